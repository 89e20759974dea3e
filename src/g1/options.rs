//! What a caller chooses.

use crate::geometry::{Point3, Vector3};
use crate::num::{I16F16, I32F32};

/// How triangles are made of a mesh.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum Scheme {
    /// Quintic triangles with one tangent plane along every edge.
    #[default]
    Smooth,
    /// Cubic PN triangles (Vlachos, Peters, Boyd, Mitchell 2001), degree-elevated: cheap, continuous, smooth at the
    /// vertices only. Lengths of tangents, given tangents and twists are not used.
    PointNormal,
    /// The flat triangles of the mesh, degree-elevated.
    Flat,
    /// Jiang Shoushan's construction taken literally: ν = 1, twists that are means of their neighbours, explicit points of
    /// the edges. For comparison, on meshes in general position; symmetrical ones have no solution.
    Literal,
}

/// How long the tangents are that a caller does not give.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum Lengths {
    /// Those of circular arcs: 0.4·|d|²/(|d| + |p|) for an edge d and its projection p into the tangent plane.
    #[default]
    Arc,
    /// A fifth of the projected edge, or of 0.35·|d| if that is longer.
    Projected,
}

/// How a mesh is interpolated.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Options {
    /// How triangles are made.
    pub scheme: Scheme,
    /// How long tangents are.
    pub lengths: Lengths,
    /// Whether tangents must stay as they are. Then a vertex of even valence may have no solution.
    pub strict: bool,
    /// By how much the equations of a vertex may be missed, relative to the mean length of its tangents, before its
    /// tangents are moved; 2^-29, the default, to 1. More keeps nearly symmetrical meshes in shape and costs an angle
    /// of about this size, in radians, between their faces.
    pub tolerance: I32F32,
}

impl Options {
    /// The least tolerance, 2^-29.
    pub const LEAST_TOLERANCE: I32F32 = I32F32::from_bits(1 << 3);
}

impl Default for Options {
    fn default() -> Self {
        let (scheme, lengths) = (Scheme::Smooth, Lengths::Arc);
        Self { scheme, lengths, strict: false, tolerance: Self::LEAST_TOLERANCE }
    }
}

/// The tangent of an edge at one end: the second control point of the edge minus the first, b\[4,1,0\] − b\[5,0,0\].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Tangent {
    /// The vertex that it belongs to.
    pub from: u16,
    /// The other end of the edge.
    pub to: u16,
    /// The tangent; what is not in the tangent plane of the vertex is dropped.
    pub vector: Vector3<I32F32>,
}

/// Where a twist point, b\[3,1,1\] at a corner, should lie; it comes as close as smoothness lets it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Twist {
    /// The face.
    pub face: u16,
    /// Its corner, 0, 1 or 2.
    pub corner: u8,
    /// The place.
    pub point: Point3<I32F32>,
}

/// What else shapes the surface: all optional. Lists are searched from the front for each use.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Controls<'a> {
    /// A normal of any length for each vertex; without them they are estimated ([`Mesh::normal`]).
    ///
    /// [`Mesh::normal`]: crate::mesh::Mesh::normal
    pub normals: Option<&'a [Vector3<I32F32>]>,
    /// Tangents; others are chosen.
    pub tangents: &'a [Tangent],
    /// Where twist points should lie.
    pub twists: &'a [Twist],
    /// A tension for each vertex, −1 ..= 15/16: its tangents are shortened by this part. None for 0 everywhere.
    pub tension: Option<&'a [I16F16]>,
}

#[cfg(feature = "defmt")]
mod format {
    use super::{Controls, Options};

    impl defmt::Format for Options {
        fn format(&self, f: defmt::Formatter<'_>) {
            let tolerance = self.tolerance.to_bits();
            defmt::write!(f, "{}, {}, strict: {}, {}/2^32", self.scheme, self.lengths, self.strict, tolerance);
        }
    }

    impl defmt::Format for Controls<'_> {
        fn format(&self, f: defmt::Formatter<'_>) {
            let (normals, tension) = (self.normals.is_some(), self.tension.is_some());
            let (tangents, twists) = (self.tangents.len(), self.twists.len());
            defmt::write!(f, "normals: {}, {} tangents, {} twists, tension: {}", normals, tangents, twists, tension);
        }
    }
}
