//! A row of a piece on its way to the pixels.

use super::super::pen::{Ink, Seen};
use super::super::style::Style;
use super::run::{Depths, Line, Pixels, Points, Raster, hide, test};
use super::tangents::RowTangents;
use super::{Piece, RowCubic, Target};

/// A row, by axis, and what is known of it.
pub(super) struct Row<'p, 'n> {
    pub(super) piece: &'p Piece<'n>,
    pub(super) cubics: [RowCubic; 3],
    pub(super) j: u32,
    /// 1 for the lattice of centres.
    pub(super) half: u32,
    pub(super) s: i32,
    /// Whether some points may be in columns, and in rows, outside the tile.
    pub(super) clip: [bool; 2],
    pub(super) tangents: RowTangents,
    /// Whether the tangents were found.
    pub(super) is_known: bool,
}

/// How values become what a tile holds.
pub(super) struct Units {
    pub(super) pixels: Pixels,
    pub(super) depths: Depths,
    pub(super) raster: Raster,
}

impl Row<'_, '_> {
    /// Draws `count` points from one on: its number and its parameter.
    #[inline(never)]
    pub(super) fn run(
        &mut self,
        (first, t): (u32, i32),
        count: usize,
        units: &Units,
        points: &mut Points,
        target: &mut Target<'_>,
    ) {
        let Units { pixels, raster, .. } = units;
        let Points { index, depths, seen, levels } = points;
        let mut lines = [Line::default(); 3];
        self.piece.lines(&self.cubics, t, &mut lines);
        let [x, y, z] = &mut lines;
        let index = index.get_mut(..count).unwrap_or_default();
        if !pixels.rows(y, index) {
            pixels.settle(y, index, &mut |k, near| self.settle(1, first + k as u32, near));
        }
        let (mut first, mut index) = (first, index);
        if self.clip[1] {
            let (from, to) = raster.trim(index);
            index = index.get_mut(from..to).unwrap_or_default();
            if index.is_empty() {
                return;
            }
            if from > 0 {
                x.skip(from);
                z.skip(from);
                first += from as u32;
            }
        }
        if self.clip[0] {
            let settle = &mut |k: usize, near| self.settle(0, first + k as u32, near);
            pixels.clipped_columns(x, raster, index, settle);
        } else if !pixels.columns(x, raster, index) {
            pixels.settle(x, index, &mut |k, near| self.settle(0, first + k as u32, near));
        }
        let depths = depths.get_mut(..index.len()).unwrap_or_default();
        units.depths.of(z, depths);
        if target.ink != Ink::Fill {
            return hide(index, depths, target.depth);
        }
        let count = test(index, depths, target.depth, seen);
        if count > 0 {
            let (seen, levels) = (seen.get(..count), levels.get_mut(..count));
            self.colour(first, (index, seen.unwrap_or_default()), levels.unwrap_or_default(), target);
        }
    }

    /// Gives the points that were seen their colours.
    #[inline(always)]
    fn colour(&mut self, first: u32, (index, seen): (&[u32], &[u8]), levels: &mut [u8], target: &mut Target<'_>) {
        let shading = target.shading;
        if shading.style.needs_normals() && !self.is_known {
            self.piece.tangents(&self.cubics, self.s, &mut self.tangents);
            self.is_known = true;
        }
        if shading.style == Style::Shaded {
            // Most scenes: without asking for the style at each point.
            let last = first + (index.len() as u32).wrapping_sub(1);
            self.light(last, seen, levels, shading.light, target.side);
        } else {
            self.shade(first, (index, seen), levels, target);
        }
        target.stain.stain_all(&target.area, &Seen { index, seen, levels });
    }

    /// The levels of points in any style.
    #[inline(never)]
    fn shade(&self, first: u32, (index, seen): (&[u32], &[u8]), levels: &mut [u8], target: &Target<'_>) {
        for (k, level) in seen.iter().zip(levels) {
            let k = index.len().wrapping_sub(1).wrapping_sub(usize::from(*k));
            let index = index.get(k).map_or(0, |index| *index as usize);
            let depth = target.depth.get(index).map_or(0, |stored| stored >> 1);
            *level = target.shading.level(depth, || self.normal(first + k as u32, target.side));
        }
    }

    /// The exact pixel of a point in doubt, from the origin on.
    #[cold]
    #[inline(never)]
    fn settle(&self, axis: usize, i: u32, near: i32) -> i32 {
        let base = self.piece.base(axis);
        self.piece.exact_pixel(axis, [i, self.j], self.half == 1, near.wrapping_add(base)).wrapping_sub(base)
    }
}
