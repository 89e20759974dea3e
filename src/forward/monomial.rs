//! Difference tables of sub-lattices from coefficients of powers, where N = 2^f.
//!
//! f(i, j) = φ + ⌊N/2⌋ = Σ c_kl i^k j^l with integers c_kl. Moved to the first point of a class they are sums of sums
//! (Taylor), and in the indices of the class, i = i_0 + qI, they have factors q^(k+l): shifts. Of f/q, modulo 2^32, only
//! c_00 needs bits above 32, so all else has 32. There are no divisions, and multiplications only by small numbers.

use super::Budget;
use super::form::{Form, Kind};
use super::table::{Table, differences, each_column};
use crate::num::BINOMIAL;

/// The coefficients of the coordinates of a lattice, modulo 2^64, of degree at most 3.
pub(super) struct Monomials {
    /// `[axis][l][k]`: of i^k j^l, in steps of tables.
    axes: [Table<i64, 4>; 3],
    /// log2 N.
    fraction: u32,
    /// 1 for centres, which stand at odd half steps.
    centred: bool,
}

impl Monomials {
    /// The coefficients; N = 2^`fraction`, which no rational net has.
    #[inline(always)]
    pub(super) fn new(form: &Form<'_>, budget: &Budget, fraction: u32) -> Self {
        let mut monomials = Self { axes: [[[0; 4]; 4]; 3], fraction, centred: form.centred };
        monomials.set_up(form, budget);
        monomials
    }

    #[inline(never)]
    fn set_up(&mut self, form: &Form<'_>, budget: &Budget) {
        let (triangle, fraction) = (form.kind == Kind::Triangle, self.fraction);
        let (m, h) = (form.degrees.0.min(3), form.degrees.1.min(3));
        let (r, s) = form.table_steps();
        // Powers of two, or without an influence.
        let (r, s) = (r.trailing_zeros(), if triangle { 0 } else { s.trailing_zeros() });
        let drop = 16 - budget.fraction_bits;
        for (axis, table) in self.axes.iter_mut().enumerate() {
            let length = |b: usize| if triangle { m.saturating_sub(b) + 1 } else { m + 1 };
            for (b, row) in table.iter_mut().enumerate().take(h + 1) {
                for (a, entry) in row.iter_mut().enumerate().take(length(b)) {
                    *entry = form.bits(axis, a, b) >> drop;
                }
                differences(row.get_mut(..length(b)).unwrap_or_default());
            }
            let columns = |a: usize| if triangle { h.saturating_sub(a) + 1 } else { h + 1 };
            each_column(table, m, |a, column| differences(column.get_mut(..columns(a)).unwrap_or_default()));
            for (l, (row, by_s)) in table.iter_mut().zip(BINOMIAL[h]).enumerate().take(h + 1) {
                let end = length(l) - 1;
                for (k, (entry, by_r)) in row.iter_mut().zip(BINOMIAL[end]).enumerate().take(end + 1) {
                    let bits = r * (end - k) as u32 + s * (h - l) as u32;
                    *entry = entry.wrapping_mul((by_s * by_r).into()) << (bits & 63);
                }
            }
            table[0][0] = table[0][0].wrapping_add((1 << (fraction & 63)) >> 1);
        }
    }

    /// Forward differences along columns, backward ones along rows, of a coordinate on the points (i + qI, j + qJ) with
    /// q = 2^`bits`; the coordinate is above `shift` bits, f − `bits` at least: `[b][a]`.
    #[inline(never)]
    pub(super) fn class(&self, axis: usize, first: (u32, u32), (bits, shift): (u32, u32), table: &mut Table<i32, 4>) {
        self.rows_of_class(axis, first, (bits, shift), table);
        let [_, two, three, four] = table;
        for ((two, three), four) in two.iter_mut().zip(three).zip(four) {
            [*two, *three, *four] = newton([*two, *three, *four], [1, 1, 6]);
        }
    }

    /// [`class`](Self::class) a row before the first one, and backward along columns, too.
    #[cfg(any(forward_asm = "v6m", forward_asm = "rv32"))]
    #[inline(never)]
    pub(super) fn class_before(
        &self,
        axis: usize,
        first: (u32, u32),
        (bits, shift): (u32, u32),
        table: &mut Table<i32, 4>,
    ) {
        self.rows_of_class(axis, first, (bits, shift), table);
        let [one, two, three, four] = table;
        for (((one, two), three), four) in one.iter_mut().zip(two).zip(three).zip(four) {
            *one = one.wrapping_sub(*two).wrapping_add(*three).wrapping_sub(*four);
            [*two, *three, *four] = newton([*two, *three, *four], [-3, 7, -12]);
        }
    }

    /// `[l][a]`: differences along rows of what J^l is multiplied by.
    #[inline(always)]
    fn rows_of_class(&self, axis: usize, (i, j): (u32, u32), (bits, shift): (u32, u32), table: &mut Table<i32, 4>) {
        let Some(base) = self.axes.get(axis) else { return };
        for (entry, power) in table.as_flattened_mut().iter_mut().zip(base.as_flattened()) {
            *entry = *power as i32;
        }
        let half = |i: u32| if self.centred { 2 * i + 1 } else { i };
        (0..half(i)).for_each(|_| move_by_column(table));
        (0..half(j)).for_each(|_| move_by_row(table));
        let value = value(base, half(i), half(j));
        let up = shift as i32 - self.fraction as i32;
        let by_step = bits as i32 + i32::from(self.centred);
        let mut row_bits = up;
        for row in &mut *table {
            let mut bits = row_bits;
            for entry in row {
                // Negative only for the value; from 32 on nothing is left.
                *entry = entry.checked_shl(bits as u32).unwrap_or(0);
                bits += by_step;
            }
            row_bits += by_step;
        }
        table[0][0] = if up < 0 { value >> (-up & 63) } else { value << (up & 63) } as i32;
        for [_, one, two, three] in table {
            [*one, *two, *three] = newton([*one, *two, *three], [-1, 1, -6]);
        }
    }
}

/// The value at (i, j).
#[inline(never)]
fn value([one, two, three, four]: &Table<i64, 4>, i: u32, j: u32) -> i64 {
    if j == 0 {
        return value_at(one, i);
    }
    value_at(&[value_at(one, i), value_at(two, i), value_at(three, i), value_at(four, i)], j)
}

/// The value at t.
#[inline(always)]
fn value_at([one, two, three, four]: &[i64; 4], t: u32) -> i64 {
    let times = |v: i64| if t == 1 { v } else { v.wrapping_mul(t.into()) };
    if t == 0 {
        return *one;
    }
    times(times(times(*four).wrapping_add(*three)).wrapping_add(*two)).wrapping_add(*one)
}

/// Coefficients of t, t^2, t^3 to their first to third differences: v1 + `by[0]`·v2 + `by[1]`·v3, 2·v2 + `by[2]`·v3, 6·v3.
#[inline(always)]
fn newton([one, two, three]: [i32; 3], by: [i32; 3]) -> [i32; 3] {
    let times = i32::wrapping_mul;
    let first = one.wrapping_add(times(by[0], two)).wrapping_add(times(by[1], three));
    [first, times(2, two).wrapping_add(times(by[2], three)), times(6, three)]
}

/// t to t + 1.
#[inline(always)]
fn move_by_one([one, two, three, four]: [i32; 4]) -> [i32; 4] {
    let plus = i32::wrapping_add;
    let three = plus(three, four);
    let two = plus(two, three);
    let one = plus(one, two);
    let three = plus(three, four);
    let two = plus(two, three);
    [one, two, plus(three, four), four]
}

/// i to i + 1.
#[inline(never)]
fn move_by_column(table: &mut Table<i32, 4>) {
    table.iter_mut().for_each(|row| *row = move_by_one(*row));
}

/// j to j + 1.
#[inline(never)]
fn move_by_row([one, two, three, four]: &mut Table<i32, 4>) {
    for (((one, two), three), four) in one.iter_mut().zip(two).zip(three).zip(four) {
        [*one, *two, *three, *four] = move_by_one([*one, *two, *three, *four]);
    }
}
