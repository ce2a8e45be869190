//! The scene in the structs that the shaders read: pure functions, no GPU.

use framegraph_shaders::layout::{
    AnisotropyUniforms, ClearCoatUniforms, LightError, LightUniforms, MATERIAL_DOUBLE_SIDED, MATERIAL_UNLIT,
    MaterialUniforms, ObjectUniforms, Punctual, SheenUniforms, SpecularUniforms, TextureMap, TransmissionUniforms,
    VertexAttributes, VertexPosition,
};
use glam::{DVec3, Vec2, Vec3, Vec4};
use half::f16;

use framegraph_scene::Scene;
use framegraph_scene::light::{Light, LightKind};
use framegraph_scene::material::{AlphaMode, EmissiveUnit, Material};
use framegraph_scene::mesh::Mesh;
use framegraph_scene::texture::TextureSlot;

/// The position stream of a mesh, a vertex each.
pub fn vertex_positions(mesh: &Mesh) -> impl Iterator<Item = VertexPosition> + '_ {
    mesh.positions.iter().map(|p| VertexPosition { position: p.to_array() })
}

/// The attribute stream of a mesh, a vertex each. Streams the mesh lacks are absent as the layout
/// has it: white, zero.
pub fn vertex_attributes(mesh: &Mesh) -> impl Iterator<Item = VertexAttributes> + '_ {
    let absent = VertexAttributes::default();
    let of = move |i: usize| VertexAttributes {
        normal: mesh.normals[i].to_array(),
        tangent: mesh.tangents.get(i).map_or(absent.tangent, Vec4::to_array),
        uv0: mesh.uv0.get(i).map_or(absent.uv0, Vec2::to_array),
        uv1: mesh.uv1.get(i).map_or(absent.uv1, Vec2::to_array),
        color: mesh.colors.get(i).map_or(absent.color, |c| c.to_array().map(half_color)),
    };
    (0..mesh.vertex_count()).map(of)
}

/// The largest half float.
const MAX_HALF: f32 = 65504.0;

fn half_color(value: f32) -> f16 {
    f16::from_f32(value.clamp(0.0, MAX_HALF))
}

/// Whether a mesh has colors that its vertex format cuts off.
#[must_use]
pub fn colors_are_cut(mesh: &Mesh) -> bool {
    mesh.colors.iter().any(|c| c.max_element() > MAX_HALF || c.min_element() < 0.0)
}

/// The factors of a material and where its textures lie.
#[must_use]
pub fn material_uniforms(material: &Material) -> MaterialUniforms {
    let flag = |set: bool, bit: u32| if set { bit } else { 0 };
    let map = |slot: Option<TextureSlot>| {
        slot.map_or(TextureMap::ABSENT, |slot| {
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
        flags: flag(material.unlit, MATERIAL_UNLIT) | flag(material.double_sided, MATERIAL_DOUBLE_SIDED),
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
        ..MaterialUniforms::default()
    }
}

/// Of a body or, without a volume, of a wall that bends nothing and absorbs nothing.
fn transmission_uniforms(material: &Material, map: impl Fn(Option<TextureSlot>) -> TextureMap) -> TransmissionUniforms {
    let Some(transmission) = material.transmission else {
        return TransmissionUniforms::default();
    };
    let wall = TransmissionUniforms {
        factor: transmission.factor,
        ior: material.ior.max(1.0),
        map: map(transmission.texture),
        ..TransmissionUniforms::default()
    };
    transmission.volume.map_or(wall, |volume| TransmissionUniforms {
        thickness: volume.thickness,
        absorption: volume.absorption_per_m(),
        thickness_map: map(volume.thickness_texture),
        ..wall
    })
}

/// The placement of every instance, in the scene's order, with `origin` (in meters) as the zero
/// point: the eye for pictures that hold far from the world's origin, zero for plain world space.
pub fn object_uniforms(scene: &Scene, origin: DVec3) -> impl Iterator<Item = ObjectUniforms> + '_ {
    scene.instances.iter().map(move |instance| ObjectUniforms::new(instance.relative_from_model(origin)))
}

/// A light with `origin` as the zero point, multiplied with the exposure (in 1/nits).
///
/// # Errors
///
/// For a light that breaks a promise of [`Light`]; importers make none.
pub fn light_uniforms(light: &Light, origin: DVec3, exposure: f32) -> Result<LightUniforms, LightError> {
    let position: Vec3 = (light.position - origin).as_vec3();
    let direction = light.direction;
    let (shape, strength) = match light.kind {
        LightKind::Directional { illuminance_lux, .. } => (Punctual::Directional { direction }, illuminance_lux),
        LightKind::Point { intensity_candela, range_m } => (Punctual::Point { position, range_m }, intensity_candela),
        LightKind::Spot { intensity_candela, range_m, inner_cone_rad, outer_cone_rad } => {
            (Punctual::Spot { position, direction, range_m, inner_cone_rad, outer_cone_rad }, intensity_candela)
        }
    };
    LightUniforms::punctual(shape, light.color, strength, exposure)
}

#[cfg(test)]
mod tests {
    use glam::{DMat4, Mat3};

    use framegraph_shaders::layout::{VERTEX_ATTRIBUTES, VertexFormat};

    use super::*;
    use framegraph_scene::geometry::cuboid;
    use framegraph_scene::material::{Anisotropy, ClearCoat, Sheen, Specular, Transmission, Volume};
    use framegraph_scene::texture::UvTransform;
    use framegraph_scene::{Aabb, Instance, MaterialId, MeshId, TextureId};

    #[test]
    fn vertices_carry_every_stream_and_absent_ones_are_neutral() {
        let mut mesh = cuboid(Vec3::ONE);
        let attributes: Vec<_> = vertex_attributes(&mesh).collect();
        assert_eq!(attributes.len(), 24);
        assert_eq!(vertex_positions(&mesh).count(), 24);
        assert_eq!(attributes[5].normal, mesh.normals[5].to_array());
        assert_eq!(attributes[5].tangent, mesh.tangents[5].to_array());
        assert_eq!(attributes[5].uv0, mesh.uv0[5].to_array());
        assert_eq!((attributes[5].uv1, attributes[5].color), ([0.0; 2], [f16::ONE; 4]));
        mesh.colors = vec![Vec4::new(0.0, 0.5, 1000.0, 0.25); 24];
        assert!(!colors_are_cut(&mesh));
        let color = vertex_attributes(&mesh).next().map(|a| a.color.map(f16::to_f32));
        assert_eq!(color, Some([0.0, 0.5, 1000.0, 0.25]));
        for (value, stored) in [(1e5, MAX_HALF), (-1.0, 0.0)] {
            mesh.colors[0].y = value;
            assert!(colors_are_cut(&mesh));
            let color = vertex_attributes(&mesh).next().map(|a| a.color[1].to_f32());
            assert_eq!(color, Some(stored));
        }
        // What `half_color` and `colors_are_cut` presume.
        assert_eq!(VERTEX_ATTRIBUTES[5].format, VertexFormat::Float16x4);
    }

    /// Both sides spell KHR_texture_transform out; they must agree.
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
        assert_eq!((map.uv_set, map.present), (1, 1));
        let columns = Mat3::from_cols(map.x_axis.extend(0.0), map.y_axis.extend(0.0), map.offset.extend(1.0));
        assert!(columns.abs_diff_eq(transform.matrix(), 1e-6));
        assert_eq!(packed.base_color_map, TextureMap::ABSENT);
        assert_eq!(packed.flags, MATERIAL_UNLIT);
        assert_eq!((packed.alpha_cutoff, packed.metallic), (0.3, 1.0));
        assert_eq!(packed.emissive_exposure_weight, 1.0);
        assert!((packed.dielectric_f0 - 0.04).abs() < 1e-7);
    }

    /// A lobe's factors and each of its texture slots, told apart by their offsets, are packed where shaders read them.
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
            ..Material::default()
        };
        let MaterialUniforms { clear_coat, sheen, anisotropy, transmission, specular, .. } =
            material_uniforms(&material);
        assert_eq!((clear_coat.factor, clear_coat.roughness, clear_coat.normal_scale), (0.75, 0.25, 0.5));
        assert_eq!((sheen.color, sheen.roughness), (Vec3::new(0.5, 0.25, 0.125), 0.75));
        assert_eq!((anisotropy.rotation, anisotropy.strength), (Vec2::from_angle(2.0), 0.5));
        assert_eq!((transmission.factor, transmission.ior, transmission.thickness), (0.75, 1.33, 2.0));
        // The logarithm of the attenuation color over its distance, with the sign turned.
        let absorption = Vec3::new(2.0, 4.0, 0.0) * std::f32::consts::LN_2;
        assert!((transmission.absorption - absorption).length() < 1e-5);
        assert_eq!((specular.factor, specular.color), (0.5, Vec3::new(2.0, 1.0, 0.5)));
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
        ];
        assert_eq!(maps.map(|map| map.offset.x), [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0, 10.0]);
        let thin = Transmission { volume: None, ..material.transmission.unwrap_or_default() };
        let thin = material_uniforms(&Material { transmission: Some(thin), ..material }).transmission;
        assert_eq!((thin.thickness, thin.absorption), (0.0, Vec3::ZERO));
    }

    #[test]
    fn objects_and_lights_move_with_the_origin() {
        let mut scene = Scene::default();
        let origin = DVec3::new(1e6, 0.0, 0.0);
        let at = origin + DVec3::new(0.25, 1.0, 2.0);
        let id = (MeshId::new(0), MaterialId::new(0));
        let placed = DMat4::from_translation(at);
        scene.instances.push(Instance::new("", id.0, id.1, placed, &Aabb::EMPTY));
        let objects: Vec<_> = object_uniforms(&scene, origin).collect();
        let column = objects[0].world_from_model.w_axis;
        assert_eq!(column.truncate(), Vec3::new(0.25, 1.0, 2.0));
        let light = Light {
            kind: LightKind::Point { intensity_candela: 100.0, range_m: Some(2.0) },
            position: at,
            ..Light::directional("", Vec3::NEG_Y, 0.0)
        };
        let packed = light_uniforms(&light, origin, 0.5).expect("a sound light");
        assert_eq!(packed.position, Vec3::new(0.25, 1.0, 2.0));
        assert_eq!(packed.intensity, Vec3::splat(50.0));
        assert_eq!(packed.inv_range2, 0.25);
    }
}
