//! Corners of a grid: ⌊256·S⌋, exact on edges, within 1/128 pixel inside.
//!
//! On an edge, and at the ends of a row, values come from [`at`](super::at), less than 16 units off, and [`exact`](super::exact)
//! decides where that is not enough: patches on both sides of an edge get equal bits. Inside, rows are walked by differences.

use super::run::Line;
use super::slopes::{RowSlopes, Slopes};
use super::{Parameters, Piece, at, scaled};
use crate::patch::SurfaceNet;

/// Fraction bits of corners.
const CORNER: u32 = 8;

/// What values may be off.
const DOUBT: i32 = 16;

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
    /// F less [`CORNER`].
    shift: u32,
    /// 2·[`DOUBT`] shifted left by 32 − `shift`; everything where even a whole unit is not sure.
    doubt: u32,
}

/// A row of corners.
#[derive(Clone, Copy, Debug)]
pub(in crate::render) struct CornerRow {
    j: u32,
    cubics: [[i32; 4]; 3],
    /// The values at both ends.
    ends: [[i32; 2]; 3],
}

impl<'n> Corners<'n> {
    /// The grid of a net with so many segments; rows run along s if `is_turned`.
    #[inline(always)]
    pub(in crate::render) fn new(net: SurfaceNet<'n>, steps: (u32, u32), is_turned: bool, steepest: u32) -> Self {
        let piece = Piece::new(net, steps, u8::from(is_turned), steepest);
        let start = piece.origin.map(|c| c - (1 << 15));
        let (up, down) = (piece.bits.saturating_sub(16), 16_u32.saturating_sub(piece.bits));
        let shift = piece.bits.saturating_sub(CORNER).clamp(1, 31);
        Self {
            slopes: Slopes::of(&piece),
            piece,
            base: start.map(|c| c >> CORNER),
            fraction: start.map(|c| (c & 255) >> down << up),
            shift,
            doubt: if shift < 6 { u32::MAX } else { (2 * DOUBT.unsigned_abs()) << (32 - shift) },
        }
    }

    /// Row `j`.
    #[inline(never)]
    pub(in crate::render) fn row(&self, j: u32) -> CornerRow {
        let s = self.piece.across.half(2 * j);
        let controls = [self.piece.control(0, s), self.piece.control(1, s), self.piece.control(2, s)];
        CornerRow {
            j,
            cubics: controls.map(|control| self.piece.row(control)),
            ends: controls.map(|control| [control[0], control[self.piece.degrees[0] & 3]]),
        }
    }

    /// Whether a row is a side of the piece: all its corners are to be exact then, or else those at its ends.
    #[inline(always)]
    pub(in crate::render) fn is_edge(&self, row: &CornerRow) -> bool {
        row.j == 0 || row.j == self.piece.across.steps
    }

    /// The exact corners from number `first` on of a row that is an edge.
    #[inline(always)]
    pub(in crate::render) fn edge<T>(
        &self,
        row: &CornerRow,
        first: u32,
        out: &mut [T],
        set: impl Fn(&mut T, [i32; 3]),
    ) {
        let cubics = row.cubics.map(scaled);
        // As `half`, with the bits below 2^-31.
        let Parameters { steps, factor, shift } = self.piece.along;
        let step = u64::from(factor) << (33 - (shift & 15));
        let mut all = step.wrapping_mul(first.into());
        for (i, out) in (first..).zip(out) {
            let t = (all >> 32) as i32;
            all = all.wrapping_add(step);
            if i == 0 || i == steps {
                set(out, self.tip([i, row.j]));
            } else {
                let exact = |axis: usize| self.exact(axis, [i, row.j], at(&cubics[axis], t));
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
        let mut line: Line = self.piece.line(&row.cubics[axis], self.piece.along.half(2 * first), fraction);
        for out in out {
            set(out, (line.value >> self.shift).wrapping_add(base));
            line.step();
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

    /// The exact corner for a value that is at most [`DOUBT`] off.
    #[inline(always)]
    fn exact(&self, axis: usize, at: [u32; 2], value: i32) -> i32 {
        let value = value.wrapping_add(self.fraction[axis]);
        let near = (value >> self.shift).wrapping_add(self.base[axis]);
        let rest = (value.wrapping_add(DOUBT) as u32) << (32 - self.shift);
        if rest < self.doubt { self.settle(axis, at, near) } else { near }
    }

    /// The number of the interval of a corner on a side, `near` or one close to it: a curve of the side's control points.
    ///
    /// With n segments and degree d, n^d·2^16·(S − border) is an integer: its weights stay below 3·2^30 for the 2^10 segments
    /// that there are at most, and it below 2^63.
    #[cold]
    #[inline(never)]
    fn settle(&self, axis: usize, at: [u32; 2], near: i32) -> i32 {
        let Piece { points, degrees, strides, along, across, .. } = &self.piece;
        let steps = [along.steps, across.steps];
        let is_column = at[1] != 0 && at[1] != steps[1];
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
        // More than a unit off where F is small.
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
