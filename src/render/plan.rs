//! Which lattices a patch is drawn by, and with which walker.

use super::cubic;
use super::pen::{NormalPen, Pen};
use super::pieces::depth;
use crate::forward::{
    Accumulator, Budget, Form, Kernel, LatticeError, PieceBudget, PieceSlopes, QuotientWalker, Residual, Sampling,
    Visit, Walker, deepest_budget, piece_budget, tangent_bits,
};
use crate::geometry::Point3;
use crate::num::Word;
use crate::patch::{Surface, SurfaceNet};
use crate::subdivide::part_net;

/// Which walker draws a lattice. Order 4 holds cubics, 6 quintics, 9 everything.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Width {
    Cubic32,
    Cubic64,
    Quintic64,
    Full64,
    Full128,
}

/// One lattice of a patch.
#[derive(Clone, Copy, Debug)]
pub(super) struct Plan<'a> {
    pub(super) form: Form<'a>,
    pub(super) budget: Budget,
    width: Width,
}

impl<'a> Plan<'a> {
    /// The plan for a form; `normals`: tangents must fit too.
    pub(super) fn of(form: Form<'a>, normals: bool) -> Result<Self, LatticeError> {
        let budget = Budget::of(&form)?;
        let points = 32 << (budget.accumulator as u32);
        let bits = if normals { tangent_bits(&form, &budget).max(points) } else { points };
        let width = match (bits, form.degree()) {
            (..=64, ..4) => Width::Cubic64,
            (..=64, ..6) => Width::Quintic64,
            (..=64, _) => Width::Full64,
            (..=128, _) => Width::Full128,
            _ => {
                let fraction_bits = budget.fraction_bits;
                return Err(LatticeError::Budget { degrees: form.degrees, steps: form.steps, fraction_bits, bits });
            }
        };
        Ok(Self { form, budget, width })
    }

    /// Walks the lattice with any visitor, which may want tangents.
    pub(super) fn walk<V: Visit>(&self, visitor: V) {
        match (self.width, self.form.weights().is_some()) {
            (Width::Cubic32 | Width::Cubic64, false) => {
                run::<_, _, 4>(Residual::<i64>::of(&self.budget), self, visitor);
            }
            (Width::Quintic64, false) => run::<_, _, 6>(Residual::<i64>::of(&self.budget), self, visitor),
            (Width::Full64, false) => run::<_, _, 9>(Residual::<i64>::of(&self.budget), self, visitor),
            (Width::Full128, false) => run::<_, _, 9>(Residual::<i128>::of(&self.budget), self, visitor),
            (Width::Cubic32 | Width::Cubic64, true) => run_quotient::<i64, _, 4>(self, visitor),
            (_, true) => run_quotient::<i128, _, 9>(self, visitor),
        }
    }
}

impl Plan<'_> {
    /// Walks the lattice, which is of a net of type `S`, with a pen.
    pub(super) fn draw<S: Surface>(&self, pen: &mut Pen<'_>) {
        let (budget, degree) = (&self.budget, if S::SHAPE.degree < 4 { 3 } else { self.form.degree() });
        if S::SHAPE.rational && self.form.weights().is_some() {
            return match self.width {
                Width::Cubic64 => run_quotient::<i64, _, 4>(self, NormalPen(pen)),
                _ if degree < 4 => run_quotient::<i128, _, 4>(self, NormalPen(pen)),
                _ => run_quotient::<i128, _, 9>(self, NormalPen(pen)),
            };
        }
        match self.width {
            Width::Cubic32 => run::<_, _, 4>(Residual::<i32>::of(budget), self, pen),
            Width::Cubic64 => run::<_, _, 4>(Residual::<i64>::of(budget), self, pen),
            _ if degree < 4 => run::<_, _, 4>(Residual::<i128>::of(budget), self, pen),
            Width::Quintic64 => run::<_, _, 6>(Residual::<i64>::of(budget), self, pen),
            Width::Full64 => run::<_, _, 9>(Residual::<i64>::of(budget), self, pen),
            Width::Full128 => run::<_, _, 9>(Residual::<i128>::of(budget), self, pen),
        }
    }
}

/// One walk in a stack frame of its own: only the walker in use takes room.
#[inline(never)]
fn run<K: Kernel, V: Visit, const R: usize>(kernel: K, plan: &Plan<'_>, visitor: V) {
    let mut walker = Walker::<K, R>::blank(kernel);
    walker.set_up(&plan.form, &plan.budget);
    walker.visit(visitor);
}

/// The same for a rational patch.
#[inline(never)]
fn run_quotient<W: Word, V: Visit, const R: usize>(plan: &Plan<'_>, visitor: V) {
    let mut walker = QuotientWalker::<W, R>::blank();
    walker.set_up(&plan.form, &plan.budget);
    walker.visit(visitor);
}

/// Calls `f` for each lattice of a piece, and with how often its z is halved: one, or a coarser one and its cells' centres.
/// `room` holds as many points as the net.
///
/// # Errors
/// [`LatticeError::Budget`] where 128 bits are too few, [`LatticeError::Steps`] above 2^24 steps.
pub(super) fn each_lattice<S: Surface>(
    net: SurfaceNet<'_>,
    sampling: Sampling,
    room: &mut [Point3],
    f: &mut dyn FnMut(&Plan<'_>, u32),
) -> Result<(), LatticeError> {
    let sampling = settled::<S>(net, sampling);
    one_lattice::<S>(net, sampling, false, room, f)?;
    if sampling.centres { one_lattice::<S>(net, sampling, true, room, f) } else { Ok(()) }
}

/// The sampling without the centres, at more steps, where they need more than 64 bits.
fn settled<S: Surface>(net: SurfaceNet<'_>, sampling: Sampling) -> Sampling {
    if !sampling.centres {
        return sampling;
    }
    let form = Form::surface(net, (sampling.steps.r(), sampling.steps.s())).centres();
    let fits = lattice::<S>(net, &form).is_ok_and(|(_, width)| width != Width::Full128);
    if fits { sampling } else { PieceSlopes::of(net).sampling::<S>(net, false) }
}

#[inline(never)]
fn one_lattice<S: Surface>(
    net: SurfaceNet<'_>,
    sampling: Sampling,
    centred: bool,
    room: &mut [Point3],
    f: &mut dyn FnMut(&Plan<'_>, u32),
) -> Result<(), LatticeError> {
    let form = |net, steps| {
        let form = Form::surface(net, steps);
        if centred { form.centres() } else { form }
    };
    let (r, s) = (sampling.steps.r(), sampling.steps.s());
    let (PieceBudget { budget, halvings }, width) = lattice::<S>(net, &form(net, (r, s)))?;
    let rounded = round_net(net, (budget.fraction_bits, halvings), room);
    let turn = PieceSlopes::of(net).turn(net.is_triangle(), sampling.centres);
    let form = form(rounded, (1, 1)).turned(turn, if turn == 1 { (s, r) } else { (r, s) });
    f(&Plan { form, budget, width }, halvings);
    Ok(())
}

/// The net with coordinates rounded half up to so many fraction bits, within 2^-(bits + 1), and z halved first.
fn round_net<'a>(net: SurfaceNet<'a>, (bits, halvings): (u32, u32), room: &'a mut [Point3]) -> SurfaceNet<'a> {
    let (points, drop) = (net.points(), 16_u32.saturating_sub(bits));
    if net.weights().is_some() || drop + halvings == 0 || room.len() < points.len() {
        return net;
    }
    let half = (1 << drop) >> 1;
    for (to, from) in room.iter_mut().zip(points) {
        let round = |c: i32| (c + half) >> drop << drop;
        let z = (from.z.to_bits() >> halvings) + half;
        *to = Point3::from_bits(round(from.x.to_bits()), round(from.y.to_bits()), z >> drop << drop);
    }
    part_net(net, room, &[])
}

/// Whether a piece need not be split to be walked: a polynomial one in 64 bits, a rational one at all.
pub(super) fn fits<S: Surface>(net: SurfaceNet<'_>, sampling: Sampling) -> bool {
    let Sampling { steps, .. } = settled::<S>(net, sampling);
    let corners = lattice::<S>(net, &Form::surface(net, (steps.r(), steps.s())));
    corners.is_ok_and(|(_, width)| width != Width::Full128 || net.weights().is_some())
}

/// The budget of a lattice of a piece and the walker that suits it.
fn lattice<S: Surface>(net: SurfaceNet<'_>, form: &Form<'_>) -> Result<(PieceBudget, Width), LatticeError> {
    if S::SHAPE.rational && form.weights().is_some() {
        // Tangents, where they are wanted, were checked with the scene.
        let plan = Plan::of(*form, true).or_else(|_| Plan::of(*form, false))?;
        return Ok((PieceBudget { budget: plan.budget, halvings: 0 }, plan.width));
    }
    let budget = piece_budget(net, form)?;
    let width = match (budget.budget.accumulator, form.degree()) {
        (Accumulator::I32, _) => Width::Cubic32,
        (Accumulator::I64, ..4) => Width::Cubic64,
        (Accumulator::I64, ..6) => Width::Quintic64,
        (Accumulator::I64, _) => Width::Full64,
        (Accumulator::I128, _) => Width::Full128,
    };
    Ok((budget, width))
}

/// Checks that every piece of a patch can be drawn.
///
/// # Errors
/// What the lattice of the patch (rational: undivided; polynomial: split as deep as it goes) does not fit.
#[inline(always)]
pub(super) fn check_pieces<S: Surface>(net: SurfaceNet<'_>, normals: bool) -> Result<(), LatticeError> {
    // Those of degree 3 or less always can.
    if cubic::suits::<S>(&net) { Ok(()) } else { check_lattices::<S>(net, normals) }
}

#[inline(never)]
fn check_lattices<S: Surface>(net: SurfaceNet<'_>, normals: bool) -> Result<(), LatticeError> {
    let sampling = PieceSlopes::of(net).sampling::<S>(net, false);
    if S::SHAPE.rational && net.weights().is_some() {
        return Plan::of(Form::surface(net, (sampling.steps.r(), sampling.steps.s())), normals).map(drop);
    }
    deepest_budget(net, sampling, depth(net.points().len()) as u32)
}
