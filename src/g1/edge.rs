//! The points beside the middle of an edge (step 5 of the scheme).

use super::balance::{Freedom, freedom};
use super::setting::{FACTOR, ONE, Setting, combine, fits};
use super::solve::Solved;
use super::{G1Error, Scheme, literal};
use crate::num::{Coord, Sum3, Triple, length, minus, plus, ratio, shift_half_up};

/// Sums are clamped to this before they are rounded.
const LARGE: i128 = 1 << 124;

/// One end of an edge, seen from there: points at the vertex, along the edge, and of the rows to its left and right.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct End {
    pub(super) vertex: usize,
    /// c0, c1, c2.
    pub(super) along: [Triple; 3],
    /// l0, l1.
    pub(super) left: [Triple; 2],
    /// r0, r1.
    pub(super) right: [Triple; 2],
    pub(super) kappa: i64,
    pub(super) m: i64,
    /// What the literal construction needs: areas of the sectors to the right and left, and the determinant across.
    pub(super) areas: [i128; 3],
}

impl End {
    /// The end of edge i of a vertex; the points of a side without a face mean nothing.
    pub(super) fn of(solved: &Solved, i: usize) -> Self {
        let (fan, star) = (&solved.fan, &solved.fan.star);
        let from = |vector: &Triple| plus(&fan.at, vector);
        let (before, after) = (star.before(i), star.after(i));
        Self {
            vertex: fan.vertex,
            along: [fan.at, from(&fan.e[i]), from(&solved.z[i])],
            left: [from(&fan.e[after]), from(&solved.w[i])],
            right: [from(&fan.e[before]), from(&solved.w[before])],
            kappa: fan.kappa[i],
            m: fan.m[i],
            areas: [fan.area(before), fan.area(i), fan.across(i)],
        }
    }
}

/// All points of an inner edge: c0 … c5, l0 … l4, r0 … r4.
#[derive(Clone, Copy, Debug)]
pub(super) struct Edge {
    pub(super) c: [Triple; 6],
    pub(super) l: [Triple; 5],
    pub(super) r: [Triple; 5],
    /// By how much the difference of the two middle points was corrected, in 2^-32 of the edge's length.
    pub(super) correction: i64,
}

impl Edge {
    /// The points as their ends know them, the middle ones still missing.
    pub(super) fn between(from: &End, to: &End) -> Self {
        let c = [from.along[0], from.along[1], from.along[2], to.along[2], to.along[1], to.along[0]];
        let l = [from.left[0], from.left[1], [0; 3], to.right[1], to.right[0]];
        let r = [from.right[0], from.right[1], [0; 3], to.left[1], to.left[0]];
        Self { c, l, r, correction: 0 }
    }

    /// T_i = l_i − r_i.
    fn t(&self, i: usize) -> Triple {
        minus(&self.l[i % 5], &self.r[i % 5])
    }

    /// S_i = l_i + r_i − c_i − c_(i+1).
    fn s(&self, i: usize) -> Triple {
        plus(&minus(&self.l[i % 5], &self.c[i % 5]), &minus(&self.r[i % 5], &self.c[i % 5 + 1]))
    }

    /// E_i = c_(i+1) − c_i.
    fn e(&self, i: usize) -> Triple {
        minus(&self.c[i % 5 + 1], &self.c[i % 5])
    }

    /// Δ⁵c.
    fn fifth_difference(&self) -> Sum3 {
        const ROW: [i64; 6] = [-1, 5, -10, 10, -5, 1];
        self.c.iter().zip(ROW).fold(Sum3::default(), |sum, (c, factor)| sum.plus(c, factor))
    }
}

impl<C: Coord> Setting<'_, C> {
    /// All points of the edge between two ends.
    #[inline(never)]
    pub(super) fn edge(&self, from: &End, to: &End) -> Result<Edge, G1Error> {
        let mut edge = Edge::between(from, to);
        if self.options.scheme == Scheme::Literal {
            literal::fill(&mut edge, from, to)?;
        } else {
            self.fill(&mut edge, from, to)?;
        }
        Ok(edge)
    }

    /// Steps: T2 = (4T1 + 4T3 − T0 − T4)/6 − (M/K)·Δ⁵c/6, S2 the mean of its two equations, l2 and r2 from both.
    pub(super) fn fill(&self, edge: &mut Edge, from: &End, to: &End) -> Result<(), G1Error> {
        let (vertex, names) = (from.vertex, [from.vertex as u16, to.vertex as u16]);
        let span = length(&minus(&edge.c[5], &edge.c[0])).max(1);
        let (t0, t1, t3, t4) = (edge.t(0), edge.t(1), edge.t(3), edge.t(4));
        let mut t2 = Sum3::default().plus(&t1, 4).plus(&t3, 4).plus(&t0, -1).plus(&t4, -1);
        let (k, m) = (from.kappa + to.kappa, from.m + to.m);
        if freedom(k, m) == Freedom::Normal {
            let factor = fits(ratio(m.into(), k.unsigned_abs().into(), FACTOR), vertex)?;
            let factor = if k < 0 { -factor } else { factor };
            let difference = fits(edge.fifth_difference().narrow(0), vertex)?;
            let correction = fits(combine(&[(&difference, -factor)]), vertex)?;
            t2.add(&correction, 1);
            edge.correction = ratio((length(&correction) / 6).into(), span.into(), 32).unwrap_or(i64::MAX);
        }
        let t2 = fits(t2.divide(6), vertex)?;
        // κ and m are linear along the edge; at its end they have the other sign there.
        let (kappa, m) = ([from.kappa, -to.kappa], [from.m, -to.m]);
        let near = Sum3::default()
            .plus(&edge.s(1), -4 * ONE)
            .plus(&t2, -6 * kappa[0])
            .plus(&t1, -4 * kappa[1])
            .plus(&edge.e(2), -6 * m[0])
            .plus(&edge.e(1), -4 * m[1]);
        let far = Sum3::default()
            .plus(&edge.s(3), -4 * ONE)
            .plus(&t2, -6 * kappa[1])
            .plus(&t3, -4 * kappa[0])
            .plus(&edge.e(2), -6 * m[1])
            .plus(&edge.e(3), -4 * m[0]);
        self.check_middle(&near, &far, (span, m), names)?;
        // Four bits more than the points have, then over the twelve equations.
        let rounded = |near: i128, far: i128| shift_half_up(near.saturating_add(far).clamp(-LARGE, LARGE), FACTOR - 4);
        let both = [rounded(near.0[0], far.0[0]), rounded(near.0[1], far.0[1]), rounded(near.0[2], far.0[2])];
        let s2 = fits(Sum3(both).divide(12 << 4), vertex)?;
        let sum = Sum3::default().plus(&s2, 1).plus(&edge.c[2], 1).plus(&edge.c[3], 1);
        edge.l[2] = fits(sum.plus(&t2, 1).narrow(1), vertex)?;
        edge.r[2] = fits(sum.plus(&t2, -1).narrow(1), vertex)?;
        Ok(())
    }

    /// The two equations of 6·S2, in 2^-48, must agree: within twice the tolerance of the edge's length and what rounding
    /// leaves.
    fn check_middle(&self, near: &Sum3, far: &Sum3, (span, m): (u64, [i64; 2]), edge: [u16; 2]) -> Result<(), G1Error> {
        let apart = near.0.iter().zip(&far.0).map(|(near, far)| near.saturating_sub(*far).unsigned_abs());
        let difference = apart.max().unwrap_or(0) >> 32;
        // In 2^-48.
        let rounding = (1 << 24) + ((m[0].unsigned_abs() >> 20) + (m[1].unsigned_abs() >> 20));
        let tolerance = self.options.tolerance.to_bits().unsigned_abs();
        let most = ((u128::from(span) * u128::from(tolerance)) >> 11) + u128::from(rounding);
        if difference <= most {
            return Ok(());
        }
        let residual = self.outward(shift_half_up((difference / 6) as i128, 16));
        Err(G1Error::EdgeSingular { edge, residual })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::g1::balance::View;
    use crate::g1::{Controls, Options, Shift};
    use crate::geometry::Point3;
    use crate::mesh::{Faces, HalfEdge, Links, Mesh};
    use crate::num::I16F16;

    const FACES: [[u16; 3]; 4] = [[0, 1, 2], [0, 3, 1], [1, 3, 2], [2, 3, 0]];

    /// After the vertices are solved both equations of an edge agree; with a twist point that was altered they do not.
    #[test]
    fn an_altered_edge_is_singular() {
        let points = [[9, 9, 9], [-9, -9, 9], [-9, 9, -9], [9, -9, -9]].map(|[x, y, z]| Point3::from_ints(x, y, z));
        let links = Links::<4, 12>::new(4, Faces::Triangles(&FACES)).unwrap();
        let mesh = Mesh::<I16F16>::new(&points, &links).unwrap();
        let setting = Setting::new(&mesh, &Controls::default(), &Options::default()).unwrap();
        let view = View { setting: &setting, shifts: &[Shift::NONE; 4] };
        let end = |vertex: usize, half_edge: usize| {
            let mut solved = Solved::blank();
            view.solved(vertex, &mut solved).unwrap();
            End::of(&solved, solved.fan.star.place_of_half_edge(half_edge))
        };
        let twin = mesh.twin(HalfEdge::new(0)).unwrap().index();
        let (mut from, to) = (end(0, 0), end(1, twin));
        assert!(setting.edge(&from, &to).is_ok());
        from.left[1][0] += 1 << 32;
        let error = setting.edge(&from, &to).unwrap_err();
        assert!(matches!(error, G1Error::EdgeSingular { edge: [0, 1], residual } if residual > 1 << 25), "{error}");
    }
}
