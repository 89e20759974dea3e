//! Strokes of curves: the lattice's pixels, or a disc dragged along it.

use super::curve::BezierCurve;
use super::mask::{Mask, row_bytes};
use super::tiles::{each_tile, line, moved, runs};
use crate::forward::{PlaneWalk, PlaneWalker};
use crate::num::Word;
use embedded_graphics_core::Drawable;
use embedded_graphics_core::draw_target::DrawTarget;
use embedded_graphics_core::geometry::{Dimensions, Point, Size};
use embedded_graphics_core::pixelcolor::PixelColor;
use embedded_graphics_core::primitives::Rectangle;

/// The widest stroke, in pixels: squares of radii in 1/512 pixel fit 32 bits.
pub const MAX_STROKE_WIDTH: u32 = 255;

/// A curve drawn in one colour.
///
/// * Width 0 draws nothing.
/// * Width 1 draws the pixels of [`BezierCurve::points`].
/// * Widths from 2 to [`MAX_STROKE_WIDTH`], and wider ones as that, draw the pixels whose centres are within half the
///   width of the curve, **up to 1/20 pixel**: all centres within width/2 − 1/20 and none beyond width/2 + 1/20. Ends
///   are round caps, corners round joins. An axis-parallel line is exactly `width` pixels thick: of two centres at
///   half the width the upper or left one is drawn.
///
/// A disc is dragged along the chords of the lattice, in steps so short that less than 0.016 pixels are missed between
/// two discs; the curve is within 0.022 pixels of the chords ([`BezierCurve`]), and a disc within 0.012 of its place:
/// the 1/512 pixels it is rounded to, and the bias that settles ties.
///
/// Only pixels inside the target's bounding box are drawn, and none twice, also where the curve crosses itself: it is
/// drawn in tiles through a mask of `BUFFER` bytes on the stack, a bit a pixel; the default holds 128 × 64 pixels or
/// 25 rows of 320. Runs go out by `fill_solid`, left to right.
///
/// Cost: every tile that the stroke's bounding box has on the target walks the whole curve, at about 140 instructions
/// a step for a cubic in `i64` on a Cortex-M4; each disc near the tile takes an integer square root a row. Stack: the
/// mask and 1.7 KB.
///
/// ```
/// use embedded_graphics::{mock_display::MockDisplay, pixelcolor::BinaryColor, prelude::*};
/// use embedded_surfaces::{graphics::{BezierCurve, Stroke}, patch::CubicCurve};
/// let wave = CubicCurve::from_ints([[1, 9, 0], [9, -14, 0], [9, 24, 0], [17, 1, 0]])?;
/// let mut display = MockDisplay::new();
/// Stroke::new(BezierCurve::new(&wave)?, BinaryColor::On, 2).draw(&mut display)?;
/// display.assert_pattern(&[
///     "                 #",
///     "     ###        ##",
///     "    #####       ##",
///     "   ##  ###      ##",
///     "  ###   ##     ## ",
///     "  ##    ###    ## ",
///     "  ##     ##   ### ",
///     " ##      ###  ##  ",
///     " ##       #####   ",
///     "###        ###    ",
/// ]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Stroke<'a, C, const BUFFER: usize = 1024> {
    /// What is drawn.
    pub curve: BezierCurve<'a>,
    /// The colour of every pixel.
    pub colour: C,
    /// The width in pixels.
    pub width: u32,
}

impl<'a, C> Stroke<'a, C> {
    /// A stroke of this colour and width, with a mask of 1024 bytes, which holds 128 × 64 pixels.
    #[must_use]
    pub const fn new(curve: BezierCurve<'a>, colour: C, width: u32) -> Self {
        Self { curve, colour, width }
    }
}

impl<'a, C, const BUFFER: usize> Stroke<'a, C, BUFFER> {
    /// Fails to compile for an empty mask.
    const LEGAL: () = assert!(BUFFER > 0, "the mask holds no pixel");

    /// A stroke with a mask of your size: `Stroke::<_, 64>::with_buffer(…)`.
    #[must_use]
    pub const fn with_buffer(curve: BezierCurve<'a>, colour: C, width: u32) -> Self {
        let () = Self::LEGAL;
        Self { curve, colour, width }
    }

    /// A rectangle that holds every pixel of the stroke, from the control points; empty for width 0.
    #[must_use]
    pub fn bounding_box(&self) -> Rectangle {
        match Tip::of(self.width) {
            None => Rectangle::new(self.curve.bounding_box().top_left, Size::zero()),
            Some(Tip::Pixel) => self.curve.bounding_box(),
            Some(Tip::Disc { radius, .. }) => self.curve.pixel_box(|low, high| {
                let radius = i64::from(radius);
                // Where `Tip::position` may put the ends.
                let (low, high) = ((low >> 7) - 2, (high >> 7) - 1);
                [(low - radius + i64::from(UNIT) - 1) >> UNIT_BITS, (high + radius) >> UNIT_BITS]
            }),
        }
    }

    /// The stroke with its curve moved by whole pixels. Places beyond ±2^29 stop there.
    #[must_use]
    pub fn translate(&self, by: Point) -> Self
    where
        C: Copy,
    {
        Self { curve: self.curve.translate(by), ..*self }
    }

    /// Moves the curve by whole pixels. Places beyond ±2^29 stop there.
    pub fn translate_mut(&mut self, by: Point) -> &mut Self {
        self.curve.translate_mut(by);
        self
    }
}

impl<C: PixelColor, const BUFFER: usize> Drawable for Stroke<'_, C, BUFFER> {
    type Color = C;
    type Output = ();

    fn draw<D: DrawTarget<Color = C>>(&self, target: &mut D) -> Result<(), D::Error> {
        let () = Self::LEGAL;
        let visible = target.bounding_box().intersection(&self.bounding_box());
        let Some(tip) = Tip::of(self.width).filter(|_| !visible.is_zero_sized()) else { return Ok(()) };
        let buffer = u32::try_from(BUFFER).unwrap_or(u32::MAX);
        let width = visible.size.width.min(buffer.saturating_mul(8));
        let height = BUFFER.checked_div(row_bytes(width)).and_then(|rows| u32::try_from(rows).ok());
        each_tile(visible, Size::new(width, height.unwrap_or(u32::MAX)), |area| {
            let mut bits = [0; BUFFER];
            let mut mask = Mask::new(moved(area, self.curve.offset(), -1).into(), &mut bits);
            paint(&self.curve, tip, &mut mask);
            for row in 0..area.size.height as usize {
                for run in runs(area.size.width as usize, |column, covered| mask.find(row, column, covered)) {
                    target.fill_solid(&line(area, row, &run), self.colour)?;
                }
            }
            Ok(())
        })
    }
}

impl<C, const BUFFER: usize> Dimensions for Stroke<'_, C, BUFFER> {
    fn bounding_box(&self) -> Rectangle {
        self.bounding_box()
    }
}

/// Positions are in 1/512 pixel.
const UNIT_BITS: u32 = 9;
const UNIT: u32 = 1 << UNIT_BITS;

/// What is dragged along the curve.
#[derive(Clone, Copy, Debug)]
enum Tip {
    /// The pixel of the lattice point.
    Pixel,
    /// A disc.
    Disc {
        /// In units, at most 65 280: its square fits 32 bits.
        radius: u32,
        /// Up to 2^finest discs a lattice step, each at most 129·2^(2 − finest) units from the one before along x and
        /// y. With r the radius and g the distance in pixels, the discs' union is at most g²/(8r)·(1 + …) < 0.017
        /// pixels narrower than the dragged disc: g ≤ 0.36, 0.72, 1.44 where r ≥ 1, 4, 16.
        finest: u32,
    },
}

impl Tip {
    fn of(width: u32) -> Option<Self> {
        let radius = width.min(MAX_STROKE_WIDTH) * (UNIT / 2);
        match width {
            0 => None,
            1 => Some(Self::Pixel),
            2..8 => Some(Self::Disc { radius, finest: 2 }),
            8..32 => Some(Self::Disc { radius, finest: 1 }),
            _ => Some(Self::Disc { radius, finest: 0 }),
        }
    }
}

/// A coordinate in units, from its rounded value and the 8 bits below: 1 to 3 units less than exact. It is odd and a
/// radius even, so that no pixel centre of its row or column is at the radius: of two such centres one is drawn.
fn position(whole: i32, below: u32) -> i32 {
    (whole << UNIT_BITS) + 2 * below as i32 - (UNIT / 2) as i32 - 1
}

/// Draws a curve into a mask.
#[inline(never)]
fn paint(curve: &BezierCurve<'_>, tip: Tip, mask: &mut Mask<'_>) {
    let mut brush = Brush { mask, last: None };
    match &mut curve.walk() {
        PlaneWalk::Narrow(walk) => brush.follow(walk, tip),
        PlaneWalk::Wide(walk) => brush.follow(walk, tip),
    }
}

/// A tip on its way along a curve.
#[derive(Debug)]
struct Brush<'m, 'b> {
    mask: &'m mut Mask<'b>,
    last: Option<[i32; 2]>,
}

impl Brush<'_, '_> {
    /// Covers what the tip does on its way.
    ///
    /// Of a disc only what happens near the mask is looked at: what is farther than the radius and a step away, in
    /// whole pixels, cannot reach it.
    fn follow<W: Word>(&mut self, walk: &mut PlaneWalker<W>, tip: Tip) {
        let area = self.mask.area();
        loop {
            let [x, y] = walk.point();
            match tip {
                Tip::Pixel => self.mask.fill(y, x, x),
                Tip::Disc { radius, finest } => {
                    let reach = (radius >> UNIT_BITS) + 3;
                    let near = |c: i32, first: i32, count: u32| {
                        (c.wrapping_sub(first) as u32).wrapping_add(reach) < count + 2 * reach
                    };
                    if near(x, area.x, area.width) && near(y, area.y, area.height) {
                        let [right, down] = walk.below();
                        self.drag([position(x, right), position(y, down)], radius, finest);
                    } else {
                        self.last = None;
                    }
                }
            }
            if !walk.advance() {
                break;
            }
        }
    }

    /// Covers the way of the disc from where it is to `to`.
    #[inline(never)]
    fn drag(&mut self, to: [i32; 2], radius: u32, finest: u32) {
        let Some([x, y]) = self.last.replace(to) else { return self.stamp(to, radius) };
        let (right, down) = (to[0] - x, to[1] - y);
        let length = right.unsigned_abs().max(down.unsigned_abs());
        let closest = 129 << (2 - finest);
        let halvings = (0..finest).find(|halvings| length >> halvings <= closest).unwrap_or(finest);
        if length > 0 {
            for part in 1..=1 << halvings {
                self.stamp([x + ((right * part) >> halvings), y + ((down * part) >> halvings)], radius);
            }
        }
    }

    /// Covers the pixel centres in the disc around (x, y): in row `at` those within √(r² − (y − at)²) of x.
    fn stamp(&mut self, [x, y]: [i32; 2], radius: u32) {
        let (area, r, unit) = (self.mask.area(), radius as i32, UNIT as i32);
        let first = ((y - r + unit - 1) >> UNIT_BITS).max(area.y);
        let last = ((y + r) >> UNIT_BITS).min(area.y + area.height as i32 - 1);
        let apart = x + r < area.x << UNIT_BITS || (x - r) >> UNIT_BITS >= area.x + area.width as i32;
        let mut row = if apart { last + 1 } else { first };
        while row <= last {
            let height = ((row << UNIT_BITS) - y).unsigned_abs();
            let half = radius.wrapping_mul(radius).saturating_sub(height.wrapping_mul(height)).isqrt() as i32;
            self.mask.fill(row, (x - half + unit - 1) >> UNIT_BITS, (x + half) >> UNIT_BITS);
            row += 1;
        }
    }
}
