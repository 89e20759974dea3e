//! What a band found out about pieces that reach into the next one.
//!
//! In come what is done with such pieces, in the order in which they are met; the next band takes that out again when it meets
//! them, in the same order: bands of a frame are as wide as it is, so a piece that was there before and has pixels in the next
//! band is met in both. There is room for [`NOTES`] pieces. If more cross a border between bands, the last ones of them are
//! looked at again.

use super::pieces::{Split, Verdict, Way};
use crate::forward::{Sampling, Steps};

/// The most pieces that are noted between two bands: a teapot of 320 × 240 pixels in bands of 16 rows, without its back sides,
/// needs 85 in the mean of the bands that it is in.
const NOTES: u16 = 128;

/// What bands of exact points remember of pieces that reach into the next one: 524 bytes of the caller's, for
/// [`Frame::with_notes`](super::Frame::with_notes).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Notes {
    /// 0 for a piece that is to be looked at again.
    ring: [u32; NOTES as usize],
    /// Where the next note is taken from, and where it goes.
    read: u16,
    write: u16,
    /// Notes of the band before that are left, and those of this one.
    left: u16,
    kept: u16,
    is_full: bool,
}

impl Notes {
    /// No notes.
    pub const EMPTY: Self = Self { ring: [0; NOTES as usize], read: 0, write: 0, left: 0, kept: 0, is_full: false };

    /// Begins the next band.
    pub(super) fn turn(&mut self) {
        let before = if self.kept > self.write { NOTES } else { 0 };
        self.read = self.write + before - self.kept;
        (self.left, self.kept, self.is_full) = (self.kept, 0, false);
    }

    /// What the band before wrote down about the next of the pieces that reach into this one.
    pub(super) fn recall(&mut self) -> Option<Verdict> {
        self.left = self.left.checked_sub(1)?;
        let note = self.ring.get(usize::from(self.read)).copied();
        self.read = after(self.read);
        unpacked(note?)
    }

    /// Writes down what is done with the next of the pieces that reach into the next band.
    pub(super) fn keep(&mut self, verdict: &Verdict) {
        self.is_full |= self.left + self.kept >= NOTES;
        if !self.is_full
            && let Some(note) = self.ring.get_mut(usize::from(self.write))
        {
            *note = packed(verdict);
            (self.write, self.kept) = (after(self.write), self.kept + 1);
        }
    }
}

impl Default for Notes {
    fn default() -> Self {
        Self::EMPTY
    }
}

#[cfg(feature = "defmt")]
impl defmt::Format for Notes {
    fn format(&self, f: defmt::Formatter<'_>) {
        defmt::write!(f, "notes of {} pieces", self.kept);
    }
}

/// The place after one in the ring.
fn after(place: u16) -> u16 {
    if place + 1 < NOTES { place + 1 } else { 0 }
}

/// Steps up to this fit.
const MOST_STEPS: u32 = (1 << 13) - 1;

/// Two bits of what is done, one of whether the piece faces the viewer; then the direction of a split, or whether rows are
/// turned, whether centres are sampled, and twice 13 bits of steps.
fn packed(verdict: &Verdict) -> u32 {
    let way = match verdict.way {
        Way::Leave => 1,
        Way::Split(Split::R) => 2,
        Way::Split(Split::S) => 2 | 8,
        Way::Draw { sampling, turn, steepest } => {
            let (r, s) = (sampling.steps.r(), sampling.steps.s());
            if r > MOST_STEPS || s > MOST_STEPS || steepest >= Verdict::SLOW {
                return 0;
            }
            3 | u32::from(turn & 1) << 3 | u32::from(sampling.centres) << 4 | r << 5 | s << 18
        }
        Way::Split(_) => return 0,
    };
    way | u32::from(verdict.is_front) << 2
}

fn unpacked(note: u32) -> Option<Verdict> {
    let bit = |k: u32| note >> k & 1 == 1;
    let way = match note & 3 {
        1 => Way::Leave,
        2 => Way::Split(if bit(3) { Split::S } else { Split::R }),
        3 => {
            let steps = Steps::new(note >> 5 & MOST_STEPS, note >> 18 & MOST_STEPS).ok()?;
            let sampling = Sampling { steps, centres: bit(4) };
            Way::Draw { sampling, turn: bit(3).into(), steepest: Verdict::SLOW - 1 }
        }
        _ => return None,
    };
    Some(Verdict { way, is_front: bit(2) })
}

#[cfg(all(test, feature = "std"))]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;
    use std::vec::Vec;

    fn draw(r: u32, s: u32, centres: bool, turn: u8) -> Verdict {
        let sampling = Sampling { steps: Steps::new(r, s).unwrap(), centres };
        Verdict { way: Way::Draw { sampling, turn, steepest: Verdict::SLOW - 1 }, is_front: centres }
    }

    #[test]
    fn notes_are_what_was_noted() {
        for is_front in [false, true] {
            for way in [Way::Leave, Way::Split(Split::R), Way::Split(Split::S)] {
                let verdict = Verdict { way, is_front };
                assert_eq!(unpacked(packed(&verdict)), Some(verdict));
            }
        }
        for (r, s) in [(1, 8191), (8191, 1), (17, 23)] {
            for (centres, turn) in [(false, 0), (true, 1), (true, 0)] {
                assert_eq!(unpacked(packed(&draw(r, s, centres, turn))), Some(draw(r, s, centres, turn)));
            }
        }
        assert_eq!(unpacked(packed(&draw(8192, 1, false, 0))), None);
    }

    /// However many pieces cross the borders: what is recalled is what was kept, up to where there was no more room.
    #[test]
    fn bands_recall_what_the_one_before_kept() {
        let mut notes = Notes::EMPTY;
        let counts = [3, 60, 128, 127, 130, 1, 0, 300, 5];
        let mut before: Vec<u32> = Vec::new();
        for (band, count) in (0..).zip(counts) {
            notes.turn();
            let mut recalled = before.iter();
            let mut kept = Vec::new();
            for k in 0..count {
                // Some new ones between those that were there before.
                if k % 3 != band % 3
                    && let Some(steps) = recalled.next()
                {
                    assert!([Some(draw(*steps, 1, false, 0)), None].contains(&notes.recall()));
                }
                let steps = 1 + band * 400 + k;
                notes.keep(&draw(steps, 1, false, 0));
                kept.push(steps);
            }
            before = kept;
        }
        notes.turn();
        assert_eq!(notes.recall(), Some(draw(1 + 8 * 400, 1, false, 0)));
    }
}
