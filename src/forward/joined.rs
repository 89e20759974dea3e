//! Rows of cubics on cores that multiply and add to 64 bits in one instruction, where N = 2^f.
//!
//! # Why it is exact
//! The value of a coordinate is one number of 64 bits: x above, and e·2^(32−f) in the lower half, 0 ≤ e < N. A step adds
//! Δφ·2^(32−f), which moves x by ⌊(e + Δφ)/N⌋ and leaves the residual. Δφ has its sign in 32 bits, for |Δφ| ≤ K·N and
//! (2K+1)·N < 2^32; differences of it may wrap.
//!
//! # How it is fast
//! Differences are backward ones along the row, Δ^a f(i − a): then each addition of a step needs what the one before it
//! made, and nothing is copied. A loop makes x and y of a run, ten instructions a point, which is what its state in 13
//! registers takes: two loads less would want z in them, too. z is made where points are given away, so that it is never
//! stored. Both loops are turned once per point: in unrolled ones the optimiser regroups sums, and copies what a
//! multiplication that adds overwrites while it is still to be stored (measured: 2 to 4 instructions a point more).

use super::fill::as_written;
use super::form::{Form, Kind};
use super::kernel::{Mask, Residual};
use super::lattice::LatticePoint;
use super::table::{Table, step_s, to_backward};
use super::walk::Walker;
use super::{Accumulator, Budget};

/// The most points of a run: half of a row of 256 steps.
const LEN: usize = 128;

/// x and y of the points of a run.
type Room = [[i32; 2]; LEN];

/// A coordinate in a row: x above 32 bits, and what is added in a step.
#[derive(Clone, Copy, Debug, Default)]
struct Axis {
    value: i64,
    d: [i32; 3],
}

impl Axis {
    #[inline(always)]
    fn x(&self) -> i32 {
        (self.value >> 32) as i32
    }

    #[cfg(forward_asm = "v7m")]
    #[inline(always)]
    fn words(&self) -> [i32; 5] {
        let [one, two, three] = self.d;
        [self.value as i32, self.x(), one, two, three]
    }

    #[inline(always)]
    fn step(&mut self, by: i32) {
        let [one, two, three] = &mut self.d;
        *two = two.wrapping_add(*three);
        *one = one.wrapping_add(*two);
        self.value = self.value.wrapping_add(i64::from(*one) * i64::from(by));
    }
}

/// A walk in row order.
#[derive(Clone, Debug)]
pub(super) struct Joined {
    /// 2^32/N.
    by: i32,
    triangle: bool,
    last_row: u32,
    /// The last i of the row.
    last_in_row: u32,
    /// (i, j) of the run that is there, and of the one to come.
    position: (u32, u32),
    next: (u32, u32),
    /// The values at the start of the row.
    start: [i64; 3],
    /// `[axis][b][a]` at the start of the row, backward along the row; the value itself is not in it.
    tables: [Table<i32, 4>; 3],
    /// x and y where the next run goes on in the row; z where the run that is there starts, and after it.
    row: [Axis; 3],
}

impl Joined {
    /// The walk over a polynomial surface of degree at most 3 whose differences have 32 bits, N a power of two above 2.
    #[inline(never)]
    pub(super) fn new(form: &Form<'_>, budget: &Budget) -> Option<Self> {
        if form.weights().is_some() || form.degree() > 3 || budget.accumulator != Accumulator::I32 {
            return None;
        }
        let by = Mask::<i32>::of(budget)?.factor()?;
        let mut base = Walker::<_, 4>::blank(Residual::<i32>::of(budget));
        base.set_up_points(form, budget);
        let mut walk = Self {
            by,
            triangle: form.kind == Kind::Triangle,
            last_row: form.last_row(),
            last_in_row: form.last_in_row(0),
            position: (0, 0),
            next: (0, 0),
            start: [0; 3],
            tables: [[[0; 4]; 4]; 3],
            row: [Axis::default(); 3],
        };
        for (axis, (start, rows)) in walk.start.iter_mut().zip(&mut walk.tables).enumerate() {
            let (table, x, e) = base.start_of(axis)?;
            *start = (i64::from(x) << 32).wrapping_add(i64::from(e) * i64::from(by));
            *rows = *table;
            rows.iter_mut().for_each(to_backward);
        }
        Some(walk)
    }

    /// Gives all points to `f`.
    #[inline(always)]
    pub(super) fn for_each(&mut self, mut f: impl FnMut(LatticePoint)) {
        let mut room = [[0; 2]; LEN];
        loop {
            let count = self.next_run(&mut room);
            if count == 0 {
                return;
            }
            let ((i, j), [.., axis], by) = (self.position, self.row, self.by);
            // Seen as a reference, it is walked by one register.
            let points = core::hint::black_box(&room);
            let (_, axis) = points.iter().take(count).fold((i, axis), |(i, mut axis), [x, y]| {
                f(LatticePoint { i, j, x: *x, y: *y, z: axis.x() });
                as_written();
                axis.step(by);
                (i + 1, axis)
            });
            (self.row[2].value, self.row[2].d) = (axis.value, axis.d);
        }
    }

    /// Makes x and y of the next run, and returns how many points are in it; 0 at the end.
    #[inline(never)]
    fn next_run(&mut self, room: &mut Room) -> usize {
        let (i, j) = self.next;
        if j > self.last_row {
            return 0;
        }
        let ([mut x, mut y, _], by) = (self.row, self.by);
        if i == 0 {
            if j > 0 {
                self.next_row();
            }
            (x, y, self.row[2]) = (self.axis(0), self.axis(1), self.axis(2));
        }
        let left = self.last_in_row.wrapping_sub(i).wrapping_add(1);
        let count = left.min(LEN as u32);
        room.iter_mut().take(count as usize).for_each(|entry| {
            *entry = [x.x(), y.x()];
            as_written();
            x.step(by);
            y.step(by);
        });
        self.position = (i, j);
        if count == left {
            self.next = (0, j + 1);
        } else {
            self.next.0 += count;
            (self.row[0], self.row[1]) = (x, y);
        }
        count as usize
    }

    /// Gives every row to `f`: j, how many points, and of each axis the lower and the upper half of the value at its
    /// start, and the differences.
    #[cfg(forward_asm = "v7m")]
    #[inline(always)]
    pub(super) fn each_row(&mut self, mut f: impl FnMut(u32, u32, [[i32; 5]; 3])) {
        for j in 0..=self.last_row {
            f(j, self.last_in_row.wrapping_add(1), [self.axis(0), self.axis(1), self.axis(2)].map(|axis| axis.words()));
            self.next_row();
        }
    }

    /// 2^32/N.
    #[cfg(forward_asm = "v7m")]
    pub(super) fn by(&self) -> i32 {
        self.by
    }

    /// A coordinate at the start of the row.
    #[inline(always)]
    fn axis(&self, axis: usize) -> Axis {
        let [_, one, two, three] = self.tables[axis][0];
        Axis { value: self.start[axis], d: [one, two, three] }
    }

    #[inline(always)]
    fn next_row(&mut self) {
        for (start, table) in self.start.iter_mut().zip(&mut self.tables) {
            *start = start.wrapping_add(i64::from(table[1][0]) * i64::from(self.by));
            if let (true, [[_, a, b, _], [c, d, e, _], [f, g, ..], [h, ..]]) = (self.triangle, &mut *table) {
                // What is left out is zero, or the value.
                (*a, *b) = (a.wrapping_add(*d), b.wrapping_add(*e));
                (*c, *d) = (c.wrapping_add(*f), d.wrapping_add(*g));
                *f = f.wrapping_add(*h);
            } else {
                step_s(table);
            }
        }
        self.last_in_row = self.last_in_row.wrapping_sub(u32::from(self.triangle));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::forward::{Lattice, Steps};
    use crate::geometry::Point3;
    use crate::patch::{SurfaceNet, TensorNet, TriangleNet};
    use std::vec::Vec;

    /// Gives every point as the walk that goes one by one does; returns whether the form applies.
    fn check(net: SurfaceNet<'_>, n: u32, centred: bool) -> bool {
        let steps = Steps::uniform(n).unwrap();
        let (lattice, form) = if centred {
            (Lattice::centres(net, steps).unwrap(), Form::surface(net, (n, n)).centres())
        } else {
            (Lattice::new(net, steps).unwrap(), Form::surface(net, (n, n)))
        };
        let Some(mut walk) = Joined::new(&form, lattice.budget()) else { return false };
        let mut points = lattice.points();
        let one_by_one: Vec<LatticePoint> = core::iter::from_fn(|| points.next()).collect();
        let mut joined = Vec::new();
        walk.for_each(|p| joined.push(p));
        assert!(joined == one_by_one, "{:?} n={n}", lattice.budget());
        true
    }

    #[test]
    fn joined_rows_give_the_points_of_the_plain_walk() {
        let mut applied = 0;
        for (size, fraction) in [(3, 0), (201, 0), (32_701, 0), (201, 4)] {
            let bits = |k: usize| {
                let whole = (size * (k as i32 * 7 % 5 - 2) / 2) << 16;
                whole + if fraction > 0 { (k as i32 % 3) << (16 - fraction) } else { 0 }
            };
            let points: Vec<_> =
                (0..16).map(|k: usize| Point3::from_bits(bits(k), bits(3 * k + 1), bits(k * k))).collect();
            for degree in 1..=3 {
                let triangle = TriangleNet::new(degree, &points[..(degree + 1) * (degree + 2) / 2]).unwrap();
                let tensor = TensorNet::new((degree, degree), &points[..(degree + 1) * (degree + 1)]).unwrap();
                // Rows of less than a run, of a run and one point, of three.
                for n in [1, 2, 8, 32, 128, 256] {
                    for centred in [false, true] {
                        applied += u32::from(check(SurfaceNet::Triangle(triangle), n, centred));
                        applied += u32::from(check(SurfaceNet::Tensor(tensor), n, centred));
                    }
                }
            }
        }
        assert!(applied > 100, "{applied}");
    }
}
