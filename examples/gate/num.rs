//! Angles, words and coordinates.

use super::{Sum, hide};
use embedded_surfaces::num::{Angle, Coord, I16F16, I32F32, Word};

pub(super) fn calls(sum: &mut Sum) {
    for degrees in hide([i32::MIN, -360, -1, 0, 30, 45, 90, 137, 359]) {
        let angle = Angle::from_degrees(degrees);
        sum.add(Angle::to_binary(angle));
        sum.add(Angle::sin_cos(angle));
    }
    for steps in hide([0, 1, 0x4000_0000, 0x8765_4321, u32::MAX]) {
        let (a, b) = (Angle::from_binary(steps), Angle::from_degrees_fixed(I16F16::from_bits(steps as i32)));
        sum.add([a, b, a + b, -a].map(Angle::to_binary));
    }
    for value in hide([0, -1, 1 << 31, i128::from(i64::MIN) - 5, i128::MAX]) {
        words::<i32>(sum, value);
        words::<i64>(sum, value);
        words::<i128>(sum, value);
    }
    coordinates::<I16F16>(sum);
    coordinates::<I32F32>(sum);
}

#[inline(never)]
fn words<W: Word>(sum: &mut Sum, value: i128) {
    let (a, b): (W, W) = (Word::truncate(value), Word::truncate(hide(0x1234_5678_9abc_def0)));
    let results = [
        Word::wrapping_plus(a, b),
        Word::wrapping_minus(a, b),
        Word::wrapping_times(a, b),
        Word::wrapping_mul_i64(a, hide(-77)),
    ];
    for word in results {
        let low: i64 = word.as_();
        sum.add((low, Word::below(word, a)));
    }
}

#[inline(never)]
fn coordinates<C: Coord>(sum: &mut Sum) {
    for bits in hide([0, -1, 32767 << 16, 1 << 47, (1 << 58) + 1, i128::MIN]) {
        let coordinate: Option<C> = Coord::from_legal_bits(bits);
        sum.add(coordinate.map(|c| (Coord::bits(c), Coord::is_legal(c))));
    }
}
