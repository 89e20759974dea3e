//! The nearest point of a surface.

use super::grid::{Grid, GridBox, GridVertex, vertex_count};
use super::newton::{difference, pull_back, shifted};
use super::sheet::{ONE, POINT_BITS, Place, ROOM, Sheet};
use super::{I16F48, I20F44, IntersectError, check_depth};
use crate::geometry::Point3;
use crate::num::{Coord, I16F16, Real};
use crate::patch::SurfaceNet;

/// The point of a patch nearest to a given one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Projection {
    /// Parameters: (u, v) of a triangle with w = 1 − u − v, (r, s) of a tensor-product patch.
    pub parameters: [I16F48; 2],
    /// The point of the patch.
    pub position: Point3<I20F44>,
    /// The distance of the given point from it.
    pub distance: I20F44,
}

#[cfg(feature = "defmt")]
impl defmt::Format for Projection {
    fn format(&self, f: defmt::Formatter<'_>) {
        let at = self.parameters.map(I16F48::to_bits);
        let p = self.position.to_array().map(I20F44::to_bits);
        defmt::write!(f, "{}/2^48: {}/2^44, distance {}/2^44", at, p, self.distance.to_bits());
    }
}

/// Rounds of Newton's method.
const LIMIT: u32 = 40;

/// The grid of one patch in a caller's buffers.
fn grid<'b>(
    net: SurfaceNet<'_>,
    depth: u32,
    vertices: &'b mut [GridVertex],
    boxes: &'b mut [GridBox],
) -> Result<Grid<'b>, IntersectError> {
    check_depth(depth)?;
    let (needed, given) = (vertex_count(net.is_triangle(), depth), vertices.len());
    if needed > given {
        return Err(IntersectError::VertexBuffer { needed, given });
    }
    Grid::new(net, depth, vertices, boxes)
}

/// The point of a patch nearest to `point`.
///
/// Newton's method begins at every vertex of a grid of 2^depth cells a side that is no farther than its neighbours, on a border
/// than its neighbours there; it minimises the distance with second derivatives, within the domain. What comes out is the least
/// of these minima: the nearest point of all unless the distance has a minimum so shallow that no vertex shows it. Buffers: the
/// vertices of one grid ([`Room`](super::Room) has those of two), one box or more.
///
/// # Errors
/// [`IntersectError::Depth`], [`IntersectError::VertexBuffer`], [`IntersectError::BoxBuffer`].
///
/// # Examples
/// ```
/// use embedded_surfaces::{geometry::Point3, intersect::project, patch::{BilinearPatch, Surface}};
///
/// let floor = BilinearPatch::from_ints([[[0, 0, 0], [0, 60, 0]], [[80, 0, 0], [80, 60, 0]]])?;
/// let (mut vertices, mut boxes) = ([[0; 3]; 81], [[[0; 3]; 2]; 85]);
/// let nearest = project(floor.surface(), Point3::from_ints(20, 15, 7), 3, &mut vertices, &mut boxes)?;
/// assert_eq!((nearest.distance.to_num::<i32>(), nearest.position.x.to_num::<i32>()), (7, 20));
/// assert!(nearest.parameters.iter().all(|p| (*p - p.round()).abs() == 0.25));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn project(
    net: SurfaceNet<'_>,
    point: Point3<I16F16>,
    depth: u32,
    vertices: &mut [GridVertex],
    boxes: &mut [GridBox],
) -> Result<Projection, IntersectError> {
    let grid = grid(net, depth, vertices, boxes)?;
    let mut room = [[0; 4]; ROOM];
    let sheet = Sheet::new(net, &mut room);
    let target = point.to_array().map(Coord::bits);
    let square = |(i, j): (usize, usize)| {
        let v = grid.vertex(i, j);
        (0..3).fold(0, |s, k| s + i128::from(i64::from(v[k]) - target[k]).pow(2))
    };
    let c = target.map(|t| t << (POINT_BITS - 16));
    let mut best: Option<(Place, Real)> = None;
    for i in 0..=grid.last() {
        for j in 0..=grid.last() {
            if !grid.has_vertex(i, j) || !is_nearest_around(&grid, (i, j), square) {
                continue;
            }
            let place = descend(&sheet, [i, j].map(|k| (k as i64) << (48 - depth)), c);
            let Some(far) = sheet.eval(place, 0).map(|jet| difference(jet.point, c).square()) else { continue };
            if best.is_none_or(|(_, least)| far < least) {
                best = Some((place, far));
            }
        }
    }
    let place = best.map_or([0; 2], |(place, _)| place);
    let position = sheet.eval(place, 0).map_or(c, |jet| jet.point);
    Ok(Projection {
        parameters: place.map(I16F48::from_bits),
        position: Point3::from_array(position.map(I20F44::from_bits)),
        distance: I20F44::from_bits(difference(position, c).norm().nearest(POINT_BITS)),
    })
}

impl Grid<'_> {
    /// The largest index.
    const fn last(&self) -> usize {
        1 << self.depth
    }

    fn has_vertex(&self, i: usize, j: usize) -> bool {
        i <= self.last() && j <= self.last() && (!self.triangle || i + j <= self.last())
    }

    fn is_on_border(&self, (i, j): (usize, usize)) -> bool {
        i.min(j) == 0 || if self.triangle { i + j == self.last() } else { i.max(j) == self.last() }
    }
}

/// Whether no neighbour of a vertex along a line of the grid is less; for one on a border, none on the border: what is least there
/// need not be so inside. Not those across: a valley may run between them.
fn is_nearest_around(grid: &Grid<'_>, (i, j): (usize, usize), square: impl Fn((usize, usize)) -> i128) -> bool {
    let (own, is_on_border) = (square((i, j)), grid.is_on_border((i, j)));
    // Below 0 there is none: the largest number is no index.
    let beside = [
        (i.wrapping_sub(1), j),
        (i + 1, j),
        (i, j.wrapping_sub(1)),
        (i, j + 1),
        (i.wrapping_sub(1), j + 1),
        (i + 1, j.wrapping_sub(1)),
    ];
    // The diagonals of cells are lines of a triangular grid, one of its borders is one.
    let count = if grid.triangle { 6 } else { 4 };
    beside
        .into_iter()
        .take(count)
        .all(|(k, l)| !grid.has_vertex(k, l) || (is_on_border && !grid.is_on_border((k, l))) || square((k, l)) >= own)
}

impl Sheet<'_> {
    /// A place brought into the domain, to the nearest in the parameters.
    fn clamped(&self, [u, v]: Place) -> Place {
        if !self.triangle {
            return [u.clamp(0, ONE), v.clamp(0, ONE)];
        }
        let over = (u + v - ONE).max(0);
        let (u, v) = (u - over / 2, v - (over - over / 2));
        let u = u.clamp(0, ONE);
        [u, v.clamp(0, ONE - u)]
    }
}

/// Minimises the distance from `c`, with a shorter step wherever it would grow.
fn descend(sheet: &Sheet<'_>, start: Place, c: [i64; 3]) -> Place {
    let far = |place: Place| sheet.eval(place, 0).map(|jet| difference(c, jet.point).square());
    let (mut place, Some(mut least)) = (start, far(start)) else { return start };
    for _ in 0..LIMIT {
        let Some(jet) = sheet.eval(place, 2) else { return place };
        let d = difference(c, jet.point);
        let g = jet.first.map(|s| s.dot(d));
        let [a, b, e] = [
            jet.first[0].square() - jet.second[0].dot(d),
            jet.first[0].dot(jet.first[1]) - jet.second[1].dot(d),
            jet.first[1].square() - jet.second[2].dot(d),
        ];
        let determinant = a * e - b * b;
        let newton = if a.is_positive() && determinant.is_positive() {
            [(g[0] * e - g[1] * b) / determinant, (g[1] * a - g[0] * b) / determinant]
        } else {
            pull_back(&jet.first, jet.normal(), d)
        };
        // On a border the other parameter moves alone; along the diagonal, both.
        let mut candidates = [newton, [g[0] / a, Real::ZERO], [Real::ZERO, g[1] / e], [Real::ZERO; 2]];
        let diagonal = a + e - b.shl(1);
        if sheet.triangle && diagonal.is_positive() {
            let t = (g[0] - g[1]) / diagonal;
            candidates[3] = [t, -t];
        }
        let mut better = None;
        for step in candidates {
            for shift in [0, -2, -5] {
                let next = sheet.clamped(shifted(place, step.map(|s| s.shl(shift))));
                if let Some(square) = far(next).filter(|s| *s < least) {
                    (better, least) = (Some(next), square);
                    break;
                }
            }
        }
        let Some(next) = better else { return place };
        place = next;
    }
    place
}
