//! `golden g1`, run as a user runs it: the reference cases, the options, malformed files.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]
#![allow(clippy::disallowed_types, clippy::float_arithmetic, clippy::float_cmp, reason = "an oracle in f64")]

#[path = "common/golden.rs"]
#[allow(dead_code)]
mod tool;

use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use std::process::Output;

fn golden(case: &Path) -> Output {
    tool::golden("g1", case, &[])
}

/// The result of a case written to a file of its own.
fn run(name: &str, case: &Value) -> Output {
    let path = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(format!("g1-{name}.json"));
    std::fs::write(&path, case.to_string()).unwrap();
    golden(&path)
}

fn answer(output: &Output) -> Value {
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).unwrap()
}

fn data() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/g1.json")
}

fn case(name: &str) -> Value {
    let file: Value = serde_json::from_str(&std::fs::read_to_string(data()).unwrap()).unwrap();
    file["ok_cases"].as_array().unwrap().iter().find(|case| case["name"] == name).unwrap().clone()
}

/// The largest difference of coordinates, the expected ones times a factor.
fn difference(ours: &Value, expected: &Value, factor: f64) -> f64 {
    let mut worst = 0.0_f64;
    let lists = |value: &Value| value.as_array().unwrap().clone();
    assert_eq!(lists(ours).len(), lists(expected).len());
    for (ours, expected) in lists(ours).iter().zip(lists(expected)) {
        assert_eq!((lists(ours).len(), lists(&expected).len()), (21, 21));
        for (ours, expected) in lists(ours).iter().zip(lists(&expected)) {
            assert_eq!(ours[0], expected[0]);
            for c in 0..3 {
                worst = worst.max((ours[1][c].as_f64().unwrap() - factor * expected[1][c].as_f64().unwrap()).abs());
            }
        }
    }
    worst
}

#[test]
fn the_reference_file_gives_its_results() {
    let file: Value = serde_json::from_str(&std::fs::read_to_string(data()).unwrap()).unwrap();
    let results = answer(&golden(&data()));
    let cases: Vec<_> = ["ok_cases", "error_cases"].iter().flat_map(|list| file[list].as_array().unwrap()).collect();
    assert_eq!(results["results"].as_array().unwrap().len(), cases.len());
    for (case, result) in cases.iter().zip(results["results"].as_array().unwrap()) {
        assert_eq!((&result["name"], &result["status"]), (&case["name"], &case["expect"]["status"]));
        if result["status"] != "ok" {
            assert!(result["message"].is_string());
            continue;
        }
        let quality = &result["quality"];
        assert!(quality["max_angle"].as_f64().unwrap() < 5e-9, "{quality}");
        assert!(quality["max_dev_pn"].is_f64() && quality["max_correction"].is_f64(), "{quality}");
        assert_eq!(quality["folded"], json!([]));
        if case.get("shifted").is_some() {
            assert_eq!(quality["shifted"], case["shifted"]);
        }
        if case.get("control_points").is_some() {
            let worst = difference(&result["control_points"], &case["control_points"], 1.0);
            assert!(worst < 1e-10, "{}: {worst:e}", case["name"]);
        }
    }
}

#[test]
fn the_scale_is_applied_first() {
    let mut octahedron = case("octa");
    for scale in [1.0, 256.0, 0.125] {
        octahedron["options"] = json!({ "scale": scale });
        let result = answer(&run("scale", &octahedron));
        let worst = difference(&result["control_points"], &octahedron["control_points"], scale);
        assert!(worst < 2e-9 * scale.max(1.0), "{scale}: {worst:e}");
    }
}

#[test]
fn schemes_and_modes_can_be_compared() {
    let mut tetrahedron = case("tetra");
    let mut with = |options: Value| {
        tetrahedron["options"] = options;
        answer(&run("scheme", &tetrahedron))
    };
    let angle = |result: &Value| result["quality"]["max_angle"].as_f64().unwrap();
    assert!(angle(&with(json!({ "mode": "proj" }))) < 5e-9);
    assert!(angle(&with(json!({ "scheme": "pn" }))) > 1.0);
    let flat = angle(&with(json!({ "scheme": "flat" })));
    assert!((flat - (-1.0 / 3.0_f64).acos()).abs() < 1e-9, "{flat}");
    let literal = with(json!({ "scheme": "literal" }));
    assert_eq!(literal["status"], "EqualRatios");
}

#[test]
fn malformed_files_name_their_field() {
    let base = case("one_triangle");
    let cases = [
        ("vertices", json!(7), "vertices: is not a list"),
        ("vertices", json!([[0, 0, 0], [1, 0], [0, 1, 0]]), "vertices[1]: has 2 items"),
        ("vertices", json!([[0, 0, 0], [1, 0, "x"], [0, 1, 0]]), "vertices[1][2]:"),
        ("faces", json!([[0, 1, 2.5]]), "faces[0][2]: 2.5 is not a whole number"),
        ("normals", json!([[0, 0, 1], 3, [0, 0, 1]]), "normals[1]: is not a list"),
        ("tangents", json!([[0, 1]]), "tangents[0]: has 2 items instead of 3"),
        ("options", json!({ "scale": 3 }), "options.scale: 3 is not a power of two"),
        ("options", json!({ "mode": "arcs" }), "options.mode: \"arcs\""),
        ("options", json!({ "strict": 1 }), "options.strict: is neither true nor false"),
        ("options", json!({ "tolerance": 2 }), "options.tolerance: 2"),
        ("options", json!({ "scheme": "best" }), "options.scheme: \"best\""),
    ];
    for (key, value, message) in cases {
        let mut case = base.clone();
        case[key] = value;
        let output = run("malformed", &case);
        let said = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{said}");
        assert!(said.contains(message), "{said} instead of {message}");
    }
    let mut case = base.clone();
    case.as_object_mut().unwrap().remove("faces");
    let output = run("missing", &case);
    assert_eq!(output.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&output.stderr).contains("faces: is missing"));
    // What the mesh is made of is a result.
    let mut case = base;
    case["faces"] = json!([[0, 1, 9]]);
    assert_eq!(answer(&run("index", &case))["status"], "Index");
    case["faces"] = json!([[0, 1]]);
    assert_eq!(answer(&run("corners", &case))["status"], "DegenerateFace");
    case["faces"] = json!([]);
    assert_eq!(answer(&run("none", &case))["control_points"], json!([]));
}
