//! What can keep an intersection from being computed.

use super::{MAX_DEPTH, MIN_DEPTH, Side};

/// Why there is no result.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum IntersectError {
    /// A depth outside [`MIN_DEPTH`] ..= [`MAX_DEPTH`].
    Depth {
        /// The depth asked for.
        depth: u32,
    },
    /// A tolerance that is not positive.
    Tolerance {
        /// The tolerance in units of 2^-44.
        bits: i64,
    },
    /// The buffer of grid vertices is too small.
    VertexBuffer {
        /// The vertices that both grids have.
        needed: usize,
        /// The vertices that there is room for.
        given: usize,
    },
    /// The buffer of boxes is too small for the root of either pyramid.
    BoxBuffer {
        /// The boxes of both roots.
        needed: usize,
        /// The boxes that there is room for.
        given: usize,
    },
    /// The grids cross in more segments than there is room for. How many more is not known: lend more, or lower the depth.
    SegmentBuffer {
        /// The segments that there is room for: half the records, or half the links, whichever is less.
        given: usize,
        /// The pairs of nodes that were visited until then.
        visited: u32,
    },
    /// A buffer of results is too small. How much is needed is known only up to here: lend more, or a larger tolerance.
    Buffer {
        /// Which one.
        buffer: Buffer,
        /// The least that is needed.
        needed: usize,
        /// The entries that there is room for.
        given: usize,
    },
    /// The budget of pairs of nodes is spent.
    PairBudget {
        /// The pairs that were visited.
        visited: u32,
        /// The level that was reached.
        level: u8,
    },
    /// A patch that has no normal anywhere: a point or a curve.
    DegeneratePatch {
        /// Which patch.
        side: Side,
    },
    /// A curve that is a point.
    DegenerateCurve,
    /// A parameter outside 0 ..= 1, at which an iso-parametric curve of a triangle is a point, or that a tensor-product patch
    /// does not have.
    Parameter {
        /// Its value in units of 2^-48.
        bits: i64,
    },
    /// A plane whose part over the surface's box leaves the range of coordinates, ±32767 units.
    Plane {
        /// A coordinate that it would have in whole units, rounded down.
        units: i64,
    },
    /// The normal of a plane has three zeros.
    Normal {
        /// The plane's offset in units of 2^-32.
        offset: i64,
    },
    /// The offset n·x of a plane outside ±2^31.
    Offset {
        /// It in whole units, rounded down.
        units: i64,
    },
    /// A combinatorial rule of the method was broken: a defect of this crate, never of the input.
    Internal,
}

/// A buffer for results.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum Buffer {
    /// The points of all curves.
    Points,
    /// The curves.
    Curves,
    /// The branches.
    Branches,
}

impl core::fmt::Display for Buffer {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str(match self {
            Self::Points => "point",
            Self::Curves => "curve",
            Self::Branches => "branch",
        })
    }
}

impl core::fmt::Display for IntersectError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Depth { depth } => write!(f, "depth {depth} is outside {MIN_DEPTH} ..= {MAX_DEPTH}"),
            Self::Tolerance { bits } => write!(f, "the tolerance is not positive: {bits} / 2^44"),
            Self::VertexBuffer { needed, given } => {
                write!(f, "the vertex buffer has room for {given} entries, {needed} are needed")
            }
            Self::BoxBuffer { needed, given } => {
                write!(f, "the box buffer has room for {given} entries, at least {needed} are needed")
            }
            Self::SegmentBuffer { given, visited } => {
                write!(
                    f,
                    "more than {given} segments after {visited} pairs of nodes: lend more room or lower the depth"
                )
            }
            Self::Buffer { buffer, needed, given } => {
                write!(f, "the {buffer} buffer has room for {given} entries, at least {needed} are needed")
            }
            Self::PairBudget { visited, level } => {
                write!(f, "the budget of {visited} pairs of nodes was spent at level {level}")
            }
            Self::DegeneratePatch { side } => {
                let name = if *side == Side::A { "first" } else { "second" };
                write!(f, "the {name} patch has no normal anywhere")
            }
            Self::DegenerateCurve => write!(f, "the curve is a point"),
            Self::Parameter { bits } => write!(f, "no curve of the patch has its parameter at {bits} / 2^48"),
            Self::Plane { units } => write!(f, "the plane reaches {units} over the surface, outside -32767 ..= 32767"),
            Self::Normal { offset } => write!(f, "the plane 0 = {offset} / 2^32 has no normal"),
            Self::Offset { units } => write!(f, "the plane's offset {units} is outside -2^31 .. 2^31"),
            Self::Internal => write!(f, "a rule of the method was broken"),
        }
    }
}

impl core::error::Error for IntersectError {}
