//! Curves in the plane as primitives.

use super::tiles::{add_offset, moved};
use crate::forward::{LatticeError, PlanePlan, PlaneWalk};
use crate::geometry::{Bounds, Point3};
use crate::num::{Coord, I16F16};
use crate::patch::{Curve, CurveNet, RationalCurve, RationalCurveNet};
use embedded_graphics_core::geometry::{Dimensions, Point, Size};
use embedded_graphics_core::primitives::{PointsIter, Rectangle};

/// The net of a curve of either kind, borrowed: what [`BezierCurve::new`] takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum AnyCurveNet<'a> {
    /// A polynomial curve.
    Polynomial(CurveNet<'a>),
    /// A rational curve.
    Rational(RationalCurveNet<'a>),
}

impl<'a> AnyCurveNet<'a> {
    /// The control points.
    #[must_use]
    pub const fn points(&self) -> &'a [Point3] {
        match self {
            Self::Polynomial(net) => net.points(),
            Self::Rational(net) => net.points(),
        }
    }

    /// The weights; `None` for a polynomial curve.
    #[must_use]
    pub const fn weights(&self) -> Option<&'a [I16F16]> {
        match self {
            Self::Polynomial(_) => None,
            Self::Rational(net) => Some(net.weights()),
        }
    }
}

impl<'a> From<CurveNet<'a>> for AnyCurveNet<'a> {
    fn from(net: CurveNet<'a>) -> Self {
        Self::Polynomial(net)
    }
}

impl<'a> From<RationalCurveNet<'a>> for AnyCurveNet<'a> {
    fn from(net: RationalCurveNet<'a>) -> Self {
        Self::Rational(net)
    }
}

impl<'a, const K: usize> From<&'a Curve<K>> for AnyCurveNet<'a> {
    fn from(curve: &'a Curve<K>) -> Self {
        Self::Polynomial(curve.net())
    }
}

impl<'a, const K: usize> From<&'a RationalCurve<K>> for AnyCurveNet<'a> {
    fn from(curve: &'a RationalCurve<K>) -> Self {
        Self::Rational(curve.net())
    }
}

/// A Bézier curve in the plane, at a place: polynomial or rational, of degree 1 to 8. It borrows the control points;
/// their z is ignored.
///
/// Coordinates are pixels, x to the right, y down, pixel centres at integers. The curve is sampled at n steps
/// ([`steps`](Self::steps)), the larger of
/// * B, the bound m·max|ΔP| on the derivatives of x and y (the centred one for a rational curve), rounded up: neither
///   moves by more than one pixel a step;
/// * 16·(m − 1 + W) with W = m·max|Δw|/min w: the chord of a step stays within √2/64 pixel of the curve, also where
///   B is small.
///
/// Memory: 32 bytes on a 32-bit target, 48 on a 64-bit one. Making one takes 1.3 KB of stack.
///
/// ```
/// use embedded_graphics::{mock_display::MockDisplay, pixelcolor::BinaryColor, prelude::*};
/// use embedded_surfaces::{graphics::BezierCurve, patch::QuadraticCurve};
/// let arch = QuadraticCurve::from_ints([[0, 5, 0], [6, -5, 0], [12, 5, 0]])?;
/// let mut display = MockDisplay::new();
/// let pixels = BezierCurve::new(&arch)?.points().map(|p| Pixel(p, BinaryColor::On));
/// display.draw_iter(pixels)?;
/// display.assert_pattern(&[
///     "    #####    ",
///     "   ##   ##   ",
///     "  #       #  ",
///     " #         # ",
///     " #         # ",
///     "#           #",
/// ]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// With the feature `styled` it is a `Primitive`:
///
/// ```
/// # #[cfg(feature = "styled")] {
/// use embedded_graphics::{mock_display::MockDisplay, pixelcolor::BinaryColor, prelude::*, primitives::PrimitiveStyle};
/// use embedded_surfaces::{graphics::BezierCurve, patch::QuadraticCurve};
/// let arch = QuadraticCurve::from_ints([[3, 7, 0], [9, -5, 0], [15, 7, 0]])?;
/// let mut display = MockDisplay::new();
/// BezierCurve::new(&arch)?.into_styled(PrimitiveStyle::with_stroke(BinaryColor::On, 3)).draw(&mut display)?;
/// display.assert_pattern(&[
///     "       #####     ",
///     "      #######    ",
///     "     #########   ",
///     "    ####   ####  ",
///     "   ####     #### ",
///     "   ###       ### ",
///     "  ####       ####",
///     "  ###         ###",
///     "  ###         ###",
/// ]);
/// # }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BezierCurve<'a> {
    net: AnyCurveNet<'a>,
    plan: PlanePlan,
    offset: Point,
}

impl<'a> BezierCurve<'a> {
    /// The curve with this net: a `&Curve`, a `&RationalCurve`, a [`CurveNet`] or a [`RationalCurveNet`].
    ///
    /// # Errors
    /// [`LatticeError`] where the lattice does not fit the engine: [`Budget`](LatticeError::Budget) for (2K+1)·N above
    /// 128 bits, [`Steps`](LatticeError::Steps) for a step count above 2^24, which only rational curves ask for.
    pub fn new(curve: impl Into<AnyCurveNet<'a>>) -> Result<Self, LatticeError> {
        let net = curve.into();
        let plan = PlanePlan::of((net.points(), net.weights()))?;
        Ok(Self { net, plan, offset: Point::zero() })
    }

    /// The control net.
    #[must_use]
    pub const fn net(&self) -> AnyCurveNet<'a> {
        self.net
    }

    /// The number of steps n that the curve is sampled at.
    #[must_use]
    pub const fn steps(&self) -> u32 {
        self.plan.steps
    }

    /// How far the curve was moved from its control points.
    #[must_use]
    pub const fn offset(&self) -> Point {
        self.offset
    }

    /// The curve moved by whole pixels; lattice points move exactly. Places beyond ±2^29 stop there.
    #[must_use]
    pub fn translate(&self, by: Point) -> Self {
        let mut moved = *self;
        moved.translate_mut(by);
        moved
    }

    /// Moves the curve by whole pixels. Places beyond ±2^29 stop there.
    pub fn translate_mut(&mut self, by: Point) -> &mut Self {
        self.offset = add_offset(self.offset, by);
        self
    }

    /// The smallest rectangle that holds every pixel of [`points`](Self::points), from the control points.
    #[must_use]
    pub fn bounding_box(&self) -> Rectangle {
        self.pixel_box(|low, high| [(low + (1 << 15)) >> 16, (high + (1 << 15)) >> 16])
    }

    /// The rectangle whose sides `pixels` finds from the least and the largest coordinate in 2^-16 pixels.
    pub(super) fn pixel_box(&self, pixels: impl Fn(i64, i64) -> [i64; 2]) -> Rectangle {
        let Some(bounds) = Bounds::of(self.net.points()) else { return Rectangle::zero() };
        let [left, right] = pixels(bounds.min.x.bits(), bounds.max.x.bits()).map(|c| c as i32);
        let [top, bottom] = pixels(bounds.min.y.bits(), bounds.max.y.bits()).map(|c| c as i32);
        let size = Size::new(right.abs_diff(left) + 1, bottom.abs_diff(top) + 1);
        moved(Rectangle::new(Point::new(left, top), size), self.offset, 1)
    }

    /// The pixels of the curve, in order, from the first control point to the last: the lattice points
    /// `floor(S(i/n) + 1/2)` without those equal to the one before.
    ///
    /// Each is one of the eight neighbours of the one before: x and y differ by at most one unit between i/n and
    /// (i+1)/n since n ≥ B, and of a + 1/2 and b + 1/2 with |a − b| ≤ 1 the integer parts differ by at most one. Where
    /// the curve crosses itself, or turns back, a pixel comes again.
    ///
    /// Cost: 2·m additions a lattice point, 3·m for a rational curve. The iterator holds the differences: 0.5 KB.
    #[must_use]
    pub fn points(&self) -> CurvePixels {
        CurvePixels { walk: self.walk(), next: true, last: None, offset: self.offset }
    }

    /// The walk over the lattice, without the offset.
    pub(super) fn walk(&self) -> PlaneWalk {
        PlaneWalk::new((self.net.points(), self.net.weights()), &self.plan)
    }
}

impl Dimensions for BezierCurve<'_> {
    fn bounding_box(&self) -> Rectangle {
        self.bounding_box()
    }
}

impl PointsIter for BezierCurve<'_> {
    type Iter = CurvePixels;

    fn points(&self) -> CurvePixels {
        self.points()
    }
}

#[cfg(feature = "defmt")]
impl defmt::Format for BezierCurve<'_> {
    fn format(&self, f: defmt::Formatter<'_>) {
        defmt::write!(f, "{} moved by ({}, {})", self.net, self.offset.x, self.offset.y);
    }
}

/// The pixels of a [`BezierCurve`], in order: neighbours are 8-connected and differ.
#[derive(Clone, Debug)]
pub struct CurvePixels {
    walk: PlaneWalk,
    /// Whether the point that the walk stands at is still to come.
    next: bool,
    last: Option<[i32; 2]>,
    offset: Point,
}

impl Iterator for CurvePixels {
    type Item = Point;

    fn next(&mut self) -> Option<Point> {
        while self.next {
            let (point, more) = match &mut self.walk {
                PlaneWalk::Narrow(walk) => (walk.point(), walk.advance()),
                PlaneWalk::Wide(walk) => (walk.point(), walk.advance()),
            };
            self.next = more;
            if self.last.replace(point) != Some(point) {
                let [x, y] = point;
                return Some(Point::new(x, y) + self.offset);
            }
        }
        None
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        let left = match &self.walk {
            PlaneWalk::Narrow(walk) => walk.left(),
            PlaneWalk::Wide(walk) => walk.left(),
        };
        // At most 2^24 steps and a point.
        let most = if self.next { left as usize + 1 } else { 0 };
        (if self.last.is_none() { most.min(1) } else { 0 }, Some(most))
    }
}

impl core::iter::FusedIterator for CurvePixels {}

#[cfg(feature = "defmt")]
impl defmt::Format for CurvePixels {
    fn format(&self, f: defmt::Formatter<'_>) {
        let (_, most) = self.size_hint();
        defmt::write!(f, "at most {} curve pixels left, moved by ({}, {})", most, self.offset.x, self.offset.y);
    }
}
