//! The pixels of pieces are those of the exact lattices of the point engine.
#![allow(clippy::unwrap_used, clippy::panic)]

use super::super::brush::Shading;
use super::super::depth::DepthWindow;
use super::super::light::{Light, Side};
use super::super::pen::{Ink, Seen, Stain};
use super::super::style::Style;
use super::super::tile::Area;
use super::{Piece, Target};
use crate::forward::{Lattice, PieceSlopes, Steps};
use crate::geometry::Point3;
use crate::patch::{SurfaceNet, TensorNet};
use proptest::prelude::*;
use std::collections::BTreeSet;
use std::vec;
use std::vec::Vec;

type Pixels = BTreeSet<(i32, i32)>;

struct Record(Pixels);

impl Stain for Record {
    fn stain(&mut self, _: usize, [x, y]: [i32; 2], _: u8) {
        self.0.insert((x, y));
    }

    fn stain_all(&mut self, area: &Area, points: &Seen<'_>) {
        points.each(area, |index, at, shade| self.stain(index, at, shade));
    }
}

/// The pixels of a net whose z is 0, in an area.
fn drawn(net: SurfaceNet<'_>, steps: (u32, u32), turn: u8, centred: bool, area: Area) -> Pixels {
    let (mut record, mut points) = (Record(Pixels::new()), 0);
    let mut depth = vec![u16::MAX; area.pixels()];
    let shading = Shading { light: &Light::default(), style: Style::Flat, window: DepthWindow::of(0, 0) };
    let mut piece = Piece::blank(net, steps, turn);
    piece.set_up::<true>(PieceSlopes::of(net).steepest(net));
    piece.draw(
        centred,
        &mut Target {
            area,
            depth: &mut depth,
            shading,
            ink: Ink::Fill,
            side: Side::Viewer,
            is_wide: true,
            points: &mut points,
            stain: &mut record,
        },
    );
    record.0
}

/// The same by the point engine.
fn exact(net: SurfaceNet<'_>, (r, s): (u32, u32), centred: bool, area: Area) -> Pixels {
    let doubled = if centred { Steps::new(2 * r, 2 * s) } else { Steps::new(r, s) };
    let lattice = Lattice::new(net, doubled.unwrap()).unwrap();
    let wanted = lattice.points().filter(|p| !centred || (p.i % 2 == 1 && p.j % 2 == 1));
    wanted.map(|p| (p.x, p.y)).filter(|(x, y)| area.index(*x, *y).is_some()).collect()
}

fn net_of(m: usize, h: usize, bits: &[(i32, i32)], drop: u32) -> Vec<Point3> {
    bits[..(m + 1) * (h + 1)].iter().map(|(x, y)| Point3::from_bits(x >> drop << drop, y >> drop << drop, 0)).collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(192))]

    /// Any legal net of degrees 1 to 3, with any number of fraction bits: halves, where rounding is in doubt, are common.
    #[test]
    fn pixels_are_exact(
        m in 1_usize..4, h in 1_usize..4, size in 1_u32..15, drop in 0_u32..17, r in 1_u32..70, s in 1_u32..24,
        bits in proptest::collection::vec((any::<i32>(), any::<i32>()), 16), turn in 0_u8..2, centred: bool,
        x in -40_i32..40, y in -40_i32..40,
    ) {
        let bits: Vec<_> = bits.iter().map(|(x, y)| (x >> (15 - size), y >> (15 - size))).collect();
        let points = net_of(m, h, &bits, drop);
        prop_assume!(points.iter().all(|p| p.x.unsigned_abs() <= 32_767 && p.y.unsigned_abs() <= 32_767));
        let net = SurfaceNet::Tensor(TensorNet::new((m, h), &points).unwrap());
        // Some of it outside.
        let area = Area { x: x - 150, y: y - 150, width: 300, height: 200 };
        let (ours, all) = (drawn(net, (r, s), turn, centred, area), exact(net, (r, s), centred, area));
        prop_assert_eq!(ours, all);
    }
}

/// The longest differences, and a piece without any.
#[test]
fn both_ends_of_the_range() {
    let far = 32_767 << 16;
    let corners = [(-far, -far), (far, far), (far, -far), (-far, far)];
    let wild: Vec<_> = (0..16).map(|k| corners[(k * 7 + k / 4) % 4]).collect();
    for (bits, steps) in [(wild, (61, 33)), (vec![(1 << 15, -(1 << 15)); 16], (3, 2))] {
        let points = net_of(3, 3, &bits, 0);
        let net = SurfaceNet::Tensor(TensorNet::new((3, 3), &points).unwrap());
        for area in
            [Area { x: -32_767, y: -32_767, width: 32_768, height: 400 }, Area { x: -9, y: -9, width: 99, height: 99 }]
        {
            for (turn, centred) in [(0, false), (1, false), (0, true), (1, true)] {
                assert_eq!(drawn(net, steps, turn, centred, area), exact(net, steps, centred, area), "{area:?}");
            }
        }
    }
}

/// Regression: with one step along a row, the third difference of such a row does not fit, though the first one does.
#[test]
fn one_step_is_right() {
    let mut bits = [(0, 0); 16];
    bits[7] = (0, 1 << 15);
    let points = net_of(3, 1, &bits, 0);
    let net = SurfaceNet::Tensor(TensorNet::new((3, 1), &points).unwrap());
    let area = Area { x: -9, y: -9, width: 20, height: 20 };
    assert_eq!(drawn(net, (1, 1), 0, false, area), exact(net, (1, 1), false, area));
}
