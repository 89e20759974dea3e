//! `golden intersect`, run as a user runs it: the cases with their components, ends and flags; malformed files.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]
#![allow(clippy::disallowed_types, clippy::float_arithmetic, clippy::float_cmp, reason = "an oracle in f64")]

#[path = "common/meeting.rs"]
#[allow(dead_code)]
mod meeting;
#[path = "common/golden.rs"]
#[allow(dead_code)]
mod tool;

use meeting::{CASES, cases, expected};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use std::process::Output;

/// The answer to a case written to a file of its own.
fn run(name: &str, case: &Value) -> Output {
    let path = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(format!("intersect-{name}.json"));
    std::fs::write(&path, case.to_string()).unwrap();
    tool::golden("intersect", &path, &[])
}

fn answer(output: &Output) -> Value {
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).unwrap()
}

#[test]
fn cases_give_their_components_in_order() {
    let answer = answer(&tool::golden("intersect", Path::new(CASES), &[]));
    let results = answer["results"].as_array().unwrap();
    assert_eq!(results.len(), cases().len());
    for (result, case) in results.iter().zip(cases()) {
        let name = &case["name"];
        assert_eq!((&result["name"], &result["status"]), (name, &json!("ok")));
        let components = result["components"].as_array().unwrap();
        let (kinds, length, arms) = expected(&case);
        let mut found: Vec<_> = components.iter().map(|c| c["kind"].as_str().unwrap().to_owned()).collect();
        found.sort_unstable();
        assert_eq!(found, kinds, "{name}");
        if let Some(length) = length {
            let sum: f64 = components.iter().map(|c| c["length"].as_f64().unwrap()).sum();
            assert!((sum - length).abs() <= 1e-6 * length.max(1e-3), "{name}: {sum} and {length}");
        }
        let branches = result["branches"].as_array().unwrap();
        assert_eq!(branches.iter().map(|b| b["arms"].as_u64().unwrap()).collect::<Vec<_>>(), arms, "{name}");
        for flag in ["certified", "perturbation_sensitive"] {
            assert!(result[flag].is_boolean(), "{name}: {flag}");
        }
        for count in ["undecided", "zero_predicates", "degenerate_triangles"] {
            assert!(result[count].is_u64(), "{name}: {count}");
        }
    }
}

/// Two squares that cross along x = 0 from border to border: all of the component is known.
#[test]
fn a_component_has_points_tangents_and_ends() {
    let flat =
        json!({"kind": "tensor", "degree": [1, 1], "ctrl": [[[-8, -8, 0], [-8, 8, 0]], [[8, -8, 0], [8, 8, 0]]]});
    let steep =
        json!({"kind": "tensor", "degree": [1, 1], "ctrl": [[[0, -9, -9], [0, 9, -9]], [[0, -9, 9], [0, 9, 9]]]});
    let answer = answer(&run("squares", &json!({"name": "squares", "A": flat, "B": steep})));
    assert_eq!((&answer["certified"], &answer["undecided"]), (&json!(true), &json!(0)));
    let [component] = answer["components"].as_array().unwrap().as_slice() else { panic!("{answer}") };
    assert_eq!((&component["kind"], &component["closed"]), (&json!("open_curve"), &json!(false)));
    assert!((component["length"].as_f64().unwrap() - 16.0).abs() < 1e-9);
    assert!((component["min_sin"].as_f64().unwrap() - 1.0).abs() < 1e-6);
    let mut ends: Vec<_> = component["ends"].as_array().unwrap().iter().map(Value::to_string).collect();
    ends.sort_unstable();
    assert_eq!(ends, ["[0,2]", "[0,3]"]); // v = 0 and v = 1 of A
    for point in component["points"].as_array().unwrap() {
        let numbers = |key: &str| -> Vec<f64> { serde_json::from_value(point[key].clone()).unwrap() };
        let (uvst, xyz, tangent) = (numbers("uvst"), numbers("xyz"), numbers("tangent"));
        let y = 16.0 * uvst[1] - 8.0;
        for (ours, exact) in [(uvst[0], 0.5), (uvst[2], 0.5), (uvst[3], (y + 9.0) / 18.0)] {
            assert!((ours - exact).abs() < 1e-9, "{point}");
        }
        for (ours, exact) in xyz.iter().zip([0.0, y, 0.0]) {
            assert!((ours - exact).abs() < 1e-9, "{point}");
        }
        assert!((tangent[1].abs() - 1.0).abs() < 1e-6, "{point}");
    }
}

#[test]
fn what_is_wrong_is_named() {
    let flat = json!({"kind": "tensor", "degree": [1, 1], "ctrl": [[[0, 0, 0], [0, 9, 0]], [[9, 0, 0], [9, 9, 0]]]});
    let with = |key: &str, value: Value| {
        let mut patch = flat.clone();
        patch[key] = value;
        patch
    };
    for (number, (case, text)) in [
        (json!({"A": flat}), "B: is missing"),
        (json!({"A": flat, "B": with("degree", json!([9, 1]))}), "B.degree[0]: 9"),
        (json!({"A": with("kind", json!("quad")), "B": flat}), "A.kind: \"quad\""),
        (json!({"A": flat, "B": with("weights", json!([[1, 1], [1, -1]]))}), "B.weights[1][1]: weight -1"),
        (json!({"A": flat, "B": with("ctrl", json!([[[0, 0, 0], [0, 99999, 0]], [[9, 0, 0], [9, 9, 0]]]))}), "99999"),
    ]
    .iter()
    .enumerate()
    {
        let output = run(&format!("wrong-{number}"), case);
        let said = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{said}");
        assert!(said.contains(text), "{said} does not say {text}");
    }
    // A point is a patch without a normal: an error of the geometry.
    let point = with("ctrl", json!([[[1, 1, 0], [1, 1, 0]], [[1, 1, 0], [1, 1, 0]]]));
    assert_eq!(answer(&run("point", &json!({"A": flat, "B": point})))["status"], "DegeneratePatch");
}
