//! Exact Bézier surfaces for microcontrollers: no heap, no floats, no panics; integers only.
//!
#![doc = include_str!("../docs/img/teapot.md")]
//!
//! *The Utah teapot, 32 bicubic patches, every pixel from integer additions (`examples/teapot.rs`).*
//!
//! A firmware author describes a patch by its control points; this crate finds every pixel of the surface, exactly,
//! and draws it into an `embedded-graphics` target through a buffer of a few rows. The same code on a host gives the
//! same bits, so firmware is checked by golden tests.
//!
//! ```
//! use embedded_graphics::{mock_display::MockDisplay, pixelcolor::Rgb565, prelude::*};
//! use embedded_surfaces::{const_net, graphics::Model, patch::BicubicPatch};
//!
//! // Checked by the compiler, kept in flash.
//! static SAIL: [BicubicPatch; 1] = [const_net!(BicubicPatch::from_ints([
//!     [[4, 60, 0], [4, 44, 9], [4, 20, 9], [4, 4, 0]],
//!     [[20, 60, 9], [24, 44, 40], [24, 20, 40], [20, 6, 9]],
//!     [[40, 58, 9], [40, 44, 40], [36, 24, 40], [32, 12, 9]],
//!     [[60, 60, 0], [52, 44, 9], [44, 30, 9], [36, 20, 0]],
//! ]))];
//!
//! let mut display = MockDisplay::new(); // any `DrawTarget`
//! Model::shaded(&SAIL, Rgb565::YELLOW)?.draw(&mut display)?;
//! # assert!(display.get_pixel(Point::new(20, 40)).is_some());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Reading order
//! 1. [`num`]: the numbers and the one rounding rule, half up.
//! 2. [`geometry`]: points, boxes, affine maps, views by angle, perspective.
//! 3. [`patch`]: control nets of curves, triangles and tensor products, degrees 1 to 8, polynomial and rational.
//!    Ways in: Hermite, Coons, B-splines and NURBS, quadrics.
//! 4. [`forward`]: the point engine. Every lattice point is `floor(S + 1/2)` of the exact surface, by proof.
//! 5. [`subdivide`]: parts of nets, bounds, how patches meet, watertight meshes.
//! 6. [`mesh`] and [`g1`]: triangle meshes, checked; smooth skins over them.
//! 7. [`intersect`]: curves in which two surfaces meet, contour lines, nearest points.
//! 8. [`render`]: bands of pixels with depth test, shaded or as lines, the same bytes for every band height.
//! 9. `graphics`: drawables, strokes of curves, and colours (feature `graphics`, default).
//! 10. `reference`: the independent `f64` oracle to check scenes against (feature `std`, hosts only).
//!
//! # Features
//! | feature | brings |
//! |---|---|
//! | `graphics` (default) | `graphics`: drawing into `embedded-graphics-core` targets |
//! | `styled` | `Transform` on models and curves, `into_styled` on curves; needs the full `embedded-graphics` |
//! | `defmt` | `defmt::Format` on every public type |
//! | `asm` | rows in assembly, the only `unsafe` code: sums of lattices on ARMv6-M, ARMv7-M and RV32, visibility buffers on ARMv7-M, points in row order on ARMv6-M |
//! | `std` | `reference`; the rest stays `no_std` code |
//!
//! # What it asks of a target
//! Rust 1.95 or later, 32-bit integers or wider, no FPU, no allocator. Built and run in CI on `thumbv6m`,
//! `thumbv7m`, `thumbv7em` and `riscv32imc` under emulation. Nothing should panic on a path a user can reach: CI looks
//! for `core::panicking` in a linked firmware that walks lattices; the rest is fuzzed on a host.
#![no_std]
#![cfg_attr(not(feature = "asm"), forbid(unsafe_code))]
#![cfg_attr(feature = "asm", deny(unsafe_code))]
#![cfg_attr(docsrs, feature(doc_cfg))]

#[cfg(any(test, feature = "std"))]
extern crate std;

pub mod num;

pub mod geometry;

pub mod patch;

pub mod mesh;

pub mod forward;

pub mod subdivide;

pub mod g1;

pub mod intersect;

pub mod render;

#[cfg(feature = "graphics")]
#[cfg_attr(docsrs, doc(cfg(feature = "graphics")))]
pub mod graphics;

#[cfg(feature = "std")]
#[cfg_attr(docsrs, doc(cfg(feature = "std")))]
pub mod reference;
