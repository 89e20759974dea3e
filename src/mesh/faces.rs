//! Faces as lists of vertex indices, borrowed.

use super::HalfEdge;

/// The faces of a mesh: each a list of vertices, counter-clockwise as seen from outside.
///
/// ```
/// use embedded_surfaces::mesh::Faces;
/// // A square and a triangle on one of its sides.
/// const HOUSE: Faces<'_> = Faces::Polygons { corners: &[0, 1, 2, 3, 3, 2, 4], ends: &[4, 7] };
/// assert_eq!((HOUSE.len(), HOUSE.half_edges()), (2, 7));
/// assert_eq!(HOUSE.corners(1), Some(&[3, 2, 4][..]));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Faces<'a> {
    /// Triangles.
    Triangles(&'a [[u16; 3]]),
    /// Quadrilaterals.
    Quads(&'a [[u16; 4]]),
    /// Polygons of any number of corners, one after the other.
    Polygons {
        /// The corners of all faces.
        corners: &'a [u16],
        /// Where in `corners` each face ends.
        ends: &'a [u16],
    },
}

impl<'a> Faces<'a> {
    /// The number of faces.
    #[must_use]
    pub const fn len(&self) -> usize {
        match self {
            Self::Triangles(faces) => faces.len(),
            Self::Quads(faces) => faces.len(),
            Self::Polygons { ends, .. } => ends.len(),
        }
    }

    /// Whether there is no face.
    #[must_use]
    pub const fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The number of half-edges: of corners of all faces.
    #[must_use]
    pub const fn half_edges(&self) -> usize {
        self.all().len()
    }

    /// The corners of a face; `None` where there is no such face.
    #[must_use]
    pub fn corners(&self, face: usize) -> Option<&'a [u16]> {
        let (start, end) = self.range(face);
        if face < self.len() { self.all().get(start..end) } else { None }
    }

    /// The corners of all faces.
    pub(super) const fn all(&self) -> &'a [u16] {
        match self {
            Self::Triangles(faces) => faces.as_flattened(),
            Self::Quads(faces) => faces.as_flattened(),
            Self::Polygons { corners, .. } => corners,
        }
    }

    /// Where the corners of a face begin and end.
    pub(super) const fn range(&self, face: usize) -> (usize, usize) {
        match self {
            Self::Triangles(_) => (3 * face, 3 * face + 3),
            Self::Quads(_) => (4 * face, 4 * face + 4),
            Self::Polygons { ends, .. } => {
                let start = if face == 0 || face > ends.len() { 0 } else { ends[face - 1] as usize };
                (start, if face < ends.len() { ends[face] as usize } else { start })
            }
        }
    }

    /// The face that a half-edge bounds. Polygons are searched by halving.
    pub(super) const fn face(&self, half_edge: usize) -> usize {
        match self {
            Self::Triangles(_) => half_edge / 3,
            Self::Quads(_) => half_edge / 4,
            Self::Polygons { ends, .. } => {
                let (mut low, mut high) = (0, ends.len());
                while low < high {
                    let middle = usize::midpoint(low, high);
                    if middle < ends.len() && ends[middle] as usize <= half_edge {
                        low = middle + 1;
                    } else {
                        high = middle;
                    }
                }
                low
            }
        }
    }

    /// The half-edge behind this one around its face.
    pub(super) const fn next(&self, half_edge: usize) -> usize {
        let (start, end) = self.range(self.face(half_edge));
        if half_edge + 1 < end { half_edge + 1 } else { start }
    }

    /// The half-edge before this one around its face.
    pub(super) const fn previous(&self, half_edge: usize) -> usize {
        let (start, end) = self.range(self.face(half_edge));
        if half_edge > start { half_edge - 1 } else { end.saturating_sub(1) }
    }

    /// The vertex that a half-edge leaves.
    pub(super) const fn origin(&self, half_edge: usize) -> usize {
        let all = self.all();
        if half_edge < all.len() { all[half_edge] as usize } else { 0 }
    }
}

impl HalfEdge {
    /// The half-edge that leaves corner `corner` of all corners of all faces, counted in order.
    #[must_use]
    pub const fn new(corner: u16) -> Self {
        Self(corner)
    }

    /// Its number: that of the corner that it leaves.
    #[must_use]
    pub const fn index(self) -> usize {
        self.0 as usize
    }
}
