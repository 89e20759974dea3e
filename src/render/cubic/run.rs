//! A run of points: their pixels, one coordinate after the other, then the depth test.

use super::super::depth::DepthWindow;
use super::super::tile::{is_nearest, occlude};
use super::MORE;

/// The most points of a run.
pub(super) const RUN: usize = 32;

/// What a coordinate may be off, in units of 2^-F.
pub(super) const DOUBT: u32 = 1024;

/// The points of a run: the column and the row in the tile, the index of the pixel, and which
/// were seen.
#[derive(Clone, Copy, Debug)]
pub(super) struct Points {
    pub(super) columns: [u16; RUN],
    pub(super) rows: [u16; RUN],
    pub(super) index: [u32; RUN],
    pub(super) seen: [u8; RUN],
}

impl Points {
    pub(super) const fn new() -> Self {
        Self { columns: [0; RUN], rows: [0; RUN], index: [0; RUN], seen: [0; RUN] }
    }
}

/// A walk along a row: a value in 2^-F, its differences in 2^-(F + [`MORE`]).
#[derive(Clone, Copy, Debug)]
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
}

/// How values become pixels of a tile. Values are [`DOUBT`] more than the coordinate plus 1/2: as long as the fraction of
/// the sum is 2·`DOUBT` or more, its whole part is the pixel.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pixels {
    /// F.
    bits: u32,
    /// 32 − F, and 2·`DOUBT` shifted left by as much; everything where even a whole pixel is not sure.
    up: u32,
    doubt: u32,
}

impl Pixels {
    pub(super) fn new(bits: u32) -> Self {
        let up = 32_u32.wrapping_sub(bits) & 31;
        Self { bits: bits & 31, up, doubt: if bits > 11 { (2 * DOUBT) << up } else { u32::MAX } }
    }

    /// Writes columns, counted from `start` pixels before the origin; whether all are sure. `CLIP`: some may be outside the
    /// tile; those become the largest number.
    #[inline(never)]
    pub(super) fn columns<const CLIP: bool>(&self, mut line: Line, out: &mut [u16], start: i32) -> bool {
        let (up, bits) = (self.up & 31, self.bits & 31);
        let mut least = u32::MAX;
        for out in out {
            least = least.min((line.value as u32) << up);
            *out = short::<CLIP>((line.value >> bits).wrapping_add(start));
            line.step();
            // Runs are short: this keeps the compiler from unrolling the loop.
            core::hint::black_box(());
        }
        least >= self.doubt
    }

    /// Writes rows, counted likewise, and indices; whether all are sure. `CLIP`: indices of rows from `height` on are the
    /// largest number.
    #[inline(never)]
    pub(super) fn rows<const CLIP: bool>(
        &self,
        mut line: Line,
        points: &mut Points,
        count: usize,
        start: i32,
        [width, height]: [u32; 2],
    ) -> bool {
        let (up, bits) = (self.up & 31, self.bits & 31);
        let mut least = u32::MAX;
        let out = points.rows.iter_mut().zip(&mut points.index);
        for ((row, index), column) in out.zip(&points.columns).take(count) {
            least = least.min((line.value as u32) << up);
            let pixel = (line.value >> bits).wrapping_add(start);
            *index = indexed::<CLIP>(pixel, *column, [width, height]);
            *row = pixel as u16;
            line.step();
            core::hint::black_box(());
        }
        least >= self.doubt
    }

    /// Calls `settle` for the points of a run that are in doubt.
    #[cold]
    #[inline(never)]
    pub(super) fn each_doubtful(&self, mut line: Line, count: usize, settle: &mut dyn FnMut(usize, i32)) {
        for k in 0..count {
            if ((line.value as u32) << self.up) < self.doubt {
                settle(k, line.value >> self.bits);
            }
            line.step();
        }
    }
}

/// A column or row that is in a tile, or the largest number.
#[inline(always)]
pub(super) fn short<const CLIP: bool>(pixel: i32) -> u16 {
    if CLIP { u16::try_from(pixel).unwrap_or(u16::MAX) } else { pixel as u16 }
}

/// The index of a pixel; `CLIP`: the largest number where its row is not in the tile.
#[inline(always)]
pub(super) fn indexed<const CLIP: bool>(row: i32, column: u16, [width, height]: [u32; 2]) -> u32 {
    let index = (row as u32).wrapping_mul(width).wrapping_add(column.into());
    if CLIP && row as u32 >= height { u32::MAX } else { index }
}

impl Points {
    /// Takes back the indices of points whose columns are not in the tile.
    #[inline(never)]
    pub(super) fn clip(&mut self, count: usize, width: u32) {
        for (index, column) in self.index.iter_mut().zip(&self.columns).take(count) {
            if u32::from(*column) >= width {
                *index = u32::MAX;
            }
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
        Self { window, shift, base, is_inside: is_within(low) && is_within(high) }
    }

    /// Tests the depths of a run and stores those that are nearest; writes down which points were seen, of neighbours on one
    /// pixel the last, and returns how many.
    pub(super) fn test(&self, line: Line, index: &[u32], depths: &mut [u16], seen: &mut [u8; RUN]) -> usize {
        if self.is_inside {
            self.test_all::<true>(line, index, depths, seen)
        } else {
            self.test_all::<false>(line, index, depths, seen)
        }
    }

    #[inline(never)]
    fn test_all<const INSIDE: bool>(
        &self,
        mut line: Line,
        index: &[u32],
        depths: &mut [u16],
        seen: &mut [u8; RUN],
    ) -> usize {
        let (mut count, mut last) = (0, u32::MAX);
        for (k, index) in index.iter().enumerate() {
            if let Some(stored) = depths.get_mut(*index as usize) {
                let depth = self.window.depth_of_parts::<INSIDE>(self.base, line.value >> self.shift);
                if is_nearest(stored, depth) {
                    count += usize::from(*index != last);
                    last = *index;
                    seen[count.wrapping_sub(1) & (RUN - 1)] = k as u8;
                }
            }
            line.step();
            core::hint::black_box(());
        }
        count
    }

    /// Stores the depths that are nearest, without colours.
    #[inline(never)]
    pub(super) fn hide(&self, mut line: Line, index: &[u32], depths: &mut [u16]) {
        for index in index {
            if let Some(stored) = depths.get_mut(*index as usize) {
                occlude(stored, self.window.depth_of_parts::<false>(self.base, line.value >> self.shift));
            }
            line.step();
        }
    }
}
