//! A plan is a promise: whatever compiles for a device is executed by it, and what the device can execute compiles.
//!
//! Thousands of graphs with one extreme each are compiled with the capabilities of a device, and executed on it. A graph
//! that the compiler refuses is compiled for a device without limits and executed too. Cases on the real adapter run in
//! child processes, because drivers may hang or crash.

mod adapter;
mod case;
mod generate;

use crate::bench::TestResult;
use crate::random::record;
use case::Case;
use framegraph::{Caps, Format, FormatCaps, FormatTable, Options, Plan, Scratch, compile};
use framegraph_wgpu::{Executor, Frame, Gpu, mock};
use std::collections::BTreeMap;

/// Outcome of a case.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Outcome {
    /// Planned and executed.
    Executed,
    /// Refused by the compiler and by the device.
    Refused,
    /// The graph is invalid on every device, or cannot be declared.
    Invalid,
    /// Planned, and refused by the device.
    Broken,
    /// Refused by the compiler, and executed by the device.
    Strict,
}

/// Compiles and executes cases on one device.
struct Bench {
    gpu: Gpu,
    caps: Caps,
    without_limits: Caps,
    executor: Executor,
    scratch: Scratch,
}

impl Bench {
    fn new(gpu: &Gpu, caps: Caps) -> Self {
        let (scratch, executor) = (Scratch::new(), Executor::new(gpu));
        Self { gpu: gpu.clone(), without_limits: without_limits(&caps), caps, executor, scratch }
    }

    /// Returns what became of a case, and the error if there is one.
    fn outcome(&mut self, case: &Case) -> (Outcome, String) {
        let mut frame = Frame::new();
        if let Err(error) = (case.declare)(&mut frame) {
            return (Outcome::Invalid, error.to_string());
        }
        let (mut plan, options) = (Plan::new(), Options::for_frame(case::SIDE, case::SIDE));
        let planned = compile(frame.graph(), &self.caps, &options, &mut self.scratch, &mut plan);
        if let Err(refused) = planned {
            let forced = compile(frame.graph(), &self.without_limits, &options, &mut self.scratch, &mut plan);
            return match forced.is_ok() && self.execute(frame, &plan).is_ok() {
                true => (Outcome::Strict, refused.to_string()),
                false if forced.is_ok() => (Outcome::Refused, refused.to_string()),
                false => (Outcome::Invalid, refused.to_string()),
            };
        }
        match self.execute(frame, &plan) {
            Ok(()) => (Outcome::Executed, String::new()),
            Err(error) => (Outcome::Broken, error),
        }
    }

    fn execute(&mut self, mut frame: Frame, plan: &Plan) -> Result<(), String> {
        for pass in plan.graph().pass_ids() {
            let kind = plan.graph().passes()[pass.index()].kind;
            frame.set_recorder(pass, move |_, (), cx| {
                drop(cx.inlined());
                record(cx, kind)
            });
        }
        let imported = mock::imports(&self.gpu, plan).map_err(|e| e.to_string())?;
        let report = self.executor.execute(plan, &frame, &(), &imported.bound);
        report.map(drop).map_err(|e| e.to_string())
    }
}

/// Returns the device with all limits and rules lifted. Capabilities that change a plan, such as merging, stay.
fn without_limits(caps: &Caps) -> Caps {
    let resolved = |format| if caps.averages(format) { FormatCaps::NONE } else { FormatCaps::RESOLVABLE };
    let all = FormatTable::all();
    let formats = Format::ALL.into_iter().fold(all, |table, format| table.without(format, resolved(format)));
    Caps {
        max_color_attachments: 8,
        max_color_bytes_per_sample: u32::MAX,
        max_attached_layers: u32::MAX,
        max_texture_texels: u32::MAX,
        max_volume_texels: u32::MAX,
        max_texture_layers: u32::MAX,
        max_buffer_bytes: u64::MAX,
        max_samples: 16,
        max_sampled_textures: u32::MAX,
        max_storage_textures: u32::MAX,
        max_storage_buffers: u32::MAX,
        max_uniform_buffers: u32::MAX,
        max_uniform_bytes: u64::MAX,
        max_storage_bytes: u64::MAX,
        uniform_alignment_bytes: 1,
        storage_alignment_bytes: 1,
        formats,
        srgb_views: true,
        multisampled_arrays: true,
        multisampled_storage: true,
        partial_blocks: true,
        raster_storage: true,
        empty_raster: true,
        clears_to_zero: true,
        clears_to_value: true,
        sample_read_only_depth: true,
        separate_planes: true,
        ..caps.clone()
    }
}

/// Counts of outcomes by kind of case, and the broken promises.
#[derive(Default)]
struct Tally {
    counts: BTreeMap<String, BTreeMap<Outcome, u32>>,
    broken: Vec<String>,
}

impl Tally {
    fn add(&mut self, case: &Case, outcome: Outcome, why: &str) {
        *self.counts.entry(case.kind.to_owned()).or_default().entry(outcome).or_default() += 1;
        if matches!(outcome, Outcome::Broken | Outcome::Strict) {
            self.broken.push(format!("{outcome:?}: {}: {}: {why}", case.kind, case.name));
        }
    }

    /// Reports the counts as one line, and fails if a promise was broken.
    fn finish(&self, device: &str) {
        let total: u32 = self.counts.values().flat_map(BTreeMap::values).sum();
        let kinds = self.counts.iter().map(|(kind, counts)| {
            let of = |outcome| counts.get(&outcome).copied().unwrap_or_default();
            format!(
                "{kind} {} executed, {} refused, {} invalid",
                of(Outcome::Executed),
                of(Outcome::Refused),
                of(Outcome::Invalid)
            )
        });
        let kinds: Vec<_> = kinds.collect();
        test_report::result("promise", &format!("{device}: {total} cases; {}", kinds.join("; ")));
        let shown: Vec<_> = self.broken.iter().take(40).map(String::as_str).collect();
        assert!(self.broken.is_empty(), "{} broken promises on {device}\n{}", self.broken.len(), shown.join("\n"));
    }
}

/// Selects all cases with `cargo xtask test --all`, otherwise every fifth one of the many formats.
fn share(cases: Vec<Case>) -> Vec<Case> {
    let chosen = |at: usize, case: &Case| test_report::is_all() || case.kind != "format" || at.is_multiple_of(5);
    cases.into_iter().enumerate().filter(|(at, case)| chosen(*at, case)).map(|(_, case)| case).collect()
}

fn tally(gpu: &Gpu, caps: Caps, cases: &[Case]) -> Tally {
    let (mut bench, mut tally) = (Bench::new(gpu, caps), Tally::default());
    for case in cases {
        let (outcome, why) = bench.outcome(case);
        tally.add(case, outcome, &why);
    }
    tally
}

/// Opens a noop device with WebGPU's default limits and no optional feature.
fn baseline() -> Result<Gpu, Box<dyn std::error::Error>> {
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor {
        backends: wgpu::Backends::NOOP,
        backend_options: wgpu::BackendOptions {
            noop: wgpu::NoopBackendOptions { enable: true, ..Default::default() },
            ..Default::default()
        },
        ..wgpu::InstanceDescriptor::new_without_display_handle()
    });
    let adapters = pollster::block_on(instance.enumerate_adapters(wgpu::Backends::NOOP));
    let adapter = adapters.first().ok_or("no noop adapter")?;
    let (device, queue) = pollster::block_on(adapter.request_device(&wgpu::DeviceDescriptor::default()))?;
    Ok(Gpu::wrap(adapter, &device, &queue))
}

#[test]
fn plans_for_webgpu_are_executed_by_any_device() -> TestResult {
    let gpu = baseline()?;
    let cases = share(generate::cases(&Caps::wgpu(), 512 << 20));
    tally(&gpu, Caps::wgpu(), &cases).finish("WebGPU's baseline");
    Ok(())
}

#[test]
fn plans_for_all_features_are_executed() -> TestResult {
    let gpu = Gpu::noop()?;
    let cases = share(generate::cases(&gpu.caps(), generate::BUDGET_BYTES));
    tally(&gpu, gpu.caps(), &cases).finish("noop with all features");
    Ok(())
}

/// A device that claims more than it has breaks promises, one that claims less is too strict.
#[test]
fn missing_limits_are_found() -> TestResult {
    let gpu = baseline()?;
    let caps = Caps::wgpu();
    let stored = caps.formats.get(Format::R8Unorm).union(FormatCaps::STORAGE_WRITE);
    // Kind of cases, start of their names, device, and the expected outcome.
    let planted = [
        (
            "format",
            "R8Unorm StorageWrite",
            Caps { formats: caps.formats.with(Format::R8Unorm, stored), ..caps.clone() },
            Outcome::Broken,
        ),
        ("format", "Rgba8Unorm Color", Caps { max_samples: 1, ..caps.clone() }, Outcome::Strict),
        ("bindings", "17 sampled", Caps { max_sampled_textures: 17, ..caps.clone() }, Outcome::Broken),
        ("bytes", "", Caps { max_uniform_bytes: u64::MAX, ..caps.clone() }, Outcome::Broken),
        ("range", "bytes 4..", Caps { storage_alignment_bytes: 4, ..caps.clone() }, Outcome::Broken),
        ("view", "Rgba8Unorm", Caps { memoryless_views: true, ..caps.clone() }, Outcome::Broken),
        ("planes", "", Caps { separate_planes: true, ..caps.clone() }, Outcome::Broken),
        ("layers", "2", Caps { max_attached_layers: 2, ..caps.clone() }, Outcome::Broken),
        ("size", "8192 wide", Caps { max_texture_texels: 8191, ..caps.clone() }, Outcome::Strict),
        ("attachments", "", Caps { max_color_bytes_per_sample: 36, ..caps.clone() }, Outcome::Broken),
        ("attachments", "a raster pass", Caps { empty_raster: true, ..caps.clone() }, Outcome::Broken),
        (
            "bindings",
            "9 storage buffers, raster false",
            Caps { max_storage_buffers: 9, ..caps.clone() },
            Outcome::Broken,
        ),
        ("bindings", "5 storage textures", Caps { max_storage_textures: 5, ..caps.clone() }, Outcome::Broken),
        ("bindings", "25 uniform", Caps { max_uniform_buffers: 13, ..caps.clone() }, Outcome::Broken),
        ("bindings", "32 sampled", Caps { max_sampled_textures: 15, ..caps.clone() }, Outcome::Strict),
        ("size", "257 layers", Caps { max_texture_layers: 257, ..caps.clone() }, Outcome::Broken),
        ("size", "volume 2049", Caps { max_volume_texels: 2049, ..caps.clone() }, Outcome::Broken),
        ("range", "bytes 4..", Caps { uniform_alignment_bytes: 4, ..caps.clone() }, Outcome::Broken),
        ("view", "Rgba8Unorm", Caps { srgb_views: false, ..caps.clone() }, Outcome::Strict),
        ("format", "Rgba8Unorm Sampled 2 layers", Caps { multisampled_arrays: true, ..caps.clone() }, Outcome::Broken),
        ("format", "R32Float Storage", Caps { multisampled_storage: true, ..caps.clone() }, Outcome::Broken),
        ("attachments", "", Caps { raster_storage: false, ..caps.clone() }, Outcome::Strict),
        ("format", "Rgba8Snorm StorageFill", Caps { clears_to_value: true, ..caps.clone() }, Outcome::Broken),
        ("format", "Rgba8Snorm StorageClear", Caps { clears_to_zero: true, ..caps.clone() }, Outcome::Broken),
        ("attachments", "", Caps { max_color_attachments: 3, ..caps.clone() }, Outcome::Strict),
        ("planes", "", Caps { sample_read_only_depth: false, ..caps.clone() }, Outcome::Strict),
        ("layers", "", Caps { memoryless_layers: true, max_attached_layers: 6, ..caps.clone() }, Outcome::Broken),
    ];
    let mut missed = Vec::new();
    for (number, (kind, name, caps, expected)) in planted.into_iter().enumerate() {
        let mut cases = generate::cases(&Caps::wgpu(), 1 << 20);
        cases.retain(|case| case.kind == kind && case.name.starts_with(name));
        let found = tally(&gpu, caps, &cases);
        let word = format!("{expected:?}");
        if !found.broken.iter().any(|line| line.starts_with(&word)) {
            missed.push(format!("{number}: {kind} {name} in {} cases: {:?}", cases.len(), found.broken.first()));
        }
    }
    // The baseline has no compressed formats.
    let gpu = Gpu::noop()?;
    let mut cases = generate::cases(&gpu.caps(), 1 << 20);
    cases.retain(|case| case.kind == "block");
    let found = tally(&gpu, Caps { partial_blocks: true, ..gpu.caps() }, &cases);
    assert!(found.broken.iter().any(|line| line.starts_with("Broken")), "{:?}", found.broken.first());
    assert!(missed.is_empty(), "{missed:#?}");
    Ok(())
}
