//! The two cubic triangles of the point-by-point paper (Huang & Zhu 2002, section 4), sharing a boundary curve.

#[path = "nets.rs"]
mod nets;

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
pub(crate) const P: CubicTriangle = const_net!(CubicTriangle::from_ints(nets::SEED_P));

/// Q, below.
pub(crate) const Q: CubicTriangle = const_net!(CubicTriangle::from_ints(nets::SEED_Q));
