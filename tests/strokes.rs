//! What `BezierCurve` and `Stroke` promise, against dense sampling in `f64`: neighbours, distances, no seams.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, clippy::disallowed_types, clippy::float_arithmetic)]

mod common;
#[path = "common/stroke.rs"]
mod stroke;

use common::draw::{cases, net, weights};
use embedded_graphics::pixelcolor::BinaryColor;
use embedded_graphics::prelude::*;
use embedded_graphics::primitives::{PointsIter, Rectangle};
use embedded_surfaces::forward::CurveLattice;
use embedded_surfaces::geometry::Point3;
use embedded_surfaces::graphics::{AnyCurveNet, BezierCurve, Stroke};
use embedded_surfaces::num::I16F16;
use embedded_surfaces::patch::{CurveNet, RationalCurveNet};
use proptest::prelude::*;
use stroke::{drawn, quarter, stroke};

/// The bound of the docs.
const EPSILON: f64 = 1.0 / 20.0;

fn are_neighbours(a: Point, b: Point) -> bool {
    a != b && (a.x - b.x).abs() <= 1 && (a.y - b.y).abs() <= 1
}

/// The curve at t, by the Bernstein sum.
fn at(net: AnyCurveNet<'_>, t: f64) -> [f64; 2] {
    let m = net.points().len() - 1;
    let mut sums = [0.0; 3];
    for (i, p) in net.points().iter().enumerate() {
        let choose = (0..i).fold(1.0, |c, k| c * (m - k) as f64 / (k + 1) as f64);
        let weight = net.weights().map_or(1.0, |w| w[i].to_num());
        let basis = weight * choose * t.powi(i as i32) * (1.0 - t).powi((m - i) as i32);
        for (sum, c) in sums.iter_mut().zip([p.x.to_num(), p.y.to_num(), 1.0]) {
            *sum += basis * c;
        }
    }
    [sums[0] / sums[2], sums[1] / sums[2]]
}

fn distance_to_segment(p: [f64; 2], a: [f64; 2], b: [f64; 2]) -> f64 {
    let (way, to) = ([b[0] - a[0], b[1] - a[1]], [p[0] - a[0], p[1] - a[1]]);
    let square = way[0] * way[0] + way[1] * way[1];
    let along = if square > 0.0 { ((way[0] * to[0] + way[1] * to[1]) / square).clamp(0.0, 1.0) } else { 0.0 };
    (to[0] - along * way[0]).hypot(to[1] - along * way[1])
}

/// Every pixel of the display against its distance from the curve, sampled four times as densely as the stroke is.
fn check_thickness(net: AnyCurveNet<'_>, width: u32) -> Result<(), TestCaseError> {
    let stroke = stroke(net, width);
    let n = 4 * stroke.curve.steps();
    let samples: Vec<_> = (0..=n).map(|i| at(net, f64::from(i) / f64::from(n))).collect();
    let mut distances = vec![f64::MAX; 64 * 64];
    let reach = f64::from(width) / 2.0 + 1.0;
    for ends in samples.windows(2) {
        let range = |axis: usize| {
            let (low, high) = (ends[0][axis].min(ends[1][axis]) - reach, ends[0][axis].max(ends[1][axis]) + reach);
            (low.ceil().max(0.0) as i32)..=(high.floor().min(63.0) as i32)
        };
        for (x, y) in range(1).flat_map(|y| range(0).map(move |x| (x, y))) {
            let stored = &mut distances[(64 * y + x) as usize];
            *stored = stored.min(distance_to_segment([x.into(), y.into()], ends[0], ends[1]));
        }
    }
    let display = drawn(stroke);
    let half = f64::from(width) / 2.0;
    for p in display.bounding_box().points() {
        let (covered, distance) = (display.get_pixel(p).is_some(), distances[(64 * p.y + p.x) as usize]);
        prop_assert!(covered || distance >= half - EPSILON, "{} missed at {}", p, distance);
        prop_assert!(!covered || distance <= half + EPSILON, "{} drawn at {}", p, distance);
        prop_assert!(!covered || stroke.bounding_box().contains(p), "{} is outside the bounding box", p);
    }
    Ok(())
}

/// Diagonal lines are the fastest: a step is a whole pixel along both axes. Phases bring pixel centres everywhere near
/// the sides; the widths are the least of each spacing of discs.
#[test]
fn nothing_is_lost_between_two_discs() {
    for (width, along, across) in
        [2, 8, 32].into_iter().flat_map(|w| (0..8).flat_map(move |a| (0..91).map(move |b| (w, a << 13, b << 10))))
    {
        let at = |c: i32| Point3::from_bits((c << 16) + along + across / 2, (c << 16) + along - across / 2, 0);
        let ends = [at(24), at(40)];
        check_thickness(CurveNet::new(&ends).unwrap().into(), width).unwrap();
    }
}

/// Nets about the size of the display, and tiny ones.
fn on_screen(len: usize) -> impl Strategy<Value = Vec<Point3>> {
    let of = |low: i32, high: i32| {
        let c = move || low << 16..high << 16;
        prop::collection::vec((c(), c()).prop_map(|(x, y)| Point3::from_bits(x, y, 0)), len)
    };
    prop_oneof![3 => of(-20, 84), 1 => of(28, 36), 1 => of(31, 32)]
}

/// Weights that the engine takes at degree 8 and the size of the display: few bits, and not far apart.
fn mild_weights(len: usize) -> impl Strategy<Value = Vec<I16F16>> {
    prop::collection::vec((4..=9).prop_map(|quarters| I16F16::from_bits(quarters << 14)), len)
}

/// The curve of the first `degree + 1` points, with weights or without.
fn any_net<'a>(points: &'a [Point3], weights: &'a [I16F16], degree: usize, rational: bool) -> AnyCurveNet<'a> {
    let net = CurveNet::new(&points[..=degree]).unwrap();
    if rational { RationalCurveNet::new(net, &weights[..=degree]).unwrap().into() } else { net.into() }
}

fn check_pixels(net: AnyCurveNet<'_>) -> Result<(), TestCaseError> {
    let Ok(curve) = BezierCurve::new(net) else { return Ok(()) };
    let lattice = match net {
        AnyCurveNet::Polynomial(net) => CurveLattice::new(net, curve.steps()),
        AnyCurveNet::Rational(net) => CurveLattice::rational(net, curve.steps()),
    };
    let Ok(lattice) = lattice else { return Ok(()) };
    let by = Point::new(7, -1000);
    // Curves of whole displays and more are walked in part.
    let pixels: Vec<_> = curve.translate(by).points().take(5000).collect();
    prop_assert!(pixels.windows(2).all(|w| are_neighbours(w[0], w[1])));
    let mut expected: Vec<_> = lattice.points().map(|p| Point::new(p.x, p.y) + by).take(20_000).collect();
    expected.dedup();
    let common = expected.len().min(pixels.len());
    prop_assert_eq!(&expected[..common], &pixels[..common]);
    let area = curve.translate(by).bounding_box();
    prop_assert!(pixels.iter().all(|p| area.contains(*p)));
    Ok(())
}

/// A full circle of four rational arcs, the NURBS way.
#[test]
fn four_quarters_are_a_circle() {
    let arcs = [
        [[56, 31], [56, 56], [31, 56]],
        [[31, 56], [6, 56], [6, 31]],
        [[6, 31], [6, 6], [31, 6]],
        [[31, 6], [56, 6], [56, 31]],
    ]
    .map(quarter);
    let off_radius = |p: Point| (f64::from(p.x - 31).hypot(f64::from(p.y - 31)) - 25.0).abs();
    let pixels: Vec<_> = arcs.iter().flat_map(|arc| BezierCurve::new(arc).unwrap().points()).collect();
    let worst = pixels.iter().map(|p| off_radius(*p)).fold(0.0, f64::max);
    assert!(worst <= core::f64::consts::FRAC_1_SQRT_2, "{worst}");
    assert_eq!(pixels.first(), pixels.last());
    assert!(pixels.windows(2).all(|w| w[0] == w[1] || are_neighbours(w[0], w[1])));
    let octants = pixels.iter().map(|p| ((p.x - 31).abs(), (p.y - 31).abs()));
    assert!(octants.clone().any(|p| p == (15, 20)) && octants.clone().any(|p| p == (24, 7)), "3-4-5 and 7-24-25");
    // A ring of width 6: every centre is decided by its distance from the true circle.
    let mut covered = std::collections::HashSet::new();
    for arc in &arcs {
        let display = drawn(stroke(arc, 6));
        covered.extend(display.bounding_box().points().filter(|p| display.get_pixel(*p).is_some()));
    }
    for p in Rectangle::new(Point::zero(), Size::new(64, 64)).points() {
        let distance = off_radius(p);
        assert!(!covered.contains(&p) || distance <= 3.0 + EPSILON, "{p} at {distance}");
        assert!(covered.contains(&p) || distance >= 3.0 - EPSILON, "{p} at {distance}");
    }
}

proptest! {
    #![proptest_config(cases(150))]

    #[test]
    fn pixels_are_lattice_points_and_neighbours(
        points in net::<I16F16>(9), weights in weights(9), degree in 1_usize..=8, rational: bool,
    ) {
        check_pixels(any_net(&points, &weights, degree, rational))?;
    }

    #[test]
    fn pixels_on_the_screen_are_neighbours_along_the_curve(
        points in on_screen(9), weights in mild_weights(9), degree in 1_usize..=8, rational: bool,
    ) {
        let net = any_net(&points, &weights, degree, rational);
        check_pixels(net)?;
        // Nothing of the curve is left out: half a step and half a pixel along each axis.
        let pixels: Vec<_> = BezierCurve::new(net).unwrap().points().collect();
        for p in (0..=500).map(|i| at(net, f64::from(i) / 500.0)) {
            let near = |q: &Point| (f64::from(q.x) - p[0]).abs().max((f64::from(q.y) - p[1]).abs()) < 1.000_001;
            prop_assert!(pixels.iter().any(near), "{:?}", p);
        }
    }

    #[test]
    fn strokes_hold_what_is_within_half_the_width(
        points in on_screen(9), weights in mild_weights(9), degree in 1_usize..=8, rational: bool, width in 2_u32..=40,
    ) {
        check_thickness(any_net(&points, &weights, degree, rational), width)?;
    }

    #[test]
    fn thin_strokes_hold_what_is_within_half_the_width(
        points in on_screen(9), weights in mild_weights(9), degree in 1_usize..=8, rational: bool, width in 2_u32..=4,
    ) {
        check_thickness(any_net(&points, &weights, degree, rational), width)?;
    }

    #[test]
    fn buffers_and_translations_do_not_show(
        points in on_screen(9), weights in mild_weights(9), degree in 1_usize..=8, rational: bool, width in 1_u32..=12,
        x in -30..30, y in -30..30,
    ) {
        let curve = BezierCurve::new(any_net(&points, &weights, degree, rational)).unwrap();
        let whole = drawn(Stroke::<_, 512>::with_buffer(curve, BinaryColor::On, width));
        prop_assert!(drawn(Stroke::<_, 1>::with_buffer(curve, BinaryColor::On, width)) == whole);
        prop_assert!(drawn(Stroke::<_, 7>::with_buffer(curve, BinaryColor::On, width)) == whole);
        prop_assert!(drawn(Stroke::<_, 4096>::with_buffer(curve, BinaryColor::On, width)) == whole);
        let by = Point::new(x, y);
        let moved = drawn(Stroke::new(curve, BinaryColor::On, width).translate(by));
        for p in moved.bounding_box().points().filter(|p| moved.bounding_box().contains(*p - by)) {
            prop_assert_eq!(moved.get_pixel(p), whole.get_pixel(p - by));
        }
    }
}
