//! Points, vectors, boxes, and the maps that bring control points to the screen.
//!
//! In come coordinates of [`crate::num`]; out go points, exact boxes and affine or perspective views. A polynomial
//! surface commutes with affine maps, so a view is applied to control points only, rounded once, half up.
//!
//! Screen coordinates: x to the right, y down, pixel centres at integers, z away from the viewer (smaller z is
//! nearer). Model coordinates of a [`View`]: z up.

mod affine;
mod bounds;
mod point;
mod view;

pub use affine::Affine;
pub use bounds::Bounds;
pub use point::{Axis, Point3, Vector3};
pub use view::{Perspective, View};

/// Why a map could not be made or applied.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum GeometryError {
    /// A mapped coordinate lies outside the legal range of its type.
    OutOfRange {
        /// The axis of the coordinate.
        axis: Axis,
        /// The coordinate, in whole units, rounded down.
        units: i64,
        /// The largest legal absolute value.
        limit: i64,
    },
    /// A matrix entry does not fit an `I32F32`.
    MatrixOverflow,
    /// A view was asked to fit no points, or points that all project to one.
    NothingToFit,
    /// A fraction of the screen that is not above 0, or a screen without pixels.
    EmptyScreen {
        /// Width of the screen in pixels.
        width: u32,
        /// Height of the screen in pixels.
        height: u32,
    },
    /// A point at or behind the eye: distance + z, or the distance itself, is not positive.
    BehindEye {
        /// The smaller of the two, in whole units, rounded down.
        units: i64,
    },
}

impl core::fmt::Display for GeometryError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::OutOfRange { axis, units, limit } => {
                write!(f, "{axis} coordinate near {units} is outside -{limit} ..= {limit}")
            }
            Self::MatrixOverflow => write!(f, "a matrix entry does not fit 32 integer bits"),
            Self::NothingToFit => write!(f, "the points to fit are none or all the same on the screen"),
            Self::EmptyScreen { width, height } => write!(f, "nothing fits a screen of {width} x {height} pixels"),
            Self::BehindEye { units } => write!(f, "a point lies behind the eye: its distance is near {units}"),
        }
    }
}

impl core::error::Error for GeometryError {}
