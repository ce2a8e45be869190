//! Hard inputs of shadow maps: the design's hard cases, by number, as pictures in both precisions. Every pixel must
//! also be finite, tested by its bits.

use super::{JUDGED, Set, TestResult, camera, field, scene_of};
use crate::stage::{gpu, precisions};
use framegraph_passes::gpu_scene::shadow_views::{Fit, ShadowFilter, ShadowSettings};
use framegraph_wgpu::Gpu;
use glam::DVec3;

const FITS: [Fit; 3] = [Fit::Tight { lispsm: true }, Fit::Tight { lispsm: false }, Fit::Stable];

/// Tests every fit in every precision. `most` is the allowed difference from rays in thousandths of the pixels,
/// `least_dark` the minimum number of shadowed pixels.
fn each_fit(test: &str, gpu: &Gpu, set: &Set, most: u32, least_dark: u32) -> TestResult {
    for precision in precisions(test, gpu) {
        let set = Set { precision, ..set.clone() };
        let judge = set.judge(gpu)?;
        for fit in FITS {
            let settings = ShadowSettings { fit, cascades: 2, ..ShadowSettings::DEFAULT };
            let [wrong, count, dark] = judge.compared(settings, |distance_m| (0.01 * distance_m).max(0.08))?;
            let told = format!("{test}: {fit:?} in {precision:?}: {wrong} of {count} wrong, {dark} dark");
            assert!(count >= JUDGED && dark >= least_dark && 1000 * wrong <= most * count, "{told}");
        }
    }
    Ok(())
}

/// Case 40: light along the view, straight down, and nearly so.
#[test]
fn hard_case_40_light_along_the_view_shades_as_rays_do() -> TestResult {
    let test = "hard_case_40_light_along_the_view_shades_as_rays_do";
    let Some(gpu) = gpu(test) else { return Ok(()) };
    let Set { scene, camera: ahead, .. } = field()?;
    let down = camera([0.5, 14.0, 0.0], [0.5, 0.0, -0.001], 50.0)?;
    // Surfaces seen along the light are lit, so no dark pixels are required.
    for (camera, toward) in
        [(&ahead, DVec3::Y), (&ahead, -ahead.forward()), (&down, -down.forward()), (&down, DVec3::new(1e-9, 1.0, 0.0))]
    {
        each_fit(test, &gpu, &Set::new(scene.clone(), camera.clone(), toward), 4, 0)?;
    }
    Ok(())
}

/// Case 41: a slab behind the eye casts a shadow on the center of the picture.
#[test]
fn hard_case_41_a_caster_behind_the_eye_shades_the_picture() -> TestResult {
    let test = "hard_case_41_a_caster_behind_the_eye_shades_the_picture";
    let Some(gpu) = gpu(test) else { return Ok(()) };
    let (floor, slab) = (([0.0, -0.5, 0.0], [50.0, 0.5, 50.0]), ([20.0, 24.0, 12.0], [3.0, 0.3, 3.0]));
    let eye = camera([1.0, 2.5, 8.0], [0.0, 0.0, -1.0], 50.0)?;
    each_fit(test, &gpu, &Set::new(scene_of(&[floor, slab]), eye, DVec3::new(0.5, 0.6, 0.3)), 4, 1000)
}

/// Cases 43, 44, 45: a floor without occluders, in a map with another object. No blocker is found, and the light equals
/// that without shadows: bit for bit with depth comparison, to within 1 % with moments.
#[test]
fn hard_cases_43_to_45_a_floor_without_blockers_is_lit() -> TestResult {
    let test = "hard_cases_43_to_45_a_floor_without_blockers_is_lit";
    let Some(gpu) = gpu(test) else { return Ok(()) };
    // The box casts its shadow outside of the picture.
    let scene = scene_of(&[([0.0, -0.5, 0.0], [20.0, 0.5, 20.0]), ([-9.0, 1.0, 0.0], [0.3, 1.0, 0.3])]);
    let eye = camera([3.0, 3.0, 4.0], [3.0, 0.0, 0.0], 40.0)?;
    for precision in precisions(test, &gpu) {
        let set = Set { precision, ..Set::new(scene.clone(), eye.clone(), DVec3::new(0.5, 0.6, 0.3)) };
        let plain = set.radiance(&gpu, None)?;
        for filter in ShadowFilter::ALL {
            let settings = ShadowSettings { filter, ..ShadowSettings::DEFAULT };
            let told = format!("{filter:?} in {precision:?}");
            if matches!(filter, ShadowFilter::Vsm | ShadowFilter::Evsm) {
                let dark =
                    set.visibility_beside(&gpu, &plain, settings)?.into_iter().flatten().filter(|v| *v < 0.99).count();
                assert_eq!(dark, 0, "{told}");
            } else {
                let with = set.radiance(&gpu, Some(settings))?;
                assert!(with.iter().zip(&plain).all(|(a, b)| a.to_bits() == b.to_bits()), "{told}");
            }
        }
    }
    Ok(())
}

/// Case 43: blockers at the near end of the map and touching the receiver, under a wide sun.
#[test]
fn hard_case_43_blockers_at_both_ends_shade_as_rays_do() -> TestResult {
    let test = "hard_case_43_blockers_at_both_ends_shade_as_rays_do";
    let Some(gpu) = gpu(test) else { return Ok(()) };
    let set = field()?;
    for precision in precisions(test, &gpu) {
        let set = Set { precision, ..set.clone() };
        let judge = set.judge(&gpu)?;
        for filter in [ShadowFilter::Pcss, ShadowFilter::Dpcf] {
            let settings = ShadowSettings { filter, cascades: 2, bulb_m: Some(0.02), ..ShadowSettings::DEFAULT };
            let wrong = judge.wrong(settings, |distance_m| (0.01 * distance_m).max(0.05))?;
            assert!(wrong <= 2.0, "{filter:?} in {precision:?}: {wrong} of a thousand");
        }
    }
    Ok(())
}

/// Moments need no bias: a lit floor stays lit, and the area under a box is dark if no second box is above it (hard
/// case 45).
#[test]
fn hard_case_45_moments_agree_with_rays() -> TestResult {
    let Some(gpu) = gpu("hard_case_45_moments_agree_with_rays") else { return Ok(()) };
    let (filters, set) = ([ShadowFilter::Vsm, ShadowFilter::Evsm], field()?);
    let precisions = precisions("hard_case_45_moments_agree_with_rays", &gpu);
    for precision in precisions {
        let set = Set { precision, ..set.clone() };
        let judge = set.judge(&gpu)?;
        for filter in filters {
            let mut settings = ShadowSettings { filter, cascades: 2, ..ShadowSettings::DEFAULT };
            // Sixteen bits leak light near the base of casters, at up to 1 % of the pixels.
            let most = if filter == ShadowFilter::Vsm { 30.0 } else { 10.0 };
            let plain = judge.wrong(settings, |distance_m| (0.01 * distance_m).max(0.1))?;
            settings.moments.blur_texels = 5.0;
            settings.moments.levels = 3;
            settings.moments.samples = 4;
            let filtered = judge.wrong(settings, |distance_m| (0.015 * distance_m).max(0.15))?;
            assert!(plain <= most && filtered <= most, "{filter:?} in {precision:?}: {plain} {filtered} of a thousand");
        }
    }
    Ok(())
}
