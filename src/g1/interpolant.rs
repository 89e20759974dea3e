//! The surface of a mesh, face by face.

use super::balance::View;
use super::fan::Fan;
use super::setting::Setting;
use super::shift::Shift;
use super::{Controls, G1Error, List, Options, Quality, Scheme};
use crate::geometry::Point3;
use crate::mesh::Mesh;
use crate::num::{Coord, I32F32};
use crate::patch::{QuinticTriangle, Triangle};

/// A surface over a mesh: quintic triangles, one a face, each made when it is asked for.
///
/// ```
/// use embedded_surfaces::g1::{Controls, Interpolant, Options, Shift};
/// use embedded_surfaces::{geometry::Point3, mesh::{Faces, Links, Mesh}, num::I16F16};
/// let points = [[80, 0, 0], [0, 80, 0], [0, 0, 80], [-80, 0, 0], [0, -80, 0], [0, 0, -80]];
/// let points = points.map(|[x, y, z]| Point3::from_ints(x, y, z));
/// let faces = [[0, 1, 2], [1, 3, 2], [3, 4, 2], [4, 0, 2], [1, 0, 5], [3, 1, 5], [4, 3, 5], [0, 4, 5]];
/// let links = Links::<6, 24>::new(6, Faces::Triangles(&faces))?;
/// let mesh = Mesh::<I16F16>::new(&points, &links)?;
///
/// let mut shifts = [Shift::NONE; 6];
/// let ball = Interpolant::new(&mesh, &Controls::default(), &Options::default(), &mut shifts)?;
/// let patch = ball.triangle(0)?; // for `tessellate`, scenes, plotters: patch.round()?
/// assert_eq!(patch.point(5, 0, 0), Some(&points[0].into()));
/// let middle = patch.net().eval(embedded_surfaces::patch::Barycentric::new(1, 1, 1)?);
/// assert!((middle.x.to_num::<f64>() * 3_f64.sqrt() - 80.0).abs() < 0.2); // almost a sphere
/// assert!(ball.quality()?.max_angle < 5 << 30); // 5·10^-9 rad
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Interpolant<'a, C = crate::num::I16F16> {
    setting: Setting<'a, C>,
    shifts: &'a [Shift],
}

impl<'a, C: Coord> Interpolant<'a, C> {
    /// The surface over a mesh. This is the first pass, which looks at all vertices and fills in `shifts`, a byte a vertex.
    ///
    /// Cost: the tangents of each vertex once, those of a vertex of even valence and its neighbours up to four times, and
    /// for each whose tangents move those of its neighbours' neighbours. About 12 KB of stack on a Cortex-M.
    ///
    /// # Errors
    /// [`G1Error`] for lists of a wrong length, tensions, tangents and twists that are not legal, faces with more than three
    /// corners, more than [`MAX_VALENCE`](super::MAX_VALENCE) edges at a vertex, fewer than three inside the mesh, a vertex
    /// without a normal, given tangents that fold over, coefficients that overflow.
    pub fn new(
        mesh: &Mesh<'a, C>,
        controls: &Controls<'a>,
        options: &Options,
        shifts: &'a mut [Shift],
    ) -> Result<Self, G1Error> {
        let (expected, given) = (mesh.points().len(), shifts.len());
        if expected != given {
            return Err(G1Error::Count { list: List::Shifts, expected, given });
        }
        let setting = Setting::new(mesh, controls, options)?;
        shifts.fill(Shift::NONE);
        if options.scheme != Scheme::Flat {
            let mut fan = Fan::blank();
            for vertex in 0..given {
                if mesh.leaving(vertex).is_some() {
                    setting.fan(vertex, Shift::NONE, &mut fan)?;
                }
            }
        }
        if options.scheme == Scheme::Smooth {
            setting.decide(shifts)?;
        }
        Ok(Self { setting, shifts })
    }

    fn view(&self) -> View<'_, 'a, C> {
        View { setting: &self.setting, shifts: self.shifts }
    }

    fn check(&self, face: usize) -> Result<(), G1Error> {
        let faces = self.setting.mesh.faces().len();
        if face < faces { Ok(()) } else { Err(G1Error::Face { face, faces }) }
    }

    /// The quintic triangle of a face, its corners in the order of the face's, rounded once, half up.
    ///
    /// Points shared with a neighbour are the same bits there. Cost: three systems of at most 16 rows and the tangents of
    /// their vertices' neighbours. About 18 KB of stack on a Cortex-M.
    ///
    /// # Errors
    /// [`G1Error::Face`], [`G1Error::VertexInconsistent`], [`G1Error::EdgeSingular`]; [`G1Error::Overflow`] where a control
    /// point leaves ±2^26; with [`Scheme::Literal`] [`G1Error::OppositeTangents`] and [`G1Error::EqualRatios`].
    pub fn triangle(&self, face: usize) -> Result<Triangle<5, 21, I32F32>, G1Error> {
        self.check(face)?;
        let points = self.view().face(face)?.points;
        let overflow = G1Error::Overflow { vertex: self.setting.corner(face) };
        let mut out = [Point3::new(I32F32::ZERO, I32F32::ZERO, I32F32::ZERO); 21];
        for (out, point) in out.iter_mut().zip(&points) {
            *out = self.setting.emit(point).ok_or(overflow)?;
        }
        Triangle::<5, 21, I32F32>::new(out).map_err(|_| overflow)
    }

    /// The same with coordinates in `I16F16`, half up: what scenes and the point engine take.
    ///
    /// # Errors
    /// Those of [`triangle`](Self::triangle); [`G1Error::Overflow`] where a control point leaves ±32767.
    pub fn rounded(&self, face: usize) -> Result<QuinticTriangle, G1Error> {
        let vertex = self.setting.corner(face);
        self.triangle(face)?.round().map_err(|_| G1Error::Overflow { vertex })
    }

    /// The triangles of all faces, in order.
    #[must_use]
    pub const fn triangles(&self) -> Triangles<'a, C> {
        Triangles { surface: Self { setting: self.setting, shifts: self.shifts }, face: 0 }
    }

    /// By what the tangents of each vertex were moved.
    #[must_use]
    pub const fn shifts(&self) -> &'a [Shift] {
        self.shifts
    }

    /// Whether a face folds: has a normal at more than a right angle to that of the PN triangle with the same tangents, at
    /// a point of a lattice of 28.
    ///
    /// # Errors
    /// Those of [`triangle`](Self::triangle).
    pub fn is_folded(&self, face: usize) -> Result<bool, G1Error> {
        self.check(face)?;
        self.view().is_folded(face)
    }

    /// How smooth the surface is and how far from the cubic one, over all faces and edges. Cost: about twice that of all
    /// triangles.
    ///
    /// # Errors
    /// Those of [`triangle`](Self::triangle) for the first face that has any.
    pub fn quality(&self) -> Result<Quality, G1Error> {
        self.view().quality()
    }
}

/// The triangles of a surface; see [`Interpolant::triangles`].
#[derive(Clone, Copy, Debug)]
pub struct Triangles<'a, C = crate::num::I16F16> {
    surface: Interpolant<'a, C>,
    face: usize,
}

impl<C: Coord> Iterator for Triangles<'_, C> {
    type Item = Result<Triangle<5, 21, I32F32>, G1Error>;

    fn next(&mut self) -> Option<Self::Item> {
        if self.face >= self.surface.setting.mesh.faces().len() {
            return None;
        }
        self.face += 1;
        Some(self.surface.triangle(self.face - 1))
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        let left = self.surface.setting.mesh.faces().len().saturating_sub(self.face);
        (left, Some(left))
    }
}

impl<C: Coord> ExactSizeIterator for Triangles<'_, C> {}
impl<C: Coord> core::iter::FusedIterator for Triangles<'_, C> {}

#[cfg(feature = "defmt")]
mod format {
    use super::{Coord, Interpolant, Triangles};

    impl<C: Coord> defmt::Format for Interpolant<'_, C> {
        fn format(&self, f: defmt::Formatter<'_>) {
            defmt::write!(f, "{}, {}", self.setting.mesh, self.setting.options);
        }
    }

    impl<C: Coord> defmt::Format for Triangles<'_, C> {
        fn format(&self, f: defmt::Formatter<'_>) {
            defmt::write!(f, "from face {} of {}", self.face, self.surface);
        }
    }
}
