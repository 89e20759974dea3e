//! Sampling of pieces: hole-free counts in 32-bit arithmetic, and the narrowest accumulator by rounding the net.
//!
//! A piece is a part of a patch that is sampled on its own. Its counts must come cheap: most of them are only compared
//! with those of its own parts.

use super::budget::unused_bits;
use super::form::{Form, Kind};
use super::{Accumulator, Budget, LatticeError, MAX_STEPS, Sampling, Steps};
use crate::geometry::Point3;
use crate::patch::{MAX_DEGREE, Surface, SurfaceNet, triangle_index};

/// The fraction bits that a net keeps at least where its positions are rounded for a narrower accumulator.
const LEAST_FRACTION: u32 = 7;

/// How often z may be halved for a narrower accumulator: it then has at least 4 fraction bits.
const MOST_HALVINGS: u32 = 3;

/// How far lattice points may be from the patch: neighbours, also across a seam, are up to d = 2^-7 + 2^-12 or, where points
/// are exact, 2^-12 farther apart than the bound says, and a count has to exceed bound/(1 − d).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Slack {
    /// 2^-13: 2^-17 for each of at most 16 roundings at subdivision.
    Exact,
    /// And 2^-8, half a unit of [`LEAST_FRACTION`] bits, in nets that are rounded.
    Rounded,
}

impl Slack {
    /// Points are exact where a piece is of degree 3 or less; rational ones have the other slack.
    fn of(net: &SurfaceNet<'_>) -> Self {
        let (m, h) = net.degrees();
        if matches!(net, SurfaceNet::Tensor(_)) && m <= 3 && h <= 3 { Self::Exact } else { Self::Rounded }
    }

    /// The bound with 2^-11, or 2^-7 and 2^-11, more of itself.
    fn more(self, bound: u32) -> u32 {
        match self {
            Self::Exact => bound + (bound >> 11) + 1,
            Self::Rounded => bound + (bound >> 7) + (bound >> 11),
        }
    }

    /// A count, as a bound, less as much.
    fn less(self, n: u32) -> u32 {
        match self {
            Self::Exact => n - (n >> 11) - 1,
            Self::Rounded => n - (n >> 7) - (n >> 11) - 1,
        }
    }

    /// floor(slope with slack) + 1 steps.
    fn count(self, slope: u32) -> u32 {
        more_than(self.more(slope))
    }
}

/// Slopes are counted in 2^-9: differences of coordinates cut to 9 fraction bits have at most 25 bits and are less than
/// one unit off.
const SHORT: u32 = 9;

/// The bounds on |S_r|, |S_s| and, for a triangle, |S_u − S_v| along one axis, in 2^-9.
type Slopes = [u32; 3];

fn short(p: &Point3, axis: usize) -> i32 {
    let c = match axis {
        0 => p.x,
        1 => p.y,
        _ => p.z,
    };
    c.to_bits() >> (16 - SHORT)
}

/// One coordinate of the points of a bicubic.
#[inline(always)]
fn axis_of(points: &[Point3; 16], axis: usize) -> [i32; 16] {
    let mut values = [0; 16];
    for (value, p) in values.iter_mut().zip(points) {
        *value = short(p, axis);
    }
    values
}

/// The largest |difference| of neighbours times the degree, rounded up, for each family of net edges.
fn slopes(net: &SurfaceNet<'_>, axis: usize) -> Slopes {
    let (points, (m, h)) = (net.points(), net.degrees());
    let gap = |a: &Point3, b: &Point3| short(a, axis).abs_diff(short(b, axis)) + 1;
    let mut largest = [0; 3];
    if let Some(points) = points.first_chunk::<16>().filter(|_| (m, h) == (3, 3) && !net.is_triangle()) {
        let values = axis_of(points, axis);
        let along_r = values.iter().zip(&values[4..]).fold(0, |most: u32, (a, b)| a.abs_diff(*b).max(most));
        let rows = values.as_chunks::<4>().0.iter();
        let along_s =
            rows.fold(0, |most: u32, [a, b, c, d]| most.max(a.abs_diff(*b)).max(b.abs_diff(*c)).max(c.abs_diff(*d)));
        largest = [along_r + 1, along_s + 1, 0];
    } else if net.is_triangle() {
        for row in 0..m {
            let above = points.get(triangle_index(row, 0)..).unwrap_or_default();
            let below = points.get(triangle_index(row + 1, 0)..).unwrap_or_default();
            for ((p, q), next) in above.iter().zip(below).zip(below.iter().skip(1)).take(row + 1) {
                for (largest, gap) in largest.iter_mut().zip([gap(p, next), gap(q, next), gap(p, q)]) {
                    *largest = gap.max(*largest);
                }
            }
        }
    } else {
        for (p, q) in points.iter().zip(points.get(h + 1..).unwrap_or_default()) {
            largest[0] = gap(p, q).max(largest[0]);
        }
        for row in points.chunks_exact(h + 1) {
            for (p, q) in row.iter().zip(row.get(1..).unwrap_or_default()) {
                largest[1] = gap(p, q).max(largest[1]);
            }
        }
    }
    [largest[0] * m as u32, largest[1] * h as u32, largest[2] * m as u32]
}

/// floor(bound) + 1 steps.
fn more_than(bound: u32) -> u32 {
    (bound >> SHORT) + 1
}

/// The bounds on the slopes of a piece in x and y.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PieceSlopes {
    x: Slopes,
    y: Slopes,
    slack: Slack,
}

impl PieceSlopes {
    pub(crate) fn of(net: SurfaceNet<'_>) -> Self {
        Self { x: slopes(&net, 0), y: slopes(&net, 1), slack: Slack::of(&net) }
    }

    /// A bound along all axes, in 2^-9 unit, for a tensor-product net: at least the degree times every difference of
    /// neighbours, along z up to twice as much, or any bound below 2^16.
    pub(crate) fn steepest(&self, net: SurfaceNet<'_>) -> u32 {
        let (points, (m, h)) = (net.points(), net.degrees());
        let z = |p: &Point3| short(p, 2);
        let degree = m.max(h) as u32;
        let xy = self.largest();
        // Neighbours are at most twice as far apart as all are from one of them.
        let start = points.first().map_or(0, z);
        let far = points.iter().fold(0, |all, p| all | (z(p) - start) ^ ((z(p) - start) >> 31)) as u32;
        let most = (2 * far + 2) * degree;
        if most < 1 << 16 {
            return most.max(xy[0]).max(xy[1]);
        }
        let mut all = 0;
        let mut take = |p: &Point3, q: &Point3| all |= (z(p) - z(q)) ^ ((z(p) - z(q)) >> 31);
        points.iter().zip(points.get(h + 1..).unwrap_or_default()).for_each(|(p, q)| take(p, q));
        for row in points.chunks_exact(h + 1) {
            row.iter().zip(row.get(1..).unwrap_or_default()).for_each(|(p, q)| take(p, q));
        }
        // One more than all bits that differences have; and one unit that each may be off.
        ((all as u32 + 2) * degree).max(xy[0]).max(xy[1])
    }

    /// The larger of x and y, for each family of net edges.
    fn largest(&self) -> Slopes {
        core::array::from_fn(|d| self.x[d].max(self.y[d]))
    }

    /// Whether a tensor-product piece takes more steps along s than along r.
    pub(crate) fn is_longer_along_s(&self) -> bool {
        let [a, b, _] = self.largest();
        b > a
    }

    /// No hole-free lattice of a polynomial tensor-product piece has fewer points.
    pub(crate) fn least_points(&self) -> u64 {
        let [a, b, _] = self.largest();
        u64::from(self.slack.count(a) + 1) * u64::from(self.slack.count(b) + 1)
    }

    /// The cheapest hole-free sampling of the piece, with the slack that seams between pieces need; `centres`: those of
    /// cells may be used. `S`: what the net can be.
    pub(crate) fn sampling<S: Surface>(&self, net: SurfaceNet<'_>, centres: bool) -> Sampling {
        if S::SHAPE.rational && net.weights().is_some() {
            let plain = || Sampling { steps: Steps::hole_free(net), centres };
            let Sampling { steps, centres } = if centres { Sampling::cheapest(net) } else { plain() };
            let more = |n: u32| (self.slack.more(n) + 1).min(MAX_STEPS + 1);
            return Sampling { steps: Steps { r: more(steps.r), s: more(steps.s) }, centres };
        }
        let [a, b, c] = self.largest();
        if S::SHAPE.triangles && net.is_triangle() {
            // The centres of cells make up for the longest family of edges.
            let longest = a.max(b).max(c);
            let others = a.max(b).min(b.max(c)).min(a.max(c));
            let (coarse, fine) = (self.slack.count(others), self.slack.count(longest));
            return cheaper(net, Steps { r: fine, s: fine }, centres.then_some(Steps { r: coarse, s: coarse }));
        }
        let coarse = Steps { r: self.slack.count(a), s: self.slack.count(b) };
        cheaper(net, tensor_steps(net.points(), net.degrees(), a, b, self.slack), centres.then_some(coarse))
    }

    /// The turn of a lattice whose rows change y the least: then bands leave out the most of them. A triangle with centres
    /// is turned so that they lie on its longest family of edges.
    pub(crate) fn turn(&self, triangle: bool, centres: bool) -> u8 {
        let y = self.y;
        if !triangle {
            return (y[1] < y[0]).into();
        }
        // Turned by 0, 1, 2, rows run along families 0, 1, 2, and cells are halved along families 2, 0, 1.
        if centres {
            let [a, b, c] = self.largest();
            return if c >= a.max(b) { 0 } else { 1 + u8::from(b > a) };
        }
        if y[2] < y[0].min(y[1]) { 2 } else { (y[1] < y[0]).into() }
    }
}

fn cheaper(net: SurfaceNet<'_>, plain: Steps, coarse: Option<Steps>) -> Sampling {
    let points = |sampling: &Sampling| sampling.points(net.is_triangle());
    let plain = Sampling { steps: plain, centres: false };
    let coarse = coarse.map(|steps| Sampling { steps, centres: true });
    coarse.filter(|coarse| points(coarse) < points(&plain)).unwrap_or(plain)
}

impl Sampling {
    /// The points of the lattice, and of its cells' centres where they are sampled.
    pub(crate) fn points(self, triangle: bool) -> u64 {
        let (r, s) = (u64::from(self.steps.r), u64::from(self.steps.s));
        match (triangle, self.centres) {
            (true, false) => (r + 1) * (r + 2) / 2,
            (true, true) => (r + 1) * (r + 1),
            (false, false) => (r + 1) * (s + 1),
            (false, true) => (r + 1) * (s + 1) + r * s,
        }
    }
}

/// The hole-free steps of a polynomial tensor patch with bounds a and b on |S_r| and |S_s|, from magnitudes p and q of 15
/// bits, rounded up.
///
/// A pair of coefficients of S_r and S_s with the sign that the cell's diagonal cancels differs by less than the larger
/// of |S_r|/n_r, |S_s|/n_s < 1; pairs that add up ask for p/n_r + q/n_s < 1. Three candidates: n_r : n_s = a : b
/// ([`Steps::hole_free`]), the least n_r, the least n_s. With the slack d the sums have to be below 1 − d, which with the
/// least n_r asks for n_s > q·n_r/((1 − d)·n_r − p).
fn tensor_steps(points: &[Point3], degrees: (usize, usize), a: u32, b: u32, slack: Slack) -> Steps {
    let shift = (32 - (a | b).leading_zeros()).saturating_sub(15);
    let [along_r, along_s] = [a, b].map(|bound| (bound >> shift) + 1);
    let least = [along_r, along_s].map(|bound| slack.count(bound << shift));
    // In the unit of p and q.
    let scaled = least.map(|n| (n << SHORT) >> shift);
    let [room_r, room_s] = scaled.map(|n| slack.less(n));
    let enough = along_r * along_s;
    let mut diagonals = [Diagonal::default(); 2];
    // In memory: as variables, which of the two it is would be asked for at every step.
    let both = core::hint::black_box(&mut diagonals);
    let up = MAX_DEGREE as u32 + (1 << shift);
    let pair = |by_r: i32, by_s: i32| {
        let [p, q] = [by_r, by_s].map(|slope| (slope.unsigned_abs() + up) >> shift);
        let diagonal = &mut both[usize::from(by_r ^ by_s >= 0)];
        // Most pairs ask for less than one before.
        if p <= diagonal.largest[0] && q <= diagonal.largest[1] {
            return;
        }
        let sum = p * along_s + q * along_r;
        if sum <= enough {
            return;
        }
        if sum > diagonal.sum {
            (diagonal.sum, diagonal.largest) = (sum, [p, q]);
        }
        diagonal.for_s.raise(q, room_r.saturating_sub(p));
        diagonal.for_r.raise(p, room_s.saturating_sub(q));
    };
    match points.first_chunk::<16>().filter(|_| degrees == (3, 3)) {
        Some(points) => each_bicubic_pair(points, pair),
        None => each_pair(points, degrees, pair),
    }
    let candidates = diagonals.into_iter().flat_map(|diagonal| {
        let k = diagonal.sum.max(enough);
        let balanced = |other: u32| slack.count(k.checked_div(other).unwrap_or(0) << shift);
        let beside = |ratio: Ratio, other: u32, least: u32| {
            ratio.times(other).map_or(MAX_STEPS + 1, |bound| more_than(bound << shift).max(least))
        };
        [
            Steps { r: balanced(along_s), s: balanced(along_r) },
            Steps { r: least[0], s: beside(diagonal.for_s, scaled[0], least[1]) },
            Steps { r: beside(diagonal.for_r, scaled[1], least[0]), s: least[1] },
        ]
    });
    let points = |steps: &Steps| u64::from(steps.r + 1) * u64::from(steps.s + 1);
    candidates.min_by_key(points).unwrap_or(Steps { r: MAX_STEPS + 1, s: MAX_STEPS + 1 })
}

/// [`each_pair`] for a bicubic.
fn each_bicubic_pair(points: &[Point3; 16], mut f: impl FnMut(i32, i32)) {
    // Elevated differences of a row or column of four.
    let elevated = |[a, b, c, d]: [i32; 4]| {
        let [u, v, w] = [b - a, c - b, d - c];
        [3 * u, u + 2 * v, 2 * v + w, 3 * w]
    };
    for axis in 0..2 {
        let values = axis_of(points, axis);
        let mut by_s = [[0; 4]; 4];
        for (by_s, row) in by_s.iter_mut().zip(values.as_chunks::<4>().0) {
            *by_s = elevated(*row);
        }
        // Corners first: there slopes are often largest. Masked, so that no check is left at any level of optimisation.
        for j in [0, 3, 1, 2] {
            let value = |i: usize| values[(4 * i + j) & 15];
            let by_r = elevated([value(0), value(1), value(2), value(3)]);
            for i in [0, 3, 1, 2] {
                f(by_r[i & 3], by_s[i & 3][j & 3]);
            }
        }
    }
}

/// Calls `f` for the Bernstein coefficients of S_r and S_s along x and y, both of degree (m, h), in 2^-9; each is less than
/// eight units off.
fn each_pair(points: &[Point3], (m, h): (usize, usize), mut f: impl FnMut(i32, i32)) {
    for axis in 0..2 {
        let at = |i: usize, j: usize| points.get(i * (h + 1) + j).map_or(0, |p| short(p, axis));
        for i in 0..=m {
            for j in 0..=h {
                let here = at(i, j);
                // Elevation: k·e_(k−1) + (n − k)·e_k of the differences e.
                let before = if i > 0 { i as i32 * (here - at(i - 1, j)) } else { 0 };
                let by_r = if i < m { before + (m - i) as i32 * (at(i + 1, j) - here) } else { before };
                let before = if j > 0 { j as i32 * (here - at(i, j - 1)) } else { 0 };
                let by_s = if j < h { before + (h - j) as i32 * (at(i, j + 1) - here) } else { before };
                f(by_r, by_s);
            }
        }
    }
}

/// What the pairs that add up along one diagonal ask for.
#[derive(Clone, Copy, Debug, Default)]
struct Diagonal {
    sum: u32,
    /// The pair with the largest sum.
    largest: [u32; 2],
    for_r: Ratio,
    for_s: Ratio,
}

/// The largest of some ratios of 16-bit numbers; a denominator of 0 is infinite.
#[derive(Clone, Copy, Debug)]
struct Ratio {
    numerator: u32,
    denominator: u32,
}

impl Default for Ratio {
    fn default() -> Self {
        Self { numerator: 0, denominator: 1 }
    }
}

impl Ratio {
    fn raise(&mut self, numerator: u32, denominator: u32) {
        if numerator * self.denominator > self.numerator * denominator {
            *self = Self { numerator, denominator };
        }
    }

    /// The ratio times a 16-bit factor, rounded up; `None` for infinity, or more than 2^16.
    fn times(self, factor: u32) -> Option<u32> {
        (self.numerator * factor).checked_div(self.denominator).map(|ratio| ratio + 1).filter(|ratio| *ratio < 1 << 16)
    }
}

/// K: the longest step of any coordinate in whole units, rounded up, at least 1. Steps of x and y are below 1.
fn longest_step(net: &SurfaceNet<'_>, (r, s): (u32, u32)) -> u32 {
    let units = |slope: u32, steps: u32| (slope >> SHORT).checked_div(steps).unwrap_or(slope >> SHORT) + 1;
    let [a, b, _] = slopes(net, 2);
    units(a, r).max(units(b, s)).min(1 << 16)
}

/// The budget of a lattice of a piece, and how often z has to be halved for it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PieceBudget {
    pub(crate) budget: Budget,
    pub(crate) halvings: u32,
}

/// The budget of a polynomial piece: 32 bits where the net, rounded to at least [`LEAST_FRACTION`] bits, fits and the
/// degree is at most 3; then 64, then 128. [`Budget::fraction_bits`] tells what to round to. z counts in steps of 2, 4 or
/// 8 units where it moves faster than x and y.
///
/// # Errors
/// [`LatticeError::Budget`] where 128 bits are too few.
pub(crate) fn piece_budget(net: SurfaceNet<'_>, form: &Form<'_>) -> Result<PieceBudget, LatticeError> {
    let longest = longest_step(&net, form.steps);
    let halvings = (longest - 1).checked_ilog2().map_or(0, |bits| bits + 1).min(MOST_HALVINGS);
    let longest = (longest >> halvings) + u32::from(longest & ((1 << halvings) - 1) != 0);
    // Halved coordinates use more bits.
    let used = 16 - unused_bits(form).saturating_sub(halvings);
    Ok(PieceBudget { budget: budget(form, longest, used)?, halvings })
}

/// Checks that a polynomial patch of this sampling can be split into pieces that have a budget, quartering it `depth`
/// times at most: the first differences of a net halve with each.
pub(crate) fn deepest_budget(net: SurfaceNet<'_>, sampling: Sampling, depth: u32) -> Result<(), LatticeError> {
    let Steps { r, s } = sampling.steps;
    let largest_step = longest_step(&net, (r, s)).saturating_add(1);
    // A budget below 2^128 at the last level; one of 64 bits on the way ends splitting earlier.
    let steps = ((r >> depth) + 2, (s >> depth) + 2);
    budget(&Form::surface(net, steps), largest_step, 16).map(drop)
}

/// n^exponent, in 64 bits while it fits.
fn power(n: u32, exponent: usize) -> Option<u128> {
    let (n, mut power, mut left) = (u64::from(n), 1_u64, exponent);
    while left > 0 {
        match power.checked_mul(n) {
            Some(next) => power = next,
            None => return u128::from(power).checked_mul(u128::from(n).checked_pow(left as u32)?),
        }
        left -= 1;
    }
    Some(power.into())
}

/// The budget of a net that uses so many fraction bits.
fn budget(form: &Form<'_>, largest_step: u32, used: u32) -> Result<Budget, LatticeError> {
    let (r, s) = form.table_steps();
    let exponent = if form.kind == Kind::Tensor { form.degrees.1 } else { 0 };
    let cells = power(r, form.degrees.0).zip(power(s, exponent)).and_then(|(r, s)| {
        let short = u64::try_from(r).ok().zip(u64::try_from(s).ok()).and_then(|(r, s)| r.checked_mul(s));
        short.map(u128::from).or_else(|| r.checked_mul(s))
    });
    let least = used.min(LEAST_FRACTION);
    let values = cells.and_then(|cells| cells.checked_mul(2 * u128::from(largest_step) + 1));
    let free = values.map_or(0, u128::leading_zeros);
    let accumulator = match 128_u32.saturating_sub(free) + least {
        ..=32 if form.degree() < 4 => Some(Accumulator::I32),
        ..=64 => Some(Accumulator::I64),
        ..=128 if values.is_some() => Some(Accumulator::I128),
        _ => None,
    };
    match (cells, accumulator) {
        (Some(cells), Some(accumulator)) => {
            let width = 32 << accumulator as u32;
            let fraction_bits = (width + free).saturating_sub(128).min(used);
            let scale = cells << fraction_bits;
            Ok(Budget { accumulator, scale, fraction_bits, largest_step, weight_shift: 0 })
        }
        _ => Err(LatticeError::Budget { degrees: form.degrees, steps: form.steps, fraction_bits: least, bits: 129 }),
    }
}
