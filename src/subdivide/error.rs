//! What can be wrong with a request to subdivide, join or tessellate.

/// Why patches cannot be subdivided, joined or tessellated as asked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum SubdivideError {
    /// A tolerance that is not positive.
    Tolerance {
        /// The tolerance in units of 2^-16.
        bits: i32,
    },
    /// More levels of subdivision than there may be.
    TooDeep {
        /// The levels that the tolerance asks for.
        needed: u32,
        /// The most there may be.
        limit: u32,
    },
    /// A patch whose control points are all equal.
    Point {
        /// The index of the patch.
        patch: usize,
    },
    /// A patch that bends too much for the tolerance.
    PatchTooDeep {
        /// The index of the patch.
        patch: usize,
        /// How many halvings are not enough.
        limit: u32,
    },
    /// A buffer of the caller is too small.
    Buffer {
        /// Which one.
        buffer: Buffer,
        /// How many entries it must have.
        needed: usize,
        /// How many it has.
        given: usize,
    },
    /// More patches than indices can name.
    TooManyPatches {
        /// How many were given.
        given: usize,
        /// The most that can be.
        most: usize,
    },
    /// A part of the surface has one side only: its patches cannot be oriented consistently.
    NotOrientable {
        /// A patch at which the contradiction shows.
        patch: usize,
    },
}

/// A buffer that a caller lends.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum Buffer {
    /// One [`PatchTopology`](super::PatchTopology) per patch.
    Topology,
    /// The vertices of a mesh.
    Vertices,
    /// The triangles of a mesh.
    Triangles,
    /// The index of vertices by place.
    Index,
}

impl core::fmt::Display for Buffer {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str(match self {
            Self::Topology => "topology",
            Self::Vertices => "vertex",
            Self::Triangles => "triangle",
            Self::Index => "index",
        })
    }
}

impl core::fmt::Display for SubdivideError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Tolerance { bits } => write!(f, "the tolerance is not positive: {bits} / 65536"),
            Self::TooDeep { needed, limit } => {
                write!(f, "the tolerance needs {needed} levels of subdivision, at most {limit} are possible")
            }
            Self::Point { patch } => write!(f, "all control points of patch {patch} are equal"),
            Self::PatchTooDeep { patch, limit } => {
                write!(f, "parts of patch {patch} are not flat to the tolerance after {limit} halvings")
            }
            Self::Buffer { buffer, needed, given } => {
                write!(f, "the {buffer} buffer has room for {given} entries, {needed} are needed")
            }
            Self::TooManyPatches { given, most } => write!(f, "{given} patches are more than {most}"),
            Self::NotOrientable { patch } => {
                write!(f, "the surface has one side only: patch {patch} cannot be oriented like its neighbours")
            }
        }
    }
}

impl core::error::Error for SubdivideError {}
