//! The chain of vertices along a side of a leaf, and the triangles between two chains.

use super::Tessellation;
use super::cell::{Cell, FINE, Fine};
use crate::geometry::Point3;
use crate::patch::Surface;

/// A vertex on the way: its parameters and its place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Spot {
    pub(super) fine: Fine,
    pub(super) point: Point3,
}

/// The vertices on a side of a leaf, from one of its ends on: where any cell that touches the side has corners.
#[derive(Clone, Copy, Debug)]
pub(super) struct Chain {
    side: usize,
    /// Whether it runs as the side does.
    forward: bool,
    start: Fine,
    step: Fine,
    /// Steps of the fine grid from the start.
    at: u32,
    end: u32,
    /// Length of the side.
    full: u32,
    /// Whether there are vertices between its ends.
    divided: bool,
}

/// Which chain: a side, the corner it starts from, whether there are vertices between its ends, and whether it ends at
/// the middle one of these.
#[derive(Clone, Copy, Debug)]
pub(super) struct Run {
    pub(super) side: usize,
    pub(super) from: usize,
    pub(super) divided: bool,
    pub(super) half: bool,
}

impl Run {
    /// The same side from its other end.
    pub(super) fn reversed(self, leaf: &Leaf) -> Self {
        let (first, last) = leaf.ends(self.side);
        Self { from: if self.from == first { last } else { first }, ..self }
    }

    /// Only the first half of a divided side.
    pub(super) fn half(self) -> Self {
        Self { half: true, ..self }
    }
}

impl Chain {
    pub(super) fn new(leaf: &Leaf, run: Run) -> Self {
        let Run { side, from, divided, half } = run;
        let (domain, cell) = (leaf.domain, leaf.cell);
        let (start, target) = (domain.corner(cell, from), domain.corner(cell, run.reversed(leaf).from));
        let ([a, b, c], [x, y, z]) = (start, target);
        let step = [x - a, y - b, z - c].map(i32::signum);
        let full = 1 << (FINE - domain.exponent(cell.level, side));
        let end = if half { full / 2 } else { full };
        Self { side, forward: leaf.ends(side).0 == from, start, step, at: 0, end, full, divided }
    }

    pub(super) fn is_done(&self) -> bool {
        self.at >= self.end
    }

    /// The segments of the chain.
    pub(super) fn count<S: Surface>(mut self, mesh: &Tessellation<'_, S>, leaf: &Leaf) -> usize {
        let mut count = 0;
        while !self.is_done() {
            self.advance(mesh, leaf);
            count += 1;
        }
        count
    }

    /// Moves to the next vertex.
    fn advance<S: Surface>(&mut self, mesh: &Tessellation<'_, S>, leaf: &Leaf) -> Fine {
        let mut size = if self.at == 0 { self.full } else { 1 << self.at.trailing_zeros() };
        let mut down = self.full.trailing_zeros() - size.trailing_zeros();
        while self.divided && size > 1 {
            let low = if self.forward { self.at } else { self.full - self.at - size };
            if !mesh.is_divided(leaf, self.side, (down as u8, low >> size.trailing_zeros())) {
                break;
            }
            size /= 2;
            down += 1;
        }
        self.at += size;
        self.place(self.at)
    }

    /// The point so many steps from the start.
    fn place(&self, steps: u32) -> Fine {
        let ([a, b, c], [x, y, z], steps) = (self.start, self.step, steps as i32);
        [a + x * steps, b + y * steps, c + z * steps]
    }

    /// The way made, in 2^-16 of the side's length.
    fn progress(&self) -> u32 {
        self.at << (FINE - self.full.trailing_zeros())
    }
}

/// A leaf of a patch's quadtree.
#[derive(Clone, Copy, Debug)]
pub(super) struct Leaf {
    pub(super) patch: usize,
    pub(super) domain: super::cell::Domain,
    pub(super) cell: Cell,
}

impl Leaf {
    /// The corners that a side runs from and to.
    pub(super) fn ends(&self, side: usize) -> (usize, usize) {
        match (self.domain.triangle, side) {
            (true, side) => super::cell::ends(side),
            (false, 0) => (0, 2),
            (false, 1) => (1, 3),
            (false, 2) => (0, 1),
            (false, _) => (2, 3),
        }
    }
}

/// The triangles between two chains that leave one corner; the side between their ends has no vertices inside.
#[derive(Clone, Copy, Debug)]
pub(super) struct Zip {
    left: (Chain, Spot),
    right: (Chain, Spot),
}

impl Zip {
    /// `left` turns counter-clockwise into `right`.
    #[inline(never)]
    pub(super) fn new<S: Surface>(mesh: &Tessellation<'_, S>, leaf: &Leaf, (left, right): (Run, Run)) -> Self {
        let (left, right) = (Chain::new(leaf, left), Chain::new(leaf, right));
        let apex = mesh.spot(leaf.patch, left.start);
        Self { left: (left, apex), right: (right, apex) }
    }

    /// The next triangle, counter-clockwise in the parameters.
    pub(super) fn next<S: Surface>(&mut self, mesh: &Tessellation<'_, S>, leaf: &Leaf) -> Option<[Spot; 3]> {
        let ((left, g), (right, h)) = (&mut self.left, &mut self.right);
        let at = |fine| mesh.spot(leaf.patch, fine);
        if left.at == 0 {
            let apex = *g;
            *g = at(left.advance(mesh, leaf));
            *h = at(right.advance(mesh, leaf));
            return Some([apex, *g, *h]);
        }
        if !left.is_done() && (right.is_done() || left.progress() <= right.progress()) {
            let before = *g;
            *g = at(left.advance(mesh, leaf));
            return Some([before, *g, *h]);
        }
        if !right.is_done() {
            let before = *h;
            *h = at(right.advance(mesh, leaf));
            return Some([*g, *h, before]);
        }
        None
    }
}
