//! What can be wrong with a spline.

use crate::patch::NetError;

/// Why a knot vector or a spline was refused. Knots are in units of 2^-16.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum SplineError {
    /// Fewer knots than the order needs: twice the order.
    KnotCount {
        /// The fewest knots.
        least: usize,
        /// The knots given.
        given: usize,
    },
    /// A number of control points for which there are no such knots.
    PointCount {
        /// The fewest points: the order.
        least: usize,
        /// The most points: the knots 0, 1, 2 … end at 32767.
        most: usize,
        /// The points asked for.
        given: usize,
    },
    /// A knot below the one before it.
    Decreasing {
        /// The index of the knot.
        index: usize,
        /// The knot before it.
        previous: i32,
        /// The knot.
        bits: i32,
    },
    /// A domain without a span: it starts and ends at the same knot.
    EmptyDomain {
        /// The index of the knot at which it starts, the degree.
        index: usize,
        /// The knot at which it starts and ends.
        bits: i32,
    },
    /// Too many equal knots.
    Multiplicity {
        /// The index of the first one.
        index: usize,
        /// Their value.
        bits: i32,
        /// How many there are.
        multiplicity: usize,
        /// How many there may be: the degree inside the domain, one more elsewhere.
        limit: usize,
    },
    /// A number of weights that differs from the number of points.
    WeightCount {
        /// The number of points.
        expected: usize,
        /// The weights given.
        given: usize,
    },
    /// A weight that leaves the type when scaled.
    WeightScale {
        /// The index of the weight.
        index: usize,
        /// The weight in units of 2^-16.
        bits: i32,
        /// The binary logarithm of the scale.
        log2: u32,
    },
    /// A wrong number of points, a point out of range, or a weight that is not positive.
    Net(NetError),
}

impl From<NetError> for SplineError {
    fn from(error: NetError) -> Self {
        Self::Net(error)
    }
}

impl core::fmt::Display for SplineError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::KnotCount { least, given } => write!(f, "the order needs at least {least} knots, {given} given"),
            Self::PointCount { least, most, given } => {
                write!(f, "{given} control points are not in {least} ..= {most}")
            }
            Self::Decreasing { index, previous, bits } => {
                write!(f, "knot {index}, {bits} / 65536, is below the one before it, {previous} / 65536")
            }
            Self::EmptyDomain { index, bits } => {
                write!(f, "the domain starts at knot {index} and ends there too, at {bits} / 65536")
            }
            Self::Multiplicity { index, bits, multiplicity, limit } => write!(
                f,
                "{multiplicity} knots from knot {index} on are {bits} / 65536, at most {limit} may be equal there"
            ),
            Self::WeightCount { expected, given } => write!(f, "{expected} control points have {given} weights"),
            Self::WeightScale { index, bits, log2 } => {
                write!(f, "weight {index}, {bits} / 65536, times 2^{log2} is not below 32768")
            }
            Self::Net(error) => error.fmt(f),
        }
    }
}

impl core::error::Error for SplineError {
    fn source(&self) -> Option<&(dyn core::error::Error + 'static)> {
        match self {
            Self::Net(error) => Some(error),
            _ => None,
        }
    }
}
