//! Affine maps of control points.

use super::{Axis, GeometryError, Point3};
use crate::num::{Angle, Coord, I32F32, shift_half_up};

/// An affine map p ↦ M p + t with `I32F32` entries.
///
/// A mapped coordinate is the exact sum of products, rounded once, half up.
///
/// ```
/// use embedded_surfaces::geometry::{Affine, Point3};
/// use embedded_surfaces::num::{Angle, I32F32};
/// let quarter = Affine::rotation_z(Angle::from_degrees(90));
/// let moved = quarter.then(&Affine::translation(I32F32::ONE, I32F32::ZERO, I32F32::ZERO))?;
/// assert_eq!(moved.apply(&Point3::from_ints(2, 0, 5))?, Point3::from_ints(1, 2, 5));
/// # Ok::<(), embedded_surfaces::geometry::GeometryError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Affine {
    /// Row by row: three factors and the translation.
    pub rows: [[I32F32; 4]; 3],
}

const ZERO: I32F32 = I32F32::ZERO;
const ONE: I32F32 = I32F32::ONE;

impl Affine {
    /// The map that changes nothing.
    pub const IDENTITY: Self = Self::scaling(ONE, ONE, ONE);

    /// Scales each axis.
    #[must_use]
    pub const fn scaling(x: I32F32, y: I32F32, z: I32F32) -> Self {
        Self { rows: [[x, ZERO, ZERO, ZERO], [ZERO, y, ZERO, ZERO], [ZERO, ZERO, z, ZERO]] }
    }

    /// Moves by (x, y, z).
    #[must_use]
    pub const fn translation(x: I32F32, y: I32F32, z: I32F32) -> Self {
        Self { rows: [[ONE, ZERO, ZERO, x], [ZERO, ONE, ZERO, y], [ZERO, ZERO, ONE, z]] }
    }

    /// Turns by `angle` about the x axis, y towards z. Entries within 2^-32.
    #[must_use]
    pub fn rotation_x(angle: Angle) -> Self {
        let (sin, cos) = angle.sin_cos();
        Self { rows: [[ONE, ZERO, ZERO, ZERO], [ZERO, cos, -sin, ZERO], [ZERO, sin, cos, ZERO]] }
    }

    /// Turns by `angle` about the z axis, x towards y. Entries within 2^-32.
    #[must_use]
    pub fn rotation_z(angle: Angle) -> Self {
        let (sin, cos) = angle.sin_cos();
        Self { rows: [[cos, -sin, ZERO, ZERO], [sin, cos, ZERO, ZERO], [ZERO, ZERO, ONE, ZERO]] }
    }

    /// First `self`, then `next`; entries rounded half up.
    ///
    /// # Errors
    /// [`GeometryError::MatrixOverflow`] where an entry does not fit an `I32F32`.
    pub fn then(&self, next: &Self) -> Result<Self, GeometryError> {
        let mut rows = [[ZERO; 4]; 3];
        for (out, factors) in rows.iter_mut().zip(&next.rows) {
            for (column, entry) in out.iter_mut().enumerate() {
                let mut sum = if column == 3 { i128::from(factors[3].to_bits()) << 32 } else { 0 };
                for (factor, row) in factors.iter().zip(&self.rows) {
                    let product = i128::from(factor.to_bits()) * i128::from(row[column].to_bits());
                    sum = sum.checked_add(product).ok_or(GeometryError::MatrixOverflow)?;
                }
                let rounded = shift_half_up(sum >> 1, 31);
                *entry = i64::try_from(rounded).map(I32F32::from_bits).map_err(|_| GeometryError::MatrixOverflow)?;
            }
        }
        Ok(Self { rows })
    }

    /// The image of a point, rounded half up to its coordinate type.
    ///
    /// # Errors
    /// [`GeometryError::OutOfRange`] where the image leaves the legal range of `C`.
    pub fn apply<C: Coord>(&self, point: &Point3<C>) -> Result<Point3<C>, GeometryError> {
        self.apply_into(point)
    }

    /// The image of a point in another coordinate type, rounded half up once.
    ///
    /// # Errors
    /// [`GeometryError::OutOfRange`] where the image leaves the legal range of `D`.
    pub fn apply_into<C: Coord, D: Coord>(&self, point: &Point3<C>) -> Result<Point3<D>, GeometryError> {
        let short = point.to_array().map(C::bits);
        let p = short.map(i128::from);
        let image = |axis: Axis| {
            let row = &self.rows[axis as usize];
            if let Some(image) = short_image::<C, D>(row, short) {
                return Ok(image);
            }
            let mut sum = i128::from(row[3].to_bits()) << C::FRACTION_BITS;
            for (factor, c) in row.iter().zip(p) {
                // |factor|, |c| <= 2^63. Legal points stay below 2^124; others may saturate, and what saturated stays
                // above 2^125 in magnitude, out of every range.
                sum = sum.saturating_add(i128::from(factor.to_bits()) * c);
            }
            let fraction = 32 + C::FRACTION_BITS;
            let bits = shift_half_up(sum >> 1, fraction - D::FRACTION_BITS - 1);
            D::from_legal_bits(bits).ok_or(GeometryError::OutOfRange {
                axis,
                units: (sum >> fraction) as i64,
                limit: D::LIMIT,
            })
        };
        Ok(Point3::new(image(Axis::X)?, image(Axis::Y)?, image(Axis::Z)?))
    }
}

/// [`Affine::apply_into`] in 64 bits, where factors are below 1/4, as those of maps onto screens are; `None` for others.
#[inline(always)]
fn short_image<C: Coord, D: Coord>(row: &[I32F32; 4], point: [i64; 3]) -> Option<D> {
    let [a, b, c, shift] = row.map(I32F32::to_bits);
    let fits = |v: i64, bits: u32| v >= -1 << bits && v < 1 << bits;
    let is_short = fits(a, 30) && fits(b, 30) && fits(c, 30) && fits(shift, 44);
    if C::FRACTION_BITS + D::FRACTION_BITS != 32 || !is_short {
        return None;
    }
    // Three products of 31 bits and 30, and 2^60: below 2^63.
    let product = |factor: i64, c: i64| i64::from(factor as i32) * i64::from(c as i32);
    let [x, y, z] = point;
    let sum = product(a, x) + product(b, y) + product(c, z) + (shift << C::FRACTION_BITS);
    D::from_legal_bits(((sum + (1 << 31)) >> 32).into())
}

#[cfg(feature = "defmt")]
impl defmt::Format for Affine {
    fn format(&self, f: defmt::Formatter<'_>) {
        let rows = self.rows.map(|row| row.map(|entry| entry.to_bits()));
        defmt::write!(f, "{}/2^32", rows);
    }
}
