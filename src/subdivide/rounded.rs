//! Rounded midpoint subdivision of nets: exact sums, rounded once, half up.
//!
//! A control point on an edge of a child is a sum over the edge's own control points, exact before its one rounding:
//! both patches at a shared edge, whatever their kind and whichever way they run, get the same bits.

use super::exact::{Direction, Half, Quarter, halve_tensor, quarter_triangle};
use crate::geometry::Point3;
use crate::num::{Coord, I16F16, Word, div_half_up};
use crate::patch::{MAX_DEGREE, RationalTensorNet, RationalTriangleNet, Surface, SurfaceNet, TensorNet, TriangleNet};

/// The most control points of a net.
const MOST: usize = (MAX_DEGREE + 1) * (MAX_DEGREE + 1);

/// A part of a patch after one subdivision.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Cut {
    /// A half of a tensor-product patch.
    Half(Direction, Half),
    /// A quarter of a tensor-product patch.
    Tensor(Half, Half),
    /// A quarter of a triangle.
    Triangle(Quarter),
}

impl Cut {
    /// Replaces the control values of a net of these degrees by 2^shift times those of the part; returns the shift.
    fn apply<W: Word>(self, values: &mut [W], degrees: (usize, usize)) -> u32 {
        match self {
            Self::Half(direction, half) => {
                halve_tensor(values, degrees, direction, half);
                (if direction == Direction::R { degrees.0 } else { degrees.1 }) as u32
            }
            Self::Tensor(r, s) => {
                halve_tensor(values, degrees, Direction::R, r);
                halve_tensor(values, degrees, Direction::S, s);
                (degrees.0 + degrees.1) as u32
            }
            Self::Triangle(quarter) => {
                quarter_triangle(values, degrees.0, quarter);
                degrees.0 as u32
            }
        }
    }
}

/// A net as the subdivider sees it; a curve has the degrees (n, 0).
#[derive(Clone, Copy, Debug)]
pub(crate) struct Source<'a> {
    degrees: (usize, usize),
    points: &'a [Point3],
    weights: Option<&'a [I16F16]>,
    /// Weights of parts are multiplied by two to this power: surfaces do not change by it, roundings do.
    doublings: i32,
    /// Whether all points are less than 2048 units apart along each axis.
    is_near: bool,
}

impl<'a> Source<'a> {
    pub(crate) fn new(degrees: (usize, usize), points: &'a [Point3], weights: Option<&'a [I16F16]>) -> Self {
        Self { degrees, points, weights, doublings: 0, is_near: false }
    }

    pub(crate) fn of(net: SurfaceNet<'a>) -> Self {
        Self::new(net.degrees(), net.points(), net.weights())
    }

    /// The source whose parts have weights of at least 17 bits and of no more than 31: a weight is then within 2^-17 of
    /// itself, however small the weights of the net are.
    pub(crate) fn with_long_weights(self) -> Self {
        let Some(weights) = self.weights else { return self };
        let length = |w: Option<&I16F16>| 32 - w.map_or(1, |w| w.to_bits()).leading_zeros() as i32;
        let (longest, shortest) = (length(weights.iter().max()), length(weights.iter().min()));
        Self { doublings: (17 + longest - shortest).min(31) - longest, ..self }
    }

    /// The source for which it is known that [`are_near`] says so of it, or of what it was cut from.
    pub(crate) fn known_near(self, is_near: bool) -> Self {
        Self { is_near, ..self }
    }

    /// Writes the points of the part into `points` and, for a rational net, its weights into `weights`; both hold as
    /// many as the net has points, or only the first are written.
    ///
    /// A polynomial point is within 2^-17 of the exact one. A rational point and a weight are each within 2^-17.
    ///
    /// Stack: 0.2 KB for nets of up to 16 points, 0.8 KB above, 2.2 KB for rational ones.
    pub(crate) fn cut(self, part: Cut, points: &mut [Point3], weights: &mut [I16F16]) {
        self.cut_of::<SurfaceNet<'_>>(part, points, weights);
    }

    /// [`cut`](Self::cut) of a net of type `S`.
    pub(crate) fn cut_of<S: Surface>(self, part: Cut, points: &mut [Point3], weights: &mut [I16F16]) {
        match self.weights {
            Some(by) if S::SHAPE.rational => self.cut_weighted(by, part, points, weights),
            _ if self.cut_bicubic(part, points) => {}
            _ if self.points.len() <= 16 => self.cut_points::<16>(part, points),
            _ => self.cut_points::<MOST>(part, points),
        }
    }

    /// [`cut_points`](Self::cut_points) for halves of bicubics, from differences that fit 32 bits; whether they do.
    fn cut_bicubic(self, part: Cut, points: &mut [Point3]) -> bool {
        let Cut::Half(direction, half) = part else { return false };
        let (Some(from), Some(to)) = (self.points.first_chunk::<16>(), points.first_chunk_mut::<16>()) else {
            return false;
        };
        if self.degrees != (3, 3) || !(self.is_near || are_near(self.points)) {
            return false;
        }
        halve_bicubic(from, direction, half, to);
        true
    }

    #[inline(never)]
    fn cut_points<const ROOM: usize>(self, part: Cut, points: &mut [Point3]) {
        for axis in 0..3 {
            // Legal bits have 32 bits; at most 16 more: the sums fit.
            let mut sums = [0_i64; ROOM];
            let Some(sums) = sums.get_mut(..self.points.len()) else { return };
            for (sum, p) in sums.iter_mut().zip(self.points) {
                *sum = bits(p, axis);
            }
            let shift = part.apply(sums, self.degrees);
            for (point, sum) in points.iter_mut().zip(sums.iter()) {
                set(point, axis, (*sum + ((1 << shift) >> 1)) >> shift);
            }
        }
    }

    #[inline(never)]
    fn cut_weighted(self, by: &[I16F16], part: Cut, points: &mut [Point3], weights: &mut [I16F16]) {
        let mut total = [0_i64; MOST];
        let Some(total) = total.get_mut(..self.points.len()) else { return };
        for (sum, w) in total.iter_mut().zip(by) {
            *sum = w.bits();
        }
        let shift = part.apply(total, self.degrees);
        for (weight, sum) in weights.iter_mut().zip(total.iter()) {
            // Sums of positive integers: at least 2^shift. Doubled, at most 31 + shift bits.
            let (up, down) = (self.doublings.max(0), shift + self.doublings.min(0).unsigned_abs());
            *weight = I16F16::from_bits((((*sum << up) + ((1 << down) >> 1)) >> down).max(1) as i32);
        }
        for axis in 0..3 {
            let mut sums = [0_i128; MOST];
            let Some(sums) = sums.get_mut(..self.points.len()) else { return };
            for ((sum, p), w) in sums.iter_mut().zip(self.points).zip(by) {
                *sum = i128::from(bits(p, axis)) * i128::from(w.bits());
            }
            part.apply(sums, self.degrees);
            for ((point, sum), total) in points.iter_mut().zip(sums.iter()).zip(total.iter()) {
                // A mean of coordinates: in range.
                set(point, axis, div_half_up(*sum, (*total).into()).unwrap_or(0) as i64);
            }
        }
    }
}

/// Whether points are less than 2048 units apart along each axis: differences then have 27 bits and a sign.
pub(crate) fn are_near(points: &[Point3]) -> bool {
    let Some(first) = points.first().map(|p| p.to_array().map(I16F16::to_bits)) else { return true };
    let mut far = 0;
    for p in points {
        for (c, start) in p.to_array().map(I16F16::to_bits).into_iter().zip(first) {
            // A magnitude, or one less; and whether the difference did not fit, which then has the wrong sign.
            let apart = c.wrapping_sub(start);
            far |= (apart ^ (apart >> 31)) >> 26 | ((c ^ start) & (c ^ apart)) >> 31;
        }
    }
    far == 0
}

/// A half of a bicubic whose points [are near](are_near).
#[inline(never)]
fn halve_bicubic(from: &[Point3; 16], direction: Direction, half: Half, to: &mut [Point3; 16]) {
    let (along, across) = if direction == Direction::R { (4, 1) } else { (1, 4) };
    // From the far end for the second half.
    let (start, step) = if half == Half::First { (0, along) } else { (3 * along, 0_usize.wrapping_sub(along)) };
    for row in 0..4 {
        let place = |k: usize| start.wrapping_add(row * across).wrapping_add(k.wrapping_mul(step)) & 15;
        let places = [place(0), place(1), place(2), place(3)];
        // Masked where they are used: no check is left at any level of optimisation.
        let at = |k: usize| &from[places[k & 3] & 15];
        let [a, b, c, d] = [at(0), at(1), at(2), at(3)];
        let x = cubic_half([a.x, b.x, c.x, d.x].map(I16F16::to_bits));
        let y = cubic_half([a.y, b.y, c.y, d.y].map(I16F16::to_bits));
        let z = cubic_half([a.z, b.z, c.z, d.z].map(I16F16::to_bits));
        for k in 0..4 {
            to[places[k] & 15] = Point3::from_bits(x[k], y[k], z[k]);
        }
    }
}

/// The first half of a cubic, rounded half up: sums are taken from the first value.
#[inline(always)]
fn cubic_half([a, b, c, d]: [i32; 4]) -> [i32; 4] {
    let [u, v, w] = [b.wrapping_sub(a), c.wrapping_sub(a), d.wrapping_sub(a)];
    let two = u.wrapping_add(v);
    let sums = [
        u.wrapping_add(1) >> 1,
        u.wrapping_add(two).wrapping_add(2) >> 2,
        two.wrapping_mul(3).wrapping_add(w).wrapping_add(4) >> 3,
    ];
    [a, a.wrapping_add(sums[0]), a.wrapping_add(sums[1]), a.wrapping_add(sums[2])]
}

fn bits(p: &Point3, axis: usize) -> i64 {
    match axis {
        0 => p.x.bits(),
        1 => p.y.bits(),
        _ => p.z.bits(),
    }
}

fn set(p: &mut Point3, axis: usize, bits: i64) {
    let value = I16F16::from_bits(bits as i32);
    match axis {
        0 => p.x = value,
        1 => p.y = value,
        _ => p.z = value,
    }
}

/// The view of a part that [`Source::cut`] wrote: of the kind and degrees of the net it came from.
pub(crate) fn part_net<'a>(net: SurfaceNet<'_>, points: &'a [Point3], weights: &'a [I16F16]) -> SurfaceNet<'a> {
    let triangle = |n: usize| TriangleNet::of_checked(n, points);
    let tensor = |degrees: (usize, usize)| TensorNet::of_checked(degrees, points);
    match net {
        SurfaceNet::Triangle(net) => SurfaceNet::Triangle(triangle(net.degree())),
        SurfaceNet::Tensor(net) => SurfaceNet::Tensor(tensor(net.degrees())),
        SurfaceNet::RationalTriangle(net) => {
            SurfaceNet::RationalTriangle(RationalTriangleNet::of_checked(triangle(net.control_net().degree()), weights))
        }
        SurfaceNet::RationalTensor(net) => {
            SurfaceNet::RationalTensor(RationalTensorNet::of_checked(tensor(net.control_net().degrees()), weights))
        }
    }
}
