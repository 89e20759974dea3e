//! Strokes on a mock display.

use embedded_graphics::mock_display::MockDisplay;
use embedded_graphics::pixelcolor::BinaryColor;
use embedded_graphics::prelude::*;
use embedded_surfaces::graphics::{AnyCurveNet, BezierCurve, Stroke};
use embedded_surfaces::num::I16F16;
use embedded_surfaces::patch::{Curve, RationalCurve};

/// `MockDisplay` panics on a pixel outside or drawn twice.
pub(crate) fn drawn<const BUFFER: usize>(stroke: Stroke<'_, BinaryColor, BUFFER>) -> MockDisplay<BinaryColor> {
    let mut display = MockDisplay::new();
    stroke.draw(&mut display).unwrap();
    display
}

pub(crate) fn stroke<'a>(curve: impl Into<AnyCurveNet<'a>>, width: u32) -> Stroke<'a, BinaryColor> {
    Stroke::new(BezierCurve::new(curve).unwrap(), BinaryColor::On, width)
}

pub(crate) fn curve<const K: usize>(points: [[i16; 2]; K]) -> Curve<K> {
    // z is ignored, however wild.
    let mut z = -20_000;
    Curve::from_ints(points.map(|[x, y]| {
        z = -z - 7;
        [x, y, z]
    }))
    .unwrap()
}

/// A quarter circle with the weights 1, 1, 2.
pub(crate) fn quarter(points: [[i16; 2]; 3]) -> RationalCurve<3> {
    RationalCurve::new(curve(points), [1, 1, 2].map(I16F16::from_num)).unwrap()
}
