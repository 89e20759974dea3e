//! Two patches of any kind, near each other, alike or degenerate: no panic, and no rule of the method is broken.
#![no_main]

#[path = "../../examples/data/workspace.rs"]
mod workspace;

use arbitrary::{Result, Unstructured};
use embedded_surfaces::geometry::{Point3, Vector3};
use embedded_surfaces::intersect::{
    Held, Hit, HitKind, I16F48, IntersectError, IsoCurve, Options, Plane, Room, SpaceCurve, curve_points, intersect,
    project, section,
};
use embedded_surfaces::num::{I16F16, I32F32};
use embedded_surfaces::patch::{
    CurveNet, RationalCurveNet, RationalTensorNet, RationalTriangleNet, SurfaceNet, TensorNet, TriangleNet,
};
use libfuzzer_sys::fuzz_target;
use workspace::Workspace;

struct Patch {
    triangle: bool,
    degrees: (usize, usize),
    points: Vec<Point3>,
    weights: Option<Vec<I16F16>>,
}

impl Patch {
    fn read(u: &mut Unstructured<'_>) -> Result<Self> {
        let triangle = u.ratio(1, 3)?;
        let (m, h) = (u.int_in_range(1..=4)?, u.int_in_range(1..=3)?);
        let count = if triangle { (m + 1) * (m + 2) / 2 } else { (m + 1) * (h + 1) };
        // Whole numbers of one byte meet in special ways; any bits are the rest.
        let whole: bool = u.arbitrary()?;
        let mut c =
            || -> Result<i32> { Ok(if whole { i32::from(u.arbitrary::<i8>()?) << 16 } else { u.arbitrary()? }) };
        let points = (0..count).map(|_| Ok(Point3::from_bits(c()?, c()?, c()?))).collect::<Result<_>>()?;
        let weights = if u.ratio(1, 4)? {
            let weight = |_| Ok(I16F16::from_bits(u.int_in_range(1..=1 << 18)?));
            Some((0..count).map(weight).collect::<Result<_>>()?)
        } else {
            None
        };
        Ok(Self { triangle, degrees: (m, if triangle { m } else { h }), points, weights })
    }

    fn net(&self) -> Option<SurfaceNet<'_>> {
        Some(if self.triangle {
            let net = TriangleNet::new(self.degrees.0, &self.points).ok()?;
            match &self.weights {
                None => SurfaceNet::Triangle(net),
                Some(weights) => SurfaceNet::RationalTriangle(RationalTriangleNet::new(net, weights).ok()?),
            }
        } else {
            let net = TensorNet::new(self.degrees, &self.points).ok()?;
            match &self.weights {
                None => SurfaceNet::Tensor(net),
                Some(weights) => SurfaceNet::RationalTensor(RationalTensorNet::new(net, weights).ok()?),
            }
        })
    }
}

fn check(u: &mut Unstructured<'_>) -> Result<()> {
    let (one, mut two) = (Patch::read(u)?, Patch::read(u)?);
    // Patches that share points, some of them off by a bit.
    for (k, p) in one.points.iter().enumerate() {
        if u.ratio(1, 3)? {
            if let Some(q) = two.points.get_mut(k) {
                *q = *p;
                q.z = q.z.wrapping_add(I16F16::from_bits(u.int_in_range(-1..=1)?));
            }
        }
    }
    let (Some(a), Some(b)) = (one.net(), two.net()) else { return Ok(()) };
    let options = Options::DEFAULT.with_depth(u.int_in_range(3..=5)?).with_budgets(1 << 16, 1 << 8);
    let Ok(room) = Room::new(a, b, options.depth) else { panic!("the depth is legal") };
    let mut workspace = Workspace::new(&room, 1 << 11, 1 << 10, 32);
    let mut normal = [0; 3];
    for c in &mut normal {
        *c = if u.arbitrary()? { i32::from(u.arbitrary::<i8>()?) << 16 } else { u.arbitrary()? };
    }
    let normal = Vector3::from_array(normal.map(I16F16::from_bits));
    // Often through a control point.
    let plane = if u.arbitrary()? {
        Plane::through(one.points[u.choose_index(one.points.len())?], normal)
    } else {
        Plane::new(normal, I32F32::from_bits(u.arbitrary()?))
    };
    for turn in 0..3 {
        let buffers = workspace.buffers();
        let result = match turn {
            0 => intersect(a, b, &options, buffers),
            1 => intersect(b, a, &options, buffers),
            _ => match plane {
                Ok(plane) => section(a, plane, &options, buffers),
                Err(_) => continue,
            },
        };
        assert!(!matches!(result, Err(IntersectError::Internal)), "a rule is broken");
    }
    let buffers = workspace.buffers();
    assert!(project(b, one.points[0], options.depth, buffers.vertices, buffers.boxes).is_ok());
    lines(u, &one, b)
}

/// Curves made of a patch's points, and its iso-parametric curves, against another.
fn lines(u: &mut Unstructured<'_>, one: &Patch, net: SurfaceNet<'_>) -> Result<()> {
    let count = u.int_in_range(2..=9.min(one.points.len()))?;
    let Ok(curve) = CurveNet::new(&one.points[..count]) else { return Ok(()) };
    let held = *u.choose(&[Held::First, Held::Second, Held::Third])?;
    let at = I16F48::from_bits(u.int_in_range(0..=1 << 48)?);
    let weights = one.weights.as_ref().map(|w| RationalCurveNet::new(curve, &w[..count]));
    let iso = one.net().map(|own| IsoCurve::new(own, held, at).ok());
    let curves =
        [Some(SpaceCurve::from(curve)), weights.and_then(|w| w.ok()).map(Into::into), iso.flatten().map(Into::into)];
    for curve in curves.into_iter().flatten() {
        let mut room = [Hit::BLANK; 64];
        let Ok(hits) = curve_points(curve, net, &mut room) else { continue };
        assert!(hits.points().is_sorted_by_key(|hit| hit.t), "out of order");
        let touches = hits.points().iter().filter(|hit| hit.kind == HitKind::Touching).count();
        assert!(touches == 0 || !hits.is_certified(), "a touch is certain");
    }
    Ok(())
}

fuzz_target!(|data: &[u8]| {
    let _ = check(&mut Unstructured::new(data));
});
