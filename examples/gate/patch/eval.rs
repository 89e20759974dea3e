//! Points, blossoms and derivatives.

use super::super::{Sum, data, hide};
use embedded_surfaces::num::Coord;
use embedded_surfaces::patch::{
    Barycentric, CurveNet, Parameter, RationalCurveNet, RationalTensorNet, RationalTriangleNet, TensorNet, TriangleNet,
};

const PARAMETERS: [(u32, u32); 4] = [(0, 1), (3, 7), (65535, 65536), (1, 1)];
const PLACES: [[u32; 3]; 4] = [[1, 0, 0], [1, 1, 1], [60000, 5000, 536], [0, 2, 3]];

pub(crate) fn calls(sum: &mut Sum) {
    for (numerator, denominator) in hide(PARAMETERS) {
        if let Ok(t) = Parameter::new(numerator, denominator) {
            along(sum, t);
        }
    }
    for [u, v, w] in hide(PLACES) {
        if let Ok(at) = Barycentric::new(u, v, w) {
            inside(sum, at);
        }
    }
}

#[inline(never)]
fn along(sum: &mut Sum, t: Parameter) {
    curve(sum, &hide(&data::CUBIC).net(), t);
    tensor(sum, &hide(&data::UNEVEN).net(), t);
    let net = hide(&data::ARC).net();
    sum.add(RationalCurveNet::eval(&net, t));
    sum.add(RationalCurveNet::derivative(&net, t));
    let net = hide(&data::OCTANT).net();
    sum.add(RationalTensorNet::eval(&net, t, Parameter::HALF));
    sum.add(RationalTensorNet::partials(&net, t, t));
}

#[inline(never)]
fn curve<C: Coord>(sum: &mut Sum, net: &CurveNet<'_, C>, t: Parameter) {
    sum.add(CurveNet::eval(net, t));
    sum.add(CurveNet::derivative(net, t));
    sum.add(CurveNet::blossom(net, &[t, Parameter::HALF, t]));
    sum.add(CurveNet::blossom(net, hide(&[t])));
}

#[inline(never)]
fn tensor<C: Coord>(sum: &mut Sum, net: &TensorNet<'_, C>, t: Parameter) {
    sum.add(TensorNet::eval(net, Parameter::HALF, t));
    sum.add(TensorNet::partials(net, t, t));
    sum.add(TensorNet::blossom(net, &[t], &[t, Parameter::ONE, Parameter::HALF]));
    sum.add(TensorNet::blossom(net, &[t], hide(&[t])));
}

#[inline(never)]
fn inside(sum: &mut Sum, at: Barycentric) {
    triangle(sum, &hide(&data::TRIANGLE).net(), at);
    let net = hide(&data::WEIGHTED).net();
    sum.add(RationalTriangleNet::eval(&net, at));
    sum.add(RationalTriangleNet::partials(&net, at));
}

#[inline(never)]
fn triangle<C: Coord>(sum: &mut Sum, net: &TriangleNet<'_, C>, at: Barycentric) {
    sum.add(TriangleNet::eval(net, at));
    sum.add(TriangleNet::partials(net, at));
    sum.add(TriangleNet::blossom(net, &[at, at, at]));
    sum.add(TriangleNet::blossom(net, hide(&[at; 4])));
}
