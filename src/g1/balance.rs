//! What a vertex sees of its neighbours, and whether its equations can be met (step 3 of the scheme).

use super::G1Error;
use super::fan::Fan;
use super::ring::Ring;
use super::setting::{FACTOR, ONE, Setting, fits};
use super::shift::Shift;
use crate::num::{Coord, Sum3, Triple, length, minus, narrow, ratio, root, shift_half_up};

/// |K| and |M| below this are rounding.
const TINY: u64 = 1 << (FACTOR - 28);
/// M/K stays below.
const LARGEST_RATIO: u64 = 1024;
/// Fraction bits of weights, gaps and capacities.
pub(super) const FINE: u32 = 40;

/// The other ends of a vertex's edges.
#[derive(Clone, Copy, Debug)]
pub(super) struct Far {
    /// The tangents of the same edges at their other ends.
    pub(super) e: Ring<Triple>,
    /// κ and m there.
    pub(super) kappa: Ring<i64>,
    pub(super) m: Ring<i64>,
    /// The tangents there of the edges to the next neighbour and to the one before.
    pub(super) to_next: Ring<Triple>,
    pub(super) to_previous: Ring<Triple>,
    /// The edges as vectors.
    pub(super) d: Ring<Triple>,
}

impl Far {
    /// A place for it, so that none is copied.
    pub(super) const fn blank() -> Self {
        let (none, zero) = (Ring::all([0; 3]), Ring::all(0));
        Self { e: none, kappa: zero, m: zero, to_next: none, to_previous: none, d: none }
    }
}

/// All vertices with what is known of their shifts.
#[derive(Clone, Copy, Debug)]
pub(super) struct View<'s, 'a, C> {
    pub(super) setting: &'s Setting<'a, C>,
    pub(super) shifts: &'s [Shift],
}

impl<C: Coord> View<'_, '_, C> {
    /// The tangents of a vertex, with its shift.
    pub(super) fn fan(&self, vertex: usize, fan: &mut Fan) -> Result<(), G1Error> {
        self.setting.fan(vertex, self.shifts.get(vertex).copied().unwrap_or_default(), fan)
    }

    /// What a vertex with these tangents sees of its neighbours.
    #[inline(never)]
    pub(super) fn far(&self, of: &Fan, far: &mut Far) -> Result<(), G1Error> {
        let mut fan = Fan::blank();
        for i in 0..of.star.len {
            self.fan(of.star.to[i].into(), &mut fan)?;
            let back = fan.star.place_of(of.vertex);
            far.e[i] = fan.e[back];
            far.kappa[i] = fan.kappa[back];
            far.m[i] = fan.m[back];
            far.to_next[i] = fan.e[fan.star.before(back)];
            far.to_previous[i] = fan.e[fan.star.after(back)];
            far.d[i] = minus(&fan.at, &of.at);
        }
        Ok(())
    }
}

/// K = κ + κ' and M = m + m' of an edge.
pub(super) fn differences(fan: &Fan, far: &Far, i: usize) -> (i64, i64) {
    (fan.kappa[i] + far.kappa[i], fan.m[i] + far.m[i])
}

/// How free the middle of an edge's boundary curve is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Freedom {
    /// K = M = 0: nothing is asked of the curve.
    Free,
    /// K is too small against M: the curve must be a quartic one.
    Frozen,
    /// The curve may be of degree 5.
    Normal,
}

pub(super) fn freedom(k: i64, m: i64) -> Freedom {
    let (k, m) = (k.unsigned_abs(), m.unsigned_abs());
    if k < TINY && m < TINY {
        Freedom::Free
    } else if k.saturating_mul(LARGEST_RATIO) <= m {
        Freedom::Frozen
    } else {
        Freedom::Normal
    }
}

/// The weight with which an edge's points may leave the quartic curve: K²/(K² + M²/4), or 1 or 0.
pub(super) fn weight(k: i64, m: i64) -> i64 {
    let square = |c: i64| i128::from(c) * i128::from(c);
    match freedom(k, m) {
        Freedom::Free => ONE,
        Freedom::Frozen => 0,
        Freedom::Normal => ratio(4 * square(k), 4 * square(k) + square(m), FACTOR).unwrap_or(0),
    }
}

/// Where a point c2 should lie, from c0: on the cubic curve, degree-elevated; e + e'/2 + 0.3·d.
pub(super) fn curve_target(e: &Triple, far_e: &Triple, d: &Triple) -> Option<Triple> {
    Sum3::default().plus(e, 10).plus(far_e, 5).plus(d, 3).divide(10)
}

/// 4·d of the vertex equation (V) of edge i, in 2^-48 working units: (4 + 4m + M)·e + K·(e⁺ − e⁻).
pub(super) fn right_side(fan: &Fan, far: &Far, i: usize) -> Sum3 {
    let (k, m) = differences(fan, far, i);
    let beside = minus(&fan.e[fan.star.after(i)], &fan.e[fan.star.before(i)]);
    Sum3::default().plus(&fan.e[i], 4 * ONE + 4 * fan.m[i] + m).plus(&beside, k)
}

/// Weights (1/A⁻ + 1/A)/2 of the rows in the combination without twists (W), scaled by the smallest area; in 2^-40.
pub(super) fn row_weights(fan: &Fan) -> Ring<i64> {
    let (mut inverse, mut weights) = (Ring::all(0), Ring::all(0));
    let least = (0..fan.star.len).map(|i| fan.area(i)).min().unwrap_or(1);
    for i in 0..fan.star.len {
        inverse[i] = ratio(least, fan.area(i), FINE).unwrap_or(0);
    }
    for i in 0..fan.star.len {
        weights[i] = i64::midpoint(inverse[i], inverse[fan.star.before(i)]);
    }
    weights
}

/// Whether the equations of a vertex of even valence can be met, in 2^-40.
#[derive(Clone, Copy, Debug)]
pub(super) struct Balance {
    /// What of (W) is left at the targets, relative to the tangents.
    gap: i64,
    /// How much the points of the edges can do about it.
    capacity: i64,
}

impl Balance {
    #[inline(never)]
    pub(super) fn of(fan: &Fan, far: &Far) -> Result<Self, G1Error> {
        let weights = row_weights(fan);
        let (mut left, mut squares, mut capacity) = (Sum3::default(), 0_u128, 0_u128);
        for i in 0..fan.star.len {
            let target = fits(curve_target(&fan.e[i], &far.e[i], &far.d[i]), fan.vertex)?;
            let row = right_side(fan, far, i).plus(&target, 4 * (ONE - fan.m[i]));
            let row = fits(row.narrow(FACTOR + 2), fan.vertex)?;
            left.add(&row, if i.is_multiple_of(2) { weights[i] } else { -weights[i] });
            let (k, m) = differences(fan, far, i);
            squares += u128::from(weights[i].unsigned_abs()).pow(2);
            let part = (u128::from(weights[i].unsigned_abs()) * u128::from((ONE - fan.m[i]).unsigned_abs())) >> FACTOR;
            capacity += (((part * part) >> FINE) * u128::from(weight(k, m).unsigned_abs())) >> FACTOR;
        }
        let left = length(&fits(narrow(left.0.map(|c| shift_half_up(c, FINE))), fan.vertex)?);
        let size = (i128::from(fan.size) * i128::from(root(squares))) >> FINE;
        let gap = ratio(left.into(), size, FINE).unwrap_or(1 << 50).min(1 << 50);
        let capacity = ratio(capacity as i128, (squares >> FINE) as i128, FINE).unwrap_or(1 << 50).min(1 << 62);
        Ok(Self { gap, capacity })
    }

    /// Whether the targets meet the equations to a tolerance in 2^-32.
    pub(super) fn is_met(&self, tolerance: i64) -> bool {
        self.gap >> (FINE - 32) <= tolerance
    }

    /// Whether the points of the edges can hardly do anything: a capacity below 1/1000.
    pub(super) fn is_weak(&self) -> bool {
        self.capacity < (1 << FINE) / 1000
    }

    /// Whether the points would move too far: J = gap²/capacity above 1/5.
    pub(super) fn is_strained(&self, tolerance: i64) -> bool {
        let (square, capacity) = self.parts();
        !self.is_met(tolerance) && 5 * square > capacity
    }

    /// J/(1 + J), in 2^-24.
    pub(super) fn strain(&self, tolerance: i64) -> i64 {
        let (square, capacity) = self.parts();
        if self.is_met(tolerance) { 0 } else { ratio(square, square + capacity, 24).unwrap_or(1 << 24) }
    }

    /// gap² and the capacity, in 2^-80.
    fn parts(&self) -> (i128, i128) {
        (i128::from(self.gap) * i128::from(self.gap), i128::from(self.capacity) << FINE)
    }
}
