//! Light and shade.

use super::{Gloss, RenderError};
use crate::num::{Word, reciprocal_root};

/// A light from a fixed direction, and the level of what it does not reach.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Light {
    /// The unit vector towards the light, in 2^-15.
    direction: [i32; 3],
    ambient: u8,
}

impl Default for Light {
    /// From the upper left behind the viewer, (−2, −3, −6)/7, with an ambient level of 40.
    fn default() -> Self {
        const LIGHT: Light = match Light::towards(-2, -3, -6, 40) {
            Ok(light) => light,
            Err(_) => Light { direction: [0, 0, -(1 << 15)], ambient: 40 },
        };
        LIGHT
    }
}

impl Light {
    /// A light in the direction (x, y, z) of the screen: x right, y down, z away from the viewer; any length.
    ///
    /// The unit vector is kept to 2^-16.
    ///
    /// ```
    /// use embedded_surfaces::render::Light;
    /// assert!(Light::towards(0, -1, -1, 30).is_ok());
    /// assert!(Light::towards(0, 0, 0, 30).is_err());
    /// ```
    ///
    /// # Errors
    /// [`RenderError::Light`] for (0, 0, 0).
    pub const fn towards(x: i16, y: i16, z: i16, ambient: u8) -> Result<Self, RenderError> {
        let v = [x as i64, y as i64, z as i64];
        // The length in 2^-15: 15 more bits on each component square to 30 on the sum.
        let length = (((v[0] * v[0] + v[1] * v[1] + v[2] * v[2]) as u64) << 30).isqrt() as i64;
        let mut direction = [0; 3];
        let mut axis = 0;
        while axis < 3 {
            match ((v[axis] << 31) + length).checked_div_euclid(2 * length) {
                Some(c) => direction[axis] = c as i32,
                None => return Err(RenderError::Light),
            }
            axis += 1;
        }
        Ok(Self { direction, ambient })
    }

    /// The unit vector towards the light, in units of 2^-15.
    #[must_use]
    pub const fn direction(&self) -> [i32; 3] {
        self.direction
    }

    /// The level of what the light does not reach.
    #[must_use]
    pub const fn ambient(&self) -> u8 {
        self.ambient
    }

    /// The unit vector halfway between the light and the viewer, in 2^-15; 0 for a light behind the screen's axis.
    fn halfway(&self) -> [i32; 3] {
        let [x, y, z] = self.direction;
        let v = [x, y, z - (1 << 15)].map(i64::from);
        let length = v.iter().map(|c| c * c).sum::<i64>().unsigned_abs().isqrt() as i64;
        v.map(|c| ((c << 16) + length).checked_div_euclid(2 * length).unwrap_or(0) as i32)
    }

    /// [`level`](Self::level) with a highlight: specular·max(0, N·H)^exponent more where the light reaches.
    ///
    /// N·H is kept to 2^-15, its power to exponent·2^-16: together with the Lambert part within 2 levels.
    pub(super) fn glossy(&self, normal: [i32; 3], gloss: Gloss) -> u8 {
        let level = self.level(normal);
        let dot = |v: [i32; 3]| normal.iter().zip(&v).map(|(n, c)| n * c).sum::<i32>();
        if dot(self.direction) <= 0 {
            return level;
        }
        let length = normal.iter().map(|n| n.unsigned_abs().pow(2)).sum::<u32>().isqrt();
        let along = dot(self.halfway()).max(0) as u32;
        let cosine = (along + length / 2).checked_div(length).unwrap_or(0).min(1 << 15);
        let power = (0..gloss.exponent()).fold(1_u32 << 15, |power, _| (power * cosine + (1 << 14)) >> 15);
        let more = (u32::from(gloss.specular()) * power + (1 << 14)) >> 15;
        level.saturating_add(more as u8)
    }

    /// The level of a surface with this normal vector, of components of at most 2^15.
    #[inline(always)]
    pub(super) fn level(&self, normal: [i32; 3]) -> u8 {
        let (level, is_lit) = self.level_of_lit_side(normal);
        if is_lit { level } else { self.ambient }
    }
}

impl Light {
    /// The light from the other side.
    #[inline(always)]
    pub(super) fn reversed(&self) -> Self {
        Self { direction: self.direction.map(|c| -c), ambient: self.ambient }
    }

    /// [`level`](Self::level) of this normal, or of the one that points the other way, where its largest component has 15
    /// bits.
    #[inline(always)]
    pub(super) fn level_of_turned(&self, [x, y, z]: [i32; 3], turned: bool) -> u8 {
        let [a, b, c] = self.direction;
        let along = x * a + y * b + z * c;
        let along = if turned { -along } else { along };
        if along <= 0 {
            return self.ambient;
        }
        self.ambient.saturating_add(self.above(along as u32, (x * x) as u32 + (y * y) as u32 + (z * z) as u32))
    }

    /// What a normal adds to the ambient level, from its product with the direction and its square.
    #[inline(always)]
    fn above(&self, along: u32, square: u32) -> u8 {
        let (root, half) = reciprocal_root(square);
        // The normal is shorter than 2^half: the product is at most 2^31, and the cosine's in 2^-31.
        let cosine = (along >> (half.max(1) - 1)).wrapping_mul(root) >> 16;
        ((u32::from(255 - self.ambient) * cosine + (1 << 14)) >> 15) as u8
    }

    /// The level of a surface with this normal vector of components of at most 2^15 on the side that the light reaches,
    /// without a division and within 1 of the exact one; and whether that is the side to which it points.
    pub(super) fn level_of_lit_side(&self, normal: [i32; 3]) -> (u8, bool) {
        let dot = normal.iter().zip(&self.direction).map(|(n, l)| n * l).sum::<i32>();
        let square: u32 = normal.iter().map(|n| n.unsigned_abs().pow(2)).sum();
        (self.ambient.saturating_add(self.above(dot.unsigned_abs(), square.max(1))), dot >= 0)
    }
}

/// The normal U × V, turned to the viewer.
#[cfg(all(test, feature = "std"))]
pub(super) fn normal<W: Word>(tangents: [[W; 3]; 2]) -> Option<[i32; 3]> {
    normal_on(Side::Viewer, tangents)
}

/// Which way a normal points.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Side {
    /// To the viewer: both sides of a patch are lit alike.
    Viewer,
    /// As U × V.
    Along,
    /// As V × U.
    Against,
}

/// The normal of two tangents, with components of at most 2^15; `None` where it vanishes.
///
/// To the viewer it is turned by the sign of the untruncated z: at a silhouette the level jumps with it.
pub(super) fn normal_on<W: Word>(side: Side, [u, v]: [[W; 3]; 2]) -> Option<[i32; 3]> {
    let (u, v) = (truncate(u, 30), truncate(v, 30));
    let [a, b] = [u, v].map(|t| t.map(i64::from));
    // Two products of 30-bit numbers stay below 2^61.
    let cross = [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
    let turned = side == Side::Against || (side == Side::Viewer && cross[2] > 0);
    let cross = if turned { cross.map(|c| -c) } else { cross };
    (cross[0] | cross[1] | cross[2] != 0).then(|| truncate(cross, 15))
}

/// The normal U × V as it is, with components of at most 2^15, from tangents of at most 14 bits; `None` where it
/// vanishes.
pub(super) fn normal_of([u, v]: [[i16; 3]; 2]) -> Option<[i32; 3]> {
    let [a, b] = [u, v].map(|t| t.map(i32::from));
    // Two products of 14-bit numbers stay below 2^29.
    let cross = [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
    (cross != [0; 3]).then(|| truncate(cross, 15))
}

/// A tangent in 14 bits and a sign.
pub(super) fn short<W: Word>(tangent: [W; 3]) -> [i16; 3] {
    truncate(tangent, 14).map(|c| c as i16)
}

/// The vector with its components shifted right by one common amount: from −2^bits to 2^bits − 1.
pub(super) fn truncate<W: Word>(v: [W; 3], bits: u32) -> [i32; 3] {
    let magnitude = v.iter().fold(W::ZERO, |all, c| all | (*c ^ (*c >> (<W as Word>::BITS - 1) as usize)));
    let used = <W as Word>::BITS - magnitude.leading_zeros();
    let shift = used.saturating_sub(bits) as usize;
    v.map(|c| (c >> shift).as_())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_light_is_a_unit_vector() {
        let light = Light::towards(-2, -3, -6, 0).unwrap();
        assert_eq!(light.direction(), [-9362, -14043, -28087]); // n/7 of 32768, rounded
        assert_eq!(Light::towards(0, 0, i16::MIN, 0).unwrap().direction(), [0, 0, -(1 << 15)]);
        assert_eq!(Light::towards(0, 0, 0, 9), Err(RenderError::Light));
    }

    #[test]
    fn facing_the_light_is_255_and_turned_away_is_ambient() {
        let light = Light::towards(0, 0, -1, 40).unwrap();
        for n in [[0, 0, -5], [0, 0, -32768], [0, 0, -1]] {
            assert_eq!(light.level(n), 255, "{n:?}");
        }
        assert_eq!(light.level([32767, 0, 0]), 40);
        assert_eq!(Light::towards(1, 0, 0, 40).unwrap().level([-3000, 0, -5]), 40);
        assert_eq!(Light::towards(0, 0, -1, 255).unwrap().level([32767, 32767, -32767]), 255);
    }

    #[test]
    fn levels_without_a_division_are_as_good() {
        let light = Light::towards(3, -4, -7, 20).unwrap();
        let mut state = 1_u32;
        let mut next = |bits: u32| {
            state = state.wrapping_mul(0x915f_77f5).wrapping_add(12_345);
            (state as i32) >> (31 - bits)
        };
        for k in 0..200_000 {
            let bits = 1 + k % 15;
            let normal = [next(bits), next(bits), next(bits)];
            let (level, along) = light.level_of_lit_side(normal);
            let dot: i64 = normal.iter().zip(light.direction()).map(|(n, l)| i64::from(n * l)).sum();
            let square: u64 = normal.iter().map(|n| u64::from(n.unsigned_abs()).pow(2)).sum();
            let length = (square << 32).isqrt().max(1);
            let exact = 20 + (((235 * dot.unsigned_abs()) << 2) / length).div_ceil(2);
            assert!(u64::from(level).abs_diff(exact) <= 1, "{normal:?} {level} {exact}");
            let other = light.level(if along { normal } else { normal.map(|c| -c) });
            assert!(square < 1 << 16 || level.abs_diff(other) <= 1, "{normal:?} {level} {other}");
        }
    }

    #[test]
    fn truncation_keeps_the_direction() {
        assert_eq!(truncate([1_i64 << 40, -(1 << 41), 3], 15), [1 << 14, -(1 << 15), 0]);
        assert_eq!(truncate([i64::MIN, i64::MAX, -1], 30), [-(1 << 30), (1 << 30) - 1, -1]);
        assert_eq!(truncate([7_i128, -8, 0], 30), [7, -8, 0]);
        assert_eq!(normal([[1_i64, 0, 0], [2, 0, 0]]), None);
        assert_eq!(normal([[1_i128 << 100, 0, 0], [0, 1, 0]]), Some([0, 0, -(1 << 15)]));
    }
}
