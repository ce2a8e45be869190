//! `measure soak`: long-running test of the standard frame with changing window size, effects and scene.
//!
//! `WGPU_BACKEND=noop cargo run --release -p tests --bin measure -- soak --frames 100000` prints the resources in use during
//! the run. At the end, it compares the last frame with one of a fresh run. Any error ends the run.

use crate::{Outcome, adapter};
use framegraph_wgpu::{AdapterRequest, Gpu};
use program::cli::{self, Parsed, option};
use tests::soak::{Soak, Trouble};

/// Draws frames and prints rows.
pub fn run(words: &[&str]) -> Outcome {
    let (mut frames, mut largest, mut rows) = (10_000_usize, 512_u32, 10_usize);
    let open = || Gpu::open(&AdapterRequest::from_env());
    let mut trouble = Trouble { reload_every: usize::MAX, lose_every: usize::MAX, open };
    let about = "The standard frame under random sizes, effects and scenes";
    let command = cli::command("measure soak", about, "WGPU_BACKEND=noop draws nothing and validates everything.")
        .args([
            option("frames", "N", "Frames to draw (10000)"),
            option("largest", "PX", "Maximum number of pixels of a side (512)"),
            option("rows", "N", "Rows to print (10)"),
            option("reload", "N", "Replace all shaders each N frames (not at all)"),
            option("lose", "N", "Lose the device each N frames, and make everything anew (not at all)"),
        ]);
    let given = match cli::parse(command, words.iter().map(Into::into))? {
        Parsed::Help(text) => {
            program::print(text);
            return Ok(true);
        }
        Parsed::Given(given) => given,
    };
    for item in given {
        let number = item.parse("a whole number", |text| text.parse::<usize>().ok())?;
        match item.name() {
            "frames" => frames = number,
            "largest" => largest = number.try_into()?,
            "rows" => rows = number,
            "reload" => trouble.reload_every = number,
            _ => trouble.lose_every = number,
        }
    }
    let gpu = adapter()?;
    program::line(
        "\n| frames | textures held | their MiB | made | shaders replaced | devices lost | resident MiB |\n| --- | --- | --- | --- | --- | --- | --- |",
    );
    let mib = |bytes: u64| bytes as f64 / f64::from(1 << 20);
    let last = Soak::new(&gpu, largest.max(64))?.with(trouble).run(frames, (frames / rows.max(1)).max(1), |held| {
        let (textures, resident) = (held.textures, mib(held.resident_bytes));
        program::line(format_args!(
            "| {} | {} | {:.1} | {} | {} | {} | {resident:.1} |",
            held.frames,
            textures.objects,
            mib(textures.bytes),
            textures.created,
            held.reloaded,
            held.lost,
        ));
    })?;
    if last != Soak::fresh(&open()?)? {
        return Err("the last frame differs from that of a fresh run".into());
    }
    program::line("\nThe last frame is that of a fresh run.");
    Ok(true)
}
