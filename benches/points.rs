//! Nanoseconds per point on this host: the exact engine against the peers that a firmware author would write.
//!
//! One surface for all, the seed patch P: a cubic triangle with an integer net at n = 256, 33 153 points. One sink
//! for all: the wrapping sum of x, y and z of every point. Before anything is timed, every peer's points are compared
//! with the exact ones and the differing points are counted. `cargo bench` ends with a table of the best of many
//! interleaved runs, as ratios to the exact engine.
#![allow(missing_docs, clippy::unwrap_used, clippy::disallowed_types, clippy::float_arithmetic)]

mod peers;

use criterion::{Criterion, Throughput};
use embedded_surfaces::forward::{Lattice, Steps};
use embedded_surfaces::patch::{CubicTriangle, Surface};
use peers::{Cubic, Sink};
use std::hint::black_box;
use std::time::{Duration, Instant};

const N: u32 = 256;

static SEED_P: CubicTriangle = embedded_surfaces::const_net!(CubicTriangle::from_ints(peers::SEED_P));

/// One way to make all points.
struct Row {
    name: &'static str,
    /// The points in any order, to a sink that looks at them.
    check: fn(&Cubic, &mut dyn Sink),
    /// The wrapping sum of all coordinates.
    sum: fn(&Cubic) -> i32,
}

/// The wrapping sum: what all rows are timed with.
#[derive(Default)]
struct Sum(i32);

impl Sink for Sum {
    #[inline(always)]
    fn point(&mut self, _: u32, _: u32, x: i32, y: i32, z: i32) {
        self.0 = self.0.wrapping_add(x.wrapping_add(y).wrapping_add(z));
    }
}

/// Points by (i, j), for the comparison before the timing.
struct Grid(Vec<Option<[i32; 3]>>);

impl Sink for Grid {
    fn point(&mut self, i: u32, j: u32, x: i32, y: i32, z: i32) {
        let before = self.0[(j * (N + 1) + i) as usize].replace([x, y, z]);
        assert_eq!(before, None, "the point ({i}, {j}) came twice");
    }
}

/// The library's internal iteration.
fn exact<S: Sink + ?Sized>(_: &Cubic, sink: &mut S) {
    let lattice = Lattice::new(black_box(&SEED_P).surface(), Steps::uniform(N).unwrap()).unwrap();
    lattice.for_each(|p| sink.point(p.i, p.j, p.x, p.y, p.z));
}

/// The library's iterator in a `for` loop.
fn exact_iterator<S: Sink + ?Sized>(_: &Cubic, sink: &mut S) {
    let lattice = Lattice::new(black_box(&SEED_P).surface(), Steps::uniform(N).unwrap()).unwrap();
    for p in &lattice {
        sink.point(p.i, p.j, p.x, p.y, p.z);
    }
}

macro_rules! rows {
    ($($name:literal: $f:expr),+ $(,)?) => {
        [$(Row {
            name: $name,
            check: |cubic, mut sink| $f(cubic, &mut sink),
            sum: |cubic| { let mut sum = Sum::default(); $f(black_box(cubic), &mut sum); sum.0 },
        }),+]
    };
}

const ROWS: [Row; 11] = rows! {
    "exact, for_each": exact,
    "exact, iterator": exact_iterator,
    "f32 forward differences, row order, arrays": peers::forward_f32::<4, _>,
    "f32 forward differences, row order, by hand": peers::forward_f32_by_hand,
    "f32 forward differences, 4 rows in lockstep": peers::forward_f32_rows::<4, _>,
    "f32 forward differences, 8 rows in lockstep": peers::forward_f32_rows::<8, _>,
    "f32 forward differences, 4 points of a row in lockstep": peers::forward_f32_lanes::<4, _>,
    "f32 forward differences, 8 points of a row in lockstep": peers::forward_f32_lanes::<8, _>,
    "I16F16 Horner": peers::horner_fixed,
    "I16F16 de Casteljau": peers::de_casteljau_fixed,
    "f32 de Casteljau": peers::de_casteljau_f32::<8, _>,
};

/// Points of a row that differ from the exact ones.
fn differing(row: &Row, cubic: &Cubic, exact: &Grid) -> usize {
    let mut grid = Grid(vec![None; exact.0.len()]);
    (row.check)(cubic, &mut grid);
    grid.0.iter().zip(&exact.0).filter(|(a, b)| a != b).count()
}

fn bench(c: &mut Criterion, cubic: &Cubic, points: u64) {
    let mut group = c.benchmark_group("points");
    group.throughput(Throughput::Elements(points)).warm_up_time(Duration::from_millis(500));
    group.measurement_time(Duration::from_secs(2));
    for row in &ROWS {
        group.bench_function(row.name, |b| b.iter(|| (row.sum)(cubic)));
    }
    group.finish();
}

/// The best of many runs of each row in nanoseconds per point, taken in turns so that all meet the same noise.
fn best(cubic: &Cubic, points: f64) -> [f64; ROWS.len()] {
    let mut best = [f64::INFINITY; ROWS.len()];
    for _ in 0..400 {
        for (best, row) in best.iter_mut().zip(&ROWS) {
            let start = Instant::now();
            black_box((row.sum)(cubic));
            *best = best.min(start.elapsed().as_secs_f64() * 1e9 / points);
        }
    }
    best
}

fn main() {
    let cubic = Cubic::new(peers::SEED_P, N);
    let mut grid = Grid(vec![None; ((N + 1) * (N + 1)) as usize]);
    exact(&cubic, &mut grid);
    let points = grid.0.iter().flatten().count() as u64;
    assert_eq!(points, 33_153);
    let wrong = ROWS.map(|row| {
        let wrong = differing(&row, &cubic, &grid);
        assert!(wrong <= 20, "{}: {wrong} points differ", row.name);
        wrong
    });
    let mut criterion = Criterion::default().configure_from_args();
    bench(&mut criterion, &cubic, points);
    criterion.final_summary();
    if !std::env::args().any(|argument| argument == "--bench") {
        return;
    }
    let best = best(&cubic, points as f64);
    println!("{:<56} {:>8} {:>8} {:>8}", "seed patch P, n = 256", "ns/point", "ratio", "differ");
    for ((row, ns), wrong) in ROWS.iter().zip(best).zip(wrong) {
        println!("{:<56} {ns:>8.3} {:>8.2} {wrong:>8}", row.name, ns / best[0]);
    }
}
