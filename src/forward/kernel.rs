//! The three ways to carry a rounded coordinate through a difference.
//!
//! A coordinate of value φ/N is carried as x = floor((φ + ⌊N/2⌋)/N), which is floor(φ/N + 1/2) for even and odd N,
//! and e = φ + ⌊N/2⌋ − N·x in 0 ..= N − 1.

use super::Budget;
use super::fill::{self, MULTIPLIES, Room};
use super::lanes::LANES;
use crate::num::Word;
use num_traits::AsPrimitive;

/// One way to carry (x, e). All arithmetic is modulo 2^w.
pub(crate) trait Kernel: Copy {
    type Word: Word;

    /// (x, e) in the kernel's own representation.
    fn start(&self, x: i32, e: Self::Word) -> (i32, Self::Word);

    /// Adds the difference `d` of φ.
    fn advance(&self, x: &mut i32, e: &mut Self::Word, d: Self::Word);

    /// The rounded coordinate.
    fn read(&self, x: i32, e: Self::Word) -> i32;

    /// By how many bits all values are shifted left in this kernel's own representation.
    #[inline(always)]
    fn raise(&self) -> usize {
        0
    }

    /// Writes the points of a row to the first of each three entries of `out`, and goes past them.
    #[inline(never)]
    fn fill<const R: usize>(
        &self,
        x: &mut i32,
        e: &mut Self::Word,
        d: &mut [Self::Word; R],
        out: &mut Room,
        count: usize,
    ) {
        fill_by_steps(*self, x, e, d, out, count);
    }

    /// The fraction and integer bits of e where it holds N·x + e and nothing else moves: such rows can run in lanes.
    #[inline(always)]
    fn bits(&self) -> Option<(u32, u32)> {
        None
    }
}

#[inline(always)]
fn fill_by_steps<K: Kernel, const R: usize>(
    kernel: K,
    x: &mut i32,
    e: &mut K::Word,
    d: &mut [K::Word; R],
    out: &mut Room,
    count: usize,
) {
    let (mut here, mut row) = ((*x, *e), *d);
    for [entry, ..] in out.as_chunks_mut::<3>().0.iter_mut().take(count) {
        *entry = kernel.read(here.0, here.1);
        kernel.advance(&mut here.0, &mut here.1, row[1]);
        for a in 1..R - 1 {
            row[a] = row[a].wrapping_plus(row[a + 1]);
        }
    }
    ((*x, *e), *d) = (here, row);
}

/// N = 2^f with room for the coordinate above f: e holds N·x + e, where words have 32 bits shifted up to the top of a
/// longer one, so that the upper half is all that is read.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Accumulate<W> {
    shift: usize,
    raise: usize,
    /// Only lanes ask.
    #[cfg(target_pointer_width = "64")]
    integer_bits: u32,
    word: core::marker::PhantomData<W>,
}

/// N = 2^f, e in f bits; right while (K+1)·N ≤ 2^(w−1), which is (2K+1)·N < 2^w for such N.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Mask<W> {
    shift: usize,
    mask: W,
}

/// Any N.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Residual<W> {
    scale: W,
    half: W,
    /// ⌊log2 K⌋.
    ladder: u32,
}

impl<W: Word> Accumulate<W> {
    /// The kernel where N is a power of two and `integer_bits`, sign included, fit above it.
    pub(crate) fn of(budget: &Budget, integer_bits: u32) -> Option<Self> {
        let shift = budget.dyadic().filter(|f| f + integer_bits <= <W as Word>::BITS)?;
        let room = <W as Word>::BITS - (shift + integer_bits);
        let raise = match 48_u32.checked_sub(shift) {
            _ if LANES > 1 || <W as Word>::BITS == 32 => 0,
            // The same place for most: 16 bits above 48.
            Some(raise) if raise <= room => raise as usize,
            _ => room as usize,
        };
        Some(Self {
            shift: shift as usize + raise,
            raise,
            #[cfg(target_pointer_width = "64")]
            integer_bits,
            word: core::marker::PhantomData,
        })
    }

    /// The bits below the coordinate.
    #[cfg(forward_asm = "v7m")]
    pub(super) fn fraction_bits(&self) -> usize {
        self.shift
    }
}

impl<W: Word> Kernel for Accumulate<W> {
    type Word = W;

    fn start(&self, x: i32, e: W) -> (i32, W) {
        (0, (W::truncate(x.into()) << self.shift).wrapping_plus(e << self.raise))
    }

    #[inline(always)]
    fn raise(&self) -> usize {
        self.raise
    }

    #[inline(always)]
    fn advance(&self, _: &mut i32, e: &mut W, d: W) {
        *e = e.wrapping_plus(d);
    }

    #[inline(always)]
    fn read(&self, _: i32, e: W) -> i32 {
        if LANES > 1 || <W as Word>::BITS == 32 {
            return (e >> self.shift).as_();
        }
        // At most 32 bits are above the shift.
        let upper: i32 = (e >> 32).as_();
        upper >> (self.shift & 31)
    }

    #[inline(never)]
    fn fill<const R: usize>(&self, _: &mut i32, e: &mut W, d: &mut [W; R], out: &mut Room, count: usize) {
        let kernel = *self;
        fill::accumulate(e, d, out, (count + 2) / 4, |v| kernel.read(0, v));
    }

    #[cfg(target_pointer_width = "64")]
    #[inline(always)]
    fn bits(&self) -> Option<(u32, u32)> {
        Some((self.shift as u32, self.integer_bits))
    }
}

impl<W: Word> Mask<W> {
    /// Whether x and e are one number of 64 bits, x in the upper half and e below it, and Δφ is multiplied to fit: one
    /// instruction a step. N > 2^14 here, or the coordinate would fit above N, and |Δφ| ≤ K·N < 2^31 has its sign.
    const JOINED: bool = MULTIPLIES && <W as Word>::BITS == 32;

    pub(crate) fn of(budget: &Budget) -> Option<Self> {
        let shift = budget.dyadic()? as usize;
        Some(Self { shift, mask: W::truncate((1_i128 << shift) - 1) })
    }

    /// What Δφ is multiplied by: 2^32/N.
    #[inline(always)]
    fn by(&self) -> i32 {
        1 << (32_usize.wrapping_sub(self.shift) & 31)
    }

    /// What Δφ is multiplied by where x and e are one number of 64 bits; `None` for an N that is too small for that.
    pub(super) fn factor(&self) -> Option<i32> {
        (2..32).contains(&self.shift).then(|| self.by())
    }

    #[inline(always)]
    fn join(x: i32, e: W) -> i64 {
        i64::from(x) << 32 | i64::from(AsPrimitive::<i32>::as_(e) as u32)
    }

    #[inline(always)]
    fn part(value: i64) -> (i32, W) {
        ((value >> 32) as i32, W::truncate(i128::from(value as i32)))
    }
}

impl<W: Word> Kernel for Mask<W> {
    type Word = W;

    fn start(&self, x: i32, e: W) -> (i32, W) {
        (x, if Self::JOINED { e.wrapping_mul_i64(self.by().into()) } else { e })
    }

    #[inline(always)]
    fn advance(&self, x: &mut i32, e: &mut W, d: W) {
        if Self::JOINED {
            let change = i64::from(AsPrimitive::<i32>::as_(d)) * i64::from(self.by());
            (*x, *e) = Self::part(Self::join(*x, *e).wrapping_add(change));
            return;
        }
        let v = e.wrapping_plus(d);
        let step: i32 = (v >> self.shift).as_();
        *x = x.wrapping_add(step);
        *e = v & self.mask;
    }

    #[inline(always)]
    fn read(&self, x: i32, _: W) -> i32 {
        x
    }

    #[inline(never)]
    fn fill<const R: usize>(&self, x: &mut i32, e: &mut W, d: &mut [W; R], out: &mut Room, count: usize) {
        if !Self::JOINED {
            let (kernel, mut here, mut row, first) = (*self, (*x, *e), *d, *x);
            let mut next = || {
                kernel.advance(&mut here.0, &mut here.1, row[1]);
                for a in 1..R - 1 {
                    row[a] = row[a].wrapping_plus(row[a + 1]);
                }
                here.0
            };
            fill::each(out, (count + 2) / 4, first, &mut next);
            next();
            ((*x, *e), *d) = (here, row);
            return;
        }
        (*x, *e) = Self::part(fill::multiply(Self::join(*x, *e), d, self.by(), out, (count + 2) / 4));
    }
}

impl<W: Word> Residual<W> {
    pub(crate) fn of(budget: &Budget) -> Self {
        let scale = W::truncate(budget.scale as i128);
        Self { scale, half: scale >> 1, ladder: budget.largest_step.checked_ilog2().unwrap_or(0) }
    }

    /// Brings v = e + d, which left 0 ..= N − 1, back into it; returns the change of x.
    ///
    /// v lies in (−K·N, (K+1)·N), so v − ⌊N/2⌋ has its true sign in w bits. Multiples N·2^b with 2^b ≤ K stay below
    /// 2^(w−1), and compares are unsigned because K·N + N ≤ (2K+1)·N < 2^w.
    #[inline(never)]
    fn settle(&self, v: W) -> (i32, W) {
        let negative = v.wrapping_minus(self.half) < W::ZERO;
        // −1 − v counts how far below zero v is; it loses as many N as v must gain, less one.
        let mut rest = if negative { !v } else { v };
        let mut moved = 0;
        for bit in (0..=self.ladder).rev() {
            let multiple = self.scale << bit as usize;
            if !rest.below(multiple) {
                rest = rest.wrapping_minus(multiple);
                moved += 1 << bit;
            }
        }
        if negative { (-1 - moved, self.scale.wrapping_minus(W::ONE).wrapping_minus(rest)) } else { (moved, rest) }
    }
}

impl<W: Word> Kernel for Residual<W> {
    type Word = W;

    fn start(&self, x: i32, e: W) -> (i32, W) {
        (x, e)
    }

    #[inline(always)]
    fn advance(&self, x: &mut i32, e: &mut W, d: W) {
        *e = e.wrapping_plus(d);
        if !e.below(self.scale) {
            // Most steps are of one unit: v − N or v + N is in range. Neither can be by wrapping, for (2K+1)·N < 2^w.
            let less = e.wrapping_minus(self.scale);
            let more = e.wrapping_plus(self.scale);
            if less.below(self.scale) {
                (*x, *e) = (x.wrapping_add(1), less);
            } else if more.below(self.scale) {
                (*x, *e) = (x.wrapping_sub(1), more);
            } else {
                let (step, rest) = self.settle(*e);
                (*x, *e) = (x.wrapping_add(step), rest);
            }
        }
    }

    #[inline(always)]
    fn read(&self, x: i32, _: W) -> i32 {
        x
    }
}
