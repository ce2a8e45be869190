//! Light that an environment came with, in the form that computed light has.

use framegraph::Format;
use framegraph_scene::environment::FilteredLight;
use glam::DVec3;
use half::f16;

use super::cube::scale_of;
use super::entry::LightEntry;
use super::texture::CubeShape;

/// Its cube in half floats, which hold what files of eleven bits a channel do.
pub(super) fn shape(light: &FilteredLight) -> CubeShape {
    CubeShape { texels: light.size_texels, levels: light.levels.len() as u32, format: Format::Rgba16Float }
}

/// Its texels and harmonics; `average` is the mean radiance of the map.
pub(super) fn entry(light: &FilteredLight, average: DVec3) -> LightEntry {
    let texel_nits = scale_of(light.levels.iter().flatten());
    let level = |texels: &Vec<[f32; 4]>| {
        let half = |[r, g, b, _]: [f32; 4]| [r / texel_nits, g / texel_nits, b / texel_nits, 1.0].map(f16::from_f32);
        texels.iter().flat_map(|texel| half(*texel)).flat_map(f16::to_le_bytes).collect()
    };
    LightEntry { sh: light.sh.clone(), average, texel_nits, levels: light.levels.iter().map(level).collect() }
}
