//! Back faces: which pieces look away from the viewer everywhere.
//!
//! S_r is a positive combination of net differences along r, S_s of those along s (of a rational patch: of the
//! differences of all points of neighbouring rows and columns, because weights mix them). If the first lie in one plane
//! cone, the second in another, and no ray of the one turns the wrong way into a ray of the other, the z component of
//! S_r × S_s has one sign on the whole piece.

use crate::geometry::Point3;
use crate::patch::{SurfaceNet, triangle_index};

/// A vector in the plane of the screen, in 2^-16.
type Vector = [i32; 2];

/// Vectors beyond this are not looked at: 16384 pixels. Sums of two products then fit 63 bits.
const LONGEST: u32 = 1 << 30;

/// The vector from one point to another; a component of 2^31 stands for those that do not fit.
fn between(from: &Point3, to: &Point3) -> Vector {
    let gap = |a: i32, b: i32| b.checked_sub(a).unwrap_or(i32::MIN);
    [gap(from.x.to_bits(), to.x.to_bits()), gap(from.y.to_bits(), to.y.to_bits())]
}

fn times(a: i32, b: i32) -> i64 {
    i64::from(a) * i64::from(b)
}

fn cross(a: Vector, b: Vector) -> i64 {
    times(a[0], b[1]) - times(a[1], b[0])
}

fn dot(a: Vector, b: Vector) -> i64 {
    times(a[0], b[0]) + times(a[1], b[1])
}

/// All α·right + β·left with α, β ≥ 0: less than half a turn from the one to the other.
#[derive(Clone, Copy, Debug)]
struct Cone {
    right: Vector,
    left: Vector,
}

impl Cone {
    /// A cone that holds all vectors of `each`, which are not all zero; `None` where none was found.
    fn around<I: Iterator<Item = Vector>>(each: impl Fn() -> I) -> Option<Self> {
        let mut cone: Option<Self> = None;
        for v in each() {
            if v[0].unsigned_abs() >= LONGEST || v[1].unsigned_abs() >= LONGEST {
                return None;
            }
            let Some(Self { right, left }) = &mut cone else {
                cone = (v != [0; 2]).then_some(Self { right: v, left: v });
                continue;
            };
            if cross(*left, v) > 0 {
                *left = v;
            } else if cross(v, *right) > 0 {
                *right = v;
            }
        }
        let cone = cone.filter(Self::is_less_than_half)?;
        each().all(|v| cone.holds(v)).then_some(cone)
    }

    fn is_less_than_half(&self) -> bool {
        let turn = cross(self.right, self.left);
        turn > 0 || (turn == 0 && dot(self.right, self.left) > 0)
    }

    fn holds(&self, v: Vector) -> bool {
        let (from_right, to_left) = (cross(self.right, v), cross(v, self.left));
        from_right >= 0 && to_left >= 0 && (from_right > 0 || to_left > 0 || dot(self.right, v) >= 0)
    }

    /// The signs of `a × b` over both cones: (never negative, never positive).
    fn signs(&self, other: &Self) -> (bool, bool) {
        let corners = [
            cross(self.right, other.right),
            cross(self.right, other.left),
            cross(self.left, other.right),
            cross(self.left, other.left),
        ];
        (corners.iter().all(|c| *c >= 0), corners.iter().all(|c| *c <= 0))
    }
}

/// The differences along r, or along s: of a triangle along u and v, both from w.
fn differences<'n>(net: &SurfaceNet<'n>, along_s: bool) -> impl Iterator<Item = Vector> + 'n {
    let (points, (m, h), triangle) = (net.points(), net.degrees(), net.is_triangle());
    let mixes = net.weights().is_some();
    let (across, last) = if along_s || triangle { (m, h) } else { (h, m) };
    let mixed = if mixes { across + 1 } else { 1 };
    let index = move |a: usize, b: usize| if along_s { b * (h + 1) + a } else { a * (h + 1) + b };
    let pair = move |a: usize, b: usize, c: usize| {
        let (from, to) = if triangle {
            let from = triangle_index(a - b, b + 1);
            (from, if along_s { triangle_index(a + 1 - b, b) } else { triangle_index(a - b, b) })
        } else {
            (index(a, b), index(a + 1, if mixes { c } else { b }))
        };
        Some(between(points.get(from)?, points.get(to)?))
    };
    let width = move |a: usize| if triangle { a } else { across };
    (0..last).flat_map(move |a| (0..=width(a)).flat_map(move |b| (0..mixed).filter_map(move |c| pair(a, b, c))))
}

/// The cones of both directions.
fn cones(net: &SurfaceNet<'_>) -> Option<(Cone, Cone)> {
    if let (SurfaceNet::Tensor(net), Some(points)) = (net, net.points().first_chunk::<16>())
        && net.degrees() == (3, 3)
    {
        let along_r: [Vector; 12] = core::array::from_fn(|k| between(&points[k & 15], &points[(k + 4) & 15]));
        let along_s: [Vector; 12] = core::array::from_fn(|k| {
            let from = k + k / 3;
            between(&points[from & 15], &points[(from + 1) & 15])
        });
        return Cone::around(|| along_r.iter().copied()).zip(Cone::around(|| along_s.iter().copied()));
    }
    Cone::around(|| differences(net, false)).zip(Cone::around(|| differences(net, true)))
}

/// Whether no point of a piece faces the viewer: z of S_r × S_s is nowhere negative, or nowhere positive where that
/// normal points inwards. Where the cones are too wide to tell, and for rational triangles, the answer is no.
pub(super) fn faces_away(net: &SurfaceNet<'_>, inward: bool) -> bool {
    if net.is_triangle() && net.weights().is_some() {
        return false;
    }
    let Some((along_r, along_s)) = cones(net) else { return false };
    let (never_negative, never_positive) = along_r.signs(&along_s);
    if inward { never_positive } else { never_negative }
}
