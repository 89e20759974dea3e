//! `for_each_unordered` and `checksum`: the same multiset of points as in row order, and exact where it matters most.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod common;

use common::*;
use embedded_surfaces::forward::{Lattice, LatticePoint, Steps};
use embedded_surfaces::geometry::Point3;
use embedded_surfaces::patch::{SurfaceNet, TensorNet, TriangleNet};
use num_bigint::BigInt;
use proptest::prelude::*;

/// The points in any order, sorted, after a look at the order: whether it is that of rows.
fn check(lattice: &Lattice<'_>) -> (Vec<LatticePoint>, bool) {
    let (mut rows, mut any) = (Vec::new(), Vec::new());
    lattice.for_each(|p| rows.push(p));
    lattice.for_each_unordered(|p| any.push(p));
    let in_rows = rows == any;
    let key = |p: &LatticePoint| (p.j, p.i);
    any.sort_by_key(key);
    assert_eq!(rows, any, "{:?}", lattice.budget());
    let sum = rows.iter().fold(0_i32, |sum, p| sum.wrapping_add(p.x).wrapping_add(p.y).wrapping_add(p.z));
    assert_eq!(lattice.checksum(), sum);
    (any, in_rows)
}

fn check_net(net: SurfaceNet<'_>, steps: (u32, u32), exact: impl Fn(&LatticePoint, usize) -> BigInt) {
    for centres in [false, true] {
        let steps = Steps::new(steps.0, steps.1).unwrap();
        let lattice = if centres { Lattice::centres(net, steps) } else { Lattice::new(net, steps) };
        let Ok(lattice) = lattice else { continue };
        let (points, _) = check(&lattice);
        if !centres {
            for p in points.iter().step_by((points.len() / 12).max(1)) {
                for (axis, ours) in [p.x, p.y, p.z].into_iter().enumerate() {
                    assert_eq!(BigInt::from(ours), exact(p, axis), "axis {axis} of {p:?}, {:?}", lattice.budget());
                }
            }
        }
    }
}

/// Coordinates around the limits of all places in 32 bits.
fn coordinates() -> impl Strategy<Value = Vec<i32>> {
    let ends = |low: i32, high: i32| {
        prop_oneof![Just(low << 16), Just(high << 16), (low..=high).prop_map(|c| c << 16), (low << 16..=high << 16)]
    };
    prop_oneof![
        prop::collection::vec(ends(0, 511), 48),
        prop::collection::vec((0..=511_i32).prop_map(|c| c << 16), 48),
        prop::collection::vec(ends(-512, 511), 48),
        prop::collection::vec((-512..=512_i32).prop_map(|c| c << 16), 48),
        prop::collection::vec((-32_767..=32_767_i32).prop_map(|c| c << 16), 48),
        prop::collection::vec(ends(-32_767, 32_767), 48),
    ]
}

fn steps() -> impl Strategy<Value = u32> {
    prop_oneof![(0_u32..8).prop_map(|k| 1 << k), 1_u32..70]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(120))]

    #[test]
    fn triangles_have_the_same_points_in_any_order(bits in coordinates(), degree in 1_usize..=4, n in steps()) {
        let points = points(&bits[..3 * (degree + 1) * (degree + 2) / 2]);
        let net = SurfaceNet::Triangle(TriangleNet::new(degree, &points).unwrap());
        check_net(net, (n, n), |p, axis| {
            let at = |i, j, k| coordinate(&points[triangle_index(degree, (i, j, k))], axis);
            round_half_up(&triangle(degree, at, &ratio(p.i.into(), n.into()), &ratio(p.j.into(), n.into())))
        });
    }

    #[test]
    fn tensors_have_the_same_points_in_any_order(
        bits in coordinates(), m in 1_usize..=3, h in 1_usize..=3, r in steps(), s in steps(),
    ) {
        let points = points(&bits[..3 * (m + 1) * (h + 1)]);
        let net = SurfaceNet::Tensor(TensorNet::new((m, h), &points).unwrap());
        check_net(net, (r, s), |p, axis| {
            let at = |i: usize, j: usize| coordinate(&points[i * (h + 1) + j], axis);
            round_half_up(&tensor((m, h), at, &ratio(p.i.into(), r.into()), &ratio(p.j.into(), s.into())))
        });
    }
}

/// Whether a cubic triangle with two corners of the net's range is walked by rows.
fn is_by_rows(n: u32, low: i32, high: i32, fraction: i32) -> bool {
    let c = |k: i32| if k % 2 == 0 { low << 16 } else { (high << 16) - fraction };
    let points: Vec<_> = (0..10).map(|k| Point3::from_bits(c(k), c(k + 1), c(k * k))).collect();
    let net = SurfaceNet::Triangle(TriangleNet::new(3, &points).unwrap());
    check(&Lattice::new(net, Steps::uniform(n).unwrap()).unwrap()).1
}

#[test]
fn the_form_is_taken_where_it_applies() {
    // f = 3 log2 n bits, and the place of the coordinate: no class, 4, 16, too many.
    assert!(is_by_rows(128, 0, 511, 0), "one class is in row order");
    assert!(!is_by_rows(256, 0, 511, 0), "R = 1");
    assert!(!is_by_rows(256, -511, 511, 0), "R = 2");
    assert!(is_by_rows(256, 0, 1023, 0), "R = 8");
    assert!(is_by_rows(512, 0, 511, 0), "R = 4");
    assert!(!is_by_rows(128, 0, 511, 1 << 13), "R = 1 by three fraction bits");
    assert!(is_by_rows(256, 0, 511, 1 << 8), "eight fraction bits");
    assert!(is_by_rows(96, 0, 511, 0), "N is no power of two");
    assert!(!is_by_rows(64, -32_767, 32_767, 0), "R = 2");
    assert!(is_by_rows(128, -32_767, 32_767, 0), "R = 5");
}
