//! Cameras compared with hand-computed projections, and edge cases of `look_at` and `orbit`.

use glam::{DMat4, DVec3, DVec4, Mat4, Vec3};

use super::*;
use crate::bounds::Aabb;
use crate::{Instance, MaterialId, MeshId, Scene};

fn project(camera: &Camera, aspect: f64, point: DVec3) -> DVec3 {
    let clip = camera.clip_from_view(aspect) * camera.view_from_world() * point.extend(1.0);
    clip.truncate() / clip.w
}

#[test]
fn depth_is_one_at_the_near_plane_and_zero_far_away() {
    let infinite = Projection::perspective(1.0, 0.25);
    let finite = Projection::Perspective { fov_y_rad: 1.0, near_m: 0.25, far_m: Some(100.0) };
    let parallel = Projection::Orthographic { half_width_m: Some(4.0), half_height_m: 2.0, near_m: 0.25, far_m: 100.0 };
    let depth = |p: &Projection, z: f64| {
        let clip = p.clip_from_view(2.0) * DVec4::new(0.0, 0.0, -z, 1.0);
        clip.z / clip.w
    };
    for projection in [infinite, finite, parallel] {
        assert!((depth(&projection, 0.25) - 1.0).abs() < 1e-12);
        assert!(depth(&projection, 1.0) > depth(&projection, 2.0));
    }
    assert!(depth(&infinite, 1e12).abs() < 1e-12);
    assert!(depth(&finite, 100.0).abs() < 1e-12);
    assert!(depth(&parallel, 100.0).abs() < 1e-12);
}

/// 90° vertical at 2:1: the point (2, 1, −1) in view space is the upper right corner.
#[test]
fn the_picture_is_upright_and_not_mirrored() {
    let projection = Projection::perspective(std::f64::consts::FRAC_PI_2, 0.1);
    let camera = Camera::look_at(DVec3::new(0.0, 0.0, 5.0), DVec3::ZERO, DVec3::Y, projection).expect("a plain camera");
    let corner = project(&camera, 2.0, DVec3::new(2.0, 1.0, 4.0));
    assert!((corner.truncate() - glam::DVec2::ONE).length() < 1e-12, "{corner}");
    assert!((camera.forward() - DVec3::NEG_Z).length() < 1e-12);
}

#[test]
fn looking_straight_up_or_down_still_makes_a_camera() {
    let projection = Projection::perspective(1.0, 0.1);
    for (target, up) in [
        (DVec3::Y, DVec3::Y),
        (DVec3::NEG_Y, DVec3::Y),
        (DVec3::NEG_Z, DVec3::Z),
        (DVec3::X, DVec3::ZERO),
        (DVec3::NEG_Z, DVec3::ZERO),
    ] {
        let camera = Camera::look_at(DVec3::ZERO, target, up, projection).expect("a direction");
        assert!(camera.world_from_view.is_normalized());
        assert!((camera.forward() - target).length() < 1e-9);
    }
    let at = DVec3::new(1.0, 2.0, 3.0);
    assert!(Camera::look_at(at, at, DVec3::Y, projection).is_err());
    assert!(Camera::look_at(at, DVec3::NAN, DVec3::Y, projection).is_err());
}

#[test]
fn a_node_camera_ignores_the_nodes_scale() {
    let projection = Projection::perspective(1.0, 0.1);
    let node = DMat4::from_translation(DVec3::new(1.0, 2.0, 3.0))
        * DMat4::from_rotation_y(std::f64::consts::FRAC_PI_2)
        * DMat4::from_scale(DVec3::new(2.0, 1e-9, 7.0));
    let camera = Camera::of_node("c", &node, projection).expect("z has a length");
    assert!((camera.forward() - DVec3::NEG_X).length() < 1e-9);
    assert_eq!(camera.eye, DVec3::new(1.0, 2.0, 3.0));
    assert!(Camera::of_node("flat", &DMat4::ZERO, projection).is_none());
}

/// The eight corners fit tightly: one of them nearly reaches the margin.
#[test]
fn orbit_frames_boxes_of_every_shape_and_size() {
    let boxes = [
        (DVec3::ZERO, DVec3::ONE),
        (DVec3::splat(-1e6), DVec3::new(1e6, 0.1, 1e6)),
        (DVec3::splat(1e5), DVec3::splat(1e5 + 0.01)),
        (DVec3::ZERO, DVec3::new(0.1, 50.0, 0.1)),
    ];
    for (min, max) in boxes {
        for aspect in [16.0 / 9.0, 1.0, 0.4] {
            let bounds = Aabb { min, max };
            let camera = orbit(&bounds, aspect);
            let furthest = bounds
                .corners()
                .into_iter()
                .map(|corner| {
                    let ndc = project(&camera, aspect, corner);
                    assert!(ndc.z > 0.0 && ndc.z < 1.0, "{corner} is behind the near plane");
                    ndc.truncate().abs().max_element()
                })
                .fold(0.0, f64::max);
            assert!(furthest < 1.0, "{min} {max} {aspect}: {furthest}");
            assert!(furthest > 0.8, "{min} {max} {aspect}: {furthest}");
        }
    }
}

#[test]
fn orbit_of_nothing_is_still_a_camera() {
    for bounds in [Aabb::EMPTY, Aabb::from_points(&[Vec3::new(3.0, 4.0, 5.0)])] {
        let camera = orbit(&bounds, 1.5);
        assert!(camera.eye.is_finite());
        assert!(camera.clip_from_view(1.5).is_finite());
        assert_eq!(camera, orbit(&bounds, 1.5));
    }
}

/// Accuracy at 10⁶ m: camera-relative f32 matrices place a point within 0.05 pixel of f64, unlike f32 world coordinates
/// (the control).
#[test]
fn far_from_the_origin_pixels_stay_put() {
    let far = DVec3::new(1e6, 20.0, -1e6);
    let projection = Projection::perspective(0.9, 0.1);
    let camera = Camera::look_at(far + DVec3::new(3.0, 1.0, 5.0), far, DVec3::Y, projection).expect("a plain camera");
    let instance = Instance::new("", MeshId::new(0), MaterialId::new(0), DMat4::from_translation(far), &Aabb::EMPTY);
    let clip_from_view = camera.clip_from_view(1.0).as_mat4();
    let relative = clip_from_view
        * Mat4::from_quat(camera.world_from_view.inverse().as_quat())
        * instance.relative_from_model(camera.eye);
    let plain = clip_from_view * camera.view_from_world().as_mat4() * instance.world_from_model.as_mat4();
    let (mut worst_relative, mut worst_plain) = (0.0_f32, 0.0_f32);
    for i in 0..200_u16 {
        let angle = f32::from(i) * 0.7;
        let model = Vec3::new(angle.sin(), angle.cos(), (2.0 * angle).sin()) * 0.7;
        let exact = project(&camera, 1.0, far + model.as_dvec3()).as_vec3();
        let pixels = |ndc: Vec3| (ndc - exact).truncate().abs().max_element() * 960.0;
        worst_relative = worst_relative.max(pixels(relative.project_point3(model)));
        worst_plain = worst_plain.max(pixels(plain.project_point3(model)));
    }
    assert!(worst_relative < 0.05, "{worst_relative} px");
    assert!(worst_plain > 0.5, "the control is too good: {worst_plain} px");
}

#[test]
fn exposure_follows_the_formula_and_stays_finite() {
    assert!((exposure_from_ev100(0.0) - 1.0 / 1.2).abs() < 1e-7);
    assert!((exposure_from_ev100(15.0) * 110_000.0 - 2.797).abs() < 1e-3);
    for ev in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 1e30, -1e30] {
        let exposure = exposure_from_ev100(ev);
        assert!(exposure.is_finite() && exposure > 0.0, "{ev}");
    }
    assert_eq!(exposure_from_ev100(30.0), exposure_from_ev100(24.0));
    // f/16 at 1/125 s and ISO 100 is the sunny-16 rule: slightly below EV 15.
    let sunny = ev100_from_settings(16.0, 1.0 / 125.0, 100.0).expect("positive settings");
    assert!((sunny - 14.966).abs() < 1e-3);
    assert_eq!(ev100_from_settings(0.0, 1.0, 100.0), None);
    assert_eq!(ev100_from_settings(1.0, f32::NAN, 100.0), None);
    // 4096 nits is a sunlit scene: log2(32768) = 15.
    assert_eq!(ev100_from_average_luminance(4096.0), 15.0);
    assert_eq!(ev100_from_average_luminance(0.0), EV100_RANGE.0);
    assert_eq!(ev100_from_average_luminance(f64::NAN), EV100_RANGE.0);
}

#[test]
fn choices_parse_or_say_why_not() {
    assert_eq!("orbit".parse::<CameraChoice>().ok(), Some(CameraChoice::Orbit));
    assert_eq!("Main: 2".parse::<CameraChoice>().ok(), Some(CameraChoice::Named("Main: 2".into())));
    assert_eq!(
        "1,2,-3:0,0.5,0:45".parse::<CameraChoice>().ok(),
        Some(CameraChoice::LookAt {
            eye: DVec3::new(1.0, 2.0, -3.0),
            target: DVec3::new(0.0, 0.5, 0.0),
            fov_y_deg: 45.0,
        })
    );
    for (text, reason) in [
        ("", "the name is empty"),
        ("1,2,3:0,0,0", "2 parts between colons"),
        ("1,2:0,0,0:45", "eye: 2 coordinates"),
        ("1,2,x:0,0,0:45", "\"x\" is not a number"),
        ("1,2,inf:0,0,0:45", "\"inf\" is not finite"),
        ("1,2,3:0,0,0:180", "between 0 and 180"),
        ("1,2,3:0,0,0:NaN", "not finite"),
        ("1,2,3:1,2,3:45", "coincide"),
    ] {
        let error = text.parse::<CameraChoice>().expect_err(text).to_string();
        assert!(error.contains(reason), "{error}");
        assert!(error.contains("EX,EY,EZ"), "{error}");
    }
}

#[test]
fn an_unknown_camera_lists_the_known_ones() {
    let mut scene = Scene::default();
    for name in ["front", "top"] {
        let mut camera = orbit(&Aabb::EMPTY, 1.0);
        camera.name = name.into();
        scene.cameras.push(camera);
    }
    let top = CameraChoice::Named("top".into());
    assert_eq!(top.resolve(&scene, 1.0).expect("it exists").name, "top");
    let error = CameraChoice::Named("left".into()).resolve(&scene, 1.0).expect_err("there is none").to_string();
    assert!(error.contains("\"left\"") && error.contains("front, top"), "{error}");
}

#[test]
fn a_parallel_projection_shows_more_rather_than_stretch() {
    let of = |width, height| Projection::Orthographic {
        half_width_m: Some(width),
        half_height_m: height,
        near_m: 0.0,
        far_m: 1.0,
    };
    for (picture, seen) in [(2.0, (4.0, 2.0)), (4.0, (8.0, 2.0)), (0.5, (4.0, 8.0))] {
        assert_eq!(of(4.0, 2.0).unstretched(picture), of(seen.0, seen.1), "{picture}");
    }
    let perspective = Projection::perspective(1.0, 0.1);
    assert_eq!(perspective.unstretched(3.0), perspective);
}
