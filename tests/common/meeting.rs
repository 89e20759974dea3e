//! Patches of case files as nets, intersections with growing buffers, curves in `f64`.

#[path = "../../examples/data/workspace.rs"]
mod workspace;

use embedded_surfaces::geometry::Point3;
use embedded_surfaces::intersect::{
    Branch, Buffers, Curve, CurvePoint, IntersectError, Intersection, Options, Room, intersect,
};
use embedded_surfaces::num::I16F16;
use embedded_surfaces::patch::{RationalTensorNet, RationalTriangleNet, SurfaceNet, TensorNet, TriangleNet};
use embedded_surfaces::reference::fixed_half_up;
use serde_json::Value;
use workspace::{Workspace, name};

/// Their file.
pub(crate) const CASES: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/golden/intersect.json");

/// The pairs of `tests/golden/intersect.json`.
pub(crate) fn cases() -> Vec<Value> {
    let file: Value = serde_json::from_str(&std::fs::read_to_string(CASES).unwrap()).unwrap();
    file["cases"].as_array().unwrap().clone()
}

/// The kinds, the length where it is known, and the arms that a case must have.
pub(crate) fn expected(case: &Value) -> (Vec<String>, Option<f64>, Vec<u64>) {
    if let Some(expect) = case.get("expect") {
        let kinds = expect["kinds"].as_object().unwrap();
        let mut all: Vec<String> = Vec::new();
        for (kind, count) in kinds {
            all.extend(std::iter::repeat_n(kind.clone(), count.as_u64().unwrap() as usize));
        }
        all.sort_unstable();
        let arms = expect["branches"].as_array().unwrap().iter().map(|n| n.as_u64().unwrap()).collect();
        return (all, expect["length"].as_f64(), arms);
    }
    let reference = &case["reference"];
    let components = reference["components"].as_array().unwrap();
    let mut kinds: Vec<_> = components.iter().map(|c| c["kind"].as_str().unwrap().to_owned()).collect();
    kinds.sort_unstable();
    (kinds, reference["total_length"].as_f64(), Vec::new())
}

/// A patch with its control points.
#[derive(Clone, Debug)]
pub(crate) struct Patch {
    pub(crate) triangle: bool,
    pub(crate) degrees: (usize, usize),
    pub(crate) points: Vec<Point3>,
    pub(crate) weights: Option<Vec<I16F16>>,
}

impl Patch {
    /// Reads `{"kind", "degree", "ctrl", "weights"?}`.
    pub(crate) fn read(patch: &Value) -> Self {
        let triangle = patch["kind"] == "tri";
        let number = |v: &Value| v.as_u64().unwrap() as usize;
        let degree = &patch["degree"];
        let degrees =
            if triangle { (number(degree), number(degree)) } else { (number(&degree[0]), number(&degree[1])) };
        let fixed = |v: &Value| fixed_half_up(v.as_f64().unwrap()).unwrap();
        let flat = |list: &Value| -> Vec<Value> {
            let items = list.as_array().unwrap().clone();
            if triangle { items } else { items.iter().flat_map(|row| row.as_array().unwrap().clone()).collect() }
        };
        let point = |p: &Value| Point3::new(fixed(&p[0]), fixed(&p[1]), fixed(&p[2]));
        let weights = patch.get("weights").map(|list| flat(list).iter().map(fixed).collect());
        Self { triangle, degrees, points: flat(&patch["ctrl"]).iter().map(point).collect(), weights }
    }

    pub(crate) fn net(&self) -> SurfaceNet<'_> {
        let (points, degrees) = (&self.points[..], self.degrees);
        match (self.triangle, &self.weights) {
            (true, None) => SurfaceNet::Triangle(TriangleNet::new(degrees.0, points).unwrap()),
            (false, None) => SurfaceNet::Tensor(TensorNet::new(degrees, points).unwrap()),
            (true, Some(weights)) => {
                let net = TriangleNet::new(degrees.0, points).unwrap();
                SurfaceNet::RationalTriangle(RationalTriangleNet::new(net, weights).unwrap())
            }
            (false, Some(weights)) => {
                let net = TensorNet::new(degrees, points).unwrap();
                SurfaceNet::RationalTensor(RationalTensorNet::new(net, weights).unwrap())
            }
        }
    }

    /// The patch with u and v exchanged.
    pub(crate) fn swapped(&self) -> Self {
        let (m, h) = self.degrees;
        let at = |j: usize, k: usize| (j + k) * (j + k + 1) / 2 + k;
        let order: Vec<usize> = if self.triangle {
            (0..=m).rev().flat_map(|i| (0..=m - i).rev().map(move |j| at(i, m - i - j))).collect()
        } else {
            (0..=h).flat_map(|j| (0..=m).map(move |i| i * (h + 1) + j)).collect()
        };
        let weights = self.weights.as_ref().map(|w| order.iter().map(|k| w[*k]).collect());
        Self { degrees: (h, m), points: order.iter().map(|k| self.points[*k]).collect(), weights, ..self.clone() }
    }

    /// The patch with each point mapped, in units of 2^-16.
    pub(crate) fn mapped(&self, map: impl Fn([i32; 3]) -> [i32; 3]) -> Self {
        let point = |p: &Point3| {
            let [x, y, z] = map(p.to_array().map(I16F16::to_bits));
            Point3::from_bits(x, y, z)
        };
        Self { points: self.points.iter().map(point).collect(), ..self.clone() }
    }
}

/// The owned part of a result.
#[derive(Clone, Debug)]
pub(crate) struct Meeting {
    pub(crate) curves: Vec<(Curve, Vec<CurvePoint>)>,
    pub(crate) branches: Vec<Branch>,
    pub(crate) certified: bool,
    pub(crate) undecided: u32,
}

impl Meeting {
    pub(crate) fn new(a: &Patch, b: &Patch, options: &Options) -> Result<Self, IntersectError> {
        Self::with(a, b, options, |buffers, [a, b], options| intersect(a, b, options, buffers))
    }

    /// Runs an operation with room enough.
    pub(crate) fn with(
        a: &Patch,
        b: &Patch,
        options: &Options,
        run: impl for<'b> Fn(Buffers<'b>, [SurfaceNet<'_>; 2], &Options) -> Result<Intersection<'b>, IntersectError>,
    ) -> Result<Self, IntersectError> {
        let nets = [a.net(), b.net()];
        let room = Room::new(nets[0], nets[1], options.depth)?;
        let mut workspace = Workspace::new(&room, 1 << 15, 1 << 15, 64);
        let result = run(workspace.buffers(), nets, options)?;
        Ok(Self {
            curves: result.curves().iter().map(|c| (*c, result.points(c).to_vec())).collect(),
            branches: result.branches().to_vec(),
            certified: result.is_certified(),
            undecided: result.undecided,
        })
    }

    /// The kinds of the components, sorted.
    pub(crate) fn kinds(&self) -> Vec<&'static str> {
        let mut kinds: Vec<_> = self.curves.iter().map(|(c, _)| name(c.kind)).collect();
        kinds.sort_unstable();
        kinds
    }

    pub(crate) fn length(&self) -> f64 {
        self.curves.iter().map(|(c, _)| c.length.to_num::<f64>()).sum()
    }
}

pub(crate) type Point = [f64; 3];

pub(crate) fn position(p: &CurvePoint) -> Point {
    p.position.to_array().map(|c| c.to_bits() as f64 / (1_u64 << 44) as f64)
}

pub(crate) fn tangent(p: &CurvePoint) -> Point {
    p.tangent.to_array().map(|c| f64::from(c.to_bits()) / f64::from(1 << 30))
}

pub(crate) fn minus(a: Point, b: Point) -> Point {
    [0, 1, 2].map(|k: usize| a[k] - b[k])
}

pub(crate) fn dot(a: Point, b: Point) -> f64 {
    (0..3).map(|k| a[k] * b[k]).sum()
}

/// The distance of a point from the Hermite pieces of a curve.
pub(crate) fn distance(curve: &Curve, points: &[CurvePoint], x: Point) -> f64 {
    let mut best = f64::INFINITY;
    let count = points.len();
    let pieces = if curve.closed { count } else { count - 1 };
    for p in points {
        best = best.min(dot(minus(position(p), x), minus(position(p), x)).sqrt());
    }
    for i in 0..pieces {
        let (p, q) = (&points[i], &points[(i + 1) % count]);
        let (a, b, s, t) = (position(p), position(q), tangent(p), tangent(q));
        let chord = minus(b, a);
        let square = dot(chord, chord);
        if square == 0.0 || dot(minus(x, a), minus(x, a)) > 9.0 * square {
            continue;
        }
        let arc = square.sqrt() * (1.0 + dot(minus(t, s), minus(t, s)) / 24.0);
        let at = |u: f64| {
            let (rise, one, two) = (u * u * (3.0 - 2.0 * u), u * (1.0 - u).powi(2), u * u * (1.0 - u));
            let h = [0, 1, 2].map(|k: usize| a[k] + chord[k] * rise + arc * (s[k] * one - t[k] * two));
            dot(minus(h, x), minus(h, x)).sqrt()
        };
        // Ternary search: the distance has one minimum on a piece as short as these.
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..60 {
            let (m, n) = (low + (high - low) / 3.0, high - (high - low) / 3.0);
            if at(m) < at(n) { high = n } else { low = m }
        }
        best = best.min(at(low));
    }
    best
}
