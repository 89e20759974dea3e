//! The oracle of smooth skins: normals, gaps and the condition itself in `f64` from emitted control points; and meshes.
#![allow(dead_code, reason = "each test uses its part")]

use embedded_surfaces::g1::{Controls, G1Error, Interpolant, Options, Quality, Shift};
use embedded_surfaces::geometry::{Point3, Vector3};
use embedded_surfaces::mesh::{Faces, Links, Mesh, MeshError};
use embedded_surfaces::num::I32F32;
use std::collections::HashMap;

pub(crate) type V3 = [f64; 3];
/// b\[i,j,k\] with i descending, then j descending.
pub(crate) type Net = [V3; 21];

pub(crate) fn minus(a: V3, b: V3) -> V3 {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

pub(crate) fn plus(a: V3, b: V3) -> V3 {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

pub(crate) fn times(a: V3, factor: f64) -> V3 {
    a.map(|c| c * factor)
}

pub(crate) fn dot(a: V3, b: V3) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(crate) fn cross(a: V3, b: V3) -> V3 {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

pub(crate) fn length(a: V3) -> f64 {
    dot(a, a).sqrt()
}

pub(crate) fn unit(a: V3) -> V3 {
    times(a, 1.0 / length(a))
}

/// A mesh as a test makes it.
#[derive(Clone, Debug, Default)]
pub(crate) struct Skin {
    pub(crate) points: Vec<V3>,
    pub(crate) faces: Vec<[u16; 3]>,
    pub(crate) normals: Option<Vec<V3>>,
}

/// What became of it: control points and how good they are.
pub(crate) struct Solution {
    pub(crate) nets: Vec<Net>,
    pub(crate) quality: Quality,
    pub(crate) shifts: Vec<Shift>,
}

/// Why there is nothing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Refusal {
    Mesh(MeshError),
    Surface(G1Error),
}

impl Refusal {
    /// The name of the error.
    pub(crate) fn kind(self) -> String {
        let debug = match self {
            Self::Mesh(error) => format!("{error:?}"),
            Self::Surface(error) => format!("{error:?}"),
        };
        debug.chars().take_while(|c| c.is_alphanumeric()).collect()
    }
}

pub(crate) fn fixed(c: f64) -> I32F32 {
    I32F32::from_bits((c * 4_294_967_296.0 + 0.5).floor() as i64)
}

pub(crate) fn point(p: V3) -> Point3<I32F32> {
    Point3::from_array(p.map(fixed))
}

pub(crate) fn float(p: Point3<I32F32>) -> V3 {
    p.to_array().map(|c| c.to_bits() as f64 / 4_294_967_296.0)
}

impl Skin {
    /// The largest side of the box.
    fn extent(&self) -> f64 {
        let side = |c: usize| {
            let range = self.points.iter().fold((f64::MAX, f64::MIN), |(l, h), p| (l.min(p[c]), h.max(p[c])));
            range.1 - range.0
        };
        (0..3).map(side).fold(0.0, f64::max)
    }

    /// Scaled by a power of two to an extent of 2^8 to 2^9; and the factor.
    pub(crate) fn scaled(mut self) -> (Self, f64) {
        let factor = (8.0 - self.extent().log2().floor()).exp2();
        self.points.iter_mut().for_each(|p| *p = times(*p, factor));
        (self, factor)
    }

    pub(crate) fn shortest_edge(&self) -> f64 {
        let edges = self.faces.iter().flat_map(|f| [[f[0], f[1]], [f[1], f[2]], [f[2], f[0]]]);
        edges.map(|e| length(minus(self.points[e[0] as usize], self.points[e[1] as usize]))).fold(f64::MAX, f64::min)
    }

    /// The surface, at the size of the skin. Normals get more bits than a unit vector in `I32F32` has.
    pub(crate) fn solve(&self, controls: &Controls<'_>, options: &Options) -> Result<Solution, Refusal> {
        let points: Vec<_> = self.points.iter().map(|p| point(*p)).collect();
        let normal =
            |n: &V3| Vector3::from_array(n.map(|c| fixed(c * if length(*n) < 1e-3 { 1.0 } else { 16_777_216.0 })));
        let normals: Option<Vec<_>> = self.normals.as_ref().map(|normals| normals.iter().map(normal).collect());
        let links = Links::<800, 4800>::new(points.len(), Faces::Triangles(&self.faces)).map_err(Refusal::Mesh)?;
        let mesh = Mesh::<I32F32>::new(&points, &links).map_err(Refusal::Mesh)?;
        let controls = Controls { normals: controls.normals.or(normals.as_deref()), ..*controls };
        let mut shifts = vec![Shift::NONE; points.len()];
        let surface = Interpolant::new(&mesh, &controls, options, &mut shifts).map_err(Refusal::Surface)?;
        let triangles = surface.triangles().collect::<Result<Vec<_>, _>>().map_err(Refusal::Surface)?;
        let nets = triangles.iter().map(|t| t.points().map(float)).collect();
        let quality = surface.quality().map_err(Refusal::Surface)?;
        Ok(Solution { nets, quality, shifts: surface.shifts().to_vec() })
    }

    pub(crate) fn smooth(&self) -> Result<Solution, Refusal> {
        self.solve(&Controls::default(), &Options::default())
    }

    /// Inner edges: the face and corner that they leave on either side.
    pub(crate) fn seams(&self) -> Vec<[(usize, usize); 2]> {
        let mut sides = HashMap::new();
        for (f, face) in self.faces.iter().enumerate() {
            sides.extend((0..3).map(|c| ((face[c], face[(c + 1) % 3]), (f, c))));
        }
        let mut seams: Vec<_> = sides
            .iter()
            .filter(|((a, b), _)| a < b)
            .filter_map(|((a, b), left)| Some([*left, *sides.get(&(*b, *a))?]))
            .collect();
        seams.sort_unstable();
        seams
    }
}

/// b with weight a at corner c, b at the next, d at the one after it.
pub(crate) fn at(net: &Net, c: usize, weights: [usize; 3]) -> V3 {
    let [a, b, d] = weights;
    let [_, j, k] = match c {
        0 => [a, b, d],
        1 => [d, a, b],
        _ => [b, d, a],
    };
    net[(j + k) * (j + k + 1) / 2 + k]
}

/// The rows along an edge: c, l and r.
pub(crate) struct Seam {
    pub(crate) c: [V3; 6],
    pub(crate) l: [V3; 5],
    pub(crate) r: [V3; 5],
    /// Whether both faces have the same boundary points.
    pub(crate) closed: bool,
}

impl Seam {
    pub(crate) fn of(nets: &[Net], [(f, c), (g, d)]: [(usize, usize); 2]) -> Self {
        let (left, right) = (&nets[f], &nets[g]);
        let row = |net: &Net, c: usize| core::array::from_fn(|i| at(net, c, [5 - i, i, 0]));
        let (own, mut other): ([V3; 6], [V3; 6]) = (row(left, c), row(right, d));
        other.reverse();
        let r = core::array::from_fn(|i| at(right, d, [i, 4 - i, 1]));
        Self { c: own, l: core::array::from_fn(|i| at(left, c, [4 - i, i, 1])), r, closed: own == other }
    }

    /// The derivatives along the edge, into the left face and into the right one.
    fn derivatives(&self, t: f64) -> [V3; 3] {
        let bernstein = |i: usize| [1.0, 4.0, 6.0, 4.0, 1.0][i] * t.powi(i as i32) * (1.0 - t).powi(4 - i as i32);
        let sum = |row: &[V3], shift: usize| {
            let terms = (0..5).map(|i| times(minus(row[i + shift], self.c[i]), bernstein(i)));
            terms.fold([0.0; 3], plus)
        };
        [sum(&self.c, 1), sum(&self.l, 0), sum(&self.r, 0)]
    }

    /// The largest angle between the normals at these many places.
    pub(crate) fn angle(&self, samples: usize) -> f64 {
        let angle = |t: f64| {
            let [along, left, right] = self.derivatives(t);
            let (p, q) = (unit(cross(along, left)), unit(cross(right, along)));
            length(cross(p, q)).atan2(dot(p, q))
        };
        (0..=samples).map(|s| angle(s as f64 / samples as f64)).fold(0.0, f64::max)
    }

    /// How near the edge comes to a place without a normal: the least length of a normal over that at the ends.
    pub(crate) fn pinch(&self, samples: usize) -> f64 {
        let normal = |t: f64| {
            let [along, left, right] = self.derivatives(t);
            length(cross(along, left)).min(length(cross(right, along)))
        };
        let least = (0..=samples).map(|s| normal(s as f64 / samples as f64)).fold(f64::MAX, f64::min);
        least / normal(0.0).max(normal(1.0))
    }

    /// The largest of the six Bernstein coefficients of S + κT + mE, κ and m linear between what the tangents at the ends
    /// say, as a multiple of what rounding by half of 2^-`bits` may leave.
    pub(crate) fn residual(&self, bits: i32) -> f64 {
        let t: [V3; 5] = core::array::from_fn(|i| minus(self.l[i], self.r[i]));
        let e: [V3; 5] = core::array::from_fn(|i| minus(self.c[i + 1], self.c[i]));
        let s: [V3; 5] = core::array::from_fn(|i| plus(minus(self.l[i], self.c[i]), minus(self.r[i], self.c[i + 1])));
        // At an end: s + κt + me = 0 in the tangent plane.
        let solve = |i: usize| {
            let normal = cross(t[i], e[i]);
            let area = dot(normal, normal);
            let kappa = -dot(cross(s[i], e[i]), normal) / area;
            let m = -dot(cross(t[i], s[i]), normal) / area;
            // What an error of 1 in the rows does to κ and m.
            (kappa, m, (length(t[i]) + length(e[i])) / area.sqrt())
        };
        let (ends, choices) = ([solve(0), solve(4)], [1.0, 4.0, 6.0, 4.0, 1.0]);
        let term = |i: usize, end: usize| plus(s[i], plus(times(t[i], ends[end].0), times(e[i], ends[end].1)));
        let size = (0..5).map(|i| length(t[i]) + length(e[i])).fold(0.0, f64::max);
        let factors = 4.0 + ends.iter().map(|(kappa, m, _)| kappa.abs() + m.abs()).fold(0.0, f64::max);
        let floor = factors * (1.0 + size * ends[0].2.max(ends[1].2)) * 2_f64.powi(-bits);
        let coefficient = |k: usize| {
            let own = if k < 5 { times(term(k, 0), choices[k]) } else { [0.0; 3] };
            let other = if k > 0 { times(term(k - 1, 1), choices[k - 1]) } else { [0.0; 3] };
            length(plus(own, other)) / 5.0
        };
        (0..6).map(coefficient).fold(0.0, f64::max) / floor
    }
}

/// Every coordinate rounded half up to 2^-16.
pub(crate) fn rounded(nets: &[Net]) -> Vec<Net> {
    let round = |c: f64| (c * 65_536.0 + 0.5).floor() / 65_536.0;
    nets.iter().map(|net| net.map(|p| p.map(round))).collect()
}

/// The point of a quintic triangle at barycentric (u, v, w).
pub(crate) fn eval(net: &Net, [u, v, w]: V3) -> V3 {
    let factorial = |n: usize| (1..=n).product::<usize>() as f64;
    let order = (0..=5).rev().flat_map(|i: usize| (0..=5 - i).rev().map(move |j| [i, j, 5 - i - j]));
    order.zip(net).fold([0.0; 3], |sum, ([i, j, k], p)| {
        let weight = 120.0 / (factorial(i) * factorial(j) * factorial(k));
        plus(sum, times(*p, weight * u.powi(i as i32) * v.powi(j as i32) * w.powi(k as i32)))
    })
}

/// Places in a triangle, n a side.
pub(crate) fn places(n: usize) -> impl Iterator<Item = V3> {
    (0..=n).flat_map(move |i| (0..=n - i).map(move |j| [i, j, n - i - j].map(|c| c as f64 / n as f64)))
}
