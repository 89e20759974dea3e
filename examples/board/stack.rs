//! RAM of a firmware on ARM: what the linker placed, and how far down the stack went, painted before and looked at after.

const PAINT: u32 = 0xA5A5_5A5A;

unsafe extern "C" {
    static mut __sdata: u32;
    static mut __sheap: u32;
    static mut _stack_start: u32;
}

/// The first word of RAM, the first after the statics, the end of the stack.
fn memory() -> [usize; 3] {
    // Addresses alone.
    [(&raw const __sdata) as usize, (&raw const __sheap) as usize, (&raw const _stack_start) as usize]
}

/// Paints what lies between the statics and the caller.
#[inline(never)]
pub(crate) fn paint() {
    let local = 0_u32;
    let here = (&raw const local) as usize & !3;
    for address in (memory()[1]..here - 64).step_by(4) {
        // SAFETY: RAM between the statics and this frame, which nobody uses.
        unsafe { (address as *mut u32).write_volatile(PAINT) };
    }
}

/// Bytes of RAM: statics, and the stack since [`paint`] with all that was on it before.
pub(crate) fn used() -> usize {
    let [start, statics, end] = memory();
    // SAFETY: the same words.
    let is_painted = |address: &usize| unsafe { (*address as *const u32).read_volatile() } == PAINT;
    let lowest = (statics..end).step_by(4).find(|address| !is_painted(address)).unwrap_or(end);
    (statics - start) + (end - lowest)
}
