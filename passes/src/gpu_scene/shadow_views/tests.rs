//! The fits: what lies in the maps, how fine they are, how still they stand.

use super::fitted::Fitted;
use super::local;
use super::settings::{Fit, ShadowSettings, Splits};
use super::sun::{LightAxes, SunMaps, SunScene};
use super::view::local_layers;
use super::volume::FitCamera;
use framegraph_scene::geometry::cuboid;
use framegraph_scene::{AlphaMode, Camera, Light, LightKind, Material, Projection, Renderables, Scene};
use glam::{DMat4, DQuat, DVec2, DVec3, Vec3};

const ASPECT: f64 = 16.0 / 9.0;

/// Boxes by center and half extent.
fn scene(boxes: &[([f64; 3], [f64; 3])]) -> Scene {
    let mut scene = Scene::default();
    let material = scene.add_material(Material::dielectric("clay", Vec3::splat(0.5), 1.0));
    for (center, half) in boxes {
        let mesh = scene.add_mesh(cuboid(DVec3::from(*half).as_vec3()));
        scene.add_instance("box", mesh, material, DMat4::from_translation(DVec3::from(*center)));
    }
    scene
}

/// A 100 m floor with boxes on it, from near to far.
fn field() -> Scene {
    let floor = [([0.0, -0.5, 0.0], [50.0, 0.5, 50.0])];
    let boxes = (0..10).map(|i| ([0.0, 1.0, -4.0 * f64::from(i)], [0.4, 1.0, 0.4]));
    scene(&floor.into_iter().chain(boxes).collect::<Vec<_>>())
}

fn camera(eye: [f64; 3], target: [f64; 3]) -> Camera {
    let projection = Projection::perspective(1.0, 0.1);
    Camera::look_at(DVec3::from(eye), DVec3::from(target), DVec3::Y, projection).expect("a camera")
}

fn fit(scene: &Scene, camera: &Camera, toward: DVec3, settings: &ShadowSettings) -> SunMaps {
    SunScene::new(&Renderables::new(scene), &[FitCamera { camera, width_over_height: ASPECT }], toward, settings).fit()
}

fn ndc(map: &Fitted, point: DVec3) -> DVec3 {
    let clip = map.clip_from_world * point.extend(1.0);
    clip.truncate() / clip.w
}

const TOWARD: DVec3 = DVec3::new(0.4, 0.8, 0.3);

fn all_fits() -> impl Iterator<Item = ShadowSettings> {
    let fits = [Fit::Tight { lispsm: true }, Fit::Tight { lispsm: false }, Fit::Stable];
    fits.into_iter().flat_map(|fit| [1, 4].map(|cascades| ShadowSettings { fit, cascades, ..ShadowSettings::DEFAULT }))
}

/// Of many casters, the corners of each; what blends casts nothing, however large it is.
#[test]
fn what_casts_is_known_of_each() {
    let at = |i: usize| [(i * 37 % 200) as f64, (i * 91 % 150) as f64, (i * 53 % 170) as f64];
    let mut scene = scene(&(0..300).map(|i| (at(i), [0.5, 1.0, 2.0])).collect::<Vec<_>>());
    let pane = scene.add_material(Material { alpha: AlphaMode::Blend, ..Material::default() });
    let mesh = scene.add_mesh(cuboid(Vec3::splat(500.0)));
    scene.add_instance("pane", mesh, pane, DMat4::IDENTITY);
    let (renderables, settings) = (Renderables::new(&scene), ShadowSettings::DEFAULT);
    let axes = LightAxes::new(TOWARD.normalize(), None);
    let cast = SunScene::new(&renderables, &[], TOWARD, &settings).cast(&axes);
    let corners = scene.instances[..300].iter().flat_map(|instance| instance.bounds.corners());
    let expected = axes.bounds(corners);
    assert!(cast.min.abs_diff_eq(expected.min, 1e-9) && cast.max.abs_diff_eq(expected.max, 1e-9), "{cast:?}");
}

/// What a camera sees and something can shadow lies in the map of its cascade, and nearer to the sun means more depth.
#[test]
fn what_is_seen_lies_in_its_cascade() {
    let (scene, camera) = (field(), camera([3.0, 2.0, 5.0], [0.0, 0.5, -5.0]));
    let seen = FitCamera { camera: &camera, width_over_height: ASPECT };
    for settings in all_fits() {
        let SunMaps { maps, far_ends, .. } = fit(&scene, &camera, TOWARD, &settings);
        assert_eq!(maps.len(), usize::from(settings.cascades));
        let slice = seen.slice(0.1, 60.0);
        let mut checked = 0;
        for i in 0..4000 {
            // Points at the feet and around the heads of the boxes.
            let (x, z) = (f64::from(i % 40) * 0.05 - 1.0, f64::from(i / 40) * -0.4);
            for y in [0.0, 1.9] {
                let point = DVec3::new(x, y, z);
                let inside = slice.planes.iter().all(|p| p.truncate().dot(point) + p.w > 0.0);
                let on_a_box = x.abs() < 0.4 && (z / 4.0 - (z / 4.0).round()).abs() < 0.1;
                let ahead = seen.ahead_m(point);
                let Some(cascade) = far_ends.iter().position(|end| ahead <= *end) else { continue };
                if inside && on_a_box {
                    checked += 1;
                    let at = ndc(&maps[cascade], point);
                    assert!(at.x.abs() <= 1.0 && at.y.abs() <= 1.0, "{settings:?} {point}: {at}");
                    assert!((0.0..=1.0).contains(&at.z), "{settings:?} {point}: {at}");
                    let nearer = ndc(&maps[cascade], point + TOWARD.normalize() * 0.01);
                    assert!(nearer.z > at.z && (nearer - at).truncate().length() < 1e-6, "{at} {nearer}");
                }
            }
        }
        assert!(checked > 100, "{checked}");
    }
}

/// Hard case 41: what casts into the picture from behind the eye, or from beside it, is drawn and not clipped.
#[test]
fn hard_case_41_casters_before_the_near_plane() {
    let tower = ([6.0, 20.0, 8.0], [0.5, 20.0, 0.5]);
    let scene = scene(&[([0.0, -0.5, 0.0], [50.0, 0.5, 50.0]), ([0.0, 0.5, -4.0], [0.5, 0.5, 0.5]), tower]);
    let camera = camera([0.0, 2.0, 3.0], [0.0, 0.0, -6.0]);
    for settings in all_fits() {
        let maps = fit(&scene, &camera, TOWARD, &settings).maps;
        assert!(maps.iter().any(|map| map.casters.opaque.contains(&2)), "{settings:?}");
        for map in maps.iter().filter(|map| map.casters.opaque.contains(&2)) {
            // Along the ray from a receiver to the tower, depth stays in range.
            for height in [1.0, 10.0, 39.9] {
                let at = ndc(map, DVec3::new(6.0, height, 8.0));
                let over = at.x.abs() <= 1.0 && at.y.abs() <= 1.0;
                assert!(!over || (0.0..=1.0).contains(&at.z), "{settings:?}: {at}");
            }
        }
    }
}

/// Hard case 40: light along the view, and light and view along the usual up axis, give finite maps that can be inverted.
#[test]
fn hard_case_40_light_along_the_view_and_up() {
    let scene = field();
    let down = camera([0.0, 10.0, 0.0], [0.0, 0.0, 0.0]);
    let ahead = camera([0.0, 2.0, 5.0], [0.0, 0.0, -5.0]);
    for settings in all_fits() {
        for camera in [&down, &ahead] {
            for toward in
                [DVec3::Y, -camera.forward(), camera.forward(), DVec3::new(1e-9, 1.0, 0.0), DVec3::X, DVec3::ZERO]
            {
                for map in fit(&scene, camera, toward, &settings).maps {
                    let matrix = map.clip_from_world;
                    assert!(matrix.is_finite() && matrix.determinant().abs() > 0.0, "{settings:?} {toward}");
                    assert!(map.texel_m.iter().all(|t| t.is_finite() && *t > 0.0), "{:?}", map.texel_m);
                }
            }
        }
    }
}

/// Hard case 39: nothing, a point, a flat scene, and no range between near and far give finite maps.
#[test]
fn hard_case_39_empty_and_flat_scenes() {
    let eye = camera([0.0, 1.0, 3.0], [0.0, 0.0, 0.0]);
    let scenes = [
        Scene::default(),
        scene(&[([0.0; 3], [0.0; 3])]),
        scene(&[([0.0; 3], [5.0, 0.0, 5.0])]),
        scene(&[([0.0, -1.0, 0.0], [5.0, 0.0, 5.0]), ([0.0; 3], [5.0, 0.0, 5.0])]),
    ];
    for scene in &scenes {
        for settings in all_fits() {
            for far_m in [None, Some(0.1)] {
                let settings = ShadowSettings { far_m, ..settings };
                let SunMaps { maps, far_ends, .. } = fit(scene, &eye, TOWARD, &settings);
                assert!(far_ends.iter().all(|end| end.is_finite()), "{far_ends:?}");
                assert!(maps.iter().all(|map| map.clip_from_world.is_finite()), "{settings:?}");
            }
        }
    }
}

/// Hard case 37: a million meters from the origin the map is the same to a hundredth of a texel.
#[test]
fn hard_case_37_far_from_the_origin() {
    let away = DVec3::new(1e6, 0.0, -1e6);
    let moved = |scene: &Scene| {
        let mut moved = scene.clone();
        for instance in &mut moved.instances {
            instance.world_from_model = DMat4::from_translation(away) * instance.world_from_model;
            instance.bounds.min += away;
            instance.bounds.max += away;
        }
        moved
    };
    let (here, eye) = (field(), [3.0, 2.0, 5.0]);
    let there = moved(&here);
    let near = camera(eye, [0.0, 0.5, -5.0]);
    let far = camera((DVec3::from(eye) + away).into(), (DVec3::new(0.0, 0.5, -5.0) + away).into());
    for settings in all_fits().filter(|s| s.fit != Fit::Stable) {
        let pairs = fit(&here, &near, TOWARD, &settings).maps;
        for (a, b) in pairs.iter().zip(fit(&there, &far, TOWARD, &settings).maps) {
            // As views take them: the eye subtracted in f64, the result rounded to f32.
            let a = (a.clip_from_world * DMat4::from_translation(near.eye)).as_mat4();
            let b = (b.clip_from_world * DMat4::from_translation(far.eye)).as_mat4();
            for point in [Vec3::new(-3.0, -2.0, -9.0), Vec3::new(-2.5, -1.0, -20.0)] {
                let at = [a, b].map(|m| m.project_point3(point));
                let texels = (at[0] - at[1]).truncate().abs().max_element() * 1024.0;
                assert!(texels < 0.01, "{settings:?}: {texels} texels");
            }
        }
    }
}

/// World size of a pixel and of a texel at a point of the floor; the larger of the texel's sides.
fn texels_per_pixel(maps: &SunMaps, seen: &FitCamera<'_>, height_px: f64, point: DVec3) -> Option<f64> {
    let ahead = seen.ahead_m(point);
    let cascade = maps.far_ends.iter().position(|end| ahead <= *end)?;
    let map = &maps.maps[cascade];
    let w = (map.clip_from_world * point.extend(1.0)).w;
    let warped = map.clip_from_world.transpose().w_axis.truncate() != DVec3::ZERO;
    let texel = (map.texel_m[0] * w).max(map.texel_m[1] * w * if warped { w } else { 1.0 });
    let pixel = 2.0 * seen.half_extent()[1] * ahead / height_px;
    Some(texel / pixel)
}

/// How many pixels a texel covers at worst, along the middle of the picture, from 2 m to 40 m: four cascades and the warp each
/// bring a map of 2048 below what one map over everything has by the factor that is stated.
#[test]
fn cascades_and_warp_bring_texels_near_pixels() {
    let (scene, camera) = (field(), camera([0.0, 1.7, 5.0], [0.0, 1.0, -5.0]));
    let seen = FitCamera { camera: &camera, width_over_height: ASPECT };
    let worst = |settings: &ShadowSettings| {
        let maps = fit(&scene, &camera, TOWARD, settings);
        let points = (0..=38).map(|i| DVec3::new(0.0, 0.0, 5.0 - 2.0 - f64::from(i)));
        points.filter_map(|p| texels_per_pixel(&maps, &seen, 1080.0, p)).fold(0.0, f64::max)
    };
    let of =
        |fit, cascades| ShadowSettings { fit, cascades, splits: Splits::Practical(0.8), ..ShadowSettings::DEFAULT };
    let [one, four] = [1, 4].map(|count| worst(&of(Fit::Tight { lispsm: false }, count)));
    let [warped, both] = [1, 4].map(|count| worst(&of(Fit::Tight { lispsm: true }, count)));
    let [stable_one, stable] = [1, 4].map(|count| worst(&of(Fit::Stable, count)));
    println!(
        "texels a pixel: one {one:.1}, four {four:.1}, warped {warped:.1}, both {both:.1}, stable {stable_one:.1} {stable:.1}"
    );
    assert!(four < 0.5 * one && warped < 0.5 * one && stable < 0.5 * stable_one, "{one} {four} {warped}");
    assert!(both <= 4.0 && four <= 6.0, "{both} {four}");
}

/// Stable cascades: whatever the camera turns to and moves by, a point of the world lies at the same place within its texel,
/// which has the same size. Tight ones do not stand so.
#[test]
fn stable_cascades_stand_on_one_grid() {
    let scene = field();
    let eye = DVec3::new(1.3, 2.0, 5.0);
    let place = |fitted: Fit, turn: f64, step: DVec3| -> Vec<(DVec2, [f64; 2])> {
        let mut camera = camera(eye.into(), [0.0, 1.0, -5.0]);
        camera.world_from_view = DQuat::from_rotation_y(turn) * camera.world_from_view;
        camera.eye += step;
        let settings = ShadowSettings { fit: fitted, cascades: 3, far_m: Some(30.0), ..ShadowSettings::DEFAULT };
        let maps = fit(&scene, &camera, TOWARD, &settings).maps;
        let texel = |map: &Fitted| {
            let at = ndc(map, DVec3::new(0.3, 0.1, -2.0)).truncate() * f64::from(settings.map_texels) / 2.0;
            (at - at.floor(), map.texel_m)
        };
        maps.iter().map(texel).collect()
    };
    let apart = |a: f64| (a - a.round()).abs();
    let first = place(Fit::Stable, 0.0, DVec3::ZERO);
    let mut shifted = false;
    for i in 1..50 {
        let (turn, step) = (0.031 * f64::from(i), DVec3::new(0.017, 0.003, -0.023) * f64::from(i));
        for ((here, size), (there, other)) in first.iter().zip(place(Fit::Stable, turn, step)) {
            let off = *here - there;
            assert!(apart(off.x) < 1e-6 && apart(off.y) < 1e-6, "{i}: {off}");
            assert!((size[0] / other[0] - 1.0).abs() < 1e-12, "{i}: {size:?} {other:?}");
        }
        let tight = place(Fit::Tight { lispsm: false }, turn, step);
        shifted |= tight[0].1 != first[0].1;
    }
    assert!(shifted, "the tight fit was as still");
}

/// A flat ground with everything on it casts nothing; with something below it, it does.
#[test]
fn a_ground_with_nothing_below_is_not_drawn() {
    let ground = ([0.0; 3], [50.0, 0.0, 50.0]);
    let on_it = ([0.0, 1.0, 0.0], [1.0, 1.0, 1.0]);
    let below = ([4.0, -3.0, 0.0], [1.0, 1.0, 1.0]);
    let eye = camera([0.0, 3.0, 8.0], [0.0, 0.0, 0.0]);
    let drawn = |boxes: &[_]| fit(&scene(boxes), &eye, TOWARD, &ShadowSettings::DEFAULT).maps[0].casters.opaque.clone();
    assert_eq!(drawn(&[ground, on_it]), [1]);
    assert_eq!(drawn(&[ground, on_it, below]), [0, 1, 2]);
}

#[test]
fn light_axes_are_a_right_handed_frame() {
    for toward in [DVec3::Y, DVec3::NEG_Y, DVec3::X, TOWARD.normalize()] {
        for along in [None, Some(toward), Some(DVec3::Z), Some(DVec3::new(1.0, 2.0, -1.0))] {
            let LightAxes([right, up, light]) = LightAxes::new(toward, along);
            assert!((right.cross(up) - light).length() < 1e-12 && (right.length() - 1.0).abs() < 1e-12);
        }
    }
}

/// Local maps are as large as their lights are important, share layers without a gap, and are all smaller where those are fewer;
/// where even the smallest have no room, the least important lights have none.
#[test]
fn local_maps_are_as_large_as_their_lights_are_important() {
    let mut scene = field();
    let kind = LightKind::Point { intensity_candela: 1.0, range_m: Some(4.0) };
    let lamp =
        |away_m: f64| Light { kind, position: DVec3::X * away_m, ..Light::directional("lamp", Vec3::NEG_Y, 1.0) };
    // Out of order: shares of the view of 1/4, 1, 1/16 and 1/2.
    scene.lights = [16.0, 4.0, 64.0, 8.0].map(lamp).into();
    let lights: Vec<&Light> = scene.lights.iter().collect();
    let settings = ShadowSettings { cascades: 2, local_maps: 24, ..ShadowSettings::texels(1024) };
    let sides = |settings: &ShadowSettings| -> [Option<u32>; 4] {
        let (starts, maps) = local::fit(&Renderables::new(&scene), &lights, DVec3::ZERO, settings);
        let layers = maps.iter().map(|map| map.place.layer).max().map_or(0, |last| last - 1);
        assert_eq!(layers, u16::from(local_layers(&scene, DVec3::ZERO, settings)));
        assert!(layers <= settings.local_layers() && maps.iter().all(|map| map.place.layer >= 2));
        let side = |start: &Option<u32>| start.map(|first| maps[first as usize].place.texels);
        [0, 1, 2, 3].map(|light: usize| side(&starts[light]))
    };
    assert_eq!(sides(&settings), [256, 1024, 64, 512].map(Some));
    // 6 (1 + 1/4 + 1/16 + 1/256) layers, where a layer a map took 24.
    assert_eq!(local_layers(&scene, DVec3::ZERO, &settings), 8);
    assert_eq!(sides(&ShadowSettings { local_layers: 7, ..settings }), [128, 512, 64, 256].map(Some));
    assert_eq!(sides(&ShadowSettings { local_layers: 1, ..settings }), [64, 256, 64, 128].map(Some));
    let coarse = ShadowSettings { map_texels: 128, ..settings };
    assert_eq!(sides(&ShadowSettings { local_layers: 3, ..coarse }), [None, Some(64), None, Some(64)]);
    assert_eq!(sides(&ShadowSettings { local_layers: 1, ..coarse }), [None; 4]);
    assert_eq!(sides(&ShadowSettings { local_maps: 6, ..settings }), [None, Some(1024), None, None]);
}
