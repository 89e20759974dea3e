//! The edges of one vertex, and a value for each.

use super::{G1Error, MAX_VALENCE};
use crate::mesh::Mesh;
use crate::num::Coord;

/// A value for each edge of a vertex, or for each sector between two. Any index is legal: it counts modulo 16.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ring<T>([T; MAX_VALENCE]);

impl<T: Copy> Ring<T> {
    pub(super) const fn all(value: T) -> Self {
        Self([value; MAX_VALENCE])
    }
}

impl<T> core::ops::Index<usize> for Ring<T> {
    type Output = T;

    #[inline(always)]
    fn index(&self, at: usize) -> &T {
        &self.0[at % MAX_VALENCE]
    }
}

impl<T> core::ops::IndexMut<usize> for Ring<T> {
    #[inline(always)]
    fn index_mut(&mut self, at: usize) -> &mut T {
        &mut self.0[at % MAX_VALENCE]
    }
}

/// The edges of a vertex, counter-clockwise. Sector i lies between edges i and i + 1.
#[derive(Clone, Copy, Debug)]
pub(super) struct Star {
    /// The number of edges.
    pub(super) len: usize,
    /// Whether the faces go all the way around.
    pub(super) closed: bool,
    /// The vertices at the other ends.
    pub(super) to: Ring<u16>,
    /// The half-edges with sector i to their left.
    pub(super) left: Ring<u16>,
}

impl Star {
    pub(super) fn of<C: Coord>(mesh: &Mesh<'_, C>, vertex: usize) -> Result<Self, G1Error> {
        let mut star = Self { len: 0, closed: true, to: Ring::all(0), left: Ring::all(u16::MAX) };
        for spoke in mesh.spokes(vertex) {
            star.to[star.len] = spoke.to as u16;
            star.left[star.len] = spoke.left.map_or(u16::MAX, |half_edge| half_edge.index() as u16);
            star.closed &= spoke.left.is_some();
            star.len += 1;
        }
        let (valence, limit) = (star.len, MAX_VALENCE);
        if valence > limit {
            return Err(G1Error::ValenceTooLarge { vertex, valence, limit });
        }
        if star.closed && (1..3).contains(&valence) {
            return Err(G1Error::NonManifoldVertex { vertex });
        }
        Ok(if star.closed { star.turned() } else { star })
    }

    /// Beginning with the neighbour of the least number, so that the order of faces and of their corners does not matter.
    fn turned(self) -> Self {
        let first = (0..self.len).min_by_key(|i| self.to[*i]).unwrap_or(0);
        let mut turned = self;
        for i in 0..self.len {
            let from = if first + i < self.len { first + i } else { first + i - self.len };
            (turned.to[i], turned.left[i]) = (self.to[from], self.left[from]);
        }
        turned
    }

    /// The number of faces.
    pub(super) fn sectors(&self) -> usize {
        if self.closed { self.len } else { self.len.saturating_sub(1) }
    }

    /// The next edge counter-clockwise.
    pub(super) fn after(&self, i: usize) -> usize {
        if i + 1 < self.len { i + 1 } else { 0 }
    }

    /// The next edge clockwise, and the sector on that side.
    pub(super) fn before(&self, i: usize) -> usize {
        if i > 0 { i - 1 } else { self.len.saturating_sub(1) }
    }

    /// The first edge with faces on both sides, and how many there are.
    pub(super) fn inner(&self) -> (usize, usize) {
        if self.closed { (0, self.len) } else { (1, self.len.saturating_sub(2)) }
    }

    /// Whether the equations of the vertex need not have a solution.
    pub(super) fn is_even(&self) -> bool {
        self.closed && self.len > 0 && self.len.is_multiple_of(2)
    }

    /// Which edge leads to a vertex.
    pub(super) fn place_of(&self, vertex: usize) -> usize {
        (0..self.len).find(|i| usize::from(self.to[*i]) == vertex).unwrap_or(0)
    }

    /// The edge that a half-edge is.
    pub(super) fn place_of_half_edge(&self, half_edge: usize) -> usize {
        (0..self.len).find(|i| usize::from(self.left[*i]) == half_edge).unwrap_or(0)
    }
}
