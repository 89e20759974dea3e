//! Views by angle, fitted to a screen, and perspective.

use super::{Affine, Bounds, GeometryError, Point3};
use crate::num::{Angle, Coord, I16F16, I32F32, div_half_up};
use core::borrow::Borrow;

/// A direction of view: the model (z up) is turned by `spin` about z, then by `tilt` about x, and the screen shows
/// (x, −y, −z) of that. The default is tilt −60°, spin 30°.
///
/// ```
/// use embedded_surfaces::geometry::{Point3, View};
/// use embedded_surfaces::num::{Angle, I16F16};
/// let model = [Point3::from_ints(-1, 0, 0), Point3::from_ints(1, 0, 0), Point3::from_ints(0, 0, 1)];
/// let front = View { tilt: Angle::from_degrees(-90), spin: Angle::ZERO };
/// let to_screen = front.fit(&model, 320, 240, I16F16::ONE)?;
/// assert_eq!(to_screen.apply(&model[0])?, Point3::from_ints(0, 200, 0)); // 320 wide, centred
/// # Ok::<(), embedded_surfaces::geometry::GeometryError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct View {
    /// The turn about the x axis, after the spin.
    pub tilt: Angle,
    /// The turn about the model's vertical.
    pub spin: Angle,
}

impl Default for View {
    fn default() -> Self {
        Self { tilt: Angle::from_degrees(-60), spin: Angle::from_degrees(30) }
    }
}

impl View {
    /// The turned model seen by a screen whose y points down and whose z points away: no scale, no shift.
    ///
    /// # Errors
    /// None in fact: entries of rotations are at most 1.
    pub fn rotation(&self) -> Result<Affine, GeometryError> {
        let one = I32F32::ONE;
        let turned = Affine::rotation_z(self.spin).then(&Affine::rotation_x(self.tilt))?;
        turned.then(&Affine::scaling(one, -one, -one))
    }

    /// The orthographic view in which the axis box of the turned points fills the fraction `fit` of a screen of
    /// `width` × `height` pixels in the tighter direction, its centre at (width/2, height/2, 0).
    ///
    /// Cost: two passes over the points (one affine map each) and two 128-bit divisions.
    ///
    /// # Errors
    /// [`GeometryError::EmptyScreen`], [`GeometryError::NothingToFit`], or a turned point or matrix entry out of
    /// range.
    pub fn fit<C: Coord, P: Borrow<Point3<C>>>(
        &self,
        points: impl IntoIterator<Item = P>,
        width: u32,
        height: u32,
        fit: I16F16,
    ) -> Result<Affine, GeometryError> {
        if width == 0 || height == 0 || fit <= 0 {
            return Err(GeometryError::EmptyScreen { width, height });
        }
        let rotation = self.rotation()?;
        let mut bounds: Option<Bounds<I32F32>> = None;
        for point in points {
            let p = rotation.apply_into(point.borrow())?;
            let here = Bounds { min: p, max: p };
            bounds = Some(bounds.map_or(here, |b| b.union(&here)));
        }
        let b = bounds.ok_or(GeometryError::NothingToFit)?;
        let scale = [(width, b.max.x - b.min.x), (height, b.max.y - b.min.y)]
            .into_iter()
            .filter_map(|(pixels, extent)| {
                let target = (i128::from(pixels) * i128::from(fit.to_bits())) << 48;
                div_half_up(target, extent.to_bits().into())
            })
            .min()
            .ok_or(GeometryError::NothingToFit)?;
        let scale = i64::try_from(scale).map(I32F32::from_bits).map_err(|_| GeometryError::MatrixOverflow)?;
        let scaled = rotation.then(&Affine::scaling(scale, scale, scale))?;
        // The centre of the scaled box, from the same scale the points get.
        let centre = |low: I32F32, high: I32F32| {
            let sum = i128::from(low.to_bits()) + i128::from(high.to_bits());
            let product = sum.checked_mul(scale.to_bits().into()).ok_or(GeometryError::MatrixOverflow)?;
            i64::try_from(product >> 33).map(I32F32::from_bits).map_err(|_| GeometryError::MatrixOverflow)
        };
        let shift = |pixels: u32, centre: I32F32| {
            let half = I32F32::from_bits(i64::from(pixels) << 31);
            half.checked_sub(centre).ok_or(GeometryError::MatrixOverflow)
        };
        scaled.then(&Affine::translation(
            shift(width, centre(b.min.x, b.max.x)?)?,
            shift(height, centre(b.min.y, b.max.y)?)?,
            shift(0, centre(b.min.z, b.max.z)?)?,
        ))
    }
}

/// A perspective view along z: the plane z = 0 keeps its scale, the eye is `distance` in front of it, above
/// (`centre_x`, `centre_y`).
///
/// A point goes to x' = cx + (x − cx)·D/(D + z), likewise y, and z' = z·D/(D + z). The perspective of a polynomial
/// patch is the rational patch through the projected control points with the weights D + z.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Perspective {
    /// x of the eye.
    pub centre_x: I16F16,
    /// y of the eye.
    pub centre_y: I16F16,
    /// Distance D of the eye from the plane z = 0, in pixels.
    pub distance: I16F16,
}

impl Perspective {
    /// The projected point, rounded half up, and its weight D + z (exact).
    ///
    /// ```
    /// use embedded_surfaces::geometry::{Perspective, Point3};
    /// use embedded_surfaces::num::I16F16;
    /// let eye = Perspective { centre_x: I16F16::ZERO, centre_y: I16F16::ZERO, distance: I16F16::from_num(100) };
    /// let (p, weight) = eye.project(&Point3::from_ints(60, 30, 100))?;
    /// assert_eq!((p, weight), (Point3::from_ints(30, 15, 50), I16F16::from_num(200)));
    /// # Ok::<(), embedded_surfaces::geometry::GeometryError>(())
    /// ```
    ///
    /// # Errors
    /// [`GeometryError::BehindEye`] where D + z ≤ 0 or D ≤ 0; [`GeometryError::OutOfRange`] where the image or the weight
    /// leaves the legal range.
    pub fn project(&self, point: &Point3<I16F16>) -> Result<(Point3<I16F16>, I16F16), GeometryError> {
        let weight = self.distance.bits() + point.z.bits();
        if weight <= 0 || self.distance <= 0 {
            return Err(GeometryError::BehindEye { units: weight.min(self.distance.bits()) >> 16 });
        }
        let map = |axis, c: I16F16, centre: I16F16| {
            let product = i128::from(c.bits() - centre.bits()) * i128::from(self.distance.bits());
            let offset = div_half_up(product, weight.into()).unwrap_or(0);
            let bits = i128::from(centre.bits()) + offset;
            let limit = I16F16::LIMIT;
            let units = (bits >> 16) as i64;
            I16F16::from_legal_bits(bits).ok_or(GeometryError::OutOfRange { axis, units, limit })
        };
        let image = Point3::new(
            map(super::Axis::X, point.x, self.centre_x)?,
            map(super::Axis::Y, point.y, self.centre_y)?,
            map(super::Axis::Z, point.z, I16F16::ZERO)?,
        );
        let weight = I16F16::from_legal_bits(weight.into()).ok_or(GeometryError::OutOfRange {
            axis: super::Axis::Z,
            units: weight >> 16,
            limit: I16F16::LIMIT,
        })?;
        Ok((image, weight))
    }
}

#[cfg(feature = "defmt")]
impl defmt::Format for Perspective {
    fn format(&self, f: defmt::Formatter<'_>) {
        let (x, y, d) = (self.centre_x.to_bits(), self.centre_y.to_bits(), self.distance.to_bits());
        defmt::write!(f, "Perspective {{ centre: ({}, {})/2^16, distance: {}/2^16 }}", x, y, d);
    }
}
