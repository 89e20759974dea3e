//! Pairs of patches that meet in curves of different kinds: c01, c04 and c12 of the reference cases.

#[path = "nets.rs"]
mod nets;

use embedded_surfaces::const_net;
use embedded_surfaces::patch::{BicubicPatch, CubicTriangle, Surface, SurfaceNet};

static LOW_WAVE: BicubicPatch = const_net!(BicubicPatch::from_ints([
    [[-291, -314, -5], [-283, -108, 101], [-280, 114, 23], [-270, 323, 99]],
    [[-83, -289, 116], [-71, -97, 79], [-129, 123, -1], [-101, 319, -5]],
    [[130, -315, 10], [111, -127, 98], [127, 80, 30], [77, 293, -72]],
    [[300, -275, -73], [285, -106, 85], [304, 76, 11], [306, 285, 1]],
]));
static WALL: BicubicPatch = const_net!(BicubicPatch::from_ints([
    [[-10, -343, -286], [-37, -357, -82], [51, -340, 117], [-54, -342, 280]],
    [[50, -124, -285], [-11, -128, -90], [68, -105, 110], [31, -100, 289]],
    [[-11, 140, -311], [63, 124, -120], [-54, 110, 117], [-60, 119, 281]],
    [[-2, 370, -282], [29, 367, -95], [43, 348, 103], [-46, 342, 288]],
]));
static HIGH_WAVE: BicubicPatch = const_net!(BicubicPatch::from_ints([
    [[-300, -307, -120], [-294, -99, -100], [-294, 96, -110], [-311, 297, -130]],
    [[-115, -304, 160], [-100, -107, 420], [-95, 110, 380], [-101, 307, 150]],
    [[112, -296, -330], [92, -98, -360], [85, 106, -340], [104, 289, -320]],
    [[299, -304, 200], [290, -105, 260], [313, 91, 240], [286, 303, 220]],
]));
static LEVEL: BicubicPatch = const_net!(BicubicPatch::from_ints([
    [[-327, -336, 48], [-314, -106, 50], [-314, 100, 52], [-308, 323, 46]],
    [[-120, -325, 50], [-118, -114, 44], [-121, 102, 47], [-118, 315, 52]],
    [[108, -340, 46], [89, -133, 52], [102, 102, 50], [91, 318, 49]],
    [[304, -345, 52], [308, -131, 48], [321, 96, 50], [314, 295, 46]],
]));
static LEAF: CubicTriangle = const_net!(CubicTriangle::from_ints(nets::SEED_P));
static SHEET: BicubicPatch = const_net!(BicubicPatch::from_ints([
    [[5, -25, 190], [7, 96, 200], [0, 219, 210], [0, 330, 200]],
    [[125, -19, 205], [121, 92, 215], [122, 224, 200], [120, 335, 195]],
    [[240, -10, 200], [230, 106, 190], [232, 230, 210], [235, 340, 205]],
    [[350, -17, 210], [354, 94, 200], [362, 219, 195], [359, 340, 190]],
]));

/// Two patches and what to intersect them with.
pub(crate) struct Pair {
    pub(crate) name: &'static str,
    pub(crate) nets: [SurfaceNet<'static>; 2],
    /// Pieces are within 2^-this unit.
    pub(crate) tolerance: u32,
}

/// The number of pairs.
pub(crate) const COUNT: usize = 3;

/// A curve; a curve and a loop; a triangle. With the tolerances with which some 130 points are enough.
pub(crate) fn pairs() -> [Pair; COUNT] {
    let pair = |name, nets, tolerance| Pair { name, nets, tolerance };
    [
        pair("two bicubic patches", [LOW_WAVE.surface(), WALL.surface()], 21),
        pair("two bicubic patches, a loop", [HIGH_WAVE.surface(), LEVEL.surface()], 14),
        pair("a cubic triangle and a bicubic patch", [LEAF.surface(), SHEET.surface()], 18),
    ]
}
