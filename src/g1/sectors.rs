//! Directions of tangents around a vertex, spread so that every sector is open (step 1 of the scheme).
//!
//! Angles are in 2^-64 turns.

use super::ring::Ring;
use crate::num::{Angle, arctangent, ratio};

/// 2^64 · `numerator` / `denominator` for a fraction of a turn below 1.
const fn turns(numerator: u64, denominator: u64) -> u64 {
    ((numerator as u128) << 64).div_euclid(denominator as u128) as u64
}

const FULL: u128 = 1 << 64;
/// 12°.
const NARROWEST: u64 = turns(12, 360);
/// 165°.
const WIDEST: u64 = turns(165, 360);
/// 10^-9 rad.
const CLOSED: u64 = turns(1, 6_283_185_307);

/// The directions of the edges of a fan, and the angles between the edges themselves, by which a folded fan opens.
pub(super) struct Directions<'a> {
    pub(super) directions: &'a Ring<u64>,
    /// The angles of the corners of the faces; asked for where the directions cannot be used.
    pub(super) corners: &'a dyn Fn(usize) -> u64,
    pub(super) len: usize,
    pub(super) closed: bool,
    /// Whether some direction is not known.
    pub(super) unknown: bool,
}

impl Directions<'_> {
    fn sectors(&self) -> usize {
        if self.closed { self.len } else { self.len.saturating_sub(1) }
    }

    fn sum(&self, angles: &Ring<u64>) -> u128 {
        (0..self.sectors()).map(|i| u128::from(angles[i])).sum()
    }

    /// New directions where the old ones leave a sector closed, too narrow or too wide; `None` where they are fine.
    pub(super) fn spread(&self) -> Option<Ring<u64>> {
        let n = self.sectors();
        if n < 2 {
            return None;
        }
        let mut angles = Ring::all(0);
        for i in 0..n {
            let next = if i + 1 < self.len { i + 1 } else { 0 };
            angles[i] = self.directions[next].wrapping_sub(self.directions[i]);
        }
        let sum = self.sum(&angles);
        let folded = if self.closed { sum != FULL } else { sum >= FULL };
        let mut changed = self.unknown || folded || (0..n).any(|i| angles[i] < CLOSED);
        if changed {
            for i in 0..n {
                angles[i] = (self.corners)(i);
            }
            let sum = self.sum(&angles).max(1);
            // A full turn, or at most 0.8 of one at a border.
            let most = if self.closed { FULL } else { FULL / 5 * 4 };
            if self.closed || sum > most {
                scale(&mut angles, n, most, sum);
            }
        }
        let mut total = if self.closed { FULL } else { self.sum(&angles) };
        let most = (FULL / 10 * 9).min(u128::from(WIDEST) * 9 * n as u128 / 10);
        if !self.closed && total > most {
            scale(&mut angles, n, most, total);
            (total, changed) = (most, true);
        }
        changed |= equalise(&mut angles, n, total);
        changed.then(|| self.turned(&angles))
    }

    /// The fan with these angles, turned to match the old directions best: by the angle of Σ exp(i·difference).
    fn turned(&self, angles: &Ring<u64>) -> Ring<u64> {
        let (mut directions, mut at) = (Ring::all(0_u64), 0_u64);
        let (mut sine, mut cosine) = (0, 0);
        for i in 0..self.len {
            directions[i] = at;
            let (sin, cos) = short(self.directions[i].wrapping_sub(at)).sin_cos();
            (sine, cosine) = (sine + sin.to_bits(), cosine + cos.to_bits());
            at = at.wrapping_add(angles[i]);
        }
        let turn = arctangent(sine, cosine);
        for i in 0..self.len {
            directions[i] = directions[i].wrapping_add(turn);
        }
        directions
    }
}

/// An angle rounded to 2^-32 turns.
pub(super) fn short(turns: u64) -> Angle {
    Angle::from_binary((turns.wrapping_add(1 << 31) >> 32) as u32)
}

/// Scales angles from a sum to another.
fn scale(angles: &mut Ring<u64>, n: usize, to: u128, from: u128) {
    for i in 0..n {
        let scaled = ratio((u128::from(angles[i]) >> 2) as i128, (from >> 2) as i128, 60).unwrap_or(0);
        angles[i] = ((scaled as u128 * (to >> 24)) >> 36) as u64;
    }
}

/// phi ← (1 − tau)·phi + tau·equal with the smallest tau that brings all into their bounds; whether that is above 0.
fn equalise(angles: &mut Ring<u64>, n: usize, total: u128) -> bool {
    let equal = total.checked_div(n as u128).unwrap_or(0) as i128;
    let low = i128::from(NARROWEST).min(equal * 3 / 5);
    let high = i128::from(WIDEST);
    // In 2^-32, rounded up.
    let mut tau = 0;
    for i in 0..n {
        let phi = i128::from(angles[i]);
        let (missing, room) = if phi < low { (low - phi, equal - phi) } else { (phi - high, phi - equal) };
        if missing > 0 {
            tau = tau.max(ratio(missing, room, 32).map_or(1 << 32, |part| part + 1));
        }
    }
    let tau = i128::from(tau.min(1 << 32));
    for i in 0..n {
        let phi = i128::from(angles[i]);
        angles[i] = (phi + (((equal - phi) * tau) >> 32)).clamp(0, i128::from(u64::MAX)) as u64;
    }
    tau > 0
}

#[cfg(test)]
mod tests {
    #![allow(clippy::disallowed_types, clippy::float_arithmetic)]
    use super::*;
    use std::vec::Vec;

    fn spread(degrees: &[u64], corners: &[u64], closed: bool) -> Option<Vec<f64>> {
        let (mut directions, mut angles) = (Ring::all(0), Ring::all(0));
        degrees.iter().enumerate().for_each(|(i, d)| directions[i] = turns(*d, 360));
        corners.iter().enumerate().for_each(|(i, d)| angles[i] = turns(*d, 360));
        let len = degrees.len();
        let new =
            Directions { directions: &directions, corners: &|i| angles[i], len, closed, unknown: false }.spread()?;
        let sectors = if closed { len } else { len - 1 };
        let angle = |i: usize| new[(i + 1) % len].wrapping_sub(new[i]) as f64 / 18_446_744_073_709_551_616.0 * 360.0;
        Some((0..sectors).map(angle).collect())
    }

    #[test]
    fn open_fans_stay() {
        assert_eq!(spread(&[0, 90, 180, 270], &[0; 4], true), None);
        assert_eq!(spread(&[0, 200], &[0; 1], false), None);
        assert_eq!(spread(&[10, 150, 290], &[0; 3], false), None);
    }

    #[test]
    fn narrow_and_wide_sectors_are_moved_just_far_enough() {
        let angles = spread(&[0, 2, 120, 240], &[0; 4], true).unwrap();
        assert!((angles[0] - 12.0).abs() < 1e-6, "{angles:?}");
        let angles = spread(&[0, 200, 280], &[0; 3], true).unwrap();
        assert!((angles[0] - 165.0).abs() < 1e-6, "{angles:?}");
        assert!((angles.iter().sum::<f64>() - 360.0).abs() < 1e-6);
    }

    #[test]
    fn folded_fans_follow_their_corners() {
        let angles = spread(&[0, 240, 120], &[100, 60, 80], true).unwrap();
        for (angle, expected) in angles.iter().zip([150.0, 90.0, 120.0]) {
            assert!((angle - expected).abs() < 1e-6, "{angles:?}");
        }
        let angles = spread(&[0, 350, 20], &[30, 40, 0], false).unwrap();
        assert!((angles[0] - 30.0).abs() < 1e-6 && (angles[1] - 40.0).abs() < 1e-6, "{angles:?}");
        let angles = spread(&[0, 170, 340], &[0; 3], false).unwrap();
        assert!((angles[0] - 148.5).abs() < 1e-6, "{angles:?}");
    }
}
