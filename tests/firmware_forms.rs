//! The forms of the engine under QEMU, those in assembly with them: `examples/fw_forms.rs` prints what it prints here.
//!
//! What is not installed (a target, QEMU) is skipped with a message, or fails where `REQUIRE_FIRMWARE=1`.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

#[path = "common/firmware.rs"]
mod firmware;
#[path = "../examples/fw_forms.rs"]
#[allow(dead_code, reason = "its `main` is for `cargo run`")]
mod fw_forms;

use firmware::{TARGETS, cargo_build_all, installed, installed_runner, offences, run, symbols};

#[test]
fn all_forms_give_the_same_points() {
    let mut expected = String::new();
    fw_forms::report(&mut expected).unwrap();
    assert!(expected.lines().count() > 300);
    let targets = installed(&TARGETS);
    let folder = cargo_build_all(&targets, "asm", &firmware::WITH_ASSEMBLY);
    for target in targets {
        let image = folder.join(target).join("release/examples/fw_forms");
        let elf = std::fs::read(&image).unwrap();
        assert_eq!(offences(&elf), [], "{target}");
        assert!(symbols(&elf).iter().any(|name| name.contains("forward3asm")), "{target}: no assembly in the image");
        let Some(runner) = installed_runner(target) else { continue };
        let printed = run(&runner, &image);
        let differ = expected.lines().zip(printed.lines()).find(|(here, there)| here != there);
        assert_eq!(differ, None, "{target}");
        assert_eq!(expected.len(), printed.len());
    }
}
