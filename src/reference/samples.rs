//! Random nets for the tests of this module.

use crate::geometry::Point3;
use crate::patch::{SurfaceNet, TensorNet, TriangleNet};
use proptest::prelude::*;
use std::vec::Vec;

/// A net with its points on the heap; the second degree is `None` for a triangle.
#[derive(Clone, Debug)]
pub(super) struct Net {
    degrees: (usize, Option<usize>),
    pub(super) points: Vec<Point3>,
}

impl Net {
    pub(super) fn is_triangle(&self) -> bool {
        self.degrees.1.is_none()
    }

    pub(super) fn surface(&self) -> SurfaceNet<'_> {
        match self.degrees {
            (n, None) => SurfaceNet::Triangle(TriangleNet::new(n, &self.points).unwrap()),
            (m, Some(h)) => SurfaceNet::Tensor(TensorNet::new((m, h), &self.points).unwrap()),
        }
    }
}

/// Nets of both kinds, of degree up to `highest`, with coordinate bits up to `limit`.
pub(super) fn nets(highest: usize, limit: i32) -> impl Strategy<Value = Net> {
    (1..=highest, proptest::option::of(1..=highest)).prop_flat_map(move |(m, h)| {
        let count = h.map_or((m + 1) * (m + 2) / 2, |h| (m + 1) * (h + 1));
        let c = -limit..=limit;
        let point = (c.clone(), c.clone(), c).prop_map(|(x, y, z)| Point3::from_bits(x, y, z));
        proptest::collection::vec(point, count).prop_map(move |points| Net { degrees: (m, h), points })
    })
}
