//! Newton's method in integers: points of both surfaces to the last bits of the parameters.
//!
//! A step has a closed form and a condition of 1/sin of the angle between the surfaces, not 1/sin² as normal equations:
//! with r = R − S, the normals nA and nB, T = nA × nB and a plane through c with normal τ,
//! δ = \[(nB·r)(τ × nA) + (τ·(c − S)) T\] / (τ·T) is the move of S within its tangent plane, δ − r that of R.

use super::sheet::{Jet, ONE, POINT_BITS, Place, Sheet};
use super::vector::V3;
use crate::num::Real;

/// Parameters are in units of 2^-48.
use super::sheet::PARAMETER_BITS;

/// Iterations after which a point counts as not found.
const LIMIT: u32 = 16;

/// A place on both surfaces.
pub(super) type Places = [Place; 2];

/// A point of both surfaces with what belongs to it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Spot {
    pub(super) at: Places,
    /// In units of 2^-44.
    pub(super) point: [i64; 3],
    /// The unit tangent of the intersection, along nA × nB; zero where the surfaces are tangent.
    pub(super) tangent: V3,
    /// Parameters a unit along the tangent.
    pub(super) rates: [[Real; 2]; 2],
    /// The sine of the angle between the surfaces.
    pub(super) sine: Real,
    /// The distance of the two surface points.
    pub(super) residual: Real,
}

/// Two patches ready for evaluation, A and B.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pair<'a> {
    pub(super) sheets: [Sheet<'a>; 2],
    /// The distance of the surface points that counts as none.
    pub(super) accept: Real,
    /// The longer of the two extents.
    pub(super) extent: Real,
}

#[cfg_attr(target_pointer_width = "32", inline(never))]
pub(super) fn difference(a: [i64; 3], b: [i64; 3]) -> V3 {
    V3::bits(three!(|k| a[k].wrapping_sub(b[k])), -POINT_BITS)
}

/// `point` + `move`, both in space.
#[cfg_attr(target_pointer_width = "32", inline(never))]
pub(super) fn moved(point: [i64; 3], by: V3) -> [i64; 3] {
    let by = by.fixed(POINT_BITS);
    three!(|k| point[k].wrapping_add(by[k]))
}

pub(super) fn middle(a: [i64; 3], b: [i64; 3]) -> [i64; 3] {
    three!(|k| (a[k] >> 1).wrapping_add(b[k] >> 1).wrapping_add(a[k] & b[k] & 1))
}

/// The parameters' move whose image under the derivatives is nearest to `by`; the normal is Su × Sv.
#[cfg_attr(target_pointer_width = "32", inline(never))]
#[cfg_attr(not(target_pointer_width = "32"), inline)]
pub(super) fn pull_back(first: &[V3; 2], normal: V3, by: V3) -> [Real; 2] {
    let inverse = Real::ONE / normal.square();
    [by.cross(first[1]).dot(normal) * inverse, first[0].cross(by).dot(normal) * inverse]
}

/// A place moved by parameters, within an eighth of the domain.
#[cfg_attr(target_pointer_width = "32", inline(never))]
pub(super) fn shifted(place: Place, by: [Real; 2]) -> Place {
    let step = |p: i64, d: Real| {
        let d = d.nearest(PARAMETER_BITS).clamp(-ONE, ONE);
        (p + d).clamp(-ONE / 8, ONE + ONE / 8)
    };
    [step(place[0], by[0]), step(place[1], by[1])]
}

impl<'a> Pair<'a> {
    /// Control points of the larger net.
    pub(super) fn most_points(&self) -> usize {
        self.sheets.iter().fold(0, |most, sheet| most.max(sheet.source.points().len()))
    }

    pub(super) fn of(sheets: [Sheet<'a>; 2]) -> Self {
        let mut pair = Self { sheets, accept: Real::ZERO, extent: Real::ZERO };
        pair.extent = pair.sheets[0].extent.max(pair.sheets[1].extent);
        pair.accept = Real::power(-36).max(pair.extent.shl(-46));
        pair
    }

    /// Jets at places, up to an order of derivatives.
    pub(super) fn jets(&self, at: Places, order: u32) -> Option<[Jet; 2]> {
        let mut jets = [Jet::BLANK; 2];
        self.jets_to(at, order, &mut jets)?;
        Some(jets)
    }

    /// The same in place.
    #[inline]
    pub(super) fn jets_to(&self, at: Places, order: u32, [a, b]: &mut [Jet; 2]) -> Option<()> {
        self.sheets[0].eval_to(at[0], order, a)?;
        self.sheets[1].eval_to(at[1], order, b)
    }

    /// The spot at a place whose jets are known.
    #[cfg_attr(target_pointer_width = "32", inline(never))]
    pub(super) fn spot(&self, at: Places, jets: &[Jet; 2]) -> Spot {
        let normals = [jets[0].normal(), jets[1].normal()];
        let product = normals[0].cross(normals[1]);
        let square = product.square();
        let lengths = normals[0].square() * normals[1].square();
        let sine = (square / lengths).sqrt();
        let tangent = product * (Real::ONE / square.sqrt());
        let rates = both!(|s| pull_back(&jets[s].first, normals[s], tangent));
        let point = middle(jets[0].point, jets[1].point);
        Spot { at, point, tangent, rates, sine, residual: difference(jets[1].point, jets[0].point).norm() }
    }

    /// The point of both surfaces in the plane through `c` with normal `plane`, near `at`.
    #[inline(never)]
    pub(super) fn in_plane(&self, mut at: Places, c: [i64; 3], plane: V3) -> Option<Spot> {
        let near = self.extent.shl(-20);
        let mut jets = [Jet::BLANK; 2];
        for round in 0..LIMIT {
            self.jets_to(at, 1, &mut jets)?;
            let r = difference(jets[1].point, jets[0].point);
            let off = plane.dot(difference(c, jets[0].point));
            let square = r.square();
            if round > 0 && square <= self.accept.square() && off.abs() <= near {
                return Some(self.spot(at, &jets));
            }
            let normals = [jets[0].normal(), jets[1].normal()];
            let tangent = normals[0].cross(normals[1]);
            let across = plane.dot(tangent);
            if across.is_zero() {
                return None;
            }
            let delta = (plane.cross(normals[0]) * normals[1].dot(r) + tangent * off) * (Real::ONE / across);
            let moves = [delta, delta - r];
            at = both!(|s| shifted(at[s], pull_back(&jets[s].first, normals[s], moves[s])));
        }
        None
    }

    /// The point of both surfaces nearest to the line of intersection from `at`: the plane moves along.
    pub(super) fn nearest(&self, at: Places) -> Option<Spot> {
        let (c, tangent) = self.line(at)?;
        self.in_plane(at, c, tangent)
    }

    /// The middle of two places' points, and the direction across both normals.
    #[inline(never)]
    fn line(&self, at: Places) -> Option<([i64; 3], V3)> {
        let jets = self.jets(at, 1)?;
        let tangent = jets[0].normal().cross(jets[1].normal());
        Some((middle(jets[0].point, jets[1].point), tangent.unit()))
    }

    /// The point where an edge of one patch meets the other, near `at`; the edge's parameter and the other's two move.
    pub(super) fn on_edge(&self, side: usize, edge: usize, at: Places) -> Option<Spot> {
        let sheet = &self.sheets[side & 1];
        let onto = |place: Place| sheet.edge_place(edge, sheet.edge_parameter(edge, place));
        self.on_line(side, sheet.edge_direction(edge).map(Real::int), &onto, at)
    }

    /// The same for a line in a direction of the domain; `onto` keeps places on it.
    #[inline(never)]
    pub(super) fn on_line(
        &self,
        side: usize,
        direction: [Real; 2],
        onto: &dyn Fn(Place) -> Place,
        mut at: Places,
    ) -> Option<Spot> {
        let (one, other) = (side & 1, 1 - (side & 1));
        at[one] = onto(at[one]);
        let mut jets = [Jet::BLANK; 2];
        for round in 0..LIMIT {
            self.jets_to(at, 1, &mut jets)?;
            let r = difference(jets[other].point, jets[one].point);
            if round > 0 && r.square() <= self.accept.square() {
                return Some(self.spot(at, &jets));
            }
            let [a, b] = direction;
            let along = jets[one].first[0] * a + jets[one].first[1] * b;
            let normal = jets[other].normal();
            let across = normal.dot(along);
            if across.is_zero() {
                return None;
            }
            let step = normal.dot(r) / across;
            at[other] = shifted(at[other], pull_back(&jets[other].first, normal, along * step - r));
            at[one] = onto(shifted(at[one], [a * step, b * step]));
        }
        None
    }

    /// The foot on a surface of a point near it, from a place; by Gauss's method, without second derivatives.
    pub(super) fn foot(&self, side: usize, place: Place, c: [i64; 3]) -> Option<(Place, Jet)> {
        let mut jet = Jet::BLANK;
        let place = self.foot_to(side, place, c, &mut jet)?;
        Some((place, jet))
    }

    /// The foot's place alone.
    #[inline(never)]
    pub(super) fn foot_place(&self, side: usize, place: Place, c: [i64; 3]) -> Option<Place> {
        let mut jet = Jet::BLANK;
        self.foot_to(side, place, c, &mut jet)
    }

    /// The same with the jet in place.
    #[inline(never)]
    pub(super) fn foot_to(&self, side: usize, mut place: Place, c: [i64; 3], jet: &mut Jet) -> Option<Place> {
        let sheet = &self.sheets[side & 1];
        for _ in 0..LIMIT {
            sheet.eval_to(place, 1, jet)?;
            let step = pull_back(&jet.first, jet.normal(), difference(c, jet.point));
            let next = shifted(place, step);
            let size = both!(|k| (next[k] - place[k]).abs());
            if size[0].max(size[1]) <= 2 {
                return Some(place);
            }
            place = next;
        }
        sheet.eval_to(place, 1, jet)?;
        Some(place)
    }

    /// Whether a place lies in a patch's domain, up to `slack` units of 2^-48.
    pub(super) fn inside(&self, at: Places, slack: i64) -> bool {
        self.sheets.iter().zip(at).all(|(sheet, place)| sheet.contains(place, slack))
    }
}

impl Sheet<'_> {
    /// The number of edges.
    pub(super) fn edge_count(&self) -> usize {
        if self.triangle { 3 } else { 4 }
    }

    /// How far inside an edge a place lies, in units of the parameter.
    pub(super) fn inset(&self, edge: usize, [u, v]: Place) -> i64 {
        match (self.triangle, edge) {
            (true, 0) | (false, 0) => u,
            (true, 1) | (false, 2) => v,
            (true, _) => ONE - u - v,
            (false, 1) => ONE - u,
            (false, _) => ONE - v,
        }
    }

    pub(super) fn contains(&self, place: Place, slack: i64) -> bool {
        (0..self.edge_count()).all(|edge| self.inset(edge, place) >= -slack)
    }

    /// The parameters' direction along an edge.
    pub(super) fn edge_direction(&self, edge: usize) -> [i64; 2] {
        match (self.triangle, edge) {
            (_, 0) | (false, 1) => [0, 1],
            (true, 1) | (false, _) => [1, 0],
            (true, _) => [1, -1],
        }
    }

    /// The parameter of an edge nearest to a place: v on u = const, u on v = const and on w = 0.
    pub(super) fn edge_parameter(&self, edge: usize, [u, v]: Place) -> i64 {
        let parameter = match (self.triangle, edge) {
            (_, 0) | (false, 1) => v,
            (true, 2) => (u - v + ONE) >> 1,
            _ => u,
        };
        parameter.clamp(0, ONE)
    }

    /// The place of an edge's parameter.
    pub(super) fn edge_place(&self, edge: usize, parameter: i64) -> Place {
        match (self.triangle, edge) {
            (_, 0) => [0, parameter],
            (true, 1) | (false, 2) => [parameter, 0],
            (true, _) => [parameter, ONE - parameter],
            (false, 1) => [ONE, parameter],
            (false, _) => [parameter, ONE],
        }
    }

    /// The corner at a place, if it is one up to `slack`: tensor 0 (0,0), 1 (1,0), 2 (0,1), 3 (1,1); triangle 0 u = 1,
    /// 1 v = 1, 2 w = 1.
    pub(super) fn corner(&self, place: Place, slack: i64) -> Option<u8> {
        let near = |edge| self.inset(edge, place).abs() <= slack;
        if self.triangle {
            return [[1, 2], [0, 2], [0, 1]].iter().zip(0..).find(|(e, _)| near(e[0]) && near(e[1])).map(|(_, k)| k);
        }
        let corners = [[0, 2], [1, 2], [0, 3], [1, 3]];
        corners.iter().zip(0..).find(|(e, _)| near(e[0]) && near(e[1])).map(|(_, k)| k)
    }

    /// The edge at a place, if it lies on one up to `slack`.
    pub(super) fn edge_at(&self, place: Place, slack: i64) -> Option<u8> {
        (0..self.edge_count()).find(|edge| self.inset(*edge, place).abs() <= slack).map(|edge| edge as u8)
    }
}
