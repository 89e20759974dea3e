//! What a picture takes on parts of four sizes, `examples/fw_parts.rs`: flash and static RAM of the images, stack of their
//! runs, against `tests/budgets.txt`; the README's table is made of these.
//!
//! `UPDATE_BUDGETS=1` writes both anew.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

#[path = "common/budgets.rs"]
#[allow(dead_code)]
mod budgets;
#[path = "common/firmware.rs"]
mod firmware;
#[path = "../examples/fw_parts.rs"]
#[allow(dead_code, reason = "its `main` is for `cargo run`")]
mod fw_parts;

use embedded_surfaces::patch::Surface;
use embedded_surfaces::render::stack_bytes;
use fw_parts::{Fill, SETUPS, Setup, sum_on_host, teapot};
use object::{Object, ObjectSection};
use std::fmt::Write;
use std::path::Path;

/// Bytes of a set-up.
#[derive(Clone, Copy)]
struct Need {
    flash: u64,
    statics: u64,
    stack: u64,
}

/// Of the part's name.
fn kilobytes(setup: &Setup) -> u64 {
    setup.part.split_whitespace().rev().nth(1).unwrap().parse().unwrap()
}

/// Links a set-up for its part, whose RAM the linker knows, and runs it; `None` where something is not installed.
fn measure(number: usize, setup: &Setup) -> Option<Need> {
    let runner = firmware::board(setup.target)?;
    let part = number.to_string();
    let ram = format!("link-arg=--defsym=_kb_of_ram={}", kilobytes(setup));
    let what = ["--example", "fw_parts", "--", "-C", &ram];
    let folder = firmware::cargo("rustc", setup.target, &what, &[firmware::FOR_SIZE, ("FW_PART", &part)]);
    let image = folder.join("examples/fw_parts");
    let said = firmware::run(&runner, &image);
    let (stack, sum) = said.trim().strip_prefix("stack ").and_then(|said| said.split_once(", sum ")).unwrap();
    assert_eq!(sum.parse(), Ok(sum_on_host(setup).unwrap()), "set-up {number} draws another picture than the host");
    let elf = std::fs::read(&image).unwrap();
    let file = object::File::parse(&*elf).unwrap();
    let is_static = |name: &str| [".data", ".sdata", ".bss", ".sbss", ".uninit"].contains(&name);
    let statics = file.sections().filter(|s| s.name().is_ok_and(is_static)).map(|s| s.size()).sum();
    Some(Need { flash: firmware::sizes(&elf).0, statics, stack: stack.parse().unwrap() })
}

fn line(setup: &Setup, need: &Need) -> String {
    let Setup { part, width, height, rows, is_grey, fill, .. } = setup;
    let colours = if *is_grey { "`Gray4`" } else { "`Rgb565`" };
    let fill = match fill {
        Fill::Exact => "exact points".to_owned(),
        Fill::Grid(0) => "grid, no list".to_owned(),
        Fill::Grid(facets) => format!("grid, list of {facets} facets"),
    };
    let Need { flash, statics, stack } = need;
    let ram = statics + stack;
    format!("| {part} | {width}×{height} {colours}, {rows} rows, {fill} | {flash} | {ram} | {statics} + {stack} |")
}

const HEAD: &str =
    "| part and its RAM | picture, rows of a band, fill | flash | RAM | static + stack |\n|---|---|---|---|---|\n";

#[test]
fn pictures_fit_their_parts() {
    let promised = stack_bytes(teapot::MODEL[0].surface()) as u64;
    let (mut table, mut rows, mut measured) = (HEAD.to_owned(), 0, Vec::new());
    for (number, setup) in SETUPS.iter().enumerate() {
        let Some(need) = measure(number, setup) else { continue };
        let Need { flash, statics, stack } = need;
        // On a heap-free board, RAM is statics and stack; half a kilobyte is left for the vectors of interrupts.
        assert!(statics + stack + 512 <= kilobytes(setup) << 10, "set-up {number}: {statics} + {stack} bytes of RAM");
        // Exact points: what `stack_bytes` says, and what calls the drawing. The grid keeps rows of vertices.
        let most = if matches!(setup.fill, Fill::Exact) { promised + 1024 } else { 7442 };
        assert!(stack < most, "set-up {number}: {stack} bytes of stack, `stack_bytes` says {promised}");
        for (what, bytes) in [("flash", flash), ("static memory", statics), ("stack", stack)] {
            measured.push((format!("bytes of {what}, set-up {number}, {}", setup.part), bytes));
        }
        writeln!(table, "{}", line(setup, &need)).unwrap();
        rows += 1;
    }
    if rows == SETUPS.len() {
        budgets::check("fw_parts, opt-level s", &measured);
        in_readme(&table);
    }
}

/// Compares the README's table, or writes it.
fn in_readme(table: &str) {
    let path = Path::new(firmware::ROOT).join("README.md");
    let text = std::fs::read_to_string(&path).unwrap();
    let start = text.find(HEAD).expect("a table of parts");
    let end = start + text[start..].find("\n\n").expect("its end") + 1;
    if std::env::var_os("UPDATE_BUDGETS").is_some_and(|value| value == "1") {
        std::fs::write(path, format!("{}{table}{}", &text[..start], &text[end..])).unwrap();
    } else {
        assert_eq!(&text[start..end], table, "the README's table of parts is old: UPDATE_BUDGETS=1");
    }
}
