//! ARMv6-M.

use super::Walk;
use core::arch::naked_asm;

/// The points that [`pairs`] makes at most.
pub(in crate::forward) const PAIRS: usize = 48;

/// Makes 4·`fours` points of x, y, z, of each the value and its backward differences d1, d2, d3, which go past them. They go
/// to the first three of each six entries of `room`. Coordinates are above `shift` bits, 23 without a sign, 22 or 16 with
/// one.
pub(in crate::forward) fn pairs(rows: &mut [[i32; 4]; 3], room: &mut [i32; 6 * PAIRS], fours: usize, shift: u32) {
    let fours = fours.min(PAIRS / 4) as u32;
    // SAFETY: each reads and writes the twelve words of `rows` and writes the first 24·`fours` of `room`, which are no more
    // than there are.
    unsafe {
        match shift {
            23 => small_pairs(rows, room, fours),
            22 => screen_pairs(rows, room, fours),
            _ => large_pairs(rows, room, fours),
        }
    }
}

/// The rows with the coordinate of `$v` read by `$read` to r0.
///
/// In a row: r1, r2, r3: d1 of x, y, z, r4, r5, r6: v, r8, r9, r7: d2, r10, r11, r12: d3, lr: the sum, r0: a coordinate. Then
/// r0 reads the walk and r7 writes it, r1 to r6 hold two triples of it. On the stack: the walk, turns to go, where the row was
/// entered. A point takes 30 bytes. The walk's first words are where rows of no points are entered, and turns; or 0, for
/// which no row follows.
macro_rules! rows {
    ($name:ident, $read:literal, $shift:literal) => {
        #[unsafe(naked)]
        pub(super) unsafe extern "C" fn $name(walk: &mut Walk, count: u32, rows: u32) -> i32 {
            naked_asm!(
                "push {{r4-r7, lr}}",
                "mov r4, r8",
                "mov r5, r9",
                "mov r6, r10",
                "mov r7, r11",
                "push {{r4-r7}}",
                "sub sp, #12",
                "str r0, [sp]",
                // To the point that leaves the points of the row modulo 32.
                "lsrs r3, r1, #5",
                "movs r4, #31",
                "ands r1, r4",
                "movs r4, #32",
                "subs r4, r4, r1",
                "lsls r1, r4, #5",
                "lsls r4, r4, #1",
                "subs r1, r1, r4",
                "adr r5, 3f",
                "adds r1, r1, r5",
                "movs r4, #240",
                "lsls r4, r4, #2",
                "adds r5, r5, r4",
                "movs r4, r3",
                "cmp r2, #1",
                "bhi 2f",
                "movs r4, #0",
                "movs r5, #0",
                "2:",
                "stm r0!, {{r5}}",
                "stm r0!, {{r4}}",
                "ldr r4, [r0, #108]",
                "mov r10, r4",
                "ldr r4, [r0, #112]",
                "mov r11, r4",
                "ldr r4, [r0, #116]",
                "mov r12, r4",
                "movs r4, #0",
                "mov lr, r4",
                "b 5f",
                ".p2align 2",
                "3:",
                ".rept 32",
                concat!($read, " r0, r4, ", $shift),
                "add lr, r0",
                "add r8, r10",
                "add r1, r8",
                "adds r4, r4, r1",
                concat!($read, " r0, r5, ", $shift),
                "add lr, r0",
                "add r9, r11",
                "add r2, r9",
                "adds r5, r5, r2",
                concat!($read, " r0, r6, ", $shift),
                "add lr, r0",
                "add r7, r12",
                "adds r3, r3, r7",
                "adds r6, r6, r3",
                ".endr",
                "ldr r0, [sp, #4]",
                "subs r0, r0, #1",
                "bmi 4f",
                "str r0, [sp, #4]",
                "b 3b",
                // The next row is entered a point later, or after the first turn with a turn less.
                "4:",
                "ldr r0, [sp]",
                "ldr r1, [sp, #8]",
                "adds r1, r1, #30",
                "ldm r0!, {{r2, r3}}",
                "cmp r1, r2",
                "bhi 6f",
                "5:",
                "str r1, [sp, #8]",
                "str r3, [sp, #4]",
                // d1.
                "mov r7, r0",
                "ldm r0!, {{r1-r6}}",
                "adds r4, r4, r1",
                "adds r5, r5, r2",
                "adds r6, r6, r3",
                "stm r7!, {{r1-r6}}",
                "ldm r0!, {{r1-r3}}",
                "adds r1, r1, r4",
                "adds r2, r2, r5",
                "adds r3, r3, r6",
                "stm r7!, {{r1-r3}}",
                // d2, z first.
                "ldm r0!, {{r1-r6}}",
                "adds r1, r1, r4",
                "adds r2, r2, r5",
                "adds r3, r3, r6",
                "stm r7!, {{r1-r6}}",
                "mov r8, r3",
                "mov r9, r2",
                // v.
                "ldm r0!, {{r1-r6}}",
                "adds r4, r4, r1",
                "adds r5, r5, r2",
                "adds r6, r6, r3",
                "stm r7!, {{r1-r6}}",
                "ldm r0!, {{r1-r3}}",
                "adds r1, r1, r4",
                "adds r2, r2, r5",
                "adds r3, r3, r6",
                "stm r7!, {{r1-r3}}",
                "ldm r0!, {{r4-r6}}",
                "adds r4, r4, r1",
                "adds r5, r5, r2",
                "adds r6, r6, r3",
                "stm r7!, {{r4-r6}}",
                // d1 again, and d2 of z after it.
                "subs r0, r0, #84",
                "ldm r0!, {{r1-r3, r7}}",
                "ldr r0, [sp, #8]",
                "mov pc, r0",
                // 32 points before where it is now, and one less.
                "6:",
                "movs r1, #233",
                "lsls r1, r1, #2",
                "subs r1, r2, r1",
                "adds r1, r1, #2",
                "subs r3, r3, #1",
                "bmi 7f",
                "subs r0, r0, #4",
                "stm r0!, {{r3}}",
                "b 5b",
                "7:",
                "mov r0, lr",
                "add sp, #12",
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

rows!(small, "lsrs", "#23");
rows!(screen, "asrs", "#22");
rows!(large, "asrs", "#16");

/// The points with coordinates read by `$read` to r0.
///
/// r1, r3, r5: v of x, y, z, r2, r4, r6: d1, r8, r9, lr: d2, r10, r11, r12: d3, r7: where to write, r0: a coordinate. On the
/// stack: turns to go, the rows, where to enter, the room. Four points take 122 bytes.
macro_rules! pairs {
    ($name:ident, $read:literal, $shift:literal) => {
        #[unsafe(naked)]
        unsafe extern "C" fn $name(rows: &mut [[i32; 4]; 3], room: &mut [i32; 6 * PAIRS], fours: u32) {
            naked_asm!(
                "push {{r4-r7, lr}}",
                "mov r4, r8",
                "mov r5, r9",
                "mov r6, r10",
                "mov r7, r11",
                "push {{r4-r7}}",
                "sub sp, #16",
                "lsrs r3, r2, #3",
                "str r3, [sp]",
                "str r0, [sp, #4]",
                "str r1, [sp, #12]",
                "movs r3, #7",
                "ands r2, r3",
                "movs r3, #8",
                "subs r3, r3, r2",
                "movs r2, #122",
                "muls r3, r2, r3",
                "adr r2, 3f",
                "adds r2, r2, r3",
                "str r2, [sp, #8]",
                "ldm r0!, {{r1-r4}}",
                "mov r8, r3",
                "mov r10, r4",
                "ldm r0!, {{r3-r6}}",
                "mov r9, r5",
                "mov r11, r6",
                "ldm r0!, {{r5-r7}}",
                "mov lr, r7",
                "ldr r7, [r0]",
                "mov r12, r7",
                "ldr r7, [sp, #12]",
                "ldr r0, [sp, #8]",
                "mov pc, r0",
                ".p2align 2",
                "3:",
                ".rept 8",
                ".irp at, 0, 24, 48, 72",
                concat!($read, " r0, r1, ", $shift),
                "str r0, [r7, #\\at]",
                "add r8, r10",
                "add r2, r8",
                "adds r1, r1, r2",
                concat!($read, " r0, r3, ", $shift),
                "str r0, [r7, #\\at + 4]",
                "add r9, r11",
                "add r4, r9",
                "adds r3, r3, r4",
                concat!($read, " r0, r5, ", $shift),
                "str r0, [r7, #\\at + 8]",
                "add lr, r12",
                "add r6, lr",
                "adds r5, r5, r6",
                ".endr",
                "adds r7, r7, #96",
                ".endr",
                "ldr r0, [sp]",
                "subs r0, r0, #1",
                "bmi 4f",
                "str r0, [sp]",
                "b 3b",
                "4:",
                "ldr r0, [sp, #4]",
                "mov r7, r8",
                "stm r0!, {{r1, r2, r7}}",
                "adds r0, r0, #4",
                "mov r7, r9",
                "stm r0!, {{r3, r4, r7}}",
                "adds r0, r0, #4",
                "mov r7, lr",
                "stm r0!, {{r5-r7}}",
                "add sp, #16",
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

pairs!(small_pairs, "lsrs", "#23");
pairs!(screen_pairs, "asrs", "#22");
pairs!(large_pairs, "asrs", "#16");
