//! How patches meet: classes, parts and orientation against slow, separate searches over the same nets.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]
#![allow(clippy::disallowed_types, clippy::float_arithmetic, reason = "an oracle in f64")]

#[path = "common/scene.rs"]
mod scene;

use embedded_surfaces::const_net;
use embedded_surfaces::geometry::Point3;
use embedded_surfaces::num::I16F16;
use embedded_surfaces::patch::{
    BicubicPatch, BilinearPatch, CubicTriangle, FlatTriangle, RationalTensor, Surface, SurfaceNet, Tensor, cylinder,
    sphere, torus,
};
use embedded_surfaces::subdivide::{Buffer, PatchTopology, SubdivideError, topology};
use scene::{Look, teacup, teapot};
use std::collections::BTreeMap;

fn of<S: Surface>(patches: &[S]) -> Result<Vec<PatchTopology>, SubdivideError> {
    let mut out = vec![PatchTopology::default(); patches.len()];
    topology(patches, &mut out)?;
    Ok(out)
}

type Curve = Vec<(Point3, i32)>;

/// The control polygons of the edges of a bicubic patch, in the numbering of the crate.
fn curves(patch: &BicubicPatch) -> [Curve; 4] {
    let p = patch.points();
    let of = |pick: fn(&[[Point3; 4]; 4], usize) -> Point3| (0..4).map(|k| (pick(p, k), 1)).collect();
    [of(|p, k| p[0][k]), of(|p, k| p[3][k]), of(|p, k| p[k][0]), of(|p, k| p[k][3])]
}

fn same(a: &Curve, b: &Curve) -> bool {
    let collapsed = a.iter().all(|p| *p == a[0]);
    !collapsed && (a == b || a.iter().eq(b.iter().rev()))
}

/// Classes by repeated painting: the smallest name spreads until nothing changes.
fn painted(patches: &[BicubicPatch]) -> Vec<[u16; 4]> {
    let edges: Vec<_> = patches.iter().flat_map(curves).collect();
    let mut names: Vec<usize> = (0..edges.len()).collect();
    loop {
        let before = names.clone();
        for a in 0..edges.len() {
            for b in 0..edges.len() {
                if a ^ b == 1 || same(&edges[a], &edges[b]) {
                    let least = names[a].min(names[b]);
                    (names[a], names[b]) = (least, least);
                }
            }
        }
        if names == before {
            break;
        }
    }
    let mut numbers = BTreeMap::new();
    for name in &names {
        let next = numbers.len() as u16;
        numbers.entry(*name).or_insert(next);
    }
    names.chunks(4).map(|c| [0, 1, 2, 3].map(|e| numbers[&c[e]])).collect()
}

/// A coarse mesh of the patches, oriented by the topology: how often a directed edge between neighbours occurs.
fn directed_edges(patches: &[BicubicPatch], table: &[PatchTopology]) -> BTreeMap<[[i32; 3]; 2], usize> {
    let mut count = BTreeMap::new();
    for (patch, topology) in patches.iter().zip(table) {
        let p = patch.points().map(|row| row.map(|p| p.to_array().map(I16F16::to_bits)));
        let ring = [(0, 0), (1, 0), (2, 0), (3, 0), (3, 1), (3, 2), (3, 3), (2, 3), (1, 3), (0, 3), (0, 2), (0, 1)];
        for k in 0..12 {
            let (a, b) = (ring[k], ring[(k + 1) % 12]);
            let edge = [p[a.0][a.1], p[b.0][b.1]];
            let edge = if topology.is_inward() { [edge[1], edge[0]] } else { edge };
            if edge[0] != edge[1] {
                *count.entry(edge).or_default() += 1;
            }
        }
    }
    count
}

#[test]
fn models_have_the_classes_and_a_consistent_orientation() {
    let views = [(-90.0, 0.0), (-60.0, 30.0)];
    for (model, patches, parts) in [("teapot", teapot(), 4), ("teacup", teacup(), 2)] {
        for view in views {
            let patches = Look::at(view, (640, 480)).see(&patches);
            let table = of(&patches).unwrap();
            assert_eq!(table.iter().map(PatchTopology::classes).collect::<Vec<_>>(), painted(&patches), "{model}");
            assert_eq!(table.iter().map(PatchTopology::part).max(), Some(parts - 1), "{model}");
            let edges = directed_edges(&patches, &table);
            assert!(edges.values().all(|n| *n == 1), "{model}: neighbours run the same way");
            let curves: Vec<_> = patches.iter().map(curves).collect();
            for (p, topology) in table.iter().enumerate() {
                for e in 0..4 {
                    let twins = curves.iter().flatten().filter(|c| same(&curves[p][e], c)).count();
                    assert_eq!(topology.is_joined(e), twins == 2, "{model}: edge {e} of patch {p}");
                }
            }
        }
    }
}

#[test]
fn solids_are_oriented_outwards_however_their_patches_are_turned() {
    fn check<const P: usize>(patches: [RationalTensor<3, 3>; P]) {
        for turned in 0..1_usize << P.min(6) {
            let patches: Vec<_> =
                patches.iter().enumerate().map(|(p, patch)| mirrored(patch, turned >> p & 1 == 1)).collect();
            for (p, topology) in of(&patches).unwrap().iter().enumerate() {
                assert_eq!(topology.is_inward(), turned >> p & 1 == 1);
                assert_eq!(topology.part(), 0);
                assert_eq!(topology.flipped().is_inward(), !topology.is_inward());
            }
        }
    }
    let (at, one) = (Point3::from_ints(70, -30, 900), I16F16::ONE);
    check(sphere(at, 60 * one).unwrap());
    check(torus(at, 60 * one, 20 * one).unwrap());
    check(cylinder(at, 20 * one, 90 * one).unwrap());
}

/// The same surface, its parameters exchanged.
fn mirrored(patch: &RationalTensor<3, 3>, turn: bool) -> RationalTensor<3, 3> {
    if !turn {
        return *patch;
    }
    let (net, weights) = (patch.net(), patch.weights());
    let points: [[Point3; 3]; 3] = core::array::from_fn(|i| core::array::from_fn(|j| net.points()[3 * j + i]));
    let weights = core::array::from_fn(|i| core::array::from_fn(|j| weights[j][i]));
    RationalTensor::new(Tensor::<3, 3>::new(points).unwrap(), weights).unwrap()
}

fn quad(a: [i16; 3], b: [i16; 3], c: [i16; 3], d: [i16; 3]) -> BilinearPatch {
    BilinearPatch::from_ints([[a, b], [c, d]]).unwrap()
}

#[test]
fn one_sided_surfaces_are_refused() {
    // Six quads around a band, the last joined to the first as it is, or crosswise.
    let ring = [[30, 0], [15, 26], [-15, 26], [-30, 0], [-15, -26], [15, -26]];
    let rung = |k: usize| [0, 9].map(|z| [ring[k % 6][0], ring[k % 6][1], z]);
    let band = |twist: bool| {
        let strip: Vec<_> = (0..6)
            .map(|k| {
                let ([a, b], [c, d]) = (rung(k), rung(k + 1));
                if twist && k == 5 { quad(a, b, d, c) } else { quad(a, b, c, d) }
            })
            .collect();
        of(&strip)
    };
    assert!(band(false).is_ok());
    let Err(error) = band(true) else { panic!("a Möbius band passed") };
    assert_eq!(error, SubdivideError::NotOrientable { patch: 5 });
    assert!(error.to_string().contains("patch 5"));
    // One patch that meets itself, round a tube and crosswise.
    let column = |z: [i16; 3]| z.map(|z| [9, 0, z]);
    let tube = |last: [[i16; 3]; 3]| {
        let middle = |y: i16| [0, 5, 9].map(|z| [-9, y, z]);
        Tensor::<4, 3>::from_ints([column([0, 5, 9]), middle(-20), middle(20), last]).unwrap()
    };
    let table = of(&[tube(column([0, 5, 9]))]).unwrap();
    assert!(
        table[0].is_joined(0) && table[0].is_joined(1) && !table[0].is_joined(2) && table[0].classes() == [0, 0, 1, 1]
    );
    assert_eq!(of(&[tube(column([9, 5, 0]))]), Err(SubdivideError::NotOrientable { patch: 0 }));
}

#[test]
fn kinds_mix_and_a_third_patch_on_a_curve_is_a_part_of_its_own() {
    const TRIANGLE: FlatTriangle = const_net!(FlatTriangle::from_ints([[0, 0, 9], [0, 0, 0], [9, 0, 0]]));
    const PAGE: BilinearPatch = const_net!(BilinearPatch::from_ints([[[9, 0, 0], [9, 9, 0]], [[0, 0, 0], [0, 9, 0]]]));
    const OTHER: BilinearPatch =
        const_net!(BilinearPatch::from_ints([[[0, 0, 0], [9, 0, 0]], [[0, -9, 0], [9, -9, 0]]]));
    const NETS: [SurfaceNet<'static>; 3] =
        [SurfaceNet::Triangle(TRIANGLE.net()), SurfaceNet::Tensor(PAGE.net()), SurfaceNet::Tensor(OTHER.net())];
    static TABLE: [PatchTopology; 3] = const_net!(PatchTopology::of_nets(&NETS));
    assert_eq!(TABLE.map(|t| t.part()), [0, 0, 1]);
    assert_eq!(TABLE.map(|t| t.classes()), [[0; 4], [1, 1, 0, 0], [0, 0, 2, 2]]);
    assert_eq!(of(&NETS).unwrap(), TABLE);
    assert!(TABLE[0].is_joined(0) && TABLE[1].is_joined(2) && !TABLE[2].is_joined(0));
}

#[test]
fn what_is_out_of_reach_is_refused() {
    let patches = [CubicTriangle::from_ints([[0; 3]; 10]).unwrap(); 3];
    let error = topology(&patches, &mut [PatchTopology::default(); 2]).unwrap_err();
    assert_eq!(error, SubdivideError::Buffer { buffer: Buffer::Topology, needed: 3, given: 2 });
    assert_eq!(error.to_string(), "the topology buffer has room for 2 entries, 3 are needed");
    // Points only: nothing is joined, nothing has a volume.
    let table = of(&patches).unwrap();
    assert!(table.iter().enumerate().all(|(p, t)| t.part() == p && !t.is_inward() && !(0..5).any(|e| t.is_joined(e))));
    let many = vec![patches[0]; 16385];
    assert_eq!(of(&many), Err(SubdivideError::TooManyPatches { given: 16385, most: 16384 }));
    assert_eq!(of::<BicubicPatch>(&[]), Ok(Vec::new()));
}
