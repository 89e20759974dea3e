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

/// The Bernstein weights of degrees 2 and 3.
#[inline(always)]
fn cubic(t: u32) -> ([i32; 3], [i32; 4]) {
    let rest = (1 << FRACTION) - t;
    let (tt, ss, ts) = (times(t, t), times(rest, rest), times(t, rest));
    let (tts, sst) = (times(ts, t), times(ts, rest));
    ([ss, 2 * ts, tt].map(|w| w as i32), [ss - sst, 3 * sst, 3 * tts, tt - tts].map(|w| w as i32))
}

/// The product of two 32-bit numbers.
#[inline(always)]
fn product(a: i32, b: i32) -> i64 {
    i64::from(a) * i64::from(b)
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
    /// How often the differences of a bicubic can be doubled.
    doublings: Option<u32>,
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
        Self {
            net,
            along,
            turn: form.turn(),
            degrees: form.degrees,
            strides,
            doublings: None,
            row: None,
            by_r: zero,
            by_s: zero,
        }
    }

    /// The tangents 1/64 of the way from lattice point (i, j) inwards: where those at the point span no plane.
    #[cold]
    #[inline(never)]
    pub(super) fn inside(&mut self, i: u32, j: u32) -> [[i32; 3]; 2] {
        let share = if self.net.is_triangle() { 61 } else { 62 };
        let inwards = |t: u32| (1 << (FRACTION - 6)) + (t >> 6) * share;
        let (r, s) = (inwards(self.along[0].at(i)), inwards(self.along[1].at(j)));
        self.row = None;
        self.at_parameters(r, s, None)
    }

    /// The tangents at lattice point (i, j).
    pub(super) fn at(&mut self, i: u32, j: u32) -> [[i32; 3]; 2] {
        self.at_parameters(self.along[0].at(i), self.along[1].at(j), Some(j))
    }

    /// The tangents at parameters; `row` is the number of the row where it may be used again.
    #[inline(always)]
    fn at_parameters(&mut self, r: u32, s: u32, row: Option<u32>) -> [[i32; 3]; 2] {
        if self.net.is_triangle() {
            let s = s.min((1 << FRACTION) - r);
            return triangle(self.net.points(), self.degrees.0, unturned(self.turn, [r, s, (1 << FRACTION) - r - s]));
        }
        if row.is_none() || self.row != row {
            self.row = row;
            self.collapse(s);
        }
        if self.degrees == (3, 3) {
            let (below, here) = cubic(r);
            let ([a, b, c, ..], [d, e, f, g, ..]) = (&self.by_r, &self.by_s);
            let mut out = [[0; 3]; 2];
            for axis in 0..3 {
                let along = product(below[0], a[axis]) + product(below[1], b[axis]) + product(below[2], c[axis]);
                let across = product(here[0], d[axis]) + product(here[1], e[axis]);
                let across = across + product(here[2], f[axis]) + product(here[3], g[axis]);
                (out[0][axis], out[1][axis]) = ((along >> FRACTION) as i32, (across >> FRACTION) as i32);
            }
            return out;
        }
        let m = self.degrees.0.min(MAX_DEGREE);
        let weights = Weights::of(m, r);
        [dot(&weights.below[..m], &self.by_r), dot(&weights.here[..m + 1], &self.by_s)]
    }

    /// The control vectors along the row at parameter `s`: differences of its control values, and Σ of those across it.
    #[inline(never)]
    fn collapse(&mut self, s: u32) {
        if let Some(points) = self.net.points().first_chunk::<16>().filter(|_| self.degrees == (3, 3)) {
            self.collapse_bicubic(points, s);
        } else {
            self.collapse_any(s);
        }
    }

    /// [`collapse`](Self::collapse) for any degrees.
    #[inline(never)]
    fn collapse_any(&mut self, s: u32) {
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

impl Tangents<'_> {
    /// [`collapse`](Self::collapse) for a bicubic. Coordinates are taken from the first point and doubled until the largest
    /// has 30 bits; then the upper halves of the sums are what is wanted.
    fn collapse_bicubic(&mut self, points: &[Point3; 16], s: u32) {
        let halves = |p: &Point3| [p.x.to_bits() >> 1, p.y.to_bits() >> 1, p.z.to_bits() >> 1];
        let origin = halves(&points[0]);
        let doublings = *self.doublings.get_or_insert_with(|| {
            let mut all = 0;
            for p in points {
                let [x, y, z] = halves(p);
                let apart = |c: i32, o: i32| (c - o) ^ ((c - o) >> 31);
                all |= apart(x, origin[0]) | apart(y, origin[1]) | apart(z, origin[2]);
            }
            (all as u32 | 1).leading_zeros().saturating_sub(2)
        });
        let (below, here) = cubic(s);
        let mut before = [0_i64; 3];
        for a in 0..4 {
            let mut row = [[0; 4]; 3];
            for b in 0..4 {
                let [x, y, z] = halves(&points[(a * self.strides.0 + b * self.strides.1) & 15]);
                row[0][b] = (x - origin[0]) << doublings;
                row[1][b] = (y - origin[1]) << doublings;
                row[2][b] = (z - origin[2]) << doublings;
            }
            for axis in 0..3 {
                let [p, q, r, s] = row[axis];
                let value = product(here[0], p) + product(here[1], q) + product(here[2], r) + product(here[3], s);
                let slope = product(below[0], q - p) + product(below[1], r - q) + product(below[2], s - r);
                self.by_s[a][axis] = (slope >> 32) as i32;
                if a > 0 {
                    self.by_r[a - 1][axis] = ((value - before[axis]) >> 32) as i32;
                }
                before[axis] = value;
            }
        }
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
    let s = Grid::of(form.steps.1, form.centred).at(j);
    if let Some(points) = form.points().first_chunk::<16>().filter(|_| (m, h) == (3, 3)) {
        return bicubic_range(points, form.turn(), s);
    }
    let weights = Weights::of(h, s).here;
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

/// [`row_range`] for a bicubic.
fn bicubic_range(points: &[Point3; 16], turn: u8, s: u32) -> (i64, i64) {
    let (_, here) = cubic(s);
    let (along, across) = if turn == 0 { (4, 1) } else { (1, 4) };
    let mut range = (i32::MAX, i32::MIN);
    for a in 0..4 {
        let y = |b: usize| points[(a * along + b * across) & 15].y.to_bits();
        let value = product(here[0], y(0)) + product(here[1], y(1)) + product(here[2], y(2)) + product(here[3], y(3));
        let value = (value >> FRACTION) as i32;
        range = (range.0.min(value), range.1.max(value));
    }
    (range.0.into(), range.1.into())
}
