//! Edges of patches: where their control points stand, and which edges of two patches are the same curve.

use crate::geometry::Point3;
use crate::num::{I16F16, bits_i16f16};
use crate::patch::{SurfaceNet, triangle_index};

/// The number of edges of a patch.
pub(crate) const fn edge_count(net: &SurfaceNet<'_>) -> usize {
    if net.is_triangle() { 3 } else { 4 }
}

/// The degree of an edge.
pub(crate) const fn edge_degree(net: &SurfaceNet<'_>, edge: usize) -> usize {
    let (m, h) = net.degrees();
    if edge < 2 { h } else { m }
}

/// Where control point `k` of an edge stands.
///
/// Edges of a tensor-product patch: 0 r = 0, 1 r = 1 (both run along s), 2 s = 0, 3 s = 1 (along r). Of a triangle:
/// 0 u = 0 from T2 to T3, 1 v = 0 from T1 to T3, 2 w = 0 from T1 to T2.
pub(crate) const fn edge_index(net: &SurfaceNet<'_>, edge: usize, k: usize) -> usize {
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

/// A control point by index; the origin out of range, which no index of a net is.
pub(crate) const fn net_point(points: &[Point3], index: usize) -> Point3 {
    if index < points.len() { points[index] } else { Point3::ORIGIN }
}

/// The raw bits of a control point of an edge and of its weight.
const fn edge_bits(net: &SurfaceNet<'_>, edge: usize, k: usize) -> [i64; 4] {
    let index = edge_index(net, edge, k);
    let p = net_point(net.points(), index);
    let weight = match net.weights() {
        Some(weights) if index < weights.len() => weights[index],
        _ => I16F16::ONE,
    };
    [bits_i16f16(p.x), bits_i16f16(p.y), bits_i16f16(p.z), bits_i16f16(weight)]
}

/// Whether the first `count` numbers agree.
const fn agree(a: &[i64; 4], b: &[i64; 4], count: usize) -> bool {
    let mut c = 0;
    while c < count {
        if a[c] != b[c] {
            return false;
        }
        c += 1;
    }
    true
}

/// Whether all control points of an edge are one.
pub(crate) const fn is_collapsed(net: &SurfaceNet<'_>, edge: usize) -> bool {
    let first = edge_bits(net, edge, 0);
    let mut k = edge_degree(net, edge);
    while k > 0 {
        if !agree(&edge_bits(net, edge, k), &first, 3) {
            return false;
        }
        k -= 1;
    }
    true
}

/// Whether two edges of one degree have the same control points and weights, in the same order or reversed.
const fn equal(a: (&SurfaceNet<'_>, usize), b: (&SurfaceNet<'_>, usize), degree: usize, reversed: bool) -> bool {
    let mut k = 0;
    while k <= degree {
        let other = if reversed { degree - k } else { k };
        if !agree(&edge_bits(a.0, a.1, k), &edge_bits(b.0, b.1, other), 4) {
            return false;
        }
        k += 1;
    }
    true
}

/// Whether two edges have bit-equal control polygons: `Some(false)` in the same order, `Some(true)` reversed.
///
/// A polynomial edge has the weights 1.
pub(crate) const fn same_curve(a: (&SurfaceNet<'_>, usize), b: (&SurfaceNet<'_>, usize)) -> Option<bool> {
    let degree = edge_degree(a.0, a.1);
    if degree != edge_degree(b.0, b.1) {
        None
    } else if equal(a, b, degree, false) {
        Some(false)
    } else if equal(a, b, degree, true) {
        Some(true)
    } else {
        None
    }
}

/// Whether an edge runs there and back: bit-equal to itself reversed.
pub(crate) const fn is_palindrome(net: &SurfaceNet<'_>, edge: usize) -> bool {
    equal((net, edge), (net, edge), edge_degree(net, edge), true)
}

/// Whether an edge runs the way of the border that has the surface's inside on its left, seen from where
/// S_r × S_s (S_u × S_v) points to.
pub(crate) const fn runs_forward(net: &SurfaceNet<'_>, edge: usize) -> bool {
    if net.is_triangle() { edge != 1 } else { edge == 1 || edge == 2 }
}
