//! Following a curve from a spot: predictor, corrector, and the judgement of every piece.
//!
//! Three points in a row judge two pieces: the distance of the middle one from the Hermite piece through its neighbours is
//! sixteen times what either piece may have. So nothing is evaluated for the judgement alone.

use super::contact::Contact;
use super::curve::{Branch, Curve, CurvePoint, End};
use super::hermite::Piece;
use super::newton::{Pair, Places, Spot, difference, moved, shifted};
use super::sheet::{Jet, ONE, Place};
use super::vector::V3;
use super::{Buffer, IntersectError};
use crate::num::Real;

/// What a curve is a set of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Locus {
    /// Points where the surfaces cross.
    Crossing,
    /// Points where they touch along a curve.
    Ridge,
    /// Points of an edge of a patch that lies on the other.
    Edge { side: usize, edge: usize },
}

/// Pieces between two points are halved this often at most.
const HALVINGS: usize = 20;

/// Distance from a border that counts as none, in units of 2^-48 of the parameters.
pub(super) const BORDER: i64 = 1 << 14;

/// The results under construction, in the caller's buffers.
#[derive(Debug)]
pub(super) struct Output<'b> {
    pub(super) points: &'b mut [CurvePoint],
    pub(super) used: usize,
    pub(super) curves: &'b mut [Curve],
    pub(super) curve_count: usize,
    pub(super) branches: &'b mut [Branch],
    pub(super) branch_count: usize,
    /// Pieces of the curve in hand that were not brought within the tolerance.
    pub(super) unrefined: u32,
    /// Points at the end of the buffer that are set aside.
    pub(super) aside: usize,
}

impl Output<'_> {
    #[inline(never)]
    pub(super) fn emit(&mut self, spot: &Spot) -> Result<(), IntersectError> {
        let given = self.points.len();
        let full = IntersectError::Buffer { buffer: Buffer::Points, needed: self.used + self.aside + 1, given };
        let room = given.saturating_sub(self.aside);
        *self.points.get_mut(..room).and_then(|points| points.get_mut(self.used)).ok_or(full)? = CurvePoint::of(spot);
        self.used += 1;
        Ok(())
    }

    /// Keeps a spot at the end of the buffer of points, until it is taken back.
    pub(super) fn set_aside(&mut self, spot: &Spot) -> Result<(), IntersectError> {
        let given = self.points.len();
        let needed = self.used + self.aside + 1;
        let full = IntersectError::Buffer { buffer: Buffer::Points, needed, given };
        let free = self.points.get_mut(self.used..).and_then(|points| points.iter_mut().rev().nth(self.aside));
        *free.ok_or(full)? = CurvePoint::of(spot);
        self.aside += 1;
        Ok(())
    }

    /// Takes back the spot set aside last.
    pub(super) fn take_back(&mut self) -> Option<CurvePoint> {
        self.aside = self.aside.checked_sub(1)?;
        self.points.iter().rev().nth(self.aside).copied()
    }

    pub(super) fn finished(&self) -> &[Curve] {
        self.curves.get(..self.curve_count).unwrap_or(&[])
    }

    pub(super) fn points_of(&self, curve: &Curve) -> &[CurvePoint] {
        self.points.get(curve.first..curve.first + curve.count).unwrap_or(&[])
    }

    pub(super) fn branches(&self) -> &[Branch] {
        self.branches.get(..self.branch_count).unwrap_or(&[])
    }
}

impl Spot {
    /// The spot with its tangent along or against nA × nB.
    pub(super) fn oriented(mut self, forward: bool) -> Self {
        if !forward {
            self.tangent = -self.tangent;
            self.rates = self.rates.map(|r| r.map(|c| -c));
        }
        self
    }

    /// The spot with its tangent along a direction.
    pub(super) fn along(self, direction: V3) -> Self {
        let forward = !self.tangent.dot(direction).is_negative();
        self.oriented(forward)
    }
}

/// Follows curves of one locus in one orientation.
#[derive(Clone, Copy, Debug)]
pub(super) struct Tracer<'t, 'a> {
    pub(super) pair: &'t Pair<'a>,
    pub(super) locus: Locus,
    /// Whether tangents are along nA × nB.
    pub(super) forward: bool,
    /// What Hermite pieces may miss the curve by.
    pub(super) tolerance: Real,
}

/// How a walk ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Stop {
    Border,
    Closed,
    Branch(usize),
    Lost,
}

impl Tracer<'_, '_> {
    /// The point of the locus in the plane through `c` with normal `plane`, near `at`.
    #[inline(never)]
    fn solve(&self, at: Places, c: [i64; 3], plane: V3) -> Option<Spot> {
        match self.locus {
            Locus::Crossing => Some(self.pair.in_plane(at, c, plane)?.oriented(self.forward)),
            Locus::Ridge => Some(self.pair.on_ridge(at, c, plane)?.along(plane)),
            Locus::Edge { .. } => None,
        }
    }

    /// A point of the locus about halfway between two, with its tangent along the chord.
    #[inline(never)]
    fn between(&self, p: &Spot, q: &Spot, piece: &Piece) -> Option<Spot> {
        if let Locus::Edge { side, edge } = self.locus {
            let sheet = &self.pair.sheets[side & 1];
            let [a, b] = [p, q].map(|s| sheet.edge_parameter(edge, s.at[side & 1]));
            let near = both!(|k| middle_place(p.at[1 - (side & 1)], q.at[1 - (side & 1)])[k]);
            return Some(self.pair.edge_spot(side, edge, (a + b) >> 1, near)?.along(difference(q.point, p.point)));
        }
        let eighth = piece.arc().shl(-3);
        let at = both!(|s| {
            let bend = both!(|k| (p.rates[s][k] - q.rates[s][k]) * eighth);
            shifted(middle_place(p.at[s], q.at[s]), bend)
        });
        let chord = difference(q.point, p.point);
        let spot = self.solve(at, moved(p.point, piece.middle()), chord.unit())?;
        spot.tangent.dot(chord).is_positive().then_some(spot)
    }

    /// Writes the points after `p` up to and with `q`, or without it; halves pieces until they are within the tolerance.
    pub(super) fn connect(
        &self,
        out: &mut Output<'_>,
        p: &Spot,
        q: &Spot,
        with_last: bool,
    ) -> Result<(), IntersectError> {
        let mut stack = [*q; HALVINGS];
        let mut height = 1;
        let mut from = *p;
        while height > 0 {
            let Some(to) = stack.get(height - 1).copied() else { return Err(IntersectError::Internal) };
            let piece = Piece::new(&from, &to);
            let tiny = piece.arc() <= self.pair.extent.shl(-26);
            let found = if tiny { None } else { self.between(&from, &to, &piece) };
            match found {
                Some(spot) if piece.error(spot.point) <= self.tolerance.shl(3) => out.emit(&spot)?,
                Some(spot) if height < HALVINGS => {
                    if let Some(place) = stack.get_mut(height) {
                        *place = spot;
                    }
                    height += 1;
                    continue;
                }
                _ => out.unrefined += u32::from(!tiny),
            }
            height -= 1;
            if height > 0 || with_last {
                out.emit(&to)?;
            }
            from = to;
        }
        Ok(())
    }

    /// The next spot along the tangent, if the curve does not turn too much on the way.
    #[inline(never)]
    fn advance(&self, p: &Spot, h: Real, before: Option<&Spot>) -> Option<Spot> {
        let mut at = Pair::followed(p.at, &p.rates, h);
        if let Some(before) = before {
            // The rates' own rate of change carries on.
            let gone = difference(p.point, before.point).norm();
            let factor = h.square() / gone.shl(1);
            at = both!(|s| shifted(at[s], both!(|k| (p.rates[s][k] - before.rates[s][k]) * factor)));
        }
        let q = self.solve(at, moved(p.point, p.tangent * h), p.tangent)?;
        let chord = difference(q.point, p.point);
        let turn = Real::ONE - Real::power(-4);
        let length = chord.norm();
        let straight = q.tangent.dot(p.tangent) > turn && q.tangent.dot(chord) > length * turn;
        (straight && length < h * Real::int(2)).then_some(q)
    }

    /// Whether a target lies ahead of a spot, and how far: at most `reach`, not farther aside than a quarter.
    fn ahead(p: &Spot, target: [i64; 3], reach: Real) -> Option<Real> {
        let d = difference(target, p.point);
        let along = d.dot(p.tangent);
        let aside = d.square() - along.square();
        (along.is_positive() && along <= reach && aside <= along.square().shl(-4)).then_some(along)
    }

    /// Emits the piece to a target on the curve; false if it would have to be halved.
    #[inline(never)]
    fn join(&self, out: &mut Output<'_>, p: &Spot, target: &Spot, with_last: bool) -> Result<bool, IntersectError> {
        let piece = Piece::new(p, target);
        if piece.arc() > self.pair.extent.shl(-18) {
            let Some(spot) = self.between(p, target, &piece) else { return Ok(false) };
            if piece.error(spot.point) > self.tolerance.shl(3) {
                return Ok(false);
            }
            out.emit(&spot)?;
        }
        if with_last {
            out.emit(target)?;
        }
        Ok(true)
    }

    /// The branch ahead within `reach`: its index, the arm on which the curve comes, the spot there, the distance.
    #[inline(never)]
    fn branch_ahead(&self, out: &Output<'_>, p: &Spot, reach: Real) -> Option<(usize, usize, Spot, Real)> {
        for (b, branch) in out.branches().iter().enumerate() {
            let Some(distance) = Self::ahead(p, branch.point.bits(), reach) else { continue };
            let come = (0..4).map(|arm| (arm, -branch.direction(arm).dot(p.tangent)));
            let (arm, cosine) = come.fold((0, -Real::ONE), |best, c| if c.1 > best.1 { c } else { best });
            if cosine < Real::ONE - Real::power(-2) {
                continue;
            }
            let direction = -branch.direction(arm);
            let Some(contact) = Contact::new(self.pair, branch.point.places()) else { continue };
            let mut spot = contact.spot(self.pair);
            (spot.tangent, spot.rates) = (direction, contact.rates(direction));
            spot.point = branch.point.bits();
            return Some((b, arm, spot, distance));
        }
        None
    }

    /// Ends a walk in the branch ahead, if there is one within two steps and the piece to it will do; else shortens the step.
    #[inline(never)]
    fn end_in_branch(&self, out: &mut Output<'_>, p: &mut Spot, h: &mut Real) -> Result<Option<Stop>, IntersectError> {
        // Where the walk leads away from a branch, that branch is behind: `ahead` looks forward only.
        let Some((b, arm, spot, distance)) = self.branch_ahead(out, p, h.shl(1)) else { return Ok(None) };
        if self.join(out, p, &spot, true)? || distance <= self.pair.extent.shl(-24) {
            if let Some(branch) = out.branches.get_mut(b) {
                branch.taken[arm & 3] = true;
            }
            *p = spot;
            return Ok(Some(Stop::Branch(b)));
        }
        *h = (*h).min(distance.shl(-1));
        Ok(None)
    }

    /// Ends a walk on the border between a spot inside and one outside, if the piece to it will do: whether it did, or `None`
    /// where there is no border between.
    #[inline(never)]
    fn end_on_border(
        &self,
        out: &mut Output<'_>,
        p: &mut Spot,
        q: &Spot,
        is_start: bool,
        small: bool,
    ) -> Result<Option<bool>, IntersectError> {
        let Some(end) = self.leave(p, q) else { return Ok(None) };
        let moves = difference(end.point, p.point).norm() > self.shortest().shl(6);
        // Without a move it is the border where the curve began: it leaves again within the step.
        let done = if moves { self.join(out, p, &end, true)? || small } else { !is_start || small };
        if done {
            *p = end;
        }
        Ok(Some(done))
    }

    /// Writes the middle of the first piece and its end if the piece will do: the middle.
    #[inline(never)]
    fn first_piece(&self, out: &mut Output<'_>, p: &Spot, q: &Spot) -> Result<Option<Spot>, IntersectError> {
        let piece = Piece::new(p, q);
        let middle = self.between(p, q, &piece).filter(|spot| piece.error(spot.point) <= self.tolerance.shl(3));
        if let Some(spot) = &middle {
            out.emit(spot)?;
            out.emit(q)?;
        }
        Ok(middle)
    }

    /// The error of either of the pieces between three spots, and the arc of the first.
    #[inline(never)]
    fn error(b: &Spot, p: &Spot, q: &Spot) -> (Real, Real) {
        let [one, two] = [Piece::new(b, p).arc(), Piece::new(p, q).arc()];
        let share = one.max(two) / (one + two);
        (Piece::new(b, q).error(p.point) * share.square().square(), one)
    }

    /// The shortest step.
    fn shortest(&self) -> Real {
        self.pair.extent.shl(-32)
    }

    /// Walks from a spot that is emitted already, emitting what follows; `p` becomes the last spot, but for a closed curve.
    /// `origin`: where the curve began, to close it.
    #[inline(never)]
    pub(super) fn walk(
        &self,
        out: &mut Output<'_>,
        p: &mut Spot,
        origin: Option<&Spot>,
    ) -> Result<Stop, IntersectError> {
        let longest = self.pair.extent.shl(-2);
        let shortest = self.shortest();
        let mut h = self.pair.extent.shl(-6);
        let mut before: Option<Spot> = None;
        let mut steps = 0_u32;
        loop {
            if let Some(stop) = self.end_in_branch(out, p, &mut h)? {
                return Ok(stop);
            }
            let home = origin.filter(|o| steps >= 3 && p.tangent.dot(o.tangent) > Real::power(-1));
            let ahead = home.and_then(|o| Some((o, Self::ahead(p, o.point, h + h.shl(-1))?)));
            if let Some((origin, distance)) = ahead {
                if self.join(out, p, origin, false)? {
                    return Ok(Stop::Closed);
                }
                h = h.min(distance.shl(-1));
            }
            if h < shortest {
                return Ok(Stop::Lost);
            }
            let Some(q) = self.advance(p, h, before.as_ref()) else {
                h = h.shl(-1);
                continue;
            };
            if !self.pair.inside(q.at, 0) {
                match self.end_on_border(out, p, &q, steps == 0, h < shortest.shl(8))? {
                    Some(true) => return Ok(Stop::Border),
                    None if !self.pair.inside(p.at, 4) && h <= shortest.shl(8) => return Ok(Stop::Lost),
                    _ => h = h.shl(-1),
                }
                continue;
            }
            if let Some(b) = &before {
                let (error, one) = Self::error(b, p, &q);
                let allowed = self.tolerance.shl(-1);
                if error > allowed {
                    h = h.shl(-1);
                    if h.shl(1) < one {
                        // What is behind was judged already: from here the next piece is judged alone.
                        before = None;
                    }
                    continue;
                }
                out.emit(&q)?;
                before = Some(*p);
                if error.shl(5) < allowed {
                    h = h.shl(1);
                } else if error.shl(1) < allowed {
                    h = h + h.shl(-3);
                } else {
                    h = h - h.shl(-4);
                }
                h = h.min(longest);
            } else {
                before = self.first_piece(out, p, &q)?;
                if before.is_none() {
                    h = h.shl(-1);
                    continue;
                }
            }
            *p = q;
            steps += 1;
        }
    }

    /// Where the curve from a spot inside to one outside leaves the domain of either patch.
    #[inline(never)]
    fn leave(&self, p: &Spot, q: &Spot) -> Option<Spot> {
        let slack = BORDER;
        let mut best: Option<(Real, Spot)> = None;
        for side in 0..2 {
            let sheet = &self.pair.sheets[side];
            for edge in 0..sheet.edge_count() {
                let (from, to) = (sheet.inset(edge, p.at[side]), sheet.inset(edge, q.at[side]));
                if to >= 0 {
                    continue;
                }
                let share = Real::int(from.max(0)) / Real::int(from.max(0) - to);
                let at = both!(|s| {
                    let step = both!(|k| Real::new(q.at[s][k] - p.at[s][k], -48) * share);
                    shifted(p.at[s], step)
                });
                let found = match self.locus {
                    Locus::Crossing => self.pair.on_edge(side, edge, at).map(|s| s.oriented(self.forward)),
                    _ => self.ridge_on_edge(side, edge, p, q),
                };
                let Some(spot) = found.filter(|s| self.pair.inside(s.at, slack)) else { continue };
                let along = difference(spot.point, p.point).dot(p.tangent);
                let length = difference(q.point, p.point).norm();
                let sound = along >= -length.shl(-10) && along <= length * Real::int(2);
                if sound && best.is_none_or(|(least, _)| along < least) {
                    best = Some((along, spot));
                }
            }
        }
        best.map(|(_, spot)| spot)
    }

    /// The same along a ridge, by halving: a ridge has no simple equation with an edge.
    #[inline(never)]
    fn ridge_on_edge(&self, side: usize, edge: usize, p: &Spot, q: &Spot) -> Option<Spot> {
        let sheet = &self.pair.sheets[side];
        let (mut low, mut high) = (*p, *q);
        for _ in 0..60 {
            let [a, b] = [low, high].map(|s| Real::int(sheet.inset(edge, s.at[side])));
            if b.is_zero() || high.at == low.at {
                break;
            }
            let share = (a / (a - b)).max(Real::power(-6)).min(Real::ONE - Real::power(-6));
            let chord = difference(high.point, low.point);
            let at = both!(|s| shifted(low.at[s], both!(|k| Real::new(high.at[s][k] - low.at[s][k], -48) * share)));
            let spot = self.solve(at, moved(low.point, chord * share), p.tangent)?;
            let inset = sheet.inset(edge, spot.at[side]);
            if inset.abs() <= 4 {
                high = spot;
                break;
            }
            if inset > 0 { low = spot } else { high = spot }
        }
        Some(high)
    }
}

impl Pair<'_> {
    /// The spot of an edge's parameter, with its foot on the other patch searched from `near`; the tangent is the edge's.
    #[inline(never)]
    pub(super) fn edge_spot(&self, side: usize, edge: usize, parameter: i64, near: Place) -> Option<Spot> {
        let (one, other) = (side & 1, 1 - (side & 1));
        let sheet = &self.sheets[one];
        let mut jets = [Jet::BLANK; 2];
        let mut at = [sheet.edge_place(edge, parameter); 2];
        sheet.eval_to(at[one], 1, &mut jets[one])?;
        at[other] = self.foot_to(other, near, jets[one].point, &mut jets[other])?;
        let [a, b] = sheet.edge_direction(edge).map(Real::int);
        let mut spot = self.spot(at, &jets);
        spot.tangent = (jets[one].first[0] * a + jets[one].first[1] * b).unit();
        spot.rates = both!(|s| super::newton::pull_back(&jets[s].first, jets[s].normal(), spot.tangent));
        Some(spot)
    }

    /// The end of a curve at a spot on a border.
    pub(super) fn end(&self, at: Places) -> End {
        use super::curve::Side;
        let slack = ONE >> 30;
        for (side, place) in Side::BOTH.into_iter().zip(at) {
            if let Some(corner) = self.sheets[side as usize].corner(place, slack) {
                return End::Corner { side, corner };
            }
        }
        for (side, place) in Side::BOTH.into_iter().zip(at) {
            if let Some(edge) = self.sheets[side as usize].edge_at(place, slack) {
                return End::Edge { side, edge };
            }
        }
        End::Lost
    }
}

pub(super) fn middle_place(a: Place, b: Place) -> Place {
    let [u, v] = both!(|k| (a[k] + b[k]) >> 1);
    [u, v]
}
