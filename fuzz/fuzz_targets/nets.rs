//! Nets of every kind from arbitrary bytes, legal or not, through every call that takes them: nothing panics, and
//! what comes out agrees with itself (walk and iterator, lattice and exact evaluation, points and bounds).
#![no_main]

use arbitrary::{Result, Unstructured};
use embedded_surfaces::forward::{CurveLattice, CurvePoint, Lattice, LatticePoint, RowStep, Steps};
use embedded_surfaces::geometry::{Affine, Perspective, Point3, View};
use embedded_surfaces::num::{Angle, Coord, I16F16, I32F32};
use embedded_surfaces::patch::{
    Barycentric, Curve, CurveNet, MAX_DEGREE, Parameter, RationalCurve, RationalTensor, RationalTriangle, Surface,
    SurfaceNet, Tensor, TensorNet, Triangle, TriangleNet,
};
use std::hint::black_box;

/// Lattices of more points are planned, but only begun.
const MAX_POINTS: u64 = 3000;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    // Short input is an `Err` of `arbitrary`, which is fine.
    let _ = run(&mut Unstructured::new(bytes));
});

fn run(u: &mut Unstructured<'_>) -> Result<()> {
    // Owned nets are generic over degrees: the ends of the range, the common ones, and unequal ones.
    match u.int_in_range(0..=16)? {
        0 => views::<I16F16>(u),
        1 => views::<I32F32>(u),
        2 => tensor::<2, 2>(u),
        3 => tensor::<4, 4>(u),
        4 => tensor::<2, 9>(u),
        5 => tensor::<6, 3>(u),
        6 => tensor::<9, 9>(u),
        7 => triangle::<1, 3>(u),
        8 => triangle::<3, 10>(u),
        9 => triangle::<5, 21>(u),
        10 => triangle::<8, 45>(u),
        11 => curve::<2>(u),
        12 => curve::<4>(u),
        13 => curve::<9>(u),
        14 => views_of_geometry(u),
        15 => wide_tensor(u),
        _ => wide_triangle(u),
    }
}

// What bytes become.

/// A coordinate type that can be drawn.
trait Draw: Coord {
    fn draw(u: &mut Unstructured<'_>, zeros: u32) -> Result<Self>;
}

impl Draw for I16F16 {
    fn draw(u: &mut Unstructured<'_>, zeros: u32) -> Result<Self> {
        Ok(Self::from_bits(u.arbitrary::<i32>()? >> zeros / 2 << zeros))
    }
}

impl Draw for I32F32 {
    fn draw(u: &mut Unstructured<'_>, zeros: u32) -> Result<Self> {
        // Five bits fewer are just legal.
        Ok(Self::from_bits(u.arbitrary::<i64>()? >> (zeros % 8) << zeros))
    }
}

/// Points whose coordinates have a common number of trailing zeros: the budget depends on it.
fn points<C: Draw>(u: &mut Unstructured<'_>, count: usize) -> Result<Vec<Point3<C>>> {
    let zeros = u.int_in_range(0..=16)?;
    let mut point = || Ok(Point3::new(C::draw(u, zeros)?, C::draw(u, zeros)?, C::draw(u, zeros)?));
    (0..count).map(|_| point()).collect()
}

fn array<C: Draw, const N: usize>(u: &mut Unstructured<'_>) -> Result<[Point3<C>; N]> {
    points(u, N)?.try_into().map_err(|_| arbitrary::Error::IncorrectFormat)
}

fn grid<C: Draw, const M: usize, const H: usize>(u: &mut Unstructured<'_>) -> Result<[[Point3<C>; H]; M]> {
    let rows: Result<Vec<_>> = (0..M).map(|_| array(u)).collect();
    rows?.try_into().map_err(|_| arbitrary::Error::IncorrectFormat)
}

/// Mostly positive, often small.
fn weights<const N: usize>(u: &mut Unstructured<'_>) -> Result<[I16F16; N]> {
    let mut weights = [I16F16::ONE; N];
    if u.arbitrary()? {
        for weight in &mut weights {
            *weight = I16F16::from_bits(u.arbitrary::<i32>()? >> u.int_in_range(0..=31)?);
        }
    }
    Ok(weights)
}

/// Any number, small ones more often.
fn number(u: &mut Unstructured<'_>) -> Result<u32> {
    Ok(u.arbitrary::<u32>()? >> u.int_in_range(0..=31)?)
}

fn parameter(u: &mut Unstructured<'_>) -> Result<Option<Parameter>> {
    Ok(legal(Parameter::new(number(u)?, number(u)?)))
}

fn barycentric(u: &mut Unstructured<'_>) -> Result<Option<Barycentric>> {
    Ok(legal(Barycentric::new(number(u)?, number(u)?, number(u)?)))
}

fn affine(u: &mut Unstructured<'_>) -> Result<Affine> {
    let shift = u.int_in_range(0..=63)?;
    let mut rows = [[I32F32::ZERO; 4]; 3];
    for entry in rows.as_flattened_mut() {
        *entry = I32F32::from_bits(u.arbitrary::<i64>()? >> shift);
    }
    Ok(Affine { rows })
}

/// The value, after its error was formatted if it is one.
fn legal<T, E: std::error::Error>(result: std::result::Result<T, E>) -> Option<T> {
    result.inspect_err(|error| assert!(!format!("{error} {error:?}").is_empty())).ok()
}

// Views with the degree erased, from any degree and any number of points.

fn views<C: Draw>(u: &mut Unstructured<'_>) -> Result<()> {
    let (m, h) = (usize::from(u.arbitrary::<u8>()?), usize::from(u.arbitrary::<u8>()?));
    let count = match u.int_in_range(0..=3)? {
        0 => usize::from(u.arbitrary::<u8>()?),
        1 => (m + 1) * (h + 1),
        2 => (m + 1) * (m + 2) / 2,
        _ => m + 1,
    };
    let points = points::<C>(u, count.min(100))?;
    // Degrees near usize::MAX must not overflow a count either.
    let huge = if u.arbitrary()? { usize::MAX - m } else { m };
    black_box((legal(TensorNet::new((huge, h), &points)), legal(TensorNet::new((h, huge), &points))));
    black_box(legal(TriangleNet::new(huge, &points)));
    if let Some(net) = legal(TensorNet::new((m, h), &points)) {
        check_tensor_net(u, net)?;
    }
    if let Some(net) = legal(TriangleNet::new(m, &points)) {
        check_triangle_net(u, net)?;
    }
    if let Some(net) = legal(CurveNet::new(&points)) {
        check_curve_net(u, net)?;
    }
    Ok(())
}

fn check_curve_net<C: Draw>(u: &mut Unstructured<'_>, net: CurveNet<'_, C>) -> Result<()> {
    if let Some(t) = parameter(u)? {
        let p = net.eval(t);
        assert_eq!(net.blossom(&vec![t; net.degree()]), Ok(p));
        black_box(net.derivative(t));
    }
    let many: Result<Vec<_>> = (0..u.int_in_range(0..=MAX_DEGREE + 1)?).map(|_| parameter(u)).collect();
    black_box(legal(net.blossom(&many?.into_iter().flatten().collect::<Vec<_>>())));
    Ok(())
}

fn check_triangle_net<C: Draw>(u: &mut Unstructured<'_>, net: TriangleNet<'_, C>) -> Result<()> {
    if let Some(at) = barycentric(u)? {
        let p = net.eval(at);
        assert_eq!(net.blossom(&vec![at; net.degree()]), Ok(p));
        assert_within(p, SurfaceNet::Triangle(net));
        black_box(net.partials(at));
    }
    let many: Result<Vec<_>> = (0..u.int_in_range(0..=MAX_DEGREE + 1)?).map(|_| barycentric(u)).collect();
    black_box(legal(net.blossom(&many?.into_iter().flatten().collect::<Vec<_>>())));
    Ok(())
}

fn check_tensor_net<C: Draw>(u: &mut Unstructured<'_>, net: TensorNet<'_, C>) -> Result<()> {
    if let (Some(r), Some(s)) = (parameter(u)?, parameter(u)?) {
        let (p, (m, h)) = (net.eval(r, s), net.degrees());
        assert_eq!(net.blossom(&vec![r; m], &vec![s; h]), Ok(p));
        assert_within(p, SurfaceNet::Tensor(net));
        black_box((net.partials(r, s), legal(net.blossom(&vec![r; h], &vec![s; m]))));
    }
    Ok(())
}

fn assert_within<C: Coord>(p: Point3<C>, net: SurfaceNet<'_, C>) {
    let b = net.bounds();
    let inside = [(p.x, b.min.x, b.max.x), (p.y, b.min.y, b.max.y), (p.z, b.min.z, b.max.z)];
    assert!(inside.iter().all(|(c, low, high)| low <= c && c <= high), "{p:?} is outside {b:?}");
}

// Lattices.

fn check_surface(u: &mut Unstructured<'_>, net: SurfaceNet<'_>) -> Result<()> {
    let steps = match u.int_in_range(0..=3)? {
        0 => Some(Steps::paper(net)),
        1 => Some(Steps::hole_free(net)),
        2 => legal(Steps::uniform(number(u)?)),
        _ => legal(Steps::new(number(u)?, number(u)?)),
    };
    let Some(lattice) = steps.and_then(|steps| legal(Lattice::new(net, steps))) else { return Ok(()) };
    if steps == Some(Steps::paper(net)) {
        assert!(lattice.row_steps().is_ok());
    }
    let count = lattice.point_count();
    let iterated: Vec<_> = lattice.points().take(MAX_POINTS as usize).collect();
    assert_eq!(iterated.len() as u64, count.min(MAX_POINTS));
    assert_eq!(lattice.points().size_hint().0 as u64, count);
    if count <= MAX_POINTS {
        let mut rest = lattice.points();
        let mut at = 0;
        lattice.for_each(|p| {
            assert_eq!(rest.size_hint().0 as u64, count - at as u64);
            assert_eq!((Some(p), p), (rest.next(), iterated[at]));
            at += 1;
        });
        assert_eq!((at as u64, rest.next(), rest.next()), (count, None, None));
    }
    if !iterated.is_empty() {
        let chosen = iterated[u.choose_index(iterated.len())?];
        assert_exact(net, lattice.steps(), chosen);
    }
    if let Some(steps) = legal(lattice.row_steps()) {
        replay(steps.take(MAX_POINTS as usize), &iterated);
    }
    Ok(())
}

/// The lattice rounds the surface once; `eval` to 2^-16 first. They differ by half a unit and a half of 2^-16.
fn assert_exact(net: SurfaceNet<'_>, (r, s): (u32, u32), p: LatticePoint) {
    let exact = match net {
        SurfaceNet::Triangle(t) => Barycentric::new(p.i, p.j, r - p.i - p.j).map(|at| t.eval(at)),
        SurfaceNet::Tensor(t) => Parameter::new(p.i, r).and_then(|i| Ok(t.eval(i, Parameter::new(p.j, s)?))),
        SurfaceNet::RationalTriangle(t) => Barycentric::new(p.i, p.j, r - p.i - p.j).map(|at| t.eval(at)),
        SurfaceNet::RationalTensor(t) => Parameter::new(p.i, r).and_then(|i| Ok(t.eval(i, Parameter::new(p.j, s)?))),
    };
    // Steps beyond 2^16 have no parameter.
    let Ok(exact) = exact else { return };
    for (exact, ours) in exact.to_array().into_iter().zip([p.x, p.y, p.z]) {
        let difference = exact.bits() - (i64::from(ours) << 16);
        assert!((-(1 << 15)..=1 << 15).contains(&difference), "{p:?}: {exact}");
    }
}

fn replay(steps: impl Iterator<Item = RowStep>, points: &[LatticePoint]) {
    let mut pen = [0; 3];
    for (step, p) in steps.zip(points) {
        match step {
            RowStep::Start(q) => pen = [q.x, q.y, q.z],
            RowStep::Step(d) => pen = core::array::from_fn(|axis| pen[axis] + i32::from(d[axis])),
        }
        assert_eq!(pen, [p.x, p.y, p.z]);
    }
}

fn check_curve(u: &mut Unstructured<'_>, net: CurveNet<'_>) -> Result<()> {
    let enough = Steps::curve(net);
    let n = if u.arbitrary()? { enough } else { number(u)? };
    let Some(lattice) = legal(CurveLattice::new(net, n)) else { return Ok(()) };
    let points: Vec<CurvePoint> = lattice.points().take(MAX_POINTS as usize).collect();
    assert_eq!(points.len() as u64, MAX_POINTS.min(u64::from(n) + 1));
    if u64::from(n) < MAX_POINTS {
        let mut walked = Vec::new();
        lattice.for_each(|p| walked.push(p));
        assert_eq!(walked, points);
    }
    let steps = legal(lattice.unit_steps());
    assert!(n != enough || steps.is_some());
    for (step, pair) in steps.into_iter().flatten().zip(points.windows(2)) {
        let moved = [pair[1].x - pair[0].x, pair[1].y - pair[0].y, pair[1].z - pair[0].z];
        assert_eq!([step.x, step.y, step.z].map(i32::from), moved);
    }
    Ok(())
}

// Nets that own their points.

fn perspective(u: &mut Unstructured<'_>) -> Result<Perspective> {
    let [x, y, distance] = [u.arbitrary()?, u.arbitrary()?, u.arbitrary()?].map(I16F16::from_bits);
    Ok(Perspective { centre_x: x, centre_y: y, distance })
}

fn tensor<const M: usize, const H: usize>(u: &mut Unstructured<'_>) -> Result<()> {
    let points = grid(u)?;
    black_box(legal(Tensor::from_power(&points)));
    let Some(net) = legal(Tensor::<M, H>::new(points)) else { return Ok(()) };
    check_surface(u, net.surface())?;
    check_tensor_net(u, net.net())?;
    black_box((legal(net.elevate::<9, 9>()), legal(net.elevate::<3, 3>()), net.bounds()));
    if let Some(moved) = legal(net.transform(&affine(u)?)) {
        check_surface(u, moved.surface())?;
    }
    black_box(legal(net.perspective(&perspective(u)?)));
    let flat: [I16F16; 81] = weights(u)?;
    let weights = core::array::from_fn(|i| core::array::from_fn(|j| flat[i * H + j]));
    let rational = legal(RationalTensor::new(net, weights));
    if let (Some(net), Some(r), Some(s)) = (rational, parameter(u)?, parameter(u)?) {
        assert_within(net.net().eval(r, s), SurfaceNet::RationalTensor(net.net()));
        black_box((net.net().partials(r, s), legal(net.transform(&affine(u)?))));
    }
    Ok(())
}

fn triangle<const N: usize, const LEN: usize>(u: &mut Unstructured<'_>) -> Result<()> {
    let Some(net) = legal(Triangle::<N, LEN>::new(array(u)?)) else { return Ok(()) };
    check_surface(u, net.surface())?;
    check_triangle_net(u, net.net())?;
    let [i, j, k] = [number(u)?, number(u)?, number(u)?].map(|n| n as usize);
    black_box((net.point(i, j, k), net.point(usize::MAX - i, j, k)));
    black_box((legal(net.elevate::<8, 45>()), legal(net.elevate::<2, 6>()), net.bounds()));
    if let Some(moved) = legal(net.transform(&affine(u)?)) {
        check_surface(u, moved.surface())?;
    }
    black_box(legal(net.perspective(&perspective(u)?)));
    if let (Some(net), Some(at)) = (legal(RationalTriangle::new(net, weights(u)?)), barycentric(u)?) {
        assert_within(net.net().eval(at), SurfaceNet::RationalTriangle(net.net()));
        black_box((net.net().partials(at), legal(net.transform(&affine(u)?))));
    }
    Ok(())
}

fn curve<const K: usize>(u: &mut Unstructured<'_>) -> Result<()> {
    let points = array(u)?;
    black_box(legal(Curve::from_power(&points)));
    let Some(net) = legal(Curve::<K>::new(points)) else { return Ok(()) };
    check_curve(u, net.net())?;
    check_curve_net(u, net.net())?;
    black_box((legal(net.elevate::<9>()), legal(net.elevate::<3>()), net.bounds()));
    black_box((legal(net.transform(&affine(u)?)), legal(net.perspective(&perspective(u)?))));
    if let (Some(net), Some(t)) = (legal(RationalCurve::new(net, weights(u)?)), parameter(u)?) {
        black_box((net.net().eval(t), net.net().derivative(t), legal(net.transform(&affine(u)?))));
    }
    Ok(())
}

// I32F32, the ends of the range of `num::wide` included.

fn wide_tensor(u: &mut Unstructured<'_>) -> Result<()> {
    let points = grid(u)?;
    black_box(legal(Tensor::from_power(&points)));
    let Some(net) = legal(Tensor::<9, 9, I32F32>::new(points)) else { return Ok(()) };
    black_box((legal(net.round()), legal(net.elevate::<9, 9>()), legal(net.transform(&affine(u)?))));
    let flat: [I16F16; 81] = weights(u)?;
    let weights = core::array::from_fn(|i| core::array::from_fn(|j| flat[i * 9 + j]));
    let rational = legal(RationalTensor::new(net, weights));
    if let (Some(net), Some(r), Some(s)) = (rational, parameter(u)?, parameter(u)?) {
        assert_within(net.net().eval(r, s), SurfaceNet::RationalTensor(net.net()));
        black_box(net.net().partials(r, s));
    }
    Ok(())
}

fn wide_triangle(u: &mut Unstructured<'_>) -> Result<()> {
    let Some(net) = legal(Triangle::<5, 21, I32F32>::new(array(u)?)) else { return Ok(()) };
    black_box((legal(net.round()), legal(net.elevate::<8, 45>()), legal(net.transform(&affine(u)?))));
    if let (Some(net), Some(at)) = (legal(RationalTriangle::new(net, weights(u)?)), barycentric(u)?) {
        assert_within(net.net().eval(at), SurfaceNet::RationalTriangle(net.net()));
        black_box(net.net().partials(at));
    }
    Ok(())
}

// Points and maps.

fn views_of_geometry(u: &mut Unstructured<'_>) -> Result<()> {
    let (a, b) = (affine(u)?, affine(u)?);
    let view = View { tilt: Angle::from_binary(u.arbitrary()?), spin: Angle::from_degrees(u.arbitrary()?) };
    let (fixed, wide) = (points::<I16F16>(u, 3)?, points::<I32F32>(u, 3)?);
    let fit = I16F16::from_bits(u.arbitrary()?);
    let (width, height) = (number(u)?, number(u)?);
    let maps = [legal(a.then(&b)), legal(view.rotation()), legal(view.fit(&fixed, width, height, fit))];
    let eye = perspective(u)?;
    for map in maps.into_iter().flatten().chain([a, b]) {
        for p in &fixed {
            black_box((legal(map.apply(p)), legal(map.apply_into::<_, I32F32>(p)), legal(eye.project(p))));
        }
        for p in &wide {
            black_box((legal(map.apply(p)), legal(map.apply_into::<_, I16F16>(p)), p.round()));
        }
    }
    black_box(legal(view.fit(&wide, width, height, fit)));
    Ok(())
}
