//! Views of a case: all in binary64, rounded once, half up, where the engine's coordinates begin.

use crate::case::Patch;
use crate::field::{Field, Malformed};
use embedded_surfaces::geometry::GeometryError;

/// How model coordinates become screen coordinates: three rows of an affine map, then a perspective.
pub(crate) struct View {
    /// `None`: they are screen coordinates.
    matrix: Option<[[f64; 4]; 3]>,
    eye: Option<Eye>,
}

/// The eye, `distance` in front of the plane z = 0, above (x, y).
#[derive(Clone, Copy)]
struct Eye {
    x: f64,
    y: f64,
    distance: f64,
}

fn degrees(field: Option<Field<'_>>, default: f64) -> Result<f64, Malformed> {
    Ok(field.map_or(Ok(default), |f| f.number())?.to_radians())
}

impl View {
    pub(crate) fn read(case: &Field<'_>, size: (u32, u32), model: &[[f64; 3]]) -> Result<Self, Malformed> {
        let Some(view) = case.get("view") else { return Ok(Self { matrix: None, eye: None }) };
        view.object()?;
        if let Some(matrix) = view.get("matrix") {
            let mut rows = [[0.0; 4]; 3];
            for (row, field) in rows.iter_mut().zip(matrix.fixed::<3>()?) {
                for (entry, field) in row.iter_mut().zip(field.fixed::<4>()?) {
                    *entry = field.number()?;
                }
            }
            return Ok(Self { matrix: Some(rows), eye: None });
        }
        let fit = view.get("fit").map_or(Ok(0.92), |f| {
            let fit = f.number()?;
            if fit > 0.0 { Ok(fit) } else { Err(f.malformed(&format!("{fit} is not above 0"))) }
        })?;
        let rotation = rotation(degrees(view.get("tilt"), -60.0)?, degrees(view.get("spin"), 30.0)?);
        let (matrix, diagonal) =
            fitted(rotation, size, fit, model).ok_or_else(|| view.malformed("there is nothing to fit"))?;
        let eye = view.get("perspective").map(|field| {
            let d = field.number()?;
            let (x, y) = (f64::from(size.0) / 2.0, f64::from(size.1) / 2.0);
            if d > 0.0 { Ok(Eye { x, y, distance: d * diagonal }) } else { Err(field.malformed("is not above 0")) }
        });
        Ok(Self { matrix: Some(matrix), eye: eye.transpose()? })
    }

    /// Whether coordinates are screen coordinates already.
    pub(crate) fn is_screen(&self) -> bool {
        self.matrix.is_none()
    }

    /// Whether images carry weights.
    pub(crate) fn is_perspective(&self) -> bool {
        self.eye.is_some()
    }

    /// The image of a point and its weight: x' = cx + (x − cx)·D/(D + z), likewise y, z' = z·D/(D + z), weight D + z.
    pub(crate) fn apply(&self, p: [f64; 3]) -> Result<([f64; 3], f64), GeometryError> {
        let rows = self.matrix.unwrap_or([[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]]);
        let [x, y, z] = rows.map(|[x, y, z, shift]| x * p[0] + y * p[1] + z * p[2] + shift);
        let Some(eye) = self.eye else { return Ok(([x, y, z], 1.0)) };
        let weight = eye.distance + z;
        if weight <= 0.0 {
            return Err(GeometryError::BehindEye { units: Patch::units(weight) });
        }
        let scale = eye.distance / weight;
        Ok(([eye.x + (x - eye.x) * scale, eye.y + (y - eye.y) * scale, z * scale], weight))
    }
}

/// (x, −y, −z) of Rx(tilt)·Rz(spin).
fn rotation(tilt: f64, spin: f64) -> [[f64; 3]; 3] {
    let ((st, ct), (ss, cs)) = (tilt.sin_cos(), spin.sin_cos());
    [[cs, -ss, 0.0], [-ct * ss, -ct * cs, st], [-st * ss, -st * cs, -ct]]
}

/// The axis box of the turned points fills `fit` of the screen in the tighter direction, centred.
/// Returned with the diagonal of the scaled box.
fn fitted(rotation: [[f64; 3]; 3], size: (u32, u32), fit: f64, model: &[[f64; 3]]) -> Option<([[f64; 4]; 3], f64)> {
    let turned = |p: &[f64; 3]| rotation.map(|row| row[0] * p[0] + row[1] * p[1] + row[2] * p[2]);
    let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    for p in model.iter().map(turned) {
        for axis in 0..3 {
            low[axis] = low[axis].min(p[axis]);
            high[axis] = high[axis].max(p[axis]);
        }
    }
    let (width, height) = (f64::from(size.0), f64::from(size.1));
    let scale = (width * fit / (high[0] - low[0])).min(height * fit / (high[1] - low[1]));
    if !scale.is_finite() {
        return None;
    }
    let target = [width / 2.0, height / 2.0, 0.0];
    let mut rows = [[0.0; 4]; 3];
    for axis in 0..3 {
        let [x, y, z] = rotation[axis].map(|entry| entry * scale);
        rows[axis] = [x, y, z, target[axis] - scale * (low[axis] + high[axis]) / 2.0];
    }
    let diagonal = (0..3).map(|axis| (scale * (high[axis] - low[axis])).powi(2)).sum::<f64>().sqrt();
    Some((rows, diagonal))
}
