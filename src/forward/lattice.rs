//! Lattices of surfaces.

use super::checksum::checksum;
use super::engine::{Engine, walk, walk_unordered};
use super::form::Form;
use super::{Budget, LatticeError, Steps};
use crate::patch::SurfaceNet;

/// A point of a lattice: indices and exactly rounded coordinates.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct LatticePoint {
    /// The index in the first direction, 0 ..= n_r; the parameter is i/n_r.
    pub i: u32,
    /// The index in the second direction, 0 ..= n_s; the parameter is j/n_s.
    pub j: u32,
    /// floor(x + 1/2).
    pub x: i32,
    /// floor(y + 1/2).
    pub y: i32,
    /// floor(z + 1/2).
    pub z: i32,
}

/// A step between neighbours in a row: −1, 0 or +1 per axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum RowStep {
    /// A row begins at this point: move here with the pen up.
    Start(LatticePoint),
    /// The next point of the row is this far away, x first.
    Step([i8; 3]),
}

/// The plan of a surface's lattice: checked once, cheap to copy (it borrows the net), walked as often as needed.
///
/// Points come in row order: j outer 0 ..= n_s, i inner 0 ..= n_r; for a triangle u = i/n, v = j/n and i + j ≤ n.
/// Every coordinate is `floor(S + 1/2)` of the exact surface.
///
/// * [`for_each`](Self::for_each): internal iteration, the fast path. Set-up about 3(m+1)(h+1)(m+h) operations, then
///   3·m additions a point (m: degree in the first direction).
/// * [`for_each_unordered`](Self::for_each_unordered): the same points in an order that is left open.
/// * [`points`](Self::points): an iterator in row order; `fold` and `for_each` on it go by runs of points too.
///
/// State of a walk, on the stack (computed; what the compiler spills comes on top): 3·(d+1)²·w/8 bytes plus
/// 6·(d+1)·w/8, with d the larger degree rounded up to 3, 5 or 8 and w the accumulator's bits, so 0.6 KB for bicubics
/// in `i64` and 4.8 KB at most; a third more for rational nets. The points of a run come on top: 0.6 KB on 32-bit cores,
/// 1 KB for cubics in `i32` on ARMv7-M, 0.8 KB for the lanes of 64-bit hosts. Sub-lattices take 1 KB
/// ([`for_each_unordered`](Self::for_each_unordered)), on ARMv6-M 3 KB, in row order 2.5 KB.
///
/// ```
/// use embedded_surfaces::forward::{Lattice, Steps};
/// use embedded_surfaces::patch::{BicubicPatch, Surface};
/// let flat = BicubicPatch::from_ints([
///     [[0, 0, 0], [0, 10, 0], [0, 20, 0], [0, 30, 0]],
///     [[10, 0, 0], [10, 10, 0], [10, 20, 0], [10, 30, 0]],
///     [[20, 0, 0], [20, 10, 0], [20, 20, 0], [20, 30, 0]],
///     [[30, 0, 0], [30, 10, 0], [30, 20, 0], [30, 30, 0]],
/// ])?;
/// let lattice = Lattice::new(flat.surface(), Steps::uniform(30)?)?;
/// lattice.for_each(|p| assert_eq!((p.x, p.y, p.z), (p.i as i32, p.j as i32, 0)));
/// assert_eq!(lattice.points().count(), 31 * 31);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Lattice<'a> {
    form: Form<'a>,
    budget: Budget,
}

/// The points of a [`Lattice`], in row order.
#[derive(Clone, Debug)]
pub struct LatticePoints(Engine);

impl<'a> Lattice<'a> {
    /// Plans the lattice of `net` at `steps`.
    ///
    /// # Errors
    /// [`LatticeError::Steps`] for a triangle with different counts, [`LatticeError::Budget`] where (2K+1)·N needs
    /// more than 128 bits; it names degrees, steps and bits.
    pub fn new(net: SurfaceNet<'a>, steps: Steps) -> Result<Self, LatticeError> {
        let form = Form::surface(net, (steps.r(), steps.s()));
        Ok(Self { form, budget: Budget::of(&form)? })
    }

    /// Plans the lattice of the cells' centres, ((i + 1/2)/n_r, (j + 1/2)/n_s): i < n_r and j < n_s, or i + j < n for
    /// a triangle, whose outermost centres lie on its third side. See [`Sampling`](super::Sampling).
    ///
    /// # Errors
    /// As for [`new`](Self::new); the scale is that of twice as many steps.
    pub fn centres(net: SurfaceNet<'a>, steps: Steps) -> Result<Self, LatticeError> {
        let form = Form::surface(net, (steps.r(), steps.s())).centres();
        Ok(Self { form, budget: Budget::of(&form)? })
    }

    /// The step counts.
    #[must_use]
    pub fn steps(&self) -> (u32, u32) {
        self.form.steps
    }

    /// The bit budget: accumulator, scale, used fraction bits, largest step.
    #[must_use]
    pub fn budget(&self) -> &Budget {
        &self.budget
    }

    /// What is walked, for what walks it by itself.
    #[cfg(forward_asm = "v7m")]
    pub(super) fn plan(&self) -> (&Form<'a>, &Budget) {
        (&self.form, &self.budget)
    }

    /// The number of points: (n_r+1)(n_s+1), or (n+1)(n+2)/2 for a triangle.
    #[must_use]
    pub fn point_count(&self) -> u64 {
        self.form.point_count()
    }

    /// Calls `f` with every point in row order: the fast path.
    ///
    /// With the feature `asm` runs of points are made by assembly on ARMv6-M, where N is a power of two, the degree at most
    /// 3 and two sub-lattices a row take 32 bits ([`for_each_unordered`](Self::for_each_unordered)).
    #[inline]
    pub fn for_each(&self, f: impl FnMut(LatticePoint)) {
        walk(&self.form, &self.budget, f);
    }

    /// Calls `f` with every point once, in an order that is left open: for depth buffers, sums and other sinks that do
    /// not ask for neighbours in turn.
    ///
    /// Where the step counts and the net allow it the lattice is walked in up to 16 sub-lattices in 32-bit arithmetic: a
    /// polynomial surface of degree at most 3, N = 2^f (step counts that are powers of two) and at most 2 bits of f and
    /// the coordinates more than 32. So it is for a cubic triangle of 256 steps with whole coordinates. All others are
    /// walked as by [`for_each`](Self::for_each). The points are the same.
    ///
    /// ```
    /// use embedded_surfaces::forward::{Lattice, Steps};
    /// use embedded_surfaces::patch::{BilinearPatch, Surface};
    /// let patch = BilinearPatch::from_ints([[[0, 0, 5], [0, 64, 9]], [[64, 0, 7], [64, 64, 1]]])?;
    /// let lattice = Lattice::new(patch.surface(), Steps::uniform(64)?)?;
    /// let mut seen = [[false; 65]; 65];
    /// lattice.for_each_unordered(|p| seen[p.y as usize][p.x as usize] = true);
    /// assert!(seen.iter().flatten().all(|seen| *seen));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[inline]
    pub fn for_each_unordered(&self, f: impl FnMut(LatticePoint)) {
        walk_unordered(&self.form, &self.budget, f);
    }

    /// The wrapping sum of all coordinates of all points: what a self-test on a board compares with what a host says.
    ///
    /// By [`for_each_unordered`](Self::for_each_unordered); with the feature `asm` by rows in assembly, on cores that
    /// there are some for, where the degree is at most 3, N a power of two and the coordinates fit with it.
    ///
    /// ```
    /// use embedded_surfaces::forward::{Lattice, Steps};
    /// use embedded_surfaces::patch::{BilinearPatch, Surface};
    /// let patch = BilinearPatch::from_ints([[[0, 0, 5], [0, 9, 5]], [[9, 0, 5], [9, 9, 5]]])?;
    /// let lattice = Lattice::new(patch.surface(), Steps::uniform(9)?)?;
    /// // The coordinates are 0 ..= 9, 0 ..= 9 and 5.
    /// assert_eq!(lattice.checksum(), 10 * (45 + 45) + 100 * 5);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn checksum(&self) -> i32 {
        checksum(&self.form, &self.budget)
    }

    /// The points as an iterator, in row order.
    #[must_use]
    pub fn points(&self) -> LatticePoints {
        LatticePoints(Engine::new(&self.form, &self.budget))
    }

    /// The points as unit steps along the rows, for plotters.
    ///
    /// # Errors
    /// [`LatticeError::LongStep`] where the net's bound allows a step of more than one unit; it names counts that
    /// do not. [`Steps::paper`] never fails here.
    pub fn row_steps(&self) -> Result<RowSteps, LatticeError> {
        let units = self.budget.largest_step;
        if units > 1 {
            let scaled = |n: u32| n.saturating_mul(units);
            return Err(LatticeError::LongStep {
                units,
                needed: (scaled(self.form.steps.0), scaled(self.form.steps.1)),
            });
        }
        Ok(RowSteps { points: self.points(), last: None })
    }
}

impl IntoIterator for &Lattice<'_> {
    type Item = LatticePoint;
    type IntoIter = LatticePoints;

    fn into_iter(self) -> LatticePoints {
        self.points()
    }
}

impl Iterator for LatticePoints {
    type Item = LatticePoint;

    fn next(&mut self) -> Option<LatticePoint> {
        self.0.next_point()
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        let left = usize::try_from(self.0.remaining());
        (left.unwrap_or(usize::MAX), left.ok())
    }

    fn fold<B, F: FnMut(B, LatticePoint) -> B>(self, init: B, f: F) -> B {
        self.0.fold(init, f)
    }
}

impl core::iter::FusedIterator for LatticePoints {}

/// The points of a [`Lattice`] as unit steps along its rows.
#[derive(Clone, Debug)]
pub struct RowSteps {
    points: LatticePoints,
    last: Option<LatticePoint>,
}

impl Iterator for RowSteps {
    type Item = RowStep;

    fn next(&mut self) -> Option<RowStep> {
        let p = self.points.next()?;
        let step = match self.last {
            Some(q) if q.j == p.j => RowStep::Step([(p.x - q.x) as i8, (p.y - q.y) as i8, (p.z - q.z) as i8]),
            _ => RowStep::Start(p),
        };
        self.last = Some(p);
        Some(step)
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        self.points.size_hint()
    }
}

impl core::iter::FusedIterator for RowSteps {}

#[cfg(feature = "defmt")]
mod format {
    use super::{Lattice, LatticePoints, RowSteps};
    use defmt::{Format, Formatter};

    impl Format for Lattice<'_> {
        fn format(&self, f: Formatter<'_>) {
            let what = if self.form.centred { "centres" } else { "lattice" };
            defmt::write!(
                f,
                "{=str} of degrees {} at {} steps, {}",
                what,
                self.form.degrees,
                self.form.steps,
                self.budget
            );
        }
    }

    impl Format for LatticePoints {
        fn format(&self, f: Formatter<'_>) {
            defmt::write!(f, "{} lattice points left", self.0.remaining());
        }
    }

    impl Format for RowSteps {
        fn format(&self, f: Formatter<'_>) {
            defmt::write!(f, "{} row steps left, after {}", self.points.0.remaining(), self.last);
        }
    }
}
