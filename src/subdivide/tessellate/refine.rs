//! Where a patch's quadtree ends: the test of a cell, and the way down to one.

use super::cell::{Cell, Domain};
use crate::geometry::Point3;
use crate::num::{Coord, I16F16};
use crate::patch::{MAX_DEGREE, SurfaceNet, triangle_index};
use crate::subdivide::edge::net_point;
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
        let within = |(scale, off): (i64, [i64; 3])| {
            let limit = i128::from(scale * self.tolerance);
            let square = |c: i64| i128::from(c + scale * slack).pow(2);
            off.into_iter().map(square).sum::<i128>() <= limit * limit
        };
        within(displacements(net)) || matches!(net, SurfaceNet::Tensor(_)) && within(bending(net))
    }
}

/// The most that `least` may answer.
pub(super) const MOST_LEAST: u8 = 2;

fn bits(p: Point3) -> [i64; 3] {
    p.to_array().map(Coord::bits)
}

/// Combines three axes.
fn each(f: impl Fn(usize) -> i64) -> [i64; 3] {
    [f(0), f(1), f(2)]
}

/// How far the displacements of a net from an affine map spread along each axis, times the first result.
///
/// The map is that of the corners of a triangle; of a tensor-product patch that of the parallelogram nearest to its
/// corners. Below 2^45.
fn displacements(net: &SurfaceNet<'_>) -> (i64, [i64; 3]) {
    let ((m, h), points) = (net.degrees(), net.points());
    let corner = |index: usize| bits(net_point(points, index));
    let (mut low, mut high) = ([0; 3], [0; 3]);
    let mut include = |e: [i64; 3]| {
        for ((low, high), e) in low.iter_mut().zip(&mut high).zip(e) {
            (*low, *high) = ((*low).min(e), (*high).max(e));
        }
    };
    let n = m as i64;
    let scale = if net.is_triangle() {
        let (u, v, w) = (corner(0), corner(triangle_index(m, 0)), corner(triangle_index(0, m)));
        let mut index = 0;
        for row in 0..=m {
            for k in 0..=row {
                let (b, k) = (corner(index), k as i64);
                let (i, j) = (n - row as i64, row as i64 - k);
                include(each(|c| n * b[c] - i * u[c] - j * v[c] - k * w[c]));
                index += 1;
            }
        }
        n
    } else {
        let last = points.len() - 1;
        let (a, b, c, d) = (corner(0), corner(last - h), corner(h), corner(last));
        let h = h as i64;
        let along_r = each(|x| h * (b[x] - a[x] + d[x] - c[x]));
        let along_s = each(|x| n * (c[x] - a[x] + d[x] - b[x]));
        let sum = each(|x| n * h * (a[x] + b[x] + c[x] + d[x]));
        let mut index = 0;
        for i in 0..=n {
            for j in 0..=h {
                let p = corner(index);
                include(each(|x| 4 * n * h * p[x] - sum[x] - (2 * i - n) * along_r[x] - (2 * j - h) * along_s[x]));
                index += 1;
            }
        }
        4 * n * h
    };
    (scale, each(|c| high[c] - low[c]))
}

/// A bound of the distance between a tensor-product patch and any triangle with corners on it, along each axis, times
/// 8: M_rr + 2 M_rs + M_ss with M the largest second derivatives.
///
/// Linear interpolation is off by half the mean of S''(p − p_i)² over the corners p_i, and a mean of squares of one
/// coordinate about its mean is at most a quarter of the interval's (Filip, Magedson and Markot 1986 for the halves of a
/// rectangle; this is for every triangle in it).
fn bending(net: &SurfaceNet<'_>) -> (i64, [i64; 3]) {
    let ((m, h), points) = (net.degrees(), net.points());
    let mut most = [[0_i64; 3]; 3];
    let mut include = |kind: usize, places: [(usize, i64); 4]| {
        let sum = places.iter().fold([0; 3], |sum: [i64; 3], (index, factor)| {
            let p = bits(net_point(points, *index));
            each(|c| sum[c] + factor * p[c])
        });
        if let Some(most) = most.get_mut(kind) {
            *most = each(|c| most[c].max(sum[c].abs()));
        }
    };
    for i in 0..=m {
        for j in 0..=h {
            let at = |di: usize, dj: usize| (i + di) * (h + 1) + j + dj;
            let straight = |step: usize| [(at(0, 0), 1), (at(0, 0) + step, -2), (at(0, 0) + 2 * step, 1), (0, 0)];
            if i + 2 <= m {
                include(0, straight(h + 1));
            }
            if j + 2 <= h {
                include(1, straight(1));
            }
            if i < m && j < h {
                include(2, [(at(0, 0), 1), (at(1, 0), -1), (at(0, 1), -1), (at(1, 1), 1)]);
            }
        }
    }
    let factors = [m * (m - 1), h * (h - 1), 2 * m * h].map(|f| f as i64);
    (8, each(|c| (0..3).map(|kind| factors[kind] * most[kind][c]).sum()))
}

/// How much rounding its weights may move a part's surface, in units of 2^-16, rounded up: every weight is off by at most
/// half a unit of its last bit, so a mean of the points moves by at most their range times that over the least weight.
fn rounding_of_weights(net: &SurfaceNet<'_>) -> i64 {
    let Some(least) = net.weights().and_then(|w| w.iter().map(|w| w.bits()).min()) else { return 0 };
    let bounds = net.bounds();
    let (low, high) = (bits(bounds.min), bits(bounds.max));
    let range = each(|c| high[c] - low[c]).into_iter().max().unwrap_or(0);
    (2 * range).checked_div(least).map_or(0, |units| units + 1)
}

/// Whether the triangles between the corners have an area, but for corners that a collapsed side makes equal.
fn is_sound(net: &SurfaceNet<'_>) -> bool {
    let ((m, h), points) = (net.degrees(), net.points());
    let corner = |index: usize| net_point(points, index);
    if net.is_triangle() {
        let corners = [corner(0), corner(triangle_index(m, 0)), corner(triangle_index(0, m))];
        return (0..3).any(|side| crate::subdivide::edge::is_collapsed(net, side)) || has_area(corners);
    }
    let last = points.len().saturating_sub(1);
    let [a, b, c, d] = [0, last - h, h, last].map(corner);
    let collapsed = (0..4).any(|side| crate::subdivide::edge::is_collapsed(net, side));
    collapsed || [[a, b, c], [b, d, c], [a, b, d], [a, d, c]].into_iter().all(has_area)
}

fn has_area([a, b, c]: [Point3; 3]) -> bool {
    let (a, b, c) = (bits(a), bits(b), bits(c));
    let (p, q) = (each(|x| b[x] - a[x]), each(|x| c[x] - a[x]));
    let wide = i128::from;
    (0..3).any(|x| {
        let (y, z) = ((x + 1) % 3, (x + 2) % 3);
        wide(p[y]) * wide(q[z]) != wide(p[z]) * wide(q[y])
    })
}

/// How often a tensor-product patch is halved in one direction so that its cells bend about as much in both.
///
/// Bending is measured by second differences, m(m−1)|Δ²| as the distance from a chord has it; halving divides it by 4.
fn grid(net: &SurfaceNet<'_>, tolerance: i64) -> (u8, u8) {
    let ((m, h), points) = (net.degrees(), net.points());
    let bend = |step: usize, rows: core::ops::Range<usize>, columns: usize| {
        let mut most = 0;
        for from in rows.flat_map(|i| (0..columns).map(move |j| i * (h + 1) + j)) {
            let [a, b, c] = [from, from + step, from + 2 * step].map(|index| bits(net_point(points, index)));
            most = each(|x| (a[x] - 2 * b[x] + c[x]).abs()).into_iter().fold(most, i64::max);
        }
        most
    };
    let r = (m * (m - 1)) as i64 * bend(h + 1, 0..m - 1, h + 1);
    let s = (h * (h - 1)) as i64 * bend(1, 0..m + 1, h - 1);
    // What passes by second derivatives along one axis; by displacements, along two or three.
    let enough = if net.weights().is_none() { 8 * tolerance } else { 3 * tolerance };
    let halvings = |bend: i64, other: i64| {
        (0..MOST_GRID).find(|k| bend >> (2 * k) <= (2 * other).max(enough)).unwrap_or(MOST_GRID)
    };
    (halvings(r, s), halvings(s, r))
}
