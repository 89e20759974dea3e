//! What happens at a lattice point: clip, depth test, shade, store.

use super::light::{Light, normal};
use super::scene::DepthWindow;
use super::tile::{Fragment, Paint, Tile};
use crate::forward::{Form, Fraction, Site, Visit};
use crate::num::Word;
use crate::patch::{Barycentric, Parameter, SurfaceNet};

/// Draws the points of one patch into a tile.
pub(super) struct Pen<'a, 'b, P: Paint, const SHADED: bool> {
    tile: &'a mut Tile<'b, P::Pixel>,
    paint: &'a P,
    light: &'a Light,
    net: SurfaceNet<'a>,
    form: &'a Form<'a>,
    patch: usize,
    window: DepthWindow,
    fraction: Fraction,
}

impl<'a, 'b, P: Paint, const SHADED: bool> Pen<'a, 'b, P, SHADED> {
    pub(super) fn new(
        tile: &'a mut Tile<'b, P::Pixel>,
        paint: &'a P,
        light: &'a Light,
        (patch, net): (usize, SurfaceNet<'a>),
        (form, scale): (&'a Form<'a>, u128),
        window: DepthWindow,
    ) -> Self {
        Self { tile, paint, light, net, form, patch, window, fraction: Fraction::of(scale, window.bits) }
    }

    /// The level at lattice point (i, j), from its tangents.
    fn level<W: Word>(&self, i: u32, j: u32, tangents: [[W; 3]; 2]) -> u8 {
        let facing = [0, 0, -1];
        self.light.level(normal(tangents).or_else(|| self.normal_inside(i, j)).unwrap_or(facing))
    }

    /// The normal 1/64 of the way from the border inwards: what stands in where a tangent vanishes.
    #[cold]
    #[inline(never)]
    fn normal_inside(&self, i: u32, j: u32) -> Option<[i32; 3]> {
        let half = u64::from(self.form.centred);
        let part = |index: u32, steps: u32, range: u64| {
            let doubled = (2 * u64::from(index) + half) * range;
            1024 + doubled.checked_div(2 * u64::from(steps)).unwrap_or(0) as u32
        };
        let (n_r, n_s) = self.form.steps;
        let tangents = if self.net.is_triangle() {
            let (u, v) = (part(i, n_r, 61 * 1024), part(j, n_s, 61 * 1024));
            let at = Barycentric::new(u, v, (1_u32 << 16).saturating_sub(u + v)).ok()?;
            match self.net {
                SurfaceNet::Triangle(net) => net.partials(at),
                SurfaceNet::RationalTriangle(net) => net.partials(at)?,
                _ => return None,
            }
        } else {
            let at = |index, steps| Parameter::new(part(index, steps, 62 * 1024), 1 << 16).ok();
            let (r, s) = (at(i, n_r)?, at(j, n_s)?);
            match self.net {
                SurfaceNet::Tensor(net) => net.partials(r, s),
                SurfaceNet::RationalTensor(net) => net.partials(r, s)?,
                _ => return None,
            }
        };
        normal(tangents.map(|t| t.to_array().map(|c| c.to_bits())))
    }
}

impl<P: Paint, const SHADED: bool> Visit for Pen<'_, '_, P, SHADED> {
    const TANGENTS: bool = SHADED;

    #[inline(always)]
    fn point<S: Site>(self, at: &S) -> Self {
        let [x, y, z] = at.point();
        if let Some(index) = self.tile.index(x, y) {
            let depth = self.window.depth(z, at.below(2, &self.fraction));
            if self.tile.is_nearest(index, depth) {
                let shade = if SHADED { self.level(at.i(), at.j(), at.tangents()) } else { u8::MAX };
                let pixel = self.paint.pixel(Fragment { x, y, patch: self.patch, shade });
                self.tile.set(index, pixel);
            }
        }
        self
    }
}
