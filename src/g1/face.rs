//! The 21 control points of a face.

use super::balance::View;
use super::edge::{Edge, End};
use super::setting::fits;
use super::solve::Solved;
use super::{G1Error, Scheme};
use crate::mesh::HalfEdge;
use crate::num::{Coord, Sum3, Triple, minus, plus};

/// The control points of a quintic triangle, b\[i,j,k\] with i descending, then j descending.
pub(super) type Points = [Triple; 21];

/// Where b\[i,j,k\] stands, from j and k.
pub(super) const fn index(j: usize, k: usize) -> usize {
    (j + k) * (j + k + 1) / 2 + k
}

/// Where the point with weight `a` at corner c, `b` at the next and `rest` at the one after it stands.
pub(super) const fn index_from(corner: usize, a: usize, b: usize, rest: usize) -> usize {
    match corner % 3 {
        0 => index(b, rest),
        1 => index(a, b),
        _ => index(rest, a),
    }
}

/// A corner of a face with its two edges: to the next corner and to the previous one.
#[derive(Clone, Copy, Debug)]
pub(super) struct Corner {
    pub(super) ends: [End; 2],
    /// The tangents, from the vertex.
    pub(super) e: [Triple; 2],
    /// Where c2 of both edges and the twist point should be, from the vertex.
    curve_target: [Triple; 2],
    twist_target: Triple,
    twist: Triple,
    vertex: usize,
    at: Triple,
}

impl Corner {
    /// The corner that a half-edge leaves.
    fn of(solved: &Solved, half_edge: usize) -> Self {
        let (fan, i) = (&solved.fan, solved.fan.star.place_of_half_edge(half_edge));
        let next = fan.star.after(i);
        Self {
            ends: [End::of(solved, i), End::of(solved, next)],
            e: [fan.e[i], fan.e[next]],
            curve_target: [solved.curve_target[i], solved.curve_target[next]],
            twist_target: solved.twist_target[i],
            twist: solved.w[i],
            vertex: fan.vertex,
            at: fan.at,
        }
    }
}

/// A face: its control points in working units, and what they aimed at.
#[derive(Clone, Copy, Debug)]
pub(super) struct Face {
    pub(super) points: Points,
    /// The degree-elevated PN triangle with the same tangents.
    pub(super) target: Points,
}

impl<C: Coord> View<'_, '_, C> {
    /// The corners of a face.
    #[inline(never)]
    fn corner(&self, half_edge: usize) -> Result<Corner, G1Error> {
        let vertex = self.setting.mesh.origin(HalfEdge::new(half_edge as u16));
        let mut solved = Solved::blank();
        self.solved(vertex, &mut solved)?;
        Ok(Corner::of(&solved, half_edge))
    }

    /// The control points of a face.
    #[inline(never)]
    pub(super) fn face(&self, face: usize) -> Result<Face, G1Error> {
        if self.setting.options.scheme == Scheme::Flat {
            return self.flat(face);
        }
        let corners = [self.corner(3 * face)?, self.corner(3 * face + 1)?, self.corner(3 * face + 2)?];
        let vertex = corners[0].vertex;
        let target = fits(target(&corners), vertex)?;
        let mut points = target;
        for (c, corner) in corners.iter().enumerate() {
            let [next, previous] = &corner.ends;
            points[index_from(c, 4, 1, 0)] = next.along[1];
            points[index_from(c, 4, 0, 1)] = previous.along[1];
            points[index_from(c, 3, 2, 0)] = next.along[2];
            points[index_from(c, 3, 0, 2)] = previous.along[2];
            points[index_from(c, 3, 1, 1)] = plus(&corner.at, &corner.twist);
        }
        if self.setting.options.scheme != Scheme::PointNormal {
            for c in 0..3 {
                self.middle(3 * face + c, c, &corners, &mut points)?;
            }
        }
        Ok(Face { points, target })
    }

    /// The points that belong to the edge that a half-edge of the face runs along.
    #[inline(never)]
    fn middle(&self, half_edge: usize, c: usize, corners: &[Corner; 3], points: &mut Points) -> Result<(), G1Error> {
        let (from, to) = (&corners[c % 3], &corners[(c + 1) % 3]);
        let at = index_from(c, 2, 2, 1);
        if self.setting.mesh.twin(HalfEdge::new(half_edge as u16)).is_none() {
            // A border: the target and the mean of its neighbours' changes.
            let change = |corner: &Corner| minus(&corner.twist, &corner.twist_target);
            let sum = Sum3::default().plus(&points[at], 2).plus(&change(from), 1).plus(&change(to), 1);
            points[at] = fits(sum.narrow(1), from.vertex)?;
            return Ok(());
        }
        // Both faces fill the edge in the same direction, to the same bits.
        let along = from.vertex < to.vertex;
        let (first, last) = (&from.ends[0], &to.ends[1]);
        let edge = if along { self.setting.edge(first, last)? } else { self.setting.edge(last, first)? };
        points[at] = if along { edge.l[2] } else { edge.r[2] };
        let curve = if along { [edge.c[2], edge.c[3]] } else { [edge.c[3], edge.c[2]] };
        [points[index_from(c, 3, 2, 0)], points[index_from(c, 2, 3, 0)]] = curve;
        Ok(())
    }

    /// A flat triangle.
    fn flat(&self, face: usize) -> Result<Face, G1Error> {
        let corner = |c: usize| self.setting.mesh.origin(HalfEdge::new((3 * face + c) as u16));
        let [p, q, r] = [0, 1, 2].map(|c| self.setting.place(corner(c)));
        let mut points = [p; 21];
        for row in 0..=5 {
            for k in 0..=row {
                let factors = [5 - row, row - k, k].map(|factor| factor as i64);
                let sum = Sum3::default().plus(&p, factors[0]).plus(&q, factors[1]).plus(&r, factors[2]);
                points[index(row - k, k) % 21] = fits(sum.divide(5), corner(0))?;
            }
        }
        Ok(Face { points, target: points })
    }

    /// The points of an inner edge, from its vertex of the lesser number.
    #[inline(never)]
    pub(super) fn edge_of(&self, half_edge: usize, twin: usize) -> Result<Edge, G1Error> {
        let (from, to) = (self.corner(half_edge)?, self.corner(twin)?);
        let [first, last] = if from.vertex < to.vertex { [&from, &to] } else { [&to, &from] };
        self.setting.edge(&first.ends[0], &last.ends[0])
    }
}

/// The degree-elevated PN triangle with the tangents of the corners. Beside the middle of an edge ab lies
/// (13·(a + b) + 4·c + 5·(2·e_ab + 2·e_ba + e_ac + e_bc + Σe))/30.
fn target(corners: &[Corner; 3]) -> Option<Points> {
    let mut points = [corners[0].at; 21];
    let all = corners.iter().flat_map(|corner| &corner.e).fold(Sum3::default(), |sum, e| sum.plus(e, 5));
    for (c, corner) in corners.iter().enumerate() {
        let (next, last) = (&corners[(c + 1) % 3], &corners[(c + 2) % 3]);
        let from = |vector: &Triple| plus(&corner.at, vector);
        points[index_from(c, 5, 0, 0)] = corner.at;
        points[index_from(c, 4, 1, 0)] = from(&corner.e[0]);
        points[index_from(c, 4, 0, 1)] = from(&corner.e[1]);
        points[index_from(c, 3, 2, 0)] = from(&corner.curve_target[0]);
        points[index_from(c, 3, 0, 2)] = from(&corner.curve_target[1]);
        points[index_from(c, 3, 1, 1)] = from(&corner.twist_target);
        let sum = all.plus(&corner.at, 13).plus(&next.at, 13).plus(&last.at, 4);
        let sum = sum.plus(&corner.e[0], 10).plus(&next.e[1], 10).plus(&corner.e[1], 5).plus(&next.e[0], 5);
        points[index_from(c, 2, 2, 1)] = sum.divide(30)?;
    }
    Some(points)
}
