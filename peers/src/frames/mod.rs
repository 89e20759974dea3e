//! One frame, drawn by each peer from the same mesh: the vertices are placed and lit, the picture is cleared, the
//! triangles are drawn. All of that is counted.

pub(crate) mod fixed;
pub(crate) mod float;
#[cfg(all(target_abi = "eabihf", target_os = "none"))]
mod gfx3d;
pub(crate) mod mesh;
pub(crate) mod triangles;
pub(crate) mod view;

use super::counter;
use super::room;
use core::fmt::{Error, Result, Write};
use core::hint::black_box;
use mesh::{MOST_VERTICES, Mesh};
use view::{AREA, Corner, Shot};

/// A picture and its depths.
pub(crate) struct Screen {
    pub(crate) colour: [u16; AREA.pixels()],
    pub(crate) depth: [u16; AREA.pixels()],
}

impl Screen {
    pub(crate) const EMPTY: Self = Self { colour: [0; AREA.pixels()], depth: [0; AREA.pixels()] };

    fn clear(&mut self) {
        self.colour.fill(0);
        self.depth.fill(u16::MAX);
    }
}

/// Pixels that are not black, and a checksum of all.
fn seen(colour: &[u16]) -> (usize, i32) {
    let sum = colour.iter().fold(0_u32, |sum, c| (sum.rotate_left(5) ^ u32::from(*c)).wrapping_mul(0x0100_0193));
    (colour.iter().filter(|c| **c != 0).count(), sum as i32)
}

/// What all peers work on.
pub(crate) struct Studio {
    screen: Screen,
    mesh: Mesh,
    corners: [Corner; MOST_VERTICES],
    floats: [float::Corner; MOST_VERTICES],
    order: triangles::Order,
}

impl Studio {
    pub(crate) const EMPTY: Self = Self {
        screen: Screen::EMPTY,
        mesh: Mesh::EMPTY,
        corners: [Corner::ZERO; MOST_VERTICES],
        floats: [float::Corner::ZERO; MOST_VERTICES],
        order: triangles::Order::EMPTY,
    };

    /// Bakes the mesh, draws it by each peer, and gives away name, instructions and picture.
    pub(crate) fn draw_all(&mut self, mut done: impl FnMut(&str, u32, &[u16]) -> Result) -> Result {
        let Self { screen, mesh, corners, floats, order } = self;
        let shot = black_box(Shot::new().ok_or(Error)?);
        let float_shot = float::Shot::of(&shot);
        mesh.bake();
        let counted = counter::count(|| {
            screen.clear();
            view::place(mesh, &shot, corners);
            for indices in mesh.triangles() {
                let corners = indices.map(|index| &corners[usize::from(index)]);
                fixed::triangle::<false>(screen, &(0..0), corners, &shot.colours);
            }
        });
        done("scanlines in fixed point", counted, &screen.colour)?;
        let mut counted = counter::count(|| {
            view::place(mesh, &shot, corners);
            fixed::sort(mesh, corners, order);
        });
        for band in 0..fixed::BANDS {
            counted += counter::count(|| fixed::draw_band(screen, band, (mesh, corners), order, &shot.colours));
        }
        done("scanlines in fixed point, bands of 16 rows", counted, &screen.colour)?;
        let counted = counter::count(|| {
            screen.clear();
            float::place(mesh, &float_shot, floats);
            for indices in mesh.triangles() {
                float::triangle(screen, indices.map(|index| &floats[usize::from(index)]), &shot.colours);
            }
        });
        done("scanlines in f32", counted, &screen.colour)?;
        let counted = counter::count(|| {
            screen.colour.fill(0);
            view::place(mesh, &shot, corners);
            triangles::draw(triangles::Target(&mut screen.colour), mesh, corners, order, &shot.colours);
        });
        done("triangles of embedded-graphics", counted, &screen.colour)?;
        #[cfg(all(target_abi = "eabihf", target_os = "none"))]
        {
            let counted = gfx3d::draw(screen, mesh, &shot)?;
            done("embedded-3dgfx", counted, &screen.colour)?;
        }
        Ok(())
    }
}

/// Writes a line per frame.
pub(crate) fn report(out: &mut impl Write) -> Result {
    let studio = room::room!(Studio, Studio::EMPTY);
    studio.draw_all(|name, instructions, colour| {
        let (lit, sum) = seen(colour);
        writeln!(out, "frame, {name}: {instructions} instructions, {lit} points, sum {sum}")
    })
}
