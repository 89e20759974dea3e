//! The grid of a bicubic patch in 32-bit differences, its edges in 64: the same vertices as the general walk on edges,
//! within 1/128 pixel of them inside, and many times as fast.
//!
//! Columns of the net are cubics in s, rows of the grid cubics in r through what the columns are at s. Coordinates
//! count from a corner of the net's box, so nothing is negative. Values are n³ times those of the cubic in 2^-F pixel,
//! with F as large as 29 bits allow; differences are formed modulo 2^32. A row is walked an axis at a time: the state of
//! one cubic stays in registers. Tangents are evaluated where a facet asks for them, from polynomials of the row.

use super::super::depth::DepthWindow;
use super::vertices::{Lit, RowSink, Rows, SEGMENTS, Tangents, Vertex, with_room};
use crate::forward::Form;
use crate::num::{Factor, leading_zeros};
use crate::patch::SurfaceNet;

/// n³ times a cubic at 0, 1, …, n, by differences; the second and the third are halved.
#[derive(Clone, Copy, Debug, Default)]
struct Cubic {
    value: i32,
    first: i32,
    second: i32,
    third: i32,
}

impl Cubic {
    /// From control values.
    fn new(p: [i32; 4], n: i32) -> Self {
        Self::of(p[0], power(p), n)
    }

    /// From the value at 0 and the coefficients of t, t² and t³.
    #[inline(always)]
    fn of(start: i32, [b1, b2, b3]: [i32; 3], n: i32) -> Self {
        let (n1, n2) = (n.wrapping_mul(b2), n.wrapping_mul(n));
        let third = b3.wrapping_mul(3);
        Self {
            value: n2.wrapping_mul(n).wrapping_mul(start),
            first: n2.wrapping_mul(b1).wrapping_add(n1).wrapping_add(b3),
            second: n1.wrapping_add(third),
            third,
        }
    }

    #[inline(always)]
    fn step(&mut self) {
        self.value = self.value.wrapping_add(self.first);
        self.first = self.first.wrapping_add(self.second.wrapping_mul(2));
        self.second = self.second.wrapping_add(self.third);
    }

    /// n³ times the derivative by the step: the first difference less half the second and a third of the third one.
    #[inline(always)]
    fn slope(&self) -> i32 {
        // 2/3 modulo 2^32: the third difference is a multiple of 3.
        const TWO_THIRDS: i32 = 0x5555_5556;
        self.first.wrapping_sub(self.second).wrapping_add(self.third.wrapping_mul(TWO_THIRDS))
    }
}

/// The direction of a vector in 14 bits and a sign.
#[inline(always)]
fn direction([x, y, z]: [i32; 3]) -> [i16; 3] {
    let size = (x ^ (x >> 31)) | (y ^ (y >> 31)) | (z ^ (z >> 31));
    let shift = 18_u32.saturating_sub(leading_zeros(size as u32));
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
    reciprocal: Factor,
}

impl Cube {
    fn of(n: u32) -> Self {
        let cube = n * n * n;
        // 1 more than ⌊(2^32 − 1)/n³⌋ for powers of two alone.
        let reciprocal = u32::MAX.checked_div(cube).unwrap_or(0) + u32::from(cube.is_power_of_two() && cube > 1);
        Self { cube, reciprocal: Factor::new(reciprocal) }
    }

    /// ⌊a/n³⌋ for a < 2^32, or one less.
    #[inline(always)]
    fn near(self, a: u32) -> u32 {
        self.reciprocal.high(a)
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
    /// Segments of a row, and of a column.
    counts: (u32, u32),
    /// Whether rows run along s, the direction of more segments: a row's start costs as much as several vertices.
    is_turned: bool,
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
        let (counts, is_turned) = ((n, r.min(s)), s > r);
        (fraction_bits >= 10 && extent < 1 << 14).then_some(Self { net, counts, is_turned, origin, fraction_bits })
    }

    pub(super) fn form(&self) -> Form<'a> {
        let (long, short) = self.counts;
        Form::surface(self.net, if self.is_turned { (short, long) } else { (long, short) })
    }

    /// Whether what the walk calls r is s, and the other way round.
    pub(super) fn is_turned(&self) -> bool {
        self.is_turned
    }

    /// Coordinates of the column `k` of the net, across the rows of the grid, in 2^-16 pixel from the origin.
    fn column(&self, axis: usize, k: usize) -> [i32; 4] {
        if self.is_turned { self.line(axis, k, 4) } else { self.line(axis, 4 * k, 1) }
    }

    /// Coordinates of the row `k` of the net.
    fn row(&self, axis: usize, k: usize) -> [i32; 4] {
        if self.is_turned { self.line(axis, 4 * k, 1) } else { self.line(axis, k, 4) }
    }

    fn line(&self, axis: usize, first: usize, stride: usize) -> [i32; 4] {
        let origin = self.origin.get(axis).map_or(0, |c| c << 8);
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
        let mut columns = [[Cubic::default(); 4]; 3];
        for (axis, columns) in columns.iter_mut().enumerate() {
            for (a, column) in columns.iter_mut().enumerate() {
                *column = Cubic::new(self.column(axis, a).map(|c| c >> drop), n_s);
            }
        }
        let mut sides = [0, 3].map(|a| [0, 1, 2].map(|axis| Exact::new(self.column(axis, a), n_s)));
        let put = Put { origin: self.origin, window, level };
        let mut slopes = Slopes([Slope::default(); 2]);
        for j in 0..=n_s {
            let Some(out) = rows.0[(j & 1) as usize].get_mut(..=n_r as usize) else { return };
            let slope = &mut slopes.0[(j & 1) as usize];
            if level.is_none() {
                slope.across = across(&columns, n_r);
            }
            let grid = Row { put: &put, by_r, by_s, fraction_bits: self.fraction_bits };
            let mut control = [[0; 4]; 3];
            for ((control, along), columns) in control.iter_mut().zip(&mut slope.along).zip(&columns) {
                *control = columns.map(|column| by_s.near(column.value as u32) as i32);
                let [b1, b2, b3] = power(*control);
                let n_b2 = n_r.wrapping_mul(b2);
                *along = [n_r.wrapping_mul(n_r).wrapping_mul(b1), n_b2.wrapping_mul(2), b3.wrapping_mul(3)];
            }
            if j == 0 || j == n_s {
                let end = if j == 0 { 0 } else { 3 };
                grid.edge::<0>(out, Exact::new(self.row(0, end), n_r));
                grid.edge::<1>(out, Exact::new(self.row(1, end), n_r));
                grid.edge::<2>(out, Exact::new(self.row(2, end), n_r));
            } else {
                grid.inside::<0>(out, Cubic::new(control[0], n_r));
                grid.inside::<1>(out, Cubic::new(control[1], n_r));
                grid.inside::<2>(out, Cubic::new(control[2], n_r));
            }
            if let [first, .., last] = out {
                grid.exact(first, &sides[0]);
                grid.exact(last, &sides[1]);
            }
            sink.row(rows, &slopes, j as u32, n_r as usize + 1);
            columns.as_flattened_mut().iter_mut().for_each(Cubic::step);
            sides.as_flattened_mut().iter_mut().for_each(Exact::step);
        }
    }
}

/// Where coordinates of vertices go.
struct Put<'l> {
    origin: [i32; 3],
    window: DepthWindow,
    level: Option<Levels<'l>>,
}

impl Put<'_> {
    /// One coordinate of a vertex in 1/256 pixel from the origin.
    #[inline(always)]
    fn vertex<const AXIS: usize>(&self, vertex: &mut Vertex, c: i32) {
        let c = self.origin[AXIS] + c;
        match AXIS {
            0 => vertex.x = c,
            1 => vertex.y = c,
            _ => {
                let depth = self.window.depth_of_256(c);
                vertex.depth = with_room(depth);
                (vertex.level, vertex.lit) = match self.level {
                    Some(level) => (level(depth), Lit::Both),
                    None => (0, Lit::Unknown),
                };
            }
        }
    }
}

/// A row of the grid on its way to its vertices.
struct Row<'p> {
    put: &'p Put<'p>,
    by_r: Cube,
    by_s: Cube,
    fraction_bits: u32,
}

impl Row<'_> {
    /// One coordinate of the vertices of a row.
    #[inline(always)]
    fn inside<const AXIS: usize>(&self, row: &mut [Vertex], mut cubic: Cubic) {
        // 256·x of what is n³·2^F·x.
        let shift = self.fraction_bits - 8;
        for vertex in row {
            self.put.vertex::<AXIS>(vertex, (self.by_r.near(cubic.value as u32) >> (shift & 31)) as i32);
            cubic.step();
        }
    }

    /// One coordinate of the vertices of an edge.
    #[inline(always)]
    fn edge<const AXIS: usize>(&self, row: &mut [Vertex], mut cubic: Exact) {
        for vertex in row {
            self.put.vertex::<AXIS>(vertex, self.by_r.floor(&cubic));
            cubic.step();
        }
    }

    /// The end of a row, on a side.
    #[inline(always)]
    fn exact(&self, vertex: &mut Vertex, [x, y, z]: &[Exact; 3]) {
        self.put.vertex::<0>(vertex, self.by_s.floor(x));
        self.put.vertex::<1>(vertex, self.by_s.floor(y));
        self.put.vertex::<2>(vertex, self.by_s.floor(z));
    }
}

/// The level of a depth, where it does not depend on a normal.
pub(super) type Levels<'l> = &'l dyn Fn(u16) -> u8;

/// The tangents of a row: per axis, the coefficients of n³·S_r and n³·S_s by powers of the column, up to one factor for
/// each.
#[derive(Clone, Copy, Debug, Default)]
struct Slope {
    along: [[i32; 3]; 3],
    across: [[i32; 4]; 3],
}

/// S_s along a row. Control values are taken in 14 bits and a sign: n³ is at most 2^15, so that the products fit.
fn across(columns: &[[Cubic; 4]; 3], n: i32) -> [[i32; 4]; 3] {
    let control = columns.map(|axis| axis.map(|column| column.slope()));
    let size = control.as_flattened().iter().fold(0, |all, c| all | (c ^ (c >> 31)));
    let shift = 18_u32.saturating_sub(size.leading_zeros());
    control.map(|axis| {
        let p = axis.map(|c| c >> shift);
        let [b1, b2, b3] = power(p);
        let n2 = n.wrapping_mul(n);
        [n2.wrapping_mul(n).wrapping_mul(p[0]), n2.wrapping_mul(b1), n.wrapping_mul(b2), b3]
    })
}

/// The tangents of rows j − 1 and j; row j stands at j mod 2.
#[derive(Clone, Copy, Debug)]
struct Slopes([Slope; 2]);

impl Tangents for Slopes {
    /// Directions of S_r and S_s; where one vanishes, of what it grows from.
    fn tangents(&self, i: u32, j: u32) -> [[i16; 3]; 2] {
        let (slope, at) = (&self.0[(j & 1) as usize], i as i32);
        let along = |[a, b, c]: [i32; 3]| c.wrapping_mul(at).wrapping_add(b).wrapping_mul(at).wrapping_add(a);
        let across = |[a, b, c, d]: [i32; 4]| along([b, c, d]).wrapping_mul(at).wrapping_add(a);
        let ([u, v, w], [x, y, z]) = (slope.along, slope.across);
        let r = direction([along(u), along(v), along(w)]);
        let s = direction([across(x), across(y), across(z)]);
        if r[0] | r[1] | r[2] == 0 || s[0] | s[1] | s[2] == 0 { self.limit([r, s], i, j) } else { [r, s] }
    }
}

impl Slopes {
    /// Next to r = 0, S_s grows as r·S_rs; next to r = 1 as −(1 − r)·S_rs; S_r likewise.
    #[cold]
    #[inline(never)]
    fn limit(&self, [r, s]: [[i16; 3]; 2], i: u32, j: u32) -> [[i16; 3]; 2] {
        let at = i as i32;
        let twist = self.0[(j & 1) as usize].across.map(|[_, b, c, d]| b + 2 * c * at + 3 * d * at * at);
        let from = |start: bool| direction(if start { twist } else { twist.map(|c| -c) });
        match (r == [0; 3], s == [0; 3]) {
            (true, false) => [from(j == 0), s],
            (false, true) => [r, from(i == 0)],
            _ => [r, s],
        }
    }
}
