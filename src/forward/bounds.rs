//! Bounds on derivatives, from the control net.
//!
//! Polynomial: |x_r| ≤ m·max|Δ_r P|. Rational, with the centre c and the half extent R of the net along the axis:
//! x_r = ((A − cD)_r − (x − c)·D_r)/D, so |x_r| ≤ (m·max|Δ_r(A − cD)| + R·m·max|Δ_r D|)/w_min (the centred bound). A
//! polynomial is the case D = 1 of it.

use super::form::{Form, Kind};
use crate::num::Coord;

/// The centred coefficients of one axis: value(a, b) = w·(2p − low − high), twice the coordinate about the centre.
pub(super) struct Axis<'f, 'a> {
    form: &'f Form<'a>,
    axis: usize,
    low: i64,
    high: i64,
    shift: u32,
}

/// The weights' share: their common trailing zeros, and the least weight without them.
fn weights(form: &Form<'_>) -> (u32, i64) {
    form.weights().map_or((0, 1), |weights| {
        let shift = weights.iter().fold(0, |all, w| all | w.to_bits()).trailing_zeros().min(31);
        (shift, weights.iter().map(|w| w.bits() >> shift).min().unwrap_or(1).max(1))
    })
}

/// The common trailing zeros of all weights.
pub(super) fn weight_shift(form: &Form<'_>) -> u32 {
    weights(form).0
}

/// The largest weight, without common trailing zeros; 1 for a polynomial.
pub(super) fn largest_weight(form: &Form<'_>) -> u128 {
    let (shift, _) = weights(form);
    let largest = form.weights().into_iter().flatten().map(|w| w.bits() >> shift).max().unwrap_or(1);
    largest.unsigned_abs().into()
}

/// What derivatives are counted in: |x_r| = value / unit, in units of the lattice.
pub(super) fn unit(form: &Form<'_>) -> u128 {
    u128::from(weights(form).1.unsigned_abs()) << 17
}

impl<'f, 'a> Axis<'f, 'a> {
    pub(super) fn new(form: &'f Form<'a>, axis: usize) -> Self {
        let coordinate = |p: &crate::geometry::Point3| match axis {
            0 => p.x.bits(),
            1 => p.y.bits(),
            _ => p.z.bits(),
        };
        let low = form.points().iter().map(coordinate).min().unwrap_or(0);
        let high = form.points().iter().map(coordinate).max().unwrap_or(0);
        Self { form, axis, low, high, shift: weight_shift(form) }
    }

    fn weight(&self, a: usize, b: usize) -> i64 {
        self.form.weight_bits(a, b) >> self.shift
    }

    fn value(&self, a: usize, b: usize) -> i128 {
        i128::from(self.weight(a, b)) * i128::from(2 * self.form.bits(self.axis, a, b) - self.low - self.high)
    }

    /// Twice the half extent.
    pub(super) fn extent(&self) -> u128 {
        u128::from(self.high.abs_diff(self.low))
    }

    /// Bounds on |x_r| and |x_s| (|x_u|, |x_v| of a triangle), over [`unit`].
    pub(super) fn slopes(&self) -> [u128; 2] {
        if self.form.weights().is_none() {
            let [by_r, by_s] = self.form.largest_edges(self.axis).map(u64::from);
            let (m, h) = self.form.degrees;
            // Below 2^36, of twice the coordinate.
            return [2 * m as u64 * by_r, 2 * h as u64 * by_s].map(u128::from);
        }
        let values = self.form.largest_differences(|a, b| self.value(a, b));
        let weights = self.form.largest_differences(|a, b| self.weight(a, b).into());
        let degrees = [self.form.degrees.0, self.form.degrees.1];
        core::array::from_fn(|d| degrees[d] as u128 * (values[d] + self.extent() * weights[d]))
    }

    /// The bound on |x_u − x_v| of a triangle: the third family of net edges.
    pub(super) fn third_slope(&self) -> u128 {
        let n = self.form.degrees.0;
        let (mut values, mut weights) = (0, 0);
        for a in 0..n {
            for b in 0..n - a {
                values = self.value(a + 1, b).abs_diff(self.value(a, b + 1)).max(values);
                weights = u128::from(self.weight(a + 1, b).abs_diff(self.weight(a, b + 1))).max(weights);
            }
        }
        n as u128 * (values + self.extent() * weights)
    }

    /// The bounds on |x_r·along_s ∓ x_s·along_r| of a tensor patch, over [`unit`]²; `None` where 128 bits do not hold
    /// them. Both derivatives enter as Bernstein coefficients of the common degree (m, h).
    pub(super) fn diagonals(&self, along_r: i128, along_s: i128) -> Option<[u128; 2]> {
        let (m, h) = self.form.degrees;
        let (mut values, mut weights) = ([0; 2], [0; 2]);
        for i in 0..=m {
            for j in 0..=h {
                let by_r = elevated(i, m, |a| self.value(a + 1, j) - self.value(a, j)).checked_mul(along_s)?;
                let by_s = elevated(j, h, |b| self.value(i, b + 1) - self.value(i, b)).checked_mul(along_r)?;
                widen(&mut values, by_r, by_s)?;
                let weight = |a, b| i128::from(self.weight(a, b));
                let by_r = elevated(i, m, |a| weight(a + 1, j) - weight(a, j)).checked_mul(along_s)?;
                let by_s = elevated(j, h, |b| weight(i, b + 1) - weight(i, b)).checked_mul(along_r)?;
                widen(&mut weights, by_r, by_s)?;
            }
        }
        let total = |d: usize| self.extent().checked_mul(weights[d])?.checked_add(values[d]);
        Some([total(0)?, total(1)?])
    }
}

/// Raises both maxima to |p − q| and |p + q|.
fn widen(largest: &mut [u128; 2], p: i128, q: i128) -> Option<()> {
    largest[0] = largest[0].max(p.checked_sub(q)?.unsigned_abs());
    largest[1] = largest[1].max(p.checked_add(q)?.unsigned_abs());
    Some(())
}

/// Coefficient `i` of a derivative of degree m − 1, elevated to degree m, from its net differences e:
/// i·e_(i−1) + (m − i)·e_i.
fn elevated(i: usize, m: usize, e: impl Fn(usize) -> i128) -> i128 {
    let before = if i > 0 { i as i128 * e(i - 1) } else { 0 };
    let after = if i < m { (m - i) as i128 * e(i) } else { 0 };
    before + after
}

/// K: the longest step of any coordinate between neighbours in a row or column, in whole units, rounded up.
///
/// Never more than the extent of the net, which holds the surface.
pub(super) fn longest_step(form: &Form<'_>) -> u32 {
    let unit = unit(form);
    let mut longest = 1;
    for axis in 0..3 {
        let axis = Axis::new(form, axis);
        let [by_r, by_s] = axis.slopes();
        let steps = |n: u32| unit * u128::from(n.max(1));
        let by_s = if form.kind == Kind::Curve { 0 } else { ceil_div(by_s, steps(form.steps.1)) };
        let bound = ceil_div(by_r, steps(form.steps.0)).max(by_s).min(ceil_div(axis.extent(), 1 << 16));
        longest = longest.max(bound);
    }
    longest as u32
}

/// `ceil(a / b)`, 0 for b = 0.
pub(super) fn ceil_div(a: u128, b: u128) -> u128 {
    // Without the zeros that both end in, most quotients are of 32 bits.
    let shift = (a | b).trailing_zeros() & 127;
    let (a, b) = (a >> shift, b >> shift);
    if let (Ok(a), Ok(b)) = (u32::try_from(a), u32::try_from(b)) {
        return a.checked_div(b).map_or(0, |quotient| u128::from(quotient) + u128::from(quotient * b != a));
    }
    a.checked_div(b).map_or(0, |quotient| quotient + u128::from(quotient * b != a))
}
