//! Exact parameters: rational numbers with small denominators.

use super::NetError;

/// The largest denominator of a parameter.
pub(crate) const MAX_DENOMINATOR: u32 = 1 << 16;

/// A parameter in 0 ..= 1, as an exact fraction with a denominator of at most 65536.
///
/// ```
/// use embedded_surfaces::patch::Parameter;
/// assert!(Parameter::new(3, 300).is_ok());
/// assert!(Parameter::new(4, 3).is_err());
/// assert!(Parameter::new(0, 0).is_err());
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Parameter {
    numerator: u32,
    denominator: u32,
}

impl Parameter {
    /// The start, 0.
    pub const ZERO: Self = Self { numerator: 0, denominator: 1 };
    /// The middle, 1/2.
    pub const HALF: Self = Self { numerator: 1, denominator: 2 };
    /// The end, 1.
    pub const ONE: Self = Self { numerator: 1, denominator: 1 };

    /// `numerator / denominator`.
    ///
    /// # Errors
    /// [`NetError::Parameter`] unless 1 ≤ denominator ≤ 65536 and numerator ≤ denominator.
    pub const fn new(numerator: u32, denominator: u32) -> Result<Self, NetError> {
        if denominator == 0 || denominator > MAX_DENOMINATOR || numerator > denominator {
            return Err(NetError::Parameter { numerator, denominator });
        }
        Ok(Self { numerator, denominator })
    }

    /// The numerator, at most the denominator.
    #[must_use]
    pub const fn numerator(self) -> u32 {
        self.numerator
    }

    /// The denominator, 1 ..= 65536.
    #[must_use]
    pub const fn denominator(self) -> u32 {
        self.denominator
    }
}

/// Barycentric coordinates of a point of the domain triangle: (u, v, w) / (u + v + w), exact.
///
/// ```
/// use embedded_surfaces::patch::Barycentric;
/// let centroid = Barycentric::new(1, 1, 1)?;
/// assert_eq!(centroid.denominator(), 3);
/// # Ok::<(), embedded_surfaces::patch::NetError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Barycentric {
    weights: [u32; 3],
}

impl Barycentric {
    /// The point with these homogeneous barycentric coordinates.
    ///
    /// # Errors
    /// [`NetError::Parameter`] unless the sum is in 1 ..= 65536.
    pub const fn new(u: u32, v: u32, w: u32) -> Result<Self, NetError> {
        let sum = u as u64 + v as u64 + w as u64;
        if sum == 0 || sum > MAX_DENOMINATOR as u64 {
            let denominator = if sum > u32::MAX as u64 { u32::MAX } else { sum as u32 };
            return Err(NetError::Parameter { numerator: u, denominator });
        }
        Ok(Self { weights: [u, v, w] })
    }

    /// (u, v, w), before the division by [`denominator`](Self::denominator).
    #[must_use]
    pub const fn weights(self) -> [u32; 3] {
        self.weights
    }

    /// u + v + w.
    #[must_use]
    pub const fn denominator(self) -> u32 {
        self.weights[0] + self.weights[1] + self.weights[2]
    }
}
