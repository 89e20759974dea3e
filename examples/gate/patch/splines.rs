//! Knots and splines; their pieces, by number and in turn.

use super::super::{Sum, data, hide};
use embedded_surfaces::geometry::Point3;
use embedded_surfaces::num::I16F16;
use embedded_surfaces::patch::{
    BSplineCurve, BSplineSurface, KnotVector, NurbsCurve, NurbsSurface, Spline, SplineError,
};

const WEIGHTS: [i32; 10] = [1, 3, 2, 1, 1, 2, 5, 1, 4, 1];

pub(crate) fn calls(sum: &mut Sum) {
    knots(sum);
    let points = hide(&data::TRIANGLE).points();
    let weights = hide(WEIGHTS).map(I16F16::from_num);
    for count in hide([4, 7, 10, 0]) {
        let (points, weights) = (points.get(..count).unwrap_or(&[]), weights.get(..count).unwrap_or(&[]));
        for knots in [KnotVector::<4>::clamped(7), KnotVector::<4>::uniform(count)].into_iter().flatten() {
            let count = curve(sum, points, weights, knots);
            sum.add(count);
        }
    }
    let knots = (KnotVector::<3>::clamped(hide(5)), KnotVector::<2>::uniform(hide(2)));
    if let (Ok(along_r), Ok(along_s)) = knots {
        for (points, weights) in [(&points[..], &weights[..]), (points, &weights[1..]), (&points[1..], &weights)] {
            let count = surface(sum, points, weights, along_r, along_s);
            sum.add(count);
        }
    }
}

#[inline(never)]
fn knots(sum: &mut Sum) {
    const CASES: [[i32; 8]; 5] = [
        [0, 0, 0, 1, 3, 4, 4, 4],
        [-2, 0, 1, 1, 2, 2, 9, 20],
        [0, 0, 1, 0, 1, 1, 1, 1],
        [0, 0, 1, 1, 1, 1, 2, 3],
        [5, 5, 5, 5, 5, 5, 5, 5],
    ];
    for case in hide(CASES) {
        let knots = case.map(I16F16::from_num);
        sum.add(KnotVector::<3>::new(&knots).map(|vector| {
            let counts = (KnotVector::points(&vector), KnotVector::pieces(&vector));
            let knots = hide([0, 4, 7, 8]).map(|index| KnotVector::knot(&vector, index));
            (counts, (knots, hide([0, 1, 7]).map(|index| KnotVector::interval(&vector, index))))
        }));
    }
    for count in hide([0, 4, 32767, 32768]) {
        sum.add(KnotVector::<4>::uniform(count).map(|vector| vector.interval(hide(1))));
        sum.add(KnotVector::<4>::clamped(count).map(|vector| vector.interval(hide(1))));
        sum.add(KnotVector::<4>::new(hide(&[])).map(|vector| vector.pieces()));
    }
}

#[inline(never)]
fn curve(sum: &mut Sum, points: &[Point3], weights: &[I16F16], knots: KnotVector<'_, 4>) -> Result<usize, SplineError> {
    let spline = BSplineCurve::new(points, knots)?;
    sum.add((BSplineCurve::points(&spline), BSplineCurve::knots(&spline).points()));
    hide([0, 2, 99]).into_iter().for_each(|index| sum.add(BSplineCurve::piece(&spline, index)));
    BSplineCurve::pieces(&spline).for_each(|piece| sum.add(piece));
    let rational = NurbsCurve::new(spline, weights)?;
    sum.add((NurbsCurve::weights(&rational), NurbsCurve::spline(&rational).points()));
    for log2 in hide([0, 3, 16]) {
        let scaled = NurbsCurve::scale_weights(rational, log2);
        sum.add(scaled.map(|spline| NurbsCurve::piece(&spline, hide(1))));
    }
    NurbsCurve::pieces(&rational).for_each(|piece| sum.add(piece));
    sum.add(Spline::nth(&spline, hide(0)));
    Ok(Spline::count(&rational))
}

#[inline(never)]
fn surface(
    sum: &mut Sum,
    points: &[Point3],
    weights: &[I16F16],
    along_r: KnotVector<'_, 3>,
    along_s: KnotVector<'_, 2>,
) -> Result<usize, SplineError> {
    let spline = BSplineSurface::new(points, along_r, along_s)?;
    let (r, s) = BSplineSurface::knots(&spline);
    sum.add((BSplineSurface::points(&spline), (r.pieces(), s.pieces())));
    hide([(0, 0), (2, 0), (0, 1)]).into_iter().for_each(|(i, j)| sum.add(BSplineSurface::piece(&spline, i, j)));
    BSplineSurface::pieces(&spline).for_each(|piece| sum.add(piece));
    let rational = NurbsSurface::new(spline, weights)?;
    sum.add((NurbsSurface::weights(&rational), NurbsSurface::spline(&rational).points()));
    for log2 in hide([0, 3, 16]) {
        let scaled = NurbsSurface::scale_weights(rational, log2);
        sum.add(scaled.map(|spline| NurbsSurface::piece(&spline, hide(1), 0)));
    }
    NurbsSurface::pieces(&rational).for_each(|piece| sum.add(piece));
    sum.add(Spline::nth(&spline, hide(9)));
    Ok(Spline::count(&rational))
}
