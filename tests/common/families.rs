//! Random meshes of the families that the scheme was measured on, and regular ones.
#![allow(dead_code, reason = "each test uses its part")]

#[path = "../../examples/data/cube.rs"]
mod cube;

use super::skin::{Skin, V3, cross, dot, length, minus, plus, times, unit};
use std::collections::{BTreeSet, HashMap};
use std::f64::consts::TAU;

/// A generator of numbers (splitmix64).
pub(crate) struct Dice(pub(crate) u64);

impl Dice {
    pub(crate) fn word(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// In 0 .. 1.
    pub(crate) fn part(&mut self) -> f64 {
        (self.word() >> 11) as f64 / 9_007_199_254_740_992.0
    }

    pub(crate) fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.part()
    }

    pub(crate) fn whole(&mut self, low: usize, high: usize) -> usize {
        low + (self.word() % (high - low) as u64) as usize
    }

    pub(crate) fn normal(&mut self) -> f64 {
        (-2.0 * (1.0 - self.part()).ln()).sqrt() * (TAU * self.part()).cos()
    }

    pub(crate) fn direction(&mut self) -> V3 {
        loop {
            let v = [self.normal(), self.normal(), self.normal()];
            if length(v) > 1e-3 {
                return unit(v);
            }
        }
    }

    pub(crate) fn noise(&mut self, p: V3, size: f64) -> V3 {
        p.map(|c| c + size * self.normal())
    }
}

/// The convex hull of points in general position, and of the points on it alone.
pub(crate) fn hull(points: &[V3]) -> Skin {
    let volume = |f: &[usize; 3], p: V3| {
        let [a, b, c] = f.map(|i| points[i]);
        dot(cross(minus(b, a), minus(c, a)), minus(p, a))
    };
    let middle = times((0..4).map(|i| points[i]).fold([0.0; 3], plus), 0.25);
    let outward = |f: [usize; 3]| if volume(&f, middle) < 0.0 { f } else { [f[0], f[2], f[1]] };
    let mut faces: BTreeSet<[usize; 3]> = [[0, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3]].map(outward).into();
    for (i, p) in points.iter().enumerate().skip(4) {
        let seen: Vec<_> = faces.iter().copied().filter(|f| volume(f, *p) > 1e-14).collect();
        let edges: BTreeSet<_> = seen.iter().flat_map(|f| [(f[0], f[1]), (f[1], f[2]), (f[2], f[0])]).collect();
        faces.retain(|f| !seen.contains(f));
        faces.extend(edges.iter().filter(|(a, b)| !edges.contains(&(*b, *a))).map(|(a, b)| [*a, *b, i]));
    }
    compact(points, &faces.into_iter().collect::<Vec<_>>())
}

/// The faces with the points that they use.
fn compact(points: &[V3], faces: &[[usize; 3]]) -> Skin {
    let used: BTreeSet<_> = faces.iter().flatten().copied().collect();
    let place: HashMap<_, _> = used.iter().zip(0_u16..).collect();
    let faces = faces.iter().map(|f| f.map(|i| place[&i])).collect();
    Skin { points: used.iter().map(|i| points[*i]).collect(), faces, normals: None }
}

pub(crate) fn sphere(dice: &mut Dice, count: usize) -> Skin {
    let points: Vec<_> = (0..count).map(|_| dice.direction()).collect();
    let skin = hull(&points);
    Skin { normals: Some(skin.points.clone()), ..skin }
}

/// Of radius 1, its points as normals.
pub(crate) fn octahedron() -> Skin {
    let points = [[1., 0., 0.], [0., 1., 0.], [0., 0., 1.], [-1., 0., 0.], [0., -1., 0.], [0., 0., -1.]].to_vec();
    let faces = [[0, 1, 2], [1, 3, 2], [3, 4, 2], [4, 0, 2], [1, 0, 5], [3, 1, 5], [4, 3, 5], [0, 4, 5]].to_vec();
    Skin { normals: Some(points.clone()), points, faces }
}

pub(crate) fn cube() -> Skin {
    let corner = |i: u8| [4, 2, 1].map(|bit| if i & bit == 0 { -1.0 } else { 1.0 });
    Skin { points: (0..8).map(corner).collect(), faces: cube::TRIANGLES.to_vec(), normals: None }
}

pub(crate) fn bipyramid(count: u16) -> Skin {
    let rim = (0..count).map(|i| TAU * f64::from(i) / f64::from(count)).map(|a| [a.cos(), a.sin(), 0.0]);
    let points: Vec<_> = rim.chain([[0.0, 0.0, 1.0], [0.0, 0.0, -1.0]]).collect();
    let next = |i: u16| (i + 1) % count;
    let faces = (0..count).flat_map(|i| [[i, next(i), count], [next(i), i, count + 1]]).collect();
    Skin { normals: Some(points.clone()), points, faces }
}

pub(crate) fn torus(m: u16, n: u16) -> Skin {
    let (mut skin, mut normals) = (Skin::default(), vec![]);
    for i in 0..m {
        for j in 0..n {
            let (a, b) = (TAU * f64::from(i) / f64::from(m), TAU * f64::from(j) / f64::from(n));
            let ring = 1.0 + 0.4 * b.cos();
            skin.points.push([ring * a.cos(), ring * a.sin(), 0.4 * b.sin()]);
            normals.push([b.cos() * a.cos(), b.cos() * a.sin(), b.sin()]);
            let at = |i: u16, j: u16| (i % m) * n + j % n;
            let [p, q, r, s] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            skin.faces.extend([[p, q, r], [p, r, s]]);
        }
    }
    Skin { normals: Some(normals), ..skin }
}

/// A bumpy square, perhaps with a hole.
pub(crate) fn open(dice: &mut Dice, n: usize, hole: bool) -> Skin {
    let (mut points, mut faces) = (vec![], vec![]);
    for i in 0..n {
        for j in 0..n {
            let (x, y) = (i as f64 + dice.between(-0.3, 0.3), j as f64 + dice.between(-0.3, 0.3));
            points.push([x, y, 0.5 * x.sin() * y.cos()]);
        }
    }
    for i in 0..n - 1 {
        for j in 0..n - 1 {
            let [a, b, c, d] = [i * n + j, (i + 1) * n + j, (i + 1) * n + j + 1, i * n + j + 1];
            faces.extend(if dice.part() < 0.5 { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] });
        }
    }
    if hole {
        let vertex = (n / 2) * n + n / 2;
        faces.retain(|face: &[usize; 3]| !face.contains(&vertex));
    }
    compact(&points, &faces)
}

/// A mesh with the name of its family.
pub(crate) type Named = (&'static str, Skin);

/// `count` meshes, in turn of each family.
pub(crate) fn all(seed: u64, count: usize) -> Vec<Named> {
    let mut dice = Dice(seed);
    (0..count).map(|k| one(&mut dice, k)).collect()
}

fn noisy(dice: &mut Dice, skin: Skin, size: f64) -> Skin {
    Skin { points: skin.points.iter().map(|p| dice.noise(*p, size)).collect(), normals: None, ..skin }
}

fn one(dice: &mut Dice, k: usize) -> Named {
    let count = dice.whole(6, 41);
    match k % 14 {
        0 | 1 => ("hull", sphere(dice, count)),
        2 => {
            let skin = sphere(dice, count);
            let normals = skin.points.iter().map(|p| unit([p[0], p[1] / 0.6, p[2] / 0.3])).collect();
            let points = skin.points.iter().map(|p| [p[0], 0.6 * p[1], 0.3 * p[2]]).collect();
            ("ellipsoid", Skin { points, normals: Some(normals), ..skin })
        }
        3 | 4 => {
            let skin = sphere(dice, count);
            let size = [0.1, 0.3, 0.6][dice.whole(0, 3)];
            let normals = skin.points.iter().map(|p| unit(dice.noise(*p, size))).collect();
            ("noisy normals", Skin { normals: Some(normals), ..skin })
        }
        5 => {
            let skin = sphere(dice, count);
            let normals = skin.points.iter().map(|_| dice.direction()).collect();
            ("random normals", Skin { normals: Some(normals), ..skin })
        }
        6 | 7 => {
            let size = 10_f64.powf(dice.between(-8.0, -0.7));
            ("noisy octahedron", noisy(dice, octahedron(), size))
        }
        8 => {
            let skin = octahedron();
            let points = skin.points.iter().map(|p| times(*p, dice.between(0.5, 2.0))).collect();
            ("stretched octahedron", Skin { points, ..skin })
        }
        9 => {
            let size = [1e-6, 1e-3, 0.1][dice.whole(0, 3)];
            ("noisy cube", noisy(dice, cube(), size))
        }
        10 => {
            let (size, count) = (10_f64.powf(dice.between(-6.0, -1.0)), dice.whole(3, 17) as u16);
            ("noisy bipyramid", noisy(dice, bipyramid(count), size))
        }
        11 => {
            let skin = sphere(dice, 40);
            let points = skin.points.iter().map(|p| times(*p, dice.between(0.7, 1.3))).collect();
            ("rough", Skin { points, normals: None, ..skin })
        }
        12 => {
            let size = [0.0, 0.0, 1e-3, 0.03][dice.whole(0, 4)];
            let skin = torus(dice.whole(4, 11) as u16, dice.whole(3, 8) as u16);
            let points = skin.points.iter().map(|p| dice.noise(*p, size)).collect();
            ("torus", Skin { points, ..skin })
        }
        _ => {
            let (n, hole) = (dice.whole(4, 8), dice.part() < 0.5);
            ("open", open(dice, n, hole))
        }
    }
}
