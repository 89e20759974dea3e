//! Maps and views of points: exact rationals for what is exact, `f64` within a stated tolerance for views by angle.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]
#![allow(clippy::disallowed_types, clippy::float_arithmetic, reason = "the oracle of views by angle")]

mod common;

use common::basis::*;
use common::draw::*;
use common::{ratio, round_half_up};
use embedded_surfaces::geometry::{Affine, Axis, Bounds, GeometryError, Perspective, Point3, View};
use embedded_surfaces::num::{Angle, Coord, I16F16, I32F32};
use embedded_surfaces::patch::{
    Barycentric, BicubicPatch, CubicTriangle, Curve, Parameter, QuinticTriangle, RationalCurve, RationalTensor,
    RationalTriangle, Tensor, Triangle,
};
use num_bigint::BigInt;
use num_rational::BigRational;
use num_traits::{Signed, ToPrimitive};
use proptest::prelude::*;

fn fixed(bits: i64) -> I32F32 {
    I32F32::from_bits(bits)
}

fn exact<C: Coord>(c: C) -> BigRational {
    BigRational::new(c.bits().into(), BigInt::from(1) << C::FRACTION_BITS)
}

/// M p + t along one axis.
fn image<C: Coord>(map: &Affine, p: &Point3<C>, axis: usize) -> BigRational {
    let row = map.rows[axis].map(|entry| ratio(entry.to_bits(), 1 << 32));
    row.iter().zip(p.to_array()).fold(row[3].clone(), |sum, (factor, c)| sum + factor * exact(c))
}

/// Matrix entries: of rotations, of scales, and any.
fn entry() -> impl Strategy<Value = I32F32> {
    let one = 1_i64 << 32;
    prop_oneof![3 => -one..=one, 3 => -40 * one..=40 * one, 1 => any::<i64>(), 1 => Just(0)].prop_map(fixed)
}

fn affine() -> impl Strategy<Value = Affine> {
    let row = || [entry(), entry(), entry(), entry()];
    [row(), row(), row()].prop_map(|rows| Affine { rows })
}

fn check_image<C: Coord, D: Coord>(map: &Affine, p: &Point3<C>) {
    let images = [0, 1, 2].map(|axis| image(map, p, axis));
    let bits = [0, 1, 2].map(|axis| rounded_bits(&images[axis], D::FRACTION_BITS));
    let limit = BigInt::from(D::LIMIT) << D::FRACTION_BITS;
    match map.apply_into::<C, D>(p) {
        Ok(ours) => assert_eq!(ours.to_array().map(|c| BigInt::from(c.bits())), bits),
        Err(GeometryError::OutOfRange { axis, units, limit: named }) => {
            let first = bits.iter().position(|b| b.abs() > limit).expect("all fit");
            assert_eq!((axis, named), (Axis::ALL[first], D::LIMIT));
            assert_eq!(BigInt::from(units), images[first].floor().to_integer());
        }
        Err(other) => panic!("{other}"),
    }
}

proptest! {
    #![proptest_config(cases(1000))]

    #[test]
    fn images_are_exact_sums_rounded_once(map in affine(), narrow in net::<I16F16>(1), wide in net::<I32F32>(1)) {
        check_image::<I16F16, I16F16>(&map, &narrow[0]);
        check_image::<I16F16, I32F32>(&map, &narrow[0]);
        check_image::<I32F32, I16F16>(&map, &wide[0]);
        check_image::<I32F32, I32F32>(&map, &wide[0]);
    }

    #[test]
    fn maps_compose_with_entries_rounded_once(first in affine(), next in affine()) {
        let rational = |map: &Affine| map.rows.map(|row| row.map(|entry| ratio(entry.to_bits(), 1 << 32)));
        let (a, b) = (rational(&first), rational(&next));
        let entry = |row: usize, column: usize| {
            let shift = if column == 3 { b[row][3].clone() } else { ratio(0, 1) };
            rounded_bits(&(0..3).fold(shift, |sum, k| sum + &b[row][k] * &a[k][column]), 32)
        };
        let expected: Vec<_> = (0..12).map(|at| entry(at / 4, at % 4)).collect();
        match first.then(&next) {
            Ok(map) => {
                let ours: Vec<_> = map.rows.as_flattened().iter().map(|e| BigInt::from(e.to_bits())).collect();
                prop_assert_eq!(ours, expected);
            }
            Err(error) => {
                prop_assert_eq!(error, GeometryError::MatrixOverflow);
                prop_assert!(expected.iter().any(|bits| i64::try_from(bits).is_err()));
            }
        }
    }

    #[test]
    fn nets_map_point_by_point_and_surfaces_with_them(points in net::<I16F16>(16), turn: u32, r in parameter()) {
        let map = Affine::rotation_z(Angle::from_binary(turn));
        let patch = Tensor::<4, 4>::try_from(points.as_chunks::<4>().0.first_chunk().copied().unwrap()).unwrap();
        let Ok(moved) = patch.transform(&map) else {
            prop_assert!(points.iter().any(|p| map.apply(p).is_err()));
            return Ok(());
        };
        for (p, q) in moved.points().as_flattened().iter().zip(&points) {
            prop_assert_eq!(Ok(*p), map.apply(q));
        }
        // Moving the control points moves the surface: within the two roundings and that of the control points.
        let (ours, point) = (moved.net().eval(r, r), patch.net().eval(r, r));
        for axis in 0..3 {
            let error = image(&map, &point, axis) - exact(ours.to_array()[axis]);
            prop_assert!(error.abs() <= ratio(3, 1 << 17), "{error}");
        }
    }
}

#[test]
fn every_kind_of_net_is_transformed() {
    let map = Affine::translation(fixed(3 << 32), fixed(-(2 << 32)), fixed(1 << 31));
    let (from, to) = ([[1, 2, 3], [5, 5, 5], [-7, 0, 2]], [[4, 0, 3], [8, 3, 5], [-4, -2, 2]]);
    let up = |p: &Point3| Point3::new(p.x, p.y, p.z - I16F16::from_bits(1 << 15));
    let curve = Curve::<3>::from_ints(from).unwrap();
    let triangle = Triangle::<1, 3>::from_ints(from).unwrap();
    assert_eq!(
        curve.transform(&map).unwrap().points().each_ref().map(up),
        *Curve::<3>::from_ints(to).unwrap().points()
    );
    let moved = triangle.transform(&map).unwrap();
    assert_eq!(moved.points().each_ref().map(up), *Curve::<3>::from_ints(to).unwrap().points());
    let weights = [1, 2, 3].map(I16F16::from_bits);
    let rational = RationalCurve::new(curve, weights).unwrap();
    assert_eq!(
        rational.transform(&map),
        RationalCurve::new(curve.transform(&map).unwrap(), weights).map_err(|_| panic!())
    );
    let rational = RationalTriangle::new(triangle, weights).unwrap();
    assert_eq!(rational.transform(&map), RationalTriangle::new(moved, weights).map_err(|_| panic!()));
    let patch = BicubicPatch::from_ints([[[1, 2, 3]; 4]; 4]).unwrap();
    let rational = RationalTensor::new(patch, [[I16F16::MAX; 4]; 4]).unwrap();
    let moved = RationalTensor::new(patch.transform(&map).unwrap(), [[I16F16::MAX; 4]; 4]).unwrap();
    assert_eq!(rational.transform(&map), Ok(moved));
    let far = Affine::scaling(fixed(10_000 << 32), I32F32::ONE, I32F32::ONE);
    let error = GeometryError::OutOfRange { axis: Axis::X, units: 50_000, limit: 32_767 };
    assert_eq!((curve.transform(&far), triangle.transform(&far)), (Err(error), Err(error)));
    assert_eq!(RationalCurve::new(curve, weights).unwrap().transform(&far).map(|_| ()), Err(error));
}

#[test]
fn ranges_end_where_they_say() {
    let shift = |bits: i64| Affine::translation(fixed(bits), I32F32::ZERO, I32F32::ZERO);
    let edge = Point3::from_ints(32_766, 0, 0);
    let half = (1 << 32) + (1 << 15); // one unit and half of the last place of I16F16
    assert_eq!(shift(half - 1).apply(&edge), Ok(Point3::from_ints(32_767, 0, 0)));
    let beyond = Err(GeometryError::OutOfRange { axis: Axis::X, units: 32_767, limit: 32_767 });
    assert_eq!(shift(half).apply(&edge), beyond, "rounds up out of the range");
    assert_eq!(shift(half).apply_into::<_, I32F32>(&edge).map(|p| p.x.to_bits()), Ok((32_766 << 32) + half));
    let (low, wide) = (fixed(-(1 << 58)), |x| Point3::new(x, I32F32::ZERO, I32F32::ZERO));
    assert_eq!(shift(0).apply(&wide(low)), Ok(wide(low)));
    let beyond = Err(GeometryError::OutOfRange { axis: Axis::X, units: -(1 << 26) - 1, limit: 1 << 26 });
    assert_eq!(shift(-1).apply(&wide(low)), beyond);
    // Points are plain data: an illegal one is an error, not an overflow.
    let worst = [fixed(i64::MIN), fixed(i64::MAX)];
    for (a, b, c) in (0..8).map(|k: usize| (worst[k & 1], worst[k >> 1 & 1], worst[k >> 2])) {
        let map = Affine { rows: [[a, b, c, a]; 3] };
        for p in [Point3::new(a, b, c), Point3::new(c, b, a), Point3::new(b, b, b)] {
            assert!(matches!(map.apply(&p), Err(GeometryError::OutOfRange { axis: Axis::X, .. })));
            assert_eq!(map.then(&map), Err(GeometryError::MatrixOverflow));
        }
    }
    assert_eq!(
        Affine::IDENTITY.apply(&wide(I32F32::MIN)).map(|_| ()),
        Err(GeometryError::OutOfRange { axis: Axis::X, units: i64::from(i32::MIN), limit: 1 << 26 })
    );
}

/// p' = Rx(tilt) Rz(spin) p, on the screen (x, −y, −z); then the box to the middle of the screen.
fn view_f64(points: &[[f64; 3]], (tilt, spin): (f64, f64), screen: [f64; 2], fit: f64) -> (Vec<[f64; 3]>, f64) {
    let ((st, ct), (ss, cs)) = (tilt.to_radians().sin_cos(), spin.to_radians().sin_cos());
    let turned: Vec<[f64; 3]> = points
        .iter()
        .map(|[x, y, z]| {
            let (x, y) = (cs * x - ss * y, ss * x + cs * y);
            [x, -(ct * y - st * z), -(st * y + ct * z)]
        })
        .collect();
    let low = [0, 1, 2].map(|a| turned.iter().fold(f64::INFINITY, |m, p| m.min(p[a])));
    let high = [0, 1, 2].map(|a| turned.iter().fold(f64::NEG_INFINITY, |m, p| m.max(p[a])));
    let scale = (screen[0] * fit / (high[0] - low[0])).min(screen[1] * fit / (high[1] - low[1]));
    let target = [screen[0] / 2.0, screen[1] / 2.0, 0.0];
    let place = |p: &[f64; 3]| [0, 1, 2].map(|a| (p[a] - (low[a] + high[a]) / 2.0) * scale + target[a]);
    (turned.iter().map(place).collect(), scale)
}

fn to_f64(p: &Point3) -> [f64; 3] {
    p.to_array().map(|c| f64::from(c.to_bits()) / 65536.0)
}

/// The six views of the tests and the tea cup's.
const VIEWS: [(i32, i32); 7] = [(-90, 0), (-60, 30), (-70, -40), (-20, 75), (0, 0), (-110, 200), (-10, 30)];

proptest! {
    #![proptest_config(cases(300))]

    #[test]
    fn views_fill_the_screen_by_the_fraction_and_are_centred(
        points in prop::collection::vec([-(400_i32 << 16)..400 << 16, -(400 << 16)..400 << 16, -(400 << 16)..400 << 16], 3..30),
        view in 0..VIEWS.len(), width in 8_u32..1000, height in 8_u32..1000, fit in 1_i32 << 10..=1 << 16,
    ) {
        let model: Vec<Point3> = points.iter().map(|[x, y, z]| Point3::from_bits(*x, *y, *z)).collect();
        let (tilt, spin) = VIEWS[view];
        let direction = View { tilt: Angle::from_degrees(tilt), spin: Angle::from_degrees(spin) };
        let map = direction.fit(&model, width, height, I16F16::from_bits(fit)).unwrap();
        let (screen, fraction) = ([f64::from(width), f64::from(height)], f64::from(fit) / 65536.0);
        let floats: Vec<_> = model.iter().map(to_f64).collect();
        let (expected, scale) = view_f64(&floats, (tilt.into(), spin.into()), screen, fraction);
        // Angles of 2^-33 turns, sines and entries of 2^-32, a scale of 2^-33: each times 400 units three times.
        let tolerance = (scale * 2.0_f64.powi(-27)).max(2.0_f64.powi(-21)) * 8.0 + 2.0_f64.powi(-17);
        let images: Vec<Point3> = model.iter().map(|p| map.apply_into(p).unwrap()).collect();
        for (ours, expected) in images.iter().map(to_f64).zip(&expected) {
            for axis in 0..3 {
                prop_assert!((ours[axis] - expected[axis]).abs() <= tolerance, "{ours:?} {expected:?} {tolerance}");
            }
        }
        let b = Bounds::of(&images).unwrap();
        let (low, high) = (to_f64(&b.min), to_f64(&b.max));
        let fill = [(high[0] - low[0]) / screen[0], (high[1] - low[1]) / screen[1]];
        let slack = 2.0 * tolerance / screen[0].min(screen[1]);
        prop_assert!((fill[0].max(fill[1]) - fraction).abs() <= slack, "{fill:?} of {fraction}");
        for (axis, middle) in [screen[0] / 2.0, screen[1] / 2.0, 0.0].into_iter().enumerate() {
            prop_assert!(((low[axis] + high[axis]) / 2.0 - middle).abs() <= tolerance);
        }
    }
}

fn box_corners([x, y, z]: [i16; 3]) -> Vec<Point3> {
    (0..8).map(|k| Point3::from_ints(x * (k & 1), y * (k >> 1 & 1), z * (k >> 2))).collect()
}

#[test]
fn front_and_top_views_are_exact() {
    let model = box_corners([4, 2, 3]);
    let shown = |tilt, spin, fit| {
        let view = View { tilt: Angle::from_degrees(tilt), spin: Angle::from_degrees(spin) };
        let map = view.fit(&model, 320, 240, fit).unwrap();
        [0, 1, 2, 4].map(|k: usize| map.apply(&model[k]).unwrap())
    };
    let points = |all: [[i16; 3]; 4]| all.map(|[x, y, z]| Point3::from_ints(x, y, z));
    // From the front, x to the right, z up, y away; 3 · 80 pixels fill the height.
    let front = shown(-90, 0, I16F16::ONE);
    assert_eq!(front, points([[0, 240, -80], [320, 240, -80], [0, 240, 80], [0, 0, -80]]));
    // From above, y up, z towards the viewer; 4 · 80 pixels fill the width.
    let top = shown(0, 0, I16F16::ONE);
    assert_eq!(top, points([[0, 200, 120], [320, 200, 120], [0, 40, 120], [0, 200, -120]]));
    // Half of it, and turned by a quarter: y along −x.
    let turned = shown(0, 90, I16F16::from_bits(1 << 15));
    assert_eq!(turned, points([[190, 180, 45], [190, 60, 45], [130, 180, 45], [190, 180, -45]]));
    let rotation = View { tilt: Angle::ZERO, spin: Angle::ZERO }.rotation().unwrap();
    assert_eq!(rotation, Affine::scaling(I32F32::ONE, -I32F32::ONE, -I32F32::ONE));
    assert_eq!(View::default(), View { tilt: Angle::from_degrees(-60), spin: Angle::from_degrees(30) });
}

#[test]
fn flat_models_fit_by_the_direction_that_has_an_extent() {
    let front = View { tilt: Angle::from_degrees(-90), spin: Angle::ZERO };
    let line = [Point3::from_ints(0, 0, 5), Point3::from_ints(10, 7, 5)];
    let map = front.fit(line, 100, 60, I16F16::ONE).unwrap();
    assert_eq!(map.apply(&line[1]), Ok(Point3::from_ints(100, 30, 35)));
    let upright = [Point3::from_ints(3, 0, 0), Point3::from_ints(3, 0, 20)];
    assert_eq!(front.fit(upright, 100, 60, I16F16::ONE).unwrap().apply(&upright[1]), Ok(Point3::from_ints(50, 0, 0)));
}

/// One test per error, with the text.
#[test]
fn errors_name_the_offending_values() {
    let view = View::default();
    let (model, none) = (box_corners([4, 2, 3]), Vec::<Point3>::new());
    let fit = |points: &[Point3], width, height, fit: i32| {
        view.fit(points, width, height, I16F16::from_bits(fit)).map(|_| ())
    };
    let empty = |width, height| Err(GeometryError::EmptyScreen { width, height });
    assert_eq!(fit(&model, 0, 240, 1 << 16), empty(0, 240));
    assert_eq!(fit(&model, 320, 0, 1 << 16), empty(320, 0));
    assert_eq!(fit(&model, 320, 240, 0), empty(320, 240));
    assert_eq!(fit(&model, 320, 240, -1), empty(320, 240));
    assert_eq!(fit(&none, 320, 240, 1 << 16), Err(GeometryError::NothingToFit));
    assert_eq!(fit(&[model[3]; 5], 320, 240, 1 << 16), Err(GeometryError::NothingToFit));
    let speck = [Point3::ORIGIN, Point3::from_bits(1, 0, 0)];
    assert_eq!(fit(&speck, u32::MAX, u32::MAX, i32::MAX), Err(GeometryError::MatrixOverflow));
    let eye = Perspective { centre_x: I16F16::ZERO, centre_y: I16F16::ZERO, distance: I16F16::from_num(100) };
    let behind = eye.project(&Point3::from_ints(1, 2, -130));
    assert_eq!(behind, Err(GeometryError::BehindEye { units: -30 }));
    assert_eq!(eye.project(&Point3::from_ints(1, 2, -100)).map(|_| ()), Err(GeometryError::BehindEye { units: 0 }));
    let near = eye.project(&Point3::from_ints(1, 20_000, -99));
    assert_eq!(near, Err(GeometryError::OutOfRange { axis: Axis::Y, units: 2_000_000, limit: 32_767 }));
    let heavy = eye.project(&Point3::from_ints(0, 0, 32_700));
    assert_eq!(heavy, Err(GeometryError::OutOfRange { axis: Axis::Z, units: 32_800, limit: 32_767 }));
    let cases: [(GeometryError, &[&str]); 5] = [
        (GeometryError::OutOfRange { axis: Axis::Y, units: 2_000_000, limit: 32_767 }, &["y ", "2000000", "32767"]),
        (GeometryError::MatrixOverflow, &["matrix"]),
        (GeometryError::NothingToFit, &["fit"]),
        (GeometryError::EmptyScreen { width: 320, height: 0 }, &["320 x 0"]),
        (GeometryError::BehindEye { units: -30 }, &["behind", "-30"]),
    ];
    for (error, expected) in cases {
        let text = error.to_string();
        assert!(expected.iter().all(|part| text.contains(part)), "{text}");
        assert!(text.starts_with(|c: char| c.is_lowercase()) && !text.ends_with('.'), "{text}");
        let _: &dyn core::error::Error = &error;
    }
}

/// x' = c + (x − c)·D/(D + z), likewise y; z' = z·D/(D + z).
fn seen(eye: &Perspective, p: [BigRational; 3]) -> [BigRational; 3] {
    let [cx, cy, d] = [eye.centre_x, eye.centre_y, eye.distance].map(exact);
    let factor = &d / (&d + &p[2]);
    let [x, y, z] = p;
    [&cx + (x - &cx) * &factor, &cy + (y - &cy) * &factor, z * factor]
}

/// The control points are rounded by at most 2^-17, the weights are exact; a rational point is a convex combination
/// of control points, so it is off by at most that, and its own rounding adds 2^-17.
fn check_seen(eye: &Perspective, ours: Point3, surface: [BigRational; 3]) {
    for (ours, expected) in ours.to_array().into_iter().zip(seen(eye, surface)) {
        let error = exact(ours) - expected;
        assert!(
            error.abs() <= ratio(1, 1 << 16),
            "{} units of the last place",
            (error * BigInt::from(65536)).to_f64().unwrap()
        );
    }
}

proptest! {
    #![proptest_config(cases(200))]

    #[test]
    fn a_patch_in_perspective_is_the_perspective_of_its_points(
        points in prop::collection::vec([-(300_i32 << 16)..300 << 16, -(300 << 16)..300 << 16, -(190 << 16)..900 << 16], 21),
        centre in [-(400_i32 << 16)..400 << 16, -(400 << 16)..400 << 16], distance in 200_i32 << 16..2000 << 16,
        r in parameter(), s in parameter(), at in barycentric(),
    ) {
        let [centre_x, centre_y] = centre.map(I16F16::from_bits);
        let eye = Perspective { centre_x, centre_y, distance: I16F16::from_bits(distance) };
        let points: Vec<Point3> = points.iter().map(|[x, y, z]| Point3::from_bits(*x, *y, *z)).collect();
        for p in &points {
            let (image, weight) = eye.project(p).unwrap();
            prop_assert_eq!(exact(weight), exact(eye.distance) + exact(p.z));
            let expected = seen(&eye, p.to_array().map(exact));
            for (ours, expected) in image.to_array().into_iter().zip(expected) {
                let bits = round_half_up(&(expected * BigInt::from(1 << 16)));
                prop_assert_eq!(BigInt::from(ours.to_bits()), bits);
            }
        }
        let triangle = QuinticTriangle::try_from(*points.first_chunk().unwrap()).unwrap();
        let [basis, ..] = triangle_basis(5, at);
        let value = |axis| basis.value(triangle.points(), None, axis);
        check_seen(&eye, triangle.perspective(&eye).unwrap().net().eval(at), [0, 1, 2].map(value));
        let tensor = Tensor::<4, 5>::try_from(points.as_chunks::<5>().0.first_chunk().copied().unwrap()).unwrap();
        let [basis, ..] = tensor_basis((3, 4), r, s);
        let value = |axis| basis.value(tensor.points().as_flattened(), None, axis);
        check_seen(&eye, tensor.perspective(&eye).unwrap().net().eval(r, s), [0, 1, 2].map(value));
        let curve = Curve::<9>::try_from(*points.first_chunk().unwrap()).unwrap();
        let [basis, ..] = curve_basis(8, r);
        let value = |axis| basis.value(curve.points(), None, axis);
        check_seen(&eye, curve.perspective(&eye).unwrap().net().eval(r), [0, 1, 2].map(value));
    }
}

#[test]
fn a_net_behind_the_eye_has_no_perspective() {
    let eye = Perspective { centre_x: I16F16::ZERO, centre_y: I16F16::ZERO, distance: I16F16::from_num(59) };
    let patch = CubicTriangle::from_ints(common::SEED_P).unwrap();
    assert!(patch.perspective(&eye).is_ok());
    let down = patch.transform(&Affine::scaling(I32F32::ONE, I32F32::ONE, -I32F32::ONE)).unwrap();
    assert_eq!(down.perspective(&eye).map(|_| ()), Err(GeometryError::BehindEye { units: -91 }));
    let flat = Curve::<2>::from_ints([[3, 4, 0], [9, -4, 0]]).unwrap();
    let seen = flat.perspective(&eye).unwrap();
    assert_eq!(seen.net().points(), flat.points(), "the plane z = 0 keeps its scale");
    assert_eq!(seen.net().eval(Parameter::HALF), Point3::from_ints(6, 0, 0));
    let corner = patch.perspective(&eye).unwrap().net().eval(Barycentric::new(1, 0, 0).unwrap());
    assert_eq!(Ok(corner), eye.project(&patch.points()[0]).map(|(p, _)| p));
}
