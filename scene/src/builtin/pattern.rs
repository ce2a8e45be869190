//! Procedural images for the textures of built-in scenes. All tile.

use std::f32::consts::TAU;

use glam::{Vec2, Vec3, Vec4};

use crate::color::srgb_from_linear;
use crate::texture::Image;

/// Returns an image of `side` × `side` texels. `texel` maps a texel center in 0…1 to channels in 0…1, stored without
/// conversion.
fn image(name: &str, side: u32, texel: impl Fn(Vec2) -> Vec4) -> Image {
    let mut rgba8 = Vec::with_capacity((side * side * 4) as usize);
    for y in 0..side {
        for x in 0..side {
            let uv = (Vec2::new(x as f32, y as f32) + 0.5) / side as f32;
            let code = texel(uv).clamp(Vec4::ZERO, Vec4::ONE) * 255.0 + 0.5;
            rgba8.extend(code.to_array().map(|c| c as u8));
        }
    }
    Image::from_rgba8(name, side, side, rgba8)
}

/// Encodes a linear color as sRGB; all values are in 0…1, alpha is unchanged.
fn encoded(linear: Vec3, alpha: f32) -> Vec4 {
    Vec3::from_array(linear.to_array().map(srgb_from_linear)).extend(alpha)
}

/// Returns a checkerboard of two by two squares in linear Rec.709 colors; role `Color`.
pub(super) fn checker(name: &str, side: u32, dark: Vec3, light: Vec3) -> Image {
    image(name, side, |uv| {
        let odd = (uv.x < 0.5) != (uv.y < 0.5);
        encoded(if odd { light } else { dark }, 1.0)
    })
}

/// Returns squares that alternate between two roughnesses, one of them metallic; role `Linear` (G roughness, B
/// metallic).
pub(super) fn inlay(name: &str, side: u32, metal_roughness: f32, rest_roughness: f32) -> Image {
    image(name, side, |uv| {
        let cell = (uv * 2.0).fract() - 0.5;
        let metal = cell.length() < 0.33;
        let (g, b) = if metal { (metal_roughness, 1.0) } else { (rest_roughness, 0.0) };
        Vec4::new(1.0, g, b, 1.0)
    })
}

/// Returns the height (0…1) of a field of `count` × `count` round bumps.
fn bumps_height(uv: Vec2, count: f32) -> f32 {
    let cell = (uv * count).fract() - 0.5;
    let d = cell.length() / 0.42;
    if d < 1.0 { (1.0 - d * d).sqrt() } else { 0.0 }
}

/// Returns `count` × `count` hemispherical bumps as tangent-space normals, green up; role `Normal`. `relief` is the
/// height of a bump relative to its radius.
pub(super) fn bumps(name: &str, side: u32, count: f32, relief: f32) -> Image {
    image(name, side, |uv| {
        let cell = (uv * count).fract() - 0.5;
        let d = cell / 0.42;
        let normal = if d.length_squared() < 0.98 {
            // The slope of √(1 − d²) is −d/√(1 − d²); v grows downward, green upward.
            let slope = d * (relief / (1.0 - d.length_squared()).sqrt());
            Vec3::new(slope.x, -slope.y, 1.0).normalize()
        } else {
            Vec3::Z
        };
        (normal * 0.5 + 0.5).extend(1.0)
    })
}

/// Returns the ambient occlusion between the bumps of [`bumps`]; role `Linear` (R).
pub(super) fn bumps_occlusion(name: &str, side: u32, count: f32) -> Image {
    image(name, side, |uv| {
        let open = 0.35 + 0.65 * bumps_height(uv, count);
        Vec4::new(open, 1.0, 1.0, 1.0)
    })
}

/// Returns a lattice of leaves: alpha is 1 inside leaves and 0 outside, with an edge a few texels soft for filtering;
/// role `Color`.
pub(super) fn leaves(name: &str, side: u32) -> Image {
    image(name, side, |uv| {
        let cell = (uv * 2.0).fract() - 0.5;
        // A leaf is the intersection of two discs, offset along its diagonal.
        let offset = Vec2::new(0.18, 0.18);
        let d = (cell - offset).length().max((cell + offset).length());
        let alpha = ((0.50 - d) * side as f32 / 8.0 + 0.5).clamp(0.0, 1.0);
        let vein = (cell.x + cell.y).abs() * 6.0;
        let green = Vec3::new(0.06, 0.22, 0.03).lerp(Vec3::new(0.16, 0.42, 0.06), vein.min(1.0));
        encoded(green, alpha)
    })
}

/// Returns a grid of bright lines on black; role `Color`.
pub(super) fn grid_lines(name: &str, side: u32, color: Vec3) -> Image {
    image(name, side, |uv| {
        let wave = (uv * TAU * 4.0).to_array().map(f32::cos);
        let line = wave[0].max(wave[1]);
        let glow = ((line - 0.9) * 10.0).clamp(0.0, 1.0);
        encoded(color * glow, 1.0)
    })
}
