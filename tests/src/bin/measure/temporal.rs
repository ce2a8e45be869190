//! `measure temporal`: flicker, ghosting and popping of options while the camera moves around a scene.

use crate::{Outcome, adapter, no_words};
use framegraph_passes::effects::depth::structure::Resolution;
use framegraph_passes::gpu_scene::shadow_views::ShadowSettings;
use framegraph_passes::light::shading::Quality;
use framegraph_passes::{LightSearch, OcclusionSettings, Settings, TaaSettings, Upscale};
use glam::Vec3;
use tests::lab::record::Rounds;
use tests::lab::studio::{Setup, Studio};
use tests::lab::temporal::temporal;

const FRAMES: u32 = 12;
const SIZE_PX: [u32; 2] = [96, 64];

/// Prints a table for `columns`: 12 frames, 0.01 rad each, against 4 samples with the finest ambient occlusion.
pub fn run(words: &[&str]) -> Outcome {
    no_words(words)?;
    let gpu = adapter()?;
    let studio = Studio::new(&gpu, SIZE_PX, Rounds::QUICK);
    let shadows = ShadowSettings { cascades: 2, local_maps: 0, contact: None, ..ShadowSettings::texels(1024) };
    let mut finest = Settings {
        samples: 4,
        fxaa: false,
        shadows: Some(shadows),
        occlusion: Some(OcclusionSettings::GTAO),
        ..Settings::DEFAULT
    };
    finest.post.dither = 0.0;
    let half = OcclusionSettings { resolution: Resolution::Half, ..OcclusionSettings::SAO };
    let options = [
        ("1 sample", Settings { samples: 1, ..finest }),
        ("FXAA", Settings { samples: 1, fxaa: true, ..finest }),
        ("TAA", Settings { samples: 1, taa: Some(TaaSettings::DEFAULT), ..finest }),
        ("shadow map of 256²", Settings { shadows: Some(ShadowSettings { map_texels: 256, ..shadows }), ..finest }),
        ("SAO at half size", Settings { occlusion: Some(half), ..finest }),
        (
            "half of the width and height",
            Settings { upscale: Some(Upscale { percent: 50, ..Upscale::DEFAULT }), ..finest },
        ),
    ];
    let setup = Setup {
        scene: "columns",
        ev100: 14.5,
        settings: finest,
        light: finest.shading.light(Quality::High),
        lights: LightSearch::default(),
        sun: Some((Vec3::new(0.5, 0.7, 0.5).normalize(), 0.0175)),
    };
    let mut ready = studio.prepare(&setup, SIZE_PX)?;
    let mut sequence = |settings: &Settings| {
        studio.change(&mut ready, settings)?;
        let mut frames = Vec::new();
        for frame in 0..FRAMES {
            ready.turn(&gpu, 0.01 * f64::from(frame))?;
            frames.push(ready.next(&gpu)?);
        }
        Ok::<_, Box<dyn std::error::Error>>(frames)
    };
    let truth = sequence(&finest)?;
    program::line("| option | spatial error, steps | flicker, steps | ghosting, share | popping |");
    program::line("| --- | ---: | ---: | ---: | ---: |");
    for (name, settings) in &options {
        let found = temporal(&sequence(settings)?, &truth)?;
        program::line(format_args!(
            "| {name} | {:.2} | {:.2} | {:.3} | {:.2} |",
            found.spatial, found.flicker, found.ghost, found.pop
        ));
    }
    Ok(true)
}
