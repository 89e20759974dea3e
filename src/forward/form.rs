//! What the engine walks over: a net of any kind, seen from its corner (0, 0).

use crate::geometry::Point3;
use crate::num::Coord;
use crate::patch::{CurveNet, SurfaceNet, triangle_index};

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
    points: &'a [Point3],
}

impl<'a> Form<'a> {
    pub(crate) fn curve(net: CurveNet<'a>, steps: u32) -> Self {
        Self { kind: Kind::Curve, degrees: (net.degree(), 0), steps: (steps, 0), points: net.points() }
    }

    pub(crate) fn surface(net: SurfaceNet<'a>, steps: (u32, u32)) -> Self {
        let kind = match net {
            SurfaceNet::Triangle(_) => Kind::Triangle,
            SurfaceNet::Tensor(_) => Kind::Tensor,
        };
        Self { kind, degrees: net.degrees(), steps, points: net.points() }
    }

    pub(crate) fn points(&self) -> &'a [Point3] {
        self.points
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

    /// Raw bits of coordinate `axis` of control point (a, b): b\[a, b, n−a−b\] of a triangle.
    pub(crate) fn bits(&self, axis: usize, a: usize, b: usize) -> i64 {
        let index = match self.kind {
            Kind::Curve => a,
            Kind::Tensor => a * (self.degrees.1 + 1) + b,
            Kind::Triangle => triangle_index(b, self.degrees.0 - a - b),
        };
        // The net was counted when it was made; the fallback is never taken.
        self.points.get(index).map_or(0, |p| match axis {
            0 => p.x.bits(),
            1 => p.y.bits(),
            _ => p.z.bits(),
        })
    }

    /// The last i of row `j`.
    pub(crate) fn last_in_row(&self, j: u32) -> u32 {
        if self.kind == Kind::Triangle { self.steps.0 - j } else { self.steps.0 }
    }

    /// The last row.
    pub(crate) fn last_row(&self) -> u32 {
        self.steps.1
    }

    /// The number of lattice points.
    pub(crate) fn point_count(&self) -> u64 {
        let (r, s) = (u64::from(self.steps.0), u64::from(self.steps.1));
        if self.kind == Kind::Triangle { (r + 1) * (r + 2) / 2 } else { (r + 1) * (s + 1) }
    }

    /// The largest |difference| of neighbours along each direction, per axis, in raw bits; [r, s] for each axis.
    pub(crate) fn largest_differences(&self) -> [[u64; 2]; 3] {
        let mut largest = [[0; 2]; 3];
        for (axis, [by_r, by_s]) in largest.iter_mut().enumerate() {
            for a in 0..=self.degrees.0 {
                for b in 0..=self.last_column_entry(a) {
                    let here = self.bits(axis, a, b);
                    if a < self.degrees.0 && b <= self.last_column_entry(a + 1) {
                        *by_r = (*by_r).max(self.bits(axis, a + 1, b).abs_diff(here));
                    }
                    if b < self.last_column_entry(a) {
                        *by_s = (*by_s).max(self.bits(axis, a, b + 1).abs_diff(here));
                    }
                }
            }
        }
        largest
    }
}
