//! The loop-free test: pairs of parts that do not meet, or meet without any closed curve inside; and what is left.
//!
//! Two parts are apart if a plane across x, y, z or either axis of normals lies between their hulls. Where each turns less
//! than 90 degrees and no normal of one is parallel to one of the other, they meet in no closed curve and touch nowhere
//! (Sinha, Klassen, Wang 1985; Sederberg, Christiansen, Katz 1989). Others are halved, the longer one first. Where both are
//! nearly flat, a search for a point with collinear normals tells what keeps them from being decided.

use super::contact::{Contact, Form};
use super::newton::{Pair, Places};
use super::part::{Part, Region};
use super::sheet::in_rooms;
use crate::num::Real;

/// Halvings of a part at most.
const DEEPEST: u8 = 11;
const STACK: usize = 3 * 2 * DEEPEST as usize + 2;
/// Points with collinear normals that are kept.
pub(super) const CONTACTS: usize = 24;

/// A point with collinear normals.
#[derive(Clone, Copy, Debug)]
pub(super) struct Found {
    pub(super) at: Places,
    pub(super) form: Form,
    /// Whether the surfaces touch there.
    pub(super) touches: bool,
}

/// What the test left. 1 KB.
#[derive(Debug)]
pub(super) struct Report {
    pub(super) contacts: [Option<Found>; CONTACTS],
    pub(super) count: usize,
    /// Pairs that are not decided.
    pub(super) undecided: u32,
    pub(super) visited: u32,
}

impl Report {
    pub(super) const EMPTY: Self = Self { contacts: [None; CONTACTS], count: 0, undecided: 0, visited: 0 };

    pub(super) fn list(&self) -> impl Iterator<Item = &Found> {
        self.contacts.iter().flatten()
    }

    /// Enters a contact unless it is known; false if there is no room.
    fn enter(&mut self, found: Found) -> bool {
        let close = |a: &Places, b: &Places| (0..2).all(|s| (0..2).all(|k| (a[s][k] - b[s][k]).abs() <= 1 << 24));
        if self.list().any(|known| close(&known.at, &found.at)) {
            return true;
        }
        let Some(place) = self.contacts.get_mut(self.count) else { return false };
        *place = Some(found);
        self.count += 1;
        true
    }

    /// Enters a contact; where the surfaces touch, one without room is counted.
    fn keep(&mut self, found: Found) {
        if !self.enter(found) && found.touches {
            self.undecided = self.undecided.saturating_add(1);
        }
    }
}

/// What is known of a pair.
#[derive(Clone, Copy, Debug)]
enum Verdict {
    /// Apart, or without closed curves.
    Decided,
    /// To be halved.
    Open,
    /// Near a tangency that is known.
    Explained,
    /// The surfaces touch here: explained if this lies on a curve that is known.
    Asks(Found),
}

/// The test between two questions: the pairs that are left. 0.9 KB; parts
/// take up to 5.2 KB more, so they do not stay while a curve is followed.
#[derive(Debug)]
pub(super) struct Search<'s, 'a> {
    pair: &'s Pair<'a>,
    stack: [[Region; 2]; STACK],
    height: usize,
    /// The pair about which was asked, and the contact.
    asked: Option<([Region; 2], Found)>,
}

impl<'s, 'a> Search<'s, 'a> {
    #[inline(always)]
    pub(super) const fn new(pair: &'s Pair<'a>) -> Self {
        Self { pair, stack: [[Region::ROOT; 2]; STACK], height: 1, asked: None }
    }

    /// Runs until all pairs are decided, or `report.visited` has reached `budget`; or until a contact is found of which must
    /// be known whether it lies on a known curve along which the surfaces touch: then run again, with the answer.
    /// `is_near` tells whether such a curve passes within a distance of a point.
    pub(super) fn run(
        &mut self,
        report: &mut Report,
        budget: u32,
        answer: bool,
        is_near: impl Fn([i64; 3], Real) -> bool,
    ) -> Option<Places> {
        let points = self.pair.sheets.iter().fold(0, |most, sheet| most.max(sheet.source.points().len()));
        in_rooms(points, |rooms| self.run_with(rooms.map(Part::new), report, budget, answer, is_near))
    }

    #[inline(never)]
    fn run_with(
        &mut self,
        mut parts: [Part<'_>; 2],
        report: &mut Report,
        budget: u32,
        answer: bool,
        is_near: impl Fn([i64; 3], Real) -> bool,
    ) -> Option<Places> {
        loop {
            let (regions, verdict) = if let Some((regions, found)) = self.asked.take() {
                self.load(&mut parts, regions);
                if !answer {
                    report.keep(found);
                }
                (regions, if answer { Verdict::Explained } else { Verdict::Open })
            } else {
                let height = self.height.checked_sub(1)?;
                let regions = self.stack.get(height).copied()?;
                self.height = height;
                if report.visited >= budget {
                    report.undecided = report.undecided.saturating_add(height as u32 + 1);
                    return None;
                }
                report.visited += 1;
                self.load(&mut parts, regions);
                let [a, b] = &mut parts;
                (regions, self.judge(report, a, b, regions, &is_near))
            };
            match verdict {
                Verdict::Decided => {}
                Verdict::Explained => report.undecided = report.undecided.saturating_add(1),
                Verdict::Open => self.halve(report, &parts, regions),
                Verdict::Asks(found) => {
                    self.asked = Some((regions, found));
                    return Some(found.at);
                }
            }
        }
    }

    fn load(&self, parts: &mut [Part<'_>; 2], regions: [Region; 2]) {
        for ((part, region), sheet) in parts.iter_mut().zip(regions).zip(&self.pair.sheets) {
            if part.region != Some(region) {
                part.load(sheet, region);
            }
        }
    }

    /// Puts the quarters of the larger part, each with the other part, on the stack.
    fn halve(&mut self, report: &mut Report, parts: &[Part<'_>; 2], regions: [Region; 2]) {
        let ends = regions.map(|r| r.level >= DEEPEST);
        if ends[0] && ends[1] {
            report.undecided = report.undecided.saturating_add(1);
            return;
        }
        let split = usize::from(ends[0] || (!ends[1] && parts[1].size() > parts[0].size()));
        for quarter in regions[split].quarters(self.pair.sheets[split].triangle) {
            if let Some(place) = self.stack.get_mut(self.height) {
                *place = regions;
                place[split] = quarter;
                self.height += 1;
            }
        }
    }

    fn judge(
        &self,
        report: &mut Report,
        a: &mut Part<'_>,
        b: &mut Part<'_>,
        regions: [Region; 2],
        is_near: &impl Fn([i64; 3], Real) -> bool,
    ) -> Verdict {
        let [over_a, over_b] = regions;
        if !a.boxes_meet(b) {
            return Verdict::Decided;
        }
        a.aim();
        b.aim();
        for axis in [a.cone.axis, b.cone.axis] {
            if !axis.is_zero() && a.is_apart_along(b, axis) {
                return Verdict::Decided;
            }
        }
        if !(a.cone.is_narrow() && b.cone.is_narrow()) {
            return Verdict::Open;
        }
        if a.cone.is_apart(&b.cone) {
            return Verdict::Decided;
        }
        let level = over_a.level.min(over_b.level);
        if level >= 4 {
            let near = |f: &Found| f.touches && over_a.holds(f.at[0], 0) && over_b.holds(f.at[1], 0);
            if report.list().any(near) {
                return Verdict::Explained;
            }
        }
        if level >= 6 {
            let reach = a.extent().max(b.extent()).shl(1);
            if self.centre(over_a).is_some_and(|point| is_near(point, reach)) {
                return Verdict::Explained;
            }
        }
        let flat = Real::new(7, -4);
        if a.cone.sine < flat && b.cone.sine < flat {
            return self.search(report, a.extent().min(b.extent()), regions);
        }
        Verdict::Open
    }

    /// The point of A in the middle of a region.
    #[inline(never)]
    fn centre(&self, over_a: Region) -> Option<[i64; 3]> {
        let sheet = &self.pair.sheets[0];
        Some(sheet.eval(over_a.centre(sheet.triangle), 0)?.point)
    }

    /// Looks for a point with collinear normals near a pair of parts of this size.
    #[inline(never)]
    fn search(&self, report: &mut Report, size: Real, [over_a, over_b]: [Region; 2]) -> Verdict {
        let known = |f: &Found| over_a.holds(f.at[0], 1) && over_b.holds(f.at[1], 1);
        if report.list().any(known) {
            return Verdict::Open;
        }
        let mut at = [over_a.centre(self.pair.sheets[0].triangle), over_b.centre(self.pair.sheets[1].triangle)];
        // B's foot under A's centre, before anything is judged.
        if let Some(place) = self.centre(over_a).and_then(|point| self.pair.foot_place(1, at[1], point)) {
            at[1] = place;
        }
        let mut contact = Contact::BLANK;
        if self.pair.critical(&mut contact, at, size.shl(1)).is_none() {
            return Verdict::Open;
        }
        let near = over_a.holds(contact.at[0], 1) && over_b.holds(contact.at[1], 1);
        if !near || !self.pair.inside(contact.at, 1 << 20) {
            return Verdict::Open;
        }
        let touches = contact.apart.norm() <= self.pair.touching();
        let found = Found { at: contact.at, form: contact.form(), touches };
        if touches {
            return Verdict::Asks(found);
        }
        // Those at a distance are hints where small curves may be; the pair itself is halved on.
        report.keep(found);
        Verdict::Open
    }
}
