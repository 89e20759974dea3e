//! A smooth skin over a mesh of 200 vertices on a board with 64 KB of RAM: the first pass takes a byte a vertex, then the
//! 400 quintic triangles stream out one after the other. The mesh, its links included, stays in flash.
//!
//! ```sh
//! CARGO_PROFILE_RELEASE_OPT_LEVEL=s cargo run --release --target thumbv7m-none-eabi --example fw_skin
//! ```
//!
//! It prints a checksum of all control points, the quality, and on a board the RAM that it took: shifts and stack, painted
//! before and looked at after. `tests/firmware_skin.rs` compares the rest with a host.
#![cfg_attr(target_os = "none", no_std, no_main)]

#[path = "data/ring.rs"]
mod ring;
#[path = "board/run.rs"]
mod run;

use core::fmt::{Error, Result, Write};
use embedded_surfaces::g1::{Controls, Interpolant, Options, Shift};

/// Streams all triangles; a checksum of their control points.
#[inline(never)]
fn skin(out: &mut impl Write, shifts: &mut [Shift]) -> Result {
    let surface =
        Interpolant::new(&ring::RING, &Controls::default(), &Options::default(), shifts).map_err(|_| Error)?;
    let mut sum = 0_u64;
    for triangle in surface.triangles() {
        for point in triangle.map_err(|_| Error)?.points() {
            for c in point.to_array() {
                sum = sum.wrapping_mul(0x0000_0100_0000_01b3).wrapping_add(c.to_bits() as u64).rotate_left(9);
            }
        }
    }
    writeln!(out, "{} triangles, checksum {sum:016x}", ring::TRIANGLES)?;
    let shifted = surface.shifts().iter().filter(|shift| !shift.is_none()).count();
    writeln!(out, "{shifted} vertices with moved tangents")
}

pub(crate) fn report(out: &mut impl Write) -> Result {
    #[cfg(all(target_os = "none", target_arch = "arm"))]
    let top = stack::paint();
    let mut shifts = [Shift::NONE; ring::VERTICES];
    skin(out, &mut shifts)?;
    #[cfg(all(target_os = "none", target_arch = "arm"))]
    writeln!(out, "RAM {}", stack::used(top))?;
    Ok(())
}

#[cfg(not(target_os = "none"))]
fn main() {
    run::on_host();
}

/// How far down the stack goes: paint below, and look how far the paint is gone.
#[cfg(all(target_os = "none", target_arch = "arm"))]
mod stack {
    const PAINT: u32 = 0xA5A5_5A5A;
    /// What is painted, in bytes.
    const DEEPEST: usize = 60 * 1024;

    /// Paints what lies below; returns where that begins.
    #[inline(never)]
    pub(crate) fn paint() -> usize {
        let local = 0_u8;
        let here = core::hint::black_box(&raw const local) as usize & !3;
        for address in (here - DEEPEST..here - 256).step_by(4) {
            // SAFETY: unused stack between the heapless program's statics and this frame.
            unsafe { (address as *mut u32).write_volatile(PAINT) };
        }
        here
    }

    pub(crate) fn used(top: usize) -> usize {
        // SAFETY: the same words.
        let is_painted = |address: &usize| unsafe { (*address as *const u32).read_volatile() } == PAINT;
        let lowest = (top - DEEPEST..top).step_by(4).find(|address| !is_painted(address));
        top - lowest.unwrap_or(top)
    }
}
