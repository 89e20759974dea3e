//! Wavefront OBJ files: indexed meshes.

use super::Mesh;
use crate::num::{Coord, Decimal};
use core::fmt::Write;

impl Mesh<'_> {
    /// Writes an OBJ file: vertices, normals, and faces that name both by the same number.
    ///
    /// All decimals are exact.
    ///
    /// # Errors
    /// The first error of `out`.
    pub fn write_obj(&self, out: &mut impl Write) -> core::fmt::Result {
        for vertex in self.vertices() {
            let [x, y, z] = vertex.point.to_array().map(|c| Decimal(c.bits()));
            writeln!(out, "v {x} {y} {z}")?;
        }
        for vertex in self.vertices() {
            let [x, y, z] = vertex.normal.to_array().map(|c| Decimal(c.bits()));
            writeln!(out, "vn {x} {y} {z}")?;
        }
        for corners in self.triangles() {
            let [a, b, c] = corners.map(|index| u64::from(index) + 1);
            writeln!(out, "f {a}//{a} {b}//{b} {c}//{c}")?;
        }
        Ok(())
    }
}
