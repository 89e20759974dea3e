//! What a caller can choose, the baselines, and every error.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]
#![allow(clippy::disallowed_types, clippy::float_arithmetic, clippy::float_cmp, reason = "an oracle in f64")]

#[path = "common/families.rs"]
mod families;
#[path = "common/skin.rs"]
mod skin;

use embedded_surfaces::g1::{Controls, G1Error, Interpolant, Lengths, List, Options, Scheme, Shift, Tangent, Twist};
use embedded_surfaces::geometry::{Point3, Vector3};
use embedded_surfaces::mesh::{Faces, Links, Mesh};
use embedded_surfaces::num::{I16F16, I32F32};
use embedded_surfaces::patch::QuinticTriangle;
use embedded_surfaces::subdivide::{PatchTopology, Tolerance, tessellate, topology};
use families::{Dice, bipyramid, cube, octahedron, open, sphere, torus};
use skin::{Net, Refusal, Seam, Skin, length, minus, plus, point, times};
use std::collections::HashMap;

fn ball() -> Skin {
    sphere(&mut Dice(5), 20).scaled().0
}

fn largest_angle(skin: &Skin, nets: &[Net]) -> f64 {
    skin.seams().into_iter().map(|seam| Seam::of(nets, seam).angle(50)).fold(0.0, f64::max)
}

/// Where b\[3,1,1\] stands at corner 0.
const TWIST: usize = 4;

/// A face and a corner with an odd number of edges: its tangents are never moved.
fn odd_corner(skin: &Skin) -> (usize, usize) {
    let is_odd = |v: u16| skin.faces.iter().filter(|face| face.contains(&v)).count() % 2 == 1;
    let mut corners = skin.faces.iter().enumerate().flat_map(|(f, face)| (0..3).map(move |c| (f, c, face[c])));
    corners.find(|corner| is_odd(corner.2)).map(|(f, c, _)| (f, c)).unwrap()
}

fn tangent(nets: &[Net], (face, corner): (usize, usize)) -> skin::V3 {
    let [own, next] = [[5, 0, 0], [4, 1, 0]].map(|weights| skin::at(&nets[face], corner, weights));
    minus(next, own)
}

#[test]
fn given_tangents_are_taken_and_others_chosen() {
    let skin = ball();
    let (face, c) = odd_corner(&skin);
    let old = tangent(&skin.smooth().unwrap().nets, (face, c));
    let vector = Vector3::from_array(times(old, 1.25).map(skin::fixed));
    let tangents = [Tangent { from: skin.faces[face][c], to: skin.faces[face][(c + 1) % 3], vector }];
    let controls = Controls { tangents: &tangents, ..Controls::default() };
    let after = skin.solve(&controls, &Options::default()).unwrap();
    assert!(length(minus(tangent(&after.nets, (face, c)), times(old, 1.25))) < 1e-8);
    assert!(largest_angle(&skin, &after.nets) < 5e-9);
}

#[test]
fn tension_shortens_tangents() {
    let skin = ball();
    let (face, c) = odd_corner(&skin);
    let old = tangent(&skin.smooth().unwrap().nets, (face, c));
    let mut tension = vec![I16F16::ZERO; skin.points.len()];
    tension[usize::from(skin.faces[face][c])] = I16F16::from_num(0.5);
    let controls = Controls { tension: Some(&tension), ..Controls::default() };
    let after = skin.solve(&controls, &Options::default()).unwrap();
    let ratio = length(tangent(&after.nets, (face, c))) / length(old);
    assert!((ratio - 0.5).abs() < 1e-8, "{ratio}");
    assert!(largest_angle(&skin, &after.nets) < 5e-9);
}

#[test]
fn twists_come_closer_to_their_targets() {
    let skin = ball();
    let before = skin.smooth().unwrap();
    let aim = plus(before.nets[3][TWIST], [3.0, -2.0, 4.0]);
    let twists = [Twist { face: 3, corner: 0, point: point(aim) }];
    let controls = Controls { twists: &twists, ..Controls::default() };
    let after = skin.solve(&controls, &Options::default()).unwrap();
    let [old, new] = [&before, &after].map(|s| length(minus(s.nets[3][TWIST], aim)));
    assert!(new < 0.9 * old, "{new} {old}");
    assert!(largest_angle(&skin, &after.nets) < 5e-9);
}

#[test]
fn projected_tangents_and_estimated_normals_are_smooth_too() {
    let options = Options { lengths: Lengths::Projected, ..Options::default() };
    for skin in [ball(), torus(6, 5).scaled().0, open(&mut Dice(2), 6, true).scaled().0] {
        let solution = skin.solve(&Controls::default(), &options).unwrap();
        assert!(largest_angle(&skin, &solution.nets) < 5e-9);
        let solution = Skin { normals: None, ..skin.clone() }.smooth().unwrap();
        assert!(largest_angle(&skin, &solution.nets) < 5e-9);
    }
}

/// A nearly symmetrical mesh is solved in shape if small angles may be left.
#[test]
fn a_tolerance_keeps_nearly_symmetrical_meshes_in_shape() {
    let mut dice = Dice(4);
    let skin = octahedron();
    let points = skin.points.iter().map(|p| dice.noise(*p, 1e-6)).collect();
    let (skin, _) = Skin { points, ..skin }.scaled();
    let solution = skin.smooth().unwrap();
    assert_eq!(solution.quality.shifted, 6);
    let options = Options { tolerance: I32F32::from_num(1e-3), ..Options::default() };
    let kept = skin.solve(&Controls::default(), &options).unwrap();
    assert_eq!(kept.quality.shifted, 0);
    assert!(kept.quality.max_deviation < solution.quality.max_deviation * 3 / 5);
    assert!(largest_angle(&skin, &kept.nets) < 1e-5);
}

#[test]
fn baselines_have_the_same_interface_and_are_not_smooth() {
    let skin = ball();
    for scheme in [Scheme::PointNormal, Scheme::Flat] {
        let options = Options { scheme, ..Options::default() };
        let solution = skin.solve(&Controls::default(), &options).unwrap();
        let angle = largest_angle(&skin, &solution.nets);
        assert!(angle > 0.05);
        let reported = solution.quality.max_angle as f64 / 2_f64.powi(60);
        assert!(reported > 0.9 * angle && reported < 1.001 * angle, "{reported} {angle}");
        assert!(skin.seams().into_iter().all(|seam| Seam::of(&solution.nets, seam).closed));
        assert_eq!((solution.quality.max_deviation.to_bits(), solution.quality.folded), (0, 0));
        // Cubic or linear, degree-elevated: the boundary's fifth difference vanishes.
        let [c0, c1, c2, c3, c4, c5] = [0, 1, 3, 6, 10, 15].map(|i| solution.nets[0][i]);
        let inner = plus(times(minus(c1, c4), 5.0), times(minus(c3, c2), 10.0));
        assert!(length(plus(minus(c5, c0), inner)) < 1e-7);
        if scheme == Scheme::PointNormal {
            // e = p/5 with the projected edge p.
            let (d, n) = (minus(c5, c0), skin.normals.as_ref().unwrap()[usize::from(skin.faces[0][0])]);
            let p = minus(d, times(n, skin::dot(d, n)));
            assert!(length(minus(minus(c1, c0), times(p, 0.2))) < 1e-8);
        }
    }
}

#[test]
fn the_literal_construction_is_smooth_but_wild_in_general_position() {
    let options = Options { scheme: Scheme::Literal, ..Options::default() };
    let skin = ball();
    let literal = skin.solve(&Controls::default(), &options).unwrap();
    let robust = skin.smooth().unwrap();
    let wildest = |nets: &[Net]| nets.iter().flatten().map(|p| length(*p)).fold(0.0, f64::max);
    let (wild, tame) = (wildest(&literal.nets), wildest(&robust.nets));
    assert!(wild > 3.0 * tame, "{wild} {tame}");
    assert!(largest_angle(&skin, &literal.nets) < 1e-6);
    let kind = |skin: &Skin| skin.solve(&Controls::default(), &options).err().map(Refusal::kind).unwrap();
    assert_eq!(kind(&octahedron().scaled().0), "OppositeTangents");
    assert_eq!(kind(&bipyramid(5).scaled().0), "OppositeTangents");
    let case: serde_json::Value = serde_json::from_str(include_str!("data/g1.json")).unwrap();
    let tetra = &case["ok_cases"][0];
    let triple = |v: &serde_json::Value| core::array::from_fn(|c| v[c].as_f64().unwrap());
    let points: Vec<_> = tetra["vertices"].as_array().unwrap().iter().map(triple).collect();
    let corners = |f: &serde_json::Value| core::array::from_fn(|c| f[c].as_u64().unwrap() as u16);
    let faces = tetra["faces"].as_array().unwrap().iter().map(corners).collect();
    let tetra = Skin { normals: Some(points.clone()), points, faces };
    assert_eq!(kind(&tetra.scaled().0), "EqualRatios");
}

#[test]
fn sizes_and_places_do_not_matter() {
    let skin = ball();
    let nets = skin.smooth().unwrap().nets;
    for (factor, tolerance) in [(2_f64.powi(16), 1e-2), (2_f64.powi(-16), 1e-8), (1.0, 1e-8)] {
        let offset = if factor < 1.0 { [1.0e4, -3.0e5, 7.0] } else { [0.0; 3] };
        let moved = |p: skin::V3| plus(times(p, factor), offset);
        let other = Skin { points: skin.points.iter().map(|p| moved(*p)).collect(), ..skin.clone() };
        let solution = other.smooth().unwrap();
        for (a, b) in solution.nets.iter().flatten().zip(nets.iter().flatten()) {
            let error = length(minus(*a, moved(*b)));
            // The corners of the small one have 24 bits.
            assert!(error < tolerance, "{factor}: {error:e}");
        }
    }
}

#[test]
fn whole_coordinates_and_rounded_triangles() {
    let skin = octahedron();
    let points: Vec<Point3> = skin
        .points
        .iter()
        .map(|p| {
            let [x, y, z] = p.map(|c| 80 * c as i16);
            Point3::from_ints(x, y, z)
        })
        .collect();
    let links = Links::<6, 24>::new(6, Faces::Triangles(&skin.faces)).unwrap();
    let mesh = Mesh::<I16F16>::new(&points, &links).unwrap();
    let mut shifts = [Shift::NONE; 6];
    let surface = Interpolant::new(&mesh, &Controls::default(), &Options::default(), &mut shifts).unwrap();
    assert_eq!(surface.triangles().len(), 8);
    for (face, triangle) in surface.triangles().enumerate() {
        let triangle = triangle.unwrap();
        assert_eq!(surface.rounded(face).unwrap(), triangle.round().unwrap());
        for (corner, at) in skin.faces[face].iter().zip([0, 15, 20]) {
            assert_eq!(triangle.points()[at], points[usize::from(*corner)].into());
        }
    }
    let quality = surface.quality().unwrap();
    assert!(quality.max_angle_rounded() <= I32F32::from_bits(4), "{quality:?}");
}

#[test]
fn skins_are_tessellated_without_a_crack() {
    let skin = torus(7, 5).scaled().0;
    let nets = skin.smooth().unwrap().nets;
    let fixed = |p: &skin::V3| Point3::from_array(p.map(|c| I16F16::from_bits((c * 65_536.0 + 0.5).floor() as i32)));
    let patches: Vec<_> =
        nets.iter().map(|net| QuinticTriangle::new(core::array::from_fn(|i| fixed(&net[i]))).unwrap()).collect();
    let mut table = vec![PatchTopology::default(); patches.len()];
    topology(&patches, &mut table).unwrap();
    assert!(table.iter().all(|patch| (0..3).all(|edge| patch.is_joined(edge))));
    let tolerance = Tolerance::new(I16F16::from_num(0.5)).unwrap();
    let mut edges = HashMap::new();
    for triangle in tessellate(&patches, &table, tolerance).unwrap() {
        let [a, b, c] = triangle.map(|vertex| vertex.point);
        for (p, q) in [(a, b), (b, c), (c, a)] {
            *edges.entry((p, q)).or_insert(0) += 1;
        }
    }
    assert!(edges.len() > 3 * 1000);
    assert!(edges.iter().all(|((p, q), count)| *count == 1 && edges.contains_key(&(*q, *p))));
}

#[test]
fn every_error_is_reached() {
    let skin = cube();
    let points: Vec<_> = skin.points.iter().map(|p| point(times(*p, 100.0))).collect();
    let links = Links::<8, 36>::new(8, Faces::Triangles(&skin.faces)).unwrap();
    let mesh = Mesh::<I32F32>::new(&points, &links).unwrap();
    let up = [Vector3::new(I32F32::ZERO, I32F32::ZERO, I32F32::ONE); 8];
    let new = |controls: &Controls<'_>, count: usize| {
        let mut shifts = vec![Shift::NONE; count];
        Interpolant::new(&mesh, controls, &Options::default(), &mut shifts).map(|_| ()).err()
    };
    let none = Controls::default();
    let count = |list, given| Some(G1Error::Count { list, expected: 8, given });
    assert_eq!(new(&none, 7), count(List::Shifts, 7));
    assert_eq!(new(&Controls { normals: Some(&up[..3]), ..none }, 8), count(List::Normals, 3));
    let tension = [I16F16::ONE; 8];
    assert_eq!(new(&Controls { tension: Some(&tension[..1]), ..none }, 8), count(List::Tension, 1));
    let error = Some(G1Error::Tension { vertex: 0, bits: 65536 });
    assert_eq!(new(&Controls { tension: Some(&tension), ..none }, 8), error);
    let tangents = [Tangent { from: 0, to: 7, vector: up[0] }];
    assert_eq!(new(&Controls { tangents: &tangents, ..none }, 8), Some(G1Error::Tangent { index: 0 }));
    let twists = [Twist { face: 11, corner: 3, point: points[0] }];
    assert_eq!(new(&Controls { twists: &twists, ..none }, 8), Some(G1Error::Twist { index: 0 }));
    let mut normals = up;
    normals[5] = Vector3::new(I32F32::from_bits(2), I32F32::from_bits(-2), I32F32::from_bits(2));
    assert_eq!(new(&Controls { normals: Some(&normals), ..none }, 8), Some(G1Error::BadNormal { vertex: 5 }));
    // Opposite to the direction of its edge.
    let tangents =
        [Tangent { from: 0, to: 1, vector: Vector3::new(I32F32::ZERO, I32F32::ZERO, I32F32::from_num(-30)) }];
    assert_eq!(new(&Controls { tangents: &tangents, ..none }, 8), Some(G1Error::FoldedTangents { vertex: 0 }));

    let mut shifts = [Shift::NONE; 8];
    let strict = Options { strict: true, ..Options::default() };
    let surface = Interpolant::new(&mesh, &none, &strict, &mut shifts).unwrap();
    assert_eq!(surface.triangle(12).err(), Some(G1Error::Face { face: 12, faces: 12 }));
    assert_eq!(surface.is_folded(99).err(), Some(G1Error::Face { face: 99, faces: 12 }));
    let error = surface.quality().err().unwrap();
    assert!(matches!(error, G1Error::VertexInconsistent { residual, .. } if residual > 1 << 28), "{error}");
    assert!(surface.triangles().any(|triangle| triangle.is_err()));

    let quads = [[0, 1, 3, 2]];
    let links = Links::<8, 4>::new(8, Faces::Quads(&quads)).unwrap();
    let mesh = Mesh::<I32F32>::new(&points, &links).unwrap();
    let mut shifts = [Shift::NONE; 8];
    let error = Interpolant::new(&mesh, &none, &Options::default(), &mut shifts).err();
    assert_eq!(error, Some(G1Error::NotTriangle { face: 0, corners: 4 }));
}

/// The kind of the error of a skin without further controls.
fn refused(skin: &Skin) -> String {
    skin.smooth().err().map(Refusal::kind).unwrap_or_default()
}

#[test]
fn errors_of_meshes_and_ranges_are_reached() {
    let pillow = Skin { faces: vec![[0, 1, 2], [0, 2, 1]], ..ball() };
    let pillow =
        Skin { points: pillow.points[..3].to_vec(), normals: pillow.normals.map(|n| n[..3].to_vec()), ..pillow };
    assert_eq!(refused(&pillow), "NonManifoldVertex");
    let (bipyramid, _) = bipyramid(17).scaled();
    assert_eq!(refused(&bipyramid), "ValenceTooLarge");
    // A cube to the end of the range: its sides bulge beyond.
    let huge = |factor: f64| Skin { points: cube().points.iter().map(|p| times(*p, factor)).collect(), ..cube() };
    assert_eq!(refused(&huge(67_108_864.0)), "Overflow");
    let skin = huge(32767.0);
    let points: Vec<_> = skin.points.iter().map(|p| point(*p)).collect();
    let links = Links::<8, 36>::new(8, Faces::Triangles(&skin.faces)).unwrap();
    let mesh = Mesh::<I32F32>::new(&points, &links).unwrap();
    let mut shifts = [Shift::NONE; 8];
    let surface = Interpolant::new(&mesh, &Controls::default(), &Options::default(), &mut shifts).unwrap();
    assert!((0..12).any(|face| matches!(surface.rounded(face), Err(G1Error::Overflow { .. }))));
    assert!((0..12).all(|face| surface.triangle(face).is_ok()));
}
