//! Control nets up to degree 8, their exact values, derivatives and changes of form.
//!
//! In come control points; out go nets that were checked once (degree, count, legal range), so that nothing later
//! can overflow. Concrete nets own their points and can be `const` tables in flash; *views* ([`CurveNet`],
//! [`TriangleNet`], [`TensorNet`], [`SurfaceNet`]) borrow them with the degree erased, and every algorithm is
//! written once, over views.
//!
//! | net | parameters | points |
//! |---|---|---|
//! | [`Curve`] of order K (degree K − 1) | t | `points[i]`, weight C(m,i) t^i (1−t)^(m−i) |
//! | [`Triangle`] of degree n | barycentric u, v, w | b\[i,j,k\], i+j+k = n, i descending, then j descending |
//! | [`Tensor`] of orders M × H (degrees m = M − 1, h = H − 1) | r, s | `points[i][j]`, weight B_i^m(r) B_j^h(s) |
//!
//! The rational ones ([`RationalCurve`], [`RationalTriangle`], [`RationalTensor`]) add a positive weight per point.
//!
//! ```
//! use embedded_surfaces::patch::{Barycentric, CubicTriangle};
//!
//! // Range-checked by the compiler, stored in flash.
//! static P: CubicTriangle = embedded_surfaces::const_net!(CubicTriangle::from_ints([
//!     [180, 20, 150],
//!     [100, 60, 100], [200, 180, 380],
//!     [100, 120, 160], [160, 140, 400], [300, 120, 100],
//!     [40, 200, 60], [200, 200, 360], [100, 220, 60], [300, 200, 300],
//! ]));
//! let corner = P.net().eval(Barycentric::new(0, 0, 1)?);
//! assert_eq!(corner, P.points()[9]);
//! # Ok::<(), embedded_surfaces::patch::NetError>(())
//! ```

#![doc = include_str!("../../docs/img/shapes.md")]
//!
//! *Rational patches with the weights 1, 1, 2: [`sphere`], [`cylinder`], [`cone`], [`torus`].*

mod convert;
mod coons;
mod curve;
mod error;
mod eval;
mod exact;
#[cfg(feature = "defmt")]
mod format;
mod hermite;
mod net;
mod parameter;
pub mod quadrics;
mod rational;
mod rational_net;
pub mod spline;
mod tensor;
mod triangle;

pub use coons::CoonsBoundary;
pub use curve::{CubicCurve, Curve, QuadraticCurve};
pub use error::NetError;
pub use hermite::HermiteCorner;
pub use net::{CurveNet, Shape, Surface, SurfaceNet, TensorNet, TriangleNet};
pub use parameter::{Barycentric, Parameter};
pub use quadrics::{Dimension, cone, cylinder, sphere, torus};
pub use rational::{RationalCurve, RationalTensor, RationalTriangle};
pub use rational_net::{RationalCurveNet, RationalTensorNet, RationalTriangleNet};
pub use spline::{BSplineCurve, BSplineSurface, KnotVector, NurbsCurve, NurbsSurface, Pieces, Spline, SplineError};
pub use tensor::{BicubicPatch, BilinearPatch, BiquadraticPatch, BiquinticPatch, Tensor};
pub use triangle::{CubicTriangle, FlatTriangle, QuadraticTriangle, QuarticTriangle, QuinticTriangle, Triangle};

/// The highest degree of a net, in each direction.
pub const MAX_DEGREE: usize = 8;

/// Evaluates a fallible constructor at compile time: the net, or a compile error.
///
/// ```
/// use embedded_surfaces::{const_net, patch::CubicCurve};
/// const ARC: CubicCurve = const_net!(CubicCurve::from_ints([[0, 0, 0], [0, 55, 0], [45, 100, 0], [100, 100, 0]]));
/// assert_eq!(ARC.points().len(), 4);
/// ```
///
/// A coordinate out of range does not compile:
///
/// ```compile_fail
/// use embedded_surfaces::{const_net, patch::CubicCurve};
/// const ARC: CubicCurve = const_net!(CubicCurve::from_ints([[0, 0, 0], [0, 55, 0], [45, 99, 0], [-32768, 100, 0]]));
/// # let _ = ARC;
/// ```
#[macro_export]
macro_rules! const_net {
    ($constructor:expr) => {
        const {
            match $constructor {
                Ok(net) => net,
                Err(_) => ::core::panic!("the control net is not legal"),
            }
        }
    };
}

/// Points of a triangular net of this degree: (n+1)(n+2)/2.
pub(crate) const fn triangle_len(degree: usize) -> usize {
    (degree + 1) * (degree + 2) / 2
}

/// Where b\[i,j,k\] of a triangular net stands, from j + k and k: i descending, then j descending.
pub(crate) const fn triangle_index(j: usize, k: usize) -> usize {
    (j + k) * (j + k + 1) / 2 + k
}
