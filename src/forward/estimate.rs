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
        match net.degrees() {
            (3, 3) => Self::with_degrees(net.points(), (3, 3)),
            degrees => Self::with_degrees(net.points(), degrees),
        }
    }

    #[inline(always)]
    fn with_degrees(points: &[Point3], (m, h): (usize, usize)) -> Self {
        let mut estimate = Self { degrees: (m, h), ..Self::default() };
        for axis in 0..2 {
            let at = |a: usize, b: usize| {
                points.get(a * (h + 1) + b).map_or(0, |p| {
                    let c = if axis == 0 { p.x } else { p.y };
                    c.to_bits() >> DROP
                })
            };
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

    /// Takes account of a row of differences along direction `of`, as they follow each other along direction `along`.
    #[inline(always)]
    fn add(&mut self, axis: usize, way: (usize, usize), differences: impl Iterator<Item = i32>) {
        let mut values = [0; MAX_DEGREE + 1];
        let mut count = 0;
        for (value, difference) in values.iter_mut().zip(differences) {
            *value = difference;
            count += 1;
        }
        self.add_values(axis, way, &mut values, count);
    }

    #[inline(always)]
    fn add_values(
        &mut self,
        axis: usize,
        (of, along): (usize, usize),
        values: &mut [i32; MAX_DEGREE + 1],
        count: usize,
    ) {
        // Differences along the direction that is halved are half as long.
        let shift = u32::from(of == along);
        let (mut first, mut second) = (0, 0);
        for level in 0..count {
            let last = count - 1 - level;
            let (Some(left), Some(right)) = (values.first().copied(), values.get(last).copied()) else { return };
            let least = level as u32 + shift;
            first = first.max(left.unsigned_abs() >> least);
            second = second.max(right.unsigned_abs() >> least);
            for k in 0..last.min(MAX_DEGREE) {
                values[k] += values[k + 1];
            }
        }
        if let Some([one, two]) = self.halves.get_mut(along) {
            for (spans, most) in [(one, first), (two, second)] {
                if let Some(span) = spans.get_mut(axis).and_then(|spans| spans.get_mut(of)) {
                    *span = most.max(*span);
                }
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
