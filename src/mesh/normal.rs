//! Normals of vertices, estimated from the faces around them.

use super::Mesh;
use crate::geometry::Vector3;
use crate::num::{
    Coord, I32F32, Sum3, Triple, UNIT, arctangent, cross, dot, length, minus, shift_half_up, shortened, unit,
};

/// The angle between two directions in 2^-64 turns, at most a half, within 2^-38 rad.
pub(crate) fn angle_between(a: &Triple, b: &Triple) -> u64 {
    let [a, b] = [a, b].map(|v| shortened(v.map(i128::from)));
    let sine = length(&shortened_by(cross(&a, &b), 62));
    arctangent(sine.min(1 << 62) as i64, (dot(&a, &b) >> 62) as i64)
}

fn shortened_by(v: [i128; 3], shift: u32) -> Triple {
    v.map(|c| (c >> shift) as i64)
}

impl<C: Coord> Mesh<'_, C> {
    /// The unit normal of a vertex, estimated: the sum of the unit normals of its faces' corners, weighted by their
    /// angles, within 2^-31. `None` where that vanishes: for a vertex without a face, or faces that cancel out.
    ///
    /// Cost: for each face two square roots, four divisions of 128 bits and an arctangent.
    ///
    /// ```
    /// # use embedded_surfaces::{geometry::{Point3, Vector3}, mesh::{Faces, Links, Mesh, MeshError}, num::{I16F16, I32F32}};
    /// let points = [[0, 0], [9, 0], [9, 9], [0, 9]].map(|[x, y]| Point3::from_ints(x, y, 0));
    /// let links = Links::<4, 4>::new(4, Faces::Quads(&[[0, 1, 2, 3]]))?;
    /// let normal = Mesh::<I16F16>::new(&points, &links)?.normal(0);
    /// assert_eq!(normal, Some(Vector3::new(I32F32::ZERO, I32F32::ZERO, I32F32::ONE)));
    /// # Ok::<(), MeshError>(())
    /// ```
    #[must_use]
    pub fn normal(&self, vertex: usize) -> Option<Vector3> {
        let normal = self.estimated_normal(vertex)?;
        Some(Vector3::from_array(normal.map(|c| I32F32::from_bits(shift_half_up(c.into(), UNIT - 32) as i64))))
    }

    /// The same in 2^-60.
    pub(crate) fn estimated_normal(&self, vertex: usize) -> Option<Triple> {
        let at = self.bits(vertex);
        let mut sum = Sum3::default();
        for half_edge in self.spokes(vertex).filter_map(|spoke| spoke.left) {
            let along = minus(&self.bits(self.tip(half_edge)), &at);
            let back = minus(&self.bits(self.origin(self.previous(half_edge))), &at);
            if let Some(normal) = unit(cross(&along, &back)) {
                // 30 bits of weight leave the sum below 2^97.
                sum.add(&normal, (angle_between(&along, &back) >> 34) as i64);
            }
        }
        // What is left of normals that cancel out is noise.
        let rest = sum.0.iter().fold(0, |all, c| all | c.unsigned_abs());
        if rest < 1 << 60 { None } else { unit(sum.0) }
    }
}
