//! What threads that record one frame share.

use super::*;
use crate::execute::cx::Cx;

fn needs_send<T: Send>() {}
fn needs_sync<T: Sync>() {}

/// A recorder's context goes to another thread, and what contexts share is shared by reference.
#[test]
fn contexts_of_one_frame_may_live_on_several_threads() {
    needs_send::<Cx<'_>>();
    needs_send::<Recording>();
    needs_sync::<Prepared<'_>>();
    needs_sync::<Passes<'_, ()>>();
}

/// What a frame attached and sampled is remembered for the next one, but for what was lent; every `max_age` frames, and when
/// an object is given up, it is let go of.
#[test]
fn views_are_remembered_until_they_may_be_gone() -> Result<(), Box<dyn std::error::Error>> {
    use framegraph::{ClearValue, Entry, Exit, Extent, Format, Intent, Options, Scratch, TextureDesc, compile};
    let gpu = Gpu::noop()?;
    let options = ExecutorOptions { max_age: 4, ..ExecutorOptions::default() };
    let (mut executor, mut frame, mut plan) = (Executor::with(&gpu, options), Frame::<()>::new(), Plan::new());
    let desc = TextureDesc::new(Extent::FRAME, Format::Rgba8Unorm);
    let clear = Intent::Clear(ClearValue::BLACK);
    let sky = frame.graph_mut().texture("sky", desc);
    let sky = frame.add_fn("sky", |pass| pass.color(sky, clear), |_, _, _| Ok(()))?;
    let shown = frame.graph_mut().import_texture("shown", desc, Entry::Undefined, Exit::Keep);
    let declare = |pass: &mut framegraph::PassBuilder<'_>| Ok((pass.sampled(sky)?, pass.color(shown, clear)?));
    frame.add_fn("show", declare, |(view, _), _, cx| cx.view(*view).map(|_| ()))?;
    compile(frame.graph(), &gpu.caps(), &Options::for_frame(8, 8), &mut Scratch::new(), &mut plan)?;
    let image = gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d { width: 8, height: 8, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::Rgba8Unorm,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT,
        view_formats: &[],
    });
    let execute = |executor: &mut Executor, lent: bool| {
        let mut imports = Imports::new();
        let _ = if lent { imports.surface(shown, &image) } else { imports.texture(shown, &image) };
        let before = executor.recording.remembered.views_found;
        executor.execute(&plan, &frame, &(), &imports).map(|_| executor.recording.remembered.views_found - before)
    };
    // The sky attached, the sky sampled, the image attached.
    let found = (0..9).map(|_| execute(&mut executor, false)).collect::<Result<Vec<_>, _>>()?;
    assert_eq!(found, [0, 3, 3, 3, 0, 3, 3, 3, 0]);
    assert_eq!(execute(&mut executor, true)?, 2);
    assert_eq!(execute(&mut executor, true)?, 2, "what is lent is looked up in each frame");
    executor.trim();
    assert_eq!(execute(&mut executor, false)?, 0, "nothing is kept of what may be gone");
    Ok(())
}
