//! Exact midpoint subdivision against blossoms in big rationals; orientation; and the paper's Algorithm 1 as printed,
//! which must fail.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod common;

use common::basis::triangle_indices;
use common::blossom::{self, Corner, whole};
use common::{ratio, triangle_index};
use embedded_surfaces::subdivide::{Direction, Half, Quarter, halve_curve, halve_tensor, quarter_triangle};
use num_bigint::BigInt;
use num_rational::BigRational;
use proptest::prelude::*;
use std::collections::BTreeMap;

fn triangle_len(n: usize) -> usize {
    (n + 1) * (n + 2) / 2
}

/// What the sums of a child must be: 2^shift times the exact control values.
fn scaled(exact: Vec<BigRational>, shift: usize) -> Vec<i128> {
    let whole = |x: BigRational| {
        let x = x * (BigInt::from(1) << shift);
        assert!(x.is_integer(), "{x} is not over 2^{shift}");
        i128::try_from(x.to_integer()).unwrap()
    };
    exact.into_iter().map(whole).collect()
}

/// Legal bits, both ends often.
fn values(len: usize) -> impl Strategy<Value = Vec<i64>> {
    let limit = 32_767_i64 << 16;
    prop::collection::vec(prop_oneof![1 => Just(limit), 1 => Just(-limit), 3 => -limit..=limit, 3 => -99_i64..=99], len)
}

fn triangle_values() -> impl Strategy<Value = (usize, Vec<i64>)> {
    (1_usize..=8).prop_flat_map(|n| (Just(n), values(triangle_len(n))))
}

fn tensor_values() -> impl Strategy<Value = ((usize, usize), Vec<i64>)> {
    (1_usize..=8, 1_usize..=8).prop_flat_map(|(m, h)| (Just((m, h)), values((m + 1) * (h + 1))))
}

/// The four children of a triangle by the crate, in `i64`; the same in `i128`.
fn quarters(n: usize, values: &[i64]) -> [Vec<i128>; 4] {
    Quarter::ALL.map(|quarter| {
        let mut narrow = values.to_vec();
        quarter_triangle(&mut narrow, n, quarter);
        let mut wide: Vec<i128> = values.iter().map(|v| i128::from(*v)).collect();
        quarter_triangle(&mut wide, n, quarter);
        assert!(wide.iter().zip(&narrow).all(|(w, n)| *w == i128::from(*n)));
        wide
    })
}

/// Values of an oscillating net at the ends of the legal range.
fn extreme(len: usize) -> Vec<i64> {
    (0..len as i64).map(|i| if i * i % 3 == 0 { 32_767 << 16 } else { -32_767 << 16 }).collect()
}

fn check_triangle(n: usize, values: &[i64]) {
    let exact = whole(values);
    for (ours, corners) in quarters(n, values).into_iter().zip(&blossom::children()) {
        assert_eq!(ours, scaled(blossom::triangle_part(n, &exact, corners), n), "degree {n}");
    }
}

#[test]
fn triangles_of_every_degree_at_the_ends_of_the_range() {
    for n in 1..=8 {
        check_triangle(n, &extreme(triangle_len(n)));
        check_triangle(n, &vec![-32_767 << 16; triangle_len(n)]);
    }
}

/// Half intervals of the parameters of a tensor-product patch, the whole where not cut.
fn check_tensor(degrees: (usize, usize), values: &[i64]) {
    let (exact, halves, unit) = (whole(values), blossom::halves(), [ratio(0, 1), ratio(1, 1)]);
    let (m, h) = degrees;
    for (half, interval) in Half::ALL.into_iter().zip(&halves) {
        let mut by_r = values.to_vec();
        halve_tensor(&mut by_r, degrees, Direction::R, half);
        let part = |r: &[BigRational; 2], s: &[BigRational; 2]| {
            blossom::tensor_part(degrees, &exact, [&r[0], &r[1]], [&s[0], &s[1]])
        };
        let wide = |values: &[i64]| values.iter().map(|v| i128::from(*v)).collect::<Vec<_>>();
        assert_eq!(wide(&by_r), scaled(part(interval, &unit), m));
        let mut by_s = values.to_vec();
        halve_tensor(&mut by_s, degrees, Direction::S, half);
        assert_eq!(wide(&by_s), scaled(part(&unit, interval), h));
        for (other, across) in Half::ALL.into_iter().zip(&halves) {
            let mut quarter = by_r.clone();
            halve_tensor(&mut quarter, degrees, Direction::S, other);
            assert_eq!(wide(&quarter), scaled(part(interval, across), m + h));
        }
    }
}

#[test]
fn tensor_products_of_every_degree_at_the_ends_of_the_range() {
    for n in 1..=8 {
        check_tensor((n, 9 - n), &extreme((n + 1) * (10 - n)));
        check_tensor((n, n), &extreme((n + 1) * (n + 1)));
    }
}

#[test]
fn slices_of_a_wrong_length_are_left_alone() {
    let mut values = [1_i64, 2, 3, 4, 5];
    quarter_triangle(&mut values, 2, Quarter::Centre);
    halve_tensor(&mut values, (1, 1), Direction::R, Half::First);
    assert_eq!(values, [1, 2, 3, 4, 5]);
    halve_curve::<i64>(&mut [], Half::Second);
}

/// Twice the signed area of three points (x, y).
fn area(x: [i128; 3], y: [i128; 3]) -> i128 {
    (x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0])
}

/// The values at the three corners of a net.
fn corners<T: Copy>(n: usize, values: &[T]) -> [T; 3] {
    [(n, 0, 0), (0, n, 0), (0, 0, n)].map(|index| values[triangle_index(n, index)])
}

/// x and y of the affine net over the triangle (0,0), (n,0), (0,n).
fn affine(n: usize) -> [Vec<i64>; 2] {
    [triangle_indices(n).map(|(_, j, _)| j as i64).collect(), triangle_indices(n).map(|(_, _, k)| k as i64).collect()]
}

#[test]
fn all_four_children_keep_the_orientation() {
    for n in 1..=8 {
        let [x, y] = affine(n);
        let parent = area(corners(n, &x).map(i128::from), corners(n, &y).map(i128::from));
        for (x, y) in quarters(n, &x).iter().zip(&quarters(n, &y)) {
            // Both coordinates are over 2^n: a quarter of the parent's area, with its sign.
            assert_eq!(4 * area(corners(n, x), corners(n, y)), parent << (2 * n));
        }
    }
}

proptest! {
    #![proptest_config(common::draw::cases(48))]

    #[test]
    fn triangles_are_blossoms((n, values) in triangle_values()) {
        check_triangle(n, &values);
    }

    #[test]
    fn tensor_products_are_blossoms((degrees, values) in tensor_values()) {
        check_tensor(degrees, &values);
    }

    #[test]
    fn curves_are_blossoms(values in (2_usize..=9).prop_flat_map(values)) {
        let (exact, n) = (whole(&values), values.len() - 1);
        for (half, interval) in Half::ALL.into_iter().zip(&blossom::halves()) {
            let mut ours = values.clone();
            halve_curve(&mut ours, half);
            let ours: Vec<_> = ours.into_iter().map(i128::from).collect();
            prop_assert_eq!(ours, scaled(blossom::curve_part(&exact, [&interval[0], &interval[1]]), n));
        }
    }

    /// T1, T2, T3 stay, and the midpoints are points of the surface, the same for all children.
    #[test]
    fn corners_are_interpolated((n, values) in triangle_values()) {
        let [at_u, at_v, at_w, centre] = quarters(n, &values).map(|child| corners(n, &child));
        let kept = corners(n, &values).map(|v| i128::from(v) << n);
        prop_assert_eq!([at_u[0], at_v[1], at_w[2]], kept);
        let [p1, p2, p3] = centre;
        prop_assert_eq!([at_u[1], at_u[2], at_v[0], at_v[2], at_w[0], at_w[1]], [p3, p2, p3, p1, p2, p1]);
        let exact = whole(&values);
        let surface = |u: i64, v: i64| {
            let at = |i, j, k| exact[triangle_index(n, (i, j, k))].clone();
            common::triangle(n, at, &ratio(u, 2), &ratio(v, 2))
        };
        prop_assert_eq!(scaled(vec![surface(0, 1), surface(1, 0), surface(1, 1)], n), centre);
    }

    /// No linear functional is larger on a child than on its parent: the convex hulls are nested.
    #[test]
    fn children_stay_in_the_convex_hull(
        ((n, x), factors) in (triangle_values(), [-9_i128..=9, -9_i128..=9, -9_i128..=9]),
        seed in 1_i64..1000,
    ) {
        let others = [seed, 2 * seed + 1].map(|step| x.iter().map(|v| v.wrapping_mul(step) >> 9).collect::<Vec<_>>());
        let axes = [&x, &others[0], &others[1]];
        let parts = axes.map(|axis| quarters(n, axis));
        let largest = (0..x.len()).map(|i| axes.iter().zip(factors).map(|(a, f)| i128::from(a[i]) * f).sum::<i128>());
        let largest = largest.max().unwrap();
        for child in 0..4 {
            for i in 0..x.len() {
                let value: i128 = parts.iter().zip(factors).map(|(part, f)| part[child][i] * f).sum();
                prop_assert!(value <= largest << n);
            }
        }
    }

    #[test]
    fn halves_stay_in_the_range_of_their_parent((degrees, values) in tensor_values()) {
        let (low, high) = (*values.iter().min().unwrap(), *values.iter().max().unwrap());
        for (half, direction, n) in Half::ALL.into_iter().flat_map(|half| {
            [(half, Direction::R, degrees.0), (half, Direction::S, degrees.1)]
        }) {
            let mut part = values.clone();
            halve_tensor(&mut part, degrees, direction, half);
            prop_assert!(part.iter().all(|v| (low << n..=high << n).contains(v)));
        }
    }
}

// Algorithm 1 as printed, with sums for halves: the point [i, j, k, r, s, t] of level r + s + t carries 2^(r+s+t).

type Levels = BTreeMap<[usize; 6], i128>;

/// Points in the order in which they are computed.
type Points = Vec<([usize; 6], i128)>;

/// All de Casteljau points.
fn casteljau(n: usize, values: &[i64]) -> Points {
    let mut levels: Levels =
        triangle_indices(n).zip(values).map(|((i, j, k), v)| ([i, j, k, 0, 0, 0], i128::from(*v))).collect();
    let mut order = Vec::new();
    for l in 0..n {
        for (i, j, k) in triangle_indices(n - 1 - l) {
            for (r, s, t) in triangle_indices(l) {
                let at = |i, j, k| levels[&[i, j, k, r, s, t]];
                let (along_i, along_j, along_k) = (at(i + 1, j, k), at(i, j + 1, k), at(i, j, k + 1));
                let three = [
                    ([i, j, k, r + 1, s, t], along_j + along_k),
                    ([i, j, k, r, s + 1, t], along_i + along_k),
                    ([i, j, k, r, s, t + 1], along_i + along_j),
                ];
                levels.extend(three);
                order.extend(three);
            }
        }
    }
    triangle_indices(n).zip(values).map(|((i, j, k), v)| ([i, j, k, 0, 0, 0], i128::from(*v))).chain(order).collect()
}

/// The net P of step 2: points stored at their r and s, the last store wins. As printed, nothing is asked of the other
/// indices; to be right, i = j = t = 0.
fn stored_p(n: usize, values: &[i64], conditions: bool) -> BTreeMap<[usize; 2], i128> {
    let points = casteljau(n, values).into_iter();
    let stored = points.filter(|([i, j, _, _, _, t], _)| !conditions || (*i, *j, *t) == (0, 0, 0));
    stored.map(|([_, _, _, r, s, t], v)| ([r, s], v << (n - r - s - t))).collect()
}

/// S, Q, P and T with the right conditions but the printed places: S[i,s,t], Q[r,j,t], P[r,s,k], T[r,s,t].
fn printed_places(n: usize, values: &[i64]) -> [Vec<i128>; 4] {
    let mut nets = [(); 4].map(|()| vec![i128::MIN; triangle_len(n)]);
    for ([i, j, k, r, s, t], v) in casteljau(n, values) {
        let v = v << (n - r - s - t);
        let mut store = |net: usize, right: bool, index: (usize, usize, usize)| {
            if right {
                nets[net][triangle_index(n, index)] = v;
            }
        };
        store(0, j == 0 && k == 0 && r == 0, (i, s, t));
        store(1, i == 0 && k == 0 && s == 0, (r, j, t));
        store(2, i == 0 && j == 0 && t == 0, (r, s, k));
        store(3, i == 0 && j == 0 && k == 0, (r, s, t));
    }
    nets
}

fn drawn(n: usize) -> Vec<i64> {
    (0..triangle_len(n) as i64).map(|i| i * i * i % 101 - 40).collect()
}

#[test]
fn the_printed_stores_without_conditions_fail() {
    for n in 1..=8 {
        let values = drawn(n);
        let corners = &blossom::children()[2];
        let exact = scaled(blossom::triangle_part(n, &whole(&values), corners), n);
        // The child (p2, p1, T3) has b[p2^s p1^r T3^k] at (s, r, k).
        let differ = |net: &BTreeMap<[usize; 2], i128>| {
            triangle_indices(n).filter(|(r, s, k)| net[&[*r, *s]] != exact[triangle_index(n, (*s, *r, *k))]).count()
        };
        assert_eq!(differ(&stored_p(n, &values, true)), 0, "degree {n}");
        assert!(differ(&stored_p(n, &values, false)) > 0, "degree {n}");
        // The reason: superscripts r, s, t instead of r, s, 0 take points that hold p3, which P does not see.
        let printed = casteljau(n, &values);
        let [.., p3] = blossom::named();
        let strays = printed.iter().filter(|([i, j, k, r, s, t], _)| (*i, *j) == (0, 0) && *t > 0 && r + s + k < n);
        assert!(strays.count() > 0, "degree {n}");
        // At the corner T3, r = s = 0, the last of them is b[p3^n].
        let all_p3: Vec<&Corner> = vec![&p3; n];
        let last = scaled(vec![blossom::triangle(&whole(&values), &all_p3)], n)[0];
        assert_eq!(stored_p(n, &values, false)[&[0, 0]], last);
    }
}

#[test]
fn the_printed_places_reverse_three_of_four_children() {
    let [t1, t2, t3, p1, p2, p3] = blossom::named();
    let reversed = [
        [t1, p2.clone(), p3.clone()],
        [p1.clone(), t2, p3.clone()],
        [p1.clone(), p2.clone(), t3],
        [p1, p2, p3], // T is right
    ];
    for n in 1..=8 {
        let values = drawn(n);
        let exact = whole(&values);
        let printed = printed_places(n, &values);
        for (net, corners) in printed.iter().zip(&reversed) {
            assert_eq!(*net, scaled(blossom::triangle_part(n, &exact, corners), n), "degree {n}");
        }
        // So the check of `triangles_are_blossoms` fails for S, Q and P
        let right = blossom::children().map(|corners| scaled(blossom::triangle_part(n, &exact, &corners), n));
        let fails: Vec<bool> = printed.iter().zip(&right).map(|(net, right)| net != right).collect();
        assert_eq!(fails, [true, true, true, false], "degree {n}");
        // because their area has the other sign.
        let [x, y] = affine(n).map(|axis| printed_places(n, &axis).map(|net| corners(n, &net)));
        let quarter = (n * n) as i128;
        let areas: Vec<i128> = x.iter().zip(&y).map(|(x, y)| (4 * area(*x, *y)) >> (2 * n)).collect();
        assert_eq!(areas, [-quarter, -quarter, -quarter, quarter]);
    }
}

#[test]
fn both_ways_count_the_same_averages() {
    // The distinct points that Algorithm 1 computes, for degrees 1 to 6.
    let counts = (1..=6).map(|n| {
        let levels: BTreeMap<_, _> = casteljau(n, &drawn(n)).into_iter().collect();
        levels.len() - triangle_len(n)
    });
    assert_eq!(counts.collect::<Vec<_>>(), [3, 15, 46, 111, 231, 434]);
}
