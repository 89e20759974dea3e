//! What firmware does today, counted under QEMU on the same work as `fw_bench` and `fw_cost` of the crate: points of the
//! seed patch by floats, by Horner and by de Casteljau; the frame of `fw_cost` from a mesh baked to half a pixel, by
//! triangles of `embedded-graphics`, by two scanline rasterisers, and by `embedded-3dgfx`.
//!
//! ```sh
//! cd peers
//! cargo run --release --target thumbv7em-none-eabihf # or thumbv6m-none-eabi; riscv32imc-unknown-none-elf: points only
//! ```
//!
//! A line per row: `name: N instructions, P points, sum S`. The points of a frame are its pixels that are not black, its
//! sum is a checksum. Peers are given what the crate does not take: their tables are set up, and their mesh is made and
//! its view fitted, before anything is counted. `tests/firmware_peers.rs` compares counts with `tests/budgets.txt` and
//! pictures with the host's.
#![cfg_attr(target_os = "none", no_std, no_main)]
#![allow(clippy::disallowed_types, clippy::float_arithmetic, clippy::indexing_slicing, reason = "peers")]

#[path = "../../examples/board/counter.rs"]
mod counter;
#[cfg(not(target_arch = "riscv32"))]
pub(crate) mod frames;
#[path = "../../benches/peers/mod.rs"]
#[allow(dead_code, reason = "what vectorises is for hosts")]
mod points;
#[cfg(not(target_arch = "riscv32"))]
#[path = "../../examples/board/room.rs"]
mod room;
#[path = "../../examples/board/run.rs"]
mod run;
#[cfg(not(target_arch = "riscv32"))]
#[path = "../../examples/data/teapot.rs"]
pub(crate) mod teapot;

use core::fmt::Write;
use core::hint::black_box;
use points::{Cubic, SEED_P, Sink};

/// The wrapping sum of the coordinates, and how many points they were.
#[derive(Default)]
struct Sum {
    points: u32,
    sum: i32,
}

impl Sink for Sum {
    #[inline(always)]
    fn point(&mut self, _: u32, _: u32, x: i32, y: i32, z: i32) {
        self.sum = self.sum.wrapping_add(x).wrapping_add(y).wrapping_add(z);
    }
}

macro_rules! ways {
    ($($name:literal: $f:expr),+ $(,)?) => {
        [$(($name, {
            #[inline(never)]
            fn way(cubic: &Cubic, sum: &mut Sum) {
                $f(cubic, sum);
            }
            way as fn(&Cubic, &mut Sum)
        })),+]
    };
}

type Way = (&'static str, fn(&Cubic, &mut Sum));

/// Each as `benches/peers` writes it, a point at a time.
const WAYS: [Way; 4] = ways! {
    "f32 forward differences": points::forward_f32::<3, _>,
    "I16F16 Horner": points::horner_fixed,
    "I16F16 de Casteljau": points::de_casteljau_fixed,
    "f32 de Casteljau": points::de_casteljau_f32::<1, _>,
};

/// Writes a line per row.
pub(crate) fn report(out: &mut impl Write) -> core::fmt::Result {
    let n = 256;
    let cubic = Cubic::new(SEED_P, n);
    for (name, way) in WAYS {
        let mut sum = Sum { points: (n + 1) * (n + 2) / 2, sum: 0 };
        let instructions = counter::count(|| way(black_box(&cubic), &mut sum));
        let Sum { points, sum } = black_box(sum);
        writeln!(out, "cubic n=256, {name}: {instructions} instructions, {points} points, sum {sum}")?;
    }
    #[cfg(not(target_arch = "riscv32"))]
    frames::report(out)?;
    Ok(())
}

#[cfg(not(target_os = "none"))]
fn main() {
    run::on_host();
}
