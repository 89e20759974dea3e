//! Smooth skins over triangle meshes: one quintic Bézier triangle a face, with one tangent plane along every edge.
//!
//! In come a [`Mesh`] of triangles, a normal for each vertex or none, and, if you like, tangents, twists and tensions; out
//! goes a [`Triangle`] of degree 5 for each face, made when it is asked for. Shared control points are bit-identical, so
//! there is no gap; the normals of neighbours agree along the whole edge up to the rounding of the control points.
//!
//! # Method
//! Jiang Shoushan, *On the degree of G1 interpolation over a spatial triangle mesh*: the boundary curves and the rows of
//! control points beside them are quintic, and fulfil ν·D* + μ·E + λ·D = 0 with linear ν, μ, λ along each edge, where E is
//! the derivative along it and D, D* those into its faces. The paper's construction ([`Scheme::Literal`]) divides by
//! what symmetry makes 0: opposite tangents, equal ratios at both ends of an edge. Here instead:
//!
//! 0. The mesh is moved to its middle and scaled up by a power of two, if it is small.
//! 1. Tangents have the lengths of circular arcs; where they leave a sector closed, too narrow or too wide, they are spread.
//! 2. The condition is brought to the form S + κT + mE = 0 with T = l − r, S = l + r − c − c⁺, E = c⁺ − c over the rows of
//!    control points beside and along the edge; κ and m at its ends follow from the areas between tangents.
//! 3. A vertex of even valence has one equation too many. Where the curves of its edges cannot take that up, the centre of
//!    its fan of tangents is moved a little: that is the first pass, which remembers a byte a vertex.
//! 4. The twist points and the third points of the edges around a vertex are those nearest to the cubic PN triangle's
//!    that fulfil its equations: a symmetric system of at most 16 rows.
//! 5. The two points beside the middle of an edge follow from both its ends.
//!
//! Nothing is global but the first pass, so faces stream out one after the other. Positions are integers of 2^-32 units
//! with products in 128 bits, coefficients of 2^-48. Angles decide whether and where tangents are spread; no other result
//! depends on their last bits.
//!
#![doc = include_str!("../../docs/img/g1.md")]
//!
//! *An icosahedron, a torus and a duck: flat, as PN triangles, and smooth. Stripes that a surface reflects are torn where its
//! tangent plane is (`examples/g1.rs`).*
//!
//! # Which meshes
//! Closed ones, and open ones with borders and holes; up to 16 edges a vertex. Corners of the mesh are met exactly, and
//! control points of flat regions lie in their plane. In exchange for smoothness the shape may suffer where the input is rough:
//! [`Interpolant::quality`] tells. A vertex of even valence keeps its tangents only if they are consistent by symmetry or
//! almost; so a symmetrical mesh and the same with noise of 10^-5 differ. [`Options::tolerance`] moves that border.

mod balance;
mod cyclic;
mod edge;
mod error;
mod face;
mod fan;
mod interpolant;
mod literal;
mod options;
mod quality;
mod ring;
mod search;
mod sectors;
mod setting;
mod shift;
mod solve;

pub use error::{G1Error, List};
pub use interpolant::{Interpolant, Triangles};
pub use options::{Controls, Lengths, Options, Scheme, Tangent, Twist};
pub use quality::Quality;
pub use shift::Shift;

#[cfg(doc)]
use crate::{mesh::Mesh, patch::Triangle};
use setting::FACTOR;

/// The most edges that a vertex may have.
pub const MAX_VALENCE: usize = 16;
