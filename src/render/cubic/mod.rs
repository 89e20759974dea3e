//! The points of a piece of degree 3 or less: fixed point for speed, exact arithmetic where that is in doubt.
//!
//! In comes a polynomial tensor-product net and its step counts; out go the pixels ⌊S + 1/2⌋ of its exact lattice points,
//! row by row, and where they are seen their normals.
//!
//! # How
//! All values are taken from the first control point on, in 2^-F pixel. Along each column of the net S is a cubic in s:
//! its coefficients are found once. A row is a cubic in r through what the columns are at s; it is walked by differences
//! with 4 bits more, an axis at a time, so that the state of one cubic stays in registers: three additions and a shift a
//! point. Where the fraction of x or y is too close to a pixel's border, [`exact`] decides.
//!
//! # Why it is right
//! Let E be the largest difference of neighbours in the net, m ≥ 3E the largest bound on a derivative along any axis. F is
//! taken such that 48·E < 2^31: every coefficient below, times the power of two that [`at`] wants, fits. Each [`high`]
//! rounds down by less than one unit, so a value by `at` is within 3 units, and a parameter in 2^-31, within two of them,
//! adds less than one. Control values of a row are within 5 units (one of them where F < 16 drops bits of the net), and so
//! is every point of the cubic through them.
//!
//! A run of at most [`RUN`] points starts at such a value. Differences, in 2^-(F+4), are rounded by at most 3, 2.2 and 1.2
//! units, their factors 1/n² and 1/n³ by less than 2^-27 and 2^-25 of themselves: after k ≤ 31 steps the sum is off by at
//! most 3k + 2.2·k(k−1)/2 + 1.2·k(k−1)(k−2)/6 of those units, and 11 units of 2^-F for the factors; dropping 4 bits at each
//! step costs up to 31 more. In all that is below 500; [`DOUBT`] is twice as much.
//!
//! Depths are those of the fixed-point z: within one unit of the exact ones.

mod corners;
mod exact;
mod run;
mod slopes;
mod tangents;

#[cfg(all(test, feature = "std"))]
mod tests;

use super::brush::Shading;
use super::light::Side;
use super::pen::{Ink, Stain};
use super::style::Style;
use super::tile::Area;
use crate::geometry::Point3;
use crate::num::{cubic_at, high};
use crate::patch::{Surface, SurfaceNet};
pub(super) use corners::Corners;
use run::{DOUBT, Depths, Line, Pixels, Points, RUN, indexed, short};
pub(super) use slopes::RowSlopes;
use tangents::RowTangents;

/// The most fraction bits of values.
const MOST_BITS: u32 = 28;

/// Bits that differences have more than values.
const MORE: u32 = 4;

/// A cubic c0 + c1·t + c2·t² + c3·t³ as c0, 2·c1, 4·c2, 8·c3.
type Cubic = [i32; 4];

/// A cubic at a parameter in 2^-31, rounded down by less than 3.
#[inline(always)]
fn at(c: &Cubic, t: i32) -> i32 {
    cubic_at(c, t)
}

/// Parameters i/n or (i + 1/2)/n in 2^-31.
#[derive(Clone, Copy, Debug)]
struct Parameters {
    steps: u32,
    /// ⌊(2^31 − 1)·2^shift/2n⌋.
    factor: u32,
    shift: u32,
}

impl Parameters {
    fn new(steps: u32) -> Self {
        let doubled = 2 * steps;
        let shift = doubled.checked_ilog2().unwrap_or(0).min(15);
        const ONE: u32 = i32::MAX.unsigned_abs();
        let whole = ONE.checked_div(doubled).unwrap_or(0);
        let rest = ONE.wrapping_sub(whole.wrapping_mul(doubled));
        let factor = (whole << shift).wrapping_add((rest << shift).checked_div(doubled).unwrap_or(0));
        Self { steps, factor, shift }
    }

    /// The parameter of half step `i` in one product: within 2·i of those units.
    #[inline(always)]
    fn near(&self, i: u32) -> i32 {
        i.wrapping_mul(self.factor >> (self.shift & 15)) as i32
    }

    /// The parameter of half step `i`, within two units.
    #[inline(always)]
    fn half(&self, i: u32) -> i32 {
        ((u64::from(i) * u64::from(self.factor)) >> (self.shift & 15)) as i32
    }
}

/// 1/n, 1/n² and 1/n³ in 2^-31, shifted left by `shift`, 2·`shift` and 3·`shift`: at least 1/2, 1/4 and 1/8.
#[derive(Clone, Copy, Debug)]
struct Powers {
    powers: [i32; 3],
    /// What products with them are multiplied by, then how far they are shifted right, to be differences.
    left: [i32; 3],
    right: [u32; 3],
}

impl Powers {
    fn new(along: &Parameters) -> Self {
        let shift = along.steps.checked_ilog2().unwrap_or(0);
        let first = (along.factor << (shift + 1 - along.shift.min(shift + 1))) as i32;
        let second = high(first, first) << 1;
        let third = high(second, first) << 1;
        let by = [1, 2, 3].map(|k| (k * shift) as i32 - if k == 1 { 1 } else { 5 });
        Self {
            powers: [first, second, third],
            left: by.map(|by| 1 << by.min(0).unsigned_abs()),
            right: by.map(|by| by.clamp(0, 31).unsigned_abs()),
        }
    }

    #[inline(always)]
    fn times(&self, k: usize, value: i32) -> i32 {
        high(value, self.powers[k]).wrapping_mul(self.left[k]) >> self.right[k]
    }
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
    powers: Powers,
    /// F.
    bits: u32,
    /// What values are taken from, plus 1/2, in 2^-16; and the fraction of it in 2^-F.
    origin: [i32; 3],
    fraction: [i32; 3],
    /// The columns of the net as cubics in s, by axis.
    columns: [[Cubic; 4]; 3],
    /// The least and the greatest value of z in the net, plus the fraction of the origin.
    depths: [i32; 2],
}

/// Whether a net of type `S` is walked here: a polynomial, tensor-product one of degree 3 or less.
#[inline(always)]
pub(super) fn suits<S: Surface>(net: &SurfaceNet<'_>) -> bool {
    let always = !S::SHAPE.triangles && !S::SHAPE.rational && S::SHAPE.degree <= 3;
    always || (matches!(net, SurfaceNet::Tensor(_)) && net.degrees().0.max(net.degrees().1) <= 3)
}

impl<'n> Piece<'n> {
    /// A piece that [`suits`]; `steepest` is the largest bound on a derivative, in 2^-9.
    #[inline(never)]
    pub(super) fn new(net: SurfaceNet<'n>, steps: (u32, u32), turn: u8, steepest: u32) -> Self {
        let (m, h) = net.degrees();
        let (r, s) = (Parameters::new(steps.0), Parameters::new(steps.1));
        let is_turned = turn == 1;
        let (degrees, strides) = if is_turned { ([h, m], [1, h + 1]) } else { ([m, h], [h + 1, 1]) };
        let (along, across) = if is_turned { (s, r) } else { (r, s) };
        // 16·m·2^(F−9) is 48·E or more, and below 2^31.
        let bits = (4 + steepest.leading_zeros()).min(MOST_BITS);
        let points = net.points();
        let mut piece = Self {
            points,
            degrees,
            strides,
            along,
            across,
            powers: Powers::new(&along),
            bits,
            origin: [0; 3],
            fraction: [0; 3],
            columns: [[[0; 4]; 4]; 3],
            depths: [0; 2],
        };
        match points.first_chunk::<16>() {
            Some(points) => piece.set_up(points),
            None => {
                let mut room = [Point3::ORIGIN; 16];
                room.iter_mut().zip(points).for_each(|(to, from)| *to = *from);
                piece.set_up(&room);
                // Columns that there are not: where the last one is, so that a row's control values bound it.
                for columns in &mut piece.columns {
                    let last = columns[degrees[0] & 3];
                    columns.iter_mut().skip(degrees[0] + 1).for_each(|column| *column = last);
                }
            }
        }
        piece
    }

    #[inline(always)]
    fn set_up(&mut self, points: &[Point3; 16]) {
        let (up, down) = (self.bits.saturating_sub(16), 16_u32.saturating_sub(self.bits));
        let factors = &FACTORS[self.degrees[1] & 3];
        for axis in 0..3 {
            let bits = |k: usize| {
                let p = &points[k & 15];
                match axis {
                    0 => p.x.to_bits(),
                    1 => p.y.to_bits(),
                    _ => p.z.to_bits(),
                }
            };
            let start = bits(0) >> down;
            self.origin[axis] = bits(0) + (1 << 15);
            self.fraction[axis] = (self.origin[axis] & 0xffff) >> down << up;
            for (a, column) in self.columns[axis].iter_mut().enumerate().take(self.degrees[0] + 1) {
                let value = |b: usize| {
                    let bits = bits(a * self.strides[0] + b * self.strides[1]) >> down;
                    bits.wrapping_sub(start) << up
                };
                let values = [value(0), value(1), value(2), value(3)];
                *column = scaled(power(values, factors));
                if axis == 2 {
                    let [least, most] = &mut self.depths;
                    for value in values.iter().take(self.degrees[1] + 1) {
                        (*least, *most) = ((*least).min(*value), (*most).max(*value));
                    }
                }
            }
        }
        self.depths = self.depths.map(|depth| depth + self.fraction[2]);
    }

    /// The control values of a row.
    #[inline(always)]
    fn control(&self, axis: usize, s: i32) -> [i32; 4] {
        let [a, b, c, d] = &self.columns[axis];
        [at(a, s), at(b, s), at(c, s), at(d, s)]
    }

    /// The cubic of a row, its coefficients as they are.
    #[inline(always)]
    fn row(&self, control: [i32; 4]) -> [i32; 4] {
        power(control, &FACTORS[self.degrees[0] & 3])
    }

    /// The walk along a row from parameter `t` on.
    #[inline(always)]
    fn line(&self, b: &[i32; 4], t: i32, fraction: i32) -> Line {
        let [b0, b1, b2, b3] = *b;
        let (value, slope, bend) = if t == 0 {
            (b0, b1, b2)
        } else {
            let slope = at(&[b1, b2.wrapping_shl(2), b3.wrapping_mul(12), 0], t);
            (at(&scaled(*b), t), slope, b2.wrapping_add(high(b3.wrapping_mul(6), t)))
        };
        let third = self.powers.times(2, b3.wrapping_mul(6));
        let second = self.powers.times(1, bend.wrapping_shl(1));
        let first = self.powers.times(0, slope.wrapping_shl(MORE));
        Line {
            value: value.wrapping_add(fraction),
            // Modulo 2^32, where the sum fits though its parts may not.
            first: first.wrapping_add(self.powers.times(1, bend)).wrapping_add(self.powers.times(2, b3)),
            second: second.wrapping_add(third),
            third,
        }
    }

    /// Draws the lattice of corners, or that of cell centres.
    pub(super) fn draw(&self, centred: bool, target: &mut Target<'_>) {
        let half = u32::from(centred);
        let last = self.along.steps - half;
        let (pixels, window) = (Pixels::new(self.bits), target.shading.window);
        let depths = Depths::new(window, self.bits, self.base(2), self.depths);
        let columns = [self.base(0).wrapping_sub(target.area.x), target.area.width as i32];
        let rows = [self.base(1).wrapping_sub(target.area.y), target.area.height as i32];
        let sides = [Range::of(columns, self, 0), Range::of(rows, self, 1)];
        let mut points = Points::new();
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
            let y = self.control(1, s);
            let by_row = sides[1].place(&y);
            if by_row == Place::Outside {
                continue;
            }
            *target.points += u64::from(last) + 1;
            let x = self.control(0, s);
            let by_column = if target.is_wide { sides[0].place(&x) } else { Place::Inside };
            if by_column == Place::Outside {
                continue;
            }
            row.cubics = [self.row(x), self.row(y), self.row(self.control(2, s))];
            (row.j, row.s, row.is_known) = (j, s, false);
            row.clip = [by_column == Place::Across, by_row == Place::Across];
            let mut first = 0;
            while first <= last {
                let count = (last + 1 - first).min(RUN as u32);
                row.run(first, count as usize, (&pixels, &depths), [columns[0], rows[0]], &mut points, target);
                first += count;
            }
        }
    }

    /// The whole pixels of the origin.
    fn base(&self, axis: usize) -> i32 {
        self.origin[axis] >> 16
    }
}

/// Where the values of a row are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Place {
    Inside,
    Outside,
    Across,
}

/// The columns or the rows of a tile, in the unit of a piece.
struct Range {
    low: i32,
    high: i32,
}

/// What control values and points may be off.
const MARGIN: i32 = DOUBT as i32;

impl Range {
    /// From `-start` pixels after the origin, `length` pixels.
    fn of([start, length]: [i32; 2], piece: &Piece<'_>, axis: usize) -> Self {
        let from = |pixel: i64| {
            let units = (pixel << piece.bits) - i64::from(piece.fraction[axis]);
            units.clamp(i32::MIN.into(), i32::MAX.into()) as i32
        };
        let start = -i64::from(start);
        Self { low: from(start), high: from(start + i64::from(length)) }
    }

    #[inline(always)]
    fn place(&self, [a, b, c, d]: &[i32; 4]) -> Place {
        let (least, most) = (*a.min(b).min(c).min(d), *a.max(b).max(c).max(d));
        if least >= self.low.saturating_add(MARGIN) && most < self.high.saturating_sub(MARGIN) {
            Place::Inside
        } else if most < self.low.saturating_sub(MARGIN) || least >= self.high.saturating_add(MARGIN) {
            Place::Outside
        } else {
            Place::Across
        }
    }
}

/// A row on its way to the pixels.
struct Row<'p, 'n> {
    piece: &'p Piece<'n>,
    cubics: [[i32; 4]; 3],
    j: u32,
    /// 1 for the lattice of centres.
    half: u32,
    s: i32,
    /// Whether some points may be in columns, and in rows, outside the tile.
    clip: [bool; 2],
    tangents: RowTangents,
    /// Whether the tangents were found.
    is_known: bool,
}

impl Row<'_, '_> {
    /// Draws `count` points from number `first` on.
    #[inline(never)]
    fn run(
        &mut self,
        first: u32,
        count: usize,
        (pixels, depths): (&Pixels, &Depths),
        starts: [i32; 2],
        points: &mut Points,
        target: &mut Target<'_>,
    ) {
        let (piece, area) = (self.piece, target.area);
        let t = piece.along.half(2 * first + self.half);
        let line = |axis: usize, more: u32| {
            piece.line(&self.cubics[axis], t, piece.fraction[axis].wrapping_add_unsigned(more))
        };
        let x = line(0, DOUBT);
        let columns = points.columns.get_mut(..count).unwrap_or_default();
        let is_sure = if self.clip[0] {
            pixels.columns::<true>(x, columns, starts[0])
        } else {
            pixels.columns::<false>(x, columns, starts[0])
        };
        if !is_sure {
            pixels.each_doubtful(x, count, &mut |k, near| {
                points.columns[k & (RUN - 1)] = short::<true>(self.settle(0, first + k as u32, near, starts[0]));
            });
        }
        let y = line(1, DOUBT);
        let sides = [area.width, area.height];
        let is_sure = if self.clip[1] {
            pixels.rows::<true>(y, points, count, starts[1], sides)
        } else {
            pixels.rows::<false>(y, points, count, starts[1], sides)
        };
        if !is_sure {
            pixels.each_doubtful(y, count, &mut |k, near| {
                let k = k & (RUN - 1);
                let row = self.settle(1, first + k as u32, near, starts[1]);
                points.rows[k] = row as u16;
                points.index[k] = indexed::<true>(row, points.columns[k], sides);
            });
        }
        if self.clip[0] {
            points.clip(count, area.width);
        }
        let z = line(2, 0);
        let Points { index, seen, .. } = &mut *points;
        let index = index.get(..count).unwrap_or_default();
        if target.ink != Ink::Fill {
            return depths.hide(z, index, target.depth);
        }
        let count = depths.test(z, index, target.depth, seen);
        let points = &*points;
        let seen = points.seen.get(..count).unwrap_or_default();
        if count > 0 && target.shading.style.needs_normals() && !self.is_known {
            piece.tangents(&self.cubics, self.s, &mut self.tangents);
            self.is_known = true;
        }
        if target.shading.style == Style::Shaded {
            // Most scenes: without asking for the style at each point.
            self.colour(seen, first, points, target, |row, i, target, _| {
                target.shading.light.level(row.normal(i, target.side))
            });
        } else {
            self.colour(seen, first, points, target, |row, i, target, index| {
                let depth = target.depth.get(index).map_or(0, |stored| stored >> 1);
                target.shading.level(depth, || row.normal(i, target.side))
            });
        }
    }

    /// Gives the points that were seen their colours.
    #[inline(always)]
    fn colour(
        &self,
        seen: &[u8],
        first: u32,
        points: &Points,
        target: &mut Target<'_>,
        level: impl Fn(&Self, u32, &Target<'_>, usize) -> u8,
    ) {
        for k in seen {
            let (i, k) = (first + u32::from(*k), usize::from(*k) & (RUN - 1));
            let index = points.index[k] as usize;
            let at = [target.area.x + i32::from(points.columns[k]), target.area.y + i32::from(points.rows[k])];
            let level = level(self, i, target, index);
            target.stain.stain(index, at, level);
        }
    }

    /// The exact pixel of a point in doubt, from the tile's first one.
    #[cold]
    #[inline(never)]
    fn settle(&self, axis: usize, i: u32, near: i32, start: i32) -> i32 {
        let base = self.piece.base(axis);
        let pixel = self.piece.exact_pixel(axis, [i, self.j], self.half == 1, near.wrapping_add(base));
        pixel.wrapping_sub(base).wrapping_add(start)
    }
}
