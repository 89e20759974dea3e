//! What the property tests draw: legal coordinates of every kind, parameters, weights.

use embedded_surfaces::geometry::Point3;
use embedded_surfaces::num::{Coord, I16F16};
use embedded_surfaces::patch::{Barycentric, Parameter};
use proptest::prelude::*;

/// The number of cases, unless `PROPTEST_CASES` says otherwise.
pub(crate) fn cases(default: u32) -> ProptestConfig {
    let cases = std::env::var("PROPTEST_CASES").ok().and_then(|n| n.parse().ok()).unwrap_or(default);
    ProptestConfig { cases, ..ProptestConfig::with_cases(default) }
}

/// Legal coordinates: both ends, the whole range, whole units, a pixel-sized range with all fraction bits.
pub(crate) fn coordinate<C: Coord>() -> impl Strategy<Value = C> {
    let limit = C::LIMIT << C::FRACTION_BITS;
    let bits = prop_oneof![
        1 => prop_oneof![Just(-limit), Just(limit), Just(0), Just(1), Just(-1)],
        2 => -limit..=limit,
        2 => (-400_i64..=400).prop_map(|c| c << C::FRACTION_BITS),
        3 => (-400_i64 << C::FRACTION_BITS)..(400 << C::FRACTION_BITS),
    ];
    bits.prop_map(|bits| C::from_legal_bits(bits.into()).unwrap())
}

/// That many legal points.
pub(crate) fn net<C: Coord>(len: usize) -> impl Strategy<Value = Vec<Point3<C>>> {
    let point = [coordinate::<C>(), coordinate(), coordinate()].prop_map(Point3::from_array);
    prop::collection::vec(point, len)
}

/// Denominators of every kind up to 65536.
fn denominator() -> impl Strategy<Value = u32> {
    prop_oneof![1_u32..=16, 1_u32..=65536, Just(65536), Just(65521)]
}

/// A parameter, the ends included.
pub(crate) fn parameter() -> impl Strategy<Value = Parameter> {
    denominator()
        .prop_flat_map(|q| (prop_oneof![Just(0), Just(q), 0..=q], Just(q)))
        .prop_map(|(p, q)| Parameter::new(p, q).unwrap())
}

/// A point of the domain triangle, corners and edges included.
pub(crate) fn barycentric() -> impl Strategy<Value = Barycentric> {
    let u = denominator().prop_flat_map(|q| (prop_oneof![1 => Just(0), 1 => Just(q), 4 => 0..=q], Just(q)));
    u.prop_flat_map(|(u, q)| (Just(u), prop_oneof![1 => Just(0), 4 => 0..=q - u], Just(q)))
        .prop_map(|(u, v, q)| Barycentric::new(u, v, q - u - v).unwrap())
}

/// Positive weights: any, two with the ratio 1024, the extremes of the type, all equal.
pub(crate) fn weights(len: usize) -> impl Strategy<Value = Vec<I16F16>> {
    let of = |bits: BoxedStrategy<i32>| prop::collection::vec(bits.prop_map(I16F16::from_bits), len);
    prop_oneof![
        of((1..=i32::MAX).boxed()),
        of((1 << 14..1 << 18).boxed()),
        of(prop_oneof![Just(1 << 8), Just(1 << 18)].boxed()),
        of(prop_oneof![Just(1), Just(i32::MAX)].boxed()),
        Just(vec![I16F16::ONE; len]),
    ]
}
