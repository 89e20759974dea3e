//! Instructions of a whole 320 × 240 frame of the teapot under QEMU, exactly: by exact points and by the facets of a grid,
//! in one piece and in 15 bands of 16 rows. A frame is everything from control points in model space to pixels in a buffer:
//! they are mapped, the patches checked, the buffers cleared and drawn to.
//!
//! ```sh
//! cargo run --release --target thumbv7em-none-eabihf --example fw_cost \
//!     --config 'target.thumbv7em-none-eabihf.rustflags=["-Clink-arg=--defsym=_flash_of_mps2=1"]'
//! ```
//!
//! A line per frame: `name: N instructions, P points, sum S`, where the points are the pixels of the frame and the sum is
//! that of their colours. `tests/firmware_bench.rs` compares the counts with `tests/budgets.txt` and the sums with the
//! host's.
#![cfg_attr(target_os = "none", no_std, no_main)]

#[path = "board/counter.rs"]
mod counter;
#[path = "data/frame.rs"]
#[allow(dead_code, reason = "the file format and the parts are for `fw_frame`")]
pub(crate) mod frame;
#[path = "board/run.rs"]
mod run;
#[path = "data/teapot.rs"]
pub(crate) mod teapot;

use embedded_graphics_core::pixelcolor::IntoStorage;
use embedded_surfaces::geometry::Affine;
use embedded_surfaces::patch::BicubicPatch;
use embedded_surfaces::render::{Facet, Notes};
use frame::{AREA, BANDS, Picture, ROWS};

/// Facets of a list: the frame has 773.
const FACETS: usize = 800;

/// A whole frame, and a list.
type Buffers = frame::Buffers<{ AREA.pixels() }, FACETS, { FACETS + BANDS }>;

/// Calls `f` with the buffers: 384 KB, of the memory that `memory.x` keeps for measurements.
#[cfg(target_os = "none")]
fn with_buffers<T>(f: impl FnOnce(&mut Buffers) -> T) -> T {
    // Not set at the start: all zero or, of what is used, written first.
    #[cfg_attr(target_arch = "arm", unsafe(link_section = ".bench"))]
    static mut BUFFERS: Buffers = Buffers::new();
    // SAFETY: called once, and nothing else runs.
    f(unsafe { &mut *(&raw mut BUFFERS) })
}

#[cfg(not(target_os = "none"))]
fn with_buffers<T>(f: impl FnOnce(&mut Buffers) -> T) -> T {
    f(&mut Box::new(Buffers::new()))
}

/// Writes a line per frame; an error where one is refused.
pub(crate) fn report(out: &mut impl core::fmt::Write) -> core::fmt::Result {
    with_buffers(|buffers| {
        let mut line = |name: &str, cost: Option<[i64; 3]>| {
            let [instructions, pixels, sum] = cost.ok_or(core::fmt::Error)?;
            writeln!(out, "{name}: {instructions} instructions, {pixels} points, sum {sum}")
        };
        line("grid, full frame", cost::<true>(buffers, AREA.height, false))?;
        line("grid, bands with a list", cost::<true>(buffers, ROWS, true))?;
        line("grid, bands without a list", cost::<true>(buffers, ROWS, false))?;
        line("exact points, full frame", cost::<false>(buffers, AREA.height, false))?;
        line("exact points, bands", cost::<false>(buffers, ROWS, false))
    })
}

/// Instructions, pixels and their sum of a frame in bands of so many rows; `None` if it was refused.
fn cost<const GRID: bool>(buffers: &mut Buffers, rows: u32, with_list: bool) -> Option<[i64; 3]> {
    let Buffers { patches, facets, links, colour, depth } = buffers;
    let mut notes = Notes::EMPTY;
    let map = core::hint::black_box(frame::view()?);
    let list = with_list.then_some((&mut facets[..], &mut links[..]));
    let mut frame = None;
    let mut instructions = counter::count(|| frame = start::<GRID>(&map, patches, rows, list, &mut notes));
    let (mut frame, mut pixels, mut sum) = (frame?, 0, 0_u32);
    loop {
        let mut band = None;
        instructions += counter::count(|| band = frame.next_band(colour, depth).ok());
        let Some(band) = band? else { break };
        pixels += band.pixels().len() as i64;
        sum = band.pixels().iter().fold(sum, |sum, colour| sum.wrapping_add(colour.into_storage().into()));
    }
    Some([instructions.into(), pixels, sum.into()])
}

/// What comes before the first band.
fn start<'a, const GRID: bool>(
    map: &Affine,
    patches: &'a mut [BicubicPatch; 32],
    rows: u32,
    list: Option<(&'a mut [Facet], &'a mut [u16])>,
    notes: &'a mut Notes,
) -> Option<Picture<'a>> {
    frame::place(map, patches)?;
    let frame =
        if GRID { frame::grid(patches, AREA, rows)? } else { frame::exact(patches, AREA, rows)?.with_notes(notes) };
    match list {
        Some((facets, links)) => frame.with_facets(facets, links).ok(),
        None => Some(frame),
    }
}

#[cfg(not(target_os = "none"))]
fn main() {
    run::on_host();
}
