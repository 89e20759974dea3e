//! Colours by level, from a table.

use crate::render::{Fragment, Paint};
use embedded_graphics_core::pixelcolor::PixelColor;

/// The levels there are.
const LEVELS: usize = 256;

/// A paint that looks its colours up: a load a pixel, where a [`Material`](super::Material) takes a product for each
/// channel.
///
/// Memory: 256 colours, in flash where the compiler makes them.
///
/// ```
/// use embedded_graphics_core::pixelcolor::{Rgb565, RgbColor};
/// use embedded_surfaces::graphics::{Palette, Shade};
/// use embedded_surfaces::render::{Fragment, Paint};
/// let red = Palette::from_fn(|level| Rgb565::RED.shaded(level, 0, 0));
/// assert_eq!(red.pixel(Fragment { x: 0, y: 0, patch: 3, shade: 128 }), Rgb565::new(16, 0, 0));
/// assert_eq!(size_of_val(&red), 512);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Palette<C> {
    /// The colour of each level.
    pub colours: [C; LEVELS],
}

impl<C: PixelColor> Palette<C> {
    /// The colours that `colour` gives the levels 0 ..= 255.
    pub fn from_fn(mut colour: impl FnMut(u8) -> C) -> Self {
        let mut colours = [colour(0); LEVELS];
        for (level, out) in (1..=u8::MAX).zip(colours.iter_mut().skip(1)) {
            *out = colour(level);
        }
        Self { colours }
    }
}

impl<C: PixelColor> Paint for Palette<C> {
    type Pixel = C;

    #[inline(always)]
    fn pixel(&self, at: Fragment) -> C {
        self.colours[usize::from(at.shade)]
    }
}

#[cfg(feature = "defmt")]
impl<C> defmt::Format for Palette<C> {
    fn format(&self, f: defmt::Formatter<'_>) {
        defmt::write!(f, "palette of {} colours", LEVELS);
    }
}
