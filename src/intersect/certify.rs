//! The loop-free test: pairs of parts that do not meet, or meet without any closed curve inside; and what is left.
//!
//! Two parts are apart if a plane across x, y, z or either axis of normals lies between their hulls. Where each turns less
//! than 90 degrees and no normal of one is parallel to one of the other, they meet in no closed curve and touch nowhere
//! (Sinha, Klassen, Wang 1985; Sederberg, Christiansen, Katz 1989). Others are halved, the longer one first. Where both are
//! nearly flat, a search for a point with collinear normals tells what keeps them from being decided.

use super::contact::{Contact, Form};
use super::newton::{Pair, Places};
use super::part::{Part, Region};
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

/// What the test left.
#[derive(Debug)]
pub(super) struct Report {
    pub(super) contacts: [Option<Found>; CONTACTS],
    pub(super) count: usize,
    /// Pairs that are not decided.
    pub(super) undecided: u32,
    pub(super) visited: u32,
}

impl Report {
    pub(super) fn list(&self) -> impl Iterator<Item = &Found> {
        self.contacts.iter().flatten()
    }

    /// Enters a contact unless it is known; false if there is no room.
    fn enter(&mut self, found: Found) -> bool {
        let close = |a: &Places, b: &Places| (0..2).all(|s| (0..2).all(|k| (a[s][k] - b[s][k]).abs() <= 1 << 24));
        if self.list().any(|known| close(&known.at, &found.at)) {
            return true;
        }
        if let Some(place) = self.contacts.get_mut(self.count) {
            *place = Some(found);
            self.count += 1;
            return true;
        }
        // A tangency is worth more than a hint.
        let hint = self.contacts.iter_mut().find(|c| found.touches && c.is_some_and(|c| !c.touches));
        hint.map(|place| *place = Some(found)).is_some()
    }
}

/// A question about what is known.
#[derive(Debug)]
pub(super) enum Query<'q> {
    /// Whether a contact lies on a curve that was found; it may be followed first.
    Contact(&'q Contact),
    /// Whether a curve along which the surfaces touch passes within a distance of a point.
    Near([i64; 3], Real),
}

/// What is known of a pair.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Verdict {
    /// Apart, or without closed curves.
    Decided,
    /// To be halved.
    Open,
    /// Near a tangency that is known.
    Explained,
}

struct Search<'s, 'a, F> {
    pair: &'s Pair<'a>,
    known: F,
    report: Report,
}

impl<F: FnMut(Query<'_>) -> bool> Search<'_, '_, F> {
    fn judge(&mut self, a: &mut Part, b: &mut Part, regions: [Region; 2]) -> Verdict {
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
        if level >= 4 && self.touching_in(regions) > 0 {
            self.probe(a, b, regions);
            if self.touching_in(regions) == 1 || level >= 7 {
                return Verdict::Explained;
            }
            return Verdict::Open;
        }
        if level >= 6 {
            let centre = self.pair.sheets[0].eval(over_a.centre(self.pair.sheets[0].triangle), 0);
            let reach = a.extent().max(b.extent()).shl(1);
            if centre.is_some_and(|jet| (self.known)(Query::Near(jet.point, reach))) {
                return Verdict::Explained;
            }
        }
        let flat = Real::new(7, -4);
        if a.cone.sine < flat && b.cone.sine < flat && self.search(a, b, regions) {
            return Verdict::Explained;
        }
        Verdict::Open
    }

    /// Halves pairs that are not decided down to a level, while there is budget; true if none is left.
    fn descend(&mut self, deepest: u8, budget: u32) -> bool {
        let mut stack = [[Region::ROOT; 2]; STACK];
        let mut height = 1;
        let mut parts = [Part::BLANK; 2];
        let mut left = 0_u32;
        while height > 0 {
            height -= 1;
            let Some(regions) = stack.get(height).copied() else { break };
            if self.report.visited >= budget {
                left = left.saturating_add(height as u32 + 1);
                break;
            }
            self.report.visited += 1;
            for ((part, region), sheet) in parts.iter_mut().zip(regions).zip(&self.pair.sheets) {
                if part.region != Some(region) {
                    part.load(sheet, region);
                }
            }
            let [a, b] = &mut parts;
            let verdict = self.judge(a, b, regions);
            let ends = regions.map(|r| r.level >= deepest);
            if verdict == Verdict::Decided {
                continue;
            }
            if verdict == Verdict::Explained || (ends[0] && ends[1]) {
                left = left.saturating_add(1);
                continue;
            }
            let split = usize::from(ends[0] || (!ends[1] && parts[1].size() > parts[0].size()));
            for quarter in regions[split].quarters(self.pair.sheets[split].triangle) {
                if let Some(place) = stack.get_mut(height) {
                    *place = regions;
                    place[split] = quarter;
                    height += 1;
                }
            }
        }
        self.report.undecided = self.report.undecided.saturating_add(left);
        left == 0
    }

    /// Tangencies known in a pair.
    fn touching_in(&self, [over_a, over_b]: [Region; 2]) -> usize {
        self.report.list().filter(|f| f.touches && over_a.holds(f.at[0], 0) && over_b.holds(f.at[1], 0)).count()
    }

    /// Looks for a second tangency in a pair with one, from the quarters of A's part.
    fn probe(&mut self, a: &Part, b: &Part, [over_a, over_b]: [Region; 2]) {
        let size = a.extent().min(b.extent());
        let triangle = self.pair.sheets[0].triangle;
        for quarter in over_a.quarters(triangle) {
            let at = [quarter.centre(triangle), over_b.centre(self.pair.sheets[1].triangle)];
            let Some(contact) = self.contact_near(at, size) else { continue };
            let touches = contact.apart.norm() <= self.pair.touching();
            let near = over_a.holds(contact.at[0], 1) && over_b.holds(contact.at[1], 1);
            if near && touches && self.pair.inside(contact.at, 1 << 20) {
                self.report.enter(Found { at: contact.at, form: contact.form(), touches });
            }
        }
    }

    /// The point with collinear normals near a place of A, no farther than twice a size, from B's foot under it.
    fn contact_near(&self, mut at: Places, size: Real) -> Option<Contact> {
        let centre = self.pair.sheets[0].eval(at[0], 0);
        if let Some((foot, _)) = centre.and_then(|jet| self.pair.foot(1, at[1], jet.point)) {
            at[1] = foot;
        }
        self.pair.critical(at, size.shl(1))
    }

    /// Looks for a point with collinear normals near a pair; true if it lies on a curve that is known.
    fn search(&mut self, a: &Part, b: &Part, [over_a, over_b]: [Region; 2]) -> bool {
        let known = |f: &Found| over_a.holds(f.at[0], 1) && over_b.holds(f.at[1], 1);
        if self.report.list().any(known) {
            return false;
        }
        let at = [over_a.centre(self.pair.sheets[0].triangle), over_b.centre(self.pair.sheets[1].triangle)];
        let Some(contact) = self.contact_near(at, a.extent().min(b.extent())) else { return false };
        let near = over_a.holds(contact.at[0], 1) && over_b.holds(contact.at[1], 1);
        if !near {
            return false;
        }
        let touches = contact.apart.norm() <= self.pair.touching();
        let inside = self.pair.inside(contact.at, 1 << 20);
        if touches && inside && (self.known)(Query::Contact(&contact)) {
            return true;
        }
        if !inside {
            return false;
        }
        // Those at a distance are hints where small curves may be; the pair itself is halved on.
        if !self.report.enter(Found { at: contact.at, form: contact.form(), touches }) && touches {
            self.report.undecided = self.report.undecided.saturating_add(1);
        }
        false
    }
}

/// Levels of the first pass, which looks for tangencies all over before the second goes deep anywhere.
const SHALLOW: u8 = 6;

/// Runs the test on at most `budget` pairs; `known` answers what is known of tangencies.
#[inline(never)]
pub(super) fn test(pair: &Pair<'_>, budget: u32, known: impl FnMut(Query<'_>) -> bool) -> Report {
    let report = Report { contacts: [None; CONTACTS], count: 0, undecided: 0, visited: 0 };
    let mut search = Search { pair, known, report };
    let is_decided = search.descend(SHALLOW, budget / 2);
    if !is_decided {
        search.report.undecided = 0;
        search.descend(DEEPEST, budget);
    }
    search.report
}
