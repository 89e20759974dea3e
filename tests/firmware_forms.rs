//! The forms of the engine under QEMU, those in assembly with them: `examples/fw_forms.rs` prints what it prints here.
//!
//! What is not installed (a target, QEMU) is skipped with a message, or fails where `REQUIRE_FIRMWARE=1`.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

#[path = "common/firmware.rs"]
mod firmware;
#[path = "../examples/fw_forms.rs"]
#[allow(dead_code, reason = "its `main` is for `cargo run`")]
mod fw_forms;

use firmware::target_is_installed;
use firmware::{TARGETS, cargo_build_all, offence, program_is_installed, run, runner_of, skip, symbols};

#[test]
fn all_forms_give_the_same_points() {
    let mut expected = String::new();
    fw_forms::report(&mut expected).unwrap();
    assert!(expected.lines().count() > 300);
    let installed: Vec<_> = TARGETS.into_iter().filter(|target| target_is_installed(target)).collect();
    for target in TARGETS.iter().filter(|target| !installed.contains(target)) {
        skip(target, &format!("the Rust target (rustup target add {target})"));
    }
    let what = ["--example", "fw_forms", "--no-default-features", "--features", "asm"];
    let folder = cargo_build_all(&installed, "forms", &what);
    for target in installed {
        let image = folder.join(target).join("release/examples/fw_forms");
        let names = symbols(&std::fs::read(&image).unwrap());
        let offences: Vec<_> = names.iter().filter_map(|name| Some((offence(name)?, name))).collect();
        assert!(offences.is_empty(), "{target}: {offences:#?}");
        assert!(names.iter().any(|name| name.contains("forward3asm")), "{target}: no assembly in the image");
        let runner = runner_of(target);
        if !program_is_installed(&runner[0]) {
            skip(target, &runner[0]);
            continue;
        }
        let printed = run(&runner, &image);
        let differ = expected.lines().zip(printed.lines()).find(|(here, there)| here != there);
        assert_eq!(differ, None, "{target}");
        assert_eq!(expected.len(), printed.len());
    }
}
