//! The binding convention against what the shaders declare.

use std::collections::{BTreeMap, BTreeSet};

use framegraph_shaders::bindings::{
    CONVENTIONS, GROUP_FRAME, GROUP_MATERIAL, GROUP_OBJECTS, Resource, Sampling, convention,
};
use framegraph_shaders::layout::VERTEX_ATTRIBUTES;
use framegraph_shaders::reflect::{BindingKind, Sample, Stage};
use framegraph_shaders::{Feature, Features, ShaderId};

use crate::variants;

fn everything() -> Features {
    Feature::ALL.into_iter().fold(Features::NONE, Features::with)
}

#[test]
fn every_slot_is_in_the_convention_and_every_convention_in_use() {
    let mut used = BTreeSet::new();
    for variant in &variants::all().0 {
        for binding in variant.shader.reflection.entry_points.iter().flat_map(|e| &e.bindings) {
            let known = convention(&binding.name).unwrap_or_else(|| panic!("{} of {}", binding.name, variant.name()));
            let fits = match (known.resource, binding.kind) {
                (Resource::Uniform(_), BindingKind::Uniform { .. })
                | (Resource::Storage(_), BindingKind::Storage { read_only: true, .. })
                | (Resource::Texture(_), BindingKind::Texture { .. }) => true,
                (Resource::Sampler(how), BindingKind::Sampler { comparison }) => {
                    comparison == (how == Sampling::ShadowCompare)
                }
                _ => false,
            };
            assert!(fits, "{}: {:?} is no {:?}", binding.name, binding.kind, known.resource);
            used.insert(binding.name.clone());
        }
    }
    let conventions: BTreeSet<String> = CONVENTIONS.iter().map(|c| c.name.to_owned()).collect();
    assert_eq!(used, conventions);
    assert_eq!(conventions.len(), CONVENTIONS.len(), "a name is listed twice");
}

#[test]
fn one_place_holds_one_variable_within_a_pass() {
    for variant in &variants::all().0 {
        let mut places = BTreeMap::new();
        for binding in variant.shader.reflection.entry_points.iter().flat_map(|e| &e.bindings) {
            let place = (binding.group, binding.binding);
            let before = places.insert(place, binding.name.clone());
            assert!(before.is_none_or(|name| name == binding.name), "{place:?}");
        }
    }
}

#[test]
fn the_color_pass_binds_frame_material_and_objects() {
    let color = framegraph_shaders::resolve(ShaderId::Color, everything()).unwrap();
    let groups = color.reflection.groups(&["vs_main", "fs_main"]);
    let names =
        |group: u32| -> Vec<&str> { groups[group as usize].iter().map(|slot| slot.binding.name.as_str()).collect() };
    assert_eq!(groups.len(), 3);
    assert_eq!(names(GROUP_FRAME).len(), 9);
    assert_eq!(names(GROUP_MATERIAL).len(), 31);
    assert_eq!(names(GROUP_OBJECTS), ["objects"]);

    let frame = &groups[GROUP_FRAME as usize][0];
    assert!(frame.vertex && frame.fragment && !frame.compute);
    let objects = &groups[GROUP_OBJECTS as usize][0];
    assert!(objects.vertex && !objects.fragment, "the fragment stage reads no objects");
}

/// WebGPU's default limits, 16 sampled textures and 16 samplers a stage, hold every lobe by itself, and the two that bind
/// most together.
#[test]
fn surfaces_with_one_or_two_lobes_fit_every_device() {
    for lobes in Features::subsets(&Feature::LOBES).into_iter().filter(|lobes| lobes.iter().count() <= 2) {
        let features = lobes.with(Feature::Shadows).with(Feature::EnvironmentMap);
        let color = framegraph_shaders::resolve(ShaderId::Color, features).unwrap();
        let groups = color.reflection.groups(&["vs_main", "fs_main"]);
        let count = |is: fn(&BindingKind) -> bool| {
            groups.iter().flatten().filter(|slot| slot.fragment && is(&slot.binding.kind)).count()
        };
        assert!(count(|kind| matches!(kind, BindingKind::Texture { .. })) <= 16, "{lobes:?}");
        assert!(count(|kind| matches!(kind, BindingKind::Sampler { .. })) <= 16, "{lobes:?}");
    }
}

#[test]
fn features_add_and_remove_their_bindings() {
    let names = |features| -> Vec<String> {
        let shader = framegraph_shaders::resolve(ShaderId::Color, features).unwrap();
        let fragment = shader.reflection.entry_point("fs_main").unwrap();
        fragment.bindings.iter().map(|binding| binding.name.clone()).collect()
    };
    let plain = names(Features::NONE);
    let own: [(Feature, &[&str]); 7] = [
        (Feature::Shadows, &["shadow_map"]),
        (Feature::EnvironmentMap, &["specular_map"]),
        (Feature::ClearCoat, &["clear_coat", "clear_coat_roughness", "clear_coat_normal"]),
        (Feature::Sheen, &["sheen_color", "sheen_roughness"]),
        (Feature::Anisotropy, &["anisotropy"]),
        (Feature::Transmission, &["transmission", "thickness"]),
        (Feature::Specular, &["specular", "specular_color"]),
    ];
    for (feature, own) in own {
        let with = names(Features::NONE.with(feature));
        let added: BTreeSet<String> = with.into_iter().filter(|name| !plain.contains(name)).collect();
        let pair = |name: &&str| match feature {
            Feature::Shadows => vec![(*name).to_owned(), "shadow_sampler".to_owned()],
            // The cube shares the sampler of the table.
            Feature::EnvironmentMap => vec![(*name).to_owned()],
            _ => vec![format!("{name}_texture"), format!("{name}_sampler")],
        };
        let mut expected: BTreeSet<String> = own.iter().flat_map(pair).collect();
        if feature == Feature::Transmission {
            expected.extend(["scene_levels", "scene_sampler"].map(str::to_owned));
        }
        assert_eq!(added, expected, "{}", feature.name());
    }
}

#[test]
fn a_texture_that_is_only_loaded_need_not_be_filterable() {
    let kind = |id, entry: &str, name: &str| {
        let shader = framegraph_shaders::resolve(id, Features::NONE).unwrap();
        let entry = shader.reflection.entry_point(entry).unwrap().clone();
        entry.bindings.into_iter().find(|b| b.name == name).unwrap().kind
    };
    let filterable = |kind| match kind {
        BindingKind::Texture { sample: Sample::Float { filterable }, .. } => filterable,
        other => panic!("{other:?}"),
    };
    assert!(!filterable(kind(ShaderId::Post, "fs_main", "hdr")));
    assert!(!filterable(kind(ShaderId::Copy, "fs_copy", "source")));
    assert!(filterable(kind(ShaderId::Copy, "fs_blit", "source")));
    assert!(filterable(kind(ShaderId::Fxaa, "fs_main", "ldr")));
}

#[test]
fn vertex_stages_read_what_the_vertex_format_stores() {
    let mut read = BTreeSet::new();
    for variant in &variants::all().0 {
        for entry in &variant.shader.reflection.entry_points {
            assert!(entry.stage == Stage::Vertex || entry.vertex_inputs.is_empty());
            for input in &entry.vertex_inputs {
                let stored = VERTEX_ATTRIBUTES.iter().find(|a| a.location == input.location);
                let stored = stored.unwrap_or_else(|| panic!("{} {input:?}", variant.name()));
                assert_eq!(stored.format.components(), input.components);
                read.insert(input.location);
            }
        }
    }
    assert_eq!(read.len(), VERTEX_ATTRIBUTES.len(), "an attribute that no shader reads");
}
