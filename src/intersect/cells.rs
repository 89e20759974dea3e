//! Curves that pass from one pair of parts of the loop-free test to another.
//!
//! In a pair whose normals are apart no curve closes: each goes from a border of one of the parts to a border. So a curve of the
//! intersection either reaches an edge of a patch, all of whose points on the other patch are known, or it passes a border
//! between two parts; and of those each is tested here against the part of the other patch that it was paired with. Where it
//! meets that, a curve must be known, or is followed. Then none is missed, whatever the mesh saw.

use super::IntersectError;
use super::certify::{DEEPEST, STACK, halve, load};
use super::line::Line;
use super::newton::{Pair, Spot};
use super::part::{Meeting, Part, Region};
use super::roots;
use super::sheet::in_rooms;

/// Pairs of parts whose normals are apart, in the order in which they are found.
#[derive(Debug)]
pub(super) struct Cells<'c> {
    list: &'c mut [u64],
    /// How many were found, with or without room.
    count: usize,
    /// How many of them come before the list.
    skipped: usize,
    /// The level at which the test leaves pairs undecided.
    deepest: u8,
}

impl<'c> Cells<'c> {
    pub(super) const fn new(list: &'c mut [u64]) -> Self {
        Self { list, count: 0, skipped: 0, deepest: DEEPEST }
    }

    /// Forgets all, for a test down to a level.
    pub(super) const fn restart(&mut self, deepest: u8) {
        (self.count, self.skipped, self.deepest) = (0, 0, deepest);
    }

    pub(super) fn enter(&mut self, [a, b]: [Region; 2]) {
        let place = self.count.checked_sub(self.skipped).and_then(|at| self.list.get_mut(at));
        if let Some(place) = place {
            *place = u64::from(a.pack()) << 32 | u64::from(b.pack());
        }
        self.count += 1;
    }

    /// Pair k; where there was no room for it, the test runs again.
    pub(super) fn get(&mut self, pair: &Pair<'_>, k: usize) -> Option<[Region; 2]> {
        if k >= self.count {
            return None;
        }
        if k >= self.skipped + self.list.len() {
            (self.skipped, self.count) = (k, 0);
            self.find(pair);
        }
        let bits = *self.list.get(k.checked_sub(self.skipped)?)?;
        Some([(bits >> 32) as u32, bits as u32].map(Region::unpack))
    }

    /// The loop-free test as far as it found these pairs.
    fn find(&mut self, pair: &Pair<'_>) {
        in_rooms(pair.most_points(), |rooms| self.find_with(pair, rooms.map(Part::new)));
    }

    #[inline(never)]
    fn find_with(&mut self, pair: &Pair<'_>, mut parts: [Part<'_>; 2]) {
        let mut stack = [[Region::ROOT; 2]; STACK];
        let mut height = 1_usize;
        while let Some(regions) = height.checked_sub(1).and_then(|top| stack.get(top)).copied() {
            height -= 1;
            load(pair, &mut parts, regions);
            let [a, b] = &mut parts;
            match a.meeting(b) {
                Meeting::Apart => {}
                Meeting::Through => self.enter(regions),
                Meeting::Any => {
                    halve(pair, &parts, regions, self.deepest, (&mut stack, &mut height));
                }
            }
        }
    }
}

/// Pairs of parts that are looked at for one border.
const PAIRS: u32 = 1 << 10;

/// What takes the points.
type Visit<'v> = dyn FnMut(&Spot) -> Result<(), IntersectError> + 'v;

/// Calls `visit` with the points where the borders of either part meet the other; what remains undecided.
pub(super) fn pass(pair: &Pair<'_>, cell: [Region; 2], visit: &mut Visit<'_>) -> Result<u32, IntersectError> {
    in_rooms(pair.most_points(), |rooms| pass_with(pair, cell, &mut rooms.map(Part::new), visit))
}

#[inline(never)]
fn pass_with(
    pair: &Pair<'_>,
    cell: [Region; 2],
    parts: &mut [Part<'_>; 2],
    visit: &mut Visit<'_>,
) -> Result<u32, IntersectError> {
    let mut undecided = 0_u32;
    for side in 0..2_usize {
        parts[1].region = None;
        let (own, over) = (cell[side & 1], cell[1 - (side & 1)]);
        for [from, to] in own.borders(pair.sheets[side & 1].triangle).into_iter().flatten() {
            let line = Line { side, edge: None, from, to };
            let found = roots::find(pair, line, over, PAIRS, parts, &mut |spot, _| visit(spot))?;
            undecided = undecided.saturating_add(found.undecided);
            // A border along which the surfaces meet is a curve itself.
            for part in found.parts.into_iter().flatten() {
                match part.spot(pair, &line, part.at) {
                    Some(spot) => visit(&spot)?,
                    None => undecided = undecided.saturating_add(1),
                }
            }
        }
    }
    Ok(undecided)
}
