//! ARMv6-M.

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

/// The row with the coordinate read by `$read`.
///
/// r0: differences, r1: turns to go, r2: the coordinate, r3: v, r4, r5, r6: d1, d2, d3, r7: the sum, r8: turns, r9: where
/// to enter, r10: end of differences. A point takes 10 bytes.
macro_rules! row {
    ($name:ident, $read:literal) => {
        #[unsafe(naked)]
        unsafe extern "C" fn $name(class: &[[[i32; 4]; 4]; 3], count: u32) -> i32 {
            naked_asm!(
                "push {{r4-r7, lr}}",
                "mov r4, r8",
                "mov r5, r9",
                "mov r6, r10",
                "push {{r4-r6}}",
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
                "movs r1, #192",
                "add r1, r0",
                "mov r10, r1",
                "movs r7, #0",
                "2:",
                "ldm r0!, {{r3-r6}}",
                "adds r0, r0, #48",
                "mov r1, r8",
                ".p2align 2",
                "add pc, r9",
                "nop",
                "3:",
                ".rept 32",
                $read,
                "adds r7, r7, r2",
                "adds r3, r3, r4",
                "adds r4, r4, r5",
                "adds r5, r5, r6",
                ".endr",
                "subs r1, r1, #1",
                "bmi 4f",
                "b 3b",
                "4:",
                "cmp r0, r10",
                "beq 5f",
                "b 2b",
                "5:",
                "mov r0, r7",
                "pop {{r4-r6}}",
                "mov r8, r4",
                "mov r9, r5",
                "mov r10, r6",
                "pop {{r4-r7, pc}}",
            )
        }
    };
}

row!(small, "lsrs r2, r3, #23");
row!(screen, "asrs r2, r3, #22");
row!(large, "asrs r2, r3, #16");
