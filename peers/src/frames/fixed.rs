//! A scanline rasteriser in integers: Gouraud levels, 16 bits of depth, edges and planes stepped in 16.16, vertices in
//! 1/16 of a pixel. A pixel belongs to a triangle if its centre does, borders on the left and above included.

use super::Screen;
use super::mesh::Mesh;
use super::triangles::{NONE, Order};
use super::view::{AREA, Corner};
use core::ops::Range;

const WIDTH: usize = AREA.width as usize;

/// 2^20 over a height in 1/16 of a pixel: cores without a divider look it up.
static RECIPROCALS: [u32; 1024] = {
    let (mut table, mut k) = ([0; 1024], 1);
    while k < 1024 {
        table[k] = (1 << 20) / k as u32;
        k += 1;
    }
    table
};

/// Pixels a row in 16.16, from differences in 1/16 of a pixel.
#[inline(always)]
fn slope(dx: i32, dy: i32) -> i32 {
    match RECIPROCALS.get(dy as usize) {
        Some(reciprocal) if dx.abs() < 2048 => (dx * *reciprocal as i32) >> 4,
        _ => ((i64::from(dx) << 16) / i64::from(dy)) as i32,
    }
}

/// A border, stepped a row at a time: where it is in 16.16.
struct Border {
    x: i32,
    step: i32,
}

impl Border {
    /// From one end down to the other, at the centre of a row.
    #[inline(always)]
    fn at(row: i32, from: &Corner, to: &Corner) -> Self {
        let step = slope(to.x - from.x, to.y - from.y);
        Self { x: (from.x << 12) + ((((row << 4) - from.y) * (step >> 2)) >> 2), step }
    }
}

/// A value over the triangle in 16.16, modulo 2^32.
#[derive(Clone, Copy)]
struct Plane {
    /// At the first corner.
    start: u32,
    /// A pixel to the right, and down.
    right: i32,
    down: i32,
}

impl Plane {
    #[inline(always)]
    fn at(&self, x: i32, y: i32) -> u32 {
        let by = ((self.right >> 4).wrapping_mul(x)).wrapping_add((self.down >> 4).wrapping_mul(y));
        self.start.wrapping_add(by as u32)
    }
}

/// Fills a triangle that faces the viewer; of a band only the rows in it.
pub(crate) fn triangle<const BANDED: bool>(
    screen: &mut Screen,
    band: &Range<i32>,
    corners: [&Corner; 3],
    colours: &[u16; 256],
) {
    let [a, b, c] = corners;
    let (ux, uy, vx, vy) = (b.x - a.x, b.y - a.y, c.x - a.x, c.y - a.y);
    let area = ux * vy - vx * uy;
    if area <= 0 {
        return;
    }
    let inverse = i64::from((1_u32 << 31) / area as u32);
    let plane = |a: i32, b: i32, c: i32| {
        let (p, q) = (b - a, c - a);
        let gradient = |by: i32| ((i64::from(by) * inverse) >> 11) as i32;
        Plane { start: (a as u32) << 16, right: gradient(p * vy - q * uy), down: gradient(q * ux - p * vx) }
    };
    let planes = (plane(a.z, b.z, c.z), plane(a.level, b.level, c.level));
    // From the top: `mid` is on the right of the long border where the turn from `top` by `mid` to `low` is clockwise.
    let (top, mid, low) = match (a.y <= b.y, b.y <= c.y, c.y <= a.y) {
        (true, true, _) => (a, b, c),
        (_, true, true) => (b, c, a),
        (true, _, true) => (c, a, b),
        (true, false, false) => (a, c, b),
        (false, true, false) => (b, a, c),
        (false, false, _) => (c, b, a),
    };
    let mid_is_right = (mid.x - top.x) * (low.y - top.y) > (low.x - top.x) * (mid.y - top.y);
    let row = |corner: &Corner| (corner.y + 15) >> 4;
    let rows = [top, mid, low].map(|corner| if BANDED { row(corner).clamp(band.start, band.end) } else { row(corner) });
    if rows[0] == rows[2] {
        return;
    }
    let mut long = Border::at(rows[0], top, low);
    for (from, to, first, end) in [(top, mid, rows[0], rows[1]), (mid, low, rows[1], rows[2])] {
        if first == end {
            continue;
        }
        let mut short = Border::at(first, from, to);
        for row in first..end {
            let (left, right) = if mid_is_right { (long.x, short.x) } else { (short.x, long.x) };
            span(screen, row, [left, right].map(|x| (x + 0xffff) >> 16), a, &planes, colours);
            long.x += long.step;
            short.x += short.step;
        }
    }
}

#[inline(always)]
fn span(
    screen: &mut Screen,
    row: i32,
    [left, right]: [i32; 2],
    origin: &Corner,
    (z, level): &(Plane, Plane),
    colours: &[u16; 256],
) {
    if left >= right {
        return;
    }
    let start = row as usize * WIDTH;
    let range = start + left as usize..start + right as usize;
    let (Some(depths), Some(pixels)) = (screen.depth.get_mut(range.clone()), screen.colour.get_mut(range)) else {
        return;
    };
    let (x, y) = ((left << 4) - origin.x, (row << 4) - origin.y);
    let (mut depth, mut shade) = (z.at(x, y), level.at(x, y));
    for (there, pixel) in depths.iter_mut().zip(pixels) {
        let here = (depth >> 16) as u16;
        if here < *there {
            *there = here;
            *pixel = colours[(shade >> 24) as usize];
        }
        depth = depth.wrapping_add(z.right as u32);
        shade = shade.wrapping_add(level.right as u32);
    }
}

/// Rows of a band.
pub(crate) const ROWS: i32 = 16;
pub(crate) const BANDS: usize = (AREA.height as usize).div_ceil(ROWS as usize);

/// Lists the triangles that face the viewer by the first band that they meet.
pub(crate) fn sort(mesh: &Mesh, corners: &[Corner], order: &mut Order) {
    order.first.fill(NONE);
    for (index, triangle) in mesh.triangles().iter().enumerate() {
        let [a, b, c] = triangle.map(|index| &corners[usize::from(index)]);
        if (b.x - a.x) * (c.y - a.y) > (c.x - a.x) * (b.y - a.y) {
            let row = (a.y.min(b.y).min(c.y) + 15) >> 4;
            order.push((row / ROWS) as usize, index as u16);
        }
    }
}

/// Draws a band, and hands those that reach below it on to the next.
pub(crate) fn draw_band(
    screen: &mut Screen,
    band: usize,
    (mesh, corners): (&Mesh, &[Corner]),
    order: &mut Order,
    colours: &[u16; 256],
) {
    let rows = band as i32 * ROWS..(band as i32 + 1) * ROWS;
    let pixels = rows.start as usize * WIDTH..rows.end as usize * WIDTH;
    screen.colour[pixels.clone()].fill(0);
    screen.depth[pixels].fill(u16::MAX);
    let mut index = order.first[band];
    while index != NONE {
        let next = order.next[usize::from(index)];
        let corners = mesh.triangles()[usize::from(index)].map(|index| &corners[usize::from(index)]);
        triangle::<true>(screen, &rows, corners, colours);
        if corners.iter().any(|corner| corner.y > (rows.end - 1) << 4) {
            order.push(band + 1, index);
        }
        index = next;
    }
}
