//! Files under `tests/files/cases`, which other importers often reject. Their README describes the correct result.

use std::path::Path;

use glam::{DMat3, DVec3};

use crate::Scene;
use crate::import::load_bytes;
use crate::progress::silent;

macro_rules! case {
    ($name:literal) => {
        ($name, include_bytes!(concat!("../../../tests/files/cases/", $name, ".gltf")).as_slice())
    };
}

const BASE: (&str, &[u8]) = case!("00_base");

fn loaded((name, bytes): (&str, &[u8])) -> Scene {
    let scene = load_bytes(Path::new(&format!("{name}.gltf")), bytes, &mut silent).expect(name);
    assert_eq!(scene.check(), Ok(()), "{name}");
    scene
}

/// Position, normal and texture coordinates of a corner, in units of 1e-4.
type Corner = [i64; 8];

/// Returns all triangles in world axes, rotated to start at their smallest corner, and sorted. `moved` maps positions.
fn triangles(scene: &Scene, moved: impl Fn(DVec3, DVec3) -> DVec3) -> Vec<[Corner; 3]> {
    let mut all = Vec::new();
    for instance in &scene.instances {
        let (mesh, world) = (&scene.meshes[instance.mesh.index()], instance.world_from_model);
        let turn = DMat3::from_mat4(world).inverse().transpose();
        let corner = |vertex: &u32| {
            let vertex = *vertex as usize;
            let normal = (turn * mesh.normals[vertex].as_dvec3()).normalize();
            let position = moved(world.transform_point3(mesh.positions[vertex].as_dvec3()), normal);
            let uv = mesh.uv0[vertex].as_dvec2();
            let numbers = [position.x, position.y, position.z, normal.x, normal.y, normal.z, uv.x, uv.y];
            // Rounding to units of 1e-4 hides f32 rounding (1e-7), but no visible fault.
            numbers.map(|number| (number * 1e4).round() as i64)
        };
        for triangle in mesh.indices.chunks(3) {
            let mut corners = [0, 1, 2].map(|i| corner(&triangle[i]));
            let first = (0..3).min_by_key(|i| corners[*i]).expect("there are three");
            corners.rotate_left(first);
            all.push(corners);
        }
    }
    all.sort_unstable();
    all
}

fn still(position: DVec3, _: DVec3) -> DVec3 {
    position
}

/// Checks that two scenes have equal cameras, lights, materials, textures and texels.
fn assert_same_look(case: &Scene, base: &Scene) {
    let name = &case.name;
    assert_eq!(case.materials, base.materials, "{name}");
    assert_eq!((&case.textures, &case.samplers), (&base.textures, &base.samplers), "{name}");
    assert_eq!((&case.cameras, &case.lights), (&base.cameras, &base.lights), "{name}");
    let texels = |scene: &Scene| scene.images.iter().map(|image| image.rgba8().map(<[u8]>::to_vec)).collect::<Vec<_>>();
    assert_eq!(texels(case), texels(base), "{name}");
    assert_eq!(case.instances.len(), base.instances.len(), "{name}");
}

#[test]
fn files_that_equal_the_plain_box() {
    let base = loaded(BASE);
    let truth = triangles(&base, still);
    assert_eq!((truth.len(), base.cameras.len(), base.images.len()), (12, 1, 1));
    assert!(base.warnings.is_empty(), "{:?}", base.warnings);
    let cases = [
        (case!("04_channel_without_node"), ""),
        (case!("07_primitive_without_position"), "mesh 1 primitive 0: it has no POSITION and is not drawn"),
        (case!("09_one_zero_normal"), "mesh 0 primitive 0: 1 normals have no direction; they were recomputed"),
        (case!("12_node_visibility"), ""),
        (case!("13_buffer_without_uri"), ""),
        (case!("15_integer_as_float"), ""),
    ];
    for (case, warning) in cases {
        let scene = loaded(case);
        assert_eq!(triangles(&scene, still), truth, "{}", case.0);
        assert_same_look(&scene, &base);
        assert_eq!(scene.warnings.len(), usize::from(!warning.is_empty()), "{}: {:?}", case.0, scene.warnings);
        assert!(scene.warnings.iter().all(|line| line.contains(warning)), "{:?}", scene.warnings);
    }
}

/// The joint of the +x face is 0.4 away from its bind pose; in the second file the first set of weights is 0 there.
#[test]
fn skins_move_the_face_of_the_box() {
    let base = loaded(BASE);
    let faces_x = |normal: DVec3| normal.x > 0.5;
    let moved = |position: DVec3, normal| if faces_x(normal) { position + DVec3::X * 0.4 } else { position };
    for case in [case!("01_skin_inverse_bind_matrices"), case!("08_skin_two_weight_sets")] {
        let scene = loaded(case);
        assert_eq!(triangles(&scene, still), triangles(&base, moved), "{}", case.0);
        assert_same_look(&scene, &base);
        assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);
    }
    assert_ne!(triangles(&base, moved), triangles(&base, still));
}

#[test]
fn a_scene_without_nodes_is_empty() {
    let scene = loaded(case!("05_scene_without_nodes"));
    assert!(scene.instances.is_empty() && scene.meshes.is_empty());
    assert!(scene.warnings.len() == 1 && scene.warnings[0].contains("the scene draws nothing"), "{:?}", scene.warnings);
}

#[test]
fn the_old_format_is_named() {
    let (name, bytes) = case!("11_gltf1_message");
    let error = load_bytes(Path::new(name), bytes, &mut silent).expect_err("it is of glTF 1.0").to_string();
    assert!(error.contains("glTF version \"1.0\" is not supported"), "{error}");
}

#[test]
fn transmission_that_blends_loads() {
    let scene = loaded(case!("03_blend_transmission"));
    assert_eq!(triangles(&scene, still), triangles(&loaded(BASE), still));
    assert_eq!(scene.materials[0].transmission.map(|lobe| lobe.factor), Some(0.8));
}

#[test]
fn a_texture_without_a_source_is_left_out() {
    let (case, base) = (loaded(case!("06_texture_without_source")), loaded(BASE));
    assert_eq!(triangles(&case, still), triangles(&base, still));
    assert_eq!((case.materials[0].base_color_texture, case.images.len()), (None, 0));
    assert!(case.warnings.iter().any(|warning| warning.contains("texture 0")), "{:?}", case.warnings);
}
