//! Normals and Lambert shading.

use super::eval::{coordinates, partials};
use crate::num::Coord;
use crate::patch::SurfaceNet;

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The longest side of the box of the control points.
fn extent<C: Coord>(net: SurfaceNet<'_, C>) -> f64 {
    let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    for p in net.points().iter().map(coordinates) {
        for axis in 0..3 {
            low[axis] = low[axis].min(p[axis]);
            high[axis] = high[axis].max(p[axis]);
        }
    }
    (0..3).map(|axis| high[axis] - low[axis]).fold(0.0, f64::max)
}

/// The unit normal S_u × S_v / |S_u × S_v| at (u, v); `None` where it vanishes.
///
/// It counts as vanished where |S_u × S_v| ≤ 2^-32 D², D the longest side of the net's box: at collapsed edges, at
/// cusps, and where the partial derivatives are parallel. The thinnest flat sliver of an `I16F16` net is above that.
/// Rounding errors of the product stay below 2^-37 D² at degree 8 (partials: 8D with errors of 2^-43 D), so a
/// direction is good to 2^-37 D²/|S_u × S_v|: 2^-5 at the threshold, 2^-37 where the partials are as long as D.
///
/// ```
/// use embedded_surfaces::patch::{BilinearPatch, Surface};
/// use embedded_surfaces::reference::unit_normal;
/// let roof = BilinearPatch::from_ints([[[0, 0, 0], [0, 30, 40]], [[10, 0, 0], [10, 30, 40]]])?;
/// assert_eq!(unit_normal(roof.surface(), 0.5, 0.5), Some([0.0, -0.8, 0.6]));
/// let line = BilinearPatch::from_ints([[[0, 0, 0], [9, 9, 9]], [[10, 10, 10], [12, 12, 12]]])?;
/// assert_eq!(unit_normal(line.surface(), 0.5, 0.5), None);
/// # Ok::<(), embedded_surfaces::patch::NetError>(())
/// ```
#[must_use]
pub fn unit_normal<C: Coord>(net: SurfaceNet<'_, C>, u: f64, v: f64) -> Option<[f64; 3]> {
    let [by_u, by_v] = partials(net, u, v);
    let normal = cross(by_u, by_v);
    let length = dot(normal, normal).sqrt();
    let size = extent(net);
    let noise = size * size / (1_u64 << 32) as f64;
    (length > noise).then(|| normal.map(|c| c / length))
}

/// The two-sided Lambert shade of a unit normal, 0 ..= 255: 255·(a + (1 − a)·max(0, n·l)).
///
/// The normal may point either way: it is turned towards the viewer (negative z) first. `light` points from the
/// surface to the light; its length does not matter, and the zero vector is no light. `ambient`, a, is in 0 ..= 1.
///
/// ```
/// use embedded_surfaces::reference::lambert;
/// let towards_viewer = [0.0, 0.0, -2.0];
/// assert_eq!(lambert([0.0, 0.6, 0.8], towards_viewer, 0.0), 204.0);
/// assert_eq!(lambert([0.0, -0.6, -0.8], towards_viewer, 0.5), 229.5);
/// ```
#[must_use]
pub fn lambert(normal: [f64; 3], light: [f64; 3], ambient: f64) -> f64 {
    let length = dot(light, light).sqrt();
    let cosine = if length > 0.0 { dot(normal, light) / length } else { 0.0 };
    let facing = if normal[2] > 0.0 { -cosine } else { cosine };
    255.0 * (ambient + (1.0 - ambient) * facing.max(0.0))
}

/// The Blinn–Phong shade of a unit normal: [`lambert`], and specular·max(0, n·h)^exponent where the light reaches, at
/// most 255 in all. h is halfway between the light and the viewer; `specular` is in levels, 0 ..= 255.
///
/// ```
/// use embedded_surfaces::reference::blinn_phong;
/// let towards_viewer = [0.0, 0.0, -1.0];
/// assert_eq!(blinn_phong(towards_viewer, towards_viewer, 0.0, (60.0, 8)), 255.0);
/// assert_eq!(blinn_phong([1.0, 0.0, 0.0], towards_viewer, 0.5, (60.0, 8)), 127.5);
/// ```
#[must_use]
pub fn blinn_phong(normal: [f64; 3], light: [f64; 3], ambient: f64, (specular, exponent): (f64, u8)) -> f64 {
    let level = lambert(normal, light, ambient);
    let turned = if normal[2] > 0.0 { normal.map(|c| -c) } else { normal };
    let length = dot(light, light).sqrt();
    if dot(turned, light) <= 0.0 {
        return level;
    }
    let half = [light[0] / length, light[1] / length, light[2] / length - 1.0];
    let cosine = dot(turned, half) / dot(half, half).sqrt();
    let power = (0..exponent).fold(1.0, |power, _| power * cosine.max(0.0));
    (level + specular * power).min(255.0)
}

/// The [`lambert`] shade of the surface at (u, v); `None` where its normal vanishes.
///
/// ```
/// use embedded_surfaces::patch::{BilinearPatch, Surface};
/// use embedded_surfaces::reference::shade;
/// let screen = BilinearPatch::from_ints([[[0, 0, 5], [0, 9, 5]], [[9, 0, 5], [9, 9, 5]]])?;
/// assert_eq!(shade(screen.surface(), 0.5, 0.5, [0.0, 0.0, -1.0], 0.2), Some(255.0));
/// # Ok::<(), embedded_surfaces::patch::NetError>(())
/// ```
#[must_use]
pub fn shade<C: Coord>(net: SurfaceNet<'_, C>, u: f64, v: f64, light: [f64; 3], ambient: f64) -> Option<f64> {
    unit_normal(net, u, v).map(|normal| lambert(normal, light, ambient))
}

#[cfg(test)]
mod tests {
    use super::super::samples::nets;
    use super::*;
    use crate::patch::{BiquadraticPatch, FlatTriangle, Surface};
    use proptest::prelude::*;

    #[test]
    fn paraboloid_has_its_closed_form() {
        // (16r, 16s, 16(r² + s²)): the normal is (-2r, -2s, 1) up to length.
        let row = |i: i16, z: i16| [[8 * i, 0, z], [8 * i, 8, z], [8 * i, 16, z + 16]];
        let net = BiquadraticPatch::from_ints([row(0, 0), row(1, 0), row(2, 16)]).unwrap();
        for (r, s) in [(0.0, 0.0), (0.25, 0.5), (1.0, 1.0), (0.9, 0.1)] {
            let length = (4.0 * (r * r + s * s) + 1.0_f64).sqrt();
            let normal = unit_normal(net.surface(), r, s).unwrap();
            for (got, want) in normal.into_iter().zip([-2.0 * r / length, -2.0 * s / length, 1.0 / length]) {
                assert!((got - want).abs() < 1e-14);
            }
        }
    }

    #[test]
    fn triangles_have_a_normal() {
        // S_u = P - R, S_v = Q - R.
        let flat = FlatTriangle::from_ints([[1, 0, 0], [0, 1, 0], [0, 0, 0]]).unwrap();
        assert_eq!(unit_normal(flat.surface(), 0.1, 0.2), Some([0.0, 0.0, 1.0]));
    }

    #[test]
    fn a_collapsed_edge_has_none() {
        // A cone whose tip is the whole row r = 0.
        let tip = [[5, 5, 0]; 3];
        let net =
            BiquadraticPatch::from_ints([tip, [[0, 0, 5], [5, 0, 5], [9, 1, 5]], [[0, 0, 9], [5, 0, 9], [9, 1, 9]]]);
        let net = net.unwrap();
        assert_eq!(unit_normal(net.surface(), 0.0, 0.3), None);
        assert_eq!(shade(net.surface(), 0.0, 0.3, [0.0, 0.0, -1.0], 0.1), None);
        assert!(unit_normal(net.surface(), 1e-3, 0.3).is_some());
    }

    #[test]
    fn rounding_noise_is_no_normal() {
        // Every point on one line through the origin: the partial derivatives are parallel.
        let row = |a: i16| [a, 5 * a + 3, 29 - a].map(|t| [t, 3 * t, 7 * t]);
        let net = BiquadraticPatch::from_ints([row(0), row(11), row(2)]).unwrap();
        let mut noisy = 0;
        for step in 0..100 {
            let (r, s) = (f64::from(step) / 99.0, f64::from(step * 37 % 100) / 99.0);
            let [by_r, by_s] = partials(net.surface(), r, s);
            noisy += usize::from(cross(by_r, by_s) != [0.0; 3]);
            assert_eq!(unit_normal(net.surface(), r, s), None);
        }
        assert!(noisy > 10, "the noise that this test is about has gone");
    }

    #[test]
    fn shades_span_ambient_to_full() {
        let light = [0.0, 0.0, -1.0];
        assert_eq!(lambert([0.0, 0.0, 1.0], light, 0.25), 255.0);
        assert_eq!(lambert([1.0, 0.0, 0.0], light, 0.25), 63.75); // edge on
        assert_eq!(lambert([0.0, 0.0, 1.0], [0.0, 0.0, 1.0], 0.25), 63.75); // lit from behind
        assert_eq!(lambert([0.0, 0.0, 1.0], [0.0; 3], 0.25), 63.75); // no light
        assert_eq!(lambert([0.6, 0.0, 0.8], [-3.0, 0.0, -4.0], 0.0), 255.0); // along the turned normal
    }

    proptest! {
        #[test]
        fn normals_are_unit_and_orthogonal(net in nets(8, 1 << 24), u in 0.0..0.5, v in 0.0..0.5) {
            let [by_u, by_v] = partials(net.surface(), u, v);
            if let Some(n) = unit_normal(net.surface(), u, v) {
                prop_assert!((dot(n, n) - 1.0).abs() < 1e-12);
                let scale = 1e-9 * extent(net.surface());
                prop_assert!(dot(n, by_u).abs() < scale && dot(n, by_v).abs() < scale);
            }
        }

        #[test]
        fn both_sides_shade_alike(n in proptest::array::uniform3(-1.0..1.0), l in proptest::array::uniform3(-1.0..1.0)) {
            let shade = lambert(n, l, 0.1);
            prop_assert_eq!(shade, lambert(n.map(|c: f64| -c), l, 0.1));
            prop_assert!(shade >= 25.5);
        }
    }
}
