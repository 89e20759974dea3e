//! Intersections against reference data and closed forms, in every order of arguments, parameters and coordinates.
//!
//! `tests/golden/intersect.json`: points of the reference cases come from Newton's method with 40 digits; lengths under
//! `expect` are those of the exact curves, which the patches were made to have.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]
#![allow(clippy::disallowed_types, clippy::float_arithmetic, clippy::float_cmp, reason = "an oracle in f64")]

#[path = "common/meeting.rs"]
mod meeting;

use embedded_surfaces::geometry::{Axis, Point3};
use embedded_surfaces::intersect::{
    Branch, Buffer, Buffers, Curve, CurvePoint, End, IntersectError, Options, Plane, Room, Side, intersect, project,
    section,
};
use embedded_surfaces::num::I16F16;
use embedded_surfaces::patch::{BicubicPatch, BilinearPatch, Surface};
use embedded_surfaces::reference;
use meeting::{Meeting, Patch, cases, distance, dot, expected, minus, position, tangent};
use proptest::prelude::*;
use serde_json::Value;

const OPTIONS: Options = Options::DEFAULT;

fn check(name: &str, case: &Value, found: &Meeting) {
    let (kinds, length, arms) = expected(case);
    assert_eq!(found.kinds(), kinds, "{name}");
    if let Some(length) = length {
        assert!((found.length() - length).abs() <= 1e-6 * length.max(1e-3), "{name}: {} and {length}", found.length());
    }
    assert_eq!(found.branches.iter().map(|b| b.arms() as u64).collect::<Vec<_>>(), arms, "{name}");
}

/// At the default depth: on a coarser grid a crossing may be too far from its curve to be refined.
fn check_certificate(name: &str, case: &Value, found: &Meeting) {
    if let Some(certified) = case["expect"]["certified"].as_bool() {
        assert_eq!(found.certified, certified, "{name}: {} undecided", found.undecided);
    }
}

/// Points on both surfaces, pieces that run forward.
fn check_points(name: &str, a: &Patch, b: &Patch, found: &Meeting) {
    for (curve, points) in &found.curves {
        assert_eq!(curve.unrefined, 0, "{name}");
        for p in points {
            let [[u, v], [s, t]] = p.parameters.map(|q| q.map(|c| c.to_bits() as f64 / (1_u64 << 48) as f64));
            for on in [reference::point(a.net(), u, v), reference::point(b.net(), s, t)] {
                let d = minus(on, position(p));
                assert!(dot(d, d).sqrt() < 1e-9, "{name}: {:e}", dot(d, d).sqrt());
            }
        }
        for w in points.windows(2) {
            let chord = minus(position(&w[1]), position(&w[0]));
            assert!(dot(chord, tangent(&w[0])) > 0.0, "{name} runs backwards at {:?}", w[0].position);
        }
    }
}

fn check_reference(name: &str, case: &Value, found: &Meeting) {
    // The points of a region fill it.
    for component in case["reference"]["components"].as_array().into_iter().flatten() {
        if component["kind"] == "overlap_region" {
            continue;
        }
        for point in component["points"].as_array().unwrap() {
            let x = [0, 1, 2].map(|k: usize| point["xyz"][k].as_f64().unwrap());
            let far = found.curves.iter().map(|(c, points)| distance(c, points, x)).fold(f64::INFINITY, f64::min);
            assert!(far < 1e-6, "{name}: {x:?} is {far:e} away");
        }
    }
}

#[test]
fn cases_have_their_components_lengths_and_points() {
    for case in cases() {
        let name = case["name"].as_str().unwrap();
        let (a, b) = (Patch::read(&case["A"]), Patch::read(&case["B"]));
        let found = Meeting::new(&a, &b, &OPTIONS).unwrap();
        check(name, &case, &found);
        check_certificate(name, &case, &found);
        check_points(name, &a, &b, &found);
        check_reference(name, &case, &found);
    }
}

#[test]
fn orders_of_arguments_parameters_and_coordinates_do_not_matter() {
    for case in cases() {
        let name = case["name"].as_str().unwrap();
        let (a, b) = (Patch::read(&case["A"]), Patch::read(&case["B"]));
        let turned = |p: &Patch| p.mapped(|[x, y, z]| [z, x, y]);
        let mirrored = |p: &Patch| p.mapped(|[x, y, z]| [x, z, y]);
        let pairs = [
            ("exchanged", b.clone(), a.clone()),
            ("u and v of A", a.swapped(), b.clone()),
            ("u and v of both, exchanged", b.swapped(), a.swapped()),
            ("turned", turned(&a), turned(&b)),
            ("mirrored", mirrored(&a), mirrored(&b)),
        ];
        for (what, a, b) in pairs {
            check(&format!("{name}, {what}"), &case, &Meeting::new(&a, &b, &OPTIONS).unwrap());
        }
    }
}

#[test]
fn exchanged_arguments_exchange_the_answer() {
    for case in cases().iter().take(8) {
        let (a, b) = (Patch::read(&case["A"]), Patch::read(&case["B"]));
        let (one, two) = (Meeting::new(&a, &b, &OPTIONS).unwrap(), Meeting::new(&b, &a, &OPTIONS).unwrap());
        for ((c, points), (d, others)) in one.curves.iter().zip(&two.curves) {
            assert_eq!((c.length, c.kind), (d.length, d.kind));
            for (p, q) in points.iter().zip(others) {
                assert_eq!(
                    (p.position, p.parameters[0], p.parameters[1]),
                    (q.position, q.parameters[1], q.parameters[0])
                );
            }
            for (e, f) in c.ends.iter().zip(d.ends) {
                if let (End::Edge { side, edge }, End::Edge { side: other, edge: same }) = (*e, f) {
                    assert!(side != other && edge == same);
                }
            }
        }
    }
}

#[test]
fn depths_and_scales_do_not_matter() {
    for case in cases().iter().filter(|case| case["name"] != "c10_coincident" && case["name"] != "twice the same patch")
    {
        let name = case["name"].as_str().unwrap();
        let (a, b) = (Patch::read(&case["A"]), Patch::read(&case["B"]));
        let depth = if name.len() % 2 == 0 { 4 } else { 6 };
        check(&format!("{name}, depth {depth}"), case, &Meeting::new(&a, &b, &OPTIONS.with_depth(depth)).unwrap());
        let (kinds, length, _) = expected(case);
        let small = |p: &Patch| p.points.iter().all(|p| p.to_array().iter().all(|c| c.abs() < 4000));
        if !small(&a) || !small(&b) {
            continue;
        }
        let eight = |p: &Patch| p.mapped(|p| p.map(|c| 8 * c));
        let found = Meeting::new(&eight(&a), &eight(&b), &OPTIONS).unwrap();
        assert_eq!(found.kinds(), kinds, "{name}, eight times as large");
        if let Some(length) = length {
            assert!((found.length() - 8.0 * length).abs() <= 8e-6 * length, "{name}, eight times as large");
        }
        let moved = |p: &Patch| p.mapped(|[x, y, z]| [x + 12_345_678, y - 7_654_321, z + 33_333_333]);
        check(&format!("{name}, moved"), case, &Meeting::new(&moved(&a), &moved(&b), &OPTIONS).unwrap());
    }
}

/// A tensor-product patch near a sheet, with noise.
fn sheet(degrees: (usize, usize), noise: &[[i32; 3]], height: i32) -> Patch {
    let (m, h) = degrees;
    let place = |i: usize, n: usize| (i * 600 / n) as i32 - 300;
    let grid = (0..=m).flat_map(|i| (0..=h).map(move |j| (i, j)));
    let points = grid.zip(noise).map(|((i, j), [x, y, z])| {
        let whole = [place(i, m) + x % 40, place(j, h) + y % 40, z % height];
        let [x, y, z] = whole.map(|c| c << 16);
        Point3::from_bits(x, y, z)
    });
    Patch { triangle: false, degrees, points: points.collect(), weights: None }
}

fn noise() -> impl Strategy<Value = Vec<[i32; 3]>> {
    proptest::collection::vec(proptest::array::uniform3(-1000_i32..1000), 36)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 60, ..ProptestConfig::default() })]

    #[test]
    fn random_pairs_agree_in_both_orders_and_depths(
        a in noise(), b in noise(), m in 1_usize..6, h in 1_usize..6, height in 50_i32..600,
    ) {
        let (one, two) = (sheet((m, h), &a, height), sheet((h, 3), &b, 60));
        let found = Meeting::new(&one, &two, &OPTIONS).unwrap();
        check_points("random", &one, &two, &found);
        let (swapped, deeper) =
            (Meeting::new(&two, &one, &OPTIONS).unwrap(), Meeting::new(&one, &two, &OPTIONS.with_depth(6)).unwrap());
        prop_assert_eq!(found.kinds(), swapped.kinds());
        prop_assert!(found.certified == swapped.certified);
        if found.certified && deeper.certified {
            prop_assert_eq!(found.kinds(), deeper.kinds());
            prop_assert!((found.length() - deeper.length()).abs() <= 1e-6 * found.length().max(1e-3));
        }
    }

    /// Patches that share an edge but for the last bits, or all of their points but for them.
    #[test]
    fn nearly_degenerate_pairs_end_without_a_broken_rule(
        a in noise(), b in noise(), bits in proptest::collection::vec(-1_i32..=1, 16), height in 2_i32..600, same: bool,
    ) {
        let one = sheet((3, 3), &a, height);
        let mut two = if same { one.clone() } else { sheet((3, 3), &b, height) };
        for (k, bit) in bits.iter().enumerate() {
            if same || k % 4 == 0 {
                let [x, y, z] = one.points[if same { k } else { k + 3 }].to_array().map(I16F16::to_bits);
                two.points[k] = Point3::from_bits(x, y, z + bit);
            }
        }
        match Meeting::new(&one, &two, &OPTIONS.with_depth(4).with_budgets(1 << 18, 1 << 11)) {
            Ok(_) | Err(IntersectError::SegmentBuffer { .. } | IntersectError::Buffer { .. } | IntersectError::PairBudget { .. }) => {}
            Err(other) => panic!("{other}"),
        }
    }
}

static HILL: BicubicPatch = embedded_surfaces::const_net!(BicubicPatch::from_ints([
    [[0, 0, 0], [0, 20, 0], [0, 40, 0], [0, 60, 0]],
    [[20, 0, 0], [20, 20, 40], [20, 40, 40], [20, 60, 0]],
    [[40, 0, 0], [40, 20, 40], [40, 40, 40], [40, 60, 0]],
    [[60, 0, 0], [60, 20, 0], [60, 40, 0], [60, 60, 0]],
]));
static WATER: BilinearPatch = embedded_surfaces::const_net!(BilinearPatch::from_ints([
    [[-9, -9, 10], [-9, 70, 12]],
    [[70, -9, 10], [70, 70, 12]]
]));

#[test]
fn small_buffers_and_wrong_options_are_named() {
    let run = |options: &Options, [vertices, boxes, segments, points, curves]: [usize; 5]| {
        intersect(
            HILL.surface(),
            WATER.surface(),
            options,
            Buffers {
                vertices: &mut vec![[0; 3]; vertices],
                boxes: &mut vec![[[0; 3]; 2]; boxes],
                records: &mut vec![0; 2 * segments],
                links: &mut vec![0; 2 * segments],
                points: &mut vec![CurvePoint::BLANK; points],
                curves: &mut vec![Curve::BLANK; curves],
                branches: &mut [Branch::BLANK; 1],
            },
        )
        .map(|result| result.curves().len())
    };
    let coarse = OPTIONS.with_depth(3);
    let room = Room::new(HILL.surface(), WATER.surface(), 3).unwrap();
    assert_eq!((room.vertices, room.boxes), (162, 170));
    assert_eq!(run(&coarse, [162, 170, 200, 300, 2]), Ok(1));
    // Fewer boxes are enough, down to two.
    assert_eq!(run(&coarse, [162, 2, 200, 300, 2]), Ok(1));
    assert_eq!(run(&coarse, [161, 170, 200, 300, 2]), Err(IntersectError::VertexBuffer { needed: 162, given: 161 }));
    assert_eq!(run(&coarse, [162, 1, 200, 300, 2]), Err(IntersectError::BoxBuffer { needed: 2, given: 1 }));
    assert!(matches!(run(&coarse, [162, 170, 5, 300, 2]), Err(IntersectError::SegmentBuffer { given: 5, .. })));
    let full = |buffer, given| Err(IntersectError::Buffer { buffer, needed: given + 1, given });
    assert_eq!(run(&coarse, [162, 170, 200, 7, 2]), full(Buffer::Points, 7));
    assert_eq!(run(&coarse, [162, 170, 200, 300, 0]), full(Buffer::Curves, 0));
    assert!(matches!(
        run(&coarse.with_budgets(9, 0), [162, 170, 200, 300, 2]),
        Err(IntersectError::PairBudget { visited: 9, .. })
    ));
    assert_eq!(run(&OPTIONS.with_depth(8), [0; 5]), Err(IntersectError::Depth { depth: 8 }));
    let zero = embedded_surfaces::intersect::I20F44::ZERO;
    assert_eq!(run(&OPTIONS.with_tolerance(zero), [0; 5]), Err(IntersectError::Tolerance { bits: 0 }));
    let point = Patch { triangle: false, degrees: (1, 1), points: vec![Point3::from_ints(1, 2, 3); 4], weights: None };
    let hill = Patch { triangle: false, degrees: (3, 3), points: HILL.points().as_flattened().to_vec(), weights: None };
    let degenerate = |side| Some(IntersectError::DegeneratePatch { side });
    assert_eq!(Meeting::new(&point, &hill, &coarse).err(), degenerate(Side::A));
    assert_eq!(Meeting::new(&hill, &point, &coarse).err(), degenerate(Side::B));
    assert_eq!(
        IntersectError::VertexBuffer { needed: 162, given: 161 }.to_string(),
        "the vertex buffer has room for 161 entries, 162 are needed"
    );
}

#[test]
fn contours_are_closed_round_a_summit_and_level() {
    let hill = Patch { triangle: false, degrees: (3, 3), points: HILL.points().as_flattened().to_vec(), weights: None };
    for (height, count) in [(5, 1), (15, 1), (22, 1), (23, 0)] {
        let at = I16F16::from_num(height);
        let found = Meeting::with(&hill, &hill, &OPTIONS, |buffers, [net, _], options| {
            section(net, Plane::across(Axis::Z, at), options, buffers)
        });
        let found = found.unwrap();
        assert_eq!(found.kinds(), vec!["closed_curve"; count], "{height}");
        assert!(found.certified);
        for (_, points) in &found.curves {
            assert!(points.iter().all(|p| (position(p)[2] - f64::from(height)).abs() < 1e-9));
        }
    }
    // The summit, 22.5, is a touching point.
    let summit = Meeting::with(&hill, &hill, &OPTIONS, |buffers, [net, _], options| {
        section(net, Plane::across(Axis::Z, I16F16::from_num(45) / 2), options, buffers)
    });
    assert_eq!(summit.unwrap().kinds(), ["tangent_point"]);
}

proptest! {
    #[test]
    fn the_nearest_point_is_no_farther_than_any_of_a_fine_grid(x in -30_i16..90, y in -30_i16..90, z in -60_i16..90) {
        let (mut vertices, mut boxes) = ([[0; 3]; 289], [[[0; 3]; 2]; 341]);
        let found = project(HILL.surface(), Point3::from_ints(x, y, z), 4, &mut vertices, &mut boxes).unwrap();
        let c = [x, y, z].map(f64::from);
        let far = |u: f64, v: f64| {
            let d = minus(reference::point(HILL.surface(), u, v), c);
            dot(d, d).sqrt()
        };
        let least = (0..=80).flat_map(|i| (0..=80).map(move |j| (i, j))).map(|(i, j)| far(f64::from(i) / 80.0, f64::from(j) / 80.0));
        let least = least.fold(f64::INFINITY, f64::min);
        let ours = found.distance.to_bits() as f64 / (1_u64 << 44) as f64;
        prop_assert!(ours <= least + 1e-9, "{} and {}", ours, least);
        prop_assert!(ours >= least - 1.0);
        let [u, v] = found.parameters.map(|p| p.to_bits() as f64 / (1_u64 << 48) as f64);
        prop_assert!((far(u, v) - ours).abs() < 1e-9);
        for (i, j) in (-1..=1).flat_map(|i| (-1..=1).map(move |j| (i, j))) {
            let [s, t] = [(u, i), (v, j)].map(|(c, k)| (c + f64::from(k) / 512.0).clamp(0.0, 1.0));
            prop_assert!(ours <= far(s, t) + 1e-9, "{} at {} {}, and at {} {}", ours, u, v, s, t);
        }
    }
}
