//! The two cubic triangles of the point-by-point paper (Huang & Zhu 2002, section 4), sharing a boundary curve.
//!
//! The printed q201 = p012 + p003 − p002 has an index of sum 2; the parallelogram rule of its neighbours makes it
//! q201 = p012 + p003 − p102.

use embedded_graphics::pixelcolor::Rgb888;
use embedded_surfaces::const_net;
use embedded_surfaces::geometry::{Affine, GeometryError};
use embedded_surfaces::num::I32F32;
use embedded_surfaces::patch::CubicTriangle;
use embedded_surfaces::render::Area;

/// The picture of both views.
pub(crate) const AREA: Area = Area { x: 0, y: 0, width: 720, height: 380 };

/// The colours of P and Q.
pub(crate) const COLOURS: [Rgb888; 2] = [Rgb888::new(240, 190, 120), Rgb888::new(130, 190, 240)];

/// P and Q seen along z (x and y on the screen), then P and Q seen along x (z and y).
pub(crate) fn both_views() -> Result<[CubicTriangle; 4], GeometryError> {
    let view = |rows: [[i32; 4]; 3]| Affine { rows: rows.map(|row| row.map(I32F32::from_num)) };
    let along_z = view([[1, 0, 0, 10], [0, 1, 0, 0], [0, 0, -1, 0]]);
    let along_x = view([[0, 0, 1, 320], [0, 1, 0, 0], [1, 0, 0, 0]]);
    Ok([P.transform(&along_z)?, Q.transform(&along_z)?, P.transform(&along_x)?, Q.transform(&along_x)?])
}

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
