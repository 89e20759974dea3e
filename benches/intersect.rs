//! Milliseconds to intersect two bicubic patches that cross in one curve, all points refined and the result certified.
#![allow(missing_docs, clippy::unwrap_used)]

#[path = "../examples/data/workspace.rs"]
mod workspace;

use criterion::Criterion;
use embedded_surfaces::intersect::{Options, Room, intersect};
use embedded_surfaces::patch::{BicubicPatch, Surface};
use std::hint::black_box;
use workspace::Workspace;

static WAVE: BicubicPatch = embedded_surfaces::const_net!(BicubicPatch::from_ints([
    [[-300, -300, 10], [-300, -100, 60], [-300, 100, -40], [-300, 300, 20]],
    [[-100, -300, -30], [-100, -100, 90], [-100, 100, 50], [-100, 300, -60]],
    [[100, -300, 40], [100, -100, -70], [100, 100, 80], [100, 300, 30]],
    [[300, -300, -20], [300, -100, 30], [300, 100, -50], [300, 300, 10]],
]));
static WALL: BicubicPatch = embedded_surfaces::const_net!(BicubicPatch::from_ints([
    [[-20, -320, -200], [30, -310, -70], [-10, -320, 80], [15, -330, 220]],
    [[20, -110, -210], [-40, -100, -60], [30, -90, 70], [-20, -100, 200]],
    [[-30, 100, -190], [20, 110, -80], [-25, 90, 90], [10, 100, 210]],
    [[10, 320, -200], [-20, 310, -70], [25, 330, 60], [-5, 320, 190]],
]));

fn main() {
    let mut criterion = Criterion::default().configure_from_args();
    for depth in [5, 6] {
        let options = Options::DEFAULT.with_depth(depth);
        let room = Room::new(WAVE.surface(), WALL.surface(), depth).unwrap();
        let mut workspace = Workspace::new(&room, 2000, 1000, 9);
        criterion.bench_function(&format!("two bicubic patches, depth {depth}"), |bencher| {
            bencher.iter(|| {
                let [a, b] = [black_box(&WAVE).surface(), black_box(&WALL).surface()];
                let found = intersect(a, b, &options, workspace.buffers()).unwrap();
                assert!(found.curves().len() == 1 && found.is_certified());
            });
        });
    }
    criterion.final_summary();
}
