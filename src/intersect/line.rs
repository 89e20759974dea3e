//! Lines in the domain of a patch, edges above all, and curves in space as nets of degrees (n, 0): those have one row only,
//! and their edge v = 0 is all of them.

use super::part::{Row, piece, row, triangle_blossom};
use super::sheet::{Homogeneous, ONE, PARAMETER_BITS, Place, Sheet, between};
use crate::num::Real;
use crate::patch::{CurveNet, MAX_DEGREE, RationalCurveNet, RationalTensorNet, SurfaceNet, TensorNet};

/// A line in the domain of a patch of a pair, with the parameter t, 0 ..= 1 in units of 2^-48; each of its parameters rises
/// or falls by a power of two on the way, or not at all.
#[derive(Clone, Copy, Debug)]
pub(super) struct Line {
    pub(super) side: usize,
    /// The edge that it is, if it is one.
    pub(super) edge: Option<usize>,
    pub(super) from: Place,
    pub(super) to: Place,
}

impl Line {
    pub(super) fn edge(sheet: &Sheet<'_>, side: usize, edge: usize) -> Self {
        let [from, to] = [0, ONE].map(|t| sheet.edge_place(edge, t));
        Self { side, edge: Some(edge), from, to }
    }

    pub(super) fn place(&self, t: i64) -> Place {
        let step = |from: i64, to: i64| from + ((i128::from(to - from) * i128::from(t)) >> PARAMETER_BITS) as i64;
        [step(self.from[0], self.to[0]), step(self.from[1], self.to[1])]
    }

    /// The parameter of a place on the line; far beyond 1 for one farther than twice the line's length.
    pub(super) fn parameter(&self, place: Place) -> i64 {
        let k = usize::from(self.from[0] == self.to[0]);
        let (size, far) = (self.to[k] - self.from[k], place[k] - self.from[k]);
        if far.abs() / 2 > size.abs() {
            return ONE << 8;
        }
        let shift = PARAMETER_BITS as u32 - size.trailing_zeros().min(PARAMETER_BITS as u32);
        (far << shift) * size.signum()
    }

    /// How fast the patch's parameters grow.
    pub(super) fn direction(&self) -> [Real; 2] {
        both!(|k| Real::new(self.to[k] - self.from[k], -PARAMETER_BITS))
    }
}

/// The value of coefficients of degree `n` at `t`.
fn value(mut row: Row, n: usize, t: i64) -> Homogeneous {
    for left in (1..=n.min(MAX_DEGREE)).rev() {
        for i in 0..left {
            let next = row[(i + 1).min(MAX_DEGREE)];
            let value = &mut row[i.min(MAX_DEGREE)];
            for k in 0..4 {
                value[k] = between(value[k], next[k], t);
            }
        }
    }
    row[0]
}

impl<'a> Sheet<'a> {
    /// A curve.
    pub(super) fn line(net: CurveNet<'a>, weighted: Option<RationalCurveNet<'a>>, room: &'a mut [Homogeneous]) -> Self {
        let row = TensorNet::of_checked((net.degree(), 0), net.points());
        let source = match weighted {
            None => SurfaceNet::Tensor(row),
            Some(weighted) => SurfaceNet::RationalTensor(RationalTensorNet::of_checked(row, weighted.weights())),
        };
        Self::new(source, room)
    }

    /// The control points of the curve of a tensor-product patch on which its first parameter is `t`.
    fn held_first(&self, t: i64) -> (Row, usize) {
        let (m, h) = (self.degrees.0.min(MAX_DEGREE), self.degrees.1.min(MAX_DEGREE));
        let mut out = [[0; 4]; MAX_DEGREE + 1];
        for (j, out) in out.iter_mut().enumerate().take(h + 1) {
            *out = value(row(self.net, (j, h + 1)), m, t);
        }
        (out, h)
    }

    /// The same for its second parameter.
    fn held_second(&self, t: i64) -> (Row, usize) {
        let (m, h) = (self.degrees.0.min(MAX_DEGREE), self.degrees.1.min(MAX_DEGREE));
        let mut out = [[0; 4]; MAX_DEGREE + 1];
        for (i, out) in out.iter_mut().enumerate().take(m + 1) {
            *out = value(row(self.net, (i * (h + 1), 1)), h, t);
        }
        (out, m)
    }

    /// The control points of the curve over the line between two places, parallel to an axis but on a triangle, and its degree.
    pub(super) fn row(&self, from: Place, to: Place) -> (Row, usize) {
        if self.triangle {
            let n = self.degrees.0.min(MAX_DEGREE);
            let mut out = [[0; 4]; MAX_DEGREE + 1];
            for (k, out) in out.iter_mut().enumerate().take(n + 1) {
                *out = triangle_blossom(self.net, n, &[from, to, from], [n - k, k, 0]);
            }
            return (out, n);
        }
        let first = from[0] == to[0];
        let (mut row, n) = if first { self.held_first(from[0]) } else { self.held_second(from[1]) };
        let along = usize::from(first);
        piece(&mut row, n, [from[along], to[along]]);
        (row, n)
    }

    /// The curve over a line of a patch, in a room of nine points or as many as the patch has.
    pub(super) fn cut(source: SurfaceNet<'a>, [from, to]: [Place; 2], room: &'a mut [Homogeneous]) -> Self {
        let patch = Sheet::new(source, &mut *room);
        let (row, n) = patch.row(from, to);
        let (rational, bits, extent) = (patch.rational, patch.bits, patch.extent);
        for (out, value) in room.iter_mut().zip(row) {
            *out = value;
        }
        Self { source, triangle: false, rational, degrees: (n, 0), bits, extent, net: room }
    }

    /// Whether a curve is a point.
    pub(super) fn is_point(&self) -> bool {
        let point = |t: i64| self.eval([t, 0], 0).map(|jet| jet.point);
        (1..=16).all(|k| point(ONE / 16 * k) == point(0))
    }

    /// Whether a patch has a normal anywhere.
    pub(super) fn has_normal(&self) -> bool {
        let least = self.extent.square().square() * Real::power(-72);
        (0..8).any(|i| {
            (0..8).any(|j| {
                let place = [2 * i + 1, 2 * j + 1].map(|k| ONE / 16 * k);
                let inside = self.contains(place, 0);
                inside && self.eval(place, 1).is_some_and(|jet| jet.normal().square() > least)
            })
        })
    }
}
