//! Intersections of a few pairs of patches: a table of their curves, and pictures of the curves on the shaded surfaces.
//!
//! `cargo run --release --example intersect -- -o intersect.png`
#![allow(clippy::disallowed_types, clippy::float_arithmetic, reason = "figures for people")]

#[path = "data/command.rs"]
mod command;
#[path = "data/draw.rs"]
mod draw;
#[path = "data/workspace.rs"]
mod workspace;

use clap::Parser;
use embedded_graphics::geometry::Point as Place;
use embedded_graphics::pixelcolor::Rgb888;
use embedded_graphics::prelude::*;
use embedded_graphics::primitives::{Circle, Line, PrimitiveStyle, Rectangle};
use embedded_graphics_simulator::{OutputSettings, SimulatorDisplay};
use embedded_surfaces::geometry::{Affine, Point3, View};
use embedded_surfaces::graphics::Ramps;
use embedded_surfaces::intersect::{CurveKind, CurvePoint, Intersection, Options, Room, intersect};
use embedded_surfaces::num::{Angle, I16F16};
use embedded_surfaces::patch::{BicubicPatch, Surface};
use embedded_surfaces::render::{Area, Light, Scene, Style};
use std::error::Error;
use std::path::PathBuf;
use std::process::ExitCode;
use workspace::Workspace;

/// Intersect pairs of patches and draw them.
#[derive(Parser)]
struct Arguments {
    /// Where the picture goes
    #[arg(short, long, default_value = "intersect.png")]
    output: PathBuf,
    /// Cells of the grids are 1/2^depth of a patch
    #[arg(long, default_value_t = 5, value_parser = clap::value_parser!(u32).range(3..=7))]
    depth: u32,
    /// Width and height of each of the four pictures in pixels
    #[arg(long, default_value_t = 320, value_parser = clap::value_parser!(u32).range(32..=2048))]
    size: u32,
}

const BACKGROUND: Rgb888 = Rgb888::new(24, 26, 32);
const ONE: [Rgb888; 2] = [Rgb888::new(10, 20, 40), Rgb888::new(120, 170, 230)];
const TWO: [Rgb888; 2] = [Rgb888::new(40, 25, 5), Rgb888::new(240, 190, 110)];

/// A sheet over a square: z at the control points.
fn sheet(reach: i16, z: [[i16; 4]; 4]) -> Result<BicubicPatch, Box<dyn Error>> {
    let place = |k: usize| reach / 3 * (2 * k as i16 - 3);
    let points = core::array::from_fn(|i| core::array::from_fn(|j| [place(i), place(j), z[i][j]]));
    Ok(BicubicPatch::from_ints(points)?)
}

/// Two patches with a name.
type Named = (&'static str, [BicubicPatch; 2]);

/// What is drawn.
fn pairs() -> Result<[Named; 4], Box<dyn Error>> {
    let waves = sheet(192, [[90, -80, 70, -60], [-70, 160, -150, 80], [60, -150, 170, -90], [-80, 70, -60, 90]])?;
    let dome = sheet(192, [[-60, -20, -20, -60], [-20, 130, 130, -20], [-20, 130, 130, -20], [-60, -20, -20, -60]])?;
    let slope = sheet(210, [[-14, 6, 26, 46], [-14, 6, 26, 46], [-14, 6, 26, 46], [-14, 6, 26, 46]])?;
    let flat = sheet(210, [[0; 4]; 4])?;
    // z = xy / 128 over the square: two lines that cross in the middle.
    let saddle = sheet(192, [[288, 96, -96, -288], [96, 32, -32, -96], [-96, -32, 32, 96], [-288, -96, 96, 288]])?;
    // z = x² / 512: it touches the plane along a line.
    let trough = sheet(192, [[72; 4], [-24; 4], [-24; 4], [72; 4]])?;
    Ok([
        ("waves and slope", [waves, slope]),
        ("dome and plane", [dome, flat]),
        ("saddle and plane: a branch", [saddle, flat]),
        ("trough on a plane: a tangential curve", [trough, flat]),
    ])
}

fn kind(kind: CurveKind) -> &'static str {
    match kind {
        CurveKind::Closed => "closed",
        CurveKind::TangentPoint => "touching point",
        CurveKind::Tangential => "tangential",
        CurveKind::SharedEdge | CurveKind::SharedEdgeTangential => "shared edge",
        CurveKind::EdgeOnSurface => "edge on surface",
        CurveKind::OverlapRegion => "region",
        _ => "open",
    }
}

fn table(name: &str, found: &Intersection<'_>) {
    let state = if found.is_certified() { "certified".into() } else { format!("{} parts undecided", found.undecided) };
    println!("{name}: {} curves, {} branches, {state}", found.curves().len(), found.branches().len());
    println!("  {:<15} {:>10} {:>7} {:>10} {:>10}", "kind", "length", "points", "residual", "least sine");
    for curve in found.curves() {
        let (length, residual) = (curve.length.to_num::<f64>(), curve.residual.to_bits() as f64 / 2_f64.powi(44));
        let sine = curve.min_sine.to_num::<f64>();
        println!("  {:<15} {length:>10.4} {:>7} {residual:>10.1e} {sine:>10.6}", kind(curve.kind), curve.count);
    }
}

/// The place of a point on the screen, in binary64.
fn project(map: &Affine, p: &CurvePoint) -> Place {
    let x = p.position.to_array().map(|c| c.to_num::<f64>());
    let row = |r: usize| {
        let row = map.rows[r].map(|c| c.to_num::<f64>());
        row[0] * x[0] + row[1] * x[1] + row[2] * x[2] + row[3]
    };
    Place::new(row(0).round() as i32, row(1).round() as i32)
}

fn picture(
    patches: &[BicubicPatch; 2],
    found: &Intersection<'_>,
    size: u32,
) -> Result<SimulatorDisplay<Rgb888>, Box<dyn Error>> {
    let area = Area { x: 0, y: 0, width: size, height: size };
    let view = View { tilt: Angle::from_degrees(-50), spin: Angle::from_degrees(25) };
    let points: Vec<Point3> = patches.iter().flat_map(|p| p.points().as_flattened()).copied().collect();
    let map = view.fit(&points, size, size, I16F16::from_num(0.94))?;
    let seen = patches.iter().map(|p| p.transform(&map)).collect::<Result<Vec<_>, _>>()?;
    let mut display = draw::blank(area, BACKGROUND);
    let scene = Scene::new(&seen, Light::default(), Style::Shaded)?;
    draw::in_bands(&mut display, scene, (&Ramps { ramps: &[&ONE, &TWO] }, BACKGROUND), (area, 16), |_| ())?;
    for curve in found.curves() {
        let points: Vec<_> = found.points(curve).iter().map(|p| project(&map, p)).collect();
        let closing = points.last().copied().zip(points.first().copied()).filter(|_| curve.closed);
        let colour = if curve.kind == CurveKind::Tangential { Rgb888::GREEN } else { Rgb888::RED };
        for (a, b) in points.windows(2).map(|w| (w[0], w[1])).chain(closing) {
            Line::new(a, b).into_styled(PrimitiveStyle::with_stroke(colour, 2)).draw(&mut display)?;
        }
    }
    for branch in found.branches() {
        let disc = Circle::with_center(project(&map, &branch.point), 9);
        disc.into_styled(PrimitiveStyle::with_fill(Rgb888::WHITE)).draw(&mut display)?;
    }
    Ok(display)
}

fn main() -> ExitCode {
    command::end(run(&Arguments::parse()))
}

fn run(arguments: &Arguments) -> Result<(), Box<dyn Error>> {
    let options = Options::DEFAULT.with_depth(arguments.depth);
    let size = arguments.size;
    let mut sheet = SimulatorDisplay::<Rgb888>::with_default_color(Size::new(2 * size, 2 * size), BACKGROUND);
    for (k, (name, patches)) in pairs()?.iter().enumerate() {
        let [a, b] = [patches[0].surface(), patches[1].surface()];
        let room = Room::new(a, b, options.depth)?;
        let mut workspace = Workspace::new(&room, 1 << 15, 10_000, 99);
        let found = intersect(a, b, &options, workspace.buffers())?;
        table(name, &found);
        let part = picture(patches, &found, size)?;
        let corner = Place::new((k as u32 % 2 * size) as i32, (k as u32 / 2 * size) as i32);
        let area = Rectangle::new(corner, part.size());
        sheet.fill_contiguous(&area, part.bounding_box().points().map(|at| part.get_pixel(at)))?;
    }
    command::save_png(&sheet, &OutputSettings::default(), &arguments.output)?;
    println!("{}: {} x {}", arguments.output.display(), 2 * size, 2 * size);
    Ok(())
}
