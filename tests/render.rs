//! P5 and the conventions of `embedded-graphics`: bands do not show, nothing outside, nothing twice, typed errors.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, clippy::disallowed_types, clippy::float_arithmetic)]

mod common;
#[path = "common/scene.rs"]
mod scene;

use embedded_graphics::draw_target::DrawTarget;
use embedded_graphics::mock_display::MockDisplay;
use embedded_graphics::pixelcolor::{BinaryColor, Gray4, Gray8, Rgb565, Rgb888};
use embedded_graphics::prelude::*;
use embedded_graphics::primitives::Rectangle;
use embedded_surfaces::forward::LatticeError;
use embedded_surfaces::geometry::Point3;
use embedded_surfaces::graphics::{Material, Model, Shade};
use embedded_surfaces::patch::{BicubicPatch, BilinearPatch, Surface, SurfaceNet, TensorNet};
use embedded_surfaces::render::{Area, Fragment, Frame, Light, Notes, Paint, RenderError, Scene, Style, Tile};
use scene::{Look, VIEWS, teapot};

const SCREEN: Area = Area { x: 0, y: 0, width: 320, height: 240 };

/// The whole picture, pulled in bands, which take notes.
fn picture<S: Surface, P: Paint>(
    patches: &[S],
    style: Style,
    paint: &P,
    background: P::Pixel,
    rows: u32,
) -> Vec<P::Pixel> {
    let scene = Scene::new(patches, Light::default(), style).unwrap();
    let mut notes = Notes::default();
    let mut frame = Frame::new(scene, paint, background, SCREEN, rows).unwrap().with_notes(&mut notes);
    let (mut colour, mut depth) = (vec![background; frame.band_pixels()], vec![0; frame.band_pixels()]);
    let mut pixels = Vec::new();
    while let Some(band) = frame.next_band(&mut colour, &mut depth).unwrap() {
        assert_eq!(band.area().y as usize * 320, pixels.len());
        pixels.extend_from_slice(band.pixels());
    }
    pixels
}

fn bands_do_not_show<C: Shade + PartialEq + core::fmt::Debug>(patches: &[BicubicPatch], colour: C, background: C) {
    let paint = Material { colour };
    let whole = picture(patches, Style::Shaded, &paint, background, 240);
    assert_eq!(whole.len(), 320 * 240);
    assert!(whole.iter().filter(|c| **c != background).count() > 15_000);
    for rows in [1, 7, 16, 1000] {
        assert!(picture(patches, Style::Shaded, &paint, background, rows) == whole, "bands of {rows} rows differ");
    }
}

#[test]
fn the_same_bytes_for_every_band_height_in_every_colour_type() {
    let patches = Look::at(VIEWS[1], (320, 240)).see(&teapot());
    bands_do_not_show(&patches, Rgb565::new(31, 50, 20), Rgb565::BLACK);
    bands_do_not_show(&patches, Rgb888::new(250, 200, 99), Rgb888::BLACK);
    bands_do_not_show(&patches, Gray4::WHITE, Gray4::BLACK);
    bands_do_not_show(&patches, Gray8::WHITE, Gray8::BLACK);
    bands_do_not_show(&patches, BinaryColor::On, BinaryColor::Off);
}

/// What a person sees: each pixel is the nearest point's, whatever order the patches come in.
#[test]
fn the_nearest_patch_wins_in_any_order() {
    let square = |z: i16, low: i16| {
        BilinearPatch::from_ints([[[low, low, z], [low, low + 9, z]], [[low + 9, low, z], [low + 9, low + 9, z]]])
            .unwrap()
    };
    let (near, far) = (square(-3, 4), square(2, 0));
    for patches in [[near, far], [far, near]] {
        let paint = |at: Fragment| if patches[at.patch] == near { b'n' } else { b'f' };
        let pixels = picture(&patches, Style::Flat, &paint, b'.', 16);
        assert_eq!(pixels[4 * 320 + 4], b'n');
        assert_eq!(pixels[3 * 320 + 4], b'f');
        assert_eq!(pixels[14 * 320 + 14], b'.');
    }
    // Planes that cross: the depth test works at a fraction of a unit.
    let tilted = BilinearPatch::from_ints([[[0, 0, 0], [0, 20, 0]], [[40, 0, 1], [40, 20, 1]]]).unwrap();
    let level = BilinearPatch::new(
        tilted.points().map(|row| row.map(|p| Point3 { z: Point3::from_bits(0, 0, 1 << 15).z, ..p })),
    );
    let patches = [tilted, level.unwrap()];
    let pixels = picture(&patches, Style::Flat, &|at: Fragment| at.patch, 9, 240);
    let row = &pixels[10 * 320..10 * 320 + 41];
    assert!(row[..20].iter().all(|p| *p == 0) && row[21..].iter().all(|p| *p == 1), "{row:?}");
}

#[test]
fn a_model_draws_what_it_covers_once_and_inside() {
    let square = [BilinearPatch::from_ints([[[0, 0, 0], [0, 4, 0]], [[6, 0, 0], [6, 4, 0]]]).unwrap()];
    // MockDisplay panics on a pixel outside or drawn twice.
    let mut display = MockDisplay::new();
    Model::flat(&square, BinaryColor::On).unwrap().translate(Point::new(-3, -2)).draw(&mut display).unwrap();
    display.assert_pattern(&["####", "####", "####"]);
    let mut display = MockDisplay::new();
    let mut model = Model::<_, _, 5>::with_buffer(&square, BinaryColor::On, Light::default(), Style::Flat).unwrap();
    model.translate_mut(Point::new(60, 61)).draw(&mut display).unwrap();
    assert_eq!(display.affected_area(), Rectangle::new(Point::new(60, 61), Size::new(4, 3)));
    assert_eq!(model.bounding_box(), Rectangle::new(Point::new(60, 61), Size::new(7, 5)));
    for far in [Point::new(i32::MAX, 0), Point::new(i32::MIN, i32::MIN), Point::new(0, 64)] {
        let mut display = MockDisplay::new();
        model.translate(far).translate(far).draw(&mut display).unwrap();
        assert_eq!(display.affected_area(), Rectangle::zero());
    }
}

/// Buffers of any size give the same pixels, moved exactly by whole pixels.
#[test]
fn buffers_and_translations_do_not_show() {
    let small: Vec<_> = Look::at(VIEWS[2], (60, 50)).see(&teapot());
    let drawn = |model: &dyn Fn(&mut MockDisplay<Gray8>)| {
        let mut display = MockDisplay::new();
        model(&mut display);
        display
    };
    let by = Point::new(3, 7);
    let whole = drawn(&|d| Model::shaded(&small, Gray8::WHITE).unwrap().draw(d).unwrap());
    let narrow = Model::<_, _, 37>::with_buffer(&small, Gray8::WHITE, Light::default(), Style::Shaded).unwrap();
    assert_eq!(drawn(&|d| narrow.draw(d).unwrap()), whole);
    let moved = drawn(&|d| narrow.translate(by).draw(d).unwrap());
    for p in Rectangle::new(Point::zero(), Size::new(60, 56)).points() {
        assert_eq!(moved.get_pixel(p + by), whole.get_pixel(p), "{p:?}");
    }
}

#[cfg(feature = "styled")]
#[test]
fn transform_is_the_same_verb() {
    use embedded_graphics::transform::Transform;
    let square = [BilinearPatch::from_ints([[[0, 0, 0], [0, 4, 0]], [[6, 0, 0], [6, 4, 0]]]).unwrap()];
    let model = Model::flat(&square, BinaryColor::On).unwrap();
    let mut moved = model;
    Transform::translate_mut(&mut moved, Point::new(5, 6));
    let by_trait = Dimensions::bounding_box(&Transform::translate(&model, Point::new(5, 6)));
    assert_eq!(by_trait, moved.bounding_box());
    assert_eq!(by_trait.top_left, Point::new(5, 6));
}

/// A target that records every call and refuses what is outside.
struct Recorder {
    bounds: Rectangle,
    filled: Vec<(Rectangle, usize)>,
}

impl Dimensions for Recorder {
    fn bounding_box(&self) -> Rectangle {
        self.bounds
    }
}

impl DrawTarget for Recorder {
    type Color = Gray8;
    type Error = core::convert::Infallible;

    fn draw_iter<I: IntoIterator<Item = Pixel<Gray8>>>(&mut self, _: I) -> Result<(), Self::Error> {
        panic!("bands go out contiguously");
    }

    fn fill_contiguous<I: IntoIterator<Item = Gray8>>(
        &mut self,
        area: &Rectangle,
        colors: I,
    ) -> Result<(), Self::Error> {
        assert_eq!(area.intersection(&self.bounds), *area, "outside");
        self.filled.push((*area, colors.into_iter().count()));
        Ok(())
    }
}

#[test]
fn bands_go_out_by_one_contiguous_write_each_clipped_to_the_target() {
    let patches = Look::at(VIEWS[1], (320, 240)).see(&teapot());
    let paint = Material { colour: Gray8::WHITE };
    for (corner, size) in [((0, 0), (320, 240)), ((10, 20), (100, 50)), ((-5, 200), (500, 900)), ((400, 0), (9, 9))] {
        let bounds = Rectangle::new(corner.into(), size.into());
        let mut target = Recorder { bounds, filled: Vec::new() };
        let scene = Scene::new(&patches, Light::default(), Style::Shaded).unwrap();
        let mut frame = Frame::new(scene, &paint, Gray8::BLACK, SCREEN, 16).unwrap();
        let (mut colour, mut depth) = ([Gray8::BLACK; 320 * 16], [0; 320 * 16]);
        while let Some(band) = frame.next_band(&mut colour, &mut depth).unwrap() {
            band.draw(&mut target).unwrap();
        }
        let visible = bounds.intersection(&SCREEN.into());
        let sent: usize = target
            .filled
            .iter()
            .map(|(area, count)| {
                assert_eq!((area.size.width * area.size.height) as usize, *count);
                *count
            })
            .sum();
        assert_eq!(sent, (visible.size.width * visible.size.height) as usize);
    }
}

#[test]
fn degenerate_patches_draw_what_they_are() {
    let count = |patch: BicubicPatch, style| {
        picture(&[patch], style, &|_: Fragment| true, false, 240).into_iter().filter(|p| *p).count()
    };
    let bicubic = |point: &dyn Fn(i16, i16) -> [i16; 3]| {
        BicubicPatch::from_ints(core::array::from_fn(|i| core::array::from_fn(|j| point(i as i16, j as i16)))).unwrap()
    };
    for style in [Style::Shaded, Style::Flat] {
        assert_eq!(count(bicubic(&|_, _| [9, 9, 5]), style), 1);
        assert_eq!(count(bicubic(&|i, _| [9 + 5 * i, 9, 5]), style), 16);
        assert_eq!(count(bicubic(&|i, j| [9 + 3 * i, 9 + 2 * j, 0]), style), 70);
        assert_eq!(count(bicubic(&|i, j| [-900 + i, 9 + j, 0]), style), 0);
    }
}

#[test]
fn what_cannot_be_drawn_is_a_typed_error() {
    let square = [BilinearPatch::from_ints([[[0, 0, 0], [0, 4, 0]], [[6, 0, 0], [6, 4, 0]]]).unwrap()];
    let scene = Scene::new(&square, Light::default(), Style::Shaded).unwrap();
    let grey = |at: Fragment| at.shade;
    let area = |width, height| Area { x: 0, y: 0, width, height };
    for (bad, rows) in [(area(0, 9), 4), (area(9, 0), 4), (area(40_000, 9), 4), (area(9, u32::MAX), 4), (area(9, 9), 0)]
    {
        assert!(matches!(Frame::new(scene, &grey, 0, bad, rows).map(|_| ()), Err(RenderError::Area { .. })));
    }
    assert!(Tile::new(area(0, 1), &mut [0_u8], &mut [0], 0).is_err());
    let mut frame = Frame::new(scene, &grey, 0, area(20, 20), 5).unwrap();
    let error = frame.next_band(&mut [0; 99], &mut [0; 100]).unwrap_err();
    assert_eq!(error, RenderError::Buffer { needed: 100, colour: 99, depth: 100 });
    assert_eq!(error.to_string(), "100 pixels do not fit buffers of 99 colours and 100 depths");
    let error = frame.next_band(&mut [0; 100], &mut [0; 9]).unwrap_err();
    assert_eq!(error, RenderError::Buffer { needed: 100, colour: 100, depth: 9 });
    let mut rows = 0;
    while let Some(band) = frame.next_band(&mut [0; 100], &mut [0; 100]).unwrap() {
        rows += band.area().height;
    }
    assert_eq!(rows, 20, "nothing was lost to the errors");

    // Degrees (8, 8) over the whole legal range: no accumulator is wide enough, however often it is split.
    let bits = |k: i32| (k - 4) * 500_000_001;
    let points: Vec<_> = (0..81).map(|k| Point3::from_bits(bits(k / 9), bits(k % 9), 0)).collect();
    let large = SurfaceNet::Tensor(TensorNet::new((8, 8), &points).unwrap());
    let error = Scene::new(&[square[0].surface(), large], Light::default(), Style::Flat).map(|_| ()).unwrap_err();
    assert!(matches!(error, RenderError::Patch { index: 1, error: LatticeError::Budget { degrees: (8, 8), .. } }));
    assert!(error.to_string().starts_with("patch 1: degrees (8, 8) at "), "{error}");
}

/// A patch of high degree that only fits after it was quartered often: all of a window in its middle is covered.
#[test]
fn large_patches_of_high_degree_have_no_hole() {
    for (m, h, width) in [(8, 8, 1000), (8, 8, 8000), (8, 5, 12_000), (6, 8, 4000), (4, 7, 20_000)] {
        let place = |k: i32, n: i32| (i64::from(2 * k - n) * width * 32_768 / i64::from(n) + 12_345) as i32;
        let points: Vec<_> = (0..(m + 1) * (h + 1))
            .map(|k| Point3::from_bits(place(k / (h + 1), m), place(k % (h + 1), h), (k * 977) % 400_000))
            .collect();
        let net = SurfaceNet::Tensor(TensorNet::new((m as usize, h as usize), &points).unwrap());
        let scene = Scene::new(core::slice::from_ref(&net), Light::default(), Style::Flat).unwrap();
        let area = Area { x: -20, y: 7, width: 64, height: 48 };
        let (mut colour, mut depth) = (vec![0_u8; area.pixels()], vec![0; area.pixels()]);
        let mut tile = Tile::new(area, &mut colour, &mut depth, 0).unwrap();
        scene.draw(&mut tile, &|_| 1);
        let missed = tile.pixels().iter().filter(|pixel| **pixel == 0).count();
        assert_eq!(missed, 0, "degrees ({m}, {h}), {width} pixels wide");
    }
}
