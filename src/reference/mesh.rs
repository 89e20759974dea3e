//! Fine meshes over a surface, row by row.

use super::eval::{bernstein, factorial, homogeneous, powers};
use crate::num::Coord;
use crate::patch::{MAX_DEGREE, SurfaceNet};
use std::vec;
use std::vec::Vec;

/// Fraction bits of a snapped vertex.
pub(super) const SNAP_BITS: u32 = 24;

/// A vertex (x, y) in units of 2^-24 pixel.
pub(super) type Vertex = [i64; 2];

/// Cell counts four times as fine as these step counts.
///
/// ```
/// use embedded_surfaces::reference::fine_mesh;
/// assert_eq!(fine_mesh((30, 7)), (120, 28));
/// ```
#[must_use]
pub fn fine_mesh(steps: (u32, u32)) -> (u32, u32) {
    (steps.0.saturating_mul(4), steps.1.saturating_mul(4))
}

/// A mesh of n_r × n_s cells, or of n² triangles over a triangular patch, with what its rows have in common
/// precomputed: 8(d+1)(n_r+1) bytes.
pub(super) struct Mesh {
    counts: (u32, u32),
    degrees: (usize, usize),
    triangle: bool,
    rational: bool,
    /// w·x, w·y and w of the control points; w = 1 for a polynomial.
    points: Vec<Homogeneous>,
    /// d + 1 values for each a = 0 ..= n_r: B_i^d(a/n_r), or (a/n)^i for a triangle.
    table: Vec<f64>,
}

/// (w x, w y, w).
type Homogeneous = [f64; 3];

/// Nearest multiple of 2^-24, ties away from 0. |c| ≤ 2^26, so the result is below 2^51 and exact.
fn snap(c: f64) -> i64 {
    (c * (1_u64 << SNAP_BITS) as f64).round() as i64
}

fn fraction(a: u32, n: u32) -> f64 {
    f64::from(a) / f64::from(n)
}

impl Mesh {
    /// The mesh over `net`; a triangle takes the larger count, and a count of 0 is taken as 1.
    pub(super) fn new<C: Coord>(net: SurfaceNet<'_, C>, counts: (u32, u32)) -> Self {
        let (triangle, rational) = (net.is_triangle(), net.weights().is_some());
        let (r, s) = (counts.0.max(1), counts.1.max(1));
        let counts = if triangle { (r.max(s), r.max(s)) } else { (r, s) };
        let degrees = net.degrees();
        let basis = if triangle { powers } else { bernstein };
        let mut table = Vec::new();
        for a in 0..=counts.0 {
            table.extend_from_slice(&basis(degrees.0, fraction(a, counts.0))[..=degrees.0]);
        }
        let flat = |[x, y, _, w]: [f64; 4]| [x, y, w];
        let points = (0..net.points().len()).map(|index| flat(homogeneous(net, index))).collect();
        Self { counts, degrees, triangle, rational, points, table }
    }

    /// The pixel position of a homogeneous point.
    fn place(&self, [x, y, w]: Homogeneous) -> Vertex {
        if self.rational { [x / w, y / w].map(snap) } else { [x, y].map(snap) }
    }

    /// The number of the last row.
    pub(super) fn last_row(&self) -> u32 {
        self.counts.1
    }

    /// Writes the vertices of row j, i = 0 ..= n_r, or i = 0 ..= n − j for a triangle. Cost: (m+1) multiplications
    /// a vertex and coordinate, or (n+1)(n+4)/2.
    pub(super) fn row(&self, j: u32, out: &mut Vec<Vertex>) {
        out.clear();
        if self.triangle { self.triangle_row(j, out) } else { self.tensor_row(j, out) }
    }

    /// A row is the curve through q_i = Σ_j B_j^h(s) P_ij.
    fn tensor_row(&self, row: u32, out: &mut Vec<Vertex>) {
        let (m, h) = self.degrees;
        let by_s = bernstein(h, fraction(row, self.counts.1));
        let mut columns = [[0.0; 3]; MAX_DEGREE + 1];
        for (column, points) in columns.iter_mut().zip(self.points.chunks_exact(h + 1)) {
            *column = weighted_sum(&by_s, points);
        }
        let columns = &columns[..=m];
        out.extend(self.table.chunks_exact(m + 1).map(|weights| self.place(weighted_sum(weights, columns))));
    }

    /// A row is Σ_i u^i Σ_k w^k c_ik with c_ik = n!/(i!j!k!) v^j b\[i,j,k\].
    fn triangle_row(&self, row: u32, out: &mut Vec<Vertex>) {
        let n = self.degrees.0;
        let terms = self.row_terms(row);
        let length = (self.counts.0 - row) as usize + 1;
        let by_u = self.table.chunks_exact(n + 1).take(length);
        // w falls as u rises.
        let by_w = self.table[..length * (n + 1)].chunks_exact(n + 1).rev();
        out.extend(by_u.zip(by_w).map(|(u, w)| {
            let mut inner = [[0.0; 3]; MAX_DEGREE + 1];
            for (i, (inner, terms)) in inner.iter_mut().zip(&terms).enumerate().take(n + 1) {
                *inner = weighted_sum(&w[..=n - i], terms);
            }
            self.place(weighted_sum(u, &inner))
        }));
    }

    /// c_ik of a row.
    fn row_terms(&self, row: u32) -> [[Homogeneous; MAX_DEGREE + 1]; MAX_DEGREE + 1] {
        let n = self.degrees.0;
        let by_v = powers(n, fraction(row, self.counts.1));
        let mut terms = [[[0.0; 3]; MAX_DEGREE + 1]; MAX_DEGREE + 1];
        let mut points = self.points.iter();
        // The storage order: i descending, then j descending.
        for i in (0..=n).rev() {
            for (k, point) in (0..=n - i).zip(&mut points) {
                let j = n - i - k;
                let weight = factorial(n) / (factorial(i) * factorial(j) * factorial(k)) * by_v[j];
                terms[i][k] = point.map(|c| weight * c);
            }
        }
        terms
    }

    /// Calls `f` with the corners of every triangle: two per cell, upright and inverted ones of a triangle.
    pub(super) fn for_each_triangle(&self, mut f: impl FnMut([Vertex; 3])) {
        let (mut low, mut high) = (vec![], vec![]);
        self.row(0, &mut low);
        for j in 1..=self.last_row() {
            self.row(j, &mut high);
            // `high` is as long as `low`, or shorter by one: then the last triangle stands alone.
            for (below, above) in low.windows(2).zip(&high) {
                f([below[0], below[1], *above]);
            }
            for (below, above) in low[1..].iter().zip(high.windows(2)) {
                f([*below, above[1], above[0]]);
            }
            core::mem::swap(&mut low, &mut high);
        }
    }
}

fn weighted_sum(weights: &[f64], points: &[Homogeneous]) -> Homogeneous {
    let mut sum = [0.0; 3];
    for (weight, point) in weights.iter().zip(points) {
        for (sum, c) in sum.iter_mut().zip(point) {
            *sum += weight * c;
        }
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::super::eval::point;
    use super::super::samples::nets;
    use super::*;
    use crate::patch::{BilinearPatch, FlatTriangle, Surface};
    use proptest::prelude::*;

    fn area2([a, b, c]: [Vertex; 3]) -> i64 {
        (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
    }

    #[test]
    fn triangles_tile_the_patch() {
        const ONE: i64 = 1 << SNAP_BITS;
        let square = BilinearPatch::from_ints([[[0, 0, 0], [0, 1, 0]], [[1, 0, 0], [1, 1, 0]]]).unwrap();
        let half = FlatTriangle::from_ints([[1, 0, 0], [0, 1, 0], [0, 0, 0]]).unwrap();
        for (mesh, count, area) in [
            (Mesh::new(square.surface(), (4, 8)), 64, 2 * ONE * ONE),
            (Mesh::new(half.surface(), (8, 2)), 64, ONE * ONE),
            (Mesh::new(half.surface(), (0, 0)), 1, ONE * ONE),
        ] {
            let (mut triangles, mut sum) = (0, 0);
            mesh.for_each_triangle(|t| {
                assert!(area2(t) > 0); // one orientation
                (triangles, sum) = (triangles + 1, sum + area2(t));
            });
            assert_eq!((triangles, sum), (count, area));
        }
    }

    proptest! {
        #[test]
        fn vertices_are_points_of_the_surface(net in nets(8, 32767 << 16), r in 1_u32..9, s in 1_u32..9) {
            let s = if net.is_triangle() { r } else { s };
            let mesh = Mesh::new(net.surface(), (r, s));
            let mut row = vec![];
            for j in 0..=mesh.last_row() {
                mesh.row(j, &mut row);
                prop_assert_eq!(row.len() as u32, if net.is_triangle() { r - j + 1 } else { r + 1 });
                for (i, vertex) in (0..).zip(&row) {
                    let p = point(net.surface(), fraction(i, r), fraction(j, s));
                    for axis in 0..2 {
                        let error = vertex[axis] as f64 - p[axis] * (1 << SNAP_BITS) as f64;
                        prop_assert!(error.abs() < 0.51, "{error} at ({i}, {j})");
                    }
                }
            }
        }
    }
}
