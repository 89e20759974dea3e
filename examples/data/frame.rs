//! The 320 × 240 teapot of `fw_frame` and `fw_cost`: what boards draw, and what hosts draw to compare.

use crate::teapot;
use embedded_graphics_core::pixelcolor::{Rgb565, RgbColor};
use embedded_surfaces::geometry::{Affine, View};
use embedded_surfaces::graphics::Palette;
use embedded_surfaces::num::I16F16;
use embedded_surfaces::patch::{BicubicPatch, Tensor};
use embedded_surfaces::render::{Area, Cull, Facet, Frame, Light, Notes, Scene, Style};
use embedded_surfaces::subdivide::PatchTopology;

pub(crate) const AREA: Area = Area { x: 0, y: 0, width: 320, height: 240 };
/// Rows of a band.
pub(crate) const ROWS: u32 = 16;
/// Pixels of a band.
pub(crate) const BAND: usize = (AREA.width * ROWS) as usize;
/// Bands of a frame.
pub(crate) const BANDS: usize = AREA.height.div_ceil(ROWS) as usize;

/// The most facets of a list for a part: the upper one has 438, the lower one 376.
#[allow(dead_code, reason = "`fw_cost` lists the whole frame")]
pub(crate) const PART_FACETS: usize = 450;
/// Rows of the upper part.
const UPPER: u32 = 5 * ROWS;

/// A frame as it is drawn.
pub(crate) type Picture<'a> = Frame<'a, BicubicPatch, Palette<Rgb565>>;

/// How the patches meet, found by the compiler: the model's nets are whole numbers in flash.
static EDGES: [PatchTopology; 32] = match Tensor::topology(&teapot::MODEL) {
    Ok(edges) => edges,
    Err(_) => panic!("the teapot's parts have two sides"),
};

/// `Rgb565::CSS_BURLY_WOOD` at all levels, as a `Material` darkens it; in flash.
pub(crate) static PAINT: Palette<Rgb565> = {
    const fn scaled(channel: u32, level: u32) -> u8 {
        ((2 * channel * level + 255) / 510) as u8
    }
    let (mut colours, mut level) = ([Rgb565::BLACK; 256], 0);
    while level < 256 {
        colours[level as usize] = Rgb565::new(scaled(27, level), scaled(45, level), scaled(16, level));
        level += 1;
    }
    Palette { colours }
};

/// What a frame needs: 6 KB of patches, two bytes of colour and two of depth for each pixel of a band, and for a list of
/// facets 32 bytes a facet and two bytes for each facet and each band.
pub(crate) struct Buffers<const PIXELS: usize, const FACETS: usize, const LINKS: usize> {
    pub(crate) patches: [BicubicPatch; 32],
    pub(crate) facets: [Facet; FACETS],
    pub(crate) links: [u16; LINKS],
    pub(crate) colour: [Rgb565; PIXELS],
    pub(crate) depth: [u16; PIXELS],
}

impl<const PIXELS: usize, const FACETS: usize, const LINKS: usize> Buffers<PIXELS, FACETS, LINKS> {
    pub(crate) const fn new() -> Self {
        Self {
            patches: [teapot::BLANK; 32],
            facets: [Facet::EMPTY; FACETS],
            links: [0; LINKS],
            colour: [Rgb565::BLACK; PIXELS],
            depth: [0; PIXELS],
        }
    }
}

/// The default view of the whole model, from the model's units to pixels.
#[inline(never)]
pub(crate) fn view() -> Option<Affine> {
    let fit = I16F16::from_bits(60_293); // 0.92
    View::default().fit(teapot::vertices(), AREA.width, AREA.height, fit).ok()
}

/// Maps the control points; out of line, so that its stack is free again when patches are drawn.
#[inline(never)]
pub(crate) fn place(map: &Affine, patches: &mut [BicubicPatch; 32]) -> Option<()> {
    teapot::map_into(map, patches).ok()
}

/// A part of the frame by exact points, back faces culled, in bands of so many rows.
pub(crate) fn exact(patches: &[BicubicPatch; 32], area: Area, rows: u32) -> Option<Picture<'_>> {
    let scene = Scene::new(patches, Light::default(), Style::Shaded).ok()?.with_topology(&EDGES).ok()?;
    Frame::new(scene.with_cull(Cull::Back), &PAINT, Rgb565::BLACK, area, rows).ok()
}

/// The same by facets within a pixel of the surface.
pub(crate) fn grid(patches: &[BicubicPatch; 32], area: Area, rows: u32) -> Option<Picture<'_>> {
    let scene = Scene::grid(patches, &EDGES, I16F16::ONE, Light::default(), Style::Shaded).ok()?;
    Frame::new(scene.with_cull(Cull::Back), &PAINT, Rgb565::BLACK, area, rows).ok()
}

/// Draws the default view in bands, by facets if `GRID`; `row` gets the rows of the picture from the top. `None` if
/// anything was refused.
///
/// The two parts are frames of their own: a list of facets then takes three fifths of the room, and no pixel changes.
pub(crate) fn draw<const GRID: bool, const FACETS: usize, const LINKS: usize>(
    buffers: &mut Buffers<BAND, FACETS, LINKS>,
    mut row: impl FnMut(&[Rgb565]),
) -> Option<()> {
    let Buffers { patches, facets, links, colour, depth } = buffers;
    // 0.5 KB, for exact points alone.
    let mut notes = Notes::EMPTY;
    place(&view()?, patches)?;
    for area in [Area { height: UPPER, ..AREA }, Area { y: UPPER as i32, height: AREA.height - UPPER, ..AREA }] {
        let mut frame = if GRID {
            grid(patches, area, ROWS)?.with_facets(&mut *facets, &mut *links).ok()?
        } else {
            exact(patches, area, ROWS)?.with_notes(&mut notes)
        };
        while let Some(band) = frame.next_band(colour, depth).ok()? {
            band.pixels().chunks_exact(AREA.width as usize).for_each(&mut row);
        }
    }
    Some(())
}

/// A row of a binary PPM: three bytes a pixel, each channel stretched to 8 bits.
pub(crate) fn ppm_row(pixels: &[Rgb565]) -> [u8; 3 * AREA.width as usize] {
    let mut bytes = [0; 3 * AREA.width as usize];
    for (out, pixel) in bytes.as_chunks_mut::<3>().0.iter_mut().zip(pixels) {
        let (r, g, b) = (pixel.r(), pixel.g(), pixel.b());
        *out = [(r << 3) | (r >> 2), (g << 2) | (g >> 4), (b << 3) | (b >> 2)];
    }
    bytes
}

/// The head of the file.
pub(crate) const PPM_HEAD: &[u8] = b"P6\n320 240\n255\n";
