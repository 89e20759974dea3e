//! From two rows of vertices to convex facets: clipping, culling, splitting, levels.

use super::super::light::{Light, normal_of, short};
use super::super::pen::tangents_inside;
use super::super::style::Style;
use super::vertices::{Lit, RowSink, Rows, Vertex};
use super::{FRACTION_BITS, Output, Quad};
use crate::forward::Form;
use crate::patch::SurfaceNet;

/// Where levels come from.
#[derive(Clone, Copy, Debug)]
pub(in crate::render) struct Lighting<'a> {
    pub(super) light: &'a Light,
    pub(super) style: Style,
    pub(super) net: SurfaceNet<'a>,
    pub(super) form: &'a Form<'a>,
}

impl Lighting<'_> {
    /// The level of the side that the light reaches, and which one it is.
    #[inline(never)]
    fn shade(&self, vertex: &mut Vertex, i: u32, j: u32) {
        let inside = || normal_of(tangents_inside(self.net, self.form, i, j)?.map(short));
        let normal = normal_of(vertex.tangents).or_else(inside).unwrap_or([0, 0, -1]);
        let along = normal.iter().zip(self.light.direction()).map(|(n, l)| n * l).sum::<i32>() >= 0;
        let normal = if along { normal } else { normal.map(|n| -n) };
        vertex.level = match self.style {
            Style::Glossy(gloss) => self.light.glossy(normal, gloss),
            _ => self.light.level(normal),
        };
        vertex.lit = if along { Lit::Along } else { Lit::Against };
    }

    /// The level of a vertex on the side that is seen.
    #[inline(always)]
    fn level(&self, vertex: &mut Vertex, along: bool, i: u32, j: u32) -> u8 {
        if vertex.lit == Lit::Unknown {
            self.shade(vertex, i, j);
        }
        match vertex.lit {
            Lit::Against if along => self.light.ambient(),
            Lit::Along if !along => self.light.ambient(),
            _ => vertex.level,
        }
    }
}

/// Which facets are drawn, by the sign of their area: negative where S_r × S_s looks at the viewer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Side {
    Both,
    Along,
    Against,
}

impl Side {
    pub(super) fn of(inward: Option<bool>) -> Self {
        match inward {
            None => Self::Both,
            Some(false) => Self::Along,
            Some(true) => Self::Against,
        }
    }

    fn shows(self, along: bool) -> bool {
        match self {
            Self::Both => true,
            Self::Along => along,
            Self::Against => !along,
        }
    }
}

/// Makes facets of the cells between two rows.
pub(super) struct Cells<'a, O> {
    pub(super) patch: usize,
    pub(super) lighting: Lighting<'a>,
    pub(super) side: Side,
    pub(super) output: &'a mut O,
    /// The first column of the strip.
    pub(super) first: u32,
    pub(super) facets: u64,
}

/// A corner of a cell: its vertex, by row and column in the strip.
type Corner = (usize, usize);

/// Twice the signed area of three vertices, exact: they are less than 2^15 apart.
fn area(a: &Vertex, b: &Vertex, c: &Vertex) -> i32 {
    (b.x - a.x).wrapping_mul(c.y - a.y).wrapping_sub((b.y - a.y).wrapping_mul(c.x - a.x))
}

/// The first pixel centre from each of two coordinates on.
fn centres(low: i32, high: i32) -> (i32, i32) {
    let up = |c: i32| (c + (1 << FRACTION_BITS) - 1) >> FRACTION_BITS;
    (up(low), up(high))
}

/// How far a plane may be from the corners of a quad: 4 times 12 levels, 4 times 1/128 of the depths.
const WARP: (i32, i32) = (48, 1024);

impl<O: Output> Cells<'_, O> {
    /// The cell with the corners (i, j), (i+1, j), (i+1, j+1), (i, j+1); the last two are one in a triangle.
    fn cell(&mut self, rows: &mut Rows, j: u32, corners: [Corner; 4]) {
        let Some([a, b, c, d]) = vertices(rows, corners) else { return };
        let [x_from, x_to, y_from, y_to] = self.output.window();
        let (first, end) = centres(a.y.min(b.y).min(c.y).min(d.y), a.y.max(b.y).max(c.y).max(d.y));
        if first >= end || end <= y_from || first >= y_to {
            return;
        }
        let (first, end) = centres(a.x.min(b.x).min(c.x).min(d.x), a.x.max(b.x).max(c.x).max(d.x));
        if first >= end || end <= x_from || first >= x_to {
            return;
        }
        let [abc, acd, abd, bcd] = [area(&a, &b, &c), area(&a, &c, &d), area(&a, &b, &d), area(&b, &c, &d)];
        let [p, q, r, s] = corners;
        if (abc | acd | abd | bcd) >= 0 || (abc <= 0 && acd <= 0 && abd <= 0 && bcd <= 0) {
            let along = abc < 0 || acd < 0;
            self.convex(rows, j, along, corners);
        } else if (abc >= 0) != (acd >= 0) && (abd >= 0) == (bcd >= 0) {
            self.convex(rows, j, abd < 0 || bcd < 0, [p, q, s, s]);
            self.convex(rows, j, abd < 0 || bcd < 0, [q, r, s, s]);
        } else {
            self.convex(rows, j, abc < 0, [p, q, r, r]);
            self.convex(rows, j, acd < 0, [p, r, s, s]);
        }
    }

    /// A convex quad, or a triangle with its last corner twice.
    fn convex(&mut self, rows: &mut Rows, j: u32, along: bool, corners: [Corner; 4]) {
        if !self.side.shows(along) {
            return;
        }
        let levels = corners.map(|(row, column)| {
            let (i, j) = (self.first + column as u32, if row == (j & 1) as usize { j } else { j - 1 });
            let vertex = rows.0[row & 1].get_mut(column);
            vertex.map_or(0, |v| self.lighting.level(v, along, i, j))
        });
        let Some(vertices) = vertices(rows, corners) else { return };
        let depths = vertices.map(|v| v.depth);
        let warp = |v: [i32; 4]| (v[0] - v[1] + v[2] - v[3]).abs();
        let is_quad = corners[2] != corners[3];
        if is_quad && (warp(levels.map(i32::from)) > WARP.0 || warp(depths.map(i32::from)) > WARP.1) {
            for [p, q, r] in [[0, 1, 2], [0, 2, 3]] {
                let index = [p, q, r, r];
                self.send(along, index.map(|k| vertices[k]), index.map(|k| levels[k]));
            }
        } else {
            self.send(along, vertices, levels);
        }
    }

    /// Sends a facet, clockwise on the screen.
    fn send(&mut self, along: bool, v: [Vertex; 4], levels: [u8; 4]) {
        let order = if along { [0, 3, 2, 1] } else { [0, 1, 2, 3] };
        self.facets += 1;
        self.output.facet(&Quad {
            x: order.map(|k| v[k].x),
            y: order.map(|k| v[k].y),
            depth: order.map(|k| v[k].depth),
            level: order.map(|k| levels[k]),
            patch: self.patch,
        });
    }
}

fn vertices(rows: &Rows, corners: [Corner; 4]) -> Option<[Vertex; 4]> {
    let [a, b, c, d] = corners.map(|(row, column)| rows.0[row & 1].get(column).copied());
    Some([a?, b?, c?, d?])
}

impl<O: Output> RowSink for Cells<'_, O> {
    fn row(&mut self, rows: &mut Rows, j: u32, count: usize) {
        if j == 0 {
            return;
        }
        let (above, below) = ((j as usize + 1) & 1, (j & 1) as usize);
        for k in 0..count {
            if k + 1 < count {
                self.cell(rows, j, [(above, k), (above, k + 1), (below, k + 1), (below, k)]);
            }
        }
        // The row before is longer by one in a triangle, unless the strip ends first.
        let form = self.lighting.form;
        let last = self.first + count as u32 - 1;
        if form.last_in_row(j) == last && form.last_in_row(j - 1) > last && count <= super::SEGMENTS {
            let k = count - 1;
            self.cell(rows, j, [(above, k), (above, k + 1), (below, k), (below, k)]);
        }
    }
}
