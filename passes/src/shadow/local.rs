//! Maps of spot lights and of the six faces about point lights.

use super::fitted::Fitted;
use super::settings::ShadowSettings;
use framegraph_scene::{Aabb, DrawLists, Light, LightKind, Renderables};
use glam::{DMat4, DVec3, DVec4};

/// Distance of a local map's near plane from the light, in meters.
const NEAR_M: f64 = 0.01;
/// Texels around a face that belong to its neighbors, so that taps near an edge find what is there.
const GUARD_TEXELS: f64 = 2.0;
/// The smallest map, in texels.
const LEAST_TEXELS: u32 = 64;

/// Faces about a point light: +x, -x, +y, -y, +z, -z, each with the axis that is to its right.
const FACES: [[DVec3; 2]; 6] = [
    [DVec3::X, DVec3::Z],
    [DVec3::NEG_X, DVec3::Z],
    [DVec3::Y, DVec3::X],
    [DVec3::NEG_Y, DVec3::X],
    [DVec3::Z, DVec3::X],
    [DVec3::NEG_Z, DVec3::X],
];

/// Maps that a light takes: one for a spot, six for a point; a parallel light that is not the sun has none.
pub(super) fn maps_of(light: &Light) -> usize {
    match light.kind {
        LightKind::Directional { .. } => 0,
        LightKind::Spot { .. } => 1,
        LightKind::Point { .. } => 6,
    }
}

/// What a light is worth to a viewer at `eye`: the share of the view that it fills, as its reach over its distance, at most 1.
fn importance(light: &Light, reach_m: f64, eye: DVec3) -> f64 {
    let distance_m = (light.position - eye).length();
    (reach_m / distance_m.max(1e-6)).min(1.0)
}

/// How far a light reaches into the scene.
fn reach_m(light: &Light, bounds: &Aabb) -> f64 {
    let (LightKind::Point { range_m, .. } | LightKind::Spot { range_m, .. }) = light.kind else { return 0.0 };
    let whole_m = (bounds.center() - light.position).length() + bounds.radius();
    range_m.map_or(whole_m, |range| f64::from(range).min(whole_m)).max(2.0 * NEAR_M)
}

/// For each light of `lights` the number of its first map, counted from `first`, if it has any; and the maps. The most
/// important lights come first, as many as have room.
pub(super) fn fit(
    scene: &Renderables,
    lights: &[&Light],
    eye: DVec3,
    settings: &ShadowSettings,
    first: usize,
) -> (Vec<Option<u32>>, Vec<Fitted>) {
    let bounds = scene.whole();
    let mut order: Vec<(usize, f64)> = lights
        .iter()
        .enumerate()
        .filter(|(_, light)| maps_of(light) > 0)
        .map(|(i, light)| (i, importance(light, reach_m(light, &bounds), eye)))
        .collect();
    order.sort_by(|a, b| b.1.total_cmp(&a.1));
    let (mut starts, mut maps) = (vec![None; lights.len()], Vec::new());
    for (index, importance) in order {
        let light = lights[index];
        if maps.len() + maps_of(light) > usize::from(settings.local_maps) {
            continue;
        }
        starts[index] = Some((first + maps.len()) as u32);
        let texels = texels_of(importance, settings.map_texels);
        let far_m = reach_m(light, &bounds);
        match light.kind {
            LightKind::Point { .. } => {
                for [direction, right] in FACES {
                    let view = LocalView { position: light.position, direction, right, tan_half: 1.0, far_m, texels };
                    maps.push(view.fit(scene));
                }
            }
            _ => {
                let LightKind::Spot { outer_cone_rad, .. } = light.kind else { continue };
                let direction = light.direction.as_dvec3();
                // A cone of half a turn would need a map without end.
                let tan_half = f64::from(outer_cone_rad).min(1.55).tan();
                let right = if direction.y.abs() > 0.99 { DVec3::X } else { direction.cross(DVec3::Y).normalize() };
                let right = (right - direction * direction.dot(right)).normalize();
                let view = LocalView { position: light.position, direction, right, tan_half, far_m, texels };
                maps.push(view.fit(scene));
            }
        }
    }
    (starts, maps)
}

/// Texels of a map, halved with each halving of importance.
fn texels_of(importance: f64, most: u32) -> u32 {
    let halvings = (-importance.max(1e-6).log2()).floor() as u32;
    (most >> halvings.min(16)).max(LEAST_TEXELS.min(most))
}

/// A pyramid of light.
struct LocalView {
    position: DVec3,
    direction: DVec3,
    right: DVec3,
    tan_half: f64,
    far_m: f64,
    texels: u32,
}

impl LocalView {
    fn fit(&self, scene: &Renderables) -> Fitted {
        let Self { position, direction, right, far_m, texels, .. } = *self;
        let count = f64::from(texels.max(8));
        let tan_half = self.tan_half * count / (count - 2.0 * GUARD_TEXELS);
        let up = right.cross(direction);
        let plane = |axis: DVec3| axis.extend(-axis.dot(position));
        let (near, range) = (NEAR_M, far_m - NEAR_M);
        let w = plane(direction);
        let z = (DVec4::W * far_m - w) * (near / range);
        let clip = DMat4::from_cols(plane(right) / tan_half, plane(up) / tan_half, z, w).transpose();
        let sides = [plane(right), plane(up)].map(|side| [w * tan_half - side, w * tan_half + side]);
        let inside = |bounds: &Aabb| {
            let (center, half) = (bounds.center(), bounds.half_extent());
            let reaches = |p: &DVec4| p.truncate().dot(center) + p.w + p.truncate().abs().dot(half) >= 0.0;
            sides.iter().flatten().chain([&w]).all(reaches)
                && !bounds.is_empty()
                && (bounds.min.max(position.min(bounds.max)) - position).length() <= far_m
        };
        let planes: Vec<DVec4> = sides.into_iter().flatten().chain([w]).collect();
        let mut casters = Vec::new();
        scene.boxes().reaching(DVec3::ZERO, &planes, 1, &mut casters);
        let draws = |number: usize| scene.kinds()[number].leaves_depth() && inside(&scene.bounds()[number]);
        casters.retain(|number| draws(*number as usize));
        let texel_m = 2.0 * tan_half / count;
        Fitted {
            clip_from_world: clip,
            linear_depth: w / range - DVec4::W * (near / range),
            axes: [right, up, -direction],
            texel_m: [texel_m; 2],
            depth_m: range,
            near_over_range: near / range,
            casters: DrawLists::of_kinds(scene, &casters),
            texels,
        }
    }
}
