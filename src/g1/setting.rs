//! The mesh in working units: moved to its middle and scaled up by a power of two.

use super::{Controls, G1Error, List, MAX_VALENCE, Options};
use crate::geometry::Point3;
use crate::mesh::{HalfEdge, Mesh};
use crate::num::{Coord, I16F16, I32F32, Sum3, Triple, bits, minus, shift_half_up};

/// Fraction bits of coefficients and factors.
pub(super) const FACTOR: u32 = 48;
/// 1 as a coefficient.
pub(super) const ONE: i64 = 1 << FACTOR;

/// What is given, and how it is scaled. Working units are 2^-32 of a model unit times 2^`shift`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Setting<'a, C> {
    pub(super) mesh: Mesh<'a, C>,
    pub(super) controls: Controls<'a>,
    pub(super) options: Options,
    /// The middle of the mesh, in 2^-32 units.
    origin: Triple,
    /// The mesh is scaled up until it reaches 2^7 units from its middle; larger ones stay.
    shift: u32,
}

impl<'a, C: Coord> Setting<'a, C> {
    pub(super) fn new(mesh: &Mesh<'a, C>, controls: &Controls<'a>, options: &Options) -> Result<Self, G1Error> {
        let (mut low, mut high) = ([i64::MAX; 3], [i64::MIN; 3]);
        for vertex in 0..mesh.points().len() {
            let p = mesh.bits(vertex);
            for (c, bits) in p.into_iter().enumerate() {
                low[c] = low[c].min(bits);
                high[c] = high[c].max(bits);
            }
        }
        let (mut origin, mut reach) = ([0; 3], 0);
        for (c, origin) in origin.iter_mut().enumerate() {
            if low[c] <= high[c] {
                *origin = i64::midpoint(low[c], high[c]);
                reach = reach.max(high[c].saturating_sub(*origin).unsigned_abs());
            }
        }
        let shift = 40_u32.saturating_sub(bits(reach.into()));
        let tolerance = options.tolerance.clamp(Options::LEAST_TOLERANCE, I32F32::ONE);
        let options = Options { tolerance, ..*options };
        let setting = Self { mesh: *mesh, controls: *controls, options, origin, shift };
        setting.check()?;
        Ok(setting)
    }

    /// Lists, lengths of lists, faces.
    fn check(&self) -> Result<(), G1Error> {
        let (expected, faces) = (self.mesh.points().len(), self.mesh.faces());
        let count = |list, given: Option<usize>| match given {
            Some(given) if given != expected => Err(G1Error::Count { list, expected, given }),
            _ => Ok(()),
        };
        count(List::Normals, self.controls.normals.map(<[_]>::len))?;
        count(List::Tension, self.controls.tension.map(<[_]>::len))?;
        for face in 0..faces.len() {
            let corners = faces.corners(face).map_or(0, <[_]>::len);
            if corners != 3 {
                return Err(G1Error::NotTriangle { face, corners });
            }
        }
        for (vertex, tension) in self.controls.tension.unwrap_or(&[]).iter().enumerate() {
            if !(-I16F16::ONE..=I16F16::ONE - I16F16::ONE / 16).contains(tension) {
                return Err(G1Error::Tension { vertex, bits: tension.to_bits() });
            }
        }
        for (index, tangent) in self.controls.tangents.iter().enumerate() {
            let mut spokes = self.mesh.spokes(tangent.from.into());
            let legal = tangent.vector.to_array().into_iter().all(Coord::is_legal);
            if !legal || !spokes.any(|spoke| spoke.to == usize::from(tangent.to)) {
                return Err(G1Error::Tangent { index });
            }
        }
        for (index, twist) in self.controls.twists.iter().enumerate() {
            let legal = twist.point.to_array().into_iter().all(Coord::is_legal);
            if !legal || usize::from(twist.face) >= faces.len() || twist.corner > 2 {
                return Err(G1Error::Twist { index });
            }
        }
        Ok(())
    }

    /// The first corner of a face.
    pub(super) const fn corner(&self, face: usize) -> usize {
        self.mesh.origin(HalfEdge::new((3 * face) as u16))
    }

    /// A vertex.
    pub(super) fn place(&self, vertex: usize) -> Triple {
        self.inward(self.mesh.bits(vertex))
    }

    /// A point in 2^-32 units, in working units. Legal ones stay below 2^60; far ones saturate.
    fn inward(&self, point: Triple) -> Triple {
        let limit = (1_i128 << 60) - 1;
        minus(&point, &self.origin).map(|c| (i128::from(c) << self.shift).clamp(-limit, limit) as i64)
    }

    /// A vector in working units.
    fn inward_vector(&self, vector: [I32F32; 3]) -> Triple {
        let limit = (1_i128 << 60) - 1;
        vector.map(|c| (i128::from(c.to_bits()) << self.shift).clamp(-limit, limit) as i64)
    }

    /// A length back in 2^-32 units.
    pub(super) fn outward(&self, length: i128) -> i64 {
        let bits = shift_half_up(length.clamp(0, 1 << 120), self.shift);
        bits.min(i64::MAX.into()) as i64
    }

    /// A control point in units, half up; `None` outside the legal range.
    pub(super) fn emit(&self, point: &Triple) -> Option<Point3<I32F32>> {
        let coordinate = |origin: i64, c: i64| {
            let bits = (i128::from(origin) << self.shift) + i128::from(c);
            I32F32::from_legal_bits(shift_half_up(bits, self.shift))
        };
        let ([x, y, z], [p, q, r]) = (self.origin, *point);
        Some(Point3::new(coordinate(x, p)?, coordinate(y, q)?, coordinate(z, r)?))
    }

    /// A control point as it is emitted, in 2^-32 units from the middle.
    pub(super) fn rounded(&self, point: &Triple) -> Triple {
        point.map(|c| shift_half_up(c.into(), self.shift) as i64)
    }

    /// A tangent that the caller gives.
    pub(super) fn given_tangent(&self, from: usize, to: u16) -> Option<Triple> {
        let mut tangents = self.controls.tangents.iter();
        let given = tangents.find(|tangent| usize::from(tangent.from) == from && tangent.to == to)?;
        Some(self.inward_vector(given.vector.to_array()))
    }

    /// A twist target that the caller gives, for the corner that a half-edge leaves.
    pub(super) fn given_twist(&self, half_edge: u16) -> Option<Triple> {
        let corner = |face: u16, corner: u8| 3 * u32::from(face) + u32::from(corner);
        let mut twists = self.controls.twists.iter();
        let given = twists.find(|twist| corner(twist.face, twist.corner) == u32::from(half_edge))?;
        Some(self.inward(given.point.to_array().map(I32F32::to_bits)))
    }

    /// 1 − tension, in 2^-16.
    pub(super) fn slack(&self, vertex: usize) -> i64 {
        let tension = self.controls.tension.and_then(|tension| tension.get(vertex));
        (1 << 16) - tension.map_or(0, |tension| i64::from(tension.to_bits()))
    }
}

/// `None` is an overflow at a vertex.
pub(super) fn fits<T>(value: Option<T>, vertex: usize) -> Result<T, G1Error> {
    value.ok_or(G1Error::Overflow { vertex })
}

/// a·f + b·g + … over 2^48, half up.
pub(super) fn combine(terms: &[(&Triple, i64)]) -> Option<Triple> {
    terms.iter().fold(Sum3::default(), |sum, (vector, factor)| sum.plus(vector, *factor)).narrow(FACTOR)
}

const _: () = assert!(MAX_VALENCE.is_power_of_two());
