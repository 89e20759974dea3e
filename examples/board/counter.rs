//! Instructions of a section of code under QEMU, exactly: runs repeat to the instruction, so counts can be budgets.
//!
//! ARM: CMSDK timer 0 of the `mps2` machines, 25 MHz, with `-icount shift=7`: an instruction takes 128 ns, a tick 40 ns,
//! so 3.2 ticks; it wraps after 1.3e9 instructions. RISC-V: `mcycle` with `-icount shift=0`, one an instruction. QEMU
//! counts translated guest instructions, not cycles: no claim about time follows.

/// Instructions that `section` takes, those of the counter itself left out; within 1 on ARM.
#[inline(never)]
pub(crate) fn count(section: impl FnOnce()) -> u32 {
    #[inline(never)]
    fn empty() -> u32 {
        measured(|| core::hint::black_box(()))
    }
    start();
    let own = empty();
    measured(section).wrapping_sub(own)
}

#[inline(always)]
fn measured(section: impl FnOnce()) -> u32 {
    let before = read();
    core::sync::atomic::compiler_fence(core::sync::atomic::Ordering::SeqCst);
    section();
    core::sync::atomic::compiler_fence(core::sync::atomic::Ordering::SeqCst);
    instructions(before, read())
}

#[cfg(all(target_os = "none", target_arch = "arm"))]
mod timer {
    const CONTROL: *mut u32 = 0x4000_0000 as *mut u32;
    const VALUE: *mut u32 = 0x4000_0004 as *mut u32;
    const RELOAD: *mut u32 = 0x4000_0008 as *mut u32;

    pub(super) fn start() {
        // SAFETY: the registers of CMSDK timer 0, which nothing else uses.
        unsafe {
            RELOAD.write_volatile(u32::MAX);
            VALUE.write_volatile(u32::MAX);
            CONTROL.write_volatile(1);
        }
    }

    #[inline(always)]
    pub(super) fn read() -> u32 {
        // SAFETY: as above; the timer counts down.
        unsafe { VALUE.read_volatile() }
    }

    /// Ticks of 40 ns to instructions of 128 ns, rounded half up.
    pub(super) fn instructions(before: u32, after: u32) -> u32 {
        let ticks = u64::from(before.wrapping_sub(after));
        ((ticks * 5 + 8) >> 4) as u32
    }
}

#[cfg(all(target_os = "none", target_arch = "riscv32"))]
mod timer {
    pub(super) fn start() {}

    #[inline(always)]
    pub(super) fn read() -> u32 {
        let cycles: u32;
        // SAFETY: reads a counter.
        unsafe { core::arch::asm!("csrr {}, mcycle", out(reg) cycles, options(nomem, nostack)) };
        cycles
    }

    pub(super) fn instructions(before: u32, after: u32) -> u32 {
        after.wrapping_sub(before)
    }
}

/// A host counts nothing.
#[cfg(not(target_os = "none"))]
mod timer {
    pub(super) fn start() {}

    pub(super) fn read() -> u32 {
        0
    }

    pub(super) fn instructions(_: u32, _: u32) -> u32 {
        0
    }
}

use timer::{instructions, read, start};
