//! Formats of the prefiltered environment, and irradiance from its last level.

use crate::stage::{self, Set, Shot};
use framegraph_passes::effects::fog::{FogColor, FogSettings};
use framegraph_passes::gpu_scene::view::Background;
use framegraph_passes::light::ibl::EnvironmentFormat;
use framegraph_passes::light::shading::Irradiance;
use framegraph_passes::{Settings, Shading};
use framegraph_scene::environment::{ShBands, ShWindow};
use std::error::Error;
use tests::measure::harmonics::{self, Scene};

type TestResult = Result<(), Box<dyn Error>>;

/// Returns the RMS difference in 8-bit steps.
fn apart(a: &[u8], b: &[u8]) -> f64 {
    let squares = a.iter().zip(b).map(|(a, b)| f64::from(a.abs_diff(*b)).powi(2)).sum::<f64>();
    (squares / a.len() as f64).sqrt()
}

/// Surfaces, and the sky behind fog with the environment's color, look equal for all storage formats. Surfaces whose
/// diffuse light is the last level of the cube look equal too. Reading RGBM without decoding would differ by dozens of steps.
#[test]
fn pictures_are_the_same_by_every_format_and_by_the_cube() -> TestResult {
    const TEST: &str = "pictures_are_the_same_by_every_format_and_by_the_cube";
    let Some(gpu) = stage::gpu(TEST) else { return Ok(()) };
    let fog = FogSettings {
        color: FogColor::Environment { tint: [1.0; 3], sharp_m: 10.0, sharp_levels: 1.0 },
        density: 0.05,
        ..FogSettings::default()
    };
    let picture = |shading: Shading| -> Result<(Vec<u8>, u64), Box<dyn Error>> {
        let settings = Settings { shading, shadows: None, fog: Some(fog), fxaa: false, ..Settings::DEFAULT };
        let shot = Shot { size_px: [64, 48], options: framegraph::Options::for_frame(64, 48), ..Shot::small(settings) };
        let set = Set::new(&gpu, "spheres", &shot, &Background::Environment)?;
        assert_eq!(set.world().lighting.image.is_rgbm(), shading.environment_format == EnvironmentFormat::Rgbm);
        Ok((set.shoot(&gpu, &shot)?.0, set.world().lighting.image.size_bytes))
    };
    for precision in stage::precisions(TEST, &gpu) {
        let half = Shading { precision, environment_format: EnvironmentFormat::Half, ..Shading::default() };
        let (truth, bytes) = picture(half)?;
        let rgbm = Shading { environment_format: EnvironmentFormat::Rgbm, ..half };
        let (codes, small) = picture(rgbm)?;
        let off = apart(&codes, &truth);
        assert!(off > 0.0 && off < 1.5, "{precision:?}, RGBM: {off}");
        assert_eq!(small * 2, bytes);
        let (codes, _) = picture(Shading { irradiance: Irradiance::Cube, ..rgbm })?;
        let off = apart(&codes, &truth);
        assert!(off > 0.1 && off < 4.0, "{precision:?}, irradiance of the cube: {off}");
    }
    Ok(())
}

/// A level of sixteen texels a side has what two bands of harmonics lack; one of four is too coarse for a disc.
#[test]
fn the_last_level_is_irradiance() -> TestResult {
    let Some(gpu) = stage::gpu("the_last_level_is_irradiance") else { return Ok(()) };
    let cube = |levels_of| harmonics::cube_errors(&gpu, Scene::KeyDisc, levels_of, 100);
    let (fine, coarse) = (cube([256, 5])?, cube([64, 5])?);
    let two = harmonics::errors(Scene::KeyDisc, ShBands::Two, ShWindow::None, 100, |sh| sh);
    assert!(fine.worst < 0.05 && fine.lowest >= 0.0, "{fine:?}");
    assert!(coarse.worst > 1.5 * fine.worst && two.worst > 2.0 * fine.worst, "{coarse:?}, {two:?}");
    Ok(())
}
