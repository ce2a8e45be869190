//! Materials, textures, lights and cameras.

use std::f32::consts::{FRAC_PI_2, FRAC_PI_4};

use glam::{DVec3, Vec2, Vec3, Vec4};
use serde_json::{Value, json};

use super::fixture::{Fixture, png};
use crate::camera::Projection;
use crate::light::LightKind;
use crate::material::{AlphaMode, EmissiveUnit, Material};
use crate::texture::{Filter, Sampler, TextureRole, Wrap};

fn with_material(material: Value) -> Fixture {
    let mut fixture = Fixture::triangle();
    let uv = fixture.floats(2, &[0.0; 6]);
    fixture.set("/meshes/0/primitives/0/attributes/TEXCOORD_0", json!(uv));
    fixture.set("/meshes/0/primitives/0/attributes/TEXCOORD_1", json!(uv));
    for color in [[255, 0, 0, 255], [0, 255, 0, 128]] {
        let view = fixture.view(&png(2, 1, color));
        fixture.push("images", json!({"bufferView": view, "mimeType": "image/png"}));
    }
    fixture.push("samplers", json!({"wrapS": 33071, "wrapT": 33648, "magFilter": 9728, "minFilter": 9985}));
    fixture.push("textures", json!({"source": 0, "sampler": 0}));
    fixture.push("textures", json!({"source": 1}));
    fixture.push("materials", material);
    fixture.set("/meshes/0/primitives/0/material", json!(0));
    fixture
}

#[test]
fn a_primitive_without_material_gets_the_specified_default() {
    let scene = Fixture::triangle().load().expect("a good file");
    assert_eq!(scene.materials, [Material::default()]);
    let default = &scene.materials[0];
    assert_eq!((default.metallic, default.roughness), (1.0, 1.0));
    assert!((default.dielectric_f0() - 0.04).abs() < 1e-7);
    let plain = with_material(json!({"emissiveFactor": [1.0, 1.0, 1.0]}));
    let unit = plain.load().expect("a good file").materials[0].emissive_unit;
    assert_eq!(unit, EmissiveUnit::Display);
}

/// Every factor and all five textures, with transforms on each kind of reference.
#[test]
fn a_full_material_comes_through() {
    let moved = |texture: usize, uv: u32, x: f32| {
        json!({
            "index": texture,
            "texCoord": 0,
            "extensions": {"KHR_texture_transform":
                {"offset": [x, 0.5], "rotation": 0.25, "scale": [2.0, 3.0], "texCoord": uv}},
        })
    };
    let mut normal = moved(1, 1, 3.0);
    normal["scale"] = json!(0.7);
    let mut occlusion = moved(0, 0, 4.0);
    occlusion["strength"] = json!(0.6);
    let scene = with_material(json!({
        "name": "all",
        "pbrMetallicRoughness": {
            "baseColorFactor": [0.1, 0.2, 0.3, 0.4],
            "metallicFactor": 0.25,
            "roughnessFactor": 0.75,
            "baseColorTexture": moved(0, 0, 1.0),
            "metallicRoughnessTexture": moved(0, 1, 2.0),
        },
        "normalTexture": normal,
        "occlusionTexture": occlusion,
        "emissiveTexture": moved(1, 0, 5.0),
        "emissiveFactor": [1.0, 0.5, 0.25],
        "alphaMode": "MASK",
        "alphaCutoff": 0.3,
        "doubleSided": true,
        "extensions": {
            "KHR_materials_emissive_strength": {"emissiveStrength": 1000.0},
            "KHR_materials_ior": {"ior": 2.0},
            "KHR_materials_unlit": {},
        },
    }))
    .load()
    .expect("a good file");
    assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);
    let m = &scene.materials[0];
    assert_eq!(m.name, "all");
    assert_eq!(m.base_color, Vec4::new(0.1, 0.2, 0.3, 0.4));
    assert_eq!((m.metallic, m.roughness), (0.25, 0.75));
    assert_eq!(m.emissive, Vec3::new(1000.0, 500.0, 250.0));
    assert_eq!(m.emissive_unit, EmissiveUnit::Nits);
    assert!((m.dielectric_f0() - 1.0 / 9.0).abs() < 1e-6);
    assert_eq!((m.normal_scale, m.occlusion_strength), (0.7, 0.6));
    assert_eq!(m.alpha, AlphaMode::Mask { cutoff: 0.3 });
    assert!(m.double_sided && m.unlit);
    // Offset, coordinate set (overridden by the transform) and role of each slot, in order.
    let expected = [
        (1.0, 0, TextureRole::Color, 0),
        (2.0, 1, TextureRole::Linear, 0),
        (3.0, 1, TextureRole::Normal, 1),
        (4.0, 0, TextureRole::Linear, 0),
        (5.0, 0, TextureRole::Color, 1),
    ];
    for (slot, (x, uv_set, role, green)) in m.slots().into_iter().zip(expected) {
        let slot = slot.expect("all five textures are there");
        assert_eq!(slot.transform.offset, Vec2::new(x, 0.5));
        assert_eq!(slot.transform.rotation_rad, 0.25);
        assert_eq!(slot.transform.scale, Vec2::new(2.0, 3.0));
        assert_eq!(slot.uv_set, uv_set);
        let texture = scene.textures[slot.texture.index()];
        assert_eq!(texture.role, role);
        let image = &scene.images[texture.image.index()];
        assert_eq!((image.width, image.height), (2, 1));
        let texel = [[255, 0, 0, 255], [0, 255, 0, 128]][green];
        assert_eq!(image.rgba8().expect("it is a PNG")[..4], texel);
        let sampler = scene.samplers[texture.sampler.index()];
        let given = Sampler {
            wrap_u: Wrap::ClampToEdge,
            wrap_v: Wrap::MirroredRepeat,
            mag: Filter::Nearest,
            min: Filter::Linear,
            mip: Some(Filter::Nearest),
        };
        assert_eq!(sampler, if green == 0 { given } else { Sampler::default() });
    }
    // Image 0 and image 1 in two roles each: four textures, two images, two samplers.
    let sizes = (scene.textures.len(), scene.images.len(), scene.samplers.len());
    assert_eq!(sizes, (4, 2, 2));
}

#[test]
fn ignored_features_are_warned_of() {
    let mut fixture = with_material(json!({
        "pbrMetallicRoughness": {
            "baseColorTexture": {"index": 0, "texCoord": 2},
            "roughnessFactor": 1.5,
        },
        "extensions": {"KHR_materials_volume_scatter": {"scatterAnisotropy": 0.5}},
    }));
    fixture.json["extensionsUsed"] = json!(["KHR_materials_volume_scatter", "EXT_unheard_of"]);
    let scene = fixture.load().expect("a good file");
    for word in [
        "KHR_materials_volume_scatter is ignored (1 materials",
        "EXT_unheard_of is ignored",
        "TEXCOORD_2",
        "roughnessFactor of 1.5 was clamped to 1",
    ] {
        assert!(scene.warnings.iter().any(|w| w.contains(word)), "{word}: {:?}", scene.warnings);
    }
    assert_eq!(scene.materials[0].base_color_texture, None);
}

#[test]
fn textures_without_coordinates_are_warned_of() {
    let mut fixture = with_material(json!({"normalTexture": {"index": 0}, "emissiveTexture": {"index": 0}}));
    let attributes = fixture.json.pointer_mut("/meshes/0/primitives/0/attributes");
    let attributes = attributes.expect("there").as_object_mut().expect("an object");
    attributes.remove("TEXCOORD_0");
    let scene = fixture.load().expect("a good file");
    let lacking = scene.warnings.iter().filter(|w| w.contains("lacks")).count();
    assert_eq!(lacking, 1, "{:?}", scene.warnings);
    assert_eq!(scene.meshes[0].tangents.len(), 3, "frames come from the normals");
}

fn with_light(light: Value) -> Fixture {
    let mut fixture = Fixture::triangle();
    fixture.json["extensionsRequired"] = json!(["KHR_lights_punctual"]);
    fixture.json["extensions"] = json!({"KHR_lights_punctual": {"lights": [light]}});
    // 90° around x: −z becomes +y; lights ignore the scale.
    let half = std::f32::consts::FRAC_1_SQRT_2;
    fixture.push(
        "nodes",
        json!({
            "name": "lamp", "translation": [1.0, 2.0, 3.0], "scale": [2.0, 2.0, 2.0],
            "rotation": [half, 0.0, 0.0, half],
            "extensions": {"KHR_lights_punctual": {"light": 0}},
        }),
    );
    fixture.set("/scenes/0/nodes", json!([0, 1]));
    fixture
}

#[test]
fn lights_have_their_units_place_and_direction() {
    let sun = json!({"type": "directional", "intensity": 90000.0, "name": "sun"});
    let scene = with_light(sun).load().expect("a good file");
    let light = &scene.lights[0];
    assert_eq!(light.name, "sun");
    assert_eq!(light.kind, LightKind::Directional { illuminance_lux: 90000.0, angular_radius_rad: 0.0 });
    assert!((light.direction - Vec3::Y).length() < 1e-6);

    let point = json!({"type": "point", "intensity": 80.0, "range": 7.5, "color": [1.0, 0.5, 0.0]});
    let scene = with_light(point).load().expect("a good file");
    let light = &scene.lights[0];
    assert_eq!(light.name, "lamp");
    assert_eq!(light.position, DVec3::new(1.0, 2.0, 3.0));
    assert_eq!(light.color, Vec3::new(1.0, 0.5, 0.0));
    assert_eq!(light.kind, LightKind::Point { intensity_candela: 80.0, range_m: Some(7.5) });

    let scene = with_light(json!({"type": "spot", "spot": {}})).load().expect("a good file");
    assert_eq!(
        scene.lights[0].kind,
        LightKind::Spot { intensity_candela: 1.0, range_m: None, inner_cone_rad: 0.0, outer_cone_rad: FRAC_PI_4 }
    );
    assert!(scene.warnings.is_empty());
}

/// Equal inner and outer angles would divide by zero in the falloff; a half-angle beyond 90° is no cone.
#[test]
fn cone_angles_are_kept_apart() {
    for (inner, outer) in [(0.5, 0.5), (1.0, 0.5), (0.2, 3.0)] {
        let spot = json!({"innerConeAngle": inner, "outerConeAngle": outer});
        let scene = with_light(json!({"type": "spot", "spot": spot})).load().expect("a good file");
        let LightKind::Spot { inner_cone_rad, outer_cone_rad, .. } = scene.lights[0].kind else {
            panic!("a spot");
        };
        assert!(inner_cone_rad < outer_cone_rad && outer_cone_rad <= FRAC_PI_2);
        assert!(scene.warnings[0].contains("clamped"), "{:?}", scene.warnings);
    }
}

#[test]
fn broken_lights_are_errors() {
    for (light, word) in [
        (json!({"type": "point", "range": 0.0}), "range is 0"),
        (json!({"type": "point", "intensity": -1.0}), "intensity is -1"),
        (json!({"type": "point", "intensity": 1e300}), "intensity is inf"),
        (json!({"type": "point", "color": [1.0, -1.0, 0.0]}), "color is"),
        (json!({"type": "spot"}), "without cone angles"),
        (json!({"type": "spot", "spot": {"outerConeAngle": 0.0}}), "cone angles"),
    ] {
        let error = with_light(light).error();
        assert!(error.contains("light 0") && error.contains(word), "{error}");
    }
    let area = with_light(json!({"type": "area"}));
    assert!(area.warnings().contains("light 0: its type is unknown") && area.load().expect("warned").lights.is_empty());
    let mut flat = with_light(json!({"type": "directional"}));
    flat.set("/nodes/1/scale", json!([1.0, 1.0, 0.0]));
    assert!(flat.error().contains("no direction"));
    let mut missing = with_light(json!({"type": "directional"}));
    missing.set("/nodes/1/extensions/KHR_lights_punctual/light", json!(4));
    assert!(missing.error().contains("names light 4, but there are 1"));
}

fn with_camera(camera: Value) -> Fixture {
    let mut fixture = Fixture::triangle();
    fixture.push("cameras", camera);
    fixture.push("nodes", json!({"name": "tripod", "camera": 0, "translation": [0.0, 1.0, 5.0]}));
    fixture.set("/scenes/0/nodes", json!([0, 1]));
    fixture
}

#[test]
fn cameras_come_with_name_and_projection() {
    let lens = json!({"yfov": 0.8, "znear": 0.1, "aspectRatio": 1.5});
    let named = json!({"type": "perspective", "name": "main", "perspective": lens});
    let scene = with_camera(named).load().expect("a good file");
    let camera = &scene.cameras[0];
    assert_eq!(camera.name, "main");
    assert_eq!(camera.eye, DVec3::new(0.0, 1.0, 5.0));
    assert!((camera.forward() - DVec3::NEG_Z).length() < 1e-9);
    assert_eq!(camera.projection, Projection::perspective(f64::from(0.8_f32), f64::from(0.1_f32)));
    assert_eq!(scene.default_camera(1.0), *camera);

    let ortho = json!({"xmag": -2.0, "ymag": 1.0, "znear": 0.0, "zfar": 10.0});
    let scene = with_camera(json!({"type": "orthographic", "orthographic": ortho})).load().expect("a good file");
    assert_eq!(scene.cameras[0].name, "tripod");
    assert_eq!(
        scene.cameras[0].projection,
        Projection::Orthographic { half_width_m: Some(2.0), half_height_m: 1.0, near_m: 0.0, far_m: 10.0 }
    );
}

#[test]
fn broken_cameras_are_errors() {
    for (lens, word) in [
        (json!({"yfov": 0.0, "znear": 0.1}), "yfov is 0"),
        (json!({"yfov": 1.0, "znear": 0.0}), "znear is 0"),
        (json!({"yfov": 1.0, "znear": 1.0, "zfar": 1.0}), "zfar is 1"),
    ] {
        let error = with_camera(json!({"type": "perspective", "perspective": lens})).error();
        assert!(error.contains("camera 0") && error.contains(word), "{error}");
    }
    let wide = with_camera(json!({"type": "perspective", "perspective": {"yfov": 4.0, "znear": 0.1}}));
    assert!(wide.warnings().contains("camera 0: its yfov") && wide.load().expect("warned").cameras.is_empty());
    // The parameters of the type are missing; the accessor of the `gltf` crate would panic.
    let lens = json!({"yfov": 1.0, "znear": 0.1});
    let error = with_camera(json!({"type": "orthographic", "perspective": lens})).error();
    assert!(error.contains("no parameters"), "{error}");
}
