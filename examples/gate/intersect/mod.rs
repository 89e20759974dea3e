//! Intersections of every kind of pair at the least depth, sections, curves, nearest points.

use super::{Digest, Sum, data, hide};
use embedded_surfaces::geometry::{Axis, Point3, Vector3};
use embedded_surfaces::intersect::{
    Branch, Buffers, Curve, CurveKind, CurvePoint, End, Held, Hit, HitKind, Hits, I16F48, I20F44, IntersectError,
    Intersection, IsoCurve, MIN_DEPTH, Options, Plane, Projection, Room, SpaceCurve, curve_points, intersect, project,
    section,
};
use embedded_surfaces::num::{I16F16, I32F32};
use embedded_surfaces::patch::{
    BicubicPatch, BilinearPatch, CubicTriangle, Curve as Line, RationalCurve, Surface, SurfaceNet,
};

static SHEET: BicubicPatch = embedded_surfaces::const_net!(BicubicPatch::from_ints([
    [[0, 0, 0], [0, 20, 9], [0, 40, 9], [0, 60, 0]],
    [[20, 0, 9], [20, 20, 40], [20, 40, 40], [20, 60, 9]],
    [[40, 0, 9], [40, 20, 40], [40, 40, 40], [40, 60, 9]],
    [[60, 0, 0], [60, 20, 9], [60, 40, 9], [60, 60, 0]],
]));
static FLOOR: BilinearPatch = embedded_surfaces::const_net!(BilinearPatch::from_ints([
    [[5, -9, 12], [-8, 70, 15]],
    [[70, -5, 11], [68, 70, 14]]
]));
static LEAF: CubicTriangle = embedded_surfaces::const_net!(CubicTriangle::from_ints([
    [50, 30, 40],
    [40, 25, 20],
    [40, 40, 30],
    [20, 20, 10],
    [25, 30, 5],
    [25, 45, 20],
    [9, 15, 0],
    [10, 25, 30],
    [12, 40, 12],
    [10, 50, 20],
]));

/// What the calls work in: 12 KB.
struct Work {
    vertices: [[i32; 3]; 162],
    boxes: [[[i32; 3]; 2]; 42],
    records: [u64; 200],
    links: [u32; 200],
    points: [CurvePoint; 60],
    curves: [Curve; 8],
    branches: [Branch; 2],
}

impl Work {
    const fn new() -> Self {
        Self {
            vertices: [[0; 3]; 162],
            boxes: [[[0; 3]; 2]; 42],
            records: [0; 200],
            links: [0; 200],
            points: [CurvePoint::BLANK; 60],
            curves: [Curve::BLANK; 8],
            branches: [Branch::BLANK; 2],
        }
    }

    fn buffers(&mut self) -> Buffers<'_> {
        Buffers {
            vertices: &mut self.vertices,
            boxes: &mut self.boxes,
            records: &mut self.records,
            links: &mut self.links,
            points: &mut self.points,
            curves: &mut self.curves,
            branches: &mut self.branches,
        }
    }
}

impl Digest for CurvePoint {
    fn digest(&self, sum: &mut Sum) {
        let parameters = self.parameters.as_flattened();
        parameters.iter().for_each(|p| p.to_bits().digest(sum));
        self.position.to_array().map(I20F44::to_bits).digest(sum);
        self.tangent.to_array().map(|c| c.to_bits()).digest(sum);
        [self.sine.to_bits(), self.residual.to_bits() as i32].digest(sum);
    }
}

impl Digest for Hit {
    fn digest(&self, sum: &mut Sum) {
        [self.kind == HitKind::Touching, self.kind == HitKind::Begin].digest(sum);
        [self.t, self.parameters[0], self.parameters[1]].map(|p| p.to_bits()).digest(sum);
        self.position.to_array().map(I20F44::to_bits).digest(sum);
        self.tangent.to_array().map(|c| c.to_bits()).digest(sum);
        [self.sine.to_bits(), self.residual.to_bits() as i32].digest(sum);
    }
}

impl Digest for Hits<'_> {
    fn digest(&self, sum: &mut Sum) {
        Hits::points(self).digest(sum);
        Hits::is_certified(self).digest(sum);
    }
}

impl Digest for Projection {
    fn digest(&self, sum: &mut Sum) {
        self.parameters.map(|p| p.to_bits()).digest(sum);
        self.position.to_array().map(I20F44::to_bits).digest(sum);
        self.distance.to_bits().digest(sum);
    }
}

impl Digest for Intersection<'_> {
    fn digest(&self, sum: &mut Sum) {
        for curve in Intersection::curves(self) {
            [curve.kind == CurveKind::Closed, curve.closed, curve.ends == [End::None; 2]].digest(sum);
            curve.length.to_bits().digest(sum);
            Intersection::points(self, curve).digest(sum);
        }
        for branch in Intersection::branches(self) {
            Branch::arms(branch).digest(sum);
            branch.point.digest(sum);
        }
        [self.undecided, self.zero_predicates, self.degenerate_triangles].digest(sum);
        [self.perturbation_sensitive, Intersection::is_certified(self)].digest(sum);
    }
}

fn options() -> Options {
    let coarse = I20F44::from_bits(hide(1 << 38));
    let options = Options::with_tolerance(Options::with_depth(Options::DEFAULT, hide(MIN_DEPTH)), coarse);
    Options::with_budgets(options, hide(1 << 16), hide(1 << 10))
}

pub(super) fn calls(sum: &mut Sum) {
    let mut work = Work::new();
    let work = &mut work;
    let nets: [SurfaceNet<'_>; 3] = hide([SHEET.surface(), FLOOR.surface(), LEAF.surface()]);
    sum.add(intersect(nets[0], hide(&data::OCTANT).surface(), &options(), work.buffers()));
    sum.add(intersect(nets[1], hide(&data::WEIGHTED).surface(), &options(), work.buffers()));
    let [one, two, three] = nets;
    for [a, b] in [[one, two], [two, three], [one, three], [one, one]] {
        let result: Result<Intersection<'_>, IntersectError> = intersect(a, b, &options(), work.buffers());
        sum.add(result);
    }
    let room = Room::new(nets[0], nets[1], hide(MIN_DEPTH));
    sum.add(room.map(|room| [room.vertices, room.boxes].map(|n| n as u32)));
    sum.add(Room::new(nets[0], nets[1], hide(9)).map(|_| 0_u8));
    sum.add(Room::of_section(nets[2], hide(MIN_DEPTH)).map(|room| room.vertices as u32));
    sum.add(intersect(
        nets[0],
        hide(&data::OCTANT).surface(),
        &Options::with_depth(options(), hide(2)),
        work.buffers(),
    ));
    for plane in planes() {
        sum.add(plane.and_then(|plane| section(nets[0], plane, &options(), work.buffers())));
    }
    let point = hide(Point3::from_ints(20, 30, 90));
    sum.add(project(nets[2], point, MIN_DEPTH, &mut work.vertices, &mut work.boxes));
    lines(sum, nets);
}

/// Across an axis, by numbers, through a point, oblique; one without a normal.
fn planes() -> [Result<Plane, IntersectError>; 5] {
    let normal = hide(Vector3::new(I16F16::from_bits(-9000), I16F16::from_bits(30_000), I16F16::from_bits(70_000)));
    [
        Ok(Plane::across(Axis::Z, I16F16::from_num(hide(17)))),
        Plane::from_ints(hide([1, -2, 2]), hide(20)),
        Plane::through(hide(Point3::from_ints(30, 30, 25)), normal),
        Plane::new(normal, hide(I32F32::from_bits(28 << 32))),
        Plane::from_ints(hide([0; 3]), hide(1)),
    ]
}

/// Curves of every kind against surfaces of every kind.
fn lines(sum: &mut Sum, nets: [SurfaceNet<'_>; 3]) {
    let Ok(line) = Line::<3>::from_ints(hide([[10, 10, -40], [30, 20, 50], [50, 40, -20]])) else { return };
    let Ok(weighted) = RationalCurve::new(line, hide([1, 2, 1].map(I16F16::from_num))) else { return };
    let iso = |net, held| IsoCurve::new(net, held, I16F48::from_bits(hide(3 << 46)));
    let curves = [
        Ok(SpaceCurve::from(line.net())),
        Ok(SpaceCurve::from(weighted.net())),
        iso(nets[0], Held::First).map(SpaceCurve::from),
        iso(nets[0], Held::Second).map(SpaceCurve::from),
        iso(nets[2], Held::Third).map(SpaceCurve::from),
        iso(nets[0], Held::Third).map(SpaceCurve::from),
    ];
    let octant = hide(&data::OCTANT).surface();
    let weighted = hide(&data::WEIGHTED).surface();
    for net in [nets[0], nets[1], nets[2], octant, weighted] {
        for curve in curves {
            let mut points = [Hit::BLANK; 8];
            sum.add(curve.and_then(|curve| curve_points(curve, net, &mut points)));
        }
    }
}
