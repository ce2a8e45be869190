//! Post-processing inlined into the color pass, compared with separate passes.
//!
//! A software rasterizer uses f32 either way, so both are bit-exact if the epilogue rounds like the intermediate
//! texture. With four samples they differ by design, since without inlining samples are averaged before grading.
//! `inline/samples.rs` then grades each sample as the reference.

mod own;
mod samples;

use crate::stage::{Set, Shot, gpu};
use framegraph::{Format, Options, Plan, Reason, Refusal, Subject};
use framegraph_passes::gpu_scene::view::Background;
use framegraph_passes::grading::Look;
use framegraph_passes::{PostSettings, Settings};
use framegraph_shaders::layout::Grading;
use framegraph_wgpu::{Gpu, Rounding, StoreRounding};
use std::error::Error;
use tests::compare::compare;

type TestResult = Result<(), Box<dyn Error>>;

/// Returns settings with every effect, so that each is compared.
fn graded(samples: u8, fxaa: bool) -> Settings {
    let grading = Grading { temperature: 0.3, contrast: 1.2, vibrance: 0.7, saturation: 1.3, ..Grading::NEUTRAL };
    let look = Look { grading, ..Look::default() };
    let post = PostSettings { compensation_ev: 0.4, vignette_ev: 1.0, look, ..PostSettings::DEFAULT };
    Settings { samples, fxaa, post, ..Settings::default() }
}

/// Returns the shot with separate post-processing.
fn apart(shot: &Shot) -> Shot {
    Shot { options: Options { inline: false, ..shot.options }, ..*shot }
}

fn with(shot: &Shot, change: impl FnOnce(&mut Settings)) -> Shot {
    let mut shot = *shot;
    change(&mut shot.settings);
    shot
}

/// Returns the reason that a pass was not inlined.
fn refusal(plan: &Plan, pass: &str) -> Option<Refusal> {
    let pass = plan.graph().find_pass(pass)?;
    plan.reasons(Subject::Pass(pass)).find_map(|reason| match reason {
        Reason::NotInlined(_, why) => Some(why),
        _ => None,
    })
}

/// Returns the number of texels that differ in any of four channels.
fn differing(a: &[u8], b: &[u8]) -> usize {
    a.chunks_exact(4).zip(b.chunks_exact(4)).filter(|(a, b)| a != b).count()
}

fn rounding_of(gpu: &Gpu) -> Result<StoreRounding, Box<dyn Error>> {
    Ok(StoreRounding::measure(gpu)?)
}

/// Color, sky and clear value use the same functions: with rounding, the pictures are bit-exact.
#[test]
fn at_one_sample_with_rounding_the_picture_is_the_same_to_the_bit() -> TestResult {
    let Some(gpu) = gpu("at_one_sample_with_rounding_the_picture_is_the_same_to_the_bit") else { return Ok(()) };
    let stored = rounding_of(&gpu)?;
    for (scene, background, fxaa, hdr_format) in [
        ("spheres", Background::Environment, false, Format::Rgba16Float),
        ("spheres", Background::None, true, Format::Rgba16Float),
        ("columns", Background::Environment, true, Format::Rgba16Float),
        ("columns", Background::None, false, Format::Rg11b10Ufloat),
    ] {
        if stored.of(hdr_format).is_none() {
            test_report::skip("inline, Rg11b10Ufloat", "the device cannot draw into it");
            continue;
        }
        let shot = Shot::small(Settings { hdr_format, stored: Some(stored), ..graded(1, fxaa) });
        let set = Set::new(&gpu, scene, &shot, &background)?;
        let (inlined, plan) = set.shoot(&gpu, &shot)?;
        let (expected, two) = set.shoot(&gpu, &apart(&shot))?;
        let told = format!("{scene}, {hdr_format:?}, fxaa {fxaa}");
        assert_eq!((plan.counts().inlined, two.counts().inlined), (1, 0), "{told}");
        assert_eq!(differing(&inlined, &expected), 0, "{told}");

        // Negative controls: without rounding, and with another rounding, some texel differs.
        let (exact, _) = set.shoot(&gpu, &with(&shot, |s| s.stored = None))?;
        assert!(differing(&exact, &expected) > 0, "{told}: rounding makes no difference");
        let other = |r| if r == Rounding::Nearest { Rounding::TowardZero } else { Rounding::Nearest };
        let wrong =
            StoreRounding { rgba16float: other(stored.rgba16float), rg11b10ufloat: stored.rg11b10ufloat.map(other) };
        let (wrong, _) = set.shoot(&gpu, &with(&shot, |s| s.stored = Some(wrong)))?;
        assert!(differing(&wrong, &expected) > 0, "{told}: the way of rounding makes no difference");
    }
    Ok(())
}

/// Without rounding, the epilogue uses f32 where the texture has 11 bits: a relative difference of at most 2⁻¹⁰. At the
/// steepest part of the curves, this is less than one 8-bit step. FXAA uses thresholds and can amplify it.
#[test]
fn at_one_sample_without_rounding_the_picture_is_the_same_to_a_code() -> TestResult {
    let Some(gpu) = gpu("at_one_sample_without_rounding_the_picture_is_the_same_to_a_code") else { return Ok(()) };
    for scene in ["spheres", "columns"] {
        let shot = Shot::small(Settings { fxaa: false, ..Settings::default() });
        let set = Set::new(&gpu, scene, &shot, &Background::Environment)?;
        let ((inlined, _), (expected, _)) = (set.shoot(&gpu, &shot)?, set.shoot(&gpu, &apart(&shot))?);
        let difference = compare(&inlined, &expected).ok_or("two pictures")?;
        assert!(difference.largest_codes <= 1, "{scene}: {difference:?}");

        let wrong = set.shoot(&gpu, &with(&shot, |s| s.post.compensation_ev = 0.05))?.0;
        let difference = compare(&wrong, &expected).ok_or("two pictures")?;
        assert!(difference.largest_codes > 1, "the control, a twentieth of a stop: {difference:?}");
    }
    Ok(())
}

/// Five passes of one effect each form one epilogue, bit-exact with all effects in one pass. With rounding, they are
/// bit-exact with five full-screen passes and textures in between.
#[test]
fn a_chain_of_passes_is_one_epilogue() -> TestResult {
    let Some(gpu) = gpu("a_chain_of_passes_is_one_epilogue") else { return Ok(()) };
    let stored = rounding_of(&gpu)?;
    for samples in [1, 4] {
        let whole = Shot::small(graded(samples, false));
        let set = Set::new(&gpu, "spheres", &whole, &Background::Environment)?;
        let split = with(&whole, |s| s.split_post = true);
        let ((one, _), (chain, plan)) = (set.shoot(&gpu, &whole)?, set.shoot(&gpu, &split)?);
        let counts = plan.counts();
        assert_eq!((counts.inlined, counts.steps, counts.multisample_resolves), (5, 2, u32::from(samples == 4)));
        assert_eq!(differing(&one, &chain), 0, "{samples} samples");
        if samples == 1 {
            let rounded = with(&split, |s| s.stored = Some(stored));
            let ((chain, _), (five, plan)) = (set.shoot(&gpu, &rounded)?, set.shoot(&gpu, &apart(&split))?);
            assert_eq!((plan.counts().inlined, plan.counts().steps), (0, 7));
            assert_eq!(differing(&chain, &five), 0);
            assert!(differing(&one, &five) > 0, "the control: textures in between make a difference");
        }
    }
    Ok(())
}

/// Blending must happen before grading.
#[test]
fn a_scene_that_blends_falls_back() -> TestResult {
    let Some(gpu) = gpu("a_scene_that_blends_falls_back") else { return Ok(()) };
    for samples in [1, 4] {
        let shot = Shot::small(Settings { samples, ..Settings::default() });
        let set = Set::new(&gpu, "materials", &shot, &Background::Environment)?;
        let ((picture, plan), (expected, _)) = (set.shoot(&gpu, &shot)?, set.shoot(&gpu, &apart(&shot))?);
        assert_eq!((plan.counts().inlined, refusal(&plan, "post")), (0, Some(Refusal::Blends)));
        assert_eq!(differing(&picture, &expected), 0);

        // A wrong declaration is rejected with a message instead of grading in the wrong order.
        let (frame, io) = crate::stage::declared(&shot.settings);
        let told = set.render(&gpu, &frame, io.output, &shot.options).map(|_| ()).map_err(|e| e.to_string());
        let told = told.err().unwrap_or_default();
        assert!(told.contains("`color`") && told.contains("Settings::blended"), "{told}");
        set.render(&gpu, &frame, io.output, &apart(&shot).options)?;
    }
    Ok(())
}

/// With another reader of the radiance, or without inlining, there are two steps and the same picture.
#[test]
fn other_readers_and_the_switch_keep_it_apart() -> TestResult {
    let Some(gpu) = gpu("other_readers_and_the_switch_keep_it_apart") else { return Ok(()) };
    let shot = Shot::small(Settings { samples: 1, ..Settings::default() });
    let set = Set::new(&gpu, "spheres", &shot, &Background::Environment)?;
    let (expected, off) = set.shoot(&gpu, &apart(&shot))?;
    let (mut frame, io) = crate::stage::declared(&shot.settings);
    frame.graph_mut().readback(io.hdr)?;
    let (picture, read) = set.render(&gpu, &frame, io.output, &shot.options)?;
    assert_eq!((off.counts().inlined, read.counts().inlined), (0, 0));
    assert_eq!(refusal(&read, "post"), Some(Refusal::NeededAsTexture));
    assert_eq!(differing(&picture, &expected), 0);
    Ok(())
}
