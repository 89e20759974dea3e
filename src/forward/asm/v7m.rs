//! ARMv7-M.

use core::arch::naked_asm;

/// The sum of `count` points of a row: each axis has x, d1, d2, d3 at the start of its 16 words, and its e; `by` is 2^32/N.
///
/// The value x:e has 64 bits; a step adds d1·by to it, which moves x.
pub(in crate::forward) fn product_row(class: &[[[i32; 4]; 4]; 3], e: &[i32; 3], by: i32, count: u32) -> i32 {
    // SAFETY: it reads three times four words of `class`, 64 bytes apart, and three of `e`.
    unsafe { product(class, e, by, count) }
}

/// The sum of `count` points of a row of 64-bit values v, d1, d2, d3 at the start of the 16 of each axis; the coordinate
/// is the upper 16 bits of v.
pub(in crate::forward) fn wide_row(table: &[[[i64; 4]; 4]; 3], count: u32) -> i32 {
    // SAFETY: it reads three times four double words of `table`, 128 bytes apart.
    unsafe { wide(table, count) }
}

/// r0: differences, r1: e, r2: by, r3: end of differences, r4:r5 value, r6, r7, r8: d1, d2, d3, r9: turns to go, r10: where
/// to enter, r11: turns, r12: the sum. A point takes 12 bytes.
#[unsafe(naked)]
unsafe extern "C" fn product(class: &[[[i32; 4]; 4]; 3], e: &[i32; 3], by: i32, count: u32) -> i32 {
    naked_asm!(
        "push {{r4-r11, lr}}",
        "lsr r11, r3, #6",
        "and r10, r3, #63",
        "rsb r10, r10, #64",
        "add r10, r10, r10, lsl #1",
        "lsl r10, r10, #2",
        "add r3, r0, #192",
        "mov r12, #0",
        "2:",
        "ldm r0, {{r5-r8}}",
        "ldr r4, [r1], #4",
        "add r0, r0, #64",
        "mov r9, r11",
        ".p2align 2",
        "add pc, r10",
        "nop",
        "3:",
        ".rept 64",
        "add.w r12, r12, r5",
        "smlal r4, r5, r6, r2",
        "add r6, r7",
        "add r7, r8",
        ".endr",
        "subs r9, r9, #1",
        "bpl.w 3b",
        "cmp r0, r3",
        "bne.w 2b",
        "mov r0, r12",
        "pop {{r4-r11, pc}}",
    )
}

/// r0: differences, r1: turns and r2: where to enter, r3: end of differences, r4:r5 v, r6:r7 d1, r8:r9 d2, r10:r11 d3,
/// r12: turns to go, lr: the sum. A point takes 28 bytes.
#[unsafe(naked)]
unsafe extern "C" fn wide(table: &[[[i64; 4]; 4]; 3], count: u32) -> i32 {
    naked_asm!(
        "push {{r4-r11, lr}}",
        "and r2, r1, #31",
        "lsr r1, r1, #5",
        "rsb r2, r2, #32",
        "rsb r2, r2, r2, lsl #3",
        "lsl r2, r2, #2",
        "add r3, r0, #384",
        "mov lr, #0",
        "2:",
        "ldm r0, {{r4-r11}}",
        "add r0, r0, #128",
        "mov r12, r1",
        ".p2align 2",
        "add pc, r2",
        "nop",
        "3:",
        ".rept 32",
        "add.w lr, lr, r5, asr #16",
        "adds.w r4, r4, r6",
        "adc.w r5, r5, r7",
        "adds.w r6, r6, r8",
        "adc.w r7, r7, r9",
        "adds.w r8, r8, r10",
        "adc.w r9, r9, r11",
        ".endr",
        "subs r12, r12, #1",
        "bpl.w 3b",
        "cmp r0, r3",
        "bne.w 2b",
        "mov r0, lr",
        "pop {{r4-r11, pc}}",
    )
}
