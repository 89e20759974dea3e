//! Constructors of nets, parameters and weights: the legal range at both ends, every error with the value it names,
//! constants, boxes.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod common;

use common::basis::triangle_indices;
use common::draw::*;
use embedded_surfaces::const_net;
use embedded_surfaces::geometry::{Axis, Bounds, Point3};
use embedded_surfaces::num::{Coord, I16F16, I32F32};
use embedded_surfaces::patch::{
    Barycentric, BicubicPatch, BilinearPatch, CubicCurve, CubicTriangle, Curve, CurveNet, FlatTriangle, NetError,
    Parameter, QuadraticCurve, RationalCurve, RationalTensor, RationalTriangle, Surface, SurfaceNet, Tensor, TensorNet,
    Triangle, TriangleNet,
};
use proptest::prelude::*;

const ARC: CubicCurve = const_net!(CubicCurve::from_ints([[0, 0, 0], [0, 55, 0], [45, 100, 0], [100, 100, 0]]));
const SQUARE: BilinearPatch = const_net!(BilinearPatch::from_ints([[[0, 0, 0], [0, 9, 0]], [[9, 0, 0], [9, 9, 0]]]));
static SEED: CubicTriangle = const_net!(CubicTriangle::from_ints(common::SEED_P));
const LIMITS: Curve<2, I32F32> = const_net!(Curve::<2, I32F32>::new([
    Point3::new(I32F32::from_bits(1 << 58), I32F32::ZERO, I32F32::ZERO),
    Point3::new(I32F32::from_bits(-(1 << 58)), I32F32::ZERO, I32F32::ZERO),
]));
const QUARTER: RationalCurve<3> = const_net!(RationalCurve::new(
    const_net!(QuadraticCurve::from_ints([[100, 0, 0], [100, 100, 0], [0, 100, 0]])),
    [I16F16::ONE, I16F16::ONE, I16F16::from_bits(2 << 16)]
));

#[test]
fn nets_can_be_constants() {
    assert_eq!(ARC.points()[2], Point3::from_ints(45, 100, 0));
    assert_eq!(SQUARE.points()[1][0], Point3::from_ints(9, 0, 0));
    assert_eq!(SEED.net().degree(), 3);
    assert_eq!(LIMITS.points()[0].x, 1 << 26);
    assert_eq!(QUARTER.net().eval(Parameter::HALF), Point3::from_ints(60, 80, 0));
}

/// Every way to make a net out of this many equal points but one.
fn results<C: Coord>(odd: Point3<C>, index: usize) -> Vec<Result<(), NetError>> {
    let mut points = [Point3::new(C::ZERO, C::ZERO, C::ZERO); 6];
    points[index] = odd;
    let rows = |points: &[Point3<C>; 6]| [0, 2, 4].map(|i| [points[i], points[i + 1]]);
    vec![
        CurveNet::new(&points).map(|_| ()),
        TriangleNet::new(2, &points).map(|_| ()),
        TensorNet::new((2, 1), &points).map(|_| ()),
        Curve::<6, C>::try_from(points).map(|_| ()),
        Triangle::<2, 6, C>::try_from(points).map(|_| ()),
        Tensor::<3, 2, C>::try_from(rows(&points)).map(|_| ()),
    ]
}

/// One unit of the last place beyond each end, on each axis, is refused by name; the ends are accepted.
fn check_range<C: Coord>(raw: impl Fn(i64) -> C, more: impl Fn([Point3<C>; 6]) -> [Result<(), NetError>; 3]) {
    let limit = C::LIMIT << C::FRACTION_BITS;
    for (axis, index) in Axis::ALL.into_iter().flat_map(|axis| (0..6).map(move |index| (axis, index))) {
        for (bits, units) in
            [(limit, None), (-limit, None), (limit + 1, Some(C::LIMIT)), (-limit - 1, Some(-C::LIMIT - 1))]
        {
            let mut point = [C::ZERO; 3];
            point[axis as usize] = raw(bits);
            let odd = Point3::from_array(point);
            let expected =
                units.map_or(Ok(()), |units| Err(NetError::OutOfRange { index, axis, units, limit: C::LIMIT }));
            let mut all = results(odd, index);
            let mut points = [Point3::new(C::ZERO, C::ZERO, C::ZERO); 6];
            points[index] = odd;
            all.extend(more(points));
            assert!(all.iter().all(|r| *r == expected), "{all:?}");
            assert_eq!(raw(bits).is_legal(), units.is_none());
            assert_eq!(C::from_legal_bits(bits.into()).is_some(), units.is_none());
        }
    }
}

#[test]
fn the_legal_range_is_enforced_at_both_ends_of_both_types() {
    let rows = |i: usize| [i, i + 1];
    check_range(
        |bits| I16F16::from_bits(bits as i32),
        |points| {
            [
                Curve::<6>::new(points).map(|_| ()),
                Triangle::<2, 6>::new(points).map(|_| ()),
                Tensor::<3, 2>::new([0, 2, 4].map(|i| rows(i).map(|i| points[i]))).map(|_| ()),
            ]
        },
    );
    check_range(I32F32::from_bits, |points| {
        [
            Curve::<6, I32F32>::new(points).map(|_| ()),
            Triangle::<2, 6, I32F32>::new(points).map(|_| ()),
            Tensor::<3, 2, I32F32>::new([0, 2, 4].map(|i| rows(i).map(|i| points[i]))).map(|_| ()),
        ]
    });
    assert_eq!(I16F16::from_legal_bits(i128::MIN), None);
    assert_eq!(I32F32::from_legal_bits(1 << 64), None);
    let out = Err(NetError::OutOfRange { index: 1, axis: Axis::Z, units: -32_768, limit: 32_767 });
    assert_eq!(Curve::<2>::from_ints([[0; 3], [0, 0, -32_768]]).map(|_| ()), out);
    assert_eq!(FlatTriangle::from_ints([[0; 3], [0, 0, -32_768], [0; 3]]).map(|_| ()), out);
    assert_eq!(BilinearPatch::from_ints([[[0; 3], [0, 0, -32_768]], [[0; 3]; 2]]).map(|_| ()), out);
}

#[test]
fn degrees_and_counts_are_checked() {
    let points = [Point3::ORIGIN; 100];
    let curve = |count: usize| CurveNet::new(&points[..count]).map(|net| net.degree());
    assert_eq!(curve(0), Err(NetError::Count { expected: 2, given: 0 }));
    assert_eq!(curve(1), Err(NetError::Degree { degree: 0 }));
    assert_eq!(curve(2), Ok(1));
    assert_eq!(curve(9), Ok(8));
    assert_eq!(curve(10), Err(NetError::Degree { degree: 9 }));
    let triangle = |degree, count: usize| TriangleNet::new(degree, &points[..count]).map(|net| net.degree());
    assert_eq!(triangle(0, 1), Err(NetError::Degree { degree: 0 }));
    assert_eq!(triangle(8, 45), Ok(8));
    assert_eq!(triangle(9, 55), Err(NetError::Degree { degree: 9 }));
    assert_eq!(triangle(usize::MAX, 3), Err(NetError::Degree { degree: usize::MAX }));
    assert_eq!(triangle(3, 9), Err(NetError::Count { expected: 10, given: 9 }));
    assert_eq!(triangle(3, 11), Err(NetError::Count { expected: 10, given: 11 }));
    let tensor = |degrees, count: usize| TensorNet::new(degrees, &points[..count]).map(|net| net.degrees());
    assert_eq!(tensor((0, 3), 4), Err(NetError::Degree { degree: 0 }));
    assert_eq!(tensor((3, 9), 40), Err(NetError::Degree { degree: 9 }));
    assert_eq!(tensor((8, 8), 81), Ok((8, 8)));
    assert_eq!(tensor((2, 3), 11), Err(NetError::Count { expected: 12, given: 11 }));
    assert_eq!(tensor((2, 3), 0), Err(NetError::Count { expected: 12, given: 0 }));
}

#[test]
fn parameters_are_fractions_of_one_with_small_denominators() {
    let refused = |numerator, denominator| Err(NetError::Parameter { numerator, denominator });
    assert_eq!(Parameter::new(1, 0), refused(1, 0));
    assert_eq!(Parameter::new(0, 65_537), refused(0, 65_537));
    assert_eq!(Parameter::new(5, 4), refused(5, 4));
    assert_eq!(Parameter::new(u32::MAX, u32::MAX), refused(u32::MAX, u32::MAX));
    let t = Parameter::new(65_536, 65_536).unwrap();
    assert_eq!((t.numerator(), t.denominator()), (65_536, 65_536));
    assert_eq!(Barycentric::new(0, 0, 0), Err(NetError::Parameter { numerator: 0, denominator: 0 }));
    assert_eq!(Barycentric::new(7, 65_536, 0), Err(NetError::Parameter { numerator: 7, denominator: 65_543 }));
    let all = u32::MAX;
    assert_eq!(Barycentric::new(all, all, all), Err(NetError::Parameter { numerator: all, denominator: all }));
    let corner = Barycentric::new(0, 65_536, 0).unwrap();
    assert_eq!((corner.weights(), corner.denominator()), ([0, 65_536, 0], 65_536));
}

#[test]
fn weights_must_be_positive() {
    let weights = |odd: i32| [1 << 16, 1, odd, i32::MAX].map(I16F16::from_bits);
    let square = |w: [I16F16; 4]| [[w[0], w[1]], [w[2], w[3]]];
    for bits in [0, -1, i32::MIN] {
        let refused = NetError::Weight { index: 2, bits };
        assert_eq!(RationalCurve::new(ARC, weights(bits)), Err(refused));
        assert_eq!(RationalTensor::new(SQUARE, square(weights(bits))), Err(refused));
        let mut ten = [I16F16::ONE; 10];
        ten[2] = I16F16::from_bits(bits);
        assert_eq!(RationalTriangle::new(SEED, ten), Err(refused));
    }
    let curve = RationalCurve::new(ARC, weights(5)).unwrap();
    assert_eq!((curve.net().control_net(), curve.weights()), (ARC.net(), &weights(5)));
    let patch = RationalTensor::new(SQUARE, square(weights(5))).unwrap();
    assert_eq!((patch.net().control_net(), patch.weights()), (SQUARE.net(), &square(weights(5))));
    let patch = RationalTriangle::new(SEED, [I16F16::MAX; 10]).unwrap();
    assert_eq!((patch.net().control_net(), patch.weights()), (SEED.net(), &[I16F16::MAX; 10]));
}

/// Text of errors: lower case, no full stop, and the values that were wrong.
#[test]
fn errors_name_the_offending_values() {
    let cases: [(NetError, &[&str]); 6] = [
        (NetError::Degree { degree: 9 }, &["9", "1 ..= 8"]),
        (NetError::Count { expected: 10, given: 11 }, &["10", "11"]),
        (
            NetError::OutOfRange { index: 4, axis: Axis::Y, units: -40_000, limit: 32_767 },
            &["y coordinate", "point 4", "-40000", "32767"],
        ),
        (NetError::Weight { index: 3, bits: -65_535 }, &["weight 3", "-65535"]),
        (NetError::Parameter { numerator: 5, denominator: 4 }, &["5 / 4"]),
        (NetError::Elevation { from: 5, to: 3 }, &["degree 5", "degree 3"]),
    ];
    for (error, expected) in cases {
        let text = error.to_string();
        assert!(expected.iter().all(|part| text.contains(part)), "{text}");
        assert!(text.starts_with(|c: char| c.is_lowercase()) && !text.ends_with('.'), "{text}");
        let _: &dyn core::error::Error = &error;
    }
}

#[test]
fn points_of_triangles_stand_in_the_documented_order() {
    for (at, (i, j, k)) in triangle_indices(3).enumerate() {
        assert_eq!(SEED.point(i, j, k), Some(&SEED.points()[at]));
        let [x, y, z] = common::SEED_P[at];
        assert_eq!(SEED.points()[at], Point3::from_ints(x, y, z));
    }
    assert_eq!((SEED.point(3, 1, 0), SEED.point(0, 0, 0), SEED.point(usize::MAX, 2, 2)), (None, None, None));
}

#[test]
fn views_show_the_net() {
    let patch = BicubicPatch::from_ints([[[1, 2, 3]; 4]; 4]).unwrap();
    let by_reference = &&patch;
    assert_eq!(by_reference.surface(), SurfaceNet::Tensor(patch.net()));
    assert_eq!(patch.surface().surface().degrees(), (3, 3));
    assert_eq!(SEED.surface().degrees(), (3, 3));
    assert_eq!(SEED.surface().points(), SEED.points());
    assert_eq!(patch.surface().points(), patch.points().as_flattened());
    assert_eq!(patch.surface().bounds(), patch.bounds());
    assert_eq!(SEED.surface().bounds(), SEED.bounds());
    let expected = Bounds { min: Point3::from_ints(40, 20, 60), max: Point3::from_ints(300, 220, 400) };
    assert_eq!(SEED.bounds(), expected);
    assert_eq!(Bounds::<I16F16>::of(&[]), None);
}

fn inside<C: Coord>(b: &Bounds<C>, p: Point3<C>) -> bool {
    let (low, high) = (b.min.to_array(), b.max.to_array());
    p.to_array().iter().zip(low.iter().zip(&high)).all(|(c, (low, high))| low <= c && c <= high)
}

fn check_bounds<C: Coord>(points: &[Point3<C>], weights: &[I16F16], (r, s): (Parameter, Parameter), at: Barycentric) {
    let tensor = TensorNet::new((3, 3), &points[..16]).unwrap();
    assert!(inside(&SurfaceNet::Tensor(tensor).bounds(), tensor.eval(r, s)));
    let owned = Tensor::<4, 4, C>::try_from(points.as_chunks::<4>().0.first_chunk().copied().unwrap()).unwrap();
    assert_eq!(owned.bounds(), SurfaceNet::Tensor(tensor).bounds());
    let rational = RationalTensor::new(owned, weights.as_chunks::<4>().0.first_chunk().copied().unwrap()).unwrap();
    assert!(inside(&owned.bounds(), rational.net().eval(r, s)));
    let triangle = TriangleNet::new(5, &points[..21]).unwrap();
    assert!(inside(&SurfaceNet::Triangle(triangle).bounds(), triangle.eval(at)));
    let owned = Triangle::<5, 21, C>::try_from(*points.first_chunk().unwrap()).unwrap();
    let rational = RationalTriangle::new(owned, *weights.first_chunk().unwrap()).unwrap();
    assert!(inside(&owned.bounds(), rational.net().eval(at)));
    let curve = Curve::<9, C>::try_from(*points.first_chunk().unwrap()).unwrap();
    assert!(inside(&curve.bounds(), curve.net().eval(r)));
    assert!(inside(&curve.bounds(), RationalCurve::new(curve, *weights.first_chunk().unwrap()).unwrap().net().eval(s)));
}

proptest! {
    #![proptest_config(cases(300))]

    #[test]
    fn boxes_hold_every_evaluated_point(
        narrow in net::<I16F16>(21), wide in net::<I32F32>(21), weights in weights(21), r in parameter(),
        s in parameter(), at in barycentric(),
    ) {
        check_bounds(&narrow, &weights, (r, s), at);
        check_bounds(&wide, &weights, (r, s), at);
    }
}
