//! Shadows compared with ray-traced visibility of the same scene.

mod hard;
mod penumbrae;
mod set;
mod shimmer;
mod strength;

use crate::stage::{gpu, precisions};
use framegraph_passes::effects::depth::structure::Resolution;
use framegraph_passes::effects::occlusion::OcclusionSettings;
use framegraph_passes::gpu_scene::shadow_views::{
    ContactShadows, Fit, ShadowBias, ShadowFilter, ShadowSettings, Splits,
};
use framegraph_scene::geometry::cuboid;
use framegraph_scene::{AlphaMode, Camera, Light, LightKind, Material, Projection, Scene, progress};
use glam::{DMat4, DVec3, Vec3};
use set::{JUDGED, Lamp, SIZE, Set};
use std::error::Error;
use tests::files::{asset, references};
use tests::reference::document::Document;
use tests::reference::examine::{How, render};
use tests::reference::picture::Picture;

type TestResult = Result<(), Box<dyn Error>>;

/// Steps and small objects on a floor, with a shadow map whose texels are as wide as the objects. Contact shadows
/// darken what the map misses within their range, and almost nothing that is lit, also with a depth of half resolution.
#[test]
fn contact_shadows_find_what_the_map_misses() -> TestResult {
    let Some(gpu) = gpu("contact_shadows_find_what_the_map_misses") else { return Ok(()) };
    let floor = ([0.0, -0.5, 0.0], [30.0, 0.5, 30.0]);
    let small = (0..60).map(|i| {
        let (column, row) = (f64::from(i % 10), f64::from(i / 10));
        ([0.35 * column - 1.6, 0.06, 1.5 - 0.5 * row], [0.06, 0.06, 0.06])
    });
    let scene = scene_of(&[floor].into_iter().chain(small).collect::<Vec<_>>());
    let set = Set::new(scene, camera([0.4, 1.3, 3.4], [0.0, 0.0, 0.2], 45.0)?, DVec3::new(0.6, 0.5, 0.2));
    let triangles = set.triangles();
    let truth: Vec<Option<bool>> =
        set.seen(&triangles).iter().map(|hit| hit.map(|hit| set.is_lit(&triangles, &hit, hit.point))).collect();
    let half = Some(OcclusionSettings { resolution: Resolution::Half, ..OcclusionSettings::SAO });
    let count = |contact, occlusion| -> Result<[usize; 3], Box<dyn Error>> {
        let coarse = ShadowSettings { map_texels: 64, fit: Fit::Stable, contact, ..ShadowSettings::DEFAULT };
        let found = Set { occlusion, ..set.clone() }.visibility(&gpu, coarse)?;
        let pairs: Vec<_> = found.iter().zip(&truth).filter_map(|(found, lit)| Some(((*found)?, (*lit)?))).collect();
        let missed = pairs.iter().filter(|(found, lit)| !lit && *found > 0.5).count();
        let darkened = pairs.iter().filter(|(found, lit)| *lit && *found < 0.5).count();
        Ok([missed, darkened, pairs.len()])
    };
    let [plain, _, all] = count(None, None)?;
    // A half-resolution texel extends over two pixels.
    for (occlusion, most) in [(None, 0.02), (half, 0.04)] {
        let [missed, darkened, _] = count(Some(ContactShadows::FILAMENT), occlusion)?;
        println!(
            "of {all} pixels: {plain} in shadow are missed by the map, {missed} with contact shadows, {darkened} darkened"
        );
        assert!(plain > 150 && 2 * missed < plain, "{plain} {missed}");
        assert!((darkened as f64) < most * all as f64, "{darkened} of {all}");
    }
    Ok(())
}

/// A ray that starts near the eye toward a sun behind it leaves the picture's depth, so a lit floor stays lit.
#[test]
fn contact_shadows_give_up_behind_the_eye() -> TestResult {
    let Some(gpu) = gpu("contact_shadows_give_up_behind_the_eye") else { return Ok(()) };
    let floor = scene_of(&[([0.0, -0.5, 0.0], [30.0, 0.5, 30.0])]);
    let low = camera([0.0, 0.2, 0.0], [0.0, 0.1, -0.3], 60.0)?;
    let contact = Some(ContactShadows { distance_m: 1.0, ..ContactShadows::FILAMENT });
    let shadows = ShadowSettings { contact, ..ShadowSettings::DEFAULT };
    for toward in [DVec3::new(0.1, 0.3, 1.0), DVec3::new(-0.4, 1.0, 0.6)] {
        let found = Set::new(floor.clone(), low.clone(), toward).visibility(&gpu, shadows)?;
        let dark = found.iter().flatten().filter(|visibility| **visibility < 0.99).count();
        assert!(found.iter().flatten().count() > 4000 && dark == 0, "{toward}: {dark} pixels are dark");
    }
    Ok(())
}

fn scene_of(boxes: &[([f64; 3], [f32; 3])]) -> Scene {
    let mut scene = Scene::default();
    let clay = scene.add_material(Material::dielectric("clay", Vec3::splat(0.5), 1.0));
    for (center, half) in boxes {
        let mesh = scene.add_mesh(cuboid(Vec3::from(*half)));
        scene.add_instance("box", mesh, clay, DMat4::from_translation(DVec3::from(*center)));
    }
    scene
}

fn camera(eye: [f64; 3], target: [f64; 3], fov_y_deg: f64) -> Result<Camera, Box<dyn Error>> {
    let projection = Projection::perspective(fov_y_deg.to_radians(), 0.1);
    Ok(Camera::look_at(DVec3::from(eye), DVec3::from(target), DVec3::Y, projection)?)
}

/// Creates a thick floor of 100 m, which is drawn into the maps, with boxes and posts.
fn field() -> Result<Set, Box<dyn Error>> {
    let floor = ([0.0, -0.5, 0.0], [50.0, 0.5, 50.0]);
    let boxes = (0..12).map(|i| {
        let (i, high) = (f64::from(i), 0.8 + 0.3 * (i % 4) as f32);
        ([3.0 * (2.3 * i).sin(), f64::from(high), 2.0 - 3.0 * i], [0.7, high, 0.7])
    });
    let scene = scene_of(&[floor].into_iter().chain(boxes).collect::<Vec<_>>());
    Ok(Set::new(scene, camera([1.0, 2.5, 8.0], [0.0, 0.0, -4.0], 50.0)?, DVec3::new(0.5, 0.6, 0.3)))
}

/// Returns every fit with hardware comparison, and the other filters with their intended fit.
fn kinds() -> Vec<ShadowSettings> {
    let base = ShadowSettings { splits: Splits::Practical(0.8), ..ShadowSettings::DEFAULT };
    vec![
        base,
        ShadowSettings { cascades: 4, ..base },
        ShadowSettings { cascades: 4, fit: Fit::Tight { lispsm: false }, ..base },
        ShadowSettings { cascades: 4, fit: Fit::Stable, ..base },
        ShadowSettings { cascades: 2, filter: ShadowFilter::Pcss, ..base },
        ShadowSettings { cascades: 2, filter: ShadowFilter::Dpcf, bulb_m: Some(0.02), ..base },
    ]
}

/// No acne and no light leaks: at most 0.1 % of the pixels differ from the rays. Pixels within 5 cm, or 1 % of the view distance, of a shadow's edge are ignored. Also at grazing light (hard case 42).
#[test]
fn hard_case_42_a_field_of_100_m_agrees_with_rays() -> TestResult {
    let Some(gpu) = gpu("hard_case_42_a_field_of_100_m_agrees_with_rays") else { return Ok(()) };
    let steep = field()?;
    let grazing = Set::new(steep.scene.clone(), steep.camera.clone(), DVec3::new(0.7, 0.12, 0.5));
    let precisions = precisions("hard_case_42_a_field_of_100_m_agrees_with_rays", &gpu);
    let all = kinds().into_iter().flat_map(|kind| precisions.iter().map(move |p| (kind, *p)));
    let all = test_report::share(all);
    for (set, most) in [(&steep, 1.0), (&grazing, 4.0)] {
        for precision in &precisions {
            let set = Set { precision: *precision, ..set.clone() };
            let judge = set.judge(&gpu)?;
            for (settings, _) in all.iter().filter(|(_, own)| own == precision) {
                let wrong = judge.wrong(*settings, |distance_m| (0.01 * distance_m).max(0.05))?;
                assert!(wrong <= most, "{settings:?} in {precision:?}: {wrong} of a thousand");
            }
        }
    }
    // Negative control: without bias, the floor shadows itself.
    let none = ShadowBias { constant_m: 0.0, normal: 0.0, slope: 0.0, steps: 0 };
    let acne = ShadowSettings { bias: none, ..ShadowSettings::DEFAULT };
    assert!(steep.judge(&gpu)?.wrong(acne, |distance_m| (0.01 * distance_m).max(0.05))? > 10.0);
    Ok(())
}

/// Shadows with an end distance fade over its last tenth: pixels that rays find in shadow have the brightness of the
/// formula.
#[test]
fn shadows_fade_out_before_their_end() -> TestResult {
    const END_M: f64 = 13.0;
    let Some(gpu) = gpu("shadows_fade_out_before_their_end") else { return Ok(()) };
    let Set { scene, camera, .. } = field()?;
    // Long shadows.
    let set = Set::new(scene, camera, DVec3::new(0.8, 0.2, 0.3));
    let judge = set.judge(&gpu)?;
    for cascades in [1, 4] {
        let settings = ShadowSettings { cascades, far_m: Some(END_M), ..ShadowSettings::DEFAULT };
        // Pixels before, within and after the fade.
        let mut counts = [0; 3];
        for (visibility, hit) in set.visibility_beside(&gpu, &judge.without, settings)?.iter().zip(&judge.seen) {
            let (Some(visibility), Some(hit)) = (visibility, hit) else { continue };
            if judge.lit_around(hit, 0.1) != Some(false) {
                continue;
            }
            let ahead = (hit.point - set.camera.eye).dot(set.camera.forward()) / END_M;
            let share = (5.0 - 5.0 * ahead * ahead).clamp(0.0, 1.0);
            counts[if share == 1.0 { 0 } else { 1 + usize::from(share == 0.0) }] += 1;
            // Filters are narrower than the shadowed area and have 8-bit weights.
            assert!((1.0 - share - visibility).abs() < 0.01, "{cascades}, {ahead} of the way: {visibility}");
        }
        assert!(counts.iter().all(|count| *count > 10), "{counts:?}");
    }
    Ok(())
}

/// The colonnade, a regression test for stripes on plinths and a bright ring under capitals. At most 0.3 % of the
/// pixels differ from the rays at distances of more than 4 cm from an edge.
#[test]
fn columns_agree_with_rays() -> TestResult {
    let Some(gpu) = gpu("columns_agree_with_rays") else { return Ok(()) };
    let scene = Scene::open("columns", &mut progress::silent)?;
    let toward = DVec3::new(0.55, 0.62, 0.56);
    for (camera, cascades) in [(scene.cameras[0].clone(), 1), (scene.cameras[1].clone(), 4)] {
        let set = Set::new(scene.clone(), camera, toward);
        let settings = ShadowSettings { cascades, ..ShadowSettings::DEFAULT };
        let wrong = set.judge(&gpu)?.wrong(settings, |_| 0.04)?;
        assert!(wrong <= 3.0, "{wrong} of a thousand");
    }
    Ok(())
}

/// The helmet: thin straps over curved leather, from nearby. At most 1 % of the pixels differ from the rays at
/// distances of more than 3 mm from an edge. Rays use flat triangles, shading interpolated normals.
#[test]
fn the_helmet_agrees_with_rays() -> TestResult {
    let test = "the_helmet_agrees_with_rays";
    let Some(file) = asset(test, "models/FlightHelmet/FlightHelmet.gltf") else { return Ok(()) };
    let Some(gpu) = gpu(test) else { return Ok(()) };
    let mut scene = Scene::open(&file.to_string_lossy(), &mut progress::silent)?;
    // Blended surfaces cast no shadow. All other surfaces are clay, without highlights that outshine shadows.
    let materials = scene.materials.clone();
    scene.instances.retain(|i| materials[i.material.index()].alpha != AlphaMode::Blend);
    let clay = scene.add_material(Material::dielectric("clay", Vec3::splat(0.5), 1.0));
    scene.instances.iter_mut().for_each(|instance| instance.material = clay);
    let set = Set::new(scene, camera([0.28, 0.55, 0.42], [0.0, 0.45, 0.05], 40.0)?, DVec3::new(0.8, 0.7, 0.3));
    let wrong = set.judge(&gpu)?.wrong(ShadowSettings::DEFAULT, |_| 0.003)?;
    assert!(wrong <= 10.0, "{wrong} of a thousand");
    Ok(())
}

/// Spot and point lights: one map, and six maps with invisible seams (hard case 46). The point light is inside the
/// scene, so every face is visible; the camera is inside too.
#[test]
fn hard_case_46_local_lights_agree_with_rays() -> TestResult {
    let Some(gpu) = gpu("hard_case_46_local_lights_agree_with_rays") else { return Ok(()) };
    let wall = |axis: usize, side: f64| {
        let (mut center, mut half) = ([0.0; 3], [3.0_f32; 3]);
        (center[axis], half[axis]) = (side * 3.1, 0.1);
        (center, half)
    };
    let walls = (0..3).flat_map(|axis| [-1.0, 1.0].map(|side| wall(axis, side)));
    let posts = [
        ([0.9, -0.8, -0.7], [0.15, 0.9, 0.15]),
        ([-0.8, 0.3, 0.2], [0.1, 0.1, 0.6]),
        ([0.2, 1.4, -1.2], [0.5, 0.1, 0.1]),
    ];
    let scene = scene_of(&walls.chain(posts).collect::<Vec<_>>());
    let seen = [([2.4, 2.2, 2.5], [-1.0, -1.2, -1.5]), ([-2.5, -2.0, 2.4], [1.5, 1.0, -1.0])];
    let light = |kind| Light {
        kind,
        position: DVec3::new(0.1, 0.2, 0.3),
        ..Light::directional("lamp", Vec3::new(0.2, -0.3, -1.0), 1.0)
    };
    let point = light(LightKind::Point { intensity_candela: 1e4, range_m: Some(20.0) });
    let cone = LightKind::Spot { intensity_candela: 1e4, range_m: None, inner_cone_rad: 0.9, outer_cone_rad: 0.95 };
    for (lamp, local_maps) in [(point, 6), (light(cone), 1)] {
        for (eye, target) in seen {
            let set = Set::new(scene.clone(), camera(eye, target, 70.0)?, DVec3::Y);
            let settings = ShadowSettings { cascades: 0, local_maps, map_texels: 1024, ..ShadowSettings::DEFAULT };
            for precision in precisions("hard_case_46_local_lights_agree_with_rays", &gpu) {
                let set = Set { lamp: Lamp::Local(lamp.clone()), precision, ..set.clone() };
                let wrong = set.judge(&gpu)?.wrong(settings, |_| 0.05)?;
                assert!(wrong <= 2.0, "{precision:?}: {wrong} of a thousand");
            }
        }
    }
    Ok(())
}

/// Scene 11 compared with a path tracer: at most 0.1 % of the pixels are on the other side of an edge (Filament: 0.06
/// to 0.22 %).
#[test]
fn the_clay_scene_has_the_path_tracers_mask() -> TestResult {
    let Some(gpu) = gpu("the_clay_scene_has_the_path_tracers_mask") else { return Ok(()) };
    let folder = references().with_file_name("filament_frame");
    let picture = |id: &str| {
        let file = folder.join(format!("{id}.json"));
        let document = Document::read(&file)?;
        render(&gpu, &document, &file, How::default()).map_err(Box::<dyn Error>::from)
    };
    let (with, without) = (picture("11_shadow_clay_pcf")?, picture("11_shadow_clay_none")?);
    let truth = Picture::read(&folder.join("mi_shadow_clay_hard.exr"))?;
    // A pixel counts as lit if it has more than half of its light without shadows.
    let light = with.linear.iter().zip(&without.linear).zip(&truth.linear);
    let light = light.map(|((with, without), truth)| (with[0], 0.5 * without[0], truth[0]));
    let wrong = light.filter(|(with, half, truth)| *half > 0.01 && (with > half) != (truth > half)).count();
    let share = 100.0 * wrong as f64 / truth.linear.len() as f64;
    println!("{wrong} pixels are on the other side, {share:.3} %");
    assert!(share <= 0.10, "{share} %");
    Ok(())
}
