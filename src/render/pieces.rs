//! The pieces of a patch: split at midpoints while it pays, depth first, without a list of pieces.
//!
//! A tensor-product piece of more than [`LARGEST`] points is halved in the direction of more steps. A triangle or a
//! rational piece is split (a triangle into quarters) if its parts cost less together than it does alone, where a piece
//! costs the points of its cheapest hole-free sampling and [`SETUP`]. What does not fit 64 bits is quartered. Nothing but
//! the piece enters the decision, so every band finds the same pieces.

use super::plan::fits;
use crate::forward::{Estimate, PieceSlopes, Sampling};
use crate::geometry::Point3;
use crate::num::I16F16;
use crate::patch::{MAX_DEGREE, Surface, SurfaceNet};
use crate::subdivide::{Cut, Direction, Half, Quarter, Source, are_near, part_net};

/// The most points of a polynomial tensor-product piece: with more, points are wasted where a piece is short; with fewer,
/// setting up pieces costs more than the points that it saves.
const LARGEST: u64 = 370;

/// What setting up another piece counts for, in points.
const SETUP: u64 = 24;

/// How often a patch is split at most on the way to a piece.
const DEPTH: usize = 8;

/// The room for nets of a class of patches: points of the largest, and how often they are split at most.
const fn room(points: usize) -> (usize, usize) {
    match points {
        0..=16 => (16, 6),
        17..=21 => (21, 6),
        22..=45 => (45, 8),
        _ => ((MAX_DEGREE + 1) * (MAX_DEGREE + 1), 8),
    }
}

/// How often a patch with so many control points is split at most.
pub(super) const fn depth(points: usize) -> usize {
    room(points).1
}

/// What is known of a piece.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Wanted {
    No,
    /// Its parts are to be asked for.
    Yes,
    /// It faces the viewer everywhere, and so do its parts.
    Front,
}

/// What is done with a piece.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Way {
    /// It is not looked at, nor are its parts.
    Leave,
    Split(Split),
    /// By this lattice, of which a polynomial tensor product of degree 3 or less is turned so; the steepest derivative of
    /// that is at most so many 2^-9.
    Draw {
        sampling: Sampling,
        turn: u8,
        steepest: u32,
    },
}

/// What is done with a piece, and whether it faces the viewer everywhere, as far as is known.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Verdict {
    pub(super) way: Way,
    pub(super) is_front: bool,
}

impl Verdict {
    /// How much steeper than this a piece is makes a difference, and not how much less.
    pub(super) const SLOW: u32 = 1 << 16;
}

/// Where a piece is that is met by a band.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Reach {
    /// Whether it was met by the band before.
    pub(super) is_old: bool,
    /// Whether the next one meets it.
    pub(super) goes_on: bool,
}

/// What is done with pieces.
pub(super) trait Pieces {
    /// Where a piece is; `None` where it is not met.
    fn reach(&mut self, piece: SurfaceNet<'_>) -> Option<Reach>;

    /// What the notes of a frame say of the next piece that is old.
    fn recall(&mut self) -> Option<Verdict>;

    /// Notes what is done with the next piece that goes on.
    fn keep(&mut self, verdict: &Verdict);

    /// Whether a piece is looked at at all.
    fn wants(&mut self, piece: SurfaceNet<'_>) -> Wanted;

    /// A piece that is not split any further, [a way to draw it](Way::Draw), and room for as many points as it has.
    fn piece(&mut self, piece: SurfaceNet<'_>, way: (Sampling, u8, u32), room: &mut [Point3]);

    /// Called when a piece is split.
    fn split(&mut self);
}

/// The bytes of stack that [`Scene::draw`](super::Scene::draw) takes at most for a patch like this on a 32-bit target.
///
/// A net for each level of splitting, 7 of 16 or 21 points or 9 of more, 12 bytes a point (16 with weights); the walk with
/// its difference table: 1.7 KB up to degree 3, 4.3 KB up to 5, 6.6 KB for triangles and 13 KB for tensor products above,
/// 5.5 KB for rational patches up to degree 3 and 20.5 KB above; 1.9 KB for the rest. `examples/fw_stack.rs` measures it.
///
/// ```
/// use embedded_surfaces::patch::{BicubicPatch, Surface};
/// use embedded_surfaces::render::stack_bytes;
/// const FLAT: BicubicPatch = embedded_surfaces::const_net!(BicubicPatch::from_ints([[[0; 3]; 4]; 4]));
/// assert_eq!(stack_bytes(FLAT.surface()), 4944);
/// ```
#[must_use]
pub const fn stack_bytes(net: SurfaceNet<'_>) -> usize {
    let (len, depth) = room(net.points().len());
    let (m, h) = net.degrees();
    let degree = if m > h { m } else { h };
    let rational = net.weights().is_some();
    let walk = match degree {
        ..=3 if rational => 5500,
        _ if rational => 20_500,
        ..=3 => 1650,
        4..=5 => 4300,
        _ if net.is_triangle() => 6600,
        _ => 13_000,
    };
    (depth + 1) * len * if rational { 16 } else { 12 } + walk + 1950
}

/// Walks the pieces of a patch.
pub(super) fn each_piece<S: Surface>(net: SurfaceNet<'_>, pieces: &mut dyn Pieces) {
    let shape = S::SHAPE;
    match (net.points().len(), shape.rational && net.weights().is_some()) {
        (..=16, false) => with_room::<S, 16, 0, 7>(net, pieces),
        (..=16, true) => with_room::<S, 16, 16, 7>(net, pieces),
        // More points than degree 3 has.
        _ if shape.degree < 4 => {}
        (..=21, false) => with_room::<S, 21, 0, 7>(net, pieces),
        (..=21, true) => with_room::<S, 21, 21, 7>(net, pieces),
        (..=45, false) => with_room::<S, 45, 0, 9>(net, pieces),
        (..=45, true) => with_room::<S, 45, 45, 9>(net, pieces),
        (_, false) => with_room::<S, 81, 0, 9>(net, pieces),
        (_, true) => with_room::<S, 81, 81, 9>(net, pieces),
    }
}

#[inline(never)]
fn with_room<S: Surface, const LEN: usize, const WEIGHTS: usize, const SLOTS: usize>(
    net: SurfaceNet<'_>,
    pieces: &mut dyn Pieces,
) {
    let mut points = [[Point3::ORIGIN; LEN]; SLOTS];
    let mut weights = [[I16F16::ONE; WEIGHTS]; SLOTS];
    let len = net.points().len();
    let weight_len = if WEIGHTS == 0 { 0 } else { len };
    let mut tree = Tree {
        root: net,
        points: points.as_flattened_mut(),
        weights: weights.as_flattened_mut(),
        len,
        weight_len,
        path: [(Split::R, 0); DEPTH],
        depth: 0,
        deepest: SLOTS - 1,
        front: 0,
        is_near: are_near(net.points()),
    };
    tree.walk::<S>(pieces);
}

/// How a piece is split.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Split {
    R,
    S,
    Squares,
    Triangles,
}

impl Split {
    /// Part number `index`; `None` after the last.
    fn part(self, index: u8) -> Option<Cut> {
        let half = |second: bool| if second { Half::Second } else { Half::First };
        match self {
            Self::R | Self::S if index >= 2 => None,
            Self::R => Some(Cut::Half(Direction::R, half(index == 1))),
            Self::S => Some(Cut::Half(Direction::S, half(index == 1))),
            Self::Squares => (index < 4).then(|| Cut::Tensor(half(index >= 2), half(index % 2 == 1))),
            Self::Triangles => Quarter::ALL.get(usize::from(index)).map(|quarter| Cut::Triangle(*quarter)),
        }
    }
}

/// The pieces on the way from the patch to the current one; piece k stands in slot k − 1.
struct Tree<'n, 's> {
    root: SurfaceNet<'n>,
    points: &'s mut [Point3],
    weights: &'s mut [I16F16],
    len: usize,
    weight_len: usize,
    /// How each was split, and which part is on the way.
    path: [(Split, u8); DEPTH],
    depth: usize,
    deepest: usize,
    /// A bit for each depth: whether the piece there is known to face the viewer.
    front: u16,
    /// Whether the points of the root, and so those of its parts, [are near](are_near).
    is_near: bool,
}

impl Tree<'_, '_> {
    fn walk<S: Surface>(&mut self, pieces: &mut dyn Pieces) {
        loop {
            let split = self.visit::<S>(pieces);
            if let (Some(split), Some(way)) = (split, self.path.get_mut(self.depth)) {
                *way = (split, 0);
                self.depth += 1;
                self.enter::<S>();
                pieces.split();
            } else if !self.advance::<S>() {
                return;
            }
        }
    }

    /// Draws the current piece, or says how it is split.
    fn visit<S: Surface>(&mut self, pieces: &mut dyn Pieces) -> Option<Split> {
        let reach = pieces.reach(self.current().0)?;
        let noted = if reach.is_old { pieces.recall() } else { None };
        let verdict = match noted {
            Some(verdict) => verdict,
            None => self.judge::<S>(pieces),
        };
        if reach.goes_on {
            pieces.keep(&verdict);
        }
        // That of the piece above stands one bit lower.
        let own = 2_u16 << self.depth;
        self.front = if verdict.is_front { self.front | own } else { self.front & !own };
        match verdict.way {
            Way::Leave => None,
            Way::Split(split) => Some(split),
            Way::Draw { sampling, turn, steepest } => {
                let (piece, slot, _) = self.current();
                pieces.piece(piece, (sampling, turn, steepest), slot);
                None
            }
        }
    }

    /// What is to be done with the current piece. Out of line: its stack is free again when a piece is drawn.
    #[inline(never)]
    fn judge<S: Surface>(&mut self, pieces: &mut dyn Pieces) -> Verdict {
        let (depth, deepest) = (self.depth, self.deepest);
        let is_front = self.front >> depth & 1 == 1;
        let (piece, slot, weight_slot) = self.current();
        let wanted = if is_front { Wanted::Front } else { pieces.wants(piece) };
        let verdict = |way: Way| Verdict { way, is_front: wanted == Wanted::Front };
        if wanted == Wanted::No {
            return verdict(Way::Leave);
        }
        let slopes = PieceSlopes::of(piece);
        let (triangles, rational) =
            (S::SHAPE.triangles && piece.is_triangle(), S::SHAPE.rational && piece.weights().is_some());
        let direct = !triangles && !rational;
        // Up to degree 3 any legal net fits 128 bits: (n_r·n_s)^3·2^7·(2K+1) with n below 2^19.
        let fits_always = direct && (S::SHAPE.degree <= 3 || degree(&piece) <= 3);
        if depth < deepest && fits_always && slopes.least_points() > LARGEST {
            return verdict(Way::Split(halves_of(&slopes)));
        }
        let sampling = slopes.sampling::<S>(piece, true);
        let split = if depth == deepest {
            None
        } else if !fits_always && !fits::<S>(piece, sampling) {
            // Both directions at once: what the check of the scene counts on.
            Some(if triangles { Split::Triangles } else { Split::Squares })
        } else if direct {
            (sampling.points(false) > LARGEST).then(|| halves_of(&slopes))
        } else {
            split_that_pays::<S>(source(piece, depth), sampling, slot, weight_slot)
        };
        verdict(match split {
            Some(split) => Way::Split(split),
            None if fits_always => {
                Way::Draw { sampling, turn: slopes.turn(false, sampling.centres), steepest: slopes.steepest(piece) }
            }
            None => Way::Draw { sampling, turn: 0, steepest: 0 },
        })
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
    fn enter<S: Surface>(&mut self) -> bool {
        let Some(level) = self.depth.checked_sub(1) else { return false };
        let Some(part) = self.path.get(level).and_then(|(split, part)| split.part(*part)) else { return false };
        self.depth = level;
        let is_near = self.is_near;
        let (parent, slot, weight_slot) = self.current();
        source(parent, level).1.known_near(is_near).cut_of::<S>(part, slot, weight_slot);
        self.depth = level + 1;
        true
    }

    /// Goes to the next piece that was not visited; whether there is one.
    fn advance<S: Surface>(&mut self) -> bool {
        while let Some(level) = self.depth.checked_sub(1) {
            if let Some((_, part)) = self.path.get_mut(level) {
                *part += 1;
            }
            if self.enter::<S>() {
                return true;
            }
            self.depth = level;
        }
        false
    }
}

/// The larger degree of a piece.
fn degree(piece: &SurfaceNet<'_>) -> usize {
    let (m, h) = piece.degrees();
    m.max(h)
}

/// A piece, and what its parts are cut from.
fn source(piece: SurfaceNet<'_>, depth: usize) -> (SurfaceNet<'_>, Source<'_>) {
    let source = Source::of(piece);
    (piece, if depth == 0 { source.with_long_weights() } else { source })
}

/// Halves of the longer direction.
fn halves_of(slopes: &PieceSlopes) -> Split {
    if slopes.is_longer_along_s() { Split::S } else { Split::R }
}

/// The halves that promise fewer points.
fn longer(piece: SurfaceNet<'_>) -> Split {
    if Estimate::of(piece).prefers_s() { Split::S } else { Split::R }
}

/// The split that pays, if any; looks at the parts in `slot`.
fn split_that_pays<S: Surface>(
    (piece, source): (SurfaceNet<'_>, Source<'_>),
    own: Sampling,
    slot: &mut [Point3],
    weights: &mut [I16F16],
) -> Option<Split> {
    let (triangle, rational) = (piece.is_triangle(), piece.weights().is_some());
    let limit = own.points(triangle) + SETUP;
    if limit <= 3 * SETUP {
        return None;
    }
    let split = if triangle { Split::Triangles } else { longer(piece) };
    let (mut sum, mut index) = (0, 0);
    while let Some(part) = split.part(index) {
        source.cut_of::<S>(part, slot, weights);
        let net = part_net(piece, slot, weights);
        let sampling = PieceSlopes::of(net).sampling::<S>(net, true);
        sum += sampling.points(triangle) + SETUP;
        // Weights of parts have more bits than those of the patch may have had.
        if sum >= limit || (rational && !fits::<S>(net, sampling)) {
            return None;
        }
        index += 1;
    }
    Some(split)
}
