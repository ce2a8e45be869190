//! Conversion of a material to shader data: binding names, shader features, uniforms.

use framegraph_scene::material::{
    AlphaMode, EmissiveUnit, Lobe, Lobes, Material, SLOT_COUNT, Subsurface, TransparencyMode,
};
use framegraph_scene::texture::{TextureSlot, UvTransform};
use framegraph_shaders::layout::{
    AnisotropyUniforms, ClearCoatUniforms, DiffuseTransmissionUniforms, IridescenceUniforms, MATERIAL_SLOTS,
    MaterialUniforms, SheenUniforms, SpecularUniforms, SubsurfaceUniforms, TRAIT_COAT_KEEPS_F0, TRAIT_DOUBLE_SIDED,
    TRAIT_EMITS, TRAIT_PACKED_OCCLUSION, TRAIT_PLAIN_UV, TRAIT_SHADOW_CATCHER, TRAIT_UNLIT, TextureMap,
    TransmissionUniforms,
};
use framegraph_shaders::{Feature, Features};
use glam::{Vec2, Vec3};

// The bits of traits follow those of the slots.
const _: () = assert!(SLOT_COUNT == MATERIAL_SLOTS as usize);

/// Variable names of `wgsl/interface/material.wgsl` and of the lobe files next to it.
///
/// [`GpuScene::material_binding`](super::GpuScene::material_binding) uses this order: the uniforms, a texture and a
/// sampler for each of [`Material::slots`], and the array of all uniforms.
pub const MATERIAL_BINDINGS: [&str; 2 + 2 * SLOT_COUNT] = [
    "material",
    "base_color_texture",
    "base_color_sampler",
    "metallic_roughness_texture",
    "metallic_roughness_sampler",
    "normal_texture",
    "normal_sampler",
    "occlusion_texture",
    "occlusion_sampler",
    "emissive_texture",
    "emissive_sampler",
    "clear_coat_texture",
    "clear_coat_sampler",
    "clear_coat_roughness_texture",
    "clear_coat_roughness_sampler",
    "clear_coat_normal_texture",
    "clear_coat_normal_sampler",
    "sheen_color_texture",
    "sheen_color_sampler",
    "sheen_roughness_texture",
    "sheen_roughness_sampler",
    "anisotropy_texture",
    "anisotropy_sampler",
    "transmission_texture",
    "transmission_sampler",
    "thickness_texture",
    "thickness_sampler",
    "specular_texture",
    "specular_sampler",
    "specular_color_texture",
    "specular_color_sampler",
    "iridescence_texture",
    "iridescence_sampler",
    "iridescence_thickness_texture",
    "iridescence_thickness_sampler",
    "diffuse_transmission_texture",
    "diffuse_transmission_sampler",
    "diffuse_transmission_color_texture",
    "diffuse_transmission_color_sampler",
    "materials",
];

/// Returns the shader features that a material's lobes need.
pub fn features_of(lobes: Lobes) -> Features {
    let feature = |lobe| match lobe {
        Lobe::ClearCoat => Feature::CLEAR_COAT,
        Lobe::Sheen => Feature::SHEEN,
        Lobe::Anisotropy => Feature::ANISOTROPY,
        Lobe::Transmission => Feature::TRANSMISSION,
        Lobe::Specular => Feature::SPECULAR,
        Lobe::Iridescence => Feature::IRIDESCENCE,
        Lobe::Dispersion => Feature::DISPERSION,
        Lobe::DiffuseTransmission => Feature::DIFFUSE_TRANSMISSION,
        Lobe::Subsurface => Feature::SUBSURFACE,
        Lobe::ClothSubsurface => Feature::CLOTH_SUBSURFACE,
    };
    lobes.iter().map(feature).collect()
}

/// Texture bits of [`material_traits`].
pub const TEXTURE_TRAITS: u32 = (1 << SLOT_COUNT) - 1;

/// Returns the [`material_traits`] of an updated material that keeps its textures.
pub(super) fn traits_with_textures_of(before: u32, material: &Material) -> u32 {
    let (new, packed) = (material_traits(material), 1 << TRAIT_PACKED_OCCLUSION);
    before & TEXTURE_TRAITS | new & !(TEXTURE_TRAITS | packed) | before & new & packed
}

/// Returns the traits of a material, for the shader constant `MATERIAL_TRAITS`: one bit for each texture of its
/// [slots](Material::slots), and the bits `layout::TRAIT_*`.
#[must_use]
pub fn material_traits(material: &Material) -> u32 {
    let slots = material.slots();
    let textures = slots.map(|slot| slot.is_some()).into_iter().zip(0..);
    let plain = |slot: &TextureSlot| slot.uv_set == 0 && slot.transform == UvTransform::default();
    let packed =
        material.occlusion_texture.is_some() && material.occlusion_texture == material.metallic_roughness_texture;
    let two_sides = material.alpha == AlphaMode::Blend && material.transparency == TransparencyMode::TwoPassesTwoSides;
    let others = [
        (material.emissive != Vec3::ZERO, TRAIT_EMITS),
        (material.double_sided || two_sides, TRAIT_DOUBLE_SIDED),
        (material.unlit, TRAIT_UNLIT),
        (slots.iter().any(Option::is_some) && slots.iter().flatten().all(plain), TRAIT_PLAIN_UV),
        (packed, TRAIT_PACKED_OCCLUSION),
        (material.clear_coat.is_some_and(|coat| coat.keeps_base_f0), TRAIT_COAT_KEEPS_F0),
        (material.catches_shadows(), TRAIT_SHADOW_CATCHER),
    ];
    textures.chain(others).filter(|(is, _)| *is).map(|(_, bit)| 1 << bit).sum()
}

/// Returns the uniforms of a material: its factors and texture mappings.
#[must_use]
pub fn material_uniforms(material: &Material) -> MaterialUniforms {
    let map = |slot: Option<TextureSlot>| {
        slot.map_or(TextureMap::IDENTITY, |slot| {
            let transform = slot.transform;
            TextureMap::new(slot.uv_set, transform.offset, transform.rotation_rad, transform.scale)
        })
    };
    MaterialUniforms {
        base_color: material.base_color,
        emissive: material.emissive,
        emissive_exposure_weight: match material.emissive_unit {
            EmissiveUnit::Nits => 1.0,
            EmissiveUnit::Display => 0.0,
        },
        metallic: material.metallic,
        roughness: material.roughness,
        normal_scale: material.normal_scale,
        occlusion_strength: material.occlusion_strength,
        alpha_cutoff: match material.alpha {
            AlphaMode::Mask { cutoff } => cutoff,
            AlphaMode::Opaque | AlphaMode::Blend => 0.0,
        },
        dielectric_f0: material.dielectric_f0(),
        catcher_strength: material.shadow_catcher.map_or(1.0, |strength| strength.clamp(0.0, 1.0)),
        base_color_map: map(material.base_color_texture),
        metallic_roughness_map: map(material.metallic_roughness_texture),
        normal_map: map(material.normal_texture),
        occlusion_map: map(material.occlusion_texture),
        emissive_map: map(material.emissive_texture),
        clear_coat: material.clear_coat.map_or_else(Default::default, |coat| ClearCoatUniforms {
            factor: coat.factor,
            roughness: coat.roughness,
            normal_scale: coat.normal_scale,
            _pad: 0,
            map: map(coat.texture),
            roughness_map: map(coat.roughness_texture),
            normal_map: map(coat.normal_texture),
        }),
        sheen: material.sheen.map_or_else(Default::default, |sheen| SheenUniforms {
            color: sheen.color,
            roughness: sheen.roughness,
            color_map: map(sheen.color_texture),
            roughness_map: map(sheen.roughness_texture),
        }),
        anisotropy: material.anisotropy.map_or_else(Default::default, |anisotropy| AnisotropyUniforms {
            rotation: Vec2::from_angle(anisotropy.rotation_rad),
            strength: anisotropy.strength,
            _pad: 0,
            map: map(anisotropy.texture),
        }),
        transmission: transmission_uniforms(material, map),
        specular: material.specular.map_or_else(Default::default, |specular| SpecularUniforms {
            color: specular.color,
            factor: specular.factor,
            map: map(specular.texture),
            color_map: map(specular.color_texture),
        }),
        iridescence: material.iridescence.map_or_else(Default::default, |film| IridescenceUniforms {
            factor: film.factor,
            ior: film.ior,
            min_thickness_nm: film.min_thickness_nm,
            max_thickness_nm: film.max_thickness_nm,
            map: map(film.texture),
            thickness_map: map(film.thickness_texture),
        }),
        diffuse_transmission: material.diffuse_transmission.map_or_else(Default::default, |scattered| {
            DiffuseTransmissionUniforms {
                color: scattered.color,
                factor: scattered.factor,
                map: map(scattered.texture),
                color_map: map(scattered.color_texture),
            }
        }),
        subsurface: subsurface_uniforms(material),
        ..MaterialUniforms::default()
    }
}

/// Returns the subsurface scattering parameters, clamped to the ranges of the shaders.
fn subsurface_uniforms(material: &Material) -> SubsurfaceUniforms {
    let Subsurface { color, power, thickness } = material.subsurface.unwrap_or_default();
    SubsurfaceUniforms {
        color: color.clamp(Vec3::ZERO, Vec3::ONE),
        power: power.clamp(0.0, Subsurface::MAX_POWER),
        cloth_color: material.cloth_subsurface.unwrap_or(Vec3::ONE).clamp(Vec3::ZERO, Vec3::ONE),
        thickness: thickness.clamp(0.0, 1.0),
    }
}

/// Returns the uniforms of a refractive volume or, without one, of a thin wall that neither refracts nor absorbs
/// light. Diffuse transmission uses the same volume.
fn transmission_uniforms(material: &Material, map: impl Fn(Option<TextureSlot>) -> TextureMap) -> TransmissionUniforms {
    let wall = material.transmission.map_or_else(Default::default, |transmission| TransmissionUniforms {
        factor: transmission.factor,
        ior: material.ior.max(1.0),
        dispersion: material.dispersion.unwrap_or(0.0),
        map: map(transmission.texture),
        ..TransmissionUniforms::default()
    });
    material.volume().map_or(wall, |volume| TransmissionUniforms {
        thickness: volume.thickness,
        absorption: volume.absorption_per_m(),
        thickness_map: map(volume.thickness_texture),
        ..wall
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use framegraph_scene::TextureId;
    use framegraph_scene::material::{
        Anisotropy, ClearCoat, DiffuseTransmission, Iridescence, Sheen, Specular, Transmission, Volume,
    };
    use glam::Mat3;

    /// Scene and shaders both implement KHR_texture_transform, and must agree.
    #[test]
    fn texture_transforms_agree_with_the_scenes() {
        let transform = UvTransform { offset: Vec2::new(0.3, -0.2), rotation_rad: 0.7, scale: Vec2::new(2.0, 0.5) };
        let material = Material {
            normal_texture: Some(TextureSlot { texture: TextureId::new(0), uv_set: 1, transform }),
            alpha: AlphaMode::Mask { cutoff: 0.3 },
            unlit: true,
            emissive: Vec3::splat(7.0),
            emissive_unit: EmissiveUnit::Nits,
            ..Material::default()
        };
        let packed = material_uniforms(&material);
        let map = packed.normal_map;
        assert_eq!(map.uv_set, 1);
        let columns = Mat3::from_cols(map.x_axis.extend(0.0), map.y_axis.extend(0.0), map.offset.extend(1.0));
        assert!(columns.abs_diff_eq(transform.matrix(), 1e-6));
        assert_eq!(packed.base_color_map, TextureMap::IDENTITY);
        assert_eq!(material_traits(&material), 1 << 2 | 1 << TRAIT_EMITS | 1 << TRAIT_UNLIT);
        assert_eq!((packed.alpha_cutoff, packed.metallic, packed.emissive_exposure_weight), (0.3, 1.0, 1.0));
        assert!((packed.dielectric_f0 - 0.04).abs() < 1e-7);
    }

    #[test]
    fn textures_that_are_looked_up_alike_are_told() {
        let slot =
            |texture| TextureSlot { texture: TextureId::new(texture), uv_set: 0, transform: UvTransform::default() };
        let moved = UvTransform { offset: Vec2::X, ..UvTransform::default() };
        let traits = |rough, occlusion| {
            let bits = material_traits(&Material {
                metallic_roughness_texture: rough,
                occlusion_texture: occlusion,
                ..Material::default()
            });
            [TRAIT_PLAIN_UV, TRAIT_PACKED_OCCLUSION].map(|bit| bits & 1 << bit != 0)
        };
        assert_eq!(traits(None, None), [false, false]);
        assert_eq!(traits(Some(slot(0)), None), [true, false]);
        assert_eq!(traits(Some(slot(0)), Some(slot(1))), [true, false]);
        assert_eq!(traits(Some(slot(0)), Some(slot(0))), [true, true]);
        let (turned, second) = (TextureSlot { transform: moved, ..slot(0) }, TextureSlot { uv_set: 1, ..slot(0) });
        for other in [turned, second] {
            assert_eq!(traits(Some(slot(0)), Some(other)), [false, false]);
            assert_eq!(traits(Some(other), Some(other)), [false, true]);
        }
        // An update may use fewer textures, but not others.
        let both = |rough, occlusion| Material {
            metallic_roughness_texture: rough,
            occlusion_texture: occlusion,
            ..Material::default()
        };
        let (packed, apart) = (both(Some(slot(0)), Some(slot(0))), both(Some(slot(0)), Some(turned)));
        let has =
            |before, now| traits_with_textures_of(material_traits(before), now) & 1 << TRAIT_PACKED_OCCLUSION != 0;
        assert!(has(&packed, &packed) && !has(&packed, &apart) && !has(&apart, &packed));
    }

    /// The factors and texture slots of a lobe, distinguished by their offsets, are packed where shaders read them.
    #[test]
    fn lobes_are_packed_factor_by_factor_and_slot_by_slot() {
        let slot = |x: f32| {
            let transform = UvTransform { offset: Vec2::new(x, 0.0), ..UvTransform::default() };
            Some(TextureSlot { texture: TextureId::new(0), uv_set: 1, transform })
        };
        let material = Material {
            ior: 1.33,
            clear_coat: Some(ClearCoat {
                factor: 0.75,
                roughness: 0.25,
                normal_scale: 0.5,
                texture: slot(1.0),
                roughness_texture: slot(2.0),
                normal_texture: slot(3.0),
                keeps_base_f0: true,
            }),
            sheen: Some(Sheen {
                color: Vec3::new(0.5, 0.25, 0.125),
                roughness: 0.75,
                color_texture: slot(4.0),
                roughness_texture: slot(5.0),
            }),
            anisotropy: Some(Anisotropy { strength: 0.5, rotation_rad: 2.0, texture: slot(6.0) }),
            transmission: Some(Transmission {
                factor: 0.75,
                texture: slot(7.0),
                volume: Some(Volume {
                    thickness: 2.0,
                    thickness_texture: slot(8.0),
                    attenuation_color: Vec3::new(0.5, 0.25, 1.0),
                    attenuation_distance_m: 0.5,
                }),
            }),
            specular: Some(Specular {
                factor: 0.5,
                color: Vec3::new(2.0, 1.0, 0.5),
                texture: slot(9.0),
                color_texture: slot(10.0),
            }),
            dispersion: Some(0.5),
            iridescence: Some(Iridescence {
                factor: 0.75,
                texture: slot(11.0),
                ior: 1.25,
                min_thickness_nm: 150.0,
                max_thickness_nm: 250.0,
                thickness_texture: slot(12.0),
            }),
            diffuse_transmission: Some(DiffuseTransmission {
                factor: 0.25,
                texture: slot(13.0),
                color: Vec3::new(0.5, 0.25, 0.125),
                color_texture: slot(14.0),
                volume: None,
            }),
            subsurface: Some(Subsurface { color: Vec3::splat(2.0), power: 3.0, thickness: 0.25 }),
            cloth_subsurface: Some(Vec3::new(0.5, 0.25, 0.125)),
            ..Material::default()
        };
        let SubsurfaceUniforms { color, power, cloth_color, thickness } = material_uniforms(&material).subsurface;
        assert_eq!((color, power, thickness, cloth_color.y), (Vec3::ONE, 3.0, 0.25, 0.25));
        assert_eq!(material_traits(&material) >> SLOT_COUNT, 1 << (TRAIT_COAT_KEEPS_F0 - MATERIAL_SLOTS));
        let MaterialUniforms {
            clear_coat,
            sheen,
            anisotropy,
            transmission,
            specular,
            iridescence: film,
            diffuse_transmission: scattered,
            ..
        } = material_uniforms(&material);
        assert_eq!((clear_coat.factor, clear_coat.roughness, clear_coat.normal_scale), (0.75, 0.25, 0.5));
        assert_eq!((sheen.color, sheen.roughness), (Vec3::new(0.5, 0.25, 0.125), 0.75));
        assert_eq!((anisotropy.rotation, anisotropy.strength), (Vec2::from_angle(2.0), 0.5));
        assert_eq!((transmission.factor, transmission.ior, transmission.thickness), (0.75, 1.33, 2.0));
        // Negative logarithm of the attenuation color, divided by its distance.
        let absorption = Vec3::new(2.0, 4.0, 0.0) * std::f32::consts::LN_2;
        assert!((transmission.absorption - absorption).length() < 1e-5);
        assert_eq!((specular.factor, specular.color), (0.5, Vec3::new(2.0, 1.0, 0.5)));
        assert_eq!(transmission.dispersion, 0.5);
        let thickness = (film.min_thickness_nm, film.max_thickness_nm);
        assert_eq!((film.factor, film.ior, thickness), (0.75, 1.25, (150.0, 250.0)));
        assert_eq!((scattered.factor, scattered.color), (0.25, Vec3::new(0.5, 0.25, 0.125)));
        let maps = [
            clear_coat.map,
            clear_coat.roughness_map,
            clear_coat.normal_map,
            sheen.color_map,
            sheen.roughness_map,
            anisotropy.map,
            transmission.map,
            transmission.thickness_map,
            specular.map,
            specular.color_map,
            film.map,
            film.thickness_map,
            scattered.map,
            scattered.color_map,
        ];
        let expected: [f32; 14] = std::array::from_fn(|i| (i + 1) as f32);
        assert_eq!(maps.map(|map| map.offset.x), expected);
        // Without refraction, the volume is that of diffuse transmission.
        let body = material.transmission.and_then(|t| t.volume);
        let wax = DiffuseTransmission { volume: body, ..DiffuseTransmission::default() };
        let wax = Material { transmission: None, diffuse_transmission: Some(wax), ..material.clone() };
        let wax = material_uniforms(&wax).transmission;
        assert_eq!((wax.factor, wax.thickness, wax.absorption), (0.0, transmission.thickness, transmission.absorption));
        let thin = Transmission { volume: None, ..material.transmission.unwrap_or_default() };
        let thin = material_uniforms(&Material { transmission: Some(thin), ..material }).transmission;
        assert_eq!((thin.thickness, thin.absorption), (0.0, Vec3::ZERO));
    }
}
