//! What the engine walks over: a net of any kind, seen from its corner (0, 0).

use crate::geometry::Point3;
use crate::num::{Coord, I16F16};
use crate::patch::{CurveNet, RationalCurveNet, SurfaceNet, triangle_index};

/// The three kinds of nets.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    Curve,
    Triangle,
    Tensor,
}

/// A net and its step counts. A curve has degree 0 and one row in the second direction.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Form<'a> {
    pub(crate) kind: Kind,
    pub(crate) degrees: (usize, usize),
    pub(crate) steps: (u32, u32),
    /// The lattice of cell centres, ((i + 1/2)/n_r, (j + 1/2)/n_s), instead of (i/n_r, j/n_s).
    pub(crate) centred: bool,
    /// Which corner is (0, 0) and which way rows run: 0 as stored; 1 transposed, or turned by a third for a
    /// triangle; 2 turned twice.
    turn: u8,
    points: &'a [Point3],
    weights: Option<&'a [I16F16]>,
}

impl<'a> Form<'a> {
    pub(crate) fn curve(net: CurveNet<'a>, steps: u32) -> Self {
        let (kind, degrees) = (Kind::Curve, (net.degree(), 0));
        Self { kind, degrees, steps: (steps, 0), centred: false, turn: 0, points: net.points(), weights: None }
    }

    pub(crate) fn rational_curve(net: RationalCurveNet<'a>, steps: u32) -> Self {
        Self { weights: Some(net.weights()), ..Self::curve(net.control_net(), steps) }
    }

    pub(crate) fn surface(net: SurfaceNet<'a>, steps: (u32, u32)) -> Self {
        let kind = if net.is_triangle() { Kind::Triangle } else { Kind::Tensor };
        let (points, weights) = (net.points(), net.weights());
        Self { kind, degrees: net.degrees(), steps, centred: false, turn: 0, points, weights }
    }

    /// The centres of the cells of this lattice; for a triangle those of its parallelograms, the halves along the
    /// third side included.
    pub(crate) fn centres(&self) -> Self {
        Self { centred: true, ..*self }
    }

    /// The same net with rows along another direction: s instead of r; along v = const, u = const and w = const for
    /// the turns 0, 1 and 2 of a triangle. The step counts are those of the turned directions.
    pub(crate) fn turned(&self, turn: u8, steps: (u32, u32)) -> Self {
        let (m, h) = self.degrees;
        let degrees = if self.kind == Kind::Tensor && turn == 1 { (h, m) } else { (m, h) };
        Self { turn, degrees, steps, ..*self }
    }

    /// Which way the net is turned; see [`turned`](Self::turned).
    pub(crate) fn turn(&self) -> u8 {
        self.turn
    }

    pub(crate) fn points(&self) -> &'a [Point3] {
        self.points
    }

    pub(crate) fn weights(&self) -> Option<&'a [I16F16]> {
        self.weights
    }

    /// The larger degree.
    pub(crate) fn degree(&self) -> usize {
        self.degrees.0.max(self.degrees.1)
    }

    /// The last second index of column `a`.
    pub(crate) fn last_column_entry(&self, a: usize) -> usize {
        if self.kind == Kind::Triangle { self.degrees.1 - a } else { self.degrees.1 }
    }

    /// The last first index of row `b`.
    pub(crate) fn last_row_entry(&self, b: usize) -> usize {
        if self.kind == Kind::Triangle { self.degrees.0 - b } else { self.degrees.0 }
    }

    /// Where control point (a, b) stands; of a triangle b\[a,b,c\], b\[b,c,a\] or b\[c,a,b\] by its turn, c = n − a − b.
    fn index(&self, a: usize, b: usize) -> usize {
        match self.kind {
            Kind::Curve => a,
            Kind::Tensor if self.turn == 0 => a * (self.degrees.1 + 1) + b,
            Kind::Tensor => b * (self.degrees.0 + 1) + a,
            Kind::Triangle => {
                let c = self.degrees.0 - a - b;
                match self.turn {
                    0 => triangle_index(b, c),
                    1 => triangle_index(c, a),
                    _ => triangle_index(a, b),
                }
            }
        }
    }

    /// Raw bits of coordinate `axis` of control point (a, b).
    pub(crate) fn bits(&self, axis: usize, a: usize, b: usize) -> i64 {
        // The net was counted when it was made; the fallback is never taken.
        self.points.get(self.index(a, b)).map_or(0, |p| match axis {
            0 => p.x.bits(),
            1 => p.y.bits(),
            _ => p.z.bits(),
        })
    }

    /// Raw bits of the weight of control point (a, b); 1 for a polynomial.
    pub(crate) fn weight_bits(&self, a: usize, b: usize) -> i64 {
        self.weights.map_or(1, |weights| weights.get(self.index(a, b)).map_or(1, |w| w.bits()))
    }

    /// The steps that difference tables take: half steps to reach cell centres.
    pub(crate) fn table_steps(&self) -> (u32, u32) {
        if self.centred { (2 * self.steps.0, 2 * self.steps.1) } else { self.steps }
    }

    /// The last i of row `j`.
    pub(crate) fn last_in_row(&self, j: u32) -> u32 {
        let last = if self.kind == Kind::Triangle { self.steps.0 - j } else { self.steps.0 };
        last - u32::from(self.centred)
    }

    /// The last row.
    pub(crate) fn last_row(&self) -> u32 {
        self.steps.1 - u32::from(self.centred)
    }

    /// The number of lattice points.
    pub(crate) fn point_count(&self) -> u64 {
        let (r, s) = (u64::from(self.last_in_row(0)), u64::from(self.last_row()));
        if self.kind == Kind::Triangle { (r + 1) * (r + 2) / 2 } else { (r + 1) * (s + 1) }
    }

    /// The largest |difference| of neighbours along r and along s of the net values `value(a, b)`.
    pub(crate) fn largest_differences(&self, value: impl Fn(usize, usize) -> i128) -> [u128; 2] {
        self.largest_gaps(|[a, b], [c, d]| value(a, b).abs_diff(value(c, d)))
    }

    /// [`largest_differences`](Self::largest_differences) of the raw bits of coordinate `axis`.
    pub(super) fn largest_edges(&self, axis: usize) -> [u32; 2] {
        let value = |[a, b]: [usize; 2]| {
            self.points.get(self.index(a, b)).map_or(0, |p| match axis {
                0 => p.x.to_bits(),
                1 => p.y.to_bits(),
                _ => p.z.to_bits(),
            })
        };
        self.largest_gaps(|p, q| value(p).abs_diff(value(q)))
    }

    /// The largest `gap` of neighbours along r and along s.
    #[inline(always)]
    fn largest_gaps<T: Ord + Copy + Default>(&self, gap: impl Fn([usize; 2], [usize; 2]) -> T) -> [T; 2] {
        let [mut by_r, mut by_s] = [T::default(); 2];
        for a in 0..=self.degrees.0 {
            for b in 0..=self.last_column_entry(a) {
                if a < self.degrees.0 && b <= self.last_column_entry(a + 1) {
                    by_r = gap([a + 1, b], [a, b]).max(by_r);
                }
                if b < self.last_column_entry(a) {
                    by_s = gap([a, b + 1], [a, b]).max(by_s);
                }
            }
        }
        [by_r, by_s]
    }
}
