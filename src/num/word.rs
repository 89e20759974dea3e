//! The integers that the point engine accumulates in.

use num_traits::{AsPrimitive, PrimInt};

/// An accumulator of the point engine: `i32`, `i64` or `i128`.
///
/// All its arithmetic here is arithmetic modulo 2^w; the budget of [`crate::forward`] proves that what is compared
/// never depends on the bits that wrap away.
pub trait Word: PrimInt + AsPrimitive<i32> + AsPrimitive<i64> + core::fmt::Debug {
    /// Width in bits.
    const BITS: u32;
    /// Zero.
    const ZERO: Self;
    /// One.
    const ONE: Self;

    /// `value` modulo 2^w.
    fn truncate(value: i128) -> Self;

    /// Unsigned comparison: both sides read as w-bit unsigned integers.
    fn below(self, limit: Self) -> bool;

    /// `self + other` modulo 2^w.
    fn wrapping_plus(self, other: Self) -> Self;

    /// `self - other` modulo 2^w.
    fn wrapping_minus(self, other: Self) -> Self;

    /// `self * other` modulo 2^w.
    fn wrapping_times(self, other: Self) -> Self;

    /// `self * factor` modulo 2^w.
    fn wrapping_mul_i64(self, factor: i64) -> Self;
}

macro_rules! word {
    ($signed:ty, $unsigned:ty) => {
        impl Word for $signed {
            const BITS: u32 = <$signed>::BITS;
            const ZERO: Self = 0;
            const ONE: Self = 1;

            #[inline(always)]
            fn truncate(value: i128) -> Self {
                value as $signed
            }

            #[inline(always)]
            fn below(self, limit: Self) -> bool {
                (self as $unsigned) < (limit as $unsigned)
            }

            #[inline(always)]
            fn wrapping_plus(self, other: Self) -> Self {
                self.wrapping_add(other)
            }

            #[inline(always)]
            fn wrapping_minus(self, other: Self) -> Self {
                self.wrapping_sub(other)
            }

            #[inline(always)]
            fn wrapping_times(self, other: Self) -> Self {
                self.wrapping_mul(other)
            }

            #[inline(always)]
            fn wrapping_mul_i64(self, factor: i64) -> Self {
                self.wrapping_mul(factor as $signed)
            }
        }
    };
}

word!(i32, u32);
word!(i64, u64);
word!(i128, u128);
