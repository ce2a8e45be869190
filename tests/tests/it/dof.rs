//! Depth of field: compared with lens discs summed on the CPU; pixels in focus; loads and stores of frames with it.

mod steps;

use crate::bloom::stage::{Image, made};
use crate::lens_document::documented;
use crate::parts::Parts;
use crate::stage::{gpu, plan};
use framegraph::{Caps, Counts, Options, Texture, dump};
use framegraph_passes::effects::depth::structure::Resolution;
use framegraph_passes::effects::dof::depth_of_field;
use framegraph_passes::gpu_scene::view::{ViewSettings, Views};
use framegraph_passes::{CameraView, DofSettings, Handles, Settings, Slot, StageError};
use framegraph_scene::{Camera, Projection};
use framegraph_wgpu::{Frame, Gpu};
use glam::DVec3;
use half::f16;
use std::error::Error;

type TestResult = Result<(), Box<dyn Error>>;

const SIZE: [u32; 2] = [64, 48];
const NEAR_M: f64 = 0.1;

fn parts(gpu: &Gpu) -> Result<Parts, Box<dyn Error>> {
    let moment = ViewSettings {
        camera: Camera::look_at(DVec3::ZERO, DVec3::NEG_Z, DVec3::Y, Projection::perspective(0.9, NEAR_M))?,
        size_px: SIZE,
        ev100: 0.0,
        shadows: None,
        ..ViewSettings::default()
    };
    Ok(Parts { views: Views::new(gpu, [CameraView::empty(&moment)])?, ..Parts::default() })
}

/// Returns a lens focused at 4 m, whose circle of confusion has a radius of `radius_px` at infinity.
fn lens(radius_px: f32) -> DofSettings {
    let whole =
        DofSettings { focus_m: 4.0, focal_length_m: Some(0.05), resolution: Resolution::Full, ..DofSettings::DEFAULT };
    // Diameter on the film, in pixels of the picture, with a circle-of-confusion scale of 1.
    let diameter = 0.05 / 2.8 * 0.05 / (4.0 - 0.05) / 0.024 * SIZE[1] as f32;
    DofSettings { scale: 2.0 * radius_px / diameter, ..whole }
}

/// Returns the radius of the circle of confusion at a distance, in pixels; negative in front of the focus.
fn radius(radius_px: f64, distance_m: f64) -> f64 {
    let radius = radius_px * (1.0 - 4.0 / distance_m);
    if radius.abs() < 1.0 { 0.0 } else { radius.clamp(-32.0, 32.0) }
}

/// Draws a picture with depths `distance_m` through a lens.
fn shoot(
    gpu: &Gpu,
    image: &Image,
    distance_m: impl Fn(u32, u32) -> f64,
    settings: &DofSettings,
) -> Result<Image, Box<dyn Error>> {
    // Reversed depth of an infinite projection, in half floats: distances are powers of two times the near plane.
    let depth = Image::from_fn(SIZE, |x, y| DVec3::splat(NEAR_M / distance_m(x, y)));
    let declare = |frame: &mut Frame<Parts>, [hdr, depth]: [Texture; 2]| -> Result<Texture, StageError> {
        let mut handles = Handles::default().with(Slot::HDR, hdr).with(DEPTH, depth);
        depth_of_field(frame, &mut handles, settings, SIZE)?;
        handles.get(Slot::HDR)
    };
    Ok(made(gpu, &parts(gpu)?, [image, &depth], declare)?.0)
}

/// Slot of a picture that is used as depth.
const DEPTH: Slot = Slot::new(Slot::DEPTH.name, framegraph_passes::stages::Holds::ColorSamples);

/// Compares pictures of random depths with the CPU. Textures between steps have half floats, which a driver may
/// truncate. Truncation alone causes a mean difference of 0.0005 to 0.0014, and 0.0018 with rings behind the focus, which
/// compare distances. Seven of nine mutants of the gather pass exceed the limits, by factors of 1.04 to 40.
#[test]
fn pictures_are_those_of_the_steps_on_the_cpu() -> TestResult {
    let Some(gpu) = gpu("pictures_are_those_of_the_steps_on_the_cpu") else { return Ok(()) };
    let random = |x: i64, y: i64, salt: i64| {
        let mixed = ((x * 7919 + y * 104_729 + salt * 1_299_709) as u64).wrapping_mul(0x9E37_79B9_7F4A_7C15);
        (mixed >> 40) as f64 / (1u64 << 24) as f64
    };
    let image = Image::from_fn(SIZE, |x, y| {
        DVec3::from_array([1, 2, 3].map(|salt| 3.0 * random(x.into(), y.into(), salt).powi(3)))
    })
    .rounded();
    // Focus distance divided by distance: patches of eight pixels before and behind the focus, and all pixels on one
    // side.
    let mixed = |x: i64, y: i64| f64::exp2((random(x / 8, y / 8, 9) * 4.0).floor() - 2.0);
    let before = |x: i64, y: i64| 1.25 + (random(x / 8, y / 8, 9) * 4.0).floor() / 4.0;
    let behind = |x: i64, y: i64| (random(x / 8, y / 8, 9) * 4.0).floor() / 8.0;
    let even = |_: i64, _: i64| 0.25;
    let places: [(&dyn Fn(i64, i64) -> f64, f64); 4] =
        [(&mixed, 0.0018), (&before, 0.0018), (&behind, 0.0025), (&even, 0.0018)];
    for (index, (per_focus, most)) in places.into_iter().enumerate() {
        for (resolution, rings, median, radius_px) in [
            (Resolution::Full, [5, 5, 5], true, 6.0),
            (Resolution::Full, [3, 4, 6], false, 12.0),
            (Resolution::Half, [4, 3, 4], true, 9.0),
            (Resolution::Half, [6, 5, 3], false, 20.0),
            (Resolution::Full, [3, 3, 3], false, 2.0),
        ] {
            let [rings_before, rings_behind, rings_even] = rings;
            let settings =
                DofSettings { resolution, rings_before, rings_behind, rings_even, median, ..lens(radius_px) };
            let ours = shoot(&gpu, &image, |x, y| 4.0 / per_focus(x.into(), y.into()), &settings)?;
            // Depth as rounded by half floats.
            let held = |x: i64, y: i64| f16::from_f64(NEAR_M * per_focus(x, y) / 4.0).to_f64() / NEAR_M * 4.0;
            let shot =
                steps::Shot { image: &image, per_focus: &held, radius_px: radius_px.into(), settings: &settings };
            let truth = shot.develop();
            let apart = ours.texels.iter().zip(&truth.texels).map(|(a, b)| (*a - *b).abs().max_element());
            let mean = apart.sum::<f64>() / truth.texels.len() as f64;
            assert!(mean < most, "depths {index}, {settings:?}: off by {mean} of a radiance of 0 to 3");
        }
    }
    Ok(())
}

/// Returns waves with periods of at least 20 pixels and a contrast of at most 2 to 1.
fn smooth() -> Image {
    Image::from_fn(SIZE, |x, y| {
        let wave = |x: f64| 1.5 + 0.5 * (x * std::f64::consts::TAU / 20.0).sin();
        DVec3::new(wave(x.into()), wave(y.into()), wave(f64::from(x + y) * 0.7))
    })
    .rounded()
}

/// Averages over a disc around each pixel, as a lens blurs a wall, with sixteen samples per texel.
fn disc(image: &Image, radius: f64) -> Image {
    let reach = radius.ceil() as i64 + 1;
    Image::from_fn(image.size, |x, y| {
        let (mut sum, mut whole) = (DVec3::ZERO, 0.0);
        for (i, j) in (-reach..=reach).flat_map(|i| (-reach..=reach).map(move |j| (i, j))) {
            let inside = |k: i32| {
                let at = |side: i64, k: i32| side as f64 + (f64::from(k) + 0.5) / 4.0 - 0.5;
                at(i, k % 4).hypot(at(j, k / 4)) <= radius
            };
            let weight = (0..16).filter(|k| inside(*k)).count() as f64;
            sum += image.at(i64::from(x) + i, i64::from(y) + j) * weight;
            whole += weight;
        }
        sum / whole
    })
}

/// Returns the root mean square difference away from the border, relative to the mean.
fn rms(ours: &Image, truth: &Image) -> f64 {
    let inner = |i: &usize| {
        let (x, y) = (*i as u32 % SIZE[0], *i as u32 / SIZE[0]);
        (12..SIZE[0] - 12).contains(&x) && (12..SIZE[1] - 12).contains(&y)
    };
    let all: Vec<usize> = (0..truth.texels.len()).filter(inner).collect();
    let squares: f64 = all.iter().map(|i| (ours.texels[*i] - truth.texels[*i]).length_squared() / 3.0).sum();
    (squares / all.len() as f64).sqrt() / truth.mean().element_sum() * 3.0
}

/// A wall before or behind the focus, at full or half resolution, compared with averages over discs. A disc is sampled
/// by rings; median and noise leave some percent of the waves' contrast of a third.
#[test]
fn walls_are_blurred_by_discs() -> TestResult {
    let Some(gpu) = gpu("walls_are_blurred_by_discs") else { return Ok(()) };
    let image = smooth();
    for (distance_m, resolution) in
        [(1e6, Resolution::Full), (1e6, Resolution::Half), (1.6, Resolution::Full), (8.0, Resolution::Full)]
    {
        let settings = DofSettings { resolution, ..lens(8.0) };
        let ours = shoot(&gpu, &image, |_, _| distance_m, &settings)?;
        let truth = disc(&image, radius(8.0, distance_m).abs());
        let (off, sharp) = (rms(&ours, &truth), rms(&image, &truth));
        documented(&format!("a wall at {distance_m} m, {resolution:?}"), off);
        assert!(off < 0.02 && off < 0.25 * sharp, "{distance_m} m, {resolution:?}: off by {off}, sharp by {sharp}");
    }
    Ok(())
}

/// Renders a near wall over the left half of a far one, by tracing rays through points of the aperture.
fn two_walls([near, far]: [&Image; 2], distances: [f64; 2], radius_px: f64) -> Image {
    const RAYS: u32 = 2048;
    let radii = distances.map(|distance_m| radius(radius_px, distance_m));
    Image::from_fn(SIZE, |x, y| {
        let ray = |i: u32| {
            // Sunflower sampling fills the disc uniformly.
            let (r, angle) = (((f64::from(i) + 0.5) / f64::from(RAYS)).sqrt(), f64::from(i) * 2.399963);
            let at = |radius: f64| (f64::from(x) + radius * r * angle.cos(), f64::from(y) + radius * r * angle.sin());
            let texel = |image: &Image, (x, y): (f64, f64)| image.at(x.round() as i64, y.round() as i64);
            if at(radii[0]).0 < 31.5 { texel(near, at(radii[0])) } else { texel(far, at(radii[1])) }
        };
        (0..RAYS).map(ray).sum::<DVec3>() / f64::from(RAYS)
    })
}

/// At an edge, the picture does not contain the occluded background, and opposite samples approximate it.
#[test]
fn edges_are_near_what_rays_through_the_lens_see() -> TestResult {
    let Some(gpu) = gpu("edges_are_near_what_rays_through_the_lens_see") else { return Ok(()) };
    let [near, far] = [0.3, 2.0].map(|scale| {
        let waves = smooth();
        Image { texels: waves.texels.iter().map(|c| *c * scale).collect(), ..waves }.rounded()
    });
    let image = Image::from_fn(SIZE, |x, y| (if x < 32 { &near } else { &far }).at(x.into(), y.into()));
    for (distances, resolution) in [
        ([1.6, 4.0], Resolution::Full),
        ([1.6, 4.0], Resolution::Half),
        ([4.0, 1e6], Resolution::Full),
        ([1.6, 1e6], Resolution::Half),
    ] {
        let settings = DofSettings { resolution, ..lens(6.0) };
        let ours = shoot(&gpu, &image, |x, _| if x < 32 { distances[0] } else { distances[1] }, &settings)?;
        let truth = two_walls([&near, &far], distances, 6.0);
        let (off, sharp) = (rms(&ours, &truth), rms(&image, &truth));
        documented(&format!("walls at {} m and {} m, {resolution:?}", distances[0], distances[1]), off);
        assert!(off < 0.4 * sharp, "{distances:?} m, {resolution:?}: off by {off}, sharp by {sharp}");
    }
    Ok(())
}

/// Two walls in front of the focus at full resolution: the nearer one covers the other. The passes know neither the
/// occluded background nor more than two layers. For two walls behind the focus, they are hardly better than the sharp
/// picture (0.115 and 0.127).
#[test]
fn walls_on_one_side_of_focus_are_near_what_rays_see() -> TestResult {
    let Some(gpu) = gpu("walls_on_one_side_of_focus_are_near_what_rays_see") else { return Ok(()) };
    let [near, far] = [[0.2, 1.0, 0.1], [1.0, 0.1, 0.4]].map(|color| {
        let color = DVec3::from_array(color);
        Image::from_fn(SIZE, |_, _| color).rounded()
    });
    let image = Image::from_fn(SIZE, |x, y| (if x < 32 { &near } else { &far }).at(x.into(), y.into()));
    let settings = DofSettings { median: false, ..lens(8.0) };
    let ours = shoot(&gpu, &image, |x, _| if x < 32 { 1.6 } else { 2.4 }, &settings)?;
    let truth = two_walls([&near, &far], [1.6, 2.4], 8.0);
    let (off, sharp) = (rms(&ours, &truth), rms(&image, &truth));
    // A sixth of the blur's effect, plus the unknown background.
    assert!(off < 0.25 * sharp, "off by {off}, sharp by {sharp}");
    Ok(())
}

/// Pixels in focus keep their bits, also next to blurred ones, and a blurred point keeps its total light.
#[test]
fn what_is_in_focus_stays() -> TestResult {
    let Some(gpu) = gpu("what_is_in_focus_stays") else { return Ok(()) };
    let image = smooth();
    assert!(shoot(&gpu, &image, |_, _| 4.0, &lens(16.0))? == image);
    // Radii below one pixel change nothing.
    assert!(shoot(&gpu, &image, |_, _| 4.2, &lens(16.0))? == image);
    // A blurred far wall does not change a near one in focus, away from the edge.
    let edge = shoot(&gpu, &image, |x, _| if x < 32 { 4.0 } else { 1e6 }, &lens(6.0))?;
    let left = |image: &Image| {
        (0..48).flat_map(|y| (0..24).map(move |x| (x, y))).map(|(x, y)| image.at(x, y)).collect::<Vec<_>>()
    };
    let apart = left(&edge).into_iter().zip(left(&image)).map(|(a, b)| (a - b).abs().max_element()).fold(0.0, f64::max);
    assert!(apart < 1e-3, "{apart}");
    let dot = Image::from_fn(SIZE, |x, y| {
        DVec3::splat(if (30..34).contains(&x) && (22..26).contains(&y) { 8.0 } else { 0.0 })
    });
    let spread = shoot(&gpu, &dot, |_, _| 1e6, &DofSettings { median: false, ..lens(6.0) })?;
    let share = spread.mean().x / dot.mean().x;
    assert!((0.9..1.1).contains(&share), "{share}");
    Ok(())
}

/// An anamorphic lens blurs a point into an ellipse of this width and height, at the same light. A circle is the negative
/// control.
#[test]
fn a_squeezed_point_is_an_ellipse() -> TestResult {
    let Some(gpu) = gpu("a_squeezed_point_is_an_ellipse") else { return Ok(()) };
    let dot = Image::from_fn(SIZE, |x, y| {
        DVec3::splat(if (30..34).contains(&x) && (22..26).contains(&y) { 8.0 } else { 0.0 })
    });
    // Standard deviation of the light from the middle along both axes, without that of the sharp point.
    let spread = |image: &Image| {
        let pixels = || (0..SIZE[1]).flat_map(|y| (0..SIZE[0]).map(move |x| (x, y)));
        let of = |(x, y): (u32, u32)| image.at(x.into(), y.into()).x;
        let whole: f64 = pixels().map(of).sum();
        let along = |middle: f64, axis: fn((u32, u32)) -> u32| {
            let variance: f64 = pixels().map(|at| of(at) * (f64::from(axis(at)) + 0.5 - middle).powi(2)).sum();
            (variance / whole - 1.25).max(0.0).sqrt()
        };
        (along(32.0, |(x, _)| x) / along(24.0, |(_, y)| y), whole)
    };
    let mut whole = None;
    for squeeze in [0.5, 1.0, 2.0] {
        let settings = DofSettings { median: false, squeeze, ..lens(8.0) };
        let (ratio, light) = spread(&shoot(&gpu, &dot, |_, _| 1e6, &settings)?);
        assert!((ratio / f64::from(squeeze) - 1.0).abs() < 0.1, "{squeeze}: {ratio}");
        let circle = *whole.get_or_insert(light);
        assert!((light / circle - 1.0).abs() < 0.1, "{squeeze}: {light} for {circle}");
    }
    Ok(())
}

/// No circle is larger than 32 pixels, and every pixel is finite: at depth 0 and 1, and for a focus distance below the
/// focal length.
#[test]
fn hard_case_54_pictures_stay_finite() -> TestResult {
    let Some(gpu) = gpu("hard_case_54_pictures_stay_finite") else { return Ok(()) };
    let image = smooth();
    for focus_m in [0.0, 0.05, 0.05 + 1e-7] {
        let settings = DofSettings { focus_m, f_number: 0.5, ..lens(8.0) };
        let ours = shoot(&gpu, &image, |x, _| if x < 20 { f64::INFINITY } else { NEAR_M }, &settings)?;
        let bounded = |c: &DVec3| c.is_finite() && c.min_element() >= 0.0 && c.max_element() <= 2.01;
        assert!(ours.texels.iter().all(bounded), "{focus_m}");
    }
    Ok(())
}

const FRAME: [u32; 2] = [1920, 1080];

fn planned(dof: Option<DofSettings>, samples: u8) -> framegraph::Plan {
    let settings = Settings { dof, samples, size_texels: FRAME, ..Settings::DEFAULT };
    plan(&settings, &Caps::wgpu(), &Options::for_frame(FRAME[0], FRAME[1]))
}

/// step              attachment    load       store
/// prepass + color   hdr           clear      STORE   (coc and combine read it)
///                   depth         clear      STORE   (coc reads it)
/// dof/coc           field 0       don't care STORE
/// dof/level ×3      field i       don't care STORE
/// dof/tiles, dof/dilate, dof/gather, dof/median     a STORE each
/// dof/combine + (post)            hdr_focused: stays in the tile, post reads it at the same pixel
///
/// Filament's passes at half resolution store radiance and radius separately, and halve tiles three times. The sum is 2 + 2·2 + 3 +
/// 2 + 2 + 2 + 1 = 16 stores. Ours have 9, and neither loads.
#[test]
fn counts_beside_filaments() {
    let none = planned(None, 1).counts();
    let dof = planned(Some(DofSettings::DEFAULT), 1);
    let found = dof.counts();
    assert_eq!(found.unresolves, 0, "{}", dump::text(&dof));
    assert_eq!(found.passes, none.passes + 9, "{}", dump::text(&dof));
    // Stores of depth, of radiance, and of each of eight passes. Combine is one more unless post-processing joins it.
    let combined = found.resolves - none.resolves - 2;
    assert!((8..=9).contains(&combined), "{}", dump::text(&dof));
    let nothing = DofSettings { scale: 0.0, ..DofSettings::DEFAULT };
    assert_eq!(dump::text(&planned(Some(nothing), 1)), dump::text(&planned(None, 1)));
    let no_median = DofSettings { median: false, ..DofSettings::DEFAULT };
    assert_eq!(
        planned(Some(no_median), 1).counts(),
        Counts {
            resolves: found.resolves - 1,
            steps: found.steps - 1,
            render_passes: found.render_passes - 1,
            passes: found.passes - 1,
            ..found
        }
    );
}
