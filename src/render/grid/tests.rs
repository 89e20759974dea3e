//! Vertices against exact rationals, bit-equal along shared edges; segment counts against sampled deviations.
#![allow(clippy::unwrap_used, clippy::panic, clippy::disallowed_types, clippy::float_arithmetic)]

use super::super::depth::DepthWindow;
use super::super::style::Style;
use super::bicubic::Bicubic;
use super::counts::Segments;
use super::vertices::{self, Normals, RowSink, Rows, Vertex};
use super::{Collector, FRACTION_BITS};
use crate::forward::{Form, Fraction};
use crate::geometry::Point3;
use crate::num::I16F16;
use crate::patch::{RationalTensorNet, RationalTriangleNet, SurfaceNet, TensorNet, TriangleNet};
use crate::reference;
use crate::render::plan::Plan;
use crate::subdivide::{PatchTopology, topology};
use proptest::prelude::*;
use std::collections::BTreeMap;
use std::vec::Vec;

/// Keeps every vertex by its place.
struct Keep<'k>(&'k mut Vertices, u32);

/// A vertex and its normal.
#[derive(Clone, Copy, Debug)]
struct Kept {
    vertex: Vertex,
    normal: Option<[i32; 3]>,
}

type Vertices = BTreeMap<(u32, u32), Kept>;

impl RowSink for Keep<'_> {
    fn row(&mut self, rows: &mut Rows, normals: &dyn Normals, j: u32, count: usize) {
        for (i, vertex) in rows.0[(j & 1) as usize].iter().take(count).enumerate() {
            let i = self.1 + i as u32;
            self.0.insert((i, j), Kept { vertex: *vertex, normal: normals.normal(i, j) });
        }
    }
}

const WINDOW: (i32, i32) = (-2000, 2000);

/// The vertices by the point engine.
fn general(net: SurfaceNet<'_>, counts: (u32, u32)) -> Vertices {
    let plan = Plan::of(Form::surface(net, counts), true).unwrap();
    let fraction = Fraction::of(plan.budget.scale, FRACTION_BITS);
    let (mut all, mut rows, mut first) = (BTreeMap::new(), Rows::new(), 0);
    while first < counts.0 {
        let columns = (first, (first + 32).min(counts.0));
        let (form, window) = (&plan.form, DepthWindow::of(WINDOW.0, WINDOW.1));
        let (rows, style, sink) = (&mut rows, Style::Shaded, &mut Keep(&mut all, first));
        let kept = &mut vertices::Kept::new(first, net, form);
        plan.walk(Collector { rows, kept, sink, style, window, fraction, form, columns });
        first = columns.1;
    }
    all
}

/// The vertices of a patch of degree 3 or less in fixed point.
fn short(net: SurfaceNet<'_>, counts: (u32, u32)) -> Vertices {
    let (mut all, mut rows, mut first) = (BTreeMap::new(), Rows::new(), 0);
    let window = DepthWindow::of(WINDOW.0, WINDOW.1);
    let mut grid = Bicubic::blank(net, counts);
    grid.set_up();
    while first < grid.columns() {
        let columns = (first, (first + 32).min(grid.columns()));
        grid.walk(columns, &mut rows, &mut Keep(&mut all, first), (window, None));
        first = columns.1;
    }
    let turned = |((i, j), v): (_, Kept)| ((j, i), Kept { normal: v.normal.map(|n| n.map(|c| -c)), ..v });
    if grid.is_turned() { all.into_iter().map(turned).collect() } else { all }
}

/// The normal, of length 1, from differences of exact points; `None` where the tangents are nearly parallel or the surface
/// bends sharply.
fn steep_normal(net: SurfaceNet<'_>, u: f64, v: f64) -> Option<[f64; 3]> {
    let (h, point) = (1e-5, |u: f64, v: f64| reference::point(net, u, v));
    let minus = |p: [f64; 3], q: [f64; 3]| [p[0] - q[0], p[1] - q[1], p[2] - q[2]];
    let (r, s) = (minus(point(u + h, v), point(u - h, v)), minus(point(u, v + h), point(u, v - h)));
    let cross = [r[1] * s[2] - r[2] * s[1], r[2] * s[0] - r[0] * s[2], r[0] * s[1] - r[1] * s[0]];
    let length = |p: [f64; 3]| p.iter().map(|c| c * c).sum::<f64>().sqrt();
    let is_clear = length(cross) > 0.05 * length(r) * length(s) && length(r).min(length(s)) > 10.0 * h;
    is_clear.then(|| cross.map(|c| c / length(cross)))
}

fn place(v: &Kept) -> [i32; 3] {
    [v.vertex.x, v.vertex.y, v.vertex.depth.into()]
}

fn points(count: usize, pixels: i32) -> impl Strategy<Value = Vec<Point3>> {
    let c = -pixels << 16..=pixels << 16;
    proptest::collection::vec((c.clone(), c.clone(), c).prop_map(|(x, y, z)| Point3::from_bits(x, y, z)), count)
}

/// ⌊256·c⌋ from f64, with a range where the sum's errors leave it open.
fn is_floor(ours: i32, c: f64) -> bool {
    (f64::from(ours) - 1e-4..f64::from(ours) + 1.0 + 1e-4).contains(&(c * 256.0))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(96))]

    #[test]
    fn vertices_are_rounded_down_everywhere(
        m in 1_usize..6, h in 1_usize..6, r in 1_u32..70, s in 1_u32..9, net in points(36, 300),
        weights in proptest::collection::vec(1 << 14..1 << 18, 36), rational: bool, triangle: bool,
    ) {
        let (m, h, s) = if triangle { (m, m, r) } else { (m, h, s) };
        let count = if triangle { (m + 1) * (m + 2) / 2 } else { (m + 1) * (h + 1) };
        let weights: Vec<I16F16> = weights[..count].iter().map(|w| I16F16::from_bits(*w)).collect();
        let (tri, tensor) = (TriangleNet::new(m, &net[..count]), TensorNet::new((m, h), &net[..count]));
        let net = match (triangle, rational) {
            (true, false) => SurfaceNet::Triangle(tri.unwrap()),
            (true, true) => SurfaceNet::RationalTriangle(RationalTriangleNet::new(tri.unwrap(), &weights).unwrap()),
            (false, false) => SurfaceNet::Tensor(tensor.unwrap()),
            (false, true) => SurfaceNet::RationalTensor(RationalTensorNet::new(tensor.unwrap(), &weights).unwrap()),
        };
        prop_assume!(Plan::of(Form::surface(net, (r, s)), true).is_ok());
        let all = general(net, (r, s));
        prop_assert_eq!(all.len() as u64, Form::surface(net, (r, s)).point_count());
        for ((i, j), v) in &all {
            let p = reference::point(net, f64::from(*i) / f64::from(r), f64::from(*j) / f64::from(s));
            prop_assert!(is_floor(v.vertex.x, p[0]) && is_floor(v.vertex.y, p[1]), "{v:?} for {p:?}");
        }
    }

    /// The short engine: the same bits on edges, close inside.
    #[test]
    fn short_grids_agree_with_the_point_engine(
        m in 1_usize..4, h in 1_usize..4, net in points(16, 150), r in 1_u32..40, s in 1_u32..14, turned: bool,
    ) {
        let net = SurfaceNet::Tensor(TensorNet::new((m, h), &net[..(m + 1) * (h + 1)]).unwrap());
        let (r, s) = if turned { (s, r) } else { (r, s) };
        let (ours, exact) = (short(net, (r, s)), general(net, (r, s)));
        prop_assert_eq!(ours.len(), exact.len());
        for ((i, j), v) in &ours {
            let other = exact.get(&(*i, *j)).unwrap();
            let apart = place(v).into_iter().zip(place(other)).map(|(a, b)| a.abs_diff(b)).max().unwrap();
            let is_edge = *i == 0 || *j == 0 || *i == r || *j == s;
            prop_assert!(apart <= if is_edge { 0 } else { 2 }, "{v:?} {other:?} at {i}, {j}");
            let (u, w) = (f64::from(*i) / f64::from(r), f64::from(*j) / f64::from(s));
            if let Some(normal) = steep_normal(net, u, w) {
                let ours = v.normal.unwrap().map(f64::from);
                let dot: f64 = ours.iter().zip(normal).map(|(a, b)| a * b).sum();
                let cosine = dot / ours.iter().map(|c| c * c).sum::<f64>().sqrt();
                prop_assert!(cosine > 0.9999, "{ours:?} {normal:?}");
            }
        }
    }

    /// An edge of a patch of one kind is an edge of one of another kind, along or against it: equal bits.
    #[test]
    fn shared_edges_have_equal_vertices(
        edge in points(4, 200), a in points(16, 200), b in points(20, 200), n in 1_u32..12, other in 1_u32..12,
        reversed: bool, kind in 0..4,
    ) {
        let mut left = a.clone();
        left[..4].copy_from_slice(&edge);
        let left = SurfaceNet::Tensor(TensorNet::new((3, 3), &left).unwrap());
        let along = |k: usize| if reversed { edge[3 - k] } else { edge[k] };
        let at = |k: u32| if reversed { n - k } else { k };
        let mut right = b;
        let ones = [I16F16::from_num(3); 20];
        // The edge as the side s = 0, r = 1, or w = 0 of the second patch.
        type Place = fn(u32, u32) -> (u32, u32);
        let (right, counts, of): (_, _, Place) = match kind {
            0 => {
                (0..4).for_each(|k| right[4 * k] = along(k));
                (SurfaceNet::Tensor(TensorNet::new((3, 3), &right[..16]).unwrap()), (n, other), |k, _| (k, 0))
            }
            1 => {
                (0..4).for_each(|k| right[16 + k] = along(k));
                (SurfaceNet::Tensor(TensorNet::new((4, 3), &right).unwrap()), (other, n), |k, last| (last, k))
            }
            2 => {
                (0..4).for_each(|k| right[4 * k] = along(k));
                let net = TensorNet::new((3, 3), &right[..16]).unwrap();
                (SurfaceNet::RationalTensor(RationalTensorNet::new(net, &ones[..16]).unwrap()), (n, other), |k, _| (k, 0))
            }
            _ => {
                // w = 0 runs from T1 (u = 1) to T2.
                [0, 1, 3, 6].into_iter().enumerate().for_each(|(k, index)| right[index] = along(k));
                (SurfaceNet::Triangle(TriangleNet::new(3, &right[..10]).unwrap()), (n, n), |k, last| (last - k, k))
            }
        };
        let first = short(left, (other, n));
        let exact = general(left, (other, n));
        let is_short = Bicubic::suits::<SurfaceNet<'_>>(&right);
        let second = if is_short { short(right, counts) } else { general(right, counts) };
        for k in 0..=n {
            let here = place(first.get(&(0, k)).unwrap());
            prop_assert_eq!(here, place(exact.get(&(0, k)).unwrap()));
            prop_assert_eq!(here, place(second.get(&of(at(k), counts.0)).unwrap()), "{} of {}", k, n);
        }
    }

    /// The surface is within the tolerance of the bilinear cells, or triangles, at the counts.
    #[test]
    fn counts_keep_the_tolerance(
        (m, h) in prop_oneof![Just((3, 3)), (1_usize..5, 1_usize..5)], net in points(25, 60),
        triangle: bool, rational: bool,
        weights in proptest::collection::vec(1 << 15..1 << 17, 25), tolerance in 1 << 14..1 << 18,
    ) {
        let h = if triangle { m } else { h };
        let count = if triangle { (m + 1) * (m + 2) / 2 } else { (m + 1) * (h + 1) };
        let weights: Vec<I16F16> = weights[..count].iter().map(|w| I16F16::from_bits(*w)).collect();
        let (tri, tensor) = (TriangleNet::new(m, &net[..count]), TensorNet::new((m, h), &net[..count]));
        let net = match (triangle, rational) {
            (true, false) => SurfaceNet::Triangle(tri.unwrap()),
            (true, true) => SurfaceNet::RationalTriangle(RationalTriangleNet::new(tri.unwrap(), &weights).unwrap()),
            (false, false) => SurfaceNet::Tensor(tensor.unwrap()),
            (false, true) => SurfaceNet::RationalTensor(RationalTensorNet::new(tensor.unwrap(), &weights).unwrap()),
        };
        let mut edges = [PatchTopology::default()];
        topology(&[net], &mut edges).unwrap();
        let segments = Segments::of(&[net], &edges, I16F16::from_bits(tolerance)).unwrap();
        let (r, s) = segments.counts(net, &edges[0]);
        let point = |u: f64, v: f64| reference::point(net, u, v);
        let limit = f64::from(tolerance) / 65536.0;
        let mut worst = 0.0_f64;
        for cell in 0..40_u32 {
            let (i, j) = (f64::from(cell * 7 % u32::from(r)), f64::from(cell * 5 % u32::from(s)));
            let (r, s) = (f64::from(r), f64::from(s));
            if triangle && i + j + 1.0 > r {
                continue;
            }
            let corner = |a: f64, b: f64| point((i + a) / r, (j + b) / s);
            let half = triangle && i + j + 2.0 > r;
            let (p, q, t) = (corner(0.0, 0.0), corner(1.0, 0.0), corner(0.0, 1.0));
            let o = if half { p } else { corner(1.0, 1.0) };
            for (a, b) in [(0.5, 0.5), (0.3, 0.6), (0.5, 0.0), (0.1, 0.8), (0.33, 0.33)] {
                if half && a + b > 1.0 {
                    continue;
                }
                let true_point = corner(a, b);
                let at = |axis: usize| {
                    if half {
                        p[axis] + a * (q[axis] - p[axis]) + b * (t[axis] - p[axis])
                    } else {
                        (1.0 - a) * ((1.0 - b) * p[axis] + b * t[axis]) + a * ((1.0 - b) * q[axis] + b * o[axis])
                    }
                };
                worst = worst.max((at(0) - true_point[0]).hypot(at(1) - true_point[1]));
            }
            let longest = [q, t, o].iter().map(|c| (c[0] - p[0]).abs().max((c[1] - p[1]).abs())).fold(0.0, f64::max);
            prop_assert!(longest < 126.5, "a cell of {longest} pixels");
        }
        prop_assert!(worst <= limit, "{worst} pixels at {r} x {s} segments for {limit}");
    }
}
