//! Ways in from derivatives: cubic Hermite curves and bicubic Hermite patches.
//!
//! Points are `I16F16`; derivatives are [`Vector3`] in `I32F32`, the type in which nets give them, by the net's own
//! parameter in 0 ..= 1. Every control point is the exact sum rounded once, half up, so it is within 2^-17 of it
//! along each axis, and exact where the derivatives are multiples of 3 (twists of 9) units of 2^-16.

use super::exact::{point, rounded, vector};
use super::{BicubicPatch, CubicCurve, NetError};
use crate::geometry::{Point3, Vector3};

/// 2^16: vectors have that many steps in one of a point's.
const STEPS: i64 = 1 << 16;

impl CubicCurve {
    /// The cubic through two points with these derivatives: b0 = p0, b1 = p0 + d0/3, b2 = p1 − d1/3, b3 = p1.
    ///
    /// Derivatives are by the curve's own parameter in 0 ..= 1, of any size. Each inner control point is the exact sum
    /// rounded once, half up: within 2^-17 along each axis, exact for multiples of 3 · 2^-16. Also in constant context.
    /// Cost: two 128-bit divisions per axis, 450 bytes of stack. Source: the cubic Hermite form, Farin, *Curves and
    /// Surfaces for CAGD*.
    ///
    /// ```
    /// use embedded_surfaces::{geometry::{Point3, Vector3}, num::I32F32, patch::CubicCurve};
    /// let along = |x, y| Vector3::new(I32F32::from_num(x), I32F32::from_num(y), I32F32::ZERO);
    /// let ends = [Point3::from_ints(0, 0, 0), Point3::from_ints(100, 0, 0)];
    /// let hop = CubicCurve::from_hermite(ends, [along(0, 300), along(0, -300)])?;
    /// assert_eq!(Ok(hop), CubicCurve::from_ints([[0, 0, 0], [0, 100, 0], [100, 100, 0], [100, 0, 0]]));
    /// # Ok::<(), embedded_surfaces::patch::NetError>(())
    /// ```
    ///
    /// # Errors
    /// [`NetError::OutOfRange`] where a control point leaves ±32767.
    pub const fn from_hermite(points: [Point3; 2], derivatives: [Vector3; 2]) -> Result<Self, NetError> {
        let [p0, p1] = points;
        let [d0, d1] = derivatives;
        let b1 = match rounded(1, &[(3 * STEPS, point(&p0)), (1, vector(&d0))], 3 * STEPS) {
            Ok(b1) => b1,
            Err(error) => return Err(error),
        };
        let b2 = match rounded(2, &[(3 * STEPS, point(&p1)), (-1, vector(&d1))], 3 * STEPS) {
            Ok(b2) => b2,
            Err(error) => return Err(error),
        };
        Self::new([p0, b1, b2, p1])
    }
}

/// A corner of a bicubic Hermite patch S(r, s), r and s in 0 ..= 1. 84 bytes or a little more.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct HermiteCorner {
    /// The point S.
    pub point: Point3,
    /// The tangent ∂S/∂r.
    pub by_r: Vector3,
    /// The tangent ∂S/∂s.
    pub by_s: Vector3,
    /// The twist ∂²S/∂r∂s.
    pub twist: Vector3,
}

impl HermiteCorner {
    /// The corner with this point, these tangents and this twist.
    #[must_use]
    pub const fn new(point: Point3, by_r: Vector3, by_s: Vector3, twist: Vector3) -> Self {
        Self { point, by_r, by_s, twist }
    }
}

/// Which corner a row or column of the net belongs to, and where it lies from it in thirds of the tangent.
const PLACES: [(usize, i64); 4] = [(0, 0), (0, 1), (1, -1), (1, 0)];

impl BicubicPatch {
    /// The bicubic patch with these corners, `corners[a][b]` at r = a, s = b.
    ///
    /// With x, y in {0, 1, −1, 0} for the rows and columns of the net, b = S + x/3 S_r + y/3 S_s + xy/9 S_rs of the
    /// nearest corner, rounded once, half up. A border depends on the points and tangents along it only: it is
    /// [`CubicCurve::from_hermite`] of them, bit by bit, and so is the neighbour's. Also in constant context. Cost:
    /// 48 divisions of 128 bits, 700 bytes of stack. Source: the bicubic Hermite form, Farin, *Curves and Surfaces for
    /// CAGD*.
    ///
    /// ```
    /// use embedded_surfaces::geometry::{Point3, Vector3};
    /// use embedded_surfaces::num::I32F32;
    /// use embedded_surfaces::patch::{BicubicPatch, HermiteCorner, Parameter};
    /// let v = |x, y, z| Vector3::new(I32F32::from_num(x), I32F32::from_num(y), I32F32::from_num(z));
    /// let flat = |x, y| HermiteCorner::new(Point3::from_ints(x, y, 0), v(90, 0, 0), v(0, 60, 0), v(0, 0, 0));
    /// let mut corners = [[flat(0, 0), flat(0, 60)], [flat(90, 0), flat(90, 60)]];
    /// corners[0][0].twist = v(0, 0, 9); // lifts one inner control point by a ninth
    /// let patch = BicubicPatch::from_hermite(&corners)?;
    /// assert_eq!(patch.points()[1][1], Point3::from_ints(30, 20, 1));
    /// assert_eq!(patch.net().partials(Parameter::ZERO, Parameter::ONE), [v(90, 0, 0), v(0, 60, 0)]);
    /// # Ok::<(), embedded_surfaces::patch::NetError>(())
    /// ```
    ///
    /// # Errors
    /// [`NetError::OutOfRange`] where a control point leaves ±32767.
    pub const fn from_hermite(corners: &[[HermiteCorner; 2]; 2]) -> Result<Self, NetError> {
        let mut points = [[Point3::ORIGIN; 4]; 4];
        let mut index = 0;
        while index < 16 {
            let ((a, x), (b, y)) = (PLACES[index / 4], PLACES[index % 4]);
            let corner = &corners[a][b];
            let terms = [
                (9 * STEPS, point(&corner.point)),
                (3 * x, vector(&corner.by_r)),
                (3 * y, vector(&corner.by_s)),
                (x * y, vector(&corner.twist)),
            ];
            points[index / 4][index % 4] = match rounded(index, &terms, 9 * STEPS) {
                Ok(point) => point,
                Err(error) => return Err(error),
            };
            index += 1;
        }
        Self::new(points)
    }
}
