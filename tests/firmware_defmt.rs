//! The log of `examples/fw_defmt.rs`, run under QEMU and decoded, is `examples/fw_defmt.out`.
//!
//! `UPDATE_DEFMT=1 cargo test --all-features --test firmware_defmt` writes that file anew; read what changed.
#![cfg(feature = "defmt")]
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

#[path = "common/budgets.rs"]
#[allow(dead_code)]
mod budgets;
#[path = "common/firmware.rs"]
mod firmware;

use defmt_decoder::{DecodeError, Table};
use std::fmt::Write;
use std::path::Path;

#[test]
fn the_log_of_thumbv7em_is_as_expected() {
    check("thumbv7em-none-eabihf");
}

#[test]
fn the_log_of_thumbv6m_is_as_expected() {
    check("thumbv6m-none-eabi");
}

fn check(target: &str) {
    let Some(runner) = firmware::board(target) else { return };
    // The format strings are sections that only this linker script keeps.
    let what = ["--features", "defmt", "--example", "fw_defmt", "--", "-C", "link-arg=-Tdefmt.x"];
    let folder = firmware::cargo("rustc", target, &what, &[firmware::FOR_SIZE]);
    let image = folder.join("examples/fw_defmt");
    let elf = std::fs::read(&image).unwrap();
    weigh(target, &elf);
    let log = decode(&elf, &firmware::run_bytes(&runner, &image));
    let path = Path::new(firmware::ROOT).join("examples/fw_defmt.out");
    if std::env::var_os("UPDATE_DEFMT").is_some() {
        std::fs::write(&path, &log).unwrap();
    }
    let expected = std::fs::read_to_string(&path).unwrap();
    for (k, (line, expected)) in log.lines().zip(expected.lines()).enumerate() {
        assert_eq!(line, expected, "line {} of {target}", k + 1);
    }
    assert_eq!(log.lines().count(), expected.lines().count(), "lines of {target}:\n{log}");
}

/// Logging brings in no soft float, no allocator, and no panic but those of `defmt-semihosting`: `panic!` and what that
/// calls, for a logger taken twice. A check of bounds, of a divisor or of an option would show by a name of its own.
fn weigh(target: &str, elf: &[u8]) {
    let is_loggers = |name: &str| {
        let name = format!("{:#}", rustc_demangle::demangle(name));
        ["core::panicking::panic_fmt", "core::panicking::panic"].contains(&name.as_str())
    };
    let names = firmware::symbols(elf).into_iter().filter(|name| !is_loggers(name));
    let offences: Vec<_> = names.filter_map(|name| Some((firmware::offence(&name)?, name))).collect();
    assert!(offences.is_empty(), "{target}: {offences:#?}");
    let (flash, ram) = firmware::sizes(elf);
    let measured = [("bytes of flash", flash), ("bytes of static memory", ram)];
    budgets::check(&format!("fw_defmt, {target}"), &measured.map(|(name, bytes)| (name.to_owned(), bytes)));
}

/// A line for each frame: its level and its message.
fn decode(elf: &[u8], bytes: &[u8]) -> String {
    let table = Table::parse(elf).unwrap().expect("a table of format strings");
    let mut stream = table.new_stream_decoder();
    stream.received(bytes);
    let mut log = String::new();
    loop {
        match stream.decode() {
            Ok(frame) => {
                let level = frame.level().map_or("print", |level| level.as_str());
                writeln!(log, "{level:5} {}", frame.display_message()).unwrap();
            }
            Err(DecodeError::UnexpectedEof) => return log,
            Err(DecodeError::Malformed) => panic!("a frame cannot be decoded, after\n{log}"),
        }
    }
}
