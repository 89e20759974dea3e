//! Pictures pulled band by band.

use super::grid::{Facet, Facets, Filler};
use super::notes::Notes;
use super::tile::{Area, Paint, Tile};
use super::{RenderError, Scene};
use crate::patch::Surface;

/// What drawing cost.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Statistics {
    /// Patches drawn; one that meets several bands counts in each, and so do its pieces and splits.
    pub patches: u32,
    /// Pieces of patches that were sampled.
    pub pieces: u32,
    /// Splits of patches and pieces at a midpoint.
    pub splits: u32,
    /// Lattice points generated.
    pub points: u64,
    /// Vertices of grids generated.
    pub vertices: u64,
    /// Facets filled; one that meets several bands counts in each, but for a list, where it counts once.
    pub facets: u64,
}

impl core::ops::AddAssign for Statistics {
    fn add_assign(&mut self, other: Self) {
        self.patches += other.patches;
        self.pieces += other.pieces;
        self.splits += other.splits;
        self.points += other.points;
        self.vertices += other.vertices;
        self.facets += other.facets;
    }
}

/// A finished band: a rectangle as wide as the frame and its pixels, row by row.
///
/// It borrows the colour buffer only, so the next band can be drawn into another one while this one is sent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Band<'b, P> {
    area: Area,
    pixels: &'b [P],
}

impl<'b, P> Band<'b, P> {
    /// The rectangle.
    #[must_use]
    pub const fn area(&self) -> Area {
        self.area
    }

    /// The pixels, row by row.
    #[must_use]
    pub const fn pixels(&self) -> &'b [P] {
        self.pixels
    }
}

/// A picture of a scene, drawn band by band from the top as the caller pulls.
///
/// ```
/// use embedded_surfaces::patch::BilinearPatch;
/// use embedded_surfaces::render::{Area, Fragment, Frame, Light, Scene, Style};
/// let square = [BilinearPatch::from_ints([[[1, 1, 0], [1, 6, 0]], [[6, 1, 0], [6, 6, 0]]])?];
/// let scene = Scene::new(&square, Light::default(), Style::Shaded)?;
/// let grey = |f: Fragment| f.shade;
/// let mut frame = Frame::new(scene, &grey, 0, Area { x: 0, y: 0, width: 8, height: 8 }, 3)?;
/// let (mut colour, mut depth, mut rows) = ([0; 24], [0; 24], 0);
/// while let Some(band) = frame.next_band(&mut colour, &mut depth)? {
///     rows += band.area().height; // 3, 3 and 2: send band.pixels() here
/// }
/// assert_eq!(rows, 8);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct Frame<'a, S, P: Paint> {
    scene: Scene<'a, S>,
    paint: &'a P,
    background: P::Pixel,
    area: Area,
    rows: u32,
    next: u32,
    statistics: Statistics,
    notes: Option<&'a mut Notes>,
    /// The list, and the row that it starts at.
    facets: Option<(Facets<'a>, u32)>,
}

impl<'a, S: Surface, P: Paint> Frame<'a, S, P> {
    /// A picture of the pixels in `area`, in bands of `rows` rows; the last one may be shorter.
    ///
    /// # Errors
    /// [`RenderError::Area`] for an area without pixels, a side above 32768, or bands of no rows.
    pub fn new(
        scene: Scene<'a, S>,
        paint: &'a P,
        background: P::Pixel,
        area: Area,
        rows: u32,
    ) -> Result<Self, RenderError> {
        if !area.is_drawable() {
            return Err(RenderError::Area { width: area.width, height: area.height });
        }
        if rows == 0 {
            return Err(RenderError::Area { width: area.width, height: rows });
        }
        let rows = rows.min(area.height);
        let statistics = Statistics::default();
        Ok(Self { scene, paint, background, area, rows, next: 0, statistics, notes: None, facets: None })
    }

    /// The same picture, the facets of the bands to come made once instead of anew for each band that they meet: for bands of
    /// [`Fill::Grid`](super::Fill::Grid). Scenes that have no facets ignore the list.
    ///
    /// `links` holds one number for each band and each facet. A teapot of 320 × 240 pixels in bands of 16 rows at a
    /// tolerance of 1 pixel takes 1472 facets, 47 KB, and 3 KB of links; without its back sides 773, 25 KB and 1.6 KB.
    ///
    /// ```
    /// use embedded_surfaces::num::I16F16;
    /// use embedded_surfaces::patch::BilinearPatch;
    /// use embedded_surfaces::render::{Area, Facet, Fill, Fragment, Frame, Light, RenderError, Scene, Style};
    /// use embedded_surfaces::subdivide::{PatchTopology, topology};
    /// let square = [BilinearPatch::from_ints([[[1, 1, 0], [1, 6, 0]], [[6, 1, 0], [6, 6, 0]]])?];
    /// let mut edges = [PatchTopology::default()];
    /// topology(&square, &mut edges)?;
    /// let scene = Scene::new(&square, Light::default(), Style::Shaded)?.with_topology(&edges)?;
    /// let scene = scene.with_fill(Fill::Grid { tolerance: I16F16::ONE })?;
    /// let grey = |f: Fragment| f.shade;
    /// let area = Area { x: 0, y: 0, width: 8, height: 8 };
    /// let refused = Frame::new(scene, &grey, 0, area, 3)?.with_facets(&mut [], &mut []).map(|_| ());
    /// let needed = RenderError::Facets { needed: 1, given: 0, needed_links: 4, given_links: 0 };
    /// assert_eq!(refused, Err(needed));
    /// let (mut facets, mut links) = ([Facet::EMPTY; 1], [0; 4]);
    /// let mut frame = Frame::new(scene, &grey, 0, area, 3)?.with_facets(&mut facets, &mut links)?;
    /// let (mut colour, mut depth) = ([0; 24], [0; 24]);
    /// while let Some(band) = frame.next_band(&mut colour, &mut depth)? {
    ///     // Send band.pixels().
    /// }
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`RenderError::Facets`] says how many there must be.
    pub fn with_facets(mut self, facets: &'a mut [Facet], links: &'a mut [u16]) -> Result<Self, RenderError> {
        let height = self.area.height - self.next;
        let left = Area { y: self.area.y.saturating_add_unsigned(self.next), height, ..self.area };
        if let Some((facets, statistics)) = self.scene.facets(left, self.rows, facets, links)? {
            self.facets = Some((facets, self.next));
            self.statistics += statistics;
        }
        Ok(self)
    }

    /// The same picture, where bands of exact points remember what is done with pieces that reach into the next one instead
    /// of finding it out anew: polynomial tensor-product patches of degree 3 or less. Others ignore the notes, and so do
    /// facets and lines. A teapot of 320 × 240 pixels in bands of 16 rows takes 9 % fewer instructions.
    ///
    /// ```
    /// use embedded_surfaces::patch::BilinearPatch;
    /// use embedded_surfaces::render::{Area, Fragment, Frame, Light, Notes, Scene, Style};
    /// let square = [BilinearPatch::from_ints([[[1, 1, 0], [1, 6, 0]], [[6, 1, 0], [6, 6, 0]]])?];
    /// let scene = Scene::new(&square, Light::default(), Style::Shaded)?;
    /// let (grey, mut notes) = (|f: Fragment| f.shade, Notes::EMPTY);
    /// let area = Area { x: 0, y: 0, width: 8, height: 8 };
    /// let mut frame = Frame::new(scene, &grey, 0, area, 3)?.with_notes(&mut notes);
    /// let (mut colour, mut depth) = ([0; 24], [0; 24]);
    /// while let Some(band) = frame.next_band(&mut colour, &mut depth)? {
    ///     // Send band.pixels().
    /// }
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn with_notes(mut self, notes: &'a mut Notes) -> Self {
        *notes = Notes::EMPTY;
        self.notes = Some(notes);
        self
    }

    /// The pixels that each buffer must hold.
    #[must_use]
    pub const fn band_pixels(&self) -> usize {
        self.area.width as usize * self.rows as usize
    }

    /// The next band, drawn into `colour` with the help of `depth`; `None` after the last.
    ///
    /// # Errors
    /// [`RenderError::Buffer`] for a buffer too small; nothing is lost, call again with larger ones.
    pub fn next_band<'b>(
        &mut self,
        colour: &'b mut [P::Pixel],
        depth: &mut [u16],
    ) -> Result<Option<Band<'b, P::Pixel>>, RenderError> {
        let left = self.area.height - self.next;
        if left == 0 {
            return Ok(None);
        }
        let area = Area { y: self.area.y.saturating_add_unsigned(self.next), height: self.rows.min(left), ..self.area };
        let pixels = {
            let needed = area.pixels();
            let error = RenderError::Buffer { needed, colour: colour.len(), depth: depth.len() };
            let colour = colour.get_mut(..needed).ok_or(error)?;
            let mut tile = Tile::new(area, &mut *colour, depth, self.background)?;
            match &mut self.facets {
                Some((facets, first)) => {
                    let band = (self.next - *first).checked_div(self.rows).unwrap_or(0) as usize;
                    let end = area.y.saturating_add_unsigned(area.height);
                    facets.draw(band, end, &mut Filler::new(&mut tile, self.paint));
                }
                None => {
                    let mut notes = self.notes.as_deref_mut();
                    if let Some(notes) = &mut notes {
                        notes.turn();
                    }
                    self.statistics += self.scene.draw_noted(&mut tile, self.paint, notes);
                }
            }
            &*colour
        };
        self.next += area.height;
        Ok(Some(Band { area, pixels }))
    }

    /// What drawing has cost so far.
    #[must_use]
    pub const fn statistics(&self) -> Statistics {
        self.statistics
    }
}

#[cfg(feature = "defmt")]
mod format {
    use super::{Band, Frame};
    use crate::render::Paint;
    use defmt::{Format, Formatter};

    impl<P> Format for Band<'_, P> {
        fn format(&self, f: Formatter<'_>) {
            defmt::write!(f, "band of {}", self.area);
        }
    }

    impl<S, P: Paint> Format for Frame<'_, S, P> {
        fn format(&self, f: Formatter<'_>) {
            let (area, rows, next) = (self.area, self.rows, self.next);
            defmt::write!(f, "frame of {} in bands of {} rows, {} rows drawn, {}", area, rows, next, self.scene);
        }
    }
}
