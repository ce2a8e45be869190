//! Every entry point, resolved as at run time, is valid with nothing but core WGSL, and half floats where asked for.

use framegraph_shaders::reflect::Stage;
use framegraph_shaders::{Features, ShaderId};
use naga::valid::{Capabilities, ValidationFlags, Validator};

use crate::variants;

/// What each pass is expected to offer.
const ENTRY_POINTS: &[(ShaderId, &[&str])] = &[
    (ShaderId::Shadow, &["vs_opaque", "vs_mask", "fs_mask"]),
    (ShaderId::Prepass, &["vs_opaque", "vs_mask", "fs_mask"]),
    (ShaderId::Color, &["vs_main", "fs_main"]),
    (ShaderId::Scene, &["vs_main", "fs_copy", "fs_copy_samples", "fs_level"]),
    (ShaderId::Sky, &["vs_main", "fs_environment", "fs_procedural", "fs_constant", "fs_black"]),
    (ShaderId::Post, &["vs_main", "fs_main"]),
    (ShaderId::Fxaa, &["vs_main", "fs_main"]),
    (ShaderId::Copy, &["vs_main", "fs_copy", "fs_blit"]),
    (ShaderId::Ibl, &["vs_main", "fs_cube", "fs_mip", "fs_prefilter"]),
    (ShaderId::Dfg, &["vs_main", "fs_main"]),
];

#[test]
fn every_entry_point_is_valid_core_wgsl() {
    let (variants, failures) = variants::all();
    let mut failures = failures.clone();
    let mut entry_points = 0;
    for variant in variants {
        let module = naga::front::wgsl::parse_str(&variant.shader.wgsl);
        // `resolve` allows what a device might; here nothing beyond the core is allowed.
        let checked = module.map_err(|e| e.to_string()).and_then(|module| {
            let mut core = Validator::new(ValidationFlags::all(), Capabilities::empty());
            let with = Validator::new(ValidationFlags::all(), variant.capabilities()).validate(&module);
            match core.validate(&module) {
                Ok(_) if variant.in_half() => Err("it is said to use half floats and does not".to_owned()),
                _ => with.map_err(|e| format!("{e:?}")),
            }
        });
        match checked {
            Ok(_) => entry_points += variant.shader.reflection.entry_points.len(),
            Err(error) => failures.push(format!("{}: {error}", variant.name())),
        }
    }
    assert!(failures.is_empty(), "{} failures:\n{}", failures.len(), failures.join("\n"));
    assert!(variants.len() > ShaderId::ALL.len(), "no variants were found");
    assert!(entry_points > variants.len(), "only {entry_points} entry points were found");
}

#[test]
fn the_entry_points_are_the_ones_documented() {
    assert_eq!(ENTRY_POINTS.len(), ShaderId::ALL.len());
    for (id, expected) in ENTRY_POINTS {
        let shader = framegraph_shaders::resolve(*id, Features::NONE).unwrap();
        let found: Vec<&str> = shader.reflection.entry_points.iter().map(|e| e.name.as_str()).collect();
        assert_eq!(found, *expected, "{}", id.path());
    }
}

#[test]
fn resolving_is_deterministic() {
    // Hash maps inside the resolver are seeded anew for every one of these.
    let (first, _) = variants::all();
    for _ in 0..3 {
        let (again, _) = variants::resolve_all();
        for (a, b) in first.iter().zip(&again) {
            assert_eq!(a.shader.wgsl, b.shader.wgsl, "{}", a.name());
            assert_eq!(a.shader.reflection, b.shader.reflection, "{}", a.name());
        }
    }
}

#[test]
fn features_make_a_difference_and_only_where_they_are_declared() {
    for id in ShaderId::ALL {
        let plain = framegraph_shaders::resolve(id, Features::NONE).unwrap();
        for feature in framegraph_shaders::Feature::ALL {
            let with = framegraph_shaders::resolve(id, Features::NONE.with(feature)).unwrap();
            let declared = id.features().contains(&feature);
            assert_eq!(plain.wgsl != with.wgsl, declared, "{} {}", id.path(), feature.name());
        }
    }
}

#[test]
fn effects_make_a_difference_and_only_where_there_is_a_socket() {
    for id in ShaderId::ALL {
        let plain = framegraph_shaders::resolve(id, Features::NONE).unwrap();
        let with = framegraph_shaders::resolve_with(id, Features::NONE, &[framegraph_shaders::Effect::TONE]).unwrap();
        assert_eq!(plain.wgsl != with.wgsl, id.takes_effects(), "{}", id.path());
    }
}

#[test]
fn depth_passes_of_opaque_geometry_read_positions_alone() {
    for id in [ShaderId::Shadow, ShaderId::Prepass] {
        let shader = framegraph_shaders::resolve(id, Features::NONE).unwrap();
        let opaque = shader.reflection.entry_point("vs_opaque").unwrap();
        assert_eq!(opaque.stage, Stage::Vertex);
        assert_eq!(opaque.vertex_inputs.len(), 1);
        assert!(opaque.bindings.iter().all(|b| b.group != framegraph_shaders::bindings::GROUP_MATERIAL));
    }
}

#[test]
fn prepass_and_color_agree_on_the_position() {
    // The same two functions, printed the same, under @invariant outputs.
    let text = |id| framegraph_shaders::resolve(id, Features::NONE).unwrap().wgsl;
    let (prepass, color) = (text(ShaderId::Prepass), text(ShaderId::Color));
    for name in ["fn world_position", "fn clip_position"] {
        let body = |wgsl: &str| {
            let from = wgsl.find(name).unwrap_or_else(|| panic!("{name} is missing"));
            wgsl[from..from + wgsl[from..].find("\n}").unwrap()].to_owned()
        };
        assert_eq!(body(&prepass), body(&color));
    }
    assert_eq!(prepass.matches("@invariant").count(), 2);
    assert_eq!(color.matches("@invariant").count(), 1);
}
