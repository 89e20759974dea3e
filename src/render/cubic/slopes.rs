//! Normals at the corners of a grid: tangents in 14 bits, with products of 32 bits only.
//!
//! Levels have 8 bits: S_r and S_s are taken up to a factor that brings the largest of their control values, of a row and
//! of the piece, to between 2^13 and 2^14; parameters are in 2^-13. A quadratic or cubic with control values of at most M
//! has no coefficient, and no partial sum of Horner's rule, above 12·M: products stay below 2^31. Each step rounds down by
//! less than one, so tangents are within 3 units, and a component of the normal within 2^18.

use super::super::light::Side;
use super::steps::Parameters;
use super::tangents::{RowTangents, normal_of};
use super::{FACTORS, Piece, RowCubic, power};
use crate::num::leading_zeros;

/// Fraction bits of parameters.
const T: u32 = 13;

/// Bits of control values.
const BITS: u32 = 14;

/// A quadratic by its coefficients.
type Quadratic = [i32; 3];

/// Control values below this, in 2^-F, are what rounding leaves of a side that is one point.
const NOISE: u32 = 1 << 9;

/// Normals with a component of at least this much are within 1/16 of their direction, mostly far less.
const CLEAR: u32 = 1 << 22;

/// The columns of a piece: S_s along each as a quadratic in s.
#[derive(Clone, Copy, Debug)]
pub(super) struct Slopes([[Quadratic; 4]; 3]);

/// S_r and S_s along a row, by axis.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::render) struct RowSlopes {
    along: [Quadratic; 3],
    across: [[i32; 4]; 3],
}

/// The bits that are set in some value, or clear in a negative one.
#[inline(always)]
fn magnitude(values: &[i32]) -> u32 {
    values.iter().fold(0, |all, v| all | (v ^ (v >> 31))) as u32
}

/// The bits that all values together take.
#[inline(always)]
fn bits(values: &[i32]) -> u32 {
    32 - leading_zeros(magnitude(values))
}

/// Brings values of so many bits to [`BITS`].
#[inline(always)]
fn fit(value: i32, bits: u32) -> i32 {
    if bits > BITS { value >> (bits - BITS) } else { value << (BITS - bits) }
}

/// The coefficients of a quadratic with these control values.
#[inline(always)]
fn quadratic([a, b, c]: [i32; 3]) -> Quadratic {
    let d = b - a;
    [a, 2 * d, c - b - d]
}

#[inline(always)]
fn step(c: i32, higher: i32, t: i32) -> i32 {
    c + (higher.wrapping_mul(t) >> T)
}

/// Step `i` in 2^-13.
#[inline(always)]
fn parameter(parameters: &Parameters, i: u32) -> i32 {
    ((parameters.near().wrapping_mul(2 * i) + (1 << 17)) >> 18) as i32
}

impl Slopes {
    pub(super) const BLANK: Self = Self([[[0; 3]; 4]; 3]);

    /// Finds those of a piece.
    #[inline(never)]
    pub(super) fn set_up(&mut self, piece: &Piece<'_>) {
        let Piece { points, degrees: [m, h], strides, .. } = piece;
        let slopes = &mut self.0;
        for a in 0..=m & 3 {
            // The control values of the derivative, up to its degree, and raised to degree 2 up to a factor.
            let mut sides = [[0; 3]; 3];
            let at = |b: usize| points.get(a * strides[0] + b * strides[1]).copied().unwrap_or_default();
            for (b, side) in sides.iter_mut().enumerate().take(*h) {
                let [from, to] = [at(b), at(b + 1)].map(|p| p.to_array().map(|c| c.to_bits() >> 2));
                *side = [to[0] - from[0], to[1] - from[1], to[2] - from[2]];
            }
            for (axis, slopes) in slopes.iter_mut().enumerate() {
                let [p, q, r] = sides.map(|side| side[axis]);
                slopes[a & 3] = match h {
                    1 => [p; 3],
                    2 => [p, (p >> 1) + (q >> 1), q],
                    _ => [p, q, r],
                };
            }
        }
        let bits = bits(slopes.as_flattened().as_flattened());
        for slope in slopes.as_flattened_mut() {
            *slope = quadratic(slope.map(|c| fit(c, bits)));
        }
    }
}

impl Piece<'_> {
    /// Finds the tangents of row `j`, whose coefficients are `cubics`.
    #[inline(never)]
    pub(super) fn row_slopes(&self, slopes: &Slopes, cubics: &[RowCubic; 3], j: u32, out: &mut RowSlopes) {
        // From 4·b1, 2·b2 and 2·b3 to control values of the derivative.
        let along = cubics.map(|[_, b1, b2, b3]| {
            let (first, second, third) = (b1 >> 2, b2 >> 1, b3 >> 1);
            [first, first + second, first + 2 * second + 3 * third]
        });
        let used = bits(along.as_flattened());
        let is_point = used <= NOISE.ilog2();
        for (out, along) in out.along.iter_mut().zip(along) {
            *out = if is_point { [0; 3] } else { quadratic(along.map(|c| fit(c, used))) };
        }
        let s = parameter(&self.across, j);
        for (out, columns) in out.across.iter_mut().zip(&slopes.0) {
            *out = power(columns.map(|[a, b, c]| step(a, step(b, c, s), s)), &FACTORS[self.degrees[0] & 3]);
        }
    }

    /// The normal S_r × S_s at corner (i, j); where the tangents span no plane, that 1/64 further inside.
    #[inline(always)]
    pub(super) fn corner_normal(&self, row: &RowSlopes, i: u32, j: u32) -> Option<[i32; 3]> {
        let t = parameter(&self.along, i);
        let u = row.along.each_ref().map(|[a, b, c]| step(*a, step(*b, *c, t), t));
        let v = row.across.each_ref().map(|[a, b, c, d]| step(*a, step(*b, step(*c, *d, t), t), t));
        // Factors are at most 2^14 + 3.
        let minor = |a: usize, b: usize| u[a].wrapping_mul(v[b]).wrapping_sub(u[b].wrapping_mul(v[a]));
        let cross = [minor(1, 2), minor(2, 0), minor(0, 1)];
        let size = magnitude(&cross);
        if size < CLEAR {
            self.doubtful_normal(row.along == [[0; 3]; 3], i, j)
        } else {
            // To 15 bits.
            let shift = 17 - leading_zeros(size);
            Some(cross.map(|c| c >> (shift & 15)))
        }
    }

    #[cold]
    #[inline(never)]
    fn doubtful_normal(&self, is_point: bool, i: u32, j: u32) -> Option<[i32; 3]> {
        let (s, t) = (self.across.half(2 * j), self.along.half(2 * i));
        if is_point {
            return self.inside(s, t, Side::Along);
        }
        let mut row = RowTangents::default();
        self.tangents(&[self.row(0, s), self.row(1, s), self.row(2, s)], s, &mut row);
        row.double();
        let tangents = row.at(t);
        let is_clear = tangents.iter().all(|tangent| bits(tangent) > NOISE.ilog2());
        let normal = if is_clear { normal_of(Side::Along, tangents) } else { None };
        normal.or_else(|| self.inside(s, t, Side::Along))
    }
}
