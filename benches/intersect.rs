//! Milliseconds to intersect pairs of the reference cases (c01, c04, c12): all points refined, the result certified.
#![allow(missing_docs, clippy::unwrap_used)]

#[path = "../examples/data/pairs.rs"]
#[allow(dead_code, reason = "tolerances and their number are the firmware's")]
mod pairs;
#[path = "../examples/data/workspace.rs"]
mod workspace;

use criterion::Criterion;
use embedded_surfaces::intersect::{Options, Room, intersect};
use std::hint::black_box;
use workspace::Workspace;

fn main() {
    let mut criterion = Criterion::default().configure_from_args();
    for pair in pairs::pairs() {
        for depth in [5, 6] {
            let options = Options::DEFAULT.with_depth(depth);
            let [a, b] = pair.nets;
            let room = Room::new(a, b, depth).unwrap();
            let mut workspace = Workspace::new(&room, 2000, 1000, 9);
            criterion.bench_function(&format!("{}, depth {depth}", pair.name), |bencher| {
                bencher.iter(|| {
                    let [a, b] = black_box(pair.nets);
                    let found = intersect(a, b, &options, workspace.buffers()).unwrap();
                    assert!(found.is_certified() && found.curves().iter().all(|curve| curve.unrefined == 0));
                });
            });
        }
    }
    criterion.final_summary();
}
