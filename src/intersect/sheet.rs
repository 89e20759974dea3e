//! A patch made ready for evaluation: control points as 64-bit integers of one scale.
//!
//! Parameters are integers in units of 2^-48, points in units of 2^-44. A de Casteljau step rounds once, half up, so a
//! point of degrees (m, h) is within (m + h) / 2 units of the net's own scale, 2^-44 or 2^-42 for polynomial patches.

use super::vector::V3;
use crate::num::{Coord, I16F16, Real, product_half_up, products_half_up};
use crate::patch::{MAX_DEGREE, SurfaceNet, triangle_index, triangle_len};

/// Fraction bits of parameters.
pub(super) const PARAMETER_BITS: i32 = 48;
const PARAMETER: u32 = PARAMETER_BITS as u32;
/// The parameter 1.
pub(super) const ONE: i64 = 1 << PARAMETER_BITS;
/// Fraction bits of points.
pub(super) const POINT_BITS: i32 = 44;
/// Bits of the largest coordinate of a prepared net: five are left for extrapolation past the borders.
const NET_BITS: i32 = 57;
/// Control points of a net at most.
pub(super) const ROOM: usize = (MAX_DEGREE + 1) * (MAX_DEGREE + 1);

/// Homogeneous coordinates of a control point or of a sum of them; the weight is unused by polynomial patches.
pub(super) type Homogeneous = [i64; 4];

/// Parameters (u, v) in units of 2^-48.
pub(super) type Place = [i64; 2];

/// Point and derivatives at a place.
#[derive(Clone, Copy, Debug)]
pub(super) struct Jet {
    /// The point in units of 2^-44.
    pub(super) point: [i64; 3],
    /// The derivatives by u and v.
    pub(super) first: [V3; 2],
    /// The second derivatives by uu, uv and vv; zero unless asked for.
    pub(super) second: [V3; 3],
}

impl Jet {
    /// No point.
    pub(super) const BLANK: Self = Self { point: [0; 3], first: [V3::ZERO; 2], second: [V3::ZERO; 3] };

    /// The normal Su × Sv, of any length.
    #[inline]
    pub(super) fn normal(&self) -> V3 {
        self.first[0].cross(self.first[1])
    }

    /// Whether the normals' angle has a cosine above 1 − 2^-10.
    pub(super) fn is_parallel(&self, other: &Self) -> bool {
        self.normal().unit().dot(other.normal().unit()).abs() > Real::ONE - Real::power(-10)
    }
}

/// A patch ready for evaluation.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sheet<'a> {
    pub(super) source: SurfaceNet<'a>,
    pub(super) triangle: bool,
    pub(super) rational: bool,
    pub(super) degrees: (usize, usize),
    /// Fraction bits of the net.
    pub(super) bits: i32,
    /// The longest side of the control points' box.
    pub(super) extent: Real,
    pub(super) net: &'a [Homogeneous],
}

/// Calls `work` with room for two nets of so many control points, from 512 bytes to 2.6 KB each: most of a stack.
pub(super) fn in_rooms<R>(points: usize, work: impl FnOnce([&mut [Homogeneous]; 2]) -> R) -> R {
    match points {
        0..=16 => with_rooms::<16, R>(work),
        17..=36 => with_rooms::<36, R>(work),
        _ => with_rooms::<ROOM, R>(work),
    }
}

#[inline(never)]
fn with_rooms<const POINTS: usize, R>(work: impl FnOnce([&mut [Homogeneous]; 2]) -> R) -> R {
    let mut one = [[0; 4]; POINTS];
    let mut two = [[0; 4]; POINTS];
    work([&mut one, &mut two])
}

/// A place with its value and differences of orders 1 and 2, all unscaled.
struct Collapsed {
    value: Homogeneous,
    first: Homogeneous,
    second: Homogeneous,
}

/// `a + (b − a) t`, rounded half up.
#[inline(always)]
pub(super) fn between(a: i64, b: i64, t: i64) -> i64 {
    a.wrapping_add(product_half_up::<PARAMETER>(b.wrapping_sub(a), t))
}

#[inline(always)]
pub(super) fn minus<const D: usize>(a: &Homogeneous, b: &Homogeneous) -> Homogeneous {
    let mut out = [0; 4];
    for k in 0..D {
        out[k] = a[k].wrapping_sub(b[k]);
    }
    out
}

/// Collapses the coefficients of degree `n` at `t`.
#[cfg_attr(target_pointer_width = "32", inline(never))]
#[cfg_attr(not(target_pointer_width = "32"), inline(always))]
fn collapse<const D: usize>(values: &mut [Homogeneous; MAX_DEGREE + 1], n: usize, t: i64) -> Collapsed {
    let mut second = [0; 4];
    for left in (2..=n.min(MAX_DEGREE)).rev() {
        if left == 2 {
            second = minus::<D>(&minus::<D>(&values[2], &values[1]), &minus::<D>(&values[1], &values[0]));
        }
        for i in 0..left {
            let next = values[(i + 1).min(MAX_DEGREE)];
            let value = &mut values[i.min(MAX_DEGREE)];
            for k in 0..D {
                value[k] = between(value[k], next[k], t);
            }
        }
    }
    let first = minus::<D>(&values[1], &values[0]);
    let mut value = values[0];
    for k in 0..D {
        value[k] = between(value[k], values[1][k], t);
    }
    Collapsed { value, first, second }
}

impl<'a> Sheet<'a> {
    /// Makes a patch ready in a room of as many points as it has, or more.
    #[inline(never)]
    pub(super) fn new(source: SurfaceNet<'a>, room: &'a mut [Homogeneous]) -> Self {
        let bounds = source.bounds();
        let sizes = [bounds.max.x, bounds.max.y, bounds.max.z]
            .into_iter()
            .zip([bounds.min.x, bounds.min.y, bounds.min.z])
            .map(|(max, min)| (max.bits() - min.bits(), max.bits().max(-min.bits())));
        let (extent, largest) = sizes.fold((0, 1), |(e, l), (size, far)| (e.max(size), l.max(far)));
        // Whole bits of the largest coordinate.
        let whole = (64 - largest.leading_zeros() as i32 - 16).max(0);
        let weights = source.weights();
        let most = weights.map_or(1, |w| w.iter().fold(1, |most, w| most.max(w.to_bits())));
        let weight_bits = 32 - most.leading_zeros() as i32;
        let bits = if weights.is_some() { NET_BITS - whole } else { (NET_BITS - whole).min(POINT_BITS) };
        for (i, (out, point)) in room.iter_mut().zip(source.points()).enumerate() {
            let coordinates = point.to_array().map(I16F16::bits);
            match weights {
                None => {
                    for (out, c) in out.iter_mut().zip(coordinates) {
                        *out = c << (bits - 16);
                    }
                }
                Some(weights) => {
                    let weight = weights.get(i).map_or(1, |w| i64::from(w.to_bits()));
                    for (out, c) in out.iter_mut().zip(coordinates) {
                        *out = shifted(c * weight, bits - 16 - weight_bits);
                    }
                    out[3] = shifted(weight, bits - weight_bits);
                }
            }
        }
        Self {
            source,
            triangle: source.is_triangle(),
            rational: weights.is_some(),
            degrees: source.degrees(),
            bits,
            extent: Real::new(extent, -16),
            net: room,
        }
    }

    /// The point and the derivatives up to `order` (0, 1 or 2); `None` where a weight is not positive, outside the domain.
    #[inline]
    pub(super) fn eval(&self, place: Place, order: u32) -> Option<Jet> {
        let mut jet = Jet::BLANK;
        self.eval_to(place, order, &mut jet)?;
        Some(jet)
    }

    /// The same in place.
    #[cfg_attr(target_pointer_width = "32", inline(never))]
    #[cfg_attr(not(target_pointer_width = "32"), inline)]
    pub(super) fn eval_to(&self, place: Place, order: u32, jet: &mut Jet) -> Option<()> {
        let mut sums = [[0; 4]; 6];
        match (self.triangle, self.rational) {
            (false, false) => self.tensor::<3>(place, order, &mut sums),
            (false, true) => self.tensor::<4>(place, order, &mut sums),
            (true, false) => self.triangular::<3>(place, &mut sums),
            (true, true) => self.triangular::<4>(place, &mut sums),
        }
        if self.rational {
            return self.quotients(&sums, order, jet);
        }
        self.plain(&sums, order, jet);
        Some(())
    }

    /// Value, differences by u, v, uu, uv, vv, unscaled.
    #[cfg_attr(target_pointer_width = "32", inline(never))]
    #[cfg_attr(not(target_pointer_width = "32"), inline(always))]
    fn tensor<const D: usize>(&self, [u, v]: Place, order: u32, sums: &mut [Homogeneous; 6]) {
        let (m, h) = (self.degrees.0.min(MAX_DEGREE), self.degrees.1.min(MAX_DEGREE));
        let mut columns = [[[0; 4]; MAX_DEGREE + 1]; 3];
        let [values, slopes, bends] = &mut columns;
        let out = values.iter_mut().zip(slopes.iter_mut()).zip(bends.iter_mut());
        for (((value, slope), bend), points) in out.zip(self.net.chunks(h + 1)).take(m + 1) {
            let mut row = [[0; 4]; MAX_DEGREE + 1];
            for (out, point) in row.iter_mut().zip(points) {
                *out = *point;
            }
            let along = collapse::<D>(&mut row, h, v);
            (*value, *slope, *bend) = (along.value, along.first, along.second);
        }
        let along = collapse::<D>(values, m, u);
        (sums[0], sums[1], sums[3]) = (along.value, along.first, along.second);
        if order >= 1 {
            let along = collapse::<D>(slopes, m, u);
            (sums[2], sums[4]) = (along.value, along.first);
        }
        if order >= 2 {
            sums[5] = collapse::<D>(bends, m, u).value;
        }
    }

    /// The same over a triangle.
    #[cfg_attr(target_pointer_width = "32", inline(never))]
    #[cfg_attr(not(target_pointer_width = "32"), inline(always))]
    fn triangular<const D: usize>(&self, [u, v]: Place, sums: &mut [Homogeneous; 6]) {
        let n = self.degrees.0.min(MAX_DEGREE);
        let mut values = [[0; 4]; triangle_len(MAX_DEGREE)];
        for (out, point) in values.iter_mut().zip(self.net.iter()).take(triangle_len(n)) {
            *out = *point;
        }
        for degree in (0..n).rev() {
            if degree == 1 {
                let [c200, c110, c101, c020, c011, c002, ..] = values;
                let along_u = [minus::<D>(&c200, &c101), minus::<D>(&c101, &c002)];
                let along_v = minus::<D>(&c011, &c002);
                sums[3] = minus::<D>(&along_u[0], &along_u[1]);
                sums[4] = minus::<D>(&minus::<D>(&c110, &c101), &along_v);
                sums[5] = minus::<D>(&minus::<D>(&c020, &c011), &along_v);
            }
            if degree == 0 {
                break;
            }
            for row in 0..=degree {
                for k in 0..=row {
                    // The index never passes the last; a compiler for size does not see it.
                    let last = values.len() - 1;
                    let [at, v_at, w_at] = corner_indices(row, k);
                    let (at, v_at, w_at) = (at.min(last), v_at.min(last), w_at.min(last));
                    values[at] = combine::<D>([&values[at], &values[v_at], &values[w_at]], [u, v]);
                }
            }
        }
        let [a, b, c] = [values[0], values[1], values[2]];
        sums[0] = combine::<D>([&a, &b, &c], [u, v]);
        (sums[1], sums[2]) = (minus::<D>(&a, &c), minus::<D>(&b, &c));
    }

    /// What turns differences by u, v, uu, uv, vv to derivatives.
    fn factors(&self) -> [usize; 5] {
        let (m, h) = self.degrees;
        let mixed = if self.triangle { m * (m - 1) } else { m * h };
        [m, h, m * (m - 1), mixed, h * h.saturating_sub(1)]
    }

    /// A sum as a vector, times a factor.
    #[cfg_attr(target_pointer_width = "32", inline(never))]
    #[cfg_attr(not(target_pointer_width = "32"), inline(always))]
    fn scaled(&self, sum: &Homogeneous, factor: usize) -> V3 {
        let v = V3::bits([sum[0], sum[1], sum[2]], -self.bits);
        if factor == 1 { v } else { v * Real::int(factor as i64) }
    }

    /// Differences to derivatives.
    #[inline(always)]
    fn plain(&self, sums: &[Homogeneous; 6], order: u32, jet: &mut Jet) {
        let factors = self.factors();
        let shift = POINT_BITS - self.bits;
        jet.point = three!(|k| sums[0][k].wrapping_shl(shift as u32));
        if order >= 1 {
            jet.first = both!(|k| self.scaled(&sums[k + 1], factors[k]));
        }
        if order >= 2 {
            jet.second = three!(|k| self.scaled(&sums[k + 3], factors[k + 2]));
        }
    }

    /// The same, homogeneous to plain coordinates.
    #[inline(never)]
    fn quotients(&self, sums: &[Homogeneous; 6], order: u32, jet: &mut Jet) -> Option<()> {
        let factors = self.factors();
        if sums[0][3] <= 0 {
            return None;
        }
        let inverse = Real::ONE / Real::new(sums[0][3], -self.bits);
        let weight = |k: usize| Real::new(sums[k.min(5)][3], -self.bits) * Real::int(factors[(k - 1).min(4)] as i64);
        let s = self.scaled(&sums[0], 1) * inverse;
        jet.point = s.fixed(POINT_BITS);
        if order >= 1 {
            jet.first = both!(|k| (self.scaled(&sums[k + 1], factors[k]) - s * weight(k + 1)) * inverse);
        }
        if order >= 2 {
            // Leibniz: (wS)'' = wS'' + 2w'S' + w''S, the mixed one by both.
            let first = jet.first;
            let bend = |k: usize, a: usize, b: usize| {
                let lower = first[(a - 1) & 1] * weight(b) + first[(b - 1) & 1] * weight(a);
                (self.scaled(&sums[k.min(5)], factors[(k - 1).min(4)]) - lower - s * weight(k)) * inverse
            };
            jet.second = [bend(3, 1, 1), bend(4, 1, 2), bend(5, 2, 2)];
        }
        Some(())
    }
}

/// Where the parents towards u, v and w of entry k of a row of a triangular net's next level stand.
#[inline(always)]
pub(super) const fn corner_indices(row: usize, k: usize) -> [usize; 3] {
    let at = triangle_index(row - k, k);
    [at, at + row + 1, at + row + 2]
}

/// `value` · 2^`shift`, half up.
fn shifted(value: i64, shift: i32) -> i64 {
    if shift >= 0 { value << shift } else { crate::num::shift_half_up(value.into(), shift.unsigned_abs()) as i64 }
}

/// The sum of points weighted by u, v, w, which sum to 1, rounded half up.
#[cfg_attr(target_pointer_width = "32", inline(never))]
#[cfg_attr(not(target_pointer_width = "32"), inline(always))]
pub(super) fn combine<const D: usize>(points: [&Homogeneous; 3], place: Place) -> Homogeneous {
    let [a, b, c] = points;
    let mut out = [0; 4];
    for k in 0..D {
        let along = [a[k].wrapping_sub(c[k]), b[k].wrapping_sub(c[k])];
        out[k] = c[k].wrapping_add(products_half_up::<PARAMETER>(along, place));
    }
    out
}
