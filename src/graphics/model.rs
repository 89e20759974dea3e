//! Patches as a `Drawable`.

use super::colour::{Material, Shade};
use super::tiles::{add_offset, each_tile, line, moved, runs};
use crate::patch::Surface;
use crate::render::{Area, Light, RenderError, Scene, Style, Tile};
use embedded_graphics_core::Drawable;
use embedded_graphics_core::draw_target::DrawTarget;
use embedded_graphics_core::geometry::{Dimensions, Point, Size};
use embedded_graphics_core::primitives::Rectangle;

/// A shaded model: patches in one colour, at a place; draws the pixels that it covers and no others.
///
/// It is drawn in rectangles of at most `BUFFER` pixels, with both buffers on the stack: 4 KB for 1024 pixels of a
/// 16-bit colour, plus the stack of [`Scene::draw`]. The more rectangles a model meets, the more often its patches
/// are walked; with a band buffer of your own, [`Frame`](crate::render::Frame) is the faster way.
///
/// ```
/// use embedded_graphics::{mock_display::MockDisplay, pixelcolor::BinaryColor, prelude::*};
/// use embedded_surfaces::{graphics::Model, patch::BilinearPatch};
/// let square = [BilinearPatch::from_ints([[[0, 0, 0], [0, 3, 0]], [[3, 0, 0], [3, 3, 0]]])?];
/// let mut display = MockDisplay::new();
/// Model::flat(&square, BinaryColor::On)?.translate(Point::new(1, 1)).draw(&mut display)?;
/// display.assert_pattern(&["     ", " ####", " ####", " ####", " ####"]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct Model<'a, S, C, const BUFFER: usize = 1024> {
    pub(super) scene: Scene<'a, S>,
    pub(super) material: Material<C>,
    pub(super) offset: Point,
}

impl<S, C: Copy, const BUFFER: usize> Clone for Model<'_, S, C, BUFFER> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<S, C: Copy, const BUFFER: usize> Copy for Model<'_, S, C, BUFFER> {}

impl<'a, S: Surface, C: Shade> Model<'a, S, C> {
    /// A Lambert-shaded model under the default light.
    ///
    /// # Errors
    /// [`RenderError::Patch`] for a patch whose lattice does not fit the engine.
    pub fn shaded(patches: &'a [S], colour: C) -> Result<Self, RenderError> {
        Self::with_buffer(patches, colour, Light::default(), Style::Shaded)
    }

    /// A model in one flat colour.
    ///
    /// # Errors
    /// [`RenderError::Patch`] for a patch whose lattice does not fit the engine.
    pub fn flat(patches: &'a [S], colour: C) -> Result<Self, RenderError> {
        Self::with_buffer(patches, colour, Light::default(), Style::Flat)
    }
}

impl<'a, S: Surface, C: Shade, const BUFFER: usize> Model<'a, S, C, BUFFER> {
    /// Fails to compile for an empty buffer.
    const LEGAL: () = assert!(BUFFER > 0, "the buffer holds no pixel");

    /// A model with this light and style, and a buffer size of your choice.
    ///
    /// # Errors
    /// [`RenderError::Patch`] for a patch whose lattice does not fit the engine.
    pub fn with_buffer(patches: &'a [S], colour: C, light: Light, style: Style) -> Result<Self, RenderError> {
        let () = Self::LEGAL;
        let scene = Scene::new(patches, light, style)?;
        Ok(Self { scene, material: Material { colour }, offset: Point::zero() })
    }

    /// The model moved by whole pixels; lattice points move exactly. Places beyond ±2^29 stop there.
    #[must_use]
    pub fn translate(&self, by: Point) -> Self {
        let mut moved = *self;
        moved.translate_mut(by);
        moved
    }

    /// Moves the model by whole pixels. Places beyond ±2^29 stop there.
    pub fn translate_mut(&mut self, by: Point) -> &mut Self {
        self.offset = add_offset(self.offset, by);
        self
    }

    /// The smallest rectangle that holds every pixel of the model, from its control points.
    #[must_use]
    pub fn bounding_box(&self) -> Rectangle {
        let area = self.scene.area().unwrap_or(Area { x: 0, y: 0, width: 0, height: 0 });
        moved(area.into(), self.offset, 1)
    }

    /// Draws the part of the model inside `area` (in target coordinates, at most `BUFFER` pixels).
    fn draw_tile<D: DrawTarget<Color = C>>(&self, area: Rectangle, target: &mut D) -> Result<(), D::Error> {
        let (mut colour, mut depth) = ([self.material.colour; BUFFER], [0; BUFFER]);
        let own = Area::from(moved(area, self.offset, -1));
        let Ok(mut tile) = Tile::new(own, &mut colour, &mut depth, self.material.colour) else {
            return Ok(());
        };
        self.scene.draw(&mut tile, &self.material);
        let width = area.size.width as usize;
        for (row, pixels) in tile.pixels().chunks_exact(width.max(1)).enumerate() {
            let find = |column: usize, covered| (column..width).find(|c| tile.is_covered(row * width + c) == covered);
            for run in runs(width, |column, covered| find(column, covered).unwrap_or(width)) {
                if let Some(colours) = pixels.get(run.clone()) {
                    target.fill_contiguous(&line(area, row, &run), colours.iter().copied())?;
                }
            }
        }
        Ok(())
    }
}

impl<S: Surface, C: Shade, const BUFFER: usize> Drawable for Model<'_, S, C, BUFFER> {
    type Color = C;
    type Output = ();

    fn draw<D: DrawTarget<Color = C>>(&self, target: &mut D) -> Result<(), D::Error> {
        let visible = target.bounding_box().intersection(&self.bounding_box());
        if visible.is_zero_sized() {
            return Ok(());
        }
        let buffer = u32::try_from(BUFFER).unwrap_or(u32::MAX);
        let width = visible.size.width.min(buffer).max(1);
        let height = buffer.checked_div(width).unwrap_or(1);
        each_tile(visible, Size::new(width, height), |area| self.draw_tile(area, target))
    }
}

impl<S: Surface, C: Shade, const BUFFER: usize> Dimensions for Model<'_, S, C, BUFFER> {
    fn bounding_box(&self) -> Rectangle {
        self.bounding_box()
    }
}

#[cfg(feature = "styled")]
impl<S: Surface, C: Shade, const BUFFER: usize> embedded_graphics::transform::Transform for Model<'_, S, C, BUFFER> {
    fn translate(&self, by: Point) -> Self {
        self.translate(by)
    }

    fn translate_mut(&mut self, by: Point) -> &mut Self {
        self.translate_mut(by)
    }
}

#[cfg(feature = "defmt")]
impl<S, C, const BUFFER: usize> defmt::Format for Model<'_, S, C, BUFFER> {
    fn format(&self, f: defmt::Formatter<'_>) {
        defmt::write!(f, "model moved by ({}, {}): {}", self.offset.x, self.offset.y, self.scene);
    }
}
