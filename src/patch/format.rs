//! `defmt::Format` of the nets: derives would ask it of `fixed`'s types, which have it from 1.30 on only.

use super::{
    Curve, CurveNet, RationalCurve, RationalCurveNet, RationalTensor, RationalTensorNet, RationalTriangle,
    RationalTriangleNet, SurfaceNet, Tensor, TensorNet, Triangle, TriangleNet,
};
use crate::num::Coord;
use defmt::{Format, Formatter};

impl<const K: usize, C: Coord> Format for Curve<K, C> {
    fn format(&self, f: Formatter<'_>) {
        self.net().format(f);
    }
}

impl<const N: usize, const LEN: usize, C: Coord> Format for Triangle<N, LEN, C> {
    fn format(&self, f: Formatter<'_>) {
        self.net().format(f);
    }
}

impl<const M: usize, const H: usize, C: Coord> Format for Tensor<M, H, C> {
    fn format(&self, f: Formatter<'_>) {
        self.net().format(f);
    }
}

impl<C: Coord> Format for CurveNet<'_, C> {
    fn format(&self, f: Formatter<'_>) {
        defmt::write!(f, "curve of degree {}: {}", self.degree(), self.points());
    }
}

impl<C: Coord> Format for TriangleNet<'_, C> {
    fn format(&self, f: Formatter<'_>) {
        defmt::write!(f, "triangle of degree {}: {}", self.degree(), self.points());
    }
}

impl<C: Coord> Format for TensorNet<'_, C> {
    fn format(&self, f: Formatter<'_>) {
        defmt::write!(f, "tensor of degrees {}: {}", self.degrees(), self.points());
    }
}

impl<C: Coord> Format for SurfaceNet<'_, C> {
    fn format(&self, f: Formatter<'_>) {
        match self {
            Self::Triangle(net) => net.format(f),
            Self::Tensor(net) => net.format(f),
            Self::RationalTriangle(net) => net.format(f),
            Self::RationalTensor(net) => net.format(f),
        }
    }
}

/// Rational views and the nets that own them.
macro_rules! rational {
    ($view:ident, $net:ident, $($parameter:ident),*) => {
        impl<C: Coord> Format for $view<'_, C> {
            fn format(&self, f: Formatter<'_>) {
                defmt::write!(f, "rational {}, weights in 2^-16: ", self.control_net());
                for weight in self.weights() {
                    defmt::write!(f, "{} ", weight.to_bits());
                }
            }
        }

        impl<$(const $parameter: usize,)* C: Coord> Format for $net<$($parameter,)* C> {
            fn format(&self, f: Formatter<'_>) {
                self.net().format(f);
            }
        }
    };
}

rational!(RationalCurveNet, RationalCurve, K);
rational!(RationalTriangleNet, RationalTriangle, N, LEN);
rational!(RationalTensorNet, RationalTensor, M, H);
