//! Hard inputs of ambient occlusion: the design's hard cases, by number, in both precisions.

use super::{TestResult, gpu, least_and_mean, settings};
use crate::stage::{self, precisions};
use framegraph::{Caps, Options};
use framegraph_passes::Settings;
use framegraph_scene::Projection;
use framegraph_shader_mirrors::cases::{Case, Domain, all};
use framegraph_wgpu::Gpu;
use glam::DVec3;
use std::error::Error;
use tests::measure::occlusion::{Stage, ground};

/// All methods, without a blur that would hide single texels.
const METHODS: [&str; 4] = [
    "sao:quality=high,blur=off",
    "gtao:blur=off",
    "gtao:occluders=0.5,blur=off",
    "gtao:occluders=fading,bent-normals=on,cone=on,blur=off",
];
const SIZE: [u32; 2] = [128, 96];

/// Runs every method in every precision on a stage.
fn each(test: &str, gpu: &Gpu, stage: &Stage, mut look: impl FnMut(&str, &[[f32; 4]]) -> TestResult) -> TestResult {
    for precision in precisions(test, gpu) {
        for text in METHODS {
            let (texels, _) = stage.occlusion(gpu, &settings(text)?, precision, 1)?;
            let sound = |texel: &[f32; 4]| texel.iter().all(|x| x.is_finite()) && (0.0..=1.0).contains(&texel[0]);
            let broken = texels.iter().position(|texel| !sound(texel));
            assert!(broken.is_none(), "{test}: {text} in {precision:?}: {broken:?}");
            look(&format!("{text} in {precision:?}"), &texels)?;
        }
    }
    Ok(())
}

/// Case 30: depth 0 is not a surface. Sky is unoccluded and occludes nothing.
#[test]
fn hard_30_sky_is_open() -> TestResult {
    let Some(gpu) = gpu("hard_30_sky_is_open") else { return Ok(()) };
    let floor = ground(3.0, 60.0);
    let horizon = move |start: DVec3, direction: DVec3| floor(start, direction).filter(|_| direction.y < 0.1);
    let stage = Stage::new(Projection::perspective(0.8, 0.1), SIZE, horizon)?;
    assert!(stage.depth.contains(&0.0) && stage.depth.iter().any(|d| *d > 0.0));
    each("hard_30_sky_is_open", &gpu, &stage, |text, texels| {
        for (texel, depth) in texels.iter().zip(&stage.depth) {
            assert!(texel[0] >= 0.98 && (*depth > 0.0 || texel[0].to_bits() == 1f32.to_bits()), "{text}: {texel:?}");
        }
        Ok(())
    })
}

/// Case 31: near the eye, the radius covers any number of pixels.
#[test]
fn hard_31_what_is_before_the_eye_is_open() -> TestResult {
    let Some(gpu) = gpu("hard_31_what_is_before_the_eye_is_open") else { return Ok(()) };
    for distance_m in [1e-3, 1e-6] {
        let stage = Stage::new(Projection::perspective(0.8, 0.5 * distance_m), SIZE, ground(distance_m, 20.0))?;
        each("hard_31", &gpu, &stage, |text, texels| {
            let visibility: Vec<f32> = texels.iter().map(|texel| texel[0]).collect();
            let [least, _] = least_and_mean(&stage, &visibility);
            assert!(least >= 0.98, "{distance_m} m, {text}: {least}");
            Ok(())
        })?;
    }
    Ok(())
}

/// Case 32: without a radius, there is no pass.
#[test]
fn hard_32_a_radius_of_nothing_leaves_the_passes_out() -> TestResult {
    let options = Options::for_frame(256, 256);
    let counts =
        |occlusion| stage::plan(&Settings { occlusion, ..Settings::DEFAULT }, &Caps::wgpu(), &options).counts();
    let none = counts(None);
    for text in ["sao:radius=0", "gtao:radius=0", "sao:intensity=0"] {
        assert_eq!(counts(Some(settings(text)?)), none, "{text}");
    }
    assert_ne!(counts(Some(settings("sao")?)), none);
    Ok(())
}

/// Case 33: along a step of 0.5 m and on a strip of two pixels, normals are those of the surface. A surface with a
/// wrong normal would occlude itself.
#[test]
fn hard_33_normals_hold_at_edges_and_on_strips() -> TestResult {
    let Some(gpu) = gpu("hard_33_normals_hold_at_edges_and_on_strips") else { return Ok(()) };
    // Columns 0…47 are near, 48… are far, and 80 and 81 are near again; all are tilted by 30°.
    let (near, far) = (ground(3.0, 30.0), ground(3.5, 30.0));
    let projection = Projection::perspective(0.8, 0.1);
    let column = |direction: DVec3| {
        let half_width = (0.4_f64).tan() * f64::from(SIZE[0]) / f64::from(SIZE[1]);
        ((direction.x / half_width + 1.0) * 0.5 * f64::from(SIZE[0])) as u32
    };
    let stage = Stage::new(projection, SIZE, move |start, direction| match column(direction) {
        0..48 | 80 | 81 => near(start, direction),
        _ => far(start, direction),
    })?;
    let dark = |texels: &[[f32; 4]]| texels.iter().filter(|texel| texel[0] < 0.98).count();
    let (mut fine, mut coarse) = (0, 0);
    each("hard_33", &gpu, &stage, |_, texels| {
        fine += dark(texels);
        Ok(())
    })?;
    let plain = settings("sao:quality=high,blur=off,normals=coarse")?;
    coarse += dark(&stage.occlusion(&gpu, &plain, framegraph_passes::Precision::Full, 1)?.0);
    assert_eq!(fine, 0, "no occluder is within the radius");
    assert!(coarse > 90, "normals of the next texel are wrong along edges, and that shows: {coarse}");
    Ok(())
}

/// Case 34: distant positions keep their precision.
#[test]
fn hard_34_far_ground_is_open() -> TestResult {
    let Some(gpu) = gpu("hard_34_far_ground_is_open") else { return Ok(()) };
    for distance_m in [10.0, 50.0, 100.0] {
        // A narrow view, so that the radius is several pixels even there.
        let stage = Stage::new(Projection::perspective(4.0 / distance_m, 0.1), SIZE, ground(distance_m, 45.0))?;
        each("hard_34", &gpu, &stage, |text, texels| {
            let visibility: Vec<f32> = texels.iter().map(|texel| texel[0]).collect();
            let [least, _] = least_and_mean(&stage, &visibility);
            assert!(least >= 0.99, "{distance_m} m, {text}: {least}");
            Ok(())
        })?;
    }
    Ok(())
}

/// Case 35: arc cosine of values that rounding moved beyond 1.
#[test]
fn hard_35_collinear_vectors_have_an_angle() -> TestResult {
    let Some(gpu) = gpu("hard_35_collinear_vectors_have_an_angle") else { return Ok(()) };
    const PAST: &[Domain] = &[Domain::Values(&[1.0, 1.000_000_1, -1.000_000_1, 1.001, -1.0, 0.0, -0.0])];
    let case = all().find(|case| case.function == "acos_held").ok_or("acos_held")?;
    let hard = Case { parameters: PAST, ..*case };
    let inputs = hard.inputs(64);
    for (x, angle) in inputs.iter().zip(tests::mirror::results(&gpu, &hard, &inputs)?) {
        let expected = f64::from(x.clamp(-1.0, 1.0)).acos();
        assert!((f64::from(angle) - expected).abs() < 1e-4, "{x}: {angle}");
    }
    // Ground that faces the eye: its normal equals the view axis bit for bit.
    let stage = Stage::new(Projection::perspective(0.8, 0.1), SIZE, ground(2.0, 0.0))?;
    each("hard_35", &gpu, &stage, |text, texels| {
        let open = texels.iter().filter(|texel| texel[0] >= 0.98).count();
        assert_eq!(open, texels.len(), "{text}");
        Ok(())
    })
}

/// Case 36: samples do not wrap around at the borders of the picture.
#[test]
fn hard_36_borders_do_not_wrap() -> TestResult {
    let Some(gpu) = gpu("hard_36_borders_do_not_wrap") else { return Ok(()) };
    let floor = ground(3.0, 40.0);
    // A wall at the right border of the ground, and nothing at the left.
    let stage = Stage::new(Projection::perspective(0.8, 0.1), SIZE, move |start, direction| {
        let way = floor(start, direction)?;
        Some(if direction.x > 0.5 { 0.95 * way } else { way })
    })?;
    let mut at_wall: f32 = 1.0;
    each("hard_36", &gpu, &stage, |text, texels| {
        for y in 0..SIZE[1] {
            for x in 0..SIZE[0] / 4 {
                let left = texels[(y * SIZE[0] + x) as usize][0];
                assert!(left >= 0.98, "{text} at {x}, {y}: {left}");
            }
        }
        at_wall = texels.iter().map(|texel| texel[0]).fold(at_wall, f32::min);
        Ok(())
    })?;
    assert!(at_wall < 0.8, "the wall occludes what is beside it: {at_wall}");
    Ok::<_, Box<dyn Error>>(())
}
