//! Symmetric, cyclic tridiagonal systems of up to 16 rows.

use super::balance::FINE;
use super::ring::Ring;

/// Three right-hand sides.
pub(super) type Wide3 = [i128; 3];

/// A symmetric matrix with entries on the diagonal, beside it and in the corner, in 2^-40.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cyclic {
    rows: usize,
    pub(super) diagonal: Ring<i128>,
    /// Entry (i, i + 1).
    pub(super) beside: Ring<i128>,
    /// Entry (0, n − 1), beside the diagonal for two rows.
    pub(super) corner: i128,
}

/// L D Lᵀ: L has ones on its diagonal, entries below it and in its last row.
#[derive(Clone, Copy, Debug)]
pub(super) struct Factors {
    rows: usize,
    pivots: Ring<i128>,
    below: Ring<i128>,
    last: Ring<i128>,
    /// Whether a pivot was too small and its unknown is 0.
    pub(super) dropped: bool,
}

/// Pivots below this part of their diagonal entry are 0: 2^-26.
const LEAST: u32 = 26;

/// a·b in the format of a.
fn times(a: i128, b: i128) -> i128 {
    a.saturating_mul(b) >> FINE
}

/// a/b in the format of a; 0 for a pivot of 0.
fn over(a: i128, b: i128) -> i128 {
    (a.clamp(-(1 << 86), 1 << 86) << FINE).checked_div(b).unwrap_or(0)
}

impl Cyclic {
    pub(super) fn new(rows: usize) -> Self {
        Self { rows, diagonal: Ring::all(0), beside: Ring::all(0), corner: 0 }
    }

    /// The factors, without a choice of pivots.
    #[inline(never)]
    pub(super) fn factored(&self) -> Factors {
        let none = Ring::all(0);
        let mut out = Factors { rows: self.rows, pivots: none, below: none, last: none, dropped: false };
        let end = self.rows.saturating_sub(1);
        let (mut pivot, mut last, mut rest) = (self.diagonal[0], self.corner, self.diagonal[end]);
        for i in 0..end {
            if i + 1 == end {
                last += self.beside[i];
            }
            out.keep(i, pivot, self.diagonal[i]);
            let below = if i + 1 == end { 0 } else { over(self.beside[i], out.pivots[i]) };
            out.below[i] = below;
            out.last[i] = over(last, out.pivots[i]);
            rest -= times(last, out.last[i]);
            pivot = self.diagonal[i + 1] - times(self.beside[i], below);
            last = -times(last, below);
        }
        out.keep(end, rest, self.diagonal[end]);
        out
    }
}

impl Factors {
    fn keep(&mut self, i: usize, pivot: i128, diagonal: i128) {
        let kept = pivot > 0 && pivot >= diagonal >> LEAST;
        self.pivots[i] = if kept { pivot } else { 0 };
        self.dropped |= !kept;
    }

    /// The solution in place of the right-hand sides, of any format.
    #[inline(never)]
    pub(super) fn solve(&self, x: &mut Ring<Wide3>) {
        let end = self.rows.saturating_sub(1);
        for c in 0..3 {
            for i in 0..end {
                let y = x[i][c];
                if i + 1 < end {
                    x[i + 1][c] -= times(y, self.below[i]);
                }
                x[end][c] -= times(y, self.last[i]);
            }
            for i in 0..=end {
                x[i][c] = over(x[i][c], self.pivots[i]);
            }
            for i in (0..end).rev() {
                let next = if i + 1 < end { times(x[i + 1][c], self.below[i]) } else { 0 };
                x[i][c] -= next + times(x[end][c], self.last[i]);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::disallowed_types, clippy::float_arithmetic)]
    use super::*;

    fn fixed(x: f64) -> i128 {
        (x * (1_u64 << FINE) as f64) as i128
    }

    /// A system with diagonal 3 + i, entries 1/(i + 1) beside it, and a corner.
    fn check(rows: usize, corner: f64) {
        let mut matrix = Cyclic::new(rows);
        let mut dense = [[0.0; 16]; 16];
        for i in 0..rows {
            dense[i][i] = 3.0 + i as f64;
            matrix.diagonal[i] = fixed(dense[i][i]);
            if i + 1 < rows {
                dense[i][i + 1] = 1.0 / (i + 1) as f64;
                dense[i + 1][i] = dense[i][i + 1];
                matrix.beside[i] = fixed(dense[i][i + 1]);
            }
        }
        dense[0][rows - 1] += corner;
        if rows > 1 {
            dense[rows - 1][0] += corner;
        }
        matrix.corner = fixed(corner);
        if rows == 1 {
            matrix.diagonal[0] += fixed(corner);
        }
        let mut x = Ring::all([0; 3]);
        (0..rows).for_each(|i| x[i] = [fixed(1.0 + i as f64), fixed(-2.0), fixed((i * i) as f64)]);
        let right = x;
        let factors = matrix.factored();
        assert!(!factors.dropped);
        factors.solve(&mut x);
        for i in 0..rows {
            for c in 0..3 {
                let sum: f64 = (0..rows).map(|j| dense[i][j] * x[j][c] as f64).sum();
                assert!((sum - right[i][c] as f64).abs() < 4096.0, "{rows} {i} {c}");
            }
        }
    }

    #[test]
    fn solutions_solve() {
        (3..=16).for_each(|rows| check(rows, 0.7));
        (1..=16).for_each(|rows| check(rows, 0.0));
    }

    #[test]
    fn a_singular_system_drops_its_last_pivot() {
        // (1 1 0 1; 1 1 1 0 …): ones on the diagonal ×2, ones beside: singular for an even cycle.
        let mut matrix = Cyclic::new(4);
        for i in 0..4 {
            (matrix.diagonal[i], matrix.beside[i]) = (fixed(2.0), fixed(1.0));
        }
        matrix.corner = fixed(1.0);
        let factors = matrix.factored();
        assert!(factors.dropped);
        let mut x = Ring::all([fixed(4.0); 3]);
        factors.solve(&mut x);
        for i in 0..4 {
            let sum = 2 * x[i][0] + x[(i + 1) % 4][0] + x[(i + 3) % 4][0];
            assert!((sum - fixed(4.0)).abs() < 16, "{i}");
        }
    }
}
