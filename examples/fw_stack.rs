//! How much stack `Scene::draw` takes for patches of every kind: firmware that paints its stack, draws, and looks how
//! far down the paint is gone.
//!
//! `CARGO_PROFILE_RELEASE_OPT_LEVEL=s cargo run --release --target thumbv7em-none-eabihf --example fw_stack` prints a
//! line for each patch, and what [`stack_bytes`](embedded_surfaces::render::stack_bytes) says; at level 3 the image
//! exceeds the 256 KB of `memory.x`. `tests/firmware_stack.rs` compares the two.
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(not(target_os = "none"))]
fn main() {}

#[cfg(all(target_os = "none", target_arch = "arm"))]
#[path = "board/run.rs"]
mod run;

#[cfg(all(target_os = "none", target_arch = "arm"))]
pub(crate) use firmware::report;

#[cfg(all(target_os = "none", target_arch = "arm"))]
mod firmware {
    use core::fmt::{Error, Result, Write};
    use core::hint::black_box;
    use embedded_surfaces::geometry::Point3;
    use embedded_surfaces::num::I16F16;
    use embedded_surfaces::patch::{RationalTensorNet, SurfaceNet, TensorNet, TriangleNet};
    use embedded_surfaces::render::{Area, Fragment, Light, Scene, Style, Tile, stack_bytes};

    const PAINT: u32 = 0xA5A5_5A5A;
    /// What is painted below the caller, in bytes.
    const DEEPEST: usize = 44 * 1024;
    const AREA: Area = Area { x: 0, y: 40, width: 160, height: 16 };

    /// About where the stack ends now.
    #[inline(never)]
    fn here() -> usize {
        let local = 0_u8;
        black_box(&raw const local) as usize & !3
    }

    #[inline(never)]
    fn paint(top: usize) {
        for address in (top - DEEPEST..top - 256).step_by(4) {
            // SAFETY: unused stack between the heapless program's statics and this frame.
            unsafe { (address as *mut u32).write_volatile(PAINT) };
        }
    }

    fn used(top: usize) -> usize {
        // SAFETY: the same words.
        let is_painted = |address: &usize| unsafe { (*address as *const u32).read_volatile() } == PAINT;
        let lowest = (top - DEEPEST..top).step_by(4).find(|address| !is_painted(address));
        top - lowest.unwrap_or(top)
    }

    #[inline(never)]
    fn draw(scene: &Scene<'_, SurfaceNet<'_>>, tile: &mut Tile<'_, u8>) {
        black_box(scene.draw(tile, &|at: Fragment| at.shade));
    }

    fn measure(out: &mut impl Write, name: &str, net: SurfaceNet<'_>) -> Result {
        let (mut colour, mut depth) = ([0; AREA.pixels()], [0; AREA.pixels()]);
        let scene = Scene::new(core::slice::from_ref(&net), Light::default(), Style::Shaded).map_err(|_| Error)?;
        let mut tile = Tile::new(AREA, &mut colour, &mut depth, 0).map_err(|_| Error)?;
        let top = here();
        paint(top);
        draw(black_box(&scene), &mut tile);
        writeln!(out, "{name}: {} of {}", used(top), stack_bytes(net))
    }

    /// A wavy net that fills the tile, and more.
    fn points<const LEN: usize>(width: i32) -> [Point3; LEN] {
        let mut points = [Point3::ORIGIN; LEN];
        for (point, k) in points.iter_mut().zip(0..) {
            let (row, column) = (k / width, k % width);
            let wave = |seed: i32| (k * k * seed) % 400_000;
            *point =
                Point3::from_bits(row * 40 * 65_536 + wave(7919), column * 30 * 65_536 + wave(10_473), wave(31_337));
        }
        points
    }

    fn tensor(out: &mut impl Write, name: &str, degrees: (usize, usize), weights: Option<&[I16F16]>) -> Result {
        let points: [Point3; 81] = points(degrees.1 as i32 + 1);
        let len = (degrees.0 + 1) * (degrees.1 + 1);
        let net = TensorNet::new(degrees, points.get(..len).ok_or(Error)?).map_err(|_| Error)?;
        match weights.and_then(|weights| weights.get(..len)) {
            None => measure(out, name, SurfaceNet::Tensor(net)),
            Some(weights) => {
                let net = RationalTensorNet::new(net, weights).map_err(|_| Error)?;
                measure(out, name, SurfaceNet::RationalTensor(net))
            }
        }
    }

    fn triangle(out: &mut impl Write, name: &str, degree: usize) -> Result {
        let points: [Point3; 45] = points(degree as i32);
        let points = points.get(..(degree + 1) * (degree + 2) / 2).ok_or(Error)?;
        measure(out, name, SurfaceNet::Triangle(TriangleNet::new(degree, points).map_err(|_| Error)?))
    }

    pub(crate) fn report(out: &mut impl Write) -> Result {
        let mut weights = [I16F16::ONE; 81];
        for (weight, k) in weights.iter_mut().zip(0..) {
            *weight = I16F16::from_bits(65_536 + (k * 7919) % 60_000);
        }
        tensor(out, "bicubic", (3, 3), None)?;
        triangle(out, "cubic triangle", 3)?;
        triangle(out, "quintic triangle", 5)?;
        tensor(out, "biquintic", (5, 5), None)?;
        triangle(out, "octic triangle", 8)?;
        tensor(out, "degrees (8, 8)", (8, 8), None)?;
        tensor(out, "rational biquadratic", (2, 2), Some(&weights))?;
        tensor(out, "rational bicubic", (3, 3), Some(&weights))?;
        tensor(out, "rational biquartic", (4, 4), Some(&weights))
    }
}

#[cfg(all(target_os = "none", not(target_arch = "arm")))]
mod firmware {
    #[panic_handler]
    fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
        loop {}
    }
}
