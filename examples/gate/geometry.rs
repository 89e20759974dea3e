//! Points, boxes, maps and views, with every error.

use super::{Sum, hide};
use embedded_surfaces::geometry::{Affine, Axis, Bounds, Perspective, Point3, Vector3, View};
use embedded_surfaces::num::{Angle, I16F16, I32F32};

const INTS: [[i16; 3]; 4] = [[3, -40, 500], [-32767, 32767, 0], [17, 23, -1], [100, 0, 60]];

pub(super) fn calls(sum: &mut Sum) {
    let points = hide(INTS).map(|[x, y, z]| Point3::<I16F16>::from_ints(x, y, z));
    coordinates(sum, &points);
    maps(sum, &points);
    views(sum, &points);
}

#[inline(never)]
fn coordinates(sum: &mut Sum, points: &[Point3; 4]) {
    for p in points {
        let array: [I16F16; 3] = Point3::to_array(*p);
        let [x, y, z] = array;
        sum.add([Point3::from_array(array), Point3::new(y, z, x)]);
        let vector = Vector3::from_array(array);
        sum.add([Vector3::to_array(vector), Vector3::to_array(Vector3::new(z, x, y))]);
        let wide = Point3::<I32F32>::from(*p);
        let finer = Point3::new(wide.x + I32F32::from_bits(hide(1 << 15)), wide.y, wide.z);
        let far = Point3::new(hide(I32F32::MAX), wide.y, wide.z);
        sum.add([wide, finer, far].map(Point3::<I32F32>::round));
    }
    let bits = Point3::<I16F16>::from_bits(hide(1), hide(-1), hide(1 << 16));
    let (one, all) = (Bounds::of([&bits]), Bounds::of(points));
    sum.add(Bounds::<I16F16>::of(hide([]).iter()));
    sum.add(one);
    sum.add(one.zip(all).map(|(a, b)| Bounds::union(&a, &b)));
}

#[inline(never)]
fn maps(sum: &mut Sum, points: &[Point3; 4]) {
    let number = |n: i32| I32F32::from_num(hide(n));
    let scaling = Affine::scaling(number(2), number(-1), number(3));
    let translation = Affine::translation(number(5), number(-7), number(11));
    let turns = [Affine::rotation_x, Affine::rotation_z].map(|turn| turn(Angle::from_degrees(hide(33))));
    let huge = Affine::scaling(number(1 << 30), number(1), number(1));
    let mut map = hide(Affine::IDENTITY);
    for next in [scaling, translation, turns[0], turns[1], huge, huge] {
        let both = Affine::then(&map, &next);
        sum.add(both);
        map = both.unwrap_or(map);
        for p in points {
            sum.add(Affine::apply(&next, p));
            sum.add(Affine::apply_into::<I16F16, I32F32>(&next, p));
            sum.add(Affine::apply_into::<I32F32, I16F16>(&next, &(*p).into()));
        }
    }
}

#[inline(never)]
fn views(sum: &mut Sum, points: &[Point3; 4]) {
    let turned = View { tilt: Angle::from_degrees(hide(70)), spin: Angle::from_degrees(hide(-20)) };
    for view in [View::default(), turned] {
        sum.add(View::rotation(&view));
        for (width, fit) in hide([(320, 60000), (0, 60000), (320, 0)]) {
            sum.add(View::fit(&view, points, width, 240, I16F16::from_bits(fit)));
        }
        sum.add(View::fit(&view, hide(&points[..0]), 320, 240, I16F16::ONE));
    }
    for distance in hide([400, 20000, 0]) {
        let distance = I16F16::from_num(distance);
        let eye = Perspective { centre_x: I16F16::from_num(160), centre_y: I16F16::from_num(-120), distance };
        let behind = Point3::from_ints(0, 0, hide(-500));
        points.iter().chain([&behind]).for_each(|p| sum.add(Perspective::project(&eye, p)));
    }
    Axis::ALL.into_iter().for_each(|axis| sum.add(Err::<(), _>(axis)));
}
