//! Sections of a surface by planes across an axis: contour lines.

use super::{Buffers, IntersectError, Intersection, Options, intersect};
use crate::geometry::{Axis, Point3};
use crate::num::I16F16;
use crate::patch::{SurfaceNet, TensorNet};

/// The curves in which a surface meets the plane where a coordinate has a value: for z, the contour line at that height.
///
/// The plane is B, a bilinear patch that reaches a unit past the surface's box; its parameters are the other two
/// coordinates, mapped to 0 ..= 1. Everything else is as of [`intersect`], tangencies included: a summit is a touching
/// point, a pass a branch.
///
/// # Errors
/// [`IntersectError::Plane`] for a plane outside the range of coordinates, else as [`intersect`].
///
/// # Examples
/// ```
/// use embedded_surfaces::geometry::Axis;
/// use embedded_surfaces::intersect::{Branch, Buffers, Curve, CurvePoint, End, I20F44, Options, Side, section};
/// use embedded_surfaces::num::I16F16;
/// use embedded_surfaces::patch::{BilinearPatch, Surface};
///
/// let roof = BilinearPatch::from_ints([[[0, 0, 0], [0, 60, 0]], [[80, 0, 40], [80, 60, 40]]])?;
/// let height = I16F16::from_num(10);
/// let (mut vertices, mut boxes) = ([[0; 3]; 200], [[[0; 3]; 2]; 200]);
/// let (mut records, mut links) = ([0; 200], [0; 200]);
/// let (mut points, mut curves, mut branches) = ([CurvePoint::BLANK; 40], [Curve::BLANK; 4], [Branch::BLANK; 1]);
/// let buffers = Buffers {
///     vertices: &mut vertices,
///     boxes: &mut boxes,
///     records: &mut records,
///     links: &mut links,
///     points: &mut points,
///     curves: &mut curves,
///     branches: &mut branches,
/// };
/// let contour = section(roof.surface(), Axis::Z, height, &Options::DEFAULT.with_depth(3), buffers)?;
/// let line = contour.curves()[0];
/// assert_eq!(line.ends.map(|end| matches!(end, End::Edge { side: Side::A, .. })), [true; 2]);
/// let off = |p: &CurvePoint| (p.position.x - I20F44::from_num(20)).abs() + (p.position.z - I20F44::from_num(10)).abs();
/// assert!(contour.points(&line).iter().all(|p| off(p) < I20F44::from_bits(1 << 14))); // 10^-9
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn section<'b>(
    net: SurfaceNet<'_>,
    axis: Axis,
    at: I16F16,
    options: &Options,
    buffers: Buffers<'b>,
) -> Result<Intersection<'b>, IntersectError> {
    let limit = I16F16::from_bits(32767 << 16);
    if at > limit || at < -limit {
        return Err(IntersectError::Plane { units: at.to_bits() >> 16 });
    }
    let bounds = net.bounds();
    let one = I16F16::from_bits(1 << 16);
    let [low, high] = [
        bounds.min.to_array().map(|c| (c.saturating_sub(one)).max(-limit)),
        bounds.max.to_array().map(|c| (c.saturating_add(one)).min(limit)),
    ];
    let corner = |far: [bool; 2]| {
        let pick = |k: usize, far: bool| if far { high[k] } else { low[k] };
        let [f, g] = far;
        match axis {
            Axis::X => Point3::new(at, pick(1, f), pick(2, g)),
            Axis::Y => Point3::new(pick(0, f), at, pick(2, g)),
            Axis::Z => Point3::new(pick(0, f), pick(1, g), at),
        }
    };
    let corners = [[false, false], [false, true], [true, false], [true, true]].map(corner);
    let plane = SurfaceNet::Tensor(TensorNet::of_checked((1, 1), &corners));
    intersect(net, plane, options, buffers)
}
