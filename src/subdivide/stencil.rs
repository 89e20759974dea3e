//! First and second differences of nets: which control points they are made of, and the largest of them.

use crate::geometry::Point3;
use crate::num::{Coord, I16F16, sqrt_up};
use crate::patch::{CurveNet, SurfaceNet, triangle_index};

/// The domain of a net.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Shape {
    Curve,
    Triangle,
    Tensor,
}

/// A net as the bounds see it; a curve has the degrees (n, 0).
#[derive(Clone, Copy, Debug)]
pub(super) struct Net<'a> {
    pub(super) shape: Shape,
    pub(super) degrees: (usize, usize),
    pub(super) points: &'a [Point3],
    pub(super) weights: Option<&'a [I16F16]>,
}

/// A direction of differences.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Along {
    /// The first parameter.
    R,
    /// The second parameter.
    S,
    /// From one corner of a triangle to another, corners counted 0, 1, 2.
    Edge(usize, usize),
}

/// The three edge directions of a triangle: T1T2, T2T3, T3T1.
pub(super) const EDGES: [Along; 3] = [Along::Edge(0, 1), Along::Edge(1, 2), Along::Edge(2, 0)];

impl<'a> Net<'a> {
    pub(super) fn of(net: &SurfaceNet<'a>) -> Self {
        let shape = if net.is_triangle() { Shape::Triangle } else { Shape::Tensor };
        Self { shape, degrees: net.degrees(), points: net.points(), weights: net.weights() }
    }

    pub(super) fn of_curve(net: &CurveNet<'a>, weights: Option<&'a [I16F16]>) -> Self {
        Self { shape: Shape::Curve, degrees: (net.degree(), 0), points: net.points(), weights }
    }

    /// The coordinates of a point in 2^-16 units.
    pub(super) fn bits(&self, index: usize) -> [i64; 3] {
        self.points.get(index).map_or([0; 3], |p| p.to_array().map(Coord::bits))
    }

    /// The least and the largest coordinates, in 2^-16 units.
    pub(super) fn extremes(&self) -> [[i64; 3]; 2] {
        let (mut low, mut high) = ([i64::MAX; 3], [i64::MIN; 3]);
        for p in self.points {
            let p = p.to_array().map(Coord::bits);
            low = zip(low, p, i64::min);
            high = zip(high, p, i64::max);
        }
        [low, high]
    }

    /// The diagonal of the box, in 2^-16 units, rounded up. Below 2^33.
    #[inline(never)]
    pub(super) fn diagonal(&self) -> u128 {
        let [low, high] = self.extremes();
        sqrt_up(square(zip(high, low, i64::saturating_sub)))
    }

    /// Visits the pairs (from, to) of all first differences in a direction.
    pub(super) fn first(&self, along: Along, visit: &mut dyn FnMut([usize; 2])) {
        if let Along::Edge(from, to) = along {
            for_triangle(self.degrees.0, 1, |at| visit([at([Some(from), None]), at([Some(to), None])]));
        } else {
            let (step, used) = self.step(along);
            self.for_tensor(used, |base| visit([base, base + step]));
        }
    }

    /// Visits [a, b, c, d] of all second differences a − b − c + d in two directions.
    pub(super) fn second(&self, one: Along, two: Along, visit: &mut dyn FnMut([usize; 4])) {
        if let (Along::Edge(from, to), Along::Edge(from2, to2)) = (one, two) {
            for_triangle(self.degrees.0, 2, |at| {
                let at = |p: usize, q: usize| at([Some(p), Some(q)]);
                visit([at(from, from2), at(from, to2), at(to, from2), at(to, to2)]);
            });
        } else {
            let ((step, used), (step2, used2)) = (self.step(one), self.step(two));
            let used = (used.0 + used2.0, used.1 + used2.1);
            self.for_tensor(used, |base| visit([base, base + step, base + step2, base + step + step2]));
        }
    }

    /// The distance of neighbours in storage, and how many steps are taken in either direction.
    fn step(&self, along: Along) -> (usize, (usize, usize)) {
        if along == Along::R { (self.degrees.1 + 1, (1, 0)) } else { (1, (0, 1)) }
    }

    /// Visits all points that are not among the last `used` in either direction.
    fn for_tensor(&self, used: (usize, usize), mut visit: impl FnMut(usize)) {
        let (m, h) = self.degrees;
        for i in used.0..=m {
            for j in used.1..=h {
                visit((i - used.0) * (h + 1) + j - used.1);
            }
        }
    }

    /// The largest squared length of the first differences in a direction, in 2^-32. Below 2^68.
    pub(super) fn longest_first(&self, along: Along) -> u128 {
        let mut longest = 0;
        self.first(along, &mut |[a, b]| {
            longest = square(zip(self.bits(b), self.bits(a), |b, a| b - a)).max(longest);
        });
        longest
    }

    /// The largest squared length of the second differences in two directions, in 2^-32. Below 2^70.
    pub(super) fn longest_second(&self, one: Along, two: Along) -> u128 {
        let mut longest = 0;
        self.second(one, two, &mut |indices| {
            let [a, b, c, d] = indices.map(|index| self.bits(index));
            let (outer, inner) = (zip(a, d, |a, d| a + d), zip(b, c, |b, c| b + c));
            longest = square(zip(outer, inner, |o, i| o - i)).max(longest);
        });
        longest
    }
}

/// Visits all (i, j, k) with the sum degree − missing, handing over where the point stands that is one step further
/// towards each corner named.
fn for_triangle(degree: usize, missing: usize, mut visit: impl FnMut(&dyn Fn([Option<usize>; 2]) -> usize)) {
    for rest in missing..=degree {
        for k in 0..=rest - missing {
            let j = rest - missing - k;
            visit(&|corners| {
                let towards = |corner| corners.iter().filter(|c| **c == Some(corner)).count();
                triangle_index(j + towards(1), k + towards(2))
            });
        }
    }
}

/// A function of the components of two vectors. No indices, which opt-level "s" would check.
pub(super) fn zip<A, B, T>([x, y, z]: [A; 3], [p, q, r]: [B; 3], f: impl Fn(A, B) -> T) -> [T; 3] {
    [f(x, p), f(y, q), f(z, r)]
}

/// The squared length.
fn square(v: [i64; 3]) -> u128 {
    v.into_iter().map(|c| u128::from(c.unsigned_abs()) * u128::from(c.unsigned_abs())).sum()
}
