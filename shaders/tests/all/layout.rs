//! Rust structs against naga's layout of the WGSL structs of the same name.

use std::collections::BTreeMap;
use std::mem::{offset_of, size_of};

use framegraph_shaders::layout::{
    AnisotropyUniforms, ClearCoatUniforms, EncodingUniforms, ExposureUniforms, FrameUniforms, FxaaUniforms,
    GradingUniforms, IblKernelUniforms, IblUniforms, LightUniforms, MaterialUniforms, ObjectUniforms,
    ShadowViewUniforms, SheenUniforms, SkyUniforms, SpecularUniforms, TextureMap, ToneMap, TransmissionUniforms,
    VignetteUniforms,
};
use framegraph_shaders::reflect::{Member, StructLayout};
use framegraph_shaders::{layout, library};

use crate::variants;

/// Size of a field without naming its type.
const fn size_of_field<S, F>(_: fn(&S) -> &F) -> u32 {
    size_of::<F>() as u32
}

/// The layout of a Rust struct, given all its fields. A macro because only one can name
/// fields; the pattern without `..` refuses to compile when a field is left out.
macro_rules! layout_of {
    ($name:ident { $($field:ident),* $(,)? }) => {{
        let _complete = |value: $name| {
            let $name { $($field: _),* } = value;
        };
        StructLayout {
            name: stringify!($name).to_owned(),
            size_bytes: size_of::<$name>() as u32,
            members: [$(Member {
                name: stringify!($field).to_owned(),
                offset_bytes: offset_of!($name, $field) as u32,
                size_bytes: size_of_field(|value: &$name| &value.$field),
            }),*]
            .into_iter()
            .filter(|member| !member.name.starts_with("_pad"))
            .collect(),
        }
    }};
}

fn rust_structs() -> Vec<StructLayout> {
    vec![
        layout_of!(FrameUniforms {
            clip_from_world,
            world_from_clip,
            world_from_view,
            shadow_clip_from_world,
            camera,
            sun_direction,
            sun_angular_radius,
            sun_illuminance,
            exposure,
            viewport_size_px,
            shadow_texel_uv,
            shadow_texel_m,
            shadow_normal_bias_texels,
            environment_rotation,
            environment_scale,
            light_count,
            frame_index,
            time_s,
            specular_scale,
            roughness_one_lod,
            _pad,
            sh,
        }),
        layout_of!(ShadowViewUniforms { clip_from_world }),
        layout_of!(LightUniforms { position, inv_range2, intensity, kind, direction, spot_scale, spot_offset, _pad }),
        layout_of!(ObjectUniforms {
            world_from_model,
            normal_column_x,
            handedness,
            normal_column_y,
            _pad0,
            normal_column_z,
            _pad1,
        }),
        layout_of!(TextureMap { x_axis, y_axis, offset, uv_set, present }),
        layout_of!(MaterialUniforms {
            base_color,
            emissive,
            emissive_exposure_weight,
            metallic,
            roughness,
            normal_scale,
            occlusion_strength,
            alpha_cutoff,
            dielectric_f0,
            flags,
            _pad,
            base_color_map,
            metallic_roughness_map,
            normal_map,
            occlusion_map,
            emissive_map,
            clear_coat,
            sheen,
            anisotropy,
            transmission,
            specular,
        }),
        layout_of!(ClearCoatUniforms { factor, roughness, normal_scale, _pad, map, roughness_map, normal_map }),
        layout_of!(SheenUniforms { color, roughness, color_map, roughness_map }),
        layout_of!(AnisotropyUniforms { rotation, strength, _pad, map }),
        layout_of!(TransmissionUniforms { factor, ior, thickness, _pad0, absorption, _pad1, map, thickness_map }),
        layout_of!(SpecularUniforms { color, factor, map, color_map }),
        layout_of!(SkyUniforms { perez, zenith, sun_disc, ground, _pad0, toward_sun, _pad1 }),
        layout_of!(ExposureUniforms { scale, _pad }),
        layout_of!(GradingUniforms { white_balance, slope, contrast, offset, vibrance, power, saturation }),
        layout_of!(VignetteUniforms { centre_px, per_corner_px, falloff }),
        layout_of!(EncodingUniforms { dither, dither_levels, frame_index, _pad }),
        layout_of!(IblUniforms { face, size_texels, samples, scale }),
        layout_of!(IblKernelUniforms { rows }),
        layout_of!(FxaaUniforms { edge_sharpness, edge_threshold, edge_threshold_min, centre_weight }),
    ]
}

/// The structs of all passes in all variants; one name must mean one layout.
fn wgsl_structs() -> BTreeMap<String, StructLayout> {
    let mut structs: BTreeMap<String, StructLayout> = BTreeMap::new();
    for variant in &variants::all().0 {
        for found in &variant.shader.reflection.structs {
            if let Some(before) = structs.insert(found.name.clone(), found.clone()) {
                assert_eq!(before, *found, "two passes disagree");
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
    // Uniform structs are read in rows of 16 bytes, storage arrays step by the element.
    for layout in wgsl_structs().values() {
        assert_eq!(layout.size_bytes % 16, 0, "{}", layout.name);
    }
}

/// Value of a `const NAME: u32 = …u;` in an embedded file.
fn constant(path: &str, name: &str) -> u32 {
    let text = library::text(path).unwrap();
    let from = format!("const {name}: u32 = ");
    let at = text.find(&from).unwrap_or_else(|| panic!("{name} is not in {path}"));
    let rest = &text[at + from.len()..];
    rest[..rest.find('u').unwrap()].parse().unwrap()
}

#[test]
fn constants_have_the_same_values_on_both_sides() {
    let curves = ["LINEAR", "ACES", "FILMIC", "NEUTRAL", "ACES_LEGACY", "LINEAR_2020"];
    assert_eq!(curves.len(), ToneMap::ALL.len());
    for (curve, name) in ToneMap::ALL.into_iter().zip(curves) {
        let value = constant("lib/tone_map.wgsl", &format!("TONE_MAP_{name}"));
        assert_eq!(f64::from(value), curve.constant());
        assert_eq!(curve.name(), name.to_lowercase().replace('_', "-"));
        assert_eq!(ToneMap::from_name(curve.name()), Some(curve));
    }
    let material = |name| constant("interface/material.wgsl", name);
    assert_eq!(material("MATERIAL_UNLIT"), layout::MATERIAL_UNLIT);
    assert_eq!(material("MATERIAL_DOUBLE_SIDED"), layout::MATERIAL_DOUBLE_SIDED);

    use glam::Vec3;
    use layout::Punctual;
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
    let effects = [framegraph_shaders::Effect::TONE];
    let post = framegraph_shaders::resolve_with(
        framegraph_shaders::ShaderId::Post,
        framegraph_shaders::Features::NONE,
        &effects,
    )
    .unwrap();
    let tone_map = post.reflection.overrides.iter().find(|o| o.name == "TONE_MAP").unwrap();
    assert_eq!(tone_map.default, Some(ToneMap::default().constant()));
}
