//! Comparison of the structs with naga's layout of the WGSL structs of the same name.

use std::collections::BTreeMap;

use super::{
    LightUniforms, Punctual, ToneMap, frame, froxel, grading, ibl, light, material, motion, object, occlusion, post,
    reflection, shadow, sharpen, sky, taa,
};
use crate::reflect::StructLayout;
use crate::{Effect, Feature, layout, library, resolve};

fn rust_structs() -> Vec<StructLayout> {
    let files =
        [frame::layouts(), froxel::layouts(), light::layouts(), object::layouts(), material::layouts(), sky::layouts()];
    let of_passes = [post::layouts(), grading::layouts(), ibl::layouts(), occlusion::layouts(), shadow::layouts()];
    files
        .into_iter()
        .chain(of_passes)
        .chain([reflection::layouts(), taa::layouts(), sharpen::layouts(), motion::layouts()])
        .chain([super::fog::layouts(), super::bloom::layouts(), super::dof::layouts()])
        .flatten()
        .collect()
}

/// Returns the structs of all passes with all features and effects; each name must have one layout.
fn wgsl_structs() -> BTreeMap<String, StructLayout> {
    let effects = library::SOURCES.iter().filter_map(|source| {
        let name = source.path.strip_prefix("effect/")?.strip_suffix(".wgsl")?;
        Some(Effect { name, wgsl: source.wgsl })
    });
    let effects: Vec<Effect<'_>> = effects.collect();
    let mut structs: BTreeMap<String, StructLayout> = BTreeMap::new();
    for pass in library::passes() {
        let effects = if pass.wgsl.contains("epilogue(") { effects.as_slice() } else { &[] };
        // Without INSTANCE_STREAM, objects are read from buffers.
        let without = Feature::all().filter(|feature| *feature != Feature::INSTANCE_STREAM).collect();
        for features in [Feature::all().chain([Feature::STEREO]).collect(), without] {
            for found in resolve(&pass, &features, effects).unwrap().reflection.structs {
                if let Some(before) = structs.insert(found.name.clone(), found.clone()) {
                    assert_eq!(before, found, "two passes disagree");
                }
            }
        }
    }
    structs
}

#[test]
fn every_struct_has_a_partner_with_the_same_layout() {
    let wgsl = wgsl_structs();
    let rust: BTreeMap<String, StructLayout> =
        rust_structs().into_iter().map(|layout| (layout.name.clone(), layout)).collect();
    assert!(!wgsl.is_empty(), "no struct was found");
    let names = |map: &BTreeMap<String, StructLayout>| map.keys().cloned().collect::<Vec<_>>();
    assert_eq!(names(&rust), names(&wgsl), "a struct has no partner");
    for (name, layout) in &wgsl {
        assert_eq!(&rust[name], layout, "{name}");
    }
}

#[test]
fn the_comparison_notices_a_moved_member() {
    let wgsl = wgsl_structs();
    let mut moved = rust_structs().remove(0);
    assert_eq!(moved, wgsl[&moved.name]);
    moved.members[5].offset_bytes += 4;
    assert_ne!(moved, wgsl[&moved.name]);
}

#[test]
fn element_and_uniform_sizes_are_multiples_of_16() {
    // Uniform structs are read in rows of 16 bytes; storage arrays have the stride of their element.
    for layout in wgsl_structs().values() {
        assert_eq!(layout.size_bytes % 16, 0, "{}", layout.name);
    }
}

/// Returns the value of a `const NAME: u32 = …u;` in an embedded file.
fn constant(path: &str, name: &str) -> u32 {
    let text = library::text(path).unwrap();
    let from = format!("const {name}: u32 = ");
    let at = text.find(&from).unwrap_or_else(|| panic!("{name} is not in {path}"));
    let rest = &text[at + from.len()..];
    rest[..rest.find('u').unwrap()].parse().unwrap()
}

#[test]
fn constants_have_the_same_values_on_both_sides() {
    for curve in ToneMap::ALL {
        let name = curve.name().to_uppercase().replace('-', "_");
        let value = constant("lib/tone_map.wgsl", &format!("TONE_MAP_{name}"));
        assert_eq!(Some(value), curve.number());
        assert_eq!(ToneMap::from_name(curve.name()), Some(curve));
    }
    let slots = constant("interface/material.wgsl", "SLOT_COUNT");
    assert_eq!(slots, layout::MATERIAL_SLOTS);
    // Trait bits are sums with the number of texture slots.
    let material = |name: &str| {
        let text = library::text("interface/material.wgsl").unwrap();
        let from = format!("const {name}: u32 = SLOT_COUNT + ");
        let rest = &text[text.find(&from).unwrap_or_else(|| panic!("{name} is not there")) + from.len()..];
        slots + rest[..rest.find('u').unwrap()].parse::<u32>().unwrap()
    };
    assert_eq!(material("TRAIT_EMITS"), layout::TRAIT_EMITS);
    assert_eq!(material("TRAIT_DOUBLE_SIDED"), layout::TRAIT_DOUBLE_SIDED);
    assert_eq!(material("TRAIT_UNLIT"), layout::TRAIT_UNLIT);
    assert_eq!(material("TRAIT_PLAIN_UV"), layout::TRAIT_PLAIN_UV);
    assert_eq!(material("TRAIT_PACKED_OCCLUSION"), layout::TRAIT_PACKED_OCCLUSION);
    assert_eq!(material("TRAIT_NO_AREA"), layout::TRAIT_NO_AREA);
    assert_eq!(material("TRAIT_COAT_KEEPS_F0"), layout::TRAIT_COAT_KEEPS_F0);
    assert_eq!(material("TRAIT_SHADOW_CATCHER"), layout::TRAIT_SHADOW_CATCHER);

    use glam::Vec3;
    let kind = |shape| LightUniforms::punctual(shape, Vec3::ONE, 1.0, 1.0).unwrap().kind;
    let light = |name| constant("interface/frame.wgsl", name);
    let (position, direction) = (Vec3::ZERO, Vec3::X);
    assert_eq!(light("LIGHT_DIRECTIONAL"), kind(Punctual::Directional { direction }));
    assert_eq!(light("LIGHT_POINT"), kind(Punctual::Point { position, range_m: None }));
    let spot = Punctual::Spot { position, direction, range_m: None, inner_cone_rad: 0.1, outer_cone_rad: 0.2 };
    assert_eq!(light("LIGHT_SPOT"), kind(spot));
}

#[test]
fn defaults_of_the_overrides_are_the_defaults_of_the_settings() {
    let tone = Effect { name: "tone", wgsl: library::text("effect/tone.wgsl").unwrap() };
    let post = library::pass("pass/post.wgsl").unwrap();
    let post = resolve(&post, &crate::Features::NONE, &[tone]).unwrap();
    let color = resolve(&library::pass("pass/color.wgsl").unwrap(), &crate::Features::NONE, &[]).unwrap();
    let traits = color.reflection.overrides.iter().find(|o| o.name == "MATERIAL_TRAITS").unwrap();
    assert_eq!(traits.default, Some(f64::from((1_u32 << layout::TRAIT_UNLIT) - 1)), "every texture, and that it emits");
    let tone_map = post.reflection.overrides.iter().find(|o| o.name == "TONE_MAP").unwrap();
    assert_eq!(tone_map.default, ToneMap::default().number().map(f64::from));
}

/// Verifies the default fade against Filament's `VignetteOptions`: 0.5 for every parameter, fading to black.
#[test]
fn the_usual_fade_is_filaments() {
    let layout::EdgeFade { middle, roundness, feather, color, multiple_px } = layout::EdgeFade::DEFAULT;
    assert_eq!(([middle, roundness, feather], color, multiple_px), ([0.5; 3], [0.0; 3], 1));
}
