//! Intersection of two surfaces: every curve in which they meet, refined, with parameters on both.
//!
//! In come two nets of any kind, polynomial or rational, triangular or tensor-product, of degrees 1 to 8; out go curves as
//! points with unit tangents, joined by cubic Hermite pieces, and branches, touching points, shared edges, regions where the
//! surfaces coincide, each as what it is. Promises:
//!
//! * Every point lies within [`Curve::residual`] of both surfaces, less than 10^-9 unit for patches up to a few thousand
//!   units across; every piece is within [`Options::tolerance`] of the curve, or counted in [`Curve::unrefined`].
//! * What cannot be decided is counted in [`Intersection::undecided`], never left out in silence.
//!   [`Intersection::is_certified`] says that nothing was, and then no curve is missing: no closed curve and no tangency lies in
//!   any pair of parts, all points are known where an edge meets the other patch and where a curve passes between parts, and a
//!   curve that is returned comes within eight tolerances of each. A tangency is never certified, only found: whether
//!   surfaces touch or miss each other by less than the arithmetic resolves is not decidable.
//! * The result does not depend on the order of the arguments; equal input gives equal bits on every target.
//!
//! # How
//! The paper (Tian Jie 1989) subdivides both surfaces, cuts facets, sorts segments into curves, and refines by Newton's method.
//! Here the facets are those of canonical integer grids, cut by exact predicates under a symbolic move of B, and chained by
//! the names of their crossings: no distance decides about topology. The chains are seeds and witnesses; curves are followed on
//! the surfaces themselves, and then every chain must be covered by curves.
//!
//! | file | comes in → goes out |
//! |---|---|
//! | `grid` | net → exact vertices at (i/2^m, j/2^m), rounded once; boxes over them |
//! | `descent`, `predicate`, `key`, `chain` | two grids → crossings, segments, chains |
//! | `sheet`, `newton` | net → points and derivatives; places near the curve → spots on it |
//! | `line`, `roots` | a curve and a surface → all points where they meet, parts on the surface |
//! | `edges` | edges on the other surface: shared edges, borders of regions, crossings |
//! | `part`, `certify`, `contact` | the loop-free test; points with collinear normals: touching points, branches, ridges |
//! | `trace`, `hermite`, `solve` | seeds → curves |
//! | `cells` | pairs of parts → where curves pass from one to the next |
//! | `plane`, `probe`, `hits` | [`section`]; [`project`]; [`curve_points`] |
//!
//! # What it needs
//! Everything is lent by the caller ([`Buffers`]). Bytes for two tensor-product patches; triangles take half the vertices:
//!
//! | depth | vertices | boxes of all levels | boxes to depth − 2 |
//! |---|---|---|---|
//! | 4 | 6 936 | 16 368 | 1 008 |
//! | 5 | 26 136 | 65 520 | 4 080 |
//! | 6 | 101 400 | 262 128 | 16 368 |
//! | 7 | 399 384 | 1 048 560 | 65 520 |
//!
//! A segment takes 24 bytes (two records, two links), a point 80, a curve 48, a branch 136 (on targets of 64 bits a curve 56).
//! Until curves are followed, each crossing of an edge takes a point too. Records to spare keep the pairs of parts of the
//! loop-free test, one each; with fewer than those the test runs again. A transversal curve from border to border takes some
//! 4·2^depth segments and, at the default tolerance, about a hundred points. Boxes below the levels that there is room for are
//! made of vertices again and again: to depth − 2 the descent takes about twice the time.
//!
//! The stack does not depend on the depth, but on the degrees. As measured at `opt-level = "s"` on a Cortex-M4: 18 KB for bicubic
//! patches that cross, 20 KB where they coincide in a region, 27 KB for patches of degrees (8, 8); up to 2 KB more on ARMv6-M.
//!
//! With boxes to depth − 2, room for 210 segments and 140 points, and the stack, depth 5 takes less than 64 KB of RAM; the
//! image, for size on a Cortex-M4, less than 132 KB of flash (`examples/fw_intersect.rs`). On targets of 32 bits operations on
//! wide numbers are calls, which products by halves and division by digits make short; the bits are the same everywhere.
//!
//! # What it does not do
//! More than two curves through one point (higher contacts), and cusps, are counted as undecided; curves end near them.
//! An edge that touches the other surface is undecided, and so is a part of an edge on it shorter than 2^-10 of the edge.
//! Two curves closer to each other than eight tolerances may count as one. In a pair with a region where the surfaces coincide
//! the loop-free test is left out.

/// `[body with k = 0, body with k = 1]`: indices are constants, whatever a compiler for size inlines.
macro_rules! both {
    (|$k:ident| $body:expr) => {
        [
            {
                let $k = 0_usize;
                $body
            },
            {
                let $k = 1_usize;
                $body
            },
        ]
    };
}

/// The same for three.
macro_rules! three {
    (|$k:ident| $body:expr) => {
        [
            {
                let $k = 0_usize;
                $body
            },
            {
                let $k = 1_usize;
                $body
            },
            {
                let $k = 2_usize;
                $body
            },
        ]
    };
}

mod cells;
mod certify;
mod chain;
mod contact;
mod curve;
mod descent;
mod edges;
mod error;
mod grid;
mod hermite;
mod hits;
mod key;
mod line;
mod newton;
mod part;
mod plane;
mod predicate;
mod probe;
mod roots;
mod sheet;
mod solve;
mod trace;
mod vector;

pub use curve::{Branch, Curve, CurveKind, CurvePoint, End, Side};
pub use error::{Buffer, IntersectError};
pub use fixed::types::{I2F30, I16F48, I20F44};
pub use grid::{GridBox, GridVertex};
pub use hits::{Held, Hit, HitKind, Hits, IsoCurve, SpaceCurve, curve_points};
pub use plane::{Plane, section};
pub use probe::{Projection, project};

use crate::num::{Coord, Real};
use crate::patch::SurfaceNet;
use cells::Cells;
use certify::Report;
use chain::{Chains, Signature};
use descent::Found;
use grid::{Grid, box_count, vertex_count};
use key::Crossing;
use newton::Pair;
use sheet::{Sheet, in_rooms};
use solve::Solver;
use trace::Output;

/// Pairs of parts of the loop-free test that are kept at a time where records leave no room for more.
const FEW: usize = 32;

/// Pairs of parts that are looked at to find all points of one edge on the other patch.
const EDGE_PAIRS: u32 = 1 << 12;

/// The least depth of a grid.
pub const MIN_DEPTH: u32 = 3;
/// The largest depth of a grid.
pub const MAX_DEPTH: u32 = 7;

/// How to intersect.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Options {
    /// Both grids have 2^depth cells a side, [`MIN_DEPTH`] ..= [`MAX_DEPTH`].
    pub depth: u32,
    /// What the cubic pieces between points may miss the curve by.
    pub tolerance: I20F44,
    /// Pairs of nodes that the descent may visit.
    pub pairs: u32,
    /// Pairs of parts that the loop-free test may visit; 0 leaves it out, and nothing is certified.
    pub certificate_pairs: u32,
}

impl Options {
    /// Depth 5, pieces within 2^-21 unit, 2^22 pairs of nodes, 2^15 pairs of parts.
    ///
    /// ```
    /// use embedded_surfaces::intersect::{I20F44, Options};
    /// let coarse = Options::DEFAULT.with_depth(4).with_tolerance(I20F44::from_num(1) / 100).with_budgets(1 << 16, 0);
    /// assert_eq!((coarse.depth, coarse.certificate_pairs, Options::DEFAULT.depth), (4, 0, 5));
    /// ```
    pub const DEFAULT: Self =
        Self { depth: 5, tolerance: I20F44::from_bits(1 << 23), pairs: 1 << 22, certificate_pairs: 1 << 15 };

    /// These options with another depth.
    #[must_use]
    pub const fn with_depth(self, depth: u32) -> Self {
        Self { depth, ..self }
    }

    /// These options with another tolerance.
    #[must_use]
    pub const fn with_tolerance(self, tolerance: I20F44) -> Self {
        Self { tolerance, ..self }
    }

    /// These options with other budgets: pairs of nodes for the descent, pairs of parts for the loop-free test.
    #[must_use]
    pub const fn with_budgets(self, pairs: u32, certificate_pairs: u32) -> Self {
        Self { pairs, certificate_pairs, ..self }
    }
}

impl Default for Options {
    fn default() -> Self {
        Self::DEFAULT
    }
}

/// What an intersection works in; all of it the caller's.
#[derive(Debug)]
pub struct Buffers<'b> {
    /// The vertices of both grids, [`Room::vertices`].
    pub vertices: &'b mut [GridVertex],
    /// Boxes over both grids: as many levels as there is room for, [`Room::boxes`] for all.
    pub boxes: &'b mut [GridBox],
    /// Two a segment in which the grids cross.
    pub records: &'b mut [u64],
    /// As many as records.
    pub links: &'b mut [u32],
    /// The points of all curves.
    pub points: &'b mut [CurvePoint],
    /// The curves.
    pub curves: &'b mut [Curve],
    /// The branches.
    pub branches: &'b mut [Branch],
}

/// The room that grids take.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub struct Room {
    /// Vertices of both grids, 12 bytes each.
    pub vertices: usize,
    /// Boxes of all levels of both pyramids, 24 bytes each. Less room costs time: boxes below the levels that it holds are
    /// made of vertices when they are needed.
    pub boxes: usize,
}

impl Room {
    /// The room for two nets at a depth.
    ///
    /// # Errors
    /// [`IntersectError::Depth`].
    ///
    /// # Examples
    /// ```
    /// use embedded_surfaces::{intersect::Room, patch::{BilinearPatch, Surface}};
    /// let floor = BilinearPatch::from_ints([[[0, 0, 0], [0, 60, 0]], [[80, 0, 0], [80, 60, 0]]])?;
    /// let room = Room::new(floor.surface(), floor.surface(), 5)?;
    /// assert_eq!((12 * room.vertices, 24 * room.boxes), (26_136, 65_520));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn new(a: SurfaceNet<'_>, b: SurfaceNet<'_>, depth: u32) -> Result<Self, IntersectError> {
        check_depth(depth)?;
        let vertices = [a, b].map(|net| vertex_count(net.is_triangle(), depth));
        Ok(Self { vertices: vertices[0] + vertices[1], boxes: 2 * box_count(depth) })
    }

    /// The room for a [`section`] of a net at a depth.
    ///
    /// # Errors
    /// [`IntersectError::Depth`].
    ///
    /// # Examples
    /// ```
    /// use embedded_surfaces::{intersect::Room, patch::{BilinearPatch, Surface}};
    /// let floor = BilinearPatch::from_ints([[[0, 0, 0], [0, 60, 0]], [[80, 0, 0], [80, 60, 0]]])?;
    /// assert_eq!(Room::of_section(floor.surface(), 5)?, Room::new(floor.surface(), floor.surface(), 5)?);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn of_section(net: SurfaceNet<'_>, depth: u32) -> Result<Self, IntersectError> {
        check_depth(depth)?;
        let vertices = [net.is_triangle(), false].map(|triangle| vertex_count(triangle, depth));
        Ok(Self { vertices: vertices[0] + vertices[1], boxes: 2 * box_count(depth) })
    }
}

/// The curves in which two surfaces meet, and what is certain about them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Intersection<'b> {
    points: &'b [CurvePoint],
    curves: &'b [Curve],
    branches: &'b [Branch],
    /// Parts, edges, chains and ends about which nothing certain can be said.
    pub undecided: u32,
    /// Predicates that were zero and decided by moving B by an infinitesimal.
    pub zero_predicates: u32,
    /// Whether moving B the other way leads to other chains: something is degenerate.
    pub perturbation_sensitive: bool,
    /// Triangles of the grids without a normal that were left out.
    pub degenerate_triangles: u32,
    /// Segments in which the grids cross.
    pub segments: usize,
    /// Whether the loop-free test ran.
    tested: bool,
}

impl<'b> Intersection<'b> {
    /// Of surfaces that are apart for certain.
    const EMPTY: Self = Self {
        points: &[],
        curves: &[],
        branches: &[],
        undecided: 0,
        zero_predicates: 0,
        perturbation_sensitive: false,
        degenerate_triangles: 0,
        segments: 0,
        tested: true,
    };

    /// The components: curves, touching points, borders of regions.
    #[must_use]
    pub const fn curves(&self) -> &'b [Curve] {
        self.curves
    }

    /// The points of a curve, in order.
    #[must_use]
    pub fn points(&self, curve: &Curve) -> &'b [CurvePoint] {
        self.points.get(curve.first..curve.first + curve.count).unwrap_or(&[])
    }

    /// The branches.
    #[must_use]
    pub const fn branches(&self) -> &'b [Branch] {
        self.branches
    }

    /// Whether the loop-free test ran and nothing was left undecided: no curve is missing.
    #[must_use]
    pub const fn is_certified(&self) -> bool {
        self.tested && self.undecided == 0
    }
}

fn check_depth(depth: u32) -> Result<(), IntersectError> {
    if (MIN_DEPTH..=MAX_DEPTH).contains(&depth) { Ok(()) } else { Err(IntersectError::Depth { depth }) }
}

fn check(options: &Options) -> Result<(), IntersectError> {
    check_depth(options.depth)?;
    if options.tolerance <= 0 {
        return Err(IntersectError::Tolerance { bits: options.tolerance.to_bits() });
    }
    Ok(())
}

/// The nets in an order that does not depend on that of the arguments.
fn is_ordered(a: &SurfaceNet<'_>, b: &SurfaceNet<'_>) -> bool {
    let head = |net: &SurfaceNet<'_>| (net.is_triangle(), net.weights().is_some(), net.degrees());
    let body = |net: &SurfaceNet<'_>, k: usize| {
        let p = net.points().get(k).map(|p| p.to_array().map(Coord::bits));
        (p, net.weights().and_then(|w| w.get(k)).map(|w| w.to_bits()))
    };
    let heads = head(a).cmp(&head(b));
    let bodies = (0..a.points().len()).map(|k| body(a, k).cmp(&body(b, k)));
    bodies.fold(heads, core::cmp::Ordering::then).is_le()
}

/// The curves in which two surfaces meet.
///
/// Depth 5 finds all components that are larger than two cells or so; smaller ones are found by the loop-free test, by the
/// edges' points on the other patch and by the passages between parts. On a host a
/// transversal pair of bicubic patches takes about a millisecond at depth 5.
///
/// # Errors
/// [`IntersectError::Depth`] and [`IntersectError::Tolerance`] for options out of range; a buffer that is too small, with what
/// was needed as far as it is known; [`IntersectError::PairBudget`]; [`IntersectError::DegeneratePatch`] for a patch that is
/// a point or a curve.
///
/// # Examples
/// ```
/// use embedded_surfaces::intersect::{
///     Branch, Buffers, Curve, CurveKind, CurvePoint, MIN_DEPTH, Options, Room, intersect,
/// };
/// use embedded_surfaces::patch::{BicubicPatch, BilinearPatch, Surface};
///
/// let hill = BicubicPatch::from_ints([
///     [[0, 0, 0], [0, 20, 0], [0, 40, 0], [0, 60, 0]],
///     [[20, 0, 0], [20, 20, 40], [20, 40, 40], [20, 60, 0]],
///     [[40, 0, 0], [40, 20, 40], [40, 40, 40], [40, 60, 0]],
///     [[60, 0, 0], [60, 20, 0], [60, 40, 0], [60, 60, 0]],
/// ])?;
/// let water = BilinearPatch::from_ints([[[-9, -9, 10], [-9, 70, 12]], [[70, -9, 10], [70, 70, 12]]])?;
/// let options = Options::DEFAULT.with_depth(MIN_DEPTH);
/// let room = Room::new(hill.surface(), water.surface(), options.depth)?;
///
/// let (mut vertices, mut boxes) = (vec![[0; 3]; room.vertices], vec![[[0; 3]; 2]; room.boxes]);
/// let (mut records, mut links) = ([0; 400], [0; 400]);
/// let (mut points, mut curves, mut branches) = ([CurvePoint::BLANK; 500], [Curve::BLANK; 4], [Branch::BLANK; 1]);
/// let shore = intersect(hill.surface(), water.surface(), &options, Buffers {
///     vertices: &mut vertices,
///     boxes: &mut boxes,
///     records: &mut records,
///     links: &mut links,
///     points: &mut points,
///     curves: &mut curves,
///     branches: &mut branches,
/// })?;
/// assert_eq!(shore.curves().len(), 1);
/// assert_eq!(shore.curves()[0].kind, CurveKind::Closed);
/// assert!(shore.is_certified());
/// assert!(shore.points(&shore.curves()[0]).iter().all(|p| p.position.z > 10 && p.position.z < 12));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn intersect<'b>(
    a: SurfaceNet<'_>,
    b: SurfaceNet<'_>,
    options: &Options,
    buffers: Buffers<'b>,
) -> Result<Intersection<'b>, IntersectError> {
    check(options)?;
    if is_ordered(&a, &b) {
        return in_order([a, b], None, options, buffers, false);
    }
    in_order([b, a], None, options, buffers, true).map_err(|error| match error {
        IntersectError::DegeneratePatch { side } => IntersectError::DegeneratePatch { side: side.other() },
        other => other,
    })
}

/// The same with the nets in their order; `exchanged`: the caller's A is the second. `plane`: finer corners of B.
fn in_order<'b>(
    nets: [SurfaceNet<'_>; 2],
    plane: Option<&[[i64; 3]; 4]>,
    options: &Options,
    buffers: Buffers<'b>,
    exchanged: bool,
) -> Result<Intersection<'b>, IntersectError> {
    let Buffers { vertices, boxes, records, links, points, curves, branches } = buffers;
    let depth = options.depth;
    let [one, two] = nets.map(|net| vertex_count(net.is_triangle(), depth));
    let given = vertices.len();
    let short = IntersectError::VertexBuffer { needed: one + two, given };
    let (first, second) = vertices.split_at_mut_checked(one).ok_or(short)?;
    if second.len() < two {
        return Err(short);
    }
    let (half, given) = (boxes.len() / 2, boxes.len());
    let (boxes_a, boxes_b) = boxes.split_at_mut_checked(half).unwrap_or((&mut [], &mut []));
    if half == 0 {
        return Err(IntersectError::BoxBuffer { needed: 2, given });
    }
    let grids = [Grid::new(nets[0], depth, first, boxes_a)?, Grid::new(nets[1], depth, second, boxes_b)?];
    let grids = [&grids[0], &grids[1]];
    for (side, grid) in Side::BOTH.into_iter().zip(grids) {
        if !grid.has_normal() {
            return Err(IntersectError::DegeneratePatch { side });
        }
    }
    let room = records.len().min(links.len()) & !1;
    let (records, links) = (records.get_mut(..room).unwrap_or(&mut []), links.get_mut(..room).unwrap_or(&mut []));
    let out = Output { points, used: 0, curves, curve_count: 0, branches, branch_count: 0, unrefined: 0, aside: 0 };
    let found = in_rooms(nets[0].points().len().max(nets[1].points().len()), |rooms| {
        let [one, two] = rooms;
        let second = match plane {
            None => Sheet::new(nets[1], two),
            Some(corners) => Sheet::of_plane(nets[1], corners, two),
        };
        let pair = Pair::of([Sheet::new(nets[0], one), second]);
        let tolerance = Real::new(options.tolerance.to_bits(), -44);
        let cell = pair.extent.shl(1 - depth as i32);
        let solver = Solver { pair: &pair, out, tolerance, cell, undecided: 0 };
        solve(solver, grids, options, (records, links))
    });
    let (Output { points, used, curves, curve_count, branches, branch_count, .. }, flags) = found?;
    if exchanged {
        points.iter_mut().take(used).for_each(|p| *p = p.exchanged());
        curves.iter_mut().take(curve_count).for_each(|c| c.ends = c.ends.map(End::exchanged));
        branches.iter_mut().take(branch_count).for_each(|b| b.point = b.point.exchanged());
    }
    Ok(Intersection {
        points: points.get(..used).unwrap_or(&[]),
        curves: curves.get(..curve_count).unwrap_or(&[]),
        branches: branches.get(..branch_count).unwrap_or(&[]),
        ..flags
    })
}

/// Finds all curves: what was written, and the flags.
#[inline(never)]
fn solve<'b>(
    mut solver: Solver<'_, '_, 'b>,
    grids: [&Grid<'_>; 2],
    options: &Options,
    (records, links): (&mut [u64], &mut [u32]),
) -> Result<(Output<'b>, Intersection<'b>), IntersectError> {
    let edges = edges::find(solver.pair, EDGE_PAIRS, solver.tolerance, &mut solver.out)?;
    solver.undecided += edges.undecided;
    let (found, perturbation_sensitive) = segments(grids, options, records, links)?;
    let used = 2 * found.segments;
    let (records, spare) = records.split_at_mut_checked(used).unwrap_or((&mut [], &mut []));
    let links = links.get_mut(..used).unwrap_or(&mut []);
    let mut few = [0; FEW];
    let mut cells = Cells::new(if spare.len() < FEW { &mut few } else { spare });
    let mut chains = Chains::new(records, links, found.degenerate > 0, |c| is_border(grids, c))?;

    // A region of coincidence is a contact everywhere.
    let tested = options.certificate_pairs > 0 && !edges.overlap;
    let mut report = Report::EMPTY;
    if tested {
        solver.contacts(options.certificate_pairs, &mut report, &mut cells)?;
    }
    solver.arms()?;
    solver.borders(grids, &mut chains)?;
    solver.chains(grids, &mut chains)?;
    solver.roots()?;
    solver.around(&report)?;
    solver.leftovers(&report)?;
    if tested && solver.undecided == 0 {
        solver.passages(&mut cells)?;
    }
    let flags = Intersection {
        points: &[],
        curves: &[],
        branches: &[],
        undecided: solver.undecided.max(u32::from(edges.overlap)),
        zero_predicates: found.zeros,
        perturbation_sensitive,
        degenerate_triangles: found.degenerate,
        segments: found.segments,
        tested,
    };
    Ok((solver.out, flags))
}

fn is_border(grids: [&Grid<'_>; 2], crossing: Crossing) -> bool {
    let grid = grids[usize::from(crossing.side) & 1];
    crossing.edge.is_border(grid.triangle, grid.depth)
}

/// Writes the segments in which the grids cross; whether moving B the other way leads to other chains.
#[inline(never)]
fn segments(
    grids: [&Grid<'_>; 2],
    options: &Options,
    records: &mut [u64],
    links: &mut [u32],
) -> Result<(Found, bool), IntersectError> {
    let found = descent::descend(grids, true, options.pairs, records)?;
    if found.zeros == 0 {
        return Ok((found, false));
    }
    let mut signature = |found: &Found, records: &mut [u64]| -> Result<Signature, IntersectError> {
        let used = 2 * found.segments;
        let (records, links) = (records.get_mut(..used), links.get_mut(..used));
        let (records, links) = (records.unwrap_or(&mut []), links.unwrap_or(&mut []));
        Chains::new(records, links, found.degenerate > 0, |c| is_border(grids, c))?.signature()
    };
    let one = signature(&found, records)?;
    let other = descent::descend(grids, false, options.pairs, records)?;
    let is_sensitive = one != signature(&other, records)?;
    descent::descend(grids, true, options.pairs, records)?;
    Ok((found, is_sensitive))
}

#[cfg(feature = "defmt")]
mod format {
    use super::{Buffers, Intersection, Options};
    use defmt::{Format, Formatter, write};

    impl Format for Options {
        fn format(&self, f: Formatter<'_>) {
            write!(f, "depth {}, tolerance {}/2^44, ", self.depth, self.tolerance.to_bits());
            write!(f, "at most {} and {} pairs", self.pairs, self.certificate_pairs);
        }
    }

    impl Format for Buffers<'_> {
        fn format(&self, f: Formatter<'_>) {
            let [records, links] = [self.records.len(), self.links.len()];
            write!(f, "{} vertices, {} boxes, ", self.vertices.len(), self.boxes.len());
            write!(f, "{} records, {} links, ", records, links);
            write!(f, "{} points, {} curves, {} branches", self.points.len(), self.curves.len(), self.branches.len());
        }
    }

    impl Format for Intersection<'_> {
        fn format(&self, f: Formatter<'_>) {
            write!(f, "{} curves, {} branches, {} undecided", self.curves.len(), self.branches.len(), self.undecided);
        }
    }
}
