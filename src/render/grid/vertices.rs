//! The vertices of a patch's grid, two rows at a time.

use super::super::depth::DepthWindow;
use super::super::light::{normal_of, short};
use super::super::pen::tangents_inside;
use super::super::style::Style;
use super::cells::Lighting;
use super::level_of;
use crate::forward::{Form, Fraction, Site, Visit};
use crate::patch::SurfaceNet;

/// Segments of a row that are walked at once. A longer row is cut into strips, each a walk of its own.
pub(super) const SEGMENTS: usize = 32;

/// A row of vertices; what lies behind those of the walk is old.
pub(super) type Row = [Vertex; SEGMENTS + 1];

/// Rows j − 1 and j: row j stands at j mod 2.
pub(in crate::render) type Rows = TwoRows;

/// Two rows of vertices.
#[derive(Clone, Copy, Debug)]
pub(in crate::render) struct TwoRows(pub(super) [Row; 2]);

impl TwoRows {
    pub(in crate::render) fn new() -> Self {
        Self([[Vertex::NONE; SEGMENTS + 1]; 2])
    }
}

/// Which side of a patch the light reaches at a vertex; the other one has the ambient level. Written with the level, where a
/// facet is seen there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Lit {
    /// The side to which S_r × S_s points.
    Along,
    /// The other side.
    Against,
    /// The level does not depend on the side.
    Both,
}

/// A vertex of a grid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Vertex {
    /// ⌊256·x⌋ and ⌊256·y⌋ of the exact point.
    pub(super) x: i32,
    pub(super) y: i32,
    /// The depth of ⌊256·z⌋, with room on both sides.
    pub(super) depth: u16,
    /// The level of the side that is lit.
    pub(super) level: u8,
    pub(super) lit: Lit,
}

impl Vertex {
    pub(super) const NONE: Self = Self { x: 0, y: 0, depth: 0, level: 0, lit: Lit::Both };

    #[inline(always)]
    pub(super) fn place(&self) -> [i32; 2] {
        [self.x, self.y]
    }
}

/// Room at both ends of the depths, 1/64 of the range: what a plane through a facet may err.
const ROOM: u16 = 512;

/// A depth of at most [`DepthWindow::LARGEST`] with room on both sides.
pub(super) fn with_room(depth: u16) -> u16 {
    ROOM + depth - (depth >> 5)
}

/// The normals of two rows of vertices.
pub(super) trait Normals {
    /// The normal S_r × S_s at column `i` of row `j`, of components of at most 2^15; `None` where it is not known.
    fn normal(&self, i: u32, j: u32) -> Option<[i32; 3]>;

    /// Finds the levels of vertices from this column on in row `j`: where a bit is set.
    #[inline(never)]
    fn shade(&self, lighting: &Lighting<'_>, row: &mut Row, [first, j]: [u32; 2], mut wanted: u64) {
        let in_full = lighting.keeps_sides();
        for (vertex, i) in row.iter_mut().zip(first..) {
            if wanted & 1 == 1 {
                lighting.shade(vertex, self.normal(i, j), in_full);
            }
            wanted >>= 1;
            if wanted == 0 {
                break;
            }
        }
    }
}

/// What is done with a row of vertices and the one before it.
pub(super) trait RowSink {
    /// Row `j` is complete, with `count` vertices of the strip.
    fn row(&mut self, rows: &mut Rows, normals: &dyn Normals, j: u32, count: usize);
}

/// Tangents of a strip's vertices in two rows, kept as they come: row j stands at j mod 2.
#[derive(Clone, Copy, Debug)]
pub(super) struct Kept<'a> {
    rows: [[[[i16; 3]; 2]; SEGMENTS + 1]; 2],
    first: u32,
    net: SurfaceNet<'a>,
    form: &'a Form<'a>,
}

impl<'a> Kept<'a> {
    /// For the strip from column `first` on.
    pub(super) fn new(first: u32, net: SurfaceNet<'a>, form: &'a Form<'a>) -> Self {
        Self { rows: [[[[0; 3]; 2]; SEGMENTS + 1]; 2], first, net, form }
    }
}

impl Normals for Kept<'_> {
    fn normal(&self, i: u32, j: u32) -> Option<[i32; 3]> {
        let kept = self.rows[(j & 1) as usize].get(i.wrapping_sub(self.first) as usize);
        let inside = || normal_of(tangents_inside(self.net, self.form, i, j)?.map(short));
        normal_of(*kept?).or_else(inside)
    }
}

/// Collects rows of vertices on a walk; with tangents in every style, so that one copy of the walks serves all.
pub(super) struct Collector<'v> {
    pub(super) rows: &'v mut Rows,
    pub(super) kept: &'v mut Kept<'v>,
    pub(super) sink: &'v mut dyn RowSink,
    pub(super) style: Style,
    pub(super) window: DepthWindow,
    pub(super) fraction: Fraction,
    pub(super) form: &'v Form<'v>,
    /// The first and the last column of the strip.
    pub(super) columns: (u32, u32),
}

impl Collector<'_> {
    /// The level where it does not depend on a normal.
    fn level(&self, depth: u16) -> u8 {
        if self.style.needs_normals() { 0 } else { level_of(self.style, self.window, depth) }
    }

    /// Directions of S_r and S_s; of what grows from one that vanishes.
    #[inline(always)]
    fn tangents<S: Site>(&self, at: &S) -> [[i16; 3]; 2] {
        let tangents = at.tangents().map(short);
        if tangents.contains(&[0; 3]) { self.limit(tangents, at) } else { tangents }
    }

    /// Next to the side r = 0, S_s grows as r·S_rs; next to r = 1 as −(1 − r)·S_rs; S_r likewise.
    #[cold]
    #[inline(never)]
    fn limit<S: Site>(&self, [r, s]: [[i16; 3]; 2], at: &S) -> [[i16; 3]; 2] {
        let twist = at.twist();
        let from = |start: bool| short(if start { twist } else { twist.map(|c| -c) });
        match (r == [0; 3], s == [0; 3]) {
            (true, false) => [from(at.j() == 0), s],
            (false, true) => [r, from(at.i() == 0)],
            _ => [r, s],
        }
    }

    #[inline(never)]
    fn end_row(&mut self, i: u32, j: u32) {
        self.sink.row(self.rows, self.kept, j, (i - self.columns.0) as usize + 1);
    }
}

impl Visit for Collector<'_> {
    const TANGENTS: bool = true;

    #[inline(always)]
    fn point<S: Site>(mut self, at: &S) -> Self {
        let (i, j) = (at.i(), at.j());
        let (first, last) = self.columns;
        if i < first || i > last {
            return self;
        }
        let depth = self.window.depth_of_256(at.floor(2, &self.fraction));
        let tangents = self.tangents(at);
        let vertex = Vertex {
            x: at.floor(0, &self.fraction),
            y: at.floor(1, &self.fraction),
            depth: with_room(depth),
            level: self.level(depth),
            lit: Lit::Both,
        };
        let (row, column) = ((j & 1) as usize, (i - first) as usize);
        if let (Some(slot), Some(kept)) = (self.rows.0[row].get_mut(column), self.kept.rows[row].get_mut(column)) {
            *slot = vertex;
            *kept = tangents;
        }
        if i == last.min(self.form.last_in_row(j)) {
            self.end_row(i, j);
        }
        self
    }
}
