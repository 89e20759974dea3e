//! Sub-lattices on cores with few registers, in row order: runs of points, made one coordinate after the other.
//!
//! A loop keeps one coordinate of one class: a value, two differences, and the last, which is read anew every fourth
//! time so that the loop is kept as it is written.

#[cfg(forward_asm = "v6m")]
use super::asm::{PAIRS, pairs};
use super::fill::{Lane, MULTIPLIES, as_written, lane};
use super::lanes::LANES;
use super::lattice::LatticePoint;
use super::residue::{Class, Classes, Place, read};
use super::run::Run;

/// Whether sub-lattices are made by runs: on 32-bit cores with neither registers for three coordinates at a time nor a
/// multiplication that adds to 64 bits.
pub(super) const BUFFERED: bool = LANES == 1 && !MULTIPLIES && !cfg!(target_arch = "riscv32");

/// The most points of a run.
pub(super) const MOST: usize = 96;
#[cfg(forward_asm = "v6m")]
const _: () = assert!(MOST == 2 * PAIRS);

/// Room for the points of a run, x, y, z of each together.
pub(super) struct Columns([i32; 3 * MOST + 5]);

impl Columns {
    /// Makes `count` points of S coordinates, which are side by side, and of S more, and so on.
    #[inline(always)]
    fn fill<const S: usize>(&mut self, rows: &mut [[i32; 4]; S], place: Place, count: usize) {
        let fours = count.div_ceil(4);
        #[cfg(forward_asm = "v6m")]
        if S == 6 {
            for (offset, rows) in [0, 3].into_iter().zip(rows.as_chunks_mut::<3>().0) {
                if let Some(room) = self.0.get_mut(offset..).and_then(|room| room.first_chunk_mut()) {
                    pairs(rows, room, fours, place.shift());
                }
            }
            return;
        }
        for (offset, row) in rows.iter_mut().enumerate() {
            let Some(room) = self.0.get_mut(offset..).and_then(|room| room.first_chunk_mut::<{ 3 * MOST }>()) else {
                return;
            };
            let room: &mut Lane = room;
            match place {
                Place::Small => lane::<S>(row, room, fours, read::<23>),
                Place::Screen => lane::<S>(row, room, fours, read::<22>),
                Place::Large => lane::<S>(row, room, fours, read::<16>),
            }
        }
    }
}

/// Gives all points of a walk to `f`.
#[inline(always)]
pub(super) fn visit_runs(walk: &mut Paired<'_, '_>, mut f: impl FnMut(LatticePoint)) {
    let mut columns = Columns([0; 3 * MOST + 5]);
    while let Some(run) = walk.next_run(&mut columns) {
        // Seen as a reference, it is walked by one register.
        let points = core::hint::black_box(&columns.0).as_chunks().0;
        points.iter().take(run.count).fold(run.i, |i, [x, y, z]| {
            f(LatticePoint { i, j: run.j, x: *x, y: *y, z: *z });
            as_written();
            i + run.stride
        });
    }
}

/// The walk in row order where q = 2: even and odd columns each in 32 bits.
pub(super) struct Paired<'f, 'a> {
    classes: Classes<'f, 'a>,
    /// `[j modulo 2][i modulo 2]`, each at its next row.
    tables: [[Class; 2]; 2],
    /// x, y, z of the even column and of the odd one.
    row: [[i32; 4]; 6],
    position: (u32, u32),
}

impl<'f, 'a> Paired<'f, 'a> {
    #[inline(always)]
    pub(super) fn new(classes: Classes<'f, 'a>) -> Option<Self> {
        if classes.bits != 1 {
            return None;
        }
        let tables = [[Class::default(); 2]; 2];
        let mut walk = Self { classes, tables, row: [[0; 4]; 6], position: (0, 0) };
        for (j, columns) in (0..).zip(&mut walk.tables) {
            for (i, class) in (0..).zip(columns) {
                walk.classes.set(class, i, j);
            }
        }
        Some(walk)
    }

    /// Takes the row from the tables, which go on to the next but one.
    fn start_row(&mut self) {
        let [even, odd] = &mut self.tables;
        let columns = if self.position.1 & 1 == 0 { even } else { odd };
        for (row, table) in self.row.iter_mut().zip(columns.as_flattened()) {
            *row = table[0];
        }
        for class in columns {
            self.classes.next_row(class);
        }
    }

    /// Makes the next run; `None` at the end.
    #[inline(never)]
    fn next_run(&mut self, columns: &mut Columns) -> Option<Run> {
        let (i, j) = self.position;
        if j > self.classes.last_row() {
            return None;
        }
        if i == 0 {
            self.start_row();
        }
        let left = (self.classes.last_in_row(j) + 1).wrapping_sub(i);
        let count = left.min(MOST as u32);
        columns.fill(&mut self.row, self.classes.place, count.div_ceil(2) as usize);
        self.position = if count == left { (0, j + 1) } else { (i + count, j) };
        Some(Run { i, j, stride: 1, count: count as usize })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::forward::class_runs as runs;
    use crate::forward::form::Form;
    use crate::forward::{Lattice, Steps};
    use crate::geometry::Point3;
    use crate::patch::{SurfaceNet, TensorNet, TriangleNet};
    use std::vec::Vec;

    /// Both walks give every point as the walk that goes one by one does; returns which of them apply.
    fn check(net: SurfaceNet<'_>, n: u32) -> [bool; 2] {
        let lattice = Lattice::new(net, Steps::uniform(n).unwrap()).unwrap();
        let form = Form::surface(net, (n, n));
        let mut points = lattice.points();
        let mut one_by_one: Vec<LatticePoint> = core::iter::from_fn(|| points.next()).collect();
        let paired = Classes::new(&form, lattice.budget(), 1).and_then(Paired::new);
        let in_rows = paired.map(|mut walk| {
            let mut seen = Vec::new();
            visit_runs(&mut walk, |p| seen.push(p));
            assert!(seen == one_by_one, "{:?} n={n}", lattice.budget());
        });
        let classes = Classes::new(&form, lattice.budget(), 0);
        let by_class = classes.map(|classes| {
            let (mut seen, rows) = (Vec::new(), &mut classes.rows());
            match classes.place {
                Place::Small => runs::visit::<23>(rows, |p| seen.push(p)),
                Place::Screen => runs::visit::<22>(rows, |p| seen.push(p)),
                Place::Large => runs::visit::<16>(rows, |p| seen.push(p)),
            }
            let key = |p: &LatticePoint| (p.j, p.i);
            seen.sort_by_key(key);
            one_by_one.sort_by_key(key);
            assert!(seen == one_by_one, "{:?} n={n}", lattice.budget());
        });
        [in_rows.is_some(), by_class.is_some()]
    }

    #[test]
    fn runs_of_columns_give_the_points_of_the_plain_walk() {
        let mut applied = [0; 2];
        // What each place holds.
        for (low, high) in [(0, 511), (-201, 201), (-20_001, 20_001)] {
            let coordinate = |k: usize| low + (high - low) * (k as i32 * 7 % 5) / 4;
            let points: Vec<_> = (0..16)
                .map(|k: usize| {
                    let [x, y, z] = [k, 3 * k + 1, k * k].map(|k| coordinate(k) << 16);
                    Point3::from_bits(x, y, z)
                })
                .collect();
            for degree in 1..=3 {
                let triangle = TriangleNet::new(degree, &points[..(degree + 1) * (degree + 2) / 2]).unwrap();
                let tensor = TensorNet::new((degree, degree), &points[..(degree + 1) * (degree + 1)]).unwrap();
                for n in [32, 64, 128, 256] {
                    for net in [SurfaceNet::Triangle(triangle), SurfaceNet::Tensor(tensor)] {
                        let here = check(net, n);
                        applied = [applied[0] + u32::from(here[0]), applied[1] + u32::from(here[1])];
                    }
                }
            }
        }
        assert!(applied[0] > 20 && applied[1] > 20, "{applied:?}");
    }
}
