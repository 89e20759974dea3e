//! ARMv7-M.

use core::arch::naked_asm;
use core::marker::PhantomData;

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

/// The most points that [`Places`] and [`Depths`] take at a time.
pub(in crate::forward) const PIXELS: usize = 128;

/// x and y in a row: where points are.
///
/// A value has 64 bits, the coordinate above and the fraction below; a step adds its first difference times `by` to it,
/// which is 2^32/N. Differences are backward ones, the value is of the next point.
#[repr(C)]
pub(in crate::forward) struct Places {
    /// Lower and upper half of the value, d1, d2, d3.
    x: [i32; 5],
    y: [i32; 5],
    by: i32,
    width: u32,
}

impl Places {
    pub(in crate::forward) fn new(by: i32, width: u32) -> Self {
        Self { x: [0; 5], y: [0; 5], by, width }
    }

    /// Goes to a row.
    pub(in crate::forward) fn start(&mut self, x: [i32; 5], y: [i32; 5]) {
        (self.x, self.y) = (x, y);
    }

    /// Writes y·width + x modulo 2^32 of the next `count` points to the front of `pixels`.
    pub(in crate::forward) fn next(&mut self, pixels: &mut [u32; PIXELS], count: u32) {
        // SAFETY: it reads the twelve words of `self`, of which `repr(C)` tells the order, and writes ten of them and the first
        // `count` entries of `pixels`, which are no more than there are.
        unsafe { places(self, pixels, count.min(PIXELS as u32)) }
    }
}

/// z in a row, and the entries (z + 2^15)·2^16 + tag that are to be stored where they are less than what is there.
#[repr(C)]
pub(in crate::forward) struct Depths<'b> {
    /// As in [`Places`].
    z: [i32; 5],
    by: i32,
    /// The tag of the next point, and 2^31.
    tag: u32,
    by_i: u32,
    entries: *mut u32,
    len: u32,
    borrowed: PhantomData<&'b mut [u32]>,
}

impl<'b> Depths<'b> {
    pub(in crate::forward) fn new(by: i32, by_i: u16, entries: &'b mut [u32]) -> Self {
        // A slice of words has less than 2^30 of them here.
        let (entries, len) = (entries.as_mut_ptr(), entries.len() as u32);
        Self { z: [0; 5], by, tag: 0, by_i: by_i.into(), entries, len, borrowed: PhantomData }
    }

    /// Goes to a row.
    pub(in crate::forward) fn start(&mut self, z: [i32; 5], tag: u16) {
        (self.z, self.tag) = (z, 1 << 31 | u32::from(tag));
    }

    /// Stores the next `count` points at the entries that `pixels` tells; those that are not there are left out.
    pub(in crate::forward) fn next(&mut self, pixels: &[u32; PIXELS], count: u32) {
        // SAFETY: it reads the ten words of `self`, of which `repr(C)` tells the order, and writes ten of them; it reads the
        // first `count` entries of `pixels`, which are no more than there are; it reads and writes those of the `len` words
        // at `entries` whose number, compared with `len` each time, is less. These are borrowed for as long as `self` lives,
        // and `entries` and `len` cannot be changed.
        unsafe { depths(self, pixels, count.min(PIXELS as u32)) }
    }
}

/// r0: by, r1: where to write, r2: width, r3:r4 x, r5, r6, r7 its d1, d2, d3, r8:r9 y, r10, r11, r12 its d1, d2, d3, lr: the
/// pixel; on the stack `places` and where to end. A point takes 24 bytes.
#[unsafe(naked)]
unsafe extern "C" fn places(places: &mut Places, pixels: &mut [u32; PIXELS], count: u32) {
    naked_asm!(
        "push {{r4-r11, lr}}",
        "add r3, r1, r2, lsl #2",
        "push {{r0, r3}}",
        "and r2, r2, #31",
        "rsb r2, r2, #32",
        "add r2, r2, r2, lsl #1",
        "lsl lr, r2, #3",
        "ldr r2, [r0, #44]",
        "ldm r0, {{r3-r12}}",
        "ldr r0, [r0, #40]",
        ".p2align 2",
        "add pc, lr",
        "nop",
        "3:",
        ".rept 32",
        "mla lr, r9, r2, r4",
        "add r6, r7",
        "add r5, r6",
        "smlal r3, r4, r5, r0",
        "add r11, r12",
        "add r10, r11",
        "smlal r8, r9, r10, r0",
        "str lr, [r1], #4",
        ".endr",
        "ldr lr, [sp, #4]",
        "cmp r1, lr",
        "bne.w 3b",
        "ldr r0, [sp]",
        "stm r0, {{r3-r12}}",
        "add sp, sp, #8",
        "pop {{r4-r11, pc}}",
    )
}

/// r0: the pixel, r1: where to read it, r2: what is to be stored, r3:r4 z, r5, r6, r7 its d1, d2, d3, r8: by, r9: the tag,
/// r10: what is added to it, r11: the entries, r12: how many, lr: what is there; on the stack `depths` and where to end. A
/// point takes 32 bytes.
///
/// The second comparison is made where the first one said that the entry is there; the store looks at the last that was
/// made.
#[unsafe(naked)]
unsafe extern "C" fn depths(depths: &mut Depths<'_>, pixels: &[u32; PIXELS], count: u32) {
    naked_asm!(
        "push {{r4-r11, lr}}",
        "add r3, r1, r2, lsl #2",
        "push {{r0, r3}}",
        "and r2, r2, #31",
        "rsb r2, r2, #32",
        "lsl r2, r2, #5",
        "ldm r0, {{r3-r12}}",
        ".p2align 2",
        "add pc, r2",
        "nop",
        "3:",
        ".rept 32",
        "ldr r0, [r1], #4",
        "add.w r2, r9, r4, lsl #16",
        "add r6, r7",
        "add r5, r6",
        "smlal r3, r4, r5, r8",
        "add r9, r10",
        "cmp r0, r12",
        "ittt lo",
        "ldrlo.w lr, [r11, r0, lsl #2]",
        "cmplo r2, lr",
        "strlo.w r2, [r11, r0, lsl #2]",
        ".endr",
        "ldr r0, [sp, #4]",
        "cmp r1, r0",
        "bne.w 3b",
        "ldr r0, [sp]",
        "stm r0, {{r3-r12}}",
        "add sp, sp, #8",
        "pop {{r4-r11, pc}}",
    )
}
