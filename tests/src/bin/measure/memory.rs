//! `measure memory`: bytes that the device allocates for the standard frame under each aliasing mode.
//!
//! `cargo run --release -p tests --bin measure -- memory` prints the table of `docs/measurements/performance.md`: one frame per size.

use crate::{Outcome, adapter, no_words};
use framegraph::{Alias, Memory, Options};
use framegraph_passes::effects::bloom::BloomSettings;
use framegraph_passes::effects::dof::DofSettings;
use framegraph_passes::effects::fog::FogSettings;
use framegraph_passes::{Preset, Settings};
use framegraph_wgpu::{AdapterRequest, Allocated, ExecutorOptions, FrameLoop, Gpu};
use std::error::Error;
use tests::stage::Stage;

const SIZES_PX: [[u32; 2]; 2] = [[1920, 1080], [3840, 2160]];
const WAYS: [(&str, Alias); 3] = [("none", Alias::Off), ("pool", Alias::Pool), ("heap", Alias::Heap)];

/// Prints the table.
pub fn run(words: &[&str]) -> Outcome {
    no_words(words)?;
    let open = || Gpu::open(&AdapterRequest::from_env());
    adapter()?;
    program::line(
        "\n| size | aliasing | lower bound, MiB | by the plan, MiB | by wgpu, MiB | in blocks, MiB | together, MiB | of the bound | of no aliasing |",
    );
    program::line("| --- | --- | --- | --- | --- | --- | --- | --- | --- |");
    for size_px in SIZES_PX {
        let mut apart = None;
        for (name, alias) in WAYS {
            // A new device keeps allocations of other modes out of the count.
            let (memory, frame) = measured(&open()?, size_px, alias)?;
            let together = frame.by_wgpu + frame.placed;
            let share = together as f64 / *apart.get_or_insert(together) as f64;
            let bound = memory.lower_bound_bytes + memory.own_bytes;
            if together < bound {
                return Err(format!("{name}: {together} bytes are allocated, below the bound of {bound}").into());
            }
            let of_bound = together as f64 / bound as f64;
            let planned = memory.bytes + memory.own_bytes;
            let [bound, planned, by_wgpu, placed, together] =
                [bound, planned, frame.by_wgpu, frame.placed, together].map(mib);
            let [width, height] = size_px;
            program::line(format_args!(
                "| {width}x{height} | {name} | {bound:.1} | {planned:.1} | {by_wgpu:.1} | {placed:.1} | {together:.1} | {of_bound:.2} | {share:.2} |"
            ));
        }
    }
    Ok(true)
}

fn mib(bytes: u64) -> f64 {
    bytes as f64 / f64::from(1 << 20)
}

/// Returns the memory that the plan reports, and the bytes allocated in addition to the scene.
fn measured(gpu: &Gpu, size_px: [u32; 2], alias: Alias) -> Result<(Memory, Allocated), Box<dyn Error>> {
    let settings = Settings {
        fog: Some(FogSettings::DEFAULT),
        bloom: Some(BloomSettings::DEFAULT),
        dof: Some(DofSettings::DEFAULT),
        ..Preset::High.frame().settings
    };
    let mut stage = Stage::new(gpu, "columns")?;
    let mut frames = FrameLoop::with(gpu, Options { alias, ..Options::default() }, ExecutorOptions::default());
    // Uploads of the scene end, and free their staging buffers.
    gpu.queue.submit([]);
    gpu.wait()?;
    let before = frames.executor().allocated();
    stage.draw(&mut frames, &settings, size_px, 0)?;
    gpu.wait()?;
    let behind = frames.executor().allocated();
    if let Some(why) = frames.executor().not_placed() {
        return Err(format!("no texture is placed: {why}").into());
    }
    let memory = frames.plan().memory();
    Ok((memory, Allocated { by_wgpu: behind.by_wgpu - before.by_wgpu, ..behind }))
}
