//! Which pixel centres a surface covers.

use super::eval::coordinates;
use super::mesh::{Mesh, SNAP_BITS, Vertex};
use crate::num::Coord;
use crate::patch::SurfaceNet;
use core::iter::FusedIterator;
use std::vec;
use std::vec::Vec;

const ONE: i64 = 1 << SNAP_BITS;
const WORD: usize = u64::BITS as usize;

/// A set of pixel centres: a bitmap over a rectangle of pixels. Outside the rectangle nothing is kept.
///
/// A surface is [added](Self::add) as a fine triangle mesh; single centres, the hits of an engine, are
/// [inserted](Self::insert). [`missed`](Self::missed) compares the two.
///
/// ```
/// use embedded_surfaces::patch::{FlatTriangle, Surface};
/// use embedded_surfaces::reference::Coverage;
/// let triangle = FlatTriangle::from_ints([[0, 0, 0], [4, 0, 0], [0, 2, 0]])?;
/// let mut coverage = Coverage::around(triangle.surface());
/// coverage.add(triangle.surface(), (1, 1));
/// assert_eq!(coverage.to_string(), "#####\n###..\n#....\n"); // edges and corners belong to it
/// # Ok::<(), embedded_surfaces::patch::NetError>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Coverage {
    x0: i32,
    y0: i32,
    width: u32,
    height: u32,
    /// Row by row, lowest bit first.
    bits: Vec<u64>,
}

/// The covered centres of a [`Coverage`], row by row, left to right.
#[derive(Clone, Debug)]
pub struct Centres<'a> {
    coverage: &'a Coverage,
    /// Bits of the word before `next` still to come.
    word: u64,
    next: usize,
    left: usize,
}

/// Twice the signed area of (a, b, c): positive where c is on the side of a→b to which +x turns to reach +y.
///
/// Exact: snapped coordinates of legal nets are at most 2^26·2^24 = 2^50, differences at most 2^51, products at most
/// 2^102, and two of them fit an `i128` by far.
fn orientation(a: Vertex, b: Vertex, c: Vertex) -> i128 {
    let side = |p: Vertex, axis: usize| i128::from(p[axis] - a[axis]);
    side(b, 0) * side(c, 1) - side(b, 1) * side(c, 0)
}

/// The smallest and the largest integer between the least and the greatest of three snapped coordinates, if any.
fn whole_between(a: i64, b: i64, c: i64) -> Option<(i64, i64)> {
    let first = (a.min(b).min(c) + (ONE - 1)) >> SNAP_BITS;
    let last = a.max(b).max(c) >> SNAP_BITS;
    (first <= last).then_some((first, last))
}

impl Coverage {
    /// The empty set over `width` × `height` pixels, the first centre at (x0, y0). Memory: a bit per pixel.
    #[must_use]
    pub fn new(x0: i32, y0: i32, width: u32, height: u32) -> Self {
        let pixels = width as usize * height as usize;
        Self { x0, y0, width, height, bits: vec![0; pixels.div_ceil(WORD)] }
    }

    /// The empty set over every pixel that the surface can cover or that one of its points can round to.
    ///
    /// ```
    /// use embedded_surfaces::{geometry::Point3, patch::{FlatTriangle, Surface}, reference::Coverage};
    /// let half_way = Point3::from_bits(1 << 15, 1 << 15, 0);
    /// let net = FlatTriangle::new([Point3::from_ints(0, 0, 0), half_way, Point3::from_ints(-3, 7, 0)])?;
    /// assert_eq!(Coverage::around(net.surface()), Coverage::new(-3, 0, 5, 8));
    /// # Ok::<(), embedded_surfaces::patch::NetError>(())
    /// ```
    #[must_use]
    pub fn around<C: Coord>(net: SurfaceNet<'_, C>) -> Self {
        let range = |axis: usize| {
            let along = || net.points().iter().map(|p| coordinates(p)[axis]);
            let low = along().fold(f64::INFINITY, f64::min).floor() as i32;
            let high = along().fold(f64::NEG_INFINITY, f64::max).ceil() as i32;
            (low, high.abs_diff(low) + 1)
        };
        let ((x0, width), (y0, height)) = (range(0), range(1));
        Self::new(x0, y0, width, height)
    }

    /// The first centre (x0, y0).
    #[must_use]
    pub fn origin(&self) -> (i32, i32) {
        (self.x0, self.y0)
    }

    /// The width and height of the rectangle, in pixels.
    #[must_use]
    pub fn size(&self) -> (u32, u32) {
        (self.width, self.height)
    }

    /// The place of a centre in the bitmap; `None` outside the rectangle.
    fn place(&self, x: i64, y: i64) -> Option<(usize, u64)> {
        let column = u32::try_from(x - i64::from(self.x0)).ok().filter(|c| *c < self.width)?;
        let row = u32::try_from(y - i64::from(self.y0)).ok().filter(|r| *r < self.height)?;
        let index = row as usize * self.width as usize + column as usize;
        Some((index / WORD, 1 << (index % WORD)))
    }

    fn set(&mut self, x: i64, y: i64) -> bool {
        let Some((word, bit)) = self.place(x, y) else { return false };
        let new = self.bits[word] & bit == 0;
        self.bits[word] |= bit;
        new
    }

    /// Adds one centre; whether it was new. A centre outside the rectangle is not kept and not new.
    ///
    /// ```
    /// use embedded_surfaces::reference::Coverage;
    /// let mut hits = Coverage::new(-1, 0, 3, 2);
    /// assert!(hits.insert(-1, 1));
    /// assert!(!hits.insert(-1, 1));
    /// assert!(!hits.insert(2, 0));
    /// assert_eq!(hits.count(), 1);
    /// ```
    pub fn insert(&mut self, x: i32, y: i32) -> bool {
        self.set(x.into(), y.into())
    }

    /// Whether the centre (x, y) is in the set.
    #[must_use]
    pub fn contains(&self, x: i32, y: i32) -> bool {
        self.place(x.into(), y.into()).is_some_and(|(word, bit)| self.bits[word] & bit != 0)
    }

    /// The number of centres in the set.
    #[must_use]
    pub fn count(&self) -> usize {
        self.bits.iter().map(|word| word.count_ones() as usize).sum()
    }

    /// The centres in the set, row by row.
    #[must_use]
    pub fn iter(&self) -> Centres<'_> {
        Centres { coverage: self, word: 0, next: 0, left: self.count() }
    }

    /// The centres of this set that `hits` lacks, row by row: with a surface here and an engine's hits there, the
    /// holes.
    ///
    /// ```
    /// use embedded_surfaces::patch::{BilinearPatch, Surface};
    /// use embedded_surfaces::reference::Coverage;
    /// let square = BilinearPatch::from_ints([[[0, 0, 0], [0, 1, 0]], [[2, 0, 0], [2, 1, 0]]])?;
    /// let mut truth = Coverage::around(square.surface());
    /// let mut hits = truth.clone();
    /// truth.add(square.surface(), (8, 8));
    /// for (x, y) in [(0, 0), (1, 0), (2, 0), (0, 1), (2, 1)] {
    ///     hits.insert(x, y);
    /// }
    /// assert_eq!(truth.missed(&hits), [(1, 1)]);
    /// # Ok::<(), embedded_surfaces::patch::NetError>(())
    /// ```
    #[must_use]
    pub fn missed(&self, hits: &Self) -> Vec<(i32, i32)> {
        self.iter().filter(|&(x, y)| !hits.contains(x, y)).collect()
    }

    /// Adds the centres that the surface covers, seen along z: those in a closed triangle of its mesh of n_r × n_s
    /// cells, cut along a diagonal (a triangular patch: n² triangles, n the larger count; 0 counts as 1).
    ///
    /// Vertices are evaluated in `f64` and snapped to multiples of 2^-24 pixel, neighbours sharing theirs; from there
    /// on all is exact. So the mesh has no cracks, and of an `I16F16` net a centre is judged wrongly only within 2^-24
    /// pixel of the mesh's border or silhouette. Triangles without area cover nothing. How far the mesh is from the
    /// surface is the caller's choice: see [`fine_mesh`](super::fine_mesh).
    ///
    /// Cost: about 10 ns a triangle on a host, and less than that for each centre in the box of one.
    pub fn add<C: Coord>(&mut self, net: SurfaceNet<'_, C>, mesh: (u32, u32)) {
        Mesh::new(net, mesh).for_each_triangle(|triangle| self.add_triangle(triangle));
    }

    /// Adds the centres that the surface covers with the side that faces the viewer: those in triangles of its mesh whose
    /// normal, in the sense of S_r × S_s and turned where the patch is `inward`, has z < 0.
    pub fn add_front<C: Coord>(&mut self, net: SurfaceNet<'_, C>, mesh: (u32, u32), inward: bool) {
        Mesh::new(net, mesh).for_each_triangle(|triangle| {
            let [a, b, c] = triangle;
            let turn = orientation(a, b, c);
            if if inward { turn > 0 } else { turn < 0 } {
                self.add_triangle(triangle);
            }
        });
    }

    /// Adds the centres in a closed triangle of positive area.
    #[inline]
    fn add_triangle(&mut self, [a, b, c]: [Vertex; 3]) {
        let Some(columns) = whole_between(a[0], b[0], c[0]) else { return };
        let Some(rows) = whole_between(a[1], b[1], c[1]) else { return };
        self.test_box([a, b, c], columns, rows);
    }

    /// Tests every centre of a box against a triangle.
    fn test_box(&mut self, [a, b, c]: [Vertex; 3], columns: (i64, i64), rows: (i64, i64)) {
        let area = orientation(a, b, c);
        if area == 0 {
            return;
        }
        let (b, c) = if area > 0 { (b, c) } else { (c, b) };
        let (left, top) = (i64::from(self.x0), i64::from(self.y0));
        let (right, bottom) = (left + i64::from(self.width), top + i64::from(self.height));
        for y in rows.0.max(top)..(rows.1 + 1).min(bottom) {
            for x in columns.0.max(left)..(columns.1 + 1).min(right) {
                let centre = [x * ONE, y * ONE];
                if [(a, b), (b, c), (c, a)].into_iter().all(|(p, q)| orientation(p, q, centre) >= 0) {
                    self.set(x, y);
                }
            }
        }
    }
}

impl Iterator for Centres<'_> {
    type Item = (i32, i32);

    fn next(&mut self) -> Option<(i32, i32)> {
        while self.word == 0 {
            self.word = *self.coverage.bits.get(self.next)?;
            self.next += 1;
        }
        let index = (self.next - 1) * WORD + self.word.trailing_zeros() as usize;
        self.word &= self.word - 1;
        self.left -= 1;
        let width = self.coverage.width as usize;
        // Only coordinates that fit an i32 are ever set.
        let along = |start: i32, steps: usize| (i64::from(start) + steps as i64) as i32;
        Some((along(self.coverage.x0, index % width), along(self.coverage.y0, index / width)))
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        (self.left, Some(self.left))
    }
}

impl ExactSizeIterator for Centres<'_> {}
impl FusedIterator for Centres<'_> {}

impl<'a> IntoIterator for &'a Coverage {
    type Item = (i32, i32);
    type IntoIter = Centres<'a>;

    fn into_iter(self) -> Centres<'a> {
        self.iter()
    }
}

/// A line per row: `#` covered, `.` not.
impl core::fmt::Display for Coverage {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        let covered = |x: i64, y: i64| self.place(x, y).is_some_and(|(word, bit)| self.bits[word] & bit != 0);
        for row in 0..i64::from(self.height) {
            for column in 0..i64::from(self.width) {
                let here = covered(i64::from(self.x0) + column, i64::from(self.y0) + row);
                f.write_str(if here { "#" } else { "." })?;
            }
            f.write_str("\n")?;
        }
        Ok(())
    }
}

#[cfg(feature = "defmt")]
mod format {
    use super::{Centres, Coverage};
    use defmt::{Format, Formatter};

    impl Format for Coverage {
        fn format(&self, f: Formatter<'_>) {
            let (origin, size) = (self.origin(), self.size());
            defmt::write!(f, "{} of {} pixels at {} covered", self.count(), size, origin);
        }
    }

    impl Format for Centres<'_> {
        fn format(&self, f: Formatter<'_>) {
            defmt::write!(f, "{} covered centres left", self.left);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::fine_mesh;
    use super::*;
    use crate::geometry::Point3;
    use crate::patch::{BicubicPatch, BilinearPatch, FlatTriangle, QuadraticTriangle, Surface};
    use num_rational::Ratio;
    use proptest::prelude::*;
    use std::string::ToString;

    fn covered(net: SurfaceNet<'_>, mesh: (u32, u32)) -> Coverage {
        let mut coverage = Coverage::around(net);
        coverage.add(net, mesh);
        coverage
    }

    /// Whether the line y meets the triangle in an interval that holds x, in exact rationals.
    fn in_triangle(corners: [(i32, i32); 3], x: i32, y: i32) -> bool {
        let corners = corners.map(|(x, y)| (Ratio::new(i128::from(x), 65536), Ratio::new(i128::from(y), 65536)));
        let (x, y) = (Ratio::from(i128::from(x)), Ratio::from(i128::from(y)));
        let mut meets = Vec::new();
        for k in 0..3 {
            let ((ax, ay), (bx, by)) = (corners[k], corners[(k + 1) % 3]);
            if ay == by {
                if ay == y {
                    meets.extend([ax, bx]);
                }
            } else {
                let t = (y - ay) / (by - ay);
                if t >= Ratio::from(0) && t <= Ratio::from(1) {
                    meets.push(ax + t * (bx - ax));
                }
            }
        }
        meets.iter().min().is_some_and(|low| *low <= x) && meets.iter().max().is_some_and(|high| x <= *high)
    }

    /// Coordinates within a few pixels; often whole or half, so that centres fall on edges and corners.
    fn coordinate(pixels: i32) -> impl Strategy<Value = i32> {
        let halves = (-2 * pixels..=2 * pixels).prop_map(|h| h << 15);
        let near = (-2 * pixels..=2 * pixels, -1..=1).prop_map(|(h, last)| (h << 15) + last);
        prop_oneof![halves, near, -pixels << 16..=pixels << 16]
    }

    proptest! {
        #[test]
        fn a_triangle_covers_what_it_holds(
            corners in proptest::array::uniform3((coordinate(6), coordinate(6))),
            n in prop_oneof![Just(1_u32), Just(2), Just(4)],
        ) {
            let net = FlatTriangle::new(corners.map(|(x, y)| Point3::from_bits(x, y, 0))).unwrap();
            let [(ax, ay), (bx, by), (cx, cy)] = corners.map(|(x, y)| (i64::from(x), i64::from(y)));
            let flat = (bx - ax) * (cy - ay) == (by - ay) * (cx - ax);
            let got = covered(net.surface(), (n, n));
            for y in -8..=8 {
                for x in -8..=8 {
                    let want = !flat && in_triangle(corners, x, y);
                    prop_assert_eq!(got.contains(x, y), want, "({}, {})", x, y);
                }
            }
        }

        #[test]
        fn the_iterator_lists_the_set(inserted in proptest::collection::btree_set((0_i32..9, -5_i32..11), 0..99)) {
            let mut coverage = Coverage::new(0, -5, 9, 16);
            // Row by row, so in the order of (y, x).
            let mut want: Vec<(i32, i32)> = inserted.iter().copied().collect();
            want.sort_unstable_by_key(|&(x, y)| (y, x));
            for &(x, y) in &inserted {
                prop_assert!(coverage.insert(x, y));
            }
            prop_assert_eq!(coverage.iter().len(), want.len());
            prop_assert_eq!(coverage.count(), want.len());
            prop_assert_eq!(coverage.into_iter().collect::<Vec<_>>(), want);
        }
    }

    #[test]
    fn a_square_covers_every_centre_of_its_closure() {
        for n in [1_i16, 2, 7, 64] {
            let net =
                BilinearPatch::from_ints([[[-3, 5, 0], [-3, 5 + n, 0]], [[n - 3, 5, 0], [n - 3, 5 + n, 0]]]).unwrap();
            let side = n as usize + 1;
            for mesh in [(1, 1), (3, 1), (n as u32, n as u32), fine_mesh((n as u32, n as u32)), (101, 97)] {
                assert_eq!(covered(net.surface(), mesh).count(), side * side, "{n} {mesh:?}");
            }
        }
    }

    #[test]
    fn a_cubic_square_is_the_same_square() {
        let line = |x: i16| [[x, 0, 0], [x, 10, 9], [x, 20, -9], [x, 30, 0]];
        let net = BicubicPatch::from_ints([line(0), line(2), line(29), line(30)]).unwrap();
        assert_eq!(covered(net.surface(), fine_mesh((90, 60))).count(), 31 * 31);
    }

    #[test]
    fn a_half_pixel_inset_square_loses_its_rim() {
        let half = 1 << 15;
        let (a, b) = (half, (9 << 16) + half);
        let corner = |x, y| Point3::from_bits(x, y, 0);
        let net = BilinearPatch::new([[corner(a, a), corner(a, b)], [corner(b, a), corner(b, b)]]).unwrap();
        assert_eq!(covered(net.surface(), (36, 36)).count(), 81);
    }

    #[test]
    fn a_parabola_bounds_a_triangle() {
        // Between the chord y = 0 and the arc y = 8 - x²/8, |x| <= 8: the edge w = 0 is the arc.
        let net = QuadraticTriangle::from_ints([[8, 0, 0], [0, 16, 0], [4, 0, 0], [-8, 0, 0], [-4, 0, 0], [0, 0, 0]]);
        let got = covered(net.unwrap().surface(), (256, 256));
        for y in 0..=8 {
            for x in -8..=8 {
                // Chords of a concave arc stay below it: skip the centres on the arc itself.
                if x * x + 8 * y != 64 {
                    assert_eq!(got.contains(x, y), x * x + 8 * y < 64, "({x}, {y})\n{got}");
                }
            }
        }
    }

    #[test]
    fn a_folded_patch_covers_both_sheets() {
        // x runs 0 to 6 and back to 0; the mesh turns over on the way.
        let net = BicubicPatch::from_ints([0, 8, 8, 0].map(|x| [0, 1, 2, 3].map(|y| [x, y, 0]))).unwrap();
        assert_eq!(covered(net.surface(), (64, 12)).to_string(), "#######..\n".repeat(4));
    }

    #[test]
    fn nothing_without_area_is_covered() {
        let point = FlatTriangle::from_ints([[2, 2, 0]; 3]).unwrap();
        let line = BilinearPatch::from_ints([[[0, 0, 0], [4, 4, 0]], [[2, 2, 0], [6, 6, 1]]]).unwrap();
        assert_eq!(covered(point.surface(), (8, 8)).count(), 0);
        assert_eq!(covered(line.surface(), (8, 8)).count(), 0);
    }

    #[test]
    fn both_ends_of_the_legal_range() {
        let (l, h) = (-32767, 32767);
        let all = FlatTriangle::from_ints([[l, l, 0], [h, l, 0], [l, h, 0]]).unwrap();
        let mut corner = Coverage::new(32765, -32768, 4, 4);
        corner.add(all.surface(), (1, 1));
        assert_eq!(corner.to_string(), "....\n###.\n##..\n#...\n");
        let mut far = Coverage::new(i32::MAX - 1, i32::MIN, 5, 5);
        assert!(far.insert(i32::MAX, i32::MIN) && !far.insert(i32::MIN, i32::MIN));
        assert_eq!(far.iter().collect::<Vec<_>>(), [(i32::MAX, i32::MIN)]);
        assert_eq!(Coverage::new(0, 0, 0, 0).iter().next(), None);
    }

    #[test]
    fn missed_is_a_difference() {
        let (mut truth, mut hits) = (Coverage::new(0, 0, 4, 2), Coverage::new(-1, -1, 4, 2));
        for (x, y) in [(0, 0), (2, 0), (3, 0), (1, 1)] {
            truth.insert(x, y);
        }
        for (x, y) in [(0, 0), (2, 0), (1, 0)] {
            hits.insert(x, y);
        }
        assert_eq!(truth.missed(&hits), [(3, 0), (1, 1)]);
    }
}
