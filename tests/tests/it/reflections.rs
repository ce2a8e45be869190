//! Screen-space reflections: loads and stores of frames with them, accuracy of hits, and shading.

mod hard;
mod shaded;

use crate::stage::{self, gpu};
use framegraph::{Caps, Counts, Options};
use framegraph_passes::SettingsTable;
use framegraph_passes::effects::depth::structure::Resolution;
use framegraph_passes::effects::reflection::ReflectionSettings;
use framegraph_passes::effects::transmission::scene_levels;
use framegraph_passes::{OcclusionSettings, Settings};
use glam::DVec3;
use std::error::Error;
use tests::measure::reflection::{Found, Stage};
use truth::reflection::{Lens, Room};

type TestResult = Result<(), Box<dyn Error>>;

const FRAME: [u32; 2] = [1920, 1088];
const SIZE: [u32; 2] = [320, 240];

fn counts(settings: Settings) -> Counts {
    stage::plan(&settings, &Caps::wgpu(), &Options::for_frame(FRAME[0], FRAME[1])).counts()
}

/// step                attachment     load       store
/// prepass             depth          clear      STORE
/// structure           level 0        don't care STORE   (rays are followed through it)
/// depth_bounds        level i        don't care STORE   (and so on: a step and a store for each level)
/// reflection          reflections    clear      STORE
///                     ways           clear      STORE   (the color pass reads it)
///                     depth          LOAD       -       (read only)
/// reflection_level    level i        don't care STORE   (and so on for each further level)
/// color               hdr            clear      STORE   (the next frame reads it, and post)
///                     depth          LOAD       discard
/// post                ldr            don't care STORE
/// fxaa                output         don't care STORE
///
/// With four samples the structure is drawn and the reflection pass tests it; the color pass tests its own depth.
///
/// Filament with separate grading and FXAA has more stores, and no load. Five levels of structure have 5 stores,
/// reflections 1, and each of six further levels 2, blurred across and down. Color, grading and FXAA have 3. The stored
/// depth costs one load and one store more than a drawn structure, and the geometry is drawn once less. Loads and stores
/// together are at most one more than Filament's 21.
#[test]
fn stores_are_less_than_filaments() {
    let filaments = 5 + 1 + 2 * 6 + 3;
    for samples in [1, 4] {
        for levels in [1, 4, scene_levels(FRAME)] {
            let further = u32::from(levels) - 1;
            let reflections = Some(ReflectionSettings::DEFAULT);
            let frame =
                Settings { samples, shadows: None, reflections, reflection_levels: levels, ..Settings::DEFAULT };
            let multisampled = u32::from(samples > 1);
            let bounds = (u32::from(levels) - 1).clamp(1, 5);
            let more = further + bounds;
            let expected = Counts {
                unresolves: 2 - multisampled,
                resolves: 7 - multisampled + more,
                clears: 4 + multisampled,
                discards: 1 + multisampled,
                multisample_resolves: multisampled,
                memoryless: 2 * multisampled,
                inlined: 0,
                steps: 6 - multisampled + more,
                render_passes: 6 - multisampled + more,
                passes: 6 - multisampled + more,
                culled: 0,
            };
            let found = counts(frame);
            assert_eq!(found, expected, "{samples} samples, {levels} levels");
            assert!(found.resolves < filaments);
            assert!(found.unresolves + found.resolves <= filaments + 1 - multisampled);
        }
    }
}

/// Ambient occlusion already stores depth and structure, which reflections reuse.
#[test]
fn the_structure_is_shared() {
    let occlusion = Some(OcclusionSettings::SAO);
    let with = |reflections, occlusion| {
        counts(Settings { shadows: None, reflections, occlusion, reflection_levels: 4, ..Settings::DEFAULT }).resolves
    };
    let own = Some(ReflectionSettings::DEFAULT);
    let [none, reflected, occluded, both] = [(None, None), (own, None), (None, occlusion), (own, occlusion)]
        .map(|(reflections, occlusion)| with(reflections, occlusion));
    assert_eq!(both + none + 2, reflected + occluded, "the stores of depth and structure");
}

/// Checks the accuracy of hits: almost all visible reflections are found, the median error is at most one pixel, and
/// there are few false hits.
fn near_the_truth(what: &str, found: Found, [least_hit, median_px, most_px]: [f64; 3]) {
    assert!(found.seen > 1000 && found.empty > 1000, "{what}: there is something to judge: {found:?}");
    assert!(found.hit > least_hit, "{what}: {found:?}");
    assert!(found.off_px[0] < median_px && found.off_px[1] < most_px, "{what}: {found:?}");
    assert!(found.elsewhere < 0.03 && found.made_up < 0.01, "{what}: {found:?}");
}

#[test]
fn rays_find_what_mirrors_show() -> TestResult {
    let Some(gpu) = gpu("rays_find_what_mirrors_show") else { return Ok(()) };
    let settings = ReflectionSettings::DEFAULT;
    let mut stage = Stage::balls(SIZE);
    // Bounds are the measured values times 1.5, since devices round differently.
    let bounds = [
        (Resolution::Full, [0.99, 0.3, 0.85], [0.99, 0.5, 1.8]),
        (Resolution::Half, [0.95, 0.5, 1.6], [0.93, 0.95, 3.5]),
    ];
    for (resolution, of_floor, of_balls) in bounds {
        let [floor, balls] = stage.found(&gpu, &settings, resolution)?;
        near_the_truth("floor", floor, of_floor);
        near_the_truth("balls", balls, of_balls);
    }
    // The previous frame was seen from another position.
    stage.earlier.eye += DVec3::new(0.3, 0.1, -0.2);
    let [floor, _] = stage.found(&gpu, &settings, Resolution::Full)?;
    near_the_truth("floor, moved", floor, bounds[0].1);
    Ok(())
}

/// Grazing rays that leave a floor do not hit that floor.
#[test]
fn flat_rays_do_not_meet_what_they_leave() -> TestResult {
    let Some(gpu) = gpu("flat_rays_do_not_meet_what_they_leave") else { return Ok(()) };
    for height_m in [0.3, 0.05] {
        let lens = Lens {
            eye: DVec3::new(0.0, height_m, 3.0),
            target: DVec3::new(0.3, 0.5 * height_m, 0.0),
            fov_y_rad: 0.7,
            aspect: 4.0 / 3.0,
        };
        let stage = Stage::new(Room { floor_m: 0.0, balls: Vec::new() }, lens, SIZE);
        for text in ["on", "on:bias=0,stride=4"] {
            let settings = ReflectionSettings::from_text(text)?.ok_or("it is on")?;
            for resolution in [Resolution::Full, Resolution::Half] {
                let [floor, _] = stage.found(&gpu, &settings, resolution)?;
                assert!(
                    floor.empty > 10_000 && floor.made_up == 0.0,
                    "{height_m} m, {text}, {resolution:?}: {floor:?}"
                );
            }
        }
    }
    Ok(())
}
