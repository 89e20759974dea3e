//! RV32I.

use super::Walk;
use core::arch::naked_asm;

/// The sum of `rows` rows, which are one, or as many as the first one has points: `count`, and each other one has one less
/// than the one before it. Coordinates are above `shift` bits, 23 without a sign, 22 or 16 with one.
pub(in crate::forward) fn class_sum(walk: &mut Walk, shift: u32, count: u32, rows: u32) -> i32 {
    // SAFETY: each reads and writes the 32 words of `walk` alone.
    unsafe {
        match shift {
            23 => small(walk, count, rows),
            22 => screen(walk, count, rows),
            _ => large(walk, count, rows),
        }
    }
}

/// The rows with coordinates read by `$read` and so many bits.
///
/// a0: the sum, a1: turns to go, a2: scratch; a3, a4, a5: v of x, y, z, a6, a7, t0: d1, t1, t2, t3: d2, t4, t5, t6: d3; s0: the
/// walk, s1: where the row is entered, s2: its turns, s3: where rows of no points are entered; differences from row to row
/// s4, s5, s6 and s10, s11, ra: of v, first and second ones, s7, s8, s9: of d1. A point takes 60 bytes. Where one row is
/// wanted, s2 and s3 are 0, for which no row follows.
macro_rules! rows {
    ($name:ident, $read:literal, $shift:literal) => {
        #[unsafe(naked)]
        unsafe extern "C" fn $name(walk: &mut Walk, count: u32, rows: u32) -> i32 {
            naked_asm!(
                ".option push",
                ".option norvc",
                ".option norelax",
                "addi sp, sp, -64",
                "sw ra, 0(sp)",
                "sw s0, 4(sp)",
                "sw s1, 8(sp)",
                "sw s2, 12(sp)",
                "sw s3, 16(sp)",
                "sw s4, 20(sp)",
                "sw s5, 24(sp)",
                "sw s6, 28(sp)",
                "sw s7, 32(sp)",
                "sw s8, 36(sp)",
                "sw s9, 40(sp)",
                "sw s10, 44(sp)",
                "sw s11, 48(sp)",
                "mv s0, a0",
                // To the point that leaves the points of the row modulo 32.
                "lla s1, 3f",
                "addi s3, s1, 1920",
                "andi a3, a1, 31",
                "li a4, 32",
                "sub a4, a4, a3",
                "slli a5, a4, 6",
                "slli a4, a4, 2",
                "sub a5, a5, a4",
                "add s1, s1, a5",
                "srli s2, a1, 5",
                "mv a1, s2",
                "li a3, 1",
                "bgtu a2, a3, 2f",
                "li s2, 0",
                "li s3, 0",
                "2:",
                "lw s7, 20(s0)",
                "lw s8, 24(s0)",
                "lw s9, 28(s0)",
                "lw s10, 80(s0)",
                "lw s11, 84(s0)",
                "lw ra, 88(s0)",
                "lw s4, 92(s0)",
                "lw s5, 96(s0)",
                "lw s6, 100(s0)",
                "lw t4, 116(s0)",
                "lw t5, 120(s0)",
                "lw t6, 124(s0)",
                "li a0, 0",
                "j 5f",
                "3:",
                ".rept 32",
                concat!($read, " a2, a3, ", $shift),
                "add a0, a0, a2",
                "add t1, t1, t4",
                "add a6, a6, t1",
                "add a3, a3, a6",
                concat!($read, " a2, a4, ", $shift),
                "add a0, a0, a2",
                "add t2, t2, t5",
                "add a7, a7, t2",
                "add a4, a4, a7",
                concat!($read, " a2, a5, ", $shift),
                "add a0, a0, a2",
                "add t3, t3, t6",
                "add t0, t0, t3",
                "add a5, a5, t0",
                ".endr",
                "addi a1, a1, -1",
                "bgez a1, 3b",
                // The next row is entered a point later, or after the first turn with a turn less.
                "addi s1, s1, 60",
                "bgtu s1, s3, 6f",
                "mv a1, s2",
                "5:",
                // v.
                "lw a2, 68(s0)",
                "lw a3, 72(s0)",
                "lw a4, 76(s0)",
                "add s10, s10, a2",
                "add s11, s11, a3",
                "add ra, ra, a4",
                "add s4, s4, s10",
                "add s5, s5, s11",
                "add s6, s6, ra",
                "lw a3, 104(s0)",
                "lw a4, 108(s0)",
                "lw a5, 112(s0)",
                "add a3, a3, s4",
                "add a4, a4, s5",
                "add a5, a5, s6",
                "sw a3, 104(s0)",
                "sw a4, 108(s0)",
                "sw a5, 112(s0)",
                // d1.
                "lw a6, 8(s0)",
                "lw a7, 12(s0)",
                "lw t0, 16(s0)",
                "add s7, s7, a6",
                "add s8, s8, a7",
                "add s9, s9, t0",
                "lw a6, 32(s0)",
                "lw a7, 36(s0)",
                "lw t0, 40(s0)",
                "add a6, a6, s7",
                "add a7, a7, s8",
                "add t0, t0, s9",
                "sw a6, 32(s0)",
                "sw a7, 36(s0)",
                "sw t0, 40(s0)",
                // d2, z first.
                "lw t3, 44(s0)",
                "lw t2, 48(s0)",
                "lw t1, 52(s0)",
                "lw a2, 56(s0)",
                "add t3, t3, a2",
                "lw a2, 60(s0)",
                "add t2, t2, a2",
                "lw a2, 64(s0)",
                "add t1, t1, a2",
                "sw t3, 44(s0)",
                "sw t2, 48(s0)",
                "sw t1, 52(s0)",
                "jr s1",
                // 32 points before where it is now, and one less.
                "6:",
                "addi s2, s2, -1",
                "mv a1, s2",
                "addi s1, s3, -1860",
                "bgez s2, 5b",
                "lw ra, 0(sp)",
                "lw s0, 4(sp)",
                "lw s1, 8(sp)",
                "lw s2, 12(sp)",
                "lw s3, 16(sp)",
                "lw s4, 20(sp)",
                "lw s5, 24(sp)",
                "lw s6, 28(sp)",
                "lw s7, 32(sp)",
                "lw s8, 36(sp)",
                "lw s9, 40(sp)",
                "lw s10, 44(sp)",
                "lw s11, 48(sp)",
                "addi sp, sp, 64",
                "ret",
                ".option pop",
            )
        }
    };
}

rows!(small, "srli", "23");
rows!(screen, "srai", "22");
rows!(large, "srai", "16");
