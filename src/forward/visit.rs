//! What a walk shows at each point, and to whom.

use crate::num::Word;

/// A point of a lattice as a visitor sees it.
pub(crate) trait Site {
    /// What tangents are made of.
    type Word: Word;

    /// The index in the row.
    fn i(&self) -> u32;

    /// The row.
    fn j(&self) -> u32;

    /// The rounded coordinates.
    fn point(&self) -> [i32; 3];

    /// Both tangents, each exact up to one truncation and a positive factor; only for visitors with
    /// [`Visit::TANGENTS`].
    fn tangents(&self) -> [[Self::Word; 3]; 2];

    /// The mixed derivative, each component exact up to one truncation and a positive factor, where one of the tangents
    /// vanishes: next to a collapsed side it is what that tangent grows from.
    fn twist(&self) -> [i64; 3];

    /// The bits below the rounded coordinate plus 1/2: about 2^bits times the fraction, below 2^bits.
    fn below(&self, axis: usize, fraction: &Fraction) -> u32;

    /// ⌊2^bits·value⌋, exact: equal values give equal results, whatever lattices they belong to. Polynomial lattices
    /// are carried as residuals then.
    fn floor(&self, axis: usize, fraction: &Fraction) -> i32;
}

/// What happens at the points of a walk.
pub(crate) trait Visit: Sized {
    /// Whether [`Site::tangents`] is wanted.
    const TANGENTS: bool = false;

    /// Whether the visitor looks at nothing but i, j and the point of a [`Site`]: then rows may run in lanes.
    const POINTS_ONLY: bool = false;

    /// Whether the points of row `j` are wanted; asked once a row, before its points.
    fn wants_row(&mut self, j: u32) -> bool {
        let _ = j;
        true
    }

    /// Called at every point of the rows wanted, in row order; the visitor is threaded through by value.
    fn point<S: Site>(self, at: &S) -> Self;
}

/// How to read the bits below a coordinate.
///
/// Where the denominator N is constant: e·2^bits/N without a division. With N' = ⌊N/2^s⌋ of 16 bits (s < 0 for a small
/// N) and q = ⌊2^(16+bits)/(N' + 1)⌋ it is ⌊⌊e/2^s⌋·q/2^16⌋: below 2^bits, never decreasing in e, and less than two
/// below the exact value for bits ≤ 8, less than four for bits ≤ 11.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Fraction {
    pub(crate) bits: u32,
    shift: u32,
    up: u32,
    factor: u32,
}

impl Fraction {
    /// The reader for the constant denominator `scale`; `bits` is at most 11.
    pub(crate) fn of(scale: u128, bits: u32) -> Self {
        let used = 128 - scale.leading_zeros();
        let (shift, up) = (used.saturating_sub(16), 16_u32.saturating_sub(used));
        let high = ((scale >> shift) as u32) << up;
        Self { bits, shift, up, factor: (1_u32 << (16 + bits)).checked_div(high + 1).unwrap_or(0) }
    }

    #[inline(always)]
    pub(crate) fn read<W: Word>(&self, residual: W) -> u32 {
        let high: i32 = (residual >> self.shift as usize).as_();
        ((high as u32) << self.up).wrapping_mul(self.factor) >> 16
    }

    /// ⌊e·2^bits/N⌋ for the constant denominator N with 2N < 2^w, exact: [`read`](Self::read) and one correction. What
    /// is left over lies in 0 ..= 2N − 1, so it is right modulo 2^w.
    #[inline(always)]
    pub(crate) fn exact<W: Word>(&self, e: W, scale: W) -> u32 {
        let near = self.read(e);
        let rest = (e << self.bits as usize).wrapping_minus(scale.wrapping_mul_i64(near.into()));
        near + u32::from(!rest.below(scale))
    }

    /// ⌊e·2^bits/d⌋ for 0 ≤ e < d < 2^(w−1), by restoring division: for denominators that change from point to point.
    #[inline(always)]
    pub(crate) fn divide<W: Word>(&self, e: W, d: W) -> u32 {
        let (mut rest, mut out) = (e, 0);
        for _ in 0..self.bits {
            rest = rest.wrapping_plus(rest);
            out <<= 1;
            if !rest.below(d) {
                rest = rest.wrapping_minus(d);
                out |= 1;
            }
        }
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fractions_are_within_two_of_the_exact_ones_and_never_fall() {
        for scale in [1_u128, 2, 10, 1000, 65_535, 65_536, 65_537, 1 << 40, (1 << 50) + 12_345] {
            for (bits, off) in [(0, 2), (3, 2), (8, 2), (11, 4)] {
                let (fraction, mut last) = (Fraction::of(scale, bits), 0);
                for k in 0..=200_u128.min(scale - 1) {
                    let e = (scale - 1) * k / 200_u128.min(scale - 1).max(1);
                    let exact = ((e << bits) / scale) as u32;
                    let ours = fraction.read(e as i64);
                    assert!(ours <= exact && ours + off > exact && ours >= last, "{e}/{scale}: {ours} for {exact}");
                    assert_eq!(fraction.divide(e as i64, scale as i64), exact);
                    assert_eq!(fraction.exact(e as i64, scale as i64), exact);
                    last = ours;
                }
            }
        }
    }
}
