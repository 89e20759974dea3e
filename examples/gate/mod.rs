//! The calls of the gate, a file per module of the crate.
//!
//! Arguments come through [`hide`] and results go through it, so that the optimiser knows neither: the image holds
//! the operation, not its result. Calls are written as `Type::method`, which is what the test counts.

mod data;
mod forward;
mod g1;
mod geometry;
#[cfg(feature = "graphics")]
mod graphics;
mod intersect;
mod mesh;
mod num;
mod patch;
mod render;
#[cfg(feature = "styled")]
mod styled;
mod subdivide;

pub(crate) use core::hint::black_box as hide;

use core::fmt::{Display, Write};
use embedded_surfaces::geometry::{Affine, Bounds, Point3, Vector3};
use embedded_surfaces::num::{Coord, I16F16, I32F32};

/// The name of a module and its calls.
pub(crate) type Module = (&'static str, fn(&mut Sum));

/// The modules in order.
pub(crate) const MODULES: &[Module] = &[
    ("num", num::calls),
    ("geometry", geometry::calls),
    ("patch, nets", patch::nets::calls),
    ("patch, evaluation", patch::eval::calls),
    ("patch, splines", patch::splines::calls),
    ("patch, quadrics", patch::quadrics::calls),
    ("patch, Hermite", patch::hermite::calls),
    ("patch, Coons", patch::coons::calls),
    ("mesh", mesh::calls),
    ("forward", forward::calls),
    ("subdivide", subdivide::calls),
    ("subdivide, meshes", subdivide::mesh::calls),
    ("g1", g1::calls),
    ("intersect", intersect::calls),
    ("render", render::calls),
    ("render, grid", render::grid::calls),
    #[cfg(feature = "graphics")]
    ("graphics", graphics::calls),
    #[cfg(feature = "styled")]
    ("styled", styled::calls),
];

/// Results in order: their number and a checksum.
#[derive(Default)]
pub(crate) struct Sum {
    pub(crate) results: u32,
    pub(crate) value: u32,
}

impl Sum {
    /// Takes a result.
    pub(crate) fn add(&mut self, result: impl Digest) {
        self.results = self.results.wrapping_add(1);
        hide(result).digest(self);
    }

    /// Takes a word; multiplied before each addition, so that the order counts.
    #[inline(never)]
    fn word(&mut self, word: u32) {
        self.value = self.value.wrapping_mul(0x0100_0193).wrapping_add(word).rotate_left(5);
    }
}

/// Text, byte by byte.
impl Write for Sum {
    fn write_str(&mut self, text: &str) -> core::fmt::Result {
        text.bytes().for_each(|byte| self.word(byte.into()));
        Ok(())
    }
}

/// What a checksum can be taken of, alike on targets of any width.
pub(crate) trait Digest {
    fn digest(&self, sum: &mut Sum);
}

macro_rules! integers {
    ($($integer:ty)*) => {$(
        impl Digest for $integer {
            #[allow(clippy::unnecessary_cast)]
            fn digest(&self, sum: &mut Sum) {
                let wide = *self as u64;
                sum.word(wide as u32);
                sum.word((wide >> 32) as u32);
            }
        }
    )*};
}

integers!(i8 u8 i16 u16 i32 u32 i64 u64 usize);

macro_rules! digests {
    ($(($($generics:tt)*) $type:ty: |$value:ident| $parts:expr;)*) => {$(
        impl<$($generics)*> Digest for $type {
            fn digest(&self, sum: &mut Sum) {
                let $value = self;
                $parts.digest(sum);
            }
        }
    )*};
}

digests! {
    () (): |_none| 0_u8;
    () bool: |b| u8::from(*b);
    () u128: |v| [*v as u64, (*v >> 64) as u64];
    () i128: |v| *v as u128;
    () I16F16: |c| c.to_bits();
    () I32F32: |c| c.to_bits();
    (C: Coord) Point3<C>: |p| [p.x.bits(), p.y.bits(), p.z.bits()];
    (C: Coord) Vector3<C>: |v| [v.x.bits(), v.y.bits(), v.z.bits()];
    (C: Coord) Bounds<C>: |b| [b.min, b.max];
    () Affine: |map| map.rows;
    (T: Digest, const N: usize) [T; N]: |values| values.as_slice();
    (T: Digest + ?Sized) &T: |value| **value;
}

impl<A: Digest, B: Digest> Digest for (A, B) {
    fn digest(&self, sum: &mut Sum) {
        self.0.digest(sum);
        self.1.digest(sum);
    }
}

impl<T: Digest> Digest for [T] {
    fn digest(&self, sum: &mut Sum) {
        sum.word(self.len() as u32);
        self.iter().for_each(|value| value.digest(sum));
    }
}

impl<T: Digest> Digest for Option<T> {
    fn digest(&self, sum: &mut Sum) {
        sum.word(self.is_some().into());
        if let Some(value) = self {
            value.digest(sum);
        }
    }
}

/// An error counts with its text.
impl<T: Digest, E: Display> Digest for Result<T, E> {
    fn digest(&self, sum: &mut Sum) {
        match self {
            Ok(value) => value.digest(sum),
            Err(error) => write!(sum, "{error}").unwrap_or_default(),
        }
    }
}
