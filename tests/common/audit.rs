//! Meshes held against their definition: every edge, every triangle, dense distances.
#![allow(dead_code, reason = "each test binary uses a part")]

use embedded_surfaces::geometry::Point3;
use embedded_surfaces::num::I16F16;
use embedded_surfaces::patch::{
    Parameter, RationalTensorNet, RationalTriangleNet, Surface, SurfaceNet, TensorNet, TriangleNet,
};
use embedded_surfaces::reference::{partials, point};
use embedded_surfaces::subdivide::{PatchTopology, Tessellation, Tolerance, Vertex, tessellate, topology};
use std::collections::{BTreeSet, HashMap};

/// A patch of any kind that owns its net.
#[derive(Clone, Debug)]
pub(crate) struct AnyPatch {
    pub(crate) triangle: bool,
    pub(crate) degrees: (usize, usize),
    pub(crate) points: Vec<Point3>,
    pub(crate) weights: Option<Vec<I16F16>>,
}

impl Surface for AnyPatch {
    fn surface(&self) -> SurfaceNet<'_> {
        if self.triangle {
            let net = TriangleNet::new(self.degrees.0, &self.points).unwrap();
            let rational = |w| SurfaceNet::RationalTriangle(RationalTriangleNet::new(net, w).unwrap());
            self.weights.as_deref().map_or(SurfaceNet::Triangle(net), rational)
        } else {
            let net = TensorNet::new(self.degrees, &self.points).unwrap();
            let rational = |w| SurfaceNet::RationalTensor(RationalTensorNet::new(net, w).unwrap());
            self.weights.as_deref().map_or(SurfaceNet::Tensor(net), rational)
        }
    }
}

/// Parameters as numbers.
pub(crate) fn numbers(parameters: [Parameter; 2]) -> [f64; 2] {
    parameters.map(|p| f64::from(p.numerator()) / f64::from(p.denominator()))
}

fn bits(p: Point3) -> [i64; 3] {
    p.to_array().map(|c| c.to_bits().into())
}

pub(crate) fn units(p: Point3) -> [f64; 3] {
    p.to_array().map(I16F16::to_num)
}

fn has_area([a, b, c]: [Point3; 3]) -> bool {
    let (a, b, c) = (bits(a), bits(b), bits(c));
    let [p, q] = [b, c].map(|to| [0, 1, 2].map(|k: usize| i128::from(to[k] - a[k])));
    (0..3).any(|k| p[k] * q[(k + 1) % 3] != p[(k + 1) % 3] * q[k])
}

/// The edges of a patch's domain that a pair of parameters is on, in the numbering of the crate. Parameters are dyadic:
/// their sum is exact.
fn domain_edges(triangle: bool, [r, s]: [f64; 2]) -> Vec<usize> {
    let (is_zero, is_one) = (|c: f64| c <= 0.0, |c: f64| c >= 1.0);
    let on = if triangle {
        vec![(is_zero(r), 0), (is_zero(s), 1), (is_one(r + s), 2)]
    } else {
        vec![(is_zero(r), 0), (is_one(r), 1), (is_zero(s), 2), (is_one(s), 3)]
    };
    on.into_iter().filter(|(on, _)| *on).map(|(_, edge)| edge).collect()
}

/// What a mesh is.
#[derive(Debug, PartialEq, Eq)]
pub(crate) struct Audit {
    pub(crate) triangles: usize,
    pub(crate) vertices: usize,
    /// Edges of one triangle.
    pub(crate) border: usize,
    /// Vertices − edges + triangles of each part.
    pub(crate) euler: Vec<i64>,
    /// Triangles without area.
    pub(crate) flat: usize,
}

pub(crate) fn joined<S: Surface>(patches: &[S]) -> Vec<PatchTopology> {
    let mut table = vec![PatchTopology::default(); patches.len()];
    topology(patches, &mut table).unwrap();
    table
}

pub(crate) fn mesh<'a, S: Surface>(
    patches: &'a [S],
    table: &'a [PatchTopology],
    tolerance: f64,
) -> Tessellation<'a, S> {
    tessellate(patches, table, Tolerance::new(I16F16::from_num(tolerance)).unwrap()).unwrap()
}

/// Panics at a crack: within a part every edge must have one triangle on either side, with its ends in opposite order,
/// but for edges on the border of a part.
pub(crate) fn watertight<S: Surface>(patches: &[S], tolerance: f64) -> Audit {
    let table = joined(patches);
    let parts = table.iter().map(PatchTopology::part).max().map_or(0, |last| last + 1);
    let mut edges: HashMap<(usize, [[i64; 3]; 2]), [Vertex; 2]> = HashMap::new();
    let mut vertices = vec![BTreeSet::new(); parts];
    let (mut triangles, mut flat) = (vec![0; parts], 0);
    for triangle in mesh(patches, &table, tolerance) {
        let part = table[triangle[0].patch].part();
        triangles[part] += 1;
        flat += usize::from(!has_area(triangle.map(|v| v.point)));
        for k in 0..3 {
            let ends = [triangle[k], triangle[(k + 1) % 3]];
            assert_ne!(ends[0].point, ends[1].point, "a triangle with two equal corners at {tolerance}");
            vertices[part].insert(bits(ends[0].point));
            let before = edges.insert((part, ends.map(|v| bits(v.point))), ends);
            assert!(before.is_none(), "two triangles run along {ends:?} and {before:?} at {tolerance}");
        }
    }
    let mut border = vec![0; parts];
    for ((part, [a, b]), ends) in &edges {
        if edges.contains_key(&(*part, [*b, *a])) {
            continue;
        }
        border[*part] += 1;
        let net = patches[ends[0].patch].surface();
        let [first, last] = ends.map(|v| domain_edges(net.is_triangle(), numbers(v.parameters)));
        let open = first.iter().any(|edge| last.contains(edge) && !table[ends[0].patch].is_joined(*edge));
        assert!(open, "a crack along {ends:?} at {tolerance}");
    }
    let edges_of = |part| (edges.keys().filter(|(p, _)| *p == part).count() + border[part]) / 2;
    let euler = (0..parts).map(|p| vertices[p].len() as i64 - edges_of(p) as i64 + triangles[p] as i64).collect();
    let vertices = vertices.iter().map(BTreeSet::len).sum();
    Audit { triangles: triangles.iter().sum(), vertices, border: border.iter().sum(), euler, flat }
}

fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|k| (a[k] - b[k]).powi(2)).sum::<f64>().sqrt()
}

/// The largest distance between points of triangles and points of the surface, over a grid of each triangle; for a
/// polynomial patch at equal parameters, for a rational one to the nearest point that Gauss–Newton finds from there.
pub(crate) fn deviation<S: Surface>(patches: &[S], tolerance: f64) -> f64 {
    const GRID: usize = 6;
    let table = joined(patches);
    let mut worst = 0.0_f64;
    for triangle in mesh(patches, &table, tolerance) {
        let net = patches[triangle[0].patch].surface();
        let (places, at) = (triangle.map(|v| units(v.point)), triangle.map(|v| numbers(v.parameters)));
        for i in 0..=GRID {
            for j in 0..=GRID - i {
                let part = [i, j, GRID - i - j].map(|k| k as f64 / GRID as f64);
                let place = [0, 1, 2].map(|c: usize| (0..3).map(|k| part[k] * places[k][c]).sum::<f64>());
                let uv = [0, 1].map(|c: usize| (0..3).map(|k| part[k] * at[k][c]).sum::<f64>());
                let at_equal = distance(place, point(net, uv[0], uv[1]));
                worst =
                    worst.max(if net.weights().is_some() { nearest(net, place, uv).min(at_equal) } else { at_equal });
            }
        }
    }
    worst
}

/// The distance of a place from a surface, by Gauss–Newton from parameters near by.
pub(crate) fn nearest(net: SurfaceNet<'_>, place: [f64; 3], mut uv: [f64; 2]) -> f64 {
    let dot = |a: [f64; 3], b: [f64; 3]| (0..3).map(|k| a[k] * b[k]).sum::<f64>();
    for _ in 0..8 {
        let (p, [a, b]) = (point(net, uv[0], uv[1]), partials(net, uv[0], uv[1]));
        let off = [0, 1, 2].map(|k: usize| place[k] - p[k]);
        let (aa, ab, bb, ax, bx) = (dot(a, a), dot(a, b), dot(b, b), dot(a, off), dot(b, off));
        let determinant = aa * bb - ab * ab;
        if determinant.abs() < 1e-9 * aa * bb {
            break;
        }
        uv = [uv[0] + (ax * bb - bx * ab) / determinant, uv[1] + (aa * bx - ab * ax) / determinant];
        uv = uv.map(|c| c.clamp(0.0, 1.0));
        if net.is_triangle() && uv[0] + uv[1] > 1.0 {
            let excess = (uv[0] + uv[1] - 1.0) / 2.0;
            uv = uv.map(|c| (c - excess).clamp(0.0, 1.0));
        }
    }
    distance(place, point(net, uv[0], uv[1]))
}
