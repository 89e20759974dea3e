//! Pairs that meet in straight lines of the parameters: B is A plus a product of linear forms, so that the number of curves,
//! branches and curves of contact follows from the lines alone.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]
#![allow(clippy::disallowed_types, clippy::float_arithmetic, reason = "an oracle in f64")]

#[path = "common/meeting.rs"]
#[allow(dead_code)]
mod meeting;

use embedded_surfaces::geometry::Point3;
use embedded_surfaces::intersect::{CurveKind, End, Options};
use meeting::{Meeting, Patch};

/// The domain of both patches is the square −96 ..= 96.
const HALF: i128 = 96;

/// a·x + b·y + c = 0.
type Line = [i128; 3];

/// A sequence of numbers without a pattern.
struct Numbers(u64);

impl Numbers {
    fn next(&mut self, low: i128, high: i128) -> i128 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        low + i128::from(self.0 >> 33) % (high - low + 1)
    }

    fn line(&mut self) -> Line {
        loop {
            let line = [self.next(-3, 3), self.next(-3, 3), self.next(-60, 60)];
            if line[..2] != [0, 0] {
                return line;
            }
        }
    }
}

/// The coefficients of u^a v^b of a product of linear forms over the unit square.
fn product(lines: &[Line]) -> [[i128; 4]; 4] {
    let mut all = [[0; 4]; 4];
    all[0][0] = 1;
    for [a, b, c] in lines {
        let (along, across, rest) = (2 * HALF * a, 2 * HALF * b, c - HALF * (a + b));
        let old = all;
        for i in 0..4 {
            for j in 0..4 {
                let left = if i > 0 { old[i - 1][j] } else { 0 };
                let below = if j > 0 { old[i][j - 1] } else { 0 };
                all[i][j] = along * left + across * below + rest * old[i][j];
            }
        }
    }
    all
}

/// Nine times the bicubic control ordinates.
fn ordinates(lines: &[Line]) -> [i128; 16] {
    const BINOMIAL: [[i128; 4]; 4] = [[1, 0, 0, 0], [1, 1, 0, 0], [1, 2, 1, 0], [1, 3, 3, 1]];
    let power = product(lines);
    core::array::from_fn(|k| {
        let pairs = (0..=k / 4).flat_map(|a| (0..=k % 4).map(move |b| (a, b)));
        let term = |(a, b): (usize, usize)| {
            9 * power[a][b] * BINOMIAL[k / 4][a] * BINOMIAL[k % 4][b] / (BINOMIAL[3][a] * BINOMIAL[3][b])
        };
        pairs.map(term).sum()
    })
}

/// A and B over the same square; `None` if B's ordinates are out of range.
fn pair(lines: &[Line], numbers: &mut Numbers) -> Option<[Patch; 2]> {
    let raised = ordinates(lines);
    let most = raised.iter().map(|z| z.abs()).max()?;
    // At most 512 units with sixteen fraction bits, exactly.
    let shift = (0..=16).find(|shift| most >> shift <= 512)?;
    let base: [i128; 16] = core::array::from_fn(|_| numbers.next(-200, 200) << 16);
    // A map of space that keeps the lattice.
    let [p, q, r] = [numbers.next(-1, 1), numbers.next(-1, 1), numbers.next(-1, 1)];
    let patch = |heights: [i128; 16]| {
        let points = heights.iter().enumerate().map(|(k, z)| {
            let (x, y) = ((64 * (k as i128 / 4) - HALF) << 16, (64 * (k as i128 % 4) - HALF) << 16);
            let y = y + p * x;
            let (x, z) = (x + q * z, z + r * y);
            Point3::from_bits(x as i32, y as i32, z as i32)
        });
        Patch { triangle: false, degrees: (3, 3), points: points.collect(), weights: None }
    };
    Some([patch(base), patch(core::array::from_fn(|k| base[k] + (raised[k] << (16 - shift))))])
}

/// The crossing of two lines as [x, y] over a positive denominator.
fn crossing(p: &Line, q: &Line) -> Option<([i128; 2], i128)> {
    let d = p[0] * q[1] - q[0] * p[1];
    let at = [q[2] * p[1] - p[2] * q[1], p[2] * q[0] - q[2] * p[0]];
    (d != 0).then(|| (at.map(|c| c * d.signum()), d.abs()))
}

/// How the corners lie about a line: none on it, and whether it cuts the square.
fn cuts(line: &Line) -> Option<bool> {
    let corners = [(-HALF, -HALF), (-HALF, HALF), (HALF, -HALF), (HALF, HALF)];
    let sides = corners.map(|(x, y)| line[0] * x + line[1] * y + line[2]);
    let beside = sides.iter().all(|s| *s > 0) || sides.iter().all(|s| *s < 0);
    sides.iter().all(|s| *s != 0).then_some(!beside)
}

/// Curves and branches of lines in the square; `None` if they meet on its border, or three in one point.
fn arrangement(lines: &[Line]) -> Option<(usize, usize)> {
    let mut points = Vec::new();
    let mut curves = 0;
    for (k, line) in lines.iter().enumerate() {
        curves += usize::from(cuts(line)?);
        for other in &lines[..k] {
            let Some((at, d)) = crossing(line, other) else {
                let same = line[0] * other[2] == line[2] * other[0] && line[1] * other[2] == line[2] * other[1];
                if same {
                    return None;
                }
                continue;
            };
            let far = at.map(|c| c.abs()).into_iter().max()? - HALF * d;
            if far == 0 {
                return None;
            }
            if far < 0 {
                if points.iter().any(|(p, e): &([i128; 2], i128)| (0..2).all(|k| p[k] * d == at[k] * e)) {
                    return None;
                }
                points.push((at, d));
                curves += 2;
            }
        }
    }
    Some((curves, points.len()))
}

/// Lines cross in branches however near each other, and arms end in them.
#[test]
fn branches_of_two_and_three_lines() {
    let mut numbers = Numbers(7);
    let mut tried = [0; 4];
    while tried[2] < 8 || tried[3] < 8 {
        let count = 2 + usize::from(numbers.next(0, 9) > 0);
        let lines: Vec<Line> = (0..count).map(|_| numbers.line()).collect();
        let (Some((curves, branches)), Some([a, b])) = (arrangement(&lines), pair(&lines, &mut numbers)) else {
            continue;
        };
        tried[count] += 1;
        let found = Meeting::new(&a, &b, &Options::DEFAULT).unwrap();
        assert_eq!(found.kinds(), vec!["open_curve"; curves], "{lines:?}");
        assert_eq!(found.branches.len(), branches, "{lines:?}");
        assert!(found.branches.iter().all(|b| b.arms() == 4), "{lines:?}");
        assert!(branches == 0 || !found.certified, "{lines:?}");
    }
}

/// The square of one form: the surfaces touch along a line.
#[test]
fn tangential_lines() {
    let mut numbers = Numbers(11);
    let mut tried = 0;
    while tried < 8 {
        let line = numbers.line();
        let (Some(inside), Some([a, b])) = (cuts(&line), pair(&[line, line], &mut numbers)) else { continue };
        tried += 1;
        let found = Meeting::new(&a, &b, &Options::DEFAULT).unwrap();
        assert_eq!(found.kinds(), vec!["tangential_curve"; usize::from(inside)], "{line:?}");
        assert!(found.branches.is_empty() && (!inside || !found.certified), "{line:?}");
    }
}

/// An edge that both patches share, and a line that may cross it: the edge is one component, the line ends on it.
#[test]
fn shared_edges_with_a_line_across() {
    let mut numbers = Numbers(13);
    let mut tried = 0;
    while tried < 12 {
        let line = numbers.line();
        let edge = [1, 0, HALF];
        let Some([a, b]) = cuts(&line).and_then(|_| pair(&[edge, line], &mut numbers)) else { continue };
        tried += 1;
        let found = Meeting::new(&a, &b, &Options::DEFAULT).unwrap();
        let inside = usize::from(cuts(&line) == Some(true));
        let mut kinds = vec!["open_curve"; inside];
        kinds.push("shared_edge");
        assert_eq!(found.kinds(), kinds, "{line:?}");
        for (curve, _) in &found.curves {
            let lost = |end: &End| matches!(end, End::Lost | End::None | End::Branch { .. });
            assert!(curve.kind != CurveKind::Open || !curve.ends.iter().any(lost), "{line:?}: {:?}", curve.ends);
        }
    }
}
