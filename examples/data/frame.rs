//! The 320 × 240 teapot of `fw_frame` in bands of 16 rows: what the board draws, and what the host draws to compare.

use crate::teapot;
use embedded_graphics_core::pixelcolor::{Rgb565, RgbColor, WebColors};
use embedded_surfaces::geometry::View;
use embedded_surfaces::graphics::Material;
use embedded_surfaces::num::I16F16;
use embedded_surfaces::patch::{BicubicPatch, Tensor};
use embedded_surfaces::render::{Area, Cull, Frame, Light, Scene, Style};
use embedded_surfaces::subdivide::PatchTopology;

pub(crate) const AREA: Area = Area { x: 0, y: 0, width: 320, height: 240 };
/// Rows of a band.
pub(crate) const ROWS: u32 = 16;
/// Pixels of a band.
pub(crate) const BAND: usize = (AREA.width * ROWS) as usize;

/// How the patches meet, found by the compiler: the model's nets are whole numbers in flash.
static EDGES: [PatchTopology; 32] = match Tensor::topology(&teapot::MODEL) {
    Ok(edges) => edges,
    Err(_) => panic!("the teapot's parts have two sides"),
};

/// What a frame needs: 6 KB of patches, and for a band 10 KB of colours and 10 KB of depths.
pub(crate) struct Buffers {
    patches: [BicubicPatch; 32],
    colour: [Rgb565; BAND],
    depth: [u16; BAND],
}

impl Buffers {
    pub(crate) const fn new() -> Self {
        Self { patches: [teapot::BLANK; 32], colour: [Rgb565::BLACK; BAND], depth: [0; BAND] }
    }
}

/// The patches in the default view; out of line, so that its stack is free again when patches are drawn.
#[inline(never)]
fn place(patches: &mut [BicubicPatch; 32]) -> Option<()> {
    let fit = I16F16::from_bits(60_293); // 0.92
    let map = View::default().fit(teapot::vertices(), AREA.width, AREA.height, fit).ok()?;
    teapot::map_into(&map, patches).ok()
}

/// Draws the default view, back faces culled; `row` gets the rows of the picture from the top. `None` if anything was
/// refused.
pub(crate) fn draw(grid: bool, buffers: &mut Buffers, mut row: impl FnMut(&[Rgb565])) -> Option<()> {
    let Buffers { patches, colour, depth } = buffers;
    place(patches)?;
    let (light, style) = (Light::default(), Style::Shaded);
    let scene = if grid {
        Scene::grid(patches, &EDGES, I16F16::ONE, light, style).ok()?
    } else {
        Scene::new(patches, light, style).ok()?.with_topology(&EDGES).ok()?
    };
    let paint = Material { colour: Rgb565::CSS_BURLY_WOOD };
    let mut frame = Frame::new(scene.with_cull(Cull::Back), &paint, Rgb565::BLACK, AREA, ROWS).ok()?;
    while let Some(band) = frame.next_band(colour, depth).ok()? {
        band.pixels().chunks_exact(AREA.width as usize).for_each(&mut row);
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
