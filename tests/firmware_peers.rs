//! `peers/`: what firmware does today, counted like `fw_bench` and `fw_cost`; its pictures are the host's on every core,
//! and show what the crate's frame shows. RV32 only with `FIRMWARE_GATE=1` or `UPDATE_BUDGETS=1`.
//!
//! `FIRMWARE_PICTURES=folder cargo test --test firmware_peers` writes them there as PPM files.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]
#![allow(clippy::disallowed_types, clippy::float_arithmetic)]

#[path = "common/audit.rs"]
mod audit;
#[path = "common/budgets.rs"]
#[allow(dead_code)]
mod budgets;
#[path = "common/firmware.rs"]
mod firmware;
#[path = "../peers/src/main.rs"]
#[allow(dead_code, reason = "its `main` is for `cargo run`")]
mod peers;
#[path = "common/rows.rs"]
mod rows;

use embedded_graphics::pixelcolor::{IntoStorage, Rgb565, WebColors, raw::RawU16};
use embedded_graphics::prelude::RgbColor;
use embedded_surfaces::geometry::View;
use embedded_surfaces::graphics::Material;
use embedded_surfaces::num::I16F16;
use embedded_surfaces::patch::{BicubicPatch, Surface, SurfaceNet};
use embedded_surfaces::reference::point;
use embedded_surfaces::render::{Cull, Light, Scene, Style, Tile};
use peers::frames::{Studio, mesh::GRIDS, view::AREA};
use peers::teapot;
use rows::{counted, parse, print_table, run_all};

#[test]
fn boards_draw_what_the_host_draws() {
    let mut host = String::new();
    peers::report(&mut host).unwrap();
    let host = parse(&host);
    let mut targets = counted();
    if !firmware::is_thorough() {
        // Points alone run there.
        targets.retain(|target| target.starts_with("thumb"));
    }
    let folder = firmware::cargo_build_peers(&targets);
    let columns = run_all("fw_peers", &targets, |target| folder.join(target).join("release/fw_peers"), |_| true);
    for (short, rows) in &columns {
        for row in rows {
            match host.iter().find(|other| other.name == row.name) {
                Some(here) => assert_eq!((row.points, row.sum), (here.points, here.sum), "{} on {short}", row.name),
                // It is for cores with floats alone, and rounds vertices to pixels.
                None => {
                    assert_eq!((row.name.as_str(), *short), ("frame, embedded-3dgfx", "M4"));
                    assert!(row.points.abs_diff(crates_frame().iter().filter(|c| **c != 0).count() as u64) < 1500);
                }
            }
        }
        assert!(rows.len() >= if *short == "RV32" { 4 } else { host.len() });
    }
    print_table(&columns);
}

/// The patches in the view of `fw_cost`.
fn patches() -> [BicubicPatch; 32] {
    let fit = I16F16::from_bits(60_293); // 0.92
    let map = View::default().fit(teapot::vertices(), AREA.width, AREA.height, fit).unwrap();
    teapot::patches(&map).unwrap()
}

/// The frame that `fw_cost` counts, by exact points.
fn crates_frame() -> Vec<u16> {
    let (patches, table) = (patches(), audit::joined(&teapot::MODEL));
    let scene = Scene::new(&patches, Light::default(), Style::Shaded).unwrap().with_topology(&table).unwrap();
    let (mut colour, mut depth) = (vec![Rgb565::BLACK; AREA.pixels()], vec![0; AREA.pixels()]);
    let mut tile = Tile::new(AREA, &mut colour, &mut depth, Rgb565::BLACK).unwrap();
    scene.with_cull(Cull::Back).draw(&mut tile, &Material { colour: Rgb565::CSS_BURLY_WOOD });
    tile.pixels().iter().map(|c| c.into_storage()).collect()
}

/// The level of green, of 255.
fn level(colour: u16) -> f64 {
    f64::from(Rgb565::from(RawU16::new(colour)).g()) * 255.0 / 63.0
}

#[test]
fn peers_show_the_frame() {
    let expected = crates_frame();
    write("crate", &expected);
    let mut names = Vec::new();
    let mut studio = Box::new(Studio::EMPTY);
    let drawn = studio.draw_all(|name, _, colour| {
        write(name, colour);
        let both = || expected.iter().zip(colour).filter(|(a, b)| **a != 0 && **b != 0);
        let one = expected.iter().zip(colour).filter(|(a, b)| (**a == 0) != (**b == 0)).count();
        let off = both().map(|(a, b)| (level(*a) - level(*b)).abs()).sum::<f64>() / both().count() as f64;
        println!("{name}: {one} pixels in one picture only, levels off by {off:.2} in the mean");
        assert!(one < 1800 && off < 8.0, "{name}: {one} pixels, levels off by {off:.2}");
        names.push(name.to_owned());
        Ok(())
    });
    drawn.unwrap();
    assert_eq!(names.len(), 4);
}

fn write(name: &str, colour: &[u16]) {
    let Some(folder) = std::env::var_os("FIRMWARE_PICTURES") else { return };
    let mut bytes = b"P6\n320 240\n255\n".to_vec();
    let rgb = colour.iter().map(|c| Rgb565::from(RawU16::new(*c))).map(|c| [c.r() << 3, c.g() << 2, c.b() << 3]);
    bytes.extend(rgb.flatten());
    std::fs::write(std::path::Path::new(&folder).join(format!("{name}.ppm")), bytes).unwrap();
}

/// The farthest that the triangles of an r × s grid are from the surface, in pixels.
fn deviation(net: SurfaceNet<'_>, r: usize, s: usize) -> f64 {
    let corner = |i: usize, j: usize| [i as f64 / r as f64, j as f64 / s as f64];
    let mut worst = 0.0_f64;
    for (i, j) in (0..r).flat_map(|i| (0..s).map(move |j| (i, j))) {
        let [a, b, c, d] = [corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)];
        for at in [[a, b, c], [a, c, d]] {
            let places = at.map(|uv| point(net, uv[0], uv[1]));
            for (x, y) in (0..=6).flat_map(|x| (0..=6 - x).map(move |y| (x, y))) {
                let part = [x, y, 6 - x - y].map(|k| f64::from(k) / 6.0);
                let mix = |of: [f64; 3]| (0..3).map(|k| part[k] * of[k]).sum::<f64>();
                let place = [0, 1, 2].map(|axis: usize| mix(places.map(|p| p[axis])));
                let uv = [0, 1].map(|axis: usize| mix(at.map(|uv| uv[axis])));
                let equal = point(net, uv[0], uv[1]);
                let at_equal = (0..3).map(|k| (place[k] - equal[k]).powi(2)).sum::<f64>().sqrt();
                worst = worst.max(audit::nearest(net, place, uv).min(at_equal));
            }
        }
    }
    worst
}

#[test]
fn the_mesh_is_half_a_pixel_from_the_surface() {
    let patches = patches();
    let mut worst = 0.0_f64;
    for [first, count, r, s] in GRIDS {
        // The others of a ring are this one turned, or mirrored.
        for patch in &patches[first..first + count.min(2)] {
            let off = deviation(patch.surface(), r, s);
            assert!(off <= 0.5, "patch {first}: {off}");
            worst = worst.max(off);
        }
    }
    assert!(worst > 0.45, "the mesh is finer than needed: {worst}");
}
