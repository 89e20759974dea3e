//! The pieces of a patch: split at midpoints while it pays, depth first, without a list of pieces.
//!
//! A piece costs the points of its cheapest hole-free sampling and [`SETUP`]. A tensor-product piece is halved in the
//! direction that promises more, a triangle quartered, if its parts cost less together than it does alone; what does not
//! fit 64 bits is quartered. Nothing but the piece enters the decision, so every band finds the same pieces.

use super::plan::fits;
use crate::forward::{Estimate, Sampling, piece_sampling};
use crate::geometry::Point3;
use crate::num::I16F16;
use crate::patch::{MAX_DEGREE, SurfaceNet};
use crate::subdivide::{Cut, Direction, Half, Quarter, Source, part_net};

/// What setting up a piece costs, in points.
const SETUP: u64 = 16;

/// How often a patch is split at most on the way to a piece.
pub(super) const DEPTH: usize = 8;

/// Slots for nets: one per level, and one for what is only looked at.
const SLOTS: usize = DEPTH + 1;

/// Storage for the pieces of patches of up to `LEN` points.
type Slots<T, const LEN: usize> = [[T; LEN]; SLOTS];

/// What is done with pieces.
pub(super) trait Pieces {
    /// Whether a piece is looked at at all.
    fn wants(&mut self, piece: SurfaceNet<'_>) -> bool;

    /// A piece that is not split any further, and room for as many points as it has.
    fn piece(&mut self, piece: SurfaceNet<'_>, sampling: Sampling, room: &mut [Point3]);

    /// Called when a piece is split.
    fn split(&mut self);
}

/// The bytes of stack that the pieces of a patch with `points` control points take.
pub(super) const fn storage(points: usize, rational: bool) -> usize {
    let room = if points <= 21 {
        21
    } else if points <= 45 {
        45
    } else {
        (MAX_DEGREE + 1) * (MAX_DEGREE + 1)
    };
    SLOTS * room * (size_of::<Point3>() + if rational { size_of::<I16F16>() } else { 0 })
}

/// Walks the pieces of a patch.
pub(super) fn each_piece(net: SurfaceNet<'_>, pieces: &mut dyn Pieces) {
    match (net.points().len(), net.weights().is_some()) {
        (..=21, false) => with_room::<21, 0>(net, pieces),
        (..=21, true) => with_room::<21, 21>(net, pieces),
        (..=45, false) => with_room::<45, 0>(net, pieces),
        (..=45, true) => with_room::<45, 45>(net, pieces),
        (_, false) => with_room::<81, 0>(net, pieces),
        (_, true) => with_room::<81, 81>(net, pieces),
    }
}

#[inline(never)]
fn with_room<const LEN: usize, const WEIGHTS: usize>(net: SurfaceNet<'_>, pieces: &mut dyn Pieces) {
    let mut points: Slots<Point3, LEN> = [[Point3::ORIGIN; LEN]; SLOTS];
    let mut weights: Slots<I16F16, WEIGHTS> = [[I16F16::ONE; WEIGHTS]; SLOTS];
    let (len, sampling) = (net.points().len(), piece_sampling(net, true));
    let weight_len = if WEIGHTS == 0 { 0 } else { len };
    let mut tree = Tree {
        root: net,
        points: points.as_flattened_mut(),
        weights: weights.as_flattened_mut(),
        len,
        weight_len,
        path: [Step { split: Split::R, part: 0, samplings: [sampling; 4] }; DEPTH],
        depth: 0,
        sampling,
    };
    tree.walk(pieces);
}

/// How a piece is split.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Split {
    R,
    S,
    Squares,
    Triangles,
}

impl Split {
    /// Part number `index`; `None` after the last.
    fn part(self, index: usize) -> Option<Cut> {
        let half = |second: bool| if second { Half::Second } else { Half::First };
        match self {
            Self::R | Self::S if index >= 2 => None,
            Self::R => Some(Cut::Half(Direction::R, half(index == 1))),
            Self::S => Some(Cut::Half(Direction::S, half(index == 1))),
            Self::Squares => (index < 4).then(|| Cut::Tensor(half(index >= 2), half(index % 2 == 1))),
            Self::Triangles => Quarter::ALL.get(index).map(|quarter| Cut::Triangle(*quarter)),
        }
    }
}

/// A split on the way to a piece: which part the way takes, and how the parts are sampled.
#[derive(Clone, Copy, Debug)]
struct Step {
    split: Split,
    part: usize,
    samplings: [Sampling; 4],
}

/// The pieces on the way from the patch to the current one; piece k stands in slot k − 1.
struct Tree<'n, 's> {
    root: SurfaceNet<'n>,
    points: &'s mut [Point3],
    weights: &'s mut [I16F16],
    len: usize,
    weight_len: usize,
    path: [Step; DEPTH],
    depth: usize,
    /// How the current piece is sampled.
    sampling: Sampling,
}

impl Tree<'_, '_> {
    fn walk(&mut self, pieces: &mut dyn Pieces) {
        loop {
            let step = self.visit(pieces);
            if let (Some(step), Some(way)) = (step, self.path.get_mut(self.depth)) {
                *way = step;
                self.depth += 1;
                self.enter();
                pieces.split();
            } else if !self.advance() {
                return;
            }
        }
    }

    /// Draws the current piece, or says how it is split.
    fn visit(&mut self, pieces: &mut dyn Pieces) -> Option<Step> {
        let (depth, sampling) = (self.depth, self.sampling);
        let (piece, slot, weight_slot) = self.current();
        if !pieces.wants(piece) {
            return None;
        }
        let step = if depth < DEPTH { best_split(source(piece, depth), sampling, slot, weight_slot) } else { None };
        if step.is_none() {
            pieces.piece(piece, sampling, slot);
        }
        step
    }

    /// The current piece, and the slots after it.
    fn current(&mut self) -> (SurfaceNet<'_>, &mut [Point3], &mut [I16F16]) {
        let (len, weight_len) = (self.len, self.weight_len);
        let (before, after) = self.points.split_at_mut_checked(self.depth * len).unwrap_or_default();
        let (weights_before, weights_after) =
            self.weights.split_at_mut_checked(self.depth * weight_len).unwrap_or_default();
        let piece = match self.depth.checked_sub(1) {
            None => self.root,
            Some(level) => part_net(
                self.root,
                before.get(level * len..).unwrap_or_default(),
                weights_before.get(level * weight_len..).unwrap_or_default(),
            ),
        };
        (piece, after.get_mut(..len).unwrap_or_default(), weights_after.get_mut(..weight_len).unwrap_or_default())
    }

    /// Cuts the current piece from the one above it; whether there is one.
    fn enter(&mut self) -> bool {
        let Some(level) = self.depth.checked_sub(1) else { return false };
        let Some(Step { split, part, samplings }) = self.path.get(level) else { return false };
        let (Some(cut), Some(sampling)) = (split.part(*part), samplings.get(*part)) else { return false };
        self.sampling = *sampling;
        self.depth = level;
        let (parent, slot, weight_slot) = self.current();
        source(parent, level).1.cut(cut, slot, weight_slot);
        self.depth = level + 1;
        true
    }

    /// Goes to the next piece that was not visited; whether there is one.
    fn advance(&mut self) -> bool {
        while let Some(level) = self.depth.checked_sub(1) {
            if let Some(step) = self.path.get_mut(level) {
                step.part += 1;
            }
            if self.enter() {
                return true;
            }
            self.depth = level;
        }
        false
    }
}

/// A piece, and what its parts are cut from.
fn source(piece: SurfaceNet<'_>, depth: usize) -> (SurfaceNet<'_>, Source<'_>) {
    let source = Source::of(piece);
    (piece, if depth == 0 { source.with_long_weights() } else { source })
}

/// The split that pays, if any; looks at the parts in `slot`.
fn best_split(
    (piece, source): (SurfaceNet<'_>, Source<'_>),
    own: Sampling,
    slot: &mut [Point3],
    weights: &mut [I16F16],
) -> Option<Step> {
    let (triangle, rational) = (piece.is_triangle(), piece.weights().is_some());
    let must = !fits(piece, own);
    let limit = if must { u64::MAX } else { own.points(triangle) + SETUP };
    if limit <= 3 * SETUP {
        return None;
    }
    let split = match (triangle, must) {
        (true, _) => Split::Triangles,
        (false, true) => Split::Squares,
        (false, false) if Estimate::of(piece).prefers_s() => Split::S,
        (false, false) => Split::R,
    };
    let mut step = Step { split, part: 0, samplings: [own; 4] };
    let mut sum: u64 = 0;
    for (index, sampling) in step.samplings.iter_mut().enumerate() {
        let Some(part) = split.part(index) else { break };
        source.cut(part, slot, weights);
        let net = part_net(piece, slot, weights);
        *sampling = piece_sampling(net, true);
        sum = sum.saturating_add(sampling.points(triangle) + SETUP);
        // Weights of parts have more bits than those of the patch may have had.
        if sum >= limit || (rational && !fits(net, *sampling)) {
            return None;
        }
    }
    Some(step)
}
