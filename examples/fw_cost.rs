//! Scratch.
#![allow(clippy::all)]
#![cfg_attr(target_os = "none", no_std, no_main)]
#[cfg(not(target_os = "none"))]
fn main() {}
#[cfg(all(target_os = "none", target_arch = "arm"))]
#[path = "data/teapot.rs"]
mod teapot;
#[cfg(all(target_os = "none", target_arch = "arm"))]
mod target {
    use cortex_m as _;
    use cortex_m_semihosting::{debug, hprintln};
    use embedded_surfaces::geometry::View;
    use embedded_surfaces::num::I16F16;
    use embedded_surfaces::render::{Area, Cull, Fragment, Frame, Light, Scene, Style};

    fn ticks() -> u32 {
        unsafe { (0x4000_0004 as *const u32).read_volatile() }
    }

    #[cortex_m_rt::entry]
    fn main() -> ! {
        unsafe {
            (0x4000_0008 as *mut u32).write_volatile(u32::MAX);
            (0x4000_0004 as *mut u32).write_volatile(u32::MAX);
            (0x4000_0000 as *mut u32).write_volatile(1);
        }
        let view = View::default().fit(super::teapot::vertices(), 320, 240, I16F16::from_num(0.92)).unwrap();
        let patches = super::teapot::patches(&view).unwrap();
        static mut COLOUR: [u16; 320 * 16] = [0; 320 * 16];
        static mut DEPTH: [u16; 320 * 16] = [0; 320 * 16];
        let (colour, depth) = unsafe { (&mut *(&raw mut COLOUR), &mut *(&raw mut DEPTH)) };
        for (cull, style) in [(Cull::None, Style::Shaded), (Cull::None, Style::Flat), (Cull::Back, Style::Shaded)] {
            let scene = Scene::new(core::hint::black_box(&patches), Light::default(), style).unwrap().with_cull(cull);
            let paint = |f: Fragment| u16::from(f.shade);
            let area = Area { x: 0, y: 0, width: 320, height: 240 };
            let mut frame = Frame::new(scene, &paint, 0, area, 16).unwrap();
            let mut sum = 0u32;
            let start = ticks();
            while let Some(band) = frame.next_band(colour, depth).unwrap() {
                sum = sum.wrapping_add(band.pixels()[77].into());
            }
            let used = (u64::from(start - ticks()) * 40 / 128) as u32;
            let s = frame.statistics();
            hprintln!(
                "{:?} {} instr, {} points {} pieces {} splits {}",
                cull as u8,
                used,
                s.points as u32,
                s.pieces,
                s.splits,
                sum
            );
        }
        debug::exit(debug::EXIT_SUCCESS);
        loop {}
    }
    #[panic_handler]
    fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
        hprintln!("panic");
        debug::exit(debug::EXIT_FAILURE);
        loop {}
    }
}
