//! Exact predicates on grid triangles, made generic by moving all of B by (δ, δ², δ³), δ → 0.
//!
//! Coordinates have 32 bits, differences 33, a determinant of three differences at most 102: `i128` is exact. Where a
//! determinant is 0 the sign is that of the first component of the normal (or of the cross product of two edges) that
//! is not 0, which is what δ leaves; a cross product that vanishes altogether belongs to parallel edges, and then the
//! ends of the edge lie on one side of the plane and the predicate is not reached.

use super::grid::GridVertex;

/// A vector of exact integers.
type Wide = [i128; 3];

/// How B is moved, and how often that decided.
#[derive(Clone, Copy, Debug)]
pub(super) struct Perturbation {
    /// Whether δ is positive.
    pub(super) positive: bool,
    /// Predicates that were 0 without the move.
    pub(super) zeros: u32,
}

#[inline(always)]
fn minus(a: GridVertex, b: GridVertex) -> [i64; 3] {
    three!(|k| i64::from(a[k]) - i64::from(b[k]))
}

#[cfg_attr(target_pointer_width = "32", inline(never))]
#[cfg_attr(not(target_pointer_width = "32"), inline(always))]
fn cross(a: [i64; 3], b: [i64; 3]) -> Wide {
    let [a, b] = [a, b].map(|v| v.map(i128::from));
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

#[cfg_attr(target_pointer_width = "32", inline(never))]
#[cfg_attr(not(target_pointer_width = "32"), inline(always))]
fn dot(a: &Wide, b: [i64; 3]) -> i128 {
    a[0] * i128::from(b[0]) + a[1] * i128::from(b[1]) + a[2] * i128::from(b[2])
}

/// The normal of a triangle, exact.
#[inline(always)]
pub(super) fn normal([a, b, c]: [GridVertex; 3]) -> Wide {
    cross(minus(b, a), minus(c, a))
}

/// The height of a point over the plane through `a`, times the length of the normal.
#[inline(always)]
pub(super) fn height(normal: &Wide, a: GridVertex, x: GridVertex) -> i128 {
    dot(normal, minus(x, a))
}

impl Perturbation {
    /// The sign of a determinant whose point belongs to B or, `of_a`, to A.
    #[inline(always)]
    fn resolve(&mut self, determinant: i128, vector: &Wide, of_a: bool) -> bool {
        if determinant != 0 {
            return determinant > 0;
        }
        self.zeros = self.zeros.saturating_add(1);
        let first = vector.iter().find(|c| **c != 0).copied().unwrap_or(1);
        (first > 0) ^ of_a ^ !self.positive
    }

    /// On which side of a triangle's plane a point of the other patch lies; `of_a`: the point is A's.
    #[inline(always)]
    pub(super) fn side(&mut self, normal: &Wide, a: GridVertex, x: GridVertex, of_a: bool) -> bool {
        let determinant = height(normal, a, x);
        self.resolve(determinant, normal, of_a)
    }

    /// Whether the edge pq passes the side ab of a triangle on its left; `of_a`: the edge is A's.
    #[inline(always)]
    fn passes(&mut self, [p, q]: [GridVertex; 2], [a, b]: [GridVertex; 2], of_a: bool) -> bool {
        let normal = cross(minus(b, a), minus(q, p));
        let determinant = dot(&normal, minus(p, a));
        self.resolve(determinant, &normal, of_a)
    }

    /// Whether an edge whose ends lie on both sides of a triangle's plane crosses the triangle.
    #[inline(always)]
    pub(super) fn crosses(&mut self, edge: [GridVertex; 2], [a, b, c]: [GridVertex; 3], of_a: bool) -> bool {
        let first = self.passes(edge, [a, b], of_a);
        first == self.passes(edge, [b, c], of_a) && first == self.passes(edge, [c, a], of_a)
    }
}

/// Whether a triangle has no normal.
pub(super) fn is_degenerate(normal: &Wide) -> bool {
    normal.iter().all(|c| *c == 0)
}
