//! Values, blossoms and derivatives of every net are the exact ones, rounded once, half up: against direct Bernstein
//! sums in big integers.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod common;

use common::basis::*;
use common::draw::*;
use common::{ratio, round_half_up};
use embedded_surfaces::geometry::{Point3, Vector3};
use embedded_surfaces::num::{Coord, I16F16, I32F32};
use embedded_surfaces::patch::{
    Barycentric, CubicCurve, Curve, CurveNet, NetError, Parameter, QuadraticCurve, RationalCurve, RationalTensor,
    RationalTriangle, Tensor, TensorNet, Triangle, TriangleNet,
};
use num_bigint::BigInt;
use num_rational::BigRational;
use proptest::prelude::*;

/// A value and the derivatives, `None` where one does not fit.
type Jet<C> = (Point3<C>, Option<Vec<Vector3>>);

fn array<T: Copy + core::fmt::Debug, const K: usize>(values: &[T]) -> [T; K] {
    values.try_into().unwrap()
}

fn rational_curve<const K: usize, C: Coord>(points: &[Point3<C>], weights: &[I16F16], t: Parameter) -> Jet<C> {
    let net = Curve::<K, C>::try_from(array(points)).unwrap();
    let curve = RationalCurve::new(net, array(weights)).unwrap();
    (curve.net().eval(t), curve.net().derivative(t).map(|d| vec![d]))
}

fn rational_triangle<const N: usize, const LEN: usize, C: Coord>(
    points: &[Point3<C>],
    weights: &[I16F16],
    at: Barycentric,
) -> Jet<C> {
    let net = Triangle::<N, LEN, C>::try_from(array(points)).unwrap();
    let patch = RationalTriangle::new(net, array(weights)).unwrap();
    (patch.net().eval(at), patch.net().partials(at).map(Vec::from))
}

fn rational_tensor<const M: usize, const H: usize, C: Coord>(
    points: &[Point3<C>],
    weights: &[I16F16],
    (r, s): (Parameter, Parameter),
) -> Jet<C> {
    let rows = points.as_chunks::<H>().0;
    let net = Tensor::<M, H, C>::try_from(array(rows)).unwrap();
    let patch = RationalTensor::new(net, array(weights.as_chunks::<H>().0)).unwrap();
    (patch.net().eval(r, s), patch.net().partials(r, s).map(Vec::from))
}

/// Calls `$f` with the constants that belong to a degree known only at run time.
macro_rules! dispatch {
    ($degree:expr, $arguments:tt, $($value:literal => $($f:ident)::+ < $($constant:tt),+ >),+) => {
        match $degree { $($value => $($f)::+ ::<$($constant),+> $arguments,)+ other => panic!("degree {other}") }
    };
}

fn rational_tensor_of_order<const M: usize, C: Coord>(
    h: usize,
    points: &[Point3<C>],
    weights: &[I16F16],
    at: (Parameter, Parameter),
) -> Jet<C> {
    dispatch!(h, (points, weights, at),
        1 => rational_tensor<M, 2, C>, 2 => rational_tensor<M, 3, C>, 3 => rational_tensor<M, 4, C>,
        4 => rational_tensor<M, 5, C>, 5 => rational_tensor<M, 6, C>, 6 => rational_tensor<M, 7, C>,
        7 => rational_tensor<M, 8, C>, 8 => rational_tensor<M, 9, C>)
}

/// Compares a polynomial and a rational net at one parameter with the exact values; `bases` are those of the value and
/// of the derivatives.
fn check<C: Coord>(
    bases: &[Basis],
    points: &[Point3<C>],
    weights: &[I16F16],
    (value, slopes): (Point3<C>, Vec<Vector3>),
    (rational, rational_slopes): Jet<C>,
) {
    assert_rounds_to(&value, |axis| bases[0].value(points, None, axis));
    assert_rounds_to(&rational, |axis| bases[0].value(points, Some(weights), axis));
    assert_eq!(slopes.len(), bases.len() - 1);
    for (slope, basis) in slopes.iter().zip(&bases[1..]) {
        assert_vector(slope, |axis| basis.value(points, None, axis));
    }
    let exact = |basis: &Basis, axis| basis.quotient_rule(&bases[0], points, weights, axis);
    match rational_slopes {
        Some(slopes) => {
            for (slope, basis) in slopes.iter().zip(&bases[1..]) {
                assert_vector(slope, |axis| exact(basis, axis));
            }
        }
        None => {
            let mut all = bases[1..].iter().flat_map(|basis| (0..3).map(move |axis| exact(basis, axis)));
            assert!(all.any(|x| i64::try_from(rounded_bits(&x, 32)).is_err()), "every component fits");
        }
    }
}

fn check_curves<C: Coord>(points: &[Point3<C>], weights: &[I16F16], t: Parameter) {
    for m in 1..=8 {
        let (points, weights) = (&points[..=m], &weights[..=m]);
        let net = CurveNet::new(points).unwrap();
        let rational = dispatch!(m, (points, weights, t),
            1 => rational_curve<2, C>, 2 => rational_curve<3, C>, 3 => rational_curve<4, C>, 4 => rational_curve<5, C>,
            5 => rational_curve<6, C>, 6 => rational_curve<7, C>, 7 => rational_curve<8, C>, 8 => rational_curve<9, C>);
        check(&curve_basis(m, t), points, weights, (net.eval(t), vec![net.derivative(t)]), rational);
    }
}

fn check_triangles<C: Coord>(points: &[Point3<C>], weights: &[I16F16], at: Barycentric) {
    for n in 1..=8 {
        let len = (n + 1) * (n + 2) / 2;
        let (points, weights) = (&points[..len], &weights[..len]);
        let net = TriangleNet::new(n, points).unwrap();
        let rational = dispatch!(n, (points, weights, at),
            1 => rational_triangle<1, 3, C>, 2 => rational_triangle<2, 6, C>, 3 => rational_triangle<3, 10, C>,
            4 => rational_triangle<4, 15, C>, 5 => rational_triangle<5, 21, C>, 6 => rational_triangle<6, 28, C>,
            7 => rational_triangle<7, 36, C>, 8 => rational_triangle<8, 45, C>);
        check(&triangle_basis(n, at), points, weights, (net.eval(at), net.partials(at).into()), rational);
    }
}

fn check_tensors<C: Coord>(points: &[Point3<C>], weights: &[I16F16], (r, s): (Parameter, Parameter)) {
    for (m, h) in (1..=8).flat_map(|m| (1..=8).map(move |h| (m, h))) {
        let len = (m + 1) * (h + 1);
        let (points, weights) = (&points[..len], &weights[..len]);
        let net = TensorNet::new((m, h), points).unwrap();
        let rational = dispatch!(m, (h, points, weights, (r, s)),
            1 => rational_tensor_of_order<2, C>, 2 => rational_tensor_of_order<3, C>,
            3 => rational_tensor_of_order<4, C>, 4 => rational_tensor_of_order<5, C>,
            5 => rational_tensor_of_order<6, C>, 6 => rational_tensor_of_order<7, C>,
            7 => rational_tensor_of_order<8, C>, 8 => rational_tensor_of_order<9, C>);
        check(&tensor_basis((m, h), r, s), points, weights, (net.eval(r, s), net.partials(r, s).into()), rational);
    }
}

proptest! {
    #![proptest_config(cases(150))]

    #[test]
    fn curves_of_every_degree_are_exact(
        narrow in net::<I16F16>(9), wide in net::<I32F32>(9), weights in weights(9), t in parameter(),
    ) {
        check_curves(&narrow, &weights, t);
        check_curves(&wide, &weights, t);
    }

    #[test]
    fn triangles_of_every_degree_are_exact(
        narrow in net::<I16F16>(45), wide in net::<I32F32>(45), weights in weights(45), at in barycentric(),
    ) {
        check_triangles(&narrow, &weights, at);
        check_triangles(&wide, &weights, at);
    }
}

proptest! {
    #![proptest_config(cases(48))]

    #[test]
    fn tensors_of_every_pair_of_degrees_are_exact(
        narrow in net::<I16F16>(81), wide in net::<I32F32>(81), weights in weights(81), r in parameter(),
        s in parameter(),
    ) {
        check_tensors(&narrow, &weights, (r, s));
        check_tensors(&wide, &weights, (r, s));
    }
}

/// The widest numbers there are: extreme coordinates and weights at denominators of 65536 and 65535.
#[test]
fn the_widest_values_are_exact() {
    let limit = |sign: bool| I32F32::from_bits(if sign { 1 << 58 } else { -(1 << 58) });
    let at = (Parameter::new(32769, 65536).unwrap(), Parameter::new(1, 65535).unwrap());
    for pattern in [0x5555_5555_5555_5555_5555_u128, 0xffff_0000_ffff_0000_ffff, 1, 0] {
        let sign = |i: usize| pattern >> i & 1 == 1;
        let points: Vec<_> = (0..81).map(|i| Point3::new(limit(sign(i)), limit(!sign(i)), limit(i < 40))).collect();
        for weights in [[1, i32::MAX], [i32::MAX, 1], [i32::MAX; 2]] {
            let weights: Vec<_> = (0..81).map(|i| I16F16::from_bits(weights[usize::from(sign(i + 1))])).collect();
            check_curves(&points[..9], &weights[..9], at.0);
            check_triangles(&points[..45], &weights[..45], Barycentric::new(21845, 21846, 21845).unwrap());
            check_tensors(&points, &weights, at);
        }
    }
}

/// Equations (7) and (12) as printed, sums over differences of neighbours, agree with the derivatives of the bases.
#[test]
fn derivatives_are_sums_over_differences_of_neighbours() {
    let value = |i: usize| ratio((i * i * 37 % 101) as i64 - 50, 3);
    let at = Barycentric::new(3, 5, 9).unwrap();
    for n in 1..=8 {
        let [_, by_u, by_v] = triangle_basis(n, at);
        let lower = if n > 1 { triangle_basis(n - 1, at)[0].clone() } else { constant() };
        let index = |i, j, k| triangle_indices(n).position(|index| index == (i, j, k)).unwrap();
        let sum = |u: usize, v: usize| {
            let differences = triangle_indices(n - 1)
                .map(|(i, j, k)| value(index(i + u, j + v, k)) - value(index(i, j, k + 1)))
                .collect::<Vec<_>>();
            lower.sum(differences.into_iter()) * BigInt::from(n)
        };
        let all = || (0..(n + 1) * (n + 2) / 2).map(value);
        assert_eq!((by_u.sum(all()), by_v.sum(all())), (sum(1, 0), sum(0, 1)), "degree {n}");
    }
    let t = Parameter::new(4, 7).unwrap();
    for m in 2..=8 {
        let differences = (0..m).map(|i| value(i + 1) - value(i));
        let sum = curve_basis(m - 1, t)[0].sum(differences) * BigInt::from(m);
        assert_eq!(curve_basis(m, t)[1].sum((0..=m).map(value)), sum, "degree {m}");
    }
}

fn constant() -> Basis {
    Basis { factors: vec![1.into()], divisor: 1.into() }
}

/// Ramshaw's recursion: the first argument is eaten by neighbours of the net that the other arguments leave.
fn curve_blossom(values: &[BigRational], arguments: &[Parameter]) -> BigRational {
    let Some((t, rest)) = arguments.split_first() else { return values[0].clone() };
    let (last, t) = (values.len() - 1, fraction(*t));
    let (low, high) = (curve_blossom(&values[..last], rest), curve_blossom(&values[1..], rest));
    (&high - &low) * t + low
}

fn fraction(t: Parameter) -> BigRational {
    ratio(t.numerator().into(), t.denominator().into())
}

/// The same over a triangle, as an integer over the product of the denominators.
fn triangle_blossom(n: usize, bits: &[i64], corner: (usize, usize, usize), arguments: &[Barycentric]) -> BigInt {
    let (i, j, k) = corner;
    let Some((at, rest)) = arguments.split_first() else {
        return bits[triangle_indices(n).position(|index| index == corner).unwrap()].into();
    };
    let towards = [(i + 1, j, k), (i, j + 1, k), (i, j, k + 1)];
    at.weights().iter().zip(towards).map(|(w, to)| triangle_blossom(n, bits, to, rest) * *w).sum()
}

fn along<C: Coord>(points: &[Point3<C>], axis: usize) -> Vec<i64> {
    points.iter().map(|p| p.to_array()[axis].bits()).collect()
}

/// Raw bits as rationals: blossoms of them round to raw bits.
fn rationals(bits: &[i64]) -> Vec<BigRational> {
    bits.iter().map(|b| ratio(*b, 1)).collect()
}

fn check_bits<C: Coord>(ours: Point3<C>, exact: impl Fn(usize) -> BigRational) {
    for (axis, c) in ours.to_array().into_iter().enumerate() {
        assert_eq!(BigInt::from(c.bits()), round_half_up(&exact(axis)), "axis {axis}");
    }
}

fn check_curve_blossom<C: Coord>(points: &[Point3<C>], arguments: &[Parameter], turn: usize) {
    let m = arguments.len();
    let net = CurveNet::new(&points[..=m]).unwrap();
    let blossom = net.blossom(arguments).unwrap();
    check_bits(blossom, |axis| curve_blossom(&rationals(&along(net.points(), axis)), arguments));
    let mut turned = arguments.to_vec();
    turned.rotate_left(turn % m);
    assert_eq!(net.blossom(&turned), Ok(blossom), "not symmetric");
    turned.reverse();
    assert_eq!(net.blossom(&turned), Ok(blossom), "not symmetric");
    assert_eq!(net.blossom(&vec![arguments[0]; m]), Ok(net.eval(arguments[0])), "the diagonal is not the curve");
    let wrong = vec![arguments[0]; m + 1];
    assert_eq!(net.blossom(&wrong), Err(NetError::Count { expected: m, given: m + 1 }));
    assert_eq!(net.blossom(&wrong[2..]), Err(NetError::Count { expected: m, given: m - 1 }));
}

fn check_triangle_blossom<C: Coord>(points: &[Point3<C>], arguments: &[Barycentric], turn: usize) {
    let n = arguments.len();
    let net = TriangleNet::new(n, &points[..(n + 1) * (n + 2) / 2]).unwrap();
    let blossom = net.blossom(arguments).unwrap();
    let divisor: BigInt = arguments.iter().map(|a| BigInt::from(a.denominator())).product();
    check_bits(blossom, |axis| {
        BigRational::new(triangle_blossom(n, &along(net.points(), axis), (0, 0, 0), arguments), divisor.clone())
    });
    let mut turned = arguments.to_vec();
    turned.rotate_left(turn % n);
    assert_eq!(net.blossom(&turned), Ok(blossom), "not symmetric");
    turned.reverse();
    assert_eq!(net.blossom(&turned), Ok(blossom), "not symmetric");
    assert_eq!(net.blossom(&vec![arguments[0]; n]), Ok(net.eval(arguments[0])), "the diagonal is not the patch");
    assert_eq!(net.blossom(&arguments[1..]), Err(NetError::Count { expected: n, given: n - 1 }));
}

fn check_tensor_blossom<C: Coord>(points: &[Point3<C>], r: &[Parameter], s: &[Parameter], turn: usize) {
    let (m, h) = (r.len(), s.len());
    let net = TensorNet::new((m, h), &points[..(m + 1) * (h + 1)]).unwrap();
    let blossom = net.blossom(r, s).unwrap();
    check_bits(blossom, |axis| {
        let values = rationals(&along(net.points(), axis));
        let columns: Vec<_> = values.chunks_exact(h + 1).map(|row| curve_blossom(row, s)).collect();
        curve_blossom(&columns, r)
    });
    let (mut turned_r, mut turned_s) = (r.to_vec(), s.to_vec());
    turned_r.rotate_left(turn % m);
    turned_s.reverse();
    assert_eq!(net.blossom(&turned_r, &turned_s), Ok(blossom), "not symmetric");
    let diagonal = net.blossom(&vec![r[0]; m], &vec![s[0]; h]);
    assert_eq!(diagonal, Ok(net.eval(r[0], s[0])), "the diagonal is not the patch");
    assert_eq!(net.blossom(&r[1..], s), Err(NetError::Count { expected: m, given: m - 1 }));
    assert_eq!(net.blossom(r, &s[1..]), Err(NetError::Count { expected: h, given: h - 1 }));
}

proptest! {
    #![proptest_config(cases(120))]

    #[test]
    fn curve_blossoms_are_the_polar_form(
        narrow in net::<I16F16>(9), wide in net::<I32F32>(9), at in prop::collection::vec(parameter(), 1..=8),
        turn in 0_usize..8,
    ) {
        check_curve_blossom(&narrow, &at, turn);
        check_curve_blossom(&wide, &at, turn);
    }

    #[test]
    fn triangle_blossoms_are_the_polar_form(
        narrow in net::<I16F16>(45), wide in net::<I32F32>(45), at in prop::collection::vec(barycentric(), 1..=8),
        turn in 0_usize..8,
    ) {
        check_triangle_blossom(&narrow, &at, turn);
        check_triangle_blossom(&wide, &at, turn);
    }

    #[test]
    fn tensor_blossoms_are_the_polar_form(
        narrow in net::<I16F16>(81), wide in net::<I32F32>(81), r in prop::collection::vec(parameter(), 1..=8),
        s in prop::collection::vec(parameter(), 1..=8), turn in 0_usize..8,
    ) {
        check_tensor_blossom(&narrow, &r, &s, turn);
        check_tensor_blossom(&wide, &r, &s, turn);
    }
}

#[test]
fn subdivision_points_are_blossoms_a_person_can_check() {
    let curve = CubicCurve::from_ints([[0, 0, 0], [0, 8, 0], [8, 8, 0], [8, 0, 16]]).unwrap();
    let (zero, half, one) = (Parameter::ZERO, Parameter::HALF, Parameter::ONE);
    // The left half of the curve: b(0,0,0), b(0,0,1/2), b(0,1/2,1/2), b(1/2,1/2,1/2).
    let left = [[zero, zero, zero], [zero, zero, half], [zero, half, half], [half, half, half]];
    let points = left.map(|arguments| curve.net().blossom(&arguments).unwrap());
    assert_eq!(points, [[0, 0, 0], [0, 4, 0], [2, 6, 0], [4, 6, 2]].map(|[x, y, z]| Point3::from_ints(x, y, z)));
    // Control points are the blossoms at the ends: b(0,1,1) is the third.
    assert_eq!(curve.net().blossom(&[zero, one, one]), Ok(curve.points()[2]));
    assert_eq!(curve.net().derivative(zero), Vector3::new(I32F32::ZERO, I32F32::from_num(24), I32F32::ZERO));
}

#[test]
fn halves_round_up_and_a_derivative_that_does_not_fit_is_none() {
    // The middle of -1 and 0 in the last place is -1/2, which rounds to 0; of 0 and 1 it is 1.
    let line = Curve::<2>::new([Point3::from_bits(-1, 0, 0), Point3::from_bits(0, 1, 0)]).unwrap();
    assert_eq!(line.net().eval(Parameter::HALF), Point3::from_bits(0, 1, 0));
    let net = QuadraticCurve::from_ints([[0, 0, 0], [32767, 0, 0], [0, 0, 0]]).unwrap();
    let steep = RationalCurve::new(net, [1, i32::MAX, 1].map(I16F16::from_bits)).unwrap();
    assert_eq!(steep.net().derivative(Parameter::ZERO), None); // 2 · 32767 · 2^31 units
    assert_eq!(steep.net().derivative(Parameter::HALF).map(|d| d.x), Some(I32F32::ZERO));
}
