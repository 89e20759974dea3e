//! Reciprocals of 16 bits: what pictures divide by, the same bits on cores with and without a divider.

/// Whether the target divides, counts leading zeros and has products of 64 bits in hardware. Of the ARM cores, those
/// that do have atomics: ARMv7-M and later. Others take tables and shorter products, to the same results.
const HAS_DIVIDER: bool = cfg!(any(not(target_arch = "arm"), target_has_atomic = "32"));

/// ⌊2^31/d⌋ for d = 2^15 + 2^8·k + 2^7, rounded to 2^8.
const SEEDS: [u8; 128] = {
    let mut table = [0; 128];
    let mut k = 0;
    while k < 128 {
        let d = (1 << 15) + (k << 8) + (1 << 7);
        table[k as usize] = (((1_u32 << 31) / d + (1 << 7)) >> 8) as u8;
        k += 1;
    }
    table
};

/// The leading zeros of a positive number; of 0, 31 or 32.
#[inline(always)]
pub(crate) const fn leading_zeros(value: u32) -> u32 {
    if HAS_DIVIDER { value.leading_zeros() } else { zeros_by_steps(value) }
}

/// The leading zeros of a byte.
const ZEROS: [u8; 256] = {
    let mut table = [8; 256];
    let mut k = 1;
    while k < 256 {
        table[k] = (k as u8).leading_zeros() as u8;
        k += 1;
    }
    table
};

const fn zeros_by_steps(value: u32) -> u32 {
    if value < 1 << 16 { zeros_of_half(value) } else { zeros_of_half(value >> 16) - 16 }
}

/// The leading zeros of a number below 2^16.
#[inline(always)]
const fn zeros_of_half(value: u32) -> u32 {
    if value < 1 << 8 {
        24 + ZEROS[value as usize & 255] as u32
    } else {
        16 + ZEROS[(value >> 8) as usize & 255] as u32
    }
}

/// ⌊2^31/d⌋ for d of 16 bits, the first of them set; at most 2^16 − 1.
#[inline(always)]
const fn invert(d: u32) -> u32 {
    if HAS_DIVIDER {
        let quotient = match (1_u32 << 31).checked_div(d) {
            Some(quotient) => quotient,
            None => 0,
        };
        if quotient < 1 << 16 { quotient } else { (1 << 16) - 1 }
    } else {
        invert_by_table(d)
    }
}

const fn invert_by_table(d: u32) -> u32 {
    let quotient = floor_by_table(d);
    if quotient < 1 << 16 { quotient } else { (1 << 16) - 1 }
}

const fn floor_by_table(d: u32) -> u32 {
    // Within 2^-8 of itself; a step of Newton's method leaves it at most 2 too small.
    let seed = SEEDS[(d >> 8) as usize & 127] as u32;
    let error = (1_u32 << 31).wrapping_sub((seed << 8).wrapping_mul(d)) as i32;
    let quotient = (seed << 8).wrapping_add(((error >> 8).wrapping_mul(seed as i32) >> 15) as u32);
    let rest = (1_u32 << 31).wrapping_sub(quotient.wrapping_mul(d)) as i32;
    // What is still missing, by signs: it takes no branch.
    let (once, twice) = ((d as i32 - 1).wrapping_sub(rest) >> 31, (2 * d as i32 - 1).wrapping_sub(rest) >> 31);
    quotient.wrapping_sub((once + twice) as u32)
}

/// 2^31 over the 16 leading bits of a positive number, rounded down, at most 2^16 − 1; and the number's leading zeros.
#[inline(always)]
pub(crate) const fn reciprocal(value: u32) -> (u32, u32) {
    let zeros = leading_zeros(value);
    (invert(value << (zeros & 31) >> 16), zeros)
}

/// 2^31 over a positive number below 2^16 shifted left until its 16th bit is set, rounded down, at most 2^16; and the
/// number's leading zeros.
#[inline(always)]
pub(crate) const fn exact_reciprocal(value: u32) -> (u32, u32) {
    let zeros = if HAS_DIVIDER { value.leading_zeros() } else { zeros_of_half(value) };
    let d = value << (zeros & 31) >> 16;
    // The bit is set but for 0, which has no reciprocal: so the compiler sees that nothing is divided by it.
    let quotient = if HAS_DIVIDER { (1_u32 << 31) / (d | 1 << 15) } else { floor_by_table(d) };
    (quotient, zeros)
}

/// ⌊a·b/2^8⌋ modulo 2^32, for b of less than 2^23.
#[inline(always)]
pub(crate) const fn times_256th(a: i32, b: i32) -> i32 {
    if HAS_DIVIDER { ((a as i64 * b as i64) >> 8) as i32 } else { times_256th_in_parts(a, b) }
}

const fn times_256th_in_parts(a: i32, b: i32) -> i32 {
    (a >> 8).wrapping_mul(b).wrapping_add((a & 255).wrapping_mul(b) >> 8)
}

/// The upper half of a product, rounded down.
#[inline(always)]
pub(crate) fn high(a: i32, b: i32) -> i32 {
    if HAS_DIVIDER { ((i64::from(a) * i64::from(b)) >> 32) as i32 } else { high_in_halves(a, b) }
}

/// A cubic c0 + c1·t + c2·t² + c3·t³, given as c0, 2·c1, 4·c2, 8·c3, at a parameter in 2^-31: rounded down three times.
#[inline(always)]
pub(crate) fn cubic_at(c: &[i32; 4], t: i32) -> i32 {
    if HAS_DIVIDER { At::new(t).cubic(c) } else { cubic_in_halves(c, t) }
}

#[inline(never)]
fn cubic_in_halves(c: &[i32; 4], t: i32) -> i32 {
    At { whole: t, halves: split(t) }.cubic_in_halves(c)
}

/// A parameter in 2^-31 for many cubics.
#[derive(Clone, Copy)]
pub(crate) struct At {
    whole: i32,
    /// Where products are made of those of halves.
    halves: [i32; 2],
}

impl At {
    #[inline(always)]
    pub(crate) fn new(t: i32) -> Self {
        Self { whole: t, halves: if HAS_DIVIDER { [0; 2] } else { split(t) } }
    }

    /// [`cubic_at`].
    #[inline(always)]
    pub(crate) fn cubic(self, c: &[i32; 4]) -> i32 {
        if !HAS_DIVIDER {
            return self.cubic_in_halves(c);
        }
        let t = self.whole;
        c[0].wrapping_add(high(c[1].wrapping_add(high(c[2].wrapping_add(high(c[3], t)), t)), t))
    }

    #[inline(always)]
    fn cubic_in_halves(self, [a, b, c, d]: &[i32; 4]) -> i32 {
        let value = c.wrapping_add(halves(*d, self.halves));
        let value = b.wrapping_add(halves(value, self.halves));
        a.wrapping_add(halves(value, self.halves))
    }
}

#[inline(never)]
fn high_in_halves(a: i32, b: i32) -> i32 {
    halves(a, split(b))
}

/// A number as h·2^16 + l, where l has a sign, too.
#[inline(always)]
fn split(a: i32) -> [i32; 2] {
    // Rounded: the upper half of 2^31 − 1 is 2^15.
    [((a >> 15) + 1) >> 1, i32::from(a as i16)]
}

/// The upper half of a product, of four products of half as many bits. With signs in the lower halves the sum of those in
/// the middle fits: of an upper half of ±2^15 the lower one has the other sign, or is 0.
#[inline(always)]
fn halves(a: i32, [b1, b0]: [i32; 2]) -> i32 {
    let [a1, a0] = split(a);
    let middle = (a1 * b0).wrapping_add((a0 * b0) >> 16).wrapping_add(a0 * b1);
    (a1 * b1).wrapping_add(middle >> 16)
}

/// ⌊a·b/2^17⌋ for b below 2^16.
#[inline(always)]
pub(crate) const fn multiply(a: i32, b: u32) -> i32 {
    if HAS_DIVIDER { ((a as i64 * (b << 15) as i64) >> 32) as i32 } else { multiply_in_halves(a, b) }
}

const fn multiply_in_halves(a: i32, b: u32) -> i32 {
    let low = (a as u32 & 0xffff).wrapping_mul(b) >> 16;
    (a >> 16).wrapping_mul(b as i32).wrapping_add(low as i32) >> 1
}

/// 2^15 over the square roots of (k + 1/2)/256, k from 64 on, rounded.
const ROOT_SEEDS: [u16; 192] = {
    let mut table = [0; 192];
    let mut k = 0;
    while k < 192 {
        let square = 2 * (k + 64) as u64 + 1;
        // 2^30·512/(2k + 1), rounded to the nearest when its root is taken.
        table[k as usize] = (4 * (1_u64 << 39) / square).isqrt().div_ceil(2) as u16;
        k += 1;
    }
    table
};

/// The reciprocal square root of a positive number, 2^(15 + h)/√v within 2^-14 of itself, and h: a number of 16 bits or
/// 2^16.
#[inline(always)]
pub(crate) fn reciprocal_root(value: u32) -> (u32, u32) {
    // Even, so that a root of the shift remains.
    let zeros = leading_zeros(value) & 30;
    let v = value << zeros;
    let seed = ROOT_SEEDS.get(((v >> 24) as usize).wrapping_sub(64)).map_or(1 << 15, |seed| u32::from(*seed));
    // A step of Newton's method: y·(3 − v·y²)/2, in 2^-15, with v/2^32 in 16 bits.
    let square = ((v >> 16) * ((seed * seed) >> 15)) >> 16;
    let root = (seed * ((3 * (1 << 15) - square) >> 1)) >> 15;
    (root, 16 - zeros / 2)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn without_a_divider_it_is_the_same() {
        for d in 1 << 15..1_u32 << 16 {
            assert_eq!(invert_by_table(d), ((1_u32 << 31) / d).min(65_535), "{d}");
            assert_eq!(invert(d), invert_by_table(d), "{d}");
        }
        for bit in 0..32 {
            for value in [1_u32 << bit, (1_u32 << bit) + (1 << bit >> 1), (1_u32 << bit) | ((1 << bit) - 1)] {
                assert_eq!(zeros_by_steps(value), value.leading_zeros(), "{value}");
                assert_eq!(reciprocal(value).1, value.leading_zeros());
            }
        }
    }

    #[test]
    fn roots_are_close() {
        for value in (1..200_000_u32).chain((0..50_000).map(|k| u32::MAX - k * 85_000)) {
            let (root, half) = reciprocal_root(value);
            // root·√v/2^(15 + half) is 1: of its square, in 2^-32, within 2^-13.
            let square = (4 * u128::from(root).pow(2) * u128::from(value)) >> (2 * half);
            assert!(square.abs_diff(1 << 32) < 1 << 19, "{value}: {root} {half} {square}");
        }
    }

    #[test]
    fn products_in_halves_are_the_same() {
        let mut state = 1_u32;
        let mut next = || {
            state = state.wrapping_mul(0x915f_77f5).wrapping_add(12_345);
            state ^ state >> 15
        };
        for k in 0..100_000 {
            let (a, b) = (next(), next());
            let (a, b) = match k % 7 {
                0 => (a | 0x7fff_ffff, b | 0xffff),
                1 => ([i32::MIN, i32::MIN + 0x8000, i32::MAX - 0x8000, i32::MAX, 0x7fff][k % 5] as u32, b),
                _ => (a, b),
            };
            let b = if k % 9 == 0 { b & 0xffff_0000 | 0x8000 } else { b };
            let (p, q) = (a as i32, b as i32);
            assert_eq!(i64::from(high(p, q)), (i64::from(p) * i64::from(q)) >> 32);
            assert_eq!(high_in_halves(p, q), high(p, q));
            assert_eq!(times_256th_in_parts(p, q >> 9), times_256th(p, q >> 9));
            assert_eq!(high_in_halves(q, p), high(p, q));
            let cubic = [next() as i32, next() as i32, p, next() as i32];
            assert_eq!(cubic_in_halves(&cubic, q), cubic_at(&cubic, q));
            assert_eq!(multiply_in_halves(a as i32, b & 0xffff), multiply(a as i32, b & 0xffff));
            assert_eq!(i64::from(multiply(a as i32, b & 0xffff)), (i64::from(a as i32) * i64::from(b & 0xffff)) >> 17);
        }
    }
}
