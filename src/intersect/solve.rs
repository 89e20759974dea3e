//! From seeds to curves: borders, contacts, arms of branches, and every chain of the mesh that no curve covers yet.

use super::cells::{self, Cells};
use super::certify::{self, Query, Report};
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

impl Solver<'_, '_, '_> {
    /// Whether a point lies on a curve that is known.
    fn is_covered(&self, point: [i64; 3]) -> bool {
        let slack = self.tolerance.shl(3).max(self.pair.extent.shl(-26));
        self.out.finished().iter().any(|c| on_pieces(self.out.points_of(c), c.closed, point, slack))
    }

    /// Whether a singular spot is explained by a branch, a touching point or a curve of contact within some cells.
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
        let cosine = a.normal().unit().dot(b.normal().unit()).abs();
        self.pair.inside([u, v], 0)
            && difference(a.point, b.point).norm() <= self.pair.touching()
            && cosine > Real::ONE - Real::power(-10)
    }

    /// Whether a point within a region lies on both surfaces, which are parallel there.
    fn is_coincident(&self, point: [i64; 3], near: usize) -> bool {
        let Some(border) = self.out.points.get(near) else { return false };
        let feet = both!(|s| self.pair.foot(s, border.places()[s], point));
        let [Some((_, a)), Some((_, b))] = feet else { return false };
        let cosine = a.normal().unit().dot(b.normal().unit()).abs();
        cosine > Real::ONE - Real::power(-10)
    }

    /// Whether the curve at a spot goes on inside both patches, in the spot's direction.
    fn leads_inside(&self, spot: &Spot) -> bool {
        let step = self.pair.extent.shl(-14);
        self.pair.inside(Pair::followed(spot.at, &spot.rates, step), BORDER)
    }

    fn stop(&mut self, stop: Stop, spot: &Spot) -> End {
        match stop {
            Stop::Border => self.pair.end(spot.at),
            Stop::Branch(branch) => End::Branch { branch: branch as u16 },
            Stop::Closed => End::None,
            Stop::Lost => {
                self.undecided += 1;
                End::Lost
            }
        }
    }

    /// Follows the curve through a spot in both directions and enters it.
    pub(super) fn follow(&mut self, locus: Locus, seed: Spot) -> Result<(), IntersectError> {
        let (open, closed) = match locus {
            Locus::Crossing => (CurveKind::Open, CurveKind::Closed),
            _ => (CurveKind::Tangential, CurveKind::Tangential),
        };
        let first = self.out.used;
        let (ahead, behind) = (seed.oriented(true), seed.oriented(false));
        let (forward, backward) = (self.leads_inside(&ahead), self.leads_inside(&behind));
        let pair = self.pair;
        let tracer = |forward| Tracer { pair, locus, forward, tolerance: self.tolerance };
        let (one, two) = (tracer(true), tracer(false));
        if !forward && !backward {
            return self.touch(&seed);
        }
        let (walker, start, back) = if forward { (one, ahead, behind) } else { (two, behind, ahead) };
        self.out.emit(&start)?;
        let (stop, spot) = walker.walk(&mut self.out, start, Some(&start))?;
        if stop == Stop::Closed {
            return self.out.finish(closed, true, [End::None; 2], first);
        }
        let last = self.stop(stop, &spot);
        if !(forward && backward) {
            let begin = pair.end(start.at);
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
        let (stop, spot) = if forward { &two } else { &one }.walk(&mut self.out, back, lost.as_ref())?;
        if stop == Stop::Closed {
            return self.out.finish(closed, true, [End::None; 2], first);
        }
        let end = self.stop(stop, &spot);
        self.out.finish(open, false, [last, end], first)
    }

    /// Runs the loop-free test and enters what its contacts are: touching points, tangential curves, branches.
    /// Keeps the pairs through which curves go.
    pub(super) fn contacts(&mut self, budget: u32, cells: &mut Cells<'_>) -> Result<Report, IntersectError> {
        let mut failure = Ok(());
        let pair = self.pair;
        let report = certify::test(pair, budget, cells, |query| {
            let contact = match query {
                Query::Contact(contact) => contact,
                Query::Near(point, reach) => return self.touches_near(point, reach),
            };
            let spot = contact.spot(pair);
            if self.is_covered(spot.point) {
                return true;
            }
            if contact.form() != Form::Ridge || failure.is_err() {
                return false;
            }
            let count = self.out.curve_count;
            failure = self.follow(Locus::Ridge, spot);
            // A ridge that is level at one point only is no curve.
            let short =
                self.out.finished().last().is_some_and(|c| c.ends == [End::Lost; 2] && c.length < self.cell_bits());
            if self.out.curve_count > count && short {
                self.out.curve_count = count;
                self.out.used = self.out.curves.get(count).map_or(self.out.used, |c| c.first);
                self.out.unrefined = 0;
                return false;
            }
            true
        });
        failure?;
        self.undecided = self.undecided.saturating_add(report.undecided);
        for found in report.list().filter(|f| f.touches) {
            let Some(contact) = Contact::new(pair, found.at) else { continue };
            let spot = contact.spot(pair);
            if self.is_covered(spot.point) {
                continue;
            }
            match found.form {
                Form::Saddle => self.branch(&contact)?,
                Form::Definite => self.touch(&spot)?,
                Form::Ridge | Form::Flat => self.undecided += 1,
            }
        }
        Ok(report)
    }

    /// Enters a touching point.
    fn touch(&mut self, spot: &Spot) -> Result<(), IntersectError> {
        let first = self.out.used;
        self.out.emit(&Spot { tangent: V3::ZERO, ..*spot })?;
        self.out.finish(CurveKind::TangentPoint, false, [End::None; 2], first)
    }

    /// Enters contacts of a higher order that no curve reached: touching points, as far as can be told.
    pub(super) fn leftovers(&mut self, report: &Report) -> Result<(), IntersectError> {
        for found in report.list().filter(|f| f.touches && matches!(f.form, Form::Ridge | Form::Flat)) {
            let Some(contact) = Contact::new(self.pair, found.at) else { continue };
            let (spot, slack) = (contact.spot(self.pair), self.cell.shl(-1));
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
    fn arm(&self, contact: &Contact, direction: V3) -> Option<(Spot, bool)> {
        let point = contact.spot(self.pair).point;
        let rates = contact.rates(direction);
        for shift in [7, 9, 11, 13, 15] {
            let radius = self.pair.extent.shl(-shift);
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

    /// Enters a branch with its arms.
    fn branch(&mut self, contact: &Contact) -> Result<(), IntersectError> {
        let directions = contact.arms();
        let unit = |c: Real| I2F30::from_bits(c.nearest(30).clamp(-1 << 30, 1 << 30) as i32);
        let mut spot = contact.spot(self.pair);
        spot.tangent = directions[0];
        let mut branch = Branch {
            point: CurvePoint::of(&spot),
            directions: directions.map(|d| Vector3::from_array(d.0.map(unit))),
            ..Branch::BLANK
        };
        for (k, direction) in directions.into_iter().enumerate() {
            if let Some((arm, _)) = self.arm(contact, direction) {
                branch.present[k] = true;
                branch.taken[k] = self.is_covered(arm.point);
            }
        }
        let given = self.out.branches.len();
        let full = IntersectError::Buffer { buffer: Buffer::Branches, needed: given + 1, given };
        *self.out.branches.get_mut(self.out.branch_count).ok_or(full)? = branch;
        self.out.branch_count += 1;
        Ok(())
    }

    /// Follows the arms of all branches.
    pub(super) fn arms(&mut self) -> Result<(), IntersectError> {
        for b in 0..self.out.branch_count {
            let Some(branch) = self.out.branches.get(b).copied() else { continue };
            let Some(contact) = Contact::new(self.pair, branch.point.places()) else { continue };
            for k in 0..4 {
                let free = self.out.branches.get(b).is_some_and(|now| now.present[k] && !now.taken[k]);
                if !free {
                    continue;
                }
                let direction = branch.direction(k);
                let Some((spot, forward)) = self.arm(&contact, direction) else { continue };
                let first = self.out.used;
                let mut origin = contact.spot(self.pair);
                (origin.tangent, origin.rates) = (direction, contact.rates(direction));
                origin.point = branch.point.bits();
                self.out.emit(&origin)?;
                let pair = self.pair;
                let tracer = Tracer { pair, locus: Locus::Crossing, forward, tolerance: self.tolerance };
                tracer.connect(&mut self.out, &origin, &spot, true)?;
                if let Some(branch) = self.out.branches.get_mut(b) {
                    branch.taken[k] = true;
                }
                let (stop, last) = tracer.walk(&mut self.out, spot, None)?;
                let end = self.stop(stop, &last);
                self.out.finish(CurveKind::Open, false, [End::Branch { branch: b as u16 }, end], first)?;
            }
        }
        Ok(())
    }

    /// Follows curves from where the mesh crosses a border.
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
        let mut k = 0;
        while let Some(cell) = cells.get(pair, k) {
            let undecided =
                cells::pass(pair, cell, |spot| if self.is_covered(spot.point) { Ok(()) } else { self.seed(spot.at) })?;
            self.undecided = self.undecided.saturating_add(undecided);
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
            return self.follow(Locus::Crossing, spot);
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
        self.follow(Locus::Crossing, spot)
    }

    /// Follows curves from crossings of chains that no curve covers.
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
        self.follow(Locus::Crossing, spot)?;
        Ok(true)
    }

    /// Follows small curves round contacts at a distance, which a mesh may miss.
    pub(super) fn around(&mut self, report: &Report) -> Result<(), IntersectError> {
        for found in report.list().filter(|f| !f.touches) {
            let Some(contact) = Contact::new(self.pair, found.at) else { continue };
            for k in 0..2 {
                let curvature = contact.curvatures[k];
                let square = -(contact.gap.shl(1)) / curvature;
                if !square.is_positive() || square > self.cell.square().shl(8) {
                    continue;
                }
                for sign in [Real::ONE, -Real::ONE] {
                    let direction = contact.axes[k];
                    let at = Pair::followed(contact.at, &contact.rates(direction), square.sqrt() * sign);
                    let Some(spot) = self.pair.nearest(at).filter(|s| s.sine > SINGULAR) else { continue };
                    if self.pair.inside(spot.at, 0) && !self.is_covered(spot.point) {
                        self.follow(Locus::Crossing, spot)?;
                    }
                }
            }
        }
        Ok(())
    }
}
