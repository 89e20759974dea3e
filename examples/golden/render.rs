//! `golden render`: a picture of patches, and what it cost.

use crate::case::Patch;
use crate::draw;
use crate::field::{Field, Malformed};
use crate::view::View;
use crate::{Answer, typed_error};
use embedded_graphics::pixelcolor::Rgb888;
use embedded_graphics_simulator::{OutputSettings, SimulatorDisplay};
use embedded_surfaces::geometry::{Axis, GeometryError, Point3};
use embedded_surfaces::graphics::Material;
use embedded_surfaces::num::I16F16;
use embedded_surfaces::patch::SurfaceNet;
use embedded_surfaces::reference::{Audit, fixed_half_up};
use embedded_surfaces::render::{Area, Fill, Light, Lines, RenderError, Scene, Statistics, Style};
use embedded_surfaces::subdivide::{PatchTopology, SubdivideError, topology};
use serde_json::Map;
use std::path::PathBuf;

/// The settings of a picture.
struct Settings {
    area: Area,
    band: u32,
    style: Style,
    fill: Fill,
    colour: Rgb888,
    background: Rgb888,
}

fn colour(field: Option<Field<'_>>, default: [u8; 3]) -> Result<Rgb888, Malformed> {
    let [r, g, b] = field.map_or(Ok(default), |f| f.colour())?;
    Ok(Rgb888::new(r, g, b))
}

impl Settings {
    fn read(case: &Field<'_>) -> Result<Self, Malformed> {
        let fill = match case.get("fill").filter(|f| f.value() != "exact") {
            None => Fill::Exact,
            Some(fill) => {
                let Some(tolerance) = fill.get("grid") else {
                    return Err(fill.malformed("neither \"exact\" nor {\"grid\": tolerance}"));
                };
                let fixed = fixed_half_up(tolerance.number()?);
                let out_of_range = || tolerance.malformed("the tolerance does not fit 16 bits before the point");
                Fill::Grid { tolerance: fixed.ok_or_else(out_of_range)? }
            }
        };
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
                "wire" => Style::Wire(Lines::every(8).without_hidden()),
                "net" => Style::Net { hidden: false },
                other => return Err(style.malformed(&format!("{other:?} is none of shaded, flat, wire and net"))),
            },
        };
        Ok(Self {
            area: Area { x: 0, y: 0, width, height },
            band: case.get("band").map_or(Ok(16), |f| f.whole(1..=u32::MAX))?,
            style,
            fill,
            colour: colour(case.get("color"), [255; 3])?,
            background: colour(case.get("background"), [0; 3])?,
        })
    }
}

/// The control points and weights of a patch on the screen.
struct Seen {
    points: Vec<Point3<I16F16>>,
    weights: Option<Vec<I16F16>>,
}

/// One patch seen by a view: rounded once, half up.
fn see(patch: &Patch<'_>, view: &View) -> Result<Seen, GeometryError> {
    let rational = view.is_perspective() || patch.weights().is_some();
    let mut seen = Seen { points: Vec::new(), weights: rational.then(Vec::new) };
    for (index, p) in patch.points().iter().enumerate() {
        let (image, perspective) = view.apply(*p)?;
        let out_of_range = |c: f64, axis| GeometryError::OutOfRange { axis, units: Patch::units(c), limit: 32767 };
        let farthest = || {
            let far = Axis::ALL.into_iter().zip(image).max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()));
            far.map_or(out_of_range(0.0, Axis::X), |(axis, c)| out_of_range(c, axis))
        };
        seen.points.push(Patch::fix(image).ok_or_else(farthest)?);
        if let Some(weights) = &mut seen.weights {
            let own = patch.weights().and_then(|w| w.get(index)).map_or(1.0, |w| w.to_num::<f64>());
            let weight = fixed_half_up(own * perspective).filter(|w| *w > 0);
            weights.push(weight.ok_or_else(|| out_of_range(own * perspective, Axis::Z))?);
        }
    }
    Ok(seen)
}

/// All patches on the screen, or the typed error of the first that cannot be seen.
fn on_screen(
    case: &Field<'_>,
    patches: &[Patch<'_>],
    area: Area,
) -> Result<Result<Vec<Seen>, GeometryError>, Malformed> {
    let model: Vec<[f64; 3]> = patches.iter().flat_map(Patch::points).copied().collect();
    let view = View::read(case, (area.width, area.height), &model)?;
    if view.is_screen() {
        // A number out of range is the file's fault then, and named.
        for patch in patches {
            patch.fixed_points()?;
        }
    }
    Ok(patches.iter().map(|patch| see(patch, &view)).collect())
}

pub(crate) fn run(case: &Field<'_>, output: Option<PathBuf>) -> Answer {
    let settings = Settings::read(case)?;
    let patches = Patch::read_all(case)?;
    let seen = match on_screen(case, &patches, settings.area)? {
        Ok(seen) => seen,
        Err(error) => return Ok(typed_error(&error)),
    };
    let mut nets = Vec::new();
    for (patch, seen) in patches.iter().zip(&seen) {
        let net = patch.net(&seen.points, seen.weights.as_deref());
        nets.push(net.map_err(|error| case.malformed(&error.to_string()))?);
    }
    match picture(&settings, &nets) {
        Ok((display, drawn, audit)) => {
            if let Some(path) = output {
                let image = display.to_rgb_output_image(&OutputSettings::default());
                image.save_png(&path).map_err(|e| Malformed::new("-o", &format!("{}: {e}", path.display())))?;
            }
            Ok(Map::from_iter([
                ("status".to_owned(), "ok".into()),
                ("points".to_owned(), (drawn.points + drawn.vertices).into()),
                ("pixels".to_owned(), audit.pixels.into()),
                ("pieces".to_owned(), (u64::from(drawn.pieces) + drawn.facets).into()),
                ("splits".to_owned(), drawn.splits.into()),
                ("missed".to_owned(), audit.missed.len().into()),
            ]))
        }
        Err(Refused::Render(RenderError::Patch { error, .. })) => Ok(typed_error(&error)),
        Err(Refused::Render(error)) => Ok(typed_error(&error)),
        Err(Refused::Topology(error)) => Ok(typed_error(&error)),
    }
}

/// Why there is no picture.
enum Refused {
    Render(RenderError),
    Topology(SubdivideError),
}

impl From<RenderError> for Refused {
    fn from(error: RenderError) -> Self {
        Self::Render(error)
    }
}

/// A picture, what drawing it took, and the audit against the reference.
type Picture = (SimulatorDisplay<Rgb888>, Statistics, Audit);

fn picture(settings: &Settings, nets: &[SurfaceNet<'_>]) -> Result<Picture, Refused> {
    let mut display = draw::blank(settings.area, settings.background);
    let paint = (&Material { colour: settings.colour }, settings.background);
    let mut edges = vec![PatchTopology::default(); nets.len()];
    let (scene, audit) = match settings.fill {
        Fill::Grid { tolerance } => {
            topology(nets, &mut edges).map_err(Refused::Topology)?;
            let scene = Scene::grid(nets, &edges, tolerance, Light::default(), settings.style)?;
            (scene, Audit::of_grid(nets, tolerance, settings.area)?)
        }
        _ => (Scene::new(nets, Light::default(), settings.style)?, Audit::of(nets, settings.area)?),
    };
    let statistics = draw::in_bands(&mut display, scene, paint, (settings.area, settings.band), |_| ())?;
    Ok((display, statistics, audit))
}
