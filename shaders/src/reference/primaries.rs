//! Mirror of `wgsl/lib/primaries.wgsl`, and primaries that only the CPU and the mirrors of tone curves need.
//!
//! Matrices are written by rows.

use glam::{DMat3, DVec3};

/// Creates a matrix from its rows.
pub(super) const fn rows(r: [f64; 3], g: [f64; 3], b: [f64; 3]) -> DMat3 {
    DMat3::from_cols(DVec3::new(r[0], g[0], b[0]), DVec3::new(r[1], g[1], b[1]), DVec3::new(r[2], g[2], b[2]))
}

/// Luminance weights of Rec.2020.
pub const LUMINANCE_REC2020: DVec3 = DVec3::new(0.262_700_2, 0.677_998_1, 0.059_301_7);
/// Luminance weights of Rec.709.
pub const LUMINANCE_REC709: DVec3 = DVec3::new(0.2126, 0.7152, 0.0722);

/// Rec.709 to Rec.2020 (ITU-R BT.2087).
pub const REC2020_FROM_REC709: DMat3 = rows(
    [0.627_403_895_9, 0.329_283_038_4, 0.043_313_065_7],
    [0.069_097_289_4, 0.919_540_395_1, 0.011_362_315_6],
    [0.016_391_438_9, 0.088_013_307_9, 0.895_595_253_2],
);

/// Rec.2020 to XYZ (white D65), with the same digits as in Filament.
pub const XYZ_FROM_REC2020: DMat3 = rows(
    [0.636_953_0, 0.144_616_9, 0.168_855_8],
    [0.262_698_3, 0.678_008_8, 0.059_292_9],
    [0.0, 0.028_073_1, 1.060_827_2],
);

/// AP1, the rendering primaries of ACES, to XYZ with the white of ACES.
pub const XYZ_FROM_AP1: DMat3 = rows(
    [0.662_454_181_1, 0.134_004_206_5, 0.156_187_687_0],
    [0.272_228_716_8, 0.674_081_765_8, 0.053_689_517_4],
    [-0.005_574_649_5, 0.004_060_733_5, 1.010_339_100_3],
);

/// AP1 to AP0, the archival primaries of ACES.
pub const AP0_FROM_AP1: DMat3 = rows(
    [0.695_452_241_4, 0.140_678_696_5, 0.163_869_062_2],
    [0.044_794_563_4, 0.859_671_118_5, 0.095_534_318_2],
    [-0.005_525_882_6, 0.004_025_210_3, 1.001_500_672_3],
);

/// Converts Rec.709 to Rec.2020.
pub fn rec2020_from_rec709(color: DVec3) -> DVec3 {
    REC2020_FROM_REC709 * color
}

/// Converts Rec.2020 to Rec.709.
pub fn rec709_from_rec2020(color: DVec3) -> DVec3 {
    REC2020_FROM_REC709.inverse() * color
}

/// Linear Rec.709 to the cone responses of OkLab.
const OKLAB_CONES: DMat3 = rows(
    [0.412_221_470_8, 0.536_332_536_3, 0.051_445_992_9],
    [0.211_903_498_2, 0.680_699_545_1, 0.107_396_956_6],
    [0.088_302_461_9, 0.281_718_837_6, 0.629_978_700_5],
);

/// Cube roots of cone responses to OkLab.
const OKLAB_FROM_ROOTS: DMat3 = rows(
    [0.210_454_255_3, 0.793_617_785_0, -0.004_072_046_8],
    [1.977_998_495_1, -2.428_592_205_0, 0.450_593_709_9],
    [0.025_904_037_1, 0.782_771_766_2, -0.808_675_766_0],
);

/// Converts linear Rec.709 to OkLab.
pub fn oklab_from_rec709(color: DVec3) -> DVec3 {
    OKLAB_FROM_ROOTS * DVec3::from_array((OKLAB_CONES * color).to_array().map(f64::cbrt))
}

/// Converts OkLab to linear Rec.709.
pub fn rec709_from_oklab(lab: DVec3) -> DVec3 {
    let root = OKLAB_FROM_ROOTS.inverse() * lab;
    OKLAB_CONES.inverse() * (root * root * root)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn white_stays_white_and_the_way_back_is_the_way_back() {
        let white = rec2020_from_rec709(DVec3::ONE);
        assert!((white - 1.0).abs().max_element() < 1e-7, "{white}");
        assert!((oklab_from_rec709(DVec3::ONE) - DVec3::X).abs().max_element() < 1e-6);
        for color in [DVec3::new(0.3, 0.5, 0.1), DVec3::new(4.0, 0.0, 0.2), DVec3::new(0.0, 0.0, 1.0)] {
            assert!((rec709_from_rec2020(rec2020_from_rec709(color)) - color).length() < 1e-12);
            assert!((rec709_from_oklab(oklab_from_rec709(color)) - color).length() < 1e-9);
            // Both sets of weights give the same luminance.
            let (y709, y2020) = (color.dot(LUMINANCE_REC709), rec2020_from_rec709(color).dot(LUMINANCE_REC2020));
            assert!((y709 - y2020).abs() < 1e-4 * color.length(), "{y709} {y2020}");
        }
    }
}
