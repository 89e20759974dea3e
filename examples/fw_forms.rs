//! The forms of the engine against each other on the board: one by one, in row order, in any order, and the checksum and the
//! visibility buffer, which are assembly with the feature `asm`. A line per lattice; `tests/firmware_forms.rs` compares them
//! with the host's.
//!
//! ```sh
//! cargo run --release --target thumbv6m-none-eabi --features asm --example fw_forms
//! ```
#![cfg_attr(target_os = "none", no_std, no_main)]

#[path = "board/run.rs"]
mod run;

use embedded_surfaces::forward::{Lattice, LatticePoint, Steps, Tags, VisibilityBuffer};
use embedded_surfaces::geometry::Point3;
use embedded_surfaces::patch::{SurfaceNet, TensorNet, TriangleNet};

/// Degrees of a triangle (twice the same) or of a tensor-product net.
const KINDS: [(bool, (usize, usize)); 7] =
    [(true, (1, 1)), (true, (2, 2)), (true, (3, 3)), (true, (5, 5)), (false, (1, 1)), (false, (3, 1)), (false, (3, 3))];

/// Ranges of coordinates: what 9 bits hold without a sign, with negative ones, all that is legal.
const RANGES: [(i32, i32); 3] = [(0, 511), (-511, 511), (-32_767, 32_767)];

/// Fraction bits.
const FRACTIONS: [u32; 3] = [0, 8, 16];

/// Steps in the two directions; triangles take those that are equal.
const STEPS: [(u32, u32); 11] =
    [(1, 1), (2, 2), (3, 3), (8, 8), (16, 16), (32, 32), (33, 33), (64, 64), (65, 65), (16, 64), (128, 32)];

/// Pixels of a picture on a side.
const SIDE: usize = 48;
const SIDE_I32: i32 = SIDE as i32;

/// Ranges of coordinates in a picture: inside of it, to its edges, beyond them.
const PICTURES: [(i32, i32); 3] = [(3, 41), (0, SIDE_I32 - 1), (-9, SIDE_I32 + 5)];

/// Tags that are equal, that count along rows, that go on from row to row, that wrap.
const TAGS: [Tags; 4] = [
    Tags::same(0xbeef),
    Tags { first: 7, by_i: 1, by_j: 0 },
    Tags { first: 0, by_i: 1, by_j: 33 },
    Tags { first: 65_500, by_i: 3, by_j: 65_535 },
];

/// Numbers that look random.
struct Random(u32);

impl Random {
    fn next(&mut self) -> u32 {
        self.0 = self.0.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        self.0 >> 8
    }

    /// Raw bits of a coordinate; often an end of the range.
    fn coordinate(&mut self, (low, high): (i32, i32), fraction: u32) -> i32 {
        match self.next() & 7 {
            0 => low << 16,
            1 => high << 16,
            _ => {
                let whole = low + ((u64::from(self.next()) * u64::from(high.abs_diff(low))) >> 24) as i32;
                (whole << 16) + (((self.next() & 0xffff) >> (16 - fraction)) << (16 - fraction)) as i32
            }
        }
    }
}

impl Random {
    fn net<'r>(
        &mut self,
        room: &'r mut [Point3; 21],
        (triangle, degrees): (bool, (usize, usize)),
        range: (i32, i32),
        fraction: u32,
    ) -> Result<SurfaceNet<'r>, core::fmt::Error> {
        let len = if triangle { (degrees.0 + 1) * (degrees.0 + 2) / 2 } else { (degrees.0 + 1) * (degrees.1 + 1) };
        let points = room.get_mut(..len).ok_or(core::fmt::Error)?;
        for p in &mut *points {
            let [x, y, z] = [(); 3].map(|()| self.coordinate(range, fraction));
            *p = Point3::from_bits(x, y, z);
        }
        if triangle {
            TriangleNet::new(degrees.0, points).map(SurfaceNet::Triangle).map_err(|_| core::fmt::Error)
        } else {
            TensorNet::new(degrees, points).map(SurfaceNet::Tensor).map_err(|_| core::fmt::Error)
        }
    }
}

/// Takes account of a point where the order counts.
fn append(digest: u32, p: LatticePoint) -> u32 {
    let values = [p.i, p.j, p.x as u32, p.y as u32, p.z as u32];
    values.into_iter().fold(digest, |digest, value| digest.wrapping_mul(0x0100_0193).wrapping_add(value).rotate_left(5))
}

/// Takes account of a point where it does not.
fn add(sum: (u32, u32), p: LatticePoint) -> (u32, u32) {
    (sum.0.wrapping_add(1), sum.1.wrapping_add(append(1, p)))
}

/// What all forms agree upon: the points, the digest in row order, the checksum. `None` where they do not.
fn agreed(lattice: &Lattice<'_>) -> Option<(u32, u32, i32)> {
    let (mut digest, mut sum, mut coordinates) = (0, (0, 0), 0_i32);
    // One after the other, not by `fold`.
    for p in lattice.points() {
        digest = append(digest, p);
        sum = add(sum, p);
        coordinates = coordinates.wrapping_add(p.x).wrapping_add(p.y).wrapping_add(p.z);
    }
    let (mut in_rows, mut any) = (0, (0, 0));
    lattice.for_each(|p| in_rows = append(in_rows, p));
    lattice.for_each_unordered(|p| any = add(any, p));
    let folded = lattice.points().fold(0, append);
    let agree = in_rows == digest && folded == digest && any == sum && lattice.checksum() == coordinates;
    agree.then_some((sum.0, digest, coordinates))
}

/// Writes a line per lattice; an error where the forms differ.
pub(crate) fn report(out: &mut impl core::fmt::Write) -> core::fmt::Result {
    let mut random = Random(core::hint::black_box(2026));
    let mut room = [Point3::from_ints(0, 0, 0); 21];
    for (triangle, degrees) in KINDS {
        for range in RANGES {
            for fraction in FRACTIONS {
                let net = random.net(&mut room, (triangle, degrees), range, fraction)?;
                lattices(out, net, random.next())?;
            }
        }
        for range in PICTURES {
            for (fraction, steps) in [(0, 16), (0, 256), (4, 64), (16, 33)] {
                let net = random.net(&mut room, (triangle, degrees), range, fraction)?;
                picture(out, net, steps, *TAGS.get(random.next() as usize & 3).ok_or(core::fmt::Error)?)?;
            }
        }
    }
    Ok(())
}

/// Writes the lines of a net; of the finer lattices one, chosen by `pick`.
fn lattices(out: &mut impl core::fmt::Write, net: SurfaceNet<'_>, pick: u32) -> core::fmt::Result {
    for (k, (r, s)) in (0_u32..).zip(STEPS) {
        if net.is_triangle() && r != s || k >= 5 && pick % 6 != k - 5 {
            continue;
        }
        let steps = Steps::new(r, s).map_err(|_| core::fmt::Error)?;
        let lattice = Lattice::new(net, steps).map_err(|_| core::fmt::Error)?;
        let Some((count, digest, sum)) = agreed(&lattice) else {
            writeln!(out, "{:?} {r} x {s}: the forms differ", net.degrees())?;
            return Err(core::fmt::Error);
        };
        writeln!(out, "{:?} {r} x {s}: {count} points, digest {digest:08x}, sum {sum}", net.degrees())?;
    }
    Ok(())
}

/// Writes the line of a picture; an error where it is not that of the points one by one, or the forms differ on many steps.
fn picture(out: &mut impl core::fmt::Write, net: SurfaceNet<'_>, n: u32, tags: Tags) -> core::fmt::Result {
    let lattice = Steps::uniform(n).ok().and_then(|steps| Lattice::new(net, steps).ok()).ok_or(core::fmt::Error)?;
    if n == 256 && net.is_triangle() && agreed(&lattice).is_none() {
        writeln!(out, "{:?} {n} x {n}: the forms differ", net.degrees())?;
        return Err(core::fmt::Error);
    }
    let mut expected = [VisibilityBuffer::EMPTY; SIDE * SIDE];
    for p in lattice.points() {
        if let (0..SIDE_I32, 0..SIDE_I32) = (p.x, p.y)
            && let Some(entry) = expected.get_mut(p.y as usize * SIDE + p.x as usize)
        {
            *entry = (*entry).min(((p.z + (1 << 15)) as u32) << 16 | u32::from(tags.at(p.i, p.j)));
        }
    }
    let mut entries = [0; SIDE * SIDE];
    let mut picture = VisibilityBuffer::new(&mut entries, SIDE as u32, SIDE as u32).map_err(|_| core::fmt::Error)?;
    picture.clear();
    picture.draw(&lattice, tags);
    // Nothing is nearer a second time.
    picture.draw(&lattice, tags);
    let (seen, digest) = entries.iter().fold((0, 0_u32), |(seen, digest), entry| {
        let digest = digest.wrapping_mul(0x0100_0193).wrapping_add(*entry).rotate_left(5);
        (seen + u32::from(*entry != VisibilityBuffer::EMPTY), digest)
    });
    writeln!(out, "{:?} {n} x {n}, a picture: {seen} pixels, digest {digest:08x}", net.degrees())?;
    if entries == expected { Ok(()) } else { Err(core::fmt::Error) }
}

#[cfg(not(target_os = "none"))]
fn main() {
    run::on_host();
}
