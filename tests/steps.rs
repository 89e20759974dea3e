//! Step counts against the formulas of the maths (section 2) in rationals, and against what they promise.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod common;

use common::basis::{tensor_basis, triangle_basis, triangle_indices};
use common::draw::{cases, net};
use common::{coordinate, ratio, triangle_index};
use embedded_surfaces::forward::Steps;
use embedded_surfaces::geometry::Point3;
use embedded_surfaces::num::I16F16;
use embedded_surfaces::patch::{
    Barycentric, BicubicPatch, BilinearPatch, CubicTriangle, CurveNet, Parameter, Surface, SurfaceNet, TensorNet,
    TriangleNet,
};
use num_bigint::BigInt;
use num_rational::BigRational;
use num_traits::{One, Signed, ToPrimitive, Zero};
use proptest::prelude::*;

type Net = Vec<Point3<I16F16>>;
type Index = (usize, usize, usize);

fn largest(values: impl IntoIterator<Item = BigRational>) -> BigRational {
    values.into_iter().map(|v| v.abs()).max().unwrap_or_else(BigRational::zero)
}

fn count(n: &BigRational) -> u32 {
    n.to_integer().max(BigInt::one()).to_u32().unwrap()
}

fn floor_plus_one(bound: &BigRational) -> u32 {
    count(&(bound.floor() + BigRational::one()))
}

/// Net edges of a triangle along one axis: both parameter directions, then the third family.
fn triangle_edges(points: &Net, n: usize, axis: usize) -> [Vec<BigRational>; 3] {
    let at = |i, j, k| coordinate(&points[triangle_index(n, (i, j, k))], axis);
    let family = |edge: fn(Index) -> [Index; 2]| {
        let differences = triangle_indices(n - 1).map(edge).map(|[a, b]| at(a.0, a.1, a.2) - at(b.0, b.1, b.2));
        differences.collect::<Vec<_>>()
    };
    [
        family(|(i, j, k)| [(i + 1, j, k), (i, j, k + 1)]),
        family(|(i, j, k)| [(i, j + 1, k), (i, j, k + 1)]),
        family(|(i, j, k)| [(i + 1, j, k), (i, j + 1, k)]),
    ]
}

/// m·ΔP along a line of the net.
fn slopes(line: &[BigRational]) -> Vec<BigRational> {
    line.windows(2).map(|w| (&w[1] - &w[0]) * BigInt::from(line.len() - 1)).collect()
}

/// One degree up: (i/m) e_(i−1) + (1 − i/m) e_i.
fn elevated(e: &[BigRational]) -> Vec<BigRational> {
    let m = e.len() as i64;
    let at = |i: i64| usize::try_from(i).ok().and_then(|i| e.get(i)).cloned().unwrap_or_else(BigRational::zero);
    (0..=m).map(|i| at(i - 1) * ratio(i, m) + at(i) * ratio(m - i, m)).collect()
}

/// S_r and S_s along one axis as Bernstein coefficients: of their own degrees, then both of degrees (m, h), in
/// `[i][j]` order.
struct Slopes {
    own: [Vec<BigRational>; 2],
    common: [Vec<BigRational>; 2],
}

fn tensor_slopes(points: &Net, (m, h): (usize, usize), axis: usize) -> Slopes {
    let at = |i: usize, j: usize| coordinate(&points[i * (h + 1) + j], axis);
    let rows: Vec<Vec<_>> = (0..=m).map(|i| slopes(&(0..=h).map(|j| at(i, j)).collect::<Vec<_>>())).collect();
    let columns: Vec<Vec<_>> = (0..=h).map(|j| slopes(&(0..=m).map(|i| at(i, j)).collect::<Vec<_>>())).collect();
    let by_columns: Vec<Vec<_>> = columns.iter().map(|c| elevated(c)).collect();
    Slopes {
        own: [columns.concat(), rows.concat()],
        common: [
            (0..=m).flat_map(|i| by_columns.iter().map(move |c| c[i].clone())).collect(),
            rows.iter().flat_map(|row| elevated(row)).collect(),
        ],
    }
}

/// (A, B, K, and the sign that K takes) of section 2.
fn tensor_bounds(points: &Net, degrees: (usize, usize)) -> (BigRational, BigRational, BigRational) {
    let ulp = ratio(1, 1 << 16);
    let [x, y] = [0, 1].map(|axis| tensor_slopes(points, degrees, axis));
    let of = |direction: usize| largest(x.own[direction].iter().chain(&y.own[direction]).cloned()).max(ulp.clone());
    let (a, b) = (of(0), of(1));
    let both = [-1, 1].map(|sign| {
        largest([&x, &y].into_iter().flat_map(|axis| {
            let pairs = axis.common[0].iter().zip(&axis.common[1]);
            pairs.map(|(r, s)| r * &b + s * &a * ratio(sign, 1))
        }))
    });
    let [minus, plus] = both;
    let k = minus.min(plus).max(&a * &b);
    (a, b, k)
}

fn tensor_net(points: &Net, degrees: (usize, usize)) -> SurfaceNet<'_> {
    SurfaceNet::Tensor(TensorNet::new(degrees, &points[..(degrees.0 + 1) * (degrees.1 + 1)]).unwrap())
}

fn triangle_net(points: &Net, n: usize) -> SurfaceNet<'_> {
    SurfaceNet::Triangle(TriangleNet::new(n, &points[..(n + 1) * (n + 2) / 2]).unwrap())
}

proptest! {
    #![proptest_config(cases(300))]

    #[test]
    fn triangles_take_the_three_families(points in net::<I16F16>(45), n in 1_usize..=8) {
        let surface = triangle_net(&points, n);
        let edges = [0, 1, 2].map(|axis| triangle_edges(&points, n, axis));
        let all = edges[..2].iter().flatten().flatten().cloned();
        let hole_free = floor_plus_one(&(largest(all) * BigInt::from(n)));
        prop_assert_eq!(Steps::hole_free(surface), Steps::uniform(hole_free).unwrap());
        let two = edges.iter().flat_map(|families| families[..2].iter().flatten()).cloned();
        let paper = count(&(largest(two) * BigInt::from(n)).ceil());
        prop_assert_eq!(Steps::paper(surface), Steps::uniform(paper).unwrap());
    }

    #[test]
    fn tensors_take_both_diagonals(points in net::<I16F16>(81), m in 1_usize..=8, h in 1_usize..=8) {
        let surface = tensor_net(&points, (m, h));
        let (a, b, k) = tensor_bounds(&points, (m, h));
        let hole_free = Steps::new(floor_plus_one(&(&k / &b)), floor_plus_one(&(&k / &a))).unwrap();
        prop_assert_eq!(Steps::hole_free(surface), hole_free);
        let all = [0, 1, 2].map(|axis| tensor_slopes(&points, (m, h), axis).own.concat());
        let paper = count(&largest(all.concat()).ceil());
        prop_assert_eq!(Steps::paper(surface), Steps::uniform(paper).unwrap());
    }

    #[test]
    fn curves_take_the_longest_slope(points in net::<I16F16>(9), m in 1_usize..=8) {
        let all = [0, 1, 2].map(|axis| {
            slopes(&points[..=m].iter().map(|p| coordinate(p, axis)).collect::<Vec<_>>())
        });
        let expected = count(&largest(all.concat()).ceil());
        prop_assert_eq!(Steps::curve(CurveNet::new(&points[..=m]).unwrap()), expected);
    }
}

/// x and y of a tensor patch at i/n_r, j/n_s.
fn tensor_at(points: &Net, degrees: (usize, usize), steps: Steps, (i, j): (u32, u32)) -> [BigRational; 2] {
    let (r, s) = (Parameter::new(i, steps.r()).unwrap(), Parameter::new(j, steps.s()).unwrap());
    let [basis, ..] = tensor_basis(degrees, r, s);
    [0, 1].map(|axis| basis.value(points, None, axis))
}

fn within_one(a: &[BigRational; 2], b: &[BigRational; 2]) -> bool {
    a.iter().zip(b).all(|(a, b)| (a - b).abs() < BigRational::one())
}

/// One of `count` cells, by a fraction of 2^16.
fn cell(fraction: u64, count: u32) -> u32 {
    ((fraction * u64::from(count)) >> 16) as u32
}

/// A net of pixel-sized coordinates, turned every way.
fn small_net(len: usize) -> impl Strategy<Value = Net> {
    let c = || -(60_i32 << 16)..60 << 16;
    prop::collection::vec((c(), c(), c()).prop_map(|(x, y, z)| Point3::from_bits(x, y, z)), len)
}

proptest! {
    #![proptest_config(cases(100))]

    /// What the count promises: in one triangulation of the cells, corners differ by less than one unit in x and y.
    #[test]
    fn corners_of_triangulated_cells_differ_by_less_than_one_unit(
        points in small_net(16), m in 1_usize..=3, h in 1_usize..=3,
        cells in prop::collection::vec((0_u64..1 << 16, 0_u64..1 << 16), 24),
    ) {
        let points = points[..(m + 1) * (h + 1)].to_vec();
        let steps = Steps::hole_free(tensor_net(&points, (m, h)));
        let mut diagonals = [true; 2];
        for (i, j) in cells {
            let (i, j) = (cell(i, steps.r()), cell(j, steps.s()));
            let corner = |di, dj| tensor_at(&points, (m, h), steps, (i + di, j + dj));
            let [a, b, c, d] = [corner(0, 0), corner(1, 0), corner(0, 1), corner(1, 1)];
            prop_assert!(within_one(&a, &b) && within_one(&a, &c) && within_one(&b, &d) && within_one(&c, &d));
            diagonals = [diagonals[0] && within_one(&a, &d), diagonals[1] && within_one(&b, &c)];
        }
        prop_assert!(diagonals[0] || diagonals[1], "both diagonals are long");
    }

    #[test]
    fn corners_of_triangle_cells_differ_by_less_than_one_unit(
        points in small_net(10), n in 1_usize..=3, cells in prop::collection::vec((0_u64..1 << 16, 0_u64..1 << 16), 24),
    ) {
        let points = points[..(n + 1) * (n + 2) / 2].to_vec();
        let steps = Steps::hole_free(triangle_net(&points, n)).r();
        for (i, j) in cells {
            let i = cell(i, steps);
            let j = cell(j, steps - i);
            let corner = |i: u32, j: u32| {
                let [basis, ..] = triangle_basis(n, Barycentric::new(i, j, steps - i - j).unwrap());
                [0, 1].map(|axis| basis.value(&points, None, axis))
            };
            let [a, b, c] = [corner(i, j), corner(i + 1, j), corner(i, j + 1)];
            prop_assert!(within_one(&a, &b) && within_one(&a, &c) && within_one(&b, &c));
        }
    }
}

#[test]
fn counts_a_person_can_check() {
    let seed = CubicTriangle::from_ints(common::SEED_P).unwrap();
    assert_eq!(Steps::paper(seed.surface()), Steps::uniform(1020).unwrap()); // z: 3 · (400 − 60), p111 to p012
    // The longest edge in x and y: 200 in x from p012 to p003, and in the third family from p012 to p102.
    assert_eq!(Steps::hole_free(seed.surface()), Steps::uniform(601).unwrap());
    // Affine and axis-parallel: one cell a pixel is enough, and one more since the bound is strict.
    let flat = BilinearPatch::from_ints([[[0, 0, 9], [0, 20, 0]], [[50, 0, 0], [50, 20, 0]]]).unwrap();
    assert_eq!(Steps::hole_free(flat.surface()), Steps::new(51, 21).unwrap());
    assert_eq!(Steps::paper(flat.surface()), Steps::uniform(50).unwrap());
    let point = BicubicPatch::from_ints([[[7, 7, 7]; 4]; 4]).unwrap();
    assert_eq!(Steps::hole_free(point.surface()), Steps::uniform(1).unwrap());
    assert_eq!(Steps::paper(point.surface()), Steps::uniform(1).unwrap());
    // A patch that is a line: the other direction needs no steps.
    let line = BilinearPatch::from_ints([[[0, 0, 0], [0, 0, 5]], [[50, 0, 0], [50, 0, 5]]]).unwrap();
    assert_eq!(Steps::hole_free(line.surface()), Steps::new(51, 1).unwrap());
}

/// The longest net of the narrow type still has legal counts.
#[test]
fn extreme_nets_have_legal_counts() {
    let far =
        |sign: bool| if sign { Point3::from_ints(32_767, -32_767, 0) } else { Point3::from_ints(-32_767, 32_767, 0) };
    let points: Net = (0..81).map(|i| far(i % 2 == 0)).collect();
    let (a, b, k) = tensor_bounds(&points, (8, 8));
    assert_eq!(a, ratio(8 * 65_534, 1));
    let expected = Steps::new(floor_plus_one(&(&k / &b)), floor_plus_one(&(&k / &a))).unwrap();
    assert_eq!(Steps::hole_free(tensor_net(&points, (8, 8))), expected);
    assert_eq!(Steps::paper(tensor_net(&points, (8, 8))), Steps::uniform(8 * 65_534).unwrap());
    assert_eq!(Steps::curve(CurveNet::new(&points[..9]).unwrap()), 8 * 65_534);
    // The whole triangle's neighbours differ by the whole range at most.
    let n = Steps::hole_free(triangle_net(&points, 8)).r();
    assert!(n > 65_534 && n <= 8 * 65_534 + 1);
}
