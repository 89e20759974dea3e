//! Exact and rounded subdivision, and the bounds.

pub(super) mod mesh;

use super::{Digest, Sum, data, hide};
use embedded_surfaces::num::{I16F16, I32F32, Word};
use embedded_surfaces::patch::{
    Curve, CurveNet, RationalCurve, RationalCurveNet, RationalTensor, RationalTriangle, Surface, SurfaceNet, Tensor,
    TensorNet, Triangle, TriangleNet,
};
use embedded_surfaces::subdivide::{
    Direction, Half, Quarter, Tolerance, depth_by_edges, halve_curve, halve_tensor, quarter_triangle,
};

const DIRECTIONS: [Direction; 2] = [Direction::R, Direction::S];

pub(super) fn calls(sum: &mut Sum) {
    exact::<i32>(sum);
    exact::<i64>(sum);
    exact::<i128>(sum);
    rounded(sum);
    for bits in hide([0, 1, 1 << 13, 1 << 16, 5 << 16]) {
        let tolerance = Tolerance::new(I16F16::from_bits(bits));
        sum.add(tolerance.map(Tolerance::get));
        if let Ok(tolerance) = tolerance {
            depths(sum, tolerance);
        }
    }
    differences(sum);
}

#[inline(never)]
fn exact<W: Word + Digest>(sum: &mut Sum) {
    let values: [W; 12] = hide([3, -7, 100, 2, 0, 9, 31, -4, 8, 77, 5, 1]).map(|v| W::truncate(v));
    for half in Half::ALL {
        let mut curve = values;
        halve_curve(&mut curve[..9], half);
        sum.add(curve);
        for (direction, degrees) in DIRECTIONS.into_iter().zip(hide([(2, 3), (1, 1)])) {
            let mut tensor = values;
            halve_tensor(&mut tensor, degrees, direction, half);
            halve_tensor(&mut tensor[..6], hide((2, 1)), direction, half);
            sum.add(tensor);
        }
    }
    for (quarter, degree) in Quarter::ALL.into_iter().zip(hide([3, 3, 3, 3])) {
        let mut triangle = values;
        quarter_triangle(&mut triangle[..10], degree, quarter);
        quarter_triangle(&mut triangle, degree, quarter);
        sum.add(triangle);
    }
}

#[inline(never)]
fn rounded(sum: &mut Sum) {
    sum.add(Curve::subdivide(hide(&data::CUBIC)));
    sum.add(RationalCurve::subdivide(hide(&data::ARC)));
    sum.add(Triangle::subdivide(hide(&data::TRIANGLE)));
    sum.add(RationalTriangle::subdivide(hide(&data::WEIGHTED)));
    sum.add(Tensor::subdivide(hide(&data::UNEVEN)));
    sum.add(RationalTensor::subdivide(hide(&data::OCTANT)));
    for direction in hide(DIRECTIONS) {
        sum.add(Tensor::bisect(hide(&data::BICUBIC), direction));
        sum.add(RationalTensor::bisect(hide(&data::OCTANT), direction));
    }
}

#[inline(never)]
fn depths(sum: &mut Sum, tolerance: Tolerance) {
    let (cubic, arc) = (hide(&data::CUBIC).net(), hide(&data::ARC).net());
    sum.add((CurveNet::depth_for(&cubic, tolerance), CurveNet::is_flat(&cubic, tolerance)));
    sum.add((RationalCurveNet::depth_for(&arc, tolerance), RationalCurveNet::is_flat(&arc, tolerance)));
    for net in surfaces() {
        sum.add((SurfaceNet::depth_for(&net, tolerance), SurfaceNet::is_flat(&net, tolerance)));
        sum.add(SurfaceNet::depths_for(&net, tolerance));
    }
    sum.add(depth_by_edges(&hide([I32F32::ONE, I32F32::from_bits(1 << 50), I32F32::ZERO]), tolerance));
    sum.add(depth_by_edges(hide(&[]), tolerance));
}

#[inline(never)]
fn surfaces() -> [SurfaceNet<'static>; 5] {
    let (triangle, wave, uneven) = hide((&data::TRIANGLE, &data::BICUBIC, &data::UNEVEN));
    let (weighted, octant) = hide((&data::WEIGHTED, &data::OCTANT));
    [triangle.surface(), wave.surface(), uneven.surface(), weighted.surface(), octant.surface()]
}

#[inline(never)]
fn differences(sum: &mut Sum) {
    let (cubic, arc) = (hide(&data::CUBIC).net(), hide(&data::ARC).net());
    sum.add([CurveNet::first_difference(&cubic), CurveNet::second_difference(&cubic)]);
    sum.add([CurveNet::flatness(&cubic), RationalCurveNet::flatness(&arc)]);
    let (triangle, tensor) = (hide(&data::TRIANGLE).net(), hide(&data::UNEVEN).net());
    sum.add((TriangleNet::first_differences(&triangle), TriangleNet::second_differences(&triangle)));
    sum.add((TensorNet::first_differences(&tensor), TensorNet::second_differences(&tensor)));
    sum.add(surfaces().map(|net| SurfaceNet::flatness(&net)));
}
