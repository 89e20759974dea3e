//! Segment counts of a bicubic patch, from its bends along r and s where they meet.
//!
//! Let A = S_rr/r² and B = S_ss/s² in the plane of the screen, for r × s cells. A cubic is off its chord over [a, b] by exactly
//! (u − a)(u − b)/2 times its second derivative at (a + b + u)/3. With t and τ the place (u, v) in a cell, w = 1 − 2t,
//! ω = 1 − 2τ, p = 1 − w² and q = 1 − ω², eight times what a bilinear cell is off is therefore
//!
//! p·A(u*, v) + q·B(u, v*) + q·R, |R| ≤ max|B_uu|/8r²,
//!
//! u* being w/6 of a cell from the middle of the cell, v* likewise: both in the square Q that leaves 1/3r and 1/3s at the
//! sides of the patch. Let a be the largest |A| for u* in Q and any v, b the largest |B| for v* in Q, c the largest |A + B| in
//! Q. For p ≥ q, that is |w| ≤ |ω|, the first two terms are (p − q)·A(u*, v) + q·(A + B)(u*, v*) and what A and B change
//! from v to v* and from u to u*: with d = max|A_v|/3s + max|B_u|/3r not longer than
//!
//! (p − q)·a + q·(c + |ω|·d) ≤ max(a, c) + 0.385·d,
//!
//! for 0.385 is the most that |ω|·(1 − ω²) is; where c > a also at most c + d²/4(c − a), by (1 − ω²)(x + |ω|·d) ≤ x + d²/4x.
//! For p ≤ q the same holds with b. A, B and A + B are bounded by their Bernstein coefficients over Q.

use crate::geometry::Point3;
use crate::num::{I16F16, leading_zeros, reciprocal_root};

/// A vector in the plane of the screen.
type Vector = [i32; 2];

/// A quantity that is linear along one parameter and cubic along the other: its coefficients.
type Bend = [[Vector; 4]; 2];

/// Bits of second differences.
const BITS: u32 = 13;

/// Bits of second differences by squares of counts.
const SCALED_BITS: u32 = 14;

/// The most segments that are looked for: squares have [`LAMBDA_BITS`].
const MOST: u32 = 63;

/// Fraction bits of what Q is of the unit square.
const LAMBDA_BITS: u32 = 12;

/// 1 − 2/3n in 2^-12 and up; 1 beyond.
const LAMBDAS: [u16; 17] = {
    let (mut table, mut n) = ([1 << LAMBDA_BITS; 17], 1);
    while n < 17 {
        table[n as usize] -= (1 << (LAMBDA_BITS + 1)) / (3 * n);
        n += 1;
    }
    table
};

/// What is rounded on the way to the coefficients over Q, in their units.
const ROUNDED: u32 = 60;

#[inline(always)]
fn minus(a: Vector, b: Vector) -> Vector {
    [a[0].wrapping_sub(b[0]), a[1].wrapping_sub(b[1])]
}

#[inline(always)]
fn square(v: Vector) -> u32 {
    (v[0].wrapping_mul(v[0])).wrapping_add(v[1].wrapping_mul(v[1])) as u32
}

/// The square root, within [`ROOT`] of a number below 2^31.
#[inline(never)]
fn root(square: u32) -> u32 {
    let (reciprocal, half) = reciprocal_root(square | 1);
    let shift = 16_u32.saturating_sub(leading_zeros(square));
    ((square >> shift) * reciprocal) >> ((15 + half - shift) & 31)
}

/// What roots may be off.
const ROOT: u32 = 5;

/// The bits that are set in some component, or clear in a negative one.
#[inline(always)]
fn bits(vectors: &[Vector]) -> u32 {
    vectors.as_flattened().iter().fold(0, |all, c| all | (c ^ (c >> 31))).unsigned_abs()
}

/// More than the length of each of these vectors, of components below 2^15.
#[inline(always)]
fn longest<const N: usize>(vectors: [Vector; N]) -> u32 {
    root(vectors.into_iter().fold(0, |most, v| most.max(square(v)))) + ROOT + 1
}

/// What a patch tells about its cells, in 2^(e − 12) pixel.
struct Bends {
    /// The second differences along r, linear in r and cubic in s; those along s, linear in s.
    along: [Bend; 2],
    /// At least the largest component of each.
    most: [u32; 2],
    /// The longest difference of each along the parameter in which it is cubic.
    slopes: [u32; 2],
    /// The longest second difference of the second.
    convex: u32,
    exponent: u32,
    /// The least counts that leave no side of a cell too long.
    sides: [u32; 2],
}

/// The second differences along the first parameter, and the longest first one in whole pixels, rounded up.
#[inline(never)]
fn differences(net: &[Vector; 16]) -> (Bend, u32) {
    let (mut bend, mut first) = ([[[0; 2]; 4]; 2], [[0; 2]; 12]);
    for b in 0..4 {
        let [p, q, r, s] = [net[b], net[4 + b], net[8 + b], net[12 + b]];
        let steps = [minus(q, p), minus(r, q), minus(s, r)];
        (bend[0][b], bend[1][b]) = (minus(steps[1], steps[0]), minus(steps[2], steps[1]));
        for (k, step) in steps.into_iter().enumerate() {
            first[(3 * b + k) & 15] = step.map(|c| c >> 12);
        }
    }
    // Of components below 2^14: beyond, anything that is far too much.
    let length = if bits(&first) < 1 << 14 { longest(first) + 2 } else { 1 << 14 };
    (bend, length)
}

impl Bends {
    #[inline(never)]
    fn of(points: &[Point3; 16]) -> Self {
        // Within 2^-12 each, so a second difference within twice that.
        let net = points.map(|p| [p.x.to_bits() >> 4, p.y.to_bits() >> 4]);
        let mut turned = net;
        for k in 0..16 {
            turned[k % 4 * 4 + k / 4] = net[k];
        }
        let [(along_r, longest_r), (along_s, longest_s)] = [differences(&net), differences(&turned)];
        let mut along = [along_r, along_s];
        let used = along.each_ref().map(|bend| bits(bend.as_flattened()));
        let exponent = (32 - leading_zeros(used[0] | used[1] | 1)).saturating_sub(BITS);
        if exponent > 0 {
            for c in along.as_flattened_mut().as_flattened_mut().as_flattened_mut() {
                *c >>= exponent;
            }
        }
        let slopes = along.each_ref().map(|[p, q]| {
            let steps = |v: &[Vector; 4]| [minus(v[1], v[0]), minus(v[2], v[1]), minus(v[3], v[2])];
            let ([a, b, c], [d, e, f]) = (steps(p), steps(q));
            longest([a, b, c, d, e, f]) + 4
        });
        let bent = |v: &[Vector; 4], k: usize| minus(minus(v[k], v[k + 1]), minus(v[k + 1], v[k + 2]));
        let [p, q] = &along[1];
        let convex = longest([bent(p, 0), bent(p, 1), bent(q, 0), bent(q, 1)]) + 8;
        // Three times the longest difference, in cells of at most 63 pixels.
        let sides = [longest_r, longest_s].map(|length| (3 * length).div_ceil(63));
        Self { along, most: used.map(|all| (all >> exponent) + 1), slopes, convex, exponent, sides }
    }
}

/// Half the sums and half the differences of coefficients, doubled, the differences over Q: by axis.
type Halves = [[[i32; 4]; 2]; 2];

#[inline(always)]
fn halves([start, end]: &Bend, scale: impl Fn(i32) -> i32, lambda: i32) -> Halves {
    let mut halves = [[[0; 4]; 2]; 2];
    for k in 0..4 {
        for axis in 0..2 {
            let (start, end) = (scale(start[k][axis]), scale(end[k][axis]));
            halves[axis][0][k] = start.wrapping_add(end);
            halves[axis][1][k] = end.wrapping_sub(start).wrapping_mul(lambda) >> LAMBDA_BITS;
        }
    }
    halves
}

/// The square of the longest coefficient.
#[inline(always)]
fn largest([[mx, hx], [my, hy]]: &Halves) -> u32 {
    let ends = |k: usize| [[mx[k] + hx[k], my[k] + hy[k]], [mx[k] - hx[k], my[k] - hy[k]]].map(square);
    (0..4).fold(0, |most, k| most.max(ends(k)[0]).max(ends(k)[1]))
}

/// The coefficients of a cubic over the middle λ of its interval.
///
/// By powers of 2t − 1 the even ones are 1, (1, −1/3, −1/3, 1) and the odd ones (−1, −1/3, 1/3, 1), (−1, 1, −1, 1).
#[inline(always)]
fn restrict([a, b, c, d]: [i32; 4], [l1, l2, l3]: [i32; 3]) -> [i32; 4] {
    let (outer, inner, wide, near) = (a + d, b + c, d - a, c - b);
    let by = |x: i32, l: i32| x.wrapping_mul(l) >> LAMBDA_BITS;
    let even = by(outer - inner, l2);
    let start = outer + 3 * inner;
    let (odd, third) = (by(wide + near, l1), by(wide - 3 * near, l3));
    let (ends, insides) = (start + 3 * even, start - even);
    let (far, close) = (3 * odd + third, odd - third);
    [ends - far, insides - close, insides + close, ends + far].map(|c| c >> 3)
}

/// The square of the longest coefficient of the sum over Q.
#[inline(never)]
fn largest_of_sum(first: &Halves, second: &Halves, lambdas: [[i32; 3]; 2]) -> u32 {
    let mut squares = [[0_u32; 4]; 4];
    for (first, second) in first.iter().zip(second) {
        let [m, h] = [restrict(first[0], lambdas[1]), restrict(first[1], lambdas[1])];
        let [n, g] = [restrict(second[0], lambdas[0]), restrict(second[1], lambdas[0])];
        // A function that is −half and half at the ends, as coefficients of degree 3.
        let [h, g] = [h, g].map(|half| half.map(|end| [end, end.wrapping_mul(21_845) >> 16]));
        let at = |[end, third]: [i32; 2], k: usize| [-end, -third, third, end][k];
        for k in 0..4 {
            for l in 0..4 {
                let sum = m[l] + at(h[l], k) + n[k] + at(g[k], l);
                squares[k][l] = squares[k][l].wrapping_add(sum.wrapping_mul(sum) as u32);
            }
        }
    }
    squares.as_flattened().iter().fold(0, |most, s| most.max(*s))
}

/// λ of a count, and its powers.
#[inline(always)]
fn lambdas(count: u32) -> [i32; 3] {
    let l = LAMBDAS.get(count as usize).map_or(1 << LAMBDA_BITS, |l| i32::from(*l));
    let square = (l * l) >> LAMBDA_BITS;
    [l, square, (square * l) >> LAMBDA_BITS]
}

/// Cells of a patch, r × s of them.
#[derive(Clone, Copy)]
struct Cells {
    r: u32,
    s: u32,
}

/// What is known of cells.
enum Verdict {
    Within,
    /// Too far: along r, or along s.
    Beyond {
        along_r: bool,
    },
}

impl Bends {
    /// Whether cells are within a tolerance, given four thirds of it in 2^(e − 12) pixel: second differences are a sixth of
    /// derivatives, and eight times the error is bounded. All is multiplied by r²·s².
    #[inline(never)]
    fn judge(&self, Cells { r, s }: Cells, tolerance: u32) -> Verdict {
        let (by_r, by_s) = (r * r, s * s);
        let all = self.most[0] * by_s + self.most[1] * by_r;
        let shift = (32 - leading_zeros(all)).saturating_sub(SCALED_BITS);
        // In doubled units after the shift, rounded up; net values are less than 3 off.
        let scaled = |value: u32| (value >> shift << 1) + 2;
        let limit = ((u64::from(tolerance) * u64::from(by_r * by_s)) << 1 >> shift).min(1 << 17) as u32;
        let rest = scaled(3 * (by_r + by_s)) + scaled(self.convex) + ROUNDED;
        let drift = scaled(self.slopes[0] * s + self.slopes[1] * r);
        let (lambda_r, lambda_s) = (lambdas(r), lambdas(s));
        let first = halves(&self.along[0], |c| c.wrapping_mul(by_s as i32) >> shift, lambda_r[0]);
        let second = halves(&self.along[1], |c| c.wrapping_mul(by_r as i32) >> shift, lambda_s[0]);
        let (a, b) = (largest(&first), largest(&second));
        let beyond = Verdict::Beyond { along_r: a > b };
        let Some(limit) = limit.checked_sub(rest) else { return beyond };
        let is_longer = |square: u32| limit < 1 << 16 && square > limit * limit;
        if is_longer(a.max(b)) {
            return beyond;
        }
        let c = largest_of_sum(&first, &second, [lambda_r, lambda_s]);
        if is_longer(c) {
            return beyond;
        }
        let most = root(c.max(a).max(b)) + ROOT;
        if most + (99 * drift).div_ceil(256) <= limit {
            return Verdict::Within;
        }
        let above = root(c).saturating_sub(root(a.max(b)) + 2 * ROOT);
        let excess = u64::from(above) * u64::from(limit.saturating_sub(most));
        if u64::from(drift) * u64::from(drift) <= 4 * excess { Verdict::Within } else { beyond }
    }

    /// The least count that would do if there were no bend along the other direction, or one less.
    fn alone(&self, way: usize, start: u32, tolerance: u32) -> u32 {
        let bends = self.along[way & 1].as_flattened();
        let longest = root(bends.iter().fold(0, |most, v| most.max(square(*v)))).saturating_sub(ROOT);
        let mut n = start.max(self.sides[way & 1]);
        while n <= MOST && longest * (3 * n - 2) > (3 * n * n * n).saturating_mul(tolerance) {
            n += 1;
        }
        n
    }
}

/// The least counts from `start` on that bring the cells within the tolerance, the longer bend first; `None` where they are
/// beyond what is looked for, or the tolerance too small beside the patch.
pub(super) fn counts(points: &[Point3; 16], start: (u16, u16), tolerance: I16F16) -> Option<(u16, u16)> {
    let bends = Bends::of(points);
    // Four thirds of it in 2^(e − 12), rounded down; more than 128 pixels change nothing.
    let tolerance = (tolerance.to_bits().unsigned_abs().min(128 << 16) / 12) >> bends.exponent.min(31);
    if tolerance < 32 {
        return None;
    }
    let mut cells =
        Cells { r: bends.alone(0, start.0.into(), tolerance), s: bends.alone(1, start.1.into(), tolerance) };
    while cells.r.max(cells.s) <= MOST {
        match bends.judge(cells, tolerance) {
            Verdict::Within => return Some((cells.r as u16, cells.s as u16)),
            Verdict::Beyond { along_r: true } => cells.r += 1,
            Verdict::Beyond { along_r: false } => cells.s += 1,
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn roots_are_close() {
        for square in (0..100_000).chain((0..60_000).map(|k| (1 << 31) - 1 - k * 35_000)) {
            let (found, square) = (u64::from(root(square)), u64::from(square));
            let (least, most) = (found.saturating_sub(ROOT.into()), found + u64::from(ROOT));
            assert!(least * least <= square && square <= most * most, "{square}: {found}");
        }
    }
}
