//! What the tests of firmware share: building it, running it under QEMU, reading its image.
//!
//! What is not installed (a target, QEMU) is skipped with a message, or fails where `REQUIRE_FIRMWARE=1`.
#![allow(dead_code, reason = "each test uses its part")]

use object::{Object, ObjectSection, ObjectSymbol, SectionFlags, SectionKind};
use std::io::{Read, Write};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::Mutex;
use std::time::{Duration, Instant};

pub(crate) const ROOT: &str = env!("CARGO_MANIFEST_DIR");
/// How long a firmware may run before it is killed; it takes seconds at most.
pub(crate) const WATCHDOG: Duration = Duration::from_secs(60);
/// Held while a build runs.
static BUILDS: Mutex<()> = Mutex::new(());

/// Says on the real standard error, which the test harness does not capture, that something is not checked.
pub(crate) fn skip(target: &str, missing: &str) {
    let required = std::env::var_os("REQUIRE_FIRMWARE").is_some_and(|value| value == "1");
    assert!(!required, "{target}: {missing} is missing, and REQUIRE_FIRMWARE=1");
    let message = format!("firmware test of {target} skipped: {missing} is missing\n");
    std::io::stderr().write_all(message.as_bytes()).unwrap();
}

/// Whether images that take minutes to build, or that hardly ever change, are built, too.
pub(crate) fn is_thorough() -> bool {
    ["FIRMWARE_GATE", "UPDATE_BUDGETS"].iter().any(|name| std::env::var_os(name).is_some_and(|value| value == "1"))
}

/// Those of some targets that can be built for; says which cannot.
pub(crate) fn installed<'t>(targets: &[&'t str]) -> Vec<&'t str> {
    let (installed, missing): (Vec<_>, Vec<_>) = targets.iter().copied().partition(|t| target_is_installed(t));
    missing.iter().for_each(|target| skip(target, &format!("the Rust target (rustup target add {target})")));
    installed
}

/// The words that start a target's firmware; says where their program is missing.
pub(crate) fn installed_runner(target: &str) -> Option<Vec<String>> {
    let runner = runner_of(target);
    let is_installed = program_is_installed(&runner[0]);
    if !is_installed {
        skip(target, &runner[0]);
    }
    is_installed.then_some(runner)
}

/// The words that start a target's firmware, where it can be built and run; else says what is missing.
pub(crate) fn board(target: &str) -> Option<Vec<String>> {
    if installed(&[target]).is_empty() { None } else { installed_runner(target) }
}

fn target_is_installed(target: &str) -> bool {
    let rustc = std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
    let output = Command::new(rustc).current_dir(ROOT).args(["--print", "target-libdir", "--target", target]).output();
    output.is_ok_and(|o| o.status.success() && Path::new(String::from_utf8_lossy(&o.stdout).trim()).is_dir())
}

/// Whether a program can be started.
fn program_is_installed(program: &str) -> bool {
    Command::new(program).arg("--version").output().is_ok()
}

/// Firmware is measured as small parts want it. What draws patches of every kind exceeds the 256 KB of `memory.x` at level 3.
pub(crate) const FOR_SIZE: (&str, &str) = ("CARGO_PROFILE_RELEASE_OPT_LEVEL", "s");

/// The examples that have something of the feature `asm`, built at once so that they share what they are built on.
pub(crate) const WITH_ASSEMBLY: [&str; 6] = ["--example", "fw_bench", "--example", "fw_forms", "--features", "asm"];

/// Runs `cargo build` or `cargo rustc` for a target with variables of the environment, in a target directory of its own
/// (the outer cargo may hold the lock of the usual one), and returns the folder with the results.
pub(crate) fn cargo(command: &str, target: &str, what: &[&str], environment: &[(&str, &str)]) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("firmware");
    let mut cargo = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    cargo.current_dir(ROOT).args([command, "--release", "--locked", "--quiet", "--target", target]);
    cargo.arg("--target-dir").arg(&folder).args(what);
    // These would replace the link arguments of .cargo/config.toml.
    for variable in ["RUSTFLAGS", "CARGO_ENCODED_RUSTFLAGS", "CARGO_BUILD_RUSTFLAGS", "CARGO_BUILD_TARGET"] {
        cargo.env_remove(variable);
    }
    // One at a time: the builds for all targets share the procedural macros and their folder.
    let one = BUILDS.lock();
    // The same filter of the log for all, or `defmt` would be built anew each time.
    cargo.env("DEFMT_LOG", "trace").envs(environment.iter().copied());
    let output = cargo.output().unwrap();
    drop(one);
    let said = String::from_utf8_lossy(&output.stderr);
    let error = said.find("error").unwrap_or(0); // after warnings
    assert!(output.status.success(), "{target} {what:?}:\n{}", &said[error..]);
    folder.join(target).join("release")
}

/// The four targets.
pub(crate) const TARGETS: [&str; 4] =
    ["thumbv6m-none-eabi", "thumbv7m-none-eabi", "thumbv7em-none-eabihf", "riscv32imc-unknown-none-elf"];

/// Runs `cargo build --release` for some targets at once, in the target directory of this name; returns it. The images
/// may take the 4 MB of flash and 16 MB of RAM of QEMU's mps2 machines.
pub(crate) fn cargo_build_all(targets: &[&str], folder: &str, what: &[&str]) -> PathBuf {
    let mut all = Vec::new();
    for target in targets.iter().filter(|target| target.starts_with("thumb")) {
        let flag = "-Clink-arg=--defsym=_flash_of_mps2=1"; // see memory.x
        all.extend(["--config".into(), format!("target.{target}.rustflags=[\"{flag}\"]")]);
    }
    all.extend(what.iter().copied().map(String::from));
    build_all(Path::new(ROOT), targets, folder, &all)
}

/// The same for the package `peers`, which brings its link arguments along.
pub(crate) fn cargo_build_peers(targets: &[&str]) -> PathBuf {
    build_all(&Path::new(ROOT).join("peers"), targets, "peers", &[])
}

fn build_all(package: &Path, targets: &[&str], folder: &str, what: &[String]) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(folder);
    let mut cargo = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    cargo.current_dir(package).args(["build", "--release", "--locked", "--quiet"]);
    cargo.args(targets.iter().flat_map(|target| ["--target", target]));
    cargo.args(what).arg("--target-dir").arg(&folder);
    for variable in ["RUSTFLAGS", "CARGO_ENCODED_RUSTFLAGS", "CARGO_BUILD_RUSTFLAGS", "CARGO_BUILD_TARGET"] {
        cargo.env_remove(variable);
    }
    if what.iter().any(|argument| argument.contains("-Z")) {
        cargo.env("RUSTC_BOOTSTRAP", "1");
    }
    let output = cargo.output().unwrap();
    assert!(output.status.success(), "{targets:?} {what:?}:\n{}", String::from_utf8_lossy(&output.stderr));
    folder
}

/// What `cargo run` starts a target's firmware by.
fn runner_of(target: &str) -> Vec<String> {
    runner(&std::fs::read_to_string(Path::new(ROOT).join(".cargo/config.toml")).unwrap(), target)
}

/// The words of `runner = "…"` in `[target.NAME]`: what `cargo run` uses.
pub(crate) fn runner(config: &str, target: &str) -> Vec<String> {
    let section =
        config.split("\n[").find_map(|s| s.trim_start_matches('[').strip_prefix(&format!("target.{target}]")));
    let line = section.and_then(|s| s.lines().find_map(|line| line.strip_prefix("runner = ")));
    line.expect("a runner").trim_matches('"').split_whitespace().map(String::from).collect()
}

/// What the firmware prints. Fails when it does not end well in time.
pub(crate) fn run(runner: &[String], image: &Path) -> String {
    String::from_utf8_lossy(&run_bytes(runner, image)).into_owned()
}

/// The bytes that the firmware puts out. Fails when it does not end well in time.
pub(crate) fn run_bytes(runner: &[String], image: &Path) -> Vec<u8> {
    let mut qemu = Command::new(&runner[0]);
    qemu.args(&runner[1..]).arg(image).stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = qemu.spawn().unwrap();
    let (out, err) = (gather(child.stdout.take().unwrap()), gather(child.stderr.take().unwrap()));
    let start = Instant::now();
    let status = loop {
        match child.try_wait().unwrap() {
            None if start.elapsed() > WATCHDOG => {
                child.kill().unwrap();
                break child.wait().unwrap();
            }
            None => std::thread::sleep(Duration::from_millis(10)),
            Some(status) => break status,
        }
    };
    let (out, err) = (out.join().unwrap(), err.join().unwrap());
    let (printed, said) = (String::from_utf8_lossy(&out), String::from_utf8_lossy(&err));
    assert!(status.success(), "{status}; printed {printed:?}, QEMU says {said}");
    out
}

pub(crate) fn gather(mut pipe: impl Read + Send + 'static) -> std::thread::JoinHandle<Vec<u8>> {
    std::thread::spawn(move || {
        let mut bytes = Vec::new();
        pipe.read_to_end(&mut bytes).unwrap();
        bytes
    })
}

/// The names in the symbol table of an ELF file.
pub(crate) fn symbols(elf: &[u8]) -> Vec<String> {
    let file = object::File::parse(elf).unwrap();
    file.symbols().filter_map(|symbol| symbol.name().ok().map(String::from)).collect()
}

/// Bytes of flash and of static RAM of an ELF file: code and constants with the start values of data; data and what
/// starts as zero or undefined.
pub(crate) fn sizes(elf: &[u8]) -> (u64, u64) {
    const WRITE: u64 = 1;
    const ALLOC: u64 = 2;
    let file = object::File::parse(elf).unwrap();
    let (mut flash, mut ram) = (0, 0);
    for section in file.sections() {
        let SectionFlags::Elf { sh_flags } = section.flags() else { panic!("not an ELF file") };
        if sh_flags & ALLOC != 0 && section.kind() != SectionKind::UninitializedData {
            flash += section.size();
        }
        if sh_flags & (ALLOC | WRITE) == ALLOC | WRITE {
            ram += section.size();
        }
    }
    (flash, ram)
}

/// The symbols that may not be in a firmware, with the reason. Fails for an image without symbols.
pub(crate) fn offences(elf: &[u8]) -> Vec<(&'static str, String)> {
    let names = symbols(elf);
    assert!(names.iter().any(|name| name.contains("embedded_surfaces")), "the image is stripped");
    names.into_iter().filter_map(|name| Some((offence(&name)?, name))).collect()
}

/// Why a symbol may not be in a firmware; `None` for one that may. The panic handler alone is no offence: it is
/// required, and only `core::panicking` calls it.
pub(crate) fn offence(name: &str) -> Option<&'static str> {
    const ALLOCATOR: [&str; 5] = ["__rust_alloc", "__rust_dealloc", "__rust_realloc", "__rg_", "__rdl_"];
    const C_ALLOCATOR: [&str; 4] = ["malloc", "calloc", "realloc", "free"];
    if name.contains("panicking") {
        Some("a panic")
    } else if is_soft_float(name) {
        Some("soft float")
    } else if ALLOCATOR.iter().any(|part| name.contains(part)) || C_ALLOCATOR.contains(&name) {
        Some("an allocator")
    } else {
        None
    }
}

/// The run-time ABI of ARM (`__aeabi_dadd`, `__aeabi_ui2f`, …) or of GCC (`__adddf3`, `__floatunsisf`, …).
pub(crate) fn is_soft_float(name: &str) -> bool {
    const OPERATIONS: [&str; 19] = [
        "add", "sub", "mul", "div", "neg", "eq", "ne", "lt", "le", "gt", "ge", "cmp", "unord", "powi", "fix", "fixuns",
        "float", "floatun", "extend",
    ];
    if let Some(arm) = name.strip_prefix("__aeabi_") {
        return arm.starts_with(['f', 'd'])
            || ["cf", "cd"].iter().any(|c| arm.starts_with(c))
            || arm.contains("2f")
            || arm.contains("2d");
    }
    // Modes are pairs of letters: half, single, double, tetra; float or integer.
    let is_mode = |pair: &[u8]| matches!(pair, [b'h' | b's' | b'd' | b't', b'f' | b'i']);
    let modes = |rest: &str| {
        let rest = rest.trim_end_matches(|c: char| c.is_ascii_digit());
        !rest.is_empty() && rest.contains('f') && rest.len() % 2 == 0 && rest.as_bytes().chunks(2).all(is_mode)
    };
    let gcc = name.strip_prefix("__").unwrap_or("");
    OPERATIONS.iter().chain(&["trunc"]).any(|operation| gcc.strip_prefix(operation).is_some_and(modes))
}
