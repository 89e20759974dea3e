//! The same rasteriser in `f32`, as one would write it for a core with an FPU.

use super::Screen;
use super::view::AREA;

const WIDTH: usize = AREA.width as usize;

/// A vertex on the screen.
#[derive(Clone, Copy)]
pub(crate) struct Corner {
    pub(crate) x: f32,
    pub(crate) y: f32,
    /// In 1/128 of a pixel from 2^15.
    pub(crate) z: f32,
    pub(crate) level: f32,
}

impl Corner {
    pub(crate) const ZERO: Self = Self { x: 0.0, y: 0.0, z: 0.0, level: 0.0 };
}

/// The view in floats, made from the integers once.
pub(crate) struct Shot {
    matrix: [[f32; 4]; 3],
    /// Scaled by 215 levels over the units of the normals.
    light: [f32; 3],
    ambient: f32,
}

impl Shot {
    pub(crate) fn of(shot: &super::view::Shot) -> Self {
        let matrix = shot.matrix.map(|row| row.map(|c| c as f32 / 2_097_152.0));
        let levels = (255 - shot.ambient) as f32;
        Self { matrix, light: shot.light.map(|c| c as f32 * levels / 536_870_912.0), ambient: shot.ambient as f32 }
    }
}

/// Every vertex of a mesh on the screen, lit. The mesh stays in 16 bits: twice as much flash buys nothing.
pub(crate) fn place(mesh: &super::mesh::Mesh, shot: &Shot, corners: &mut [Corner]) {
    let [mx, my, mz] = shot.matrix;
    let [lx, ly, lz] = shot.light;
    for (corner, (point, normal)) in corners.iter_mut().zip(mesh.vertices()) {
        let [x, y, z] = point.map(f32::from);
        let row = |[a, b, c, d]: [f32; 4]| a * x + b * y + c * z + d;
        let [nx, ny, nz] = normal.map(f32::from);
        let lit = lx * nx + ly * ny + lz * nz;
        let level = self_or_zero(lit) + shot.ambient;
        *corner = Corner { x: row(mx), y: row(my), z: row(mz) * 128.0 + 32_768.0, level };
    }
}

/// max(0, x), as a compare.
#[inline(always)]
fn self_or_zero(x: f32) -> f32 {
    if x > 0.0 { x } else { 0.0 }
}

/// Towards zero.
#[inline(always)]
fn whole(x: f32) -> i32 {
    // SAFETY: coordinates of the picture, depths of 16 bits, levels.
    unsafe { x.to_int_unchecked() }
}

/// The least integer that is not below x, for x > −1.
#[inline(always)]
fn ceil(x: f32) -> i32 {
    let t = whole(x);
    t + i32::from(x > t as f32)
}

/// A border, stepped a row at a time.
struct Border {
    x: f32,
    step: f32,
}

impl Border {
    #[inline(always)]
    fn at(row: i32, from: &Corner, to: &Corner) -> Self {
        let step = (to.x - from.x) / (to.y - from.y);
        Self { x: from.x + (row as f32 - from.y) * step, step }
    }
}

#[derive(Clone, Copy)]
struct Plane {
    start: f32,
    right: f32,
    down: f32,
}

/// Fills a triangle that faces the viewer.
pub(crate) fn triangle(screen: &mut Screen, corners: [&Corner; 3], colours: &[u16; 256]) {
    let [a, b, c] = corners;
    let (ux, uy, vx, vy) = (b.x - a.x, b.y - a.y, c.x - a.x, c.y - a.y);
    let area = ux * vy - vx * uy;
    if area <= 0.0 {
        return;
    }
    let inverse = 1.0 / area;
    let plane = |a: f32, b: f32, c: f32| {
        let (p, q) = ((b - a) * inverse, (c - a) * inverse);
        Plane { start: a, right: p * vy - q * uy, down: q * ux - p * vx }
    };
    let planes = (plane(a.z, b.z, c.z), plane(a.level, b.level, c.level));
    let (top, mid, low) = match (a.y <= b.y, b.y <= c.y, c.y <= a.y) {
        (true, true, _) => (a, b, c),
        (_, true, true) => (b, c, a),
        (true, _, true) => (c, a, b),
        (true, false, false) => (a, c, b),
        (false, true, false) => (b, a, c),
        (false, false, _) => (c, b, a),
    };
    let mid_is_right = (mid.x - top.x) * (low.y - top.y) > (low.x - top.x) * (mid.y - top.y);
    let rows = [ceil(top.y), ceil(mid.y), ceil(low.y)];
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
            span(screen, row, [left, right].map(ceil), a, &planes, colours);
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
    let (x, y) = (left as f32 - origin.x, row as f32 - origin.y);
    let mut depth = z.start + z.right * x + z.down * y;
    let mut shade = level.start + level.right * x + level.down * y;
    for (there, pixel) in depths.iter_mut().zip(pixels) {
        let here = whole(depth) as u16;
        if here < *there {
            *there = here;
            *pixel = colours[whole(shade) as usize & 255];
        }
        depth += z.right;
        shade += level.right;
    }
}
