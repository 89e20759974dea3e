//! Meshes against brute force over their faces, and every error.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]
#![allow(clippy::disallowed_types, clippy::float_arithmetic, clippy::float_cmp, reason = "an oracle in f64")]

#[path = "common/families.rs"]
mod families;
#[path = "common/skin.rs"]
mod skin;

use embedded_surfaces::geometry::{Axis, Point3};
use embedded_surfaces::mesh::{Faces, HalfEdge, Links, MAX_VALENCE, Mesh, MeshError};
use embedded_surfaces::num::{I16F16, I32F32};
use embedded_surfaces::{const_mesh, num::Coord};
use families::Dice;
use std::collections::BTreeSet;

/// What every mesh must be.
fn check<C: Coord>(mesh: &Mesh<'_, C>) {
    let faces: Vec<_> = (0..mesh.faces().len()).map(|f| mesh.faces().corners(f).unwrap().to_vec()).collect();
    let mut h = 0;
    for (f, face) in faces.iter().enumerate() {
        for (c, corner) in face.iter().enumerate() {
            let half_edge = HalfEdge::new(h);
            let next = face[(c + 1) % face.len()];
            assert_eq!((mesh.face(half_edge), mesh.origin(half_edge)), (f, usize::from(*corner)));
            assert_eq!(mesh.tip(half_edge), usize::from(next));
            assert_eq!(mesh.previous(mesh.next(half_edge)), half_edge);
            assert_eq!(mesh.origin(mesh.next(half_edge)), mesh.tip(half_edge));
            let back =
                |face: &Vec<u16>| (0..face.len()).any(|i| (face[i], face[(i + 1) % face.len()]) == (next, *corner));
            let twin = mesh.twin(half_edge);
            assert_eq!(twin.is_some(), faces.iter().any(back));
            if let Some(twin) = twin {
                assert_eq!((mesh.twin(twin), mesh.origin(twin)), (Some(half_edge), mesh.tip(half_edge)));
            }
            h += 1;
        }
    }
    assert_eq!(usize::from(h), mesh.half_edges());
    for v in 0..mesh.points().len() {
        let around: BTreeSet<_> = faces.iter().filter(|face| face.contains(&(v as u16))).collect();
        let spokes: Vec<_> = mesh.spokes(v).collect();
        let sectors: Vec<_> = spokes.iter().filter_map(|spoke| spoke.left).collect();
        assert_eq!((sectors.len(), mesh.valence(v)), (around.len(), spokes.len()));
        assert_eq!(mesh.is_border(v), spokes.len() > sectors.len());
        for (i, half_edge) in sectors.iter().enumerate() {
            assert_eq!((mesh.origin(*half_edge), mesh.tip(*half_edge)), (v, spokes[i].to));
            // Counter-clockwise: the face's edge back comes from the next spoke.
            assert_eq!(mesh.origin(mesh.previous(*half_edge)), spokes[(i + 1) % spokes.len()].to);
        }
    }
}

#[test]
fn random_meshes_agree_with_brute_force() {
    for (_, skin) in families::all(3, 28) {
        let points: Vec<_> = skin.points.iter().map(|p| skin::point(*p)).collect();
        match Links::<200, 1200>::new(points.len(), Faces::Triangles(&skin.faces)) {
            Ok(links) => check(&Mesh::<I32F32>::new(&points, &links).unwrap()),
            Err(error) => assert!(matches!(error, MeshError::NonManifoldVertex { .. }), "{error}"),
        }
    }
}

/// A grid of quadrilaterals with one of them cut in two, in three ways to say it.
#[test]
fn polygons_of_all_kinds_are_meshes() {
    let points: Vec<_> = (0..16).map(|i| Point3::from_ints(10 * (i % 4), 10 * (i / 4), 0)).collect();
    let quads: Vec<[u16; 4]> = (0..9).map(|i| i / 3 * 4 + i % 3).map(|i| [i, i + 1, i + 5, i + 4]).collect();
    let links = Links::<16, 36>::new(16, Faces::Quads(&quads)).unwrap();
    let mesh = Mesh::<I16F16>::new(&points, &links).unwrap();
    check(&mesh);
    assert_eq!((mesh.valence(5), mesh.is_border(5), mesh.valence(0)), (4, false, 2));
    let corners: Vec<u16> = quads[1..].iter().flatten().copied().chain([0, 1, 5, 0, 5, 4]).collect();
    let ends: Vec<u16> = (1..=8).map(|i| 4 * i).chain([35, 38]).collect();
    let links = Links::<20, 40>::new(16, Faces::Polygons { corners: &corners, ends: &ends }).unwrap();
    let mesh = Mesh::<I16F16>::new(&points, &links).unwrap();
    check(&mesh);
    assert_eq!((mesh.valence(5), mesh.valence(0), mesh.faces().len()), (5, 3, 10));
}

static POINTS: [Point3; 4] =
    [Point3::from_ints(0, 0, 0), Point3::from_ints(9, 0, 0), Point3::from_ints(0, 9, 0), Point3::from_ints(0, 0, 9)];
const FACES: [[u16; 3]; 4] = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
static LINKS: Links<'_, 4, 12> = const_mesh!(Links::new(4, Faces::Triangles(&FACES)));
static TETRAHEDRON: Mesh<'_> = const_mesh!(Mesh::<I16F16>::new(&POINTS, &LINKS));

#[test]
fn meshes_in_flash_are_not_copied() {
    check(&TETRAHEDRON);
    assert!(core::ptr::eq(TETRAHEDRON.points().as_ptr(), POINTS.as_ptr()));
    assert_eq!(size_of::<Links<'_, 200, 1188>>() - size_of::<Links<'_, 0, 0>>(), 2 * (200 + 1188));
}

#[test]
fn every_error_names_its_place() {
    let triangles = |vertices: usize, faces: &[[u16; 3]]| Links::<4, 12>::new(vertices, Faces::Triangles(faces)).err();
    let polygons = |corners: &[u16], ends: &[u16]| Links::<4, 12>::new(4, Faces::Polygons { corners, ends }).err();
    let many = [[0, 1, 2]; 5];
    let cases = [
        (triangles(5, &FACES), MeshError::TooManyVertices { given: 5, limit: 4 }),
        (triangles(4, &many), MeshError::TooManyHalfEdges { given: 15, limit: 12 }),
        (triangles(4, &[[0, 1, 2], [1, 3, 1]]), MeshError::DegenerateFace { face: 1 }),
        (triangles(3, &[[0, 1, 3]]), MeshError::Index { face: 0, vertex: 3, vertices: 3 }),
        (triangles(4, &[[0, 1, 2], [0, 1, 3]]), MeshError::NonManifoldEdge { edge: [0, 1] }),
        (polygons(&[0, 1], &[2]), MeshError::DegenerateFace { face: 0 }),
        (polygons(&[0, 1, 2], &[4]), MeshError::Corners { face: 0, end: 4, corners: 3 }),
        (polygons(&[0, 1, 2, 3], &[3]), MeshError::Corners { face: 0, end: 3, corners: 4 }),
        (polygons(&[0, 1, 2, 3], &[4, 3]), MeshError::Corners { face: 1, end: 3, corners: 4 }),
    ];
    for (result, expected) in cases {
        assert_eq!(result, Some(expected));
    }
    // Two fans that share a point.
    let bow = Links::<5, 6>::new(5, Faces::Triangles(&[[0, 1, 2], [0, 3, 4]])).err();
    assert_eq!(bow, Some(MeshError::NonManifoldVertex { vertex: 0 }));
    // Two cycles that share a point.
    let lower = FACES.map(|f| f.map(|v| if v == 0 { 0 } else { v + 3 }));
    let cones = Links::<7, 24>::new(7, Faces::Triangles(&[FACES, lower].concat())).err();
    assert_eq!(cones, Some(MeshError::NonManifoldVertex { vertex: 0 }));
    let wheel: Vec<_> = (0..65).map(|i| [0, i + 1, (i + 1) % 65 + 1]).collect();
    let links = Links::<66, 195>::new(66, Faces::Triangles(&wheel)).err();
    assert_eq!(links, Some(MeshError::ValenceTooLarge { vertex: 0, valence: 65, limit: MAX_VALENCE }));

    let mesh = |points: &[Point3]| Mesh::<I16F16>::new(points, &LINKS).err();
    assert_eq!(mesh(&POINTS[1..]), Some(MeshError::Count { expected: 4, given: 3 }));
    let mut points = POINTS;
    points[3] = points[1];
    assert_eq!(mesh(&points), Some(MeshError::ZeroEdge { edge: [1, 3] }));
    points[2].y = I16F16::MIN;
    let limit = 32767;
    assert_eq!(mesh(&points), Some(MeshError::OutOfRange { vertex: 2, axis: Axis::Y, units: -32768, limit }));
    for error in cases.iter().map(|(_, error)| error) {
        assert!(!error.to_string().ends_with('.'));
    }
}

#[test]
fn normals_are_weighted_by_angles() {
    let mut dice = Dice(9);
    let skin = families::sphere(&mut dice, 30);
    let points: Vec<_> = skin.points.iter().map(|p| skin::point(skin::times(*p, 100.0))).collect();
    let links = Links::<30, 180>::new(30, Faces::Triangles(&skin.faces)).unwrap();
    let mesh = Mesh::<I32F32>::new(&points, &links).unwrap();
    for v in 0..30 {
        let mut sum = [0.0; 3];
        for face in &skin.faces {
            for c in 0..3 {
                let [a, b, d] = [0, 1, 2].map(|k| skin::float(points[usize::from(face[(c + k) % 3])]));
                let (p, q) = (skin::minus(b, a), skin::minus(d, a));
                let normal = skin::cross(p, q);
                if usize::from(face[c]) == v {
                    let angle = skin::length(normal).atan2(skin::dot(p, q));
                    sum = skin::plus(sum, skin::times(skin::unit(normal), angle));
                }
            }
        }
        let ours = mesh.normal(v).unwrap().to_array().map(|c| c.to_bits() as f64 / 4_294_967_296.0);
        let error = skin::length(skin::minus(ours, skin::unit(sum)));
        assert!(error < 2_f64.powi(-28), "{v}: {error:e}");
    }
    assert_eq!(mesh.normal(30), None);
    // Back to back: they cancel out.
    let links = Links::<3, 6>::new(3, Faces::Triangles(&[[0, 1, 2], [0, 2, 1]])).unwrap();
    assert_eq!(Mesh::<I32F32>::new(&points[..3], &links).unwrap().normal(0), None);
}
