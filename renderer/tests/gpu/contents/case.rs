//! Runs one random graph on the device and on the CPU, frame after frame, and reports differences.

use super::code::{Texel, coding, planes};
use super::copy::{NOTE_BYTES, NOTES};
use super::oracle::{self, Contents, Outcome, Past};
use super::probe::{Item, Probe};
use super::record::{Stage, record};
use super::record_copy::note_offset;
use super::spec::Class;
use super::{FRAME, copy, spec};
use framegraph::{
    AccessKind, Desc, Dimension, Entry, Exit, Graph, Intent, Kind, Options, PassFlags, PassId, PassKind, Placement,
    Plan, Range, ResourceId, Scratch, Usage,
};
use framegraph_wgpu::Frame;
use framegraph_wgpu::{
    ExecuteError, Executor, ExecutorOptions, Gpu, Imports, Workers, buffer_usages, texture_format, texture_usages,
};
use wgpu::BufferUsages;

/// Maximum number of passes in a graph.
const PASSES: u64 = 256;

/// Runs graphs on one device.
pub struct Runner {
    pub gpu: Gpu,
    /// One executor without poisoning and one with it.
    executors: [Executor; 2],
    /// Fills imports.
    prelude: Executor,
    probe: Probe,
    stage: Stage,
    scratch: Scratch,
    /// True if the driver can draw into several layers at once.
    layered: bool,
}

/// Result of running a graph.
#[derive(Clone, Debug, Default)]
pub struct Verdict {
    /// Number of compared levels, layers, planes and buffers, and how many of them are undefined.
    pub parts: u64,
    pub unknown: u64,
    /// Number of compared pass digests and copy notes.
    pub digests: u64,
    /// Number of digests that are undefined.
    pub unknown_digests: u64,
    /// Number of reads that influence no output, or only in part.
    pub unobserved: u64,
    /// Differences between device and oracle, as text.
    pub differences: Vec<String>,
}

/// Reason why a graph cannot be executed on this device, as one word.
pub type Beyond = &'static str;

/// A graph with its plan, ready to run.
pub struct Case {
    pub plan: Plan,
    frame: Frame<Stage>,
    /// Number of frames to run; more if histories are read.
    frames: u32,
}

impl Case {
    /// Returns the frame with another plan of its graph.
    pub fn planned(self, plan: Plan) -> Self {
        Self { plan, ..self }
    }
}

impl Runner {
    /// Returns why graphs with these shaders cannot be executed on a device, if so.
    pub fn unfit(gpu: &Gpu) -> Option<&'static str> {
        let gl = gpu.info().backend == wgpu::Backend::Gl;
        gl.then_some(
            "its passes load texels of depth textures and read storage in vertex shaders, which OpenGL does not",
        )
    }

    pub fn new(gpu: &Gpu) -> Result<Self, Box<dyn std::error::Error>> {
        let buffer = |label, size| {
            let usage = BufferUsages::STORAGE | BufferUsages::COPY_SRC | BufferUsages::COPY_DST;
            let label = Some(label);
            gpu.device.create_buffer(&wgpu::BufferDescriptor { label, size, usage, mapped_at_creation: false })
        };
        let stage = Stage::new(buffer("witness", PASSES * 4), buffer("notes", PASSES * NOTES as u64 * NOTE_BYTES));
        let executor =
            |poison| Executor::with(gpu, ExecutorOptions { poison, timing: false, ..ExecutorOptions::default() });
        // One of the two executors records on several threads.
        let mut threaded = executor(false);
        threaded.force_record_on(Workers::with_threads(3)?);
        Ok(Self {
            gpu: gpu.clone(),
            executors: [threaded, executor(true)],
            prelude: executor(false),
            probe: Probe::new(gpu),
            stage,
            scratch: Scratch::new(),
            layered: gpu.max_attached_layers()? > 1,
        })
    }

    /// Compiles a graph and adds a recorder to each pass.
    pub fn prepare(&mut self, graph: Graph, options: &Options) -> Result<Result<Case, Beyond>, String> {
        let mut plan = Plan::new();
        if self.executors[0].compile(&graph, options, &mut self.scratch, &mut plan).is_err() {
            return Ok(Err("refused by the compiler"));
        }
        let copies = |p: PassId| plan.graph().passes()[p.index()].kind == PassKind::Copy;
        let mut kept = plan.graph().pass_ids().filter(|p| copies(*p));
        if kept.any(|p| copy::copies(plan.graph(), p).is_none()) {
            return Ok(Err("a plane copied alone"));
        }
        if plan.graph().pass_ids().any(|p| !self.binds(plan.graph(), p)) {
            return Ok(Err("more bindings than the device has"));
        }
        if !self.layered && plan.steps().iter().any(|s| s.layers > 1) {
            return Ok(Err("several layers"));
        }
        let history = plan.graph().resources().iter().any(|r| matches!(r.kind, Kind::HistoryPrevious { .. }));
        Ok(Ok(Case { frame: recorded(graph), plan, frames: if history { 4 } else { 2 } }))
    }

    /// Returns whether the device can bind all inputs of a pass, its output and the witness buffer.
    fn binds(&self, graph: &Graph, pass: PassId) -> bool {
        let (inputs, limits) = (spec::inputs(graph, pass, false), self.gpu.device.limits());
        let count = |of: fn(&Class) -> bool| inputs.iter().filter(|i| of(&i.class)).count() as u32;
        count(|c| matches!(c, Class::Texture(..))) <= limits.max_sampled_textures_per_shader_stage
            && count(|c| matches!(c, Class::Storage(_))) < limits.max_storage_textures_per_shader_stage
            && count(|c| *c == Class::Buffer) + 1 < limits.max_storage_buffers_per_shader_stage
            && count(|c| *c == Class::Uniform) < limits.max_uniform_buffers_per_shader_stage
    }

    /// Runs a case and compares every frame.
    pub fn run(&mut self, case: &Case, poison: bool) -> Result<Result<Verdict, Beyond>, String> {
        let (graph, mut verdict) = (case.plan.graph(), Verdict::default());
        for pass in graph.pass_ids() {
            verdict.unobserved += spec::unobserved(graph, pass) as u64;
            let copies = copy::copies(graph, pass).unwrap_or_default();
            verdict.unobserved += copy::unobserved(graph, pass, &copies) as u64;
        }
        let Ok(imports) = self.gpu.guard("an import", || imports(&self.gpu, &case.plan)) else {
            return Ok(Err("import"));
        };
        let executor = usize::from(poison);
        self.executors[executor].reset_histories();
        let mut past: Past = vec![Vec::new(); graph.resources().len()];
        for frame in 1..=case.frames {
            let entry = self.fill_imports(case, &imports, 1000 + frame).map_err(|e| format!("prelude: {e}"))?;
            self.stage.frame = frame;
            self.gpu.queue.write_buffer(&self.stage.witness, 0, &[0; PASSES as usize * 4]);
            for pass in graph.pass_ids().filter(|p| graph.passes()[p.index()].kind == PassKind::Copy) {
                let blank = [0; NOTES * NOTE_BYTES as usize];
                self.gpu.queue.write_buffer(&self.stage.notes, note_offset(pass, 0), &blank);
            }
            match self.executors[executor].execute(&case.plan, &case.frame, &self.stage, &imports.bound) {
                Ok(_) => {}
                Err(ExecuteError::NoAttachment { .. }) => return Ok(Err("no attachment")),
                Err(ExecuteError::Planes { .. }) => return Ok(Err("planes apart")),
                Err(ExecuteError::Unsupported(_)) => return Ok(Err("format or size")),
                Err(ExecuteError::Layers { .. }) => return Ok(Err("several layers")),
                Err(ExecuteError::Clear { .. }) => return Ok(Err("clear")),
                Err(error) => return Err(error.to_string()),
            }
            let outcome = oracle::run(graph, frame, &entry, &past, false);
            self.compare(case, &imports, &outcome, frame, executor, &mut verdict).map_err(|e| e.to_string())?;
            for (id, row) in graph.resource_ids().zip(graph.resources()) {
                let written = graph.versions().iter().any(|v| v.resource == id && !v.writer.is_none());
                if matches!(row.kind, Kind::HistoryCurrent { .. }) && written {
                    past[id.index()].insert(0, outcome.contents[id.index()].clone());
                }
            }
        }
        Ok(Ok(verdict))
    }

    /// Fills all imports with a separate graph. Returns the contents that passes may read.
    fn fill_imports(
        &mut self,
        case: &Case,
        imports: &Imported,
        frame: u32,
    ) -> Result<Vec<Option<Contents>>, Box<dyn std::error::Error>> {
        let graph = case.plan.graph();
        let mut entry = vec![None; graph.resources().len()];
        if imports.textures.is_empty() && imports.buffers.is_empty() {
            return Ok(entry);
        }
        let mut prelude = Graph::new();
        let mut made = Vec::new();
        for (resource, _) in &imports.textures {
            let Desc::Texture(desc) = graph.resources()[resource.index()].desc else { continue };
            made.push((*resource, prelude.resources().len()));
            let name = graph.resource_name(*resource);
            let mut texture = prelude.import_texture(name, desc, Entry::Undefined, Exit::Keep);
            for mip in 0..desc.mip_count(FRAME) as u8 {
                for layer in 0..desc.layers {
                    let range = Range { mip, mips: 1, layer, layers: 1, ..Range::ALL };
                    texture = prelude.add_fn("fill", |p| match desc.format.is_depth_stencil() {
                        true => p.depth(texture.range(range), Intent::Overwrite),
                        false => p.color(texture.range(range), Intent::Overwrite),
                    })?;
                }
            }
        }
        for (resource, _) in &imports.buffers {
            let bytes = graph.resources()[resource.index()].desc.bytes(FRAME);
            made.push((*resource, prelude.resources().len()));
            let buffer = prelude.import_buffer(graph.resource_name(*resource), bytes, Entry::Undefined, Exit::Keep);
            prelude.add_fn("fill", |p| p.write_buffer(buffer, AccessKind::StorageWrite, Intent::Overwrite))?;
        }
        let mut plan = Plan::new();
        let options = Options { frame: FRAME, ..Options::default() };
        framegraph::compile(&prelude, &self.gpu.caps(), &options, &mut self.scratch, &mut plan)?;
        self.stage.frame = frame;
        self.prelude.execute(&plan, &recorded(prelude), &self.stage, &imports.bound)?;
        let mut outcome = oracle::run(plan.graph(), frame, &[], &Vec::new(), false);
        for (resource, row) in made {
            entry[resource.index()] = Some(std::mem::replace(&mut outcome.contents[row], Contents::Buffer(None)));
        }
        Ok(entry)
    }

    /// Compares digests, exports, and imports that are kept.
    fn compare(
        &self,
        case: &Case,
        imports: &Imported,
        outcome: &Outcome,
        frame: u32,
        executor: usize,
        verdict: &mut Verdict,
    ) -> Result<(), Box<dyn std::error::Error>> {
        let graph = case.plan.graph();
        let mut kept: Vec<ResourceId> = graph.exports().iter().map(|e| e.resource).collect();
        kept.extend(graph.resource_ids().filter(|r| {
            let written = case.plan.resources()[r.index()].usage != Usage::NONE;
            match graph.resources()[r.index()].kind {
                Kind::Imported { exit: Exit::Keep, .. } => imports.has(*r),
                Kind::HistoryCurrent { .. } => written,
                _ => false,
            }
        }));
        // An exported import that no pass uses is not compared.
        let lent = |r: &ResourceId| matches!(graph.resources()[r.index()].kind, Kind::Imported { .. });
        kept.retain(|r| !lent(r) || imports.has(*r));
        kept.sort_unstable();
        kept.dedup();
        let mut items = vec![Item::Buffer { buffer: &self.stage.witness, first: 0, bytes: PASSES * 4 }];
        let mut expected: Vec<(String, Option<Vec<u32>>)> = Vec::new();
        for resource in kept {
            let name = graph.resource_name(resource);
            match (&outcome.contents[resource.index()], graph.resources()[resource.index()].desc) {
                (Contents::Texture(parts), Desc::Texture(desc)) => {
                    let texture = self.executors[executor].texture_at(resource).ok_or(format!("`{name}` is gone"))?;
                    for mip in 0..desc.mip_count(FRAME) {
                        for layer in 0..desc.layers {
                            for plane in planes(desc.format) {
                                let at = oracle::part_index(graph, resource, mip as u8, layer, plane);
                                let coding = coding(desc.format, plane);
                                let layer = u32::from(layer);
                                items.push(Item::Part { texture, plane, coding, mip, layer });
                                let words = |texels: &Vec<Texel>| texels.concat();
                                let place = format!("`{name}` level {mip} layer {layer} {plane:?}");
                                expected.push((place, parts[at].as_ref().map(words)));
                            }
                        }
                    }
                }
                (Contents::Buffer(bytes), _) => {
                    let buffer = self.executors[executor].buffer_at(resource).ok_or(format!("`{name}` is gone"))?;
                    let length = graph.resources()[resource.index()].desc.bytes(FRAME);
                    items.push(Item::Buffer { buffer, first: 0, bytes: length });
                    let word = |b: &[u8]| u32::from_le_bytes([b[0], b[1], b[2], b[3]]);
                    let words = bytes.as_ref().map(|bytes| bytes.chunks_exact(4).map(word).collect());
                    expected.push((format!("`{name}`"), words));
                }
                (Contents::Texture(_), Desc::Buffer(_)) => {}
            }
        }
        let notes = graph.pass_ids().flat_map(|p| (0..NOTES).map(move |note| (p, note)));
        let noted: Vec<_> = notes.filter(|(p, note)| outcome.notes[p.index()][*note].is_some()).collect();
        for (pass, note) in &noted {
            let first = note_offset(*pass, *note);
            items.push(Item::Buffer { buffer: &self.stage.notes, first, bytes: NOTE_BYTES });
        }
        let found = self.probe.read(&items)?;
        let mut differ = |text: String| verdict.differences.push(format!("frame {frame}: {text}"));
        for pass in graph.pass_ids() {
            let row = &graph.passes()[pass.index()];
            let (noted, name) = (found[0][pass.index()], graph.pass_name(pass));
            match outcome.digests[pass.index()] {
                _ if row.kind == PassKind::Copy => {}
                _ if noted == 0 && row.flags.has(PassFlags::SIDE_EFFECT) => {
                    differ(format!("pass `{name}` has side effects and did not run"));
                }
                None => verdict.unknown_digests += 1,
                Some(digest) if noted != 0 => {
                    verdict.digests += 1;
                    if digest != noted {
                        differ(format!("pass `{name}` read {noted:08x}, not {digest:08x}"));
                    }
                }
                Some(_) => {}
            }
        }
        for ((pass, note), found) in noted.iter().zip(&found[1 + expected.len()..]) {
            let expected = outcome.notes[pass.index()][*note].as_deref().unwrap_or_default();
            let found = &bytemuck::cast_slice::<u32, u8>(found)[..expected.len()];
            let ran = found.iter().any(|b| *b != 0);
            let must = graph.passes()[pass.index()].flags.has(PassFlags::SIDE_EFFECT);
            verdict.digests += u64::from(ran);
            if found != expected && (ran || must) {
                differ(format!("copy pass `{}` read something else", graph.pass_name(*pass)));
            }
        }
        for ((place, expected), found) in expected.iter().zip(&found[1..]) {
            verdict.parts += 1;
            let Some(expected) = expected else {
                verdict.unknown += 1;
                continue;
            };
            let wrong = expected.iter().zip(found).filter(|(e, f)| e != f).count();
            if wrong > 0 {
                let first = expected.iter().zip(found).position(|(e, f)| e != f).unwrap_or(0);
                let (e, f) = (expected[first], found[first]);
                let total = expected.len();
                differ(format!("{place}: {wrong} of {total} words differ, word {first} is {f:x}, not {e:x}"));
            }
        }
        Ok(())
    }
}

/// Textures and buffers bound to imports.
struct Imported {
    bound: Imports,
    textures: Vec<(ResourceId, wgpu::Texture)>,
    buffers: Vec<(ResourceId, wgpu::Buffer)>,
}

impl Imported {
    fn has(&self, resource: ResourceId) -> bool {
        self.textures.iter().any(|(r, _)| *r == resource) || self.buffers.iter().any(|(r, _)| *r == resource)
    }
}

/// Creates a frame whose passes are recorded according to `spec`.
fn recorded(graph: Graph) -> Frame<Stage> {
    let mut frame = Frame::from_graph(graph);
    frame.allow_threads();
    for pass in frame.graph().pass_ids() {
        frame.set_recorder(pass, |pass, stage: &Stage, cx| {
            drop(cx.inlined());
            record(cx, *pass, stage)
        });
    }
    frame
}

/// Creates the textures and buffers that the plan imports.
fn imports(gpu: &Gpu, plan: &Plan) -> Imported {
    let (graph, mut imported) =
        (plan.graph(), Imported { bound: Imports::new(), textures: Vec::new(), buffers: Vec::new() });
    for (resource, row) in graph.resource_ids().zip(plan.resources()) {
        if row.placement != Placement::External || row.first.is_none() {
            continue;
        }
        let name = graph.resource_name(resource);
        match graph.resources()[resource.index()].desc {
            Desc::Texture(desc) => {
                let [width, height] = desc.extent.texels(plan.frame());
                let three = desc.dimension == Dimension::D3;
                let uses = wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING;
                let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
                    label: Some(name),
                    size: wgpu::Extent3d { width, height, depth_or_array_layers: desc.layers.into() },
                    mip_level_count: desc.mip_count(plan.frame()),
                    sample_count: desc.samples.into(),
                    dimension: if three { wgpu::TextureDimension::D3 } else { wgpu::TextureDimension::D2 },
                    format: texture_format(desc.format),
                    usage: texture_usages(row.usage) | uses,
                    view_formats: &[],
                });
                imported.bound.texture_named(name, &texture);
                imported.textures.push((resource, texture));
            }
            Desc::Buffer(desc) => {
                let uses = BufferUsages::STORAGE | BufferUsages::COPY_SRC | BufferUsages::COPY_DST;
                let buffer = gpu.device.create_buffer(&wgpu::BufferDescriptor {
                    label: Some(name),
                    size: desc.bytes(FRAME),
                    usage: buffer_usages(row.usage) | uses,
                    mapped_at_creation: false,
                });
                imported.bound.buffer_named(name, &buffer);
                imported.buffers.push((resource, buffer));
            }
        }
    }
    imported
}
