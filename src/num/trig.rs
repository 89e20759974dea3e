//! Angles, sine and cosine by CORDIC.

use super::{I16F16, I32F32};

/// An angle as a binary fraction of a turn: 2^32 steps make a full turn, so adding angles wraps as turning does.
///
/// ```
/// use embedded_surfaces::num::{Angle, I32F32};
/// let (sin, cos) = (Angle::from_degrees(-60) + Angle::from_degrees(90)).sin_cos();
/// assert!((sin - I32F32::from_bits(1 << 31)).abs() <= I32F32::from_bits(4)); // sin 30° = 1/2 within 2^-30
/// assert!(cos > sin);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Angle(u32);

/// atan(2^-i) in 2^-64 turns, rounded; i = 0 ..= 40.
const ARCTANGENTS: [i64; 41] = [
    0x2000_0000_0000_0000,
    0x12e4_051d_9df3_0866,
    0x09fb_385b_5ee3_9e8e,
    0x0511_11d4_1ddd_9a1b,
    0x028b_0d43_0e58_9aed,
    0x0145_d7e1_5904_6278,
    0x00a2_f61e_5c28_262a,
    0x0051_7c55_11d4_42af,
    0x0028_be53_46d0_c337,
    0x0014_5f2e_bb30_ab38,
    0x000a_2f98_0091_ba7b,
    0x0005_17cc_14a8_0cb7,
    0x0002_8be6_0cdf_ec62,
    0x0001_45f3_06c1_72f2,
    0x0000_a2f9_836a_e911,
    0x0000_517c_c1b6_ba7c,
    0x0000_28be_60db_85fc,
    0x0000_145f_306d_c816,
    0x0000_0a2f_9836_e4ae,
    0x0000_0517_cc1b_726b,
    0x0000_028b_e60d_b938,
    0x0000_0145_f306_dc9c,
    0x0000_00a2_f983_6e4e,
    0x0000_0051_7cc1_b727,
    0x0000_0028_be60_db94,
    0x0000_0014_5f30_6dca,
    0x0000_000a_2f98_36e5,
    0x0000_0005_17cc_1b72,
    0x0000_0002_8be6_0db9,
    0x0000_0001_45f3_06dd,
    0x0000_0000_a2f9_836e,
    0x0000_0000_517c_c1b7,
    0x0000_0000_28be_60dc,
    0x0000_0000_145f_306e,
    0x0000_0000_0a2f_9837,
    0x0000_0000_0517_cc1b,
    0x0000_0000_028b_e60e,
    0x0000_0000_0145_f307,
    0x0000_0000_00a2_f983,
    0x0000_0000_0051_7cc2,
    0x0000_0000_0028_be61,
];

/// The CORDIC gain's inverse, prod 1/sqrt(1 + 2^-2i) for i = 0 ..= 40, in units of 2^-60.
const INVERSE_GAIN: i64 = 0x09b74eda8435e5a6;

impl Angle {
    /// No turn.
    pub const ZERO: Self = Self(0);

    /// The angle of whole degrees, rounded to 2^-32 turns; any number of turns.
    #[must_use]
    pub const fn from_degrees(degrees: i32) -> Self {
        Self::from_degree_bits((degrees as i64) << 16)
    }

    /// The angle of fractional degrees, rounded half up to 2^-32 turns.
    #[must_use]
    pub const fn from_degrees_fixed(degrees: I16F16) -> Self {
        Self::from_degree_bits(degrees.to_bits() as i64)
    }

    /// Degrees in 2^-16: times 2^32 / (360 * 2^16) = 2^13 / 45, half up. |degrees| < 2^31 keeps it in 63 bits.
    const fn from_degree_bits(bits: i64) -> Self {
        Self((2 * (bits % (360 << 16)) * 8192 + 45).div_euclid(90) as u32)
    }

    /// The angle of `steps` / 2^32 turns.
    #[must_use]
    pub const fn from_binary(steps: u32) -> Self {
        Self(steps)
    }

    /// The angle in steps of 2^-32 turns.
    #[must_use]
    pub const fn to_binary(self) -> u32 {
        self.0
    }

    /// Sine and cosine, each within 2^-32 of the true value of this angle; exact at multiples of a quarter turn.
    ///
    /// An angle made from degrees is itself within 2^-33 turns, so views by angle are within 2^-30. Cost: 41 rounds
    /// of two shifts and three 64-bit additions.
    #[must_use]
    pub const fn sin_cos(self) -> (I32F32, I32F32) {
        let quadrant = self.0 >> 30;
        let rest = self.0 & 0x3fff_ffff;
        let (sin, cos) = if rest == 0 { (0, 1 << 32) } else { cordic((rest as i64) << 32) };
        let (sin, cos) = match quadrant {
            0 => (sin, cos),
            1 => (cos, -sin),
            2 => (-sin, -cos),
            _ => (-cos, sin),
        };
        (I32F32::from_bits(sin), I32F32::from_bits(cos))
    }
}

/// Sine and cosine in 2^-32 of an angle in the first quadrant, given in 2^-64 turns.
///
/// After round i the remaining angle is at most atan(2^-i); at 40 it is below 2^-40 rad. Each round truncates two
/// products by at most 2^-60, so the sum of all errors before the final rounding (2^-33) is below 2^-39.
const fn cordic(angle: i64) -> (i64, i64) {
    let (mut x, mut y, mut left) = (INVERSE_GAIN, 0_i64, angle);
    let mut i = 0;
    while i < ARCTANGENTS.len() {
        let (dx, dy) = (y >> i, x >> i);
        if left >= 0 {
            (x, y) = (x - dx, y + dy);
            left -= ARCTANGENTS[i];
        } else {
            (x, y) = (x + dx, y - dy);
            left += ARCTANGENTS[i];
        }
        i += 1;
    }
    let half = 1 << 27;
    ((y + half) >> 28, (x + half) >> 28)
}

/// The direction of (x, y) in 2^-64 turns, counter-clockwise from the x axis, within 2^-39 rad; 0 for the origin.
///
/// CORDIC in vectoring mode: round i turns the vector by atan(2^-i) towards the x axis; 41 rounds leave at most
/// atan(2^-40), and truncation adds 41·2^-59 of the length.
pub(crate) fn arctangent(y: i64, x: i64) -> u64 {
    let widest = x.unsigned_abs() | y.unsigned_abs();
    if widest == 0 {
        return 0;
    }
    // The gain is 1.65, the length up to 1.42 of the largest component: 2^60 leaves room for both.
    let (zeros, half_turn) = (widest.leading_zeros(), 1_u64 << 63);
    let scaled = |c: i64| if zeros < 4 { c >> (4 - zeros) } else { c << (zeros - 4) };
    let (mut x, mut y) = (scaled(x), scaled(y));
    let mut turn = 0_u64;
    if x < 0 {
        (x, y, turn) = (-x, -y, half_turn);
    }
    for (i, arctangent) in ARCTANGENTS.iter().enumerate() {
        let (dx, dy) = (y >> i, x >> i);
        if y >= 0 {
            (x, y) = (x + dx, y - dy);
            turn = turn.wrapping_add(*arctangent as u64);
        } else {
            (x, y) = (x - dx, y + dy);
            turn = turn.wrapping_sub(*arctangent as u64);
        }
    }
    turn
}

impl core::ops::Add for Angle {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self(self.0.wrapping_add(other.0))
    }
}

impl core::ops::Neg for Angle {
    type Output = Self;
    fn neg(self) -> Self {
        Self(self.0.wrapping_neg())
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::disallowed_types, clippy::float_arithmetic)]
    use super::*;

    #[test]
    fn quarter_turns_are_exact() {
        let one = I32F32::from_num(1);
        let zero = I32F32::ZERO;
        let quarters = [(zero, one), (one, zero), (zero, -one), (-one, zero)];
        for (k, expected) in quarters.iter().enumerate() {
            assert_eq!(Angle::from_degrees(90 * k as i32).sin_cos(), *expected);
            assert_eq!(Angle::from_degrees(90 * k as i32 - 360_000).sin_cos(), *expected);
        }
    }

    #[test]
    fn within_two_to_the_minus_32_of_the_true_sine() {
        let mut worst = 0.0_f64;
        let mut check = |steps: u32| {
            let (sin, cos) = Angle::from_binary(steps).sin_cos();
            let turn = f64::from(steps) / 4_294_967_296.0;
            let radians = turn * core::f64::consts::TAU;
            for (ours, true_value) in [(sin, radians.sin()), (cos, radians.cos())] {
                worst = worst.max((ours.to_bits() as f64 / 4_294_967_296.0 - true_value).abs());
            }
        };
        (0..1 << 20).for_each(|i: u32| check(i.wrapping_mul(0x9e37_79b9)));
        [1, 2, 3, u32::MAX, 0x3fff_ffff, 0x4000_0001, 0x7fff_ffff].into_iter().for_each(check);
        assert!(worst <= 2.0_f64.powi(-32), "worst error {worst:e}");
        assert!(worst >= 2.0_f64.powi(-34), "a rounded result cannot be that good: {worst:e}");
    }

    #[test]
    fn directions_are_within_two_to_the_minus_39() {
        let mut worst = 0.0_f64;
        for k in 0..200_000_u64 {
            let word = (k + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
            let (x, y) = ((word as i64) >> (k % 50), (word.rotate_left(29) as i64) >> (k % 31));
            let turn = arctangent(y, x) as f64 / 18_446_744_073_709_551_616.0;
            let exact = (y as f64).atan2(x as f64) / core::f64::consts::TAU;
            let error = (turn - exact).rem_euclid(1.0);
            worst = worst.max(error.min(1.0 - error) * core::f64::consts::TAU);
        }
        assert!(worst <= 2.0_f64.powi(-39), "{worst:e}");
        assert_eq!(arctangent(0, 0), 0);
        let quarter = |y, x| (arctangent(y, x).wrapping_add(1 << 40) >> 62) as u8;
        assert_eq!([quarter(0, 5), quarter(5, 0), quarter(0, i64::MIN), quarter(i64::MIN, 0)], [0, 1, 2, 3]);
    }

    #[test]
    fn degrees_round_to_the_nearest_step() {
        assert_eq!(Angle::from_degrees(360), Angle::ZERO);
        assert_eq!(Angle::from_degrees(180).to_binary(), 1 << 31);
        assert_eq!(Angle::from_degrees(-90).to_binary(), 3 << 30);
        assert_eq!(Angle::from_degrees(1).to_binary(), 11_930_465); // 2^32/360 = 11930464.71
        assert_eq!(Angle::from_degrees_fixed(I16F16::from_bits(1)).to_binary(), 182); // 182.04
        let _ = (Angle::from_degrees(i32::MIN), Angle::from_degrees(i32::MAX));
    }
}
