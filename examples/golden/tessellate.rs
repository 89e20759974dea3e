//! `golden tessellate`: the indexed mesh of patches to a tolerance.

use crate::case::Patch;
use crate::field::{Field, Malformed};
use crate::{Answer, typed_error};
use embedded_surfaces::num::I16F16;
use embedded_surfaces::patch::{Parameter, SurfaceNet};
use embedded_surfaces::reference::fixed_half_up;
use embedded_surfaces::subdivide::{
    MeshBuffers, MeshVertex, PatchTopology, SubdivideError, Tessellation, Tolerance, tessellate, topology,
};
use serde_json::{Map, Value};

/// A tolerance in units; what is larger than any coordinate is as good as the largest.
fn tolerance(field: &Field<'_>) -> Result<I16F16, Malformed> {
    let number = field.number()?.clamp(-32767.0, 32767.0);
    fixed_half_up(number).ok_or_else(|| field.malformed("is not a tolerance"))
}

fn number(parameter: Parameter) -> Value {
    (f64::from(parameter.numerator()) / f64::from(parameter.denominator())).into()
}

fn list(items: impl IntoIterator<Item = Value>) -> Value {
    Value::Array(items.into_iter().collect())
}

/// `[patch, [u, v], [u, v], [u, v]]` of each triangle, in the order of the mesh.
fn corners(tessellation: Tessellation<'_, SurfaceNet<'_>>) -> Value {
    list(tessellation.map(|corners| {
        let parameters = corners.map(|vertex| list(vertex.parameters.map(number)));
        list(core::iter::once(corners[0].patch.into()).chain(parameters))
    }))
}

fn mesh(nets: &[SurfaceNet<'_>], tolerance: I16F16) -> Result<Map<String, Value>, SubdivideError> {
    let mut table = vec![PatchTopology::default(); nets.len()];
    topology(nets, &mut table)?;
    let tessellation = tessellate(nets, &table, Tolerance::new(tolerance)?)?;
    let size = tessellation.size();
    let (mut vertices, mut triangles) = (vec![MeshVertex::BLANK; size.vertices], vec![[0; 3]; size.triangles]);
    let mut index = vec![0; 2 * size.index];
    let buffers = MeshBuffers { vertices: &mut vertices, triangles: &mut triangles, index: &mut index };
    let mesh = tessellation.mesh(buffers)?;
    let place = |vertex: &MeshVertex| list(vertex.point.to_array().map(|c| c.to_num::<f64>().into()));
    Ok(Map::from_iter([
        ("status".to_owned(), "ok".into()),
        ("vertices".to_owned(), list(mesh.vertices().iter().map(place))),
        ("triangles".to_owned(), list(mesh.triangles().iter().map(|t| t.to_vec().into()))),
        ("corners".to_owned(), corners(tessellation)),
    ]))
}

pub(crate) fn run(case: &Field<'_>) -> Answer {
    let tolerance = tolerance(&case.need("tolerance")?)?;
    let patches = Patch::read_all(case)?;
    let points = patches.iter().map(Patch::fixed_points).collect::<Result<Vec<_>, _>>()?;
    let mut nets = Vec::new();
    for (patch, points) in patches.iter().zip(&points) {
        nets.push(patch.net(points, patch.weights()).map_err(|error| Malformed::new("patches", &error.to_string()))?);
    }
    Ok(mesh(&nets, tolerance).unwrap_or_else(|error| typed_error(&error)))
}
