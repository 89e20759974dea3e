//! How many segments each class of edges takes.
//!
//! With M the largest second derivatives, a triangle of legs 1/n is within (M_rr + 2 M_rs + M_ss)/(8n²) of the surface
//! (Filip, Magedson & Markot 1986), and a bilinear cell of sides 1/n_r and 1/n_s within (M_rr/n_r² + M_ss/n_s²)/8:
//! linear interpolation along r, then along s, neither of which enlarges the other's error. A convex quad on the screen
//! is what its bilinear cell covers; a cell that is folded on the screen, next to a silhouette, is cut into two
//! triangles, which may be M_rs/(4 n_r n_s) farther. The control net bounds M_rr ≤ m(m−1)·max|Δ_rr P| and so on, in the
//! plane of the screen. Of bicubic patches [`joint`] knows more.

use super::super::RenderError;
use super::joint;
use crate::forward::Form;
use crate::num::{Coord, I16F16};
use crate::patch::{MAX_DEGREE, Surface, SurfaceNet, triangle_index};
use crate::subdivide::PatchTopology;

/// Classes that are kept apart. Class k is kept at k modulo this; classes that meet there share the larger count.
const SLOTS: usize = 64;

/// The most segments of an edge.
pub(in crate::render) const MOST: u16 = 1024;

/// Fraction bits of bounds.
const BITS: u32 = 12;

/// The longest side of a cell: two of them and a rounding error stay below 127 pixels.
const LONGEST_SIDE: u64 = 63 << BITS;

/// The segment count of every class.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::render) struct Segments([u16; SLOTS]);

fn slot(class: u16) -> usize {
    usize::from(class) % SLOTS
}

impl Segments {
    /// The least counts, patch by patch in order, that are enough for all of them.
    pub(in crate::render) fn of<S: Surface>(
        patches: &[S],
        topology: &[PatchTopology],
        tolerance: I16F16,
    ) -> Result<Self, RenderError> {
        if tolerance <= 0 {
            return Err(RenderError::Tolerance { bits: tolerance.to_bits() });
        }
        let mut all = Self([1; SLOTS]);
        for (index, (patch, topology)) in patches.iter().zip(topology).enumerate() {
            let net = patch.surface();
            let start = all.counts(net, topology);
            let joint = match (net, net.points().first_chunk::<16>()) {
                (SurfaceNet::Tensor(net), Some(points)) if net.degrees() == (3, 3) => {
                    joint::counts(points, start, tolerance)
                }
                _ => None,
            };
            let (r, s) = joint.unwrap_or_else(|| Bends::of(net).counts(net.is_triangle(), start, tolerance));
            if r.max(s) > MOST {
                return Err(RenderError::Segments { index, most: MOST });
            }
            let [along_s, _, along_r, _] = topology.classes();
            all.raise(along_s, s);
            all.raise(if net.is_triangle() { along_s } else { along_r }, r);
        }
        Ok(all)
    }

    fn raise(&mut self, class: u16, count: u16) {
        let own = &mut self.0[slot(class)];
        *own = count.max(*own);
    }

    /// The counts along r and s of a patch.
    pub(in crate::render) fn counts(&self, net: SurfaceNet<'_>, topology: &PatchTopology) -> (u16, u16) {
        let [along_s, _, along_r, _] = topology.classes();
        let count = |class: u16| self.0[slot(class)];
        (count(if net.is_triangle() { along_s } else { along_r }), count(along_s))
    }
}

/// Bounds on first and second derivatives in the plane of the screen, in 2^-12 pixel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Bends {
    pub(super) r: u64,
    pub(super) s: u64,
    pub(super) rr: u64,
    pub(super) rs: u64,
    pub(super) ss: u64,
}

/// At least the length of (x, y), at most 8 % more: the longer one and 53/128 of the other.
fn length([x, y]: [u64; 2]) -> u64 {
    x.max(y) + (x.min(y).saturating_mul(53) >> 7) + 1
}

impl Bends {
    pub(super) fn of(net: SurfaceNet<'_>) -> Self {
        let form = Form::surface(net, (1, 1));
        let triangle = net.is_triangle();
        if form.weights().is_some() { Self::rational(&form, triangle) } else { Self::polynomial(&form, triangle) }
    }

    fn polynomial(form: &Form<'_>, triangle: bool) -> Self {
        let (m, h) = form.degrees;
        // Within 1/4096 each, so a second difference within 4 of them.
        let mut net = [[0; 2]; (MAX_DEGREE + 1) * (MAX_DEGREE + 1)];
        for (place, p) in net.iter_mut().zip(form.points()) {
            *place = [p.x.to_bits() >> (16 - BITS), p.y.to_bits() >> (16 - BITS)];
        }
        let place = |k: usize| net.get(k).copied().unwrap_or_default();
        // Where (a, b) stands: of a triangle b[a, b, c], its first index falling.
        let index = |a: usize, b: usize| if triangle { triangle_index(b, m - a - b) } else { a * (h + 1) + b };
        let mut largest = [0_u32; 5];
        for a in 0..=m {
            let last_b = if triangle { m - a } else { h };
            for b in 0..=last_b {
                // How far the net goes on along r and s.
                let (ahead_r, ahead_s) = if triangle { (m - a - b, m - a - b) } else { (m - a, h - b) };
                let here = place(index(a, b));
                let (mut by_r, mut by_s) = ([0; 2], [0; 2]);
                if ahead_r > 0 {
                    by_r = minus(place(index(a + 1, b)), here);
                    raise(&mut largest[0], by_r);
                }
                if ahead_s > 0 {
                    by_s = minus(place(index(a, b + 1)), here);
                    raise(&mut largest[1], by_s);
                }
                if ahead_r > 1 {
                    raise(&mut largest[2], minus(minus(place(index(a + 2, b)), place(index(a + 1, b))), by_r));
                }
                // Tensor-product patches do without.
                if triangle && ahead_r > 1 {
                    raise(&mut largest[3], minus(minus(place(index(a + 1, b + 1)), place(index(a, b + 1))), by_r));
                }
                if ahead_s > 1 {
                    raise(&mut largest[4], minus(minus(place(index(a, b + 2)), place(index(a, b + 1))), by_s));
                }
            }
        }
        let [r, s, rr, rs, ss] = largest.map(u64::from);
        let [r, s, rr, rs, ss] = [r, s, rr, rs, ss].map(|d| d + 4);
        let (m, h) = (m as u64, h as u64);
        let mixed = if triangle { m * (m - 1) } else { m * h };
        Self { r: m * r, s: h * s, rr: m * (m - 1) * rr, rs: mixed * rs, ss: h * (h - 1) * ss }
    }

    /// With A = w·(x − c) about the middle c of the net, R its half extent and w the weight function:
    /// x_r = (A_r − (x − c) w_r)/w, x_rr = (A_rr − 2 x_r w_r − (x − c) w_rr)/w, x_rs likewise.
    fn rational(form: &Form<'_>, triangle: bool) -> Self {
        let (m, h) = (form.degrees.0 as u128, form.degrees.1 as u128);
        let mixed = if triangle { m * (m - 1) } else { m * h };
        let weight = |a, b| form.weight_bits(a, b);
        let least = form.weights().into_iter().flatten().map(|w| w.bits()).min().unwrap_or(1).unsigned_abs();
        let [w_r, w_s, w_rr, w_rs, w_ss] = largest_differences(form, &|a, b| weight(a, b).into());
        // In 2^-17 pixel.
        let bounds = [0, 1].map(|axis| {
            let bits = |p: &crate::geometry::Point3| if axis == 0 { p.x.bits() } else { p.y.bits() };
            let low = form.points().iter().map(bits).min().unwrap_or(0);
            let high = form.points().iter().map(bits).max().unwrap_or(0);
            let value = |a, b| i128::from(weight(a, b)) * i128::from(2 * form.bits(axis, a, b) - low - high);
            let [a_r, a_s, a_rr, a_rs, a_ss] = largest_differences(form, &value);
            let half = u128::from(high.abs_diff(low));
            let over = |n: u128| n.checked_div(least.into()).map_or(u128::MAX, |q| q + 1);
            let (r, s) = (over(m * (a_r + half * w_r)), over(h * (a_s + half * w_s)));
            let rr = over(m * (m - 1) * (a_rr + half * w_rr) + 2 * m * r * w_r);
            let ss = over(h * (h - 1) * (a_ss + half * w_ss) + 2 * h * s * w_s);
            let rs = over(mixed * (a_rs + half * w_rs) + h * r * w_s + m * s * w_r);
            [r, s, rr, rs, ss].map(|d| u64::try_from((d >> (17 - BITS)) + 1).unwrap_or(u64::MAX).min(TOO_MUCH))
        });
        let along = |k: usize| length([bounds[0][k], bounds[1][k]]);
        Self { r: along(0), s: along(1), rr: along(2), rs: along(3), ss: along(4) }
    }

    /// The least counts from `start` on that bring the facets within the tolerance, the longer bend first; beyond
    /// [`MOST`] they stop.
    fn counts(&self, is_triangle: bool, start: (u16, u16), tolerance: I16F16) -> (u16, u16) {
        // 8·tolerance in 2^-12 pixel is half its bits; more than 128 pixels change nothing.
        let tolerance = u64::from(tolerance.to_bits().unsigned_abs()).min(128 << 16);
        let sides = |length: u64| length.div_ceil(LONGEST_SIDE);
        let (mut r, mut s) = (sides(self.r).max(start.0.into()), sides(self.s).max(start.1.into()));
        if is_triangle {
            (r, s) = (r.max(s), r.max(s));
        }
        if self.rr.max(self.rs).max(self.ss) >= TOO_MUCH {
            return (MOST + 1, MOST + 1);
        }
        while r.max(s) <= u64::from(MOST) {
            let (along_r, along_s) = (self.rr * s * s, self.ss * r * r);
            let mixed = if is_triangle { 2 * self.rs * r * s } else { 0 };
            if 2 * (along_r + mixed + along_s) <= tolerance * (r * r * s * s) {
                break;
            }
            if is_triangle {
                (r, s) = (r + 1, s + 1);
            } else if along_r > along_s || (along_r == along_s && r < s) {
                r += 1;
            } else {
                s += 1;
            }
        }
        let short = |n: u64| u16::try_from(n).unwrap_or(u16::MAX);
        (short(r), short(s))
    }
}

/// A bound that no legal polynomial net reaches: 56·2^17 pixels.
const TOO_MUCH: u64 = 1 << 36;

/// Raises a bound to the length of a difference of at most 2^29, or up to 8 % more.
#[inline(always)]
fn raise(bound: &mut u32, d: [i32; 2]) {
    let [x, y] = d.map(i32::unsigned_abs);
    let (long, short) = if x > y { (x, y) } else { (y, x) };
    *bound = (long + (short >> 7) * 53 + 54).max(*bound);
}

fn minus(a: [i32; 2], b: [i32; 2]) -> [i32; 2] {
    [a[0] - b[0], a[1] - b[1]]
}

/// The largest differences of net values: along r, s, rr, rs, ss.
fn largest_differences(form: &Form<'_>, value: &dyn Fn(usize, usize) -> i128) -> [u128; 5] {
    let mut largest = [0; 5];
    for a in 0..=form.degrees.0 {
        for b in 0..=form.last_column_entry(a) {
            let here = value(a, b);
            let (last_a, last_b) = (form.last_row_entry(b), form.last_column_entry(a));
            let mut all = [0; 5];
            if a < last_a {
                all[0] = value(a + 1, b) - here;
            }
            if b < last_b {
                all[1] = value(a, b + 1) - here;
            }
            if a + 1 < last_a {
                all[2] = value(a + 2, b) - 2 * value(a + 1, b) + here;
            }
            if a < last_a && b < form.last_column_entry(a + 1) {
                all[3] = value(a + 1, b + 1) - value(a + 1, b) - value(a, b + 1) + here;
            }
            if b + 1 < last_b {
                all[4] = value(a, b + 2) - 2 * value(a, b + 1) + here;
            }
            for (largest, d) in largest.iter_mut().zip(all) {
                *largest = d.unsigned_abs().max(*largest);
            }
        }
    }
    largest
}
