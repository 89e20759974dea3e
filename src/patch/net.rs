//! Views: borrowed nets with the degree erased.

use super::{MAX_DEGREE, NetError, RationalTensorNet, RationalTriangleNet, triangle_len};
use crate::geometry::{Axis, Bounds, Point3};
use crate::num::{Coord, I16F16, I32F32, bits_i16f16, bits_i32f32};

/// A Bézier curve: the control points in order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CurveNet<'a, C = I16F16> {
    points: &'a [Point3<C>],
}

/// A triangular Bézier patch: b\[i,j,k\] with i descending, then j descending.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TriangleNet<'a, C = I16F16> {
    degree: u8,
    points: &'a [Point3<C>],
}

/// A tensor-product Bézier patch of degrees (m, h): point (i, j) at index i·(h+1) + j.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TensorNet<'a, C = I16F16> {
    degrees: (u8, u8),
    points: &'a [Point3<C>],
}

/// A patch of either kind, with the degree erased: what scenes and the engine take.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SurfaceNet<'a, C = I16F16> {
    /// A triangular patch.
    Triangle(TriangleNet<'a, C>),
    /// A tensor-product patch.
    Tensor(TensorNet<'a, C>),
    /// A rational triangular patch.
    RationalTriangle(RationalTriangleNet<'a, C>),
    /// A rational tensor-product patch.
    RationalTensor(RationalTensorNet<'a, C>),
}

/// What the nets of a type can be. The renderer leaves out of the image what no net of its scene's type needs: a table of
/// bicubic patches costs no code for triangles, weights or higher degrees.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub struct Shape {
    /// Whether some are triangles.
    pub triangles: bool,
    /// Whether some have weights.
    pub rational: bool,
    /// The highest degree.
    pub degree: usize,
}

impl Shape {
    /// Anything.
    pub const ANY: Self = Self { triangles: true, rational: true, degree: MAX_DEGREE };

    /// Tensor-product or triangular nets, polynomial or rational, of one degree.
    pub(super) const fn of(triangles: bool, rational: bool, degree: usize) -> Self {
        Self { triangles, rational, degree }
    }
}

/// Anything that has a surface net: the nets themselves, views, references to them.
pub trait Surface<C = I16F16> {
    /// What [`surface`](Self::surface) can return; a promise.
    const SHAPE: Shape = Shape::ANY;

    /// The net, borrowed.
    fn surface(&self) -> SurfaceNet<'_, C>;
}

const fn check_degree(degree: usize) -> Result<u8, NetError> {
    if degree == 0 || degree > MAX_DEGREE {
        return Err(NetError::Degree { degree });
    }
    Ok(degree as u8)
}

pub(super) const fn check_count(expected: usize, given: usize) -> Result<(), NetError> {
    if expected != given {
        return Err(NetError::Count { expected, given });
    }
    Ok(())
}

/// The legal range of one coordinate type, checked in constant context.
macro_rules! constant_checks {
    ($coord:ty, $bits:ident, $check:ident) => {
        /// The first coordinate out of range, if any.
        pub(super) const fn $check(points: &[Point3<$coord>]) -> Result<(), NetError> {
            let limit = <$coord as Coord>::LIMIT << <$coord as Coord>::FRACTION_BITS;
            let mut index = 0;
            while index < points.len() {
                let p = &points[index];
                let coordinates = [(Axis::X, $bits(p.x)), (Axis::Y, $bits(p.y)), (Axis::Z, $bits(p.z))];
                let mut c = 0;
                while c < 3 {
                    let (axis, bits) = coordinates[c];
                    if bits > limit || bits < -limit {
                        let units = bits >> <$coord as Coord>::FRACTION_BITS;
                        return Err(NetError::OutOfRange { index, axis, units, limit: <$coord as Coord>::LIMIT });
                    }
                    c += 1;
                }
                index += 1;
            }
            Ok(())
        }
    };
}

constant_checks!(I16F16, bits_i16f16, check_range_i16f16);
constant_checks!(I32F32, bits_i32f32, check_range_i32f32);

/// The same check where the coordinate type is generic.
pub(super) fn check_range<C: Coord>(points: &[Point3<C>]) -> Result<(), NetError> {
    for (index, p) in points.iter().enumerate() {
        for (axis, c) in Axis::ALL.into_iter().zip(p.to_array()) {
            if !c.is_legal() {
                let units = c.bits() >> C::FRACTION_BITS;
                return Err(NetError::OutOfRange { index, axis, units, limit: C::LIMIT });
            }
        }
    }
    Ok(())
}

impl<'a, C: Coord> CurveNet<'a, C> {
    /// The curve through these control points, of degree `points.len() - 1`.
    ///
    /// # Errors
    /// [`NetError`] for no points, a degree outside 1 ..= 8 or a coordinate out of range.
    pub fn new(points: &'a [Point3<C>]) -> Result<Self, NetError> {
        check_degree(points.len().checked_sub(1).ok_or(NetError::Count { expected: 2, given: 0 })?)?;
        check_range(points)?;
        Ok(Self { points })
    }

    pub(crate) const fn of_checked(points: &'a [Point3<C>]) -> Self {
        Self { points }
    }

    /// The degree, 1 ..= 8.
    #[must_use]
    pub const fn degree(&self) -> usize {
        self.points.len() - 1
    }

    /// The control points.
    #[must_use]
    pub const fn points(&self) -> &'a [Point3<C>] {
        self.points
    }
}

impl<'a, C: Coord> TriangleNet<'a, C> {
    /// The triangular patch of this degree; b\[n,0,0\] first, b\[0,0,n\] last.
    ///
    /// # Errors
    /// [`NetError`] for a degree outside 1 ..= 8, a wrong number of points, or a coordinate out of range.
    pub fn new(degree: usize, points: &'a [Point3<C>]) -> Result<Self, NetError> {
        let checked = check_degree(degree)?;
        check_count(triangle_len(degree), points.len())?;
        check_range(points)?;
        Ok(Self { degree: checked, points })
    }

    pub(crate) const fn of_checked(degree: usize, points: &'a [Point3<C>]) -> Self {
        Self { degree: degree as u8, points }
    }

    /// The degree, 1 ..= 8.
    #[must_use]
    pub const fn degree(&self) -> usize {
        self.degree as usize
    }

    /// The control points in storage order.
    #[must_use]
    pub const fn points(&self) -> &'a [Point3<C>] {
        self.points
    }
}

impl<'a, C: Coord> TensorNet<'a, C> {
    /// The tensor-product patch of degrees (m, h): (m+1)(h+1) points, the second index running fastest.
    ///
    /// # Errors
    /// [`NetError`] for a degree outside 1 ..= 8, a wrong number of points, or a coordinate out of range.
    pub fn new(degrees: (usize, usize), points: &'a [Point3<C>]) -> Result<Self, NetError> {
        let checked = (check_degree(degrees.0)?, check_degree(degrees.1)?);
        check_count((degrees.0 + 1) * (degrees.1 + 1), points.len())?;
        check_range(points)?;
        Ok(Self { degrees: checked, points })
    }

    pub(crate) const fn of_checked(degrees: (usize, usize), points: &'a [Point3<C>]) -> Self {
        Self { degrees: (degrees.0 as u8, degrees.1 as u8), points }
    }

    /// The degrees (m, h), each 1 ..= 8.
    #[must_use]
    pub const fn degrees(&self) -> (usize, usize) {
        (self.degrees.0 as usize, self.degrees.1 as usize)
    }

    /// The control points in storage order.
    #[must_use]
    pub const fn points(&self) -> &'a [Point3<C>] {
        self.points
    }
}

impl<'a, C: Coord> SurfaceNet<'a, C> {
    /// The control points in storage order.
    #[must_use]
    pub const fn points(&self) -> &'a [Point3<C>] {
        match self {
            Self::Triangle(net) => net.points(),
            Self::Tensor(net) => net.points(),
            Self::RationalTriangle(net) => net.points(),
            Self::RationalTensor(net) => net.points(),
        }
    }

    /// The weights in storage order; `None` for a polynomial patch.
    #[must_use]
    pub const fn weights(&self) -> Option<&'a [I16F16]> {
        match self {
            Self::Triangle(_) | Self::Tensor(_) => None,
            Self::RationalTriangle(net) => Some(net.weights()),
            Self::RationalTensor(net) => Some(net.weights()),
        }
    }

    /// The degrees in the two directions; (n, n) for a triangle.
    #[must_use]
    pub const fn degrees(&self) -> (usize, usize) {
        match self {
            Self::Triangle(net) => (net.degree(), net.degree()),
            Self::Tensor(net) => net.degrees(),
            Self::RationalTriangle(net) => (net.control_net().degree(), net.control_net().degree()),
            Self::RationalTensor(net) => net.control_net().degrees(),
        }
    }

    /// Whether the domain is a triangle.
    #[must_use]
    pub const fn is_triangle(&self) -> bool {
        matches!(self, Self::Triangle(_) | Self::RationalTriangle(_))
    }

    /// The net without its weights.
    #[must_use]
    pub const fn control_net(&self) -> Self {
        match self {
            Self::Triangle(net) => Self::Triangle(*net),
            Self::Tensor(net) => Self::Tensor(*net),
            Self::RationalTriangle(net) => Self::Triangle(net.control_net()),
            Self::RationalTensor(net) => Self::Tensor(net.control_net()),
        }
    }

    /// The box of the control points, which holds the whole patch.
    #[must_use]
    pub fn bounds(&self) -> Bounds<C> {
        bounds_of(self.points())
    }
}

/// The box of a net's points. A net is never empty.
pub(super) fn bounds_of<C: Coord>(points: &[Point3<C>]) -> Bounds<C> {
    let zero = Point3::new(C::ZERO, C::ZERO, C::ZERO);
    Bounds::of(points).unwrap_or(Bounds { min: zero, max: zero })
}

impl<C: Coord> Surface<C> for SurfaceNet<'_, C> {
    fn surface(&self) -> SurfaceNet<'_, C> {
        *self
    }
}

impl<C: Coord, S: Surface<C> + ?Sized> Surface<C> for &S {
    const SHAPE: Shape = S::SHAPE;

    fn surface(&self) -> SurfaceNet<'_, C> {
        (**self).surface()
    }
}
