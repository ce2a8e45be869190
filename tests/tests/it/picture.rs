//! Pictures of the standard frame, compared with committed ones.

use crate::stage::{Shot, gpu, picture};
use framegraph::Options;
use framegraph_passes::Settings;
use framegraph_scene::picture::{encode_png, read_rgba8};
use framegraph_wgpu::Gpu;
use std::error::Error;
use std::path::PathBuf;
use tests::compare::compare;

/// Returns the minimum PSNR in dB, and the maximum share of differing pixels. The pictures are from Mesa's software
/// driver, all tested versions of which agree apart from a few texels on other processors. Other drivers may round differently at edges and in filters. They are allowed 40 dB and 0.5 %, the difference between two builds of one renderer (see the reference pictures' README). A change of 1/20 stop gives 32 dB.
fn limits(gpu: &Gpu) -> (f64, f64) {
    if gpu.describe().contains("llvmpipe") { (60.0, 0.0003) } else { (40.0, 0.005) }
}

fn reference(name: &str) -> PathBuf {
    PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/references")).join(format!("{name}.png"))
}

fn matches(gpu: &Gpu, name: &str, size_px: [u32; 2], rgba8: &[u8]) -> Result<(bool, String), Box<dyn Error>> {
    let path = reference(name);
    if std::env::var_os("FRAMEGRAPH_WRITE_REFERENCES").is_some() {
        encode_png(std::fs::File::create(&path)?, size_px, rgba8)?;
    }
    let (size, expected) = read_rgba8(&path)?;
    assert_eq!(size, size_px, "{}", path.display());
    let difference = compare(rgba8, &expected).ok_or("the pictures differ in size")?;
    let (least_psnr_db, most_off) = limits(gpu);
    let same = difference.psnr_db >= least_psnr_db && difference.share_off <= most_off;
    Ok((same, format!("{name}: {difference:?}")))
}

#[test]
fn the_built_in_scenes_look_as_they_did() -> Result<(), Box<dyn Error>> {
    let Some(gpu) = gpu("the_built_in_scenes_look_as_they_did") else { return Ok(()) };
    // With four samples, edges show whether grading happens before the resolve (inlined) or after it. A scene that
    // blends is never inlined, and at one sample both are equal within one 8-bit step.
    for (reference, scene, samples, inline) in [
        ("spheres", "spheres", 4, false),
        ("spheres_inlined", "spheres", 4, true),
        ("columns", "columns", 1, true),
        ("materials", "materials", 4, true),
    ] {
        let mut shot = Shot::small(Settings { samples, ..Settings::default() });
        shot.options.inline = inline;
        let (same, told) = matches(&gpu, reference, shot.size_px, &picture(&gpu, scene, &shot)?)?;
        assert!(same, "{told}");
    }
    Ok(())
}

/// Negative controls: 1/20 stop, a missing shadow, and grading on the other side of the resolve.
#[test]
fn one_perturbed_constant_fails_the_comparison() -> Result<(), Box<dyn Error>> {
    let Some(gpu) = gpu("one_perturbed_constant_fails_the_comparison") else { return Ok(()) };
    let shot = Shot::small(Settings { samples: 4, ..Settings::default() });
    let darker = Shot { ev100: shot.ev100 + 0.05, ..shot };
    let unshadowed = Shot { settings: Settings { shadows: None, ..shot.settings }, ..shot };
    if std::env::var_os("FRAMEGRAPH_WRITE_REFERENCES").is_some() {
        test_report::skip("one_perturbed_constant_fails_the_comparison", "the pictures are being written");
        return Ok(());
    }
    let apart = Shot { options: Options { inline: false, ..shot.options }, ..shot };
    for wrong in [darker, unshadowed, apart] {
        let (same, told) = matches(&gpu, "spheres_inlined", shot.size_px, &picture(&gpu, "spheres", &wrong)?)?;
        assert!(!same, "{told}");
    }
    Ok(())
}

/// On one driver, the picture does not depend on the plan.
#[test]
fn the_plan_does_not_change_the_picture() -> Result<(), Box<dyn Error>> {
    let Some(gpu) = gpu("the_plan_does_not_change_the_picture") else { return Ok(()) };
    let shot = Shot::small(Settings { samples: 4, ..Settings::default() });
    let expected = picture(&gpu, "materials", &shot)?;
    let other = [
        Options { merge: false, ..shot.options },
        Options { memoryless: false, ..shot.options },
        Options { alias: framegraph::Alias::Off, ..shot.options },
        Options { order: framegraph::Order::Optimized, ..shot.options },
        shot.options.immediate(),
    ];
    for options in other {
        assert!(picture(&gpu, "materials", &Shot { options, ..shot })? == expected, "{options:?}");
    }
    Ok(())
}
