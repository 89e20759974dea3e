//! Direct Bernstein sums.
//!
//! Accuracy for parameters in the domain: at degree 8 a sum has at most 81 terms with at most 40 roundings each, so
//! a point is within 2^-45 of the largest coordinate, that is within 2^-30 unit for `I16F16` nets.

use crate::geometry::Point3;
use crate::num::{Coord, I16F16};
use crate::patch::{CurveNet, MAX_DEGREE, SurfaceNet};

/// Values of B_0 ..= B_n; 0 past n.
pub(super) type Basis = [f64; MAX_DEGREE + 1];

/// The coordinates of a control point: exact for `I16F16`, to 53 bits for `I32F32`.
pub(super) fn coordinates<C: Coord>(p: &Point3<C>) -> [f64; 3] {
    let one = (1_u64 << C::FRACTION_BITS) as f64;
    [p.x, p.y, p.z].map(|c| c.bits() as f64 / one)
}

/// t^0 ..= t^n, by repeated multiplication (`powi` promises no particular bits).
pub(super) fn powers(n: usize, t: f64) -> Basis {
    let mut out = [0.0; MAX_DEGREE + 1];
    out[0] = 1.0;
    for k in 1..=n {
        out[k] = out[k - 1] * t;
    }
    out
}

/// n!, exact.
pub(super) fn factorial(n: usize) -> f64 {
    (1..=n).map(|k| k as f64).product()
}

/// B_i^n(t) = C(n,i) t^i (1−t)^(n−i) for i = 0 ..= n (Farin, "Curves and Surfaces for CAGD", 5th ed., section 4.1).
pub(super) fn bernstein(n: usize, t: f64) -> Basis {
    let (rising, falling) = (powers(n, t), powers(n, 1.0 - t));
    let mut out = [0.0; MAX_DEGREE + 1];
    for i in 0..=n {
        let choose = factorial(n) / (factorial(i) * factorial(n - i));
        out[i] = choose * rising[i] * falling[n - i];
    }
    out
}

/// Where b\[i,j,k\] stands in a triangular net: after the 1 + 2 + … + (j+k) points of larger i, then k further.
fn triangle_place(j: usize, k: usize) -> usize {
    (0..=j + k).sum::<usize>() + k
}

fn add_scaled<const N: usize>(sum: &mut [f64; N], weight: f64, value: [f64; N]) {
    for (sum, value) in sum.iter_mut().zip(value) {
        *sum += weight * value;
    }
}

fn minus<const N: usize>(a: [f64; N], b: [f64; N]) -> [f64; N] {
    core::array::from_fn(|c| a[c] - b[c])
}

/// Control point `index` in homogeneous coordinates: (w x, w y, w z, w), each product exact.
pub(super) fn homogeneous<C: Coord>(net: SurfaceNet<'_, C>, index: usize) -> [f64; 4] {
    let [x, y, z] = coordinates(&net.points()[index]);
    let w = net.weights().map_or(1.0, |weights| f64::from(weights[index].to_bits()) / 65536.0);
    [w * x, w * y, w * z, w]
}

/// (x, y, z, w) to (x/w, y/w, z/w); a polynomial has w = 1 and is left alone.
fn project([x, y, z, w]: [f64; 4], rational: bool) -> [f64; 3] {
    if rational { [x / w, y / w, z / w] } else { [x, y, z] }
}

/// The derivative of the projected point from value and derivative in homogeneous coordinates: (A' − S W')/W.
fn project_slope(value: [f64; 4], slope: [f64; 4], rational: bool) -> [f64; 3] {
    let s = project(value, rational);
    let raw = [slope[0], slope[1], slope[2]];
    if rational { core::array::from_fn(|c| (raw[c] - s[c] * slope[3]) / value[3]) } else { raw }
}

/// The values at 0 ..= n with their indices.
fn indexed(n: usize, values: Basis) -> impl Iterator<Item = (usize, f64)> + Clone {
    values.into_iter().enumerate().take(n + 1)
}

/// Σ B_i^n(t) · `value`(i).
fn curve_sum<const N: usize>(n: usize, t: f64, value: impl Fn(usize) -> [f64; N]) -> [f64; N] {
    let mut sum = [0.0; N];
    for (i, weight) in indexed(n, bernstein(n, t)) {
        add_scaled(&mut sum, weight, value(i));
    }
    sum
}

/// Σ B_i^m(r) B_j^h(s) · `value`(i, j).
fn tensor_sum<const N: usize>(
    (m, h): (usize, usize),
    (r, s): (f64, f64),
    value: impl Fn(usize, usize) -> [f64; N],
) -> [f64; N] {
    let by_s = indexed(h, bernstein(h, s));
    let mut sum = [0.0; N];
    for (i, by_r) in indexed(m, bernstein(m, r)) {
        for (j, by_s) in by_s.clone() {
            add_scaled(&mut sum, by_r * by_s, value(i, j));
        }
    }
    sum
}

/// Σ n!/(i!j!k!) u^i v^j w^k · `value`(j, k) over i + j + k = n (ibid., "Bézier Triangles").
fn triangle_sum<const N: usize>(n: usize, (u, v): (f64, f64), value: impl Fn(usize, usize) -> [f64; N]) -> [f64; N] {
    let (by_u, by_w) = (powers(n, u), powers(n, 1.0 - u - v));
    let mut sum = [0.0; N];
    for (j, by_v) in indexed(n, powers(n, v)) {
        for (k, by_w) in indexed(n - j, by_w) {
            let i = n - j - k;
            let arrangements = factorial(n) / (factorial(i) * factorial(j) * factorial(k));
            add_scaled(&mut sum, arrangements * by_u[i] * by_v * by_w, value(j, k));
        }
    }
    sum
}

/// The point of a curve at `t`.
///
/// ```
/// use embedded_surfaces::{patch::QuadraticCurve, reference::curve_point};
/// let parabola = QuadraticCurve::from_ints([[0, 0, 0], [8, 0, 0], [16, 16, 0]])?; // (16t, 16t²)
/// assert_eq!(curve_point(parabola.net(), 0.25), [4.0, 1.0, 0.0]);
/// # Ok::<(), embedded_surfaces::patch::NetError>(())
/// ```
#[must_use]
pub fn curve_point<C: Coord>(net: CurveNet<'_, C>, t: f64) -> [f64; 3] {
    curve_sum(net.degree(), t, |i| coordinates(&net.points()[i]))
}

/// The derivative of a curve at `t`: m Σ B_i^(m−1)(t) (P_(i+1) − P_i).
///
/// ```
/// use embedded_surfaces::{patch::QuadraticCurve, reference::curve_derivative};
/// let parabola = QuadraticCurve::from_ints([[0, 0, 0], [8, 0, 0], [16, 16, 0]])?; // (16t, 16t²)
/// assert_eq!(curve_derivative(parabola.net(), 0.25), [16.0, 8.0, 0.0]);
/// # Ok::<(), embedded_surfaces::patch::NetError>(())
/// ```
#[must_use]
pub fn curve_derivative<C: Coord>(net: CurveNet<'_, C>, t: f64) -> [f64; 3] {
    let p = |i: usize| coordinates(&net.points()[i]);
    let m = net.degree();
    curve_sum(m - 1, t, |i| minus(p(i + 1), p(i))).map(|c| m as f64 * c)
}

/// The point of a surface at (u, v).
///
/// ```
/// use embedded_surfaces::patch::{FlatTriangle, Surface};
/// use embedded_surfaces::reference::point;
/// let t = FlatTriangle::from_ints([[8, 0, 0], [0, 8, 0], [0, 0, 8]])?; // (8u, 8v, 8w)
/// assert_eq!(point(t.surface(), 0.25, 0.5), [2.0, 4.0, 2.0]);
/// # Ok::<(), embedded_surfaces::patch::NetError>(())
/// ```
#[must_use]
pub fn point<C: Coord>(net: SurfaceNet<'_, C>, u: f64, v: f64) -> [f64; 3] {
    project(homogeneous_point(net, u, v), net.weights().is_some())
}

fn homogeneous_point<C: Coord>(net: SurfaceNet<'_, C>, u: f64, v: f64) -> [f64; 4] {
    let p = |index: usize| homogeneous(net, index);
    let (m, h) = net.degrees();
    if net.is_triangle() {
        triangle_sum(m, (u, v), |j, k| p(triangle_place(j, k)))
    } else {
        tensor_sum((m, h), (u, v), |i, j| p(i * (h + 1) + j))
    }
}

/// The partial derivatives \[S_u, S_v\] at (u, v); for a triangle w = 1 − u − v moves along.
///
/// Differences of `I16F16` points are exact in `f64`, so a derivative along a collapsed edge is exactly 0.
///
/// ```
/// use embedded_surfaces::patch::{BilinearPatch, Surface};
/// use embedded_surfaces::reference::partials;
/// let saddle = BilinearPatch::from_ints([[[0, 0, 0], [0, 8, 0]], [[8, 0, 0], [8, 8, 8]]])?; // (8r, 8s, 8rs)
/// assert_eq!(partials(saddle.surface(), 0.25, 0.5), [[8.0, 0.0, 4.0], [0.0, 8.0, 2.0]]);
/// # Ok::<(), embedded_surfaces::patch::NetError>(())
/// ```
#[must_use]
pub fn partials<C: Coord>(net: SurfaceNet<'_, C>, u: f64, v: f64) -> [[f64; 3]; 2] {
    let value = homogeneous_point(net, u, v);
    let slopes = if net.is_triangle() { triangle_partials(net, u, v) } else { tensor_partials(net, u, v) };
    slopes.map(|slope| project_slope(value, slope, net.weights().is_some()))
}

/// n Σ B^(n−1) (b\[i+1,j,k\] − b\[i,j,k+1\]) and n Σ B^(n−1) (b\[i,j+1,k\] − b\[i,j,k+1\]), homogeneous.
fn triangle_partials<C: Coord>(net: SurfaceNet<'_, C>, u: f64, v: f64) -> [[f64; 4]; 2] {
    let p = |j: usize, k: usize| homogeneous(net, triangle_place(j, k));
    let n = net.degrees().0;
    let by_u = triangle_sum(n - 1, (u, v), |j, k| minus(p(j, k), p(j, k + 1)));
    let by_v = triangle_sum(n - 1, (u, v), |j, k| minus(p(j + 1, k), p(j, k + 1)));
    [by_u, by_v].map(|d| d.map(|c| n as f64 * c))
}

fn tensor_partials<C: Coord>(net: SurfaceNet<'_, C>, r: f64, s: f64) -> [[f64; 4]; 2] {
    let (m, h) = net.degrees();
    let p = |i: usize, j: usize| homogeneous(net, i * (h + 1) + j);
    let by_r = tensor_sum((m - 1, h), (r, s), |i, j| minus(p(i + 1, j), p(i, j)));
    let by_s = tensor_sum((m, h - 1), (r, s), |i, j| minus(p(i, j + 1), p(i, j)));
    [by_r.map(|c| m as f64 * c), by_s.map(|c| h as f64 * c)]
}

/// The nearest `I16F16`, half up: floor(65536·value + 1/2) units of 2^-16, exactly. `None` for NaN and where the
/// result is outside the legal ±32767.
///
/// No sum is rounded on the way. With x = 65536·value (exact: a power of two) and f = floor(x), the question is
/// whether x − f ≥ 1/2. That difference is exact for x ≥ 0, for x ≤ −1 (a multiple of the last place of x, below
/// 1) and for −1 < x ≤ −1/2 (Sterbenz); in between it is above 1/2 and stays so when rounded.
///
/// ```
/// use embedded_surfaces::reference::fixed_half_up;
/// let bits = |value| fixed_half_up(value).map(|c| c.to_bits());
/// assert_eq!(bits(-0.5 / 65536.0), Some(0));
/// assert_eq!(bits(0.49999999999999994 / 65536.0), Some(0)); // floor(x + 0.5) in f64 would say 1
/// assert_eq!(bits(32767.1), None);
/// ```
#[must_use]
pub fn fixed_half_up(value: f64) -> Option<I16F16> {
    const ONE: f64 = 65536.0;
    const LIMIT: f64 = 32767.0 * ONE;
    let scaled = value * ONE;
    let floor = scaled.floor();
    let rounded = if scaled - floor >= 0.5 { floor + 1.0 } else { floor };
    // NaN fails the comparison; within the limit the cast is exact.
    (rounded.abs() <= LIMIT).then(|| I16F16::from_bits(rounded as i32))
}

#[cfg(test)]
mod tests {
    use super::super::samples::{Net, nets};
    use super::*;
    use crate::patch::{BilinearPatch, Surface};
    use num_bigint::BigInt;
    use num_rational::BigRational;
    use proptest::prelude::*;
    use std::vec::Vec;

    /// 2^-30.
    const TOLERANCE: f64 = 1.0 / (1_u64 << 30) as f64;

    /// De Casteljau's algorithm on one axis with integer parameters: q^steps times the value, in units of 2^-16.
    fn casteljau(mut values: Vec<i128>, p: i128, q: i128) -> i128 {
        while values.len() > 1 {
            values = values.windows(2).map(|w| (q - p) * w[0] + p * w[1]).collect();
        }
        values[0]
    }

    /// The exact value of one axis at (p, t)/q, in units of 2^-16 / q^(m+h) (q^n for a triangle).
    fn exact(net: &Net, axis: usize, (p, t, q): (i128, i128, i128)) -> i128 {
        let bits = |index: usize| i128::from(net.points[index].to_array()[axis].to_bits());
        match net.surface() {
            SurfaceNet::Tensor(patch) => {
                let (m, h) = patch.degrees();
                let row = |i: usize| (0..=h).map(|j| bits(i * (h + 1) + j)).collect();
                casteljau((0..=m).map(|i| casteljau(row(i), t, q)).collect(), p, q)
            }
            SurfaceNet::Triangle(patch) => {
                // Row by row from b[n,0,0]: each step joins a point to the two below it.
                let n = patch.degree();
                let mut rows: Vec<Vec<i128>> =
                    (0..=n).map(|r| (0..=r).map(|k| bits(r * (r + 1) / 2 + k)).collect()).collect();
                for size in (1..=n).rev() {
                    rows = (0..size)
                        .map(|r| {
                            let join =
                                |k: usize| p * rows[r][k] + t * rows[r + 1][k] + (q - p - t) * rows[r + 1][k + 1];
                            (0..=r).map(join).collect()
                        })
                        .collect();
                }
                rows[0][0]
            }
            rational => panic!("{rational:?} is not a polynomial"),
        }
    }

    proptest! {
        #[test]
        fn points_agree_with_exact_arithmetic(net in nets(8, 32767 << 16), p in 0_i32..=16, t in 0_i32..=16) {
            let t = if net.is_triangle() { t.min(16 - p) } else { t };
            let got = point(net.surface(), f64::from(p) / 16.0, f64::from(t) / 16.0);
            let (m, h) = net.surface().degrees();
            let steps = if net.is_triangle() { m } else { m + h };
            for (axis, got) in got.into_iter().enumerate() {
                let want = exact(&net, axis, (p.into(), t.into(), 16)) as f64 / 65536.0 / powers_of_16(steps);
                prop_assert!((got - want).abs() <= TOLERANCE, "{got} for {want}");
            }
        }

        // The five-point stencil is exact for polynomials up to degree 4.
        #[test]
        fn partials_agree_with_differences(net in nets(4, 1 << 24), u in 0.2..0.4, v in 0.2..0.4) {
            const H: f64 = 1.0 / 16.0;
            let stencil = |at: &dyn Fn(f64) -> [f64; 3], axis: usize| {
                let f = |k: f64| at(k * H)[axis];
                (f(-2.0) - 8.0 * f(-1.0) + 8.0 * f(1.0) - f(2.0)) / (12.0 * H)
            };
            let [by_u, by_v] = partials(net.surface(), u, v);
            for axis in 0..3 {
                let want_u = stencil(&|d| point(net.surface(), u + d, v), axis);
                let want_v = stencil(&|d| point(net.surface(), u, v + d), axis);
                prop_assert!((by_u[axis] - want_u).abs() < 1e-8, "{} for {want_u}", by_u[axis]);
                prop_assert!((by_v[axis] - want_v).abs() < 1e-8, "{} for {want_v}", by_v[axis]);
            }
        }

        #[test]
        fn bases_sum_to_one(n in 1_usize..=8, t in 0.0..=1.0, v in 0.0..=1.0) {
            let sum: f64 = bernstein(n, t).into_iter().sum();
            prop_assert!((sum - 1.0).abs() < 1e-14);
            let v = v * (1.0 - t);
            prop_assert!((triangle_sum(n, (t, v), |_, _| [1.0; 3])[0] - 1.0).abs() < 1e-14);
        }

        #[test]
        fn rounding_is_exact(value in rounding_values()) {
            let half = BigRational::new(BigInt::from(1), BigInt::from(2));
            let scale = BigRational::from(BigInt::from(65536));
            let exact = BigRational::from_float(value).unwrap() * scale + half;
            let limit = BigInt::from(32767 << 16);
            let want = Some(exact.floor().to_integer()).filter(|bits| *bits <= limit && *bits >= -limit);
            prop_assert_eq!(fixed_half_up(value).map(|c| BigInt::from(c.to_bits())), want);
        }
    }

    fn powers_of_16(n: usize) -> f64 {
        (0..n).fold(1.0, |p, _| p * 16.0)
    }

    /// Ties, their neighbours a few last places away, tiny and large values.
    fn rounding_values() -> impl Strategy<Value = f64> {
        let near_ties = (-70_000_i64..70_000, -3_i64..=3).prop_map(|(halves, last_places)| {
            let tie = halves as f64 / 131_072.0;
            f64::from_bits(tie.to_bits().wrapping_add_signed(if halves == 0 { 0 } else { last_places }))
        });
        prop_oneof![near_ties, -33_000.0..33_000.0, 32_766.9..32_767.1, -32_767.1..-32_766.9, -1e-300..1e-300]
    }

    #[test]
    fn ties_go_up_and_only_ties() {
        // In units of 2^-16; 0.49999999999999994 + 0.5 rounds to 1 in f64.
        for (value, want) in [
            (0.5, 1),
            (0.49999999999999994, 0),
            (-0.5, 0),
            (-0.5000000000000001, -1),
            (-0.49999999999999994, 0),
            (-5e-324 * 65536.0, 0),
            (-1.5, -1),
            (2147418111.5, 2147418112),
            (2147418111.4999998, 2147418111),
        ] {
            assert_eq!(fixed_half_up(value / 65536.0).map(I16F16::to_bits), Some(want), "{value}");
        }
    }

    #[test]
    fn nothing_illegal_is_rounded() {
        for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, f64::MAX, 32768.0, -32768.0, 32767.00001] {
            assert_eq!(fixed_half_up(value), None, "{value}");
        }
        assert_eq!(fixed_half_up(32767.0), Some(I16F16::from_num(32767)));
        assert_eq!(fixed_half_up(-32767.0), Some(I16F16::from_num(-32767)));
        assert_eq!(fixed_half_up(-32767.0 - 0.5 / 65536.0), Some(I16F16::from_num(-32767)));
        assert_eq!(fixed_half_up(32767.0 + 0.5 / 65536.0), None);
    }

    #[test]
    fn curves_have_their_closed_form() {
        use crate::patch::CurveNet;
        // (24t, 24t², 24t³): P_i by the blossom of t, t², t³.
        let points = [[0, 0, 0], [8, 0, 0], [16, 8, 0], [24, 24, 24]].map(|[x, y, z]| Point3::from_ints(x, y, z));
        let net = CurveNet::new(&points).unwrap();
        for t in [0.0, 0.125, 0.5, 0.75, 1.0] {
            assert_eq!(curve_point(net, t), [24.0 * t, 24.0 * t * t, 24.0 * t * t * t]);
            assert_eq!(curve_derivative(net, t), [24.0, 48.0 * t, 72.0 * t * t]);
        }
    }

    #[test]
    fn both_coordinate_types_agree() {
        let net = BilinearPatch::from_ints([[[0, -7, 0], [0, 8, 3]], [[8, 0, 0], [8, 9, 8]]]).unwrap();
        let wide = crate::patch::Tensor::try_from(net.points().map(|row| row.map(Point3::<crate::num::I32F32>::from)));
        let wide = wide.unwrap();
        assert_eq!(point(net.surface(), 0.3, 0.7), point(wide.surface(), 0.3, 0.7));
    }
}
