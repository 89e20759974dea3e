//! Instructions under QEMU against `tests/budgets.txt`, compared exactly: `examples/fw_bench.rs` and `fw_cost.rs` for v6-M
//! code, M4 and RV32. Prints the tables of instructions a point: `cargo test --test firmware_bench -- --nocapture`.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, clippy::duplicate_mod)]

#[path = "common/budgets.rs"]
#[allow(dead_code)]
mod budgets;
#[path = "common/firmware.rs"]
mod firmware;
#[path = "../examples/fw_bench.rs"]
#[allow(dead_code, reason = "its `main` is for `cargo run`")]
mod fw_bench;
#[path = "../examples/fw_cost.rs"]
#[allow(dead_code, reason = "its `main` is for `cargo run`")]
mod fw_cost;

use firmware::{cargo_build_all, program_is_installed, run, runner_of, skip, target_is_installed};
use fw_cost::{frame, teapot};
use std::path::Path;

const TARGETS: [(&str, &str); 3] =
    [("M0", "thumbv6m-none-eabi"), ("M4", "thumbv7em-none-eabihf"), ("RV32", "riscv32imc-unknown-none-elf")];

/// A line of a report.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Row {
    name: String,
    instructions: u64,
    points: u64,
    sum: i64,
}

fn parse(report: &str) -> Vec<Row> {
    let row = |line: &str| {
        let (name, rest) = line.split_once(": ")?;
        let (instructions, rest) = rest.split_once(" instructions, ")?;
        let (points, sum) = rest.split_once(" points, sum ")?;
        let [instructions, points] = [instructions, points].map(|number| number.parse().ok());
        Some(Row { name: name.into(), instructions: instructions?, points: points?, sum: sum.parse().ok()? })
    };
    report.lines().map(|line| row(line).unwrap_or_else(|| panic!("{line:?} is no row"))).collect()
}

#[test]
fn instructions_are_as_budgeted() {
    let mut host = String::new();
    fw_bench::report(&mut host).unwrap();
    let columns = check("fw_bench", &parse(&host));
    for (short, rows) in columns {
        // A call and a return, and what the counter is off.
        assert!((1000..=1006).contains(&rows[0].instructions), "{short}: the counter says {:?}", rows[0]);
    }
}

#[test]
fn a_frame_takes_what_is_budgeted() {
    assert_eq!((teapot::vertices().count(), frame::BAND), (306, 320 * 16));
    let mut host = String::new();
    fw_cost::report(&mut host).unwrap();
    check("fw_cost", &parse(&host));
}

/// Runs an example on all targets: the same points and sums as here, and the instructions that are budgeted. Returns
/// each target's rows.
fn check(example: &str, host: &[Row]) -> Vec<(&'static str, Vec<Row>)> {
    let installed: Vec<_> = TARGETS.into_iter().filter(|(_, target)| target_is_installed(target)).collect();
    for (_, target) in TARGETS.iter().filter(|row| !installed.contains(row)) {
        skip(target, &format!("the Rust target (rustup target add {target})"));
    }
    let targets: Vec<_> = installed.iter().map(|(_, target)| *target).collect();
    let folder = cargo_build_all(&targets, example, &["--example", example]);
    let mut columns = Vec::new();
    for (short, target) in installed {
        let Some(rows) = rows(target, &folder, example) else { continue };
        for (there, here) in rows.iter().zip(host) {
            assert_eq!((&there.name, there.points, there.sum), (&here.name, here.points, here.sum), "{target}");
        }
        assert_eq!(rows.len(), host.len());
        let measured: Vec<_> =
            rows.iter().map(|row| (format!("instructions, {}", row.name), row.instructions)).collect();
        budgets::check(&format!("{example}, {target}"), &measured);
        columns.push((short, rows));
    }
    print_table(host, &columns);
    columns
}

fn rows(target: &str, folder: &Path, example: &str) -> Option<Vec<Row>> {
    let runner = runner_of(target);
    if !program_is_installed(&runner[0]) {
        skip(target, &runner[0]);
        return None;
    }
    Some(parse(&run(&runner, &folder.join(target).join("release/examples").join(example))))
}

fn print_table(rows: &[Row], columns: &[(&str, Vec<Row>)]) {
    print!("| instructions a point | points |");
    columns.iter().for_each(|(short, _)| print!(" {short} |"));
    println!("\n|---|---|{}", "---|".repeat(columns.len()));
    for (k, row) in rows.iter().enumerate() {
        print!("| {} | {} |", row.name, row.points);
        for (_, column) in columns {
            let hundredths = (column[k].instructions * 100 + row.points / 2) / row.points;
            print!(" {}.{:02} |", hundredths / 100, hundredths % 100);
        }
        println!();
    }
}

#[test]
fn rows_are_read() {
    let row = Row { name: "a, b".into(), instructions: 7, points: 3, sum: -5 };
    assert_eq!(parse("a, b: 7 instructions, 3 points, sum -5\n"), [row]);
}
