//! The nets that the calls take, range-checked by the compiler.

#[path = "../data/nets.rs"]
mod nets;

use embedded_surfaces::const_net;
use embedded_surfaces::num::I16F16;
use embedded_surfaces::patch::{
    BicubicPatch, BilinearPatch, CubicCurve, CubicTriangle, QuadraticCurve, QuinticTriangle, RationalCurve,
    RationalTensor, RationalTriangle, Tensor, Triangle,
};

const fn whole<const N: usize>(ints: [i32; N]) -> [I16F16; N] {
    let (mut out, mut k) = ([I16F16::ZERO; N], 0);
    while k < N {
        out[k] = I16F16::const_from_int(ints[k]);
        k += 1;
    }
    out
}

pub(crate) static CUBIC: CubicCurve =
    const_net!(CubicCurve::from_ints([[2, 3, 0], [5, 57, 9], [45, 60, -7], [60, 9, 4]]));

pub(crate) static ARC: RationalCurve<3> = const_net!(RationalCurve::new(
    const_net!(QuadraticCurve::from_ints([[50, 0, 3], [50, 50, 1], [0, 50, 8]])),
    whole([1, 1, 2]),
));

/// The P of Huang and Zhu 2002, at a quarter of its size.
pub(crate) static TRIANGLE: CubicTriangle = const_net!(CubicTriangle::from_ints(nets::quartered(nets::SEED_P)));

pub(crate) static QUINTIC: QuinticTriangle = const_net!(QuinticTriangle::from_ints(nets::QUINTIC));

pub(crate) static WEIGHTED: RationalTriangle<2, 6> = const_net!(RationalTriangle::new(
    const_net!(Triangle::<2, 6>::from_ints([[0, 0, 5], [30, 2, 9], [1, 33, 20], [58, 0, 7], [34, 31, 30], [3, 60, 2]])),
    whole([1, 2, 1, 3, 1, 2]),
));

/// A wave.
pub(crate) static BICUBIC: BicubicPatch = const_net!(BicubicPatch::from_ints([
    [[12, 7, 0], [5, 28, 60], [11, 40, -40], [9, 54, 10]],
    [[24, -3, 35], [24, 21, -50], [27, 43, 80], [22, 59, 0]],
    [[41, 11, -20], [36, 19, 90], [45, 44, -30], [38, 60, 25]],
    [[63, 2, 5], [60, 21, -60], [57, 46, 45], [56, 55, -15]],
]));

/// Across it.
pub(crate) static BILINEAR: BilinearPatch =
    const_net!(BilinearPatch::from_ints([[[3, 30, -20], [8, 62, 40]], [[60, 2, 30], [55, 40, -35]]]));

pub(crate) static UNEVEN: Tensor<2, 4> = const_net!(Tensor::<2, 4>::from_ints([
    [[0, 0, 0], [2, 20, 30], [1, 41, -9], [0, 60, 5]],
    [[50, 3, 8], [47, 22, -4], [55, 44, 26], [49, 58, 0]],
]));

/// An eighth of a ball.
pub(crate) static OCTANT: RationalTensor<3, 3> = const_net!(RationalTensor::new(
    const_net!(Tensor::<3, 3>::from_ints([
        [[40, 0, 0], [40, 0, 40], [0, 0, 40]],
        [[40, 40, 0], [40, 40, 40], [0, 0, 40]],
        [[0, 40, 0], [0, 40, 40], [0, 0, 40]],
    ])),
    [whole([1, 1, 2]), whole([1, 1, 2]), whole([2, 2, 4])],
));
