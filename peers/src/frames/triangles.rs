//! `embedded-graphics` as it is: flat filled triangles, far ones first, into a picture that fills whole runs.

use super::mesh::{MOST_TRIANGLES, Mesh};
use super::view::{AREA, Corner};
use core::convert::Infallible;
use embedded_graphics::pixelcolor::{IntoStorage, Rgb565, raw::RawU16};
use embedded_graphics::prelude::*;
use embedded_graphics::primitives::{PrimitiveStyle, Rectangle, Triangle};

const WIDTH: usize = AREA.width as usize;

/// A picture as a target.
pub(crate) struct Target<'a>(pub(crate) &'a mut [u16; AREA.pixels()]);

impl OriginDimensions for Target<'_> {
    fn size(&self) -> Size {
        Size::new(AREA.width, AREA.height)
    }
}

impl DrawTarget for Target<'_> {
    type Color = Rgb565;
    type Error = Infallible;

    fn draw_iter<I: IntoIterator<Item = Pixel<Rgb565>>>(&mut self, pixels: I) -> Result<(), Infallible> {
        for Pixel(at, colour) in pixels {
            if (at.x as u32) < AREA.width
                && let Some(pixel) = self.0.get_mut(at.y as usize * WIDTH + at.x as usize)
            {
                *pixel = colour.into_storage();
            }
        }
        Ok(())
    }

    fn fill_solid(&mut self, area: &Rectangle, colour: Rgb565) -> Result<(), Infallible> {
        let area = area.intersection(&self.bounding_box());
        let (x, y) = (area.top_left.x as usize, area.top_left.y as usize);
        for row in y..y + area.size.height as usize {
            let start = row * WIDTH + x;
            if let Some(pixels) = self.0.get_mut(start..start + area.size.width as usize) {
                pixels.fill(colour.into_storage());
            }
        }
        Ok(())
    }
}

const BUCKETS: usize = 512;
/// No triangle.
pub(crate) const NONE: u16 = u16::MAX;

/// Lists of triangles, by depth or by band.
pub(crate) struct Order {
    pub(crate) first: [u16; BUCKETS],
    pub(crate) next: [u16; MOST_TRIANGLES],
}

impl Order {
    pub(crate) const EMPTY: Self = Self { first: [0; BUCKETS], next: [0; MOST_TRIANGLES] };

    pub(crate) fn push(&mut self, bucket: usize, index: u16) {
        self.next[usize::from(index)] = self.first[bucket];
        self.first[bucket] = index;
    }
}

/// Draws a mesh from behind.
pub(crate) fn draw(mut screen: Target<'_>, mesh: &Mesh, corners: &[Corner], order: &mut Order, colours: &[u16; 256]) {
    order.first.fill(NONE);
    let of = |indices: &[u16; 3]| indices.map(|index| &corners[usize::from(index)]);
    for (index, triangle) in mesh.triangles().iter().enumerate() {
        let [a, b, c] = of(triangle);
        if (b.x - a.x) * (c.y - a.y) <= (c.x - a.x) * (b.y - a.y) {
            continue;
        }
        // The depths are 2^14 around 2^15; three of them, in steps of 3/2 pixels.
        let bucket = ((a.z + b.z + c.z) as usize / 192).min(BUCKETS - 1);
        order.push(bucket, index as u16);
    }
    for first in order.first.iter().rev() {
        let mut index = *first;
        while index != NONE {
            let [a, b, c] = of(&mesh.triangles()[usize::from(index)]);
            let level = (a.level + b.level + c.level) as usize / 768;
            let colour = Rgb565::from(RawU16::new(colours[level]));
            let point = |corner: &Corner| Point::new((corner.x + 8) >> 4, (corner.y + 8) >> 4);
            let triangle = Triangle::new(point(a), point(b), point(c));
            let Ok(()) = triangle.into_styled(PrimitiveStyle::with_fill(colour)).draw(&mut screen);
            index = order.next[usize::from(index)];
        }
    }
}
