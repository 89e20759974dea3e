//! Rows in assembly: the only `unsafe` code of the crate, behind the feature `asm`.
//!
//! A function here takes the differences of a row and returns the wrapping sum of its coordinates, or of the rows from it
//! on, or stores its points. It reads the arrays that it is given references to and nothing else, writes to those that it
//! may change and to its own stack, keeps what the calling convention asks to be kept, and returns for every count. No
//! address is made of a coordinate without a comparison with the end of what is there. The loops are unrolled 32 or 64
//! times and entered so that a row takes exactly its points.
//!
//! | function | for | instructions a point |
//! |---|---|---|
//! | [`product_row`] | ARMv7-M: SMLAL keeps coordinate and fraction in 64 bits | 12 and 6 each 64 points |
//! | [`wide_row`] | ARMv7-M: 64-bit differences | 21 and 6 each 32 points |
//! | [`Places`], [`Depths`] | ARMv7-M: the same, to pixels, and from there to the nearest of a picture | 8 and 11, and 3 each 32 points, 19 and 17 a call |
//! | [`class_sum`] | ARMv6-M, RV32: 32-bit differences of a residue class | 15 and 6 (RV32: 2) each 32 points, 108 (RV32: 91) a row |
//!
//! `examples/fw_forms.rs` holds them against the Rust form on the targets.
#![allow(unsafe_code, reason = "audited: see above")]

#[cfg(forward_asm = "rv32")]
mod rv32;
#[cfg(forward_asm = "v6m")]
mod v6m;
#[cfg(forward_asm = "v7m")]
mod v7m;

#[cfg(forward_asm = "rv32")]
pub(super) use rv32::class_sum;
#[cfg(forward_asm = "v6m")]
pub(super) use v6m::class_sum;
#[cfg(forward_asm = "v7m")]
pub(super) use v7m::{Depths, PIXELS, Places, product_row, wide_row};
