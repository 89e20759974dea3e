//! The point engine: exact lattices of curves and surfaces by forward differences (Huang & Zhu 2002).
//!
//! In comes a net of [`I16F16`](crate::num::I16F16) points and step counts; out come the integer points
//! `floor(S(i/n_r, j/n_s) + 1/2)`, row by row, with additions and compares only.
//!
#![doc = include_str!("../../docs/img/seed_patches.md")]
//!
//! *The two cubic triangles of the paper, seen along z and along x: 601 and 1021 hole-free steps a side.*
//!
//! # How
//! With N = n_r^m n_s^h 2^F (n^m 2^F for triangles and curves; F: fraction bits that the net really uses),
//! φ(i, j) = N·S(i/n_r, j/n_s) is a polynomial in i and j with integer coefficients. Its Newton differences at (0, 0)
//! are set up once; then each point costs m additions per coordinate. A coordinate is carried as its rounded value x
//! and the residual e = φ + ⌊N/2⌋ − N·x, which stays in 0 ..= N − 1; a step adds Δφ to e and corrects x.
//!
//! # Why it is exact
//! All arithmetic is modulo 2^w, and e is the only value that is compared. Where no step is longer than K units, e
//! plus a step lies in (−K·N, (K+1)·N), an interval of (2K+1)·N values, so **(2K+1)·N < 2^w** is enough: differences
//! may wrap, x cannot be wrong. K comes from the control net (m·max|ΔP|/n, rounded up). The paper's ±1 correction is
//! the case K = 1 and loses step when a step is longer; this engine corrects by any K.
//!
//! | kernel | when | work per step and coordinate, after m additions |
//! |---|---|---|
//! | accumulate | N = 2^f, and the coordinate's bits fit above them | a shift to read |
//! | mask | N = 2^f | a shift, an addition, a mask; on ARMv7-M one multiplication that adds to 64 bits, for the first addition too |
//! | residual | any N | one unsigned compare; ⌊log2 K⌋ + 1 compares and subtractions when x changes |
//!
//! The narrowest of `i32`, `i64`, `i128` with (2K+1)·N < 2^w is taken; what fits none is a
//! [`LatticeError::Budget`].
//!
//! Where the order does not matter, and in row order on cores of 32 bits that have nothing better, lattices with N = 2^f
//! fall apart into sub-lattices that are accumulated in 32 bits though N and the coordinate have a few more
//! ([`Lattice::for_each_unordered`]).
//!
//! What is nearest at each pixel, and which point it is of, goes into a [`VisibilityBuffer`], to be shaded after.
//!
//! # How it is fast
//! On 32-bit cores points are made in runs of up to 49, one coordinate after the other: three or four differences are all
//! that a loop keeps in registers. The loops do not know who looks at the points, so an image holds each of them once,
//! and each closure once. Cubics in `i32` have loops of their own, which know: on RV32, which has registers for it, points
//! are made one by one; on ARMv7-M x and y are made in runs and z where points are given away; on ARMv6-M runs are longer,
//! where N = 2^f. On 64-bit hosts neighbours are made in vector registers.
//!
//! Instructions a point under QEMU, the sum of all coordinates as the sink and all set-up included, of a cubic triangle of
//! 256 steps with whole coordinates (`examples/fw_bench.rs`, which has more rows):
//!
//! | | M0 | M4 | RV32 |
//! |---|---|---|---|
//! | row order | 34.1 | 22.9 | 24.4 |
//! | any order | 28.7 | 18.0 | 18.5 |
//! | nearest of each pixel ([`VisibilityBuffer::draw`]) | 50.7 | 35.9 | 34.7 |
//! | row order with the feature `asm` | 29.2 | 22.9 | 24.4 |
//! | [`Lattice::checksum`] with it | 16.7 | 13.5 | 16.4 |
//! | nearest of each pixel with it | 50.7 | 21.1 | 34.7 |
//!
//! What a compiler leaves above that, in any order: on ARMv6-M a coordinate takes three additions, a shift and a store, and
//! 0.7 more for a loop of eight that reads the last difference anew, of which the last ones of a row are not all wanted;
//! then the point is loaded and added up in 7, and the change of a row of 65 points takes 220. On M4 a sum has nine
//! additions, three shifted ones and two loads of last differences, because nine values, one difference and the sum leave
//! no register for them, and the change of a row takes 110.

#[cfg(forward_asm)]
mod asm;
mod bounds;
mod budget;
mod checksum;
mod class_runs;
mod columns;
mod curve;
mod engine;
mod estimate;
mod fill;
mod form;
mod joined;
mod kernel;
mod lanes;
mod lattice;
mod monomial;
mod piece;
#[cfg(feature = "graphics")]
mod plane;
mod quotient;
mod residue;
mod run;
mod steps;
mod table;
mod tangent;
mod visibility;
mod visit;
mod walk;

pub use budget::{Accumulator, Budget, LatticeError};
pub use curve::{CurveLattice, CurvePoint, CurvePoints, UnitStep, UnitSteps};
pub use lattice::{Lattice, LatticePoint, LatticePoints, RowStep, RowSteps};
pub use steps::{Sampling, Steps};
pub use visibility::{Tags, VisibilityBuffer, VisibilityError, Visible};

pub(crate) use budget::MAX_STEPS;
pub(crate) use estimate::Estimate;
pub(crate) use form::{Form, Kind};
pub(crate) use kernel::{Kernel, Residual};
pub(crate) use piece::{PieceBudget, PieceSlopes, deepest_budget, piece_budget};
#[cfg(feature = "graphics")]
pub(crate) use plane::{PlanePlan, PlaneWalk, PlaneWalker};
pub(crate) use quotient::QuotientWalker;
pub(crate) use steps::row_count;
pub(crate) use tangent::tangent_bits;
pub(crate) use visit::{Fraction, Site, Visit};
pub(crate) use walk::Walker;
