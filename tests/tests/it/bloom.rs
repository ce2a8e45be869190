//! Bloom and lens flare: compared with a CPU implementation; energy; loads and stores of frames with them.

pub mod stage;
mod truth;

use crate::lens_document::documented;
use crate::parts::Parts;
use crate::stage::{gpu, plan};
use framegraph::{Caps, Counts, Options, Target, Texture, dump};
use framegraph_passes::effects::bloom::bloom;
use framegraph_passes::effects::bloom::{
    Blend, BloomChain, BloomMix, BloomQuality, BloomSettings, FlareSettings, Threshold,
};
use framegraph_passes::effects::post::{Post, PostEffect};
use framegraph_passes::gpu_scene::view::{ViewSettings, Views};
use framegraph_passes::{CameraView, Handles, PostSettings, Settings, Slot, StageError};
use framegraph_scene::{Camera, Projection};
use framegraph_shader_mirrors::flare::starburst;
use framegraph_wgpu::{Frame, Gpu};
use glam::{DVec2, DVec3};
use stage::{Image, made};
use std::error::Error;

type TestResult = Result<(), Box<dyn Error>>;

const SIZE: [u32; 2] = [50, 36];

fn camera() -> Result<Camera, Box<dyn Error>> {
    let ahead = DVec3::new(0.3, 0.1, -1.0);
    Ok(Camera::look_at(DVec3::ZERO, ahead, DVec3::Y, Projection::perspective(1.0, 0.1))?)
}

fn parts(gpu: &Gpu) -> Result<Parts, Box<dyn Error>> {
    let moment =
        ViewSettings { camera: camera()?, size_px: SIZE, ev100: 0.0, shadows: None, ..ViewSettings::default() };
    Ok(Parts { views: Views::new(gpu, [CameraView::empty(&moment)])?, ..Parts::default() })
}

/// Returns dim noise with a bright bar, a brighter dot and a very bright pixel.
fn bright_spots() -> Image {
    let image = Image::from_fn(SIZE, |x, y| {
        let noise = f64::from((x * 37 + y * 101 + x * y * 13) % 64) / 64.0;
        let dim = DVec3::new(noise, 1.2 * noise, 0.5);
        match (x, y) {
            (8..=20, 10..=11) => DVec3::new(6.0, 4.0, 0.5),
            (34..=36, 20..=23) => DVec3::new(20.0, 40.0, 80.0),
            (4, 30) => DVec3::splat(5000.0),
            _ => dim,
        }
    });
    image.rounded()
}

/// Declares the bloom stage for a picture, and returns its outputs.
fn handed(frame: &mut Frame<Parts>, hdr: Texture, settings: &BloomSettings) -> Result<Handles, StageError> {
    let mut handles = Handles::default().with(Slot::HDR, hdr);
    bloom(frame, &mut handles, settings, SIZE)?;
    Ok(handles)
}

fn glow(gpu: &Gpu, parts: &Parts, image: &Image, settings: &BloomSettings) -> Result<Image, Box<dyn Error>> {
    let declare = |frame: &mut Frame<Parts>, [hdr]: [Texture; 1]| handed(frame, hdr, settings)?.get(Slot::BLOOM);
    Ok(made(gpu, parts, [image], declare)?.0)
}

const USUAL: BloomSettings = BloomSettings { height_texels: 30, quality: BloomQuality::High, ..BloomSettings::DEFAULT };
const FLARE: FlareSettings = FlareSettings {
    starburst: false,
    ghost_threshold: 1.0,
    halo_threshold: 0.5,
    halo_radius: 0.15,
    halo_thickness: 0.3,
    aberration: 0.02,
    multiple_px: 1,
    ..FlareSettings::DEFAULT
};

/// Device filters have 8-bit weights, and each of up to seven levels is stored as half floats: 1 % of the brightest
/// value. A missing or wrong kernel differs by several percent.
const BOUND: f64 = 0.01;

#[test]
fn bloom_is_the_sum_that_its_sources_state() -> TestResult {
    let Some(gpu) = gpu("bloom_is_the_sum_that_its_sources_state") else { return Ok(()) };
    let (parts, image) = (parts(&gpu)?, bright_spots());
    let mut worst = 0.0_f64;
    for settings in [
        USUAL,
        BloomSettings { narrow: true, threshold: Threshold::Hard, threshold_at: 3.0, highlight: 20.0, ..USUAL },
        BloomSettings { threshold: Threshold::None, levels: 3, multiple_px: 16, ..USUAL },
        BloomSettings { quality: BloomQuality::Low, ..USUAL },
        // Downsampled twice; or at double size.
        BloomSettings { quality: BloomQuality::Medium, height_texels: 17, levels: 1, ..USUAL },
        BloomSettings { height_texels: 17, levels: 2, ..USUAL },
    ] {
        let (ours, truth) = (glow(&gpu, &parts, &image, &settings)?, truth::glow(&image, &settings));
        let off = ours.off(&truth);
        assert!(off < BOUND, "{settings:?}: off by {off}");
        worst = worst.max(off);
    }
    documented("glow", worst);
    let other = BloomSettings { narrow: true, ..USUAL };
    assert!(glow(&gpu, &parts, &image, &USUAL)?.off(&truth::glow(&image, &other)) > BOUND, "kernels differ");
    Ok(())
}

#[test]
fn flare_is_ghosts_and_a_halo_of_what_glows() -> TestResult {
    let Some(gpu) = gpu("flare_is_ghosts_and_a_halo_of_what_glows") else { return Ok(()) };
    let (parts, image) = (parts(&gpu)?, bright_spots());
    let flare = |flare: FlareSettings| {
        let settings = BloomSettings { flare: Some(flare), ..USUAL };
        let declare = |frame: &mut Frame<Parts>, [hdr]: [Texture; 1]| handed(frame, hdr, &settings)?.get(Slot::FLARE);
        Ok::<_, Box<dyn Error>>(made(&gpu, &parts, [&image], declare)?.0)
    };
    let levels = truth::levels(&image, &USUAL);
    let mut worst = 0.0_f64;
    let centered = FlareSettings { multiple_px: 16, ..FLARE };
    for own in [FLARE, FlareSettings { ghosts: 0, ..FLARE }, FlareSettings { halo_thickness: 0.0, ..FLARE }, centered] {
        let (ours, truth) = (flare(own)?, truth::flare(&levels[0], SIZE, &own));
        assert!(truth.mean().max_element() > 1e-6, "{own:?}: nothing is seen");
        // Bloom's error is BOUND of 80, and thresholds at 1 and 2 shift the edges of ghosts.
        let off = ours.off(&truth);
        assert!(off < 0.01, "{own:?}: off by {off}");
        worst = worst.max(off);
    }
    documented("flare", worst);
    let (whole, rays) = (flare(FLARE)?, flare(FlareSettings { starburst: true, ..FLARE })?);
    let less = whole.texels.iter().zip(&rays.texels).all(|(whole, rays)| rays.cmple(*whole + 1e-3).all());
    assert!(less && rays.mean().max_element() < 0.95 * whole.mean().max_element(), "rays only take");
    // The noise uses a sine that drivers round differently, so it must be closer to the mirror's than to any other
    // rotation's.
    let turn = (camera()?.world_from_view.inverse() * DVec3::Z).element_sum();
    let apart = |turn: f64| {
        let share = |i: usize| {
            let at = DVec2::new((i as u32 % whole.size[0]).into(), (i as u32 / whole.size[0]).into());
            starburst((at + 0.5) / DVec2::new(whole.size[0].into(), whole.size[1].into()), turn)
        };
        let texels = whole.texels.iter().zip(&rays.texels).enumerate();
        texels.map(|(i, (whole, rays))| (*whole * share(i) - *rays).abs().element_sum()).sum::<f64>()
    };
    let (own, other) = (apart(turn), [-0.1, -0.05, 0.05, 0.1].map(|by| apart(turn + by)));
    assert!(other.iter().all(|other| own < 0.5 * other), "off by {own}, and at other turns by {other:?}");
    Ok(())
}

/// Without a threshold, every kernel is an average. No texel of a level is brighter than the picture's maximum, and the total light of a bright pixel on black is preserved. The tolerance is 1/256 of a quarter of each level's weights.
#[test]
fn hard_case_23_bloom_adds_no_energy() -> TestResult {
    let Some(gpu) = gpu("hard_case_23_bloom_adds_no_energy") else { return Ok(()) };
    let parts = parts(&gpu)?;
    let lamp = Image::from_fn(SIZE, |x, y| {
        DVec3::splat(if (24..27).contains(&x) && (17..20).contains(&y) { 9.0 } else { 0.0 })
    });
    let settings = BloomSettings { threshold: Threshold::None, levels: 3, ..USUAL };
    let sum = glow(&gpu, &parts, &lamp, &settings)?;
    let levels = f64::from(BloomChain::new(&settings, SIZE).levels);
    let most = sum.texels.iter().map(|c| c.max_element()).fold(0.0, f64::max) / levels;
    let share = sum.mean().x / levels / lamp.mean().x;
    assert!(most <= 9.0 && (share - 1.0).abs() < 0.01, "{most}, {share}");
    let sifted = glow(&gpu, &parts, &lamp, &BloomSettings { threshold: Threshold::Soft, ..settings })?;
    assert!(sifted.texels.iter().zip(&sum.texels).all(|(less, all)| less.cmple(*all + 1e-3).all()));
    Ok(())
}

/// A NaN or infinite pixel counts as black or as the brightest value, and does not affect other pixels.
#[test]
fn hard_case_23_and_26_what_is_not_finite_does_not_spread() -> TestResult {
    let Some(gpu) = gpu("hard_case_23_and_26_what_is_not_finite_does_not_spread") else { return Ok(()) };
    let (parts, image) = (parts(&gpu)?, bright_spots());
    let with = |value: f64| {
        let mut image = image.clone();
        image.texels[usize::from(SIZE[0] as u16) * 15 + 25] = DVec3::new(value, 0.25, 0.5);
        image
    };
    for threshold in [Threshold::None, Threshold::Soft, Threshold::Hard] {
        let settings = BloomSettings { threshold, ..USUAL };
        for (bad, as_if) in [
            (f64::NAN, 0.0),
            (f64::INFINITY, 4094.0),
            (f64::NEG_INFINITY, 0.0),
            (-0.1, 0.0),
            (65024.0, 4094.0),
            (65504.0, 4094.0),
        ] {
            let (shot, sound) =
                (glow(&gpu, &parts, &with(bad), &settings)?, glow(&gpu, &parts, &with(as_if), &settings)?);
            let finite = shot.texels.iter().all(|c| c.to_array().iter().all(|x| x.to_bits() << 1 < 0x7ff << 53));
            assert!(finite && shot == sound, "{bad} {threshold:?}");
            assert!(shot.texels.iter().all(|c| c.min_element() >= 0.0), "nothing is darker than black");
        }
    }
    Ok(())
}

/// Bloom is blended as stated: with dirt, with flare, additively or by interpolation.
#[test]
fn glow_is_laid_over_the_picture() -> TestResult {
    let Some(gpu) = gpu("glow_is_laid_over_the_picture") else { return Ok(()) };
    let (parts, image) = (parts(&gpu)?, bright_spots());
    let image = Image { texels: image.texels.iter().map(|c| c.min(DVec3::splat(100.0))).collect(), ..image };
    let dust = Image::from_fn([7, 5], |x, y| DVec3::new(f64::from(x % 2), 0.5, f64::from(y) / 4.0)).rounded();
    let wide = |image: &Image, at: usize| {
        let (x, y) = ((at % SIZE[0] as usize) as f64 + 0.5, (at / SIZE[0] as usize) as f64 + 0.5);
        image.sample(x / f64::from(SIZE[0]), y / f64::from(SIZE[1]))
    };
    for (blend, dirt, flare) in
        [(Blend::Add, false, None), (Blend::Interpolate, true, Some(FLARE)), (Blend::Add, true, None)]
    {
        let settings = BloomSettings { strength: 0.8, blend, dirt: 0.7, flare, ..USUAL };
        let declare = |frame: &mut Frame<Parts>, [hdr, dust]: [Texture; 2]| {
            let handles = handed(frame, hdr, &settings)?;
            let mix = BloomMix {
                glow: handles.get(Slot::BLOOM)?,
                levels: BloomChain::new(&settings, SIZE).levels,
                flare: handles.find(Slot::FLARE),
                dirt: dirt.then_some(dust),
                settings,
            };
            let (only, post) = (Some(PostEffect::Bloom), PostSettings::DEFAULT);
            let bloom = Some(mix);
            let pass = Post { hdr, bloom, into: Target::New, settings: post, only, for_fxaa: false, stored: None };
            Ok(frame.add("post", pass)?.ldr)
        };
        let (ours, _) = made(&gpu, &parts, [&image, &dust], declare)?;
        let (levels, sum) = (truth::levels(&image, &settings), truth::glow(&image, &settings));
        let share = 0.8 / levels.len() as f64;
        let flare = flare.map(|own| truth::flare(&levels[0], SIZE, &own));
        let texel = |(at, color): (usize, &DVec3)| {
            let mut added = wide(&sum, at) * share;
            added += flare.as_ref().map_or(DVec3::ZERO, |flare| wide(flare, at) * 0.8);
            added *= if dirt { wide(&dust, at) * 0.7 } else { DVec3::ONE };
            added + *color * if blend == Blend::Add { 1.0 } else { 1.0 - share }
        };
        let truth = Image { size: SIZE, texels: image.texels.iter().enumerate().map(texel).collect() };
        let off = ours.off(&truth);
        assert!(off < BOUND, "{settings:?}: off by {off}");
    }
    Ok(())
}

const FRAME: [u32; 2] = [1920, 1080];

fn counts(bloom: Option<BloomSettings>) -> Counts {
    let settings = Settings { bloom, size_texels: FRAME, ..Settings::DEFAULT };
    plan(&settings, &Caps::wgpu(), &Options::for_frame(FRAME[0], FRAME[1])).counts()
}

/// Bloom without strength or levels declares nothing, so the plan and the picture are unchanged.
#[test]
fn bloom_of_nothing_is_no_bloom() {
    let text = |bloom| {
        let settings = Settings { bloom, size_texels: FRAME, ..Settings::DEFAULT };
        dump::text(&plan(&settings, &Caps::wgpu(), &Options::for_frame(FRAME[0], FRAME[1])))
    };
    let none = text(None);
    assert_eq!(text(Some(BloomSettings { strength: 0.0, ..BloomSettings::DEFAULT })), none);
    assert_eq!(text(Some(BloomSettings { levels: 0, ..BloomSettings::DEFAULT })), none);
    let blooms = text(Some(BloomSettings::DEFAULT));
    assert!(none.contains("pass `post`: inlined into the shader of `color`"), "{none}");
    // The log states why post-processing is a separate pass.
    let why =
        ["store of `hdr` in step 1: stored because `bloom/half` reads it", "pass `post`: not merged with `bloom/up`"];
    assert!(why.iter().all(|why| blooms.contains(why)), "{blooms}");
}

/// step              attachment    load       store
/// prepass + color   hdr           clear      STORE   (bloom and post read it: not inlined)
/// bloom/half        glow          don't care STORE   (1920×1080 to 960×540)
/// bloom/first       glow 0        don't care STORE
/// bloom/down ×5     glow i        don't care STORE
/// bloom/up ×5       glow_sum i    don't care STORE
/// post              ldr           don't care STORE
///
/// Filament's bloom, by its rules, has as many stores, but blends each level into the one above, which costs five
/// loads. A flare adds three stores in both.
#[test]
fn counts_beside_filaments() {
    let none = counts(None);
    let more = |passes: u32| Counts {
        // The radiance is stored for bloom and for post-processing, which becomes a step of its own.
        resolves: none.resolves + 1 + passes,
        steps: none.steps + 1 + passes,
        render_passes: none.render_passes + 1 + passes,
        passes: none.passes + passes,
        inlined: 0,
        ..none
    };
    assert_eq!(counts(Some(BloomSettings::DEFAULT)), more(1 + 1 + 5 + 5));
    assert_eq!(
        counts(Some(BloomSettings { flare: Some(FlareSettings::DEFAULT), ..BloomSettings::DEFAULT })),
        more(12 + 3)
    );
    // One more level instead of half resolution.
    assert_eq!(counts(Some(BloomSettings { quality: BloomQuality::High, ..BloomSettings::DEFAULT })), more(1 + 6 + 6));
    assert_eq!(
        counts(Some(BloomSettings { levels: 1, quality: BloomQuality::High, ..BloomSettings::DEFAULT })),
        more(1 + 1 + 1)
    );
}
