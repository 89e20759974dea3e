//! Vectors of [`Real`].

use crate::num::Real;
use core::ops::{Add, Mul, Neg, Sub};

/// A vector in space.
#[derive(Clone, Copy, Debug)]
pub(super) struct V3(pub(super) [Real; 3]);

impl V3 {
    pub(super) const ZERO: Self = Self([Real::ZERO; 3]);

    /// Integers in units of 2^`exponent`.
    #[inline(always)]
    pub(super) const fn bits([x, y, z]: [i64; 3], exponent: i32) -> Self {
        Self([Real::new(x, exponent), Real::new(y, exponent), Real::new(z, exponent)])
    }

    #[inline(always)]
    pub(super) fn dot(self, other: Self) -> Real {
        let ([a, b, c], [x, y, z]) = (self.0, other.0);
        a * x + b * y + c * z
    }

    #[inline(always)]
    pub(super) fn cross(self, other: Self) -> Self {
        let ([a, b, c], [x, y, z]) = (self.0, other.0);
        Self([b * z - c * y, c * x - a * z, a * y - b * x])
    }

    #[inline(always)]
    pub(super) fn square(self) -> Real {
        self.dot(self)
    }

    pub(super) fn norm(self) -> Real {
        self.square().sqrt()
    }

    /// The unit vector; zero for zero.
    pub(super) fn unit(self) -> Self {
        self * (Real::ONE / self.norm())
    }

    pub(super) fn is_zero(self) -> bool {
        self.0.iter().all(|c| c.is_zero())
    }

    /// Halfway to the end of `other`.
    pub(super) fn half(self) -> Self {
        Self(self.0.map(|c| c.shl(-1)))
    }

    /// Fixed-point components, half up.
    pub(super) fn fixed(self, fraction_bits: i32) -> [i64; 3] {
        self.0.map(|c| c.nearest(fraction_bits))
    }
}

impl Add for V3 {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        let ([a, b, c], [x, y, z]) = (self.0, other.0);
        Self([a + x, b + y, c + z])
    }
}

impl Sub for V3 {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        let ([a, b, c], [x, y, z]) = (self.0, other.0);
        Self([a - x, b - y, c - z])
    }
}

impl Neg for V3 {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        let [x, y, z] = self.0;
        Self([-x, -y, -z])
    }
}

impl Mul<Real> for V3 {
    type Output = Self;

    #[inline(always)]
    fn mul(self, factor: Real) -> Self {
        let [x, y, z] = self.0;
        Self([x * factor, y * factor, z * factor])
    }
}
