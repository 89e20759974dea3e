//! What all drawables share: places far from the ends of `i32`, tiles of a buffer's size, runs of covered pixels.

use core::ops::Range;
use embedded_graphics_core::geometry::{Point, Size};
use embedded_graphics_core::primitives::Rectangle;

/// `offset` moved by `by`, stopped at ±2^29: `Rectangle` adds without checks.
pub(super) fn add_offset(offset: Point, by: Point) -> Point {
    const FAR: i32 = 1 << 29;
    let add = |a: i32, b: i32| a.saturating_add(b).clamp(-FAR, FAR);
    Point::new(add(offset.x, by.x), add(offset.y, by.y))
}

/// `area` moved by `sign` times an offset of [`add_offset`].
pub(super) fn moved(area: Rectangle, offset: Point, sign: i32) -> Rectangle {
    let corner =
        Point::new(area.top_left.x.saturating_add(offset.x * sign), area.top_left.y.saturating_add(offset.y * sign));
    Rectangle::new(corner, area.size)
}

/// Calls `draw` with tiles of at most `tile` pixels that make up `area`, row by row; stops at the first error.
pub(super) fn each_tile<E>(
    area: Rectangle,
    tile: Size,
    mut draw: impl FnMut(Rectangle) -> Result<(), E>,
) -> Result<(), E> {
    let (right, bottom) = (area.size.width, area.size.height);
    let (width, height) = (tile.width.max(1), tile.height.max(1));
    let mut y = 0;
    while y < bottom {
        let mut x = 0;
        while x < right {
            let corner = area.top_left + Point::new(x as i32, y as i32);
            let size = Size::new(width.min(right - x), height.min(bottom - y));
            draw(Rectangle::new(corner, size))?;
            x = x.saturating_add(width);
        }
        y = y.saturating_add(height);
    }
    Ok(())
}

/// The maximal ranges of covered columns below `width`, left to right.
///
/// `find(column, covered)` is the first column from `column` on that is covered, or is not; anything from `width` on
/// stands for none.
pub(super) fn runs(width: usize, find: impl Fn(usize, bool) -> usize) -> impl Iterator<Item = Range<usize>> {
    let mut column = 0;
    core::iter::from_fn(move || {
        let start = find(column, true);
        if start >= width {
            return None;
        }
        column = find(start, false).max(start + 1).min(width);
        Some(start..column)
    })
}

/// The pixels of a run in row `row` of a tile.
pub(super) fn line(tile: Rectangle, row: usize, run: &Range<usize>) -> Rectangle {
    let corner = tile.top_left + Point::new(run.start as i32, row as i32);
    Rectangle::new(corner, Size::new(run.len() as u32, 1))
}

#[cfg(test)]
mod tests {
    use super::*;
    use embedded_graphics_core::primitives::PointsIter;
    use std::vec::Vec;

    #[test]
    fn runs_are_maximal_and_end_at_the_width() {
        let row = *b"##.#..###";
        let find = |from: usize, covered| (from..9).find(|c| (row[*c] == b'#') == covered).unwrap_or(usize::MAX);
        assert_eq!(runs(9, find).collect::<Vec<_>>(), [0..2, 3..4, 6..9]);
        assert_eq!(runs(8, find).collect::<Vec<_>>(), [0..2, 3..4, 6..8]);
        assert_eq!(runs(0, find).count(), 0);
    }

    #[test]
    fn tiles_make_up_the_area() {
        let area = Rectangle::new(Point::new(-3, 4), Size::new(10, 5));
        for tile in [Size::new(4, 2), Size::new(10, 5), Size::new(1, 1), Size::new(99, 99), Size::zero()] {
            let mut points = Vec::new();
            each_tile(area, tile, |t| {
                assert!(t.size.width <= tile.width.max(1) && t.size.height <= tile.height.max(1));
                points.extend(t.points());
                Ok::<(), ()>(())
            })
            .unwrap();
            points.sort_by_key(|p| (p.y, p.x));
            assert_eq!(points, area.points().collect::<Vec<_>>());
        }
    }
}
