//! The figure of the point-by-point paper: its two cubic triangles P and Q, seen along z (left: x and y) and along x
//! (right: z and y), drawn point by point in bands, with the points counted.
//!
//! `cargo run --release --example seed_patches -- -o seed_patches.png`
#![allow(clippy::disallowed_types, clippy::float_arithmetic, reason = "host-side figures")]

#[path = "data/command.rs"]
mod command;
#[path = "data/draw.rs"]
mod draw;
#[path = "data/seed.rs"]
mod seed;

use clap::Parser;
use embedded_graphics::pixelcolor::Rgb888;
use embedded_graphics::prelude::RgbColor;
use embedded_graphics_simulator::OutputSettings;
use embedded_surfaces::forward::{Lattice, Steps};
use embedded_surfaces::graphics::Shade;
use embedded_surfaces::patch::{CubicTriangle, Surface};
use embedded_surfaces::reference::Audit;
use embedded_surfaces::render::{Fragment, Light, Scene, Style};
use std::error::Error;
use std::path::PathBuf;
use std::process::ExitCode;

/// Draw the two patches of the paper in two views.
#[derive(Parser)]
struct Arguments {
    /// Where the picture goes
    #[arg(short, long, default_value = "seed_patches.png")]
    output: PathBuf,
}

const BACKGROUND: Rgb888 = Rgb888::new(24, 28, 44);

fn main() -> ExitCode {
    command::end(run(&Arguments::parse()))
}

fn run(arguments: &Arguments) -> Result<(), Box<dyn Error>> {
    let mut display = draw::blank(seed::AREA, BACKGROUND);
    println!("{}: {} x {}", arguments.output.display(), seed::AREA.width, seed::AREA.height);
    let patches = seed::both_views()?;
    for (name, pair) in ["xy", "yz"].iter().zip(patches.chunks_exact(2)) {
        report(name, pair)?;
    }
    let paint =
        |at: Fragment| seed::COLOURS.get(at.patch % 2).map_or(Rgb888::WHITE, |c| c.shaded(at.shade, at.x, at.y));
    let scene = Scene::new(&patches, Light::default(), Style::Shaded)?;
    draw::in_bands(&mut display, scene, (&paint, BACKGROUND), (seed::AREA, 16), |_| ())?;
    command::save_png(&display, &OutputSettings::default(), &arguments.output)?;
    Ok(())
}

/// Step counts, points and missed pixels of a view.
fn report(name: &str, pair: &[CubicTriangle]) -> Result<(), Box<dyn Error>> {
    let audit = Audit::of(pair, seed::AREA)?;
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
