//! The teapot turning on an OLED of 128 × 64 pixels and 16 greys: a board with 64 KB of RAM and 256 KB of flash, the
//! LM3S6965 evaluation kit. Every frame is made on the board: control points turned by a [`View`], patches drawn in
//! bands of 16 rows.
//!
//! ```text
//! export CARGO_TARGET_THUMBV7M_NONE_EABI_RUNNER="qemu-system-arm -machine lm3s6965evb -serial stdio -kernel"
//! export CARGO_PROFILE_RELEASE_OPT_LEVEL=s
//! cargo run --release --target thumbv7m-none-eabi --example fw_oled
//! ```
//!
//! At level `s` it takes 44 KB of flash, and 26 KB of RAM with the stack.
//!
//! It turns for ever. A byte n on the serial line asks for a halt: at the first frame from n on the board answers
//! `READY` with the frame's number and waits for the next byte. `tests/firmware_oled.rs` compares the panel with the
//! host's picture of that frame.
//!
//! For a board of your own, replace `board/lm3s6965.rs` by its HAL, the panel's driver by your panel's, and `memory.x`.
//!
//! [`View`]: embedded_surfaces::geometry::View
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(all(target_os = "none", target_arch = "arm"))]
#[path = "board/lm3s6965.rs"]
mod lm3s6965;
#[cfg(all(target_os = "none", target_arch = "arm"))]
#[path = "board/selected.rs"]
mod selected;
#[cfg(all(target_os = "none", target_arch = "arm"))]
#[path = "board/ssd0323.rs"]
mod ssd0323;
#[cfg(all(target_os = "none", target_arch = "arm"))]
#[path = "data/teapot.rs"]
#[allow(dead_code, reason = "its parts for hosts")]
mod teapot;
#[cfg(all(target_os = "none", target_arch = "arm"))]
#[path = "data/turning.rs"]
mod turning;

#[cfg(not(target_os = "none"))]
fn main() {
    println!("fw_oled is for a board; `cargo run --example gallery` draws its picture on a host");
}

#[cfg(all(target_os = "none", target_arch = "arm"))]
mod target {
    use super::lm3s6965::{Board, Serial};
    use super::selected::Selected;
    use super::ssd0323::Ssd0323;
    use super::turning::{Buffers, draw};
    use core::fmt::Write;

    #[cortex_m_rt::entry]
    fn main() -> ! {
        let Board { spi, select, data, mut serial } = Board::start();
        let Ok(device) = Selected::new(spi, select);
        let mut display = Ssd0323::new(device, data);
        let Ok(()) = display.start();
        let (mut frame, mut halt) = (0, None);
        // Static, so that the linker knows of it.
        let Some(buffers) = cortex_m::singleton!(: Buffers = Buffers::new()) else { stop() };
        while let Ok(_statistics) = draw(frame, buffers, &mut display) {
            halt = halt.or_else(|| serial.received());
            if halt.is_some_and(|first| frame >= u32::from(first)) {
                let _ = writeln!(serial, "READY {frame}");
                halt = Some(wait(&mut serial));
            }
            frame = frame.wrapping_add(1);
        }
        let _ = writeln!(serial, "fw_oled: frame {frame} was refused");
        stop()
    }

    /// The next byte from the serial line.
    fn wait(serial: &mut Serial) -> u8 {
        loop {
            if let Some(byte) = serial.received() {
                return byte;
            }
        }
    }

    fn stop() -> ! {
        loop {
            cortex_m::asm::wfi();
        }
    }

    #[panic_handler]
    fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
        stop()
    }
}

/// There is no OLED on QEMU's RISC-V machine.
#[cfg(all(target_os = "none", not(target_arch = "arm")))]
mod target {
    #[panic_handler]
    fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
        loop {}
    }
}
