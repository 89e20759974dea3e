//! Bands into draw targets.

use crate::render::{Area, Band};
use embedded_graphics_core::draw_target::DrawTarget;
use embedded_graphics_core::geometry::{Point, Size};
use embedded_graphics_core::pixelcolor::PixelColor;
use embedded_graphics_core::primitives::Rectangle;

impl From<Area> for Rectangle {
    fn from(area: Area) -> Self {
        Self::new(Point::new(area.x, area.y), Size::new(area.width, area.height))
    }
}

impl From<Rectangle> for Area {
    fn from(r: Rectangle) -> Self {
        Self { x: r.top_left.x, y: r.top_left.y, width: r.size.width, height: r.size.height }
    }
}

impl<C: PixelColor> Band<'_, C> {
    /// Sends the band to the target by one `fill_contiguous`, clipped to the target's bounding box.
    ///
    /// ```
    /// use embedded_graphics::{mock_display::MockDisplay, pixelcolor::Gray8, prelude::*};
    /// use embedded_surfaces::graphics::Material;
    /// use embedded_surfaces::patch::BilinearPatch;
    /// use embedded_surfaces::render::{Frame, Light, Scene, Style};
    /// let square = [BilinearPatch::from_ints([[[1, 1, 0], [1, 40, 0]], [[40, 1, 0], [40, 40, 9]]])?];
    /// let mut display = MockDisplay::new();
    /// let paint = Material { colour: Gray8::WHITE };
    /// let scene = Scene::new(&square, Light::default(), Style::Shaded)?;
    /// let mut frame = Frame::new(scene, &paint, Gray8::BLACK, display.bounding_box().into(), 16)?;
    /// let (mut colour, mut depth) = ([Gray8::BLACK; 64 * 16], [0; 64 * 16]);
    /// while let Some(band) = frame.next_band(&mut colour, &mut depth)? {
    ///     band.draw(&mut display)?;
    /// }
    /// assert!(display.get_pixel(Point::new(20, 20)).is_some_and(|c| c.luma() > 200));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// What the target reports.
    pub fn draw<D: DrawTarget<Color = C>>(&self, target: &mut D) -> Result<(), D::Error> {
        let area = Rectangle::from(self.area());
        let visible = target.bounding_box().intersection(&area);
        if visible.is_zero_sized() {
            return Ok(());
        }
        if visible == area {
            return target.fill_contiguous(&area, self.pixels().iter().copied());
        }
        let (width, left) = (area.size.width as usize, visible.top_left.x.abs_diff(area.top_left.x) as usize);
        let top = visible.top_left.y.abs_diff(area.top_left.y) as usize;
        let (columns, rows) = (visible.size.width as usize, visible.size.height as usize);
        let lines = self.pixels().chunks_exact(width.max(1)).skip(top).take(rows);
        target.fill_contiguous(&visible, lines.flat_map(|line| line.iter().skip(left).take(columns).copied()))
    }
}
