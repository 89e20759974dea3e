//! Lines: iso-parametric curves, control nets, normals.

use super::brush::Highest;
use super::fill::Drawing;
use super::light::Side;
use super::pen::{Ink, Pen, Rows, normal_inside};
use super::plan::Plan;
use super::style::{Lines, Style};
#[cfg(feature = "styled")]
use crate::forward::Budget;
use crate::forward::{Form, Fraction, LatticeError, row_count};
use crate::geometry::Point3;
use crate::num::{Coord, I16F16};
use crate::patch::{Barycentric, CurveNet, Parameter, Surface, SurfaceNet};
use core::marker::PhantomData;

/// Draws the lines of one patch of a type `S`.
#[inline(never)]
pub(super) fn draw_lines<S: Surface>(drawing: &mut Drawing<'_>) {
    let style = drawing.shading.style;
    let mut lines = LineDrawing::<S> { kind: PhantomData, net: drawing.net, drawing };
    lines.draw(style);
}

/// The lines of one patch on their way into a tile.
struct LineDrawing<'a, 'd, S> {
    kind: PhantomData<S>,
    net: SurfaceNet<'d>,
    drawing: &'a mut Drawing<'d>,
}

/// The lattice whose rows 0, stride, 2·stride, … are the iso-parametric curves of one family.
pub(super) fn family<'a>(net: SurfaceNet<'a>, lines: Lines, turn: u8) -> Result<(Plan<'a>, u32), LatticeError> {
    let count = lines.count();
    let form = Form::surface(net, (1, 1)).turned(turn, (1, 1));
    let along = row_count(&form);
    if net.is_triangle() {
        // A triangle has as many rows as steps: take a multiple of the curves, and skip the rows in between.
        let stride = along.div_ceil(count.max(1));
        let steps = stride.saturating_mul(count);
        Ok((Plan::of(form.turned(turn, (steps, steps)), false)?, stride))
    } else {
        Ok((Plan::of(form.turned(turn, (along, count)), false)?, 1))
    }
}

/// Checks that [`family`] succeeds for every number of lines: at its most steps with its longest step.
#[cfg(feature = "styled")]
pub(super) fn any_family(net: SurfaceNet<'_>) -> Result<(), LatticeError> {
    for turn in 0..families(net) {
        let form = Form::surface(net, (1, 1)).turned(turn, (1, 1));
        let along = row_count(&form);
        let most = along.saturating_add(u8::MAX.into());
        let (few, many) = if net.is_triangle() { ((along, along), (most, most)) } else { ((along, 1), (along, 255)) };
        let longest = Budget::of(&form.turned(turn, few))?.largest_step;
        let budget = Budget::of(&form.turned(turn, many))?;
        if budget.scale.checked_mul(2 * u128::from(longest) + 1).is_none() {
            let (degrees, fraction_bits) = (form.degrees, budget.fraction_bits);
            return Err(LatticeError::Budget { degrees, steps: many, fraction_bits, bits: 129 });
        }
    }
    Ok(())
}

/// How many families of iso-parametric curves a patch has.
pub(super) fn families(net: SurfaceNet<'_>) -> u8 {
    if net.is_triangle() { 3 } else { 2 }
}

impl<S: Surface> LineDrawing<'_, '_, S> {
    fn draw(&mut self, style: Style) {
        match style {
            Style::Wire(lines) => self.wire(lines),
            Style::Net { .. } => self.control_net(),
            Style::Normals { lines, length } => self.normals(lines, length),
            _ => {}
        }
    }

    fn walk(&mut self, plan: &Plan<'_>, rows: Rows) {
        let drawing = &mut *self.drawing;
        let window = drawing.shading.window;
        plan.draw::<S>(&mut Pen {
            area: drawing.area,
            depth: drawing.depth,
            window,
            fraction: Fraction::of(plan.budget.scale, window.bits),
            ink: Ink::Line(window.bias()),
            side: Side::Viewer,
            form: &plan.form,
            rows,
            points: &mut drawing.statistics.points,
            brush: &mut Highest(drawing.stain),
        });
    }

    fn wire(&mut self, lines: Lines) {
        for turn in 0..families(self.net) {
            // Planned when the scene was made, so it cannot fail here.
            if let Ok((plan, stride)) = family(self.net, lines, turn) {
                self.walk(&plan, Rows::Every(stride));
            }
        }
    }

    /// A straight line, as the exact lattice of a curve of degree 1.
    fn segment(&mut self, ends: [Point3; 2]) {
        let net = CurveNet::of_checked(&ends);
        let steps = row_count(&Form::curve(net, 1));
        // N is at most 2^16·2^16 and K at most 2 in x and y: any pair of legal points fits 128 bits.
        if let Ok(plan) = Plan::of(Form::curve(net, steps), false) {
            self.walk(&plan, Rows::All);
        }
    }

    fn control_net(&mut self) {
        let (m, h) = self.net.degrees();
        let net = self.net;
        let at = |i: usize, j: usize| {
            let index = if net.is_triangle() { crate::patch::triangle_index(i, j) } else { i * (h + 1) + j };
            net.points().get(index).copied()
        };
        // A triangle is read by (j, k): then the same three differences are its edges.
        let last = |i: usize| if net.is_triangle() { m - i } else { h };
        let families = if net.is_triangle() { 3 } else { 2 };
        for i in 0..=m {
            for j in 0..=last(i) {
                let ends = [(i + 1, Some(j)), (i, Some(j + 1)), (i + 1, j.checked_sub(1))];
                for (a, b) in ends.into_iter().take(families) {
                    let Some(b) = b.filter(|b| a <= m && *b <= last(a)) else { continue };
                    if let (Some(p), Some(q)) = (at(i, j), at(a, b)) {
                        self.segment([p, q]);
                    }
                }
            }
        }
    }

    fn normals(&mut self, lines: Lines, length: u8) {
        let count = lines.count();
        let form = Form::surface(self.net, (count, count));
        for j in 0..=count {
            for i in 0..=form.last_in_row(j) {
                let Some(foot) = point(self.net, count, i, j) else { continue };
                let Some(normal) = normal_inside(self.net, &form, i, j) else { continue };
                if let Some(tip) = tip(foot, normal, length) {
                    self.segment([foot, tip]);
                }
            }
        }
    }
}

/// The exactly rounded point at (i/n, j/n).
fn point(net: SurfaceNet<'_>, n: u32, i: u32, j: u32) -> Option<Point3> {
    let parameters = || Some((Parameter::new(i, n).ok()?, Parameter::new(j, n).ok()?));
    let barycentric = || Barycentric::new(i, j, n.checked_sub(i + j)?).ok();
    Some(match net {
        SurfaceNet::Triangle(net) => net.eval(barycentric()?),
        SurfaceNet::RationalTriangle(net) => net.eval(barycentric()?),
        SurfaceNet::Tensor(net) => parameters().map(|(r, s)| net.eval(r, s))?,
        SurfaceNet::RationalTensor(net) => parameters().map(|(r, s)| net.eval(r, s))?,
    })
}

/// The point `length` units along the normal; `None` out of range.
fn tip(foot: Point3, normal: [i32; 3], length: u8) -> Option<Point3> {
    let size = i64::from(normal.iter().map(|n| n.unsigned_abs().pow(2)).sum::<u32>().isqrt());
    let mut axes = foot.to_array();
    for (c, n) in axes.iter_mut().zip(normal) {
        let offset = ((i64::from(n) * i64::from(length)) << 16).checked_div(size)?;
        *c = I16F16::from_legal_bits((c.bits() + offset).into())?;
    }
    Some(Point3::from_array(axes))
}
