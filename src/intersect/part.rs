//! Parts of a patch with rigorous bounds: hulls and cones of normals.
//!
//! A part's hull has coordinates in units of 2^-26, each within two units of the exact control point; every test below has
//! that in hand. Cones: the derivatives of a part lie in the cone of the differences of its control points; with angles α
//! and β about unit axes a and b, γ apart, |x × y − a × b| ≤ 2 sin(α/2) + 2 sin(β/2), so normals turn from a × b by an
//! angle whose sine is at most that over sin γ (after Sederberg and Meyers 1988). A rational part has the derivatives
//! (A' − S w')/w; moved to its centre, |S| is at most its radius, which widens the cone.

use super::line::Line;
use super::sheet::{Homogeneous, ONE, PARAMETER_BITS, Place, ROOM, Sheet, between, combine};
use super::vector::V3;
use crate::num::Real;
use crate::patch::{MAX_DEGREE, triangle_index, triangle_len};

/// Fraction bits of a hull.
const HULL_BITS: i32 = 26;
/// What a hull's coordinates may be wrong by, in its units, twice and rounded up.
const SLACK: i64 = 6;

/// A node of the quadtree over a patch's domain; the upper triangles are parts of triangular patches only.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Region {
    pub(super) level: u8,
    pub(super) i: u16,
    pub(super) j: u16,
    pub(super) upper: bool,
}

impl Region {
    pub(super) const ROOT: Self = Self { level: 0, i: 0, j: 0, upper: false };

    /// The four quarters.
    pub(super) fn quarters(self, triangle: bool) -> [Self; 4] {
        let Self { level, i, j, upper } = self;
        let part = |di: u16, dj: u16, upper| Self { level: level + 1, i: 2 * i + di, j: 2 * j + dj, upper };
        match (triangle, upper) {
            (false, _) => [part(0, 0, false), part(0, 1, false), part(1, 0, false), part(1, 1, false)],
            (true, false) => [part(0, 0, false), part(0, 1, false), part(1, 0, false), part(0, 0, true)],
            (true, true) => [part(1, 1, true), part(0, 1, true), part(1, 0, true), part(1, 1, false)],
        }
    }

    fn place(self, di: u16, dj: u16) -> Place {
        let shift = PARAMETER_BITS - i32::from(self.level);
        [i64::from(self.i + di) << shift, i64::from(self.j + dj) << shift]
    }

    /// The corners of a triangular part, in the order of u, v, w.
    fn corners(self) -> [Place; 3] {
        if self.upper {
            [self.place(0, 1), self.place(1, 0), self.place(1, 1)]
        } else {
            [self.place(1, 0), self.place(0, 1), self.place(0, 0)]
        }
    }

    /// The halves of a part of a line: `j` is 0.
    pub(super) fn halves(self) -> [Self; 2] {
        [0, 1].map(|d| Self { level: self.level + 1, i: 2 * self.i + d, ..self })
    }

    /// The borders of a part that it shares with parts before it, each with its ends; a triangle's third one too. Between
    /// neighbours every border is one of these of one of them, and of the other none.
    pub(super) fn borders(self, triangle: bool) -> [Option<[Place; 2]>; 3] {
        if self.upper {
            return [None; 3];
        }
        let [low, u, v] = [self.place(0, 0), self.place(1, 0), self.place(0, 1)];
        let inner = |outside: bool, ends: [Place; 2]| (!outside).then_some(ends);
        [inner(self.i == 0, [low, v]), inner(self.j == 0, [low, u]), inner(!triangle || u[0] + u[1] >= ONE, [u, v])]
    }

    /// In 32 bits.
    pub(super) fn pack(self) -> u32 {
        u32::from(self.level) << 28
            | u32::from(self.i & 0x1fff) << 15
            | u32::from(self.j & 0x1fff) << 2
            | u32::from(self.upper)
    }

    pub(super) fn unpack(bits: u32) -> Self {
        let part = |shift: u32| (bits >> shift) as u16 & 0x1fff;
        Self { level: (bits >> 28) as u8, i: part(15), j: part(2), upper: bits & 1 == 1 }
    }

    /// The ends of a part of a line.
    pub(super) fn range(self) -> [i64; 2] {
        [self.place(0, 0)[0], self.place(1, 0)[0]]
    }

    /// A place well inside.
    pub(super) fn centre(self, triangle: bool) -> Place {
        let size = ONE >> self.level;
        let [u, v] = self.place(0, 0);
        match (triangle, self.upper) {
            (false, _) => [u + size / 2, v + size / 2],
            (true, false) => [u + size / 3, v + size / 3],
            (true, true) => [u + size - size / 3, v + size - size / 3],
        }
    }

    /// Whether a place lies in the part, up to `slack`.
    pub(super) fn contains(self, place: Place, triangle: bool, slack: i64) -> bool {
        let size = ONE >> self.level;
        let [u, v] = both!(|k| place[k] - self.place(0, 0)[k]);
        let (least, most) = (u.min(v) >= -slack, u.max(v) <= size + slack);
        match (triangle, self.upper) {
            (false, _) => least && most,
            (true, false) => least && u + v <= size + slack,
            (true, true) => most && u + v >= size - slack,
        }
    }

    /// Whether a place lies in the part's square, grown by a share of 2^-`grow` of its side.
    pub(super) fn holds(self, place: Place, grow: u32) -> bool {
        let size = ONE >> self.level;
        let low = self.place(0, 0);
        (0..2).all(|k| place[k] >= low[k] - (size >> grow) && place[k] <= low[k] + size + (size >> grow))
    }
}

/// A part of a patch.
#[derive(Debug)]
pub(super) struct Part<'r> {
    pub(super) region: Option<Region>,
    triangle: bool,
    degrees: (usize, usize),
    count: usize,
    /// Points, with weights relative to the largest, 24 fraction bits; all alike for polynomial parts.
    hull: &'r mut [Homogeneous],
    low: [i64; 3],
    high: [i64; 3],
    pub(super) cone: Cone,
    is_aimed: bool,
}

/// How two parts can meet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Meeting {
    /// Not at all.
    Apart,
    /// In curves that go through, none of them closed; they touch nowhere.
    Through,
    /// In any way.
    Any,
}

/// Directions of normals about an axis, up to sign.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cone {
    pub(super) axis: V3,
    /// The sine of the half angle; above 1 where nothing is known.
    pub(super) sine: Real,
    /// Unit axes of the derivatives by u and v.
    pub(super) along: [V3; 2],
    /// How much directions may turn a share of the part beyond it.
    pub(super) turn: Real,
}

/// Directions about a unit axis.
#[derive(Clone, Copy, Debug)]
pub(super) struct Directions {
    pub(super) axis: V3,
    /// 2 sin of half the largest angle from it.
    pub(super) spread: Real,
    /// How much directions may turn a share of the part beyond it.
    pub(super) turn: Real,
}

impl Cone {
    const UNKNOWN: Self = Self { axis: V3::ZERO, sine: Real::int(2), along: [V3::ZERO; 2], turn: Real::ZERO };

    /// Whether the half angle is below 45 degrees.
    pub(super) fn is_narrow(&self) -> bool {
        self.sine.square() < Real::power(-1)
    }

    /// Whether no normal of one is parallel to one of the other; both are narrow.
    pub(super) fn is_apart(&self, other: &Self) -> bool {
        let cosine = |sine: Real| (Real::ONE - sine.square()).sqrt();
        let limit = cosine(self.sine) * cosine(other.sine) - self.sine * other.sine;
        self.axis.dot(other.axis).abs() + Real::power(-16) < limit
    }
}

#[cfg_attr(target_pointer_width = "32", inline(never))]
fn lerp(a: &Homogeneous, b: &Homogeneous, t: i64) -> Homogeneous {
    let mut out = [0; 4];
    for k in 0..4 {
        out[k] = between(a[k], b[k], t);
    }
    out
}

/// A de Casteljau step of entry i.
fn advance(values: &mut Row, i: usize, t: i64) {
    let i = i.min(MAX_DEGREE - 1);
    values[i] = lerp(&values[i], &values[i + 1], t);
}

/// A row of control points.
pub(super) type Row = [Homogeneous; MAX_DEGREE + 1];

/// The points of a net that begin at `start`, `step` apart.
pub(super) fn row(net: &[Homogeneous], (start, step): (usize, usize)) -> Row {
    let mut row = [[0; 4]; MAX_DEGREE + 1];
    for (value, point) in row.iter_mut().zip(net.iter().skip(start).step_by(step)) {
        *value = *point;
    }
    row
}

/// Turns a curve into its part low ..= high; both are multiples of 2^-14.
///
/// First the part up to `high`, then what is after low/high of that: n (n + 1) steps of de Casteljau's algorithm. The quotient
/// is rounded to 2^-48, which moves points by less than 2^-30 unit.
#[inline(never)]
pub(super) fn piece(row: &mut Row, n: usize, [low, high]: [i64; 2]) {
    let n = n.min(MAX_DEGREE);
    if high < ONE {
        for k in 1..=n {
            for i in (k..=n).rev() {
                let (before, i) = (i.saturating_sub(1).min(MAX_DEGREE), i.min(MAX_DEGREE));
                row[i] = lerp(&row[before], &row[i], high);
            }
        }
    }
    if low > 0 {
        let share = ((low >> 34) << PARAMETER_BITS).checked_div(high >> 34).unwrap_or(0);
        for left in (1..=n).rev() {
            for i in 0..left {
                advance(row, i, share);
            }
        }
    }
}

/// The blossom of a triangular net: `counts` steps at each of the corners.
pub(super) fn triangle_blossom(net: &[Homogeneous], n: usize, corners: &[Place; 3], counts: [usize; 3]) -> Homogeneous {
    let mut values = [[0; 4]; triangle_len(MAX_DEGREE)];
    for (out, value) in values.iter_mut().zip(net).take(triangle_len(n)) {
        *out = *value;
    }
    let mut degree = n;
    for (corner, count) in corners.iter().zip(counts) {
        for _ in 0..count {
            degree = degree.saturating_sub(1);
            for row in 0..=degree {
                for k in 0..=row {
                    let at = triangle_index(row - k, k);
                    let parents = [at, at + row + 1, at + row + 2].map(|p| values.get(p).copied().unwrap_or([0; 4]));
                    let [u, v, w] = &parents;
                    let sum = combine::<4>([u, v, w], *corner);
                    if let Some(value) = values.get_mut(at) {
                        *value = sum;
                    }
                }
            }
        }
    }
    values[0]
}

impl<'r> Part<'r> {
    /// No part; its hull in a room of as many points as the patch has, or more.
    pub(super) fn new(room: &'r mut [Homogeneous]) -> Self {
        Self {
            region: None,
            triangle: false,
            degrees: (1, 1),
            count: 0,
            hull: room,
            low: [0; 3],
            high: [0; 3],
            cone: Cone::UNKNOWN,
            is_aimed: false,
        }
    }

    /// Becomes the part of a patch over a region.
    #[inline(never)]
    pub(super) fn load(&mut self, sheet: &Sheet<'_>, region: Region) {
        let (m, h) = (sheet.degrees.0.min(MAX_DEGREE), sheet.degrees.1.min(MAX_DEGREE));
        let count = if sheet.triangle { triangle_len(m) } else { (m + 1) * (h + 1) };
        if sheet.triangle {
            let corners = region.corners();
            for row in 0..=m {
                for k in 0..=row {
                    if let Some(out) = self.hull.get_mut(triangle_index(row - k, k)) {
                        *out = triangle_blossom(sheet.net, m, &corners, [m - row, row - k, k]);
                    }
                }
            }
        } else {
            let ([u, v], [x, y]) = (region.place(0, 0), region.place(1, 1));
            for i in 0..=m {
                let mut along = row(sheet.net, (i * (h + 1), 1));
                piece(&mut along, h, [v, y]);
                self.write(&along, h, (i * (h + 1), 1));
            }
            for j in 0..=h {
                let mut across = row(self.hull, (j, h + 1));
                piece(&mut across, m, [u, x]);
                self.write(&across, m, (j, h + 1));
            }
        }
        (self.triangle, self.degrees, self.count) = (sheet.triangle, (m, h), count);
        self.finish(sheet, region);
    }

    /// Writes a row of degree `n` into the hull.
    fn write(&mut self, row: &Row, n: usize, (start, step): (usize, usize)) {
        for (out, value) in self.hull.iter_mut().skip(start).step_by(step).zip(row).take(n + 1) {
            *out = *value;
        }
    }

    /// Becomes the part of a line of a patch over an interval.
    #[inline(never)]
    pub(super) fn load_line(&mut self, sheet: &Sheet<'_>, line: &Line, region: Region) {
        let [low, high] = region.range();
        let (row, n) = match line.edge {
            Some(edge) => {
                let n = sheet.edge_degree(edge).min(MAX_DEGREE);
                let mut row = [[0; 4]; MAX_DEGREE + 1];
                for (k, out) in row.iter_mut().enumerate().take(n + 1) {
                    *out = sheet.edge_index(edge, k).and_then(|at| sheet.net.get(at)).copied().unwrap_or([0; 4]);
                }
                piece(&mut row, n, [low, high]);
                (row, n)
            }
            None => sheet.row(line.place(low), line.place(high)),
        };
        self.write(&row, n, (0, 1));
        (self.triangle, self.degrees, self.count) = (false, (n, 0), n + 1);
        self.finish(sheet, region);
    }

    /// The control points in the hull become that; its box.
    fn finish(&mut self, sheet: &Sheet<'_>, region: Region) {
        self.region = Some(region);
        (self.low, self.high) = ([i64::MAX; 3], [i64::MIN; 3]);
        self.is_aimed = false;
        self.project(sheet);
    }

    /// Finds the cone of normals, once.
    pub(super) fn aim(&mut self) {
        if !self.is_aimed {
            self.cone = self.normals();
            self.is_aimed = true;
        }
    }

    /// Control points, in place, to the hull with its weights; the box.
    fn project(&mut self, sheet: &Sheet<'_>) {
        let heaviest = self.points().iter().fold(1, |most, c| most.max(c[3]));
        let Some(points) = self.hull.get_mut(..self.count) else { return };
        for c in points {
            for k in 0..3 {
                c[k] = if sheet.rational {
                    (i128::from(c[k]) << HULL_BITS).checked_div(i128::from(c[3])).unwrap_or(0) as i64
                } else {
                    c[k] >> (sheet.bits - HULL_BITS)
                };
                self.low[k] = self.low[k].min(c[k]);
                self.high[k] = self.high[k].max(c[k]);
            }
            c[3] = if sheet.rational {
                (i128::from(c[3]) << 24).checked_div(i128::from(heaviest)).unwrap_or(0) as i64
            } else {
                1 << 24
            };
        }
    }

    /// The direction of the third side of a triangular part; zero for others.
    pub(super) fn diagonal(&self) -> V3 {
        let corner = |at: usize| self.hull.get(at).copied().unwrap_or([0; 4]);
        let corners = [corner(0), corner(triangle_index(self.degrees.0.min(MAX_DEGREE), 0))];
        let [from, to] = if self.triangle { corners } else { [[0; 4]; 2] };
        V3::bits(three!(|k| to[k] - from[k]), 0).unit()
    }

    fn points(&self) -> &[Homogeneous] {
        self.hull.get(..self.count).unwrap_or(&[])
    }

    /// The longest side of the box.
    pub(super) fn size(&self) -> i64 {
        (0..3).fold(0, |size, k| size.max(self.high[k] - self.low[k]))
    }

    /// The same in units.
    pub(super) fn extent(&self) -> Real {
        Real::new(self.size().max(1), -HULL_BITS)
    }

    pub(super) fn boxes_meet(&self, other: &Self) -> bool {
        (0..3).all(|k| self.low[k] <= other.high[k] + SLACK && other.low[k] <= self.high[k] + SLACK)
    }

    /// What the hulls and the cones of normals say of two parts.
    pub(super) fn meeting(&mut self, other: &mut Self) -> Meeting {
        if !self.boxes_meet(other) {
            return Meeting::Apart;
        }
        self.aim();
        other.aim();
        let (one, two) = (self.cone, other.cone);
        if [one.axis, two.axis].into_iter().any(|axis| !axis.is_zero() && self.is_apart_along(other, axis)) {
            return Meeting::Apart;
        }
        if one.is_narrow() && two.is_narrow() && one.is_apart(&two) { Meeting::Through } else { Meeting::Any }
    }

    /// Whether a plane across a direction lies between the hulls.
    pub(super) fn is_apart_along(&self, other: &Self, direction: V3) -> bool {
        let axis = direction.fixed(18);
        let slack = SLACK * axis.iter().map(|c| c.abs()).sum::<i64>();
        let span = |part: &Self| {
            part.points().iter().fold((i64::MAX, i64::MIN), |(low, high), p| {
                let d = p[0] * axis[0] + p[1] * axis[1] + p[2] * axis[2];
                (low.min(d), high.max(d))
            })
        };
        let ((a, b), (c, d)) = (span(self), span(other));
        b + slack < c || d + slack < a
    }

    /// The cone of normals.
    fn normals(&self) -> Cone {
        if self.count <= 16 { self.normals_in::<16>() } else { self.normals_in::<ROOM>() }
    }

    #[inline(never)]
    fn normals_in<const POINTS: usize>(&self) -> Cone {
        let mut points = [[0; 3]; POINTS];
        let radius = self.centre(&mut points);
        let Some(along_u) = self.directions(&points, radius, 0) else { return Cone::UNKNOWN };
        let Some(along_v) = self.directions(&points, radius, 1) else { return Cone::UNKNOWN };
        let across = along_u.axis.cross(along_v.axis);
        let sine = across.norm();
        if sine.is_zero() {
            return Cone::UNKNOWN;
        }
        Cone {
            axis: across * (Real::ONE / sine),
            sine: (along_u.spread + along_v.spread) / sine + Real::power(-20),
            along: [along_u.axis, along_v.axis],
            turn: (along_u.turn + along_v.turn) / sine,
        }
    }

    /// The directions of a line's tangents.
    #[inline(never)]
    pub(super) fn tangents(&self) -> Option<Directions> {
        let mut points = [[0; 3]; MAX_DEGREE + 1];
        let radius = self.centre(&mut points);
        self.directions(&points, radius, 0)
    }

    /// Writes weighted control points about the middle with at most 29 bits; how far any point of the part is from it.
    fn centre(&self, points: &mut [[i64; 3]]) -> i64 {
        let middle = three!(|k| (self.low[k] >> 1) + (self.high[k] >> 1));
        let size = self.size().max(1);
        let shift = (64 - size.leading_zeros() as i32 - 28).max(0);
        for (out, p) in points.iter_mut().zip(self.points()) {
            for k in 0..3 {
                out[k] = (((p[k] - middle[k]) >> shift) * p[3]) >> 24;
            }
        }
        (size >> shift) + 1
    }

    /// The directions of the derivatives along u or v.
    ///
    /// Beyond the part by a share ε, each of n − 1 steps of de Casteljau's algorithm moves a difference by ε times another
    /// less itself: 2 n ε times the longest in all, and directions turn by that over the shortest.
    fn directions(&self, points: &[[i64; 3]], radius: i64, along: usize) -> Option<Directions> {
        let mut sum = [0_i64; 3];
        self.differences(along, |a, b| {
            let [p, q] = [a, b].map(|k| points.get(k).copied().unwrap_or([0; 3]));
            sum = three!(|k| sum[k] + q[k] - p[k]);
        });
        let axis = V3::bits(sum, 0);
        let length = axis.square();
        if length.is_zero() {
            return None;
        }
        let (mut worst, mut shortest, mut longest, mut turn) = (Real::ZERO, Real::power(60), Real::ZERO, 0_i64);
        let weight = |k: usize| self.hull.get(k).map_or(0, |p| p[3]);
        self.differences(along, |a, b| turn = turn.max((weight(a) - weight(b)).abs()));
        // Two units of rounding a component, and what the weights' change adds.
        let widening = Real::int(4 + if turn == 0 { 0 } else { 2 * ((radius * turn) >> 24) + 2 });
        let inverse = Real::ONE / length.sqrt();
        let mut bad = false;
        self.differences(along, |a, b| {
            let [p, q] = [a, b].map(|k| points.get(k).copied().unwrap_or([0; 3]));
            let d = V3::bits(three!(|k| q[k] - p[k]), 0);
            let forward = d.dot(axis) * inverse;
            let aside = (d.square() - forward.square()).max(Real::ZERO);
            let least = forward - widening;
            if !least.is_positive() {
                bad = true;
                return;
            }
            worst = worst.max(aside / least.square());
            (shortest, longest) = (shortest.min(least), longest.max(d.square()));
        });
        if bad {
            return None;
        }
        let worst = worst.sqrt() + widening / shortest;
        // tan α to 2 sin(α/2) = √(2 − 2 cos α).
        let cosine = Real::ONE / (Real::ONE + worst.square()).sqrt();
        Some(Directions {
            axis: axis * inverse,
            spread: ((Real::ONE - cosine).shl(1)).max(Real::ZERO).sqrt(),
            turn: (longest.sqrt() + widening) / shortest * Real::int(2 * MAX_DEGREE as i64),
        })
    }

    /// Calls `visit` with the indices of neighbours along u or v.
    fn differences(&self, along: usize, mut visit: impl FnMut(usize, usize)) {
        let (m, h) = self.degrees;
        if self.triangle {
            for row in 0..m {
                for k in 0..=row {
                    let at = triangle_index(row - k, k);
                    let towards = if along == 0 { at } else { at + row + 1 };
                    let from = at + row + 2;
                    if from < ROOM {
                        visit(from, towards.min(ROOM - 1));
                    }
                }
            }
            return;
        }
        let (rows, columns, step) = if along == 0 { (m, h + 1, h + 1) } else { (m + 1, h, 1) };
        for i in 0..rows {
            for j in 0..columns {
                let at = i * (h + 1) + j;
                if at + step < ROOM {
                    visit(at, at + step);
                }
            }
        }
    }
}
