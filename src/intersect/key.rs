//! Names of crossings: an edge of one grid through a triangle of the other.

/// A kind of grid edge, from its base vertex (i, j).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum EdgeKind {
    /// To (i+1, j).
    U,
    /// To (i, j+1).
    V,
    /// From (i+1, j) to (i, j+1).
    Diagonal,
}

/// An edge of a grid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Edge {
    pub(super) kind: EdgeKind,
    pub(super) i: u8,
    pub(super) j: u8,
}

/// A triangle of a grid: cell (i, j), lower or upper.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Cell {
    pub(super) i: u8,
    pub(super) j: u8,
    pub(super) upper: bool,
}

/// The crossing of an edge of one patch with a triangle of the other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Crossing {
    /// Whose edge it is: 0 for A, 1 for B.
    pub(super) side: u8,
    pub(super) edge: Edge,
    pub(super) cell: Cell,
}

/// Bits of a packed crossing.
pub(super) const KEY_BITS: u32 = 36;

impl Edge {
    /// The ends (i, j).
    pub(super) fn ends(self) -> [(usize, usize); 2] {
        let (i, j) = (usize::from(self.i), usize::from(self.j));
        match self.kind {
            EdgeKind::U => [(i, j), (i + 1, j)],
            EdgeKind::V => [(i, j), (i, j + 1)],
            EdgeKind::Diagonal => [(i + 1, j), (i, j + 1)],
        }
    }

    /// Whether it lies on the border of a grid of 2^depth cells a side.
    pub(super) fn is_border(self, triangle: bool, depth: u32) -> bool {
        let last = 1 << depth;
        let (i, j) = (usize::from(self.i), usize::from(self.j));
        match self.kind {
            EdgeKind::U => j == 0 || (!triangle && j == last),
            EdgeKind::V => i == 0 || (!triangle && i == last),
            EdgeKind::Diagonal => triangle && i + j + 1 == last,
        }
    }
}

impl Cell {
    /// The corners, and the edges between each and the next.
    pub(super) fn corners(self) -> [(usize, usize); 3] {
        let (i, j) = (usize::from(self.i), usize::from(self.j));
        if self.upper { [(i + 1, j + 1), (i, j + 1), (i + 1, j)] } else { [(i, j), (i + 1, j), (i, j + 1)] }
    }

    /// The edges, each with the places of its ends among the corners, in the edge's own order.
    pub(super) fn edges(self) -> [(Edge, [usize; 2]); 3] {
        let Self { i, j, upper } = self;
        let edge = |kind, i, j| Edge { kind, i, j };
        if upper {
            [
                (edge(EdgeKind::U, i, j + 1), [1, 0]),
                (edge(EdgeKind::Diagonal, i, j), [2, 1]),
                (edge(EdgeKind::V, i + 1, j), [2, 0]),
            ]
        } else {
            [
                (edge(EdgeKind::U, i, j), [0, 1]),
                (edge(EdgeKind::Diagonal, i, j), [1, 2]),
                (edge(EdgeKind::V, i, j), [0, 2]),
            ]
        }
    }
}

impl Crossing {
    /// The crossing as an integer of [`KEY_BITS`] bits.
    pub(super) fn pack(self) -> u64 {
        let kind = match self.edge.kind {
            EdgeKind::U => 0,
            EdgeKind::V => 1,
            EdgeKind::Diagonal => 2,
        };
        let bytes = [self.edge.i, self.edge.j, self.cell.i, self.cell.j];
        let places = bytes.iter().fold(0, |key, byte| key << 8 | u64::from(*byte));
        (u64::from(self.side) << 2 | kind) << 33 | places << 1 | u64::from(self.cell.upper)
    }

    pub(super) fn unpack(key: u64) -> Self {
        let byte = |shift: u32| (key >> shift) as u8;
        let kind = match (key >> 33) & 3 {
            0 => EdgeKind::U,
            1 => EdgeKind::V,
            _ => EdgeKind::Diagonal,
        };
        Self {
            side: (key >> 35) as u8 & 1,
            edge: Edge { kind, i: byte(25), j: byte(17) },
            cell: Cell { i: byte(9), j: byte(1), upper: key & 1 == 1 },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_come_back() {
        for (n, kind) in [EdgeKind::U, EdgeKind::V, EdgeKind::Diagonal].into_iter().enumerate() {
            let n = n as u8;
            for side in 0..2 {
                let edge = Edge { kind, i: 128 - n, j: 3 * n };
                let crossing = Crossing { side, edge, cell: Cell { i: 7 * n, j: 127, upper: n == 1 } };
                assert!(crossing.pack() < 1 << KEY_BITS);
                assert_eq!(Crossing::unpack(crossing.pack()), crossing);
            }
        }
    }
}
