//! Polygon meshes with half-edges, checked once.
//!
//! In come points and faces, lists of vertices counter-clockwise as seen from outside; out goes a [`Mesh`] that is known
//! to be manifold and oriented, without degenerate face or edge of length 0, and answers what is next to what. Points and
//! faces are borrowed and may lie in flash; so may the [`Links`], which a `const fn` makes.
//!
//! | is asked | cost |
//! |---|---|
//! | next and previous half-edge, face | a division by 3 or 4; a search by halving for [`Faces::Polygons`] |
//! | twin, a half-edge of a vertex | a look into a table |
//! | the ring of a vertex, [`Mesh::spokes`] | a twin and a previous half-edge a spoke |
//!
//! A half-edge stands for the corner that it leaves: number h is the h-th corner of all faces, in order.

mod error;
mod faces;
mod links;
mod normal;
mod spokes;

pub use error::MeshError;
pub use faces::Faces;
pub use links::{Links, MAX_VALENCE};
pub use spokes::{Spoke, Spokes};

pub(crate) use normal::angle_between;

use crate::geometry::{Axis, Point3};
use crate::num::{Coord, I16F16, I32F32, bits_i16f16, bits_i32f32};
use links::NONE;

/// Evaluates a fallible constructor of links or meshes at compile time: the value, or a compile error.
#[macro_export]
macro_rules! const_mesh {
    ($constructor:expr) => {
        const {
            match $constructor {
                Ok(mesh) => mesh,
                Err(_) => ::core::panic!("the mesh is not legal"),
            }
        }
    };
}

/// One side of an edge: it runs along one face, from one corner to the next.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct HalfEdge(u16);

/// A mesh that was checked: points, faces and how they meet, all borrowed.
///
/// ```
/// use embedded_surfaces::{geometry::Point3, mesh::{Faces, Links, Mesh, MeshError}, num::I16F16};
/// let points = [[0, 0], [9, 0], [9, 9], [0, 9]].map(|[x, y]| Point3::from_ints(x, y, 0));
/// let links = Links::<4, 6>::new(4, Faces::Triangles(&[[0, 1, 2], [0, 2, 3]]))?;
/// let mesh = Mesh::<I16F16>::new(&points, &links)?;
/// assert!(mesh.is_border(0));
/// let neighbours: Vec<_> = mesh.spokes(0).map(|spoke| spoke.to).collect();
/// assert_eq!(neighbours, [1, 2, 3]);
///
/// let wrong = Links::<4, 6>::new(4, Faces::Triangles(&[[0, 1, 2], [0, 1, 3]]));
/// assert_eq!(wrong, Err(MeshError::NonManifoldEdge { edge: [0, 1] }));
/// # Ok::<(), MeshError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Mesh<'a, C = I16F16> {
    points: &'a [Point3<C>],
    faces: Faces<'a>,
    first: &'a [u16],
    twins: &'a [u16],
}

macro_rules! constructors {
    ($coord:ty, $bits:ident) => {
        impl<'a> Mesh<'a, $coord> {
            /// The mesh of these points; also in constant context.
            ///
            /// # Errors
            /// [`MeshError::Count`] for another number of points than the links are for, [`MeshError::OutOfRange`] for a
            /// coordinate outside the legal range of its type, [`MeshError::ZeroEdge`] for neighbours at the same place.
            pub const fn new<const V: usize, const H: usize>(
                points: &'a [Point3<$coord>],
                links: &'a Links<'a, V, H>,
            ) -> Result<Self, MeshError> {
                let (vertices, first, twins) = links.parts();
                if points.len() != vertices {
                    return Err(MeshError::Count { expected: vertices, given: points.len() });
                }
                let mut vertex = 0;
                while vertex < points.len() {
                    let p = &points[vertex];
                    let coordinates = [(Axis::X, $bits(p.x)), (Axis::Y, $bits(p.y)), (Axis::Z, $bits(p.z))];
                    let mut c = 0;
                    while c < 3 {
                        let (axis, bits) = coordinates[c];
                        let units = bits >> <$coord as Coord>::FRACTION_BITS;
                        let limit = <$coord as Coord>::LIMIT;
                        if bits.unsigned_abs() > (limit as u64) << <$coord as Coord>::FRACTION_BITS {
                            return Err(MeshError::OutOfRange { vertex, axis, units, limit });
                        }
                        c += 1;
                    }
                    vertex += 1;
                }
                let faces = links.faces();
                let mut half_edge = 0;
                while half_edge < faces.half_edges() {
                    let (from, to) = (faces.origin(half_edge), faces.origin(faces.next(half_edge)));
                    if from < points.len() && to < points.len() {
                        let (p, q) = (&points[from], &points[to]);
                        if $bits(p.x) == $bits(q.x) && $bits(p.y) == $bits(q.y) && $bits(p.z) == $bits(q.z) {
                            return Err(MeshError::ZeroEdge { edge: [from as u16, to as u16] });
                        }
                    }
                    half_edge += 1;
                }
                Ok(Self { points, faces, first, twins })
            }
        }
    };
}

constructors!(I16F16, bits_i16f16);
constructors!(I32F32, bits_i32f32);

impl<'a, C: Coord> Mesh<'a, C> {
    /// The points of the vertices.
    #[must_use]
    pub const fn points(&self) -> &'a [Point3<C>] {
        self.points
    }

    /// The faces.
    #[must_use]
    pub const fn faces(&self) -> Faces<'a> {
        self.faces
    }

    /// The number of half-edges.
    #[must_use]
    pub const fn half_edges(&self) -> usize {
        self.faces.half_edges()
    }

    /// The vertex that a half-edge leaves; 0 for a half-edge that does not exist.
    #[must_use]
    pub const fn origin(&self, half_edge: HalfEdge) -> usize {
        self.faces.origin(half_edge.index())
    }

    /// The vertex that a half-edge leads to.
    #[must_use]
    pub const fn tip(&self, half_edge: HalfEdge) -> usize {
        self.faces.origin(self.faces.next(half_edge.index()))
    }

    /// The face that a half-edge bounds: to its left.
    #[must_use]
    pub const fn face(&self, half_edge: HalfEdge) -> usize {
        self.faces.face(half_edge.index())
    }

    /// The half-edge that follows around the face.
    #[must_use]
    pub const fn next(&self, half_edge: HalfEdge) -> HalfEdge {
        HalfEdge(self.faces.next(half_edge.index()) as u16)
    }

    /// The half-edge that comes before around the face.
    #[must_use]
    pub const fn previous(&self, half_edge: HalfEdge) -> HalfEdge {
        HalfEdge(self.faces.previous(half_edge.index()) as u16)
    }

    /// The half-edge along the same edge in the other direction; `None` on a border.
    #[must_use]
    pub fn twin(&self, half_edge: HalfEdge) -> Option<HalfEdge> {
        self.twins.get(half_edge.index()).filter(|twin| **twin != NONE).map(|twin| HalfEdge(*twin))
    }

    /// A half-edge that leaves the vertex, the one with nothing to its right if the vertex is on a border; `None` for a
    /// vertex without a face.
    #[must_use]
    pub fn leaving(&self, vertex: usize) -> Option<HalfEdge> {
        self.first.get(vertex).filter(|first| **first != NONE).map(|first| HalfEdge(*first))
    }

    /// Whether a vertex is on a border. One without a face is not.
    #[must_use]
    pub fn is_border(&self, vertex: usize) -> bool {
        self.leaving(vertex).is_some_and(|first| self.twin(first).is_none())
    }

    /// The number of edges of a vertex.
    #[must_use]
    pub fn valence(&self, vertex: usize) -> usize {
        self.spokes(vertex).count()
    }

    /// The edges of a vertex, counter-clockwise as seen from outside, from border to border if it is on one.
    #[must_use]
    pub fn spokes(&self, vertex: usize) -> Spokes<'a, C> {
        Spokes::new(*self, vertex)
    }

    /// The raw bits of a vertex in 2^-32, zero for one that does not exist.
    pub(crate) fn bits(&self, vertex: usize) -> [i64; 3] {
        let scaled = |c: C| c.bits() << (32 - C::FRACTION_BITS);
        self.points.get(vertex).map_or([0; 3], |p| p.to_array().map(scaled))
    }
}

#[cfg(feature = "defmt")]
impl<C: Coord> defmt::Format for Mesh<'_, C> {
    fn format(&self, f: defmt::Formatter<'_>) {
        defmt::write!(f, "{} vertices, {}", self.points.len(), self.faces);
    }
}
