//! Changes of form: coordinate type, degree elevation, power basis.

use super::{Curve, MAX_DEGREE, NetError, Tensor, Triangle, triangle_index};
use crate::geometry::{Axis, Point3};
use crate::num::{BINOMIAL, Coord, I32F32, div_half_up};

/// Every point in `I16F16`, half up; the first one is point `first` of its net.
pub(super) fn round<const K: usize>(points: &[Point3<I32F32>; K], first: usize) -> Result<[Point3; K], NetError> {
    let mut out = [Point3::ORIGIN; K];
    for (index, (out, p)) in (first..).zip(out.iter_mut().zip(points)) {
        *out = p.round().ok_or_else(|| {
            let largest = Axis::ALL.into_iter().zip(p.to_array()).max_by_key(|(_, c)| c.unsigned_abs());
            let (axis, c) = largest.unwrap_or((Axis::X, I32F32::ZERO));
            NetError::OutOfRange { index, axis, units: c.bits() >> 32, limit: <crate::num::I16F16 as Coord>::LIMIT }
        })?;
    }
    Ok(out)
}

/// A weighted sum of points over a common divisor, rounded half up: one point of a new net.
struct Sum([i128; 3]);

impl Sum {
    fn new() -> Self {
        Self([0; 3])
    }

    /// Adds `factor` times the point. Factors stay below 2^40 and coordinates below 2^59.
    fn add<C: Coord>(&mut self, p: &Point3<C>, factor: i128) {
        for (sum, c) in self.0.iter_mut().zip(p.to_array()) {
            *sum += factor * i128::from(c.bits());
        }
    }

    fn divide<C: Coord>(self, index: usize, divisor: i128) -> Result<Point3<C>, NetError> {
        let coordinate = |axis: Axis| {
            let bits = div_half_up(self.0[axis as usize], divisor).unwrap_or(0);
            C::from_legal_bits(bits).ok_or(NetError::OutOfRange {
                index,
                axis,
                units: (bits >> C::FRACTION_BITS) as i64,
                limit: C::LIMIT,
            })
        };
        Ok(Point3::new(coordinate(Axis::X)?, coordinate(Axis::Y)?, coordinate(Axis::Z)?))
    }
}

fn binomial(n: usize, k: usize) -> i128 {
    BINOMIAL.get(n).and_then(|row| row.get(k)).map_or(0, |choices| i128::from(*choices))
}

/// The factor of point i of a net of degree m in point j of the net elevated to degree m + r, over C(m + r, j).
fn elevation_factor(m: usize, r: usize, i: usize, j: usize) -> i128 {
    if i <= j && j - i <= r { binomial(m, i) * binomial(r, j - i) } else { 0 }
}

impl<const K: usize, C: Coord> Curve<K, C> {
    /// The same curve as a net of the higher order `L`, each point rounded once, half up (so within half a unit of
    /// the last place).
    ///
    /// # Errors
    /// [`NetError::Elevation`] where `L` is below `K`.
    pub fn elevate<const L: usize>(&self) -> Result<Curve<L, C>, NetError> {
        let () = Curve::<L, C>::LEGAL;
        let (m, to) = (K - 1, L - 1);
        let r = to.checked_sub(m).ok_or(NetError::Elevation { from: m, to })?;
        let mut points = [self.points[0]; L];
        for (j, out) in points.iter_mut().enumerate() {
            let mut sum = Sum::new();
            for (i, p) in self.points.iter().enumerate() {
                sum.add(p, elevation_factor(m, r, i, j));
            }
            *out = sum.divide(j, binomial(to, j))?;
        }
        Ok(Curve { points })
    }

    /// The Bézier net of the power form Σ q_k t^k, k < K, by equation (11) of the paper in its corrected form:
    /// P_i = Σ_{k ≤ i} C(i,k)/C(m,k) q_k, rounded once, half up.
    ///
    /// ```
    /// use embedded_surfaces::{geometry::Point3, patch::QuadraticCurve};
    /// // (t, t^2, 0)
    /// let [zero, one, square] = [[0, 0, 0], [1, 0, 0], [0, 1, 0]].map(|[x, y, z]| Point3::from_ints(x, y, z));
    /// let parabola = QuadraticCurve::from_power(&[zero, one, square])?;
    /// assert_eq!(parabola.points()[1], Point3::from_bits(1 << 15, 0, 0));
    /// assert_eq!(parabola.points()[2], Point3::from_ints(1, 1, 0));
    /// # Ok::<(), embedded_surfaces::patch::NetError>(())
    /// ```
    ///
    /// # Errors
    /// [`NetError::OutOfRange`] where a control point leaves the legal range.
    pub fn from_power(coefficients: &[Point3<C>; K]) -> Result<Self, NetError> {
        let () = Self::LEGAL;
        let (m, (factor, divisor)) = (K - 1, power_factors(K - 1));
        let mut points = *coefficients;
        for (i, out) in points.iter_mut().enumerate() {
            let mut sum = Sum::new();
            for (k, q) in coefficients.iter().enumerate().take(i + 1) {
                sum.add(q, binomial(i, k) * factor[k]);
            }
            *out = sum.divide(i, divisor)?;
        }
        debug_assert!(m <= MAX_DEGREE);
        Ok(Self { points })
    }
}

/// `(f, d)` with f\[k\]/d = 1/C(m,k), d the least common multiple of C(m, ·) (at most 280).
fn power_factors(m: usize) -> ([i128; MAX_DEGREE + 1], i128) {
    const LCM: [i128; MAX_DEGREE + 1] = [1, 1, 2, 3, 12, 10, 60, 105, 280];
    let mut factors = [0; MAX_DEGREE + 1];
    for (k, factor) in factors.iter_mut().enumerate().take(m + 1) {
        *factor = LCM[m].checked_div(binomial(m, k)).unwrap_or(0);
    }
    (factors, LCM[m])
}

impl<const N: usize, const LEN: usize, C: Coord> Triangle<N, LEN, C> {
    /// The same patch as a net of the higher degree `N2`, each point rounded once, half up.
    ///
    /// # Errors
    /// [`NetError::Elevation`] where `N2` is below `N`.
    pub fn elevate<const N2: usize, const LEN2: usize>(&self) -> Result<Triangle<N2, LEN2, C>, NetError> {
        let () = Triangle::<N2, LEN2, C>::LEGAL;
        let r = N2.checked_sub(N).ok_or(NetError::Elevation { from: N, to: N2 })?;
        let mut points = [self.points[0]; LEN2];
        for row in 0..=N2 {
            for k in 0..=row {
                let (i, j) = (N2 - row, row - k);
                let mut sum = Sum::new();
                // b'[i,j,k] = Σ C(i,a) C(j,b) C(k,c) / C(N2,N) b[a,b,c]
                for b in 0..=N.min(j) {
                    for c in 0..=k.min(N - b) {
                        let a = N - b - c;
                        if a <= i {
                            let factor = binomial(i, a) * binomial(j, b) * binomial(k, c);
                            if let Some(p) = self.points.get(triangle_index(b, c)) {
                                sum.add(p, factor);
                            }
                        }
                    }
                }
                let index = triangle_index(j, k);
                let point = sum.divide(index, binomial(N2, r))?;
                if let Some(out) = points.get_mut(index) {
                    *out = point;
                }
            }
        }
        Ok(Triangle { points })
    }
}

impl<const M: usize, const H: usize, C: Coord> Tensor<M, H, C> {
    /// The same patch as a net of the higher orders `M2` × `H2`, each point rounded once, half up.
    ///
    /// # Errors
    /// [`NetError::Elevation`] where an order is below the patch's.
    pub fn elevate<const M2: usize, const H2: usize>(&self) -> Result<Tensor<M2, H2, C>, NetError> {
        let () = Tensor::<M2, H2, C>::LEGAL;
        let r = M2.checked_sub(M).ok_or(NetError::Elevation { from: M - 1, to: M2 - 1 })?;
        let s = H2.checked_sub(H).ok_or(NetError::Elevation { from: H - 1, to: H2 - 1 })?;
        let mut points = [[self.points[0][0]; H2]; M2];
        for (i, row) in points.iter_mut().enumerate() {
            for (j, out) in row.iter_mut().enumerate() {
                let mut sum = Sum::new();
                for (a, from) in self.points.iter().enumerate() {
                    for (b, p) in from.iter().enumerate() {
                        sum.add(p, elevation_factor(M - 1, r, a, i) * elevation_factor(H - 1, s, b, j));
                    }
                }
                *out = sum.divide(i * H2 + j, binomial(M2 - 1, i) * binomial(H2 - 1, j))?;
            }
        }
        Ok(Tensor { points })
    }

    /// The Bézier net of the power form Σ q_kl r^k s^l (equation (10) of the paper), by equation (11) in its
    /// corrected form: P_ij = Σ_{k ≤ i, l ≤ j} C(i,k) C(j,l) / (C(m,k) C(h,l)) q_kl, rounded once, half up.
    ///
    /// # Errors
    /// [`NetError::OutOfRange`] where a control point leaves the legal range.
    pub fn from_power(coefficients: &[[Point3<C>; H]; M]) -> Result<Self, NetError> {
        let () = Self::LEGAL;
        let ((by_r, divisor_r), (by_s, divisor_s)) = (power_factors(M - 1), power_factors(H - 1));
        let mut points = *coefficients;
        for (i, row) in points.iter_mut().enumerate() {
            for (j, out) in row.iter_mut().enumerate() {
                let mut sum = Sum::new();
                for (k, from) in coefficients.iter().enumerate().take(i + 1) {
                    for (l, q) in from.iter().enumerate().take(j + 1) {
                        sum.add(q, binomial(i, k) * by_r[k] * binomial(j, l) * by_s[l]);
                    }
                }
                *out = sum.divide(i * H + j, divisor_r * divisor_s)?;
            }
        }
        Ok(Self { points })
    }
}
