//! The rules of the house, held against the tokens of the sources: the order of modules, no float outside the
//! oracle, short files, one module that knows `embedded-graphics`, and a document that names every module.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use proc_macro2::{Delimiter, Ident, Literal, Spacing, TokenStream, TokenTree};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// A module may import from earlier ones only.
const ORDER: [&str; 13] = [
    "num",
    "geometry",
    "patch",
    "mesh",
    "forward",
    "subdivide",
    "g1",
    "catmull_clark",
    "intersect",
    "trim",
    "render",
    "plot",
    "graphics",
];
/// It sees all modules, and no module sees it.
const ORACLE: &str = "reference";
const MAX_LINES: usize = 600;

#[test]
fn modules_import_only_from_earlier_ones() {
    assert_none(over_sources(|file| imports(file).into_iter().filter_map(|i| illegal_import(file, &i)).collect()));
}

#[test]
fn floats_stay_in_the_oracle() {
    assert_none(over_sources(|file| if file.module == ORACLE { Vec::new() } else { floats(&file.tokens) }));
}

#[test]
fn only_graphics_names_embedded_graphics() {
    assert_none(over_sources(|file| if file.module == "graphics" { Vec::new() } else { draw_targets(&file.tokens) }));
}

#[test]
fn files_are_short() {
    let folders = ["src", "tests", "examples", "benches", "fuzz/fuzz_targets"];
    let files = folders.iter().flat_map(|folder| rust_files(&root().join(folder)));
    let long = files.filter_map(|path| too_long(&std::fs::read_to_string(&path).unwrap()).map(|n| (path, n)));
    assert_none(long.map(|(path, lines)| format!("{}: {lines} lines", path.display())).collect());
}

#[test]
fn the_document_names_every_module() {
    let path = root().join("ARCHITECTURE.md");
    let document = std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    assert_none(unmentioned(&document, modules()));
}

#[test]
fn every_module_has_its_place() {
    let known = |module: &String| ORDER.contains(&module.as_str()) || module == ORACLE;
    assert_none(modules().into_iter().filter(|module| !known(module)).collect());
    assert!(modules().contains("num") && modules().contains("forward"), "found {:?} only", modules());
}

// The sources.

/// A source file: its path of modules below the crate, and its tokens without test code.
struct Source {
    name: String,
    /// The top-level module, empty for `lib.rs`.
    module: String,
    /// How many `super` lead from the file to the crate's root.
    depth: usize,
    tokens: Vec<TokenTree>,
}

impl Source {
    /// `path` is relative to `src`.
    fn new(path: &Path, text: &str) -> Self {
        let mut modules: Vec<_> = path.with_extension("").iter().map(|c| c.to_str().unwrap().to_owned()).collect();
        modules.pop_if(|last| ["mod", "lib"].contains(&last.as_str()));
        let tokens: TokenStream = text.parse().unwrap_or_else(|e| panic!("{}: {e}", path.display()));
        Self {
            name: format!("src/{}", path.display()),
            module: modules.first().cloned().unwrap_or_default(),
            depth: modules.len(),
            tokens: without_tests(tokens),
        }
    }

    fn is_test(&self) -> bool {
        self.name.ends_with("/tests.rs")
    }
}

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn rust_files(folder: &Path) -> Vec<PathBuf> {
    let Ok(entries) = std::fs::read_dir(folder) else { return Vec::new() };
    let mut files = Vec::new();
    for path in entries.map(|entry| entry.unwrap().path()) {
        if path.is_dir() {
            files.extend(rust_files(&path));
        } else if path.extension().is_some_and(|e| e == "rs") {
            files.push(path);
        }
    }
    files
}

/// What a check finds in all sources, each line with its file.
fn over_sources(check: impl Fn(&Source) -> Vec<String>) -> Vec<String> {
    let folder = root().join("src");
    let files = rust_files(&folder);
    assert!(files.len() > 20, "found {} sources only", files.len());
    let mut found = Vec::new();
    for path in files {
        let text = std::fs::read_to_string(&path).unwrap();
        let source = Source::new(path.strip_prefix(&folder).unwrap(), &text);
        if !source.is_test() {
            found.extend(check(&source).into_iter().map(|what| format!("{}:{what}", source.name)));
        }
    }
    found
}

/// The top-level modules under `src`.
fn modules() -> BTreeSet<String> {
    let folder = root().join("src");
    let files = rust_files(&folder);
    let modules = files.iter().map(|path| Source::new(path.strip_prefix(&folder).unwrap(), "").module);
    modules.filter(|module| !module.is_empty()).collect()
}

#[track_caller]
#[allow(clippy::needless_pass_by_value, reason = "it is the end of every list")]
fn assert_none(offences: Vec<String>) {
    assert!(offences.is_empty(), "\n{}", offences.join("\n"));
}

// Tokens.

fn is_punct(token: Option<&TokenTree>, c: char) -> bool {
    matches!(token, Some(TokenTree::Punct(p)) if p.as_char() == c)
}

fn ident(token: Option<&TokenTree>) -> Option<String> {
    match token {
        Some(TokenTree::Ident(i)) => Some(i.to_string()),
        _ => None,
    }
}

fn line(token: &TokenTree) -> usize {
    token.span().start().line
}

/// The tokens without the items marked `#[cfg(test)]` or `#[cfg(all(test, …))]`, at every depth.
fn without_tests(tokens: TokenStream) -> Vec<TokenTree> {
    let tokens: Vec<_> = tokens.into_iter().collect();
    let mut kept = Vec::new();
    let mut at = 0;
    while at < tokens.len() {
        if is_punct(tokens.get(at), '#') && is_test_attribute(tokens.get(at + 1)) {
            // An item ends with its braces or a semicolon.
            let end = |t: &TokenTree| {
                is_punct(Some(t), ';') || matches!(t, TokenTree::Group(g) if g.delimiter() == Delimiter::Brace)
            };
            let length = tokens[at + 2..].iter().position(end).map_or(tokens.len(), |n| n + 3);
            at += length;
            continue;
        }
        kept.push(match &tokens[at] {
            TokenTree::Group(g) => {
                let inner = without_tests(g.stream()).into_iter().collect();
                let mut group = proc_macro2::Group::new(g.delimiter(), inner);
                group.set_span(g.span());
                group.into()
            }
            token => token.clone(),
        });
        at += 1;
    }
    kept
}

fn is_test_attribute(token: Option<&TokenTree>) -> bool {
    let Some(TokenTree::Group(group)) = token else { return false };
    let text: String = group.stream().to_string().split_whitespace().collect();
    text == "cfg(test)" || text.starts_with("cfg(all(test,")
}

/// Calls `visit` with every token and those before it in its group, at every depth.
fn walk(tokens: &[TokenTree], visit: &mut impl FnMut(&[TokenTree], &TokenTree)) {
    for (at, token) in tokens.iter().enumerate() {
        visit(&tokens[..at], token);
        if let TokenTree::Group(group) = token {
            walk(&group.stream().into_iter().collect::<Vec<_>>(), visit);
        }
    }
}

// Imports.

/// A path that reaches a top-level module.
#[derive(Debug, PartialEq, Eq)]
struct Import {
    line: usize,
    module: String,
}

/// All `crate::NAME`, `crate::{NAME, …}` and `super::…::super::NAME` that leave for the crate's root.
fn imports(source: &Source) -> Vec<Import> {
    let mut found = Vec::new();
    paths(&source.tokens, source.depth, &mut found);
    found
}

/// Scans tokens that stand `depth` modules below the root.
fn paths(tokens: &[TokenTree], depth: usize, found: &mut Vec<Import>) {
    let mut at = 0;
    while at < tokens.len() {
        let name = ident(tokens.get(at));
        let begins = name.as_deref().is_some_and(|n| ["crate", "super"].contains(&n)) && !follows_path(&tokens[..at]);
        if begins {
            at = path(tokens, at, depth, found);
            continue;
        }
        if let TokenTree::Group(group) = &tokens[at] {
            let inner: Vec<_> = group.stream().into_iter().collect();
            let is_module = at >= 2 && ident(tokens.get(at - 2)).as_deref() == Some("mod");
            paths(&inner, depth + usize::from(is_module), found);
        }
        at += 1;
    }
}

/// Whether `self::` or the like stands before: only `self` may, and it changes nothing.
fn follows_path(before: &[TokenTree]) -> bool {
    let n = before.len();
    n >= 3 && is_punct(before.last(), ':') && ident(before.get(n - 3)).is_some_and(|i| i != "self")
}

/// Reads one path, or a tree of paths, from `at`; `depth` modules lie between it and the root. Returns where it ends.
fn path(tokens: &[TokenTree], mut at: usize, mut depth: usize, found: &mut Vec<Import>) -> usize {
    loop {
        match ident(tokens.get(at)).as_deref() {
            Some("crate") => depth = 0,
            Some("super") => depth = depth.saturating_sub(1),
            Some("self") => {}
            Some(module) if depth == 0 => {
                found.push(Import { line: line(&tokens[at]), module: module.to_owned() });
                return at + 1;
            }
            _ => break,
        }
        if !(is_punct(tokens.get(at + 1), ':') && is_punct(tokens.get(at + 2), ':')) {
            return at + 1;
        }
        at += 3;
    }
    match tokens.get(at) {
        Some(TokenTree::Group(group)) if group.delimiter() == Delimiter::Brace => {
            let inner: Vec<_> = group.stream().into_iter().collect();
            for branch in inner.split(|t| is_punct(Some(t), ',')) {
                path(branch, 0, depth, found);
            }
            at + 1
        }
        Some(star) if is_punct(Some(star), '*') && depth == 0 => {
            found.push(Import { line: line(star), module: "*".to_owned() });
            at + 1
        }
        _ => at,
    }
}

fn illegal_import(source: &Source, import: &Import) -> Option<String> {
    let place = |module: &str| ORDER.iter().position(|m| *m == module);
    let legal = match (place(&source.module), place(&import.module)) {
        _ if source.module == ORACLE || source.module.is_empty() || source.module == import.module => true,
        (Some(from), Some(to)) => to < from,
        // A glob could be anything; other names are macros and items of the crate's root.
        _ => import.module != ORACLE && import.module != "*",
    };
    (!legal).then(|| format!("{}: `{}` imports from `{}`", import.line, source.module, import.module))
}

// Floats and embedded-graphics.

fn floats(tokens: &[TokenTree]) -> Vec<String> {
    let mut found = Vec::new();
    walk(tokens, &mut |before, token| {
        let float = match token {
            TokenTree::Ident(i) => ["f16", "f32", "f64", "f128"].iter().any(|f| i == f),
            TokenTree::Literal(l) => is_float(l) && !is_tuple_index(before),
            _ => false,
        };
        if float {
            found.push(format!("{}: {token}", line(token)));
        }
    });
    found
}

/// `1.0`, `1.`, `1e3`, `1f32`, but not `1_u8`, `0x1f32`, `"1.0"`.
fn is_float(literal: &Literal) -> bool {
    let text = literal.to_string();
    let prefixed = ["0x", "0o", "0b"].iter().any(|prefix| text.starts_with(prefix));
    let number = text.starts_with(|c: char| c.is_ascii_digit()) && !prefixed;
    let rest = text.trim_start_matches(|c: char| c.is_ascii_digit() || c == '_');
    number && rest.starts_with(['.', 'e', 'E', 'f'])
}

/// `t.0.1` has the tokens `t`, `.`, `0.1`; a range `0..1.0` has two dots, the first one joint.
fn is_tuple_index(before: &[TokenTree]) -> bool {
    match before {
        [.., TokenTree::Punct(a), TokenTree::Punct(b)] => {
            b.as_char() == '.' && !(a.as_char() == '.' && a.spacing() == Spacing::Joint)
        }
        [.., TokenTree::Punct(b)] => b.as_char() == '.',
        _ => false,
    }
}

fn draw_targets(tokens: &[TokenTree]) -> Vec<String> {
    let names = |i: &Ident| i.to_string().starts_with("embedded_graphics");
    let mut found = Vec::new();
    walk(tokens, &mut |_, token| match token {
        TokenTree::Ident(i) if names(i) => found.push(format!("{}: {i}", line(token))),
        _ => {}
    });
    found
}

// Texts.

fn too_long(text: &str) -> Option<usize> {
    Some(text.lines().count()).filter(|lines| *lines >= MAX_LINES)
}

fn unmentioned(document: &str, modules: impl IntoIterator<Item = String>) -> Vec<String> {
    let mentioned =
        |module: &String| document.contains(&format!("`{module}`")) || document.contains(&format!("`src/{module}`"));
    modules.into_iter().filter(|module| !mentioned(module)).map(|m| format!("ARCHITECTURE.md: no `{m}`")).collect()
}

// Each check can fail.

/// What the module order says about a snippet in a file.
fn order(path: &str, text: &str) -> Vec<String> {
    let source = Source::new(Path::new(path), text);
    imports(&source).iter().filter_map(|i| illegal_import(&source, i)).collect()
}

#[test]
fn a_later_module_is_found_in_every_kind_of_path() {
    let bad = [
        ("patch/curve.rs", "use crate::forward::Steps;"),
        ("patch/curve.rs", "use crate::{num::Coord, render::Pen};"),
        ("patch/curve.rs", "use crate::{num::{Coord}, {graphics}};"),
        ("patch/curve.rs", "use super::super::forward::Steps;"),
        ("patch/curve.rs", "use self::super::super::forward::Steps;"),
        ("patch/curve.rs", "use super::{Curve, super::forward::Steps};"),
        ("patch/curve.rs", "mod inner { use super::super::super::forward::Steps; }"),
        ("patch/curve.rs", "fn f() -> crate::mesh::Mesh { todo!() }"),
        ("patch/curve.rs", "macro_rules! m { () => { $crate::plot::Pen } }"),
        ("patch/mod.rs", "use super::forward::Steps;"),
        ("patch/mod.rs", "use crate::reference::lattice;"),
        ("patch/mod.rs", "use crate::*;"),
        ("patch.rs", "impl From<super::trim::Loop> for X {}"),
        ("patch/mod.rs", "#[cfg(feature = \"std\")] mod tests { use crate::forward::Steps; }"),
    ];
    for (path, text) in bad {
        assert_eq!(order(path, text).len(), 1, "{path}: {text}");
    }
    assert_eq!(order("num/mod.rs", "\n\nuse crate::patch::Curve;"), ["3: `num` imports from `patch`"]);
    assert_eq!(order("num/mod.rs", "use crate::{patch, {forward::Steps, mesh::*}};").len(), 3);
}

#[test]
fn legal_paths_pass() {
    let good = [
        ("patch/curve.rs", "use crate::num::{Coord, I16F16}; use crate::geometry;"),
        ("patch/curve.rs", "use super::{forward, Curve}; use crate::patch::mesh;"),
        ("patch/curve.rs", "pub(crate) struct A; pub(in crate::patch) struct B; pub(super) struct C;"),
        ("patch/curve.rs", "/// [`Steps`](crate::forward::Steps)\nuse crate::const_net;"),
        ("patch/mod.rs", "#[cfg(test)] mod tests { use crate::forward::Steps; fn f() {} }"),
        ("patch/mod.rs", "mod deep { #[cfg(test)] #[allow(dead_code)] mod tests { use crate::forward::Steps; } }"),
        ("patch/mod.rs", "#[cfg(all(test, feature = \"std\"))] use crate::forward::Steps;"),
        ("patch/mod.rs", "mod format { use super::{Coord, forward}; }"),
        ("forward/mod.rs", "use other::crate_like::render; use num_traits::Zero;"),
        ("reference/mod.rs", "use crate::graphics::Frame;"),
        ("lib.rs", "pub use crate::graphics::Frame;"),
    ];
    for (path, text) in good {
        assert_eq!(order(path, text), [""; 0], "{path}: {text}");
    }
}

#[test]
fn floats_are_found() {
    let found = |text: &str| floats(&without_tests(text.parse().unwrap()));
    let bad = [
        "fn f(x: f32) {}",
        "type T = core::f64::consts::C;",
        "let x = 1.0;",
        "let x = 1.;",
        "let x = 1e3;",
        "let x = 1E-3;",
        "let x = 2_f32;",
        "let x = 1_0.5_0;",
        "let x = 0..1.5;",
        "let x = ..1.5;",
        "let x = 0..=1.5;",
        "m!{ [(-1.5)] }",
        "fn f() -> f128 { 0 }",
        "#[cfg(not(test))] mod m { type T = f16; }",
    ];
    for text in bad {
        assert_eq!(found(text).len(), 1, "{text}");
    }
    let good = [
        "let x = t.0.1 + t.0.1.2 + t.1;",
        "let x = t\n    .0.1;",
        "let x = 0x1f32 + 0b1 + 0xe3 + 1_usize + 5isize + 1_000_u64;",
        "let x = 1..2; let y = 1..=2; let z = 1.max(2);",
        "let s = \"1.0 f32\"; let b = b\"1.0\"; // 1.0 f64",
        "/// 1.0 as f64\nfn g() {}",
        "#[cfg(test)] mod tests { fn f(x: f64) -> f64 { 1.0 } }",
        "let f32s = 1; let to_f64 = 2;",
    ];
    for text in good {
        assert_eq!(found(text), [""; 0], "{text}");
    }
}

#[test]
fn draw_targets_are_found() {
    let found = |text: &str| draw_targets(&without_tests(text.parse().unwrap()));
    assert_eq!(found("use embedded_graphics::prelude::*;").len(), 1);
    assert_eq!(found("fn f() { let p = embedded_graphics_core::geometry::Point::zero(); }").len(), 1);
    assert_eq!(found("/// `embedded_graphics`\nuse crate::graphics::Frame;"), [""; 0]);
}

#[test]
fn long_files_are_found() {
    assert_eq!(too_long(&"//\n".repeat(MAX_LINES - 1)), None);
    assert_eq!(too_long(&"//\n".repeat(MAX_LINES)), Some(MAX_LINES));
}

#[test]
fn unnamed_modules_are_found() {
    let modules = || ["num", "patch"].map(String::from);
    assert_eq!(unmentioned("| `num` | | `src/patch` |", modules()), [""; 0]);
    assert_eq!(unmentioned("`num` and patch", modules()), ["ARCHITECTURE.md: no `patch`"]);
}
