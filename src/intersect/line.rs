//! Curves as nets of degrees (n, 0): evaluated at (t, 0) they are what their only row is.

use super::part::triangle_blossom;
use super::sheet::{Homogeneous, ONE, Place, Sheet, between};
use crate::num::Real;
use crate::patch::{CurveNet, MAX_DEGREE, RationalCurveNet, RationalTensorNet, SurfaceNet, TensorNet};

type Row = [Homogeneous; MAX_DEGREE + 1];

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
    pub(super) fn line(net: CurveNet<'a>, weighted: Option<RationalCurveNet<'a>>) -> Self {
        let row = TensorNet::of_checked((net.degree(), 0), net.points());
        Self::new(match weighted {
            None => SurfaceNet::Tensor(row),
            Some(weighted) => SurfaceNet::RationalTensor(RationalTensorNet::of_checked(row, weighted.weights())),
        })
    }

    /// Becomes this row.
    fn become_row(&mut self, row: &Row, degree: usize) {
        for (out, value) in self.net.iter_mut().zip(row) {
            *out = *value;
        }
        (self.triangle, self.degrees) = (false, (degree, 0));
    }

    /// Becomes the curve of a tensor-product patch on which its first parameter is `t`.
    pub(super) fn hold_first(&mut self, t: i64) {
        let (m, h) = self.degrees;
        let mut out = [[0; 4]; MAX_DEGREE + 1];
        for (j, out) in out.iter_mut().enumerate().take(h + 1) {
            let mut column = [[0; 4]; MAX_DEGREE + 1];
            for (value, point) in column.iter_mut().zip(self.net.iter().skip(j).step_by(h + 1)).take(m + 1) {
                *value = *point;
            }
            *out = value(column, m, t);
        }
        self.become_row(&out, h);
    }

    /// The same for its second parameter.
    pub(super) fn hold_second(&mut self, t: i64) {
        let (m, h) = self.degrees;
        let mut out = [[0; 4]; MAX_DEGREE + 1];
        for (out, points) in out.iter_mut().zip(self.net.chunks(h + 1)).take(m + 1) {
            let mut row = [[0; 4]; MAX_DEGREE + 1];
            for (value, point) in row.iter_mut().zip(points) {
                *value = *point;
            }
            *out = value(row, h, t);
        }
        self.become_row(&out, m);
    }

    /// Becomes the curve of a triangular patch over the line between two places.
    pub(super) fn cut(&mut self, [from, to]: [Place; 2]) {
        let n = self.degrees.0.min(MAX_DEGREE);
        let mut out = [[0; 4]; MAX_DEGREE + 1];
        for (k, out) in out.iter_mut().enumerate().take(n + 1) {
            *out = triangle_blossom(&self.net, n, &[from, to, from], [n - k, k, 0]);
        }
        self.become_row(&out, n);
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
