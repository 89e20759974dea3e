//! Curves against surfaces, sections by planes, and borders that are cut twice: against signs of exact functions in `f64`.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]
#![allow(clippy::disallowed_types, clippy::float_arithmetic, clippy::float_cmp, reason = "an oracle in f64")]

#[path = "common/meeting.rs"]
#[allow(dead_code)]
mod meeting;

use embedded_surfaces::geometry::{Axis, Point3, Vector3};
use embedded_surfaces::intersect::{
    Buffer, CurveKind, End, Held, Hit, HitKind, Hits, I16F48, IntersectError, IsoCurve, Options, Plane, Side,
    SpaceCurve, curve_points, section,
};
use embedded_surfaces::num::{I16F16, I32F32};
use embedded_surfaces::patch::{CurveNet, RationalCurveNet, Surface, SurfaceNet, sphere};
use embedded_surfaces::reference;
use meeting::{Meeting, Patch, Point, dot, minus, position};
use proptest::prelude::*;

fn fixed(x: f64) -> I16F16 {
    reference::fixed_half_up(x).unwrap()
}

fn float(p: I16F48) -> f64 {
    p.to_bits() as f64 / (1_u64 << 48) as f64
}

fn point(p: Point) -> Point3 {
    Point3::from_array(p.map(fixed))
}

/// Numbers in −1 ..= 1 from a seed, the same on every host.
struct Noise(u64);

impl Noise {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((self.0 >> 33) as f64) / f64::from(1 << 30) - 1.0
    }
}

/// A patch over the square or the triangle 0 ..= 60 whose x and y are 60 u and 60 v; weights alike, if any.
fn graph(triangle: bool, degrees: (usize, usize), rough: f64, weighted: bool, noise: &mut Noise) -> Patch {
    let (m, h) = degrees;
    let places: Vec<[f64; 2]> = if triangle {
        (0..=m).rev().flat_map(|i| (0..=m - i).rev().map(move |j| [i, j].map(|k| k as f64 / m as f64))).collect()
    } else {
        (0..=m).flat_map(|i| (0..=h).map(move |j| [i as f64 / m as f64, j as f64 / h as f64])).collect()
    };
    // 60/7 is rounded, half up, as the oracle reads it back.
    let points: Vec<_> = places.iter().map(|[x, y]| point([60.0 * x, 60.0 * y, rough * noise.next()])).collect();
    let weights = weighted.then(|| vec![I16F16::from_num(3) / 2; points.len()]);
    Patch { triangle, degrees: if triangle { (m, m) } else { degrees }, points, weights }
}

/// A curve through the box of such patches.
fn wild(degree: usize, rough: f64, noise: &mut Noise) -> Vec<Point3> {
    let mut c = |centre: f64, size: f64| centre + size * noise.next();
    (0..=degree).map(|_| point([c(22.0, 20.0), c(22.0, 20.0), c(0.0, 2.0 * rough)])).collect()
}

/// The rational curve in `f64`: independent of the crate's evaluation.
fn on_curve(points: &[Point3], weights: &[I16F16], t: f64) -> Point {
    let n = points.len() - 1;
    let mut sum = [0.0; 4];
    let mut binomial = 1.0;
    for (k, (p, w)) in points.iter().zip(weights).enumerate() {
        let b = binomial * t.powi(k as i32) * (1.0 - t).powi((n - k) as i32) * w.to_num::<f64>();
        binomial = binomial * (n - k) as f64 / (k + 1) as f64;
        let [x, y, z] = p.to_array().map(|c| c.to_num::<f64>());
        for (sum, c) in sum.iter_mut().zip([x, y, z, 1.0]) {
            *sum += b * c;
        }
    }
    [sum[0] / sum[3], sum[1] / sum[3], sum[2] / sum[3]]
}

const STEPS: usize = 4000;

/// Changes of sign of a function along a curve, within a domain; `None` where a root is not plain enough to be counted.
fn count(curve: impl Fn(f64) -> Point, height: impl Fn(Point) -> f64, inside: impl Fn(Point) -> f64) -> Option<usize> {
    let samples: Vec<_> = (0..=STEPS).map(|k| curve(k as f64 / STEPS as f64)).map(|p| (height(p), inside(p))).collect();
    let mut roots = 0;
    for w in samples.windows(3) {
        let dip = (w[1].0.abs() <= w[0].0.abs()) && (w[1].0.abs() <= w[2].0.abs());
        if dip && w[1].0.abs() < 1e-2 && (w[0].0 > 0.0) == (w[2].0 > 0.0) {
            return None;
        }
    }
    for w in samples.windows(2) {
        if (w[0].0 > 0.0) != (w[1].0 > 0.0) {
            if (w[0].1 > 0.0) != (w[1].1 > 0.0) || w[0].1.abs() < 1e-2 {
                return None;
            }
            roots += usize::from(w[0].1 > 0.0);
        }
    }
    Some(roots)
}

fn check_hits(hits: &Hits<'_>, net: SurfaceNet<'_>, curve: impl Fn(f64) -> Point) {
    for hit in hits.points() {
        let [u, v] = hit.parameters.map(float);
        let position = hit.position.to_array().map(|c| c.to_bits() as f64 / (1_u64 << 44) as f64);
        for on in [reference::point(net, u, v), curve(float(hit.t))] {
            let d = minus(on, position);
            assert!(dot(d, d).sqrt() < 1e-9, "{:e}", dot(d, d).sqrt());
        }
    }
    assert!(hits.points().is_sorted_by_key(|hit| hit.t));
}

#[test]
fn every_curve_meets_every_graph_as_often_as_the_height_changes_its_sign() {
    let mut noise = Noise(1);
    let mut room = [Hit::BLANK; 40];
    let (mut compared, mut found) = (0, 0);
    for round in 0..480 {
        let (triangle, rational, weighted) = (round & 1 == 1, round & 2 == 2, round & 4 == 4);
        let degree = 1 + round / 8 % 8;
        // Degrees that divide 60·2^16, so that x and y are exact.
        let degrees = [(1, 1), (2, 3), (3, 3), (4, 2), (5, 4), (6, 6), (8, 5), (3, 8)][round % 61 % 8];
        let rough = [3.0, 30.0, 90.0][round % 3];
        let patch = graph(triangle, degrees, rough, weighted, &mut noise);
        let points = wild(degree, rough, &mut noise);
        let weights: Vec<_> =
            (0..=degree).map(|_| fixed(1.0 + if rational { 0.8 * noise.next() } else { 0.0 })).collect();
        let net = CurveNet::new(&points).unwrap();
        let curve = if rational { RationalCurveNet::new(net, &weights).unwrap().into() } else { SpaceCurve::from(net) };
        let hits = curve_points(curve, patch.net(), &mut room).unwrap();
        let at = |t: f64| on_curve(&points, &weights, t);
        check_hits(&hits, patch.net(), at);
        let height = |[x, y, z]: Point| z - reference::point(patch.net(), x / 60.0, y / 60.0)[2];
        let inside = |[x, y, _]: Point| {
            let far = if triangle { 60.0 - x - y } else { (60.0 - x).min(60.0 - y) };
            x.min(y).min(far)
        };
        if let Some(roots) = count(at, height, inside) {
            assert!(hits.is_certified(), "{round}: {}", hits.undecided);
            assert_eq!(hits.points().len(), roots, "{round}");
            // Each crossing is from one side to the other, in turn, as far as the domain goes.
            for hit in hits.points() {
                let step = 1e-5;
                let slope = height(at(float(hit.t) + step)) - height(at(float(hit.t) - step));
                assert_eq!(slope > 0.0, hit.sine > 0, "{round}");
            }
            (compared, found) = (compared + 1, found + roots);
        }
    }
    assert!(compared > 300 && found > 500, "{compared} {found}");
}

/// A straight line, a rational conic and a cubic against the octant of a sphere, whose equation is known.
#[test]
fn a_sphere_is_met_where_its_equation_says() {
    let mut noise = Noise(7);
    // The one of the eight where all coordinates are positive.
    let octant = sphere(Point3::ORIGIN, I16F16::from_num(64)).unwrap()[4];
    let mut room = [Hit::BLANK; 20];
    let mut found = 0;
    for round in 0..200 {
        let degree = 1 + round % 8;
        let points: Vec<_> = (0..=degree).map(|_| point([0, 0, 0].map(|_| 45.0 + 40.0 * noise.next()))).collect();
        let weights: Vec<_> = (0..=degree).map(|_| fixed(1.2 + noise.next())).collect();
        let net = RationalCurveNet::new(CurveNet::new(&points).unwrap(), &weights).unwrap();
        let hits = curve_points(net, octant.surface(), &mut room).unwrap();
        let at = |t: f64| on_curve(&points, &weights, t);
        check_hits(&hits, octant.surface(), at);
        let height = |p: Point| dot(p, p).sqrt() - 64.0;
        if let Some(roots) = count(at, height, |[x, y, z]| x.min(y).min(z)) {
            assert!(hits.is_certified(), "{round}");
            assert_eq!(hits.points().len(), roots, "{round}");
            found += roots;
        }
    }
    assert!(found > 100, "{found}");
}

fn flat() -> Patch {
    let corners = [[0, 0], [0, 60], [80, 0], [80, 60]].map(|[x, y]| Point3::from_ints(x, y, 0));
    Patch { triangle: false, degrees: (1, 1), points: corners.to_vec(), weights: None }
}

fn hits<'b>(points: &[[f64; 3]], patch: &Patch, room: &'b mut [Hit]) -> Hits<'b> {
    let points: Vec<_> = points.iter().map(|p| point(*p)).collect();
    curve_points(CurveNet::new(&points).unwrap(), patch.net(), room).unwrap()
}

/// What no arithmetic can decide is said to be so; what it can is found, however close.
#[test]
fn multiple_roots_touches_and_curves_on_the_surface_are_named() {
    let mut room = [Hit::BLANK; 8];
    let kinds = |hits: &Hits<'_>| hits.points().iter().map(|hit| hit.kind).collect::<Vec<_>>();
    let bow = |low: f64| [[20.0, 20.0, 10.0], [30.0, 30.0, low], [40.0, 40.0, 10.0]];
    // The parabola 10 (1 − 2t)² + (10 + low)·2t(1 − t): its least height is (10 + low)/2.
    let touching = hits(&bow(-10.0), &flat(), &mut room);
    assert_eq!((kinds(&touching), touching.undecided), (vec![HitKind::Touching], 1));
    let middle = touching.points()[0];
    assert!((float(middle.t) - 0.5).abs() < 1e-6 && middle.residual.abs() < 1e-9);
    // Two crossings 10^-3 of the curve apart, and a miss by as little.
    for (gap, count) in [(-2, 2), (-1, 2), (1, 0), (2, 0)] {
        let near = hits(&bow(-10.0 + f64::from(gap) / 65536.0), &flat(), &mut room);
        assert!(near.is_certified(), "{gap}: {}", near.undecided);
        assert_eq!(kinds(&near), vec![HitKind::Crossing; count], "{gap}");
        let t: Vec<_> = near.points().iter().map(|hit| float(hit.t)).collect();
        // 10 (1 − 2t)² = −gap/65536/2 · (1 − (1 − 2t)²), nearly.
        let expected = (f64::from(-gap) / 65536.0 / 20.0).max(0.0).sqrt() / 2.0;
        assert!(t.iter().all(|t| ((t - 0.5).abs() - expected).abs() < 1e-7), "{t:?} {expected}");
    }
    // A triple root: z = (2t − 1)³.
    let cubic = [[10.0, 10.0, -1.0], [20.0, 20.0, 1.0], [30.0, 30.0, -1.0], [40.0, 40.0, 1.0]];
    let triple = hits(&cubic, &flat(), &mut room);
    assert_eq!(kinds(&triple), [HitKind::Touching]);
    assert!(!triple.is_certified() && (float(triple.points()[0].t) - 0.5).abs() < 1e-3);
    // A line in the plane, from outside the patch to outside, and one from inside.
    let line = hits(&[[-20.0, 30.0, 0.0], [140.0, 30.0, 0.0]], &flat(), &mut room);
    assert_eq!((kinds(&line), line.undecided), (vec![HitKind::Begin, HitKind::End], 0));
    let [begin, end] = [0, 1].map(|k: usize| float(line.points()[k].t));
    assert!((begin - 0.125).abs() < 1e-9 && (end - 0.625).abs() < 1e-9, "{begin} {end}");
    let line = hits(&[[10.0, 10.0, 0.0], [30.0, 50.0, 0.0]], &flat(), &mut room);
    assert_eq!((kinds(&line), line.undecided), (vec![HitKind::Begin, HitKind::End], 0));
    assert!(line.points().iter().map(|hit| float(hit.t)).eq([0.0, 1.0]));
    // Through a corner and through an edge.
    let corner = hits(&[[70.0, 50.0, -10.0], [90.0, 70.0, 10.0]], &flat(), &mut room);
    assert_eq!((kinds(&corner), corner.undecided), (vec![HitKind::Crossing], 0));
    let edge = hits(&[[70.0, 60.0, -10.0], [50.0, 60.0, 10.0]], &flat(), &mut room);
    assert_eq!((kinds(&edge), edge.undecided), (vec![HitKind::Crossing], 0));
    // An end of the curve on the surface, and a curve beyond the border by the last bit.
    let end = hits(&[[70.0, 40.0, 0.0], [50.0, 20.0, 10.0]], &flat(), &mut room);
    assert_eq!((kinds(&end), end.points()[0].t), (vec![HitKind::Crossing], I16F48::ZERO));
    let beyond = hits(&[[70.0, 60.0 + 1.0 / 65536.0, -10.0], [50.0, 60.0 + 1.0 / 65536.0, 10.0]], &flat(), &mut room);
    assert_eq!((beyond.points().len(), beyond.undecided), (0, 0));
}

#[test]
fn roots_at_equal_distances_are_roots_and_not_a_part() {
    // A quintic with roots at the ends, the middle and the quarters.
    let roots = [0.0, 0.25, 0.5, 0.75, 1.0];
    // The Bernstein coefficients of the quintic, from its powers: Σ a_k t^k with b_i = Σ_k C(i,k)/C(5,k) a_k.
    let mut powers = vec![1.0];
    for r in roots {
        let mut next = vec![0.0; powers.len() + 1];
        for (k, a) in powers.iter().enumerate() {
            next[k + 1] += a;
            next[k] -= a * r;
        }
        powers = next;
    }
    let choose = |n: usize, k: usize| (0..k).fold(1.0, |c, i| c * (n - i) as f64 / (i + 1) as f64);
    let points: Vec<[f64; 3]> = (0..=5)
        .map(|i| {
            let z: f64 = (0..=i).map(|k| choose(i, k) / choose(5, k) * powers[k] * 320.0).sum();
            [10.0 + 10.0 * i as f64, 30.0, (z * 65536.0).round() / 65536.0]
        })
        .collect();
    let mut room = [Hit::BLANK; 8];
    let found = hits(&points, &flat(), &mut room);
    let kinds: Vec<_> = found.points().iter().map(|hit| hit.kind).collect();
    // Rounding of the coefficients may push a root at an end out by less than the last bit.
    assert!(kinds.iter().all(|kind| *kind == HitKind::Crossing) && (3..=5).contains(&kinds.len()), "{kinds:?}");
}

#[test]
fn wrong_arguments_are_named() {
    let mut room = [Hit::BLANK; 1];
    let dot = [Point3::from_ints(1, 2, 3); 3];
    let curve = CurveNet::new(&dot).unwrap();
    assert_eq!(curve_points(curve, flat().net(), &mut room), Err(IntersectError::DegenerateCurve));
    let line = [Point3::from_ints(10, 10, -10), Point3::from_ints(30, 30, 90), Point3::from_ints(50, 50, -10)];
    let curve = CurveNet::new(&line).unwrap();
    let full = IntersectError::Buffer { buffer: Buffer::Points, needed: 2, given: 1 };
    assert_eq!(curve_points(curve, flat().net(), &mut room), Err(full));
    let thin = Patch { points: [0, 0, 60, 60].map(|x| Point3::from_ints(x, x, 0)).to_vec(), ..flat() };
    let degenerate = IntersectError::DegeneratePatch { side: Side::B };
    assert_eq!(curve_points(curve, thin.net(), &mut room), Err(degenerate));
    let bits = 1 << 48;
    let flat = flat();
    assert!(IsoCurve::new(flat.net(), Held::First, I16F48::from_bits(bits)).is_ok());
    for (held, bits) in [(Held::First, -1), (Held::Second, bits + 1), (Held::Third, 5)] {
        assert_eq!(IsoCurve::new(flat.net(), held, I16F48::from_bits(bits)), Err(IntersectError::Parameter { bits }));
    }
    let zero = Vector3::new(I16F16::ZERO, I16F16::ZERO, I16F16::ZERO);
    assert_eq!(Plane::new(zero, I32F32::ONE), Err(IntersectError::Normal { offset: 1 << 32 }));
    assert_eq!(IntersectError::Normal { offset: 3 }.to_string(), "the plane 0 = 3 / 2^32 has no normal");
    let far = Vector3::from_array([32767; 3].map(I16F16::from_num));
    let corner = Point3::from_ints(32767, 32767, 32767);
    assert_eq!(Plane::through(corner, far), Err(IntersectError::Offset { units: 3 * 32767 * 32767 }));
}

/// The four kinds of nets: an oracle of points from `reference`.
fn kinds(noise: &mut Noise) -> Vec<Patch> {
    let mut all = Vec::new();
    for (triangle, weighted) in [(false, false), (true, false), (false, true), (true, true)] {
        let mut patch = graph(triangle, (3, 2), 20.0, weighted, noise);
        for p in &mut patch.points {
            *p = point(p.to_array().map(|c| c.to_num::<f64>() + 4.0 * noise.next()));
        }
        if let Some(weights) = &mut patch.weights {
            weights.iter_mut().for_each(|w| *w = fixed(1.2 + noise.next()));
        }
        all.push(patch);
    }
    all
}

/// Iso-parametric curves meet a surface where the curves of both surfaces pass that parameter.
#[test]
fn iso_parametric_curves_of_every_kind_meet_surfaces_where_the_surfaces_meet() {
    let mut noise = Noise(3);
    let mut found = 0;
    for one in kinds(&mut noise) {
        for two in kinds(&mut noise) {
            let two = two.mapped(|[x, y, z]| [z + (30 << 16), y, x - (30 << 16)]);
            let meeting = Meeting::new(&one, &two, &Options::DEFAULT).unwrap();
            for (held, at) in [(Held::First, 0.3), (Held::Second, 0.45), (Held::Third, 0.6)] {
                let at = I16F48::from_num(at);
                let Ok(iso) = IsoCurve::new(one.net(), held, at) else {
                    assert!(!one.triangle && held == Held::Third);
                    continue;
                };
                let mut room = [Hit::BLANK; 12];
                let hits = curve_points(iso, two.net(), &mut room).unwrap();
                let place = |t: f64| {
                    let c = float(at);
                    match (held, one.triangle) {
                        (Held::First, false) => [c, t],
                        (Held::Second, false) => [t, c],
                        (Held::First, true) => [c, t * (1.0 - c)],
                        (Held::Second, true) => [t * (1.0 - c), c],
                        (Held::Third, _) => [t * (1.0 - c), (1.0 - t) * (1.0 - c)],
                    }
                };
                check_hits(&hits, two.net(), |t| {
                    let [u, v] = place(t);
                    reference::point(one.net(), u, v)
                });
                let parameter = |[u, v]: [f64; 2]| match held {
                    Held::First => u,
                    Held::Second => v,
                    Held::Third => 1.0 - u - v,
                };
                let passes: usize = meeting
                    .curves
                    .iter()
                    .map(|(curve, points)| {
                        let sides: Vec<_> =
                            points.iter().map(|p| parameter(p.parameters[0].map(float)) > float(at)).collect();
                        let closing = usize::from(curve.closed && sides.first() != sides.last());
                        sides.windows(2).filter(|w| w[0] != w[1]).count() + closing
                    })
                    .sum();
                assert!(hits.is_certified());
                assert_eq!(hits.points().len(), passes, "{held:?}");
                found += passes;
            }
        }
    }
    assert!(found > 10, "{found}");
}

/// Ends of curves on the borders, and lengths, against a fine grid of heights over the plane.
#[test]
fn sections_by_any_plane_have_the_ends_and_the_length_of_a_fine_grid() {
    let mut noise = Noise(5);
    let (mut ends, mut lengths) = (0, 0);
    for round in 0..24 {
        for patch in kinds(&mut noise) {
            let normal = [noise.next(), noise.next(), noise.next()].map(|c| fixed(c * [0.5, 3.0, 900.0][round % 3]));
            let through = point([20.0 + 9.0 * noise.next(), 20.0 + 9.0 * noise.next(), 4.0 * noise.next()]);
            let plane = Plane::through(through, Vector3::from_array(normal)).unwrap();
            let n = normal.map(|c| c.to_num::<f64>());
            let n = n.map(|c| c / dot(n, n).sqrt());
            let c = dot(n, through.to_array().map(|c| c.to_num::<f64>()));
            let run = |patch: &Patch| {
                Meeting::with(patch, &flat(), &Options::DEFAULT, |buffers, [net, _], options| {
                    section(net, plane, options, buffers)
                })
            };
            let found = run(&patch).unwrap();
            for (_, points) in &found.curves {
                for p in points {
                    let [u, v] = p.parameters[0].map(float);
                    let on = minus(reference::point(patch.net(), u, v), position(p));
                    assert!(dot(on, on).sqrt() < 1e-9 && (dot(n, position(p)) - c).abs() < 1e-9);
                    // The plane's normal is Su × Sv of B: its parameters grow with the coordinates, whichever they are.
                    assert!(p.parameters[1].iter().all(|q| (0.0..=1.0).contains(&float(*q))));
                }
            }
            let height = |u: f64, v: f64| dot(n, reference::point(patch.net(), u, v)) - c;
            if let Some((roots, length)) = grid(patch.triangle, height, |u, v| reference::point(patch.net(), u, v)) {
                let open = found.curves.iter().flat_map(|(curve, _)| curve.ends);
                assert!(found.certified, "{round}: {}", found.undecided);
                assert_eq!(open.filter(|end| *end != End::None).count(), roots, "{round}");
                assert!((found.length() - length).abs() < 4e-3 * length.max(1.0), "{} {length}", found.length());
                (ends, lengths) = (ends + roots, lengths + 1);
            }
        }
    }
    assert!(ends > 60 && lengths > 40, "{ends} {lengths}");
}

/// Roots on the border and the length of the zero line of a height, from triangles; `None` where they are not plain.
fn grid(triangle: bool, height: impl Fn(f64, f64) -> f64, at: impl Fn(f64, f64) -> Point) -> Option<(usize, f64)> {
    const N: usize = 64;
    let place = |i: usize, j: usize| [i, j].map(|k| k as f64 / N as f64);
    let values: Vec<Vec<f64>> = (0..=N)
        .map(|i| (0..=if triangle { N - i } else { N }).map(|j| height(place(i, j)[0], place(i, j)[1])).collect())
        .collect();
    let mut length = 0.0;
    let mut cell = |corners: [(usize, usize); 3]| {
        let mut ends = Vec::new();
        for k in 0..3 {
            let ((a, b), (c, d)) = (corners[k], corners[(k + 1) % 3]);
            let (f, g) = (values[a][b], values[c][d]);
            if (f > 0.0) != (g > 0.0) {
                let s = f / (f - g);
                let ([u, v], [x, y]) = (place(a, b), place(c, d));
                ends.push(at(u + s * (x - u), v + s * (y - v)));
            }
        }
        if let [p, q] = ends[..] {
            length += dot(minus(p, q), minus(p, q)).sqrt();
        }
    };
    for i in 0..N {
        for j in 0..if triangle { N - i } else { N } {
            cell([(i, j), (i + 1, j), (i, j + 1)]);
            if !triangle || i + j + 2 <= N {
                cell([(i + 1, j + 1), (i, j + 1), (i + 1, j)]);
            }
        }
    }
    let borders: &[[[f64; 2]; 2]] = if triangle {
        &[[[0.0, 0.0], [1.0, 0.0]], [[0.0, 0.0], [0.0, 1.0]], [[0.0, 1.0], [1.0, 0.0]]]
    } else {
        &[[[0.0, 0.0], [1.0, 0.0]], [[0.0, 0.0], [0.0, 1.0]], [[0.0, 1.0], [1.0, 1.0]], [[1.0, 0.0], [1.0, 1.0]]]
    };
    let mut roots = 0;
    for [from, to] in borders {
        let f = |t: f64| [height(from[0] + t * (to[0] - from[0]), from[1] + t * (to[1] - from[1])), 0.0, 0.0];
        roots += count(f, |p| p[0], |_| 1.0)?;
    }
    Some((roots, length))
}

#[test]
fn planes_beside_the_surface_and_out_of_range() {
    let mut patch = flat();
    let run = |patch: &Patch, plane: Plane| {
        Meeting::with(patch, patch, &Options::DEFAULT.with_depth(4), |buffers, [net, _], options| {
            section(net, plane, options, buffers)
        })
    };
    for height in [-32768, -1, 1, 32767] {
        let found = run(&patch, Plane::across(Axis::Z, I16F16::from_num(height))).unwrap();
        assert!(found.curves.is_empty() && found.certified, "{height}");
    }
    // The plane of the patch itself.
    let found = run(&patch, Plane::across(Axis::Z, I16F16::ZERO)).unwrap();
    assert_eq!(found.curves.iter().map(|(c, _)| c.kind).collect::<Vec<_>>(), [CurveKind::OverlapRegion]);
    // At the ends of the range: an axis' plane always fits, an oblique one may not.
    let corners = [[-32767, -32767], [-32767, 32767], [32767, -32767], [32767, 32767]];
    patch.points = corners.map(|[x, y]| Point3::from_ints(x, y, x)).to_vec();
    let found = run(&patch, Plane::across(Axis::X, I16F16::from_num(32766))).unwrap();
    assert_eq!((found.kinds(), found.certified), (vec!["open_curve"], true));
    let steep = Plane::from_ints([3, 3, 4], 0).unwrap();
    assert!(matches!(run(&patch, steep), Err(IntersectError::Plane { .. })));
    patch.points = corners.map(|[x, y]| Point3::from_ints(x / 5, y / 5, x / 5)).to_vec();
    let found = run(&patch, steep).unwrap();
    assert_eq!((found.kinds(), found.certified), (vec!["open_curve"], true));
}

/// Turns about all axes by angles in radians, and moves.
fn pose(patch: &Patch, angles: Point, by: Point) -> Patch {
    let turn = |p: [i32; 3]| {
        let mut p = p.map(|c| f64::from(c) / 65536.0);
        for (k, angle) in angles.into_iter().enumerate() {
            let (i, j) = ((k + 1) % 3, (k + 2) % 3);
            let (sin, cos) = angle.sin_cos();
            (p[i], p[j]) = (cos * p[i] - sin * p[j], sin * p[i] + cos * p[j]);
        }
        [0, 1, 2].map(|k: usize| fixed(p[k] + by[k]).to_bits())
    };
    patch.mapped(turn)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, ..ProptestConfig::default() })]

    /// A steep bicubic whose lower edge dips through a gently curved sheet by less than a cell of the mesh.
    #[test]
    fn a_border_that_is_cut_twice_within_a_cell_is_found_in_every_pose(
        angles in proptest::array::uniform3(-3.0_f64..3.0), by in proptest::array::uniform3(-99.0_f64..99.0),
        place in 60.0_f64..240.0, depth in 4_u32..6, dip in 0.002_f64..0.03, triangle: bool,
    ) {
        // The edge z = k (x − place)² − dip, as the lower border of a wall; the sheet z = 0 bends away from it elsewhere.
        let k = 1.0 / 500.0;
        let z = |x: f64| k * (x - place).powi(2) - dip;
        // The cubic through it: a parabola, exactly, by blossoms.
        let blossom = |a: f64, b: f64| k * ((a - place) * (b - place)) - dip;
        let xs = [0.0, 100.0, 200.0, 300.0];
        let [first, mixed, last] = [blossom(0.0, 0.0), blossom(0.0, 300.0), blossom(300.0, 300.0)];
        let low = [z(0.0), (first + 2.0 * mixed) / 3.0, (2.0 * mixed + last) / 3.0, z(300.0)];
        let wall: Vec<_> = (0..4)
            .flat_map(|i| (0..4).map(move |j| (i, j)))
            .map(|(i, j): (usize, usize)| point([xs[i], 10.0 + 3.0 * j as f64, low[i] + 40.0 * j as f64]))
            .collect();
        let wall = Patch { triangle: false, degrees: (3, 3), points: wall, weights: None };
        let floor = if triangle {
            let corners = [[-50.0, -80.0, 0.0], [700.0, -80.0, 0.0], [-50.0, 500.0, 0.0]];
            Patch { triangle, degrees: (1, 1), points: corners.map(point).to_vec(), weights: None }
        } else {
            let corners = [[-50.0, -80.0, 0.0], [-50.0, 190.0, 0.0], [350.0, -80.0, 0.0], [350.0, 190.0, 0.0]];
            Patch { triangle, degrees: (1, 1), points: corners.map(point).to_vec(), weights: None }
        };
        let (wall, floor) = (pose(&wall, angles, by), pose(&floor, angles, by));
        let options = Options::DEFAULT.with_depth(depth);
        for (a, b, side) in [(&wall, &floor, Side::A), (&floor, &wall, Side::B)] {
            let found = Meeting::new(a, b, &options).unwrap();
            prop_assert_eq!(found.kinds(), vec!["open_curve"]);
            let (curve, points) = &found.curves[0];
            prop_assert_eq!(curve.ends, [End::Edge { side, edge: 2 }; 2]);
            // Its chord is that of the parabola below 0, but for the rounding of the control points.
            let chord = minus(position(&points[0]), position(&points[points.len() - 1]));
            let expected = 2.0 * (dip / k).sqrt();
            prop_assert!((dot(chord, chord).sqrt() - expected).abs() < 0.05 * expected + 0.05);
            prop_assert!(found.certified, "{} undecided", found.undecided);
        }
    }
}
