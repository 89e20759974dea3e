//! B-spline and NURBS surfaces: tensor products.

use super::insertion::Source;
use super::natural::Natural;
use super::{KnotVector, Pieces, Spline, SplineError, check_weights, scaled};
use crate::geometry::Point3;
use crate::num::I16F16;
use crate::patch::net::check_range_i16f16;
use crate::patch::{NetError, RationalTensor, Tensor};

/// A B-spline surface of orders `M` × `H`: control points, the second index running fastest, and knots along r and
/// along s, borrowed. 36 to 64 bytes.
///
/// ```
/// use embedded_surfaces::{geometry::Point3, patch::{BSplineSurface, KnotVector, Parameter}};
/// // A roof over 4 × 3 points: quadratic along r, straight along s.
/// let points: [Point3; 12] = core::array::from_fn(|n| {
///     let (i, j) = ((n / 3) as i16, (n % 3) as i16);
///     Point3::from_ints(20 * i, 30 * j, if i == 1 || i == 2 { 16 } else { 0 })
/// });
/// let roof = BSplineSurface::new(&points, KnotVector::<3>::uniform(4)?, KnotVector::<2>::uniform(3)?)?;
/// assert_eq!(roof.pieces().count(), 4);
/// let patch = roof.piece(0, 1).unwrap();
/// assert_eq!(patch.net().eval(Parameter::ONE, Parameter::ZERO), Point3::from_ints(30, 30, 16));
/// assert_eq!(roof.piece(2, 0), None);
/// # Ok::<(), embedded_surfaces::patch::SplineError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct BSplineSurface<'a, const M: usize, const H: usize> {
    points: &'a [Point3],
    along_r: KnotVector<'a, M>,
    along_s: KnotVector<'a, H>,
}

impl<'a, const M: usize, const H: usize> BSplineSurface<'a, M, H> {
    /// The surface with these control points, point (i, j) at index i · `along_s.points()` + j; also in constant
    /// context.
    ///
    /// # Errors
    /// [`SplineError::Net`]: [`NetError::Count`] unless there is a point for each the knots need,
    /// [`NetError::OutOfRange`] for a coordinate outside ±32767.
    pub const fn new(
        points: &'a [Point3],
        along_r: KnotVector<'a, M>,
        along_s: KnotVector<'a, H>,
    ) -> Result<Self, SplineError> {
        let expected = along_r.points().saturating_mul(along_s.points());
        if points.len() != expected {
            return Err(SplineError::Net(NetError::Count { expected, given: points.len() }));
        }
        match check_range_i16f16(points) {
            Ok(()) => Ok(Self { points, along_r, along_s }),
            Err(error) => Err(SplineError::Net(error)),
        }
    }

    /// The control points, the second index running fastest.
    #[must_use]
    pub const fn points(&self) -> &'a [Point3] {
        self.points
    }

    /// The knots along r and along s.
    #[must_use]
    pub const fn knots(&self) -> (&KnotVector<'a, M>, &KnotVector<'a, H>) {
        (&self.along_r, &self.along_s)
    }

    /// The Bézier patch over span i along r and span j along s, counting spans that are not empty; `None` from the
    /// number of pieces on.
    ///
    /// Each control point is the exact one, a rational number, rounded once, half up: within 2^-17 along each axis,
    /// and so is the piece. Neighbours share their border bit by bit. Cost: M + 1 times that of a curve for each
    /// control point; 4.2 KB of stack for a bicubic, 7.3 KB at most.
    #[must_use]
    pub fn piece(&self, i: usize, j: usize) -> Option<Tensor<M, H>> {
        let mut points = [[Point3::ORIGIN; H]; M];
        let out = points.as_flattened_mut().iter_mut();
        fill(self, None, 0, (i, j), out.map(|point| move |(p, _)| *point = p))?;
        Some(Tensor { points })
    }

    /// All pieces, those of a row along s together.
    #[must_use]
    pub fn pieces(&self) -> Pieces<Self> {
        Pieces::new(*self)
    }

    fn count(&self) -> usize {
        self.along_r.pieces().saturating_mul(self.along_s.pieces())
    }

    /// (i, j) of the piece of this number.
    fn split(&self, index: usize) -> Option<(usize, usize)> {
        let across = self.along_s.pieces();
        Some((index.checked_div(across)?, index.checked_rem(across)?))
    }
}

/// Gives each Bézier point of a piece and its weight to its receiver.
fn fill<const M: usize, const H: usize>(
    spline: &BSplineSurface<'_, M, H>,
    weights: Option<&[I16F16]>,
    log2: u32,
    (i, j): (usize, usize),
    receivers: impl Iterator<Item = impl FnOnce((Point3, I16F16))>,
) -> Option<()> {
    let (r, s) = (spline.along_r.span(i)?, spline.along_s.span(j)?);
    let (window_r, window_s) = (spline.along_r.window(r), spline.along_s.window(s));
    let stride = spline.along_s.points();
    let source = Source { points: spline.points, weights, first: (r + 1 - M) * stride + (s + 1 - H), stride };
    let (mut columns, mut rows) = ([Natural::ZERO; M], [Natural::ZERO; H]);
    for (index, receive) in receivers.enumerate() {
        let along = [window_r.insertion(index / H), window_s.insertion(index % H)];
        receive(source.point(along, log2, &mut columns, &mut rows));
    }
    Some(())
}

impl<const M: usize, const H: usize> Spline for BSplineSurface<'_, M, H> {
    type Piece = Tensor<M, H>;

    fn count(&self) -> usize {
        self.count()
    }

    fn nth(&self, index: usize) -> Option<Tensor<M, H>> {
        let (i, j) = self.split(index)?;
        self.piece(i, j)
    }
}

/// A NURBS surface of orders `M` × `H`: a B-spline surface and a positive weight for each control point, borrowed.
///
/// ```
/// use embedded_surfaces::{geometry::Point3, num::I16F16};
/// use embedded_surfaces::patch::{BSplineSurface, KnotVector, NurbsSurface, Parameter};
/// // A quarter of a cylinder of radius 100.
/// let points = [[100, 0, 0], [100, 0, 40], [100, 100, 0], [100, 100, 40], [0, 100, 0], [0, 100, 40]];
/// let points = points.map(|[x, y, z]| Point3::from_ints(x, y, z));
/// let weights = [1, 1, 1, 1, 2, 2].map(I16F16::from_num);
/// let wall = BSplineSurface::new(&points, KnotVector::<3>::clamped(3)?, KnotVector::<2>::clamped(2)?)?;
/// let wall = NurbsSurface::new(wall, &weights)?.piece(0, 0).unwrap();
/// assert_eq!(wall.net().eval(Parameter::HALF, Parameter::HALF), Point3::from_ints(60, 80, 20));
/// # Ok::<(), embedded_surfaces::patch::SplineError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NurbsSurface<'a, const M: usize, const H: usize> {
    spline: BSplineSurface<'a, M, H>,
    weights: &'a [I16F16],
    log2: u32,
}

impl<'a, const M: usize, const H: usize> NurbsSurface<'a, M, H> {
    /// The surface with these weights, in the order of the points; also in constant context.
    ///
    /// # Errors
    /// [`SplineError::WeightCount`] unless there is a weight for each point, [`SplineError::Net`] with
    /// [`NetError::Weight`] for the first that is not positive.
    pub const fn new(spline: BSplineSurface<'a, M, H>, weights: &'a [I16F16]) -> Result<Self, SplineError> {
        match check_weights(spline.points.len(), weights) {
            Ok(()) => Ok(Self { spline, weights, log2: 0 }),
            Err(error) => Err(error),
        }
    }

    /// The same surface with the weights of its pieces times 2^`log2`, which round the finer. Surfaces that are to
    /// share a border bit by bit need the same scale.
    ///
    /// # Errors
    /// [`SplineError::WeightScale`] for the first weight that reaches 32768.
    pub const fn scale_weights(self, log2: u32) -> Result<Self, SplineError> {
        match scaled(self.weights, log2) {
            Ok(()) => Ok(Self { log2, ..self }),
            Err(error) => Err(error),
        }
    }

    /// The surface of the same points without weights.
    #[must_use]
    pub const fn spline(&self) -> &BSplineSurface<'a, M, H> {
        &self.spline
    }

    /// The weights as given, all positive.
    #[must_use]
    pub const fn weights(&self) -> &'a [I16F16] {
        self.weights
    }

    /// The rational Bézier patch over span i along r and span j along s, counting spans that are not empty; `None`
    /// from the number of pieces on.
    ///
    /// Roundings and bound as for [`NurbsCurve::piece`](super::NurbsCurve::piece), cost as for
    /// [`BSplineSurface::piece`] with four coordinates.
    #[must_use]
    pub fn piece(&self, i: usize, j: usize) -> Option<RationalTensor<M, H>> {
        let (mut points, mut weights) = ([[Point3::ORIGIN; H]; M], [[I16F16::ONE; H]; M]);
        let out = points.as_flattened_mut().iter_mut().zip(weights.as_flattened_mut());
        let receivers = out.map(|(point, weight)| move |(p, w)| (*point, *weight) = (p, w));
        fill(&self.spline, Some(self.weights), self.log2, (i, j), receivers)?;
        RationalTensor::new(Tensor { points }, weights).ok()
    }

    /// All pieces, those of a row along s together.
    #[must_use]
    pub fn pieces(&self) -> Pieces<Self> {
        Pieces::new(*self)
    }
}

impl<const M: usize, const H: usize> Spline for NurbsSurface<'_, M, H> {
    type Piece = RationalTensor<M, H>;

    fn count(&self) -> usize {
        self.spline.count()
    }

    fn nth(&self, index: usize) -> Option<RationalTensor<M, H>> {
        let (i, j) = self.spline.split(index)?;
        self.piece(i, j)
    }
}

#[cfg(feature = "defmt")]
impl<const M: usize, const H: usize> defmt::Format for NurbsSurface<'_, M, H> {
    fn format(&self, f: defmt::Formatter<'_>) {
        defmt::write!(f, "{}, scale 2^{}, weights ", self.spline, self.log2);
        super::format_bits(self.weights, f);
    }
}
