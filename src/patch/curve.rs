//! Bézier curves that own their control points.

use super::net::{bounds_of, check_range, check_range_i16f16, check_range_i32f32};
use super::{CurveNet, MAX_DEGREE, NetError};
use crate::geometry::{Affine, Bounds, GeometryError, Point3};
use crate::num::{Coord, I16F16, I32F32};

/// A Bézier curve of order `K`, that is of degree K − 1 in 1 ..= 8, in storage of 12·K bytes (`I16F16`).
///
/// ```
/// use embedded_surfaces::patch::{CubicCurve, Parameter};
/// let curve = CubicCurve::from_ints([[0, 0, 0], [0, 100, 0], [100, 100, 0], [100, 0, 0]])?;
/// let middle = curve.net().eval(Parameter::HALF);
/// assert_eq!((middle.x.to_num::<i32>(), middle.y.to_num::<i32>()), (50, 75));
/// # Ok::<(), embedded_surfaces::patch::NetError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Curve<const K: usize, C = I16F16> {
    pub(crate) points: [Point3<C>; K],
}

/// Degree 2, a parabola.
pub type QuadraticCurve = Curve<3>;
/// Degree 3.
pub type CubicCurve = Curve<4>;

impl<const K: usize, C> Curve<K, C> {
    /// Fails to compile for a degree outside 1 ..= 8.
    pub(super) const LEGAL: () = assert!(K >= 2 && K <= MAX_DEGREE + 1, "the degree K - 1 is outside 1 ..= 8");
}

impl<const K: usize> Curve<K> {
    /// The curve with these whole coordinates, one `[x, y, z]` per control point.
    ///
    /// # Errors
    /// [`NetError::OutOfRange`] for −32768.
    pub const fn from_ints(points: [[i16; 3]; K]) -> Result<Self, NetError> {
        let mut out = [Point3::ORIGIN; K];
        let mut i = 0;
        while i < K {
            let [x, y, z] = points[i];
            out[i] = Point3::from_ints(x, y, z);
            i += 1;
        }
        Self::new(out)
    }

    /// The curve through these control points; also in constant context.
    ///
    /// # Errors
    /// [`NetError::OutOfRange`] for a coordinate outside ±32767.
    pub const fn new(points: [Point3<I16F16>; K]) -> Result<Self, NetError> {
        let () = Self::LEGAL;
        match check_range_i16f16(&points) {
            Ok(()) => Ok(Self { points }),
            Err(error) => Err(error),
        }
    }
}

impl<const K: usize> Curve<K, I32F32> {
    /// The curve through these control points; also in constant context.
    ///
    /// # Errors
    /// [`NetError::OutOfRange`] for a coordinate outside ±2^26.
    pub const fn new(points: [Point3<I32F32>; K]) -> Result<Self, NetError> {
        let () = Self::LEGAL;
        match check_range_i32f32(&points) {
            Ok(()) => Ok(Self { points }),
            Err(error) => Err(error),
        }
    }

    /// The nearest curve with `I16F16` coordinates, half up.
    ///
    /// # Errors
    /// [`NetError::OutOfRange`] for a coordinate outside ±32767.
    pub fn round(&self) -> Result<Curve<K>, NetError> {
        super::convert::round(&self.points, 0).and_then(Curve::<K>::new)
    }
}

impl<const K: usize, C: Coord> TryFrom<[Point3<C>; K]> for Curve<K, C> {
    type Error = NetError;

    fn try_from(points: [Point3<C>; K]) -> Result<Self, NetError> {
        let () = Self::LEGAL;
        check_range(&points)?;
        Ok(Self { points })
    }
}

impl<const K: usize, C: Coord> Curve<K, C> {
    /// The control points.
    #[must_use]
    pub const fn points(&self) -> &[Point3<C>; K] {
        &self.points
    }

    /// The curve, borrowed, with the degree erased.
    #[must_use]
    pub const fn net(&self) -> CurveNet<'_, C> {
        CurveNet::of_checked(&self.points)
    }

    /// The box of the control points, which holds the whole curve.
    #[must_use]
    pub fn bounds(&self) -> Bounds<C> {
        bounds_of(&self.points)
    }

    /// The image under an affine map, each control point rounded once, half up.
    ///
    /// # Errors
    /// [`GeometryError::OutOfRange`] where a control point leaves the legal range.
    pub fn transform(&self, map: &Affine) -> Result<Self, GeometryError> {
        let mut points = self.points;
        for p in &mut points {
            *p = map.apply(p)?;
        }
        Ok(Self { points })
    }
}
