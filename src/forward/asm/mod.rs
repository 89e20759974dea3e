//! Rows in assembly: the only `unsafe` code of the crate, behind the feature `asm`.
//!
//! A function here takes the differences of a row and returns the wrapping sum of its coordinates, or of the rows from it
//! on, or stores its points. It reads the arrays that it is given references to and nothing else, writes to those that it
//! may change and to its own stack, keeps what the calling convention asks to be kept, and returns for every count. No
//! address is made of a coordinate without a comparison with the end of what is there. The loops are unrolled 32 or 64
//! times and entered so that a row takes exactly its points, or the next multiple of four.
//!
//! | function | for | instructions a point |
//! |---|---|---|
//! | [`product_row`] | ARMv7-M: SMLAL keeps coordinate and fraction in 64 bits | 12 and 6 each 64 points |
//! | [`wide_row`] | ARMv7-M: 64-bit differences | 21 and 6 each 32 points |
//! | [`Places`], [`Depths`] | ARMv7-M: the same, to pixels, and from there to the nearest of a picture | 8 and 11, and 3 each 32 points, 19 and 17 a call |
//! | [`class_sum`] | ARMv6-M, RV32: 32-bit differences of a residue class | 15 and 5 (RV32: 2) each 32 points, 49 a row |
//! | [`pairs`] | ARMv6-M: the same, made for others to look at | 15 and 1 each 4, 5 each 32 points, 60 a call |
//!
//! `examples/fw_forms.rs` holds them against the Rust form on the targets.
#![allow(unsafe_code, reason = "audited: see above")]

#[cfg(any(forward_asm = "v6m", forward_asm = "rv32"))]
use super::table::Table;

#[cfg(forward_asm = "rv32")]
mod rv32;
#[cfg(forward_asm = "v6m")]
mod v6m;
#[cfg(forward_asm = "v7m")]
mod v7m;

/// Rows of a residue class that [`class_sum`] goes through: backward differences along rows, d1, d2, d3 (in the indices of
/// the class), and from row to row, at the row before the first one, of x, y, z each. Values v and d1, d2, d3 change from row
/// to row by those before them.
///
/// | words | |
/// |---|---|
/// | 0, 1 | for the function |
/// | 2 … 4, 5 … 7, 8 … 10 | second and first differences from row to row of d1, d1 |
/// | 11 … 13, 14 … 16 | d2 of z, y, x, first differences of it |
/// | 17 … 19, 20 … 22, 23 … 25, 26 … 28 | third, second and first differences from row to row of v, v |
/// | 29 … 31 | d3 |
#[cfg(any(forward_asm = "v6m", forward_asm = "rv32"))]
pub(super) type Walk = [i32; 32];

/// The walk of the rows with these differences: `[axis][b][a]`, the b-th along columns of the a-th along rows.
#[cfg(any(forward_asm = "v6m", forward_asm = "rv32"))]
#[inline(never)]
pub(super) fn walk_of([x, y, z]: &[Table<i32, 4>; 3]) -> Walk {
    let [v, d1, d2, d3] = [0, 1, 2, 3].map(|a| [0, 1, 2, 3].map(|b| [x[b][a], y[b][a], z[b][a]]));
    let backward = |[x, y, z]: [i32; 3]| [z, y, x];
    let triples = [d1[2], d1[1], d1[0], backward(d2[0]), backward(d2[1]), v[3], v[2], v[1], v[0], d3[0]];
    let mut walk = [0; 32];
    for (word, v) in walk.iter_mut().skip(2).zip(triples.as_flattened()) {
        *word = *v;
    }
    walk
}

#[cfg(forward_asm = "rv32")]
use rv32 as kernels;
#[cfg(forward_asm = "v6m")]
use v6m as kernels;
#[cfg(forward_asm = "v6m")]
pub(super) use v6m::{PAIRS, pairs};
#[cfg(forward_asm = "v7m")]
pub(super) use v7m::{Depths, PIXELS, Places, product_row, wide_row};

/// The sum of `rows` rows, which are one, or as many as the first one has points: `count`, and each other one has one less
/// than the one before it. Coordinates are above `shift` bits, 23 without a sign, 22 or 16 with one.
#[cfg(any(forward_asm = "v6m", forward_asm = "rv32"))]
pub(super) fn class_sum(walk: &mut Walk, shift: u32, count: u32, rows: u32) -> i32 {
    // SAFETY: each reads and writes the 32 words of `walk` alone.
    unsafe {
        match shift {
            23 => kernels::small(walk, count, rows),
            22 => kernels::screen(walk, count, rows),
            _ => kernels::large(walk, count, rows),
        }
    }
}
