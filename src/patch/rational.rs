//! Rational nets: a polynomial net and a positive weight per control point.
//!
//! The patch is Σ w_i B_i P_i / Σ w_i B_i. Only ratios of weights matter.

use super::{
    Curve, NetError, RationalCurveNet, RationalTensorNet, RationalTriangleNet, Shape, Surface, SurfaceNet, Tensor,
    Triangle,
};
use crate::geometry::{Affine, GeometryError, Perspective, Point3};
use crate::num::{Coord, I16F16};

/// The first weight that is not positive, if any.
pub(super) const fn check_weights(weights: &[I16F16]) -> Result<(), NetError> {
    let mut index = 0;
    while index < weights.len() {
        let bits = weights[index].to_bits();
        if bits <= 0 {
            return Err(NetError::Weight { index, bits });
        }
        index += 1;
    }
    Ok(())
}

/// A rational curve of order `K`.
///
/// ```
/// use embedded_surfaces::num::I16F16;
/// use embedded_surfaces::patch::{Parameter, QuadraticCurve, RationalCurve};
/// // A quarter circle of radius 100, with the weights 1, 1, 2.
/// let net = QuadraticCurve::from_ints([[100, 0, 0], [100, 100, 0], [0, 100, 0]])?;
/// let arc = RationalCurve::new(net, [1, 1, 2].map(I16F16::from_num))?;
/// let p = arc.net().eval(Parameter::HALF); // (60, 80): 3-4-5
/// assert_eq!((p.x, p.y), (I16F16::from_num(60), I16F16::from_num(80)));
/// # Ok::<(), embedded_surfaces::patch::NetError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct RationalCurve<const K: usize, C = I16F16> {
    pub(crate) net: Curve<K, C>,
    pub(crate) weights: [I16F16; K],
}

/// A rational triangular patch of degree `N` with `LEN` control points.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct RationalTriangle<const N: usize, const LEN: usize, C = I16F16> {
    pub(crate) net: Triangle<N, LEN, C>,
    pub(crate) weights: [I16F16; LEN],
}

/// A rational tensor-product patch of orders `M` × `H`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct RationalTensor<const M: usize, const H: usize, C = I16F16> {
    pub(crate) net: Tensor<M, H, C>,
    pub(crate) weights: [[I16F16; H]; M],
}

impl<const K: usize, C: Coord> RationalCurve<K, C> {
    /// The curve with these control points and weights; also in constant context.
    ///
    /// # Errors
    /// [`NetError::Weight`] for the first weight that is not positive.
    pub const fn new(net: Curve<K, C>, weights: [I16F16; K]) -> Result<Self, NetError> {
        match check_weights(&weights) {
            Ok(()) => Ok(Self { net, weights }),
            Err(error) => Err(error),
        }
    }

    /// The control points and weights, borrowed, with the degree erased.
    #[must_use]
    pub const fn net(&self) -> RationalCurveNet<'_, C> {
        RationalCurveNet::of_checked(self.net.net(), &self.weights)
    }

    /// The weights, all positive.
    #[must_use]
    pub const fn weights(&self) -> &[I16F16; K] {
        &self.weights
    }

    /// The image under an affine map; weights stay.
    ///
    /// # Errors
    /// [`GeometryError::OutOfRange`] where a control point leaves the legal range.
    pub fn transform(&self, map: &Affine) -> Result<Self, GeometryError> {
        Ok(Self { net: self.net.transform(map)?, weights: self.weights })
    }
}

impl<const N: usize, const LEN: usize, C: Coord> RationalTriangle<N, LEN, C> {
    /// The patch with these control points and weights; also in constant context.
    ///
    /// # Errors
    /// [`NetError::Weight`] for the first weight that is not positive.
    pub const fn new(net: Triangle<N, LEN, C>, weights: [I16F16; LEN]) -> Result<Self, NetError> {
        match check_weights(&weights) {
            Ok(()) => Ok(Self { net, weights }),
            Err(error) => Err(error),
        }
    }

    /// The control points and weights, borrowed, with the degree erased.
    #[must_use]
    pub const fn net(&self) -> RationalTriangleNet<'_, C> {
        RationalTriangleNet::of_checked(self.net.net(), &self.weights)
    }

    /// The weights in storage order, all positive.
    #[must_use]
    pub const fn weights(&self) -> &[I16F16; LEN] {
        &self.weights
    }

    /// The image under an affine map; weights stay.
    ///
    /// # Errors
    /// [`GeometryError::OutOfRange`] where a control point leaves the legal range.
    pub fn transform(&self, map: &Affine) -> Result<Self, GeometryError> {
        Ok(Self { net: self.net.transform(map)?, weights: self.weights })
    }
}

impl<const M: usize, const H: usize, C: Coord> RationalTensor<M, H, C> {
    /// The patch with these control points and weights; also in constant context.
    ///
    /// # Errors
    /// [`NetError::Weight`] for the first weight that is not positive.
    pub const fn new(net: Tensor<M, H, C>, weights: [[I16F16; H]; M]) -> Result<Self, NetError> {
        match check_weights(weights.as_flattened()) {
            Ok(()) => Ok(Self { net, weights }),
            Err(error) => Err(error),
        }
    }

    /// The control points and weights, borrowed, with the degree erased.
    #[must_use]
    pub const fn net(&self) -> RationalTensorNet<'_, C> {
        RationalTensorNet::of_checked(self.net.net(), self.weights.as_flattened())
    }

    /// The weights, `weights[i][j]`, all positive.
    #[must_use]
    pub const fn weights(&self) -> &[[I16F16; H]; M] {
        &self.weights
    }

    /// The image under an affine map; weights stay.
    ///
    /// # Errors
    /// [`GeometryError::OutOfRange`] where a control point leaves the legal range.
    pub fn transform(&self, map: &Affine) -> Result<Self, GeometryError> {
        Ok(Self { net: self.net.transform(map)?, weights: self.weights })
    }
}

impl<const N: usize, const LEN: usize, C: Coord> Surface<C> for RationalTriangle<N, LEN, C> {
    const SHAPE: Shape = Shape::of(true, true, N);

    fn surface(&self) -> SurfaceNet<'_, C> {
        SurfaceNet::RationalTriangle(self.net())
    }
}

impl<const M: usize, const H: usize, C: Coord> Surface<C> for RationalTensor<M, H, C> {
    const SHAPE: Shape = Shape::of(false, true, if M > H { M - 1 } else { H - 1 });

    fn surface(&self) -> SurfaceNet<'_, C> {
        SurfaceNet::RationalTensor(self.net())
    }
}

/// Projects all points; each weight becomes D + z.
fn project(
    view: &Perspective,
    points: &[Point3],
    mut store: impl FnMut(usize, Point3, I16F16),
) -> Result<(), GeometryError> {
    for (index, point) in points.iter().enumerate() {
        let (image, weight) = view.project(point)?;
        store(index, image, weight);
    }
    Ok(())
}

impl<const K: usize> Curve<K> {
    /// The perspective view: a rational curve.
    ///
    /// # Errors
    /// [`GeometryError`] where a control point is behind the eye or leaves the legal range.
    pub fn perspective(&self, view: &Perspective) -> Result<RationalCurve<K>, GeometryError> {
        let mut out = RationalCurve { net: *self, weights: [I16F16::ONE; K] };
        project(view, &self.points, |i, point, weight| (out.net.points[i], out.weights[i]) = (point, weight))?;
        Ok(out)
    }
}

impl<const N: usize, const LEN: usize> Triangle<N, LEN> {
    /// The perspective view: a rational patch.
    ///
    /// # Errors
    /// [`GeometryError`] where a control point is behind the eye or leaves the legal range.
    pub fn perspective(&self, view: &Perspective) -> Result<RationalTriangle<N, LEN>, GeometryError> {
        let mut out = RationalTriangle { net: *self, weights: [I16F16::ONE; LEN] };
        project(view, &self.points, |i, point, weight| (out.net.points[i], out.weights[i]) = (point, weight))?;
        Ok(out)
    }
}

impl<const M: usize, const H: usize> Tensor<M, H> {
    /// The perspective view: a rational patch.
    ///
    /// # Errors
    /// [`GeometryError`] where a control point is behind the eye or leaves the legal range.
    pub fn perspective(&self, view: &Perspective) -> Result<RationalTensor<M, H>, GeometryError> {
        let mut out = RationalTensor { net: *self, weights: [[I16F16::ONE; H]; M] };
        project(view, self.points.as_flattened(), |i, point, weight| {
            (out.net.points[i / H][i % H], out.weights[i / H][i % H]) = (point, weight);
        })?;
        Ok(out)
    }
}
