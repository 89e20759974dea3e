//! The walk over a curve in the plane: x and y only, unit steps, the bits below a pixel, little flash and stack.
//!
//! One incremental quotient serves both kinds of curves: x = A/D with A = Σ w P B·N and D = Σ w B·N, which is the
//! constant N for a polynomial. For the current integer x the differences of T = x·D − A and of D are kept; a step
//! adds differences to both, and where T leaves −D/2 < T ≤ D/2, x moves by one unit and T by D. So x is
//! floor(A/D + 1/2), as in `quotient`; there steps may be long and the net a surface.
//!
//! T after a step of at most one unit lies in ±(3/2)·D: signed compares are right while 3·D_max < 2^w, which is the
//! budget's (2K+1)·N < 2^w with K = 1. All else is arithmetic modulo 2^w.

use super::form::Form;
use super::table::{differences, to_newton};
use super::{Accumulator, Budget, LatticeError, Steps};
use crate::geometry::Point3;
use crate::num::{BINOMIAL, Coord, I16F16, Word};
use crate::patch::{CurveNet, MAX_DEGREE, RationalCurveNet};

/// The differences of the highest degree.
const ORDER: usize = MAX_DEGREE + 1;

/// The control points and weights of a curve of degree 1 to 8, checked.
pub(crate) type PlaneNet<'a> = (&'a [Point3], Option<&'a [I16F16]>);

/// The plan of a curve's lattice in the plane.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub(crate) struct PlanePlan {
    /// n.
    pub(crate) steps: u32,
    /// At least one, so that every D is even and D/2 exact.
    fraction_bits: u8,
    weight_shift: u8,
    /// Whether 64 bits do not hold 3·D_max.
    wide: bool,
}

impl PlanePlan {
    /// Plans n = max(⌈B⌉, ⌈16·(m − 1 + W)⌉) steps: B is the bound on |x'| and |y'|, W = m·max|Δw|/min w.
    ///
    /// * n ≥ B: x and y move by at most one unit a step.
    /// * n ≥ 16·(m − 1 + W): chords are within √2/64 of the curve. With (A − cD)'' = x''·D + 2x'·D' + (x − c)·D'' about
    ///   the centre c, and each second derivative at most 2(m − 1) times the bound on the first, |x''| ≤ 2B·(m − 1 + W).
    ///   So a chord is off by at most |x''|/(8n²) ≤ B·(m − 1 + W)/(4n²) ≤ 1/64 along each axis.
    pub(crate) fn of((points, weights): PlaneNet<'_>) -> Result<Self, LatticeError> {
        // z neither moves nor counts; half a unit keeps one fraction bit in use.
        let mut flat = [Point3::from_bits(0, 0, 1 << 15); ORDER];
        for (flat, p) in flat.iter_mut().zip(points) {
            (flat.x, flat.y) = (p.x, p.y);
        }
        let net = CurveNet::of_checked(flat.get(..points.len()).unwrap_or(&flat));
        let rational = weights.map(|weights| RationalCurveNet::of_checked(net, weights));
        let unit_steps = rational.map_or_else(|| Steps::curve(net), Steps::rational_curve);
        let steps = unit_steps.max(smooth_steps(net.degree() as u64, weights.unwrap_or(&[])));
        let form = rational.map_or_else(|| Form::curve(net, steps), |net| Form::rational_curve(net, steps));
        let budget = Budget::of(&form)?;
        let units = budget.largest_step;
        if units > 1 {
            return Err(LatticeError::LongStep { units, needed: (steps.saturating_mul(units), 1) });
        }
        let (fraction_bits, weight_shift) = (budget.fraction_bits as u8, budget.weight_shift as u8);
        Ok(Self { steps, fraction_bits, weight_shift, wide: budget.accumulator == Accumulator::I128 })
    }
}

/// ⌈16·(m − 1 + W)⌉.
fn smooth_steps(degree: u64, weights: &[I16F16]) -> u32 {
    let bits = |w: &I16F16| w.bits().unsigned_abs();
    let least = weights.iter().map(bits).min().unwrap_or(1);
    let pairs = weights.iter().zip(weights.iter().skip(1));
    let largest = pairs.map(|(a, b)| bits(a).abs_diff(bits(b))).max().unwrap_or(0);
    // Below 2^39, and `least` is positive.
    let uneven = (16 * degree * largest + least - 1).checked_div(least).unwrap_or(0);
    u32::try_from(16 * (degree - 1) + uneven).unwrap_or(u32::MAX)
}

/// A walk with the accumulator that it needs.
#[derive(Clone, Debug)]
#[allow(clippy::large_enum_variant, reason = "no heap; half a kilobyte")]
pub(crate) enum PlaneWalk {
    Narrow(PlaneWalker<i64>),
    Wide(PlaneWalker<i128>),
}

impl PlaneWalk {
    /// The walk over a net by its plan.
    pub(crate) fn new(net: PlaneNet<'_>, plan: &PlanePlan) -> Self {
        if plan.wide { Self::Wide(PlaneWalker::new(net, plan)) } else { Self::Narrow(PlaneWalker::new(net, plan)) }
    }
}

/// A walk over the lattice of a curve. It stands at a point.
#[derive(Clone, Debug)]
pub(crate) struct PlaneWalker<W> {
    point: [i32; 2],
    /// Differences of T per axis, and of D.
    t: [[W; ORDER]; 2],
    d: [W; ORDER],
    /// How many differences of T and of D change from step to step.
    degrees: (usize, usize),
    left: u32,
}

impl<W: Word> PlaneWalker<W> {
    #[inline(never)]
    fn new((points, weights): PlaneNet<'_>, plan: &PlanePlan) -> Self {
        let weight = |a: usize| weights.and_then(|w| w.get(a)).map_or(1, |w| w.bits() >> plan.weight_shift);
        let drop = 16 - u32::from(plan.fraction_bits);
        let degree = points.len().saturating_sub(1).min(MAX_DEGREE);
        let row = |value: &dyn Fn(usize, &Point3) -> i64| newton(points, value, degree, plan.steps);
        let d: [W; ORDER] = row(&|a, _| weight(a) << plan.fraction_bits);
        let mut t: [[W; ORDER]; 2] =
            [row(&|a, p| weight(a) * (p.x.bits() >> drop)), row(&|a, p| weight(a) * (p.y.bits() >> drop))];
        let point = points.first().map_or([0; 2], |p| [p.x, p.y].map(|c| ((c.bits() + (1 << 15)) >> 16) as i32));
        for (row, x) in t.iter_mut().zip(point) {
            for (t, d) in row.iter_mut().zip(&d) {
                *t = d.wrapping_mul_i64(x.into()).wrapping_minus(*t);
            }
        }
        let changing = if weights.is_some() { degree } else { 0 };
        Self { point, t, d, degrees: (degree, changing), left: plan.steps }
    }

    /// The rounded coordinates where the walk stands.
    #[inline]
    pub(crate) fn point(&self) -> [i32; 2] {
        self.point
    }

    /// The 8 bits below the rounded coordinates: floor(256·(x + 1/2)) modulo 256, exact.
    pub(crate) fn below(&self) -> [u32; 2] {
        // x + 1/2 is the point and (D/2 − T)/D more. By restoring division.
        let bits = |[t, ..]: &[W; ORDER]| {
            let (mut rest, mut out) = ((self.d[0] >> 1).wrapping_minus(*t), 0);
            for _ in 0..8 {
                rest = rest.wrapping_plus(rest);
                out <<= 1;
                if !rest.below(self.d[0]) {
                    rest = rest.wrapping_minus(self.d[0]);
                    out |= 1;
                }
            }
            out
        };
        let [x, y] = &self.t;
        [bits(x), bits(y)]
    }

    /// Moves to the next point; false at the last one.
    #[inline]
    pub(crate) fn advance(&mut self) -> bool {
        let Some(left) = self.left.checked_sub(1) else { return false };
        self.left = left;
        step(&mut self.d, self.degrees.1);
        let (floor, ceil) = (self.d[0] >> 1, self.d[0].wrapping_plus(W::ONE) >> 1);
        // The differences of D that are not zero.
        let d = self.d.get(..=self.degrees.1).unwrap_or(&self.d);
        for (t, x) in self.t.iter_mut().zip(&mut self.point) {
            step(t, self.degrees.0);
            if t[0] > floor {
                *x = x.wrapping_sub(1);
                t.iter_mut().zip(d).for_each(|(t, d)| *t = t.wrapping_minus(*d));
            } else if t[0] <= W::ZERO.wrapping_minus(ceil) {
                *x = x.wrapping_add(1);
                t.iter_mut().zip(d).for_each(|(t, d)| *t = t.wrapping_plus(*d));
            }
        }
        true
    }

    /// The steps still to come.
    pub(crate) fn left(&self) -> u32 {
        self.left
    }
}

/// Moves differences of degree `degree` one step.
#[inline]
fn step<W: Word>(row: &mut [W; ORDER], degree: usize) {
    for a in 0..degree.min(ORDER - 1) {
        row[a] = row[a].wrapping_plus(row[a + 1]);
    }
}

/// The differences Δ^k φ(0) of φ(i) = n^m Σ B_a(i/n)·c_a with c_a = `value(a, P_a)`: φ is Σ C(m, k)·n^(m−k)·Δ^k c_0·i^k.
#[inline(never)]
fn newton<W: Word>(points: &[Point3], value: &dyn Fn(usize, &Point3) -> i64, degree: usize, n: u32) -> [W; ORDER] {
    let mut row = [W::ZERO; ORDER];
    for (a, (entry, p)) in row.iter_mut().zip(points).enumerate() {
        *entry = W::truncate(value(a, p).into());
    }
    let degree = degree.min(MAX_DEGREE);
    differences(&mut row[..=degree]);
    let mut power = W::ONE;
    for k in (0..=degree).rev() {
        row[k] = row[k].wrapping_mul_i64(BINOMIAL[degree][k].into()).wrapping_times(power);
        power = power.wrapping_mul_i64(n.into());
    }
    to_newton(&mut row[..=degree]);
    row
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::vec::Vec;

    /// floor(256·(x + 1/2)) of Σ w B P / Σ w B at i/n, in integers.
    fn exact(points: &[Point3], weights: &[i128], i: i128, n: i128) -> [i128; 2] {
        let m = points.len() - 1;
        let basis = |a: usize| weights[a] * i128::from(BINOMIAL[m][a]) * i.pow(a as u32) * (n - i).pow((m - a) as u32);
        let d: i128 = (0..=m).map(basis).sum();
        [0, 1].map(|axis| {
            let bits = |a: usize| i128::from(points[a].to_array()[axis].to_bits());
            let sum: i128 = (0..=m).map(|a| basis(a) * bits(a)).sum();
            // x = sum / (d·2^16)
            (sum + (d << 15)).div_euclid(d << 8)
        })
    }

    #[test]
    fn points_and_the_bits_below_are_exact() {
        let mut state = 1_u64;
        let mut random = |below: i64| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 33) as i64 % below
        };
        for case in 0..400 {
            let (m, whole) = (1 + case % 5, case % 3 == 0);
            let mut coordinate = || {
                let bits = random(30 << 16) as i32 - (5 << 16);
                if whole { bits & !0xffff } else { bits }
            };
            let points: Vec<_> = (0..=m).map(|_| Point3::from_bits(coordinate(), coordinate(), 1)).collect();
            let weights: Vec<_> = (0..=m).map(|_| I16F16::from_bits((1 + random(5) as i32) << 14)).collect();
            let weights = (case % 2 == 0).then_some(&weights[..]);
            let plan = PlanePlan::of((&points, weights)).unwrap();
            let values: Vec<_> =
                points.iter().enumerate().map(|(a, _)| weights.map_or(1, |w| w[a].bits().into())).collect();
            let check = |i: u32, point: [i32; 2], below: [u32; 2]| {
                let ours = [0, 1].map(|axis| 256 * i128::from(point[axis]) + i128::from(below[axis]));
                assert_eq!(ours, exact(&points, &values, i.into(), plan.steps.into()), "{i} of {plan:?}, {points:?}");
            };
            // Both accumulators, whichever the plan takes.
            let mut narrow = PlaneWalker::<i64>::new((&points, weights), &plan);
            let mut wide = PlaneWalker::<i128>::new((&points, weights), &plan);
            for i in 0..=plan.steps {
                check(i, wide.point(), wide.below());
                if !plan.wide {
                    check(i, narrow.point(), narrow.below());
                }
                assert_eq!(wide.left(), plan.steps - i);
                assert_eq!((wide.advance(), narrow.advance()), (i < plan.steps, i < plan.steps));
            }
        }
    }

    #[test]
    fn counts_a_person_can_check() {
        let plan = |points: &[[i16; 2]], weights: Option<&[I16F16]>| {
            let points: Vec<_> = points.iter().map(|[x, y]| Point3::from_ints(*x, *y, 9)).collect();
            PlanePlan::of((&points, weights)).unwrap().steps
        };
        assert_eq!(plan(&[[0, 0], [10, -20]], None), 20, "a line takes its longer side");
        assert_eq!(plan(&[[0, 0], [0, 50], [100, 50], [100, 0]], None), 300);
        assert_eq!(plan(&[[0, 0], [1, 1], [2, 3], [4, 4]], None), 32, "16 (m - 1)");
        let ones = [I16F16::ONE; 4];
        assert_eq!(plan(&[[0, 0], [0, 50], [100, 50], [100, 0]], Some(&ones)), 300);
        let uneven = [2, 3, 2].map(I16F16::from_num);
        assert_eq!(plan(&[[0, 0], [1, 1], [2, 0]], Some(&uneven)), 32, "16 (m - 1 + 2 / 2)");
    }
}
