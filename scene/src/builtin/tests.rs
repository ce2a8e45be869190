//! The built-in scenes are valid and show what they are made for.

use crate::material::{Lobe, Lobes};

use super::*;
use crate::material::AlphaMode;
use crate::texture::UvTransform;
use glam::Vec3;

#[test]
fn every_built_in_scene_is_sound() {
    for name in NAMES {
        let scene = builtin(name).expect(name);
        assert_eq!(scene.check(), Ok(()), "{name}");
        assert_eq!(scene.name, name);
        assert!(scene.warnings.is_empty());
        assert!(scene.triangle_count() > 1000, "{name}");
        assert!(!scene.cameras.is_empty());
        // The ground continues to the horizon; an orbit frames the objects on it.
        let [whole, above] = [scene.bounds(), scene.bounds_above_ground()].map(|bounds| bounds.radius());
        assert_eq!(scene.ground_albedo.is_some(), above < 0.5 * whole, "{name}: {above} m of {whole} m");
        for mesh in &scene.meshes {
            assert!(!mesh.tangents.is_empty(), "{name} {}", mesh.name);
            for [a, b, c] in mesh.triangles() {
                let p = |i: usize| mesh.positions[i].as_dvec3();
                let area = (p(b) - p(a)).cross(p(c) - p(a)).length();
                assert!(area > 1e-8, "{name} {} has a triangle without area", mesh.name);
            }
        }
        // The first camera sees everything but the ground.
        let lists = crate::DrawLists::for_camera(&scene, &scene.cameras[0], 16.0 / 9.0);
        assert_eq!(lists.culled, 0, "{name}");
    }
}

#[test]
fn the_same_name_gives_the_same_scene() {
    for name in NAMES {
        let (a, b) = (builtin(name).expect(name), builtin(name).expect(name));
        assert_eq!(a.meshes, b.meshes);
        assert_eq!(a.images, b.images);
        assert_eq!(a.instances, b.instances);
    }
}

#[test]
fn spheres_span_metallic_and_roughness() {
    let scene = builtin("spheres").expect("it is built in");
    let corner = |metallic: f32, roughness: f32| {
        scene.materials.iter().any(|m| m.metallic == metallic && m.roughness == roughness)
    };
    assert!(corner(0.0, 0.0) && corner(0.0, 1.0) && corner(1.0, 0.0) && corner(1.0, 1.0));
    assert_eq!(scene.instances.len(), 36);
}

#[test]
fn materials_show_every_feature() {
    let scene = builtin("materials").expect("it is built in");
    let some = |what: &str, has: &dyn Fn(&crate::Material) -> bool| {
        assert!(scene.materials.iter().any(has), "no material with {what}");
    };
    some("mask", &|m| matches!(m.alpha, AlphaMode::Mask { .. }));
    some("blend", &|m| m.alpha == AlphaMode::Blend);
    some("double sides", &|m| m.double_sided);
    some("unlit", &|m| m.unlit);
    some("emission", &|m| m.emissive != Vec3::ZERO);
    some("base color map", &|m| m.base_color_texture.is_some());
    some("metallic-roughness map", &|m| m.metallic_roughness_texture.is_some());
    some("normal map", &|m| m.normal_texture.is_some());
    some("occlusion map", &|m| m.occlusion_texture.is_some());
    some("emissive map", &|m| m.emissive_texture.is_some());
    some("texture transform", &|m| m.slots().iter().flatten().any(|s| s.transform != UvTransform::default()));
    assert!(scene.meshes.iter().any(|m| !m.colors.is_empty()));
    for metal in METALS {
        some(metal.name, &|m| m.name == metal.name && m.metallic == 1.0);
    }
}

#[test]
fn there_are_as_many_lamps_as_asked_for() {
    for (name, count) in [("lamps", 1000), ("lamps:0", 0), ("lamps:1", 1), ("lamps:37", 37)] {
        let scene = builtin(name).expect(name);
        assert_eq!((scene.lights.len(), scene.name.as_str()), (count, "lamps"));
        assert_eq!(scene.check(), Ok(()));
    }
    for name in ["lamps:", "lamps:-1", "lamps:65537", "lamps:1e3", "lamps:\n"] {
        let told = builtin(name).expect_err(name).to_string();
        assert!(told.starts_with("lamps:") && told.contains("65536") && !told.contains('\n'), "{told}");
    }
}

#[test]
fn there_are_as_many_panes_as_asked_for() {
    for (name, count) in [("panes", 5), ("panes:0", 0), ("panes:7", 7)] {
        let scene = builtin(name).expect(name);
        let blended = scene.materials.iter().filter(|m| m.alpha == AlphaMode::Blend && m.double_sided).count();
        assert_eq!((blended, scene.name.as_str()), (count + 2, "panes"));
        assert_eq!(scene.check(), Ok(()));
    }
    for name in ["panes:", "panes:65", "panes:x\n"] {
        let told = builtin(name).expect_err(name).to_string();
        assert!(told.starts_with("panes:") && told.contains("64") && !told.contains('\n'), "{told}");
    }
}

/// Each scene uses the lobes that it shows; those for the base alone use none.
#[test]
fn lobes_and_glass_call_for_what_they_show() {
    let called_for = |name: &str| builtin(name).expect(name).lobes();
    let glass = Lobes::NONE.with(Lobe::Transmission);
    assert_eq!(called_for("glass"), glass);
    let optics = [Lobe::Iridescence, Lobe::Dispersion, Lobe::DiffuseTransmission, Lobe::Transmission];
    assert_eq!(called_for("optics"), optics.into_iter().collect());
    let lobes = [Lobe::ClearCoat, Lobe::Sheen, Lobe::Anisotropy, Lobe::Specular];
    assert_eq!(called_for("lobes"), lobes.into_iter().collect());
    for plain in ["columns", "materials", "spheres"] {
        assert!(called_for(plain).is_empty(), "{plain}");
    }
}

#[test]
fn an_unknown_name_lists_the_known_ones() {
    let error = builtin("sphere\n").expect_err("no such scene").to_string();
    assert!(error.contains("balls, columns, glass, lamps, lobes, materials, optics, panes, spheres"), "{error}");
    assert!(!error.contains('\n'));
}
