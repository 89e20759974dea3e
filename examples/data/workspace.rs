//! Buffers of an intersection for those who have a heap (examples, benchmarks, tests), and the names of what it finds.

use embedded_surfaces::intersect::{Branch, Buffers, Curve, CurveKind, CurvePoint, Room};

/// Owned buffers.
pub(crate) struct Workspace {
    vertices: Vec<[i32; 3]>,
    boxes: Vec<[[i32; 3]; 2]>,
    records: Vec<u64>,
    links: Vec<u32>,
    points: Vec<CurvePoint>,
    curves: Vec<Curve>,
    branches: Vec<Branch>,
}

impl Workspace {
    /// For patches that need this room, with so many segments of their meshes' curves, points, and curves and branches.
    pub(crate) fn new(room: &Room, segments: usize, points: usize, curves: usize) -> Self {
        Self {
            vertices: vec![[0; 3]; room.vertices],
            boxes: vec![[[0; 3]; 2]; room.boxes],
            records: vec![0; 2 * segments],
            links: vec![0; 2 * segments],
            points: vec![CurvePoint::BLANK; points],
            curves: vec![Curve::BLANK; curves],
            branches: vec![Branch::BLANK; curves],
        }
    }

    pub(crate) fn buffers(&mut self) -> Buffers<'_> {
        Buffers {
            vertices: &mut self.vertices,
            boxes: &mut self.boxes,
            records: &mut self.records,
            links: &mut self.links,
            points: &mut self.points,
            curves: &mut self.curves,
            branches: &mut self.branches,
        }
    }
}

/// The name of a kind in case files.
#[allow(dead_code, reason = "benchmarks have no need of it")]
pub(crate) fn name(kind: CurveKind) -> &'static str {
    match kind {
        CurveKind::Closed => "closed_curve",
        CurveKind::TangentPoint => "tangent_point",
        CurveKind::Tangential => "tangential_curve",
        CurveKind::SharedEdge => "shared_edge",
        CurveKind::SharedEdgeTangential => "shared_edge_tangential",
        CurveKind::EdgeOnSurface => "edge_on_surface",
        CurveKind::OverlapRegion => "overlap_region",
        _ => "open_curve",
    }
}
