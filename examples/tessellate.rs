//! The Utah teapot as a watertight mesh: to STL or OBJ, and as a picture of the mesh over the shaded surface.
//!
//! `cargo run --release --example tessellate -- --help`
#![allow(clippy::disallowed_types, clippy::float_arithmetic, reason = "host-side figures and hidden lines")]

#[path = "data/command.rs"]
mod command;
#[path = "data/draw.rs"]
mod draw;
#[path = "data/teapot.rs"]
mod teapot;

use clap::Parser;
use embedded_graphics::pixelcolor::Rgb888;
use embedded_graphics::prelude::*;
use embedded_graphics::primitives::{Line, PrimitiveStyle, Triangle};
use embedded_graphics_simulator::{OutputSettings, SimulatorDisplay};
use embedded_surfaces::geometry::{Affine, View};
use embedded_surfaces::graphics::Material;
use embedded_surfaces::num::{Angle, I16F16, I32F32};
use embedded_surfaces::patch::BicubicPatch;
use embedded_surfaces::reference::fixed_half_up;
use embedded_surfaces::render::{Area, Light, Scene, Style};
use embedded_surfaces::subdivide::{
    Mesh, MeshBuffers, MeshVertex, PatchTopology, Tolerance, tessellate, topology, write_stl, write_stl_text,
};
use std::error::Error;
use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Write the Utah teapot as a watertight triangle mesh.
#[derive(Parser)]
struct Arguments {
    /// Largest distance between mesh and surface, in millimetres
    #[arg(long, default_value_t = 0.5, allow_negative_numbers = true)]
    tolerance: f64,
    /// Length of the teapot from handle to spout, in millimetres
    #[arg(long, default_value_t = 160.0, allow_negative_numbers = true)]
    length: f64,
    /// Where the mesh goes: NAME.stl or NAME.obj
    #[arg(short, long, default_value = "teapot.stl")]
    output: PathBuf,
    /// Write STL as text
    #[arg(long)]
    text: bool,
    /// Where the picture goes
    #[arg(long, default_value = "mesh.png")]
    picture: PathBuf,
    /// What the picture shows
    #[arg(long, value_enum, default_value_t = Look::Mesh)]
    style: Look,
    /// Width and height of the picture in pixels
    #[arg(long, num_args = 2, value_names = ["WIDTH", "HEIGHT"], default_values_t = [960, 720],
        value_parser = clap::value_parser!(u32).range(1..=4096))]
    size: Vec<u32>,
    /// Turn about the screen's horizontal, in degrees
    #[arg(long, default_value_t = -60, allow_negative_numbers = true)]
    tilt: i32,
    /// Turn about the model's vertical, in degrees
    #[arg(long, default_value_t = 30, allow_negative_numbers = true)]
    spin: i32,
}

#[derive(Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum Look {
    /// The edges of the mesh over the exact shaded surface
    Mesh,
    /// The triangles, each in one shade
    Facets,
}

const COLOUR: Rgb888 = Rgb888::new(236, 196, 140);
const EDGE: Rgb888 = Rgb888::new(30, 60, 110);
const BACKGROUND: Rgb888 = Rgb888::new(24, 28, 44);

fn main() -> ExitCode {
    command::end(run(&Arguments::parse()))
}

fn run(arguments: &Arguments) -> Result<(), Box<dyn Error>> {
    let scale = to_millimetres(arguments.length)?;
    let patches = teapot::patches(&scale)?;
    let tolerance = fixed_half_up(arguments.tolerance).ok_or("--tolerance: out of range")?;
    let tolerance = Tolerance::new(tolerance).map_err(|error| format!("--tolerance: {error}"))?;

    // The topology needs one entry a patch; it could be a constant in flash.
    let mut table = [PatchTopology::default(); 32];
    topology(&patches, &mut table)?;
    let tessellation = tessellate(&patches, &table, tolerance).map_err(|error| error.to_string())?;
    let size = tessellation.size();
    let (mut vertices, mut triangles) = (vec![MeshVertex::BLANK; size.vertices], vec![[0; 3]; size.triangles]);
    let mut index = vec![0; 2 * size.index];
    let buffers = MeshBuffers { vertices: &mut vertices, triangles: &mut triangles, index: &mut index };
    let mesh = tessellation.mesh(buffers)?;

    save(arguments, &mesh)?;
    println!("{}: within {} mm of the surface", arguments.output.display(), arguments.tolerance);
    println!("  parts       {}", table.iter().map(PatchTopology::part).max().map_or(0, |last| last + 1));
    println!("  triangles   {}", mesh.triangles().len());
    println!("  vertices    {}", mesh.vertices().len());
    let [width, height] = arguments.size[..] else { return Err("--size takes two numbers".into()) };
    let area = Area { x: 0, y: 0, width, height };
    let view = View { tilt: Angle::from_degrees(arguments.tilt), spin: Angle::from_degrees(arguments.spin) };
    let points = mesh.vertices().iter().map(|vertex| vertex.point);
    let to_screen = view.fit(points, width, height, I16F16::from_num(0.92))?;
    let picture = picture(arguments, &patches, &mesh, (&to_screen, area))?;
    command::save_png(&picture, &OutputSettings::default(), &arguments.picture)?;
    println!("{}: {width} x {height}", arguments.picture.display());
    Ok(())
}

/// The map of the model to millimetres.
fn to_millimetres(length: f64) -> Result<Affine, Box<dyn Error>> {
    let along = teapot::vertices().map(|p| p.x.to_num::<f64>());
    let extent = along.clone().fold(f64::MIN, f64::max) - along.fold(f64::MAX, f64::min);
    let factor = I32F32::checked_from_num(length / extent).filter(|f| *f > 0).ok_or("--length: out of range")?;
    Ok(Affine::scaling(factor, factor, factor))
}

/// What `core::fmt::Write` writes goes to a file.
struct Text(BufWriter<File>, std::io::Result<()>);

impl core::fmt::Write for Text {
    fn write_str(&mut self, text: &str) -> core::fmt::Result {
        self.0.write_all(text.as_bytes()).map_err(|error| {
            self.1 = Err(error);
            core::fmt::Error
        })
    }
}

/// Writes the mesh in the format of the file's name.
fn save(arguments: &Arguments, mesh: &Mesh<'_>) -> Result<(), Box<dyn Error>> {
    let path: &Path = &arguments.output;
    let obj = match path.extension().and_then(|e| e.to_str()) {
        Some("stl") => false,
        Some("obj") => true,
        _ => return Err(format!("{}: neither .stl nor .obj", path.display()).into()),
    };
    let mut file = BufWriter::new(File::create(path).map_err(|e| format!("{}: {e}", path.display()))?);
    if !obj && !arguments.text {
        write_stl(mesh.corners(), |bytes| file.write_all(bytes))?;
        return Ok(file.flush()?);
    }
    let mut text = Text(file, Ok(()));
    let result = if obj { mesh.write_obj(&mut text) } else { write_stl_text("teapot", mesh.corners(), &mut text) };
    text.1?;
    result?;
    Ok(text.0.flush()?)
}

/// A corner on the screen, in pixels.
type Place = [f64; 3];

fn picture(
    arguments: &Arguments,
    patches: &[BicubicPatch],
    mesh: &Mesh<'_>,
    (to_screen, area): (&Affine, Area),
) -> Result<SimulatorDisplay<Rgb888>, Box<dyn Error>> {
    let mut display = draw::blank(area, BACKGROUND);
    let mut seen = Vec::new();
    for corners in mesh.corners() {
        let mut places = [[0.0; 3]; 3];
        for (place, corner) in places.iter_mut().zip(corners) {
            *place = to_screen.apply::<I16F16>(&corner)?.to_array().map(I16F16::to_num::<f64>);
        }
        seen.push(places);
    }
    if arguments.style == Look::Facets {
        facets(&mut display, seen)?;
        return Ok(display);
    }
    let patches = patches.iter().map(|patch| patch.transform(to_screen)).collect::<Result<Vec<_>, _>>()?;
    let scene = Scene::new(&patches, Light::default(), Style::Shaded)?;
    let paint = (&Material { colour: COLOUR }, BACKGROUND);
    draw::in_bands(&mut display, scene, paint, (area, 16), |_| ())?;
    let depths = Depths::of(&seen, area);
    for places in &seen {
        for k in 0..3 {
            depths.line(&mut display, places[k], places[(k + 1) % 3])?;
        }
    }
    Ok(display)
}

fn pixel([x, y, _]: Place) -> Point {
    Point::new(x.round() as i32, y.round() as i32)
}

/// The z of the normal, twice the area long: negative for what faces the viewer.
fn facing([a, b, c]: &[Place; 3]) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

/// Draws the triangles themselves with `embedded-graphics`, far ones first.
fn facets(display: &mut SimulatorDisplay<Rgb888>, mut triangles: Vec<[Place; 3]>) -> Result<(), Box<dyn Error>> {
    let depth = |triangle: &[Place; 3]| triangle.iter().map(|p| p[2]).sum::<f64>();
    triangles.sort_by(|a, b| depth(b).total_cmp(&depth(a)));
    for triangle in &triangles {
        let [a, b, c] = triangle;
        let edge = |to: &Place| [0, 1, 2].map(|k: usize| to[k] - a[k]);
        let (p, q) = (edge(b), edge(c));
        let normal = [0, 1, 2].map(|k: usize| p[(k + 1) % 3] * q[(k + 2) % 3] - p[(k + 2) % 3] * q[(k + 1) % 3]);
        let length = normal.iter().map(|c| c * c).sum::<f64>().sqrt();
        // Light from above left, towards the viewer; the inside is as bright as the outside.
        let level =
            if length > 0.0 { (normal[0] * 0.4 + normal[1] * 0.5 + normal[2] * 0.77).abs() / length } else { 0.0 };
        let shade = |c: u8| (f64::from(c) * (0.15 + 0.85 * level.min(1.0))) as u8;
        let colour = Rgb888::new(shade(COLOUR.r()), shade(COLOUR.g()), shade(COLOUR.b()));
        let [a, b, c] = triangle.map(pixel);
        Triangle::new(a, b, c).into_styled(PrimitiveStyle::with_fill(colour)).draw(display)?;
    }
    Ok(())
}

/// The nearest z of the mesh at each pixel centre.
struct Depths {
    width: u32,
    nearest: Vec<f64>,
}

impl Depths {
    /// Lines stand this many pixels before the surface.
    const LEAD: f64 = 1.5;

    fn of(triangles: &[[Place; 3]], area: Area) -> Self {
        let mut depths = Self { width: area.width, nearest: vec![f64::INFINITY; (area.width * area.height) as usize] };
        for triangle in triangles {
            let area = facing(triangle);
            let range = |axis: usize, most: u32| {
                let along = triangle.map(|p| p[axis]);
                let low = along.into_iter().fold(f64::MAX, f64::min).ceil().max(0.0) as u32;
                low..=(along.into_iter().fold(f64::MIN, f64::max).floor().max(-1.0).min(f64::from(most) - 1.0)) as u32
            };
            if area.abs() <= 0.0 {
                continue;
            }
            for y in range(1, depths.nearest.len() as u32 / depths.width) {
                for x in range(0, depths.width) {
                    let at = [f64::from(x), f64::from(y), 0.0];
                    let [a, b, c] = triangle;
                    let part = [facing(&[at, *b, *c]), facing(&[*a, at, *c]), facing(&[*a, *b, at])].map(|w| w / area);
                    if part.iter().all(|w| *w >= 0.0) {
                        let z = part[0] * a[2] + part[1] * b[2] + part[2] * c[2];
                        let nearest = &mut depths.nearest[(y * depths.width + x) as usize];
                        *nearest = nearest.min(z);
                    }
                }
            }
        }
        depths
    }

    /// Draws what of a line stands before the surface.
    fn line(&self, display: &mut SimulatorDisplay<Rgb888>, a: Place, b: Place) -> Result<(), Box<dyn Error>> {
        let (from, to) = (pixel(a), pixel(b));
        let longest = (to.x - from.x).abs().max((to.y - from.y).abs()).max(1);
        let seen = Line::new(from, to).points().enumerate().filter(|(k, p)| {
            let part = *k as f64 / f64::from(longest);
            let z = a[2] + part * (b[2] - a[2]);
            let inside = p.x >= 0 && p.y >= 0 && (p.x as u32) < self.width;
            let nearest = inside.then(|| self.nearest.get(p.y as usize * self.width as usize + p.x as usize)).flatten();
            nearest.is_some_and(|nearest| z <= nearest + Self::LEAD)
        });
        Ok(display.draw_iter(seen.map(|(_, p)| Pixel(p, EDGE)))?)
    }
}
