//! Every public type has `defmt::Format` under the feature `defmt`, so that any of them can be logged: the sources are
//! searched for public types and for what implements the trait. `rustfmt` keeps both on lines of their own.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use std::path::Path;

/// Types without the trait: none.
const EXCEPTIONS: [&str; 0] = [];

/// Types that a macro makes or implements the trait for; the test at the end sees them.
const BY_MACROS: [&str; 4] = [
    "src/patch/rational_net.rs: $name",
    "src/patch/rational.rs: RationalCurve",
    "src/patch/rational.rs: RationalTriangle",
    "src/patch/rational.rs: RationalTensor",
];

#[test]
fn every_public_type_can_be_logged() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut sources = Vec::new();
    read(&root.join("src"), &mut sources);
    let implemented: Vec<_> = sources.iter().flat_map(|(_, text)| implementations(text)).collect();
    let (mut missing, mut types) = (Vec::new(), 0);
    for (path, text) in &sources {
        for (name, derived) in public_types(text) {
            let place = format!("{}: {name}", path.strip_prefix(root.to_str().unwrap()).unwrap().trim_matches('/'));
            types += 1;
            if !derived && !implemented.contains(&name) && !BY_MACROS.contains(&place.as_str()) {
                missing.push(place);
            }
        }
    }
    assert!(types > 70 && implemented.len() > 20, "found {types} types and {} implementations", implemented.len());
    assert_eq!(missing, EXCEPTIONS, "without defmt::Format");
}

/// All sources under a folder with their paths.
fn read(folder: &Path, sources: &mut Vec<(String, String)>) {
    for path in std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()) {
        if path.is_dir() {
            read(&path, sources);
        } else if path.extension().is_some_and(|e| e == "rs") {
            sources.push((path.to_str().unwrap().to_owned(), std::fs::read_to_string(&path).unwrap()));
        }
    }
}

/// The identifier at the start of a text, with the `$` of a macro's.
fn identifier(text: &str) -> &str {
    let end = text.find(|c: char| !(c.is_alphanumeric() || c == '_' || c == '$')).unwrap_or(text.len());
    &text[..end]
}

/// The names of public structures and enumerations, each with whether it derives the trait.
fn public_types(text: &str) -> Vec<(&str, bool)> {
    let lines: Vec<_> = text.lines().map(str::trim_start).collect();
    let mut found = Vec::new();
    for (at, line) in lines.iter().enumerate() {
        let Some(name) = ["pub struct ", "pub enum ", "pub union "].iter().find_map(|kind| line.strip_prefix(kind))
        else {
            continue;
        };
        // Its attributes and documentation are the lines up to an empty one or the end of another item.
        let above = lines[..at].iter().rev().take_while(|l| !l.is_empty() && !l.starts_with('}'));
        let derived = above.clone().any(|l| l.starts_with("#[") && l.contains("derive(defmt::Format)"));
        found.push((identifier(name), derived));
    }
    found
}

/// What the trait is implemented for.
fn implementations(text: &str) -> Vec<&str> {
    let lines = text.lines().map(str::trim_start).filter(|line| line.starts_with("impl"));
    lines.filter_map(|line| Some(identifier(line.split_once("Format for ")?.1))).collect()
}

#[test]
fn a_type_without_the_trait_is_found() {
    let text = "\
/// One.
#[derive(Clone)]
#[cfg_attr(feature = \"defmt\", derive(defmt::Format))]
#[non_exhaustive]
pub struct One<'a>(&'a ());

#[derive(Clone)]
pub enum Two {}
    pub struct $name<'a, C = I16F16> {
pub(crate) struct Three;
";
    assert_eq!(public_types(text), [("One", true), ("Two", false), ("$name", false)]);
    let text = "impl<C: Coord> defmt::Format for Two<C> {\n    impl Format for Four {}\n/// Format for five\n";
    assert_eq!(implementations(text), ["Two", "Four"]);
}

#[cfg(feature = "defmt")]
#[test]
fn generic_types_need_it_of_no_parameter() {
    use embedded_surfaces::graphics::{Model, Palette, Ramps};
    use embedded_surfaces::patch::{
        RationalCurve, RationalCurveNet, RationalTensor, RationalTensorNet, RationalTriangle, RationalTriangleNet,
    };
    use embedded_surfaces::render::{Band, Fragment, Frame, Scene, Tile};

    struct Bare;
    type Paint = fn(Fragment) -> u8;
    fn can_be_logged<T: defmt::Format>() {}
    can_be_logged::<RationalCurve<4>>();
    can_be_logged::<RationalTriangle<3, 10>>();
    can_be_logged::<RationalTensor<4, 4>>();
    can_be_logged::<RationalCurveNet<'_>>();
    can_be_logged::<RationalTriangleNet<'_>>();
    can_be_logged::<RationalTensorNet<'_>>();
    can_be_logged::<Scene<'_, Bare>>();
    can_be_logged::<Frame<'_, Bare, Paint>>();
    can_be_logged::<Band<'_, Bare>>();
    can_be_logged::<Tile<'_, Bare>>();
    can_be_logged::<Model<'_, Bare, Bare>>();
    can_be_logged::<Ramps<'_, Bare>>();
    can_be_logged::<Palette<Bare>>();
}
