//! Changes of form: degree elevation and the power basis round each coefficient of the exact net once, half up.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod common;

use common::basis::*;
use common::draw::*;
use common::{choose, ratio, round_half_up};
use embedded_surfaces::geometry::{Axis, Point3};
use embedded_surfaces::num::{Coord, I16F16, I32F32};
use embedded_surfaces::patch::{
    BilinearPatch, CubicCurve, CubicTriangle, Curve, NetError, Parameter, QuadraticCurve, Tensor, TensorNet, Triangle,
};
use num_bigint::BigInt;
use num_rational::BigRational;
use proptest::prelude::*;

/// Raw bits of a net along one axis, as rationals: exact coefficients round to raw bits.
fn along<C: Coord>(points: &[Point3<C>], axis: usize) -> Vec<BigRational> {
    points.iter().map(|p| ratio(p.to_array()[axis].bits(), 1)).collect()
}

/// Each coefficient is the exact one rounded half up, so within half a unit of the last place.
fn assert_coefficients<C: Coord>(ours: &[Point3<C>], exact: impl Fn(usize) -> Vec<BigRational>) {
    for axis in 0..3 {
        let exact = exact(axis);
        assert_eq!(ours.len(), exact.len());
        for (p, exact) in ours.iter().zip(exact) {
            let bits = p.to_array()[axis].bits();
            assert_eq!(BigInt::from(bits), round_half_up(&exact));
            let error = ratio(bits, 1) - exact;
            assert!(error > ratio(-1, 2) && error <= ratio(1, 2));
        }
    }
}

/// One degree up: q_j = (j p_(j−1) + (m + 1 − j) p_j) / (m + 1).
fn raised(p: &[BigRational]) -> Vec<BigRational> {
    let order = p.len();
    let term = |factor: usize, i: Option<&BigRational>| i.map_or(ratio(0, 1), |p| p * BigInt::from(factor));
    (0..=order)
        .map(|j| term(j, j.checked_sub(1).map(|i| &p[i])) + term(order - j, p.get(j)))
        .map(|sum| sum / BigInt::from(order))
        .collect()
}

fn raised_by(p: &[BigRational], count: usize) -> Vec<BigRational> {
    (0..count).fold(p.to_vec(), |p, _| raised(&p))
}

/// One degree up: b'[i,j,k] = (i b[i−1,j,k] + j b[i,j−1,k] + k b[i,j,k−1]) / (n + 1).
fn triangle_raised(n: usize, b: &[BigRational]) -> Vec<BigRational> {
    let at = |index| b[triangle_indices(n).position(|i| i == index).unwrap()].clone();
    triangle_indices(n + 1)
        .map(|(i, j, k)| {
            let mut sum = ratio(0, 1);
            if i > 0 {
                sum += at((i - 1, j, k)) * BigInt::from(i);
            }
            if j > 0 {
                sum += at((i, j - 1, k)) * BigInt::from(j);
            }
            if k > 0 {
                sum += at((i, j, k - 1)) * BigInt::from(k);
            }
            sum / BigInt::from(n + 1)
        })
        .collect()
}

fn transposed<T: Clone>(values: &[T], width: usize) -> Vec<T> {
    (0..width).flat_map(|j| values.chunks_exact(width).map(move |row| row[j].clone())).collect()
}

fn check_curve<const K: usize, const L: usize, C: Coord>(points: &[Point3<C>]) {
    let curve = Curve::<K, C>::try_from(*points.first_chunk::<K>().unwrap()).unwrap();
    let elevated = curve.elevate::<L>().unwrap();
    assert_coefficients(elevated.points(), |axis| raised_by(&along(curve.points(), axis), L - K));
    if L > K {
        assert_eq!(elevated.elevate::<K>(), Err(NetError::Elevation { from: L - 1, to: K - 1 }));
    }
}

fn check_triangle<const N: usize, const LEN: usize, const N2: usize, const LEN2: usize, C: Coord>(
    points: &[Point3<C>],
) {
    let patch = Triangle::<N, LEN, C>::try_from(*points.first_chunk::<LEN>().unwrap()).unwrap();
    let elevated = patch.elevate::<N2, LEN2>().unwrap();
    let exact = |axis| (N..N2).fold(along(patch.points(), axis), |b, n| triangle_raised(n, &b));
    assert_coefficients(elevated.points(), exact);
    if N2 > N {
        assert_eq!(elevated.elevate::<N, LEN>(), Err(NetError::Elevation { from: N2, to: N }));
    }
}

fn check_tensor<const M: usize, const H: usize, const M2: usize, const H2: usize, C: Coord>(points: &[Point3<C>]) {
    let rows = *points.as_chunks::<H>().0.first_chunk::<M>().unwrap();
    let patch = Tensor::<M, H, C>::try_from(rows).unwrap();
    let elevated = patch.elevate::<M2, H2>().unwrap();
    assert_coefficients(elevated.points().as_flattened(), |axis| {
        let values = along(rows.as_flattened(), axis);
        let wide: Vec<_> = values.chunks_exact(H).flat_map(|row| raised_by(row, H2 - H)).collect();
        let columns: Vec<_> = transposed(&wide, H2).chunks_exact(M).flat_map(|c| raised_by(c, M2 - M)).collect();
        transposed(&columns, M2)
    });
    if M2 > M {
        assert_eq!(elevated.elevate::<M, H2>(), Err(NetError::Elevation { from: M2 - 1, to: M - 1 }));
    }
    if H2 > H {
        assert_eq!(elevated.elevate::<M2, H>(), Err(NetError::Elevation { from: H2 - 1, to: H - 1 }));
    }
}

fn check_elevations<C: Coord>(points: &[Point3<C>]) {
    check_curve::<2, 2, C>(points);
    check_curve::<2, 3, C>(points);
    check_curve::<2, 9, C>(points);
    check_curve::<3, 5, C>(points);
    check_curve::<4, 5, C>(points);
    check_curve::<4, 6, C>(points);
    check_curve::<4, 9, C>(points);
    check_curve::<6, 9, C>(points);
    check_curve::<8, 9, C>(points);
    check_triangle::<1, 3, 2, 6, C>(points);
    check_triangle::<1, 3, 8, 45, C>(points);
    check_triangle::<2, 6, 2, 6, C>(points);
    check_triangle::<2, 6, 5, 21, C>(points);
    check_triangle::<3, 10, 4, 15, C>(points);
    check_triangle::<3, 10, 8, 45, C>(points);
    check_triangle::<5, 21, 7, 36, C>(points);
    check_triangle::<7, 36, 8, 45, C>(points);
    check_tensor::<2, 2, 2, 2, C>(points);
    check_tensor::<2, 2, 9, 9, C>(points);
    check_tensor::<2, 4, 4, 4, C>(points);
    check_tensor::<4, 4, 4, 6, C>(points);
    check_tensor::<4, 4, 6, 6, C>(points);
    check_tensor::<3, 8, 7, 9, C>(points);
}

/// Power coefficients small enough for any control point to be legal.
fn shrunk<C: Coord>(points: &[Point3<C>]) -> Vec<Point3<C>> {
    let shrink = |c: C| C::from_legal_bits((c.bits() / 81).into()).unwrap();
    points.iter().map(|p| Point3::from_array(p.to_array().map(shrink))).collect()
}

/// Equation (11): the control points of t^k, C(i,k)/C(m,k), or its transpose, C(k,i)/C(m,k).
fn power_column(m: usize, k: usize, transposed: bool) -> Vec<BigRational> {
    let ordered = |n, k| if k <= n { choose(n, k) } else { BigInt::default() };
    (0..=m)
        .map(|i| if transposed { ordered(k, i) } else { ordered(i, k) })
        .map(|numerator| BigRational::new(numerator, choose(m, k)))
        .collect()
}

fn power(t: &BigRational, n: usize) -> BigRational {
    (0..n).fold(ratio(1, 1), |p, _| p * t)
}

fn fraction(t: Parameter) -> BigRational {
    ratio(t.numerator().into(), t.denominator().into())
}

/// The control points are the exact ones rounded; a convex combination of them is within half a unit of the last
/// place of the power form, and its own rounding adds another half.
fn check_power<const M: usize, const H: usize, C: Coord>(coefficients: &[Point3<C>], r: Parameter, s: Parameter) {
    let rows = *coefficients.as_chunks::<H>().0.first_chunk::<M>().unwrap();
    let patch = Tensor::<M, H, C>::from_power(&rows).unwrap();
    assert_coefficients(patch.points().as_flattened(), |axis| {
        let mut exact = vec![ratio(0, 1); M * H];
        for (at, q) in along(rows.as_flattened(), axis).into_iter().enumerate() {
            let (by_r, by_s) = (power_column(M - 1, at / H, false), power_column(H - 1, at % H, false));
            for (i, exact) in exact.iter_mut().enumerate() {
                *exact += &q * &by_r[i / H] * &by_s[i % H];
            }
        }
        exact
    });
    let (value, by_s) = (patch.net().eval(r, s), fraction(s));
    for axis in 0..3 {
        let row = |row: &[BigRational]| row.iter().rfold(ratio(0, 1), |sum, q| sum * &by_s + q);
        let values = along(rows.as_flattened(), axis);
        let form = values.chunks_exact(H).rfold(ratio(0, 1), |sum, q| sum * fraction(r) + row(q));
        let error = ratio(value.to_array()[axis].bits(), 1) - form;
        assert!(error >= ratio(-1, 1) && error <= ratio(1, 1), "{error} units of the last place");
    }
}

fn check_powers<C: Coord>(points: &[Point3<C>], r: Parameter, s: Parameter) {
    let q = shrunk(points);
    check_power::<2, 2, C>(&q, r, s);
    check_power::<2, 9, C>(&q, r, s);
    check_power::<3, 4, C>(&q, r, s);
    check_power::<4, 4, C>(&q, r, s);
    check_power::<5, 8, C>(&q, r, s);
    check_power::<6, 3, C>(&q, r, s);
    check_power::<7, 7, C>(&q, r, s);
    check_power::<8, 5, C>(&q, r, s);
    check_power::<9, 9, C>(&q, r, s);
}

fn check_curve_power<const K: usize, C: Coord>(points: &[Point3<C>]) {
    let q = *shrunk(points).first_chunk::<K>().unwrap();
    assert_coefficients(Curve::<K, C>::from_power(&q).unwrap().points(), |axis| {
        let columns = along(&q, axis).into_iter().enumerate().map(|(k, q)| (q, power_column(K - 1, k, false)));
        columns.fold(vec![ratio(0, 1); K], |sum, (q, column)| {
            sum.into_iter().zip(column).map(|(sum, factor)| sum + &q * factor).collect()
        })
    });
}

fn check_curve_powers<C: Coord>(points: &[Point3<C>]) {
    check_curve_power::<2, C>(points);
    check_curve_power::<3, C>(points);
    check_curve_power::<4, C>(points);
    check_curve_power::<5, C>(points);
    check_curve_power::<6, C>(points);
    check_curve_power::<7, C>(points);
    check_curve_power::<8, C>(points);
    check_curve_power::<9, C>(points);
}

proptest! {
    #![proptest_config(cases(25))]

    #[test]
    fn elevated_nets_are_the_repeated_one_degree_elevation_rounded_once(
        narrow in net::<I16F16>(81), wide in net::<I32F32>(81),
    ) {
        check_elevations(&narrow);
        check_elevations(&wide);
    }

    #[test]
    fn power_forms_become_the_exact_net_rounded_once(
        narrow in net::<I16F16>(81), wide in net::<I32F32>(81), r in parameter(), s in parameter(),
    ) {
        check_powers(&narrow, r, s);
        check_powers(&wide, r, s);
        check_curve_powers(&narrow);
        check_curve_powers(&wide);
    }

    #[test]
    fn nets_round_to_the_narrow_type_half_up(points in net::<I32F32>(4)) {
        let wide = Curve::<4, I32F32>::try_from(*points.first_chunk().unwrap()).unwrap();
        let exact = |p: &Point3<I32F32>| p.to_array().map(|c| (c.to_bits() + (1 << 15)).div_euclid(1 << 16));
        let legal = points.iter().all(|p| exact(p).iter().all(|bits| bits.abs() <= 32767 << 16));
        let rounded = wide.round();
        prop_assert_eq!(rounded.is_ok(), legal);
        for (ours, p) in rounded.iter().flat_map(|curve| curve.points()).zip(&points) {
            prop_assert_eq!(ours.to_array().map(|c| i64::from(c.to_bits())), exact(p));
        }
    }
}

/// Equation (11) as printed has the triangular matrix the other way round: it does not even keep t^k at the ends.
#[test]
fn the_transposed_matrix_is_wrong_and_the_corrected_one_is_right_for_every_degree() {
    let t = Parameter::new(3, 7).unwrap();
    for m in 1..=8 {
        let basis = &curve_basis(m, t)[0];
        for k in 0..=m {
            let value = |transposed| basis.sum(power_column(m, k, transposed).into_iter());
            assert_eq!(value(false), power(&fraction(t), k), "t^{k} in degree {m}");
            assert_ne!(value(true), power(&fraction(t), k), "t^{k} in degree {m}, transposed");
        }
    }
    // Through the crate: t + t^2 + t^3 of units of 6 ends at 18, not at 6/3 + 6/3 + 6 spread over the start.
    let one = [Point3::ORIGIN, Point3::from_ints(6, 0, 0), Point3::from_ints(6, 0, 0), Point3::from_ints(6, 0, 0)];
    let curve = CubicCurve::from_power(&one).unwrap();
    assert_eq!(curve.points().map(|p| p.x.to_num::<i32>()), [0, 2, 6, 18]);
}

#[test]
fn elevating_a_line_spreads_its_points_evenly() {
    let line = Curve::<2>::from_ints([[0, 0, 0], [12, 6, -12]]).unwrap();
    let quartic = line.elevate::<5>().unwrap();
    assert_eq!(quartic.points().map(|p| p.x.to_num::<i32>()), [0, 3, 6, 9, 12]);
    // 1/3 and 2/3 of the last place round to 0 and 1; negative ones to -0 and -1.
    let tiny = Curve::<2>::new([Point3::from_bits(0, 0, -1), Point3::from_bits(1, -1, 0)]).unwrap();
    let cubic = tiny.elevate::<4>().unwrap();
    assert_eq!(cubic.points().map(|p| p.x.to_bits()), [0, 0, 1, 1]);
    assert_eq!(cubic.points().map(|p| p.y.to_bits()), [0, 0, -1, -1]);
    let middle = tiny.elevate::<3>().unwrap().points()[1];
    assert_eq!((middle.x.to_bits(), middle.y.to_bits(), middle.z.to_bits()), (1, 0, 0), "halves go up");
}

#[test]
fn power_forms_that_leave_the_range_are_typed_errors() {
    let (zero, far) = (Point3::ORIGIN, Point3::from_ints(0, 20_000, 0));
    let error = QuadraticCurve::from_power(&[far, zero, far]);
    assert_eq!(error, Err(NetError::OutOfRange { index: 2, axis: Axis::Y, units: 40_000, limit: 32_767 }));
    let error = BilinearPatch::from_power(&[[far, zero], [far, zero]]);
    assert_eq!(error, Err(NetError::OutOfRange { index: 2, axis: Axis::Y, units: 40_000, limit: 32_767 }));
    // Coefficients may be outside the range themselves as long as the control points are not.
    let beyond = Point3::from_bits(i32::MIN, 0, 0);
    let line = Curve::<2>::from_power(&[Point3::from_ints(32_767, 0, 0), beyond]).unwrap();
    assert_eq!(line.points()[1], Point3::from_ints(-1, 0, 0));
    let all = [Point3::new(I32F32::MAX, I32F32::MIN, I32F32::MAX); 9];
    let error = Tensor::<9, 9, I32F32>::from_power(&[all; 9]);
    assert_eq!(error, Err(NetError::OutOfRange { index: 0, axis: Axis::X, units: i32::MAX.into(), limit: 1 << 26 }));
}

#[test]
fn rounding_a_net_names_the_point_in_storage_order() {
    let at = |x: i64| Point3::new(I32F32::from_num(x), I32F32::ZERO, I32F32::ZERO);
    let error = Err(NetError::OutOfRange { index: 2, axis: Axis::X, units: -40_000, limit: 32_767 });
    let curve = Curve::<3, I32F32>::new([at(1), at(2), at(-40_000)]).unwrap();
    assert_eq!(curve.round().map(|_| ()), error);
    let triangle = Triangle::<1, 3, I32F32>::new([at(1), at(2), at(-40_000)]).unwrap();
    assert_eq!(triangle.round().map(|_| ()), error);
    let tensor = Tensor::<2, 2, I32F32>::new([[at(1), at(2)], [at(-40_000), at(3)]]).unwrap();
    assert_eq!(tensor.round().map(|_| ()), error);
    let small = Tensor::<2, 2, I32F32>::new([[at(1), at(2)], [at(3), at(4)]]).unwrap();
    assert_eq!(small.round().unwrap().points()[1][0], Point3::from_ints(3, 0, 0));
    let cubic = Triangle::<3, 10, I32F32>::new([at(-7); 10]).unwrap();
    assert_eq!(cubic.round(), CubicTriangle::from_ints([[-7, 0, 0]; 10]));
}

#[test]
fn the_elevated_net_has_the_same_points() {
    let patch = BilinearPatch::from_ints([[[0, 0, 0], [0, 60, 0]], [[60, 0, 0], [60, 60, 60]]]).unwrap();
    let elevated = patch.elevate::<4, 4>().unwrap();
    let net: TensorNet<'_> = elevated.net();
    for (p, q) in (0..=6).flat_map(|p| (0..=6).map(move |q| (p, q))) {
        let (r, s) = (Parameter::new(p, 6).unwrap(), Parameter::new(q, 6).unwrap());
        let (exact, ours) = (patch.net().eval(r, s), net.eval(r, s));
        for (a, b) in exact.to_array().into_iter().zip(ours.to_array()) {
            assert!(a.to_bits().abs_diff(b.to_bits()) <= 1);
        }
    }
}
