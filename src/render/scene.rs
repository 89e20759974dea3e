//! Scenes: what is drawn, checked once.

use super::brush::{Canvas, Shader, Shading};
use super::cubic;
use super::cull::{Facing, facing};
use super::depth::DepthWindow;
use super::grid::{self, Facet, Facets, Filler, Recorder, Segments};
use super::light::{Light, Side};
#[cfg(feature = "styled")]
use super::lines::any_family;
use super::lines::{LineDrawing, families, family};
use super::pen::{Ink, Pen, Rows};
use super::pieces::{Pieces, Wanted, each_piece};
use super::plan::{Plan, check_pieces, each_lattice};
use super::style::{Cull, Fill, Style};
use super::tangents::Tangents;
use super::tile::{Area, Paint, Tile};
use super::{RenderError, Statistics};
use crate::forward::{Fraction, Kind, LatticeError, PieceSlopes, Sampling};
use crate::geometry::{Bounds, Point3};
use crate::num::{Coord, I16F16};
use crate::patch::{Surface, SurfaceNet};
use crate::subdivide::PatchTopology;
use core::marker::PhantomData;

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

/// Whether the box of a piece has pixels in an area.
fn meets(piece: SurfaceNet<'_>, area: &Area) -> bool {
    let (mut x, mut y) = ((i32::MAX, i32::MIN), (i32::MAX, i32::MIN));
    for p in piece.points() {
        x = (x.0.min(p.x.to_bits()), x.1.max(p.x.to_bits()));
        y = (y.0.min(p.y.to_bits()), y.1.max(p.y.to_bits()));
    }
    let overlaps = |(low, high): (i32, i32), start: i32, length: u32| {
        // Rounded half up; legal coordinates leave room.
        let [low, high] = [low, high].map(|c| (c + (1 << 15)) >> 16);
        high >= start && i64::from(low) < i64::from(start) + i64::from(length)
    };
    overlaps(y, area.y, area.height) && overlaps(x, area.x, area.width)
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
    pub fn new(patches: &'a [S], light: Light, style: Style) -> Result<Self, RenderError> {
        let scene = Self::unchecked(patches, light, style);
        scene.check_exact()?;
        Ok(scene)
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
    pub fn grid(
        patches: &'a [S],
        topology: &'a [PatchTopology],
        tolerance: I16F16,
        light: Light,
        style: Style,
    ) -> Result<Self, RenderError> {
        let scene = Self { topology, ..Self::unchecked(patches, light, style) };
        if style.lines().is_some() {
            scene.check_exact()?;
        }
        scene.with_fill(Fill::Grid { tolerance })
    }

    fn check_exact(&self) -> Result<(), RenderError> {
        for (index, patch) in self.patches.iter().enumerate() {
            check::<S>(patch.surface(), self.style).map_err(|error| RenderError::Patch { index, error })?;
        }
        Ok(())
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
        Self { patches, light, style, window, pixels, cull, topology: &[], segments: None }
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
        Ok(Self { topology, segments: None, ..self })
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
        let Fill::Grid { tolerance } = fill else {
            self.check_exact()?;
            return Ok(Self { segments: None, ..self });
        };
        if self.topology.len() != self.patches.len() {
            return Err(RenderError::Topology { patches: self.patches.len(), given: self.topology.len() });
        }
        let segments = Segments::of(self.patches, self.topology, tolerance)?;
        let scene = Self { segments: Some(segments), ..self };
        for index in 0..self.patches.len() {
            if let Some(patch) = scene.grid_patch(index) {
                let fits = grid::check(patch.net, patch.counts);
                fits.map_err(|error| RenderError::Patch { index, error })?;
            }
        }
        Ok(scene)
    }

    /// A patch and its grid; `None` where it is not drawn by one.
    fn grid_patch(&self, index: usize) -> Option<grid::Patch<'a>> {
        let segments = self.segments.filter(|_| self.style.lines().is_none())?;
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
        if self.segments.is_none() || self.style.lines().is_some() {
            return Ok(None);
        }
        let end = |start: i32, length: u32| start.saturating_add_unsigned(length);
        let window = [area.x, end(area.x, area.width), area.y, end(area.y, area.height)];
        let (mut recorder, mut statistics) = (Recorder::new(entries, window), Statistics::default());
        for index in 0..self.patches.len() {
            if let Some(patch) = self.grid_patch(index)
                && PixelBox::of(&patch.net.bounds()).meets(&area, 0)
            {
                statistics.patches += 1;
                statistics += grid::facets(&patch, (&self.light, self.style, self.window), &mut recorder);
            }
        }
        Ok(Some((Facets::of(recorder, links, rows)?, statistics)))
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
        let mut statistics = Statistics::default();
        if self.style.lines() == Some(true) {
            self.each_visible(tile, |tile, patch, net| {
                self.fill(tile, paint, (patch, net), Ink::Occlude, &mut statistics);
            });
        }
        self.each_visible(tile, |tile, patch, net| {
            statistics.patches += 1;
            if self.style.lines().is_some() {
                let mut lines =
                    LineDrawing::<S, P> { kind: PhantomData, tile, paint, patch, net, window: self.window, points: 0 };
                lines.draw(self.style);
                statistics.points += lines.points;
            } else if let Some(patch) = self.grid_patch(patch) {
                statistics += self.fill_facets(tile, paint, &patch);
            } else {
                self.fill(tile, paint, (patch, net), Ink::Fill, &mut statistics);
            }
        });
        statistics
    }

    /// Fills the facets of one patch. Out of line: points and facets need not stand on the stack together.
    #[inline(never)]
    fn fill_facets<P: Paint>(&self, tile: &mut Tile<'_, P::Pixel>, paint: &P, patch: &grid::Patch<'a>) -> Statistics {
        let mut filler = Filler::new(tile, paint);
        grid::facets(patch, (&self.light, self.style, self.window), &mut filler)
    }

    /// Calls `f` for every patch whose box meets the tile.
    fn each_visible<'b, C: Copy>(
        &self,
        tile: &mut Tile<'b, C>,
        mut f: impl FnMut(&mut Tile<'b, C>, usize, SurfaceNet<'a>),
    ) {
        for (index, patch) in self.patches.iter().enumerate() {
            let net = patch.surface();
            if PixelBox::of(&net.bounds()).meets(&tile.area(), self.style.reach()) {
                f(tile, index, net);
            }
        }
    }

    /// Draws the pieces of one patch that meet the tile.
    #[inline(never)]
    fn fill<P: Paint>(
        &self,
        tile: &mut Tile<'_, P::Pixel>,
        paint: &P,
        (patch, net): (usize, SurfaceNet<'a>),
        ink: Ink,
        statistics: &mut Statistics,
    ) {
        let inward = self.topology.get(patch).is_some_and(PatchTopology::is_inward);
        let shading = Shading { light: &self.light, style: self.style, window: self.window };
        each_piece::<S>(
            net,
            &mut Filling::<S, P> {
                kind: PhantomData,
                shading,
                cull: self.cull,
                tile,
                paint,
                patch,
                inward,
                ink,
                statistics,
            },
        );
    }
}

/// The pieces of one patch on their way into a tile.
struct Filling<'s, 'b, 't, S, P: Paint> {
    kind: PhantomData<S>,
    shading: Shading<'s>,
    cull: Cull,
    tile: &'t mut Tile<'b, P::Pixel>,
    paint: &'s P,
    patch: usize,
    inward: bool,
    ink: Ink,
    statistics: &'t mut Statistics,
}

impl<S: Surface, P: Paint> Filling<'_, '_, '_, S, P> {
    /// Which way normals point; a tensor-product lattice that is turned has its tangents exchanged.
    fn side(&self, is_turned: bool) -> Side {
        match (self.cull, self.inward != is_turned) {
            (Cull::None, _) => Side::Viewer,
            (Cull::Back, false) => Side::Along,
            (Cull::Back, true) => Side::Against,
        }
    }

    /// Draws a piece of degree 3 or less.
    #[inline(never)]
    fn cubic(&mut self, net: SurfaceNet<'_>, sampling: Sampling, slopes: &PieceSlopes) {
        let turn = slopes.turn(false, sampling.centres);
        let piece = cubic::Piece::new(net, sampling, turn, slopes.steepest(net));
        let side = self.side(turn == 1);
        let (area, colour, depth) = self.tile.parts();
        let mut target = cubic::Target {
            area,
            depth,
            shading: self.shading,
            ink: self.ink,
            side,
            points: &mut self.statistics.points,
            stain: &mut Canvas { paint: self.paint, patch: self.patch, colour },
        };
        piece.draw(false, &mut target);
        if sampling.centres {
            piece.draw(true, &mut target);
        }
    }

    /// Draws one lattice of a piece.
    fn lattice(&mut self, piece: SurfaceNet<'_>, plan: &Plan<'_>, halvings: u32) {
        let (form, window) = (&plan.form, self.shading.window.halved(halvings));
        let side = self.side(form.kind == Kind::Tensor && form.turn() == 1);
        let (area, colour, depth) = self.tile.parts();
        let mut shader = Shader {
            shading: self.shading,
            canvas: Canvas { paint: self.paint, patch: self.patch, colour },
            side,
            tangents: Tangents::new(piece, form),
        };
        plan.draw::<S>(&mut Pen {
            area,
            depth,
            window,
            fraction: Fraction::of(plan.budget.scale, window.bits),
            ink: self.ink,
            side,
            form,
            rows: Rows::in_band(form, (area.y, area.y.saturating_add_unsigned(area.height))),
            points: &mut self.statistics.points,
            brush: &mut shader,
        });
    }
}

impl<S: Surface, P: Paint> Pieces for Filling<'_, '_, '_, S, P> {
    fn wants(&mut self, piece: SurfaceNet<'_>, is_front: bool) -> Wanted {
        if !meets(piece, &self.tile.area()) {
            return Wanted::No;
        }
        if self.cull == Cull::None || is_front {
            return Wanted::Front;
        }
        match facing(&piece, self.inward) {
            Facing::Away => Wanted::No,
            Facing::Viewer => Wanted::Front,
            Facing::Unknown => Wanted::Yes,
        }
    }

    fn piece(&mut self, piece: SurfaceNet<'_>, sampling: Sampling, slopes: &PieceSlopes, room: &mut [Point3]) {
        self.statistics.pieces += 1;
        if cubic::suits::<S>(&piece) {
            return self.cubic(piece, sampling, slopes);
        }
        // Checked in `new`, so it cannot fail here.
        let _ = each_lattice::<S>(piece, sampling, room, &mut |plan, halvings| self.lattice(piece, plan, halvings));
    }

    fn split(&mut self) {
        self.statistics.splits += 1;
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

/// Every lattice that the style will need fits the engine.
fn check<S: Surface>(net: SurfaceNet<'_>, style: Style) -> Result<(), LatticeError> {
    if style.lines() != Some(false) {
        check_pieces::<S>(net, style.needs_normals())?;
    }
    if let Style::Wire(lines) = style {
        for turn in 0..families(net) {
            family(net, lines, turn)?;
        }
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
