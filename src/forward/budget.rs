//! The bit budget: which accumulator is wide enough, by proof.

use super::bounds::{largest_weight, longest_step, weight_shift};
use super::form::{Form, Kind};
use crate::num::Wide;

/// The largest step count in one direction.
pub(crate) const MAX_STEPS: u32 = 1 << 24;

/// The integer type that a lattice accumulates in.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Accumulator {
    /// 32 bits.
    I32,
    /// 64 bits.
    I64,
    /// 128 bits.
    I128,
}

impl core::fmt::Display for Accumulator {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str(match self {
            Self::I32 => "i32",
            Self::I64 => "i64",
            Self::I128 => "i128",
        })
    }
}

/// What the engine needs for a net at its step counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub struct Budget {
    /// The accumulator taken: the narrowest w with (2K+1)·N < 2^w.
    pub accumulator: Accumulator,
    /// N = n_r^m n_s^h 2^F: the denominator of every exact coordinate; times the largest weight for a rational net
    /// (as an integer, common trailing zeros dropped), a bound on the denominators.
    pub scale: u128,
    /// F: the fraction bits that the net really uses.
    pub fraction_bits: u32,
    /// K ≥ 1: no coordinate moves by more units from a point to the next in a row or column.
    pub largest_step: u32,
    /// The trailing zero bits that all weights share.
    pub(crate) weight_shift: u32,
}

/// Why a lattice cannot be generated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum LatticeError {
    /// A step count of zero or above 2^24, or different ones for a triangle.
    Steps {
        /// Steps in the first direction.
        r: u32,
        /// Steps in the second direction.
        s: u32,
    },
    /// No accumulator is wide enough.
    Budget {
        /// The degrees in the two directions (0 in the second for a curve).
        degrees: (usize, usize),
        /// The step counts.
        steps: (u32, u32),
        /// The fraction bits that the net uses.
        fraction_bits: u32,
        /// The bits of (2K+1)·N; 128 are there.
        bits: u32,
    },
    /// Unit steps were asked for where a coordinate may move by more than one unit.
    LongStep {
        /// The bound on a step, in whole units.
        units: u32,
        /// The step counts that make every step at most one unit.
        needed: (u32, u32),
    },
}

impl core::fmt::Display for LatticeError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Steps { r, s } => {
                write!(f, "step counts {r} x {s} are not in 1 ..= {MAX_STEPS}, or differ for a triangle")
            }
            Self::Budget { degrees: (m, h), steps: (r, s), fraction_bits, bits } => write!(
                f,
                "degrees ({m}, {h}) at {r} x {s} steps with {fraction_bits} fraction bits need {bits} bits, 128 are there"
            ),
            Self::LongStep { units, needed: (r, s) } => {
                write!(f, "a step may be {units} units long; {r} x {s} steps make all of them at most one unit")
            }
        }
    }
}

impl core::error::Error for LatticeError {}

/// The trailing zero bits that all coordinates share, at most 16.
pub(super) fn unused_bits(form: &Form<'_>) -> u32 {
    let used = form.points().iter().fold(0, |bits, p| bits | p.x.to_bits() | p.y.to_bits() | p.z.to_bits());
    used.trailing_zeros().min(16)
}

/// The factors of N: a step count and its exponent, twice.
fn factors(form: &Form<'_>) -> [(u32, usize); 2] {
    let (r, s) = form.table_steps();
    let second = if form.kind == Kind::Tensor { (s, form.degrees.1) } else { (1, 0) };
    [(r, form.degrees.0), second]
}

/// `weight` times all factors.
fn scale(weight: u128, factors: [(u32, usize); 2]) -> Option<u128> {
    factors.into_iter().try_fold(weight, |scale, (steps, exponent)| {
        core::iter::repeat_n(u64::from(steps), exponent).try_fold(scale, times)
    })
}

/// The product, in 64 bits where they do: most of what is checked is that small.
fn times(a: u128, b: u64) -> Option<u128> {
    match u64::try_from(a).ok().and_then(|a| a.checked_mul(b)) {
        Some(product) => Some(product.into()),
        None => a.checked_mul(b.into()),
    }
}

impl Budget {
    /// Checks step counts and finds the accumulator.
    pub(crate) fn of(form: &Form<'_>) -> Result<Self, LatticeError> {
        let (r, s) = form.steps;
        let legal = |n: u32| (1..=MAX_STEPS).contains(&n);
        let fits = match form.kind {
            Kind::Curve => legal(r),
            Kind::Triangle => legal(r) && r == s,
            Kind::Tensor => legal(r) && legal(s),
        };
        if !fits {
            return Err(LatticeError::Steps { r, s });
        }
        let (largest_step, fraction_bits) = (longest_step(form), 16 - unused_bits(form));
        let largest_weight = largest_weight(form);
        let range = 2 * u64::from(largest_step) + 1;
        let scale = scale(largest_weight << fraction_bits, factors(form));
        let accumulator = scale.and_then(|n| times(n, range)).map(|values| match 128 - values.leading_zeros() {
            0..=32 => Accumulator::I32,
            33..=64 => Accumulator::I64,
            _ => Accumulator::I128,
        });
        match (scale, accumulator) {
            (Some(scale), Some(accumulator)) => {
                Ok(Self { accumulator, scale, fraction_bits, largest_step, weight_shift: weight_shift(form) })
            }
            _ => {
                let one = Wide::from_i64((largest_weight << fraction_bits) as i64).mul_i32(2 * largest_step as i32 + 1);
                let values = factors(form).into_iter().fold(one, |product, (steps, exponent)| {
                    core::iter::repeat_n(steps as i32, exponent).fold(product, |p, n| p.mul_i32(n))
                });
                Err(LatticeError::Budget {
                    degrees: form.degrees,
                    steps: form.steps,
                    fraction_bits,
                    bits: values.bit_length(),
                })
            }
        }
    }

    /// log2 N where N is a power of two.
    pub(crate) fn dyadic(&self) -> Option<u32> {
        self.scale.is_power_of_two().then(|| self.scale.trailing_zeros())
    }
}
