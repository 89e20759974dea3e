//! Shade levels of every lattice point against the `f64` reference.
#![allow(clippy::unwrap_used, clippy::disallowed_types, clippy::float_arithmetic)]

use super::light::normal;
use super::pen::unturned;
use super::plan::Plan;
use super::tangents::Tangents;
use super::{Gloss, Light};
use crate::forward::{Form, Site, Steps, Visit};
use crate::num::I16F16;
use crate::patch::{BicubicPatch, BiquadraticPatch, CubicTriangle, RationalTensor, Surface, SurfaceNet};
use crate::reference;
use std::vec::Vec;

/// Collects (i, j, level, glossy level) of every point whose tangents span a plane.
struct Levels<'a>(Light, &'a mut Vec<(u32, u32, [u8; 2])>);

const GLOSS: Gloss = Gloss::new(200, 32);

impl Visit for Levels<'_> {
    const TANGENTS: bool = true;

    fn point<S: Site>(self, at: &S) -> Self {
        if let Some(normal) = normal(at.tangents()) {
            self.1.push((at.i(), at.j(), [self.0.level(normal), self.0.glossy(normal, GLOSS)]));
        }
        self
    }
}

fn cross([a, b]: [[f64; 3]; 2]) -> f64 {
    let c = [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
    c.iter().map(|x| x * x).sum::<f64>().sqrt()
}

/// The largest differences in levels, plain and glossy, where |S_r × S_s| ≥ 1e-3 of its maximum, and the points.
fn worst(net: SurfaceNet<'_>, light: Light) -> ([f64; 2], usize) {
    let steps = Steps::hole_free(net);
    let form = Form::surface(net, (steps.r(), steps.s()));
    let mut levels = Vec::new();
    Plan::of(form, true).unwrap().walk(Levels(light, &mut levels));
    let mut worst = compare(net, light, (steps.r(), steps.s()), &levels);
    // The tangents of pieces, of the lattice as it is and turned.
    for turn in 0..if net.weights().is_some() { 0 } else { 2 + u8::from(net.is_triangle()) } {
        let swapped = !net.is_triangle() && turn == 1;
        let turned = form.turned(turn, if swapped { (steps.s(), steps.r()) } else { (steps.r(), steps.s()) });
        let mut tangents = Tangents::new(net, &turned);
        let mut levels = Vec::new();
        for j in 0..=turned.last_row() {
            for i in 0..=turned.last_in_row(j) {
                let Some(normal) = normal(tangents.at(i, j)) else { continue };
                let [u, v, _] = unturned(turn, [i, j, steps.r().wrapping_sub(i + j)]);
                let (u, v) = if net.is_triangle() {
                    (u, v)
                } else if swapped {
                    (j, i)
                } else {
                    (i, j)
                };
                levels.push((u, v, [light.level(normal), light.glossy(normal, GLOSS)]));
            }
        }
        let (error, points) = compare(net, light, (steps.r(), steps.s()), &levels);
        assert_eq!(points, worst.1);
        worst.0 = [worst.0[0].max(error[0]), worst.0[1].max(error[1])];
    }
    worst
}

/// The largest differences of levels at (i/n_r, j/n_s) from the reference.
fn compare(net: SurfaceNet<'_>, light: Light, steps: (u32, u32), levels: &[(u32, u32, [u8; 2])]) -> ([f64; 2], usize) {
    let direction = light.direction().map(|c| f64::from(c) / 32768.0);
    let ambient = f64::from(light.ambient()) / 255.0;
    let at = |i: u32, j: u32| (f64::from(i) / f64::from(steps.0), f64::from(j) / f64::from(steps.1));
    let areas: Vec<f64> =
        levels.iter().map(|(i, j, _)| cross(reference::partials(net, at(*i, *j).0, at(*i, *j).1))).collect();
    let least = areas.iter().fold(0.0_f64, |a, b| a.max(*b)) * 1e-3;
    let mut worst = ([0.0_f64; 2], 0);
    for ((i, j, ours), _) in levels.iter().zip(&areas).filter(|(_, area)| **area >= least) {
        let (u, v) = at(*i, *j);
        let normal = reference::unit_normal(net, u, v).unwrap();
        let gloss = (f64::from(GLOSS.specular()), GLOSS.exponent());
        let exact =
            [reference::lambert(normal, direction, ambient), reference::blinn_phong(normal, direction, ambient, gloss)];
        for k in 0..2 {
            worst.0[k] = worst.0[k].max((f64::from(ours[k]) - exact[k]).abs());
        }
        worst.1 += 1;
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
        assert!(error[0] <= 0.6 && error[1] <= 1.6, "seed P: {error:?} levels over {points} points");
        assert!(points > 100_000);
        let mut seed = 42;
        for _ in 0..12 {
            let patch = BicubicPatch::new(core::array::from_fn(|i| {
                core::array::from_fn(|j| {
                    let mut c = |base: usize| ((base as i32 * 30) << 16) + (random(&mut seed) - (1 << 23)) / 4;
                    crate::geometry::Point3::from_bits(c(i), c(j), c(1))
                })
            }))
            .unwrap();
            let (error, points) = worst(patch.surface(), light);
            assert!(error[0] <= 0.6 && error[1] <= 1.6, "{error:?} levels over {points} points of {patch:?}");
            assert!(points > 1000);
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
    assert!(error[0] <= 0.6 && error[1] <= 1.6 && points > 1000, "{error:?} levels over {points} points");
}

/// Rational patches: an octant of a sphere, with the weights 1, 1, 2, and random weights.
#[test]
fn rational_levels_are_within_one_of_exact_arithmetic() {
    let mut seed = 7;
    let octant = [[[90, 0, 0], [90, 90, 0], [0, 90, 0]], [[90, 0, 90], [90, 90, 90], [0, 90, 90]], [[0, 0, 90]; 3]];
    let net = BiquadraticPatch::from_ints(octant).unwrap();
    let exact = [[1, 1, 2], [1, 1, 2], [2, 2, 4]].map(|row| row.map(I16F16::from_num));
    for case in 0..8 {
        let random: [[I16F16; 3]; 3] = core::array::from_fn(|_| {
            core::array::from_fn(|_| I16F16::from_bits((1 << 16) + random(&mut seed).unsigned_abs() as i32 % (3 << 16)))
        });
        let patch = RationalTensor::new(net, if case == 0 { exact } else { random }).unwrap();
        let (error, points) = worst(patch.surface(), Light::default());
        assert!(error[0] <= 0.6 && error[1] <= 1.6 && points > 1000, "{error:?} levels over {points} points");
    }
}
