//! Bounds on nets against what is measured: differences in exact integers, distances by dense sampling in `f64`.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]
#![allow(clippy::disallowed_types, clippy::float_arithmetic)]

mod common;

use common::basis::triangle_indices;
use common::draw::{cases, net, weights};
use common::smooth::{Shape, Smooth, distance};
use common::triangle_index;
use embedded_surfaces::geometry::Point3;
use embedded_surfaces::num::{I16F16, I32F32};
use embedded_surfaces::patch::{
    CurveNet, RationalCurveNet, RationalTensorNet, RationalTriangleNet, SurfaceNet, TensorNet, TriangleNet,
};
use embedded_surfaces::subdivide::{
    Direction, Half, Quarter, SubdivideError, Tolerance, halve_curve, halve_tensor, quarter_triangle,
};
use proptest::prelude::*;

/// Points with three integer coordinates.
type Net = Vec<[i128; 3]>;

fn bits(points: &[Point3]) -> Net {
    points.iter().map(|p| p.to_array().map(|c| c.to_bits().into())).collect()
}

fn square(v: [i128; 3]) -> i128 {
    v.iter().map(|c| c * c).sum()
}

/// Σ factor · point
fn sum(net: &Net, terms: &[(i128, usize)]) -> [i128; 3] {
    std::array::from_fn(|a| terms.iter().map(|(f, i)| f * net[*i][a]).sum())
}

/// The largest squared first and second differences of a triangle along T1T2, T2T3, T3T1.
fn triangle_differences(n: usize, net: &Net) -> [[i128; 3]; 2] {
    let step = |at: (usize, usize, usize), corner: usize, by: usize| match corner {
        0 => (at.0 + by, at.1, at.2),
        1 => (at.0, at.1 + by, at.2),
        _ => (at.0, at.1, at.2 + by),
    };
    let edges = [(0, 1), (1, 2), (2, 0)];
    let first = edges.map(|(p, q)| {
        let difference = |at| [(1, step(at, q, 1)), (-1, step(at, p, 1))].map(|(f, at)| (f, triangle_index(n, at)));
        triangle_indices(n - 1).map(|at| square(sum(net, &difference(at)))).max().unwrap()
    });
    let second = edges.map(|(p, q)| {
        let terms = |at| [(1, step(at, q, 2)), (-2, step(step(at, p, 1), q, 1)), (1, step(at, p, 2))];
        let difference = |at| terms(at).map(|(f, at)| (f, triangle_index(n, at)));
        let all = n.checked_sub(2).map(|lower| triangle_indices(lower).map(|at| square(sum(net, &difference(at)))));
        all.and_then(Iterator::max).unwrap_or(0)
    });
    [first, second]
}

/// The largest squared first differences (r, s) and second differences (rr, rs, ss) of a tensor-product net.
fn tensor_differences((m, h): (usize, usize), net: &Net) -> ([i128; 2], [i128; 3]) {
    let largest = |terms: &[(i128, usize, usize)]| {
        let (rows, columns) = (terms.iter().map(|t| t.1).max().unwrap(), terms.iter().map(|t| t.2).max().unwrap());
        let all = (rows..=m).flat_map(|i| (columns..=h).map(move |j| (i - rows, j - columns)));
        let at = |(i, j): (usize, usize)| -> Vec<_> {
            terms.iter().map(|(f, a, b)| (*f, (i + a) * (h + 1) + j + b)).collect()
        };
        all.map(|place| square(sum(net, &at(place)))).max().unwrap_or(0)
    };
    let first = [largest(&[(1, 1, 0), (-1, 0, 0)]), largest(&[(1, 0, 1), (-1, 0, 0)])];
    let second = [
        largest(&[(1, 2, 0), (-2, 1, 0), (1, 0, 0)]),
        largest(&[(1, 1, 1), (-1, 1, 0), (-1, 0, 1), (1, 0, 0)]),
        largest(&[(1, 0, 2), (-2, 0, 1), (1, 0, 0)]),
    ];
    (first, second)
}

/// Fails unless the length is the square root, rounded up to 2^-16.
fn assert_length(ours: I32F32, square: i128) {
    let length = i128::from(ours.to_bits());
    assert_eq!(length % 65_536, 0);
    let length = length / 65_536;
    assert!(length * length >= square && (length == 0 || (length - 1) * (length - 1) < square), "{ours} for {square}");
}

/// Applies a cut to every coordinate.
fn cut(net: &Net, by: impl Fn(&mut [i128])) -> Net {
    let axes: [Vec<i128>; 3] = std::array::from_fn(|a| {
        let mut axis: Vec<_> = net.iter().map(|p| p[a]).collect();
        by(&mut axis);
        axis
    });
    (0..net.len()).map(|i| [axes[0][i], axes[1][i], axes[2][i]]).collect()
}

fn triangle() -> impl Strategy<Value = (usize, Vec<Point3>)> {
    (1_usize..=8).prop_flat_map(|n| (Just(n), net(triangle_indices(n).count())))
}

fn tensor() -> impl Strategy<Value = ((usize, usize), Vec<Point3>)> {
    (1_usize..=8, 1_usize..=8).prop_flat_map(|(m, h)| (Just((m, h)), net((m + 1) * (h + 1))))
}

/// Weights whose ratio is at most 3/2, for which bounds from the net alone are worth something.
fn mild(len: usize) -> impl Strategy<Value = Vec<I16F16>> {
    prop::collection::vec((65_536..=98_304).prop_map(I16F16::from_bits), len)
}

/// A net of any kind, with weights or none.
fn any_patch() -> impl Strategy<Value = (Shape, Vec<Point3>, Option<Vec<I16F16>>)> {
    let shape = prop_oneof![
        (1_usize..=8).prop_map(Shape::Curve),
        (1_usize..=8).prop_map(Shape::Triangle),
        (1_usize..=6, 1_usize..=6).prop_map(|(m, h)| Shape::Tensor(m, h)),
    ];
    shape.prop_flat_map(|shape| {
        let len = match shape {
            Shape::Curve(n) => n + 1,
            Shape::Triangle(n) => triangle_indices(n).count(),
            Shape::Tensor(m, h) => (m + 1) * (h + 1),
        };
        (Just(shape), net(len), prop_oneof![Just(None), weights(len).prop_map(Some), mild(len).prop_map(Some)])
    })
}

/// Calls `then` with the two answers of a net: its flatness, and whether it passes the displacement test.
fn with_net<T>(
    (shape, points, weights): &(Shape, Vec<Point3>, Option<Vec<I16F16>>),
    then: impl FnOnce(I32F32, &dyn Fn(Tolerance) -> bool, &dyn Fn(Tolerance) -> Result<[u32; 2], SubdivideError>) -> T,
) -> T {
    let surface = match (*shape, weights) {
        (Shape::Curve(_), None) => {
            let net = CurveNet::new(points).unwrap();
            return then(net.flatness(), &|t| net.is_flat(t), &|t| net.depth_for(t).map(|m| [m, 0]));
        }
        (Shape::Curve(_), Some(w)) => {
            let net = RationalCurveNet::new(CurveNet::new(points).unwrap(), w).unwrap();
            return then(net.flatness(), &|t| net.is_flat(t), &|t| net.depth_for(t).map(|m| [m, 0]));
        }
        (Shape::Triangle(n), None) => SurfaceNet::Triangle(TriangleNet::new(n, points).unwrap()),
        (Shape::Triangle(n), Some(w)) => {
            let net = TriangleNet::new(n, points).unwrap();
            SurfaceNet::RationalTriangle(RationalTriangleNet::new(net, w).unwrap())
        }
        (Shape::Tensor(m, h), None) => SurfaceNet::Tensor(TensorNet::new((m, h), points).unwrap()),
        (Shape::Tensor(m, h), Some(w)) => {
            let net = TensorNet::new((m, h), points).unwrap();
            SurfaceNet::RationalTensor(RationalTensorNet::new(net, w).unwrap())
        }
    };
    then(surface.flatness(), &|t| surface.is_flat(t), &|t| surface.depths_for(t))
}

fn tolerance(bits: i32) -> Tolerance {
    Tolerance::new(I16F16::from_bits(bits)).unwrap()
}

fn to_f64(x: I32F32) -> f64 {
    x.to_bits() as f64 / 4_294_967_296.0
}

/// The least tolerance that passes, in bits; `None` if none does.
fn threshold(is_flat: &dyn Fn(Tolerance) -> bool) -> Option<i32> {
    let (mut low, mut high) = (0_i64, i64::from(i32::MAX) + 1);
    while high - low > 1 {
        let middle = i64::midpoint(low, high);
        if is_flat(tolerance(middle as i32)) { high = middle } else { low = middle }
    }
    i32::try_from(high).ok()
}

/// The square of the largest displacement times (denominator)², of the test as documented.
fn displacement(shape: Shape, net: &Net, rational: bool) -> (i128, i128) {
    match shape {
        Shape::Curve(n) => {
            let of = |i: usize| sum(net, &[(n as i128, i), (i as i128 - n as i128, 0), (-(i as i128), n)]);
            ((0..=n).map(|i| square(of(i))).max().unwrap(), n as i128)
        }
        Shape::Triangle(n) => {
            let corner = [(n, 0, 0), (0, n, 0), (0, 0, n)].map(|at| triangle_index(n, at));
            let of = |(i, j, k): (usize, usize, usize)| {
                let [i2, j2, k2] = [i, j, k].map(|c| -(c as i128));
                sum(
                    net,
                    &[(n as i128, triangle_index(n, (i, j, k))), (i2, corner[0]), (j2, corner[1]), (k2, corner[2])],
                )
            };
            (triangle_indices(n).map(|at| square(of(at))).max().unwrap(), n as i128)
        }
        Shape::Tensor(m, h) => {
            let corner = [0, h, m * (h + 1), m * (h + 1) + h];
            // Over 4mh: the bilinear interpolant, and a quarter or half of the twist either way.
            let (mh, share) = ((m * h) as i128, if rational { 2 } else { 1 });
            let of = |i: usize, j: usize, sign: i128| {
                let shares = [(m - i) * (h - j), (m - i) * j, i * (h - j), i * j].map(|f| -4 * f as i128);
                let twist = sign * share * mh;
                let terms = [twist, -twist, -twist, twist];
                let corners: Vec<_> = (0..4).map(|c| (shares[c] + terms[c], corner[c])).collect();
                sum(net, &[vec![(4 * mh, i * (h + 1) + j)], corners].concat())
            };
            let all = (0..=m).flat_map(|i| (0..=h).flat_map(move |j| [(i, j, 1), (i, j, -1)]));
            (all.map(|(i, j, sign)| square(of(i, j, sign))).max().unwrap(), 4 * mh)
        }
    }
}

/// Points of the domain.
fn samples(shape: Shape, per: usize) -> impl Iterator<Item = [f64; 2]> {
    let part = move |i: usize| i as f64 / per as f64;
    let all = (0..=per).flat_map(move |i| (0..=per).map(move |j| (i, j)));
    all.filter(move |(i, j)| match shape {
        Shape::Curve(_) => *j == 0,
        Shape::Triangle(_) => i + j <= per,
        Shape::Tensor(..) => true,
    })
    .map(move |(i, j)| [part(i), part(j)])
}

/// Rounding of `f64` at the legal range.
const SLACK: f64 = 1e-9;

proptest! {
    #![proptest_config(cases(128))]

    /// Lemma 1 per direction, and its twin: each child halves the first differences and quarters the second.
    #[test]
    fn subdivision_halves_and_quarters_the_differences_of_triangles((n, points) in triangle()) {
        let net = bits(&points);
        let [first, second] = triangle_differences(n, &net);
        for quarter in Quarter::ALL {
            // Over 2^n: |child| ≤ 2^n·parent/2 and 2^n·parent/4.
            let [of_first, of_second] = triangle_differences(n, &cut(&net, |axis| quarter_triangle(axis, n, quarter)));
            for edge in 0..3 {
                prop_assert!(4 * of_first[edge] <= first[edge] << (2 * n));
                prop_assert!(16 * of_second[edge] <= second[edge] << (2 * n));
            }
        }
        let view = TriangleNet::new(n, &points).unwrap();
        view.first_differences().into_iter().zip(first).for_each(|(ours, exact)| assert_length(ours, exact));
        view.second_differences().into_iter().zip(second).for_each(|(ours, exact)| assert_length(ours, exact));
    }

    #[test]
    fn halving_halves_the_differences_of_its_direction((degrees, points) in tensor()) {
        let net = bits(&points);
        let (first, second) = tensor_differences(degrees, &net);
        for (half, direction) in [(Half::First, Direction::R), (Half::Second, Direction::S)] {
            let along_r = direction == Direction::R;
            let n = if along_r { degrees.0 } else { degrees.1 };
            let part = cut(&net, |axis| halve_tensor(axis, degrees, direction, half));
            let (of_first, of_second) = tensor_differences(degrees, &part);
            let (halved, quartered) = if along_r { ([4, 1], [16, 4, 1]) } else { ([1, 4], [1, 4, 16]) };
            for d in 0..2 {
                prop_assert!(halved[d] * of_first[d] <= first[d] << (2 * n));
            }
            for d in 0..3 {
                prop_assert!(quartered[d] * of_second[d] <= second[d] << (2 * n));
            }
        }
        let view = TensorNet::new(degrees, &points).unwrap();
        view.first_differences().into_iter().zip(first).for_each(|(ours, exact)| assert_length(ours, exact));
        view.second_differences().into_iter().zip(second).for_each(|(ours, exact)| assert_length(ours, exact));
    }

    #[test]
    fn differences_of_curves(points in (2_usize..=9).prop_flat_map(net::<I16F16>)) {
        let (n, exact) = (points.len() - 1, bits(&points));
        // A curve is a tensor product of degrees (n, 0) for the oracle.
        let ([first, _], [second, ..]) = tensor_differences((n, 0), &exact);
        let ([of_first, _], [of_second, ..]) =
            tensor_differences((n, 0), &cut(&exact, |axis| halve_curve(axis, Half::First)));
        prop_assert!(4 * of_first <= first << (2 * n) && 16 * of_second <= second << (2 * n));
        let view = CurveNet::new(&points).unwrap();
        assert_length(view.first_difference(), first);
        assert_length(view.second_difference(), second);
    }

    /// At equal parameters no point is farther from the interpolant than the bound says.
    #[test]
    fn the_flatness_bound_holds(patch in any_patch()) {
        let smooth = Smooth::new(patch.0, &patch.1, patch.2.as_deref());
        let bound = with_net(&patch, |flatness, _, _| to_f64(flatness));
        for at in samples(patch.0, 24) {
            let point = smooth.eval(at);
            for flat in smooth.flat(at) {
                let measured = distance(point, flat);
                prop_assert!(measured <= bound * (1.0 + SLACK) + SLACK, "{measured} > {bound} at {at:?}");
            }
        }
    }

    /// The least tolerance that passes is the documented one, and no point is farther from the triangles.
    #[test]
    fn the_displacement_test_is_exact_and_holds(patch in any_patch()) {
        let least = with_net(&patch, |_, is_flat, _| threshold(is_flat));
        let (square, over) = displacement(patch.0, &bits(&patch.1), patch.2.is_some());
        let passes = |bits: i128| square <= (over * bits) * (over * bits);
        let Some(least) = least else {
            prop_assert!(!passes(i32::MAX.into()));
            return Ok(());
        };
        prop_assert!(passes(least.into()) && (least == 1 || !passes(i128::from(least) - 1)), "{least}");
        let smooth = Smooth::new(patch.0, &patch.1, patch.2.as_deref());
        let (places, limit) = (smooth.places(), f64::from(least) / 65536.0);
        for at in samples(patch.0, 16) {
            let shares = smooth.shares(at);
            // The place to compare with; for polynomials, the same parameters.
            let place: [f64; 2] =
                std::array::from_fn(|d| shares.iter().zip(&places).map(|(f, p)| f * p[d]).sum());
            prop_assert!(patch.2.is_some() || distance([place[0], place[1], 0.0], [at[0], at[1], 0.0]) < SLACK
                || matches!(patch.0, Shape::Curve(_)));
            let point = smooth.eval(at);
            for flat in smooth.flat(place) {
                prop_assert!(distance(point, flat) <= limit * (1.0 + SLACK) + SLACK);
            }
        }
    }

    /// Depths from the net alone are deep enough, in both directions together and apart.
    #[test]
    fn the_depth_suffices(patch in any_patch(), share in 1_i32..60) {
        let smooth = Smooth::new(patch.0, &patch.1, patch.2.as_deref());
        // A tolerance for which the depth is small enough to measure.
        let bound = with_net(&patch, |flatness, _, _| flatness.to_bits() >> 16);
        let eps = (bound / i64::from(share)).clamp(1, i32::MAX.into()) as i32;
        match with_net(&patch, |_, _, depths| depths(tolerance(eps))) {
            Ok([r, s]) if r + s <= 8 => {
                let (measured, eps) = (smooth.deviation([r, s], 3), f64::from(eps) / 65536.0);
                prop_assert!(measured <= eps * (1.0 + SLACK) + SLACK, "{measured} > {eps} at {r}, {s}");
            }
            Ok(_) => {}
            Err(error) => {
                let SubdivideError::TooDeep { needed, limit } = error else { panic!("{error}") };
                prop_assert!(needed > limit);
            }
        }
    }

    /// Of all pairs of depths that satisfy the bound, the documented one.
    #[test]
    fn the_depths_are_the_least_pair(((m, h), points) in tensor(), bits in (0..26).prop_flat_map(|s| 1_i32..=1 << s)) {
        let ours = SurfaceNet::Tensor(TensorNet::new((m, h), &points).unwrap()).depths_for(tolerance(bits));
        let (_, second) = tensor_differences((m, h), &self::bits(&points));
        let factors = [m * (m - 1), m * h, h * (h - 1)].map(|f| f as u128);
        let root = |square: u128| square.isqrt() + u128::from(square.isqrt().pow(2) < square);
        let [rr, rs, ss]: [u128; 3] = std::array::from_fn(|d| root(factors[d].pow(2) * second[d].unsigned_abs()));
        let fits = |[r, s]: [u32; 2]| {
            (rr << (2 * s)) + (rs << (r + s + 1)) + (ss << (2 * r)) <= (bits as u128) << (2 * (r + s) + 3)
        };
        let all = (0..=16).flat_map(|r| (0..=16).map(move |s| [r, s]));
        let least = all.filter(|pair| fits(*pair)).min_by_key(|[r, s]| (r + s, r.abs_diff(*s), *r));
        let uniform = (0..=20).find(|m| fits([*m, *m])).unwrap();
        if uniform > 16 {
            prop_assert_eq!(ours, Err(SubdivideError::TooDeep { needed: uniform, limit: 16 }));
        } else {
            prop_assert_eq!(ours.ok(), least);
        }
    }

    /// With equal weights the bound of a rational triangle is the one of right triangles, least over its corners.
    #[test]
    fn equal_weights_give_the_bound_of_right_triangles((n, points) in triangle(), weight in 1_i32..) {
        let (net, weights) = (bits(&points), vec![I16F16::from_bits(weight); points.len()]);
        let up = |at: (usize, usize, usize), corner: usize| match corner {
            0 => (at.0 + 1, at.1, at.2),
            1 => (at.0, at.1 + 1, at.2),
            _ => (at.0, at.1, at.2 + 1),
        };
        // The largest component of each axis, as one vector.
        let length = |(from, to): (usize, usize), (from2, to2): (usize, usize)| {
            let mut largest = [0.0_f64; 3];
            for at in n.checked_sub(2).into_iter().flat_map(triangle_indices) {
                let index = |p, q| triangle_index(n, up(up(at, p), q));
                let terms = [(1, index(to, to2)), (-1, index(to, from2)), (-1, index(from, to2)), (1, index(from, from2))];
                let v = sum(&net, &terms);
                (0..3).for_each(|a| largest[a] = largest[a].max(v[a].abs() as f64));
            }
            largest.iter().map(|c| c * c).sum::<f64>().sqrt()
        };
        let at = |c: usize, a: usize, b: usize| {
            let (one, two) = ((c, a), (c, b));
            length(one, one) + 2.0 * length(one, two) + length(two, two)
        };
        let bound = at(0, 1, 2).min(at(1, 2, 0)).min(at(2, 0, 1)) * (n * (n - 1)) as f64 / 8.0 / 65536.0;
        let surface = TriangleNet::new(n, &points).unwrap();
        let surface = SurfaceNet::RationalTriangle(RationalTriangleNet::new(surface, &weights).unwrap());
        let span = surface.bounds();
        let extents = [(span.min.x, span.max.x), (span.min.y, span.max.y), (span.min.z, span.max.z)];
        let squares = extents.map(|(low, high)| (f64::from(high.to_bits()) - f64::from(low.to_bits())).powi(2));
        let bound = bound.min(squares.iter().sum::<f64>().sqrt() / 65536.0);
        let ours = to_f64(surface.flatness());
        prop_assert!((ours - bound).abs() <= bound * SLACK + 4.0 / 65536.0, "{ours} {bound}");
    }

    /// The closed form of q, by a fine grid; bounds of heights that bend one way are attained.
    #[test]
    fn the_closed_form_is_the_largest_mean(a in 0_i32..4000, b in 0_i32..4000, c in 0_i32..4000) {
        let height = |twice: i32| Point3::from_bits(0, 0, -twice << 11);
        let flat = Point3::from_bits(0, 0, 0);
        // Second differences a, b, c along T1T2, T2T3, T3T1, in 2^-4.
        let net = [flat, height(a), height(c), flat, height(b), flat];
        let ours = to_f64(SurfaceNet::Triangle(TriangleNet::new(2, &net).unwrap()).flatness()) * 16.0;
        let [fa, fb, fc] = [a, b, c].map(f64::from);
        let mean = |[u, v]: [f64; 2]| u * v * fa + v * (1.0 - u - v) * fb + (1.0 - u - v) * u * fc;
        let largest = samples(Shape::Triangle(2), 120).map(mean).fold(0.0, f64::max);
        prop_assert!(ours >= largest && ours <= largest * 1.0005 + 0.001, "{ours} {largest}");
    }
}

/// Lemma 1 is attained by affine nets, its twin by nets of degree 2: no smaller factor would do.
#[test]
fn affine_and_quadratic_nets_attain_the_factors() {
    let affine: Vec<_> =
        triangle_indices(3).map(|(i, j, _)| Point3::from_ints(7 * i as i16, 9 * j as i16, 1)).collect();
    let quadratic: Vec<_> = (0..6).map(|i: i16| Point3::from_ints(i * i, 40 - 3 * i, 5 * i % 4)).collect();
    for quarter in Quarter::ALL {
        let part = |n: usize, net: &[Point3]| cut(&bits(net), |axis| quarter_triangle(axis, n, quarter));
        let [whole, child] = [bits(&affine), part(3, &affine)].map(|net| triangle_differences(3, &net)[0]);
        assert_eq!(child.map(|d| 4 * d), whole.map(|d| d << 6));
        let [whole, child] = [bits(&quadratic), part(2, &quadratic)].map(|net| triangle_differences(2, &net)[1]);
        assert_eq!(child.map(|d| 16 * d), whole.map(|d| d << 4));
    }
}
