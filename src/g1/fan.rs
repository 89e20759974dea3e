//! The tangents of a vertex and the coefficients that follow from them (steps 1 and 2 of the scheme).

use super::ring::{Ring, Star};
use super::sectors::{Directions, short};
use super::setting::{ONE, Setting, fits};
use super::shift::Shift;
use super::{FACTOR, G1Error, Lengths, Scheme};
use crate::mesh::angle_between;
use crate::num::{Coord, I32F32, Sum3, Triple, UNIT, arctangent, cross, dot, length, minus, ratio, unit};

/// A vector in the tangent plane.
pub(super) type Flat = [i64; 2];

/// Coefficients stay below 2^12.
const LARGEST: u64 = 1 << (FACTOR + 12);

/// A vertex with its tangents.
#[derive(Clone, Copy, Debug)]
pub(super) struct Fan {
    pub(super) vertex: usize,
    pub(super) at: Triple,
    pub(super) star: Star,
    /// Unit vectors that span the tangent plane; a × b is the normal.
    axes: [Triple; 2],
    /// Tangents in the tangent plane.
    pub(super) t: Ring<Flat>,
    /// The same as vectors, c1 − c0 of each edge.
    pub(super) e: Ring<Triple>,
    /// κ of each inner edge.
    pub(super) kappa: Ring<i64>,
    /// m of each inner edge.
    pub(super) m: Ring<i64>,
    /// The mean length of the tangents.
    pub(super) size: i64,
}

/// det(a, b).
fn det(a: &Flat, b: &Flat) -> i128 {
    i128::from(a[0]) * i128::from(b[1]) - i128::from(a[1]) * i128::from(b[0])
}

/// The length of a vector in the tangent plane, rounded down.
fn size(t: &Flat) -> u64 {
    length(&[t[0], t[1], 0])
}

impl Fan {
    /// Twice the area of sector i.
    pub(super) fn area(&self, i: usize) -> i128 {
        det(&self.t[i], &self.t[self.star.after(i)])
    }

    /// det of the tangents on either side of edge i.
    pub(super) fn across(&self, i: usize) -> i128 {
        det(&self.t[self.star.before(i)], &self.t[self.star.after(i)])
    }

    /// κ and m of an inner edge, equation (C):
    /// κ = (A⁻ − A)/(A⁻ + A), m = 1 − 2·det(t⁻, t⁺)/(A⁻ + A).
    pub(super) fn coefficients(&self, i: usize) -> Result<(i64, i64), G1Error> {
        let vertex = self.vertex;
        let (right, left) = (self.area(self.star.before(i)), self.area(i));
        if right <= 0 || left <= 0 {
            return Err(G1Error::FoldedTangents { vertex });
        }
        let kappa = fits(ratio(right - left, right + left, FACTOR), vertex)?;
        let part = fits(ratio(2 * self.across(i), right + left, FACTOR), vertex)?;
        if part.unsigned_abs() >= LARGEST {
            return Err(G1Error::Overflow { vertex });
        }
        Ok((kappa, ONE - part))
    }

    /// The tangent of edge i as a vector.
    pub(super) fn lifted(&self, i: usize) -> Option<Triple> {
        let [x, y] = self.t[i];
        let [a, b] = &self.axes;
        Sum3::default().plus(a, x).plus(b, y).narrow(UNIT)
    }

    /// A place for a fan, so that none is copied.
    pub(super) const fn blank() -> Self {
        let star = Star { len: 0, closed: true, to: Ring::all(0), left: Ring::all(0) };
        let (t, e, factors) = (Ring::all([0; 2]), Ring::all([0; 3]), Ring::all(0));
        Self { vertex: 0, at: [0; 3], star, axes: [[0; 3]; 2], t, e, kappa: factors, m: factors, size: 0 }
    }

    /// Moves the centre.
    pub(super) fn move_by(&mut self, shift: Shift) {
        if shift.is_none() {
            return;
        }
        let [x, y] = shift.step(self.size);
        for i in 0..self.star.len {
            let t = self.t[i];
            self.t[i] = [t[0].wrapping_add(x), t[1].wrapping_add(y)];
        }
    }

    /// Whether the sine of every sector is at least a tenth.
    pub(super) fn is_open(&self) -> bool {
        (0..self.star.sectors()).all(|i| {
            let sides = u128::from(size(&self.t[i])) * u128::from(size(&self.t[self.star.after(i)]));
            let area = self.area(i);
            area > 0 && area.unsigned_abs() >= sides / 10
        })
    }

    /// Fills in vectors and coefficients.
    pub(super) fn finish(&mut self) -> Result<(), G1Error> {
        for i in 0..self.star.len {
            self.e[i] = fits(self.lifted(i), self.vertex)?;
        }
        let (first, count) = self.star.inner();
        for i in first..first + count {
            (self.kappa[i], self.m[i]) = self.coefficients(i)?;
        }
        Ok(())
    }
}

impl<C: Coord> Setting<'_, C> {
    /// The normal of a vertex in 2^-60.
    fn normal(&self, vertex: usize) -> Result<Triple, G1Error> {
        let bad = G1Error::BadNormal { vertex };
        let Some(normals) = self.controls.normals else { return self.mesh.estimated_normal(vertex).ok_or(bad) };
        let normal = normals.get(vertex).ok_or(bad)?.to_array().map(I32F32::to_bits);
        // Below 10^-9 are lengths of up to 4 bits.
        let square = normal.iter().fold(0_u128, |sum, c| sum + u128::from(c.unsigned_abs()).pow(2) / 4);
        if square < 5 { Err(bad) } else { unit(normal.map(i128::from)).ok_or(bad) }
    }

    /// A vertex with its tangents, moved as the first pass says, and its coefficients.
    #[inline(never)]
    pub(super) fn fan(&self, vertex: usize, shift: Shift, fan: &mut Fan) -> Result<(), G1Error> {
        self.original(vertex, fan)?;
        fan.move_by(shift);
        fan.finish()
    }

    /// A vertex with its tangents where no shift has moved them (step 1), without vectors and coefficients.
    #[inline(never)]
    pub(super) fn original(&self, vertex: usize, fan: &mut Fan) -> Result<(), G1Error> {
        let star = Star::of(&self.mesh, vertex)?;
        let normal = self.normal(vertex)?;
        let axes = axes(&normal).ok_or(G1Error::BadNormal { vertex })?;
        let at = self.place(vertex);
        (fan.vertex, fan.at, fan.star, fan.axes) = (vertex, at, star, axes);
        let edge = |i: usize| minus(&self.place(star.to[i].into()), &at);
        let classical = self.options.scheme == Scheme::PointNormal;
        let mut unknown = false;
        for i in 0..star.len {
            let (d, p) = (edge(i), fits(flattened(&edge(i), &axes), vertex)?);
            let factor = if classical { Some(ONE / 5) } else { self.factor(&d, &p) };
            unknown |= factor.is_none();
            let factor = i128::from(factor.unwrap_or(0)) * i128::from(self.slack(vertex));
            let scaled = |c: i64| i64::try_from((i128::from(c) * (factor >> 16) + i128::from(ONE / 2)) >> FACTOR).ok();
            fan.t[i] = fits(scaled(p[0]).zip(scaled(p[1])), vertex)?.into();
        }
        if !classical && !self.give(fan)? {
            self.spread(fan, unknown, edge)?;
        }
        let sum = (0..star.len).map(|i| u128::from(size(&fan.t[i]))).sum::<u128>();
        fan.size = sum.checked_div(star.len as u128).unwrap_or(0) as i64;
        Ok(())
    }

    /// The tangents that the caller gives; whether there are any.
    fn give(&self, fan: &mut Fan) -> Result<bool, G1Error> {
        let mut given = false;
        for i in 0..fan.star.len {
            if let Some(tangent) = self.given_tangent(fan.vertex, fan.star.to[i]) {
                fan.t[i] = fits(flattened(&tangent, &fan.axes), fan.vertex)?;
                given = true;
            }
        }
        let folded = given && (0..fan.star.sectors()).any(|i| fan.area(i) <= 0);
        if folded { Err(G1Error::FoldedTangents { vertex: fan.vertex }) } else { Ok(given) }
    }

    /// The length of the tangent of an edge d over that of its projection p; `None` where the projection vanishes.
    fn factor(&self, d: &Triple, p: &Flat) -> Option<i64> {
        let (long, short) = (i128::from(length(d)), i128::from(size(p)));
        // Below 2^56, so that products of two and small factors stay below 2^120.
        let excess = (128 - long.unsigned_abs().leading_zeros()).saturating_sub(56);
        let (long, short) = (long >> excess, short >> excess);
        let factor = match self.options.lengths {
            Lengths::Arc => ratio(2 * long * long, 5 * (long + short) * short, FACTOR),
            Lengths::Projected => ratio(short.max(long * 7 / 20), 5 * short, FACTOR),
        };
        factor.filter(|factor| factor.unsigned_abs() < LARGEST)
    }

    /// The length of the tangent of an edge d that has the direction of no projection, or another one.
    fn length(&self, d: &Triple, axes: &[Triple; 2]) -> Option<i64> {
        let (long, short) = (u128::from(length(d)), u128::from(size(&flattened(d, axes)?)));
        let length = match self.options.lengths {
            Lengths::Arc => (2 * long * long).checked_div(5 * (long + short))?,
            Lengths::Projected => short.max(long * 7 / 20) / 5,
        };
        i64::try_from(length).ok()
    }

    /// Spreads directions that leave a sector closed, too narrow or too wide.
    fn spread(&self, fan: &mut Fan, unknown: bool, edge: impl Fn(usize) -> Triple) -> Result<(), G1Error> {
        let mut directions = Ring::all(0);
        let (len, closed) = (fan.star.len, fan.star.closed);
        for i in 0..len {
            directions[i] = arctangent(fan.t[i][1], fan.t[i][0]);
        }
        let corners = |i: usize| angle_between(&edge(i), &edge(fan.star.after(i)));
        let fan_of = Directions { directions: &directions, corners: &corners, len, closed, unknown };
        let Some(new) = fan_of.spread() else { return Ok(()) };
        for i in 0..len {
            let length = fits(self.length(&edge(i), &fan.axes), fan.vertex)?;
            let length = (i128::from(length) * i128::from(self.slack(fan.vertex))) >> 16;
            let (sin, cos) = short(new[i]).sin_cos();
            fan.t[i] = [cos, sin].map(|c| ((length * i128::from(c.to_bits())) >> 32) as i64);
        }
        Ok(())
    }
}

/// The components of a vector along the axes of the tangent plane.
fn flattened(vector: &Triple, axes: &[Triple; 2]) -> Option<Flat> {
    let [x, y] = axes.each_ref().map(|axis| (dot(vector, axis) + (1 << (UNIT - 1))) >> UNIT);
    Some([i64::try_from(x).ok()?, i64::try_from(y).ok()?])
}

/// Unit vectors a and b with a × b = n: a is at right angles to the axis that n has least of.
fn axes(normal: &Triple) -> Option<[Triple; 2]> {
    let [x, y, z] = normal.map(i64::unsigned_abs);
    let axis = if x <= y && x <= z {
        [1, 0, 0]
    } else if y <= z {
        [0, 1, 0]
    } else {
        [0, 0, 1]
    };
    let a = unit(cross(&axis, normal))?;
    Some([a, unit(cross(normal, &a))?])
}
