//! Exact tangents from the differences of the points.
//!
//! A polynomial with Newton differences Δ^a has the derivative Σ (−1)^(a−1)/a · Δ^a. Times L = lcm(1 ..= m) the
//! factors are integers, so the tangents are exact sums of differences that are there anyway.

use super::Budget;
use super::form::Form;
use crate::num::Word;
use crate::patch::MAX_DEGREE;

/// lcm(1 ..= degree) for a degree of at most 8.
const fn lcm(degree: usize) -> i32 {
    const TABLE: [i32; MAX_DEGREE + 1] = [1, 1, 2, 6, 12, 60, 60, 420, 840];
    TABLE[if degree > MAX_DEGREE { MAX_DEGREE } else { degree }]
}

/// (−1)^(a−1)·L/a for the two directions.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Weights {
    r: [i32; MAX_DEGREE + 1],
    s: [i32; MAX_DEGREE + 1],
}

fn weights(degree: usize) -> [i32; MAX_DEGREE + 1] {
    let mut out = [0; MAX_DEGREE + 1];
    for (a, weight) in out.iter_mut().enumerate().take(degree + 1).skip(1) {
        let magnitude = lcm(degree).checked_div(a as i32).unwrap_or(0);
        *weight = if a % 2 == 1 { magnitude } else { -magnitude };
    }
    out
}

impl Weights {
    pub(crate) fn of(degrees: (usize, usize)) -> Self {
        Self { r: weights(degrees.0), s: weights(degrees.1) }
    }

    /// L_r times the derivative along the row.
    #[inline(always)]
    pub(crate) fn along_row<W: Word, const R: usize>(&self, d: &[W; R]) -> W {
        (1..R).fold(W::ZERO, |sum, a| sum.wrapping_plus(d[a].wrapping_mul_i64(self.r[a].into())))
    }

    /// The derivative along the row of the given differences, up to one positive factor: L_r times those of the three
    /// axes, shifted right by one common amount where they exceed 48 bits.
    pub(crate) fn along_rows<W: Word, const R: usize>(&self, d: &[[W; R]; 3]) -> [i64; 3] {
        let all = d.as_flattened().iter().fold(W::ZERO, |all, v| all | (*v ^ (*v >> (<W as Word>::BITS - 1) as usize)));
        let shift = (<W as Word>::BITS - all.leading_zeros()).saturating_sub(48) as usize;
        d.map(|d| self.along_row(&d.map(|v| -> i64 { (v >> shift).as_() })))
    }

    /// L_s times the derivative across the rows, as differences along the row.
    pub(crate) fn across<W: Word, const R: usize>(&self, table: &[[W; R]; R]) -> [W; R] {
        let mut sums = [W::ZERO; R];
        for (row, weight) in table.iter().zip(self.s).skip(1) {
            for (sum, entry) in sums.iter_mut().zip(row) {
                *sum = sum.wrapping_plus(entry.wrapping_mul_i64(weight.into()));
            }
        }
        sums
    }
}

/// The bits, sign included, that hold every component of both tangents: |L·N/n·S'| ≤ L·K·N.
///
/// For a rational net T' = −D·S' + (x − S)·D' with |D'|/n ≤ m·D_max, so L·(K + m)·D_max.
pub(crate) fn tangent_bits(form: &Form<'_>, budget: &Budget) -> u32 {
    let weights = if form.weights().is_some() { form.degree() as u128 } else { 0 };
    let factor = lcm(form.degree()) as u128 * (u128::from(budget.largest_step) + weights);
    budget.scale.checked_mul(factor).map_or(129, |largest| 129 - largest.leading_zeros())
}
