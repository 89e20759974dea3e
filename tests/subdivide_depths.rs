//! A-priori depths on known patches, the adaptive leaves of the displacement test, the table of the docs, bad input.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]
#![allow(clippy::disallowed_types, clippy::float_arithmetic)]

mod common;

use common::basis::triangle_indices;
use common::smooth::{Shape, Smooth, Vec3, distance};
use common::{SEED_P, SEED_Q};
use embedded_surfaces::geometry::Point3;
use embedded_surfaces::num::{I16F16, I32F32};
use embedded_surfaces::patch::{
    BicubicPatch, CubicCurve, CubicTriangle, QuadraticCurve, RationalCurve, RationalTensor, Surface, SurfaceNet,
    Tensor, TensorNet, Triangle, sphere,
};
use embedded_surfaces::subdivide::{MAX_DEPTH, SubdivideError, Tolerance, depth_by_edges};

/// Bicubic patches of two pairs of surfaces that cross: in one open curve, and in a loop and an open curve.
const OPEN_A: [[[i16; 3]; 4]; 4] = [
    [[-291, -314, -5], [-283, -108, 101], [-280, 114, 23], [-270, 323, 99]],
    [[-83, -289, 116], [-71, -97, 79], [-129, 123, -1], [-101, 319, -5]],
    [[130, -315, 10], [111, -127, 98], [127, 80, 30], [77, 293, -72]],
    [[300, -275, -73], [285, -106, 85], [304, 76, 11], [306, 285, 1]],
];
const OPEN_B: [[[i16; 3]; 4]; 4] = [
    [[-10, -343, -286], [-37, -357, -82], [51, -340, 117], [-54, -342, 280]],
    [[50, -124, -285], [-11, -128, -90], [68, -105, 110], [31, -100, 289]],
    [[-11, 140, -311], [63, 124, -120], [-54, 110, 117], [-60, 119, 281]],
    [[-2, 370, -282], [29, 367, -95], [43, 348, 103], [-46, 342, 288]],
];
const LOOP_A: [[[i16; 3]; 4]; 4] = [
    [[-300, -307, -120], [-294, -99, -100], [-294, 96, -110], [-311, 297, -130]],
    [[-115, -304, 160], [-100, -107, 420], [-95, 110, 380], [-101, 307, 150]],
    [[112, -296, -330], [92, -98, -360], [85, 106, -340], [104, 289, -320]],
    [[299, -304, 200], [290, -105, 260], [313, 91, 240], [286, 303, 220]],
];
const LOOP_B: [[[i16; 3]; 4]; 4] = [
    [[-327, -336, 48], [-314, -106, 50], [-314, 100, 52], [-308, 323, 46]],
    [[-120, -325, 50], [-118, -114, 44], [-121, 102, 47], [-118, 315, 52]],
    [[108, -340, 46], [89, -133, 52], [102, 102, 50], [91, 318, 49]],
    [[304, -345, 52], [308, -131, 48], [321, 96, 50], [314, 295, 46]],
];

fn tolerance(eps: f64) -> Tolerance {
    Tolerance::new(I16F16::from_bits((eps * 65536.0).round() as i32)).unwrap()
}

/// The first depth whose measured deviation is within the tolerance.
fn needed(smooth: &Smooth, eps: f64, from: u32, per: usize) -> u32 {
    (from..).find(|m| smooth.deviation([*m; 2], per) <= eps).unwrap()
}

/// The depths by edges and by second differences for tolerances 1, 1/4 and 1/100; the second is enough, and at most one
/// level more than enough.
fn check_depths(name: &str, net: &SurfaceNet<'_>, first: &[I32F32], edges: [u32; 3], seconds: [u32; 3]) {
    let smooth = Smooth::of(net);
    for (eps, (edge, second)) in [1.0, 0.25, 0.01].into_iter().zip(edges.into_iter().zip(seconds)) {
        let at = tolerance(eps);
        assert_eq!(depth_by_edges(first, at), edge, "{name} at {eps}");
        assert_eq!(net.depth_for(at), Ok(second), "{name} at {eps}");
        let eps = at.get().to_num::<f64>();
        let per = if second > 6 { 2 } else { 6 };
        let least = needed(&smooth, eps, second - 2, per);
        assert!(least <= second, "{name} at {eps}: {second} is not enough");
        assert!(second - least <= 1, "{name} at {eps}: {second}, where {least} is enough");
        // Directions apart: never more triangles, and within the tolerance.
        let [r, s] = net.depths_for(at).unwrap();
        assert!(r + s <= 2 * second);
        assert!(smooth.deviation([r, s], per) <= eps, "{name} at {eps}: {r}, {s}");
    }
}

#[test]
fn depths_of_triangles() {
    for (name, points) in [("P", SEED_P), ("Q", SEED_Q)] {
        let patch = CubicTriangle::from_ints(points).unwrap();
        check_depths(name, &patch.surface(), &patch.net().first_differences(), [9, 11, 16], [5, 6, 8]);
    }
}

#[test]
fn depths_of_tensor_products() {
    let cases = [
        ("open A", OPEN_A, [9, 11, 15], [5, 6, 9]),
        ("open B", OPEN_B, [9, 11, 15], [5, 6, 9]),
        ("loop A", LOOP_A, [10, 12, 17], [6, 7, 9]),
        ("loop B", LOOP_B, [8, 10, 15], [4, 5, 7]),
    ];
    for (name, points, edges, seconds) in cases {
        let patch = BicubicPatch::from_ints(points).unwrap();
        check_depths(name, &patch.surface(), &patch.net().first_differences(), edges, seconds);
    }
}

/// Of a patch bent along r only, s is not subdivided.
#[test]
fn directions_apart_save_triangles() {
    let patch = BicubicPatch::from_ints(LOOP_A).unwrap();
    let uniform = patch.surface().depth_for(tolerance(0.25)).unwrap();
    let [r, s] = patch.surface().depths_for(tolerance(0.25)).unwrap();
    assert_eq!((uniform, r, s), (7, 7, 6));
}

/// The sphere's octants have weights with the ratio 4: the bound from the net alone is conservative.
#[test]
fn depths_of_rational_patches() {
    let octants = sphere(Point3::ORIGIN, I16F16::from_num(100)).unwrap();
    for octant in &octants {
        let net = octant.surface();
        let (smooth, at) = (Smooth::of(&net), tolerance(1.0));
        let deep = net.depth_for(at).unwrap();
        let least = needed(&smooth, 1.0, 0, 6);
        assert!(least <= deep && deep <= least + 3, "{deep}, where {least} is enough");
    }
}

/// Two rational nets whose second derivative attains the bound at an end: |S'' | = 8Rw + 16Rw(w − 1) for the weights
/// 1, w, 1 and the points R, −R, R.
#[test]
fn the_rational_bound_is_attained() {
    let weights = [65_536, 98_304, 65_536].map(I16F16::from_bits);
    let line = QuadraticCurve::from_ints([[100, 0, 0], [-100, 0, 0], [100, 0, 0]]).unwrap();
    let curve = RationalCurve::new(line, weights).unwrap();
    let rows = Tensor::from_ints([[[100, 0, 0]; 2], [[-100, 0, 0]; 2], [[100, 0, 0]; 2]]).unwrap();
    let patch = RationalTensor::<3, 2>::new(rows, weights.map(|w| [w; 2])).unwrap();
    let columns = Tensor::from_ints([[[100, 0, 0], [-100, 0, 0], [100, 0, 0]]; 2]).unwrap();
    let turned = RationalTensor::<2, 3>::new(columns, [weights; 2]).unwrap();
    // An eighth is R·w(2w − 1) = 300.
    let bits = 300 << 16;
    for (over, depth) in [(0, 0), (-1, 1)] {
        let at = Tolerance::new(I16F16::from_bits(bits + over)).unwrap();
        assert_eq!(curve.net().depth_for(at), Ok(depth));
        assert_eq!(patch.surface().depth_for(at), Ok(depth));
        assert_eq!(turned.surface().depth_for(at), Ok(depth));
        assert_eq!(patch.surface().depths_for(at), Ok([depth, 0]));
        assert_eq!(turned.surface().depths_for(at), Ok([0, depth]));
    }
}

/// The surface does not follow a spike of the net, so that the bound is too deep by more than a level. The test of each
/// part is the better one there.
#[test]
fn spikes_of_the_net_are_the_exception() {
    let height = |i: usize, j: usize| if (i, j) == (4, 4) { 600 } else { 0 };
    let points: [[[i16; 3]; 9]; 9] =
        std::array::from_fn(|i| std::array::from_fn(|j| [60 * i as i16, 60 * j as i16, height(i, j)]));
    let patch = Tensor::<9, 9>::from_ints(points).unwrap();
    let deep = patch.surface().depth_for(tolerance(1.0)).unwrap();
    let least = needed(&Smooth::of(&patch.surface()), 1.0, 0, 6);
    let (leaves, deepest) = tensor_leaves(patch, tolerance(1.0), deep);
    assert_eq!((deep, least, deepest, leaves), (8, 5, 5, 220));
}

/// The leaves of a patch subdivided until flat, and the deepest.
fn leaves<P: Copy, const C: usize>(
    patch: P,
    limit: u32,
    is_flat: &dyn Fn(&P) -> bool,
    split: &dyn Fn(&P) -> [P; C],
) -> (usize, u32) {
    let (mut open, mut count, mut deepest) = (vec![(patch, 0)], 0, 0);
    while let Some((patch, level)) = open.pop() {
        if is_flat(&patch) {
            (count, deepest) = (count + 1, deepest.max(level));
        } else {
            assert!(level < limit, "deeper than the bound allows");
            open.extend(split(&patch).map(|part| (part, level + 1)));
        }
    }
    (count, deepest)
}

fn tensor_leaves<const M: usize, const H: usize>(patch: Tensor<M, H>, at: Tolerance, limit: u32) -> (usize, u32) {
    leaves(patch, limit, &|p: &Tensor<M, H>| p.surface().is_flat(at), &Tensor::subdivide)
}

/// As many leaves as the displacement test needs, never deeper than the bound: coordinates rounded to 2^-16 at each
/// level do not change the counts.
#[test]
fn adaptive_leaves_of_the_seed_patches() {
    for (points, counts) in [(SEED_P, [(769, 5), (3049, 6)]), (SEED_Q, [(718, 5), (2830, 6)])] {
        let patch = CubicTriangle::from_ints(points).unwrap();
        for (eps, count) in [1.0, 0.25].into_iter().zip(counts) {
            let at = tolerance(eps);
            let limit = patch.surface().depth_for(at).unwrap();
            let flat = |p: &CubicTriangle| p.surface().is_flat(at);
            assert_eq!(leaves(patch, limit, &flat, &Triangle::subdivide), count, "at {eps}");
        }
    }
}

// Degree elevation against subdivision.

fn binomial(n: usize, k: usize) -> f64 {
    if k > n { 0.0 } else { (0..k).fold(1.0, |c, i| c * (n - i) as f64 / (i + 1) as f64) }
}

/// The net of degree `to` of the same patch: b_I = Σ b_i C(I1,i1) C(I2,i2) C(I3,i3) / C(to, n).
fn elevated(smooth: &Smooth, n: usize, to: usize) -> Vec<Vec3> {
    let point = |(i, j, k): (usize, usize, usize)| {
        let mut sum = [0.0; 3];
        for (index, p) in triangle_indices(n).zip(&smooth.points) {
            let share = binomial(i, index.0) * binomial(j, index.1) * binomial(k, index.2) / binomial(to, n);
            (0..3).for_each(|a| sum[a] += share * p[a]);
        }
        sum
    };
    triangle_indices(to).map(point).collect()
}

/// The largest distance of a control point from the surface at its own parameters.
fn net_distance(net: &[Vec3], shape: Shape, surface: &Smooth) -> f64 {
    let places = Smooth { shape, points: net.to_vec(), weights: vec![1.0; net.len()] }.places();
    net.iter().zip(places).map(|(p, place)| distance(*p, surface.eval(place))).fold(0.0, f64::max)
}

fn subdivided_distance(level: u32) -> f64 {
    let mut nets = vec![CubicTriangle::from_ints(SEED_P).unwrap()];
    for _ in 0..level {
        nets = nets.iter().flat_map(Triangle::subdivide).collect();
    }
    let of = |net: &CubicTriangle| {
        let smooth = Smooth::of(&net.surface());
        net_distance(&smooth.points, Shape::Triangle(3), &smooth)
    };
    nets.iter().map(of).fold(0.0, f64::max)
}

fn elevated_distance(to: usize) -> f64 {
    let surface = Smooth::of(&CubicTriangle::from_ints(SEED_P).unwrap().surface());
    net_distance(&elevated(&surface, 3, to), Shape::Triangle(to), &surface)
}

#[test]
fn the_oracle_elevates_as_the_crate_does() {
    let patch = CubicTriangle::from_ints(SEED_P).unwrap();
    let ours = patch.elevate::<6, 28>().unwrap();
    for (p, q) in elevated(&Smooth::of(&patch.surface()), 3, 6).iter().zip(Smooth::of(&ours.surface()).points) {
        assert!(distance(*p, q) < 1e-4);
    }
}

/// The rows of the table in the module's docs are what is measured.
#[test]
fn the_table_of_the_docs() {
    let page = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/src/subdivide/mod.rs")).unwrap();
    let (_, table) = page.split_once("| control points |").unwrap();
    let rows: Vec<Vec<f64>> = table
        .lines()
        .skip(2)
        .map_while(|line| line.strip_prefix("//! |"))
        .map(|line| line.trim_end_matches('|').split('|').map(|cell| cell.trim().parse().unwrap()).collect())
        .collect();
    let measured: Vec<Vec<f64>> = (0..6)
        .map(|level| {
            let degree = 3 << level;
            let points = (degree + 1) * (degree + 2) / 2;
            let round = |x: f64| (x * 1000.0).round() / 1000.0;
            let (raised, halved) = (round(elevated_distance(degree)), round(subdivided_distance(level as u32)));
            vec![points as f64, degree as f64, raised, level as f64, halved]
        })
        .collect();
    let close = |a: &Vec<f64>, b: &Vec<f64>| a.len() == b.len() && a.iter().zip(b).all(|(a, b)| (a - b).abs() < 0.0015);
    let same = rows.len() == measured.len() && rows.iter().zip(&measured).all(|(a, b)| close(a, b));
    assert!(same, "the table is {rows:?}, it should be {measured:?}");
    // 1/n against 1/4^level.
    for pair in measured[2..].windows(2) {
        let (raised, halved) = (pair[0][2] / pair[1][2], pair[0][4] / pair[1][4]);
        assert!((1.9..2.2).contains(&raised) && (3.8..4.1).contains(&halved), "{raised} {halved}");
    }
}

// Bad input and both ends.

#[test]
fn tolerances_are_positive() {
    for bits in [0, -1, i32::MIN] {
        let error = Tolerance::new(I16F16::from_bits(bits)).unwrap_err();
        assert_eq!(error, SubdivideError::Tolerance { bits });
        assert_eq!(error.to_string(), format!("the tolerance is not positive: {bits} / 65536"));
    }
    for bits in [1, i32::MAX] {
        assert_eq!(Tolerance::new(I16F16::from_bits(bits)).unwrap().get().to_bits(), bits);
    }
}

#[test]
fn too_deep_names_the_depth() {
    // Rows are up and down in turn: M_rr/8 = 7·131068·sqrt(2) units, 2^36.3 tolerances or 2^5.3.
    let end = |up: bool| I16F16::from_num(if up { 32_767 } else { -32_767 });
    let point = |i: usize| Point3::new(end(true), end(i % 4 < 2), end(i % 4 < 2));
    let points: Vec<_> = (0..18).map(point).collect();
    let least = Tolerance::new(I16F16::from_bits(1)).unwrap();
    let net = SurfaceNet::Tensor(TensorNet::new((8, 1), &points).unwrap());
    let error = net.depth_for(least).unwrap_err();
    assert_eq!(error, SubdivideError::TooDeep { needed: 19, limit: MAX_DEPTH });
    assert_eq!(net.depths_for(least), Err(error));
    assert_eq!(error.to_string(), "the tolerance needs 19 levels of subdivision, at most 16 are possible");
    // The box is the end of the bound: nothing is farther than its diagonal.
    assert!(net.flatness() <= I32F32::from_num(65_534 * 3 / 2));
    assert_eq!(net.depth_for(tolerance(32_767.0)).unwrap(), 3);
}

#[test]
fn a_point_is_flat() {
    let (least, point) = (Tolerance::new(I16F16::from_bits(1)).unwrap(), [-32_767, 32_767, 5]);
    let triangle = CubicTriangle::from_ints([point; 10]).unwrap();
    let patch = BicubicPatch::from_ints([[point; 4]; 4]).unwrap();
    for net in [triangle.surface(), patch.surface()] {
        assert_eq!(net.flatness(), 0);
        assert_eq!(net.depth_for(least), Ok(0));
        assert_eq!(net.depths_for(least), Ok([0, 0]));
        assert!(net.is_flat(least));
    }
    let curve = CubicCurve::from_ints([point; 4]).unwrap();
    assert_eq!((curve.net().flatness().to_bits(), curve.net().depth_for(least)), (0, Ok(0)));
    assert!(curve.net().is_flat(least));
    assert_eq!(depth_by_edges(&triangle.net().first_differences(), least), 0);
    assert_eq!(depth_by_edges(&[], least), 0);
}

/// A folded net in a line is not flat, though all its points are on the lines of the corners.
#[test]
fn folds_are_not_flat() {
    let fold = CubicCurve::from_ints([[0, 0, 0], [90, 0, 0], [-60, 0, 0], [30, 0, 0]]).unwrap();
    assert!(!fold.net().is_flat(tolerance(1.0)));
    let collinear = Triangle::<2, 6>::from_ints([[0, 0, 0], [4, 0, 0], [9, 0, 0], [8, 0, 0], [12, 0, 0], [16, 0, 0]]);
    assert!(!collinear.unwrap().surface().is_flat(tolerance(0.5)));
    assert!(collinear.unwrap().surface().is_flat(tolerance(1.0)));
}
