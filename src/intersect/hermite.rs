//! Pieces of curves: cubic Hermite curves through two spots with their unit tangents.
//!
//! The handles are a third of the arc, arc ≈ chord (1 + θ²/24) with θ the angle between the tangents.

use super::newton::{Spot, difference};
use super::vector::V3;
use crate::num::Real;

/// A cubic from the origin to `chord` with derivatives `first` and `last` at its ends.
#[derive(Clone, Copy, Debug)]
pub(super) struct Piece {
    origin: [i64; 3],
    chord: V3,
    first: V3,
    last: V3,
    length: Real,
    turn: Real,
}

const HALF: Real = Real::power(-1);

impl Piece {
    pub(super) fn new(p: &Spot, q: &Spot) -> Self {
        Self::through(p.point, p.tangent, q.point, q.tangent)
    }

    #[cfg_attr(target_pointer_width = "32", inline(never))]
    pub(super) fn through(p: [i64; 3], start: V3, q: [i64; 3], end: V3) -> Self {
        let chord = difference(q, p);
        let square = (end - start).square();
        let length = chord.norm();
        let arc = length + length * square * Real::new(0x0aaa_aaaa_aaaa_aaab, -64);
        Self { origin: p, chord, first: start * arc, last: end * arc, length: arc, turn: square.sqrt() }
    }

    /// The arc of the estimate.
    pub(super) fn arc(&self) -> Real {
        self.length
    }

    /// The point at a parameter, from the start of the piece, and the derivative.
    #[cfg_attr(target_pointer_width = "32", inline(never))]
    fn eval(&self, s: Real) -> (V3, V3) {
        let r = Real::ONE - s;
        let sr = s * r;
        // The cubic Hermite basis: s²(3 − 2s), s r², −s² r; its derivatives 6sr, r(1 − 3s), s(3s − 2).
        let rise = s * s * (Real::int(3) - s.shl(1));
        let point = self.chord * rise + self.first * (sr * r) - self.last * (sr * s);
        let three = s * Real::int(3);
        let slope = self.chord * (sr * Real::int(6))
            + self.first * (r * (Real::ONE - three))
            + self.last * (s * (three - Real::int(2)));
        (point, slope)
    }

    /// The point at the middle.
    pub(super) fn middle(&self) -> V3 {
        self.chord.half() + (self.first - self.last) * Real::power(-3)
    }

    /// The distance of a point from the piece; `None` for points beside it beyond a sixteenth past its ends.
    #[cfg_attr(target_pointer_width = "32", inline(never))]
    pub(super) fn distance(&self, point: [i64; 3]) -> Option<Real> {
        let x = difference(point, self.origin);
        let mut s = x.dot(self.chord) / self.chord.square();
        let slack = Real::power(-4);
        for _ in 0..2 {
            if s < -slack || s > Real::ONE + slack {
                return None;
            }
            let (h, slope) = self.eval(s);
            s = s + (x - h).dot(slope) / slope.square();
        }
        let (h, slope) = self.eval(s);
        let d = x - h;
        let along = d.dot(slope);
        Some((d.square() - along.square() / slope.square()).max(Real::ZERO).sqrt())
    }

    /// The error of the piece, given a point of the curve near its middle: the distance of that point, and what it
    /// matters whether handles are a third of the arc or of the chord, whichever is larger. Falls by 16 when halved.
    pub(super) fn error(&self, middle: [i64; 3]) -> Real {
        let handles = self.length * self.turn.square() * self.turn * Real::new(0x0155_5555_5555_5555, -64);
        let far = self.length;
        self.distance(middle).map_or(far, |d| d.max(handles))
    }

    /// The arc length: Gauss's rule of three points on both halves.
    pub(super) fn arc_length(&self) -> Real {
        // (5 ± √15)/10 of a half, the weights 5/18, 8/18, 5/18.
        let offset = Real::new(0x18c9_7ef4_3f72_47c1, -63);
        let mut sum = Real::ZERO;
        for centre in [Real::power(-2), Real::int(3).shl(-2)] {
            let speed = |s| self.eval(s).1.norm();
            sum = sum + (speed(centre - offset) + speed(centre + offset)) * Real::int(5) + speed(centre) * Real::int(8);
        }
        sum * HALF / Real::int(18)
    }
}
