//! How firmware under QEMU prints a line and ends: semihosting on ARM, the UART and the test device of the `virt`
//! machine on RISC-V. The crate root has `report`, which writes the line.

#[cfg(target_arch = "arm")]
mod machine {
    use cortex_m as _; // the critical section of `hstdout`
    use cortex_m_semihosting::{debug, hio};

    #[cortex_m_rt::entry]
    fn main() -> ! {
        leave(hio::hstdout().is_ok_and(|mut out| crate::report(&mut out).is_ok()))
    }

    pub(super) fn leave(done: bool) -> ! {
        debug::exit(if done { debug::EXIT_SUCCESS } else { debug::EXIT_FAILURE });
        loop {
            cortex_m::asm::wfi();
        }
    }
}

#[cfg(target_arch = "riscv32")]
mod machine {
    const UART: *mut u8 = 0x1000_0000 as *mut u8;
    const TEST_DEVICE: *mut u32 = 0x10_0000 as *mut u32;

    struct Uart;

    impl core::fmt::Write for Uart {
        fn write_str(&mut self, text: &str) -> core::fmt::Result {
            for byte in text.bytes() {
                // SAFETY: the transmit register of the 16550 at this address; QEMU's is always ready.
                unsafe { UART.write_volatile(byte) };
            }
            Ok(())
        }
    }

    #[riscv_rt::entry]
    fn main() -> ! {
        leave(crate::report(&mut Uart).is_ok())
    }

    pub(super) fn leave(done: bool) -> ! {
        // SAFETY: the test device: 0x5555 ends QEMU with status 0, (code << 16) | 0x3333 with that code.
        unsafe { TEST_DEVICE.write_volatile(if done { 0x5555 } else { 1 << 16 | 0x3333 }) };
        loop {}
    }
}

#[panic_handler]
fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
    machine::leave(false)
}
