//! The Utah teapot, drawn by integer additions in bands into an `embedded-graphics` target, to a PNG.
//!
//! `cargo run --release --example teapot -- --help`
#![allow(clippy::disallowed_types, clippy::float_arithmetic, reason = "host-side figures")]

#[path = "data/teapot.rs"]
mod teapot;

use clap::Parser;
use embedded_graphics::pixelcolor::Rgb888;
use embedded_graphics::prelude::Size;
use embedded_graphics_simulator::{OutputSettings, SimulatorDisplay};
use embedded_surfaces::geometry::View;
use embedded_surfaces::graphics::Material;
use embedded_surfaces::num::{Angle, I16F16};
use embedded_surfaces::reference::Audit;
use embedded_surfaces::render::{Area, Frame, Light, Scene, Style};
use indicatif::{ProgressBar, ProgressStyle};
use std::error::Error;
use std::path::PathBuf;

/// Draw the Utah teapot in bands.
#[derive(Parser)]
struct Arguments {
    /// Width and height of the picture in pixels
    #[arg(long, num_args = 2, value_names = ["WIDTH", "HEIGHT"], default_values_t = [320, 240],
          value_parser = clap::value_parser!(u32).range(1..=4096))]
    size: Vec<u32>,
    /// Rows of a band
    #[arg(long, default_value_t = 16, value_parser = clap::value_parser!(u32).range(1..))]
    band: u32,
    /// Turn about the screen's horizontal, in degrees
    #[arg(long, default_value_t = -60, allow_negative_numbers = true)]
    tilt: i32,
    /// Turn about the model's vertical, in degrees
    #[arg(long, default_value_t = 30, allow_negative_numbers = true)]
    spin: i32,
    /// Where the picture goes
    #[arg(short, long, default_value = "teapot.png")]
    output: PathBuf,
}

const COLOUR: Rgb888 = Rgb888::new(236, 196, 140);
const BACKGROUND: Rgb888 = Rgb888::new(24, 28, 44);

fn main() -> Result<(), Box<dyn Error>> {
    let arguments = Arguments::parse();
    let (width, height) = (arguments.size[0], arguments.size[1]);
    let view = View { tilt: Angle::from_degrees(arguments.tilt), spin: Angle::from_degrees(arguments.spin) };
    let to_screen = view.fit(teapot::vertices(), width, height, I16F16::from_num(0.92))?;
    let patches = teapot::patches(&to_screen)?;
    let area = Area { x: 0, y: 0, width, height };

    // What firmware does: pull a band, send it away.
    let mut display = SimulatorDisplay::<Rgb888>::with_default_color(Size::new(width, height), BACKGROUND);
    let paint = Material { colour: COLOUR };
    let scene = Scene::new(&patches, Light::default(), Style::Shaded)?;
    let mut frame = Frame::new(scene, &paint, BACKGROUND, area, arguments.band)?;
    let (mut colour, mut depth) = (vec![BACKGROUND; frame.band_pixels()], vec![0; frame.band_pixels()]);
    let progress = bar(u64::from(height), "rows drawn");
    while let Some(band) = frame.next_band(&mut colour, &mut depth)? {
        band.draw(&mut display)?;
        progress.inc(band.area().height.into());
    }
    progress.finish_and_clear();
    let points = frame.statistics().points;
    display.to_rgb_output_image(&OutputSettings::default()).save_png(&arguments.output)?;

    let (progress, mut audit) = (bar(patches.len() as u64, "patches checked"), Audit::default());
    for index in 0..patches.len() {
        audit.add(&patches, index, area)?;
        progress.inc(1);
    }
    progress.finish_and_clear();
    println!("{}: {width} x {height}, bands of {} rows", arguments.output.display(), arguments.band);
    println!("  patches            {}", patches.len());
    println!("  points             {points} in all bands");
    println!("  pixels             {} hit, summed over patches", audit.pixels);
    println!("  points per pixel   {:.2}", points as f64 / audit.pixels as f64);
    println!("  missed pixels      {} of {} centres that the f64 reference covers", audit.missed.len(), audit.covered);
    Ok(())
}

fn bar(length: u64, what: &'static str) -> ProgressBar {
    let style = ProgressStyle::with_template("{msg:18} {bar:40} {pos}/{len}");
    ProgressBar::new(length).with_message(what).with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()))
}
