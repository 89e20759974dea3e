//! Two surfaces meet on a board with 64 KB of RAM: grids of depth 5, boxes to depth 3, all points refined.
//!
//! ```sh
//! CARGO_PROFILE_RELEASE_OPT_LEVEL=s cargo run --release --target thumbv7em-none-eabihf --example fw_intersect
//! ```
//!
//! For each pair it prints the curves, the points, a checksum of their bits; on a board also instructions, and the RAM that
//! all of it took: tables and stack, painted before and looked at after. `tests/firmware_intersect.rs` compares the rest
//! with a host.
#![cfg_attr(target_os = "none", no_std, no_main)]

#[path = "board/counter.rs"]
mod counter;
#[path = "data/pairs.rs"]
mod pairs;
#[path = "board/run.rs"]
mod run;
#[cfg(all(target_os = "none", target_arch = "arm"))]
#[path = "board/stack.rs"]
mod stack;

use core::fmt::{Error, Result, Write};
use embedded_surfaces::intersect::{Branch, Buffers, Curve, CurvePoint, I20F44, Intersection, Options, intersect};
use pairs::Pair;

/// Of two tensor-product patches at depth 5: 26 KB.
const VERTICES: usize = 2 * 33 * 33;
/// Of both patches to level 3, two less than the grids': 4 KB.
const BOXES: usize = 2 * (1 + 4 + 16 + 64);
/// 24 bytes each.
const SEGMENTS: usize = 210;
/// 80 bytes each.
const POINTS: usize = 140;

/// Adds the bits of all points to a checksum.
fn checksum(found: &Intersection<'_>) -> u64 {
    let mut sum = 0_u64;
    let mut add = |bits: i64| sum = sum.wrapping_mul(0x0000_0100_0000_01b3).wrapping_add(bits as u64).rotate_left(9);
    for point in found.curves().iter().flat_map(|curve| found.points(curve)) {
        point.parameters.as_flattened().iter().for_each(|c| add(c.to_bits()));
        point.position.to_array().iter().for_each(|c| add(c.to_bits()));
        point.tangent.to_array().iter().for_each(|c| add(c.to_bits().into()));
        [point.sine.to_bits().into(), point.residual.to_bits()].into_iter().for_each(&mut add);
    }
    sum
}

/// Intersects a pair and writes what comes out; the instructions.
#[inline(never)]
fn meet(out: &mut impl Write, pair: &Pair, buffers: Buffers<'_>) -> core::result::Result<u32, Error> {
    let [a, b] = pair.nets;
    let options = Options::DEFAULT.with_tolerance(I20F44::from_bits(1 << (44 - pair.tolerance)));
    let mut found = Err(Error);
    let count = counter::count(|| found = intersect(a, b, &options, buffers).map_err(|_| Error));
    let found = found?;
    let points: usize = found.curves().iter().map(|curve| curve.count).sum();
    let unrefined: u32 = found.curves().iter().map(|curve| curve.unrefined).sum();
    let certified = if found.is_certified() { "certified" } else { "not certified" };
    writeln!(
        out,
        "{}, within 2^-{}: {} curves, {points} points, {unrefined} pieces unrefined, {certified}, checksum {:016x}",
        pair.name,
        pair.tolerance,
        found.curves().len(),
        checksum(&found)
    )?;
    Ok(count)
}

pub(crate) fn report(out: &mut impl Write) -> Result {
    #[cfg(all(target_os = "none", target_arch = "arm"))]
    stack::paint();
    let mut vertices = [[0; 3]; VERTICES];
    let mut boxes = [[[0; 3]; 2]; BOXES];
    let (mut records, mut links) = ([0; 2 * SEGMENTS], [0; 2 * SEGMENTS]);
    let mut points = [CurvePoint::BLANK; POINTS];
    let (mut curves, mut branches) = ([Curve::BLANK; 2], [Branch::BLANK; 1]);
    let mut counts = [0; pairs::COUNT];
    for (pair, count) in pairs::pairs().iter().zip(&mut counts) {
        let buffers = Buffers {
            vertices: &mut vertices,
            boxes: &mut boxes,
            records: &mut records,
            links: &mut links,
            points: &mut points,
            curves: &mut curves,
            branches: &mut branches,
        };
        *count = meet(out, pair, buffers)?;
    }
    #[cfg(all(target_os = "none", target_arch = "arm"))]
    {
        let used = stack::used();
        for (pair, count) in pairs::pairs().iter().zip(counts) {
            writeln!(out, "{count} instructions, {}", pair.name)?;
        }
        writeln!(out, "{used} bytes of RAM")?;
    }
    let _ = counts;
    Ok(())
}

#[cfg(not(target_os = "none"))]
fn main() {
    run::on_host();
}
