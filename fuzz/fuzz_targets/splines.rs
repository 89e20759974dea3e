//! Knots, weights, strokes and styles of any kind: constructors refuse or everything after them works.
#![no_main]

use arbitrary::Unstructured;
use embedded_surfaces::geometry::Point3;
use embedded_surfaces::graphics::BezierCurve;
use embedded_surfaces::num::I16F16;
use embedded_surfaces::patch::{
    BSplineCurve, BSplineSurface, KnotVector, NurbsCurve, NurbsSurface, RationalTensor, Surface, SurfaceNet,
};
use embedded_surfaces::render::{Area, Fragment, Gloss, Light, Lines, Scene, Style, Tile};
use libfuzzer_sys::fuzz_target;

fn numbers(u: &mut Unstructured<'_>, most: usize) -> arbitrary::Result<Vec<I16F16>> {
    let count = u.int_in_range(0..=most)?;
    // Small whole numbers make legal knots; any bits make the rest.
    let whole: bool = u.arbitrary()?;
    let mut out = Vec::new();
    for _ in 0..count {
        out.push(I16F16::from_bits(if whole { i32::from(u.int_in_range(0_u8..=9)?) << 16 } else { u.arbitrary()? }));
    }
    if u.arbitrary()? {
        out.sort_unstable();
    }
    Ok(out)
}

fn points(u: &mut Unstructured<'_>, count: usize) -> arbitrary::Result<Vec<Point3>> {
    let small: bool = u.arbitrary()?;
    let mut c =
        || -> arbitrary::Result<i32> { Ok(if small { i32::from(u.arbitrary::<i16>()?) << 8 } else { u.arbitrary()? }) };
    (0..count).map(|_| Ok(Point3::from_bits(c()?, c()?, c()?))).collect()
}

fn curve<const K: usize>(u: &mut Unstructured<'_>) -> arbitrary::Result<()> {
    let knots = numbers(u, 24)?;
    let Ok(vector) = KnotVector::<K>::new(&knots) else { return Ok(()) };
    let points = points(u, vector.points())?;
    let weights = numbers(u, 24)?;
    let Ok(spline) = BSplineCurve::new(&points, vector) else { return Ok(()) };
    for piece in spline.pieces() {
        if let Ok(curve) = BezierCurve::new(&piece) {
            assert!(curve.points().take(500).count() > 0);
        }
    }
    if let Ok(nurbs) = NurbsCurve::new(spline, &weights) {
        assert_eq!(nurbs.pieces().count(), vector.pieces());
    }
    Ok(())
}

fn surface(u: &mut Unstructured<'_>) -> arbitrary::Result<()> {
    let (by_r, by_s) = (numbers(u, 8)?, numbers(u, 8)?);
    let (Ok(r), Ok(s)) = (KnotVector::<3>::new(&by_r), KnotVector::<3>::new(&by_s)) else { return Ok(()) };
    let points = points(u, r.points() * s.points())?;
    let weights = numbers(u, 25)?;
    let Ok(spline) = BSplineSurface::new(&points, r, s) else { return Ok(()) };
    let pieces: Vec<RationalTensor<3, 3>> = match NurbsSurface::new(spline, &weights) {
        Ok(nurbs) => nurbs.pieces().collect(),
        Err(_) => return Ok(()),
    };
    let nets: Vec<SurfaceNet<'_>> = pieces.iter().map(Surface::surface).collect();
    let lines = Lines { intervals: u.int_in_range(0..=3)?, hidden: u.arbitrary()? };
    let styles = [
        Style::Shaded,
        Style::Glossy(Gloss::new(u.arbitrary()?, u.arbitrary()?)),
        Style::DepthCued { near: u.arbitrary()?, far: u.arbitrary()? },
        Style::Wire(lines),
        Style::Net { hidden: u.arbitrary()? },
        Style::Normals { lines, length: u.arbitrary()? },
    ];
    let light = Light::towards(u.arbitrary()?, u.arbitrary()?, u.arbitrary()?, u.arbitrary()?).unwrap_or_default();
    let Ok(scene) = Scene::new(&nets, light, *u.choose(&styles)?) else { return Ok(()) };
    // Only what a few thousand points can draw.
    let small = |area: Area| area.width <= 60 && area.height <= 60;
    if scene.area().is_some_and(small) {
        let (mut colour, mut depth) = ([0_u8; 64 * 64], [0; 64 * 64]);
        let area = Area { x: u.int_in_range(-40..=40)?, y: u.int_in_range(-40..=40)?, width: 64, height: 64 };
        if let Ok(mut tile) = Tile::new(area, &mut colour, &mut depth, 0) {
            scene.draw(&mut tile, &|at: Fragment| at.shade);
        }
    }
    Ok(())
}

fuzz_target!(|data: &[u8]| {
    let mut u = Unstructured::new(data);
    let _ = match u.int_in_range(0..=3) {
        Ok(0) => curve::<2>(&mut u),
        Ok(1) => curve::<4>(&mut u),
        Ok(2) => curve::<9>(&mut u),
        _ => surface(&mut u),
    };
});
