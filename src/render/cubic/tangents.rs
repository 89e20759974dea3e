//! Normals of a piece where they are wanted.
//!
//! Along a row S_r is a quadratic of the row's own coefficients; S_s a cubic through the derivatives of the coefficients of
//! rows. Both are shifted left as far as the coefficients of the piece allow.

use super::super::light::{Light, Side, normal_on};
use super::{Cubic, Piece, Row, RowCubic, at, magnitude};
use crate::num::{high, leading_zeros};

/// S_r and S_s along a row, each up to a factor, by axis.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::render) struct RowTangents {
    along: [[i32; 3]; 3],
    across: [Cubic; 3],
}

impl Piece<'_> {
    /// Finds the tangents of the row at `s`, whose coefficients are `rows`.
    #[inline(never)]
    pub(super) fn tangents(&self, rows: &[RowCubic; 3], s: i32, out: &mut RowTangents) {
        let [by_r, by_s] = self.doublings.map(|up| up & 31);
        // b1 + 2·b2·t + 3·b3·t² from 4·b1, 2·b2 and 2·b3, a quarter of it and doubled.
        for (along, [_, slope, bend, last]) in out.along.iter_mut().zip(rows) {
            *along = [slope >> 4 << by_r, bend >> 1 << by_r, (last >> 1).wrapping_mul(3) << by_r];
        }
        // From c0, 2·c1, 4·c2, 8·c3 to c1, 4·c2, 12·c3.
        let slope =
            |c: &Cubic| (c[1] >> 1).wrapping_add(high(c[2].wrapping_add(high(c[3].wrapping_add(c[3] >> 1), s)), s));
        for (across, [a, b, c, d]) in out.across.iter_mut().zip(&self.rows) {
            // A quarter of b0, 2·b1, 4·b2 and 8·b3, doubled.
            *across = [slope(a) >> 2 << by_s, slope(b) >> 3 << by_s, slope(c) >> 1 << by_s, slope(d) << by_s];
        }
    }
}

impl RowTangents {
    /// Doubles both as often as this row allows: those of a whole patch are long in others.
    pub(super) fn double(&mut self) {
        let up = |all: &[i32]| {
            let all = all.iter().fold(0, |all, c| all | magnitude(*c));
            leading_zeros(all as u32 | 1).saturating_sub(3)
        };
        let (by_r, by_s) = (up(self.along.as_flattened()), up(self.across.as_flattened()));
        self.along.as_flattened_mut().iter_mut().for_each(|c| *c <<= by_r & 31);
        self.across.as_flattened_mut().iter_mut().for_each(|c| *c <<= by_s & 31);
    }

    #[inline(always)]
    pub(super) fn at(&self, t: i32) -> [[i32; 3]; 2] {
        let ([x, y, z], [u, v, w]) = (&self.along, &self.across);
        let quadratic = |c: &[i32; 3]| c[0].wrapping_add(high(c[1].wrapping_add(high(c[2], t)), t));
        [[quadratic(x), quadratic(y), quadratic(z)], [at(u, t), at(v, t), at(w, t)]]
    }
}

/// U × V by the upper halves of products, and how far it is to be shifted right to have 15 bits; `None` where that does not
/// say enough, of the sign of z too if `IS_SIGN_WANTED`.
#[inline(always)]
fn cross<const IS_SIGN_WANTED: bool>([u, v]: [[i32; 3]; 2]) -> Option<([i32; 3], u32)> {
    let minor = |a: usize, b: usize| high(u[a], v[b]).wrapping_sub(high(u[b], v[a]));
    let [x, y, z] = [minor(1, 2), minor(2, 0), minor(0, 1)];
    let size = (magnitude(x) | magnitude(y) | magnitude(z)) as u32;
    // A half is off by one at most.
    if size < 1 << 16 || (IS_SIGN_WANTED && z.wrapping_add(1) as u32 <= 2) {
        return None;
    }
    Some(([x, y, z], 17_u32.wrapping_sub(leading_zeros(size)) & 31))
}

/// The normal of two tangents; `None` where it vanishes. By the upper halves of the products where those say enough.
#[inline(always)]
pub(super) fn normal_of(side: Side, tangents: [[i32; 3]; 2]) -> Option<[i32; 3]> {
    let Some((cross, shift)) = cross::<true>(tangents) else { return normal_on(side, tangents) };
    let turned = side == Side::Against || (side == Side::Viewer && cross[2] > 0);
    Some(cross.map(|c| if turned { -(c >> shift) } else { c >> shift }))
}

impl Row<'_, '_> {
    /// The normal at point `i`; where the tangents span no plane, that 1/64 further inside.
    #[inline(always)]
    pub(super) fn normal(&self, i: u32, side: Side) -> [i32; 3] {
        let t = self.parameter(i);
        normal_of(side, self.tangents.at(t)).or_else(|| self.piece.inside(self.s, t, side)).unwrap_or([0, 0, -1])
    }

    /// The parameter of point `i`, good enough for a normal.
    #[inline(always)]
    fn parameter(&self, i: u32) -> i32 {
        (2 * i + self.half).wrapping_mul(self.piece.along.near()) as i32
    }

    /// The levels of points, whose numbers are counted from `last` down, in a light.
    pub(super) fn light(&self, last: u32, seen: &[u8], levels: &mut [u8], light: &Light, side: Side) {
        if side == Side::Viewer {
            self.light_on::<true>(last, seen, levels, light, side);
        } else {
            self.light_on::<false>(last, seen, levels, light, side);
        }
    }

    #[inline(never)]
    fn light_on<const VIEWER: bool>(&self, last: u32, seen: &[u8], levels: &mut [u8], light: &Light, side: Side) {
        let (end, step) = (self.parameter(last), 2 * self.piece.along.near());
        let lamp = if side == Side::Against { light.reversed() } else { *light };
        for (k, out) in seen.iter().zip(levels) {
            let t = end.wrapping_sub_unsigned(u32::from(*k).wrapping_mul(step));
            *out = match cross::<VIEWER>(self.tangents.at(t)) {
                // Turning a normal turns the sign of its product with the light, and nothing else.
                Some((cross, shift)) => lamp.level_of_turned(cross.map(|c| c >> shift), VIEWER && cross[2] > 0),
                None => self.level(t, light, side),
            };
        }
    }

    /// The level where the upper halves of products are not enough.
    #[cold]
    #[inline(never)]
    fn level(&self, t: i32, light: &Light, side: Side) -> u8 {
        let normal = normal_on(side, self.tangents.at(t)).or_else(|| self.piece.inside(self.s, t, side));
        light.level(normal.unwrap_or([0, 0, -1]))
    }
}

impl Piece<'_> {
    /// The normal 1/64 of the way from a point inwards.
    #[cold]
    #[inline(never)]
    pub(super) fn inside(&self, s: i32, t: i32, side: Side) -> Option<[i32; 3]> {
        let inwards = |t: i32| (1 << 25) + (t >> 6) * 62;
        let s = inwards(s);
        let mut tangents = RowTangents::default();
        self.tangents(&[self.row(0, s), self.row(1, s), self.row(2, s)], s, &mut tangents);
        normal_on(side, tangents.at(inwards(t)))
    }
}
