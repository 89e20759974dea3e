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
//! **Bands do not show.** Where a patch is split and which points a piece gets depends on the patch alone, every pixel
//! takes its nearest point (the first of equals, in the order of patches, pieces and points), and shade and depth depend
//! on the point alone: bands of 1 row and the whole frame give the same bytes. A band leaves out the pieces and the rows
//! of points that cannot reach it.
//!
//! **No holes.** Every pixel centre in the interpolant of a lattice is hit: inside a piece by the step counts of
//! [`Steps::hole_free`](crate::forward::Steps::hole_free), or fewer with cell centres; between pieces and between
//! patches, whatever their step counts, because counts have 1/128 in hand.
//!
//! # Pieces
//! One step count for a whole patch wastes points where it is short, turned away or out of sight. A patch is split at
//! midpoints ([`subdivide`](crate::subdivide)) until a piece has at most 370 points; a triangle or a rational patch while its parts
//! cost less than it does. No list is kept: pieces are walked depth first on a fixed stack ([`stack_bytes`]).
//!
//! | teapot, default view | points | points a pixel | pieces |
//! |---|---|---|---|
//! | 320 × 240, one frame | 153 024 | 2.32 | 624 |
//! | the same in 16-row bands | 193 919 | 2.94 | 1167 |
//! | 640 × 480, one frame | 511 842 | 1.99 | 1450 |
//!
//! *Pixels: distinct ones of each patch, summed.*
//!
//! A tensor-product piece of degree 3 or less is walked in fixed point of 32 bits, and where that leaves a pixel in doubt
//! (one point in a thousand) exact arithmetic decides: its points are the exact ones of its net. Positions of other
//! polynomial pieces are those of the net rounded to at least 7 fraction bits, where that lets 64-bit accumulators do: within
//! 1/256 + 1/8192 of a pixel of the patch; their z may count in steps of 2, 4 or 8 units where it moves faster than x and y.
//! Normals come from the piece's own net, all 16 fraction bits of it. Splitting rounds each control point once a level, to
//! 2^-17; seams get the same bits on both sides.
//!
//! # Two fills
//! | [`Fill`] | what it draws | holes | default teapot, 320 × 240 |
//! |---|---|---|---|
//! | `Exact` (default) | every exact point | none | levels within 1 of exact arithmetic |
//! | `Grid { tolerance }` | facets between exact points of a coarse grid | none but within the tolerance of silhouettes and borders | at 1 pixel: 1936 vertices, 1472 facets, levels off by 2.6 in the mean, 30 at the 99th percentile |
//!
//! Points are the reference quality, the grid is the fast path: its cost goes with the facets and the pixels that it
//! fills, not with points. An edge that patches share is cut alike on both sides, into the same vertices bit by bit, so
//! there is no crack; [`subdivide::topology`](crate::subdivide::topology) finds once which edges these are. Depth and
//! level are linear over a facet. In bands, a list of facets ([`Frame::with_facets`]) saves making them anew for every
//! band. A centre exactly on a border belongs to a facet only if the border is on its left or above.
//!
//! # Depth
//! A `u16` per pixel: 15 bits of depth and one that tells drawn from empty. The depth is the lattice z with k more bits,
//! (z + 1/2 − z_low)·2^k within one unit of what the piece's net says, or two of what a rounded one says; z_low and k ≤ 8 come
//! from the scene's z range, so the whole range is used.
//!
//! # Lines
//! Iso-parametric curves are rows of the patch's own exact lattice, at steps of less than a pixel: connected, and no
//! pixel twice in a tile. Where patches hide them, the patches' depths are laid down first.
//!
//! # Shading
//! Lambert: level = ambient + (255 − ambient)·max(0, N·L), after the depth test. N is turned to the viewer, or with
//! [`Cull::Back`] outwards. Tangents of pieces of degree 3 or less are polynomials of 25 bits or more, of others sums of
//! Bernstein weights of 30 bits and control differences (rational: exact forward differences), cut once to 28 bits or more;
//! their cross product is cut once to 15 bits and multiplied by a reciprocal of its length. The level is within 1 of exact arithmetic wherever |S_r × S_s| is at least 1/1000 of its maximum over
//! the piece (within 2 with a [`Gloss`]). Where a tangent vanishes (the pole of a patch with a collapsed side) the normal
//! 1/64 further inside is taken, for a rational piece that of its control net without weights.

mod brush;
mod cubic;
mod cull;
mod depth;
mod fill;
mod frame;
mod grid;
mod light;
mod lines;
mod notes;
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
pub use grid::Facet;
pub use light::Light;
pub use notes::Notes;
pub use pieces::stack_bytes;
pub use scene::Scene;
#[cfg(feature = "styled")]
pub(crate) use scene::fits_every_style;
pub use style::{Cull, Fill, Gloss, Lines, Style};
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
    /// A tolerance of the grid that is not positive.
    Tolerance {
        /// The tolerance in 2^-16 pixel.
        bits: i32,
    },
    /// Not one [`PatchTopology`](crate::subdivide::PatchTopology) for each patch: edges of neighbours would be cut into
    /// different segments.
    Topology {
        /// The patches.
        patches: usize,
        /// The entries of the topology; 0 without one.
        given: usize,
    },
    /// A patch needs more segments at this tolerance.
    Segments {
        /// The index of the patch.
        index: usize,
        /// The most that an edge can have.
        most: u16,
    },
    /// The list of facets is too short, or its links are; a list holds at most 65535.
    Facets {
        /// The facets of the frame.
        needed: usize,
        /// The entries of the list that can be used.
        given: usize,
        /// One for each band and each facet.
        needed_links: usize,
        /// The links that there are.
        given_links: usize,
    },
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
            Self::Tolerance { bits } => write!(f, "a tolerance of {bits}/65536 pixel is not positive"),
            Self::Topology { patches, given } => {
                write!(f, "a grid over {patches} patches needs a topology of as many entries, not {given}")
            }
            Self::Segments { index, most } => {
                write!(f, "patch {index} needs more than {most} segments in a direction at this tolerance")
            }
            Self::Facets { needed, given, needed_links, given_links } => write!(
                f,
                "{needed} facets with {needed_links} links do not fit {given} entries and {given_links} links"
            ),
        }
    }
}

impl core::error::Error for RenderError {}
