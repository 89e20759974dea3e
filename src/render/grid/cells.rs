//! From two rows of vertices to convex facets: clipping, culling, splitting, levels.

use super::super::light::Light;
use super::super::style::Style;
use super::quad::rows;
use super::vertices::{Lit, Normals, Row, RowSink, Rows, Vertex};
use super::{Output, Quad};
use crate::forward::Form;

/// Where levels come from.
#[derive(Clone, Copy, Debug)]
pub(in crate::render) struct Lighting<'a> {
    pub(super) light: &'a Light,
    pub(super) style: Style,
    pub(super) form: &'a Form<'a>,
    pub(super) side: Side,
}

impl Lighting<'_> {
    /// Whether vertices keep which side is lit until a facet asks: where both sides are drawn, or there is a highlight.
    #[inline(always)]
    fn keeps_sides(&self) -> bool {
        self.side == Side::Both || matches!(self.style, Style::Glossy(_))
    }

    /// The level of the side that is drawn; of both, that of the one that the light reaches, and which one it is.
    #[inline(always)]
    pub(super) fn shade(&self, vertex: &mut Vertex, normal: Option<[i32; 3]>) {
        let normal = normal.unwrap_or([0, 0, -1]);
        if self.keeps_sides() {
            return self.shade_in_full(vertex, normal);
        }
        vertex.level = self.light.level_of_turned(normal, self.side == Side::Against);
        vertex.lit = Lit::Both;
    }

    #[inline(never)]
    fn shade_in_full(&self, vertex: &mut Vertex, normal: [i32; 3]) {
        let (level, along) = self.light.level_of_lit_side(normal);
        vertex.level = match self.style {
            Style::Glossy(gloss) => self.light.glossy(if along { normal } else { normal.map(|n| -n) }, gloss),
            _ => level,
        };
        vertex.lit = if along { Lit::Along } else { Lit::Against };
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

    /// What is to be turned in areas and what is to be added so that a cell of areas that are not negative then is hidden;
    /// where areas are zero, others may be as well.
    #[inline(always)]
    fn masks(self) -> [i32; 2] {
        match self {
            Self::Both => [0, -1],
            Self::Along => [0, 0],
            Self::Against => [-1, 0],
        }
    }

    /// Whether both triangles of a cell of these areas are hidden.
    #[inline(always)]
    fn hides(self, [abc, acd]: [i32; 2]) -> bool {
        match self {
            Self::Both => false,
            Self::Along => abc >= 0 && acd >= 0,
            Self::Against => abc <= 0 && acd <= 0,
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
pub(super) struct Cells<'a> {
    /// The facet that is made, of this patch.
    pub(super) quad: Quad,
    pub(super) lighting: Lighting<'a>,
    pub(super) output: &'a mut dyn Output,
    /// The output's.
    pub(super) window: [i32; 4],
    /// The first column of the strip.
    pub(super) first: u32,
    pub(super) facets: u32,
}

/// Twice the signed area between two sides that leave a vertex.
#[inline(always)]
fn cross(p: [i32; 2], q: [i32; 2]) -> i32 {
    p[0].wrapping_mul(q[1]).wrapping_sub(p[1].wrapping_mul(q[0]))
}

fn minus(p: [i32; 2], q: [i32; 2]) -> [i32; 2] {
    [p[0] - q[0], p[1] - q[1]]
}

/// Whether there are pixel centres of `from .. to` in `first .. end`.
#[inline(always)]
fn meet([first, end]: [i32; 2], from: i32, to: i32) -> bool {
    first < end && end > from && first < to
}

/// A cell between two rows.
struct Cell<'r> {
    /// (i, j−1), (i+1, j−1), (i+1, j), (i, j); of a triangle the third is not used.
    corners: [&'r mut Vertex; 4],
    normals: &'r dyn Normals,
    /// i and j.
    at: [u32; 2],
}

impl Cells<'_> {
    /// Finds the level of a corner where it is not known.
    #[inline(always)]
    fn shade(&self, vertex: &mut Vertex, corner: usize, normals: &dyn Normals, at: [u32; 2]) {
        if vertex.lit == Lit::Unknown {
            let (i, j) = (at[0] + u32::from(corner == 1 || corner == 2), at[1] - u32::from(corner < 2));
            normals.shade(&self.lighting, vertex, [i, j]);
        }
    }

    /// Gives corners that look away from the light its level.
    #[inline(always)]
    fn darken(&mut self, along: bool) {
        let dark = if along { Lit::Against } else { Lit::Along };
        for corner in &mut self.quad.corners {
            if corner.lit == dark {
                corner.level = self.lighting.light.ambient();
            }
        }
    }

    /// Draws a cell that may be seen, given twice the areas of its triangles abc and acd.
    #[inline(always)]
    fn cell(&mut self, cell: Cell<'_>, [abc, acd]: [i32; 2], is_triangle: bool) {
        let Cell { corners: [a, b, c, d], normals, at } = cell;
        let abd = cross([b.x - a.x, b.y - a.y], [d.x - a.x, d.y - a.y]);
        let bcd = abc.wrapping_add(acd).wrapping_sub(abd);
        let [x_from, x_to, y_from, y_to] = self.window;
        let rows_of_cell = rows([a.y, b.y, c.y, d.y]);
        if (abc | acd | abd) == 0
            || self.lighting.side.hides([abc, acd])
            || !meet(rows_of_cell, y_from, y_to)
            || (self.quad.is_wide && !meet(rows([a.x, b.x, c.x, d.x]), x_from, x_to))
        {
            return;
        }
        let is_convex = (abc | acd | abd | bcd) >= 0 || (abc <= 0 && acd <= 0 && abd <= 0 && bcd <= 0);
        if !is_convex || is_triangle {
            let mut cell = Cell { corners: [a, b, c, d], normals, at };
            return if is_triangle {
                self.triangle(&mut cell, abc < 0, [0, 1, 3]);
            } else {
                self.folded(&mut cell, [abc, acd, abd, bcd]);
            };
        }
        self.shade(a, 0, normals, at);
        self.shade(b, 1, normals, at);
        self.shade(c, 2, normals, at);
        self.shade(d, 3, normals, at);
        // Clockwise on the screen: the other way round where S_r × S_s looks at the viewer.
        let along = (abc | acd) < 0;
        let (second, fourth) = if along { (d, b) } else { (b, d) };
        let quad = &mut self.quad;
        (quad.corners[0], quad.corners[1], quad.corners[2], quad.corners[3]) = (*a, *second, *c, *fourth);
        quad.rows = rows_of_cell;
        self.put(along);
    }

    /// Sends the facet that was made to the output.
    #[inline(always)]
    fn put(&mut self, along: bool) {
        if self.lighting.keeps_sides() {
            self.darken(along);
        }
        self.facets += 1;
        self.output.facet(&self.quad);
    }

    /// A cell that is not convex, cut along one of its diagonals.
    #[cold]
    #[inline(never)]
    fn folded(&mut self, cell: &mut Cell<'_>, [abc, acd, abd, bcd]: [i32; 4]) {
        if (abc >= 0) != (acd >= 0) && (abd >= 0) == (bcd >= 0) {
            let along = abd < 0 || bcd < 0;
            self.triangle(cell, along, [0, 1, 3]);
            self.triangle(cell, along, [1, 2, 3]);
        } else {
            self.triangle(cell, abc < 0, [0, 1, 2]);
            self.triangle(cell, acd < 0, [0, 2, 3]);
        }
    }

    /// A triangle of three corners, its last one twice.
    #[inline(never)]
    fn triangle(&mut self, cell: &mut Cell<'_>, along: bool, corners: [usize; 3]) {
        if !self.lighting.side.shows(along) {
            return;
        }
        for corner in corners {
            self.shade(cell.corners[corner & 3], corner, cell.normals, cell.at);
        }
        let [a, b, c] = corners.map(|corner| *cell.corners[corner & 3]);
        let corners = if along { [a, c, b, b] } else { [a, b, c, c] };
        self.quad = Quad::new(corners, self.quad.patch, self.quad.is_wide);
        self.put(along);
    }
}

impl RowSink for Cells<'_> {
    #[inline(never)]
    fn row(&mut self, rows: &mut Rows, normals: &dyn Normals, j: u32, count: usize) {
        if j == 0 {
            return;
        }
        let [even, odd] = &mut rows.0;
        let (above, below) = if j & 1 == 1 { (even, odd) } else { (odd, even) };
        let ends = above.iter().zip(below.iter()).next();
        let Some((mut a, mut d)) = ends.map(|(a, d)| ([a.x, a.y], [d.x, d.y])) else { return };
        let [turn, keep] = self.lighting.side.masks();
        for k in 0..count.saturating_sub(1).min(super::SEGMENTS) {
            let (b, c) = (above[k + 1].place(), below[k + 1].place());
            // All products are exact: corners are less than 2^15 apart.
            let ac = minus(c, a);
            let areas = [cross(minus(b, a), ac), cross(ac, minus(d, a))];
            if ((areas[0] ^ turn) | (areas[1] ^ turn) | keep) < 0 {
                self.seen(above, below, (normals, j, k), areas);
            }
            (a, d) = (b, c);
        }
        // The row before is longer by one in a triangle, unless the strip ends first.
        let form = self.lighting.form;
        let last = self.first + count as u32 - 1;
        if form.last_in_row(j) == last && form.last_in_row(j - 1) > last && count <= super::SEGMENTS {
            self.last(above, below, (normals, j, count - 1));
        }
    }
}

impl Cells<'_> {
    /// The cell after column `k` of the strip.
    #[inline(never)]
    fn seen(&mut self, above: &mut Row, below: &mut Row, (normals, j, k): (&dyn Normals, u32, usize), areas: [i32; 2]) {
        let at = [self.first + k as u32, j];
        if let (Some([a, b]), Some([d, c])) = (above.get_mut(k..k + 2), below.get_mut(k..k + 2)) {
            self.cell(Cell { corners: [a, b, c, d], normals, at }, areas, false);
        }
    }

    /// The triangle at the end of a row of a triangular patch, after column `k` of the strip.
    #[cold]
    #[inline(never)]
    fn last(&mut self, above: &mut Row, below: &mut Row, (normals, j, k): (&dyn Normals, u32, usize)) {
        if let (Some([a, b]), Some(d)) = (above.get_mut(k..k + 2), below.get_mut(k)) {
            let mut c = *d;
            let ac = minus(c.place(), a.place());
            let areas = [cross(minus(b.place(), a.place()), ac), 0];
            self.cell(Cell { corners: [a, b, &mut c, d], normals, at: [self.first + k as u32, j] }, areas, true);
        }
    }
}
