//! The walk over a polynomial lattice.

use super::Budget;
use super::form::{Form, Kind};
use super::kernel::Kernel;
use super::lanes::{CHUNK, Chunk, LANES, Lanes};
use super::run::{Buffer, RUN, Run, Runs};
use super::table::{Table, difference_table, double_steps, step, step_r, step_s};
use super::tangent::Weights;
use super::visit::{Fraction, Site, Visit};
use crate::num::Word;

/// The state of a row: for each axis the rounded coordinate, its residual and the differences along the row.
#[derive(Clone, Copy, Debug)]
struct Row<W, const R: usize> {
    x: [i32; 3],
    e: [W; 3],
    /// `d[axis][a]` = Δ_r^a φ; `d[axis][0]` is not used.
    d: [[W; R]; 3],
    /// `v[axis][a]` = Δ_r^a of the cross tangent; only kept for visitors that want tangents.
    v: [[W; R]; 3],
}

/// A point of a polynomial lattice.
struct At<'a, W, const R: usize> {
    i: u32,
    j: u32,
    point: [i32; 3],
    row: &'a Row<W, R>,
    weights: &'a Weights,
    scale: W,
}

impl<W: Word, const R: usize> Site for At<'_, W, R> {
    type Word = W;

    #[inline(always)]
    fn i(&self) -> u32 {
        self.i
    }

    #[inline(always)]
    fn j(&self) -> u32 {
        self.j
    }

    #[inline(always)]
    fn point(&self) -> [i32; 3] {
        self.point
    }

    /// L_r·N/n_r·S_r and L_s·N/n_s·S_s, exact.
    #[inline(always)]
    fn tangents(&self) -> [[W; 3]; 2] {
        [core::array::from_fn(|axis| self.weights.along_row(&self.row.d[axis])), self.row.v.map(|v| v[0])]
    }

    fn twist(&self) -> [i64; 3] {
        self.weights.along_rows(&self.row.v)
    }

    #[inline(always)]
    fn below(&self, axis: usize, fraction: &Fraction) -> u32 {
        fraction.read(self.row.e[axis])
    }

    #[inline(always)]
    fn floor(&self, axis: usize, fraction: &Fraction) -> i32 {
        // value = x + (e − ⌊N/2⌋)/N.
        let e = self.row.e[axis].wrapping_minus(self.scale >> 1);
        let (x, e) =
            if e < W::ZERO { (self.point[axis] - 1, e.wrapping_plus(self.scale)) } else { (self.point[axis], e) };
        (x << fraction.bits) + fraction.exact(e, self.scale) as i32
    }
}

/// A table, and x and e at the start of its row.
type Start<'a, W, const R: usize> = (&'a Table<W, R>, i32, W);

/// A walk over a lattice: the engine itself.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Walker<K: Kernel, const R: usize> {
    kernel: K,
    scale: K::Word,
    table: [Table<K::Word, R>; 3],
    /// (x, e) at the start of the row, per axis.
    start: ([i32; 3], [K::Word; 3]),
    row: Row<K::Word, R>,
    weights: Weights,
    position: (u32, u32),
    last_in_row: u32,
    last_row: u32,
    shrinks: bool,
}

impl<K: Kernel, const R: usize> Walker<K, R> {
    /// The walk over `form`, whose degrees are below `R`.
    pub(crate) fn new(kernel: K, form: &Form<'_>, budget: &Budget) -> Self {
        let mut walker = Self::blank(kernel);
        walker.set_up(form, budget);
        walker
    }

    /// No walk yet: for [`set_up`](Self::set_up) in place, which spares the stack a copy.
    #[inline(always)]
    pub(crate) fn blank(kernel: K) -> Self {
        let zero = K::Word::ZERO;
        Self {
            kernel,
            scale: zero,
            table: [[[zero; R]; R]; 3],
            start: ([0; 3], [zero; 3]),
            row: Row { x: [0; 3], e: [zero; 3], d: [[zero; R]; 3], v: [[zero; R]; 3] },
            weights: Weights::of((0, 0)),
            position: (0, 0),
            last_in_row: 0,
            last_row: 0,
            shrinks: false,
        }
    }

    /// Starts the walk over `form`, whose degrees are below `R`.
    #[inline(never)]
    pub(crate) fn set_up(&mut self, form: &Form<'_>, budget: &Budget) {
        self.set_up_tables(form, budget);
        self.start_row::<true>();
    }

    /// [`set_up`](Self::set_up) for a walk that nobody asks for tangents.
    #[inline(never)]
    pub(super) fn set_up_points(&mut self, form: &Form<'_>, budget: &Budget) {
        self.set_up_tables(form, budget);
        self.start_row::<false>();
    }

    #[inline(never)]
    fn set_up_tables(&mut self, form: &Form<'_>, budget: &Budget) {
        let drop = 16 - budget.fraction_bits;
        for (axis, table) in self.table.iter_mut().enumerate() {
            difference_table(table, form, &|a, b| form.bits(axis, a, b) >> drop);
            let raise = self.kernel.raise();
            if raise > 0 {
                table.as_flattened_mut().iter_mut().for_each(|entry| *entry = *entry << raise);
            }
        }
        self.scale = K::Word::truncate(budget.scale as i128);
        self.weights = Weights::of(form.degrees);
        self.last_in_row = form.last_in_row(0);
        self.last_row = form.last_row();
        self.shrinks = form.kind == Kind::Triangle;
        self.place(form, budget);
    }

    /// Sets x and e at the first point.
    fn place(&mut self, form: &Form<'_>, budget: &Budget) {
        let (scale, drop) = (K::Word::truncate(budget.scale as i128), 16 - budget.fraction_bits);
        for axis in 0..3 {
            let bits = form.bits(axis, 0, 0);
            let x = ((bits + (1 << 15)) >> 16) as i32;
            // e = φ + ⌊N/2⌋ − N·x with φ = N·bits/2^16 = (N/2^F)·(bits/2^drop), an integer.
            let phi = (scale >> budget.fraction_bits as usize).wrapping_mul_i64(bits >> drop);
            let e = phi.wrapping_plus(scale >> 1).wrapping_minus(scale.wrapping_mul_i64(x.into()));
            let (mut x, mut e) = self.kernel.start(x, e);
            if form.centred {
                self.move_to_centre(axis, &mut x, &mut e);
            }
            (self.start.0[axis], self.start.1[axis]) = (x, e);
        }
    }

    /// From (0, 0) of the lattice of half steps to (1, 1), then two half steps at a time.
    #[inline(never)]
    fn move_to_centre(&mut self, axis: usize, x: &mut i32, e: &mut K::Word) {
        let Some(table) = self.table.get_mut(axis) else { return };
        self.kernel.advance(x, e, table[0][1]);
        step_r(table);
        self.kernel.advance(x, e, table[1][0]);
        step_s(table);
        double_steps(table);
    }

    #[inline(always)]
    fn start_row<const TANGENTS: bool>(&mut self) {
        (self.row.x, self.row.e) = self.start;
        for axis in 0..3 {
            self.row.d[axis] = self.table[axis][0];
            if TANGENTS {
                self.row.v[axis] = self.weights.across(&self.table[axis]);
            }
        }
    }

    /// Moves the row's start to the next row.
    #[inline]
    fn next_row(&mut self) {
        for axis in 0..3 {
            let table = &mut self.table[axis];
            self.kernel.advance(&mut self.start.0[axis], &mut self.start.1[axis], table[1][0]);
            step_s(table);
        }
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
    #[inline(always)]
    pub(crate) fn visit<V: Visit>(&mut self, mut visitor: V) -> V {
        if self.position.1 > self.last_row {
            return visitor;
        }
        if LANES > 1
            && V::POINTS_ONLY
            && let Some(bits) = self.kernel.bits()
        {
            return self.visit_in_lanes(visitor, Lanes::new(bits));
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
            if V::TANGENTS {
                self.start_row::<true>();
            } else {
                self.start_row::<false>();
            }
        }
    }

    /// Visits what is left of the row, and leaves it at its end.
    #[inline(always)]
    fn visit_row<V: Visit>(&mut self, mut visitor: V) -> V {
        let (mut i, j) = self.position;
        let row = &mut self.row;
        loop {
            let point = core::array::from_fn(|axis| self.kernel.read(row.x[axis], row.e[axis]));
            visitor = visitor.point(&At { i, j, point, row, weights: &self.weights, scale: self.scale });
            if i == self.last_in_row {
                return visitor;
            }
            i += 1;
            row.step(&self.kernel);
            if V::TANGENTS {
                row.step_tangent();
            }
        }
    }

    /// [`visit`](Self::visit) for visitors of points only, with a kernel that has [`Kernel::bits`].
    #[inline]
    fn visit_in_lanes<V: Visit>(&mut self, mut visitor: V, mut lanes: Lanes<R>) -> V {
        let mut chunk = Chunk::default();
        loop {
            let (mut i, j) = self.position;
            if !visitor.wants_row(j) {
                // Nothing to do.
            } else if self.last_in_row - i < CHUNK as u32 {
                visitor = self.visit_row(visitor);
            } else {
                lanes.start(&self.row.e, &self.row.d);
                while i <= self.last_in_row {
                    lanes.next(&mut chunk);
                    let count = (self.last_in_row - i + 1).min(CHUNK as u32);
                    for (i, point) in (i..).zip(chunk.points(count)) {
                        visitor = visitor.point(&At {
                            i,
                            j,
                            point,
                            row: &self.row,
                            weights: &self.weights,
                            scale: self.scale,
                        });
                    }
                    i += count;
                }
            }
            if j == self.last_row {
                return visitor;
            }
            self.next_row();
            self.start_row::<false>();
        }
    }

    /// The current point; the walk then stands at the next one.
    pub(crate) fn next_point(&mut self) -> Option<(u32, u32, [i32; 3])> {
        let (i, j) = self.position;
        if j > self.last_row {
            return None;
        }
        let point = core::array::from_fn(|axis| self.kernel.read(self.row.x[axis], self.row.e[axis]));
        if i < self.last_in_row {
            self.row.step(&self.kernel);
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

    /// The table of an axis, and x and e at the start of the row as the kernel has them.
    pub(super) fn start_of(&self, axis: usize) -> Option<Start<'_, K::Word, R>> {
        Some((self.table.get(axis)?, *self.start.0.get(axis)?, *self.start.1.get(axis)?))
    }
}

impl<K: Kernel, const R: usize> Runs for Walker<K, R> {
    #[inline(never)]
    fn next_run(&mut self, buffer: &mut Buffer) -> Option<Run> {
        let (i, j) = self.position;
        if j > self.last_row {
            return None;
        }
        let left = self.last_in_row - i + 1;
        let count = left.min(RUN as u32);
        let row = &mut self.row;
        for (axis, ((x, e), d)) in row.x.iter_mut().zip(&mut row.e).zip(&mut row.d).enumerate() {
            if let Some(room) = buffer.axis(axis) {
                self.kernel.fill(x, e, d, room, count as usize);
            }
        }
        if count < left {
            self.position.0 += count;
        } else if j < self.last_row {
            self.next_row();
            self.start_row::<false>();
        } else {
            self.position.1 += 1;
        }
        Some(Run { i, j, stride: 1, count: count as usize })
    }
}

/// Points from `position` on, of rows that have `last_in_row + 1` points and, where they shrink, one less each.
pub(super) fn remaining(position: (u32, u32), last_in_row: u32, last_row: u32, shrinks: bool) -> u64 {
    let (i, j, last) = (u64::from(position.0), u64::from(position.1), u64::from(last_in_row));
    let rows = (u64::from(last_row) + 1).saturating_sub(j);
    match rows {
        0 => 0,
        // Rows of last + 1, last, … points, the last one having last + 2 − rows.
        _ if shrinks => (2 * last + 3 - rows) * rows / 2 - i,
        _ => rows * (last + 1) - i,
    }
}

impl<W: Word, const R: usize> Row<W, R> {
    #[inline(always)]
    fn step<K: Kernel<Word = W>>(&mut self, kernel: &K) {
        for axis in 0..3 {
            kernel.advance(&mut self.x[axis], &mut self.e[axis], self.d[axis][1]);
            for a in 1..R - 1 {
                self.d[axis][a] = self.d[axis][a].wrapping_plus(self.d[axis][a + 1]);
            }
        }
    }

    #[inline(always)]
    fn step_tangent(&mut self) {
        self.v.iter_mut().for_each(step);
    }
}
