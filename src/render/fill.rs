//! Exact points of a patch: its pieces on their way into a tile.

use super::Statistics;
use super::brush::{Shader, Shading};
use super::cubic;
use super::cull::{Facing, facing};
use super::light::Side;
use super::pen::{Ink, Pen, Rows, Stain};
use super::pieces::{Pieces, Wanted, each_piece};
use super::plan::{Plan, each_lattice};
use super::style::Cull;
use super::tangents::Tangents;
use super::tile::Area;
use crate::forward::{Fraction, Kind, PieceSlopes, Sampling};
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
}

/// How a patch is drawn. Scenes hold such functions: what no scene of a program can draw by is not linked.
pub(super) type Draw = for<'a, 'd> fn(&'a mut Drawing<'d>);

/// Draws the pieces of one patch of a type `S` that meet the tile.
#[inline(never)]
pub(super) fn fill<S: Surface>(drawing: &mut Drawing<'_>) {
    let is_wide = is_wide(drawing.net, &drawing.area);
    each_piece::<S>(drawing.net, &mut Filling::<S> { kind: PhantomData, drawing, is_wide });
}

/// Whether control values have pixels in `length` pixels from `start` on.
#[inline(always)]
fn overlaps(values: impl Iterator<Item = i32>, start: i32, length: u32) -> bool {
    let (low, high) = values.fold((i32::MAX, i32::MIN), |(low, high), c| (low.min(c), high.max(c)));
    // Rounded half up; legal coordinates leave room.
    let [low, high] = [low, high].map(|c| (c + (1 << 15)) >> 16);
    high >= start && i64::from(low) < i64::from(start) + i64::from(length)
}

/// Whether the box of a piece has pixels in an area; `is_wide`: it may be beside it.
fn meets(piece: SurfaceNet<'_>, area: &Area, is_wide: bool) -> bool {
    let points = piece.points().iter();
    overlaps(points.clone().map(|p| p.y.to_bits()), area.y, area.height)
        && (!is_wide || overlaps(points.map(|p| p.x.to_bits()), area.x, area.width))
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
    fn cubic(&mut self, net: SurfaceNet<'_>, sampling: Sampling, slopes: &PieceSlopes) {
        let turn = slopes.turn(false, sampling.centres);
        let mut piece = cubic::Piece::blank(net, (sampling.steps.r(), sampling.steps.s()), turn);
        piece.set_up(slopes.steepest(net));
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
    fn wants(&mut self, piece: SurfaceNet<'_>, is_front: bool) -> Wanted {
        if !meets(piece, &self.drawing.area, self.is_wide) {
            return Wanted::No;
        }
        if self.drawing.cull == Cull::None || is_front {
            return Wanted::Front;
        }
        match facing(&piece, self.drawing.inward) {
            Facing::Away => Wanted::No,
            Facing::Viewer => Wanted::Front,
            Facing::Unknown => Wanted::Yes,
        }
    }

    fn piece(&mut self, piece: SurfaceNet<'_>, sampling: Sampling, slopes: &PieceSlopes, room: &mut [Point3]) {
        self.drawing.statistics.pieces += 1;
        if cubic::suits::<S>(&piece) {
            return self.cubic(piece, sampling, slopes);
        }
        // Checked in `new`, so it cannot fail here.
        let _ = each_lattice::<S>(piece, sampling, room, &mut |plan, halvings| self.lattice(piece, plan, halvings));
    }

    fn split(&mut self) {
        self.drawing.statistics.splits += 1;
    }
}
