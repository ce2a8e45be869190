//! Views of a scene: camera, exposure, sun and lights in the layout of shaders, and draw lists.
//!
//! Positions are relative to the eye and subtracted in double precision, so that a scene 1000 km from its origin does
//! not jitter. Lights are multiplied by the exposure in f32, so that their values fit half floats.
//!
//! A frame may have several views ([`Views`]). Each view has its own buffers for eye-relative data and draw lists. All
//! views share the meshes, materials and textures of the scene.

mod blended;
mod gpu;
mod levels;
mod motion;
mod stereo;

pub use gpu::{GpuView, ViewId, Views};

use crate::gpu_scene::draws::ViewDraws;
use crate::gpu_scene::placements::{CHUNK, Placements};
use crate::gpu_scene::prepared::PreparedScene;
use crate::gpu_scene::previous_view::PreviousView;
use crate::gpu_scene::punctual;
use crate::gpu_scene::punctual::{LightLists, LightReport, LightSearch};
use crate::gpu_scene::shadow_views::{FitCamera, ShadowSettings, ViewShadows};
use crate::gpu_scene::upload::pack::light_uniforms;
use crate::gpu_scene::view::blended::blended_range;
use crate::gpu_scene::view::motion::Moment;
use crate::light::ibl::ImageLight;
use crate::light::sun::{angular_radius_rad, halo_of, illuminance_lux, sun_of};
use framegraph_scene::camera::exposure_from_ev100;
use framegraph_scene::environment::{Sky, sun_light};
use framegraph_scene::{Camera, DrawLists, Light, Projection, Scene, SunHalo};
use framegraph_shaders::layout::{EyeUniforms, FrameUniforms, LightUniforms, MotionUniforms, SkyUniforms};
use framegraph_shaders::reference::sky::Preetham;
use glam::{DMat4, DVec2, DVec3, Mat4, Vec2, Vec3, Vec4};

/// Settings of a view.
#[derive(Clone, Debug)]
pub struct ViewSettings {
    /// Camera position, direction and projection.
    pub camera: Camera,
    /// Width and height of the picture in pixels.
    pub size_px: [u32; 2],
    /// Exposure value at ISO 100.
    pub ev100: f32,
    /// Factor on the environment's radiance, as light and as a background.
    pub environment_intensity: f32,
    /// Settings of shadow maps; `None` disables shadows.
    pub shadows: Option<ShadowSettings>,
    /// Method of finding the punctual lights that reach a point.
    pub lights: LightSearch,
    /// Maximum geometric error of [levels of detail](framegraph_scene::MeshLevel), in pixels and in shadow-map texels.
    /// 0 draws full meshes.
    pub lod_error_px: f32,
    /// Visible layers as a bit mask ([`DrawOptions::layers`](framegraph_scene::DrawOptions::layers)); 1 by default, as
    /// Filament's `View::setVisibleLayers`.
    pub visible_layers: u8,
}

/// 1280×720 pixels of the default camera, exposed for a sunny day (14.5 EV100), with shadows and full meshes.
impl Default for ViewSettings {
    fn default() -> Self {
        Self {
            camera: Camera::default(),
            size_px: [1280, 720],
            ev100: 14.5,
            environment_intensity: 1.0,
            shadows: Some(ShadowSettings::DEFAULT),
            lights: LightSearch::default(),
            lod_error_px: 0.0,
            visible_layers: 1,
        }
    }
}

/// Background of a view.
#[derive(Clone, Debug)]
pub enum Background {
    /// Black.
    None,
    /// The environment map.
    Environment,
    /// A clear sky with the sun's disc.
    ClearSky(Preetham),
    /// Uniform radiance in nits, linear Rec.709. It does not light the scene.
    Constant(Vec3),
}

impl Background {
    /// Returns a clear sky as a background. Its sun lights the ground below the horizon.
    pub fn clear_sky(sky: &Sky) -> Self {
        let sun_lux = sun_light(sky.toward_sun, sky.turbidity)
            .map_or(DVec3::ZERO, |sun| sun.color.as_dvec3() * f64::from(illuminance_lux(&sun)));
        Self::ClearSky(Preetham::new(sky.toward_sun, sky.turbidity, sky.ground_albedo, sun_lux))
    }
}

/// [`Background`] in the layout of the sky shader, multiplied by the exposure.
#[derive(Clone, Copy, Debug)]
pub enum BackgroundUniforms {
    /// Black.
    None,
    /// The environment map.
    Environment,
    /// A clear sky with the sun's disc.
    ClearSky(SkyUniforms),
    /// Uniform radiance.
    Constant(SkyUniforms),
}

impl BackgroundUniforms {
    fn new(background: &Background, exposure: f32, environment_scale: f32) -> Self {
        match background {
            Background::None => Self::None,
            Background::Environment => Self::Environment,
            Background::ClearSky(sky) => Self::ClearSky(SkyUniforms::new(sky, environment_scale)),
            Background::Constant(nits) => Self::Constant(SkyUniforms::constant(*nits * exposure)),
        }
    }
}

/// Maximum number of instances of a scene for streamed objects ([`CameraView::streams_objects`]).
pub const MAX_STREAMED: usize = CHUNK;

/// One view of one frame, on the CPU.
#[derive(Clone, Debug)]
pub struct CameraView {
    /// Camera, sun and ambient light.
    pub frame: FrameUniforms,
    /// Visible instances, by kind of draw.
    pub visible: DrawLists,
    /// Background.
    pub background: BackgroundUniforms,
    /// Angular radius of the sun's disc in radians, and its halo, if they are drawn.
    pub sun_halo: Option<(f32, SunHalo)>,
    /// Punctual lights. Never empty, so that a binding exists; `frame.light_count` is the number of lights.
    pub lights: Vec<LightUniforms>,
    /// Lists of punctual lights by froxel; `None` if every light is evaluated everywhere.
    pub light_lists: Option<LightLists>,
    /// Light channels of the sun.
    pub sun_channels: u8,
    /// True if some punctual light and some instance share no light channel.
    pub channels_differ: bool,
    /// Lights that are kept, and lights that are dropped with the reason.
    pub light_report: LightReport,
    /// Draw lists of the view.
    pub draws: ViewDraws,
    /// Points that translations of instances are relative to, in m relative to the eye.
    pub origins: Vec<Vec4>,
    /// View-independent transforms of instances.
    pub placements: Placements,
    /// True if the instance stream contains the objects: one copy for each list that draws an instance, uploaded
    /// whenever the view changes. Scenes of more than [`MAX_STREAMED`] instances read objects from a shared buffer
    /// instead. The picture does not change.
    pub streams_objects: bool,
    /// Current and previous transforms to clip space, if an instance moved since the previous frame. Zeros for
    /// instances that did not move.
    pub motions: Vec<MotionUniforms>,
    /// Shadow maps, relative to this view's eye; `None` without shadows.
    pub shadows: Option<ViewShadows>,
    /// Position of the eye in m, world space.
    pub eye: DVec3,
    /// Clip space from world space relative to the eye, without jitter.
    pub clip_from_world: DMat4,
    /// Jitter to the right and up in pixels; set by [`CameraView::jitter`].
    pub jitter_px: DVec2,
    /// Number of consecutive frames of this view by [`Views::again`], including this one.
    pub still_frames: u32,
    /// View of the previous frame ([`CameraView::after`]); `None` if it equals this one.
    pub earlier: Option<PreviousView>,
    /// Left and right eye of a stereo view ([`CameraView::stereo`]); `None` for other views.
    pub eyes: Option<[EyeUniforms; 2]>,
}

impl CameraView {
    /// Returns a view of `scene` with the image-based light `light`. The sun is that of the environment, if any,
    /// otherwise the brightest directional light of the scene. All other lights are punctual. Prepares the scene for
    /// this view only.
    pub fn new(scene: &Scene, light: &ImageLight, background: &Background, settings: &ViewSettings) -> Self {
        Self::prepared(scene, &PreparedScene::new(scene), light, background, settings)
    }

    /// Returns a view of a prepared scene. [`PreparedScene::update`] must have been called for moved instances.
    pub fn prepared(
        scene: &Scene,
        prepared: &PreparedScene,
        light: &ImageLight,
        background: &Background,
        settings: &ViewSettings,
    ) -> Self {
        Self::of(scene, prepared, light, background, settings, std::slice::from_ref(settings))
    }

    /// Returns views of `scene` that share shadow maps ([`Handles::with`](crate::Handles::with)). Each map is fitted
    /// to everything that the cameras see. The settings of the first view apply to all of them. Shared maps are not
    /// warped to the perspective of a camera.
    pub fn together(
        scene: &Scene,
        light: &ImageLight,
        background: &Background,
        settings: &[ViewSettings],
    ) -> Vec<Self> {
        let prepared = PreparedScene::new(scene);
        settings.iter().map(|own| Self::of(scene, &prepared, light, background, own, settings)).collect()
    }

    /// Returns a view of the surfaces of a prepared scene, without light.
    pub fn unlit(prepared: &PreparedScene, settings: &ViewSettings) -> Self {
        let levels = settings.unlimited_levels(prepared.renderables());
        Self::empty(settings).with_surfaces(prepared, seen(prepared, settings), settings, levels)
    }

    /// Adds visible instances to a view with shadows. `levels` limits the levels of detail.
    fn with_surfaces(
        mut self,
        prepared: &PreparedScene,
        visible: DrawLists,
        settings: &ViewSettings,
        mut levels: Vec<u8>,
    ) -> Self {
        let (renderables, eye) = (prepared.renderables(), settings.camera.eye);
        let from_eye = |origin: &DVec3| (*origin - eye).as_vec3().extend(0.0);
        if !levels.is_empty() {
            settings.limit_levels(renderables, &visible, &mut levels);
        }
        self.shadows.iter_mut().for_each(|shadows| shadows.set_instances(prepared.placements(), &levels));
        let (draws, origins) = prepared.both(
            || {
                let draws = ViewDraws::new(renderables, &visible, &levels, self.shadows.as_ref());
                draws.indirect(|instance, level| prepared.mesh(instance, level))
            },
            || prepared.reference_points().iter().map(from_eye).collect(),
        );
        self.frame.blended = blended_range(renderables, &visible.blend, &settings.camera);
        let placements = prepared.placements().clone();
        let streams_objects = placements.count() <= MAX_STREAMED;
        Self { draws, visible, origins, placements, streams_objects, ..self }
    }

    /// Culls instances and selects lights in parallel.
    fn of(
        scene: &Scene,
        prepared: &PreparedScene,
        light: &ImageLight,
        background: &Background,
        settings: &ViewSettings,
        sharing: &[ViewSettings],
    ) -> Self {
        let lit = || Self::lit(scene, prepared, light, background, settings, sharing);
        let (visible, (lit, mut levels)) = prepared.both(|| seen(prepared, settings), lit);
        let others = if levels.is_empty() { &[][..] } else { sharing };
        let others = others.iter().filter(|other| !std::ptr::eq(*other, settings));
        others.for_each(|other| other.limit_levels(prepared.renderables(), &seen(prepared, other), &mut levels));
        lit.with_surfaces(prepared, visible, settings, levels)
    }

    /// Returns a view with lights and shadows but without surfaces, and the levels of detail that its shadow maps
    /// allow.
    fn lit(
        scene: &Scene,
        prepared: &PreparedScene,
        light: &ImageLight,
        background: &Background,
        settings: &ViewSettings,
        sharing: &[ViewSettings],
    ) -> (Self, Vec<u8>) {
        let renderables = &*prepared.shown(sharing.first().unwrap_or(settings).visible_layers);
        let ViewSettings { camera, environment_intensity, .. } = settings;
        let sun = sun_of(scene, light.sun.as_ref());
        let sun_channels = sun.map_or(u8::MAX, |sun| sun.channels);
        let empty = Self { sun_channels, ..Self::empty(settings) };
        let exposure = empty.frame.exposure;
        let cameras: Vec<_> = sharing.iter().map(fitted_camera).collect();
        let selection = punctual::select(scene, renderables, sun, &cameras);
        let empty = Self { channels_differ: selection.differs_in_channels(renderables), ..empty };
        let packed = selection.kept.iter().filter_map(|own| light_uniforms(own, camera.eye, exposure).ok());
        let mut lights: Vec<LightUniforms> = packed.collect();
        let (mut shadows, mut levels) = (None, settings.unlimited_levels(renderables));
        if let Some((first, asked)) = sharing.first().and_then(|first| Some((first, first.shadows?))) {
            let all = (first.lod_error_px, first.unlimited_levels(renderables));
            let fitted = ViewShadows::fit(renderables, sun, &selection.kept, &cameras, camera.eye, &asked, all);
            (shadows, levels) = (Some(fitted.0), fitted.1);
        }
        let first_maps = shadows.iter().flat_map(|shadows| &shadows.of_lights);
        for (light, first) in lights.iter_mut().zip(first_maps) {
            light.shadow_map = first.map_or(0, |first| first + 1);
        }
        let environment_scale = environment_intensity * exposure;
        let light_count = lights.len() as u32;
        lights.resize(lights.len().max(1), LightUniforms::default());
        let (light_lists, light_report) =
            punctual::lists(renderables, selection, &fitted_camera(settings), settings.size_px, settings.lights);

        let frame = FrameUniforms {
            sun_direction: sun.map_or(Vec3::Y, |sun| -sun.direction),
            sun_angular_radius: sun.map_or(0.0, angular_radius_rad),
            sun_illuminance: sun.map_or(Vec3::ZERO, |sun: &Light| sun.color * illuminance_lux(sun) * exposure),
            environment_scale,
            light_count,
            specular_scale: environment_scale * light.texel_nits,
            roughness_one_lod: light.roughness_one_lod,
            sh: light.exposed_irradiance(environment_scale),
            ..empty.frame
        };
        let background = BackgroundUniforms::new(background, exposure, environment_scale);
        let sun_halo = sun.and_then(halo_of);
        (Self { frame, background, sun_halo, lights, light_lists, light_report, shadows, ..empty }, levels)
    }

    /// Sets the view of the previous frame, which passes use for reprojection. Without it, the previous frame is
    /// assumed to have the same camera and no motion.
    #[must_use]
    pub fn after(self, before: &Self) -> Self {
        let motions = self.moment().motions_since(&before.moment());
        Self { earlier: Some(before.stand()), still_frames: 0, motions, ..self }
    }

    /// Adds motion of meshes that were deformed since the previous frame's view `before`
    /// ([`GpuScene::repose`](crate::gpu_scene::upload::GpuScene::repose)).
    #[must_use]
    pub fn deformed(self, before: &Self, scene: &Scene) -> Self {
        let bodies = scene.motion.bodies.iter().map(|body| body.instance);
        let motions = self.moment().motions_of(bodies, &before.moment(), self.motions.clone());
        Self { motions, ..self }
    }

    fn moment(&self) -> Moment<'_> {
        Moment { clip_from_world: self.clip_from_world, eye: self.eye, placements: &self.placements }
    }

    /// Returns true if an instance moved since the previous frame.
    pub fn moves(&self, instance: usize) -> bool {
        self.motions.get(instance).is_some_and(|motion| *motion != MotionUniforms::default())
    }

    /// Returns the camera of this view, for the next frame.
    pub fn stand(&self) -> PreviousView {
        PreviousView {
            eye: self.eye,
            clip_from_world: self.jittered(),
            steady_clip_from_world: self.clip_from_world,
            world_from_view: self.frame.world_from_view.as_dmat4(),
            exposure: self.frame.exposure,
        }
    }

    /// Returns clip space from world space relative to the eye, with jitter.
    fn jittered(&self) -> DMat4 {
        let by = 2.0 * self.jitter_px / self.frame.viewport_size_px.as_dvec2().max(DVec2::ONE);
        DMat4::from_translation(by.extend(0.0)) * self.clip_from_world
    }

    /// Sets the jitter to the right and up in pixels, for temporal anti-aliasing. It replaces an earlier jitter. Draw
    /// lists do not change, so up to half a pixel may be missing at the border of the picture.
    pub fn jitter(&mut self, jitter_px: DVec2) {
        self.jitter_px = jitter_px;
        let clip_from_world = self.jittered();
        self.frame.clip_from_world = clip_from_world.as_mat4();
        self.frame.world_from_clip = inverse(clip_from_world).as_mat4();
    }

    /// Returns a black view without instances and lights, for passes over pictures that need the camera.
    pub fn empty(settings: &ViewSettings) -> Self {
        let ViewSettings { camera, size_px: [width, height], ev100, .. } = settings;
        let clip_from_world =
            camera.clip_from_view(aspect(settings)) * DMat4::from_quat(camera.world_from_view.inverse());
        Self {
            sun_halo: None,
            frame: FrameUniforms {
                clip_from_world: clip_from_world.as_mat4(),
                world_from_clip: inverse(clip_from_world).as_mat4(),
                world_from_view: Mat4::from_quat(camera.world_from_view.as_quat()),
                camera: eye_or_direction(camera),
                exposure: exposure_from_ev100(*ev100),
                viewport_size_px: Vec2::new(*width as f32, *height as f32),
                environment_rotation: Vec2::X,
                ..FrameUniforms::default()
            },
            visible: DrawLists::default(),
            background: BackgroundUniforms::None,
            lights: vec![LightUniforms::default()],
            light_lists: None,
            sun_channels: u8::MAX,
            channels_differ: false,
            light_report: LightReport::default(),
            draws: ViewDraws::default(),
            origins: Vec::new(),
            placements: Placements::default(),
            streams_objects: true,
            motions: Vec::new(),
            shadows: None,
            eye: camera.eye,
            clip_from_world,
            jitter_px: DVec2::ZERO,
            still_frames: 0,
            earlier: None,
            eyes: None,
        }
    }
}

/// Returns the instances that the camera may see.
fn seen(prepared: &PreparedScene, settings: &ViewSettings) -> DrawLists {
    DrawLists::seen(&prepared.shown(settings.visible_layers), &settings.camera, aspect(settings), prepared.pool())
}

fn aspect(settings: &ViewSettings) -> f64 {
    let [width, height] = settings.size_px;
    f64::from(width.max(1)) / f64::from(height.max(1))
}

fn fitted_camera(settings: &ViewSettings) -> FitCamera<'_> {
    FitCamera { camera: &settings.camera, width_over_height: aspect(settings) }
}

/// Returns the eye, which is the origin, or the direction toward the viewer of a parallel projection.
fn eye_or_direction(camera: &Camera) -> Vec4 {
    match camera.projection {
        Projection::Perspective { .. } => Vec4::W,
        Projection::Orthographic { .. } => (-camera.forward()).as_vec3().extend(0.0),
    }
}

/// Returns the inverse, computed in f64. A matrix with an infinite far plane is invertible too.
fn inverse(matrix: DMat4) -> DMat4 {
    let inverse = matrix.inverse();
    if inverse.is_finite() { inverse } else { DMat4::IDENTITY }
}

#[cfg(all(test, feature = "ibl"))]
mod tests;
