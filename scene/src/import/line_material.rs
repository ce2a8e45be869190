//! Materials of lines and points (glTF 2.0, section 3.9.7).

use glam::Vec3;
use gltf_json::mesh::{Primitive, Semantic};
use gltf_json::validation::Checked;

use super::topology::topology;
use crate::material::{ClearCoat, Material};
use crate::mesh::Topology;

/// Vertex streams of lines or points that affect shading.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum LineStreams {
    /// Without normals: unlit.
    Bare,
    /// Normals without tangents: lit without normal maps.
    Normals,
    /// Normals and tangents: lit like triangles.
    Tangents,
}

impl LineStreams {
    /// Returns the streams of a primitive; `None` for triangles or an unknown mode.
    pub fn of(primitive: &Primitive) -> Option<Self> {
        let has = |semantic| primitive.attributes.contains_key(&Checked::Valid(semantic));
        match primitive.mode {
            Checked::Valid(mode) if topology(mode) != Topology::Triangles => Some(match has(Semantic::Normals) {
                false => Self::Bare,
                true if has(Semantic::Tangents) => Self::Tangents,
                true => Self::Normals,
            }),
            _ => None,
        }
    }
}

/// Returns the variant of a material for lines and points with these streams. Without normals it is unlit and shows
/// base color plus emission; without tangents it has no normal maps.
pub(super) fn for_lines(material: &Material, streams: LineStreams) -> Material {
    let Material { name, base_color, emissive, emissive_unit, alpha, double_sided, .. } = material.clone();
    let Material { base_color_texture, emissive_texture, clear_coat, .. } = *material;
    match streams {
        // KHR_materials_unlit shows only the base color.
        _ if material.unlit => Material { emissive: Vec3::ZERO, emissive_texture: None, ..material.clone() },
        LineStreams::Tangents => material.clone(),
        LineStreams::Normals => Material {
            normal_texture: None,
            clear_coat: clear_coat.map(|coat| ClearCoat { normal_texture: None, ..coat }),
            ..material.clone()
        },
        LineStreams::Bare => Material {
            name,
            base_color,
            base_color_texture,
            emissive,
            emissive_unit,
            emissive_texture,
            alpha,
            double_sided,
            unlit: true,
            ..Material::default()
        },
    }
}
