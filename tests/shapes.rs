//! Ways into nets: Hermite and Coons nets are the exact ones rounded once, solids are what they are called.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod common;
#[path = "common/interpolate.rs"]
mod interpolate;

use common::draw::*;
use common::{ratio, round_half_up};
use embedded_surfaces::const_net;
use embedded_surfaces::geometry::{Affine, Axis, Point3, Vector3};
use embedded_surfaces::num::{Angle, I16F16, I32F32};
use embedded_surfaces::patch::{
    BicubicPatch, CoonsBoundary, CubicCurve, Curve, Dimension, HermiteCorner, NetError, Parameter, RationalTensor,
    cone, cylinder, sphere, torus,
};
use interpolate::{bernsteins, dot, parameters, to_bezier};
use num_bigint::BigInt;
use num_rational::BigRational;
use proptest::prelude::*;

const LIMIT: i64 = 32767 << 16;

fn ints<const N: usize>(points: [[i16; 3]; N]) -> [Point3; N] {
    points.map(|[x, y, z]| Point3::from_ints(x, y, z))
}

/// A coordinate in raw bits.
fn along(p: &Point3, axis: usize) -> BigRational {
    ratio(p.to_array()[axis].to_bits().into(), 1)
}

/// A component in 2^-16.
fn component(v: &Vector3, axis: usize) -> BigRational {
    ratio(v.to_array()[axis].to_bits(), 1 << 16)
}

fn power(t: &BigRational, n: usize) -> BigRational {
    (0..n).fold(ratio(1, 1), |p, _| p * t)
}

/// c0 + c1 t + c2 t² + c3 t³
fn cubic(c: [i64; 4], t: &BigRational) -> BigRational {
    c.into_iter().enumerate().fold(ratio(0, 1), |sum, (n, c)| sum + power(t, n) * BigInt::from(c))
}

/// The net is the exact one rounded once, or its first point out of range is named.
fn assert_net(ours: Result<Vec<Point3>, NetError>, exact: [Vec<BigRational>; 3]) {
    let rounded = exact.map(|values| values.iter().map(round_half_up).collect::<Vec<_>>());
    let illegal = (0..rounded[0].len())
        .flat_map(|index| (0..3).map(move |axis| (index, axis)))
        .find(|(index, axis)| rounded[*axis][*index].magnitude() > BigInt::from(LIMIT).magnitude());
    match (ours, illegal) {
        (Ok(points), None) => {
            for (axis, rounded) in rounded.iter().enumerate() {
                assert!(points.iter().map(|p| BigInt::from(p.to_array()[axis].to_bits())).eq(rounded.iter().cloned()));
            }
        }
        (Err(error), Some((index, axis))) => {
            let units = i64::try_from(&rounded[axis][index]).unwrap() >> 16;
            assert_eq!(error, NetError::OutOfRange { index, axis: Axis::ALL[axis], units, limit: 32767 });
        }
        (ours, illegal) => panic!("{ours:?}, but {illegal:?} is out of range"),
    }
}

// Hermite.

/// The cubic Hermite functions of the ends' values and derivatives.
fn hermite(t: &BigRational) -> [[BigRational; 2]; 2] {
    let [p0, d0, p1, d1] = [[1, 0, -3, 2], [0, 1, -2, 1], [0, 0, 3, -2], [0, 0, -1, 1]].map(|c| cubic(c, t));
    [[p0, d0], [p1, d1]]
}

/// Vectors from nothing over a few units to the ends of the type.
fn vector() -> impl Strategy<Value = Vector3> {
    let bits = prop_oneof![Just(0_i64), -600_i64 << 32..600 << 32, (-300_i64..300).prop_map(|v| v << 32)];
    let wild = prop_oneof![9 => bits, 1 => prop_oneof![Just(i64::MIN), Just(i64::MAX), any::<i64>()]];
    prop::array::uniform3(wild.prop_map(I32F32::from_bits)).prop_map(Vector3::from_array)
}

fn corner() -> impl Strategy<Value = HermiteCorner> {
    (net::<I16F16>(1), vector(), vector(), vector()).prop_map(|(p, r, s, twist)| HermiteCorner::new(p[0], r, s, twist))
}

proptest! {
    #![proptest_config(cases(200))]

    #[test]
    fn hermite_curves_are_the_interpolants_rounded_once(points in net::<I16F16>(2), d in [vector(), vector()]) {
        let matrix = to_bezier(3);
        let exact = [0, 1, 2].map(|axis| {
            let value = |t: &BigRational| {
                let ends = hermite(t).into_iter().zip(points.iter().zip(&d));
                ends.fold(ratio(0, 1), |sum, ([by_p, by_d], (p, d))| {
                    sum + by_p * along(p, axis) + by_d * component(d, axis)
                })
            };
            interpolate::curve(&matrix, &parameters(3).iter().map(value).collect::<Vec<_>>())
        });
        let ours = CubicCurve::from_hermite([points[0], points[1]], d);
        assert_net(ours.map(|curve| curve.points().to_vec()), exact);
    }

    #[test]
    fn hermite_patches_are_the_interpolants_rounded_once(c in [[corner(), corner()], [corner(), corner()]]) {
        let matrix = to_bezier(3);
        let ours = BicubicPatch::from_hermite(&c);
        let exact = [0, 1, 2].map(|axis| {
            let value = |r: &BigRational, s: &BigRational| {
                let mut sum = ratio(0, 1);
                for (row, [value_r, slope_r]) in c.iter().zip(hermite(r)) {
                    for (corner, [value_s, slope_s]) in row.iter().zip(hermite(s)) {
                        sum += &value_r * &value_s * along(&corner.point, axis);
                        sum += &value_r * &slope_s * component(&corner.by_s, axis);
                        sum += &slope_r * value_s * component(&corner.by_r, axis);
                        sum += &slope_r * slope_s * component(&corner.twist, axis);
                    }
                }
                sum
            };
            let values: Vec<Vec<_>> =
                parameters(3).iter().map(|r| parameters(3).iter().map(|s| value(r, s)).collect()).collect();
            interpolate::surface([&matrix, &matrix], &values)
        });
        assert_net(ours.map(|patch| patch.points().as_flattened().to_vec()), exact);
        // Each border is the Hermite curve of what belongs to it.
        if let Ok(patch) = ours {
            let b = patch.points();
            for a in [0, 1] {
                let along_s = CubicCurve::from_hermite(c[a].map(|c| c.point), c[a].map(|c| c.by_s)).unwrap();
                prop_assert_eq!(&b[3 * a], along_s.points());
                let ends = [c[0][a], c[1][a]];
                let along_r = CubicCurve::from_hermite(ends.map(|c| c.point), ends.map(|c| c.by_r)).unwrap();
                prop_assert_eq!(&b.map(|row| row[3 * a]), along_r.points());
            }
        }
    }
}

#[test]
fn thirds_and_ninths_round_to_the_nearest_bit() {
    let v = |bits: [i64; 3]| Vector3::from_array(bits.map(|b| I32F32::from_bits(b << 16)));
    let ends = [Point3::ORIGIN, Point3::ORIGIN];
    let curve = CubicCurve::from_hermite(ends, [v([1, 2, -1]), v([1, 2, -2])]).unwrap();
    assert_eq!(curve.points()[1..3], [Point3::from_bits(0, 1, 0), Point3::from_bits(0, -1, 1)]);
    // Halves of a bit come from the finer type only: 3/2 · 2^-16 is 3/2 · 2^-16 / 3 = half a bit.
    let half = Vector3::from_array([3, -3, 0].map(|b| I32F32::from_bits(b << 15)));
    let curve = CubicCurve::from_hermite(ends, [half, half]).unwrap();
    assert_eq!(curve.points()[1..3], [Point3::from_bits(1, 0, 0), Point3::from_bits(0, 1, 0)]);
}

#[test]
fn the_net_gives_the_derivatives_back() {
    let v = |x: i16, y: i16, z: i16| Vector3::from_array([x, y, z].map(I32F32::from_num));
    let c =
        |x, y, z, n: i16| HermiteCorner::new(Point3::from_ints(x, y, z), v(30 + n, n, 3), v(-n, 60, n), v(9, -18, 27));
    const FLAT: HermiteCorner = HermiteCorner::new(
        Point3::ORIGIN,
        Vector3::new(I32F32::ZERO, I32F32::ZERO, I32F32::ZERO),
        Vector3::new(I32F32::ZERO, I32F32::ZERO, I32F32::ZERO),
        Vector3::new(I32F32::ZERO, I32F32::ZERO, I32F32::ZERO),
    );
    static POINT: BicubicPatch = const_net!(BicubicPatch::from_hermite(&[[FLAT; 2]; 2]));
    assert_eq!(POINT.points(), &[[Point3::ORIGIN; 4]; 4]);
    let corners = [[c(0, 0, 0, 3), c(0, 90, 5, 6)], [c(90, 0, -5, 9), c(90, 90, 0, 12)]];
    let patch = BicubicPatch::from_hermite(&corners).unwrap();
    let ends = [Parameter::ZERO, Parameter::ONE];
    for (a, b) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
        assert_eq!(patch.net().partials(ends[a], ends[b]), [corners[a][b].by_r, corners[a][b].by_s]);
        // The twist is nine times the cross difference of the corner's four points.
        let near = |end: usize| if end == 0 { [0, 1] } else { [2, 3] };
        let ([i0, i1], [j0, j1]) = (near(a), near(b));
        let x = |i: usize, j: usize| patch.points()[i][j].to_array().map(I32F32::from);
        let twist = [0, 1, 2].map(|axis| 9 * (x(i1, j1)[axis] - x(i1, j0)[axis] - x(i0, j1)[axis] + x(i0, j0)[axis]));
        assert_eq!(Vector3::from_array(twist), corners[a][b].twist);
    }
}

// Coons.

/// The curve's exact value along one axis.
fn value(points: &[Point3], t: &BigRational, axis: usize) -> BigRational {
    dot(&bernsteins(3, t), points.iter().map(|p| along(p, axis)))
}

/// The blending formula itself.
fn blended(
    [along_r, along_s]: [&[CubicCurve; 2]; 2],
    f: [i64; 4],
    (r, s): (&BigRational, &BigRational),
    axis: usize,
) -> BigRational {
    let weights = |t: &BigRational| [ratio(1, 1) - cubic(f, t), cubic(f, t)];
    let (of_r, of_s) = (weights(r), weights(s));
    let mut sum = ratio(0, 1);
    for side in 0..2 {
        sum += &of_s[side] * value(along_r[side].points(), r, axis);
        sum += &of_r[side] * value(along_s[side].points(), s, axis);
        for (end, of_r) in of_r.iter().enumerate() {
            sum -= of_r * &of_s[side] * along(&along_r[side].points()[3 * end], axis);
        }
    }
    sum
}

/// Four borders that meet.
fn borders(points: &[Point3]) -> [[CubicCurve; 2]; 2] {
    let curve = |a: usize, from: usize, b: usize| {
        CubicCurve::new([points[a], points[from], points[from + 1], points[b]]).unwrap()
    };
    [[curve(0, 4, 2), curve(1, 6, 3)], [curve(0, 8, 1), curve(2, 10, 3)]]
}

fn fraction() -> impl Strategy<Value = BigRational> {
    parameter().prop_map(|t| ratio(t.numerator().into(), t.denominator().into()))
}

const LINEAR: [i64; 4] = [0, 1, 0, 0];
const SMOOTH: [i64; 4] = [0, 0, 3, -2];

proptest! {
    #![proptest_config(cases(100))]

    #[test]
    fn coons_patches_are_the_blending_formula(points in net::<I16F16>(12), r in fraction(), s in fraction()) {
        let [along_r, along_s] = borders(&points);
        let boundary = CoonsBoundary::new(along_r, along_s).unwrap();
        let matrix = to_bezier(3);
        // Rounding moves the surface by half a bit at most; the bicubic one is exact.
        let both = [(boundary.bilinear(), LINEAR, ratio(1, 2)), (boundary.bicubic(), SMOOTH, ratio(0, 1))];
        for (ours, f, bound) in both {
            let exact = [0, 1, 2].map(|axis| {
                let value = |r: &_, s: &_| blended([&along_r, &along_s], f, (r, s), axis);
                let values: Vec<Vec<_>> =
                    parameters(3).iter().map(|r| parameters(3).iter().map(|s| value(r, s)).collect()).collect();
                interpolate::surface([&matrix, &matrix], &values)
            });
            assert_net(ours.map(|patch| patch.points().as_flattened().to_vec()), exact);
            let Ok(patch) = ours else { continue };
            let b = patch.points();
            for side in [0, 1] {
                prop_assert_eq!(&b[3 * side], along_s[side].points());
                prop_assert_eq!(&b.map(|row| row[3 * side]), along_r[side].points());
            }
            for axis in 0..3 {
                let net = common::tensor((3, 3), |i, j| along(&b[i][j], axis), &r, &s);
                let error = net - blended([&along_r, &along_s], f, (&r, &s), axis);
                prop_assert!(error <= bound && -error <= bound);
            }
        }
    }
}

#[test]
fn corners_must_agree_in_every_bit() {
    let points = ints([
        [0, 0, 0],
        [0, 30, 0],
        [30, 0, 0],
        [30, 30, 9],
        [10, 0, 4],
        [20, 0, 4],
        [10, 30, 0],
        [20, 30, 0],
        [0, 10, 0],
        [0, 20, 0],
        [30, 10, 0],
        [30, 20, 0],
    ]);
    let [along_r, along_s] = borders(&points);
    for (r, s) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
        for axis in 0..3 {
            let mut torn = *along_s[r].points();
            let mut end = torn[3 * s].to_array();
            end[axis] += I16F16::from_bits(1);
            torn[3 * s] = Point3::from_array(end);
            let mut along_s = along_s;
            along_s[r] = CubicCurve::new(torn).unwrap();
            let error = CoonsBoundary::new(along_r, along_s).unwrap_err();
            let (of_r, of_s) = (along_r[s].points()[3 * r], torn[3 * s]);
            assert_eq!(error, NetError::Corner { r: r as u8, s: s as u8, along_r: of_r, along_s: of_s });
        }
    }
    let [one, other] = [[1, 2, -3], [1, 2, 3]].map(|[x, y, z]| Point3::from_bits(x, y, z));
    let text = NetError::Corner { r: 0, s: 1, along_r: one, along_s: other }.to_string();
    let expected = "at the corner (0, 1) the border along r ends at (1, 2, -3) / 65536, \
                    the one along s at (1, 2, 3) / 65536";
    assert_eq!(text, expected);
}

#[test]
fn a_boundary_is_constant_and_straight_borders_give_the_bilinear_patch() {
    const fn line(from: [i16; 3], to: [i16; 3]) -> Result<CubicCurve, NetError> {
        let mut points = [from, from, to, to];
        let mut c = 0;
        while c < 3 {
            let third = (to[c] - from[c]) / 3;
            points[1][c] += third;
            points[2][c] -= third;
            c += 1;
        }
        Curve::<4>::from_ints(points)
    }
    const ALONG_R: [CubicCurve; 2] =
        [const_net!(line([0, 0, 0], [90, 0, 0])), const_net!(line([0, 90, 0], [90, 90, 90]))];
    const ALONG_S: [CubicCurve; 2] =
        [const_net!(line([0, 0, 0], [0, 90, 0])), const_net!(line([90, 0, 0], [90, 90, 90]))];
    const BOUNDARY: CoonsBoundary = const_net!(CoonsBoundary::new(ALONG_R, ALONG_S));
    static SADDLE: BicubicPatch = const_net!(BOUNDARY.bilinear());
    let heights = SADDLE.points().map(|row| row.map(|p| p.z.to_num::<i32>()));
    assert_eq!(heights, [[0; 4], [0, 10, 20, 30], [0, 20, 40, 60], [0, 30, 60, 90]]);
    // The step keeps the corners' tangent planes level instead.
    let heights = BOUNDARY.bicubic().unwrap().points().map(|row| row.map(|p| p.z.to_num::<i32>()));
    assert_eq!(heights, [[0; 4], [0, 0, 30, 30], [0, 30, 30, 60], [0, 30, 60, 90]]);
}

// Solids.

type Patch = RationalTensor<3, 3>;

/// The exact point at (r, s) from the centre, in raw bits.
fn offset(patch: &Patch, centre: &Point3, r: &BigRational, s: &BigRational) -> [BigRational; 3] {
    let (points, weights) = (patch.net().points(), patch.weights().as_flattened());
    let sum = |axis| {
        common::tensor(
            (2, 2),
            |i, j| interpolate::homogeneous(&points[3 * i + j], Some(weights[3 * i + j]), axis),
            r,
            s,
        )
    };
    [0, 1, 2].map(|axis| sum(axis) / sum(3) - along(centre, axis))
}

fn square(x: &BigRational) -> BigRational {
    x * x
}

/// A grid that holds the borders and the corners.
fn samples() -> impl Iterator<Item = (BigRational, BigRational)> {
    (0..=3).flat_map(|p| (0..=3).map(move |q| (ratio(p, 3), ratio(q, 3))))
}

/// Borders, as points with weights.
fn borders_of(patch: &Patch) -> [Vec<(Point3, I16F16)>; 4] {
    let at = |i: usize, j: usize| (patch.net().points()[3 * i + j], patch.weights()[i][j]);
    let side = |of: &dyn Fn(usize) -> (usize, usize)| (0..3).map(of).map(|(i, j)| at(i, j)).collect();
    [side(&|k| (0, k)), side(&|k| (2, k)), side(&|k| (k, 0)), side(&|k| (k, 2))]
}

/// Every border is another patch's, bit by bit and the same way round, or has shrunk to a point, or is one of `open`.
fn assert_closed(patches: &[Patch], open: usize) {
    let all: Vec<_> = patches.iter().flat_map(borders_of).collect();
    let lone = |border: &&Vec<(Point3, I16F16)>| {
        let shrunk = border.iter().all(|(p, _)| *p == border[0].0);
        !shrunk && all.iter().filter(|other| other == border).count() != 2
    };
    assert_eq!(all.iter().filter(lone).count(), open);
}

/// S_r × S_s, dotted with `outwards` of the point, is positive in the middle of each patch.
fn assert_outwards(patches: &[Patch], outwards: impl Fn([i64; 3]) -> [i64; 3]) {
    for patch in patches {
        let at = patch.net().eval(Parameter::HALF, Parameter::HALF).to_array().map(|c| i64::from(c.to_bits()) >> 16);
        let [r, s] = patch.net().partials(Parameter::HALF, Parameter::HALF).unwrap();
        let ([a, b, c], [d, e, f]) = (r.to_array().map(|c| c.to_bits() >> 32), s.to_array().map(|c| c.to_bits() >> 32));
        let normal = [b * f - c * e, c * d - a * f, a * e - b * d];
        assert!(normal.iter().zip(outwards(at)).map(|(n, o)| n * o).sum::<i64>() > 0, "{at:?}");
    }
}

fn length() -> impl Strategy<Value = I16F16> {
    prop_oneof![(1_i32..300).prop_map(|l| l << 16), 1..100_i32 << 16, Just(1), Just(10_000 << 16)]
        .prop_map(I16F16::from_bits)
}

fn centre() -> impl Strategy<Value = Point3> {
    let bits = prop_oneof![-300 << 16..300 << 16, (-300..300).prop_map(|c: i32| c << 16), Just(12_000 << 16)];
    [bits.clone(), bits.clone(), bits].prop_map(|[x, y, z]| Point3::from_bits(x, y, z))
}

proptest! {
    #![proptest_config(cases(10))]

    #[test]
    fn every_point_of_a_solid_lies_on_it(centre in centre(), a in length(), b in length()) {
        let (radius, other) = (ratio(a.to_bits().into(), 1), ratio(b.to_bits().into(), 1));
        let ball = sphere(centre, a).unwrap();
        let tin = cylinder(centre, a, b).unwrap();
        let even = |l: I16F16| I16F16::from_bits(l.to_bits() & !1 | 2);
        let hat = cone(centre, even(a), even(b)).unwrap();
        let (base, height) = (ratio(even(a).to_bits().into(), 1), ratio(even(b).to_bits().into(), 1));
        let ring = torus(centre, a, b).unwrap();
        for (r, s) in samples() {
            for patch in &ball {
                let [x, y, z] = offset(patch, &centre, &r, &s);
                prop_assert_eq!(square(&x) + square(&y) + square(&z), square(&radius));
            }
            for patch in &tin {
                let [x, y, z] = offset(patch, &centre, &r, &s);
                prop_assert_eq!(square(&x) + square(&y), square(&radius));
                prop_assert!(z >= ratio(0, 1) && z <= other);
            }
            for patch in &hat {
                let [x, y, z] = offset(patch, &centre, &r, &s);
                prop_assert_eq!((square(&x) + square(&y)) * square(&height), square(&(&base * (&height - &z))));
                prop_assert!(z >= ratio(0, 1) && z <= height);
            }
            for patch in &ring {
                let [x, y, z] = offset(patch, &centre, &r, &s);
                let from_axis = square(&x) + square(&y);
                let quartic = square(&(&from_axis + square(&z) + square(&radius) - square(&other)));
                prop_assert_eq!(quartic, square(&radius) * from_axis * BigInt::from(4));
            }
        }
        assert_closed(&ball, 0);
        assert_closed(&tin, 8);
        assert_closed(&hat, 4);
        assert_closed(&ring, 0);
    }

    #[test]
    fn a_turned_sphere_is_off_by_the_rounding_of_its_points(tilt: u32, spin: u32, radius in 1_i16..2000) {
        let [spin, tilt] = [spin, tilt].map(Angle::from_binary);
        let turn = Affine::rotation_z(spin).then(&Affine::rotation_x(tilt)).unwrap();
        let exact = i64::from(radius) << 16;
        for patch in sphere(Point3::ORIGIN, I16F16::from_num(radius)).unwrap() {
            let patch = patch.transform(&turn).unwrap();
            for (r, s) in samples() {
                let square: BigRational = offset(&patch, &Point3::ORIGIN, &r, &s).iter().map(square).sum();
                // Half a bit along each axis is 0.87; the matrix adds less than a bit at this size.
                let within = |bits: i64| ratio(bits * bits, 1);
                prop_assert!(square >= within(exact - 2) && square <= within(exact + 2));
            }
        }
    }
}

#[test]
fn parts_stand_in_their_order_and_face_outwards() {
    let length = I16F16::from_num::<i32>;
    let corner = |patch: &Patch| patch.net().points()[0].to_array().map(|c| c.to_num::<i32>());
    let ball = sphere(Point3::ORIGIN, length(50)).unwrap();
    assert_eq!(ball.each_ref().map(corner)[3..6], [[0, 0, -50], [50, 0, 0], [0, 50, 0]]);
    assert_outwards(&ball, |at| at);
    let tin = cylinder(Point3::ORIGIN, length(50), length(20)).unwrap();
    assert_eq!(tin.each_ref().map(corner), [[50, 0, 0], [0, 50, 0], [-50, 0, 0], [0, -50, 0]]);
    assert_outwards(&tin, |[x, y, _]| [x, y, 0]);
    assert_outwards(&cone(Point3::ORIGIN, length(50), length(20)).unwrap(), |[x, y, _]| [x, y, 1]);
    let ring = torus(Point3::ORIGIN, length(50), length(20)).unwrap();
    assert_eq!(ring.each_ref().map(corner)[8..10], [[30, 0, 0], [0, 30, 0]]);
    assert_outwards(&ring, |[x, y, z]| {
        // From the nearest point of the middle circle, 50/|(x, y)| of (x, y) at height 0, times |(x, y)|.
        let from_axis = (x * x + y * y).isqrt();
        [x * (from_axis - 50), y * (from_axis - 50), z * from_axis]
    });
}

#[test]
fn odd_halves_of_a_cone_are_rounded() {
    let bits = I16F16::from_bits;
    let [east, ..] = cone(Point3::ORIGIN, bits(5), bits(7)).unwrap();
    assert_eq!(east.net().points()[1], Point3::from_bits(3, 0, 4));
    // Within half a bit along each axis: 0.71 from the cone's ruling at worst.
    let [middle, _] = [ratio(1, 2), ratio(0, 1)];
    let [x, _, z] = offset(&east, &Point3::ORIGIN, &ratio(0, 1), &middle);
    assert_eq!((x, z), (ratio(5 + 2 * 3, 4), ratio(7 + 2 * 4, 4)));
}

#[test]
fn what_is_wrong_with_a_solid_is_named() {
    let (one, zero, below) = (I16F16::ONE, I16F16::ZERO, I16F16::from_bits(-3));
    let wrong = |dimension, bits| Some(NetError::NotPositive { dimension, bits });
    assert_eq!(sphere(Point3::ORIGIN, zero).err(), wrong(Dimension::Radius, 0));
    assert_eq!(cylinder(Point3::ORIGIN, below, one).err(), wrong(Dimension::Radius, -3));
    assert_eq!(cylinder(Point3::ORIGIN, one, below).err(), wrong(Dimension::Height, -3));
    assert_eq!(cone(Point3::ORIGIN, zero, zero).err(), wrong(Dimension::Radius, 0));
    assert_eq!(cone(Point3::ORIGIN, one, I16F16::MIN).err(), wrong(Dimension::Height, i32::MIN));
    assert_eq!(torus(Point3::ORIGIN, zero, one).err(), wrong(Dimension::Radius, 0));
    assert_eq!(torus(Point3::ORIGIN, one, zero).err(), wrong(Dimension::TubeRadius, 0));
    let texts = [Dimension::Radius, Dimension::TubeRadius, Dimension::Height]
        .map(|dimension| NetError::NotPositive { dimension, bits: -3 }.to_string());
    let expected = ["radius", "tube radius", "height"].map(|name| format!("the {name} is not positive: -3 / 65536"));
    assert_eq!(texts, expected);

    let range = |index, axis, units| Some(NetError::OutOfRange { index, axis, units, limit: 32767 });
    assert!(sphere(Point3::ORIGIN, I16F16::from_num(32767)).is_ok());
    assert_eq!(sphere(Point3::ORIGIN, I16F16::MAX).err(), range(0, Axis::Z, -32768));
    assert_eq!(sphere(Point3::from_ints(1, 0, 0), I16F16::from_num(32767)).err(), range(1, Axis::X, 32768));
    assert_eq!(cylinder(Point3::from_ints(0, -32767, 0), one, one).err(), range(3, Axis::Y, -32768));
    assert_eq!(cone(Point3::from_ints(0, 0, 32767), one, one).err(), range(1, Axis::Z, 32767));
    assert_eq!(torus(Point3::ORIGIN, I16F16::from_num(32767), one).err(), range(0, Axis::X, 32768));
}
