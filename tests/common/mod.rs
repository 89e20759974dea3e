//! The oracle of the exact tests: direct Bernstein sums in big integers, written without the crate's engine.
#![allow(dead_code, reason = "each test binary uses a part")]

pub(crate) mod basis;
pub(crate) mod blossom;
pub(crate) mod draw;
#[path = "../../examples/data/nets.rs"]
mod nets;
pub(crate) mod smooth;

#[allow(unused_imports, reason = "each test binary uses a part")]
pub(crate) use nets::{SEED_P, SEED_Q};

use embedded_surfaces::geometry::Point3;
use embedded_surfaces::num::I16F16;
use num_bigint::{BigInt, Sign};
use num_rational::BigRational;

pub(crate) fn choose(n: usize, k: usize) -> BigInt {
    (0..k).fold(BigInt::from(1), |c, i| c * (n - i) / (i + 1))
}

/// floor(x + 1/2)
pub(crate) fn round_half_up(x: &BigRational) -> BigInt {
    let two = BigInt::from(2);
    let (n, d) = (x.numer() * &two + x.denom(), x.denom() * &two);
    let q = &n / &d;
    if (&n % &d).sign() == Sign::Minus { q - 1 } else { q }
}

pub(crate) fn ratio(n: i64, d: i64) -> BigRational {
    BigRational::new(n.into(), d.into())
}

pub(crate) fn coordinate(p: &Point3<I16F16>, axis: usize) -> BigRational {
    let c = [p.x, p.y, p.z][axis];
    ratio(c.to_bits().into(), 1 << 16)
}

fn power(x: &BigRational, n: usize) -> BigRational {
    (0..n).fold(ratio(1, 1), |p, _| p * x)
}

/// B_i^m(t)
pub(crate) fn bernstein(m: usize, i: usize, t: &BigRational) -> BigRational {
    let rest = ratio(1, 1) - t;
    power(t, i) * power(&rest, m - i) * choose(m, i)
}

/// Σ B_i(r) B_j(s) c(i, j)
pub(crate) fn tensor(
    (m, h): (usize, usize),
    value: impl Fn(usize, usize) -> BigRational,
    r: &BigRational,
    s: &BigRational,
) -> BigRational {
    let mut sum = ratio(0, 1);
    for i in 0..=m {
        for j in 0..=h {
            sum += bernstein(m, i, r) * bernstein(h, j, s) * value(i, j);
        }
    }
    sum
}

/// Σ n!/(i!j!k!) u^i v^j w^k b[i,j,k]
pub(crate) fn triangle(
    n: usize,
    value: impl Fn(usize, usize, usize) -> BigRational,
    u: &BigRational,
    v: &BigRational,
) -> BigRational {
    let w = ratio(1, 1) - u - v;
    let mut sum = ratio(0, 1);
    for i in 0..=n {
        for j in 0..=n - i {
            let k = n - i - j;
            sum += power(u, i) * power(v, j) * power(&w, k) * (choose(n, i) * choose(n - i, j)) * value(i, j, k);
        }
    }
    sum
}

/// Storage index of b[i,j,k], counted the slow way.
pub(crate) fn triangle_index(n: usize, (i, j, k): (usize, usize, usize)) -> usize {
    let mut index = 0;
    for a in (0..=n).rev() {
        for b in (0..=n - a).rev() {
            if (a, b, n - a - b) == (i, j, k) {
                return index;
            }
            index += 1;
        }
    }
    panic!("not an index")
}

pub(crate) fn points(bits: &[i32]) -> Vec<Point3<I16F16>> {
    bits.chunks_exact(3).map(|c| Point3::from_bits(c[0], c[1], c[2])).collect()
}
