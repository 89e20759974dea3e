//! Tensor-product Bézier patches that own their control points.

use super::net::{bounds_of, check_range, check_range_i16f16, check_range_i32f32};
use super::{MAX_DEGREE, NetError, Shape, Surface, SurfaceNet, TensorNet};
use crate::geometry::{Affine, Bounds, GeometryError, Point3};
use crate::num::{Coord, I16F16, I32F32};

/// A tensor-product Bézier patch of orders `M` × `H`, that is of degrees (M − 1, H − 1), each in 1 ..= 8.
///
/// `points[i][j]` belongs to B_i(r)·B_j(s).
///
/// ```
/// use embedded_surfaces::patch::{BilinearPatch, Parameter};
/// let square = BilinearPatch::from_ints([[[0, 0, 0], [0, 10, 0]], [[10, 0, 0], [10, 10, 4]]])?;
/// let centre = square.net().eval(Parameter::HALF, Parameter::HALF);
/// assert_eq!((centre.x.to_num::<i32>(), centre.z.to_num::<i32>()), (5, 1));
/// # Ok::<(), embedded_surfaces::patch::NetError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Tensor<const M: usize, const H: usize, C = I16F16> {
    pub(crate) points: [[Point3<C>; H]; M],
}

/// Degrees (1, 1).
pub type BilinearPatch = Tensor<2, 2>;
/// Degrees (2, 2).
pub type BiquadraticPatch = Tensor<3, 3>;
/// Degrees (3, 3), 192 bytes.
pub type BicubicPatch = Tensor<4, 4>;
/// Degrees (5, 5).
pub type BiquinticPatch = Tensor<6, 6>;

impl<const M: usize, const H: usize, C> Tensor<M, H, C> {
    /// Fails to compile for a degree outside 1 ..= 8.
    pub(super) const LEGAL: () = {
        assert!(M >= 2 && M <= MAX_DEGREE + 1, "the degree M - 1 is outside 1 ..= 8");
        assert!(H >= 2 && H <= MAX_DEGREE + 1, "the degree H - 1 is outside 1 ..= 8");
    };
}

impl<const M: usize, const H: usize> Tensor<M, H> {
    /// The patch with these whole coordinates, one `[x, y, z]` per control point.
    ///
    /// # Errors
    /// [`NetError::OutOfRange`] for −32768.
    pub const fn from_ints(points: [[[i16; 3]; H]; M]) -> Result<Self, NetError> {
        let mut out = [[Point3::ORIGIN; H]; M];
        let mut i = 0;
        while i < M {
            let mut j = 0;
            while j < H {
                let [x, y, z] = points[i][j];
                out[i][j] = Point3::from_ints(x, y, z);
                j += 1;
            }
            i += 1;
        }
        Self::new(out)
    }

    /// The patch through these control points; also in constant context.
    ///
    /// # Errors
    /// [`NetError::OutOfRange`] for a coordinate outside ±32767.
    pub const fn new(points: [[Point3<I16F16>; H]; M]) -> Result<Self, NetError> {
        let () = Self::LEGAL;
        match check_range_i16f16(points.as_flattened()) {
            Ok(()) => Ok(Self { points }),
            Err(error) => Err(error),
        }
    }
}

impl<const M: usize, const H: usize> Tensor<M, H, I32F32> {
    /// The patch through these control points; also in constant context.
    ///
    /// # Errors
    /// [`NetError::OutOfRange`] for a coordinate outside ±2^26.
    pub const fn new(points: [[Point3<I32F32>; H]; M]) -> Result<Self, NetError> {
        let () = Self::LEGAL;
        match check_range_i32f32(points.as_flattened()) {
            Ok(()) => Ok(Self { points }),
            Err(error) => Err(error),
        }
    }

    /// The nearest patch with `I16F16` coordinates, half up.
    ///
    /// # Errors
    /// [`NetError::OutOfRange`] for a coordinate outside ±32767.
    pub fn round(&self) -> Result<Tensor<M, H>, NetError> {
        let mut points = [[Point3::ORIGIN; H]; M];
        for (i, (out, row)) in points.iter_mut().zip(&self.points).enumerate() {
            *out = super::convert::round(row, i * H)?;
        }
        Tensor::<M, H>::new(points)
    }
}

impl<const M: usize, const H: usize, C: Coord> TryFrom<[[Point3<C>; H]; M]> for Tensor<M, H, C> {
    type Error = NetError;

    fn try_from(points: [[Point3<C>; H]; M]) -> Result<Self, NetError> {
        let () = Self::LEGAL;
        check_range(points.as_flattened())?;
        Ok(Self { points })
    }
}

impl<const M: usize, const H: usize, C: Coord> Tensor<M, H, C> {
    /// The control points, `points[i][j]`.
    #[must_use]
    pub const fn points(&self) -> &[[Point3<C>; H]; M] {
        &self.points
    }

    /// The patch, borrowed, with the degrees erased.
    #[must_use]
    pub const fn net(&self) -> TensorNet<'_, C> {
        TensorNet::of_checked((M - 1, H - 1), self.points.as_flattened())
    }

    /// The box of the control points, which holds the whole patch.
    #[must_use]
    pub fn bounds(&self) -> Bounds<C> {
        bounds_of(self.points.as_flattened())
    }

    /// The image under an affine map, each control point rounded once, half up.
    ///
    /// # Errors
    /// [`GeometryError::OutOfRange`] where a control point leaves the legal range.
    pub fn transform(&self, map: &Affine) -> Result<Self, GeometryError> {
        let mut points = self.points;
        for p in points.as_flattened_mut() {
            *p = map.apply(p)?;
        }
        Ok(Self { points })
    }
}

impl<const M: usize, const H: usize, C: Coord> Surface<C> for Tensor<M, H, C> {
    const SHAPE: Shape = Shape::of(false, false, if M > H { M - 1 } else { H - 1 });

    fn surface(&self) -> SurfaceNet<'_, C> {
        SurfaceNet::Tensor(self.net())
    }
}
