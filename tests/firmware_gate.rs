//! The gate on all four targets: `examples/fw_gate.rs` calls every public operation, gives the host's results bit for
//! bit, holds no panic, soft float or allocator, and costs what `tests/budgets.txt` says.
//!
//! Always for size with every feature; with `FIRMWARE_GATE=1` or `UPDATE_BUDGETS=1` also for speed and with fewer
//! features: those images take minutes to build.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

#[path = "common/budgets.rs"]
mod budgets;
#[path = "common/firmware.rs"]
mod firmware;
#[path = "../examples/fw_gate.rs"]
#[allow(dead_code, reason = "its `main` is for `cargo run`")]
mod fw_gate;
#[path = "common/image.rs"]
mod image;
#[path = "common/public.rs"]
mod public;

use firmware::{ROOT, TARGETS, cargo_build_all, installed, installed_runner, is_thorough, offences, run};
use std::collections::BTreeMap;
use std::path::Path;

/// Public functions that the gate need not call, with the reason.
const EXCEPTIONS: [(&str, &str); 0] = [];

#[test]
fn for_size_with_every_feature() {
    check("s", "styled");
}

#[test]
fn for_speed_with_every_feature() {
    if is_thorough() {
        check("3", "styled");
    }
}

#[test]
fn for_size_with_fewer_features() {
    if is_thorough() {
        check("s", "");
        check("s", "graphics");
    }
}

/// Builds, reads, weighs and runs the gate on every target.
fn check(opt_level: &str, features: &str) {
    let targets = installed(&TARGETS);
    let quoted = if opt_level == "s" { "\"s\"" } else { opt_level };
    let mut what = ["--example", "fw_gate", "--no-default-features", "--features", features].map(String::from).to_vec();
    what.extend(["--config".into(), format!("profile.release.opt-level={quoted}")]);
    for target in &targets {
        let flags = "[\"-Zemit-stack-sizes\", \"-Csymbol-mangling-version=v0\"]";
        what.extend(["--config".into(), format!("target.{target}.rustflags={flags}")]);
    }
    let what: Vec<_> = what.iter().map(String::as_str).collect();
    let folder = cargo_build_all(&targets, &format!("gate-{opt_level}-{features}"), &what);
    for target in targets {
        let path = folder.join(target).join("release/examples/fw_gate");
        let elf = std::fs::read(&path).unwrap();
        let title = format!("fw_gate, {target}, opt-level {opt_level}, features \"{features}\"");
        let offences = offences(&elf);
        assert!(offences.is_empty(), "{title}: {offences:#?}");
        compare_with_host(target, &path, &title);
        budgets::check(&title, &image::weigh(&elf, features == "styled"));
    }
}

/// The lines of an image with fewer features, or of a host with fewer, are the first of all.
fn compare_with_host(target: &str, image: &Path, title: &str) {
    let Some(runner) = installed_runner(target) else { return };
    let mut host = String::new();
    fw_gate::report(&mut host).unwrap();
    let there = run(&runner, image);
    assert!(there.lines().count() >= 11, "{title}: {there}");
    for (there, here) in there.lines().zip(host.lines()) {
        assert_eq!(there, here, "{title}");
    }
}

/// Each module's calls stand in the gate's file or folder of its name, as often as the name is defined.
#[test]
fn every_public_function_is_called() {
    let mut missing = Vec::new();
    let defined = public::defined();
    let total: usize = defined.values().flat_map(BTreeMap::values).sum();
    assert!(total > 200 && defined["render"].contains_key("Scene::draw"), "found {total} public functions only");
    for (module, names) in defined {
        let calls = calls_of(&module);
        for (name, count) in names {
            let called = calls.get(&name).copied().unwrap_or(0);
            let excepted = EXCEPTIONS.iter().any(|(exception, _)| *exception == name);
            if called < count && !excepted {
                missing.push(format!("{module}: {name} is defined {count} times and called {called} times"));
            }
        }
    }
    assert!(missing.is_empty(), "examples/gate misses these:\n{}", missing.join("\n"));
}

fn calls_of(module: &str) -> public::Names {
    let folder = Path::new(ROOT).join("examples/gate");
    let mut files = vec![folder.join(module).with_extension("rs")];
    if module == "graphics" {
        files.push(folder.join("styled.rs"));
    }
    if folder.join(module).is_dir() {
        files = public::rust_files(&folder.join(module));
    }
    let mut aliases = public::Aliases::new();
    for path in public::rust_files(&Path::new(ROOT).join("src")) {
        let tokens: proc_macro2::TokenStream = std::fs::read_to_string(&path).unwrap().parse().unwrap();
        public::aliases_in(&tokens.into_iter().collect::<Vec<_>>(), &mut aliases);
    }
    let mut calls = BTreeMap::new();
    for file in files.iter().filter(|file| file.exists()) {
        public::calls(std::fs::read_to_string(file).unwrap().parse().unwrap(), &aliases, &mut calls);
    }
    calls
}

#[test]
fn the_scanner_sees_what_is_public() {
    let source = "
        pub type Short = Long<3>;
        impl<const K: usize, T: Fn() -> u8> Long<K, T> { pub const fn one(self) {} fn two() {} pub(crate) fn three() {} }
        impl Short { #[must_use] pub fn four() { pub fn inner() {} } #[cfg(test)] pub fn five() {} }
        impl Clone for Long<1> { fn clone(&self) {} }
        pub trait Six { const A: u8; fn seven(); fn eight() {} }
        pub(crate) trait Nine { fn ten(); }
        pub fn eleven() {}
        fn twelve() {}
        #[cfg(test)] mod tests { pub fn thirteen() {} }
        #[cfg(feature = \"std\")] pub fn fourteen() {}
        macro_rules! views { ($name:ident, $x:ident) => { impl<'a> $name<'a> { pub fn fifteen() {} } }; }
        views! { #[doc = \"\"] A, B }
        views! { C, D }";
    let tokens: Vec<_> = source.parse::<proc_macro2::TokenStream>().unwrap().into_iter().collect();
    let (mut aliases, mut names) = Default::default();
    public::aliases_in(&tokens, &mut aliases);
    public::definitions(&tokens, &aliases, &mut names);
    let expected = ["A::fifteen", "C::fifteen", "Long::four", "Long::one", "Six::eight", "Six::seven", "eleven"];
    assert_eq!(names.keys().collect::<Vec<_>>(), expected);

    let calls = "use a::Short; fn f() { Short::four(); Long::<4, u8>::one(x.map(Six::seven)); y.eleven(); eleven() }";
    let mut called = BTreeMap::new();
    public::calls(calls.parse().unwrap(), &aliases, &mut called);
    for name in ["Long::four", "Long::one", "Six::seven", "eleven"] {
        assert_eq!(called.get(name), Some(&1), "{name} in {called:?}");
    }
}

#[test]
fn budgets_survive_printing_and_differences_show() {
    let section = vec![("bytes of code in num".to_owned(), 12), ("a name".to_owned(), 7)];
    let sections = BTreeMap::from([("a title, opt-level s".to_owned(), section.clone())]);
    assert_eq!(budgets::parse(&budgets::print(&sections)), sections);
    assert_eq!(budgets::compare(&section, &section), Vec::<String>::new());
    let other = [("a name".to_owned(), 8), ("new".to_owned(), 1)];
    let lines = [
        "a name: 7 budgeted, 8 measured",
        "bytes of code in num: 12 budgeted, nothing measured",
        "new: nothing budgeted, 1 measured",
    ];
    assert_eq!(budgets::compare(&section, &other), lines);
}

#[test]
fn images_are_read() {
    assert_eq!(image::stack_sizes(&[1, 0, 0, 0, 8, 0, 1, 0, 0, 0x90, 3]), [(1, 8), (256, 400)]);
    let name = image::readable("_ZN17embedded_surfaces7forward4walk16difference_table17hebbad454a78df330E.llvm.123");
    assert_eq!(name, "embedded_surfaces::forward::walk::difference_table");
    assert_eq!(image::module(&name), "forward");
    let name = "<embedded_surfaces::forward::quotient::QuotientWalker<I16F16, 9>>::new::{closure#0}";
    assert_eq!(image::short(name), "<quotient::QuotientWalker<I16F16, 9>>::new::{closure#0}");
    assert_eq!(image::module("<fw_gate::gate::Sum>::add"), "the gate");
    assert_eq!(image::module("__aeabi_lmul"), "core and run-time");
}
