//! Visibility buffers: the depth and the tag of what is nearest at each pixel (an item buffer, Weghorst, Hooper and
//! Greenberg 1984; Burns and Hunt 2013).
//!
//! In come lattices, seen along z, and a tag for each point; a picture keeps the nearest depth of every pixel and the tag
//! that came with it. So a caller shades after the depth test, each pixel once, and what is in the buffer does not depend
//! on the order of lattices or of points.

use super::Lattice;
use super::fill::MULTIPLIES;
use super::lattice::LatticePoint;

/// Why a visibility buffer cannot be made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum VisibilityError {
    /// There are fewer entries than pixels, or a side has more than 32768 pixels.
    Size {
        /// Columns.
        width: u32,
        /// Rows.
        height: u32,
        /// The entries that are there.
        len: usize,
    },
}

impl core::fmt::Display for VisibilityError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        let Self::Size { width, height, len } = self;
        write!(f, "a picture of {width} x {height} pixels, sides up to {MAX_SIDE}, does not fit {len} entries")
    }
}

impl core::error::Error for VisibilityError {}

/// The largest side of a picture.
const MAX_SIDE: u32 = 1 << 15;

/// What is added to z to have no sign: |z| ≤ 32767.
const BIAS: i32 = 1 << 15;

/// Tags of lattice points: that of (i, j) is `first` + i·`by_i` + j·`by_j` modulo 2^16.
///
/// With the three at 0 … 65535 a tag may say which lattice a point is of ([`same`](Self::same)), or which of its points:
/// with `by_i` 1 and `by_j` n_r + 1 all points of up to 65536 have tags of their own.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Tags {
    /// The tag of (0, 0).
    pub first: u16,
    /// What a step in the first direction adds.
    pub by_i: u16,
    /// What a step in the second direction adds.
    pub by_j: u16,
}

impl Tags {
    /// The same tag for all points.
    #[must_use]
    pub const fn same(tag: u16) -> Self {
        Self { first: tag, by_i: 0, by_j: 0 }
    }

    /// The tag of the point (i, j).
    #[must_use]
    pub const fn at(&self, i: u32, j: u32) -> u16 {
        let by_i = (self.by_i as u32).wrapping_mul(i);
        (self.first as u32).wrapping_add(by_i).wrapping_add((self.by_j as u32).wrapping_mul(j)) as u16
    }
}

/// What is nearest at a pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Visible {
    /// The depth, floor(z + 1/2): smaller is nearer.
    pub z: i16,
    /// The tag of the point.
    pub tag: u16,
}

/// A picture of the nearest points, row by row in the caller's memory, 4 bytes a pixel.
///
/// An entry has z + 2^15 in its upper 16 bits and the tag in its lower ones, and the least of all that fall on a pixel
/// stays: what is nearer, and of equal depths the lower tag. So no order of drawing changes it. 2^32 − 1 is empty; a
/// point of depth 32767 and tag 65535 cannot be told from that.
///
/// ```
/// use embedded_surfaces::forward::{Lattice, Steps, Tags, Visible, VisibilityBuffer};
/// use embedded_surfaces::patch::{BilinearPatch, Surface};
/// // One rises from left to right, the other is level.
/// let ramp = BilinearPatch::from_ints([[[0, 0, 0], [0, 8, 0]], [[8, 0, 8], [8, 8, 8]]])?;
/// let level = BilinearPatch::from_ints([[[0, 0, 5], [0, 8, 5]], [[8, 0, 5], [8, 8, 5]]])?;
/// let mut entries = [0; 9 * 9];
/// let mut picture = VisibilityBuffer::new(&mut entries, 9, 9)?;
/// picture.clear();
/// for (tag, patch) in (1..).zip([ramp, level]) {
///     picture.draw(&Lattice::new(patch.surface(), Steps::uniform(8)?)?, Tags::same(tag));
/// }
/// assert_eq!(picture.get(2, 7), Some(Visible { z: 2, tag: 1 }));
/// assert_eq!(picture.get(5, 7), Some(Visible { z: 5, tag: 1 }));
/// assert_eq!(picture.get(6, 7), Some(Visible { z: 5, tag: 2 }));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, PartialEq, Eq)]
pub struct VisibilityBuffer<'b> {
    /// As many as pixels.
    entries: &'b mut [u32],
    width: u32,
    height: u32,
}

impl<'b> VisibilityBuffer<'b> {
    /// The entry of a pixel where nothing is.
    pub const EMPTY: u32 = u32::MAX;

    /// The picture of `width` × `height` pixels in the first of `entries`, with what stands there: after an
    /// [`EMPTY`](Self::EMPTY) fill, or [`clear`](Self::clear), nothing.
    ///
    /// # Errors
    /// [`VisibilityError::Size`] where there are fewer entries than pixels, or a side is longer than 32768.
    pub fn new(entries: &'b mut [u32], width: u32, height: u32) -> Result<Self, VisibilityError> {
        let len = entries.len();
        let error = VisibilityError::Size { width, height, len };
        if width > MAX_SIDE || height > MAX_SIDE {
            return Err(error);
        }
        // At most 2^30.
        let entries = entries.get_mut(..width as usize * height as usize).ok_or(error)?;
        Ok(Self { entries, width, height })
    }

    /// Makes all pixels empty.
    pub fn clear(&mut self) {
        self.entries.fill(Self::EMPTY);
    }

    /// What is nearest at a pixel; `None` where nothing is, and outside of the picture.
    #[must_use]
    pub fn get(&self, x: i32, y: i32) -> Option<Visible> {
        let entry = *self.entries.get(self.index(x, y).filter(|_| (y as u32) < self.height)?)?;
        (entry != Self::EMPTY).then_some(Visible { z: ((entry >> 16) as i32 - BIAS) as i16, tag: entry as u16 })
    }

    /// The entries, row by row.
    #[must_use]
    pub fn entries(&self) -> &[u32] {
        self.entries
    }

    /// Stores every point of a lattice that is nearer than what is there. Points outside of the picture are left out.
    ///
    /// The points come in an order that is left open, as from [`Lattice::for_each_unordered`]. With the feature `asm`
    /// they are made and stored by assembly on ARMv7-M, in three fifths of the instructions, where the lattice is of a
    /// polynomial surface of degree at most 3, N is a power of two and the accumulator an `i32`, no control point is
    /// outside of the picture, and no tag exceeds 65535. The entries are the same.
    ///
    /// Cost above that of the points: an index, a comparison, a store. Stack: that of the walk, or 1 KB in assembly.
    pub fn draw(&mut self, lattice: &Lattice<'_>, tags: Tags) {
        #[cfg(forward_asm = "v7m")]
        if assembly::draw(self, lattice, tags).is_some() {
            return;
        }
        let store = |p: LatticePoint| self.store(p, tags.at(p.i, p.j));
        // Rows leave more registers there.
        if MULTIPLIES { lattice.for_each(store) } else { lattice.for_each_unordered(store) }
    }

    /// The index of a pixel, beyond all entries where y is outside: |y|·`width` ≤ 2^30 for |y| < 2^15, and what is
    /// below 0 becomes 3·2^30 at least.
    #[inline(always)]
    fn index(&self, x: i32, y: i32) -> Option<usize> {
        ((x as u32) < self.width).then(|| y.wrapping_mul(self.width as i32).wrapping_add(x) as u32 as usize)
    }

    #[inline(always)]
    fn store(&mut self, p: LatticePoint, tag: u16) {
        let Some(entry) = self.index(p.x, p.y).and_then(|at| self.entries.get_mut(at)) else { return };
        let here = (p.z.wrapping_add(BIAS) as u32) << 16 | u32::from(tag);
        if here < *entry {
            *entry = here;
        }
    }
}

/// Rows in two passes: first where the points are, then their depths.
#[cfg(forward_asm = "v7m")]
mod assembly {
    use super::{Tags, VisibilityBuffer};
    use crate::forward::Lattice;
    use crate::forward::asm::{Depths, PIXELS, Places};
    use crate::forward::form::{Form, Kind};
    use crate::forward::joined::Joined;
    use crate::num::Coord;

    /// Whether the net, and so every point, is in the picture.
    fn is_inside(form: &Form<'_>, width: u32, height: u32) -> bool {
        let within = |c: i64, side: u32| (0..i64::from(side)).contains(&((c + (1 << 15)) >> 16));
        form.points().iter().all(|p| within(p.x.bits(), width) && within(p.y.bits(), height))
    }

    /// Whether no tag wraps.
    fn tags_fit(form: &Form<'_>, tags: Tags) -> bool {
        let last = |by: u16, n: u32| u64::from(by) * u64::from(n);
        let (by_i, by_j) = (last(tags.by_i, form.steps.0), last(tags.by_j, form.steps.1));
        let most = if form.kind == Kind::Triangle { by_i.max(by_j) } else { by_i + by_j };
        u64::from(tags.first) + most <= u64::from(u16::MAX)
    }

    #[inline(never)]
    pub(super) fn draw(buffer: &mut VisibilityBuffer<'_>, lattice: &Lattice<'_>, tags: Tags) -> Option<()> {
        let (form, budget) = lattice.plan();
        if !is_inside(form, buffer.width, buffer.height) || !tags_fit(form, tags) {
            return None;
        }
        let walk = &mut Joined::new(form, budget)?;
        let (mut places, mut depths) =
            (Places::new(walk.by(), buffer.width), Depths::new(walk.by(), tags.by_i, buffer.entries));
        let mut pixels = [0; PIXELS];
        walk.each_row(|j, count, [x, y, z]| {
            places.start(x, y);
            depths.start(z, tags.at(0, j));
            let mut left = count;
            while left > 0 {
                let count = left.min(PIXELS as u32);
                places.next(&mut pixels, count);
                depths.next(&pixels, count);
                left -= count;
            }
        });
        Some(())
    }
}

#[cfg(feature = "defmt")]
impl defmt::Format for VisibilityBuffer<'_> {
    fn format(&self, f: defmt::Formatter<'_>) {
        defmt::write!(f, "visibility buffer of {} x {} pixels", self.width, self.height);
    }
}
