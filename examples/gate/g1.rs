//! Smooth skins, their baselines, reports and errors.

use super::mesh::{CUBE, TRIANGLES};
use super::{Digest, Sum, hide};
use embedded_surfaces::g1::{Controls, Interpolant, Lengths, Options, Quality, Scheme, Shift, Tangent, Twist};
use embedded_surfaces::geometry::{Point3, Vector3};
use embedded_surfaces::mesh::{Faces, Links, Mesh};
use embedded_surfaces::num::{I16F16, I32F32};

impl Digest for Shift {
    fn digest(&self, sum: &mut Sum) {
        Shift::is_none(*self).digest(sum);
    }
}

impl Digest for Quality {
    fn digest(&self, sum: &mut Sum) {
        (self.max_angle, Quality::max_angle_rounded(self)).digest(sum);
        [self.max_deviation, self.max_correction].digest(sum);
        [self.folded, self.shifted].digest(sum);
    }
}

pub(super) fn calls(sum: &mut Sum) {
    let mut points = hide(CUBE).map(|[x, y, z]| Point3::<I16F16>::from_ints(x, y, z));
    points[5].x += I16F16::from_bits(hide(77_777));
    let Ok(closed) = Links::<8, 36>::new(8, hide(Faces::Triangles(&TRIANGLES))) else { return };
    let Ok(open) = Links::<8, 36>::new(8, hide(Faces::Triangles(&TRIANGLES[..6]))) else { return };
    let Ok(quads) = Links::<8, 36>::new(8, hide(Faces::Quads(&[[0, 1, 3, 2]]))) else { return };
    let normals = points.map(|p| Vector3::from_array(Point3::<I32F32>::from(p).to_array()));
    let tension = [I16F16::from_bits(hide(9_999)); 8];
    let tangents = [Tangent { from: 0, to: 1, vector: Vector3::new(I32F32::ONE, I32F32::ZERO, hide(I32F32::ONE * 9)) }];
    let twists = [Twist { face: 2, corner: 1, point: Point3::from(points[6]) }];
    let none = Controls::default();
    let all = Controls { normals: Some(&normals), tension: Some(&tension), twists: &twists, ..none };
    let given = Controls { tangents: &tangents, ..none };
    let strict = Options { strict: true, lengths: Lengths::Projected, ..Options::default() };
    let scheme = |scheme| Options { scheme, ..Options::default() };
    for (links, controls, options) in hide([
        (&closed, all, Options::default()),
        (&closed, given, Options::default()),
        (&closed, none, strict),
        (&open, none, scheme(Scheme::PointNormal)),
        (&open, all, Options::default()),
        (&open, none, scheme(Scheme::Literal)),
        (&open, none, scheme(Scheme::Flat)),
        (&quads, none, Options::default()),
        (&closed, Controls { normals: Some(&normals[..3]), ..none }, strict),
    ]) {
        if let Ok(mesh) = Mesh::<I16F16>::new(&points, links) {
            surface(sum, &mesh, &controls, &options);
        }
    }
    let fine = points.map(Point3::<I32F32>::from);
    if let Ok(mesh) = Mesh::<I32F32>::new(&fine, &open) {
        let mut shifts = [Shift::NONE; 8];
        let surface = Interpolant::new(&mesh, &all, &Options::default(), &mut shifts);
        sum.add(surface.map(|surface| Interpolant::quality(&surface)).and_then(|quality| quality));
    }
}

#[inline(never)]
fn surface(sum: &mut Sum, mesh: &Mesh<'_>, controls: &Controls<'_>, options: &Options) {
    let mut shifts = [Shift::NONE; 8];
    let surface = Interpolant::new(mesh, controls, options, &mut shifts);
    sum.add(surface.as_ref().map(Interpolant::shifts).map_err(|error| *error));
    let Ok(surface) = surface else { return };
    for face in hide([0, 3, 99]) {
        sum.add(Interpolant::triangle(&surface, face).map(|triangle| *triangle.points()));
        sum.add(Interpolant::rounded(&surface, face).map(|triangle| *triangle.points()));
        sum.add(Interpolant::is_folded(&surface, face));
    }
    for triangle in Interpolant::triangles(&surface).take(2) {
        sum.add(triangle.map(|triangle| triangle.points()[9]));
    }
    sum.add(Interpolant::quality(&surface));
}
