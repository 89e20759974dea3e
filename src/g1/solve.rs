//! The twist points around a vertex and the points c2 of its edges (step 4 of the scheme).

use super::balance::{FINE, Far, View, curve_target, differences, right_side, row_weights, weight};
use super::cyclic::{Cyclic, Wide3};
use super::fan::Fan;
use super::ring::Ring;
use super::setting::{FACTOR, ONE, fits};
use super::{G1Error, Scheme, literal};
use crate::num::{Coord, Sum3, Triple, minus, plus, shift_half_up};

/// Corrections of the solution.
const REFINEMENTS: usize = 3;

/// A vertex with all its points, as vectors from it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Solved {
    pub(super) fan: Fan,
    /// The twist points of the sectors, and where they should be.
    pub(super) w: Ring<Triple>,
    pub(super) twist_target: Ring<Triple>,
    /// The points c2 of the edges, and where they should be.
    pub(super) z: Ring<Triple>,
    pub(super) curve_target: Ring<Triple>,
}

impl Solved {
    /// A place for a vertex, so that none is copied.
    pub(super) const fn blank() -> Self {
        let none = Ring::all([0; 3]);
        Self { fan: Fan::blank(), w: none, twist_target: none, z: none, curve_target: none }
    }
}

/// The twist point of the degree-elevated PN triangle, from its vertex:
/// (20·(e₁ + e₂) + 4·(d₁ + d₂) + 5·Σe)/40 with all six tangents of the face in the sum.
fn twist_target(fan: &Fan, far: &Far, i: usize) -> Option<Triple> {
    let next = fan.star.after(i);
    let sum = Sum3::default().plus(&fan.e[i], 25).plus(&fan.e[next], 25).plus(&far.d[i], 4).plus(&far.d[next], 4);
    let sum = sum.plus(&far.e[i], 5).plus(&far.e[next], 5).plus(&far.to_next[i], 5).plus(&far.to_previous[next], 5);
    sum.divide(40)
}

impl<C: Coord> View<'_, '_, C> {
    /// A vertex with all its points.
    #[inline(never)]
    pub(super) fn solved(&self, vertex: usize, solved: &mut Solved) -> Result<(), G1Error> {
        let mut far = Far::blank();
        self.fan(vertex, &mut solved.fan)?;
        self.far(&solved.fan, &mut far)?;
        self.targets(solved, &far)?;
        if self.setting.options.scheme == Scheme::Smooth { self.solve(solved, &far) } else { Ok(()) }
    }

    #[inline(never)]
    fn targets(&self, solved: &mut Solved, far: &Far) -> Result<(), G1Error> {
        let fan = &solved.fan;
        for i in 0..fan.star.len {
            solved.z[i] = fits(curve_target(&fan.e[i], &far.e[i], &far.d[i]), fan.vertex)?;
        }
        solved.curve_target = solved.z;
        let literal = self.setting.options.scheme == Scheme::Literal;
        for i in 0..fan.star.sectors() {
            let given = self.setting.given_twist(fan.star.left[i]).map(|point| minus(&point, &fan.at));
            solved.twist_target[i] = fits(given.or_else(|| twist_target(fan, far, i)), fan.vertex)?;
            solved.w[i] = solved.twist_target[i];
            if literal {
                solved.w[i] = fits(literal::twist(&fan.e[i], &fan.e[fan.star.after(i)]), fan.vertex)?;
            }
        }
        Ok(())
    }

    /// The least change of the targets, c2 weighted by 1/ω, that meets (V) at every inner edge.
    #[inline(never)]
    fn solve(&self, solved: &mut Solved, far: &Far) -> Result<(), G1Error> {
        let fan = &solved.fan;
        let (vertex, (first, rows)) = (fan.vertex, fan.star.inner());
        if rows == 0 {
            return Ok(());
        }
        let mut omega = Ring::all(0);
        for i in first..first + rows {
            let (k, m) = differences(fan, far, i);
            omega[i] = weight(k, m);
        }
        let factors = matrix(fan, &omega).factored();
        for _ in 0..REFINEMENTS {
            let mut left = residuals(solved, far);
            if factors.dropped && solved.fan.star.is_even() {
                spread(&solved.fan, &mut left);
            }
            factors.solve(&mut left);
            fits(apply(solved, &omega, &left), vertex)?;
        }
        let (left, fan) = (residuals(solved, far), &solved.fan);
        let tolerance = i128::from(self.setting.options.tolerance.to_bits());
        for i in 0..rows {
            // In 2^-48: the tolerance, twice, and what rounding the points leaves.
            let rounding = (i128::from(fan.m[first + i].unsigned_abs()) >> (FACTOR - 18)) + (1 << 21);
            let most = ((i128::from(fan.size) * tolerance) >> 15) + rounding;
            let residual = left[i].iter().map(|c| c.unsigned_abs()).max().unwrap_or(0) as i128;
            if residual > most {
                let residual = self.setting.outward(shift_half_up(residual, 16));
                return Err(G1Error::VertexInconsistent { vertex, residual });
            }
        }
        Ok(())
    }
}

/// G = C Ω Cᵀ, in 2^-40.
fn matrix(fan: &Fan, omega: &Ring<i64>) -> Cyclic {
    let (first, rows) = fan.star.inner();
    let product = |a: i64, b: i64| (i128::from(a) * i128::from(b)) >> (2 * FACTOR - FINE);
    let mut matrix = Cyclic::new(rows);
    for row in 0..rows {
        let i = first + row;
        let (kappa, next) = (fan.kappa[i], fan.kappa[fan.star.after(i)]);
        let free = ONE - fan.m[i];
        let edge = (product(free, free) * i128::from(omega[i])) >> FACTOR;
        matrix.diagonal[row] = product(ONE + kappa, ONE + kappa) + product(ONE - kappa, ONE - kappa) + edge;
        let coupling = product(ONE + kappa, ONE - next);
        if row + 1 < rows {
            matrix.beside[row] = coupling;
        } else if fan.star.closed {
            matrix.corner = coupling;
        }
    }
    matrix
}

/// d − C x of the inner edges in 2^-48 working units.
fn residuals(solved: &Solved, far: &Far) -> Ring<Wide3> {
    let fan = &solved.fan;
    let (first, rows) = fan.star.inner();
    let mut left = Ring::all([0; 3]);
    for row in 0..rows {
        let (i, kappa) = (first + row, fan.kappa[first + row]);
        let sum = right_side(fan, far, i)
            .plus(&solved.w[i], -4 * (ONE + kappa))
            .plus(&solved.w[fan.star.before(i)], -4 * (ONE - kappa))
            .plus(&solved.z[i], 4 * (ONE - fan.m[i]));
        left[row] = sum.0.map(|c| shift_half_up(c.clamp(-(1 << 124), 1 << 124), FACTOR + 2 - 16));
    }
    left
}

/// Takes from the rows what no choice of twists can meet, where nothing else is free: their part along the weights of (W).
fn spread(fan: &Fan, left: &mut Ring<Wide3>) {
    let weights = row_weights(fan);
    let signed = |i: usize| i128::from(if i.is_multiple_of(2) { weights[i] } else { -weights[i] });
    let squares = (0..fan.star.len).map(|i| (signed(i) * signed(i)) >> FINE).sum::<i128>();
    for c in 0..3 {
        let sum = (0..fan.star.len).fold(0_i128, |sum, i| sum.saturating_add(signed(i).saturating_mul(left[i][c])));
        let part = sum.checked_div(squares).unwrap_or(0);
        for i in 0..fan.star.len {
            left[i][c] = left[i][c].saturating_sub(signed(i).saturating_mul(part) >> FINE);
        }
    }
}

/// x += Ω Cᵀ λ, λ in 2^-48.
fn apply(solved: &mut Solved, omega: &Ring<i64>, lambda: &Ring<Wide3>) -> Option<()> {
    let Solved { fan, w, z, .. } = solved;
    let (first, rows) = fan.star.inner();
    for row in 0..rows {
        let (i, lambda) = (first + row, lambda[row]);
        let times = |factor: i64| {
            let [x, y, z] =
                lambda.map(|c| shift_half_up(c.saturating_mul(factor.into()).clamp(-(1 << 125), 1 << 125), 64));
            crate::num::narrow([x, y, z])
        };
        let before = fan.star.before(i);
        w[i] = plus(&w[i], &times(ONE + fan.kappa[i])?);
        w[before] = plus(&w[before], &times(ONE - fan.kappa[i])?);
        let free = (i128::from(fan.m[i] - ONE) * i128::from(omega[i])) >> FACTOR;
        z[i] = plus(&z[i], &times(free as i64)?);
    }
    // Below 2^61, as every vector is.
    let short =
        |vectors: &Ring<Triple>| (0..fan.star.len).all(|i| vectors[i].iter().all(|c| c.unsigned_abs() < 1 << 61));
    (short(w) && short(z)).then_some(())
}
