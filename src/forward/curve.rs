//! Lattices of curves, and unit steps for plotters.

use super::engine::{Engine, walk};
use super::form::Form;
use super::lattice::LatticePoint;
use super::{Budget, LatticeError};
use crate::patch::{CurveNet, RationalCurveNet};

/// A point of a curve's lattice: the index and exactly rounded coordinates.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct CurvePoint {
    /// The index, 0 ..= n; the parameter is i/n.
    pub i: u32,
    /// floor(x + 1/2).
    pub x: i32,
    /// floor(y + 1/2).
    pub y: i32,
    /// floor(z + 1/2).
    pub z: i32,
}

impl CurvePoint {
    fn of(p: LatticePoint) -> Self {
        Self { i: p.i, x: p.x, y: p.y, z: p.z }
    }
}

/// A step from a point to the next: −1, 0 or +1 per axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct UnitStep {
    /// Along x.
    pub x: i8,
    /// Along y.
    pub y: i8,
    /// Along z.
    pub z: i8,
}

/// The plan of a curve's lattice at i/n, i = 0 ..= n: checked once, cheap to copy.
///
/// ```
/// use embedded_surfaces::forward::{CurveLattice, Steps};
/// use embedded_surfaces::patch::CubicCurve;
/// let curve = CubicCurve::from_ints([[0, 0, 0], [0, 55, 0], [45, 100, 0], [100, 100, 0]])?;
/// let lattice = CurveLattice::new(curve.net(), Steps::curve(curve.net()))?;
/// let (mut x, mut y) = (0, 0);
/// for step in lattice.unit_steps()? {
///     x += i32::from(step.x);
///     y += i32::from(step.y);
/// }
/// assert_eq!((x, y), (100, 100));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct CurveLattice<'a> {
    form: Form<'a>,
    budget: Budget,
}

/// The points of a [`CurveLattice`].
#[derive(Clone, Debug)]
pub struct CurvePoints(Engine);

/// The unit steps between the points of a [`CurveLattice`].
#[derive(Clone, Debug)]
pub struct UnitSteps {
    points: CurvePoints,
    last: Option<CurvePoint>,
}

impl<'a> CurveLattice<'a> {
    /// Plans the lattice of `net` at `n` steps.
    ///
    /// # Errors
    /// [`LatticeError::Steps`] unless n is in 1 ..= 2^24, [`LatticeError::Budget`] where (2K+1)·N needs more than 128
    /// bits.
    pub fn new(net: CurveNet<'a>, n: u32) -> Result<Self, LatticeError> {
        let form = Form::curve(net, n);
        Ok(Self { form, budget: Budget::of(&form)? })
    }

    /// Plans the lattice of a rational curve, by the incremental quotient.
    ///
    /// # Errors
    /// As for [`new`](Self::new), with N times the largest weight.
    pub fn rational(net: RationalCurveNet<'a>, n: u32) -> Result<Self, LatticeError> {
        let form = Form::rational_curve(net, n);
        Ok(Self { form, budget: Budget::of(&form)? })
    }

    /// The bit budget: accumulator, scale, used fraction bits, largest step.
    #[must_use]
    pub fn budget(&self) -> &Budget {
        &self.budget
    }

    /// Calls `f` with every point in order: the fast path, 3·m additions a point.
    #[inline]
    pub fn for_each(&self, mut f: impl FnMut(CurvePoint)) {
        walk(&self.form, &self.budget, |p| f(CurvePoint::of(p)));
    }

    /// The points as an iterator, in order.
    #[must_use]
    pub fn points(&self) -> CurvePoints {
        CurvePoints(Engine::new(&self.form, &self.budget))
    }

    /// The steps between the points, n of them, for step/dir drivers.
    ///
    /// # Errors
    /// [`LatticeError::LongStep`] where the net's bound allows a step of more than one unit; it names a count that
    /// does not. [`Steps::curve`](super::Steps::curve) never fails here.
    pub fn unit_steps(&self) -> Result<UnitSteps, LatticeError> {
        let units = self.budget.largest_step;
        if units > 1 {
            let n = self.form.steps.0.saturating_mul(units);
            return Err(LatticeError::LongStep { units, needed: (n, 1) });
        }
        let mut points = self.points();
        let last = points.next();
        Ok(UnitSteps { points, last })
    }
}

impl IntoIterator for &CurveLattice<'_> {
    type Item = CurvePoint;
    type IntoIter = CurvePoints;

    fn into_iter(self) -> CurvePoints {
        self.points()
    }
}

impl Iterator for CurvePoints {
    type Item = CurvePoint;

    fn next(&mut self) -> Option<CurvePoint> {
        self.0.next_point().map(CurvePoint::of)
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        let left = usize::try_from(self.0.remaining());
        (left.unwrap_or(usize::MAX), left.ok())
    }

    fn fold<B, F: FnMut(B, CurvePoint) -> B>(self, init: B, mut f: F) -> B {
        self.0.fold(init, |state, p| f(state, CurvePoint::of(p)))
    }
}

impl core::iter::FusedIterator for CurvePoints {}

impl Iterator for UnitSteps {
    type Item = UnitStep;

    fn next(&mut self) -> Option<UnitStep> {
        let p = self.points.next()?;
        let q = self.last.replace(p)?;
        Some(UnitStep { x: (p.x - q.x) as i8, y: (p.y - q.y) as i8, z: (p.z - q.z) as i8 })
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        self.points.size_hint()
    }
}

impl core::iter::FusedIterator for UnitSteps {}

#[cfg(feature = "defmt")]
mod format {
    use super::{CurveLattice, CurvePoints, UnitSteps};
    use defmt::{Format, Formatter};

    impl Format for CurveLattice<'_> {
        fn format(&self, f: Formatter<'_>) {
            let (form, budget) = (&self.form, &self.budget);
            defmt::write!(f, "curve lattice of degree {} at {} steps, {}", form.degrees.0, form.steps.0, budget);
        }
    }

    impl Format for CurvePoints {
        fn format(&self, f: Formatter<'_>) {
            defmt::write!(f, "{} curve points left", self.0.remaining());
        }
    }

    impl Format for UnitSteps {
        fn format(&self, f: Formatter<'_>) {
            defmt::write!(f, "{} unit steps left, after {}", self.points.0.remaining(), self.last);
        }
    }
}
