//! ARMv6-M.

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

/// The rows with the coordinate read by `$read`.
///
/// r0: differences, r1: turns to go, r2: the coordinate, r3: v, r4, r5, r6: d1, d2, d3, r7: the sum, r8: turns, r9: where
/// to enter, r10: end of differences, r11: points of the row, r12: rows to go. A point takes 10 bytes.
macro_rules! rows {
    ($name:ident, $read:literal) => {
        #[unsafe(naked)]
        unsafe extern "C" fn $name(class: &mut [[[i32; 4]; 4]; 3], count: u32, rows: u32) -> i32 {
            naked_asm!(
                "push {{r4-r7, lr}}",
                "mov r4, r8",
                "mov r5, r9",
                "mov r6, r10",
                "mov r7, r11",
                "push {{r4-r7}}",
                "mov r11, r1",
                "mov r12, r2",
                "movs r1, #192",
                "add r1, r0",
                "mov r10, r1",
                "movs r7, #0",
                "1:",
                "mov r1, r11",
                "lsrs r2, r1, #5",
                "mov r8, r2",
                "movs r2, #31",
                "ands r1, r2",
                "movs r2, #32",
                "subs r2, r2, r1",
                "lsls r1, r2, #2",
                "adds r1, r1, r2",
                "lsls r1, r1, #1",
                "mov r9, r1",
                "2:",
                "ldm r0!, {{r3-r6}}",
                "mov r1, r8",
                ".p2align 2",
                "add pc, r9",
                "nop",
                "3:",
                ".rept 32",
                $read,
                "adds r7, r7, r2",
                "adds r5, r5, r6",
                "adds r4, r4, r5",
                "adds r3, r3, r4",
                ".endr",
                "subs r1, r1, #1",
                "bmi 4f",
                "b 3b",
                "4:",
                // To the next row: the second, third and fourth of the table go to the one before.
                "ldm r0!, {{r3-r5}}",
                "subs r0, r0, #28",
                "ldr r1, [r0, #0]",
                "ldr r2, [r0, #4]",
                "ldr r6, [r0, #8]",
                "adds r1, r1, r3",
                "adds r2, r2, r4",
                "adds r6, r6, r5",
                "stm r0!, {{r1, r2, r6}}",
                "ldr r1, [r0, #20]",
                "ldr r2, [r0, #24]",
                "ldr r6, [r0, #36]",
                "adds r3, r3, r1",
                "adds r4, r4, r2",
                "adds r1, r1, r6",
                "str r3, [r0, #4]",
                "str r4, [r0, #8]",
                "str r1, [r0, #20]",
                "adds r0, r0, #52",
                "cmp r0, r10",
                "beq 5f",
                "b 2b",
                "5:",
                "subs r0, r0, #192",
                "movs r1, #1",
                "mov r2, r11",
                "subs r2, r2, r1",
                "mov r11, r2",
                "mov r2, r12",
                "subs r2, r2, r1",
                "mov r12, r2",
                "beq 6f",
                "b 1b",
                "6:",
                "mov r0, r7",
                "pop {{r4-r7}}",
                "mov r8, r4",
                "mov r9, r5",
                "mov r10, r6",
                "mov r11, r7",
                "pop {{r4-r7, pc}}",
            )
        }
    };
}

rows!(small, "lsrs r2, r3, #23");
rows!(screen, "asrs r2, r3, #22");
rows!(large, "asrs r2, r3, #16");
