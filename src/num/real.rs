//! Numbers with a wide range for geometry: a mantissa of 62 bits and an exponent, both integers.
//!
//! A relative error of at most 2^-60 an operation, no overflow for exponents that geometry can reach, the same bits on
//! every target. Only what intersection needs: sums, products, quotients, roots, comparisons.
//!
//! On targets of 32 bits an operation is a call: in place it would be 60 to 400 bytes of code, some thousand times.

use super::round::{long_quotient, product_down};
use core::cmp::Ordering;
use core::ops::{Add, Div, Mul, Neg, Sub};

/// `mantissa` · 2^`exponent`; the mantissa is 0 or has a magnitude in 2^61 ..= 2^62.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Real {
    mantissa: i64,
    exponent: i32,
}

impl Real {
    pub(crate) const ZERO: Self = Self { mantissa: 0, exponent: 0 };
    pub(crate) const ONE: Self = Self { mantissa: 1 << 61, exponent: -61 };

    /// `value` · 2^`exponent`. The magnitude of `value` is below 2^63.
    #[inline]
    pub(crate) const fn new(value: i64, exponent: i32) -> Self {
        let zeros = value.unsigned_abs().leading_zeros() as i32;
        if zeros >= 2 {
            if value == 0 {
                return Self::ZERO;
            }
            Self { mantissa: value << (zeros - 2), exponent: exponent - (zeros - 2) }
        } else {
            Self { mantissa: value >> (2 - zeros), exponent: exponent + (2 - zeros) }
        }
    }

    /// `value` · 2^`exponent`, rounded down to the mantissa.
    #[cfg_attr(target_pointer_width = "32", inline(never))]
    pub(crate) const fn wide(value: i128, exponent: i32) -> Self {
        let shift = 66 - value.unsigned_abs().leading_zeros() as i32;
        if shift > 0 { Self::new((value >> shift) as i64, exponent + shift) } else { Self::new(value as i64, exponent) }
    }

    /// A whole number.
    pub(crate) const fn int(value: i64) -> Self {
        Self::new(value, 0)
    }

    /// 2^`exponent`.
    pub(crate) const fn power(exponent: i32) -> Self {
        Self { mantissa: 1 << 61, exponent: exponent - 61 }
    }

    /// `self` · 2^`shift`.
    #[inline]
    pub(crate) const fn shl(self, shift: i32) -> Self {
        if self.mantissa == 0 { self } else { Self { mantissa: self.mantissa, exponent: self.exponent + shift } }
    }

    /// `floor(self · 2^fraction_bits)`, or the end of the range of an `i64`.
    #[inline]
    pub(crate) const fn fixed(self, fraction_bits: i32) -> i64 {
        let shift = self.exponent + fraction_bits;
        if shift > 1 {
            return if self.mantissa == 0 {
                0
            } else if self.mantissa > 0 {
                i64::MAX
            } else {
                i64::MIN
            };
        }
        if shift >= 0 {
            self.mantissa << shift
        } else if shift > -64 {
            self.mantissa >> -shift
        } else {
            self.mantissa >> 63
        }
    }

    /// Nearest fixed-point value, half up, or the end of the range of an `i64`.
    #[cfg_attr(target_pointer_width = "32", inline(never))]
    #[cfg_attr(not(target_pointer_width = "32"), inline)]
    pub(crate) fn nearest(self, fraction_bits: i32) -> i64 {
        (self + Self::power(-fraction_bits - 1)).fixed(fraction_bits)
    }

    pub(crate) const fn is_zero(self) -> bool {
        self.mantissa == 0
    }

    pub(crate) const fn is_negative(self) -> bool {
        self.mantissa < 0
    }

    pub(crate) const fn is_positive(self) -> bool {
        self.mantissa > 0
    }

    pub(crate) const fn abs(self) -> Self {
        Self { mantissa: self.mantissa.abs(), exponent: self.exponent }
    }

    /// The square root; 0 for what is not positive.
    #[cfg_attr(target_pointer_width = "32", inline(never))]
    pub(crate) fn sqrt(self) -> Self {
        if self.mantissa <= 0 {
            return Self::ZERO;
        }
        // What is left of the exponent is even; the value, mantissa · 2^shift, has 122 to 124 bits.
        let odd = self.exponent & 1;
        let exponent = self.exponent - 60 - odd;
        Self::new(root(self.mantissa.unsigned_abs(), 60 + odd as u32) as i64, exponent >> 1)
    }

    pub(crate) fn min(self, other: Self) -> Self {
        if other < self { other } else { self }
    }

    pub(crate) fn max(self, other: Self) -> Self {
        if other > self { other } else { self }
    }

    /// The square.
    #[inline]
    pub(crate) fn square(self) -> Self {
        self * self
    }
}

/// The root of `value` · 2^`shift`, a number of 122 to 124 bits, to the last bit or two: the 32 upper bits by the root of
/// 64 bits, the rest by a step of Newton's method.
fn root(value: u64, shift: u32) -> u64 {
    let first = (value >> (62 - shift)).isqrt();
    let guess = first << 31;
    (guess + long_quotient(value, guess, shift)) >> 1
}

impl Neg for Real {
    type Output = Self;

    #[inline]
    fn neg(self) -> Self {
        Self { mantissa: -self.mantissa, exponent: self.exponent }
    }
}

impl Add for Real {
    type Output = Self;

    #[cfg_attr(target_pointer_width = "32", inline(never))]
    #[cfg_attr(not(target_pointer_width = "32"), inline)]
    fn add(self, other: Self) -> Self {
        if other.mantissa == 0 {
            return self;
        }
        if self.mantissa == 0 {
            return other;
        }
        let (high, low) = if self.exponent >= other.exponent { (self, other) } else { (other, self) };
        let shift = high.exponent.saturating_sub(low.exponent);
        if shift > 62 {
            return high;
        }
        Self::new(high.mantissa + (low.mantissa >> shift), high.exponent)
    }
}

impl Sub for Real {
    type Output = Self;

    #[inline]
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for Real {
    type Output = Self;

    #[cfg_attr(target_pointer_width = "32", inline(never))]
    #[cfg_attr(not(target_pointer_width = "32"), inline)]
    fn mul(self, other: Self) -> Self {
        Self::new(product_down::<62>(self.mantissa, other.mantissa), self.exponent + other.exponent + 62)
    }
}

/// The quotient; 0 for the divisor 0, which callers exclude or take as such.
impl Div for Real {
    type Output = Self;

    #[cfg_attr(target_pointer_width = "32", inline(never))]
    #[cfg_attr(not(target_pointer_width = "32"), inline)]
    fn div(self, other: Self) -> Self {
        if other.mantissa == 0 {
            return Self::ZERO;
        }
        let size = long_quotient(self.mantissa.unsigned_abs(), other.mantissa.unsigned_abs(), 61) as i64;
        let quotient = if (self.mantissa ^ other.mantissa) < 0 { -size } else { size };
        Self::new(quotient, self.exponent - other.exponent - 61)
    }
}

impl PartialOrd for Real {
    #[inline]
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Real {
    #[cfg_attr(target_pointer_width = "32", inline(never))]
    #[cfg_attr(not(target_pointer_width = "32"), inline)]
    fn cmp(&self, other: &Self) -> Ordering {
        let sign = self.mantissa.signum().cmp(&other.mantissa.signum());
        if sign != Ordering::Equal || self.mantissa == 0 {
            return sign;
        }
        let size = self.exponent.cmp(&other.exponent);
        let size = if self.mantissa < 0 { size.reverse() } else { size };
        size.then(self.mantissa.cmp(&other.mantissa))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[allow(clippy::disallowed_types, clippy::float_arithmetic)]
    fn float(x: Real) -> f64 {
        x.mantissa as f64 * 2_f64.powi(x.exponent)
    }

    proptest! {
        #[test]
        #[allow(clippy::disallowed_types, clippy::float_arithmetic)]
        fn agrees_with_binary64(a in -1_i64 << 60..1 << 60, b in -1_i64 << 60..1 << 60, s in -80_i32..80) {
            let (x, y) = (Real::new(a, -40), Real::new(b, s));
            let (fx, fy) = (float(x), float(y));
            let near = |ours: Real, theirs: f64, scale: f64| (float(ours) - theirs).abs() <= 4e-16 * scale;
            prop_assert!(near(x + y, fx + fy, fx.abs() + fy.abs()));
            prop_assert!(near(x - y, fx - fy, fx.abs() + fy.abs()));
            prop_assert!(near(x * y, fx * fy, (fx * fy).abs()));
            if b != 0 {
                prop_assert!(near(x / y, fx / fy, (fx / fy).abs()));
            }
            prop_assert!(near(x.abs().sqrt(), fx.abs().sqrt(), fx.abs().sqrt()));
            prop_assert_eq!(x < y, fx < fy);
            prop_assert_eq!(Real::new(a, -40).fixed(40), a);
        }
    }

    #[test]
    fn ends_of_the_range() {
        assert_eq!(Real::power(70).fixed(0), i64::MAX);
        assert_eq!((-Real::power(70)).fixed(0), i64::MIN);
        assert_eq!((Real::power(-200)).fixed(0), 0);
        assert_eq!((-Real::power(-200)).fixed(0), -1);
        assert_eq!(Real::int(9).sqrt().nearest(0), 3);
        assert_eq!(Real::new(i64::MIN + 1, 0).fixed(0), i64::MIN);
        assert_eq!(Real::wide(3 << 100, -100), Real::int(3));
        assert_eq!(Real::ONE / Real::ZERO, Real::ZERO);
    }
}
