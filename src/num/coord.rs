//! The two coordinate types.

use super::{I16F16, I32F32};

mod sealed {
    pub trait Sealed {}
    impl Sealed for super::I16F16 {}
    impl Sealed for super::I32F32 {}
}

/// A coordinate of a control point: [`I16F16`] or [`I32F32`]. One unit is one pixel or one motor step.
///
/// The legal range is narrower than the type's, so that every difference, derivative and rounding of legal
/// coordinates stays representable: ±32767 for `I16F16` (the rounded value fits an `i16`), ±2^26 for `I32F32`
/// (eight times a difference fits an `I32F32`). Constructors of control nets check it once.
///
/// ```
/// use embedded_surfaces::num::{Coord, I16F16};
/// assert!(I16F16::from_num(32767).is_legal());
/// assert!(!I16F16::MAX.is_legal());
/// ```
pub trait Coord: sealed::Sealed + Copy + Ord + core::hash::Hash + core::fmt::Debug + 'static {
    /// Fraction bits of the type.
    const FRACTION_BITS: u32;
    /// The largest legal absolute value, in units.
    const LIMIT: i64;
    /// Zero.
    const ZERO: Self;

    /// The raw bits: the value times 2^[`FRACTION_BITS`](Self::FRACTION_BITS).
    fn bits(self) -> i64;

    /// The coordinate with these raw bits; `None` outside the legal range.
    fn from_legal_bits(bits: i128) -> Option<Self>;

    /// Whether the value is in the legal range.
    fn is_legal(self) -> bool {
        self.bits().unsigned_abs() <= (Self::LIMIT as u64) << Self::FRACTION_BITS
    }
}

/// Raw bits of an `I16F16`, in constant context.
pub(crate) const fn bits_i16f16(c: I16F16) -> i64 {
    c.to_bits() as i64
}

/// Raw bits of an `I32F32`, in constant context.
pub(crate) const fn bits_i32f32(c: I32F32) -> i64 {
    c.to_bits()
}

macro_rules! coord {
    ($fixed:ty, $raw:ty, $fraction:literal, $limit:expr) => {
        impl Coord for $fixed {
            const FRACTION_BITS: u32 = $fraction;
            const LIMIT: i64 = $limit;
            const ZERO: Self = <$fixed>::ZERO;

            #[inline]
            fn bits(self) -> i64 {
                i64::from(self.to_bits())
            }

            #[inline]
            fn from_legal_bits(bits: i128) -> Option<Self> {
                (bits.unsigned_abs() <= (Self::LIMIT as u128) << Self::FRACTION_BITS)
                    .then(|| <$fixed>::from_bits(bits as $raw))
            }
        }
    };
}

coord!(I16F16, i32, 16, 32767);
coord!(I32F32, i64, 32, 1 << 26);
