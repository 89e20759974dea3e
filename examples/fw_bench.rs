//! Instructions a point under QEMU, exactly. The image takes more than the 256 KB of `memory.x`:
//!
//! ```sh
//! cargo run --release --target thumbv7em-none-eabihf --example fw_bench \
//!     --config 'target.thumbv7em-none-eabihf.rustflags=["-Clink-arg=--defsym=_flash_of_mps2=1"]'
//! ```
//!
//! A line per row: `name: N instructions, P points, sum S`. The sink of all rows is the wrapping sum of the coordinates.
//! `tests/firmware_bench.rs` compares the counts with `tests/budgets.txt` and the sums with the host's.
#![cfg_attr(target_os = "none", no_std, no_main)]

#[path = "board/counter.rs"]
mod counter;
#[path = "board/run.rs"]
mod run;

use core::hint::black_box;
use embedded_surfaces::const_net;
use embedded_surfaces::forward::{Lattice, Steps};
use embedded_surfaces::geometry::Point3;
use embedded_surfaces::patch::{BicubicPatch, CubicTriangle, QuinticTriangle, Surface, SurfaceNet};

/// The P of Huang and Zhu 2002.
const SEED_NET: CubicTriangle = const_net!(CubicTriangle::from_ints([
    [180, 20, 150],
    [100, 60, 100],
    [200, 180, 380],
    [100, 120, 160],
    [160, 140, 400],
    [300, 120, 100],
    [40, 200, 60],
    [200, 200, 360],
    [100, 220, 60],
    [300, 200, 300],
]));
static SEED: CubicTriangle = SEED_NET;
static SEED_4: CubicTriangle = with_fraction(4);
static SEED_8: CubicTriangle = with_fraction(8);
static SEED_16: CubicTriangle = with_fraction(16);

/// The seed patch with a point moved by 2^-bits, so that the net uses so many fraction bits.
#[allow(clippy::panic, reason = "at compile time")]
const fn with_fraction(bits: u32) -> CubicTriangle {
    let mut points = *SEED_NET.points();
    let p = points[4];
    points[4] = Point3::from_bits(p.x.to_bits() + (1 << (16 - bits)), p.y.to_bits(), p.z.to_bits());
    match CubicTriangle::new(points) {
        Ok(net) => net,
        Err(_) => panic!("the net is not legal"),
    }
}

static BICUBIC: BicubicPatch = const_net!(BicubicPatch::from_ints([
    [[12, 7, 0], [5, 38, 60], [21, 70, -40], [9, 104, 10]],
    [[40, -3, 35], [44, 31, -50], [37, 73, 80], [42, 99, 0]],
    [[71, 11, -20], [66, 29, 90], [75, 64, -30], [68, 110, 25]],
    [[103, 2, 5], [110, 41, -60], [97, 66, 45], [106, 95, -15]],
]));

static QUINTIC: QuinticTriangle = const_net!(QuinticTriangle::from_ints([
    [0, 0, 9],
    [12, 3, 7],
    [3, 11, 20],
    [25, 2, -7],
    [14, 13, 30],
    [2, 26, 1],
    [37, 4, 5],
    [26, 15, 12],
    [15, 24, 22],
    [1, 39, 3],
    [52, 3, 9],
    [38, 12, 40],
    [27, 26, 0],
    [13, 37, 17],
    [4, 50, 9],
    [60, 0, 2],
    [51, 13, 8],
    [40, 25, 31],
    [25, 38, 4],
    [12, 49, 9],
    [0, 61, 5],
]));

/// Name, net and steps.
fn rows() -> [(&'static str, SurfaceNet<'static>, u32); 10] {
    [
        ("cubic n=256 F=0", SEED.surface(), 256),
        ("cubic n=256 F=4", SEED_4.surface(), 256),
        ("cubic n=256 F=8", SEED_8.surface(), 256),
        ("cubic n=256 F=16", SEED_16.surface(), 256),
        ("cubic n=1024 F=0", SEED.surface(), 1024),
        ("cubic n=1024 F=8", SEED_8.surface(), 1024),
        ("bicubic n=256 F=0", BICUBIC.surface(), 256),
        ("quintic n=256 F=0", QUINTIC.surface(), 256),
        ("cubic n=300 F=0", SEED.surface(), 300),
        ("cubic n=300 F=16", SEED_16.surface(), 300),
    ]
}

/// What a row gives, whatever it costs.
#[derive(Default)]
struct Total {
    points: u32,
    sum: i32,
}

/// The points alone, set-up of the lattice included.
#[inline(never)]
fn generate(net: SurfaceNet<'_>, steps: u32, total: &mut Total) {
    let lattice = Steps::uniform(steps).and_then(|steps| Lattice::new(net, steps));
    let Ok(lattice) = lattice else { return };
    let mut sum = 0_i32;
    lattice.for_each(|p| sum = sum.wrapping_add(p.x).wrapping_add(p.y).wrapping_add(p.z));
    *total = Total { points: lattice.point_count() as u32, sum };
}

/// The same in any order.
#[inline(never)]
fn unordered(net: SurfaceNet<'_>, steps: u32, total: &mut Total) {
    let lattice = Steps::uniform(steps).and_then(|steps| Lattice::new(net, steps));
    let Ok(lattice) = lattice else { return };
    let mut sum = 0_i32;
    lattice.for_each_unordered(|p| sum = sum.wrapping_add(p.x).wrapping_add(p.y).wrapping_add(p.z));
    *total = Total { points: lattice.point_count() as u32, sum };
}

/// The sum by itself.
#[inline(never)]
fn checksum(net: SurfaceNet<'_>, steps: u32, total: &mut Total) {
    let lattice = Steps::uniform(steps).and_then(|steps| Lattice::new(net, steps));
    let Ok(lattice) = lattice else { return };
    *total = Total { points: lattice.point_count() as u32, sum: lattice.checksum() };
}

/// A row whose count is known: an instruction a point.
#[inline(never)]
fn nops() {
    #[cfg(target_os = "none")]
    // SAFETY: does nothing.
    unsafe {
        core::arch::asm!(".rept 1000", "nop", ".endr", options(nomem, nostack, preserves_flags));
    }
}

/// Writes the line of a row.
fn row(out: &mut impl core::fmt::Write, name: &str, what: &str, section: impl FnOnce(&mut Total)) -> core::fmt::Result {
    let mut total = Total::default();
    let instructions = counter::count(|| section(&mut total));
    let Total { points, sum } = black_box(total);
    writeln!(out, "{name}, {what}: {instructions} instructions, {points} points, sum {sum}")
}

/// Writes a line per row.
pub(crate) fn report(out: &mut impl core::fmt::Write) -> core::fmt::Result {
    writeln!(out, "nops: {} instructions, 1000 points, sum 0", counter::count(nops))?;
    for (name, net, steps) in rows() {
        let (net, steps) = black_box((net, steps));
        row(out, name, "generation", |total| generate(net, steps, total))?;
    }
    let (name, net, steps) = black_box(("cubic n=256 F=0", SEED.surface(), 256));
    row(out, name, "any order", |total| unordered(net, steps, total))?;
    for (name, net, steps) in rows() {
        let (net, steps) = black_box((net, steps));
        row(out, name, "checksum", |total| checksum(net, steps, total))?;
    }
    Ok(())
}

#[cfg(not(target_os = "none"))]
fn main() {
    run::on_host();
}
