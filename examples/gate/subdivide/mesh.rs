//! Topology, tessellation and what writes meshes.

use super::super::{Digest, Sum, data, hide};
use embedded_surfaces::num::I16F16;
use embedded_surfaces::patch::{RationalTensor, RationalTriangle, Surface, SurfaceNet, Tensor, Triangle};
use embedded_surfaces::subdivide::{
    Mesh, MeshBuffers, MeshVertex, PatchTopology, Tessellation, Tolerance, tessellate, topology, write_stl,
    write_stl_text,
};

impl Digest for PatchTopology {
    fn digest(&self, sum: &mut Sum) {
        (PatchTopology::classes(self), PatchTopology::part(self)).digest(sum);
        [0, 3, 4].map(|edge| PatchTopology::is_joined(self, edge)).digest(sum);
        [PatchTopology::is_inward(self), PatchTopology::flipped(*self).is_inward()].digest(sum);
    }
}

pub(crate) fn calls(sum: &mut Sum) {
    tables(sum);
    let patches = [hide(&data::BICUBIC).surface(), hide(&data::TRIANGLE).surface(), hide(&data::OCTANT).surface()];
    let mut table = [PatchTopology::default(); 3];
    sum.add(topology(&patches, &mut table));
    sum.add(topology(&patches, &mut table[..2]));
    for (bits, count) in hide([(1 << 21, 3), (1 << 19, 1)]) {
        let table = table.get(..count).unwrap_or(&table);
        let tessellation = Tolerance::new(I16F16::from_bits(bits)).and_then(|at| tessellate(&patches, table, at));
        sum.add(tessellation.as_ref().map(|_| ()).map_err(|error| *error));
        if let Ok(tessellation) = tessellation {
            triangles(sum, &tessellation);
        }
    }
}

#[inline(never)]
fn tables(sum: &mut Sum) {
    sum.add(Triangle::topology(&[*hide(&data::TRIANGLE)]));
    sum.add(Tensor::topology(&[*hide(&data::BICUBIC), *hide(&data::BICUBIC)]));
    sum.add(RationalTriangle::topology(&[*hide(&data::WEIGHTED)]));
    sum.add(RationalTensor::topology(&[*hide(&data::OCTANT)]));
    sum.add(PatchTopology::of_nets(&[hide(&data::OCTANT).surface(), hide(&data::TRIANGLE).surface()]));
}

#[inline(never)]
fn triangles(sum: &mut Sum, tessellation: &Tessellation<'_, SurfaceNet<'_>>) {
    for triangle in tessellation.clone().take(60) {
        sum.add(triangle.map(|vertex| ([vertex.point.x, vertex.point.y, vertex.point.z], vertex.patch)));
        sum.add(triangle.map(|vertex| vertex.parameters.map(|p| (p.numerator(), p.denominator()))));
    }
    let size = Tessellation::size(tessellation);
    sum.add([size.vertices, size.triangles, size.index]);
    let (mut vertices, mut faces, mut index) = ([MeshVertex::BLANK; 150], [[0; 3]; 260], [0; 600]);
    let buffers = MeshBuffers { vertices: &mut vertices[..3], triangles: &mut faces, index: &mut index };
    sum.add(Tessellation::mesh(tessellation, buffers).map(|_| ()));
    let buffers = MeshBuffers { vertices: &mut vertices, triangles: &mut faces, index: &mut index };
    let mesh = Tessellation::mesh(tessellation, buffers);
    sum.add(mesh.as_ref().map(|_| ()).map_err(|error| *error));
    if let Ok(mesh) = mesh {
        written(sum, &mesh);
    }
}

#[inline(never)]
fn written(sum: &mut Sum, mesh: &Mesh<'_>) {
    for vertex in Mesh::vertices(mesh).iter().take(50) {
        sum.add((vertex.point, vertex.normal));
    }
    sum.add(Mesh::triangles(mesh));
    let failed = |result: core::fmt::Result| result.is_err();
    let done = failed(Mesh::write_obj(mesh, sum));
    sum.add(done);
    let done = failed(write_stl_text("gate", Mesh::corners(mesh), sum));
    sum.add(done);
    let bytes = write_stl(Mesh::corners(mesh), |bytes| {
        sum.add(bytes);
        Ok::<(), core::fmt::Error>(())
    });
    sum.add(bytes);
}
