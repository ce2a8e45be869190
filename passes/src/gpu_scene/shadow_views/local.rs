//! Shadow maps of spot lights, and of the six cube faces of point lights.

use super::atlas::{self, Place};
use super::fitted::Fitted;
use super::settings::ShadowSettings;
use framegraph_scene::{Aabb, DrawLists, Light, LightKind, Renderables};
use glam::{DMat4, DVec3, DVec4};

/// Distance of a map's near plane from a punctual light, in meters.
const NEAR_M: f64 = 0.01;
/// Border of a face in texels, rendered beyond its edge so that filter taps near the edge are valid.
const GUARD_TEXELS: f64 = 2.0;

/// Cube faces of a point light: +x, -x, +y, -y, +z, -z, each with the axis to its right.
const FACES: [[DVec3; 2]; 6] = [
    [DVec3::X, DVec3::Z],
    [DVec3::NEG_X, DVec3::Z],
    [DVec3::Y, DVec3::X],
    [DVec3::NEG_Y, DVec3::X],
    [DVec3::Z, DVec3::X],
    [DVec3::NEG_Z, DVec3::X],
];

/// Returns the number of maps of a light: one for a spot light, six for a point light. 0 for directional lights and
/// for lights whose shadows have no strength.
pub(crate) fn maps_of(light: &Light) -> usize {
    match light.kind {
        _ if light.held_shadow_strength() == 0.0 => 0,
        LightKind::Directional { .. } => 0,
        LightKind::Spot { .. } => 1,
        LightKind::Point { .. } => 6,
    }
}

/// Returns the importance of a light for a viewer at `eye`: reach divided by distance, at most 1.
fn importance(light: &Light, reach_m: f64, eye: DVec3) -> f64 {
    let distance_m = (light.position - eye).length();
    (reach_m / distance_m.max(1e-6)).min(1.0)
}

/// Returns the distance that a light reaches within the scene.
fn reach_m(light: &Light, bounds: &Aabb) -> f64 {
    let (LightKind::Point { range_m, .. } | LightKind::Spot { range_m, .. }) = light.kind else { return 0.0 };
    let whole_m = (bounds.center() - light.position).length() + bounds.radius();
    range_m.map_or(whole_m, |range| f64::from(range).min(whole_m)).max(2.0 * NEAR_M)
}

/// Returns the indices of lights with maps, most important first, and the number of times that the side of a layer is
/// halved for each. All maps are halved further until they fit the layers. If even the smallest maps do not fit, the
/// least important lights have none.
fn chosen(lights: &[&Light], bounds: &Aabb, eye: DVec3, settings: &ShadowSettings) -> Vec<(usize, u32)> {
    let layer_texels = settings.map_texels;
    let mut order: Vec<(usize, f64)> = lights
        .iter()
        .enumerate()
        .filter(|(_, light)| maps_of(light) > 0)
        .map(|(i, light)| (i, importance(light, reach_m(light, bounds), eye)))
        .collect();
    order.sort_by(|a, b| b.1.total_cmp(&a.1));
    let mut room = usize::from(settings.local_maps());
    let mut chosen = Vec::new();
    for (index, importance) in order {
        if let Some(left) = room.checked_sub(maps_of(lights[index])) {
            room = left;
            chosen.push((index, atlas::halvings(importance, layer_texels)));
        }
    }
    let smallest = atlas::most_halvings(layer_texels);
    while atlas::layers(squares(lights, &chosen)) > settings.local_layers().into() {
        if chosen.iter().all(|(_, halved)| *halved == smallest) {
            chosen.pop();
        }
        chosen.iter_mut().for_each(|(_, halved)| *halved = smallest.min(*halved + 1));
    }
    chosen
}

/// Returns the number of halvings of each map, in the order of lights.
fn squares(lights: &[&Light], chosen: &[(usize, u32)]) -> Vec<u32> {
    chosen.iter().flat_map(|(index, halved)| std::iter::repeat_n(*halved, maps_of(lights[*index]))).collect()
}

/// Returns the number of layers that the maps of `lights` share in a scene within `bounds`.
pub(crate) fn layers(bounds: &Aabb, lights: &[&Light], eye: DVec3, settings: &ShadowSettings) -> u64 {
    atlas::layers(squares(lights, &chosen(lights, bounds, eye, settings)))
}

/// Returns the index of the first map of each light, if any, and the maps.
pub(crate) fn fit(
    scene: &Renderables,
    lights: &[&Light],
    eye: DVec3,
    settings: &ShadowSettings,
) -> (Vec<Option<u32>>, Vec<Fitted>) {
    let bounds = scene.whole();
    let chosen = chosen(lights, &bounds, eye, settings);
    let cascades = settings.cascades;
    let behind = |place: Place| Place { layer: place.layer + u16::from(cascades), ..place };
    let mut places = atlas::pack(&squares(lights, &chosen), settings.map_texels).into_iter().map(behind);
    let (mut starts, mut maps) = (vec![None; lights.len()], Vec::new());
    for (index, _) in chosen {
        let light = lights[index];
        starts[index] = Some(maps.len() as u32);
        let (position, far_m) = (light.position, reach_m(light, &bounds));
        // Same number of maps as the light has squares.
        match light.kind {
            LightKind::Directional { .. } => {}
            LightKind::Point { .. } => {
                for ([direction, right], place) in FACES.into_iter().zip(&mut places) {
                    maps.push(LocalView { position, direction, right, tan_half: 1.0, far_m, place }.fit(scene));
                }
            }
            LightKind::Spot { outer_cone_rad, .. } => {
                let direction = light.direction.as_dvec3();
                // A half angle of 90° would need an infinite map.
                let tan_half = f64::from(outer_cone_rad).min(1.55).tan();
                let right = if direction.y.abs() > 0.99 { DVec3::X } else { direction.cross(DVec3::Y).normalize() };
                let right = (right - direction * direction.dot(right)).normalize();
                let views = places.next().map(|place| LocalView { position, direction, right, tan_half, far_m, place });
                maps.extend(views.map(|view| view.fit(scene)));
            }
        }
    }
    (starts, maps)
}

/// Perspective view of a punctual light.
struct LocalView {
    position: DVec3,
    direction: DVec3,
    right: DVec3,
    tan_half: f64,
    far_m: f64,
    place: Place,
}

impl LocalView {
    fn fit(&self, scene: &Renderables) -> Fitted {
        let Self { position, direction, right, far_m, place, .. } = *self;
        let count = f64::from(place.texels.max(8));
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
        scene.boxes().reaching(DVec3::ZERO, &planes, None, &mut casters);
        let draws = |number: usize| scene.casts()[number] && inside(&scene.bounds()[number]);
        casters.retain(|number| draws(*number as usize));
        let texel_m = 2.0 * tan_half / count;
        Fitted {
            clip_from_world: clip,
            linear_depth: w / range - DVec4::W * (near / range),
            axes: [right, up, -direction],
            texel_m: [texel_m; 2],
            depth_m: range,
            near_over_range: near / range,
            casters: DrawLists::of_kinds(scene, casters),
            place,
        }
    }
}
