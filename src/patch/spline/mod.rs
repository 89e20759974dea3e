//! Ways in from splines: B-spline and NURBS curves and surfaces of degrees 1 to 8 as Bézier pieces.
//!
//! In come borrowed control points, knots and weights, checked once; out go pieces, one at a time, each made from
//! the 2·(degree) knots around its span without a heap. Every control point of a piece is the exact one rounded
//! once, half up, whatever the knots: pieces share their common control points bit by bit, and where the exact ones
//! are representable nothing is lost.
//!
//! | spline | piece |
//! |---|---|
//! | [`BSplineCurve`] | [`Curve`](super::Curve) |
//! | [`NurbsCurve`] | [`RationalCurve`](super::RationalCurve) |
//! | [`BSplineSurface`] | [`Tensor`](super::Tensor) |
//! | [`NurbsSurface`] | [`RationalTensor`](super::RationalTensor) |
//!
//! This is set-up work, for each piece once. Measured on a Cortex-M4, in thousands of instructions (on a Cortex-M0+
//! they are 1.5 to 4.3 times as many) and bytes of stack, the pieces of NURBS at most 45 % and 400 bytes more:
//!
//! | degree | curve | stack | surface | stack |
//! |---|---|---|---|---|
//! | 2 | 30 | 2800 | 110 | 3400 |
//! | 3 | 55 | 3000 | 330 | 4000 |
//! | 5 | 160 | 3600 | 2700 | 5200 |
//! | 8 | 680 | 4400 | 39 000 | 7200 |
//!
//! They are least where knots coincide and where their differences are small multiples of one.

mod curve;
mod error;
mod insertion;
mod knots;
mod natural;
mod surface;

pub use curve::{BSplineCurve, NurbsCurve};
pub use error::SplineError;
pub use knots::KnotVector;
pub use surface::{BSplineSurface, NurbsSurface};

use super::NetError;
use crate::num::I16F16;

/// A spline whose Bézier pieces are numbered: what [`Pieces`] goes through.
pub trait Spline {
    /// The Bézier net of a piece.
    type Piece;

    /// The number of pieces.
    fn count(&self) -> usize;

    /// The piece of this number; `None` from the number of pieces on.
    fn nth(&self, index: usize) -> Option<Self::Piece>;
}

/// The Bézier pieces of a spline, made one at a time.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Pieces<S> {
    spline: S,
    next: usize,
}

impl<S: Spline> Pieces<S> {
    const fn new(spline: S) -> Self {
        Self { spline, next: 0 }
    }
}

impl<S: Spline> Iterator for Pieces<S> {
    type Item = S::Piece;

    fn next(&mut self) -> Option<S::Piece> {
        let piece = self.spline.nth(self.next)?;
        self.next += 1;
        Some(piece)
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        let left = self.spline.count().saturating_sub(self.next);
        (left, Some(left))
    }
}

impl<S: Spline> ExactSizeIterator for Pieces<S> {}
impl<S: Spline> core::iter::FusedIterator for Pieces<S> {}

/// A positive weight for each point.
const fn check_weights(points: usize, weights: &[I16F16]) -> Result<(), SplineError> {
    if weights.len() != points {
        return Err(SplineError::WeightCount { expected: points, given: weights.len() });
    }
    let mut index = 0;
    while index < weights.len() {
        let bits = weights[index].to_bits();
        if bits <= 0 {
            return Err(SplineError::Net(NetError::Weight { index, bits }));
        }
        index += 1;
    }
    Ok(())
}

/// Every weight times 2^log2 fits the type.
const fn scaled(weights: &[I16F16], log2: u32) -> Result<(), SplineError> {
    let mut index = 0;
    while index < weights.len() {
        let bits = weights[index].to_bits();
        // The sign bit is one of the zeros in front.
        if bits.leading_zeros() <= log2 {
            return Err(SplineError::WeightScale { index, bits, log2 });
        }
        index += 1;
    }
    Ok(())
}

/// Raw bits, which `fixed` formats for defmt only from 1.30 on.
#[cfg(feature = "defmt")]
fn format_bits(values: &[I16F16], f: defmt::Formatter<'_>) {
    values.iter().for_each(|value| defmt::write!(f, "{}/2^16 ", value.to_bits()));
}
