//! Fills a convex facet: integer spans, depth and level as linear functions of the pixel.

use super::super::tile::{Fragment, Paint, Tile};
use super::Output;
use super::vertices::Vertex;
use crate::num::{exact_reciprocal, multiply, reciprocal, times_256th};

/// A convex facet, its corners clockwise on the screen; of a triangle two neighbouring corners are one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::render) struct Quad {
    /// Less than 2^15 apart, their levels those of the side that is seen.
    pub(super) corners: [Vertex; 4],
    /// The first row of pixel centres, and the one after the last.
    pub(super) rows: [i32; 2],
    pub(super) patch: usize,
    /// Whether it may leave the columns of the output.
    pub(super) is_wide: bool,
}

impl Quad {
    /// The facet with these corners.
    pub(super) fn new(corners: [Vertex; 4], patch: usize, is_wide: bool) -> Self {
        let [a, b, c, d] = corners.each_ref().map(|corner| corner.y);
        Self { corners, rows: rows([a, b, c, d]), patch, is_wide }
    }
}

/// The first row of pixel centres between the least and the greatest of four coordinates, and the one after the last.
#[inline(always)]
pub(super) fn rows([a, b, c, d]: [i32; 4]) -> [i32; 2] {
    [centre(a.min(b).min(c).min(d)), centre(a.max(b).max(c).max(d))]
}

/// The first pixel centre from a coordinate on.
#[inline(always)]
pub(super) fn centre(c: i32) -> i32 {
    (c + 255) >> 8
}

/// The most rows of a facet, and of columns on either side of a corner.
const ROWS: usize = 128;

/// Where the spans of a facet start and end, row by row, counted from a column that is left of all.
type Ends = [[u8; 2]; ROWS];

/// The side from `top` down to `bottom`: its x at `row` in 2^-16 pixel, and what a row adds.
///
/// It depends on the two vertices alone. The step errs by less than 2^-15 of itself, which is 1/128 pixel over a side of
/// 127; its product is formed modulo 2^32, and x itself fits.
#[inline(always)]
fn edge(top: &Vertex, bottom: &Vertex, row: i32) -> [i32; 2] {
    let (reciprocal, zeros) = exact_reciprocal((bottom.y - top.y) as u32);
    // 2^16·(x1 − x0)/(y1 − y0): factors of 15 and 16 bits and a sign.
    let step = (bottom.x - top.x).wrapping_mul(reciprocal as i32) >> ((31 - zeros) & 31);
    let moved = times_256th(step, (row << 8) - top.y);
    [(top.x << 8).wrapping_add(moved), step]
}

/// Writes where a facet's spans start and end in the rows from `row` to before `last`, counted from `column`. Whether both
/// flanks are complete, in all rows of the facet; where some are not asked for it is `CUT`.
#[inline(never)]
fn flanks<const CUT: bool>(quad: &Quad, column: i32, [row, last]: [i32; 2], ends: &mut Ends) -> bool {
    // A little less than one pixel more: shifted right it is the first centre.
    let start = 0xffff_i32.wrapping_sub(column << 16);
    let [first, end] = quad.rows;
    let mut side = |top: &Vertex, bottom: &Vertex, [from, to]: [i32; 2], is_end: usize| {
        let count = to.wrapping_sub(from);
        let (from, to) = if CUT { (from.max(row), to.min(last)) } else { (from, to) };
        if CUT && from >= to {
            return count;
        }
        let Some(ends) = ends.get_mut(from.wrapping_sub(row) as usize..to.wrapping_sub(row) as usize) else { return 0 };
        let [x, step] = edge(top, bottom, from);
        let mut x = x.wrapping_add(start);
        for end in ends {
            end[is_end] = (x >> 16) as u8;
            x = x.wrapping_add(step);
            // Sides are short: unrolled, this loop would cost more.
            core::hint::black_box(());
        }
        count
    };
    let (mut from, mut rows) = (&quad.corners[3], 0);
    let mut above = centre(from.y);
    for to in &quad.corners {
        let below = centre(to.y);
        // Corners are clockwise: what goes down ends spans.
        if below > above {
            rows += side(from, to, [above, below], 1);
        } else if below < above {
            rows += side(to, from, [below, above], 0);
        }
        (from, above) = (to, below);
    }
    rows == 2 * (end - first) && (!CUT || end - first <= ROWS as i32)
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

/// A facet is thin where its longer diagonal squared is more than this times twice its area. Slopes have relative errors
/// below 2^-14, and values at most 2^-8 of their range then.
const THIN: u32 = 32;

/// The index of the least and the greatest of four.
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

/// The planes of depth and level over a facet, from the pixel `start` on: through the mean of the corners, a quarter of
/// `sums`, along both diagonals as the corners say.
#[inline(never)]
fn planes(quad: &Quad, sums: [i32; 2], start: [i32; 2]) -> [Plane; 2] {
    let [x, y] = [quad.corners.each_ref().map(|c| c.x), quad.corners.each_ref().map(|c| c.y)];
    let (p, q) = ([x[2] - x[0], y[2] - y[0]], [x[3] - x[1], y[3] - y[1]]);
    // At most 2·127²·2^16 < 2^31: the facet is convex.
    let area = p[0].wrapping_mul(q[1]).wrapping_sub(p[1].wrapping_mul(q[0])).max(0).unsigned_abs();
    let square = |d: [i32; 2]| d[0].wrapping_mul(d[0]).wrapping_add(d[1].wrapping_mul(d[1])) as u32;
    let length = square(p).max(square(q));
    if length < 1 << 16 || length / THIN > area {
        return lines(quad, start);
    }
    let (reciprocal, zeros) = reciprocal(area);
    let mean = Base::new([x[0] + x[1] + x[2] + x[3], y[0] + y[1] + y[2] + y[3]], start);
    // Factors below 2^15 and of at most 2^15: the products' difference fits. A pixel is 2^8 units; the reciprocal is 2^15
    // times the inverse of the area shifted up by its zeros, and the product 2^17 less.
    let slopes = |v: [i32; 4]| {
        let (dp, dq) = (v[2] - v[0], v[3] - v[1]);
        let cross = |a: i32, b: i32| dp.wrapping_mul(a).wrapping_sub(dq.wrapping_mul(b));
        [multiply(cross(q[1], p[1]), reciprocal), multiply(cross(q[0], p[0]), reciprocal).wrapping_neg()]
    };
    let depth = quad.corners.each_ref().map(|c| i32::from(c.depth));
    let [by_x, by_y] = slopes(depth);
    let up = DEPTH_BITS - 22 + zeros as i32;
    let depth_slopes = if up <= 0 {
        [by_x >> -up, by_y >> -up]
    } else if ((by_x ^ (by_x >> 31)) | (by_y ^ (by_y >> 31))) as u32 >> (31 - up) == 0 {
        [by_x << up, by_y << up]
    } else {
        // Steeper than 2^31 to a pixel: constant.
        [0; 2]
    };
    let level = quad.corners.each_ref().map(|c| i32::from(c.level));
    let [by_x, by_y] = slopes(level);
    // Levels, of 8 bits, cannot be as steep: no facet here is thinner than 1/64 pixel.
    let up = LEVEL_BITS - 22 + zeros as i32;
    let level_slopes = if up <= 0 { [by_x >> -up, by_y >> -up] } else { [by_x << up, by_y << up] };
    [
        Plane::new(depth_slopes, sums[0] << (DEPTH_BITS - 2), &mean),
        Plane::new(level_slopes, sums[1] << (LEVEL_BITS - 2), &mean),
    ]
}

/// The planes over a thin facet, linear along x or y only, from one corner to another one; over one below a pixel,
/// constant.
#[cold]
#[inline(never)]
fn lines(quad: &Quad, start: [i32; 2]) -> [Plane; 2] {
    let [x, y] = [quad.corners.each_ref().map(|c| c.x), quad.corners.each_ref().map(|c| c.y)];
    let [width, height] = [&x, &y].map(|c| bounds(c).1 - bounds(c).0);
    let along_y = height > width;
    let (from, to) = extremes(if along_y { &y } else { &x });
    let length = width.max(height);
    let base = Base::new([4 * x[from & 3], 4 * y[from & 3]], start);
    let line = |v: [i32; 4], bits: i32| {
        let slope = (i64::from(v[to & 3] - v[from & 3]) << (8 + bits)).checked_div(length.into()).unwrap_or(0);
        match i32::try_from(slope) {
            Ok(slope) if length >= 256 => {
                Plane::new(if along_y { [0, slope] } else { [slope, 0] }, v[from & 3] << bits, &base)
            }
            _ => Plane { by_x: 0, by_y: 0, start: (v[0] + v[1] + v[2] + v[3]) << (bits - 2) },
        }
    };
    [
        line(quad.corners.each_ref().map(|c| i32::from(c.depth)), DEPTH_BITS),
        line(quad.corners.each_ref().map(|c| i32::from(c.level)), LEVEL_BITS),
    ]
}

/// How far a plane may be from the corners of a quad: 4 times 12 levels, 4 times 1/128 of the depths.
const WARP: (u32, u32) = (48, 1024);

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
        Self { tile, paint, window, ends: [[0; 2]; ROWS] }
    }
}

impl<P: Paint> Output for Filler<'_, '_, P> {
    fn window(&self) -> [i32; 4] {
        self.window
    }

    fn facet(&mut self, quad: &Quad) {
        if !self.fill(quad, true) {
            self.warped(quad);
        }
    }
}

impl<P: Paint> Filler<'_, '_, P> {
    /// A facet that is no plane, as two triangles; or a triangle.
    #[cold]
    #[inline(never)]
    fn warped(&mut self, quad: &Quad) {
        let [a, b, c, d] = quad.corners;
        if [c.x, c.y] == [d.x, d.y] {
            self.fill(quad, false);
            return;
        }
        self.fill(&Quad::new([a, b, c, c], quad.patch, quad.is_wide), false);
        self.fill(&Quad::new([a, c, d, d], quad.patch, quad.is_wide), false);
    }

    /// Fills a facet as a plane, unless that is to be `checked` and it is too far from one: returns false then.
    #[inline(never)]
    fn fill(&mut self, quad: &Quad, checked: bool) -> bool {
        let [left, right, top, bottom] = self.window;
        let [first, end] = quad.rows;
        let (row, end) = (first.max(top), end.min(bottom));
        if row >= end {
            return true;
        }
        let [a, b, c, d] = &quad.corners;
        // Sums along both diagonals: of a plane's corners they are alike.
        let levels = [u32::from(a.level) + u32::from(c.level), u32::from(b.level) + u32::from(d.level)];
        let depths = [u32::from(a.depth) + u32::from(c.depth), u32::from(b.depth) + u32::from(d.depth)];
        if checked && (levels[0].abs_diff(levels[1]) > WARP.0 || depths[0].abs_diff(depths[1]) > WARP.1) {
            return false;
        }
        let column = (a.x >> 8) - (ROWS as i32 - 1);
        let is_complete = if [row, end] == quad.rows {
            flanks::<false>(quad, column, [row, end], &mut self.ends)
        } else {
            flanks::<true>(quad, column, [row, end], &mut self.ends)
        };
        let rows = end.wrapping_sub(row) as usize;
        let (true, Some(ends)) = (is_complete, self.ends.get_mut(..rows)) else { return true };
        if quad.is_wide && is_beyond([a.x, b.x, c.x, d.x], left, right) {
            clip(ends, [left.wrapping_sub(column), right.wrapping_sub(column)]);
        }
        let sums = [depths[0] + depths[1], levels[0] + levels[1]];
        let [depth, level] = planes(quad, sums.map(|sum| sum as i32), [column, row]);
        let (_, colours, stored) = self.tile.parts();
        let Some(colours) = colours.get_mut(..stored.len()) else { return true };
        // The first column's values, rounded to the nearest level.
        let (mut z, mut s) = (depth.start, level.start.wrapping_add(1 << (LEVEL_BITS - 1)));
        let width = right.wrapping_sub(left);
        let mut offset = row.wrapping_sub(top).wrapping_mul(width).wrapping_add(column.wrapping_sub(left));
        for (y, [first, last]) in (row..).zip(ends.iter()) {
            let (first, last) = (i32::from(*first), i32::from(*last));
            let range = offset.wrapping_add(first) as usize..offset.wrapping_add(last) as usize;
            if first < last
                && range.end <= stored.len()
                && range.start < range.end
                && let (Some(colours), Some(depths)) = (colours.get_mut(range.clone()), stored.get_mut(range))
            {
                let z = z.wrapping_add(depth.by_x.wrapping_mul(first)) as u32;
                let s = s.wrapping_add(level.by_x.wrapping_mul(first));
                let at = Place { x: column.wrapping_add(first), y, patch: quad.patch };
                run(self.paint, (colours, depths), at, (z, s), [depth.by_x, level.by_x], last - first);
            }
            z = z.wrapping_add(depth.by_y);
            s = s.wrapping_add(level.by_y);
            offset = offset.wrapping_add(width);
        }
        true
    }
}

/// A pixel, and the patch.
#[derive(Clone, Copy)]
struct Place {
    x: i32,
    y: i32,
    patch: usize,
}

/// Whether some columns are not from `left` to before `right`.
#[inline(always)]
fn is_beyond(x: [i32; 4], left: i32, right: i32) -> bool {
    let (least, greatest) = bounds(&x);
    least >> 8 < left || greatest >> 8 >= right - 1
}

/// Cuts spans to the columns from `left` to before `right`.
#[cold]
#[inline(never)]
fn clip(ends: &mut [[u8; 2]], [left, right]: [i32; 2]) {
    for end in ends.as_flattened_mut() {
        *end = i32::from(*end).max(left).min(right).clamp(0, 255) as u8;
    }
}

/// Whether the target limits a number to 8 bits in one instruction: then levels are not looked at before.
const SATURATES: bool = cfg!(all(target_arch = "arm", target_has_atomic = "32"));

/// Fills a run of pixels of one row.
#[inline(always)]
fn run<P: Paint>(
    paint: &P,
    pixels: (&mut [P::Pixel], &mut [u16]),
    at: Place,
    (z, s): (u32, i32),
    [depth_by_x, level_by_x]: [i32; 2],
    length: i32,
) {
    if SATURATES {
        return span::<P, true>(paint, pixels, at, (z, s), [depth_by_x, level_by_x]);
    }
    // Levels are linear: where both ends are levels, all are.
    let end = s.wrapping_add(level_by_x.wrapping_mul(length - 1));
    if (s | end) as u32 >> (LEVEL_BITS + 8) == 0 {
        span::<P, false>(paint, pixels, at, (z, s << 8), [depth_by_x, level_by_x << 8]);
    } else {
        clamped(paint, pixels, at, (z, s), [depth_by_x, level_by_x]);
    }
}

/// `CLAMP`: the plane may leave the levels; else levels come with 8 more fraction bits.
#[inline(always)]
fn span<P: Paint, const CLAMP: bool>(
    paint: &P,
    (colours, depths): (&mut [P::Pixel], &mut [u16]),
    Place { mut x, y, patch }: Place,
    (mut z, mut s): (u32, i32),
    [depth_by_x, level_by_x]: [i32; 2],
) {
    for (colour, stored) in colours.iter_mut().zip(depths) {
        let depth = z >> 16;
        // The lowest bit is no depth yet: it decides nothing, for what is stored is even, or larger than any.
        if depth < u32::from(*stored) {
            *stored = depth as u16 & !1;
            let shade =
                if CLAMP { (s >> LEVEL_BITS).clamp(0, 255) as u8 } else { (s as u32 >> (LEVEL_BITS + 8)) as u8 };
            *colour = paint.pixel(Fragment { x, y, patch, shade });
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
fn clamped<P: Paint>(paint: &P, pixels: (&mut [P::Pixel], &mut [u16]), at: Place, start: (u32, i32), slopes: [i32; 2]) {
    span::<P, true>(paint, pixels, at, start, slopes);
}
