//! Midpoint subdivision (Tian Jie 1989): nets in, nets of their parts out; and what is made of it.
//!
//! | form | where | growth and error |
//! |---|---|---|
//! | exact, integers in place | [`halve_curve`], [`halve_tensor`], [`quarter_triangle`] | n more bits a level, no error |
//! | rounded, nets that own their points | `subdivide` of every net in [`crate::patch`], `bisect` of tensor-product ones | each coordinate within 2^-17 a level |
//!
//! How patches meet is found by [`topology`]; [`tessellate`] makes watertight meshes of them, as an iterator or in the
//! caller's buffers ([`Tessellation::mesh`]), and [`write_stl`], [`write_stl_text`] and [`Mesh::write_obj`] write these.
//!
//! Both sides of a shared edge get the same bits: an edge of a part depends on the control points of the edge alone.
//! Rational nets are subdivided in homogeneous coordinates, exactly, before points and weights are rounded.

mod edge;
mod error;
mod exact;
mod nets;
mod rounded;
mod tessellate;
mod topology;

pub use error::{Buffer, SubdivideError};
pub use exact::{Direction, Half, Quarter, halve_curve, halve_tensor, quarter_triangle};
pub use tessellate::{
    Mesh, MeshBuffers, MeshSize, MeshVertex, Tessellation, Vertex, tessellate, write_stl, write_stl_text,
};
pub use topology::{PatchTopology, topology};
