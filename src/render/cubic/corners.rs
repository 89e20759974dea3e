//! Corners of a grid: ⌊256·S⌋, exact on edges, within 1/128 pixel inside.
//!
//! Values come from [`value_at`], less than 16 units off. On an edge, and at the ends of a row, [`exact`](super::exact) decides
//! where that is not enough: patches on both sides of an edge get equal bits. Wild nets, for which values have few bits, are
//! exact inside, too.

use super::super::light::Side;
use super::steps::value_at;
use super::tangents::{RowTangents, normal_of};
use super::{Piece, RowCubic};
use crate::patch::SurfaceNet;

/// Fraction bits of corners.
const CORNER: u32 = 8;

/// What values may be off; and those of a net that was cut.
const DOUBT: i32 = 16;
const DOUBT_IF_CUT: i32 = 32;

/// The least F, and the most segments of a row, for which values and parameters inside are off by less than 1/256 pixel where
/// a segment has 32 pixels at most.
const LEAST_BITS: u32 = 14;
const MOST_SEGMENTS: u32 = 256;

/// The grid of a piece that [`suits`](super::suits).
#[derive(Clone, Copy, Debug)]
pub(in crate::render) struct Corners<'n> {
    piece: Piece<'n>,
    /// The whole corner units of the origin, and the rest in 2^-F.
    base: [i32; 3],
    fraction: [i32; 3],
    /// F less [`CORNER`], at least 1: values are doubled so many times before.
    shift: u32,
    doublings: u32,
    doubt: i32,
}

/// A row of corners.
#[derive(Clone, Copy, Debug)]
pub(in crate::render) struct CornerRow {
    j: u32,
    s: i32,
    cubics: [RowCubic; 3],
    /// The values at both ends.
    ends: [[i32; 2]; 3],
    is_exact: bool,
}

impl<'n> Corners<'n> {
    /// The grid of a net with so many segments; rows run along s if `is_turned`.
    pub(in crate::render) fn new(net: SurfaceNet<'n>, steps: (u32, u32), is_turned: bool, steepest: u32) -> Self {
        let mut piece = Piece::blank(net, steps, u8::from(is_turned));
        piece.set_up::<false>(steepest);
        let start = piece.origin.map(|c| c - (1 << 15));
        let (up, less) = (piece.bits.saturating_sub(16), 16_u32.saturating_sub(piece.bits));
        let doubt = if piece.is_cut { DOUBT_IF_CUT } else { DOUBT };
        Self {
            piece,
            base: start.map(|c| c >> CORNER),
            fraction: start.map(|c| (c & 255) >> less << up),
            shift: piece.bits.saturating_sub(CORNER).clamp(1, 31),
            doublings: (CORNER + 1).saturating_sub(piece.bits),
            doubt,
        }
    }

    /// Row `j`.
    #[inline(never)]
    pub(in crate::render) fn row(&self, j: u32) -> CornerRow {
        let s = self.piece.across.half(2 * j);
        let (mut cubics, mut ends) = ([[0; 4]; 3], [[0; 2]; 3]);
        for axis in 0..3 {
            let cubic = self.piece.row(axis, s);
            let [start, slope, bend, last] = cubic;
            ends[axis] = [start, start.wrapping_add(slope >> 2).wrapping_add(bend >> 1).wrapping_add(last >> 1)];
            cubics[axis] = cubic;
        }
        let is_edge = j == 0 || j == self.piece.across.steps;
        let is_exact = is_edge || self.piece.bits < LEAST_BITS || self.piece.along.steps > MOST_SEGMENTS;
        CornerRow { j, s, cubics, ends, is_exact }
    }

    /// Calls `set` with a coordinate of the corners from number `first` on.
    #[inline(always)]
    pub(in crate::render) fn each<T>(
        &self,
        row: &CornerRow,
        axis: usize,
        first: u32,
        out: &mut [T],
        set: impl Fn(&mut T, i32),
    ) {
        let (along, cubic) = (&self.piece.along, &row.cubics[axis]);
        if row.is_exact {
            for (i, out) in (first..).zip(out.iter_mut()) {
                set(out, self.exact(axis, [i, row.j], value_at(cubic, along.half(2 * i))));
            }
        } else {
            let (base, fraction, step) = (self.base[axis], self.fraction[axis], 2 * along.near());
            let mut t = first.wrapping_mul(step);
            for out in out.iter_mut() {
                let value = value_at(cubic, t as i32).wrapping_add(fraction);
                set(out, (value << self.doublings >> self.shift).wrapping_add(base));
                t = t.wrapping_add(step);
                core::hint::black_box(());
            }
        }
        let last = (first as usize).wrapping_add(out.len()).wrapping_sub(1) as u32;
        if let (0, Some(out)) = (first, out.first_mut()) {
            set(out, self.exact(axis, [0, row.j], row.ends[axis][0]));
        }
        if let (true, Some(out)) = (last == along.steps, out.last_mut()) {
            set(out, self.exact(axis, [last, row.j], row.ends[axis][1]));
        }
    }

    /// The exact corner for a value that is at most [`DOUBT`] off.
    #[inline(always)]
    fn exact(&self, axis: usize, at: [u32; 2], value: i32) -> i32 {
        let value = value.wrapping_add(self.fraction[axis]);
        let near = (value << self.doublings >> self.shift).wrapping_add(self.base[axis]);
        let rest = value.wrapping_add(self.doubt) & ((1 << self.shift) - 1);
        if rest < 2 * self.doubt || self.shift < 6 { self.settle(axis, at, near) } else { near }
    }

    #[cold]
    #[inline(never)]
    fn settle(&self, axis: usize, at: [u32; 2], near: i32) -> i32 {
        let unit = 16 - CORNER;
        self.piece.exact_floor(axis, at, false, (near, i64::from(near) << unit, unit))
    }

    /// Finds the tangents of a row.
    pub(in crate::render) fn tangents(&self, row: &CornerRow, out: &mut RowTangents) {
        self.piece.tangents(&row.cubics, row.s, out);
        out.double();
    }

    /// The normal S_r × S_s of the walk at corner (i, j), from the tangents of its row; where they span no plane, that 1/64
    /// further inside.
    pub(in crate::render) fn normal(&self, tangents: &RowTangents, i: u32, j: u32) -> Option<[i32; 3]> {
        let t = self.piece.along.half(2 * i);
        let inside = || self.piece.inside(self.piece.across.half(2 * j), t, Side::Along);
        normal_of(Side::Along, tangents.at(t)).or_else(inside)
    }
}
