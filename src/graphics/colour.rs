//! Levels to colours.

use crate::render::{Fragment, Paint};
use embedded_graphics_core::pixelcolor::{
    Bgr555, Bgr565, Bgr666, Bgr888, BinaryColor, Gray2, Gray4, Gray8, GrayColor, PixelColor, Rgb555, Rgb565, Rgb666,
    Rgb888, RgbColor,
};

/// A colour type that can show levels.
pub trait Shade: PixelColor {
    /// The colour at level `shade` of 255: black at 0, itself at 255, channels rounded half up in between.
    ///
    /// Types with one bit choose by ordered dithering at pixel (x, y).
    #[must_use]
    fn shaded(self, shade: u8, x: i32, y: i32) -> Self;
}

/// A channel of at most 255 at level `shade`: floor(channel·shade/255 + 1/2).
fn scaled(channel: u8, shade: u8) -> u8 {
    let product = 2 * u32::from(channel) * u32::from(shade) + 255;
    (product / 510) as u8
}

macro_rules! rgb {
    ($($colour:ty),*) => {$(
        impl Shade for $colour {
            fn shaded(self, shade: u8, _: i32, _: i32) -> Self {
                let [r, g, b] = [self.r(), self.g(), self.b()].map(|c| scaled(c, shade));
                Self::new(r, g, b)
            }
        }
    )*};
}

macro_rules! grey {
    ($($colour:ty),*) => {$(
        impl Shade for $colour {
            fn shaded(self, shade: u8, _: i32, _: i32) -> Self {
                Self::new(scaled(self.luma(), shade))
            }
        }
    )*};
}

rgb!(Rgb555, Rgb565, Rgb666, Rgb888, Bgr555, Bgr565, Bgr666, Bgr888);
grey!(Gray2, Gray4, Gray8);

/// Bayer's 8 × 8 matrix: 0 ..= 63, neighbours far apart. Bit by bit, from the interleaved bits of x XOR y and y.
const fn bayer(x: i32, y: i32) -> u8 {
    let (a, b) = ((x ^ y) as u8, y as u8);
    ((a & 1) << 5) | ((b & 1) << 4) | ((a & 2) << 2) | ((b & 2) << 1) | ((a & 4) >> 1) | ((b & 4) >> 2)
}

impl Shade for BinaryColor {
    /// `On` where the level exceeds the threshold 4·b + 2 of an 8 × 8 Bayer matrix b: never at 0, always at 255.
    fn shaded(self, shade: u8, x: i32, y: i32) -> Self {
        (self.is_on() && shade > 4 * bayer(x, y) + 2).into()
    }
}

/// A paint of one colour, darkened by the level.
///
/// ```
/// use embedded_graphics_core::pixelcolor::{Gray8, GrayColor, Rgb565, RgbColor};
/// use embedded_surfaces::graphics::Shade;
/// assert_eq!(Rgb565::WHITE.shaded(128, 0, 0), Rgb565::new(16, 32, 16));
/// assert_eq!(Gray8::WHITE.shaded(77, 0, 0).luma(), 77);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Material<C> {
    /// The colour at level 255.
    pub colour: C,
}

impl<C: Shade> Paint for Material<C> {
    type Pixel = C;

    fn pixel(&self, at: Fragment) -> C {
        self.colour.shaded(at.shade, at.x, at.y)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bayer_holds_every_threshold_once() {
        let mut seen = [0; 64];
        (0..64).for_each(|i| seen[usize::from(bayer(i % 8, i / 8))] += 1);
        assert_eq!(seen, [1; 64]);
        assert_eq!([bayer(0, 0), bayer(1, 1), bayer(1, 0), bayer(-8, -8)], [0, 16, 32, 0]);
    }

    #[test]
    fn dithering_keeps_the_mean() {
        for shade in 0..=255_u8 {
            let on = (0..64).filter(|i| BinaryColor::On.shaded(shade, i % 8, i / 8).is_on()).count();
            assert!((on as i32 * 4 - i32::from(shade)).abs() <= 2, "{shade}: {on} of 64");
        }
        assert!(BinaryColor::Off.shaded(255, 0, 0).is_off());
    }

    #[test]
    fn channels_round_half_up() {
        for (channel, shade) in (0..=255).flat_map(|c| (0..=255).map(move |s| (c, s))) {
            let exact = u32::from(channel) * u32::from(shade);
            let ours = u32::from(scaled(channel, shade)) * 255;
            assert!(2 * ours <= 2 * exact + 255 && 2 * ours + 255 > 2 * exact, "{channel} {shade}");
        }
    }
}
