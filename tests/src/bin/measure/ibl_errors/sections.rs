//! Tables of the program. Each function prints one and returns whether its negative control was detected.

use framegraph_passes::light::ibl::cache::Cache;
use framegraph_passes::light::ibl::{DfgSettings, DfgTable, IblSettings, ImageLight};
use framegraph_passes::{Quality, Shading};
use framegraph_scene::environment::{Sh, ShBands, ShWindow, Sky};
use framegraph_scene::{Environment, progress};
use framegraph_shader_mirrors::cases;
use framegraph_shader_mirrors::dfg::Visibility;
use framegraph_wgpu::Gpu;
use std::error::Error;
use std::time::Instant;
use tests::lookup::Mapping;
use tests::measure::furnace::{Compensation, F0};
use tests::measure::harmonics::Scene;
use tests::measure::specular::Feature;
use tests::measure::{albedo, furnace, harmonics, specular};
use tests::mirror;
use truth::albedo::Masking;

type Section = fn(&Gpu) -> Result<bool, Box<dyn Error>>;

/// All sections by name, in the order of the output.
pub const ALL: &[(&str, Section)] = &[
    ("mirrors", mirrors),
    ("harmonics", harmonics_table),
    ("specular", specular_table),
    ("dfg", dfg_table),
    ("furnace", furnace_table),
    ("frame", frame_table),
    ("load", load_table),
];

fn heading(text: &str) {
    program::line(format_args!("\n## {text}\n"));
}

fn percent(share: f64) -> String {
    format!("{:.2} %", 100.0 * share)
}

fn mirrors(gpu: &Gpu) -> Result<bool, Box<dyn Error>> {
    heading("Shader library against its f64 mirrors: 2048 points each, f32");
    program::line("| function | largest difference | of its bound |");
    program::line("| --- | --- | --- |");
    let mut noticed = true;
    let (mut count, mut failed) = (0, 0);
    for case in cases::all() {
        let inputs = case.inputs(2048);
        let results = mirror::results(gpu, case, &inputs)?;
        match case.check(&inputs, &results) {
            Ok(deviation) => program::line(format_args!(
                "| {}::{} | {:.1e} | {} |",
                case.file,
                case.function,
                deviation.absolute,
                percent(deviation.of_bound)
            )),
            Err(disagreement) => {
                failed += 1;
                program::line(format_args!("| {}::{} | {disagreement} | OUTSIDE |", case.file, case.function));
            }
        }
        count += 1;
        // Negative control: every result is off by a tenth and an offset, which no bound may accept.
        let spoilt: Vec<f32> = results.iter().map(|y| y * 1.1 + 0.3).collect();
        noticed &= case.check(&inputs, &spoilt).is_err();
    }
    program::line(format_args!("\n{count} functions, {failed} outside of their bounds"));
    Ok(noticed && failed == 0)
}

fn harmonics_table(_: &Gpu) -> Result<bool, Box<dyn Error>> {
    heading("Spherical harmonics: largest error and lowest value of irradiance, in shares of its peak (design 1.4)");
    program::line("| environment | 2 bands | 3 bands | 5 bands | design: 2, 3, 5 bands |");
    program::line("| --- | --- | --- | --- | --- |");
    let design = ["9.1, .57, .14", "21 −12, 3.5, 1.0", "25 −25, 9.4 −4.0, 5.9 −3.1", "21 −4.2, 7.8, 4.9"];
    let keep = |sh: Sh| sh;
    for (scene, design) in Scene::ALL.into_iter().zip(design) {
        let cells = [ShBands::Two, ShBands::Three, ShBands::Five].map(|bands| {
            let e = harmonics::errors(scene, bands, ShWindow::None, 1500, keep);
            format!("{}, {}", percent(e.worst), percent(e.lowest))
        });
        program::line(format_args!("| {} | {} | {design} |", scene.name(), cells.join(" | ")));
    }
    program::line(
        "\nWindows on the sun delta, three bands (design: Hann 30 %, −4.7 %; sinc 21 %; Laplacian 13.5 %; clamping adds 3.1 %):\n",
    );
    program::line("| window | largest | lowest | clamping adds |");
    program::line("| --- | --- | --- | --- |");
    for window in [ShWindow::None, ShWindow::Hann, ShWindow::Sinc, ShWindow::Laplacian { lambda: 0.01 }] {
        let e = harmonics::errors(Scene::Sun, ShBands::Three, window, 1500, keep);
        program::line(format_args!(
            "| {window:?} | {} | {} | {} |",
            percent(e.worst),
            percent(e.lowest),
            percent(e.clamped)
        ));
    }
    // Negative control: the third band has 2/3 of the cosine's strength, as if it were the second.
    let spoil = |sh: Sh| {
        let scale = |(i, c): (usize, &glam::DVec3)| if i >= 4 { *c * (8.0 / 3.0) } else { *c };
        Sh::from_coefficients(sh.bands(), sh.radiance_coefficients().iter().enumerate().map(scale).collect())
    };
    let right = harmonics::errors(Scene::Sky, ShBands::Three, ShWindow::None, 1500, keep).worst;
    let wrong = harmonics::errors(Scene::Sky, ShBands::Three, ShWindow::None, 1500, spoil).worst;
    program::line(format_args!(
        "\ncontrol: the sky with its third band 8/3 as strong errs by {} instead of {}",
        percent(wrong),
        percent(right)
    ));
    Ok(wrong > 2.0 * right)
}

fn specular_table(gpu: &Gpu) -> Result<bool, Box<dyn Error>> {
    heading(
        "Specular cube: largest error (RMS) of a lookup, in shares of the lobe's peak across the feature (design 1.4)",
    );
    program::line("| feature | texels, levels | r = .1 | .134 | .2 | .293 | .4 | .5 | .7 | 1 |");
    program::line("| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |");
    let roughness = [0.1, 0.133_975, 0.2, 0.292_893, 0.4, 0.5, 0.7, 1.0];
    for feature in [Feature::Uniform, Feature::Edge, Feature::Disc(5.0), Feature::Disc(1.5), Feature::Disc(0.35)] {
        for cube in [[256, 5], [256, 6], [256, 7], [256, 8], [512, 8]] {
            if feature == Feature::Uniform && cube != [256, 5] {
                continue;
            }
            let light = specular::light_of(gpu, feature, 2048, cube)?;
            let mut cells = Vec::new();
            for r in roughness {
                let e = specular::errors(gpu, &light, feature, r, Mapping::Lod, 41)?;
                cells.push(format!("{} ({})", percent(e.worst), percent(e.rms)));
            }
            program::line(format_args!(
                "| {} | {} → {}, {} | {} |",
                feature.name(),
                cube[0],
                cube[0] >> (cube[1] - 1),
                cube[1],
                cells.join(" | ")
            ));
        }
    }
    program::line(
        "\ndesign, interpolation between levels alone: edge 5.4 % at .1; disc of radius 5° 47 % at .4, 26 % at .7; eight levels 1.7 % and 13 %",
    );
    let feature = Feature::Disc(1.5);
    let light = specular::light_of(gpu, feature, 2048, [256, 5])?;
    let right = specular::errors(gpu, &light, feature, 0.2, Mapping::Lod, 41)?.worst;
    let wrong = specular::errors(gpu, &light, feature, 0.2, Mapping::Linear, 41)?.worst;
    program::line(format_args!(
        "control: levels in proportion to roughness err by {} instead of {}",
        percent(wrong),
        percent(right)
    ));
    Ok(wrong > 1.5 * right)
}

fn dfg_table(gpu: &Gpu) -> Result<bool, Box<dyn Error>> {
    heading("DFG tables against a grid of 600 × 300 half vectors at 400 points, n·v > .05, r > .089 (design 1.3)");
    program::line("| table | albedo f0 = 1 | RMS | Fresnel part | 1/E | cloth | lowest E | design: max, RMS, 1/E |");
    program::line("| --- | --- | --- | --- | --- | --- | --- | --- |");
    let design = |texels| match texels {
        32 => ".013, .0022, .094",
        64 => ".0057, .0005, .036",
        _ => ".0022, .0002, .014",
    };
    let table = |texels, visibility| {
        DfgTable::new(gpu, DfgSettings { texels, visibility }, &Cache::off(), &mut progress::silent)
    };
    for (visibility, masking) in [(Visibility::Exact, Masking::Smith), (Visibility::Fast, Masking::Hammon)] {
        for texels in [32, 64, 128] {
            let e = albedo::errors(gpu, &table(texels, visibility)?, masking, 400)?;
            program::line(format_args!(
                "| {visibility:?} {texels}² | {:.4} | {:.5} | {:.4} | {:.4} | {:.4} | {:.4} | {} |",
                e.albedo,
                e.albedo_rms,
                e.fresnel,
                e.compensation,
                e.cloth,
                e.lowest,
                design(texels)
            ));
        }
    }
    let wrong = albedo::errors(gpu, &table(128, Visibility::Fast)?, Masking::Smith, 100)?;
    program::line(format_args!("\ncontrol: the fast table judged as the exact one errs by {:.4}", wrong.albedo));
    Ok(wrong.albedo > 0.05)
}

fn furnace_table(gpu: &Gpu) -> Result<bool, Box<dyn Error>> {
    heading("White furnace: relative error against a random walk, 60 points, 60 000 paths each (design 1.3)");
    let settings = DfgSettings::default();
    let table = DfgTable::new(gpu, settings, &Cache::off(), &mut progress::silent)?;
    program::line(format_args!("| compensation | {} |", F0.map(|f0| format!("f0 = {f0}")).join(" | ")));
    program::line("| --- | --- | --- | --- | --- | --- |");
    let mut means = Vec::new();
    for (compensation, design) in [
        (Compensation::None, ["17.9 −69", "16.7 −66", "12.8 −51", "8.4 −33", "4.5 −12"]),
        (Compensation::Table, ["0 0", ".5 +4.7", "1.6 +14.5", "2.1 +13", "3.4 −8"]),
    ] {
        let errors = furnace::errors(gpu, &table, compensation, 60_000)?;
        let cell = |e: &furnace::Errors| format!("{}, {}", percent(e.mean), percent(e.worst));
        program::line(format_args!(
            "| {compensation:?} | {} |",
            errors.iter().map(cell).collect::<Vec<_>>().join(" | ")
        ));
        program::line(format_args!("| design | {} |", design.join(" | ")));
        means.push(errors[0].mean);
    }
    program::line(format_args!("\ncontrol: without compensation a perfect conductor loses {}", percent(means[0])));
    Ok(means[0] > 0.1 && means[1] < 0.002)
}

fn frame_table(gpu: &Gpu) -> Result<bool, Box<dyn Error>> {
    heading("White furnace through the standard frame: 300 cards, relative error against the same walk");
    program::line(format_args!("| shading | compensation | {} |", F0.map(|f0| format!("f0 = {f0}")).join(" | ")));
    program::line("| --- | --- | --- | --- | --- | --- | --- |");
    let truth = furnace::truth(60_000);
    let row = |name: &str, shading: Shading| -> Result<[f64; 2], Box<dyn Error>> {
        let mut worst = [0.0; 2];
        for (slot, compensate_image) in worst.iter_mut().zip([true, false]) {
            let errors = furnace::frame_errors(gpu, &Shading { compensate_image, ..shading }, &truth)?;
            let cell = |e: &furnace::Errors| format!("{}, {}", percent(e.mean), percent(e.worst));
            let cells = errors.iter().map(cell).collect::<Vec<_>>().join(" | ");
            program::line(format_args!("| {name} | {} | {cells} |", if compensate_image { "on" } else { "off" }));
            *slot = errors[0].worst.abs();
        }
        Ok(worst)
    };
    let high = row("high", Quality::High.shading())?;
    let low = row("low", Quality::Low.shading())?;
    let filament = Shading { table: Visibility::Exact, ..Quality::Low.shading() };
    row("low with the exact term's table, as Filament", filament)?;
    // Image-based light uses the table alone, so only direct lights show a mismatch; the furnace test shows the table
    // itself.
    program::line(format_args!("\ncontrol: without compensation a perfect conductor loses up to {}", percent(high[1])));
    Ok(high[0] < 0.002 && low[0] < 0.002 && high[1] > 0.5 && low[1] > 0.5)
}

fn load_table(gpu: &Gpu) -> Result<bool, Box<dyn Error>> {
    heading("Loading: the file, the light, the DFG table; first time and from the cache");
    let Some(assets) = tests::files::asset("load_table", "hdri") else { return Ok(true) };
    let folder = std::env::temp_dir().join(format!("ibl-errors-{}", std::process::id()));
    let cache = Cache::at(&folder);
    program::line("| map | file ms | light ms | DFG ms | from the cache: light ms | DFG ms | warnings |");
    program::line("| --- | --- | --- | --- | --- | --- | --- |");
    let since = |start: Instant| format!("{:.0}", start.elapsed().as_secs_f64() * 1e3);
    for name in ["park.hdr", "park_negative.exr", "sunset.hdr", "studio.hdr", "venice.hdr", "sky of 4096×2048"] {
        let start = Instant::now();
        let environment = if name.contains('.') {
            Environment::load(&assets.join(name), &mut progress::silent)?
        } else {
            Sky::default().environment(4096)?
        };
        let mut cells = vec![since(start)];
        let table = Cache::at(folder.join(name));
        for _ in 0..2 {
            let start = Instant::now();
            let light = ImageLight::new(gpu, &environment, &IblSettings::default(), &cache, &mut progress::silent)?;
            gpu.wait()?;
            cells.push(since(start));
            let start = Instant::now();
            let dfg = DfgTable::new(gpu, DfgSettings::default(), &table, &mut progress::silent)?;
            gpu.wait()?;
            cells.push(since(start));
            assert!(light.warnings.is_empty() && dfg.warnings.is_empty(), "{:?} {:?}", light.warnings, dfg.warnings);
        }
        program::line(format_args!(
            "| {name} | {} | {} |",
            cells.join(" | "),
            environment.warnings.join("; ").rsplit('/').next().unwrap_or_default()
        ));
    }
    std::fs::remove_dir_all(&folder)?;
    Ok(true)
}
