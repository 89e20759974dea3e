//! Scenes: what is drawn, checked once.

use super::light::Light;
use super::pen::Pen;
use super::tile::{Area, Paint, Tile};
use super::{RenderError, Statistics};
use crate::forward::{
    Budget, Form, Kernel, LatticeError, QuotientWalker, Residual, Sampling, Steps, Visit, Walker, tangent_bits,
};
use crate::geometry::Bounds;
use crate::num::{Coord, I16F16, Word};
use crate::patch::{Surface, SurfaceNet};

/// How patches are drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum Style {
    /// Lambert shading with exact normals, two-sided.
    #[default]
    Shaded,
    /// The same level, 255, everywhere.
    Flat,
}

/// Where z lies in a scene: the depth of z is (z + 1/2 − low)·2^bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct DepthWindow {
    low: i32,
    pub(super) bits: u32,
}

impl DepthWindow {
    /// The window of whole z values low ..= high, with as many bits below the unit as fit 16 in all, at most 8.
    fn of(low: i32, high: i32) -> Self {
        let levels = (high - low).unsigned_abs() + 1;
        Self { low, bits: (16 - (32 - levels.leading_zeros()).min(16)).min(8) }
    }

    /// The depth of a rounded z and the fraction bits below it; never that of an empty pixel.
    #[inline(always)]
    pub(super) fn depth(self, z: i32, fraction: u32) -> u16 {
        let depth = ((z.wrapping_sub(self.low) as u32) << self.bits) | fraction;
        depth.min(u32::from(u16::MAX) - 1) as u16
    }
}

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

    fn meets(&self, area: &Area) -> bool {
        let apart = |axis: usize, start: i32, len: u32| {
            i64::from(self.max[axis]) < i64::from(start)
                || i64::from(self.min[axis]) >= i64::from(start) + i64::from(len)
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
}

impl<S> Clone for Scene<'_, S> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<S> Copy for Scene<'_, S> {}

/// Which walker draws a patch. Order 4 holds cubics, 9 everything.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Width {
    Cubic64,
    Full64,
    Full128,
}

/// One lattice of a patch.
#[derive(Clone, Copy, Debug)]
struct Plan<'a> {
    form: Form<'a>,
    budget: Budget,
    width: Width,
}

impl<'a> Plan<'a> {
    fn of(form: Form<'a>, style: Style) -> Result<Self, LatticeError> {
        let budget = Budget::of(&form)?;
        let points = 32 << (budget.accumulator as u32);
        let bits = if style == Style::Shaded { tangent_bits(&form, &budget).max(points) } else { points };
        let width = match (bits, form.degree()) {
            (..=64, ..4) => Width::Cubic64,
            (..=64, _) => Width::Full64,
            (..=128, _) => Width::Full128,
            _ => {
                let fraction_bits = budget.fraction_bits;
                return Err(LatticeError::Budget { degrees: form.degrees, steps: form.steps, fraction_bits, bits });
            }
        };
        Ok(Self { form, budget, width })
    }
}

/// The hole-free lattices of a patch: one, or a coarser one and its cells' centres where that takes fewer points and
/// no wider accumulator.
fn plans<'a>(net: SurfaceNet<'a>, style: Style) -> Result<(Plan<'a>, Option<Plan<'a>>), LatticeError> {
    let form = |steps: Steps| Form::surface(net, (steps.r(), steps.s()));
    let sampling = Sampling::cheapest(net);
    if sampling.centres {
        let coarse = form(sampling.steps);
        if let (Ok(corners), Ok(centres)) = (Plan::of(coarse, style), Plan::of(coarse.centres(), style))
            && centres.width != Width::Full128
        {
            return Ok((corners, Some(centres)));
        }
    }
    Ok((Plan::of(form(Steps::hole_free(net)), style)?, None))
}

impl<'a, S: Surface> Scene<'a, S> {
    /// Checks every patch.
    ///
    /// # Errors
    /// [`RenderError::Patch`] for the first patch whose hole-free lattice needs more than 128 bits.
    pub fn new(patches: &'a [S], light: Light, style: Style) -> Result<Self, RenderError> {
        let mut all: Option<Bounds> = None;
        for (index, patch) in patches.iter().enumerate() {
            let net = patch.surface();
            plans(net, style).map_err(|error| RenderError::Patch { index, error })?;
            let bounds = net.bounds();
            all = Some(all.map_or(bounds, |b| b.union(&bounds)));
        }
        let pixels = all.map(|b| PixelBox::of(&b));
        let window = pixels.map_or(DepthWindow::of(0, 0), |p| DepthWindow::of(p.min[2], p.max[2]));
        Ok(Self { patches, light, style, window, pixels })
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
        self.pixels.map(|p| Area {
            x: p.min[0],
            y: p.min[1],
            width: p.max[0].abs_diff(p.min[0]) + 1,
            height: p.max[1].abs_diff(p.min[1]) + 1,
        })
    }

    /// Draws the patches that meet the tile, in order; what is nearer than what was there stays.
    ///
    /// Cost: every lattice point of those patches. Stack: 0.6 KB for patches up to degree 3, 2.3 KB above, 4.8 KB
    /// where the lattice needs `i128`.
    pub fn draw<P: Paint>(&self, tile: &mut Tile<'_, P::Pixel>, paint: &P) -> Statistics {
        let mut statistics = Statistics::default();
        for (index, patch) in self.patches.iter().enumerate() {
            let net = patch.surface();
            if !PixelBox::of(&net.bounds()).meets(&tile.area()) {
                continue;
            }
            // Planned in `new`, so it cannot fail here.
            if let Ok((first, second)) = plans(net, self.style) {
                statistics.patches += 1;
                for plan in [Some(first), second].into_iter().flatten() {
                    statistics.points += plan.form.point_count();
                    match self.style {
                        Style::Shaded => self.walk::<P, true>(tile, paint, (index, net), &plan),
                        Style::Flat => self.walk::<P, false>(tile, paint, (index, net), &plan),
                    }
                }
            }
        }
        statistics
    }

    fn walk<P: Paint, const SHADED: bool>(
        &self,
        tile: &mut Tile<'_, P::Pixel>,
        paint: &P,
        patch: (usize, SurfaceNet<'a>),
        plan: &Plan<'a>,
    ) {
        let at = (&plan.form, plan.budget.scale);
        let pen = Pen::<P, SHADED>::new(tile, paint, &self.light, patch, at, self.window);
        match (plan.width, plan.form.weights().is_some()) {
            (Width::Cubic64, false) => run::<_, _, 4>(Residual::<i64>::of(&plan.budget), plan, pen),
            (Width::Full64, false) => run::<_, _, 9>(Residual::<i64>::of(&plan.budget), plan, pen),
            (Width::Full128, false) => run::<_, _, 9>(Residual::<i128>::of(&plan.budget), plan, pen),
            (Width::Cubic64, true) => run_quotient::<i64, _, 4>(plan, pen),
            (_, true) => run_quotient::<i128, _, 9>(plan, pen),
        }
    }
}

/// One walk in a stack frame of its own: only the walker in use takes room.
#[inline(never)]
fn run<K: Kernel, V: Visit, const R: usize>(kernel: K, plan: &Plan<'_>, visitor: V) {
    Walker::<K, R>::new(kernel, &plan.form, &plan.budget).visit(visitor);
}

/// The same for a rational patch.
#[inline(never)]
fn run_quotient<W: Word, V: Visit, const R: usize>(plan: &Plan<'_>, visitor: V) {
    QuotientWalker::<W, R>::new(&plan.form, &plan.budget).visit(visitor);
}
