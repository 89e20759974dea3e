//! The displacement test: whether a patch is within a tolerance of its corners' triangles, without a division.
//!
//! Source: Tian Jie 1989, Algorithm 2, with the distances to the plane and to the lines of the corners replaced by the
//! distance of each control point to the place where it would stand if the patch were flat. That also refuses folded
//! nets and nets whose corners lie on one line.

use super::SubdivideError;
use super::stencil::{Net, Shape, zip};
use crate::num::{Coord, I16F16};
use crate::patch::{CurveNet, RationalCurveNet, SurfaceNet};

/// A distance that is allowed, in units (pixels): positive, checked once.
///
/// ```
/// use embedded_surfaces::num::I16F16;
/// use embedded_surfaces::subdivide::{SubdivideError, Tolerance};
/// assert_eq!(Tolerance::new(I16F16::from_bits(1 << 14))?.get(), I16F16::from_num(0.25));
/// assert_eq!(Tolerance::new(I16F16::ZERO), Err(SubdivideError::Tolerance { bits: 0 }));
/// # Ok::<(), SubdivideError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Tolerance(I16F16);

impl Tolerance {
    /// The tolerance of this many units.
    ///
    /// # Errors
    /// [`SubdivideError::Tolerance`] unless it is positive.
    pub const fn new(tolerance: I16F16) -> Result<Self, SubdivideError> {
        let bits = tolerance.to_bits();
        if bits > 0 { Ok(Self(tolerance)) } else { Err(SubdivideError::Tolerance { bits }) }
    }

    /// The tolerance in units.
    #[must_use]
    pub const fn get(self) -> I16F16 {
        self.0
    }

    /// The tolerance in 2^-16 units.
    pub(super) fn bits(self) -> i64 {
        self.0.bits()
    }
}

#[cfg(feature = "defmt")]
impl defmt::Format for Tolerance {
    fn format(&self, f: defmt::Formatter<'_>) {
        defmt::write!(f, "Tolerance({} / 65536)", self.0.to_bits());
    }
}

impl SurfaceNet<'_> {
    /// Whether every point of the patch is within the tolerance of the triangle of its corners (Tian Jie 1989,
    /// Algorithm 2, division-free); of a tensor-product patch, of its two triangles over either diagonal.
    ///
    /// * Triangle of degree n: max |n·b\[i,j,k\] − (i·T1 + j·T2 + k·T3)|² ≤ (n·tolerance)².
    /// * Tensor product of degrees (m, h), with the bilinear interpolant l of the corners and their twist
    ///   t = c00 − c01 − c10 + c11: max |b\[i,j\] − l(i/m, j/h) ± t/4| ≤ tolerance. The interpolant is off the
    ///   triangles by κ·t, 0 ≤ κ ≤ 1/4 over one diagonal and −1/4 ≤ κ ≤ 0 over the other, and distances are convex.
    /// * Rational patches: the same with t/2; weights do not enter. With the shares β ≥ 0 of the control points in a
    ///   surface point, Σ β (i/m, j/h) is the point of the domain to compare with, and Σ β (i/m)(j/h) is off the
    ///   product of its coordinates.
    ///
    /// A polynomial patch that passes is within the tolerance at equal parameters. The converse does not hold, but
    /// displacements fall by 4 a level in the limit.
    ///
    /// Cost per point: 3 multiplications and 6 additions of 64 bits, 3 squares where no component alone decides (twice
    /// that for twisted tensor products), until the first point that fails. 128 bits are used only for tolerances of
    /// 2^15/n units (triangles) or 2^13/(mh) units and more. Counted on thumbv7em:
    /// 550 instructions where the second point fails, 1900 for a flat cubic triangle, 4300 for a flat bicubic patch.
    /// Flash 2.5 KB, stack 0.7 KB on thumbv6m.
    ///
    /// ```
    /// use embedded_surfaces::num::I16F16;
    /// use embedded_surfaces::patch::{QuadraticTriangle, Surface};
    /// use embedded_surfaces::subdivide::Tolerance;
    /// let dome = QuadraticTriangle::from_ints([[0, 0, 0], [40, 0, 9], [0, 40, 9], [80, 0, 0], [40, 40, 9], [0, 80, 0]])?;
    /// assert!(!dome.surface().is_flat(Tolerance::new(I16F16::from_num(8))?));
    /// assert!(dome.surface().is_flat(Tolerance::new(I16F16::from_num(9))?));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn is_flat(&self, tolerance: Tolerance) -> bool {
        flat(&Net::of(self), tolerance)
    }
}

impl CurveNet<'_> {
    /// Whether every point of the curve is within the tolerance of its chord, at equal parameters:
    /// max |n·b_i − ((n − i)·b_0 + i·b_n)|² ≤ (n·tolerance)².
    ///
    /// ```
    /// use embedded_surfaces::{num::I16F16, patch::CubicCurve, subdivide::Tolerance};
    /// let pixel = Tolerance::new(I16F16::ONE)?;
    /// let bow = CubicCurve::from_ints([[0, 0, 0], [30, 1, 0], [60, 1, 0], [90, 0, 0]])?;
    /// assert!(bow.net().is_flat(pixel));
    /// // On its chord, but far from even.
    /// let uneven = CubicCurve::from_ints([[0, 0, 0], [10, 0, 0], [20, 0, 0], [90, 0, 0]])?;
    /// assert!(!uneven.net().is_flat(pixel));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn is_flat(&self, tolerance: Tolerance) -> bool {
        flat(&Net::of_curve(self, None), tolerance)
    }
}

impl RationalCurveNet<'_> {
    /// Whether every point of the curve is within the tolerance of its chord: the test of [`CurveNet::is_flat`], whose
    /// answer does not depend on positive weights.
    #[must_use]
    pub fn is_flat(&self, tolerance: Tolerance) -> bool {
        flat(&Net::of_curve(&self.control_net(), None), tolerance)
    }
}

/// Tests the points row by row against where they belong, which moves by the same step along a row.
///
/// All over `whole`: n, or 4mh for tensor products. Below 2^43, as legal bits have 31 bits.
fn flat(net: &Net<'_>, tolerance: Tolerance) -> bool {
    let frame = Frame::of(net);
    let limit = frame.whole * tolerance.bits();
    let mut points = net.points.iter();
    for i in 0..=frame.rows {
        let (count, mut place, step) = frame.row(i);
        for p in points.by_ref().take(count) {
            let p = p.to_array();
            let v = zip(p, place, |p, place| frame.whole * p.bits() - place);
            let either = within(zip(v, frame.twist, |v, t| v + t), limit);
            if !either || (frame.is_twisted && !within(zip(v, frame.twist, |v, t| v - t), limit)) {
                return false;
            }
            place = zip(place, step, |place, step| place + step);
        }
    }
    true
}

/// The corners of a net and what stands between them.
struct Frame {
    shape: Shape,
    degrees: [i64; 2],
    whole: i64,
    /// The index of the last row.
    rows: i64,
    /// c00, c01, c10, c11; of a triangle T1, T2, T3; of a curve its ends first and last.
    corners: [[i64; 3]; 4],
    twist: [i64; 3],
    is_twisted: bool,
}

impl Frame {
    fn of(net: &Net<'_>) -> Self {
        let (m, h) = net.degrees;
        let last = net.points.len().saturating_sub(1);
        let at = match net.shape {
            Shape::Triangle => [0, last.saturating_sub(h), last, last],
            Shape::Tensor | Shape::Curve => [0, h, last.saturating_sub(h), last],
        };
        let corners = at.map(|index| net.bits(index));
        let degrees = [m as i64, h as i64];
        let mut frame = Self {
            shape: net.shape,
            degrees,
            whole: degrees[0],
            rows: if net.shape == Shape::Curve { 0 } else { degrees[0] },
            corners,
            twist: [0; 3],
            is_twisted: false,
        };
        if net.shape == Shape::Tensor {
            let [c00, c01, c10, c11] = corners;
            let mh = degrees[0] * degrees[1];
            let quarters = if net.weights.is_some() { 2 * mh } else { mh };
            frame.whole = 4 * mh;
            frame.twist = sum([(quarters, c00), (-quarters, c01), (-quarters, c10), (quarters, c11)]);
            frame.is_twisted = frame.twist != [0; 3];
        }
        frame
    }

    /// The points of row `i`, where the first belongs and the step to the next.
    fn row(&self, i: i64) -> (usize, [i64; 3], [i64; 3]) {
        let ([a, b, c, d], [m, h]) = (self.corners, self.degrees);
        match self.shape {
            Shape::Curve => (m as usize + 1, sum([(m, a)]), sum([(1, d), (-1, a)])),
            Shape::Triangle => (i as usize + 1, sum([(m - i, a), (i, b)]), sum([(1, c), (-1, b)])),
            Shape::Tensor => {
                let (low, high) = (4 * (m - i), 4 * i);
                let step = sum([(low, b), (-low, a), (high, d), (-high, c)]);
                (h as usize + 1, sum([(h * low, a), (h * high, c)]), step)
            }
        }
    }
}

/// Σ factor·vector
fn sum<const K: usize>(terms: [(i64, [i64; 3]); K]) -> [i64; 3] {
    terms.iter().fold([0; 3], |sum, (factor, v)| zip(sum, *v, |sum, v| sum + factor * v))
}

/// Whether |v| ≤ limit. |v| < 2^62, limit < 2^62.
fn within(v: [i64; 3], limit: i64) -> bool {
    let limit = limit.unsigned_abs();
    let lengths = v.map(i64::unsigned_abs);
    if lengths.iter().any(|c| *c > limit) {
        return false;
    }
    if limit < 1 << 31 {
        // Three squares below 2^62.
        lengths.iter().map(|c| c * c).sum::<u64>() <= limit * limit
    } else {
        let square = |c: u64| u128::from(c) * u128::from(c);
        lengths.into_iter().map(square).sum::<u128>() <= square(limit)
    }
}
