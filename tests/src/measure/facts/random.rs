//! Random scenes with random settings: planes, boxes and spheres with all kinds of materials, lights, fog and lens.

use super::{Case, every_effect, matt, scene, sun};
use framegraph_passes::effects::fog::FogSettings;
use framegraph_passes::gpu_scene::shadow_views::{ContactShadows, Fit, ShadowFilter, ShadowSettings};
use framegraph_passes::gpu_scene::view::Background;
use framegraph_passes::{BloomSettings, DofSettings, Settings};
use framegraph_scene::geometry::{cuboid, plane, sphere};
use framegraph_scene::material::AlphaMode;
use framegraph_scene::{ClearCoat, Light, LightKind, Material, Scene, Sheen, Transmission};
use framegraph_shaders::layout::ToneMap;
use glam::{DMat4, DQuat, DVec3, EulerRot, Vec2, Vec3};

/// Width and height of the pictures, in pixels.
pub const SMALL_PX: [u32; 2] = [48, 32];

/// Pseudo-random numbers that are the same on every machine (Steele, Lea and Flood, "Fast splittable pseudorandom
/// number generators", 2014).
#[derive(Debug)]
pub struct Dice(u64);

impl Dice {
    /// Creates a generator from a seed.
    pub const fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15))
    }

    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ z >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ z >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ z >> 31
    }

    /// Returns a number in 0…1.
    pub fn unit(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Returns a number between two others, uniformly.
    pub fn between(&mut self, from: f64, to: f64) -> f64 {
        from + (to - from) * self.unit()
    }

    /// Returns a number between two positive numbers, uniform in the logarithm.
    pub fn scaled(&mut self, from: f64, to: f64) -> f64 {
        from * (to / from).powf(self.unit())
    }

    /// Returns true with a given probability.
    pub fn chance(&mut self, probability: f64) -> bool {
        self.unit() < probability
    }

    /// Returns a random element.
    pub fn pick<T: Copy>(&mut self, of: &[T]) -> T {
        of[(self.next() % of.len() as u64) as usize]
    }

    fn point(&mut self, half: f64) -> DVec3 {
        DVec3::new(self.between(-half, half), self.between(-half, half), self.between(-half, half))
    }

    fn color(&mut self) -> Vec3 {
        (self.point(0.5) + 0.5).as_vec3()
    }
}

fn material(dice: &mut Dice) -> Material {
    let (color, roughness) = (dice.color(), dice.unit() as f32);
    let mut made =
        if dice.chance(0.25) { Material::metal("metal", color, roughness) } else { matt("matt", color, roughness) };
    made.double_sided = dice.chance(0.4);
    match dice.pick(&[0, 0, 0, 0, 1, 2, 3, 4, 5, 6]) {
        1 => made.unlit = true,
        2 => {
            made.alpha = AlphaMode::Blend;
            made.base_color.w = dice.unit() as f32;
        }
        3 => made.transmission = Some(Transmission { factor: dice.unit() as f32, ..Transmission::default() }),
        4 => made.clear_coat = Some(ClearCoat { factor: 1.0, roughness: dice.unit() as f32, ..ClearCoat::default() }),
        5 => made.sheen = Some(Sheen { color: dice.color(), roughness, ..Sheen::default() }),
        6 => made.emissive = dice.color() * dice.scaled(0.01, 10.0) as f32,
        _ => {}
    }
    made
}

fn thing(dice: &mut Dice, scene: &mut Scene) {
    let size = dice.scaled(0.1, 3.0);
    let mesh = match dice.pick(&[0, 1, 2, 3]) {
        0 => plane(Vec2::splat(2.0 * size as f32), dice.pick(&[1, 3]), Vec2::ONE),
        1 => cuboid((Vec3::new(0.2, 0.2, 0.2) + dice.color()) * size as f32),
        // A thin box.
        2 => cuboid(Vec3::new(size as f32, dice.scaled(1e-4, 0.02) as f32, size as f32)),
        _ => sphere(0.5 * size as f32, 16, 8),
    };
    let turned = if dice.chance(0.4) {
        DQuat::IDENTITY
    } else {
        DQuat::from_euler(EulerRot::XYZ, dice.between(-1.6, 1.6), dice.between(-3.1, 3.1), dice.between(-1.6, 1.6))
    };
    let at = dice.point(1.5) + DVec3::Y;
    let (mesh, material) = (scene.add_mesh(mesh), scene.add_material(material(dice)));
    scene.add_instance("thing", mesh, material, DMat4::from_rotation_translation(turned, at));
}

fn lights(dice: &mut Dice, scene: &mut Scene) {
    if dice.chance(0.7) {
        let direction = (dice.point(1.0) - DVec3::Y * dice.unit()).as_vec3().normalize_or(Vec3::NEG_Y);
        scene.lights.push(Light { direction, ..sun() });
    }
    for _ in 0..dice.pick(&[0, 0, 1, 2]) {
        let (intensity_candela, range_m) = (dice.scaled(100.0, 10_000.0) as f32, Some(dice.scaled(1.0, 10.0) as f32));
        let kind = if dice.chance(0.5) {
            LightKind::Point { intensity_candela, range_m }
        } else {
            LightKind::Spot { intensity_candela, range_m, inner_cone_rad: 0.3, outer_cone_rad: 0.7 }
        };
        let position = dice.point(3.0) + DVec3::Y * 2.0;
        scene.lights.push(Light { kind, position, ..Light::directional("punctual", Vec3::NEG_Y, 0.0) });
    }
}

fn settings(dice: &mut Dice) -> Settings {
    let every = every_effect();
    let shadows = ShadowSettings {
        cascades: dice.pick(&[1, 1, 2, 4]),
        filter: dice.pick(&[ShadowFilter::Pcf, ShadowFilter::Pcss, ShadowFilter::Dpcf, ShadowFilter::Vsm]),
        fit: dice.pick(&[Fit::Tight { lispsm: true }, Fit::Tight { lispsm: false }, Fit::Stable]),
        local_maps: dice.pick(&[0, 4]),
        contact: Some(ContactShadows::FILAMENT).filter(|_| dice.chance(0.2)),
        ..ShadowSettings::texels(128)
    };
    let mut asked = Settings {
        samples: dice.pick(&[1, 1, 4]),
        shadows: Some(shadows).filter(|_| dice.chance(0.8)),
        occlusion: every.occlusion.filter(|_| dice.chance(0.3)),
        reflections: every.reflections.filter(|_| dice.chance(0.2)),
        fxaa: dice.chance(0.2),
        prepass: dice.chance(0.7),
        ..every
    };
    if dice.chance(0.4) {
        asked.fog = Some(FogSettings {
            density: dice.scaled(1e-5, 1.0) as f32,
            falloff: dice.pick(&[0.0, 1.0]),
            cut_off_m: dice.pick(&[f32::INFINITY, 20.0]),
            ..FogSettings::DEFAULT
        });
    }
    if dice.chance(0.2) {
        let f_number = dice.scaled(0.5, 64.0) as f32;
        asked.dof = Some(DofSettings { focus_m: 3.0, f_number, focal_length_m: Some(0.05), ..DofSettings::DEFAULT });
    }
    if dice.chance(0.2) {
        asked.bloom = Some(BloomSettings { threshold_at: dice.scaled(0.1, 10.0) as f32, ..BloomSettings::DEFAULT });
    }
    if dice.chance(0.3) {
        asked.post = framegraph_passes::PostSettings::DEFAULT;
        asked.post.look.tone_map = dice.pick(&[ToneMap::Linear, every.post.look.tone_map]);
    }
    asked
}

/// Creates the scene `number` with the settings `of_settings`. Scenes with the same settings share most shaders.
pub fn random_case(number: u64, of_settings: u64) -> Case {
    let mut dice = Dice::new(number);
    let eye = DVec3::new(dice.between(-2.0, 2.0), dice.between(0.3, 4.0), dice.between(2.0, 5.0));
    let mut made = scene(eye, DVec3::new(0.0, dice.between(0.0, 1.0), 0.0));
    if dice.chance(0.4) {
        let (mesh, material) =
            (made.add_mesh(plane(Vec2::splat(9.0), 1, Vec2::ONE)), made.add_material(material(&mut dice)));
        made.add_instance("ground", mesh, material, DMat4::IDENTITY);
    }
    for _ in 0..dice.pick(&[0, 1, 1, 2, 3, 5]) {
        thing(&mut dice, &mut made);
    }
    lights(&mut dice, &mut made);
    // Three skies, so that environments are filtered only three times.
    let nits = DVec3::splat(dice.pick(&[0.0, 1000.0, 2000.0]));
    let background =
        if dice.chance(0.5) { Background::Environment } else { Background::Constant(dice.color() * 1000.0) };
    let asked = Settings { blended: true, ..settings(&mut Dice::new(!of_settings)).for_scene(&made, SMALL_PX) };
    let ev100 = dice.between(8.0, 15.0) as f32;
    Case { name: "random", scene: made, nits, background, asked, ev100, size_px: SMALL_PX }
}
