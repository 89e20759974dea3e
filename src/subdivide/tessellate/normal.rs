//! Unit normals in integers.

use super::cell::{FINE, Fine};
use super::eval::{dyadic, reduced_barycentric};
use crate::geometry::{Point3, Vector3};
use crate::num::{Coord, I16F16, div_half_up, shift_half_up};
use crate::patch::{Barycentric, SurfaceNet};

/// Fraction bits of a unit normal.
pub(super) const UNIT: u32 = 30;

/// A vector shortened to 30 bits: enough for a direction.
fn shortened(v: [i64; 3]) -> [i64; 3] {
    let widest = v.iter().fold(0, |widest, c| widest | c.unsigned_abs());
    let excess = (64 - widest.leading_zeros()).saturating_sub(30);
    v.map(|c| c >> excess)
}

/// The cross product made one unit long, in 2^-30; `None` where it is zero.
fn unit_cross(p: [i64; 3], q: [i64; 3]) -> Option<[i64; 3]> {
    let (p, q) = (shortened(p), shortened(q));
    let component = |y: usize, z: usize| p[y] * q[z] - p[z] * q[y];
    let cross = [component(1, 2), component(2, 0), component(0, 1)];
    let square = cross.iter().map(|c| u128::from(c.unsigned_abs()).pow(2)).sum::<u128>();
    // Four more bits of the length; the square is below 2^125.
    let (square, scale) = if square >> 60 == 0 { (square << 64, 32) } else { (square, 0) };
    let length = square.isqrt() as i128;
    let [x, y, z] = cross.map(|c| div_half_up(i128::from(c) << (UNIT + scale), length).map(|n| n as i64));
    Some([x?, y?, z?])
}

/// The unit normal of a triangle, in 2^-30; `None` where it has no area.
pub(super) fn of_triangle([a, b, c]: [Point3; 3]) -> Option<[i64; 3]> {
    let [a, b, c] = [a, b, c].map(|p| p.to_array().map(Coord::bits));
    let difference = |to: [i64; 3]| [to[0] - a[0], to[1] - a[1], to[2] - a[2]];
    unit_cross(difference(b), difference(c))
}

/// The unit normal S_r × S_s (S_u × S_v) of a patch, in 2^-30; where a derivative vanishes, as at a collapsed side, that
/// of a point a little towards the middle of the patch; `None` where that fails as well.
pub(super) fn of_patch(net: &SurfaceNet<'_>, fine: Fine) -> Option<[i64; 3]> {
    [FINE, 10, 6, 2].into_iter().find_map(|shift| {
        let middle = if net.is_triangle() { [21845, 21845, 21846] } else { [1 << 15, 1 << 15, 0] };
        let move_in = |c: usize| fine[c] + if shift == FINE { 0 } else { (middle[c] - fine[c]) >> shift };
        let [r, s] = [move_in(0), move_in(1)];
        let at = [r, s, if net.is_triangle() { (1 << FINE) - r - s } else { 0 }];
        let [by_r, by_s] = partials(net, at)?;
        unit_cross(by_r.to_array().map(Coord::bits), by_s.to_array().map(Coord::bits))
    })
}

fn partials(net: &SurfaceNet<'_>, fine: Fine) -> Option<[Vector3; 2]> {
    let barycentric = || {
        let ([u, v, w], _) = reduced_barycentric(fine);
        Barycentric::new(u as u32, v as u32, w as u32).ok()
    };
    match net {
        SurfaceNet::Triangle(net) => Some(net.partials(barycentric()?)),
        SurfaceNet::RationalTriangle(net) => net.partials(barycentric()?),
        SurfaceNet::Tensor(net) => Some(net.partials(dyadic(fine[0]), dyadic(fine[1]))),
        SurfaceNet::RationalTensor(net) => net.partials(dyadic(fine[0]), dyadic(fine[1])),
    }
}

/// A unit normal rounded to 2^-16.
pub(super) fn rounded(normal: [i64; 3]) -> Vector3<I16F16> {
    let component = |c: i64| I16F16::from_bits(shift_half_up(c.into(), UNIT - 16) as i32);
    Vector3::from_array(normal.map(component))
}
