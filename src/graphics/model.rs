//! Patches as a `Drawable`.

use super::colour::{Material, Shade};
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
    scene: Scene<'a, S>,
    material: Material<C>,
    offset: Point,
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
        // `Rectangle` adds without checks: stay far from the ends of i32.
        const FAR: i32 = 1 << 29;
        self.offset.x = self.offset.x.saturating_add(by.x).clamp(-FAR, FAR);
        self.offset.y = self.offset.y.saturating_add(by.y).clamp(-FAR, FAR);
        self
    }

    /// The smallest rectangle that holds every pixel of the model, from its control points.
    #[must_use]
    pub fn bounding_box(&self) -> Rectangle {
        let area = self.scene.area().unwrap_or(Area { x: 0, y: 0, width: 0, height: 0 });
        self.moved(area.into(), 1)
    }

    /// `area` moved by `sign` times the offset.
    fn moved(&self, area: Rectangle, sign: i32) -> Rectangle {
        let corner = Point::new(
            area.top_left.x.saturating_add(self.offset.x * sign),
            area.top_left.y.saturating_add(self.offset.y * sign),
        );
        Rectangle::new(corner, area.size)
    }

    /// Draws the part of the model inside `area` (in target coordinates, at most `BUFFER` pixels).
    fn draw_tile<D: DrawTarget<Color = C>>(&self, area: Rectangle, target: &mut D) -> Result<(), D::Error> {
        let (mut colour, mut depth) = ([self.material.colour; BUFFER], [0; BUFFER]);
        let own = Area::from(self.moved(area, -1));
        let Ok(mut tile) = Tile::new(own, &mut colour, &mut depth, self.material.colour) else {
            return Ok(());
        };
        self.scene.draw(&mut tile, &self.material);
        let width = area.size.width as usize;
        for (row, pixels) in tile.pixels().chunks_exact(width.max(1)).enumerate() {
            let mut column = 0;
            while column < width {
                let covered = |c: &usize| tile.is_covered(row * width + c);
                let start = (column..width).find(covered).unwrap_or(width);
                let end = (start..width).find(|c| !covered(c)).unwrap_or(width);
                if let Some(run) = pixels.get(start..end).filter(|run| !run.is_empty()) {
                    let corner = area.top_left + Point::new(start as i32, row as i32);
                    let line = Rectangle::new(corner, Size::new(run.len() as u32, 1));
                    target.fill_contiguous(&line, run.iter().copied())?;
                }
                column = end;
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
        let (right, bottom) = (visible.size.width, visible.size.height);
        let buffer = u32::try_from(BUFFER).unwrap_or(u32::MAX);
        let width = right.min(buffer).max(1);
        let height = buffer.checked_div(width).unwrap_or(1).min(bottom).max(1);
        let mut y = 0;
        while y < bottom {
            let mut x = 0;
            while x < right {
                let corner = visible.top_left + Point::new(x as i32, y as i32);
                let size = Size::new(width.min(right - x), height.min(bottom - y));
                self.draw_tile(Rectangle::new(corner, size), target)?;
                x += width;
            }
            y += height;
        }
        Ok(())
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
