//! Indexed meshes in the caller's buffers.

use super::cell::Fine;
use super::zip::{Chain, Leaf, Run};
use super::{Tessellation, edge_ends, normal};
use crate::geometry::{Point3, Vector3};
use crate::num::{Coord, I16F16};
use crate::patch::{Parameter, Surface};
use crate::subdivide::edge::{edge_count, is_collapsed, same_curve};
use crate::subdivide::{Buffer, PatchTopology, SubdivideError};

/// A vertex of an indexed mesh, 44 bytes on a 32-bit target.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct MeshVertex {
    /// The exact point of the patch at the parameters, rounded once, half up. No other vertex of the part has the same.
    pub point: Point3,
    /// The unit normal of the patch there, away from the volume, each component within 2^-14.
    ///
    /// Where patches meet at an angle it is that of the first. Where a derivative of the patch vanishes, as at a
    /// collapsed side, it is that of a point nearby, or at last that of a triangle.
    pub normal: Vector3<I16F16>,
    /// The index of the first patch that has the vertex.
    pub patch: usize,
    /// (r, s) of a tensor-product patch, (u, v) of a triangle.
    pub parameters: [Parameter; 2],
}

impl MeshVertex {
    /// What a buffer is filled with before there is a mesh.
    pub const BLANK: Self = Self {
        point: Point3::ORIGIN,
        normal: Vector3::new(I16F16::ZERO, I16F16::ZERO, I16F16::ZERO),
        patch: 0,
        parameters: [Parameter::ZERO; 2],
    };
}

/// How much room a mesh takes.
///
/// Vertices of a part at one place are counted once where curves or collapsed sides tell that they are one; a
/// coincidence of others makes the mesh smaller than this, never larger.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct MeshSize {
    /// Entries of the buffer for vertices.
    pub vertices: usize,
    /// Entries of the buffer for triangles.
    pub triangles: usize,
    /// Entries of the buffer for the index, at least: one more than there are vertices. With twice as many it takes
    /// two looks to find a vertex, on average.
    pub index: usize,
}

/// The buffers that a mesh is written to.
#[derive(Debug)]
pub struct MeshBuffers<'b> {
    /// See [`MeshSize::vertices`].
    pub vertices: &'b mut [MeshVertex],
    /// See [`MeshSize::triangles`].
    pub triangles: &'b mut [[u32; 3]],
    /// A hash table by place, of use only while the mesh is made. See [`MeshSize::index`].
    pub index: &'b mut [u32],
}

/// An indexed mesh in the caller's buffers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Mesh<'b> {
    vertices: &'b [MeshVertex],
    triangles: &'b [[u32; 3]],
}

#[cfg(feature = "defmt")]
impl defmt::Format for MeshBuffers<'_> {
    fn format(&self, f: defmt::Formatter<'_>) {
        let (vertices, triangles, index) = (self.vertices.len(), self.triangles.len(), self.index.len());
        defmt::write!(f, "MeshBuffers {{ vertices: {}, triangles: {}, index: {} }}", vertices, triangles, index);
    }
}

#[cfg(feature = "defmt")]
impl defmt::Format for Mesh<'_> {
    fn format(&self, f: defmt::Formatter<'_>) {
        let (vertices, triangles) = (self.vertices.len(), self.triangles.len());
        defmt::write!(f, "Mesh {{ {} vertices, {} triangles }}", vertices, triangles);
    }
}

impl<'b> Mesh<'b> {
    /// The vertices, in the order in which triangles first have them.
    #[must_use]
    pub const fn vertices(&self) -> &'b [MeshVertex] {
        self.vertices
    }

    /// Indices of the corners of each triangle, counter-clockwise seen from outside.
    #[must_use]
    pub const fn triangles(&self) -> &'b [[u32; 3]] {
        self.triangles
    }

    /// The corners of each triangle.
    pub fn corners(&self) -> impl Iterator<Item = [Point3; 3]> + Clone + use<'b> {
        let Self { vertices, triangles } = *self;
        let point = move |index: u32| vertices.get(index as usize).map_or(Point3::ORIGIN, |vertex| vertex.point);
        triangles.iter().map(move |corners| corners.map(point))
    }
}

/// What a free place in the index holds.
const FREE: u32 = u32::MAX;

impl<S: Surface> Tessellation<'_, S> {
    /// How much room the mesh of all triangles takes: counted, no vertex is evaluated.
    ///
    /// By Euler's formula a patch with T triangles and B border segments has (T + B)/2 + 1 vertices; those on shared
    /// curves and in corners are counted apart.
    #[must_use]
    pub fn size(&self) -> MeshSize {
        let (mut vertices, mut triangles) = (0, 0);
        for patch in 0..self.patches.len() {
            let (cells, border) = self.count(patch);
            let segments = border.iter().sum::<usize>();
            vertices += (cells + 2).saturating_sub(segments) / 2;
            triangles += cells;
            for (edge, segments) in border.into_iter().enumerate() {
                match self.first_on_curve(patch, edge) {
                    Curve::Collapsed => triangles -= segments.min(triangles),
                    Curve::First => vertices += segments.saturating_sub(1),
                    Curve::Later => {}
                }
            }
            vertices += self.new_corners(patch);
        }
        MeshSize { vertices, triangles, index: vertices + 1 }
    }

    /// Triangles of a patch, and segments of each of its edges.
    fn count(&self, patch: usize) -> (usize, [usize; 4]) {
        let (mut triangles, mut border) = (0, [0; 4]);
        let mut next = self.first_leaf(patch);
        while let Some(leaf) = next {
            let sides = if leaf.domain.triangle { 3 } else { 4 };
            let mut corners = 0;
            for (side, segments) in border.iter_mut().enumerate().take(sides) {
                let divided = self.is_divided(&leaf, side, (0, 0));
                let run = Run { side, from: leaf.ends(side).0, divided, half: false };
                let count = Chain::new(&leaf, run).count(self, &leaf);
                corners += count;
                if leaf.domain.across(leaf.cell, side).is_none() {
                    *segments += count;
                }
            }
            triangles += corners - 2;
            next = self.next_leaf(&leaf).filter(|leaf| leaf.patch == patch);
        }
        (triangles, border)
    }

    fn first_on_curve(&self, patch: usize, edge: usize) -> Curve {
        let Some(net) = self.net(patch) else { return Curve::Later };
        if edge >= edge_count(&net) {
            return Curve::Later;
        }
        if is_collapsed(&net, edge) {
            return Curve::Collapsed;
        }
        let earlier = (0..=patch).any(|before| {
            let Some(other) = self.net(before) else { return false };
            let edges = if before == patch { edge } else { edge_count(&other) };
            (0..edges).any(|across| same_curve((&net, edge), (&other, across)).is_some())
        });
        if earlier { Curve::Later } else { Curve::First }
    }

    /// Corners of a patch that no earlier patch of its part has.
    fn new_corners(&self, patch: usize) -> usize {
        let corners = |patch: usize| {
            let ends = |net| [2, if net_is_triangle(&net) { 1 } else { 3 }].map(|edge| edge_ends(&net, edge));
            self.net(patch).map(ends).into_iter().flatten().flat_map(|(a, b)| [a, b])
        };
        let seen_before = |place: usize, p: Point3| {
            let earlier = (0..patch).filter(|before| self.part(*before) == self.part(patch));
            earlier.flat_map(corners).any(|q| q == p) || corners(patch).take(place).any(|q| q == p)
        };
        corners(patch).enumerate().filter(|(place, p)| !seen_before(*place, *p)).count()
    }

    /// The indexed mesh of all triangles, in the caller's buffers.
    ///
    /// Vertices of a part at one place are one, so neighbouring patches share them. Cost: the triangles, exact derivatives once
    /// per vertex, and a look into a hash table per corner.
    ///
    /// ```
    /// use embedded_surfaces::geometry::Point3;
    /// use embedded_surfaces::num::I16F16;
    /// use embedded_surfaces::patch::sphere;
    /// use embedded_surfaces::subdivide::{MeshBuffers, MeshVertex, PatchTopology, Tolerance, tessellate, topology};
    /// let ball = sphere(Point3::ORIGIN, I16F16::from_num(20))?;
    /// let mut table = [PatchTopology::default(); 8];
    /// topology(&ball, &mut table)?;
    /// let triangles = tessellate(&ball, &table, Tolerance::new(I16F16::from_num(2))?)?;
    /// let (mut vertices, mut faces, mut index) = ([MeshVertex::BLANK; 400], [[0; 3]; 800], [0; 800]);
    /// let buffers = MeshBuffers { vertices: &mut vertices, triangles: &mut faces, index: &mut index };
    /// let mesh = triangles.mesh(buffers)?;
    /// assert_eq!((mesh.vertices().len(), mesh.triangles().len()), (triangles.size().vertices, triangles.count()));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`SubdivideError::Buffer`] for the first buffer that is too small, with the entries it needs
    /// ([`size`](Self::size)). What the buffers hold then means nothing.
    pub fn mesh<'b>(&self, buffers: MeshBuffers<'b>) -> Result<Mesh<'b>, SubdivideError> {
        let MeshBuffers { vertices, triangles, index } = buffers;
        index.fill(FREE);
        let (mut count, mut filled) = (0, 0);
        let mut rest = Self { leaf: self.first_leaf(0), ..self.clone() };
        rest.start();
        while let Some((leaf, corners)) = rest.next_spots() {
            let mut indices = [0; 3];
            for (to, spot) in indices.iter_mut().zip(&corners) {
                let Some(slot) = self.slot(index, vertices, leaf.patch, spot.point) else {
                    return Err(self.too_small(Buffer::Index, index.len()));
                };
                if *slot == FREE {
                    let Some(vertex) = vertices.get_mut(count) else {
                        return Err(self.too_small(Buffer::Vertices, vertices.len()));
                    };
                    *vertex = self.mesh_vertex(&leaf, spot.fine, corners.map(|spot| spot.point), spot.point);
                    *slot = count as u32;
                    count += 1;
                }
                *to = *slot;
            }
            let Some(triangle) = triangles.get_mut(filled) else {
                return Err(self.too_small(Buffer::Triangles, triangles.len()));
            };
            *triangle = indices;
            filled += 1;
        }
        let (vertices, triangles): (&'b [_], &'b [_]) = (vertices, triangles);
        Ok(Mesh { vertices: vertices.get(..count).unwrap_or(&[]), triangles: triangles.get(..filled).unwrap_or(&[]) })
    }

    fn part(&self, patch: usize) -> usize {
        self.topology.get(patch).map_or(0, PatchTopology::part)
    }

    /// Where a place of a part stands in the index, or the free slot where it would; `None` if all others are taken.
    fn slot<'i>(
        &self,
        index: &'i mut [u32],
        vertices: &[MeshVertex],
        patch: usize,
        point: Point3,
    ) -> Option<&'i mut u32> {
        let hash = point
            .to_array()
            .into_iter()
            .fold(0x9e37_79b9_u32, |hash, c| (hash.rotate_left(13) ^ c.bits() as u32).wrapping_mul(0x85eb_ca6b));
        let start = ((u64::from(hash ^ hash >> 15) * index.len() as u64) >> 32) as usize;
        let is_it = |v: &MeshVertex| v.point == point && self.part(v.patch) == self.part(patch);
        let fits = |slot: &u32| *slot == FREE || vertices.get(*slot as usize).is_some_and(is_it);
        let (before, after) = index.split_at_mut_checked(start)?;
        after.iter_mut().chain(before).find(|slot| fits(slot))
    }

    fn too_small(&self, buffer: Buffer, given: usize) -> SubdivideError {
        let size = self.size();
        let needed = match buffer {
            Buffer::Vertices => size.vertices,
            Buffer::Triangles => size.triangles,
            _ => size.index,
        };
        SubdivideError::Buffer { buffer, needed, given }
    }

    fn mesh_vertex(&self, leaf: &Leaf, fine: Fine, triangle: [Point3; 3], point: Point3) -> MeshVertex {
        let sign = if self.is_inward(leaf.patch) { -1 } else { 1 };
        let own = self.net(leaf.patch).and_then(|net| normal::of_patch(&net, fine)).map(|n| n.map(|c| sign * c));
        let normal = own.or_else(|| normal::of_triangle(triangle)).unwrap_or([0; 3]);
        let vertex = self.vertex(leaf, super::Spot { fine, point });
        let (patch, parameters) = (vertex.patch, vertex.parameters);
        MeshVertex { point, normal: normal::rounded(normal), patch, parameters }
    }
}

/// How an edge's vertices count.
enum Curve {
    /// As one.
    Collapsed,
    /// Here.
    First,
    /// With an earlier edge.
    Later,
}

fn net_is_triangle(net: &crate::patch::SurfaceNet<'_>) -> bool {
    net.is_triangle()
}
