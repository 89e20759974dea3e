//! Difference tables: from control coefficients to the Newton differences of φ, modulo 2^w.

use super::form::{Form, Kind};
use crate::num::{BINOMIAL, SURJECTIONS, Word};

/// `table[b][a]` = Δ_r^a Δ_s^b φ at some point; `R` is the largest order it has room for.
pub(crate) type Table<W, const R: usize> = [[W; R]; R];

/// Fills `t` with Δ_r^a Δ_s^b φ(0, 0) of φ = n_r^m n_s^h Σ B_a B_b·coefficient(a, b).
///
/// φ is Σ c_kl i^k j^l with c_kl = (multinomial)·n^(…)·Δ_r^k Δ_s^l of the coefficients, and the a-th difference of
/// i^k at 0 is a! S(k, a).
///
/// Row l ends at e = m, or m − l in a triangle: then the multinomial is C(h, l)·C(e, k) and the power of n
/// (of n_r) is e − k for both kinds. The limits `R - 1` change nothing; with them no index can be out of bounds.
#[inline(never)]
pub(crate) fn difference_table<W: Word, const R: usize>(
    t: &mut Table<W, R>,
    form: &Form<'_>,
    coefficient: &dyn Fn(usize, usize) -> i64,
) {
    let (m, h) = (form.degrees.0.min(R - 1), form.degrees.1.min(R - 1));
    let row_end = |b: usize| form.last_row_entry(b).min(R - 1);
    let column_end = |a: usize| form.last_column_entry(a).min(R - 1);
    let (steps_r, steps_s) = form.table_steps();
    let power_r: [W; R] = powers(steps_r);
    let power_s: [W; R] = powers(if form.kind == Kind::Triangle { 1 } else { steps_s });
    t.iter_mut().for_each(|row| row.fill(W::ZERO));
    for (b, row) in t.iter_mut().enumerate().take(h + 1) {
        let row = up_to(row, row_end(b));
        for (a, entry) in row.iter_mut().enumerate() {
            *entry = W::truncate(coefficient(a, b).into());
        }
        differences(row);
    }
    each_column(t, m, |a, column| differences(up_to(column, column_end(a))));
    let by_s = BINOMIAL[h].into_iter().zip(power_s.iter().take(h + 1).rev());
    for (b, (row, (choices, power))) in t.iter_mut().zip(by_s).enumerate() {
        let end = row_end(b);
        let row = up_to(row, end);
        let by_s = power.wrapping_mul_i64(choices.into());
        for ((entry, choices), power) in row.iter_mut().zip(BINOMIAL[end]).zip(power_r.iter().take(end + 1).rev()) {
            *entry = entry.wrapping_mul_i64(choices.into()).wrapping_times(*power).wrapping_times(by_s);
        }
        to_newton(row);
    }
    each_column(t, m, |a, column| to_newton(up_to(column, column_end(a))));
}

/// The entries up to `last`; none beyond the room.
fn up_to<W, const R: usize>(entries: &mut [W; R], last: usize) -> &mut [W] {
    entries.get_mut(..=last).unwrap_or_default()
}

/// Moves a table one step along r: Δ^a ← Δ^a + Δ^(a+1).
#[inline(never)]
pub(crate) fn step_r<W: Word, const R: usize>(t: &mut Table<W, R>) {
    for row in t {
        step(row);
    }
}

/// Moves a table one step along s.
#[inline(always)]
pub(crate) fn step_s<W: Word, const R: usize>(t: &mut Table<W, R>) {
    for b in 0..R - 1 {
        let next = t[b + 1];
        for (entry, next) in t[b].iter_mut().zip(next) {
            *entry = entry.wrapping_plus(next);
        }
    }
}

/// [`step_s`] for a triangle of degree 3 at most: what is left out is zero.
#[inline(always)]
pub(super) fn step_triangle<W: Word>([one, two, three, four]: &mut Table<W, 4>) {
    for (entry, next) in one.iter_mut().zip(*two).take(3) {
        *entry = entry.wrapping_plus(next);
    }
    for (entry, next) in two.iter_mut().zip(*three).take(2) {
        *entry = entry.wrapping_plus(next);
    }
    three[0] = three[0].wrapping_plus(four[0]);
}

/// Moves a row of differences one step.
#[inline(always)]
pub(crate) fn step<W: Word, const R: usize>(d: &mut [W; R]) {
    for a in 0..R - 1 {
        d[a] = d[a].wrapping_plus(d[a + 1]);
    }
}

/// Forward differences to backward ones: Δ^a at i to Δ^a at i − a, whatever the first entry is.
#[inline(always)]
pub(super) fn to_backward<W: Word, const R: usize>(d: &mut [W; R]) {
    for s in 1..R - 1 {
        for a in (s..R - 1).rev() {
            d[a] = d[a].wrapping_minus(d[a + 1]);
        }
    }
}

/// Moves a row of backward differences one step; the value is the first of them.
#[inline(always)]
pub(super) fn step_backward<W: Word, const R: usize>(d: &mut [W; R]) {
    for a in (0..R - 1).rev() {
        d[a] = d[a].wrapping_plus(d[a + 1]);
    }
}

/// Undoes [`step_backward`].
#[inline(always)]
pub(super) fn step_back<W: Word, const R: usize>(d: &mut [W; R]) {
    for a in 0..R - 1 {
        d[a] = d[a].wrapping_minus(d[a + 1]);
    }
}

/// Differences over steps of two instead of one, in both directions: sample at 0, 2, 4, … and difference anew.
#[inline(never)]
pub(crate) fn double_steps<W: Word, const R: usize>(t: &mut Table<W, R>) {
    t.iter_mut().for_each(double);
    each_column(t, R - 1, |_, column| double(column));
}

#[inline(never)]
fn double<W: Word, const R: usize>(d: &mut [W; R]) {
    let (mut here, mut samples) = (*d, [W::ZERO; R]);
    for sample in &mut samples {
        *sample = here[0];
        step(&mut here);
        step(&mut here);
    }
    differences(&mut samples);
    *d = samples;
}

/// To differences of twice the stride: (1 + Δ)² − 1 = Δ·(2 + Δ), so the s-th gets s factors 2 + Δ.
#[inline(always)]
pub(super) fn double_stride<W: Word, const R: usize>(d: &mut [W; R]) {
    for s in 1..R {
        for a in s..R {
            let next = if a + 1 < R { d[a + 1] } else { W::ZERO };
            d[a] = d[a].wrapping_plus(d[a]).wrapping_plus(next);
        }
    }
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
pub(super) fn each_column<W: Word, const R: usize>(
    t: &mut Table<W, R>,
    last: usize,
    change: impl Fn(usize, &mut [W; R]),
) {
    for a in 0..R {
        if a > last {
            return;
        }
        // Not by `from_fn`: at opt-level s its closure would check the index.
        let mut column = [W::ZERO; R];
        for (entry, row) in column.iter_mut().zip(t.iter()) {
            *entry = row[a];
        }
        change(a, &mut column);
        for (row, entry) in t.iter_mut().zip(column) {
            row[a] = entry;
        }
    }
}

/// v_a to Δ^a v_0, in place.
#[inline(never)]
pub(super) fn differences<W: Word>(values: &mut [W]) {
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
pub(super) fn to_newton<W: Word>(values: &mut [W]) {
    for a in 1..values.len().min(SURJECTIONS.len()) {
        let terms = values[a..].iter().zip(&SURJECTIONS[a..]);
        values[a] = terms.fold(W::ZERO, |sum, (value, by)| sum.wrapping_plus(value.wrapping_mul_i64(by[a].into())));
    }
}
