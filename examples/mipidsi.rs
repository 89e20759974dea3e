//! Bands to a display of `mipidsi`: each goes out by one contiguous write, and of two buffers in turn one is drawn into
//! while the other is sent.
//!
//! `cargo run --example mipidsi` prints what went over the wires to a mock of an ILI9341, 320 × 240 pixels in 16 bits;
//! `cargo run --release --target thumbv7em-none-eabihf --example mipidsi` does the same under QEMU. For a display of your
//! own, put `mipidsi`'s `SpiInterface` or `ParallelInterface` in the place of [`Mock`], and what your chip does beside its
//! processor (DMA, a second core) into [`join`].
//!
//! `tests/mipidsi.rs` obeys the recorded commands and compares with a picture drawn at once.
#![cfg_attr(target_os = "none", no_std, no_main)]

#[path = "board/run.rs"]
mod board;
#[path = "data/teapot.rs"]
pub(crate) mod teapot;

use core::convert::Infallible;
use core::fmt::Debug;
use embedded_graphics_core::draw_target::DrawTarget;
use embedded_graphics_core::pixelcolor::{Rgb565, RgbColor};
use embedded_hal::delay::DelayNs;
use embedded_surfaces::geometry::View;
use embedded_surfaces::graphics::Material;
use embedded_surfaces::num::I16F16;
use embedded_surfaces::patch::BicubicPatch;
use embedded_surfaces::render::{Area, Frame, Light, Scene, Style};
use mipidsi::interface::{Interface, InterfaceKind};
use mipidsi::models::ILI9341Rgb565;
use mipidsi::options::{Orientation, Rotation};

pub(crate) const SCREEN: Area = Area { x: 0, y: 0, width: 320, height: 240 };
/// Rows of a band: two buffers of 5 KB, and 5 KB of depths.
pub(crate) const ROWS: u32 = 8;
pub(crate) const BAND: usize = (SCREEN.width * ROWS) as usize;
pub(crate) const PAINT: Material<Rgb565> = Material { colour: Rgb565::new(29, 49, 17) };
pub(crate) const BACKGROUND: Rgb565 = Rgb565::new(3, 7, 5);

/// Runs both and returns what both return: on a host at the same time.
#[cfg(not(target_os = "none"))]
fn join<A: Send, B>(send: impl FnOnce() -> A + Send, draw: impl FnOnce() -> B) -> (A, B) {
    std::thread::scope(|scope| {
        let sent = scope.spawn(send);
        let drawn = draw();
        let Ok(sent) = sent.join() else { std::process::abort() };
        (sent, drawn)
    })
}

/// Runs both and returns what both return. This one has nothing to send by but the processor; with DMA, start the
/// transfer, draw, wait for its end.
#[cfg(target_os = "none")]
fn join<A, B>(send: impl FnOnce() -> A, draw: impl FnOnce() -> B) -> (A, B) {
    (send(), draw())
}

/// Draws the scene in bands: while one of the buffers is sent, the next band is drawn into the other. Returns the
/// number of bands.
pub(crate) fn show<D>(
    scene: Scene<'_, BicubicPatch>,
    display: &mut D,
    [first, second]: [&mut [Rgb565]; 2],
    depth: &mut [u16],
) -> Result<u32, Fault<D::Error>>
where
    D: DrawTarget<Color = Rgb565> + Send,
    D::Error: Send,
{
    let mut frame = Frame::new(scene, &PAINT, BACKGROUND, SCREEN, ROWS).map_err(Fault::of)?;
    let mut bands = 0;
    let mut ready = frame.next_band(first, depth).map_err(Fault::of)?;
    while let Some(band) = ready {
        bands += 1;
        let (sent, drawn) = join(|| band.draw(display), || frame.next_band(second, depth));
        sent.map_err(Fault::Display)?;
        let Some(band) = drawn.map_err(Fault::of)? else { break };
        bands += 1;
        let (sent, drawn) = join(|| band.draw(display), || frame.next_band(first, depth));
        sent.map_err(Fault::Display)?;
        ready = drawn.map_err(Fault::of)?;
    }
    Ok(bands)
}

/// Why a picture did not come out.
#[derive(Debug)]
#[allow(dead_code, reason = "hosts print it")]
pub(crate) enum Fault<E> {
    /// The model, the patches or the buffers.
    Scene(embedded_surfaces::render::RenderError),
    /// The display.
    Display(E),
}

impl<E> Fault<E> {
    fn of(error: embedded_surfaces::render::RenderError) -> Self {
        Self::Scene(error)
    }
}

/// What goes over the wires.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Sent<'a> {
    /// A command and its arguments.
    Command(u8, &'a [u8]),
    /// A part of the pixels of a write.
    Pixels(&'a [u8]),
}

/// An interface to a display that tells a function what is sent.
pub(crate) struct Mock<F>(pub(crate) F);

impl<F: FnMut(Sent<'_>)> Interface for Mock<F> {
    type Word = u8;
    type Error = Infallible;

    const KIND: InterfaceKind = InterfaceKind::Serial4Line;

    fn send_command(&mut self, command: u8, arguments: &[u8]) -> Result<(), Infallible> {
        (self.0)(Sent::Command(command, arguments));
        Ok(())
    }

    fn send_pixels<const N: usize>(&mut self, pixels: impl IntoIterator<Item = [u8; N]>) -> Result<(), Infallible> {
        pixels.into_iter().for_each(|pixel| (self.0)(Sent::Pixels(&pixel)));
        Ok(())
    }

    fn send_repeated_pixel<const N: usize>(&mut self, pixel: [u8; N], count: u32) -> Result<(), Infallible> {
        (0..count).for_each(|_| (self.0)(Sent::Pixels(&pixel)));
        Ok(())
    }
}

/// The mock is never busy.
struct NoDelay;

impl DelayNs for NoDelay {
    fn delay_ns(&mut self, _: u32) {}
}

/// The teapot on the screen.
pub(crate) fn patches() -> Option<[BicubicPatch; 32]> {
    let fit = const { I16F16::from_bits(60_293) }; // 0.92
    let map = View::default().fit(teapot::vertices(), SCREEN.width, SCREEN.height, fit).ok()?;
    teapot::patches(&map).ok()
}

/// Shows the teapot on a mock that tells `record` what it hears. Returns the number of bands; `None` where anything is
/// refused.
pub(crate) fn run(record: impl FnMut(Sent<'_>) + Send) -> Option<u32> {
    let landscape = Orientation::new().rotate(Rotation::Deg90);
    let builder = mipidsi::Builder::new(ILI9341Rgb565, Mock(record)).orientation(landscape);
    let mut display = builder.init(&mut NoDelay).ok()?;
    let patches = patches()?;
    let scene = Scene::new(&patches, Light::default(), Style::Shaded).ok()?;
    let mut buffers = [[Rgb565::BLACK; BAND]; 2];
    let [first, second] = &mut buffers;
    show(scene, &mut display, [first, second], &mut [0; BAND]).ok()
}

/// Writes the line that all targets print; an error where anything is refused.
pub(crate) fn report(out: &mut impl core::fmt::Write) -> core::fmt::Result {
    let (mut writes, mut bytes, mut sum) = (0_u32, 0_u32, 0_u32);
    let bands = run(|sent| {
        let (command, data) = match sent {
            Sent::Command(command, arguments) => (Some(command), arguments),
            Sent::Pixels(pixels) => (None, pixels),
        };
        writes += u32::from(command == Some(0x2c));
        bytes += if command.is_none() { data.len() as u32 } else { 0 };
        let all = command.iter().chain(data);
        sum = all.fold(sum, |sum, byte| sum.wrapping_mul(0x0100_0193).wrapping_add(u32::from(*byte)).rotate_left(5));
    });
    let bands = bands.ok_or(core::fmt::Error)?;
    writeln!(out, "mipidsi: {bands} bands in {writes} writes, {bytes} bytes of pixels, checksum {sum:08x}")
}

#[cfg(not(target_os = "none"))]
fn main() {
    board::on_host();
}
