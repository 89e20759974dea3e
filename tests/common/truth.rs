//! What a picture should show, in `f64`: the nearest surface at each pixel centre, and what is near a silhouette.
#![allow(dead_code, reason = "each test binary uses a part")]

use embedded_surfaces::patch::Surface;
use embedded_surfaces::reference::{Coverage, point, unit_normal};
use embedded_surfaces::render::Area;
use embedded_surfaces::subdivide::PatchTopology;
use std::collections::HashMap;

/// Points of seams, and how the patches there face.
type Seams = HashMap<[i64; 3], ([f64; 3], Vec<bool>)>;

/// Cells of a patch in each direction.
const CELLS: usize = 144;

/// The nearest surface at a pixel centre: its unit normal, `None` where it has none.
#[derive(Clone, Copy)]
pub(crate) struct Seen {
    z: f64,
    pub(crate) normal: Option<[f64; 3]>,
}

pub(crate) struct Truth {
    pub(crate) area: Area,
    /// Covered centres.
    pub(crate) coverage: Coverage,
    pub(crate) seen: Vec<Option<Seen>>,
    /// Centres within the distance of a silhouette, an open border or an uncovered centre.
    pub(crate) near: Vec<bool>,
}

/// A fine grid over a patch: the points, rows along the first parameter.
struct Mesh {
    triangle: bool,
    points: Vec<[f64; 3]>,
}

fn parameters(triangle: bool, i: usize, j: usize) -> (f64, f64) {
    let (u, v) = (i as f64 / CELLS as f64, j as f64 / CELLS as f64);
    // A triangle is the square with the side u = 1 collapsed.
    if triangle { (u, v * (1.0 - u)) } else { (u, v) }
}

impl Mesh {
    fn of(patch: &impl Surface) -> Self {
        let net = patch.surface();
        let triangle = net.is_triangle();
        let at = |k: usize| parameters(triangle, k / (CELLS + 1), k % (CELLS + 1));
        let points = (0..(CELLS + 1) * (CELLS + 1)).map(|k| point(net, at(k).0, at(k).1)).collect();
        Self { triangle, points }
    }

    fn at(&self, i: usize, j: usize) -> [f64; 3] {
        self.points[i * (CELLS + 1) + j]
    }

    /// Twice the signed area of a cell on the screen, from its diagonals.
    fn facing(&self, i: usize, j: usize) -> f64 {
        let (a, b, c, d) = (self.at(i, j), self.at(i + 1, j), self.at(i + 1, j + 1), self.at(i, j + 1));
        (c[0] - a[0]) * (d[1] - b[1]) - (c[1] - a[1]) * (d[0] - b[0])
    }

    /// The points of an edge in the order of [`PatchTopology`], and whether the cell there has a positive area.
    fn edge(&self, edge: usize) -> Vec<([f64; 3], bool)> {
        let place = |k: usize| match (self.triangle, edge) {
            (_, 0) => (0, k),
            (false, 1) => (CELLS, k),
            (false, 2) | (true, 1) => (k, 0),
            _ => (k, CELLS),
        };
        let last = CELLS - 1;
        let along = |(i, j): (usize, usize)| (self.at(i, j), self.facing(i.min(last), j.min(last)) > 0.0);
        (0..=CELLS).map(|k| along(place(k))).collect()
    }
}

impl Truth {
    pub(crate) fn of<S: Surface>(patches: &[S], topology: &[PatchTopology], area: Area, distance: f64) -> Self {
        let mut truth = Self {
            area,
            coverage: Coverage::new(area.x, area.y, area.width, area.height),
            seen: vec![None; area.pixels()],
            near: vec![false; area.pixels()],
        };
        let mut seams = HashMap::new();
        for (patch, topology) in patches.iter().zip(topology) {
            truth.add(patch, *topology, distance, &mut seams);
        }
        // Where one side of a seam looks at the viewer and the other does not, and seams cut at other places.
        for (p, sides) in seams.into_values() {
            if sides.len() < 2 || sides.iter().any(|side| *side != sides[0]) {
                truth.mark(p, distance + 0.5);
            }
        }
        truth.mark_outside(distance);
        truth
    }

    fn index(&self, x: i32, y: i32) -> Option<usize> {
        let (column, row) = (x - self.area.x, y - self.area.y);
        let inside = column >= 0 && row >= 0 && column < self.area.width as i32 && row < self.area.height as i32;
        inside.then(|| row as usize * self.area.width as usize + column as usize)
    }

    fn add<S: Surface>(&mut self, patch: &S, topology: PatchTopology, distance: f64, seams: &mut Seams) {
        let net = patch.surface();
        self.coverage.add(net, (CELLS as u32, CELLS as u32));
        let mesh = Mesh::of(patch);
        for i in 0..CELLS {
            for j in 0..CELLS {
                let (a, b, c, d) = ((i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1));
                for corners in [[a, b, c], [a, c, d]] {
                    self.add_triangle(patch, &mesh, corners);
                }
                let front = mesh.facing(i, j) > 0.0;
                let turns = (i + 1 < CELLS && (mesh.facing(i + 1, j) > 0.0) != front)
                    || (j + 1 < CELLS && (mesh.facing(i, j + 1) > 0.0) != front);
                if turns {
                    [a, b, c, d].iter().for_each(|(i, j)| self.mark(mesh.at(*i, *j), distance + 0.5));
                }
            }
        }
        for edge in 0..if net.is_triangle() { 3 } else { 4 } {
            let points = mesh.edge(edge);
            if topology.is_joined(edge) {
                for (p, positive) in points {
                    let place = seams.entry(p.map(|c| (c * 1024.0).round() as i64)).or_insert_with(|| (p, Vec::new()));
                    place.1.push(positive != topology.is_inward());
                }
            } else if points.iter().any(|p| (0..3).any(|axis| (p.0[axis] - points[0].0[axis]).abs() > 0.0)) {
                points.windows(2).for_each(|pair| self.mark_between(pair[0].0, pair[1].0, distance + 0.5));
            }
        }
    }

    fn mark(&mut self, [x, y, _]: [f64; 3], distance: f64) {
        let range = |c: f64| (c - distance).ceil() as i32..=(c + distance).floor() as i32;
        for row in range(y) {
            for column in range(x) {
                if (f64::from(column) - x).hypot(f64::from(row) - y) <= distance
                    && let Some(index) = self.index(column, row)
                {
                    self.near[index] = true;
                }
            }
        }
    }

    fn mark_between(&mut self, a: [f64; 3], b: [f64; 3], distance: f64) {
        let parts = ((b[0] - a[0]).hypot(b[1] - a[1]) * 2.0).ceil().clamp(1.0, 2000.0);
        for k in 0..=parts as u32 {
            self.mark([0, 1, 2].map(|axis| a[axis] + (b[axis] - a[axis]) * f64::from(k) / parts), distance);
        }
    }

    fn mark_outside(&mut self, distance: f64) {
        let (x0, y0) = (self.area.x, self.area.y);
        for y in y0..y0 + self.area.height as i32 {
            for x in x0..x0 + self.area.width as i32 {
                if !self.coverage.contains(x, y) {
                    self.mark([f64::from(x), f64::from(y), 0.0], distance);
                }
            }
        }
    }

    fn add_triangle<S: Surface>(&mut self, patch: &S, mesh: &Mesh, corners: [(usize, usize); 3]) {
        let [a, b, c] = corners.map(|(i, j)| mesh.at(i, j));
        let area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
        let range = |axis: usize| {
            let low = a[axis].min(b[axis]).min(c[axis]).ceil() as i32;
            low..=a[axis].max(b[axis]).max(c[axis]).floor() as i32
        };
        for y in range(1) {
            for x in range(0) {
                let (px, py) = (f64::from(x), f64::from(y));
                let weight =
                    |p: [f64; 3], q: [f64; 3]| ((q[0] - p[0]) * (py - p[1]) - (q[1] - p[1]) * (px - p[0])) / area;
                let [wa, wb, wc] = [weight(b, c), weight(c, a), weight(a, b)];
                if !(wa >= -1e-9 && wb >= -1e-9 && wc >= -1e-9) {
                    continue;
                }
                let z = wa * a[2] + wb * b[2] + wc * c[2];
                let Some(index) = self.index(x, y) else { continue };
                if self.seen[index].is_none_or(|seen| z < seen.z) {
                    let [pa, pb, pc] = corners.map(|(i, j)| parameters(mesh.triangle, i, j));
                    let u = wa * pa.0 + wb * pb.0 + wc * pc.0;
                    let v = wa * pa.1 + wb * pb.1 + wc * pc.1;
                    let normal = unit_normal(patch.surface(), u.clamp(0.0, 1.0), v.clamp(0.0, 1.0));
                    self.seen[index] = Some(Seen { z, normal });
                }
            }
        }
    }

    /// The covered centres away from silhouettes and borders, as indices.
    pub(crate) fn inner(&self) -> impl Iterator<Item = usize> {
        self.coverage.iter().filter_map(|(x, y)| self.index(x, y)).filter(|index| !self.near[*index])
    }
}
