//! The pictures of the docs: `docs/img/NAME.md` embeds `docs/img/NAME.png`, so that they show without a network.
//!
//! `UPDATE_DOCS=1 cargo test --test docs` writes them anew from the PNG files.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use base64::Engine;
use std::path::Path;

#[test]
fn embedded_pictures_are_the_files() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/img");
    let mut pictures = 0;
    for entry in std::fs::read_dir(&folder).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_none_or(|e| e != "png") {
            continue;
        }
        let name = path.file_stem().unwrap().to_str().unwrap();
        let data = base64::engine::general_purpose::STANDARD.encode(std::fs::read(&path).unwrap());
        let expected = format!("![{}](data:image/png;base64,{data})\n", name.replace('_', " "));
        let page = path.with_extension("md");
        if std::env::var_os("UPDATE_DOCS").is_some() {
            std::fs::write(&page, &expected).unwrap();
        }
        assert!(std::fs::read_to_string(&page).unwrap() == expected, "{} is not its PNG", page.display());
        pictures += 1;
    }
    assert!(pictures >= 2);
}
