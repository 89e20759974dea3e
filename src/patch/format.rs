//! `defmt::Format` of the nets: derives would ask it of `fixed`'s types, which have it from 1.30 on only.

use super::{
    Curve, CurveNet, RationalCurve, RationalTensor, RationalTriangle, SurfaceNet, Tensor, TensorNet, Triangle,
    TriangleNet,
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
        }
    }
}

impl<const K: usize, C: Coord> Format for RationalCurve<K, C> {
    fn format(&self, f: Formatter<'_>) {
        defmt::write!(f, "rational {}, weights {}/2^16", self.net(), self.weights().map(|w| w.to_bits()));
    }
}

impl<const N: usize, const LEN: usize, C: Coord> Format for RationalTriangle<N, LEN, C> {
    fn format(&self, f: Formatter<'_>) {
        defmt::write!(f, "rational {}, weights {}/2^16", self.net(), self.weights().map(|w| w.to_bits()));
    }
}

impl<const M: usize, const H: usize, C: Coord> Format for RationalTensor<M, H, C> {
    fn format(&self, f: Formatter<'_>) {
        let weights = self.weights().map(|row| row.map(|w| w.to_bits()));
        defmt::write!(f, "rational {}, weights {}/2^16", self.net(), weights);
    }
}
