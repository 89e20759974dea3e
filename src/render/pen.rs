//! What happens at a lattice point: clip, depth test, shade, store.

use super::light::{Light, normal};
use super::scene::DepthWindow;
use super::tile::{Fragment, Paint, Tile};
use crate::forward::{At, Form, Kernel, Residual, Visit};
use crate::num::Word;
use crate::patch::{Barycentric, Parameter, SurfaceNet};

/// Turns the z residual e in 0 ..= N − 1 into the k bits below a whole z: about e·2^k/N, without a division.
///
/// With N' = ⌊N/2^s⌋ of at most 16 bits and q = ⌊2^(16+k)/(N' + 1)⌋ it is ⌊⌊e/2^s⌋·q/2^16⌋: below 2^k, never
/// decreasing in e, and at most one below the exact value for k ≤ 8.
#[derive(Clone, Copy, Debug)]
struct Fraction {
    shift: u32,
    factor: u32,
}

impl Fraction {
    fn of<W: Word>(scale: W, bits: u32) -> Self {
        let used = <W as Word>::BITS - scale.leading_zeros();
        let shift = used.saturating_sub(16);
        let high: i64 = (scale >> shift as usize).as_();
        Self { shift, factor: (1_u32 << (16 + bits)).checked_div(high as u32 + 1).unwrap_or(0) }
    }

    #[inline(always)]
    fn read<W: Word>(&self, residual: W) -> u32 {
        let high: i32 = (residual >> self.shift as usize).as_();
        (high as u32).wrapping_mul(self.factor) >> 16
    }
}

/// Draws the points of one patch into a tile.
pub(super) struct Pen<'a, 'b, P: Paint, const SHADED: bool> {
    tile: &'a mut Tile<'b, P::Pixel>,
    paint: &'a P,
    light: &'a Light,
    net: SurfaceNet<'a>,
    steps: (u32, u32),
    patch: usize,
    window: DepthWindow,
    fraction: Fraction,
}

impl<'a, 'b, P: Paint, const SHADED: bool> Pen<'a, 'b, P, SHADED> {
    #[allow(clippy::too_many_arguments, reason = "one call site")]
    pub(super) fn new<W: Word>(
        tile: &'a mut Tile<'b, P::Pixel>,
        paint: &'a P,
        light: &'a Light,
        (patch, net): (usize, SurfaceNet<'a>),
        form: &Form<'_>,
        window: DepthWindow,
        kernel: &Residual<W>,
    ) -> Self {
        let fraction = Fraction::of(kernel.scale(), window.bits);
        Self { tile, paint, light, net, steps: form.steps, patch, window, fraction }
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
        let part = |index: u32, steps: u32, range: u64| {
            1024 + (u64::from(index) * range).checked_div(u64::from(steps)).unwrap_or(0) as u32
        };
        let tangents = match self.net {
            SurfaceNet::Tensor(net) => {
                let at = |index, steps| Parameter::new(part(index, steps, 62 * 1024), 1 << 16).ok();
                net.partials(at(i, self.steps.0)?, at(j, self.steps.1)?)
            }
            SurfaceNet::Triangle(net) => {
                let (u, v) = (part(i, self.steps.0, 61 * 1024), part(j, self.steps.1, 61 * 1024));
                net.partials(Barycentric::new(u, v, (1_u32 << 16).saturating_sub(u + v)).ok()?)
            }
        };
        normal(tangents.map(|t| t.to_array().map(|c| c.to_bits())))
    }
}

impl<P: Paint, const SHADED: bool> Visit for Pen<'_, '_, P, SHADED> {
    const TANGENTS: bool = SHADED;

    #[inline(always)]
    fn point<K: Kernel, const R: usize>(self, at: &At<'_, K, R>) -> Self {
        let [x, y, z] = at.point;
        if let Some(index) = self.tile.index(x, y) {
            let depth = self.window.depth(z, self.fraction.read(at.residual(2)));
            if self.tile.is_nearest(index, depth) {
                let shade = if SHADED { self.level(at.i, at.j, at.tangents()) } else { u8::MAX };
                let pixel = self.paint.pixel(Fragment { x, y, patch: self.patch, shade });
                self.tile.set(index, pixel);
            }
        }
        self
    }
}
