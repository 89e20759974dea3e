//! What the host examples share: a scene drawn in bands into a display of `embedded-graphics-simulator`.

use embedded_graphics::pixelcolor::PixelColor;
use embedded_graphics::prelude::Size;
use embedded_graphics_simulator::SimulatorDisplay;
use embedded_surfaces::patch::Surface;
use embedded_surfaces::render::{Area, Facet, Frame, Paint, RenderError, Scene, Statistics};

/// A display of `area`'s size, all in one colour.
pub(crate) fn blank<C: PixelColor>(area: Area, background: C) -> SimulatorDisplay<C> {
    SimulatorDisplay::with_default_color(Size::new(area.width, area.height), background)
}

/// What firmware does: pull a band of at most `rows` rows, send it away. `sent` hears how many rows.
pub(crate) fn in_bands<S: Surface, P: Paint<Pixel = C>, C: PixelColor>(
    display: &mut SimulatorDisplay<C>,
    scene: Scene<'_, S>,
    (paint, background): (&P, C),
    (area, rows): (Area, u32),
    mut sent: impl FnMut(u32),
) -> Result<Statistics, RenderError> {
    // A host has room for the longest list.
    let (mut facets, mut links) =
        (vec![Facet::EMPTY; u16::MAX.into()], vec![0; u16::MAX as usize + area.height as usize]);
    let mut frame = Frame::new(scene, paint, background, area, rows)?.with_facets(&mut facets, &mut links)?;
    let (mut colour, mut depth) = (vec![background; frame.band_pixels()], vec![0; frame.band_pixels()]);
    while let Some(band) = frame.next_band(&mut colour, &mut depth)? {
        let Ok(()) = band.draw(display);
        sent(band.area().height);
    }
    Ok(frame.statistics())
}
