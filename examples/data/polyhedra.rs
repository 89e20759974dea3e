//! Coarse meshes to put skins over: an icosahedron, a torus, a duck.

use super::mesh_file::Polyhedron;
use std::f64::consts::TAU;

pub(crate) fn icosahedron() -> Polyhedron {
    let golden = (1.0 + 5_f64.sqrt()) / 2.0;
    let mut points: Vec<[f64; 3]> = Vec::new();
    for (a, b) in [(1.0, golden), (-1.0, golden), (1.0, -golden), (-1.0, -golden)] {
        points.extend([[0.0, a, b], [a, b, 0.0], [b, 0.0, a]]);
    }
    // Faces are the triples at distance 2 of each other, turned outward.
    let near = |i: usize, j: usize| {
        let square: f64 = (0..3).map(|c| (points[i][c] - points[j][c]).powi(2)).sum();
        (square - 4.0).abs() < 1e-9
    };
    let mut faces = Vec::new();
    for i in 0..12 {
        for j in i + 1..12 {
            for k in j + 1..12 {
                if near(i, j) && near(j, k) && near(k, i) {
                    let [a, b, c] = [points[i], points[j], points[k]];
                    let volume = a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0])
                        + a[2] * (b[0] * c[1] - b[1] * c[0]);
                    let face = [i, j, k].map(|v| v as u16);
                    faces.push(if volume > 0.0 { face } else { [face[0], face[2], face[1]] });
                }
            }
        }
    }
    Polyhedron { points, faces }
}

/// `around` rings of `across` vertices, radii 1 and 0.45.
pub(crate) fn torus(around: u16, across: u16) -> Polyhedron {
    let mut out = Polyhedron::default();
    for i in 0..around {
        for j in 0..across {
            let (a, b) = (TAU * f64::from(i) / f64::from(around), TAU * f64::from(j) / f64::from(across));
            let distance = 1.0 + 0.45 * b.cos();
            out.points.push([distance * a.cos(), distance * a.sin(), 0.45 * b.sin()]);
            let at = |i: u16, j: u16| (i % around) * across + j % across;
            let [p, q, r, s] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            out.faces.extend([[p, q, r], [p, r, s]]);
        }
    }
    out
}

/// Rings of a body along its spine: x, z, half the width, half the height.
const BODY: [[f64; 4]; 11] = [
    [-1.25, 0.42, 0.26, 0.16],
    [-0.85, 0.14, 0.52, 0.36],
    [-0.20, 0.00, 0.74, 0.58],
    [0.42, 0.06, 0.66, 0.56],
    [0.80, 0.42, 0.42, 0.40],
    [0.86, 0.82, 0.26, 0.26],
    [0.96, 1.12, 0.34, 0.32],
    [1.22, 1.28, 0.36, 0.33],
    [1.46, 1.22, 0.24, 0.20],
    [1.64, 1.14, 0.21, 0.075],
    [1.86, 1.10, 0.15, 0.04],
];
const TAIL: [f64; 3] = [-1.44, 0.0, 0.56];
const BEAK: [f64; 3] = [1.95, 0.0, 1.09];

/// A duck: rings of eight around a bent spine, from the tail to the tip of the beak.
pub(crate) fn duck() -> Polyhedron {
    const SIDES: u16 = 8;
    let mut out = Polyhedron::default();
    for (i, [x, z, width, height]) in BODY.into_iter().enumerate() {
        let before = if i > 0 { [BODY[i - 1][0], BODY[i - 1][1]] } else { [TAIL[0], TAIL[2]] };
        let after = BODY.get(i + 1).map_or([BEAK[0], BEAK[2]], |ring| [ring[0], ring[1]]);
        let along = [after[0] - before[0], after[1] - before[1]];
        let length = along[0].hypot(along[1]);
        let [forward, up] = along.map(|c| c / length);
        for j in 0..SIDES {
            // No vertex on the ridges.
            let (sin, cos) = (TAU * (f64::from(j) + 0.5) / f64::from(SIDES)).sin_cos();
            out.points.push([x - up * height * sin, width * cos, z + forward * height * sin]);
        }
    }
    let rings = BODY.len() as u16;
    let at = |i: u16, j: u16| i * SIDES + j % SIDES;
    for (i, j) in (0..rings - 1).flat_map(|i| (0..SIDES).map(move |j| (i, j))) {
        let [p, q, r, s] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
        out.faces.extend(if j < SIDES / 2 { [[p, r, q], [p, s, r]] } else { [[p, s, q], [q, s, r]] });
    }
    let [tail, beak] = [rings * SIDES, rings * SIDES + 1];
    out.points.extend([TAIL, BEAK]);
    out.faces.extend(
        (0..SIDES).flat_map(|j| [[tail, at(0, j + 1), at(0, j)], [beak, at(rings - 1, j), at(rings - 1, j + 1)]]),
    );
    out
}
