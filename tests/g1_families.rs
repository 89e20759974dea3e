//! Random meshes of all families: solved, smooth, without gaps.
//!
//! 150 meshes and 12 places an edge; `G1_MESHES` and `G1_SAMPLES` ask for others.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]
#![allow(clippy::disallowed_types, clippy::float_arithmetic, clippy::float_cmp, reason = "an oracle in f64")]

#[path = "common/families.rs"]
mod families;
#[path = "common/skin.rs"]
mod skin;

use skin::{Refusal, Seam, rounded};

fn number(name: &str, default: usize) -> usize {
    std::env::var(name).ok().and_then(|text| text.parse().ok()).unwrap_or(default)
}

#[test]
fn random_meshes_are_smooth_or_refused_for_a_reason() {
    let (meshes, samples) = (number("G1_MESHES", 150), number("G1_SAMPLES", 12));
    let (mut refused, mut folded, mut pinches, mut worst) = (0, 0, 0, [0.0_f64; 3]);
    for (k, (family, skin)) in families::all(20, meshes).into_iter().enumerate() {
        let (skin, _) = skin.scaled();
        let solution = match skin.smooth() {
            Ok(solution) => solution,
            Err(refusal @ Refusal::Mesh(_)) => {
                println!("mesh {k}, {family}: {refusal:?}");
                refused += 1;
                continue;
            }
            Err(refusal) => panic!("mesh {k}, {family}: {refusal:?}"),
        };
        folded += usize::from(solution.quality.folded > 0);
        let shortest = skin.shortest_edge();
        let limits = [(100.0 * 2_f64.powi(-32) / shortest).max(5e-9), 100.0 * 2_f64.powi(-16) / shortest];
        let coarse = rounded(&solution.nets);
        for seam in skin.seams() {
            let exact = Seam::of(&solution.nets, seam);
            assert!(exact.closed, "mesh {k}, {family}: a gap");
            let mut parts = [
                exact.angle(samples) / limits[0],
                Seam::of(&coarse, seam).angle(samples) / limits[1],
                exact.residual(32) / 4.0,
            ];
            // Where a normal almost vanishes, as at folds, rounding turns what is left of it.
            for (part, least) in parts.iter_mut().zip([0.001, 0.05]) {
                let pinch = if *part > 1.0 { exact.pinch(samples) } else { 1.0 };
                if pinch < least {
                    println!(
                        "mesh {k}, {family}: {part:.1} of what is allowed where a normal is {pinch:.1e} of others"
                    );
                    (pinches, *part) = (pinches + 1, 0.0);
                }
            }
            for (worst, part) in worst.iter_mut().zip(parts) {
                assert!(part <= 1.0, "mesh {k}, {family}: {parts:?} of what is allowed");
                *worst = worst.max(part);
            }
        }
    }
    println!("{meshes} meshes, {refused} refused, {folded} with folds, at most {worst:?} of what is allowed");
    assert!(pinches * 20 <= meshes, "{pinches} edges of {meshes} meshes");
    assert!(refused * 50 <= meshes, "{refused} of {meshes} meshes were refused");
}
