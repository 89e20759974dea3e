//! Dual descent: pairs of grid nodes whose boxes meet, down to pairs of triangles that cross.

use super::grid::{Grid, GridBox, GridVertex};
use super::key::{Cell, Crossing, KEY_BITS};
use super::predicate::{Perturbation, height as height_over, is_degenerate, normal};
use super::sheet::Place;
use super::vector::V3;
use super::{IntersectError, MAX_DEPTH};
use crate::num::Real;

/// Each of the 2m splits leaves three siblings.
const STACK: usize = 6 * MAX_DEPTH as usize + 1;

/// A segment has two crossings: half of the numbers below this.
const ID_BITS: u32 = 64 - KEY_BITS;

/// A node of a grid's quadtree.
#[derive(Clone, Copy, Debug)]
struct Node {
    level: u8,
    i: u8,
    j: u8,
}

/// What a descent found beside its segments.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Found {
    pub(super) segments: usize,
    pub(super) zeros: u32,
    pub(super) degenerate: u32,
    /// Pairs of nodes looked at.
    pub(super) visited: u32,
}

fn meet(a: &GridBox, b: &GridBox) -> bool {
    (0..3).all(|k| a[0][k] <= b[1][k] && b[0][k] <= a[1][k])
}

/// Entry k of three.
fn corner<T: Copy>([a, b, c]: &[T; 3], k: usize) -> T {
    match k {
        0 => *a,
        1 => *b,
        _ => *c,
    }
}

fn longest(bounds: &GridBox) -> i64 {
    (0..3).fold(0, |l, k| l.max(i64::from(bounds[1][k]) - i64::from(bounds[0][k])))
}

/// Writes two records a segment, key and number, to `records`; at most `budget` pairs of nodes.
#[inline(never)]
pub(super) fn descend(
    grids: [&Grid<'_>; 2],
    positive: bool,
    budget: u32,
    records: &mut [u64],
) -> Result<Found, IntersectError> {
    let mut found = Found::default();
    let mut perturbation = Perturbation { positive, zeros: 0 };
    let root = Node { level: 0, i: 0, j: 0 };
    let mut stack = [[root; 2]; STACK];
    let mut height = 1;
    while height > 0 {
        height -= 1;
        let Some(pair) = stack.get(height).copied() else { return Err(IntersectError::Internal) };
        found.visited += 1;
        if found.visited > budget {
            return Err(IntersectError::PairBudget { visited: budget, level: pair[0].level.max(pair[1].level) });
        }
        let boxes = both!(|s| grids[s].bounds(pair[s].level.into(), pair[s].i.into(), pair[s].j.into()));
        if !meet(&boxes[0], &boxes[1]) {
            continue;
        }
        let leaf = both!(|s| u32::from(pair[s].level) == grids[s].depth);
        if leaf[0] && leaf[1] {
            cells(grids, pair, &mut perturbation, &mut found, records)?;
            continue;
        }
        let split = usize::from(leaf[0] || (!leaf[1] && longest(&boxes[1]) > longest(&boxes[0]))) & 1;
        let Node { level, i, j } = pair[split];
        for (di, dj) in [(1, 1), (1, 0), (0, 1), (0, 0)] {
            let child = Node { level: level + 1, i: 2 * i + di, j: 2 * j + dj };
            if grids[split].exists(child.level.into(), child.i.into(), child.j.into()) {
                let Some(place) = stack.get_mut(height) else { return Err(IntersectError::Internal) };
                *place = pair;
                place[split] = child;
                height += 1;
            }
        }
    }
    found.zeros = perturbation.zeros;
    Ok(found)
}

/// A triangle of a grid with its corners.
#[derive(Clone, Copy)]
struct Facet {
    cell: Cell,
    corners: [GridVertex; 3],
    normal: [i128; 3],
}

/// A triangle of a cell, unless the domain ends before it or it has no normal.
#[inline(always)]
fn facet(grid: &Grid<'_>, node: Node, upper: bool, found: &mut Found) -> Option<Facet> {
    if upper && !grid.has_upper(node.i.into(), node.j.into()) {
        return None;
    }
    let cell = Cell { i: node.i, j: node.j, upper };
    let places = cell.corners();
    let corners = three!(|k| grid.vertex(places[k].0, places[k].1));
    let normal = normal(corners);
    if is_degenerate(&normal) {
        found.degenerate = found.degenerate.saturating_add(1);
        return None;
    }
    Some(Facet { cell, corners, normal })
}

/// The signs of a triangle's corners over another's plane.
#[inline(always)]
fn signs(perturbation: &mut Perturbation, f: &Facet, g: &Facet, of_a: bool) -> [bool; 3] {
    three!(|k| perturbation.side(&g.normal, g.corners[0], f.corners[k], of_a))
}

/// The pairs of triangles of two cells.
fn cells(
    grids: [&Grid<'_>; 2],
    pair: [Node; 2],
    perturbation: &mut Perturbation,
    found: &mut Found,
    records: &mut [u64],
) -> Result<(), IntersectError> {
    let [of_a, of_b] = both!(|s| both!(|k| facet(grids[s], pair[s], k == 1, found)));
    for a in of_a.iter().flatten() {
        for b in of_b.iter().flatten() {
            let mut crossings = [None; 2];
            let mut count = 0;
            let a_signs = signs(perturbation, a, b, true);
            if a_signs == [a_signs[0]; 3] {
                continue;
            }
            let b_signs = signs(perturbation, b, a, false);
            if b_signs == [b_signs[0]; 3] {
                continue;
            }
            for (side, f, g, signs) in [(0, a, b, a_signs), (1, b, a, b_signs)] {
                for (edge, [p, q]) in f.cell.edges() {
                    if corner(&signs, p) == corner(&signs, q) {
                        continue;
                    }
                    if perturbation.crosses([corner(&f.corners, p), corner(&f.corners, q)], g.corners, side == 0) {
                        let Some(place) = crossings.get_mut(count) else { return Err(IntersectError::Internal) };
                        *place = Some(Crossing { side, edge, cell: g.cell });
                        count += 1;
                    }
                }
            }
            match crossings {
                [None, None] => {}
                [Some(first), Some(second)] => {
                    let given = records.len() / 2;
                    let number = found.segments as u64;
                    let places = records.get_mut(2 * found.segments..2 * found.segments + 2);
                    let Some([one, two]) = places else {
                        return Err(IntersectError::SegmentBuffer { given, visited: found.visited });
                    };
                    if number >> (ID_BITS - 1) != 0 {
                        return Err(IntersectError::Internal);
                    }
                    *one = (first.pack() << ID_BITS) | (2 * number);
                    *two = (second.pack() << ID_BITS) | (2 * number + 1);
                    found.segments += 1;
                }
                _ => return Err(IntersectError::Internal),
            }
        }
    }
    Ok(())
}

/// The key of a record.
pub(super) const fn key(record: u64) -> u64 {
    record >> ID_BITS
}

/// The number of a record: twice its segment, plus one for the second end.
pub(super) const fn number(record: u64) -> usize {
    (record & ((1 << ID_BITS) - 1)) as usize
}

/// Where a segment meets the plane of a triangle: its share of the segment, and the weights of the second and third corner,
/// all within 0 ..= 1.
pub(super) fn meeting([p, q]: [GridVertex; 2], [a, b, c]: [GridVertex; 3], exact: &[i128; 3]) -> (Real, [Real; 2]) {
    let clamp = |r: Real| r.max(Real::ZERO).min(Real::ONE);
    let [from, to] = [p, q].map(|x| Real::wide(height_over(exact, a, x), 0));
    let share = if from == to { Real::power(-1) } else { clamp(from / (from - to)) };
    let vector = |x: GridVertex| V3::bits(x.map(i64::from), -16);
    let x = vector(p) + (vector(q) - vector(p)) * share - vector(a);
    let n = V3(exact.map(|c| Real::wide(c, -32)));
    let inverse = Real::ONE / n.square();
    let (ab, ac) = (vector(b) - vector(a), vector(c) - vector(a));
    (share, [clamp(x.cross(ac).dot(n) * inverse), clamp(ab.cross(x).dot(n) * inverse)])
}

/// The place on a patch of the point of a grid's triangle with these weights of its second and third corner.
pub(super) fn place_in(grid: &Grid<'_>, cell: Cell, [beta, gamma]: [Real; 2]) -> Place {
    let [a, b, c] = cell.corners().map(|(i, j)| [i, j].map(|k| (k as i64) << (48 - grid.depth)));
    let mix = |from: i64, to: i64, share: Real| (Real::new(to - from, -48) * share).nearest(48);
    let [u, v] = both!(|k| a[k] + mix(a[k], b[k], beta) + mix(a[k], c[k], gamma));
    [u, v]
}
