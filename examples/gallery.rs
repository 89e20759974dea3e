//! Every picture of the docs, drawn anew: `cargo run --release --example gallery -- -o docs/img`.
//!
//! CI compares the files byte for byte; `UPDATE_DOCS=1 cargo test --test docs` embeds them in the docs.
#![allow(clippy::disallowed_types, clippy::float_arithmetic, reason = "host-side figures")]

#[path = "data/command.rs"]
mod command;
#[path = "data/convergence.rs"]
mod convergence;
#[path = "data/draw.rs"]
mod draw;
#[path = "data/seed.rs"]
mod seed;
#[path = "data/teapot.rs"]
mod teapot;
#[path = "data/turning.rs"]
#[allow(dead_code, reason = "its parts for tests")]
mod turning;

use clap::Parser;
use embedded_graphics::Drawable;
use embedded_graphics::draw_target::DrawTargetExt;
use embedded_graphics::pixelcolor::{BinaryColor, Gray2, Gray4, PixelColor, Rgb888};
use embedded_graphics::prelude::{GrayColor, RgbColor};
use embedded_graphics_simulator::{OutputSettings, OutputSettingsBuilder, SimulatorDisplay};
use embedded_surfaces::geometry::{Affine, Perspective, View};
use embedded_surfaces::graphics::{BezierCurve, Material, Ramps, Shade, Stroke};
use embedded_surfaces::num::{Angle, I16F16, I32F32};
use embedded_surfaces::patch::{
    BicubicPatch, CubicCurve, Curve, QuadraticCurve, RationalCurve, RationalTensor, Surface, SurfaceNet, cone,
    cylinder, sphere, torus,
};
use embedded_surfaces::render::{Area, Fragment, Gloss, Light, Lines, Scene, Style};
use std::error::Error;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Draw every picture of the docs.
#[derive(Parser)]
struct Arguments {
    /// The folder that the pictures go to
    #[arg(short, long, default_value = "docs/img")]
    output: PathBuf,
}

type Outcome = Result<(), Box<dyn Error>>;

const BACKGROUND: Rgb888 = Rgb888::new(24, 28, 44);
const CLAY: Rgb888 = Rgb888::new(236, 196, 140);
const SCREEN: Area = Area { x: 0, y: 0, width: 320, height: 240 };

fn main() -> ExitCode {
    command::end(run(&Arguments::parse().output))
}

fn run(folder: &Path) -> Outcome {
    std::fs::create_dir_all(folder)?;
    let pot = pot(SCREEN, View::default())?;
    single(folder, "teapot", &pot, &Material { colour: CLAY }, BACKGROUND)?;
    single(folder, "teapot_1_bit", &pot, &Material { colour: BinaryColor::On }, BinaryColor::Off)?;
    single(folder, "teapot_4_greys", &pot, &Material { colour: Gray2::WHITE }, Gray2::BLACK)?;
    perspective(folder)?;
    oled(folder)?;
    seed_patches(folder)?;
    styles(folder)?;
    shapes(folder)?;
    curves(folder)?;
    save(folder, "convergence", &convergence::draw(BACKGROUND)?)
}

fn save<C: PixelColor + Into<Rgb888>>(folder: &Path, name: &str, display: &SimulatorDisplay<C>) -> Outcome {
    let path = folder.join(name).with_extension("png");
    command::save_png(display, &OutputSettings::default(), &path)?;
    println!("{}", path.display());
    Ok(())
}

/// The teapot fitted to a part of a picture.
fn pot(area: Area, view: View) -> Result<[BicubicPatch; 32], Box<dyn Error>> {
    let fitted = view.fit(teapot::vertices(), area.width, area.height, I16F16::from_num(0.92))?;
    Ok(teapot::patches(&fitted.then(&moved(area))?)?)
}

/// The map from a picture of its own to a part of another.
fn moved(area: Area) -> Affine {
    Affine::translation(I32F32::from_num(area.x), I32F32::from_num(area.y), I32F32::ZERO)
}

fn single<P>(folder: &Path, name: &str, patches: &[BicubicPatch], paint: &P, background: P::Pixel) -> Outcome
where
    P: embedded_surfaces::render::Paint,
    P::Pixel: PixelColor + Into<Rgb888>,
{
    let mut display = draw::blank(SCREEN, background);
    let scene = Scene::new(patches, Light::default(), Style::Shaded)?;
    draw::in_bands(&mut display, scene, (paint, background), (SCREEN, 16), |_| ())?;
    save(folder, name, &display)
}

/// The teapot seen from nearby: rational patches, glossy, with a ramp from shadow to highlight.
fn perspective(folder: &Path) -> Outcome {
    let view = View { tilt: Angle::from_degrees(-72), spin: Angle::from_degrees(30) };
    let eye = Perspective {
        centre_x: I16F16::from_num(160),
        centre_y: I16F16::from_num(120),
        distance: I16F16::from_num(420),
    };
    let pot = pot(SCREEN, view)?;
    let seen = pot.iter().map(|patch| patch.perspective(&eye)).collect::<Result<Vec<_>, _>>()?;
    let glaze = [Rgb888::new(10, 14, 40), Rgb888::new(40, 90, 170), Rgb888::new(120, 190, 240), Rgb888::WHITE];
    let mut display = draw::blank(SCREEN, BACKGROUND);
    let scene = Scene::new(&seen, Light::default(), Style::Glossy(Gloss::new(150, 28)))?;
    draw::in_bands(&mut display, scene, (&Ramps { ramps: &[&glaze] }, BACKGROUND), (SCREEN, 16), |_| ())?;
    save(folder, "perspective", &display)
}

/// Three frames of `fw_oled`, each pixel twice as wide and as high.
fn oled(folder: &Path) -> Outcome {
    let (screen, gap) = (turning::AREA, 4);
    let mut display = draw::blank(Area { width: 3 * screen.width + 2 * gap, ..screen }, Gray4::new(4));
    for (k, frame) in (0..3).zip([3, 17, 30]) {
        let panel = Area { x: k * (screen.width + gap) as i32, ..screen };
        turning::draw(frame, &mut turning::Buffers::new(), &mut display.cropped(&panel.into()))
            .map_err(|fault| format!("{fault:?}"))?;
    }
    let path = folder.join("oled.png");
    command::save_png(&display, &OutputSettingsBuilder::new().scale(2).build(), &path)?;
    println!("{}", path.display());
    Ok(())
}

/// The two patches of the point-by-point paper, along z and along x.
fn seed_patches(folder: &Path) -> Outcome {
    let mut display = draw::blank(seed::AREA, BACKGROUND);
    let patches = seed::both_views()?;
    let paint = |at: Fragment| seed::COLOURS.get(at.patch % 2).map_or(CLAY, |c| c.shaded(at.shade, at.x, at.y));
    let scene = Scene::new(&patches, Light::default(), Style::Shaded)?;
    draw::in_bands(&mut display, scene, (&paint, BACKGROUND), (seed::AREA, 16), |_| ())?;
    save(folder, "seed_patches", &display)
}

/// Six styles of the same teapot.
fn styles(folder: &Path) -> Outcome {
    let lines = Lines::every(5).without_hidden();
    let styles = [
        Style::Shaded,
        Style::Glossy(Gloss::new(110, 24)),
        Style::DepthCued { near: 255, far: 50 },
        Style::Wire(lines),
        Style::Net { hidden: false },
        Style::Normals { lines: Lines::every(3).without_hidden(), length: 9 },
    ];
    let mut display = draw::blank(Area { x: 0, y: 0, width: 660, height: 330 }, BACKGROUND);
    for (k, style) in styles.into_iter().enumerate() {
        let area = Area { x: 220 * (k as i32 % 3), y: 165 * (k as i32 / 3), width: 220, height: 165 };
        let pot = pot(area, View::default())?;
        let scene = Scene::new(&pot, Light::default(), style)?;
        let paint = Material { colour: CLAY };
        draw::in_bands(&mut display, scene, (&paint, BACKGROUND), (area, 16), |_| ())?;
    }
    save(folder, "styles", &display)
}

/// Sphere, cylinder, cone and torus: rational patches with the weights 1, 1, 2, tilted.
fn shapes(folder: &Path) -> Outcome {
    let origin = embedded_surfaces::geometry::Point3::ORIGIN;
    let size = I16F16::from_num;
    let solids: [Vec<RationalTensor<3, 3>>; 4] = [
        sphere(origin, size(60))?.to_vec(),
        cylinder(origin, size(42), size(100))?.to_vec(),
        cone(origin, size(55), size(110))?.to_vec(),
        torus(origin, size(46), size(20))?.to_vec(),
    ];
    let colours = [
        Rgb888::new(240, 140, 120),
        Rgb888::new(130, 200, 140),
        Rgb888::new(240, 210, 110),
        Rgb888::new(140, 170, 240),
    ];
    let mut display = draw::blank(Area { x: 0, y: 0, width: 640, height: 160 }, BACKGROUND);
    let view = View { tilt: Angle::from_degrees(-60), spin: Angle::from_degrees(20) };
    for (k, (solid, colour)) in solids.iter().zip(colours).enumerate() {
        let area = Area { x: 160 * k as i32, y: 0, width: 160, height: 160 };
        let points = solid.iter().flat_map(|patch| patch.surface().points().iter());
        let map = view.fit(points, area.width, area.height, I16F16::from_num(0.85))?.then(&moved(area))?;
        let seen = solid.iter().map(|patch| patch.transform(&map)).collect::<Result<Vec<_>, _>>()?;
        let nets: Vec<SurfaceNet<'_>> = seen.iter().map(Surface::surface).collect();
        let scene = Scene::new(&nets, Light::default(), Style::Glossy(Gloss::new(90, 20)))?;
        draw::in_bands(&mut display, scene, (&Material { colour }, BACKGROUND), (area, 16), |_| ())?;
    }
    save(folder, "shapes", &display)
}

/// Curves without a surface: strokes of 1 to 12 pixels, of degrees 2 to 5, and a circle of four rational arcs.
fn curves(folder: &Path) -> Outcome {
    let area = Area { x: 0, y: 0, width: 640, height: 160 };
    let mut display = draw::blank(area, BACKGROUND);
    let colours = [CLAY, Rgb888::new(130, 200, 140), Rgb888::new(240, 140, 120), Rgb888::new(140, 170, 240)];
    let arch = QuadraticCurve::from_ints([[15, 140, 0], [70, -90, 0], [145, 130, 0]])?;
    let loop_ = CubicCurve::from_ints([[170, 140, 0], [400, 0, 0], [100, -10, 0], [310, 145, 0]])?;
    let wave = Curve::<6>::from_ints([
        [330, 80, 0],
        [360, -160, 0],
        [380, 330, 0],
        [430, -160, 0],
        [450, 320, 0],
        [475, 80, 0],
    ])?;
    for (curve, (colour, width)) in [BezierCurve::new(&arch)?, BezierCurve::new(&loop_)?, BezierCurve::new(&wave)?]
        .iter()
        .zip(colours.into_iter().zip([1, 3, 8]))
    {
        Stroke::<_>::new(*curve, colour, width).draw(&mut display)?;
    }
    let (x, y, r) = (565_i16, 80_i16, 60_i16);
    for [a, b] in [[1, 1], [-1, 1], [-1, -1], [1, -1]] {
        let arc = QuadraticCurve::from_ints([[x + a * r, y, 0], [x + a * r, y + b * r, 0], [x, y + b * r, 0]])?;
        let arc = RationalCurve::new(arc, [1, 1, 2].map(I16F16::from_num))?;
        Stroke::<_>::new(BezierCurve::new(&arc)?, colours[3], 12).draw(&mut display)?;
    }
    save(folder, "curves", &display)
}
