//! Control nets that converge to one patch: by degree elevation, above, and by subdivision, below.

use crate::{draw, seed};
use embedded_graphics::Drawable;
use embedded_graphics::pixelcolor::Rgb888;
use embedded_graphics::prelude::{Point, Primitive};
use embedded_graphics::primitives::{Line, PrimitiveStyle};
use embedded_graphics_simulator::SimulatorDisplay;
use embedded_surfaces::geometry::{Affine, View};
use embedded_surfaces::graphics::Material;
use embedded_surfaces::num::{I16F16, I32F32};
use embedded_surfaces::patch::CubicTriangle;
use embedded_surfaces::render::{Area, Light, Scene, Style};
use std::error::Error;

const LEVELS: u32 = 4;
const CELL: (u32, u32) = (160, 150);

/// The picture: a column for 10, 28, 91 and 325 control points.
pub(crate) const AREA: Area = Area { x: 0, y: 0, width: LEVELS * CELL.0, height: 2 * CELL.1 };

/// A net of a degree with its points on the screen, b[n,0,0] first.
type Net = (usize, Vec<[f64; 2]>);

fn net(patch: &CubicTriangle) -> Net {
    (3, patch.points().iter().map(|p| [p.x.to_num(), p.y.to_num()]).collect())
}

/// Where b[i,j,k] stands.
fn place(j: usize, k: usize) -> usize {
    (j + k) * (j + k + 1) / 2 + k
}

/// One degree up: (n + 1) b'[i,j,k] = i b[i−1,j,k] + j b[i,j−1,k] + k b[i,j,k−1].
fn elevate((n, points): &Net) -> Net {
    let mut out = Vec::new();
    for rest in 0..=n + 1 {
        for k in 0..=rest {
            let (i, j) = (n + 1 - rest, rest - k);
            let mut sum = [0.0; 2];
            for (factor, from) in [(i, [j, k]), (j, [j.saturating_sub(1), k]), (k, [j, k.saturating_sub(1)])] {
                if factor > 0 {
                    let p = points[place(from[0], from[1])];
                    (0..2).for_each(|a| sum[a] += p[a] * factor as f64 / (n + 1) as f64);
                }
            }
            out.push(sum);
        }
    }
    (n + 1, out)
}

/// The edges of a net as lines.
fn lines(display: &mut SimulatorDisplay<Rgb888>, (n, points): &Net, colour: Rgb888) {
    let style = PrimitiveStyle::with_stroke(colour, 1);
    let at = |j: usize, k: usize| points[place(j, k)].map(|c| c.round() as i32);
    for (j, k) in (0..*n).flat_map(|rest| (0..=rest).map(move |k| (rest - k, k))) {
        let [a, b, c] = [at(j, k), at(j + 1, k), at(j, k + 1)].map(|[x, y]| Point::new(x, y));
        for (from, to) in [(a, b), (b, c), (c, a)] {
            let Ok(()) = Line::new(from, to).into_styled(style).draw(display);
        }
    }
}

/// Draws the patch P in every cell and its nets over it.
pub(crate) fn draw(background: Rgb888) -> Result<SimulatorDisplay<Rgb888>, Box<dyn Error>> {
    let mut display = draw::blank(AREA, background);
    let view = View::default();
    for level in 0..LEVELS {
        for row in 0..2 {
            let (x, y) = ((level * CELL.0) as i32, (row * CELL.1) as i32);
            let area = Area { x, y, width: CELL.0, height: CELL.1 };
            let moved = Affine::translation(I32F32::from_num(x), I32F32::from_num(y), I32F32::ZERO);
            let map = view.fit(seed::P.points(), CELL.0, CELL.1, I16F16::from_num(0.9))?.then(&moved)?;
            let patch = seed::P.transform(&map)?;
            let scene = [patch];
            let scene = Scene::new(&scene, Light::default(), Style::Shaded)?;
            let paint = Material { colour: seed::COLOURS[row as usize] };
            draw::in_bands(&mut display, scene, (&paint, background), (area, 16), |_| ())?;
            if row == 0 {
                let degree = 3 << level;
                let elevated = (3..degree).fold(net(&patch), |net, _| elevate(&net));
                lines(&mut display, &elevated, Rgb888::new(255, 90, 90));
            } else {
                let mut parts = vec![patch];
                for _ in 0..level {
                    parts = parts.iter().flat_map(CubicTriangle::subdivide).collect();
                }
                parts.iter().for_each(|part| lines(&mut display, &net(part), Rgb888::new(255, 90, 90)));
            }
        }
    }
    Ok(display)
}
