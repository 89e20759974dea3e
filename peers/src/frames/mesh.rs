//! The teapot as an author would bake it: an indexed mesh in model units, 16 bits a coordinate, vertices that patches
//! share stored once, normals of the surface.

use super::super::teapot;
use embedded_surfaces::patch::{BicubicPatch, Parameter, Tensor};
use embedded_surfaces::subdivide::PatchTopology;

/// First patch, patches, segments along r, along s: the fewest triangles of a grid a patch, alike on shared curves, that
/// stay within half a pixel of the surface in the view of the frame. `tests/firmware_peers.rs` measures the distance.
pub(crate) const GRIDS: [[usize; 4]; 10] = [
    [0, 4, 4, 11],
    [4, 4, 6, 11],
    [8, 4, 9, 11],
    [12, 2, 10, 7],
    [14, 2, 7, 7],
    [16, 2, 16, 10],
    [18, 2, 3, 10],
    [20, 4, 9, 8],
    [24, 4, 12, 8],
    [28, 4, 7, 8],
];

/// Of each patch which way it is turned.
static TOPOLOGY: [PatchTopology; 32] = match Tensor::topology(&teapot::MODEL) {
    Ok(topology) => topology,
    Err(_) => panic!("the teapot's parts have two sides"),
};

pub(crate) const MOST_VERTICES: usize = 2560;
pub(crate) const MOST_TRIANGLES: usize = 4636;

pub(crate) struct Mesh {
    points: [[i16; 3]; MOST_VERTICES],
    /// Unit normals out of the volume, in 2^-14.
    normals: [[i16; 3]; MOST_VERTICES],
    /// Corners; clockwise on a screen whose y points down, where they are seen from outside.
    triangles: [[u16; 3]; MOST_TRIANGLES],
    vertices: usize,
    triangle_count: usize,
}

impl Mesh {
    pub(crate) const EMPTY: Self = Self {
        points: [[0; 3]; MOST_VERTICES],
        normals: [[0; 3]; MOST_VERTICES],
        triangles: [[0; 3]; MOST_TRIANGLES],
        vertices: 0,
        triangle_count: 0,
    };

    /// Points and normals of the vertices.
    pub(crate) fn vertices(&self) -> impl Iterator<Item = (&[i16; 3], &[i16; 3])> {
        self.points.iter().zip(&self.normals).take(self.vertices)
    }

    pub(crate) fn triangles(&self) -> &[[u16; 3]] {
        &self.triangles[..self.triangle_count]
    }

    /// Makes the mesh.
    pub(crate) fn bake(&mut self) {
        (self.vertices, self.triangle_count) = (0, 0);
        for [first, count, r, s] in GRIDS {
            for patch in first..first + count {
                self.bake_patch(patch, (r, s));
            }
        }
    }

    fn bake_patch(&mut self, patch: usize, (r, s): (usize, usize)) {
        let net = &teapot::MODEL[patch];
        let inward = TOPOLOGY[patch].is_inward();
        let mut before = [0; 32];
        for i in 0..=r {
            let mut row = [0; 32];
            for (j, index) in row.iter_mut().enumerate().take(s + 1) {
                *index = self.vertex(net, [(i, r), (j, s)], inward);
            }
            for j in 0..if i == 0 { 0 } else { s } {
                let [a, b, c, d] = [before[j], row[j], row[j + 1], before[j + 1]];
                self.triangle([a, b, c], inward);
                self.triangle([a, c, d], inward);
            }
            before = row;
        }
    }

    /// The index of the vertex at i/r, j/s; a new one unless one stands there.
    fn vertex(&mut self, net: &BicubicPatch, at: [(usize, usize); 2], inward: bool) -> u16 {
        let [r, s] = at.map(|(i, n)| parameter(i, n));
        let point = net.net().eval(r, s);
        let point = [point.x, point.y, point.z].map(|c| ((c.to_bits() + (1 << 15)) >> 16) as i16);
        let found = self.points[..self.vertices].iter().position(|p| *p == point);
        let index = found.unwrap_or(self.vertices);
        if found.is_none() {
            self.points[index] = point;
            self.normals[index] = normal(net, at, inward);
            self.vertices += 1;
        }
        index as u16
    }

    /// Keeps a triangle unless two corners are one.
    fn triangle(&mut self, [a, b, c]: [u16; 3], inward: bool) {
        if a != b && b != c && c != a {
            // Along r, then along s: the normal r × s is towards a viewer who sees them counter-clockwise.
            self.triangles[self.triangle_count] = if inward { [a, b, c] } else { [a, c, b] };
            self.triangle_count += 1;
        }
    }
}

fn parameter(i: usize, n: usize) -> Parameter {
    Parameter::new(i as u32, n as u32).unwrap_or(Parameter::ZERO)
}

/// The unit normal; where a side is collapsed, that of a point a little inside.
fn normal(net: &BicubicPatch, at: [(usize, usize); 2], inward: bool) -> [i16; 3] {
    let inside = |(i, n): (usize, usize)| parameter((64 * i).clamp(1, 64 * n - 1), 64 * n);
    for at in [at.map(|(i, n)| parameter(i, n)), at.map(inside)] {
        let [a, b] = net.net().partials(at[0], at[1]).map(|d| [d.x, d.y, d.z].map(|c| i128::from(c.to_bits())));
        let cross = [0, 1, 2].map(|k: usize| a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3]);
        // To 30 bits, so that squares fit.
        let largest = cross.iter().map(|c| c.unsigned_abs()).max().unwrap_or(0);
        let shift = 98_u32.saturating_sub(largest.leading_zeros());
        let v = cross.map(|c| (c >> shift) as i64);
        let length = v.iter().map(|c| c * c).sum::<i64>().unsigned_abs().isqrt() as i64;
        if length > 0 {
            let sign = if inward { -1 } else { 1 };
            return v.map(|c| ((sign * c * (1 << 14)) / length) as i16);
        }
    }
    [0; 3]
}
