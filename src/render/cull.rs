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
    /// The least cone that holds all vectors, where they are less than a quarter turn from `middle` and not all zero.
    #[inline(always)]
    fn around(middle: Vector, each: impl Iterator<Item = Vector>) -> Option<Self> {
        let mut cone: Option<Self> = None;
        for v in each {
            let Some(Self { right, left }) = &mut cone else {
                if dot(middle, v) > 0 {
                    cone = Some(Self { right: v, left: v });
                } else if v != [0; 2] {
                    return None;
                }
                continue;
            };
            let (is_left, is_right) = (cross(*left, v) > 0, cross(v, *right) > 0);
            // Neither: it is in the cone, or the cone is a ray, and it may point the other way.
            if (is_left || is_right || right == left) && dot(middle, v) <= 0 {
                if v == [0; 2] {
                    continue;
                }
                return None;
            }
            if is_left {
                *left = v;
            } else if is_right {
                *right = v;
            }
        }
        cone
    }

    /// [`around`](Self::around) their sum.
    fn around_sum(each: impl Iterator<Item = Vector> + Clone) -> Option<Self> {
        let mut sum = [0_i64; 2];
        for v in each.clone() {
            if v[0].unsigned_abs() >= LONGEST || v[1].unsigned_abs() >= LONGEST {
                return None;
            }
            sum = [sum[0] + i64::from(v[0]), sum[1] + i64::from(v[1])];
        }
        // Fewer than 2^10 vectors.
        Self::around(sum.map(|c| (c >> 10) as i32), each)
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
fn differences<'n>(net: &SurfaceNet<'n>, along_s: bool) -> impl Iterator<Item = Vector> + Clone + 'n {
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
        return bicubic_cones(points);
    }
    Cone::around_sum(differences(net, false)).zip(Cone::around_sum(differences(net, true)))
}

/// [`cones`] of a bicubic.
fn bicubic_cones(points: &[Point3; 16]) -> Option<(Cone, Cone)> {
    let place = |k: usize| [points[k & 15].x.to_bits(), points[k & 15].y.to_bits()];
    let size = (0..16).map(place).fold(0, |all, [x, y]| all | (x ^ (x >> 31)) | (y ^ (y >> 31)));
    if size >= (LONGEST >> 1) as i32 {
        return None;
    }
    let between = |from: usize, to: usize| {
        let ([x, y], [u, v]) = (place(from), place(to));
        [u - x, v - y]
    };
    // Sums of the differences, a quarter of them.
    let sum = |ends: [[usize; 2]; 4]| {
        ends.iter().fold([0; 2], |[x, y]: Vector, [from, to]| {
            let [u, v] = between(*from, *to);
            [x + (u >> 2), y + (v >> 2)]
        })
    };
    let along_r = Cone::around(sum([[0, 12], [1, 13], [2, 14], [3, 15]]), (0..12).map(|k| between(k, k + 4)))?;
    let in_rows = (0..12).map(|k| between(k + k / 3, k + k / 3 + 1));
    Some((along_r, Cone::around(sum([[0, 3], [4, 7], [8, 11], [12, 15]]), in_rows)?))
}

/// Which way a piece looks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Facing {
    /// No point of it faces the viewer.
    Away,
    /// No point of it faces away.
    Viewer,
    /// Where the cones are too wide to tell, and for rational triangles.
    Unknown,
}

/// Which way a piece looks: the z of S_r × S_s is nowhere positive where it faces the viewer, or nowhere negative where
/// that normal points inwards.
#[inline(never)]
pub(super) fn facing(net: &SurfaceNet<'_>, inward: bool) -> Facing {
    if net.is_triangle() && net.weights().is_some() {
        return Facing::Unknown;
    }
    let Some((along_r, along_s)) = cones(net) else { return Facing::Unknown };
    match along_r.signs(&along_s) {
        (true, false) if !inward => Facing::Away,
        (false, true) if inward => Facing::Away,
        (true, true) => Facing::Away,
        (true, false) | (false, true) => Facing::Viewer,
        (false, false) => Facing::Unknown,
    }
}
