//! Segment counts of a bicubic patch, from its bends along r and s where they meet.
//!
//! Let A = S_rr and B = S_ss in the plane of the screen. A cubic is off its chord over [a, b] by exactly
//! (u − a)(u − b)/2 times its second derivative at (a + b + u)/3. With t and τ the place in a cell, w = 1 − 2t and
//! ω = 1 − 2τ, eight times what a bilinear cell is off is therefore at most
//!
//! (1 − w²)·|A(u*, v)|/r² + (1 − ω²)·|(1 − t)·B(u₀, v*) + t·B(u₁, v*)|/s²,
//!
//! u* being |w|/3 of a cell from u, v* likewise. Let a and b be the lengths of the 4 × 4 Bernstein coefficients of A and B
//! in degree (3, 3): the polynomials â and b̂ with those coefficients bound |A| and |B|. To take them all at (u, v):
//! â there is larger by at most |w|·max|â_u|/3r, b̂ by |ω|·max|b̂_v|/3s, and the chord of b̂ lies above it by at most
//! max(b̂_uu, 0)/8r². With α = max|â_u|/3r³ and β = max|b̂_v|/3s³,
//!
//! (1 − w²)·(â/r² + |w|·α) ≤ â/r² + 0.385·α
//!
//! for 0.385 is the most that |w|·(1 − w²) is, and likewise for b̂; and â/r² + b̂/s² is at most the largest a/r² + b/s².

use crate::geometry::Point3;
use crate::num::I16F16;

/// Three times the lengths of the coefficients of S_rr/6 and S_ss/6, shifted right by `exponent` from 2^-12 pixel.
struct Bends {
    along: [[u32; 2]; 16],
    exponent: u32,
    /// The least counts that leave no side of a cell too long.
    sides: [u32; 2],
}

/// Bits of components of coefficients: sums of their products with squares of 14 bits stay below 2^32.
const BITS: u32 = 15;

/// Counts beyond this are not looked for.
const MOST: u32 = 127;

/// At least 256 times the length of (x, y), at most 2 % more, for components below 2^16: the largest of three projections.
#[inline(always)]
fn length([x, y]: [u32; 2]) -> u32 {
    let (long, short) = if x > y { (x, y) } else { (y, x) };
    (262 * long).max(242 * long + 100 * short).max(185 * (long + short))
}

impl Bends {
    fn of(points: &[Point3; 16]) -> Self {
        // Within a unit each: a second difference within 2, three of them within 6.
        let [x, y] = [points.map(|p| p.x.to_bits() >> 4), points.map(|p| p.y.to_bits() >> 4)];
        // The strides of r and s, and of what is across.
        let ways = [(4, 1), (1, 4)];
        let longest = ways.map(|(step, across)| {
            let longest = [&x, &y].map(|c| {
                let difference = |at: usize| (c[(at + step) & 15] - c[at & 15]).unsigned_abs();
                let differences = (0..12).map(|k| difference((k / 4) * step + (k % 4) * across));
                (differences.fold(0, u32::max) >> 12) + 1
            });
            length(longest)
        });
        // Three second differences are at most six times the longest difference, of at most 2^16 pixels.
        let most = 6 * (longest[0].max(longest[1]) >> 8).saturating_add(1);
        let exponent = (12 + 32 - most.leading_zeros()).saturating_sub(BITS);
        // What they are off, and rounding up.
        let more = 6 + (1 << exponent);
        let mut along = [[0; 2]; 16];
        for (way, (step, across)) in ways.into_iter().enumerate() {
            for line in 0..4 {
                let second = |c: &[i32; 16]| {
                    let [p, q, r, s] = [0, 1, 2, 3].map(|k| c[(line * across + k * step) & 15]);
                    [p - 2 * q + r, q - 2 * r + s]
                };
                let bends = [second(&x), second(&y)];
                for k in 0..4 {
                    let size =
                        |[first, last]: [i32; 2]| (((3 - k) * first + k * last).unsigned_abs() + more) >> exponent;
                    let at = line * across + k as usize * step;
                    along[at & 15][way] = (length(bends.map(size)) >> 8) + 1;
                }
            }
        }
        // Three times the longest difference, in cells of at most 63 pixels.
        Self { along, exponent, sides: longest.map(|length| (3 * length).div_ceil(63 << 8)) }
    }
}

/// The least counts from `start` on that bring the cells within the tolerance, the longer bend first; `None` where they are
/// beyond what is looked for, or the tolerance too small beside the patch.
pub(super) fn counts(points: &[Point3; 16], start: (u16, u16), tolerance: I16F16) -> Option<(u16, u16)> {
    let Bends { along, exponent, sides } = Bends::of(points);
    // Eight tolerances in 2^-12, halved because coefficients are; more than 128 pixels change nothing.
    let tolerance = tolerance.to_bits().unsigned_abs().min(128 << 16) >> (2 + exponent).min(31);
    if tolerance < 32 {
        return None;
    }
    let largest = |way: usize| along.iter().fold(0, |most, bend| bend[way].max(most));
    // The least counts that would do if there were no bend along the other direction.
    let alone = |start: u32, bend: u32| (start..=MOST).find(|n| bend <= (n * n).saturating_mul(tolerance));
    let mut r = alone(sides[0].max(start.0.into()), largest(0))?;
    let mut s = alone(sides[1].max(start.1.into()), largest(1))?;
    let (mut slopes, mut convex) = ([0; 2], 0);
    for k in 0..12_usize {
        slopes[0] = along[(k + 4) & 15][0].abs_diff(along[k & 15][0]).max(slopes[0]);
        let at = k / 3 * 4 + k % 3;
        slopes[1] = along[(at + 1) & 15][1].abs_diff(along[at & 15][1]).max(slopes[1]);
        if k < 8 {
            let (ends, middle) = (along[k & 15][1] + along[(k + 8) & 15][1], 2 * along[(k + 4) & 15][1]);
            convex = ends.saturating_sub(middle).max(convex);
        }
    }
    // 0.385·α·r²·s² and so on, with the first counts in the place of one factor; α is 6·slope/3r³ over 2.
    let by = |slope: u32, count: u32| (slope * 99).div_ceil(256).div_ceil(count.max(1));
    let more = [by(slopes[0], r), by(slopes[1], s)];
    while r.max(s) <= MOST {
        let (by_r, by_s) = (s * s, r * r);
        let (mut most, mut at) = (0, &along[0]);
        for bend in &along {
            let sum = bend[0] * by_r + bend[1] * by_s;
            if sum > most {
                (most, at) = (sum, bend);
            }
        }
        let all = most + more[0] * by_r + more[1] * by_s + convex;
        if u64::from(all) <= u64::from(tolerance) * u64::from(by_r * by_s) {
            return Some((r as u16, s as u16));
        }
        if at[0] * by_r > at[1] * by_s { r += 1 } else { s += 1 }
    }
    None
}
