//! Curves and patches with the styles and transforms of `embedded-graphics`.

use super::colour::{Material, Shade};
use super::curve::BezierCurve;
use super::model::Model;
use super::stroke::Stroke;
use super::tiles::add_offset;
use crate::patch::Surface;
use crate::render::{Light, RenderError, Scene, Style, fits_every_style};
use embedded_graphics::primitives::{Primitive, PrimitiveStyle, StyledDimensions, StyledDrawable};
use embedded_graphics::transform::Transform;
use embedded_graphics_core::Drawable;
use embedded_graphics_core::draw_target::DrawTarget;
use embedded_graphics_core::geometry::{Dimensions, Point, Size};
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

/// Patches as a primitive: `into_styled` with a [`ModelStyle`] makes it drawable.
///
/// ```
/// use embedded_graphics::{mock_display::MockDisplay, pixelcolor::Gray8, prelude::*};
/// use embedded_surfaces::graphics::{ModelStyle, Patches};
/// use embedded_surfaces::patch::BilinearPatch;
/// use embedded_surfaces::render::{Lines, Style};
/// let square = [BilinearPatch::from_ints([[[0, 0, 0], [0, 3, 0]], [[3, 0, 0], [3, 3, 0]]])?];
/// let style = ModelStyle { style: Style::Wire(Lines::BOUNDARY), ..ModelStyle::new(Gray8::WHITE) };
/// let mut display = MockDisplay::new();
/// Patches::new(&square)?.translate(Point::new(1, 0)).into_styled(style).draw(&mut display)?;
/// display.assert_pattern(&[" FFFF", " F  F", " F  F", " FFFF"]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct Patches<'a, S> {
    patches: &'a [S],
    offset: Point,
}

/// How [`Patches`] look.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct ModelStyle<C> {
    /// The colour at level 255.
    pub colour: C,
    /// The light.
    pub light: Light,
    /// Shaded, flat, lines, ….
    pub style: Style,
}

impl<C> ModelStyle<C> {
    /// Shaded in this colour under the default light.
    #[must_use]
    pub fn new(colour: C) -> Self {
        Self { colour, light: Light::default(), style: Style::Shaded }
    }
}

impl<S> Clone for Patches<'_, S> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<S> Copy for Patches<'_, S> {}

impl<'a, S: Surface> Patches<'a, S> {
    /// Checks once that the patches can be drawn in every style.
    ///
    /// # Errors
    /// [`RenderError::Patch`] for the first patch with a lattice that some style may need and no accumulator holds.
    pub fn new(patches: &'a [S]) -> Result<Self, RenderError> {
        fits_every_style(patches)?;
        Ok(Self { patches, offset: Point::zero() })
    }

    /// The model in this style; `None` where `new` would have refused.
    fn model<C: Shade>(&self, style: &ModelStyle<C>) -> Option<Model<'a, S, C>> {
        let scene = Scene::new(self.patches, style.light, style.style).ok()?;
        Some(Model { scene, material: Material { colour: style.colour }, offset: self.offset })
    }
}

impl<S: Surface> Dimensions for Patches<'_, S> {
    /// The rectangle of the patches' pixels, from their control points.
    fn bounding_box(&self) -> Rectangle {
        let area = Scene::new(self.patches, Light::default(), Style::Flat).ok().and_then(|scene| scene.area());
        area.map_or(Rectangle::new(self.offset, Size::zero()), |area| super::tiles::moved(area.into(), self.offset, 1))
    }
}

impl<S: Surface> Primitive for Patches<'_, S> {}

impl<S: Surface, C: Shade> StyledDrawable<ModelStyle<C>> for Patches<'_, S> {
    type Color = C;
    type Output = ();

    fn draw_styled<D: DrawTarget<Color = C>>(&self, style: &ModelStyle<C>, target: &mut D) -> Result<(), D::Error> {
        self.model(style).map_or(Ok(()), |model| model.draw(target))
    }
}

impl<S: Surface, C: Shade> StyledDimensions<ModelStyle<C>> for Patches<'_, S> {
    fn styled_bounding_box(&self, style: &ModelStyle<C>) -> Rectangle {
        self.model(style).map_or(self.bounding_box(), |model| model.bounding_box())
    }
}

impl<S> Transform for Patches<'_, S> {
    fn translate(&self, by: Point) -> Self {
        let mut moved = *self;
        moved.translate_mut(by);
        moved
    }

    fn translate_mut(&mut self, by: Point) -> &mut Self {
        self.offset = add_offset(self.offset, by);
        self
    }
}

#[cfg(feature = "defmt")]
impl<S> defmt::Format for Patches<'_, S> {
    fn format(&self, f: defmt::Formatter<'_>) {
        defmt::write!(f, "{} patches moved by ({}, {})", self.patches.len(), self.offset.x, self.offset.y);
    }
}
