//! Exact values: de Casteljau steps in 640-bit integers, one rounding at the end.
//!
//! A step with a parameter p/q replaces neighbours a, b by (q − p)·a + p·b, so m steps carry the factor q^m; a step
//! along a direction replaces them by b − a. Parameters have at most 16 bits, so the widest numerator stays below
//! 2^640 (see `num::wide`).

use super::{
    Barycentric, CurveNet, MAX_DEGREE, NetError, Parameter, RationalCurveNet, RationalTensorNet, RationalTriangleNet,
    TensorNet, TriangleNet, triangle_len,
};
use crate::geometry::{Point3, Vector3};
use crate::num::{Coord, I16F16, I32F32, Wide};

/// One de Casteljau step along a curve: neighbours a, b become low·a + high·b.
#[derive(Clone, Copy)]
struct Step {
    low: i32,
    high: i32,
}

impl Step {
    const DIRECTION: Self = Self { low: -1, high: 1 };

    fn at(p: Parameter) -> Self {
        let high = p.numerator() as i32;
        Self { low: p.denominator() as i32 - high, high }
    }
}

/// One step over a triangle: factors of the neighbours towards u, v and w.
#[derive(Clone, Copy)]
struct TriangleStep {
    factors: [i32; 3],
}

impl TriangleStep {
    const ALONG_U: Self = Self { factors: [1, 0, -1] };
    const ALONG_V: Self = Self { factors: [0, 1, -1] };

    fn at(b: Barycentric) -> Self {
        Self { factors: b.weights().map(|w| w as i32) }
    }
}

/// Collapses `steps.len() + 1` values to one.
fn collapse_curve(mut values: &mut [Wide], steps: impl IntoIterator<Item = Step>) -> Wide {
    for step in steps {
        for i in 1..values.len() {
            values[i - 1] = values[i - 1].mul_i32(step.low).add(&values[i].mul_i32(step.high));
        }
        let Some((_, shorter)) = values.split_last_mut() else { return Wide::ZERO };
        values = shorter;
    }
    values.first().copied().unwrap_or(Wide::ZERO)
}

/// Collapses a triangular net of this degree to one value.
fn collapse_triangle(values: &mut [Wide], degree: usize, steps: impl IntoIterator<Item = TriangleStep>) -> Wide {
    let mut degree = degree;
    for step in steps {
        degree = degree.saturating_sub(1);
        let [u, v, w] = step.factors;
        let mut index = 0;
        for row in 0..=degree {
            for _ in 0..=row {
                // b[i,j,k] of the smaller net stands between its three parents towards u, v and w: itself and two
                // neighbours in the next row.
                let parent = |at: usize, factor| values.get(at).map_or(Wide::ZERO, |value| value.mul_i32(factor));
                let sum = parent(index, u).add(&parent(index + row + 1, v)).add(&parent(index + row + 2, w));
                if let Some(value) = values.get_mut(index) {
                    *value = sum;
                }
                index += 1;
            }
        }
    }
    values.first().copied().unwrap_or(Wide::ZERO)
}

/// Where the coordinates of a weighted sum come from: w·x, w·y, w·z or w.
#[derive(Clone, Copy)]
struct Source<'a, C> {
    points: &'a [Point3<C>],
    weights: Option<&'a [I16F16]>,
}

impl<C: Coord> Source<'_, C> {
    /// Homogeneous coordinate `axis` (0 ..= 2, or 3 for the weight) of point `index`.
    fn get(&self, axis: usize, index: usize) -> Wide {
        let weight = self.weights.map_or(1, |w| w.get(index).map_or(0, |w| w.to_bits()));
        // The net was counted when it was made; the fallback is never taken.
        let coordinate = self.points.get(index).map_or(0, |p| match axis {
            0 => p.x.bits(),
            1 => p.y.bits(),
            2 => p.z.bits(),
            _ => 1,
        });
        Wide::from_i64(coordinate).mul_i32(weight)
    }
}

/// A surface or curve whose homogeneous coordinates can be collapsed by steps `S`.
trait Collapse<S> {
    fn collapse(&self, axis: usize, steps: S) -> Wide;
}

struct CurveSource<'a, C>(Source<'a, C>);
struct TriangleSource<'a, C>(Source<'a, C>, usize);
struct TensorSource<'a, C>(Source<'a, C>, (usize, usize));

impl<C: Coord, I: IntoIterator<Item = Step>> Collapse<I> for CurveSource<'_, C> {
    fn collapse(&self, axis: usize, steps: I) -> Wide {
        let mut values = [Wide::ZERO; MAX_DEGREE + 1];
        let count = self.0.points.len().min(values.len());
        for (i, value) in values[..count].iter_mut().enumerate() {
            *value = self.0.get(axis, i);
        }
        collapse_curve(&mut values[..count], steps)
    }
}

impl<C: Coord, I: IntoIterator<Item = TriangleStep>> Collapse<I> for TriangleSource<'_, C> {
    fn collapse(&self, axis: usize, steps: I) -> Wide {
        let mut values = [Wide::ZERO; triangle_len(MAX_DEGREE)];
        for (i, value) in values.iter_mut().enumerate().take(triangle_len(self.1)) {
            *value = self.0.get(axis, i);
        }
        collapse_triangle(&mut values, self.1, steps)
    }
}

impl<C: Coord, R: IntoIterator<Item = Step>, S: IntoIterator<Item = Step> + Clone> Collapse<(R, S)>
    for TensorSource<'_, C>
{
    fn collapse(&self, axis: usize, (along_r, along_s): (R, S)) -> Wide {
        let (m, h) = (self.1.0.min(MAX_DEGREE), self.1.1.min(MAX_DEGREE));
        let mut columns = [Wide::ZERO; MAX_DEGREE + 1];
        for (i, column) in columns[..=m].iter_mut().enumerate() {
            let mut row = [Wide::ZERO; MAX_DEGREE + 1];
            for (j, value) in row[..=h].iter_mut().enumerate() {
                *value = self.0.get(axis, i * (h + 1) + j);
            }
            *column = collapse_curve(&mut row[..=h], along_s.clone());
        }
        collapse_curve(&mut columns[..=m], along_r)
    }
}

fn product(denominators: impl IntoIterator<Item = u32>) -> Wide {
    denominators.into_iter().fold(Wide::from_i64(1), |p, d| p.mul_i32(d as i32))
}

/// The point with these homogeneous coordinates. A convex combination of legal points is legal, so the fallback is
/// never taken.
fn rounded_point<C: Coord>(coordinate: impl Fn(usize) -> Wide, divisor: &Wide) -> Point3<C> {
    let round = |axis| {
        let bits = coordinate(axis).div_half_up(divisor).unwrap_or(0);
        C::from_legal_bits(bits.into()).unwrap_or(C::ZERO)
    };
    Point3::new(round(0), round(1), round(2))
}

/// m·(difference)/q^(m−1), to 2^-32. Eight times a difference of legal coordinates fits an `I32F32`.
fn polynomial_derivative<C: Coord>(degree: usize, divisor: &Wide, coordinate: impl Fn(usize) -> Wide) -> Vector3 {
    let round = |axis| {
        let numerator = coordinate(axis).mul_i32(degree as i32).shl(32 - C::FRACTION_BITS);
        I32F32::from_bits(numerator.div_half_up(divisor).unwrap_or(0))
    };
    Vector3::new(round(0), round(1), round(2))
}

/// The quotient rule: m·q·(A' W − A W') / W², to 2^-32; `None` where a component does not fit an `I32F32`.
fn rational_derivative<C: Coord>(
    factor: (usize, u32),
    value: impl Fn(usize) -> Wide,
    slope: impl Fn(usize) -> Wide,
) -> Option<Vector3> {
    let (weight, weight_slope) = (value(3), slope(3));
    let square = weight.mul(&weight);
    let round = |axis| {
        let cross = slope(axis).mul(&weight).sub(&value(axis).mul(&weight_slope));
        let scaled = cross.mul_i32(factor.0 as i32).mul_i32(factor.1 as i32).shl(32 - C::FRACTION_BITS);
        scaled.div_half_up(&square).map(I32F32::from_bits)
    };
    Some(Vector3::new(round(0)?, round(1)?, round(2)?))
}

fn expect_arguments(expected: usize, given: usize) -> Result<(), NetError> {
    if expected == given { Ok(()) } else { Err(NetError::Count { expected, given }) }
}

/// `count` steps at `p`.
fn repeat(p: Parameter, count: usize) -> impl Iterator<Item = Step> + Clone {
    core::iter::repeat_n(Step::at(p), count)
}

/// A step along the curve, then `count` at `p`.
fn slope(p: Parameter, count: usize) -> impl Iterator<Item = Step> + Clone {
    core::iter::once(Step::DIRECTION).chain(repeat(p, count))
}

fn powers(p: Parameter, count: usize) -> impl Iterator<Item = u32> {
    core::iter::repeat_n(p.denominator(), count)
}

impl<C: Coord> CurveNet<'_, C> {
    fn source(&self) -> CurveSource<'_, C> {
        CurveSource(Source { points: self.points(), weights: None })
    }

    /// The point at `t`, correctly rounded, half up.
    ///
    /// Cost: m(m+1)/2 steps of 640-bit integers per axis; 1 KB of stack. For many points use [`crate::forward`].
    #[must_use]
    pub fn eval(&self, t: Parameter) -> Point3<C> {
        let (source, m) = (self.source(), self.degree());
        rounded_point(|axis| source.collapse(axis, repeat(t, m)), &product(powers(t, m)))
    }

    /// The blossom at as many arguments as the degree, correctly rounded: symmetric, affine in each, and equal to
    /// the curve where all agree (Ramshaw's polar form).
    ///
    /// # Errors
    /// [`NetError::Count`] for another number of arguments.
    pub fn blossom(&self, t: &[Parameter]) -> Result<Point3<C>, NetError> {
        expect_arguments(self.degree(), t.len())?;
        let source = self.source();
        let divisor = product(t.iter().map(|p| p.denominator()));
        Ok(rounded_point(|axis| source.collapse(axis, t.iter().map(|p| Step::at(*p))), &divisor))
    }

    /// The derivative at `t`, rounded to 2^-32, half up.
    #[must_use]
    pub fn derivative(&self, t: Parameter) -> Vector3 {
        let (source, rest) = (self.source(), self.degree() - 1);
        let divisor = product(powers(t, rest));
        polynomial_derivative::<C>(self.degree(), &divisor, |axis| source.collapse(axis, slope(t, rest)))
    }
}

impl<C: Coord> TriangleNet<'_, C> {
    fn source(&self) -> TriangleSource<'_, C> {
        TriangleSource(Source { points: self.points(), weights: None }, self.degree())
    }

    /// The point at (u, v, w), correctly rounded, half up. Stack: 4 KB.
    #[must_use]
    pub fn eval(&self, at: Barycentric) -> Point3<C> {
        let (source, n) = (self.source(), self.degree());
        let divisor = product(core::iter::repeat_n(at.denominator(), n));
        rounded_point(|axis| source.collapse(axis, core::iter::repeat_n(TriangleStep::at(at), n)), &divisor)
    }

    /// The blossom at as many arguments as the degree, correctly rounded.
    ///
    /// # Errors
    /// [`NetError::Count`] for another number of arguments.
    pub fn blossom(&self, at: &[Barycentric]) -> Result<Point3<C>, NetError> {
        expect_arguments(self.degree(), at.len())?;
        let source = self.source();
        let divisor = product(at.iter().map(|b| b.denominator()));
        Ok(rounded_point(|axis| source.collapse(axis, at.iter().map(|b| TriangleStep::at(*b))), &divisor))
    }

    /// The partial derivatives by u and by v, where w = 1 − u − v (equation (7) of the paper), rounded to 2^-32.
    #[must_use]
    pub fn partials(&self, at: Barycentric) -> [Vector3; 2] {
        let (source, rest) = (self.source(), self.degree() - 1);
        let divisor = product(core::iter::repeat_n(at.denominator(), rest));
        [TriangleStep::ALONG_U, TriangleStep::ALONG_V].map(|along| {
            let steps = core::iter::once(along).chain(core::iter::repeat_n(TriangleStep::at(at), rest));
            polynomial_derivative::<C>(self.degree(), &divisor, |axis| source.collapse(axis, steps.clone()))
        })
    }
}

impl<C: Coord> TensorNet<'_, C> {
    fn source(&self) -> TensorSource<'_, C> {
        TensorSource(Source { points: self.points(), weights: None }, self.degrees())
    }

    /// The point at (r, s), correctly rounded, half up. Stack: 2 KB.
    #[must_use]
    pub fn eval(&self, r: Parameter, s: Parameter) -> Point3<C> {
        let (source, (m, h)) = (self.source(), self.degrees());
        let divisor = product(powers(r, m).chain(powers(s, h)));
        rounded_point(|axis| source.collapse(axis, (repeat(r, m), repeat(s, h))), &divisor)
    }

    /// The blossom at as many arguments as the degree in each direction, correctly rounded.
    ///
    /// # Errors
    /// [`NetError::Count`] for another number of arguments.
    pub fn blossom(&self, r: &[Parameter], s: &[Parameter]) -> Result<Point3<C>, NetError> {
        let (m, h) = self.degrees();
        expect_arguments(m, r.len())?;
        expect_arguments(h, s.len())?;
        let source = self.source();
        let divisor = product(r.iter().chain(s).map(|p| p.denominator()));
        let steps = |p: &Parameter| Step::at(*p);
        Ok(rounded_point(|axis| source.collapse(axis, (r.iter().map(steps), s.iter().map(steps))), &divisor))
    }

    /// The partial derivatives by r and by s (equation (12) of the paper), rounded to 2^-32.
    #[must_use]
    pub fn partials(&self, r: Parameter, s: Parameter) -> [Vector3; 2] {
        let (source, (m, h)) = (self.source(), self.degrees());
        let by_r = product(powers(r, m - 1).chain(powers(s, h)));
        let by_s = product(powers(r, m).chain(powers(s, h - 1)));
        [
            polynomial_derivative::<C>(m, &by_r, |axis| source.collapse(axis, (slope(r, m - 1), repeat(s, h)))),
            polynomial_derivative::<C>(h, &by_s, |axis| source.collapse(axis, (repeat(r, m), slope(s, h - 1)))),
        ]
    }
}

impl<C: Coord> RationalCurveNet<'_, C> {
    fn source(&self) -> CurveSource<'_, C> {
        CurveSource(Source { points: self.points(), weights: Some(self.weights()) })
    }

    /// The point at `t`, correctly rounded, half up.
    #[must_use]
    pub fn eval(&self, t: Parameter) -> Point3<C> {
        let (source, m) = (self.source(), self.control_net().degree());
        let value = |axis| source.collapse(axis, repeat(t, m));
        rounded_point(value, &value(3))
    }

    /// The derivative at `t`, rounded to 2^-32; `None` where it does not fit an `I32F32`.
    #[must_use]
    pub fn derivative(&self, t: Parameter) -> Option<Vector3> {
        let (source, m) = (self.source(), self.control_net().degree());
        rational_derivative::<C>(
            (m, t.denominator()),
            |axis| source.collapse(axis, repeat(t, m)),
            |axis| source.collapse(axis, slope(t, m - 1)),
        )
    }
}

impl<C: Coord> RationalTriangleNet<'_, C> {
    fn source(&self) -> TriangleSource<'_, C> {
        let source = Source { points: self.points(), weights: Some(self.weights()) };
        TriangleSource(source, self.control_net().degree())
    }

    /// The point at (u, v, w), correctly rounded, half up.
    #[must_use]
    pub fn eval(&self, at: Barycentric) -> Point3<C> {
        let (source, n) = (self.source(), self.control_net().degree());
        let value = |axis| source.collapse(axis, core::iter::repeat_n(TriangleStep::at(at), n));
        rounded_point(value, &value(3))
    }

    /// The partial derivatives by u and by v, rounded to 2^-32; `None` where one does not fit an `I32F32`.
    #[must_use]
    pub fn partials(&self, at: Barycentric) -> Option<[Vector3; 2]> {
        let (source, n) = (self.source(), self.control_net().degree());
        let by = |along| {
            let steps = core::iter::once(along).chain(core::iter::repeat_n(TriangleStep::at(at), n - 1));
            rational_derivative::<C>(
                (n, at.denominator()),
                |axis| source.collapse(axis, core::iter::repeat_n(TriangleStep::at(at), n)),
                |axis| source.collapse(axis, steps.clone()),
            )
        };
        Some([by(TriangleStep::ALONG_U)?, by(TriangleStep::ALONG_V)?])
    }
}

impl<C: Coord> RationalTensorNet<'_, C> {
    fn source(&self) -> TensorSource<'_, C> {
        let source = Source { points: self.points(), weights: Some(self.weights()) };
        TensorSource(source, self.control_net().degrees())
    }

    /// The point at (r, s), correctly rounded, half up.
    #[must_use]
    pub fn eval(&self, r: Parameter, s: Parameter) -> Point3<C> {
        let (source, (m, h)) = (self.source(), self.control_net().degrees());
        let value = |axis| source.collapse(axis, (repeat(r, m), repeat(s, h)));
        rounded_point(value, &value(3))
    }

    /// The partial derivatives by r and by s, rounded to 2^-32; `None` where one does not fit an `I32F32`.
    #[must_use]
    pub fn partials(&self, r: Parameter, s: Parameter) -> Option<[Vector3; 2]> {
        let (source, (m, h)) = (self.source(), self.control_net().degrees());
        let value = |axis| source.collapse(axis, (repeat(r, m), repeat(s, h)));
        Some([
            rational_derivative::<C>((m, r.denominator()), value, |axis| {
                source.collapse(axis, (slope(r, m - 1), repeat(s, h)))
            })?,
            rational_derivative::<C>((h, s.denominator()), value, |axis| {
                source.collapse(axis, (repeat(r, m), slope(s, h - 1)))
            })?,
        ])
    }
}
