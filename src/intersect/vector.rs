//! Vectors of [`Real`].
//!
//! What consists of several operations is a call on targets of 32 bits, by reference: copies of vectors would fill the stack.

use crate::num::Real;
use core::ops::{Add, Mul, Neg, Sub};

/// A vector in space.
#[derive(Clone, Copy, Debug)]
pub(super) struct V3(pub(super) [Real; 3]);

#[cfg_attr(target_pointer_width = "32", inline(never))]
#[cfg_attr(not(target_pointer_width = "32"), inline(always))]
fn dot([a, b, c]: &[Real; 3], [x, y, z]: &[Real; 3]) -> Real {
    *a * *x + *b * *y + *c * *z
}

#[cfg_attr(target_pointer_width = "32", inline(never))]
#[cfg_attr(not(target_pointer_width = "32"), inline(always))]
fn cross([a, b, c]: &[Real; 3], [x, y, z]: &[Real; 3]) -> V3 {
    V3([*b * *z - *c * *y, *c * *x - *a * *z, *a * *y - *b * *x])
}

#[cfg_attr(target_pointer_width = "32", inline(never))]
#[cfg_attr(not(target_pointer_width = "32"), inline(always))]
fn sum([a, b, c]: &[Real; 3], [x, y, z]: &[Real; 3]) -> V3 {
    V3([*a + *x, *b + *y, *c + *z])
}

#[cfg_attr(target_pointer_width = "32", inline(never))]
#[cfg_attr(not(target_pointer_width = "32"), inline(always))]
fn minus([a, b, c]: &[Real; 3], [x, y, z]: &[Real; 3]) -> V3 {
    V3([*a - *x, *b - *y, *c - *z])
}

#[cfg_attr(target_pointer_width = "32", inline(never))]
#[cfg_attr(not(target_pointer_width = "32"), inline(always))]
fn times([x, y, z]: &[Real; 3], factor: Real) -> V3 {
    V3([*x * factor, *y * factor, *z * factor])
}

impl V3 {
    pub(super) const ZERO: Self = Self([Real::ZERO; 3]);

    /// Integers in units of 2^`exponent`.
    #[cfg_attr(target_pointer_width = "32", inline(never))]
    #[cfg_attr(not(target_pointer_width = "32"), inline(always))]
    pub(super) const fn bits([x, y, z]: [i64; 3], exponent: i32) -> Self {
        Self([Real::new(x, exponent), Real::new(y, exponent), Real::new(z, exponent)])
    }

    #[inline(always)]
    pub(super) fn dot(self, other: Self) -> Real {
        dot(&self.0, &other.0)
    }

    #[inline(always)]
    pub(super) fn cross(self, other: Self) -> Self {
        cross(&self.0, &other.0)
    }

    #[inline(always)]
    pub(super) fn square(self) -> Real {
        dot(&self.0, &self.0)
    }

    #[cfg_attr(target_pointer_width = "32", inline(never))]
    pub(super) fn norm(self) -> Real {
        self.square().sqrt()
    }

    /// The unit vector; zero for zero.
    #[cfg_attr(target_pointer_width = "32", inline(never))]
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
    #[cfg_attr(target_pointer_width = "32", inline(never))]
    pub(super) fn fixed(self, fraction_bits: i32) -> [i64; 3] {
        self.0.map(|c| c.nearest(fraction_bits))
    }
}

impl Add for V3 {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        sum(&self.0, &other.0)
    }
}

impl Sub for V3 {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        minus(&self.0, &other.0)
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
        times(&self.0, factor)
    }
}
