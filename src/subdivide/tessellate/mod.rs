//! Watertight triangle meshes of patches, to a tolerance.
//!
//! Every patch is a quadtree whose leaves are flat to the tolerance. A leaf's side has a vertex wherever a cell that
//! touches it, of the same patch or of a neighbour on the same curve, has a corner: so there are no T-junctions. Which
//! these are is found by going down the other side's own quadtree, from its root; both sides agree because both ask the
//! same trees. No mesh is kept: memory is one net on the way down. The leaf between its sides is cut into triangles
//! that never have three corners on one side.
//!
//! Vertices are exact points of the patches, rounded once; on a common curve they depend on the curve alone.

mod cell;
mod eval;
mod mesh;
mod normal;
mod obj;
mod refine;
mod stl;
mod triple;
mod zip;

use super::edge::{edge_count, edge_degree, edge_index, is_collapsed, net_point, same_curve};
use super::{Buffer, PatchTopology, SubdivideError, Tolerance};
use crate::geometry::Point3;
use crate::patch::{Parameter, Surface, SurfaceNet};
use cell::{Cell, FINE, Fine};
use eval::{dyadic, eval};
use refine::{MOST_LEAST, Reach, Tree};
use triple::Triple;
use zip::{Leaf, Run, Spot, Zip};

pub use mesh::{Mesh, MeshBuffers, MeshSize, MeshVertex};
pub use stl::{write_stl, write_stl_text};

/// A corner of a triangle of a tessellation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Vertex {
    /// The exact point of the patch at the parameters, rounded once, half up.
    pub point: Point3,
    /// The index of the patch.
    pub patch: usize,
    /// (r, s) of a tensor-product patch, (u, v) of a triangle.
    pub parameters: [Parameter; 2],
}

/// The triangles of a tessellation, an iterator; made by [`tessellate`].
///
/// Each item is three corners, counter-clockwise seen from outside (see [`PatchTopology::is_inward`]). 320 bytes on a
/// 32-bit target; a step takes 2 KB of stack for polynomial patches of up to 16 points, 4.2 KB above, 6.3 KB for
/// rational ones; 6 KB where a vertex needs 640 bits.
#[derive(Debug)]
pub struct Tessellation<'a, S> {
    patches: &'a [S],
    topology: &'a [PatchTopology],
    tolerance: i64,
    leaf: Option<Leaf>,
    zips: [Option<Zip>; 2],
}

#[cfg(feature = "defmt")]
impl<S> defmt::Format for Tessellation<'_, S> {
    fn format(&self, f: defmt::Formatter<'_>) {
        let (patches, tolerance) = (self.patches.len(), self.tolerance);
        defmt::write!(f, "Tessellation {{ {} patches, tolerance: {}/2^16 }}", patches, tolerance);
    }
}

impl<S> Clone for Tessellation<'_, S> {
    fn clone(&self) -> Self {
        Self { ..*self }
    }
}

/// The triangles of a watertight mesh of these patches, each point of it within `tolerance` of the surface and each
/// point of the surface within `tolerance` of it.
///
/// *Watertight.* Within a part (see [`PatchTopology::part`]) two triangles meet at every edge that is not on the part's
/// border, and have its two ends in opposite order; no vertex lies inside an edge. This holds across patches, and where
/// neighbours are refined differently. Only bit-equal boundary curves are neighbours. A side collapsed to a point
/// becomes that point.
///
/// *Within the tolerance*, by proof: the test of a cell bounds the distance for every triangle with corners on the
/// patch and parameters in the cell, rounding of nets and vertices included. For a polynomial patch the distance is
/// that of points at equal parameters. Measured on the seed patches, the teapot and solids: 0.2 to 0.8 of the tolerance
/// is used.
///
/// *Few triangles*: the cubic triangles P and Q of Tian Jie take 832 and 833 at a tolerance of 1, 3246 and 3277 at 1/4;
/// the teapot, 290 units long, 5816 and 20 299.
///
/// Triangles have an area unless the patch itself is degenerate there. Mesh edges may coincide near a corner at which
/// two edges of one patch are the same curve.
///
/// `topology` is what [`topology`](super::topology()) finds for these patches, or a table in flash. It orients the
/// triangles, and names the parts for [`mesh`](Tessellation::mesh); that there is no crack does not depend on it.
///
/// Cost: every leaf is reached from its patch, and so is its neighbour at every segment of its sides, a cut and a test of
/// a net per level; at a border all edges of all patches are compared. A vertex is evaluated exactly in 64, 128 or, where
/// the degree and depth ask for it, 640 bits. At the call, every leaf is visited once, so that nothing fails later.
///
/// ```
/// use embedded_graphics::{mock_display::MockDisplay, pixelcolor::Gray8, prelude::*, primitives::*};
/// use embedded_surfaces::num::I16F16;
/// use embedded_surfaces::patch::BiquadraticPatch;
/// use embedded_surfaces::subdivide::{PatchTopology, Tolerance, tessellate, topology};
///
/// let sail = [BiquadraticPatch::from_ints([
///     [[4, 60, 0], [30, 50, 40], [60, 60, 0]],
///     [[8, 30, 9], [30, 30, 60], [50, 30, 9]],
///     [[20, 4, 0], [30, 8, 20], [40, 4, 0]],
/// ])?];
/// let mut table = [PatchTopology::default()];
/// topology(&sail, &mut table)?;
/// let mut display = MockDisplay::<Gray8>::new();
/// display.set_allow_overdraw(true); // triangles share their borders
/// for (count, corners) in tessellate(&sail, &table, Tolerance::new(I16F16::ONE)?)?.enumerate() {
///     let [a, b, c] = corners.map(|vertex| Point::new(vertex.point.x.to_num(), vertex.point.y.to_num()));
///     let shade = PrimitiveStyle::with_fill(Gray8::new(100 + 4 * (count % 32) as u8));
///     Triangle::new(a, b, c).into_styled(shade).draw(&mut display)?;
/// }
/// assert!(display.get_pixel(Point::new(30, 30)).is_some());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`SubdivideError::Buffer`] for fewer entries of the topology than patches; [`SubdivideError::Point`] for a patch whose control points are all equal;
/// [`SubdivideError::PatchTooDeep`] where 16 halvings in one direction do not make a patch flat. Rounding takes some
/// 2^-16 a level, and more where weights differ by factors beyond 2^10, so the finest tolerance is around 2^-11.
pub fn tessellate<'a, S: Surface>(
    patches: &'a [S],
    topology: &'a [PatchTopology],
    tolerance: Tolerance,
) -> Result<Tessellation<'a, S>, SubdivideError> {
    if topology.len() < patches.len() {
        let (needed, given) = (patches.len(), topology.len());
        return Err(SubdivideError::Buffer { buffer: Buffer::Topology, needed, given });
    }
    for (patch, surface) in patches.iter().enumerate() {
        let points = surface.surface();
        let points = points.points();
        if points.iter().all(|p| Some(p) == points.first()) {
            return Err(SubdivideError::Point { patch });
        }
    }
    let mut mesh = Tessellation { patches, topology, tolerance: tolerance.bits(), leaf: None, zips: [None; 2] };
    // Every cell is visited once, so that nothing later can be too deep.
    for patch in 0..patches.len() {
        let Some(tree) = mesh.tree(patch) else { continue };
        let mut cell = Some(tree.domain.first());
        while let Some(from) = cell {
            let leaf = mesh.leaf_from(patch, &tree, from).ok_or(SubdivideError::PatchTooDeep { patch, limit: FINE })?;
            cell = tree.domain.next(leaf.cell);
        }
    }
    mesh.leaf = mesh.first_leaf(0);
    mesh.start();
    Ok(mesh)
}

impl<'a, S: Surface> Tessellation<'a, S> {
    fn net(&self, patch: usize) -> Option<SurfaceNet<'a>> {
        self.patches.get(patch).map(Surface::surface)
    }

    fn tree(&self, patch: usize) -> Option<Tree<'a>> {
        self.net(patch).map(|net| Tree::new(net, self.tolerance))
    }

    /// The leaf that holds the first part of a cell.
    fn leaf_from(&self, patch: usize, tree: &Tree<'a>, from: Cell) -> Option<Leaf> {
        let domain = tree.domain;
        let target = domain.descend(from, domain.deepest());
        match tree.reach(target, from.level, || self.least(patch)) {
            Reach::Leaf(level) => Some(Leaf { patch, domain, cell: domain.ancestor(target, level) }),
            _ => None,
        }
    }

    fn first_leaf(&self, patch: usize) -> Option<Leaf> {
        let tree = self.tree(patch)?;
        self.leaf_from(patch, &tree, tree.domain.first())
    }

    fn next_leaf(&self, leaf: &Leaf) -> Option<Leaf> {
        match leaf.domain.next(leaf.cell) {
            Some(from) => self.leaf_from(leaf.patch, &self.tree(leaf.patch)?, from),
            None => self.first_leaf(leaf.patch + 1),
        }
    }

    /// Whether a cell exists and is split; those above level `from` that hold it are known to be.
    fn is_split(&self, patch: usize, cell: Cell, from: u8) -> bool {
        let Some(tree) = self.tree(patch) else { return false };
        cell.level < tree.domain.deepest() && tree.reach(cell, from, || self.least(patch)) == Reach::Split
    }

    /// Whether a cell beyond a segment of a leaf's side has a vertex in the middle of it: segment `index` of 2^down, as
    /// the side runs.
    fn is_divided(&self, leaf: &Leaf, side: usize, (down, index): (u8, u32)) -> bool {
        let domain = leaf.domain;
        let ours = domain.along(leaf.cell, side, down, index);
        match domain.across(ours, side) {
            // The side opposite to a pinched corner has a vertex in the middle, so that nothing cuts the corner off.
            Some(other)
                if domain.triangle && [ours, other].into_iter().any(|c| self.pinched(leaf, c) == Some(side)) =>
            {
                true
            }
            Some(other) => self.is_split(leaf.patch, other, domain.shared(leaf.cell, other)),
            None => {
                let exponent = domain.exponent(ours.level, side);
                self.is_divided_beyond((leaf.patch, side), exponent, domain.place(ours, side))
            }
        }
    }

    /// The same for segment `index` of 2^exponent of an edge, in all other patches on the same curve.
    fn is_divided_beyond(&self, (patch, edge): (usize, usize), exponent: u32, index: u32) -> bool {
        let Some(net) = self.net(patch) else { return false };
        if is_collapsed(&net, edge) {
            return false;
        }
        (0..self.patches.len()).any(|beyond| {
            let Some(other) = self.net(beyond) else { return false };
            (0..edge_count(&other)).any(|across| {
                let Some(reversed) = same_curve((&net, edge), (&other, across)) else { return false };
                if (beyond, across) == (patch, edge) {
                    return false;
                }
                let index = if reversed { (1 << exponent) - 1 - index } else { index };
                let domain = Tree::new(other, self.tolerance).domain;
                let Some(level) = exponent.checked_sub(domain.exponent(0, across)) else { return true };
                let level = level as u8;
                level < domain.deepest() && self.is_split(beyond, domain.on_border(across, level, index), 0)
            })
        })
    }

    /// The level that a patch's leaves have at least, so that no two mesh edges have the same ends.
    fn least(&self, patch: usize) -> u8 {
        let Some(net) = self.net(patch) else { return 0 };
        let closed = |edge| {
            let (a, b) = edge_ends(&net, edge);
            a == b && !is_collapsed(&net, edge)
        };
        if (0..edge_count(&net)).any(closed) {
            return MOST_LEAST;
        }
        let others = (0..self.patches.len()).filter(|other| *other != patch);
        u8::from(others.filter_map(|other| self.net(other)).any(|other| collide(&net, &other)))
    }

    /// The corner of a patch that a cell below level 0 is at, if both edges there belong to one other patch as well: no
    /// mesh edge may join the two, for the other patch could have it too.
    fn pinched(&self, leaf: &Leaf, cell: Cell) -> Option<usize> {
        let (domain, net) = (leaf.domain, self.net(leaf.patch)?);
        if cell.level == 0 {
            return None;
        }
        let sides = |corner: usize| {
            if domain.triangle { ((corner + 1) % 3, (corner + 2) % 3) } else { (corner & 1, 2 + (corner >> 1)) }
        };
        let on_border = |side| domain.across(cell, side).is_none();
        let corner = (0..edge_count(&net)).find(|corner| on_border(sides(*corner).0) && on_border(sides(*corner).1))?;
        let (first, second) = sides(corner);
        let shared = |other: &SurfaceNet<'_>, edge: usize| {
            (0..edge_count(other)).any(|across| same_curve((&net, edge), (other, across)).is_some())
        };
        let mut others = (0..self.patches.len()).filter(|other| *other != leaf.patch).filter_map(|p| self.net(p));
        others.any(|other| shared(&other, first) && shared(&other, second)).then_some(corner)
    }

    /// The exact point.
    fn spot(&self, patch: usize, fine: Fine) -> Spot {
        let point = self.net(patch).map_or(Point3::ORIGIN, |net| eval(&net, fine));
        Spot { fine, point }
    }

    /// Makes the zips of the current leaf.
    #[inline(never)]
    fn start(&mut self) {
        let Some(leaf) = self.leaf else { return };
        let runs = self.runs(&leaf);
        for (which, runs) in runs.into_iter().enumerate() {
            let zip = runs.map(|runs| Zip::new(self, &leaf, runs));
            if let Some(to) = self.zips.get_mut(which) {
                *to = zip;
            }
        }
    }

    /// The chains that a leaf is cut between.
    #[inline(never)]
    fn runs(&self, leaf: &Leaf) -> [Option<(Run, Run)>; 2] {
        let run = |(side, from)| Run { side, from, divided: self.is_divided(leaf, side, (0, 0)), half: false };
        if let Some(sides) = self.triangle(leaf) {
            let sides = sides.map(run);
            let [first, second, third] = sides;
            let pinched = if leaf.domain.triangle { self.pinched(leaf, leaf.cell) } else { None };
            // Counter-clockwise; one that has no vertices inside may close a zip that starts at the opposite corner.
            let [opposite, ahead, behind] = match pinched.or(sides.iter().position(|side| !side.divided)) {
                Some(1) => [second, third, first],
                Some(2) => [third, first, second],
                _ => [first, second, third],
            };
            if opposite.divided {
                let back = opposite.reversed(leaf).half();
                return [Some((opposite.half(), behind.reversed(leaf))), Some((ahead, back))];
            }
            return [Some((behind, ahead.reversed(leaf))), None];
        }
        let corner = |c| self.spot(leaf.patch, leaf.domain.corner(leaf.cell, c)).point;
        let long = match self.pinched(leaf, leaf.cell) {
            Some(corner) => matches!(corner, 1 | 2),
            None => squared(corner(0), corner(3)) > squared(corner(1), corner(2)),
        };
        if long {
            [Some((run((2, 0)), run((0, 0)))), Some((run((3, 3)), run((1, 3))))]
        } else {
            [Some((run((1, 1)), run((2, 1)))), Some((run((0, 2)), run((3, 2))))]
        }
    }

    /// The three sides of a leaf and the corners where they start, counter-clockwise; `None` for one with four sides. A
    /// side collapsed to a point is none: the first is opposite to it.
    fn triangle(&self, leaf: &Leaf) -> Option<[(usize, usize); 3]> {
        if leaf.domain.triangle {
            return Some([(0, 1), (1, 2), (2, 0)]);
        }
        let net = self.net(leaf.patch)?;
        let point = |side: &usize| leaf.domain.across(leaf.cell, *side).is_none() && is_collapsed(&net, *side);
        Some(match (0..4).find(point)? {
            0 => [(1, 1), (3, 3), (2, 0)],
            1 => [(0, 2), (2, 0), (3, 3)],
            2 => [(3, 3), (0, 2), (1, 1)],
            _ => [(2, 0), (1, 1), (0, 2)],
        })
    }

    fn vertex(&self, leaf: &Leaf, spot: Spot) -> Vertex {
        let parameters = [spot.fine[0], spot.fine[1]].map(dyadic);
        Vertex { point: spot.point, patch: leaf.patch, parameters }
    }
}

impl<S: Surface> Tessellation<'_, S> {
    fn is_inward(&self, patch: usize) -> bool {
        self.topology.get(patch).is_some_and(PatchTopology::is_inward)
    }

    /// The next triangle between three different places.
    fn next_spots(&mut self) -> Option<(Leaf, [Spot; 3])> {
        loop {
            let leaf = self.leaf?;
            let [mut first, mut second] = self.zips;
            let next = |zip: &mut Option<Zip>| zip.as_mut().and_then(|zip| zip.next(self, &leaf));
            let found = next(&mut first).or_else(|| next(&mut second));
            self.zips = [first, second];
            match found {
                Some([a, b, c]) if a.point != b.point && b.point != c.point && c.point != a.point => {
                    return Some((leaf, if self.is_inward(leaf.patch) { [a, c, b] } else { [a, b, c] }));
                }
                Some(_) => {}
                None => {
                    self.leaf = self.next_leaf(&leaf);
                    self.start();
                }
            }
        }
    }
}

impl<S: Surface> Iterator for Tessellation<'_, S> {
    type Item = [Vertex; 3];

    fn next(&mut self) -> Option<Self::Item> {
        self.next_spots().map(|(leaf, corners)| corners.map(|spot| self.vertex(&leaf, spot)))
    }
}

impl<S: Surface> core::iter::FusedIterator for Tessellation<'_, S> {}

fn edge_ends(net: &SurfaceNet<'_>, edge: usize) -> (Point3, Point3) {
    let at = |k| net_point(net.points(), edge_index(net, edge, k));
    (at(0), at(edge_degree(net, edge)))
}

/// Whether the meshes of two patches that are one cell each could have different edges with the same ends.
fn collide(net: &SurfaceNet<'_>, other: &SurfaceNet<'_>) -> bool {
    let (ours, theirs) = (corners(net), corners(other));
    let same_side = |p: Point3, q: Point3| {
        let has = |(a, b): (Point3, Point3)| (a, b) == (p, q) || (b, a) == (p, q);
        (0..edge_count(net)).filter(|edge| has(edge_ends(net, *edge))).all(|edge| {
            let mut twins = (0..edge_count(other)).filter(|across| has(edge_ends(other, *across)));
            twins.all(|across| same_curve((net, edge), (other, across)).is_some())
        }) && (0..edge_count(net)).any(|edge| has(edge_ends(net, edge)))
            && (0..edge_count(other)).any(|edge| has(edge_ends(other, edge)))
    };
    let [a, b, c, d] = ours;
    [(a, b), (a, c), (b, c), (a, d), (b, d), (c, d)]
        .into_iter()
        .any(|(p, q)| p != q && theirs.contains(&p) && theirs.contains(&q) && !same_side(p, q))
}

/// The corners; the last of a triangle twice.
fn corners(net: &SurfaceNet<'_>) -> [Point3; 4] {
    let (a, b) =
        if net.is_triangle() { (edge_ends(net, 2), edge_ends(net, 1)) } else { (edge_ends(net, 2), edge_ends(net, 3)) };
    if net.is_triangle() { [a.0, a.1, b.1, b.1] } else { [a.0, a.1, b.0, b.1] }
}

fn squared(a: Point3, b: Point3) -> i128 {
    (Triple::of(a) - Triple::of(b)).to_array().into_iter().map(|c| i128::from(c).pow(2)).sum()
}
