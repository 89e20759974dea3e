//! B-spline and NURBS curves.

use super::insertion::{Source, Window};
use super::natural::Natural;
use super::{KnotVector, Pieces, Spline, SplineError, check_weights, scaled};
use crate::geometry::Point3;
use crate::num::I16F16;
use crate::patch::net::check_range_i16f16;
use crate::patch::{Curve, NetError, RationalCurve};

/// A B-spline curve of order `K`: control points and knots, borrowed. 20 to 40 bytes.
///
/// ```
/// use embedded_surfaces::{geometry::Point3, patch::{BSplineCurve, CubicCurve, KnotVector}};
/// let points = [[0, 0], [0, 60], [60, 60], [60, 0], [120, 0]].map(|[x, y]| Point3::from_ints(x, y, 0));
/// let curve = BSplineCurve::new(&points, KnotVector::<4>::clamped(5)?)?;
/// let halves: [CubicCurve; 2] = [curve.piece(0).unwrap(), curve.piece(1).unwrap()];
/// assert_eq!(Ok(halves[0]), CubicCurve::from_ints([[0, 0, 0], [0, 60, 0], [30, 60, 0], [45, 45, 0]]));
/// assert_eq!(halves[0].points()[3], halves[1].points()[0]);
/// assert_eq!(curve.pieces().count(), 2);
/// # Ok::<(), embedded_surfaces::patch::SplineError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct BSplineCurve<'a, const K: usize> {
    points: &'a [Point3],
    knots: KnotVector<'a, K>,
}

impl<'a, const K: usize> BSplineCurve<'a, K> {
    /// The curve with these control points and knots; also in constant context. For a closed one, repeat the first
    /// K − 1 points at the end.
    ///
    /// # Errors
    /// [`SplineError::Net`]: [`NetError::Count`] unless there is a point for each the knots need,
    /// [`NetError::OutOfRange`] for a coordinate outside ±32767.
    pub const fn new(points: &'a [Point3], knots: KnotVector<'a, K>) -> Result<Self, SplineError> {
        if points.len() != knots.points() {
            return Err(SplineError::Net(NetError::Count { expected: knots.points(), given: points.len() }));
        }
        match check_range_i16f16(points) {
            Ok(()) => Ok(Self { points, knots }),
            Err(error) => Err(SplineError::Net(error)),
        }
    }

    /// The control points.
    #[must_use]
    pub const fn points(&self) -> &'a [Point3] {
        self.points
    }

    /// The knots.
    #[must_use]
    pub const fn knots(&self) -> &KnotVector<'a, K> {
        &self.knots
    }

    /// The Bézier curve over the span of this number that is not empty; `None` from [`KnotVector::pieces`] on.
    ///
    /// Each control point is the exact one, a rational number, rounded once, half up: within 2^-17 along each axis,
    /// and so is the piece. Pieces share their common point bit by bit. Cost: at most (K − 1)³/3 multiplications of
    /// a long number by a word for each coordinate of a control point; 3.2 KB of stack for a cubic, 4.5 KB at most.
    #[must_use]
    pub fn piece(&self, index: usize) -> Option<Curve<K>> {
        let mut points = [Point3::ORIGIN; K];
        let out = points.iter_mut();
        fill(self, None, 0, index, out.map(|point| move |(p, _)| *point = p))?;
        Some(Curve { points })
    }

    /// All pieces, in order.
    #[must_use]
    pub fn pieces(&self) -> Pieces<Self> {
        Pieces::new(*self)
    }
}

/// Gives each Bézier point of a piece and its weight to its receiver.
fn fill<const K: usize>(
    spline: &BSplineCurve<'_, K>,
    weights: Option<&[I16F16]>,
    log2: u32,
    index: usize,
    receivers: impl Iterator<Item = impl FnOnce((Point3, I16F16))>,
) -> Option<()> {
    let span = spline.knots.span(index)?;
    let window = spline.knots.window(span);
    let source = Source { points: spline.points, weights, first: span + 1 - K, stride: 1 };
    let (mut columns, mut rows) = ([Natural::ZERO; K], [Natural::ZERO; 1]);
    for (k, receive) in receivers.enumerate() {
        let along = [window.insertion(k), Window::NONE.insertion(0)];
        receive(source.point(along, log2, &mut columns, &mut rows));
    }
    Some(())
}

impl<const K: usize> Spline for BSplineCurve<'_, K> {
    type Piece = Curve<K>;

    fn count(&self) -> usize {
        self.knots.pieces()
    }

    fn nth(&self, index: usize) -> Option<Curve<K>> {
        self.piece(index)
    }
}

/// A NURBS curve of order `K`: a B-spline curve and a positive weight for each control point, borrowed.
///
/// ```
/// use embedded_surfaces::{geometry::Point3, num::I16F16, patch::{BSplineCurve, KnotVector, NurbsCurve, Parameter}};
/// // A quarter of a circle of radius 90, with a knot at 1/2.
/// let points = [[90, 0, 0], [90, 45, 0], [30, 90, 0], [0, 90, 0]].map(|[x, y, z]| Point3::from_ints(x, y, z));
/// let weights = [1.0, 1.0, 1.5, 2.0].map(I16F16::from_num);
/// let arc = NurbsCurve::new(BSplineCurve::new(&points, KnotVector::<3>::clamped(4)?)?, &weights)?;
/// assert_eq!(arc.piece(1).unwrap().net().eval(Parameter::ZERO), Point3::from_ints(54, 72, 0)); // 54² + 72² = 90²
/// # Ok::<(), embedded_surfaces::patch::SplineError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NurbsCurve<'a, const K: usize> {
    spline: BSplineCurve<'a, K>,
    weights: &'a [I16F16],
    log2: u32,
}

impl<'a, const K: usize> NurbsCurve<'a, K> {
    /// The curve with these weights; also in constant context.
    ///
    /// # Errors
    /// [`SplineError::WeightCount`] unless there is a weight for each point, [`SplineError::Net`] with
    /// [`NetError::Weight`] for the first that is not positive.
    pub const fn new(spline: BSplineCurve<'a, K>, weights: &'a [I16F16]) -> Result<Self, SplineError> {
        match check_weights(spline.points.len(), weights) {
            Ok(()) => Ok(Self { spline, weights, log2: 0 }),
            Err(error) => Err(error),
        }
    }

    /// The same curve with the weights of its pieces times 2^`log2`, which round the finer. Pieces that are to share
    /// a border bit by bit need the same scale.
    ///
    /// # Errors
    /// [`SplineError::WeightScale`] for the first weight that reaches 32768.
    pub const fn scale_weights(self, log2: u32) -> Result<Self, SplineError> {
        match scaled(self.weights, log2) {
            Ok(()) => Ok(Self { log2, ..self }),
            Err(error) => Err(error),
        }
    }

    /// The curve of the same points without weights.
    #[must_use]
    pub const fn spline(&self) -> &BSplineCurve<'a, K> {
        &self.spline
    }

    /// The weights as given, all positive.
    #[must_use]
    pub const fn weights(&self) -> &'a [I16F16] {
        self.weights
    }

    /// The rational Bézier curve over the span of this number that is not empty; `None` from
    /// [`KnotVector::pieces`] on.
    ///
    /// Homogeneous points (w·P, w) are blossomed exactly; then each weight w and each coordinate of w·P / w is
    /// rounded once, half up. So control points are within 2^-17 along each axis, weights within 2^-17 (after
    /// scaling), and the piece within 2^-17·(1 + E/w) of the exact one along an axis along which its control points
    /// extend over E, w its least weight. Cost as for [`BSplineCurve::piece`], for four coordinates.
    #[must_use]
    pub fn piece(&self, index: usize) -> Option<RationalCurve<K>> {
        let (mut points, mut weights) = ([Point3::ORIGIN; K], [I16F16::ONE; K]);
        let out = points.iter_mut().zip(&mut weights);
        let receivers = out.map(|(point, weight)| move |(p, w)| (*point, *weight) = (p, w));
        fill(&self.spline, Some(self.weights), self.log2, index, receivers)?;
        RationalCurve::new(Curve { points }, weights).ok()
    }

    /// All pieces, in order.
    #[must_use]
    pub fn pieces(&self) -> Pieces<Self> {
        Pieces::new(*self)
    }
}

impl<const K: usize> Spline for NurbsCurve<'_, K> {
    type Piece = RationalCurve<K>;

    fn count(&self) -> usize {
        self.spline.knots.pieces()
    }

    fn nth(&self, index: usize) -> Option<RationalCurve<K>> {
        self.piece(index)
    }
}

#[cfg(feature = "defmt")]
impl<const K: usize> defmt::Format for NurbsCurve<'_, K> {
    fn format(&self, f: defmt::Formatter<'_>) {
        defmt::write!(f, "{}, scale 2^{}, weights ", self.spline, self.log2);
        super::format_bits(self.weights, f);
    }
}
