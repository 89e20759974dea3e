//! Exact midpoint subdivision of integers: sums instead of halves, in place, one coordinate at a time.
//!
//! With the blossom b\[…\] of a curve of degree n over (A, B) and the midpoint M, the half over (A, M) has the control
//! points b\[A^(n−j) M^j\] = 2^-j Σ C(j, l) b_l. The sums are what one pass of additions towards the end of the row
//! leaves behind, repeated n times, each a place shorter. Everything here is that pass along rows of a net.

use crate::num::Word;
use crate::patch::{triangle_index, triangle_len};

/// One of the two halves of a parameter interval.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Half {
    /// 0 ..= 1/2.
    First,
    /// 1/2 ..= 1.
    Second,
}

/// A parameter direction of a tensor-product patch.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Direction {
    /// The first parameter.
    R,
    /// The second parameter.
    S,
}

/// One of the four children of a triangle (T1, T2, T3) with the midpoints p1 of T2T3, p2 of T1T3, p3 of T1T2. All have
/// the parent's orientation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Quarter {
    /// (T1, p3, p2), the paper's S.
    AtU,
    /// (p3, T2, p1), the paper's Q.
    AtV,
    /// (p2, p1, T3), the paper's P.
    AtW,
    /// (p1, p2, p3), the paper's T.
    Centre,
}

impl Half {
    /// Both halves, in the order of the parameter.
    pub const ALL: [Self; 2] = [Self::First, Self::Second];
}

impl Quarter {
    /// The four children: at T1, T2, T3 and the one in the middle.
    pub const ALL: [Self; 4] = [Self::AtU, Self::AtV, Self::AtW, Self::Centre];
}

/// The row of `count` values that starts at `start` and whose neighbours are `at(k)`, summed: value k becomes
/// Σ C(k, l)·value l, which is 2^k times the control point of the half at its start.
fn sum_row<W: Word>(values: &mut [W], count: usize, at: impl Fn(usize) -> usize) {
    for pass in 1..count {
        for k in (pass..count).rev() {
            let (Some(before), Some(here)) = (values.get(at(k - 1)).copied(), values.get_mut(at(k))) else { return };
            *here = here.wrapping_plus(before);
        }
    }
}

/// One half of a row of control values of degree count − 1, times 2^(count − 1).
fn halve_row<W: Word>(values: &mut [W], count: usize, half: Half, at: impl Fn(usize) -> usize) {
    let last = count.saturating_sub(1);
    let place = |k: usize| at(if half == Half::First { k } else { last - k });
    sum_row(values, count, place);
    for k in 0..count {
        if let Some(value) = values.get_mut(place(k)) {
            *value = *value << (last - k);
        }
    }
}

/// One half of a curve: control values of degree n = `values.len()` − 1 become 2^n times those of the half, exactly.
///
/// Values grow by n bits; where they outgrow the word they wrap. Cost: n(n+1)/2 additions, n shifts.
///
/// ```
/// use embedded_surfaces::subdivide::{Half, halve_curve};
/// let mut values = [0_i64, 8, 8, 0];
/// halve_curve(&mut values, Half::First);
/// assert_eq!(values, [0, 32, 48, 48]); // 8 times 0, 4, 6, 6
/// ```
pub fn halve_curve<W: Word>(values: &mut [W], half: Half) {
    let count = values.len();
    halve_row(values, count, half, |k| k);
}

/// One half of a tensor-product patch of degrees (m, h) in one direction: its (m+1)(h+1) control values, the second
/// index running fastest, become 2^m (or 2^h) times those of the half, exactly.
///
/// Values grow by m (or h) bits; where they outgrow the word they wrap. Slices of another length are left alone.
pub fn halve_tensor<W: Word>(values: &mut [W], degrees: (usize, usize), direction: Direction, half: Half) {
    let (rows, columns) = (degrees.0 + 1, degrees.1 + 1);
    if values.len() != rows * columns {
        return;
    }
    match direction {
        Direction::R => (0..columns).for_each(|b| halve_row(values, rows, half, |a| a * columns + b)),
        Direction::S => (0..rows).for_each(|a| halve_row(values, columns, half, |b| a * columns + b)),
    }
}

/// One of the four children of a triangular patch of degree n: its (n+1)(n+2)/2 control values, i descending, then j
/// descending, become 2^n times those of the child, exactly (Tian Jie, Algorithm 1, with corrected indices).
///
/// With b\[T1^i p3^j p2^k\] for the child at T1, a pass along T1T2 inserts p3 and a pass along T1T3 inserts p2; the two
/// other corners likewise. The child in the middle comes from the one at T2, because p2 = p3 + p1 − T2. All sums are
/// values of the blossom inside the triangle times at most 2^n, so values grow by n bits; where they outgrow the word
/// they wrap. Slices of another length are left alone.
///
/// ```
/// use embedded_surfaces::subdivide::{Quarter, quarter_triangle};
/// let mut corners = [0_i64, 10, 20]; // degree 1: T1, T2, T3
/// quarter_triangle(&mut corners, 1, Quarter::Centre);
/// assert_eq!(corners, [30, 20, 10]); // twice p1, p2, p3
/// ```
pub fn quarter_triangle<W: Word>(values: &mut [W], degree: usize, child: Quarter) {
    if values.len() != triangle_len(degree) {
        return;
    }
    // Rows from one corner towards another: place k steps on the way, `fixed` steps towards the third.
    match child {
        Quarter::AtU => {
            rows(values, degree, |fixed, k| triangle_index(k, fixed));
            rows(values, degree, triangle_index);
            scale(values, degree, |i, _, _| i);
        }
        Quarter::AtV | Quarter::Centre => {
            rows(values, degree, |fixed, k| triangle_index(degree - fixed - k, fixed));
            rows(values, degree, |fixed, k| triangle_index(degree - fixed - k, k));
            scale(values, degree, |_, j, _| j);
        }
        Quarter::AtW => {
            rows(values, degree, |fixed, k| triangle_index(fixed, degree - fixed - k));
            rows(values, degree, |fixed, k| triangle_index(k, degree - fixed - k));
            scale(values, degree, |_, _, k| k);
        }
    }
    if child == Quarter::Centre {
        middle(values, degree);
    }
}

/// Sums all rows of one direction.
fn rows<W: Word>(values: &mut [W], degree: usize, at: impl Fn(usize, usize) -> usize) {
    for fixed in 0..=degree {
        sum_row(values, degree - fixed + 1, |k| at(fixed, k));
    }
}

/// Doubles value (i, j, k) as often as `exponent` says.
fn scale<W: Word>(values: &mut [W], degree: usize, exponent: impl Fn(usize, usize, usize) -> usize) {
    for k in 0..=degree {
        for j in 0..=degree - k {
            if let Some(value) = values.get_mut(triangle_index(j, k)) {
                *value = *value << exponent(degree - j - k, j, k);
            }
        }
    }
}

/// The net over (p3, T2, p1) becomes the one over (p1, p2, p3): T2 is replaced by p2 = p3 + p1 − T2, once a pass.
fn middle<W: Word>(values: &mut [W], degree: usize) {
    for pass in 1..=degree {
        for j in (pass..=degree).rev() {
            for k in 0..=degree - j {
                let value = |j: usize, k: usize| values.get(triangle_index(j, k)).copied().unwrap_or(W::ZERO);
                let sum = value(j - 1, k).wrapping_plus(value(j - 1, k + 1)).wrapping_minus(value(j, k));
                if let Some(here) = values.get_mut(triangle_index(j, k)) {
                    *here = sum;
                }
            }
        }
    }
    for j in 0..=degree {
        let last = degree - j;
        for k in 0..last.div_ceil(2) {
            let (a, b) = (triangle_index(j, k), triangle_index(j, last - k));
            // Always; told to the compiler, so that no check is left.
            if a < values.len() && b < values.len() {
                values.swap(a, b);
            }
        }
    }
}
