//! Points to pixels: a depth-tested renderer for bands of any height.
//!
//! In come patches in screen coordinates and the caller's buffers; out go rectangles of shaded pixels. Nothing here
//! knows a colour type: a [`Paint`] turns a grey level at a pixel into one.
//!
#![doc = include_str!("../../docs/img/styles.md")]
//!
//! *[`Style`]: shaded, glossy, depth-cued, wire with hidden lines removed, control net, normals.*
//!
//! * [`Scene`]: patches, light and style, checked once. [`Scene::draw`] draws them into a [`Tile`].
//! * [`Tile`]: a rectangle of pixels in the caller's colour and depth buffers.
//! * [`Frame`]: pulls a picture band by band ([`Frame::next_band`]); the caller sends each band away, by DMA if it
//!   likes, and owns double buffering.
//!
//! **Bands do not show.** Which points a patch gets depends on the patch alone, every pixel takes its nearest point
//! (the first of equals, in the order of patches and points), and shade and depth depend on the point alone: bands
//! of 1 row and the whole frame give the same bytes.
//!
//! **No holes.** Patches are sampled by [`Sampling::cheapest`](crate::forward::Sampling::cheapest): every pixel centre
//! in the lattice's interpolant is hit, also along shared edges of patches, whatever their step counts.
//!
//! # Depth
//! A `u16` per pixel: 15 bits of depth and one that tells drawn from empty. The depth is the exact lattice z with k
//! more bits, (z + 1/2 − z_low)·2^k within one unit; z_low and k ≤ 8 come from the scene's z range, so the whole range
//! is used.
//!
//! # Lines
//! Iso-parametric curves are rows of the patch's own exact lattice, at steps of less than a pixel: connected, and no
//! pixel twice in a tile. Where patches hide them, the patches' depths are laid down first.
//!
//! # Shading
//! Lambert, two-sided (the normal is turned to the viewer): level = ambient + (255 − ambient)·max(0, N·L). The
//! tangents are exact forward differences, truncated once to 30 bits; their cross product is truncated once to 15
//! bits and divided by its integer length. The level is within 1 of exact arithmetic wherever |S_r × S_s| is at
//! least 1/1000 of its maximum over the patch (within 2 with a [`Gloss`]). Where a tangent vanishes (the pole of a patch with a collapsed side)
//! the normal 1/64 further inside is taken.

mod brush;
mod cull;
mod depth;
mod frame;
mod light;
mod lines;
mod pen;
mod pieces;
mod plan;
mod scene;
mod style;
mod tangents;
mod tile;

#[cfg(all(test, feature = "std"))]
mod tests;

pub use frame::{Band, Frame, Statistics};
pub use light::Light;
pub use scene::Scene;
#[cfg(feature = "styled")]
pub(crate) use scene::fits_every_style;
pub use style::{Cull, Gloss, Lines, Style};
pub use tile::{Area, Fragment, Paint, Tile};

use crate::forward::LatticeError;

/// Why a scene or a frame was refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum RenderError {
    /// The lattice of a patch does not fit the engine.
    Patch {
        /// The index of the patch.
        index: usize,
        /// What does not fit.
        error: LatticeError,
    },
    /// A buffer has fewer elements than the rectangle has pixels.
    Buffer {
        /// The pixels of the rectangle.
        needed: usize,
        /// The elements of the colour buffer.
        colour: usize,
        /// The elements of the depth buffer.
        depth: usize,
    },
    /// A rectangle without pixels, with a side above 32768, or bands of no rows.
    Area {
        /// Width in pixels.
        width: u32,
        /// Height, or rows of a band, in pixels.
        height: u32,
    },
    /// A light from no direction.
    Light,
}

impl core::fmt::Display for RenderError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Patch { index, error } => write!(f, "patch {index}: {error}"),
            Self::Buffer { needed, colour, depth } => {
                write!(f, "{needed} pixels do not fit buffers of {colour} colours and {depth} depths")
            }
            Self::Area { width, height } => write!(f, "an area of {width} x {height} pixels is not drawable"),
            Self::Light => write!(f, "the light's direction is zero"),
        }
    }
}

impl core::error::Error for RenderError {}
