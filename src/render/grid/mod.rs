//! The fast fill: a coarse grid of exact vertices per patch, and facets between them.
//!
//! In comes a scene; out go convex facets of at most 127 pixels a side, filled into a tile at once or listed for a
//! frame. `counts` says how many segments each class of edges takes, `vertices` walks the grid by the difference
//! engine and keeps two rows of it, `cells` makes facets of them, `quad` fills one, `list` keeps them for bands.
//!
//! **No crack.** An edge that two patches share is cut into equally many segments on both sides, and its vertices are
//! ⌊256·S⌋ of the same exact points: equal bits. A pixel centre belongs to the facet in whose half-open spans it lies,
//! and where a span ends depends on the two vertices of the side alone: next to a side that two facets share, each
//! centre is in exactly one.
//!
//! **Bands do not show.** Facets and their order depend on the scene alone; a span, a depth and a level are linear
//! functions of the pixel in integers modulo 2^32.

mod cells;
mod counts;
mod list;
mod quad;
mod vertices;

pub use list::Facet;

pub(super) use counts::Segments;
pub(super) use list::{Facets, Recorder};
pub(super) use quad::{Filler, Quad};

use super::depth::DepthWindow;
use super::plan::Plan;
use super::style::Style;
use super::{Light, Statistics};
use crate::forward::{Form, Fraction, LatticeError};
use crate::patch::SurfaceNet;
use cells::{Cells, Lighting, Side};
use vertices::{Collector, Rows, SEGMENTS};

/// Fraction bits of vertices on the screen.
const FRACTION_BITS: u32 = 8;

/// What takes facets, in the order in which they are drawn.
pub(super) trait Output {
    /// Takes a convex facet.
    fn facet(&mut self, quad: &Quad);

    /// The rows of pixels that are wanted, from the first to before the second, and the columns likewise.
    fn window(&self) -> [i32; 4];
}

/// The grid of a patch at these counts.
pub(super) fn plan<'a>(net: SurfaceNet<'a>, counts: (u32, u32), style: Style) -> Result<Plan<'a>, LatticeError> {
    Plan::of(Form::surface(net, counts), style.needs_normals())
}

/// One patch of a scene.
#[derive(Clone, Copy, Debug)]
pub(super) struct Patch<'a> {
    pub(super) net: SurfaceNet<'a>,
    pub(super) index: usize,
    /// Segments along r and s.
    pub(super) counts: (u32, u32),
    /// Whether S_r × S_s points inwards; `None`: both sides are drawn.
    pub(super) inward: Option<bool>,
}

/// Sends the facets of a patch that meet the output's window to it.
///
/// Stack: two rows of 33 vertices, 1.6 KB, and the walker.
pub(super) fn facets<O: Output>(
    patch: &Patch<'_>,
    (light, style, window): (&Light, Style, DepthWindow),
    output: &mut O,
) -> Statistics {
    // Checked with the scene, so it cannot fail here.
    let Ok(plan) = plan(patch.net, patch.counts, style) else { return Statistics::default() };
    let fraction = Fraction::of(plan.budget.scale, FRACTION_BITS);
    let mut rows = Rows::new();
    let lighting = Lighting { light, style, net: patch.net, form: &plan.form };
    let mut cells = Cells { patch: patch.index, lighting, side: Side::of(patch.inward), output, first: 0, facets: 0 };
    let mut first = 0;
    while first < plan.form.steps.0 {
        let last = (first + SEGMENTS as u32).min(plan.form.steps.0);
        cells.first = first;
        let (rows, sink) = (&mut rows, &mut cells);
        if style.needs_normals() {
            plan.walk(Collector::<true> { rows, sink, style, window, fraction, form: &plan.form, columns: (first, last) });
        } else {
            plan.walk(Collector::<false> { rows, sink, style, window, fraction, form: &plan.form, columns: (first, last) });
        }
        first = last;
    }
    Statistics { vertices: plan.form.point_count(), facets: cells.facets, ..Statistics::default() }
}
