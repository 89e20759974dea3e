//! How a firmware example runs: it writes a report, line by line, and ends QEMU with a status.
//!
//! The example holds `#[path = "board/run.rs"] mod run;`, a function `report(&mut impl core::fmt::Write)`, and for the
//! host `fn main() { run::on_host() }`. An error from `report` is a failure.

/// Prints the report; status 1 for an error.
#[cfg(not(target_os = "none"))]
pub(crate) fn on_host() {
    let mut text = String::new();
    let result = super::report(&mut text);
    print!("{text}");
    if result.is_err() {
        std::process::exit(1);
    }
}

/// Output by semihosting.
#[cfg(all(target_os = "none", target_arch = "arm"))]
mod target {
    use cortex_m as _; // the critical section of `hprint!`
    use cortex_m_semihosting::{debug, hio, hprintln};

    #[cortex_m_rt::entry]
    fn main() -> ! {
        let done = hio::hstdout().is_ok_and(|mut out| super::super::report(&mut out).is_ok());
        if !done {
            hprintln!("the report failed");
        }
        leave(done)
    }

    #[panic_handler]
    fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
        leave(false)
    }

    /// A stack that overflows ends here, if there is room for that: QEMU stops instead of waiting for the watchdog.
    #[cortex_m_rt::exception]
    unsafe fn HardFault(_: &cortex_m_rt::ExceptionFrame) -> ! {
        leave(false)
    }

    fn leave(done: bool) -> ! {
        debug::exit(if done { debug::EXIT_SUCCESS } else { debug::EXIT_FAILURE });
        loop {
            cortex_m::asm::wfi();
        }
    }
}

/// Output by the UART of QEMU's `virt` machine, exit by its test device.
#[cfg(all(target_os = "none", target_arch = "riscv32"))]
mod target {
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
        leave(super::super::report(&mut Uart).is_ok())
    }

    #[panic_handler]
    fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
        leave(false)
    }

    fn leave(done: bool) -> ! {
        // SAFETY: the test device: 0x5555 ends QEMU with status 0, (code << 16) | 0x3333 with that code.
        unsafe { TEST_DEVICE.write_volatile(if done { 0x5555 } else { 1 << 16 | 0x3333 }) };
        loop {}
    }
}
