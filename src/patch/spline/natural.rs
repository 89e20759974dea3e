//! Natural numbers that hold the numerators and denominators of knot insertion.

/// Limbs of 32 bits. A direction of degree 8 has at most 7 + 6 + … + 1 = 28 denominators below 2^32, a surface twice
/// that; their product D is below 2^1792. The widest number is the numerator 2·w·c + w of a division, over D, with a
/// coordinate c ≤ 2^32 − 2^16 and a weight w < 2^31: it is below 2^64·D.
const LIMBS: usize = 58;

/// A natural number below 2^1856, least significant limb first. Work is proportional to its length.
#[derive(Clone, Copy, Debug)]
pub(super) struct Natural {
    limbs: [u32; LIMBS],
    /// Limbs in use; those above are zero.
    len: usize,
}

impl Natural {
    pub(super) const ZERO: Self = Self { limbs: [0; LIMBS], len: 0 };

    pub(super) fn new(value: u64) -> Self {
        let mut limbs = [0; LIMBS];
        limbs[0] = value as u32;
        limbs[1] = (value >> 32) as u32;
        let mut new = Self { limbs, len: 2 };
        new.trim();
        new
    }

    /// Drops leading zeros.
    fn trim(&mut self) {
        let used = self.limbs.iter().take(self.len).rposition(|limb| *limb != 0);
        self.len = used.map_or(0, |top| top + 1);
    }

    /// Multiplies by `factor`.
    pub(super) fn scale(&mut self, factor: u32) {
        self.len += 1;
        let mut carry = 0;
        for limb in self.limbs.iter_mut().take(self.len) {
            carry += u64::from(*limb) * u64::from(factor);
            *limb = carry as u32;
            carry >>= 32;
        }
        self.trim();
    }

    /// Multiplies by all factors, as many at a time as fit a word.
    pub(super) fn scale_all(&mut self, factors: impl Iterator<Item = u32>) {
        let mut product = 1_u32;
        for factor in factors {
            product = product.checked_mul(factor).unwrap_or_else(|| {
                self.scale(product);
                factor
            });
        }
        self.scale(product);
    }

    /// Adds `factor` times `other`. The sum of a limb, a product and a carry is at most 2^64 − 1.
    pub(super) fn add_scaled(&mut self, other: &Self, factor: u32) {
        self.len = self.len.max(other.len) + 1;
        let mut carry = 0;
        for (limb, other) in self.limbs.iter_mut().zip(&other.limbs).take(self.len) {
            carry += u64::from(*other) * u64::from(factor) + u64::from(*limb);
            *limb = carry as u32;
            carry >>= 32;
        }
        self.trim();
    }

    /// Takes `factor` times `other` away, which is at most `self`.
    fn sub_scaled(&mut self, other: &Self, factor: u32) {
        let (mut carry, mut borrow) = (0, 0);
        for (limb, other) in self.limbs.iter_mut().zip(&other.limbs).take(self.len) {
            carry += u64::from(*other) * u64::from(factor);
            let rest = i64::from(*limb) - i64::from(carry as u32) - borrow;
            *limb = rest as u32;
            carry >>= 32;
            borrow = i64::from(rest < 0);
        }
        self.trim();
    }

    /// Whether it is at most `other`.
    fn at_most(&self, other: &Self) -> bool {
        let digits = || self.limbs.iter().rev().cmp(other.limbs.iter().rev());
        self.len.cmp(&other.len).then_with(digits).is_le()
    }

    /// How far the highest 32 bits are from the lowest bit; 0 below 2^32.
    fn shift(&self) -> usize {
        let top = self.limbs.get(self.len.wrapping_sub(1)).map_or(0, |limb| limb.leading_zeros() as usize);
        (32 * self.len).saturating_sub(32 + top)
    }

    /// `floor(self / 2^shift)` modulo 2^64.
    fn shifted(&self, shift: usize) -> u64 {
        let limb = |i: usize| self.limbs.get(shift / 32 + i).map_or(0, |limb| u128::from(*limb));
        ((limb(0) | limb(1) << 32 | limb(2) << 64) >> (shift % 32)) as u64
    }

    /// `floor(self / divisor + 1/2)`, which is below 2^32. The divisor is not zero.
    pub(super) fn div_half_up(&self, divisor: &Self) -> u32 {
        // floor((2n + d) / 2d)
        let (mut rest, mut double) = (*self, *divisor);
        rest.scale(2);
        rest.add_scaled(divisor, 1);
        double.scale(2);
        // Let t = floor(2d / 2^shift), of 32 bits or exact. A round takes p = floor(rest / 2^shift / (t + 1)) times 2d
        // away, at most rest, and leaves less than (t + p + 1) 2^shift: so p is below 2^32, then at most 4, then at
        // most 1, and less than 2·2d is left.
        let shift = double.shift();
        let above = double.shifted(shift) + u64::from(shift > 0);
        let mut quotient = 0_u32;
        for _ in 0..3 {
            let part = rest.shifted(shift).checked_div(above).unwrap_or(0) as u32;
            rest.sub_scaled(&double, part);
            quotient = quotient.wrapping_add(part);
        }
        quotient.wrapping_add(u32::from(double.at_most(&rest)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use num_bigint::BigUint;
    use proptest::prelude::*;
    use std::vec::Vec;

    fn big(n: &Natural) -> BigUint {
        assert!(n.limbs.iter().skip(n.len).all(|limb| *limb == 0) && (n.len == 0 || n.limbs[n.len - 1] != 0));
        BigUint::new(n.limbs.to_vec())
    }

    fn product(value: u64, factors: &[u32]) -> (Natural, BigUint) {
        let mut ours = Natural::new(value);
        ours.scale_all(factors.iter().copied());
        (ours, factors.iter().fold(BigUint::from(value), |n, f| n * f))
    }

    proptest! {
        #[test]
        fn agrees_with_a_big_integer_library(
            a in 0..1_u64 << 63, b: u64, c: u32,
            factors in prop::collection::vec(prop_oneof![any::<u32>(), 0_u32..9], 0..56),
        ) {
            let mut one_by_one = Natural::new(a);
            factors.iter().for_each(|f| one_by_one.scale(*f));
            prop_assert_eq!(big(&one_by_one), product(a, &factors).1);
            let ((x, exact_x), (y, exact_y)) = (product(a, &factors), product(b, &factors[factors.len() / 2..]));
            prop_assert_eq!(big(&x), exact_x.clone());
            let mut sum = x;
            sum.add_scaled(&y, c);
            prop_assert_eq!(big(&sum), &exact_x + &exact_y * c);
            prop_assert_eq!(x.at_most(&y), exact_x <= exact_y);
            prop_assert!(x.at_most(&x));
        }

        #[test]
        fn quotients_are_rounded_half_up(
            q: u32, d in prop_oneof![1..1_u64 << 31, 1..9_u64], rest: u64,
            factors in prop::collection::vec(prop_oneof![1_u32.., 1_u32..9], 0..56),
        ) {
            let (divisor, exact) = product(d, &factors);
            // q·d + rest with rest below d/2 or from there on.
            let (mut n, rest) = (divisor, rest % d);
            n.scale(q);
            n.add_scaled(&product(rest, &factors).0, 1);
            let up = u32::from(2 * rest >= d);
            prop_assume!(q.checked_add(up).is_some());
            prop_assert_eq!(n.div_half_up(&divisor), q + up);
            prop_assert_eq!(big(&divisor), exact);
        }
    }

    #[test]
    fn the_widest_number_has_room() {
        let factors: Vec<u32> = std::iter::repeat_n(u32::MAX, 56).collect();
        let (n, exact) = product(u64::from(u32::MAX) << 31, &factors);
        let (d, _) = product(1 << 31, &factors);
        assert_eq!(big(&n), exact);
        assert_eq!(n.div_half_up(&d), u32::MAX);
    }
}
