//! Normals of a piece where they are wanted.
//!
//! Along a row S_r is a quadratic of the row's own coefficients, which leave 27 bits for it; S_s a cubic through the
//! derivatives of the columns, shifted to 25 bits. S_r is within 2^-25 of the steepest tangent of its piece, S_s within 2^-23
//! of the longest of its row.

use super::super::light::{Side, normal_on, truncate};
use super::{Cubic, Piece, Row, at, high, scaled};

/// S_r and S_s along a row, each up to a factor, by axis.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::render) struct RowTangents {
    along: [[i32; 3]; 3],
    across: [Cubic; 3],
}

/// The leading zeros of all values, sign bits included, less the one for the sign.
#[inline(always)]
fn room(values: &[i32]) -> u32 {
    let all = values.iter().fold(0, |all, v| all | (v ^ (v >> 31)));
    (all as u32 | 1).leading_zeros() - 1
}

impl Piece<'_> {
    /// Finds the tangents of the row at `s`, whose coefficients are `cubics`.
    #[inline(never)]
    pub(super) fn tangents(&self, cubics: &[[i32; 4]; 3], s: i32, out: &mut RowTangents) {
        for (along, [_, b1, b2, b3]) in out.along.iter_mut().zip(cubics) {
            *along = [*b1, b2.wrapping_shl(2), b3.wrapping_mul(12)];
        }
        // From c0, 2·c1, 4·c2, 8·c3 to c1, 4·c2, 12·c3.
        let slope = |c: &Cubic| at(&[c[1] >> 1, c[2], c[3].wrapping_add(c[3] >> 1), 0], s);
        let mut slopes = self.columns.each_ref().map(|[a, b, c, d]| [slope(a), slope(b), slope(c), slope(d)]);
        let room = room(slopes.as_flattened());
        let (up, down) = (room.saturating_sub(6), 6_u32.saturating_sub(room));
        slopes.as_flattened_mut().iter_mut().for_each(|c| *c = *c << up >> down);
        for (across, slopes) in out.across.iter_mut().zip(slopes) {
            *across = scaled(self.row(slopes));
        }
    }
}

impl RowTangents {
    #[inline(always)]
    pub(super) fn at(&self, t: i32) -> [[i32; 3]; 2] {
        let ([x, y, z], [u, v, w]) = (&self.along, &self.across);
        let quadratic = |c: &[i32; 3]| c[0].wrapping_add(high(c[1].wrapping_add(high(c[2], t)), t));
        [[quadratic(x), quadratic(y), quadratic(z)], [at(u, t), at(v, t), at(w, t)]]
    }
}

/// The normal of two tangents; `None` where it vanishes. By the upper halves of the products where those say enough.
#[inline(always)]
pub(super) fn normal_of(side: Side, [u, v]: [[i32; 3]; 2]) -> Option<[i32; 3]> {
    let minor = |a: usize, b: usize| high(u[a], v[b]).wrapping_sub(high(u[b], v[a]));
    let cross = [minor(1, 2), minor(2, 0), minor(0, 1)];
    let size = cross.iter().fold(0, |all, c| all | (c ^ (c >> 31))) as u32;
    // A half is off by one at most; the sign of z has to be known.
    if size < 1 << 16 || (side == Side::Viewer && cross[2].wrapping_add(1) as u32 <= 2) {
        return normal_on(side, [u, v]);
    }
    let turned = side == Side::Against || (side == Side::Viewer && cross[2] > 0);
    let normal = truncate(cross, 15);
    Some(if turned { normal.map(|c| -c) } else { normal })
}

impl Row<'_, '_> {
    /// The normal at point `i`; where the tangents span no plane, that 1/64 further inside.
    #[inline(always)]
    pub(super) fn normal(&self, i: u32, side: Side) -> [i32; 3] {
        let t = self.piece.along.near(2 * i + self.half);
        normal_of(side, self.tangents.at(t)).or_else(|| self.piece.inside(self.s, t, side)).unwrap_or([0, 0, -1])
    }
}

impl Piece<'_> {
    /// The normal 1/64 of the way from a point inwards.
    #[cold]
    #[inline(never)]
    pub(super) fn inside(&self, s: i32, t: i32, side: Side) -> Option<[i32; 3]> {
        let inwards = |t: i32| (1 << 25) + (t >> 6) * 62;
        let s = inwards(s);
        let cubics = [self.row(self.control(0, s)), self.row(self.control(1, s)), self.row(self.control(2, s))];
        let mut tangents = RowTangents::default();
        self.tangents(&cubics, s, &mut tangents);
        normal_on(side, tangents.at(inwards(t)))
    }
}
