//! Conversion of a scene to shader structs: pure functions, no GPU.

use framegraph_shaders::layout::{
    LightError, LightUniforms, ObjectUniforms, Punctual, VertexAttributes, VertexPosition,
};
use glam::{DMat3, DVec3, Mat4, Vec2, Vec3, Vec4};
use half::f16;

use framegraph_scene::Instance;
use framegraph_scene::light::{Light, LightKind};
use framegraph_scene::mesh::Mesh;

/// Returns the position stream of a mesh, one item for each vertex.
pub fn vertex_positions(mesh: &Mesh) -> impl Iterator<Item = VertexPosition> + '_ {
    mesh.positions.iter().map(|p| VertexPosition { position: p.to_array() })
}

/// Returns the attribute stream of a mesh, one item for each vertex. Missing attributes have the default of the
/// layout: white, or zero.
pub fn vertex_attributes(mesh: &Mesh) -> impl Iterator<Item = VertexAttributes> + '_ {
    let absent = VertexAttributes::default();
    let of = move |i: usize| VertexAttributes {
        normal: mesh.normals.get(i).map_or(absent.normal, Vec3::to_array),
        tangent: mesh.tangents.get(i).map_or(absent.tangent, Vec4::to_array),
        uv0: mesh.uv0.get(i).map_or(absent.uv0, Vec2::to_array),
        uv1: mesh.uv1.get(i).map_or(absent.uv1, Vec2::to_array),
        color: mesh.colors.get(i).map_or(absent.color, |c| c.to_array().map(half_color)),
    };
    (0..mesh.vertex_count()).map(of)
}

/// Maximum half float.
const MAX_HALF: f32 = 65504.0;

fn half_color(value: f32) -> f16 {
    f16::from_f32(value.clamp(0.0, MAX_HALF))
}

/// Returns true if a mesh has colors outside the range of its vertex format.
#[must_use]
pub fn colors_are_cut(mesh: &Mesh) -> bool {
    mesh.colors.iter().any(|c| c.max_element() > MAX_HALF || c.min_element() < 0.0)
}

/// Returns the rotation, scale and material of an instance, without a translation.
pub fn object_uniforms(instance: &Instance) -> ObjectUniforms {
    let turned = Mat4::from_mat3(DMat3::from_mat4(instance.world_from_model).as_mat3());
    ObjectUniforms { material: instance.material.index() as u32, ..ObjectUniforms::new(turned) }
}

/// Returns a light relative to `origin`, multiplied by the exposure (in 1/nits).
///
/// # Errors
///
/// Fails if the light is invalid as [`Light`] describes. Importers create only valid lights.
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
    let packed = LightUniforms::punctual(shape, light.color, strength, exposure)?;
    let (shadow_strength, channels) = (light.held_shadow_strength(), light.channels.into());
    Ok(LightUniforms { shadow_strength, channels, ..packed })
}

#[cfg(test)]
mod tests {
    use glam::DMat4;

    use framegraph_shaders::layout::{VERTEX_ATTRIBUTES, VertexFormat};

    use super::*;
    use framegraph_scene::geometry::cuboid;
    use framegraph_scene::{Aabb, MaterialId, MeshId};

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
        // Assumed by `half_color` and `colors_are_cut`.
        assert_eq!(VERTEX_ATTRIBUTES[5].format, VertexFormat::Float16x4);
    }

    #[test]
    fn lights_move_with_the_origin_and_objects_do_not() {
        let origin = DVec3::new(1e6, 0.0, 0.0);
        let at = origin + DVec3::new(0.25, 1.0, 2.0);
        let id = (MeshId::new(0), MaterialId::new(0));
        let of = |placed: DMat4| object_uniforms(&Instance::new("", id.0, id.1, placed, &Aabb::EMPTY));
        assert_eq!(of(DMat4::from_translation(at)), of(DMat4::IDENTITY));
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
