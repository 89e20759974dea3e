//! From two rows of vertices to convex facets: clipping, culling, splitting, levels.

use super::super::light::Light;
use super::super::style::Style;
use super::quad::rows;
use super::vertices::{Lit, Normals, Row, RowSink, Rows, SEGMENTS, Vertex};
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
    pub(super) fn keeps_sides(&self) -> bool {
        self.side == Side::Both || matches!(self.style, Style::Glossy(_))
    }

    /// Finds the level of a vertex on the side that is drawn, and of both of them, or for a highlight, on that which the
    /// light reaches, and which one it is. `in_full` is [`keeps_sides`](Self::keeps_sides).
    #[inline(always)]
    pub(super) fn shade(&self, vertex: &mut Vertex, normal: Option<[i32; 3]>, in_full: bool) {
        let normal = normal.unwrap_or([0, 0, -1]);
        if in_full {
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

    /// All bits where areas change their sign, and all bits where no cell is hidden: others are where no area is negative
    /// then.
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
    /// Whether there may be cells outside the window.
    pub(super) is_cut: bool,
    pub(super) facets: u32,
    /// The vertices of the last row whose levels are known, a bit each.
    pub(super) known: u64,
    /// Twice the areas of the triangles abc and acd of a row's cells.
    pub(super) areas: [[i32; 2]; SEGMENTS],
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

/// The corners (i, j−1), (i+1, j−1), (i+1, j), (i, j) of a cell; of a triangle the third is not used.
type Corners<'r> = [&'r Vertex; 4];

impl Cells<'_> {
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
    fn cell(&mut self, corners: Corners<'_>, [abc, acd]: [i32; 2], is_triangle: bool) {
        let [a, b, c, d] = corners;
        let abd = cross([b.x - a.x, b.y - a.y], [d.x - a.x, d.y - a.y]);
        let bcd = abc.wrapping_add(acd).wrapping_sub(abd);
        let [x_from, x_to, y_from, y_to] = self.window;
        let rows_of_cell = rows([a.y, b.y, c.y, d.y]);
        if (abc | acd | abd) == 0
            || !meet(rows_of_cell, y_from, y_to)
            || (self.quad.is_wide && !meet(rows([a.x, b.x, c.x, d.x]), x_from, x_to))
        {
            return;
        }
        let is_convex = (abc | acd | abd | bcd) >= 0 || (abc <= 0 && acd <= 0 && abd <= 0 && bcd <= 0);
        if !is_convex || is_triangle {
            return if is_triangle {
                self.triangle(corners, abc < 0, [0, 1, 3]);
            } else {
                self.folded(corners, [abc, acd, abd, bcd]);
            };
        }
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
    fn folded(&mut self, corners: Corners<'_>, [abc, acd, abd, bcd]: [i32; 4]) {
        if (abc >= 0) != (acd >= 0) && (abd >= 0) == (bcd >= 0) {
            let along = abd < 0 || bcd < 0;
            self.triangle(corners, along, [0, 1, 3]);
            self.triangle(corners, along, [1, 2, 3]);
        } else {
            self.triangle(corners, abc < 0, [0, 1, 2]);
            self.triangle(corners, acd < 0, [0, 2, 3]);
        }
    }

    /// A triangle of three corners, its last one twice.
    #[inline(never)]
    fn triangle(&mut self, corners: Corners<'_>, along: bool, three: [usize; 3]) {
        if !self.lighting.side.shows(along) {
            return;
        }
        let [a, b, c] = three.map(|corner| *corners[corner & 3]);
        let corners = if along { [a, c, b, b] } else { [a, b, c, c] };
        self.quad = Quad::new(corners, self.quad.patch, self.quad.is_wide);
        self.put(along);
    }

    /// The cells that may be seen, a bit each, of `count` of them; keeps their areas.
    #[inline(never)]
    fn turned(&mut self, above: &Row, below: &Row, count: usize) -> u32 {
        let ends = above.iter().zip(below).next();
        let Some((mut a, mut d)) = ends.map(|(a, d)| (a.place(), d.place())) else { return 0 };
        let [turn, keep] = self.lighting.side.masks();
        let (mut seen, mut bit) = (0, 1_u32);
        let next = above.iter().zip(below).skip(1);
        for (areas, (b, c)) in self.areas.iter_mut().zip(next).take(count) {
            let (b, c) = (b.place(), c.place());
            // All products are exact: corners are less than 2^15 apart.
            let ac = minus(c, a);
            *areas = [cross(minus(b, a), ac), cross(ac, minus(d, a))];
            let turned = areas.map(|area| (area ^ turn).wrapping_sub(turn));
            if (turned[0] | turned[1] | keep) < 0 {
                seen |= bit;
            }
            bit <<= 1;
            (a, d) = (b, c);
        }
        seen
    }

    /// Those of some cells that meet the window.
    #[cold]
    #[inline(never)]
    fn inside(&self, above: &Row, below: &Row, seen: u32) -> u32 {
        let [x_from, x_to, y_from, y_to] = self.window;
        let (mut inside, mut bit) = (0, 1_u32);
        let sides = above.iter().zip(above.iter().skip(1)).zip(below.iter().zip(below.iter().skip(1)));
        for ((a, b), (d, c)) in sides {
            let is_inside = seen & bit != 0
                && meet(rows([a.y, b.y, c.y, d.y]), y_from, y_to)
                && (!self.quad.is_wide || meet(rows([a.x, b.x, c.x, d.x]), x_from, x_to));
            if is_inside {
                inside |= bit;
            }
            bit <<= 1;
        }
        inside
    }

    /// The areas of the triangle at the end of a row of a triangular patch, after column `k` of the strip, where it may be
    /// seen: the row before is longer by one, unless the strip ends first.
    #[inline(always)]
    fn end(&self, above: &Row, below: &Row, j: u32, k: usize) -> Option<[i32; 2]> {
        let (form, last) = (self.lighting.form, self.first + k as u32);
        if form.last_in_row(j) != last || form.last_in_row(j - 1) <= last {
            return None;
        }
        let (Some([a, b]), Some(d)) = (above.get(k..k + 2), below.get(k)) else { return None };
        let areas = [cross(minus(b.place(), a.place()), minus(d.place(), a.place())), 0];
        (!self.lighting.side.hides(areas)).then_some(areas)
    }
}

impl RowSink for Cells<'_> {
    #[inline(never)]
    fn row(&mut self, rows: &mut Rows, normals: &dyn Normals, j: u32, count: usize) {
        if j == 0 {
            self.known = 0;
            return;
        }
        let [even, odd] = &mut rows.0;
        let (above, below) = if j & 1 == 1 { (even, odd) } else { (odd, even) };
        let cells = count.saturating_sub(1).min(SEGMENTS);
        let mut seen = self.turned(above, below, cells);
        if self.is_cut {
            seen = self.inside(above, below, seen);
        }
        let end = self.end(above, below, j, cells);
        if self.lighting.style.needs_normals() {
            let corners = u64::from(seen) | u64::from(seen) << 1;
            let of_end = u64::from(end.is_some()) << (cells & 31);
            let (missing, wanted) = ((corners | (3 * of_end)) & !self.known, corners | of_end);
            if missing != 0 {
                normals.shade(&self.lighting, above, [self.first, j - 1], missing);
            }
            if wanted != 0 {
                normals.shade(&self.lighting, below, [self.first, j], wanted);
            }
            self.known = wanted;
        }
        let mut k = 0;
        while seen != 0 && k < SEGMENTS {
            if seen & 1 == 1 {
                self.seen(above, below, k);
            }
            seen >>= 1;
            k += 1;
        }
        if let (Some(areas), Some([a, b]), Some(d)) = (end, above.get(cells..cells + 2), below.get(cells)) {
            self.cell([a, b, d, d], areas, true);
        }
    }
}

impl Cells<'_> {
    /// The cell after column `k` of the strip.
    #[inline(never)]
    fn seen(&mut self, above: &Row, below: &Row, k: usize) {
        let areas = self.areas.get(k).copied().unwrap_or_default();
        if let (Some([a, b]), Some([d, c])) = (above.get(k..k + 2), below.get(k..k + 2)) {
            self.cell([a, b, c, d], areas, false);
        }
    }
}
