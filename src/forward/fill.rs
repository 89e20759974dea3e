//! The loops that make the points of a row, one coordinate at a time: all that they keep is its differences.
//!
//! They are functions of their own, so that nothing else takes registers, and step before they write, so that a step is
//! made in place.

use super::columns::MOST;
use super::run::RUN;
use super::table::step_backward;
use crate::num::Word;
use num_traits::AsPrimitive;

/// Whether the core multiplies and adds to 64 bits in one instruction: ARMv7-M and later, which is to say all 32-bit ARM
/// cores with atomics but those of ARMv8-M baseline, where it costs time but not exactness.
pub(super) const MULTIPLIES: bool = cfg!(all(target_arch = "arm", target_has_atomic = "32"));

/// Keeps a loop as it is written: unrolled further, or with its sums regrouped, it would need more registers than
/// there are. It is no instruction, and changes nothing but what the optimiser makes of the loop.
#[inline(always)]
pub(super) fn as_written() {
    core::hint::black_box(());
}

/// Where the points of a run go that one coordinate at a time is made of: the first of each three entries.
pub(super) type Room = [i32; 3 * RUN];

/// Where [`lane`] puts points.
pub(super) type Lane = [i32; 3 * MOST];

#[inline(always)]
fn step<W: Word, const R: usize>(v: &mut [W; R]) {
    for a in 0..R - 1 {
        v[a] = v[a].wrapping_plus(v[a + 1]);
    }
}

/// Makes 1 + 4·`fours` points of value `e` and differences `d`, which go past them; `read` makes coordinates of values.
#[inline(always)]
pub(super) fn accumulate<W: Word, const R: usize>(
    e: &mut W,
    d: &mut [W; R],
    out: &mut Room,
    fours: usize,
    read: impl Fn(W) -> i32,
) {
    let mut v = *d;
    v[0] = *e;
    let first = read(v[0]);
    each(out, fours, first, || {
        step(&mut v);
        read(v[0])
    });
    step(&mut v);
    (*e, *d) = (v[0], v);
}

/// [`accumulate`] for a value of 64 bits, the coordinate x in its upper half and e in its lower, whose differences of 32
/// bits count `by` each: cores that multiply and add to 64 bits in one instruction take three a coordinate.
#[inline(always)]
pub(super) fn multiply<W: Word, const R: usize>(
    value: i64,
    d: &mut [W; R],
    by: i32,
    out: &mut Room,
    fours: usize,
) -> i64 {
    let (mut value, mut v, first) = (value, *d, (value >> 32) as i32);
    let mut next = || {
        value = value.wrapping_add(i64::from(AsPrimitive::<i32>::as_(v[1])) * i64::from(by));
        for a in 1..R - 1 {
            v[a] = v[a].wrapping_plus(v[a + 1]);
        }
        (value >> 32) as i32
    };
    let Some(([entry, ..], rest)) = out.as_chunks_mut::<3>().0.split_first_mut() else { return value };
    *entry = first;
    // Counted, which leaves one more register than an end does.
    for [[x, ..], [y, ..], [z, ..], [w, ..]] in rest.as_chunks_mut::<4>().0.iter_mut().take(fours) {
        for entry in [x, y, z, w] {
            *entry = next();
            as_written();
        }
    }
    next();
    *d = v;
    value
}

/// Sets the first of each three entries to `first`, and after it to what `next` gives.
#[inline(always)]
pub(super) fn each(out: &mut Room, fours: usize, first: i32, mut next: impl FnMut() -> i32) {
    let Some(([entry, ..], rest)) = out.as_chunks_mut::<3>().0.split_first_mut() else { return };
    *entry = first;
    for [[x, ..], [y, ..], [z, ..], [w, ..]] in rest.as_chunks_mut::<4>().0.get_mut(..fours).unwrap_or_default() {
        for entry in [x, y, z, w] {
            *entry = next();
            as_written();
        }
    }
}

/// Makes 4·`fours` points of a coordinate: of value `v[0]` with backward differences `v[1..]`, which go past them. They go
/// to the first of each S entries.
#[inline(never)]
pub(super) fn lane<const S: usize>(row: &mut [i32; 4], room: &mut Lane, fours: usize, read: impl Fn(i32) -> i32) {
    let (mut v, last) = (*row, core::hint::black_box(&row[3]));
    room.as_chunks_mut::<S>().0.as_chunks_mut::<4>().0.iter_mut().take(fours).for_each(|entries| {
        // Read anew: the loop is kept as it is written.
        v[3] = *last;
        for entry in entries.iter_mut().filter_map(|point| point.first_mut()) {
            *entry = read(v[0]);
            step_backward(&mut v);
        }
        as_written();
    });
    [row[0], row[1], row[2]] = [v[0], v[1], v[2]];
}
