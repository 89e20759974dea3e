//! Depths: a scene's z range in 15 bits.

use super::style::Lines;

/// Where z lies in a scene: the depth of z is (z + 1/2 − low)·2^bits, divided by 2^drop.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct DepthWindow {
    /// Bits of depth below the unit of z: at most 8, more where z is halved.
    pub(super) bits: u32,
    /// What is taken off.
    offset: i32,
    /// 1 where the range is beyond 15 bits, else 0.
    drop: u32,
    deepest: u16,
}

impl DepthWindow {
    /// The largest depth that something can have.
    pub(super) const LARGEST: u16 = (1 << 15) - 2;

    /// The window of whole z values low ..= high.
    pub(super) fn of(low: i32, high: i32) -> Self {
        let used = 32 - ((high - low).unsigned_abs() + 1).leading_zeros();
        let (bits, drop) = (15_u32.saturating_sub(used).min(8), used.saturating_sub(15));
        let mut window = Self { bits, offset: low << bits, drop, deepest: 1 };
        window.deepest = window.depth(high, (1 << bits) - 1).max(1);
        window
    }

    /// The depth of a rounded z and the fraction bits below it.
    #[inline(always)]
    pub(super) fn depth(self, z: i32, fraction: u32) -> u16 {
        // Tips of normals may stand nearer than the window. z has 16 bits, halved ones fewer.
        let depth = ((z << self.bits) | fraction as i32).wrapping_sub(self.offset).max(0) >> self.drop;
        depth.min(Self::LARGEST.into()) as u16
    }

    /// The depth of ⌊2^bits·z⌋, given in two parts: whole units, and the rest, of any size.
    #[inline(always)]
    pub(super) fn depth_of_parts(self, whole: i32, rest: i32) -> u16 {
        let depth = self.parts_of_whole(whole).wrapping_add(rest);
        (depth.max(0) >> self.drop).min(Self::LARGEST.into()) as u16
    }

    /// What the rest is added to: all of it, where [`is_whole`](Self::is_whole) and depths [are
    /// within](Self::is_within).
    #[inline(always)]
    pub(super) fn parts_of_whole(self, whole: i32) -> i32 {
        (whole << self.bits).wrapping_sub(self.offset)
    }

    /// Whether depths keep all their bits.
    pub(super) fn is_whole(self) -> bool {
        self.drop == 0
    }

    /// Whether the depth of these parts, or of a unit more or less, is in the window.
    pub(super) fn is_within(self, whole: i32, rest: i32) -> bool {
        let depth = (whole << self.bits).wrapping_sub(self.offset).wrapping_add(rest);
        depth > 0 && (depth >> self.drop) < i32::from(Self::LARGEST)
    }

    /// The window for z halved so many times: with z' = z/2^k it is told z' + 1/2, which is (z + 2^(k−1))/2^k.
    pub(super) fn halved(self, halvings: u32) -> Self {
        let more = ((1 << halvings) - 1) << self.bits >> 1;
        Self { bits: self.bits + halvings, offset: self.offset + more, ..self }
    }

    /// The depth of ⌊256·z⌋.
    #[inline(always)]
    pub(super) fn depth_of_256(self, z: i32) -> u16 {
        let depth = ((z + 128) >> (8 - self.bits)).wrapping_sub(self.offset).max(0) >> self.drop;
        depth.min(Self::LARGEST.into()) as u16
    }

    /// The lead of lines over surfaces.
    pub(super) fn bias(self) -> u16 {
        ((Lines::BIAS << self.bits) >> self.drop) as u16
    }

    /// The level of a depth between `near` at 0 and `far` at the deepest, rounded half up.
    pub(super) fn cue(self, depth: u16, near: u8, far: u8) -> u8 {
        let (near, far, deepest) = (i32::from(near), i32::from(far), i32::from(self.deepest));
        let doubled = 2 * (far - near) * i32::from(depth.min(self.deepest)) + deepest;
        (near + doubled.checked_div_euclid(2 * deepest).unwrap_or(0)) as u8
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn halved_values_have_the_same_depths() {
        for (low, high) in [(-150, 170), (-30_000, -29_950), (0, 32_766)] {
            let window = DepthWindow::of(low, high);
            for k in 1..=3 {
                let halved = window.halved(k);
                for z in low..=high {
                    // z + 1/2 in units of 2^k, plus 1/2, with halved.bits fraction bits.
                    let shifted = (2 * z + (1 << k)) << halved.bits >> (k + 1);
                    let (whole, fraction) = (shifted >> halved.bits, shifted & ((1 << halved.bits) - 1));
                    let exact = window.depth(z, (1 << window.bits) >> 1);
                    assert!(halved.depth(whole, fraction as u32).abs_diff(exact) <= 1, "{low} {high} {k} {z}");
                }
            }
        }
    }

    #[test]
    fn the_range_fills_15_bits_and_no_more() {
        for (low, high) in [(0, 0), (-150, 170), (-32767, 32767), (5, 16388), (0, 32766)] {
            let window = DepthWindow::of(low, high);
            assert_eq!(window.depth(low, 0), 0);
            let deepest = window.depth(high, (1 << window.bits) - 1);
            assert!(deepest <= DepthWindow::LARGEST && (window.bits == 8 || deepest > 1 << 13), "{window:?} {deepest}");
            assert_eq!((window.cue(0, 250, 10), window.cue(deepest, 250, 10)), (250, 10));
        }
        assert_eq!(DepthWindow::of(-150, 170).bits, 6);
    }
}
