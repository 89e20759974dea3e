//! Curves in the plane: pictures a person can read, both ends of every range, typed errors.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

#[path = "common/stroke.rs"]
mod stroke;

use embedded_graphics::mock_display::MockDisplay;
use embedded_graphics::pixelcolor::BinaryColor;
use embedded_graphics::prelude::*;
use embedded_graphics::primitives::{PointsIter, Rectangle};
use embedded_surfaces::forward::LatticeError;
use embedded_surfaces::geometry::Point3;
use embedded_surfaces::graphics::{AnyCurveNet, BezierCurve, CurvePixels, MAX_STROKE_WIDTH, Stroke};
use embedded_surfaces::num::I16F16;
use embedded_surfaces::patch::{CubicCurve, Curve, RationalCurve};
use stroke::{curve, drawn, quarter, stroke};

// Pictures.

fn assert_pictures<'a>(curve: impl Into<AnyCurveNet<'a>> + Copy, pictures: &[(u32, &[&str])]) {
    for (width, pattern) in pictures {
        drawn(stroke(curve, *width)).assert_pattern(pattern);
    }
}

#[test]
fn quadratic() {
    assert_pictures(
        &curve([[0, 9], [5, -8], [15, 8]]),
        &[
            (
                1,
                &[
                    "     ####       ",
                    "    ##  ###     ",
                    "   #      ##    ",
                    "  ##       ##   ",
                    "  #         #   ",
                    " ##          #  ",
                    " #            # ",
                    " #            # ",
                    "#              #",
                    "#               ",
                ],
            ),
            (
                3,
                &[
                    "    #######      ",
                    "   #########     ",
                    "  ####  #####    ",
                    " ####     ####   ",
                    " ###       ####  ",
                    "####        ###  ",
                    "###         #### ",
                    "###          ####",
                    "##            ###",
                    "##            ###",
                    "##               ",
                ],
            ),
        ],
    );
}

#[test]
fn cubic() {
    assert_pictures(
        &curve([[1, 14], [2, -9], [18, 25], [19, 2]]),
        &[
            (
                1,
                &[
                    "                    ",
                    "                    ",
                    "                   #",
                    "                   #",
                    "                   #",
                    "                   #",
                    "   ######          #",
                    "  ##    ##        # ",
                    "  #      ###      # ",
                    "  #        ##    ## ",
                    " #          ######  ",
                    " #                  ",
                    " #                  ",
                    " #                  ",
                    " #                  ",
                ],
            ),
            (
                3,
                &[
                    "                     ",
                    "                  ###",
                    "                  ###",
                    "                  ###",
                    "                  ###",
                    "   #####          ###",
                    "  ########        ###",
                    " ###########     ### ",
                    " ###    #####    ### ",
                    " ###     ########### ",
                    "###        ########  ",
                    "###          #####   ",
                    "###                  ",
                    "###                  ",
                    "###                  ",
                    "###                  ",
                ],
            ),
        ],
    );
}

#[test]
fn quintic() {
    assert_pictures(
        &curve([[0, 8], [4, -20], [8, 40], [12, -30], [16, 36], [22, 0]]),
        &[
            (
                1,
                &[
                    "                      #",
                    "  ###                 #",
                    " ## ##                #",
                    " #   ##              # ",
                    " #    ##             # ",
                    "##     ###           # ",
                    "#        ####        # ",
                    "#           ##      ## ",
                    "#            ##     #  ",
                    "              ##   ##  ",
                    "               ### #   ",
                    "                 ###   ",
                ],
            ),
            (
                3,
                &[
                    " ####                ###",
                    " #####               ###",
                    "#######              ###",
                    "### ####            ### ",
                    "###  #####          ### ",
                    "###   #######       ### ",
                    "##     #######      ### ",
                    "##       ######    #### ",
                    "##          #####  ###  ",
                    "##           #########  ",
                    "              #######   ",
                    "               ######   ",
                    "                 ###    ",
                ],
            ),
        ],
    );
}

#[test]
fn rational_quarter_circle() {
    assert_pictures(
        &quarter([[0, 12], [12, 12], [12, 0]]),
        &[
            (
                1,
                &[
                    "            #",
                    "            #",
                    "            #",
                    "            #",
                    "           # ",
                    "           # ",
                    "          ## ",
                    "          #  ",
                    "         #   ",
                    "        #    ",
                    "      ##     ",
                    "    ###      ",
                    "####         ",
                ],
            ),
            (
                3,
                &[
                    "           ###",
                    "           ###",
                    "           ###",
                    "           ###",
                    "          ### ",
                    "          ### ",
                    "         #### ",
                    "        ####  ",
                    "       ####   ",
                    "      #####   ",
                    "    ######    ",
                    "########      ",
                    "#######       ",
                    "####          ",
                ],
            ),
        ],
    );
}

#[test]
fn a_loop_crosses_itself() {
    assert_pictures(
        &curve([[2, 15], [34, -8], [-14, -8], [18, 15]]),
        &[
            (
                1,
                &[
                    "       #     #     ",
                    "      #       #    ",
                    "      ##     ##    ",
                    "       #     #     ",
                    "       #     #     ",
                    "        #   #      ",
                    "        ## ##      ",
                    "         # #       ",
                    "          #        ",
                    "         ###       ",
                    "        #   #      ",
                    "       ##   ##     ",
                    "      #       #    ",
                    "    ##         ##  ",
                    "   ##           ## ",
                    "  ##             ##",
                ],
            ),
            (
                3,
                &[
                    "      ###   ###     ",
                    "     ###     ###    ",
                    "     ####   ####    ",
                    "      ###   ###     ",
                    "      ###   ###     ",
                    "      #### ####     ",
                    "       #######      ",
                    "        #####       ",
                    "        #####       ",
                    "        #####       ",
                    "      #########     ",
                    "     ##### #####    ",
                    "    #####   #####   ",
                    "   #####     #####  ",
                    " #####         #####",
                    " ####           ####",
                    " ###             ###",
                ],
            ),
        ],
    );
}

#[test]
fn what_is_off_the_screen_is_clipped() {
    let cubic = curve([[1, 14], [2, -9], [18, 25], [19, 2]]);
    let mut display = MockDisplay::new();
    stroke(&cubic, 3).translate(Point::new(-3, -7)).draw(&mut display).unwrap();
    display.assert_pattern(&[
        "#########     ###",
        "#    #####    ###",
        "#     ###########",
        "        ######## ",
        "          #####  ",
    ]);
    let mut display = MockDisplay::new();
    stroke(&cubic, 3).translate(Point::new(50, 53)).draw(&mut display).unwrap();
    let corner = Rectangle::new(Point::new(50, 58), Size::new(14, 6));
    assert_eq!(display.affected_area(), corner);
    for far in [Point::new(i32::MAX, 0), Point::new(0, i32::MIN), Point::new(-30, 0), Point::new(0, 64)] {
        let mut display = MockDisplay::new();
        stroke(&cubic, 9).translate(far).translate(far).draw(&mut display).unwrap();
        assert_eq!(display.affected_area(), Rectangle::zero(), "{far}");
    }
}

/// Of two centres at half the width one is drawn, so that even widths are exact too, at every phase.
#[test]
fn axis_parallel_lines_are_exactly_as_thick_as_asked() {
    for (width, phase) in (1..=20).flat_map(|w| [0, 1, 99, 1 << 14, 1 << 15, 40_000, 65_535].map(|p| (w, p))) {
        let at = |x: i32, y: i32| Point3::from_bits(x << 16, (y << 16) + phase, 0);
        let level = Curve::<2>::new([at(20, 30), at(40, 30)]).unwrap();
        let upright = Curve::<2>::new(level.points().map(|p| Point3 { x: p.y, y: p.x, z: p.z })).unwrap();
        let (level, upright) = (stroke(&level, width), stroke(&upright, width));
        let (area, turned) = (drawn(level).affected_area(), drawn(upright).affected_area());
        assert_eq!(area.size.height, width, "phase {phase}");
        assert_eq!((turned.size.width, turned.size.height), (area.size.height, area.size.width));
        if phase == 0 {
            assert_eq!(area.size.width, 20 + width, "round caps, half the width at each end");
            assert_eq!(level.bounding_box(), area, "width {width}");
            assert_eq!(upright.bounding_box(), turned, "width {width}");
        }
    }
}

// Ends of the range.

#[test]
fn z_takes_no_part() {
    let wild = [[0, 0, 32_767], [3, 9, -32_767], [9, 3, 32_767], [12, 12, -32_767]];
    let (wild, flat) = (CubicCurve::from_ints(wild).unwrap(), curve(wild.map(|[x, y, _]| [x, y])));
    let (wild, flat) = (BezierCurve::new(&wild).unwrap(), BezierCurve::new(&flat).unwrap());
    assert_eq!(wild.steps(), 32, "short chords: 16 (m - 1)");
    assert_eq!(wild.steps(), flat.steps());
    assert!(wild.points().eq(flat.points()));
}

#[test]
fn degenerate_curves_are_dots() {
    let dot = curve([[9, 9]; 4]);
    let curve = BezierCurve::new(&dot).unwrap();
    assert_eq!(curve.points().collect::<Vec<_>>(), [Point::new(9, 9)]);
    assert_eq!(curve.points().size_hint(), (1, Some(curve.steps() as usize + 1)));
    assert_eq!(drawn(stroke(&dot, 1)).affected_area(), Rectangle::new(Point::new(9, 9), Size::new(1, 1)));
    assert_eq!(drawn(stroke(&dot, 7)).affected_area(), Rectangle::new(Point::new(6, 6), Size::new(7, 7)));
}

#[test]
fn widths_have_two_ends() {
    let line = curve([[10, 10], [50, 40]]);
    assert_eq!(drawn(stroke(&line, 0)).affected_area(), Rectangle::zero());
    assert!(stroke(&line, 0).bounding_box().is_zero_sized());
    assert_eq!(stroke(&line, u32::MAX).bounding_box(), stroke(&line, MAX_STROKE_WIDTH).bounding_box());
    assert_eq!(drawn(stroke(&line, u32::MAX)).affected_area().size, Size::new(64, 64));
}

/// The longest curves: the target is what limits the drawing.
#[test]
fn the_ends_of_the_legal_range_are_drawn() {
    let far = curve([[-32_767, -32_767], [32_767, 32_767]]);
    for width in [1, 2, 255] {
        let display = drawn(stroke(&far, width));
        assert!((0..64).all(|i| display.get_pixel(Point::new(i, i)).is_some()), "width {width}");
    }
    let far = curve([[-32_767, 32_767], [32_767, 32_767], [32_767, -32_767], [-32_767, -32_767]]);
    let moved = stroke(&far, 255).translate(Point::new(-16_350, 0));
    assert_eq!(moved.bounding_box().size, Size::new(65_535 + 254, 65_535 + 254));
    assert_eq!(drawn(moved).affected_area().size, Size::new(64, 64));
    for places in [Point::new(1 << 29, -(1 << 29)), Point::new(i32::MAX, i32::MIN)] {
        let moved = stroke(&far, 9).translate(places).translate(places);
        assert_eq!(moved.curve.offset(), Point::new(1 << 29, -(1 << 29)));
        assert_eq!(moved.curve.points().next(), Some(Point::new((1 << 29) - 32_767, -(1 << 29) + 32_767)));
    }
}

#[test]
fn what_does_not_fit_the_engine_is_a_typed_error() {
    let zigzag: [[i16; 2]; 9] = core::array::from_fn(|i| if i % 2 == 0 { [-32_767, 9] } else { [32_767, 0] });
    let error = BezierCurve::new(&curve(zigzag)).unwrap_err();
    let bits = 8 * 19 + 1 + 2;
    let expected = LatticeError::Budget { degrees: (8, 0), steps: (8 * 65_534, 0), fraction_bits: 1, bits };
    assert_eq!(error, expected);
    // Weights that make a straight line as fast as 10^8 pixels a parameter.
    let line = Curve::<2>::from_ints([[-32_767, 0, 0], [32_767, 0, 0]]).unwrap();
    let steep = RationalCurve::new(line, [1, 1000].map(I16F16::from_num)).unwrap();
    let error = BezierCurve::new(&steep).unwrap_err();
    assert_eq!(error, LatticeError::Steps { r: (1 << 24) + 1, s: 0 });
    let extreme = RationalCurve::new(line, [I16F16::from_bits(1), I16F16::from_bits(i32::MAX)]).unwrap();
    let error = BezierCurve::new(&extreme).unwrap_err();
    assert_eq!(error, LatticeError::Steps { r: u32::MAX, s: 0 });
}

#[test]
fn sizes_are_those_of_the_docs() {
    #[cfg(target_pointer_width = "64")]
    assert_eq!(size_of::<BezierCurve<'_>>(), 48);
    assert!(size_of::<CurvePixels>() <= 512, "{}", size_of::<CurvePixels>());
}

#[test]
fn traits_say_the_same_as_the_methods() {
    let arc = quarter([[0, 12], [12, 12], [12, 0]]);
    let curve = BezierCurve::new(&arc).unwrap();
    assert!(PointsIter::points(&curve).eq(curve.points()));
    assert_eq!(Dimensions::bounding_box(&curve), Rectangle::new(Point::zero(), Size::new(13, 13)));
    let stroke = Stroke::new(curve, BinaryColor::On, 4);
    assert_eq!(Dimensions::bounding_box(&stroke), stroke.bounding_box());
    assert_eq!(BezierCurve::new(arc.net()).unwrap(), curve);
}

#[cfg(feature = "styled")]
#[test]
fn styles_and_transforms_are_those_of_embedded_graphics() {
    use embedded_graphics::primitives::{PrimitiveStyle, PrimitiveStyleBuilder, StrokeAlignment};
    use embedded_graphics::transform::Transform;
    let looped = curve([[2, 15], [34, -8], [-14, -8], [18, 15]]);
    let (curve, by) = (BezierCurve::new(&looped).unwrap(), Point::new(9, 5));
    let expected = drawn(Stroke::new(curve.translate(by), BinaryColor::On, 3));
    let draw = |style: PrimitiveStyle<BinaryColor>| {
        let styled = Transform::translate(&curve, by).into_styled(style);
        let mut display = MockDisplay::new();
        styled.draw(&mut display).unwrap();
        assert!(styled.bounding_box().intersection(&display.bounding_box()).contains(display.affected_area().top_left));
        display
    };
    assert_eq!(draw(PrimitiveStyle::with_stroke(BinaryColor::On, 3)), expected);
    let all = PrimitiveStyleBuilder::new().stroke_color(BinaryColor::On).stroke_width(3).fill_color(BinaryColor::Off);
    assert_eq!(draw(all.stroke_alignment(StrokeAlignment::Outside).build()), expected, "no fill, always centred");
    let mut display = MockDisplay::new();
    curve.into_styled(PrimitiveStyle::with_fill(BinaryColor::On)).draw(&mut display).unwrap();
    assert_eq!(display.affected_area(), Rectangle::zero());
    let mut stroke = Stroke::new(curve, BinaryColor::On, 3);
    Transform::translate_mut(&mut stroke, by);
    assert_eq!(drawn(stroke), expected);
    assert_eq!(Transform::translate(&Stroke::new(curve, BinaryColor::On, 3), by), stroke);
}
