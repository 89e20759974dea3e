//! Fixed-point numbers as other formats have them: binary32 and decimals, without floating point.

use core::fmt::Write;

/// The bits of the binary32 nearest to `value` / 2^fraction, ties to even.
///
/// For a fraction of at most 126 bits, so that nothing is subnormal.
pub(crate) const fn binary32(value: i64, fraction: u32) -> u32 {
    let magnitude = value.unsigned_abs();
    if magnitude == 0 {
        return 0;
    }
    let length = u64::BITS - magnitude.leading_zeros();
    let excess = length.saturating_sub(24);
    let mut mantissa = (magnitude >> excess) << (24 + excess - length);
    let rest = magnitude & ((1 << excess) - 1);
    if excess > 0 {
        let half = 1 << (excess - 1);
        mantissa += (rest > half || rest == half && mantissa & 1 == 1) as u64;
    }
    // A mantissa rounded up to 2^24 carries into the exponent by itself.
    let exponent = 126 + length - fraction;
    (((value < 0) as u32) << 31) | (((exponent as u64) << 23) + (mantissa - (1 << 23))) as u32
}

/// 5^16: a fraction of 16 bits times this is the same in 10^-16.
const FIVE_16: u64 = 152_587_890_625;

/// A number in units of 2^-16, written as an exact decimal without trailing zeros.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Decimal(pub(crate) i64);

impl core::fmt::Display for Decimal {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        let magnitude = self.0.unsigned_abs();
        let sign = if self.0 < 0 { "-" } else { "" };
        write!(f, "{sign}{}", magnitude >> 16)?;
        let mut rest = (magnitude & 0xffff) * FIVE_16;
        let mut unit = 1_000_000_000_000_000;
        if rest > 0 {
            f.write_char('.')?;
        }
        while rest > 0 {
            // 0 ..= 9: the rest is below ten units.
            let digit = rest.checked_div(unit).unwrap_or(0);
            f.write_char(char::from(b'0' + digit as u8))?;
            rest -= digit * unit;
            unit /= 10;
        }
        Ok(())
    }
}

#[cfg(test)]
#[allow(clippy::disallowed_types, clippy::float_arithmetic, reason = "the machine's own rounding is the oracle")]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::string::ToString;

    #[test]
    fn decimals_are_exact_and_short() {
        assert_eq!(Decimal(0).to_string(), "0");
        assert_eq!(Decimal(-3 << 15).to_string(), "-1.5");
        assert_eq!(Decimal(1).to_string(), "0.0000152587890625");
        assert_eq!(Decimal(i32::MIN.into()).to_string(), "-32768");
    }

    proptest! {
        #[test]
        fn numbers_are_those_of_the_machine(value: i64, shift in 0_u32..64, fraction in 0_u32..=62) {
            let value = value >> shift;
            // Both conversions round once, and the division is exact.
            let expected = value as f32 / (1_u64 << fraction) as f32;
            prop_assert_eq!(binary32(value, fraction), expected.to_bits());
            let value = i64::from(value as i32);
            prop_assert_eq!(Decimal(value).to_string().parse::<f64>(), Ok(value as f64 / 65536.0));
        }
    }
}
