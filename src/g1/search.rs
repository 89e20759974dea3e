//! The first pass: which vertices have their tangents moved, and where to (step 3 of the scheme).

use super::G1Error;
use super::balance::{Balance, Far, View};
use super::fan::Fan;
use super::ring::Star;
use super::setting::Setting;
use super::shift::{DUE, MOVED, Shift, WEAK};
use crate::num::Coord;

/// Sweeps over the mesh, at most.
const SWEEPS: usize = 3;

impl<C: Coord> Setting<'_, C> {
    /// Fills in the shifts, one a vertex.
    pub(super) fn decide(&self, shifts: &mut [Shift]) -> Result<(), G1Error> {
        shifts.fill(Shift::NONE);
        if self.options.strict {
            return Ok(());
        }
        for _ in 0..SWEEPS {
            let weak_too = self.mark(shifts)?;
            let mut changed = false;
            for vertex in 0..shifts.len() {
                let shift = shifts.get(vertex).copied().unwrap_or_default();
                if !shift.has(DUE) {
                    continue;
                }
                // Neighbours that have moved may have helped.
                let Some(balance) = View { setting: self, shifts }.balance(vertex)? else { continue };
                let weak = weak_too && balance.is_weak();
                if !weak && !balance.is_strained(self.tolerance()) {
                    continue;
                }
                let choice = self.best(vertex, shifts, shift.has(MOVED) || !weak)?;
                if let Some(entry) = shifts.get_mut(vertex).filter(|entry| entry.number() != choice) {
                    *entry = Shift::choice(choice).with(MOVED, true);
                    changed = true;
                }
            }
            if !changed {
                break;
            }
        }
        shifts.iter_mut().for_each(|shift| *shift = shift.unmarked());
        Ok(())
    }

    fn tolerance(&self) -> i64 {
        self.options.tolerance.to_bits()
    }

    /// Marks the vertices to look at: those whose points would move too far; and, if some vertex that can hardly meet its
    /// equations does not meet them, all such vertices. Otherwise these are consistent by symmetry and stay. Returns
    /// whether such vertices count.
    fn mark(&self, shifts: &mut [Shift]) -> Result<bool, G1Error> {
        let mut weak_too = false;
        for vertex in 0..shifts.len() {
            let balance = View { setting: self, shifts }.balance(vertex)?;
            let (weak, strained) = balance.map_or((false, false), |balance| {
                weak_too |= balance.is_weak() && !balance.is_met(self.tolerance());
                (balance.is_weak(), balance.is_strained(self.tolerance()))
            });
            if let Some(shift) = shifts.get_mut(vertex) {
                *shift = shift.with(WEAK, weak).with(DUE, strained);
            }
        }
        for shift in shifts.iter_mut().filter(|shift| weak_too && shift.has(WEAK)) {
            *shift = shift.with(DUE, true);
        }
        Ok(weak_too)
    }

    /// The best shift of a vertex: the least of 4·J/(1 + J), 4 if it is weak, J/(1 + J) of its even neighbours, and the
    /// square of the shift.
    fn best(&self, vertex: usize, shifts: &[Shift], may_stay: bool) -> Result<u8, G1Error> {
        let view = View { setting: self, shifts };
        let mut costs = [None; Shift::COUNT as usize];
        let star = self.costs_of_vertex(view, vertex, may_stay, &mut costs)?;
        for i in 0..star.len {
            self.costs_of_neighbour(view, vertex, i, star.to[i].into(), &mut costs)?;
        }
        let stays = shifts.get(vertex).map_or(0, |shift| shift.number());
        let (mut best, mut least) = (stays, i64::MAX);
        for (choice, cost) in (0..).zip(costs) {
            if let Some(cost) = cost.filter(|cost| *cost < least) {
                (best, least) = (choice, cost);
            }
        }
        Ok(best)
    }

    #[inline(never)]
    fn costs_of_vertex(
        &self,
        view: View<'_, '_, C>,
        vertex: usize,
        may_stay: bool,
        costs: &mut [Option<i64>; Shift::COUNT as usize],
    ) -> Result<Star, G1Error> {
        let (mut fan, mut far) = (Fan::blank(), Far::blank());
        self.original(vertex, &mut fan)?;
        view.far(&fan, &mut far)?;
        let still = fan.t;
        for (choice, cost) in (0..).zip(costs) {
            fan.t = still;
            fan.move_by(Shift::choice(choice));
            let legal = if choice == 0 { may_stay } else { fan.is_open() };
            let balance = if legal { fan.finish().and_then(|()| Balance::of(&fan, &far)) } else { continue };
            if let Ok(balance) = balance {
                let weak = if balance.is_weak() { 4 << 24 } else { 0 };
                *cost = Some(4 * balance.strain(self.tolerance()) + weak + Shift::choice(choice).square());
            }
        }
        Ok(fan.star)
    }

    /// Adds the strain of neighbour i to each shift's costs.
    #[inline(never)]
    fn costs_of_neighbour(
        &self,
        view: View<'_, '_, C>,
        vertex: usize,
        i: usize,
        neighbour: usize,
        costs: &mut [Option<i64>; Shift::COUNT as usize],
    ) -> Result<(), G1Error> {
        if !Star::of(&self.mesh, neighbour)?.is_even() {
            return Ok(());
        }
        let (mut fan, mut far, mut moved) = (Fan::blank(), Far::blank(), Fan::blank());
        view.fan(neighbour, &mut fan)?;
        view.far(&fan, &mut far)?;
        self.original(vertex, &mut moved)?;
        let (still, at) = (moved.t, fan.star.place_of(vertex));
        for (choice, cost) in (0..).zip(costs) {
            let Some(sum) = cost else { continue };
            moved.t = still;
            moved.move_by(Shift::choice(choice));
            let seen = moved.coefficients(i).ok().zip(moved.lifted(i));
            let balance = seen.and_then(|((kappa, m), e)| {
                (far.kappa[at], far.m[at], far.e[at]) = (kappa, m, e);
                Balance::of(&fan, &far).ok()
            });
            match balance {
                Some(balance) => *sum += balance.strain(self.tolerance()),
                None => *cost = None,
            }
        }
        Ok(())
    }
}

impl<C: Coord> View<'_, '_, C> {
    /// The balance of a vertex of even valence; `None` for others, which have none to keep.
    #[inline(never)]
    fn balance(&self, vertex: usize) -> Result<Option<Balance>, G1Error> {
        if !Star::of(&self.setting.mesh, vertex)?.is_even() {
            return Ok(None);
        }
        let (mut fan, mut far) = (Fan::blank(), Far::blank());
        self.fan(vertex, &mut fan)?;
        self.far(&fan, &mut far)?;
        Balance::of(&fan, &far).map(Some)
    }
}
