//! Points, vectors and axes.

use crate::num::{Coord, I16F16, I32F32, shift_half_up};

/// One of the three axes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Axis {
    /// To the right on a screen.
    X,
    /// Down on a screen.
    Y,
    /// Away from the viewer on a screen.
    Z,
}

impl Axis {
    /// The three axes, in order.
    pub const ALL: [Self; 3] = [Self::X, Self::Y, Self::Z];
}

impl core::fmt::Display for Axis {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str(match self {
            Self::X => "x",
            Self::Y => "y",
            Self::Z => "z",
        })
    }
}

/// A point with coordinates of type `C`, in pixels or motor steps.
///
/// ```
/// use embedded_surfaces::geometry::Point3;
/// let p = Point3::from_ints(180, 20, 150);
/// assert_eq!(p.x, 180);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub struct Point3<C = I16F16> {
    /// To the right on a screen.
    pub x: C,
    /// Down on a screen.
    pub y: C,
    /// Away from the viewer on a screen.
    pub z: C,
}

/// A vector with components of type `C`: a difference of points or a derivative.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub struct Vector3<C = I32F32> {
    /// Along x.
    pub x: C,
    /// Along y.
    pub y: C,
    /// Along z.
    pub z: C,
}

impl<C> Point3<C> {
    /// The point with these coordinates.
    pub const fn new(x: C, y: C, z: C) -> Self {
        Self { x, y, z }
    }

    /// The coordinates as an array, x first.
    pub fn to_array(self) -> [C; 3] {
        [self.x, self.y, self.z]
    }

    /// The point with these coordinates, x first.
    pub fn from_array([x, y, z]: [C; 3]) -> Self {
        Self { x, y, z }
    }
}

impl<C> Vector3<C> {
    /// The vector with these components.
    pub const fn new(x: C, y: C, z: C) -> Self {
        Self { x, y, z }
    }

    /// The components as an array, x first.
    pub fn to_array(self) -> [C; 3] {
        [self.x, self.y, self.z]
    }

    /// The vector with these components, x first.
    pub fn from_array([x, y, z]: [C; 3]) -> Self {
        Self { x, y, z }
    }
}

impl Point3<I16F16> {
    /// The origin.
    pub const ORIGIN: Self = Self::from_ints(0, 0, 0);

    /// The point with whole coordinates.
    #[must_use]
    pub const fn from_ints(x: i16, y: i16, z: i16) -> Self {
        const fn whole(value: i16) -> I16F16 {
            I16F16::from_bits((value as i32) << 16)
        }
        Self { x: whole(x), y: whole(y), z: whole(z) }
    }

    /// The point with these raw coordinate bits, in units of 2^-16.
    #[must_use]
    pub const fn from_bits(x: i32, y: i32, z: i32) -> Self {
        Self { x: I16F16::from_bits(x), y: I16F16::from_bits(y), z: I16F16::from_bits(z) }
    }
}

impl Point3<I32F32> {
    /// The nearest point with `I16F16` coordinates, half up; `None` outside its legal range.
    ///
    /// ```
    /// use embedded_surfaces::{geometry::Point3, num::I32F32};
    /// let p = Point3::new(I32F32::from_num(7), I32F32::ZERO, I32F32::from_bits(1 << 15));
    /// assert_eq!(p.round().map(|p| (p.x.to_bits(), p.z.to_bits())), Some((7 << 16, 1)));
    /// ```
    #[must_use]
    pub fn round(self) -> Option<Point3<I16F16>> {
        let round = |c: I32F32| I16F16::from_legal_bits(shift_half_up(c.bits().into(), 16));
        Some(Point3::new(round(self.x)?, round(self.y)?, round(self.z)?))
    }
}

impl From<Point3<I16F16>> for Point3<I32F32> {
    fn from(p: Point3<I16F16>) -> Self {
        Self::new(p.x.into(), p.y.into(), p.z.into())
    }
}

#[cfg(feature = "defmt")]
mod format {
    use super::{Coord, Point3, Vector3};

    // `fixed` formats itself for defmt only from 1.30 on: print exact bits over the scale.
    impl<C: Coord> defmt::Format for Point3<C> {
        fn format(&self, f: defmt::Formatter<'_>) {
            let (x, y, z) = (self.x.bits(), self.y.bits(), self.z.bits());
            defmt::write!(f, "({}, {}, {})/2^{}", x, y, z, C::FRACTION_BITS);
        }
    }

    impl<C: Coord> defmt::Format for Vector3<C> {
        fn format(&self, f: defmt::Formatter<'_>) {
            let (x, y, z) = (self.x.bits(), self.y.bits(), self.z.bits());
            defmt::write!(f, "<{}, {}, {}>/2^{}", x, y, z, C::FRACTION_BITS);
        }
    }
}
