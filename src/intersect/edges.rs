//! Edges that lie on the other patch: shared edges, edges on a surface, borders of regions where the surfaces coincide.
//!
//! An edge is looked at before anything else: on it the surfaces meet in no point that a mesh could find reliably. Shared
//! edges are found by exact comparison of control points; of all others the points on the other patch, and the parts on it, by
//! halving, with proof (`roots`). Crossings are set aside until it is known which curves end there.

use super::IntersectError;
use super::curve::{Curve, CurveKind, CurvePoint};
use super::hermite::Piece;
use super::line::Line;
use super::newton::{Pair, Places, Spot, difference};
use super::part::{Part, Region};
use super::roots::{self, Lying};
use super::sheet::in_rooms;
use super::sheet::{ONE, Place, Sheet};
use super::trace::{Locus, Output, Tracer};
use crate::geometry::Point3;
use crate::num::{Coord, I16F16, Real};
use crate::patch::{MAX_DEGREE, triangle_index};

/// Parts of edges on a surface that are kept at most: 7 or 8 edges, a few parts each.
const MOST: usize = 12;
/// The largest sine of an angle that counts as none along a curve.
const PARALLEL: Real = Real::power(-17);

/// A control point of an edge with its weight.
type EdgePoint = (Point3<I16F16>, i32);

/// A part of an edge on the other patch.
#[derive(Clone, Copy, Debug)]
struct OnSurface {
    side: usize,
    edge: usize,
    /// The places and points of its ends; spots would take twice as much.
    ends: [Places; 2],
    points: [[i64; 3]; 2],
    /// Whether tangent planes agree at the ends and in the middle.
    tangential: bool,
    shared: bool,
    used: bool,
}

impl OnSurface {
    /// The spots of its ends, with tangents along the rising parameter.
    fn spots(&self, pair: &Pair<'_>) -> Option<[Spot; 2]> {
        let [a, b] = self.ends;
        Some([pair.place_on_edge(self.side, self.edge, a)?, pair.place_on_edge(self.side, self.edge, b)?])
    }

    /// A part with its ends, and two spots between them.
    fn new((side, edge): (usize, usize), ends: &[Spot; 2], between: &[Spot; 2], shared: bool) -> Self {
        let tangential = ends.iter().chain(between).all(|s| s.sine <= PARALLEL);
        let (at, points) = (both!(|k| ends[k].at), both!(|k| ends[k].point));
        Self { side, edge, ends: at, points, tangential, shared, used: false }
    }
}

impl Sheet<'_> {
    /// Where control point `k` of an edge stands, in the direction of its parameter.
    pub(super) fn edge_index(&self, edge: usize, k: usize) -> Option<usize> {
        let (m, h) = self.degrees;
        Some(match (self.triangle, edge) {
            (true, 0) => triangle_index(k, m.checked_sub(k)?),
            (true, 1) => triangle_index(0, m.checked_sub(k)?),
            (true, _) => triangle_index(m.checked_sub(k)?, 0),
            (false, 0) => k,
            (false, 1) => m * (h + 1) + k,
            (false, 2) => k * (h + 1),
            (false, _) => k * (h + 1) + h,
        })
    }

    /// Control point `k` of an edge with its weight.
    fn edge_point(&self, edge: usize, k: usize) -> Option<EdgePoint> {
        let at = self.edge_index(edge, k)?;
        let weight = self.source.weights().map_or(Some(1), |w| Some(w.get(at)?.to_bits()))?;
        Some((*self.source.points().get(at)?, weight))
    }

    pub(super) fn edge_degree(&self, edge: usize) -> usize {
        if self.triangle || edge >= 2 { self.degrees.0 } else { self.degrees.1 }
    }
}

/// Whether two edges have the same control points, in the same direction or in opposite ones; weights up to a factor.
fn are_equal(a: &Sheet<'_>, edge_a: usize, b: &Sheet<'_>, edge_b: usize, reversed: bool) -> bool {
    let n = a.edge_degree(edge_a);
    if n != b.edge_degree(edge_b) || n > MAX_DEGREE {
        return false;
    }
    let pairs = |k: usize| Some((a.edge_point(edge_a, k)?, b.edge_point(edge_b, if reversed { n - k } else { k })?));
    let Some((first_a, first_b)) = pairs(0) else { return false };
    (0..=n).all(|k| {
        pairs(k).is_some_and(|((p, w), (q, x))| {
            p == q && i64::from(w) * i64::from(first_b.1) == i64::from(x) * i64::from(first_a.1)
        })
    })
}

/// Parts of edges that lie on the other patch.
struct Parts {
    list: [Option<OnSurface>; MOST],
    count: usize,
}

impl Parts {
    fn get(&self, k: usize) -> Option<OnSurface> {
        *self.list.get(k)?
    }

    /// Adds a part unless it is one of the other patch's; `centre` is the spot in its middle.
    fn enter(&mut self, pair: &Pair<'_>, part: OnSurface, centre: &Spot) {
        let [low, high] = part.points;
        let near = |a: [i64; 3], b: [i64; 3]| difference(a, b).norm() <= pair.extent.shl(-26);
        let known = self.list.iter().flatten().any(|p| {
            let [a, b] = p.points;
            let same = (near(a, low) && near(b, high)) || (near(a, high) && near(b, low));
            same && p.side != part.side
                && pair.sheets[p.side & 1].edge_at(centre.at[p.side & 1], 1 << 20) == Some(p.edge as u8)
        });
        if known {
            return;
        }
        if let Some(place) = self.list.get_mut(self.count) {
            *place = Some(part);
            self.count += 1;
        }
    }
}

/// What was found before any mesh.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Edges {
    /// A region where the surfaces coincide.
    pub(super) overlap: bool,
    /// More parts than there is room for, or a border of tangential edges that does not enclose a region.
    pub(super) undecided: u32,
}

/// Finds and writes all of them.
#[inline(never)]
pub(super) fn find(
    pair: &Pair<'_>,
    budget: u32,
    tolerance: Real,
    out: &mut Output<'_>,
) -> Result<Edges, IntersectError> {
    let mut parts = Parts { list: [None; MOST], count: 0 };
    let undecided =
        in_rooms(pair.most_points(), |rooms| collect_all(pair, budget, rooms.map(Part::new), &mut parts, out))?;
    let mut found = Edges { overlap: false, undecided: undecided + u32::from(parts.count == MOST) };
    found.overlap = regions(pair, tolerance, &mut parts, out)?;
    for part in parts.list.iter().flatten().filter(|part| !part.used) {
        let first = out.used;
        run(pair, tolerance, part, false, out)?;
        let kind = match (part.shared, part.tangential) {
            (true, true) => CurveKind::SharedEdgeTangential,
            (true, false) => CurveKind::SharedEdge,
            _ => CurveKind::EdgeOnSurface,
        };
        let ends = part.ends.map(|at| pair.end(at));
        out.finish(kind, false, ends, first)?;
    }
    Ok(found)
}

/// Adds the parts of all edges; what stays undecided.
#[inline(never)]
fn collect_all(
    pair: &Pair<'_>,
    budget: u32,
    mut halves: [Part<'_>; 2],
    parts: &mut Parts,
    out: &mut Output<'_>,
) -> Result<u32, IntersectError> {
    let mut undecided = 0_u32;
    for side in 0..2 {
        halves[1].region = None;
        for edge in 0..pair.sheets[side & 1].edge_count() {
            undecided = undecided.saturating_add(collect(pair, (side, edge), budget, &mut halves, parts, out)?);
        }
    }
    Ok(undecided)
}

/// Adds the parts of one edge, and sets its other points on the surface aside; what stays undecided.
#[inline(never)]
fn collect(
    pair: &Pair<'_>,
    (side, edge): (usize, usize),
    budget: u32,
    halves: &mut [Part<'_>; 2],
    parts: &mut Parts,
    out: &mut Output<'_>,
) -> Result<u32, IntersectError> {
    let sheet = &pair.sheets[side & 1];
    if is_point(sheet, edge) {
        return Ok(0);
    }
    if collect_shared(pair, (side, edge), parts) {
        return Ok(0);
    }
    let line = Line::edge(sheet, side, edge);
    let roots = roots::find(pair, line, Region::ROOT, budget, halves, &mut |spot, _| out.set_aside(spot))?;
    let mut undecided = roots.undecided.saturating_add(roots.touching);
    for part in roots.parts.iter().flatten() {
        undecided = undecided.saturating_add(u32::from(!collect_lying(pair, &line, edge, part, parts)));
    }
    Ok(undecided)
}

/// Whether an edge is degenerate.
fn is_point(sheet: &Sheet<'_>, edge: usize) -> bool {
    let [low, middle, high] = [0, ONE / 2, ONE].map(|t| sheet.eval(sheet.edge_place(edge, t), 0).map(|jet| jet.point));
    low == middle && middle == high
}

/// Adds an edge that the other patch has, too; whether it does.
#[inline(never)]
fn collect_shared(pair: &Pair<'_>, (side, edge): (usize, usize), parts: &mut Parts) -> bool {
    let (sheet, other) = (&pair.sheets[side & 1], &pair.sheets[(1 - side) & 1]);
    let shared_with = (0..other.edge_count()).find_map(|e| {
        let reversed = |r: &bool| are_equal(sheet, edge, other, e, *r);
        [false, true].into_iter().find(reversed).map(|r| (e, r))
    });
    let Some((e, reversed)) = shared_with else { return false };
    let spot = |t: i64| pair.shared_spot(side, edge, t, other.edge_place(e, if reversed { ONE - t } else { t }));
    let spots = [0, ONE / 2, ONE, ONE / 4].map(spot);
    if let [Some(low), Some(centre), Some(high), Some(quarter)] = spots {
        parts.enter(pair, OnSurface::new((side, edge), &[low, high], &[centre, quarter], true), &centre);
    }
    true
}

/// Adds a part of an edge that lies on the other patch; false if its ends cannot be told.
#[inline(never)]
fn collect_lying(pair: &Pair<'_>, line: &Line, edge: usize, part: &Lying, parts: &mut Parts) -> bool {
    let inner = [2, 1].map(|k| part.spot(pair, line, part.range[0] + (part.range[1] - part.range[0]) / 4 * k));
    let (Some(ends), [Some(centre), Some(quarter)]) = (part.ends(pair, line), inner) else { return false };
    parts.enter(pair, OnSurface::new((line.side, edge), &ends, &[centre, quarter], false), &centre);
    true
}

impl Pair<'_> {
    /// The spot of a shared edge, whose place on the other patch is known.
    #[inline(never)]
    fn shared_spot(&self, side: usize, edge: usize, parameter: i64, place: Place) -> Option<Spot> {
        let own = self.sheets[side & 1].edge_place(edge, parameter);
        let at = if side == 0 { [own, place] } else { [place, own] };
        self.place_on_edge(side, edge, at)
    }

    /// The spot at a place on an edge, whose tangent is the edge's.
    #[inline(never)]
    fn place_on_edge(&self, side: usize, edge: usize, at: Places) -> Option<Spot> {
        let jets = self.jets(at, 1)?;
        let mut spot = self.spot(at, &jets);
        let [a, b] = self.sheets[side & 1].edge_direction(edge).map(Real::int);
        spot.tangent = (jets[side & 1].first[0] * a + jets[side & 1].first[1] * b).unit();
        spot.rates = both!(|s| super::newton::pull_back(&jets[s].first, jets[s].normal(), spot.tangent));
        Some(spot)
    }
}

/// Emits a part from its first point, or from its last one, backwards.
#[inline(never)]
fn run(
    pair: &Pair<'_>,
    tolerance: Real,
    part: &OnSurface,
    backwards: bool,
    out: &mut Output<'_>,
) -> Result<(), IntersectError> {
    let Some(ends) = part.spots(pair) else { return Err(IntersectError::Internal) };
    let locus = Locus::Edge { side: part.side, edge: part.edge };
    let tracer = Tracer { pair, locus, forward: true, tolerance };
    let [a, b] = if backwards { [ends[1].oriented(false), ends[0].oriented(false)] } else { ends };
    out.emit(&a)?;
    // Eight pieces at first: a chord says little about a long edge.
    let sheet = &pair.sheets[part.side & 1];
    let [low, high] = [a, b].map(|s| sheet.edge_parameter(part.edge, s.at[part.side & 1]));
    let mut from = a;
    for k in 1..=8 {
        let near = from.at[(1 - part.side) & 1];
        let next = if k == 8 {
            Some(b)
        } else {
            let spot = pair.edge_spot(part.side, part.edge, low + (high - low) / 8 * k, near);
            spot.map(|s| s.oriented(!backwards))
        };
        let Some(next) = next else { continue };
        tracer.connect(out, &from, &next, true)?;
        from = next;
    }
    Ok(())
}

/// Joins tangential parts that close to the border of a region where the surfaces coincide.
#[inline(never)]
fn regions(pair: &Pair<'_>, tolerance: Real, parts: &mut Parts, out: &mut Output<'_>) -> Result<bool, IntersectError> {
    let near = |a: [i64; 3], b: [i64; 3]| difference(a, b).norm() <= pair.extent.shl(-24);
    let mut any = false;
    for start in 0..parts.count {
        let mut order = [(0, false); MOST];
        let Some(first) = parts.get(start).filter(|p| p.tangential && !p.used) else { continue };
        let (mut length, mut end) = (1, first.points[1]);
        order[0] = (start, false);
        while !near(end, first.points[0]) && length < MOST {
            let next = (0..parts.count).find_map(|k| {
                let part = parts.get(k).filter(|p| p.tangential && !p.used)?;
                if order.iter().take(length).any(|(used, _)| *used == k) {
                    return None;
                }
                let [a, b] = part.points;
                if near(a, end) { Some((k, false, b)) } else { near(b, end).then_some((k, true, a)) }
            });
            let Some((k, backwards, other)) = next else { break };
            if let Some(place) = order.get_mut(length) {
                *place = (k, backwards);
            }
            length += 1;
            end = other;
        }
        if length < 2 || !near(end, first.points[0]) {
            continue;
        }
        let (begin, unrefined) = (out.used, out.unrefined);
        for (k, backwards) in order.iter().take(length) {
            let Some(part) = parts.get(*k) else { continue };
            // A corner of the border has the tangent of the part that begins.
            run(pair, tolerance, &shortened(pair, &part, *backwards), *backwards, out)?;
        }
        if encloses(pair, out.points.get(begin..out.used).unwrap_or(&[])) {
            out.finish(CurveKind::OverlapRegion, true, [super::End::None; 2], begin)?;
            for (k, _) in order.iter().take(length) {
                if let Some(Some(part)) = parts.list.get_mut(*k) {
                    part.used = true;
                }
            }
            any = true;
        } else {
            (out.used, out.unrefined) = (begin, unrefined);
        }
    }
    Ok(any)
}

/// A part that ends 2^-34 of an edge early, so that a corner has a point for either of its tangents.
#[inline(never)]
fn shortened(pair: &Pair<'_>, part: &OnSurface, backwards: bool) -> OnSurface {
    let sheet = &pair.sheets[part.side & 1];
    let last = usize::from(!backwards);
    let end = part.ends[last & 1];
    let parameter =
        sheet.edge_parameter(part.edge, end[part.side & 1]) + if backwards { ONE >> 34 } else { -(ONE >> 34) };
    let mut out = *part;
    if let Some(spot) = pair.edge_spot(part.side, part.edge, parameter, end[(1 - part.side) & 1]) {
        (out.ends[last & 1], out.points[last & 1]) = (spot.at, spot.point);
    }
    out
}

/// Whether points amid a closed border lie on both surfaces.
#[inline(never)]
fn encloses(pair: &Pair<'_>, border: &[CurvePoint]) -> bool {
    let share = Real::ONE / Real::int(border.len().max(1) as i64);
    let mut sums = [Real::ZERO; 4];
    for p in border {
        for (sum, c) in sums.iter_mut().zip(p.places().as_flattened()) {
            *sum = *sum + Real::new(*c, -48);
        }
    }
    let [u, v, s, t] = sums.map(|sum| (sum * share).nearest(48));
    let centre: [Place; 2] = [[u, v], [s, t]];
    let coincide = |place: Place, near: Place| {
        let Some(jet) = pair.sheets[0].eval(place, 1) else { return false };
        let Some((_, under)) = pair.foot(1, near, jet.point) else { return false };
        difference(jet.point, under.point).norm() <= pair.touching()
    };
    // Between the centre and points of the border.
    let towards = (0..4).filter_map(|k| border.get(border.len() * k / 4)).map(|p| p.places());
    coincide(centre[0], centre[1])
        && towards.into_iter().all(|p| {
            let [a, b] = both!(|s| super::trace::middle_place(centre[s], p[s]));
            coincide(a, b)
        })
}

impl Output<'_> {
    /// Ends the curve whose points begin at `first`: measures it and enters it in the list.
    #[inline(never)]
    pub(super) fn finish(
        &mut self,
        kind: CurveKind,
        closed: bool,
        ends: [super::End; 2],
        first: usize,
    ) -> Result<(), IntersectError> {
        use fixed::types::{I2F30, I20F44};
        let points = self.points.get(first..self.used).unwrap_or(&[]);
        let mut length = Real::ZERO;
        let pieces = points.windows(2).map(|w| (w[0], w[1]));
        let last = points.last().zip(points.first()).filter(|_| closed && points.len() > 1);
        for (p, q) in pieces.chain(last.map(|(p, q)| (*p, *q))) {
            if p.bits() != q.bits() {
                length = length + Piece::through(p.bits(), p.direction(), q.bits(), q.direction()).arc_length();
            }
        }
        let curve = Curve {
            kind,
            closed,
            ends,
            first,
            count: self.used - first,
            length: I20F44::from_bits(length.nearest(44)),
            min_sine: points.iter().fold(I2F30::ONE, |least, p| least.min(p.sine)),
            residual: points.iter().fold(I20F44::ZERO, |most, p| most.max(p.residual)),
            unrefined: self.unrefined,
        };
        self.unrefined = 0;
        let given = self.curves.len();
        let full = IntersectError::Buffer { buffer: super::Buffer::Curves, needed: given + 1, given };
        *self.curves.get_mut(self.curve_count).ok_or(full)? = curve;
        self.curve_count += 1;
        Ok(())
    }
}

const _: () = assert!(<I16F16 as Coord>::FRACTION_BITS == 16);
