//! Tests of the executor's internal state.

use super::*;
use crate::execute::cx::Cx;

fn needs_send<T: Send>() {}
fn needs_sync<T: Sync>() {}

/// Checks that contexts can be moved to other threads, and that their shared state is `Sync`.
#[test]
fn contexts_of_one_frame_may_live_on_several_threads() {
    needs_send::<Cx<'_>>();
    needs_send::<Recording>();
    needs_sync::<Prepared<'_>>();
    needs_sync::<Passes<'_, ()>>();
}

/// Checks that views of attached and sampled textures are cached for the next frame, except surface textures. They are
/// released every `max_age` frames, and when an object is dropped.
#[test]
fn views_are_cached_until_they_may_be_invalid() -> Result<(), Box<dyn std::error::Error>> {
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
        let before = executor.recording.requests.views_found;
        executor.execute(&plan, &frame, &(), &imports).map(|_| executor.recording.requests.views_found - before)
    };
    // Three views: the sky attached, the sky sampled, the image attached.
    let found = (0..9).map(|_| execute(&mut executor, false)).collect::<Result<Vec<_>, _>>()?;
    assert_eq!(found, [0, 3, 3, 3, 0, 3, 3, 3, 0]);
    assert_eq!(execute(&mut executor, true)?, 2);
    assert_eq!(execute(&mut executor, true)?, 2, "surface textures are looked up in each frame");
    executor.trim();
    assert_eq!(execute(&mut executor, false)?, 0, "no references to freed objects remain");
    Ok(())
}

/// Checks that rejected commands are errors of their frame: with this crate's error handler, within error scopes of the
/// caller, and on a wrapped device. Earlier errors are reported separately.
#[test]
fn a_frame_reports_only_its_own_errors() -> Result<(), Box<dyn std::error::Error>> {
    use framegraph::{ClearValue, Extent, Format, Intent, Options, Scratch, TextureDesc, compile};
    let owned = Gpu::noop()?;
    let wrapped = Gpu::wrap(owned.adapter(), &owned.device, &owned.queue);
    let (mut frame, mut plan) = (Frame::<()>::new(), Plan::new());
    let sky = frame.graph_mut().texture("sky", TextureDesc::new(Extent::FRAME, Format::Rgba8Unorm));
    let clear = Intent::Clear(ClearValue::BLACK);
    // Draws without a pipeline.
    let sky = frame.add_fn(
        "sky",
        |p| p.color(sky, clear),
        |_, (), cx| {
            cx.render_pass()?.draw(0..3, 0..1);
            Ok(())
        },
    )?;
    frame.graph_mut().export(sky)?;
    compile(frame.graph(), &owned.caps(), &Options::for_frame(8, 8), &mut Scratch::new(), &mut plan)?;
    let refused = |gpu: &Gpu| {
        let ran = Executor::new(gpu).execute(&plan, &frame, &(), &Imports::new());
        assert!(matches!(ran, Err(ExecuteError::Refused { .. })), "{ran:?}");
    };
    for gpu in [&owned, &wrapped] {
        refused(gpu);
        gpu.guard("nothing else", || refused(gpu))?;
    }
    let size =
        wgpu::BufferDescriptor { label: None, size: 8, usage: wgpu::BufferUsages::MAP_READ, mapped_at_creation: false };
    owned.queue.write_buffer(&owned.device.create_buffer(&size), 0, &[0; 4]);
    let ran = Executor::new(&owned).execute(&plan, &frame, &(), &Imports::new()).map_err(|error| error.to_string());
    assert!(ran.as_ref().is_err_and(|message| message.contains("something outside of a frame")), "{ran:?}");
    Ok(())
}
