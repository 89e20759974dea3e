//! Instructions of a whole 320 × 240 frame of the teapot under QEMU, exactly: by exact points, and by the facets of a
//! grid; the placing of the patches and 15 bands of 16 rows included.
//!
//! ```sh
//! cargo run --release --target thumbv7em-none-eabihf --example fw_cost \
//!     --config 'target.thumbv7em-none-eabihf.rustflags=["-Clink-arg=--defsym=_flash_of_mps2=1"]'
//! ```
//!
//! A line per fill: `name: N instructions, P points, sum S`, where the points are the pixels of the frame and the sum is
//! that of their colours. `tests/firmware_bench.rs` compares the counts with `tests/budgets.txt` and the sums with the
//! host's.
#![cfg_attr(target_os = "none", no_std, no_main)]

#[path = "board/counter.rs"]
mod counter;
#[path = "data/frame.rs"]
#[allow(dead_code, reason = "the file format is for `fw_frame`")]
pub(crate) mod frame;
#[path = "board/run.rs"]
mod run;
#[path = "data/teapot.rs"]
pub(crate) mod teapot;

use embedded_graphics_core::pixelcolor::IntoStorage;

/// Writes a line per fill; an error where the frame is refused.
pub(crate) fn report(out: &mut impl core::fmt::Write) -> core::fmt::Result {
    let mut buffers = frame::Buffers::new();
    for (name, grid) in [("frame, exact points", false), ("frame, grid", true)] {
        let (mut pixels, mut sum) = (0, 0_i32);
        let mut drawn = None;
        let instructions = counter::count(|| {
            drawn = frame::draw(core::hint::black_box(grid), &mut buffers, |row| {
                pixels += row.len();
                sum = row.iter().fold(sum, |sum, colour| sum.wrapping_add(i32::from(colour.into_storage())));
            });
        });
        drawn.ok_or(core::fmt::Error)?;
        writeln!(out, "{name}: {instructions} instructions, {pixels} points, sum {sum}")?;
    }
    Ok(())
}

#[cfg(not(target_os = "none"))]
fn main() {
    run::on_host();
}
