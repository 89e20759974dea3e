//! Ways in from borders: Coons patches of four cubic curves.

use super::exact::{Triple, point, rounded};
use super::{BicubicPatch, CubicCurve, NetError};
use crate::geometry::Point3;
use crate::num::bits_i16f16;

/// Four cubic borders whose ends meet bit by bit: what Coons patches are blended from. 192 bytes.
///
/// With borders c_b(r) = S(r, b) and d_a(s) = S(a, s), corners P_ab and a blend f from f(0) = 0 to f(1) = 1, the
/// Coons patch is the sum of the two lofted surfaces less the surface of the corners:
///
/// ```text
/// S = (1−f(s)) c_0(r) + f(s) c_1(r) + (1−f(r)) d_0(s) + f(r) d_1(s)
///   − (1−f(r)) (1−f(s)) P_00 − (1−f(r)) f(s) P_01 − f(r) (1−f(s)) P_10 − f(r) f(s) P_11
/// ```
///
/// Each term is a cubic in r times a cubic in s for f of degree up to 3, so S is a bicubic Bézier patch, and its net
/// is the same sum over the Bézier coefficients f_k of f:
///
/// | blend | f | f_0 ..= f_3 | twists at the corners |
/// |---|---|---|---|
/// | [bilinear](CoonsBoundary::bilinear) | t | 0, 1/3, 2/3, 1 | Adini's: those of the bilinearly blended patch |
/// | [bicubic](CoonsBoundary::bicubic) | 3t² − 2t³ | 0, 0, 1, 1 | zero |
///
/// Sources: Coons, *Surfaces for Computer-Aided Design of Space Forms* (1967); Farin and Hansford, *Discrete Coons
/// Patches* (1999).
///
/// ```
/// use embedded_surfaces::patch::{CoonsBoundary, CubicCurve, NetError, Parameter};
/// let along_r = [
///     CubicCurve::from_ints([[0, 0, 0], [30, 0, 0], [60, 0, 0], [90, 0, 0]])?,
///     CubicCurve::from_ints([[0, 90, 0], [30, 90, 40], [60, 90, 40], [90, 90, 0]])?,
/// ];
/// let along_s = [
///     CubicCurve::from_ints([[0, 0, 0], [0, 30, 0], [0, 60, 0], [0, 90, 0]])?,
///     CubicCurve::from_ints([[90, 0, 0], [90, 30, 0], [90, 60, 0], [90, 90, 0]])?,
/// ];
/// let sail = CoonsBoundary::new(along_r, along_s)?.bicubic()?;
/// assert_eq!(sail.net().eval(Parameter::HALF, Parameter::ONE).z, 30); // the arched border
/// assert_eq!(sail.net().eval(Parameter::HALF, Parameter::HALF).z, 15);
/// // Borders in the wrong order do not meet: one starts at the origin, the other at (90, 0, 0).
/// let [d0, d1] = along_s;
/// assert!(matches!(CoonsBoundary::new(along_r, [d1, d0]), Err(NetError::Corner { r: 0, s: 0, .. })));
/// # Ok::<(), NetError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct CoonsBoundary {
    along_r: [CubicCurve; 2],
    along_s: [CubicCurve; 2],
}

/// The Bézier coefficients of a blend, over their last one.
type Blend = [i64; 4];
const LINEAR: Blend = [0, 1, 2, 3];
const SMOOTH: Blend = [0, 0, 1, 1];

const fn same(p: &Point3, q: &Point3) -> bool {
    bits_i16f16(p.x) == bits_i16f16(q.x) && bits_i16f16(p.y) == bits_i16f16(q.y) && bits_i16f16(p.z) == bits_i16f16(q.z)
}

impl CoonsBoundary {
    /// The borders S(r, 0), S(r, 1) along r and S(0, s), S(1, s) along s; also in constant context.
    ///
    /// # Errors
    /// [`NetError::Corner`] for the first corner, in the order (0, 0), (0, 1), (1, 0), (1, 1), at which the two
    /// borders differ in any bit.
    pub const fn new(along_r: [CubicCurve; 2], along_s: [CubicCurve; 2]) -> Result<Self, NetError> {
        let mut corner = 0;
        while corner < 4 {
            let (a, b) = (corner / 2, corner % 2);
            let (of_r, of_s) = (along_r[b].points[3 * a], along_s[a].points[3 * b]);
            if !same(&of_r, &of_s) {
                return Err(NetError::Corner { r: a as u8, s: b as u8, along_r: of_r, along_s: of_s });
            }
            corner += 1;
        }
        Ok(Self { along_r, along_s })
    }

    /// The bilinearly blended patch, f(t) = t: the plainest surface between the borders, and a ruled one between
    /// straight borders.
    ///
    /// Its exact net rounded once, half up: borders are exact, the inner four points within 2^-17 of the exact ones
    /// along each axis, and so is the surface. Also in constant context. Cost: 48 divisions of 128 bits, 900 bytes of
    /// stack.
    ///
    /// # Errors
    /// [`NetError::OutOfRange`] where an inner control point leaves ±32767.
    pub const fn bilinear(&self) -> Result<BicubicPatch, NetError> {
        self.blended(&LINEAR)
    }

    /// The bicubically blended patch, f(t) = 3t² − 2t³, the cubic Hermite step: the derivative across a border runs
    /// by the same step from corner to corner and depends on nothing else. So two patches join with one derivative
    /// across all of their common border where the borders that cross it at its ends do.
    ///
    /// Exact, nothing is rounded: an inner control point completes the parallelogram of its corner, and the twists
    /// are zero. (Farin calls it *partially* bicubically blended; the full form adds cross derivatives of the
    /// caller's, and with those of this step it is the same patch.) Also in constant context. Cost: additions and
    /// 900 bytes of stack.
    ///
    /// # Errors
    /// [`NetError::OutOfRange`] where an inner control point leaves ±32767.
    pub const fn bicubic(&self) -> Result<BicubicPatch, NetError> {
        self.blended(&SMOOTH)
    }

    const fn blended(&self, f: &Blend) -> Result<BicubicPatch, NetError> {
        let mut points = [[Point3::ORIGIN; 4]; 4];
        let mut index = 0;
        while index < 16 {
            let (i, j) = (index / 4, index % 4);
            points[i][j] = match rounded(index, &self.terms(f, i, j), f[3] * f[3]) {
                Ok(point) => point,
                Err(error) => return Err(error),
            };
            index += 1;
        }
        BicubicPatch::new(points)
    }

    /// What point (i, j) of the net times f_3² is the sum of.
    const fn terms(&self, f: &Blend, i: usize, j: usize) -> [(i64, Triple); 8] {
        let ([c0, c1], [d0, d1]) = (&self.along_r, &self.along_s);
        let (one, r, s) = (f[3], f[i], f[j]);
        [
            (one * (one - s), point(&c0.points[i])),
            (one * s, point(&c1.points[i])),
            (one * (one - r), point(&d0.points[j])),
            (one * r, point(&d1.points[j])),
            (-(one - r) * (one - s), point(&c0.points[0])),
            (-(one - r) * s, point(&c1.points[0])),
            (-r * (one - s), point(&c0.points[3])),
            (-r * s, point(&c1.points[3])),
        ]
    }
}
