//! `examples/fw_skin.rs`: a mesh of 200 vertices on an emulated Cortex-M3 gives the host's control points, within 64 KB of
//! RAM, and without panic, heap or soft float.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

#[path = "../examples/fw_skin.rs"]
#[allow(dead_code, reason = "its `main` is for `cargo run`")]
mod example;
#[path = "common/firmware.rs"]
mod firmware;

/// Shifts and stack, in bytes: measured, with a little room.
const MOST: usize = 20 * 1024;

#[test]
fn a_mesh_of_200_vertices_streams_within_64_kilobytes() {
    let mut host = String::new();
    example::report(&mut host).unwrap();
    assert_eq!(host.lines().count(), 2, "{host}");
    let target = "thumbv7m-none-eabi";
    let Some(runner) = firmware::board(target) else { return };
    let image =
        firmware::cargo("build", target, &["--example", "fw_skin"], &[firmware::FOR_SIZE]).join("examples/fw_skin");
    let elf = std::fs::read(&image).unwrap();
    let offences: Vec<_> =
        firmware::symbols(&elf).into_iter().filter(|name| firmware::offence(name).is_some()).collect();
    assert_eq!(offences, [""; 0]);
    let said = firmware::run(&runner, &image);
    let (flash, statics) = firmware::sizes(&elf);
    println!("{said}{flash} bytes of flash");
    let rest = said.strip_prefix(&host);
    let ram = rest.and_then(|rest| rest.lines().find_map(|line| line.strip_prefix("RAM "))).map(str::parse::<usize>);
    let ram = ram.unwrap_or_else(|| panic!("the board says {said}, the host {host}")).unwrap() + statics as usize;
    assert!(ram <= MOST, "{ram} bytes of RAM");
}
