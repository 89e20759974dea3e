//! Sub-lattices on cores with few registers, in any order: runs of points, made one coordinate after the other.
//!
//! A loop keeps one coordinate of one class: a value, two differences, and the last, which is read anew every eighth time so
//! that the loop is kept as it is written.

use super::fill::as_written;
use super::lattice::LatticePoint;
use super::residue::{Class, ClassRows, read};
use super::table::step_backward;
use core::cell::Cell;

/// Points of a coordinate that a loop makes at a time.
const LEN: usize = 8;

/// The most points of a run: those of a class of 256 steps are one.
const MOST: usize = 17 * LEN;

/// Room for the points of a run, x, y, z of each together, and two words more.
type Room = [i32; 3 * MOST + 2];

/// Gives all points of the classes to `f`.
#[inline(always)]
pub(super) fn visit<const SHIFT: u32>(rows: &mut ClassRows<'_, '_, '_>, mut f: impl FnMut(LatticePoint)) {
    let (mut room, mut past, stride) = ([0; 3 * MOST + 2], Class::default(), rows.classes.count());
    while rows.advance() {
        fill::<SHIFT>(&mut room, &rows.class, &mut past, rows.row.count as usize);
        let (mut i, j, mut left) = (rows.row.i, rows.row.j, rows.row.count as usize);
        loop {
            // Seen as a reference, it is walked by one register.
            let points = core::hint::black_box(&room).as_chunks::<3>().0;
            i = points.iter().take(left.min(MOST)).fold(i, |i, [x, y, z]| {
                f(LatticePoint { i, j, x: *x, y: *y, z: *z });
                as_written();
                i + stride
            });
            if left <= MOST {
                break;
            }
            left -= MOST;
            let here = past;
            fill::<SHIFT>(&mut room, &here, &mut past, left);
        }
    }
}

/// Makes as many of `count` points as there is room for, and their differences for those that come after them.
#[inline(never)]
fn fill<const SHIFT: u32>(room: &mut Room, class: &Class, past: &mut Class, count: usize) {
    let runs = count.min(MOST).div_ceil(LEN);
    for (offset, (table, past)) in class.iter().zip(past).enumerate() {
        let Some(room) = room.get_mut(offset..).and_then(|room| room.first_chunk_mut::<{ 3 * MOST }>()) else { return };
        let (mut v, last) = (table[0], Cell::new(table[0][3]));
        core::hint::black_box(&last);
        for entries in room.as_chunks_mut::<3>().0.as_chunks_mut::<LEN>().0.get_mut(..runs).unwrap_or_default() {
            v[3] = last.get();
            for [entry, ..] in entries {
                *entry = read::<SHIFT>(v[0]);
                step_backward(&mut v);
            }
            as_written();
        }
        if count > MOST {
            past[0] = v;
        }
    }
}
