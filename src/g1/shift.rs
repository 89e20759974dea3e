//! Where the centre of a fan moves.

/// The shift of a vertex's tangents, a byte: none, or one of three lengths in one of eight directions.
///
/// [`Interpolant::new`](super::Interpolant::new) fills a slice of them, one a vertex.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Shift(u8);

/// The low five bits choose.
const CHOICE: u8 = 31;
/// Set while the search goes on: for vertices that it has moved, for those that it looks at in this sweep, and for those
/// that can hardly meet their equations.
pub(super) const MOVED: u8 = 128;
pub(super) const DUE: u8 = 64;
pub(super) const WEAK: u8 = 32;

/// cos and sin of 2π(j + 0.3)/8, in 2^-32.
const DIRECTIONS: [[i64; 2]; 8] = [
    [4_176_297_008, 1_002_640_203],
    [2_244_114_248, 3_662_061_621],
    [-1_002_640_203, 4_176_297_008],
    [-3_662_061_621, 2_244_114_248],
    [-4_176_297_008, -1_002_640_203],
    [-2_244_114_248, -3_662_061_621],
    [1_002_640_203, -4_176_297_008],
    [3_662_061_621, -2_244_114_248],
];

/// The lengths in twentieths of the mean length of the tangents.
const LENGTHS: [i64; 3] = [3, 6, 9];

impl Shift {
    /// No shift.
    pub const NONE: Self = Self(0);

    /// How many there are, none among them.
    pub(super) const COUNT: u8 = 25;

    /// One of [`COUNT`](Self::COUNT), none first.
    pub(super) const fn choice(choice: u8) -> Self {
        Self(choice)
    }

    /// Whether the tangents stay.
    #[must_use]
    pub const fn is_none(self) -> bool {
        self.0 & CHOICE == 0
    }

    /// Its number among all.
    pub(super) const fn number(self) -> u8 {
        self.0 & CHOICE
    }

    const fn length(self) -> i64 {
        let choice = (self.0 & CHOICE).saturating_sub(1);
        if self.is_none() { 0 } else { LENGTHS[(choice / 8) as usize % 3] }
    }

    /// By how much tangents of this mean length move.
    pub(super) fn step(self, size: i64) -> [i64; 2] {
        let length = i128::from(size) * i128::from(self.length()) / 20;
        let direction = DIRECTIONS[(self.0 & CHOICE).wrapping_sub(1) as usize % 8];
        direction.map(|c| ((length * i128::from(c)) >> 32) as i64)
    }

    /// The square of the length in 2^-24.
    pub(super) const fn square(self) -> i64 {
        ((self.length() * self.length()) << 24) / 400
    }

    /// The same with a mark of the search set or not.
    pub(super) const fn with(self, mark: u8, set: bool) -> Self {
        Self(if set { self.0 | mark } else { self.0 & !mark })
    }

    pub(super) const fn has(self, mark: u8) -> bool {
        self.0 & mark != 0
    }

    /// Without the marks.
    pub(super) const fn unmarked(self) -> Self {
        Self(self.0 & CHOICE)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::disallowed_types, clippy::float_arithmetic)]
    use super::*;

    #[test]
    fn directions_are_eighths_of_a_turn() {
        for (j, direction) in (0..).zip(DIRECTIONS) {
            let angle = core::f64::consts::TAU * (f64::from(j) + 0.3) / 8.0;
            for (ours, exact) in direction.into_iter().zip([angle.cos(), angle.sin()]) {
                assert!((ours as f64 / 4_294_967_296.0 - exact).abs() < 1e-9, "{j}: {ours} {exact}");
            }
        }
    }

    #[test]
    fn bytes_hold_a_choice_and_marks() {
        let shift = Shift::choice(24).with(MOVED, true).with(DUE, true).with(DUE, false);
        assert_eq!(shift.step(20 << 32).map(|c| c >> 29), [61, -38]); // 9·(0.853, −0.523)·8
        assert!(shift.has(MOVED) && !shift.has(DUE) && !shift.is_none() && !Shift::choice(24).has(MOVED));
        assert_eq!(shift.unmarked(), Shift::choice(24));
        assert_eq!(Shift::choice(1).square(), (9 << 24) / 400);
        assert!(Shift::NONE.is_none() && Shift::NONE.step(1 << 40) == [0, 0]);
    }
}
