//! Runs a case file through the public API and prints JSON: `golden COMMAND CASE.json [-o OUT]`.
//!
//! Exit 0: a result, typed errors of the geometry included. Exit 2: the file or the arguments are wrong; the message
//! names the field. `tests/golden/` holds case files with their expected answers.
#![allow(clippy::disallowed_types, clippy::float_arithmetic, reason = "JSON numbers are binary64")]

mod case;
#[path = "../data/draw.rs"]
mod draw;
mod field;
mod g1;
mod intersect;
mod lattice;
mod render;
mod tessellate;
mod view;
#[path = "../data/workspace.rs"]
mod workspace;

use clap::{Parser, ValueEnum};
use field::{Field, Malformed};
use serde_json::{Map, Value};
use std::path::PathBuf;
use std::process::ExitCode;

/// Run a case file through the crate and print JSON.
#[derive(Parser)]
struct Arguments {
    /// What to run
    command: Command,
    /// The case: a JSON object, or one with a list "cases"
    case: PathBuf,
    /// Where a picture (render) or a copy of the result goes
    #[arg(short, long)]
    output: Option<PathBuf>,
}

#[derive(Clone, Copy, ValueEnum)]
enum Command {
    /// The integer lattice of a patch
    Lattice,
    /// A picture of patches, and what it cost
    Render,
    /// The indexed mesh of patches to a tolerance
    Tessellate,
    /// Quintic triangles over a triangle mesh
    G1,
    /// The curves in which two patches meet
    Intersect,
}

/// A result, or a typed error of the geometry as one.
type Answer = Result<Map<String, Value>, Malformed>;

/// What a typed error of the crate becomes: its variant's name and its text.
fn typed_error(error: &(impl core::fmt::Debug + core::fmt::Display)) -> Map<String, Value> {
    let debug = format!("{error:?}");
    let kind: String = debug.chars().take_while(|c| c.is_alphanumeric()).collect();
    Map::from_iter([("status".into(), kind.into()), ("message".into(), error.to_string().into())])
}

fn run_one(command: Command, case: &Field<'_>, output: Option<PathBuf>) -> Answer {
    let answer = match command {
        Command::Lattice => lattice::run(case)?,
        Command::Render => render::run(case, output)?,
        Command::Tessellate => tessellate::run(case)?,
        Command::G1 => g1::run(case)?,
        Command::Intersect => intersect::run(case)?,
    };
    let name = case.get("name").map(|name| ("name".to_owned(), name.value().clone()));
    Ok(name.into_iter().chain(answer).collect())
}

/// `out.png` for a single case; `out-3.png` for the fourth of several.
fn numbered(output: &Option<PathBuf>, index: usize) -> Option<PathBuf> {
    let path = output.as_ref()?;
    let stem = path.file_stem()?.to_string_lossy();
    let extension = path.extension().map(|e| format!(".{}", e.to_string_lossy())).unwrap_or_default();
    Some(path.with_file_name(format!("{stem}-{index}{extension}")))
}

fn run(arguments: &Arguments) -> Result<Value, Malformed> {
    let text = std::fs::read_to_string(&arguments.case)
        .map_err(|error| Malformed::new(&arguments.case.display().to_string(), &error.to_string()))?;
    let file = field::parse(&text)?;
    let root = Field::root(&file);
    let Some(cases) = case::several(&root)? else {
        return Ok(Value::Object(run_one(arguments.command, &root, arguments.output.clone())?));
    };
    let mut results = Vec::new();
    for (index, case) in cases.iter().enumerate() {
        let output = numbered(&arguments.output, index);
        results.push(Value::Object(run_one(arguments.command, case, output)?));
    }
    Ok(Value::Object(Map::from_iter([("results".to_owned(), Value::Array(results))])))
}

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    let result = run(&arguments).and_then(|value| {
        let text = value.to_string();
        if let (Command::Lattice | Command::Tessellate | Command::G1 | Command::Intersect, Some(path)) =
            (arguments.command, &arguments.output)
        {
            std::fs::write(path, &text).map_err(|e| Malformed::new("-o", &format!("{}: {e}", path.display())))?;
        }
        Ok(text)
    });
    match result {
        Ok(text) => {
            println!("{text}");
            ExitCode::SUCCESS
        }
        Err(malformed) => {
            eprintln!("{malformed}");
            ExitCode::from(2)
        }
    }
}
