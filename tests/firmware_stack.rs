//! The stack that drawing takes, measured under QEMU, is within what the crate says.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

#[path = "common/firmware.rs"]
mod firmware;

#[test]
fn drawing_stays_within_the_stack_that_is_promised() {
    let target = "thumbv7em-none-eabihf";
    let Some(runner) = firmware::board(target) else { return };
    let folder = firmware::cargo("build", target, &["--example", "fw_stack"], &[firmware::FOR_SIZE]);
    let said = firmware::run(&runner, &folder.join("examples/fw_stack"));
    println!("{said}");
    assert_eq!(said.lines().count(), 9);
    for line in said.lines() {
        let (name, figures) = line.split_once(": ").unwrap();
        let (used, promised) = figures.split_once(" of ").unwrap();
        let (used, promised): (usize, usize) = (used.parse().unwrap(), promised.parse().unwrap());
        assert!(used <= promised, "{line}");
        assert!(2 * used > promised, "{name}: the promise is too large to be of use: {figures}");
    }
}
