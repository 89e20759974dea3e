//! Coons patches.

use super::super::{Sum, hide};
use embedded_surfaces::patch::{CoonsBoundary, CubicCurve};

pub(crate) fn calls(sum: &mut Sum) {
    for x in hide([90, 91]) {
        let curve = |points| hide(CubicCurve::from_ints(points));
        let (Ok(bottom), Ok(top), Ok(left), Ok(right)) = (
            curve([[0, 0, 0], [30, 0, 30], [60, 0, 40], [90, 0, 0]]),
            curve([[0, 90, 9], [31, 99, 0], [60, 92, 20], [90, 90, 3]]),
            curve([[0, 0, 0], [0, 30, -30], [-5, 60, 7], [0, 90, 9]]),
            curve([[x, 0, 0], [80, 33, 50], [97, 60, 0], [90, 90, 3]]),
        ) else {
            return;
        };
        let boundary = CoonsBoundary::new([bottom, top], [left, right]);
        sum.add(boundary.and_then(|b| CoonsBoundary::bilinear(&b)));
        sum.add(boundary.and_then(|b| CoonsBoundary::bicubic(&b)));
    }
}
