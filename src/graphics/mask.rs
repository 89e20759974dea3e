//! Which pixels of a tile are covered: a bit each.

use crate::render::Area;

/// A rectangle of pixels, one bit each, rows starting at whole bytes.
#[derive(Debug)]
pub(super) struct Mask<'b> {
    area: Area,
    /// Bytes in a row.
    stride: usize,
    bits: &'b mut [u8],
}

/// The bytes of a row of `width` pixels.
pub(super) fn row_bytes(width: u32) -> usize {
    width.div_ceil(8).max(1) as usize
}

impl<'b> Mask<'b> {
    /// The empty mask of `area`; rows for which `bits` has no room stay empty.
    pub(super) fn new(area: Area, bits: &'b mut [u8]) -> Self {
        bits.fill(0);
        Self { area, stride: row_bytes(area.width), bits }
    }

    pub(super) fn area(&self) -> Area {
        self.area
    }

    /// Covers the columns `first ..= last` of row `y`, those inside the area.
    #[inline]
    pub(super) fn fill(&mut self, y: i32, first: i32, last: i32) {
        let row = y.wrapping_sub(self.area.y) as u32;
        let first = first.max(self.area.x).wrapping_sub(self.area.x);
        let last = last.wrapping_sub(self.area.x).min(self.area.width as i32 - 1);
        if row >= self.area.height || first > last {
            return;
        }
        let (first, last) = (first as u32, last as u32);
        let start = row as usize * self.stride;
        let Some(row) = self.bits.get_mut(start..start + self.stride) else { return };
        let (left, right) = ((first / 8) as usize, (last / 8) as usize);
        for (at, byte) in row.iter_mut().enumerate().take(right + 1).skip(left) {
            let from = if at == left { 0xff << (first % 8) } else { 0xff_u8 };
            let to = if at == right { 0xff >> (7 - last % 8) } else { 0xff_u8 };
            *byte |= from & to;
        }
    }

    /// The first column from `column` on that is covered, or is not; columns count from the area's left side.
    pub(super) fn find(&self, row: usize, column: usize, covered: bool) -> usize {
        let start = row * self.stride;
        let bytes = self.bits.get(start..start + self.stride).unwrap_or(&[]);
        let flip = if covered { 0 } else { 0xff };
        let mut wanted = 0xff << (column % 8);
        for (at, byte) in bytes.iter().enumerate().skip(column / 8) {
            let found = (byte ^ flip) & wanted;
            if found != 0 {
                return 8 * at + found.trailing_zeros() as usize;
            }
            wanted = 0xff_u8;
        }
        usize::MAX
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::vec::Vec;

    /// Every range of columns, inside and across all sides, sets its own bits only, and `find` finds them.
    #[test]
    fn fills_are_clipped_and_found() {
        let area = Area { x: -5, y: 7, width: 21, height: 2 };
        for (first, last) in (-30..30).flat_map(|a| (-30..30).map(move |b| (a, b))) {
            let mut bits = [0xff; 6];
            let mut mask = Mask::new(area, &mut bits);
            mask.fill(8, first, last);
            mask.fill(6, -30, 30);
            mask.fill(9, -30, 30);
            assert!(mask.find(0, 0, true) >= 21);
            let covered: Vec<_> = (0..21).filter(|c| mask.find(1, *c, true) == *c).collect();
            let expected: Vec<_> = (0..21).filter(|c| (first..=last).contains(&(*c as i32 - 5))).collect();
            assert_eq!(covered, expected, "{first} ..= {last}");
            let free: Vec<_> = (0..21).filter(|c| mask.find(1, *c, false) == *c).collect();
            assert_eq!(free.len() + covered.len(), 21);
        }
    }
}
