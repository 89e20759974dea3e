//! `golden lattice`: the integer lattice of a patch.

use crate::case::Patch;
use crate::field::{Field, Malformed};
use crate::{Answer, typed_error};
use embedded_surfaces::forward::{Lattice, LatticeError, Steps};
use embedded_surfaces::patch::SurfaceNet;
use serde_json::{Map, Value};

const MOST_STEPS: u32 = 1 << 24;

/// `steps`: n, [nr, ns] or "hole-free".
fn steps(field: &Field<'_>, patch: &Patch<'_>, net: SurfaceNet<'_>) -> Result<Steps, Malformed> {
    let malformed = |error: LatticeError| field.malformed(&error.to_string());
    match field.value() {
        Value::String(text) if text == "hole-free" => Ok(Steps::hole_free(net)),
        Value::Array(_) => {
            let [r, s] = field.fixed()?;
            let (r, s) = (r.whole(1..=MOST_STEPS)?, s.whole(1..=MOST_STEPS)?);
            if patch.is_triangle() && r != s {
                return Err(field.malformed(&format!("[{r}, {s}]: a triangle takes the same count in both directions")));
            }
            Steps::new(r, s).map_err(malformed)
        }
        Value::Number(_) => Steps::uniform(field.whole(1..=MOST_STEPS)?).map_err(malformed),
        _ => Err(field.malformed("is neither a count, nor two of them, nor \"hole-free\"")),
    }
}

pub(crate) fn run(case: &Field<'_>) -> Answer {
    let patch_field = case.need("patch")?;
    let patch = Patch::read(&patch_field)?;
    let points = patch.fixed_points()?;
    let net = patch.net(&points, patch.weights()).map_err(|error| patch_field.malformed(&error.to_string()))?;
    let steps = steps(&case.need("steps")?, &patch, net)?;
    let lattice = match Lattice::new(net, steps) {
        Ok(lattice) => lattice,
        Err(error) => return Ok(typed_error(&error)),
    };
    let mut points = Vec::new();
    lattice
        .for_each(|p| points.push(Value::from(vec![i64::from(p.i), p.j.into(), p.x.into(), p.y.into(), p.z.into()])));
    let (r, s) = lattice.steps();
    Ok(Map::from_iter([
        ("status".to_owned(), "ok".into()),
        ("steps".to_owned(), vec![r, s].into()),
        ("accumulator".to_owned(), lattice.budget().accumulator.to_string().into()),
        ("points".to_owned(), points.into()),
    ]))
}
