//! `examples/fw_intersect.rs`: pairs of surfaces on an emulated Cortex-M4 give the host's curves bit for bit, within the
//! 64 KB of RAM of `memory.x` at depth 5, without panic, heap or soft float; what they take is in `tests/budgets.txt`.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

#[path = "common/budgets.rs"]
#[allow(dead_code)]
mod budgets;
#[path = "../examples/fw_intersect.rs"]
#[allow(dead_code, reason = "its `main` is for `cargo run`")]
mod example;
#[path = "common/firmware.rs"]
mod firmware;

/// The RAM of `memory.x`; what is beside statics and stack is left.
const RAM: u64 = 64 * 1024;
/// A curve, a curve and a loop, two curves.
const CURVES: [usize; 3] = [1, 2, 2];

#[test]
fn surfaces_meet_within_64_kilobytes() {
    let mut host = String::new();
    example::report(&mut host).unwrap();
    assert_eq!(host.lines().count(), CURVES.len(), "{host}");
    for (line, curves) in host.lines().zip(CURVES) {
        assert!(
            line.contains(&format!(": {curves} curves, ")) && line.contains(", 0 pieces unrefined, certified,"),
            "{line}"
        );
    }
    let target = "thumbv7em-none-eabihf";
    let Some(runner) = firmware::board(target) else { return };
    let what = ["--example", "fw_intersect"];
    let image = firmware::cargo("build", target, &what, &[firmware::FOR_SIZE]).join("examples/fw_intersect");
    let elf = std::fs::read(&image).unwrap();
    assert_eq!(firmware::offences(&elf), []);
    let said = firmware::run(&runner, &image);
    let (flash, _) = firmware::sizes(&elf);
    println!("{said}{flash} bytes of flash");
    let rest = said.strip_prefix(&host).unwrap_or_else(|| panic!("the board says {said}, the host {host}"));
    let measured = rest.lines().map(|line| line.split_once(' ').unwrap());
    let mut measured: Vec<_> = measured.map(|(number, name)| (name.to_owned(), number.parse().unwrap())).collect();
    let ram = measured.iter().find(|(name, _)| name == "bytes of RAM").unwrap().1;
    assert!(ram <= RAM, "{ram} bytes of RAM");
    measured.push(("bytes of flash".to_owned(), flash));
    budgets::check("fw_intersect, thumbv7em-none-eabihf, opt-level s", &measured);
}
