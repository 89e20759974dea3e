//! The sub-lattice form: 32 bits for each residue class of the indices, where N = 2^f.
//!
//! # Why it is exact
//! f(i, j) = φ + ⌊N/2⌋ has integer coefficients, and i + q ≡ i modulo q, so f(i + qI, j + qJ) ≡ f(i, j) modulo q. With
//! q = 2^R the lowest R bits of f are therefore the same all over the class (i, j) modulo q, and ⌊f/q⌋ is a polynomial
//! with integer values in I and J: its Newton differences of stride q are integers, sums of them lose nothing. The
//! coordinate is ⌊f/N⌋ = ⌊⌊f/q⌋/2^(f−R)⌋. Of it only the bits that coordinates have are wanted, so everything may be
//! taken modulo 2^32 where these bits and the f − R below them are no more than 32. Below a coordinate of few bits
//! more fraction bits fit, which are zero; so the coordinate stands at one of three [`Place`]s, and a shift by it is part
//! of another instruction on many cores.
//!
//! A class takes m additions of 32 bits a coordinate, no carry, no mask. There are 4^R classes, each with a table of its
//! own: R is at most [`MOST`].

use super::Budget;
use super::class_runs;
use super::columns::BUFFERED;
use super::fill::{MULTIPLIES, as_written};
use super::form::{Form, Kind};
use super::lattice::LatticePoint;
use super::monomial::Monomials;
use super::table::{Table, step_back, step_backward, step_s, step_triangle};
use crate::num::Coord;
use core::cell::Cell;

/// The largest R: 16 classes.
const MOST: u32 = 2;

/// Rows of a class have at least so many points on average of a tensor patch, or the tables of classes cost more than
/// they gain.
const LEAST: u32 = 16;

/// Whether rows begin a step before their first point: their loop steps before it reads.
const BEGINS_BEFORE: bool = MULTIPLIES;

/// Where coordinates stand in 32 bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Place {
    /// 0 ..= 511 above 23 bits.
    Small,
    /// −512 ..= 511 above 22 bits.
    Screen,
    /// −32768 ..= 32767 above 16 bits.
    Large,
}

impl Place {
    fn of(form: &Form<'_>) -> Option<Self> {
        let rounded = |c: i64| (c + (1 << 15)) >> 16;
        let coordinates = || form.points().iter().flat_map(|p| p.to_array()).map(|c| rounded(c.bits()));
        let (low, high) = (coordinates().min()?, coordinates().max()?);
        let holds = |place: &Self| {
            let bits = 32 - place.shift();
            let (least, most) =
                if *place == Self::Small { (0, 1 << bits) } else { (-1 << (bits - 1), 1 << (bits - 1)) };
            least <= low && high < most
        };
        [Self::Small, Self::Screen, Self::Large].into_iter().find(holds)
    }

    pub(super) fn shift(self) -> u32 {
        match self {
            Self::Small => 23,
            Self::Screen => 22,
            Self::Large => 16,
        }
    }
}

/// The coordinate above so many bits.
#[inline(always)]
pub(super) fn read<const SHIFT: u32>(v: i32) -> i32 {
    if SHIFT == 23 { (v as u32 >> 23) as i32 } else { v >> SHIFT }
}

/// What is the same for all classes.
pub(super) struct Classes<'f, 'a> {
    form: &'f Form<'a>,
    powers: Monomials,
    pub(super) place: Place,
    /// R.
    pub(super) bits: u32,
}

/// The differences of a class: `[axis][b][a]`, backward ones along the row.
pub(super) type Class = [Table<i32, 4>; 3];

impl<'f, 'a> Classes<'f, 'a> {
    /// The classes where the form applies: a polynomial surface of degree at most 3, N a power of two, R small enough.
    /// R is at least `least`.
    #[inline(never)]
    pub(super) fn new(form: &'f Form<'a>, budget: &Budget, least: u32) -> Option<Self> {
        let steps = form.steps.0.min(form.steps.1);
        if form.weights().is_some() || form.kind == Kind::Curve || form.degree() > 3 {
            return None;
        }
        let fraction = budget.dyadic()?;
        let place = Place::of(form)?;
        let bits = fraction.saturating_sub(place.shift()).max(least);
        if bits > MOST || steps >> bits < LEAST {
            return None;
        }
        Some(Self { form, powers: Monomials::new(form, budget, fraction), place, bits })
    }

    /// q.
    pub(super) fn count(&self) -> u32 {
        1 << self.bits
    }

    /// The class of the points (i + qI, j + qJ).
    #[inline(never)]
    pub(super) fn set(&self, class: &mut Class, i: u32, j: u32) {
        for (axis, class) in class.iter_mut().enumerate() {
            self.powers.class(axis, (i, j), (self.bits, self.place.shift()), class);
        }
    }

    /// The class a row before its first one, with backward differences along columns, too.
    #[cfg(any(forward_asm = "v6m", forward_asm = "rv32"))]
    pub(super) fn set_before(&self, class: &mut Class, i: u32, j: u32) {
        for (axis, class) in class.iter_mut().enumerate() {
            self.powers.class_before(axis, (i, j), (self.bits, self.place.shift()), class);
        }
    }

    /// Moves a class to its next row.
    #[inline(always)]
    pub(super) fn next_row(&self, class: &mut Class) {
        if self.form.kind == Kind::Triangle {
            class.iter_mut().for_each(step_triangle);
        } else {
            class.iter_mut().for_each(step_s);
        }
    }

    /// The rows of all classes.
    #[inline(always)]
    pub(super) fn rows(&self) -> ClassRows<'_, 'f, 'a> {
        let row = ClassRow { i: 0, j: 0, count: 0 };
        let shrinks = self.form.kind == Kind::Triangle;
        ClassRows { classes: self, class: Class::default(), next: 0, row, left: 0, stride: self.count(), shrinks }
    }

    #[cfg(any(forward_asm = "v6m", forward_asm = "rv32"))]
    pub(super) fn shrinks(&self) -> bool {
        self.form.kind == Kind::Triangle
    }

    /// The last i of row `j`.
    pub(super) fn last_in_row(&self, j: u32) -> u32 {
        self.form.last_in_row(j)
    }

    pub(super) fn last_row(&self) -> u32 {
        self.form.last_row()
    }
}

/// The points i, i + stride, … of row j.
#[derive(Clone, Copy, Debug)]
pub(super) struct ClassRow {
    pub(super) i: u32,
    pub(super) j: u32,
    pub(super) count: u32,
}

/// A walk over the rows of all classes, one class after the other.
pub(super) struct ClassRows<'c, 'f, 'a> {
    pub(super) classes: &'c Classes<'f, 'a>,
    /// The differences at the start of the row; a step before it where the walk [`BEGINS_BEFORE`].
    pub(super) class: Class,
    /// The class after this one.
    next: u32,
    /// The row that is there.
    pub(super) row: ClassRow,
    /// The rows of the class after it.
    left: u32,
    stride: u32,
    shrinks: bool,
}

impl ClassRows<'_, '_, '_> {
    /// Goes to the next row.
    #[inline(always)]
    pub(super) fn next_row(&mut self) -> Option<ClassRow> {
        self.advance().then_some(self.row)
    }

    /// Goes to the next row, if there is one.
    #[inline(never)]
    pub(super) fn advance(&mut self) -> bool {
        if self.left == 0 {
            return self.start_class();
        }
        self.left -= 1;
        self.row.j += self.stride;
        if self.shrinks {
            // A row of a triangle's class has one point less than the one before it, for q divides the steps.
            self.row.count -= 1;
            self.class.iter_mut().for_each(step_triangle);
        } else {
            self.class.iter_mut().for_each(step_s);
        }
        true
    }

    /// Goes to the first row of the next class, if there is one.
    #[inline(never)]
    fn start_class(&mut self) -> bool {
        let Classes { bits, .. } = *self.classes;
        while self.next >> (2 * bits) == 0 {
            let (i, j) = (self.next & (self.stride - 1), self.next >> bits);
            self.next += 1;
            // The classes of a small lattice may have no point.
            let (last_in_row, last_row) = (self.classes.last_in_row(j), self.classes.last_row());
            if let (Some(columns), Some(rows)) = (last_in_row.checked_sub(i), last_row.checked_sub(j)) {
                let (columns, rows) = (columns >> bits, rows >> bits);
                self.row = ClassRow { i, j, count: columns + 1 };
                self.left = if self.shrinks { columns } else { rows };
                self.classes.set(&mut self.class, i, j);
                if BEGINS_BEFORE {
                    self.class.as_flattened_mut().iter_mut().for_each(step_back);
                }
                return true;
            }
        }
        false
    }
}

/// Visits all points, class by class.
#[inline(always)]
pub(super) fn visit(classes: &Classes<'_, '_>, f: impl FnMut(LatticePoint)) {
    let rows = &mut classes.rows();
    match classes.place {
        Place::Small => visit_rows::<23>(rows, f),
        Place::Screen => visit_rows::<22>(rows, f),
        Place::Large => visit_rows::<16>(rows, f),
    }
}

#[inline(always)]
fn visit_rows<const SHIFT: u32>(rows: &mut ClassRows<'_, '_, '_>, mut f: impl FnMut(LatticePoint)) {
    if BUFFERED {
        return class_runs::visit::<SHIFT>(rows, f);
    }
    let stride = rows.classes.count();
    while let Some(row) = rows.next_row() {
        if BEGINS_BEFORE {
            visit_row_by_axes::<SHIFT>(&rows.class, row, stride, &mut f);
        } else {
            visit_row::<SHIFT>(&rows.class, row, stride, &mut f);
        }
    }
}

/// A loop that reads the last differences of x and y anew: then nine values, one such difference and what `f` holds stay in
/// the 12 registers that there are. It steps before it reads, so that the optimiser adds coordinates to a sum of `f` one
/// after the other, with the shift in the addition.
#[inline(always)]
fn visit_row_by_axes<const SHIFT: u32>(class: &Class, row: ClassRow, stride: u32, f: &mut impl FnMut(LatticePoint)) {
    let [x, y, z] = class.each_ref().map(|table| table[0]);
    // Cells that something else might see are read where they are, on the stack, which takes no register for an address.
    let last = [x, y].map(|row| Cell::new(row[3]));
    core::hint::black_box(&last);
    let [last_x, last_y] = &last;
    let go = |mut v: [i32; 4]| {
        step_backward(&mut v);
        as_written();
        v
    };
    (0..row.count).fold((row.i, x, y, z), |(i, mut x, mut y, z), _| {
        x[3] = last_x.get();
        let (x, z) = (go(x), go(z));
        y[3] = last_y.get();
        let y = go(y);
        let [x_here, y_here, z_here] = [x[0], y[0], z[0]].map(read::<SHIFT>);
        f(LatticePoint { i, j: row.j, x: x_here, y: y_here, z: z_here });
        as_written();
        (i + stride, x, y, z)
    });
}

/// A loop for cores that have registers for all.
#[inline(always)]
fn visit_row<const SHIFT: u32>(class: &Class, row: ClassRow, stride: u32, f: &mut impl FnMut(LatticePoint)) {
    let (mut rows, mut i) = (class.each_ref().map(|table| table[0]), row.i);
    let mut go = |rows: &mut [[i32; 4]; 3]| {
        let [x, y, z] = [rows[0][0], rows[1][0], rows[2][0]].map(read::<SHIFT>);
        f(LatticePoint { i, j: row.j, x, y, z });
        i += stride;
        rows.iter_mut().for_each(step_backward);
    };
    for _ in 0..row.count >> 1 {
        go(&mut rows);
        go(&mut rows);
    }
    if row.count & 1 != 0 {
        go(&mut rows);
    }
}
