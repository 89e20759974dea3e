//! The forms of the engine under QEMU, with the feature `asm` and without: `examples/fw_forms.rs` prints what it prints here.
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
    for (folder, features) in [("forms-asm", "asm"), ("forms", "")] {
        let what = ["--example", "fw_forms", "--no-default-features", "--features", features];
        let folder = cargo_build_all(&installed, folder, &what);
        for target in &installed {
            let image = folder.join(target).join("release/examples/fw_forms");
            let names = symbols(&std::fs::read(&image).unwrap());
            let offences: Vec<_> = names.iter().filter_map(|name| Some((offence(name)?, name))).collect();
            assert!(offences.is_empty(), "{target}, features {features:?}: {offences:#?}");
            let form = names.iter().any(|name| name.contains("forward::asm") || name.contains("forward3asm"));
            assert_eq!(form, !features.is_empty(), "{target}: assembly with features {features:?}");
            let runner = runner_of(target);
            if program_is_installed(&runner[0]) {
                let printed = run(&runner, &image);
                let differ = expected.lines().zip(printed.lines()).find(|(here, there)| here != there);
                assert_eq!(differ, None, "{target}, features {features:?}");
                assert_eq!(expected.len(), printed.len());
            } else {
                skip(target, &runner[0]);
            }
        }
    }
}
