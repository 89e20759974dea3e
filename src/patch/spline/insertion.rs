//! Knot insertion until a span carries a Bézier net, by blossoms: exact, one rounding at the end.
//!
//! Over a span \[a, b\] with the knots … ≤ L_2 ≤ L_1 = a < b = R_1 ≤ R_2 ≤ … around it, the control points of degree
//! p that matter are the blossom values d_i = f(L_1 … L_(p−i), R_1 … R_i), and Bézier point k is f(a, … b, …) with
//! p − k times a and k times b (Ramshaw, *Blossoming*, 1987). Putting u in place of the outermost knots λ < ρ in
//! which two neighbours differ is Boehm's knot insertion (1980):
//!
//! f(u, …) = ((ρ − u) f(λ, …) + (u − λ) f(ρ, …)) / (ρ − λ).
//!
//! All factors are natural numbers. A level of insertions is taken over the product of its denominators, so values
//! stay natural; the product of all levels divides once, at the end.

use super::natural::Natural;
use crate::geometry::Point3;
use crate::num::I16F16;
use crate::patch::MAX_DEGREE;

/// The knots around a span, as distances from its start a in units of their greatest common divisor.
pub(super) struct Window {
    /// The degree.
    degree: usize,
    /// a − L_1 = 0, a − L_2 …, one for each degree.
    left: [u32; MAX_DEGREE],
    /// R_1 − a, R_2 − a …
    right: [u32; MAX_DEGREE],
}

fn common_divisor(mut a: u32, mut b: u32) -> u32 {
    while let Some(rest) = a.checked_rem(b) {
        (a, b) = (b, rest);
    }
    a
}

impl Window {
    /// From the knots at and before a, and at and after b > a. Differences of 32-bit knots fit 32 unsigned bits.
    pub(super) fn new(degree: usize, before: impl Fn(usize) -> i32, after: impl Fn(usize) -> i32) -> Self {
        let (mut left, mut right) = ([0; MAX_DEGREE], [0; MAX_DEGREE]);
        let start = before(0);
        let mut divisor = 0;
        for (i, (left, right)) in left.iter_mut().zip(&mut right).enumerate().take(degree) {
            *left = start.wrapping_sub(before(i)) as u32;
            *right = after(i).wrapping_sub(start) as u32;
            divisor = common_divisor(common_divisor(divisor, *left), *right);
        }
        for distance in left.iter_mut().chain(&mut right) {
            *distance = distance.checked_div(divisor).unwrap_or(0);
        }
        Self { degree, left, right }
    }

    /// The knots of a direction that is not there: one point, nothing to insert.
    pub(super) const NONE: Self = Self { degree: 0, left: [0; MAX_DEGREE], right: [0; MAX_DEGREE] };

    /// b − a.
    fn width(&self) -> u32 {
        self.right[0]
    }

    /// What makes Bézier point `k`. As many arguments as a or b already have copies among the knots cost nothing.
    pub(super) fn insertion(&self, k: usize) -> Insertion<'_> {
        let here =
            |knots: &[u32; MAX_DEGREE], at: u32| knots.iter().take(self.degree).take_while(|t| **t == at).count();
        let before = here(&self.left, 0).min(self.degree.saturating_sub(k));
        let after = here(&self.right, self.width()).min(k);
        let at_a = self.degree.saturating_sub(k + before);
        Insertion { window: self, before, after, at_a, count: at_a + k - after }
    }
}

/// The insertions that lead to one Bézier control point in one direction.
#[derive(Clone, Copy)]
pub(super) struct Insertion<'a> {
    window: &'a Window,
    /// Copies of a among the knots of every point that is used.
    before: usize,
    /// Copies of b, and the first point of the window that is used.
    after: usize,
    /// Insertions of a; the others are of b.
    at_a: usize,
    /// All insertions; one point more is used.
    count: usize,
}

impl Insertion<'_> {
    /// (a − λ, ρ − a) for each pair of neighbours on a level with `len` of them.
    fn pairs(&self, len: usize) -> impl Iterator<Item = (u32, u32)> {
        let left = self.window.left.iter().skip(self.before).take(len).rev();
        left.copied().zip(self.window.right.iter().skip(self.after).take(len).copied())
    }

    /// The lengths of the levels, each with the u − a that it inserts.
    fn levels(&self) -> impl Iterator<Item = (usize, u32)> {
        let (at_a, count, width) = (self.at_a, self.count, self.window.width());
        (0..count).map(move |step| (count - step, if step < at_a { 0 } else { width }))
    }

    /// Multiplies by the denominators of all levels.
    fn multiply_denominators(&self, value: &mut Natural) {
        let denominators = self.levels().flat_map(|(len, _)| self.pairs(len));
        value.scale_all(denominators.map(|(left, right)| left + right));
    }

    /// The value from those of the points in use, times the denominators of all levels.
    fn collapse(&self, values: &mut [Natural]) -> Natural {
        for (len, u) in self.levels() {
            for (m, (left, right)) in self.pairs(len).enumerate() {
                let Some([x, y]) = values.get_mut(m..m + 2) else { continue };
                x.scale(right - u);
                x.add_scaled(y, left + u);
                let others = self.pairs(len).enumerate().filter(|(other, _)| *other != m);
                x.scale_all(others.map(|(_, (left, right))| left + right));
            }
        }
        values.first().copied().unwrap_or(Natural::ZERO)
    }
}

/// Added to the raw bits of coordinates to make them natural. Rounding half up commutes with it.
const OFFSET: u32 = 1 << 31;

/// The control points of a spline that belong to one span, or one pair of spans.
#[derive(Clone, Copy)]
pub(super) struct Source<'a> {
    pub(super) points: &'a [Point3],
    pub(super) weights: Option<&'a [I16F16]>,
    /// The first point of the span.
    pub(super) first: usize,
    /// From a row to the next.
    pub(super) stride: usize,
}

/// A homogeneous coordinate of the points.
#[derive(Clone, Copy)]
enum Part {
    X,
    Y,
    Z,
    Weight,
}

impl Source<'_> {
    /// Coordinate or weight of point (i, j) of the span, times the weight if there are weights.
    fn get(&self, part: Part, i: usize, j: usize) -> Natural {
        let index = self.first + i * self.stride + j;
        // Counted when the spline was made; the fallbacks are never taken.
        let weight = self.weights.map_or(1, |w| w.get(index).map_or(0, |w| w.to_bits() as u32));
        let coordinate = self.points.get(index).map_or(0, |p| match part {
            Part::X => OFFSET.wrapping_add(p.x.to_bits() as u32),
            Part::Y => OFFSET.wrapping_add(p.y.to_bits() as u32),
            Part::Z => OFFSET.wrapping_add(p.z.to_bits() as u32),
            Part::Weight => 1,
        });
        Natural::new(u64::from(coordinate) * u64::from(weight))
    }

    /// One homogeneous coordinate, times all denominators. `rows` has room for the points of a row, `columns` for
    /// those of a column.
    fn collapse(
        &self,
        part: Part,
        along: [Insertion<'_>; 2],
        columns: &mut [Natural],
        rows: &mut [Natural],
    ) -> Natural {
        let [r, s] = along;
        for (i, column) in (r.after..).zip(columns.iter_mut().take(r.count + 1)) {
            for (j, value) in (s.after..).zip(rows.iter_mut().take(s.count + 1)) {
                *value = self.get(part, i, j);
            }
            *column = s.collapse(rows);
        }
        r.collapse(columns)
    }

    /// The Bézier control point and its weight times 2^`log2`, both rounded half up; the weight is 1 where there are
    /// no weights.
    ///
    /// Points are convex combinations, so they stay legal, and weights stay between the least and the largest.
    pub(super) fn point(
        &self,
        along: [Insertion<'_>; 2],
        log2: u32,
        columns: &mut [Natural],
        rows: &mut [Natural],
    ) -> (Point3, I16F16) {
        let mut denominator = Natural::new(1);
        along.iter().for_each(|insertion| insertion.multiply_denominators(&mut denominator));
        let mut weight = I16F16::ONE;
        if self.weights.is_some() {
            let homogeneous = self.collapse(Part::Weight, along, columns, rows);
            let mut scaled = homogeneous;
            scaled.scale(1 << log2);
            weight = I16F16::from_bits(scaled.div_half_up(&denominator) as i32);
            denominator = homogeneous;
        }
        let [x, y, z] = [Part::X, Part::Y, Part::Z].map(|part| {
            let coordinate = self.collapse(part, along, columns, rows).div_half_up(&denominator);
            coordinate.wrapping_sub(OFFSET) as i32
        });
        (Point3::from_bits(x, y, z), weight)
    }
}
