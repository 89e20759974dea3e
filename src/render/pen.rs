//! What happens at a lattice point: clip, depth test, level, store.

use super::depth::DepthWindow;
use super::light::{Light, normal};
use super::style::Style;
use super::tile::{Fragment, Paint, Tile};
use crate::forward::{Form, Fraction, Site, Visit};
use crate::num::Word;
use crate::patch::{Barycentric, Parameter, SurfaceNet};

/// Draws the points of one patch into a tile; `NORMALS`: its style needs them.
pub(super) struct Pen<'a, 'b, P: Paint, const NORMALS: bool> {
    pub(super) tile: &'a mut Tile<'b, P::Pixel>,
    pub(super) paint: &'a P,
    pub(super) light: &'a Light,
    pub(super) style: Style,
    pub(super) net: SurfaceNet<'a>,
    pub(super) form: &'a Form<'a>,
    pub(super) patch: usize,
    pub(super) window: DepthWindow,
    pub(super) fraction: Fraction,
}

impl<P: Paint, const NORMALS: bool> Pen<'_, '_, P, NORMALS> {
    /// The level at lattice point (i, j), from its tangents.
    fn shade<W: Word>(&self, i: u32, j: u32, tangents: [[W; 3]; 2]) -> u8 {
        let facing = [0, 0, -1];
        let n = normal(tangents).or_else(|| normal_inside(self.net, self.form, i, j)).unwrap_or(facing);
        match self.style {
            Style::Glossy(gloss) => self.light.glossy(n, gloss),
            _ => self.light.level(n),
        }
    }
}

impl<P: Paint, const NORMALS: bool> Visit for Pen<'_, '_, P, NORMALS> {
    const TANGENTS: bool = NORMALS;

    #[inline(always)]
    fn point<S: Site>(self, at: &S) -> Self {
        let [x, y, z] = at.point();
        if let Some(index) = self.tile.index(x, y) {
            let depth = self.window.depth(z, at.below(2, &self.fraction));
            if self.tile.is_nearest(index, depth) {
                let shade = match self.style {
                    _ if NORMALS => self.shade(at.i(), at.j(), at.tangents()),
                    Style::DepthCued { near, far } => self.window.cue(depth, near, far),
                    _ => u8::MAX,
                };
                let pixel = self.paint.pixel(Fragment { x, y, patch: self.patch, shade });
                self.tile.set(index, pixel);
            }
        }
        self
    }
}

/// Leaves a patch's depth and nothing else: what hides lines.
pub(super) struct Occluder<'a, 'b, P> {
    pub(super) tile: &'a mut Tile<'b, P>,
    pub(super) window: DepthWindow,
    pub(super) fraction: Fraction,
}

impl<P: Copy> Visit for Occluder<'_, '_, P> {
    #[inline(always)]
    fn point<S: Site>(self, at: &S) -> Self {
        let [x, y, z] = at.point();
        if let Some(index) = self.tile.index(x, y) {
            let depth = self.window.depth(z, at.below(2, &self.fraction));
            self.tile.occlude(index, depth);
        }
        self
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
    fn wants_row(&self, j: u32) -> bool {
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
    normal(tangents_inside(net, form, i, j)?)
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
    let tangents = if net.is_triangle() {
        let (u, v) = (part(i, n_r, 61 * 1024), part(j, n_s, 61 * 1024));
        let at = Barycentric::new(u, v, (1_u32 << 16).saturating_sub(u + v)).ok()?;
        match net {
            SurfaceNet::Triangle(net) => net.partials(at),
            SurfaceNet::RationalTriangle(net) => net.partials(at)?,
            _ => return None,
        }
    } else {
        let at = |index, steps| Parameter::new(part(index, steps, 62 * 1024), 1 << 16).ok();
        let (r, s) = (at(i, n_r)?, at(j, n_s)?);
        match net {
            SurfaceNet::Tensor(net) => net.partials(r, s),
            SurfaceNet::RationalTensor(net) => net.partials(r, s)?,
            _ => return None,
        }
    };
    Some(tangents.map(|t| t.to_array().map(|c| c.to_bits())))
}
