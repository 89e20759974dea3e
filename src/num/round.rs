//! Rounding half up, and the small integer tables of the difference calculus.

/// `floor(value / 2^shift + 1/2)`.
///
/// Exact for every `shift` from 0 to 126 and |value| < 2^126: the half is added before the shift and cannot
/// overflow.
pub(crate) const fn shift_half_up(value: i128, shift: u32) -> i128 {
    if shift == 0 { value } else { (value + (1 << (shift - 1))) >> shift }
}

/// `floor(a · b / 2^SHIFT)` modulo 2^64, for a `SHIFT` of 33 to 62 and |b| ≤ 2^62.
#[inline(always)]
pub(crate) const fn product_down<const SHIFT: u32>(a: i64, b: i64) -> i64 {
    if cfg!(target_pointer_width = "32") {
        product_of_halves::<SHIFT>(a, b, 0)
    } else {
        ((a as i128 * b as i128) >> SHIFT) as i64
    }
}

/// `floor(a · b / 2^SHIFT + 1/2)` modulo 2^64, for a `SHIFT` of 33 to 62 and |b| ≤ 2^62.
#[inline(always)]
pub(crate) const fn product_half_up<const SHIFT: u32>(a: i64, b: i64) -> i64 {
    if cfg!(target_pointer_width = "32") {
        product_of_halves::<SHIFT>(a, b, 1 << (SHIFT - 33))
    } else {
        ((a as i128 * b as i128 + (1 << (SHIFT - 1))) >> SHIFT) as i64
    }
}

/// `floor((a · b + c · d) / 2^SHIFT + 1/2)` modulo 2^64, for a `SHIFT` of 33 to 62, |b| and |d| ≤ 2^61.
#[inline(always)]
pub(crate) const fn products_half_up<const SHIFT: u32>([a, c]: [i64; 2], [b, d]: [i64; 2]) -> i64 {
    if cfg!(target_pointer_width = "32") {
        return sum_of_halves::<SHIFT>([a, c], [b, d]);
    }
    ((a as i128 * b as i128 + c as i128 * d as i128 + (1 << (SHIFT - 1))) >> SHIFT) as i64
}

/// `floor((a · b + more · 2^32) / 2^SHIFT)` from products of halves, for targets of 32 bits.
///
/// With signed upper halves a₁, b₁ and unsigned lower ones, a·b = a₁b₁ 2^64 + (a₁b₀ + a₀b₁ + c) 2^32 + r with
/// c = floor(a₀b₀ / 2^32); r is below 2^32 and does not matter. |a₀b₁| ≤ 2^62, so that its sum with c, `more` and what is
/// below the shift in a₁b₀ is in the range of an `i64`.
#[inline(always)]
const fn product_of_halves<const SHIFT: u32>(a: i64, b: i64, more: i64) -> i64 {
    let shift = SHIFT - 32;
    let ([a0, b0], [a1, b1]) = ([a as u32, b as u32], [(a >> 32) as i32, (b >> 32) as i32]);
    let carry = ((a0 as u64 * b0 as u64) >> 32) as i64;
    let first = a1 as i64 * b0 as i64;
    let rest = (first & ((1 << shift) - 1)) + b1 as i64 * a0 as i64 + carry + more;
    (a1 as i64 * b1 as i64).wrapping_shl(32 - shift).wrapping_add(first >> shift).wrapping_add(rest >> shift)
}

/// The same for the sum of two products: what is below 2^32 in both may add up to 2^32.
#[inline(always)]
const fn sum_of_halves<const SHIFT: u32>([a, c]: [i64; 2], [b, d]: [i64; 2]) -> i64 {
    let mask = (1 << (SHIFT - 32)) - 1;
    let [a0, b0, c0, d0] = [a as u32 as u64, b as u32 as u64, c as u32 as u64, d as u32 as u64];
    let (ab, cd) = (a0 * b0, c0 * d0);
    let carry = ((ab >> 32) + (cd >> 32) + (((ab as u32 as u64) + (cd as u32 as u64)) >> 32)) as i64;
    let (first, second) = ((a >> 32) * b0 as i64, (c >> 32) * d0 as i64);
    let rest = (first & mask) + (second & mask) + (b >> 32) * a0 as i64 + (d >> 32) * c0 as i64 + carry;
    let high = ((a >> 32) * (b >> 32)).wrapping_add((c >> 32) * (d >> 32)).wrapping_shl(64 - SHIFT);
    let shift = SHIFT - 32;
    let whole = (first >> shift).wrapping_add(second >> shift).wrapping_add((rest + (1 << (shift - 1))) >> shift);
    high.wrapping_add(whole)
}

/// `floor(a · 2^shift / b)` for 2^60 ≤ b ≤ 2^62 and a < 3b; 0 for the divisor 0.
///
/// Targets of 32 bits, whose division of 128 bits takes some 5000 instructions, go by digits of 13 bits.
#[inline(always)]
pub(crate) const fn long_quotient(a: u64, b: u64, shift: u32) -> u64 {
    if cfg!(target_pointer_width = "32") {
        return quotient_by_digits(a, b, shift);
    }
    match ((a as u128) << shift).checked_div(b as u128) {
        Some(quotient) => quotient as u64,
        None => 0,
    }
}

/// Long division with the divisor's 16 upper bits, rounded up: with 2^46 d > b ≥ 2^46 (d − 1) and d > 2^14 a digit comes out
/// too small by less than 2^13 / 2^14 + 1, so one correction is enough, and the rest before it is below 2^63.
#[inline(always)]
const fn quotient_by_digits(a: u64, b: u64, shift: u32) -> u64 {
    let (mut rest, mut quotient, mut left) = (a, 0_u64, shift);
    // The first digit is 0, 1 or 2.
    while quotient < 2 && rest >= b {
        (rest, quotient) = (rest - b, quotient + 1);
    }
    let divisor = (b >> 46) as u32 + 1;
    while left > 0 {
        let bits = if left < 13 { left } else { 13 };
        let digit = match ((rest >> 30) as u32).checked_div(divisor) {
            Some(digit) => (digit >> (16 - bits)) as u64,
            None => 0,
        };
        (rest, quotient) = ((rest << bits).wrapping_sub(digit.wrapping_mul(b)), (quotient << bits) + digit);
        if rest >= b {
            (rest, quotient) = (rest - b, quotient + 1);
        }
        left -= bits;
    }
    quotient
}

/// `floor(value / divisor + 1/2)`; `None` for a divisor that is not positive.
///
/// Exact for |value| < 2^125, divisor < 2^125: floor((2v + d) / 2d).
pub(crate) const fn div_half_up(value: i128, divisor: i128) -> Option<i128> {
    if divisor <= 0 {
        return None;
    }
    (2 * value + divisor).checked_div_euclid(2 * divisor)
}

/// `ceil(value / divisor)`; `u128::MAX` for the divisor 0.
#[inline(never)]
pub(crate) const fn div_up(value: u128, divisor: u128) -> u128 {
    match (value.checked_div(divisor), value.checked_rem(divisor)) {
        (Some(quotient), Some(rest)) => quotient + (rest > 0) as u128,
        _ => u128::MAX,
    }
}

/// `ceil(value / 2^shift)` for a `shift` below 128.
pub(crate) const fn shift_up(value: u128, shift: u32) -> u128 {
    let whole = value >> shift;
    whole + (whole << shift < value) as u128
}

/// `ceil(sqrt(value))`, exact for every value: a round for each bit of the root.
#[inline(never)]
pub(crate) const fn sqrt_up(value: u128) -> u128 {
    let even = (127 - (value | 1).leading_zeros()) & !1;
    let (mut root, mut rest, mut bit) = (0, value, 1 << even);
    while bit != 0 {
        let next = root + bit;
        root >>= 1;
        if rest >= next {
            rest -= next;
            root += bit;
        }
        bit >>= 2;
    }
    root + (rest > 0) as u128
}

/// Binomial coefficients: `BINOMIAL[n][k]` = C(n, k), n ≤ 16; 0 for k > n.
pub(crate) const BINOMIAL: [[u16; 17]; 17] = {
    let mut table = [[0; 17]; 17];
    let mut n = 0;
    while n < 17 {
        table[n][0] = 1;
        let mut k = 1;
        while k <= n {
            table[n][k] = table[n - 1][k - 1] + table[n - 1][k];
            k += 1;
        }
        n += 1;
    }
    table
};

/// `SURJECTIONS[k][a]` = a! S(k, a) with the Stirling numbers of the second kind S: the a-th forward difference of
/// i^k at i = 0. At most 141 120 (k = 8).
pub(crate) const SURJECTIONS: [[i32; 9]; 9] = {
    let mut table = [[0; 9]; 9];
    table[0][0] = 1;
    let mut k = 1;
    while k < 9 {
        let mut a = 1;
        while a <= k {
            // a! S(k,a) = a (a! S(k-1,a) + (a-1)! S(k-1,a-1) ... ) with the factor a taken out of both terms.
            table[k][a] = a as i32 * (table[k - 1][a] + table[k - 1][a - 1]);
            a += 1;
        }
        k += 1;
    }
    table
};

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn halves_go_up() {
        assert_eq!(shift_half_up(3, 1), 2);
        assert_eq!(shift_half_up(-3, 1), -1);
        assert_eq!(shift_half_up(-5, 2), -1);
        assert_eq!(div_half_up(-5, 2), Some(-2));
        assert_eq!(div_half_up(5, 2), Some(3));
        assert_eq!(div_half_up(1, 0), None);
    }

    /// Both forms against 128-bit products, at the ends of the ranges too.
    #[test]
    fn products_of_halves_are_exact() {
        let ends =
            [i64::MIN, i64::MIN + 1, -1 << 62, -(1 << 32) - 1, -1 << 32, -1, 0, 1, (1 << 32) - 1, 1 << 32, i64::MAX];
        let mut seed = 1_i64;
        let mut next = || {
            seed = seed.wrapping_mul(0x5851_f42d_4c95_7f2d).wrapping_add(0x1405_7b7e_f767_814f);
            seed
        };
        let random: std::vec::Vec<i64> = (0..300).map(|k| next() >> (k % 60)).collect();
        for a in ends.into_iter().chain(random.iter().copied()) {
            for b in ends.into_iter().chain(random.iter().copied()).map(|b| b.clamp(-1 << 62, 1 << 62)) {
                let exact = i128::from(a) * i128::from(b);
                assert_eq!(product_of_halves::<62>(a, b, 0), (exact >> 62) as i64, "{a} {b}");
                assert_eq!(product_of_halves::<48>(a, b, 1 << 15), ((exact + (1 << 47)) >> 48) as i64, "{a} {b}");
                let ([c, d], [b, _]) = ([b ^ 77, a >> 3], [b >> 1, 0]);
                let exact = i128::from(a) * i128::from(b) + i128::from(c) * i128::from(d);
                let rounded = ((exact + (1 << 47)) >> 48) as i64;
                assert_eq!(sum_of_halves::<48>([a, c], [b, d]), rounded, "{a} {b} {c} {d}");
                assert_eq!(products_half_up::<48>([a, c], [b, d]), rounded);
            }
        }
    }

    #[test]
    fn quotients_by_digits_are_exact() {
        let ends = [1_u64 << 60, 1 << 61, (1 << 61) + 1, (3 << 60) - 7, (1 << 62) - 1, 1 << 62];
        for b in ends {
            for a in [0, 1, b - 1, b, b + 1, 2 * b - 1, 2 * b, 3 * b - 1]
                .into_iter()
                .chain(ends.into_iter().filter(|a| *a < 3 * b))
            {
                for shift in [0, 60, 61] {
                    let exact = (u128::from(a) << shift) / u128::from(b);
                    assert_eq!(u128::from(quotient_by_digits(a, b, shift)), exact, "{a} {b} {shift}");
                    assert_eq!(u128::from(long_quotient(a, b, shift)), exact);
                }
            }
        }
        let mut seed = 1_u64;
        let mut next = || {
            seed = seed.wrapping_mul(0x5851_f42d_4c95_7f2d).wrapping_add(0x1405_7b7e_f767_814f);
            (seed >> 4) % (3 << 60) + (1 << 60)
        };
        for _ in 0..100_000 {
            let (a, b) = (next(), next());
            assert_eq!(u128::from(quotient_by_digits(a, b, 61)), (u128::from(a) << 61) / u128::from(b), "{a} {b}");
        }
    }

    #[test]
    fn quotients_and_roots_go_up() {
        assert_eq!([div_up(6, 3), div_up(7, 3), div_up(0, 3), div_up(1, 0)], [2, 3, 0, u128::MAX]);
        assert_eq!([shift_up(8, 2), shift_up(9, 2), shift_up(0, 9), shift_up(5, 0), shift_up(1, 127)], [2, 3, 0, 5, 1]);
        for root in [0, 1, 2, 3, 65_536, (1 << 32) - 1, 1 << 32, (1 << 63) - 1] {
            let square: u128 = root * root;
            assert_eq!(sqrt_up(square), root);
            assert_eq!(sqrt_up(square + 1), root + 1);
            assert_eq!(sqrt_up(square + 2 * root), root + u128::from(root > 0));
        }
        assert_eq!(sqrt_up(u128::MAX), 1 << 64);
    }

    #[test]
    fn surjections_are_differences_of_powers_at_zero() {
        for k in 0..9u32 {
            let mut row: [i64; 9] = core::array::from_fn(|i| (i as i64).pow(k));
            for (a, ours) in SURJECTIONS[k as usize].into_iter().enumerate() {
                assert_eq!(i64::from(ours), row[0], "k={k} a={a}");
                for i in 0..8 - a {
                    row[i] = row[i + 1] - row[i];
                }
            }
        }
    }
}
