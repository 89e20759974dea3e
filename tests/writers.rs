//! STL and OBJ files, read back by readers that others wrote.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]
#![allow(clippy::disallowed_types, clippy::float_arithmetic, reason = "what the formats hold")]

#[path = "common/audit.rs"]
mod audit;
#[path = "common/scene.rs"]
mod scene;

use audit::{joined, mesh, units};
use embedded_surfaces::geometry::Point3;
use embedded_surfaces::num::I16F16;
use embedded_surfaces::patch::{RationalTensor, sphere};
use embedded_surfaces::subdivide::{MeshBuffers, MeshVertex, write_stl, write_stl_text};
use std::io::Cursor;

type Corners = Vec<[Point3; 3]>;

fn ball() -> [RationalTensor<3, 3>; 8] {
    // No whole numbers: a third of a unit, and a radius with all fraction bits.
    sphere(Point3::from_bits(21_845, -21_845, 6_000_001), I16F16::from_bits(6_543_211)).unwrap()
}

fn corners() -> Corners {
    let ball = ball();
    mesh(&ball, &joined(&ball), 3.0).map(|t| t.map(|v| v.point)).collect()
}

fn binary(triangles: &Corners) -> Vec<u8> {
    let mut file = Vec::new();
    let count = write_stl(triangles.iter().copied(), |bytes| {
        assert!(bytes.len() <= 84);
        file.extend_from_slice(bytes);
        Ok::<(), ()>(())
    });
    assert_eq!(count, Ok(triangles.len() as u32));
    file
}

/// The nearest binary32, by the machine.
fn nearest(p: Point3) -> [f32; 3] {
    units(p).map(|c| c as f32)
}

fn assert_read_back(file: &[u8], triangles: &Corners) {
    let read: Vec<_> = stl_io::create_stl_reader(&mut Cursor::new(file)).unwrap().map(Result::unwrap).collect();
    assert_eq!(read.len(), triangles.len());
    for (read, ours) in read.iter().zip(triangles) {
        assert_eq!(read.vertices.map(|v| v.0), ours.map(nearest));
        let [a, b, c] = ours.map(units);
        let edge = |to: [f64; 3]| [0, 1, 2].map(|k: usize| to[k] - a[k]);
        let (p, q) = (edge(b), edge(c));
        let cross = [0, 1, 2].map(|k: usize| p[(k + 1) % 3] * q[(k + 2) % 3] - p[(k + 2) % 3] * q[(k + 1) % 3]);
        let length = cross.iter().map(|c| c * c).sum::<f64>().sqrt();
        for (read, exact) in read.normal.0.into_iter().zip(cross) {
            assert!((f64::from(read) - exact / length).abs() < 1.0 / 65536.0);
        }
    }
    // The reader's own check: no edge without a neighbour.
    stl_io::read_stl(&mut Cursor::new(file)).unwrap().validate().unwrap();
}

#[test]
fn binary_and_text_stl_read_back_as_the_same_triangles() {
    let triangles = corners();
    let file = binary(&triangles);
    assert_eq!(file.len(), 84 + 50 * triangles.len());
    assert_read_back(&file, &triangles);
    let mut text = String::new();
    write_stl_text("ball", triangles.iter().copied(), &mut text).unwrap();
    assert_read_back(text.as_bytes(), &triangles);
}

#[test]
fn obj_reads_back_as_the_same_mesh() {
    let ball = ball();
    let table = joined(&ball);
    let tessellation = mesh(&ball, &table, 3.0);
    let size = tessellation.size();
    let (mut vertices, mut triangles) = (vec![MeshVertex::BLANK; size.vertices], vec![[0; 3]; size.triangles]);
    let mut index = vec![0; 2 * size.index];
    let buffers = MeshBuffers { vertices: &mut vertices, triangles: &mut triangles, index: &mut index };
    let mesh = tessellation.mesh(buffers).unwrap();
    let mut text = String::new();
    mesh.write_obj(&mut text).unwrap();
    let no_materials = |_: &std::path::Path| Err(tobj::LoadError::OpenFileFailed);
    let (models, _) = tobj::load_obj_buf(&mut Cursor::new(text), &tobj::LoadOptions::default(), no_materials).unwrap();
    let [model] = &models[..] else { panic!("{} models", models.len()) };
    let expected: Vec<f32> = mesh.vertices().iter().flat_map(|v| nearest(v.point)).collect();
    assert_eq!(model.mesh.positions, expected);
    let normals = |v: &MeshVertex| v.normal.to_array().map(|c| c.to_num::<f64>() as f32);
    assert_eq!(model.mesh.normals, mesh.vertices().iter().flat_map(normals).collect::<Vec<_>>());
    assert_eq!(model.mesh.indices, mesh.triangles().as_flattened());
    assert_eq!(model.mesh.normal_indices, mesh.triangles().as_flattened());
}

#[test]
fn the_ends_of_the_range_and_flat_triangles_are_written() {
    let p = |x, y, z| Point3::from_bits(x, y, z);
    let far = 32767 << 16;
    let triangles =
        vec![[p(far, -far, 1), p(-1, 0, far - 1), p(0, 0, 0)], [p(far, far, far), p(-far, -far, -far), p(0, 0, 0)]];
    let file = binary(&triangles);
    let read: Vec<_> = stl_io::create_stl_reader(&mut Cursor::new(&file)).unwrap().map(Result::unwrap).collect();
    for (read, ours) in read.iter().zip(&triangles) {
        assert_eq!(read.vertices.map(|v| v.0), ours.map(nearest));
    }
    assert!(read[1].normal.0.iter().all(|c| c.to_bits() == 0));
    // An error of the sink comes back, and nothing is written after it.
    let mut calls = 0;
    let full = write_stl(triangles.iter().copied(), |_| {
        calls += 1;
        if calls == 2 { Err("full") } else { Ok(()) }
    });
    assert_eq!((full, calls), (Err("full"), 2));
}
