//! The grid of a bicubic patch in 32-bit differences, its edges in 64: the same vertices as the general walk on edges,
//! within 1/128 pixel of them inside, and several times as fast.
//!
//! Columns of the net are cubics in s, rows of the grid cubics in r through what the columns are at s. Coordinates
//! count from a corner of the net's box, so nothing is negative. Values are n³ times those of the cubic in 2^-F pixel,
//! with F as large as 29 bits allow; differences are formed modulo 2^32.

use super::super::depth::DepthWindow;
use super::vertices::{Lit, RowSink, Rows, SEGMENTS, with_room};
use crate::forward::Form;
use crate::patch::SurfaceNet;

/// n³ times a cubic at 0, 1, …, n, and n³ times its derivative by the step.
#[derive(Clone, Copy, Debug, Default)]
struct Cubic {
    value: [i32; 4],
    slope: [i32; 2],
}

impl Cubic {
    /// From control values.
    fn new(p: [i32; 4], n: i32) -> Self {
        let [b1, b2, b3] = power(p);
        let (n1, n2) = (n.wrapping_mul(b2), n.wrapping_mul(n).wrapping_mul(b1));
        let b33 = b3.wrapping_mul(3);
        let n3 = n.wrapping_mul(n).wrapping_mul(n);
        let second = n1.wrapping_add(b33).wrapping_mul(2);
        Self {
            value: [n3.wrapping_mul(p[0]), n2.wrapping_add(n1).wrapping_add(b3), second, b33.wrapping_mul(2)],
            slope: [n2, second.wrapping_sub(b33)],
        }
    }

    #[inline(always)]
    fn step(&mut self) {
        step(&mut self.value);
        self.slope[0] = self.slope[0].wrapping_add(self.slope[1]);
        self.slope[1] = self.slope[1].wrapping_add(self.value[3]);
    }
}

/// Moves differences on by one.
#[inline(always)]
fn step(d: &mut [i32; 4]) {
    d[0] = d[0].wrapping_add(d[1]);
    d[1] = d[1].wrapping_add(d[2]);
    d[2] = d[2].wrapping_add(d[3]);
}

/// The direction of a vector in 14 bits and a sign.
#[inline(always)]
fn direction([x, y, z]: [i32; 3]) -> [i16; 3] {
    let size = (x ^ (x >> 31)) | (y ^ (y >> 31)) | (z ^ (z >> 31));
    let shift = 18_u32.saturating_sub(size.leading_zeros());
    [(x >> shift) as i16, (y >> shift) as i16, (z >> shift) as i16]
}

/// The coefficients of t, t² and t³.
fn power([a, b, c, d]: [i32; 4]) -> [i32; 3] {
    let (ab, bc, cd) = (b.wrapping_sub(a), c.wrapping_sub(b), d.wrapping_sub(c));
    let (abc, bcd) = (bc.wrapping_sub(ab), cd.wrapping_sub(bc));
    [ab.wrapping_mul(3), abc.wrapping_mul(3), bcd.wrapping_sub(abc)]
}

/// n³ times a cubic in 2^-16 pixel at 0, 1, …, n, exact: below 2^40 where [`Bicubic`] takes a net.
#[derive(Clone, Copy, Debug, Default)]
struct Exact([i64; 4]);

impl Exact {
    fn new(p: [i32; 4], n: i32) -> Self {
        let [a, b, c, d] = p.map(i64::from);
        let (n, b1, b2, b3) = (i64::from(n), 3 * (b - a), 3 * (a - 2 * b + c), d - a + 3 * (b - c));
        Self([n * n * n * a, n * n * b1 + n * b2 + b3, 2 * n * b2 + 6 * b3, 6 * b3])
    }

    #[inline(always)]
    fn step(&mut self) {
        let Self(d) = self;
        d[0] += d[1];
        d[1] += d[2];
        d[2] += d[3];
    }
}

/// Division by n³.
#[derive(Clone, Copy, Debug)]
struct Cube {
    cube: u32,
    /// ⌊2^32/n³⌋, for n = 1 one less.
    reciprocal: u32,
}

fn high(a: u32, b: u32) -> u32 {
    ((u64::from(a) * u64::from(b)) >> 32) as u32
}

impl Cube {
    fn of(n: u32) -> Self {
        let cube = n * n * n;
        Self { cube, reciprocal: (1_u64 << 32).checked_div(cube.into()).unwrap_or(0).min(u32::MAX.into()) as u32 }
    }

    /// ⌊a/n³⌋ for a < 2^32, or one less.
    #[inline(always)]
    fn near(self, a: u32) -> u32 {
        high(a, self.reciprocal)
    }

    /// ⌊256·x⌋ of an exact value.
    #[inline(always)]
    fn floor(self, value: &Exact) -> i32 {
        // ⌊v/(2^8·n³)⌋ is ⌊⌊v/2^8⌋/n³⌋; near errs by less than one.
        let a = (value.0[0] >> 8) as u32;
        let near = self.near(a);
        (near + u32::from(a - near * self.cube >= self.cube)) as i32
    }
}

/// The grid of a bicubic patch.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bicubic<'a> {
    net: SurfaceNet<'a>,
    counts: (u32, u32),
    /// The corner of the box that nothing is below, in 1/256 pixel.
    origin: [i32; 3],
    fraction_bits: u32,
}

impl<'a> Bicubic<'a> {
    /// The grid of a bicubic net that fits; `None` for others.
    pub(super) fn of(net: SurfaceNet<'a>, (r, s): (u32, u32)) -> Option<Self> {
        let is_bicubic = matches!(net, SurfaceNet::Tensor(_)) && net.degrees() == (3, 3);
        let n = r.max(s);
        if !is_bicubic || n as usize > SEGMENTS {
            return None;
        }
        let bounds = net.bounds();
        let (low, high) = (bounds.min.to_array(), bounds.max.to_array());
        let origin = low.map(|c| c.to_bits() >> 8);
        let extent = high.iter().zip(origin).map(|(c, o)| (c.to_bits() >> 8).wrapping_sub(o) >> 8).fold(0, i32::max);
        // n³ is at most 2^15, an extent 2^16 pixels.
        let size = 32 - (n * n * n).checked_mul(extent.unsigned_abs() + 1)?.leading_zeros();
        let fraction_bits = 29_u32.checked_sub(size)?.min(16);
        (fraction_bits >= 10 && extent < 1 << 14).then_some(Self { net, counts: (r, s), origin, fraction_bits })
    }

    pub(super) fn form(&self) -> Form<'a> {
        Form::surface(self.net, self.counts)
    }

    /// Coordinates of a column (or of a row) of the net, in 2^-16 pixel from the origin.
    fn line(&self, axis: usize, first: usize, stride: usize) -> [i32; 4] {
        let origin = self.origin[axis] << 8;
        core::array::from_fn(|k| {
            let point = self.net.points().get(first + k * stride);
            point.map_or(0, |p| match axis {
                0 => p.x.to_bits(),
                1 => p.y.to_bits(),
                _ => p.z.to_bits(),
            } - origin)
        })
    }

    /// Walks the grid row by row.
    #[inline(never)]
    pub(super) fn walk(&self, rows: &mut Rows, sink: &mut dyn RowSink, window: DepthWindow, level: Option<Levels<'_>>) {
        let (n_r, n_s) = (self.counts.0 as i32, self.counts.1 as i32);
        let (by_r, by_s) = (Cube::of(self.counts.0), Cube::of(self.counts.1));
        let drop = 16 - self.fraction_bits;
        let column = |axis, a| Cubic::new(self.line(axis, 4 * a, 1).map(|c| c >> drop), n_s);
        let mut columns: [[Cubic; 4]; 3] = core::array::from_fn(|axis| core::array::from_fn(|a| column(axis, a)));
        let mut sides = [0, 12].map(|a| [0, 1, 2].map(|axis| Exact::new(self.line(axis, a, 1), n_s)));
        // 256·x of what is n_r³·2^F·x.
        let scale = by_r.reciprocal;
        let shift = self.fraction_bits - 8;
        for j in 0..=n_s {
            let is_edge = j == 0 || j == n_s;
            let end = if j == 0 { 0 } else { 3 };
            let mut row: [Cubic; 3] = core::array::from_fn(|axis| {
                Cubic::new(columns[axis].map(|c| by_s.near(c.value[0] as u32) as i32), n_r)
            });
            let mut edge = [Exact::default(); 3];
            if is_edge {
                edge = core::array::from_fn(|axis| Exact::new(self.line(axis, end, 4), n_r));
            }
            let mut across = Across::default();
            if level.is_none() {
                across = Across::new(&columns, n_r);
            }
            let out = &mut rows.0[(j & 1) as usize];
            for (i, slot) in out.iter_mut().enumerate().take(n_r as usize + 1) {
                let i = i as i32;
                let place = if i == 0 {
                    exact(&sides[0], by_s)
                } else if i == n_r {
                    exact(&sides[1], by_s)
                } else if is_edge {
                    exact(&edge, by_r)
                } else {
                    let [x, y, z] = &row;
                    let near = |c: &Cubic| (high(c.value[0] as u32, scale) >> shift) as i32;
                    [near(x), near(y), near(z)]
                };
                let depth = window.depth_of_256(self.origin[2] + place[2]);
                (slot.x, slot.y) = (self.origin[0] + place[0], self.origin[1] + place[1]);
                slot.depth = with_room(depth);
                let [x, y, z] = &mut row;
                match level {
                    Some(level) => (slot.level, slot.lit) = (level(depth), Lit::Both),
                    None => {
                        slot.lit = Lit::Unknown;
                        slot.tangents = across.tangents([x.slope[0], y.slope[0], z.slope[0]], (i, n_r), j == 0);
                        across.step();
                    }
                }
                x.step();
                y.step();
                z.step();
                if is_edge {
                    edge.iter_mut().for_each(Exact::step);
                }
            }
            sink.row(rows, j as u32, n_r as usize + 1);
            columns.as_flattened_mut().iter_mut().for_each(Cubic::step);
            sides.as_flattened_mut().iter_mut().for_each(Exact::step);
        }
    }
}

fn exact([x, y, z]: &[Exact; 3], by: Cube) -> [i32; 3] {
    [by.floor(x), by.floor(y), by.floor(z)]
}

/// Whether no facet of a bicubic patch can look at the viewer: on the screen, every difference along r crosses every one
/// along s with the same sign. Sides of cells are sums of such differences with positive factors.
///
/// Cost: at most 144 products of two vectors, where it is true; mostly a few.
pub(super) fn faces_away(net: SurfaceNet<'_>, inward: bool) -> bool {
    let points = net.points();
    let (SurfaceNet::Tensor(_), (3, 3)) = (net, net.degrees()) else { return false };
    let place = |k: usize| points.get(k).map_or([0; 2], |p| [p.x.to_bits() >> 4, p.y.to_bits() >> 4]);
    let minus = |to: usize, from: usize| {
        let (a, b) = (place(to), place(from));
        [a[0] - b[0], a[1] - b[1]]
    };
    let along_r: [[i32; 2]; 12] = core::array::from_fn(|k| minus(k + 4, k));
    (0..4).all(|i| {
        (0..3).all(|j| {
            let s = minus(4 * i + j + 1, 4 * i + j);
            along_r.iter().all(|r| {
                // Negative where S_r × S_s looks at the viewer. Differences have 29 bits.
                let cross = i64::from(r[0]) * i64::from(s[1]) - i64::from(r[1]) * i64::from(s[0]);
                if inward { cross <= 0 } else { cross >= 0 }
            })
        })
    })
}

/// The level of a depth, where it does not depend on a normal.
pub(super) type Levels<'l> = &'l dyn Fn(u16) -> u8;

/// S_s along a row.
#[derive(Clone, Copy, Debug, Default)]
struct Across {
    row: [[i32; 4]; 3],
    /// Control values of the row, in 14 bits.
    control: [[i32; 4]; 3],
}

impl Across {
    fn new(columns: &[[Cubic; 4]; 3], n_r: i32) -> Self {
        let all = columns.as_flattened().iter().fold(0, |all, c| all | (c.slope[0] ^ (c.slope[0] >> 31)));
        // n_r³ is at most 2^15: 14 bits and a sign fit.
        let shift = (32 - all.leading_zeros()).saturating_sub(14);
        let control = columns.map(|axis| axis.map(|c| c.slope[0] >> shift));
        Self { row: control.map(|p| Cubic::new(p, n_r).value), control }
    }

    #[inline(always)]
    fn step(&mut self) {
        let [x, y, z] = &mut self.row;
        step(x);
        step(y);
        step(z);
    }

    /// Directions of S_r and S_s at step i of n; where one vanishes, of what it grows from.
    #[inline(always)]
    fn tangents(&self, along: [i32; 3], at: (i32, i32), is_first: bool) -> [[i16; 3]; 2] {
        let (r, s) = (direction(along), direction([self.row[0][0], self.row[1][0], self.row[2][0]]));
        if r[0] | r[1] | r[2] == 0 || s[0] | s[1] | s[2] == 0 { self.limit([r, s], at, is_first) } else { [r, s] }
    }

    /// Next to r = 0, S_s grows as r·S_rs; next to r = 1 as −(1 − r)·S_rs; S_r likewise.
    #[cold]
    #[inline(never)]
    fn limit(&self, [r, s]: [[i16; 3]; 2], (i, n): (i32, i32), is_first: bool) -> [[i16; 3]; 2] {
        let twist =
            self.control.map(|[a, b, c, d]| (n - i) * (n - i) * (b - a) + 2 * i * (n - i) * (c - b) + i * i * (d - c));
        let from = |start: bool| direction(if start { twist } else { twist.map(|c| -c) });
        match (r == [0; 3], s == [0; 3]) {
            (true, false) => [from(is_first), s],
            (false, true) => [r, from(i == 0)],
            _ => [r, s],
        }
    }
}
