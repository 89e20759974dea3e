//! `examples/fw_frame.rs`: the PPM that leaves the board is the host's, byte for byte; RAM and flash stay small.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

#[path = "../examples/fw_frame.rs"]
#[allow(dead_code, reason = "its `main` is for `cargo run`")]
mod example;
#[path = "common/firmware.rs"]
mod firmware;

use example::{frame, teapot};
use std::process::{Command, Stdio};

/// What the host draws by the same calls.
fn expected(grid: bool) -> Vec<u8> {
    let mut bytes = frame::PPM_HEAD.to_vec();
    let row = |row: &[_]| bytes.extend_from_slice(&frame::ppm_row(row));
    let drawn = if grid {
        const LINKS: usize = frame::PART_FACETS + frame::BANDS;
        frame::draw::<true, _, _>(&mut Box::new(frame::Buffers::<_, { frame::PART_FACETS }, LINKS>::new()), row)
    } else {
        frame::draw::<false, _, _>(&mut Box::new(frame::Buffers::<_, 0, 0>::new()), row)
    };
    drawn.unwrap();
    bytes
}

#[test]
fn the_palette_is_a_material() {
    use embedded_graphics_core::pixelcolor::{Rgb565, WebColors};
    use embedded_surfaces::graphics::{Material, Palette, Shade};
    let material = Material { colour: Rgb565::CSS_BURLY_WOOD };
    assert_eq!(frame::PAINT, Palette::from_fn(|level| material.colour.shaded(level, 0, 0)));
}

#[test]
fn both_fills_show_the_teapot() {
    let [exact, grid] = [false, true].map(expected);
    let lit = |bytes: &[u8]| bytes[frame::PPM_HEAD.len()..].chunks_exact(3).filter(|p| **p != [0; 3]).count();
    assert_eq!(exact.len(), frame::PPM_HEAD.len() + 3 * 320 * 240);
    assert!(lit(&exact) > 25_000 && lit(&exact).abs_diff(lit(&grid)) < 2_000);
    assert_ne!(exact, grid);
}

/// Runs the firmware with this fill; checks its picture, its RAM and its flash in bytes.
fn check(fill: &str, most_ram: usize, most_flash: u64) {
    let target = "thumbv7em-none-eabihf";
    let Some(runner) = firmware::board(target) else { return };
    let environment = [firmware::FOR_SIZE, ("FW_FRAME_FILL", fill)];
    let folder = firmware::cargo("build", target, &["--example", "fw_frame"], &environment);
    let image = folder.join("examples").join("fw_frame");
    let elf = std::fs::read(&image).unwrap();
    assert_eq!(firmware::offences(&elf), [], "{fill}");
    let (flash, _) = firmware::sizes(&elf);
    let output = Command::new(&runner[0]).args(&runner[1..]).arg(&image).stdin(Stdio::null()).output().unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{said}");
    assert!(output.stdout == expected(fill == "grid"), "{fill}: the picture is not the host's");
    let ram: usize = said.lines().find_map(|line| line.strip_prefix("RAM ")).unwrap().parse().unwrap();
    println!("{fill}: {ram} bytes of RAM, {flash} of flash");
    assert!(ram <= most_ram, "{fill}: {ram} bytes of RAM");
    assert!(flash <= most_flash, "{fill}: {flash} bytes of flash");
}

#[test]
fn the_board_sends_the_hosts_picture() {
    assert_eq!(teapot::vertices().count(), 306);
    check("exact", 32 << 10, 64 << 10);
    check("grid", 56 << 10, 64 << 10);
}
