//! What happens at a lattice point: clip, depth test, and the brush where it is seen.

use super::depth::DepthWindow;
use super::light::{Side, normal_on};
use super::tangents::row_range;
use super::tile::{Area, is_nearest, is_seen, occlude};
use crate::forward::{Form, Fraction, Site, Visit};
use crate::patch::{Barycentric, Parameter, SurfaceNet};

/// What points leave in a tile.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Ink {
    /// Colour where a point is nearest.
    Fill,
    /// Depth and nothing else: what hides lines.
    Occlude,
    /// Colour where a point of a line is nearer than other lines, and than surfaces this much behind it.
    Line(u16),
}

/// A point that is seen.
#[derive(Clone, Copy, Debug)]
pub(super) struct Spot {
    pub(super) i: u32,
    pub(super) j: u32,
    pub(super) x: i32,
    pub(super) y: i32,
    pub(super) index: usize,
    pub(super) depth: u16,
}

/// What colours points that are seen.
pub(super) trait Brush {
    /// Colours a point; `normal` comes from a walk that knows it, `None` there where the tangents span no plane.
    fn dab(&mut self, spot: Spot, normal: Option<Option<[i32; 3]>>);
}

/// What sets the colour of a pixel by its level.
pub(super) trait Stain {
    /// Colours the pixel (x, y), number `index` of the tile.
    fn stain(&mut self, index: usize, at: [i32; 2], shade: u8);

    /// Colours pixels of a tile.
    fn stain_all(&mut self, area: &Area, points: &Seen<'_>);
}

/// Points of a run that are seen.
#[derive(Debug)]
pub(super) struct Seen<'r> {
    /// The index in the tile of each point of the run.
    pub(super) index: &'r [u32],
    /// Those that are seen, by how many of the run come after, and their levels.
    pub(super) seen: &'r [u8],
    pub(super) levels: &'r [u8],
}

impl Seen<'_> {
    /// Calls `f` with index, place and level of each point that is seen.
    #[inline(always)]
    pub(super) fn each(&self, area: &Area, mut f: impl FnMut(usize, [i32; 2], u8)) {
        for (k, level) in self.seen.iter().zip(self.levels) {
            let k = self.index.len().wrapping_sub(1).wrapping_sub(usize::from(*k));
            if let Some(index) = self.index.get(k) {
                let row = index.checked_div(area.width).unwrap_or(0);
                let column = index.wrapping_sub(row.wrapping_mul(area.width));
                f(*index as usize, [area.x.wrapping_add_unsigned(column), area.y.wrapping_add_unsigned(row)], *level);
            }
        }
    }
}

/// Draws the points of one lattice into a tile. One type for all colours: what a walker is made for.
pub(super) struct Pen<'p> {
    pub(super) area: Area,
    pub(super) depth: &'p mut [u16],
    pub(super) window: DepthWindow,
    pub(super) fraction: Fraction,
    pub(super) ink: Ink,
    /// Which way the normals that a walk knows point.
    pub(super) side: Side,
    pub(super) form: &'p Form<'p>,
    pub(super) rows: Rows,
    pub(super) points: &'p mut u64,
    pub(super) brush: &'p mut dyn Brush,
}

impl Pen<'_> {
    fn row(&mut self, j: u32) -> bool {
        let wanted = match self.rows {
            Rows::All => true,
            Rows::Every(stride) => j.checked_rem(stride) == Some(0),
            Rows::In(band) => meets(self.form, j, band),
        };
        if wanted {
            *self.points += u64::from(self.form.last_in_row(j)) + 1;
        }
        wanted
    }

    #[inline(always)]
    fn touch<S: Site, const NORMALS: bool>(&mut self, at: &S) {
        let [x, y, z] = at.point();
        let Some(index) = self.area.index(x, y) else { return };
        let Some(stored) = self.depth.get_mut(index) else { return };
        let depth = self.window.depth(z, at.below(2, &self.fraction));
        let seen = match self.ink {
            Ink::Fill => is_nearest(stored, depth),
            Ink::Occlude => occlude(stored, depth),
            Ink::Line(bias) => is_seen(stored, depth, bias),
        };
        if seen {
            let spot = Spot { i: at.i(), j: at.j(), x, y, index, depth };
            let normal = if NORMALS { Some(normal_on(self.side, at.tangents())) } else { None };
            self.brush.dab(spot, normal);
        }
    }
}

/// The visitor is the reference: a walk then copies a pointer, not the pen.
impl Visit for &mut Pen<'_> {
    fn wants_row(&mut self, j: u32) -> bool {
        self.row(j)
    }

    #[inline(always)]
    fn point<S: Site>(self, at: &S) -> Self {
        self.touch::<S, false>(at);
        self
    }
}

/// A pen for walks that know normals.
pub(super) struct NormalPen<'a, 'p>(pub(super) &'a mut Pen<'p>);

impl Visit for NormalPen<'_, '_> {
    const TANGENTS: bool = true;

    fn wants_row(&mut self, j: u32) -> bool {
        self.0.row(j)
    }

    #[inline(always)]
    fn point<S: Site>(self, at: &S) -> Self {
        self.0.touch::<S, true>(at);
        self
    }
}

/// Which rows of a lattice are walked.
#[derive(Clone, Copy, Debug)]
pub(super) enum Rows {
    All,
    /// Those whose number is a multiple.
    Every(u32),
    /// Those that can have points in these pixel rows: the first, and the one after the last.
    In((i32, i32)),
}

impl Rows {
    /// All rows where the net's box lies inside the band, or the net is rational.
    pub(super) fn in_band(form: &Form<'_>, band: (i32, i32)) -> Self {
        let inside = |y: i32| i64::from(y) >= i64::from(band.0) << 16 && i64::from(y) < (i64::from(band.1) - 1) << 16;
        let all = form.weights().is_some() || form.points().iter().all(|p| inside(p.y.to_bits()));
        if all { Self::All } else { Self::In(band) }
    }
}

/// Whether the control values of row `j` leave it a chance to meet the band.
fn meets(form: &Form<'_>, j: u32, band: (i32, i32)) -> bool {
    let (low, high) = row_range(form, j);
    // A coordinate y is drawn in row floor(y + 1/2); 8 units are the margin of the range.
    let half = 1_i64 << 15;
    high + half + 8 >= i64::from(band.0) << 16 && low + half - 8 < i64::from(band.1) << 16
}

/// The normal of a patch 1/64 of the way from lattice point (i, j) inwards: what stands in where a tangent vanishes.
#[cold]
#[inline(never)]
pub(super) fn normal_inside(net: SurfaceNet<'_>, form: &Form<'_>, i: u32, j: u32) -> Option<[i32; 3]> {
    normal_on(Side::Viewer, tangents_inside(net, form, i, j)?)
}

/// The tangents there.
#[cold]
#[inline(never)]
pub(super) fn tangents_inside(net: SurfaceNet<'_>, form: &Form<'_>, i: u32, j: u32) -> Option<[[i64; 3]; 2]> {
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
    Some(tangents.map(|t| t.to_array().map(|c| c.to_bits())))
}

/// Barycentric coordinates (u, v, w) from those of a turned triangle.
pub(super) fn unturned<T>(turn: u8, [a, b, c]: [T; 3]) -> [T; 3] {
    match turn {
        0 => [a, b, c],
        1 => [b, c, a],
        _ => [c, a, b],
    }
}
