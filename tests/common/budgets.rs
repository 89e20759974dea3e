//! The committed budgets: `tests/budgets.txt`, sections of lines `number name`, compared exactly.
//!
//! `UPDATE_BUDGETS=1` rewrites the sections that a test measures. Other toolchains than the pinned one give other
//! numbers: then nothing is compared, or the test fails where `REQUIRE_FIRMWARE=1`.

use super::firmware::{ROOT, skip};
use std::collections::BTreeMap;
use std::fmt::Write;
use std::process::Command;
use std::sync::Mutex;

const FILE: &str = "tests/budgets.txt";
const HEAD: &str = "\
# What the firmware costs, compared exactly by tests/firmware_*.rs on the toolchain of rust-toolchain.toml. A change that
# costs more raises the number here, in the same commit, and says why. To measure:
#     UPDATE_BUDGETS=1 REQUIRE_FIRMWARE=1 cargo test --all-features --test firmware_gate --test firmware_bench \\
#         --test firmware_peers --test firmware_parts --test firmware_defmt --test firmware_intersect
";

type Section = Vec<(String, u64)>;

static LOCK: Mutex<()> = Mutex::new(());

/// Compares what was measured with the section of this title, or writes it there.
pub(crate) fn check(title: &str, measured: &[(String, u64)]) {
    if !is_pinned_toolchain() {
        return skip(title, "the toolchain of rust-toolchain.toml");
    }
    let path = std::path::Path::new(ROOT).join(FILE);
    let _one_at_a_time = LOCK.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
    let mut sections = parse(&std::fs::read_to_string(&path).unwrap_or_default());
    if std::env::var_os("UPDATE_BUDGETS").is_some_and(|value| value == "1") {
        sections.insert(title.into(), measured.to_vec());
        return std::fs::write(path, print(&sections)).unwrap();
    }
    let budget = sections.remove(title).unwrap_or_default();
    let differences = compare(&budget, measured);
    assert!(
        differences.is_empty(),
        "{title}, in {FILE}:\n{}\nIf that is meant: UPDATE_BUDGETS=1, and say why in the commit.",
        differences.join("\n")
    );
}

/// What differs, a line each.
pub(crate) fn compare(budget: &[(String, u64)], measured: &[(String, u64)]) -> Vec<String> {
    let map = |section: &[(String, u64)]| section.iter().cloned().collect::<BTreeMap<_, _>>();
    let (budget, measured) = (map(budget), map(measured));
    let names: std::collections::BTreeSet<_> = budget.keys().chain(measured.keys()).collect();
    let show = |value: Option<&u64>| value.map_or("nothing".into(), u64::to_string);
    let line = |name: &&String| {
        let (before, now) = (budget.get(*name), measured.get(*name));
        (before != now).then(|| format!("{name}: {} budgeted, {} measured", show(before), show(now)))
    };
    names.iter().filter_map(line).collect()
}

pub(crate) fn parse(text: &str) -> BTreeMap<String, Section> {
    let mut sections = BTreeMap::<String, Section>::new();
    let mut title = String::new();
    for line in text.lines().filter(|line| !line.starts_with('#') && !line.trim().is_empty()) {
        if let Some(name) = line.strip_prefix('[').and_then(|line| line.strip_suffix(']')) {
            title = name.into();
        } else {
            let (number, name) = line.trim().split_once(' ').expect("a number and a name");
            sections.entry(title.clone()).or_default().push((name.into(), number.parse().expect("a number")));
        }
    }
    sections
}

pub(crate) fn print(sections: &BTreeMap<String, Section>) -> String {
    let mut text = HEAD.to_owned();
    for (title, section) in sections {
        write!(text, "\n[{title}]\n").unwrap();
        for (name, number) in section {
            writeln!(text, "{number:>9} {name}").unwrap();
        }
    }
    text
}

fn is_pinned_toolchain() -> bool {
    let pinned = std::fs::read_to_string(std::path::Path::new(ROOT).join("rust-toolchain.toml")).unwrap();
    let channel = pinned.lines().find_map(|line| line.strip_prefix("channel = ")).expect("a channel");
    let rustc = std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
    let version = Command::new(rustc).current_dir(ROOT).arg("--version").output().unwrap().stdout;
    String::from_utf8_lossy(&version).split_whitespace().nth(1) == Some(channel.trim_matches('"'))
}
