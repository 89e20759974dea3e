//! Numbers: the only module with shifts, widening and rounding rules.
//!
//! In come fixed-point coordinates and small integers; out go exactly rounded ones. Every rounding in this crate
//! is *half up*: `floor(x + 1/2)`. It commutes with integer translations, and both sides of a shared edge round it
//! to the same bits.
//!
//! | type | what it is | legal range |
//! |---|---|---|
//! | [`I16F16`] | coordinates that the point engine takes | −32767 ..= 32767 units |
//! | [`I32F32`] | coordinates of intermediate results, matrices | −2^26 ..= 2^26 units |
//! | [`Angle`] | a binary fraction of a turn, 2^-32 turns a step | any, it wraps |
//! | [`Word`] | what the engine accumulates in: `i32`, `i64`, `i128` | chosen from a proven budget |

mod coord;
mod real;
mod reciprocal;
mod round;
mod text;
mod trig;
mod triple;
mod wide;
mod word;

pub use coord::Coord;
pub use fixed::types::{I16F16, I32F32};
pub use trig::Angle;
pub use word::Word;

pub(crate) use coord::{bits_i16f16, bits_i32f32};
pub(crate) use real::Real;
pub(crate) use reciprocal::{
    At, cubic_at, exact_reciprocal, high, leading_zeros, multiply, reciprocal, reciprocal_root, times_256th,
};
pub(crate) use round::{
    BINOMIAL, SURJECTIONS, div_half_up, div_up, product_half_up, products_half_up, shift_half_up, shift_up, sqrt_up,
};
pub(crate) use text::{Decimal, binary32};
pub(crate) use trig::arctangent;
pub(crate) use triple::{
    Sum3, Triple, UNIT, bits, cross, dot, length, minus, narrow, plus, ratio, root, shortened, unit,
};
pub(crate) use wide::Wide;
