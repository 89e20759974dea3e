//! Where a curve meets a surface: all points, each as what it is.

use super::line::Line;
use super::newton::{Pair, Spot};
use super::part::{Part, Region};
use super::roots;
use super::sheet::{Homogeneous, ONE, Place, Sheet, in_rooms};
use super::{Buffer, I2F30, I16F48, I20F44, IntersectError, Side};
use crate::geometry::{Point3, Vector3};
use crate::num::Real;
use crate::patch::{CurveNet, RationalCurveNet, SurfaceNet};

/// A curve in space that can be cut with a surface, of degree 1 to 8.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum SpaceCurve<'a> {
    /// A polynomial Bézier curve.
    Polynomial(CurveNet<'a>),
    /// A rational Bézier curve.
    Rational(RationalCurveNet<'a>),
    /// An iso-parametric curve of a patch.
    Iso(IsoCurve<'a>),
}

impl<'a> From<CurveNet<'a>> for SpaceCurve<'a> {
    fn from(net: CurveNet<'a>) -> Self {
        Self::Polynomial(net)
    }
}

impl<'a> From<RationalCurveNet<'a>> for SpaceCurve<'a> {
    fn from(net: RationalCurveNet<'a>) -> Self {
        Self::Rational(net)
    }
}

impl<'a> From<IsoCurve<'a>> for SpaceCurve<'a> {
    fn from(curve: IsoCurve<'a>) -> Self {
        Self::Iso(curve)
    }
}

/// Which parameter of a patch is held.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Held {
    /// The first: u of a triangle, r of a tensor-product patch.
    First,
    /// The second: v of a triangle, s of a tensor-product patch.
    Second,
    /// The third of a triangle, w.
    Third,
}

/// The curve on a patch along which one parameter is held.
///
/// Its own parameter t is the other one of a tensor-product patch. On a triangle it runs over the whole curve: with u held,
/// v = t (1 − u); with v held, u = t (1 − v); with w held, u = t (1 − w).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct IsoCurve<'a> {
    net: SurfaceNet<'a>,
    held: Held,
    at: i64,
}

impl<'a> IsoCurve<'a> {
    /// The curve of a patch on which a parameter has the value `at`, 0 ..= 1; exact to 2^-42 unit.
    ///
    /// # Errors
    /// [`IntersectError::Parameter`] for a value outside 0 ..= 1, for 1 on a triangle, where the curve is a point, and for the
    /// third parameter of a tensor-product patch.
    ///
    /// # Examples
    /// ```
    /// use embedded_surfaces::intersect::{Hit, Held, I16F48, IsoCurve, curve_points};
    /// use embedded_surfaces::patch::{BilinearPatch, Surface};
    ///
    /// let roof = BilinearPatch::from_ints([[[0, 0, 0], [0, 60, 0]], [[80, 0, 40], [80, 60, 40]]])?;
    /// let wall = BilinearPatch::from_ints([[[-9, 45, -9], [-9, 45, 99]], [[99, 45, -9], [99, 45, 99]]])?;
    /// let across = IsoCurve::new(roof.surface(), Held::First, I16F48::from_num(1) / 4)?;
    /// let mut points = [Hit::BLANK; 2];
    /// let hits = curve_points(across, wall.surface(), &mut points)?;
    /// let [hit] = hits.points() else { panic!() };
    /// assert_eq!((hit.t.to_bits(), hit.position.z.to_num::<i32>()), (3 << 46, 10));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub const fn new(net: SurfaceNet<'a>, held: Held, at: I16F48) -> Result<Self, IntersectError> {
        let (bits, triangle) = (at.to_bits(), net.is_triangle());
        let beyond = bits < 0 || bits > ONE || (triangle && bits == ONE);
        if beyond || (!triangle && matches!(held, Held::Third)) {
            return Err(IntersectError::Parameter { bits });
        }
        Ok(Self { net, held, at: bits })
    }

    /// The places of the ends.
    const fn ends(&self) -> [Place; 2] {
        let rest = if self.net.is_triangle() { ONE - self.at } else { ONE };
        match self.held {
            Held::First => [[self.at, 0], [self.at, rest]],
            Held::Second => [[0, self.at], [rest, self.at]],
            Held::Third => [[0, rest], [rest, 0]],
        }
    }
}

impl<'a> SpaceCurve<'a> {
    /// The curve as a net of degrees (n, 0).
    fn sheet(self, room: &'a mut [Homogeneous]) -> Sheet<'a> {
        match self {
            Self::Polynomial(net) => Sheet::line(net, None, room),
            Self::Rational(net) => Sheet::line(net.control_net(), Some(net), room),
            Self::Iso(iso) => Sheet::cut(iso.net, iso.ends(), room),
        }
    }

    /// Control points of what it is made of.
    fn points(&self) -> usize {
        match self {
            Self::Polynomial(net) => net.points().len(),
            Self::Rational(net) => net.control_net().points().len(),
            Self::Iso(iso) => iso.net.points().len(),
        }
    }
}

/// What happens where a curve meets a surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum HitKind {
    /// The curve passes through the surface, at an angle.
    Crossing,
    /// The curve is parallel to the surface: it touches it, crosses it in a multiple root, or crosses it several times
    /// closer together than the arithmetic resolves.
    Touching,
    /// From here on the curve lies on the surface.
    Begin,
    /// Up to here the curve lay on the surface.
    End,
}

/// A point of a curve on a surface. 96 bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Hit {
    /// What happens there.
    pub kind: HitKind,
    /// The curve's parameter, 0 ..= 1.
    pub t: I16F48,
    /// The surface's parameters: (u, v) of a triangle with w = 1 − u − v, (r, s) of a tensor-product patch.
    pub parameters: [I16F48; 2],
    /// The point, halfway between the curve's and the surface's.
    pub position: Point3<I20F44>,
    /// The curve's unit tangent.
    pub tangent: Vector3<I2F30>,
    /// The sine of the angle between the curve and the surface; positive where it passes to the side of the normal Su × Sv.
    pub sine: I2F30,
    /// The distance of the curve's point from the surface's.
    pub residual: I20F44,
}

impl Hit {
    /// No point, to fill buffers with.
    pub const BLANK: Self = Self {
        kind: HitKind::Crossing,
        t: I16F48::ZERO,
        parameters: [I16F48::ZERO; 2],
        position: Point3::new(I20F44::ZERO, I20F44::ZERO, I20F44::ZERO),
        tangent: Vector3::new(I2F30::ZERO, I2F30::ZERO, I2F30::ZERO),
        sine: I2F30::ZERO,
        residual: I20F44::ZERO,
    };

    fn new(pair: &Pair<'_>, spot: &Spot, kind: HitKind) -> Self {
        let unit = |c: Real| I2F30::from_bits(c.nearest(30).clamp(-1 << 30, 1 << 30) as i32);
        let [line, surface] = &pair.sheets;
        let tangent = line.eval(spot.at[0], 1).map_or(spot.tangent, |jet| jet.first[0].unit());
        let normal = surface.eval(spot.at[1], 1).map(|jet| jet.normal().unit());
        Self {
            kind,
            t: I16F48::from_bits(spot.at[0][0]),
            parameters: spot.at[1].map(I16F48::from_bits),
            position: Point3::from_array(spot.point.map(I20F44::from_bits)),
            tangent: Vector3::from_array(tangent.0.map(unit)),
            sine: unit(normal.map_or(Real::ZERO, |n| n.dot(tangent))),
            residual: I20F44::from_bits(spot.residual.nearest(44)),
        }
    }

    /// Whether both are the same crossing: no two are as near, since where one was shown to be alone it is so farther around.
    fn is_near(&self, other: &Self) -> bool {
        let close = |a: I16F48, b: I16F48| (a.to_bits() - b.to_bits()).abs() <= 1 << 19;
        let [[a, b], [c, d]] = [self.parameters, other.parameters];
        close(self.t, other.t) && close(a, c) && close(b, d)
    }
}

/// The points in which a curve meets a surface, and what is certain about them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Hits<'b> {
    points: &'b [Hit],
    /// Parts of the curve about which nothing certain can be said: one for each touching point, and one for each part that is
    /// nearly parallel and so near that neither a point nor its absence can be shown.
    pub undecided: u32,
}

impl<'b> Hits<'b> {
    /// The points, in the order of t.
    #[must_use]
    pub const fn points(&self) -> &'b [Hit] {
        self.points
    }

    /// Whether the points are proved to be all.
    #[must_use]
    pub const fn is_certified(&self) -> bool {
        self.undecided == 0
    }
}

/// Pairs of parts that are looked at.
const PAIRS: u32 = 1 << 14;

/// All points where a curve meets a surface, in the order of the curve's parameter.
///
/// Curves are polynomial or rational of degree 1 to 8, or iso-parametric curves of a patch ([`IsoCurve`]); surfaces are nets of
/// any kind. Curve and surface are halved until a plane lies between their hulls or a cone of tangents and a cone of normals
/// show that they meet once at most; there Newton's method finds the point in three unknowns. So no crossing is missed, and
/// none comes twice. Where the curve touches the surface, or lies on it, no finite precision can decide; such places come as
/// [`HitKind::Touching`], or [`HitKind::Begin`] and [`HitKind::End`], and what is not explained by those is counted in
/// [`Hits::undecided`]. A part on the surface shorter than 2^-10 of the curve comes as a touch.
///
/// Points lie within 2^-36 unit of curve and surface, or 2^-46 of the longest side of their boxes if that is more. A few
/// microseconds a crossing on a host; at most 16384 pairs of parts are looked at, what is left then is undecided. Stack: 27 KB.
///
/// Sources: Sederberg and Meyers 1988 (cones), Dowell and Jarratt 1971 (touching points).
///
/// # Errors
/// [`IntersectError::Buffer`] for more points than there is room for, [`IntersectError::DegenerateCurve`] for a curve that is a
/// point, [`IntersectError::DegeneratePatch`] for a patch that is a point or a curve.
///
/// # Examples
/// ```
/// use embedded_surfaces::intersect::{Hit, HitKind, curve_points};
/// use embedded_surfaces::num::I16F16;
/// use embedded_surfaces::patch::{BilinearPatch, Curve, QuadraticCurve, RationalCurve, Surface};
///
/// let floor = BilinearPatch::from_ints([[[0, 0, 0], [0, 60, 0]], [[80, 0, 0], [80, 60, 0]]])?;
/// let line = Curve::<2>::from_ints([[20, 20, -10], [40, 40, 10]])?;
/// let mut points = [Hit::BLANK; 4];
/// let hits = curve_points(line.net(), floor.surface(), &mut points)?;
/// assert_eq!((hits.points().len(), hits.points()[0].position.x.to_num::<i32>()), (1, 30));
/// assert!(hits.is_certified() && hits.points()[0].sine > 0);
///
/// // A quarter circle of radius 50 over the floor, from 30 below to 20 above: 3-4-5.
/// let net = QuadraticCurve::from_ints([[60, 30, -30], [60, 30, 20], [10, 30, 20]])?;
/// let arc = RationalCurve::new(net, [1, 1, 2].map(I16F16::from_num))?;
/// let hits = curve_points(arc.net(), floor.surface(), &mut points)?;
/// assert_eq!((hits.points().len(), hits.points()[0].position.x.to_num::<i32>()), (1, 50));
///
/// // A parabola that touches the floor: found, and not certain.
/// let bow = Curve::<3>::from_ints([[20, 20, 10], [30, 30, -10], [40, 40, 10]])?;
/// let hits = curve_points(bow.net(), floor.surface(), &mut points)?;
/// assert_eq!((hits.points()[0].kind, hits.undecided), (HitKind::Touching, 1));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn curve_points<'a, 'b>(
    curve: impl Into<SpaceCurve<'a>>,
    net: SurfaceNet<'_>,
    out: &'b mut [Hit],
) -> Result<Hits<'b>, IntersectError> {
    let curve: SpaceCurve<'_> = curve.into();
    in_rooms(net.points().len().max(curve.points()), |[one, two]| {
        meet(Pair::of([curve.sheet(one), Sheet::new(net, two)]), out)
    })
}

#[inline(never)]
fn meet<'b>(pair: Pair<'_>, out: &'b mut [Hit]) -> Result<Hits<'b>, IntersectError> {
    let [line, surface] = &pair.sheets;
    if line.is_point() {
        return Err(IntersectError::DegenerateCurve);
    }
    if !surface.has_normal() {
        return Err(IntersectError::DegeneratePatch { side: Side::B });
    }
    let mut used = 0;
    let mut enter = |hit: Hit| {
        if out.iter().take(used).any(|known| known.is_near(&hit)) {
            return Ok(());
        }
        let given = out.len();
        let full = IntersectError::Buffer { buffer: Buffer::Points, needed: used + 1, given };
        *out.get_mut(used).ok_or(full)? = hit;
        used += 1;
        Ok(())
    };
    // The curve is the edge v = 0 of its net of degrees (n, 0).
    let edge = Line::edge(line, 0, 2);
    let found = in_rooms(pair.most_points(), |rooms| {
        roots::find(&pair, edge, Region::ROOT, PAIRS, &mut rooms.map(Part::new), &mut |spot, touching| {
            enter(Hit::new(&pair, spot, if touching { HitKind::Touching } else { HitKind::Crossing }))
        })
    })?;
    let mut undecided = found.undecided.saturating_add(found.touching);
    for part in found.parts.into_iter().flatten() {
        match part.ends(&pair, &edge) {
            Some([begin, end]) => {
                enter(Hit::new(&pair, &begin, HitKind::Begin))?;
                enter(Hit::new(&pair, &end, HitKind::End))?;
            }
            None => undecided = undecided.saturating_add(1),
        }
    }
    let points = out.get_mut(..used).unwrap_or(&mut []);
    sort(points);
    Ok(Hits { points, undecided })
}

/// In the order of t: few points, by insertion.
fn sort(points: &mut [Hit]) {
    for i in 1..points.len() {
        for j in (1..=i).rev() {
            if let Some([a, b]) = points.get_mut(j - 1..=j)
                && b.t < a.t
            {
                core::mem::swap(a, b);
            }
        }
    }
}

#[cfg(feature = "defmt")]
mod format {
    use super::{Hit, Hits, I20F44, IsoCurve, SpaceCurve};
    use defmt::{Format, Formatter, write};

    impl Format for Hit {
        fn format(&self, f: Formatter<'_>) {
            let [u, v] = self.parameters.map(|p| p.to_bits());
            let p = self.position.to_array().map(I20F44::to_bits);
            write!(f, "{} at {}/2^48, {} {}/2^48: {}/2^44", self.kind, self.t.to_bits(), u, v, p);
        }
    }

    impl Format for Hits<'_> {
        fn format(&self, f: Formatter<'_>) {
            write!(f, "{} points, {} undecided", self.points.len(), self.undecided);
        }
    }

    impl Format for IsoCurve<'_> {
        fn format(&self, f: Formatter<'_>) {
            write!(f, "{} parameter at {}/2^48", self.held, self.at);
        }
    }

    impl Format for SpaceCurve<'_> {
        fn format(&self, f: Formatter<'_>) {
            match self {
                Self::Polynomial(net) => net.format(f),
                Self::Rational(net) => net.format(f),
                Self::Iso(iso) => iso.format(f),
            }
        }
    }
}

const _: () = assert!(size_of::<Hit>() <= 96);
