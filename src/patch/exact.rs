//! Exact sums of points and vectors, rounded once: what the ways into nets share, also in constant context.

use super::NetError;
use crate::geometry::{Axis, Point3, Vector3};
use crate::num::{Coord, I16F16, bits_i16f16, bits_i32f32, div_half_up};

/// Three coordinates in units that the caller names.
pub(super) type Triple = [i64; 3];

/// The coordinates in 2^-16.
pub(super) const fn point(p: &Point3) -> Triple {
    [bits_i16f16(p.x), bits_i16f16(p.y), bits_i16f16(p.z)]
}

/// The components in 2^-32.
pub(super) const fn vector(v: &Vector3) -> Triple {
    [bits_i32f32(v.x), bits_i32f32(v.y), bits_i32f32(v.z)]
}

/// Σ factor · triple\[axis\] / divisor, rounded half up.
///
/// Not inlined: one copy of the 128-bit code serves all callers.
#[inline(never)]
const fn quotient(terms: &[(i64, Triple)], axis: usize, divisor: i64) -> i128 {
    let mut sum = 0;
    let mut i = 0;
    while i < terms.len() {
        let (factor, triple) = &terms[i];
        sum += *factor as i128 * triple[axis] as i128;
        i += 1;
    }
    if divisor == 1 {
        return sum; // the usual case, and a 128-bit division takes thousands of instructions
    }
    match div_half_up(sum, divisor as i128) {
        Some(quotient) => quotient,
        None => 0,
    }
}

/// The point Σ factor · triple / divisor in 2^-16, rounded half up, which is point `index` of its net.
///
/// The divisor is positive, factors stay below 2^32.
pub(super) const fn rounded(index: usize, terms: &[(i64, Triple)], divisor: i64) -> Result<Point3, NetError> {
    const LIMIT: i64 = <I16F16 as Coord>::LIMIT;
    let mut out = [0; 3];
    let mut axis = 0;
    while axis < 3 {
        let bits = quotient(terms, axis, divisor);
        if bits.unsigned_abs() > (LIMIT as u128) << 16 {
            let units = (bits >> 16) as i64;
            return Err(NetError::OutOfRange { index, axis: Axis::ALL[axis], units, limit: LIMIT });
        }
        out[axis] = bits as i32;
        axis += 1;
    }
    Ok(Point3::from_bits(out[0], out[1], out[2]))
}
