//! A run of points: their pixels, one coordinate after the other, then the depth test.

use super::super::depth::DepthWindow;
use super::super::tile::{is_nearest, occlude};

/// The most points of a run.
pub(super) const RUN: usize = 32;

/// What a coordinate may be off, in units of 2^-F.
pub(super) const DOUBT: u32 = 1024;

/// Bits that differences have more than values.
const MORE: u32 = 4;

/// The points of a run: their pixels, and which were seen.
#[derive(Clone, Copy, Debug)]
pub(super) struct Points {
    /// Rows first, from the origin on, then the index of the pixel in the tile.
    pub(super) index: [u32; RUN],
    pub(super) depths: [u16; RUN],
    pub(super) seen: [u8; RUN],
    pub(super) levels: [u8; RUN],
}

impl Points {
    pub(super) const fn new() -> Self {
        Self { index: [0; RUN], depths: [0; RUN], seen: [0; RUN], levels: [0; RUN] }
    }
}

/// A walk along a row: a value in 2^-F, its differences in 2^-(F + [`MORE`]).
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Line {
    pub(super) value: i32,
    pub(super) first: i32,
    pub(super) second: i32,
    pub(super) third: i32,
}

impl Line {
    #[inline(always)]
    pub(super) fn step(&mut self) {
        self.value = self.value.wrapping_add(self.first >> MORE);
        self.first = self.first.wrapping_add(self.second);
        self.second = self.second.wrapping_add(self.third);
    }

    /// Leaves out some points.
    #[inline(never)]
    pub(super) fn skip(&mut self, count: usize) {
        for _ in 0..count {
            self.step();
            core::hint::black_box(());
        }
    }
}

/// How values become pixels of a tile. Values are [`DOUBT`] more than the coordinate plus 1/2: as long as the fraction of
/// the sum is 2·`DOUBT` or more, its whole part is the pixel.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pixels {
    /// F.
    bits: u32,
}

/// Where columns and rows from the origin on are in a tile.
#[derive(Clone, Copy, Debug)]
pub(super) struct Raster {
    /// What is added to a column and to a row.
    pub(super) starts: [i32; 2],
    pub(super) width: u32,
    pub(super) height: u32,
}

impl Raster {
    #[inline(always)]
    fn has_row(&self, row: u32) -> bool {
        row.wrapping_add(self.starts[1] as u32) < self.height
    }

    /// The index of a pixel whose column is in the tile: that of none where its row is not.
    #[inline(always)]
    fn index(&self, row: u32, column: i32) -> u32 {
        row.wrapping_mul(self.width).wrapping_add(column as u32).wrapping_add(self.first())
    }

    /// The index of the origin.
    #[inline(always)]
    fn first(&self) -> u32 {
        (self.starts[1] as u32).wrapping_mul(self.width).wrapping_add(self.starts[0] as u32)
    }

    /// The same for any column.
    #[inline(always)]
    fn clipped(&self, row: u32, column: i32) -> u32 {
        let is_inside = (column.wrapping_add(self.starts[0]) as u32) < self.width;
        if is_inside { self.index(row, column) } else { u32::MAX }
    }

    /// The points between the first and the last whose row is in the tile.
    #[inline(never)]
    pub(super) fn trim(&self, rows: &[u32]) -> (usize, usize) {
        let first = rows.iter().position(|row| self.has_row(*row)).unwrap_or(rows.len());
        (first, rows.iter().rposition(|row| self.has_row(*row)).map_or(first, |last| last + 1))
    }
}

impl Pixels {
    pub(super) fn new(bits: u32) -> Self {
        Self { bits: bits & 31 }
    }

    /// What is not 0 where the fraction of a value is less than 2·[`DOUBT`], shifted left by F.
    #[inline(always)]
    fn doubt(value: i32) -> i32 {
        value ^ value.wrapping_sub(2 * DOUBT as i32)
    }

    /// Writes pixels along one axis, from the origin on; whether all are sure.
    #[inline(never)]
    pub(super) fn rows(&self, line: &Line, out: &mut [u32]) -> bool {
        let bits = self.bits & 31;
        let (mut line, mut doubt) = (*line, 0);
        in_pairs(out, |out| {
            doubt |= Self::doubt(line.value);
            *out = (line.value >> bits) as u32;
            line.step();
        });
        doubt >> bits == 0
    }

    /// Makes indices of rows; whether all columns are sure. All must be in the tile.
    #[inline(never)]
    pub(super) fn columns(&self, line: &Line, raster: &Raster, index: &mut [u32]) -> bool {
        let (bits, width, start) = (self.bits & 31, raster.width, raster.first());
        let (mut line, mut doubt) = (*line, 0);
        in_pairs(index, |index| {
            doubt |= Self::doubt(line.value);
            let column = (line.value >> bits) as u32;
            *index = index.wrapping_mul(width).wrapping_add(column).wrapping_add(start);
            line.step();
        });
        doubt >> bits == 0
    }

    /// The same where columns may be outside the tile: their index is the largest number. `settle` decides where one is not
    /// sure.
    #[inline(never)]
    pub(super) fn clipped_columns(
        &self,
        line: &Line,
        raster: &Raster,
        index: &mut [u32],
        settle: &mut dyn FnMut(usize, i32) -> i32,
    ) {
        let (mut line, bits) = (*line, self.bits & 31);
        for (k, index) in index.iter_mut().enumerate() {
            let mut column = line.value >> bits;
            if Self::doubt(line.value) >> bits != 0 {
                column = settle(k, column);
            }
            *index = raster.clipped(*index, column);
            line.step();
        }
    }

    /// Adds to the points of a run that are in doubt how far off they are, by `settle`, which is told what they seem.
    #[cold]
    #[inline(never)]
    pub(super) fn settle(&self, line: &Line, out: &mut [u32], settle: &mut dyn FnMut(usize, i32) -> i32) {
        let mut line = *line;
        for (k, out) in out.iter_mut().enumerate() {
            if Self::doubt(line.value) >> self.bits != 0 {
                let near = line.value >> self.bits;
                *out = out.wrapping_add_signed(settle(k, near).wrapping_sub(near));
            }
            line.step();
        }
    }
}

/// How values become depths.
#[derive(Clone, Copy, Debug)]
pub(super) struct Depths {
    window: DepthWindow,
    /// From values to the unit of depths.
    shift: u32,
    /// The whole pixels of the origin.
    base: i32,
    /// Whether all depths are sure to be within the window.
    is_inside: bool,
}

impl Depths {
    /// For a piece whose values have F = `bits` fraction bits and lie between `low` and `high`, from an origin of so many
    /// whole pixels.
    pub(super) fn new(window: DepthWindow, bits: u32, base: i32, [low, high]: [i32; 2]) -> Self {
        let shift = bits.saturating_sub(window.bits) & 31;
        let is_within = |value: i32| window.is_within(base, value >> shift);
        Self { window, shift, base, is_inside: bits >= 16 && is_within(low) && is_within(high) }
    }

    /// Finds the depths of a run.
    pub(super) fn of(&self, line: &Line, out: &mut [u16]) {
        if self.is_inside && self.window.is_whole() {
            self.each::<true>(line, out);
        } else {
            self.each::<false>(line, out);
        }
    }

    #[inline(never)]
    fn each<const WHOLE: bool>(&self, line: &Line, out: &mut [u16]) {
        let (shift, base) = (self.shift & 31, self.window.parts_of_whole(self.base));
        let mut line = *line;
        in_pairs(out, |out| {
            let rest = line.value >> shift;
            *out = if WHOLE { base.wrapping_add(rest) as u16 } else { self.window.depth_of_parts(self.base, rest) };
            line.step();
        });
    }
}

/// Calls `f` for all of a run: for two at a time, which then keep their state where it is.
#[inline(always)]
fn in_pairs<T>(all: &mut [T], mut f: impl FnMut(&mut T)) {
    let (pairs, rest) = all.as_chunks_mut::<2>();
    for [one, other] in pairs {
        f(one);
        f(other);
        // Runs are short: this keeps the compiler from unrolling the loop further.
        core::hint::black_box(());
    }
    rest.iter_mut().for_each(f);
}

/// Stores those depths of a run that are nearest; writes down which points were seen, by how many come after, of neighbours on
/// one pixel the last, and returns how many.
#[inline(never)]
pub(super) fn test(index: &[u32], depths: &[u16], stored: &mut [u16], seen: &mut [u8; RUN]) -> usize {
    let (mut count, mut last) = (0, u32::MAX);
    let mut left = index.len().min(depths.len());
    for (index, depth) in index.iter().zip(depths) {
        left = left.wrapping_sub(1);
        if let Some(stored) = stored.get_mut(*index as usize)
            && is_nearest(stored, *depth)
        {
            count += usize::from(*index != last);
            last = *index;
            seen[count.wrapping_sub(1) & (RUN - 1)] = left as u8;
        }
        core::hint::black_box(());
    }
    count
}

/// Stores the depths that are nearest, without colours.
#[inline(never)]
pub(super) fn hide(index: &[u32], depths: &[u16], stored: &mut [u16]) {
    for (index, depth) in index.iter().zip(depths) {
        if let Some(stored) = stored.get_mut(*index as usize) {
            occlude(stored, *depth);
        }
    }
}
