//! What the feature `styled` adds.

use super::graphics::Screen;
use super::render::STYLES;
use super::{Sum, data, hide};
use embedded_graphics::pixelcolor::{BinaryColor, Gray4};
use embedded_graphics::prelude::*;
use embedded_graphics::primitives::{PrimitiveStyle, StyledDimensions};
use embedded_surfaces::graphics::{BezierCurve, Model, ModelStyle, Patches, Stroke};
use embedded_surfaces::patch::Surface;

pub(super) fn calls(sum: &mut Sum) {
    let by = Point::new(hide(5), hide(2));
    let patches = [hide(&data::BICUBIC).surface(), hide(&data::OCTANT).surface()];
    let styles = hide(STYLES).map(|style| ModelStyle { style, ..ModelStyle::new(Gray4::WHITE) });
    if let Ok(mut patches) = Patches::new(&patches) {
        Transform::translate_mut(&mut patches, by);
        sum.add(Transform::translate(&patches, by).bounding_box());
        for style in styles {
            sum.add(patches.styled_bounding_box(&style));
            patches.into_styled(style).draw(&mut Screen::new(sum)).unwrap_or_else(|never| match never {});
        }
    }
    if let Ok(mut model) = Model::flat(&patches, BinaryColor::On) {
        Transform::translate_mut(&mut model, by);
        sum.add(Transform::translate(&model, by).bounding_box());
    }
    let Ok(mut curve) = BezierCurve::new(hide(&data::ARC)) else { return };
    Transform::translate_mut(&mut curve, by);
    sum.add(Transform::translate(&curve, by).bounding_box());
    let mut stroke = Stroke::new(curve, Gray4::WHITE, hide(4));
    Transform::translate_mut(&mut stroke, by);
    sum.add(Transform::translate(&stroke, by).bounding_box());
    for style in [PrimitiveStyle::with_stroke(Gray4::WHITE, hide(3)), PrimitiveStyle::with_fill(Gray4::WHITE)] {
        sum.add(curve.styled_bounding_box(&style));
        curve.into_styled(style).draw(&mut Screen::new(sum)).unwrap_or_else(|never| match never {});
    }
}
