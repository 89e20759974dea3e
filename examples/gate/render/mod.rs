//! Scenes in every style and shape, whole and in bands.

pub(super) mod grid;

use super::{Digest, Sum, data, hide};
use embedded_surfaces::forward::LatticeError;
use embedded_surfaces::patch::{Surface, SurfaceNet};
use embedded_surfaces::render::{
    Area, Band, Cull, Fragment, Frame, Gloss, Light, Lines, Notes, Paint, RenderError, Scene, Statistics, Style, Tile,
};

const SIDE: u32 = 64;

impl Digest for Area {
    fn digest(&self, sum: &mut Sum) {
        ([self.x, self.y], [self.width, self.height]).digest(sum);
    }
}

impl Digest for Statistics {
    fn digest(&self, sum: &mut Sum) {
        ([self.patches, self.pieces, self.splits], self.points).digest(sum);
    }
}

/// Level, and the patch in the lowest bits.
struct Marked;

impl Paint for Marked {
    type Pixel = u16;

    fn pixel(&self, at: Fragment) -> u16 {
        (u16::from(at.shade) << 8) ^ (at.patch as u16) ^ (at.x as u16) ^ ((at.y as u16) << 4)
    }
}

pub(crate) const STYLES: [Style; 8] = [
    Style::Shaded,
    Style::Glossy(Gloss::new(150, 20)),
    Style::Flat,
    Style::DepthCued { near: 255, far: 40 },
    Style::Wire(Lines::BOUNDARY),
    Style::Wire(Lines::every(5).without_hidden()),
    Style::Net { hidden: true },
    Style::Normals { lines: Lines { intervals: 4, hidden: false }, length: 9 },
];

pub(super) fn calls(sum: &mut Sum) {
    settings(sum);
    let (wave, across) = hide((&data::BICUBIC, &data::BILINEAR));
    let (triangle, weighted, octant) = hide((&data::TRIANGLE, &data::WEIGHTED, &data::OCTANT));
    let crossing = [wave.surface(), across.surface()];
    let round = [triangle.surface(), weighted.surface(), octant.surface()];
    for style in hide(STYLES) {
        for patches in [&crossing[..], &round] {
            scene(sum, patches, style);
        }
        sum.add(Scene::new(hide(&[*wave]), Light::default(), style).map(|scene| Scene::area(&scene)));
    }
    hide(errors()).into_iter().for_each(|error| sum.add(Err::<(), _>(error)));
}

#[inline(never)]
fn settings(sum: &mut Sum) {
    for [x, y, z] in hide([[0, 0, 0], [1, -2, -3], [i16::MIN, i16::MIN, i16::MIN]]) {
        sum.add(Light::towards(x, y, z, hide(33)).map(|light| (Light::direction(&light), Light::ambient(&light))));
    }
    let gloss = Gloss::new(hide(7), hide(0));
    sum.add((Gloss::specular(gloss), Gloss::exponent(gloss)));
    let lines = Lines::without_hidden(Lines::every(hide(3)));
    sum.add((lines.intervals, lines.hidden));
}

fn errors() -> [RenderError; 2] {
    let error = LatticeError::Steps { r: 0, s: 0 };
    [RenderError::Patch { index: 3, error }, RenderError::Light]
}

#[inline(never)]
fn scene(sum: &mut Sum, patches: &[SurfaceNet<'_>], style: Style) {
    let (mut colour, mut depth) = ([0; 4096], [0; 4096]);
    let Ok(scene) = Scene::new(patches, Light::default(), style) else { return };
    sum.add((Scene::area(&scene), Scene::patches(&scene).len()));
    for (cull, side) in [Cull::None, Cull::Back].into_iter().zip(hide([SIDE, 63])) {
        let scene = Scene::with_cull(scene, cull);
        let area = Area { x: -1, y: 2, width: side, height: side };
        let Ok(mut tile) = Tile::new(area, &mut colour, &mut depth, hide(7_u16)) else { return };
        sum.add(Scene::draw(&scene, &mut tile, &Marked));
        sum.add((Tile::area(&tile), Area::pixels(&area)));
        sum.add(Tile::pixels(&tile));
        let covered = (0..area.pixels()).filter(|k| Tile::is_covered(&tile, *k)).count();
        let places = hide([(0, 0), (30, 30), (-5, 999)]).map(|(x, y)| Tile::covers(&tile, x, y));
        sum.add((covered, places));
    }
    let area = Area { x: 3, y: 4, width: 50, height: 40 };
    let small = Tile::new(area, &mut colour[..9], &mut depth, 0).map(|_| ());
    let empty = Tile::new(Area { width: hide(0), ..area }, &mut colour, &mut depth, 0).map(|_| ());
    sum.add([small, empty]);
    frame(sum, scene, (&mut colour, &mut depth));
}

#[inline(never)]
fn frame(sum: &mut Sum, scene: Scene<'_, SurfaceNet<'_>>, (colour, depth): (&mut [u16], &mut [u16])) {
    for (width, rows) in hide([(50, 11), (50, 0), (0, 3)]) {
        let area = Area { x: 3, y: 4, width, height: 40 };
        let mut notes = hide(Notes::EMPTY);
        let frame = Frame::new(scene, &Marked, hide(1), area, rows).map(|frame| Frame::with_notes(frame, &mut notes));
        sum.add(frame.as_ref().map(Frame::band_pixels).map_err(|error| *error));
        let Ok(mut frame) = frame else { continue };
        sum.add(Frame::next_band(&mut frame, &mut [], depth).map(|_| ()));
        while let Ok(Some(band)) = Frame::next_band(&mut frame, colour, depth) {
            sum.add((Band::area(&band), Band::pixels(&band)));
        }
        sum.add(Frame::statistics(&frame));
    }
    let grey = |at: Fragment| at.shade;
    hide([Fragment { x: 1, y: 2, patch: 3, shade: 4 }])
        .into_iter()
        .for_each(|at| sum.add((Paint::pixel(&grey, at), Paint::pixel(&Marked, at))));
}
