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
use super::engine::integer_bits;
use super::fill::{MULTIPLIES, lane};
use super::form::{Form, Kind};
use super::kernel::Accumulate;
use super::lattice::LatticePoint;
use super::run::{Buffer, PAIRED, Run, Runs};
use super::table::{Table, double_stride, each_column, step, step_r, step_s, step_triangle};
use super::walk::Walker;
use crate::num::Coord;

/// The largest R: 16 classes.
const MOST: u32 = 2;

/// Rows of a class have at least so many points on average of a tensor patch, or the tables of classes cost more than
/// they gain.
const LEAST: u32 = 16;

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

/// The coordinate at a place, which a function of its own knows.
#[inline(always)]
fn read<const SHIFT: u32>(v: i32) -> i32 {
    if SHIFT == 23 { (v as u32 >> 23) as i32 } else { v >> SHIFT }
}

/// What is the same for all classes.
pub(super) struct Classes<'f, 'a> {
    form: &'f Form<'a>,
    base: Walker<Accumulate<i64>, 4>,
    pub(super) place: Place,
    /// R.
    bits: u32,
    /// What the values of `base` are shifted right by to stand at their place.
    down: i32,
}

/// The differences of a class: `[axis][b][a]`.
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
        let kernel = Accumulate::<i64>::of(budget, integer_bits(form))?;
        let down = kernel.fraction_bits() as i32 - place.shift() as i32;
        let mut classes = Self { form, base: Walker::blank(kernel), place, bits, down };
        classes.base.set_up_points(form, budget);
        Some(classes)
    }

    /// q.
    pub(super) fn count(&self) -> u32 {
        1 << self.bits
    }

    /// The class of the points (i + qI, j + qJ).
    #[inline(never)]
    pub(super) fn set(&self, class: &mut Class, i: u32, j: u32) {
        for (axis, class) in class.iter_mut().enumerate() {
            let Some((table, _, value)) = self.base.start_of(axis) else { return };
            let mut t = *table;
            t[0][0] = value;
            (0..i).for_each(|_| step_r(&mut t));
            (0..j).for_each(|_| step_s(&mut t));
            for _ in 0..self.bits {
                t.iter_mut().for_each(double_stride);
                each_column(&mut t, 3, |_, column| double_stride(column));
            }
            let place = |v: i64| if self.down < 0 { v << -self.down } else { v >> self.down } as i32;
            for (entry, v) in class.as_flattened_mut().iter_mut().zip(t.as_flattened()) {
                *entry = place(*v);
            }
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

    /// Gives every row of every class.
    #[inline(always)]
    pub(super) fn each_row(&self, class: &mut Class, mut f: impl FnMut(&Class, ClassRow)) {
        let (stride, last_row) = (self.count(), self.last_row());
        for first_row in 0..stride {
            for i in 0..stride {
                self.set(class, i, first_row);
                let mut j = first_row;
                while j <= last_row {
                    if let Some(rest) = self.last_in_row(j).checked_sub(i) {
                        f(class, ClassRow { i, j, stride, count: (rest >> self.bits) + 1 });
                    }
                    self.next_row(class);
                    j += stride;
                }
            }
        }
    }

    /// The last i of row `j`.
    pub(super) fn last_in_row(&self, j: u32) -> u32 {
        self.form.last_in_row(j)
    }

    pub(super) fn last_row(&self) -> u32 {
        self.form.last_row()
    }
}

/// The walk in row order where q = 2: even and odd columns each in 32 bits.
pub(super) struct Paired<'f, 'a> {
    classes: Classes<'f, 'a>,
    /// `[j modulo 2][i modulo 2]`, each at its next row.
    tables: [[Class; 2]; 2],
    /// `[i modulo 2][axis]`.
    row: [[[i32; 4]; 3]; 2],
    position: (u32, u32),
}

impl<'f, 'a> Paired<'f, 'a> {
    #[inline(always)]
    pub(super) fn new(classes: Classes<'f, 'a>) -> Option<Self> {
        if classes.bits != 1 {
            return None;
        }
        let tables = [[Class::default(); 2]; 2];
        let mut walk = Self { classes, tables, row: [[[0; 4]; 3]; 2], position: (0, 0) };
        for (j, columns) in (0..).zip(&mut walk.tables) {
            for (i, class) in (0..).zip(columns) {
                walk.classes.set(class, i, j);
            }
        }
        walk.start_row();
        Some(walk)
    }

    /// Takes the row from the tables, which go on to the next but one.
    fn start_row(&mut self) {
        let [even, odd] = &mut self.tables;
        let columns = if self.position.1 & 1 == 0 { even } else { odd };
        for (class, row) in columns.iter_mut().zip(&mut self.row) {
            for (row, table) in row.iter_mut().zip(class.iter()) {
                *row = table[0];
            }
            self.classes.next_row(class);
        }
    }
}

impl Runs for Paired<'_, '_> {
    #[inline(never)]
    fn next_run(&mut self, buffer: &mut Buffer) -> Option<Run> {
        let (i, j) = self.position;
        if j > self.classes.last_row() {
            return None;
        }
        let left = (self.classes.last_in_row(j) + 1).wrapping_sub(i);
        let count = left.min(PAIRED as u32);
        let place = self.classes.place;
        for (column, row) in self.row.iter_mut().enumerate() {
            let here = (count as usize + 1 - column) / 2;
            for (axis, row) in row.iter_mut().enumerate() {
                let Some(room) = buffer.column(axis, column) else { continue };
                match place {
                    Place::Small => lane(row, room, here, read::<23>),
                    Place::Screen => lane(row, room, here, read::<22>),
                    Place::Large => lane(row, room, here, read::<16>),
                }
            }
        }
        self.position.0 += count;
        if count == left {
            self.position = (0, j + 1);
            self.start_row();
        }
        Some(Run { i, j, stride: 1, count: count as usize })
    }
}

/// Visits all points, class by class.
#[inline]
pub(super) fn visit(classes: &Classes<'_, '_>, mut f: impl FnMut(LatticePoint)) {
    let mut class = Class::default();
    classes.each_row(&mut class, |class, row| match classes.place {
        Place::Small => visit_row::<23>(class, row, &mut f),
        Place::Screen => visit_row::<22>(class, row, &mut f),
        Place::Large => visit_row::<16>(class, row, &mut f),
    });
}

/// The points i, i + stride, … of row j.
#[derive(Clone, Copy, Debug)]
pub(super) struct ClassRow {
    i: u32,
    j: u32,
    stride: u32,
    pub(super) count: u32,
}

#[inline(never)]
fn visit_row<const SHIFT: u32>(class: &Class, row: ClassRow, f: &mut impl FnMut(LatticePoint)) {
    let mut rows = [class[0][0], class[1][0], class[2][0]];
    let mut point = |i, rows: &[[i32; 4]; 3]| {
        let [x, y, z] = [rows[0][0], rows[1][0], rows[2][0]].map(read::<SHIFT>);
        f(LatticePoint { i, j: row.j, x, y, z });
    };
    let mut i = row.i;
    if MULTIPLIES {
        // The compiler makes more of this.
        for _ in 1..row.count {
            point(i, &rows);
            i += row.stride;
            rows.iter_mut().for_each(step);
        }
        return point(i, &rows);
    }
    let mut go = |rows: &mut [[i32; 4]; 3]| {
        point(i, rows);
        i += row.stride;
        rows.iter_mut().for_each(step);
    };
    for _ in 0..row.count >> 1 {
        go(&mut rows);
        go(&mut rows);
    }
    if row.count & 1 != 0 {
        go(&mut rows);
    }
}
