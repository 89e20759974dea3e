//! The points of a piece of degree 3 or less: fixed point for speed, exact arithmetic where that is in doubt.
//!
//! In comes a polynomial tensor-product net and its step counts; out go the pixels ⌊S + 1/2⌋ of its exact lattice points,
//! row by row, and where they are seen their normals.
//!
//! # How
//! All values are taken from the first control point on, in 2^-F pixel. A row is b0 + b1·t + b2·t² + b3·t³ along each axis;
//! its coefficients are cubics in s, whose own coefficients are found once. A row is walked by differences with 4 bits
//! more, an axis at a time, so that the state of one cubic stays in registers: three additions and a shift a point. Where
//! the fraction of x or y is too close to a pixel's border, [`exact`] decides.
//!
//! # Why it is right
//! Rows are kept as b0, 4·b1, 2·b2 and 2·b3: what their differences are sums of, in products of 32 bits. F is taken such that
//! the cubics in s, times the powers of two that [`at`] wants, are below 2^29, that of the last one below 2^27. Then all sums
//! fit. With E the largest difference of neighbours in the net, none is above 768·E: nets of which that does not fit to begin
//! with drop low bits. Most have a tenth of it or less.
//!
//! Each [`high`] rounds down by less than one unit, so a value by `at` is within 3 units, and a parameter in 2^-31, within
//! two of them, adds less than one. At the start of a run a value is within 14 units, and so it would be along the exact
//! cubic from there: 7 for b0 to b3, or 32 where the run does not start at t = 0; 3 more where bits of the net were
//! dropped.
//!
//! A run has at most [`RUN`] points. Its differences, in 2^-(F+4), are off by 3.75·2^e, 2.5·2^e' and 1.25·2^e' of those
//! units, with the shifts of [`Differences`]: after k ≤ min(n, 31) steps, for which e and e' are made, the sum is off by at
//! most 3.75·2^e·k + 2.5·2^e'·k(k−1)/2 + 1.25·2^e'·k(k−1)(k−2)/6 of those units, which is 453 of 2^-F. The factors 1/n, 1/n²
//! and 1/n³, within 2^-29, 2^-27 and 2^-25 of themselves, add 9 units, dropping 4 bits at each step up to 31. In all that
//! is below 600; [`DOUBT`] is more.
//!
//! Depths are those of the fixed-point z: within one unit of the exact ones where F is 16 or more.

mod corners;
mod exact;
mod row;
mod run;
mod slopes;
mod steps;
mod tangents;

#[cfg(all(test, feature = "std"))]
mod tests;

use super::brush::Shading;
use super::light::Side;
use super::pen::{Ink, Stain};
use super::tile::Area;
use crate::geometry::Point3;
use crate::num::{At, cubic_at, high, leading_zeros};
use crate::patch::{Surface, SurfaceNet};
pub(super) use corners::Corners;
use row::{Row, Units};
use run::{DOUBT, Depths, Line, Pixels, Points, RUN, Raster};
pub(super) use slopes::RowSlopes;
use steps::{Differences, Parameters};
use tangents::RowTangents;

/// The most bits that values have more than the net.
const MOST_MORE: i32 = 12;

/// A cubic c0 + c1·t + c2·t² + c3·t³ as c0, 2·c1, 4·c2, 8·c3.
type Cubic = [i32; 4];

/// A row b0 + b1·t + b2·t² + b3·t³ as b0, 4·b1, 2·b2, 2·b3.
type RowCubic = [i32; 4];

/// A cubic at a parameter in 2^-31, rounded down by less than 3.
#[inline(always)]
fn at(c: &Cubic, t: i32) -> i32 {
    cubic_at(c, t)
}

/// The leading zeros of magnitudes.
fn zeros(all: i32) -> i32 {
    leading_zeros(all as u32 | 1) as i32
}

/// The magnitude of a number, or one less.
#[inline(always)]
const fn magnitude(c: i32) -> i32 {
    c ^ (c >> 31)
}

/// The factors of first, second and third differences: n, n(n−1)/2, 1 for n = 3.
const FACTORS: [[i32; 3]; 4] = [[0, 0, 0], [1, 0, 0], [2, 1, 0], [3, 3, 1]];

/// c0, c1, c2, c3 of a cubic with these control values, of the degree that the factors belong to.
#[inline(always)]
fn power(p: [i32; 4], factors: &[i32; 3]) -> [i32; 4] {
    let (u, v, w) = (p[1].wrapping_sub(p[0]), p[2].wrapping_sub(p[1]), p[3].wrapping_sub(p[2]));
    let (vu, wv) = (v.wrapping_sub(u), w.wrapping_sub(v));
    [p[0], u.wrapping_mul(factors[0]), vu.wrapping_mul(factors[1]), wv.wrapping_sub(vu).wrapping_mul(factors[2])]
}

#[inline(always)]
fn scaled([a, b, c, d]: [i32; 4]) -> Cubic {
    [a, b.wrapping_shl(1), c.wrapping_shl(2), d.wrapping_shl(3)]
}

/// Where points go.
pub(super) struct Target<'t> {
    pub(super) area: Area,
    pub(super) depth: &'t mut [u16],
    pub(super) shading: Shading<'t>,
    pub(super) ink: Ink,
    pub(super) side: Side,
    /// Whether points may be in columns outside the tile.
    pub(super) is_wide: bool,
    pub(super) points: &'t mut u64,
    pub(super) stain: &'t mut dyn Stain,
}

/// A piece of degree 3 or less on its way to a tile.
#[derive(Clone, Copy, Debug)]
pub(super) struct Piece<'n> {
    points: &'n [Point3],
    /// The degrees along a row and across, and the strides in storage.
    degrees: [usize; 2],
    strides: [usize; 2],
    along: Parameters,
    across: Parameters,
    differences: Differences,
    /// F.
    bits: u32,
    /// Whether values are of a net with fewer bits.
    is_cut: bool,
    /// What values are taken from, plus 1/2, in 2^-16; and the fraction of it in 2^-F.
    origin: [i32; 3],
    fraction: [i32; 3],
    /// The coefficients of rows as cubics in s, by axis.
    rows: [[Cubic; 4]; 3],
    /// The least and the greatest value of z in the net, plus the fraction of the origin.
    depths: [i32; 2],
    /// How often tangents along a row, and across, can be doubled.
    doublings: [u32; 2],
}

/// The bits that corners leave for sums.
const CORNERS_LESS: i32 = 2;

/// What is known of coefficients.
struct Found {
    /// The bits that each of a row takes: magnitudes together.
    sizes: [i32; 4],
    /// How often all can be doubled.
    spare: i32,
    /// The bits of the values of the net, and of the first differences of columns.
    values: i32,
    steps: i32,
}

/// Whether a net of type `S` is walked here: a polynomial, tensor-product one of degree 3 or less.
#[inline(always)]
pub(super) fn suits<S: Surface>(net: &SurfaceNet<'_>) -> bool {
    let always = !S::SHAPE.triangles && !S::SHAPE.rational && S::SHAPE.degree <= 3;
    always || (matches!(net, SurfaceNet::Tensor(_)) && net.degrees().0.max(net.degrees().1) <= 3)
}

impl<'n> Piece<'n> {
    /// A piece that [`suits`], to be [set up](Self::set_up) where it stays.
    #[inline(always)]
    pub(super) fn blank(net: SurfaceNet<'n>, steps: (u32, u32), turn: u8) -> Self {
        let (m, h) = net.degrees();
        let is_turned = turn == 1;
        let (degrees, strides) = if is_turned { ([h, m], [1, h + 1]) } else { ([m, h], [h + 1, 1]) };
        let (along, across) = if is_turned { (steps.1, steps.0) } else { steps };
        let along = Parameters::new(along);
        Self {
            points: net.points(),
            degrees,
            strides,
            along,
            across: Parameters::new(across),
            differences: Differences::NONE,
            bits: 0,
            is_cut: false,
            origin: [0; 3],
            fraction: [0; 3],
            rows: [[[0; 4]; 4]; 3],
            depths: [0; 2],
            doublings: [0; 2],
        }
    }

    /// Finds the coefficients; `steepest` is the largest bound on a derivative, in 2^-9. `WALKED`: lines along rows are
    /// wanted.
    #[inline(never)]
    pub(super) fn set_up<const WALKED: bool>(&mut self, steepest: u32) {
        if WALKED {
            self.differences = Differences::new(&self.along);
        }
        // 768·E·2^(16 − down) is below 2^31. Mostly there is much more room: then no bit is dropped after all.
        let mut down = 16_u32.saturating_sub(steepest.leading_zeros());
        // What is left for sums; differences of long steps are larger than values.
        let less = if !WALKED { CORNERS_LESS } else { 3 + if self.along.steps < 4 { 3 } else { 0 } };
        let Found { mut sizes, mut spare, .. } = self.find(down, less);
        if down > 0 && spare > 0 {
            down = down.saturating_sub(spare as u32);
            Found { sizes, spare, .. } = self.find(down, less);
        }
        self.settle_bits(down, sizes, spare);
    }

    /// What [`set_up`](Self::set_up) does for corners, of a net that is not steep: returns whether this is one.
    ///
    /// Values below 2^26 have first differences below 2^27, and what columns are made of, at most 12 times as much, fits. So
    /// do cubics of columns whose first differences are below 2^26: 32 times as much. With a bit to spare `set_up` would drop
    /// none: with `down` of them dropped values are at most 2^-down of these and 768 more, which takes a bit.
    #[inline(always)]
    pub(super) fn set_up_short(&mut self) -> bool {
        let Found { sizes, spare, values, steps } = self.find(0, CORNERS_LESS);
        let is_short = (values | steps) < 1 << 26 && spare > 0;
        if is_short {
            self.settle_bits(0, sizes, spare);
        }
        is_short
    }

    /// Brings the coefficients to their bits: found with `down` bits less than the net has.
    #[inline(never)]
    fn settle_bits(&mut self, down: u32, sizes: [i32; 4], spare: i32) {
        if let Some(p) = self.points.first() {
            self.origin = p.to_array().map(|c| c.to_bits() + (1 << 15));
        }
        let more = spare.min(if down > 0 { 0 } else { MOST_MORE });
        self.is_cut = down > 0 || more < 0;
        self.bits = (16 - down as i32 + more).max(0) as u32;
        let [b0, b1, b2, b3] = sizes;
        // Values of coefficients are less than twice as large, those of derivatives less than three times.
        let doublings = |all: i32| (zeros(all) - more - 4).clamp(0, 31) as u32;
        self.doublings = [doublings(b1 >> 4 | b2 >> 1 | b3 << 1), doublings(b0 >> 2 | b1 >> 3 | b2 >> 1 | b3)];
        self.take(down, more);
    }

    /// One coordinate of the net, from that of its first point on: four values along a row after the other.
    #[inline(always)]
    fn gather(&self, coordinate: impl Fn(&Point3) -> i32, out: &mut [i32; 16], found: &mut Found) {
        let start = self.points.first().map_or(0, &coordinate);
        let value = |p: &Point3| coordinate(p).wrapping_sub(start);
        match self.points.first_chunk::<16>() {
            Some(points) if self.strides[0] == 1 => {
                out.iter_mut().zip(points).for_each(|(out, p)| *out = value(p));
            }
            Some(points) => {
                for (k, p) in points.iter().enumerate() {
                    out[(k >> 2 | k << 2) & 15] = value(p);
                }
            }
            None => {
                for (b, row) in out.as_chunks_mut::<4>().0.iter_mut().enumerate() {
                    for (a, out) in row.iter_mut().enumerate() {
                        // What there is not has no weight.
                        *out = self.points.get(a * self.strides[0] + b * self.strides[1]).map_or(0, value);
                    }
                }
            }
        }
        found.values |= out.iter().fold(0, |all, value| all | magnitude(*value));
    }

    /// Finds the coefficients of rows along an axis, and what bits they have.
    #[inline(never)]
    fn set_axis(&mut self, values: &[i32; 16], axis: usize, found: &mut Found) {
        let (by_row, by_column) = (&FACTORS[self.degrees[0] & 3], &FACTORS[self.degrees[1] & 3]);
        let mut columns = [[0; 4]; 4];
        for (b, values) in values.as_chunks::<4>().0.iter().enumerate() {
            let [b0, b1, b2, b3] = power(*values, by_row);
            let by = [b0, b1.wrapping_shl(2), b2.wrapping_shl(1), b3.wrapping_shl(1)];
            columns.iter_mut().zip(by).for_each(|(column, value)| column[b & 3] = value);
        }
        // Not by an index: out of line it would be checked.
        let rows = self.rows.get_mut(axis).into_iter().flatten();
        for ((row, column), size) in rows.zip(&columns).zip(&mut found.sizes) {
            *row = scaled(power(*column, by_column));
            *size |= row.iter().fold(0, |all, c| all | magnitude(*c));
            let [p, q, r, s] = *column;
            found.steps |= magnitude(q.wrapping_sub(p)) | magnitude(r.wrapping_sub(q)) | magnitude(s.wrapping_sub(r));
        }
    }

    /// The least and the greatest of the values that there are.
    fn range(&self, values: &[i32; 16]) -> [i32; 2] {
        let rows = values.as_chunks::<4>().0.iter().take(self.degrees[1] + 1);
        rows.flat_map(|row| row.iter().take(self.degrees[0] + 1))
            .fold([0; 2], |[least, most], value| [least.min(*value), most.max(*value)])
    }

    /// Finds the coefficients from `down` bits less than the net has; and how often they can be doubled so that `less` bits
    /// are left, and two more of the last one.
    #[inline(never)]
    fn find(&mut self, down: u32, less: i32) -> Found {
        let mut found = Found { sizes: [0; 4], spare: 0, values: 0, steps: 0 };
        let mut values = [0; 16];
        self.gather(|p| p.x.to_bits() >> down, &mut values, &mut found);
        self.set_axis(&values, 0, &mut found);
        self.gather(|p| p.y.to_bits() >> down, &mut values, &mut found);
        self.set_axis(&values, 1, &mut found);
        self.gather(|p| p.z.to_bits() >> down, &mut values, &mut found);
        self.set_axis(&values, 2, &mut found);
        self.depths = self.range(&values);
        let [b0, b1, b2, b3] = found.sizes;
        found.spare = zeros(b0 | b1 | b2).min(zeros(b3) - 2) - less;
        found
    }

    /// Brings values to their fraction bits: `more` than they have.
    #[inline(always)]
    fn take(&mut self, down: u32, more: i32) {
        let (up, less) = (more.max(0) as u32 & 31, more.min(0).unsigned_abs() & 31);
        for c in self.rows.as_flattened_mut().as_flattened_mut() {
            *c = *c << up >> less;
        }
        for (fraction, origin) in self.fraction.iter_mut().zip(&self.origin) {
            *fraction = (*origin & 0xffff) >> down << up >> less;
        }
        self.depths = self.depths.map(|depth| (depth << up >> less) + self.fraction[2]);
    }

    /// A coordinate along the row at `s`. Out of line: coefficients are not copied to the stack.
    #[inline(never)]
    fn row(&self, axis: usize, s: i32) -> RowCubic {
        // Not by an index: out of line it would be checked.
        let at = At::new(s);
        self.rows.get(axis).map_or([0; 4], |cubics| cubics.each_ref().map(|cubic| at.cubic(cubic)))
    }

    /// The walks along a row from parameter `t` on, of what pixels are made from: x and y plus [`DOUBT`], and z.
    #[inline(never)]
    fn lines(&self, row: &[RowCubic; 3], t: i32, out: &mut [Line; 3]) {
        let more = [DOUBT, DOUBT, 0];
        for (((out, row), fraction), more) in out.iter_mut().zip(row).zip(&self.fraction).zip(more) {
            *out = self.differences.line(row, t, fraction.wrapping_add_unsigned(more));
        }
    }

    /// Draws the lattice of corners, or that of cell centres.
    pub(super) fn draw(&self, centred: bool, target: &mut Target<'_>) {
        let half = u32::from(centred);
        let last = self.along.steps - half;
        let area = target.area;
        let starts = [self.base(0).wrapping_sub(area.x), self.base(1).wrapping_sub(area.y)];
        let units = Units {
            pixels: Pixels::new(self.bits),
            depths: Depths::new(target.shading.window, self.bits, self.base(2), self.depths),
            raster: Raster { starts, width: area.width, height: area.height },
        };
        let sides = [Range::of(starts[0], area.width, self, 0), Range::of(starts[1], area.height, self, 1)];
        let start = self.along.half(half);
        let (mut points, mut rows) = (Points::new(), 0_u32);
        let mut row = Row {
            piece: self,
            cubics: [[0; 4]; 3],
            j: 0,
            half,
            s: 0,
            clip: [false; 2],
            tangents: RowTangents::default(),
            is_known: false,
        };
        for j in 0..=self.across.steps - half {
            let s = self.across.half(2 * j + half);
            let y = self.row(1, s);
            let bounds = bounds(&y);
            if sides[1].is_beside(bounds) {
                continue;
            }
            row.clip[1] = !sides[1].holds(bounds);
            rows += 1;
            let x = self.row(0, s);
            if target.is_wide {
                let bounds = self::bounds(&x);
                if sides[0].is_beside(bounds) {
                    continue;
                }
                row.clip[0] = !sides[0].holds(bounds);
            }
            row.cubics = [x, y, self.row(2, s)];
            (row.j, row.s, row.is_known) = (j, s, false);
            let (mut first, mut t) = (0, start);
            loop {
                let count = (last + 1 - first).min(RUN as u32);
                row.run((first, t), count as usize, &units, &mut points, target);
                first += count;
                if first > last {
                    break;
                }
                t = self.along.half(2 * first + half);
            }
        }
        *target.points += u64::from(rows) * (u64::from(last) + 1);
    }

    /// The whole pixels of the origin.
    fn base(&self, axis: usize) -> i32 {
        self.origin[axis] >> 16
    }
}

/// The columns or the rows of a tile, in the unit of a piece.
struct Range {
    low: i32,
    high: i32,
}

/// What values and points may be off.
const MARGIN: i32 = DOUBT as i32;

impl Range {
    /// From `-start` pixels after the origin, `length` pixels.
    fn of(start: i32, length: u32, piece: &Piece<'_>, axis: usize) -> Self {
        let from = |pixel: i64| {
            let units = (pixel << piece.bits) - i64::from(piece.fraction[axis]);
            units.clamp(i32::MIN.into(), i32::MAX.into()) as i32
        };
        let start = -i64::from(start);
        Self { low: from(start), high: from(start + i64::from(length)) }
    }

    /// Whether all between two values are outside.
    #[inline(always)]
    fn is_beside(&self, [least, most]: [i32; 2]) -> bool {
        most < self.low || least >= self.high
    }

    /// Whether all between two values are inside.
    #[inline(always)]
    fn holds(&self, [least, most]: [i32; 2]) -> bool {
        least >= self.low && most < self.high
    }
}

/// What the points of a row are between: its control values b0, b0 + b1/3, b0 + (2·b1 + b2)/3 and b0 + b1 + b2 + b3.
#[inline(always)]
fn bounds([start, slope, bend, last]: &RowCubic) -> [i32; 2] {
    const TWELFTH: i32 = (1 << 30) / 3;
    let (a, d) = (*start, start.wrapping_add(slope >> 2).wrapping_add(bend >> 1).wrapping_add(last >> 1));
    let (b, c) = (a + high(*slope, TWELFTH), a + high(slope.wrapping_add(*bend), 2 * TWELFTH));
    [a.min(b).min(c.min(d)).saturating_sub(MARGIN), a.max(b).max(c.max(d)).saturating_add(MARGIN)]
}
