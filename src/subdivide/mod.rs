//! Midpoint subdivision (Tian Jie 1989): nets in, nets of their parts out; and what is made of it.
//!
//! | form | where | growth and error |
//! |---|---|---|
//! | exact, integers in place | [`halve_curve`], [`halve_tensor`], [`quarter_triangle`] | n more bits a level, no error |
//! | rounded, nets that own their points | `subdivide` of every net in [`crate::patch`], `bisect` of tensor-product ones | each coordinate within 2^-17 a level |
//!
//! How deep to go: [`depth_for`] asks the second differences of the net, before anything is subdivided; [`is_flat`]
//! asks each part, whose displacements it tests. [`flatness`] is the bound behind the first. A [`Tolerance`] is checked
//! once; a bound does not come out too small, whatever the net.
//!
//! How patches meet is found by [`topology`]; [`tessellate`] makes watertight meshes of them, as an iterator or in the
//! caller's buffers ([`Tessellation::mesh`]), and [`write_stl`], [`write_stl_text`] and [`Mesh::write_obj`] write these.
//!
//! Both sides of a shared edge get the same bits: an edge of a part depends on the control points of the edge alone.
//! Rational nets are subdivided in homogeneous coordinates, exactly, before points and weights are rounded.
//!
//! # Subdivision against degree elevation
//! Both make control nets that converge to the patch. Below is the largest distance, in units, of a control point from
//! the surface at the point's own parameters (i/n, j/n, k/n), for the cubic triangle P of Huang and Zhu 2002. Both nets
//! of a row have as many different points.
//!
//! | control points | elevated to degree | distance | subdivided, times | distance |
//! |---|---|---|---|---|
//! | 10 | 3 | 171.055 | 0 | 171.055 |
//! | 28 | 6 | 54.336 | 1 | 50.322 |
//! | 91 | 12 | 21.222 | 2 | 13.904 |
//! | 325 | 24 | 9.738 | 3 | 3.648 |
//! | 1225 | 48 | 4.635 | 4 | 0.934 |
//! | 4753 | 96 | 2.264 | 5 | 0.236 |
//!
//! In the limit elevation halves the distance where the degree doubles; subdivision quarters it for as many points.
//!
#![doc = include_str!("../../docs/img/convergence.md")]
//!
//! *The first four rows: elevated to degree 3, 6, 12 and 24 above, subdivided 0 to 3 times below.*
//!
//! [`depth_for`]: crate::patch::SurfaceNet::depth_for
//! [`is_flat`]: crate::patch::SurfaceNet::is_flat
//! [`flatness`]: crate::patch::SurfaceNet::flatness

mod bounds;
mod curvature;
mod edge;
mod error;
mod exact;
mod flat;
mod nets;
mod rounded;
mod stencil;
mod tessellate;
mod topology;

pub use bounds::{MAX_DEPTH, depth_by_edges};
pub use error::{Buffer, SubdivideError};
pub use exact::{Direction, Half, Quarter, halve_curve, halve_tensor, quarter_triangle};
pub use flat::Tolerance;
pub use tessellate::{
    Mesh, MeshBuffers, MeshSize, MeshVertex, Tessellation, Vertex, tessellate, write_stl, write_stl_text,
};
pub use topology::{PatchTopology, topology};

pub(crate) use rounded::{Cut, Source, are_near, part_net};
