//! A log by `defmt`: nets, plans, errors, scenes and statistics, as bytes whose text stays on the host.
//!
//! ```text
//! export CARGO_PROFILE_RELEASE_OPT_LEVEL=s # at level 3 it exceeds the 256 KB of memory.x
//! DEFMT_LOG=info cargo rustc --release --target thumbv7em-none-eabihf --features defmt --example fw_defmt -- \
//!     -C link-arg=-Tdefmt.x
//! qemu-system-arm -machine mps2-an386 -nographic -monitor none -serial null \
//!     -semihosting-config enable=on,target=native -kernel target/thumbv7em-none-eabihf/release/examples/fw_defmt |
//!     defmt-print -e target/thumbv7em-none-eabihf/release/examples/fw_defmt
//! ```
//!
//! `tests/firmware_defmt.rs` decodes the bytes and compares with `fw_defmt.out`. On a board, take `defmt-rtt` in the
//! place of `defmt-semihosting`. Without `DEFMT_LOG` only errors are compiled in.
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(not(target_os = "none"))]
fn main() {
    println!("fw_defmt is for a board; see the head of its source");
}

#[cfg(all(target_os = "none", target_arch = "arm"))]
mod target {
    use core::error::Error;
    use cortex_m as _; // the critical section of the log
    use cortex_m_semihosting::debug;
    use defmt::{debug, error, info, warn};
    use defmt_semihosting as _; // where the log goes
    use embedded_surfaces::const_net;
    use embedded_surfaces::forward::{CurveLattice, Lattice, LatticeError, Sampling, Steps};
    use embedded_surfaces::geometry::{Affine, GeometryError, Perspective, Point3, View};
    use embedded_surfaces::num::{Angle, I16F16, I32F32};
    use embedded_surfaces::patch::{
        BSplineCurve, BicubicPatch, CubicCurve, FlatTriangle, KnotVector, NetError, Parameter, QuadraticCurve,
        RationalCurve, SplineError, Surface,
    };
    use embedded_surfaces::render::{Area, Fragment, Frame, Light, Lines, RenderError, Scene, Style, Tile};
    use embedded_surfaces::subdivide::Tolerance;

    static WAVE: BicubicPatch = const_net!(BicubicPatch::from_ints([
        [[2, 3, 0], [1, 8, 6], [3, 20, -4], [1, 28, 1]],
        [[11, 1, 3], [12, 9, -5], [10, 22, 8], [12, 29, 0]],
        [[20, 3, -2], [19, 8, 9], [21, 19, -3], [19, 30, 2]],
        [[29, 2, 0], [30, 12, -6], [28, 20, 4], [29, 27, -1]],
    ]));
    static ARCH: CubicCurve = const_net!(CubicCurve::from_ints([[0, 0, 0], [0, 40, 0], [30, 40, 0], [30, 0, 0]]));

    #[cortex_m_rt::entry]
    fn main() -> ! {
        nets();
        maps();
        plans();
        errors();
        match pictures() {
            Ok(()) => leave(true),
            Err(refused) => error!("the scene was refused: {}", refused),
        }
        leave(false)
    }

    /// Coordinates are exact: bits over their scale.
    fn nets() {
        info!("{}", WAVE);
        info!("{}", ARCH);
        info!("{}", FlatTriangle::from_ints([[0, 0, 0], [80, 0, 0], [0, 80, 0]]));
        let quarter = QuadraticCurve::from_ints([[60, 0, 0], [60, 60, 0], [0, 60, 0]]);
        info!("{}", quarter.and_then(|net| RationalCurve::new(net, [1, 1, 2].map(I16F16::from_num))));
        let points = [[0, 0, 0], [9, 9, 0], [18, 0, 0], [27, 9, 0]].map(|[x, y, z]| Point3::from_ints(x, y, z));
        let knots = KnotVector::<3>::clamped(points.len());
        info!("{}", knots.and_then(|knots| BSplineCurve::new(&points, knots)));
        info!("{} at {}: {}", "the arch", Parameter::HALF, ARCH.net().eval(Parameter::HALF));
    }

    fn maps() {
        let view = View::default();
        info!("{}", view);
        info!("{}", Affine::scaling(I32F32::ONE, -I32F32::ONE, I32F32::from_bits(1 << 31)));
        let (centre_x, centre_y, distance) = (I16F16::from_num(16), I16F16::from_num(16), I16F16::from_num(90));
        info!("{}", Perspective { centre_x, centre_y, distance });
        info!("{}", WAVE.bounds());
        info!("{}", Angle::from_degrees(90));
    }

    fn plans() {
        let net = WAVE.surface();
        let (paper, sampling) = (Steps::paper(net), Sampling::cheapest(net));
        info!("{}, {}", paper, sampling);
        if let Ok(lattice) = Lattice::new(net, paper) {
            info!("{}", lattice);
            let (mut points, mut steps) = (lattice.points(), lattice.row_steps());
            debug!("first {}, {}", points.next(), points);
            if let Ok(steps) = &mut steps {
                debug!("{}, {}", steps.next(), steps.next());
                debug!("{}", *steps);
            }
        }
        if let Ok(curve) = CurveLattice::new(ARCH.net(), 120) {
            info!("{}", curve);
            let mut points = curve.points();
            debug!("first {}, {}", points.next(), points);
        }
    }

    /// Every kind of error, each with what it was about.
    fn errors() {
        let net: Result<BicubicPatch, NetError> = BicubicPatch::from_ints([[[i16::MIN; 3]; 4]; 4]);
        warn!("{}", net.err());
        let view: Result<Affine, GeometryError> = View::default().fit(ARCH.points(), 0, 240, I16F16::ONE);
        warn!("{}", view.err());
        let steps: Result<Steps, LatticeError> = Steps::uniform(0);
        warn!("{}", steps.err());
        let knots: Result<KnotVector<'_, 4>, SplineError> = KnotVector::<4>::clamped(2);
        warn!("{}", knots.err());
        let light: Result<Light, RenderError> = Light::towards(0, 0, 0, 40);
        warn!("{}", light.err());
        warn!("{}", Tolerance::new(I16F16::ZERO).err());
        // As text, for those who have none but `Display`.
        let source: &dyn Error = &LatticeError::Steps { r: 0, s: 3 };
        warn!("{}", defmt::Display2Format(source));
    }

    fn pictures() -> Result<(), RenderError> {
        let area = Area { x: 0, y: 0, width: 32, height: 32 };
        let patches = [WAVE];
        let (mut colour, mut depth) = ([0_u8; 32 * 16], [0; 32 * 16]);
        let grey = |at: Fragment| at.shade;
        for style in [Style::Shaded, Style::Wire(Lines::every(4))] {
            let scene = Scene::new(&patches, Light::default(), style)?;
            info!("{}", scene);
            let mut frame = Frame::new(scene, &grey, 0, area, 16)?;
            while let Some(band) = frame.next_band(&mut colour, &mut depth)? {
                debug!("{}", band);
            }
            info!("{}", frame);
            info!("{}", frame.statistics());
        }
        let scene = Scene::new(&patches, Light::default(), Style::Flat)?;
        let half = Area { height: 16, ..area };
        let mut tile = Tile::new(half, &mut colour, &mut depth, 0)?;
        scene.draw(&mut tile, &grey);
        info!("{}", tile);
        warn!("{}", Tile::new(area, &mut colour, &mut depth, 0).err());
        Ok(())
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

/// The log needs semihosting, for which `defmt-semihosting` knows Cortex-M best.
#[cfg(all(target_os = "none", not(target_arch = "arm")))]
#[panic_handler]
fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
    loop {}
}
