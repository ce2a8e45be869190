//! Renders a scene with Bevy's post-processing and with a graph, and compares pictures, passes, bytes and times.
//!
//! `cargo run --ignore-rust-version --example execute -- [FOLDER] [--samples 1|4] [--size WIDTHxHEIGHT]` writes `bevy.png`,
//! `graph.png` and `graph_letterbox.png` to the folder.

mod support;

use framegraph::Plan;
use framegraph_bevy::observed::{Load, Work};
use framegraph_bevy::{Device, Report, ReportPlugin};
use std::path::Path;
use support::chain::Effects;
use support::pictures::{Difference, write_png};
use support::{Arguments, Scene};

/// Frames before anything is measured.
const WARM_UP: u32 = 6;
/// Measured frames of each way. The ways alternate.
const MEASURED: usize = 9;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let Arguments { folder, samples, size } = Arguments::parse("target/execute")?;
    std::fs::create_dir_all(&folder)?;
    let full = Effects { size, samples, bloom: true, fxaa: true };
    let device = Device::open(None)?;

    println!("| effects | max. difference | mean | channels off by more than 2 |\n| --- | --- | --- | --- |");
    for (name, effects) in [
        ("tone mapping", Effects { bloom: false, fxaa: false, ..full }),
        ("tone mapping, FXAA", Effects { bloom: false, ..full }),
        ("bloom, tone mapping, FXAA", full),
    ] {
        let mut bevy = Scene::new(&device, &effects.of_bevy(), |_| {});
        bevy.frames(&device, WARM_UP);
        let mut graph = effects.executed(&device, false);
        graph.frames(&device, WARM_UP);
        graph.plan()?;
        let pictures = [bevy.picture(&device), graph.picture(&device)];
        let Difference { max, mean, share } = Difference::new(&pictures[0], &pictures[1]);
        println!("| {name} | {max} | {mean:.3} | {:.2} % |", share * 100.0);
        if effects.bloom {
            write_png(&folder.join("bevy.png"), size, &pictures[0])?;
            write_png(&folder.join("graph.png"), size, &pictures[1])?;
            println!();
            compare(&folder, full, &device, bevy, graph)?;
        }
    }
    Ok(())
}

/// Compares passes, bytes and times of the full chain.
fn compare(
    folder: &Path,
    effects: Effects,
    device: &Device,
    mut bevy: Scene,
    mut graph: Scene,
) -> Result<(), Box<dyn std::error::Error>> {
    let own = of_bevy(folder, effects)?;
    let mut bars = effects.executed(device, true);
    bars.frames(device, WARM_UP);
    write_png(&folder.join("graph_letterbox.png"), effects.size, &bars.picture(device))?;
    let [plan, with_bars] = [graph.plan()?, bars.plan()?].map(|plan| of_plan(&plan));
    println!("| post-processing | Bevy | graph | graph and a pass of the user |\n| --- | --- | --- | --- |");
    for (index, name) in
        ["render passes", "loads", "stores", "loaded, KiB", "stored, KiB", "textures but the output, KiB"]
            .iter()
            .enumerate()
    {
        println!("| {name} | {} | {} | {} |", own[index], plan[index], with_bars[index]);
    }
    let mut times = [const { Vec::new() }; 3];
    for _ in 0..MEASURED {
        for (scene, times) in [&mut bevy, &mut graph, &mut bars].into_iter().zip(&mut times) {
            times.push(scene.frames(device, 1));
        }
    }
    let [a, b, c] = times.map(|mut times| {
        times.sort_by(f64::total_cmp);
        times[MEASURED / 2]
    });
    println!("| whole frame, wall time, ms (median of {MEASURED}, in turns) | {a:.1} | {b:.1} | {c:.1} |");
    Ok(())
}

/// Returns the rows of Bevy's own passes after the main pass, from a trace.
fn of_bevy(folder: &Path, effects: Effects) -> Result<[u64; 6], Box<dyn std::error::Error>> {
    let device = Device::open(Some(&folder.join("trace")))?;
    let mut scene = Scene::new(&device, &effects.of_bevy(), |app| {
        app.add_plugins(ReportPlugin);
    });
    scene.frames(&device, WARM_UP + 3);
    let frame = Report::of_trace(&folder.join("trace"), WARM_UP, &device.gpu().caps())?.frame;
    let raster = |pass: &&framegraph_bevy::observed::ObservedPass| pass.work == Work::Raster;
    let posts = |name: &str| ["bloom", "tonemapping", "fxaa", "upscaling"].iter().any(|own| name.starts_with(own));
    let (mut rows, mut written) = ([0; 6], Vec::new());
    for pass in frame.passes.iter().filter(raster).filter(|pass| posts(&pass.name)) {
        rows[0] += 1;
        for own in &pass.attachments {
            let kib = own.bytes(&frame.textures) as f64 / 1024.0;
            rows[1] += u64::from(own.load == Load::Load);
            rows[2] += u64::from(own.stores);
            rows[3] += if own.load == Load::Load { kib as u64 } else { 0 };
            rows[4] += if own.stores { kib as u64 } else { 0 };
            if Some(own.region.texture) != frame.output && !written.contains(&own.region.texture) {
                written.push(own.region.texture);
            }
        }
    }
    rows[5] = written.iter().map(|texture| frame.textures[*texture].desc.bytes([1, 1]) / 1024).sum();
    Ok(rows)
}

/// Returns the rows of a plan.
fn of_plan(plan: &Plan) -> [u64; 6] {
    let (counts, traffic) = (plan.counts(), plan.traffic(plan.frame()));
    [
        counts.render_passes.into(),
        counts.unresolves.into(),
        counts.resolves.into(),
        traffic.loaded_bytes / 1024,
        traffic.stored_bytes / 1024,
        // The source is Bevy's main texture, with 8 bytes per texel.
        (plan.memory().bytes + 8 * u64::from(plan.frame()[0]) * u64::from(plan.frame()[1])) / 1024,
    ]
}
