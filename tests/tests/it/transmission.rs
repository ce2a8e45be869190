//! Transmissive surfaces: plans of their passes, and the light that passes through them.

mod blended;
mod layers;

use crate::stage::{Shot, declared, gpu, lighting, plan, view_of};
use framegraph::{Caps, Counts, Options, Plan, Scratch, compile};
use framegraph_passes::effects::transmission::scene_levels;
use framegraph_passes::gpu_scene::view::Background;
use framegraph_passes::light::shading::TransmissionBlur;
use framegraph_passes::{Settings, Shading, World};
use framegraph_scene::environment::Sky;
use framegraph_scene::geometry::plane;
use framegraph_scene::{Camera, Material, MaterialId, Projection, Scene, Specular, Transmission, Volume, progress};
use framegraph_wgpu::{Gpu, Imports, read_texture};
use glam::{DMat4, DQuat, DVec3, Vec2, Vec3};
use std::error::Error;
use tests::executors;

type TestResult = Result<(), Box<dyn Error>>;

const FRAME: [u32; 2] = [1280, 720];

fn counts(settings: Settings) -> Counts {
    plan(&settings, &Caps::wgpu(), &Options::for_frame(FRAME[0], FRAME[1])).counts()
}

/// step             attachment    load       store
/// shadow           shadow_map    clear      STORE   (color and transparent sample it)
/// prepass + color  hdr           clear      STORE   (the copy samples it)
///                  depth         clear      STORE   (the copy samples it, transparent tests against it)
/// scene/copy       scene level 0 don't care STORE
/// scene/level      scene level 1 don't care STORE   (and so on: a step and a store for each further level)
/// transparent      hdr           LOAD       STORE   (post reads it)
///                  depth         LOAD       discard
/// post             ldr           don't care STORE
/// fxaa             output        don't care STORE
#[test]
fn one_sample() {
    for levels in [1, 3, 9] {
        let further = u32::from(levels) - 1;
        let found = counts(Settings { scene_levels: levels, ..Settings::default() });
        let expected = Counts {
            unresolves: 2,
            resolves: 7 + further,
            clears: 3,
            discards: 1,
            multisample_resolves: 0,
            memoryless: 0,
            inlined: 0,
            steps: 6 + further,
            render_passes: 6 + further,
            passes: 7 + further,
            culled: 0,
        };
        assert_eq!(found, expected, "{levels} levels");
    }
}

/// With four samples, color and depth are stored and loaded per sample, and resolved twice: for the copy, and at the
/// end. The first resolve is one more store.
#[test]
fn four_samples() {
    let one = counts(Settings { scene_levels: 4, ..Settings::default() });
    let four = counts(Settings { scene_levels: 4, samples: 4, ..Settings::default() });
    let expected = Counts { resolves: one.resolves + 1, discards: one.discards + 1, multisample_resolves: 2, ..one };
    assert_eq!(four, expected);
}

#[test]
fn levels_follow_the_size_of_the_frame() {
    let found = [[1, 1], [64, 36], [1920, 1080], [1080, 1920]].map(scene_levels);
    assert_eq!(found, [1, 4, 9, 9]);
}

const FOV_Y_RAD: f64 = 0.6;
const EYE_M: f64 = 5.0;

/// Returns a floor with an optional pane over the center of the picture, seen from above.
fn stage(pane: Option<Material>) -> Scene {
    let mut scene = Scene { name: "pane".into(), ..Scene::default() };
    let floor = scene.add_mesh(plane(Vec2::splat(40.0), 1, Vec2::ONE));
    let material = scene.add_material(Material::dielectric("floor", Vec3::new(0.8, 0.5, 0.3), 0.9));
    scene.add_instance("floor", floor, material, DMat4::IDENTITY);
    if let Some(pane) = pane {
        let mesh = scene.add_mesh(plane(Vec2::splat(2.0), 1, Vec2::ONE));
        let material = scene.add_material(pane);
        scene.add_instance("pane", mesh, material, DMat4::from_translation(DVec3::Y));
    }
    let projection = Projection::perspective(FOV_Y_RAD, 0.1);
    let camera = Camera::look_at(DVec3::new(0.0, EYE_M, 0.0), DVec3::ZERO, DVec3::NEG_Z, projection);
    scene.cameras.extend(camera);
    scene
}

/// Returns the pre-exposed radiance in the center of the picture.
fn middle(gpu: &Gpu, scene: &Scene, settings: Settings) -> Result<Vec3, Box<dyn Error>> {
    let row = middle_row(gpu, scene, settings)?;
    Ok(row[row.len() / 2])
}

/// Returns the pre-exposed radiance along the middle row of the picture.
fn middle_row(gpu: &Gpu, scene: &Scene, settings: Settings) -> Result<Vec<Vec3>, Box<dyn Error>> {
    let [width, height] = Shot::small(settings).size_px;
    let texels = texels(gpu, scene, settings)?;
    let row = texels.chunks_exact(width as usize).nth(height as usize / 2).ok_or("the picture has no rows")?;
    Ok(row.to_vec())
}

/// Returns the pre-exposed radiance of the whole picture.
fn texels(gpu: &Gpu, scene: &Scene, settings: Settings) -> Result<Vec<Vec3>, Box<dyn Error>> {
    let shot = Shot::small(Settings { shadows: None, ..settings });
    let environment = Sky::default().environment(64)?;
    let lighting = lighting(gpu, &environment, &shot.settings.shading)?;
    let view = view_of(scene, &lighting.image, &Background::None, &shot);
    let world = World::new(gpu, scene, lighting, [view], &mut progress::silent)?;
    let (mut frame, io) = declared(&shot.settings);
    frame.graph_mut().readback(io.hdr)?;
    let mut plan = Plan::new();
    compile(frame.graph(), &gpu.caps(), &shot.options, &mut Scratch::new(), &mut plan)?;
    let mut executor = executors::lend(gpu);
    executor.execute(&plan, &frame, &world, &Imports::new())?;
    assert_eq!(executor.executed(), plan.counts(), "executed against planned");
    let texture = executor.texture(&plan, io.hdr).ok_or("the frame left no picture")?;
    Ok(read_texture(gpu, texture)?.rgba().iter().map(|[r, g, b, _]| Vec3::new(*r, *g, *b)).collect())
}

/// Returns a pane without reflections, so that only transmitted light is visible.
fn pane(tint: Vec3, volume: Option<Volume>) -> Material {
    Material {
        transmission: Some(Transmission { factor: 1.0, texture: None, volume }),
        specular: Some(Specular { factor: 0.0, ..Specular::default() }),
        ..Material::dielectric("pane", tint, 0.0)
    }
}

/// At normal incidence, a pane shows the floor times its tint times the absorption of its volume (Beer-Lambert law). A
/// transmission of 0.5 mixes this equally with the color of an opaque pane.
#[test]
fn what_is_behind_is_tinted_and_absorbed() -> TestResult {
    let Some(gpu) = gpu("what_is_behind_is_tinted_and_absorbed") else { return Ok(()) };
    let tint = Vec3::new(0.9, 0.5, 0.2);
    // OpenGL does not support it and reports so; see the last test.
    let most = if gpu.info().backend == wgpu::Backend::Gl { 1 } else { 4 };
    for samples in [1, 4].into_iter().filter(|samples| *samples <= most) {
        let settings = Settings { samples, ..Settings::default() };
        let seen = |pane: Option<Material>| {
            let scene = stage(pane);
            let size_px = Shot::small(settings).size_px;
            middle(&gpu, &scene, settings.for_scene(&scene, size_px))
        };
        let floor = seen(None)?;
        assert!(floor.min_element() > 0.01, "the floor is lit: {floor}");
        // Three roundings to half floats.
        let near = |found: Vec3, expected: Vec3| ((found - expected) / expected).abs().max_element() < 4e-3;
        let wall = seen(Some(pane(tint, None)))?;
        assert!(near(wall, floor * tint), "{wall} against {}", floor * tint);
        // Negative control: a pane with another tint.
        assert!(!near(seen(Some(pane(tint * 0.98, None)))?, floor * tint));
        let volume = Volume {
            thickness: 0.5,
            attenuation_color: Vec3::new(0.25, 0.5, 1.0),
            attenuation_distance_m: 1.0,
            ..Volume::default()
        };
        let body = seen(Some(pane(Vec3::ONE, Some(volume))))?;
        let left = Vec3::new(0.5, 0.5_f32.sqrt(), 1.0);
        assert!(near(body, floor * left), "{body} against {}", floor * left);

        let half = Transmission { factor: 0.5, ..Transmission::default() };
        let half = seen(Some(Material { transmission: Some(half), ..pane(tint, None) }))?;
        let opaque = seen(Some(Material { transmission: None, ..pane(tint, None) }))?;
        assert!(near(half, (wall + opaque) * 0.5), "{half} against {wall} and {opaque}");
    }
    Ok(())
}

/// Integrates the Gaussian from −∞ to `x` standard deviations by Simpson's rule, with an error of 1e-6 here.
pub fn below(x: f64) -> f64 {
    let density = |t: f64| (-t * t / 2.0).exp() / std::f64::consts::TAU.sqrt();
    let (steps, from) = (200, -6.0);
    let width = (x.clamp(from, 6.0) - from) / f64::from(steps);
    let at = |i: i32| density(from + width * f64::from(i)) * if i % 2 == 1 { 4.0 } else { 2.0 };
    ((1..steps).map(at).sum::<f64>() + density(from) + density(x.clamp(from, 6.0))) * width / 3.0
}

/// Frosted glass 1 m above an edge between a dark and a bright floor shows the edge blurred by a Gaussian. Its standard
/// deviation is 0.85 alpha (n − 1) m, by which the glass's facets spread light over 1 m. Glass on the floor shows the
/// edge sharp.
#[test]
fn rough_glass_blurs_by_its_distance_from_what_is_behind() -> TestResult {
    let Some(gpu) = gpu("rough_glass_blurs_by_its_distance_from_what_is_behind") else { return Ok(()) };
    // The whole stage is turned, eye and all, so that no axis of the world is one of the view's.
    let blurred = |blur: TransmissionBlur,
                   roughness: f32,
                   height_m: f64,
                   turn: DQuat,
                   body: Option<Volume>|
     -> Result<Vec<f64>, Box<dyn Error>> {
        let mut scene = stage(Some(Material { roughness, ..pane(Vec3::ONE, body) }));
        // Two halves instead of one floor, and the pane at another height.
        scene.materials[0].base_color = Vec3::splat(0.05).extend(1.0);
        let bright = scene.add_material(Material::dielectric("bright", Vec3::splat(0.8), 0.9));
        let floor = scene.instances[0].mesh;
        scene.instances.remove(0);
        scene.add_instance("dark", floor, MaterialId::new(0), DMat4::from_translation(DVec3::NEG_X * 20.0));
        scene.add_instance("bright", floor, bright, DMat4::from_translation(DVec3::X * 20.0));
        let pane = scene.instances.remove(0);
        scene.add_instance("pane", pane.mesh, pane.material, DMat4::from_translation(DVec3::Y * height_m));
        for instance in std::mem::take(&mut scene.instances) {
            let turned = DMat4::from_quat(turn) * instance.world_from_model;
            scene.add_instance(&instance.name, instance.mesh, instance.material, turned);
        }
        for camera in &mut scene.cameras {
            (camera.eye, camera.world_from_view) = (turn * camera.eye, turn * camera.world_from_view);
        }
        let size_px = Shot::small(Settings::default()).size_px;
        let shading = Shading { transmission_blur: blur, ..Shading::default() };
        let settings = Settings { shading, ..Settings::default() };
        let row = middle_row(&gpu, &scene, settings.for_scene(&scene, size_px))?;
        // Texels covered by the pane: more than 40 around the center.
        let covered: Vec<f64> = row[row.len() / 2 - 20..row.len() / 2 + 20].iter().map(|c| f64::from(c.x)).collect();
        let (dark, bright) = (covered[0], covered[39]);
        assert!(bright > 4.0 * dark, "both floors are seen: {dark} {bright}");
        Ok(covered.iter().map(|c| (c - dark) / (bright - dark)).collect())
    };
    let pixels_per_m = f64::from(Shot::small(Settings::default()).size_px[1]) / (2.0 * EYE_M * (FOV_Y_RAD / 2.0).tan());
    let worst = |row: &[f64], sigma_m: f64| {
        let sigma_px = sigma_m * pixels_per_m;
        let off = |(i, found): (usize, &f64)| (found - below((i as f64 - 19.5) / sigma_px)).abs();
        row.iter().enumerate().map(off).fold(0.0, f64::max)
    };
    let over_an_edge = |roughness: f32, height_m: f64, turn: DQuat| {
        blurred(TransmissionBlur::Distance, roughness, height_m, turn, None)
    };
    let (still, aslant) = (DQuat::IDENTITY, DQuat::from_axis_angle(DVec3::new(2.0, 3.0, 6.0) / 7.0, 0.6));
    for (roughness, turn) in [(0.4_f32, still), (0.55, still), (0.55, aslant)] {
        let sigma_m = 0.849 * f64::from(roughness * roughness) * 0.5;
        let row = over_an_edge(roughness, 1.0, turn)?;
        let off = worst(&row, sigma_m);
        // Levels are powers of two, read with trilinear filters: an error of a few percent of the step.
        assert!(off < 0.06, "roughness {roughness}: {off:.3} of the step; {row:.2?}");
        // Negative controls: half and twice the blur.
        let (half, twice) = (worst(&row, sigma_m / 2.0), worst(&row, sigma_m * 2.0));
        assert!(half > 0.09 && twice > 0.09, "roughness {roughness}: {half:.3}, {twice:.3}");
    }
    // A body half a meter thick: over the way within it the spread is that in air over the index.
    let body = Volume { thickness: 0.5, ..Volume::default() };
    let row = blurred(TransmissionBlur::Distance, 0.55, 1.0, still, Some(body))?;
    let sigma_m = 0.849 * 0.55_f64.powi(2) * 0.5 * (0.5 + 0.5 / 1.5);
    let (off, without) = (worst(&row, sigma_m), worst(&row, sigma_m * 0.6));
    assert!(off < 0.06 && without > 0.07, "within the body: {off:.3}, {without:.3}; {row:.2?}");
    let near = over_an_edge(0.55, 0.02, still)?;
    assert!(worst(&near, 1e-3) < 0.06, "{near:.2?}");
    // Filament's blur is an angle from the eye, r² / √10 radians, for any distance to the floor.
    for height_m in [0.02, 1.0] {
        let sigma_m = 0.35_f64.powi(2) / 10.0_f64.sqrt() * EYE_M;
        let row = blurred(TransmissionBlur::Angle, 0.35, height_m, still, None)?;
        let [off, half, twice] = [1.0, 0.5, 2.0].map(|factor| worst(&row, sigma_m * factor));
        assert!(off < 0.06 && half > 0.09 && twice > 0.09, "{height_m} m: {off:.3} {half:.3} {twice:.3}; {row:.2?}");
    }
    Ok(())
}

/// A rough pane close to a floor shows it unchanged up to two pixels from its end. The empty background beside it does
/// not change the distance that determines the blur, with one sample and with four.
#[test]
fn distance_is_that_of_what_is_seen() -> TestResult {
    let Some(gpu) = gpu("distance_is_that_of_what_is_seen") else { return Ok(()) };
    // OpenGL does not support it and reports so; see the last test.
    let most = if gpu.info().backend == wgpu::Backend::Gl { 1 } else { 4 };
    for samples in [1, 4].into_iter().filter(|samples| *samples <= most) {
        let settings = Settings { samples, ..Settings::default() };
        let seen = |pane: Option<Material>| -> Result<Vec<Vec3>, Box<dyn Error>> {
            let mut scene = stage(pane);
            let floor = scene.instances.remove(0);
            scene.add_instance("floor", floor.mesh, floor.material, DMat4::from_translation(DVec3::X * 20.0));
            if scene.instances.len() > 1 {
                let pane = scene.instances.remove(0);
                scene.add_instance("pane", pane.mesh, pane.material, DMat4::from_translation(DVec3::Y * 0.005));
            }
            let size_px = Shot::small(settings).size_px;
            let row = middle_row(&gpu, &scene, settings.for_scene(&scene, size_px))?;
            Ok(row[row.len() / 2..row.len() / 2 + 20].to_vec())
        };
        let (floor, through) = (seen(None)?, seen(Some(Material { roughness: 0.5, ..pane(Vec3::ONE, None) }))?);
        // Three roundings to half floats. Closer to the end, the linear filter includes it.
        let off = |pixel: usize| ((through[pixel] - floor[pixel]) / floor[pixel]).abs().max_element();
        let worst = (2..20).map(off).fold(0.0, f32::max);
        assert!(worst < 4e-3, "{samples} samples: {worst}; {through:?} for {floor:?}");
    }
    Ok(())
}

/// Through a volume, the floor's edge appears where refracted rays exit, by Snell's law: a ray travels the thickness
/// times the cosine of its angle inside.
#[test]
fn a_body_shows_what_is_where_its_rays_leave_it() -> TestResult {
    let Some(gpu) = gpu("a_body_shows_what_is_where_its_rays_leave_it") else { return Ok(()) };
    let (ior, thickness, edge) = (2.4, 0.9, 0.9);
    let volume = Volume { thickness: thickness as f32, ..Volume::default() };
    let mut scene = stage(Some(Material { ior: ior as f32, ..pane(Vec3::ONE, Some(volume)) }));
    scene.materials[0].base_color = Vec3::splat(0.05).extend(1.0);
    let bright = scene.add_material(Material::dielectric("bright", Vec3::splat(0.8), 0.9));
    let floor = scene.instances[0].mesh;
    let above = DMat4::from_translation(DVec3::new(20.0 + edge, 1e-3, 0.0));
    scene.add_instance("bright", floor, bright, above);
    let shot = Shot::small(Settings::default());
    let row = middle_row(&gpu, &scene, Settings::default().for_scene(&scene, shot.size_px))?;
    let [width, height] = shot.size_px.map(f64::from);
    let mut told_apart = 0;
    for (index, seen) in row.iter().enumerate() {
        let tangent = ((2.0 * index as f64 + 1.0) / width - 1.0) * width / height * (FOV_Y_RAD / 2.0).tan();
        // On the pane, at a height of 1 m, within its border.
        let entered = (EYE_M - 1.0) * tangent;
        let sine = tangent / (1.0 + tangent * tangent).sqrt() / ior;
        let cosine = (1.0 - sine * sine).sqrt();
        let way = thickness * cosine;
        let left = (entered + way * sine) * EYE_M / (EYE_M - (1.0 - way * cosine));
        // Texels are 4 cm wide, and the picture is read with a linear filter.
        if entered.abs() < 0.95 && (left - edge).abs() > 0.05 {
            let (dark, lit) = (row[row.len() / 2].x, left > edge);
            assert!((seen.x > 4.0 * dark) == lit, "pixel {index}: {} beside {dark}, from {left:.3} m", seen.x);
            told_apart += usize::from((tangent * EYE_M > edge) != lit);
        }
    }
    assert!(told_apart > 0, "a straight ray would show the same");
    Ok(())
}

/// With dispersion, each channel shows the edge where its own ray exits. Red is refracted least and blue most, each by
/// half of the spread given by the Abbe number.
#[test]
fn a_body_with_dispersion_parts_the_channels() -> TestResult {
    let Some(gpu) = gpu("a_body_with_dispersion_parts_the_channels") else { return Ok(()) };
    // An Abbe number of 0.5 is unphysical, but separates the channels by several texels. Red goes straight through.
    let (ior, abbe, thickness, edge) = (1.8, 0.5, 1.0, 1.0);
    let volume = Volume { thickness: thickness as f32, ..Volume::default() };
    let glass = Material { ior: ior as f32, dispersion: Some((20.0 / abbe) as f32), ..pane(Vec3::ONE, Some(volume)) };
    let mut scene = stage(Some(glass));
    scene.materials[0].base_color = Vec3::splat(0.05).extend(1.0);
    let bright = scene.add_material(Material::dielectric("bright", Vec3::splat(0.8), 0.9));
    let floor = scene.instances[0].mesh;
    let above = DMat4::from_translation(DVec3::new(20.0 + edge, 1e-3, 0.0));
    scene.add_instance("bright", floor, bright, above);
    let shot = Shot::small(Settings::default());
    let row = middle_row(&gpu, &scene, Settings::default().for_scene(&scene, shot.size_px))?;
    let [width, height] = shot.size_px.map(f64::from);
    // The Abbe number is (n_d - 1) / (n_F - n_C).
    let spread = (ior - 1.0) / abbe;
    let mut parted = 0;
    for (index, seen) in row.iter().enumerate() {
        let tangent = ((2.0 * index as f64 + 1.0) / width - 1.0) * width / height * (FOV_Y_RAD / 2.0).tan();
        let entered = (EYE_M - 1.0) * tangent;
        if entered.abs() > 0.95 {
            continue;
        }
        let lit = [ior - 0.5 * spread, ior, ior + 0.5 * spread].map(|ior| {
            let sine = tangent / (1.0 + tangent * tangent).sqrt() / ior;
            let cosine = (1.0 - sine * sine).sqrt();
            let way = thickness * cosine;
            let left = (entered + way * sine) * EYE_M / (EYE_M - (1.0 - way * cosine));
            // Texels are 4 cm wide, and the picture is read with a linear filter.
            ((left - edge).abs() > 0.05).then_some(left > edge)
        });
        let dark = row[row.len() / 2];
        for (channel, lit) in lit.into_iter().enumerate() {
            let bright = seen[channel] > 4.0 * dark[channel];
            assert!(lit.is_none_or(|lit| lit == bright), "pixel {index}, channel {channel}: {seen} beside {dark}");
        }
        parted += usize::from(lit[0].is_some() && lit[2].is_some() && lit[0] != lit[2]);
    }
    assert!(parted > 0, "all channels show the same");
    Ok(())
}

#[test]
fn a_frame_without_the_passes_says_so() -> TestResult {
    let Some(gpu) = gpu("a_frame_without_the_passes_says_so") else { return Ok(()) };
    let error = middle(&gpu, &stage(Some(pane(Vec3::ONE, None))), Settings::default());
    let told = error.err().map(|e| e.to_string()).unwrap_or_default();
    assert!(told.contains("`color`") && told.contains("Settings::scene_levels"), "{told}");
    if gpu.info().backend == wgpu::Backend::Gl {
        let scene = stage(Some(pane(Vec3::ONE, None)));
        let settings = Settings { samples: 4, scene_levels: 2, ..Settings::default() };
        let told = middle(&gpu, &scene, settings).err().map(|e| e.to_string()).unwrap_or_default();
        assert!(told.contains("OpenGL") && told.contains("--msaa 1"), "{told}");
    }
    Ok(())
}
