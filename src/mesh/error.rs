//! What can be wrong with a mesh.

use crate::geometry::Axis;

/// Why faces and vertices do not make a mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum MeshError {
    /// More vertices than there is room for.
    TooManyVertices {
        /// The vertices of the mesh.
        given: usize,
        /// The most there may be.
        limit: usize,
    },
    /// More half-edges (corners of faces) than there is room for.
    TooManyHalfEdges {
        /// The half-edges of the mesh.
        given: usize,
        /// The most there may be.
        limit: usize,
    },
    /// Another number of points than the vertices that the faces were checked for.
    Count {
        /// The number of vertices.
        expected: usize,
        /// The points given.
        given: usize,
    },
    /// A face of fewer than three corners, or that names a vertex twice.
    DegenerateFace {
        /// The face.
        face: usize,
    },
    /// A face that names a vertex that does not exist.
    Index {
        /// The face.
        face: usize,
        /// The vertex that it names.
        vertex: usize,
        /// The number of vertices.
        vertices: usize,
    },
    /// The end of a list of polygons that lies behind its corners.
    Corners {
        /// The face.
        face: usize,
        /// Where its corners should end.
        end: usize,
        /// How many corners there are.
        corners: usize,
    },
    /// A directed edge of two faces: three faces meet there, or two that are oriented differently.
    NonManifoldEdge {
        /// The vertices from which and to which it leads.
        edge: [u16; 2],
    },
    /// A vertex whose faces are not one fan or one cycle.
    NonManifoldVertex {
        /// The vertex.
        vertex: usize,
    },
    /// A vertex with too many edges.
    ValenceTooLarge {
        /// The vertex.
        vertex: usize,
        /// Its edges.
        valence: usize,
        /// The most there may be.
        limit: usize,
    },
    /// An edge between two vertices at the same place.
    ZeroEdge {
        /// Its vertices.
        edge: [u16; 2],
    },
    /// A coordinate outside the legal range of its type.
    OutOfRange {
        /// The vertex.
        vertex: usize,
        /// The axis of the coordinate.
        axis: Axis,
        /// The coordinate, in whole units, rounded down.
        units: i64,
        /// The largest legal absolute value.
        limit: i64,
    },
}

impl core::fmt::Display for MeshError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::TooManyVertices { given, limit } => write!(f, "{given} vertices are more than {limit}"),
            Self::TooManyHalfEdges { given, limit } => write!(f, "{given} corners of faces are more than {limit}"),
            Self::Count { expected, given } => {
                write!(f, "the faces were checked for {expected} vertices, {given} points are given")
            }
            Self::DegenerateFace { face } => {
                write!(f, "face {face} has fewer than three corners or names a vertex twice")
            }
            Self::Index { face, vertex, vertices } => {
                write!(f, "face {face} names vertex {vertex}, there are {vertices}")
            }
            Self::Corners { face, end, corners } => {
                write!(f, "the corners of face {face} end at {end}, there are {corners}")
            }
            Self::NonManifoldEdge { edge: [from, to] } => {
                write!(f, "two faces have the edge from vertex {from} to vertex {to} in the same direction")
            }
            Self::NonManifoldVertex { vertex } => {
                write!(f, "the faces at vertex {vertex} are not one fan or one cycle")
            }
            Self::ValenceTooLarge { vertex, valence, limit } => {
                write!(f, "vertex {vertex} has {valence} edges, at most {limit} are possible")
            }
            Self::ZeroEdge { edge: [from, to] } => write!(f, "vertices {from} and {to} of an edge are at one place"),
            Self::OutOfRange { vertex, axis, units, limit } => {
                write!(f, "{axis} coordinate of vertex {vertex}, near {units}, is outside -{limit} ..= {limit}")
            }
        }
    }
}

impl core::error::Error for MeshError {}
