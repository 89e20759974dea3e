//! The loop-free test: pairs of parts that do not meet, or meet without any closed curve inside; and what is left.
//!
//! Two parts are apart if a plane across x, y, z or either axis of normals lies between their hulls. Where each turns less
//! than 90 degrees and no normal of one is parallel to one of the other, they meet in no closed curve and touch nowhere
//! (Sinha, Klassen, Wang 1985; Sederberg, Christiansen, Katz 1989). Others are halved, the longer one first. Where both are
//! nearly flat, a search for a point with collinear normals tells what keeps them from being decided.

use super::cells::Cells;
use super::contact::{Contact, Form};
use super::newton::{Pair, Places};
use super::part::{Meeting, Part, Region};
use crate::num::Real;

/// Halvings of a part at most.
const DEEPEST: u8 = 11;
pub(super) const STACK: usize = 3 * 2 * DEEPEST as usize + 2;
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
        let Some(place) = self.contacts.get_mut(self.count) else { return false };
        *place = Some(found);
        self.count += 1;
        true
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

struct Search<'s, 'a, 'c, F> {
    pair: &'s Pair<'a>,
    cells: &'s mut Cells<'c>,
    known: F,
    report: Report,
}

impl<F: FnMut(Query<'_>) -> bool> Search<'_, '_, '_, F> {
    fn judge(&mut self, a: &mut Part, b: &mut Part, regions: [Region; 2]) -> Verdict {
        let [over_a, over_b] = regions;
        match a.meeting(b) {
            Meeting::Apart => return Verdict::Decided,
            Meeting::Through => {
                self.cells.enter(regions);
                return Verdict::Decided;
            }
            Meeting::Any if !(a.cone.is_narrow() && b.cone.is_narrow()) => return Verdict::Open,
            Meeting::Any => {}
        }
        let level = over_a.level.min(over_b.level);
        if level >= 4 {
            let near = |f: &Found| f.touches && over_a.holds(f.at[0], 0) && over_b.holds(f.at[1], 0);
            if self.report.list().any(near) {
                return Verdict::Explained;
            }
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

    /// Looks for a point with collinear normals near a pair; true if it lies on a curve that is known.
    fn search(&mut self, a: &Part, b: &Part, [over_a, over_b]: [Region; 2]) -> bool {
        let known = |f: &Found| over_a.holds(f.at[0], 1) && over_b.holds(f.at[1], 1);
        if self.report.list().any(known) {
            return false;
        }
        let mut at = [over_a.centre(self.pair.sheets[0].triangle), over_b.centre(self.pair.sheets[1].triangle)];
        let size = a.extent().min(b.extent());
        // B's foot under A's centre, before anything is judged.
        let centre = self.pair.sheets[0].eval(at[0], 0);
        if let Some((foot, _)) = centre.and_then(|jet| self.pair.foot(1, at[1], jet.point)) {
            at[1] = foot;
        }
        let Some(contact) = self.pair.critical(at, size.shl(1)) else { return false };
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

/// Runs the test on at most `budget` pairs; `known` answers what is known of tangencies.
#[inline(never)]
pub(super) fn test(
    pair: &Pair<'_>,
    budget: u32,
    cells: &mut Cells<'_>,
    known: impl FnMut(Query<'_>) -> bool,
) -> Report {
    let report = Report { contacts: [None; CONTACTS], count: 0, undecided: 0, visited: 0 };
    let mut search = Search { pair, cells, known, report };
    let mut stack = [[Region::ROOT; 2]; STACK];
    let mut height = 1;
    let mut parts = [Part::BLANK; 2];
    while height > 0 {
        height -= 1;
        let Some(regions) = stack.get(height).copied() else { break };
        if search.report.visited >= budget {
            search.report.undecided = search.report.undecided.saturating_add(height as u32 + 1);
            break;
        }
        search.report.visited += 1;
        for ((part, region), sheet) in parts.iter_mut().zip(regions).zip(&pair.sheets) {
            if part.region != Some(region) {
                part.load(sheet, region);
            }
        }
        let [a, b] = &mut parts;
        match search.judge(a, b, regions) {
            Verdict::Decided => continue,
            Verdict::Explained => {
                search.report.undecided = search.report.undecided.saturating_add(1);
                continue;
            }
            Verdict::Open => {}
        }
        if regions.iter().all(|r| r.level >= DEEPEST) {
            search.report.undecided = search.report.undecided.saturating_add(1);
            continue;
        }
        halve(pair, &parts, regions, &mut stack, &mut height);
    }
    search.report
}

/// Puts the quarters of the larger part, each with the other, on a stack; nothing where both are as small as they get.
pub(super) fn halve(
    pair: &Pair<'_>,
    parts: &[Part; 2],
    regions: [Region; 2],
    stack: &mut [[Region; 2]; STACK],
    height: &mut usize,
) {
    let ends = regions.map(|r| r.level >= DEEPEST);
    if ends[0] && ends[1] {
        return;
    }
    let split = usize::from(ends[0] || (!ends[1] && parts[1].size() > parts[0].size()));
    for quarter in regions[split & 1].quarters(pair.sheets[split & 1].triangle) {
        if let Some(place) = stack.get_mut(*height) {
            *place = regions;
            place[split & 1] = quarter;
            *height += 1;
        }
    }
}
