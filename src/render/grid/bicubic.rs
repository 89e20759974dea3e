//! The grid of a patch of degree 3 or less in fixed point: the same vertices as the general walk on edges, within 1/128
//! pixel of them inside, and many times as fast.

use super::super::cubic::{self, Corners, RowTangents};
use super::super::depth::DepthWindow;
use super::vertices::{Lit, Normals, RowSink, Rows, SEGMENTS, Vertex, with_room};
use crate::forward::{Form, PieceSlopes};
use crate::patch::{Surface, SurfaceNet};

/// The grid of a patch of degree 3 or less.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bicubic<'a> {
    corners: Corners<'a>,
    net: SurfaceNet<'a>,
    /// Segments of a row, and of a column.
    counts: (u32, u32),
    /// Whether rows run along s, the direction of more segments: a row's start costs as much as several vertices.
    is_turned: bool,
}

impl<'a> Bicubic<'a> {
    /// Whether a net of type `S` is walked here.
    #[inline(always)]
    pub(super) fn suits<S: Surface>(net: &SurfaceNet<'_>) -> bool {
        cubic::suits::<S>(net)
    }

    /// The grid of a net that [`suits`](Self::suits).
    pub(super) fn new(net: SurfaceNet<'a>, (r, s): (u32, u32)) -> Self {
        let is_turned = s > r;
        let corners = Corners::new(net, (r, s), is_turned, PieceSlopes::of(net).steepest(net));
        Self { corners, net, counts: (r.max(s), r.min(s)), is_turned }
    }

    pub(super) fn form(&self) -> Form<'a> {
        let (long, short) = self.counts;
        Form::surface(self.net, if self.is_turned { (short, long) } else { (long, short) })
    }

    /// Whether what the walk calls r is s, and the other way round.
    pub(super) fn is_turned(&self) -> bool {
        self.is_turned
    }

    /// The last column.
    pub(super) fn columns(&self) -> u32 {
        self.counts.0
    }

    /// Walks the columns from `first` to `last` row by row.
    #[inline(never)]
    pub(super) fn walk(
        &self,
        (first, last): (u32, u32),
        rows: &mut Rows,
        sink: &mut dyn RowSink,
        (window, level): (DepthWindow, Option<Levels<'_>>),
    ) {
        let count = (last - first) as usize + 1;
        let mut normals = TwoRows { corners: &self.corners, tangents: [RowTangents::default(); 2] };
        for j in 0..=self.counts.1 {
            let Some(out) = rows.0[(j & 1) as usize].get_mut(..count.min(SEGMENTS + 1)) else { return };
            let row = self.corners.row(j);
            self.corners.each(&row, 0, first, out, |vertex, x| vertex.x = x);
            self.corners.each(&row, 1, first, out, |vertex, y| vertex.y = y);
            self.corners.each(&row, 2, first, out, |vertex: &mut Vertex, z| {
                let depth = window.depth_of_256(z);
                vertex.depth = with_room(depth);
                (vertex.level, vertex.lit) = match level {
                    Some(level) => (level(depth), Lit::Both),
                    None => (0, Lit::Unknown),
                };
            });
            if level.is_none() {
                self.corners.tangents(&row, &mut normals.tangents[(j & 1) as usize]);
            }
            sink.row(rows, &normals, j, count);
        }
    }
}

/// The level of a depth, where it does not depend on a normal.
pub(super) type Levels<'l> = &'l dyn Fn(u16) -> u8;

/// The tangents of rows j − 1 and j; row j stands at j mod 2.
struct TwoRows<'c, 'a> {
    corners: &'c Corners<'a>,
    tangents: [RowTangents; 2],
}

impl Normals for TwoRows<'_, '_> {
    fn normal(&self, i: u32, j: u32) -> Option<[i32; 3]> {
        self.corners.normal(&self.tangents[(j & 1) as usize], i, j)
    }
}
