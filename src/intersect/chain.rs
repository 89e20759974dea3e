//! Chaining segments by the keys of their ends: no distances, no tolerance.

use super::IntersectError;
use super::descent::{key, number};
use super::key::Crossing;

/// Sorts in place by sifting (Williams 1964, "Algorithm 232: Heapsort"): `core`'s sorts leave a panic path in an image.
pub(super) fn sort(values: &mut [u64]) {
    let sift = |values: &mut [u64], mut at: usize, end: usize| {
        loop {
            let child = 2 * at + 1;
            let (Some(left), Some(here)) = (values.get(child).copied(), values.get(at).copied()) else { return };
            if child >= end {
                return;
            }
            let right = if child + 1 < end { values.get(child + 1).copied().unwrap_or(0) } else { 0 };
            let (larger, value) = if right > left { (child + 1, right) } else { (child, left) };
            if value <= here {
                return;
            }
            exchange(values, at, larger);
            at = larger;
        }
    };
    let len = values.len();
    for at in (0..len / 2).rev() {
        sift(values, at, len);
    }
    for end in (1..len).rev() {
        exchange(values, 0, end);
        sift(values, 0, end);
    }
}

/// `swap` without its panic.
fn exchange(values: &mut [u64], a: usize, b: usize) {
    if let Ok([x, y]) = values.get_disjoint_mut([a, b]) {
        core::mem::swap(x, y);
    }
}

/// Segments linked to chains.
#[derive(Debug)]
pub(super) struct Chains<'b> {
    records: &'b [u64],
    /// Where the record of each number stands after sorting; the top bit marks visited ends.
    places: &'b mut [u32],
}

const VISITED: u32 = 1 << 31;

/// The numbers of open and closed chains.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Signature {
    pub(super) open: u32,
    pub(super) closed: u32,
}

impl<'b> Chains<'b> {
    /// Sorts and links; checks that each key occurs once on a border and twice elsewhere. `has_gaps`: triangles were left out,
    /// so chains may end beside them.
    pub(super) fn new(
        records: &'b mut [u64],
        places: &'b mut [u32],
        has_gaps: bool,
        is_border: impl Fn(Crossing) -> bool,
    ) -> Result<Self, IntersectError> {
        sort(records);
        for (place, record) in (0..).zip(records.iter()) {
            if let Some(out) = places.get_mut(number(*record)) {
                *out = place;
            }
        }
        let chains = Self { records, places };
        let mut at = 0;
        while let Some(record) = chains.records.get(at) {
            let same = chains.records.iter().skip(at).take_while(|r| key(**r) == key(*record)).count();
            let expected = if is_border(Crossing::unpack(key(*record))) { 1 } else { 2 };
            if same != expected && !(has_gaps && same == 1) {
                return Err(IntersectError::Internal);
            }
            at += same;
        }
        Ok(chains)
    }

    /// The number of the record with the same key; `None` at an open end.
    fn partner(&self, end: usize) -> Option<usize> {
        let place = (self.places.get(end)? & !VISITED) as usize;
        let own = key(*self.records.get(place)?);
        let neighbours = [place.checked_sub(1), Some(place + 1)];
        let mut others = neighbours.into_iter().flatten().filter_map(|p| self.records.get(p));
        others.find(|record| key(**record) == own).map(|record| number(*record))
    }

    fn key_of(&self, end: usize) -> u64 {
        let place = self.places.get(end).map_or(0, |p| (p & !VISITED) as usize);
        self.records.get(place).map_or(0, |record| key(*record))
    }

    fn visit(&mut self, end: usize) -> bool {
        let Some(place) = self.places.get_mut(end) else { return false };
        let new = *place & VISITED == 0;
        *place |= VISITED;
        new
    }

    fn is_new(&self, end: usize) -> bool {
        self.places.get(end).is_some_and(|p| p & VISITED == 0)
    }

    /// A chain that was not walked before, open ones first, each kind in the order of keys: its first end.
    /// `from` is where to look on, and moves.
    pub(super) fn next_start(&self, open: bool, from: &mut usize) -> Option<usize> {
        while let Some(record) = self.records.get(*from) {
            let end = number(*record);
            *from += 1;
            if self.is_new(end) && (!open || self.partner(end).is_none()) {
                return Some(end);
            }
        }
        None
    }

    /// Walks the chain that starts at an end, calling `visit` with each crossing; a closed chain's first comes once.
    pub(super) fn walk(
        &mut self,
        start: usize,
        mut visit: impl FnMut(Crossing) -> Result<(), IntersectError>,
    ) -> Result<(), IntersectError> {
        let mut end = start;
        let is_open = self.partner(start).is_none();
        loop {
            if !self.visit(end) {
                return Ok(());
            }
            visit(Crossing::unpack(self.key_of(end)))?;
            let other = end ^ 1;
            self.visit(other);
            match self.partner(other) {
                Some(next) => end = next,
                None if is_open => return visit(Crossing::unpack(self.key_of(other))),
                None => return Err(IntersectError::Internal),
            }
        }
    }

    /// Forgets what was walked.
    pub(super) fn reset(&mut self) {
        self.places.iter_mut().for_each(|place| *place &= !VISITED);
    }

    /// Counts the chains and forgets the walks.
    pub(super) fn signature(&mut self) -> Result<Signature, IntersectError> {
        let mut out = Signature::default();
        for open in [true, false] {
            let mut from = 0;
            while let Some(start) = self.next_start(open, &mut from) {
                self.walk(start, |_| Ok(()))?;
                *if open { &mut out.open } else { &mut out.closed } += 1;
            }
        }
        self.reset();
        Ok(out)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::vec::Vec;

    proptest! {
        #[test]
        fn sorts(mut values: Vec<u64>) {
            let mut expected = values.clone();
            expected.sort_unstable();
            sort(&mut values);
            prop_assert_eq!(values, expected);
        }
    }
}
