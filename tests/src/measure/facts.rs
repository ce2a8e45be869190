//! Six small scenes, from one that needs no effect to one that needs most, drawn with and without feature culling.

pub mod late;
pub mod random;
pub mod table;

use crate::stage::light_cache;
use framegraph::{Extent, Format, Options, Plan, Scratch, Target, TextureDesc, compile};
use framegraph_passes::effects::exposure::Measurement;
use framegraph_passes::feature_culling::{
    Effect, EffectSet, EnvironmentSummary, FactInput, FactMemory, Facts, Proof, SceneSummary, decide,
};
use framegraph_passes::gpu_scene::shadow_views::{ContactShadows, ShadowSettings};
use framegraph_passes::gpu_scene::view::{Background, ViewSettings};
use framegraph_passes::light::ibl::{DfgSettings, IblSettings};
use framegraph_passes::light::shading::LightSettings;
use framegraph_passes::program::Programs;
use framegraph_passes::{
    CameraView, LightSearch, Lighting, OcclusionSettings, PostSettings, ReflectionSettings, Settings, ViewId, World,
    standard,
};
use framegraph_scene::geometry::{cuboid, plane, sphere};
use framegraph_scene::{
    AlphaMode, Camera, Environment, Light, LightKind, Material, Projection, Scene, Transmission, progress,
};
use framegraph_shaders::layout::{Grading, ToneMap};
use framegraph_wgpu::{Executor, Frame, Gpu, Imports, read_texture};
use glam::{DMat4, DVec3, Vec2, Vec3};
use std::collections::BTreeMap;
use std::error::Error;
use std::time::Instant;

/// Width and height of the pictures, in pixels.
pub const SIZE_PX: [u32; 2] = [64, 64];

/// Effects of which every combination is tested.
pub const MASKED: [Effect; 12] = [
    Effect::SunShadows,
    Effect::LampShadows,
    Effect::ContactShadows,
    Effect::Occlusion,
    Effect::Reflections,
    Effect::EnergyCompensation,
    Effect::SpecularAa,
    Effect::ShBands,
    Effect::MicroShadows,
    Effect::Vignette,
    Effect::Fxaa,
    Effect::Msaa,
];

/// A scene with its light and the requested settings.
#[derive(Clone, Debug)]
pub struct Case {
    /// Name in tables.
    pub name: &'static str,
    /// Scene to draw.
    pub scene: Scene,
    /// Radiance of the uniform environment, in nits.
    pub nits: DVec3,
    /// Background of the scene.
    pub background: Background,
    /// Settings with every effect enabled, except where the scene is about one.
    pub asked: Settings,
    /// Exposure value of the camera, EV100.
    pub ev100: f32,
    /// Size of the pictures, in pixels.
    pub size_px: [u32; 2],
}

/// Returns settings with every effect, at low cost.
pub fn every_effect() -> Settings {
    let shadows = ShadowSettings {
        cascades: 2,
        local_maps: 1,
        contact: Some(ContactShadows::FILAMENT),
        ..ShadowSettings::texels(128)
    };
    let mut post = PostSettings { vignette_ev: 0.7, ..PostSettings::DEFAULT };
    post.look.grading = Grading { contrast: 1.1, ..Grading::NEUTRAL };
    Settings {
        samples: 4,
        shadows: Some(shadows),
        occlusion: Some(OcclusionSettings::SAO),
        reflections: Some(ReflectionSettings::DEFAULT),
        blended: true,
        glass_layers: 2,
        post,
        ..Settings::DEFAULT
    }
}

fn matt(name: &str, color: Vec3, roughness: f32) -> Material {
    Material::dielectric(name, color, roughness)
}

fn scene(eye: DVec3, at: DVec3) -> Scene {
    let up = if (at - eye).normalize().y.abs() > 0.99 { DVec3::NEG_Z } else { DVec3::Y };
    let camera = Camera::look_at(eye, at, up, Projection::perspective(0.8, 0.1));
    Scene { cameras: camera.into_iter().collect(), ..Scene::default() }
}

fn put(scene: &mut Scene, name: &str, mesh: framegraph_scene::Mesh, material: Material, at: DVec3) {
    let (mesh, material) = (scene.add_mesh(mesh), scene.add_material(material));
    scene.add_instance(name, mesh, material, DMat4::from_translation(at));
}

fn lamp(at: DVec3) -> Light {
    let kind =
        LightKind::Spot { intensity_candela: 3000.0, range_m: Some(6.0), inner_cone_rad: 0.3, outer_cone_rad: 0.6 };
    Light { kind, position: at, ..Light::directional("lamp", Vec3::NEG_Y, 0.0) }
}

fn sun() -> Light {
    Light::directional("sun", Vec3::new(-0.5, -1.0, -0.3), 20_000.0)
}

/// Adds a floor with a block, a ball, a mirror, glass and a blended surface.
fn things(scene: &mut Scene) {
    put(scene, "floor", plane(Vec2::splat(8.0), 1, Vec2::ONE), matt("floor", Vec3::splat(0.5), 0.3), DVec3::ZERO);
    put(
        scene,
        "block",
        cuboid(Vec3::splat(0.4)),
        matt("block", Vec3::new(0.7, 0.2, 0.1), 0.6),
        DVec3::new(-0.5, 0.4, 0.0),
    );
    let mirror = Material::metal("mirror", Vec3::splat(0.9), 0.2);
    put(scene, "ball", sphere(0.4, 16, 8), mirror, DVec3::new(0.6, 0.4, 0.1));
}

/// Returns the six scenes.
///
/// # Errors
/// Only on a bug in a built-in scene.
pub fn cases() -> [Case; 6] {
    let origin = DVec3::new(0.0, 0.4, 0.0);
    let ahead = || scene(DVec3::new(0.2, 1.2, 3.2), origin);
    let case = |name, scene: Scene, nits: f64, background| {
        let asked = every_effect().for_scene(&scene, SIZE_PX);
        let (nits, asked) = (DVec3::splat(nits), Settings { blended: true, ..asked });
        Case { name, scene, nits, background, asked, ev100: 10.5, size_px: SIZE_PX }
    };
    let nothing = case("nothing", ahead(), 1000.0, Background::Constant(Vec3::new(300.0, 500.0, 900.0)));
    let mut ball = ahead();
    put(&mut ball, "ball", sphere(0.5, 24, 12), matt("ball", Vec3::new(0.2, 0.5, 0.7), 0.8), origin);
    let ball = case("ball", ball, 2000.0, Background::Environment);
    let mut floor = scene(DVec3::new(0.3, 2.0, 0.4), DVec3::ZERO);
    put(&mut floor, "floor", plane(Vec2::splat(9.0), 1, Vec2::ONE), matt("floor", Vec3::splat(0.4), 0.5), DVec3::ZERO);
    floor.lights.push(sun());
    let floor = case("floor", floor, 1000.0, Background::Environment);
    let mut cards = ahead();
    for (i, alpha) in [AlphaMode::Opaque, AlphaMode::Blend].into_iter().enumerate() {
        let mut card =
            Material { unlit: true, alpha, double_sided: true, ..matt("card", Vec3::new(0.8, 0.4, 0.1), 1.0) };
        card.base_color.w = 0.5;
        put(&mut cards, "card", cuboid(Vec3::new(0.5, 0.5, 0.01)), card, origin + DVec3::new(0.3, 0.2, 0.5) * i as f64);
    }
    let mut cards = case("cards", cards, 1000.0, Background::Constant(Vec3::splat(100.0)));
    cards.asked.post = PostSettings { look: framegraph_passes::grading::Look::default(), ..PostSettings::DEFAULT };
    cards.asked.post.look.tone_map = ToneMap::Linear;

    let mut night = ahead();
    things(&mut night);
    night.lights.push(lamp(DVec3::new(0.0, 2.5, 0.0)));
    night.lights.push(Light { kind: LightKind::Point { intensity_candela: 0.0, range_m: None }, ..lamp(DVec3::Y) });
    let night = case("night", night, 0.0, Background::None);

    let mut full = ahead();
    things(&mut full);
    full.lights.extend([sun(), lamp(DVec3::new(0.0, 2.5, 0.0))]);
    let glass = Material {
        transmission: Some(Transmission { factor: 1.0, ..Transmission::default() }),
        ..matt("glass", Vec3::ONE, 0.1)
    };
    put(&mut full, "glass", sphere(0.3, 16, 8), glass, DVec3::new(0.1, 0.3, 0.9));
    let mut veil =
        Material { alpha: AlphaMode::Blend, double_sided: true, ..matt("veil", Vec3::new(0.2, 0.7, 0.3), 0.8) };
    veil.base_color.w = 0.4;
    put(&mut full, "veil", cuboid(Vec3::new(0.3, 0.3, 0.01)), veil, DVec3::new(-0.6, 0.6, 0.8));
    let full = case("full", full, 2000.0, Background::Environment);
    [nothing, ball, floor, cards, night, full]
}

impl Case {
    /// Returns the settings without the effects of [`MASKED`] whose bit in `mask` is 0.
    pub fn masked(&self, mask: u32) -> Settings {
        let off = MASKED.into_iter().enumerate().filter(|(bit, _)| mask >> bit & 1 == 0);
        off.fold(self.asked, |settings, (_, effect)| settings.without(effect))
    }

    /// Returns the view of the scene's camera.
    pub fn view(&self, settings: &Settings, size_px: [u32; 2]) -> ViewSettings {
        ViewSettings {
            camera: self.scene.default_camera(f64::from(size_px[0]) / f64::from(size_px[1])),
            size_px,
            ev100: self.ev100,
            environment_intensity: 1.0,
            shadows: settings.shadows,
            lights: LightSearch::All,
            lod_error_px: 0.0,
            visible_layers: 1,
        }
    }
}

/// Executor and programs that all cases share, so that pipelines are created once.
#[derive(Debug)]
pub struct Easel {
    gpu: Gpu,
    executor: Executor,
    programs: Programs,
    scratch: Scratch,
    /// Inlines post-processing into shading where the plan allows it; radiance is not stored then.
    pub inline: bool,
}

impl Easel {
    /// Creates an easel for a device.
    pub fn new(gpu: &Gpu) -> Self {
        let (executor, programs) = (Executor::new(gpu), Programs::new());
        Self { gpu: gpu.clone(), executor, programs, scratch: Scratch::new(), inline: true }
    }
}

/// A case on a device.
#[derive(Debug)]
pub struct Drawn {
    /// Case to draw.
    pub case: Case,
    survey: SceneSummary,
    world: World,
    /// Pictures by settings in text form.
    known: BTreeMap<String, Vec<u8>>,
}

impl Drawn {
    /// Uploads a case; its light is computed, or read from a cache.
    ///
    /// # Errors
    /// The device fails.
    pub fn new(gpu: &Gpu, case: Case) -> Result<Self, Box<dyn Error>> {
        let shading = case.asked.shading;
        let image = IblSettings { cube_texels: 64, bands: shading.bands, ..IblSettings::default() };
        let light = LightSettings { image, dfg: DfgSettings { texels: 32, visibility: shading.table } };
        let environment = Environment::uniform(case.nits)?;
        let lighting = Lighting::new(gpu, &environment, &light, &light_cache(), &mut progress::silent)?;
        let seen = case.view(&case.asked, case.size_px);
        let view = CameraView::new(&case.scene, &lighting.image, &case.background, &seen);
        let world = World::new(gpu, &case.scene, lighting, [view], &mut progress::silent)?;
        Ok(Self { survey: SceneSummary::new(&case.scene), case, world, known: BTreeMap::new() })
    }

    /// Returns the feature culling of the case with these settings.
    pub fn facts(&self, asked: &Settings, forced: EffectSet, memory: &mut FactMemory) -> Facts {
        let views = [self.case.view(asked, self.case.size_px)];
        let input = FactInput {
            scene: &self.case.scene,
            survey: &self.survey,
            around: EnvironmentSummary::from(&self.world.lighting.image),
            background: &self.case.background,
            views: &views,
            settings: asked,
            forced,
            measured: Measurement::Off,
            max_steps: FactInput::MAX_CODES,
        };
        decide(&input, memory)
    }

    /// Returns the picture of these settings, drawn or cached.
    ///
    /// # Errors
    /// The device fails.
    pub fn picture(&mut self, easel: &mut Easel, settings: &Settings) -> Result<Vec<u8>, Box<dyn Error>> {
        let key = format!("{settings:?}");
        if let Some(known) = self.known.get(&key) {
            return Ok(known.clone());
        }
        // Reflections read the previous frame, which must have the same settings.
        easel.executor.reset_histories();
        let frames = if settings.reflections.is_some() { 2 } else { 1 };
        let (picture, ..) = self.frames(easel, settings, self.case.size_px, frames)?;
        self.known.insert(key, picture.clone());
        Ok(picture)
    }

    /// Returns the picture, the plan, and the minimum time of several frames in ms.
    ///
    /// # Errors
    /// The device fails.
    pub fn frames(
        &mut self,
        easel: &mut Easel,
        settings: &Settings,
        size_px: [u32; 2],
        frames: u32,
    ) -> Result<(Vec<u8>, Plan, f64), Box<dyn Error>> {
        let (Self { case, world, .. }, Easel { gpu, executor, programs, scratch, inline }) = (self, easel);
        let seen = case.view(settings, size_px);
        let view = CameraView::new(&case.scene, &world.lighting.image, &case.background, &seen);
        world.set_view(gpu, ViewId::MAIN, view)?;
        let mut frame = Frame::<World>::new();
        let output = frame.graph_mut().texture("output", TextureDesc::new(Extent::FRAME, Format::Rgba8UnormSrgb));
        let io = standard(&mut frame, settings, Target::from(output))?;
        frame.graph_mut().readback(io.output)?;
        let mut plan = Plan::new();
        let options = Options { inline: *inline, ..Options::for_frame(size_px[0], size_px[1]) };
        compile(frame.graph(), &gpu.caps(), &options, scratch, &mut plan)?;
        let mut least_ms = f64::INFINITY;
        std::mem::swap(&mut world.programs, programs);
        for _ in 0..frames {
            let begun = Instant::now();
            executor.execute(&plan, &frame, world, &Imports::new())?;
            gpu.wait()?;
            least_ms = least_ms.min(begun.elapsed().as_secs_f64() * 1e3);
        }
        std::mem::swap(&mut world.programs, programs);
        let texture = executor.texture(&plan, io.output).ok_or("the frame left no picture")?;
        Ok((read_texture(gpu, texture)?.rgba8(), plan, least_ms))
    }
}

/// Difference between the pictures with and without feature culling.
#[derive(Clone, Debug, Default)]
pub struct Compared {
    /// Culled effects whose error bound is in 8-bit steps.
    pub dropped: EffectSet,
    /// Sum of their error bounds, in 8-bit steps.
    pub bound_codes: f32,
    /// Largest difference, in 8-bit steps.
    pub largest_codes: u8,
    /// Number of pixels that differ by more than the bound.
    pub beyond: usize,
    /// Number of pixels that may exceed the bound, since FXAA can detect another edge after the smallest difference.
    pub may_be_beyond: usize,
}

impl Compared {
    /// Returns true if the culled effects stay within their bounds.
    pub fn holds(&self) -> bool {
        self.beyond <= self.may_be_beyond
    }
}

/// Draws a combination of effects with and without feature culling. Effects with other kinds of bounds are not culled.
///
/// # Errors
/// The device fails.
pub fn compare_mask(easel: &mut Easel, drawn: &mut Drawn, mask: u32) -> Result<Compared, Box<dyn Error>> {
    let asked = drawn.case.masked(mask);
    compare(easel, drawn, &asked)
}

/// Draws settings with and without feature culling. Effects with other kinds of bounds are not culled.
///
/// # Errors
/// The device fails.
pub fn compare(easel: &mut Easel, drawn: &mut Drawn, asked: &Settings) -> Result<Compared, Box<dyn Error>> {
    let asked = *asked;
    let all = drawn.facts(&asked, EffectSet::NONE, &mut FactMemory::default());
    // Without multisampling, no edge has several samples.
    let edges = asked.samples > 1;
    let otherwise = all.rows.iter().filter(|row| match row.proof {
        Proof::Truer | Proof::Texels(_) => true,
        Proof::Edges => edges,
        _ => false,
    });
    let facts = drawn.facts(&asked, otherwise.map(|row| row.effect).collect(), &mut FactMemory::default());
    let bound = |effect| match facts.of(effect).map(|row| row.proof) {
        Some(Proof::Variant | Proof::Edges) => 1.0,
        Some(Proof::Codes(codes)) => codes.ceil(),
        _ => 0.0,
    };
    let applied = facts.apply(&asked);
    if applied == asked {
        return Ok(Compared::default());
    }
    let (forced, decided) = (drawn.picture(easel, &asked)?, drawn.picture(easel, &applied)?);
    let dropped = facts.dropped();
    let bound_codes: f32 = dropped.iter().map(bound).sum();
    let apart = forced.chunks_exact(4).zip(decided.chunks_exact(4));
    let apart: Vec<u8> = apart.map(|(a, b)| (0..4).map(|c| a[c].abs_diff(b[c])).max().unwrap_or(0)).collect();
    Ok(Compared {
        dropped,
        bound_codes,
        largest_codes: apart.iter().copied().max().unwrap_or(0),
        beyond: apart.iter().filter(|codes| f32::from(**codes) > bound_codes).count(),
        may_be_beyond: if applied.fxaa && bound_codes > 0.0 { apart.len() / 100 } else { 0 },
    })
}

/// Returns masks with all effects, with none, and with all but one. Every pair of effects then occurs in all four
/// states. With `alone`, also returns masks with a single effect.
pub fn some_masks(alone: bool) -> Vec<u32> {
    let (count, all) = (MASKED.len() as u32, (1 << MASKED.len()) - 1);
    let each = (0..count).map(|bit| 1 << bit);
    let alone = each.clone().filter(|_| alone);
    alone.chain(each.map(|bit| all & !bit)).chain([0, all]).collect()
}
