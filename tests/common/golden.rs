//! The `golden` tool, run as a user runs it.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::OnceLock;

/// The tool, beside the test's own executable. It is there and new where all tests were asked for; else cargo makes it so.
pub(crate) fn path() -> &'static Path {
    static TOOL: OnceLock<PathBuf> = OnceLock::new();
    TOOL.get_or_init(|| {
        let test = std::env::current_exe().unwrap();
        let profile = test.parent().unwrap().parent().unwrap();
        let mut cargo = Command::new(env!("CARGO"));
        cargo.args(["build", "--quiet", "--all-features", "--example", "golden"]);
        cargo.arg("--target-dir").arg(profile.parent().unwrap());
        if profile.ends_with("release") {
            cargo.arg("--release");
        }
        assert!(cargo.current_dir(env!("CARGO_MANIFEST_DIR")).status().unwrap().success());
        profile.join("examples/golden")
    })
}

/// `golden COMMAND CASE EXTRA...`.
pub(crate) fn golden(command: &str, case: &Path, extra: &[&str]) -> Output {
    Command::new(path()).arg(command).arg(case).args(extra).output().unwrap()
}
