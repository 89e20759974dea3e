//! The peers of the point bench, each as fast as its author could make it.
//!
//! All of them are given favours that the exact engine does not take: the coordinates of this patch are positive, so
//! `floor(x + 1/2)` is a truncation, folded into the start values; n = 256 makes u, v and w exact in `f32` and
//! `I16F16`; the differences are set up in `f64`.
#![allow(clippy::needless_range_loop, reason = "lanes are clearest by index")]

#[path = "../../examples/data/nets.rs"]
mod nets;

use fixed::types::I16F16;
pub(crate) use nets::SEED_P;

/// What takes the points.
pub(crate) trait Sink {
    fn point(&mut self, i: u32, j: u32, x: i32, y: i32, z: i32);
}

impl<S: Sink + ?Sized> Sink for &mut S {
    fn point(&mut self, i: u32, j: u32, x: i32, y: i32, z: i32) {
        (**self).point(i, j, x, y, z);
    }
}

/// A cubic triangle and what the peers prepare of it.
pub(crate) struct Cubic {
    n: u32,
    /// Control points, `[point][axis]`.
    net: [[i16; 3]; 10],
    /// `[b][a][axis]`: Δ_u^a Δ_v^b at (0, 0), one half added to the value.
    differences: [[[f32; 4]; 4]; 4],
    /// `[b][a][axis]`: coefficients of u^a v^b.
    powers: [[[i32; 3]; 4]; 4],
}

impl Cubic {
    pub(crate) fn new(net: [[i16; 3]; 10], n: u32) -> Self {
        let (mut differences, mut powers) = ([[[0.0; 4]; 4]; 4], [[[0; 3]; 4]; 4]);
        for axis in 0..3 {
            let power = power_form(&net.map(|p| i32::from(p[axis])));
            let value = |i: usize, j: usize| {
                let (u, v) = (i as f64 / f64::from(n), j as f64 / f64::from(n));
                let terms = (0..4).flat_map(|b| (0..4).map(move |a| (a, b)));
                terms.map(|(a, b)| f64::from(power[b][a]) * whole_power(u, a) * whole_power(v, b)).sum::<f64>()
            };
            let mut table: [[f64; 4]; 4] = core::array::from_fn(|b| core::array::from_fn(|a| value(a, b)));
            for order in 1..4 {
                for k in (order..4).rev() {
                    for l in 0..4 {
                        table[l][k] -= table[l][k - 1];
                    }
                }
            }
            for order in 1..4 {
                for k in (order..4).rev() {
                    for l in 0..4 {
                        table[k][l] -= table[k - 1][l];
                    }
                }
            }
            table[0][0] += 0.5;
            for (b, a) in (0..4).flat_map(|b| (0..4).map(move |a| (b, a))) {
                differences[b][a][axis] = table[b][a] as f32;
                powers[b][a][axis] = power[b][a];
            }
        }
        Self { n, net, differences, powers }
    }
}

/// x^n, also where there is no `std`.
fn whole_power(x: f64, n: usize) -> f64 {
    (0..n).fold(1.0, |power, _| power * x)
}

/// `[b][a]`: coefficients of u^a v^b from b[i,j,k] in storage order, by expanding w = 1 − u − v.
fn power_form(net: &[i32; 10]) -> [[i32; 4]; 4] {
    let factorial = |n: i32| (1..=n).product::<i32>();
    let mut out = [[0; 4]; 4];
    let indices = (0..=3).rev().flat_map(|i| (0..=3 - i).rev().map(move |j| (i, j, 3 - i - j)));
    for ((i, j, k), b) in indices.zip(net) {
        // 3!/(i!j!k!) u^i v^j (1 − u − v)^k
        for (a, c) in (0..=k).flat_map(|a| (0..=k - a).map(move |c| (a, c))) {
            let spread = factorial(k) / (factorial(a) * factorial(c) * factorial(k - a - c));
            let sign = if (a + c) % 2 == 0 { 1 } else { -1 };
            out[(j + c) as usize][(i + a) as usize] +=
                sign * spread * b * 6 / (factorial(i) * factorial(j) * factorial(k));
        }
    }
    out
}

/// Truncation of a number that is known to be small: one instruction.
#[inline(always)]
fn truncate(x: f32) -> i32 {
    // SAFETY: coordinates of the patch are in 0 .. 512.
    unsafe { x.to_int_unchecked() }
}

/// The next row's differences.
#[inline(always)]
fn next_row(table: &mut [[[f32; 4]; 4]; 4]) {
    for b in 0..3 {
        for a in 0..4 - b {
            for axis in 0..4 {
                table[b][a][axis] += table[b + 1][a][axis];
            }
        }
    }
}

/// x, y and z of one point in a vector.
#[cfg(target_arch = "x86_64")]
mod quad {
    use core::arch::x86_64::{__m128, _mm_add_ps, _mm_cvttps_epi32, _mm_loadu_ps, _mm_storeu_si128};

    #[derive(Clone, Copy)]
    pub(super) struct Quad(__m128);

    impl Quad {
        #[inline(always)]
        pub(super) fn new(values: [f32; 4]) -> Self {
            // SAFETY: four floats are there to be read.
            Self(unsafe { _mm_loadu_ps(values.as_ptr()) })
        }

        #[inline(always)]
        pub(super) fn plus(self, other: Self) -> Self {
            // SAFETY: every x86-64 has SSE.
            Self(unsafe { _mm_add_ps(self.0, other.0) })
        }

        #[inline(always)]
        pub(super) fn truncate(self) -> [i32; 4] {
            let mut out = [0; 4];
            // SAFETY: there is room for four integers.
            unsafe { _mm_storeu_si128(out.as_mut_ptr().cast(), _mm_cvttps_epi32(self.0)) };
            out
        }
    }
}

#[cfg(not(target_arch = "x86_64"))]
mod quad {
    #[derive(Clone, Copy)]
    pub(super) struct Quad([f32; 4]);

    impl Quad {
        #[inline(always)]
        pub(super) fn new(values: [f32; 4]) -> Self {
            Self(values)
        }

        #[inline(always)]
        pub(super) fn plus(self, other: Self) -> Self {
            Self(core::array::from_fn(|axis| self.0[axis] + other.0[axis]))
        }

        #[inline(always)]
        pub(super) fn truncate(self) -> [i32; 4] {
            self.0.map(super::truncate)
        }
    }
}

/// Forward differences in row order, in vector instructions by hand: LLVM makes slower ones of arrays.
#[inline(always)]
pub(crate) fn forward_f32_by_hand<S: Sink + ?Sized>(cubic: &Cubic, sink: &mut S) {
    let mut table = cubic.differences;
    for j in 0..cubic.n + 1 {
        let [mut x, mut d1, mut d2, d3] = table[0].map(quad::Quad::new);
        for i in 0..cubic.n - j + 1 {
            let [px, py, pz, _] = x.truncate();
            sink.point(i, j, px, py, pz);
            (x, d1, d2) = (x.plus(d1), d1.plus(d2), d2.plus(d3));
        }
        next_row(&mut table);
    }
}

/// Forward differences in row order, in arrays of `A` axes: 4, of which one is idle, for what turns arrays into vectors,
/// 3 for a core without vectors.
#[inline(always)]
pub(crate) fn forward_f32<const A: usize, S: Sink + ?Sized>(cubic: &Cubic, sink: &mut S) {
    let mut table = cubic.differences;
    for j in 0..cubic.n + 1 {
        let [mut x, mut d1, mut d2, d3] = table[0];
        for i in 0..cubic.n - j + 1 {
            sink.point(i, j, truncate(x[0]), truncate(x[1]), truncate(x[2]));
            for axis in 0..A {
                x[axis] += d1[axis];
                d1[axis] += d2[axis];
                d2[axis] += d3[axis];
            }
        }
        next_row(&mut table);
    }
}

/// One coordinate of `L` points in lockstep.
#[derive(Clone, Copy)]
struct Lanes<const L: usize> {
    x: [f32; L],
    d1: [f32; L],
    d2: [f32; L],
    d3: [f32; L],
}

impl<const L: usize> Lanes<L> {
    #[inline(always)]
    fn step(&mut self) -> [i32; L] {
        let out = self.x.map(truncate);
        for lane in 0..L {
            self.x[lane] += self.d1[lane];
            self.d1[lane] += self.d2[lane];
            self.d2[lane] += self.d3[lane];
        }
        out
    }
}

/// Forward differences of `L` rows in lockstep: not in row order.
#[inline(always)]
pub(crate) fn forward_f32_rows<const L: usize, S: Sink + ?Sized>(cubic: &Cubic, sink: &mut S) {
    let mut table = cubic.differences;
    let mut first = 0;
    while first <= cubic.n {
        let mut lanes = [Lanes { x: [0.0; L], d1: [0.0; L], d2: [0.0; L], d3: [0.0; L] }; 3];
        for lane in 0..L {
            for (axis, lanes) in lanes.iter_mut().enumerate() {
                lanes.x[lane] = table[0][0][axis];
                lanes.d1[lane] = table[0][1][axis];
                lanes.d2[lane] = table[0][2][axis];
                lanes.d3[lane] = table[0][3][axis];
            }
            next_row(&mut table);
        }
        // Columns that all rows have, then the triangular rest.
        let (longest, shared) = (cubic.n - first + 1, (cubic.n + 2).saturating_sub(first + L as u32));
        for i in 0..shared {
            let [x, y, z] = lanes.each_mut().map(Lanes::step);
            for lane in 0..L {
                sink.point(i, first + lane as u32, x[lane], y[lane], z[lane]);
            }
        }
        for i in shared..longest {
            let [x, y, z] = lanes.each_mut().map(Lanes::step);
            for lane in 0..(longest - i).min(L as u32) as usize {
                sink.point(i, first + lane as u32, x[lane], y[lane], z[lane]);
            }
        }
        first += L as u32;
    }
}

/// Forward differences of stride `L`: `L` neighbours of a row in lockstep, in row order.
#[inline(always)]
pub(crate) fn forward_f32_lanes<const L: usize, S: Sink + ?Sized>(cubic: &Cubic, sink: &mut S) {
    let mut table = cubic.differences;
    let l = L as f32;
    for j in 0..=cubic.n {
        let mut lanes: [Lanes<L>; 3] = core::array::from_fn(|axis| {
            let [x, d1, d2, d3] = table[0].map(|d| d[axis]);
            // Newton's form at c, then differences of stride L: LΔ + C(L,2)Δ² + C(L,3)Δ³, L²(Δ² + (L−1)Δ³), L³Δ³.
            let of = |c: usize| {
                let c = c as f32;
                let here = x + c * (d1 + (c - 1.0) * (0.5 * d2 + (c - 2.0) / 6.0 * d3));
                let (d1, d2) = (d1 + c * (d2 + (c - 1.0) * 0.5 * d3), d2 + c * d3);
                let first = l * (d1 + (l - 1.0) * (0.5 * d2 + (l - 2.0) / 6.0 * d3));
                (here, first, l * l * (d2 + (l - 1.0) * d3))
            };
            Lanes {
                x: core::array::from_fn(|c| of(c).0),
                d1: core::array::from_fn(|c| of(c).1),
                d2: core::array::from_fn(|c| of(c).2),
                d3: [l * l * l * d3; L],
            }
        });
        let count = cubic.n - j + 1;
        let mut i = 0;
        while i + L as u32 <= count {
            let [x, y, z] = lanes.each_mut().map(Lanes::step);
            for lane in 0..L {
                sink.point(i + lane as u32, j, x[lane], y[lane], z[lane]);
            }
            i += L as u32;
        }
        let [x, y, z] = lanes.each_mut().map(Lanes::step);
        for lane in 0..(count - i) as usize {
            sink.point(i + lane as u32, j, x[lane], y[lane], z[lane]);
        }
        next_row(&mut table);
    }
}

/// Horner in the power form of each row.
#[inline(always)]
pub(crate) fn horner_fixed<S: Sink + ?Sized>(cubic: &Cubic, sink: &mut S) {
    for j in 0..=cubic.n {
        let v = I16F16::from_num(j) / cubic.n as i32;
        let row: [[I16F16; 4]; 3] = core::array::from_fn(|axis| {
            core::array::from_fn(|a| {
                let c = |b: usize| I16F16::from_num(cubic.powers[b][a][axis]);
                let half = if a == 0 { I16F16::from_bits(1 << 15) } else { I16F16::ZERO };
                ((c(3) * v + c(2)) * v + c(1)) * v + c(0) + half
            })
        });
        for i in 0..=cubic.n - j {
            let u = I16F16::from_bits((i << 8) as i32);
            let [x, y, z] = row.map(|[c0, c1, c2, c3]| (((c3 * u + c2) * u + c1) * u + c0).to_bits() >> 16);
            sink.point(i, j, x, y, z);
        }
    }
}

/// De Casteljau at each point: 6, 3 and 1 combinations of three values per axis.
#[inline(always)]
pub(crate) fn de_casteljau_fixed<S: Sink + ?Sized>(cubic: &Cubic, sink: &mut S) {
    let net: [[I16F16; 10]; 3] = core::array::from_fn(|axis| cubic.net.map(|p| I16F16::from_num(p[axis])));
    for j in 0..=cubic.n {
        for i in 0..=cubic.n - j {
            let [u, v, w] = [i, j, cubic.n - i - j].map(|k| I16F16::from_bits((k << 8) as i32));
            let value = |b: &[I16F16; 10]| {
                let mix = |b: &[I16F16], at: [usize; 3]| b[at[0]] * u + b[at[1]] * v + b[at[2]] * w;
                let two = CORNERS.map(|at| mix(b, at));
                let one = [mix(&two, CORNERS[0]), mix(&two, CORNERS[1]), mix(&two, CORNERS[2])];
                (mix(&one, CORNERS[0]) + I16F16::from_bits(1 << 15)).to_bits() >> 16
            };
            let [x, y, z] = net.each_ref().map(value);
            sink.point(i, j, x, y, z);
        }
    }
}

/// Where the three parents of each of the six points of degree 2 stand; the first three serve degree 1, the first one
/// degree 0.
const CORNERS: [[usize; 3]; 6] = [[0, 1, 2], [1, 3, 4], [2, 4, 5], [3, 6, 7], [4, 7, 8], [5, 8, 9]];

/// De Casteljau at each point, `L` neighbours of a row at a time so that it vectorises where there are vectors.
#[inline(always)]
pub(crate) fn de_casteljau_f32<const L: usize, S: Sink + ?Sized>(cubic: &Cubic, sink: &mut S) {
    let net: [[f32; 10]; 3] = core::array::from_fn(|axis| cubic.net.map(|p| f32::from(p[axis])));
    let step = 1.0 / cubic.n as f32;
    for j in 0..=cubic.n {
        let (v, last) = (j as f32 * step, cubic.n - j);
        for first in (0..=last).step_by(L) {
            let u: [f32; L] = core::array::from_fn(|lane| (first + lane as u32) as f32 * step);
            let w: [f32; L] = core::array::from_fn(|lane| 1.0 - v - u[lane]);
            let value = |b: &[f32; 10]| {
                let mix = |a: [f32; L], b: [f32; L], c: [f32; L]| -> [f32; L] {
                    core::array::from_fn(|lane| a[lane] * u[lane] + b[lane] * v + c[lane] * w[lane])
                };
                let two = CORNERS.map(|[p, q, r]| mix([b[p]; L], [b[q]; L], [b[r]; L]));
                let one = [mix(two[0], two[1], two[2]), mix(two[1], two[3], two[4]), mix(two[2], two[4], two[5])];
                mix(one[0], one[1], one[2]).map(|x| truncate(x + 0.5))
            };
            let [x, y, z] = net.each_ref().map(value);
            for lane in 0..(last - first + 1).min(L as u32) as usize {
                sink.point(first + lane as u32, j, x[lane], y[lane], z[lane]);
            }
        }
    }
}
