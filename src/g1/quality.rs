//! How good a surface is.

use super::balance::View;
use super::edge::Edge;
use super::face::{Points, index};
use super::setting::Setting;
use super::{G1Error, Scheme};
use crate::mesh::HalfEdge;
use crate::num::{
    BINOMIAL, Coord, I32F32, Sum3, Triple, UNIT, arctangent, cross, dot, length, minus, ratio, shortened, unit,
};

/// How smooth a surface is, and how far it is from the cubic one that it starts from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub struct Quality {
    /// The largest angle between the normals of two faces at 17 places of their edge, in 2^-60 rad, at the control points as
    /// they are emitted; about half a turn where a face turns over. A normal that vanishes does not count.
    pub max_angle: u64,
    /// The largest distance from the PN triangle with the same tangents, at the points of a lattice of 28, in longest edges of
    /// the face.
    pub max_deviation: I32F32,
    /// The largest correction of an edge's two middle points against each other, in lengths of the edge. Above 1 means
    /// poor shape, typically beside very short edges. With [`Scheme::Literal`] the distance of one from its curve.
    pub max_correction: I32F32,
    /// The faces that fold: that somewhere have a normal at more than a right angle to that of the PN triangle.
    pub folded: usize,
    /// The vertices whose tangents were moved.
    pub shifted: usize,
}

impl Quality {
    /// The largest angle in units of 2^-32 rad, rounded up.
    #[must_use]
    pub const fn max_angle_rounded(&self) -> I32F32 {
        I32F32::from_bits(self.max_angle.div_ceil(1 << 28) as i64)
    }
}

#[cfg(feature = "defmt")]
impl defmt::Format for Quality {
    fn format(&self, f: defmt::Formatter<'_>) {
        let (deviation, correction) = (self.max_deviation.to_bits(), self.max_correction.to_bits());
        defmt::write!(f, "angle {}/2^60, deviation {}/2^32, ", self.max_angle, deviation);
        defmt::write!(f, "correction {}/2^32, {} folded, {} shifted", correction, self.folded, self.shifted);
    }
}

/// 2π in 2^-60.
const TURN: u128 = 7_244_019_458_077_122_842;

/// The angle between two directions in 2^-60 rad; `None` where one vanishes.
fn angle(p: [i128; 3], q: [i128; 3]) -> Option<u64> {
    let (p, q) = (unit(p)?, unit(q)?);
    let sine = length(&cross(&p, &q).map(|c| (c >> UNIT) as i64));
    let cosine = (dot(&p, &q) >> UNIT) as i64;
    if cosine > 0 && sine < 1 << 40 {
        // An arc of less than 2^-20: the sine is shorter by less than 2^-61.
        return Some(sine);
    }
    Some(((u128::from(arctangent(sine as i64, cosine)) * TURN) >> 64) as u64)
}

/// Places of an edge, ends included, less one.
const PLACES: i64 = 16;

/// The largest angle between the normals along an edge.
fn edge_angle(edge: &Edge) -> u64 {
    const CHOICES: [i64; 5] = [1, 4, 6, 4, 1];
    let mut largest = 0;
    for j in 0..=PLACES {
        let mut tangents = [Sum3::default(); 3];
        for (i, choices) in CHOICES.into_iter().enumerate() {
            let weight = choices * j.pow(i as u32) * (PLACES - j).pow(4 - i as u32);
            for (sum, rows) in tangents.iter_mut().zip([&edge.c[1..], &edge.l[..], &edge.r[..]]) {
                if let Some(point) = rows.get(i) {
                    sum.add(&minus(point, &edge.c[i]), weight);
                }
            }
        }
        let [along, left, right] = tangents.map(|sum| shortened(sum.0));
        largest = largest.max(angle(cross(&along, &left), cross(&right, &along)).unwrap_or(0));
    }
    largest
}

/// Steps of the lattice on which normals of a face are compared.
const STEPS: usize = 6;

/// n!/(i!·j!·k!) for j + k = row and i + row = n.
fn ways(n: usize, row: usize, k: usize) -> i64 {
    let choose = |n: usize, k: usize| BINOMIAL.get(n).and_then(|row| row.get(k)).map_or(0, |ways| i64::from(*ways));
    choose(n, row) * choose(row, k)
}

/// The two partial derivatives of a quintic triangle at (i, j, k)/6, up to a factor.
fn partials(points: &Points, at: [usize; 3]) -> [Triple; 2] {
    let mut sums = [Sum3::default(); 2];
    let power = |c: usize, exponent: usize| (at[c] as i64).pow(exponent as u32);
    for row in 0..=4 {
        for k in 0..=row {
            let (i, j) = (4 - row, row - k);
            let weight = ways(4, row, k) * power(0, i) * power(1, j) * power(2, k);
            let corner = points[index(j, k) % 21];
            sums[0].add(&minus(&points[index(j + 1, k) % 21], &corner), weight);
            sums[1].add(&minus(&points[index(j, k + 1) % 21], &corner), weight);
        }
    }
    sums.map(|sum| shortened(sum.0))
}

/// The largest distance between two quintic triangles at the same parameters.
fn largest_change(points: &Points, target: &Points) -> u64 {
    let places = (0..=STEPS).flat_map(|j| (0..=STEPS - j).map(move |k| [STEPS - j - k, j, k]));
    let change = |at: [usize; 3]| {
        let power = |c: usize, exponent: usize| (at[c] as i64).pow(exponent as u32);
        let mut sum = Sum3::default();
        for row in 0..=5 {
            for k in 0..=row {
                let (i, j) = (5 - row, row - k);
                let place = index(j, k) % 21;
                sum.add(
                    &minus(&points[place], &target[place]),
                    ways(5, row, k) * power(0, i) * power(1, j) * power(2, k),
                );
            }
        }
        sum.divide((STEPS as i64).pow(5)).map_or(u64::MAX, |change| length(&change))
    };
    places.map(change).max().unwrap_or(0)
}

fn folds(points: &Points, target: &Points) -> bool {
    (0..=STEPS).any(|j| {
        (0..=STEPS - j).any(|k| {
            let at = [STEPS - j - k, j, k];
            let [normal, aim] = [points, target].map(|net| {
                let [p, q] = partials(net, at);
                shortened(cross(&p, &q))
            });
            dot(&normal, &aim) < 0
        })
    })
}

impl<C: Coord> Setting<'_, C> {
    /// The edge as it is emitted.
    fn emitted(&self, mut edge: Edge) -> Edge {
        for point in edge.c.iter_mut().chain(&mut edge.l).chain(&mut edge.r) {
            *point = self.rounded(point);
        }
        edge
    }
}

impl<C: Coord> View<'_, '_, C> {
    /// Whether a face folds.
    pub(super) fn is_folded(&self, face: usize) -> Result<bool, G1Error> {
        let face = self.face(face)?;
        Ok(folds(&face.points, &face.target))
    }

    pub(super) fn quality(&self) -> Result<Quality, G1Error> {
        let mut quality =
            Quality { shifted: self.shifts.iter().filter(|shift| !shift.is_none()).count(), ..Quality::default() };
        for face in 0..self.setting.mesh.faces().len() {
            self.add_face(&mut quality, face)?;
            for half_edge in 3 * face..3 * face + 3 {
                let twin = self.setting.mesh.twin(HalfEdge::new(half_edge as u16));
                if let Some(twin) = twin.filter(|twin| half_edge < twin.index()) {
                    self.add_edge(&mut quality, half_edge, twin.index())?;
                }
            }
        }
        Ok(quality)
    }

    #[inline(never)]
    fn add_face(&self, quality: &mut Quality, face: usize) -> Result<(), G1Error> {
        let face = self.face(face)?;
        let corners = [face.points[0], face.points[index(5, 0)], face.points[index(0, 5)]];
        let span = |a: usize, b: usize| length(&minus(&corners[a], &corners[b]));
        let longest = span(0, 1).max(span(1, 2)).max(span(2, 0));
        let deviation =
            ratio(largest_change(&face.points, &face.target).into(), longest.into(), 32).unwrap_or(i64::MAX);
        quality.max_deviation = quality.max_deviation.max(I32F32::from_bits(deviation));
        quality.folded += usize::from(folds(&face.points, &face.target));
        Ok(())
    }

    #[inline(never)]
    fn add_edge(&self, quality: &mut Quality, half_edge: usize, twin: usize) -> Result<(), G1Error> {
        let edge = match self.setting.options.scheme {
            Scheme::Smooth | Scheme::Literal => self.edge_of(half_edge, twin)?,
            Scheme::PointNormal | Scheme::Flat => self.seam(half_edge, twin)?,
        };
        quality.max_correction = quality.max_correction.max(I32F32::from_bits(edge.correction));
        quality.max_angle = quality.max_angle.max(edge_angle(&self.setting.emitted(edge)));
        Ok(())
    }

    /// The rows of two faces' control points along their edge.
    #[inline(never)]
    fn seam(&self, half_edge: usize, twin: usize) -> Result<Edge, G1Error> {
        let mut edge = Edge { c: [[0; 3]; 6], l: [[0; 3]; 5], r: [[0; 3]; 5], correction: 0 };
        let (left, right) = (self.face(half_edge / 3)?.points, self.face(twin / 3)?.points);
        let place =
            |half_edge: usize, a: usize, b: usize, rest: usize| super::face::index_from(half_edge % 3, a, b, rest) % 21;
        for (i, c) in edge.c.iter_mut().enumerate() {
            *c = left[place(half_edge, 5 - i, i, 0)];
        }
        for (i, (l, r)) in edge.l.iter_mut().zip(&mut edge.r).enumerate() {
            *l = left[place(half_edge, 4 - i, i, 1)];
            *r = right[place(twin, i, 4 - i, 1)];
        }
        Ok(edge)
    }
}
