//! Fills a convex facet: integer spans, depth and level as linear functions of the pixel.

use super::super::tile::{Fragment, Paint, Tile};
use super::Output;
use crate::num::{multiply, reciprocal};

/// A convex facet, its corners clockwise on the screen; of a triangle two neighbouring corners are one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::render) struct Quad {
    /// In 1/256 pixel, less than 2^15 apart.
    pub(super) x: [i32; 4],
    pub(super) y: [i32; 4],
    pub(super) depth: [u16; 4],
    pub(super) level: [u8; 4],
    pub(super) patch: usize,
}

impl Quad {
    /// The facet of these corners.
    pub(super) fn corners(&self, index: [usize; 4]) -> Self {
        let (x, y) = (index.map(|k| self.x[k & 3]), index.map(|k| self.y[k & 3]));
        Self { x, y, depth: index.map(|k| self.depth[k & 3]), level: index.map(|k| self.level[k & 3]), ..*self }
    }
}

/// The first pixel centre from a coordinate on.
#[inline(always)]
fn centre(c: i32) -> i32 {
    (c + 255) >> 8
}

/// The most rows of a facet, and of columns from its leftmost one to where its spans end.
const ROWS: usize = 128;

/// Where the spans of a facet start and end, row by row, counted from its leftmost column.
type Ends = [[u8; ROWS]; 2];

/// The side from (x0, y0) down to (x1, y1): its x at `row` in 2^-16 pixel, and what a row adds.
///
/// It depends on the two vertices alone. The step errs by less than 2^-15 of itself, which is 1/128 pixel over a side of
/// 127; its product is formed modulo 2^32, and x itself fits.
#[inline(always)]
fn edge([x0, y0]: [i32; 2], [x1, y1]: [i32; 2], row: i32) -> [i32; 2] {
    let (reciprocal, zeros) = reciprocal((y1 - y0).max(1).unsigned_abs());
    // 2^16·(x1 − x0)/(y1 − y0): factors of 15 and 16 bits.
    let step = (x1 - x0).wrapping_mul(reciprocal as i32) >> (31 - zeros);
    let down = (row << 8) - y0;
    let moved = (step >> 8).wrapping_mul(down).wrapping_add((step & 255).wrapping_mul(down) >> 8);
    [(x0 << 8).wrapping_add(moved), step]
}

/// Writes where one of the two flanks of a facet is in the rows from `row` on, going down from corner `top`; `turn` is 1
/// or 3: to the next corner or to the one before. Returns the row after the last one.
#[inline(never)]
fn flank(quad: &Quad, [top, turn]: [usize; 2], row: i32, column: i32, ends: &mut [u8]) -> i32 {
    let (mut from, mut now, mut rest) = (top & 3, row, ends);
    for _ in 0..3 {
        let to = (from + turn) & 3;
        let rows = centre(quad.y[to]) - now;
        if rows > 0 {
            let [mut x, step] = edge([quad.x[from], quad.y[from]], [quad.x[to], quad.y[to]], now);
            // A little less than one pixel more: shifted right it is the first centre.
            x = x.wrapping_add(0xffff).wrapping_sub(column << 16);
            let rows = rows.min(rest.len() as i32);
            let Some((these, others)) = rest.split_at_mut_checked(rows as usize) else { return now };
            for end in these {
                *end = (x >> 16) as u8;
                x = x.wrapping_add(step);
                // Sides are short: unrolled, this loop would cost more.
                core::hint::black_box(());
            }
            rest = others;
            now += rows;
            if rest.is_empty() {
                break;
            }
        }
        from = to;
        core::hint::black_box(());
    }
    now
}

/// A linear function of the pixel, modulo 2^32: right wherever its value fits.
#[derive(Clone, Copy, Debug)]
struct Plane {
    by_x: i32,
    by_y: i32,
    /// The value at the pixel where filling starts.
    start: i32,
}

impl Plane {
    /// The plane with these slopes and the value `value` at `from`.
    #[inline(always)]
    fn new([by_x, by_y]: [i32; 2], value: i32, from: &Base) -> Self {
        // Fractions of a pixel in 10 bits, by slopes without as many: 1/128 of a unit of depth, 1/64 of a level.
        let fraction =
            (by_x >> 10).wrapping_mul(from.fraction[0]).wrapping_add((by_y >> 10).wrapping_mul(from.fraction[1]));
        let whole = by_x.wrapping_mul(from.pixels[0]).wrapping_add(by_y.wrapping_mul(from.pixels[1]));
        Self { by_x, by_y, start: value.wrapping_add(whole).wrapping_sub(fraction) }
    }
}

/// A point that a plane goes through.
struct Base {
    /// From its pixel to the one where filling starts.
    pixels: [i32; 2],
    /// Its place in its pixel, in 2^-10.
    fraction: [i32; 2],
}

impl Base {
    /// A point, given four times.
    #[inline(always)]
    fn new([x, y]: [i32; 2], start: [i32; 2]) -> Self {
        Self {
            pixels: [start[0].wrapping_sub(x >> 10), start[1].wrapping_sub(y >> 10)],
            fraction: [x & 1023, y & 1023],
        }
    }
}

/// A facet is thin where its longer side squared is more than this times twice its area. Slopes have relative errors
/// below 2^-14, and values at most 2^-8 of their range then.
const THIN: u32 = 32;

/// The index of the least and the greatest of four.
#[inline(always)]
fn extremes(c: &[i32; 4]) -> (usize, usize) {
    let (mut least, mut greatest) = (0, 0);
    for k in 1..4 {
        least = if c[k] < c[least & 3] { k } else { least };
        greatest = if c[k] > c[greatest & 3] { k } else { greatest };
    }
    (least, greatest)
}

/// The least and the greatest of four.
#[inline(always)]
fn bounds(c: &[i32; 4]) -> (i32, i32) {
    (c[0].min(c[1]).min(c[2]).min(c[3]), c[0].max(c[1]).max(c[2]).max(c[3]))
}

/// The planes of depth and level over a facet of this width and height, from the pixel `start` on: through the mean of the
/// corners, along both diagonals as the corners say.
#[inline(always)]
fn planes(quad: &Quad, [width, height]: [i32; 2], start: [i32; 2]) -> [Plane; 2] {
    let (x, y) = (&quad.x, &quad.y);
    let (p, q) = ([x[2] - x[0], y[2] - y[0]], [x[3] - x[1], y[3] - y[1]]);
    // At most 2·127²·2^16 < 2^31: the facet is convex.
    let area = p[0].wrapping_mul(q[1]).wrapping_sub(p[1].wrapping_mul(q[0])).max(0).unsigned_abs();
    let length = width.max(height);
    if length < 256 || length.unsigned_abs().wrapping_mul(length.unsigned_abs()) / THIN > area {
        return lines(quad, [width, height], start);
    }
    let (reciprocal, zeros) = reciprocal(area);
    let mean = Base::new([x[0] + x[1] + x[2] + x[3], y[0] + y[1] + y[2] + y[3]], start);
    let plane = |v: [i32; 4], bits: i32| {
        let (dp, dq) = (v[2] - v[0], v[3] - v[1]);
        // Factors below 2^15 and of at most 2^15: the products' difference fits. A pixel is 2^8 units; the reciprocal is
        // 2^15 times the inverse of the area shifted up by its zeros, and the product 2^17 less.
        let cross = |a: i32, b: i32| dp.wrapping_mul(a).wrapping_sub(dq.wrapping_mul(b));
        let slope = |n: i32| multiply(n, reciprocal);
        let (by_x, by_y) = (slope(cross(q[1], p[1])), slope(cross(q[0], p[0])).wrapping_neg());
        let up = bits - 22 + zeros as i32;
        let slopes = if up <= 0 {
            [by_x >> -up, by_y >> -up]
        } else if bits == LEVEL_BITS || (by_x.unsigned_abs() | by_y.unsigned_abs()) >> (31 - up) == 0 {
            // Levels, of 8 bits, cannot be as steep: no facet here is thinner than 1/32 pixel.
            [by_x << up, by_y << up]
        } else {
            // Steeper than 2^31 to a pixel: constant.
            [0; 2]
        };
        Plane::new(slopes, (v[0] + v[1] + v[2] + v[3]) << (bits - 2), &mean)
    };
    [plane(quad.depth.map(i32::from), DEPTH_BITS), plane(quad.level.map(i32::from), LEVEL_BITS)]
}

/// The planes over a thin facet, linear along x or y only, from one corner to another one; over one below a pixel,
/// constant.
#[cold]
#[inline(never)]
fn lines(quad: &Quad, [width, height]: [i32; 2], start: [i32; 2]) -> [Plane; 2] {
    let along_y = height > width;
    let (from, to) = extremes(if along_y { &quad.y } else { &quad.x });
    let length = width.max(height);
    let base = Base::new([4 * quad.x[from & 3], 4 * quad.y[from & 3]], start);
    let line = |v: [i32; 4], bits: i32| {
        let slope = (i64::from(v[to & 3] - v[from & 3]) << (8 + bits)).checked_div(length.into()).unwrap_or(0);
        match i32::try_from(slope) {
            Ok(slope) if length >= 256 => {
                Plane::new(if along_y { [0, slope] } else { [slope, 0] }, v[from & 3] << bits, &base)
            }
            _ => Plane { by_x: 0, by_y: 0, start: (v[0] + v[1] + v[2] + v[3]) << (bits - 2) },
        }
    };
    [line(quad.depth.map(i32::from), DEPTH_BITS), line(quad.level.map(i32::from), LEVEL_BITS)]
}

/// Fraction bits of interpolated depths, which take 15 bits, and levels.
const DEPTH_BITS: i32 = 17;
const LEVEL_BITS: i32 = 16;

/// Fills facets in a tile.
pub(in crate::render) struct Filler<'f, 'b, P: Paint> {
    tile: &'f mut Tile<'b, P::Pixel>,
    paint: &'f P,
    window: [i32; 4],
    ends: Ends,
}

impl<'f, 'b, P: Paint> Filler<'f, 'b, P> {
    pub(in crate::render) fn new(tile: &'f mut Tile<'b, P::Pixel>, paint: &'f P) -> Self {
        let area = tile.area();
        let end = |start: i32, length: u32| start.saturating_add_unsigned(length);
        let window = [area.x, end(area.x, area.width), area.y, end(area.y, area.height)];
        Self { tile, paint, window, ends: [[0; ROWS]; 2] }
    }
}

impl<P: Paint> Output for Filler<'_, '_, P> {
    fn window(&self) -> [i32; 4] {
        self.window
    }

    #[inline(never)]
    fn facet(&mut self, quad: &Quad) {
        let [left, right, top, bottom] = self.window;
        let rows_of = extremes(&quad.y);
        let (low, high) = (quad.y[rows_of.0 & 3], quad.y[rows_of.1 & 3]);
        let (mut row, end) = (centre(low).max(top), centre(high).min(bottom));
        if row >= end {
            return;
        }
        let (x_min, x_max) = bounds(&quad.x);
        let column = x_min >> 8;
        let [depth, level] = planes(quad, [x_max - x_min, high - low], [column, row]);
        let [firsts, lasts] = &mut self.ends;
        let rows = end.wrapping_sub(row) as usize;
        let (Some(firsts), Some(lasts)) = (firsts.get_mut(..rows), lasts.get_mut(..rows)) else { return };
        let before = flank(quad, [rows_of.0, 3], row, column, firsts);
        let after = flank(quad, [rows_of.0, 1], row, column, lasts);
        if before.min(after) < end {
            return;
        }
        if column < left || x_max >> 8 >= right - 1 {
            clip(firsts, [left.wrapping_sub(column), right.wrapping_sub(column)]);
            clip(lasts, [left.wrapping_sub(column), right.wrapping_sub(column)]);
        }
        let (_, colours, depths) = self.tile.parts();
        let Some(colours) = colours.get_mut(..depths.len()) else { return };
        // The first column's values, rounded to the nearest level.
        let (mut z, mut s) = (depth.start, level.start.wrapping_add(1 << (LEVEL_BITS - 1)));
        let width = right.wrapping_sub(left);
        let mut offset = row.wrapping_sub(top).wrapping_mul(width).wrapping_add(column.wrapping_sub(left));
        for (first, last) in firsts.iter().zip(lasts) {
            let (first, last) = (i32::from(*first), i32::from(*last));
            let range = offset.wrapping_add(first) as usize..offset.wrapping_add(last) as usize;
            if first < last
                && let Some(colours) = colours.get_mut(range.clone())
                && let Some(depths) = depths.get_mut(range)
            {
                let z = z.wrapping_add(depth.by_x.wrapping_mul(first)) as u32;
                let s = s.wrapping_add(level.by_x.wrapping_mul(first));
                let at = (column.wrapping_add(first), row, quad.patch);
                let slopes = [depth.by_x, level.by_x];
                // Levels are linear: where both ends are levels, all are.
                let end = s.wrapping_add(level.by_x.wrapping_mul(last - 1 - first));
                if (s | end) as u32 >> (LEVEL_BITS + 8) == 0 {
                    span::<P, false>(self.paint, (colours, depths), at, (z, s), slopes);
                } else {
                    clamped(self.paint, (colours, depths), at, (z, s), slopes);
                }
            }
            z = z.wrapping_add(depth.by_y);
            s = s.wrapping_add(level.by_y);
            offset = offset.wrapping_add(width);
            row += 1;
        }
    }
}

/// Cuts spans to the columns from `left` to before `right`.
#[cold]
#[inline(never)]
fn clip(ends: &mut [u8], [left, right]: [i32; 2]) {
    for end in ends {
        *end = i32::from(*end).max(left).min(right).clamp(0, 255) as u8;
    }
}

/// Fills a run of pixels of one row from column x on.
#[inline(always)]
fn span<P: Paint, const CLAMP: bool>(
    paint: &P,
    (colours, depths): (&mut [P::Pixel], &mut [u16]),
    (mut x, y, patch): (i32, i32, usize),
    (mut z, mut s): (u32, i32),
    [depth_by_x, level_by_x]: [i32; 2],
) {
    for (colour, stored) in colours.iter_mut().zip(depths) {
        let depth = z >> 16;
        // The lowest bit is no depth yet: it decides nothing, for what is stored is even, or larger than any.
        if depth < u32::from(*stored) {
            *stored = depth as u16 & !1;
            let shade = if CLAMP { (s >> LEVEL_BITS).clamp(0, 255) } else { s >> LEVEL_BITS };
            *colour = paint.pixel(Fragment { x, y, patch, shade: shade as u8 });
        } else {
            // Runs are short: this keeps the compiler from unrolling the loop, which costs more than it saves.
            core::hint::black_box(());
        }
        z = z.wrapping_add(depth_by_x as u32);
        s = s.wrapping_add(level_by_x);
        x = x.wrapping_add(1);
    }
}

/// The same, where a plane leaves the levels.
#[cold]
#[inline(never)]
fn clamped<P: Paint>(
    paint: &P,
    pixels: (&mut [P::Pixel], &mut [u16]),
    at: (i32, i32, usize),
    start: (u32, i32),
    slopes: [i32; 2],
) {
    span::<P, true>(paint, pixels, at, start, slopes);
}
