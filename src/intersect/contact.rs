//! Where the surfaces are parallel: critical points of the height of A over B.
//!
//! Near a point of B with unit normal n, A is a height h(x) = g + p·x + xᵀHx/2 over B, H the difference of the second
//! fundamental forms (as graphs over B's tangent plane). Critical points of h are where the normals are collinear; those
//! with g = 0 are tangencies: det H > 0 an isolated touching point, det H < 0 a branch of two curves, rank 1 a point of a
//! tangential curve. A closed curve over which normals turn less than 90 degrees goes round a critical point (Sinha,
//! Klassen, Wang 1985), so none is missed.

use super::newton::{Pair, Places, Spot, difference, middle, pull_back, shifted};
use super::sheet::{Jet, Place};
use super::vector::V3;
use crate::num::Real;

/// The form of a contact.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Form {
    /// A lies on one side of B: the height has an extremum.
    Definite,
    /// A crosses B in two curves.
    Saddle,
    /// The height is level along one direction.
    Ridge,
    /// The height is level along all directions.
    Flat,
}

/// The height of A over B near a place.
#[derive(Clone, Copy, Debug)]
pub(super) struct Contact {
    pub(super) at: Places,
    pub(super) jets: [Jet; 2],
    /// R − S.
    pub(super) apart: V3,
    /// The height of A over B.
    pub(super) gap: Real,
    /// Curvatures along the axes, the larger one first.
    pub(super) curvatures: [Real; 2],
    /// Unit axes in B's tangent plane.
    pub(super) axes: [V3; 2],
    /// What a curvature is compared with.
    scale: Real,
    /// The step to the critical point along the axes.
    steps: [Real; 2],
    /// S − R in B's tangent plane.
    beside: V3,
}

/// Iterations after which there is no critical point near.
const LIMIT: u32 = 24;

/// A symmetric form [xx, xy, yy].
type Symmetric = [Real; 3];

/// The Hessian of a surface as a height along `normal` over the plane of the axes, whose slope is `slope`.
#[cfg_attr(target_pointer_width = "32", inline(never))]
fn hessian(jet: &Jet, normal: V3, axes: &[V3; 2], slope: V3) -> Symmetric {
    let own = jet.normal();
    let [e, f] = both!(|k| pull_back(&jet.first, own, axes[k]));
    // Second derivatives along the normal, less what the slope explains.
    let [uu, uv, vv] = jet.second.map(|d| d.dot(normal) - d.dot(slope));
    let form = |a: &[Real; 2], b: &[Real; 2]| uu * a[0] * b[0] + uv * (a[0] * b[1] + a[1] * b[0]) + vv * a[1] * b[1];
    [form(&e, &e), form(&e, &f), form(&f, &f)]
}

fn size([a, b, c]: Symmetric) -> Real {
    a.abs().max(b.abs()).max(c.abs())
}

impl Contact {
    /// No contact.
    pub(super) const BLANK: Self = Self {
        at: [[0; 2]; 2],
        jets: [Jet::BLANK; 2],
        apart: V3::ZERO,
        gap: Real::ZERO,
        curvatures: [Real::ZERO; 2],
        axes: [V3::ZERO; 2],
        scale: Real::ZERO,
        steps: [Real::ZERO; 2],
        beside: V3::ZERO,
    };

    /// The contact at a place; `None` where a normal vanishes or the surfaces are at right angles.
    pub(super) fn new(pair: &Pair<'_>, at: Places) -> Option<Self> {
        let mut contact = Self::BLANK;
        contact.move_to(pair, at)?;
        Some(contact)
    }

    /// Becomes the contact at another place.
    #[inline(never)]
    fn move_to(&mut self, pair: &Pair<'_>, at: Places) -> Option<()> {
        self.at = at;
        pair.jets_to(at, 2, &mut self.jets)?;
        let jets = &self.jets;
        let (own, other) = (jets[0].normal(), jets[1].normal());
        if own.is_zero() || other.is_zero() {
            return None;
        }
        let n = other.unit();
        let e = jets[1].first[0].unit();
        let plane = [e, n.cross(e)];
        let steep = own.dot(n);
        if (steep.square()).shl(6) < own.square() {
            return None;
        }
        let apart = difference(jets[1].point, jets[0].point);
        let gap = -apart.dot(n);
        let beside = -apart - n * gap;
        let inverse = Real::ONE / steep;
        let slope = both!(|k| -(own.dot(plane[k]) * inverse));
        let of_a = hessian(&jets[0], n, &plane, plane[0] * slope[0] + plane[1] * slope[1]);
        let of_b = hessian(&jets[1], n, &plane, V3::ZERO);
        let h: Symmetric = three!(|k| of_a[k] - of_b[k]);
        let scale = size(of_a).max(size(of_b)).max(Real::power(-3) / pair.extent);
        // Eigenvalues and axes.
        let (mean, half) = ((h[0] + h[2]).shl(-1), (h[0] - h[2]).shl(-1));
        let spread = (half.square() + h[1].square()).sqrt();
        let (first, last) =
            if mean.is_negative() { (mean - spread, mean + spread) } else { (mean + spread, mean - spread) };
        let (a, b) =
            if (first - h[2]).abs() > (first - h[0]).abs() { (first - h[2], h[1]) } else { (h[1], first - h[0]) };
        let axis = plane[0] * a + plane[1] * b;
        let axis = if axis.is_zero() { plane[0] } else { axis.unit() };
        let axes = [axis, n.cross(axis)];
        // H x = HB·beside − p.
        let [x, y] = both!(|k| beside.dot(plane[k]));
        let right =
            plane[0] * (of_b[0] * x + of_b[1] * y - slope[0]) + plane[1] * (of_b[1] * x + of_b[2] * y - slope[1]);
        let curvatures = [first, last];
        let steps = both!(|k| {
            let level = curvatures[k].abs() <= scale.shl(-20);
            if level { Real::ZERO } else { right.dot(axes[k]) / curvatures[k] }
        });
        (self.apart, self.gap, self.beside, self.scale) = (apart, gap, beside, scale);
        (self.curvatures, self.axes, self.steps) = (curvatures, axes, steps);
        Some(())
    }

    /// How far the critical point seems to be.
    pub(super) fn reach(&self) -> Real {
        self.steps[0].abs().max(self.steps[1].abs()).max(self.beside.norm())
    }

    /// The places after a step of A along the axes; B's foot follows.
    fn stepped(&self, [x, y]: [Real; 2]) -> Places {
        let by = self.axes[0] * x + self.axes[1] * y;
        let move_of = |s: usize, by: V3| shifted(self.at[s], pull_back(&self.jets[s].first, self.jets[s].normal(), by));
        [move_of(0, by), move_of(1, by + self.beside)]
    }

    pub(super) fn form(&self) -> Form {
        let level = |c: Real| c.abs() <= self.scale.shl(-20);
        match self.curvatures {
            [a, _] if level(a) => Form::Flat,
            [_, b] if level(b) => Form::Ridge,
            [a, b] if a.is_negative() == b.is_negative() => Form::Definite,
            _ => Form::Saddle,
        }
    }

    /// The directions of the four arms of a saddle: ±, along which xᵀHx = 0.
    pub(super) fn arms(&self) -> [V3; 4] {
        let [a, b] = self.curvatures.map(Real::abs);
        let (x, y) = (self.axes[0] * (b / (a + b)).sqrt(), self.axes[1] * (a / (a + b)).sqrt());
        [x + y, x - y, -(x + y), y - x]
    }

    /// The point halfway between the surfaces.
    pub(super) fn point(&self) -> [i64; 3] {
        middle(self.jets[0].point, self.jets[1].point)
    }

    /// The contact as a spot; its tangent is the axis of the smaller curvature.
    pub(super) fn spot(&self, pair: &Pair<'_>) -> Spot {
        let mut spot = pair.spot(self.at, &self.jets);
        spot.tangent = self.axes[1];
        spot.rates = both!(|s| pull_back(&self.jets[s].first, self.jets[s].normal(), spot.tangent));
        spot
    }

    /// Parameters of a patch a unit along a direction.
    pub(super) fn rates(&self, direction: V3) -> [[Real; 2]; 2] {
        both!(|s| pull_back(&self.jets[s].first, self.jets[s].normal(), direction))
    }
}

impl Pair<'_> {
    /// Moves a contact to the critical point near a place, no farther than `within` from there.
    #[inline(never)]
    pub(super) fn critical(&self, contact: &mut Contact, at: Places, within: Real) -> Option<()> {
        contact.move_to(self, at)?;
        let mut travelled = Real::ZERO;
        for _ in 0..LIMIT {
            let reach = contact.reach();
            if reach <= self.extent.shl(-30) {
                return contact.move_to(self, contact.stepped(contact.steps));
            }
            travelled = travelled + reach;
            if travelled > within {
                return None;
            }
            contact.move_to(self, contact.stepped(contact.steps))?;
        }
        None
    }

    /// The point of a tangential curve in the plane through `c` with normal `plane`, near `at`.
    #[inline(never)]
    pub(super) fn on_ridge(&self, at: Places, c: [i64; 3], plane: V3) -> Option<Spot> {
        let mut contact = Contact::BLANK;
        contact.move_to(self, at)?;
        for _ in 0..LIMIT {
            let off = plane.dot(difference(c, contact.jets[0].point));
            let across = plane.dot(contact.axes[1]);
            if across.square() < Real::power(-6) || contact.form() == Form::Flat {
                return None;
            }
            let x = contact.steps[0];
            let y = (off - x * plane.dot(contact.axes[0])) / across;
            let reach = x.abs().max(y.abs()).max(contact.beside.norm());
            if reach <= self.extent.shl(-34) {
                return (contact.apart.norm() <= self.touching()).then(|| contact.spot(self));
            }
            contact.move_to(self, contact.stepped([x, y]))?;
        }
        None
    }

    /// The distance at which surfaces with parallel normals count as touching.
    pub(super) fn touching(&self) -> Real {
        self.accept.shl(3)
    }

    /// A place of one patch near a point of it that was followed along a direction.
    pub(super) fn followed(at: Places, rates: &[[Real; 2]; 2], by: Real) -> [Place; 2] {
        both!(|s| shifted(at[s], rates[s].map(|r| r * by)))
    }
}
