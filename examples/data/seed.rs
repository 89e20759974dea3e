//! The two cubic triangles of the point-by-point paper (Huang & Zhu 2002, section 4), sharing a boundary curve.
//!
//! The printed q201 = p012 + p003 − p002 has an index of sum 2; the parallelogram rule of its neighbours makes it
//! q201 = p012 + p003 − p102.

use embedded_surfaces::const_net;
use embedded_surfaces::patch::CubicTriangle;

/// P, above.
#[rustfmt::skip]
pub(crate) const P: CubicTriangle = const_net!(CubicTriangle::from_ints([
    [180, 20, 150],
    [100, 60, 100], [200, 180, 380],
    [100, 120, 160], [160, 140, 400], [300, 120, 100],
    [40, 200, 60], [200, 200, 360], [100, 220, 60], [300, 200, 300],
]));

/// Q, below.
#[rustfmt::skip]
pub(crate) const Q: CubicTriangle = const_net!(CubicTriangle::from_ints([
    [300, 200, 300],
    [100, 220, 60], [100, 300, 260],
    [200, 200, 360], [140, 280, 20], [240, 200, 200],
    [40, 200, 60], [140, 280, 260], [50, 300, 220], [180, 360, 140],
]));
