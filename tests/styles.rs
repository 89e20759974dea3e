//! Styles: bands do not show in any, lines are connected and hidden where they should be, levels follow depth.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, clippy::disallowed_types, clippy::float_arithmetic)]

mod common;
#[path = "common/scene.rs"]
mod scene;

use common::SEED_P;
use embedded_surfaces::geometry::Perspective;
use embedded_surfaces::num::I16F16;
use embedded_surfaces::patch::{BicubicPatch, BilinearPatch, CubicTriangle, Surface};
use embedded_surfaces::reference::point;
use embedded_surfaces::render::{Area, Fragment, Frame, Gloss, Light, Lines, Scene, Style};
use scene::{Look, VIEWS, teapot};

const SCREEN: Area = Area { x: 0, y: 0, width: 320, height: 240 };

/// Levels of the whole picture in bands of `rows` rows; `None` where nothing was drawn.
fn picture<S: Surface>(patches: &[S], style: Style, area: Area, rows: u32) -> Vec<Option<u8>> {
    let paint = |at: Fragment| Some(at.shade);
    let scene = Scene::new(patches, Light::default(), style).unwrap();
    let mut frame = Frame::new(scene, &paint, None, area, rows).unwrap();
    let (mut colour, mut depth) = (vec![None; frame.band_pixels()], vec![0; frame.band_pixels()]);
    let mut pixels = Vec::new();
    while let Some(band) = frame.next_band(&mut colour, &mut depth).unwrap() {
        pixels.extend_from_slice(band.pixels());
    }
    pixels
}

#[test]
fn bands_do_not_show_in_any_style() {
    let patches = Look::at(VIEWS[1], (320, 240)).see(&teapot());
    let lines = Lines::every(4);
    let styles = [
        Style::Shaded,
        Style::Glossy(Gloss::new(120, 20)),
        Style::Flat,
        Style::DepthCued { near: 255, far: 30 },
        Style::Wire(lines),
        Style::Wire(lines.without_hidden()),
        Style::Net { hidden: false },
        Style::Net { hidden: true },
        Style::Normals { lines, length: 12 },
        Style::Normals { lines: lines.without_hidden(), length: 12 },
    ];
    let eye = Perspective {
        centre_x: I16F16::from_num(160),
        centre_y: I16F16::from_num(120),
        distance: I16F16::from_num(900),
    };
    let seen: Vec<_> = patches.iter().map(|p| p.perspective(&eye).unwrap()).collect();
    for style in styles {
        let whole = picture(&patches, style, SCREEN, 240);
        assert!(whole.iter().flatten().count() > 1000, "{style:?}");
        let projected = picture(&seen, style, SCREEN, 240);
        for rows in [1, 7, 16] {
            assert!(picture(&patches, style, SCREEN, rows) == whole, "{style:?} in bands of {rows} rows");
            if rows > 1 {
                assert!(picture(&seen, style, SCREEN, rows) == projected, "{style:?} in bands of {rows} rows");
            }
        }
    }
}

/// Every point of every iso-parametric curve, sampled densely in `f64`, has a drawn pixel within one of it, and
/// every drawn pixel is near such a curve: the lines are there, connected, and nothing else is.
fn lines_are_the_curves(patch: &impl Surface, intervals: u8, area: Area) {
    let drawn = picture(core::slice::from_ref(patch), Style::Wire(Lines::every(intervals)), area, 16);
    let is_drawn = |x: i64, y: i64| {
        let inside = (0..i64::from(area.width)).contains(&x) && (0..i64::from(area.height)).contains(&y);
        inside && drawn[(y * i64::from(area.width) + x) as usize].is_some()
    };
    let mut near = vec![false; drawn.len()];
    let net = patch.surface();
    let mut family = |at: &dyn Fn(f64, f64) -> (f64, f64), limit: &dyn Fn(f64) -> f64| {
        for k in 0..=intervals {
            let fixed = f64::from(k) / f64::from(intervals);
            for step in 0..=4000 {
                let (u, v) = at(f64::from(step) / 4000.0 * limit(fixed), fixed);
                let [x, y, _] = point(net, u, v);
                let (x, y) = ((x + 0.5).floor() as i64, (y + 0.5).floor() as i64);
                assert!((-1..=1).any(|dy| (-1..=1).any(|dx| is_drawn(x + dx, y + dy))), "no line at {x}, {y}");
                for (dx, dy) in (-1..=1).flat_map(|dy| (-1..=1).map(move |dx| (dx, dy))) {
                    let (x, y) = (x + dx, y + dy);
                    if (0..i64::from(area.width)).contains(&x) && (0..i64::from(area.height)).contains(&y) {
                        near[(y * i64::from(area.width) + x) as usize] = true;
                    }
                }
            }
        }
    };
    if net.is_triangle() {
        family(&|t, f| (t, f), &|f| 1.0 - f);
        family(&|t, f| (f, t), &|f| 1.0 - f);
        family(&|t, f| (t, 1.0 - f - t), &|f| 1.0 - f);
    } else {
        family(&|t, f| (t, f), &|_| 1.0);
        family(&|t, f| (f, t), &|_| 1.0);
    }
    assert!(drawn.iter().zip(&near).all(|(d, near)| d.is_none() || *near), "something else was drawn");
}

#[test]
fn wires_are_the_iso_parametric_curves() {
    let area = Area { x: 0, y: 0, width: 420, height: 380 };
    let triangle = CubicTriangle::from_ints(SEED_P).unwrap();
    let patch = BicubicPatch::from_ints([
        [[20, 20, 0], [30, 120, 40], [10, 240, 0], [25, 340, 9]],
        [[120, 60, 50], [140, 150, 90], [100, 230, 20], [130, 300, 0]],
        [[260, 10, 0], [230, 140, -40], [280, 200, 0], [250, 350, 10]],
        [[390, 40, 0], [380, 130, 0], [400, 260, 30], [370, 330, 0]],
    ])
    .unwrap();
    for intervals in [1, 2, 5] {
        lines_are_the_curves(&triangle, intervals, area);
        lines_are_the_curves(&patch, intervals, area);
    }
    let eye = Perspective {
        centre_x: I16F16::from_num(200),
        centre_y: I16F16::from_num(180),
        distance: I16F16::from_num(500),
    };
    lines_are_the_curves(&patch.perspective(&eye).unwrap(), 3, area);
}

#[test]
fn a_patch_hides_the_lines_behind_it_and_not_its_own() {
    let square = |low: i16, high: i16, z: i16| {
        BilinearPatch::from_ints([[[low, low, z], [low, high, z]], [[high, low, z], [high, high, z]]]).unwrap()
    };
    let area = Area { x: 0, y: 0, width: 64, height: 64 };
    let patches = [square(10, 40, 0), square(20, 60, 50)];
    let at = |pixels: &[Option<u8>], x: usize, y: usize| pixels[y * 64 + x].is_some();
    let seen = picture(&patches, Style::Wire(Lines::BOUNDARY), area, 16);
    let hidden = picture(&patches, Style::Wire(Lines::BOUNDARY.without_hidden()), area, 16);
    // The far square's corner lies behind the near one.
    assert!(at(&seen, 20, 30) && at(&seen, 30, 20));
    assert!(!at(&hidden, 20, 30) && !at(&hidden, 30, 20));
    for (x, y) in [(10, 30), (40, 30), (20, 50), (60, 50), (50, 20)] {
        assert!(at(&seen, x, y) && at(&hidden, x, y), "({x}, {y})");
    }
    assert!(!at(&hidden, 25, 15), "the inside of a hiding patch is not drawn");
}

#[test]
fn depth_cues_run_from_near_to_far() {
    let ramp = BilinearPatch::from_ints([[[0, 0, -100], [0, 50, -100]], [[200, 0, 100], [200, 50, 100]]]).unwrap();
    let pixels = picture(&[ramp], Style::DepthCued { near: 250, far: 50 }, SCREEN, 240);
    let row: Vec<u8> = pixels[20 * 320..20 * 320 + 201].iter().map(|p| p.unwrap()).collect();
    assert!(row.windows(2).all(|w| w[0] >= w[1]));
    for (x, level) in row.into_iter().enumerate() {
        assert!((f64::from(level) - (250.0 - x as f64)).abs() <= 2.0, "{level} at {x}");
    }
}

#[test]
fn normals_stand_on_the_surface_towards_the_viewer() {
    let flat = BilinearPatch::from_ints([[[50, 50, 0], [50, 90, 30]], [[90, 50, 0], [90, 90, 30]]]).unwrap();
    let style = Style::Normals { lines: Lines::every(1), length: 20 };
    let pixels = picture(&[flat], style, SCREEN, 240);
    // N ~ (0, 30, -40)/50: 20 pixels of it are 12 down on the screen.
    let column: Vec<usize> = (0..240).filter(|y| pixels[y * 320 + 50].is_some()).collect();
    assert_eq!(column, (50..=62).chain(90..=102).collect::<Vec<_>>());
}

#[test]
fn control_nets_are_their_edges() {
    let net = BilinearPatch::from_ints([[[5, 5, 0], [5, 20, 0]], [[30, 5, 0], [30, 20, 0]]]).unwrap();
    let pixels = picture(&[net], Style::Net { hidden: false }, SCREEN, 16);
    assert_eq!(pixels.iter().flatten().count(), 2 * (26 + 14));
    let patch = CubicTriangle::from_ints(SEED_P).unwrap();
    let drawn = picture(&[patch], Style::Net { hidden: false }, Area { x: 0, y: 0, width: 320, height: 240 }, 16);
    for p in patch.points() {
        let (x, y) = (p.x.to_num::<usize>(), p.y.to_num::<usize>());
        assert!(drawn[y * 320 + x].is_some(), "{p:?}");
    }
}
