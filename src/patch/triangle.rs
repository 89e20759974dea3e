//! Triangular Bézier patches that own their control points.

use super::net::{bounds_of, check_range, check_range_i16f16, check_range_i32f32};
use super::{MAX_DEGREE, NetError, Shape, Surface, SurfaceNet, TriangleNet, triangle_index, triangle_len};
use crate::geometry::{Affine, Bounds, GeometryError, Point3};
use crate::num::{Coord, I16F16, I32F32};

/// A triangular Bézier patch of degree `N` in 1 ..= 8 with `LEN` = (N+1)(N+2)/2 control points.
///
/// The points b\[i,j,k\], i + j + k = N, stand with i descending, then j descending: b\[N,0,0\] first, b\[0,0,N\] last.
/// Stable Rust cannot compute `LEN`; use the aliases, or a wrong pair fails to compile:
///
/// ```compile_fail
/// use embedded_surfaces::patch::Triangle;
/// let _ = Triangle::<3, 9>::from_ints([[0; 3]; 9]);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Triangle<const N: usize, const LEN: usize, C = I16F16> {
    pub(crate) points: [Point3<C>; LEN],
}

/// Degree 1.
pub type FlatTriangle = Triangle<1, 3>;
/// Degree 2.
pub type QuadraticTriangle = Triangle<2, 6>;
/// Degree 3.
pub type CubicTriangle = Triangle<3, 10>;
/// Degree 4.
pub type QuarticTriangle = Triangle<4, 15>;
/// Degree 5.
pub type QuinticTriangle = Triangle<5, 21>;

impl<const N: usize, const LEN: usize, C> Triangle<N, LEN, C> {
    /// Fails to compile for a degree outside 1 ..= 8 or a wrong length.
    pub(super) const LEGAL: () = {
        assert!(N >= 1 && N <= MAX_DEGREE, "the degree is outside 1 ..= 8");
        assert!(LEN == triangle_len(N), "LEN is not (N+1)(N+2)/2");
    };
}

impl<const N: usize, const LEN: usize> Triangle<N, LEN> {
    /// The patch with these whole coordinates, one `[x, y, z]` per control point in storage order.
    ///
    /// # Errors
    /// [`NetError::OutOfRange`] for −32768.
    pub const fn from_ints(points: [[i16; 3]; LEN]) -> Result<Self, NetError> {
        let mut out = [Point3::ORIGIN; LEN];
        let mut i = 0;
        while i < LEN {
            let [x, y, z] = points[i];
            out[i] = Point3::from_ints(x, y, z);
            i += 1;
        }
        Self::new(out)
    }

    /// The patch through these control points; also in constant context.
    ///
    /// # Errors
    /// [`NetError::OutOfRange`] for a coordinate outside ±32767.
    pub const fn new(points: [Point3<I16F16>; LEN]) -> Result<Self, NetError> {
        let () = Self::LEGAL;
        match check_range_i16f16(&points) {
            Ok(()) => Ok(Self { points }),
            Err(error) => Err(error),
        }
    }
}

impl<const N: usize, const LEN: usize> Triangle<N, LEN, I32F32> {
    /// The patch through these control points; also in constant context.
    ///
    /// # Errors
    /// [`NetError::OutOfRange`] for a coordinate outside ±2^26.
    pub const fn new(points: [Point3<I32F32>; LEN]) -> Result<Self, NetError> {
        let () = Self::LEGAL;
        match check_range_i32f32(&points) {
            Ok(()) => Ok(Self { points }),
            Err(error) => Err(error),
        }
    }

    /// The nearest patch with `I16F16` coordinates, half up.
    ///
    /// # Errors
    /// [`NetError::OutOfRange`] for a coordinate outside ±32767.
    pub fn round(&self) -> Result<Triangle<N, LEN>, NetError> {
        super::convert::round(&self.points, 0).and_then(Triangle::<N, LEN>::new)
    }
}

impl<const N: usize, const LEN: usize, C: Coord> TryFrom<[Point3<C>; LEN]> for Triangle<N, LEN, C> {
    type Error = NetError;

    fn try_from(points: [Point3<C>; LEN]) -> Result<Self, NetError> {
        let () = Self::LEGAL;
        check_range(&points)?;
        Ok(Self { points })
    }
}

impl<const N: usize, const LEN: usize, C: Coord> Triangle<N, LEN, C> {
    /// The control points in storage order.
    #[must_use]
    pub const fn points(&self) -> &[Point3<C>; LEN] {
        &self.points
    }

    /// b\[i,j,k\]; `None` unless i + j + k = N.
    #[must_use]
    pub fn point(&self, i: usize, j: usize, k: usize) -> Option<&Point3<C>> {
        let exists = i <= N && j <= N && k <= N && i + j + k == N;
        if exists { self.points.get(triangle_index(j, k)) } else { None }
    }

    /// The patch, borrowed, with the degree erased.
    #[must_use]
    pub const fn net(&self) -> TriangleNet<'_, C> {
        TriangleNet::of_checked(N, &self.points)
    }

    /// The box of the control points, which holds the whole patch.
    #[must_use]
    pub fn bounds(&self) -> Bounds<C> {
        bounds_of(&self.points)
    }

    /// The image under an affine map, each control point rounded once, half up.
    ///
    /// # Errors
    /// [`GeometryError::OutOfRange`] where a control point leaves the legal range.
    pub fn transform(&self, map: &Affine) -> Result<Self, GeometryError> {
        let mut points = self.points;
        for p in &mut points {
            *p = map.apply(p)?;
        }
        Ok(Self { points })
    }
}

impl<const N: usize, const LEN: usize, C: Coord> Surface<C> for Triangle<N, LEN, C> {
    const SHAPE: Shape = Shape::of(true, false, N);

    fn surface(&self) -> SurfaceNet<'_, C> {
        SurfaceNet::Triangle(self.net())
    }
}
