//! Levels and colours of points that are seen.

use super::depth::DepthWindow;
use super::light::{Light, Side, normal_on};
use super::pen::{Brush, Spot};
use super::style::Style;
use super::tangents::Tangents;
use super::tile::{Fragment, Paint};

/// What the levels of a scene depend on.
#[derive(Clone, Copy, Debug)]
pub(super) struct Shading<'a> {
    pub(super) light: &'a Light,
    pub(super) style: Style,
    pub(super) window: DepthWindow,
}

/// A paint, the number of the patch that it is for, and the colours of a tile.
pub(super) struct Canvas<'c, P: Paint> {
    pub(super) paint: &'c P,
    pub(super) patch: usize,
    pub(super) colour: &'c mut [P::Pixel],
}

impl<P: Paint> Canvas<'_, P> {
    pub(super) fn set(&mut self, spot: &Spot, shade: u8) {
        if let Some(stored) = self.colour.get_mut(spot.index) {
            *stored = self.paint.pixel(Fragment { x: spot.x, y: spot.y, patch: self.patch, shade });
        }
    }
}

/// Colours lines: the highest level everywhere.
impl<P: Paint> Brush for Canvas<'_, P> {
    fn dab(&mut self, spot: Spot, _: Option<Option<[i32; 3]>>) {
        self.set(&spot, u8::MAX);
    }
}

/// Colours the points of a piece.
pub(super) struct Shader<'s, 'c, P: Paint> {
    pub(super) shading: Shading<'s>,
    pub(super) canvas: Canvas<'c, P>,
    /// Which way normals point.
    pub(super) side: Side,
    /// Of the piece with all its bits; of a rational one without its weights.
    pub(super) tangents: Tangents<'s>,
}

impl<P: Paint> Brush for Shader<'_, '_, P> {
    fn dab(&mut self, spot: Spot, known: Option<Option<[i32; 3]>>) {
        let (Shading { light, style, window }, side) = (self.shading, self.side);
        let mut found = || {
            let known = known.unwrap_or_else(|| normal_on(side, self.tangents.at(spot.i, spot.j)));
            known.or_else(|| normal_on(side, self.tangents.inside(spot.i, spot.j))).unwrap_or([0, 0, -1])
        };
        let shade = match style {
            Style::Shaded => light.level(found()),
            Style::Glossy(gloss) => light.glossy(found(), gloss),
            Style::DepthCued { near, far } => window.cue(spot.depth, near, far),
            _ => u8::MAX,
        };
        self.canvas.set(&spot, shade);
    }
}
