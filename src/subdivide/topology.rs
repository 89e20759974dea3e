//! How patches meet: classes of edges that take one segment count, parts, and a consistent orientation.
//!
//! Two patches meet where a boundary control polygon of one is bit-equal, forward or reversed, weights included, to one
//! of the other. Everything is found by comparing edges pair by pair, in constant context or at run time by the same
//! code, with union-find in the result itself: no other memory.

use super::edge::{edge_count, edge_index, is_collapsed, is_palindrome, net_point, runs_forward, same_curve};
use super::error::{Buffer, SubdivideError};
use crate::geometry::Point3;
use crate::num::bits_i16f16;
use crate::patch::{
    RationalTensor, RationalTriangle, Surface, SurfaceNet, Tensor, Triangle, TriangleNet, triangle_index,
};

/// The most patches of a table: 4 edges each are named by 16 bits.
const MOST_PATCHES: usize = 1 << 14;

/// How a patch meets its neighbours: edge classes, part and orientation, 12 bytes.
///
/// Edges of a tensor-product patch: 0 r = 0, 1 r = 1, 2 s = 0, 3 s = 1. Of a triangle: 0 u = 0, 1 v = 0, 2 w = 0.
/// Two edges are in one *class* if a grid must cut them into equally many segments: opposite edges of a
/// tensor-product patch, the three edges of a triangle, edges of any two patches that are the same curve, and
/// whatever follows from these. Classes are numbered from 0 in order of their first edge.
///
/// A *part* is a set of patches connected by joints. A joint is a curve that two edges share; where more than two
/// share one, the first two are joined. Edges collapsed to a point join nothing.
///
/// ```
/// use embedded_surfaces::patch::BilinearPatch;
/// use embedded_surfaces::subdivide::PatchTopology;
/// use embedded_surfaces::const_net;
/// // Two squares side by side, the second turned over; made by the compiler, stored in flash.
/// static PAGES: [BilinearPatch; 2] = [
///     const_net!(BilinearPatch::from_ints([[[0, 0, 0], [0, 9, 0]], [[9, 0, 0], [9, 9, 0]]])),
///     const_net!(BilinearPatch::from_ints([[[9, 0, 0], [18, 0, 0]], [[9, 9, 0], [18, 9, 0]]])),
/// ];
/// static TOPOLOGY: [PatchTopology; 2] = const_net!(BilinearPatch::topology(&PAGES));
/// assert_eq!(TOPOLOGY[0].classes(), [0, 0, 1, 1]);
/// assert_eq!(TOPOLOGY[1].classes(), [2, 2, 0, 0]);
/// assert_ne!(TOPOLOGY[0].is_inward(), TOPOLOGY[1].is_inward());
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct PatchTopology {
    /// While they are found: parents of a union-find over all edges.
    classes: [u16; 4],
    /// While it is found: the parent of a union-find over patches, with `inward` as the parity to it.
    part: u16,
    /// Bit e: edge e is joined.
    joined: u8,
    inward: bool,
}

impl PatchTopology {
    /// The class of each edge; the fourth of a triangle is that of the others.
    #[must_use]
    pub const fn classes(&self) -> [u16; 4] {
        self.classes
    }

    /// The number of the part, from 0 in order of the first patches.
    #[must_use]
    pub const fn part(&self) -> usize {
        self.part as usize
    }

    /// Whether the edge is joined to another one: neither on the border of the part nor collapsed.
    #[must_use]
    pub const fn is_joined(&self, edge: usize) -> bool {
        edge < 4 && self.joined >> edge & 1 == 1
    }

    /// Whether the normal S_r × S_s (S_u × S_v) points into the volume of the part.
    ///
    /// All patches of a part are oriented alike, and so that the volume is positive: that of the control nets, cut
    /// into triangles, an open part being closed by the cone from one point of its border over the rest of it. A
    /// part without volume has the orientation of its first patch.
    #[must_use]
    pub const fn is_inward(&self) -> bool {
        self.inward
    }

    /// The same, oriented the other way.
    #[must_use]
    pub const fn flipped(self) -> Self {
        Self { inward: !self.inward, ..self }
    }

    /// The topology of patches of several kinds, in constant context; [`topology`] does it at run time.
    ///
    /// # Errors
    /// [`SubdivideError::NotOrientable`], [`SubdivideError::TooManyPatches`].
    pub const fn of_nets<const P: usize>(nets: &[SurfaceNet<'_>; P]) -> Result<[Self; P], SubdivideError> {
        let mut out = [Self { classes: [0; 4], part: 0, joined: 0, inward: false }; P];
        match of_slice(nets, &mut out) {
            Ok(()) => Ok(out),
            Err(error) => Err(error),
        }
    }
}

// Union-find in the table itself. Parents come before their children; roots are their own parents.

const fn edge_parent(table: &[PatchTopology], edge: usize) -> usize {
    if edge / 4 < table.len() { table[edge / 4].classes[edge % 4] as usize } else { edge }
}

const fn set_edge_parent(table: &mut [PatchTopology], edge: usize, parent: usize) {
    if edge / 4 < table.len() {
        table[edge / 4].classes[edge % 4] = parent as u16;
    }
}

const fn edge_root(table: &[PatchTopology], mut edge: usize) -> usize {
    while edge_parent(table, edge) < edge {
        edge = edge_parent(table, edge);
    }
    edge
}

const fn unite_edges(table: &mut [PatchTopology], a: usize, b: usize) {
    let (a, b) = (edge_root(table, a), edge_root(table, b));
    let (low, high) = if a < b { (a, b) } else { (b, a) };
    set_edge_parent(table, high, low);
}

const fn entry(table: &[PatchTopology], patch: usize) -> PatchTopology {
    if patch < table.len() {
        table[patch]
    } else {
        PatchTopology { classes: [0; 4], part: patch as u16, joined: 0, inward: false }
    }
}

const fn set_part(table: &mut [PatchTopology], patch: usize, part: usize, inward: bool) {
    if patch < table.len() {
        table[patch].part = part as u16;
        table[patch].inward = inward;
    }
}

/// The first patch of the part, and whether this one is oriented against it.
const fn part_root(table: &[PatchTopology], mut patch: usize) -> (usize, bool) {
    let mut parity = false;
    while entry(table, patch).part() < patch {
        parity ^= entry(table, patch).inward;
        patch = entry(table, patch).part();
    }
    (patch, parity)
}

const fn set_joined(table: &mut [PatchTopology], (patch, edge): (usize, usize)) {
    if patch < table.len() {
        table[patch].joined |= 1 << edge;
    }
}

/// Every patch and every edge alone, but for edges of one patch that go together.
const fn start(net: &SurfaceNet<'_>, table: &mut [PatchTopology], patch: usize) {
    if patch < table.len() {
        let edge = 4 * patch as u16;
        let classes = if net.is_triangle() { [edge; 4] } else { [edge, edge, edge + 2, edge + 2] };
        table[patch] = PatchTopology { classes, part: patch as u16, joined: 0, inward: false };
    }
}

/// Joins two edges, each (net, patch, edge), the first before the second, if they are the same curve.
const fn join(
    table: &mut [PatchTopology],
    (net, patch, edge): (&SurfaceNet<'_>, usize, usize),
    (other, beyond, across): (&SurfaceNet<'_>, usize, usize),
) -> Result<(), SubdivideError> {
    let Some(reversed) = same_curve((net, edge), (other, across)) else { return Ok(()) };
    unite_edges(table, 4 * patch + edge, 4 * beyond + across);
    let taken = entry(table, patch).is_joined(edge) || entry(table, beyond).is_joined(across);
    if taken {
        return Ok(());
    }
    set_joined(table, (patch, edge));
    set_joined(table, (beyond, across));
    if is_palindrome(net, edge) {
        return Ok(());
    }
    // Consistent neighbours run along their common curve in opposite directions.
    let against = (runs_forward(net, edge) == runs_forward(other, across)) != reversed;
    let ((a, parity_a), (b, parity_b)) = (part_root(table, patch), part_root(table, beyond));
    let between = parity_a ^ parity_b ^ against;
    if a == b {
        return if between { Err(SubdivideError::NotOrientable { patch: beyond }) } else { Ok(()) };
    }
    let (low, high) = if a < b { (a, b) } else { (b, a) };
    set_part(table, high, low, between);
    Ok(())
}

/// Every patch directly under the first of its part.
const fn flatten(table: &mut [PatchTopology]) {
    let mut patch = 0;
    while patch < table.len() {
        let (root, parity) = part_root(table, patch);
        set_part(table, patch, root, parity);
        patch += 1;
    }
}

/// Names of classes and parts become numbers in order of first appearance.
const fn number(table: &mut [PatchTopology]) {
    let (mut edge, mut classes) = (0, 0);
    while edge < 4 * table.len() {
        // Roots come first: theirs is a number already.
        let root = edge_root(table, edge);
        set_edge_parent(table, edge, root);
        edge += 1;
    }
    edge = 0;
    while edge < 4 * table.len() {
        let root = edge_parent(table, edge);
        if root == edge {
            set_edge_parent(table, edge, classes);
            classes += 1;
        } else {
            let class = edge_parent(table, root);
            set_edge_parent(table, edge, class);
        }
        edge += 1;
    }
    let (mut patch, mut parts) = (0, 0);
    while patch < table.len() {
        let PatchTopology { part: root, inward, .. } = table[patch];
        if root as usize == patch {
            set_part(table, patch, parts, inward);
            parts += 1;
        } else {
            let part = entry(table, root as usize).part();
            set_part(table, patch, part, inward);
        }
        patch += 1;
    }
}

/// The first point of the first edge that is on the border, if there is one.
const fn border_point(net: &SurfaceNet<'_>, topology: PatchTopology) -> Option<Point3> {
    let mut edge = 0;
    while edge < edge_count(net) {
        if !topology.is_joined(edge) && !is_collapsed(net, edge) {
            return Some(net_point(net.points(), edge_index(net, edge, 0)));
        }
        edge += 1;
    }
    None
}

/// Corners of cell (i, j) of a control net, the triangles (0, 1, 2) and (2, 1, 3) being counter-clockwise; a triangle's
/// cell of row i and place j from T2 has no fourth corner in the last row.
const fn cell(net: &SurfaceNet<'_>, i: usize, j: usize) -> [Option<Point3>; 4] {
    let (m, h) = net.degrees();
    let points = net.points();
    let (indices, whole) = if net.is_triangle() {
        let (j, k) = (i - j, j);
        let fourth = triangle_index(j + 1, k + 1);
        ([triangle_index(j, k), triangle_index(j + 1, k), triangle_index(j, k + 1), fourth], i + 1 < m)
    } else {
        let at = i * (h + 1) + j;
        ([at, at + h + 1, at + 1, at + h + 2], true)
    };
    let fourth = if whole { Some(net_point(points, indices[3])) } else { None };
    [
        Some(net_point(points, indices[0])),
        Some(net_point(points, indices[1])),
        Some(net_point(points, indices[2])),
        fourth,
    ]
}

/// Six times the signed volume between a point and a control net, its cells cut into triangles: below 2^106.
const fn volume(net: &SurfaceNet<'_>, from: Point3) -> i128 {
    let (m, h) = net.degrees();
    let (mut sum, mut i) = (0, 0);
    while i < m {
        let columns = if net.is_triangle() { i + 1 } else { h };
        let mut j = 0;
        while j < columns {
            let [a, b, c, d] = cell(net, i, j);
            sum += determinant([a, b, c], from) + determinant([c, b, d], from);
            j += 1;
        }
        i += 1;
    }
    sum
}

/// The determinant of three points seen from a fourth, 0 if one is missing.
const fn determinant(corners: [Option<Point3>; 3], from: Point3) -> i128 {
    let [Some(a), Some(b), Some(c)] = corners else { return 0 };
    let (a, b, c) = (seen(a, from), seen(b, from), seen(c, from));
    a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0])
}

/// The difference of two points: 33 bits.
const fn seen(p: Point3, from: Point3) -> [i128; 3] {
    [
        (bits_i16f16(p.x) - bits_i16f16(from.x)) as i128,
        (bits_i16f16(p.y) - bits_i16f16(from.y)) as i128,
        (bits_i16f16(p.z) - bits_i16f16(from.z)) as i128,
    ]
}

const fn check_room(patches: usize, given: usize) -> Result<(), SubdivideError> {
    if patches > MOST_PATCHES {
        return Err(SubdivideError::TooManyPatches { given: patches, most: MOST_PATCHES });
    }
    if given < patches {
        return Err(SubdivideError::Buffer { buffer: Buffer::Topology, needed: patches, given });
    }
    Ok(())
}

/// Joins the edges of `$count` patches, the net of patch p being `$net`: the body of a `const fn` and of a generic
/// function, since traits cannot be called in constant context.
macro_rules! join_all {
    ($count:ident, $table:ident, |$patch:ident| $net:expr) => {{
        let mut $patch = 0;
        while $patch < $count {
            start(&$net, $table, $patch);
            $patch += 1;
        }
        let mut a = 0;
        while a < $count {
            $patch = a;
            let net = &$net;
            let mut edge = 0;
            while edge < edge_count(net) {
                $patch = if is_collapsed(net, edge) { $count } else { a };
                while $patch < $count {
                    let other = &$net;
                    let mut across = if a == $patch { edge + 1 } else { 0 };
                    while across < edge_count(other) {
                        if let Err(error) = join($table, (net, a, edge), (other, $patch, across)) {
                            return Err(error);
                        }
                        across += 1;
                    }
                    $patch += 1;
                }
                edge += 1;
            }
            a += 1;
        }
    }};
}

/// Turns every part whose volume is negative. Parts still have the number of their first patch.
macro_rules! orient {
    ($count:ident, $table:ident, |$patch:ident| $net:expr) => {{
        let mut part = 0;
        while part < $count {
            let mut $patch = part;
            let (mut from, mut sum) = (net_point((&$net).points(), 0), 0);
            let mut open = false;
            while !open && $patch < $count {
                if entry($table, $patch).part() == part
                    && let Some(point) = border_point(&$net, entry($table, $patch))
                {
                    (from, open) = (point, true);
                }
                $patch += 1;
            }
            $patch = part;
            while $patch < $count {
                let topology = entry($table, $patch);
                if topology.part() == part {
                    let own = volume(&$net, from);
                    sum += if topology.inward { -own } else { own };
                }
                $patch += 1;
            }
            $patch = part;
            while sum < 0 && $patch < $count {
                let topology = entry($table, $patch);
                if topology.part() == part {
                    set_part($table, $patch, part, !topology.inward);
                }
                $patch += 1;
            }
            part += 1;
        }
    }};
}

/// The whole search.
macro_rules! search {
    ($count:expr, $out:ident, |$patch:ident| $net:expr) => {{
        let count = $count;
        if let Err(error) = check_room(count, $out.len()) {
            return Err(error);
        }
        let (table, _) = $out.split_at_mut(count);
        join_all!(count, table, |$patch| $net);
        flatten(table);
        orient!(count, table, |$patch| $net);
        number(table);
        Ok(())
    }};
}

#[allow(clippy::question_mark, reason = "there is no `?` in constant context")]
const fn of_slice(nets: &[SurfaceNet<'_>], out: &mut [PatchTopology]) -> Result<(), SubdivideError> {
    search!(nets.len(), out, |patch| nets[patch])
}

/// Writes the topology of each patch into the first entries of `out`.
///
/// Cost: every edge is compared with every other, mostly by one point; 16 P² / 2 comparisons for P patches. No memory
/// but `out`, 12 bytes a patch. Outside the loop over frames: it depends on the patches only. A view that maps them
/// keeps classes and parts; orientation is that of the patches given, and mirrors turn it.
///
/// ```
/// use embedded_surfaces::patch::FlatTriangle;
/// use embedded_surfaces::subdivide::{PatchTopology, topology};
/// let corners = [[0, 0, 0], [9, 0, 0], [0, 9, 0], [0, 0, 9]];
/// let faces = [[0, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3]].map(|f| f.map(|i: usize| corners[i]));
/// let faces = [0, 1, 2, 3].map(|i: usize| FlatTriangle::from_ints(faces[i]).unwrap());
/// let mut tetrahedron = [PatchTopology::default(); 4];
/// topology(&faces, &mut tetrahedron)?;
/// assert_eq!(tetrahedron.map(|t| t.is_inward()), [true, false, true, false]);
/// # Ok::<(), embedded_surfaces::subdivide::SubdivideError>(())
/// ```
///
/// # Errors
/// [`SubdivideError::Buffer`] with the number of entries needed, [`SubdivideError::NotOrientable`] for a part with
/// one side, [`SubdivideError::TooManyPatches`] for more than 16384. What `out` holds then means nothing.
#[allow(clippy::question_mark, reason = "the same text as in constant context")]
pub fn topology<S: Surface>(patches: &[S], out: &mut [PatchTopology]) -> Result<(), SubdivideError> {
    search!(patches.len(), out, |patch| match patches.get(patch) {
        Some(patch) => patch.surface(),
        None => EMPTY,
    })
}

/// A net that stands where there is none.
const EMPTY: SurfaceNet<'static> = SurfaceNet::Triangle(TriangleNet::of_checked(1, &[Point3::ORIGIN; 3]));

/// The topology of patches of one type, in constant context.
macro_rules! of_patches {
    ($type:ident<$($size:ident),*>, $variant:ident) => {
        impl<$(const $size: usize),*> $type<$($size),*> {
            /// How these patches meet, for a table in flash; [`topology`] does it at run time, and
            /// [`PatchTopology::of_nets`] for patches of several types.
            ///
            /// More than about 60 patches need `#[allow(long_running_const_eval)]`.
            ///
            /// # Errors
            /// [`SubdivideError::NotOrientable`], [`SubdivideError::TooManyPatches`].
            pub const fn topology<const P: usize>(patches: &[Self; P]) -> Result<[PatchTopology; P], SubdivideError> {
                let mut nets = [EMPTY; P];
                let mut patch = 0;
                while patch < P {
                    nets[patch] = SurfaceNet::$variant(patches[patch].net());
                    patch += 1;
                }
                PatchTopology::of_nets(&nets)
            }
        }
    };
}

of_patches!(Tensor<M, H>, Tensor);
of_patches!(Triangle<N, LEN>, Triangle);
of_patches!(RationalTensor<M, H>, RationalTensor);
of_patches!(RationalTriangle<N, LEN>, RationalTriangle);
