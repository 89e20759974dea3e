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

/// A ramp of colours per patch: level 0 shows the first stop, 255 the last, in between the two nearest are mixed.
///
/// ```
/// use embedded_graphics_core::pixelcolor::{Rgb888, RgbColor};
/// use embedded_surfaces::graphics::Ramps;
/// use embedded_surfaces::render::{Fragment, Paint};
/// let stops = [Rgb888::BLACK, Rgb888::RED, Rgb888::WHITE];
/// let ramps = Ramps { ramps: &[&stops] };
/// let at = |shade| ramps.pixel(Fragment { x: 0, y: 0, patch: 3, shade });
/// assert_eq!((at(0), at(255)), (Rgb888::BLACK, Rgb888::WHITE));
/// assert_eq!(at(64), Rgb888::new(128, 0, 0));
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Ramps<'a, C> {
    /// The stops of each patch's ramp; patch k takes ramp k modulo their number. A ramp without stops is black.
    pub ramps: &'a [&'a [C]],
}

#[cfg(feature = "defmt")]
impl<C> defmt::Format for Ramps<'_, C> {
    fn format(&self, f: defmt::Formatter<'_>) {
        let stops: usize = self.ramps.iter().map(|ramp| ramp.len()).sum();
        defmt::write!(f, "{} ramps with {} stops", self.ramps.len(), stops);
    }
}

/// A colour type whose values can be mixed.
pub trait Mix: PixelColor + Default {
    /// `self` at 0, `other` at 255, channels linear in between, rounded half up.
    #[must_use]
    fn mix(self, other: Self, amount: u8) -> Self;
}

/// a + (b − a)·amount/255, rounded half up.
fn mixed(a: u8, b: u8, amount: u8) -> u8 {
    let sum = u32::from(a) * u32::from(255 - amount) + u32::from(b) * u32::from(amount);
    ((2 * sum + 255) / 510) as u8
}

macro_rules! mix {
    (rgb: $($colour:ty),*; grey: $($grey:ty),*) => {
        $(impl Mix for $colour {
            fn mix(self, other: Self, amount: u8) -> Self {
                let channel = |a, b| mixed(a, b, amount);
                Self::new(channel(self.r(), other.r()), channel(self.g(), other.g()), channel(self.b(), other.b()))
            }
        })*
        $(impl Mix for $grey {
            fn mix(self, other: Self, amount: u8) -> Self {
                Self::new(mixed(self.luma(), other.luma(), amount))
            }
        })*
    };
}

mix!(rgb: Rgb555, Rgb565, Rgb666, Rgb888, Bgr555, Bgr565, Bgr666, Bgr888; grey: Gray2, Gray4, Gray8);

impl<C: Mix> Paint for Ramps<'_, C> {
    type Pixel = C;

    fn pixel(&self, at: Fragment) -> C {
        let stops = at.patch.checked_rem(self.ramps.len()).and_then(|k| self.ramps.get(k)).copied().unwrap_or(&[]);
        let intervals = stops.len().saturating_sub(1) as u32;
        let position = u32::from(at.shade) * intervals;
        let (low, part) = (position / 255, position % 255);
        let stop = |k: u32| stops.get(k as usize).copied();
        let Some(from) = stop(low) else { return C::default() };
        stop(low + 1).map_or(from, |to| from.mix(to, part as u8))
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
