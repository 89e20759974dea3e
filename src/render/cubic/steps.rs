//! Steps of a lattice along one of its directions: parameters, and what turns the cubic of a row into differences.

use super::RowCubic;
use super::run::Line;
use crate::num::high;

/// Parameters i/n or (i + 1/2)/n in 2^-31.
#[derive(Clone, Copy, Debug)]
pub(super) struct Parameters {
    pub(super) steps: u32,
    /// ⌊(2^31 − 1)·2^shift/2n⌋.
    factor: u32,
    shift: u32,
}

impl Parameters {
    pub(super) fn new(steps: u32) -> Self {
        let doubled = 2 * steps;
        let shift = doubled.checked_ilog2().unwrap_or(0).min(15);
        const ONE: u32 = i32::MAX.unsigned_abs();
        let whole = ONE.checked_div(doubled).unwrap_or(0);
        let rest = ONE.wrapping_sub(whole.wrapping_mul(doubled));
        let factor = (whole << shift).wrapping_add((rest << shift).checked_div(doubled).unwrap_or(0));
        Self { steps, factor, shift }
    }

    /// A half step in one unit, which times i is within 2·i units of the parameter of half step i.
    #[inline(always)]
    pub(super) fn near(&self) -> u32 {
        self.factor >> (self.shift & 15)
    }

    /// The parameter of half step `i`, within two units.
    #[inline(always)]
    pub(super) fn half(&self, i: u32) -> i32 {
        ((u64::from(i) * u64::from(self.factor)) >> (self.shift & 15)) as i32
    }
}

/// The differences of the row x = b0 + b1·t + b2·t² + b3·t³ at t = 0 with the step h = 1/n, of which 16 times are
/// b1·h + b2·h² + b3·h³, 2·b2·h² + 6·b3·h³ and 6·b3·h³, as sums of upper halves of products with 4·b1, 2·b2 and 2·b3.
///
/// Factors are below 2^31: products are what is wanted over 2^e, with e = 6 − ⌊log n⌋ for the first difference and twice
/// 3 − ⌊log n⌋ for the others, where that is positive.
#[derive(Clone, Copy, Debug)]
pub(super) struct Differences {
    /// 4·h, 8·h² and 8·h³, in 2^(e − 32).
    first: [i32; 3],
    /// 16·h² and 48·h³, likewise.
    second: [i32; 2],
    shifts: [u32; 2],
}

impl Differences {
    /// Those of no walk.
    pub(super) const NONE: Self = Self { first: [0; 3], second: [0; 2], shifts: [0; 2] };

    pub(super) fn new(along: &Parameters) -> Self {
        let log = along.steps.checked_ilog2().unwrap_or(0);
        // 2^31·(2^log·h)^k.
        let one = (along.factor << (log + 1 - along.shift.min(log + 1))) as i32;
        let two = high(one, one) << 1;
        let three = high(two, one) << 1;
        let shifts = [6_u32.saturating_sub(log), 6_u32.saturating_sub(2 * log)];
        let down = |value: i32, by: u32, less: u32| value >> by.saturating_sub(less).min(31);
        Self {
            first: [
                down(one, log + shifts[0], 3),
                down(two, 2 * log + shifts[0], 4),
                down(three, 3 * log + shifts[0], 4),
            ],
            second: [down(two, 2 * log + shifts[1], 5), down((three >> 3) * 6, 3 * log + shifts[1], 7)],
            shifts,
        }
    }

    /// The walk along a row from parameter `t` on.
    #[inline(always)]
    pub(super) fn line(&self, row: &RowCubic, t: i32, fraction: i32) -> Line {
        // Most runs start at 0. What is done for others is out of line, or it slows the rest down.
        let mut moved = *row;
        if t != 0 {
            move_by(&mut moved, t);
        }
        let [value, slope, bend, last] = moved;
        let [by_slope, by_bend, by_last] = self.first;
        let third = high(self.second[1], last);
        let second = high(self.second[0], bend).wrapping_add(third);
        let first = high(by_slope, slope).wrapping_add(high(by_bend, bend)).wrapping_add(high(by_last, last));
        Line {
            value: value.wrapping_add(fraction),
            first: first << (self.shifts[0] & 7),
            second: second << (self.shifts[1] & 7),
            third: third << (self.shifts[1] & 7),
        }
    }
}

/// Makes a row the one whose parameters are counted from `t` on.
#[inline(never)]
fn move_by(row: &mut RowCubic, t: i32) {
    let [_, slope, bend, last] = *row;
    let slopes = high((bend >> 1).wrapping_add(high(last.wrapping_add(last >> 1), t)), t);
    row[0] = value_at(row, t);
    row[1] = slope.wrapping_add(slopes.wrapping_mul(16));
    row[2] = bend.wrapping_add(high(last, t).wrapping_mul(6));
}

/// The value of a row at a parameter in 2^-31, rounded down by less than 7 units.
#[inline(always)]
pub(super) fn value_at([start, slope, bend, last]: &RowCubic, t: i32) -> i32 {
    let product = high((bend >> 1).wrapping_add(high(*last, t)), t);
    let product = high((slope >> 2).wrapping_add(product.wrapping_mul(2)), t);
    start.wrapping_add(product.wrapping_mul(2))
}
