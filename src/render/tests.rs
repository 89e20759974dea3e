//! Shade levels of every lattice point against the `f64` reference.
#![allow(clippy::disallowed_types, clippy::float_arithmetic)]

use super::Light;
use super::light::normal;
use crate::forward::{Budget, Form, Residual, Site, Steps, Visit, Walker, tangent_bits};
use crate::patch::{BicubicPatch, CubicTriangle, Surface, SurfaceNet};
use crate::reference;
use std::vec::Vec;

/// Collects (i, j, level) of every point whose tangents span a plane.
struct Levels<'a>(Light, &'a mut Vec<(u32, u32, u8)>);

impl Visit for Levels<'_> {
    const TANGENTS: bool = true;

    fn point<S: Site>(self, at: &S) -> Self {
        if let Some(normal) = normal(at.tangents()) {
            self.1.push((at.i(), at.j(), self.0.level(normal)));
        }
        self
    }
}

fn cross([a, b]: [[f64; 3]; 2]) -> f64 {
    let c = [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
    c.iter().map(|x| x * x).sum::<f64>().sqrt()
}

/// The largest difference in levels where |S_r × S_s| ≥ 1e-3 of its maximum, and how many points that are.
fn worst(net: SurfaceNet<'_>, light: Light) -> (f64, usize) {
    let steps = Steps::hole_free(net);
    let form = Form::surface(net, (steps.r(), steps.s()));
    let budget = Budget::of(&form).unwrap();
    let mut levels = Vec::new();
    let visitor = Levels(light, &mut levels);
    if tangent_bits(&form, &budget) <= 64 && form.degree() < 4 {
        Walker::<_, 4>::new(Residual::<i64>::of(&budget), &form, &budget).visit(visitor);
    } else {
        Walker::<_, 9>::new(Residual::<i128>::of(&budget), &form, &budget).visit(visitor);
    }
    let (x, y, z) = (light.direction()[0], light.direction()[1], light.direction()[2]);
    let direction = [x, y, z].map(|c| f64::from(c) / 32768.0);
    let ambient = f64::from(light.ambient()) / 255.0;
    let at = |i: u32, j: u32| (f64::from(i) / f64::from(steps.r()), f64::from(j) / f64::from(steps.s()));
    let areas: Vec<f64> =
        levels.iter().map(|(i, j, _)| cross(reference::partials(net, at(*i, *j).0, at(*i, *j).1))).collect();
    let least = areas.iter().fold(0.0_f64, |a, b| a.max(*b)) * 1e-3;
    let mut worst = (0.0_f64, 0);
    for ((i, j, level), _) in levels.iter().zip(&areas).filter(|(_, area)| **area >= least) {
        let (u, v) = at(*i, *j);
        let exact = reference::shade(net, u, v, direction, ambient).unwrap();
        worst = (worst.0.max((f64::from(*level) - exact).abs()), worst.1 + 1);
    }
    worst
}

/// Pseudo-random bits.
fn random(seed: &mut u64) -> i32 {
    *seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
    (*seed >> 40) as i32
}

#[test]
fn levels_are_within_one_of_exact_arithmetic() {
    let seed_p = CubicTriangle::from_ints([
        [180, 20, 150],
        [100, 60, 100],
        [200, 180, 380],
        [100, 120, 160],
        [160, 140, 400],
        [300, 120, 100],
        [40, 200, 60],
        [200, 200, 360],
        [100, 220, 60],
        [300, 200, 300],
    ])
    .unwrap();
    let lights = [Light::default(), Light::towards(1, 2, -1, 0).unwrap(), Light::towards(-5, 1, 0, 9).unwrap()];
    for light in lights {
        let (error, points) = worst(seed_p.surface(), light);
        assert!(error <= 0.6 && points > 100_000, "seed P: {error} levels over {points} points");
        let mut seed = 42;
        for _ in 0..12 {
            let patch = BicubicPatch::new(core::array::from_fn(|i| {
                core::array::from_fn(|j| {
                    let mut c = |base: usize| (base as i32 * 30 << 16) + (random(&mut seed) - (1 << 23)) / 4;
                    crate::geometry::Point3::from_bits(c(i), c(j), c(1))
                })
            }))
            .unwrap();
            let (error, points) = worst(patch.surface(), light);
            assert!(error <= 0.6 && points > 1000, "{error} levels over {points} points of {patch:?}");
        }
    }
}

/// A patch with a collapsed side: next to the pole |S_r × S_s| is small but its direction is still right.
#[test]
fn poles_keep_their_precision() {
    let pole = BicubicPatch::from_ints(core::array::from_fn(|i| {
        core::array::from_fn(|j| [100 + (i * j * 12) as i16, 100 + (j * (3 - i) * 14) as i16, (j * j * 5) as i16])
    }))
    .unwrap();
    let (error, points) = worst(pole.surface(), Light::default());
    assert!(error <= 0.6 && points > 1000, "{error} levels over {points} points");
}
