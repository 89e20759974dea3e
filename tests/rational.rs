//! P1 for rational nets and for cell centres: every point is floor(exact + 1/2), against big rationals.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, clippy::disallowed_types, clippy::float_arithmetic)]

mod common;

use common::*;
use embedded_surfaces::forward::{CurveLattice, Lattice, LatticePoint, Sampling, Steps};
use embedded_surfaces::geometry::Point3;
use embedded_surfaces::num::I16F16;
use embedded_surfaces::patch::{
    CurveNet, RationalCurveNet, RationalTensorNet, RationalTriangleNet, Surface, SurfaceNet, TensorNet, TriangleNet,
    sphere,
};
use num_bigint::BigInt;
use num_rational::BigRational;
use proptest::prelude::*;

fn weights(bits: &[i32]) -> Vec<I16F16> {
    bits.iter().map(|b| I16F16::from_bits(*b)).collect()
}

fn weight(w: I16F16) -> BigRational {
    ratio(w.to_bits().into(), 1 << 16)
}

/// Coordinates and weights of every kind: whole, few and all fraction bits; weights up to 1024 : 1 and beyond.
fn nets() -> impl Strategy<Value = (Vec<i32>, Vec<i32>)> {
    let coordinates =
        |shift: u32, range: i32| prop::collection::vec((-range..=range).prop_map(move |c| c << shift), 243);
    let weights = |shift: u32, range: std::ops::RangeInclusive<i32>| {
        prop::collection::vec(range.prop_map(move |w| w << shift), 81)
    };
    let points = prop_oneof![coordinates(16, 300), coordinates(12, 3000), coordinates(0, 20_000_000)];
    let weights = prop_oneof![weights(16, 1..=4), weights(6, 1..=1024), weights(0, 1..=i32::MAX)];
    (points, weights)
}

fn steps() -> impl Strategy<Value = u32> {
    prop_oneof![1_u32..12, 1_u32..60, (0_u32..7).prop_map(|k| 1 << k), Just(97_u32)]
}

fn check(lattice: &Lattice<'_>, at: impl Fn(&LatticePoint, usize) -> BigRational) {
    let collected: Vec<_> = lattice.points().collect();
    assert_eq!(collected.len() as u64, lattice.point_count());
    assert_eq!(lattice.points().size_hint().0, collected.len());
    let mut walked = Vec::new();
    lattice.for_each(|p| walked.push(p));
    assert_eq!(walked, collected, "the iterator differs from for_each");
    let last = collected.iter().map(|p| p.i).max().unwrap_or(0);
    let stride = (collected.len() / 40).max(1);
    for p in collected.iter().enumerate().filter(|(n, p)| n % stride == 0 || p.i == last).map(|(_, p)| p).take(60) {
        for (axis, ours) in [p.x, p.y, p.z].into_iter().enumerate() {
            assert_eq!(BigInt::from(ours), round_half_up(&at(p, axis)), "axis {axis} of {p:?}, {:?}", lattice.budget());
        }
    }
}

/// Parameters of a lattice point, or of the centre of its cell.
fn parameters(p: &LatticePoint, (r, s): (u32, u32), centred: bool) -> (BigRational, BigRational) {
    let half = i64::from(centred);
    (ratio(2 * i64::from(p.i) + half, 2 * i64::from(r)), ratio(2 * i64::from(p.j) + half, 2 * i64::from(s)))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(cases(120)))]

    #[test]
    fn rational_tensor_lattices_are_exact(
        (points_bits, weight_bits) in nets(), m in 1_usize..=8, h in 1_usize..=8, r in steps(), s in steps(),
        centred: bool, polynomial: bool,
    ) {
        let count = (m + 1) * (h + 1);
        let (points, weights) = (points(&points_bits[..3 * count]), weights(&weight_bits[..count]));
        let control = TensorNet::new((m, h), &points).unwrap();
        let net = if polynomial {
            SurfaceNet::Tensor(control)
        } else {
            SurfaceNet::RationalTensor(RationalTensorNet::new(control, &weights).unwrap())
        };
        let make = if centred { Lattice::centres } else { Lattice::new };
        if let Ok(lattice) = make(net, Steps::new(r, s).unwrap()) {
            check(&lattice, |p, axis| {
                let (r, s) = parameters(p, (r, s), centred);
                let w = |i: usize, j: usize| if polynomial { ratio(1, 1) } else { weight(weights[i * (h + 1) + j]) };
                let numerator = tensor((m, h), |i, j| w(i, j) * coordinate(&points[i * (h + 1) + j], axis), &r, &s);
                numerator / tensor((m, h), w, &r, &s)
            });
        }
    }

    #[test]
    fn rational_triangle_lattices_are_exact(
        (points_bits, weight_bits) in nets(), degree in 1_usize..=8, n in steps(), centred: bool, polynomial: bool,
    ) {
        let count = (degree + 1) * (degree + 2) / 2;
        let (points, weights) = (points(&points_bits[..3 * count]), weights(&weight_bits[..count]));
        let control = TriangleNet::new(degree, &points).unwrap();
        let net = if polynomial {
            SurfaceNet::Triangle(control)
        } else {
            SurfaceNet::RationalTriangle(RationalTriangleNet::new(control, &weights).unwrap())
        };
        let make = if centred { Lattice::centres } else { Lattice::new };
        if let Ok(lattice) = make(net, Steps::uniform(n).unwrap()) {
            check(&lattice, |p, axis| {
                let (u, v) = parameters(p, (n, n), centred);
                let at = |i, j, k| triangle_index(degree, (i, j, k));
                let w = |i, j, k| if polynomial { ratio(1, 1) } else { weight(weights[at(i, j, k)]) };
                let numerator =
                    triangle(degree, |i, j, k| w(i, j, k) * coordinate(&points[at(i, j, k)], axis), &u, &v);
                numerator / triangle(degree, w, &u, &v)
            });
        }
    }

    #[test]
    fn rational_curve_lattices_are_exact((points_bits, weight_bits) in nets(), m in 1_usize..=8, n in 1_u32..900) {
        let (points, weights) = (points(&points_bits[..3 * (m + 1)]), weights(&weight_bits[..=m]));
        let net = RationalCurveNet::new(CurveNet::new(&points).unwrap(), &weights).unwrap();
        if let Ok(lattice) = CurveLattice::rational(net, n) {
            let collected: Vec<_> = lattice.points().collect();
            prop_assert_eq!(collected.len(), n as usize + 1);
            for p in collected.iter().step_by((n as usize / 30).max(1)) {
                let t = ratio(p.i.into(), n.into());
                for (axis, ours) in [p.x, p.y, p.z].into_iter().enumerate() {
                    let zero = ratio(0, 1);
                    let numerator = tensor((m, 0), |i, _| weight(weights[i]) * coordinate(&points[i], axis), &t, &zero);
                    let exact = numerator / tensor((m, 0), |i, _| weight(weights[i]), &t, &zero);
                    prop_assert_eq!(BigInt::from(ours), round_half_up(&exact));
                }
            }
        }
    }
}

fn cases(default: u32) -> u32 {
    std::env::var("PROPTEST_CASES").ok().and_then(|n| n.parse().ok()).unwrap_or(default)
}

/// A quarter circle with the weights 1, 1, 2: each point is the rounded point of the true circle, at unit steps.
#[test]
fn a_quarter_circle_is_the_true_circle_rounded() {
    for radius in [1_i16, 60, 300, 10_000] {
        let r = i32::from(radius) << 16;
        let points = [Point3::from_bits(r, 0, 0), Point3::from_bits(r, r, 0), Point3::from_bits(0, r, 0)];
        let weights = [1, 1, 2].map(I16F16::from_num);
        let net = RationalCurveNet::new(CurveNet::new(&points).unwrap(), &weights).unwrap();
        let lattice = CurveLattice::rational(net, Steps::rational_curve(net)).unwrap();
        assert_eq!(lattice.budget().fraction_bits, 0);
        assert_eq!(lattice.budget().scale % 2, 0); // the largest weight, 2
        let mut count = 0;
        for p in &lattice {
            // Each coordinate is within 1/2 of a point of the circle.
            let distance = (f64::from(p.x).hypot(f64::from(p.y)) - f64::from(radius)).abs();
            assert!(distance <= 0.5_f64.sqrt() + 1e-9, "{p:?}");
            count += 1;
        }
        assert!(lattice.unit_steps().is_ok() && count > i32::from(radius));
    }
}

#[test]
fn sampling_takes_centres_where_cells_lie_at_45_degrees() {
    let turned: Vec<_> =
        [(100, 0), (0, 100), (200, 100), (100, 200)].map(|(x, y)| Point3::from_ints(x, y, 0)).into_iter().collect();
    let net = SurfaceNet::Tensor(TensorNet::new((1, 1), &turned).unwrap());
    assert_eq!(Sampling::cheapest(net), Sampling { steps: Steps::uniform(101).unwrap(), centres: true });
    let straight: Vec<_> =
        [(0, 0), (0, 100), (100, 0), (100, 100)].map(|(x, y)| Point3::from_ints(x, y, 0)).into_iter().collect();
    let net = SurfaceNet::Tensor(TensorNet::new((1, 1), &straight).unwrap());
    assert_eq!(Sampling::cheapest(net), Sampling { steps: Steps::uniform(101).unwrap(), centres: false });
}

/// Every lattice point of a sphere lies within √3/2 of it: each coordinate is within 1/2 of a point on it.
#[test]
fn a_sphere_is_the_true_sphere_rounded() {
    for radius in [5_i16, 60, 333] {
        for patch in sphere(Point3::ORIGIN, I16F16::from_num(radius)).unwrap() {
            let lattice = Lattice::new(patch.surface(), Steps::hole_free(patch.surface())).unwrap();
            let r = f64::from(radius);
            lattice.for_each(|p| {
                let square = [p.x, p.y, p.z].map(|c| f64::from(c) * f64::from(c)).iter().sum::<f64>();
                assert!((square.sqrt() - r).abs() <= 3.0_f64.sqrt() / 2.0 + 1e-9, "{p:?} of radius {radius}");
            });
        }
    }
}

/// Weights so extreme that the bound asks for more steps than there are: a typed error, never a coarse lattice.
#[test]
fn extreme_weights_are_a_typed_error() {
    let points = [[0, 0], [0, 300], [300, 0], [300, 300]].map(|[x, y]| Point3::from_ints(x, y, 0));
    let weights = [1, i32::MAX, 1, i32::MAX].map(I16F16::from_bits);
    let net = RationalTensorNet::new(TensorNet::new((1, 1), &points).unwrap(), &weights).unwrap();
    let net = SurfaceNet::RationalTensor(net);
    let steps = Steps::hole_free(net);
    assert!(Lattice::new(net, steps).is_err(), "{steps:?}");
}
