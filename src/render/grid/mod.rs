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
//! Most patches are bicubic: `bicubic` walks those of degree 3 or less in fixed point, with the edges exact and the inside
//! within 1/128 pixel. All others take the point engine.
//!
//! **Bands do not show.** Facets and their order depend on the scene alone; a span, a depth and a level are linear
//! functions of the pixel in integers modulo 2^32.

mod bicubic;
mod cells;
mod counts;
mod joint;
mod list;
mod quad;
mod vertices;

#[cfg(all(test, feature = "std"))]
mod tests;

pub use list::Facet;

pub(super) use counts::Segments;
pub(super) use list::{Facets, Recorder};
pub(super) use quad::{Filler, Quad};
pub(super) use vertices::Rows;

use super::cull::{Facing, facing};
use super::depth::DepthWindow;
use super::plan::Plan;
use super::style::Style;
use super::{Light, Statistics};
use crate::forward::{Form, Fraction, LatticeError};
use crate::geometry::Point3;
use crate::num::I16F16;
use crate::patch::{Surface, SurfaceNet};
use bicubic::Bicubic;
use cells::{Cells, Lighting, Side};
use vertices::{Collector, Kept, SEGMENTS, Vertex};

/// Fraction bits of vertices on the screen.
const FRACTION_BITS: u32 = 8;

/// What takes facets, in the order in which they are drawn.
pub(super) trait Output {
    /// Takes a convex facet.
    fn facet(&mut self, quad: &Quad);

    /// The rows of pixels that are wanted, from the first to before the second, and the columns likewise.
    fn window(&self) -> [i32; 4];
}

/// Checks that the grid of a patch at these counts fits the engine.
pub(super) fn check<S: Surface>(net: SurfaceNet<'_>, counts: (u32, u32)) -> Result<(), LatticeError> {
    if Bicubic::suits::<S>(&net) { Ok(()) } else { Plan::of(Form::surface(net, counts), true).map(drop) }
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

/// Sends the facets of a patch that meet the output's window to it; it may leave the window's columns if
/// `is_beside`, and its rows if `is_above`.
///
/// Stack: 2.8 KB with the caller's, of them 0.8 for `rows`, two of 33 vertices, and 0.8 KB for the walk over a bicubic patch,
/// or 1.1 KB and what the point engine takes.
pub(super) fn facets<S: Surface>(
    patch: &Patch<'_>,
    looks: (&Light, Style, DepthWindow),
    [is_beside, is_above]: [bool; 2],
    output: &mut dyn Output,
    rows: &mut Rows,
) -> Statistics {
    if patch.inward.is_some_and(|inward| may_hide(&patch.net, inward) && facing(&patch.net, inward) == Facing::Away) {
        return Statistics::default();
    }
    if Bicubic::suits::<S>(&patch.net) {
        let mut grid = Bicubic::blank(patch.net, patch.counts);
        grid.set_up();
        let form = grid.form();
        let (form, rows) = ((&form, grid.is_turned(), grid.columns()), (rows, [is_beside, is_above]));
        return strips(patch, looks, form, output, rows, &mut |columns, rows, cells| {
            let (_, style, window) = looks;
            let level = |depth| level_of(style, window, depth);
            let level: Option<&dyn Fn(u16) -> u8> = if style.needs_normals() { None } else { Some(&level) };
            grid.walk(columns, rows, cells, (window, level));
        });
    }
    // Checked with the scene, so it cannot fail here.
    let Ok(plan) = Plan::of(Form::surface(patch.net, patch.counts), true) else { return Statistics::default() };
    let (form, rows) = ((&plan.form, false, plan.form.steps.0), (rows, [is_beside, is_above]));
    strips(patch, looks, form, output, rows, &mut |columns, rows, cells| {
        general(&plan, patch.net, columns, (rows, cells), looks);
    })
}

/// Whether a patch is worth the question whether it faces away: not where its corners face the viewer.
fn may_hide(net: &SurfaceNet<'_>, inward: bool) -> bool {
    let points = net.points();
    let (Some(a), Some([b, .., c, _, _, d])) = (points.first(), points.get(3..16)) else { return true };
    // In whole pixels, modulo 2^32: nothing but speed depends on it.
    let pixels = |c: I16F16| c.to_bits() >> 16;
    let between = |from: &Point3, to: &Point3| [pixels(to.x) - pixels(from.x), pixels(to.y) - pixels(from.y)];
    let (p, q) = (between(a, d), between(c, b));
    let area = p[0].wrapping_mul(q[1]).wrapping_sub(p[1].wrapping_mul(q[0]));
    inward == (area < 0)
}

/// What walks a strip: from its first to its last column.
type Walk<'w> = &'w mut dyn FnMut((u32, u32), &mut Rows, &mut Cells<'_>);

/// Makes the facets of a patch, a strip of columns at a time.
fn strips(
    patch: &Patch<'_>,
    (light, style, _): (&Light, Style, DepthWindow),
    (form, is_turned, last): (&Form<'_>, bool, u32),
    output: &mut dyn Output,
    (rows, [is_beside, is_above]): (&mut Rows, [bool; 2]),
    walk: Walk<'_>,
) -> Statistics {
    // S_s × S_r points the other way.
    let side = Side::of(patch.inward.map(|inward| inward != is_turned));
    let (lighting, window_of) = (Lighting { light, style, form, side }, output.window());
    let is_wide = is_beside && {
        let bounds = patch.net.bounds();
        bounds.min.x.to_bits() >> 16 < window_of[0] || bounds.max.x.to_bits() >> 16 >= window_of[1] - 1
    };
    let quad = Quad { corners: [Vertex::NONE; 4], rows: [0; 2], patch: patch.index, is_wide };
    let (window, is_cut, areas) = (window_of, is_wide || is_above, [[0; 2]; SEGMENTS]);
    let mut cells = Cells { quad, lighting, output, window, first: 0, is_cut, facets: 0, known: 0, areas };
    while cells.first < last {
        let columns = (cells.first, (cells.first + SEGMENTS as u32).min(last));
        walk(columns, rows, &mut cells);
        cells.first = columns.1;
    }
    Statistics { vertices: form.point_count(), facets: cells.facets.into(), ..Statistics::default() }
}

/// The level of a depth in styles that need no normals.
fn level_of(style: Style, window: DepthWindow, depth: u16) -> u8 {
    match style {
        Style::DepthCued { near, far } => window.cue(depth, near, far),
        _ => u8::MAX,
    }
}

/// Walks a strip by the point engine.
#[inline(never)]
fn general(
    plan: &Plan<'_>,
    net: SurfaceNet<'_>,
    columns: (u32, u32),
    (rows, sink): (&mut Rows, &mut Cells<'_>),
    (_, style, window): (&Light, Style, DepthWindow),
) {
    let fraction = Fraction::of(plan.budget.scale, FRACTION_BITS);
    let form = &plan.form;
    let kept = &mut Kept::new(columns.0, net, form);
    plan.walk(Collector { rows, kept, sink, style, window, fraction, form, columns });
}
