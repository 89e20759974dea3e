//! The smallest firmware: a bicubic patch from flash, its lattice at 16 × 16 steps, one line with a checksum.
//!
//! `cargo run --release --target thumbv7em-none-eabihf --example fw_smoke` runs it under QEMU (likewise `thumbv6m`,
//! `thumbv7m` and `riscv32imc`); without `--target` the host prints the same line. `tests/firmware.rs` compares the
//! two and reads the image's symbols: no panic, no soft float, no allocator.
#![cfg_attr(target_os = "none", no_std, no_main)]

#[path = "board/run.rs"]
mod run;

use embedded_surfaces::const_net;
use embedded_surfaces::forward::{Lattice, LatticePoint, Steps};
use embedded_surfaces::patch::{BicubicPatch, Surface};

/// A wave about 100 pixels wide, range-checked by the compiler.
pub(crate) static PATCH: BicubicPatch = const_net!(BicubicPatch::from_ints([
    [[12, 7, 0], [5, 38, 60], [21, 70, -40], [9, 104, 10]],
    [[40, -3, 35], [44, 31, -50], [37, 73, 80], [42, 99, 0]],
    [[71, 11, -20], [66, 29, 90], [75, 64, -30], [68, 110, 25]],
    [[103, 2, 5], [110, 41, -60], [97, 66, 45], [106, 95, -15]],
]));

/// Steps in both directions.
pub(crate) const STEPS: u32 = 16;

/// Multiplied before each addition, so that the order of points and coordinates counts.
pub(crate) fn append(sum: u32, value: u32) -> u32 {
    sum.wrapping_mul(0x0100_0193).wrapping_add(value).rotate_left(5)
}

/// Number of points and checksum over all (i, j, x, y, z); `None` only for a plan that does not fit.
pub(crate) fn checksum(patch: &BicubicPatch, steps: u32) -> Option<(u32, u32)> {
    let lattice = Lattice::new(patch.surface(), Steps::uniform(steps).ok()?).ok()?;
    let (mut count, mut sum) = (0_u32, 0);
    lattice.for_each(|LatticePoint { i, j, x, y, z }| {
        sum = [i, j, x as u32, y as u32, z as u32].into_iter().fold(sum, append);
        count = count.wrapping_add(1);
    });
    Some((count, sum))
}

/// Writes the line that all targets print; an error for a refused plan.
pub(crate) fn report(out: &mut impl core::fmt::Write) -> core::fmt::Result {
    // The optimiser must not know the patch: the image is to hold the engine, not its result.
    let (patch, steps) = core::hint::black_box((&PATCH, STEPS));
    let (count, sum) = checksum(patch, steps).ok_or(core::fmt::Error)?;
    writeln!(out, "fw_smoke: {count} points, checksum {sum:08x}")
}

#[cfg(not(target_os = "none"))]
fn main() {
    run::on_host();
}
