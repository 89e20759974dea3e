//! Instructions a point under QEMU, exactly. The image takes more than the 256 KB of `memory.x`, and a picture of
//! 320 × 240 pixels more than its 64 KB of RAM:
//!
//! ```sh
//! cargo run --release --target thumbv7em-none-eabihf --example fw_bench \
//!     --config 'target.thumbv7em-none-eabihf.rustflags=["-Clink-arg=--defsym=_flash_of_mps2=1"]'
//! ```
//!
//! A line per row: `name: N instructions, P points, sum S`. F is how many fraction bits the net uses. Of each lattice
//! * `generation` makes the points, set-up included; the sink is the wrapping sum of the coordinates;
//! * `depth test and store` makes the same points, and the nearest of each pixel leaves 16 bits of depth and 16 of
//!   colour; the sum is that of the depths. Clearing is not counted;
//! * `visibility buffer` is the same work as an operation of the crate, which may choose the order.
//!
//! The crate shades no lattice of the caller's: `scene, shaded` draws the patch by a [`Scene`] into a cleared [`Tile`],
//! with the points and pieces that the renderer chooses, exact normals after the depth test; its points are counted, its
//! sum is that of the levels.
//!
//! `tests/firmware_bench.rs` compares the counts with `tests/budgets.txt` and the sums with the host's.
#![cfg_attr(target_os = "none", no_std, no_main)]

#[path = "board/counter.rs"]
mod counter;
#[path = "data/nets.rs"]
mod nets;
#[path = "board/room.rs"]
mod room;
#[path = "board/run.rs"]
mod run;

use core::hint::black_box;
use embedded_surfaces::forward::{Lattice, Steps, Tags, VisibilityBuffer};
use embedded_surfaces::geometry::Point3;
use embedded_surfaces::patch::{BicubicPatch, CubicTriangle, QuinticTriangle, Surface, SurfaceNet};
use embedded_surfaces::render::{Area, Fragment, Light, Scene, Style, Tile};

const AREA: Area = Area { x: 0, y: 0, width: 320, height: 240 };
/// Fraction bits that the nets use.
const FRACTIONS: [u32; 4] = [0, 4, 8, 16];

/// Pictures.
struct Screen {
    colour: [u16; AREA.pixels()],
    depth: [u16; AREA.pixels()],
    visible: [u32; AREA.pixels()],
}

/// The nets of a number of fraction bits: the whole ones, with an inner point moved by 2^-bits.
struct Nets {
    cubic: CubicTriangle,
    bicubic: BicubicPatch,
    quintic: QuinticTriangle,
}

impl Nets {
    fn with_fraction(bits: u32) -> Option<Self> {
        let moved = |p: Point3| {
            let by = if bits == 0 { 0 } else { 1 << (16 - bits) };
            Point3::from_bits(p.x.to_bits() + by, p.y.to_bits(), p.z.to_bits())
        };
        let mut cubic = *CubicTriangle::from_ints(nets::SEED_P).ok()?.points();
        let mut bicubic = *BicubicPatch::from_ints(nets::BICUBIC).ok()?.points();
        let mut quintic = *QuinticTriangle::from_ints(nets::QUINTIC).ok()?.points();
        for point in [&mut cubic[4], &mut bicubic[1][1], &mut quintic[7]] {
            *point = moved(*point);
        }
        Some(Self {
            cubic: CubicTriangle::new(cubic).ok()?,
            bicubic: BicubicPatch::new(bicubic).ok()?,
            quintic: QuinticTriangle::new(quintic).ok()?,
        })
    }

    /// Name, net and steps of the lattices.
    fn lattices(&self) -> [(&'static str, SurfaceNet<'_>, u32); 5] {
        let (cubic, bicubic, quintic) = (self.cubic.surface(), self.bicubic.surface(), self.quintic.surface());
        [
            ("cubic n=256", cubic, 256),
            ("cubic n=1024", cubic, 1024),
            ("cubic n=300", cubic, 300),
            ("bicubic n=256", bicubic, 256),
            ("quintic n=256", quintic, 256),
        ]
    }
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

/// The points into a depth buffer, as a caller with no renderer would write it.
#[inline(never)]
fn store(net: SurfaceNet<'_>, steps: u32, screen: &mut Screen, total: &mut Total) {
    let lattice = Steps::uniform(steps).and_then(|steps| Lattice::new(net, steps));
    let Ok(lattice) = lattice else { return };
    let Screen { colour, depth, .. } = screen;
    lattice.for_each(|p| {
        let (x, y) = (p.x as u32, p.y as u32);
        if x >= AREA.width || y >= AREA.height {
            return;
        }
        let at = (y * AREA.width + x) as usize;
        let z = p.z.wrapping_add(1 << 15) as u16;
        if let (Some(depth), Some(colour)) = (depth.get_mut(at), colour.get_mut(at))
            && z < *depth
        {
            (*depth, *colour) = (z, p.i as u16);
        }
    });
    total.points = lattice.point_count() as u32;
}

/// The points into a visibility buffer, with the tags that [`store`] has as colours.
#[inline(never)]
fn visible(net: SurfaceNet<'_>, steps: u32, screen: &mut Screen, total: &mut Total) {
    let lattice = Steps::uniform(steps).and_then(|steps| Lattice::new(net, steps));
    let Ok(lattice) = lattice else { return };
    let buffer = VisibilityBuffer::new(&mut screen.visible, AREA.width, AREA.height);
    let Ok(mut buffer) = buffer else { return };
    buffer.draw(&lattice, Tags { first: 0, by_i: 1, by_j: 0 });
    total.points = lattice.point_count() as u32;
}

/// The patch as the renderer draws it.
#[inline(never)]
fn shade(net: SurfaceNet<'_>, tile: &mut Tile<'_, u16>, total: &mut Total) {
    let Ok(scene) = Scene::new(core::slice::from_ref(&net), Light::default(), Style::Shaded) else { return };
    total.points = scene.draw(tile, &|at: Fragment| u16::from(at.shade)).points as u32;
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

fn sum_of(values: &[u16]) -> i32 {
    values.iter().fold(0, |sum, value| sum.wrapping_add(i32::from(*value)))
}

/// Writes a line per row.
pub(crate) fn report(out: &mut impl core::fmt::Write) -> core::fmt::Result {
    const CLEAR: Screen = Screen { colour: [0; AREA.pixels()], depth: [0; AREA.pixels()], visible: [0; AREA.pixels()] };
    let screen = room::room!(Screen, CLEAR);
    writeln!(out, "nops: {} instructions, 1000 points, sum 0", counter::count(nops))?;
    for bits in FRACTIONS {
        let nets = Nets::with_fraction(bits).ok_or(core::fmt::Error)?;
        for (name, net, steps) in nets.lattices() {
            lattice_rows(out, (name, bits), black_box((net, steps)), screen)?;
        }
        for (name, net) in
            [("cubic", nets.cubic.surface()), ("bicubic", nets.bicubic.surface()), ("quintic", nets.quintic.surface())]
        {
            scene_row(out, (name, bits), black_box(net), screen)?;
        }
    }
    Ok(())
}

fn lattice_rows(
    out: &mut impl core::fmt::Write,
    (name, bits): (&str, u32),
    (net, steps): (SurfaceNet<'_>, u32),
    screen: &mut Screen,
) -> core::fmt::Result {
    let mut total = Total::default();
    let instructions = counter::count(|| generate(net, steps, &mut total));
    write_row(out, (name, bits, "generation"), instructions, &total)?;
    let instructions = counter::count(|| unordered(net, steps, &mut total));
    write_row(out, (name, bits, "any order"), instructions, &total)?;
    let instructions = counter::count(|| checksum(net, steps, &mut total));
    write_row(out, (name, bits, "checksum"), instructions, &total)?;
    screen.depth.fill(u16::MAX);
    let instructions = counter::count(|| store(net, steps, screen, &mut total));
    total.sum = sum_of(&screen.depth);
    write_row(out, (name, bits, "depth test and store"), instructions, &total)?;
    screen.visible.fill(VisibilityBuffer::EMPTY);
    let instructions = counter::count(|| visible(net, steps, screen, &mut total));
    total.sum = screen.visible.iter().fold(0, |sum, entry| sum.wrapping_add((entry >> 16) as i32));
    write_row(out, (name, bits, "visibility buffer"), instructions, &total)
}

fn scene_row(
    out: &mut impl core::fmt::Write,
    (name, bits): (&str, u32),
    net: SurfaceNet<'_>,
    screen: &mut Screen,
) -> core::fmt::Result {
    let mut total = Total::default();
    let mut tile = Tile::new(AREA, &mut screen.colour, &mut screen.depth, 0).map_err(|_| core::fmt::Error)?;
    let instructions = counter::count(|| shade(net, &mut tile, &mut total));
    total.sum = sum_of(tile.pixels());
    write_row(out, (name, bits, "scene, shaded"), instructions, &total)
}

fn write_row(
    out: &mut impl core::fmt::Write,
    (name, bits, what): (&str, u32, &str),
    instructions: u32,
    total: &Total,
) -> core::fmt::Result {
    let Total { points, sum } = total;
    writeln!(out, "{name} F={bits}, {what}: {instructions} instructions, {points} points, sum {sum}")
}

#[cfg(not(target_os = "none"))]
fn main() {
    run::on_host();
}
