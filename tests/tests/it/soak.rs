//! A short long run: windows, effects and scenes that change from frame to frame, shaders that are replaced, devices that are lost.

use crate::stage::gpu;
use framegraph_wgpu::{AdapterRequest, Gpu, OpenError};
use std::error::Error;
use std::process::Command;
use tests::soak::{Held, Soak, Trouble};

/// How much more resident memory may be after the second half of a run on the adapter than after its first, in each of which two
/// devices come and go. What was freed need not go back to the system: 8 to 29 MB were seen on Mesa's software driver, and 97 to 102
/// MB where executors of lost devices were kept.
const MOST_GROWN_BYTES: u64 = 64 << 20;

fn opened() -> Result<Gpu, OpenError> {
    Gpu::open(&AdapterRequest::from_env())
}

/// A hundred states on the device that validates everything: no frame fails, and the pool holds no more after many states than
/// after some.
#[test]
fn a_run_leaves_nothing_behind() -> Result<(), Box<dyn Error>> {
    let mut held = Vec::new();
    Soak::new(&Gpu::noop()?, 300)?.run(480, 80, |now| held.push(now.textures))?;
    let made = |row: usize| held[row].created;
    let (mut ended, trouble) = (None, Trouble { reload_every: 30, lose_every: 70, open: Gpu::noop });
    Soak::new(&Gpu::noop()?, 300)?.with(trouble).run(160, 160, |now| ended = Some([now.reloaded, now.lost]))?;
    assert!(ended.is_some_and(|[reloaded, lost]| reloaded > 30 && lost == 2), "{ended:?}");
    assert!(made(5) > made(0) + 200, "the run made hardly anything: {held:?}");
    // An idle texture is destroyed after 30 frames, which hold some ten states of at most forty textures.
    assert!(held.iter().all(|now| now.objects < 400), "{held:?}");
    Ok(())
}

/// A process of its own, since resident memory is that of all tests in one; see
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
    assert!(behind <= before + MOST_GROWN_BYTES, "{before} bytes were resident, then {behind}");
    assert!(last == Soak::fresh(&opened()?)?, "the last frame is not that of a fresh run");
    assert!(last.chunks(4).any(|texel| texel[..3] != last[..3]), "a picture of one color shows nothing");
    println!("DONE");
    Ok(())
}

/// The same on the adapter, with the plainest effects, whose shaders are soon compiled: memory stays flat, and the last frame is a
/// fresh run's.
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
