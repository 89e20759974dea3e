//! Fills a convex facet: integer spans, depth and level as linear functions of the pixel.

use super::super::tile::{Fragment, Paint, Tile};
use super::Output;

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

/// A side of a facet on its way down.
#[derive(Clone, Copy, Debug)]
struct Edge {
    /// The x of the row in 2^-16 pixel, a little less than one pixel added: shifted right it is the first centre.
    x: i32,
    /// What a row adds.
    step: i32,
    /// The row after its last one.
    end: i32,
}

/// The first pixel centre from a coordinate on.
fn centre(c: i32) -> i32 {
    (c + 255) >> 8
}

impl Edge {
    const NONE: Self = Self { x: 0, step: 0, end: i32::MIN };

    /// The side from (x0, y0) down to (x1, y1), with rows up to `end` (excluded), at `row`.
    ///
    /// It depends on the two vertices alone. |x1 − x0| < 2^15, so the quotient fits 32 bits; the product is formed
    /// modulo 2^32, and x itself fits.
    fn new(x0: i32, y0: i32, x1: i32, y1: i32, end: i32, row: i32) -> Self {
        let step = ((x1 - x0) << 16).checked_div(y1 - y0).unwrap_or(0);
        let down = (row << 8) - y0;
        let moved = (step >> 8).wrapping_mul(down).wrapping_add((step & 255).wrapping_mul(down) >> 8);
        Self { x: (x0 << 8).wrapping_add(moved).wrapping_add(0xffff), step, end }
    }

    #[inline(always)]
    fn advance(&mut self, rows: i32) {
        self.x = self.x.wrapping_add(self.step.wrapping_mul(rows));
    }
}

/// The sides of a facet that go down on one of its two flanks, one after the other.
#[derive(Clone, Copy, Debug)]
struct Flank<'q> {
    quad: &'q Quad,
    /// The corner that the current side ends in.
    corner: usize,
    /// 1 or 3: to the next corner or to the one before.
    turn: usize,
    edge: Edge,
}

impl<'q> Flank<'q> {
    fn new(quad: &'q Quad, top: usize, turn: usize) -> Self {
        Self { quad, corner: top, turn, edge: Edge::NONE }
    }

    /// Moves on to the side that has `row`.
    #[inline(always)]
    fn reach(&mut self, row: i32) {
        let mut sides = 0;
        while self.edge.end <= row && sides < 4 {
            let (from, to) = (self.corner & 3, (self.corner + self.turn) & 3);
            let (x, y) = (&self.quad.x, &self.quad.y);
            let end = centre(y[to]);
            if end > row {
                self.edge = Edge::new(x[from], y[from], x[to], y[to], end, row);
            }
            self.corner = to;
            sides += 1;
        }
    }
}

/// A linear function of the pixel, modulo 2^32: right wherever its value fits.
#[derive(Clone, Copy, Debug)]
struct Plane {
    by_x: i32,
    by_y: i32,
    /// The value at pixel (0, 0).
    origin: i32,
}

impl Plane {
    /// The same slopes, with the value `origin` at a point, given four times.
    #[inline(always)]
    fn through(self, at: [i32; 2]) -> Self {
        let Self { by_x, by_y, origin } = self;
        let offset = |slope: i32, at: i32| {
            let fraction = at & 1023;
            (slope >> 10).wrapping_mul(fraction).wrapping_add((slope & 1023).wrapping_mul(fraction) >> 10)
        };
        let origin = origin.wrapping_sub(offset(by_x, at[0])).wrapping_sub(offset(by_y, at[1]));
        let origin = origin.wrapping_sub(by_x.wrapping_mul(at[0] >> 10)).wrapping_sub(by_y.wrapping_mul(at[1] >> 10));
        Self { by_x, by_y, origin }
    }

    /// The value at pixel (x, y).
    #[inline(always)]
    fn at(&self, x: i32, y: i32) -> i32 {
        self.origin.wrapping_add(self.by_x.wrapping_mul(x)).wrapping_add(self.by_y.wrapping_mul(y))
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

/// The planes of depth and level over a facet of this height: through the mean of the corners, along both diagonals as
/// the corners say.
#[inline(always)]
fn planes(quad: &Quad, height: i32) -> [Plane; 2] {
    let (x, y) = (&quad.x, &quad.y);
    let (p, q) = ([x[2] - x[0], y[2] - y[0]], [x[3] - x[1], y[3] - y[1]]);
    // At most 2·127²·2^16 < 2^31: the facet is convex.
    let area = p[0].wrapping_mul(q[1]).wrapping_sub(p[1].wrapping_mul(q[0])).max(0).unsigned_abs();
    let width = x[0].max(x[1]).max(x[2]).max(x[3]) - x[0].min(x[1]).min(x[2]).min(x[3]);
    let length = width.max(height);
    if length < 256 || length.unsigned_abs().pow(2) / THIN > area {
        return lines(quad, width, height);
    }
    let zeros = area.leading_zeros();
    let leading = area << zeros >> 16;
    // 2^46 over the area's 16 leading bits.
    let reciprocal = ((1_u32 << 31).checked_div(leading).unwrap_or(0).min((1 << 16) - 1) << 15) as i32;
    let corner = [x[0] + x[1] + x[2] + x[3], y[0] + y[1] + y[2] + y[3]];
    let plane = |v: [i32; 4], bits: i32| {
        let (dp, dq) = (v[2] - v[0], v[3] - v[1]);
        let flat = Plane { by_x: 0, by_y: 0, origin: (v[0] + v[1] + v[2] + v[3]) << (bits - 2) };
        if dp | dq == 0 {
            return flat;
        }
        // Factors below 2^15 and of at most 2^15: the products' difference fits. A pixel is 2^8 units; the reciprocal is
        // 2^30 times the inverse of the area shifted up by its zeros, and the upper half of the product 2^32 less.
        let cross = |a: i32, b: i32| dp.wrapping_mul(a).wrapping_sub(dq.wrapping_mul(b));
        let slope = |n: i32| ((i64::from(n) * i64::from(reciprocal)) >> 32) as i32;
        let (by_x, by_y) = (slope(cross(q[1], p[1])), slope(cross(q[0], p[0])).wrapping_neg());
        let up = bits - 22 + zeros as i32;
        if up <= 0 {
            Plane { by_x: by_x >> -up, by_y: by_y >> -up, ..flat }.through(corner)
        } else if (by_x.unsigned_abs() | by_y.unsigned_abs()).leading_zeros() > up.unsigned_abs() {
            Plane { by_x: by_x << up, by_y: by_y << up, ..flat }.through(corner)
        } else {
            // Steeper than 2^31 to a pixel: constant.
            flat
        }
    };
    [plane(quad.depth.map(i32::from), DEPTH_BITS), plane(quad.level.map(i32::from), LEVEL_BITS)]
}

/// The planes over a thin facet, linear along x or y only, from one corner to another one; over one below a pixel,
/// constant.
#[cold]
#[inline(never)]
fn lines(quad: &Quad, width: i32, height: i32) -> [Plane; 2] {
    let along_y = height > width;
    let (from, to) = extremes(if along_y { &quad.y } else { &quad.x });
    let length = width.max(height);
    let line = |v: [i32; 4], bits: i32| {
        let flat = Plane { by_x: 0, by_y: 0, origin: (v[0] + v[1] + v[2] + v[3]) << (bits - 2) };
        let slope = (i64::from(v[to & 3] - v[from & 3]) << (8 + bits)).checked_div(length.into()).unwrap_or(0);
        match i32::try_from(slope) {
            Ok(slope) if length >= 256 => {
                let (by_x, by_y) = if along_y { (0, slope) } else { (slope, 0) };
                Plane { by_x, by_y, origin: v[from & 3] << bits }.through([4 * quad.x[from & 3], 4 * quad.y[from & 3]])
            }
            _ => flat,
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
}

impl<'f, 'b, P: Paint> Filler<'f, 'b, P> {
    pub(in crate::render) fn new(tile: &'f mut Tile<'b, P::Pixel>, paint: &'f P) -> Self {
        let area = tile.area();
        let end = |start: i32, length: u32| start.saturating_add_unsigned(length);
        Self { tile, paint, window: [area.x, end(area.x, area.width), area.y, end(area.y, area.height)] }
    }
}

/// What a facet's spans have in common.
#[derive(Clone, Copy)]
struct Spans {
    left: i32,
    depth_by_x: i32,
    level_by_x: i32,
    patch: usize,
}

impl<P: Paint> Output for Filler<'_, '_, P> {
    fn window(&self) -> [i32; 4] {
        self.window
    }

    #[inline(never)]
    fn facet(&mut self, quad: &Quad) {
        let [left, right, top, bottom] = self.window;
        let rows_of = extremes(&quad.y);
        let (mut row, end) = (centre(quad.y[rows_of.0 & 3]).max(top), centre(quad.y[rows_of.1 & 3]).min(bottom));
        if row >= end {
            return;
        }
        let [depth, level] = planes(quad, quad.y[rows_of.1 & 3] - quad.y[rows_of.0 & 3]);
        // The first column's values, rounded to the nearest level.
        let (mut z, mut s) = (depth.at(left, row), level.at(left, row).wrapping_add(1 << (LEVEL_BITS - 1)));
        let (mut before, mut after) = (Flank::new(quad, rows_of.0, 3), Flank::new(quad, rows_of.0, 1));
        let width = right.wrapping_sub(left);
        let spans = Spans { left, depth_by_x: depth.by_x, level_by_x: level.by_x, patch: quad.patch };
        let mut lines = self.tile.rows_from(row.wrapping_sub(top) as usize);
        while row < end {
            before.reach(row);
            after.reach(row);
            let until = before.edge.end.min(after.edge.end).min(end);
            if until <= row {
                return;
            }
            let (mut from, mut to) = (before.edge.x.wrapping_sub(left << 16), after.edge.x.wrapping_sub(left << 16));
            for row in row..until {
                let Some((colours, depths)) = lines.next() else { return };
                let (first, last) = ((from >> 16).max(0), (to >> 16).min(width));
                if first < last
                    && let Some(colours) = colours.get_mut(first as usize..last as usize)
                    && let Some(depths) = depths.get_mut(first as usize..last as usize)
                {
                    let at = (first, row);
                    let z = z.wrapping_add(depth.by_x.wrapping_mul(first));
                    let s = s.wrapping_add(level.by_x.wrapping_mul(first));
                    span(self.paint, (colours, depths), at, (z as u32, s), spans);
                }
                from = from.wrapping_add(before.edge.step);
                to = to.wrapping_add(after.edge.step);
                z = z.wrapping_add(depth.by_y);
                s = s.wrapping_add(level.by_y);
            }
            let rows = until - row;
            before.edge.advance(rows);
            after.edge.advance(rows);
            row = until;
        }
    }
}

/// Fills a run of pixels from column `x` (counted from the tile's) on.
#[inline(always)]
fn span<P: Paint>(
    paint: &P,
    (colours, depths): (&mut [P::Pixel], &mut [u16]),
    (x, y): (i32, i32),
    (mut z, mut s): (u32, i32),
    Spans { left, depth_by_x, level_by_x, patch }: Spans,
) {
    let mut x = left.wrapping_add(x);
    for (colour, stored) in colours.iter_mut().zip(depths) {
        let depth = z >> 16;
        // The lowest bit is no depth yet: it decides nothing, for what is stored is even, or larger than any.
        if depth < u32::from(*stored) {
            *stored = depth as u16 & !1;
            let shade = (s >> LEVEL_BITS).clamp(0, 255) as u8;
            *colour = paint.pixel(Fragment { x, y, patch, shade });
        }
        z = z.wrapping_add(depth_by_x as u32);
        s = s.wrapping_add(level_by_x);
        x = x.wrapping_add(1);
    }
}
