//! Scenes on both sides of every threshold, and cameras that cross one slowly.

use framegraph_passes::effects::exposure::{Measure, Measured, Measurement};
use framegraph_passes::feature_culling::{
    Decision, Effect, EffectSet, EnvironmentSummary, FactInput, FactMemory, Facts, Proof, SceneSummary, decide,
};
use framegraph_passes::gpu_scene::shadow_views::ShadowSettings;
use framegraph_passes::gpu_scene::view::{Background, ViewSettings};
use framegraph_passes::{BloomSettings, DofSettings, FogSettings, OcclusionSettings, ReflectionSettings, Settings};
use framegraph_scene::environment::ShBands;
use framegraph_scene::geometry::{cuboid, sphere};
use framegraph_scene::{
    AlphaMode, DiffuseTransmission, Light, LightKind, Material, TextureId, TextureSlot, Topology, Transmission,
    UvTransform,
};
use framegraph_shaders::layout::{EdgeFade, ToneMap};
use glam::{DMat4, DVec3, Vec3, Vec4};
use tests::measure::facts::{Case, SIZE_PX, cases, every_effect};

/// Returns the decision for an effect, given the light's coefficients.
struct Stage {
    case: Case,
    sh: [Vec4; 18],
    sun: Option<Light>,
    luminance_nits: f32,
}

impl Stage {
    fn of(name: &str) -> Self {
        let case = cases().into_iter().find(|case| case.name == name).expect("a case");
        let mut sh = [Vec4::ZERO; 18];
        sh[0] = case.nits.as_vec3().extend(0.0);
        Self { luminance_nits: case.nits.y as f32, case, sh, sun: None }
    }

    fn facts_with(&self, view: ViewSettings, memory: &mut FactMemory) -> Facts {
        self.facts_of(&[view], Measurement::Off, EffectSet::NONE, memory)
    }

    fn facts_of(
        &self,
        views: &[ViewSettings],
        measured: Measurement,
        forced: EffectSet,
        memory: &mut FactMemory,
    ) -> Facts {
        let Self { case, sh, sun, luminance_nits } = self;
        let around = EnvironmentSummary {
            irradiance: sh,
            bands: ShBands::Three,
            luminance_nits: *luminance_nits,
            sun: sun.as_ref(),
        };
        let input = FactInput {
            scene: &case.scene,
            survey: &SceneSummary::new(&case.scene),
            around,
            background: &case.background,
            views,
            settings: &case.asked,
            forced,
            measured,
            max_steps: FactInput::MAX_CODES,
        };
        decide(&input, memory)
    }

    fn facts(&self) -> Facts {
        self.facts_with(self.case.view(&self.case.asked, SIZE_PX), &mut FactMemory::default())
    }

    /// Returns true if an effect is culled.
    fn drops(&self, effect: Effect) -> bool {
        let facts = self.facts();
        let row = facts.of(effect).unwrap_or_else(|| panic!("{effect:?} is not asked for"));
        row.decision == Decision::Dropped
    }

    fn put(&mut self, mesh: framegraph_scene::Mesh, material: Material, at: DVec3) -> &mut Self {
        let scene = &mut self.case.scene;
        let (mesh, material) = (scene.add_mesh(mesh), scene.add_material(material));
        scene.add_instance("more", mesh, material, DMat4::from_translation(at));
        self
    }

    fn material(&mut self, change: impl Fn(&mut Material)) -> &mut Self {
        self.case.scene.materials.iter_mut().for_each(change);
        self
    }
}

fn block() -> framegraph_scene::Mesh {
    cuboid(Vec3::splat(0.3))
}

fn matt() -> Material {
    Material::dielectric("matt", Vec3::splat(0.5), 0.6)
}

/// A floor alone has no shadow maps of the sun. They are kept for a visible block, one beside the picture whose shadow
/// enters it, and one behind the camera. They are culled for a distant block whose shadow stays outside.
#[test]
fn shadows_follow_casters_in_the_swept_view() {
    let with = |at: Option<DVec3>| {
        let mut floor = Stage::of("floor");
        if let Some(at) = at {
            floor.put(block(), matt(), at);
        }
        floor.drops(Effect::SunShadows)
    };
    assert!(with(None));
    assert!(!with(Some(DVec3::new(0.0, 0.3, 0.0))), "seen");
    // The sun is in direction (0.5, 1, 0.3), so high objects on that side cast shadows into the picture.
    assert!(!with(Some(DVec3::new(2.6, 5.0, 1.6))), "above and behind the camera");
    assert!(with(Some(DVec3::new(-4.0, 0.3, -4.0))), "beside, its shadow falls away");
}

/// A depth prepass draws no triangles for lines and points, and saves no shading behind their boxes. They count as not
/// convex, so ambient occlusion is kept.
#[test]
fn lines_and_points_have_no_area() {
    let rows = |topology| {
        let mut stage = Stage::of("nothing");
        for z in [0.0, 0.7, 1.4] {
            stage.put(framegraph_scene::Mesh { topology, ..block() }, matt(), DVec3::new(0.0, 0.3, z));
        }
        let facts = stage.facts();
        [Effect::Prepass, Effect::Occlusion].map(|effect| facts.of(effect).expect("it is asked for").clone())
    };
    let [prepass, _] = rows(Topology::Triangles);
    assert!(prepass.reason.starts_with("36 triangles"), "{prepass:?}");
    for topology in [Topology::Lines, Topology::Points] {
        let [prepass, occlusion] = rows(topology);
        assert!(prepass.decision == Decision::Dropped && prepass.reason.starts_with("0 triangles"), "{prepass:?}");
        assert!(prepass.reason.ends_with("saves 0 thousand"), "{prepass:?}");
        assert_eq!(occlusion.decision, Decision::Kept, "{occlusion:?}");
    }
}

#[test]
fn suns_that_light_nothing_need_no_maps() {
    let toward = |direction: Vec3| {
        let mut floor = Stage::of("floor");
        floor.put(block(), matt(), DVec3::new(0.0, -3.0, 0.0)).case.scene.instances.truncate(1);
        floor.case.scene.lights = vec![Light::directional("sun", direction, 1e4)];
        floor.facts().of(Effect::SunShadows).expect("asked for").clone()
    };
    let below = toward(Vec3::new(-1.0, 0.02, 0.0));
    assert!(below.decision == Decision::Dropped && below.reason.contains("1.1° below the horizon"), "{below:?}");
    assert_eq!(below.proof, Proof::Exact);
    assert!(!toward(Vec3::new(-1.0, -0.02, 0.0)).reason.contains("horizon"), "it grazes the floor from above");
    // The sun shines through a sheet from below.
    let from_below = |scattered: Option<DiffuseTransmission>| {
        let mut floor = Stage::of("floor");
        floor.material(|m| m.diffuse_transmission = scattered).case.scene.instances.truncate(1);
        floor.case.scene.lights = vec![Light::directional("sun", Vec3::new(-0.3, 1.0, 0.0), 1e4)];
        floor.facts().of(Effect::SunShadows).expect("asked for").reason.contains("turns toward")
    };
    assert!(from_below(None) && !from_below(Some(DiffuseTransmission::default())));
    let mut off = Stage::of("floor");
    off.case.scene.lights[0].kind = LightKind::Directional { illuminance_lux: 0.0, angular_radius_rad: 0.0 };
    assert!(off.drops(Effect::SunShadows));
}

#[test]
fn one_map_replaces_cascades_over_a_short_range() {
    let facts = |near: f64| {
        let mut floor = Stage::of("floor");
        floor.put(block(), matt(), DVec3::new(0.0, 0.3, 0.0));
        let mut view = floor.case.view(&floor.case.asked, SIZE_PX);
        view.camera.eye = DVec3::new(0.3, near, 0.4);
        floor.facts_with(view, &mut FactMemory::default()).of(Effect::Cascades).expect("asked for").clone()
    };
    let (short, long) = (facts(4.0), facts(1.2));
    assert_eq!((short.decision, long.decision), (Decision::Dropped, Decision::Kept), "{short:?} {long:?}");
}

#[test]
fn punctual_lights_have_maps_for_casters_in_range() {
    let mut night = Stage::of("night");
    assert!(!night.drops(Effect::LampShadows));
    night.case.asked.shadows = Some(ShadowSettings { local_maps: 7, ..ShadowSettings::texels(64) });
    let facts = night.facts();
    assert!(night.drops(Effect::LampShadows), "one of seven is enough");
    assert_eq!(facts.apply(&night.case.asked).shadows.map(|s| s.local_maps), Some(1));
    night.case.scene.lights[0].position = DVec3::new(0.0, 2.5, 50.0);
    assert_eq!(night.facts().apply(&night.case.asked).shadows.map_or(0, |s| s.local_maps), 0, "out of reach");
}

#[test]
fn occlusion_and_reflections_need_neighbours_and_light() {
    let with = |distance: Option<f64>, mesh| {
        let mut ball = Stage::of("ball");
        if let Some(x) = distance {
            ball.put(mesh, matt(), DVec3::new(x, 0.4, 0.0));
        }
        (ball.drops(Effect::Occlusion), ball.drops(Effect::Reflections))
    };
    assert_eq!(with(None, block()), (true, true), "alone");
    // The ball's box ends at 0.5 m, and the block's starts 0.3 m before its center. Rays reach 3 m, occlusion 0.3 m.
    assert_eq!(with(Some(0.9), block()), (false, false), "0.1 m apart");
    assert_eq!(with(Some(1.2), block()), (true, false), "0.4 m apart");
    assert_eq!(with(Some(4.0), block()), (true, true), "3.2 m apart");
    let mut torus = Stage::of("ball");
    torus.put(framegraph_scene::geometry::torus(0.4, 0.1, 16, 8), matt(), DVec3::X * 5.0);
    torus.case.scene.instances.remove(0);
    torus.case.scene.instances[0].bounds = framegraph_scene::Aabb { min: DVec3::splat(-0.3), max: DVec3::splat(0.3) };
    assert!(!torus.drops(Effect::Occlusion), "a ring has something before itself");
    let mut dark = Stage::of("full");
    assert!(!dark.drops(Effect::Occlusion));
    (dark.sh, dark.luminance_nits) = ([Vec4::ZERO; 18], 0.0);
    assert!(dark.drops(Effect::Occlusion), "no light from all around");
    let mut off = Stage::of("full");
    off.case.asked.occlusion = Some(OcclusionSettings { radius_m: 0.0, ..OcclusionSettings::SAO });
    assert!(off.drops(Effect::Occlusion), "no radius");
    let rough = |roughness: f32| {
        let mut full = Stage::of("full");
        full.material(|material| (material.roughness, material.metallic) = (roughness, 0.0));
        full.case.asked.reflections = Some(ReflectionSettings { most_roughness: 0.7, ..ReflectionSettings::DEFAULT });
        full.drops(Effect::Reflections)
    };
    assert!(rough(0.7) && !rough(0.69));
}

#[test]
fn what_is_seen_through_is_that_in_view() {
    let mut full = Stage::of("full");
    full.case.asked.glass_layers = 2;
    assert!(![Effect::Transmission, Effect::Blending].into_iter().any(|effect| full.drops(effect)));
    assert!(full.drops(Effect::GlassLayers), "one layer of glass of two");
    let glass = Material { transmission: Some(Transmission { factor: 1.0, ..Transmission::default() }), ..matt() };
    full.put(sphere(0.2, 8, 6), glass, DVec3::new(0.15, 0.4, 1.6));
    assert!(!full.drops(Effect::GlassLayers), "two layers");
    for instance in &mut full.case.scene.instances {
        let material = &full.case.scene.materials[instance.material.index()];
        if material.transmission.is_some() || material.alpha == AlphaMode::Blend {
            let behind = DVec3::new(0.0, 0.0, 30.0);
            instance.bounds = framegraph_scene::Aabb { min: behind, max: behind + 1.0 };
        }
    }
    assert!(full.drops(Effect::Transmission) && full.drops(Effect::Blending), "behind the camera");
}

#[test]
fn shading_follows_reflectance_roughness_and_maps() {
    let compensates =
        |change: fn(&mut Material)| !Stage::of("floor").material(change).drops(Effect::EnergyCompensation);
    assert!(!compensates(|material| material.ior = 1.5));
    assert!(compensates(|material| material.ior = 1.6), "f0 = 0.053: 2.1 codes");
    assert!(compensates(|material| material.metallic = 0.01));
    let widened = |roughness: f32, size_px: [u32; 2]| {
        let mut ball = Stage::of("ball");
        ball.material(|material| material.roughness = roughness);
        let view = ball.case.view(&ball.case.asked, size_px);
        let facts = ball.facts_with(view, &mut FactMemory::default());
        facts.of(Effect::SpecularAa).expect("asked for").decision == Decision::Kept
    };
    assert!(widened(0.8, [64, 64]) && !widened(0.8, [1024, 1024]), "small and large pixels");
    assert!(widened(0.49, [4096, 4096]), "smooth");
    let slot = TextureSlot { texture: TextureId::new(0), uv_set: 0, transform: UvTransform::default() };
    let occluded = |map| {
        let mut floor = Stage::of("floor");
        floor.case.asked.occlusion = None;
        floor.material(|material| material.occlusion_texture = map);
        [Effect::OcclusionShading, Effect::MicroShadows].map(|effect| floor.drops(effect))
    };
    assert_eq!((occluded(None), occluded(Some(slot))), ([true; 2], [false; 2]));
}

#[test]
fn irradiance_has_the_bands_that_show() {
    let share = |share: f32| {
        let mut floor = Stage::of("floor");
        floor.sh[4] = floor.sh[0] * share;
        floor.drops(Effect::ShBands)
    };
    // Half an 8-bit step is a share of 0.0043; the polynomial xy is at most 0.5.
    assert!(share(0.0) && share(0.0085) && !share(0.0088) && !share(1.0));
    let mut black = Stage::of("floor");
    (black.sh[0], black.sh[5]) = (Vec4::ZERO, Vec4::ONE);
    assert!(!black.drops(Effect::ShBands), "nothing but the second band");
}

#[test]
fn the_whole_picture_is_looked_at() {
    let drops = |name: &str, effect| Stage::of(name).drops(effect);
    assert!(drops("floor", Effect::Sky) && !drops("full", Effect::Sky));
    assert!(drops("nothing", Effect::Msaa) && !drops("ball", Effect::Msaa));
    let mut even = Stage::of("nothing");
    assert!(!even.drops(Effect::Dither), "the vignette is a gradient");
    even.case.asked.post.vignette_ev = 0.0;
    even.case.asked = even.case.asked.with(Effect::Taa);
    assert!(even.drops(Effect::Dither) && even.drops(Effect::Fxaa) && even.drops(Effect::Taa));
    even.case.background = Background::Environment;
    assert!(!even.drops(Effect::Dither) && !even.drops(Effect::Taa));
    even.case.asked.post.edge_fade = Some(EdgeFade { color: [1.0; 3], ..EdgeFade::DEFAULT });
    assert!(even.drops(Effect::EdgeFade));
    even.case.asked.post.edge_fade = Some(EdgeFade::DEFAULT);
    assert!(!even.drops(Effect::EdgeFade));
    let fxaa = |samples| {
        let mut ball = Stage::of("ball");
        ball.case.asked.samples = samples;
        ball.drops(Effect::Fxaa)
    };
    assert!(fxaa(4) && !fxaa(1));
    let mut cards = Stage::of("cards");
    cards.case.asked.reflections = None;
    assert!(cards.drops(Effect::HdrTarget));
    cards.case.background = Background::Constant(Vec3::splat(1e6));
    assert!(!cards.drops(Effect::HdrTarget), "brighter than white");
    cards.case.background = Background::None;
    cards.case.asked.post.look.tone_map = ToneMap::Hill;
    assert!(!cards.drops(Effect::HdrTarget));
}

#[test]
fn air_and_lens_are_left_out_where_they_do_nothing() {
    let fog = |fog: FogSettings, sky| {
        let mut floor = Stage::of("floor");
        (floor.case.asked.fog, floor.case.asked.sky) = (Some(fog), sky);
        floor.drops(Effect::Fog)
    };
    let thin = |density| FogSettings { density, falloff: 0.0, ..FogSettings::DEFAULT };
    // The floor's farthest corner is about 7 m away: fog hides 1/512 of it at a density of 0.00028.
    assert!(fog(thin(0.0), true) && fog(thin(0.0002), false));
    assert!(!fog(thin(0.0004), false) && !fog(thin(0.0002), true), "the sky has no end");
    assert!(fog(FogSettings { cut_off_m: 5.0, ..thin(0.0002) }, true));
    let focus = |f_number| {
        let mut floor = Stage::of("floor");
        floor.case.asked.dof = Some(DofSettings { focus_m: 2.0, f_number, ..DofSettings::DEFAULT });
        floor.drops(Effect::DepthOfField)
    };
    assert!(focus(64.0) && !focus(0.5), "a small and a large aperture");
    let glow = |bloom: BloomSettings, name| {
        let mut cards = Stage::of(name);
        cards.case.asked.bloom = Some(bloom);
        cards.drops(Effect::Bloom)
    };
    let at = |threshold_at| BloomSettings { threshold_at, ..BloomSettings::DEFAULT };
    assert!(glow(at(1.1), "cards") && !glow(at(0.9), "cards") && !glow(at(1.1), "full"));
    assert!(glow(BloomSettings { strength: 0.0, ..BloomSettings::DEFAULT }, "full"));
}

/// Forced effects are kept, and an effect whose bound exceeds the tolerance is not culled. Measurements apply to one
/// view only, unless the effect is forced, and include the nearest and the farthest distance.
#[test]
fn measures_are_of_one_view_and_of_both_ends() {
    let mut stage = Stage::of("ball");
    let dof = DofSettings { focus_m: 3.0, f_number: 1.0, focal_length_m: Some(0.2), ..DofSettings::DEFAULT };
    let bloom = Some(BloomSettings::DEFAULT);
    stage.case.asked = Settings { dof: Some(dof), bloom, ..stage.case.asked };
    let view = ViewSettings { environment_intensity: 2.0, ..stage.case.view(&stage.case.asked, SIZE_PX) };
    let dropped = |views: &[ViewSettings], distances_m: [f64; 2], forced: EffectSet| {
        let measured = Measured { most_nits: Some(0.0), distances_m: Some(distances_m), frames_ago: 1 };
        let facts = stage.facts_of(views, Measurement::Known(measured), forced, &mut FactMemory::default());
        [Effect::Bloom, Effect::DepthOfField]
            .map(|effect| facts.of(effect).is_some_and(|fact| fact.decision == Decision::Dropped))
    };
    let one = [view];
    let two = [one[0].clone(), one[0].clone()];
    assert_eq!(dropped(&one, [3.0, 3.0], EffectSet::NONE), [true, true]);
    assert_eq!(dropped(&two, [3.0, 3.0], EffectSet::NONE), [false, false], "the other view was not measured");
    for ends in [[1.0, 3.0], [3.0, 9.0]] {
        assert_eq!(dropped(&one, ends, EffectSet::NONE), [true, false], "{ends:?}: one end is out of focus");
    }
    let forced = EffectSet::NONE.with(Effect::Bloom).with(Effect::DepthOfField);
    assert_eq!(dropped(&one, [3.0, 3.0], forced), [false, false]);
    let facts = stage.facts_of(&one, Measurement::Unknown, forced, &mut FactMemory::default());
    assert_eq!(facts.measure, Measure::NONE, "nothing is decided by it");
}

#[test]
fn forced_effects_stay() {
    let floor = Stage::of("floor");
    let view = [floor.case.view(&floor.case.asked, SIZE_PX)];
    let input = FactInput {
        scene: &floor.case.scene,
        survey: &SceneSummary::new(&floor.case.scene),
        around: EnvironmentSummary { irradiance: &floor.sh, bands: ShBands::Three, luminance_nits: 1.0, sun: None },
        background: &floor.case.background,
        views: &view,
        settings: &floor.case.asked,
        forced: EffectSet::ALL,
        measured: Measurement::Off,
        max_steps: 1.0,
    };
    let facts = decide(&input, &mut FactMemory::default());
    assert_eq!((facts.dropped(), facts.apply(&floor.case.asked)), (EffectSet::NONE, floor.case.asked));
    // Culled ambient occlusion occludes nothing; forced ambient occlusion may.
    let ao = EffectSet::NONE.with(Effect::Occlusion);
    let held = decide(&FactInput { forced: ao, ..input }, &mut FactMemory::default());
    assert!(!held.dropped().contains(Effect::OcclusionShading), "{}", held.text(&[]));
    let strict = decide(&FactInput { forced: EffectSet::NONE, ..input }, &mut FactMemory::default());
    let row = strict.of(Effect::EnergyCompensation).expect("asked for");
    assert!(row.decision == Decision::Kept && row.reason.contains("more than 1 codes"), "{row:?}");
    assert!(strict.dropped().contains(Effect::OcclusionShading), "{}", strict.text(&[]));
}

/// A camera rises over 64 frames with 5 % of noise. Cascades are culled once; without hysteresis, they toggle with the
/// noise.
#[test]
fn a_slow_crossing_does_not_flicker() {
    let mut floor = Stage::of("floor");
    floor.put(block(), matt(), DVec3::new(0.0, 0.3, 0.0));
    let changes = |remembers: bool| {
        let mut memory = FactMemory::default();
        let decided = (0..64).map(|frame| {
            let mut view = floor.case.view(&floor.case.asked, SIZE_PX);
            let tremor = if frame % 2 == 0 { 1.05 } else { 0.95 };
            view.camera.eye = DVec3::new(0.3, (1.2 + 2.8 * f64::from(frame) / 63.0) * tremor, 0.4);
            let facts = floor.facts_with(view, &mut memory);
            memory = if remembers { memory } else { FactMemory::default() };
            facts.of(Effect::Cascades).expect("asked for").decision
        });
        let decided: Vec<Decision> = decided.collect();
        decided.windows(2).filter(|pair| pair[0] != pair[1]).count()
    };
    assert_eq!(changes(true), 1);
    assert!(changes(false) > 1);
}

/// Every effect is covered: the cases request all of them.
#[test]
fn the_cases_ask_for_every_effect() {
    let asked = every_effect();
    let others: Vec<Effect> = Effect::ALL.into_iter().filter(|effect| !asked.has(*effect)).collect();
    let beside =
        [Effect::Transmission, Effect::EdgeFade, Effect::Taa, Effect::Fog, Effect::DepthOfField, Effect::Bloom];
    assert_eq!(others, beside, "the first is the scene's, the tests above ask for the others");
}
