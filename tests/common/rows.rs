//! Reports of counted rows: `name: N instructions, P points, sum S`, the same on all targets but for the instructions.

use super::budgets;
use super::firmware::{installed, installed_runner, run};
use std::path::Path;

/// The targets that are counted, by the short names of the tables.
pub(crate) const COUNTED: [(&str, &str); 3] =
    [("M0", "thumbv6m-none-eabi"), ("M4", "thumbv7em-none-eabihf"), ("RV32", "riscv32imc-unknown-none-elf")];

/// Those of them that are installed; says which are not.
pub(crate) fn counted() -> Vec<&'static str> {
    installed(&COUNTED.map(|(_, target)| target))
}

/// A line of a report.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Row {
    pub(crate) name: String,
    pub(crate) instructions: u64,
    pub(crate) points: u64,
    pub(crate) sum: i64,
}

pub(crate) fn parse(report: &str) -> Vec<Row> {
    let row = |line: &str| {
        let (name, rest) = line.split_once(": ")?;
        let (instructions, rest) = rest.split_once(" instructions, ")?;
        let (points, sum) = rest.split_once(" points, sum ")?;
        let [instructions, points] = [instructions, points].map(|number| number.parse().ok());
        Some(Row { name: name.into(), instructions: instructions?, points: points?, sum: sum.parse().ok()? })
    };
    report.lines().map(|line| row(line).unwrap_or_else(|| panic!("{line:?} is no row"))).collect()
}

/// Runs a firmware on some of these targets, with instructions as budgeted under its title in those rows that
/// `is_budgeted`. Returns each target's rows by its short name. `image` is where the image of a target is.
pub(crate) fn run_all<P: AsRef<Path>>(
    title: &str,
    targets: &[&str],
    image: impl Fn(&str) -> P,
    is_budgeted: impl Fn(&Row) -> bool,
) -> Vec<(&'static str, Vec<Row>)> {
    let mut columns = Vec::new();
    for (short, target) in COUNTED.into_iter().filter(|(_, target)| targets.contains(target)) {
        let Some(runner) = installed_runner(target) else { continue };
        let rows = parse(&run(&runner, image(target).as_ref()));
        let budgeted = rows.iter().filter(|row| is_budgeted(row));
        let measured: Vec<_> = budgeted.map(|row| (format!("instructions, {}", row.name), row.instructions)).collect();
        budgets::check(&format!("{title}, {target}"), &measured);
        columns.push((short, rows));
    }
    columns
}

/// Instructions a point.
pub(crate) fn print_table(columns: &[(&str, Vec<Row>)]) {
    let Some((_, rows)) = columns.iter().max_by_key(|(_, rows)| rows.len()) else { return };
    print!("| instructions a point | points |");
    columns.iter().for_each(|(short, _)| print!(" {short} |"));
    println!("\n|---|---|{}", "---|".repeat(columns.len()));
    for row in rows {
        print!("| {} | {} |", row.name, row.points);
        for (_, column) in columns {
            match column.iter().find(|other| other.name == row.name) {
                Some(Row { instructions, points, .. }) => {
                    let hundredths = (instructions * 100 + points / 2) / points;
                    print!(" {}.{:02} |", hundredths / 100, hundredths % 100);
                }
                None => print!(" – |"),
            }
        }
        println!();
    }
}
