//! The nets that examples, tests and measurements share, as whole numbers.
#![allow(dead_code, reason = "each user takes its part")]

/// The P of Huang and Zhu 2002, section 4: b300 first, b003 last.
#[rustfmt::skip]
pub(crate) const SEED_P: [[i16; 3]; 10] = [
    [180, 20, 150],
    [100, 60, 100], [200, 180, 380],
    [100, 120, 160], [160, 140, 400], [300, 120, 100],
    [40, 200, 60], [200, 200, 360], [100, 220, 60], [300, 200, 300],
];

/// Their Q, which shares a boundary curve with P.
///
/// The printed q201 = p012 + p003 − p002 has an index of sum 2; the parallelogram rule of its neighbours makes it
/// q201 = p012 + p003 − p102.
#[rustfmt::skip]
pub(crate) const SEED_Q: [[i16; 3]; 10] = [
    [300, 200, 300],
    [100, 220, 60], [100, 300, 260],
    [200, 200, 360], [140, 280, 20], [240, 200, 200],
    [40, 200, 60], [140, 280, 260], [50, 300, 220], [180, 360, 140],
];

/// A wavy quintic triangle of about 60 × 60 pixels.
#[rustfmt::skip]
pub(crate) const QUINTIC: [[i16; 3]; 21] = [
    [0, 0, 9],
    [12, 3, 7], [3, 11, 20],
    [25, 2, -7], [14, 13, 30], [2, 26, 1],
    [37, 4, 5], [26, 15, 12], [15, 24, 22], [1, 39, 3],
    [52, 3, 9], [38, 12, 40], [27, 26, 0], [13, 37, 17], [4, 50, 9],
    [60, 0, 2], [51, 13, 8], [40, 25, 31], [25, 38, 4], [12, 49, 9], [0, 61, 5],
];

/// A wavy bicubic patch of about 110 × 110 pixels.
pub(crate) const BICUBIC: [[[i16; 3]; 4]; 4] = [
    [[12, 7, 0], [5, 38, 60], [21, 70, -40], [9, 104, 10]],
    [[40, -3, 35], [44, 31, -50], [37, 73, 80], [42, 99, 0]],
    [[71, 11, -20], [66, 29, 90], [75, 64, -30], [68, 110, 25]],
    [[103, 2, 5], [110, 41, -60], [97, 66, 45], [106, 95, -15]],
];

/// A net at a quarter of its size, rounded towards zero.
pub(crate) const fn quartered<const N: usize>(mut points: [[i16; 3]; N]) -> [[i16; 3]; N] {
    let mut k = 0;
    while k < 3 * N {
        points[k / 3][k % 3] /= 4;
        k += 1;
    }
    points
}
