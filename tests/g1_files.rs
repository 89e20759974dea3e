//! The readers of OBJ and STL files of the host tools: good files, and a clear error for each kind of bad one.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]
#![allow(clippy::disallowed_types, clippy::float_arithmetic, clippy::float_cmp, reason = "what the formats hold")]

#[path = "../examples/data/mesh_file.rs"]
mod mesh_file;
#[path = "../examples/data/polyhedra.rs"]
mod polyhedra;

use embedded_surfaces::geometry::Point3;
use embedded_surfaces::mesh::{Faces, Links, Mesh};
use embedded_surfaces::num::I16F16;
use embedded_surfaces::subdivide::write_stl;
use mesh_file::{FileError, Polyhedron, read};
use std::path::PathBuf;

fn file(name: &str, bytes: &[u8]) -> PathBuf {
    let path = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(name);
    std::fs::write(&path, bytes).unwrap();
    path
}

const TETRAHEDRON: &str = "# four faces\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n\
    f 1 3 2\nf 1/1/1 2/1/1 4/1/1\nf 2//3 3//3 4//3\nf -2 -4 -1\n";

#[test]
fn models_are_meshes() {
    for model in [polyhedra::icosahedron(), polyhedra::torus(9, 6), polyhedra::duck()] {
        let points: Vec<_> = model
            .points
            .iter()
            .map(|p| {
                let [x, y, z] = p.map(|c| I16F16::from_num(100.0 * c));
                Point3::new(x, y, z)
            })
            .collect();
        let links = Links::<100, 600>::new(points.len(), Faces::Triangles(&model.faces)).unwrap();
        let mesh = Mesh::<I16F16>::new(&points, &links).unwrap();
        assert!((0..points.len()).all(|v| !mesh.is_border(v)));
        // Outward: six times the volume is positive.
        let volume: f64 = model
            .faces
            .iter()
            .map(|f| {
                let [a, b, c] = f.map(|v| model.points[usize::from(v)]);
                a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0])
                    + a[2] * (b[0] * c[1] - b[1] * c[0])
            })
            .sum();
        assert!(volume > 1.0, "{volume}");
    }
}

#[test]
fn obj_files_are_read() {
    let Polyhedron { points, faces } = read(&file("good.obj", TETRAHEDRON.as_bytes())).unwrap();
    assert_eq!(points, [[0., 0., 0.], [0., 1., 0.], [1., 0., 0.], [0., 0., 1.]]);
    assert_eq!(faces.len(), 4);
    let links = Links::<4, 12>::new(4, Faces::Triangles(&faces)).unwrap();
    assert_eq!(links.faces().len(), 4);
}

#[test]
fn corners_of_stl_files_are_joined() {
    let duck = polyhedra::duck();
    let corners = duck
        .faces
        .iter()
        .map(|face| face.map(|v| Point3::from_array(duck.points[usize::from(v)].map(|c| I16F16::from_num(64.0 * c)))));
    let mut bytes = Vec::new();
    write_stl(corners, |part| {
        bytes.extend_from_slice(part);
        Ok::<(), ()>(())
    })
    .unwrap();
    let Polyhedron { points, faces } = read(&file("duck.stl", &bytes)).unwrap();
    assert_eq!((points.len(), faces.len()), (duck.points.len(), duck.faces.len()));
    assert!(Links::<100, 600>::new(points.len(), Faces::Triangles(&faces)).is_ok());
}

#[test]
fn bad_files_are_errors_that_say_what_is_wrong() {
    let error = |name: &str, text: &str| read(&file(name, text.as_bytes())).unwrap_err();
    assert!(matches!(error("bad.ply", ""), FileError::Kind));
    assert!(matches!(error("empty.obj", "# nothing\n"), FileError::Empty));
    assert!(matches!(error("quad.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n"), FileError::NotTriangles));
    let nan = error("nan.obj", "v 0 0 0\nv 1 NaN 0\nv 1 1 0\nf 1 2 3\n");
    assert!(matches!(nan, FileError::Coordinate { vertex: 1 }), "{nan}");
    for (name, text) in
        [("index.obj", "v 0 0 0\nf 1 2 3\n"), ("cut.stl", "solid x\nfacet"), ("word.obj", "v 0 zero 0\n")]
    {
        let error = error(name, text);
        assert!(matches!(error, FileError::Unreadable(_)) && error.to_string().len() > 8, "{error}");
    }
    let missing = read(&PathBuf::from("no/such/file.stl")).unwrap_err();
    assert!(matches!(missing, FileError::Unreadable(_)), "{missing}");
}
