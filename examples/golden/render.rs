//! `golden render`: a picture of patches, and what it cost.

use crate::case::Patch;
use crate::field::{Field, Malformed};
use crate::view::View;
use crate::{Answer, typed_error};
use embedded_graphics::pixelcolor::Rgb888;
use embedded_graphics::prelude::Size;
use embedded_graphics_simulator::{OutputSettings, SimulatorDisplay};
use embedded_surfaces::geometry::{Axis, GeometryError, Point3};
use embedded_surfaces::graphics::Material;
use embedded_surfaces::num::I16F16;
use embedded_surfaces::patch::SurfaceNet;
use embedded_surfaces::reference::Audit;
use embedded_surfaces::render::{Area, Frame, Light, RenderError, Scene, Style};
use serde_json::Map;
use std::path::PathBuf;

/// The settings of a picture.
struct Settings {
    area: Area,
    band: u32,
    style: Style,
    colour: Rgb888,
    background: Rgb888,
}

fn colour(field: Option<Field<'_>>, default: [u8; 3]) -> Result<Rgb888, Malformed> {
    let [r, g, b] = field.map_or(Ok(default), |f| f.colour())?;
    Ok(Rgb888::new(r, g, b))
}

impl Settings {
    fn read(case: &Field<'_>) -> Result<Self, Malformed> {
        if let Some(fill) = case.get("fill").filter(|f| f.value() != "exact") {
            return Err(fill.malformed("only \"exact\" is supported"));
        }
        let (width, height) = match case.get("size") {
            None => (320, 240),
            Some(size) => {
                let [w, h] = size.fixed()?;
                (w.whole(1..=8192)?, h.whole(1..=8192)?)
            }
        };
        let style = match case.get("style") {
            None => Style::Shaded,
            Some(style) => match style.text()? {
                "shaded" => Style::Shaded,
                "flat" => Style::Flat,
                other => return Err(style.malformed(&format!("{other:?} is neither \"shaded\" nor \"flat\""))),
            },
        };
        Ok(Self {
            area: Area { x: 0, y: 0, width, height },
            band: case.get("band").map_or(Ok(16), |f| f.whole(1..=u32::MAX))?,
            style,
            colour: colour(case.get("color"), [255; 3])?,
            background: colour(case.get("background"), [0; 3])?,
        })
    }
}

/// The control points of all patches on the screen, or the typed error of the first out of range.
fn on_screen(
    case: &Field<'_>,
    patches: &[Patch<'_>],
    area: Area,
) -> Result<Result<Vec<Vec<Point3<I16F16>>>, GeometryError>, Malformed> {
    let model: Vec<[f64; 3]> = patches.iter().flat_map(Patch::points).copied().collect();
    let view = View::read(case, (area.width, area.height), &model)?;
    if matches!(view, View::Screen) {
        return patches.iter().map(Patch::fixed_points).collect::<Result<_, _>>().map(Ok);
    }
    let map = |p: &[f64; 3]| {
        let image = view.apply(*p);
        Patch::fix(image).ok_or_else(|| {
            let far = Axis::ALL.into_iter().zip(image).max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()));
            let (axis, c) = far.unwrap_or((Axis::X, 0.0));
            GeometryError::OutOfRange { axis, units: Patch::units(c), limit: 32767 }
        })
    };
    Ok(patches.iter().map(|patch| patch.points().iter().map(map).collect()).collect())
}

pub(crate) fn run(case: &Field<'_>, output: Option<PathBuf>) -> Answer {
    let settings = Settings::read(case)?;
    let patches = Patch::read_all(case)?;
    let points = match on_screen(case, &patches, settings.area)? {
        Ok(points) => points,
        Err(error) => return Ok(typed_error(&error)),
    };
    let mut nets = Vec::new();
    for (patch, points) in patches.iter().zip(&points) {
        nets.push(patch.net(points).map_err(|error| case.malformed(&error.to_string()))?);
    }
    match picture(&settings, &nets) {
        Ok((display, points, audit)) => {
            if let Some(path) = output {
                let image = display.to_rgb_output_image(&OutputSettings::default());
                image.save_png(&path).map_err(|e| Malformed::new("-o", &format!("{}: {e}", path.display())))?;
            }
            Ok(Map::from_iter([
                ("status".to_owned(), "ok".into()),
                ("points".to_owned(), points.into()),
                ("pixels".to_owned(), audit.pixels.into()),
                ("pieces".to_owned(), nets.len().into()),
                ("splits".to_owned(), 0.into()),
                ("missed".to_owned(), audit.missed.len().into()),
            ]))
        }
        Err(RenderError::Patch { error, .. }) => Ok(typed_error(&error)),
        Err(error) => Ok(typed_error(&error)),
    }
}

/// The picture, the lattice points that it took, and the audit against the reference.
fn picture(
    settings: &Settings,
    nets: &[SurfaceNet<'_>],
) -> Result<(SimulatorDisplay<Rgb888>, u64, Audit), RenderError> {
    let size = Size::new(settings.area.width, settings.area.height);
    let mut display = SimulatorDisplay::with_default_color(size, settings.background);
    let paint = Material { colour: settings.colour };
    let scene = Scene::new(nets, Light::default(), settings.style)?;
    let mut frame = Frame::new(scene, &paint, settings.background, settings.area, settings.band)?;
    let (mut colour, mut depth) = (vec![settings.background; frame.band_pixels()], vec![0; frame.band_pixels()]);
    while let Some(band) = frame.next_band(&mut colour, &mut depth)? {
        let Ok(()) = band.draw(&mut display);
    }
    Ok((display, frame.statistics().points, Audit::of(nets, settings.area)?))
}
