//! Visibility buffers: the nearest point of every pixel, whatever the order, and its tag.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod common;

use common::*;
use embedded_surfaces::forward::{Lattice, LatticePoint, Steps, Tags, VisibilityBuffer, VisibilityError, Visible};
use embedded_surfaces::num::I16F16;
use embedded_surfaces::patch::{BilinearPatch, RationalTensorNet, Surface, SurfaceNet, TensorNet, TriangleNet};
use proptest::prelude::*;
use std::collections::BTreeMap;

const EMPTY: u32 = VisibilityBuffer::EMPTY;

/// The nearest of each pixel, of equal ones the lower tag, by sorting.
fn nearest(lattices: &[(Lattice<'_>, Tags)], (width, height): (u32, u32)) -> BTreeMap<(i32, i32), Visible> {
    let mut all: Vec<(i32, u64, LatticePoint)> = Vec::new();
    for (lattice, tags) in lattices {
        let tag = |p: &LatticePoint| {
            u64::from(tags.first) + u64::from(tags.by_i) * u64::from(p.i) + u64::from(tags.by_j) * u64::from(p.j)
        };
        all.extend(lattice.points().map(|p| (p.z, tag(&p) % 65_536, p)));
    }
    all.sort_by_key(|(z, tag, _)| (*z, *tag));
    let mut seen = BTreeMap::new();
    for (z, tag, p) in all {
        if (0..width as i32).contains(&p.x) && (0..height as i32).contains(&p.y) {
            let visible = Visible { z: i16::try_from(z).unwrap(), tag: u16::try_from(tag).unwrap() };
            seen.entry((p.x, p.y)).or_insert(visible);
        }
    }
    seen
}

fn check(lattices: &[(Lattice<'_>, Tags)], (width, height): (u32, u32)) {
    let expected = nearest(lattices, (width, height));
    let mut backward = lattices.to_vec();
    backward.reverse();
    for order in [lattices, &backward] {
        // What is behind the picture stays as it is.
        let mut entries = vec![77; (width * height) as usize + 3];
        let mut picture = VisibilityBuffer::new(&mut entries, width, height).unwrap();
        picture.clear();
        for (lattice, tags) in order {
            picture.draw(lattice, *tags);
        }
        for y in -2..height as i32 + 2 {
            for x in -2..width as i32 + 2 {
                assert_eq!(picture.get(x, y), expected.get(&(x, y)).copied(), "({x}, {y})");
            }
        }
        let filled = picture.entries().iter().filter(|entry| **entry != EMPTY).count();
        assert_eq!(filled, expected.len());
        assert_eq!(entries[(width * height) as usize..], [77; 3]);
    }
}

fn tags() -> impl Strategy<Value = Tags> {
    let by = || prop_oneof![Just(0), Just(1), 0..300_u16, any::<u16>()];
    (any::<u16>(), by(), by()).prop_map(|(first, by_i, by_j)| Tags { first, by_i, by_j })
}

/// Raw bits of 16 points in a picture of about 40 × 40 pixels, or out of it.
fn points_near(whole: bool) -> impl Strategy<Value = Vec<i32>> {
    prop_oneof![prop::collection::vec(0..=39 << 16, 48), prop::collection::vec(-9 << 16..=50 << 16, 48)]
        .prop_map(move |bits| bits.into_iter().map(|b| if whole { b >> 16 << 16 } else { b }).collect())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    #[test]
    fn the_nearest_points_stay(
        bits in prop_oneof![points_near(true), points_near(false)],
        degree in 1_usize..=3, n in prop_oneof![Just(16_u32), Just(64), 1_u32..70],
        tags in (tags(), tags(), tags()), centres: bool,
    ) {
        let points = points(&bits);
        let triangle = SurfaceNet::Triangle(TriangleNet::new(degree, &points[..(degree + 1) * (degree + 2) / 2]).unwrap());
        let tensor = TensorNet::new((degree, degree), &points[..(degree + 1) * (degree + 1)]).unwrap();
        let weights: Vec<_> = (0..tensor.points().len()).map(|k| I16F16::from_bits((3 << 16) + (k as i32 % 3) * 9999)).collect();
        let rational = RationalTensorNet::new(tensor, &weights).unwrap();
        let steps = Steps::uniform(n).unwrap();
        let lattices = [triangle, SurfaceNet::Tensor(tensor), SurfaceNet::RationalTensor(rational)].map(|net| {
            if centres { Lattice::centres(net, steps).unwrap() } else { Lattice::new(net, steps).unwrap() }
        });
        let lattices: Vec<_> = lattices.into_iter().zip([tags.0, tags.1, tags.2]).collect();
        check(&lattices, (40, 41));
        check(&lattices[..1], (40, 40));
    }
}

/// A square of `side` pixels at depth `z`.
fn level(side: i16, z: i16) -> BilinearPatch {
    BilinearPatch::from_ints([[[0, 0, z], [0, side, z]], [[side, 0, z], [side, side, z]]]).unwrap()
}

#[test]
fn depths_at_the_ends_of_the_range_are_kept() {
    let [far, near] = [level(4, 32_767), level(4, -32_767)];
    let lattice =
        |patch: &BilinearPatch| Lattice::new(patch.surface(), Steps::uniform(4).unwrap()).unwrap().budget().scale;
    assert_eq!(lattice(&far), lattice(&near));
    let mut entries = [0; 25];
    let mut picture = VisibilityBuffer::new(&mut entries, 5, 5).unwrap();
    picture.clear();
    assert_eq!((picture.get(0, 0), picture.entries()[0]), (None, EMPTY));
    for (patch, tag, z) in [(far, 65_534, 32_767), (near, 65_535, -32_767)] {
        picture.draw(&Lattice::new(patch.surface(), Steps::uniform(4).unwrap()).unwrap(), Tags::same(tag));
        assert_eq!(picture.get(4, 4), Some(Visible { z, tag }));
    }
    assert_eq!(picture.entries()[24], (1 << 16) | 65_535);
}

#[test]
fn of_equal_depths_the_lower_tag_stays() {
    let patch = level(4, 3);
    let lattice = Lattice::new(patch.surface(), Steps::uniform(4).unwrap()).unwrap();
    let mut entries = [EMPTY; 25];
    let mut picture = VisibilityBuffer::new(&mut entries, 5, 5).unwrap();
    for tag in [5, 9, 2, 4] {
        picture.draw(&lattice, Tags::same(tag));
    }
    assert_eq!(picture.get(1, 3), Some(Visible { z: 3, tag: 2 }));
}

#[test]
fn every_point_may_have_a_tag_of_its_own() {
    let patch = level(8, 0);
    let lattice = Lattice::new(patch.surface(), Steps::uniform(8).unwrap()).unwrap();
    let mut entries = [EMPTY; 81];
    VisibilityBuffer::new(&mut entries, 9, 9).unwrap().draw(&lattice, Tags { first: 100, by_i: 1, by_j: 9 });
    for (k, entry) in (100..).zip(entries) {
        assert_eq!(entry, 1 << 31 | k);
    }
    assert_eq!(Tags { first: 65_535, by_i: 2, by_j: 65_535 }.at(3, 1), 4);
}

#[test]
fn what_does_not_fit_is_refused() {
    let mut entries = [0; 12];
    let error = VisibilityBuffer::new(&mut entries, 4, 4).unwrap_err();
    assert_eq!(error, VisibilityError::Size { width: 4, height: 4, len: 12 });
    assert_eq!(error.to_string(), "a picture of 4 x 4 pixels, sides up to 32768, does not fit 12 entries");
    assert!(VisibilityBuffer::new(&mut entries, 32_769, 0).is_err());
    assert!(VisibilityBuffer::new(&mut entries, 0, 32_769).is_err());
    assert_eq!(VisibilityBuffer::new(&mut entries, 3, 4).unwrap().entries().len(), 12);
    let patch = level(4, 3);
    let lattice = Lattice::new(patch.surface(), Steps::uniform(4).unwrap()).unwrap();
    for (width, height) in [(0, 0), (0, 3), (32_768, 0)] {
        let mut none = VisibilityBuffer::new(&mut entries, width, height).unwrap();
        none.draw(&lattice, Tags::same(0));
        assert_eq!(none.get(0, 0), None);
    }
    assert_eq!(entries, [0; 12]);
}
