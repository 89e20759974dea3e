//! What happens at a lattice point: clip, depth test, level, store.

use super::depth::DepthWindow;
use super::light::{Light, normal};
use super::style::Style;
use super::tangents::{Tangents, row_range};
use super::tile::{Fragment, Paint, Tile};
use crate::forward::{Form, Fraction, Site, Visit};
use crate::num::{Coord, Word};
use crate::patch::{Barycentric, Parameter, SurfaceNet};

/// What the points of a patch leave in a tile.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Ink {
    /// Colour where a point is nearest.
    Fill,
    /// Depth and nothing else: what hides lines.
    Occlude,
}

/// Draws the points of one piece into a tile. `RATIONAL`: the walk gives tangents; else they come from the net.
pub(super) struct Pen<'a, 'b, P: Paint, const RATIONAL: bool> {
    pub(super) tile: &'a mut Tile<'b, P::Pixel>,
    pub(super) paint: &'a P,
    pub(super) light: &'a Light,
    pub(super) style: Style,
    pub(super) ink: Ink,
    pub(super) net: SurfaceNet<'a>,
    pub(super) form: &'a Form<'a>,
    /// Of the full net, where positions may be of a rounded one.
    pub(super) tangents: Tangents<'a>,
    pub(super) patch: usize,
    pub(super) window: DepthWindow,
    pub(super) fraction: Fraction,
    /// Which rows of the lattice meet the tile.
    pub(super) rows: Rows<'a>,
    /// The points walked.
    pub(super) points: &'a mut u64,
}

impl<P: Paint, const RATIONAL: bool> Pen<'_, '_, P, RATIONAL> {
    /// The level at lattice point (i, j), from its tangents.
    fn shade<W: Word>(&self, i: u32, j: u32, tangents: [[W; 3]; 2]) -> u8 {
        let facing = [0, 0, -1];
        let n = normal(tangents).or_else(|| normal_inside(self.net, self.form, i, j)).unwrap_or(facing);
        match self.style {
            Style::Glossy(gloss) => self.light.glossy(n, gloss),
            _ => self.light.level(n),
        }
    }

    /// A point that is seen.
    #[inline(never)]
    fn store<S: Site>(&mut self, at: &S, [x, y]: [i32; 2], index: usize, depth: u16) {
        let shade = match self.style {
            Style::Shaded | Style::Glossy(_) if RATIONAL => self.shade(at.i(), at.j(), at.tangents()),
            Style::Shaded | Style::Glossy(_) => {
                let tangents = self.tangents.at(at.i(), at.j());
                self.shade(at.i(), at.j(), tangents)
            }
            Style::DepthCued { near, far } => self.window.cue(depth, near, far),
            _ => u8::MAX,
        };
        let pixel = self.paint.pixel(Fragment { x, y, patch: self.patch, shade });
        self.tile.set(index, pixel);
    }
}

impl<P: Paint, const RATIONAL: bool> Visit for Pen<'_, '_, P, RATIONAL> {
    const TANGENTS: bool = RATIONAL;

    fn wants_row(&mut self, j: u32) -> bool {
        let wanted = self.rows.meets(j);
        if wanted {
            *self.points += u64::from(self.form.last_in_row(j)) + 1;
        }
        wanted
    }

    #[inline(always)]
    fn point<S: Site>(mut self, at: &S) -> Self {
        let [x, y, z] = at.point();
        if let Some(index) = self.tile.index(x, y) {
            let depth = self.window.depth(z, at.below(2, &self.fraction));
            match self.ink {
                Ink::Occlude => self.tile.occlude(index, depth),
                Ink::Fill if self.tile.is_nearest(index, depth) => self.store(at, [x, y], index, depth),
                Ink::Fill => {}
            }
        }
        self
    }
}

/// Which rows of a lattice can have points in a band of pixel rows.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rows<'a> {
    /// The lattice, unless all its rows are wanted.
    form: Option<&'a Form<'a>>,
    /// The first pixel row and the one after the last.
    band: (i32, i32),
}

impl<'a> Rows<'a> {
    /// All rows where the net's box lies inside the band, or the net is rational.
    pub(super) fn of(form: &'a Form<'a>, band: (i32, i32)) -> Self {
        let inside = |y: i64| y >= i64::from(band.0) << 16 && y < (i64::from(band.1) - 1) << 16;
        let all = form.weights().is_some() || form.points().iter().all(|p| inside(p.y.bits()));
        Self { form: (!all).then_some(form), band }
    }

    /// Whether the control values of row `j` leave it a chance to meet the band.
    fn meets(&self, j: u32) -> bool {
        let Some(form) = self.form else { return true };
        let (low, high) = row_range(form, j);
        // A coordinate y is drawn in row floor(y + 1/2); 8 units are the margin of the range.
        let half = 1_i64 << 15;
        high + half + 8 >= i64::from(self.band.0) << 16 && low + half - 8 < i64::from(self.band.1) << 16
    }
}

/// Draws the rows of a lattice whose number is a multiple of `stride` as lines.
pub(super) struct Liner<'a, 'b, P: Paint> {
    pub(super) tile: &'a mut Tile<'b, P::Pixel>,
    pub(super) paint: &'a P,
    pub(super) patch: usize,
    pub(super) window: DepthWindow,
    pub(super) fraction: Fraction,
    pub(super) stride: u32,
}

impl<P: Paint> Visit for Liner<'_, '_, P> {
    fn wants_row(&mut self, j: u32) -> bool {
        j.checked_rem(self.stride) == Some(0)
    }

    #[inline(always)]
    fn point<S: Site>(self, at: &S) -> Self {
        let [x, y, z] = at.point();
        if let Some(index) = self.tile.index(x, y) {
            let depth = self.window.depth(z, at.below(2, &self.fraction));
            if self.tile.is_seen(index, depth, self.window.bias()) {
                let pixel = self.paint.pixel(Fragment { x, y, patch: self.patch, shade: u8::MAX });
                self.tile.set(index, pixel);
            }
        }
        self
    }
}

/// The normal of a patch 1/64 of the way from lattice point (i, j) inwards: what stands in where a tangent vanishes.
#[cold]
#[inline(never)]
pub(super) fn normal_inside(net: SurfaceNet<'_>, form: &Form<'_>, i: u32, j: u32) -> Option<[i32; 3]> {
    let half = u64::from(form.centred);
    let part = |index: u32, steps: u32, range: u64| {
        let doubled = (2 * u64::from(index) + half) * range;
        1024 + doubled.checked_div(2 * u64::from(steps)).unwrap_or(0) as u32
    };
    let (n_r, n_s) = form.steps;
    let turn = form.turn();
    let tangents = if net.is_triangle() {
        let (a, b) = (part(i, n_r, 61 * 1024), part(j, n_s, 61 * 1024));
        let [u, v, w] = unturned(turn, [a, b, (1_u32 << 16).saturating_sub(a + b)]);
        let at = Barycentric::new(u, v, w).ok()?;
        match net {
            SurfaceNet::Triangle(net) => net.partials(at),
            SurfaceNet::RationalTriangle(net) => net.partials(at)?,
            _ => return None,
        }
    } else {
        let at = |index, steps| Parameter::new(part(index, steps, 62 * 1024), 1 << 16).ok();
        let (a, b) = (at(i, n_r)?, at(j, n_s)?);
        let (r, s) = if turn == 0 { (a, b) } else { (b, a) };
        match net {
            SurfaceNet::Tensor(net) => net.partials(r, s),
            SurfaceNet::RationalTensor(net) => net.partials(r, s)?,
            _ => return None,
        }
    };
    normal(tangents.map(|t| t.to_array().map(|c| c.to_bits())))
}

/// Barycentric coordinates (u, v, w) from those of a turned triangle.
pub(super) fn unturned<T>(turn: u8, [a, b, c]: [T; 3]) -> [T; 3] {
    match turn {
        0 => [a, b, c],
        1 => [b, c, a],
        _ => [c, a, b],
    }
}
