//! Where a patch's quadtree ends: the test of a cell, and the way down to one.

use super::cell::{Cell, Domain};
use super::triple::Triple;
use crate::geometry::Point3;
use crate::num::{Coord, I16F16};
use crate::patch::{MAX_DEGREE, SurfaceNet, triangle_index};
use crate::subdivide::Direction;
use crate::subdivide::edge::{is_collapsed, net_point};
use crate::subdivide::rounded::{Source, part_net};

/// The most control points of a net.
const MOST: usize = (MAX_DEGREE + 1) * (MAX_DEGREE + 1);
/// Cells whose corners span no area are split down to this level, in the hope of ones that do.
const SOUND: u8 = 4;
/// The most halvings in one direction before the quadtrees start.
const MOST_GRID: u8 = 8;

/// What the way to a cell came to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Reach {
    /// A leaf on this level holds the cell, or is it.
    Leaf(u8),
    /// The cell exists and is split.
    Split,
    /// The deepest cell that the fine grid has is not flat.
    TooDeep,
}

/// The quadtree of one patch at one tolerance.
#[derive(Clone, Copy, Debug)]
pub(super) struct Tree<'a> {
    net: SurfaceNet<'a>,
    pub(super) domain: Domain,
    /// In units of 2^-16.
    tolerance: i64,
}

/// A net of a part on the way down.
struct Room<const P: usize, const W: usize> {
    points: [Point3; P],
    weights: [I16F16; W],
}

impl<const P: usize, const W: usize> Room<P, W> {
    const EMPTY: Self = Self { points: [Point3::ORIGIN; P], weights: [I16F16::ONE; W] };

    fn of(net: SurfaceNet<'_>) -> Self {
        let mut room = Self::EMPTY;
        for (ours, given) in room.points.iter_mut().zip(net.points()) {
            *ours = *given;
        }
        if let Some(weights) = net.weights() {
            // Only ratios matter: use all bits, so that the rounded weights of the parts are as fine as can be.
            let most = weights.iter().fold(1, |most, w| most | w.to_bits());
            for (ours, given) in room.weights.iter_mut().zip(weights) {
                *ours = I16F16::from_bits(given.to_bits() << (most.leading_zeros() - 1));
            }
        }
        room
    }
}

impl<'a> Tree<'a> {
    pub(super) fn new(net: SurfaceNet<'a>, tolerance: i64) -> Self {
        let triangle = net.is_triangle();
        let grid = if triangle { (0, 0) } else { grid(&net, tolerance) };
        Self { net, domain: Domain { triangle, grid }, tolerance }
    }

    /// Goes from the patch towards a cell until a leaf. Cells above level `from` are known to be split. `least` tells
    /// above which level no cell is a leaf; it is asked only where it matters.
    ///
    /// Stack: 0.5 KB for polynomial nets of up to 16 points, 2 KB above, 2.7 KB for rational ones, and what a
    /// cut takes.
    pub(super) fn reach(&self, target: Cell, from: u8, least: impl Fn() -> u8) -> Reach {
        match (self.net.points().len(), self.net.weights()) {
            (_, Some(_)) => self.reach_in::<MOST, MOST>(target, from, least),
            (..=16, None) => self.reach_in::<16, 0>(target, from, least),
            _ => self.reach_in::<MOST, 0>(target, from, least),
        }
    }

    #[inline(never)]
    fn reach_in<const P: usize, const W: usize>(&self, target: Cell, from: u8, least: impl Fn() -> u8) -> Reach {
        let (mut one, mut other) = (Room::<P, W>::of(self.net), Room::<P, W>::EMPTY);
        let (mut room, mut next) = (&mut one, &mut other);
        let count = self.net.points().len();
        let before = self.domain.grid.0.max(self.domain.grid.1);
        let (mut step, mut slack) = (0_u8, 1);
        loop {
            let (Some(points), weights) = (room.points.get(..count), room.weights.get(..count).unwrap_or(&[])) else {
                return Reach::TooDeep;
            };
            let net = part_net(self.net, points, weights);
            if step > 0 {
                slack += 1 + rounding_of_weights(&net);
            }
            if let Some(level) = step.checked_sub(before) {
                if level >= from
                    && self.is_flat(&net, slack)
                    && (level >= SOUND || is_sound(&net))
                    && (level >= MOST_LEAST || level >= least())
                {
                    return Reach::Leaf(level);
                }
                if level >= self.domain.deepest() {
                    return Reach::TooDeep;
                }
                if level >= target.level {
                    return Reach::Split;
                }
            }
            Source::of(net).cut(self.domain.cut(target, step), &mut next.points, &mut next.weights);
            core::mem::swap(&mut room, &mut next);
            step += 1;
        }
    }

    /// Whether every triangle with corners on the patch and parameters in the cell is within the tolerance of it.
    ///
    /// Let l be an affine map of the parameters and e = b − l(parameter of b) the displacement of a control point;
    /// both weights and products of Bernstein polynomials average, so a point of the surface is l(p) + e(p), p in the
    /// cell, with e(p) in the hull of the displacements. A point of the triangle is l(q) + a mean of three such e. p
    /// takes every value q of the cell, also for a rational patch: so the two differ by at most the spread of the
    /// displacements, axis by axis. For a polynomial tensor-product patch the bound by second derivatives may be
    /// smaller. The net on the way down is off by `slack` − 1 half-units, a vertex by one.
    fn is_flat(&self, net: &SurfaceNet<'_>, slack: i64) -> bool {
        let within = |(scale, off): (i64, Triple)| {
            let limit = i128::from(scale * self.tolerance);
            let square = |c: i64| i128::from(c + scale * slack).pow(2);
            off.to_array().into_iter().map(square).sum::<i128>() <= limit * limit
        };
        within(displacements(net)) || matches!(net, SurfaceNet::Tensor(_)) && within(bending(net))
    }
}

/// The most that `least` may answer.
pub(super) const MOST_LEAST: u8 = 2;

/// How far the displacements of a net from an affine map spread along each axis, times the first result.
///
/// The map is that of the corners of a triangle; of a tensor-product patch that of the parallelogram nearest to its
/// corners. The surface is nowhere without a share of its corners, whose displacements are none or few: that much less
/// it spreads than the net. Below 2^45.
fn displacements(net: &SurfaceNet<'_>) -> (i64, Triple) {
    let ((m, h), points) = (net.degrees(), net.points());
    let at = |index: usize| Triple::of(net_point(points, index));
    let mut range = None;
    let mut include = |e: Triple| {
        let (low, high) = range.unwrap_or((e, e));
        range = Some((low.min(e), high.max(e)));
    };
    let (n, mut index) = (m as i64, 0);
    let (scale, of_corners) = if net.is_triangle() {
        let (u, v, w) = (at(0), at(triangle_index(m, 0)), at(triangle_index(0, m)));
        for row in 0..=n {
            for k in 0..=row {
                include(at(index) * n - u * (n - row) - v * (row - k) - w * k);
                index += 1;
            }
        }
        (n, Triple::default())
    } else {
        let last = points.len().saturating_sub(1);
        let (a, b, c, d) = (at(0), at(last - h), at(h), at(last));
        let h = h as i64;
        let (along_r, along_s) = ((b - a + d - c) * h, (c - a + d - b) * n);
        let middle = (a + b + c + d) * (n * h);
        for i in 0..=n {
            for j in 0..=h {
                include(at(index) * (4 * n * h) - middle - along_r * (2 * i - n) - along_s * (2 * j - h));
                index += 1;
            }
        }
        (4 * n * h, (a - b - c + d).abs() * (2 * n * h))
    };
    let (whole, corners) = (range.map_or(Triple::default(), |(low, high)| high - low), share_of_corners(net));
    (scale, (whole * (SHARES - corners) + of_corners * corners).halved(SHARES.trailing_zeros()))
}

/// What shares are counted in.
const SHARES: i64 = 1 << 12;

/// The least share, rounded down, that the corners of a net have in a point of its surface: Bernstein polynomials are
/// least in the middle, (1/2)^m + (1/2)^m and 3 (1/3)^n, and weights count by their ratio.
fn share_of_corners(net: &SurfaceNet<'_>) -> i64 {
    let (m, h) = net.degrees();
    let share = if net.is_triangle() {
        SHARES.checked_div(3_i64.pow(m as u32 - 1)).unwrap_or(0)
    } else {
        SHARES >> (m + h - 2)
    };
    let Some(weights) = net.weights() else { return share };
    let (least, most) = weights.iter().fold((i64::MAX, 1), |(low, high), w| (low.min(w.bits()), high.max(w.bits())));
    (share * least).checked_div(most).unwrap_or(0)
}

/// Calls `visit` for the second differences of a tensor-product net: along r, along s, and mixed.
fn second_differences(net: &SurfaceNet<'_>, mut visit: impl FnMut(Option<Direction>, Triple)) {
    let ((m, h), points) = (net.degrees(), net.points());
    let at = |index: usize| Triple::of(net_point(points, index));
    for i in 0..=m {
        for j in 0..=h {
            let here = i * (h + 1) + j;
            let straight = |step: usize| at(here) - at(here + step) * 2 + at(here + 2 * step);
            if i + 2 <= m {
                visit(Some(Direction::R), straight(h + 1));
            }
            if j + 2 <= h {
                visit(Some(Direction::S), straight(1));
            }
            if i < m && j < h {
                visit(None, at(here) - at(here + 1) - at(here + h + 1) + at(here + h + 2));
            }
        }
    }
}

/// A bound of the distance between a tensor-product patch and any triangle with corners on it, along each axis, times
/// 8: M_rr + 2 M_rs + M_ss with M the largest second derivatives.
///
/// Linear interpolation is off by half the mean of S''(p − p_i)² over the corners p_i, and a mean of squares of one
/// coordinate about its mean is at most a quarter of the interval's (Filip, Magedson and Markot 1986 for the halves of a
/// rectangle; this is for every triangle in it).
fn bending(net: &SurfaceNet<'_>) -> (i64, Triple) {
    let (m, h) = net.degrees();
    let (mut r, mut s, mut mixed) = (Triple::default(), Triple::default(), Triple::default());
    second_differences(net, |direction, difference| {
        let most = match direction {
            Some(Direction::R) => &mut r,
            Some(Direction::S) => &mut s,
            None => &mut mixed,
        };
        *most = most.max(difference.abs());
    });
    (8, r * (m * (m - 1)) as i64 + mixed * (2 * m * h) as i64 + s * (h * (h - 1)) as i64)
}

/// How much rounding its weights may move a part's surface, in units of 2^-16, rounded up: every weight is off by at most
/// half a unit of its last bit, so a mean of the points moves by at most their range times that over the least weight.
fn rounding_of_weights(net: &SurfaceNet<'_>) -> i64 {
    let Some(least) = net.weights().and_then(|w| w.iter().map(|w| w.bits()).min()) else { return 0 };
    let bounds = net.bounds();
    let range = (Triple::of(bounds.max) - Triple::of(bounds.min)).largest();
    (2 * range).checked_div(least).map_or(0, |units| units + 1)
}

/// Whether the triangles between the corners have an area, but for corners that a collapsed side makes equal.
fn is_sound(net: &SurfaceNet<'_>) -> bool {
    let ((m, h), points) = (net.degrees(), net.points());
    let corner = |index: usize| net_point(points, index);
    if net.is_triangle() {
        let corners = [corner(0), corner(triangle_index(m, 0)), corner(triangle_index(0, m))];
        return (0..3).any(|side| is_collapsed(net, side)) || has_area(corners);
    }
    let last = points.len().saturating_sub(1);
    let [a, b, c, d] = [0, last - h, h, last].map(corner);
    let collapsed = (0..4).any(|side| is_collapsed(net, side));
    collapsed || [[a, b, c], [b, d, c], [a, b, d], [a, d, c]].into_iter().all(has_area)
}

fn has_area([a, b, c]: [Point3; 3]) -> bool {
    let [a, b, c] = [a, b, c].map(Triple::of);
    !(b - a).is_parallel(c - a)
}

/// How often a tensor-product patch is halved in one direction so that its cells bend about as much in both.
///
/// Bending is measured by second differences, m(m−1)|Δ²| as the distance from a chord has it; halving divides it by 4.
fn grid(net: &SurfaceNet<'_>, tolerance: i64) -> (u8, u8) {
    let ((m, h), mut r, mut s) = (net.degrees(), 0, 0);
    second_differences(net, |direction, difference| match direction {
        Some(Direction::R) => r = difference.abs().largest().max(r),
        Some(Direction::S) => s = difference.abs().largest().max(s),
        None => {}
    });
    let (r, s) = ((m * (m - 1)) as i64 * r, (h * (h - 1)) as i64 * s);
    // What passes by second derivatives along one axis; by displacements, along two or three.
    let enough = if net.weights().is_none() { 8 * tolerance } else { 3 * tolerance };
    let halvings = |bend: i64, other: i64| {
        (0..MOST_GRID).find(|k| bend >> (2 * k) <= (2 * other).max(enough)).unwrap_or(MOST_GRID)
    };
    (halvings(r, s), halvings(s, r))
}
