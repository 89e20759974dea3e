//! Exact points of a patch: its pieces on their way into a tile.

use super::Statistics;
use super::brush::{Shader, Shading};
use super::cubic;
use super::cull::{Facing, facing};
use super::light::Side;
use super::notes::Notes;
use super::pen::{Ink, Pen, Rows, Stain};
use super::pieces::{Pieces, Reach, Verdict, Wanted, each_piece};
use super::plan::{Plan, each_lattice};
use super::style::Cull;
use super::tangents::Tangents;
use super::tile::Area;
use crate::forward::{Fraction, Kind, Sampling};
use crate::geometry::Point3;
use crate::patch::{Surface, SurfaceNet};
use core::marker::PhantomData;

/// One patch, where it is drawn and how; for all colour types.
pub(super) struct Drawing<'d> {
    pub(super) net: SurfaceNet<'d>,
    pub(super) shading: Shading<'d>,
    pub(super) cull: Cull,
    /// Whether S_r × S_s points inwards.
    pub(super) inward: bool,
    pub(super) ink: Ink,
    pub(super) area: Area,
    pub(super) depth: &'d mut [u16],
    pub(super) stain: &'d mut dyn Stain,
    pub(super) statistics: &'d mut Statistics,
    /// What the band before found out, where bands of a frame are drawn one after the other.
    pub(super) notes: Option<&'d mut Notes>,
}

/// How a patch is drawn. Scenes hold such functions: what no scene of a program can draw by is not linked.
pub(super) type Draw = for<'a, 'd> fn(&'a mut Drawing<'d>);

/// Draws the pieces of one patch of a type `S` that meet the tile.
#[inline(never)]
pub(super) fn fill<S: Surface>(drawing: &mut Drawing<'_>) {
    let is_wide = is_wide(drawing.net, &drawing.area);
    each_piece::<S>(drawing.net, &mut Filling::<S> { kind: PhantomData, drawing, is_wide });
}

/// The first and the last pixel of control values.
#[inline(always)]
fn span(values: impl Iterator<Item = i32>) -> [i32; 2] {
    let (low, high) = values.fold((i32::MAX, i32::MIN), |(low, high), c| (low.min(c), high.max(c)));
    // Rounded half up; legal coordinates leave room.
    [low, high].map(|c| (c + (1 << 15)) >> 16)
}

/// Where the box of a piece is in an area; `is_wide`: it may be beside it.
fn reach(piece: SurfaceNet<'_>, area: &Area, is_wide: bool) -> Option<Reach> {
    let points = piece.points().iter();
    let end = |start: i32, length: u32| i64::from(start) + i64::from(length);
    let [first, last] = span(points.clone().map(|p| p.y.to_bits()));
    let bottom = end(area.y, area.height);
    if last < area.y || i64::from(first) >= bottom {
        return None;
    }
    if is_wide {
        let [first, last] = span(points.map(|p| p.x.to_bits()));
        if last < area.x || i64::from(first) >= end(area.x, area.width) {
            return None;
        }
    }
    Some(Reach { is_old: first < area.y, goes_on: i64::from(last) >= bottom })
}

/// Whether a patch may have points in columns outside an area.
fn is_wide(net: SurfaceNet<'_>, area: &Area) -> bool {
    let end = i64::from(area.x) + i64::from(area.width);
    net.points().iter().any(|p| {
        let column = (p.x.to_bits() + (1 << 15)) >> 16;
        column <= area.x || i64::from(column) + 1 >= end
    })
}

/// The pieces of one patch on their way into a tile.
struct Filling<'f, 'd, S> {
    kind: PhantomData<S>,
    drawing: &'f mut Drawing<'d>,
    /// Whether the patch may have points in columns outside the tile.
    is_wide: bool,
}

impl<S: Surface> Filling<'_, '_, S> {
    /// Whether all pieces are such that what is done with them fits a note.
    const IS_NOTED: bool = !S::SHAPE.triangles && !S::SHAPE.rational && S::SHAPE.degree <= 3;

    /// Which way normals point; a tensor-product lattice that is turned has its tangents exchanged.
    fn side(&self, is_turned: bool) -> Side {
        match (self.drawing.cull, self.drawing.inward != is_turned) {
            (Cull::None, _) => Side::Viewer,
            (Cull::Back, false) => Side::Along,
            (Cull::Back, true) => Side::Against,
        }
    }

    /// Draws a piece of degree 3 or less.
    #[inline(never)]
    fn cubic(&mut self, net: SurfaceNet<'_>, (sampling, turn, steepest): (Sampling, u8, u32)) {
        let mut piece = cubic::Piece::blank(net, (sampling.steps.r(), sampling.steps.s()), turn);
        piece.set_up::<true>(steepest);
        let side = self.side(turn == 1);
        let mut target = cubic::Target {
            area: self.drawing.area,
            depth: self.drawing.depth,
            shading: self.drawing.shading,
            ink: self.drawing.ink,
            side,
            is_wide: self.is_wide,
            points: &mut self.drawing.statistics.points,
            stain: self.drawing.stain,
        };
        piece.draw(false, &mut target);
        if sampling.centres {
            piece.draw(true, &mut target);
        }
    }

    /// Draws one lattice of a piece.
    fn lattice(&mut self, piece: SurfaceNet<'_>, plan: &Plan<'_>, halvings: u32) {
        let form = &plan.form;
        let side = self.side(form.kind == Kind::Tensor && form.turn() == 1);
        let Drawing { shading, area, depth, ink, stain, statistics, .. } = &mut *self.drawing;
        let window = shading.window.halved(halvings);
        let mut shader = Shader { shading: *shading, stain: &mut **stain, side, tangents: Tangents::new(piece, form) };
        plan.draw::<S>(&mut Pen {
            area: *area,
            depth,
            window,
            fraction: Fraction::of(plan.budget.scale, window.bits),
            ink: *ink,
            side,
            form,
            rows: Rows::in_band(form, (area.y, area.y.saturating_add_unsigned(area.height))),
            points: &mut statistics.points,
            brush: &mut shader,
        });
    }
}

impl<S: Surface> Pieces for Filling<'_, '_, S> {
    fn reach(&mut self, piece: SurfaceNet<'_>) -> Option<Reach> {
        reach(piece, &self.drawing.area, self.is_wide)
    }

    fn recall(&mut self) -> Option<Verdict> {
        if Self::IS_NOTED { self.drawing.notes.as_mut()?.recall() } else { None }
    }

    fn keep(&mut self, verdict: &Verdict) {
        if Self::IS_NOTED
            && let Some(notes) = &mut self.drawing.notes
        {
            notes.keep(verdict);
        }
    }

    fn wants(&mut self, piece: SurfaceNet<'_>) -> Wanted {
        if self.drawing.cull == Cull::None {
            return Wanted::Front;
        }
        match facing(&piece, self.drawing.inward) {
            Facing::Away => Wanted::No,
            Facing::Viewer => Wanted::Front,
            Facing::Unknown => Wanted::Yes,
        }
    }

    fn piece(&mut self, piece: SurfaceNet<'_>, way: (Sampling, u8, u32), room: &mut [Point3]) {
        self.drawing.statistics.pieces += 1;
        if cubic::suits::<S>(&piece) {
            return self.cubic(piece, way);
        }
        // Checked in `new`, so it cannot fail here.
        let _ = each_lattice::<S>(piece, way.0, room, &mut |plan, halvings| self.lattice(piece, plan, halvings));
    }

    fn split(&mut self) {
        self.drawing.statistics.splits += 1;
    }
}
