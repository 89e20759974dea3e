//! Knot vectors.

use super::SplineError;
use super::insertion::Window;
use crate::num::I16F16;
use crate::patch::Curve;

/// Where knots come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Knots<'a> {
    /// i − (K − 1).
    Uniform,
    /// The same, held at both ends of the domain.
    Clamped,
    /// As given.
    Given(&'a [I16F16]),
}

/// The knots t_0 ≤ t_1 ≤ … of splines of order `K`, that is of degree K − 1 in 1 ..= 8: K more than control points.
///
/// The domain runs from t_(K−1) to the K-th knot from the end. Each span in it that is not empty carries one Bézier
/// piece. Knots are any `I16F16`; only ratios of their differences matter. Checked once; 12 to 24 bytes.
///
/// ```
/// use embedded_surfaces::{num::I16F16, patch::{KnotVector, SplineError}};
/// let knots = [0, 0, 0, 0, 3, 5, 5, 8, 8, 8, 8].map(I16F16::from_num);
/// let cubic = KnotVector::<4>::new(&knots)?;
/// assert_eq!((cubic.points(), cubic.pieces()), (7, 3));
/// assert_eq!(cubic.interval(2), Some([5, 8].map(I16F16::from_num)));
/// let falling = [0, 1, 2, 1].map(I16F16::from_num);
/// let error = SplineError::Decreasing { index: 3, previous: 2 << 16, bits: 1 << 16 };
/// assert_eq!(KnotVector::<2>::new(&falling), Err(error));
/// # Ok::<(), SplineError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct KnotVector<'a, const K: usize> {
    knots: Knots<'a>,
    points: usize,
    pieces: usize,
}

/// The most control points over the knots 0, 1, 2 …
const MOST: usize = 32767;

impl<'a, const K: usize> KnotVector<'a, K> {
    /// The knots given, non-uniform or not; also in constant context.
    ///
    /// # Errors
    /// In this order: [`SplineError::KnotCount`] for fewer than 2·K; [`SplineError::Decreasing`];
    /// [`SplineError::EmptyDomain`]; [`SplineError::Multiplicity`] for more than K equal knots, or more than K − 1
    /// inside the domain, where the spline would come apart.
    pub const fn new(knots: &'a [I16F16]) -> Result<Self, SplineError> {
        let () = Curve::<K, I16F16>::LEGAL;
        if knots.len() < 2 * K {
            return Err(SplineError::KnotCount { least: 2 * K, given: knots.len() });
        }
        let mut index = 1;
        while index < knots.len() {
            let (previous, bits) = (knots[index - 1].to_bits(), knots[index].to_bits());
            if bits < previous {
                return Err(SplineError::Decreasing { index, previous, bits });
            }
            index += 1;
        }
        let domain = (knots[K - 1].to_bits(), knots[knots.len() - K].to_bits());
        if domain.0 == domain.1 {
            return Err(SplineError::EmptyDomain { index: K - 1, bits: domain.0 });
        }
        match check_multiplicities(knots, domain, K - 1) {
            Ok(()) => Ok(Self { knots: Knots::Given(knots), points: knots.len() - K, pieces: 0 }.counted()),
            Err(error) => Err(error),
        }
    }

    /// The uniform knots for this many control points: piece i lies over \[i, i + 1\].
    ///
    /// ```
    /// use embedded_surfaces::patch::KnotVector;
    /// assert_eq!(KnotVector::<4>::uniform(7)?.pieces(), 4);
    /// # Ok::<(), embedded_surfaces::patch::SplineError>(())
    /// ```
    ///
    /// # Errors
    /// [`SplineError::PointCount`] for fewer points than `K` or more than 32767.
    pub const fn uniform(points: usize) -> Result<Self, SplineError> {
        Self::counting(Knots::Uniform, points)
    }

    /// The uniform knots, the first and the last of them `K` times (also called open uniform): the spline starts at
    /// the first control point and ends at the last, piece i lies over \[i, i + 1\].
    ///
    /// ```
    /// use embedded_surfaces::{num::I16F16, patch::KnotVector};
    /// let knots = KnotVector::<3>::clamped(4)?; // 0, 0, 0, 1, 2, 2, 2
    /// assert_eq!(knots.knot(3), Some(I16F16::ONE));
    /// # Ok::<(), embedded_surfaces::patch::SplineError>(())
    /// ```
    ///
    /// # Errors
    /// [`SplineError::PointCount`] for fewer points than `K` or more than 32767.
    pub const fn clamped(points: usize) -> Result<Self, SplineError> {
        Self::counting(Knots::Clamped, points)
    }

    const fn counting(knots: Knots<'a>, points: usize) -> Result<Self, SplineError> {
        let () = Curve::<K, I16F16>::LEGAL;
        if points < K || points > MOST {
            return Err(SplineError::PointCount { least: K, most: MOST, given: points });
        }
        Ok(Self { knots, points, pieces: points + 1 - K })
    }

    /// With the spans counted that are not empty.
    const fn counted(mut self) -> Self {
        let mut span = K - 1;
        while span < self.points {
            self.pieces += (self.bits(span) < self.bits(span + 1)) as usize;
            span += 1;
        }
        self
    }

    /// The number of control points.
    #[must_use]
    pub const fn points(&self) -> usize {
        self.points
    }

    /// The number of Bézier pieces: of spans in the domain that are not empty. At least 1.
    #[must_use]
    pub const fn pieces(&self) -> usize {
        self.pieces
    }

    /// t_index; `None` from the number of points plus `K` on.
    #[must_use]
    pub const fn knot(&self, index: usize) -> Option<I16F16> {
        if index < self.points + K { Some(I16F16::from_bits(self.bits(index))) } else { None }
    }

    /// Where piece `index` starts and ends; `None` from the number of pieces on.
    ///
    /// The parameter t of the spline is (t − start) / (end − start) of the piece.
    #[must_use]
    pub const fn interval(&self, index: usize) -> Option<[I16F16; 2]> {
        match self.span(index) {
            Some(span) => Some([I16F16::from_bits(self.bits(span)), I16F16::from_bits(self.bits(span + 1))]),
            None => None,
        }
    }

    /// The j with t_j < t_(j+1) over which piece `index` lies.
    pub(super) const fn span(&self, index: usize) -> Option<usize> {
        let (mut span, mut left) = (K - 1, index);
        while span < self.points {
            if self.bits(span) < self.bits(span + 1) {
                if left == 0 {
                    return Some(span);
                }
                left -= 1;
            }
            span += 1;
        }
        None
    }

    /// The K − 1 knots on either side of the inside of the span.
    pub(super) fn window(&self, span: usize) -> Window {
        Window::new(K - 1, |before| self.bits(span - before), |after| self.bits(span + 1 + after))
    }

    /// t_index in 2^-16. At most 32767 + K points keep counted knots in the type.
    const fn bits(&self, index: usize) -> i32 {
        let count = index as i32 - (K as i32 - 1);
        match self.knots {
            Knots::Uniform => count << 16,
            Knots::Clamped => {
                let end = (self.points + 1 - K) as i32;
                (if count < 0 {
                    0
                } else if count > end {
                    end
                } else {
                    count
                }) << 16
            }
            Knots::Given(knots) => {
                if index < knots.len() {
                    knots[index].to_bits()
                } else {
                    0
                }
            }
        }
    }
}

/// No run of equal knots is longer than `degree` inside the domain, or one more elsewhere.
const fn check_multiplicities(knots: &[I16F16], domain: (i32, i32), degree: usize) -> Result<(), SplineError> {
    let (mut index, mut end) = (0, 1);
    while index < knots.len() {
        let bits = knots[index].to_bits();
        while end < knots.len() && knots[end].to_bits() == bits {
            end += 1;
        }
        let limit = if domain.0 < bits && bits < domain.1 { degree } else { degree + 1 };
        let multiplicity = end - index;
        if multiplicity > limit {
            return Err(SplineError::Multiplicity { index, bits, multiplicity, limit });
        }
        index = end;
    }
    Ok(())
}

#[cfg(feature = "defmt")]
impl<const K: usize> defmt::Format for KnotVector<'_, K> {
    fn format(&self, f: defmt::Formatter<'_>) {
        match self.knots {
            Knots::Uniform => defmt::write!(f, "uniform knots of {} points of order {}", self.points, K),
            Knots::Clamped => defmt::write!(f, "clamped knots of {} points of order {}", self.points, K),
            Knots::Given(knots) => {
                defmt::write!(f, "knots of {} points of order {}: ", self.points, K);
                super::format_bits(knots, f);
            }
        }
    }
}
