//! The `golden` tool, run as a user runs it: answers against exact rationals, malformed files against exit 2.
//!
//! `tests/golden/lattice.json`: the expected points are direct Bernstein sums in exact rationals, rounded half up.
//! `tests/golden/tessellate.json`: triangles at `most` are allowed; every corner of the mesh must be the patch's point at
//! its parameters, and every edge within the patches must have a triangle on either side.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]
#![allow(clippy::disallowed_types, clippy::float_arithmetic, reason = "an oracle in f64")]

#[path = "common/golden.rs"]
mod tool;

use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use tool::golden;

/// A case written to a file of its own.
fn file(name: &str, text: &str) -> PathBuf {
    let path = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(format!("{name}.json"));
    std::fs::write(&path, text).unwrap();
    path
}

fn answer(output: &Output) -> Value {
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).unwrap()
}

#[test]
fn lattices_equal_exact_rationals() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/golden/lattice.json");
    let cases: Value = serde_json::from_str(&std::fs::read_to_string(&path).unwrap()).unwrap();
    let results = answer(&golden("lattice", &path, &[]));
    let (cases, results) = (cases["cases"].as_array().unwrap(), results["results"].as_array().unwrap());
    assert_eq!(cases.len(), results.len());
    for (case, result) in cases.iter().zip(results) {
        assert_eq!(case["name"], result["name"]);
        for (key, expected) in case["expect"].as_object().unwrap() {
            assert_eq!(&result[key], expected, "{key} of {}", case["name"]);
        }
    }
    let error = results.last().unwrap()["message"].as_str().unwrap();
    assert!(error.contains("(8, 8)") && error.contains("300 x 400") && error.contains("153 bits"), "{error}");
}

/// Σ weight · Bernstein · control point of a patch as the case describes it.
fn patch_point(patch: &Value, [u, v]: [f64; 2]) -> [f64; 3] {
    let choose = |n: usize, k: usize| (0..k).fold(1.0, |c, i| c * (n - i) as f64 / (i + 1) as f64);
    let power = |x: f64, n: usize| x.powi(n as i32);
    let bernstein = |n: usize, i: usize, t: f64| choose(n, i) * power(t, i) * power(1.0 - t, n - i);
    let mut sum = [0.0; 4];
    let mut add = |basis: f64, point: &Value, weight: &Value| {
        let weight = basis * weight.as_f64().unwrap_or(1.0);
        (0..3).for_each(|c| sum[c] += weight * point[c].as_f64().unwrap());
        sum[3] += weight;
    };
    if let Some(n) = patch["degree"].as_u64() {
        let n = n as usize;
        let order = (0..=n).rev().flat_map(|i| (0..=n - i).rev().map(move |j| (i, j)));
        for (at, (i, j)) in order.enumerate() {
            let basis = choose(n, i) * choose(n - i, j) * power(u, i) * power(v, j) * power(1.0 - u - v, n - i - j);
            add(basis, &patch["ctrl"][at], &patch["weights"][at]);
        }
    } else {
        let [m, h] = [0, 1].map(|d| patch["degree"][d].as_u64().unwrap() as usize);
        for (i, j) in (0..=m).flat_map(|i| (0..=h).map(move |j| (i, j))) {
            add(bernstein(m, i, u) * bernstein(h, j, v), &patch["ctrl"][i][j], &patch["weights"][i][j]);
        }
    }
    [0, 1, 2].map(|c: usize| sum[c] / sum[3])
}

#[test]
fn meshes_have_their_vertices_on_the_patches_and_no_crack() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/golden/tessellate.json");
    let cases: Value = serde_json::from_str(&std::fs::read_to_string(&path).unwrap()).unwrap();
    let results = answer(&golden("tessellate", &path, &[]));
    for (case, result) in cases["cases"].as_array().unwrap().iter().zip(results["results"].as_array().unwrap()) {
        let name = &case["name"];
        assert_eq!(name, &result["name"]);
        for (key, expected) in case["expect"].as_object().unwrap() {
            // 9 and 9.0 are the same number.
            let plain = |value: &Value| value.to_string().replace(".0,", ",").replace(".0]", "]");
            assert_eq!(plain(&result[key]), plain(expected), "{key} of {name}");
        }
        let Some(triangles) = result["triangles"].as_array() else { continue };
        assert!(triangles.len() <= case["most"].as_u64().unwrap_or(u64::MAX) as usize, "{} of {name}", triangles.len());
        let patches = case["patches"].as_array().cloned().unwrap_or_else(|| vec![case["patch"].clone()]);
        let corners = result["corners"].as_array().unwrap();
        assert_eq!(corners.len(), triangles.len());
        let mut edges = std::collections::BTreeSet::new();
        for (triangle, corners) in triangles.iter().zip(corners) {
            let [a, b, c] = [0, 1, 2].map(|k| triangle[k].as_u64().unwrap() as usize);
            assert!([(a, b), (b, c), (c, a)].into_iter().all(|edge| edges.insert(edge)), "an edge twice in {name}");
            for k in 0..3 {
                let at = [0, 1].map(|p| corners[k + 1][p].as_f64().unwrap());
                let exact = patch_point(&patches[corners[0].as_u64().unwrap() as usize], at);
                let vertex = &result["vertices"][triangle[k].as_u64().unwrap() as usize];
                assert!((0..3).all(|c| (vertex[c].as_f64().unwrap() - exact[c]).abs() < 1.0001 / 131_072.0), "{name}");
            }
        }
        // One disc each: vertices − edges + triangles = 1.
        let border = edges.iter().filter(|(a, b)| !edges.contains(&(*b, *a))).count();
        let count = result["vertices"].as_array().unwrap().len();
        assert_eq!(count + triangles.len(), (edges.len() + border) / 2 + 1, "{name}");
    }
}

fn square() -> Value {
    json!({"kind": "tensor", "degree": [1, 1], "ctrl": [[[2, 2, 0], [2, 9, 0]], [[9, 2, 0], [9, 9, 0]]]})
}

#[test]
fn a_picture_is_written_and_counted() {
    let case = json!({
        "patch": square(), "size": [16, 12], "band": 5, "style": "flat", "color": [10, 200, 30],
        "background": [1, 2, 3], "unknown": 7,
    });
    let png = Path::new(env!("CARGO_TARGET_TMPDIR")).join("square.png");
    let output = golden("render", &file("square", &case.to_string()), &["-o", png.to_str().unwrap()]);
    let expected = json!({"status": "ok", "points": 81, "pixels": 64, "pieces": 2, "splits": 0, "missed": 0});
    assert_eq!(answer(&output), expected);
    assert!(std::fs::read(&png).unwrap().starts_with(b"\x89PNG"));
}

#[test]
fn a_grid_is_four_vertices_or_refused() {
    let case = |tolerance: u32| json!({"patch": square(), "size": [16, 12], "band": 5, "fill": {"grid": tolerance}});
    // Facets leave out centres on the right and on the lower border: 7 × 7 pixels.
    let expected = json!({"status": "ok", "points": 4, "pixels": 49, "pieces": 1, "splits": 0, "missed": 0});
    assert_eq!(answer(&golden("render", &file("grid", &case(1).to_string()), &[])), expected);
    let refused = answer(&golden("render", &file("grid-0", &case(0).to_string()), &[]));
    assert_eq!(refused["status"], "Tolerance");
}

#[test]
fn views_map_the_model_to_the_screen() {
    let mut case = json!({"patch": square(), "size": [40, 40], "style": "flat"});
    // Seen along z, fitted: a square of 7 units fills half of 40 pixels, 10 ..= 30.
    case["view"] = json!({"tilt": 0, "spin": 0, "fit": 0.5});
    assert_eq!(answer(&golden("render", &file("fit", &case.to_string()), &[]))["pixels"], 21 * 21);
    case["view"] = json!({"matrix": [[1, 0, 0, 0.5], [0, 2, 0, 1], [0, 0, 1, 0]]});
    assert_eq!(answer(&golden("render", &file("matrix", &case.to_string()), &[]))["pixels"], 8 * 15);
    case["view"] = json!({"matrix": [[1e6, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0]]});
    let error = answer(&golden("render", &file("far", &case.to_string()), &[]));
    assert_eq!(error["status"], "OutOfRange");
    assert!(error["message"].as_str().unwrap().contains("2000000"), "{error}");
}

#[test]
fn perspective_views_are_rational_and_keep_the_plane_of_the_screen() {
    let mut case = json!({"patch": square(), "size": [40, 40], "style": "flat"});
    case["view"] = json!({"tilt": 0, "spin": 0, "fit": 0.5, "perspective": 2});
    // The square lies in the plane z = 0, which keeps its scale.
    let answer_flat = answer(&golden("render", &file("eye", &case.to_string()), &[]));
    assert_eq!((&answer_flat["pixels"], &answer_flat["missed"]), (&json!(21 * 21), &json!(0)));
    case["view"] = json!({"tilt": -90, "spin": 40, "fit": 0.5, "perspective": 0.1});
    let error = answer(&golden("render", &file("behind", &case.to_string()), &[]));
    assert_eq!(error["status"], "BehindEye", "{error}");
}

#[test]
fn several_cases_give_several_results_and_pictures() {
    let case =
        json!({"ok_cases": [{"name": "a", "patch": square()}], "error_cases": [{"name": "b", "patch": square()}]});
    let png = Path::new(env!("CARGO_TARGET_TMPDIR")).join("several.png");
    let results = answer(&golden("render", &file("several", &case.to_string()), &["-o", png.to_str().unwrap()]));
    assert_eq!(results["results"][1]["name"], "b");
    assert!(png.with_file_name("several-0.png").exists() && png.with_file_name("several-1.png").exists());
}

/// A list of one flat triangle with these weights.
fn flat(weights: &Value) -> String {
    json!([{"kind": "tri", "degree": 1, "ctrl": [[0, 0, 0], [1, 0, 0], [0, 1, 0]], "weights": weights}]).to_string()
}

/// A case with one member replaced.
fn with(key: &str, value: Value) -> String {
    let mut case = json!({"patch": square(), "steps": 4});
    case[key] = value;
    case.to_string()
}

#[test]
fn what_is_wrong_exits_with_2_and_names_the_field() {
    let mut patch = square();
    let mut broken = |path: &str, value: Value| {
        let old = patch.pointer(path).unwrap().clone();
        *patch.pointer_mut(path).unwrap() = value;
        let text = with("patch", patch.clone());
        *patch.pointer_mut(path).unwrap() = old;
        text
    };
    let cases = [
        ("lattice", "{\"patch\": {\"kind\": \"tri\", \"degree\": 1, \"ctrl\": [[0, NaN, 0]]}}".into(), "patch.ctrl[0]"),
        (
            "lattice",
            "{\"steps\": 1, \"patch\": {\"kind\": \"tri\", \"degree\": 1, \"ctrl\": [[0, 1e999, 0], [0, 0, 0], [1, 1, 1]]}}".into(),
            "patch.ctrl[0][1]",
        ),
        ("lattice", "{\"patch\": {} trailing".into(), "the case: expected"),
        ("lattice", "[]".into(), "the case"),
        ("lattice", "{}".into(), "patch"),
        ("lattice", broken("/ctrl/1/0/2", json!(32768)), "patch.ctrl[1][0][2]"),
        ("lattice", broken("/ctrl/1/0/2", json!("7")), "patch.ctrl[1][0][2]"),
        ("lattice", broken("/ctrl/1/0/2", Value::Null), "patch.ctrl[1][0][2]"),
        ("lattice", broken("/ctrl/1/0", json!([1, 2])), "patch.ctrl[1][0]"),
        ("lattice", broken("/ctrl/1", json!([[1, 2, 3]])), "patch.ctrl[1]"),
        ("lattice", broken("/ctrl", json!([[[1, 2, 3]]])), "patch.ctrl"),
        ("lattice", broken("/degree", json!([1, 9])), "patch.degree[1]"),
        ("lattice", broken("/degree", json!([0, 1])), "patch.degree[0]"),
        ("lattice", broken("/degree", json!(1)), "patch.degree"),
        ("lattice", broken("/kind", json!("quad")), "patch.kind"),
        ("lattice", with("steps", json!(0)), "steps"),
        ("lattice", with("steps", json!([3, -1])), "steps[1]"),
        ("lattice", with("steps", json!(2.5)), "steps"),
        ("lattice", with("steps", json!("fine")), "steps"),
        ("lattice", with("steps", json!([1, 2, 3])), "steps"),
        ("tessellate", with("tolerance", json!("fine")), "tolerance"),
        ("tessellate", with("steps", json!(3)), "tolerance"),
        ("tessellate", json!({"tolerance": 1}).to_string(), "patches"),
        ("tessellate", broken("/ctrl/1/0/2", json!(1e9)).replace("\"steps\"", "\"tolerance\""), "patch.ctrl[1][0][2]"),
        ("render", with("size", json!([0, 4])), "size[0]"),
        ("render", with("size", json!(4)), "size"),
        ("render", with("band", json!(0)), "band"),
        ("render", with("style", json!("cubist")), "style"),
        ("render", with("fill", json!({"mesh": 1})), "fill"),
        ("render", with("fill", json!({"grid": "x"})), "fill.grid"),
        ("render", with("fill", json!({"grid": 1e9})), "fill.grid"),
        ("render", with("color", json!([1, 2, 256])), "color[2]"),
        ("render", with("background", json!([1, 2])), "background"),
        ("render", with("view", json!({"perspective": 0})), "view.perspective"),
        ("render", with("view", json!({"matrix": [[1, 2, 3, 4]]})), "view.matrix"),
        ("render", with("view", json!({"tilt": "up"})), "view.tilt"),
        ("render", with("view", json!({"fit": 0})), "view.fit"),
        ("render", with("view", json!(3)), "view"),
        (
            "render",
            json!({"vertices": [[0, 0, 0]], "patches": [[0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1]]}).to_string(),
            "patches[0][15]",
        ),
        (
            "render",
            with("patches", json!([])).replace("\"patch\"", "\"unused\"").replace("[]", &flat(&json!([1, 0, 1]))),
            "patches[0].weights[1]",
        ),
        (
            "render",
            with("patches", json!([])).replace("\"patch\"", "\"unused\"").replace("[]", &flat(&json!([1, 1]))),
            "patches[0].weights",
        ),
    ];
    for (index, (command, text, field)) in cases.into_iter().enumerate() {
        let output = golden(command, &file(&format!("malformed-{index}"), &text), &[]);
        let message = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{text}: {message}");
        assert!(message.contains(field), "{text}: {message}");
        assert!(output.stdout.is_empty());
    }
    for arguments in [["lattice", "no-such-file.json"], ["conquer", "x.json"]] {
        let output = Command::new(tool::path()).args(arguments).output().unwrap();
        assert_eq!(output.status.code(), Some(2));
        assert!(!output.stderr.is_empty());
    }
}
