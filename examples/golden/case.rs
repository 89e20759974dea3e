//! Cases and patches as the files describe them.

use crate::field::{Field, Malformed};
use embedded_surfaces::geometry::Point3;
use embedded_surfaces::num::{I16F16, I32F32};
use embedded_surfaces::patch::{NetError, RationalTensorNet, RationalTriangleNet, SurfaceNet, TensorNet, TriangleNet};
use embedded_surfaces::reference::fixed_half_up;

/// The cases of a file that lists several: `cases`, or `ok_cases` then `error_cases`, or the map `meshes`.
pub(crate) fn several<'a>(root: &Field<'a>) -> Result<Option<Vec<Field<'a>>>, Malformed> {
    root.object()?;
    if let Some(cases) = root.get("cases") {
        return cases.items().map(Some);
    }
    let lists = [root.get("ok_cases"), root.get("error_cases")];
    if lists.iter().any(Option::is_some) {
        let mut all = Vec::new();
        for list in lists.into_iter().flatten() {
            all.extend(list.items()?);
        }
        return Ok(Some(all));
    }
    let Some(meshes) = root.get("meshes") else { return Ok(None) };
    let keys = meshes.object()?.keys();
    Ok(Some(keys.filter_map(|key| meshes.get(key)).collect()))
}

/// A patch as read: binary64 model coordinates and where each stands in the file.
pub(crate) struct Patch<'a> {
    kind: Kind,
    points: Vec<[f64; 3]>,
    fields: Vec<Field<'a>>,
    /// One positive weight a point, in `I16F16`, for a rational patch.
    weights: Option<Vec<I16F16>>,
}

#[derive(Clone, Copy)]
enum Kind {
    Triangle(usize),
    Tensor(usize, usize),
}

impl Kind {
    /// The number of control points.
    fn len(self) -> usize {
        match self {
            Self::Triangle(n) => (n + 1) * (n + 2) / 2,
            Self::Tensor(m, h) => (m + 1) * (h + 1),
        }
    }
}

fn point(field: &Field<'_>) -> Result<[f64; 3], Malformed> {
    let [x, y, z] = field.fixed()?;
    Ok([x.number()?, y.number()?, z.number()?])
}

fn degree(field: &Field<'_>) -> Result<usize, Malformed> {
    Ok(field.whole(1..=8)? as usize)
}

/// The items of a list of the patch's shape, in storage order: nested rows for a tensor.
fn shaped<'a>(list: &Field<'a>, kind: Kind) -> Result<Vec<Field<'a>>, Malformed> {
    let items = match kind {
        Kind::Triangle(_) => list.items()?,
        Kind::Tensor(m, h) => grid(list, (m, h))?,
    };
    if items.len() != kind.len() {
        return Err(list.malformed(&format!("has {} points instead of {}", items.len(), kind.len())));
    }
    Ok(items)
}

fn weight(field: &Field<'_>) -> Result<I16F16, Malformed> {
    let value = field.number()?;
    let fixed = fixed_half_up(value).filter(|w| *w > 0);
    fixed.ok_or_else(|| field.malformed(&format!("weight {value} is not in 2^-16 ..= 32767")))
}

/// The tensor net's rows, one after the other.
fn grid<'a>(ctrl: &Field<'a>, (m, h): (usize, usize)) -> Result<Vec<Field<'a>>, Malformed> {
    let rows = ctrl.items()?;
    if rows.len() != m + 1 {
        return Err(ctrl.malformed(&format!("has {} rows instead of {}", rows.len(), m + 1)));
    }
    let mut points = Vec::new();
    for row in &rows {
        let items = row.items()?;
        if items.len() != h + 1 {
            return Err(row.malformed(&format!("has {} points instead of {}", items.len(), h + 1)));
        }
        points.extend(items);
    }
    Ok(points)
}

impl<'a> Patch<'a> {
    /// Reads `{"kind", "degree", "ctrl", "weights"?}`.
    pub(crate) fn read(field: &Field<'a>) -> Result<Self, Malformed> {
        let (kind, degrees) = (field.need("kind")?, field.need("degree")?);
        let kind = match kind.text()? {
            "tri" => Kind::Triangle(degree(&degrees)?),
            "tensor" => {
                let [m, h] = degrees.fixed()?;
                Kind::Tensor(degree(&m)?, degree(&h)?)
            }
            other => return Err(kind.malformed(&format!("{other:?} is neither \"tri\" nor \"tensor\""))),
        };
        let fields = shaped(&field.need("ctrl")?, kind)?;
        let weights = field.get("weights").map(|list| shaped(&list, kind)?.iter().map(weight).collect()).transpose()?;
        let points = fields.iter().map(point).collect::<Result<_, _>>()?;
        Ok(Self { kind, points, fields, weights })
    }

    /// Reads the patches of a case: `patch`, `patches`, or bicubic `patches` of indices into `vertices`.
    pub(crate) fn read_all(case: &Field<'a>) -> Result<Vec<Self>, Malformed> {
        if let Some(patch) = case.get("patch") {
            return Ok(vec![Self::read(&patch)?]);
        }
        let patches = case.need("patches")?.items()?;
        let Some(vertices) = case.get("vertices") else { return patches.iter().map(Self::read).collect() };
        let vertices = vertices.items()?;
        patches.iter().map(|patch| Self::read_indexed(patch, &vertices)).collect()
    }

    fn read_indexed(patch: &Field<'a>, vertices: &[Field<'a>]) -> Result<Self, Malformed> {
        let indices = patch.fixed::<16>()?;
        let mut fields = Vec::new();
        for index in &indices {
            let i = index.whole(0..=u32::MAX)? as usize;
            let count = vertices.len();
            let vertex = vertices.get(i).ok_or_else(|| index.malformed(&format!("{i} is not below {count}")))?;
            fields.push(vertex.clone());
        }
        let points = fields.iter().map(point).collect::<Result<_, _>>()?;
        Ok(Self { kind: Kind::Tensor(3, 3), points, fields, weights: None })
    }

    /// The control points in model coordinates.
    pub(crate) fn points(&self) -> &[[f64; 3]] {
        &self.points
    }

    /// The control points in `I16F16`, half up; a number out of range is the file's fault and named.
    pub(crate) fn fixed_points(&self) -> Result<Vec<Point3<I16F16>>, Malformed> {
        let mut out = Vec::new();
        for (point, field) in self.points.iter().zip(&self.fields) {
            let coordinates = field.fixed::<3>()?;
            let mut fixed = [I16F16::ZERO; 3];
            for ((fixed, c), field) in fixed.iter_mut().zip(point).zip(coordinates) {
                *fixed =
                    fixed_half_up(*c).ok_or_else(|| field.malformed(&format!("{c} is outside -32767 ..= 32767")))?;
            }
            out.push(Point3::from_array(fixed));
        }
        Ok(out)
    }

    /// The net of this patch through other points, with these weights if any.
    pub(crate) fn net<'p>(
        &self,
        points: &'p [Point3<I16F16>],
        weights: Option<&'p [I16F16]>,
    ) -> Result<SurfaceNet<'p>, NetError> {
        Ok(match (self.kind, weights) {
            (Kind::Triangle(n), None) => SurfaceNet::Triangle(TriangleNet::new(n, points)?),
            (Kind::Tensor(m, h), None) => SurfaceNet::Tensor(TensorNet::new((m, h), points)?),
            (Kind::Triangle(n), Some(weights)) => {
                SurfaceNet::RationalTriangle(RationalTriangleNet::new(TriangleNet::new(n, points)?, weights)?)
            }
            (Kind::Tensor(m, h), Some(weights)) => {
                SurfaceNet::RationalTensor(RationalTensorNet::new(TensorNet::new((m, h), points)?, weights)?)
            }
        })
    }

    /// The weights, for a rational patch.
    pub(crate) fn weights(&self) -> Option<&[I16F16]> {
        self.weights.as_deref()
    }

    /// Whether the patch is triangular.
    pub(crate) fn is_triangle(&self) -> bool {
        matches!(self.kind, Kind::Triangle(_))
    }

    /// A mapped point in `I16F16`; `None` out of range.
    pub(crate) fn fix(point: [f64; 3]) -> Option<Point3<I16F16>> {
        let [x, y, z] = point.map(fixed_half_up);
        Some(Point3::new(x?, y?, z?))
    }

    /// Whole units of an `f64` out of range, for messages.
    pub(crate) fn units(c: f64) -> i64 {
        I32F32::saturating_from_num(c).to_num::<i64>()
    }
}
