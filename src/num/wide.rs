//! Signed integers of 640 bits for exact evaluation at any parameter: set-up work, not inner loops.

/// Limbs of 32 bits. The widest value is the numerator of a rational derivative of a degree (8, 8) patch of
/// `I32F32` points at parameters with denominators q = 2^16, twice m·q·(A' W − A W'): |A'| ≤ 2^(1+58+31+240),
/// |W| < 2^(31+256), the second product is smaller, m·q = 2^19; 638 bits and the sign.
const LIMBS: usize = 20;

/// A signed integer of 640 bits in two's complement, least significant limb first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Wide([u32; LIMBS]);

impl Wide {
    pub(crate) const ZERO: Self = Self([0; LIMBS]);

    pub(crate) fn from_i64(value: i64) -> Self {
        let mut limbs = [if value < 0 { u32::MAX } else { 0 }; LIMBS];
        limbs[0] = value as u32;
        limbs[1] = (value >> 32) as u32;
        Self(limbs)
    }

    pub(crate) fn is_negative(&self) -> bool {
        self.0[LIMBS - 1] >> 31 == 1
    }

    pub(crate) fn is_zero(&self) -> bool {
        *self == Self::ZERO
    }

    pub(crate) fn add(&self, other: &Self) -> Self {
        self.combine(other, 0, 0)
    }

    pub(crate) fn sub(&self, other: &Self) -> Self {
        self.combine(other, u32::MAX, 1)
    }

    /// `self + (other ^ flip) + carry`: one loop for both signs.
    fn combine(&self, other: &Self, flip: u32, mut carry: u64) -> Self {
        let mut out = [0; LIMBS];
        for (out, (a, b)) in out.iter_mut().zip(self.0.iter().zip(&other.0)) {
            carry += u64::from(*a) + u64::from(b ^ flip);
            *out = carry as u32;
            carry >>= 32;
        }
        Self(out)
    }

    pub(crate) fn neg(&self) -> Self {
        Self::ZERO.sub(self)
    }

    /// `self * factor`, modulo 2^640.
    pub(crate) fn mul_i32(&self, factor: i32) -> Self {
        let (mut out, mut carry) = ([0; LIMBS], 0_u64);
        let magnitude = u64::from(factor.unsigned_abs());
        for (out, limb) in out.iter_mut().zip(&self.0) {
            carry += u64::from(*limb) * magnitude;
            *out = carry as u32;
            carry >>= 32;
        }
        let product = Self(out);
        if factor < 0 { product.neg() } else { product }
    }

    /// `self * other`, modulo 2^640.
    pub(crate) fn mul(&self, other: &Self) -> Self {
        let mut sum = Self::ZERO;
        for limb in other.0.iter().rev() {
            // Horner in base 2^32; the sign limb's weight is right modulo 2^640.
            let mut shifted = [0; LIMBS];
            shifted[1..].copy_from_slice(&sum.0[..LIMBS - 1]);
            let low = self.mul_i32((limb & 0x7fff_ffff) as i32);
            let high = if limb >> 31 == 1 { self.shl(31) } else { Self::ZERO };
            sum = Self(shifted).add(&low).add(&high);
        }
        sum
    }

    pub(crate) fn shl(&self, bits: u32) -> Self {
        let (limbs, bits) = ((bits / 32) as usize, bits % 32);
        let mut out = [0; LIMBS];
        let mut below = 0_u64;
        for (out, limb) in out.iter_mut().skip(limbs).zip(&self.0) {
            let pair = u64::from(*limb) << 32 | below;
            *out = ((pair << bits) >> 32) as u32;
            below = (*limb).into();
        }
        Self(out)
    }

    /// `floor(self / divisor + 1/2)` for a positive `divisor`, as raw bits of a coordinate; `None` when the quotient
    /// does not fit 64 bits or the divisor is not positive.
    pub(crate) fn div_half_up(&self, divisor: &Self) -> Option<i64> {
        if divisor.is_negative() || divisor.is_zero() {
            return None;
        }
        // floor((2v + d) / 2d) by restoring division on the magnitude of the floor's argument.
        let numerator = self.shl(1).add(divisor);
        let negative = numerator.is_negative();
        let mut rest = if negative { Self::from_i64(-1).sub(&numerator) } else { numerator };
        let step = divisor.shl(1);
        if !rest.sub(&step.shl(63)).is_negative() {
            return None;
        }
        let mut quotient = 0_i64;
        for bit in (0..63).rev() {
            let next = rest.sub(&step.shl(bit));
            if !next.is_negative() {
                rest = next;
                quotient |= 1 << bit;
            }
        }
        Some(if negative { -1 - quotient } else { quotient })
    }

    /// The number of bits of a value that is not negative, 0 for 0.
    pub(crate) fn bit_length(&self) -> u32 {
        let top = self.0.iter().rposition(|limb| *limb != 0);
        top.map_or(0, |i| 32 * (i as u32 + 1) - self.0[i].leading_zeros())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use num_bigint::BigInt;
    use proptest::prelude::*;
    use std::vec::Vec;

    fn big(w: &Wide) -> BigInt {
        let bytes: Vec<u8> = w.0.iter().flat_map(|limb| limb.to_le_bytes()).collect();
        BigInt::from_signed_bytes_le(&bytes)
    }

    fn floor(a: &BigInt, b: &BigInt) -> BigInt {
        let q = a / b;
        if (a % b).sign() == num_bigint::Sign::Minus { q - 1 } else { q }
    }

    proptest! {
        #[test]
        fn agrees_with_a_big_integer_library(a: i64, b: i64, c: i32, s in 0_u32..500) {
            let (wa, wb) = (Wide::from_i64(a), Wide::from_i64(b));
            prop_assert_eq!(big(&wa.add(&wb)), BigInt::from(a) + b);
            prop_assert_eq!(big(&wa.sub(&wb)), BigInt::from(a) - b);
            prop_assert_eq!(big(&wa.mul_i32(c)), BigInt::from(a) * c);
            prop_assert_eq!(big(&wa.shl(s)), BigInt::from(a) << s);
            let wide = wa.mul(&wb).mul(&wa).mul_i32(c);
            let exact = BigInt::from(a) * b * a * c;
            prop_assert_eq!(big(&wide), exact);
            prop_assert_eq!(u64::from(Wide::from_i64(a & i64::MAX).shl(s).bit_length()), (BigInt::from(a & i64::MAX) << s).bits());
            let (n, m) = (BigInt::from(a) * b, BigInt::from(a).magnitude().clone());
            let m = BigInt::from(m);
            if a != 0 && b.unsigned_abs() < 1 << 62 {
                let rounded = floor(&(2 * &n + &m), &(2 * &m));
                let magnitude = if a < 0 { wa.neg() } else { wa };
                prop_assert_eq!(wa.mul(&wb).div_half_up(&magnitude).map(BigInt::from), Some(rounded));
            }
        }
    }
}
