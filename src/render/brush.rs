//! Levels and colours of points that are seen.

use super::depth::DepthWindow;
use super::light::{Light, Side, normal_on};
use super::pen::{Brush, Seen, Spot, Stain};
use super::style::Style;
use super::tangents::Tangents;
use super::tile::{Area, Fragment, Paint};

/// What the levels of a scene depend on.
#[derive(Clone, Copy, Debug)]
pub(super) struct Shading<'a> {
    pub(super) light: &'a Light,
    pub(super) style: Style,
    pub(super) window: DepthWindow,
}

impl Shading<'_> {
    /// The level of a point at a depth, with the normal that `normal` finds.
    #[inline(always)]
    pub(super) fn level(&self, depth: u16, normal: impl FnOnce() -> [i32; 3]) -> u8 {
        match self.style {
            Style::Shaded => self.light.level(normal()),
            Style::Glossy(gloss) => self.light.glossy(normal(), gloss),
            Style::DepthCued { near, far } => self.window.cue(depth, near, far),
            _ => u8::MAX,
        }
    }
}

/// A paint, the number of the patch that it is for, and the colours of a tile.
pub(super) struct Canvas<'c, P: Paint> {
    pub(super) paint: &'c P,
    pub(super) patch: usize,
    pub(super) colour: &'c mut [P::Pixel],
}

impl<P: Paint> Stain for Canvas<'_, P> {
    #[inline(always)]
    fn stain(&mut self, index: usize, [x, y]: [i32; 2], shade: u8) {
        if let Some(stored) = self.colour.get_mut(index) {
            *stored = self.paint.pixel(Fragment { x, y, patch: self.patch, shade });
        }
    }

    fn stain_all(&mut self, area: &Area, points: &Seen<'_>) {
        points.each(area, |index, at, shade| self.stain(index, at, shade));
    }
}

/// Colours lines: the highest level everywhere.
pub(super) struct Highest<'c>(pub(super) &'c mut dyn Stain);

impl Brush for Highest<'_> {
    fn dab(&mut self, spot: Spot, _: Option<Option<[i32; 3]>>) {
        self.0.stain(spot.index, [spot.x, spot.y], u8::MAX);
    }
}

/// Colours the points of a piece.
pub(super) struct Shader<'s, 'c> {
    pub(super) shading: Shading<'s>,
    pub(super) stain: &'c mut dyn Stain,
    /// Which way normals point.
    pub(super) side: Side,
    /// Of the piece with all its bits; of a rational one without its weights.
    pub(super) tangents: Tangents<'s>,
}

impl Brush for Shader<'_, '_> {
    fn dab(&mut self, spot: Spot, known: Option<Option<[i32; 3]>>) {
        let side = self.side;
        let shade = self.shading.level(spot.depth, || {
            let known = known.unwrap_or_else(|| normal_on(side, self.tangents.at(spot.i, spot.j)));
            known.or_else(|| normal_on(side, self.tangents.inside(spot.i, spot.j))).unwrap_or([0, 0, -1])
        });
        self.stain.stain(spot.index, [spot.x, spot.y], shade);
    }
}
