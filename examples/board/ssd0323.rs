//! A driver of the SSD0323, an OLED controller for 128 × 64 pixels of 16 greys, over `embedded-hal` 1.0: any SPI
//! device and any output pin.
//!
//! A byte of the panel's memory holds two pixels and cannot be read back, so the driver keeps a copy of the picture
//! (4 KB). Each drawing operation changes the copy, then sends the rows that it touched by one write.
//!
//! The commands are those that QEMU's model knows. A real panel's maker may ask for more: the multiplex ratio, the
//! offset of the first row, currents and the table of greys go in front of [`ON`].

use embedded_graphics_core::Pixel;
use embedded_graphics_core::draw_target::DrawTarget;
use embedded_graphics_core::geometry::{OriginDimensions, Size};
use embedded_graphics_core::pixelcolor::{Gray4, GrayColor};
use embedded_hal::digital::OutputPin;
use embedded_hal::spi::SpiDevice;

pub(crate) const WIDTH: u32 = 128;
pub(crate) const HEIGHT: u32 = 64;
const ROW_BYTES: usize = WIDTH as usize / 2;

/// The picture is the panel's memory from the first row on, left to right, at a medium contrast; the panel is on.
const ON: [&[u8]; 4] = [&[0x81, 0x40], &[0xa0, 0x00], &[0xa4], &[0xaf]];
/// All columns, counted in bytes.
const COLUMNS: [u8; 3] = [0x15, 0, ROW_BYTES as u8 - 1];
/// From a row to a row.
const ROWS: u8 = 0x75;

/// What went wrong on the way to the panel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Error<S, P> {
    /// The SPI device.
    Spi(S),
    /// The pin that tells data from commands.
    Pin(P),
}

/// The panel.
pub(crate) struct Ssd0323<S, P> {
    spi: S,
    data: P,
    picture: [[u8; ROW_BYTES]; HEIGHT as usize],
}

impl<S: SpiDevice, P: OutputPin> Ssd0323<S, P> {
    /// The panel; `data` is low for commands and high for pixels. Nothing is sent yet.
    pub(crate) const fn new(spi: S, data: P) -> Self {
        Self { spi, data, picture: [[0; ROW_BYTES]; HEIGHT as usize] }
    }

    /// Switches the panel on, black.
    pub(crate) fn start(&mut self) -> Result<(), Error<S::Error, P::Error>> {
        ON.iter().try_for_each(|command| self.command(command))?;
        self.send(0, HEIGHT as usize - 1)
    }

    fn command(&mut self, bytes: &[u8]) -> Result<(), Error<S::Error, P::Error>> {
        self.data.set_low().map_err(Error::Pin)?;
        self.spi.write(bytes).map_err(Error::Spi)
    }

    /// Sends the rows `first ..= last` of the copy.
    fn send(&mut self, first: usize, last: usize) -> Result<(), Error<S::Error, P::Error>> {
        self.command(&COLUMNS)?;
        self.command(&[ROWS, first as u8, last as u8])?;
        self.data.set_high().map_err(Error::Pin)?;
        let rows = self.picture.get(first..=last).unwrap_or_default();
        self.spi.write(rows.as_flattened()).map_err(Error::Spi)
    }
}

impl<S, P> OriginDimensions for Ssd0323<S, P> {
    fn size(&self) -> Size {
        Size::new(WIDTH, HEIGHT)
    }
}

impl<S: SpiDevice, P: OutputPin> DrawTarget for Ssd0323<S, P> {
    type Color = Gray4;
    type Error = Error<S::Error, P::Error>;

    fn draw_iter<I: IntoIterator<Item = Pixel<Gray4>>>(&mut self, pixels: I) -> Result<(), Self::Error> {
        let (mut first, mut last) = (usize::MAX, 0);
        for Pixel(at, grey) in pixels {
            let (Ok(x), Ok(y)) = (usize::try_from(at.x), usize::try_from(at.y)) else { continue };
            let Some(byte) = self.picture.get_mut(y).and_then(|row| row.get_mut(x / 2)) else { continue };
            // The left one of two pixels is in the upper half.
            *byte = if x % 2 == 0 { *byte & 0x0f | grey.luma() << 4 } else { *byte & 0xf0 | grey.luma() };
            (first, last) = (first.min(y), last.max(y));
        }
        if first <= last { self.send(first, last) } else { Ok(()) }
    }
}
