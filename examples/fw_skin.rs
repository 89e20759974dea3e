//! A smooth skin over a mesh of 200 vertices on a board with 64 KB of RAM: the first pass takes a byte a vertex, then the
//! 400 quintic triangles stream out one after the other. The mesh, its links included, stays in flash.
//!
//! ```sh
//! CARGO_PROFILE_RELEASE_OPT_LEVEL=s cargo run --release --target thumbv7m-none-eabi --example fw_skin
//! ```
//!
//! It prints a checksum of all control points and how many vertices had their tangents moved; on a board also instructions
//! and the RAM that it took: shifts and stack, painted before and looked at after. `tests/firmware_skin.rs` compares the rest with a host.
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(all(target_os = "none", target_arch = "arm"))]
#[path = "board/counter.rs"]
mod counter;
#[path = "data/ring.rs"]
mod ring;
#[path = "board/run.rs"]
mod run;

use core::fmt::{Error, Result, Write};
use embedded_surfaces::g1::{Controls, Interpolant, Options, Shift};

/// Runs a section; the instructions that it took, in thousands, 0 where they are not counted.
fn thousands(section: impl FnOnce()) -> u32 {
    #[cfg(all(target_os = "none", target_arch = "arm"))]
    return counter::count(section) / 1000;
    #[cfg(not(all(target_os = "none", target_arch = "arm")))]
    {
        section();
        0
    }
}

/// Streams all triangles; writes a checksum of their control points, returns thousands of instructions of the first pass
/// and of a triangle.
#[inline(never)]
fn skin(out: &mut impl Write, shifts: &mut [Shift]) -> core::result::Result<[u32; 2], Error> {
    let (mut surface, mut sum, mut failed) = (None, 0_u64, false);
    let first = thousands(|| {
        surface = Interpolant::new(&ring::RING, &Controls::default(), &Options::default(), shifts).ok();
    });
    let surface = surface.ok_or(Error)?;
    let mut all = 0;
    for triangle in 0..ring::TRIANGLES {
        all += thousands(|| match surface.triangle(triangle) {
            Ok(triangle) => {
                for c in triangle.points().iter().flat_map(|point| point.to_array()) {
                    sum = sum.wrapping_mul(0x0000_0100_0000_01b3).wrapping_add(c.to_bits() as u64).rotate_left(9);
                }
            }
            Err(_) => failed = true,
        });
    }
    if failed {
        return Err(Error);
    }
    writeln!(out, "{} triangles, checksum {sum:016x}", ring::TRIANGLES)?;
    let shifted = surface.shifts().iter().filter(|shift| !shift.is_none()).count();
    writeln!(out, "{shifted} vertices with moved tangents")?;
    Ok([first, all / ring::TRIANGLES as u32])
}

pub(crate) fn report(out: &mut impl Write) -> Result {
    #[cfg(all(target_os = "none", target_arch = "arm"))]
    let top = stack::paint();
    let mut shifts = [Shift::NONE; ring::VERTICES];
    let thousands = skin(out, &mut shifts)?;
    #[cfg(all(target_os = "none", target_arch = "arm"))]
    {
        let used = stack::used(top);
        writeln!(out, "{} thousand instructions for the first pass, {} a triangle", thousands[0], thousands[1])?;
        writeln!(out, "RAM {used}")?;
    }
    let _ = thousands;
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
