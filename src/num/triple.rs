//! Vectors of 64-bit integers, with sums of products in 128 bits that are rounded once.
//!
//! Components stay below 2^61 in magnitude, so that differences of two and their products cannot overflow. Sums
//! saturate, and what saturated does not fit 64 bits when it is narrowed: the caller hears of it.

use super::shift_half_up;

/// A vector; what a unit of its components is worth is the caller's matter.
pub(crate) type Triple = [i64; 3];

/// Fraction bits of a unit vector.
pub(crate) const UNIT: u32 = 60;

/// The magnitude that no narrowed component reaches.
const LIMIT: u64 = 1 << 61;

/// A sum of vectors times factors.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Sum3(pub(crate) [i128; 3]);

impl Sum3 {
    /// Adds `factor` times the vector.
    #[inline(never)]
    pub(crate) fn add(&mut self, vector: &Triple, factor: i64) {
        for (sum, c) in self.0.iter_mut().zip(vector) {
            *sum = sum.saturating_add(i128::from(factor) * i128::from(*c));
        }
    }

    /// The sum with the vector times the factor added.
    #[must_use]
    pub(crate) fn plus(mut self, vector: &Triple, factor: i64) -> Self {
        self.add(vector, factor);
        self
    }

    /// The sum over 2^`shift`, half up; `None` where a component reaches 2^61.
    pub(crate) fn narrow(&self, shift: u32) -> Option<Triple> {
        narrow(self.0.map(|c| shift_half_up(saturated(c), shift)))
    }

    /// The sum over a positive divisor, half up; `None` where a component reaches 2^61.
    pub(crate) fn divide(&self, divisor: i64) -> Option<Triple> {
        let [x, y, z] = self.0.map(|c| div_half_up(saturated(c), divisor.into()));
        narrow([x?, y?, z?])
    }
}

/// `floor(value / divisor + 1/2)` by one division, exact for |value| < 2^126; `None` for a divisor that is not positive.
#[inline(never)]
fn div_half_up(value: i128, divisor: i128) -> Option<i128> {
    if divisor <= 0 {
        return None;
    }
    let quotient = value.checked_div(divisor)?;
    let twice = 2 * (value - quotient * divisor);
    Some(quotient + i128::from(twice >= divisor) - i128::from(twice < -divisor))
}

/// Within what may be shifted and divided with rounding.
fn saturated(c: i128) -> i128 {
    c.clamp(-(1 << 124), 1 << 124)
}

/// The components in 64 bits; `None` where one reaches 2^61.
pub(crate) fn narrow([x, y, z]: [i128; 3]) -> Option<Triple> {
    let component = |c: i128| i64::try_from(c).ok().filter(|c| c.unsigned_abs() < LIMIT);
    Some([component(x)?, component(y)?, component(z)?])
}

/// a − b.
pub(crate) fn minus(a: &Triple, b: &Triple) -> Triple {
    [a[0].wrapping_sub(b[0]), a[1].wrapping_sub(b[1]), a[2].wrapping_sub(b[2])]
}

/// a + b.
pub(crate) fn plus(a: &Triple, b: &Triple) -> Triple {
    [a[0].wrapping_add(b[0]), a[1].wrapping_add(b[1]), a[2].wrapping_add(b[2])]
}

/// a · b.
#[inline(never)]
pub(crate) fn dot(a: &Triple, b: &Triple) -> i128 {
    a.iter().zip(b).fold(0_i128, |sum, (a, b)| sum.saturating_add(i128::from(*a) * i128::from(*b)))
}

/// a × b.
#[inline(never)]
pub(crate) fn cross(a: &Triple, b: &Triple) -> [i128; 3] {
    let product = |p: i64, q: i64| i128::from(p) * i128::from(q);
    [
        product(a[1], b[2]).saturating_sub(product(a[2], b[1])),
        product(a[2], b[0]).saturating_sub(product(a[0], b[2])),
        product(a[0], b[1]).saturating_sub(product(a[1], b[0])),
    ]
}

/// The length, rounded down.
pub(crate) fn length(v: &Triple) -> u64 {
    root(dot(v, v).unsigned_abs())
}

/// ⌊√value⌋ for a value below 2^127. A root of 64 bits where the value has no more.
#[inline(never)]
pub(crate) fn root(value: u128) -> u64 {
    match u64::try_from(value) {
        Ok(short) => short.isqrt(),
        Err(_) => value.isqrt() as u64,
    }
}

/// The number of bits of a magnitude.
pub(crate) fn bits(value: u128) -> u32 {
    128 - value.leading_zeros()
}

/// A direction of wide components with the largest one of 61 bits, by a shift; zero stays zero.
#[inline(never)]
pub(crate) fn shortened(v: [i128; 3]) -> Triple {
    let widest = bits(v.iter().fold(0, |all, c| all | c.unsigned_abs()));
    if widest > 61 { v.map(|c| (c >> (widest - 61)) as i64) } else { v.map(|c| (c << (61 - widest)) as i64) }
}

/// The unit vector of a direction, in 2^-60, within 2^-58; `None` for zero.
#[inline(never)]
pub(crate) fn unit(v: [i128; 3]) -> Option<Triple> {
    let v = shortened(v);
    let length = i128::from(length(&v));
    let [x, y, z] = v.map(|c| div_half_up(i128::from(c) << UNIT, length).map(|c| c as i64));
    Some([x?, y?, z?])
}

/// numerator/denominator in 2^-`fraction`, half up, within 2^-60 of itself besides; `None` for a denominator that is not
/// positive or a quotient of more than 2^(62 − `fraction`). `fraction` is at most 60.
#[inline(never)]
pub(crate) fn ratio(numerator: i128, denominator: i128, fraction: u32) -> Option<i64> {
    let excess = bits(denominator.unsigned_abs()).saturating_sub(62);
    let (numerator, denominator) = (numerator >> excess, denominator >> excess);
    if bits(numerator.unsigned_abs()) + fraction > 124 {
        return None;
    }
    let quotient = div_half_up(numerator << fraction, denominator)?;
    i64::try_from(quotient).ok().filter(|q| q.unsigned_abs() <= 1 << 62)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_are_rounded_once_and_tell_of_overflow() {
        let v = [3, -3, 1 << 60];
        assert_eq!(Sum3::default().plus(&v, 1).narrow(1), Some([2, -1, 1 << 59]));
        assert_eq!(Sum3::default().plus(&v, 2).divide(4), Some([2, -1, 1 << 59]));
        assert_eq!(Sum3::default().plus(&v, 2).narrow(0), None);
        let huge = (0..9).fold(Sum3::default(), |sum, _| sum.plus(&[i64::MAX; 3], i64::MAX));
        assert_eq!(huge.narrow(48), None);
        assert_eq!(huge.divide(0), None);
        for value in -40_i128..40 {
            for divisor in 1..9 {
                assert_eq!(div_half_up(value, divisor), crate::num::div_half_up(value, divisor), "{value} / {divisor}");
            }
        }
    }

    #[test]
    fn units_are_one_long() {
        for v in [[1, 0, 0], [0, -5, 12], [1 << 100, 1 << 101, -(1 << 102)], [7, 1 << 60, 3], [i128::MAX; 3]] {
            let u = unit(v).unwrap();
            let square = dot(&u, &u);
            assert!((square - (1 << 120)).unsigned_abs() < 1 << 63, "{v:?}: {u:?}");
        }
        assert_eq!(unit([0, -5, 0]), Some([0, -(1 << 60), 0]));
        assert_eq!(unit([0; 3]), None);
    }

    #[test]
    fn ratios_are_within_their_bound() {
        assert_eq!(ratio(1, 3, 2), Some(1));
        assert_eq!(ratio(-1, 2, 0), Some(0));
        assert_eq!(ratio(1 << 100, 1 << 100, 48), Some(1 << 48));
        assert_eq!(ratio(1 << 100, 1 << 80, 48), None);
        assert_eq!(ratio(5, 0, 48), None);
        assert_eq!(ratio(5, -1, 48), None);
        let (n, d) = (123_456_789_012_345_678_i128 << 40, 987_654_321_098_765_432_i128 << 42);
        let exact = ((n >> 20) << 48) / (d >> 20);
        assert!((i128::from(ratio(n, d, 48).unwrap()) - exact).abs() <= 1);
    }
}
