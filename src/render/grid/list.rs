//! Facets listed for a frame: made once, drawn band by band.

use super::super::RenderError;
use super::super::tile::Paint;
use super::vertices::{Lit, Vertex};
use super::{Filler, Output, Quad};

/// A facet in a list: what [`Frame::with_facets`](crate::render::Frame::with_facets) keeps in the caller's buffer, 32
/// bytes.
///
/// ```
/// use embedded_surfaces::render::Facet;
/// let entries = [Facet::EMPTY; 2000];
/// assert_eq!(size_of_val(&entries), 64_000);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Facet {
    /// x and y of the first corner in 24 bits; above them the patch, 8 bits in each.
    first: [u32; 2],
    /// What the other corners' x and y are more.
    more: [[i16; 2]; 3],
    depth: [u16; 4],
    level: [u8; 4],
}

impl Facet {
    /// No facet.
    pub const EMPTY: Self = Self { first: [0; 2], more: [[0; 2]; 3], depth: [0; 4], level: [0; 4] };

    fn of(quad: &Quad) -> Self {
        let Quad { corners, patch, .. } = quad;
        let pack = |c: i32, patch: usize| (c as u32 & 0x00ff_ffff) | ((patch as u32) << 24);
        let [a, b, c, d] = corners;
        Self {
            first: [pack(a.x, *patch), pack(a.y, patch >> 8)],
            more: [b, c, d].map(|corner| [(corner.x - a.x) as i16, (corner.y - a.y) as i16]),
            depth: corners.each_ref().map(|corner| corner.depth),
            level: corners.each_ref().map(|corner| corner.level),
        }
    }

    fn quad(&self) -> Quad {
        let Self { first, more, depth, level } = *self;
        let [x, y] = first.map(|c| (c << 8) as i32 >> 8);
        let [a, b, c] = more.map(|[dx, dy]| [x + i32::from(dx), y + i32::from(dy)]);
        let corner = |[x, y]: [i32; 2], k: usize| Vertex { x, y, depth: depth[k], level: level[k], lit: Lit::Both };
        let corners = [corner([x, y], 0), corner(a, 1), corner(b, 2), corner(c, 3)];
        Quad::new(corners, (first[0] >> 24 | first[1] >> 24 << 8) as usize, true)
    }

    /// Its first row.
    fn start(&self) -> i32 {
        let y = (self.first[1] << 8) as i32 >> 8;
        let more = self.more.iter().map(|m| i32::from(m[1])).fold(0, i32::min);
        (y + more + 255) >> 8
    }
}

/// The end of a chain of facets.
const NONE: u16 = u16::MAX;

/// The most facets of a list.
const MOST: usize = NONE as usize;

/// The facets of a frame, chained by the band that they start in.
#[derive(Debug)]
pub(in crate::render) struct Facets<'b> {
    entries: &'b [Facet],
    /// The first facet of each band.
    bands: &'b mut [u16],
    /// The facet after each one, in the order of drawing.
    next: &'b mut [u16],
    /// The facets of bands before that reach further.
    open: u16,
}

/// Writes facets into a list, or counts those for which there is no room.
pub(in crate::render) struct Recorder<'b> {
    entries: &'b mut [Facet],
    window: [i32; 4],
    count: usize,
}

impl<'b> Recorder<'b> {
    /// A list of the facets that meet the columns and rows `window`.
    pub(in crate::render) fn new(entries: &'b mut [Facet], window: [i32; 4]) -> Self {
        Self { entries, window, count: 0 }
    }
}

impl Output for Recorder<'_> {
    fn window(&self) -> [i32; 4] {
        self.window
    }

    fn facet(&mut self, quad: &Quad) {
        if let Some(entry) = self.entries.get_mut(self.count) {
            *entry = Facet::of(quad);
        }
        self.count += 1;
    }
}

impl<'b> Facets<'b> {
    /// Chains what was recorded by bands of `rows` rows, `links` holding one link for each band and each facet.
    pub(in crate::render) fn of(recorder: Recorder<'b>, links: &'b mut [u16], rows: u32) -> Result<Self, RenderError> {
        let Recorder { entries, window: [.., top, bottom], count } = recorder;
        let bands = bottom.abs_diff(top).div_ceil(rows.max(1)) as usize;
        let (given, needed_links) = (entries.len().min(MOST), bands.saturating_add(count));
        let error = RenderError::Facets { needed: count, given, needed_links, given_links: links.len() };
        if count > given || links.len() < needed_links {
            return Err(error);
        }
        let entries: &'b [Facet] = entries.get(..count).ok_or(error)?;
        let (bands, next) = links.split_at_mut_checked(bands).ok_or(error)?;
        let next = next.get_mut(..count).ok_or(error)?;
        bands.fill(NONE);
        for (index, (facet, next)) in entries.iter().zip(next.iter_mut()).enumerate().rev() {
            let first = (facet.start().max(top) - top).unsigned_abs().checked_div(rows).unwrap_or(0);
            if let Some(band) = bands.get_mut(first as usize) {
                *next = *band;
                *band = index as u16;
            }
        }
        Ok(Self { entries, bands, next, open: NONE })
    }

    /// Draws the facets of band number `band`, whose rows end before `end`; bands come in order, each once.
    pub(in crate::render) fn draw<P: Paint>(&mut self, band: usize, end: i32, filler: &mut Filler<'_, '_, P>) {
        let mut fresh = self.bands.get(band).copied().unwrap_or(NONE);
        let (mut open, mut last) = (self.open, NONE);
        self.open = NONE;
        loop {
            // Both chains ascend; so does what stays open.
            let from = if open < fresh { &mut open } else { &mut fresh };
            let index = *from;
            let (Some(facet), Some(next)) = (self.entries.get(usize::from(index)), self.next.get(usize::from(index)))
            else {
                break;
            };
            *from = *next;
            let quad = facet.quad();
            filler.facet(&quad);
            if quad.rows[1] > end {
                match self.next.get_mut(usize::from(last)) {
                    Some(next) => *next = index,
                    None => self.open = index,
                }
                last = index;
            }
        }
        if let Some(next) = self.next.get_mut(usize::from(last)) {
            *next = NONE;
        }
    }
}
