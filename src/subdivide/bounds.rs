//! Bounds from the control net: how much neighbours differ, how far the patch is from flat, how deep to subdivide.
//!
//! One midpoint subdivision halves the largest first difference in each direction (Tian Jie 1989, Lemma 1, which holds
//! per direction) and quarters the largest second difference: differences of a part are means of differences of the
//! whole, halved once or twice. Affine nets attain the first, nets of degree 2 the second.

use super::curvature::Curvature;
use super::stencil::{Along, EDGES, Net, Shape};
use super::{SubdivideError, Tolerance};
use crate::num::{I32F32, div_up, shift_up, sqrt_up};
use crate::patch::{CurveNet, RationalCurveNet, SurfaceNet, TensorNet, TriangleNet};

/// The most levels of subdivision that a depth may have: parameters have denominators up to 2^16.
pub const MAX_DEPTH: u32 = 16;

impl CurveNet<'_> {
    /// The largest length of a difference of neighbours b_(i+1) − b_i, in units, rounded up to 2^-16. Each
    /// subdivision halves it.
    ///
    /// ```
    /// use embedded_surfaces::patch::CubicCurve;
    /// let arch = CubicCurve::from_ints([[0, 0, 0], [0, 80, 0], [60, 80, 0], [60, 0, 0]])?;
    /// assert_eq!((arch.net().first_difference(), arch.net().second_difference()), (80.into(), 100.into()));
    /// # Ok::<(), embedded_surfaces::patch::NetError>(())
    /// ```
    #[must_use]
    pub fn first_difference(&self) -> I32F32 {
        first(&Net::of_curve(self, None), Along::R)
    }

    /// The largest length of b_(i+2) − 2 b_(i+1) + b_i, in units, rounded up to 2^-16. Each subdivision quarters it.
    #[must_use]
    pub fn second_difference(&self) -> I32F32 {
        second(&Net::of_curve(self, None), Along::R, Along::R)
    }

    /// How far the curve may be from its chord at equal parameters, in units, rounded up to 2^-16:
    /// n(n−1)/8 · the largest second difference, at most the diagonal of the net's box.
    #[must_use]
    pub fn flatness(&self) -> I32F32 {
        flatness(&Net::of_curve(self, None))
    }

    /// The least m for which the chords of all 2^m parts are within the tolerance, by [`flatness`](Self::flatness):
    /// it falls by 4 a level.
    ///
    /// # Errors
    /// [`SubdivideError::TooDeep`] above [`MAX_DEPTH`].
    ///
    /// ```
    /// use embedded_surfaces::{num::I16F16, patch::CubicCurve, subdivide::Tolerance};
    /// let arch = CubicCurve::from_ints([[0, 0, 0], [0, 80, 0], [60, 80, 0], [60, 0, 0]])?;
    /// assert_eq!(arch.net().flatness(), 75); // 3·2/8 · 100
    /// assert_eq!(arch.net().depth_for(Tolerance::new(I16F16::ONE)?)?, 4); // 75 / 4^4 ≤ 1
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn depth_for(&self, tolerance: Tolerance) -> Result<u32, SubdivideError> {
        depth(bound(&Net::of_curve(self, None)), tolerance)
    }
}

impl RationalCurveNet<'_> {
    /// How far the curve may be from its chord at equal parameters, in units, rounded up to 2^-16: 1/8 of a bound on
    /// the second derivative (see [`SurfaceNet::flatness`]), at most the diagonal of the net's box.
    #[must_use]
    pub fn flatness(&self) -> I32F32 {
        flatness(&Net::of_curve(&self.control_net(), Some(self.weights())))
    }

    /// The least m for which that bound says that the chords of all 2^m parts are within the tolerance.
    ///
    /// # Errors
    /// [`SubdivideError::TooDeep`] above [`MAX_DEPTH`].
    ///
    /// ```
    /// use embedded_surfaces::patch::{QuadraticCurve, RationalCurve};
    /// use embedded_surfaces::{num::I16F16, subdivide::Tolerance};
    /// let corner = QuadraticCurve::from_ints([[100, 0, 0], [100, 100, 0], [0, 100, 0]])?;
    /// let arc = RationalCurve::new(corner, [1, 1, 2].map(I16F16::from_num))?;
    /// // Conservative: 16 equal chords of this quarter circle are within 0.12.
    /// assert_eq!(arc.net().depth_for(Tolerance::new(I16F16::from_num(0.25))?)?, 6);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn depth_for(&self, tolerance: Tolerance) -> Result<u32, SubdivideError> {
        depth(bound(&Net::of_curve(&self.control_net(), Some(self.weights()))), tolerance)
    }
}

impl TriangleNet<'_> {
    /// The largest lengths of differences of neighbours along T1T2, T2T3 and T3T1, in units, rounded up to 2^-16.
    ///
    /// Each subdivision halves each of them (Tian Jie 1989, Lemma 1).
    ///
    /// ```
    /// use embedded_surfaces::patch::FlatTriangle;
    /// let right = FlatTriangle::from_ints([[0, 0, 0], [30, 0, 0], [0, 40, 0]])?;
    /// assert_eq!(right.net().first_differences().map(|d| d.to_num::<i32>()), [30, 50, 40]);
    /// # Ok::<(), embedded_surfaces::patch::NetError>(())
    /// ```
    #[must_use]
    pub fn first_differences(&self) -> [I32F32; 3] {
        let net = Net::of(&SurfaceNet::Triangle(*self));
        EDGES.map(|along| first(&net, along))
    }

    /// The largest lengths of second differences along T1T2, T2T3 and T3T1, in units, rounded up to 2^-16.
    ///
    /// Each subdivision quarters each of them. 0 for degree 1.
    ///
    /// ```
    /// use embedded_surfaces::patch::QuadraticTriangle;
    /// let dome = QuadraticTriangle::from_ints([[0, 0, 0], [40, 0, 9], [0, 40, 8], [80, 0, 0], [40, 40, 7], [0, 80, 0]])?;
    /// assert_eq!(dome.net().second_differences().map(|d| d.to_num::<i32>()), [18, 14, 16]);
    /// # Ok::<(), embedded_surfaces::patch::NetError>(())
    /// ```
    #[must_use]
    pub fn second_differences(&self) -> [I32F32; 3] {
        let net = Net::of(&SurfaceNet::Triangle(*self));
        EDGES.map(|along| second(&net, along, along))
    }
}

impl TensorNet<'_> {
    /// The largest lengths of differences of neighbours along r and along s, in units, rounded up to 2^-16.
    ///
    /// Halving the patch in a direction halves the one of that direction and leaves the other no larger.
    #[must_use]
    pub fn first_differences(&self) -> [I32F32; 2] {
        let net = Net::of(&SurfaceNet::Tensor(*self));
        [Along::R, Along::S].map(|along| first(&net, along))
    }

    /// The largest lengths of second differences along r twice, along r and s, and along s twice, in units, rounded up
    /// to 2^-16.
    ///
    /// Halving the patch along r divides them by 4, 2 and 1 at least, along s by 1, 2 and 4.
    ///
    /// ```
    /// use embedded_surfaces::patch::BilinearPatch;
    /// let saddle = BilinearPatch::from_ints([[[0, 0, 0], [0, 40, 9]], [[30, 0, 0], [30, 40, 0]]])?;
    /// assert_eq!(saddle.net().second_differences().map(|d| d.to_num::<i32>()), [0, 9, 0]);
    /// # Ok::<(), embedded_surfaces::patch::NetError>(())
    /// ```
    #[must_use]
    pub fn second_differences(&self) -> [I32F32; 3] {
        let net = Net::of(&SurfaceNet::Tensor(*self));
        [(Along::R, Along::R), (Along::R, Along::S), (Along::S, Along::S)].map(|(one, two)| second(&net, one, two))
    }
}

impl SurfaceNet<'_> {
    /// How far the patch may be from the linear interpolant of its corners, in units, rounded up to 2^-16; of a
    /// tensor-product patch, from that of either half over either diagonal, at equal parameters.
    ///
    /// * Triangle of degree n with the second differences a, b, c along its edges: n(n−1)/2 · q(a, b, c), where
    ///   q = max (uv·a + vw·b + wu·c) over barycentric u, v, w. Sharp: patches of degree 2 attain it. With
    ///   U = b(a+c−b), V = c(a+b−c), W = a(b+c−a): q = abc/(U+V+W) if all three are positive, else max(a, b, c)/4.
    /// * Tensor product: (M_rr + 2 M_rs + M_ss)/8 with M_rr = m(m−1)·|Δ²_rr|, M_rs = mh·|Δ²_rs|,
    ///   M_ss = h(h−1)·|Δ²_ss| (Filip, Magedson, Markot 1986).
    /// * Rational: the same form with bounds on the second derivatives of the quotient from the homogeneous net, the
    ///   centre of its box as origin; of a triangle, the least over its corners. Grows like the square of the ratio
    ///   of the weights: conservative (an octant of the sphere of 100 units gets 7 levels for a tolerance of 1 where 4
    ///   are enough), where [`is_flat`](Self::is_flat) does not suffer.
    ///
    /// At most the diagonal of the net's box. Cost: a pass over the net for each of three second differences, three
    /// square roots; rational nets twice that in 128-bit products, triangles three times more. Counted on thumbv7em:
    /// 9500 instructions for a bicubic patch, 8900 for a cubic triangle, 81 000 for a rational bicubic. Stack 1.4 KB on
    /// thumbv6m.
    ///
    /// ```
    /// use embedded_surfaces::patch::{QuadraticTriangle, Surface};
    /// // Second differences of length 2·9 in all directions: 2·1/2 · 18/3.
    /// let dome = QuadraticTriangle::from_ints([[0, 0, 0], [40, 0, 9], [0, 40, 9], [80, 0, 0], [40, 40, 9], [0, 80, 0]])?;
    /// assert_eq!(dome.surface().flatness(), 6);
    /// # Ok::<(), embedded_surfaces::patch::NetError>(())
    /// ```
    #[must_use]
    pub fn flatness(&self) -> I32F32 {
        flatness(&Net::of(self))
    }

    /// The least m for which [`flatness`](Self::flatness)` / 4^m` is within the tolerance: 4^m triangles on the
    /// surface, of a tensor-product patch 2·4^m, are then within the tolerance of it.
    ///
    /// Vertices are exact here: those rounded to 2^-16 add up to 2^-16. Patches whose parts differ are served better by
    /// [`is_flat`](Self::is_flat) on each part, or by this on each part.
    ///
    /// # Errors
    /// [`SubdivideError::TooDeep`] above [`MAX_DEPTH`].
    ///
    /// ```
    /// use embedded_surfaces::num::I16F16;
    /// use embedded_surfaces::patch::{QuadraticTriangle, Surface};
    /// use embedded_surfaces::subdivide::Tolerance;
    /// let dome = QuadraticTriangle::from_ints([[0, 0, 0], [40, 0, 9], [0, 40, 9], [80, 0, 0], [40, 40, 9], [0, 80, 0]])?;
    /// let pixel = Tolerance::new(I16F16::ONE)?;
    /// assert_eq!(dome.surface().depth_for(pixel)?, 2); // 6 / 4^2 ≤ 1
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn depth_for(&self, tolerance: Tolerance) -> Result<u32, SubdivideError> {
        depth(bound(&Net::of(self)), tolerance)
    }

    /// Levels of halving along r and along s that suffice for the tolerance, with the fewest triangles that the bound
    /// allows: the least m_r + m_s with M_rr/4^m_r + 2 M_rs/2^(m_r+m_s) + M_ss/4^m_s ≤ 8·tolerance, then the most even.
    /// A triangle gets [`depth_for`](Self::depth_for) twice. Cost: that of `depth_for` and up to 50 comparisons of
    /// 128-bit sums, 19 000 instructions for a bicubic patch on thumbv7em.
    ///
    /// # Errors
    /// [`SubdivideError::TooDeep`] where `depth_for` has it.
    ///
    /// ```
    /// use embedded_surfaces::num::I16F16;
    /// use embedded_surfaces::patch::{Surface, Tensor};
    /// use embedded_surfaces::subdivide::Tolerance;
    /// // A gutter: bent along r, straight along s.
    /// let gutter = Tensor::<3, 2>::from_ints([[[0, 0, 0], [0, 99, 0]], [[40, 0, 32], [40, 99, 32]], [[80, 0, 0], [80, 99, 0]]])?;
    /// assert_eq!(gutter.surface().depths_for(Tolerance::new(I16F16::ONE)?)?, [2, 0]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn depths_for(&self, tolerance: Tolerance) -> Result<[u32; 2], SubdivideError> {
        if self.is_triangle() {
            return self.depth_for(tolerance).map(|m| [m; 2]);
        }
        let curvature = Curvature::of(&Net::of(self), [Along::R, Along::S]);
        let uniform = depth(curvature.spread(), tolerance)?;
        let Curvature { rr, rs, ss } = curvature;
        // The uniform depth is legal, so that rr + 2 rs + ss ≤ 2^(34 + 32): shifts by up to 64 stay within 128 bits.
        let allowed = u128::from(tolerance.bits().unsigned_abs()) << 3;
        let fits = |r: u32, s: u32| {
            let left = (rr << (2 * s)) + (rs << (r + s + 1)) + (ss << (2 * r));
            shift_up(left, 2 * (r + s)) <= allowed
        };
        let (mut best, mut s) = ([uniform; 2], MAX_DEPTH);
        for r in 0..=MAX_DEPTH {
            while s > 0 && fits(r, s - 1) {
                s -= 1;
            }
            let key = |[r, s]: [u32; 2]| (r + s, r.abs_diff(s));
            if fits(r, s) && key([r, s]) < key(best) {
                best = [r, s];
            }
        }
        Ok(best)
    }
}

/// The levels of subdivision that the paper's rule asks for: the least m with M / 2^m ≤ tolerance, M the largest of
/// these first differences.
///
/// For comparison: it asks for edges of the net as short as the tolerance. They halve, while the distance to the surface
/// falls by 4 a level, so that [`SurfaceNet::depth_for`] gets by with about half the levels. Not limited by
/// [`MAX_DEPTH`].
///
/// ```
/// use embedded_surfaces::num::I16F16;
/// use embedded_surfaces::patch::{CubicTriangle, Surface};
/// use embedded_surfaces::subdivide::{Tolerance, depth_by_edges};
/// let patch = CubicTriangle::from_ints([
///     [180, 20, 150], [100, 60, 100], [200, 180, 380], [100, 120, 160], [160, 140, 400],
///     [300, 120, 100], [40, 200, 60], [200, 200, 360], [100, 220, 60], [300, 200, 300],
/// ])?;
/// let pixel = Tolerance::new(I16F16::ONE)?;
/// assert_eq!(depth_by_edges(&patch.net().first_differences(), pixel), 9);
/// assert_eq!(patch.surface().depth_for(pixel)?, 5);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[must_use]
pub fn depth_by_edges(differences: &[I32F32], tolerance: Tolerance) -> u32 {
    let longest = differences.iter().map(|d| d.to_bits()).max().unwrap_or(0).max(0).unsigned_abs();
    let allowed = u128::from(tolerance.bits().unsigned_abs()) << 16;
    (0..63).find(|m| shift_up(longest.into(), *m) <= allowed).unwrap_or(63)
}

/// A length in 2^-16 units, at most the type's largest.
fn units(bits: u128) -> I32F32 {
    I32F32::from_bits(i64::try_from(bits).map_or(i64::MAX, |bits| bits.saturating_mul(1 << 16)))
}

fn first(net: &Net<'_>, along: Along) -> I32F32 {
    units(sqrt_up(net.longest_first(along)))
}

fn second(net: &Net<'_>, one: Along, two: Along) -> I32F32 {
    units(sqrt_up(net.longest_second(one, two)))
}

fn flatness(net: &Net<'_>) -> I32F32 {
    units(bound(net).min(net.diagonal()))
}

/// The bound on the distance to the linear interpolant, in 2^-16 units, rounded up. It falls by 4 a level.
#[inline(never)]
fn bound(net: &Net<'_>) -> u128 {
    match (net.shape, net.weights) {
        (Shape::Triangle, None) => triangle_bound(net),
        (Shape::Triangle, Some(_)) => {
            let at = |a, b, c| Curvature::of(net, [Along::Edge(a, b), Along::Edge(a, c)]).spread();
            at(0, 1, 2).min(at(1, 2, 0)).min(at(2, 0, 1))
        }
        _ => Curvature::of(net, [Along::R, Along::S]).spread(),
    }
}

fn triangle_bound(net: &Net<'_>) -> u128 {
    let n = net.degrees.0 as u128;
    let factor = n * (n - 1) / 2;
    // Below 2^40 each.
    let [a, b, c] = EDGES.map(|along| sqrt_up(factor * factor * net.longest_second(along, along)));
    largest_mean(a, b, c)
}

/// The largest uv·a + vw·b + wu·c over u + v + w = 1, rounded up. For values below 2^42.
fn largest_mean(a: u128, b: u128, c: u128) -> u128 {
    let inside = a + c > b && a + b > c && b + c > a && a.min(b).min(c) > 0;
    if inside {
        let sum = 2 * (a * b + b * c + c * a) - a * a - b * b - c * c;
        div_up(a * b * c, sum)
    } else {
        a.max(b).max(c).div_ceil(4)
    }
}

/// The least m with bound ≤ tolerance·4^m.
fn depth(bound: u128, tolerance: Tolerance) -> Result<u32, SubdivideError> {
    let allowed = u128::from(tolerance.bits().unsigned_abs());
    let needed = (0..63).find(|m| shift_up(bound, 2 * m) <= allowed).unwrap_or(63);
    if needed > MAX_DEPTH { Err(SubdivideError::TooDeep { needed, limit: MAX_DEPTH }) } else { Ok(needed) }
}
