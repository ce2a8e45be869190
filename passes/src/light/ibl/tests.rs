//! Light made, kept, found again, damaged and interrupted.

mod counts;

use std::ops::ControlFlow;
use std::path::PathBuf;

use glam::DVec3;

use super::cache::Cache;
use super::*;
use crate::adapter::working;
use framegraph_scene::environment::{Environment, EquirectMap, ShBands};
use framegraph_scene::progress::{Progress, Stage, silent};
use framegraph_shaders::reference::dfg::Visibility;
use framegraph_wgpu::{Gpu, read_texture};

fn noop() -> Gpu {
    Gpu::noop().expect("the adapter that does nothing is always there")
}

fn folder(name: &str) -> PathBuf {
    std::env::temp_dir().join(format!("light-{name}-{}", std::process::id()))
}

/// Brighter above, with a bright patch.
fn gradient() -> Environment {
    let radiance = |d: DVec3| {
        let patch = if d.dot(DVec3::new(0.6, 0.64, -0.48)) > 0.97 { 30.0 } else { 0.0 };
        DVec3::new(1.0, 1.2, 1.5) * (1.5 + d.y + patch)
    };
    Environment {
        name: "gradient".into(),
        map: EquirectMap::from_fn(128, 64, radiance),
        sun: None,
        filtered: None,
        warnings: Vec::new(),
    }
}

const SMALL: IblSettings = IblSettings {
    cube_texels: 64,
    levels: 5,
    bands: ShBands::Three,
    window: framegraph_scene::environment::ShWindow::None,
    format: EnvironmentFormat::Rg11b10,
};

#[test]
fn steps_are_reported_and_any_of_them_can_be_the_last() {
    let gpu = noop();
    let environment = gradient();
    let mut seen = Vec::new();
    let mut record = |p: Progress<'_>| {
        assert_eq!(p.stage, Stage::Lighting);
        seen.push((p.done, p.total));
        ControlFlow::Continue(())
    };
    ImageLight::new(&gpu, &environment, &SMALL, &Cache::off(), &mut record).expect("noop accepts it");
    // Six faces, their levels, six faces of each of five levels.
    assert_eq!(seen, (1..=37).map(|i| (i, 37)).collect::<Vec<_>>());
    for stop in [1, 7, 37] {
        let mut count = 0;
        let mut until = |_: Progress<'_>| {
            count += 1;
            if count == stop { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        };
        let stopped = ImageLight::new(&gpu, &environment, &SMALL, &Cache::off(), &mut until);
        let error = stopped.map(|_| ()).expect_err("it was told to stop").to_string();
        assert!(error.contains("gradient") && error.contains("interrupted"), "{error}");
        assert_eq!(count, stop, "nothing is done after that");
    }
    let mut stop = |_: Progress<'_>| ControlFlow::Break(());
    assert!(DfgTable::new(&gpu, DfgSettings::default(), &Cache::off(), &mut stop).is_err());
}

#[test]
fn settings_and_sizes_out_of_range_are_errors() {
    let gpu = noop();
    let bad = IblSettings { levels: 3, ..SMALL };
    let error = ImageLight::new(&gpu, &gradient(), &bad, &Cache::off(), &mut silent).expect_err("three levels");
    assert!(error.to_string().contains("levels"), "{error}");
    let bad = DfgSettings { texels: 4096, visibility: Visibility::Exact };
    assert!(DfgTable::new(&gpu, bad, &Cache::off(), &mut silent).is_err());
}

#[test]
fn a_device_that_draws_nothing_leaves_nothing_behind() {
    let folder = folder("noop");
    let cache = Cache::at(&folder);
    ImageLight::new(&noop(), &gradient(), &SMALL, &cache, &mut silent).expect("noop accepts it");
    DfgTable::new(&noop(), DfgSettings::default(), &cache, &mut silent).expect("noop accepts it");
    assert!(!folder.exists());
}

/// The first light is computed, the second found; a damaged entry is said and made anew; another
/// map, other settings and another window are told apart.
#[test]
fn light_is_found_again_and_damage_is_repaired() {
    let Some(gpu) = working("light_is_found_again_and_damage_is_repaired") else { return };
    let folder = folder("found");
    let cache = Cache::at(&folder);
    let environment = gradient();
    let make = |environment: &Environment, settings: &IblSettings| {
        ImageLight::new(&gpu, environment, settings, &cache, &mut silent).expect("a sound environment")
    };
    let first = make(&environment, &SMALL);
    assert_eq!((first.from_cache, first.warnings.len()), (false, 0), "{:?}", first.warnings);
    let again = make(&environment, &SMALL);
    assert_eq!((again.from_cache, again.warnings.len()), (true, 0), "{:?}", again.warnings);
    assert_eq!((first.irradiance, first.texel_nits), (again.irradiance, again.texel_nits));
    assert_eq!((first.luminance_nits, first.dominant_direction), (again.luminance_nits, again.dominant_direction));

    let entry = std::fs::read_dir(&folder).expect("it was made").next().expect("one entry").expect("readable").path();
    let good = std::fs::read(&entry).expect("readable");
    for (damage, word) in [
        (good[..good.len() / 2].to_vec(), "cut short"),
        ([&good[..1000], &[good[1000] ^ 4], &good[1001..]].concat(), "checksum"),
        (Vec::new(), "cut short"),
    ] {
        std::fs::write(&entry, &damage).expect("the folder is ours");
        let repaired = make(&environment, &SMALL);
        assert!(!repaired.from_cache);
        assert!(repaired.warnings.len() == 1 && repaired.warnings[0].contains(word), "{:?}", repaired.warnings);
        assert!(std::fs::read(&entry).expect("readable") == good, "made anew, byte for byte");
    }

    let mut brighter = environment.clone();
    let mut texels = brighter.map.texels().to_vec();
    texels[77][1] += 1e-3;
    brighter.map = EquirectMap::new(128, 64, texels);
    assert!(!make(&brighter, &SMALL).from_cache, "one texel makes another map");
    assert!(!make(&environment, &IblSettings { bands: ShBands::Two, ..SMALL }).from_cache);
    let hann = IblSettings { window: framegraph_scene::environment::ShWindow::Hann, ..SMALL };
    let windowed = make(&environment, &hann);
    assert!(windowed.from_cache, "the window is applied after the cache");
    assert_ne!(windowed.irradiance, first.irradiance);
    assert_eq!(std::fs::read_dir(&folder).expect("there").count(), 3, "no parts are left");
    std::fs::remove_dir_all(folder).expect("the folder is ours");
}

/// Texels that no file loader has seen are clamped and counted, and do not reach the light.
#[test]
fn unsound_texels_are_clamped_and_counted() {
    let mut environment = gradient();
    let mut texels = environment.map.texels().to_vec();
    (texels[5][0], texels[900][1], texels[2000][2]) = (f32::NAN, f32::INFINITY, -7.0);
    environment.map = EquirectMap::new(128, 64, texels);
    let light = ImageLight::new(&noop(), &environment, &SMALL, &Cache::off(), &mut silent).expect("clamped");
    let text = light.warnings.join("; ");
    assert!(text.contains("1 of 8192 texels had negative") && text.contains("2 of 8192 texels were not"), "{text}");
    assert!(light.irradiance.iter().all(|c| c.is_finite()) && light.texel_nits.is_finite());
    let sound = ImageLight::new(&noop(), &gradient(), &SMALL, &Cache::off(), &mut silent).expect("sound");
    assert!(sound.warnings.is_empty());
}

#[test]
fn a_table_is_found_again_for_its_term_alone() {
    let Some(gpu) = working("a_table_is_found_again_for_its_term_alone") else { return };
    let folder = folder("table");
    let cache = Cache::at(&folder);
    let make = |visibility| {
        let settings = DfgSettings { texels: 32, visibility };
        DfgTable::new(&gpu, settings, &cache, &mut silent).expect("a sound size")
    };
    let first = make(Visibility::Exact);
    assert!(!first.from_cache);
    let fast = make(Visibility::Fast);
    assert!(!fast.from_cache, "another term is another table");
    let again = make(Visibility::Exact);
    assert!(again.from_cache);
    let texels = |table: &DfgTable| read_texture(&gpu, table.view.texture()).expect("it may be copied from").bytes;
    assert_eq!(texels(&first), texels(&again));
    assert_ne!(texels(&first), texels(&fast));
    std::fs::remove_dir_all(folder).expect("the folder is ours");
}

/// A cache that cannot be written costs a warning and nothing else.
#[test]
fn a_cache_without_a_place_only_warns() {
    let Some(gpu) = working("a_cache_without_a_place_only_warns") else { return };
    let blocked = folder("blocked");
    std::fs::write(&blocked, b"a file where the folder should be").expect("a temporary file");
    let cache = Cache::at(blocked.join("ibl"));
    let settings = DfgSettings { texels: 16, visibility: Visibility::Exact };
    let table = DfgTable::new(&gpu, settings, &cache, &mut silent).expect("the table itself is fine");
    assert!(!table.from_cache);
    let place = blocked.to_string_lossy().into_owned();
    assert!(!table.warnings.is_empty() && table.warnings.iter().all(|w| w.contains(&place)), "{:?}", table.warnings);
    std::fs::remove_file(blocked).expect("the file is ours");
}
