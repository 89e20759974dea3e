//! The view and the light of `fw_cost`'s frame, in the form that a mesh renderer wants.

use super::super::teapot;
use super::mesh::Mesh;
use embedded_graphics_core::pixelcolor::{IntoStorage, Rgb565, WebColors};
use embedded_surfaces::geometry::View;
use embedded_surfaces::graphics::Shade;
use embedded_surfaces::num::I16F16;
use embedded_surfaces::render::{Area, Light};

pub(crate) const AREA: Area = Area { x: 0, y: 0, width: 320, height: 240 };

/// Fraction bits of the matrix.
const FRACTION: u32 = 21;

/// What an author computes once for a view, or once for a picture of a turning model.
pub(crate) struct Shot {
    /// Model to screen in 2^-21.
    pub(crate) matrix: [[i32; 4]; 3],
    /// Towards the light in model coordinates, in 2^-15.
    pub(crate) light: [i32; 3],
    pub(crate) ambient: i32,
    /// The colour of each level.
    pub(crate) colours: [u16; 256],
}

impl Shot {
    pub(crate) fn new() -> Option<Self> {
        let fit = I16F16::from_bits(60_293); // 0.92
        let map = View::default().fit(teapot::vertices(), AREA.width, AREA.height, fit).ok()?;
        let turn = View::default().rotation().ok()?.rows;
        let light = Light::default();
        let [x, y, z] = light.direction().map(i64::from);
        let back = |axis: usize| {
            let of = |row: usize| turn[row][axis].to_bits();
            ((of(0) * x + of(1) * y + of(2) * z) >> 32) as i32
        };
        let colour = |level: usize| Rgb565::CSS_BURLY_WOOD.shaded(level as u8, 0, 0).into_storage();
        Some(Self {
            matrix: map.rows.map(|row| row.map(|c| (c.to_bits() >> (32 - FRACTION)) as i32)),
            light: [0, 1, 2].map(back),
            ambient: light.ambient().into(),
            colours: core::array::from_fn(colour),
        })
    }
}

/// A vertex on the screen.
#[derive(Clone, Copy)]
pub(crate) struct Corner {
    /// In 1/16 of a pixel.
    pub(crate) x: i32,
    pub(crate) y: i32,
    /// In 1/128 of a pixel from 2^15.
    pub(crate) z: i32,
    /// The level in 2^-8.
    pub(crate) level: i32,
}

impl Corner {
    pub(crate) const ZERO: Self = Self { x: 0, y: 0, z: 0, level: 0 };
}

/// Every vertex of a mesh on the screen, lit.
pub(crate) fn place(mesh: &Mesh, shot: &Shot, corners: &mut [Corner]) {
    let [mx, my, mz] = shot.matrix;
    for (corner, (point, normal)) in corners.iter_mut().zip(mesh.vertices()) {
        let [x, y, z] = point.map(i32::from);
        let row = |[a, b, c, d]: [i32; 4]| a * x + b * y + c * z + d;
        let [nx, ny, nz] = normal.map(i32::from);
        let [lx, ly, lz] = shot.light;
        let lit = ((lx * nx + ly * ny + lz * nz) >> 13).max(0);
        *corner = Corner {
            x: row(mx) >> (FRACTION - 4),
            y: row(my) >> (FRACTION - 4),
            z: (row(mz) >> (FRACTION - 7)) + (1 << 15),
            level: (shot.ambient << 8) + (((255 - shot.ambient) * lit) >> 8),
        };
    }
}
