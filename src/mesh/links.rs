//! How the half-edges of faces meet: found and checked once.

use super::{Faces, MeshError};

/// The most edges that a vertex of a mesh may have.
pub const MAX_VALENCE: usize = 64;

/// No half-edge.
pub(super) const NONE: u16 = u16::MAX;

/// How the faces of a mesh meet: the twin of each half-edge and a half-edge of each vertex, in 2·(V + H) bytes.
///
/// Room for `V` vertices and `H` half-edges (three a triangle). A `const fn` makes it, so that a table in flash costs no
/// RAM and a wrong one does not compile:
///
/// ```
/// use embedded_surfaces::{const_mesh, geometry::Point3, mesh::{Faces, Links, Mesh}};
/// static POINTS: [Point3; 4] = [
///     Point3::from_ints(0, 0, 0), Point3::from_ints(90, 0, 0), Point3::from_ints(0, 90, 0), Point3::from_ints(0, 0, 90),
/// ];
/// static LINKS: Links<'_, 4, 12> =
///     const_mesh!(Links::new(4, Faces::Triangles(&[[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])));
/// static TETRAHEDRON: Mesh<'_> = const_mesh!(Mesh::<embedded_surfaces::num::I16F16>::new(&POINTS, &LINKS));
/// assert_eq!(TETRAHEDRON.valence(3), 3);
/// ```
///
/// ```compile_fail
/// use embedded_surfaces::{const_mesh, mesh::{Faces, Links}};
/// static TWICE: Links<'_, 4, 12> = const_mesh!(Links::new(4, Faces::Triangles(&[[0, 2, 2]])));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Links<'a, const V: usize, const H: usize> {
    faces: Faces<'a>,
    vertices: usize,
    /// A half-edge that leaves each vertex: the one on the border, if there is one.
    first: [u16; V],
    twins: [u16; H],
}

impl<'a, const V: usize, const H: usize> Links<'a, V, H> {
    /// The links of these faces between `vertices` vertices; also in constant context.
    ///
    /// A vertex without a face is legal. Cost: valence² for each vertex; 2·H bytes of stack besides.
    ///
    /// # Errors
    /// [`MeshError`] for more vertices or half-edges than `V` and `H` or 65535, an index out of range, a face with
    /// fewer than three or with repeated corners, an edge or a vertex that is not manifold, more than [`MAX_VALENCE`]
    /// edges.
    pub const fn new(vertices: usize, faces: Faces<'a>) -> Result<Self, MeshError> {
        let half_edges = faces.half_edges();
        if vertices > V || vertices >= NONE as usize {
            let limit = if V < NONE as usize { V } else { NONE as usize - 1 };
            return Err(MeshError::TooManyVertices { given: vertices, limit });
        }
        if half_edges > H || half_edges >= NONE as usize {
            let limit = if H < NONE as usize { H } else { NONE as usize - 1 };
            return Err(MeshError::TooManyHalfEdges { given: half_edges, limit });
        }
        let mut links = Self { faces, vertices, first: [NONE; V], twins: [NONE; H] };
        if let Err(error) = links.check_faces() {
            return Err(error);
        }
        if let Err(error) = links.join() {
            return Err(error);
        }
        match links.check_vertices() {
            Ok(()) => Ok(links),
            Err(error) => Err(error),
        }
    }

    const fn check_faces(&self) -> Result<(), MeshError> {
        let all = self.faces.all();
        let (mut face, mut expected) = (0, 0);
        while face < self.faces.len() {
            let (start, end) = self.faces.range(face);
            if start != expected || end > all.len() || (face + 1 == self.faces.len() && end != all.len()) {
                return Err(MeshError::Corners { face, end, corners: all.len() });
            }
            if end < start + 3 {
                return Err(MeshError::DegenerateFace { face });
            }
            let mut at = start;
            while at < end {
                let vertex = all[at] as usize;
                if vertex >= self.vertices {
                    return Err(MeshError::Index { face, vertex, vertices: self.vertices });
                }
                let mut other = start;
                while other < at {
                    if all[other] == all[at] {
                        return Err(MeshError::DegenerateFace { face });
                    }
                    other += 1;
                }
                at += 1;
            }
            expected = end;
            face += 1;
        }
        Ok(())
    }

    /// Finds the twins by way of lists of the half-edges that leave each vertex.
    const fn join(&mut self) -> Result<(), MeshError> {
        let mut following = [NONE; H];
        let mut half_edge = 0;
        while half_edge < self.faces.half_edges() && half_edge < H {
            let (from, to) = self.ends(half_edge);
            if from >= V || to >= V {
                return Ok(());
            }
            let mut other = self.first[from];
            while (other as usize) < H {
                if self.ends(other as usize).1 == to {
                    return Err(MeshError::NonManifoldEdge { edge: [from as u16, to as u16] });
                }
                other = following[other as usize];
            }
            let mut back = self.first[to];
            while (back as usize) < H {
                if self.ends(back as usize).1 == from {
                    self.twins[half_edge] = back;
                    self.twins[back as usize] = half_edge as u16;
                }
                back = following[back as usize];
            }
            following[half_edge] = self.first[from];
            self.first[from] = half_edge as u16;
            half_edge += 1;
        }
        self.begin_at_borders();
        Ok(())
    }

    /// Rings of border vertices begin at the half-edge without a twin.
    const fn begin_at_borders(&mut self) {
        let mut half_edge = 0;
        while half_edge < self.faces.half_edges() && half_edge < H {
            let from = self.faces.origin(half_edge);
            if self.twins[half_edge] == NONE && from < V {
                self.first[from] = half_edge as u16;
            }
            half_edge += 1;
        }
    }

    const fn ends(&self, half_edge: usize) -> (usize, usize) {
        (self.faces.origin(half_edge), self.faces.origin(self.faces.next(half_edge)))
    }

    /// Each half-edge must be met on the way around its vertex, each vertex in one fan or cycle.
    const fn check_vertices(&self) -> Result<(), MeshError> {
        let mut leaving = [0_u16; V];
        let mut half_edge = 0;
        while half_edge < self.faces.half_edges() {
            let from = self.faces.origin(half_edge);
            if from < V {
                leaving[from] = leaving[from].saturating_add(1);
            }
            half_edge += 1;
        }
        let mut vertex = 0;
        while vertex < self.vertices && vertex < V {
            let (met, valence) = self.around(vertex);
            if met != leaving[vertex] as usize {
                return Err(MeshError::NonManifoldVertex { vertex });
            }
            if valence > MAX_VALENCE {
                return Err(MeshError::ValenceTooLarge { vertex, valence, limit: MAX_VALENCE });
            }
            vertex += 1;
        }
        Ok(())
    }

    /// How many faces and edges a walk around a vertex meets.
    const fn around(&self, vertex: usize) -> (usize, usize) {
        let (mut at, mut faces) = (self.first[vertex], 0);
        while (at as usize) < H && faces <= H {
            faces += 1;
            let previous = self.faces.previous(at as usize);
            at = if previous < H { self.twins[previous] } else { NONE };
            if at == self.first[vertex] {
                return (faces, faces);
            }
        }
        (faces, if faces == 0 { 0 } else { faces + 1 })
    }

    /// The faces.
    #[must_use]
    pub const fn faces(&self) -> Faces<'a> {
        self.faces
    }

    pub(super) const fn parts(&self) -> (usize, &[u16], &[u16]) {
        (self.vertices, &self.first, &self.twins)
    }
}

#[cfg(feature = "defmt")]
impl<const V: usize, const H: usize> defmt::Format for Links<'_, V, H> {
    fn format(&self, f: defmt::Formatter<'_>) {
        defmt::write!(f, "{} vertices, {}", self.vertices, self.faces);
    }
}
