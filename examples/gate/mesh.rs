//! Meshes: links, faces, half-edges, rings, normals, and errors.

#[path = "../data/cube.rs"]
mod cube;

use super::{Digest, Sum, hide};
pub(super) use cube::TRIANGLES;
use embedded_surfaces::geometry::Point3;
use embedded_surfaces::mesh::{Faces, HalfEdge, Links, Mesh, Spoke};
use embedded_surfaces::num::{Coord, I16F16, I32F32};

pub(super) const CUBE: [[i16; 3]; 8] = [
    [-40, -40, -40],
    [-40, -40, 40],
    [-40, 40, -40],
    [-40, 40, 40],
    [40, -40, -40],
    [40, -40, 40],
    [40, 40, -40],
    [40, 40, 40],
];
const QUADS: [[u16; 4]; 2] = [[0, 1, 3, 2], [0, 4, 5, 1]];
const CORNERS: [u16; 7] = [0, 1, 3, 2, 0, 4, 1];

impl Digest for HalfEdge {
    fn digest(&self, sum: &mut Sum) {
        HalfEdge::index(*self).digest(sum);
    }
}

impl Digest for Spoke {
    fn digest(&self, sum: &mut Sum) {
        (self.to, self.left).digest(sum);
    }
}

pub(super) fn calls(sum: &mut Sum) {
    let points = hide(CUBE).map(|[x, y, z]| Point3::<I16F16>::from_ints(x, y, z));
    let fine = points.map(Point3::<I32F32>::from);
    for faces in hide([
        Faces::Triangles(&TRIANGLES),
        Faces::Quads(&QUADS),
        Faces::Polygons { corners: &CORNERS, ends: &[4, 7] },
        Faces::Polygons { corners: &CORNERS, ends: &[4, 8] },
        Faces::Triangles(&[[0, 1, 2], [0, 1, 3]]),
        Faces::Triangles(&[[0, 1, 2], [0, 3, 4]]),
        Faces::Triangles(&[[0, 1, 1]]),
        Faces::Triangles(&[[0, 1, 8]]),
    ]) {
        sum.add([Faces::len(&faces), Faces::half_edges(&faces), Faces::is_empty(&faces).into()]);
        sum.add([0, 1, 99].map(|face| Faces::corners(&faces, face)));
        let links = Links::<8, 36>::new(8, faces);
        sum.add(links.as_ref().map(|links| Links::faces(links).len()).map_err(|error| *error));
        if let Ok(links) = links {
            answers(sum, Mesh::<I16F16>::new(&points, &links).as_ref().map_err(|error| *error));
            answers(sum, Mesh::<I32F32>::new(&fine, &links).as_ref().map_err(|error| *error));
            sum.add(Mesh::<I16F16>::new(&points[..7], &links).map(|_| ()));
            let mut other = points;
            other[1] = other[0];
            sum.add(Mesh::<I16F16>::new(&other, &links).map(|_| ()));
            other[3].y = hide(I16F16::MIN);
            sum.add(Mesh::<I16F16>::new(&other, &links).map(|_| ()));
        }
    }
}

#[inline(never)]
fn answers<C: Coord + Digest>(sum: &mut Sum, mesh: Result<&Mesh<'_, C>, embedded_surfaces::mesh::MeshError>) {
    let Ok(mesh) = mesh else { return };
    sum.add([Mesh::half_edges(mesh), Mesh::points(mesh).len(), Mesh::faces(mesh).len()]);
    for number in 0..Mesh::half_edges(mesh) {
        let half_edge = HalfEdge::new(hide(number as u16));
        sum.add([Mesh::origin(mesh, half_edge), Mesh::tip(mesh, half_edge), Mesh::face(mesh, half_edge)]);
        sum.add([Mesh::next(mesh, half_edge), Mesh::previous(mesh, half_edge)]);
        sum.add(Mesh::twin(mesh, half_edge));
    }
    for vertex in 0..=hide(8) {
        sum.add((Mesh::leaving(mesh, vertex), Mesh::is_border(mesh, vertex)));
        sum.add(Mesh::valence(mesh, vertex));
        Mesh::spokes(mesh, vertex).for_each(|spoke| sum.add(spoke));
        sum.add(Mesh::normal(mesh, vertex));
    }
}
