//! Devices, frames and runs that the tests share.

use framegraph::file::GraphFile;
use framegraph::{Caps, Desc, Exit, Graph, Kind, Options, Plan, Scratch};
use framegraph_queues::{Command, PlanStream, Schedule};
use framegraph_vulkan::ash::vk;
use framegraph_vulkan::testing::{self, DeviceRequest, Mock, Part, TestDevice};
use framegraph_vulkan::{Executor, ExecutorOptions, Imports, Synchronization};

pub type TestResult<T = ()> = Result<T, Box<dyn std::error::Error>>;

/// Opens a device with layers, or reports a skip with the reason.
pub fn device(test: &str) -> Option<TestDevice> {
    device_with(test, Synchronization::Core)
}

/// Opens a device with these commands for barriers, or reports a skip with the reason.
pub fn device_with(test: &str, synchronization: Synchronization) -> Option<TestDevice> {
    match TestDevice::open(DeviceRequest { synchronization, ..DeviceRequest::default() }) {
        Ok(device) => {
            test_report::adapter(&device.gpu().name());
            Some(device)
        }
        Err(error) => {
            test_report::skip(test, &format!("plans are executed on Vulkan with its layers: {error}"));
            None
        }
    }
}

/// Small, since validation layers and software drivers cost time per texel.
pub const FRAME: [u32; 2] = [64, 48];

/// Returns the forward frame, the deferred frame, and a frame with the passes of Filament.
pub fn frames() -> TestResult<Vec<(&'static str, Graph)>> {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/cases");
    let read = |name: &'static str| {
        let path = format!("{folder}/{name}.ron");
        let text = std::fs::read_to_string(&path)?;
        Ok((name, GraphFile::parse(&path, &text)?.graph(&[])?))
    };
    ["forward", "deferred", "filament"].into_iter().map(read).collect()
}

/// Compiles for the device, with changed capabilities.
pub fn planned(
    device: &TestDevice,
    graph: &Graph,
    options: &Options,
    change: impl FnOnce(&mut Caps),
) -> TestResult<Plan> {
    let (mut caps, mut plan) = (device.gpu().caps(), Plan::new());
    change(&mut caps);
    device.gpu().compile(graph, &caps, options, &mut Scratch::new(), &mut plan)?;
    Ok(plan)
}

/// Result of executing frames.
pub struct Ran {
    /// Messages of the layers.
    pub messages: Vec<String>,
    /// Bytes of every kept texture of one sample, by name.
    pub contents: Vec<(String, Vec<u8>)>,
    pub executor: Executor,
}

/// Executes some frames of a plan with mock recorders.
pub fn run(
    device: &TestDevice,
    plan: &Plan,
    schedule: Option<&Schedule>,
    commands: Option<Vec<Command>>,
    frames: usize,
) -> TestResult<Ran> {
    let options = ExecutorOptions { timing: true, ..ExecutorOptions::default() };
    let mut executor = Executor::with(device.gpu(), options)?;
    let mut mock = Mock { kit: testing::Kit::new(device.gpu()) };
    let commands = commands.unwrap_or_else(|| schedule.map_or_else(|| plan.stream(), |s| plan.stream_on(s)));
    prepare(&mut executor, plan, schedule, commands)?;
    let imports = testing::imports(&mut mock.kit, plan)?;
    let left = |id: framegraph::ResourceId| {
        matches!(
            plan.graph().resources()[id.index()].kind,
            Kind::Imported { entry: framegraph::Entry::Left { .. }, .. }
        )
    };
    // Imports in a declared state have it before the first frame only.
    let frames = if plan.graph().resource_ids().any(left) { 1 } else { frames };
    for _ in 0..frames {
        executor.execute(plan, again(&imports), |cx| mock.record(cx))?;
    }
    executor.wait()?;
    let contents = contents(&executor, &mut mock, plan, &imports)?;
    drop(mock);
    Ok(Ran { messages: device.messages(), contents, executor })
}

/// Binds the same images and buffers for another frame.
#[allow(unsafe_code, reason = "imports are promises about handles")]
pub fn again(imports: &Imports) -> Imports {
    // SAFETY: the kit of the test is alive, and tests fail if the layers report another layout.
    unsafe { testing::imports_again(imports) }
}

#[allow(unsafe_code, reason = "commands without their barriers race on the GPU")]
fn prepare(executor: &mut Executor, plan: &Plan, schedule: Option<&Schedule>, commands: Vec<Command>) -> TestResult {
    // SAFETY: the device has validation layers, and tests of faults use messages only.
    unsafe { framegraph_vulkan::stream::prepare(executor, plan, schedule, commands)? };
    Ok(())
}

/// Reads what is kept after the frame.
fn contents(
    executor: &Executor,
    mock: &mut Mock,
    plan: &Plan,
    imports: &Imports,
) -> TestResult<Vec<(String, Vec<u8>)>> {
    let graph = plan.graph();
    let mut found = Vec::new();
    for id in graph.resource_ids() {
        let row = graph.resources()[id.index()];
        let exported = graph.exports().iter().any(|export| export.resource == id);
        let kept =
            exported || matches!(row.kind, Kind::Imported { exit: Exit::Keep, .. } | Kind::HistoryCurrent { .. });
        let Desc::Texture(desc) = row.desc else { continue };
        let used = !plan.resources()[id.index()].first.is_none();
        let image = executor.exported(id).map(|e| e.image).or_else(|| imports.bound_image(id));
        let (true, Some(image), 1) = (kept && used, image, desc.samples) else { continue };
        if desc.dimension == framegraph::Dimension::D3 {
            continue;
        }
        let mut bytes = Vec::new();
        for mip in 0..desc.mip_count(plan.frame()) {
            for layer in 0..u32::from(desc.layers) {
                let (aspect, texel_bytes) = match (desc.format.has_depth(), desc.format.has_stencil()) {
                    (true, true) => continue,
                    (true, false) => (vk::ImageAspectFlags::DEPTH, 4),
                    (false, true) => (vk::ImageAspectFlags::STENCIL, 1),
                    (false, false) => (vk::ImageAspectFlags::COLOR, desc.format.block_bytes()),
                };
                let layout = executor.layout(id, image, mip, layer, 0);
                if layout == vk::ImageLayout::UNDEFINED {
                    continue;
                }
                let extent = desc.mip_extent(plan.frame(), mip);
                bytes.extend(mock.kit.read_image(&Part { image, layout, aspect, mip, layer, extent, texel_bytes })?);
            }
        }
        found.push((graph.resource_name(id).to_owned(), bytes));
    }
    Ok(found)
}

/// Asserts that the same textures are kept, and that no byte differs by more than `limit`.
#[track_caller]
pub fn assert_contents(expected: &Ran, found: &Ran, limit: u8, place: &str) {
    let shape =
        |ran: &Ran| -> Vec<_> { ran.contents.iter().map(|(name, bytes)| (name.clone(), bytes.len())).collect() };
    assert_eq!(shape(found), shape(expected), "{place}");
    for ((name, a), (_, b)) in expected.contents.iter().zip(&found.contents) {
        let difference = a.iter().zip(b).map(|(a, b)| a.abs_diff(*b)).max().unwrap_or(0);
        assert!(difference <= limit, "{place}, {name}: {difference}");
    }
}
