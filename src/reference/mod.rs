//! The oracle: surfaces in `f64`, to check the integer engine against on a host (feature `std`).
//!
//! In come the same control nets that the engine takes; out go points, derivatives, normals, shades and the set of
//! pixel centres that a surface covers. It promises independence: of the rest of the crate it reads control points
//! and degrees, nothing else, and it evaluates the defining sums directly; only `audit` runs the renderer, to compare.
//! Agreement with the engine is therefore evidence. It promises nothing for a target: it has a heap, floats and `std`.
//!
//! | file | comes in → goes out |
//! |---|---|
//! | `eval` | net and parameters → [`point`], [`partials`]; `f64` → nearest coordinate, half up |
//! | `shade` | net and parameters → [`unit_normal`]; normal and light → [`lambert`] |
//! | `mesh` | net and cell counts → rows of vertices in units of 2^-24 pixel |
//! | `coverage` | net and cell counts → [`Coverage`], the pixel centres inside, by exact predicates |
//! | `audit` | patches → what the renderer hits and misses, [`Audit`]: the one part that runs the engine |
//!
//! Parameters are (r, s) in 0 ..= 1 for tensor-product patches and (u, v) with w = 1 − u − v for triangles. Screen
//! coordinates: y down, pixel centres at integers, smaller z nearer.
//!
//! ```
//! use embedded_surfaces::forward::{Lattice, Steps};
//! use embedded_surfaces::patch::{QuadraticTriangle, Surface};
//! use embedded_surfaces::reference::{Coverage, fine_mesh};
//!
//! let patch = QuadraticTriangle::from_ints([[9, 1, 0], [40, 9, 5], [2, 20, 9], [60, 30, 0], [33, 44, 7], [5, 50, 0]])?;
//! let lattice = Lattice::new(patch.surface(), Steps::hole_free(patch.surface()))?;
//!
//! let mut hits = Coverage::around(patch.surface());
//! lattice.for_each(|p| { hits.insert(p.x, p.y); });
//! let mut truth = Coverage::around(patch.surface());
//! truth.add(patch.surface(), fine_mesh(lattice.steps()));
//! assert!(truth.count() > 1000 && truth.missed(&hits).is_empty());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
#![allow(clippy::disallowed_types, clippy::float_arithmetic, clippy::float_cmp)]

mod audit;
mod coverage;
mod eval;
mod mesh;
mod shade;

pub use audit::Audit;
pub use coverage::{Centres, Coverage};
pub use eval::{curve_derivative, curve_point, fixed_half_up, partials, point};
pub use mesh::fine_mesh;
pub use shade::{blinn_phong, lambert, shade, unit_normal};

#[cfg(test)]
mod samples;
