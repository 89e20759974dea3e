//! Runs: neighbours of a row, made some at a time by code that does not know who looks at them.
//!
//! A walk fills a [`Buffer`] one coordinate after the other, so that the state of one coordinate is all that its loop
//! keeps in registers, and hands it on as a [`Run`]. The code of a kernel is then in an image once, whatever closures
//! points are given to, and each closure once, whatever kernels there are.

use super::fill::Room;
use super::lattice::LatticePoint;

/// The most points of a run: one more than a multiple of four, as [`fill`](super::fill) makes them.
pub(super) const RUN: usize = 49;

/// Room for the points of a run, x, y, z of each together.
pub(super) struct Buffer([i32; 3 * RUN + 2]);

/// Which points are in a [`Buffer`]: those at i, i + stride, … of row j.
#[derive(Clone, Copy, Debug)]
pub(super) struct Run {
    pub(super) i: u32,
    pub(super) j: u32,
    pub(super) stride: u32,
    pub(super) count: usize,
}

impl Buffer {
    pub(super) fn new() -> Self {
        Self([0; 3 * RUN + 2])
    }

    /// The room for one coordinate.
    #[inline(always)]
    pub(super) fn axis(&mut self, axis: usize) -> Option<&mut Room> {
        self.0.get_mut(axis..)?.first_chunk_mut()
    }

    /// Sets the point `at`.
    #[inline(always)]
    pub(super) fn set(&mut self, at: usize, point: [i32; 3]) {
        if let Some(entry) = self.0.as_chunks_mut().0.get_mut(at) {
            *entry = point;
        }
    }

    /// Gives the points of a run to `f`.
    #[inline(always)]
    pub(super) fn fold<B>(&self, run: &Run, state: B, f: &mut impl FnMut(B, LatticePoint) -> B) -> B {
        let (mut i, mut state) = (run.i, state);
        for [x, y, z] in self.0.as_chunks().0.get(..run.count).unwrap_or_default() {
            state = f(state, LatticePoint { i, j: run.j, x: *x, y: *y, z: *z });
            i += run.stride;
        }
        state
    }
}

/// A walk that goes on by runs.
pub(super) trait Runs {
    /// Makes the next run; `None` at the end.
    fn next_run(&mut self, buffer: &mut Buffer) -> Option<Run>;
}

/// What is done with every run.
pub(super) type Sink<'a> = &'a mut dyn FnMut(&Buffer, &Run);

/// Gives all runs of a walk to `sink`.
#[inline(always)]
pub(super) fn each(walk: &mut impl Runs, sink: Sink<'_>) {
    let mut buffer = Buffer::new();
    while let Some(run) = walk.next_run(&mut buffer) {
        sink(&buffer, &run);
    }
}
