//! Records the work that `graph_contents::spec` defines for a pass.

use framegraph::{Access, AccessKind, Aspect, Desc, Format, Graph, PassKind};
use framegraph_vulkan::ash::vk;
use framegraph_vulkan::testing::{Bound, DepthTest, Dispatch, Draw, Kit};
use framegraph_vulkan::{BoundBuffer, Cx, Error, RecordError, ViewShape};
use graph_contents::code::{Coding, Numeric, STENCIL_STEP, coding};
use graph_contents::shader::{Out, PARAMS, Signature, Stage};
use graph_contents::spec::{self, Class, Input, Paint};
use std::collections::HashMap;

/// Distance of ranges in the buffers of a frame, in bytes.
const ROW: u64 = 256;

/// A buffer that a frame uses range by range.
#[derive(Clone, Copy)]
pub struct Ranges {
    pub buffer: BoundBuffer,
    next: u64,
}

impl Ranges {
    pub fn new(kit: &mut Kit, bytes: usize, usage: vk::BufferUsageFlags) -> Result<Self, Error> {
        Ok(Self { buffer: kit.buffer(&vec![0; bytes], usage)?, next: 0 })
    }

    /// Returns the next range of this size.
    pub fn take(&mut self, bytes: u64) -> BoundBuffer {
        let offset = self.next;
        self.next += bytes.next_multiple_of(ROW);
        assert!(self.next <= self.buffer.bytes, "a frame needs more than {} bytes", self.buffer.bytes);
        BoundBuffer { offset, bytes, ..self.buffer }
    }
}

/// State shared by the recorders of a frame.
pub struct Frame<'k> {
    pub kit: &'k mut Kit,
    pub number: u32,
    /// Parameters of shaders and patterns of copies, as ranges of a buffer and as bytes.
    pub upload: Ranges,
    pub uploaded: Vec<u8>,
    /// Digests of draws and dispatches, with the pass and the offset in bytes.
    pub witness: Ranges,
    pub witnesses: Vec<(usize, u64)>,
    /// Notes of copy passes.
    pub notes: Ranges,
    pub noted: Vec<(usize, usize, u64)>,
    pub shaders: &'k mut HashMap<Signature, String>,
    /// Number of reads in the tile.
    pub in_tile: u64,
}

impl Frame<'_> {
    /// Returns a range with these bytes. The frame writes them into the buffer before it is submitted.
    pub fn put(&mut self, bytes: &[u8]) -> Result<BoundBuffer, Error> {
        let range = self.upload.take(bytes.len() as u64);
        let first = range.offset as usize;
        self.uploaded.resize(self.uploaded.len().max(first + bytes.len()), 0);
        self.uploaded[first..first + bytes.len()].copy_from_slice(bytes);
        Ok(range)
    }

    /// Records a pass.
    pub fn record(&mut self, cx: &mut Cx<'_>) -> Result<(), RecordError> {
        let graph = cx.plan().graph();
        match graph.passes()[cx.pass().index()].kind {
            PassKind::Copy => self.copies(cx),
            kind => {
                let mut recorder = Recorder {
                    graph,
                    inputs: spec::inputs(graph, cx.pass(), true),
                    bindings: Vec::new(),
                    indirect: None,
                    compute: kind == PassKind::Compute,
                };
                for input in 0..recorder.inputs.len() {
                    let bound = recorder.bind(cx, input, self)?;
                    recorder.bindings.push(bound);
                }
                if let Some(row) = spec::indirect(graph, cx.pass()) {
                    recorder.indirect = Some(cx.buffer_of(&graph.accesses_of(cx.pass())[row])?);
                }
                recorder.all(cx, self)
            }
        }
    }
}

struct Recorder<'g> {
    graph: &'g Graph,
    inputs: Vec<Input>,
    bindings: Vec<Bound>,
    indirect: Option<BoundBuffer>,
    compute: bool,
}

/// One draw or dispatch.
#[derive(Clone, Copy)]
struct Work {
    out: Out,
    coding: Option<Coding>,
    tag: u32,
    paint: Paint,
    target: Option<Bound>,
    depth: DepthTest,
    z: f32,
    stencil: u32,
    takes_arguments: bool,
}

impl Work {
    const NOTHING: Self = Self {
        out: Out::Nothing,
        coding: None,
        tag: 0,
        paint: Paint::All,
        target: None,
        depth: DepthTest::NONE,
        z: 0.5,
        stencil: 0,
        takes_arguments: false,
    };
}

impl Recorder<'_> {
    fn bind(&mut self, cx: &mut Cx<'_>, index: usize, frame: &mut Frame<'_>) -> Result<Bound, RecordError> {
        let Input { access, class, plane, mip, offset } = self.inputs[index];
        let row = self.graph.accesses_of(cx.pass())[access];
        let aspect = (plane != Aspect::All).then_some(plane);
        let shape = ViewShape { arrayed: true, aspect, ..ViewShape::default() };
        Ok(match class {
            Class::Buffer => Bound::Buffer(cx.buffer_of(&row)?),
            Class::Uniform => {
                let part = cx.buffer_of(&row)?;
                Bound::Uniform(BoundBuffer { offset: part.offset + offset, bytes: spec::UNIFORM_BYTES, ..part })
            }
            Class::Storage(_) => Bound::Storage(cx.bind(&row, ViewShape { mip: Some(mip), ..shape })?),
            Class::SamePixel(numeric, samples) => {
                let bound = cx.bind(&row, ViewShape { arrayed: !samples, ..shape })?;
                if bound.input.is_none() {
                    return Ok(Bound::Texture(bound));
                }
                frame.in_tile += 1;
                self.inputs[index].class = Class::InTile(numeric, samples);
                Bound::Texture(cx.bind(&row, ViewShape { arrayed: false, ..shape })?)
            }
            Class::Texture(_, samples) | Class::InTile(_, samples) => {
                Bound::Texture(cx.bind(&row, ViewShape { arrayed: !samples, ..shape })?)
            }
        })
    }

    /// Records all outputs of the pass. Color comes first, since it is tested against the depth before the pass.
    fn all(&self, cx: &mut Cx<'_>, frame: &mut Frame<'_>) -> Result<(), RecordError> {
        let mut worked = false;
        let own = self.graph.accesses_of(cx.pass());
        for kind in [AccessKind::Color, AccessKind::Depth, AccessKind::StorageWrite] {
            for (row, access) in own.iter().enumerate().filter(|(_, a)| a.kind == kind) {
                match kind {
                    AccessKind::Color => self.color(cx, frame, row, access)?,
                    AccessKind::Depth => self.depth(cx, frame, row, access)?,
                    _ => self.storage(cx, frame, row, access)?,
                }
                worked = true;
            }
        }
        if worked { Ok(()) } else { self.work(cx, frame, Work::NOTHING) }
    }

    fn color(&self, cx: &mut Cx<'_>, frame: &mut Frame<'_>, row: usize, access: &Access) -> Result<(), RecordError> {
        let coding = coding(self.format(access), Aspect::All);
        let tag = spec::tag(row, 0, access.range.mip) + u32::from(access.range.layer);
        let out = Out::Color(access.slot, if coding.numeric == Numeric::Uint { Numeric::Uint } else { Numeric::Float });
        let plain = Work { out, coding: Some(coding), tag, paint: spec::paint(access.mode), ..Work::NOTHING };
        self.work(cx, frame, Work { takes_arguments: true, ..plain })?;
        let Some(tested) = spec::tested(self.graph, cx.pass()) else { return Ok(()) };
        let tested = self.graph.accesses_of(cx.pass())[tested];
        for plane in spec::planes_of(self.format(&tested), tested.range.aspect) {
            let equal = DepthTest { stencil: Some(vk::CompareOp::EQUAL), reference: STENCIL_STEP, ..DepthTest::NONE };
            let nearer = DepthTest { compare: vk::CompareOp::GREATER_OR_EQUAL, ..DepthTest::NONE };
            let work = match plane {
                Aspect::Stencil => {
                    Work { tag: tag | spec::STENCIL_PASSED, depth: equal, stencil: STENCIL_STEP, ..plain }
                }
                _ => Work { tag: tag | spec::DEPTH_PASSED, depth: nearer, z: spec::TESTED_DEPTH, ..plain },
            };
            self.work(cx, frame, work)?;
        }
        Ok(())
    }

    fn depth(&self, cx: &mut Cx<'_>, frame: &mut Frame<'_>, row: usize, access: &Access) -> Result<(), RecordError> {
        let format = self.format(access);
        for plane in spec::planes_of(format, access.range.aspect) {
            let index = spec::plane_index(format, plane);
            let tag = spec::tag(row, index, access.range.mip) + u32::from(access.range.layer);
            let work =
                Work { coding: Some(coding(format, plane)), tag, paint: spec::paint(access.mode), ..Work::NOTHING };
            if plane == Aspect::Depth {
                let depth = DepthTest { write: true, ..DepthTest::NONE };
                self.work(cx, frame, Work { out: Out::Depth, depth, takes_arguments: true, ..work })?;
                continue;
            }
            for value in 0..4 {
                let stencil = value * STENCIL_STEP;
                let depth = DepthTest { stencil_write: true, reference: stencil, ..DepthTest::NONE };
                self.work(cx, frame, Work { out: Out::Stencil, depth, stencil, ..work })?;
            }
        }
        Ok(())
    }

    fn storage(&self, cx: &mut Cx<'_>, frame: &mut Frame<'_>, row: usize, access: &Access) -> Result<(), RecordError> {
        let work = Work { paint: spec::paint(access.mode), takes_arguments: true, ..Work::NOTHING };
        let Desc::Texture(desc) = self.graph.resources()[access.resource.index()].desc else {
            let target = Some(Bound::Buffer(cx.buffer_of(access)?));
            return self.work(cx, frame, Work { out: Out::Buffer, tag: spec::tag(row, 0, 0), target, ..work });
        };
        let coding = Some(coding(desc.format, Aspect::All));
        for mip in spec::mips(self.graph, access) {
            let shape = ViewShape { arrayed: true, mip: Some(mip), ..ViewShape::default() };
            let target = Some(Bound::Storage(cx.bind(access, shape)?));
            let tag = spec::tag(row, 0, mip) + u32::from(access.range.layer);
            self.work(cx, frame, Work { out: Out::Texture(desc.format), coding, tag, target, ..work })?;
        }
        Ok(())
    }

    fn format(&self, access: &Access) -> Format {
        let desc = self.graph.resources()[access.resource.index()].desc;
        desc.texture().map_or(Format::R8Unorm, |t| t.format)
    }

    /// Records one draw or dispatch.
    fn work(&self, cx: &mut Cx<'_>, frame: &mut Frame<'_>, work: Work) -> Result<(), RecordError> {
        let layers = cx.plan().steps()[cx.step().index()].layers;
        let stage = match layers {
            _ if self.compute => Stage::Compute,
            0 | 1 => Stage::Raster,
            _ => Stage::Layered,
        };
        let signature = Signature { inputs: self.inputs.iter().map(|i| i.class).collect(), out: work.out, stage };
        let text = frame.shaders.entry(signature.clone()).or_insert_with(|| signature.text()).clone();
        // All fragments of all triangles write to storage; only attachments have a last triangle.
        let stored = matches!(work.out, Out::Texture(_) | Out::Buffer);
        let indirect = self.indirect.filter(|_| work.takes_arguments && (self.compute || !stored));
        let words = self.params(cx, frame.number, &work, &signature, indirect.is_some());
        let bytes: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
        let params = frame.put(&bytes)?;
        let witness = frame.witness.take(4);
        frame.witnesses.push((cx.pass().index(), witness.offset));
        let mut bindings = vec![Bound::Uniform(params), Bound::Buffer(witness)];
        bindings.extend(self.bindings.iter().copied());
        bindings.extend(work.target);
        if self.compute {
            let dispatch = Dispatch { wgsl: &text, bindings: &bindings, groups: [1, 1, 1], indirect };
            return frame.kit.dispatch(cx, &dispatch);
        }
        let slots = if let Out::Color(slot, _) = work.out { 1 << slot } else { 0 };
        frame.kit.draw(cx, &Draw { slots, depth: work.depth, indirect, ..Draw::new(&text, &bindings) })
    }

    /// Returns the words of `Params`.
    fn params(&self, cx: &Cx<'_>, number: u32, work: &Work, signature: &Signature, indirect: bool) -> Vec<u32> {
        let [width, height] = cx.extent();
        let (mask, scale) = work.coding.map_or(([0; 4], [1.0; 4]), |c| (c.mask, c.scale));
        let mut words = vec![spec::salt(cx.pass(), number), work.tag, work.paint as u32, 0];
        words.extend([work.stencil / STENCIL_STEP, indirect.into(), work.z.to_bits(), 0, width, height, 0, 0]);
        words.extend(mask);
        words.extend(scale.map(f32::to_bits));
        assert_eq!(words.len(), PARAMS);
        let own = self.graph.accesses_of(cx.pass());
        let codings = self.inputs.iter().filter_map(|i| match i.class {
            Class::Texture(Numeric::Float, _)
            | Class::SamePixel(Numeric::Float, _)
            | Class::InTile(Numeric::Float, _)
            | Class::Storage(_) => {
                Some(coding(self.format(&own[i.access]), Aspect::All)).filter(|c| c.numeric == Numeric::Float)
            }
            _ => None,
        });
        let codings: Vec<_> = codings.collect();
        assert_eq!(codings.len(), signature.lists());
        codings.iter().for_each(|c| words.extend(c.scale.map(f32::to_bits)));
        words.resize(PARAMS + 4 * signature.lists().max(1), 0);
        codings.iter().for_each(|c| words.extend(c.mask));
        words.resize(PARAMS + 8 * signature.lists().max(1), 0);
        words
    }
}
