//! Bounds on the second derivatives of patches.
//!
//! Polynomial: |S_rr| ≤ m(m−1)·max|Δ²_rr b|, |S_rs| ≤ mh·max|Δ²_rs b|, |S_ss| ≤ h(h−1)·max|Δ²_ss b|.
//!
//! Rational, S = A/D with the centre c of the box as origin, |S − c| ≤ R: from (S − c)·D = A twice differentiated,
//! S_xy·D = A_xy − S_x·D_y − S_y·D_x − (S − c)·D_xy, and S_x·D = A_x − (S − c)·D_x. With D ≥ the least weight and the
//! largest differences of the homogeneous nets that is a bound; for equal weights it is the polynomial one.

use super::stencil::{Along, Net, zip};
use crate::num::{Coord, div_up, shift_up, sqrt_up};

/// Bounds on |S_rr|, |S_rs| and |S_ss|, in 2^-16 units, rounded up.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Curvature {
    pub(super) rr: u128,
    pub(super) rs: u128,
    pub(super) ss: u128,
}

impl Curvature {
    /// Of a patch whose two parameters run along these directions.
    #[inline(never)]
    pub(super) fn of(net: &Net<'_>, [r, s]: [Along; 2]) -> Self {
        if net.weights.is_some() {
            let net = Homogeneous::of(net);
            Self { rr: net.bound(r, r), rs: net.bound(r, s), ss: net.bound(s, s) }
        } else {
            Self { rr: polynomial(net, r, r), rs: polynomial(net, r, s), ss: polynomial(net, s, s) }
        }
    }

    /// (M_rr + 2 M_rs + M_ss) / 8, rounded up: how far the surface may be from the linear interpolant of a right
    /// triangle of unit legs (Filip, Magedson, Markot 1986).
    pub(super) fn spread(&self) -> u128 {
        self.rr.saturating_add(self.rs.saturating_mul(2)).saturating_add(self.ss).div_ceil(8)
    }
}

/// The degree in a direction.
fn degree(net: &Net<'_>, along: Along) -> u128 {
    (if along == Along::S { net.degrees.1 } else { net.degrees.0 }) as u128
}

/// What a second difference is multiplied with in a second derivative. Both directions of a triangle lower one degree.
fn factor(net: &Net<'_>, one: Along, two: Along) -> u128 {
    let (m, h) = (degree(net, one), degree(net, two));
    if matches!((one, two), (Along::R, Along::S)) { m * h } else { m * m.saturating_sub(1) }
}

#[inline(never)]
fn polynomial(net: &Net<'_>, one: Along, two: Along) -> u128 {
    let factor = factor(net, one, two);
    // Below 2^(70 + 12).
    sqrt_up(factor * factor * net.longest_second(one, two))
}

/// The nets of A and D of a rational patch. Coordinates are doubled, so that the centre of the box is an integer.
struct Homogeneous<'n, 'a> {
    net: &'n Net<'a>,
    /// Twice the centre, in 2^-16.
    centre: [i64; 3],
    /// R, doubled. Below 2^33.
    radius: u128,
    /// Positive.
    least_weight: u128,
}

/// The largest differences of the components of A, as one length, and of D.
#[derive(Clone, Copy)]
struct Largest {
    a: u128,
    d: u128,
}

impl<'n, 'a> Homogeneous<'n, 'a> {
    fn of(net: &'n Net<'a>) -> Self {
        let [low, high] = net.extremes();
        let least = net.weights.into_iter().flatten().map(|w| w.bits()).min().unwrap_or(1).max(1);
        Self {
            net,
            centre: zip(low, high, i64::saturating_add),
            radius: net.diagonal(),
            least_weight: least.unsigned_abs().into(),
        }
    }

    /// The vector A and the weight D at a control point. Below 2^63 and 2^31.
    fn at(&self, index: usize) -> ([i128; 3], i128) {
        let weight = self.net.weights.and_then(|w| w.get(index)).map_or(1, |w| w.bits().into());
        (zip(self.net.bits(index), self.centre, |p, centre| weight * i128::from(2 * p - centre)), weight)
    }

    fn first(&self, along: Along) -> Largest {
        let mut largest = ([0; 3], 0);
        self.net.first(along, &mut |[a, b]| {
            let (a, b) = (self.at(a), self.at(b));
            raise(&mut largest, zip(a.0, b.0, |a, b| a - b), a.1 - b.1);
        });
        Largest { a: length(largest.0), d: largest.1 }
    }

    fn second(&self, one: Along, two: Along) -> Largest {
        let mut largest = ([0; 3], 0);
        self.net.second(one, two, &mut |indices| {
            let [a, b, c, d] = indices.map(|index| self.at(index));
            let (outer, inner) = (zip(a.0, d.0, |a, d| a + d), zip(b.0, c.0, |b, c| b + c));
            raise(&mut largest, zip(outer, inner, |o, i| o - i), a.1 + d.1 - b.1 - c.1);
        });
        Largest { a: length(largest.0), d: largest.1 }
    }

    /// The bound on the second derivative in two directions, in 2^-16 units.
    ///
    /// First differences of A are below 2^65 as lengths, of D below 2^31; slopes below 2^70; each of the four terms
    /// below 2^107.
    #[inline(never)]
    fn bound(&self, one: Along, two: Along) -> u128 {
        let (w, second, factor) = (self.least_weight, self.second(one, two), factor(self.net, one, two));
        let (by_one, by_two) = (self.first(one), self.first(two));
        let (m, h) = (degree(self.net, one), degree(self.net, two));
        // |S_x| times the least weight.
        let slope = |degree: u128, by: Largest| degree * (by.a + self.radius * by.d);
        let sum = factor * (second.a + self.radius * second.d) * w
            + slope(m, by_one) * h * by_two.d
            + slope(h, by_two) * m * by_one.d;
        div_up(sum, 2 * w * w)
    }
}

/// Raises the components to those of a difference.
fn raise(largest: &mut ([u128; 3], u128), a: [i128; 3], d: i128) {
    largest.0 = zip(largest.0, a, |largest, a| a.unsigned_abs().max(largest));
    largest.1 = largest.1.max(d.unsigned_abs());
}

/// The length of a vector, rounded up; at most by 2^-60 of it where components have more than 62 bits.
#[inline(never)]
fn length(v: [u128; 3]) -> u128 {
    let longest = v.into_iter().max().unwrap_or(0);
    let shift = (128 - longest.leading_zeros()).saturating_sub(62);
    sqrt_up(v.into_iter().map(|c| shift_up(c, shift)).map(|c| c * c).sum()) << shift
}
