//! Executes one graph frame after frame, and compares what is left with the simulation.

use super::record::{Frame, Ranges};
use crate::bench::{TestResult, again};
use framegraph::{Desc, Exit, Graph, Kind, Options, PassFlags, PassKind, Plan, ResourceId, Scratch, Usage};
use framegraph_queues::Schedule;
use framegraph_vulkan::ash::vk;
use framegraph_vulkan::testing::{self, Kit, Part, TestDevice, WORD};
use framegraph_vulkan::{Executor, ExecutorOptions, Imports};
use graph_contents::code::{bytes_of, planes};
use graph_contents::copy::NOTE_BYTES;
use graph_contents::oracle::{self, Contents, Outcome, Past};
use graph_contents::{FRAME, copy, spec};
use std::collections::HashMap;

/// Result of executing a graph.
#[derive(Debug, Default)]
pub struct Verdict {
    /// Compared levels, layers, planes and buffers, and how many of them are undefined.
    pub parts: u64,
    pub unknown: u64,
    /// Compared digests and notes.
    pub digests: u64,
    /// Same-pixel reads of input attachments.
    pub in_tile: u64,
    /// Passes in subpasses beyond the first.
    pub subpasses: u64,
    pub differences: Vec<String>,
    /// The executed plan.
    pub plan: Plan,
}

impl Verdict {
    pub fn add(&mut self, other: &Self) {
        self.parts += other.parts;
        self.unknown += other.unknown;
        self.digests += other.digests;
        self.in_tile += other.in_tile;
        self.subpasses += other.subpasses;
    }
}

/// A graph with its plan.
pub struct Case<'d> {
    device: &'d TestDevice,
    pub plan: Plan,
}

impl<'d> Case<'d> {
    /// Compiles a graph for a device whose attachments can be memoryless.
    pub fn new(device: &'d TestDevice, graph: Graph, options: &Options) -> TestResult<Self> {
        let (mut caps, mut plan) = (device.gpu().caps(), Plan::new());
        (caps.memoryless, caps.memoryless_layers) = (true, true);
        device.gpu().compile(&graph, &caps, options, &mut Scratch::new(), &mut plan)?;
        let is_copy = |p: &framegraph::PassId| graph.passes()[p.index()].kind == PassKind::Copy;
        if graph.pass_ids().filter(is_copy).any(|p| copy::copies(&graph, p).is_none()) {
            return Err("a plane is copied alone".into());
        }
        if plan.step_ids().any(|step| plan.full_screen_resolves(step).next().is_some()) {
            return Err("a full-screen resolve has no recorder".into());
        }
        if plan.steps().iter().any(|step| step.kind == PassKind::Raster && step.layers == 0) {
            return Err("raster passes without attachments have no size in the simulation".into());
        }
        // Mesa's software driver draws the first view only, which the tests of `framegraph-wgpu` detect by drawing.
        let draws_layers = !device.gpu().name().contains("llvmpipe");
        if !draws_layers && plan.steps().iter().any(|step| step.layers > 1) {
            return Err("the driver does not draw into several layers".into());
        }
        Ok(Self { device, plan })
    }

    /// Takes a plan as it is.
    pub fn with_plan(device: &'d TestDevice, plan: Plan) -> Self {
        Self { device, plan }
    }

    /// Executes some frames.
    pub fn run(&self, schedule: Option<&Schedule>) -> TestResult<Verdict> {
        let (graph, plan, gpu) = (self.plan.graph(), &self.plan, self.device.gpu());
        let options = ExecutorOptions { multiview: true, explicit_chains: true, ..ExecutorOptions::default() };
        let (mut executor, mut kit) = (Executor::with(gpu, options)?, Kit::new(gpu));
        executor.prepare(plan, schedule.map(|schedule| (schedule, None)))?;
        let (mut verdict, mut shaders) = (Verdict { plan: plan.clone(), ..Verdict::default() }, HashMap::new());
        let mut past: Past = vec![Vec::new(); graph.resources().len()];
        let history = graph.resources().iter().any(|r| matches!(r.kind, Kind::HistoryPrevious { .. }));
        for number in 1..=if history { 4 } else { 2 } {
            // New imports in each frame, because what discarded imports hold after a frame is undefined.
            let imports = testing::imports(&mut kit, plan)?;
            let usage = vk::BufferUsageFlags::UNIFORM_BUFFER | vk::BufferUsageFlags::STORAGE_BUFFER;
            let upload = Ranges::new(&mut kit, 1 << 21, usage)?;
            let witness = Ranges::new(&mut kit, 1 << 19, usage)?;
            let notes = Ranges::new(&mut kit, 1 << 19, usage)?;
            let mut frame = Frame {
                kit: &mut kit,
                number,
                upload,
                uploaded: Vec::new(),
                witness,
                witnesses: Vec::new(),
                notes,
                noted: Vec::new(),
                shaders: &mut shaders,
                in_tile: 0,
            };
            let mut subpasses = 0;
            executor.execute(plan, again(&imports), |cx| {
                frame.record(cx)?;
                frame.kit.write(frame.upload.buffer, &frame.uploaded)?;
                subpasses += u64::from(cx.subpass() > 0);
                Ok(())
            })?;
            executor.wait()?;
            let Frame { witnesses, noted, in_tile, .. } = frame;
            (verdict.in_tile, verdict.subpasses) = (verdict.in_tile + in_tile, verdict.subpasses + subpasses);
            let entry = graph.resource_ids().map(|id| Some(entry(graph, id))).collect::<Vec<_>>();
            let outcome = oracle::run(graph, number, &entry, &past, true);
            let mut found =
                Found { number, kit: &mut kit, executor: &executor, imports: &imports, plan, verdict: &mut verdict };
            found.digests(&outcome, witness, &witnesses)?;
            found.notes(&outcome, notes, &noted)?;
            found.kept(&outcome)?;
            for (id, row) in graph.resource_ids().zip(graph.resources()) {
                let written = graph.versions().iter().any(|v| v.resource == id && !v.writer.is_none());
                if matches!(row.kind, Kind::HistoryCurrent { .. }) && written {
                    past[id.index()].insert(0, outcome.contents[id.index()].clone());
                }
            }
        }
        Ok(verdict)
    }
}

/// Returns the contents that `testing::imports` creates.
fn entry(graph: &Graph, id: ResourceId) -> Contents {
    match graph.resources()[id.index()].desc {
        Desc::Buffer(desc) => {
            let words = (0..desc.bytes(FRAME) / 4).flat_map(|_| WORD.to_le_bytes()).collect();
            Contents::Buffer(Some(words))
        }
        Desc::Texture(_) => oracle::blank(graph, id, true),
    }
}

/// Results of a frame.
struct Found<'f> {
    number: u32,
    kit: &'f mut Kit,
    executor: &'f Executor,
    imports: &'f Imports,
    plan: &'f Plan,
    verdict: &'f mut Verdict,
}

impl Found<'_> {
    fn differ(&mut self, text: &str) {
        self.verdict.differences.push(format!("frame {}: {text}", self.number));
    }

    fn digests(&mut self, outcome: &Outcome, ranges: Ranges, witnesses: &[(usize, u64)]) -> TestResult {
        let graph = self.plan.graph();
        let bytes = self.kit.read(ranges.buffer, ranges.buffer.bytes as usize)?;
        for (pass, offset) in witnesses {
            let at = *offset as usize;
            let found = u32::from_le_bytes([bytes[at], bytes[at + 1], bytes[at + 2], bytes[at + 3]]);
            // A stencil draw whose first pixel fails writes no witness.
            if let Some(expected) = outcome.digests[*pass].filter(|_| found != 0) {
                self.verdict.digests += 1;
                if found != expected {
                    let name = graph.pass_name(framegraph::PassId::at(*pass)).to_owned();
                    self.differ(&format!("pass `{name}` read {found:08x}, not {expected:08x}"));
                }
            }
        }
        for pass in graph.pass_ids() {
            let row = &graph.passes()[pass.index()];
            let ran = row.kind == PassKind::Copy || witnesses.iter().any(|(other, _)| *other == pass.index());
            if row.flags.has(PassFlags::SIDE_EFFECT) && !ran {
                let name = graph.pass_name(pass).to_owned();
                self.differ(&format!("pass `{name}` has side effects and did not run"));
            }
        }
        Ok(())
    }

    fn notes(&mut self, outcome: &Outcome, ranges: Ranges, noted: &[(usize, usize, u64)]) -> TestResult {
        let bytes = self.kit.read(ranges.buffer, ranges.buffer.bytes as usize)?;
        for (pass, note, offset) in noted {
            let Some(expected) = &outcome.notes[*pass][*note] else { continue };
            let found = &bytes[*offset as usize..(*offset + NOTE_BYTES) as usize][..expected.len()];
            self.verdict.digests += 1;
            if found != &expected[..] {
                let name = self.plan.graph().pass_name(framegraph::PassId::at(*pass)).to_owned();
                let wrong = expected.iter().zip(found).filter(|(e, f)| e != f).count();
                self.differ(&format!("copy pass `{name}`: {wrong} of {} bytes of note {note} differ", expected.len()));
            }
        }
        Ok(())
    }

    /// Compares exports, kept imports and histories.
    fn kept(&mut self, outcome: &Outcome) -> TestResult {
        let (plan, graph) = (self.plan, self.plan.graph());
        for id in graph.resource_ids() {
            let row = graph.resources()[id.index()];
            let used = plan.resources()[id.index()].usage != Usage::NONE;
            let exported = graph.exports().iter().any(|export| export.resource == id);
            let keeps = matches!(row.kind, Kind::Imported { exit: Exit::Keep, .. } | Kind::HistoryCurrent { .. });
            if !used || !(exported || keeps) {
                continue;
            }
            match (&outcome.contents[id.index()], row.desc) {
                (Contents::Texture(parts), Desc::Texture(desc)) if desc.samples == 1 => {
                    let image = self.executor.exported(id).map(|e| e.image).or_else(|| self.imports.bound_image(id));
                    let Some(image) = image else { continue };
                    for mip in 0..desc.mip_count(FRAME) {
                        for layer in 0..u32::from(desc.layers) {
                            for plane in planes(desc.format) {
                                let at = oracle::part_index(graph, id, mip as u8, layer as u16, plane);
                                let number = spec::plane_index(desc.format, plane) as u32;
                                let layout = self.executor.layout(id, image, mip, layer, number);
                                let Some(texels) = parts[at].as_ref() else {
                                    self.verdict.unknown += 1;
                                    continue;
                                };
                                let expected: Vec<u8> =
                                    texels.iter().flat_map(|t| bytes_of(desc.format, plane, *t)).collect();
                                let place = format!("`{}` {mip} {layer} {plane:?}", graph.resource_name(id));
                                if layout == vk::ImageLayout::UNDEFINED {
                                    self.differ(&format!("{place} was never written"));
                                    continue;
                                }
                                let aspect = match plane {
                                    framegraph::Aspect::Depth => vk::ImageAspectFlags::DEPTH,
                                    framegraph::Aspect::Stencil => vk::ImageAspectFlags::STENCIL,
                                    framegraph::Aspect::All => vk::ImageAspectFlags::COLOR,
                                };
                                let extent = desc.mip_extent(FRAME, mip);
                                let texel_bytes = (expected.len() / texels.len()) as u32;
                                let part = Part { image, layout, aspect, mip, layer, extent, texel_bytes };
                                let found = self.kit.read_image(&part)?;
                                self.bytes(&place, &expected, &found);
                            }
                        }
                    }
                }
                (Contents::Buffer(bytes), _) => {
                    let buffer = self.executor.exported(id).map(|e| e.buffer).or_else(|| self.imports.bound_buffer(id));
                    let (Some(buffer), Some(expected)) = (buffer, bytes) else {
                        self.verdict.unknown += 1;
                        continue;
                    };
                    let found = self.kit.read_buffer(buffer, expected.len() as u64)?;
                    self.bytes(&format!("`{}`", graph.resource_name(id)), expected, &found);
                }
                _ => self.verdict.unknown += 1,
            }
        }
        Ok(())
    }

    fn bytes(&mut self, place: &str, expected: &[u8], found: &[u8]) {
        self.verdict.parts += 1;
        let wrong = expected.iter().zip(found).filter(|(e, f)| e != f).count();
        if wrong > 0 || expected.len() != found.len() {
            self.differ(&format!("{place}: {wrong} of {} bytes differ", expected.len()));
        }
    }
}
