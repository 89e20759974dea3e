//! The Utah teapot, drawn by integer additions in bands into an `embedded-graphics` target, to a PNG.
//!
//! `cargo run --release --example teapot -- --help`
#![allow(clippy::disallowed_types, clippy::float_arithmetic, reason = "host-side figures")]

#[path = "data/command.rs"]
mod command;
#[path = "data/draw.rs"]
mod draw;
#[path = "data/teapot.rs"]
mod teapot;

use clap::Parser;
use embedded_graphics::pixelcolor::Rgb888;
use embedded_graphics_simulator::OutputSettings;
use embedded_surfaces::geometry::{Perspective, View};
use embedded_surfaces::graphics::Material;
use embedded_surfaces::num::{Angle, I16F16};
use embedded_surfaces::patch::{BicubicPatch, Surface};
use embedded_surfaces::reference::{Audit, fixed_half_up};
use embedded_surfaces::render::{Area, Cull, Facet, Fill, Gloss, Light, Lines, Scene, Style};
use embedded_surfaces::subdivide::{PatchTopology, topology};
use indicatif::{ProgressBar, ProgressStyle};
use std::error::Error;
use std::path::PathBuf;
use std::process::ExitCode;

/// Draw the Utah teapot in bands.
#[derive(Parser)]
struct Arguments {
    /// Width and height of the picture in pixels: 320x240, or two numbers
    #[arg(long, num_args = 1..=2, value_names = ["WIDTH", "HEIGHT"], default_value = "320x240")]
    size: Vec<String>,
    /// Rows of a band
    #[arg(long, default_value_t = 16, value_parser = clap::value_parser!(u32).range(1..))]
    band: u32,
    /// Turn about the screen's horizontal, in degrees
    #[arg(long, default_value_t = -60, allow_negative_numbers = true)]
    tilt: i32,
    /// Turn about the model's vertical, in degrees
    #[arg(long, default_value_t = 30, allow_negative_numbers = true)]
    spin: i32,
    /// Perspective: the eye's distance in diagonals of the model's box; without it the view is orthographic
    #[arg(long, value_name = "DIAGONALS", allow_negative_numbers = true)]
    perspective: Option<f64>,
    /// How the patches are drawn
    #[arg(long, value_enum, default_value_t = Look::Shaded)]
    style: Look,
    /// How they are filled: by exact points, or by facets between the points of a coarse grid
    #[arg(long, value_enum, default_value_t = Filling::Exact)]
    fill: Filling,
    /// How far the surface may be from the facets of a grid, in pixels
    #[arg(long, value_name = "PIXELS", default_value_t = 1.0, allow_negative_numbers = true)]
    tolerance: f64,
    /// Leave out what faces away from the viewer
    #[arg(long)]
    cull: bool,
    /// Where the picture goes
    #[arg(short, long, default_value = "teapot.png")]
    output: PathBuf,
}

#[derive(Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum Filling {
    Exact,
    Grid,
}

#[derive(Clone, Copy, clap::ValueEnum)]
enum Look {
    Shaded,
    Glossy,
    Flat,
    Depth,
    Wire,
    Net,
    Normals,
}

impl From<Look> for Style {
    fn from(look: Look) -> Self {
        let lines = Lines::every(6).without_hidden();
        match look {
            Look::Shaded => Self::Shaded,
            Look::Glossy => Self::Glossy(Gloss::new(110, 24)),
            Look::Flat => Self::Flat,
            Look::Depth => Self::DepthCued { near: 255, far: 60 },
            Look::Wire => Self::Wire(lines),
            Look::Net => Self::Net { hidden: false },
            Look::Normals => Self::Normals { lines, length: 10 },
        }
    }
}

const COLOUR: Rgb888 = Rgb888::new(236, 196, 140);
const BACKGROUND: Rgb888 = Rgb888::new(24, 28, 44);

fn main() -> ExitCode {
    command::end(place(&Arguments::parse()))
}

/// Places the patches on the screen, then draws them.
fn place(arguments: &Arguments) -> Result<(), Box<dyn Error>> {
    let (width, height) = size(&arguments.size)?;
    let view = View { tilt: Angle::from_degrees(arguments.tilt), spin: Angle::from_degrees(arguments.spin) };
    let to_screen = view.fit(teapot::vertices(), width, height, I16F16::from_num(0.92))?;
    let patches = teapot::patches(&to_screen)?;
    match arguments.perspective {
        None => run(arguments, &patches),
        Some(diagonals) => {
            let eye = eye(&patches, (width, height), diagonals)?;
            let seen = patches.iter().map(|patch| patch.perspective(&eye)).collect::<Result<Vec<_>, _>>()?;
            run(arguments, &seen)
        }
    }
}

/// `["320x240"]` or `["320", "240"]`, each 1 ..= 4096.
fn size(arguments: &[String]) -> Result<(u32, u32), Box<dyn Error>> {
    let text = arguments.join("x");
    let side = |side: &str| side.parse().ok().filter(|n| (1..=4096).contains(n));
    let sides = text.split_once('x').and_then(|(width, height)| Some((side(width)?, side(height)?)));
    sides.ok_or_else(|| format!("--size {text}: not WIDTHxHEIGHT with sides of 1 to 4096").into())
}

/// The eye above the middle of the screen, so many diagonals of the model's box away.
fn eye(patches: &[BicubicPatch], (width, height): (u32, u32), diagonals: f64) -> Result<Perspective, Box<dyn Error>> {
    let bounds = patches.iter().map(BicubicPatch::bounds).reduce(|a, b| a.union(&b)).ok_or("no patches")?;
    let (low, high) = (bounds.min.to_array(), bounds.max.to_array());
    let diagonal = (0..3).map(|c| (high[c] - low[c]).to_num::<f64>().powi(2)).sum::<f64>().sqrt();
    let fixed = |c: f64| fixed_half_up(c).ok_or("the eye is too far away");
    let (x, y) = (f64::from(width) / 2.0, f64::from(height) / 2.0);
    Ok(Perspective { centre_x: fixed(x)?, centre_y: fixed(y)?, distance: fixed(diagonals * diagonal)? })
}

/// Draws the picture, then counts what was hit and missed.
fn run<S: Surface>(arguments: &Arguments, patches: &[S]) -> Result<(), Box<dyn Error>> {
    let (width, height) = size(&arguments.size)?;
    let area = Area { x: 0, y: 0, width, height };
    let mut display = draw::blank(area, BACKGROUND);
    let mut edges = vec![PatchTopology::default(); patches.len()];
    topology(patches, &mut edges)?;
    let fill = match arguments.fill {
        Filling::Exact => Fill::Exact,
        Filling::Grid => {
            let tolerance = fixed_half_up(arguments.tolerance).filter(|t| *t > 0);
            Fill::Grid {
                tolerance: tolerance.ok_or_else(|| format!("--tolerance {}: not positive", arguments.tolerance))?,
            }
        }
    };
    let scene =
        Scene::new(patches, Light::default(), arguments.style.into())?.with_topology(&edges)?.with_fill(fill)?;
    let scene = scene.with_cull(if arguments.cull { Cull::Back } else { Cull::None });
    let progress = bar(u64::from(height), "rows drawn");
    let paint = (&Material { colour: COLOUR }, BACKGROUND);
    let statistics =
        draw::in_bands(&mut display, scene, paint, (area, arguments.band), |rows| progress.inc(rows.into()))?;
    progress.finish_and_clear();
    command::save_png(&display, &OutputSettings::default(), &arguments.output)?;

    println!("{}: {width} x {height}, bands of {} rows", arguments.output.display(), arguments.band);
    println!("  patches            {}", patches.len());
    if arguments.fill == Filling::Grid {
        println!("  vertices           {} of grids, made once", statistics.vertices);
        println!(
            "  facets             {}, {} bytes",
            statistics.facets,
            statistics.facets as usize * size_of::<Facet>()
        );
        return Ok(());
    }
    let points = statistics.points;
    let audit = if arguments.cull {
        Audit::of_front(patches, &edges, area)?
    } else {
        let (progress, mut audit) = (bar(patches.len() as u64, "patches checked"), Audit::default());
        for index in 0..patches.len() {
            audit.add(patches, index, area)?;
            progress.inc(1);
        }
        progress.finish_and_clear();
        audit
    };
    println!("  pieces             {} in all bands, after {} splits", statistics.pieces, statistics.splits);
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
