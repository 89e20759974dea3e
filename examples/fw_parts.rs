//! What a picture of the teapot takes on parts of four sizes: firmware that draws one frame in bands, into nothing, and
//! says how deep its stack was.
//!
//! ```sh
//! export CARGO_PROFILE_RELEASE_OPT_LEVEL=s
//! FW_PART=4 cargo run --release --target thumbv7em-none-eabihf --example fw_parts
//! ```
//!
//! `FW_PART` chooses one of [`SETUPS`]. `tests/firmware_parts.rs` links each for its core, and makes the table of the
//! README from what the images and their runs say.
#![cfg_attr(target_os = "none", no_std, no_main)]

#[path = "board/run.rs"]
mod run;
#[path = "data/teapot.rs"]
#[allow(dead_code, reason = "its parts for other examples")]
pub(crate) mod teapot;

use embedded_graphics_core::pixelcolor::{Gray4, GrayColor, IntoStorage, Rgb565, RgbColor, WebColors};
use embedded_surfaces::geometry::View;
use embedded_surfaces::graphics::{Material, Shade};
use embedded_surfaces::num::I16F16;
use embedded_surfaces::patch::{BicubicPatch, Tensor};
use embedded_surfaces::render::{Area, Cull, Facet, Frame, Light, Scene, Style};
use embedded_surfaces::subdivide::PatchTopology;

/// A part and what is drawn on it.
#[allow(dead_code, reason = "tests read all of it")]
pub(crate) struct Setup {
    pub(crate) part: &'static str,
    pub(crate) target: &'static str,
    pub(crate) width: u32,
    pub(crate) height: u32,
    /// Rows of a band.
    pub(crate) rows: u32,
    /// 16 greys; else 16 bits of colour.
    pub(crate) is_grey: bool,
    pub(crate) fill: Fill,
}

#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Fill {
    Exact,
    /// Facets at one pixel, with room in a list for so many of them; 0 for no list.
    Grid(usize),
}

const M0: (&str, &str) = ("M0, 16 KB", "thumbv6m-none-eabi");
const M3: (&str, &str) = ("M3, 64 KB", "thumbv7m-none-eabi");
const M4: (&str, &str) = ("M4, 128 KB", "thumbv7em-none-eabihf");
const C3: (&str, &str) = ("ESP32-C3, 400 KB", "riscv32imc-unknown-none-elf");

const fn setup(
    (part, target): (&'static str, &'static str),
    (width, height, rows): (u32, u32, u32),
    is_grey: bool,
    fill: Fill,
) -> Setup {
    Setup { part, target, width, height, rows, is_grey, fill }
}

/// Displays that go with parts of such a size.
pub(crate) const SETUPS: [Setup; 8] = [
    setup(M0, (128, 64, 8), true, Fill::Exact),
    setup(M0, (128, 64, 4), true, Fill::Grid(0)),
    setup(M3, (160, 128, 16), false, Fill::Exact),
    setup(M3, (160, 128, 16), false, Fill::Grid(600)),
    setup(M4, (320, 240, 16), false, Fill::Exact),
    setup(M4, (320, 240, 16), false, Fill::Grid(800)),
    setup(C3, (320, 240, 16), false, Fill::Exact),
    setup(C3, (320, 240, 48), false, Fill::Grid(800)),
];

/// How the patches meet, found by the compiler.
static EDGES: [PatchTopology; 32] = match Tensor::topology(&teapot::MODEL) {
    Ok(edges) => edges,
    Err(_) => panic!("the teapot's parts have two sides"),
};

/// What a frame works in.
pub(crate) struct Buffers<'b, C> {
    pub(crate) patches: &'b mut [BicubicPatch; 32],
    pub(crate) colour: &'b mut [C],
    pub(crate) depth: &'b mut [u16],
    pub(crate) facets: &'b mut [Facet],
    pub(crate) links: &'b mut [u16],
}

/// Out of line, so that its stack is free again when patches are drawn.
#[inline(never)]
fn place(patches: &mut [BicubicPatch; 32], setup: &Setup) -> Option<()> {
    let fit = I16F16::from_bits(60_293); // 0.92
    let map = View::default().fit(teapot::vertices(), setup.width, setup.height, fit).ok()?;
    teapot::map_into(&map, patches).ok()
}

/// Draws the frame, back faces culled; the sum of its colours.
#[inline(always)]
pub(crate) fn draw<C: Shade + IntoStorage<Storage: Into<u32>>>(
    setup: &Setup,
    (colour, background): (C, C),
    buffers: &mut Buffers<'_, C>,
) -> Option<u32> {
    let area = Area { x: 0, y: 0, width: setup.width, height: setup.height };
    let Buffers { patches, colour: pixels, depth, facets, links } = buffers;
    place(patches, setup)?;
    let patches = &patches[..];
    let (light, style) = (Light::default(), Style::Shaded);
    let scene = match setup.fill {
        Fill::Exact => Scene::new(patches, light, style).ok()?.with_topology(&EDGES).ok()?,
        Fill::Grid(_) => Scene::grid(patches, &EDGES, I16F16::ONE, light, style).ok()?,
    };
    let paint = Material { colour };
    let mut frame = Frame::new(scene.with_cull(Cull::Back), &paint, background, area, setup.rows).ok()?;
    if matches!(setup.fill, Fill::Grid(1..)) {
        frame = frame.with_facets(facets, links).ok()?;
    }
    let mut sum = 0_u32;
    while let Some(band) = frame.next_band(pixels, depth).ok()? {
        sum = band.pixels().iter().fold(sum, |sum, colour| sum.wrapping_add(colour.into_storage().into()));
    }
    Some(sum)
}

/// The colours of a picture and of what is behind it.
pub(crate) const GREYS: (Gray4, Gray4) = (Gray4::WHITE, Gray4::BLACK);
pub(crate) const COLOURS: (Rgb565, Rgb565) = (Rgb565::CSS_BURLY_WOOD, Rgb565::BLACK);

#[cfg(not(target_os = "none"))]
fn main() {
    run::on_host();
}

/// The sums of the pictures of all set-ups.
#[cfg(not(target_os = "none"))]
fn report(out: &mut impl core::fmt::Write) -> core::fmt::Result {
    SETUPS.iter().try_for_each(|setup| {
        let sum = sum_on_host(setup).ok_or(core::fmt::Error)?;
        writeln!(out, "{}, {} × {}, {} rows: sum {sum}", setup.part, setup.width, setup.height, setup.rows)
    })
}

/// What the part says of its picture.
#[cfg(not(target_os = "none"))]
pub(crate) fn sum_on_host(setup: &Setup) -> Option<u32> {
    fn sum<C: Shade + IntoStorage<Storage: Into<u32>>>(setup: &Setup, colours: (C, C)) -> Option<u32> {
        let band = (setup.width * setup.rows) as usize;
        let list = if let Fill::Grid(facets) = setup.fill { facets } else { 0 };
        let mut buffers = Buffers {
            patches: &mut [teapot::BLANK; 32],
            colour: &mut vec![colours.1; band],
            depth: &mut vec![0; band],
            facets: &mut vec![Facet::EMPTY; list],
            links: &mut vec![0; list + setup.height.div_ceil(setup.rows) as usize],
        };
        draw(setup, colours, &mut buffers)
    }
    if setup.is_grey { sum(setup, GREYS) } else { sum(setup, COLOURS) }
}

#[cfg(target_os = "none")]
use firmware::report;

#[cfg(target_os = "none")]
mod firmware {
    use super::{BicubicPatch, Buffers, Facet, Fill, Gray4, Rgb565, SETUPS, Setup, draw, teapot};
    use core::fmt::{Error, Result, Write};
    use core::hint::black_box;

    const SETUP: &Setup = &SETUPS[match option_env!("FW_PART") {
        Some(number) => (number.as_bytes()[0] - b'0') as usize,
        None => 0,
    }];
    const BAND: usize = (SETUP.width * SETUP.rows) as usize;
    const FACETS: usize = match SETUP.fill {
        Fill::Exact => 0,
        Fill::Grid(facets) => facets,
    };
    const LINKS: usize = if FACETS == 0 { 0 } else { FACETS + SETUP.height.div_ceil(SETUP.rows) as usize };

    /// The colour type by its number of bits.
    struct Select<const IS_GREY: bool>;

    trait Colour {
        type Of: 'static + Copy;
        const PAIR: (Self::Of, Self::Of);
    }

    impl Colour for Select<true> {
        type Of = Gray4;
        const PAIR: (Gray4, Gray4) = super::GREYS;
    }

    impl Colour for Select<false> {
        type Of = Rgb565;
        const PAIR: (Rgb565, Rgb565) = super::COLOURS;
    }

    type Chosen = Select<{ SETUP.is_grey }>;
    type Pixel = <Chosen as Colour>::Of;

    static mut PATCHES: [BicubicPatch; 32] = [teapot::BLANK; 32];
    static mut PIXELS: [Pixel; BAND] = [Chosen::PAIR.1; BAND];
    static mut DEPTHS: [u16; BAND] = [0; BAND];
    static mut LIST: [Facet; FACETS] = [Facet::EMPTY; FACETS];
    static mut NEXT: [u16; LINKS] = [0; LINKS];

    unsafe extern "C" {
        static mut __sheap: u32;
        static mut _stack_start: u32;
    }

    const PAINT: u32 = 0xA5A5_5A5A;

    /// Where painting starts: 12 KB below the caller, or behind the statics.
    fn deepest(top: usize) -> usize {
        (top - 12 * 1024).max((&raw const __sheap) as usize)
    }

    #[inline(never)]
    fn here() -> usize {
        let local = 0_u8;
        black_box(&raw const local) as usize & !3
    }

    #[inline(never)]
    fn paint(top: usize) {
        for address in (deepest(top)..top - 64).step_by(4) {
            // SAFETY: unused stack between the heapless program's statics and this frame.
            unsafe { (address as *mut u32).write_volatile(PAINT) };
        }
    }

    /// Bytes from the end of the memory to where the paint is whole.
    fn used(top: usize) -> usize {
        // SAFETY: the same words.
        let is_painted = |address: &usize| unsafe { (*address as *const u32).read_volatile() } == PAINT;
        let lowest = (deepest(top)..top).step_by(4).find(|address| !is_painted(address)).unwrap_or(top);
        (&raw const _stack_start) as usize - lowest
    }

    #[inline(never)]
    fn picture() -> Option<u32> {
        // SAFETY: called once, and nothing else names the buffers.
        let mut buffers = unsafe {
            Buffers {
                patches: &mut *(&raw mut PATCHES),
                colour: &mut *(&raw mut PIXELS),
                depth: &mut *(&raw mut DEPTHS),
                facets: &mut *(&raw mut LIST),
                links: &mut *(&raw mut NEXT),
            }
        };
        draw(SETUP, Chosen::PAIR, &mut buffers)
    }

    pub(super) fn report(out: &mut impl Write) -> Result {
        let top = here();
        paint(top);
        let sum = picture().ok_or(Error)?;
        writeln!(out, "stack {}, sum {sum}", used(top))
    }
}
