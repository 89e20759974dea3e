//! Blossoms (polar forms) by de Casteljau with another argument at each step, in big rationals.

use super::{ratio, triangle_index};
use num_bigint::BigInt;
use num_rational::BigRational;

/// A point of the domain triangle.
pub(crate) type Corner = [BigRational; 3];

pub(crate) fn whole(values: &[i64]) -> Vec<BigRational> {
    values.iter().map(|v| BigRational::from(BigInt::from(*v))).collect()
}

/// b[t1, ..., tn] of a curve.
pub(crate) fn curve(values: &[BigRational], arguments: &[BigRational]) -> BigRational {
    assert_eq!(values.len(), arguments.len() + 1);
    let mut row = values.to_vec();
    for t in arguments {
        row = row.windows(2).map(|pair| &pair[0] + (&pair[1] - &pair[0]) * t).collect();
    }
    row.swap_remove(0)
}

/// The control values of the part of a curve between two parameters.
pub(crate) fn curve_part(values: &[BigRational], [from, to]: [&BigRational; 2]) -> Vec<BigRational> {
    let n = values.len() - 1;
    let arguments = |i: usize| -> Vec<_> { (0..n).map(|l| if l < i { to } else { from }.clone()).collect() };
    (0..=n).map(|i| curve(values, &arguments(i))).collect()
}

/// b[p1, ..., pn] of a triangle.
pub(crate) fn triangle(values: &[BigRational], arguments: &[&Corner]) -> BigRational {
    let mut row = values.to_vec();
    for (done, [u, v, w]) in arguments.iter().enumerate() {
        let n = arguments.len() - done;
        let at = |i, j, k| &row[triangle_index(n, (i, j, k))];
        let next = super::basis::triangle_indices(n - 1)
            .map(|(i, j, k)| u * at(i + 1, j, k) + v * at(i, j + 1, k) + w * at(i, j, k + 1))
            .collect();
        row = next;
    }
    assert_eq!(row.len(), 1);
    row.swap_remove(0)
}

/// The control values over the triangle of these corners, in storage order.
pub(crate) fn triangle_part(n: usize, values: &[BigRational], corners: &[Corner; 3]) -> Vec<BigRational> {
    let arguments = |counts: [usize; 3]| -> Vec<&Corner> {
        corners.iter().zip(counts).flat_map(|(corner, count)| std::iter::repeat_n(corner, count)).collect()
    };
    super::basis::triangle_indices(n).map(|(i, j, k)| triangle(values, &arguments([i, j, k]))).collect()
}

/// The control values of the part of a tensor-product patch over a rectangle.
pub(crate) fn tensor_part(
    (m, h): (usize, usize),
    values: &[BigRational],
    r: [&BigRational; 2],
    s: [&BigRational; 2],
) -> Vec<BigRational> {
    let rows: Vec<_> = values.chunks(h + 1).map(|row| curve_part(row, s)).collect();
    let column = |j: usize| curve_part(&rows.iter().map(|row| row[j].clone()).collect::<Vec<_>>(), r);
    let columns: Vec<_> = (0..=h).map(column).collect();
    (0..=m).flat_map(|i| columns.iter().map(move |column| column[i].clone())).collect()
}

/// Half of the unit interval.
pub(crate) fn halves() -> [[BigRational; 2]; 2] {
    [[ratio(0, 1), ratio(1, 2)], [ratio(1, 2), ratio(1, 1)]]
}

/// T1, T2, T3, then the midpoints p1 of T2T3, p2 of T1T3, p3 of T1T2.
pub(crate) fn named() -> [Corner; 6] {
    let point = |twice: [i64; 3]| twice.map(|c| ratio(c, 2));
    [[2, 0, 0], [0, 2, 0], [0, 0, 2], [0, 1, 1], [1, 0, 1], [1, 1, 0]].map(point)
}

/// The corners of the four children, all with the parent's orientation: (T1, p3, p2), (p3, T2, p1), (p2, p1, T3),
/// (p1, p2, p3).
pub(crate) fn children() -> [[Corner; 3]; 4] {
    let [t1, t2, t3, p1, p2, p3] = named();
    [[t1, p3.clone(), p2.clone()], [p3.clone(), t2, p1.clone()], [p2.clone(), p1.clone(), t3], [p1, p2, p3]]
}
