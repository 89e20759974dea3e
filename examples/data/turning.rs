//! The turning teapot of `fw_oled`: what the board draws, and what the host draws to compare.

use crate::teapot;
use embedded_graphics_core::draw_target::DrawTarget;
use embedded_graphics_core::pixelcolor::{Gray4, GrayColor};
use embedded_surfaces::geometry::{Affine, GeometryError, View};
use embedded_surfaces::graphics::Material;
use embedded_surfaces::num::{Angle, I32F32};
use embedded_surfaces::patch::BicubicPatch;
use embedded_surfaces::render::{Area, Frame, Light, RenderError, Scene, Statistics, Style};

/// The screen.
pub(crate) const AREA: Area = Area { x: 0, y: 0, width: 128, height: 64 };
/// Frames of a full turn.
pub(crate) const TURN: u32 = 40;

const ROWS: u32 = 16;
const BAND: usize = (AREA.width * ROWS) as usize;
/// Pixels of a unit of the model, of which it is 12 600 high: what keeps the spout on the screen at every spin.
const SCALE: I32F32 = I32F32::from_bits((1 << 32) / 270);

/// What a frame needs: 6 KB of patches, and for a band 2 KB of colours and 4 KB of depths.
#[derive(Debug)]
pub(crate) struct Buffers {
    patches: [BicubicPatch; 32],
    colour: [Gray4; BAND],
    depth: [u16; BAND],
}

impl Buffers {
    pub(crate) const fn new() -> Self {
        Self { patches: [teapot::BLANK; 32], colour: [Gray4::BLACK; BAND], depth: [0; BAND] }
    }
}

/// Why a frame was not drawn.
#[derive(Debug)]
#[allow(dead_code, reason = "hosts print it")]
pub(crate) enum Fault<E> {
    /// A control point left its range.
    Geometry(GeometryError),
    /// A patch that cannot be sampled, or a buffer too small.
    Render(RenderError),
    /// What the display reports.
    Display(E),
}

/// The model turned by so many frames, seen from a little above, its axis in the middle of the screen.
pub(crate) fn map(frame: u32) -> Result<Affine, GeometryError> {
    let spin = Angle::from_degrees((frame % TURN) as i32 * (360 / TURN as i32));
    let turned = View { tilt: Angle::from_degrees(-68), spin }.rotation()?;
    let [x, y] = [AREA.width, AREA.height].map(|side| I32F32::from_bits(i64::from(side) << 31));
    let down = Affine::translation(I32F32::ZERO, I32F32::ZERO, I32F32::from_bits(-6300 << 32));
    down.then(&turned)?.then(&Affine::scaling(SCALE, SCALE, SCALE))?.then(&Affine::translation(x, y, I32F32::ZERO))
}

/// Draws a frame: the control points are mapped, then the picture goes out in four bands of 16 rows.
pub(crate) fn draw<D: DrawTarget<Color = Gray4>>(
    frame: u32,
    buffers: &mut Buffers,
    display: &mut D,
) -> Result<Statistics, Fault<D::Error>> {
    let Buffers { patches, colour, depth } = buffers;
    map(frame).and_then(|map| teapot::map_into(&map, patches)).map_err(Fault::Geometry)?;
    let scene = Scene::new(patches, Light::default(), Style::Shaded).map_err(Fault::Render)?;
    let paint = Material { colour: Gray4::WHITE };
    let mut frame = Frame::new(scene, &paint, Gray4::BLACK, AREA, ROWS).map_err(Fault::Render)?;
    while let Some(band) = frame.next_band(colour, depth).map_err(Fault::Render)? {
        band.draw(display).map_err(Fault::Display)?;
    }
    Ok(frame.statistics())
}
