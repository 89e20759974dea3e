//! Scenes of the rendering tests: models seen by the views of the tests, in `f64`, rounded once.
#![allow(dead_code, reason = "each test binary uses a part")]

use embedded_surfaces::geometry::Point3;
use embedded_surfaces::num::I16F16;
use embedded_surfaces::patch::BicubicPatch;
use embedded_surfaces::reference::fixed_half_up;

/// Degrees of tilt and spin, size, fraction of the screen.
#[derive(Clone, Copy)]
pub(crate) struct Look {
    pub(crate) tilt: f64,
    pub(crate) spin: f64,
    pub(crate) size: (u32, u32),
    pub(crate) fit: f64,
}

pub(crate) const VIEWS: [(f64, f64); 6] =
    [(-90.0, 0.0), (-60.0, 30.0), (-70.0, -40.0), (-20.0, 75.0), (0.0, 0.0), (-110.0, 200.0)];

impl Look {
    pub(crate) fn at((tilt, spin): (f64, f64), size: (u32, u32)) -> Self {
        Self { tilt, spin, size, fit: 0.92 }
    }

    fn turned(&self, [x, y, z]: [f64; 3]) -> [f64; 3] {
        let ((st, ct), (ss, cs)) = (self.tilt.to_radians().sin_cos(), self.spin.to_radians().sin_cos());
        let (x, y) = (x * cs - y * ss, x * ss + y * cs);
        let (y, z) = (y * ct - z * st, y * st + z * ct);
        [x, -y, -z]
    }

    /// The patches on the screen.
    pub(crate) fn see(&self, patches: &[[[f64; 3]; 16]]) -> Vec<BicubicPatch> {
        let turned: Vec<Vec<[f64; 3]>> = patches.iter().map(|p| p.iter().map(|c| self.turned(*c)).collect()).collect();
        let extreme = |axis: usize, pick: fn(f64, f64) -> f64, from: f64| {
            turned.iter().flatten().map(|p| p[axis]).fold(from, pick)
        };
        let low = [0, 1, 2].map(|axis| extreme(axis, f64::min, f64::INFINITY));
        let high = [0, 1, 2].map(|axis| extreme(axis, f64::max, f64::NEG_INFINITY));
        let (width, height) = (f64::from(self.size.0), f64::from(self.size.1));
        let scale = (width * self.fit / (high[0] - low[0])).min(height * self.fit / (high[1] - low[1]));
        let target = [width / 2.0, height / 2.0, 0.0];
        let place = |p: &[f64; 3]| {
            let c = [0, 1, 2].map(|a| fixed_half_up(target[a] + scale * (p[a] - (low[a] + high[a]) / 2.0)).unwrap());
            Point3::<I16F16>::from_array(c)
        };
        turned
            .iter()
            .map(|p| {
                BicubicPatch::new(core::array::from_fn(|i| core::array::from_fn(|j| place(&p[4 * i + j])))).unwrap()
            })
            .collect()
    }
}

/// Bicubic patches of a file of `vertices` and `patches` of 16 indices.
pub(crate) fn read(text: &str) -> Vec<[[f64; 3]; 16]> {
    let file: serde_json::Value = serde_json::from_str(text).unwrap();
    let number = |v: &serde_json::Value| v.as_f64().unwrap();
    let vertex = |i: &serde_json::Value| {
        let v = &file["vertices"][i.as_u64().unwrap() as usize];
        [number(&v[0]), number(&v[1]), number(&v[2])]
    };
    let patches = file["patches"].as_array().unwrap();
    patches.iter().map(|p| core::array::from_fn(|k| vertex(&p[k]))).collect()
}

pub(crate) fn teacup() -> Vec<[[f64; 3]; 16]> {
    read(include_str!("../data/teacup.json"))
}

pub(crate) fn teapot() -> Vec<[[f64; 3]; 16]> {
    read(include_str!("../data/teapot.json"))
}

/// A small deterministic generator for scenes that must be the same everywhere.
pub(crate) struct Random(pub(crate) u64);

impl Random {
    /// Uniform in 0 ..= 1.
    pub(crate) fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as f64 / f64::from(1_u32 << 31)
    }

    /// A point near (x, y) of a square of `size` pixels, each coordinate moved by up to `jitter` of the size.
    pub(crate) fn near(&mut self, x: f64, y: f64, size: f64, jitter: f64) -> Point3<I16F16> {
        let mut moved = |c: f64| fixed_half_up(10.0 + size * (c + jitter * (self.unit() - 0.5))).unwrap();
        Point3::new(moved(x), moved(y), moved(0.0))
    }
}
