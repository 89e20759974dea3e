//! From two rows of vertices to convex facets: clipping, culling, splitting, levels.

use super::super::light::{Light, normal_of, short};
use super::super::pen::tangents_inside;
use super::super::style::Style;
use super::vertices::{Lit, Row, RowSink, Rows, Vertex};
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
    /// The output's.
    pub(super) window: [i32; 4],
    /// The first column of the strip.
    pub(super) first: u32,
    pub(super) facets: u64,
}

/// Twice the signed area of three vertices, exact: they are less than 2^15 apart.
#[inline(always)]
fn area(a: &Vertex, b: &Vertex, c: &Vertex) -> i32 {
    (b.x - a.x).wrapping_mul(c.y - a.y).wrapping_sub((b.y - a.y).wrapping_mul(c.x - a.x))
}

/// Whether a pixel centre of `from .. to` lies between the least and the greatest of four coordinates.
#[inline(always)]
fn has_centres([a, b, c, d]: [i32; 4], from: i32, to: i32) -> bool {
    let up = |c: i32| (c + (1 << FRACTION_BITS) - 1) >> FRACTION_BITS;
    let (first, end) = (up(a.min(b).min(c).min(d)), up(a.max(b).max(c).max(d)));
    first < end && end > from && first < to
}

/// How far a plane may be from the corners of a quad: 4 times 12 levels, 4 times 1/128 of the depths.
const WARP: (i32, i32) = (48, 1024);

/// Two rows and the cell between them.
struct Cell<'r> {
    above: &'r mut Row,
    below: &'r mut Row,
    k: usize,
    j: u32,
}

/// A corner of a cell, in the order in which they go round.
#[derive(Clone, Copy)]
enum Corner {
    A,
    B,
    C,
    D,
}

impl Cell<'_> {
    #[inline(always)]
    fn vertex(&mut self, corner: Corner) -> Option<(&mut Vertex, usize, u32)> {
        let (row, column, j) = match corner {
            Corner::A => (&mut *self.above, self.k, self.j - 1),
            Corner::B => (&mut *self.above, self.k + 1, self.j - 1),
            Corner::C => (&mut *self.below, self.k + 1, self.j),
            Corner::D => (&mut *self.below, self.k, self.j),
        };
        Some((row.get_mut(column)?, column, j))
    }
}

impl<O: Output> Cells<'_, O> {
    /// The cell with the corners (i, j−1), (i+1, j−1), (i+1, j), (i, j); a triangle lacks the third.
    fn cell(&mut self, mut cell: Cell<'_>, is_triangle: bool) {
        let (above, below) = (cell.above.get(cell.k..cell.k + 2), cell.below.get(cell.k..cell.k + 2));
        let (Some([a, b]), Some([d, c])) = (above, below) else { return };
        let c = if is_triangle { d } else { c };
        let [x_from, x_to, y_from, y_to] = self.window;
        if !has_centres([a.y, b.y, c.y, d.y], y_from, y_to) || !has_centres([a.x, b.x, c.x, d.x], x_from, x_to) {
            return;
        }
        let (abc, acd) = (area(a, b, c), area(a, c, d));
        let hidden = match self.side {
            Side::Both => (abc | acd) == 0 && area(a, b, d) == 0,
            Side::Along => abc >= 0 && acd >= 0,
            Side::Against => abc <= 0 && acd <= 0,
        };
        if hidden {
            return;
        }
        let (abd, bcd) = (area(a, b, d), area(b, c, d));
        let third = if is_triangle { Corner::D } else { Corner::C };
        if (abc | acd | abd | bcd) >= 0 || (abc <= 0 && acd <= 0 && abd <= 0 && bcd <= 0) {
            self.convex(&mut cell, abc < 0 || acd < 0, [Corner::A, Corner::B, third, Corner::D], !is_triangle);
        } else if (abc >= 0) != (acd >= 0) && (abd >= 0) == (bcd >= 0) {
            let along = abd < 0 || bcd < 0;
            self.convex(&mut cell, along, [Corner::A, Corner::B, Corner::D, Corner::D], false);
            self.convex(&mut cell, along, [Corner::B, Corner::C, Corner::D, Corner::D], false);
        } else {
            self.convex(&mut cell, abc < 0, [Corner::A, Corner::B, Corner::C, Corner::C], false);
            self.convex(&mut cell, acd < 0, [Corner::A, Corner::C, Corner::D, Corner::D], false);
        }
    }

    /// A convex quad, or a triangle with its last corner twice.
    fn convex(&mut self, cell: &mut Cell<'_>, along: bool, corners: [Corner; 4], is_quad: bool) {
        if !self.side.shows(along) {
            return;
        }
        let mut quad = Quad { x: [0; 4], y: [0; 4], depth: [0; 4], level: [0; 4], patch: self.patch };
        for (k, corner) in corners.into_iter().enumerate() {
            // Clockwise on the screen: the other way round where S_r × S_s looks at the viewer.
            let k = if along { (4 - k) & 3 } else { k };
            let Some((vertex, column, j)) = cell.vertex(corner) else { return };
            quad.level[k] = self.lighting.level(vertex, along, self.first + column as u32, j);
            (quad.x[k], quad.y[k], quad.depth[k]) = (vertex.x, vertex.y, vertex.depth);
        }
        let warp = |[a, b, c, d]: [i32; 4]| (a - b + c - d).abs();
        let is_bent = |q: &Quad| warp(q.level.map(i32::from)) > WARP.0 || warp(q.depth.map(i32::from)) > WARP.1;
        self.facets += 1;
        if is_quad && is_bent(&quad) {
            self.facets += 1;
            self.output.facet(&quad.corners([0, 1, 2, 2]));
            self.output.facet(&quad.corners([0, 2, 3, 3]));
        } else {
            self.output.facet(&quad);
        }
    }
}

impl<O: Output> RowSink for Cells<'_, O> {
    fn row(&mut self, rows: &mut Rows, j: u32, count: usize) {
        if j == 0 {
            return;
        }
        let [even, odd] = &mut rows.0;
        let (above, below) = if j & 1 == 1 { (even, odd) } else { (odd, even) };
        for k in 0..count.saturating_sub(1) {
            self.cell(Cell { above, below, k, j }, false);
        }
        // The row before is longer by one in a triangle, unless the strip ends first.
        let form = self.lighting.form;
        let last = self.first + count as u32 - 1;
        if form.last_in_row(j) == last && form.last_in_row(j - 1) > last && count <= super::SEGMENTS {
            self.cell(Cell { above, below, k: count - 1, j }, true);
        }
    }
}
