//! Which lattices a patch is drawn by, and with which walker.

use super::style::Style;
use crate::forward::{
    Budget, Form, Kernel, LatticeError, QuotientWalker, Residual, Sampling, Steps, Visit, Walker, tangent_bits,
};
use crate::num::Word;
use crate::patch::SurfaceNet;

/// Which walker draws a patch. Order 4 holds cubics, 9 everything.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Width {
    Cubic64,
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
            (..=64, _) => Width::Full64,
            (..=128, _) => Width::Full128,
            _ => {
                let fraction_bits = budget.fraction_bits;
                return Err(LatticeError::Budget { degrees: form.degrees, steps: form.steps, fraction_bits, bits });
            }
        };
        Ok(Self { form, budget, width })
    }

    /// Walks the lattice.
    pub(super) fn walk<V: Visit>(&self, visitor: V) {
        match (self.width, self.form.weights().is_some()) {
            (Width::Cubic64, false) => run::<_, _, 4>(Residual::<i64>::of(&self.budget), self, visitor),
            (Width::Full64, false) => run::<_, _, 9>(Residual::<i64>::of(&self.budget), self, visitor),
            (Width::Full128, false) => run::<_, _, 9>(Residual::<i128>::of(&self.budget), self, visitor),
            (Width::Cubic64, true) => run_quotient::<i64, _, 4>(self, visitor),
            (_, true) => run_quotient::<i128, _, 9>(self, visitor),
        }
    }
}

/// One walk in a stack frame of its own: only the walker in use takes room.
#[inline(never)]
fn run<K: Kernel, V: Visit, const R: usize>(kernel: K, plan: &Plan<'_>, visitor: V) {
    Walker::<K, R>::new(kernel, &plan.form, &plan.budget).visit(visitor);
}

/// The same for a rational patch.
#[inline(never)]
fn run_quotient<W: Word, V: Visit, const R: usize>(plan: &Plan<'_>, visitor: V) {
    QuotientWalker::<W, R>::new(&plan.form, &plan.budget).visit(visitor);
}

/// The hole-free lattices of a patch: one, or a coarser one and its cells' centres where that takes fewer points and
/// no wider accumulator.
pub(super) fn fill_plans<'a>(net: SurfaceNet<'a>, style: Style) -> Result<(Plan<'a>, Option<Plan<'a>>), LatticeError> {
    let normals = style.needs_normals();
    let form = |steps: Steps| Form::surface(net, (steps.r(), steps.s()));
    let sampling = Sampling::cheapest(net);
    if sampling.centres {
        let coarse = form(sampling.steps);
        if let (Ok(corners), Ok(centres)) = (Plan::of(coarse, normals), Plan::of(coarse.centres(), normals))
            && centres.width != Width::Full128
        {
            return Ok((corners, Some(centres)));
        }
    }
    Ok((Plan::of(form(Steps::hole_free(net)), normals)?, None))
}
