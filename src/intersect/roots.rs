//! Where a curve meets a surface: all points, with a proof that there are no others.
//!
//! The curve is an edge of one patch of a pair, or a line in its domain. Parts of it and parts of the other patch are halved,
//! the longer one first, until a plane lies between their hulls, or they meet in one point at most: if no tangent of the
//! curve is orthogonal to a normal of the surface, both within rigorous cones, then (t, u, v) ↦ S(u, v) − C(t) has the mean
//! derivatives (Su, Sv, −C') with a determinant that is nowhere 0, and takes no value twice. There Newton's method finds the
//! point; if it lies in the pair of parts, or so little beside it that the cones hold there too, the pair is done. What
//! neither test decides is where the curve touches the surface or lies on it: such pairs are looked at by themselves.

use super::IntersectError;
use super::line::Line;
use super::newton::{Pair, Spot};
use super::part::{Directions, Part, Region};
use super::sheet::{ONE, Place};
use super::trace::BORDER;
use crate::num::Real;

/// Halvings of the curve at most.
const DEEPEST_LINE: u8 = 14;
/// Halvings of the surface at most.
const DEEPEST: u8 = 11;
const STACK: usize = DEEPEST_LINE as usize + 3 * DEEPEST as usize + 1;
/// A part of a curve on the surface that is shorter cannot be told from a touch.
const SHORTEST: i64 = ONE >> 10;
/// How far past the known ends of a part on the surface its true ends are searched for.
const REACH: i64 = ONE >> 12;
/// Parts on the surface that are kept.
const PARTS: usize = 6;
/// Touching points that are kept, to know them again.
const TOUCHES: usize = 8;

/// A part of a curve that lies on a surface.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lying {
    /// The curve's parameters.
    pub(super) range: [i64; 2],
    /// One of them, and its point's place on the surface.
    pub(super) at: i64,
    pub(super) foot: Place,
}

/// What a search found beside the points that it gave away.
#[derive(Clone, Copy, Debug)]
pub(super) struct Roots {
    /// Parts of the curve that lie on the surface, apart and rising.
    pub(super) parts: [Option<Lying>; PARTS],
    /// Pairs of parts about which nothing certain can be said, beside touching points.
    pub(super) undecided: u32,
    /// Points where the curve touches the surface.
    pub(super) touching: u32,
    /// Pairs of parts looked at.
    pub(super) visited: u32,
}

impl Lying {
    /// The spot of a parameter within the range; its foot is found in steps of a sixteenth of the way.
    #[inline(never)]
    pub(super) fn spot(&self, pair: &Pair<'_>, line: &Line, t: i64) -> Option<Spot> {
        let (mut near, mut spot) = (self.foot, None);
        for k in 1..=16 {
            let on_way = if k == 16 { t } else { self.at + (t - self.at) / 16 * k };
            spot = pair.on_surface(line, on_way, near, BORDER);
            near = spot?.at[1 - (line.side & 1)];
        }
        spot
    }

    /// The ends: by halving, since the search ended within some of its last steps from them.
    #[inline(never)]
    pub(super) fn ends(&self, pair: &Pair<'_>, line: &Line) -> Option<[Spot; 2]> {
        let [start, end] = self.range;
        let (mut low, mut high) = (self.spot(pair, line, start)?, self.spot(pair, line, end)?);
        if start > 0 {
            low = last_on(pair, line, low, start, (start - REACH).max(-1));
        }
        if end < ONE {
            high = last_on(pair, line, high, end, (end + REACH).min(ONE + 1));
        }
        Some([low, high])
    }
}

impl Pair<'_> {
    /// The spot of a parameter of a line, with its foot on the other patch searched from `near`; the tangent is the line's.
    #[inline(never)]
    fn line_spot(&self, line: &Line, t: i64, near: Place) -> Option<Spot> {
        if let Some(edge) = line.edge {
            return self.edge_spot(line.side, edge, t, near);
        }
        let (one, other) = (line.side & 1, 1 - (line.side & 1));
        let place = line.place(t);
        let jet = self.sheets[one].eval(place, 1)?;
        let (foot, under) = self.foot(other, near, jet.point)?;
        let (at, jets) = if one == 0 { ([place, foot], [jet, under]) } else { ([foot, place], [under, jet]) };
        let mut spot = self.spot(at, &jets);
        let [a, b] = line.direction();
        spot.tangent = (jet.first[0] * a + jet.first[1] * b).unit();
        Some(spot)
    }

    /// The same if it lies on the other patch, up to `slack` of its domain.
    #[inline(never)]
    fn on_surface(&self, line: &Line, t: i64, near: Place, slack: i64) -> Option<Spot> {
        let other = 1 - (line.side & 1);
        let spot = self.line_spot(line, t, near)?;
        let on = spot.residual <= self.touching() && self.sheets[other].contains(spot.at[other], slack);
        on.then_some(spot)
    }
}

/// The last spot on the surface between a parameter on it and one that is not.
#[inline(never)]
fn last_on(pair: &Pair<'_>, line: &Line, on: Spot, mut low: i64, mut high: i64) -> Spot {
    let mut last = on;
    for _ in 0..48 {
        let middle = (low + high) >> 1;
        match pair.on_surface(line, middle, last.at[1 - (line.side & 1)], 4) {
            Some(spot) => (low, last) = (middle, spot),
            None => high = middle,
        }
        if (high - low).abs() <= 1 {
            break;
        }
    }
    last
}

/// How far beside a part of a level a point may be found: a share of 2^-20 of the part and 2^-28 of the domain.
fn slack(level: u8) -> i64 {
    (ONE >> (20 + level)) + (ONE >> 28)
}

/// The same as a share of the part.
fn share(level: i32) -> Real {
    Real::power(-20) + Real::power(level - 28)
}

/// How a pair of parts was judged.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Verdict {
    Decided,
    Open,
}

/// What takes the points: each with whether the curve touches the surface there.
type Visit<'v> = dyn FnMut(&Spot, bool) -> Result<(), IntersectError> + 'v;

struct Search<'s, 'a, 'v> {
    pair: &'s Pair<'a>,
    line: Line,
    visit: &'s mut Visit<'v>,
    failure: Result<(), IntersectError>,
    touches: [Option<(i64, Place)>; TOUCHES],
    /// Pairs too small to be halved.
    doubts: [Option<(i64, Place)>; TOUCHES],
    roots: Roots,
}

impl Search<'_, '_, '_> {
    fn other(&self) -> usize {
        1 - (self.line.side & 1)
    }

    /// The parameter on the curve and the place on the surface.
    fn split(&self, spot: &Spot) -> (i64, Place) {
        (self.line.parameter(spot.at[self.line.side & 1]), spot.at[self.other()])
    }

    #[inline(never)]
    fn judge(&mut self, line: &mut Part<'_>, part: &mut Part<'_>, over: [Region; 2]) -> Verdict {
        if !line.boxes_meet(part) {
            return Verdict::Decided;
        }
        part.aim();
        let (normals, tangents) = (part.cone, line.tangents());
        if !normals.axis.is_zero() && line.is_apart_along(part, normals.axis) {
            return Verdict::Decided;
        }
        let last = over[0].level >= DEEPEST_LINE && over[1].level >= DEEPEST;
        if let Some(Directions { axis, spread, turn }) = tangents {
            // Along the curve a part of the surface is a quadrangle or a triangle, nearly: planes through its sides.
            let sides = [normals.along[0], normals.along[1], part.diagonal()];
            if sides.into_iter().any(|s| !s.is_zero() && line.is_apart_along(part, axis.cross(s))) {
                return Verdict::Decided;
            }
            let spread = spread + normals.sine;
            let [level, other] = over.map(|region| region.level.into());
            let beside = turn * share(level) + normals.turn * share(other);
            if axis.dot(normals.axis).abs() > spread + beside {
                if self.single(over) {
                    return Verdict::Decided;
                }
            } else if spread < Real::power(-2) && over[0].level > 0 && self.contact(over) {
                return Verdict::Decided;
            }
        }
        if last {
            self.give_up(over);
            return Verdict::Decided;
        }
        Verdict::Open
    }

    /// Finds the only point of a pair of parts; whether it, or that there is none, is now known.
    #[inline(never)]
    fn single(&mut self, over: [Region; 2]) -> bool {
        let other = &self.pair.sheets[self.other()];
        let [low, high] = over[0].range();
        let start = self.line.place((low + high) >> 1);
        let place = over[1].centre(other.triangle);
        let at = if self.line.side & 1 == 0 { [start, place] } else { [place, start] };
        let found = match self.line.edge {
            Some(edge) => self.pair.on_edge(self.line.side, edge, at),
            None => self.pair.on_line(self.line.side, self.line.direction(), &|place| place, at),
        };
        let Some(spot) = found else { return false };
        let (t, place) = self.split(&spot);
        let slack = slack(over[0].level);
        if t < low - slack || t > high + slack || !over[1].contains(place, other.triangle, self::slack(over[1].level)) {
            return false;
        }
        if other.contains(place, BORDER) {
            self.give(&spot, false);
        }
        true
    }

    fn give(&mut self, spot: &Spot, touching: bool) {
        if self.failure.is_ok() {
            self.failure = (self.visit)(spot, touching);
        }
    }

    /// The curve's point at a parameter, its foot on the surface, and the sine of the curve's angle with it there, signed.
    #[inline(never)]
    fn slope(&self, t: i64, near: Place) -> Option<(Spot, Real)> {
        let spot = self.pair.line_spot(&self.line, t, near)?;
        let jet = self.pair.sheets[self.other()].eval(spot.at[self.other()], 1)?;
        Some((spot, jet.normal().unit().dot(spot.tangent)))
    }

    /// Whether a spot lies on the surface.
    fn is_on(&self, spot: &Spot) -> bool {
        let other = self.other();
        spot.residual <= self.pair.touching() && self.pair.sheets[other].contains(spot.at[other], BORDER)
    }

    /// Looks at a flat pair of parts nearly parallel to each other: whether the curve lies on the surface there or touches it.
    #[inline(never)]
    fn contact(&mut self, over: [Region; 2]) -> bool {
        let other = &self.pair.sheets[self.other()];
        let [low, high] = over[0].range();
        let near = over[1].centre(other.triangle);
        let Some((middle, _)) = self.slope((low + high) >> 1, near) else { return false };
        let (_, foot) = self.split(&middle);
        if self.is_on(&middle) {
            let known = |part: &Lying| part.range[0] <= low && high <= part.range[1];
            if self.roots.parts.iter().flatten().any(known) {
                return over[1].contains(foot, other.triangle, ONE >> over[1].level);
            }
            // Not at equal distances, as roots of a curve made by hand may be.
            let sampled = [0, 197, 441, 727, 1024].into_iter().all(|share| {
                let t = low + ((high - low) >> 10) * share;
                self.slope(t, foot).is_some_and(|(spot, _)| self.is_on(&spot))
            });
            if sampled {
                self.enter_part(Lying { range: [low, high], at: (low + high) >> 1, foot });
                return over[1].contains(foot, other.triangle, ONE >> over[1].level);
            }
        }
        let known = |touch: &(i64, Place)| {
            let slack = high - low;
            touch.0 >= low - slack
                && touch.0 <= high + slack
                && over[1].contains(touch.1, other.triangle, ONE >> over[1].level)
        };
        if over[0].level.min(over[1].level) >= 6 && self.touches.iter().flatten().any(known) {
            return true;
        }
        let Some(spot) = self.touch([low, high], foot) else { return false };
        // Along a part on the surface the curve is parallel to it everywhere.
        let (t, foot) = self.split(&spot);
        let lies = |t: i64| (0..=ONE).contains(&t) && self.slope(t, foot).is_some_and(|(spot, _)| self.is_on(&spot));
        if lies(t - ((high - low) >> 3)) || lies(t + ((high - low) >> 3)) {
            return false;
        }
        self.enter_touch(&spot);
        over[0].level.min(over[1].level) >= 6
    }

    /// Where the curve is parallel to the surface and meets it, between two parameters.
    #[inline(never)]
    fn touch(&self, [mut low, mut high]: [i64; 2], foot: Place) -> Option<Spot> {
        let ((_, mut from), (_, mut to)) = (self.slope(low, foot)?, self.slope(high, foot)?);
        if from.is_negative() == to.is_negative() && !from.is_zero() && !to.is_zero() {
            return None;
        }
        // The Illinois rule of false position (Dowell and Jarratt 1971).
        let (mut last, mut near, mut side) = (low, foot, 0);
        for _ in 0..40 {
            let share = from / (from - to);
            let t = (low + (Real::new(high - low, 0) * share).nearest(0)).max(low).min(high);
            let (spot, slope) = self.slope(t, near)?;
            if (t - last).abs() <= ONE >> 30 || high - low <= ONE >> 30 || slope.is_zero() {
                return self.is_on(&spot).then_some(spot);
            }
            (last, near) = (t, self.split(&spot).1);
            if slope.is_negative() == from.is_negative() {
                (low, from) = (t, slope);
                to = if side == 1 { to.shl(-1) } else { to };
                side = 1;
            } else {
                (high, to) = (t, slope);
                from = if side == 2 { from.shl(-1) } else { from };
                side = 2;
            }
        }
        None
    }

    #[inline(never)]
    fn enter_touch(&mut self, spot: &Spot) {
        let found = self.split(spot);
        let close = |t: &(i64, Place)| (t.0 - found.0).abs() <= ONE >> 20;
        if self.touches.iter().flatten().any(close) {
            return;
        }
        // One that there is no room for is given away each time it is found.
        if let Some(free) = self.touches.iter_mut().find(|t| t.is_none()) {
            *free = Some(found);
        }
        self.roots.touching = self.roots.touching.saturating_add(1);
        self.give(spot, true);
    }

    /// Joins a part that lies on the surface with those it meets.
    #[inline(never)]
    fn enter_part(&mut self, mut part: Lying) {
        for place in &mut self.roots.parts {
            if let Some(old) = place.filter(|p| p.range[0] <= part.range[1] && part.range[0] <= p.range[1]) {
                part.range = [part.range[0].min(old.range[0]), part.range[1].max(old.range[1])];
                *place = None;
            }
        }
        match self.roots.parts.iter_mut().find(|p| p.is_none()) {
            Some(free) => *free = Some(part),
            None => self.roots.undecided = self.roots.undecided.saturating_add(1),
        }
    }

    /// Keeps a pair of parts too small to be halved.
    #[inline(never)]
    fn give_up(&mut self, over: [Region; 2]) {
        let other = &self.pair.sheets[self.other()];
        let [low, high] = over[0].range();
        let near = |d: &(i64, Place)| (d.0 - low).abs() <= (high - low) << 3;
        if self.doubts.iter().flatten().any(near) {
            return;
        }
        match self.doubts.iter_mut().find(|d| d.is_none()) {
            Some(free) => *free = Some((low, over[1].centre(other.triangle))),
            None => self.roots.undecided = self.roots.undecided.saturating_add(1),
        }
    }

    /// What can be said of them, and of parts too short, when all else is known.
    #[inline(never)]
    fn finish(&mut self) {
        let short = |part: &mut Lying| part.range[1] - part.range[0] < SHORTEST;
        while let Some(part) = self.roots.parts.iter_mut().find_map(|place| place.take_if(short)) {
            if let Some((spot, _)) = self.slope(part.at, part.foot) {
                self.enter_touch(&spot);
            }
        }
        let slack = ONE >> (DEEPEST_LINE - 3);
        for (t, place) in self.doubts.into_iter().flatten() {
            let close = |from: i64, to: i64| from - slack <= t && t <= to + slack;
            if self.touches.iter().flatten().any(|touch| close(touch.0, touch.0))
                || self.roots.parts.iter().flatten().any(|p| close(p.range[0], p.range[1]))
            {
                continue;
            }
            match self.slope(t, place) {
                Some((spot, _)) if self.is_on(&spot) => self.enter_touch(&spot),
                _ => self.roots.undecided = self.roots.undecided.saturating_add(1),
            }
        }
    }
}

/// Finds all points where a line on one patch meets the other, or a part of the other, and calls `visit` with each, and
/// with whether the curve touches the surface there. A point in the border of two parts comes twice. Looks at `budget` pairs
/// of parts at most, in `parts`: the second is empty or a part of that patch.
#[inline(never)]
pub(super) fn find(
    pair: &Pair<'_>,
    line: Line,
    over: Region,
    budget: u32,
    parts: &mut [Part<'_>; 2],
    visit: &mut Visit<'_>,
) -> Result<Roots, IntersectError> {
    let roots = Roots { parts: [None; PARTS], undecided: 0, touching: 0, visited: 0 };
    let mut search =
        Search { pair, line, visit, failure: Ok(()), touches: [None; TOUCHES], doubts: [None; TOUCHES], roots };
    let sheets = [&pair.sheets[line.side & 1], &pair.sheets[1 - (line.side & 1)]];
    let mut stack = [[Region::ROOT, over]; STACK];
    let mut height = 1;
    let [curve, part] = parts;
    curve.region = None;
    while height > 0 && search.failure.is_ok() {
        height -= 1;
        let Some(over) = stack.get(height).copied() else { break };
        if search.roots.visited >= budget {
            search.roots.undecided = search.roots.undecided.saturating_add(height as u32 + 1);
            break;
        }
        search.roots.visited += 1;
        if curve.region != Some(over[0]) {
            curve.load_line(sheets[0], &line, over[0]);
        }
        if part.region != Some(over[1]) {
            part.load(sheets[1], over[1]);
        }
        if search.judge(curve, part, over) == Verdict::Decided {
            continue;
        }
        let ends = [over[0].level >= DEEPEST_LINE, over[1].level >= DEEPEST];
        if ends[0] || (!ends[1] && part.size() > curve.size()) {
            for quarter in over[1].quarters(sheets[1].triangle) {
                if let Some(place) = stack.get_mut(height) {
                    *place = [over[0], quarter];
                    height += 1;
                }
            }
        } else {
            for half in over[0].halves() {
                if let Some(place) = stack.get_mut(height) {
                    *place = [half, over[1]];
                    height += 1;
                }
            }
        }
    }
    search.finish();
    search.failure?;
    // Few ranges: by insertion.
    let parts = &mut search.roots.parts;
    for i in 1..PARTS {
        for j in (1..=i).rev() {
            if let Some([a, b]) = parts.get_mut(j - 1..=j)
                && b.is_some_and(|b| a.is_none_or(|a| b.range[0] < a.range[0]))
            {
                core::mem::swap(a, b);
            }
        }
    }
    Ok(search.roots)
}
