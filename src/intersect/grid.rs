//! Canonical integer grids of vertices and pyramids of boxes over them.
//!
//! Vertex (i, j) of depth m is the exact surface point at (i/2^m, j/2^m), rounded once, half up, to 2^-16 unit: it depends
//! on the rational parameters alone, so grids of different depths are nested and neighbours agree. A triangle has the
//! vertices with i + j ≤ 2^m. Cell (i, j) has a lower triangle (i, j), (i+1, j), (i, j+1) and, where the domain goes on,
//! an upper one (i+1, j+1), (i, j+1), (i+1, j).

use super::IntersectError;
use super::predicate::{is_degenerate, normal};
use crate::num::{BINOMIAL, Coord, I16F16, div_half_up};
use crate::patch::{Barycentric, MAX_DEGREE, Parameter, SurfaceNet, triangle_index};

/// A vertex in units of 2^-16.
pub type GridVertex = [i32; 3];

/// The smallest and the largest coordinates of a part of a grid, in units of 2^-16.
pub type GridBox = [[i32; 3]; 2];

const EMPTY: GridBox = [[i32::MAX; 3], [i32::MIN; 3]];

/// Vertices of a grid.
pub(super) const fn vertex_count(triangle: bool, depth: u32) -> usize {
    let n = (1_usize << depth) + 1;
    if triangle { n * (n + 1) / 2 } else { n * n }
}

/// Boxes of the levels 0 ..= `level`.
pub(super) const fn box_count(level: u32) -> usize {
    ((1_usize << (2 * (level + 1))) - 1) / 3
}

/// Vertices and boxes of one patch.
#[derive(Clone, Copy, Debug)]
pub(super) struct Grid<'b> {
    pub(super) triangle: bool,
    pub(super) depth: u32,
    vertices: &'b [GridVertex],
    boxes: &'b [GridBox],
    /// Levels whose boxes are stored, from the root; boxes below are made when asked for.
    stored: u32,
}

impl<'b> Grid<'b> {
    /// The grid of a patch in these buffers; the levels of boxes that there is room for.
    pub(super) fn new(
        net: SurfaceNet<'_>,
        depth: u32,
        vertices: &'b mut [GridVertex],
        boxes: &'b mut [GridBox],
    ) -> Result<Self, IntersectError> {
        let triangle = net.is_triangle();
        fill(net, depth, vertices)?;
        let stored = (0..=depth).rev().find(|level| box_count(*level) <= boxes.len());
        let stored = stored.ok_or(IntersectError::BoxBuffer { needed: 2, given: boxes.len() })?;
        let bare = Grid { triangle, depth, vertices, boxes: &[], stored: 0 };
        let first = box_count(stored) - (1 << (2 * stored));
        for i in 0..1_usize << stored {
            for j in 0..1_usize << stored {
                if let Some(out) = boxes.get_mut(first + (i << stored) + j) {
                    *out = bare.scan(stored, i, j);
                }
            }
        }
        for level in (0..stored).rev() {
            let (here, below) = (box_count(level) - (1 << (2 * level)), box_count(level));
            for at in 0..1_usize << (2 * level) {
                let (i, j) = (at >> level, at & ((1 << level) - 1));
                let child = |di: usize, dj: usize| below + ((2 * i + di) << (level + 1)) + 2 * j + dj;
                let parts = [child(0, 0), child(0, 1), child(1, 0), child(1, 1)];
                let union = parts.iter().filter_map(|p| boxes.get(*p)).fold(EMPTY, |a, b| union(&a, b));
                if let Some(out) = boxes.get_mut(here + at) {
                    *out = union;
                }
            }
        }
        Ok(Grid { boxes, stored, ..bare })
    }

    pub(super) fn vertex(&self, i: usize, j: usize) -> GridVertex {
        self.vertices.get(index(self.triangle, self.depth, i, j)).copied().unwrap_or([0; 3])
    }

    /// Whether cell (i, j) has its upper triangle.
    pub(super) fn has_upper(&self, i: usize, j: usize) -> bool {
        !self.triangle || i + j + 2 <= 1 << self.depth
    }

    /// Whether a node of a level lies in the domain.
    pub(super) fn exists(&self, level: u32, i: usize, j: usize) -> bool {
        !self.triangle || i + j < 1 << level
    }

    /// The box of a node that exists.
    pub(super) fn bounds(&self, level: u32, i: usize, j: usize) -> GridBox {
        if level <= self.stored {
            let at = box_count(level) - (1 << (2 * level)) + (i << level) + j;
            return self.boxes.get(at).copied().unwrap_or(EMPTY);
        }
        self.scan(level, i, j)
    }

    /// Whether any triangle has a normal.
    pub(super) fn has_normal(&self) -> bool {
        let n = 1_usize << self.depth;
        (0..n).any(|i| {
            (0..n).any(|j| {
                let (row, column) = (i * 5 % n, j * 7 % n);
                self.exists(self.depth, row, column) && {
                    let corners = [(row, column), (row + 1, column), (row, column + 1)];
                    !is_degenerate(&normal(corners.map(|(i, j)| self.vertex(i, j))))
                }
            })
        })
    }

    fn scan(&self, level: u32, i: usize, j: usize) -> GridBox {
        let shift = self.depth - level;
        let mut out = EMPTY;
        if !self.exists(level, i, j) {
            return out;
        }
        for a in i << shift..=(i + 1) << shift {
            let mut end = (j + 1) << shift;
            if self.triangle {
                end = end.min((1_usize << self.depth).saturating_sub(a));
            }
            let first = index(self.triangle, self.depth, a, j << shift);
            let count = (end + 1).saturating_sub(j << shift);
            for v in self.vertices.iter().skip(first).take(count) {
                out = union(&out, &[*v; 2]);
            }
        }
        out
    }
}

pub(super) fn union(a: &GridBox, b: &GridBox) -> GridBox {
    let mut out = *a;
    for k in 0..3 {
        out[0][k] = out[0][k].min(b[0][k]);
        out[1][k] = out[1][k].max(b[1][k]);
    }
    out
}

/// Where vertex (i, j) stands.
fn index(triangle: bool, depth: u32, i: usize, j: usize) -> usize {
    let n = (1_usize << depth) + 1;
    // Rows of a triangle shrink by one: i·n − (0 + 1 + … + (i−1)).
    if triangle { i * n + j - (i * i.saturating_sub(1)) / 2 } else { i * n + j }
}

/// Writes all vertices.
fn fill(net: SurfaceNet<'_>, depth: u32, out: &mut [GridVertex]) -> Result<(), IntersectError> {
    let needed = vertex_count(net.is_triangle(), depth);
    let given = out.len();
    let Some(out) = out.get_mut(..needed) else { return Err(IntersectError::VertexBuffer { needed, given }) };
    let (m, h) = net.degrees();
    let degrees = if net.is_triangle() { m } else { m + h } as u32;
    let largest = net.points().iter().flat_map(|p| p.to_array()).fold(1, |l, c| c.bits().abs().max(l));
    let heaviest = net.weights().map_or(1, |w| w.iter().fold(1, |l, w| w.to_bits().max(l)));
    let bits = 64 - largest.leading_zeros() + 32 - heaviest.leading_zeros() + degrees * depth;
    match (net.weights().is_some(), bits) {
        (false, 0..=61) => by_differences::<i64>(net, depth, out),
        (_, 0..=122) => by_differences::<i128>(net, depth, out),
        _ => one_by_one(net, depth, out),
    }
    Ok(())
}

/// Integers with arithmetic modulo 2^w: only the values themselves fit.
trait Integer: Copy {
    const ZERO: Self;
    fn of(value: i64) -> Self;
    fn add(self, other: Self) -> Self;
    fn sub(self, other: Self) -> Self;
    fn mul(self, other: Self) -> Self;
    /// `floor(self / 2^shift + 1/2)`.
    fn round(self, shift: u32) -> i32;
    fn over(self, divisor: Self) -> i32;
}

macro_rules! integer {
    ($type:ty) => {
        impl Integer for $type {
            const ZERO: Self = 0;
            #[inline]
            fn of(value: i64) -> Self {
                value as $type
            }
            #[inline]
            fn add(self, other: Self) -> Self {
                self.wrapping_add(other)
            }
            #[inline]
            fn sub(self, other: Self) -> Self {
                self.wrapping_sub(other)
            }
            #[inline]
            fn mul(self, other: Self) -> Self {
                self.wrapping_mul(other)
            }
            #[inline]
            fn round(self, shift: u32) -> i32 {
                (self.wrapping_add((1 << shift) >> 1) >> shift) as i32
            }
            #[inline]
            fn over(self, divisor: Self) -> i32 {
                div_half_up(self as i128, divisor as i128).unwrap_or(0) as i32
            }
        }
    };
}

integer!(i64);
integer!(i128);

const ORDER: usize = MAX_DEGREE + 1;

/// A power that exists: no degree is above [`MAX_DEGREE`].
fn at<T: Integer>(powers: &[T; ORDER], k: usize) -> T {
    powers[k.min(MAX_DEGREE)]
}

/// C(n, k).
fn choose<T: Integer>(n: usize, k: usize) -> T {
    T::of(BINOMIAL[n.min(MAX_DEGREE)][k.min(MAX_DEGREE)].into())
}

/// x^0 ..= x^8.
fn powers<T: Integer>(x: i64) -> [T; ORDER] {
    let mut out = [T::of(1); ORDER];
    for k in 1..ORDER {
        out[k] = out[k - 1].mul(T::of(x));
    }
    out
}

/// Each row by forward differences: the first values are direct sums with integer weights, the rest are additions.
#[inline(never)]
fn by_differences<T: Integer>(net: SurfaceNet<'_>, depth: u32, out: &mut [GridVertex]) {
    let n = 1_i64 << depth;
    let (m, h) = net.degrees();
    let (m, h) = (m.min(MAX_DEGREE), h.min(MAX_DEGREE));
    let triangle = net.is_triangle();
    let axes = if net.weights().is_some() { 4 } else { 3 };
    let shift = depth * if triangle { m } else { m + h } as u32;
    let mut rest = out;
    for i in 0..=n {
        let length = if triangle { n - i + 1 } else { n + 1 } as usize;
        let Some((row, after)) = core::mem::take(&mut rest).split_at_mut_checked(length) else { return };
        rest = after;
        let mut tables = [[T::ZERO; ORDER]; 4];
        for (axis, table) in tables.iter_mut().enumerate().take(axes) {
            let coefficients = if triangle { [T::ZERO; ORDER] } else { across(net, (m, h), axis, (i, n)) };
            for (j, value) in (0..).zip(table.iter_mut().take(h + 1)) {
                *value = if triangle {
                    over_triangle(net, m, axis, [i, j, n - i - j])
                } else {
                    along(&coefficients, h, j, n - j)
                };
            }
            for order in 1..=h {
                for k in (order..=h).rev() {
                    let k = k.clamp(1, MAX_DEGREE);
                    table[k] = table[k].sub(table[k - 1]);
                }
            }
        }
        for vertex in row {
            for (c, table) in vertex.iter_mut().zip(&tables) {
                *c = if axes == 4 { table[0].over(tables[3][0]) } else { table[0].round(shift) };
            }
            for table in tables.iter_mut().take(axes) {
                for k in 0..h {
                    let k = k.min(MAX_DEGREE - 1);
                    table[k] = table[k].add(table[k + 1]);
                }
            }
        }
    }
}

/// Homogeneous coordinate `axis` of control point `at`; the weight is axis 3.
fn homogeneous(net: SurfaceNet<'_>, at: usize, axis: usize) -> i64 {
    let weight = net.weights().map_or(1, |w| w.get(at).map_or(1, |w| i64::from(w.to_bits())));
    let coordinate = net.points().get(at).map_or(0, |p| match axis {
        0 => p.x.bits(),
        1 => p.y.bits(),
        2 => p.z.bits(),
        _ => 1,
    });
    coordinate * weight
}

/// Coefficients of the powers of a row i of a tensor-product net: Σ_a C(m,a) i^a (n−i)^(m−a) c_ab.
fn across<T: Integer>(net: SurfaceNet<'_>, (m, h): (usize, usize), axis: usize, (i, n): (i64, i64)) -> [T; ORDER] {
    let (up, down) = (powers::<T>(i), powers::<T>(n - i));
    let mut out = [T::ZERO; ORDER];
    for a in 0..=m {
        let weight = at(&up, a).mul(at(&down, m - a)).mul(choose(m, a));
        for (b, out) in out.iter_mut().enumerate().take(h + 1) {
            let c = T::of(homogeneous(net, a * (h + 1) + b, axis));
            *out = out.add(weight.mul(c).mul(choose(h, b)));
        }
    }
    out
}

/// The value at (i, j, k) of a triangular net: Σ n!/(a!b!c!) i^a j^b k^c b_abc, homogeneous of degree n.
fn over_triangle<T: Integer>(net: SurfaceNet<'_>, n: usize, axis: usize, [i, j, k]: [i64; 3]) -> T {
    let [of_i, of_j, of_k] = [i, j, k].map(powers::<T>);
    let mut sum = T::ZERO;
    for beyond in 0..=n {
        let a = n - beyond;
        for c in 0..=beyond {
            let b = beyond - c;
            let arrangements = choose::<T>(n, a).mul(choose(beyond, b));
            let point = T::of(homogeneous(net, triangle_index(b, c), axis)).mul(arrangements);
            sum = sum.add(at(&of_i, a).mul(at(&of_j, b)).mul(at(&of_k, c)).mul(point));
        }
    }
    sum
}

/// Σ_b `coefficients`_b j^b k^(h−b).
fn along<T: Integer>(coefficients: &[T; ORDER], h: usize, j: i64, k: i64) -> T {
    let (up, down) = (powers::<T>(j), powers::<T>(k));
    let mut sum = T::ZERO;
    for b in 0..=h.min(MAX_DEGREE) {
        sum = sum.add(at(coefficients, b).mul(at(&up, b)).mul(at(&down, h.saturating_sub(b))));
    }
    sum
}

/// The same by exact evaluation in 640 bits, for nets too wide for the rest.
#[inline(never)]
fn one_by_one(net: SurfaceNet<'_>, depth: u32, out: &mut [GridVertex]) {
    let n = 1_u32 << depth;
    let mut place = out.iter_mut();
    for i in 0..=n {
        let last = if net.is_triangle() { n - i } else { n };
        for j in 0..=last {
            if let Some(out) = place.next() {
                *out = exact(net, i, j, n).unwrap_or([0; 3]);
            }
        }
    }
}

/// The vertex at (i/n, j/n); `None` for i or j above n, or i + j above n in a triangle.
fn exact(net: SurfaceNet<'_>, i: u32, j: u32, n: u32) -> Option<GridVertex> {
    let (u, v) = (Parameter::new(i, n).ok()?, Parameter::new(j, n).ok()?);
    let corner = || Barycentric::new(i, j, n.checked_sub(i + j)?).ok();
    let point = match net {
        SurfaceNet::Triangle(net) => net.eval(corner()?),
        SurfaceNet::Tensor(net) => net.eval(u, v),
        SurfaceNet::RationalTriangle(net) => net.eval(corner()?),
        SurfaceNet::RationalTensor(net) => net.eval(u, v),
    };
    Some(point.to_array().map(I16F16::to_bits))
}
