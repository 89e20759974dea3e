//! Step counts: the paper's bound and the hole-free count.

use super::form::Form;
use super::{LatticeError, MAX_STEPS};
use crate::patch::{CurveNet, SurfaceNet, TensorNet, TriangleNet};

/// How many steps a lattice takes in the two parameter directions; equal for triangles.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Steps {
    r: u32,
    s: u32,
}

/// `ceil(a / b)`, b > 0.
pub(super) fn ceil_div(a: u64, b: u64) -> u64 {
    core::num::NonZeroU64::new(b).map_or(0, |b| a.div_ceil(b.get()))
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

    /// Counts that come from a net: at least 1, and legal because 8 · 2 · 32767 < 2^24.
    fn of_net(r: u128, s: u128) -> Self {
        let clamp = |n: u128| n.clamp(1, MAX_STEPS.into()) as u32;
        Self { r: clamp(r), s: clamp(s) }
    }

    /// The paper's count (section 3): the smallest integer not below m·max|ΔP| over both directions and all of x, y
    /// and z, the same in both directions.
    ///
    /// No step is longer than one unit, which is what a plotter needs. On a screen it is not enough: rows are
    /// 8-connected, but cells may leave diamond holes between them; see [`hole_free`](Self::hole_free).
    #[must_use]
    pub fn paper(net: SurfaceNet<'_>) -> Self {
        let form = Form::surface(net, (1, 1));
        let (m, h) = (form.degrees.0 as u64, form.degrees.1 as u64);
        let longest = form.largest_differences().into_iter().map(|[r, s]| (m * r).max(h * s)).max().unwrap_or(0);
        let n = ceil_div(longest, 1 << 16).into();
        Self::of_net(n, n)
    }

    /// The paper's count for a curve: the smallest integer not below m·max|ΔP|, so that no step is longer than one
    /// unit along any axis.
    #[must_use]
    pub fn curve(net: CurveNet<'_>) -> u32 {
        let form = Form::curve(net, 1);
        let longest = form.largest_differences().into_iter().map(|[r, _]| r).max().unwrap_or(0);
        Self::of_net(ceil_div(form.degrees.0 as u64 * longest, 1 << 16).into(), 1).r
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
        match net {
            SurfaceNet::Triangle(t) => triangle_count(t),
            SurfaceNet::Tensor(t) => tensor_counts(t),
        }
    }
}

fn triangle_count(net: TriangleNet<'_>) -> Steps {
    let form = Form::surface(SurfaceNet::Triangle(net), (1, 1));
    let n = form.degrees.0;
    let mut longest = 0;
    for (axis, by_direction) in form.largest_differences().into_iter().enumerate().take(2) {
        longest = longest.max(by_direction[0]).max(by_direction[1]);
        // The third family: b[a+1,b,c] - b[a,b+1,c].
        for a in 0..n {
            for b in 0..n - a {
                longest = longest.max(form.bits(axis, a + 1, b).abs_diff(form.bits(axis, a, b + 1)));
            }
        }
    }
    let count = u128::from((n as u64 * longest) >> 16) + 1;
    Steps::of_net(count, count)
}

fn tensor_counts(net: TensorNet<'_>) -> Steps {
    let form = Form::surface(SurfaceNet::Tensor(net), (1, 1));
    let (m, h) = (form.degrees.0 as i128, form.degrees.1 as i128);
    let [x, y, _] = form.largest_differences();
    // A and B in 2^-16; one unit of the last place instead of 0.
    let a = (m * i128::from(x[0].max(y[0]))).max(1);
    let b = (h * i128::from(x[1].max(y[1]))).max(1);
    // m·h·K from the elevated coefficients, the smaller of the two diagonals.
    let (mut minus, mut plus) = (0, 0);
    for axis in 0..2 {
        for i in 0..=form.degrees.0 {
            for j in 0..=form.degrees.1 {
                let along_r = m * elevated(i, form.degrees.0, |a| form.bits(axis, a + 1, j) - form.bits(axis, a, j));
                let along_s = h * elevated(j, form.degrees.1, |b| form.bits(axis, i, b + 1) - form.bits(axis, i, b));
                let (by_r, by_s) = (h * along_r * b, m * along_s * a);
                minus = minus.max((by_r - by_s).abs());
                plus = plus.max((by_r + by_s).abs());
            }
        }
    }
    let k = minus.min(plus).max(m * h * a * b);
    let count = |other: i128| k.checked_div((m * h * other) << 16).unwrap_or(0) as u128 + 1;
    Steps::of_net(count(b), count(a))
}

/// m times coefficient `i` of a degree m − 1 polynomial elevated to degree m: i·e_(i−1) + (m − i)·e_i.
fn elevated(i: usize, m: usize, e: impl Fn(usize) -> i64) -> i128 {
    let before = if i > 0 { i as i128 * i128::from(e(i - 1)) } else { 0 };
    let after = if i < m { (m - i) as i128 * i128::from(e(i)) } else { 0 };
    before + after
}
