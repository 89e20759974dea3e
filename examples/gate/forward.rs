//! Lattices of surfaces and curves with every kernel and word, their budgets, steps and errors.

use super::{Digest, Sum, data, hide};
use embedded_surfaces::forward::{
    Accumulator, Budget, CurveLattice, CurvePoint, Lattice, LatticePoint, RowStep, Sampling, Steps, Tags, UnitStep,
    VisibilityBuffer, Visible,
};
use embedded_surfaces::geometry::Point3;
use embedded_surfaces::num::I16F16;
use embedded_surfaces::patch::{
    CubicCurve, CurveNet, RationalCurveNet, RationalTensorNet, Surface, SurfaceNet, TensorNet,
};

impl Digest for LatticePoint {
    fn digest(&self, sum: &mut Sum) {
        ([self.i, self.j], [self.x, self.y, self.z]).digest(sum);
    }
}

impl Digest for Visible {
    fn digest(&self, sum: &mut Sum) {
        (i32::from(self.z), u32::from(self.tag)).digest(sum);
    }
}

impl Digest for CurvePoint {
    fn digest(&self, sum: &mut Sum) {
        (self.i, [self.x, self.y, self.z]).digest(sum);
    }
}

impl Digest for RowStep {
    fn digest(&self, sum: &mut Sum) {
        match self {
            Self::Start(point) => point.digest(sum),
            Self::Step(step) => step.digest(sum),
        }
    }
}

impl Digest for UnitStep {
    fn digest(&self, sum: &mut Sum) {
        [self.x, self.y, self.z].digest(sum);
    }
}

impl Digest for Budget {
    fn digest(&self, sum: &mut Sum) {
        let accumulator = match self.accumulator {
            Accumulator::I32 => 32_u8,
            Accumulator::I64 => 64,
            Accumulator::I128 => 128,
        };
        ((accumulator, self.scale), [self.fraction_bits, self.largest_step]).digest(sum);
    }
}

impl Digest for Steps {
    fn digest(&self, sum: &mut Sum) {
        (Steps::r(*self), Steps::s(*self)).digest(sum);
    }
}

pub(super) fn calls(sum: &mut Sum) {
    steps(sum);
    for net in nets() {
        for (r, s) in hide([(6, 6), (16, 16), (9, 5), (1 << 24, 1 << 24)]) {
            if let Ok(steps) = Steps::new(r, s) {
                lattices(sum, net, steps);
            }
        }
    }
    extremes(sum);
    curves(sum);
    hide([Accumulator::I32, Accumulator::I64, Accumulator::I128])
        .into_iter()
        .for_each(|word| sum.add(Err::<(), _>(word)));
}

#[inline(never)]
fn nets() -> [SurfaceNet<'static>; 7] {
    let (cubic, wave, uneven, flat) = hide((&data::TRIANGLE, &data::BICUBIC, &data::UNEVEN, &data::BILINEAR));
    let (quintic, weighted, octant) = hide((&data::QUINTIC, &data::WEIGHTED, &data::OCTANT));
    let polynomial = [cubic.surface(), wave.surface(), uneven.surface(), flat.surface(), quintic.surface()];
    let [a, b, c, d, e] = polynomial;
    [a, b, c, d, e, weighted.surface(), octant.surface()]
}

#[inline(never)]
fn steps(sum: &mut Sum) {
    for n in hide([0, 1, 1 << 24, (1 << 24) + 1]) {
        sum.add(Steps::uniform(n));
        sum.add(Steps::new(7, n));
    }
    for net in nets() {
        sum.add([Steps::paper(net), Steps::hole_free(net)]);
        let sampling = Sampling::cheapest(net);
        sum.add((sampling.steps, sampling.centres));
    }
}

#[inline(never)]
fn lattices(sum: &mut Sum, net: SurfaceNet<'_>, steps: Steps) {
    for lattice in [Lattice::new(net, steps), Lattice::centres(net, steps)] {
        sum.add(lattice.map(|lattice| (*Lattice::budget(&lattice), Lattice::point_count(&lattice))));
        let Ok(lattice) = lattice else { continue };
        sum.add(Lattice::steps(&lattice));
        refusal(sum, &lattice);
        if Lattice::point_count(&lattice) < 1000 {
            each(sum, &lattice);
            points(sum, &lattice);
            unordered(sum, &lattice);
            visible(sum, &lattice);
            row_steps(sum, &lattice);
        }
    }
}

#[inline(never)]
fn first(sum: &mut Sum, lattice: &Lattice<'_>) {
    for point in lattice.into_iter().take(40) {
        sum.add(point);
    }
}

#[inline(never)]
fn each(sum: &mut Sum, lattice: &Lattice<'_>) {
    Lattice::for_each(lattice, |point| sum.add(point));
}

/// The order is left open, but the same everywhere.
#[inline(never)]
fn unordered(sum: &mut Sum, lattice: &Lattice<'_>) {
    Lattice::for_each_unordered(lattice, |point| sum.add(point));
    sum.add(Lattice::checksum(lattice));
}

/// Some points fall on the picture.
#[inline(never)]
fn visible(sum: &mut Sum, lattice: &Lattice<'_>) {
    let mut entries = [0; 16 * 16];
    for side in hide([16, 17]) {
        let picture = VisibilityBuffer::new(&mut entries, side, 16);
        sum.add(picture.as_ref().map(|_| ()));
        let Ok(mut picture) = picture else { continue };
        VisibilityBuffer::clear(&mut picture);
        VisibilityBuffer::draw(&mut picture, lattice, Tags { by_i: 1, ..Tags::same(hide(9)) });
        sum.add(VisibilityBuffer::get(&picture, hide(3), 4));
        sum.add(VisibilityBuffer::entries(&picture));
    }
    sum.add(Tags::at(&Tags::same(hide(9)), 3, 4));
}

/// An iterator over points is some kilobytes, so each has a frame of its own.
#[inline(never)]
fn points(sum: &mut Sum, lattice: &Lattice<'_>) {
    for point in Lattice::points(lattice) {
        sum.add(point);
    }
}

#[inline(never)]
fn refusal(sum: &mut Sum, lattice: &Lattice<'_>) {
    sum.add(Lattice::row_steps(lattice).map(|_| ()));
}

#[inline(never)]
fn row_steps(sum: &mut Sum, lattice: &Lattice<'_>) {
    if let Ok(steps) = Lattice::row_steps(lattice) {
        for step in steps {
            sum.add(step);
        }
    }
}

/// Degree 8 by 8 in 128 bits, fractions in all words, and weights that ask for many steps.
#[inline(never)]
fn extremes(sum: &mut Sum) {
    let high: [Point3; 81] = core::array::from_fn(|k| {
        let k = hide(k as i32);
        Point3::from_bits(k * 0x1357, (k * k) << 9, (40 - k) << 12)
    });
    let steps = [Steps::uniform(hide(3)), Steps::uniform(hide(30)), Steps::uniform(hide(1000))];
    for steps in steps.into_iter().flatten() {
        if let Ok(net) = TensorNet::new((8, 8), &high) {
            limited(sum, SurfaceNet::Tensor(net), steps);
            let mut weights = [I16F16::ONE; 81];
            weights[40] = I16F16::from_bits(hide(3));
            if let Ok(net) = RationalTensorNet::new(net, &weights) {
                limited(sum, SurfaceNet::RationalTensor(net), steps);
            }
        }
        if let Ok(net) = TensorNet::new((2, 2), &high[..9]) {
            limited(sum, SurfaceNet::Tensor(net), steps);
        }
    }
}

#[inline(never)]
fn limited(sum: &mut Sum, net: SurfaceNet<'_>, steps: Steps) {
    let lattice = Lattice::new(net, steps);
    sum.add(lattice.map(|lattice| *lattice.budget()));
    if let Ok(lattice) = lattice {
        first(sum, &lattice);
        if steps.r() < 10 {
            each(sum, &lattice);
        }
    }
}

#[inline(never)]
fn curves(sum: &mut Sum) {
    let (cubic, arc) = hide((&data::CUBIC, &data::ARC));
    let fraction = cubic.points().map(|p| Point3::from_bits(p.x.to_bits() + 1, p.y.to_bits(), p.z.to_bits()));
    polynomial_curve(sum, cubic.net());
    if let Ok(curve) = CubicCurve::new(fraction) {
        polynomial_curve(sum, curve.net());
    }
    let net: RationalCurveNet<'_> = arc.net();
    for n in hide([0, 3, 1 << 24]).into_iter().chain([Steps::rational_curve(net)]) {
        let lattice = CurveLattice::rational(net, n);
        sum.add(lattice.map(|lattice| *lattice.budget()));
        if let Ok(lattice) = lattice {
            walk(sum, &lattice, n);
        }
    }
}

#[inline(never)]
fn polynomial_curve(sum: &mut Sum, net: CurveNet<'_>) {
    for n in hide([0, 7, 1 << 24]).into_iter().chain([Steps::curve(net)]) {
        let lattice = CurveLattice::new(net, n);
        sum.add(lattice.map(|lattice| *CurveLattice::budget(&lattice)));
        if let Ok(lattice) = lattice {
            walk(sum, &lattice, n);
        }
    }
}

#[inline(never)]
fn walk(sum: &mut Sum, lattice: &CurveLattice<'_>, n: u32) {
    curve_points(sum, lattice);
    if n < 1000 {
        each_of_curve(sum, lattice);
    }
    unit_steps(sum, lattice);
}

#[inline(never)]
fn curve_points(sum: &mut Sum, lattice: &CurveLattice<'_>) {
    for point in CurveLattice::points(lattice).take(20) {
        sum.add(point);
    }
}

#[inline(never)]
fn each_of_curve(sum: &mut Sum, lattice: &CurveLattice<'_>) {
    CurveLattice::for_each(lattice, |point| sum.add(point));
}

#[inline(never)]
fn unit_steps(sum: &mut Sum, lattice: &CurveLattice<'_>) {
    let steps = CurveLattice::unit_steps(lattice);
    sum.add(steps.as_ref().map(|_| ()).map_err(|error| *error));
    if let Ok(steps) = steps {
        for step in steps.take(50) {
            sum.add(step);
        }
    }
}
