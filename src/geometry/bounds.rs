//! Axis-parallel boxes.

use super::Point3;
use crate::num::{Coord, I16F16};

/// A closed box: the smallest and the largest coordinate along each axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Bounds<C = I16F16> {
    /// The corner with the smallest coordinates.
    pub min: Point3<C>,
    /// The corner with the largest coordinates.
    pub max: Point3<C>,
}

impl<C: Coord> Bounds<C> {
    /// The smallest box around the points; `None` for no points.
    ///
    /// ```
    /// use embedded_surfaces::geometry::{Bounds, Point3};
    /// let b = Bounds::of(&[Point3::from_ints(1, 2, 3), Point3::from_ints(-1, 5, 3)]).unwrap();
    /// assert_eq!((b.min.x, b.max.y, b.max.z), (Point3::from_ints(-1, 0, 0).x, Point3::from_ints(0, 5, 0).y, b.min.z));
    /// ```
    pub fn of<'a>(points: impl IntoIterator<Item = &'a Point3<C>>) -> Option<Self> {
        let mut points = points.into_iter();
        let first = *points.next()?;
        Some(points.fold(Self { min: first, max: first }, |b, p| b.union(&Self { min: *p, max: *p })))
    }

    /// The smallest box around both.
    #[must_use]
    pub fn union(&self, other: &Self) -> Self {
        let (a, b) = (self, other);
        Self {
            min: Point3::new(a.min.x.min(b.min.x), a.min.y.min(b.min.y), a.min.z.min(b.min.z)),
            max: Point3::new(a.max.x.max(b.max.x), a.max.y.max(b.max.y), a.max.z.max(b.max.z)),
        }
    }
}

#[cfg(feature = "defmt")]
impl<C: Coord> defmt::Format for Bounds<C> {
    fn format(&self, f: defmt::Formatter<'_>) {
        defmt::write!(f, "{} ..= {}", self.min, self.max);
    }
}
