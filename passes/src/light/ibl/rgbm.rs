//! A specular cube of half floats as one of RGBM.

use framegraph::Format;
use framegraph_shaders::reference::rgbm::{RGBM_MAX, rgbm_bytes};
use glam::DVec3;
use half::f16;

use super::entry::LightEntry;
use super::texture::CubeShape;

/// Encodes the levels of `light`, whose texels are half floats, and returns the shape of the new cube. Its brightest channel
/// becomes the largest number of RGBM.
pub(super) fn encode(light: &mut LightEntry, shape: CubeShape) -> CubeShape {
    let texel = |bytes: &[u8]| {
        let channel = |c: usize| f16::from_le_bytes([bytes[2 * c], bytes[2 * c + 1]]).to_f64();
        DVec3::new(channel(0), channel(1), channel(2))
    };
    let texels = |level: &[u8]| level.chunks_exact(8).map(texel).collect::<Vec<_>>();
    let brightest = light.levels.iter().flat_map(|level| texels(level)).fold(0.0_f64, |a, c| a.max(c.max_element()));
    let scale = if brightest > 0.0 { brightest / RGBM_MAX } else { 1.0 };
    for level in &mut light.levels {
        *level = texels(level).into_iter().flat_map(|color| rgbm_bytes(color / scale)).collect();
    }
    light.texel_nits *= scale as f32;
    CubeShape { format: Format::Rgba8Unorm, ..shape }
}

#[cfg(test)]
mod tests {
    use super::*;
    use framegraph_scene::environment::{Sh, ShBands};
    use framegraph_shaders::reference::rgbm::linear_from_rgbm;
    use glam::DVec4;

    #[test]
    fn the_brightest_texel_is_kept_and_others_within_a_step() {
        let colors = [[1.0_f32, 0.5, 0.25], [3000.0, 1000.0, 0.0], [12.0, 12.0, 12.0]];
        let half = |[r, g, b]: [f32; 3]| [r, g, b, 1.0].map(f16::from_f32).into_iter().flat_map(f16::to_le_bytes);
        let sh = Sh::from_coefficients(ShBands::Two, vec![DVec3::ONE; 4]);
        let levels = vec![colors.into_iter().flat_map(half).collect()];
        let mut light = LightEntry { sh, average: DVec3::ONE, texel_nits: 2.0, levels };
        let shape = encode(&mut light, CubeShape { texels: 1, levels: 1, format: Format::Rgba16Float });
        assert_eq!((shape.format, light.levels[0].len()), (Format::Rgba8Unorm, 12));
        for (bytes, color) in light.levels[0].chunks_exact(4).zip(colors) {
            let codes = DVec4::from_array(std::array::from_fn(|i| f64::from(bytes[i]) / 255.0));
            let nits = linear_from_rgbm(codes) * f64::from(light.texel_nits);
            let expected = DVec3::from_array(color.map(|c| 2.0 * f64::from(c)));
            let off = (nits - expected).abs().max_element() / expected.max_element();
            assert!(off < 0.006, "{nits} for {expected}");
        }
    }
}
