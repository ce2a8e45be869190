//! Hard inputs of ray marching.

use super::TestResult;
use crate::stage::gpu;
use framegraph_passes::SettingsTable;
use framegraph_passes::effects::depth::structure::Resolution;
use framegraph_passes::effects::reflection::ReflectionSettings;
use framegraph_scene::Projection;
use glam::{DVec3, Vec3};
use tests::measure::reflection::{BROKEN, Stage};
use truth::reflection::{Lens, Room};

const SIZE: [u32; 2] = [96, 64];

/// Checks that every texel is finite, has a weight in 0…1, and has coordinates within the picture, multiplied by the
/// weight.
fn sound(what: &str, texels: &[[f32; 4]]) {
    for (index, [u, v, one, counts]) in texels.iter().enumerate() {
        let finite = [u, v, one, counts].iter().all(|x| (x.to_bits() & 0x7fff_ffff) < 0x7f80_0000);
        assert!(finite && (0.0..=1.0).contains(counts), "{what}: texel {index} counts {counts}");
        // A few roundings of half floats.
        let most = counts * 1.002 + 1e-3;
        assert!((0.0..=most).contains(u) && (0.0..=most).contains(v), "{what}: texel {index}: {u}, {v} of {counts}");
        assert!((one - counts).abs() < 2e-3, "{what}: texel {index}: {one} of {counts}");
    }
}

fn lens(eye: DVec3, target: DVec3) -> Lens {
    Lens { eye, target, fov_y_rad: 0.8, aspect: f64::from(SIZE[0]) / f64::from(SIZE[1]) }
}

/// Tests rays along and against the view, along surfaces, through the near plane and from in front of it. Also tests tiny pictures, an orthographic projection, and views of only the sky.
#[test]
fn rays_of_every_kind_end() -> TestResult {
    let Some(gpu) = gpu("rays_of_every_kind_end") else { return Ok(()) };
    let ball = || vec![(DVec3::new(0.0, 0.5, 0.0), 0.4)];
    let room = |balls| Room { floor_m: 0.0, balls };
    let front = DVec3::new(0.0, 0.5, 3.0);
    let mut stages = vec![
        // Straight down: the ray returns to the eye, a point in the picture.
        ("down", Stage::new(room(vec![]), lens(DVec3::new(0.0, 2.0, 1e-4), DVec3::ZERO), SIZE)),
        ("down on a ball", Stage::new(room(ball()), lens(DVec3::new(0.0, 2.0, 1e-4), DVec3::ZERO), SIZE)),
        // A millimeter above the floor: all rays are grazing.
        ("grazing", Stage::new(room(ball()), lens(DVec3::new(0.0, 1e-3, 3.0), DVec3::new(0.0, 1e-3, 0.0)), SIZE)),
        // Closer to a ball than the rays' starting offset, so they start before the near plane or behind the eye.
        ("at a ball", Stage::new(room(ball()), lens(DVec3::new(0.0, 0.5, 0.403), DVec3::new(0.0, 0.5, 0.0)), SIZE)),
        ("sky", Stage::new(room(vec![]), lens(front, DVec3::new(0.0, 9.0, 0.0)), SIZE)),
        ("far away", Stage::new(room(ball()), lens(front * 1e4, DVec3::ZERO), SIZE)),
    ];
    for (_, stage) in &mut stages {
        stage.projection = Projection::perspective(stage.lens.fov_y_rad, 1e-3);
    }
    for size in [[1, 1], [3, 2], [1, 96]] {
        stages.push(("small", Stage::new(room(ball()), lens(front, DVec3::ZERO), size)));
    }
    let mut parallel = Stage::new(room(ball()), lens(front, DVec3::new(0.0, 0.4, 0.0)), SIZE);
    parallel.projection =
        Projection::Orthographic { half_width_m: None, half_height_m: 1.0, near_m: 0.1, far_m: 100.0 };
    stages.push(("parallel", parallel));
    for (what, stage) in test_report::share(&stages) {
        for text in ["on", "on:bias=0,stride=1", "on:thickness=0", "on:distance=100000,thickness=10000"] {
            let settings = ReflectionSettings::from_text(text)?.ok_or("it is on")?;
            for resolution in [Resolution::Full, Resolution::Half] {
                let texels = stage.reflected(&gpu, &settings, resolution, 0)?;
                sound(&format!("{what}, {text}, {resolution:?}"), &texels);
                if *what == "sky" || *what == "down" {
                    assert!(texels.iter().all(|texel| texel[3] == 0.0), "{what}, {text}: nothing is there to be met");
                }
            }
        }
    }
    Ok(())
}

/// Invalid radiance in the previous frame is not read: the rest of the picture is unchanged, bit for bit.
#[test]
fn broken_radiance_does_not_spread() -> TestResult {
    let Some(gpu) = gpu("broken_radiance_does_not_spread") else { return Ok(()) };
    let (stage, settings) = (Stage::balls(SIZE), ReflectionSettings::DEFAULT);
    let whole = stage.reflected(&gpu, &settings, Resolution::Full, 0)?;
    for broken in BROKEN {
        let texels = stage.reflected(&gpu, &settings, Resolution::Full, broken)?;
        sound(&format!("{broken:#x}"), &texels);
        let mut left_out = 0;
        for (found, before) in texels.iter().zip(&whole) {
            // A linear filter reads half a texel beyond the invalid half.
            let [u, _, _, counts] = before;
            let far = (u / counts.max(1e-6) - 0.5).abs() * SIZE[0] as f32 > 1.5;
            let in_it = *u < 0.5 * counts;
            if *counts > 0.0 && far {
                assert!(if in_it { *found == [0.0; 4] } else { found == before }, "{found:?} for {before:?}");
                left_out += usize::from(in_it);
            }
        }
        assert!(left_out > 100, "there was something to leave out: {left_out}");
    }
    Ok(())
}

/// Rough surfaces trace no rays, and the reflections of less rough ones fade.
#[test]
fn rough_mirrors_fade() -> TestResult {
    let Some(gpu) = gpu("rough_mirrors_fade") else { return Ok(()) };
    let sum = |roughness: f32| -> Result<f32, Box<dyn std::error::Error>> {
        let mut stage = Stage::balls(SIZE);
        for material in &mut stage.scene.materials {
            (material.roughness, material.base_color) = (roughness, Vec3::ONE.extend(1.0));
        }
        let texels = stage.reflected(&gpu, &ReflectionSettings::DEFAULT, Resolution::Full, 0)?;
        Ok(texels.iter().map(|texel| texel[3]).sum())
    };
    let smooth = sum(0.0)?;
    let share = |roughness| Ok::<_, Box<dyn std::error::Error>>(sum(roughness)? / smooth);
    // The fade ends at √½ and starts at three quarters of it.
    assert_eq!([share(0.5)?, share(0.7072)?, share(1.0)?], [1.0, 0.0, 0.0]);
    let half = share(std::f32::consts::FRAC_1_SQRT_2 * 0.875)?;
    assert!((half - 0.5).abs() < 2e-3, "{half}");
    Ok(())
}
