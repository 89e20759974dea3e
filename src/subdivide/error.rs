//! What can be wrong with a request to subdivide.

/// Why a patch cannot be subdivided as asked.
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
}

impl core::fmt::Display for SubdivideError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Tolerance { bits } => write!(f, "the tolerance is not positive: {bits} / 65536"),
            Self::TooDeep { needed, limit } => {
                write!(f, "the tolerance needs {needed} levels of subdivision, at most {limit} are possible")
            }
        }
    }
}

impl core::error::Error for SubdivideError {}
