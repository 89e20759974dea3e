//! Sphere, cylinder, cone and torus.

use super::super::{Sum, hide};
use embedded_surfaces::geometry::Point3;
use embedded_surfaces::num::I16F16;
use embedded_surfaces::patch::{Dimension, cone, cylinder, sphere, torus};

pub(crate) fn calls(sum: &mut Sum) {
    let centre = Point3::from_ints(hide(5), -9, 33);
    for (radius, other) in hide([(40, 7), (-1, 2), (3, 0), (32767, 9)]) {
        let [radius, other] = [radius, other].map(I16F16::from_num);
        sum.add(sphere(centre, radius));
        sum.add(cylinder(centre, radius, other));
        sum.add(cone(centre, radius, other));
        sum.add(torus(centre, radius, other));
    }
    hide([Dimension::Radius, Dimension::TubeRadius, Dimension::Height])
        .into_iter()
        .for_each(|d| sum.add(Err::<(), _>(d)));
}
