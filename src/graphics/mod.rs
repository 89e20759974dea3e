//! Adapters to `embedded-graphics`: the only module that names it.
//!
//! In come scenes of [`crate::render`] and curves in the plane; out go pixels in a `DrawTarget`.
//!
//! * [`Band::draw`](crate::render::Band::draw) sends a band by `fill_contiguous`, clipped to the target.
//! * [`Model`] is a `Drawable`: patches, a colour, a light and a place. It draws only the pixels that it covers.
//! * [`BezierCurve`] is a primitive: a curve of any degree, polynomial or rational, at a place. [`Stroke`] draws it, one
//!   pixel wide or thick; `into_styled` does with the feature `styled`.
//! * [`Material`] turns levels into colours: every RGB and grey type, and `BinaryColor` by ordered dithering.
//! * [`Palette`] looks them up in a table.
//! * [`Ramps`] mixes colours along a ramp per patch.
//!
//! Nothing outside the target's bounding box is ever emitted, and no pixel twice.
//!
#![doc = include_str!("../../docs/img/curves.md")]
//!
//! *Strokes of 1, 3, 8 and 12 pixels; the ring is four rational arcs.*

mod band;
mod colour;
mod curve;
mod mask;
mod model;
mod palette;
mod stroke;
#[cfg(feature = "styled")]
mod styled;
mod tiles;

pub use colour::{Material, Mix, Ramps, Shade};
pub use curve::{AnyCurveNet, BezierCurve, CurvePixels};
pub use model::Model;
pub use palette::Palette;
pub use stroke::{MAX_STROKE_WIDTH, Stroke};
#[cfg(feature = "styled")]
#[cfg_attr(docsrs, doc(cfg(feature = "styled")))]
pub use styled::{ModelStyle, Patches};

/// The `embedded-graphics-core` that this crate was built with.
pub use embedded_graphics_core;
