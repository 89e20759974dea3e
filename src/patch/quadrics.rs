//! Ways in from solids: sphere, cylinder, cone and torus as rational biquadratic patches.
//!
//! A quarter of a circle of radius ρ is the rational quadratic through (ρ, 0), (ρ, ρ), (0, ρ) with the weights
//! 1, 1, 2, or through them backwards with 2, 1, 1: whole numbers, no 1/√2. A quarter that is turned about the axis
//! is a biquadratic patch whose control points are sums of the centre and the radii and whose weights are products
//! of these. So the nets are exact: every point of a patch lies on the solid, at distance 0.
//!
//! All have their axis along z; [`RationalTensor::transform`] turns and moves them. That rounds each control point,
//! and as weights are positive, every point of the surface is off by no more: 2^-17 along each axis, and what the
//! entries of the matrix are off.
//!
//! Patch 4·p + q is part p of the profile turned through quarter q of the full turn, the one from +x to +y first. r
//! runs with the turn, s along the profile, and S_r × S_s points outwards. Neighbours share the points and weights of
//! their border bit by bit. An error names a control point by its index within its patch.
//!
//! A patch takes 144 bytes. The functions are `const`, for tables in flash; at run time they take the result and
//! 1.1 KB of stack.
//!
//! Source: Piegl and Tiller, *The NURBS Book*, chapters 7 and 8.

use super::exact::{Triple, point, rounded};
use super::{NetError, RationalTensor, Tensor};
use crate::geometry::Point3;
use crate::num::{I16F16, shift_half_up};

/// A length of a solid.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Dimension {
    /// The radius; of a torus, that of the circle that the middle of its tube runs along.
    Radius,
    /// The radius of the tube of a torus.
    TubeRadius,
    /// The height of a cylinder or cone.
    Height,
}

impl core::fmt::Display for Dimension {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str(match self {
            Self::Radius => "radius",
            Self::TubeRadius => "tube radius",
            Self::Height => "height",
        })
    }
}

/// A control point of a profile: its distance from the axis and its height in 2^-16, and its weight.
type ProfilePoint = (i64, i64, i32);

/// Quarters of the unit circle, weights alternating so that neighbours agree on their common point's.
const QUARTERS: [[ProfilePoint; 3]; 4] = [
    [(1, 0, 1), (1, 1, 1), (0, 1, 2)],
    [(0, 1, 2), (-1, 1, 1), (-1, 0, 1)],
    [(-1, 0, 1), (-1, -1, 1), (0, -1, 2)],
    [(0, -1, 2), (1, -1, 1), (1, 0, 1)],
];

/// The sphere: four octants below the equator, four above.
///
/// ```
/// use embedded_surfaces::{const_net, geometry::Point3, num::I16F16, patch::{Parameter, RationalTensor, sphere}};
/// static BALL: [RationalTensor<3, 3>; 8] = const_net!(sphere(Point3::ORIGIN, I16F16::const_from_int(225)));
/// let p = BALL[4].net().eval(Parameter::HALF, Parameter::HALF);
/// assert_eq!(p, Point3::from_ints(81, 108, 180)); // 81² + 108² + 180² = 225²
/// ```
///
/// # Errors
/// [`NetError::NotPositive`] for the radius; [`NetError::OutOfRange`] where a control point leaves ±32767.
pub const fn sphere(centre: Point3, radius: I16F16) -> Result<[RationalTensor<3, 3>; 8], NetError> {
    match positive(Dimension::Radius, radius) {
        Ok(radius) => revolved(&centre, &[arc(0, radius, 3), arc(0, radius, 0)]),
        Err(error) => Err(error),
    }
}

/// The side of the cylinder that stands on the disc about `base`: four patches.
///
/// The middle control points are at half the height, half up, still on their ruling: the patches are exact always.
///
/// ```
/// use embedded_surfaces::{geometry::Point3, num::I16F16, patch::{Parameter, cylinder}};
/// let tin = cylinder(Point3::from_ints(0, 0, 7), I16F16::from_num(100), I16F16::from_num(30))?;
/// let p = tin[0].net().eval(Parameter::HALF, Parameter::HALF);
/// assert_eq!(p, Point3::from_ints(60, 80, 22));
/// # Ok::<(), embedded_surfaces::patch::NetError>(())
/// ```
///
/// # Errors
/// [`NetError::NotPositive`] for the radius or the height; [`NetError::OutOfRange`] where a control point leaves
/// ±32767.
pub const fn cylinder(base: Point3, radius: I16F16, height: I16F16) -> Result<[RationalTensor<3, 3>; 4], NetError> {
    match (positive(Dimension::Radius, radius), positive(Dimension::Height, height)) {
        (Ok(radius), Ok(height)) => {
            revolved(&base, &[[(radius, 0, 1), (radius, half(height), 1), (radius, height, 1)]])
        }
        (Err(error), _) | (_, Err(error)) => Err(error),
    }
}

/// The side of the cone that stands on the disc about `base` and ends in a point: four patches.
///
/// The middle control points are at half the radius and height, half up. The patches are exact where both halves are
/// multiples of 2^-16, else within 2^-17 along each axis.
///
/// ```
/// use embedded_surfaces::{geometry::Point3, num::I16F16, patch::{Parameter, cone}};
/// let hat = cone(Point3::ORIGIN, I16F16::from_num(100), I16F16::from_num(30))?;
/// let p = hat[0].net().eval(Parameter::HALF, Parameter::HALF);
/// assert_eq!(p, Point3::from_ints(30, 40, 15));
/// # Ok::<(), embedded_surfaces::patch::NetError>(())
/// ```
///
/// # Errors
/// [`NetError::NotPositive`] for the radius or the height; [`NetError::OutOfRange`] where a control point leaves
/// ±32767.
pub const fn cone(base: Point3, radius: I16F16, height: I16F16) -> Result<[RationalTensor<3, 3>; 4], NetError> {
    match (positive(Dimension::Radius, radius), positive(Dimension::Height, height)) {
        (Ok(radius), Ok(height)) => {
            let middle = (half(radius), half(height), 1);
            revolved(&base, &[[(radius, 0, 1), middle, (0, height, 1)]])
        }
        (Err(error), _) | (_, Err(error)) => Err(error),
    }
}

/// The torus whose tube of radius `tube` runs along the circle of radius `radius`: sixteen patches, the parts of its
/// profile upwards from the outer equator. With a tube wider than the circle it passes through itself at the axis.
///
/// ```
/// use embedded_surfaces::{geometry::Point3, num::I16F16, patch::{Parameter, torus}};
/// let ring = torus(Point3::ORIGIN, I16F16::from_num(100), I16F16::from_num(25))?;
/// let p = ring[0].net().eval(Parameter::HALF, Parameter::HALF); // 3-4-5 about the axis and in the tube
/// assert_eq!(p, Point3::from_ints(69, 92, 20));
/// # Ok::<(), embedded_surfaces::patch::NetError>(())
/// ```
///
/// # Errors
/// [`NetError::NotPositive`] for a radius; [`NetError::OutOfRange`] where a control point leaves ±32767.
pub const fn torus(centre: Point3, radius: I16F16, tube: I16F16) -> Result<[RationalTensor<3, 3>; 16], NetError> {
    match (positive(Dimension::Radius, radius), positive(Dimension::TubeRadius, tube)) {
        (Ok(from), Ok(tube)) => {
            revolved(&centre, &[arc(from, tube, 0), arc(from, tube, 1), arc(from, tube, 2), arc(from, tube, 3)])
        }
        (Err(error), _) | (_, Err(error)) => Err(error),
    }
}

/// The length in 2^-16.
const fn positive(dimension: Dimension, length: I16F16) -> Result<i64, NetError> {
    let bits = length.to_bits();
    if bits > 0 { Ok(bits as i64) } else { Err(NetError::NotPositive { dimension, bits }) }
}

/// Half the length, half up.
const fn half(length: i64) -> i64 {
    shift_half_up(length as i128, 1) as i64
}

/// A quarter of a circle whose centre is `from` away from the axis.
const fn arc(from: i64, radius: i64, quarter: usize) -> [ProfilePoint; 3] {
    let mut profile = QUARTERS[quarter];
    let mut j = 0;
    while j < 3 {
        profile[j] = (from + radius * profile[j].0, radius * profile[j].1, profile[j].2);
        j += 1;
    }
    profile
}

/// The parts of a profile, each turned through the four quarters: `N` is four times `P`.
const fn revolved<const P: usize, const N: usize>(
    centre: &Point3,
    profile: &[[ProfilePoint; 3]; P],
) -> Result<[RationalTensor<3, 3>; N], NetError> {
    let () = const { assert!(P > 0 && N == 4 * P) };
    let first = match turned(centre, &profile[0], 0) {
        Ok(patch) => patch,
        Err(error) => return Err(error),
    };
    let mut patches = [first; N];
    let mut index = 1;
    while index < N {
        patches[index] = match turned(centre, &profile[index / 4], index % 4) {
            Ok(patch) => patch,
            Err(error) => return Err(error),
        };
        index += 1;
    }
    Ok(patches)
}

/// A part of a profile turned through one quarter.
const fn turned(
    centre: &Point3,
    profile: &[ProfilePoint; 3],
    quarter: usize,
) -> Result<RationalTensor<3, 3>, NetError> {
    let mut points = [[*centre; 3]; 3];
    let mut weights = [[I16F16::ONE; 3]; 3];
    let mut index = 0;
    while index < 9 {
        let (i, j) = (index / 3, index % 3);
        let ((x, y, turn), (from_axis, height, weight)) = (QUARTERS[quarter][i], profile[j]);
        let offset: Triple = [from_axis * x, from_axis * y, height];
        points[i][j] = match rounded(index, &[(1, point(centre)), (1, offset)], 1) {
            Ok(point) => point,
            Err(error) => return Err(error),
        };
        weights[i][j] = I16F16::from_bits((turn * weight) << 16);
        index += 1;
    }
    match Tensor::<3, 3>::new(points) {
        Ok(net) => RationalTensor::new(net, weights),
        Err(error) => Err(error),
    }
}
