//! Edges of patches: where their control points stand, and which edges of two patches are the same curve.

use crate::geometry::Point3;
use crate::num::I16F16;
use crate::patch::{SurfaceNet, triangle_index};

/// The number of edges of a patch.
pub(crate) fn edge_count(net: &SurfaceNet<'_>) -> usize {
    if net.is_triangle() { 3 } else { 4 }
}

/// The degree of an edge.
pub(crate) fn edge_degree(net: &SurfaceNet<'_>, edge: usize) -> usize {
    let (m, h) = net.degrees();
    if edge < 2 { h } else { m }
}

/// Where control point `k` of an edge stands.
///
/// Edges of a tensor-product patch: 0 r = 0, 1 r = 1 (both run along s), 2 s = 0, 3 s = 1 (along r). Of a triangle:
/// 0 u = 0 from T2 to T3, 1 v = 0 from T1 to T3, 2 w = 0 from T1 to T2.
pub(crate) fn edge_index(net: &SurfaceNet<'_>, edge: usize, k: usize) -> usize {
    let (m, h) = net.degrees();
    if net.is_triangle() {
        match edge {
            0 => triangle_index(m - k, k),
            1 => triangle_index(0, k),
            _ => triangle_index(k, 0),
        }
    } else {
        match edge {
            0 => k,
            1 => m * (h + 1) + k,
            2 => k * (h + 1),
            _ => k * (h + 1) + h,
        }
    }
}

/// A control point of an edge and its weight.
fn edge_point(net: &SurfaceNet<'_>, edge: usize, k: usize) -> Option<(Point3, I16F16)> {
    let index = edge_index(net, edge, k);
    let weight = net.weights().map_or(Some(I16F16::ONE), |w| w.get(index).copied())?;
    Some((*net.points().get(index)?, weight))
}

/// Whether all control points of an edge are one.
pub(crate) fn is_collapsed(net: &SurfaceNet<'_>, edge: usize) -> bool {
    let point = |k| edge_point(net, edge, k).map(|(p, _)| p);
    (1..=edge_degree(net, edge)).all(|k| point(k) == point(0))
}

/// Whether two edges have bit-equal control polygons: `Some(false)` in the same order, `Some(true)` reversed.
///
/// A polynomial edge has the weights 1.
pub(crate) fn same_curve(a: (&SurfaceNet<'_>, usize), b: (&SurfaceNet<'_>, usize)) -> Option<bool> {
    let degree = edge_degree(a.0, a.1);
    if degree != edge_degree(b.0, b.1) {
        return None;
    }
    let equal =
        |at: &dyn Fn(usize) -> usize| (0..=degree).all(|k| edge_point(a.0, a.1, k) == edge_point(b.0, b.1, at(k)));
    if equal(&|k| k) {
        Some(false)
    } else if equal(&|k| degree - k) {
        Some(true)
    } else {
        None
    }
}
