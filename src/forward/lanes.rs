//! Neighbours of a row in lockstep, for hosts with vector registers.
//!
//! In come the value and the differences of a row; out come the same coordinates in the same order, [`CHUNK`] at a
//! time. Lane c of [`LANES`] = L holds f(i + c), f = φ + ⌊N/2⌋ with N = 2^k, and goes on to f(i + c + L) by differences
//! of stride L, exact combinations of the row's own. All lanes do the same additions, which the compiler turns into
//! vector instructions.
//!
//! In 32-bit lanes the coordinate stands above as many fraction bits as fit. φ has integer coefficients, so
//! f(i + L) ≡ f(i) modulo L: the lowest log2 L bits of a lane never change, and differences of stride L do not have
//! them. They can be dropped before the walk, exactly.

use super::table::{double_stride, step};
use crate::num::Word;
use num_traits::AsPrimitive;

/// Lanes: 1, which is to say none, where words have 32 bits.
pub(super) const LANES: usize = if cfg!(target_pointer_width = "64") { 4 } else { 1 };

/// Points that are made before they are visited; shorter rows do not pay. A constant, and small: around a loop of
/// unknown length LLVM keeps the lanes in scalar registers.
pub(super) const CHUNK: usize = 32;

/// `[s][lane]`: the values of one coordinate and their differences of stride [`LANES`].
type Axis<T, const R: usize> = [[T; LANES]; R];

/// One coordinate of the next points.
type Block = [[i32; LANES]; CHUNK / LANES];

/// A row in lanes.
pub(super) enum Lanes<const R: usize> {
    /// The values without their lowest `drop` bits; `shift` more are below the coordinate.
    Narrow { drop: usize, shift: u32, axes: [Axis<i32, R>; 3] },
    /// The values times 2^`raise`: the coordinate is the highest 32 bits over 2^`shift`.
    Wide { raise: u32, shift: u32, axes: [Axis<i64, R>; 3] },
}

/// The next points of a row, per axis.
#[derive(Default)]
pub(super) struct Chunk([Block; 3]);

impl Chunk {
    /// The first `count` points.
    #[inline(always)]
    pub(super) fn points(&self, count: u32) -> impl Iterator<Item = [i32; 3]> {
        let [x, y, z] = self.0.each_ref().map(|block| block.as_flattened());
        x.iter().zip(y).zip(z).take(count as usize).map(|((x, y), z)| [*x, *y, *z])
    }
}

impl<const R: usize> Lanes<R> {
    /// Lanes for values with so many fraction and integer bits, at most 64 together; the narrow kind where no bit is
    /// lost that could change.
    pub(super) fn new((fraction, integer): (u32, u32)) -> Self {
        let drop = (fraction + integer).saturating_sub(i32::BITS);
        if drop <= LANES.ilog2() {
            let shift = fraction.saturating_sub(drop);
            Self::Narrow { drop: drop as usize, shift, axes: [[[0; LANES]; R]; 3] }
        } else {
            let raise = i64::BITS.saturating_sub(fraction + integer);
            Self::Wide { raise, shift: i32::BITS.saturating_sub(integer), axes: [[[0; LANES]; R]; 3] }
        }
    }

    /// Stands at the start of a row with values `e` and differences `d`.
    #[inline(never)]
    pub(super) fn start<W: Word>(&mut self, e: &[W; 3], d: &[[W; R]; 3]) {
        let rows = e.iter().zip(d);
        match self {
            Self::Narrow { drop, axes, .. } => {
                axes.iter_mut().zip(rows).for_each(|(axis, (e, d))| *axis = spread(*e, d, |v| (v >> *drop).as_()));
            }
            Self::Wide { raise, axes, .. } => {
                let raised = |v: W| AsPrimitive::<i64>::as_(v) << *raise;
                axes.iter_mut().zip(rows).for_each(|(axis, (e, d))| *axis = spread(*e, d, raised));
            }
        }
    }

    /// Makes the next [`CHUNK`] points of the row.
    #[inline(never)]
    pub(super) fn next(&mut self, Chunk(blocks): &mut Chunk) {
        match self {
            Self::Narrow { shift, axes, .. } => {
                axes.iter_mut().zip(blocks).for_each(|(axis, block)| narrow(axis, block, *shift));
            }
            Self::Wide { shift, axes, .. } => {
                axes.iter_mut().zip(blocks).for_each(|(axis, block)| wide(axis, block, *shift));
            }
        }
    }
}

/// The lanes of a row that stands at value `e` with differences `d`: neighbours step out of those that are there, then
/// all double their stride.
#[inline(always)]
fn spread<T, W: Word, const R: usize>(e: W, d: &[W; R], lane_of: impl Fn(W) -> T) -> Axis<T, R> {
    let mut lanes = [[W::ZERO; R]; LANES];
    lanes[0] = core::array::from_fn(|a| if a == 0 { e } else { d[a] });
    let mut count = 1;
    while count < LANES {
        for lane in 0..count {
            lanes[lane + count] = lanes[lane];
            step(&mut lanes[lane + count]);
        }
        count *= 2;
        for lane in &mut lanes[..count] {
            double_stride(lane);
        }
    }
    core::array::from_fn(|s| core::array::from_fn(|lane| lane_of(lanes[lane][s])))
}

// Functions of their own: inlined, LLVM scatters the lanes over scalar registers (measured: three times slower).

#[inline(never)]
fn narrow<const R: usize>(axis: &mut Axis<i32, R>, block: &mut Block, shift: u32) {
    advance(axis, block, i32::wrapping_add, |value| value >> shift);
}

#[inline(never)]
fn wide<const R: usize>(axis: &mut Axis<i64, R>, block: &mut Block, shift: u32) {
    advance(axis, block, i64::wrapping_add, |value| (value >> 32) as i32 >> shift);
}

/// Reads a block of points and goes past it.
#[inline(always)]
fn advance<T: Copy, const R: usize>(
    axis: &mut Axis<T, R>,
    block: &mut Block,
    plus: impl Fn(T, T) -> T,
    read: impl Fn(T) -> i32,
) {
    let mut values = *axis;
    for points in block {
        *points = values[0].map(&read);
        for s in 0..R - 1 {
            values[s] = core::array::from_fn(|lane| plus(values[s][lane], values[s + 1][lane]));
        }
    }
    *axis = values;
}

#[cfg(test)]
mod tests {
    use crate::forward::{Lattice, LatticePoint, Steps};
    use crate::geometry::Point3;
    use crate::patch::{SurfaceNet, TensorNet, TriangleNet};
    use std::vec::Vec;

    /// Points of this size and sign pattern, with some low bits set: whole coordinates only for `fraction` 0.
    fn net(len: usize, size: i32, fraction: u32) -> Vec<Point3> {
        let c = |k: usize| {
            let whole = (size * (k as i32 * 7 % 5 - 2) / 2) << 16;
            whole + if fraction > 0 { (k as i32 % 3) << (16 - fraction) } else { 0 }
        };
        (0..len).map(|k| Point3::from_bits(c(k), c(3 * k + 1), c(k * k))).collect()
    }

    /// `for_each` runs rows in lanes, `next` never does; also from the middle of a row.
    fn check(net: SurfaceNet<'_>, n: u32) {
        let lattice = Lattice::new(net, Steps::uniform(n).unwrap()).unwrap();
        let mut points = lattice.points();
        let one_by_one: Vec<LatticePoint> = core::iter::from_fn(|| points.next()).collect();
        for skipped in [0, 1, 31, n as usize, n as usize + 9] {
            let mut rest = lattice.points();
            rest.by_ref().take(skipped).for_each(drop);
            let mut in_lanes = Vec::new();
            rest.for_each(|p| in_lanes.push(p));
            assert!(in_lanes == one_by_one[skipped..], "{:?} n={n} after {skipped}", lattice.budget());
        }
    }

    /// All ways to fill lanes: n = 256 and 10 to 16 integer bits drop none to two bits or take the wide kind.
    #[test]
    fn lanes_give_the_points_of_the_plain_walk() {
        for (size, fraction) in [(3, 0), (201, 0), (1001, 0), (30_001, 0), (201, 4), (32_701, 1)] {
            for degree in 1..=5 {
                let points = net((degree + 1) * (degree + 1), size, fraction);
                let triangle = TriangleNet::new(degree, &points[..(degree + 1) * (degree + 2) / 2]).unwrap();
                for n in [32, 64, 128, 256] {
                    check(SurfaceNet::Triangle(triangle), n);
                }
                let tensor = TensorNet::new((degree, degree), &points).unwrap();
                for n in [32, 64] {
                    check(SurfaceNet::Tensor(tensor), n);
                }
            }
        }
    }
}
