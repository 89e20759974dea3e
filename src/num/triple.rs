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
    let magnitude = match u64::try_from(divisor) {
        Ok(short) => divide(value.unsigned_abs(), short) as i128,
        Err(_) => value.checked_abs()?.checked_div(divisor)?,
    };
    let quotient = if value < 0 { -magnitude } else { magnitude };
    let twice = 2 * (value - quotient * divisor);
    Some(quotient + i128::from(twice >= divisor) - i128::from(twice < -divisor))
}

/// ⌊value / divisor⌋, 0 for a divisor of 0: two digits of 32 bits a word of the value, which takes a core without a divider
/// of 64 bits an eighth of the instructions of the general quotient (Knuth, The Art of Computer Programming 2, 4.3.1, D).
#[inline(never)]
fn divide(value: u128, divisor: u64) -> u128 {
    let (high, low) = ((value >> 64) as u64, value as u64);
    let (Some(first), Some(rest)) = (high.checked_div(divisor), high.checked_rem(divisor)) else { return 0 };
    // The rest is below the divisor, so what follows is one word.
    let zeros = divisor.leading_zeros();
    let divisor = divisor << zeros;
    let value = (u128::from(rest) << 64 | u128::from(low)) << zeros;
    let (high, low) = ((value >> 64) as u64, value as u64);
    let (upper, rest) = digit(high, (low >> 32) as u32, divisor);
    let (lower, _) = digit(rest, low as u32, divisor);
    u128::from(first) << 64 | u128::from(upper) << 32 | u128::from(lower)
}

/// ⌊(high·2^32 + next)/divisor⌋ and the rest, for a divisor with its first bit set and high below it.
#[inline(always)]
fn digit(high: u64, next: u32, divisor: u64) -> (u32, u64) {
    let (upper, lower) = (divisor >> 32, divisor & 0xffff_ffff);
    let mut quotient = high.checked_div(upper).unwrap_or(0);
    let mut rest = high.wrapping_sub(quotient.wrapping_mul(upper));
    // Too large by two at most.
    while quotient >> 32 != 0 || quotient.wrapping_mul(lower) > (rest << 32 | u64::from(next)) {
        quotient -= 1;
        rest = rest.wrapping_add(upper);
        if rest >> 32 != 0 {
            break;
        }
    }
    let value = high << 32 | u64::from(next);
    (quotient as u32, value.wrapping_sub(quotient.wrapping_mul(divisor)))
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
    if let Ok(short) = u64::try_from(value) {
        return short.isqrt();
    }
    // The root of the first 63 or 64 bits is within 2^-31 of itself; a step of Newton's method leaves an error of 1 or 2,
    // never below.
    let half = bits(value).saturating_sub(63) / 2;
    let root = ((value >> (2 * half)) as u64).isqrt() << half;
    let mut root = ((u128::from(root) + divide(value, root)) / 2).min(u64::MAX.into()) as u64;
    while u128::from(root) * u128::from(root) > value {
        root -= 1;
    }
    root
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
    fn quotients_and_roots_are_those_of_the_machine() {
        let mut state = 1_u128;
        for k in 0..200_000_u32 {
            state = state.wrapping_mul(0x2360_ed05_1fc6_5da4_4385_df64_9fcc_f645).wrapping_add(12_345);
            let value = (state ^ state >> 61) >> (k % 127 + 1);
            let divisor = ((state >> 64) as u64 ^ state as u64) >> (k % 63);
            let divisors = [divisor | 1, divisor | u64::MAX << 32 | 0xffff_ffff, 1 << (k % 64), (1 << (k % 64)) | 1];
            for divisor in divisors {
                assert_eq!(divide(value, divisor), value / u128::from(divisor), "{value} / {divisor}");
            }
            assert_eq!(u128::from(root(value)), value.isqrt(), "{value}");
            let square = u128::from(divisor >> 1).pow(2);
            assert_eq!([root(square), root(square + 1)], [divisor >> 1, (square + 1).isqrt() as u64]);
            if square > 0 {
                assert_eq!(u128::from(root(square - 1)), (square - 1).isqrt());
            }
        }
        assert_eq!(root(u128::MAX >> 1), (u128::MAX >> 1).isqrt() as u64);
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
