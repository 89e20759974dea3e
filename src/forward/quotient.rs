//! The walk over a rational lattice: the incremental quotient.
//!
//! x = A/D with A = Σ w P B·N and D = Σ w B·N. For the current integer x keep the differences of T = x·D − A and of D:
//! a step adds differences to both; then x moves by whole units, T by as many D, until −D/2 < T ≤ D/2, which is
//! x = floor(A/D + 1/2). Additions and compares only; D is shared by the three axes.
//!
//! T after a step of at most K units lies in ±(K + 1/2)·D, so signed compares in w bits are right while
//! (2K+1)·D_max < 2^w. Everything else is arithmetic modulo 2^w.

use super::Budget;
use super::form::{Form, Kind};
use super::run::{Buffer, RUN, Run, Runs};
use super::table::{Table, difference_table, double_steps, step, step_r, step_s};
use super::tangent::Weights;
use super::visit::{Fraction, Site, Visit};
use super::walk::remaining;
use crate::num::Word;

/// Differences along a row of T for each axis, of D, and of their derivatives across rows.
#[derive(Clone, Copy, Debug)]
struct Row<W, const R: usize> {
    x: [i32; 3],
    t: [[W; R]; 3],
    d: [W; R],
    /// Only kept for visitors that want tangents.
    across_t: [[W; R]; 3],
    across_d: [W; R],
}

struct At<'a, W, const R: usize> {
    i: u32,
    j: u32,
    row: &'a Row<W, R>,
    weights: &'a Weights,
}

impl<W: Word, const R: usize> Site for At<'_, W, R> {
    type Word = i64;

    fn i(&self) -> u32 {
        self.i
    }

    fn j(&self) -> u32 {
        self.j
    }

    fn point(&self) -> [i32; 3] {
        self.row.x
    }

    /// S' = (A' D − A D')/D² with A = x·D − T: proportional to T·D' − T'·D, each factor truncated once to 30 bits.
    fn tangents(&self) -> [[i64; 3]; 2] {
        let row = self.row;
        let [_, _, _, d] = narrow([W::ZERO, W::ZERO, W::ZERO, row.d[0]]);
        let shift = excess(&[row.d[0]]);
        let t = row.t.map(|t| to_i64(t[0] >> shift));
        let along = |slope_t: [W; 3], slope_d: W| {
            let slopes = narrow([slope_t[0], slope_t[1], slope_t[2], slope_d]);
            let mut tangent = t;
            tangent.iter_mut().zip(slopes).for_each(|(t, slope)| *t = *t * slopes[3] - slope * d);
            tangent
        };
        [
            along(row.t.map(|t| self.weights.along_row(&t)), self.weights.along_row(&row.d)),
            along(row.across_t.map(|t| t[0]), row.across_d[0]),
        ]
    }

    /// With S_r = 0 or S_s = 0, S_rs is proportional to T·D_rs + T_s·D_r − T_r·D_s − T_rs·D; factors of 29 bits.
    fn twist(&self) -> [i64; 3] {
        let (row, weights) = (self.row, self.weights);
        let along = |d: &[W; R]| weights.along_row(d);
        let d = [row.d[0], along(&row.d), row.across_d[0], along(&row.across_d)];
        let t: [[W; 4]; 3] = core::array::from_fn(|axis| {
            let (t, across) = (&row.t[axis], &row.across_t[axis]);
            [t[0], along(t), across[0], along(across)]
        });
        let (by_d, by_t) = (excess(&d) + 1, excess(t.as_flattened()) + 1);
        let [d, d_r, d_s, d_rs] = d.map(|d| to_i64(d >> by_d));
        t.map(|t| {
            let [t, t_r, t_s, t_rs] = t.map(|t| to_i64(t >> by_t));
            t * d_rs + t_s * d_r - t_r * d_s - t_rs * d
        })
    }

    fn below(&self, axis: usize, fraction: &Fraction) -> u32 {
        // value + 1/2 = x + (D/2 − T)/D.
        let d = self.row.d[0];
        fraction.divide((d >> 1).wrapping_minus(self.row.t[axis][0]), d)
    }

    fn floor(&self, axis: usize, fraction: &Fraction) -> i32 {
        // value = x − T/D with T in (−D/2, D/2].
        let (d, t) = (self.row.d[0], self.row.t[axis][0]);
        let below = t > W::ZERO;
        let e = if below { d.wrapping_minus(t) } else { W::ZERO.wrapping_minus(t) };
        ((self.row.x[axis] - i32::from(below)) << fraction.bits) + fraction.divide(e, d) as i32
    }
}

fn to_i64<W: Word>(value: W) -> i64 {
    value.as_()
}

/// The shift that leaves every value at most 30 bits and a sign.
fn excess<W: Word>(values: &[W]) -> usize {
    let all = values.iter().fold(W::ZERO, |all, v| all | (*v ^ (*v >> (<W as Word>::BITS - 1) as usize)));
    (<W as Word>::BITS - all.leading_zeros()).saturating_sub(30) as usize
}

/// The values shifted right by one common amount, to at most 30 bits and a sign.
fn narrow<W: Word>(values: [W; 4]) -> [i64; 4] {
    let shift = excess(&values);
    values.map(|v| to_i64(v >> shift))
}

/// How many units x must lose so that T = t − k·D comes into (−D/2, D/2]: negative where it must gain.
///
/// |k| ≤ K < 2^(ladder+1).
#[inline(always)]
fn units_off<W: Word>(t: W, d: W, ladder: u32) -> i32 {
    let (floor, ceil) = (d >> 1, d.wrapping_plus(W::ONE) >> 1);
    if t > floor || t <= W::ZERO.wrapping_minus(ceil) { climb(t, d, ladder) } else { 0 }
}

/// [`units_off`] where it is not 0; out of line, because it is long for wide words.
#[inline(never)]
fn climb<W: Word>(t: W, d: W, ladder: u32) -> i32 {
    let least = W::ZERO.wrapping_minus(d.wrapping_plus(W::ONE) >> 1);
    let (mut rest, mut units, loses) = (t, 0, t > least);
    for bit in (0..=ladder).rev() {
        let part = d << bit as usize;
        let next = if loses { rest.wrapping_minus(part) } else { rest.wrapping_plus(part) };
        if (next > least) == loses {
            rest = next;
            units += 1 << bit;
        }
    }
    if loses { units } else { -1 - units }
}

/// `t ← t − units·d`, by shifted additions.
#[inline(never)]
fn subtract<W: Word, const R: usize>(t: &mut [W; R], d: &[W; R], units: i32) {
    let mut left = units.unsigned_abs();
    while left != 0 {
        let bit = left.trailing_zeros() as usize;
        left &= left - 1;
        for (t, d) in t.iter_mut().zip(d) {
            let part = *d << bit;
            *t = if units > 0 { t.wrapping_minus(part) } else { t.wrapping_plus(part) };
        }
    }
}

/// A walk over a rational lattice.
#[derive(Clone, Copy, Debug)]
pub(crate) struct QuotientWalker<W, const R: usize> {
    /// x at the start of the row, and the tables of T and D there.
    x: [i32; 3],
    t: [Table<W, R>; 3],
    d: Table<W, R>,
    row: Row<W, R>,
    weights: Weights,
    ladder: u32,
    position: (u32, u32),
    last_in_row: u32,
    last_row: u32,
    shrinks: bool,
}

impl<W: Word, const R: usize> QuotientWalker<W, R> {
    /// The walk over a form with weights, whose degrees are below `R`.
    pub(crate) fn new(form: &Form<'_>, budget: &Budget) -> Self {
        let mut walker = Self::blank();
        walker.set_up(form, budget);
        walker
    }

    /// No walk yet: for [`set_up`](Self::set_up) in place, which spares the stack a copy.
    #[inline(always)]
    pub(crate) fn blank() -> Self {
        let zero = [W::ZERO; R];
        Self {
            x: [0; 3],
            t: [[zero; R]; 3],
            d: [zero; R],
            row: Row { x: [0; 3], t: [zero; 3], d: zero, across_t: [zero; 3], across_d: zero },
            weights: Weights::of((0, 0)),
            ladder: 0,
            position: (0, 0),
            last_in_row: 0,
            last_row: 0,
            shrinks: false,
        }
    }

    /// Starts the walk over a form with weights, whose degrees are below `R`.
    #[inline(never)]
    pub(crate) fn set_up(&mut self, form: &Form<'_>, budget: &Budget) {
        let (drop, fraction_bits) = (16 - budget.fraction_bits, budget.fraction_bits);
        let weight = |a, b| form.weight_bits(a, b) >> budget.weight_shift;
        difference_table(&mut self.d, form, &|a, b| weight(a, b) << fraction_bits);
        for (axis, t) in self.t.iter_mut().enumerate() {
            difference_table(t, form, &|a, b| weight(a, b) * (form.bits(axis, a, b) >> drop));
        }
        self.weights = Weights::of(form.degrees);
        self.ladder = budget.largest_step.checked_ilog2().unwrap_or(0);
        self.last_in_row = form.last_in_row(0);
        self.last_row = form.last_row();
        self.shrinks = form.kind == Kind::Triangle;
        self.place(form);
        self.start_row::<true>();
    }

    /// Turns the tables of A into those of T at the first point.
    #[inline(never)]
    fn place(&mut self, form: &Form<'_>) {
        for axis in 0..3 {
            // A corner of the net is on the surface.
            let x = ((form.bits(axis, 0, 0) + (1 << 15)) >> 16) as i32;
            self.x[axis] = x;
            for (t, d) in self.t[axis].as_flattened_mut().iter_mut().zip(self.d.as_flattened()) {
                *t = d.wrapping_mul_i64(x.into()).wrapping_minus(*t);
            }
        }
        if form.centred {
            // From (0, 0) of the lattice of half steps to (1, 1), then two half steps at a time.
            self.t.iter_mut().chain([&mut self.d]).for_each(step_r);
            self.settle_table();
            self.t.iter_mut().chain([&mut self.d]).for_each(step_s);
            self.settle_table();
            self.t.iter_mut().chain([&mut self.d]).for_each(double_steps);
        }
    }

    /// Moves x, and the tables with it, to where T is in range.
    fn settle_table(&mut self) {
        for axis in 0..3 {
            let units = units_off(self.t[axis][0][0], self.d[0][0], self.ladder);
            if units != 0 {
                self.x[axis] = self.x[axis].wrapping_sub(units);
                for (t, d) in self.t[axis].iter_mut().zip(&self.d) {
                    subtract(t, d, units);
                }
            }
        }
    }

    #[inline(always)]
    fn start_row<const TANGENTS: bool>(&mut self) {
        self.row.x = self.x;
        self.row.d = self.d[0];
        self.row.t = self.t.map(|t| t[0]);
        if TANGENTS {
            self.row.across_d = self.weights.across(&self.d);
            self.row.across_t = self.t.each_ref().map(|t| self.weights.across(t));
        }
    }

    #[inline(never)]
    fn next_row(&mut self) {
        self.t.iter_mut().chain([&mut self.d]).for_each(step_s);
        self.settle_table();
        self.position = (0, self.position.1 + 1);
        if self.shrinks {
            self.last_in_row -= 1;
        }
    }

    /// [`visit`](Self::visit) of a walk that is given away: nothing else sees it, so it can live in registers.
    #[inline(always)]
    pub(crate) fn run<V: Visit>(mut self, visitor: V) -> V {
        self.visit(visitor)
    }

    /// Visits what is left of the lattice.
    #[inline]
    pub(crate) fn visit<V: Visit>(&mut self, mut visitor: V) -> V {
        if self.position.1 > self.last_row {
            return visitor;
        }
        loop {
            let j = self.position.1;
            if visitor.wants_row(j) {
                visitor = self.visit_row(visitor);
            }
            if j == self.last_row {
                return visitor;
            }
            self.next_row();
            if V::TANGENTS { self.start_row::<true>() } else { self.start_row::<false>() }
        }
    }

    /// Visits what is left of the row, and leaves it at its end.
    fn visit_row<V: Visit>(&mut self, mut visitor: V) -> V {
        let (mut i, j) = self.position;
        let row = &mut self.row;
        loop {
            visitor = visitor.point(&At { i, j, row, weights: &self.weights });
            if i == self.last_in_row {
                return visitor;
            }
            i += 1;
            if V::TANGENTS { row.step::<true>(self.ladder) } else { row.step::<false>(self.ladder) }
        }
    }

    /// The current point; the walk then stands at the next one.
    pub(crate) fn next_point(&mut self) -> Option<(u32, u32, [i32; 3])> {
        let (i, j) = self.position;
        if j > self.last_row {
            return None;
        }
        let point = self.row.x;
        if i < self.last_in_row {
            self.row.step::<false>(self.ladder);
            self.position.0 += 1;
        } else if j < self.last_row {
            self.next_row();
            self.start_row::<false>();
        } else {
            self.position.1 += 1;
        }
        Some((i, j, point))
    }

    /// The points still to come.
    pub(crate) fn remaining(&self) -> u64 {
        remaining(self.position, self.last_in_row, self.last_row, self.shrinks)
    }
}

impl<W: Word, const R: usize> Runs for QuotientWalker<W, R> {
    #[inline(never)]
    fn next_run(&mut self, buffer: &mut Buffer) -> Option<Run> {
        let (i, j) = self.position;
        let mut count = 0;
        while count < RUN && self.position.1 == j {
            let (_, _, point) = self.next_point()?;
            buffer.set(count, point);
            count += 1;
        }
        Some(Run { i, j, stride: 1, count })
    }
}

impl<W: Word, const R: usize> Row<W, R> {
    #[inline(always)]
    fn step<const TANGENTS: bool>(&mut self, ladder: u32) {
        self.t.iter_mut().chain([&mut self.d]).for_each(step);
        if TANGENTS {
            self.across_t.iter_mut().chain([&mut self.across_d]).for_each(step);
        }
        for axis in 0..3 {
            let units = units_off(self.t[axis][0], self.d[0], ladder);
            if units != 0 {
                self.x[axis] = self.x[axis].wrapping_sub(units);
                subtract(&mut self.t[axis], &self.d, units);
                if TANGENTS {
                    subtract(&mut self.across_t[axis], &self.across_d, units);
                }
            }
        }
    }
}
