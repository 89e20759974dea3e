//! Hermite curves and patches.

use super::super::{Sum, hide};
use embedded_surfaces::geometry::{Point3, Vector3};
use embedded_surfaces::num::I32F32;
use embedded_surfaces::patch::{BicubicPatch, CubicCurve, HermiteCorner};

pub(crate) fn calls(sum: &mut Sum) {
    let vector = |x, y, z| Vector3::new(I32F32::from_num(x), I32F32::from_num(y), I32F32::from_num(z));
    for pull in hide([0, 70, -31, 1 << 20]) {
        let (start, end) = (Point3::from_ints(hide(0), 2, 5), Point3::from_ints(90, 60, -7));
        let tangents = [vector(pull, 10, 3), vector(-7, pull, 20)];
        sum.add(CubicCurve::from_hermite([start, end], tangents));
        let corner = |p, twist| HermiteCorner::new(p, tangents[0], tangents[1], vector(twist, 1, pull));
        sum.add(BicubicPatch::from_hermite(&[
            [corner(start, 3), corner(end, 0)],
            [corner(end, pull), corner(start, 9)],
        ]));
    }
}
