//! Grid fill: topology, facets, and what is refused.

use super::super::{Sum, data, hide};
use super::Marked;
use embedded_surfaces::num::I16F16;
use embedded_surfaces::patch::{Surface, SurfaceNet};
use embedded_surfaces::render::{Area, Facet, Fill, Frame, Light, Scene, Style, Tile, stack_bytes};
use embedded_surfaces::subdivide::PatchTopology;

pub(crate) fn calls(sum: &mut Sum) {
    let patches = [hide(&data::BICUBIC).surface(), hide(&data::OCTANT).surface(), hide(&data::TRIANGLE).surface()];
    sum.add(patches.map(stack_bytes));
    let Ok(table) = PatchTopology::of_nets(&patches) else { return };
    for (bits, style) in hide([(1 << 16, Style::Shaded), (0, Style::Flat), (1 << 15, Style::Shaded)]) {
        let tolerance = I16F16::from_bits(bits);
        let scene = Scene::grid(&patches, &table, tolerance, Light::default(), style);
        sum.add(scene.map(|scene| scene.area()));
        if let Ok(scene) = scene {
            draw(sum, scene);
            banded(sum, scene);
        }
        let scene = Scene::new(&patches, Light::default(), style);
        sum.add(scene.and_then(|scene| Scene::with_fill(scene, Fill::Grid { tolerance })).map(|scene| scene.area()));
        let scene = scene.and_then(|scene| Scene::with_topology(scene, &table));
        sum.add(scene.and_then(|scene| Scene::with_fill(scene, Fill::Grid { tolerance })).map(|scene| scene.area()));
    }
}

#[inline(never)]
fn draw(sum: &mut Sum, scene: Scene<'_, SurfaceNet<'_>>) {
    let (mut colour, mut depth) = ([0; 4096], [0; 4096]);
    let area = Area { x: 0, y: 0, width: 64, height: 64 };
    if let Ok(mut tile) = Tile::new(area, &mut colour, &mut depth, 7) {
        sum.add(scene.draw(&mut tile, &Marked));
        sum.add(tile.pixels());
    }
}

#[inline(never)]
fn banded(sum: &mut Sum, scene: Scene<'_, SurfaceNet<'_>>) {
    let (mut facets, mut links) = ([Facet::EMPTY; 300], [0; 100]);
    let (mut colour, mut depth) = ([0; 1024], [0; 1024]);
    let area = Area { x: 0, y: 0, width: 64, height: 64 };
    for count in hide([0, 300]) {
        let facets = facets.get_mut(..count).unwrap_or_default();
        let frame = Frame::new(scene, &Marked, 1, area, 16).and_then(|frame| frame.with_facets(&mut [], &mut []));
        sum.add(frame.map(|_| ()));
        let frame = Frame::new(scene, &Marked, 1, area, 16);
        let frame = frame.and_then(|frame| Frame::with_facets(frame, facets, &mut links));
        sum.add(frame.as_ref().map(|_| ()).map_err(|error| *error));
        let Ok(mut frame) = frame else { continue };
        while let Ok(Some(band)) = frame.next_band(&mut colour, &mut depth) {
            sum.add(band.pixels());
        }
        sum.add(frame.statistics());
    }
}
