//! `golden g1`: quintic triangles over a triangle mesh.
//!
//! Without `scale` the coordinates are multiplied by the power of two that brings the mesh to an extent of 2^8 to 2^9, and
//! the control points printed are divided by it again: exactly, so they have more fraction bits than an `I32F32`. With
//! `scale` the result stays at that size.

use crate::field::{Field, Malformed};
use crate::{Answer, typed_error};
use embedded_surfaces::g1::{Controls, G1Error, Interpolant, Lengths, Options, Quality, Scheme, Shift, Tangent};
use embedded_surfaces::geometry::{Point3, Vector3};
use embedded_surfaces::mesh::{Faces, Links, Mesh};
use embedded_surfaces::num::{Coord, I32F32};
use embedded_surfaces::patch::Triangle;
use serde_json::{Map, Value};

/// Room for the meshes of case files.
const VERTICES: usize = 4096;
const HALF_EDGES: usize = 6 * VERTICES;

/// The nearest `I32F32`, half up; `None` outside the legal range.
fn fixed(number: f64) -> Option<I32F32> {
    // Exact: halves of the last place are whole multiples of 2^-33, which is not so beyond 2^52 and not needed there.
    let scaled = number * 4_294_967_296.0;
    let floor = scaled.floor();
    let bits = if scaled - floor >= 0.5 { floor + 1.0 } else { floor };
    (bits.abs() < 9.0e18).then(|| I32F32::from_bits(bits as i64)).filter(|c| c.is_legal())
}

fn vector(field: &Field<'_>, scale: f64) -> Result<[I32F32; 3], Malformed> {
    let coordinate = |field: &Field<'_>| {
        let number = field.number()?;
        let what = || field.malformed(&format!("{number} times {scale} is outside -2^26 ..= 2^26"));
        fixed(number * scale).ok_or_else(what)
    };
    let [x, y, z] = field.fixed()?;
    Ok([coordinate(&x)?, coordinate(&y)?, coordinate(&z)?])
}

/// A factor that is a power of two.
fn power_of_two(field: &Field<'_>) -> Result<f64, Malformed> {
    let number = field.number()?;
    let is_power = number > 0.0 && number.log2().fract() == 0.0 && number.log2().abs() <= 64.0;
    if is_power { Ok(number) } else { Err(field.malformed(&format!("{number} is not a power of two"))) }
}

/// The power of two that brings the largest side of the vertices' box to 2^8 or more, but not to 2^9.
fn natural_scale(vertices: &[[f64; 3]]) -> f64 {
    let side = |c: usize| {
        let range = vertices.iter().fold((f64::MAX, f64::MIN), |(low, high), v| (low.min(v[c]), high.max(v[c])));
        range.1 - range.0
    };
    let extent = (0..3).map(side).fold(0.0, f64::max);
    if extent > 0.0 { (8.0 - extent.log2().floor()).clamp(-64.0, 64.0).exp2() } else { 1.0 }
}

struct Case {
    points: Vec<Point3<I32F32>>,
    /// Corners of all faces, and where each face ends.
    corners: Vec<u16>,
    ends: Vec<u16>,
    normals: Option<Vec<Vector3>>,
    tangents: Vec<Tangent>,
    options: Options,
    /// What printed coordinates are divided by.
    divisor: f64,
}

fn index(field: &Field<'_>) -> Result<u16, Malformed> {
    Ok(field.whole(0..=u32::from(u16::MAX) - 1)? as u16)
}

fn flag(field: &Field<'_>) -> Result<bool, Malformed> {
    field.value().as_bool().ok_or_else(|| field.malformed("is neither true nor false"))
}

fn options(case: &Field<'_>) -> Result<(Options, Option<f64>), Malformed> {
    let (mut options, mut scale) = (Options::default(), None);
    let Some(fields) = case.get("options") else { return Ok((options, scale)) };
    fields.object()?;
    if let Some(strict) = fields.get("strict") {
        options.strict = flag(&strict)?;
    }
    if let Some(mode) = fields.get("mode") {
        options.lengths = match mode.text()? {
            "arc" => Lengths::Arc,
            "proj" => Lengths::Projected,
            other => return Err(mode.malformed(&format!("{other:?} is neither \"arc\" nor \"proj\""))),
        };
    }
    if let Some(scheme) = fields.get("scheme") {
        options.scheme = match scheme.text()? {
            "smooth" => Scheme::Smooth,
            "pn" => Scheme::PointNormal,
            "flat" => Scheme::Flat,
            "literal" => Scheme::Literal,
            other => return Err(scheme.malformed(&format!("{other:?} is not smooth, pn, flat or literal"))),
        };
    }
    if let Some(tolerance) = fields.get("tolerance") {
        let number = tolerance.number()?;
        let least = Options::LEAST_TOLERANCE.to_num::<f64>();
        let legal = (least..=1.0).contains(&number);
        options.tolerance = fixed(number)
            .filter(|_| legal)
            .ok_or_else(|| tolerance.malformed(&format!("{number} is not in {least} ..= 1")))?;
    }
    if let Some(field) = fields.get("scale") {
        scale = Some(power_of_two(&field)?);
    }
    Ok((options, scale))
}

fn triple(field: &Field<'_>) -> Result<[f64; 3], Malformed> {
    let [x, y, z] = field.fixed()?;
    Ok([x.number()?, y.number()?, z.number()?])
}

/// A normal, lengthened so that no bit of a unit vector in binary64 that counts is lost.
fn normal(field: &Field<'_>) -> Result<Vector3, Malformed> {
    let [x, y, z] = triple(field)?;
    let largest = x.abs().max(y.abs()).max(z.abs());
    // Below 10^-9 it must stay below.
    let scale = if largest < 1e-3 { 1.0 } else { (24.0 - largest.log2().floor()).exp2() };
    Ok(Vector3::from_array(vector(field, scale)?))
}

fn read(case: &Field<'_>) -> Result<Case, Malformed> {
    let (options, scale) = options(case)?;
    let fields = case.need("vertices")?.items()?;
    let vertices = fields.iter().map(triple).collect::<Result<Vec<_>, _>>()?;
    let (factor, divisor) = scale.map_or_else(|| [natural_scale(&vertices); 2].into(), |scale| (scale, 1.0));
    let points = fields.iter().map(|f| Ok(Point3::from_array(vector(f, factor)?))).collect::<Result<Vec<_>, _>>()?;
    let (mut corners, mut ends) = (Vec::new(), Vec::new());
    let faces = case.need("faces")?;
    for face in faces.items()? {
        for corner in face.items()? {
            corners.push(index(&corner)?);
        }
        let end = corners.len();
        ends.push(u16::try_from(end).map_err(|_| faces.malformed(&format!("has {end} corners or more")))?);
    }
    let normals =
        case.get("normals").map(|list| list.items()?.iter().map(normal).collect::<Result<_, _>>()).transpose()?;
    let mut tangents = Vec::new();
    for tangent in case.get("tangents").map_or(Ok(Vec::new()), |list| list.items())? {
        let [from, to, along] = tangent.fixed()?;
        let vector = Vector3::from_array(vector(&along, factor)?);
        tangents.push(Tangent { from: index(&from)?, to: index(&to)?, vector });
    }
    Ok(Case { points, corners, ends, normals, tangents, options, divisor })
}

/// `[[[i, j, k], [x, y, z]], …]` of a face, i ascending, then j ascending, as in the reference cases.
fn control_points(triangle: &Triangle<5, 21, I32F32>, divisor: f64) -> Value {
    let order = (0..=5).flat_map(|i| (0..=5 - i).map(move |j| [i, j, 5 - i - j]));
    let place = |p: &Point3<I32F32>| p.to_array().map(|c| Value::from(c.to_bits() as f64 / 4_294_967_296.0 / divisor));
    let entry = |[i, j, k]: [usize; 3]| -> Option<Value> {
        let place = place(triangle.point(i, j, k)?);
        Some(vec![Value::from(vec![i, j, k]), Value::from(place.to_vec())].into())
    };
    order.filter_map(entry).collect()
}

fn quality(quality: &Quality, folded: Vec<usize>) -> Value {
    let angle = quality.max_angle as f64 / 2_f64.powi(60);
    let map = Map::from_iter([
        ("max_angle".to_owned(), angle.into()),
        ("max_dev_pn".to_owned(), quality.max_deviation.to_num::<f64>().into()),
        ("max_correction".to_owned(), quality.max_correction.to_num::<f64>().into()),
        ("folded".to_owned(), folded.into()),
        ("shifted".to_owned(), quality.shifted.into()),
    ]);
    Value::Object(map)
}

fn interpolate(case: &Case, mesh: &Mesh<'_, I32F32>) -> Result<Map<String, Value>, G1Error> {
    let mut shifts = vec![Shift::NONE; case.points.len()];
    let controls = Controls { normals: case.normals.as_deref(), tangents: &case.tangents, ..Controls::default() };
    let surface = Interpolant::new(mesh, &controls, &case.options, &mut shifts)?;
    let triangles = surface.triangles().collect::<Result<Vec<_>, _>>()?;
    let mut folded = Vec::new();
    for face in 0..triangles.len() {
        if surface.is_folded(face)? {
            folded.push(face);
        }
    }
    let points = triangles.iter().map(|triangle| control_points(triangle, case.divisor)).collect();
    Ok(Map::from_iter([
        ("status".to_owned(), "ok".into()),
        ("control_points".to_owned(), points),
        ("quality".to_owned(), quality(&surface.quality()?, folded)),
    ]))
}

pub(crate) fn run(case: &Field<'_>) -> Answer {
    let case = read(case)?;
    let faces = Faces::Polygons { corners: &case.corners, ends: &case.ends };
    let links = match Links::<VERTICES, HALF_EDGES>::new(case.points.len(), faces) {
        Ok(links) => Box::new(links),
        Err(error) => return Ok(typed_error(&error)),
    };
    let mesh = match Mesh::<I32F32>::new(&case.points, &links) {
        Ok(mesh) => mesh,
        Err(error) => return Ok(typed_error(&error)),
    };
    Ok(interpolate(&case, &mesh).unwrap_or_else(|error| typed_error(&error)))
}
