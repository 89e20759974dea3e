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
///
/// ```
/// use embedded_surfaces::g1::{Options, Scheme};
/// let baseline = Options { scheme: Scheme::PointNormal, ..Options::default() };
/// assert!(!baseline.strict && baseline.tolerance == Options::LEAST_TOLERANCE);
/// ```
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
///
/// ```
/// use embedded_surfaces::g1::{Controls, Interpolant, Options, Shift, Tangent};
/// use embedded_surfaces::geometry::{Point3, Vector3};
/// use embedded_surfaces::mesh::{Faces, Links, Mesh};
/// use embedded_surfaces::num::{I16F16, I32F32};
/// let points = [[0, 0, 0], [90, 0, 9], [90, 90, 0], [0, 90, 9]].map(|[x, y, z]| Point3::from_ints(x, y, z));
/// let links = Links::<4, 6>::new(4, Faces::Triangles(&[[0, 1, 2], [0, 2, 3]]))?;
/// let mesh = Mesh::<I16F16>::new(&points, &links)?;
/// let up = [Vector3::new(I32F32::ZERO, I32F32::ZERO, I32F32::ONE); 4];
/// let along = Vector3::new(I32F32::from_num(30), I32F32::ZERO, I32F32::ZERO);
/// let tangents = [Tangent { from: 0, to: 1, vector: along }];
/// let controls = Controls { normals: Some(&up), tangents: &tangents, ..Controls::default() };
/// let mut shifts = [Shift::NONE; 4];
/// let sail = Interpolant::new(&mesh, &controls, &Options::default(), &mut shifts)?;
/// let second = *sail.triangle(0)?.point(4, 1, 0).ok_or("it has 21 points")?;
/// assert_eq!(second, Point3::from_ints(30, 0, 0).into());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
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
