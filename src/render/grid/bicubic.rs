//! The grid of a patch of degree 3 or less in fixed point: the same vertices as the general walk on edges, within 1/128
//! pixel of them inside, and many times as fast.

use super::super::cubic::{self, Corners, RowSlopes};
use super::super::depth::DepthWindow;
use super::vertices::{Lit, Normals, RowSink, Rows, SEGMENTS, Vertex, with_room};
use crate::forward::{Form, PieceSlopes};
use crate::geometry::Point3;
use crate::patch::{Surface, SurfaceNet};

/// A bound on the derivatives of a bicubic along all axes, in 2^-9: at least three times every difference of neighbours in
/// the net, at most about six times the largest one.
fn steepest(points: &[Point3; 16]) -> u32 {
    let values = points.map(|p| [p.x, p.y, p.z].map(|c| c.to_bits() >> 7));
    let mut all = 0;
    for k in 0..12 {
        for (from, to) in [(k, k + 4), (k / 3 * 4 + k % 3, k / 3 * 4 + k % 3 + 1)] {
            for (p, q) in values[from & 15].iter().zip(&values[to & 15]) {
                all |= (q - p) ^ ((q - p) >> 31);
            }
        }
    }
    // One more than all bits that differences have; and one unit that each may be off.
    3 * (all.unsigned_abs() + 2)
}

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

    /// The grid of a net that [`suits`](Self::suits), to be [set up](Self::set_up) where it stays.
    #[inline(always)]
    pub(super) fn blank(net: SurfaceNet<'a>, (r, s): (u32, u32)) -> Self {
        let is_turned = s > r;
        Self { corners: Corners::blank(net, (r, s), is_turned), net, counts: (r.max(s), r.min(s)), is_turned }
    }

    /// Finds the coefficients.
    #[inline(never)]
    pub(super) fn set_up(&mut self) {
        let net = self.net;
        self.corners.set_up(|| match net.points().first_chunk::<16>() {
            Some(points) if net.degrees() == (3, 3) => steepest(points),
            _ => PieceSlopes::of(net).steepest(net),
        });
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
        let mut normals = TwoRows { corners: &self.corners, tangents: [RowSlopes::default(); 2] };
        let depth = |z: i32| {
            let depth = window.depth_of_256(z);
            // A level by depth comes first.
            if level.is_none() { with_room(depth) } else { depth }
        };
        let set = |vertex: &mut Vertex, [x, y, z]: [i32; 3]| {
            (vertex.x, vertex.y, vertex.depth) = (x, y, depth(z));
        };
        for j in 0..=self.counts.1 {
            let Some(out) = rows.0[(j & 1) as usize].get_mut(..count.min(SEGMENTS + 1)) else { return };
            let row = self.corners.row(j);
            if self.corners.is_exact(&row) {
                self.corners.exact_row(&row, first, out, set);
            } else {
                self.corners.each(&row, 0, first, out, |vertex: &mut Vertex, x| vertex.x = x);
                self.corners.each(&row, 1, first, out, |vertex: &mut Vertex, y| vertex.y = y);
                self.corners.each(&row, 2, first, out, |vertex: &mut Vertex, z| vertex.depth = depth(z));
                if let (Some(at), Some(vertex)) = (self.corners.end(&row, first), out.first_mut()) {
                    set(vertex, at);
                }
                if let (Some(at), Some(vertex)) = (self.corners.end(&row, last), out.last_mut()) {
                    set(vertex, at);
                }
            }
            match level {
                Some(level) => out.iter_mut().for_each(|vertex| {
                    (vertex.level, vertex.lit) = (level(vertex.depth), Lit::Both);
                    vertex.depth = with_room(vertex.depth);
                }),
                None => self.corners.tangents(&row, &mut normals.tangents[(j & 1) as usize]),
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
    tangents: [RowSlopes; 2],
}

impl Normals for TwoRows<'_, '_> {
    #[inline(always)]
    fn normal(&self, i: u32, j: u32) -> Option<[i32; 3]> {
        self.corners.normal(&self.tangents[(j & 1) as usize], i, j)
    }
}
