//! Corners of a grid: ⌊256·S⌋, exact on edges, within 1/128 pixel inside.
//!
//! On an edge, and at the ends of a row, values come from [`at`], less than 16 units off, and the edge's own control points
//! decide where that is not enough: patches on both sides of an edge get equal bits. Wild nets, for which values have few bits,
//! are exact inside, too.

use super::slopes::{RowSlopes, Slopes};
use super::{Cubic, Piece, RowCubic, at};
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

/// Binomial coefficients of degree 3 and less.
const CHOICES: [[u32; 4]; 4] = [[1, 0, 0, 0], [1, 1, 0, 0], [1, 2, 1, 0], [1, 3, 3, 1]];

/// The grid of a piece that [`suits`](super::suits).
#[derive(Clone, Copy, Debug)]
pub(in crate::render) struct Corners<'n> {
    piece: Piece<'n>,
    slopes: Slopes,
    /// The whole corner units of the origin, and the rest in 2^-F.
    base: [i32; 3],
    fraction: [i32; 3],
    /// F less [`CORNER`], at least 1: values are doubled so many times before.
    shift: u32,
    doublings: u32,
    /// What values may be off.
    margin: i32,
    /// Twice that shifted left by 32 − `shift`; everything where even a whole unit is not sure.
    doubt: u32,
}

/// A row of corners.
#[derive(Clone, Copy, Debug)]
pub(in crate::render) struct CornerRow {
    j: u32,
    cubics: [RowCubic; 3],
    /// The values at both ends.
    ends: [[i32; 2]; 3],
}

/// The cubic of a row by its powers: there are bits for that.
#[inline(always)]
fn by_powers([start, slope, bend, last]: RowCubic) -> Cubic {
    [start, slope >> 1, bend.wrapping_shl(1), last.wrapping_shl(2)]
}

impl<'n> Corners<'n> {
    /// The grid of a net with so many segments, to be [set up](Self::set_up) where it stays; rows run along s if `is_turned`.
    #[inline(always)]
    pub(in crate::render) fn blank(net: SurfaceNet<'n>, steps: (u32, u32), is_turned: bool) -> Self {
        Self {
            piece: Piece::blank(net, steps, u8::from(is_turned)),
            slopes: Slopes::BLANK,
            base: [0; 3],
            fraction: [0; 3],
            shift: 1,
            doublings: 0,
            margin: 0,
            doubt: 0,
        }
    }

    /// Finds the coefficients; `steepest` says the largest bound on a derivative, in 2^-9.
    #[inline(always)]
    pub(in crate::render) fn set_up(&mut self, steepest: impl FnOnce() -> u32) {
        if !self.piece.set_up_short() {
            self.piece.set_up::<false>(steepest());
        }
        self.slopes.set_up(&self.piece);
        let piece = &self.piece;
        let start = piece.origin.map(|c| c - (1 << 15));
        let (up, less) = (piece.bits.saturating_sub(16), 16_u32.saturating_sub(piece.bits));
        self.margin = if piece.is_cut { DOUBT_IF_CUT } else { DOUBT };
        self.shift = piece.bits.saturating_sub(CORNER).clamp(1, 31);
        self.base = start.map(|c| c >> CORNER);
        self.fraction = start.map(|c| (c & 255) >> less << up);
        self.doublings = (CORNER + 1).saturating_sub(piece.bits);
        self.doubt = if self.shift < 7 { u32::MAX } else { (2 * self.margin.unsigned_abs()) << (32 - self.shift) };
    }

    /// Row `j`.
    #[inline(never)]
    pub(in crate::render) fn row(&self, j: u32) -> CornerRow {
        let s = self.piece.across.half(2 * j);
        let cubics = [self.piece.row(0, s), self.piece.row(1, s), self.piece.row(2, s)];
        let end = |[start, slope, bend, last]: RowCubic| {
            start.wrapping_add(slope >> 2).wrapping_add(bend >> 1).wrapping_add(last >> 1)
        };
        CornerRow { j, cubics, ends: cubics.map(|cubic| [cubic[0], end(cubic)]) }
    }

    /// Whether all corners of a row are to be exact, or else those at its ends: of a side of the piece, or of a wild net.
    #[inline(always)]
    pub(in crate::render) fn is_exact(&self, row: &CornerRow) -> bool {
        let is_wild = self.piece.bits < LEAST_BITS || self.piece.along.steps > MOST_SEGMENTS;
        row.j == 0 || row.j == self.piece.across.steps || is_wild
    }

    /// The exact corners from number `first` on of a row.
    #[inline(always)]
    pub(in crate::render) fn exact_row<T>(
        &self,
        row: &CornerRow,
        first: u32,
        out: &mut [T],
        set: impl Fn(&mut T, [i32; 3]),
    ) {
        let (along, across, cubics) = (&self.piece.along, &self.piece.across, row.cubics.map(by_powers));
        for (i, out) in (first..).zip(out) {
            let t = along.half(2 * i);
            if (i == 0 || i == along.steps) && (row.j == 0 || row.j == across.steps) {
                set(out, self.tip([i, row.j]));
            } else {
                // All values before one is settled: products of 64 bits with a number that is kept as one are dearer.
                let values = [at(&cubics[0], t), at(&cubics[1], t), at(&cubics[2], t)];
                let exact = |axis: usize| self.exact(axis, [i, row.j], values[axis]);
                set(out, [exact(0), exact(1), exact(2)]);
            }
        }
    }

    /// Calls `set` with a coordinate of the corners from number `first` on, within 1/128 pixel.
    #[inline(always)]
    pub(in crate::render) fn each<T>(
        &self,
        row: &CornerRow,
        axis: usize,
        first: u32,
        out: &mut [T],
        set: impl Fn(&mut T, i32),
    ) {
        let (base, fraction) = (self.base[axis], self.fraction[axis]);
        let (cubic, step) = (by_powers(row.cubics[axis]), 2 * self.piece.along.near());
        let mut t = first.wrapping_mul(step);
        for out in out {
            let value = at(&cubic, t as i32).wrapping_add(fraction);
            set(out, (value << self.doublings >> self.shift).wrapping_add(base));
            t = t.wrapping_add(step);
            core::hint::black_box(());
        }
    }

    /// The exact corner at the start or the end of a row, by its number; `None` for others.
    #[inline(always)]
    pub(in crate::render) fn end(&self, row: &CornerRow, i: u32) -> Option<[i32; 3]> {
        let is_last = i == self.piece.along.steps;
        let exact = |axis: usize| self.exact(axis, [i, row.j], row.ends[axis][usize::from(is_last)]);
        (i == 0 || is_last).then(|| [exact(0), exact(1), exact(2)])
    }

    /// A corner of the piece: a control point.
    fn tip(&self, at: [u32; 2]) -> [i32; 3] {
        let Piece { points, degrees: [m, h], strides: [by_r, by_s], .. } = self.piece;
        let index = if at[0] == 0 { 0 } else { m * by_r } + if at[1] == 0 { 0 } else { h * by_s };
        let point = points.get(index).copied().unwrap_or_default();
        [point.x, point.y, point.z].map(|c| c.to_bits() >> (16 - CORNER))
    }

    /// The exact corner for a value that is at most `margin` off.
    #[inline(always)]
    fn exact(&self, axis: usize, at: [u32; 2], value: i32) -> i32 {
        let value = value.wrapping_add(self.fraction[axis]);
        let near = (value << self.doublings >> self.shift).wrapping_add(self.base[axis]);
        let rest = (value.wrapping_add(self.margin) as u32) << (32 - self.shift);
        if rest < self.doubt { self.settle(axis, at, near) } else { near }
    }

    /// The number of the interval of a corner on a side, `near` or one close to it: a curve of the side's control points.
    ///
    /// With n segments and degree d, n^d·2^16·(S − border) is an integer: its weights stay below 3·2^30 for the 2^10 segments
    /// that there are at most, and it below 2^63.
    #[cold]
    #[inline(never)]
    fn settle(&self, axis: usize, at: [u32; 2], near: i32) -> i32 {
        let Piece { points, degrees, strides, along, across, bits, .. } = &self.piece;
        let steps = [along.steps, across.steps];
        let is_column = at[1] != 0 && at[1] != steps[1];
        if *bits < LEAST_BITS || (is_column && at[0] != 0 && at[0] != steps[0]) {
            let unit = 16 - CORNER;
            return self.piece.exact_floor(axis, at, false, (near, i64::from(near) << unit, unit));
        }
        let (way, other) = if is_column { (1, 0) } else { (0, 1) };
        let start = if at[other] == 0 { 0 } else { degrees[other] * strides[other] };
        let (i, rest, degree) = (at[way], steps[way].wrapping_sub(at[way]), degrees[way] & 3);
        let border = i64::from(near) << (16 - CORNER);
        let (mut residual, mut whole) = (0_i64, 0_u32);
        for (k, choices) in CHOICES[degree].iter().enumerate().take(degree + 1) {
            let power = (0..degree).fold(1_u32, |power, f| power.wrapping_mul(if f < k { i } else { rest }));
            let weight = power.wrapping_mul(*choices);
            let point = points.get(start + k * strides[way]).copied().unwrap_or_default();
            let value = match axis {
                0 => point.x,
                1 => point.y,
                _ => point.z,
            };
            residual = residual.wrapping_add(i64::from(weight).wrapping_mul(i64::from(value.to_bits()) - border));
            whole = whole.wrapping_add(weight);
        }
        let interval = i64::from(whole) << (16 - CORNER);
        let mut settled = near;
        for _ in 0..4 {
            if residual < 0 {
                (settled, residual) = (settled - 1, residual.wrapping_add(interval));
            } else if residual >= interval {
                (settled, residual) = (settled + 1, residual.wrapping_sub(interval));
            }
        }
        settled
    }

    /// Finds the tangents of a row.
    pub(in crate::render) fn tangents(&self, row: &CornerRow, out: &mut RowSlopes) {
        self.piece.row_slopes(&self.slopes, &row.cubics, row.j, out);
    }

    /// The normal S_r × S_s of the walk at corner (i, j), from the tangents of its row; where they span no plane, that 1/64
    /// further inside.
    #[inline(always)]
    pub(in crate::render) fn normal(&self, tangents: &RowSlopes, i: u32, j: u32) -> Option<[i32; 3]> {
        self.piece.corner_normal(tangents, i, j)
    }
}
