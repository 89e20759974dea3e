//! Whole scenes against the oracle: is every pixel that a patch covers hit?

use super::{Coverage, fine_mesh};
use crate::forward::Steps;
use crate::num::I16F16;
use crate::patch::{Surface, SurfaceNet};
use crate::render::{Area, Cull, Light, RenderError, Scene, Style, Tile};
use crate::subdivide::{PatchTopology, topology};
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
        let scene = Scene::new(core::slice::from_ref(patch), Light::default(), Style::Flat)?;
        self.compare(index, patch, (scene, area), |truth, net, mesh| truth.add(net, mesh))
    }

    /// Draws each patch alone with [`Cull::Back`] and compares with the centres covered by what faces the viewer.
    ///
    /// # Errors
    /// What [`Scene::new`], [`Scene::with_topology`] and [`Tile::new`] report.
    pub fn of_front<S: Surface>(patches: &[S], topology: &[PatchTopology], area: Area) -> Result<Self, RenderError> {
        let mut audit = Self::default();
        for (index, (patch, topology)) in patches.iter().zip(topology).enumerate() {
            let scene = Scene::new(core::slice::from_ref(patch), Light::default(), Style::Flat)?
                .with_topology(core::slice::from_ref(topology))?
                .with_cull(Cull::Back);
            audit.compare(index, patch, (scene, area), |truth, net, mesh| {
                truth.add_front(net, mesh, topology.is_inward());
            })?;
        }
        Ok(audit)
    }

    /// Draws a scene of one patch and counts what it hits of what `cover` says.
    fn compare<S: Surface>(
        &mut self,
        index: usize,
        patch: &S,
        (scene, area): (Scene<'_, S>, Area),
        cover: impl FnOnce(&mut Coverage, SurfaceNet<'_>, (u32, u32)),
    ) -> Result<(), RenderError> {
        let (mut colour, mut depth) = (vec![(); area.pixels()], vec![0; area.pixels()]);
        let mut tile = Tile::new(area, &mut colour, &mut depth, ())?;
        scene.draw(&mut tile, &|_| ());
        let net = patch.surface();
        let steps = Steps::hole_free(net);
        let mut truth = Coverage::new(area.x, area.y, area.width, area.height);
        cover(&mut truth, net, fine_mesh((steps.r(), steps.s())));
        self.pixels += (0..area.pixels()).filter(|i| tile.is_covered(*i)).count();
        self.covered += truth.count();
        self.missed.extend(truth.iter().filter(|(x, y)| !tile.covers(*x, *y)).map(|(x, y)| (index, x, y)));
        Ok(())
    }

    /// The same for facets at this tolerance, each patch with a grid of its own. Facets promise nothing next to borders
    /// and silhouettes: of what is not hit, only centres count that are farther from every centre outside the patch than
    /// the tolerance and a pixel.
    ///
    /// # Errors
    /// What [`Scene::grid`] and [`Tile::new`] report.
    pub fn of_grid<S: Surface>(patches: &[S], tolerance: I16F16, area: Area) -> Result<Self, RenderError> {
        let mut audit = Self::default();
        for (index, patch) in patches.iter().enumerate() {
            let (mut colour, mut depth) = (vec![(); area.pixels()], vec![0; area.pixels()]);
            let mut tile = Tile::new(area, &mut colour, &mut depth, ())?;
            let (patch, mut edges) = (core::slice::from_ref(patch), [PatchTopology::default()]);
            // One patch has room; if it had one side only, it would have no classes but its own edges.
            let _ = topology(patch, &mut edges);
            Scene::grid(patch, &edges, tolerance, Light::default(), Style::Flat)?.draw(&mut tile, &|_| ());
            let net = patch[0].surface();
            let steps = Steps::hole_free(net);
            let mut truth = Coverage::new(area.x, area.y, area.width, area.height);
            truth.add(net, fine_mesh((steps.r(), steps.s())));
            audit.pixels += (0..area.pixels()).filter(|i| tile.is_covered(*i)).count();
            audit.covered += truth.count();
            let reach = tolerance.to_num::<f64>() + 1.0;
            let missed = truth.iter().filter(|(x, y)| !tile.covers(*x, *y) && is_inside(&truth, (*x, *y), reach));
            audit.missed.extend(missed.map(|(x, y)| (index, x, y)));
        }
        Ok(audit)
    }
}

/// Whether every centre within `reach` pixels is in the set.
fn is_inside(set: &Coverage, (x, y): (i32, i32), reach: f64) -> bool {
    let far = reach as i32;
    (-far..=far)
        .all(|dy| (-far..=far).all(|dx| f64::from(dx).hypot(f64::from(dy)) > reach || set.contains(x + dx, y + dy)))
}

#[cfg(feature = "defmt")]
impl defmt::Format for Audit {
    fn format(&self, f: defmt::Formatter<'_>) {
        let (pixels, covered, missed) = (self.pixels, self.covered, self.missed.len());
        defmt::write!(f, "{} pixels hit, {} of {} centres missed", pixels, missed, covered);
    }
}
