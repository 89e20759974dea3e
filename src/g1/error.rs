//! What can be wrong with a surface to interpolate.

/// Why there is no surface for a mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum G1Error {
    /// A face that is not a triangle.
    NotTriangle {
        /// The face.
        face: usize,
        /// Its corners.
        corners: usize,
    },
    /// A face that does not exist.
    Face {
        /// The face asked for.
        face: usize,
        /// The number of faces.
        faces: usize,
    },
    /// A list of another length than the vertices of the mesh.
    Count {
        /// Which list.
        list: List,
        /// The number of vertices.
        expected: usize,
        /// The entries given.
        given: usize,
    },
    /// A vertex inside the mesh with fewer than three edges.
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
    /// A normal shorter than 10^-9, or faces around a vertex whose normals cancel out.
    BadNormal {
        /// The vertex.
        vertex: usize,
    },
    /// A tension that is not in −1 ..= 15/16.
    Tension {
        /// The vertex.
        vertex: usize,
        /// The tension in units of 2^-16.
        bits: i32,
    },
    /// A tangent given for what is not an edge of the mesh, or out of range.
    Tangent {
        /// The index of the tangent in its list.
        index: usize,
    },
    /// A twist target for what is not a corner of a face, or out of range.
    Twist {
        /// The index of the target in its list.
        index: usize,
    },
    /// Tangents that do not follow each other counter-clockwise around the vertex, by less than half a turn each.
    FoldedTangents {
        /// The vertex.
        vertex: usize,
    },
    /// A vertex of even valence whose tangents admit no solution. Let them be moved, or choose other lengths.
    VertexInconsistent {
        /// The vertex.
        vertex: usize,
        /// By how much its equations are not met, in 2^-32 units.
        residual: i64,
    },
    /// An edge whose two equations for the points beside its middle differ.
    EdgeSingular {
        /// Its vertices.
        edge: [u16; 2],
        /// By how much they differ, in 2^-32 units.
        residual: i64,
    },
    /// Tangents, coefficients or control points around a vertex that leave their range: 2^12 for the coefficients, ±2^26
    /// units for control points, ±32767 where they are rounded.
    Overflow {
        /// The vertex.
        vertex: usize,
    },
    /// [`Scheme::Literal`](super::Scheme::Literal): the tangents on either side of an edge are opposite at its first
    /// vertex, so that its equation does not determine a control point.
    OppositeTangents {
        /// The edge, from where they are opposite.
        edge: [u16; 2],
    },
    /// [`Scheme::Literal`](super::Scheme::Literal): the ratios λ/ν at the ends of an edge are equal, so that the points
    /// beside its middle are not determined.
    EqualRatios {
        /// The edge.
        edge: [u16; 2],
    },
}

/// A list that has an entry for each vertex.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum List {
    /// Normals.
    Normals,
    /// Tensions.
    Tension,
    /// The byte a vertex that the first pass fills.
    Shifts,
}

impl core::fmt::Display for List {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str(match self {
            Self::Normals => "normals",
            Self::Tension => "tensions",
            Self::Shifts => "shifts",
        })
    }
}

impl core::fmt::Display for G1Error {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::NotTriangle { face, corners } => write!(f, "face {face} has {corners} corners, not three"),
            Self::Face { face, faces } => write!(f, "there is no face {face} among {faces}"),
            Self::Count { list, expected, given } => {
                write!(f, "{given} {list} are given for {expected} vertices")
            }
            Self::NonManifoldVertex { vertex } => {
                write!(f, "vertex {vertex} inside the mesh has fewer than three edges")
            }
            Self::ValenceTooLarge { vertex, valence, limit } => {
                write!(f, "vertex {vertex} has {valence} edges, at most {limit} are possible")
            }
            Self::BadNormal { vertex } => write!(f, "vertex {vertex} has no normal"),
            Self::Tension { vertex, bits } => {
                write!(f, "the tension of vertex {vertex}, {bits} / 65536, is not in -1 ..= 15/16")
            }
            Self::Tangent { index } => write!(f, "tangent {index} is not along an edge of the mesh, or out of range"),
            Self::Twist { index } => write!(f, "twist target {index} is not of a corner of a face, or out of range"),
            Self::FoldedTangents { vertex } => {
                write!(f, "the tangents of vertex {vertex} do not follow each other by less than half a turn")
            }
            Self::VertexInconsistent { vertex, residual } => {
                write!(f, "the tangents of vertex {vertex} admit no solution: {residual} / 2^32 is left")
            }
            Self::EdgeSingular { edge: [from, to], residual } => {
                write!(f, "the equations of the edge from vertex {from} to vertex {to} differ by {residual} / 2^32")
            }
            Self::Overflow { vertex } => {
                write!(f, "tangents, coefficients or control points around vertex {vertex} leave their range")
            }
            Self::OppositeTangents { edge: [from, to] } => {
                write!(f, "the tangents beside the edge from vertex {from} to vertex {to} are opposite at {from}")
            }
            Self::EqualRatios { edge: [from, to] } => {
                write!(f, "the ratios at the ends of the edge from vertex {from} to vertex {to} are equal")
            }
        }
    }
}

impl core::error::Error for G1Error {}
