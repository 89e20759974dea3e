//! Which walker serves a plan: the only place that knows the choice of kernel and room.

use super::columns::{BUFFERED, Paired, visit_runs};
use super::fill::MULTIPLIES;
use super::form::Form;
use super::joined::Joined;
use super::kernel::{Accumulate, Kernel, Mask, Residual};
use super::lanes::LANES;
use super::lattice::LatticePoint;
use super::quotient::QuotientWalker;
use super::residue::{self, Classes};
use super::run::{Buffer, Run, Runs, Sink, each};
use super::visit::{Site, Visit};
use super::walk::Walker;
use super::{Accumulator, Budget};
use crate::num::Word;

/// One walker per kernel and room. Order 4 holds cubics, 6 quintics, 9 everything.
#[derive(Clone, Debug)]
#[allow(clippy::large_enum_variant, reason = "no heap; the sizes are documented")]
pub(super) enum Engine {
    Accumulate32(Walker<Accumulate<i32>, 4>),
    Mask32(Walker<Mask<i32>, 4>),
    Residual32(Walker<Residual<i32>, 4>),
    Accumulate64(Walker<Accumulate<i64>, 4>),
    Mask64(Walker<Mask<i64>, 4>),
    Residual64(Walker<Residual<i64>, 4>),
    Accumulate64Quintic(Walker<Accumulate<i64>, 6>),
    Residual64Quintic(Walker<Residual<i64>, 6>),
    Residual64Full(Walker<Residual<i64>, 9>),
    Residual128(Walker<Residual<i128>, 9>),
    Quotient64(QuotientWalker<i64, 4>),
    Quotient128(QuotientWalker<i128, 9>),
}

/// Runs `$polynomial!(name, room, kernel)` or `$rational!(name, word, room)` by what suits the plan: one place that
/// knows the choice.
macro_rules! choose {
    ($form:expr, $budget:expr, $run:ident, $run_quotient:ident) => {{
        let (form, budget): (&Form<'_>, &Budget) = ($form, $budget);
        let degree = form.degree();
        let integer_bits = integer_bits(form);
        match budget.accumulator {
            Accumulator::I32 | Accumulator::I64 if form.weights().is_some() && degree < 4 => {
                $run_quotient!(Quotient64, i64, 4)
            }
            _ if form.weights().is_some() => $run_quotient!(Quotient128, i128, 9),
            Accumulator::I32 if degree < 4 => {
                if let Some(kernel) = Accumulate::<i32>::of(budget, integer_bits) {
                    $run!(Accumulate32, 4, kernel)
                } else if let Some(kernel) = Accumulate::<i64>::of(budget, integer_bits).filter(|_| LANES > 1) {
                    $run!(Accumulate64, 4, kernel)
                } else if let Some(kernel) = Mask::<i32>::of(budget) {
                    $run!(Mask32, 4, kernel)
                } else {
                    $run!(Residual32, 4, Residual::<i32>::of(budget))
                }
            }
            Accumulator::I32 | Accumulator::I64 if degree < 4 => {
                if let Some(kernel) = Accumulate::<i64>::of(budget, integer_bits) {
                    $run!(Accumulate64, 4, kernel)
                } else if let Some(kernel) = Mask::<i64>::of(budget) {
                    $run!(Mask64, 4, kernel)
                } else {
                    $run!(Residual64, 4, Residual::<i64>::of(budget))
                }
            }
            Accumulator::I32 | Accumulator::I64 if degree < 6 => {
                if let Some(kernel) = Accumulate::<i64>::of(budget, integer_bits) {
                    $run!(Accumulate64Quintic, 6, kernel)
                } else {
                    $run!(Residual64Quintic, 6, Residual::<i64>::of(budget))
                }
            }
            Accumulator::I32 | Accumulator::I64 => $run!(Residual64Full, 9, Residual::<i64>::of(budget)),
            Accumulator::I128 => $run!(Residual128, 9, Residual::<i128>::of(budget)),
        }
    }};
}

/// Runs `$body` with `$walker` bound to the walker that suits the plan, and `$variant` to its [`Engine`].
macro_rules! with_walker {
    ($form:expr, $budget:expr, |$walker:ident, $variant:ident| $body:expr) => {{
        macro_rules! run {
            ($name:ident, $room:literal, $kernel:expr) => {{
                let $walker = Walker::<_, $room>::new($kernel, $form, $budget);
                #[allow(unused_imports)]
                use Engine::$name as $variant;
                $body
            }};
        }
        macro_rules! run_quotient {
            ($name:ident, $word:ty, $room:literal) => {{
                let $walker = QuotientWalker::<$word, $room>::new($form, $budget);
                #[allow(unused_imports)]
                use Engine::$name as $variant;
                $body
            }};
        }
        choose!($form, $budget, run, run_quotient)
    }};
}

/// Runs `$body` with the walker inside an [`Engine`].
macro_rules! each_engine {
    ($engine:expr, $walker:ident => $body:expr) => {
        match $engine {
            Engine::Accumulate32($walker) => $body,
            Engine::Mask32($walker) => $body,
            Engine::Residual32($walker) => $body,
            Engine::Accumulate64($walker) => $body,
            Engine::Mask64($walker) => $body,
            Engine::Residual64($walker) => $body,
            Engine::Accumulate64Quintic($walker) => $body,
            Engine::Residual64Quintic($walker) => $body,
            Engine::Residual64Full($walker) => $body,
            Engine::Residual128($walker) => $body,
            Engine::Quotient64($walker) => $body,
            Engine::Quotient128($walker) => $body,
        }
    };
}

/// Bits of the largest rounded coordinate, sign included.
pub(super) fn integer_bits(form: &Form<'_>) -> u32 {
    let largest = form.points().iter().fold(0, |largest: u32, p| {
        let here = p.to_array().map(|c| c.unsigned_abs().to_bits());
        here.into_iter().fold(largest, u32::max)
    });
    33 - ((largest + (1 << 15)) >> 16).leading_zeros()
}

/// Whether three axes of 32-bit differences stay in registers: then points are not made in runs.
const MANY_REGISTERS: bool = cfg!(target_arch = "riscv32");

/// A fold: the state is threaded through the walk by value.
struct Fold<B, F> {
    state: B,
    f: F,
}

impl<B, F: FnMut(B, LatticePoint) -> B> Visit for Fold<B, F> {
    const POINTS_ONLY: bool = true;

    #[inline(always)]
    fn point<S: Site>(self, at: &S) -> Self {
        let Self { state, mut f } = self;
        let [x, y, z] = at.point();
        let state = f(state, LatticePoint { i: at.i(), j: at.j(), x, y, z });
        Self { state, f }
    }
}

impl Engine {
    pub(super) fn new(form: &Form<'_>, budget: &Budget) -> Self {
        with_walker!(form, budget, |walker, Variant| Variant(walker))
    }

    pub(super) fn next_point(&mut self) -> Option<LatticePoint> {
        let (i, j, [x, y, z]) = each_engine!(self, walker => walker.next_point())?;
        Some(LatticePoint { i, j, x, y, z })
    }

    pub(super) fn remaining(&self) -> u64 {
        each_engine!(self, walker => walker.remaining())
    }

    pub(super) fn fold<B>(mut self, state: B, mut f: impl FnMut(B, LatticePoint) -> B) -> B {
        if LANES > 1 {
            let fold = Fold { state, f };
            return each_engine!(self, walker => walker.run(fold).state);
        }
        let (mut buffer, mut state) = (Buffer::new(), state);
        while let Some(run) = self.next_run(&mut buffer) {
            state = buffer.fold(&run, state, &mut f);
        }
        state
    }
}

impl Runs for Engine {
    fn next_run(&mut self, buffer: &mut Buffer) -> Option<Run> {
        each_engine!(self, walker => walker.next_run(buffer))
    }
}

/// Walks a checked form with the kernel that suits it; only that kernel's state is on the stack.
#[inline]
pub(super) fn walk(form: &Form<'_>, budget: &Budget, f: impl FnMut(LatticePoint)) {
    if MULTIPLIES && let Some(walk) = &mut Joined::new(form, budget) {
        return walk.for_each(f);
    }
    if BUFFERED && let Some(walk) = &mut Classes::new(form, budget, 1).and_then(Paired::new) {
        return visit_runs(walk, f);
    }
    let mut f = f;
    let fold = Fold { state: (), f: |(), p| f(p) };
    if LANES > 1 {
        with_walker!(form, budget, |walker, Variant| walker.run(fold).state);
    } else if MANY_REGISTERS && form.weights().is_none() && budget.accumulator == Accumulator::I32 && form.degree() < 4
    {
        if let Some(kernel) = Mask::<i32>::of(budget) {
            Walker::<_, 4>::new(kernel, form, budget).run(fold);
        } else {
            Walker::<_, 4>::new(Residual::<i32>::of(budget), form, budget).run(fold);
        }
    } else {
        each_run(form, budget, &mut move |buffer, run| buffer.fold(run, (), &mut |(), p| f(p)));
    }
}

/// Walks a checked form in any order.
#[inline]
#[allow(clippy::redundant_closure, reason = "as `f` or `&mut f`, what `f` captures is stored at every point: measured")]
pub(super) fn walk_unordered(form: &Form<'_>, budget: &Budget, mut f: impl FnMut(LatticePoint)) {
    match Classes::new(form, budget, 0) {
        Some(classes) => residue::visit(&classes, |p| f(p)),
        None => walk(form, budget, f),
    }
}

/// The runs of a checked form, in row order.
#[inline(never)]
fn each_run(form: &Form<'_>, budget: &Budget, sink: Sink<'_>) {
    /// A function each: only one walk is on the stack.
    #[inline(never)]
    fn polynomial<K: Kernel, const R: usize>(kernel: K, form: &Form<'_>, budget: &Budget, sink: Sink<'_>) {
        let mut walker = Walker::<K, R>::blank(kernel);
        walker.set_up_points(form, budget);
        each(&mut walker, sink);
    }

    #[inline(never)]
    fn rational<W: Word, const R: usize>(form: &Form<'_>, budget: &Budget, sink: Sink<'_>) {
        let mut walker = QuotientWalker::<W, R>::blank();
        walker.set_up(form, budget);
        each(&mut walker, sink);
    }

    macro_rules! run {
        ($name:ident, $room:literal, $kernel:expr) => {
            polynomial::<_, $room>($kernel, form, budget, sink)
        };
    }
    macro_rules! run_quotient {
        ($name:ident, $word:ty, $room:literal) => {
            rational::<$word, $room>(form, budget, sink)
        };
    }
    choose!(form, budget, run, run_quotient);
}
