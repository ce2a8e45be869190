//! `measure soak`: long-running test of the standard frame with changing window size, effects and scene.
//!
//! `WGPU_BACKEND=noop cargo run --release -p tests --bin measure -- soak --frames 100000` prints the resources in use during
//! the run. At the end, it compares the last frame with one of a fresh run. Any error ends the run.

use crate::{Outcome, adapter};
use framegraph_wgpu::{AdapterRequest, Gpu};
use tests::soak::{Soak, Trouble};

const HELP: &str = "\
soak: the standard frame under random sizes, effects and scenes

  --frames N    frames to draw (10000)
  --largest PX  most pixels of a side (512)
  --rows N      rows to print (10)
  --reload N    replace all shaders each N frames (not at all)
  --lose N      lose the device each N frames, and make everything anew (not at all)

WGPU_BACKEND=noop draws nothing and validates everything.
";

/// Draws frames and prints rows.
pub fn run(words: &[&str]) -> Outcome {
    let (mut frames, mut largest, mut rows) = (10_000_usize, 512_u32, 10_usize);
    let open = || Gpu::open(&AdapterRequest::from_env());
    let mut trouble = Trouble { reload_every: usize::MAX, lose_every: usize::MAX, open };
    let mut arguments = lexopt::Parser::from_args(words);
    while let Some(argument) = arguments.next()? {
        use lexopt::ValueExt;
        match argument {
            lexopt::Arg::Long("frames") => frames = arguments.value()?.parse()?,
            lexopt::Arg::Long("largest") => largest = arguments.value()?.parse()?,
            lexopt::Arg::Long("rows") => rows = arguments.value()?.parse()?,
            lexopt::Arg::Long("reload") => trouble.reload_every = arguments.value()?.parse()?,
            lexopt::Arg::Long("lose") => trouble.lose_every = arguments.value()?.parse()?,
            lexopt::Arg::Long("help") => {
                program::print(HELP);
                return Ok(true);
            }
            other => return Err(other.unexpected().into()),
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
