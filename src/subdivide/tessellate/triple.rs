//! Three coordinates in 2^-16 at once.

use crate::geometry::Point3;
use crate::num::Coord;
use core::ops::{Add, Mul, Sub};

/// Raw bits along x, y, z, or a combination of such.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Triple {
    x: i64,
    y: i64,
    z: i64,
}

impl Triple {
    pub(super) fn of(p: Point3) -> Self {
        Self { x: p.x.bits(), y: p.y.bits(), z: p.z.bits() }
    }

    pub(super) fn to_array(self) -> [i64; 3] {
        [self.x, self.y, self.z]
    }

    fn zip(self, other: Self, f: impl Fn(i64, i64) -> i64) -> Self {
        Self { x: f(self.x, other.x), y: f(self.y, other.y), z: f(self.z, other.z) }
    }

    /// The smaller one along each axis.
    pub(super) fn min(self, other: Self) -> Self {
        self.zip(other, i64::min)
    }

    /// The larger one along each axis.
    pub(super) fn max(self, other: Self) -> Self {
        self.zip(other, i64::max)
    }

    pub(super) fn abs(self) -> Self {
        self.max(self * -1)
    }

    /// Over 2^shift, rounded up.
    pub(super) fn halved(self, shift: u32) -> Self {
        self.zip(self, |c, _| (c + (1 << shift) - 1) >> shift)
    }

    /// The largest of the three.
    pub(super) fn largest(self) -> i64 {
        self.x.max(self.y).max(self.z)
    }

    /// Whether two directions, each below 2^62, are parallel or one is none.
    pub(super) fn is_parallel(self, other: Self) -> bool {
        let minor = |a: i64, b: i64, c: i64, d: i64| i128::from(a) * i128::from(d) - i128::from(b) * i128::from(c);
        let (p, q) = (self, other);
        minor(p.x, p.y, q.x, q.y) == 0 && minor(p.y, p.z, q.y, q.z) == 0 && minor(p.x, p.z, q.x, q.z) == 0
    }
}

impl Add for Triple {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        self.zip(other, |a, b| a + b)
    }
}

impl Sub for Triple {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self.zip(other, |a, b| a - b)
    }
}

impl Mul<i64> for Triple {
    type Output = Self;

    fn mul(self, factor: i64) -> Self {
        Self { x: self.x * factor, y: self.y * factor, z: self.z * factor }
    }
}
