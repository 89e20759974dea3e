//! The wrapping sum of all coordinates of a lattice: what a board says of its points to a host.

use super::Budget;
use super::engine::walk_unordered;
use super::form::Form;

/// The sum, by whatever gives it fastest here.
#[inline]
pub(super) fn checksum(form: &Form<'_>, budget: &Budget) -> i32 {
    #[cfg(forward_asm)]
    if let Some(sum) = assembly::checksum(form, budget) {
        return sum;
    }
    let mut sum = 0_i32;
    walk_unordered(form, budget, |p| sum = sum.wrapping_add(p.x).wrapping_add(p.y).wrapping_add(p.z));
    sum
}

/// Residue classes.
#[cfg(any(forward_asm = "v6m", forward_asm = "rv32"))]
mod assembly {
    use crate::forward::Budget;
    use crate::forward::asm::{class_sum, walk_of};
    use crate::forward::form::Form;
    use crate::forward::residue::{Class, Classes};

    #[inline(never)]
    pub(super) fn checksum(form: &Form<'_>, budget: &Budget) -> Option<i32> {
        let classes = Classes::new(form, budget, 0)?;
        let (mut sum, mut class) = (0_i32, Class::default());
        let (count, shift) = (classes.count(), classes.place.shift());
        for j in 0..count {
            let Some(rows) = classes.last_row().checked_sub(j) else { break };
            for i in 0..count {
                let Some(columns) = classes.last_in_row(j).checked_sub(i) else { break };
                let points = (columns >> classes.bits) + 1;
                if classes.shrinks() {
                    // The rows of a class lose a point each, down to one.
                    classes.set_before(&mut class, i, j);
                    sum = sum.wrapping_add(class_sum(&mut walk_of(&class), shift, points, points));
                    continue;
                }
                classes.set(&mut class, i, j);
                for _ in 0..=rows >> classes.bits {
                    let alone = class.map(|[row, ..]| [row, [0; 4], [0; 4], [0; 4]]);
                    sum = sum.wrapping_add(class_sum(&mut walk_of(&alone), shift, points, 1));
                    classes.next_row(&mut class);
                }
            }
        }
        Some(sum)
    }
}

/// Rows as they are.
#[cfg(forward_asm = "v7m")]
mod assembly {
    use crate::forward::asm::{product_row, wide_row};
    use crate::forward::engine::integer_bits;
    use crate::forward::form::{Form, Kind};
    use crate::forward::kernel::{Accumulate, Mask};
    use crate::forward::table::{Table, step_s, step_triangle};
    use crate::forward::walk::Walker;
    use crate::forward::{Accumulator, Budget};
    use crate::num::Word;

    #[inline(never)]
    pub(super) fn checksum(form: &Form<'_>, budget: &Budget) -> Option<i32> {
        if form.weights().is_some() || form.degree() > 3 {
            return None;
        }
        if let Some(kernel) = Mask::<i32>::of(budget).filter(|_| budget.accumulator == Accumulator::I32) {
            return product(form, budget, kernel);
        }
        let kernel = Accumulate::<i64>::of(budget, integer_bits(form))?;
        if kernel.fraction_bits() == 48 { wide(form, budget, kernel) } else { None }
    }

    /// Moves to the next row, of which the value is an entry.
    #[inline(always)]
    fn step<W: Word>(form: &Form<'_>, tables: &mut [Table<W, 4>; 3]) {
        if form.kind == Kind::Triangle {
            tables.iter_mut().for_each(step_triangle);
        } else {
            tables.iter_mut().for_each(step_s);
        }
    }

    #[inline(never)]
    fn product(form: &Form<'_>, budget: &Budget, kernel: Mask<i32>) -> Option<i32> {
        let by = kernel.factor()?;
        let mut walker = Walker::<_, 4>::blank(kernel);
        walker.set_up_points(form, budget);
        let (mut tables, mut e) = ([[[0; 4]; 4]; 3], [0; 3]);
        for (axis, (table, e)) in tables.iter_mut().zip(&mut e).enumerate() {
            let (differences, x, below) = walker.start_of(axis)?;
            *table = *differences;
            (table[0][0], *e) = (x, below);
        }
        let mut sum = 0_i32;
        for j in 0..=form.last_row() {
            sum = sum.wrapping_add(product_row(&tables, &e, by, form.last_in_row(j) + 1));
            for ([[x, ..], [d, ..], ..], e) in tables.iter_mut().zip(&mut e) {
                let value = (i64::from(*x) << 32 | i64::from(*e as u32)).wrapping_add(i64::from(*d) * i64::from(by));
                // What the tables' step adds to x is taken off before.
                (*x, *e) = (((value >> 32) as i32).wrapping_sub(*d), value as i32);
            }
            step(form, &mut tables);
        }
        Some(sum)
    }

    #[inline(never)]
    fn wide(form: &Form<'_>, budget: &Budget, kernel: Accumulate<i64>) -> Option<i32> {
        let mut walker = Walker::<_, 4>::blank(kernel);
        walker.set_up_points(form, budget);
        let mut tables = [[[0; 4]; 4]; 3];
        for (axis, table) in tables.iter_mut().enumerate() {
            let (differences, _, value) = walker.start_of(axis)?;
            *table = *differences;
            table[0][0] = value;
        }
        let mut sum = 0_i32;
        for j in 0..=form.last_row() {
            sum = sum.wrapping_add(wide_row(&tables, form.last_in_row(j) + 1));
            step(form, &mut tables);
        }
        Some(sum)
    }
}
