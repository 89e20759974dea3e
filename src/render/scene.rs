//! Scenes: what is drawn, checked once.

use super::brush::{Canvas, Shading};
use super::depth::DepthWindow;
use super::fill::{Draw, Drawing, fill as fill_exact};
use super::grid::{self, Facet, Facets, Filler, Output, Recorder, Segments};
use super::light::Light;
#[cfg(feature = "styled")]
use super::lines::any_family;
use super::lines::{draw_lines, families, family};
use super::notes::Notes;
use super::pen::Ink;
use super::plan::check_pieces;
use super::style::{Cull, Fill, Style};
use super::tile::{Area, Paint, Tile};
use super::{RenderError, Statistics};
use crate::forward::LatticeError;
use crate::geometry::Bounds;
use crate::num::{Coord, I16F16};
use crate::patch::{Surface, SurfaceNet};
use crate::subdivide::PatchTopology;

/// Rounded coordinates of a box: what pixels its points can fall on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct PixelBox {
    min: [i32; 3],
    max: [i32; 3],
}

impl PixelBox {
    fn of(bounds: &Bounds) -> Self {
        let round = |c: I16F16| ((c.bits() + (1 << 15)) >> 16) as i32;
        Self { min: bounds.min.to_array().map(round), max: bounds.max.to_array().map(round) }
    }

    /// Whether points may be in columns, and in rows, that are not of the area or next to its ends.
    fn may_leave(&self, area: &Area) -> [bool; 2] {
        let leaves = |axis: usize, start: i32, len: u32| {
            self.min[axis] <= start || i64::from(self.max[axis]) + 2 >= i64::from(start) + i64::from(len)
        };
        [leaves(0, area.x, area.width), leaves(1, area.y, area.height)]
    }

    /// Whether a pixel of the area is at most `reach` from the box.
    fn meets(&self, area: &Area, reach: u8) -> bool {
        let reach = i64::from(reach);
        let apart = |axis: usize, start: i32, len: u32| {
            i64::from(self.max[axis]) + reach < i64::from(start)
                || i64::from(self.min[axis]) - reach >= i64::from(start) + i64::from(len)
        };
        !apart(0, area.x, area.width) && !apart(1, area.y, area.height)
    }
}

/// Patches in screen coordinates, a light and a style; checked once, so that drawing cannot fail.
///
/// ```
/// use embedded_surfaces::patch::BilinearPatch;
/// use embedded_surfaces::render::{Area, Light, Scene, Style, Tile};
/// let square = [BilinearPatch::from_ints([[[1, 1, 0], [1, 6, 0]], [[6, 1, 0], [6, 6, 0]]])?];
/// let scene = Scene::new(&square, Light::default(), Style::Flat)?;
/// let (mut colour, mut depth) = ([b' '; 64], [0; 64]);
/// let mut tile = Tile::new(Area { x: 0, y: 0, width: 8, height: 8 }, &mut colour, &mut depth, b'.')?;
/// scene.draw(&mut tile, &|_| b'#');
/// assert_eq!(&tile.pixels()[..24], b".........######..######.");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct Scene<'a, S> {
    patches: &'a [S],
    light: Light,
    style: Style,
    window: DepthWindow,
    pixels: Option<PixelBox>,
    cull: Cull,
    topology: &'a [PatchTopology],
    segments: Option<Segments>,
    /// What draws exact points and lines, in scenes that may have them.
    fill: Option<Draw>,
    lines: Option<Draw>,
}

impl<S> Clone for Scene<'_, S> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<S> Copy for Scene<'_, S> {}

impl<'a, S: Surface> Scene<'a, S> {
    /// Checks every patch.
    ///
    /// # Errors
    /// [`RenderError::Patch`] for the first patch whose hole-free lattice needs more than 128 bits.
    #[inline(always)]
    pub fn new(patches: &'a [S], light: Light, style: Style) -> Result<Self, RenderError> {
        // Inlined: where the style is a constant, what it does not draw by is not linked.
        let scene = Self { fill: Some(fill_exact::<S>), ..Self::unchecked(patches, light, style) };
        scene.check_fill()?;
        if style.lines().is_some() { scene.with_lines() } else { Ok(scene) }
    }

    /// A scene filled by facets from the start: what [`new`](Self::new), [`with_topology`](Self::with_topology) and
    /// [`with_fill`](Self::with_fill) make in turn, without checking that exact points would fit the engine. That check
    /// costs more than a frame of facets.
    ///
    /// ```
    /// use embedded_surfaces::num::I16F16;
    /// use embedded_surfaces::patch::BilinearPatch;
    /// use embedded_surfaces::render::{Light, Scene, Style};
    /// use embedded_surfaces::subdivide::{PatchTopology, topology};
    /// let square = [BilinearPatch::from_ints([[[1, 1, 0], [1, 6, 0]], [[6, 1, 0], [6, 6, 0]]])?];
    /// let mut edges = [PatchTopology::default()];
    /// topology(&square, &mut edges)?;
    /// let scene = Scene::grid(&square, &edges, I16F16::ONE, Light::default(), Style::Shaded)?;
    /// # let _ = scene;
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// Those of [`with_topology`](Self::with_topology) and [`with_fill`](Self::with_fill), and for a style of lines
    /// those of [`new`](Self::new).
    #[inline(always)]
    pub fn grid(
        patches: &'a [S],
        topology: &'a [PatchTopology],
        tolerance: I16F16,
        light: Light,
        style: Style,
    ) -> Result<Self, RenderError> {
        let scene = Self { topology, ..Self::unchecked(patches, light, style) };
        if style.lines().is_some() {
            scene.check_fill()?;
            return Self { fill: Some(fill_exact::<S>), ..scene }.with_lines()?.with_segments(tolerance);
        }
        scene.with_segments(tolerance)
    }

    /// Every patch can be drawn by exact points, if the style needs that.
    fn check_fill(&self) -> Result<(), RenderError> {
        if self.style.lines() == Some(false) {
            return Ok(());
        }
        self.each_patch(|net| check_pieces::<S>(net, self.style.needs_normals()))
    }

    /// The same scene with its lines, checked.
    #[inline(never)]
    fn with_lines(self) -> Result<Self, RenderError> {
        if let Style::Wire(lines) = self.style {
            self.each_patch(|net| (0..families(net)).try_for_each(|turn| family(net, lines, turn).map(drop)))?;
        }
        Ok(Self { lines: Some(draw_lines::<S>), ..self })
    }

    fn each_patch(&self, check: impl Fn(SurfaceNet<'a>) -> Result<(), LatticeError>) -> Result<(), RenderError> {
        self.patches
            .iter()
            .enumerate()
            .try_for_each(|(index, patch)| check(patch.surface()).map_err(|error| RenderError::Patch { index, error }))
    }

    fn unchecked(patches: &'a [S], light: Light, style: Style) -> Self {
        let mut all: Option<Bounds> = None;
        for patch in patches {
            let bounds = patch.surface().bounds();
            all = Some(all.map_or(bounds, |b| b.union(&bounds)));
        }
        let pixels = all.map(|b| PixelBox::of(&b));
        let window = pixels.map_or(DepthWindow::of(0, 0), |p| DepthWindow::of(p.min[2], p.max[2]));
        let cull = Cull::None;
        Self { patches, light, style, window, pixels, cull, topology: &[], segments: None, fill: None, lines: None }
    }

    /// The same scene with these faces drawn. Culling takes part in filling and in hiding lines; lines themselves are
    /// drawn on either side.
    #[must_use]
    pub const fn with_cull(self, cull: Cull) -> Self {
        Self { cull, ..self }
    }

    /// The same scene with what is known of how its patches meet: one entry for each of
    /// [`subdivide::topology`](crate::subdivide::topology), found once in model space. It is filled by exact points; choose
    /// a grid afterwards.
    ///
    /// # Errors
    /// [`RenderError::Topology`] for another number of entries.
    pub fn with_topology(self, topology: &'a [PatchTopology]) -> Result<Self, RenderError> {
        if topology.len() != self.patches.len() {
            return Err(RenderError::Topology { patches: self.patches.len(), given: topology.len() });
        }
        Ok(Self { topology, segments: None, fill: Some(fill_exact::<S>), ..self })
    }

    /// The same scene, filled by points or by facets. Styles of lines ignore it.
    ///
    /// Cost of [`Fill::Grid`]: the segment counts, one pass over the second differences of every net.
    ///
    /// # Errors
    /// [`RenderError::Topology`] for a grid without [`with_topology`](Self::with_topology), [`RenderError::Tolerance`]
    /// for a tolerance that is not positive, [`RenderError::Segments`] and [`RenderError::Patch`] for a patch whose
    /// grid has more than 1024 segments in a direction or does not fit the engine.
    pub fn with_fill(self, fill: Fill) -> Result<Self, RenderError> {
        match fill {
            Fill::Exact => {
                self.check_fill()?;
                Ok(Self { segments: None, fill: Some(fill_exact::<S>), ..self })
            }
            Fill::Grid { tolerance } => self.with_segments(tolerance),
        }
    }

    fn with_segments(self, tolerance: I16F16) -> Result<Self, RenderError> {
        if self.topology.len() != self.patches.len() {
            return Err(RenderError::Topology { patches: self.patches.len(), given: self.topology.len() });
        }
        let segments = Segments::of(self.patches, self.topology, tolerance)?;
        let scene = Self { segments: Some(segments), ..self };
        for index in 0..self.patches.len() {
            if let Some(patch) = scene.grid_patch(index) {
                let fits = grid::check::<S>(patch.net, patch.counts);
                fits.map_err(|error| RenderError::Patch { index, error })?;
            }
        }
        Ok(scene)
    }

    /// A patch and its grid; `None` where it is not drawn by one.
    fn grid_patch(&self, index: usize) -> Option<grid::Patch<'a>> {
        let segments = self.segments.as_ref().filter(|_| self.style.lines().is_none())?;
        let (patch, topology) = (self.patches.get(index)?, self.topology.get(index)?);
        let net = patch.surface();
        let (r, s) = segments.counts(net, topology);
        let inward = (self.cull == Cull::Back).then(|| topology.is_inward());
        Some(grid::Patch { net, index, counts: (r.into(), s.into()), inward })
    }

    /// The list of the facets in an area, for bands of `rows` rows; `None` where there are none in this style.
    pub(super) fn facets<'b>(
        &self,
        area: Area,
        rows: u32,
        entries: &'b mut [Facet],
        links: &'b mut [u16],
    ) -> Result<Option<(Facets<'b>, Statistics)>, RenderError> {
        if !self.has_facets() {
            return Ok(None);
        }
        let end = |start: i32, length: u32| start.saturating_add_unsigned(length);
        let window = [area.x, end(area.x, area.width), area.y, end(area.y, area.height)];
        let mut recorder = Recorder::new(entries, window);
        let statistics = self.each_facet(&area, &mut recorder);
        Ok(Some((Facets::of(recorder, links, rows)?, statistics)))
    }

    /// Whether it is drawn by facets.
    fn has_facets(&self) -> bool {
        self.segments.is_some() && self.style.lines().is_none()
    }

    /// Sends the facets of the patches that meet an area to an output.
    #[inline(never)]
    fn each_facet(&self, area: &Area, output: &mut dyn Output) -> Statistics {
        let (mut rows, mut statistics) = (grid::Rows::new(), Statistics::default());
        let [is_beside, is_above] = self.pixels.map_or([true; 2], |all| all.may_leave(area));
        for index in 0..self.patches.len() {
            if let Some(patch) = self.grid_patch(index)
                && (!(is_beside || is_above) || PixelBox::of(&patch.net.bounds()).meets(area, 0))
            {
                statistics.patches += 1;
                let looks = (&self.light, self.style, self.window);
                statistics += grid::facets::<S>(&patch, looks, [is_beside, is_above], output, &mut rows);
            }
        }
        statistics
    }

    /// The patches.
    #[must_use]
    pub const fn patches(&self) -> &'a [S] {
        self.patches
    }

    /// The smallest rectangle that holds every pixel a point can fall on, from the control points; `None` for no
    /// patches.
    #[must_use]
    pub fn area(&self) -> Option<Area> {
        let reach = i32::from(self.style.reach());
        self.pixels.map(|p| Area {
            x: p.min[0] - reach,
            y: p.min[1] - reach,
            width: p.max[0].abs_diff(p.min[0]) + 1 + 2 * reach.unsigned_abs(),
            height: p.max[1].abs_diff(p.min[1]) + 1 + 2 * reach.unsigned_abs(),
        })
    }

    /// Draws the patches that meet the tile, in order; what is nearer than what was there stays.
    ///
    /// Cost: the points of the pieces that meet the tile, or the facets of the grid. Stack:
    /// [`stack_bytes`](super::stack_bytes) of the largest patch.
    pub fn draw<P: Paint>(&self, tile: &mut Tile<'_, P::Pixel>, paint: &P) -> Statistics {
        self.draw_noted(tile, paint, None)
    }

    /// The same for the next band of a frame, with its notes.
    #[inline(always)]
    pub(super) fn draw_noted<P: Paint>(
        &self,
        tile: &mut Tile<'_, P::Pixel>,
        paint: &P,
        mut notes: Option<&mut Notes>,
    ) -> Statistics {
        // One result in its place, whatever the fill: a second one would stand on the stack below the drawing.
        let mut statistics = Statistics::default();
        if self.has_facets() {
            self.fill_facets(tile, paint, &mut statistics);
            return statistics;
        }
        if self.style.lines() == Some(true) {
            self.each_visible(tile, |tile, patch| {
                self.trace(self.fill, tile, paint, patch, Ink::Occlude, (&mut statistics, notes.as_deref_mut()));
            });
        }
        self.each_visible(tile, |tile, index| {
            statistics.patches += 1;
            if self.style.lines().is_some() {
                self.trace(self.lines, tile, paint, index, Ink::Fill, (&mut statistics, None));
            } else {
                self.trace(self.fill, tile, paint, index, Ink::Fill, (&mut statistics, notes.as_deref_mut()));
            }
        });
        statistics
    }

    /// Fills the facets. Out of line: points and facets need not stand on the stack together.
    #[inline(never)]
    fn fill_facets<P: Paint>(&self, tile: &mut Tile<'_, P::Pixel>, paint: &P, statistics: &mut Statistics) {
        let area = tile.area();
        *statistics += self.each_facet(&area, &mut Filler::new(tile, paint));
    }

    /// Calls `f` for every patch whose box meets the tile.
    fn each_visible<'b, C: Copy>(&self, tile: &mut Tile<'b, C>, mut f: impl FnMut(&mut Tile<'b, C>, usize)) {
        for (index, patch) in self.patches.iter().enumerate() {
            if PixelBox::of(&patch.surface().bounds()).meets(&tile.area(), self.style.reach()) {
                f(tile, index);
            }
        }
    }

    /// Draws one patch by exact points, or its lines.
    #[inline(never)]
    fn trace<P: Paint>(
        &self,
        draw: Option<Draw>,
        tile: &mut Tile<'_, P::Pixel>,
        paint: &P,
        patch: usize,
        ink: Ink,
        (statistics, notes): (&mut Statistics, Option<&mut Notes>),
    ) {
        let (Some(draw), Some(surface)) = (draw, self.patches.get(patch)) else { return };
        let (area, colour, depth) = tile.parts();
        draw(&mut Drawing {
            net: surface.surface(),
            shading: Shading { light: &self.light, style: self.style, window: self.window },
            cull: self.cull,
            inward: self.topology.get(patch).is_some_and(PatchTopology::is_inward),
            ink,
            area,
            depth,
            stain: &mut Canvas { paint, patch, colour },
            statistics,
            notes,
        });
    }
}

/// Checks that patches can be drawn in every style: a later [`Scene::new`] with any of them succeeds.
#[cfg(feature = "styled")]
pub(crate) fn fits_every_style<S: Surface>(patches: &[S]) -> Result<(), RenderError> {
    for (index, patch) in patches.iter().enumerate() {
        let net = patch.surface();
        let fits = check_pieces::<S>(net, true).and_then(|()| any_family(net));
        fits.map_err(|error| RenderError::Patch { index, error })?;
    }
    Ok(())
}

#[cfg(feature = "defmt")]
impl<S> defmt::Format for Scene<'_, S> {
    fn format(&self, f: defmt::Formatter<'_>) {
        let (patches, style, cull) = (self.patches.len(), self.style, self.cull);
        defmt::write!(f, "scene of {} patches, {}, cull {}, {}", patches, style, cull, self.light);
    }
}
