//! Difference tables and the walk over a lattice.

use super::Budget;
use super::form::{Form, Kind};
use super::kernel::Kernel;
use super::tangent::Weights;
use crate::num::{BINOMIAL, SURJECTIONS, Word};

/// `table[axis][b][a]` = Δ_r^a Δ_s^b φ(0, 0) modulo 2^w; `R` is the largest order it has room for.
type Table<W, const R: usize> = [[[W; R]; R]; 3];

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

/// A point of the lattice as a visitor sees it.
pub(crate) struct At<'a, K: Kernel, const R: usize> {
    pub(crate) i: u32,
    pub(crate) j: u32,
    pub(crate) point: [i32; 3],
    row: &'a Row<K::Word, R>,
    weights: &'a Weights,
}

impl<K: Kernel, const R: usize> At<'_, K, R> {
    /// The residual of an axis, φ + ⌊N/2⌋ − N·x.
    pub(crate) fn residual(&self, axis: usize) -> K::Word {
        self.row.e[axis]
    }

    /// L_r·N/n_r·S_r and L_s·N/n_s·S_s, exact; only for visitors with [`Visit::TANGENTS`].
    pub(crate) fn tangents(&self) -> [[K::Word; 3]; 2] {
        [core::array::from_fn(|axis| self.weights.along_row(&self.row.d[axis])), self.row.v.map(|v| v[0])]
    }
}

/// What happens at the points of a walk.
pub(crate) trait Visit: Sized {
    /// Whether [`At::tangents`] is wanted.
    const TANGENTS: bool = false;

    /// Called at every point, in row order; the visitor is threaded through by value.
    fn point<K: Kernel, const R: usize>(self, at: &At<'_, K, R>) -> Self;
}

/// A walk over a lattice: the engine itself.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Walker<K: Kernel, const R: usize> {
    kernel: K,
    table: Table<K::Word, R>,
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
        let mut walker = Self {
            kernel,
            table: difference_table(form, budget),
            start: ([0; 3], [K::Word::ZERO; 3]),
            row: Row { x: [0; 3], e: [K::Word::ZERO; 3], d: [[K::Word::ZERO; R]; 3], v: [[K::Word::ZERO; R]; 3] },
            weights: Weights::of(form.degrees),
            position: (0, 0),
            last_in_row: form.last_in_row(0),
            last_row: form.last_row(),
            shrinks: form.kind == Kind::Triangle,
        };
        let (scale, drop) = (K::Word::truncate(budget.scale as i128), 16 - budget.fraction_bits);
        for axis in 0..3 {
            let bits = form.bits(axis, 0, 0);
            let x = ((bits + (1 << 15)) >> 16) as i32;
            // e = φ + ⌊N/2⌋ − N·x with φ = N·bits/2^16 = (N/2^F)·(bits/2^drop), an integer.
            let phi = (scale >> budget.fraction_bits as usize).wrapping_mul_i64(bits >> drop);
            let e = phi.wrapping_plus(scale >> 1).wrapping_minus(scale.wrapping_mul_i64(x.into()));
            (walker.start.0[axis], walker.start.1[axis]) = kernel.start(x, e);
        }
        walker.start_row::<true>();
        walker
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
            for b in 0..R - 1 {
                let next = table[b + 1];
                for (entry, next) in table[b].iter_mut().zip(next) {
                    *entry = entry.wrapping_plus(next);
                }
            }
        }
        self.position = (0, self.position.1 + 1);
        if self.shrinks {
            self.last_in_row -= 1;
        }
    }

    /// Visits what is left of the lattice.
    #[inline]
    pub(crate) fn visit<V: Visit>(mut self, mut visitor: V) -> V {
        if self.position.1 > self.last_row {
            return visitor;
        }
        loop {
            let mut row = self.row;
            let (mut i, j) = self.position;
            loop {
                let point = core::array::from_fn(|axis| self.kernel.read(row.x[axis], row.e[axis]));
                visitor = visitor.point::<K, R>(&At { i, j, point, row: &row, weights: &self.weights });
                if i == self.last_in_row {
                    break;
                }
                i += 1;
                row.step(&self.kernel);
                if V::TANGENTS {
                    row.step_tangent();
                }
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
        let (i, j) = (u64::from(self.position.0), u64::from(self.position.1));
        let (last, rows) = (u64::from(self.last_in_row), (u64::from(self.last_row) + 1).saturating_sub(j));
        match rows {
            0 => 0,
            // Rows of last+1, last, … points, the last one having last + 2 − rows.
            _ if self.shrinks => (2 * last + 3 - rows) * rows / 2 - i,
            _ => rows * (last + 1) - i,
        }
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
        for axis in 0..3 {
            for a in 0..R - 1 {
                self.v[axis][a] = self.v[axis][a].wrapping_plus(self.v[axis][a + 1]);
            }
        }
    }
}

/// Δ_r^a Δ_s^b φ(0, 0): φ is Σ c_kl i^k j^l with c_kl = (multinomial)·n^(…)·Δ_r^k Δ_s^l P, and the a-th difference
/// of i^k at 0 is a! S(k, a). Everything modulo 2^w.
///
/// Row l ends at e = m, or m − l in a triangle: then the multinomial is C(h, l)·C(e, k) and the power of n
/// (of n_r) is e − k for both kinds. The limits `R - 1` change nothing; with them no index can be out of bounds.
#[inline(never)]
fn difference_table<W: Word, const R: usize>(form: &Form<'_>, budget: &Budget) -> Table<W, R> {
    let drop = 16 - budget.fraction_bits;
    let (m, h) = (form.degrees.0.min(R - 1), form.degrees.1.min(R - 1));
    let row_end = |b: usize| form.last_row_entry(b).min(R - 1);
    let column_end = |a: usize| form.last_column_entry(a).min(R - 1);
    let power_r: [W; R] = powers(form.steps.0);
    let power_s: [W; R] = powers(if form.kind == Kind::Triangle { 1 } else { form.steps.1 });
    let mut table = [[[W::ZERO; R]; R]; 3];
    for (axis, t) in table.iter_mut().enumerate() {
        for (b, row) in t[..=h].iter_mut().enumerate() {
            let row = &mut row[..=row_end(b)];
            for (a, entry) in row.iter_mut().enumerate() {
                *entry = W::truncate((form.bits(axis, a, b) >> drop).into());
            }
            differences(row);
        }
        each_column(t, m, |a, column| differences(&mut column[..=column_end(a)]));
        for (b, (row, power)) in t[..=h].iter_mut().zip(power_s[..=h].iter().rev()).enumerate() {
            let end = row_end(b);
            let row = &mut row[..=end];
            let by_s = power.wrapping_mul_i64(BINOMIAL[h][b].into());
            for ((entry, choices), power) in row.iter_mut().zip(BINOMIAL[end]).zip(power_r[..=end].iter().rev()) {
                *entry = entry.wrapping_mul_i64(choices.into()).wrapping_times(*power).wrapping_times(by_s);
            }
            to_newton(row);
        }
        each_column(t, m, |a, column| to_newton(&mut column[..=column_end(a)]));
    }
    table
}

/// 1, n, n², …
fn powers<W: Word, const R: usize>(n: u32) -> [W; R] {
    let mut powers = [W::ONE; R];
    for k in 1..R {
        powers[k] = powers[k - 1].wrapping_mul_i64(n.into());
    }
    powers
}

/// Applies `change` to the columns up to `last`.
#[inline(always)]
fn each_column<W: Word, const R: usize>(t: &mut [[W; R]; R], last: usize, change: impl Fn(usize, &mut [W; R])) {
    for a in 0..last.min(R - 1) + 1 {
        let mut column = core::array::from_fn(|b| t[b][a]);
        change(a, &mut column);
        for (row, entry) in t.iter_mut().zip(column) {
            row[a] = entry;
        }
    }
}

/// v_a to Δ^a v_0, in place.
#[inline(never)]
fn differences<W: Word>(values: &mut [W]) {
    let mut rest = values;
    while let Some((first, tail)) = rest.split_first_mut() {
        let mut before = *first;
        for value in &mut *tail {
            let here = *value;
            *value = here.wrapping_minus(before);
            before = here;
        }
        rest = tail;
    }
}

/// Coefficients of i^k to the differences of their sum at i = 0, in place.
#[inline(never)]
fn to_newton<W: Word>(values: &mut [W]) {
    for a in 1..values.len().min(SURJECTIONS.len()) {
        let terms = values[a..].iter().zip(&SURJECTIONS[a..]);
        values[a] = terms.fold(W::ZERO, |sum, (value, by)| sum.wrapping_plus(value.wrapping_mul_i64(by[a].into())));
    }
}
