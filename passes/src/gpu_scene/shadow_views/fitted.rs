//! View of one shadow map: projection, texel size and casters.

use super::atlas::Place;
use super::settings::ShadowSettings;
use crate::gpu_scene::placements::Placements;
use framegraph_scene::levels::level_of;
use framegraph_scene::{Aabb, DrawLists, Renderables};
use framegraph_shaders::layout::{ShadowMapUniforms, ShadowViewUniforms};
use glam::{DMat4, DVec3, DVec4};

/// Fitted view of a light, in world coordinates and double precision.
#[derive(Clone, Debug)]
pub(crate) struct Fitted {
    /// Transform from world to clip space; depth is reversed: 1 nearest to the light, 0 farthest.
    pub clip_from_world: DMat4,
    /// Plane that maps a world position to its distance from the light: 0 at the near end of the map, 1 at the far
    /// end.
    pub linear_depth: DVec4,
    /// Unit axes: two across the map, one toward the light (for a cube face, against its direction).
    pub axes: [DVec3; 3],
    /// World size of a texel along the first two axes in meters, for w = 1. The first grows with w; the second too,
    /// or with its square for a warped map.
    pub texel_m: [f64; 2],
    /// Depth range in meters where w = 1; for directional lights.
    pub depth_m: f64,
    /// near / (far - near) of a perspective map; 0 for directional lights.
    pub near_over_range: f64,
    /// Casters.
    pub casters: DrawLists,
    /// Rectangle of the map.
    pub place: Place,
}

impl Fitted {
    /// Creates a map without shadows: every point is outside of it, in front of its near end.
    pub fn empty() -> Self {
        Self {
            clip_from_world: DMat4::from_cols(DVec4::ZERO, DVec4::ZERO, DVec4::ZERO, DVec4::new(0.0, 0.0, 2.0, 1.0)),
            linear_depth: DVec4::ZERO,
            axes: [DVec3::X, DVec3::Y, DVec3::Z],
            texel_m: [1.0; 2],
            depth_m: 1.0,
            near_over_range: 0.0,
            casters: DrawLists::default(),
            place: Place::default(),
        }
    }
}

impl Fitted {
    /// Returns true if texels grow with the square of w along the second axis.
    fn is_warped(&self) -> bool {
        self.clip_from_world.transpose().w_axis.truncate() != DVec3::ZERO && self.near_over_range == 0.0
    }

    /// Limits levels of detail to a displacement of this many texels.
    pub fn limit_levels(&self, scene: &Renderables, error_texels: f64, levels: &mut [u8]) {
        let row = self.clip_from_world.transpose().w_axis;
        let (warped, along) = (self.is_warped(), row.truncate());
        // Texels per meter: along both axes, and through the change of w, at the edge of the map.
        let most_texels = |bounds: &Aabb| {
            let w = (along.dot(bounds.center()) + row.w - along.abs().dot(bounds.half_extent())).max(1e-9);
            let [first, second] = [w, if warped { w * w } else { w }];
            let of = [first * self.texel_m[0], second * self.texel_m[1]].map(|texel_m| 1.0 / texel_m);
            DVec3::new(of[0], of[1], 0.5 * f64::from(self.place.texels) * along.length() / w).length()
        };
        let most_m = |i: u32| error_texels / most_texels(&scene.bounds()[i as usize]);
        scene.levels().limit(levels, self.casters.opaque.iter().chain(&self.casters.mask), most_m);
    }
}

/// Source of the penumbra width.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Penumbra {
    /// Radius of a bulb in meters.
    Bulb(f32),
    /// Tangent of the angular radius of a disc at infinity.
    Disc(f32),
}

/// A shadow map of a view, as drawn and as read by shaders.
#[derive(Clone, Debug)]
pub struct ShadowMap {
    /// Transform from world to the light's clip space.
    pub(crate) clip_from_world: DMat4,
    /// Uniforms for shading, relative to the eye.
    pub uniforms: ShadowMapUniforms,
    /// Uniforms for drawing casters, relative to the eye.
    pub view: ShadowViewUniforms,
    /// Casters.
    pub casters: DrawLists,
    /// Rectangle of the map in its layer.
    pub place: Place,
}

impl ShadowMap {
    /// Returns the map relative to `eye`, which is subtracted in double precision.
    pub(crate) fn new(fitted: Fitted, eye: DVec3, settings: &ShadowSettings, penumbra: Penumbra) -> Self {
        let ShadowSettings { map_texels, filter, bias, .. } = *settings;
        // With moments, the variance replaces the bias. The normal bias counts half texels, as Filament's does.
        let biases = if settings.has_moments() { [0.0; 2] } else { [bias.constant_m, 0.5 * bias.normal] };
        let [back_m, offset_texels] = biases.map(f64::from);
        let Fitted { axes: [right, up, toward], linear_depth, place, .. } = fitted;
        let share = |texels: u32| texels as f32 / map_texels.max(1) as f32;
        let clip_from_relative = fitted.clip_from_world * DMat4::from_translation(eye);
        let linear = linear_depth.truncate().extend(linear_depth.truncate().dot(eye) + linear_depth.w);
        // Casters move away from the light.
        let drawn = clip_from_relative * DMat4::from_translation(-toward * back_m);
        let (bulb_m, tan_radius) = match penumbra {
            Penumbra::Bulb(radius_m) => (radius_m, 0.0),
            Penumbra::Disc(tangent) => (0.0, tangent),
        };
        let warped = fitted.is_warped();
        Self {
            clip_from_world: fitted.clip_from_world,
            uniforms: ShadowMapUniforms {
                clip_from_world: clip_from_relative.as_mat4(),
                linear_depth: linear.as_vec4(),
                right: (right * fitted.texel_m[0] * offset_texels).as_vec3(),
                texel_right_m: fitted.texel_m[0] as f32,
                up: (up * fitted.texel_m[1] * offset_texels).as_vec3(),
                texel_up_m: fitted.texel_m[1] as f32,
                depth_m: fitted.depth_m as f32,
                near_over_range: fitted.near_over_range as f32,
                bulb_m,
                tan_radius,
                uv_corner: place.corner.map(share).into(),
                uv_scale: share(place.texels),
                last_level: place.last_level(settings.moments.levels, map_texels).into(),
                layer: place.layer.into(),
                warped: u32::from(warped),
                _pad: [0; 2],
            },
            view: ShadowViewUniforms {
                clip_from_world: drawn.as_mat4(),
                linear_depth: linear.as_vec4(),
                exponent: filter.exponent(),
                _pad: [0.0; 3],
            },
            casters: fitted.casters,
            place,
        }
    }
}

/// Inputs of a map: equal keys make equal maps.
#[derive(Clone, Debug)]
pub(crate) struct MapKey {
    /// Transform from world to the light's clip space.
    clip_from_world: DMat4,
    /// Rectangle of the map.
    place: Place,
    /// Instance numbers of the casters, and the level of detail of each.
    casters: Vec<(u32, u8)>,
    /// Transforms of all instances.
    placements: Placements,
}

impl MapKey {
    /// Returns the inputs of `map`.
    pub fn new(map: &ShadowMap, placements: &Placements, levels: &[u8]) -> Self {
        let casters = map.casters.opaque.iter().chain(&map.casters.mask);
        Self {
            clip_from_world: map.clip_from_world,
            place: map.place,
            casters: casters.map(|number| (*number, level_of(levels, *number))).collect(),
            placements: placements.clone(),
        }
    }

    /// Returns true if both maps draw the same casters at the same places.
    pub fn has_casters_of(&self, other: &Self) -> bool {
        let same = |(number, _): &(u32, u8)| self.placements.is_same(&other.placements, *number as usize);
        self.casters == other.casters && self.casters.iter().all(same)
    }
}

impl PartialEq for MapKey {
    fn eq(&self, other: &Self) -> bool {
        (self.clip_from_world, self.place) == (other.clip_from_world, other.place) && self.has_casters_of(other)
    }
}
