//! From seeds to curves: borders, contacts, arms of branches, and every chain of the mesh that no curve covers yet.

use super::cells::{self, Cells};
use super::certify::{DEEPEST, Report, SHALLOW, Search};
use super::chain::Chains;
use super::contact::{Contact, Form};
use super::curve::{Branch, Curve, CurveKind, CurvePoint, End};
use super::descent::{meeting, place_in};
use super::grid::Grid;
use super::hermite::Piece;
use super::key::{Crossing, Edge, EdgeKind};
use super::newton::{Pair, Places, Spot, difference, moved};
use super::predicate::normal;
use super::trace::{BORDER, Locus, Output, Stop, Tracer};
use super::vector::V3;
use super::{Buffer, IntersectError};
use crate::geometry::Vector3;
use crate::num::Real;
use fixed::types::I2F30;

/// One of this many crossings of a chain is refined, to see whether its curve is known.
const STRIDE: usize = 3;
/// The sine of the angle between the surfaces below which a spot is singular.
const SINGULAR: Real = Real::power(-18);

/// What is needed to find curves and to know those found.
#[derive(Debug)]
pub(super) struct Solver<'s, 'a, 'b> {
    pub(super) pair: &'s Pair<'a>,
    pub(super) out: Output<'b>,
    pub(super) tolerance: Real,
    /// The size of the larger grid's cells in units.
    pub(super) cell: Real,
    pub(super) undecided: u32,
}

/// The edge of a patch on which a grid's border edge lies.
fn border_of(edge: Edge, triangle: bool) -> usize {
    match (edge.kind, triangle) {
        (EdgeKind::U, true) => 1,
        (EdgeKind::U, false) => 2 + usize::from(edge.j != 0),
        (EdgeKind::V, _) => usize::from(edge.i != 0),
        (EdgeKind::Diagonal, _) => 2,
    }
}

/// The places of a crossing on both patches, and the point, linearly interpolated.
#[inline(never)]
fn begin(grids: [&Grid<'_>; 2], crossing: Crossing) -> (Places, [i64; 3]) {
    let side = usize::from(crossing.side) & 1;
    let (own, other) = (grids[side], grids[1 - side]);
    let [p, q] = crossing.edge.ends().map(|(i, j)| own.vertex(i, j));
    let [a, b, c] = crossing.cell.corners().map(|(i, j)| other.vertex(i, j));
    let (share, weights) = meeting([p, q], [a, b, c], &normal([a, b, c]));
    let along = (V3::bits(q.map(i64::from), -16) - V3::bits(p.map(i64::from), -16)) * share;
    let place = |(i, j): (usize, usize)| [i, j].map(|k| (k as i64) << (48 - own.depth));
    let [from, to] = crossing.edge.ends().map(place);
    let on_own = both!(|k| from[k] + (Real::new(to[k] - from[k], -48) * share).nearest(48));
    let on_other = place_in(other, crossing.cell, weights);
    let point = moved(p.map(|c| i64::from(c) << 28), along);
    (if side == 0 { [on_own, on_other] } else { [on_other, on_own] }, point)
}

/// Whether a point lies on one of the curves with these pieces, up to `slack`.
fn on_pieces(points: &[CurvePoint], closed: bool, point: [i64; 3], slack: Real) -> bool {
    let bits = slack.fixed(44);
    let test = |p: &CurvePoint, q: &CurvePoint| {
        let (a, b) = (p.bits(), q.bits());
        let long = (0..3).fold(0, |l, k| l.max((a[k] - b[k]).abs())) + bits;
        if (0..3).any(|k| point[k] < a[k].min(b[k]) - long || point[k] > a[k].max(b[k]) + long) {
            return false;
        }
        if a == b {
            return difference(point, a).norm() <= slack;
        }
        let near_end = |x: [i64; 3]| difference(point, x).norm() <= slack;
        let piece = Piece::through(a, p.direction(), b, q.direction());
        near_end(a) || near_end(b) || piece.distance(point).is_some_and(|d| d <= slack)
    };
    let last = points.last().zip(points.first()).filter(|_| closed);
    points.len() == 1 && points.iter().any(|p| test(p, p))
        || points.windows(2).any(|w| test(&w[0], &w[1]))
        || last.is_some_and(|(p, q)| test(p, q))
}

impl<'s, 'a> Solver<'s, 'a, '_> {
    /// Whether a point lies on a curve that is known.
    #[inline(never)]
    fn is_covered(&self, point: [i64; 3]) -> bool {
        let slack = self.tolerance.shl(3).max(self.pair.extent.shl(-26));
        self.out.finished().iter().any(|c| on_pieces(self.out.points_of(c), c.closed, point, slack))
    }

    /// Whether a singular spot is explained by a branch, a touching point or a curve of contact within some cells.
    #[inline(never)]
    fn is_explained(&self, point: [i64; 3]) -> bool {
        let slack = self.cell.shl(2);
        let close = |x: [i64; 3]| difference(x, point).norm() <= slack;
        let singular = |kind| !matches!(kind, CurveKind::Open | CurveKind::Closed);
        self.out.branches().iter().any(|b| close(b.point.bits()))
            || self.out.finished().iter().filter(|c| singular(c.kind)).any(|c| {
                on_pieces(self.out.points_of(c), c.closed, point, slack)
                    || (c.kind == CurveKind::OverlapRegion && self.is_coincident(point, c.first))
            })
    }

    /// Whether a curve of contact passes within a distance of a point.
    #[inline(never)]
    fn touches_near(&self, point: [i64; 3], reach: Real) -> bool {
        use CurveKind::{EdgeOnSurface, OverlapRegion, SharedEdge, SharedEdgeTangential, Tangential};
        let kinds = |c: &Curve| match c.kind {
            Tangential | SharedEdgeTangential | OverlapRegion => true,
            SharedEdge | EdgeOnSurface => c.min_sine < I2F30::from_bits(1 << 20),
            _ => false,
        };
        let curves = self.out.finished().iter().filter(|c| kinds(c));
        curves.into_iter().any(|c| on_pieces(self.out.points_of(c), c.closed, point, reach))
    }

    /// Whether a point near both surfaces lies in a region where they coincide: both have the same foot, where they are parallel.
    fn is_in_region(&self, at: Places, point: [i64; 3]) -> bool {
        if self.out.finished().iter().all(|c| c.kind != CurveKind::OverlapRegion) {
            return false;
        }
        let feet = both!(|s| self.pair.foot(s, at[s], point));
        let [Some((u, a)), Some((v, b))] = feet else { return false };
        self.pair.inside([u, v], 0) && difference(a.point, b.point).norm() <= self.pair.touching() && a.is_parallel(&b)
    }

    /// Whether a point within a region lies on both surfaces, which are parallel there.
    fn is_coincident(&self, point: [i64; 3], near: usize) -> bool {
        let Some(border) = self.out.points.get(near) else { return false };
        let feet = both!(|s| self.pair.foot(s, border.places()[s], point));
        let [Some((_, a)), Some((_, b))] = feet else { return false };
        a.is_parallel(&b)
    }

    /// Whether the curve at a spot goes on inside both patches, in the spot's direction, by a share of 2^-`shift`.
    fn leads_inside(&self, spot: &Spot, shift: i32) -> bool {
        self.pair.inside(Pair::followed(spot.at, &spot.rates, self.pair.extent.shl(-shift)), BORDER)
    }

    fn stop(&mut self, stop: Stop, spot: &Spot) -> Result<End, IntersectError> {
        Ok(match stop {
            Stop::Border => self.pair.end(spot.at),
            Stop::Branch(branch) => End::Branch { branch: branch as u16 },
            Stop::Closed => End::None,
            Stop::Lost => {
                if let Some(last) = self.tangency_on_border(spot) {
                    self.out.emit(&last)?;
                    return Ok(self.pair.end(last.at));
                }
                self.undecided += 1;
                End::Lost
            }
        })
    }

    /// The tangency on a border next to the spot where a walk was lost, with the walk's tangent: a curve that ends on an edge
    /// along which the surfaces meet.
    #[inline(never)]
    fn tangency_on_border(&self, spot: &Spot) -> Option<Spot> {
        let mut contact = Contact::BLANK;
        self.pair.critical(&mut contact, spot.at, self.pair.extent.shl(-16))?;
        let last = contact.spot(self.pair);
        let sound = contact.apart.norm() <= self.pair.touching() && self.pair.end(last.at) != End::Lost;
        sound.then_some(Spot { tangent: spot.tangent, rates: spot.rates, ..last })
    }

    /// Follows the curve through a spot in both directions and enters it.
    #[inline(never)]
    pub(super) fn follow(&mut self, locus: Locus, seed: &Spot) -> Result<(), IntersectError> {
        let (open, closed) = match locus {
            Locus::Crossing => (CurveKind::Open, CurveKind::Closed),
            _ => (CurveKind::Tangential, CurveKind::Tangential),
        };
        let first = self.out.used;
        let (pair, tolerance) = (self.pair, self.tolerance);
        // Curves that cut off next to nothing are shorter than the first share.
        let inside = |shift| [true, false].map(|forward| self.leads_inside(&seed.oriented(forward), shift));
        let ways = [14, 20, 26].map(inside).into_iter().find(|i| *i != [false; 2]).unwrap_or([false; 2]);
        let tracer = |forward| Tracer { pair, locus, forward, tolerance };
        if ways == [false; 2] {
            return self.touch(seed);
        }
        let forward = ways[0];
        let mut spot = seed.oriented(forward);
        self.out.emit(&spot)?;
        let begin = pair.end(spot.at);
        let stop = tracer(forward).walk(&mut self.out, &mut spot, Some(&seed.oriented(forward)))?;
        if stop == Stop::Closed {
            return self.out.finish(closed, true, [End::None; 2], first);
        }
        let last = self.stop(stop, &spot)?;
        if ways != [true; 2] {
            return self.out.finish(open, false, [begin, last], first);
        }
        if let Some(points) = self.out.points.get_mut(first..self.out.used) {
            // Not `reverse`, which leaves a panic in images built for speed.
            let mut ends = points.iter_mut();
            while let (Some(one), Some(other)) = (ends.next(), ends.next_back()) {
                core::mem::swap(one, other);
            }
            points.iter_mut().for_each(|p| *p = p.turned());
        }
        // A closed curve that was lost comes back to where that was.
        let lost = (stop == Stop::Lost).then(|| spot.oriented(false));
        spot = seed.oriented(!forward);
        let stop = tracer(!forward).walk(&mut self.out, &mut spot, lost.as_ref())?;
        if stop == Stop::Closed {
            return self.out.finish(closed, true, [End::None; 2], first);
        }
        let end = self.stop(stop, &spot)?;
        self.out.finish(open, false, [last, end], first)
    }

    /// Runs the loop-free test and enters what its contacts are: touching points, tangential curves, branches.
    /// Keeps the pairs through which curves go.
    #[inline(never)]
    pub(super) fn contacts(
        &mut self,
        budget: u32,
        report: &mut Report,
        cells: &mut Cells<'_>,
    ) -> Result<(), IntersectError> {
        self.test(budget, report, cells)?;
        self.undecided = self.undecided.saturating_add(report.undecided);
        for found in report.list().filter(|f| f.touches) {
            match found.form {
                Form::Saddle => self.branch(found.at)?,
                Form::Definite => self.touch_at(found.at)?,
                Form::Ridge | Form::Flat => {
                    let known = self.contact_spot(found.at).is_none_or(|spot| self.is_covered(spot.point));
                    self.undecided += u32::from(!known);
                }
            }
        }
        Ok(())
    }

    #[inline(never)]
    fn test(&mut self, budget: u32, report: &mut Report, cells: &mut Cells<'_>) -> Result<(), IntersectError> {
        for (deepest, budget) in [(SHALLOW, budget / 2), (DEEPEST, budget)] {
            report.undecided = 0;
            cells.restart(deepest);
            let mut search = Search::new(self.pair, deepest);
            let mut known = false;
            while let Some(at) =
                search.run((report, cells), budget, known, |point, reach| self.touches_near(point, reach))
            {
                known = self.is_on_ridge(at)?;
            }
            if report.undecided == 0 {
                break;
            }
        }
        Ok(())
    }

    /// The spot of a contact.
    #[inline(never)]
    fn contact_spot(&self, at: Places) -> Option<Spot> {
        Some(Contact::new(self.pair, at)?.spot(self.pair))
    }

    #[inline(never)]
    fn contact_form(&self, at: Places) -> Option<Form> {
        Some(Contact::new(self.pair, at)?.form())
    }

    /// Whether a contact lies on a curve that is known, after following the curve along which the surfaces touch there.
    #[inline(never)]
    fn is_on_ridge(&mut self, at: Places) -> Result<bool, IntersectError> {
        let Some(spot) = self.contact_spot(at) else { return Ok(false) };
        if self.is_covered(spot.point) {
            return Ok(true);
        }
        if self.contact_form(at) != Some(Form::Ridge) {
            return Ok(false);
        }
        let count = self.out.curve_count;
        self.follow(Locus::Ridge, &spot)?;
        // A ridge that is level at one point only is no curve.
        let short = self.out.finished().last().is_some_and(|c| c.ends == [End::Lost; 2] && c.length < self.cell_bits());
        if self.out.curve_count > count && short {
            self.out.curve_count = count;
            self.out.used = self.out.curves.get(count).map_or(self.out.used, |c| c.first);
            self.out.unrefined = 0;
            return Ok(false);
        }
        Ok(true)
    }

    /// Enters a touching point unless a curve passes there.
    #[inline(never)]
    fn touch_at(&mut self, at: Places) -> Result<(), IntersectError> {
        match self.contact_spot(at) {
            Some(spot) if !self.is_covered(spot.point) => self.touch(&spot),
            _ => Ok(()),
        }
    }

    /// Enters a touching point.
    fn touch(&mut self, spot: &Spot) -> Result<(), IntersectError> {
        let first = self.out.used;
        self.out.emit(&Spot { tangent: V3::ZERO, ..*spot })?;
        self.out.finish(CurveKind::TangentPoint, false, [End::None; 2], first)
    }

    /// Enters contacts of a higher order that no curve reached: touching points, as far as can be told.
    #[inline(never)]
    pub(super) fn leftovers(&mut self, report: &Report) -> Result<(), IntersectError> {
        for found in report.list().filter(|f| f.touches && matches!(f.form, Form::Ridge | Form::Flat)) {
            let Some(spot) = self.contact_spot(found.at) else { continue };
            let slack = self.cell.shl(-1);
            let near = |c: &Curve| on_pieces(self.out.points_of(c), c.closed, spot.point, slack);
            if !self.out.finished().iter().any(near) {
                self.touch(&spot)?;
            }
        }
        Ok(())
    }

    fn cell_bits(&self) -> fixed::types::I20F44 {
        fixed::types::I20F44::from_bits(self.cell.fixed(44))
    }

    /// The first spot of an arm, with the tangent away from the branch; `None` where the arm lies outside a patch.
    #[inline(never)]
    fn arm(&self, contact: &Contact, direction: V3) -> Option<(Spot, bool)> {
        let point = contact.point();
        let rates = contact.rates(direction);
        // Not past a branch next to it.
        let others = self.out.branches().iter().map(|b| difference(b.point.bits(), point).norm());
        let near = self.pair.extent.shl(-24);
        let free = others.filter(|d| *d > near).fold(self.pair.extent, Real::min).shl(-1);
        for shift in [7, 9, 11, 13, 15] {
            let radius = self.pair.extent.shl(-shift);
            if radius > free && shift < 15 {
                continue;
            }
            let at = Pair::followed(contact.at, &rates, radius);
            let Some(spot) = self.pair.in_plane(at, moved(point, direction * radius), direction) else { continue };
            let forward = !spot.tangent.dot(direction).is_negative();
            let spot = spot.oriented(forward);
            let straight = spot.tangent.dot(direction) > Real::ONE - Real::power(-5);
            let near = difference(spot.point, point).norm() < radius * Real::int(2);
            if straight && near {
                if self.pair.inside(spot.at, BORDER) {
                    return Some((spot, forward));
                }
                if shift >= 11 {
                    return None;
                }
            }
        }
        None
    }

    /// Enters a branch with its arms, unless a curve passes there.
    #[inline(never)]
    fn branch(&mut self, at: Places) -> Result<(), IntersectError> {
        let Some(contact) = Contact::new(self.pair, at) else { return Ok(()) };
        let mut spot = contact.spot(self.pair);
        if self.is_covered(spot.point) {
            return Ok(());
        }
        let directions = contact.arms();
        let unit = |c: Real| I2F30::from_bits(c.nearest(30).clamp(-1 << 30, 1 << 30) as i32);
        spot.tangent = directions[0];
        let branch = Branch {
            point: CurvePoint::of(&spot),
            directions: directions.map(|d| Vector3::from_array(d.0.map(unit))),
            ..Branch::BLANK
        };
        let given = self.out.branches.len();
        let full = IntersectError::Buffer { buffer: Buffer::Branches, needed: given + 1, given };
        *self.out.branches.get_mut(self.out.branch_count).ok_or(full)? = branch;
        self.out.branch_count += 1;
        Ok(())
    }

    /// Looks which arms of the branches there are; those on a curve that is known are taken.
    #[inline(never)]
    fn look_at_arms(&mut self) {
        for b in 0..self.out.branch_count {
            let Some(branch) = self.out.branches.get(b).copied() else { continue };
            let Some(contact) = Contact::new(self.pair, branch.point.places()) else { continue };
            for k in 0..4 {
                let arm = self.arm(&contact, branch.direction(k));
                let taken = arm.is_some_and(|(spot, _)| self.is_covered(spot.point));
                if let Some(branch) = self.out.branches.get_mut(b) {
                    (branch.present[k], branch.taken[k]) = (arm.is_some(), taken);
                }
            }
        }
    }

    /// Follows the arms of all branches.
    #[inline(never)]
    pub(super) fn arms(&mut self) -> Result<(), IntersectError> {
        self.look_at_arms();
        for b in 0..self.out.branch_count {
            for k in 0..4 {
                let free = self.out.branches.get(b).is_some_and(|now| now.present[k] && !now.taken[k]);
                if !free {
                    continue;
                }
                let first = self.out.used;
                let Some((mut spot, tracer)) = self.start(b, k)? else { continue };
                if let Some(branch) = self.out.branches.get_mut(b) {
                    branch.taken[k] = true;
                }
                let stop = tracer.walk(&mut self.out, &mut spot, None)?;
                let end = self.stop(stop, &spot)?;
                self.out.finish(CurveKind::Open, false, [End::Branch { branch: b as u16 }, end], first)?;
            }
        }
        Ok(())
    }

    /// Writes the first piece of an arm: its last spot, and how to go on.
    #[inline(never)]
    fn start(&mut self, b: usize, arm: usize) -> Result<Option<(Spot, Tracer<'s, 'a>)>, IntersectError> {
        let Some((origin, spot, forward)) = self.piece_of_arm(b, arm) else { return Ok(None) };
        self.out.emit(&origin)?;
        let tracer = Tracer { pair: self.pair, locus: Locus::Crossing, forward, tolerance: self.tolerance };
        tracer.connect(&mut self.out, &origin, &spot, true)?;
        Ok(Some((spot, tracer)))
    }

    /// Both ends of an arm's first piece.
    #[inline(never)]
    fn piece_of_arm(&self, b: usize, arm: usize) -> Option<(Spot, Spot, bool)> {
        let branch = self.out.branches.get(b)?;
        let contact = Contact::new(self.pair, branch.point.places())?;
        let direction = branch.direction(arm);
        let (spot, forward) = self.arm(&contact, direction)?;
        let mut origin = contact.spot(self.pair);
        (origin.tangent, origin.rates) = (direction, contact.rates(direction));
        origin.point = branch.point.bits();
        Some((origin, spot, forward))
    }

    /// Follows curves from where the mesh crosses a border.
    #[inline(never)]
    pub(super) fn borders(&mut self, grids: [&Grid<'_>; 2], chains: &mut Chains<'_>) -> Result<(), IntersectError> {
        let mut from = 0;
        while let Some(start) = chains.next_start(true, &mut from) {
            let mut ends = [None; 2];
            chains.walk(start, |crossing| {
                ends = [ends[0].or(Some(crossing)), Some(crossing)];
                Ok(())
            })?;
            for crossing in ends.into_iter().flatten() {
                self.border(grids, crossing)?;
            }
        }
        chains.reset();
        Ok(())
    }

    /// Follows curves from the points of edges on the other patch that no curve reaches.
    pub(super) fn roots(&mut self) -> Result<(), IntersectError> {
        while let Some(root) = self.out.take_back() {
            if self.is_covered(root.bits()) {
                continue;
            }
            self.seed(root.places())?;
        }
        Ok(())
    }

    /// Follows curves from where they pass between parts of the loop-free test, if none is known there.
    pub(super) fn passages(&mut self, cells: &mut Cells<'_>) -> Result<(), IntersectError> {
        let pair = self.pair;
        let (mut k, mut last) = (0, None);
        while let Some(cell) = cells.get(pair, k) {
            // Parts and what finds points in them leave the stack before a curve is followed.
            let mut missed = None;
            let undecided = cells::pass(pair, cell, &mut |spot| {
                if missed.is_none() && !self.is_covered(spot.point) {
                    missed = Some(spot.at);
                }
                Ok(())
            })?;
            if let Some(at) = missed.filter(|at| Some(*at) != last) {
                last = missed;
                self.seed(at)?;
                continue;
            }
            self.undecided = self.undecided.saturating_add(undecided).saturating_add(u32::from(missed.is_some()));
            k += 1;
        }
        Ok(())
    }

    /// Follows the curve through a place on both surfaces.
    fn seed(&mut self, at: Places) -> Result<(), IntersectError> {
        let Some(jets) = self.pair.jets(at, 1) else {
            self.undecided += 1;
            return Ok(());
        };
        let spot = self.pair.spot(at, &jets);
        if spot.sine > SINGULAR {
            return self.follow(Locus::Crossing, &spot);
        }
        self.undecided += u32::from(!self.is_explained(spot.point));
        Ok(())
    }

    fn border(&mut self, grids: [&Grid<'_>; 2], crossing: Crossing) -> Result<(), IntersectError> {
        let (at, point) = begin(grids, crossing);
        let side = usize::from(crossing.side) & 1;
        let edge = border_of(crossing.edge, grids[side].triangle);
        let found = self.pair.on_edge(side, edge, at);
        let Some(spot) = found.filter(|s| s.sine > SINGULAR) else {
            self.undecided += u32::from(!self.is_explained(point));
            return Ok(());
        };
        let near = difference(spot.point, point).norm() <= self.cell.shl(3);
        if !near || !self.pair.inside(spot.at, BORDER) || self.is_covered(spot.point) {
            return Ok(());
        }
        self.follow(Locus::Crossing, &spot)
    }

    /// Follows curves from crossings of chains that no curve covers.
    #[inline(never)]
    pub(super) fn chains(&mut self, grids: [&Grid<'_>; 2], chains: &mut Chains<'_>) -> Result<(), IntersectError> {
        for open in [true, false] {
            let mut from = 0;
            while let Some(start) = chains.next_start(open, &mut from) {
                let (mut count, mut lost) = (0, false);
                chains.walk(start, |crossing| {
                    if count % STRIDE == 0 {
                        lost |= !self.cross(grids, crossing)?;
                    }
                    count += 1;
                    Ok(())
                })?;
                self.undecided += u32::from(lost);
            }
        }
        Ok(())
    }

    /// Makes sure that a crossing's curve is known; false if that cannot be told.
    #[inline(never)]
    fn cross(&mut self, grids: [&Grid<'_>; 2], crossing: Crossing) -> Result<bool, IntersectError> {
        let (at, point) = begin(grids, crossing);
        if self.is_in_region(at, point) {
            return Ok(true);
        }
        let Some(spot) = self.pair.nearest(at).filter(|s| s.sine > SINGULAR) else {
            return Ok(self.is_explained(point));
        };
        if !self.pair.inside(spot.at, 0) || self.is_covered(spot.point) {
            return Ok(true);
        }
        // Far from where it began, or singular: what the mesh saw may be another curve's neighbourhood.
        if spot.sine < Real::power(-10) && self.is_explained(spot.point) {
            return Ok(true);
        }
        self.follow(Locus::Crossing, &spot)?;
        Ok(true)
    }

    /// Follows small curves round contacts at a distance, which a mesh may miss.
    #[inline(never)]
    pub(super) fn around(&mut self, report: &Report) -> Result<(), IntersectError> {
        for found in report.list().filter(|f| !f.touches) {
            for k in 0..4 {
                let Some(at) = self.beside(found.at, k >> 1, k & 1 == 0) else { continue };
                let Some(spot) = self.pair.nearest(at).filter(|s| s.sine > SINGULAR) else { continue };
                if self.pair.inside(spot.at, 0) && !self.is_covered(spot.point) {
                    self.follow(Locus::Crossing, &spot)?;
                }
            }
        }
        Ok(())
    }

    /// Where a small curve round a contact would pass its axis `k`, on either side.
    #[inline(never)]
    fn beside(&self, at: Places, k: usize, ahead: bool) -> Option<Places> {
        let contact = Contact::new(self.pair, at)?;
        let square = -(contact.gap.shl(1)) / contact.curvatures[k & 1];
        if !square.is_positive() || square > self.cell.square().shl(8) {
            return None;
        }
        let by = square.sqrt() * if ahead { Real::ONE } else { -Real::ONE };
        Some(Pair::followed(contact.at, &contact.rates(contact.axes[k & 1]), by))
    }
}
