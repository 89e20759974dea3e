//! Meshes of few points and many faces, manifold or not, with wild normals, tangents and tensions: links, meshes and skins
//! do not panic, and what comes out has neighbours with the same bits along their edge.
#![no_main]

#[path = "../../examples/data/cube.rs"]
mod cube;

use arbitrary::{Result, Unstructured};
use embedded_surfaces::g1::{Controls, Interpolant, Lengths, Options, Scheme, Shift, Tangent, Twist};
use embedded_surfaces::geometry::{Point3, Vector3};
use embedded_surfaces::mesh::{Faces, HalfEdge, Links, Mesh};
use embedded_surfaces::num::{I16F16, I32F32};

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    // Short input is an `Err` of `arbitrary`, which is fine.
    let _ = run(&mut Unstructured::new(bytes));
});

/// Closed and open meshes to begin with: random faces are hardly ever manifold.
const SHAPES: [&[[u16; 3]]; 5] = [
    &[[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]],
    &[[0, 1, 2], [1, 3, 2], [3, 4, 2], [4, 0, 2], [1, 0, 5], [3, 1, 5], [4, 3, 5], [0, 4, 5]],
    &[[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 5], [0, 5, 6], [0, 6, 1]],
    &[[0, 1, 2], [2, 1, 3], [2, 3, 4], [4, 3, 5], [4, 5, 6], [6, 5, 7]],
    &cube::TRIANGLES,
];

fn number(u: &mut Unstructured<'_>) -> Result<I32F32> {
    let shift = u.int_in_range(5..=62)?;
    Ok(I32F32::from_bits(u.arbitrary::<i64>()? >> shift))
}

fn triple(u: &mut Unstructured<'_>) -> Result<[I32F32; 3]> {
    Ok([number(u)?, number(u)?, number(u)?])
}

fn run(u: &mut Unstructured<'_>) -> Result<()> {
    let mut faces = u.choose(&SHAPES)?.to_vec();
    for _ in 0..u.int_in_range(0..=3)? {
        let face = [u.int_in_range(0..=9)?, u.int_in_range(0..=9)?, u.int_in_range(0..=9)?];
        if u.arbitrary()? {
            faces.push(face);
        } else {
            faces.pop();
        }
    }
    let count = u.int_in_range(6..=10)?;
    let points = (0..count).map(|_| Ok(Point3::from_array(triple(u)?))).collect::<Result<Vec<_>>>()?;
    let Ok(links) = Links::<10, 60>::new(count, Faces::Triangles(&faces)) else { return Ok(()) };
    let Ok(mesh) = Mesh::<I32F32>::new(&points, &links) else { return Ok(()) };
    let normals = (0..count).map(|_| Ok(Vector3::from_array(triple(u)?))).collect::<Result<Vec<_>>>()?;
    let tension = (0..count).map(|_| Ok(I16F16::from_bits(u.arbitrary::<i32>()? >> 15))).collect::<Result<Vec<_>>>()?;
    let vertex = |u: &mut Unstructured<'_>| u.int_in_range(0..=9);
    let tangents = [Tangent { from: vertex(u)?, to: vertex(u)?, vector: Vector3::from_array(triple(u)?) }];
    let twists = [Twist { face: vertex(u)?, corner: 1, point: Point3::from_array(triple(u)?) }];
    let controls = Controls {
        normals: u.arbitrary::<bool>()?.then_some(normals.as_slice()),
        tension: u.ratio(1, 4)?.then_some(tension.as_slice()),
        tangents: if u.ratio(1, 4)? { &tangents } else { &[] },
        twists: if u.ratio(1, 4)? { &twists } else { &[] },
    };
    let options = Options {
        scheme: *u.choose(&[Scheme::Smooth, Scheme::Smooth, Scheme::PointNormal, Scheme::Flat, Scheme::Literal])?,
        lengths: *u.choose(&[Lengths::Arc, Lengths::Projected])?,
        strict: u.arbitrary()?,
        ..Options::default()
    };
    let mut shifts = vec![Shift::NONE; count];
    let Ok(surface) = Interpolant::new(&mesh, &controls, &options, &mut shifts) else { return Ok(()) };
    let _ = surface.quality();
    let triangles: Vec<_> = surface.triangles().collect();
    for (face, triangle) in triangles.iter().enumerate() {
        let _ = (surface.rounded(face), surface.is_folded(face));
        let Ok(triangle) = triangle else { continue };
        for c in 0..3 {
            let Some(twin) = mesh.twin(HalfEdge::new((3 * face + c) as u16)) else { continue };
            let Some(Ok(other)) = triangles.get(mesh.face(twin)) else { continue };
            let row = |c: usize, i: usize| match c {
                0 => [5 - i, i, 0],
                1 => [0, 5 - i, i],
                _ => [i, 0, 5 - i],
            };
            for i in 0..=5 {
                let ([a, b, d], [e, f, g]) = (row(c, i), row(twin.index() % 3, 5 - i));
                assert_eq!(triangle.point(a, b, d), other.point(e, f, g));
            }
        }
    }
    Ok(())
}
