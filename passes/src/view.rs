//! The view of one frame: camera, exposure, sun and lights, as the shaders read them, and what is drawn.
//!
//! Positions are sent relative to the eye, subtracted in double precision, so that a scene a thousand kilometers from its
//! origin does not jitter. Lights are multiplied by the exposure here, in f32: what the shaders see fits half floats.

use crate::ibl::ImageLight;
use crate::shadow;
use framegraph_scene::camera::exposure_from_ev100;
use framegraph_scene::{Camera, DrawLists, Light, LightKind, Projection, Scene};
use framegraph_shaders::layout::{
    FrameUniforms, LightUniforms, ObjectUniforms, Punctual, ShadowViewUniforms, SkyUniforms,
};
use framegraph_shaders::reference::sky::Preetham;
use glam::{DMat4, DVec3, Mat4, Vec2, Vec3, Vec4};

/// What a view is asked for.
#[derive(Clone, Debug)]
pub struct ViewSettings {
    /// Where from, and what of.
    pub camera: Camera,
    /// Width and height of the picture in pixels.
    pub size_px: [u32; 2],
    /// Exposure value at ISO 100.
    pub ev100: f32,
    /// Factor on the environment's radiance, as light and as a background.
    pub environment_intensity: f32,
    /// Width and height of the shadow map in texels; none leaves it out.
    pub shadow_map_texels: Option<u32>,
    /// Counts frames: moves the dither.
    pub frame_index: u32,
}

/// What stands behind everything.
#[derive(Clone, Debug)]
pub enum Background {
    /// Nothing: black.
    None,
    /// The environment map.
    Environment,
    /// A clear sky with the sun's disc.
    ClearSky(Preetham),
    /// The same radiance in every direction, in nits, linear Rec.709; it lights nothing.
    Constant(Vec3),
}

/// A background, exposed.
#[derive(Clone, Copy, Debug)]
pub enum Drawn {
    /// Nothing: black.
    None,
    /// The environment map.
    Environment,
    /// A clear sky with the sun's disc.
    ClearSky(SkyUniforms),
    /// The same radiance in every direction.
    Constant(SkyUniforms),
}

impl Drawn {
    fn of(background: &Background, exposure: f32, environment_scale: f32) -> Self {
        match background {
            Background::None => Self::None,
            Background::Environment => Self::Environment,
            Background::ClearSky(sky) => Self::ClearSky(SkyUniforms::new(sky, environment_scale, true)),
            Background::Constant(nits) => Self::Constant(SkyUniforms::constant(*nits * exposure)),
        }
    }
}

/// One frame's view, ready to be recorded.
#[derive(Clone, Debug)]
pub struct View {
    /// Camera, sun, shadow and ambient light.
    pub frame: FrameUniforms,
    /// The sun's view of the casters.
    pub shadow: ShadowViewUniforms,
    /// What the camera sees, sorted.
    pub seen: DrawLists,
    /// What casts shadows.
    pub casters: DrawLists,
    /// What stands behind everything.
    pub background: Drawn,
    /// Punctual lights; at least one, so that there is something to bind. `frame.light_count` says how many count.
    pub lights: Vec<LightUniforms>,
    /// Placement of each instance, relative to the eye.
    pub objects: Vec<ObjectUniforms>,
}

/// The largest offset along the normal, in shadow texels, for a surface that the sun sees edge-on.
const NORMAL_BIAS_TEXELS: f32 = 1.5;

impl View {
    /// Works out a view of `scene`, lit from all around by `light`. The sun is the environment's own, else the scene's
    /// brightest directional light; all other lights are punctual.
    pub fn new(scene: &Scene, light: &ImageLight, background: &Background, settings: &ViewSettings) -> Self {
        let ViewSettings { camera, size_px, ev100, environment_intensity, shadow_map_texels, frame_index } = settings;
        let [width, height] = *size_px;
        let aspect = f64::from(width.max(1)) / f64::from(height.max(1));
        let exposure = exposure_from_ev100(*ev100);
        let (sun, rest) = sun_and_rest(scene, light);
        let sun_of = |of: fn(&Light) -> Vec3| sun.map_or(Vec3::Y, of);
        let toward_sun = sun_of(|light| -light.direction);

        let clip_from_world = camera.clip_from_view(aspect) * DMat4::from_quat(camera.world_from_view.inverse());
        let bounds = scene.bounds();
        let texels = shadow_map_texels.unwrap_or(1);
        let sun_view = shadow::fit(&bounds, &bounds, toward_sun.as_dvec3(), camera.eye, texels);
        let environment_scale = environment_intensity * exposure;
        let mut lights: Vec<_> = rest.iter().filter_map(|light| punctual(light, camera.eye, exposure)).collect();
        let light_count = lights.len() as u32;
        lights.resize(lights.len().max(1), LightUniforms::default());

        let frame = FrameUniforms {
            clip_from_world: clip_from_world.as_mat4(),
            world_from_clip: inverse(clip_from_world).as_mat4(),
            world_from_view: Mat4::from_quat(camera.world_from_view.as_quat()),
            shadow_clip_from_world: sun_view.clip_from_world.as_mat4(),
            camera: viewer(camera),
            sun_direction: toward_sun,
            sun_angular_radius: sun.map_or(0.0, angular_radius),
            sun_illuminance: sun.map_or(Vec3::ZERO, |light| light.color * strength(light) * exposure),
            exposure,
            viewport_size_px: Vec2::new(width as f32, height as f32),
            shadow_texel_uv: Vec2::splat(1.0 / texels as f32),
            shadow_texel_m: sun_view.texel_m as f32,
            shadow_normal_bias_texels: NORMAL_BIAS_TEXELS,
            environment_rotation: Vec2::X,
            environment_scale,
            light_count,
            frame_index: *frame_index,
            time_s: 0.0,
            specular_scale: environment_scale * light.texel_nits,
            roughness_one_lod: light.roughness_one_lod,
            _pad: Vec2::ZERO,
            sh: light.exposed_irradiance(environment_scale),
        };
        Self {
            frame,
            shadow: ShadowViewUniforms { clip_from_world: frame.shadow_clip_from_world },
            seen: DrawLists::for_camera(scene, camera, aspect),
            casters: DrawLists::of_scene(scene),
            background: Drawn::of(background, exposure, environment_scale),
            lights,
            objects: scene.instances.iter().map(|i| ObjectUniforms::new(i.relative_from_model(camera.eye))).collect(),
        }
    }
}

/// The eye, which is the origin, or the direction toward the viewer of a parallel projection.
fn viewer(camera: &Camera) -> Vec4 {
    match camera.projection {
        Projection::Perspective { .. } => Vec4::W,
        Projection::Orthographic { .. } => (-camera.forward()).as_vec3().extend(0.0),
    }
}

/// The inverse, by whole-matrix inversion in f64; an infinite far plane has one too.
fn inverse(matrix: DMat4) -> DMat4 {
    let inverse = matrix.inverse();
    if inverse.is_finite() { inverse } else { DMat4::IDENTITY }
}

fn strength(light: &Light) -> f32 {
    match light.kind {
        LightKind::Directional { illuminance_lux, .. } => illuminance_lux,
        LightKind::Point { intensity_candela, .. } | LightKind::Spot { intensity_candela, .. } => intensity_candela,
    }
}

fn angular_radius(light: &Light) -> f32 {
    match light.kind {
        LightKind::Directional { angular_radius_rad, .. } => angular_radius_rad,
        _ => 0.0,
    }
}

/// The light that casts the shadow, and all others that are on.
fn sun_and_rest<'a>(scene: &'a Scene, image: &'a ImageLight) -> (Option<&'a Light>, Vec<&'a Light>) {
    let directional = |light: &&Light| matches!(light.kind, LightKind::Directional { .. }) && light.is_on();
    let brightest = || scene.lights.iter().filter(directional).max_by(|a, b| strength(a).total_cmp(&strength(b)));
    let own = image.sun.as_ref().filter(|sun| sun.is_on());
    let sun = own.or_else(brightest);
    let is_sun = |light: &&Light| sun.is_some_and(|sun| std::ptr::eq(sun, *light));
    (sun, scene.lights.iter().filter(|l| l.is_on() && !is_sun(l)).collect())
}

/// A light as the shader reads it, relative to the eye; none for one that cannot be used (import has said so).
fn punctual(light: &Light, eye: DVec3, exposure: f32) -> Option<LightUniforms> {
    let position = (light.position - eye).as_vec3();
    let direction = light.direction;
    let shape = match light.kind {
        LightKind::Directional { .. } => Punctual::Directional { direction },
        LightKind::Point { range_m, .. } => Punctual::Point { position, range_m },
        LightKind::Spot { range_m, inner_cone_rad, outer_cone_rad, .. } => {
            Punctual::Spot { position, direction, range_m, inner_cone_rad, outer_cone_rad }
        }
    };
    LightUniforms::punctual(shape, light.color, strength(light), exposure).ok()
}
