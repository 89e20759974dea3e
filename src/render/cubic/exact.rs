//! The exact pixel of a lattice point: the sign of a residual, modulo 2^w.

use super::Piece;
use super::run::DOUBT;
use crate::geometry::Point3;
use crate::num::Word;

/// Points are off by less than 2^10 units of 2^-F.
const WRONG: u32 = DOUBT.ilog2();

/// Binomial weights of degree 3 and less.
const CHOICES: [[i64; 4]; 4] = [[1, 0, 0, 0], [1, 1, 0, 0], [1, 2, 1, 0], [1, 3, 3, 1]];

/// C(n, k)·i^k·(d − i)^(n − k) for k = 0 ..= n.
fn weights<W: Word>(degree: usize, i: u32, d: u32) -> [W; 4] {
    let mut weights = [W::ZERO; 4];
    for (k, (weight, choices)) in weights.iter_mut().zip(CHOICES[degree & 3]).enumerate().take(degree + 1) {
        *weight = (0..degree).fold(W::ONE, |product, factor| {
            product.wrapping_mul_i64(if factor < k { i.into() } else { (d - i).into() })
        });
        *weight = weight.wrapping_mul_i64(choices);
    }
    weights
}

impl Piece<'_> {
    /// ⌊S + 1/2⌋ along an axis at a lattice point, for a guess that is at most a few pixels off.
    pub(super) fn exact_pixel(&self, axis: usize, at: [u32; 2], centred: bool, near: i32) -> i32 {
        self.exact_floor(axis, at, centred, (near, (i64::from(near) << 16) - (1 << 15), 16))
    }

    /// The number of the interval that S is in, of those of 2^`unit` bits: `near` or one close to it, which starts at
    /// `border`, in 2^-16.
    ///
    /// With N = d_r^m·d_s^h, e = N·2^16·(S − border) = Σ weights·(P − border) is an integer. Guesses are off by less than
    /// 2^([`WRONG`] − F) pixels: where that is below one, e is right modulo 2^64 for N < 2^45, and modulo 2^128 always: a
    /// piece that was not split as often as possible has at most 2^12 cells, others at most 2^32, each d twice the steps or
    /// less.
    pub(super) fn exact_floor(&self, axis: usize, at: [u32; 2], centred: bool, guess: (i32, i64, u32)) -> i32 {
        let doublings = u32::from(centred);
        let at = at.map(|i| (i << doublings) + doublings);
        let cells = [self.along.steps << doublings, self.across.steps << doublings];
        let bits = |k: usize| (32 - cells[k].leading_zeros()) * self.degrees[k] as u32;
        if bits(0) + bits(1) <= 45 && self.bits >= WRONG {
            self.settle::<i64>(axis, at, cells, guess)
        } else {
            self.settle::<i128>(axis, at, cells, guess)
        }
    }

    #[inline(never)]
    fn settle<W: Word>(
        &self,
        axis: usize,
        at: [u32; 2],
        cells: [u32; 2],
        (near, border, unit): (i32, i64, u32),
    ) -> i32 {
        let along: [W; 4] = weights(self.degrees[0], at[0], cells[0]);
        let across: [W; 4] = weights(self.degrees[1], at[1], cells[1]);
        let coordinate = |p: &Point3| {
            i64::from(match axis {
                0 => p.x.to_bits(),
                1 => p.y.to_bits(),
                _ => p.z.to_bits(),
            })
        };
        let (mut residual, mut whole) = (W::ZERO, W::ZERO);
        // On edges most weights are 0.
        for (a, by_a) in along.iter().enumerate().take(self.degrees[0] + 1).filter(|(_, by)| **by != W::ZERO) {
            for (b, by_b) in across.iter().enumerate().take(self.degrees[1] + 1).filter(|(_, by)| **by != W::ZERO) {
                let point = self.points.get(a * self.strides[0] + b * self.strides[1]);
                let weight = by_a.wrapping_times(*by_b);
                residual = residual.wrapping_plus(weight.wrapping_mul_i64(point.map_or(0, coordinate) - border));
                whole = whole.wrapping_plus(weight);
            }
        }
        let interval = whole << unit as usize;
        let mut settled = near;
        // Mostly one; more than that where F is small.
        for _ in 0..1 << (WRONG + 8) {
            if residual < W::ZERO {
                (settled, residual) = (settled - 1, residual.wrapping_plus(interval));
            } else if residual >= interval {
                (settled, residual) = (settled + 1, residual.wrapping_minus(interval));
            } else {
                break;
            }
        }
        settled
    }
}
