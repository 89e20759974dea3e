//! A torus of 200 vertices and 400 triangles, in flash: points, faces and links.

use embedded_surfaces::const_mesh;
use embedded_surfaces::geometry::Point3;
use embedded_surfaces::mesh::{Faces, Links, Mesh};
use embedded_surfaces::num::{Angle, I32F32};

const AROUND: usize = 20;
const ACROSS: usize = 10;
pub(crate) const VERTICES: usize = AROUND * ACROSS;
pub(crate) const TRIANGLES: usize = 2 * VERTICES;

/// A product in 2^-32, rounded down.
const fn times(a: I32F32, b: I32F32) -> I32F32 {
    I32F32::from_bits(((a.to_bits() as i128 * b.to_bits() as i128) >> 32) as i64)
}

/// Part `i` of `n` of a full turn.
const fn part(i: usize, n: usize) -> Angle {
    Angle::from_binary((((i as u64) << 32) / n as u64) as u32)
}

static POINTS: [Point3<I32F32>; VERTICES] = {
    let mut points = [Point3::new(I32F32::ZERO, I32F32::ZERO, I32F32::ZERO); VERTICES];
    let mut at = 0;
    while at < VERTICES {
        let (sin_a, cos_a) = part(at / ACROSS, AROUND).sin_cos();
        let (sin_b, cos_b) = part(at % ACROSS, ACROSS).sin_cos();
        // Radii of 80 and 32 units.
        let distance = I32F32::from_bits((80 << 32) + 32 * cos_b.to_bits());
        points[at] =
            Point3::new(times(distance, cos_a), times(distance, sin_a), I32F32::from_bits(32 * sin_b.to_bits()));
        at += 1;
    }
    points
};

static FACES: [[u16; 3]; TRIANGLES] = {
    let mut faces = [[0; 3]; TRIANGLES];
    let mut at = 0;
    while at < VERTICES {
        let (i, j) = (at / ACROSS, at % ACROSS);
        let (next, up) = ((i + 1) % AROUND * ACROSS, (j + 1) % ACROSS);
        let (p, q) = (at as u16, (next + j) as u16);
        let (r, s) = ((next + up) as u16, (i * ACROSS + up) as u16);
        faces[2 * at] = [p, q, r];
        faces[2 * at + 1] = [p, r, s];
        at += 1;
    }
    faces
};

static LINKS: Links<'_, VERTICES, { 3 * TRIANGLES }> = const_mesh!(Links::new(VERTICES, Faces::Triangles(&FACES)));

/// The mesh.
pub(crate) static RING: Mesh<'_, I32F32> = const_mesh!(Mesh::<I32F32>::new(&POINTS, &LINKS));
