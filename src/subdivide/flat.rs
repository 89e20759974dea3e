//! The displacement test: whether a patch is within a tolerance of its corners' triangles, without a division.
//!
//! Source: Tian Jie 1989, Algorithm 2, with the distances to the plane and to the lines of the corners replaced by the
//! distance of each control point to the place where it would stand if the patch were flat. That also refuses folded
//! nets and nets whose corners lie on one line.

use super::SubdivideError;
use super::stencil::{Net, Shape};
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
    /// A polynomial patch that passes is within the tolerance at equal parameters. Sufficient, not necessary; a
    /// patch within tolerance passes after some levels of subdivision, as displacements fall by 4 a level.
    ///
    /// Cost: 12 multiplications of 64 bits per point and 3 squares, 6 for tensor products, until the first point
    /// that fails. 128 bits are used only for tolerances of 2^15/n units (triangles) or 2^13/(mh) units and more.
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

fn flat(net: &Net<'_>, tolerance: Tolerance) -> bool {
    match net.shape {
        Shape::Triangle => flat_triangle(net, tolerance),
        Shape::Tensor => flat_tensor(net, tolerance),
        Shape::Curve => flat_curve(net, tolerance),
    }
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

fn flat_curve(net: &Net<'_>, tolerance: Tolerance) -> bool {
    let n = net.degrees.0 as i64;
    let (first, last) = (net.bits(0), net.bits(net.degrees.0));
    (0..).zip(net.points).all(|(i, p)| {
        let p = p.to_array();
        let v = core::array::from_fn(|a| n * p[a].bits() - (n - i) * first[a] - i * last[a]);
        within(v, n * tolerance.bits())
    })
}

fn flat_triangle(net: &Net<'_>, tolerance: Tolerance) -> bool {
    let n = net.degrees.0 as i64;
    let corners = [0, net.points.len().saturating_sub(net.degrees.0 + 1), net.points.len().saturating_sub(1)];
    let [t1, t2, t3] = corners.map(|index| net.bits(index));
    let indices = (0..=n).flat_map(|rest| (0..=rest).map(move |k| (n - rest, rest - k, k)));
    indices.zip(net.points).all(|((i, j, k), p)| {
        let p = p.to_array();
        // Below 2^36: legal bits have 31 bits, n ≤ 8.
        let v = core::array::from_fn(|a| n * p[a].bits() - i * t1[a] - j * t2[a] - k * t3[a]);
        within(v, n * tolerance.bits())
    })
}

fn flat_tensor(net: &Net<'_>, tolerance: Tolerance) -> bool {
    let (m, h) = net.degrees;
    let [c00, c01, c10, c11] = [0, h, m * (h + 1), m * (h + 1) + h].map(|index| net.bits(index));
    let (m, h) = (m as i64, h as i64);
    let (whole, quarters) = (4 * m * h, if net.weights.is_some() { 2 } else { 1 });
    let twist: [i64; 3] = core::array::from_fn(|a| quarters * m * h * (c00[a] - c01[a] - c10[a] + c11[a]));
    let indices = (0..=m).flat_map(|i| (0..=h).map(move |j| (i, j)));
    indices.zip(net.points).all(|((i, j), p)| {
        let p = p.to_array();
        // Below 2^42: legal bits have 31 bits, mh ≤ 64.
        let v: [i64; 3] = core::array::from_fn(|a| {
            let low = (h - j) * c00[a] + j * c01[a];
            let high = (h - j) * c10[a] + j * c11[a];
            whole * p[a].bits() - 4 * ((m - i) * low + i * high)
        });
        let moved = |sign: i64| core::array::from_fn(|a| v[a] + sign * twist[a]);
        let limit = whole * tolerance.bits();
        within(moved(1), limit) && within(moved(-1), limit)
    })
}
