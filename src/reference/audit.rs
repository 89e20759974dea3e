//! Whole scenes against the oracle: is every pixel that a patch covers hit?

use super::{Coverage, fine_mesh};
use crate::forward::Steps;
use crate::patch::Surface;
use crate::render::{Area, Light, RenderError, Scene, Style, Tile};
use std::vec;
use std::vec::Vec;

/// What the renderer hits of what the surfaces cover, counted patch by patch (so that no patch hides another's
/// holes) and summed.
///
/// ```
/// use embedded_surfaces::patch::BilinearPatch;
/// use embedded_surfaces::reference::Audit;
/// use embedded_surfaces::render::Area;
/// let square = [BilinearPatch::from_ints([[[1, 1, 0], [1, 6, 0]], [[6, 1, 0], [6, 6, 0]]])?];
/// let audit = Audit::of(&square, Area { x: 0, y: 0, width: 8, height: 8 })?;
/// assert_eq!((audit.pixels, audit.covered, audit.missed.len()), (36, 36, 0));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Audit {
    /// Distinct pixels hit by each patch, summed.
    pub pixels: usize,
    /// Pixel centres inside each patch by the `f64` reference, summed.
    pub covered: usize,
    /// Centres inside a patch that it does not hit: the patch's index and the pixel.
    pub missed: Vec<(usize, i32, i32)>,
}

impl Audit {
    /// Draws each patch alone into `area` by the renderer and compares with [`Coverage`] on a mesh at least four
    /// times finer than the lattice.
    ///
    /// # Errors
    /// What [`Scene::new`] and [`Tile::new`] report.
    pub fn of<S: Surface>(patches: &[S], area: Area) -> Result<Self, RenderError> {
        let mut audit = Self::default();
        for index in 0..patches.len() {
            audit.add(patches, index, area)?;
        }
        Ok(audit)
    }

    /// Adds patch `index` of `patches` to the audit: for callers that show progress.
    ///
    /// # Errors
    /// What [`Scene::new`] and [`Tile::new`] report; a patch that is not there adds nothing.
    pub fn add<S: Surface>(&mut self, patches: &[S], index: usize, area: Area) -> Result<(), RenderError> {
        let Some(patch) = patches.get(index) else { return Ok(()) };
        let (mut colour, mut depth) = (vec![(); area.pixels()], vec![0; area.pixels()]);
        let mut tile = Tile::new(area, &mut colour, &mut depth, ())?;
        Scene::new(core::slice::from_ref(patch), Light::default(), Style::Flat)?.draw(&mut tile, &|_| ());
        let steps = Steps::hole_free(patch.surface());
        let mut truth = Coverage::new(area.x, area.y, area.width, area.height);
        truth.add(patch.surface(), fine_mesh((steps.r(), steps.s())));
        self.pixels += (0..area.pixels()).filter(|i| tile.is_covered(*i)).count();
        self.covered += truth.count();
        self.missed.extend(truth.iter().filter(|(x, y)| !tile.covers(*x, *y)).map(|(x, y)| (index, x, y)));
        Ok(())
    }
}

#[cfg(feature = "defmt")]
impl defmt::Format for Audit {
    fn format(&self, f: defmt::Formatter<'_>) {
        let (pixels, covered, missed) = (self.pixels, self.covered, self.missed.len());
        defmt::write!(f, "{} pixels hit, {} of {} centres missed", pixels, missed, covered);
    }
}
