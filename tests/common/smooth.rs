//! Surfaces and curves in `f64` by direct Bernstein sums, and how far they are from their triangles or chords.
#![allow(clippy::disallowed_types, clippy::float_arithmetic)]

use super::{basis::triangle_indices, triangle_index};
use embedded_surfaces::geometry::Point3;
use embedded_surfaces::num::I16F16;
use embedded_surfaces::patch::SurfaceNet;

pub(crate) type Vec3 = [f64; 3];

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Shape {
    Curve(usize),
    Triangle(usize),
    Tensor(usize, usize),
}

#[derive(Clone, Debug)]
pub(crate) struct Smooth {
    pub(crate) shape: Shape,
    pub(crate) points: Vec<Vec3>,
    pub(crate) weights: Vec<f64>,
}

pub(crate) fn mix(terms: &[(f64, Vec3)]) -> Vec3 {
    std::array::from_fn(|a| terms.iter().map(|(f, p)| f * p[a]).sum())
}

pub(crate) fn distance(a: Vec3, b: Vec3) -> f64 {
    (0..3).map(|x| (a[x] - b[x]).powi(2)).sum::<f64>().sqrt()
}

fn choose(n: usize, k: usize) -> f64 {
    (0..k).fold(1.0, |c, i| c * (n - i) as f64 / (i + 1) as f64)
}

fn bernstein(n: usize, t: f64) -> Vec<f64> {
    (0..=n).map(|i| choose(n, i) * t.powi(i as i32) * (1.0 - t).powi((n - i) as i32)).collect()
}

/// The value at (r, s) of the linear interpolants of the corners c00, c01, c10, c11 over either diagonal.
fn over_diagonals([c00, c01, c10, c11]: [Vec3; 4], [r, s]: [f64; 2]) -> [Vec3; 2] {
    let over = |both: f64| mix(&[(1.0 - r - s + both, c00), (s - both, c01), (r - both, c10), (both, c11)]);
    [over(r.min(s)), over((r + s - 1.0).max(0.0))]
}

impl Smooth {
    pub(crate) fn new(shape: Shape, points: &[Point3], weights: Option<&[I16F16]>) -> Self {
        let value = |c: I16F16| f64::from(c.to_bits()) / 65536.0;
        let weight = |i| weights.map_or(1.0, |w| value(w[i]));
        Self {
            shape,
            points: points.iter().map(|p| p.to_array().map(value)).collect(),
            weights: (0..points.len()).map(weight).collect(),
        }
    }

    pub(crate) fn of(net: &SurfaceNet<'_>) -> Self {
        let (m, h) = net.degrees();
        let shape = if net.is_triangle() { Shape::Triangle(m) } else { Shape::Tensor(m, h) };
        Self::new(shape, net.points(), net.weights())
    }

    /// The shares of the control points in the point at (r, s), or (u, v) of a triangle.
    pub(crate) fn shares(&self, [r, s]: [f64; 2]) -> Vec<f64> {
        let basis: Vec<f64> = match self.shape {
            Shape::Curve(n) => bernstein(n, r),
            Shape::Triangle(n) => {
                let term = |(i, j, k): (usize, usize, usize)| {
                    let powers = r.powi(i as i32) * s.powi(j as i32) * (1.0 - r - s).powi(k as i32);
                    choose(n, i) * choose(n - i, j) * powers
                };
                triangle_indices(n).map(term).collect()
            }
            Shape::Tensor(m, h) => {
                let (rows, columns) = (bernstein(m, r), bernstein(h, s));
                rows.iter().flat_map(|a| columns.iter().map(move |b| a * b)).collect()
            }
        };
        let total: f64 = basis.iter().zip(&self.weights).map(|(b, w)| b * w).sum();
        basis.iter().zip(&self.weights).map(|(b, w)| b * w / total).collect()
    }

    pub(crate) fn eval(&self, at: [f64; 2]) -> Vec3 {
        let shares = self.shares(at);
        std::array::from_fn(|a| shares.iter().zip(&self.points).map(|(f, p)| f * p[a]).sum())
    }

    /// The point of the domain where a control point belongs: (i/m, j/h), (i/n, j/n).
    pub(crate) fn places(&self) -> Vec<[f64; 2]> {
        let part = |i: usize, n: usize| i as f64 / n as f64;
        match self.shape {
            Shape::Curve(n) => (0..=n).map(|i| [part(i, n), 0.0]).collect(),
            Shape::Triangle(n) => triangle_indices(n).map(|(i, j, _)| [part(i, n), part(j, n)]).collect(),
            Shape::Tensor(m, h) => (0..=m).flat_map(|i| (0..=h).map(move |j| [part(i, m), part(j, h)])).collect(),
        }
    }

    /// The linear interpolants of the corners: one, or one over each diagonal.
    pub(crate) fn flat(&self, [r, s]: [f64; 2]) -> [Vec3; 2] {
        let p = &self.points;
        match self.shape {
            Shape::Curve(n) => [mix(&[(1.0 - r, p[0]), (r, p[n])]); 2],
            Shape::Triangle(n) => {
                let corners = [(n, 0, 0), (0, n, 0), (0, 0, n)].map(|index| p[triangle_index(n, index)]);
                [mix(&[(r, corners[0]), (s, corners[1]), (1.0 - r - s, corners[2])]); 2]
            }
            Shape::Tensor(m, h) => over_diagonals([p[0], p[h], p[m * (h + 1)], p[m * (h + 1) + h]], [r, s]),
        }
    }

    /// The largest distance of surface points from the triangles of the surface's own vertices at 2^depth steps a
    /// direction, at equal parameters, over either diagonal; `per` samples a cell and direction.
    pub(crate) fn deviation(&self, depth: [u32; 2], per: usize) -> f64 {
        let steps = depth.map(|d| 1_usize << d);
        let curve = matches!(self.shape, Shape::Curve(_));
        let steps = if curve { [steps[0], 1] } else { steps };
        let at = |i: usize, j: usize| [i as f64 / steps[0] as f64, j as f64 / steps[1] as f64];
        let offsets = || (0..=per).map(|x| x as f64 / per as f64);
        let mut worst = 0.0_f64;
        for (i, j) in (0..steps[0]).flat_map(|i| (0..steps[1]).map(move |j| (i, j))) {
            let triangle = matches!(self.shape, Shape::Triangle(_));
            if triangle && i + j >= steps[0] {
                continue;
            }
            let corners = [(0, 0), (0, 1), (1, 0), (1, 1)].map(|(a, b)| {
                let outside = triangle && i + j + a + b > steps[0];
                if outside { [0.0; 3] } else { self.eval(at(i + a, j + b)) }
            });
            for (x, y) in offsets().flat_map(|x| offsets().map(move |y| (x, y))) {
                let place = [(i as f64 + x) / steps[0] as f64, (j as f64 + y) / steps[1] as f64];
                if (curve && y > 0.0) || (triangle && x + y > 1.0 && i + j + 2 > steps[0]) {
                    continue;
                }
                let point = self.eval(place);
                let [one, other] = over_diagonals(corners, [x, y]);
                // Cells of a triangle have one diagonal, from (0, 1) to (1, 0).
                let errors =
                    if triangle { [0.0, distance(point, other)] } else { [one, other].map(|l| distance(point, l)) };
                worst = errors.into_iter().fold(worst, f64::max);
            }
        }
        worst
    }
}
