//! What adaptive drawing costs: points, pieces and splits, counted and committed.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, clippy::disallowed_types, clippy::float_arithmetic)]

#[path = "common/scene.rs"]
mod scene;

use embedded_surfaces::geometry::Point3;
use embedded_surfaces::patch::{BicubicPatch, CubicTriangle, Surface};
use embedded_surfaces::reference::Audit;
use embedded_surfaces::render::{Area, Fragment, Frame, Light, Scene, Statistics, Style};
use scene::{Look, Random, VIEWS, teacup, teapot};

fn draw<S: Surface>(patches: &[S], area: Area, rows: u32) -> Statistics {
    let scene = Scene::new(patches, Light::default(), Style::Shaded).unwrap();
    let paint = |f: Fragment| f.shade;
    let mut frame = Frame::new(scene, &paint, 0, area, rows).unwrap();
    let (mut colour, mut depth) = (vec![0; frame.band_pixels()], vec![0; frame.band_pixels()]);
    while frame.next_band(&mut colour, &mut depth).unwrap().is_some() {}
    frame.statistics()
}

fn report<S: Surface>(name: &str, patches: &[S], area: Area) {
    let audit = Audit::of(patches, area).unwrap();
    for rows in [area.height, 32, 16, 8] {
        let s = draw(patches, area, rows);
        println!(
            "{name} rows {rows}: {s:?}, {} pixels, {:.3} a pixel, missed {}",
            audit.pixels,
            s.points as f64 / audit.pixels as f64,
            audit.missed.len()
        );
    }
}

#[test]
fn points_per_pixel() {
    let screen = |width, height| Area { x: 0, y: 0, width, height };
    report("teapot 320", &Look::at(VIEWS[1], (320, 240)).see(&teapot()), screen(320, 240));
    report("teapot 640", &Look::at(VIEWS[1], (640, 480)).see(&teapot()), screen(640, 480));
    report("tea cup", &Look::at((-10.0, 30.0), (320, 240)).see(&teacup()), screen(320, 240));
    let mut random = Random(24);
    let patches: Vec<_> = (0..24)
        .map(|_| {
            let net: [[Point3; 4]; 4] = core::array::from_fn(|i| {
                core::array::from_fn(|j| random.near(i as f64 / 3.0, j as f64 / 3.0, 200.0, 0.25))
            });
            BicubicPatch::new(net).unwrap()
        })
        .collect();
    let area = Area { x: -60, y: -60, width: 340, height: 340 };
    report("random bicubic", &patches, area);
    let patches: Vec<_> = (0..24)
        .map(|_| {
            let mut net = Vec::new();
            for i in (0..=3).rev() {
                for j in (0..=3 - i).rev() {
                    net.push(random.near(i as f64 / 3.0, j as f64 / 3.0, 200.0, 0.25));
                }
            }
            CubicTriangle::new(net.try_into().unwrap()).unwrap()
        })
        .collect();
    report("random cubic triangles", &patches, area);
}
