//! Rectangles of pixels in the caller's buffers.

use super::RenderError;

/// A rectangle of pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Area {
    /// The leftmost column.
    pub x: i32,
    /// The uppermost row.
    pub y: i32,
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
}

impl Area {
    /// The number of pixels.
    #[must_use]
    pub const fn pixels(&self) -> usize {
        self.width as usize * self.height as usize
    }

    /// Between 1 and 32768 pixels a side: index arithmetic then fits every target.
    pub(super) const fn is_drawable(&self) -> bool {
        const SIDES: u32 = 1 << 15;
        self.width > 0 && self.width <= SIDES && self.height > 0 && self.height <= SIDES
    }

    /// The index of a pixel inside, row by row.
    #[inline(always)]
    pub(super) fn index(&self, x: i32, y: i32) -> Option<usize> {
        let (column, row) = (x.wrapping_sub(self.x) as u32, y.wrapping_sub(self.y) as u32);
        (column < self.width && row < self.height).then(|| row as usize * self.width as usize + column as usize)
    }
}

/// What a [`Paint`] sees: a pixel on its way to the buffer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Fragment {
    /// The pixel's column.
    pub x: i32,
    /// The pixel's row.
    pub y: i32,
    /// The index of the patch in its scene.
    pub patch: usize,
    /// The grey level, 0 ..= 255.
    pub shade: u8,
}

/// Turns shaded pixels into a colour. Implemented by closures and by the materials of [`crate::graphics`].
pub trait Paint {
    /// What the colour buffer holds.
    type Pixel: Copy;

    /// The colour of a pixel.
    fn pixel(&self, fragment: Fragment) -> Self::Pixel;
}

impl<P: Copy, F: Fn(Fragment) -> P> Paint for F {
    type Pixel = P;

    fn pixel(&self, fragment: Fragment) -> P {
        self(fragment)
    }
}

/// What the depth buffer holds: a depth of 15 bits, and a lowest bit that is set where no colour was drawn. A pixel
/// that nothing was drawn to.
const FAR: u16 = u16::MAX;

/// A rectangle of pixels in the caller's colour and depth buffers, row by row.
///
/// Memory: the two buffers, one pixel and one `u16` per pixel.
///
/// ```
/// use embedded_surfaces::render::{Area, Tile};
/// let (mut colour, mut depth) = ([0_u8; 64], [0; 64]);
/// let tile = Tile::new(Area { x: 0, y: 0, width: 8, height: 8 }, &mut colour, &mut depth, 7)?;
/// assert_eq!(tile.pixels(), [7; 64]);
/// assert!(!tile.is_covered(0));
/// # Ok::<(), embedded_surfaces::render::RenderError>(())
/// ```
#[derive(Debug)]
pub struct Tile<'b, P> {
    area: Area,
    colour: &'b mut [P],
    depth: &'b mut [u16],
}

impl<'b, P: Copy> Tile<'b, P> {
    /// The rectangle `area`, cleared to `background`. Longer buffers are used from the start.
    ///
    /// # Errors
    /// [`RenderError::Area`] for an area without pixels or with a side above 32768, [`RenderError::Buffer`] for a
    /// buffer too small.
    pub fn new(area: Area, colour: &'b mut [P], depth: &'b mut [u16], background: P) -> Result<Self, RenderError> {
        if !area.is_drawable() {
            return Err(RenderError::Area { width: area.width, height: area.height });
        }
        let needed = area.pixels();
        let error = RenderError::Buffer { needed, colour: colour.len(), depth: depth.len() };
        let (Some(colour), Some(depth)) = (colour.get_mut(..needed), depth.get_mut(..needed)) else {
            return Err(error);
        };
        fill_aligned(depth, FAR);
        fill(colour, background);
        Ok(Self { area, colour, depth })
    }

    /// The rectangle.
    #[must_use]
    pub const fn area(&self) -> Area {
        self.area
    }

    /// The colours, row by row.
    #[must_use]
    pub fn pixels(&self) -> &[P] {
        self.colour
    }

    /// Whether something was drawn to the pixel with this index in [`pixels`](Self::pixels).
    #[must_use]
    pub fn is_covered(&self, index: usize) -> bool {
        self.depth.get(index).is_some_and(|d| d & 1 == 0)
    }

    /// Whether something was drawn to the pixel (x, y).
    #[must_use]
    pub fn covers(&self, x: i32, y: i32) -> bool {
        self.area.index(x, y).is_some_and(|index| self.is_covered(index))
    }

    /// The rectangle, the colours and the depths.
    pub(super) fn parts(&mut self) -> (Area, &mut [P], &mut [u16]) {
        (self.area, self.colour, self.depth)
    }
}

/// Fills a buffer, 32 elements at a time: in pairs, which cores that store words anywhere store as one.
fn fill<T: Copy>(buffer: &mut [T], value: T) {
    let pair = core::hint::black_box([value; 2]);
    let (pairs, rest) = buffer.as_chunks_mut::<2>();
    let (chunks, others) = pairs.as_chunks_mut::<16>();
    for chunk in chunks {
        *chunk = [pair; 16];
        // Keeps the compiler from making a call of this loop, to one that takes twice as long.
        core::hint::black_box(());
    }
    others.as_flattened_mut().fill(value);
    rest.fill(value);
}

/// Fills a buffer of depths, by whole words between its ends.
fn fill_aligned(buffer: &mut [u16], value: u16) {
    let (start, words, end) = bytemuck::pod_align_to_mut::<u16, [u32; 16]>(buffer);
    // Opaque, so that the loop is kept and no call made of it.
    let word = core::hint::black_box(u32::from(value) << 16 | u32::from(value));
    for words in words {
        *words = [word; 16];
        // As in `fill`.
        core::hint::black_box(());
    }
    start.fill(value);
    end.fill(value);
}

/// Whether `depth` is nearer than what is stored; it is stored then, as drawn.
#[inline(always)]
pub(super) fn is_nearest(stored: &mut u16, depth: u16) -> bool {
    let nearer = depth < *stored >> 1;
    if nearer {
        *stored = depth << 1;
    }
    nearer
}

/// Stores `depth` without a colour where it is nearer; nothing is to be coloured.
#[inline(always)]
pub(super) fn occlude(stored: &mut u16, depth: u16) -> bool {
    if depth < *stored >> 1 {
        *stored = (depth << 1) | 1;
    }
    false
}

/// Whether a line at `depth` is seen: nearer than any line, at most `bias` behind a surface. Stored then.
#[inline(always)]
pub(super) fn is_seen(stored: &mut u16, depth: u16, bias: u16) -> bool {
    let seen = if *stored & 1 == 0 { depth < *stored >> 1 } else { depth.saturating_sub(bias) <= *stored >> 1 };
    if seen {
        *stored = depth << 1;
    }
    seen
}

#[cfg(feature = "defmt")]
impl<P> defmt::Format for Tile<'_, P> {
    fn format(&self, f: defmt::Formatter<'_>) {
        let drawn = self.depth.iter().filter(|d| **d & 1 == 0).count();
        defmt::write!(f, "tile of {}, {} pixels drawn", self.area, drawn);
    }
}
