//! `golden intersect`: the curves in which two patches meet.

use crate::case::Patch;
use crate::field::{Field, Malformed};
use crate::workspace::{Workspace, name};
use crate::{Answer, typed_error};
use embedded_surfaces::geometry::{Point3, Vector3};
use embedded_surfaces::intersect::{
    Branch, Curve, CurvePoint, End, I2F30, I16F48, I20F44, IntersectError, Intersection, Options, Room, Side, intersect,
};
use embedded_surfaces::patch::SurfaceNet;
use serde_json::{Map, Value, json};

/// Cells of the grids are 1/64 of a patch.
const DEPTH: u32 = 6;

fn space(c: I20F44) -> f64 {
    c.to_bits() as f64 / (1_u64 << 44) as f64
}

fn unit(c: I2F30) -> f64 {
    f64::from(c.to_bits()) / f64::from(1 << 30)
}

fn parameter(c: I16F48) -> f64 {
    c.to_bits() as f64 / (1_u64 << 48) as f64
}

fn place(p: &CurvePoint) -> Value {
    json!(p.parameters.as_flattened().iter().map(|c| parameter(*c)).collect::<Vec<_>>())
}

fn position(p: Point3<I20F44>) -> Value {
    json!(p.to_array().map(space))
}

fn direction(v: Vector3<I2F30>) -> Value {
    json!(v.to_array().map(unit))
}

fn point(p: &CurvePoint) -> Value {
    json!({"uvst": place(p), "xyz": position(p.position), "tangent": direction(p.tangent)})
}

fn number(side: Side) -> u8 {
    match side {
        Side::A => 0,
        Side::B => 1,
    }
}

fn end(end: End) -> Value {
    match end {
        End::Edge { side, edge } => json!([number(side), edge]),
        End::Corner { side, corner } => json!(["corner", number(side), corner]),
        End::Branch { branch } => json!(["branch", branch]),
        _ => Value::Null,
    }
}

fn component(result: &Intersection<'_>, curve: &Curve) -> Value {
    let ends = if curve.ends == [End::None; 2] { Value::Null } else { json!(curve.ends.map(end)) };
    json!({
        "kind": name(curve.kind),
        "closed": curve.closed,
        "length": space(curve.length),
        "min_sin": unit(curve.min_sine),
        "max_residual": space(curve.residual),
        "ends": ends,
        "unrefined": curve.unrefined,
        "points": result.points(curve).iter().map(point).collect::<Vec<_>>(),
    })
}

fn branch(b: &Branch) -> Value {
    json!({"xyz": position(b.point.position), "uvst": place(&b.point), "arms": b.arms()})
}

fn answer(result: &Intersection<'_>) -> Map<String, Value> {
    let components: Vec<_> = result.curves().iter().map(|curve| component(result, curve)).collect();
    let branches: Vec<_> = result.branches().iter().map(branch).collect();
    Map::from_iter([
        ("status".to_owned(), "ok".into()),
        ("components".to_owned(), components.into()),
        ("branches".to_owned(), branches.into()),
        ("certified".to_owned(), result.is_certified().into()),
        ("undecided".to_owned(), result.undecided.into()),
        ("zero_predicates".to_owned(), result.zero_predicates.into()),
        ("perturbation_sensitive".to_owned(), result.perturbation_sensitive.into()),
        ("degenerate_triangles".to_owned(), result.degenerate_triangles.into()),
    ])
}

/// The answer, with buffers that grow until they are large enough.
fn run_nets(a: SurfaceNet<'_>, b: SurfaceNet<'_>) -> Result<Map<String, Value>, IntersectError> {
    let options = Options::DEFAULT.with_depth(DEPTH);
    let room = Room::new(a, b, DEPTH)?;
    let (mut segments, mut points, mut curves) = (1 << 14, 1 << 13, 1 << 6);
    loop {
        let mut workspace = Workspace::new(&room, segments, points, curves);
        match intersect(a, b, &options, workspace.buffers()) {
            Ok(result) => return Ok(answer(&result)),
            Err(IntersectError::SegmentBuffer { .. }) if segments < 1 << 20 => segments *= 4,
            Err(IntersectError::Buffer { .. }) if points < 1 << 20 => (points, curves) = (4 * points, 4 * curves),
            Err(error) => return Err(error),
        }
    }
}

pub(crate) fn run(case: &Field<'_>) -> Answer {
    let patches = [Patch::read(&case.need("A")?)?, Patch::read(&case.need("B")?)?];
    let [a, b] = [patches[0].fixed_points()?, patches[1].fixed_points()?];
    let named = |name: &str, error: &dyn std::fmt::Display| Malformed::new(name, &error.to_string());
    let a = patches[0].net(&a, patches[0].weights()).map_err(|error| named("A", &error))?;
    let b = patches[1].net(&b, patches[1].weights()).map_err(|error| named("B", &error))?;
    Ok(run_nets(a, b).unwrap_or_else(|error| typed_error(&error)))
}
