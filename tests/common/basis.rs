//! Bernstein bases at rational parameters as integers over one divisor, in the storage order of nets.

use super::{choose, ratio};
use embedded_surfaces::num::{Coord, I16F16};
use embedded_surfaces::patch::{Barycentric, Parameter};
use embedded_surfaces::{geometry::Point3, num::I32F32};
use num_bigint::BigInt;
use num_rational::BigRational;

/// One factor per control point, all over `divisor`.
#[derive(Clone, Debug)]
pub(crate) struct Basis {
    pub(crate) factors: Vec<BigInt>,
    pub(crate) divisor: BigInt,
}

/// p/q = `numerator`/`divisor` and 1 − p/q as powers.
fn terms(m: usize, low: i64, high: i64) -> Vec<BigInt> {
    (0..=m).map(|i| choose(m, i) * BigInt::from(high).pow(i as u32) * BigInt::from(low).pow((m - i) as u32)).collect()
}

fn divisor(q: u32, m: usize) -> BigInt {
    BigInt::from(q).pow(m as u32)
}

/// m(B_(i−1) − B_i) from a basis of degree m − 1: the derivative, equations (6) and (12).
fn slopes(lower: &[BigInt]) -> Vec<BigInt> {
    let m = lower.len();
    let at = |i: Option<usize>| i.and_then(|i| lower.get(i)).cloned().unwrap_or_default();
    (0..=m).map(|i| (at(i.checked_sub(1)) - at(Some(i))) * m).collect()
}

/// B_i^m(t) and their derivatives.
pub(crate) fn curve_basis(m: usize, t: Parameter) -> [Basis; 2] {
    let (p, q) = (t.numerator(), t.denominator());
    let (low, high) = (i64::from(q - p), i64::from(p));
    [
        Basis { factors: terms(m, low, high), divisor: divisor(q, m) },
        Basis { factors: slopes(&terms(m - 1, low, high)), divisor: divisor(q, m - 1) },
    ]
}

/// B_i^m(r) B_j^h(s), then their derivatives by r and by s.
pub(crate) fn tensor_basis((m, h): (usize, usize), r: Parameter, s: Parameter) -> [Basis; 3] {
    let outer = |a: &Basis, b: &Basis| Basis {
        factors: a.factors.iter().flat_map(|a| b.factors.iter().map(move |b| a * b)).collect(),
        divisor: &a.divisor * &b.divisor,
    };
    let ([along_r, by_r], [along_s, by_s]) = (curve_basis(m, r), curve_basis(h, s));
    [outer(&along_r, &along_s), outer(&by_r, &along_s), outer(&along_r, &by_s)]
}

/// All (i, j, k) with i + j + k = n in storage order.
pub(crate) fn triangle_indices(n: usize) -> impl Iterator<Item = (usize, usize, usize)> {
    (0..=n).rev().flat_map(move |i| (0..=n - i).rev().map(move |j| (i, j, n - i - j)))
}

/// n!/(i!j!k!) u^i v^j w^k, then their derivatives by u and by v where w = 1 − u − v: equation (6).
pub(crate) fn triangle_basis(n: usize, at: Barycentric) -> [Basis; 3] {
    let weights = at.weights();
    let term = |n: usize, (i, j, k): (usize, usize, usize)| {
        let exponents = [i as u32, j as u32, k as u32];
        let powers = weights.iter().zip(exponents).map(|(w, e)| BigInt::from(*w).pow(e));
        powers.fold(choose(n, i) * choose(n - i, j), |product, power| product * power)
    };
    let by = |u: usize, v: usize| {
        let factors = triangle_indices(n).map(|(i, j, k)| {
            let before = if i >= u && j >= v { term(n - 1, (i - u, j - v, k)) } else { BigInt::default() };
            let after = if k > 0 { term(n - 1, (i, j, k - 1)) } else { BigInt::default() };
            (before - after) * n
        });
        Basis { factors: factors.collect(), divisor: divisor(at.denominator(), n - 1) }
    };
    let value = triangle_indices(n).map(|index| term(n, index)).collect();
    [Basis { factors: value, divisor: divisor(at.denominator(), n) }, by(1, 0), by(0, 1)]
}

impl Basis {
    /// Σ factor·value / divisor.
    pub(crate) fn sum(&self, values: impl Iterator<Item = BigRational>) -> BigRational {
        let mut count = 0;
        let sum = self.factors.iter().zip(values).fold(ratio(0, 1), |sum, (f, v)| {
            count += 1;
            sum + v * f
        });
        assert_eq!(count, self.factors.len());
        sum / &self.divisor
    }

    /// Σ factor·bits / divisor / 2^F for one axis, weighted if there are weights; the sum of the weights for axis 3.
    pub(crate) fn homogeneous<C: Coord>(
        &self,
        points: &[Point3<C>],
        weights: Option<&[I16F16]>,
        axis: usize,
    ) -> BigRational {
        assert_eq!(points.len(), self.factors.len());
        let mut sum = BigInt::default();
        for (i, (factor, p)) in self.factors.iter().zip(points).enumerate() {
            let bits = [p.x.bits(), p.y.bits(), p.z.bits(), 1 << C::FRACTION_BITS][axis];
            sum += factor * bits * weights.map_or(1, |w| w[i].to_bits());
        }
        BigRational::new(sum, &self.divisor << C::FRACTION_BITS)
    }

    /// The polynomial or rational value along one axis.
    pub(crate) fn value<C: Coord>(&self, points: &[Point3<C>], weights: Option<&[I16F16]>, axis: usize) -> BigRational {
        let value = self.homogeneous(points, weights, axis);
        if weights.is_some() { value / self.homogeneous(points, weights, 3) } else { value }
    }

    /// (A' W − A W') / W² along one axis; `self` is the basis of the derivative.
    pub(crate) fn quotient_rule<C: Coord>(
        &self,
        value: &Self,
        points: &[Point3<C>],
        weights: &[I16F16],
        axis: usize,
    ) -> BigRational {
        let of = |basis: &Self, axis| basis.homogeneous(points, Some(weights), axis);
        let (a, w) = (of(value, axis), of(value, 3));
        (of(self, axis) * &w - a * of(self, 3)) / (&w * &w)
    }
}

/// The raw bits as an integer of the coordinate type's exact value, half up.
pub(crate) fn rounded_bits(x: &BigRational, fraction_bits: u32) -> BigInt {
    super::round_half_up(&(x * (BigInt::from(1) << fraction_bits)))
}

/// Fails unless the point is the exact one, each coordinate rounded half up.
pub(crate) fn assert_rounds_to<C: Coord>(ours: &Point3<C>, exact: impl Fn(usize) -> BigRational) {
    for (axis, c) in ours.to_array().into_iter().enumerate() {
        assert_eq!(BigInt::from(c.bits()), rounded_bits(&exact(axis), C::FRACTION_BITS), "axis {axis}");
    }
}

/// The same for vectors in 2^-32.
pub(crate) fn assert_vector(ours: &embedded_surfaces::geometry::Vector3, exact: impl Fn(usize) -> BigRational) {
    assert_rounds_to(&Point3::<I32F32>::from_array(ours.to_array()), exact);
}
