//! Views of rational nets: a borrowed polynomial net and a positive weight per control point.

use super::net::check_count;
use super::rational::check_weights;
use super::{CurveNet, NetError, TensorNet, TriangleNet};
use crate::geometry::Point3;
use crate::num::{Coord, I16F16};

macro_rules! rational_view {
    ($(#[$doc:meta])* $name:ident, $net:ident) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub struct $name<'a, C = I16F16> {
            net: $net<'a, C>,
            weights: &'a [I16F16],
        }

        impl<'a, C: Coord> $name<'a, C> {
            /// The net with these weights, in the storage order of its points.
            ///
            /// # Errors
            /// [`NetError::Count`] unless there is one weight per point, [`NetError::Weight`] for the first that is
            /// not positive.
            pub const fn new(net: $net<'a, C>, weights: &'a [I16F16]) -> Result<Self, NetError> {
                match (check_count(net.points().len(), weights.len()), check_weights(weights)) {
                    (Ok(()), Ok(())) => Ok(Self { net, weights }),
                    (Err(error), _) | (_, Err(error)) => Err(error),
                }
            }

            pub(crate) const fn of_checked(net: $net<'a, C>, weights: &'a [I16F16]) -> Self {
                Self { net, weights }
            }

            /// The control net alone.
            #[must_use]
            pub const fn control_net(&self) -> $net<'a, C> {
                self.net
            }

            /// The control points in storage order.
            #[must_use]
            pub const fn points(&self) -> &'a [Point3<C>] {
                self.net.points()
            }

            /// The weights in storage order, all positive.
            #[must_use]
            pub const fn weights(&self) -> &'a [I16F16] {
                self.weights
            }
        }
    };
}

rational_view! {
    /// A rational curve.
    RationalCurveNet, CurveNet
}
rational_view! {
    /// A rational triangular patch.
    RationalTriangleNet, TriangleNet
}
rational_view! {
    /// A rational tensor-product patch.
    RationalTensorNet, TensorNet
}
