//! Bindings and inputs of the shaders, by group, name and number.

use std::collections::{BTreeMap, BTreeSet};

use framegraph_shaders::layout::{OBJECT_ATTRIBUTES, VERTEX_ATTRIBUTES};
use framegraph_shaders::reflect::{BindingKind, Sample, Slot, Stage};
use framegraph_shaders::{Feature, Features, resolve};

use crate::variants::{self, pass};

/// Bindings that stay the same for a whole frame: uniforms, lights, shadow map, environment.
const GROUP_FRAME: usize = 0;
/// The material: factors, textures, samplers.
pub const GROUP_MATERIAL: u32 = 1;
/// The objects: one storage array, indexed by the instance index of the draw.
const GROUP_OBJECTS: usize = 2;

fn color(features: Features) -> Vec<Vec<Slot>> {
    resolve(&pass("color"), &features, &[]).unwrap().reflection.groups(&["vs_main", "fs_main"])
}

/// Passes offer resources by name, so a name must mean the same kind everywhere.
#[test]
fn one_name_is_one_kind_of_resource_in_all_passes() {
    let mut kinds = BTreeMap::new();
    for variant in &variants::all().0 {
        for binding in variant.shader.reflection.entry_points.iter().flat_map(|e| &e.bindings) {
            let kind = match binding.kind {
                // Filtering of a texture depends on the entry point.
                BindingKind::Texture { dimension, multisampled, .. } => format!("{dimension:?} {multisampled}"),
                kind => format!("{kind:?}"),
            };
            let before = kinds.insert(binding.name.clone(), kind.clone());
            assert!(before.is_none_or(|before| before == kind), "{} of {}", binding.name, variant.name());
        }
    }
    assert!(kinds.len() > 50, "only {} resources were found", kinds.len());
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
    assert_eq!(color(Feature::all().collect()).len(), 2, "instances bring their objects along");
    let groups = color(Feature::all().filter(|feature| *feature != Feature::INSTANCE_STREAM).collect());
    let names = |group: usize| -> Vec<&str> { groups[group].iter().map(|slot| slot.binding.name.as_str()).collect() };
    assert_eq!(groups.len(), 3);
    assert!(names(GROUP_FRAME).contains(&"frame") && names(GROUP_FRAME).contains(&"lights"));
    assert_eq!(names(GROUP_OBJECTS), ["objects", "origins"]);

    let frame = &groups[GROUP_FRAME][0];
    assert!(frame.vertex && frame.fragment && !frame.compute);
    let is_of_vertices = groups[GROUP_OBJECTS].iter().all(|slot| slot.vertex && !slot.fragment);
    assert!(is_of_vertices, "the fragment stage reads no objects");
}

/// Slot i of a material has its texture at 1 + 2i and its sampler at 2 + 2i, so that a new one renumbers no other.
#[test]
fn textures_of_the_material_are_followed_by_their_samplers() {
    let groups = color(Feature::all().collect());
    let [material, slots @ ..] = groups[GROUP_MATERIAL as usize].as_slice() else { panic!("nothing is bound") };
    assert_eq!((material.binding.binding, material.binding.name.as_str()), (0, "materials"));
    for (slot, pair) in slots.chunks(2).enumerate() {
        let [texture, sampler] = [&pair[0].binding, &pair[1].binding];
        assert_eq!([texture.binding, sampler.binding], [1 + 2 * slot as u32, 2 + 2 * slot as u32]);
        let name = texture.name.strip_suffix("_texture");
        assert_eq!(name, sampler.name.strip_suffix("_sampler"));
        assert!(name.is_some() && sampler.kind == BindingKind::Sampler { comparison: false });
    }
}

/// WebGPU's default limits, 16 sampled textures and 16 samplers a stage, hold every lobe by itself, and the two that bind
/// most together.
#[test]
fn surfaces_with_one_or_two_lobes_fit_every_device() {
    for first in Feature::LOBES {
        for second in Feature::LOBES {
            let features = [Feature::SHADOWS, Feature::OCCLUSION_UPSAMPLED, Feature::ENVIRONMENT_MAP, *first, *second]
                .into_iter()
                .collect();
            let groups = color(features);
            let count = |is: fn(&BindingKind) -> bool| {
                groups.iter().flatten().filter(|slot| slot.fragment && is(&slot.binding.kind)).count()
            };
            assert!(count(|kind| matches!(kind, BindingKind::Texture { .. })) <= 16, "{first:?} {second:?}");
            assert!(count(|kind| matches!(kind, BindingKind::Sampler { .. })) <= 16, "{first:?} {second:?}");
        }
    }
}

#[test]
fn features_add_what_they_bind_and_lobes_add_to_the_material() {
    let bound = |features| -> BTreeSet<(u32, String)> {
        let slots = color(features).into_iter().flatten();
        slots.map(|slot| (slot.binding.group, slot.binding.name)).collect()
    };
    let plain = bound(Features::NONE);
    let added = |feature| -> Vec<(u32, String)> {
        let with = bound(Features::NONE.with(feature));
        assert!(with.is_superset(&plain), "{}", feature.name());
        with.difference(&plain).cloned().collect()
    };
    let of_frame = |names: &[&str]| -> Vec<(u32, String)> { names.iter().map(|n| (0, (*n).to_owned())).collect() };
    let depth = ["local_maps", "shadow", "shadow_map", "shadow_sampler"];
    assert_eq!(added(Feature::SHADOWS), of_frame(&depth));
    assert_eq!(
        added(Feature::SHADOW_SOFT),
        of_frame(&["local_maps", "shadow", "shadow_depth", "shadow_map", "shadow_sampler"])
    );
    assert_eq!(added(Feature::CONTACT_SHADOWS), of_frame(&["contact_depth", "shadow"]));
    assert_eq!(added(Feature::SHADOW_MOMENTS), of_frame(&["local_maps", "shadow", "shadow_moments"]));
    // The cube shares the sampler of the table.
    assert_eq!(added(Feature::ENVIRONMENT_MAP), of_frame(&["specular_map"]));
    assert_eq!(added(Feature::AMBIENT_OCCLUSION), of_frame(&["ambient_occlusion"]));
    assert_eq!(added(Feature::OCCLUSION_UPSAMPLED), of_frame(&["ambient_occlusion", "structure"]));
    assert_eq!(added(Feature::FROXELS), of_frame(&["froxels", "light_lists"]));
    assert_eq!(added(Feature::HALF), []);
    for lobe in Feature::LOBES {
        let (frame, material): (Vec<_>, Vec<_>) = added(*lobe).into_iter().partition(|(group, _)| *group == 0);
        // These are numbers alone.
        let numbers = [Feature::DISPERSION, Feature::SUBSURFACE, Feature::CLOTH_SUBSURFACE];
        assert_eq!(material.is_empty(), numbers.contains(lobe), "{}", lobe.name());
        assert!(material.iter().all(|(group, _)| *group == GROUP_MATERIAL), "{}", lobe.name());
        let behind: &[&str] = if *lobe == Feature::TRANSMISSION { &["scene_levels", "scene_sampler"] } else { &[] };
        assert_eq!(frame, of_frame(behind), "{}", lobe.name());
    }
}

#[test]
fn a_texture_that_is_only_loaded_need_not_be_filterable() {
    let kind = |of: &str, entry: &str, name: &str| {
        let shader = resolve(&pass(of), &Features::NONE, &[]).unwrap();
        let entry = shader.reflection.entry_point(entry).unwrap().clone();
        entry.bindings.into_iter().find(|b| b.name == name).unwrap().kind
    };
    let filterable = |kind| match kind {
        BindingKind::Texture { sample: Sample::Float { filterable }, .. } => filterable,
        other => panic!("{other:?}"),
    };
    assert!(!filterable(kind("post", "fs_main", "hdr")));
    assert!(!filterable(kind("copy", "fs_copy", "source")));
    assert!(filterable(kind("copy", "fs_blit", "source")));
    assert!(filterable(kind("fxaa", "fs_main", "ldr")));
}

#[test]
fn vertex_stages_read_what_the_vertex_format_stores() {
    let mut read = BTreeSet::new();
    for variant in &variants::all().0 {
        for entry in &variant.shader.reflection.entry_points {
            assert!(entry.stage == Stage::Vertex || entry.vertex_inputs.is_empty());
            for input in &entry.vertex_inputs {
                let stored = VERTEX_ATTRIBUTES.iter().chain(&OBJECT_ATTRIBUTES).find(|a| a.location == input.location);
                let stored = stored.unwrap_or_else(|| panic!("{} {input:?}", variant.name()));
                assert_eq!(stored.format.components(), input.components);
                read.insert(input.location);
            }
        }
    }
    // The number of the object is in both.
    assert_eq!(read.len(), VERTEX_ATTRIBUTES.len() + OBJECT_ATTRIBUTES.len() - 1, "an attribute that no shader reads");
}
