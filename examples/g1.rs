//! Skins over coarse meshes, side by side: flat triangles, PN triangles, and smooth ones, with reflected stripes (zebra
//! shading), which are bent at an edge where the tangent plane is, and torn where it is not continuous.
//!
//! ```sh
//! cargo run --release --example g1 -- -o g1.png              # icosahedron, torus, duck
//! cargo run --release --example g1 -- --mesh bunny.obj       # a mesh of your own, OBJ or STL
//! ```
#![allow(clippy::disallowed_types, clippy::float_arithmetic, reason = "a picture made on a host")]

#[path = "data/command.rs"]
mod command;
#[path = "data/mesh_file.rs"]
mod mesh_file;
#[path = "data/polyhedra.rs"]
mod polyhedra;
#[path = "data/zebra.rs"]
mod zebra;

use clap::Parser;
use embedded_graphics::pixelcolor::Rgb888;
use embedded_graphics::prelude::*;
use embedded_graphics_simulator::{OutputSettings, SimulatorDisplay};
use embedded_surfaces::g1::{Controls, Interpolant, Options, Quality, Scheme, Shift};
use embedded_surfaces::geometry::Point3;
use embedded_surfaces::mesh::{Faces, Links, Mesh};
use embedded_surfaces::num::I32F32;
use mesh_file::Polyhedron;
use std::error::Error;
use std::path::PathBuf;
use std::process::ExitCode;

/// Draw coarse meshes as flat triangles, PN triangles and smooth quintic triangles.
#[derive(Parser)]
struct Arguments {
    /// A mesh of triangles, NAME.obj or NAME.stl, instead of the three that are built in
    #[arg(long)]
    mesh: Option<PathBuf>,
    /// Where the picture goes
    #[arg(short, long, default_value = "g1.png")]
    output: PathBuf,
    /// Height and width of a single picture, in pixels
    #[arg(long, default_value_t = 320, value_parser = clap::value_parser!(u32).range(16..=2048))]
    size: u32,
    /// Degrees that the model's z axis is tilted towards the viewer
    #[arg(long, default_value_t = 62.0, allow_negative_numbers = true)]
    tilt: f64,
    /// Degrees that the model is turned about its z axis first
    #[arg(long, default_value_t = 28.0, allow_negative_numbers = true)]
    spin: f64,
    /// Bright Lambert shading instead of stripes
    #[arg(long)]
    plain: bool,
}

const SCHEMES: [(Scheme, &str); 3] =
    [(Scheme::Flat, "flat"), (Scheme::PointNormal, "PN triangles"), (Scheme::Smooth, "smooth")];

/// Room for meshes of files.
const VERTICES: usize = 10_000;

/// Control points of all faces, in units of the mesh, and how good they are.
fn skin(mesh: &Polyhedron, scheme: Scheme) -> Result<(Vec<zebra::Net>, Quality), Box<dyn Error>> {
    let largest = mesh.points.iter().flatten().fold(0.0_f64, |largest, c| largest.max(c.abs()));
    let scale = (10.0 - largest.log2().floor()).exp2();
    let point = |p: &[f64; 3]| Point3::from_array(p.map(|c| I32F32::saturating_from_num(c * scale)));
    let points: Vec<_> = mesh.points.iter().map(point).collect();
    let links = Box::new(Links::<VERTICES, { 6 * VERTICES }>::new(points.len(), Faces::Triangles(&mesh.faces))?);
    let mesh = Mesh::<I32F32>::new(&points, &links)?;
    let mut shifts = vec![Shift::NONE; points.len()];
    let options = Options { scheme, ..Options::default() };
    let surface = Interpolant::new(&mesh, &Controls::default(), &options, &mut shifts)?;
    let triangles = surface.triangles().collect::<Result<Vec<_>, _>>()?;
    let float = |p: &Point3<I32F32>| p.to_array().map(|c| c.to_num::<f64>() / scale);
    let nets = triangles.iter().map(|triangle| core::array::from_fn(|i| float(&triangle.points()[i])));
    Ok((nets.collect(), surface.quality()?))
}

fn main() -> ExitCode {
    command::end(run(&Arguments::parse()))
}

fn run(arguments: &Arguments) -> Result<(), Box<dyn Error>> {
    let models = match &arguments.mesh {
        Some(path) => {
            let mesh = mesh_file::read(path).map_err(|error| format!("{}: {error}", path.display()))?;
            vec![(path.display().to_string(), mesh)]
        }
        None => vec![
            ("icosahedron".to_owned(), polyhedra::icosahedron()),
            ("torus".to_owned(), polyhedra::torus(9, 6)),
            ("duck".to_owned(), polyhedra::duck()),
        ],
    };
    let size = arguments.size;
    let whole = Size::new(size * SCHEMES.len() as u32, size * models.len() as u32);
    let mut picture = SimulatorDisplay::with_default_color(whole, Rgb888::WHITE);
    for (row, (name, mesh)) in models.iter().enumerate() {
        println!("{name}: {} vertices, {} faces", mesh.points.len(), mesh.faces.len());
        for (column, (scheme, title)) in SCHEMES.into_iter().enumerate() {
            let (nets, quality) = skin(mesh, scheme).map_err(|error| format!("{name}, {title}: {error}"))?;
            let angle = (quality.max_angle as f64 / 2_f64.powi(60)).to_degrees();
            println!("  {title}: normals differ by at most {angle:.1e} degrees, {} faces fold", quality.folded);
            let view = zebra::View { tilt: arguments.tilt.to_radians(), spin: arguments.spin.to_radians() };
            let pixels = zebra::draw(&nets, &mesh.points, view, size, arguments.plain);
            let corner = Point::new((column as u32 * size) as i32, (row as u32 * size) as i32);
            let place = |i: usize| corner + Point::new((i as u32 % size) as i32, (i as u32 / size) as i32);
            let pixels = pixels.into_iter().enumerate();
            let Ok(()) = picture.draw_iter(pixels.map(|(i, [r, g, b])| Pixel(place(i), Rgb888::new(r, g, b))));
        }
    }
    command::save_png(&picture, &OutputSettings::default(), &arguments.output)?;
    println!("{}", arguments.output.display());
    Ok(())
}
