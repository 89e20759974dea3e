//! Jiang Shoushan's construction taken literally (ν = 1), to compare with.
//!
//! Twist points are the means of their neighbours, b113 = (b014 + b104)/2; c2 and c3 follow from (3-3), whose second line
//! is made explicit with the divisor 4(1 + λ₁ + μ₁); the points beside the middle from (3-6). With ν = 1 the condition is
//! D* + μE + λD = 0, at a vertex λ = A⁻/A and μ = −det(t⁻, t⁺)/A.

use super::G1Error;
use super::edge::{Edge, End};
use super::setting::{FACTOR, ONE, combine, fits};
use crate::num::{Sum3, Triple, length, minus, ratio};

/// Divisors below this are 0: 2^-28.
const TINY: u64 = 1 << (FACTOR - 28);

/// λ and μ at both ends, and 1 + λ + μ at the second one.
struct Ratios {
    lambda: [i64; 2],
    mu: [i64; 2],
    far_divisor: i64,
}

impl Ratios {
    fn of(from: &End, to: &End) -> Option<Self> {
        let ([right, left, across], [far_right, far_left, far_across]) = (from.areas, to.areas);
        // From the second end the sectors change sides.
        let (lambda0, lambda1) = (ratio(right, left, FACTOR)?, ratio(far_left, far_right, FACTOR)?);
        let far_divisor = ratio(far_across, far_right, FACTOR)?;
        let mu = [ratio(-across, left, FACTOR)?, far_divisor.checked_sub(ONE.checked_add(lambda1)?)?];
        let small = |c: &i64| c.unsigned_abs() < 1 << (FACTOR + 11);
        let all = [lambda0, lambda1, mu[0], mu[1], far_divisor];
        all.iter().all(small).then_some(Self { lambda: [lambda0, lambda1], mu, far_divisor })
    }
}

/// A sum over a factor of either sign, which has 2^-48 as the sum has.
fn over(sum: Sum3, divisor: i64) -> Option<Triple> {
    if divisor < 0 { Sum3(sum.0.map(i128::saturating_neg)).divide(divisor.checked_neg()?) } else { sum.divide(divisor) }
}

/// Fills in c2, c3, l2 and r2.
pub(super) fn fill(edge: &mut Edge, from: &End, to: &End) -> Result<(), G1Error> {
    let vertex = from.vertex;
    let names = [from.vertex as u16, to.vertex as u16];
    let ratios = fits(Ratios::of(from, to), vertex)?;
    let ([lambda0, lambda1], [mu0, mu1]) = (ratios.lambda, ratios.mu);
    if mu0.unsigned_abs() < TINY {
        return Err(G1Error::OppositeTangents { edge: names });
    }
    if ratios.far_divisor.unsigned_abs() < TINY {
        return Err(G1Error::OppositeTangents { edge: [names[1], names[0]] });
    }
    let slope = lambda1.wrapping_sub(lambda0);
    if slope.unsigned_abs() < TINY {
        return Err(G1Error::EqualRatios { edge: names });
    }
    fits(ends(edge, &ratios), vertex)?;
    let middle = |edge: &Edge| -> Option<[Triple; 2]> {
        let near = side(edge, 1, (lambda1, mu1)).0;
        let far = side(edge, 3, (lambda0, mu0)).0;
        let e2 = minus(&edge.c[3], &edge.c[2]);
        // 6·(λ₁ − λ₀)·D2 = 4·(near − far) − 6·(μ₁ − μ₀)·E2
        let part = |near: i128, far: i128| near.saturating_sub(far).saturating_mul(4);
        let mut sum = Sum3([part(near[0], far[0]), part(near[1], far[1]), part(near[2], far[2])]);
        sum.add(&e2, 6 * mu0.wrapping_sub(mu1));
        let d2 = over(Sum3(sum.0.map(|c| c / 6)), slope)?;
        // D*2 = −μ₀·E2 − λ₀·D2 − (2/3)·near
        let rest = Sum3(near.map(|c| c.saturating_mul(-2) / 3)).plus(&e2, -mu0).plus(&d2, -lambda0);
        Some([d2, rest.narrow(FACTOR)?])
    };
    let [d2, star] = fits(middle(edge), vertex)?;
    edge.l[2] = crate::num::plus(&edge.c[2], &d2);
    edge.r[2] = crate::num::plus(&edge.c[2], &star);
    let span = length(&minus(&edge.c[5], &edge.c[0])).max(1);
    edge.correction = ratio(length(&d2).into(), span.into(), 32).unwrap_or(i64::MAX);
    Ok(())
}

/// D*_i + μ·E_i + λ·D_i, in 2^-80.
fn side(edge: &Edge, i: usize, (lambda, mu): (i64, i64)) -> Sum3 {
    let i = i % 5;
    let c = &edge.c[i];
    Sum3::default()
        .plus(&minus(&edge.r[i], c), ONE)
        .plus(&minus(&edge.c[i + 1], c), mu)
        .plus(&minus(&edge.l[i], c), lambda)
}

/// c2 and c3 from (3-3).
fn ends(edge: &mut Edge, ratios: &Ratios) -> Option<()> {
    let ([lambda0, lambda1], [mu0, mu1]) = (ratios.lambda, ratios.mu);
    let quarter = |sum: Sum3| sum.narrow(FACTOR + 2);
    // −μ₀·(c2 − c1) = D*1 + λ₀·D1 + (D*0 + μ₁·E0 + λ₁·D0)/4
    let c1 = edge.c[1];
    let rest = quarter(side(edge, 0, (lambda1, mu1)))?;
    let sum =
        Sum3::default().plus(&minus(&edge.r[1], &c1), -ONE).plus(&minus(&edge.l[1], &c1), -lambda0).plus(&rest, -ONE);
    let c2 = crate::num::plus(&c1, &over(sum, mu0)?);
    // (1 + λ₁ + μ₁)·c3 = r3 + λ₁·l3 + μ₁·c4 + (D*4 + μ₀·E4 + λ₀·D4)/4, from c4 as origin.
    let c4 = edge.c[4];
    let rest = quarter(side(edge, 4, (lambda0, mu0)))?;
    let sum =
        Sum3::default().plus(&minus(&edge.r[3], &c4), ONE).plus(&minus(&edge.l[3], &c4), lambda1).plus(&rest, ONE);
    let c3 = crate::num::plus(&c4, &over(sum, ratios.far_divisor)?);
    let short = |p: &Triple| p.iter().all(|c| c.unsigned_abs() < 1 << 60);
    (short(&c2) && short(&c3)).then(|| (edge.c[2], edge.c[3]) = (c2, c3))
}

/// The twist point between two tangents, from their vertex.
pub(super) fn twist(first: &Triple, second: &Triple) -> Option<Triple> {
    combine(&[(first, ONE / 2), (second, ONE / 2)])
}
