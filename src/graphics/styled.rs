//! Curves with the styles and transforms of `embedded-graphics`.

use super::curve::BezierCurve;
use super::stroke::Stroke;
use embedded_graphics::primitives::{Primitive, PrimitiveStyle, StyledDimensions, StyledDrawable};
use embedded_graphics::transform::Transform;
use embedded_graphics_core::Drawable;
use embedded_graphics_core::draw_target::DrawTarget;
use embedded_graphics_core::geometry::Point;
use embedded_graphics_core::pixelcolor::PixelColor;
use embedded_graphics_core::primitives::Rectangle;

impl Primitive for BezierCurve<'_> {}

/// The stroke's colour and width count; it is centred on the curve whatever its alignment, and nothing is filled.
impl<C: PixelColor> StyledDrawable<PrimitiveStyle<C>> for BezierCurve<'_> {
    type Color = C;
    type Output = ();

    fn draw_styled<D: DrawTarget<Color = C>>(&self, style: &PrimitiveStyle<C>, target: &mut D) -> Result<(), D::Error> {
        match style.stroke_color {
            Some(colour) => Stroke::<C>::new(*self, colour, style.stroke_width).draw(target),
            None => Ok(()),
        }
    }
}

/// The rectangle of the [`Stroke`]; empty without a stroke colour.
impl<C: PixelColor> StyledDimensions<PrimitiveStyle<C>> for BezierCurve<'_> {
    fn styled_bounding_box(&self, style: &PrimitiveStyle<C>) -> Rectangle {
        let width = style.stroke_color.map_or(0, |_| style.stroke_width);
        Stroke::<()>::new(*self, (), width).bounding_box()
    }
}

impl Transform for BezierCurve<'_> {
    fn translate(&self, by: Point) -> Self {
        self.translate(by)
    }

    fn translate_mut(&mut self, by: Point) -> &mut Self {
        self.translate_mut(by)
    }
}

impl<C: Copy, const BUFFER: usize> Transform for Stroke<'_, C, BUFFER> {
    fn translate(&self, by: Point) -> Self {
        self.translate(by)
    }

    fn translate_mut(&mut self, by: Point) -> &mut Self {
        self.translate_mut(by)
    }
}
