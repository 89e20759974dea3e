//! Step counts: the paper's bound, the hole-free count, and the cheapest sampling.

use super::bounds::{Axis, ceil_div, unit};
use super::form::Form;
use super::{LatticeError, MAX_STEPS};
use crate::patch::{CurveNet, RationalCurveNet, SurfaceNet};

/// How many steps a lattice takes in the two parameter directions; equal for triangles.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Steps {
    pub(super) r: u32,
    pub(super) s: u32,
}

/// How a surface is sampled without holes: a lattice, and the centres of its cells where that takes fewer points.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Sampling {
    /// The step counts of the lattice.
    pub steps: Steps,
    /// Whether the cells' centres are sampled too (the quincunx).
    pub centres: bool,
}

impl Steps {
    /// `r` × `s` steps.
    ///
    /// # Errors
    /// [`LatticeError::Steps`] unless both are in 1 ..= 2^24.
    pub const fn new(r: u32, s: u32) -> Result<Self, LatticeError> {
        if r == 0 || s == 0 || r > MAX_STEPS || s > MAX_STEPS {
            return Err(LatticeError::Steps { r, s });
        }
        Ok(Self { r, s })
    }

    /// `n` steps in both directions.
    ///
    /// # Errors
    /// [`LatticeError::Steps`] unless n is in 1 ..= 2^24.
    pub const fn uniform(n: u32) -> Result<Self, LatticeError> {
        Self::new(n, n)
    }

    /// Steps in the first direction.
    #[must_use]
    pub const fn r(self) -> u32 {
        self.r
    }

    /// Steps in the second direction.
    #[must_use]
    pub const fn s(self) -> u32 {
        self.s
    }

    /// Counts that come from a net, at least 1. Those of a polynomial are legal because 8 · 2 · 32767 < 2^24; those
    /// of a rational net with extreme weights that are not become 2^24 + 1, which no lattice takes.
    fn of_net(r: u128, s: u128) -> Self {
        let clamp = |n: u128| n.clamp(1, u128::from(MAX_STEPS) + 1) as u32;
        Self { r: clamp(r), s: clamp(s) }
    }

    /// The paper's count (section 3): the smallest integer not below the bound on |∂/∂r| and |∂/∂s| over all of x, y
    /// and z, the same in both directions. The bound is m·max|ΔP|, the centred one for rational patches.
    ///
    /// No step is longer than one unit, which is what a plotter needs. On a screen it is not enough: rows are
    /// 8-connected, but cells may leave diamond holes between them; see [`hole_free`](Self::hole_free).
    #[must_use]
    pub fn paper(net: SurfaceNet<'_>) -> Self {
        let form = Form::surface(net, (1, 1));
        let longest = (0..3).flat_map(|axis| Axis::new(&form, axis).slopes()).max().unwrap_or(0);
        let n = ceil_div(longest, unit(&form));
        Self::of_net(n, n)
    }

    /// The paper's count for a curve: the smallest integer not below the bound m·max|ΔP|, so that no step is longer
    /// than one unit along any axis.
    #[must_use]
    pub fn curve(net: CurveNet<'_>) -> u32 {
        curve_count(&Form::curve(net, 1))
    }

    /// The same for a rational curve, by the centred bound.
    #[must_use]
    pub fn rational_curve(net: RationalCurveNet<'_>) -> u32 {
        curve_count(&Form::rational_curve(net, 1))
    }

    /// The count that leaves no hole on the x, y grid: every pixel centre in the lattice's piecewise-linear
    /// interpolant is hit.
    ///
    /// It makes the corners of every triangle of a triangulated cell differ by less than one unit in x and in y: a
    /// triangle whose hull holds a pixel centre then has a corner that rounds to it. z takes no part.
    ///
    /// * Triangle: floor(m·max|ΔP|) + 1 over all three families of net edges.
    /// * Tensor: with A = max|S_r|, B = max|S_s| from the net and K = max(min over the sign of max|S_r·B ∓ S_s·A|,
    ///   A·B), n_r = floor(K/B) + 1 and n_s = floor(K/A) + 1. S_r and S_s enter K as Bernstein coefficients of the
    ///   common degree (m, h); the sign is the choice of the cell's diagonal.
    /// * Rational: the same with centred bounds in the place of m·max|ΔP|.
    ///
    /// ```
    /// use embedded_surfaces::{forward::Steps, patch::{BilinearPatch, Surface}};
    /// // Turned by 45 degrees, cells of one pixel leave holes: twice the steps are needed.
    /// let turned = BilinearPatch::from_ints([[[0, 0, 0], [-50, 50, 0]], [[50, 50, 0], [0, 100, 0]]])?;
    /// assert_eq!(Steps::paper(turned.surface()), Steps::uniform(50)?);
    /// assert_eq!(Steps::hole_free(turned.surface()), Steps::uniform(101)?);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn hole_free(net: SurfaceNet<'_>) -> Self {
        let form = Form::surface(net, (1, 1));
        if net.is_triangle() { triangle_count(&form) } else { tensor_counts(&form) }
    }
}

impl Sampling {
    /// The lattice of [`Steps::hole_free`], or a coarser one with its cells' centres, whichever has fewer points.
    ///
    /// With |S_r|/n_r < 1 and |S_s|/n_s < 1 alone, a cell may be too long along both diagonals. The surface point at
    /// its centre makes it hole-free: it differs from each corner by at most half a step in r and half a step in s,
    /// so less than one unit. That is 2AB points instead of up to 4AB, where cells lie at 45° on the screen.
    ///
    /// ```
    /// use embedded_surfaces::{forward::Sampling, patch::{BilinearPatch, Surface}};
    /// let turned = BilinearPatch::from_ints([[[0, 0, 0], [-50, 50, 0]], [[50, 50, 0], [0, 100, 0]]])?;
    /// let sampling = Sampling::cheapest(turned.surface());
    /// assert_eq!((sampling.steps.r(), sampling.centres), (51, true));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn cheapest(net: SurfaceNet<'_>) -> Self {
        let plain = Steps::hole_free(net);
        let form = Form::surface(net, (1, 1));
        let [a, b] = screen_slopes(&form);
        let count = |slope: u128| slope.checked_div(unit(&form)).unwrap_or(0) + 1;
        let (r, s) = (count(a), count(b));
        let coarse = if net.is_triangle() { Steps::of_net(r.max(s), r.max(s)) } else { Steps::of_net(r, s) };
        let points = |steps: Steps| Form::surface(net, (steps.r, steps.s)).point_count();
        let both = points(coarse) + Form::surface(net, (coarse.r, coarse.s)).centres().point_count();
        if both < points(plain) { Self { steps: coarse, centres: true } } else { Self { steps: plain, centres: false } }
    }
}

/// The count at which rows of `form` are connected on the screen: no step along a row of a whole pixel in x or y.
pub(crate) fn row_count(form: &Form<'_>) -> u32 {
    let longest = screen_slopes(form)[0];
    Steps::of_net(longest.checked_div(unit(form)).unwrap_or(0) + 1, 1).r
}

fn curve_count(form: &Form<'_>) -> u32 {
    let longest = (0..3).map(|axis| Axis::new(form, axis).slopes()[0]).max().unwrap_or(0);
    Steps::of_net(ceil_div(longest, unit(form)), 1).r
}

/// A and B: the larger of the x and y bounds along each direction.
fn screen_slopes(form: &Form<'_>) -> [u128; 2] {
    let [x, y] = [0, 1].map(|axis| Axis::new(form, axis).slopes());
    [x[0].max(y[0]), x[1].max(y[1])]
}

fn triangle_count(form: &Form<'_>) -> Steps {
    let third = [0, 1].map(|axis| Axis::new(form, axis).third_slope());
    let longest = screen_slopes(form).into_iter().chain(third).max().unwrap_or(0);
    let count = longest.checked_div(unit(form)).unwrap_or(0) + 1;
    Steps::of_net(count, count)
}

fn tensor_counts(form: &Form<'_>) -> Steps {
    let unit = unit(form);
    // One unit of the coordinates' last place instead of 0.
    let [a, b] = screen_slopes(form).map(|slope| slope.max(unit >> 16));
    let counts = || {
        let (along_r, along_s) = (i128::try_from(a).ok()?, i128::try_from(b).ok()?);
        let x = Axis::new(form, 0).diagonals(along_r, along_s)?;
        let y = Axis::new(form, 1).diagonals(along_r, along_s)?;
        let k = x[0].max(y[0]).min(x[1].max(y[1])).max(a.checked_mul(b)?);
        let count = |other: u128| Some(k.checked_div(unit.checked_mul(other)?)? + 1);
        Some(Steps::of_net(count(b)?, count(a)?))
    };
    counts().unwrap_or(Steps { r: MAX_STEPS + 1, s: MAX_STEPS + 1 })
}
