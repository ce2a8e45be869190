//! Order-independent transparency: pictures compared with rays that collect every layer, and counts of the plan.

mod counts;
mod lens;
mod rays;

use crate::stage::{Set, Shot, declared, gpu, lighting, view_of};
use framegraph::{Options, Plan, Scratch, compile};
use framegraph_passes::effects::fog::{FogColor, FogSettings};
use framegraph_passes::effects::transparency::{MomentPrecision, MomentTransparency};
use framegraph_passes::gpu_scene::view::Background;
use framegraph_passes::{Settings, Transparency, ViewId, World};
use framegraph_scene::environment::Sky;
use framegraph_scene::geometry::{cuboid, plane};
use framegraph_scene::{
    AlphaMode, Camera, Material, Mesh, Projection, Scene, Transmission, TransparencyMode, progress,
};
use framegraph_wgpu::{Gpu, Imports, read_texture};
use glam::{DMat4, DQuat, DVec3, Vec2, Vec3};
use std::error::Error;
use std::f64::consts::FRAC_PI_2;
use tests::executors;

type TestResult = Result<(), Box<dyn Error>>;

const SIZE_PX: [u32; 2] = [64, 48];

/// Returns an unlit surface: its color is its radiance under any light.
fn clear(color: Vec3, alpha: f32) -> Material {
    Material {
        base_color: color.extend(alpha),
        unlit: true,
        double_sided: true,
        alpha: if alpha < 1.0 { AlphaMode::Blend } else { AlphaMode::Opaque },
        ..Material::dielectric("clear", color, 0.5)
    }
}

fn looking(eye: DVec3, target: DVec3) -> Vec<Camera> {
    Camera::look_at(eye, target, DVec3::Y, Projection::perspective(0.6, 0.1)).into_iter().collect()
}

/// Colors of the faces of a box.
const PAINT: [Vec3; 6] = [
    Vec3::new(1.0, 0.2, 0.2),
    Vec3::new(0.2, 1.0, 0.2),
    Vec3::new(0.2, 0.2, 1.0),
    Vec3::new(1.0, 1.0, 0.2),
    Vec3::new(1.0, 0.2, 1.0),
    Vec3::new(0.2, 1.0, 1.0),
];

/// Returns a box with one color per face, so that their order is visible.
fn painted(half: Vec3) -> Mesh {
    let mesh = cuboid(half);
    let face = |normal: &Vec3| {
        let axis = (0..3).find(|axis| normal[*axis].abs() > 0.5).unwrap_or(0);
        PAINT[2 * axis + usize::from(normal[axis] < 0.0)].extend(1.0)
    };
    Mesh { colors: mesh.normals.iter().map(face).collect(), ..mesh }
}

/// Three panes that cross each other, a box within a box, and an opaque block behind them.
fn crossing() -> Scene {
    let mut scene = Scene { name: "crossing".into(), ..Scene::default() };
    let pane = scene.add_mesh(plane(Vec2::new(1.7, 1.3), 1, Vec2::ONE));
    let colors = [Vec3::new(0.9, 0.1, 0.05), Vec3::new(0.05, 0.6, 0.1), Vec3::new(0.05, 0.1, 0.9)];
    for (number, color) in colors.into_iter().enumerate() {
        let material = scene.add_material(clear(color, 0.55));
        let turned = DQuat::from_rotation_y(0.4 + number as f64) * DQuat::from_rotation_x(FRAC_PI_2);
        let place = DMat4::from_rotation_translation(turned, DVec3::new(-1.0, 0.0, 0.0));
        scene.add_instance("pane", pane, material, place);
    }
    for (half, color, alpha, z) in [
        (Vec3::splat(0.6), Vec3::new(0.9, 0.2, 0.1), 0.4, 0.0),
        (Vec3::splat(0.25), Vec3::new(0.1, 0.2, 0.9), 0.7, 0.25),
        (Vec3::new(3.0, 0.2, 0.1), Vec3::splat(0.7), 1.0, -1.5),
    ] {
        let mesh = scene.add_mesh(if alpha < 1.0 { painted(half) } else { cuboid(half) });
        let material = scene.add_material(clear(color, alpha));
        let x = if alpha < 1.0 { 1.0 } else { 0.0 };
        let place = DMat4::from_rotation_translation(DQuat::from_rotation_y(0.3), DVec3::new(x, 0.0, z));
        scene.add_instance("box", mesh, material, place);
    }
    scene.cameras = looking(DVec3::new(0.3, 0.9, 5.0), DVec3::ZERO);
    scene
}

/// A scene on the device, drawn by several techniques.
struct Drawn {
    scene: Scene,
    world: World,
}

impl Drawn {
    fn new(gpu: &Gpu, scene: Scene) -> Result<Self, Box<dyn Error>> {
        let shot = shot(Settings::DEFAULT);
        let lighting = lighting(gpu, &Sky::default().environment(16)?, &shot.settings.shading)?;
        let view = view_of(&scene, &lighting.image, &Background::None, &shot);
        let world = World::new(gpu, &scene, lighting, [view], &mut progress::silent)?;
        Ok(Self { scene, world })
    }

    /// Pre-exposed radiance of every pixel.
    fn texels(&self, gpu: &Gpu, transparency: Transparency, samples: u8) -> Result<Vec<Vec3>, Box<dyn Error>> {
        self.texels_of(gpu, Settings { transparency, samples, ..Settings::DEFAULT })
    }

    fn texels_of(&self, gpu: &Gpu, settings: Settings) -> Result<Vec<Vec3>, Box<dyn Error>> {
        let shot = shot(settings.for_scene(&self.scene, SIZE_PX));
        let (mut frame, io) = declared(&shot.settings);
        frame.graph_mut().readback(io.hdr)?;
        let mut plan = Plan::new();
        compile(frame.graph(), &gpu.caps(), &shot.options, &mut Scratch::new(), &mut plan)?;
        let mut executor = executors::lend(gpu);
        executor.execute(&plan, &frame, &self.world, &Imports::new())?;
        assert_eq!(executor.executed(), plan.counts(), "executed against planned");
        let texture = executor.texture(&plan, io.hdr).ok_or("the frame left no picture")?;
        Ok(read_texture(gpu, texture)?.rgba().iter().map(|[r, g, b, _]| Vec3::new(*r, *g, *b)).collect())
    }
}

/// A small picture without shadows and edge filter.
fn shot(settings: Settings) -> Shot {
    let settings = Settings { shadows: None, fxaa: false, ..settings };
    Shot { size_px: SIZE_PX, ev100: 14.5, settings, options: Options::for_frame(SIZE_PX[0], SIZE_PX[1]) }
}

/// Root mean square and greatest difference over all channels, without the share `left_out` of pixels that differ most.
fn apart(found: &[Vec3], truth: &[Vec3], left_out: f64) -> [f64; 2] {
    let mut off: Vec<f64> = found.iter().zip(truth).map(|(a, b)| f64::from((*a - *b).abs().max_element())).collect();
    off.sort_by(f64::total_cmp);
    off.truncate((off.len() as f64 * (1.0 - left_out)) as usize);
    let mean = off.iter().map(|x| x * x).sum::<f64>() / off.len().max(1) as f64;
    [mean.sqrt(), off.last().copied().unwrap_or(0.0)]
}

fn most_samples(gpu: &Gpu) -> u8 {
    // OpenGL reads no depth of several samples.
    if gpu.info().backend == wgpu::Backend::Gl { 1 } else { 4 }
}

fn moments(precision: MomentPrecision) -> Transparency {
    Transparency::Moments(MomentTransparency { precision, ..MomentTransparency::DEFAULT })
}

/// Peeling shows what rays find, and every other technique is off by its bound. Sorting is the control: it is wrong.
#[test]
fn techniques_against_rays() -> TestResult {
    let Some(gpu) = gpu("techniques_against_rays") else { return Ok(()) };
    let drawn = Drawn::new(&gpu, crossing())?;
    for samples in [1, 4].into_iter().filter(|samples| *samples <= most_samples(&gpu)) {
        let truth = rays::picture(&drawn.scene, SIZE_PX, samples);
        let off =
            |transparency| Ok::<_, Box<dyn Error>>(apart(&drawn.texels(&gpu, transparency, samples)?, &truth, 0.01));
        let [sorted, weighted, half, peeled] = [
            off(Transparency::Sorted)?,
            off(Transparency::Weighted)?,
            off(moments(MomentPrecision::Half))?,
            off(Transparency::Peeled { layers: 10 })?,
        ];
        let told =
            format!("{samples} samples: sorted {sorted:?}, weighted {weighted:?}, moments {half:?}, peeled {peeled:?}");
        assert!(peeled[1] < 2e-3, "{told}");
        assert!(sorted[0] > 0.02 && sorted[1] > 0.1, "{told}");
        assert!(weighted[0] < 0.06 && half[0] < 0.015, "{told}");
        if samples == 1 {
            let two = off(Transparency::TwoPasses)?;
            let few = off(Transparency::Peeled { layers: 2 })?;
            assert!(two[0] < sorted[0], "{two:?} {told}");
            assert!(few[0] > 10.0 * peeled[0], "{few:?} {told}");
            if gpu.device.features().contains(wgpu::Features::FLOAT32_BLENDABLE) {
                let full = off(moments(MomentPrecision::Full))?;
                assert!(full[0] < 0.008, "{full:?} {told}");
            }
        }
    }
    Ok(())
}

/// Post-processing that ends the pass that composes grades what a pass of its own would, to a code.
#[test]
fn post_processing_is_inlined_into_the_pass_that_composes() -> TestResult {
    let Some(gpu) = gpu("post_processing_is_inlined_into_the_pass_that_composes") else { return Ok(()) };
    let mut own = shot(Settings { transparency: Transparency::Weighted, ..Settings::DEFAULT });
    own.settings.post.dither = 0.0;
    let set = Set::of(&gpu, crossing(), &own, &Background::None)?;
    let (inlined, plan) = set.shoot(&gpu, &own)?;
    own.options.inline = false;
    let (apart, plan_apart) = set.shoot(&gpu, &own)?;
    assert_eq!([plan.counts().inlined, plan_apart.counts().inlined], [1, 0]);
    let most = inlined.iter().zip(&apart).map(|(a, b)| a.abs_diff(*b)).max();
    assert!(most <= Some(1) && inlined.iter().any(|code| *code > 100), "{most:?} codes");
    Ok(())
}

/// Panes of these colors and alphas before each other, the first nearest; drawn in another order.
fn stack(layers: &[(Vec3, f32, f64)]) -> Scene {
    let mut scene = Scene { name: "stack".into(), ..Scene::default() };
    let mesh = scene.add_mesh(plane(Vec2::splat(40.0), 1, Vec2::ONE));
    for (color, alpha, z) in layers.iter().rev() {
        let mut material = clear(*color, *alpha);
        material.alpha = AlphaMode::Blend;
        let material = scene.add_material(material);
        let turned = DQuat::from_rotation_x(FRAC_PI_2);
        scene.add_instance("pane", mesh, material, DMat4::from_rotation_translation(turned, DVec3::Z * -*z));
    }
    scene.cameras = looking(DVec3::ZERO, DVec3::NEG_Z);
    scene
}

/// Returns the composite of layers over black, with the first in front.
fn over(layers: &[(Vec3, f32, f64)]) -> Vec3 {
    layers.iter().rev().fold(Vec3::ZERO, |behind, (color, alpha, _)| behind.lerp(*color, *alpha))
}

/// Hard inputs: one layer, layers at equal depth, an opaque layer, depths from centimeters to hundreds of meters.
#[test]
fn hard_stacks() -> TestResult {
    let Some(gpu) = gpu("hard_stacks") else { return Ok(()) };
    let (red, green, blue) = (Vec3::new(0.9, 0.1, 0.1), Vec3::new(0.1, 0.8, 0.1), Vec3::new(0.1, 0.1, 0.9));
    let techniques = [Transparency::Weighted, moments(MomentPrecision::Half), Transparency::Peeled { layers: 4 }];
    for (name, layers, bounds) in [
        ("one layer", vec![(red, 0.3, 5.0)], [2e-3, 2e-3, 1e-3]),
        ("equal colors and depths", vec![(green, 0.4, 5.0), (green, 0.4, 5.0)], [2e-3, 2e-3, 1e-3]),
        ("opaque in front", vec![(red, 1.0, 3.0), (blue, 0.5, 9.0)], [0.2, 0.01, 1e-3]),
        ("opaque behind", vec![(red, 0.4, 3.0), (blue, 1.0, 9.0)], [0.5, 0.5, 1e-3]),
        ("deep", vec![(red, 0.5, 0.2), (green, 0.5, 30.0), (blue, 0.5, 400.0)], [0.3, 0.1, 1e-3]),
        ("invisible", vec![(red, 0.0, 3.0), (green, 0.5, 4.0)], [2e-3, 2e-3, 1e-3]),
    ] {
        let drawn = Drawn::new(&gpu, stack(&layers))?;
        let truth = over(&layers);
        for (technique, most) in techniques.into_iter().zip(bounds) {
            let texels = drawn.texels(&gpu, technique, 1)?;
            let found = texels[texels.len() / 2 + SIZE_PX[0] as usize / 2];
            let off = (found - truth).abs().max_element();
            assert!(off < most, "{name}, {}: {found} for {truth}", technique.name());
        }
    }
    Ok(())
}

/// A pane of blended glass before an opaque block, in fog: one layer, which every technique draws as sorting does.
#[test]
fn blended_glass_in_fog_is_what_it_is_sorted() -> TestResult {
    let Some(gpu) = gpu("blended_glass_in_fog_is_what_it_is_sorted") else { return Ok(()) };
    let mut scene = Scene { name: "glass".into(), ..Scene::default() };
    let block = scene.add_mesh(cuboid(Vec3::new(3.0, 0.4, 0.1)));
    let material = scene.add_material(clear(Vec3::new(0.7, 0.3, 0.1), 1.0));
    scene.add_instance("block", block, material, DMat4::from_translation(DVec3::NEG_Z));
    let pane = scene.add_mesh(plane(Vec2::splat(1.6), 1, Vec2::ONE));
    let transmission = Some(Transmission { factor: 1.0, texture: None, volume: None });
    let glass = Material { unlit: false, transmission, ..clear(Vec3::new(0.4, 0.9, 0.5), 0.6) };
    let glass = scene.add_material(glass);
    let turned = DQuat::from_rotation_y(0.4) * DQuat::from_rotation_x(FRAC_PI_2);
    scene.add_instance("pane", pane, glass, DMat4::from_rotation_translation(turned, DVec3::ZERO));
    scene.cameras = looking(DVec3::new(0.0, 0.3, 4.0), DVec3::ZERO);
    let drawn = Drawn::new(&gpu, scene)?;
    let color = FogColor::Radiance([9000.0, 4000.0, 14_000.0]);
    let fog = Some(FogSettings { density: 0.15, falloff: 0.0, color, ..FogSettings::DEFAULT });
    let of = |transparency| drawn.texels_of(&gpu, Settings { transparency, fog, ..Settings::DEFAULT });
    let sorted = of(Transparency::Sorted)?;
    let clear_air = drawn.texels(&gpu, Transparency::Sorted, 1)?;
    assert!(apart(&sorted, &clear_air, 0.0)[0] > 0.05, "there is fog");
    for technique in [Transparency::Weighted, moments(MomentPrecision::Half), Transparency::Peeled { layers: 1 }] {
        let off = apart(&of(technique)?, &sorted, 0.0);
        assert!(off[1] < 4e-3, "{}: {off:?}", technique.name());
    }
    Ok(())
}

/// Filament's modes of a material: with two passes a box shows its back faces behind its front faces, and with one side nothing but the
/// nearest.
#[test]
fn two_passes_of_a_material() -> TestResult {
    let Some(gpu) = gpu("two_passes_of_a_material") else { return Ok(()) };
    let seen = |mode| {
        let mut scene = Scene { name: "box".into(), ..Scene::default() };
        // Seen from opposite sides, one of the boxes has front faces that come first in the mesh.
        let mesh = scene.add_mesh(painted(Vec3::splat(0.5)));
        let material = Material { transparency: mode, ..clear(Vec3::new(0.2, 0.5, 0.8), 0.5) };
        let material = scene.add_material(material);
        for (x, turn) in [(-0.9, 0.6), (0.9, 0.6 + 2.0 * FRAC_PI_2)] {
            let turned = DQuat::from_rotation_y(turn);
            scene.add_instance("box", mesh, material, DMat4::from_rotation_translation(turned, DVec3::X * x));
        }
        scene.cameras = looking(DVec3::new(0.0, 1.2, 4.0), DVec3::ZERO);
        let drawn = Drawn::new(&gpu, scene)?;
        let truth = rays::picture(&drawn.scene, SIZE_PX, 1);
        Ok::<_, Box<dyn Error>>((drawn.texels(&gpu, Transparency::Sorted, 1)?, truth))
    };
    let (both, truth) = seen(TransparencyMode::TwoPassesTwoSides)?;
    let (default, _) = seen(TransparencyMode::Default)?;
    let [both, default] = [both, default].map(|found| apart(&found, &truth, 0.01));
    assert!(both[1] < 2e-3 && default[0] > 0.02, "{both:?} {default:?}");
    let (one, _) = seen(TransparencyMode::TwoPassesOneSide)?;
    // Half of a face's color, and nothing of another.
    let layer = |texel: &Vec3| {
        PAINT.iter().any(|paint| (*texel - *paint * Vec3::new(0.2, 0.5, 0.8) * 0.5).abs().max_element() < 2e-3)
    };
    let single = one.iter().filter(|texel| layer(texel)).count();
    let black = one.iter().filter(|texel| texel.max_element() == 0.0).count();
    assert!(single > 300 && single + black > one.len() - 20, "{single} {black}");
    assert!(apart(&one, &truth, 0.01)[0] > 0.02);
    Ok(())
}

#[test]
fn the_range_of_moments_is_that_of_blended_surfaces_in_view() -> TestResult {
    let Some(gpu) = gpu("the_range_of_moments_is_that_of_blended_surfaces_in_view") else { return Ok(()) };
    let drawn = Drawn::new(&gpu, stack(&[(Vec3::ONE, 0.5, 2.0), (Vec3::ONE, 0.5, 800.0)]))?;
    let views: &framegraph_passes::gpu_scene::view::Views = drawn.world.as_ref();
    let range = views.get(ViewId::MAIN)?.view.frame.blended;
    let warped = |distance_m: f32| distance_m.log2() * range.x + range.y;
    let ends = [warped(2.0), warped(800.0)];
    assert!((-1.0..-0.95).contains(&ends[0]) && (0.95..1.0).contains(&ends[1]), "{ends:?}");
    Ok(())
}
