//! The way around a vertex.

use super::{HalfEdge, Mesh};
use crate::num::Coord;

/// An edge of a vertex.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Spoke {
    /// The vertex at its other end.
    pub to: usize,
    /// The half-edge along it, which leaves the vertex and has the next face of the ring to its left; `None` for the
    /// last edge at a border.
    pub left: Option<HalfEdge>,
}

/// The edges of a vertex in counter-clockwise order; see [`Mesh::spokes`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Spokes<'a, C> {
    mesh: Mesh<'a, C>,
    first: Option<HalfEdge>,
    at: State,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum State {
    /// At the half-edge that leaves the vertex.
    Leaving(HalfEdge),
    /// At the border: the half-edge that arrives.
    Last(HalfEdge),
    Done,
}

impl<'a, C: Coord> Spokes<'a, C> {
    pub(super) fn new(mesh: Mesh<'a, C>, vertex: usize) -> Self {
        let first = mesh.leaving(vertex);
        Self { mesh, first, at: first.map_or(State::Done, State::Leaving) }
    }
}

impl<C: Coord> Iterator for Spokes<'_, C> {
    type Item = Spoke;

    fn next(&mut self) -> Option<Spoke> {
        match self.at {
            State::Leaving(half_edge) => {
                let arriving = self.mesh.previous(half_edge);
                self.at = match self.mesh.twin(arriving) {
                    Some(next) if Some(next) == self.first => State::Done,
                    Some(next) => State::Leaving(next),
                    None => State::Last(arriving),
                };
                Some(Spoke { to: self.mesh.tip(half_edge), left: Some(half_edge) })
            }
            State::Last(arriving) => {
                self.at = State::Done;
                Some(Spoke { to: self.mesh.origin(arriving), left: None })
            }
            State::Done => None,
        }
    }
}

impl<C: Coord> core::iter::FusedIterator for Spokes<'_, C> {}

#[cfg(feature = "defmt")]
impl<C> defmt::Format for Spokes<'_, C> {
    fn format(&self, f: defmt::Formatter<'_>) {
        defmt::write!(f, "spokes from {}", self.first);
    }
}
