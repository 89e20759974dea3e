//! What an intersection consists of.

use super::newton::Spot;
use super::sheet::PARAMETER_BITS;
use super::vector::V3;
use crate::geometry::{Point3, Vector3};
use crate::num::Real;
use fixed::types::{I2F30, I16F48, I20F44};

/// A point of a curve on both surfaces. 80 bytes.
///
/// Points lie within [`Curve::residual`] of both surfaces; between two of them the curve is the cubic Hermite piece with
/// the tangents here, times the arc, chord · (1 + θ²/24) with θ the angle between the tangents.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CurvePoint {
    /// Parameters on A and on B: (u, v) of triangles with w = 1 − u − v, (r, s) of tensor-product patches.
    pub parameters: [[I16F48; 2]; 2],
    /// The point, halfway between both surface points.
    pub position: Point3<I20F44>,
    /// The unit tangent, forward along the curve; zero for a touching point.
    pub tangent: Vector3<I2F30>,
    /// The sine of the angle between the surfaces, 0 ..= 1.
    pub sine: I2F30,
    /// The distance of the two surface points.
    pub residual: I20F44,
}

impl CurvePoint {
    /// A point of no curve, to fill buffers with.
    pub const BLANK: Self = Self {
        parameters: [[I16F48::ZERO; 2]; 2],
        position: Point3::new(I20F44::ZERO, I20F44::ZERO, I20F44::ZERO),
        tangent: Vector3::new(I2F30::ZERO, I2F30::ZERO, I2F30::ZERO),
        sine: I2F30::ZERO,
        residual: I20F44::ZERO,
    };

    pub(super) fn of(spot: &Spot) -> Self {
        let unit = |c: Real| I2F30::from_bits(c.nearest(30).clamp(-1 << 30, 1 << 30) as i32);
        Self {
            parameters: spot.at.map(|place| place.map(I16F48::from_bits)),
            position: Point3::from_array(spot.point.map(I20F44::from_bits)),
            tangent: Vector3::from_array(spot.tangent.0.map(unit)),
            sine: unit(spot.sine),
            residual: I20F44::from_bits(spot.residual.nearest(44)),
        }
    }

    pub(super) fn places(&self) -> [[i64; 2]; 2] {
        self.parameters.map(|place| place.map(I16F48::to_bits))
    }

    pub(super) fn bits(&self) -> [i64; 3] {
        self.position.to_array().map(I20F44::to_bits)
    }

    pub(super) fn direction(&self) -> V3 {
        V3::bits(self.tangent.to_array().map(|c| c.to_bits().into()), -30)
    }

    /// The same point of the curve run backwards.
    pub(super) fn turned(self) -> Self {
        Self { tangent: Vector3::from_array(self.tangent.to_array().map(|c| -c)), ..self }
    }

    /// The same point with A and B exchanged.
    pub(super) fn exchanged(self) -> Self {
        Self { parameters: [self.parameters[1], self.parameters[0]], ..self }
    }
}

const _: () = assert!(PARAMETER_BITS == 48);

/// What a component of an intersection is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum CurveKind {
    /// A curve with two ends, along which the surfaces cross; an arm between branches or from a branch to a border too.
    Open,
    /// A closed curve, along which the surfaces cross.
    Closed,
    /// A single point where the surfaces touch.
    TangentPoint,
    /// A curve along which the surfaces touch.
    Tangential,
    /// An edge of both patches.
    SharedEdge,
    /// An edge of both patches, along which their tangent planes agree.
    SharedEdgeTangential,
    /// A part of an edge of one patch that lies on the other.
    EdgeOnSurface,
    /// The border of a region where the surfaces coincide.
    OverlapRegion,
}

/// One of the two patches.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Side {
    /// The first patch.
    A,
    /// The second patch.
    B,
}

impl Side {
    pub(super) const BOTH: [Self; 2] = [Self::A, Self::B];

    pub(super) const fn other(self) -> Self {
        match self {
            Self::A => Self::B,
            Self::B => Self::A,
        }
    }
}

/// Where a curve ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum End {
    /// On an edge. Tensor-product patches: 0 u = 0, 1 u = 1, 2 v = 0, 3 v = 1; triangles: 0 u = 0, 1 v = 0, 2 w = 0.
    Edge {
        /// Whose edge it is.
        side: Side,
        /// Its number.
        edge: u8,
    },
    /// In a corner. Tensor-product patches: 0 (0, 0), 1 (1, 0), 2 (0, 1), 3 (1, 1); triangles: 0 u = 1, 1 v = 1, 2 w = 1.
    Corner {
        /// Whose corner it is.
        side: Side,
        /// Its number.
        corner: u8,
    },
    /// In a branch.
    Branch {
        /// Its index among the branches.
        branch: u16,
    },
    /// Nowhere: the curve is closed, or a point.
    None,
    /// Inside both patches, where the curve was lost: something is undecided here.
    Lost,
}

impl End {
    pub(super) fn exchanged(self) -> Self {
        match self {
            Self::Edge { side, edge } => Self::Edge { side: side.other(), edge },
            Self::Corner { side, corner } => Self::Corner { side: side.other(), corner },
            other => other,
        }
    }
}

/// A component of an intersection.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Curve {
    /// What it is.
    pub kind: CurveKind,
    /// Whether its last point is joined to its first.
    pub closed: bool,
    /// Where it ends.
    pub ends: [End; 2],
    /// Its first point among the points.
    pub first: usize,
    /// The number of its points.
    pub count: usize,
    /// The arc length of its Hermite pieces; for a region that of its border.
    pub length: I20F44,
    /// The smallest sine of the angle between the surfaces at its points.
    pub min_sine: I2F30,
    /// The largest distance of both surfaces at its points.
    pub residual: I20F44,
    /// Pieces that were not brought within the tolerance.
    pub unrefined: u32,
}

impl Curve {
    /// No curve, to fill buffers with.
    pub const BLANK: Self = Self {
        kind: CurveKind::Open,
        closed: false,
        ends: [End::None; 2],
        first: 0,
        count: 0,
        length: I20F44::ZERO,
        min_sine: I2F30::ONE,
        residual: I20F44::ZERO,
        unrefined: 0,
    };
}

/// A point where curves of an intersection cross; the surfaces are tangent there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Branch {
    /// The point; its tangent is that of the first arm.
    pub point: CurvePoint,
    /// The unit directions of the four arms, opposite ones in turn.
    pub directions: [Vector3<I2F30>; 4],
    /// Which of them are arms inside both patches.
    pub present: [bool; 4],
    /// Which of them belong to a curve already.
    pub(super) taken: [bool; 4],
}

impl Branch {
    /// No branch, to fill buffers with.
    pub const BLANK: Self = Self {
        point: CurvePoint::BLANK,
        directions: [Vector3::new(I2F30::ZERO, I2F30::ZERO, I2F30::ZERO); 4],
        present: [false; 4],
        taken: [false; 4],
    };

    /// The number of arms.
    #[must_use]
    pub fn arms(&self) -> usize {
        self.present.iter().filter(|p| **p).count()
    }

    pub(super) fn direction(&self, arm: usize) -> V3 {
        let direction = self.directions.get(arm).copied().unwrap_or_default();
        V3::bits(direction.to_array().map(|c| c.to_bits().into()), -30)
    }
}

#[cfg(feature = "defmt")]
mod format {
    use super::{Branch, Curve, CurvePoint};
    use defmt::{Format, Formatter, write};

    impl Format for CurvePoint {
        fn format(&self, f: Formatter<'_>) {
            let [a, b] = self.places();
            write!(f, "A {}/2^48, B {}/2^48: {}/2^44, residual {}/2^44", a, b, self.bits(), self.residual.to_bits());
        }
    }

    impl Format for Curve {
        fn format(&self, f: Formatter<'_>) {
            let (length, sine) = (self.length.to_bits(), self.min_sine.to_bits());
            write!(f, "{}, {} points from {}, ends {}, ", self.kind, self.count, self.first, self.ends);
            write!(f, "length {}/2^44, least sine {}/2^30, {} unrefined", length, sine, self.unrefined);
        }
    }

    impl Format for Branch {
        fn format(&self, f: Formatter<'_>) {
            write!(f, "branch of {} arms at {}", self.arms(), self.point);
        }
    }
}
