//! Exact points at dyadic parameters, in the narrowest integers that hold them.
//!
//! A de Casteljau step at p / 2^e replaces neighbours a, b by 2^e a + p (b − a), so a degree costs e bits. All widths
//! give the same bits: the exact point, rounded once.

use super::cell::{FINE, Fine};
use crate::geometry::Point3;
use crate::num::{Coord, I16F16, Word, div_half_up, shift_half_up};
use crate::patch::{Barycentric, MAX_DEGREE, Parameter, SurfaceNet, triangle_len};

/// c / 2^16 in lowest terms.
pub(super) fn dyadic(c: i32) -> Parameter {
    let (numerator, exponent) = reduced(c);
    Parameter::new(numerator as u32, 1 << exponent).unwrap_or(Parameter::ZERO)
}

/// c / 2^16 as numerator and exponent, in lowest terms.
fn reduced(c: i32) -> (i64, u32) {
    let shift = (c as u32 | 1 << FINE).trailing_zeros();
    (i64::from(c >> shift), FINE - shift)
}

/// (u, v, w) / 2^16 as numerators and the exponent, in lowest terms.
pub(super) fn reduced_barycentric([u, v, w]: Fine) -> ([i64; 3], u32) {
    let shift = (u as u32 | v as u32 | w as u32 | 1 << FINE).trailing_zeros();
    ([u, v, w].map(|c| i64::from(c >> shift)), FINE - shift)
}

/// The exact point of a patch, rounded once, half up.
///
/// Stack: 0.8 KB with `i64`, 1.6 KB with `i128`, and for what exceeds 124 bits that of the patch's own `eval`.
pub(super) fn eval(net: &SurfaceNet<'_>, fine: Fine) -> Point3 {
    let (m, h) = net.degrees();
    let shift = if net.is_triangle() {
        reduced_barycentric(fine).1 * m as u32
    } else {
        reduced(fine[0]).1 * m as u32 + reduced(fine[1]).1 * h as u32
    };
    // Legal coordinates have 32 bits, weights 31; a difference has one more.
    match (net.weights(), shift + if net.weights().is_some() { 64 } else { 33 }) {
        (None, ..=62) => quotient::<i64>(net, fine, shift),
        (_, ..=124) => quotient::<i128>(net, fine, shift),
        _ => wide(net, fine),
    }
}

#[inline(never)]
fn wide(net: &SurfaceNet<'_>, fine: Fine) -> Point3 {
    let barycentric = || {
        let ([u, v, w], _) = reduced_barycentric(fine);
        Barycentric::new(u as u32, v as u32, w as u32)
    };
    match net {
        SurfaceNet::Triangle(net) => barycentric().map_or(Point3::ORIGIN, |at| net.eval(at)),
        SurfaceNet::RationalTriangle(net) => barycentric().map_or(Point3::ORIGIN, |at| net.eval(at)),
        SurfaceNet::Tensor(net) => net.eval(dyadic(fine[0]), dyadic(fine[1])),
        SurfaceNet::RationalTensor(net) => net.eval(dyadic(fine[0]), dyadic(fine[1])),
    }
}

#[inline(never)]
fn quotient<W: Word + Into<i128>>(net: &SurfaceNet<'_>, fine: Fine, shift: u32) -> Point3 {
    let collapse = |axis: Option<usize>| -> i128 {
        if net.is_triangle() { triangle::<W>(net, fine, axis) } else { tensor::<W>(net, fine, axis) }.into()
    };
    let weight = net.weights().map(|_| collapse(None));
    let coordinate = |axis| {
        let sum = collapse(Some(axis));
        let bits = match weight {
            None => shift_half_up(sum, shift),
            // Weights are positive, and a mean of legal points is legal.
            Some(weight) => div_half_up(sum, weight).unwrap_or(0),
        };
        I16F16::from_legal_bits(bits).unwrap_or(I16F16::ZERO)
    };
    Point3::new(coordinate(0), coordinate(1), coordinate(2))
}

/// Control value `index`: a coordinate times its weight, or the weight alone.
fn value<W: Word>(net: &SurfaceNet<'_>, index: usize, axis: Option<usize>) -> W {
    let coordinate = net.points().get(index).map_or(0, |p| match axis {
        Some(0) => p.x.bits(),
        Some(1) => p.y.bits(),
        Some(_) => p.z.bits(),
        None => 1,
    });
    let weight = net.weights().map_or(1, |w| w.get(index).map_or(0, |w| w.bits()));
    W::truncate(coordinate.into()).wrapping_mul_i64(weight)
}

/// Collapses a row to the value at p / 2^e, times 2^(e·degree).
fn row<W: Word>(values: &mut [W], (p, exponent): (i64, u32)) -> W {
    for last in (1..values.len()).rev() {
        for i in 0..last {
            let (Some(&a), Some(&b)) = (values.get(i), values.get(i + 1)) else { return W::ZERO };
            let step = (a << exponent as usize).wrapping_plus(b.wrapping_minus(a).wrapping_mul_i64(p));
            if let Some(value) = values.get_mut(i) {
                *value = step;
            }
        }
    }
    values.first().copied().unwrap_or(W::ZERO)
}

fn tensor<W: Word>(net: &SurfaceNet<'_>, fine: Fine, axis: Option<usize>) -> W {
    let (m, h) = net.degrees();
    let mut column = [W::ZERO; MAX_DEGREE + 1];
    for (i, sum) in column.iter_mut().enumerate().take(m + 1) {
        let mut along = [W::ZERO; MAX_DEGREE + 1];
        for (j, c) in along.iter_mut().enumerate().take(h + 1) {
            *c = value(net, i * (h + 1) + j, axis);
        }
        *sum = along.get_mut(..=h).map_or(W::ZERO, |along| row(along, reduced(fine[1])));
    }
    column.get_mut(..=m).map_or(W::ZERO, |column| row(column, reduced(fine[0])))
}

fn triangle<W: Word>(net: &SurfaceNet<'_>, fine: Fine, axis: Option<usize>) -> W {
    let (n, ([u, v, w], _)) = (net.degrees().0, reduced_barycentric(fine));
    let mut values = [W::ZERO; triangle_len(MAX_DEGREE)];
    for (index, c) in values.iter_mut().enumerate().take(triangle_len(n)) {
        *c = value(net, index, axis);
    }
    for rows in (0..n).rev() {
        let mut index = 0;
        for r in 0..=rows {
            for _ in 0..=r {
                let at = |index: usize| values.get(index).copied().unwrap_or(W::ZERO);
                let (a, b, c) = (at(index), at(index + r + 1), at(index + r + 2));
                let sum =
                    a.wrapping_mul_i64(u).wrapping_plus(b.wrapping_mul_i64(v)).wrapping_plus(c.wrapping_mul_i64(w));
                if let Some(value) = values.get_mut(index) {
                    *value = sum;
                }
                index += 1;
            }
        }
    }
    values[0]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::patch::{RationalTensorNet, RationalTriangleNet, TensorNet, TriangleNet, triangle_len};
    use proptest::prelude::*;
    use std::vec::Vec;

    proptest! {
        #[test]
        fn every_width_gives_the_bits_of_the_widest(
            (m, h) in (1_usize..=8, 1_usize..=8),
            bits in prop::collection::vec((-32767_i32 << 16)..=(32767 << 16), 3 * 81),
            weights in prop::collection::vec(1_i32.., 81),
            (coarse, r, s) in (0_u32..=16, 0_i32..=65536, 0_i32..=65536),
        ) {
            let points: Vec<_> = bits.chunks(3).map(|c| Point3::from_bits(c[0], c[1], c[2])).collect();
            let weights: Vec<_> = weights.into_iter().map(I16F16::from_bits).collect();
            let on_grid = |c: i32| c >> coarse << coarse;
            let (count, length) = ((m + 1) * (h + 1), triangle_len(m));
            let tensor = TensorNet::new((m, h), &points[..count]).unwrap();
            let triangle = TriangleNet::new(m, &points[..length]).unwrap();
            let square = [on_grid(r), on_grid(s), 0];
            let barycentric = [square[0], square[1].min(65536 - square[0]), 65536 - square[0] - square[1].min(65536 - square[0])];
            for (net, fine) in [
                (SurfaceNet::Tensor(tensor), square),
                (SurfaceNet::RationalTensor(RationalTensorNet::new(tensor, &weights[..count]).unwrap()), square),
                (SurfaceNet::Triangle(triangle), barycentric),
                (SurfaceNet::RationalTriangle(RationalTriangleNet::new(triangle, &weights[..length]).unwrap()), barycentric),
            ] {
                prop_assert_eq!(eval(&net, fine), wide(&net, fine));
            }
        }
    }
}
