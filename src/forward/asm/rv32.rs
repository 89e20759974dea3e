//! RV32I.

use core::arch::naked_asm;

/// The sum of `count` points of a row of 32-bit values v, d1, d2, d3 at the start of the 16 of each axis; the coordinate
/// is above `shift` bits, 23 without a sign, 22 or 16 with one.
pub(in crate::forward) fn class_row(class: &[[[i32; 4]; 4]; 3], shift: u32, count: u32) -> i32 {
    // SAFETY: each reads three times four words of `class`, 64 bytes apart.
    unsafe {
        match shift {
            23 => small(class, count),
            22 => screen(class, count),
            _ => large(class, count),
        }
    }
}

/// The row with coordinates read by `$read` and so many bits: only registers that a call may change.
///
/// a1: turns to go, a2: scratch, a0: the sum, a3..a6, a7 t0..t2, t3..t6: v, d1, d2, d3 of the axes. A point takes 60 bytes.
macro_rules! row {
    ($name:ident, $read:literal, $shift:literal) => {
        #[unsafe(naked)]
        unsafe extern "C" fn $name(class: &[[[i32; 4]; 4]; 3], count: u32) -> i32 {
            naked_asm!(
                ".option push",
                ".option norvc",
                ".option norelax",
                // To the point that leaves count modulo 32.
                "andi a2, a1, 31",
                "srli a1, a1, 5",
                "sub a2, zero, a2",
                "addi a2, a2, 32",
                "slli a3, a2, 6",
                "slli a2, a2, 2",
                "sub a2, a3, a2",
                "lla a3, 3f",
                "add a2, a2, a3",
                "lw a3, 0(a0)",
                "lw a4, 4(a0)",
                "lw a5, 8(a0)",
                "lw a6, 12(a0)",
                "lw a7, 64(a0)",
                "lw t0, 68(a0)",
                "lw t1, 72(a0)",
                "lw t2, 76(a0)",
                "lw t3, 128(a0)",
                "lw t4, 132(a0)",
                "lw t5, 136(a0)",
                "lw t6, 140(a0)",
                "li a0, 0",
                "jr a2",
                "3:",
                ".rept 32",
                concat!($read, " a2, a3, ", $shift),
                "add a0, a0, a2",
                "add a3, a3, a4",
                "add a4, a4, a5",
                "add a5, a5, a6",
                concat!($read, " a2, a7, ", $shift),
                "add a0, a0, a2",
                "add a7, a7, t0",
                "add t0, t0, t1",
                "add t1, t1, t2",
                concat!($read, " a2, t3, ", $shift),
                "add a0, a0, a2",
                "add t3, t3, t4",
                "add t4, t4, t5",
                "add t5, t5, t6",
                ".endr",
                "addi a1, a1, -1",
                "bltz a1, 4f",
                "j 3b",
                "4:",
                "ret",
                ".option pop",
            )
        }
    };
}

row!(small, "srli", "23");
row!(screen, "srai", "22");
row!(large, "srai", "16");
