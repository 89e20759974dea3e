//! The fast fill: no crack, the same bytes in every band height with and without a list, levels against `f64`, typed
//! errors.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, clippy::disallowed_types, clippy::float_arithmetic)]

mod common;
#[path = "common/scene.rs"]
mod scene;
#[path = "common/truth.rs"]
mod truth;

use common::{SEED_P, SEED_Q};
use embedded_surfaces::forward::LatticeError;
use embedded_surfaces::geometry::{Affine, Perspective, Point3};
use embedded_surfaces::num::{Angle, I16F16};
use embedded_surfaces::patch::{
    BicubicPatch, BilinearPatch, CubicTriangle, RationalTensorNet, RationalTriangleNet, Surface, SurfaceNet, TensorNet,
    TriangleNet, sphere, torus,
};
use embedded_surfaces::reference::lambert;
use embedded_surfaces::render::{
    Area, Cull, Facet, Fill, Fragment, Frame, Gloss, Light, Lines, RenderError, Scene, Statistics, Style, Tile,
};
use embedded_surfaces::subdivide::{PatchTopology, topology};
use scene::{Look, Random, VIEWS, teacup, teapot};
use truth::Truth;

const SCREEN: Area = Area { x: 0, y: 0, width: 320, height: 240 };

fn grid(tolerance: f64) -> Fill {
    Fill::Grid { tolerance: I16F16::from_num(tolerance) }
}

fn edges<S: Surface>(patches: &[S]) -> Vec<PatchTopology> {
    let mut edges = vec![PatchTopology::default(); patches.len()];
    topology(patches, &mut edges).unwrap();
    edges
}

/// The levels of a picture in one piece.
fn draw<S: Surface>(scene: Scene<'_, S>, area: Area) -> (Vec<Option<u8>>, Statistics) {
    let (mut colour, mut depth) = (vec![None; area.pixels()], vec![0; area.pixels()]);
    let mut tile = Tile::new(area, &mut colour, &mut depth, None).unwrap();
    let statistics = scene.draw(&mut tile, &|at: Fragment| Some(at.shade));
    (colour, statistics)
}

/// No covered pixel centre away from silhouettes and open borders is left out; returns how many there are.
fn nothing_missed<S: Surface>(patches: &[S], area: Area, tolerance: f64) -> usize {
    let edges = edges(patches);
    let truth = Truth::of(patches, &edges, area, tolerance);
    let scene = Scene::new(patches, Light::default(), Style::Flat).unwrap().with_topology(&edges).unwrap();
    let (pixels, statistics) = draw(scene.with_fill(grid(tolerance)).unwrap(), area);
    let missed: Vec<usize> = truth.inner().filter(|i| pixels[*i].is_none()).collect();
    assert!(missed.is_empty(), "{missed:?} of {} inner centres, {statistics:?}", truth.inner().count());
    truth.inner().count()
}

#[test]
fn the_teapot_in_six_views() {
    for view in VIEWS {
        let patches = Look::at(view, (320, 240)).see(&teapot());
        for tolerance in if view == VIEWS[2] { [0.5, 2.0].as_slice() } else { &[1.0] } {
            let inner = nothing_missed(&patches, SCREEN, *tolerance);
            assert!(inner > 8000, "{inner}");
        }
    }
}

#[test]
fn the_tea_cup_and_perspective() {
    assert!(nothing_missed(&Look::at((-10.0, 30.0), (320, 240)).see(&teacup()), SCREEN, 1.0) > 10_000);
    let patches = Look::at(VIEWS[1], (320, 240)).see(&teapot());
    let number = I16F16::from_num::<i32>;
    let eye = Perspective { centre_x: number(160), centre_y: number(120), distance: number(900) };
    let seen: Vec<_> = patches.iter().map(|p| p.perspective(&eye).unwrap()).collect();
    assert!(nothing_missed(&seen, SCREEN, 1.0) > 10_000);
}

/// Each pair of neighbours alone: nothing behind the seam hides a crack.
#[test]
fn seams_of_the_teapot() {
    let patches = Look::at(VIEWS[1], (320, 240)).see(&teapot());
    let mut seams = 0;
    for a in 0..patches.len() {
        for b in a + 1..patches.len() {
            let pair = [patches[a], patches[b]];
            if edges(&pair).iter().any(|t| (0..4).any(|edge| t.is_joined(edge))) {
                nothing_missed(&pair, SCREEN, 1.0);
                seams += 1;
            }
        }
    }
    assert!(seams >= 48, "{seams}");
}

#[test]
fn random_seams() {
    let mut random = Random(7);
    let area = Area { x: -60, y: -60, width: 220, height: 220 };
    let mut inner = 0;
    for _ in 0..25 {
        let edge: [Point3; 4] = core::array::from_fn(|i| random.near(i as f64 / 3.0, 0.5, 90.0, 0.3));
        let mut side = |sign: f64| {
            let mut net: [[Point3; 4]; 4] = core::array::from_fn(|i| {
                core::array::from_fn(|j| random.near(i as f64 / 3.0, 0.5 + sign * j as f64 / 3.0, 90.0, 0.15))
            });
            net.iter_mut().zip(edge).for_each(|(row, p)| row[0] = p);
            net
        };
        let (left, mut right) = (side(1.0), side(-1.0));
        // The other way round along the seam.
        right.reverse();
        let pair = [left, right].map(|net| BicubicPatch::new(net).unwrap());
        inner += nothing_missed(&pair, area, 0.7);
    }
    assert!(inner > 50_000, "{inner}");
}

#[test]
fn triangles_of_every_degree() {
    let pair = [SEED_P, SEED_Q].map(|points| CubicTriangle::from_ints(points).unwrap());
    assert!(nothing_missed(&pair, Area { x: 0, y: 0, width: 420, height: 380 }, 1.0) > 25_000);
    let mut random = Random(2002);
    let area = Area { x: -60, y: -60, width: 320, height: 320 };
    let mut inner = 0;
    for index in 0..24 {
        let degree = 1 + index % 8;
        let mut points = Vec::new();
        for i in (0..=degree).rev() {
            for j in (0..=degree - i).rev() {
                points.push(random.near(i as f64 / degree as f64, j as f64 / degree as f64, 150.0, 0.4));
            }
        }
        let net = SurfaceNet::Triangle(TriangleNet::new(degree, &points).unwrap());
        inner += nothing_missed(&[net], area, 0.5);
    }
    assert!(inner > 100_000, "{inner}");
}

#[test]
fn tensor_patches_of_every_degree() {
    let mut random = Random(1989);
    let area = Area { x: -60, y: -60, width: 320, height: 320 };
    let mut inner = 0;
    for index in 0..24 {
        let (m, h) = (1 + index % 5, 1 + index / 5);
        let mut points = Vec::new();
        for i in 0..=m {
            for j in 0..=h {
                points.push(random.near(i as f64 / m as f64, j as f64 / h as f64, 150.0, 0.4));
            }
        }
        let net = SurfaceNet::Tensor(TensorNet::new((m, h), &points).unwrap());
        inner += nothing_missed(&[net], area, 0.5);
    }
    assert!(inner > 200_000, "{inner}");
}

#[test]
fn spheres_and_tori() {
    let centre = Point3::from_ints(160, 120, 0);
    let view = Affine::rotation_x(Angle::from_degrees(33)).then(&Affine::rotation_z(Angle::from_degrees(20))).unwrap();
    let map = Affine::translation((-160).into(), (-120).into(), 0.into()).then(&view).unwrap();
    let map = map.then(&Affine::translation(160.into(), 120.into(), 0.into())).unwrap();
    let size = I16F16::from_num;
    for solid in [sphere(centre, size(90)).unwrap().to_vec(), torus(centre, size(70), size(27)).unwrap().to_vec()] {
        let turned: Vec<_> = solid.iter().map(|patch| patch.transform(&map).unwrap()).collect();
        let inner = nothing_missed(&turned, SCREEN, 1.0);
        assert!(inner > 8000, "{inner}");
    }
}

/// The figures of the documentation: levels on the default teapot.
#[test]
fn levels_of_the_teapot() {
    let patches = Look::at(VIEWS[1], (320, 240)).see(&teapot());
    let edges = edges(&patches);
    let light = Light::default();
    let direction = light.direction().map(|c| f64::from(c) / 32768.0);
    let ambient = f64::from(light.ambient()) / 255.0;
    for (tolerance, limit) in [(2.0, (4.1, 26.0)), (1.0, (2.6, 31.0)), (0.5, (1.5, 13.0))] {
        let truth = Truth::of(&patches, &edges, SCREEN, tolerance);
        let scene = Scene::new(&patches, light, Style::Shaded).unwrap().with_topology(&edges).unwrap();
        let (pixels, statistics) = draw(scene.with_fill(grid(tolerance)).unwrap(), SCREEN);
        let mut errors = Vec::new();
        for index in truth.inner() {
            if let (Some(level), Some(Some(normal))) = (pixels[index], truth.seen[index].map(|seen| seen.normal)) {
                errors.push((f64::from(level) - lambert(normal, direction, ambient)).abs());
            }
        }
        errors.sort_by(f64::total_cmp);
        let mean = errors.iter().sum::<f64>() / errors.len() as f64;
        let [p50, p99] = [50, 99].map(|p| errors[errors.len() * p / 100]);
        println!(
            "tolerance {tolerance}: {statistics:?}, {} pixels, mean {mean:.3} p50 {p50:.2} p99 {p99:.2}",
            errors.len()
        );
        assert!(errors.len() > 15_000);
        assert!(mean <= limit.0 && p99 <= limit.1, "mean {mean}, p99 {p99}");
    }
}

/// The picture pulled in bands, with a list or without.
fn in_bands<S: Surface>(scene: Scene<'_, S>, rows: u32, list: bool) -> Vec<Option<u8>> {
    let (mut facets, mut links) = (vec![Facet::EMPTY; 65_535], vec![0; 66_000]);
    let paint = |at: Fragment| Some(at.shade ^ at.patch as u8);
    let mut frame = Frame::new(scene, &paint, None, SCREEN, rows).unwrap();
    if list {
        frame = frame.with_facets(&mut facets, &mut links).unwrap();
    }
    let (mut colour, mut depth) = (vec![None; frame.band_pixels()], vec![0; frame.band_pixels()]);
    let mut pixels = Vec::new();
    while let Some(band) = frame.next_band(&mut colour, &mut depth).unwrap() {
        pixels.extend_from_slice(band.pixels());
    }
    pixels
}

#[test]
fn the_same_bytes_in_every_band_height_with_and_without_a_list() {
    let patches = Look::at(VIEWS[1], (320, 240)).see(&teapot());
    let edges = edges(&patches);
    let styles = [
        Style::Shaded,
        Style::Glossy(Gloss::new(90, 24)),
        Style::Flat,
        Style::DepthCued { near: 250, far: 30 },
        Style::Wire(Lines::every(2).without_hidden()),
    ];
    for style in styles {
        for cull in [Cull::None, Cull::Back] {
            let scene = Scene::new(&patches, Light::default(), style).unwrap().with_topology(&edges).unwrap();
            let scene = scene.with_cull(cull).with_fill(grid(1.0)).unwrap();
            let whole = in_bands(scene, 240, false);
            assert!(whole.iter().flatten().count() > 2000);
            for rows in [1, 7, 16, 240] {
                for list in [false, true] {
                    assert!(in_bands(scene, rows, list) == whole, "{style:?} {cull:?} {rows} {list}");
                }
            }
        }
    }
}

/// A buffer too small loses nothing, and a list may come when bands are gone already.
#[test]
fn a_list_in_the_middle_of_a_frame() {
    let patches = Look::at(VIEWS[2], (320, 240)).see(&teapot());
    let edges = edges(&patches);
    let scene = Scene::grid(&patches, &edges, I16F16::ONE, Light::default(), Style::Shaded).unwrap();
    let whole = in_bands(scene, 240, false);
    let (mut facets, mut links) = (vec![Facet::EMPTY; 5000], vec![0; 6000]);
    let paint = |at: Fragment| Some(at.shade ^ at.patch as u8);
    let mut frame = Frame::new(scene, &paint, None, SCREEN, 11).unwrap();
    let (mut colour, mut depth) = (vec![None; frame.band_pixels()], vec![0; frame.band_pixels()]);
    let mut pixels = Vec::new();
    for _ in 0..7 {
        pixels.extend_from_slice(frame.next_band(&mut colour, &mut depth).unwrap().unwrap().pixels());
    }
    let mut frame = frame.with_facets(&mut facets, &mut links).unwrap();
    assert!(frame.next_band(&mut colour[1..], &mut depth).is_err());
    while let Some(band) = frame.next_band(&mut colour, &mut depth).unwrap() {
        pixels.extend_from_slice(band.pixels());
    }
    assert!(pixels == whole);
}

/// Tiles of any place and size show the same pixels.
#[test]
fn tiles_do_not_show() {
    let patches = Look::at(VIEWS[2], (320, 240)).see(&teapot());
    let edges = edges(&patches);
    let scene = Scene::new(&patches, Light::default(), Style::Shaded).unwrap().with_topology(&edges).unwrap();
    let scene = scene.with_fill(grid(1.0)).unwrap();
    let (whole, _) = draw(scene, SCREEN);
    let mut random = Random(5);
    for _ in 0..60 {
        let mut below = |n: f64| (n * random.unit()) as i32;
        let area =
            Area { x: below(300.0), y: below(220.0), width: below(60.0) as u32 + 1, height: below(60.0) as u32 + 1 };
        let (part, _) = draw(scene, area);
        for (k, level) in part.iter().enumerate() {
            let (x, y) = (area.x + k as i32 % area.width as i32, area.y + k as i32 / area.width as i32);
            if x < 320 && y < 240 {
                assert_eq!(*level, whole[(y * 320 + x) as usize], "({x}, {y})");
            }
        }
    }
}

/// A closed solid looks the same with its back sides left out, but for a few pixels at its silhouettes.
#[test]
fn culling_leaves_out_what_is_hidden() {
    let solid = sphere(Point3::from_ints(160, 120, 0), I16F16::from_num(90)).unwrap();
    let edges = edges(&solid);
    let scene = Scene::new(&solid, Light::default(), Style::Shaded).unwrap().with_topology(&edges).unwrap();
    let scene = scene.with_fill(grid(0.5)).unwrap();
    let (all, whole) = draw(scene, SCREEN);
    let (front, half) = draw(scene.with_cull(Cull::Back), SCREEN);
    let differ = all.iter().zip(&front).filter(|(a, b)| a != b).count();
    assert!(all.iter().flatten().count() > 20_000 && differ < 100, "{differ} differ");
    assert!(half.facets < whole.facets * 6 / 10, "{} of {} facets", half.facets, whole.facets);
    // Turned inside out, nothing in front is left.
    let flipped: Vec<_> = edges.iter().map(|e| e.flipped()).collect();
    let inside = scene.with_cull(Cull::Back).with_topology(&flipped).unwrap().with_fill(grid(0.5)).unwrap();
    let style = Style::DepthCued { near: 255, far: 0 };
    let depths = Scene::new(&solid, Light::default(), style).unwrap().with_topology(&flipped).unwrap();
    let (inner, _) = draw(depths.with_fill(grid(0.5)).unwrap().with_cull(Cull::Back), SCREEN);
    assert!(inner.iter().flatten().all(|level| *level < 140));
    assert!(draw(inside, SCREEN).1.facets + half.facets <= whole.facets + 40);
}

#[test]
fn what_is_refused() {
    let patches = Look::at(VIEWS[1], (320, 240)).see(&teapot());
    let edges = edges(&patches);
    let scene = Scene::new(&patches, Light::default(), Style::Shaded).unwrap();
    assert_eq!(scene.with_fill(grid(1.0)).unwrap_err(), RenderError::Topology { patches: 32, given: 0 });
    let short = scene.with_topology(&edges[1..]).unwrap_err();
    assert_eq!(short, RenderError::Topology { patches: 32, given: 31 });
    assert_eq!(short.to_string(), "a grid over 32 patches needs a topology of as many entries, not 31");
    let scene = scene.with_topology(&edges).unwrap();
    for bits in [0, -1, i32::MIN] {
        let refused = scene.with_fill(Fill::Grid { tolerance: I16F16::from_bits(bits) }).unwrap_err();
        assert_eq!(refused, RenderError::Tolerance { bits });
    }
    assert!(scene.with_fill(Fill::Exact).is_ok());
    let message = RenderError::Tolerance { bits: -3 }.to_string();
    assert_eq!(message, "a tolerance of -3/65536 pixel is not positive");
    let message = RenderError::Segments { index: 4, most: 1024 }.to_string();
    assert_eq!(message, "patch 4 needs more than 1024 segments in a direction at this tolerance");
    let filled = scene.with_fill(grid(1.0)).unwrap();
    let paint = |at: Fragment| at.shade;
    let frame = || Frame::new(filled, &paint, 0, SCREEN, 16).unwrap();
    let error = frame().with_facets(&mut [Facet::EMPTY; 9], &mut [0; 30]).map(|_| ()).unwrap_err();
    let RenderError::Facets { needed, given: 9, needed_links, given_links: 30 } = error else { panic!("{error:?}") };
    assert_eq!(needed_links, needed + 15);
    let message = format!("{needed} facets with {needed_links} links do not fit 9 entries and 30 links");
    assert_eq!(error.to_string(), message);
    let (mut facets, mut links) = (vec![Facet::EMPTY; needed], vec![0; needed_links]);
    assert!(frame().with_facets(&mut facets, &mut links[1..]).is_err());
    assert!(frame().with_facets(&mut facets[1..], &mut links).is_err());
    assert!(frame().with_facets(&mut facets, &mut links).is_ok());
}

/// Patches at the ends of the legal range, and tolerances of every size.
#[test]
fn the_ends_of_the_range() {
    let far = i16::MAX;
    let flat =
        [BilinearPatch::from_ints([[[-far, -far, -far], [-far, far, far]], [[far, -far, 0], [far, far, -9]]]).unwrap()];
    let flat_edges = edges(&flat);
    let scene = Scene::new(&flat, Light::default(), Style::Shaded).unwrap().with_topology(&flat_edges).unwrap();
    let refused = scene.with_fill(grid(1.0)).unwrap_err();
    assert_eq!(refused, RenderError::Segments { index: 0, most: 1024 });
    let wide =
        [BilinearPatch::from_ints([[[-far, 0, -far], [-far, 200, 0]], [[28_000, 0, far], [28_000, 200, -9]]]).unwrap()];
    assert_eq!(nothing_missed(&wide, SCREEN, 1.0), 320 * (201 - 4));
    let mut random = Random(11);
    let (mut drawn, mut refused) = (0, 0);
    for _ in 0..60 {
        let size = 10.0_f64.powf(1.0 + 3.5 * random.unit());
        let net = core::array::from_fn(|i| {
            core::array::from_fn(|j| {
                let (x, y) = (i as f64 / 3.0, j as f64 / 3.0);
                random.near(x, y, size.min(16_000.0), 0.9)
            })
        });
        let patches = [BicubicPatch::new(net).unwrap()];
        let edges = edges(&patches);
        let scene = Scene::new(&patches, Light::default(), Style::Shaded).unwrap().with_topology(&edges).unwrap();
        let tolerance = I16F16::from_bits(1 << (24.0 * random.unit()) as u32);
        match scene.with_fill(Fill::Grid { tolerance }) {
            Ok(scene) => {
                draw(scene, Area { x: -40, y: -40, width: 200, height: 100 });
                drawn += 1;
            }
            Err(RenderError::Segments { .. } | RenderError::Patch { error: LatticeError::Budget { .. }, .. }) => {
                refused += 1;
            }
            Err(error) => panic!("{error}"),
        }
    }
    assert!(drawn > 30 && refused > 3, "{drawn} {refused}");
}

/// Nets of every kind, size and place, folded and flat, through lists and tiles: nothing overflows, and lists agree.
#[test]
fn any_net_is_drawn_or_refused() {
    let mut random = Random(23);
    let (mut drawn, mut refused) = (0, 0);
    for index in 0..200 {
        let (m, h) = (1 + index % 4, 1 + index / 4 % 3);
        let size = 10.0_f64.powf(0.3 + 3.2 * random.unit());
        let (triangle, rational) = (index % 3 == 0, index % 5 == 0);
        let count = if triangle { (m + 1) * (m + 2) / 2 } else { (m + 1) * (h + 1) };
        let flat = random.unit() < 0.3;
        let mut coordinate = |flat: bool| {
            let c = 100.0 + size * (random.unit() - 0.5) * 2.0;
            if flat { 77 } else { (c.clamp(-32_767.0, 32_767.0) * 65_536.0) as i32 }
        };
        let points: Vec<_> =
            (0..count).map(|_| Point3::from_bits(coordinate(false), coordinate(flat), coordinate(false))).collect();
        let weights: Vec<_> = (0..count).map(|_| I16F16::from_num(0.01 + 9.0 * random.unit())).collect();
        let (tri, tensor) = (TriangleNet::new(m, &points), TensorNet::new((m, h), &points));
        let net = match (triangle, rational) {
            (true, false) => SurfaceNet::Triangle(tri.unwrap()),
            (true, true) => SurfaceNet::RationalTriangle(RationalTriangleNet::new(tri.unwrap(), &weights).unwrap()),
            (false, false) => SurfaceNet::Tensor(tensor.unwrap()),
            (false, true) => SurfaceNet::RationalTensor(RationalTensorNet::new(tensor.unwrap(), &weights).unwrap()),
        };
        let (nets, tolerance) =
            ([net], I16F16::from_num(if index % 23 == 0 { 0.00002 } else { 4.0 + 20.0 * random.unit() }));
        let edges = edges(&nets);
        match Scene::grid(&nets, &edges, tolerance, Light::default(), Style::Shaded) {
            Ok(scene) => {
                let scene = scene.with_cull(if index % 7 == 0 { Cull::Back } else { Cull::None });
                let whole = in_bands(scene, 240, false);
                assert!(in_bands(scene, 50, true) == whole, "{net:?}");
                drawn += 1;
            }
            Err(RenderError::Segments { .. } | RenderError::Patch { .. }) => refused += 1,
            Err(error) => panic!("{error}"),
        }
    }
    assert!(drawn > 150 && refused > 3, "{drawn} {refused}");
}
