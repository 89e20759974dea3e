//! The figure of the point-by-point paper: its two cubic triangles P and Q, seen along z (left: x and y) and along x
//! (right: z and y), drawn point by point in bands, with the points counted.
//!
//! `cargo run --release --example seed_patches -- -o seed_patches.png`
#![allow(clippy::disallowed_types, clippy::float_arithmetic, reason = "host-side figures")]

#[path = "data/seed.rs"]
mod seed;

use clap::Parser;
use embedded_graphics::pixelcolor::Rgb888;
use embedded_graphics::prelude::{RgbColor, Size};
use embedded_graphics_simulator::{OutputSettings, SimulatorDisplay};
use embedded_surfaces::forward::{Lattice, Steps};
use embedded_surfaces::geometry::Affine;
use embedded_surfaces::graphics::Shade;
use embedded_surfaces::num::I32F32;
use embedded_surfaces::patch::{CubicTriangle, Surface};
use embedded_surfaces::reference::Audit;
use embedded_surfaces::render::{Area, Fragment, Frame, Light, Scene, Style};
use std::error::Error;
use std::path::PathBuf;

/// Draw the two patches of the paper in two views.
#[derive(Parser)]
struct Arguments {
    /// Where the picture goes
    #[arg(short, long, default_value = "seed_patches.png")]
    output: PathBuf,
}

const AREA: Area = Area { x: 0, y: 0, width: 720, height: 380 };
const BACKGROUND: Rgb888 = Rgb888::new(24, 28, 44);
const COLOURS: [Rgb888; 2] = [Rgb888::new(240, 190, 120), Rgb888::new(130, 190, 240)];

/// Screen x, y and z from model x, y and z, moved right by `shift`.
fn view(rows: [[i32; 3]; 3], shift: i32) -> Affine {
    let row = |[x, y, z]: [i32; 3], shift: i32| [x, y, z, shift].map(I32F32::from_num);
    Affine { rows: [row(rows[0], shift), row(rows[1], 0), row(rows[2], 0)] }
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments = Arguments::parse();
    let along_z = view([[1, 0, 0], [0, 1, 0], [0, 0, -1]], 10);
    let along_x = view([[0, 0, 1], [0, 1, 0], [1, 0, 0]], 320);
    let mut display = SimulatorDisplay::<Rgb888>::with_default_color(Size::new(AREA.width, AREA.height), BACKGROUND);
    println!("{}: {} x {}", arguments.output.display(), AREA.width, AREA.height);
    let mut patches = Vec::new();
    for (name, map) in [("xy", along_z), ("yz", along_x)] {
        let pair = [seed::P.transform(&map)?, seed::Q.transform(&map)?];
        report(name, &pair)?;
        patches.extend(pair);
    }
    let paint = |at: Fragment| COLOURS.get(at.patch % 2).map_or(Rgb888::WHITE, |c| c.shaded(at.shade, at.x, at.y));
    let scene = Scene::new(&patches, Light::default(), Style::Shaded)?;
    let mut frame = Frame::new(scene, &paint, BACKGROUND, AREA, 16)?;
    let (mut colour, mut depth) = (vec![BACKGROUND; frame.band_pixels()], vec![0; frame.band_pixels()]);
    while let Some(band) = frame.next_band(&mut colour, &mut depth)? {
        band.draw(&mut display)?;
    }
    display.to_rgb_output_image(&OutputSettings::default()).save_png(&arguments.output)?;
    Ok(())
}

/// Step counts, points and missed pixels of a view.
fn report(name: &str, pair: &[CubicTriangle; 2]) -> Result<(), Box<dyn Error>> {
    let audit = Audit::of(pair, AREA)?;
    let mut points = 0;
    for (label, patch) in ["P", "Q"].iter().zip(pair) {
        let (paper, ours) = (Steps::paper(patch.surface()), Steps::hole_free(patch.surface()));
        let lattice = Lattice::new(patch.surface(), ours)?;
        points += lattice.point_count();
        println!("  {name} {label}: the paper's count {}, hole-free {}", paper.r(), ours.r());
    }
    println!(
        "  {name}: {points} points, {} pixels ({:.2} points per pixel), {} of {} centres missed",
        audit.pixels,
        points as f64 / audit.pixels as f64,
        audit.missed.len(),
        audit.covered
    );
    Ok(())
}
