//! Sampling of a material's texture: wrapping along both axes, minification and magnification filters, mip levels, and
//! transforms.

use crate::stage::{gpu, lighting};
use framegraph_passes::Shading;
use framegraph_scene::texture::{Filter, Sampler, TextureRole, TextureSlot, UvTransform, Wrap};
use framegraph_scene::{Environment, Material, Mesh};
use glam::{DMat4, DVec2, DVec3, Vec2};
use std::error::Error;
use tests::measure::board::{Board, EXPOSURE, card};

type TestResult = Result<(), Box<dyn Error>>;

/// Texels along each side of the picture, all of different colors.
const SIDE: usize = 4;

/// Red encodes the column, green the row, blue both.
fn texel(column: usize, row: usize) -> [u8; 4] {
    [30 + 60 * column as u8, 40 + 50 * row as u8, (17 * column + 43 * row) as u8, 255]
}

fn linear(texel: [u8; 4]) -> DVec3 {
    let decode = |code: u8| {
        let c = f64::from(code) / 255.0;
        if c <= 0.04045 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) }
    };
    DVec3::new(decode(texel[0]), decode(texel[1]), decode(texel[2]))
}

/// Adds a card that shows `slot` at `uv`; `span` is the extent of its coordinates, 0 for a single point.
fn shows(board: &mut Board, slot: TextureSlot, uv: DVec2, span: f64) {
    let material = Material { base_color_texture: Some(slot), unlit: true, ..Material::default() };
    let flat = card(0.99, DVec3::Z, DVec3::X, 1.0);
    let at = |corner: &glam::Vec3| uv.as_vec2() + Vec2::new(corner.x, -corner.y) * span as f32;
    let uv0 = flat.positions.iter().map(at).collect();
    board.hang(material, Mesh { uv0, ..flat }, DMat4::IDENTITY);
}

/// Renders the board and compares each card with its expected color.
fn compare(board: &Board, expected: &[(String, DVec3)], name: &str) -> TestResult {
    let Some(gpu) = gpu(name) else { return Ok(()) };
    let shading = Shading::default();
    let dark = lighting(&gpu, &Environment::uniform(DVec3::ZERO)?, &shading)?;
    let seen = board.render_lit(&gpu, dark, &shading)?;
    for ((what, expected), seen) in expected.iter().zip(seen) {
        // Filters have 8-bit weights, and the frame has half floats.
        let apart = (seen.nits * EXPOSURE - *expected).abs().max_element();
        assert!(apart < 4e-3, "{what}: {} for {expected}", seen.nits * EXPOSURE);
    }
    Ok(())
}

fn picture() -> Vec<[u8; 4]> {
    (0..SIDE * SIDE).map(|i| texel(i % SIDE, i / SIDE)).collect()
}

const SHARP: Sampler =
    Sampler { wrap_u: Wrap::Repeat, wrap_v: Wrap::Repeat, mag: Filter::Nearest, min: Filter::Nearest, mip: None };

#[test]
fn coordinates_wrap_along_each_axis_as_asked() -> TestResult {
    let mut board = Board::default();
    let mut expected = Vec::new();
    // One period beyond the picture, in its second texel: the repeated texel, its mirror image, or the last one.
    let beyond = |wrap, back: bool| match (wrap, back) {
        (Wrap::Repeat, false) => 1,
        (Wrap::MirroredRepeat, false) => 2,
        (Wrap::ClampToEdge, false) => 3,
        // One period before it, where its third texel would be.
        (Wrap::Repeat, true) => 2,
        (Wrap::MirroredRepeat, true) => 1,
        (Wrap::ClampToEdge, true) => 0,
    };
    for wrap_u in [Wrap::Repeat, Wrap::MirroredRepeat, Wrap::ClampToEdge] {
        for wrap_v in [Wrap::Repeat, Wrap::MirroredRepeat, Wrap::ClampToEdge] {
            let slot = board.texture(SIDE as u32, &picture(), TextureRole::Color, Sampler { wrap_u, wrap_v, ..SHARP });
            for (uv, back) in [(DVec2::splat(1.375), false), (DVec2::splat(-0.375), true)] {
                shows(&mut board, slot, uv, 0.0);
                let seen = linear(texel(beyond(wrap_u, back), beyond(wrap_v, back)));
                expected.push((format!("{wrap_u:?} {wrap_v:?} at {uv}"), seen));
            }
        }
    }
    compare(&board, &expected, "coordinates_wrap_along_each_axis_as_asked")
}

#[test]
fn filters_near_and_far_are_those_asked_for() -> TestResult {
    let mut board = Board::default();
    let mut expected = Vec::new();
    let mut add = |what: &str, sampler: Sampler, uv: DVec2, span: f64, seen: DVec3| {
        let slot = board.texture(SIDE as u32, &picture(), TextureRole::Color, sampler);
        shows(&mut board, slot, uv, span);
        expected.push((what.to_owned(), seen));
    };
    let (of, mean) = (|column, row| linear(texel(column, row)), |a: DVec3, b: DVec3| 0.5 * (a + b));
    let smooth = Sampler { mag: Filter::Linear, ..SHARP };
    // Magnification: between the second and third texel of the second row, slightly left of the center.
    let between = DVec2::new(0.499, 0.375);
    add("magnified, nearest", SHARP, between, 0.0, of(1, 1));
    add("magnified, linear", smooth, between, 0.0, mean(of(1, 1), of(2, 1)));
    // Minification: a pixel covers 4×4 texels, so level 0 shows the center texel, and the last level the mean.
    let whole = (0..SIDE * SIDE).map(|i| of(i % SIDE, i / SIDE)).sum::<DVec3>() / (SIDE * SIDE) as f64;
    let (far, middle) = (3.0, DVec2::new(0.625, 0.375));
    let minified = |min, mip| Sampler { min, mip, mag: Filter::Linear, ..SHARP };
    add("minified, one level, nearest", minified(Filter::Nearest, None), middle, far, of(2, 1));
    add("minified, one level, linear", minified(Filter::Linear, None), between, far, mean(of(1, 1), of(2, 1)));
    add("minified, nearest where magnified is linear", minified(Filter::Nearest, None), between, far, of(1, 1));
    add("minified, last level", minified(Filter::Nearest, Some(Filter::Nearest)), middle, far, whole);
    add("minified, last level, linear", minified(Filter::Linear, Some(Filter::Linear)), middle, far, whole);
    // Halfway between levels 0 and 1: a pixel covers √2 texels.
    let quarter = (of(2, 0) + of(3, 0) + of(2, 1) + of(3, 1)) / 4.0;
    let half_way = 3.0 * 2.0_f64.sqrt() / SIDE as f64;
    let blended = minified(Filter::Nearest, Some(Filter::Linear));
    add("between levels", blended, middle, half_way, mean(of(2, 1), quarter));
    let stepped = minified(Filter::Nearest, Some(Filter::Nearest));
    add("nearest level below", stepped, middle, half_way * 0.8, of(2, 1));
    add("nearest level above", stepped, middle, half_way * 1.25, quarter);
    compare(&board, &expected, "filters_near_and_far_are_those_asked_for")
}

/// KHR_texture_transform: scale, then counterclockwise rotation as seen, then translation.
#[test]
fn transforms_scale_turn_and_move() -> TestResult {
    let mut board = Board::default();
    let slot = board.texture(SIDE as u32, &picture(), TextureRole::Color, SHARP);
    let mut expected = Vec::new();
    let place = |column: usize, row: usize| DVec2::new(column as f64 + 0.5, row as f64 + 0.5) / SIDE as f64;
    let quarter = std::f32::consts::FRAC_PI_2;
    for (what, transform, uv, seen) in [
        ("as it is", UvTransform::default(), place(1, 2), (1, 2)),
        ("moved", UvTransform { offset: Vec2::new(0.25, 0.5), ..UvTransform::default() }, place(1, 1), (2, 3)),
        (
            "scaled",
            UvTransform { scale: Vec2::new(0.5, 3.0), ..UvTransform::default() },
            DVec2::new(0.75, 0.125),
            (1, 1),
        ),
        // (u, v) becomes (v, -u) and moves down by one.
        (
            "turned",
            UvTransform { rotation_rad: quarter, offset: Vec2::Y, ..UvTransform::default() },
            place(0, 2),
            (2, 3),
        ),
        (
            "scaled, then turned",
            UvTransform { rotation_rad: quarter, offset: Vec2::Y, scale: Vec2::new(0.5, 1.0) },
            DVec2::new(0.75, 0.625),
            (2, 2),
        ),
    ] {
        shows(&mut board, TextureSlot { transform, ..slot }, uv, 0.0);
        expected.push((what.to_owned(), linear(texel(seen.0, seen.1))));
    }
    compare(&board, &expected, "transforms_scale_turn_and_move")
}
