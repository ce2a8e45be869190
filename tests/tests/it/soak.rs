//! A short run of the soak test: changing windows, effects and scenes, replaced shaders, lost devices.

use crate::stage::gpu;
use framegraph_wgpu::{AdapterRequest, Gpu, OpenError};
use std::error::Error;
use std::process::Command;
use tests::soak::{Held, Soak, Trouble};

/// Maximum growth of resident memory between the first and second half of a run on the adapter; two devices are lost in
/// each half. Freed memory need not return to the system: 8 to 29 MB were measured on Mesa's software driver, and 97 to
/// 102 MB with leaked executors.
const MAX_GROWN_BYTES: u64 = 64 << 20;

fn opened() -> Result<Gpu, OpenError> {
    Gpu::open(&AdapterRequest::from_env())
}

/// A hundred states on the noop device: no frame fails, and the pool does not keep growing.
#[test]
fn a_run_leaves_nothing_behind() -> Result<(), Box<dyn Error>> {
    let mut held = Vec::new();
    Soak::new(&Gpu::noop()?, 300)?.run(480, 80, |now| held.push(now.textures))?;
    let made = |row: usize| held[row].created;
    let (mut ended, trouble) = (None, Trouble { reload_every: 30, lose_every: 70, open: Gpu::noop });
    Soak::new(&Gpu::noop()?, 300)?.with(trouble).run(160, 160, |now| ended = Some([now.reloaded, now.lost]))?;
    assert!(ended.is_some_and(|[reloaded, lost]| reloaded > 30 && lost == 2), "{ended:?}");
    assert!(made(5) > made(0) + 200, "the run made hardly anything: {held:?}");
    // An idle texture is destroyed after 30 frames, which have about ten states of at most forty textures.
    assert!(held.iter().all(|now| now.objects < 400), "{held:?}");
    Ok(())
}

/// Runs in its own process, since resident memory includes other tests; see
/// `a_run_on_the_adapter_takes_no_more_memory_as_it_goes_on`.
#[test]
#[ignore = "a part of another test, which runs it alone"]
fn run_on_the_adapter() -> Result<(), Box<dyn Error>> {
    let (gpu, mut held) = (opened()?, Vec::new());
    let trouble = Trouble { reload_every: 2, lose_every: 4, open: opened };
    let last = Soak::simple(&gpu, 48)?.with(trouble).run(16, 8, |now| held.push(now))?;
    let [middle, end]: [Held; 2] = held.try_into().map_err(|held| format!("{held:?}"))?;
    assert!(end.reloaded > middle.reloaded && [middle.lost, end.lost] == [2, 4], "{middle:?} {end:?}");
    let [before, behind] = [middle, end].map(|held| held.resident_bytes);
    assert!(behind <= before + MAX_GROWN_BYTES, "{before} bytes were resident, then {behind}");
    assert!(last == Soak::fresh(&opened()?)?, "the last frame is not that of a fresh run");
    assert!(last.chunks(4).any(|texel| texel[..3] != last[..3]), "a picture of one color shows nothing");
    println!("DONE");
    Ok(())
}

/// A run on the adapter with the simplest effects, whose shaders compile quickly: memory does not grow, and the last
/// frame equals a fresh run's.
#[test]
fn a_run_on_the_adapter_takes_no_more_memory_as_it_goes_on() -> Result<(), Box<dyn Error>> {
    if gpu("a_run_on_the_adapter_takes_no_more_memory_as_it_goes_on").is_none() {
        return Ok(());
    }
    let mut run = Command::new(std::env::current_exe()?);
    let out = run.args(["--exact", "soak::run_on_the_adapter", "--ignored", "--nocapture"]).output()?;
    let [said, told] = [out.stdout, out.stderr].map(|text| String::from_utf8_lossy(&text).into_owned());
    assert!(out.status.success() && said.contains("DONE"), "{said}\n{told}");
    Ok(())
}
