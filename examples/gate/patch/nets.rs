//! Construction, views, maps and conversions of nets, polynomial and rational.

use super::super::{Digest, Sum, data, hide};
use embedded_surfaces::geometry::{Affine, Perspective, Point3};
use embedded_surfaces::num::{Angle, Coord, I16F16, I32F32};
use embedded_surfaces::patch::{
    Curve, CurveNet, NetError, RationalCurve, RationalCurveNet, RationalTensor, RationalTensorNet, RationalTriangle,
    RationalTriangleNet, Surface, SurfaceNet, Tensor, TensorNet, Triangle, TriangleNet,
};

impl<const K: usize, C: Coord> Digest for Curve<K, C> {
    fn digest(&self, sum: &mut Sum) {
        Curve::points(self).digest(sum);
    }
}

impl<const N: usize, const LEN: usize, C: Coord> Digest for Triangle<N, LEN, C> {
    fn digest(&self, sum: &mut Sum) {
        Triangle::points(self).digest(sum);
    }
}

impl<const M: usize, const H: usize, C: Coord> Digest for Tensor<M, H, C> {
    fn digest(&self, sum: &mut Sum) {
        Tensor::points(self).digest(sum);
    }
}

impl<const K: usize> Digest for RationalCurve<K> {
    fn digest(&self, sum: &mut Sum) {
        (RationalCurveNet::points(&RationalCurve::net(self)), RationalCurve::weights(self)).digest(sum);
    }
}

impl<const N: usize, const LEN: usize> Digest for RationalTriangle<N, LEN> {
    fn digest(&self, sum: &mut Sum) {
        (RationalTriangleNet::points(&RationalTriangle::net(self)), RationalTriangle::weights(self)).digest(sum);
    }
}

impl<const M: usize, const H: usize> Digest for RationalTensor<M, H> {
    fn digest(&self, sum: &mut Sum) {
        (RationalTensorNet::points(&RationalTensor::net(self)), RationalTensor::weights(self)).digest(sum);
    }
}

/// A map that fits, and one that leaves every range.
#[inline(never)]
fn maps() -> [Affine; 2] {
    let turn = Affine::rotation_z(Angle::from_degrees(hide(31)));
    [turn, Affine { rows: [[hide(I32F32::MAX); 4]; 3] }]
}

fn eyes() -> [Perspective; 2] {
    let eye = |distance| Perspective { centre_x: I16F16::ZERO, centre_y: I16F16::ZERO, distance };
    hide([500, 20]).map(|distance| eye(I16F16::from_num(distance)))
}

fn wide(p: Point3) -> Point3<I32F32> {
    p.into()
}

pub(crate) fn calls(sum: &mut Sum) {
    curves(sum);
    triangles(sum);
    tensors(sum);
    views(sum);
    rational(sum);
    surfaces(sum);
    parameters(sum);
}

#[inline(never)]
fn curves(sum: &mut Sum) {
    for x in hide([7, i16::MIN]) {
        sum.add(Curve::from_ints([[0, 0, 0], [x, 55, 1], [100, 100, 3]]));
        sum.add(Curve::<2>::new([Point3::from_ints(x, 1, 2), Point3::from_ints(3, 4, 5)]));
        sum.add(Curve::<2>::try_from([Point3::from_ints(3, 4, 5), Point3::from_ints(6, 7, x)]));
    }
    let curve = hide(&data::CUBIC);
    for end in hide([0, 1 << 25, 1 << 27]) {
        let end = Point3::new(I32F32::from_num(end), I32F32::ZERO, I32F32::ONE);
        let [a, b, c, _] = curve.points().map(wide);
        let net = Curve::<4, I32F32>::new([a, b, c, end]);
        sum.add(net);
        sum.add(net.and_then(|net| Curve::<4, I32F32>::round(&net)));
    }
    sum.add(CurveNet::points(&Curve::net(curve)));
    sum.add(Curve::bounds(curve));
    sum.add(Curve::elevate::<7>(curve));
    sum.add(Curve::elevate::<3>(curve));
    sum.add(Curve::from_power(curve.points()));
    sum.add(Curve::from_power(&[Point3::from_ints(hide(32767), 0, 0); 4]));
    maps().iter().for_each(|map| sum.add(Curve::transform(curve, map)));
    eyes().iter().for_each(|eye| sum.add(Curve::perspective(curve, eye)));
}

#[inline(never)]
fn triangles(sum: &mut Sum) {
    for x in hide([7, i16::MIN]) {
        sum.add(Triangle::<1, 3>::from_ints([[0, 0, 0], [x, 55, 1], [100, 100, 3]]));
        let points = [[x, 1, 2], [3, 4, 5], [6, x, 8]].map(|[x, y, z]| Point3::from_ints(x, y, z));
        sum.add(Triangle::<1, 3>::new(points));
        sum.add(Triangle::<1, 3>::try_from(points));
    }
    let patch = hide(&data::TRIANGLE);
    for end in hide([0, 1 << 25, 1 << 27]) {
        let mut points = patch.points().map(wide);
        points[9].y = I32F32::from_num(end);
        let net = Triangle::<3, 10, I32F32>::new(points);
        sum.add(net);
        sum.add(net.and_then(|net| Triangle::<3, 10, I32F32>::round(&net)));
    }
    for [i, j, k] in hide([[3, 0, 0], [1, 1, 1], [0, 3, 0], [2, 2, 0], [usize::MAX, 4, 0]]) {
        sum.add(Triangle::point(patch, i, j, k));
    }
    sum.add(TriangleNet::points(&Triangle::net(patch)));
    sum.add(Triangle::bounds(patch));
    sum.add(Triangle::elevate::<5, 21>(patch));
    sum.add(Triangle::elevate::<2, 6>(patch));
    maps().iter().for_each(|map| sum.add(Triangle::transform(patch, map)));
    eyes().iter().for_each(|eye| sum.add(Triangle::perspective(patch, eye)));
}

#[inline(never)]
fn tensors(sum: &mut Sum) {
    for x in hide([7, i16::MIN]) {
        sum.add(Tensor::from_ints([[[0, 0, 0], [x, 55, 1]], [[100, 100, 3], [4, 5, 6]]]));
        let points = [[[x, 1, 2], [3, 4, 5]], [[6, x, 8], [1, 1, 1]]];
        let points = points.map(|row| row.map(|[x, y, z]| Point3::from_ints(x, y, z)));
        sum.add(Tensor::<2, 2>::new(points));
        sum.add(Tensor::<2, 2>::try_from(points));
    }
    let patch = hide(&data::UNEVEN);
    for end in hide([0, 1 << 25, 1 << 27]) {
        let mut points = patch.points().map(|row| row.map(wide));
        points[1][3].z = I32F32::from_num(end);
        let net = Tensor::<2, 4, I32F32>::new(points);
        sum.add(net);
        sum.add(net.and_then(|net| Tensor::<2, 4, I32F32>::round(&net)));
    }
    sum.add(TensorNet::points(&Tensor::net(patch)));
    sum.add(Tensor::bounds(patch));
    sum.add(Tensor::elevate::<3, 6>(patch));
    sum.add(Tensor::elevate::<3, 3>(patch));
    sum.add(Tensor::from_power(patch.points()));
    sum.add(Tensor::from_power(&[[Point3::from_ints(hide(32767), 0, 0); 2]; 2]));
    maps().iter().for_each(|map| sum.add(Tensor::transform(patch, map)));
    eyes().iter().for_each(|eye| sum.add(Tensor::perspective(patch, eye)));
}

#[inline(never)]
fn views(sum: &mut Sum) {
    let points = hide(&[[0, 0, 0], [9, 1, 8], [3, 33, 9], [17, 22, 20], [21, 5, 2], [30, 40, 50]])
        .map(|[x, y, z]| Point3::from_ints(x, y, z));
    let narrow: &[Point3] = &points;
    for count in hide([0, 1, 4, 6]) {
        let part = narrow.get(..count).unwrap_or(narrow);
        sum.add(CurveNet::new(part).map(|net| (CurveNet::degree(&net), net.points())));
        sum.add(TriangleNet::new(hide(2), part).map(|net| (TriangleNet::degree(&net), net.points())));
        sum.add(TensorNet::new(hide((1, 2)), part).map(|net| {
            let (m, h) = TensorNet::degrees(&net);
            ((m, h), net.points())
        }));
    }
    sum.add(TriangleNet::new(hide(0xffff_ffff), narrow).map(|net| net.degree()));
    sum.add(TensorNet::new(hide((0xffff_ffff, 9)), narrow).map(|net| net.degrees()));
    let far = [Point3::from_ints(0, hide(i16::MIN), 0); 2];
    sum.add(CurveNet::new(&far).map(|net| net.degree()));
}

#[inline(never)]
fn rational(sum: &mut Sum) {
    let (curve, triangle, tensor) = hide((&data::CUBIC, &data::TRIANGLE, &data::UNEVEN));
    for weight in hide([1, -3]) {
        let weights = [I16F16::from_num(weight); 10];
        sum.add(RationalCurve::new(*curve, [weights[0]; 4]));
        sum.add(RationalTriangle::new(*triangle, weights));
        sum.add(RationalTensor::new(*tensor, [[weights[0]; 4]; 2]));
        for count in hide([4, 8, 10]) {
            let weights = weights.get(..count).unwrap_or(&[]);
            let net = RationalCurveNet::new(curve.net(), weights);
            sum.add(net.map(|net| (net.points(), RationalCurveNet::weights(&net))));
            sum.add(net.map(|net| RationalCurveNet::control_net(&net).degree()));
            let net = RationalTriangleNet::new(triangle.net(), weights);
            sum.add(net.map(|net| (net.points(), RationalTriangleNet::weights(&net))));
            sum.add(net.map(|net| RationalTriangleNet::control_net(&net).degree()));
            let net = RationalTensorNet::new(tensor.net(), weights);
            sum.add(net.map(|net| (net.points(), RationalTensorNet::weights(&net))));
            sum.add(net.map(|net| RationalTensorNet::control_net(&net).degrees()));
        }
    }
    let (curve, triangle, tensor) = hide((&data::ARC, &data::WEIGHTED, &data::OCTANT));
    for map in &maps() {
        sum.add(RationalCurve::transform(curve, map));
        sum.add(RationalTriangle::transform(triangle, map));
        sum.add(RationalTensor::transform(tensor, map));
    }
}

#[inline(never)]
fn surfaces(sum: &mut Sum) {
    let nets: [SurfaceNet<'_>; 4] = [
        Surface::surface(hide(&data::TRIANGLE)),
        Surface::surface(hide(&data::UNEVEN)),
        Surface::surface(hide(&data::WEIGHTED)),
        Surface::surface(hide(&data::OCTANT)),
    ];
    for net in &nets {
        sum.add((SurfaceNet::points(net), SurfaceNet::weights(net)));
        sum.add((SurfaceNet::degrees(net), SurfaceNet::is_triangle(net)));
        sum.add(SurfaceNet::control_net(net).weights());
        sum.add(SurfaceNet::bounds(net));
        sum.add(Surface::surface(&net).points());
    }
}

#[inline(never)]
fn parameters(sum: &mut Sum) {
    use embedded_surfaces::patch::{Barycentric, Parameter};
    for (a, b) in hide([(0, 1), (3, 7), (65536, 65536), (1, 65537), (2, 1), (0, 0)]) {
        sum.add(Parameter::new(a, b).map(|p| (Parameter::numerator(p), Parameter::denominator(p))));
        sum.add(Barycentric::new(a, b, a).map(|p| (Barycentric::weights(p), Barycentric::denominator(p))));
    }
    sum.add(Err::<(), _>(hide(NetError::Degree { degree: 9 })));
}
