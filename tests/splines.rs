//! Splines as Bézier pieces: each control point is the exact one of the Cox–de Boor recursion, in big rationals,
//! rounded once, half up.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod common;
#[path = "common/interpolate.rs"]
mod interpolate;

use common::draw::*;
use common::{ratio, round_half_up};
use embedded_surfaces::geometry::Point3;
use embedded_surfaces::num::I16F16;
use embedded_surfaces::patch::{
    BSplineCurve, BSplineSurface, CurveNet, KnotVector, NurbsCurve, NurbsSurface, RationalTensor,
};
use interpolate::{bernsteins, dot, homogeneous, parameters, to_bezier};
use num_bigint::BigInt;
use num_rational::BigRational;
use proptest::prelude::*;

// The oracle.

/// N_(i,p)(u) of the polynomials over span j, by the Cox–de Boor recursion with 0/0 = 0.
fn basis(knots: &[BigRational], (i, p): (usize, usize), j: usize, u: &BigRational) -> BigRational {
    if p == 0 {
        return ratio(i64::from(i == j), 1);
    }
    let part = |numerator: BigRational, width: BigRational, lower: usize| {
        if width == ratio(0, 1) { width } else { numerator / width * basis(knots, (lower, p - 1), j, u) }
    };
    part(u - &knots[i], &knots[i + p] - &knots[i], i)
        + part(&knots[i + p + 1] - u, &knots[i + p + 1] - &knots[i + 1], i + 1)
}

/// All knots, and the spans of the domain that are not empty.
struct Oracle {
    degree: usize,
    knots: Vec<BigRational>,
    spans: Vec<usize>,
}

impl Oracle {
    fn new<const K: usize>(knots: &KnotVector<'_, K>) -> Self {
        let bits: Vec<i32> = (0..knots.points() + K).map(|i| knots.knot(i).unwrap().to_bits()).collect();
        let spans: Vec<usize> = (K - 1..knots.points()).filter(|j| bits[*j] < bits[*j + 1]).collect();
        assert_eq!((spans.len(), knots.knot(bits.len())), (knots.pieces(), None));
        for (piece, span) in spans.iter().enumerate() {
            let interval = [bits[*span], bits[*span + 1]].map(I16F16::from_bits);
            assert_eq!(knots.interval(piece), Some(interval));
        }
        assert_eq!(knots.interval(spans.len()), None);
        Self { degree: K - 1, knots: bits.iter().map(|b| ratio((*b).into(), 1)).collect(), spans }
    }

    /// The factors of the control points from `span − degree` on at parameter t of the piece.
    fn factors(&self, span: usize, t: &BigRational) -> Vec<BigRational> {
        let (a, b) = (&self.knots[span], &self.knots[span + 1]);
        let u = a + (b - a) * t;
        (span - self.degree..=span).map(|i| basis(&self.knots, (i, self.degree), span, &u)).collect()
    }
}

/// What each point and weight must be, from the exact homogeneous coordinates of the Bézier net.
fn assert_net(points: &[Point3], weights: Option<&[I16F16]>, log2: u32, exact: &[Vec<BigRational>; 4]) {
    for (k, p) in points.iter().enumerate() {
        for (axis, c) in p.to_array().into_iter().enumerate() {
            assert_eq!(BigInt::from(c.to_bits()), round_half_up(&(&exact[axis][k] / &exact[3][k])), "point {k}");
        }
        if let Some(weights) = weights {
            let exact = &exact[3][k] * BigInt::from(1 << log2);
            assert_eq!(BigInt::from(weights[k].to_bits()), round_half_up(&exact), "weight {k}");
        }
    }
}

/// The documented bound: 1/2 (1 + E/w) units of the last place from the exact point, given in those units.
fn assert_close(
    points: &[Point3],
    weights: Option<&[I16F16]>,
    least: i64,
    factors: &[BigRational],
    exact: &[BigRational],
) {
    let weight = |k: usize| weights.map(|w| w[k]);
    let value = |axis| dot(factors, points.iter().enumerate().map(|(k, p)| homogeneous(p, weight(k), axis)));
    for axis in 0..3 {
        let error = value(axis) / value(3) - &exact[axis] / &exact[3];
        let along = || points.iter().map(|p| i64::from(p.to_array()[axis].to_bits()));
        let extent = along().max().unwrap() - along().min().unwrap();
        let spread = if weights.is_some() { ratio(extent, least) } else { ratio(0, 1) };
        let bound = (ratio(1, 1) + spread) / BigInt::from(2);
        assert!(error <= bound && -error <= bound, "axis {axis}");
    }
}

// Curves.

fn check_curve<const K: usize>(knots: KnotVector<'_, K>, points: &[Point3], weights: &[I16F16], t: &BigRational) {
    let curve = BSplineCurve::new(points, knots).unwrap();
    let log2 = weights.iter().map(|w| w.to_bits().leading_zeros() - 1).min().unwrap();
    let plain = NurbsCurve::new(curve, weights).unwrap();
    let fine = plain.scale_weights(log2).unwrap();
    let (oracle, matrix) = (Oracle::new(&knots), to_bezier(K - 1));
    let mut end = None;
    for (index, span) in oracle.spans.iter().enumerate() {
        let local = *span + 1 - K..*span + 1;
        let exact = |weighted: bool, factors: &[BigRational], axis| {
            dot(factors, local.clone().map(|i| homogeneous(&points[i], weighted.then_some(weights[i]), axis)))
        };
        let rows: Vec<_> = parameters(K - 1).iter().map(|t| oracle.factors(*span, t)).collect();
        let net = |weighted: bool| {
            [0, 1, 2, 3].map(|axis| {
                let values: Vec<_> = rows.iter().map(|factors| exact(weighted, factors, axis)).collect();
                interpolate::curve(&matrix, &values)
            })
        };
        let piece = curve.piece(index).unwrap();
        assert_net(piece.points(), None, 0, &net(false));
        let (at_t, bezier) = (oracle.factors(*span, t), bernsteins(K - 1, t));
        let value = |weighted| [0, 1, 2, 3].map(|axis| exact(weighted, &at_t, axis));
        assert_close(piece.points(), None, 0, &bezier, &value(false));
        for (nurbs, log2) in [(&plain, 0), (&fine, log2)] {
            let piece = nurbs.piece(index).unwrap();
            assert_net(piece.net().points(), Some(piece.weights()), log2, &net(true));
            let least = weights.iter().map(|w| i64::from(w.to_bits()) << log2).min().unwrap();
            assert_close(piece.net().points(), Some(piece.weights()), least, &bezier, &value(true));
        }
        let last = |net: CurveNet<'_>| net.points()[K - 1];
        let rational = fine.piece(index).unwrap();
        let start = (piece.points()[0], rational.net().points()[0], rational.weights()[0]);
        assert!(end.is_none_or(|end| end == start), "piece {index} does not start where the one before ends");
        end = Some((last(piece.net()), last(rational.net().control_net()), rational.weights()[K - 1]));
    }
    assert_eq!((curve.piece(oracle.spans.len()), plain.piece(oracle.spans.len())), (None, None));
    assert_eq!(curve.pieces().len(), oracle.spans.len());
    assert!(curve.pieces().enumerate().all(|(i, piece)| Some(piece) == curve.piece(i)));
    assert!(fine.pieces().enumerate().all(|(i, piece)| Some(piece) == fine.piece(i)));
}

/// Groups of equal knots: (gap to the group before, multiplicity). At most `degree` are equal but at the ends.
fn grouped(order: usize, start: i32, groups: &[(i64, usize)]) -> Vec<I16F16> {
    let (mut knots, mut at) = (Vec::new(), i64::from(start));
    for (g, (gap, multiplicity)) in groups.iter().enumerate() {
        at = (at + gap).min(i32::MAX.into());
        let most = if g == 0 || knots.len() >= 2 * order { order } else { order - 1 };
        knots.extend(std::iter::repeat_n(I16F16::from_bits(at as i32), (*multiplicity).min(most)));
    }
    knots
}

/// Knots of every kind: whole, with all fraction bits, next to each other, over the whole type.
fn knots(order: usize) -> impl Strategy<Value = Vec<I16F16>> {
    let gap = prop_oneof![
        Just((1_i64 << 16)..=1 << 16),
        Just((1_i64 << 16)..=1 << 20),
        Just(1_i64..=3),
        Just(1_i64..=1 << 28),
    ];
    let groups = gap.prop_flat_map(move |gap| {
        let multiplicity = prop_oneof![3 => Just(1), 2 => 1..=order, 1 => Just(order)];
        prop::collection::vec((gap, multiplicity), 2..2 * order + 5)
    });
    (prop_oneof![Just(0), Just(i32::MIN), any::<i32>().prop_map(|b| b / 2)], groups)
        .prop_map(move |(start, groups)| grouped(order, start, &groups))
}

fn with_knots<const K: usize>(knots: &[I16F16], check: impl FnOnce(KnotVector<'_, K>)) -> bool {
    KnotVector::<K>::new(knots).map(check).is_ok()
}

/// Two points more than the longest knot vector needs.
const POINTS: usize = 200;

macro_rules! every_order {
    ($order:expr, $body:ident!($($argument:tt)*)) => {
        match $order {
            2 => $body!(2, $($argument)*),
            3 => $body!(3, $($argument)*),
            4 => $body!(4, $($argument)*),
            5 => $body!(5, $($argument)*),
            6 => $body!(6, $($argument)*),
            7 => $body!(7, $($argument)*),
            8 => $body!(8, $($argument)*),
            9 => $body!(9, $($argument)*),
            _ => unreachable!(),
        }
    };
}

macro_rules! curve_of_order {
    ($order:literal, $knots:expr, $points:expr, $weights:expr, $t:expr) => {
        with_knots::<$order>(&$knots, |k| check_curve(k, &$points[..k.points()], &$weights[..k.points()], &$t))
    };
}

fn fraction() -> impl Strategy<Value = BigRational> {
    parameter().prop_map(|t| ratio(t.numerator().into(), t.denominator().into()))
}

proptest! {
    #![proptest_config(cases(30))]

    #[test]
    fn curves_are_the_de_boor_points_rounded_once(
        (order, knots) in (2_usize..=9).prop_flat_map(|order| (Just(order), knots(order))),
        points in net::<I16F16>(POINTS), weights in weights(POINTS), t in fraction(),
    ) {
        let legal = every_order!(order, curve_of_order!(knots, points, weights, t));
        prop_assume!(legal);
    }

    #[test]
    fn uniform_knots_too(
        (order, more) in (2_usize..=9, 0_usize..5),
        points in net::<I16F16>(14), weights in weights(14), t in fraction(),
    ) {
        macro_rules! both {
            ($order:literal,) => {{
                let count = $order + more;
                let (points, weights) = (&points[..count], &weights[..count]);
                check_curve::<$order>(KnotVector::uniform(count).unwrap(), points, weights, &t);
                check_curve::<$order>(KnotVector::clamped(count).unwrap(), points, weights, &t);
            }};
        }
        every_order!(order, both!());
    }
}

// Surfaces.

fn check_surface<const M: usize, const H: usize>(
    along: (KnotVector<'_, M>, KnotVector<'_, H>),
    points: &[Point3],
    weights: &[I16F16],
    most: usize,
) {
    let width = along.1.points();
    let surface = BSplineSurface::new(points, along.0, along.1).unwrap();
    let nurbs = NurbsSurface::new(surface, weights).unwrap();
    let (r, s) = (Oracle::new(&along.0), Oracle::new(&along.1));
    let (to_r, to_s) = (to_bezier(M - 1), to_bezier(H - 1));
    let pairs: Vec<_> = (0..r.spans.len()).flat_map(|i| (0..s.spans.len()).map(move |j| (i, j))).collect();
    for (i, j) in pairs.iter().copied().take(most) {
        let (a, b) = (r.spans[i] + 1 - M, s.spans[j] + 1 - H);
        let rows: Vec<_> = parameters(M - 1).iter().map(|t| r.factors(r.spans[i], t)).collect();
        let columns: Vec<_> = parameters(H - 1).iter().map(|t| s.factors(s.spans[j], t)).collect();
        let exact = |weighted: bool| {
            [0, 1, 2, 3].map(|axis| {
                let at = |i: usize, j: usize| {
                    let index = (a + i) * width + b + j;
                    homogeneous(&points[index], weighted.then_some(weights[index]), axis)
                };
                // First along s in each row of control points, then along r.
                let crosswise: Vec<Vec<_>> =
                    (0..M).map(|i| columns.iter().map(|f| dot(f, (0..H).map(|j| at(i, j)))).collect()).collect();
                let value = |f: &Vec<_>, l: usize| dot(f, crosswise.iter().map(|row| row[l].clone()));
                let values: Vec<Vec<_>> = rows.iter().map(|f| (0..H).map(|l| value(f, l)).collect()).collect();
                interpolate::surface([&to_r, &to_s], &values)
            })
        };
        assert_net(surface.piece(i, j).unwrap().points().as_flattened(), None, 0, &exact(false));
        let piece = nurbs.piece(i, j).unwrap();
        assert_net(piece.net().points(), Some(piece.weights().as_flattened()), 0, &exact(true));
    }
    assert_eq!((surface.piece(r.spans.len(), 0), nurbs.piece(0, s.spans.len())), (None, None));
    if pairs.len() <= 12 {
        assert_joined(&nurbs, r.spans.len(), s.spans.len());
        assert!(surface.pieces().eq(pairs.iter().map(|(i, j)| surface.piece(*i, *j).unwrap())));
        assert!(nurbs.pieces().eq(pairs.iter().map(|(i, j)| nurbs.piece(*i, *j).unwrap())));
        assert_eq!(nurbs.pieces().len(), pairs.len());
    }
}

/// Borders of neighbours are the same bits, weights included.
fn assert_joined<const M: usize, const H: usize>(nurbs: &NurbsSurface<'_, M, H>, rows: usize, columns: usize) {
    let border = |piece: &RationalTensor<M, H>, at: &dyn Fn(usize, usize) -> bool| {
        let all = piece.net().points().iter().zip(piece.weights().as_flattened()).enumerate();
        all.filter(|(n, _)| at(n / H, n % H)).map(|(_, (p, w))| (*p, *w)).collect::<Vec<_>>()
    };
    for (i, j) in (0..rows).flat_map(|i| (0..columns).map(move |j| (i, j))) {
        let here = nurbs.piece(i, j).unwrap();
        if let Some(below) = nurbs.piece(i + 1, j) {
            assert_eq!(border(&here, &|i, _| i == M - 1), border(&below, &|i, _| i == 0));
        }
        if let Some(right) = nurbs.piece(i, j + 1) {
            assert_eq!(border(&here, &|_, j| j == H - 1), border(&right, &|_, j| j == 0));
        }
    }
}

fn check_random_surface<const M: usize, const H: usize>(
    (r, s): (&[I16F16], &[I16F16]),
    points: &[Point3],
    weights: &[I16F16],
    most: usize,
) -> bool {
    let (Ok(r), Ok(s)) = (KnotVector::<M>::new(r), KnotVector::<H>::new(s)) else { return false };
    let len = r.points() * s.points();
    // Repeated as often as the surface needs.
    let points: Vec<_> = points.iter().copied().cycle().take(len).collect();
    let weights: Vec<_> = weights.iter().copied().cycle().take(len).collect();
    check_surface((r, s), &points, &weights, most);
    true
}

macro_rules! surfaces {
    ($($name:ident: $m:literal x $h:literal, $cases:literal x $pieces:literal;)*) => {
        $(
            proptest! {
                #![proptest_config(cases($cases))]
                #[test]
                fn $name(r in knots($m), s in knots($h), points in net::<I16F16>(101), weights in weights(97)) {
                    prop_assume!(check_random_surface::<$m, $h>((&r, &s), &points, &weights, $pieces));
                }
            }
        )*
    };
}
surfaces! {
    bilinear_surfaces: 2 x 2, 24 x 4;
    bicubic_surfaces: 4 x 4, 12 x 3;
    surfaces_of_degrees_2_and_5: 3 x 6, 12 x 3;
    surfaces_of_degrees_7_and_1: 8 x 2, 8 x 3;
    surfaces_of_degrees_8_and_8: 9 x 9, 2 x 1;
}

/// Nine distinct knots at either end of the type: every difference across the span has 32 bits, no common divisor.
#[test]
fn degrees_8_and_8_over_the_widest_knots_have_the_bits_they_need() {
    let wide = |step: i32| {
        let low = (0..9).map(|i| i32::MIN + i * step);
        low.chain((0..9).rev().map(|i| i32::MAX - i * step * 2)).map(I16F16::from_bits).collect::<Vec<_>>()
    };
    let (r, s) = (wide(1), wide(7));
    let along = (KnotVector::<9>::new(&r).unwrap(), KnotVector::<9>::new(&s).unwrap());
    let far = |n: usize| if n.is_multiple_of(3) { 32767 } else { -32767 };
    let points: Vec<_> = (0..81).map(|n| Point3::from_ints(far(n), -far(n / 9), far(n + n / 9))).collect();
    let weights: Vec<_> = (0..81).map(|n| if n % 5 == 0 { I16F16::from_bits(1) } else { I16F16::MAX }).collect();
    check_surface(along, &points, &weights, 1);
}
