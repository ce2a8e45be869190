//! Views of a scene: camera, exposure, sun and lights as the shaders read them, and what is drawn.
//!
//! Positions are sent relative to the eye, subtracted in double precision, so that a scene a thousand kilometers from its
//! origin does not jitter. Lights are multiplied by the exposure here, in f32: what the shaders see fits half floats.
//!
//! A frame may have several views ([`Views`]). Each has buffers of its own for what depends on its eye and for what it draws;
//! meshes, materials and textures are the scene's and shared.

mod blended;
mod gpu;
mod levels;
mod motion;

pub use gpu::{GpuView, ViewId, Views};

use crate::gpu_scene::draws::ViewDraws;
use crate::gpu_scene::prepared::{Placements, PreparedScene};
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
use framegraph_shaders::layout::{FrameUniforms, LightUniforms, MotionUniforms, SkyUniforms};
use framegraph_shaders::reference::sky::Preetham;
use glam::{DMat4, DVec2, DVec3, Mat4, Vec2, Vec3, Vec4};

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
    /// How shadows are made; none for a frame without.
    pub shadows: Option<ShadowSettings>,
    /// How shading finds the lights that reach a place.
    pub lights: LightSearch,
    /// How far a mesh that has [levels of detail](framegraph_scene::MeshLevel) may be drawn from where it is, in pixels and in texels of
    /// shadow maps; 0 draws all meshes whole.
    pub lod_error_px: f32,
    /// Layers that are shown, a bit each ([`DrawOptions::layers`](framegraph_scene::DrawOptions::layers)); 1 by default, as
    /// Filament's `View::setVisibleLayers`.
    pub visible_layers: u8,
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

impl Background {
    /// A clear sky, to be seen. Its ground is lit by the sun that belongs to it.
    pub fn clear_sky(sky: &Sky) -> Self {
        let sun_lux = sun_light(sky.toward_sun, sky.turbidity)
            .map_or(DVec3::ZERO, |sun| sun.color.as_dvec3() * f64::from(illuminance_lux(&sun)));
        Self::ClearSky(Preetham::new(sky.toward_sun, sky.turbidity, sky.ground_albedo, sun_lux))
    }
}

/// A [`Background`] as the sky's shader reads it, multiplied by the exposure.
#[derive(Clone, Copy, Debug)]
pub enum BackgroundUniforms {
    /// Nothing: black.
    None,
    /// The environment map.
    Environment,
    /// A clear sky with the sun's disc.
    ClearSky(SkyUniforms),
    /// The same radiance in every direction.
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

/// The most instances of a scene whose objects come with the draws ([`CameraView::streams_objects`]).
pub const MAX_STREAMED: usize = 1024;

/// One view of one frame, on the CPU.
#[derive(Clone, Debug)]
pub struct CameraView {
    /// Camera, sun and ambient light.
    pub frame: FrameUniforms,
    /// What the camera may see, by how it is drawn.
    pub visible: DrawLists,
    /// What stands behind everything.
    pub background: BackgroundUniforms,
    /// Angular radius in radians of the sun's disc, and its halo, where they are drawn.
    pub sun_halo: Option<(f32, SunHalo)>,
    /// Punctual lights; at least one, so that there is something to bind. `frame.light_count` says how many count.
    pub lights: Vec<LightUniforms>,
    /// Which of them reach what part of the view; none where all are looked at everywhere.
    pub light_lists: Option<LightLists>,
    /// Light channels of the sun.
    pub sun_channels: u8,
    /// Whether some punctual light and some instance share no light channel.
    pub channels_differ: bool,
    /// What became of the scene's lights.
    pub light_report: LightReport,
    /// What is drawn of it, in which draws.
    pub draws: ViewDraws,
    /// Where the zero point of each instance's mesh is, in m, relative to the eye.
    pub origins: Vec<Vec4>,
    /// How each instance is turned and scaled.
    pub placements: Placements,
    /// Whether draws bring the objects of their instances along: a copy of each for each list that draws it, as often as the
    /// view changes. So it is made up to [`MAX_STREAMED`] instances; vertices of more rather read the scene's, which stay where
    /// they are. The picture is the same.
    pub streams_objects: bool,
    /// Where instances are and were in clip space, where any has moved since the frame before; of others it is zeros.
    pub motions: Vec<MotionUniforms>,
    /// Shadow maps, relative to this view's eye; none for a frame without.
    pub shadows: Option<ViewShadows>,
    /// Where the eye is, in m, world space.
    pub eye: DVec3,
    /// World, relative to the eye, to clip space, as if pixels were seen through their middles.
    pub clip_from_world: DMat4,
    /// How far everything is moved to the right and up for other places of the pixels to be seen, in pixels; set by
    /// [`CameraView::jitter`].
    pub jitter_px: DVec2,
    /// How many frames of it there were by [`Views::again`], this one counted.
    pub still_frames: u32,
    /// From where the frame before was seen ([`CameraView::after`]); none: from here.
    pub earlier: Option<PreviousView>,
}

impl CameraView {
    /// A view of `scene`, lit from all around by `light`. The sun is the environment's own, else the scene's brightest
    /// directional light; all other lights are punctual. The scene is prepared for this view alone.
    pub fn new(scene: &Scene, light: &ImageLight, background: &Background, settings: &ViewSettings) -> Self {
        Self::prepared(scene, &PreparedScene::new(scene), light, background, settings)
    }

    /// The same of a scene that was prepared before, and updated since where something moved.
    pub fn prepared(
        scene: &Scene,
        prepared: &PreparedScene,
        light: &ImageLight,
        background: &Background,
        settings: &ViewSettings,
    ) -> Self {
        Self::of(scene, prepared, light, background, settings, std::slice::from_ref(settings))
    }

    /// Views of `scene` that share shadow maps: each map is fitted to what all their cameras see, so one view's maps serve
    /// the others ([`Handles::with`](crate::Handles::with)). All are made as the first one's settings say. A map follows the
    /// perspective of no camera then.
    pub fn together(
        scene: &Scene,
        light: &ImageLight,
        background: &Background,
        settings: &[ViewSettings],
    ) -> Vec<Self> {
        let prepared = PreparedScene::new(scene);
        settings.iter().map(|own| Self::of(scene, &prepared, light, background, own, settings)).collect()
    }

    /// The surfaces of a scene that was prepared, without any light.
    pub fn unlit(prepared: &PreparedScene, settings: &ViewSettings) -> Self {
        let levels = settings.unlimited_levels(prepared.renderables());
        Self::empty(settings).with_surfaces(prepared, seen(prepared, settings), settings, levels)
    }

    /// Puts what is seen into a view that has its shadows, in `levels` of detail at the most.
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
            self.shadows.iter_mut().for_each(|shadows| shadows.set_levels(&levels));
        }
        let (draws, origins) = prepared.both(
            || {
                let draws = ViewDraws::new(renderables, &visible, &levels, self.shadows.as_ref());
                draws.indirect(|instance, level| prepared.mesh(instance, level))
            },
            || renderables.origins().iter().map(from_eye).collect(),
        );
        self.frame.blended = blended_range(renderables, &visible.blend, &settings.camera);
        let placements = prepared.placements().clone();
        let streams_objects = placements.count() <= MAX_STREAMED;
        Self { draws, visible, origins, placements, streams_objects, ..self }
    }

    /// What is seen and what lights it are found side by side.
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

    /// A view with its lights and shadows, and no surface; and the levels of detail that its shadow maps allow.
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

    /// The same view in a frame that follows one with the view `before`: passes that read the earlier picture find places in
    /// it. Without this, the frame before was seen from where this one is, which is so as long as nothing moves.
    #[must_use]
    pub fn after(self, before: &Self) -> Self {
        let motions = self.moment().motions_since(&before.moment());
        Self { earlier: Some(before.stand()), still_frames: 0, motions, ..self }
    }

    /// The same view with bodies of the scene that have another shape than in the frame before `before`
    /// ([`GpuScene::repose`](crate::gpu_scene::upload::GpuScene::repose)), wherever they are.
    #[must_use]
    pub fn deformed(self, before: &Self, scene: &Scene) -> Self {
        let bodies = scene.motion.bodies.iter().map(|body| body.instance);
        let motions = self.moment().motions_of(bodies, &before.moment(), self.motions.clone());
        Self { motions, ..self }
    }

    fn moment(&self) -> Moment<'_> {
        Moment { clip_from_world: self.clip_from_world, eye: self.eye, placements: &self.placements }
    }

    /// Whether an instance has moved since the frame before.
    pub fn moves(&self, instance: usize) -> bool {
        self.motions.get(instance).is_some_and(|motion| *motion != MotionUniforms::default())
    }

    /// From where it is seen.
    pub fn stand(&self) -> PreviousView {
        PreviousView {
            eye: self.eye,
            clip_from_world: self.jittered(),
            steady_clip_from_world: self.clip_from_world,
            world_from_view: self.frame.world_from_view.as_dmat4(),
            exposure: self.frame.exposure,
        }
    }

    /// Clip space from the world about the eye, moved by the jitter.
    fn jittered(&self) -> DMat4 {
        let by = 2.0 * self.jitter_px / self.frame.viewport_size_px.as_dvec2().max(DVec2::ONE);
        DMat4::from_translation(by.extend(0.0)) * self.clip_from_world
    }

    /// Moves everything by so many pixels to the right and up, instead of what it was moved by before: anti-aliasing over
    /// time sees each pixel through another place in each frame. What was chosen to be drawn stays as it is, so at the
    /// picture's border half a pixel may lack.
    pub fn jitter(&mut self, jitter_px: DVec2) {
        self.jitter_px = jitter_px;
        let clip_from_world = self.jittered();
        self.frame.clip_from_world = clip_from_world.as_mat4();
        self.frame.world_from_clip = inverse(clip_from_world).as_mat4();
    }

    /// A view of nothing, black and without light: for passes over pictures that need to know the camera.
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
        }
    }
}

/// What its camera may see.
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

/// The eye, which is the origin, or the direction toward the viewer of a parallel projection.
fn eye_or_direction(camera: &Camera) -> Vec4 {
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

#[cfg(all(test, feature = "ibl"))]
mod tests;
