//! Quintic triangles drawn on a host with the normals that they have, and stripes that they reflect.

/// b\[i,j,k\] with i descending, then j descending.
pub(crate) type Net = [[f64; 3]; 21];

/// A turn about z, then about x.
#[derive(Clone, Copy)]
pub(crate) struct View {
    pub(crate) tilt: f64,
    pub(crate) spin: f64,
}

/// Facets a side of a triangle.
const STEPS: usize = 24;
/// Samples a side of a pixel.
const FINE: usize = 3;
/// How much of the picture the model takes.
const FIT: f64 = 0.92;
const BACKGROUND: [f64; 3] = [0.94, 0.95, 0.97];

type Vector = [f64; 3];

fn minus(a: Vector, b: Vector) -> Vector {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn cross(a: Vector, b: Vector) -> Vector {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn unit(a: Vector) -> Vector {
    let length = a.iter().map(|c| c * c).sum::<f64>().sqrt();
    a.map(|c| c / length.max(f64::MIN_POSITIVE))
}

impl View {
    /// x to the right, y up, z towards the viewer.
    fn apply(self, [x, y, z]: Vector) -> Vector {
        let ((sin, cos), (up, along)) = (self.spin.sin_cos(), self.tilt.sin_cos());
        let (x, y) = (cos * x - sin * y, sin * x + cos * y);
        [x, along * y + up * z, along * z - up * y]
    }
}

/// Point and normal by de Casteljau's algorithm.
fn sample(net: &Net, at: Vector) -> (Vector, Vector) {
    let mut points = *net;
    for degree in (1..5).rev() {
        for row in 0..=degree {
            for k in 0..=row {
                let place = |row: usize, k: usize| row * (row + 1) / 2 + k;
                let three = [points[place(row, k)], points[place(row + 1, k)], points[place(row + 1, k + 1)]];
                points[place(row, k)] = [0, 1, 2].map(|c: usize| (0..3).map(|i| at[i] * three[i][c]).sum());
            }
        }
    }
    let [a, b, c] = [points[0], points[1], points[2]];
    let point = [0, 1, 2].map(|i: usize| at[0] * a[i] + at[1] * b[i] + at[2] * c[i]);
    (point, unit(cross(minus(b, a), minus(c, a))))
}

struct Canvas {
    side: usize,
    depth: Vec<f64>,
    colour: Vec<Vector>,
    plain: bool,
}

impl Canvas {
    /// Dark and light stripes of a room, as a mirror shows them; or a matt surface.
    fn shade(&self, normal: Vector) -> Vector {
        let n = unit(normal);
        let light = unit([-0.4, 0.6, 0.8]);
        let lambert = (0..3).map(|i| n[i] * light[i]).sum::<f64>().max(0.0);
        if self.plain {
            return [0.93, 0.77, 0.55].map(|c| c * (0.25 + 0.75 * lambert));
        }
        // The viewer looks along −z: r = 2(n·v)n − v.
        let height = 2.0 * n[2] * n[1];
        let stripe = ((height.clamp(-1.0, 1.0).acos() / std::f64::consts::PI * 9.0).floor() as i64) % 2 == 0;
        let tint = if stripe { [0.98, 0.98, 0.96] } else { [0.13, 0.18, 0.30] };
        tint.map(|c| c * (0.55 + 0.45 * lambert))
    }

    /// A facet with the normals of its corners, in samples; z towards the viewer.
    fn facet(&mut self, corners: [(Vector, Vector); 3]) {
        let [a, b, c] = corners.map(|(p, _)| p);
        let area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
        if area.abs() < 1e-12 {
            return;
        }
        let low = |i: usize| a[i].min(b[i]).min(c[i]).ceil().max(0.0) as usize;
        let high = |i: usize| (a[i].max(b[i]).max(c[i]).floor().min(self.side as f64 - 1.0) + 1.0).max(0.0) as usize;
        for y in low(1)..high(1) {
            for x in low(0)..high(0) {
                let p = [x as f64, y as f64];
                let side = |q: Vector, r: Vector| (r[0] - q[0]) * (p[1] - q[1]) - (r[1] - q[1]) * (p[0] - q[0]);
                let weights = [side(b, c) / area, side(c, a) / area, side(a, b) / area];
                if weights.iter().any(|w| *w < -1e-9) {
                    continue;
                }
                let mix = |of: fn(&(Vector, Vector)) -> Vector| -> Vector {
                    [0, 1, 2].map(|i: usize| (0..3).map(|k| weights[k] * of(&corners[k])[i]).sum())
                };
                let z = mix(|corner| corner.0)[2];
                let at = y * self.side + x;
                if z > self.depth[at] {
                    self.depth[at] = z;
                    self.colour[at] = self.shade(mix(|corner| corner.1));
                }
            }
        }
    }
}

/// The picture of the nets, fitted to the points of their mesh, `size` pixels a side, row by row.
pub(crate) fn draw(nets: &[Net], points: &[Vector], view: View, size: u32, plain: bool) -> Vec<[u8; 3]> {
    let side = size as usize * FINE;
    let seen: Vec<_> = points.iter().map(|p| view.apply(*p)).collect();
    let range = |c: usize| seen.iter().fold((f64::MAX, f64::MIN), |(low, high), p| (low.min(p[c]), high.max(p[c])));
    let ((left, right), (bottom, top)) = (range(0), range(1));
    // Smooth skins bulge beyond their mesh.
    let scale = FIT * side as f64 / (1.15 * (right - left).max(top - bottom));
    let middle = side as f64 / 2.0;
    let place = |p: Vector| {
        let [x, y, z] = view.apply(p);
        [middle + scale * (x - (left + right) / 2.0), middle - scale * (y - (bottom + top) / 2.0), scale * z]
    };
    let depth = vec![f64::MIN; side * side];
    let mut canvas = Canvas { side, depth, colour: vec![BACKGROUND; side * side], plain };
    for net in nets {
        let corner = |i: usize, j: usize| {
            let at = [i, j, STEPS - i - j].map(|c| c as f64 / STEPS as f64);
            let (point, normal) = sample(net, at);
            (place(point), view.apply(normal))
        };
        for (i, j) in (0..STEPS).flat_map(|i| (0..STEPS - i).map(move |j| (i, j))) {
            canvas.facet([corner(i, j), corner(i + 1, j), corner(i, j + 1)]);
            if i + j + 1 < STEPS {
                canvas.facet([corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)]);
            }
        }
    }
    let pixel = |at: usize| {
        let (x, y) = (at % size as usize * FINE, at / size as usize * FINE);
        let samples = (0..FINE * FINE).map(|k| canvas.colour[(y + k / FINE) * side + x + k % FINE]);
        let sum = samples.fold([0.0; 3], |sum, c| [sum[0] + c[0], sum[1] + c[1], sum[2] + c[2]]);
        sum.map(|c| (c / (FINE * FINE) as f64 * 255.0).round() as u8)
    };
    (0..size as usize * size as usize).map(pixel).collect()
}
