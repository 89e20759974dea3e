//! Splines that a person can check, what is wrong with them, and garbage.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod common;
#[path = "common/interpolate.rs"]
mod interpolate;

use common::draw::*;
use common::ratio;
use embedded_surfaces::const_net;
use embedded_surfaces::geometry::{Axis, Point3};
use embedded_surfaces::num::I16F16;
use embedded_surfaces::patch::{
    BSplineCurve, BSplineSurface, Curve, CurveNet, KnotVector, NetError, NurbsCurve, NurbsSurface, SplineError, Tensor,
};
use interpolate::{bernsteins, dot, homogeneous};
use num_rational::BigRational;
use proptest::prelude::*;

fn ints<const N: usize>(points: [[i16; 3]; N]) -> [Point3; N] {
    points.map(|[x, y, z]| Point3::from_ints(x, y, z))
}

fn units<const N: usize>(values: [i32; N]) -> [I16F16; N] {
    values.map(I16F16::from_num)
}

/// The textbook's uniform cubic: (1, 4, 1)/6, (4, 2)/6, (2, 4)/6.
#[test]
fn uniform_cubics() {
    let points = ints([[0, 0, 0], [6, 12, 0], [18, -6, 6], [24, 0, 0], [30, 6, 1]]);
    let curve = BSplineCurve::new(&points, KnotVector::<4>::uniform(5).unwrap()).unwrap();
    let pieces: Vec<_> = curve.pieces().collect();
    assert_eq!(pieces.len(), 2);
    assert_eq!(Ok(pieces[0]), Curve::from_ints([[7, 7, 1], [10, 6, 2], [14, 0, 4], [17, -2, 4]]));
    assert_eq!(pieces[1].points()[..3], ints([[17, -2, 4], [20, -4, 4], [22, -2, 2]]));
    let seven_sixths = (7 << 16) / 6 + 1; // of 76458.67, half up
    assert_eq!(pieces[1].points()[3], Point3::from_bits(24 << 16, 0, seven_sixths));
}

/// With all knots multiple there is nothing to insert: the points come back as they are.
#[test]
fn bezier_knots_give_the_points_back() {
    let points: [Point3; 9] = std::array::from_fn(|i| Point3::from_bits(7 * i as i32 + 1, -(i as i32), 1 << i));
    let curve = BSplineCurve::new(&points, KnotVector::<9>::clamped(9).unwrap()).unwrap();
    assert_eq!(curve.pieces().map(|piece| *piece.points()).collect::<Vec<_>>(), [points]);
    // Two pieces of degree 4 that share a point.
    let knots = units([-2, -2, -2, -2, -2, 0, 0, 0, 0, 9, 9, 9, 9, 9]);
    let curve = BSplineCurve::new(&points, KnotVector::<5>::new(&knots).unwrap()).unwrap();
    let ours: Vec<_> = curve.pieces().map(|piece| *piece.points()).collect();
    assert_eq!(ours, [*points.first_chunk::<5>().unwrap(), *points.last_chunk::<5>().unwrap()]);
}

#[test]
fn empty_spans_have_no_piece() {
    // The domain is 1 ..= 5, with knots before and after it.
    let knots = units([0, 0, 1, 1, 1, 4, 4, 5, 5, 5, 6, 8]);
    let knots = KnotVector::<4>::new(&knots).unwrap();
    assert_eq!((knots.points(), knots.pieces()), (8, 2));
    assert_eq!([0, 1, 2].map(|i| knots.interval(i)), [Some(units([1, 4])), Some(units([4, 5])), None]);
    assert_eq!([0, 11, 12].map(|i| knots.knot(i)), [Some(I16F16::ZERO), Some(I16F16::from_num(8)), None]);
}

/// Everything can be a table in flash.
#[test]
fn splines_are_constant() {
    const KNOTS: &[I16F16] = &[I16F16::ZERO, I16F16::ZERO, I16F16::ONE, I16F16::ONE];
    const POINTS: &[Point3] = &[Point3::from_ints(1, 2, 3), Point3::from_ints(4, 5, 6)];
    const ALONG: KnotVector<'static, 2> = const_net!(KnotVector::new(KNOTS));
    const LINE: BSplineCurve<'static, 2> = const_net!(BSplineCurve::new(POINTS, ALONG));
    static HEAVY: NurbsCurve<'static, 2> = const_net!(NurbsCurve::new(LINE, &[I16F16::ONE, I16F16::ONE]));
    assert_eq!(LINE.piece(0).unwrap().points(), LINE.points());
    let scaled = HEAVY.scale_weights(14).unwrap();
    assert_eq!(scaled.piece(0).unwrap().weights(), &units([1 << 14, 1 << 14]));
}

// Circles and spheres.

/// A quarter of the unit circle over the knots 0, 0, 0, 1/2, 1, 1, 1, as 2wx, 2wy, 2w: the quadratic (1, 0), (1, 1),
/// (0, 1) with the weights 1, 1, 2 and the knot 1/2 inserted.
const ARC: [[i32; 3]; 4] = [[2, 0, 2], [2, 1, 2], [1, 3, 3], [0, 4, 4]];
const HALVES: [I16F16; 7] = {
    let half = I16F16::from_bits(1 << 15);
    [I16F16::ZERO, I16F16::ZERO, I16F16::ZERO, half, I16F16::ONE, I16F16::ONE, I16F16::ONE]
};

/// The exact point of a rational net along each axis, in raw bits.
fn exact_point(points: &[Point3], weights: &[I16F16], factors: &[BigRational]) -> [BigRational; 3] {
    let sum = |axis| dot(factors, points.iter().zip(weights).map(|(p, w)| homogeneous(p, Some(*w), axis)));
    [0, 1, 2].map(|axis| sum(axis) / sum(3))
}

fn square(x: &BigRational) -> BigRational {
    x * x
}

#[test]
fn a_nurbs_circle_is_a_circle() {
    // Nine points, double knots: each quarter is a piece.
    let square_of_points = [[1, 0], [1, 1], [0, 1], [-1, 1], [-1, 0], [-1, -1], [0, -1], [1, -1], [1, 0]];
    let points = square_of_points.map(|[x, y]| Point3::from_ints(90 * x, 90 * y, 7));
    let (weights, knots) = (units([1, 1, 2, 1, 1, 1, 2, 1, 1]), units([0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4]));
    let spline = BSplineCurve::new(&points, KnotVector::<3>::new(&knots).unwrap()).unwrap();
    let mut pieces: Vec<_> = NurbsCurve::new(spline, &weights).unwrap().pieces().collect();
    assert_eq!(pieces.len(), 4);
    // A quarter with a knot inside, where points and weights are blossomed.
    let points = ARC.map(|[x, y, w]| Point3::from_ints((90 * x / w) as i16, (90 * y / w) as i16, 7));
    let weights = ARC.map(|[_, _, w]| I16F16::from_bits(w << 15));
    let spline = BSplineCurve::new(&points, KnotVector::<3>::new(&HALVES).unwrap()).unwrap();
    pieces.extend(NurbsCurve::new(spline, &weights).unwrap().pieces());
    assert_eq!(pieces.len(), 6);
    assert_eq!(pieces[4].net().points()[2], Point3::from_ints(54, 72, 7));
    for piece in pieces {
        for t in (0..=37).map(|p| ratio(p, 37)) {
            let [x, y, z] = exact_point(piece.net().points(), piece.weights(), &bernsteins(2, &t));
            assert_eq!(square(&x) + square(&y), ratio((90_i64 << 16).pow(2), 1));
            assert_eq!(z, ratio(7 << 16, 1));
        }
    }
}

#[test]
fn a_nurbs_sphere_is_a_sphere() {
    const RADIUS: i32 = 225; // 3² · 5² makes all control points of the pieces representable
    let at = |c: i32, over: i32| I16F16::from_bits(((i64::from(RADIUS * c) << 16) / i64::from(over)) as i32);
    let (mut points, mut weights) = (Vec::new(), Vec::new());
    for ([x, y, turn], [from_axis, height, w]) in ARC.into_iter().flat_map(|turn| ARC.map(|profile| (turn, profile))) {
        points.push(Point3::new(at(from_axis * x, w * turn), at(from_axis * y, w * turn), at(height, w)));
        weights.push(I16F16::from_bits((turn * w) << 14));
    }
    let knots = KnotVector::<3>::new(&HALVES).unwrap();
    let octant = NurbsSurface::new(BSplineSurface::new(&points, knots, knots).unwrap(), &weights).unwrap();
    assert_eq!(octant.pieces().len(), 4);
    for piece in octant.pieces() {
        let weights = piece.weights().as_flattened();
        for (p, q) in (0..=7).flat_map(|p| (0..=7).map(move |q| (p, q))) {
            let (by_r, by_s) = (bernsteins(2, &ratio(p, 7)), bernsteins(2, &ratio(q, 7)));
            let factors: Vec<_> = by_r.iter().flat_map(|a| by_s.iter().map(move |b| a * b)).collect();
            let [x, y, z] = exact_point(piece.net().points(), weights, &factors);
            assert_eq!(square(&x) + square(&y) + square(&z), ratio((i64::from(RADIUS) << 16).pow(2), 1));
        }
    }
}

// Errors.

#[test]
fn what_is_wrong_with_knots_is_named() {
    let knots = |values: &[i32]| {
        let values: Vec<_> = values.iter().map(|v| I16F16::from_num(*v)).collect();
        KnotVector::<3>::new(&values).map(|knots| knots.pieces())
    };
    let bits = |value: i32| value << 16;
    assert_eq!(knots(&[]), Err(SplineError::KnotCount { least: 6, given: 0 }));
    assert_eq!(knots(&[0, 0, 0, 1, 1]), Err(SplineError::KnotCount { least: 6, given: 5 }));
    let falling = SplineError::Decreasing { index: 4, previous: bits(1), bits: bits(-1) };
    assert_eq!(knots(&[0, 0, 0, 1, -1, 1]), Err(falling));
    assert_eq!(knots(&[0, 0, 1, 1, 2, 2]), Err(SplineError::EmptyDomain { index: 2, bits: bits(1) }));
    assert_eq!(knots(&[5; 6]), Err(SplineError::EmptyDomain { index: 2, bits: bits(5) }));
    let many = |index, value, multiplicity, limit| {
        Err(SplineError::Multiplicity { index, bits: bits(value), multiplicity, limit })
    };
    assert_eq!(knots(&[0, 0, 0, 0, 1, 1, 1]), many(0, 0, 4, 3));
    assert_eq!(knots(&[0, 1, 2, 3, 3, 3, 3]), many(3, 3, 4, 3));
    assert_eq!(knots(&[0, 0, 0, 1, 1, 1, 2, 2, 2]), many(3, 1, 3, 2));
    assert_eq!(knots(&[0, 0, 0, 1, 1, 2, 2, 2]), Ok(2));
    // Where the domain starts and beyond, three may be equal.
    assert_eq!(knots(&[0, 1, 1, 1, 2, 2, 2]), Ok(1));
    assert_eq!(knots(&[0, 1, 2, 3, 4, 4, 4]), Ok(2));
}

#[test]
fn counted_knots_stay_in_their_type() {
    let count = |least, given| Some(SplineError::PointCount { least, most: 32767, given });
    assert_eq!(KnotVector::<5>::uniform(4).err(), count(5, 4));
    assert_eq!(KnotVector::<5>::clamped(0).err(), count(5, 0));
    assert_eq!(KnotVector::<2>::uniform(32768).err(), count(2, 32768));
    assert_eq!(KnotVector::<2>::clamped(usize::MAX).err(), count(2, usize::MAX));
    for longest in [KnotVector::<9>::uniform(32767).unwrap(), KnotVector::<9>::clamped(32767).unwrap()] {
        assert_eq!(longest.interval(longest.pieces() - 1), Some(units([32758, 32759])));
    }
    let longest = KnotVector::<9>::uniform(32767).unwrap();
    assert_eq!(longest.knot(0), Some(I16F16::from_num(-8)));
    assert_eq!(longest.knot(32767 + 8), Some(I16F16::from_num(32767)));
}

#[test]
fn what_is_wrong_with_points_and_weights_is_named() {
    let (knots, line) = (KnotVector::<3>::clamped(4).unwrap(), KnotVector::<2>::clamped(2).unwrap());
    let points = ints([[1, 2, 3]; 8]);
    let count = |expected, given| SplineError::Net(NetError::Count { expected, given });
    assert_eq!(BSplineCurve::new(&points[..3], knots), Err(count(4, 3)));
    assert_eq!(BSplineSurface::new(&points, knots, knots), Err(count(16, 8)));
    let mut far = points;
    far[2].y = I16F16::MIN;
    let range = SplineError::Net(NetError::OutOfRange { index: 2, axis: Axis::Y, units: -32768, limit: 32767 });
    assert_eq!(BSplineCurve::new(&far[..4], knots), Err(range));
    assert_eq!(BSplineSurface::new(&far, knots, line), Err(range));

    let curve = BSplineCurve::new(&points[..4], knots).unwrap();
    let surface = BSplineSurface::new(&points, knots, line).unwrap();
    let weights = units([1, 4, 2, 0, 1, 1, 1, -1]);
    assert_eq!(NurbsCurve::new(curve, &weights), Err(SplineError::WeightCount { expected: 4, given: 8 }));
    assert_eq!(NurbsSurface::new(surface, &[]), Err(SplineError::WeightCount { expected: 8, given: 0 }));
    let weight = |index, bits| SplineError::Net(NetError::Weight { index, bits });
    assert_eq!(NurbsCurve::new(curve, &weights[..4]), Err(weight(3, 0)));
    assert_eq!(NurbsSurface::new(surface, &units([1, 1, 1, 1, 1, 1, 1, -1])), Err(weight(7, -65536)));

    let weights = units([1, 1, 4, 1, 1, 1, 1, 1]);
    let nurbs = NurbsCurve::new(curve, &weights[..4]).unwrap();
    assert_eq!(nurbs.scale_weights(13), Err(SplineError::WeightScale { index: 2, bits: 4 << 16, log2: 13 }));
    assert_eq!(nurbs.scale_weights(12).unwrap().piece(0).unwrap().weights()[0], I16F16::from_num(4096));
    let nurbs = NurbsSurface::new(surface, &weights).unwrap();
    assert_eq!(nurbs.scale_weights(u32::MAX), Err(SplineError::WeightScale { index: 0, bits: 65536, log2: u32::MAX }));
    assert!(nurbs.scale_weights(12).unwrap().piece(0, 0).is_some());
}

#[test]
fn errors_read_well() {
    let texts = [
        (SplineError::KnotCount { least: 8, given: 3 }, "the order needs at least 8 knots, 3 given"),
        (SplineError::PointCount { least: 4, most: 32767, given: 3 }, "3 control points are not in 4 ..= 32767"),
        (
            SplineError::Decreasing { index: 2, previous: 5, bits: -1 },
            "knot 2, -1 / 65536, is below the one before it, 5 / 65536",
        ),
        (
            SplineError::EmptyDomain { index: 3, bits: 7 },
            "the domain starts at knot 3 and ends there too, at 7 / 65536",
        ),
        (
            SplineError::Multiplicity { index: 1, bits: 9, multiplicity: 5, limit: 3 },
            "5 knots from knot 1 on are 9 / 65536, at most 3 may be equal there",
        ),
        (SplineError::WeightCount { expected: 4, given: 2 }, "4 control points have 2 weights"),
        (
            SplineError::WeightScale { index: 1, bits: 65536, log2: 15 },
            "weight 1, 65536 / 65536, times 2^15 is not below 32768",
        ),
        (NetError::Weight { index: 0, bits: 0 }.into(), "weight 0 is not positive: 0 / 65536"),
    ];
    for (error, text) in texts {
        assert_eq!(error.to_string(), text);
        let source = std::error::Error::source(&error);
        assert_eq!(source.is_some(), matches!(error, SplineError::Net(_)));
    }
}

// Garbage.

fn swallow<const M: usize, const H: usize>(knots: [&[I16F16]; 2], points: &[Point3], weights: &[I16F16], log2: u32) {
    let (Ok(r), Ok(s)) = (KnotVector::<M>::new(knots[0]), KnotVector::<H>::new(knots[1])) else { return };
    let legal = |points: &[Point3]| assert!(points.chunks_exact(2).all(|pair| CurveNet::new(pair).is_ok()));
    if let Ok(curve) = BSplineCurve::new(&points[..points.len().min(r.points())], r) {
        curve.pieces().for_each(|piece| legal(piece.points()));
        let nurbs = NurbsCurve::new(curve, &weights[..weights.len().min(r.points())]);
        let nurbs = nurbs.and_then(|nurbs| nurbs.scale_weights(log2));
        nurbs.iter().flat_map(NurbsCurve::pieces).for_each(|piece| legal(piece.net().points()));
    }
    let len = r.points() * s.points();
    if let Ok(surface) = BSplineSurface::new(&points[..points.len().min(len)], r, s) {
        let nurbs = NurbsSurface::new(surface, &weights[..weights.len().min(len)]);
        let nurbs = nurbs.and_then(|nurbs| nurbs.scale_weights(log2));
        surface.pieces().for_each(|piece: Tensor<M, H>| legal(piece.points().as_flattened()));
        nurbs.iter().flat_map(NurbsSurface::pieces).for_each(|piece| legal(piece.net().points()));
    }
}

/// Any bits, often sorted: few values make equal knots likely.
fn garbage() -> impl Strategy<Value = Vec<I16F16>> {
    let bits = prop_oneof![Just(i32::MIN), Just(i32::MAX), Just(0), 0..4, any::<i32>()];
    (prop::collection::vec(bits, 0..16), prop::bool::weighted(0.9)).prop_map(|(mut bits, sort)| {
        if sort {
            bits.sort_unstable();
        }
        bits.into_iter().map(I16F16::from_bits).collect()
    })
}

proptest! {
    #![proptest_config(cases(300))]

    #[test]
    fn nothing_panics(
        (r, s) in (garbage(), garbage()),
        mut points in net::<I16F16>(64), spoilt in any::<Option<(u8, i32)>>(),
        weights in prop_oneof![weights(64), garbage()], log2 in prop_oneof![Just(0), 0_u32..40, any::<u32>()],
    ) {
        if let Some((index, bits)) = spoilt {
            points[usize::from(index % 64)].z = I16F16::from_bits(bits);
        }
        swallow::<2, 3>([&r, &s], &points, &weights, log2);
        swallow::<3, 2>([&r, &s], &points, &weights, log2);
        swallow::<4, 4>([&r, &s], &points, &weights, log2);
        swallow::<5, 7>([&r, &s], &points, &weights, log2);
    }
}
