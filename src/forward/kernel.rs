//! The three ways to carry a rounded coordinate through a difference.
//!
//! A coordinate of value φ/N is carried as x = floor((φ + ⌊N/2⌋)/N), which is floor(φ/N + 1/2) for even and odd N,
//! and e = φ + ⌊N/2⌋ − N·x in 0 ..= N − 1.

use super::Budget;
use crate::num::Word;

/// One way to carry (x, e). All arithmetic is modulo 2^w.
pub(crate) trait Kernel: Copy {
    type Word: Word;

    /// (x, e) in the kernel's own representation.
    fn start(&self, x: i32, e: Self::Word) -> (i32, Self::Word);

    /// Adds the difference `d` of φ.
    fn advance(&self, x: &mut i32, e: &mut Self::Word, d: Self::Word);

    /// The rounded coordinate.
    fn read(&self, x: i32, e: Self::Word) -> i32;

    /// The fraction and integer bits of e where it holds N·x + e and nothing else moves: such rows can run in lanes.
    #[inline(always)]
    fn bits(&self) -> Option<(u32, u32)> {
        None
    }
}

/// N = 2^f with room for the coordinate above f: e holds N·x + e.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Accumulate<W> {
    shift: usize,
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
        Some(Self {
            shift: shift as usize,
            #[cfg(target_pointer_width = "64")]
            integer_bits,
            word: core::marker::PhantomData,
        })
    }
}

impl<W: Word> Kernel for Accumulate<W> {
    type Word = W;

    fn start(&self, x: i32, e: W) -> (i32, W) {
        (0, (W::truncate(x.into()) << self.shift).wrapping_plus(e))
    }

    #[inline(always)]
    fn advance(&self, _: &mut i32, e: &mut W, d: W) {
        *e = e.wrapping_plus(d);
    }

    #[inline(always)]
    fn read(&self, _: i32, e: W) -> i32 {
        (e >> self.shift).as_()
    }

    #[cfg(target_pointer_width = "64")]
    #[inline(always)]
    fn bits(&self) -> Option<(u32, u32)> {
        Some((self.shift as u32, self.integer_bits))
    }
}

impl<W: Word> Mask<W> {
    pub(crate) fn of(budget: &Budget) -> Option<Self> {
        let shift = budget.dyadic()? as usize;
        Some(Self { shift, mask: W::truncate((1_i128 << shift) - 1) })
    }
}

impl<W: Word> Kernel for Mask<W> {
    type Word = W;

    fn start(&self, x: i32, e: W) -> (i32, W) {
        (x, e)
    }

    #[inline(always)]
    fn advance(&self, x: &mut i32, e: &mut W, d: W) {
        let v = e.wrapping_plus(d);
        let step: i32 = (v >> self.shift).as_();
        *x = x.wrapping_add(step);
        *e = v & self.mask;
    }

    #[inline(always)]
    fn read(&self, x: i32, _: W) -> i32 {
        x
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
