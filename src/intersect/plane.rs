//! Sections of a surface by planes; contour lines.

use super::sheet::{Homogeneous, POINT_BITS, Sheet};
use super::{Buffers, IntersectError, Intersection, Options, check, in_order};
use crate::geometry::{Axis, Point3, Vector3};
use crate::num::{Coord, I16F16, I32F32, bits_i16f16, bits_i32f32, div_half_up, shift_half_up};
use crate::patch::{SurfaceNet, TensorNet};

/// The plane n·x = c.
///
/// The normal n has `I16F16` components, any but three zeros, of any length; the offset c is an `I32F32`, in units times the
/// normal's length. n·x has 32 fraction bits too: a plane through a point of the lattice of coordinates is exact unless c
/// leaves ±2^31.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Plane {
    /// In units of 2^-16.
    normal: [i64; 3],
    /// In units of 2^-32.
    offset: i64,
}

#[cfg(feature = "defmt")]
impl defmt::Format for Plane {
    fn format(&self, f: defmt::Formatter<'_>) {
        defmt::write!(f, "{}/2^16 x = {}/2^32", self.normal, self.offset);
    }
}

/// The largest coordinate in units of 2^-16.
const LIMIT: i64 = 32767 << 16;

impl Plane {
    /// The plane n·x = c; also in constant context.
    ///
    /// # Errors
    /// [`IntersectError::Normal`] for a normal of three zeros.
    ///
    /// # Examples
    /// ```
    /// use embedded_surfaces::geometry::Vector3;
    /// use embedded_surfaces::intersect::Plane;
    /// use embedded_surfaces::num::{I16F16, I32F32};
    /// let [half, zero] = [I16F16::ONE / 2, I16F16::ZERO];
    /// let plane = Plane::new(Vector3::new(half, half, zero), I32F32::ONE)?; // x + y = 2
    /// assert!(Plane::new(Vector3::new(zero, zero, zero), I32F32::ONE).is_err());
    /// # Ok::<(), embedded_surfaces::intersect::IntersectError>(())
    /// ```
    pub const fn new(normal: Vector3<I16F16>, offset: I32F32) -> Result<Self, IntersectError> {
        let offset = bits_i32f32(offset);
        let normal = [bits_i16f16(normal.x), bits_i16f16(normal.y), bits_i16f16(normal.z)];
        if normal[0] == 0 && normal[1] == 0 && normal[2] == 0 {
            return Err(IntersectError::Normal { offset });
        }
        Ok(Self { normal, offset })
    }

    /// The plane n·x = c with whole numbers; also in constant context.
    ///
    /// # Errors
    /// [`IntersectError::Normal`] for a normal of three zeros.
    ///
    /// # Examples
    /// ```
    /// use embedded_surfaces::{geometry::{Point3, Vector3}, intersect::Plane, num::I16F16};
    /// let slope = Plane::from_ints([1, 2, 2], 36)?;
    /// let normal = Vector3::from_array([1, 2, 2].map(I16F16::from_num));
    /// assert_eq!(slope, Plane::through(Point3::from_ints(36, -5, 5), normal)?);
    /// # Ok::<(), embedded_surfaces::intersect::IntersectError>(())
    /// ```
    pub const fn from_ints(normal: [i16; 3], offset: i32) -> Result<Self, IntersectError> {
        let [x, y, z] = normal;
        let [x, y, z] = [(x as i32) << 16, (y as i32) << 16, (z as i32) << 16];
        let normal = Vector3::new(I16F16::from_bits(x), I16F16::from_bits(y), I16F16::from_bits(z));
        Self::new(normal, I32F32::from_bits((offset as i64) << 32))
    }

    /// The plane through a point, exact.
    ///
    /// # Errors
    /// [`IntersectError::Normal`] for a normal of three zeros, [`IntersectError::Offset`] where n·x leaves ±2^31: with a
    /// shorter normal it does not.
    ///
    /// # Examples
    /// ```
    /// use embedded_surfaces::geometry::{Axis, Point3, Vector3};
    /// use embedded_surfaces::{intersect::Plane, num::I16F16};
    /// let up = Vector3::from_array([0, 0, 1].map(I16F16::from_num));
    /// let level = Plane::through(Point3::from_ints(40, 30, 12), up)?;
    /// assert_eq!(level, Plane::across(Axis::Z, I16F16::from_num(12)));
    /// # Ok::<(), embedded_surfaces::intersect::IntersectError>(())
    /// ```
    pub fn through(point: Point3<I16F16>, normal: Vector3<I16F16>) -> Result<Self, IntersectError> {
        let plane = Self::new(normal, I32F32::ZERO)?;
        let offset = plane.height(point);
        match i64::try_from(offset) {
            Ok(offset) => Ok(Self { offset, ..plane }),
            Err(_) => Err(IntersectError::Offset { units: (offset >> 32) as i64 }),
        }
    }

    /// The plane on which a coordinate has a value: for z, the one of the contour line at that height.
    #[must_use]
    pub const fn across(axis: Axis, at: I16F16) -> Self {
        let one = 1 << 16;
        let normal = match axis {
            Axis::X => [one, 0, 0],
            Axis::Y => [0, one, 0],
            Axis::Z => [0, 0, one],
        };
        Self { normal, offset: bits_i16f16(at) << 16 }
    }

    /// n·x − c, exact, in units of 2^-32.
    fn height(&self, point: Point3<I16F16>) -> i128 {
        let products = point.to_array().into_iter().zip(self.normal).map(|(c, n)| i128::from(c.bits()) * i128::from(n));
        products.sum::<i128>() - i128::from(self.offset)
    }

    /// The axis along which the normal is longest: over the other two the plane is no steeper than 45 degrees.
    fn axis(&self) -> Axis {
        let [x, y, z] = self.normal.map(i64::abs);
        if z >= x && z >= y {
            Axis::Z
        } else if y > x {
            Axis::Y
        } else {
            Axis::X
        }
    }

    /// Corners of a parallelogram in the plane, in units of 2^-44, over a box, in units of 2^-16, in two coordinates.
    fn corners(&self, [low, high]: [[i64; 3]; 2]) -> Result<[[i64; 3]; 4], IntersectError> {
        let k = self.axis();
        let ([a, b, c], low, high) = (turned(self.normal, k), turned(low, k), turned(high, k));
        let mut out = [[0; 3]; 4];
        for (corner, far) in out.iter_mut().zip([[false, false], [false, true], [true, false], [true, true]]) {
            // In cyclic order, or the other way round, so that Su × Sv points along the normal.
            let [f, g] = if c > 0 { far } else { [far[1], far[0]] };
            let (x, y) = (if f { high[0] } else { low[0] }, if g { high[1] } else { low[1] });
            let products = i128::from(x) * i128::from(a) + i128::from(y) * i128::from(b);
            let rest = (i128::from(self.offset) - products) * i128::from(c.signum());
            let z = div_half_up(rest << (POINT_BITS - 16), i128::from(c.abs())).unwrap_or(0);
            let limit = i128::from(LIMIT) << (POINT_BITS - 16);
            if z > limit || z < -limit {
                return Err(IntersectError::Plane { units: (z >> POINT_BITS) as i64 });
            }
            *corner = restored([x << (POINT_BITS - 16), y << (POINT_BITS - 16), z as i64], k);
        }
        Ok(out)
    }
}

/// The coordinates in cyclic order, that of the axis last.
const fn turned([x, y, z]: [i64; 3], axis: Axis) -> [i64; 3] {
    match axis {
        Axis::X => [y, z, x],
        Axis::Y => [z, x, y],
        Axis::Z => [x, y, z],
    }
}

/// The inverse of [`turned`].
const fn restored([a, b, c]: [i64; 3], axis: Axis) -> [i64; 3] {
    match axis {
        Axis::X => [c, a, b],
        Axis::Y => [b, c, a],
        Axis::Z => [a, b, c],
    }
}

/// The curves in which a surface meets a plane.
///
/// The surface is A, the plane B: a parallelogram that reaches a unit past the surface's box, with Su × Sv along the normal.
/// Its parameters are the two coordinates across the longest component of the normal, (y, z), (z, x) or (x, y), mapped to
/// 0 ..= 1, the other way round where that component is negative. Everything else is as of [`intersect`](super::intersect),
/// tangencies included: a summit is a touching point, a pass a branch. A plane on one side of all control points meets the
/// surface nowhere, which is certain, and no buffer is used. Vertices and boxes: [`Room::of_section`](super::Room::of_section).
///
/// The plane is within 2^-43 unit of what was asked for, for points and curves; the mesh that finds them has its corners
/// rounded to 2^-16 unit, as it has the surface's vertices.
///
/// # Errors
/// [`IntersectError::Plane`] where the parallelogram leaves ±32767 units: never for planes across an axis, never for surfaces
/// within ±6550 units. Else as [`intersect`](super::intersect).
///
/// # Examples
/// A contour line, and a section by an oblique plane:
/// ```
/// use embedded_surfaces::geometry::Axis;
/// use embedded_surfaces::intersect::{
///     Branch, Buffers, Curve, CurvePoint, End, I20F44, Options, Plane, Side, section,
/// };
/// use embedded_surfaces::num::I16F16;
/// use embedded_surfaces::patch::{BilinearPatch, Surface};
///
/// let roof = BilinearPatch::from_ints([[[0, 0, 0], [0, 60, 0]], [[80, 0, 40], [80, 60, 40]]])?;
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
/// let options = Options::DEFAULT.with_depth(3);
/// let height = Plane::across(Axis::Z, I16F16::from_num(10));
/// let contour = section(roof.surface(), height, &options, buffers)?;
/// let line = contour.curves()[0];
/// assert_eq!(line.ends.map(|end| matches!(end, End::Edge { side: Side::A, .. })), [true; 2]);
/// let off = |p: &CurvePoint| (p.position.x - I20F44::from_num(20)).abs() + (p.position.z - I20F44::from_num(10)).abs();
/// assert!(contour.points(&line).iter().all(|p| off(p) < I20F44::from_bits(1 << 14))); // 10^-9
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// ```
/// # use embedded_surfaces::intersect::{Branch, Buffers, Curve, CurvePoint, I20F44, Options, Plane, section};
/// # use embedded_surfaces::patch::{BilinearPatch, Surface};
/// # let roof = BilinearPatch::from_ints([[[0, 0, 0], [0, 60, 0]], [[80, 0, 40], [80, 60, 40]]])?;
/// # let (mut vertices, mut boxes) = ([[0; 3]; 200], [[[0; 3]; 2]; 200]);
/// # let (mut records, mut links) = ([0; 200], [0; 200]);
/// # let (mut points, mut curves, mut branches) = ([CurvePoint::BLANK; 40], [Curve::BLANK; 4], [Branch::BLANK; 1]);
/// # let buffers = Buffers {
/// #     vertices: &mut vertices,
/// #     boxes: &mut boxes,
/// #     records: &mut records,
/// #     links: &mut links,
/// #     points: &mut points,
/// #     curves: &mut curves,
/// #     branches: &mut branches,
/// # };
/// # let options = Options::DEFAULT.with_depth(3);
/// let oblique = Plane::from_ints([1, 2, 3], 100)?;
/// let cut = section(roof.surface(), oblique, &options, buffers)?;
/// let on = |p: &CurvePoint| p.position.x + 2 * p.position.y + 3 * p.position.z - I20F44::from_num(100);
/// assert!(cut.is_certified() && cut.curves().len() == 1);
/// assert!(cut.points(&cut.curves()[0]).iter().all(|p| on(p).abs() < I20F44::from_bits(1 << 14)));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn section<'b>(
    net: SurfaceNet<'_>,
    plane: Plane,
    options: &Options,
    buffers: Buffers<'b>,
) -> Result<Intersection<'b>, IntersectError> {
    check(options)?;
    let heights = net.points().iter().map(|p| plane.height(*p));
    let (least, most) = heights.fold((i128::MAX, i128::MIN), |(l, m), h| (l.min(h), m.max(h)));
    if least > 0 || most < 0 {
        return Ok(Intersection::EMPTY);
    }
    let bounds = net.bounds();
    let one = 1 << 16;
    let corners = plane.corners([
        bounds.min.to_array().map(|c| (c.bits() - one).max(-LIMIT)),
        bounds.max.to_array().map(|c| (c.bits() + one).min(LIMIT)),
    ])?;
    let rounded = corners.map(|corner| {
        let [x, y, z] = corner.map(|c| shift_half_up(c.into(), (POINT_BITS - 16) as u32) as i32);
        Point3::from_bits(x, y, z)
    });
    let rounded = SurfaceNet::Tensor(TensorNet::of_checked((1, 1), &rounded));
    in_order([net, rounded], Some(&corners), options, buffers, false)
}

impl<'a> Sheet<'a> {
    /// A plane with corners in units of 2^-44, finer than those of its net.
    pub(super) fn of_plane(source: SurfaceNet<'a>, corners: &[[i64; 3]; 4], room: &'a mut [Homogeneous]) -> Self {
        let rough = Sheet::new(source, &mut *room);
        let (bits, extent) = (rough.bits, rough.extent);
        let drop = (POINT_BITS - bits).unsigned_abs();
        for (out, corner) in room.iter_mut().zip(corners) {
            for (out, c) in out.iter_mut().zip(corner) {
                *out = shift_half_up((*c).into(), drop) as i64;
            }
        }
        Self { source, triangle: false, rational: false, degrees: (1, 1), bits, extent, net: room }
    }
}
