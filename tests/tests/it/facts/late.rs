//! Measurements of the GPU: they arrive some frames later, no frame waits for them, and nothing flickers.

use super::TestResult;
use crate::stage::{gpu, plan};
use framegraph::{Caps, Desc, Options};
use framegraph_passes::effects::bloom::{Blend, Threshold};
use framegraph_passes::effects::exposure::{Measure, Measurement};
use framegraph_passes::feature_culling::{Decision, Effect, Proof};
use framegraph_passes::gpu_scene::view::ViewSettings;
use framegraph_passes::{BloomSettings, DofSettings, Settings};
use framegraph_scene::Projection;
use framegraph_wgpu::Gpu;
use tests::measure::facts::late::InARow;
use tests::measure::facts::{Drawn, SIZE_PX, cases};

/// A frame with one effect.
const BARE: Settings = Settings { shadows: None, fxaa: false, ..Settings::DEFAULT };

fn row(gpu: &Gpu, name: &str) -> Result<InARow, Box<dyn std::error::Error>> {
    let case = cases().into_iter().find(|case| case.name == name).ok_or("a case")?;
    Ok(InARow::new(gpu, Drawn::new(gpu, case)?))
}

/// Returns a view of the ball under light scaled by `times`; at 1, the sky is 1.15 before grading.
fn lit(row: &InARow, times: f32) -> ViewSettings {
    ViewSettings { environment_intensity: times, ..row.case().view(&BARE, SIZE_PX) }
}

fn glowing() -> Settings {
    Settings { bloom: Some(BloomSettings::DEFAULT), ..BARE }
}

/// Sky and ball are measured with their brightness and distance; the sky is infinitely far away. The picture's size is
/// not a multiple of eight.
#[test]
fn light_and_distances_are_measured() -> TestResult {
    let Some(gpu) = gpu("light_and_distances_are_measured") else { return Ok(()) };
    let mut row = row(&gpu, "ball")?;
    let asked = Settings {
        dof: Some(DofSettings { f_number: 0.5, focal_length_m: Some(0.5), ..DofSettings::DEFAULT }),
        ..glowing()
    };
    for size_px in [[64, 64], [75, 41], [7, 1]] {
        let seen = ViewSettings { size_px, ..lit(&row, 1.0) };
        let (facts, _) = row.next(&asked.for_scene(&row.case().scene, size_px), &seen)?;
        assert_eq!(facts.measure, Measure { light: true, depth: true });
        row.show()?;
        gpu.wait()?;
        let Measurement::Known(found) = row.measuring.known(&gpu)? else { return Err("nothing has come".into()) };
        let (nits, [near, far]) = (found.most_nits.ok_or("light")?, found.distances_m.ok_or("depth")?);
        // Half floats round radiance to 1/2048; the sky of 2000 nits is the brightest.
        assert!((nits / 2000.0 - 1.0).abs() < 2e-3, "{size_px:?}: {nits} nits");
        assert_eq!(far, f64::INFINITY, "{size_px:?}");
        // The camera is 3.3 m from the center of the ball, which has a radius of 0.5 m and 24 segments.
        let expected = 3.306 - 0.5;
        let nearest = if size_px == [7, 1] { 0.05 } else { 0.01 };
        assert!((near - expected).abs() < nearest, "{size_px:?}: {near} m");
    }
    Ok(())
}

/// Measurements carry the number of their frame. They expire after eight frames, and when discarded.
#[test]
fn what_is_old_or_forgotten_is_unknown() -> TestResult {
    let Some(gpu) = gpu("what_is_old_or_forgotten_is_unknown") else { return Ok(()) };
    let mut row = row(&gpu, "ball")?;
    let seen = lit(&row, 1.0);
    row.next(&glowing(), &seen)?;
    row.show()?;
    gpu.wait()?;
    for frames in 1..=10 {
        let known = row.measuring.known(&gpu)?;
        match known {
            Measurement::Known(found) => assert!(found.frames_ago == frames && frames <= 8, "{frames}: {found:?}"),
            _ => assert!(frames > 8, "{frames}: {known:?}"),
        }
        // A frame that measures nothing.
        row.next(&BARE, &seen)?;
    }
    row.next(&glowing(), &seen)?;
    row.show()?;
    gpu.wait()?;
    assert!(matches!(row.measuring.known(&gpu)?, Measurement::Known(_)));
    row.measuring.forget();
    assert_eq!(row.measuring.known(&gpu)?, Measurement::Unknown);
    Ok(())
}

/// Bloom without a threshold, or that interpolates, is visible in the dark too. In an orthographic projection, depth is
/// not a distance from the eye.
#[test]
fn what_no_measure_decides_is_kept() -> TestResult {
    let Some(gpu) = gpu("what_no_measure_decides_is_kept") else { return Ok(()) };
    let mut row = row(&gpu, "ball")?;
    let dark = lit(&row, 0.01);
    for own in [
        BloomSettings { threshold: Threshold::None, ..BloomSettings::DEFAULT },
        BloomSettings { blend: Blend::Interpolate, ..BloomSettings::DEFAULT },
    ] {
        let asked = Settings { bloom: Some(own), ..BARE };
        for _ in 0..2 {
            let (facts, _) = row.next(&asked, &dark)?;
            assert_eq!(facts.of(Effect::Bloom).ok_or("bloom")?.decision, Decision::Kept, "{own:?}");
            assert!(!facts.measure.light, "{own:?}");
            row.show()?;
            gpu.wait()?;
            row.forget();
        }
    }
    let asked = Settings { dof: Some(DofSettings::DEFAULT), ..BARE };
    let mut parallel = lit(&row, 1.0);
    parallel.camera.projection =
        Projection::Orthographic { half_width_m: None, half_height_m: 2.0, near_m: 0.1, far_m: 50.0 };
    row.next(&asked, &parallel)?;
    row.show()?;
    gpu.wait()?;
    let known = row.measuring.known(&gpu)?;
    assert!(!matches!(known, Measurement::Known(found) if found.distances_m.is_some()), "{known:?}");
    Ok(())
}

/// The copied picture is 1/64 as wide and high.
#[test]
fn what_is_read_back_is_small() -> TestResult {
    let settings = Settings { measure: Measure { light: true, depth: true }, ..glowing() };
    let plan = plan(&settings, &Caps::wgpu(), &Options::for_frame(1920, 1080));
    let graph = plan.graph();
    let measured = graph.resource_ids().filter(|id| graph.resource_name(*id).ends_with("measured"));
    let sizes: Vec<[u32; 2]> = measured
        .filter_map(|id| match graph.resources()[id.index()].desc {
            Desc::Texture(desc) => Some(desc.extent.texels([1920, 1080])),
            Desc::Buffer(_) => None,
        })
        .collect();
    assert_eq!(sizes, [[240, 135], [30, 17], [240, 135], [30, 17]]);
    Ok(())
}

/// Bloom is culled if twice the light is below its threshold, which changes no bit; otherwise it is kept.
#[test]
fn bloom_is_culled_if_nothing_was_bright() -> TestResult {
    let Some(gpu) = gpu("bloom_is_culled_if_nothing_was_bright") else { return Ok(()) };
    // Twice 1.15 times the factor reaches 1 at 0.434.
    for (times, decision) in [(0.42, Decision::Dropped), (0.45, Decision::Kept), (2.0, Decision::Kept)] {
        let mut row = row(&gpu, "ball")?;
        let seen = lit(&row, times);
        let asked = glowing();
        let (first, measured) = row.next(&asked, &seen)?;
        let fact = first.of(Effect::Bloom).ok_or("bloom")?;
        assert!(measured == Measurement::Unknown && fact.decision == Decision::Kept, "{fact:?}");
        assert!(fact.reason.ends_with("no measure of it has come yet"), "{fact:?}");
        let with = row.picture()?;
        row.show()?;
        gpu.wait()?;
        row.forget();
        let (second, _) = row.next(&asked, &seen)?;
        let fact = second.of(Effect::Bloom).ok_or("bloom")?;
        assert_eq!((fact.decision, fact.proof), (decision, Proof::Late), "{times}: {fact:?}");
        assert!(second.measure.light, "it is measured on, so that bloom can come back");
        let notes = second.json(&[]);
        assert!(notes.contains("at most a frame ago, and what glows begins at 1.00"), "{notes}");
        assert!(row.picture()? == with, "{times}: the picture is another");
    }
    Ok(())
}

/// The floor fills the picture. Its box and the sky do not bound the distances, but measured depths show whether all is
/// in focus.
#[test]
fn depth_of_field_is_culled_if_all_was_in_focus() -> TestResult {
    let Some(gpu) = gpu("depth_of_field_is_culled_if_all_was_in_focus") else { return Ok(()) };
    for (f_number, decision) in [(64.0, Decision::Dropped), (1.0, Decision::Kept)] {
        let mut row = row(&gpu, "floor")?;
        // Neither side is a multiple of eight; texels beyond the edge must not count as depth.
        let seen = row.case().view(&BARE, [75, 41]);
        // A close view, so that by bounds alone the sky is out of focus at either aperture.
        let focal_length_m = Some(0.2);
        let own = DofSettings { focus_m: 2.1, f_number, focal_length_m, ..DofSettings::DEFAULT };
        let asked = Settings { dof: Some(own), ..BARE };
        let (first, _) = row.next(&asked, &seen)?;
        assert_eq!(first.of(Effect::DepthOfField).ok_or("dof")?.decision, Decision::Kept);
        let with = row.picture()?;
        row.show()?;
        gpu.wait()?;
        row.forget();
        let (second, _) = row.next(&asked, &seen)?;
        let fact = second.of(Effect::DepthOfField).ok_or("dof")?;
        assert_eq!((fact.decision, fact.proof), (decision, Proof::Late), "{f_number}: {fact:?}");
        assert!(decision == Decision::Kept || row.picture()? == with, "{f_number}: the picture is another");
    }
    Ok(())
}

/// Light grows over 64 frames with 5 % of noise. Bloom is culled once and restored once; without hysteresis, it toggles
/// with the noise. No frame waits for the device.
#[test]
fn a_slow_crossing_neither_flickers_nor_waits() -> TestResult {
    let Some(gpu) = gpu("a_slow_crossing_neither_flickers_nor_waits") else { return Ok(()) };
    let crossing = |remembers: bool| -> Result<Vec<Decision>, Box<dyn std::error::Error>> {
        let mut row = row(&gpu, "ball")?;
        // The first query of the capabilities draws a picture and waits for it.
        gpu.caps();
        let (asked, waited) = (glowing(), gpu.waits());
        let mut decided = Vec::new();
        for frame in 0..64_u8 {
            let tremor = if frame % 2 == 0 { 1.05 } else { 0.95 };
            let seen = lit(&row, (0.3 + 0.3 * f32::from(frame) / 63.0) * tremor);
            let (facts, measured) = row.next(&asked, &seen)?;
            let late = matches!(measured, Measurement::Known(found) if found.frames_ago <= 3);
            assert!(late || frame < 3, "frame {frame}: {measured:?}");
            decided.push(facts.of(Effect::Bloom).ok_or("bloom")?.decision);
            if !remembers {
                row.forget();
            }
            row.show()?;
        }
        let counts = row.measuring.counts();
        assert!(counts.begun == 64 && counts.left_out == 0 && counts.come >= 62, "{counts:?}");
        assert_eq!(gpu.waits() - waited, 0, "a frame has waited");
        Ok(decided)
    };
    let changes = |decided: &[Decision]| decided.windows(2).filter(|pair| pair[0] != pair[1]).count();
    let remembered = crossing(true)?;
    assert_eq!(changes(&remembered), 2, "{remembered:?}");
    assert_eq!((remembered[0], remembered[63]), (Decision::Kept, Decision::Kept));
    assert!(changes(&crossing(false)?) > 2);
    Ok(())
}

/// A light that is switched on has its bloom within four frames.
#[test]
fn what_comes_suddenly_glows_some_frames_late() -> TestResult {
    let Some(gpu) = gpu("what_comes_suddenly_glows_some_frames_late") else { return Ok(()) };
    let mut row = row(&gpu, "ball")?;
    let mut decided = |times: f32| -> Result<Decision, Box<dyn std::error::Error>> {
        let seen = lit(&row, times);
        let (facts, _) = row.next(&glowing(), &seen)?;
        row.show()?;
        Ok(facts.of(Effect::Bloom).ok_or("bloom")?.decision)
    };
    let dark: Vec<Decision> = (0..16).map(|_| decided(0.1)).collect::<Result<_, _>>()?;
    assert_eq!(dark[15], Decision::Dropped, "{dark:?}");
    let bright: Vec<Decision> = (0..4).map(|_| decided(2.0)).collect::<Result<_, _>>()?;
    assert_eq!(bright[3], Decision::Kept, "{bright:?}");
    Ok(())
}
