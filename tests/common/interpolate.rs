//! Bézier nets of polynomials that are known by their values alone: interpolation, with no rule of any construction;
//! and homogeneous coordinates.
#![allow(dead_code, reason = "each test binary uses a part")]

use super::common::{bernstein, ratio};
use embedded_surfaces::geometry::Point3;
use embedded_surfaces::num::I16F16;
use num_rational::BigRational;

/// l / m, l = 0 ..= m
pub(crate) fn parameters(m: usize) -> Vec<BigRational> {
    (0..=m).map(|l| ratio(l as i64, m as i64)).collect()
}

/// The matrix from values at l / m to Bézier coefficients: the inverse of B_i(l / m), by elimination.
pub(crate) fn to_bezier(m: usize) -> Vec<Vec<BigRational>> {
    let unit = |row: usize, i: usize| ratio(i64::from(row == i), 1);
    let mut rows: Vec<Vec<BigRational>> = parameters(m)
        .iter()
        .enumerate()
        .map(|(l, t)| (0..=m).map(|i| bernstein(m, i, t)).chain((0..=m).map(|i| unit(l, i))).collect())
        .collect();
    for pivot in 0..=m {
        let swap = (pivot..=m).find(|row| rows[*row][pivot] != ratio(0, 1)).expect("a basis");
        rows.swap(pivot, swap);
        let scale = rows[pivot][pivot].clone();
        rows[pivot].iter_mut().for_each(|x| *x /= &scale);
        let solved = rows[pivot].clone();
        for (_, row) in rows.iter_mut().enumerate().filter(|(row, _)| *row != pivot) {
            let factor = row[pivot].clone();
            row.iter_mut().zip(&solved).for_each(|(x, y)| *x -= &factor * y);
        }
    }
    rows.into_iter().map(|row| row[m + 1..].to_vec()).collect()
}

/// The Bézier coefficients of the curve with these values at l / m.
pub(crate) fn curve(matrix: &[Vec<BigRational>], values: &[BigRational]) -> Vec<BigRational> {
    let dot = |row: &Vec<BigRational>| row.iter().zip(values).fold(ratio(0, 1), |sum, (a, b)| sum + a * b);
    matrix.iter().map(dot).collect()
}

/// The Bézier coefficients of the surface with these values at (k / m, l / h), in storage order.
pub(crate) fn surface([along_r, along_s]: [&[Vec<BigRational>]; 2], values: &[Vec<BigRational>]) -> Vec<BigRational> {
    let rows: Vec<_> = values.iter().map(|row| curve(along_s, row)).collect();
    let columns: Vec<Vec<_>> = (0..along_s.len())
        .map(|j| curve(along_r, &rows.iter().map(|row| row[j].clone()).collect::<Vec<_>>()))
        .collect();
    (0..along_r.len()).flat_map(|i| columns.iter().map(move |column| column[i].clone())).collect()
}

/// B_0^m(t) ..= B_m^m(t)
pub(crate) fn bernsteins(m: usize, t: &BigRational) -> Vec<BigRational> {
    (0..=m).map(|i| bernstein(m, i, t)).collect()
}

/// Σ factor · value
pub(crate) fn dot(factors: &[BigRational], values: impl Iterator<Item = BigRational>) -> BigRational {
    factors.iter().zip(values).fold(ratio(0, 1), |sum, (f, v)| sum + f * v)
}

/// Homogeneous coordinate `axis` of a control point in raw bits: w·x, w·y, w·z, w, or without weights x, y, z, 1.
pub(crate) fn homogeneous(p: &Point3, weight: Option<I16F16>, axis: usize) -> BigRational {
    let coordinate = [p.x.to_bits(), p.y.to_bits(), p.z.to_bits(), 1][axis];
    ratio(i64::from(coordinate) * weight.map_or(1, |w| i64::from(w.to_bits())), 1)
}
