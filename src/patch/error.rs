//! What can be wrong with a control net or a parameter.

use super::Dimension;
use crate::geometry::{Axis, Point3};
use crate::num::I16F16;

/// Why a net or a parameter was refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum NetError {
    /// A degree outside 1 ..= 8.
    Degree {
        /// The degree asked for.
        degree: usize,
    },
    /// A number of points that the degree does not have.
    Count {
        /// The points that the degree needs.
        expected: usize,
        /// The points given.
        given: usize,
    },
    /// A coordinate outside the legal range of its type.
    OutOfRange {
        /// The index of the point in storage order.
        index: usize,
        /// The axis of the coordinate.
        axis: Axis,
        /// The coordinate, in whole units, rounded down.
        units: i64,
        /// The largest legal absolute value.
        limit: i64,
    },
    /// A weight that is not positive.
    Weight {
        /// The index of the weight in storage order.
        index: usize,
        /// The weight in units of 2^-16.
        bits: i32,
    },
    /// A parameter outside 0 ..= 1, or whose denominator is not in 1 ..= 65536.
    Parameter {
        /// The numerator.
        numerator: u32,
        /// The denominator.
        denominator: u32,
    },
    /// A target degree of an elevation below the degree of the net.
    Elevation {
        /// The degree of the net.
        from: usize,
        /// The degree asked for.
        to: usize,
    },
    /// Two borders of a Coons patch that do not end in the same point.
    Corner {
        /// The r of the corner, 0 or 1.
        r: u8,
        /// The s of the corner, 0 or 1.
        s: u8,
        /// Where the border along r ends.
        along_r: Point3,
        /// Where the border along s ends.
        along_s: Point3,
    },
    /// A length of a solid that is not positive.
    NotPositive {
        /// Which one.
        dimension: Dimension,
        /// The length in units of 2^-16.
        bits: i32,
    },
}

impl core::fmt::Display for NetError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Degree { degree } => write!(f, "degree {degree} is outside 1 ..= 8"),
            Self::Count { expected, given } => write!(f, "the net needs {expected} control points, {given} given"),
            Self::OutOfRange { index, axis, units, limit } => {
                write!(f, "{axis} coordinate of point {index}, near {units}, is outside -{limit} ..= {limit}")
            }
            Self::Weight { index, bits } => write!(f, "weight {index} is not positive: {bits} / 65536"),
            Self::Parameter { numerator, denominator } => {
                write!(f, "parameter {numerator} / {denominator} is not in 0 ..= 1 with a denominator of 1 ..= 65536")
            }
            Self::Elevation { from, to } => write!(f, "degree {from} cannot be elevated to degree {to}"),
            Self::Corner { r, s, along_r: p, along_s: q } => {
                let ([px, py, pz], [qx, qy, qz]) =
                    (p.to_array().map(I16F16::to_bits), q.to_array().map(I16F16::to_bits));
                write!(
                    f,
                    "at the corner ({r}, {s}) the border along r ends at ({px}, {py}, {pz}) / 65536, \
                     the one along s at ({qx}, {qy}, {qz}) / 65536"
                )
            }
            Self::NotPositive { dimension, bits } => write!(f, "the {dimension} is not positive: {bits} / 65536"),
        }
    }
}

impl core::error::Error for NetError {}
