//! Tessellations: no crack, no T-junction, no triangle without area, within the tolerance, few triangles.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]
#![allow(clippy::disallowed_types, clippy::float_arithmetic, reason = "an oracle in f64")]

#[path = "common/audit.rs"]
mod audit;
mod common;
#[path = "common/scene.rs"]
mod scene;

use audit::{AnyPatch, Audit, deviation, joined, mesh, numbers, units, watertight};
use common::draw::{cases, net, weights};
use common::{SEED_P, SEED_Q, coordinate, ratio, round_half_up};
use embedded_surfaces::geometry::Point3;
use embedded_surfaces::num::I16F16;
use embedded_surfaces::patch::{
    BicubicPatch, BilinearPatch, CubicTriangle, FlatTriangle, RationalTensor, Surface, Tensor, cone, cylinder, sphere,
    torus,
};
use embedded_surfaces::reference::fixed_half_up;
use embedded_surfaces::subdivide::{
    Buffer, Mesh, MeshBuffers, MeshSize, MeshVertex, PatchTopology, SubdivideError, Tolerance, tessellate,
};
use num_bigint::BigInt;
use proptest::prelude::*;
use scene::{Look, Random, teacup, teapot};

fn seed() -> [CubicTriangle; 2] {
    [SEED_P, SEED_Q].map(|points| CubicTriangle::from_ints(points).unwrap())
}

fn pot() -> Vec<BicubicPatch> {
    Look::at((-60.0, 30.0), (320, 240)).see(&teapot())
}

fn cup() -> Vec<BicubicPatch> {
    Look::at((-10.0, 30.0), (320, 240)).see(&teacup())
}

fn fixed(units: i32) -> I16F16 {
    I16F16::from_num(units)
}

/// Triangles and vertices at tolerances of 1000, 16, 4, 1 and 1/4.
type Budget = [(usize, usize); 5];

fn assert_budget<S: Surface>(name: &str, patches: &[S], euler: &[i64], budget: Budget) {
    for (tolerance, expected) in [1000.0, 16.0, 4.0, 1.0, 0.25].into_iter().zip(budget) {
        let Audit { triangles, vertices, euler: found, flat, .. } = watertight(patches, tolerance);
        assert_eq!(((triangles, vertices), &found[..], flat), (expected, euler, 0), "{name} at {tolerance}");
    }
}

#[test]
fn models_are_watertight_and_cost_what_is_written_here() {
    let [p, q] = seed();
    assert_budget("P", &[p], &[1], [(1, 3), (64, 45), (216, 131), (832, 461), (3246, 1713)]);
    assert_budget("Q", &[q], &[1], [(1, 3), (60, 43), (220, 134), (833, 464), (3277, 1733)]);
    assert_budget("P and Q", &[p, q], &[1], [(2, 4), (124, 79), (436, 250), (1666, 896), (6525, 3388)]);
    assert_budget("teapot", &pot(), &[1, 0, 0, 1], [(104, 66), (578, 317), (1856, 978), (5816, 2992), (20299, 10290)]);
    assert_budget("tea cup", &cup(), &[0, 0], [(64, 40), (328, 180), (1296, 680), (5152, 2640), (20544, 10400)]);
    let at = Point3::from_ints(70, -30, 900);
    assert_budget(
        "sphere",
        &sphere(at, fixed(100)).unwrap(),
        &[2],
        [(8, 6), (224, 114), (960, 482), (3944, 1974), (16000, 8002)],
    );
    assert_budget(
        "torus",
        &torus(at, fixed(100), fixed(50)).unwrap(),
        &[0],
        [(32, 16), (480, 240), (1728, 864), (5952, 2976), (22936, 11468)],
    );
    assert_budget(
        "cylinder",
        &cylinder(at, fixed(100), fixed(50)).unwrap(),
        &[0],
        [(8, 8), (32, 32), (64, 64), (128, 128), (256, 256)],
    );
    assert_budget(
        "cone",
        &cone(at, fixed(100), fixed(50)).unwrap(),
        &[1],
        [(4, 5), (80, 55), (192, 129), (1448, 837), (3584, 2049)],
    );
}

#[test]
fn the_seed_patches_cost_at_most_half_more_than_their_leaves() {
    // "Adaptive leaves": Algorithm 2 by displacement, without closing the gaps at T-junctions.
    for (patch, leaves) in seed().into_iter().zip([[769, 3049], [718, 2830]]) {
        for (tolerance, leaves) in [1.0, 0.25].into_iter().zip(leaves) {
            let count = mesh(&[patch], &joined(&[patch]), tolerance).count();
            assert!(2 * count <= 3 * leaves, "{count} triangles for {leaves} leaves at {tolerance}");
        }
    }
}

#[test]
fn every_point_is_within_the_tolerance() {
    let assert_close = |name: &str, tolerance: f64, off: f64| {
        println!("{name}: {:.2} of {tolerance}", off / tolerance);
        assert!(off <= tolerance + 1e-9, "{name}: {off} at {tolerance}");
        assert!(off >= 0.1 * tolerance, "{name}: {off} at {tolerance}, far too fine");
    };
    for tolerance in [16.0, 4.0, 1.0, 0.25] {
        assert_close("P and Q", tolerance, deviation(&seed(), tolerance));
    }
    for tolerance in [4.0, 1.0] {
        assert_close("teapot", tolerance, deviation(&pot(), tolerance));
        assert_close("tea cup", tolerance, deviation(&cup(), tolerance));
    }
    let at = Point3::from_ints(70, -30, 90);
    for tolerance in [16.0, 2.0, 0.25] {
        assert_close("sphere", tolerance, deviation(&sphere(at, fixed(100)).unwrap(), tolerance));
        assert_close("torus", tolerance, deviation(&torus(at, fixed(100), fixed(50)).unwrap(), tolerance));
        assert_close("cylinder", tolerance, deviation(&cylinder(at, fixed(100), fixed(50)).unwrap(), tolerance));
    }
}

#[test]
fn vertices_are_exact() {
    let (patches, pot) = (seed(), pot());
    let (table, pot_table) = (joined(&patches), joined(&pot));
    let exact = |c: f64| ratio((c * 65536.0) as i64, 65536);
    for vertex in mesh(&patches, &table, 1.0).step_by(29).flatten() {
        let net = &patches[vertex.patch];
        let [u, v] = numbers(vertex.parameters).map(exact);
        for (axis, c) in vertex.point.to_array().into_iter().enumerate() {
            let value = |i, j, k| coordinate(net.point(i, j, k).unwrap(), axis) * BigInt::from(65536);
            assert_eq!(BigInt::from(c.to_bits()), round_half_up(&common::triangle(3, value, &u, &v)));
        }
    }
    for vertex in mesh(&pot, &pot_table, 1.0).step_by(117).flatten() {
        let net = pot[vertex.patch].points();
        let [r, s] = numbers(vertex.parameters).map(exact);
        for (axis, c) in vertex.point.to_array().into_iter().enumerate() {
            let value = |i: usize, j: usize| coordinate(&net[i][j], axis) * BigInt::from(65536);
            assert_eq!(BigInt::from(c.to_bits()), round_half_up(&common::tensor((3, 3), value, &r, &s)));
        }
    }
}

// Random pairs.

/// Indices of the control points of an edge, in the numbering of the crate.
fn edge_points(triangle: bool, (m, h): (usize, usize), edge: usize) -> Vec<usize> {
    let at = |i: usize, j: usize| i * (h + 1) + j;
    match (triangle, edge) {
        (true, 0) => (0..=m).map(|k| common::triangle_index(m, (0, m - k, k))).collect(),
        (true, 1) => (0..=m).map(|k| common::triangle_index(m, (m - k, 0, k))).collect(),
        (true, _) => (0..=m).map(|k| common::triangle_index(m, (m - k, k, 0))).collect(),
        (false, 0) => (0..=h).map(|j| at(0, j)).collect(),
        (false, 1) => (0..=h).map(|j| at(m, j)).collect(),
        (false, 2) => (0..=m).map(|i| at(i, 0)).collect(),
        (false, _) => (0..=m).map(|i| at(i, h)).collect(),
    }
}

impl Random {
    fn below(&mut self, n: usize) -> usize {
        ((self.unit() * n as f64) as usize).min(n - 1)
    }

    /// A patch of about 100 units, waved by about 20.
    fn patch(&mut self, triangle: bool, degrees: (usize, usize), rational: bool) -> AnyPatch {
        let (m, h) = degrees;
        let places: Vec<[f64; 2]> = if triangle {
            let rows = (0..=m).flat_map(|row| (0..=row).map(move |k| [(m - row) as f64, (row - k) as f64]));
            rows.map(|p| p.map(|c| c / m as f64)).collect()
        } else {
            (0..=m).flat_map(|i| (0..=h).map(move |j| [i as f64 / m as f64, j as f64 / h as f64])).collect()
        };
        let mut moved = |c: f64, by: f64| fixed_half_up(100.0 * c + by * (self.unit() - 0.5)).unwrap();
        let points: Vec<_> =
            places.iter().map(|[x, y]| Point3::new(moved(*x, 20.0), moved(*y, 20.0), moved(0.0, 80.0))).collect();
        let weights =
            rational.then(|| points.iter().map(|_| fixed_half_up(0.5 + 1.5 * self.unit()).unwrap()).collect());
        AnyPatch { triangle, degrees, points, weights }
    }

    /// Two patches that share an edge.
    fn pair(&mut self) -> [AnyPatch; 2] {
        let (degree, kinds) = (1 + self.below(4), self.below(4));
        let any = |random: &mut Self, triangle: bool| {
            let other = 1 + random.below(4);
            let edge = random.below(if triangle { 3 } else { 4 });
            let degrees = if triangle {
                (degree, degree)
            } else if edge < 2 {
                (other, degree)
            } else {
                (degree, other)
            };
            let rational = random.below(3) == 0;
            (random.patch(triangle, degrees, rational), edge)
        };
        let (first, second) = (any(self, kinds & 1 == 1), any(self, kinds & 2 == 2));
        let ((a, edge), (mut b, across)) = (first, second);
        let from = edge_points(a.triangle, a.degrees, edge);
        let mut to = edge_points(b.triangle, b.degrees, across);
        if self.below(2) == 1 {
            to.reverse();
        }
        if a.weights.is_some() && b.weights.is_none() {
            b.weights = Some(vec![I16F16::ONE; b.points.len()]);
        }
        // The second patch lies beyond the edge.
        for point in &mut b.points {
            *point = Point3::new(-point.x, -point.y, point.z);
        }
        for (i, j) in from.into_iter().zip(to) {
            b.points[j] = a.points[i];
            if let Some(weights) = &mut b.weights {
                weights[j] = a.weights.as_ref().map_or(I16F16::ONE, |w| w[i]);
            }
        }
        [a, b]
    }
}

#[test]
fn two_hundred_pairs_sharing_an_edge_are_watertight_at_five_tolerances() {
    let mut random = Random(4);
    let (mut kinds, mut reversed) = ([0; 3], 0);
    for number in 0..200 {
        let pair = random.pair();
        let table = joined(&pair);
        assert!(table[0].part() == 0 && table[1].part() == 0);
        kinds[usize::from(pair[0].triangle) + usize::from(pair[1].triangle)] += 1;
        reversed += usize::from(table[0].is_inward() == table[1].is_inward());
        for tolerance in [50.0, 8.0, 3.0, 1.5, 0.75] {
            let Audit { euler, flat, .. } = watertight(&pair, tolerance);
            assert_eq!((euler, flat), (vec![1], 0), "{pair:?}");
        }
        let off = if number % 4 == 0 { deviation(&pair, 2.0) } else { 0.0 };
        assert!(off <= 2.0 + 1e-9, "{off}: {pair:?}");
    }
    assert!(kinds.iter().all(|n| *n > 30) && (50..150).contains(&reversed), "{kinds:?} {reversed}");
}

#[test]
fn neighbours_of_different_depth_have_no_crack() {
    // A flat page beside a corrugated one, in both orders: the flat one takes the other's vertices on the border.
    let flat = BilinearPatch::from_ints([[[0, 0, 0], [0, 90, 0]], [[90, 0, 0], [90, 90, 0]]]).unwrap();
    let rough = Tensor::<9, 2>::from_ints(core::array::from_fn(|i| {
        let z = if i == 0 { 0 } else { 200 * (i as i16 % 2) - 100 };
        [[90 + 20 * i as i16, 90, z], [90 + 20 * i as i16, 0, z]]
    }))
    .unwrap();
    let any = |net: embedded_surfaces::patch::SurfaceNet<'_>| AnyPatch {
        triangle: false,
        degrees: net.degrees(),
        points: net.points().to_vec(),
        weights: None,
    };
    let (flat, rough) = (any(flat.surface()), any(rough.surface()));
    let alone = watertight(std::slice::from_ref(&flat), 0.5).triangles;
    assert_eq!(alone, 2);
    // Rows of the rough one run along the border, so only its far edges are cut; turn it round for the border.
    let bent = AnyPatch {
        triangle: false,
        degrees: (3, 1),
        points: [
            [90, 0, 0],
            [180, 0, 0],
            [90, 30, 90],
            [180, 30, 0],
            [90, 60, -90],
            [180, 60, 0],
            [90, 90, 0],
            [180, 90, 0],
        ]
        .map(|[x, y, z]| Point3::from_ints(x, y, z))
        .to_vec(),
        weights: None,
    };
    let elevated = AnyPatch {
        triangle: false,
        degrees: (1, 3),
        points: [[0, 0, 0], [0, 30, 0], [0, 60, 0], [0, 90, 0], [90, 0, 0], [90, 30, 90], [90, 60, -90], [90, 90, 0]]
            .map(|[x, y, z]| Point3::from_ints(x, y, z))
            .to_vec(),
        weights: None,
    };
    for pair in [[flat.clone(), rough.clone()], [rough, flat], [bent.clone(), elevated.clone()], [elevated, bent]] {
        for tolerance in [20.0, 3.0, 0.5, 0.1] {
            assert_eq!(watertight(&pair, tolerance).euler, [1]);
        }
    }
}

#[test]
fn a_patch_may_meet_itself() {
    // A tube of one patch, and a ring of one patch closed both ways.
    let column = |x: i16, y: i16| [0, 30, 60].map(|z| [x, y, z]);
    let tube = Tensor::<4, 3>::from_ints([column(60, 0), column(-60, -150), column(-60, 150), column(60, 0)]).unwrap();
    for tolerance in [1000.0, 16.0, 1.0, 0.25] {
        let Audit { euler, flat, .. } = watertight(&[tube], tolerance);
        assert_eq!((euler, flat), (vec![0], 0), "at {tolerance}");
    }
}

#[test]
fn two_patches_may_share_all_their_edges() {
    // A pillow of two triangles, one of two squares, and a bag: two triangles that share two edges.
    let triangle = |bump: i16, third: i16| {
        let edges = [[0, 0, 0], [30, 0, 20], [0, 30, 20], [60, 0, 20], [20, 20, bump], [0, 60, 20]];
        let last = [[90, 0, 0], [60, 30, third], [30, 60, third], [0, 90, 0]];
        CubicTriangle::from_ints(core::array::from_fn(|k| if k < 6 { edges[k] } else { last[k - 6] })).unwrap()
    };
    let square = |bump: i16| {
        let inner = |i: usize, j: usize| (1..3).contains(&i) && (1..3).contains(&j);
        let z = |i, j| if inner(i, j) { bump } else { 0 };
        let point = |i: usize, j: usize| [30 * i as i16, 30 * j as i16, z(i, j)];
        BicubicPatch::from_ints(core::array::from_fn(|i| core::array::from_fn(|j| point(i, j)))).unwrap()
    };
    let pillow = [triangle(90, 20), triangle(-90, 20)];
    let bag = [triangle(90, 50), triangle(-90, -20)];
    for tolerance in [1000.0, 30.0, 8.0, 2.0, 0.5, 0.125] {
        assert_eq!(watertight(&pillow, tolerance).euler, [2], "at {tolerance}");
        assert_eq!(watertight(&bag, tolerance).euler, [1], "at {tolerance}");
        assert_eq!(watertight(&[square(90), square(-90)], tolerance).euler, [2], "at {tolerance}");
    }
}

#[test]
fn patches_may_have_two_collapsed_sides() {
    // An orange of four segments from pole to pole.
    let segment = |quarter: usize| {
        let around = [[120, 0], [120, 66], [66, 120], [0, 120]];
        let turned = |[x, y]: [i16; 2]| (0..quarter).fold([x, y], |[x, y], _| [-y, x]);
        BicubicPatch::from_ints(
            [90, 60, -60, -90]
                .map(|z: i16| around.map(|p| if z.abs() == 90 { [0, 0, z] } else { [turned(p)[0], turned(p)[1], z] })),
        )
        .unwrap()
    };
    let orange = [0, 1, 2, 3].map(segment);
    for tolerance in [1000.0, 60.0, 16.0, 4.0, 1.0, 0.25] {
        let Audit { euler, flat, border, .. } = watertight(&orange, tolerance);
        assert_eq!((euler, flat, border), (vec![2], 0, 0), "at {tolerance}");
    }
}

proptest! {
    #![proptest_config(cases(40))]
    #[test]
    fn wild_nets_of_the_whole_range_have_no_crack(
        (triangle, m, h, fine) in (any::<bool>(), 1_usize..=8, 1_usize..=8, 0..4),
        points in net::<I16F16>(81),
        weights in weights(81),
        rational in 0..4,
    ) {
        let degrees = if triangle { (m, m) } else { (m, h) };
        let count = if triangle { (m + 1) * (m + 2) / 2 } else { (m + 1) * (h + 1) };
        let weights = (rational == 0).then(|| weights[..count].to_vec());
        let patch = AnyPatch { triangle, degrees, points: points[..count].to_vec(), weights };
        let table = joined(std::slice::from_ref(&patch));
        let tolerance = I16F16::from_num(12_000 >> fine);
        match tessellate(std::slice::from_ref(&patch), &table, Tolerance::new(tolerance).unwrap()) {
            Ok(_) => {
                let audit = watertight(std::slice::from_ref(&patch), tolerance.to_num());
                prop_assert!(audit.euler[0] == 1 || audit.triangles == 0, "{audit:?}");
            }
            // Weights far apart cannot be subdivided in 31 bits.
            Err(error) => prop_assert!(matches!(error, SubdivideError::PatchTooDeep { .. }) && rational == 0, "{error}"),
        }
    }
}

// Indexed meshes.

fn with_mesh<S: Surface>(patches: &[S], tolerance: f64, check: impl FnOnce(MeshSize, Mesh<'_>)) {
    let table = joined(patches);
    let tessellation = mesh(patches, &table, tolerance);
    let size = tessellation.size();
    let (mut vertices, mut triangles) = (vec![MeshVertex::BLANK; size.vertices], vec![[0; 3]; size.triangles]);
    let mut index = vec![0; size.index];
    let buffers = MeshBuffers { vertices: &mut vertices, triangles: &mut triangles, index: &mut index };
    check(size, tessellation.mesh(buffers).unwrap());
}

#[test]
fn the_counted_size_is_the_size() {
    fn assert_size<S: Surface>(patches: &[S], tolerance: f64) {
        let table = joined(patches);
        with_mesh(patches, tolerance, |size, ours| {
            assert_eq!((ours.vertices().len(), ours.triangles().len()), (size.vertices, size.triangles), "{tolerance}");
            assert!(ours.corners().eq(mesh(patches, &table, tolerance).map(|t| t.map(|v| v.point))));
        });
    }
    let ball = sphere(Point3::ORIGIN, fixed(100)).unwrap();
    for tolerance in [1000.0, 16.0, 1.0] {
        assert_size(&seed(), tolerance);
        assert_size(&pot(), tolerance);
        assert_size(&cup(), tolerance);
        assert_size(&ball, tolerance);
        assert_size(&torus(Point3::ORIGIN, fixed(100), fixed(50)).unwrap(), tolerance);
        assert_size(&cone(Point3::ORIGIN, fixed(100), fixed(50)).unwrap(), tolerance);
    }
    // A lid's triangle whose side is collapsed.
    let sail = CubicTriangle::from_ints([
        [0, 0, 0],
        [30, 0, 20],
        [30, 10, 0],
        [60, 0, 20],
        [60, 20, -10],
        [60, 50, 9],
        [90, 9, 9],
        [90, 9, 9],
        [90, 9, 9],
        [90, 9, 9],
    ]);
    assert_size(&[sail.unwrap()], 0.5);
    // A small buffer is an error that says what is needed.
    let table = joined(&ball);
    let tessellation = mesh(&ball, &table, 1.0);
    let size = tessellation.size();
    for (short, buffer) in [Buffer::Vertices, Buffer::Triangles, Buffer::Index].into_iter().enumerate() {
        let given = [size.vertices, size.triangles, size.index];
        let has = |which: usize| given[which] - usize::from(which == short) * if which == 2 { 2 } else { 1 };
        let (mut vertices, mut triangles) = (vec![MeshVertex::BLANK; has(0)], vec![[0; 3]; has(1)]);
        let mut index = vec![0; has(2)];
        let buffers = MeshBuffers { vertices: &mut vertices, triangles: &mut triangles, index: &mut index };
        let error = tessellation.mesh(buffers).unwrap_err();
        assert_eq!(error, SubdivideError::Buffer { buffer, needed: given[short], given: has(short) });
    }
}

#[test]
fn normals_point_outwards_also_at_poles() {
    let ball = sphere(Point3::from_ints(7, 8, 9), fixed(100)).unwrap();
    with_mesh(&ball, 1.0, |_, mesh| {
        for vertex in mesh.vertices() {
            let (p, n) = (units(vertex.point), vertex.normal.to_array().map(I16F16::to_num::<f64>));
            for (k, c) in [7.0, 8.0, 9.0].into_iter().enumerate() {
                assert!((n[k] - (p[k] - c) / 100.0).abs() < 2e-3, "{vertex:?}");
            }
        }
        // Six times the volume inside the triangles, a little below that of the ball.
        let determinant = |[a, b, c]: [[f64; 3]; 3]| {
            (0..3)
                .map(|k: usize| a[k] * (b[(k + 1) % 3] * c[(k + 2) % 3] - b[(k + 2) % 3] * c[(k + 1) % 3]))
                .sum::<f64>()
        };
        let volume = mesh.corners().map(|corners| determinant(corners.map(units)) / 6.0).sum::<f64>();
        let exact = 4.0 / 3.0 * std::f64::consts::PI * 1e6;
        assert!((0.98..1.0).contains(&(volume / exact)), "{volume} of {exact}");
    });
    // The model is a mirror image on the screen: outwards stays outwards.
    with_mesh(&pot(), 1.0, |_, mesh| {
        let vertices = mesh.vertices();
        for corners in mesh.triangles() {
            let [a, b, c] = corners.map(|i| units(vertices[i as usize].point));
            let edge = |to: [f64; 3]| [0, 1, 2].map(|k: usize| to[k] - a[k]);
            let (p, q) = (edge(b), edge(c));
            let facet = [0, 1, 2].map(|k: usize| p[(k + 1) % 3] * q[(k + 2) % 3] - p[(k + 2) % 3] * q[(k + 1) % 3]);
            let length = facet.iter().map(|c| c * c).sum::<f64>().sqrt();
            for i in corners {
                let n = vertices[*i as usize].normal.to_array().map(I16F16::to_num::<f64>);
                assert!((n.iter().map(|c| c * c).sum::<f64>() - 1.0).abs() < 1e-3);
                let cosine = (0..3).map(|k| n[k] * facet[k]).sum::<f64>() / length;
                assert!(cosine > -0.2 || length < 1.0, "{n:?} against {facet:?}");
            }
        }
    });
}

#[test]
fn bad_input_is_a_typed_error() {
    let patches = [FlatTriangle::from_ints([[0, 0, 0], [9, 0, 0], [0, 9, 0]]).unwrap(); 2];
    let point = FlatTriangle::from_ints([[3, 4, 5]; 3]).unwrap();
    let (table, one) = ([PatchTopology::default(); 2], Tolerance::new(I16F16::ONE).unwrap());
    let error = |patches: &[FlatTriangle], table: &[PatchTopology], bits: i32| {
        let tolerance = Tolerance::new(I16F16::from_bits(bits));
        let error = tolerance.and_then(|tolerance| tessellate(patches, table, tolerance)).err().unwrap();
        (error, error.to_string())
    };
    let expected = SubdivideError::Tolerance { bits: 0 };
    assert_eq!(error(&patches, &table, 0), (expected, "the tolerance is not positive: 0 / 65536".into()));
    assert_eq!(error(&patches, &table, -65536).0, SubdivideError::Tolerance { bits: -65536 });
    let expected = SubdivideError::Buffer { buffer: Buffer::Topology, needed: 2, given: 1 };
    assert_eq!(
        error(&patches, &table[..1], 9),
        (expected, "the topology buffer has room for 1 entries, 2 are needed".into())
    );
    let expected = SubdivideError::Point { patch: 1 };
    assert_eq!(error(&[patches[0], point], &table, 9), (expected, "all control points of patch 1 are equal".into()));
    let steep = CubicTriangle::from_ints(SEED_P).unwrap();
    let error = tessellate(&[steep], &table, Tolerance::new(I16F16::DELTA).unwrap()).err().unwrap();
    assert_eq!(error, SubdivideError::PatchTooDeep { patch: 0, limit: 16 });
    assert_eq!(error.to_string(), "parts of patch 0 are not flat to the tolerance after 16 halvings");
    assert_eq!(tessellate::<BicubicPatch>(&[], &[], one).unwrap().count(), 0);
    // Ends of the legal range, and a needle.
    let far = BilinearPatch::from_ints([[[-32767; 3], [32767, -32767, 0]], [[-32767, 32767, 0], [32767; 3]]]).unwrap();
    assert_eq!(watertight(&[far], 20000.0).euler, [1]);
    assert_eq!(watertight(&[far], 900.0).euler, [1]);
    let folded = BilinearPatch::from_ints([[[0; 3], [90, 0, 0]], [[0, 90, 0], [90, 90, 90]]]).unwrap();
    let extreme = RationalTensor::new(folded, [[I16F16::DELTA, I16F16::MAX], [I16F16::MAX, I16F16::DELTA]]).unwrap();
    assert!(tessellate(&[extreme], &table, one).is_err());
    let line = CubicTriangle::from_ints(SEED_P.map(|[x, ..]| [x, x, x])).unwrap();
    assert!(tessellate(&[line], &table, one).unwrap().count() > 0);
}
