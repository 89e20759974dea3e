//! Drawables and colours, into a target that folds every pixel into the checksum.

use super::{Digest, Sum, data, hide};
use embedded_surfaces::forward::LatticeError;
use embedded_surfaces::graphics::embedded_graphics_core::pixelcolor::{
    Bgr555, Bgr565, Bgr666, Bgr888, BinaryColor, Gray2, Gray4, Gray8, IntoStorage, Rgb555, Rgb565, Rgb666, Rgb888,
};
use embedded_surfaces::graphics::embedded_graphics_core::prelude::*;
use embedded_surfaces::graphics::embedded_graphics_core::primitives::{PointsIter, Rectangle};
use embedded_surfaces::graphics::{AnyCurveNet, BezierCurve, Material, Mix, Model, Palette, Ramps, Shade, Stroke};
use embedded_surfaces::patch::Surface;
use embedded_surfaces::render::{Area, Band, Fragment, Frame, Light, Paint, Scene, Style};

/// A screen that keeps a checksum only.
pub(super) struct Screen<'s, C> {
    sum: &'s mut Sum,
    size: Rectangle,
    colour: core::marker::PhantomData<C>,
}

impl<'s, C> Screen<'s, C> {
    pub(super) fn new(sum: &'s mut Sum) -> Self {
        let size = Rectangle::new(Point::new(hide(4), hide(-3)), Size::new(hide(48), hide(50)));
        Self { sum, size, colour: core::marker::PhantomData }
    }
}

impl<C> Dimensions for Screen<'_, C> {
    fn bounding_box(&self) -> Rectangle {
        self.size
    }
}

impl<C: PixelColor + IntoStorage<Storage: Digest>> DrawTarget for Screen<'_, C> {
    type Color = C;
    type Error = core::convert::Infallible;

    fn draw_iter<I: IntoIterator<Item = Pixel<C>>>(&mut self, pixels: I) -> Result<(), Self::Error> {
        for Pixel(at, colour) in pixels {
            self.sum.add(([at.x, at.y], colour.into_storage()));
        }
        Ok(())
    }
}

impl Digest for Point {
    fn digest(&self, sum: &mut Sum) {
        [self.x, self.y].digest(sum);
    }
}

impl Digest for Rectangle {
    fn digest(&self, sum: &mut Sum) {
        (self.top_left, [self.size.width, self.size.height]).digest(sum);
    }
}

pub(super) fn calls(sum: &mut Sum) {
    colours(sum);
    ramps(sum);
    models(sum);
    bands(sum);
    curves(sum);
}

macro_rules! each_colour {
    ($sum:ident, $shade:expr, rgb: $($rgb:ident)*; grey: $($grey:ident)*) => {
        $({
            let (a, b) = ($rgb::new($shade & 31, $shade >> 3, 9), <$rgb as RgbColor>::YELLOW);
            $sum.add((Shade::shaded(b, $shade, 3, 5).into_storage(), Mix::mix(a, b, $shade).into_storage()));
        })*
        $({
            let (a, b) = ($grey::new(1), <$grey as GrayColor>::WHITE);
            $sum.add((Shade::shaded(b, $shade, 3, 5).into_storage(), Mix::mix(a, b, $shade).into_storage()));
        })*
    };
}

#[inline(never)]
fn colours(sum: &mut Sum) {
    for shade in hide([0, 77, 128, 254, 255]) {
        each_colour!(sum, shade, rgb: Rgb555 Rgb565 Rgb666 Rgb888 Bgr555 Bgr565 Bgr666 Bgr888; grey: Gray2 Gray4 Gray8);
        for x in hide([0, 3, -5]) {
            sum.add(Shade::shaded(BinaryColor::On, shade, x, 2).is_on());
        }
        let at = Fragment { x: 1, y: 2, patch: 0, shade };
        sum.add(Paint::pixel(&Material { colour: Rgb565::YELLOW }, at).into_storage());
        let greys = Palette::from_fn(|level| Rgb565::new(level >> 3, level >> 2, level >> 3));
        sum.add(Paint::pixel(&greys, at).into_storage());
    }
}

#[inline(never)]
fn ramps(sum: &mut Sum) {
    let (stops, short) = hide(([Rgb888::BLACK, Rgb888::RED, Rgb888::WHITE], [Rgb888::CYAN]));
    let tables: [&[&[Rgb888]]; 2] = [&[&stops, &short, &[]], &[]];
    for (ramps, patch) in tables.into_iter().flat_map(|ramps| hide([0, 1, 2, 9]).map(|patch| (ramps, patch))) {
        for shade in hide([0, 100, 255]) {
            sum.add(Paint::pixel(&Ramps { ramps }, Fragment { x: 0, y: 0, patch, shade }).into_storage());
        }
    }
}

#[inline(never)]
fn models(sum: &mut Sum) {
    let patches = hide([data::BICUBIC]);
    let solid = [hide(&data::TRIANGLE).surface(), hide(&data::OCTANT).surface()];
    let by = Point::new(hide(7), hide(-4));
    if let (Ok(model), Ok(mut flat)) = (Model::shaded(&patches, Gray4::WHITE), Model::flat(&solid, BinaryColor::On)) {
        let moved = Model::translate(&model, by);
        moved.draw(&mut Screen::new(sum)).unwrap_or_else(|never| match never {});
        sum.add([Model::bounding_box(&moved), Dimensions::bounding_box(&model)]);
        sum.add(Model::translate_mut(&mut flat, by).bounding_box());
        flat.draw(&mut Screen::new(sum)).unwrap_or_else(|never| match never {});
    }
    let model = Model::<_, _, 100>::with_buffer(&solid, Rgb565::GREEN, Light::default(), hide(Style::Shaded));
    if let Ok(model) = model {
        model.draw(&mut Screen::new(sum)).unwrap_or_else(|never| match never {});
    }
}

#[inline(never)]
fn bands(sum: &mut Sum) {
    let (paint, patches) = (Material { colour: Rgb565::MAGENTA }, hide([data::BICUBIC]));
    let (mut colour, mut depth) = ([Rgb565::BLACK; 64 * 16], [0; 64 * 16]);
    let area = Area::from(Rectangle::new(Point::new(0, 0), Size::new(hide(64), 40)));
    let frame = Scene::new(&patches, Light::default(), Style::Shaded)
        .and_then(|scene| Frame::new(scene, &paint, Rgb565::BLACK, area, hide(16)));
    let Ok(mut frame) = frame else { return };
    while let Ok(Some(band)) = frame.next_band(&mut colour, &mut depth) {
        sum.add(Rectangle::from(band.area()));
        Band::draw(&band, &mut Screen::new(sum)).unwrap_or_else(|never| match never {});
    }
}

#[inline(never)]
fn curves(sum: &mut Sum) {
    let (cubic, arc) = hide((&data::CUBIC, &data::ARC));
    let by = Point::new(hide(3), hide(-4));
    let nets: [Result<BezierCurve<'_>, LatticeError>; 4] =
        [BezierCurve::new(cubic), BezierCurve::new(arc), BezierCurve::new(cubic.net()), BezierCurve::new(arc.net())];
    for curve in nets {
        sum.add(curve.as_ref().map(BezierCurve::steps).map_err(|error| *error));
        let Ok(mut curve) = curve else { continue };
        let net = BezierCurve::net(&curve);
        sum.add((AnyCurveNet::points(&net), AnyCurveNet::weights(&net)));
        sum.add(BezierCurve::offset(&BezierCurve::translate(&curve, by)));
        BezierCurve::translate_mut(&mut curve, by);
        sum.add([BezierCurve::bounding_box(&curve), Dimensions::bounding_box(&curve)]);
        BezierCurve::points(&curve).for_each(|point| sum.add(point));
        sum.add(PointsIter::points(&curve).count());
        for width in hide([0, 1, 2, 9]) {
            strokes(sum, curve, width, by);
        }
    }
}

#[inline(never)]
fn strokes(sum: &mut Sum, curve: BezierCurve<'_>, width: u32, by: Point) {
    let mut stroke = Stroke::new(curve, Gray8::WHITE, width);
    sum.add([Stroke::bounding_box(&stroke), Stroke::translate(&stroke, by).bounding_box()]);
    stroke.draw(&mut Screen::new(sum)).unwrap_or_else(|never| match never {});
    Stroke::translate_mut(&mut stroke, by);
    sum.add(Dimensions::bounding_box(&stroke));
    let small = Stroke::<_, 40>::with_buffer(curve, BinaryColor::On, width);
    small.draw(&mut Screen::new(sum)).unwrap_or_else(|never| match never {});
}
