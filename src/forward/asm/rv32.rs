//! RV32I.

use core::arch::naked_asm;

/// The sum of `rows` rows of 32-bit values: v and its backward differences d1, d2, d3 at the start of the 16 of each axis;
/// the coordinate is above `shift` bits, 23 without a sign, 22 or 16 with one. The first row has `count` points, each
/// other one less than the one before it: at least one. The class moves on by as many rows of a triangle.
pub(in crate::forward) fn class_sum(class: &mut [[[i32; 4]; 4]; 3], shift: u32, count: u32, rows: u32) -> i32 {
    // SAFETY: each reads and writes words of `class` alone, 64 bytes apart for the axes, up to 52 bytes from there.
    unsafe {
        match shift {
            23 => small(class, count, rows),
            22 => screen(class, count, rows),
            _ => large(class, count, rows),
        }
    }
}

/// The rows with coordinates read by `$read` and so many bits.
///
/// a1: turns to go, a2: scratch, a0: the sum, a3..a6, a7 t0..t2, t3..t6: v, d1, d2, d3 of the axes, s0: the class, s1: points
/// of the row, s2: rows to go. A point takes 60 bytes.
macro_rules! rows {
    ($name:ident, $read:literal, $shift:literal) => {
        #[unsafe(naked)]
        unsafe extern "C" fn $name(class: &mut [[[i32; 4]; 4]; 3], count: u32, rows: u32) -> i32 {
            naked_asm!(
                ".option push",
                ".option norvc",
                ".option norelax",
                "addi sp, sp, -16",
                "sw s0, 0(sp)",
                "sw s1, 4(sp)",
                "sw s2, 8(sp)",
                "mv s0, a0",
                "mv s1, a1",
                "mv s2, a2",
                "li a0, 0",
                "2:",
                // To the point that leaves the points of the row modulo 32.
                "andi a2, s1, 31",
                "srli a1, s1, 5",
                "sub a2, zero, a2",
                "addi a2, a2, 32",
                "slli a3, a2, 6",
                "slli a2, a2, 2",
                "sub a2, a3, a2",
                "lla a3, 3f",
                "add a2, a2, a3",
                "lw a3, 0(s0)",
                "lw a4, 4(s0)",
                "lw a5, 8(s0)",
                "lw a6, 12(s0)",
                "lw a7, 64(s0)",
                "lw t0, 68(s0)",
                "lw t1, 72(s0)",
                "lw t2, 76(s0)",
                "lw t3, 128(s0)",
                "lw t4, 132(s0)",
                "lw t5, 136(s0)",
                "lw t6, 140(s0)",
                "jr a2",
                "3:",
                ".rept 32",
                concat!($read, " a2, a3, ", $shift),
                "add a0, a0, a2",
                "add a5, a5, a6",
                "add a4, a4, a5",
                "add a3, a3, a4",
                concat!($read, " a2, a7, ", $shift),
                "add a0, a0, a2",
                "add t1, t1, t2",
                "add t0, t0, t1",
                "add a7, a7, t0",
                concat!($read, " a2, t3, ", $shift),
                "add a0, a0, a2",
                "add t5, t5, t6",
                "add t4, t4, t5",
                "add t3, t3, t4",
                ".endr",
                "addi a1, a1, -1",
                "bltz a1, 4f",
                "j 3b",
                "4:",
                // To the next row: the second, third and fourth of the table go to the one before.
                ".irp at, 0, 64, 128",
                "lw a1, \\at(s0)",
                "lw a2, \\at + 4(s0)",
                "lw a3, \\at + 8(s0)",
                "lw a4, \\at + 16(s0)",
                "lw a5, \\at + 20(s0)",
                "lw a6, \\at + 24(s0)",
                "lw a7, \\at + 32(s0)",
                "lw t0, \\at + 36(s0)",
                "lw t1, \\at + 48(s0)",
                "add a1, a1, a4",
                "add a2, a2, a5",
                "add a3, a3, a6",
                "add a4, a4, a7",
                "add a5, a5, t0",
                "add a7, a7, t1",
                "sw a1, \\at(s0)",
                "sw a2, \\at + 4(s0)",
                "sw a3, \\at + 8(s0)",
                "sw a4, \\at + 16(s0)",
                "sw a5, \\at + 20(s0)",
                "sw a7, \\at + 32(s0)",
                ".endr",
                "addi s1, s1, -1",
                "addi s2, s2, -1",
                "bnez s2, 2b",
                "lw s0, 0(sp)",
                "lw s1, 4(sp)",
                "lw s2, 8(sp)",
                "addi sp, sp, 16",
                "ret",
                ".option pop",
            )
        }
    };
}

rows!(small, "srli", "23");
rows!(screen, "srai", "22");
rows!(large, "srai", "16");
