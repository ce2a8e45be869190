//! A short long run: windows, effects and scenes that change from frame to frame, shaders that are replaced, devices that are lost.

use crate::stage::gpu;
use framegraph_wgpu::Gpu;
use std::error::Error;
use tests::soak::{Soak, Trouble};

/// A hundred states on the device that validates everything, and some on the adapter: no frame fails, the pool holds no more
/// after many states than after some, and the last frame is a fresh run's.
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
    let Some(gpu) = gpu("a_run_leaves_nothing_behind") else { return Ok(()) };
    let last = Soak::new(&gpu, 48)?.run(24, 24, |_| ())?;
    assert!(last == Soak::fresh(&gpu)?, "the last frame is not that of a fresh run");
    assert!(last.chunks(4).any(|texel| texel[..3] != last[..3]), "a picture of one color shows nothing");
    Ok(())
}
