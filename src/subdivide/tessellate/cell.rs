//! Addresses of cells in a patch's quadtree, and of the segments of their sides.
//!
//! Parameters are whole multiples of 2^-16, the *fine grid*: (r, s) of a tensor-product patch, (u, v, w) with the sum
//! 2^16 of a triangle. A cell of a triangle is named by the floors of u, v, w times 2^level inside it; they add up to
//! 2^level − 1 in a cell that stands like the domain and to 2^level − 2 in one turned by half a turn. Both rules make
//! parent, child and neighbour a matter of bits.

use crate::subdivide::exact::{Half, Quarter};
use crate::subdivide::rounded::Cut;

/// Bits of the fine grid.
pub(super) const FINE: u32 = 16;

/// A point of the fine grid: (r, s, 0) or (u, v, w).
pub(super) type Fine = [i32; 3];

/// The domain of a patch and the grid that its quadtrees start from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Domain {
    pub(super) triangle: bool,
    /// A tensor-product patch is first cut into 2^a × 2^b cells of level 0; (0, 0) for a triangle.
    pub(super) grid: (u8, u8),
}

/// A cell of a domain's quadtree.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Cell {
    pub(super) level: u8,
    pub(super) at: [u32; 3],
}

/// A half of a parameter interval by its bit.
fn half(bit: u32) -> Half {
    if bit & 1 == 0 { Half::First } else { Half::Second }
}

impl Domain {
    /// The deepest level that the fine grid has.
    pub(super) fn deepest(self) -> u8 {
        FINE as u8 - self.grid.0.max(self.grid.1)
    }

    /// The first cell of level 0.
    pub(super) fn first(self) -> Cell {
        Cell { level: 0, at: [0; 3] }
    }

    /// How often the sides along each direction are halved at this level.
    fn exponents(self, level: u8) -> [u32; 2] {
        [self.grid.0 + level, self.grid.1 + level].map(u32::from)
    }

    /// How often the line under a side is halved at this level.
    pub(super) fn exponent(self, level: u8, side: usize) -> u32 {
        let [r, s] = self.exponents(level);
        if self.triangle || side >= 2 { r } else { s }
    }

    /// Whether a triangle's cell is turned by half a turn.
    fn turned(self, cell: Cell) -> bool {
        let [u, v, w] = cell.at;
        self.triangle && u + v + w + 2 == 1 << cell.level
    }

    /// The cuts that lead from the patch to the cells of level 0 and on to this cell: `step` 0 .. grid + level.
    pub(super) fn cut(self, cell: Cell, step: u8) -> Cut {
        let (a, b) = self.grid;
        let before = a.max(b);
        if step < before {
            let (direction, at, exponent) = if a > 0 {
                (crate::subdivide::Direction::R, cell.at[0], a + cell.level)
            } else {
                (crate::subdivide::Direction::S, cell.at[1], b + cell.level)
            };
            return Cut::Half(direction, half(at >> (exponent - 1 - step)));
        }
        let down = (before + cell.level).saturating_sub(step + 1);
        let bits = cell.at.map(|c| c >> down & 1);
        if !self.triangle {
            return Cut::Tensor(half(bits[0]), half(bits[1]));
        }
        Cut::Triangle(match bits {
            [1, 0, 0] | [0, 1, 1] => Quarter::AtU,
            [0, 1, 0] | [1, 0, 1] => Quarter::AtV,
            [0, 0, 1] | [1, 1, 0] => Quarter::AtW,
            _ => Quarter::Centre,
        })
    }

    /// Child 0 ..= 3.
    pub(super) fn child(self, cell: Cell, which: u32) -> Cell {
        let bits = if self.triangle {
            let turned = self.turned(cell);
            let corner = |c: u32| u32::from((which == c) != turned);
            [corner(0), corner(1), corner(2)]
        } else {
            [which >> 1 & 1, which & 1, 0]
        };
        let [a, b, c] = cell.at;
        Cell { level: cell.level + 1, at: [2 * a + bits[0], 2 * b + bits[1], 2 * c + bits[2]] }
    }

    /// The first of a cell's descendants on this level.
    pub(super) fn descend(self, mut cell: Cell, level: u8) -> Cell {
        while cell.level < level {
            cell = self.child(cell, 0);
        }
        cell
    }

    /// The ancestor on this level.
    pub(super) fn ancestor(self, cell: Cell, level: u8) -> Cell {
        let up = cell.level.saturating_sub(level);
        Cell { level: cell.level - up, at: cell.at.map(|c| c >> up) }
    }

    /// How many ancestors a cell shares with another: the levels 0 .. that of those that hold both.
    pub(super) fn shared(self, cell: Cell, other: Cell) -> u8 {
        (0..cell.level.min(other.level))
            .find(|level| self.ancestor(cell, *level) != self.ancestor(other, *level))
            .unwrap_or(cell.level.min(other.level))
    }

    /// The cell that follows all of a cell's descendants in the order of the walk; `None` after the last.
    pub(super) fn next(self, mut cell: Cell) -> Option<Cell> {
        while cell.level > 0 {
            let parent = self.ancestor(cell, cell.level - 1);
            let which = (0..4).find(|which| self.child(parent, *which) == cell).unwrap_or(3);
            if which < 3 {
                return Some(self.child(parent, which + 1));
            }
            cell = parent;
        }
        let [i, j, _] = cell.at;
        if j + 1 < 1 << self.grid.1 {
            Some(Cell { level: 0, at: [i, j + 1, 0] })
        } else if i + 1 < 1 << self.grid.0 {
            Some(Cell { level: 0, at: [i + 1, 0, 0] })
        } else {
            None
        }
    }

    /// The cell of the same level across a side; `None` beyond the domain's border.
    pub(super) fn across(self, cell: Cell, side: usize) -> Option<Cell> {
        let mut at = cell.at;
        if self.triangle {
            let turned = self.turned(cell);
            let c = at.get_mut(side)?;
            *c = if turned { *c + 1 } else { c.checked_sub(1)? };
        } else {
            let c = at.get_mut(side / 2)?;
            *c = if side % 2 == 1 { *c + 1 } else { c.checked_sub(1)? };
            let count = 1 << if side < 2 { self.exponents(cell.level)[0] } else { self.exponents(cell.level)[1] };
            if *c >= count {
                return None;
            }
        }
        Some(Cell { level: cell.level, at })
    }

    /// The descendant, `down` levels below, that has segment `index` of a side, counted as the side runs.
    pub(super) fn along(self, cell: Cell, side: usize, down: u8, index: u32) -> Cell {
        let mut at = cell.at.map(|c| c << down);
        let last = (1 << down) - 1;
        if self.triangle {
            // Sides run from T2 to T3, T1 to T3, T1 to T2; a cell that is turned has its corners opposite.
            let turned = self.turned(cell);
            let (from, to) = ends(side);
            let (low, high) = if turned { (to, from) } else { (from, to) };
            at[low] += last - index;
            at[high] += index;
            if turned {
                at[side.min(2)] += last;
            }
        } else {
            let (across, along) = if side < 2 { (0, 1) } else { (1, 0) };
            at[across] += if side % 2 == 1 { last } else { 0 };
            at[along] += index;
        }
        Cell { level: cell.level + down, at }
    }

    /// Where a cell on the domain's border stands along the side that is on it, as the side runs.
    pub(super) fn place(self, cell: Cell, side: usize) -> u32 {
        match (self.triangle, side) {
            (true, 0 | 1) => cell.at[2],
            (true, _) | (false, 0 | 1) => cell.at[1],
            (false, _) => cell.at[0],
        }
    }

    /// The cell of this level that has segment `index` of a side of the domain.
    pub(super) fn on_border(self, side: usize, level: u8, index: u32) -> Cell {
        if self.triangle {
            return self.along(self.first(), side, level, index);
        }
        let [r, s] = self.exponents(level).map(|e| (1 << e) - 1);
        let at = match side {
            0 => [0, index, 0],
            1 => [r, index, 0],
            2 => [index, 0, 0],
            _ => [index, s, 0],
        };
        Cell { level, at }
    }

    /// A corner: T1, T2, T3, or (0, 0), (1, 0), (0, 1), (1, 1).
    pub(super) fn corner(self, cell: Cell, corner: usize) -> Fine {
        if self.triangle {
            let turned = self.turned(cell);
            let c =
                |axis: usize| (cell.at[axis] + u32::from((axis == corner) != turned)) << (FINE - u32::from(cell.level));
            return [c(0), c(1), c(2)].map(|c| c as i32);
        }
        let [r, s] = self.exponents(cell.level);
        let at = |c: u32, bit: usize, exponent: u32| ((c + bit as u32) << (FINE - exponent)) as i32;
        [at(cell.at[0], corner & 1, r), at(cell.at[1], corner >> 1 & 1, s), 0]
    }
}

/// The corners that a triangle's side runs from and to.
pub(super) fn ends(side: usize) -> (usize, usize) {
    match side {
        0 => (1, 2),
        1 => (0, 2),
        _ => (0, 1),
    }
}
