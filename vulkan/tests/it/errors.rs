//! Executors after frames and preparations that fail.

use crate::bench::{FRAME, TestResult, device, frames, planned};
use framegraph::{
    Caps, ClearValue, Extent, Format, Graph, Intent, Options, Plan, ResolveMode, ResolveModes, ResourceId, Scratch,
    TextureDesc, compile,
};
use framegraph_vulkan::ash::vk;
use framegraph_vulkan::testing::{self, Mock};
use framegraph_vulkan::{Executor, ExecutorOptions, Imports};
use std::panic::{AssertUnwindSafe, catch_unwind};

/// A recorder that panics leaves an executor that can execute and prepare.
#[test]
fn executors_recover_from_recorders_that_panic() -> TestResult {
    let Some(device) = device("executors_recover_from_recorders_that_panic") else { return Ok(()) };
    let (_, graph) = frames()?.swap_remove(0);
    let plan = planned(&device, &graph, &Options::for_frame(FRAME[0], FRAME[1]), |_| {})?;
    for prepares in [false, true] {
        let (mut executor, mut mock) = (Executor::new(device.gpu())?, Mock { kit: testing::Kit::new(device.gpu()) });
        let imports = testing::imports(&mut mock.kit, &plan)?;
        executor.execute(&plan, imports, |cx| mock.record(cx))?;
        let imports = testing::imports(&mut mock.kit, &plan)?;
        let mut passes = 0;
        let frame = AssertUnwindSafe(|| {
            executor.execute(&plan, imports, |cx| {
                passes += 1;
                assert!(passes < 2, "planted");
                mock.record(cx)
            })
        });
        assert!(catch_unwind(frame).is_err());
        // The pipelines belong to render passes of the earlier preparation.
        mock.kit.reset();
        if prepares {
            executor.prepare(&plan, None)?;
        }
        for _ in 0..3 {
            let imports = testing::imports(&mut mock.kit, &plan)?;
            executor.execute(&plan, imports, |cx| mock.record(cx))?;
        }
        executor.wait()?;
        assert_eq!(executor.executed(), plan.counts());
        assert_eq!(device.messages(), [""; 0]);
    }
    Ok(())
}

/// The error of the recorder is returned, and the next frame is complete. Timestamps of the failed frame are not read.
#[test]
fn executors_recover_from_recorders_that_fail() -> TestResult {
    let Some(device) = device("executors_recover_from_recorders_that_fail") else { return Ok(()) };
    let (_, graph) = frames()?.swap_remove(0);
    let plan = planned(&device, &graph, &Options::for_frame(FRAME[0], FRAME[1]), |_| {})?;
    let options = ExecutorOptions { timing: true, ..ExecutorOptions::default() };
    let (mut executor, mut mock) =
        (Executor::with(device.gpu(), options)?, Mock { kit: testing::Kit::new(device.gpu()) });
    let imports = testing::imports(&mut mock.kit, &plan)?;
    let failed = executor.execute(&plan, imports, |_| Err("planted".into()));
    assert!(failed.is_err_and(|error| error.to_string().contains("planted")));
    let imports = testing::imports(&mut mock.kit, &plan)?;
    executor.execute(&plan, imports, |cx| mock.record(cx))?;
    assert!(executor.step_times_us().is_empty());
    executor.wait()?;
    assert_eq!(executor.executed(), plan.counts());
    assert_eq!(device.messages(), [""; 0]);
    Ok(())
}

/// A plan without steps has no timestamps.
#[test]
fn plans_without_steps_are_executed_with_timing() -> TestResult {
    let Some(device) = device("plans_without_steps_are_executed_with_timing") else { return Ok(()) };
    let plan = planned(&device, &Graph::new(), &Options::for_frame(FRAME[0], FRAME[1]), |_| {})?;
    let options = ExecutorOptions { timing: true, ..ExecutorOptions::default() };
    let mut executor = Executor::with(device.gpu(), options)?;
    for _ in 0..4 {
        executor.execute(&plan, Imports::new(), |_| Ok(()))?;
        assert!(executor.step_times_us().is_empty());
    }
    executor.wait()?;
    assert_eq!(device.messages(), [""; 0]);
    Ok(())
}

/// Refused plans leave the prepared one with its histories, and no object remains when the device is closed.
#[test]
fn refused_plans_keep_the_prepared_one() -> TestResult {
    let Some(device) = device("refused_plans_keep_the_prepared_one") else { return Ok(()) };
    let mut graph = Graph::new();
    let history = graph.history("history", TextureDesc::new(Extent::FRAME, Format::Rgba8Unorm), 1);
    let white = Intent::Clear(ClearValue::Color([1.0; 4]));
    let written = graph.add_fn("write", |pass| pass.color(history, white))?;
    graph.export(written)?;
    let options = Options::for_frame(FRAME[0], FRAME[1]);
    let plan = planned(&device, &graph, &options, |_| {})?;
    let mut without_barriers = Plan::new();
    let caps = Caps { explicit_barriers: false, ..device.gpu().caps() };
    compile(&graph, &caps, &options, &mut Scratch::new(), &mut without_barriers)?;
    let mut executor = Executor::new(device.gpu())?;
    executor.execute(&plan, Imports::new(), |_| Ok(()))?;
    let id = graph.resource_of(written).ok_or("the history belongs to the graph")?;
    let kept = executor.exported(id).ok_or("the history is kept")?;
    let refused = executor.prepare(&without_barriers, None);
    assert!(refused.is_err_and(|error| error.to_string().contains("no barriers")));
    assert_eq!(executor.exported(id), Some(kept));
    assert!(executor.layout(id, kept.image, 0, 0, 0) != vk::ImageLayout::UNDEFINED);
    executor.execute(&plan, Imports::new(), |_| Ok(()))?;
    assert_ne!(executor.exported(id), Some(kept));
    assert!(executor.prepare(&without_barriers, None).is_err());
    drop(executor);
    // Closing the device panics if an object was not destroyed.
    drop(device);
    Ok(())
}

/// Identifiers of another graph have no object and do not panic.
#[test]
#[allow(unsafe_code, reason = "imports are promises about handles")]
fn identifiers_of_other_graphs_are_ignored() -> TestResult {
    let Some(device) = device("identifiers_of_other_graphs_are_ignored") else { return Ok(()) };
    let plan = planned(&device, &Graph::new(), &Options::for_frame(FRAME[0], FRAME[1]), |_| {})?;
    let mut executor = Executor::new(device.gpu())?;
    let (id, mut imports) = (ResourceId::at(9), Imports::new());
    // SAFETY: the plan has no such import, so the handle is not used.
    unsafe {
        imports.image(id, vk::Image::null(), vk::ImageLayout::GENERAL);
        imports.leave_in(id, vk::ImageLayout::PRESENT_SRC_KHR);
    }
    executor.execute(&plan, imports, |_| Ok(()))?;
    assert_eq!(executor.exported(id), None);
    assert!(executor.layout(id, vk::Image::null(), 0, 0, 0) == vk::ImageLayout::UNDEFINED);
    executor.wait()?;
    assert_eq!(device.messages(), [""; 0]);
    Ok(())
}

/// Plans that need more than the device has are refused before anything is created.
#[test]
fn plans_for_other_devices_are_refused() -> TestResult {
    let Some(device) = device("plans_for_other_devices_are_refused") else { return Ok(()) };
    let mut graph = Graph::new();
    let desc = TextureDesc::new(Extent::FRAME, Format::Rgba8Unorm).layers(33);
    let layers = graph.texture("layers", desc);
    let layers = graph.add_fn("draw", |pass| pass.color(layers, Intent::Clear(ClearValue::Color([1.0; 4]))))?;
    graph.export(layers)?;
    let options = Options::for_frame(FRAME[0], FRAME[1]);
    let mut executor = Executor::new(device.gpu())?;
    let refused = |executor: &mut Executor, change: fn(&mut Caps), what: &str| -> TestResult {
        let plan = planned(&device, &graph, &options, change)?;
        let error = executor.prepare(&plan, None).err().ok_or(what)?.to_string();
        assert!(error.contains(what), "{what}: {error}");
        Ok(())
    };
    refused(&mut executor, |caps| caps.max_color_attachments += 1, "max_color_attachments")?;
    refused(&mut executor, |caps| caps.max_attached_layers += 1, "max_attached_layers")?;
    refused(&mut executor, |caps| caps.max_texture_layers += 1, "max_texture_layers")?;
    refused(&mut executor, |caps| caps.placed_histories = true, "placed_histories")?;
    refused(&mut executor, |caps| caps.separate_heaps = false, "separate_heaps")?;
    let every = |caps: &mut Caps| caps.depth_resolves = ResolveModes::of(&ResolveMode::ALL);
    refused(&mut executor, every, "depth_resolves")?;
    let plan = planned(&device, &graph, &options, |_| {})?;
    executor.prepare(&plan, None)?;
    let options = ExecutorOptions { multiview: true, ..ExecutorOptions::default() };
    let error = Executor::with(device.gpu(), options)?.prepare(&plan, None);
    assert!(error.is_err_and(|error| error.to_string().contains("draw: it draws 33 layers")));
    drop(executor);
    assert_eq!(device.messages(), [""; 0]);
    Ok(())
}
