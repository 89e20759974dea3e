//! A 320 × 240 colour frame without a display: the teapot in bands of 16 rows, streamed row by row out of the board to a
//! PPM on standard output (`mps2-an386`, semihosting); at the end the RAM that it took, on standard error.
//!
//! ```sh
//! cargo run --release --target thumbv7em-none-eabihf --example fw_frame > teapot.ppm
//! FW_FRAME_FILL=grid cargo run --release --target thumbv7em-none-eabihf --example fw_frame > teapot.ppm
//! ```
//!
//! With `CARGO_PROFILE_RELEASE_OPT_LEVEL=s` it takes 49 KB of flash instead of 78, by either fill.
//!
//! On a host the same calls write the same bytes; `tests/firmware_frame.rs` compares them. For your board, replace the
//! semihosting by your display's contiguous writes.
#![cfg_attr(target_os = "none", no_std, no_main)]

#[path = "data/frame.rs"]
pub(crate) mod frame;
#[path = "data/teapot.rs"]
pub(crate) mod teapot;

/// Exact points, or a grid of facets.
#[allow(dead_code, reason = "tests draw both")]
const GRID: bool = matches!(option_env!("FW_FRAME_FILL"), Some(fill) if matches!(fill.as_bytes(), b"grid"));
/// Facets of the list, if there is one.
const FACETS: usize = if GRID { frame::PART_FACETS } else { 0 };
const LINKS: usize = if GRID { FACETS + frame::BANDS } else { 0 };

type Buffers = frame::Buffers<{ frame::BAND }, FACETS, LINKS>;

#[cfg(not(target_os = "none"))]
fn main() -> std::io::Result<()> {
    use std::io::Write;
    let mut bytes = frame::PPM_HEAD.to_vec();
    let mut buffers = Box::new(Buffers::new());
    let drawn = frame::draw::<GRID, _, _>(&mut buffers, |row| bytes.extend_from_slice(&frame::ppm_row(row)));
    drawn.ok_or_else(|| std::io::Error::other("the frame was refused"))?;
    std::io::stdout().write_all(&bytes)
}

#[cfg(all(target_os = "none", target_arch = "arm"))]
#[path = "board/stack.rs"]
mod stack;

#[cfg(all(target_os = "none", target_arch = "arm"))]
mod board {
    use crate::{Buffers, GRID, frame, stack};
    use core::cell::RefCell;
    use core::fmt::Write;
    use cortex_m::interrupt::Mutex;
    use cortex_m_semihosting::{debug, hio};

    static BUFFERS: Mutex<RefCell<Buffers>> = Mutex::new(RefCell::new(Buffers::new()));

    /// Out of line: the bytes of a row and the drawing of a band need not stand on the stack together.
    #[inline(never)]
    fn send(out: &mut hio::HostStream, row: &[embedded_graphics_core::pixelcolor::Rgb565]) -> bool {
        out.write_all(&frame::ppm_row(row)).is_ok()
    }

    fn run() -> Option<()> {
        let mut out = hio::hstdout().ok()?;
        out.write_all(frame::PPM_HEAD).ok()?;
        let mut sent = true;
        cortex_m::interrupt::free(|token| {
            let mut buffers = BUFFERS.borrow(token).try_borrow_mut().ok()?;
            frame::draw::<GRID, _, _>(&mut buffers, |row| sent &= send(&mut out, row))
        })?;
        writeln!(hio::hstderr().ok()?, "RAM {}", stack::used()).ok()?;
        sent.then_some(())
    }

    #[cortex_m_rt::entry]
    fn main() -> ! {
        stack::paint();
        leave(run().is_some())
    }

    fn leave(done: bool) -> ! {
        debug::exit(if done { debug::EXIT_SUCCESS } else { debug::EXIT_FAILURE });
        loop {
            cortex_m::asm::wfi();
        }
    }

    #[panic_handler]
    fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
        leave(false)
    }
}

#[cfg(all(target_os = "none", not(target_arch = "arm")))]
#[panic_handler]
fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
    loop {}
}
