//! What splitting a tensor-product piece would gain, from its net alone: no part is made to be looked at.
//!
//! A difference of a half is a de Casteljau value of the differences of the whole, so the largest one of each half comes
//! from one triangle of sums per row of differences. Weights are left out: this chooses between samplings that are all
//! right.

use crate::geometry::Point3;
use crate::patch::{MAX_DEGREE, SurfaceNet};

/// The largest differences of a piece, of x and y, along r and along s, in 2^-7.
type Spans = [[u32; 2]; 2];

/// The largest differences of the halves of a piece.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Estimate {
    degrees: (usize, usize),
    /// Halves along r, then halves along s.
    halves: [[Spans; 2]; 2],
}

/// Coordinates are cut to 7 fraction bits: a difference then has at most 23 bits, 128 times one 30.
const DROP: u32 = 9;

impl Estimate {
    /// Cost: about 30 additions per control point of a bicubic.
    pub(crate) fn of(net: SurfaceNet<'_>) -> Self {
        let (m, h) = net.degrees();
        let points = net.points();
        let mut estimate = Self { degrees: (m, h), ..Self::default() };
        for axis in 0..2 {
            let short = |p: &Point3| (if axis == 0 { p.x } else { p.y }).to_bits() >> DROP;
            if let Some(points) = points.first_chunk::<16>().filter(|_| (m, h) == (3, 3)) {
                let mut values = [0; 16];
                for (value, p) in values.iter_mut().zip(points) {
                    *value = short(p);
                }
                estimate.add_bicubic(axis, &values);
                continue;
            }
            let at = |a: usize, b: usize| points.get(a * (h + 1) + b).map_or(0, short);
            for b in 0..=h {
                estimate.add(axis, (0, 0), (0..m).map(|a| at(a + 1, b) - at(a, b)));
            }
            for a in 0..m {
                estimate.add(axis, (0, 1), (0..=h).map(|b| at(a + 1, b) - at(a, b)));
            }
            for b in 0..h {
                estimate.add(axis, (1, 0), (0..=m).map(|a| at(a, b + 1) - at(a, b)));
            }
            for a in 0..=m {
                estimate.add(axis, (1, 1), (0..h).map(|b| at(a, b + 1) - at(a, b)));
            }
        }
        estimate
    }

    /// [`of`](Self::of) for a bicubic.
    fn add_bicubic(&mut self, axis: usize, v: &[i32; 16]) {
        let mut spans = [[[0_u32; 2]; 2]; 2]; // [along][half][of]
        for k in 0..4 {
            let column = [v[k], v[4 + k], v[8 + k], v[12 + k]];
            let row = [v[4 * k], v[4 * k + 1], v[4 * k + 2], v[4 * k + 3]];
            for (way, [a, b, c, d]) in [column, row].into_iter().enumerate() {
                let [u, v, w] = [b - a, c - b, d - c];
                let middle = ((u + 2 * v + w) >> 3).unsigned_abs();
                let ends = [[u >> 1, (u + v) >> 2], [w >> 1, (v + w) >> 2]];
                for (half, [one, two]) in ends.into_iter().enumerate() {
                    let most = one.unsigned_abs().max(two.unsigned_abs()).max(middle);
                    spans[way][half][way] = spans[way][half][way].max(most);
                }
            }
        }
        for k in 0..3 {
            let across = |at: usize, step: usize| v[(at + step) & 15] - v[at & 15];
            let rows: [i32; 4] = core::array::from_fn(|j| across(4 * k + j, 4));
            let columns: [i32; 4] = core::array::from_fn(|i| across(4 * i + k, 1));
            for (of, [a, b, c, d]) in [rows, columns].into_iter().enumerate() {
                let middle = ((a + 3 * (b + c) + d) >> 3).unsigned_abs();
                let ends = [[a, (a + b) >> 1, (a + 2 * b + c) >> 2], [d, (c + d) >> 1, (b + 2 * c + d) >> 2]];
                for (half, ends) in ends.into_iter().enumerate() {
                    let most = ends.iter().fold(middle, |most, v| v.unsigned_abs().max(most));
                    spans[1 - of][half][of] = spans[1 - of][half][of].max(most);
                }
            }
        }
        for (halves, spans) in self.halves.iter_mut().zip(spans) {
            for (half, spans) in halves.iter_mut().zip(spans) {
                half[axis & 1] = spans;
            }
        }
    }

    /// Takes account of differences along direction `of` of the two halves along direction `along`.
    fn raise(&mut self, axis: usize, (of, along): (usize, usize), halves: [[i32; 3]; 2]) {
        let Some(spans) = self.halves.get_mut(along) else { return };
        for (spans, values) in spans.iter_mut().zip(halves) {
            if let Some(span) = spans.get_mut(axis).and_then(|spans| spans.get_mut(of)) {
                *span = values.iter().fold(*span, |most, v| v.unsigned_abs().max(most));
            }
        }
    }

    /// Takes account of a row of differences along direction `of`, as they follow each other along direction `along`.
    fn add(&mut self, axis: usize, way: (usize, usize), differences: impl Iterator<Item = i32>) {
        let mut values = [0; MAX_DEGREE + 1];
        let mut count = 0;
        for (value, difference) in values.iter_mut().zip(differences) {
            *value = difference;
            count += 1;
        }
        // Differences along the direction that is halved are half as long.
        let shift = u32::from(way.0 == way.1);
        for level in 0..count {
            let last = count - 1 - level;
            let (Some(left), Some(right)) = (values.first().copied(), values.get(last).copied()) else { return };
            let halved = level as u32 + shift;
            self.raise(axis, way, [[left >> halved; 3], [right >> halved; 3]]);
            for k in 0..last.min(MAX_DEGREE) {
                values[k] += values[k + 1];
            }
        }
    }

    /// About the points of the cheapest hole-free lattice: without pairs of coefficients, as if the largest of x_r and
    /// x_s met, and added up.
    fn cost(&self, [x, y]: Spans) -> u64 {
        let slope = |span: u32, degree: usize| u64::from(span) * degree as u64 + 1;
        let (m, h) = self.degrees;
        let ([x_r, y_r], [x_s, y_s]) = ([x[0], y[0]].map(|v| slope(v, m)), [x[1], y[1]].map(|v| slope(v, h)));
        let (a, b) = (x_r.max(y_r), x_s.max(y_s));
        let k = (a * b).max(x_r * b + x_s * a).max(y_r * b + y_s * a);
        let steps = |bound: u64| (bound >> 7) + 2;
        let balanced = |other: u64| steps(k.checked_div(other).unwrap_or(0));
        (balanced(a) * balanced(b)).min(2 * steps(a) * steps(b))
    }

    /// Whether halving along s promises fewer points than halving along r.
    pub(crate) fn prefers_s(&self) -> bool {
        let [r, s] = self.halves.map(|[one, two]| self.cost(one) + self.cost(two));
        s < r
    }
}
