//! P1 and P4 on the linked firmware: `examples/fw_smoke.rs` is built for each bare-metal target, run under QEMU and
//! compared with an exact oracle; its symbols show no panic, no soft float and no allocator.
//!
//! What is not installed (a target, QEMU) is skipped with a message, or fails where `REQUIRE_FIRMWARE=1`.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

#[path = "../examples/fw_smoke.rs"]
#[allow(dead_code, reason = "its `main` is for `cargo run`")]
mod fw_smoke;

#[path = "common/firmware.rs"]
mod firmware;

use embedded_surfaces::geometry::Point3;
use firmware::{TARGETS, cargo_build_all, installed, installed_runner, offence, offences, run, runner, symbols};
use std::path::PathBuf;
use std::sync::OnceLock;

#[test]
fn thumbv6m() {
    check("thumbv6m-none-eabi");
}

#[test]
fn thumbv7m() {
    check("thumbv7m-none-eabi");
}

#[test]
fn thumbv7em() {
    check("thumbv7em-none-eabihf");
}

#[test]
fn riscv32imc() {
    check("riscv32imc-unknown-none-elf");
}

/// Where the images of all targets are, which are built at once; the library alone is, too.
fn images() -> &'static PathBuf {
    static IMAGES: OnceLock<PathBuf> = OnceLock::new();
    IMAGES.get_or_init(|| {
        let targets = installed(&TARGETS);
        // Nothing of it is run: that it builds, constant assertions included, does not depend on the level.
        let plain = ["--lib", "--no-default-features", "--config", "profile.release.opt-level=0"];
        cargo_build_all(&targets, "smoke", &plain);
        cargo_build_all(&targets, "smoke", &["--example", "fw_smoke"])
    })
}

/// Reads a firmware's symbols, runs it and compares what it prints.
fn check(target: &str) {
    if installed(&[target]).is_empty() {
        return;
    }
    let image = images().join(target).join("release/examples/fw_smoke");
    let offences = offences(&std::fs::read(&image).unwrap());
    assert!(offences.is_empty(), "{target}: {offences:#?}");

    let Some(runner) = installed_runner(target) else { return };
    assert_eq!(run(&runner, &image), expected_line(), "{target}");
}

/// floor(S + 1/2) of the patch's lattice by direct Bernstein sums: [i, j, x, y, z] in row order.
fn oracle(points: &[[Point3; 4]; 4], n: i128) -> Vec<[i128; 5]> {
    let bernstein = |k: usize, i: i128| [1, 3, 3, 1][k] * i.pow(k as u32) * (n - i).pow(3 - k as u32);
    let mut lattice = Vec::new();
    for (j, i) in (0..=n).flat_map(|j| (0..=n).map(move |i| (j, i))) {
        let mut sum = [0; 3];
        for (a, b) in (0..4).flat_map(|a| (0..4).map(move |b| (a, b))) {
            for (sum, c) in sum.iter_mut().zip(points[a][b].to_array()) {
                *sum += bernstein(a, i) * bernstein(b, j) * i128::from(c.to_bits());
            }
        }
        let one = n.pow(6) << 16;
        let [x, y, z] = sum.map(|s| (2 * s + one).div_euclid(2 * one));
        lattice.push([i, j, x, y, z]);
    }
    lattice
}

/// The line that every target has to print, from the oracle.
fn expected_line() -> String {
    let lattice = oracle(fw_smoke::PATCH.points(), fw_smoke::STEPS.into());
    let sum = lattice.as_flattened().iter().fold(0, |sum, value| fw_smoke::append(sum, *value as u32));
    format!("fw_smoke: {} points, checksum {sum:08x}\n", lattice.len())
}

#[test]
fn the_host_prints_what_the_oracle_says() {
    let mut line = String::new();
    fw_smoke::report(&mut line).unwrap();
    assert_eq!(line, expected_line());
}

#[test]
fn the_checksum_sees_every_point_and_its_place() {
    let mut values = oracle(fw_smoke::PATCH.points(), 3).concat();
    let checksum = |values: &[i128]| values.iter().fold(0, |sum, v| fw_smoke::append(sum, *v as u32));
    let whole = checksum(&values);
    for k in 1..values.len() {
        if values[k - 1] != values[k] {
            values.swap(k - 1, k);
            assert_ne!(checksum(&values), whole, "values {} and {k} swapped", k - 1);
            values.swap(k - 1, k);
        }
        values[k] += 1;
        assert_ne!(checksum(&values), whole, "value {k} changed");
        values[k] -= 1;
    }
}

#[test]
fn the_gate_flags_panics_soft_float_and_allocators() {
    let forbidden = [
        ("_ZN4core9panicking5panic17h0123456789abcdefE", "a panic"),
        ("_RNvNtCseold96UKqg_4core9panicking18panic_bounds_check", "a panic"),
        ("core::panicking::panic_const::panic_const_div_by_zero", "a panic"),
        ("__aeabi_fadd", "soft float"),
        ("__aeabi_dmul", "soft float"),
        ("__aeabi_ui2d", "soft float"),
        ("__aeabi_f2lz", "soft float"),
        ("__aeabi_cdcmple", "soft float"),
        ("__addsf3", "soft float"),
        ("__divdf3", "soft float"),
        ("__ltsf2", "soft float"),
        ("__floatunsidf", "soft float"),
        ("__fixunssfdi", "soft float"),
        ("__truncdfsf2", "soft float"),
        ("__extendhfsf2", "soft float"),
        ("__powidf2", "soft float"),
        ("__rust_alloc", "an allocator"),
        ("_RNvCs1_7___rustc12___rust_alloc", "an allocator"),
        ("_RNvCs1_7___rustc14___rust_dealloc", "an allocator"),
        ("__rg_alloc", "an allocator"),
        ("__rdl_realloc", "an allocator"),
        ("malloc", "an allocator"),
    ];
    for (name, why) in forbidden {
        assert_eq!(offence(name), Some(why), "{name}");
    }
}

#[test]
fn the_gate_lets_integers_and_the_handler_pass() {
    let allowed = [
        "main",
        "rust_begin_unwind",
        "_RNvCs1_7___rustc17rust_begin_unwind",
        "__aeabi_lmul",
        "__aeabi_uidivmod",
        "__aeabi_idiv",
        "__aeabi_ldivmod",
        "__aeabi_memcpy8",
        "__aeabi_llsl",
        "__muldi3",
        "__divsi3",
        "__multi3",
        "__udivmoddi4",
        "__clzsi2",
        // A hash may spell anything.
        "_ZN17embedded_surfaces7forward4walk16difference_table17hebbad454a78df330E",
    ];
    for name in allowed {
        assert_eq!(offence(name), None, "{name}");
    }
}

#[test]
#[cfg(target_os = "linux")]
fn symbols_are_read_from_this_very_program() {
    let image = std::fs::read(std::env::current_exe().unwrap()).unwrap();
    // A host program allocates and panics: the gate must see it.
    let found: Vec<_> = symbols(&image).iter().filter_map(|name| offence(name)).collect();
    assert!(found.contains(&"a panic") && found.contains(&"an allocator"), "{found:?}");
}

#[test]
fn runners_come_from_the_section_of_their_target() {
    let config = "[target.a]\nrunner = \"one -x\"\n\n[target.b]\nrustflags = [\"-y\"]\nrunner = \"two -kernel\"\n";
    assert_eq!(runner(config, "a"), ["one", "-x"]);
    assert_eq!(runner(config, "b"), ["two", "-kernel"]);
}
