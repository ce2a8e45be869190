//! Records the work that `spec` defines for a pass.

use super::code::{Coding, Numeric, STENCIL_STEP, coding};
use super::shader::{Out, PARAMS, Signature};
use super::spec::{self, Class, Input, Paint};
use framegraph::{Access, AccessKind, Aspect, Desc, Graph, PassId, PassKind};
use framegraph_wgpu::{
    Binding, BoundBuffer, BoundResource, Compute, Cx, Depth, Output, Raster, RecordError, Shader, ViewPart,
};
use std::collections::HashMap;
use std::num::NonZeroU64;
use std::sync::{Arc, Mutex, PoisonError};
use wgpu::{ColorWrites, CompareFunction, StencilFaceState, StencilOperation, StencilState, TextureViewDimension};

/// Shared state of all recorders.
pub struct Stage {
    /// Frame number, which salts the digest of every pass.
    pub frame: u32,
    /// Buffer with the digest of each pass.
    pub witness: wgpu::Buffer,
    /// Buffer with the notes of copy passes, [`NOTE_BYTES`](super::copy::NOTE_BYTES) each.
    pub notes: wgpu::Buffer,
    /// Name and source of each shader.
    shaders: Mutex<HashMap<Signature, Arc<(String, String)>>>,
}

impl Stage {
    pub fn new(witness: wgpu::Buffer, notes: wgpu::Buffer) -> Self {
        Self { frame: 0, witness, notes, shaders: Mutex::default() }
    }

    fn shader(&self, signature: &Signature) -> Arc<(String, String)> {
        let mut shaders = self.shaders.lock().unwrap_or_else(PoisonError::into_inner);
        let made = || Arc::new((signature.name(), signature.text()));
        shaders.entry(signature.clone()).or_insert_with(made).clone()
    }
}

/// Records a pass.
pub fn record(cx: &mut Cx<'_>, pass: PassId, stage: &Stage) -> Result<(), RecordError> {
    let graph = cx.plan().graph();
    match graph.passes()[pass.index()].kind {
        PassKind::Copy => super::record_copy::record(cx, pass, stage),
        kind => Recorder::new(cx, graph, pass, stage, kind == PassKind::Compute)?.all(),
    }
}

/// Recorder of one shader pass.
struct Recorder<'r, 'a> {
    cx: &'r mut Cx<'a>,
    graph: &'a Graph,
    pass: PassId,
    stage: &'r Stage,
    compute: bool,
    inputs: Vec<Input>,
    bindings: Vec<(u32, Binding)>,
    indirect: Option<BoundBuffer>,
}

/// One draw or dispatch.
struct Work {
    out: Out,
    coding: Option<Coding>,
    tag: u32,
    paint: Paint,
    /// Output, if it is a binding.
    target: Option<Binding>,
    depth: Depth,
    z: f32,
    /// Stencil value to write or test.
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
        depth: Depth::NONE,
        z: 0.5,
        stencil: 0,
        takes_arguments: false,
    };
}

impl<'r, 'a> Recorder<'r, 'a> {
    fn new(
        cx: &'r mut Cx<'a>,
        graph: &'a Graph,
        pass: PassId,
        stage: &'r Stage,
        compute: bool,
    ) -> Result<Self, RecordError> {
        let inputs = spec::inputs(graph, pass, false);
        let mut recorder = Self { cx, graph, pass, stage, compute, inputs, bindings: Vec::new(), indirect: None };
        for index in 0..recorder.inputs.len() {
            let binding = recorder.bind(recorder.inputs[index])?;
            recorder.bindings.push((Signature::FIRST + index as u32, binding));
        }
        if let Some(row) = spec::indirect(graph, pass)
            && let BoundResource::Buffer(buffer) = recorder.bound(row, ViewPart::WHOLE)?
        {
            recorder.indirect = Some(buffer);
        }
        Ok(recorder)
    }

    fn accesses(&self) -> &'a [Access] {
        self.graph.accesses_of(self.pass)
    }

    /// Returns the resource of a part of an access.
    fn bound(&mut self, access: usize, part: ViewPart) -> Result<BoundResource, RecordError> {
        let id = self.cx.accesses().nth(access).ok_or_else(|| RecordError::custom("no such access"))?;
        self.cx.resource_part(id, part)
    }

    fn bind(&mut self, input: Input) -> Result<Binding, RecordError> {
        let dimension = match input.class {
            Class::Texture(_, true) => TextureViewDimension::D2,
            _ => TextureViewDimension::D2Array,
        };
        let aspect = (input.plane != Aspect::All).then_some(input.plane);
        let mip = matches!(input.class, Class::Storage(_)).then_some(input.mip);
        let part = ViewPart { mip, aspect, ..ViewPart::as_dimension(dimension) };
        Ok(match (self.bound(input.access, part)?, input.class) {
            (BoundResource::Texture { view, .. }, _) => view.into(),
            (BoundResource::Buffer(b), Class::Uniform) => {
                Binding::Buffer { buffer: b.buffer, offset: input.offset, bytes: NonZeroU64::new(spec::UNIFORM_BYTES) }
            }
            (BoundResource::Buffer(b), _) => b.into(),
        })
    }

    /// Records all outputs of the pass. Color comes first, since it is tested against the depth before the pass.
    fn all(mut self) -> Result<(), RecordError> {
        let mut worked = false;
        for kind in [AccessKind::Color, AccessKind::Depth, AccessKind::StorageWrite] {
            for (row, access) in self.accesses().iter().enumerate().filter(|(_, a)| a.kind == kind) {
                match kind {
                    AccessKind::Color => self.color(row, access)?,
                    AccessKind::Depth => self.depth(row, access)?,
                    _ => self.storage(row, access)?,
                }
                worked = true;
            }
        }
        if worked { Ok(()) } else { self.work(Work::NOTHING) }
    }

    fn color(&mut self, row: usize, access: &Access) -> Result<(), RecordError> {
        let coding = self.coding(access, Aspect::All);
        let tag = spec::tag(row, 0, access.range.mip) + u32::from(access.range.layer);
        let out = Out::Color(access.slot, if coding.numeric == Numeric::Uint { Numeric::Uint } else { Numeric::Float });
        let paint = spec::paint(access.mode);
        let plain = || Work { out, coding: Some(coding), tag, paint, ..Work::NOTHING };
        self.work(Work { takes_arguments: true, ..plain() })?;
        let Some(tested) = spec::tested(self.graph, self.pass) else { return Ok(()) };
        let tested = &self.accesses()[tested];
        let format = self.format(tested);
        for plane in spec::planes_of(format, tested.range.aspect) {
            self.work(match plane {
                Aspect::Stencil => Work {
                    tag: tag | spec::STENCIL_PASSED,
                    depth: Depth { stencil: stencil(CompareFunction::Equal, StencilOperation::Keep, 0), ..Depth::NONE },
                    stencil: STENCIL_STEP,
                    ..plain()
                },
                _ => Work {
                    tag: tag | spec::DEPTH_PASSED,
                    depth: Depth { compare: CompareFunction::GreaterEqual, ..Depth::NONE },
                    z: spec::TESTED_DEPTH,
                    ..plain()
                },
            })?;
        }
        Ok(())
    }

    fn depth(&mut self, row: usize, access: &Access) -> Result<(), RecordError> {
        let format = self.format(access);
        for plane in spec::planes_of(format, access.range.aspect) {
            let index = spec::plane_index(format, plane);
            let tag = spec::tag(row, index, access.range.mip) + u32::from(access.range.layer);
            let (coding, paint) = (Some(coding(format, plane)), spec::paint(access.mode));
            if plane == Aspect::Depth {
                let depth = Depth { write: true, ..Depth::NONE };
                let out = Out::Depth;
                self.work(Work { out, coding, tag, paint, depth, takes_arguments: true, ..Work::NOTHING })?;
                continue;
            }
            for value in 0..4 {
                let stencil = stencil(CompareFunction::Always, StencilOperation::Replace, 0xFF);
                let depth = Depth { stencil, ..Depth::NONE };
                let stencil = value * STENCIL_STEP;
                self.work(Work { out: Out::Stencil, coding, tag, paint, depth, stencil, ..Work::NOTHING })?;
            }
        }
        Ok(())
    }

    fn storage(&mut self, row: usize, access: &Access) -> Result<(), RecordError> {
        let paint = spec::paint(access.mode);
        let Desc::Texture(desc) = self.graph.resources()[access.resource.index()].desc else {
            if let BoundResource::Buffer(buffer) = self.bound(row, ViewPart::WHOLE)? {
                let (out, tag, target) = (Out::Buffer, spec::tag(row, 0, 0), Some(buffer.into()));
                self.work(Work { out, tag, paint, target, takes_arguments: true, ..Work::NOTHING })?;
            }
            return Ok(());
        };
        let coding = Some(self.coding(access, Aspect::All));
        for mip in spec::mips(self.graph, access) {
            let part = ViewPart { mip: Some(mip), ..ViewPart::as_dimension(TextureViewDimension::D2Array) };
            let BoundResource::Texture { view, .. } = self.bound(row, part)? else { continue };
            let tag = spec::tag(row, 0, mip) + u32::from(access.range.layer);
            let (out, target) = (Out::Texture(desc.format), Some(view.into()));
            self.work(Work { out, coding, tag, paint, target, takes_arguments: true, ..Work::NOTHING })?;
        }
        Ok(())
    }

    fn format(&self, access: &Access) -> framegraph::Format {
        let desc = self.graph.resources()[access.resource.index()].desc;
        desc.texture().map_or(framegraph::Format::R8Unorm, |t| t.format)
    }

    fn coding(&self, access: &Access, plane: Aspect) -> Coding {
        coding(self.format(access), plane)
    }

    /// Records one draw or dispatch.
    fn work(&mut self, work: Work) -> Result<(), RecordError> {
        let inputs = self.inputs.iter().map(|i| i.class).collect();
        let stage = match self.cx.targets().layers {
            _ if self.compute => super::shader::Stage::Compute,
            0 | 1 => super::shader::Stage::Raster,
            _ => super::shader::Stage::Layered,
        };
        let signature = Signature { inputs, out: work.out, stage };
        let made = self.stage.shader(&signature);
        let shader = Shader::new(&made.0, &made.1);
        // All fragments of all triangles write to storage; only attachments have a last triangle.
        let stored = matches!(work.out, Out::Texture(_) | Out::Buffer);
        let indirect = self.indirect.clone().filter(|_| work.takes_arguments && (self.compute || !stored));
        let params = self.cx.uniforms(&self.params(&work, &signature, indirect.is_some()));
        let witness = self.stage.witness.clone().into();
        let mut bindings = vec![(0, params), (1, witness)];
        bindings.extend(self.bindings.iter().cloned());
        bindings.extend(work.target.map(|t| (Signature::FIRST + self.inputs.len() as u32, t)));
        if self.compute {
            let pipeline = self.cx.compute_pipeline(&Compute::new(shader))?;
            let group = self.cx.bind_group(pipeline.group(0), &bindings);
            let pass = self.cx.compute_pass()?;
            pass.set_pipeline(&pipeline);
            pass.set_bind_group(0, &group, &[]);
            match &indirect {
                Some(arguments) => pass.dispatch_workgroups_indirect(&arguments.buffer, 0),
                None => pass.dispatch_workgroups(1, 1, 1),
            }
            return Ok(());
        }
        let mut colors = [Output { blend: None, write: ColorWrites::empty() }; 8];
        if let Out::Color(slot, _) = work.out {
            colors[usize::from(slot)] = Output::REPLACE;
        }
        let raster = Raster { colors: &colors, depth: work.depth, ..Raster::new(shader) };
        let pipeline = self.cx.raster_pipeline(&raster)?;
        let group = self.cx.bind_group(pipeline.group(0), &bindings);
        let pass = self.cx.render_pass()?;
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(0, &group, &[]);
        pass.set_stencil_reference(work.stencil);
        match &indirect {
            Some(arguments) => pass.draw_indirect(&arguments.buffer, 0),
            None => pass.draw(0..3, 0..1),
        }
        Ok(())
    }

    /// Returns the words of `Params`.
    fn params(&self, work: &Work, signature: &Signature, indirect: bool) -> Vec<u32> {
        let [width, height] = self.cx.targets().extent;
        let (mask, scale) = work.coding.map_or(([0; 4], [1.0; 4]), |c| (c.mask, c.scale));
        let salt = spec::salt(self.pass, self.stage.frame);
        let wanted = work.stencil / STENCIL_STEP;
        let head = [salt, work.tag, work.paint as u32, self.pass.index() as u32];
        let mut words = head.to_vec();
        words.extend([wanted, indirect.into(), work.z.to_bits(), 0, width, height, 0, 0]);
        words.extend(mask);
        words.extend(scale.map(f32::to_bits));
        assert_eq!(words.len(), PARAMS);
        let codings = self.inputs.iter().filter_map(|i| match i.class {
            Class::Texture(Numeric::Float, _) | Class::Storage(_) => {
                Some(self.coding(&self.accesses()[i.access], Aspect::All)).filter(|c| c.numeric == Numeric::Float)
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

/// Returns a stencil state with one comparison, and one operation if it passes.
fn stencil(compare: CompareFunction, pass_op: StencilOperation, write_mask: u32) -> StencilState {
    let keep = StencilOperation::Keep;
    let face = StencilFaceState { compare, fail_op: keep, depth_fail_op: keep, pass_op };
    StencilState { front: face, back: face, read_mask: 0xFF, write_mask }
}
