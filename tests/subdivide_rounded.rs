//! Rounded midpoint subdivision: every child is the exact one, rounded once, half up; edges that patches share have the
//! same bits afterwards.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod common;

use common::blossom;
use common::draw::{cases, net, weights};
use common::{ratio, round_half_up, triangle_index};
use embedded_surfaces::geometry::Point3;
use embedded_surfaces::num::I16F16;
use embedded_surfaces::patch::{Curve, RationalCurve, RationalTensor, RationalTriangle, Tensor, Triangle};
use embedded_surfaces::subdivide::Direction;
use num_bigint::BigInt;
use num_rational::BigRational;
use proptest::prelude::*;

/// A net whose kind and degrees are known at run time.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Patch {
    shape: Shape,
    points: Vec<Point3>,
    weights: Option<Vec<I16F16>>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Shape {
    Curve(usize),
    Triangle(usize),
    Tensor(usize, usize),
}

impl Shape {
    fn len(self) -> usize {
        match self {
            Self::Curve(n) => n + 1,
            Self::Triangle(n) => (n + 1) * (n + 2) / 2,
            Self::Tensor(m, h) => (m + 1) * (h + 1),
        }
    }
}

/// The points and weights of every part of a net that owns its points.
type Parts = Vec<(Vec<Point3>, Option<Vec<I16F16>>)>;

fn curve<const K: usize>(points: &[Point3], weights: Option<&[I16F16]>) -> Parts {
    let net = Curve::<K>::new(points.try_into().unwrap()).unwrap();
    match weights {
        None => net.subdivide().iter().map(|part| (part.points().to_vec(), None)).collect(),
        Some(w) => {
            let parts = RationalCurve::new(net, w.try_into().unwrap()).unwrap().subdivide();
            parts.iter().map(|part| (part.net().points().to_vec(), Some(part.weights().to_vec()))).collect()
        }
    }
}

fn triangle<const N: usize, const LEN: usize>(points: &[Point3], weights: Option<&[I16F16]>) -> Parts {
    let net = Triangle::<N, LEN>::new(points.try_into().unwrap()).unwrap();
    match weights {
        None => net.subdivide().iter().map(|part| (part.points().to_vec(), None)).collect(),
        Some(w) => {
            let parts = RationalTriangle::new(net, w.try_into().unwrap()).unwrap().subdivide();
            parts.iter().map(|part| (part.net().points().to_vec(), Some(part.weights().to_vec()))).collect()
        }
    }
}

fn rows<T: Copy, const M: usize, const H: usize>(values: &[T]) -> [[T; H]; M] {
    std::array::from_fn(|i| std::array::from_fn(|j| values[i * H + j]))
}

/// The quarters, then the halves along r and those along s.
fn tensor<const M: usize, const H: usize>(points: &[Point3], weights: Option<&[I16F16]>) -> Parts {
    let net = Tensor::<M, H>::new(rows(points)).unwrap();
    match weights {
        None => {
            let halves = [Direction::R, Direction::S].into_iter().flat_map(|direction| net.bisect(direction));
            let all = net.subdivide().into_iter().chain(halves);
            all.map(|part| (part.points().as_flattened().to_vec(), None)).collect()
        }
        Some(w) => {
            let net = RationalTensor::new(net, rows(w)).unwrap();
            let halves = [Direction::R, Direction::S].into_iter().flat_map(|direction| net.bisect(direction));
            let all = net.subdivide().into_iter().chain(halves);
            all.map(|part| (part.net().points().to_vec(), Some(part.weights().as_flattened().to_vec()))).collect()
        }
    }
}

macro_rules! by_degree {
    ($value:expr, $call:ident $arguments:tt, $($pattern:pat => <$($n:literal),*>,)*) => {
        match $value {
            $($pattern => $call::<$($n),*> $arguments,)*
            other => panic!("no case for {other:?}"),
        }
    };
}

const TENSORS: [(usize, usize); 10] = [(1, 1), (2, 2), (3, 3), (4, 4), (5, 5), (8, 8), (1, 8), (8, 1), (2, 4), (7, 6)];

impl Patch {
    /// The two or four parts; of a tensor-product patch the two halves along r and the two along s as well.
    fn parts(&self) -> Vec<Self> {
        let (points, weights) = (self.points.as_slice(), self.weights.as_deref());
        let parts = match self.shape {
            Shape::Curve(n) => by_degree!(n, curve(points, weights), 1 => <2>, 2 => <3>, 3 => <4>, 4 => <5>, 5 => <6>,
                6 => <7>, 7 => <8>, 8 => <9>,),
            Shape::Triangle(n) => by_degree!(n, triangle(points, weights), 1 => <1, 3>, 2 => <2, 6>, 3 => <3, 10>,
                4 => <4, 15>, 5 => <5, 21>, 6 => <6, 28>, 7 => <7, 36>, 8 => <8, 45>,),
            Shape::Tensor(m, h) => by_degree!((m, h), tensor(points, weights), (1, 1) => <2, 2>, (2, 2) => <3, 3>,
                (3, 3) => <4, 4>, (4, 4) => <5, 5>, (5, 5) => <6, 6>, (8, 8) => <9, 9>, (1, 8) => <2, 9>,
                (8, 1) => <9, 2>, (2, 4) => <3, 5>, (7, 6) => <8, 7>,),
        };
        parts.into_iter().map(|(points, weights)| Self { shape: self.shape, points, weights }).collect()
    }

    /// The values of every part of a net of rationals, in the order of `parts`.
    fn exact_parts(&self, values: &[BigRational]) -> Vec<Vec<BigRational>> {
        let (halves, unit) = (blossom::halves(), [ratio(0, 1), ratio(1, 1)]);
        let between = |ends: &[BigRational; 2]| ends.clone();
        match self.shape {
            Shape::Curve(_) => halves.iter().map(|[from, to]| blossom::curve_part(values, [from, to])).collect(),
            Shape::Triangle(n) => {
                blossom::children().iter().map(|corners| blossom::triangle_part(n, values, corners)).collect()
            }
            Shape::Tensor(m, h) => {
                let quarters = halves.iter().flat_map(|r| halves.iter().map(|s| (between(r), between(s))));
                let along_r = halves.iter().map(|r| (between(r), between(&unit)));
                let along_s = halves.iter().map(|s| (between(&unit), between(s)));
                let all = quarters.chain(along_r).chain(along_s);
                all.map(|(r, s)| blossom::tensor_part((m, h), values, [&r[0], &r[1]], [&s[0], &s[1]])).collect()
            }
        }
    }

    /// Homogeneous component `axis` of all points in raw bits: w·x, w·y, w·z, w; or x, y, z, 1.
    fn component(&self, axis: usize) -> Vec<BigRational> {
        let bits = |(i, p): (usize, &Point3)| {
            let coordinate = [p.x.to_bits(), p.y.to_bits(), p.z.to_bits(), 1][axis];
            let weight = self.weights.as_ref().map_or(1, |w| w[i].to_bits());
            ratio(i64::from(coordinate) * i64::from(weight), 1)
        };
        self.points.iter().enumerate().map(bits).collect()
    }

    /// Fails unless every part is the exact one, coordinates and weights rounded once, half up.
    fn check(&self) {
        let parts = self.parts();
        let divisors = self.exact_parts(&self.component(3));
        assert_eq!(parts.len(), divisors.len());
        for axis in 0..3 {
            let exact = self.exact_parts(&self.component(axis));
            for (part, (exact, divisor)) in parts.iter().zip(exact.iter().zip(&divisors)) {
                for (p, (a, d)) in part.points.iter().zip(exact.iter().zip(divisor)) {
                    let ours = BigInt::from(p.to_array()[axis].to_bits());
                    assert_eq!(ours, round_half_up(&(a / d)), "{:?} axis {axis}", self.shape);
                }
            }
        }
        for (part, divisor) in parts.iter().zip(&divisors) {
            for (w, d) in part.weights.iter().flatten().zip(divisor) {
                assert_eq!(BigInt::from(w.to_bits()), round_half_up(d));
                assert!(*w > 0);
            }
        }
    }

    /// Where the points of an edge stand. A tensor-product patch: r = 0, r = 1, s = 0, s = 1; a triangle: u = 0 from T2,
    /// v = 0 from T1, w = 0 from T1.
    fn edge_indices(&self, edge: usize) -> Vec<usize> {
        match self.shape {
            Shape::Triangle(n) => {
                let along = |k: usize| [(0, n - k, k), (n - k, 0, k), (n - k, k, 0)][edge];
                (0..=n).map(|k| triangle_index(n, along(k))).collect()
            }
            Shape::Tensor(m, h) if edge < 2 => (0..=h).map(|j| edge * m * (h + 1) + j).collect(),
            Shape::Tensor(m, h) => (0..=m).map(|i| i * (h + 1) + (edge - 2) * h).collect(),
            Shape::Curve(_) => panic!("a curve has no edges"),
        }
    }

    fn edge(&self, edge: usize) -> Vec<(Point3, Option<I16F16>)> {
        let at = |i: usize| (self.points[i], self.weights.as_ref().map(|w| w[i]));
        self.edge_indices(edge).into_iter().map(at).collect()
    }

    fn set_edge(&mut self, edge: usize, polygon: &[(Point3, Option<I16F16>)]) {
        for (i, (p, weight)) in self.edge_indices(edge).into_iter().zip(polygon) {
            self.points[i] = *p;
            if let (Some(weights), Some(weight)) = (&mut self.weights, weight) {
                weights[i] = *weight;
            }
        }
    }

    /// The edges of the parts that make up an edge, in its direction.
    fn halves_of_edge(&self, edge: usize) -> [Vec<(Point3, Option<I16F16>)>; 2] {
        let parts = self.parts();
        let which = match self.shape {
            Shape::Triangle(_) => [[1, 2], [0, 2], [0, 1]][edge],
            _ => [[0, 1], [2, 3], [0, 2], [1, 3]][edge],
        };
        which.map(|part| parts[part].edge(edge))
    }
}

fn patch(shape: Shape) -> impl Strategy<Value = Patch> {
    (net::<I16F16>(shape.len()), prop::option::of(weights(shape.len()))).prop_map(move |(points, weights)| Patch {
        shape,
        points,
        weights,
    })
}

fn shapes() -> impl Strategy<Value = Shape> {
    prop_oneof![
        (1_usize..=8).prop_map(Shape::Curve),
        (1_usize..=8).prop_map(Shape::Triangle),
        prop::sample::select(&TENSORS[..]).prop_map(|(m, h)| Shape::Tensor(m, h)),
    ]
}

/// Two patches, an edge of each, of one degree.
fn neighbours() -> impl Strategy<Value = [(Patch, usize); 2]> {
    let shape = |n| prop_oneof![Just(Shape::Triangle(n)), Just(Shape::Tensor(n, n))];
    let side = move |n| {
        shape(n).prop_flat_map(|shape| {
            let edges = if matches!(shape, Shape::Triangle(_)) { 3_usize } else { 4 };
            (net::<I16F16>(shape.len()), weights(shape.len()), 0..edges)
                .prop_map(move |(points, weights, edge)| (Patch { shape, points, weights: Some(weights) }, edge))
        })
    };
    prop::sample::select(vec![1_usize, 2, 3, 4, 5, 8]).prop_flat_map(move |n| [side(n), side(n)])
}

fn reversed<T: Clone>(row: &[T]) -> Vec<T> {
    row.iter().rev().cloned().collect()
}

/// Fails unless the parts of both patches agree along the common edge.
fn check_seam([(a, at_a), (b, at_b)]: &[(Patch, usize); 2], flip: bool) {
    let mut b = b.clone();
    let polygon = a.edge(*at_a);
    b.set_edge(*at_b, &if flip { reversed(&polygon) } else { polygon });
    let ours = a.halves_of_edge(*at_a);
    let [first, second] = b.halves_of_edge(*at_b);
    let theirs = if flip { [reversed(&second), reversed(&first)] } else { [first, second] };
    assert_eq!(ours, theirs);
    // The halves meet.
    assert_eq!(ours[0].last(), ours[1].first());
}

proptest! {
    #![proptest_config(cases(96))]

    #[test]
    fn parts_are_the_exact_ones_rounded_once(patch in shapes().prop_flat_map(patch)) {
        patch.check();
    }

    #[test]
    fn shared_edges_get_the_same_bits(pair in neighbours(), flip: bool, rational: bool) {
        let pair = pair.map(|(mut patch, edge)| {
            patch.weights = patch.weights.filter(|_| rational);
            (patch, edge)
        });
        check_seam(&pair, flip);
    }

    /// The child in the middle and its three neighbours, whose common edges run the other way.
    #[test]
    fn children_of_a_triangle_meet(patch in (1_usize..=8).prop_flat_map(|n| patch(Shape::Triangle(n)))) {
        let parts = patch.parts();
        for edge in 0..3 {
            prop_assert_eq!(parts[3].edge(edge), reversed(&parts[edge].edge(edge)));
        }
    }

    #[test]
    fn quarters_of_a_tensor_product_meet(patch in prop::sample::select(&TENSORS[..]).prop_flat_map(|(m, h)| {
        patch(Shape::Tensor(m, h))
    })) {
        let parts = patch.parts();
        for (a, at_a, b, at_b) in [(0, 1, 2, 0), (1, 1, 3, 0), (0, 3, 1, 2), (2, 3, 3, 2)] {
            prop_assert_eq!(parts[a].edge(at_a), parts[b].edge(at_b));
        }
    }
}

#[test]
fn both_ends_of_the_legal_range() {
    let end = |sign: i32| I16F16::from_bits(sign * (32_767 << 16));
    let shapes = (1..=8).map(Shape::Curve).chain((1..=8).map(Shape::Triangle));
    for shape in shapes.chain(TENSORS.iter().map(|(m, h)| Shape::Tensor(*m, *h))) {
        for pattern in 0..5_usize {
            let sign = |i: usize| {
                if [true, false, i.is_multiple_of(2), (i * i).is_multiple_of(3), (i * i).is_multiple_of(3)][pattern] {
                    1
                } else {
                    -1
                }
            };
            let points: Vec<_> = (0..shape.len()).map(|i| Point3::new(end(sign(i)), end(-sign(i)), end(1))).collect();
            // All weights the largest, or the smallest and the largest.
            let of = |i: usize| I16F16::from_bits(if pattern == 3 && sign(i) > 0 { 1 } else { i32::MAX });
            let weights = (pattern % 3 == 0).then(|| (0..shape.len()).map(of).collect());
            Patch { shape, points, weights }.check();
        }
    }
}

#[test]
fn an_exact_half_goes_up() {
    let bits = |x: i32| Point3::from_bits(x, -x, 0);
    let [first, second] = Curve::<2>::new([bits(0), bits(1)]).unwrap().subdivide();
    // (1/2, −1/2) of the last place.
    assert_eq!(first.points()[1], Point3::from_bits(1, 0, 0));
    assert_eq!(first.points()[1], second.points()[0]);
}
