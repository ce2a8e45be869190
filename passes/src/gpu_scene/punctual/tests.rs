//! Lists against places sampled in double precision: no light is missed where it shines. The places, and which froxel each
//! is in, are worked out here anew.

use super::*;
use crate::gpu_scene::shadow_views::FitCamera;
use framegraph_scene::{Camera, Light, LightKind, Material, Projection, Renderables, Scene};
use glam::{DMat4, DVec3, Vec2, Vec3};

/// SplitMix64, 0…1.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// In a cube of two meters.
    fn place(&mut self) -> DVec3 {
        DVec3::new(self.next(), self.next(), self.next()) * 2.0 - 1.0
    }
}

fn point(position: DVec3, range_m: f64) -> Light {
    let kind = LightKind::Point { intensity_candela: 1.0, range_m: Some(range_m as f32) };
    Light { kind, position, ..Light::directional("point", Vec3::NEG_Y, 0.0) }
}

fn spot(position: DVec3, direction: DVec3, range_m: Option<f32>, outer_cone_rad: f32) -> Light {
    let kind = LightKind::Spot { intensity_candela: 1.0, range_m, inner_cone_rad: 0.0, outer_cone_rad };
    Light { kind, position, ..Light::directional("spot", direction.as_vec3(), 0.0) }
}

/// A scene of these lights in which everything is lit: a floor without end, as far as they are concerned.
fn scene(lights: Vec<Light>) -> Scene {
    let mut scene = Scene { lights, ..Scene::default() };
    let mesh = scene.add_mesh(framegraph_scene::geometry::cuboid(Vec3::splat(1.0)));
    let material = scene.add_material(Material::dielectric("all", Vec3::ONE, 1.0));
    scene.add_instance("all", mesh, material, DMat4::from_scale(DVec3::splat(3e6)));
    scene
}

fn made(
    scene: &Scene,
    camera: &Camera,
    size_px: [u32; 2],
    search: LightSearch,
) -> (Option<LightLists>, LightReport, Vec<Light>) {
    let camera = FitCamera { camera, width_over_height: f64::from(size_px[0]) / f64::from(size_px[1]) };
    let renderables = Renderables::new(scene);
    let selection = select(scene, &renderables, None, std::slice::from_ref(&camera));
    let kept = selection.kept.iter().map(|light| (*light).clone()).collect();
    let (lists, report) = lists(&renderables, selection, &camera, size_px, search);
    (lists, report, kept)
}

/// The froxel that a place is in, if it is seen: pixels by the camera's whole matrix, slices by their ends.
fn froxel_of(place: DVec3, camera: &Camera, size_px: [u32; 2], lists: &LightLists, ends: &[f64]) -> Option<usize> {
    let [width, height] = size_px.map(f64::from);
    let clip = camera.clip_from_view(width / height) * camera.view_from_world() * place.extend(1.0);
    let ndc = clip.truncate() / clip.w;
    if clip.w <= 0.0 || ndc.x.abs() > 1.0 || ndc.y.abs() > 1.0 || !(0.0..=1.0).contains(&ndc.z) {
        return None;
    }
    let pixel = [(ndc.x + 1.0) * 0.5 * width, (1.0 - ndc.y) * 0.5 * height];
    let side = f64::from(1.0 / lists.uniforms.tiles_per_px);
    let [x, y] = [0, 1].map(|axis| ((pixel[axis] / side) as usize).min(lists.uniforms.counts[axis] as usize - 1));
    let ahead = (place - camera.eye).dot(camera.forward());
    let slice = ends.iter().filter(|end| ahead >= **end).count();
    let [across, down, _] = lists.uniforms.counts.map(|count| count as usize);
    Some((slice * down + y) * across + x)
}

/// A place that the light reaches.
fn lit(light: &Light, random: &mut Random) -> DVec3 {
    let (range, cone) = match light.kind {
        LightKind::Point { range_m, .. } => (range_m, None),
        LightKind::Spot { range_m, outer_cone_rad, .. } => (range_m, Some(f64::from(outer_cone_rad))),
        LightKind::Directional { .. } => (None, None),
    };
    // A spot without an end reaches through the scene; a sample of it is near enough.
    let range = range.map_or(300.0, f64::from);
    loop {
        let v = random.place();
        let direction = match cone {
            None => v,
            // Narrow cones are sampled within a cone of their own.
            Some(angle) => {
                let axis = light.direction.as_dvec3();
                let (side, up) = axis.any_orthonormal_pair();
                let tilt = angle * random.next().sqrt();
                let turn = random.next() * std::f64::consts::TAU;
                (axis * tilt.cos() + (side * turn.cos() + up * turn.sin()) * tilt.sin()) * random.next().cbrt()
            }
        };
        if v.length() <= 1.0 {
            return light.position + direction * range;
        }
    }
}

/// Ends of the first slices, as the settings say it: 5 m, then at equal ratios.
fn ends(settings: &FroxelSettings) -> Vec<f64> {
    let ratio = f64::from(settings.far_m / settings.near_m).powf(1.0 / f64::from(settings.slices.max(2) - 1));
    (0..settings.slices as i32 - 1).map(|i| f64::from(settings.near_m) * ratio.powi(i)).collect()
}

/// Samples of every light; how many fell into the view, how many (light, froxel) pairs they found, and how many are listed.
fn check(
    lights: Vec<Light>,
    camera: &Camera,
    size_px: [u32; 2],
    settings: FroxelSettings,
    samples: usize,
) -> [usize; 3] {
    let scene = scene(lights);
    let (lists, report, kept) = made(&scene, camera, size_px, LightSearch::Froxels(settings));
    let lists = lists.expect("lists were asked for");
    assert_eq!(kept.len() + report.dropped.len(), scene.lights.len());
    let (mut random, mut seen, mut pairs) = (Random(3), 0, std::collections::BTreeSet::new());
    let ends = ends(&settings);
    for light in &scene.lights {
        let number = kept.iter().position(|own| own == light);
        for _ in 0..samples {
            let place = lit(light, &mut random);
            let Some(froxel) = froxel_of(place, camera, size_px, &lists, &ends) else { continue };
            let number = number.unwrap_or_else(|| panic!("{light:?} was dropped and lights {place}")) as u32;
            let listed = number < lists.uniforms.everywhere || lists.list(froxel).contains(&number);
            assert!(listed, "froxel {froxel} misses {light:?}, which lights {place}; {camera:?} {size_px:?}");
            seen += 1;
            pairs.insert((number, froxel));
        }
    }
    let count = lists.uniforms.counts.iter().product::<u32>() as usize;
    for froxel in 0..count {
        assert!(lists.list(froxel).is_sorted_by(|a, b| a < b), "{:?}", lists.list(froxel));
    }
    [seen, pairs.len(), lists.words.len() - count - 1]
}

fn cameras(random: &mut Random) -> Vec<Camera> {
    let projections = [
        Projection::perspective(0.8, 0.05),
        Projection::perspective(2.4, 0.05),
        Projection::Perspective { fov_y_rad: 0.1, near_m: 0.5, far_m: Some(70.0) },
        Projection::Orthographic { half_width_m: None, half_height_m: 12.0, near_m: -30.0, far_m: 60.0 },
        Projection::Orthographic { half_width_m: Some(9.0), half_height_m: 9.0, near_m: 0.5, far_m: 200.0 },
    ];
    let camera = |projection| {
        let eye = random.place() * 20.0;
        Camera::look_at(eye, eye + random.place(), DVec3::Y, projection).expect("it looks somewhere")
    };
    projections.map(camera).into()
}

/// Points and spots of all sizes about cameras of all kinds, the eye within some of them.
#[test]
fn no_light_is_missed() {
    let mut random = Random(1);
    let mut seen = 0;
    for size in [[1280, 720], [333, 777], [1, 1], [1, 777], [640, 8]] {
        for camera in cameras(&mut random) {
            let mut lights = Vec::new();
            for _ in 0..60 {
                let at = camera.eye + random.place() * 60.0;
                let range = 0.3 * 200_f64.powf(random.next());
                lights.push(point(at, range));
                let outer = (0.01 * 157_f64.powf(random.next())) as f32;
                let range = (random.next() < 0.9).then_some(range as f32);
                lights.push(spot(at, random.place().normalize(), range, outer.min(1.57)));
            }
            // About the eye, at it, and just behind it.
            lights.push(point(camera.eye, 3.0));
            lights.push(point(camera.eye - camera.forward() * 1.9, 2.0));
            lights.push(spot(camera.eye, camera.forward(), Some(40.0), 0.2));
            lights.push(spot(camera.eye - camera.forward() * 5.0, camera.forward(), Some(40.0), 1.57));
            seen += check(lights, &camera, size, FroxelSettings::DEFAULT, 300)[0];
        }
    }
    assert!(seen > 20_000, "only {seen} places were seen");
}

/// Other cuts, and a view a thousand kilometers from the origin.
#[test]
fn no_light_is_missed_by_other_cuts_and_far_away() {
    let mut random = Random(2);
    let cuts = [
        FroxelSettings { tiles: 1, slices: 1, ..FroxelSettings::DEFAULT },
        FroxelSettings { tiles: 512, slices: 64, near_m: 0.01, far_m: 1000.0 },
        FroxelSettings { tiles: 4096, slices: 2, near_m: 1.0, far_m: 2.0 },
    ];
    for settings in cuts {
        for mut camera in cameras(&mut random) {
            camera.eye += DVec3::new(1e6, -5e5, 3e5);
            let lights = (0..100).map(|_| point(camera.eye + random.place() * 40.0, 0.5 + 5.0 * random.next()));
            check(lights.collect(), &camera, [640, 360], settings, 200);
        }
    }
}

/// Lists are near what samples find: the lights of a hall of a thousand lamps.
#[test]
fn lists_are_tight() {
    let mut random = Random(4);
    let camera = Camera::look_at(
        DVec3::new(0.0, 3.0, 20.0),
        DVec3::new(0.0, 1.0, 0.0),
        DVec3::Y,
        Projection::perspective(0.8, 0.05),
    );
    let camera = camera.expect("it looks somewhere");
    let mut place = || random.place() * DVec3::new(25.0, 2.0, 25.0);
    let points: Vec<Light> = (0..100).map(|_| point(place(), 2.5)).collect();
    let spots = points.iter().map(|own| spot(own.position, DVec3::NEG_Y, Some(4.0), 0.6)).collect();
    for (lights, most) in [(points, 1.2), (spots, 1.6)] {
        let [_, found, listed] = check(lights, &camera, [1280, 720], FroxelSettings::DEFAULT, 10_000);
        println!("{listed} entries for {found} that samples found");
        assert!(found > 500 && (listed as f64) < most * found as f64, "{listed} entries for {found}");
    }
}

fn standing() -> Camera {
    Camera::look_at(
        DVec3::ZERO,
        DVec3::NEG_Z,
        DVec3::Y,
        Projection::Perspective { fov_y_rad: 0.8, near_m: 0.1, far_m: Some(50.0) },
    )
    .expect("it looks somewhere")
}

/// Each reason by a light that has it; the report counts them.
#[test]
fn what_reaches_nothing_is_dropped_with_its_reason() {
    let black = Light { color: Vec3::ZERO, ..point(DVec3::NEG_Z * 5.0, 2.0) };
    let lights = vec![
        point(DVec3::NEG_Z * 5.0, 2.0),
        black,
        point(DVec3::NEG_Z * 5.0, 0.0),
        point(DVec3::Z * 2.0, 1.9),
        point(DVec3::NEG_Z * 53.0, 2.9),
        point(DVec3::new(9.0, 0.0, -5.0), 2.0),
        spot(DVec3::new(0.0, 9.0, -5.0), DVec3::Y, Some(30.0), 0.5),
        point(DVec3::Z * 2.0, 2.2),
    ];
    let (_, report, kept) = made(&scene(lights.clone()), &standing(), [160, 90], LightSearch::default());
    assert_eq!(kept, [lights[0].clone(), lights[7].clone()]);
    let reasons: Vec<(usize, String)> = report.dropped.iter().map(|(n, why)| (*n, why.to_string())).collect();
    let named = [
        (1, "off"),
        (2, "unusable"),
        (3, "behind the camera"),
        (4, "beyond the far plane"),
        (5, "beside the view"),
        (6, "beside the view"),
    ];
    assert_eq!(reasons, named.map(|(n, why)| (n, why.to_owned())));
    let told = report.to_string();
    assert!(
        told.starts_with(
            "2 of 8 lights shade, all of them looked at everywhere: 2 that have an end are few; dropped: "
        )
    );
    assert!(
        told.ends_with("1 off, 1 unusable, 1 behind the camera, 1 beyond the far plane, 2 beside the view"),
        "{told}"
    );

    // A small thing in a large view.
    let mut small = Scene { lights: vec![point(DVec3::new(2.0, 0.0, -9.0), 1.0)], ..Scene::default() };
    let mesh = small.add_mesh(framegraph_scene::geometry::plane(Vec2::ONE, 1, Vec2::ONE));
    let material = small.add_material(Material::dielectric("thing", Vec3::ONE, 1.0));
    small.add_instance("thing", mesh, material, DMat4::from_translation(DVec3::NEG_Z * 9.0));
    let (_, report, _) = made(&small, &standing(), [160, 90], LightSearch::default());
    assert_eq!(report.dropped, [(0, DropReason::NoSurface)]);
}

/// Lights without an end come first and are in no list; few lights need none; too many entries are refused.
#[test]
fn lists_are_made_where_they_help() {
    let endless = |n: u32| Light {
        kind: LightKind::Point { intensity_candela: 1.0, range_m: None },
        ..point(DVec3::new(f64::from(n), 0.0, -5.0), 1.0)
    };
    let near = |n: u32| point(DVec3::new(0.1 * f64::from(n), 0.0, -8.0), 1.0);
    let lights: Vec<Light> = (0..10).flat_map(|n| [near(n), endless(n)]).collect();
    let (lists, report, kept) = made(&scene(lights), &standing(), [160, 90], LightSearch::default());
    let lists = lists.expect("there are ten");
    assert!(kept[..10].iter().all(|light| matches!(light.kind, LightKind::Point { range_m: None, .. })));
    assert_eq!((lists.uniforms.everywhere, kept[10].position.x, kept[19].position.x), (10, 0.0, 0.1 * 9.0));
    assert!(matches!(report.found, Found::ByFroxels { everywhere: 10, longest: 10, .. }), "{report}");

    let few: Vec<Light> = (0..3).map(near).chain((0..10).map(endless)).collect();
    let (none, report, _) = made(&scene(few.clone()), &standing(), [160, 90], LightSearch::default());
    assert!(none.is_none() && report.found == Found::All(LookedAtAll::Few(3)), "{report}");
    let (asked, ..) = made(&scene(few), &standing(), [160, 90], LightSearch::Froxels(FroxelSettings::DEFAULT));
    assert!(asked.is_some());

    // Every light in every froxel.
    let wide = vec![point(DVec3::ZERO, 1e6); 2000];
    let settings = FroxelSettings { tiles: 144, slices: 16, ..FroxelSettings::DEFAULT };
    let (none, report, _) = made(&scene(wide), &standing(), [1280, 720], LightSearch::Froxels(settings));
    assert!(none.is_none() && report.found == Found::All(LookedAtAll::TooLong), "{report}");

    let (empty, report, _) = made(&scene(Vec::new()), &standing(), [1280, 720], LightSearch::Froxels(settings));
    assert_eq!(empty.map(|lists| lists.words.len()), Some(16 * 9 * 16 + 1));
    assert!(
        report.to_string().starts_with("0 of 0 lights shade, by 16x9x16 froxels, 0.00 a list, at most 0"),
        "{report}"
    );
}

/// A device with two storage buffers a stage shades without lists.
#[test]
fn devices_of_few_storage_buffers_look_at_all_lights() {
    let limits = |count| wgpu::Limits { max_storage_buffers_per_shader_stage: count, ..wgpu::Limits::default() };
    assert!(!LightLists::can_be_bound(&limits(2)) && LightLists::can_be_bound(&limits(3)));
}
