//! Table of six scenes under four presets: culled effects, and the cost with and without feature culling.

use super::{Case, Drawn, Easel, SIZE_PX, cases};
use framegraph::{Caps, Options, Scratch};
use framegraph_passes::feature_culling::{Cost, EffectSet, FactMemory, costs};
use framegraph_passes::gpu_scene::shadow_views::{local_layers, local_maps};
use framegraph_passes::gpu_scene::view::Background;
use framegraph_passes::light::sun::has_sun;
use framegraph_passes::{PostSettings, Preset, Settings, World};
use framegraph_wgpu::Gpu;
use std::error::Error;
use std::time::Instant;

/// Size of the planned frames, in pixels. Times are of frames of [`SIZE_PX`].
pub const PLANNED_PX: [u32; 2] = [1920, 1080];
/// Number of frames per time; the minimum counts.
const FRAMES: u32 = 12;

/// Returns the head of the table.
pub fn heads() -> String {
    let names = ["scene", "preset", "asked for", "dropped", "passes", "loads", "stores", "MiB moved", "MiB held", "ms"];
    format!("| {} |\n|{}", names.join(" | "), " --- |".repeat(names.len()))
}

/// Returns the settings of a preset for a case before feature culling, with enough shadow maps for all of the scene's
/// lights.
fn asked(case: &Case, preset: Preset, size_px: [u32; 2]) -> Settings {
    let mut settings = preset.frame().settings.for_scene(&case.scene, size_px);
    if let Some(shadows) = &mut settings.shadows {
        shadows.cascades = if has_sun(&case.scene, None) { shadows.cascades } else { 0 };
        shadows.local_maps = shadows.local_maps.min(local_maps(&case.scene, shadows.cascades));
        shadows.local_layers = local_layers(&case.scene, case.scene.default_camera(1.0).eye, shadows);
    }
    settings.shadows = settings.shadows.filter(|shadows| shadows.layers() > 0);
    let post = PostSettings { look: case.asked.post.look, ..settings.post };
    // All settings share the case's albedo table.
    let shading = framegraph_passes::Shading { table: case.asked.shading.table, ..settings.shading };
    Settings { post, shading, ..settings }
}

/// Returns the rows, with times if `timed`. Each cell has the value without and with feature culling.
///
/// # Errors
/// The device fails.
pub fn rows(gpu: &Gpu, timed: bool) -> Result<Vec<String>, Box<dyn Error>> {
    let mut found = Vec::new();
    for case in cases() {
        let mut drawn = Drawn::new(gpu, case)?;
        for preset in Preset::ALL {
            // Presets share no shaders, so each uses an executor of its own.
            let mut easel = Easel::new(gpu);
            let planned = asked(&drawn.case, preset, PLANNED_PX);
            let facts = drawn.facts(&planned, EffectSet::NONE, &mut FactMemory::default());
            let cost = |settings: &Settings| {
                let options = Options::for_frame(PLANNED_PX[0], PLANNED_PX[1]);
                costs::<World>(settings, &Caps::wgpu(), &options, &mut Scratch::new())
            };
            let (forced, decided) = (cost(&planned)?, cost(&facts.apply(&planned))?);
            let ms = if timed {
                let mut small = asked(&drawn.case, preset, SIZE_PX);
                small.shadows.iter_mut().for_each(|shadows| shadows.map_texels = 256);
                let mut ms = |settings: &Settings| drawn.frames(&mut easel, settings, SIZE_PX, FRAMES).map(|f| f.2);
                let (forced, decided) = (ms(&small)?, ms(&facts.apply(&small))?);
                format!("{forced:.2} → {decided:.2}")
            } else {
                String::new()
            };
            let both = |of: fn(&Cost) -> u64| format!("{} → {}", of(&forced), of(&decided));
            let mebibytes = |of: fn(&Cost) -> u64| {
                let mib = |cost: &Cost| of(cost) as f64 / f64::from(1 << 20);
                format!("{:.1} → {:.1}", mib(&forced), mib(&decided))
            };
            let cells = [
                drawn.case.name.to_owned(),
                preset.name().to_owned(),
                facts.rows.len().to_string(),
                facts.dropped().iter().count().to_string(),
                both(|cost| cost.passes.into()),
                both(|cost| cost.loads.into()),
                both(|cost| cost.stores.into()),
                mebibytes(|cost| cost.moved_bytes),
                mebibytes(|cost| cost.memory_bytes),
                ms,
            ];
            found.push(format!("| {} |", cells.join(" | ")));
        }
    }
    Ok(found)
}

/// Returns the minimum time in ms of an empty frame, and of the finest preset in a scene that needs no effect. The
/// latter includes the time of feature culling in every frame.
///
/// # Errors
/// The device fails.
pub fn bare(gpu: &Gpu) -> Result<(f64, f64), Box<dyn Error>> {
    let [mut case, ..] = cases();
    case.background = Background::None;
    case.asked.post = PostSettings::DEFAULT;
    let ultra = asked(&case, Preset::Ultra, SIZE_PX);
    let shading = framegraph_passes::Quality::Low.shading();
    let nothing = Settings {
        shadows: None,
        fxaa: false,
        shading: framegraph_passes::Shading {
            table: ultra.shading.table,
            visibility: ultra.shading.visibility,
            ..shading
        },
        post: PostSettings { dither: 0.0, ..ultra.post },
        ..Settings::DEFAULT
    };
    let (mut drawn, mut easel) = (Drawn::new(gpu, case)?, Easel::new(gpu));
    let size_px = [512, 512];
    let (mut bare_ms, mut decided_ms) = (f64::INFINITY, f64::INFINITY);
    // Frames alternate, so that both see the same load.
    for _ in 0..FRAMES {
        bare_ms = bare_ms.min(drawn.frames(&mut easel, &nothing, size_px, 3)?.2);
        let begun = Instant::now();
        let decided = drawn.facts(&ultra, EffectSet::NONE, &mut FactMemory::default()).apply(&ultra);
        let deciding_ms = begun.elapsed().as_secs_f64() * 1e3;
        decided_ms = decided_ms.min(deciding_ms + drawn.frames(&mut easel, &decided, size_px, 3)?.2);
    }
    Ok((bare_ms, decided_ms))
}
