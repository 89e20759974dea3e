//! Tangents of a polynomial piece where they are wanted: at points that pass the depth test.
//!
//! Positions may come from a rounded net; tangents come from the piece's own net with all its bits. Bernstein weights
//! have 30 fraction bits, halves of control differences 31 bits and a sign, their sums of products at most 61: exact in
//! `i64`. A
//! sum is then cut to 30 bits once, so a tangent is within 2^-27 of the longest of its row.

use super::pen::unturned;
use crate::forward::{Form, Kind};
use crate::geometry::Point3;
use crate::patch::{MAX_DEGREE, SurfaceNet, triangle_index};

/// Room for the weights of a curve.
const ORDER: usize = MAX_DEGREE + 1;

/// Fraction bits of parameters and weights.
const FRACTION: u32 = 30;

/// Parameters i/n, or (i + 1/2)/n, in 2^-30.
#[derive(Clone, Copy, Debug)]
struct Grid {
    /// 2^32/(2n), rounded down.
    unit: u32,
    half: u32,
}

impl Grid {
    fn of(steps: u32, centred: bool) -> Self {
        Self { unit: (u32::MAX).checked_div(2 * steps).unwrap_or(0), half: centred.into() }
    }

    /// Within (2i + 1)·2^-30 of the exact parameter.
    fn at(self, i: u32) -> u32 {
        let doubled = u64::from(2 * i + self.half) * u64::from(self.unit);
        (doubled >> (32 - FRACTION)).min(1 << FRACTION) as u32
    }
}

fn times(a: u32, b: u32) -> u32 {
    ((u64::from(a) * u64::from(b)) >> FRACTION) as u32
}

/// The Bernstein weights of one degree, and of the degree below.
#[derive(Clone, Copy, Debug)]
struct Weights {
    here: [u32; ORDER],
    below: [u32; ORDER],
}

impl Weights {
    fn of(degree: usize, t: u32) -> Self {
        let rest = (1 << FRACTION) - t;
        let mut weights = Self { here: [0; ORDER], below: [0; ORDER] };
        if degree == 3 {
            let (tt, ss, ts) = (times(t, t), times(rest, rest), times(t, rest));
            let (tts, sst) = (times(ts, t), times(ts, rest));
            weights.below[..3].copy_from_slice(&[ss, 2 * ts, tt]);
            weights.here[..4].copy_from_slice(&[ss - sst, 3 * sst, 3 * tts, tt - tts]);
            return weights;
        }
        weights.here[0] = 1 << FRACTION;
        for d in 1..=degree.min(MAX_DEGREE) {
            weights.below = weights.here;
            let mut before = 0;
            for weight in weights.here.iter_mut().take(d + 1) {
                let kept = times(*weight, rest);
                (*weight, before) = (kept + times(before, t), *weight);
            }
        }
        weights
    }
}

/// Σ weight·(to − from)/2 along the three axes; halves of differences fit 32 bits.
#[inline(always)]
fn add(sum: &mut [i64; 3], weight: u32, to: Option<&Point3>, from: Option<&Point3>) {
    let (Some(to), Some(from)) = (to, from) else { return };
    let weight = i64::from(weight as i32);
    for (sum, (to, from)) in sum.iter_mut().zip(to.to_array().into_iter().zip(from.to_array())) {
        *sum += weight * i64::from((to.to_bits() >> 1) - (from.to_bits() >> 1));
    }
}

/// The vectors shifted right or left by one common amount, to at most 29 bits and a sign.
fn shorten(vectors: &[[i64; 3]], out: &mut [[i32; 3]]) {
    let all = vectors.iter().flatten().fold(0, |all, c| all | (c ^ (c >> 63)));
    let shift = (64 - all.leading_zeros()).saturating_sub(29);
    for (out, vector) in out.iter_mut().zip(vectors) {
        *out = vector.map(|c| (c >> shift) as i32);
    }
}

/// The tangents of a piece, up to factors of either sign: along its rows and across them.
#[derive(Clone, Copy, Debug)]
pub(super) struct Tangents<'a> {
    net: SurfaceNet<'a>,
    along: [Grid; 2],
    turn: u8,
    /// Degrees along a row and across, and the strides in storage; of a tensor-product piece.
    degrees: (usize, usize),
    strides: (usize, usize),
    /// The row that the control vectors belong to.
    row: Option<u32>,
    /// Control vectors, along the row, of the tangent along it (one degree less) and of the one across.
    by_r: [[i32; 3]; ORDER],
    by_s: [[i32; 3]; ORDER],
}

impl<'a> Tangents<'a> {
    /// The tangents of `net` at the points of a lattice of it, or of its rounded net.
    pub(super) fn new(net: SurfaceNet<'a>, form: &Form<'_>) -> Self {
        let along = [form.steps.0, form.steps.1].map(|steps| Grid::of(steps, form.centred));
        let width = net.degrees().1 + 1;
        let strides = if form.turn() == 0 { (width, 1) } else { (1, width) };
        let zero = [[0; 3]; ORDER];
        Self { net, along, turn: form.turn(), degrees: form.degrees, strides, row: None, by_r: zero, by_s: zero }
    }

    /// The tangents at lattice point (i, j).
    pub(super) fn at(&mut self, i: u32, j: u32) -> [[i32; 3]; 2] {
        let (r, s) = (self.along[0].at(i), self.along[1].at(j));
        if self.net.is_triangle() {
            let s = s.min((1 << FRACTION) - r);
            return triangle(self.net.points(), self.degrees.0, unturned(self.turn, [r, s, (1 << FRACTION) - r - s]));
        }
        if self.row != Some(j) {
            self.row = Some(j);
            self.collapse(s);
        }
        let m = self.degrees.0.min(MAX_DEGREE);
        let weights = Weights::of(m, r);
        [dot(&weights.below[..m], &self.by_r), dot(&weights.here[..m + 1], &self.by_s)]
    }

    /// The control vectors along the row at parameter `s`: differences of its control values, and Σ of those across it.
    #[inline(never)]
    fn collapse(&mut self, s: u32) {
        let (m, h) = self.degrees;
        let weights = Weights::of(h, s);
        let (mut along, mut across) = ([[0_i64; 3]; ORDER], [[0_i64; 3]; ORDER]);
        for (a, (along, across)) in along.iter_mut().zip(&mut across).enumerate().take(m + 1) {
            let mut before = [0; 3];
            for b in 0..=h {
                let Some(p) = self.net.points().get(a * self.strides.0 + b * self.strides.1) else { return };
                // Halves of coordinates have 31 bits, of their differences 32.
                let here = [p.x, p.y, p.z].map(|c| c.to_bits() >> 1);
                let weight = weights.here.get(b).map_or(0, |w| i64::from(*w as i32));
                let below = b.checked_sub(1).and_then(|b| weights.below.get(b)).map_or(0, |w| i64::from(*w as i32));
                for axis in 0..3 {
                    along[axis] += weight * i64::from(here[axis]);
                    across[axis] += below * i64::from(here[axis] - before[axis]);
                }
                before = here;
            }
        }
        for a in 0..MAX_DEGREE {
            if a >= m {
                break;
            }
            let next = along[a + 1];
            along[a].iter_mut().zip(next).for_each(|(here, next)| *here = next - *here);
        }
        let (m, n) = (m.min(ORDER), (m + 1).min(ORDER));
        shorten(&along[..m], &mut self.by_r);
        shorten(&across[..n], &mut self.by_s);
    }
}

/// Σ weight·vector.
fn dot(weights: &[u32], vectors: &[[i32; 3]]) -> [i32; 3] {
    let mut sum = [0_i64; 3];
    for (weight, vector) in weights.iter().zip(vectors) {
        for (sum, c) in sum.iter_mut().zip(vector) {
            *sum += i64::from(*weight as i32) * i64::from(*c);
        }
    }
    sum.map(|c| (c >> FRACTION) as i32)
}

/// Room for the weights of a triangle of the degree below the highest.
const TRIANGLE: usize = MAX_DEGREE * (MAX_DEGREE + 1) / 2;

/// S_u and S_v of a triangular piece of this degree.
fn triangle(points: &[Point3], degree: usize, [u, v, w]: [u32; 3]) -> [[i32; 3]; 2] {
    // Weights of degree d from those of degree d − 1, from the last on: each looks at itself and two before it.
    let mut weights = [0_u32; TRIANGLE];
    weights[0] = 1 << FRACTION;
    for d in 1..degree.min(MAX_DEGREE) {
        for row in (0..=d).rev() {
            for k in (0..=row).rev() {
                // (i, j, k) with j + k = row, from (i − 1, j, k), (i, j − 1, k) and (i, j, k − 1).
                let get = |row: usize, k: usize| weights.get(triangle_index(row - k, k)).copied().unwrap_or(0);
                let from_u = if row < d { times(get(row, k), u) } else { 0 };
                let from_v = if row > k { times(get(row - 1, k), v) } else { 0 };
                let from_w = if k > 0 { times(get(row - 1, k - 1), w) } else { 0 };
                if let Some(weight) = weights.get_mut(triangle_index(row - k, k)) {
                    *weight = from_u + from_v + from_w;
                }
            }
        }
    }
    let mut sums = [[0_i64; 3]; 2];
    let mut index = 0;
    for row in 0..degree {
        for _ in 0..=row {
            let weight = weights.get(index).copied().unwrap_or(0);
            // b[i+1,j,k], b[i,j+1,k] and b[i,j,k+1] for the weight of (i, j, k).
            let (at_u, at_v, at_w) = (points.get(index), points.get(index + row + 1), points.get(index + row + 2));
            add(&mut sums[0], weight, at_u, at_w);
            add(&mut sums[1], weight, at_v, at_w);
            index += 1;
        }
    }
    let mut out = [[0; 3]; 2];
    for (out, sum) in out.chunks_mut(1).zip(sums.chunks(1)) {
        shorten(sum, out);
    }
    out
}

/// The least and the greatest control value of y, in 2^-16, of row `j` of a lattice; within 2^-14.
///
/// Tensor: the row is a curve with the control values Σ_b B_b(s)·y_ab. Triangle: it is the mean, with weights B_b(s), of
/// curves of the degrees n − b through the control points of row b.
pub(super) fn row_range(form: &Form<'_>, j: u32) -> (i64, i64) {
    let (m, h) = form.degrees;
    let weights = Weights::of(h, Grid::of(form.steps.1, form.centred).at(j)).here;
    if form.kind == Kind::Triangle {
        let (mut low, mut high) = (0, 0);
        for (b, weight) in weights.iter().enumerate().take(h + 1) {
            let row = (0..=form.last_row_entry(b)).map(|a| form.bits(1, a, b));
            low += i64::from(*weight) * row.clone().min().unwrap_or(0);
            high += i64::from(*weight) * row.max().unwrap_or(0);
        }
        return (low >> FRACTION, high >> FRACTION);
    }
    let (along, across) = if form.turn() == 0 { (h + 1, 1) } else { (1, m + 1) };
    let mut range = (i64::MAX, i64::MIN);
    for a in 0..=m {
        let mut value = 0;
        for (b, weight) in weights.iter().enumerate().take(h + 1) {
            let y = form.points().get(a * along + b * across).map_or(0, |p| p.y.to_bits());
            value += i64::from(*weight as i32) * i64::from(y);
        }
        range = (range.0.min(value), range.1.max(value));
    }
    (range.0 >> FRACTION, range.1 >> FRACTION)
}
