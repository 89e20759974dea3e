//! Instructions under QEMU against `tests/budgets.txt`, compared exactly: `examples/fw_bench.rs`, with the feature `asm` too,
//! and `fw_cost.rs` for v6-M code, M4 and RV32. Prints the tables of instructions a point: `cargo test --release --test firmware_bench -- --nocapture`.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]
#![allow(clippy::duplicate_mod, reason = "each example brings its counter along")]

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
#[path = "common/rows.rs"]
mod rows;

use firmware::{cargo_build_all, offences};
use fw_cost::{frame, teapot};
use rows::{Row, counted, parse, print_table, run_all};
use std::path::PathBuf;
use std::sync::OnceLock;

/// Both examples, built at once so that they share what they are built on; where.
fn images() -> &'static PathBuf {
    static IMAGES: OnceLock<PathBuf> = OnceLock::new();
    IMAGES.get_or_init(|| cargo_build_all(&counted(), "measured", &["--example", "fw_bench", "--example", "fw_cost"]))
}

#[test]
fn instructions_are_as_budgeted() {
    let mut host = String::new();
    fw_bench::report(&mut host).unwrap();
    for (short, rows) in check("fw_bench", &parse(&host)) {
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

/// With the feature `asm`: the rows that it is for.
#[test]
fn assembly_takes_what_is_budgeted() {
    let mut host = String::new();
    fw_bench::report(&mut host).unwrap();
    let folder = cargo_build_all(&counted(), "asm", &firmware::WITH_ASSEMBLY);
    let image = |target: &str| folder.join(target).join("release/examples/fw_bench");
    let columns = run_all("fw_bench with asm", &counted(), image, |row| {
        ["checksum", "visibility buffer", "generation"].iter().any(|name| row.name.contains(name))
    });
    compare(&columns, &parse(&host));
    for (short, rows) in &columns {
        let within = |what: &str, most: [u64; 3]| {
            let (name, k) =
                (format!("cubic n=256 F=0, {what}"), ["M0", "M4", "RV32"].iter().position(|s| s == short).unwrap());
            let cubic = rows.iter().find(|row| row.name == name).unwrap();
            assert!(10 * cubic.instructions <= most[k] * cubic.points, "{short}: {cubic:?}");
        };
        // Tenths of an instruction a point.
        within("checksum", [175, 135, 165]);
        within("generation", [320, 230, 250]);
        within("visibility buffer", [600, 230, 400]);
    }
}

/// Runs an example on all targets: the same points and sums as here, and the instructions that are budgeted. Returns
/// each target's rows.
fn check(example: &str, host: &[Row]) -> Vec<(&'static str, Vec<Row>)> {
    let image = |target: &str| images().join(target).join("release/examples").join(example);
    let columns = run_all(example, &counted(), image, |_| true);
    // The gate looks at level s in every build, at level 3 in a thorough one: here is what is fast.
    for target in counted() {
        let elf = std::fs::read(image(target)).unwrap();
        assert_eq!(offences(&elf), [], "{example} on {target}");
    }
    compare(&columns, host);
    print_table(&columns);
    columns
}

/// The same points and sums everywhere.
fn compare(columns: &[(&str, Vec<Row>)], host: &[Row]) {
    for (short, rows) in columns {
        for (there, here) in rows.iter().zip(host) {
            assert_eq!((&there.name, there.points, there.sum), (&here.name, here.points, here.sum), "{short}");
        }
        assert_eq!(rows.len(), host.len());
    }
}

#[test]
fn rows_are_read() {
    let row = Row { name: "a, b".into(), instructions: 7, points: 3, sum: -5 };
    assert_eq!(parse("a, b: 7 instructions, 3 points, sum -5\n"), [row]);
}
