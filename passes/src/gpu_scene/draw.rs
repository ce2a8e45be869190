//! Drawing batches of instances: one pipeline for each kind of surface, and one bind group for each material. Each
//! batch is one draw, or many batches are one indirect call ([`indirect`](crate::gpu_scene::indirect)).
//!
//! The lobes of a material select the shader. A shader binds and computes only the lobes that it has.

use crate::error::PassError;
use crate::gpu_scene::indirect::{ARGUMENTS_BYTES, DrawList, LEAST_RUN, draws_indirectly};
use crate::gpu_scene::streams::{Instances, stream_attributes, vertex_buffers};
use crate::gpu_scene::upload::{GpuScene, InstanceDraw, MATERIAL_BINDINGS, MeshRange, TEXTURE_TRAITS, features_of};
use crate::program::{Interface, Program, ProgramDesc, Programs};
use framegraph_scene::{Batch, Lobes, MaterialId, Topology};
use framegraph_shaders::layout::{
    STREAM_ATTRIBUTES, STREAM_EARLIER, STREAM_INSTANCE, STREAM_POSITION, TRAIT_DOUBLE_SIDED, TRAIT_NO_AREA,
};
use framegraph_shaders::{Feature, Features, Module};
use framegraph_wgpu::{Binding, Constants, Cx, Depth, Output, Raster, RasterPipeline, RecordError};
use std::sync::Arc;
use wgpu::{Buffer, Face, FrontFace, PrimitiveState, PrimitiveTopology};

/// Shader variant that draws a surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SurfaceVariant {
    /// Lobes of the material.
    pub lobes: Lobes,
    /// Traits of the material ([`material_traits`](crate::gpu_scene::upload::material_traits)), and the bit of meshes
    /// without area.
    pub traits: u32,
    /// True if the mesh has vertex colors.
    pub colored: bool,
    /// True if the material is read from an array, if the shader supports that ([`Feature::MATERIAL_TABLE`]).
    pub material_table: bool,
    /// True if the instance stream contains the objects ([`Instances::Stream`]).
    pub instance_stream: bool,
}

impl SurfaceVariant {
    /// Returns the features of vertex input.
    #[must_use]
    pub fn vertex_features(self) -> Features {
        Features::NONE
            .with_if(Feature::INSTANCE_STREAM, self.instance_stream)
            .with_if(Feature::TEXTURED, self.traits & TEXTURE_TRAITS > 0)
            .with_if(Feature::VERTEX_COLORS, self.colored)
    }
}

/// Returns the program of a variant.
pub type ProgramOf<'a> = dyn Fn(SurfaceVariant) -> Result<Arc<Program>, PassError> + 'a;

/// Scene and view that instances are drawn from.
#[derive(Clone, Copy, Debug)]
pub struct InstanceSource<'a> {
    /// Meshes, materials and textures.
    pub scene: &'a GpuScene,
    /// Transforms of instances, and the instance stream.
    pub instances: Instances<'a>,
    /// Arguments of indirect draws.
    pub arguments: &'a Buffer,
    /// True if materials test and write stencil, which the pass then has.
    pub stencil: bool,
}

impl InstanceSource<'_> {
    /// Sets whether the stencil states of materials apply. The depth attachment must have stencil.
    #[must_use]
    pub const fn with_stencil(self, stencil: bool) -> Self {
        Self { stencil, ..self }
    }
}

/// State shared by the draws of a pass over surfaces.
pub struct SurfaceDraw<'a> {
    /// Program of each variant.
    pub program: &'a ProgramOf<'a>,
    /// Bindings of group 0, in the order of the pass's interface.
    pub frame: &'a [Option<Binding>],
    /// Values of the interface's constants after [`Self::TRAITS`] and [`Self::OBJECT_LIGHT`]. Constants that a shader
    /// lacks are omitted. A pass without constants does not shade.
    pub constants: &'a [f64],
    /// Depth test.
    pub depth: Depth,
    /// Blend state of each color slot.
    pub colors: &'a [Output],
}

/// Faces of triangles to draw.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Faces {
    /// Front faces, and also back faces if the material is double-sided.
    OfMaterial,
    /// Back faces only.
    Back,
    /// Front faces only.
    Front,
}

/// State of a depth-only draw.
pub struct DepthDraw<'a> {
    /// Shader with the entry points `vs_opaque`, `vs_mask` and `fs_mask`.
    pub shader: &'static Module<'static>,
    /// Interface of the pass.
    pub interface: &'static Interface,
    /// Bindings of group 0, in the order of the pass's interface.
    pub frame: &'a [Option<Binding>],
    /// Depth test.
    pub depth: Depth,
    /// Opaque and masked instances, nearest first, so that depth rejects hidden ones.
    pub batches: &'a [DrawList; 2],
}

impl DepthDraw<'_> {
    /// Draws the depth of opaque and masked instances.
    ///
    /// # Errors
    /// Fails if the shader is invalid or the device fails.
    pub fn draw(&self, from: InstanceSource<'_>, programs: &Programs, cx: &mut Cx<'_>) -> Result<(), RecordError> {
        let Self { shader, interface, frame, depth, batches } = self;
        let of = |vertex, fragment| ProgramDesc { vertex, fragment, ..ProgramDesc::new(shader, interface) };
        let stereo = cx.targets().layers > 1;
        let programs_of = [of("vs_opaque", None), of("vs_mask", Some("fs_mask"))];
        for (desc, batches) in programs_of.iter().zip(*batches) {
            let program = |variant: SurfaceVariant| {
                let features = &variant.vertex_features().with_if(Feature::STEREO, stereo);
                programs.get(&ProgramDesc { features, ..*desc })
            };
            let surface = SurfaceDraw { program: &program, frame, constants: &[], depth: depth.clone(), colors: &[] };
            surface.draw(batches, from, cx)?;
        }
        Ok(())
    }
}

/// Pipeline state other than the pass.
#[derive(Clone, Copy, PartialEq, Eq)]
struct PipelineKey {
    surface: SurfaceVariant,
    mirrored: bool,
    topology: Topology,
    /// Light channels of the instance ([`InstanceDraw::light_bits`]); 0 if nothing is shaded.
    light_bits: u16,
    /// Material, if its stencil state applies.
    stencil: Option<MaterialId>,
}

impl PipelineKey {
    /// Returns the key of an instance. `indirect` is true for indirect draws, `shades` for passes that shade.
    fn of(instance: &InstanceDraw, (indirect, shades): (bool, bool), from: InstanceSource<'_>) -> Self {
        let InstanceDraw { mesh, material, mirrored, light_bits } = *instance;
        let scene = from.scene;
        let MeshRange { colored, topology, .. } = scene.mesh(mesh, 0);
        let no_area = u32::from(topology != Topology::Triangles) << TRAIT_NO_AREA;
        let surface = SurfaceVariant {
            lobes: scene.lobes(material),
            traits: scene.traits(material) | no_area,
            colored,
            material_table: indirect && scene.is_in_table(material),
            instance_stream: matches!(from.instances, Instances::Stream(_)),
        };
        let stencil = Some(material).filter(|material| from.stencil && scene.stencil(*material).is_some());
        Self { surface, mirrored, topology, light_bits: if shades { light_bits } else { 0 }, stencil }
    }
}

/// Pipeline with the bind groups that all its draws share.
struct SharedState {
    key: PipelineKey,
    program: Arc<Program>,
    pipeline: RasterPipeline,
    frame: wgpu::BindGroup,
    /// Group 2, if objects are read from buffers.
    objects: Option<wgpu::BindGroup>,
    materials: Materials,
    /// Bind groups of materials by [`Materials::group`]; `None` if not requested yet.
    groups: Vec<Option<wgpu::BindGroup>>,
}

/// Method of reading materials in a program.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Materials {
    /// Reads no materials.
    None,
    /// Binds a group for each material.
    Bound,
    /// Reads an array of materials.
    Table,
}

impl Materials {
    fn of(program: &Program) -> Self {
        if program.binds(1, MATERIAL_BINDINGS.len() - 1) {
            return Self::Table;
        }
        if program.has_group(1) { Self::Bound } else { Self::None }
    }

    /// Returns the index of the bind group, which materials may share.
    fn group(self, material: MaterialId) -> usize {
        match self {
            Self::None | Self::Table => 0,
            Self::Bound => material.index(),
        }
    }
}

impl SharedState {
    /// Returns the bind group of a material; `None` if the program reads no materials.
    fn material(
        &mut self,
        group: usize,
        material: MaterialId,
        scene: &GpuScene,
        cx: &mut Cx<'_>,
    ) -> Result<Option<&wgpu::BindGroup>, RecordError> {
        if self.materials == Materials::None {
            return Ok(None);
        }
        if self.groups.len() <= group {
            self.groups.resize(group + 1, None);
        }
        if self.groups[group].is_none() {
            let binding = |slot| scene.material_binding(material, slot);
            self.groups[group] = Some(self.program.bind(cx, &self.pipeline, 1, binding)?);
        }
        Ok(self.groups[group].as_ref())
    }
}

impl SurfaceDraw<'_> {
    /// First constant of passes that draw surfaces: the traits of the material.
    pub const TRAITS: &'static str = "MATERIAL_TRAITS";
    /// Second constant of passes that shade: the light channels of the instance.
    pub const OBJECT_LIGHT: &'static str = "OBJECT_LIGHT";

    /// Draws a list of instances in order. State equal to the previous draw's is not set again. Consecutive batches
    /// that differ only in their arguments are one indirect call.
    ///
    /// # Errors
    /// Fails if the shader is invalid or the device fails.
    pub fn draw(&self, list: &DrawList, from: InstanceSource<'_>, cx: &mut Cx<'_>) -> Result<(), RecordError> {
        self.draw_faces(list, Faces::OfMaterial, from, cx)
    }

    /// Draws some faces of a list, as [`SurfaceDraw::draw`] does.
    ///
    /// # Errors
    /// Fails if the shader is invalid or the device fails.
    pub fn draw_faces(
        &self,
        list: &DrawList,
        faces: Faces,
        from: InstanceSource<'_>,
        cx: &mut Cx<'_>,
    ) -> Result<(), RecordError> {
        let InstanceSource { scene, instances, arguments, .. } = from;
        if list.is_empty() {
            return Ok(());
        }
        let pass = cx.render_pass()?;
        pass.set_vertex_buffer(STREAM_POSITION, scene.positions.slice(..));
        pass.set_vertex_buffer(STREAM_ATTRIBUTES, scene.attributes.slice(..));
        pass.set_vertex_buffer(STREAM_INSTANCE, instances.buffer().slice(..));
        pass.set_vertex_buffer(STREAM_EARLIER, scene.earlier_positions().slice(..));
        let first_arguments = list.first_arguments().filter(|_| draws_indirectly(cx.gpu()));
        let kind = (first_arguments.is_some(), !self.constants.is_empty());
        let mut states: Vec<SharedState> = Vec::new();
        // Index of the current state, and its current bind group of materials.
        let (mut set, mut bound): (Option<usize>, Option<usize>) = (None, None);
        // True if the bound indices have 16 bits.
        let mut indexed: Option<bool> = None;
        let mut at = 0;
        while at < list.len() {
            let instance = &scene.instances[list[at].instance as usize];
            let key = PipelineKey::of(instance, kind, from);
            let state = match set {
                Some(state) if states[state].key == key => state,
                _ => {
                    let state = match states.iter().position(|state| state.key == key) {
                        Some(state) => state,
                        None => {
                            states.push(self.pipeline((key, faces), instance.material, from, cx)?);
                            states.len() - 1
                        }
                    };
                    let SharedState { pipeline, frame, objects, .. } = &states[state];
                    let pass = cx.render_pass()?;
                    pass.set_pipeline(pipeline);
                    pass.set_bind_group(0, frame, &[]);
                    if let Some((_, reference)) = key.stencil.and_then(|material| scene.stencil(material)) {
                        pass.set_stencil_reference(*reference);
                    }
                    if let Some(objects) = objects {
                        pass.set_bind_group(2, objects, &[]);
                    }
                    (set, bound) = (Some(state), None);
                    state
                }
            };
            let materials = states[state].materials;
            let group = materials.group(instance.material);
            if bound != Some(group) {
                bound = Some(group);
                if let Some(material) = states[state].material(group, instance.material, scene, cx)? {
                    cx.render_pass()?.set_bind_group(1, material, &[]);
                }
            }
            let short = scene.mesh(instance.mesh, 0).short;
            let pass = cx.render_pass()?;
            if indexed.replace(short) != Some(short) {
                let (of, format) = match short {
                    true => (scene.indices.slice(scene.short_indices_at..), wgpu::IndexFormat::Uint16),
                    false => (scene.indices.slice(..scene.short_indices_at), wgpu::IndexFormat::Uint32),
                };
                pass.set_index_buffer(of, format);
            }
            let goes_on = |batch: &&Batch| {
                let other = &scene.instances[batch.instance as usize];
                PipelineKey::of(other, kind, from) == key
                    && materials.group(other.material) == group
                    && scene.mesh(other.mesh, 0).short == short
            };
            let run = match first_arguments {
                Some(_) => 1 + list[at + 1..].iter().take_while(goes_on).count(),
                None => 1,
            };
            match first_arguments {
                Some(first) if run >= LEAST_RUN => {
                    let offset = (u64::from(first) + at as u64) * ARGUMENTS_BYTES;
                    pass.multi_draw_indexed_indirect(arguments, offset, run as u32);
                }
                _ => {
                    for batch in &list[at..at + run] {
                        let mesh = scene.mesh(scene.instances[batch.instance as usize].mesh, batch.level);
                        pass.draw_indexed(mesh.indices(), mesh.base_vertex, batch.range());
                    }
                }
            }
            at += run;
        }
        Ok(())
    }

    /// Returns the pipeline of a kind of surface, created for the first `material` that needs it.
    fn pipeline(
        &self,
        (key, faces): (PipelineKey, Faces),
        material: MaterialId,
        from: InstanceSource<'_>,
        cx: &mut Cx<'_>,
    ) -> Result<SharedState, RecordError> {
        let Self { program, frame, constants, colors, .. } = self;
        let stencil = key.stencil.and_then(|material| from.scene.stencil(material));
        let depth =
            stencil.map_or(self.depth.clone(), |(stencil, _)| Depth { stencil: stencil.clone(), ..self.depth.clone() });
        let program = program(key.surface)?;
        fits(&program, key.surface.lobes, from.scene.material_name(material), &cx.gpu().device.limits())?;
        let attributes = stream_attributes(key.surface.instance_stream);
        let buffers = vertex_buffers(&attributes, key.surface.instance_stream);
        let own = [key.surface.traits.into(), key.light_bits.into()];
        let constants: Vec<f64> = own.into_iter().chain(constants.iter().copied()).collect();
        let pipeline = cx.raster_pipeline(&Raster {
            vertex: program.vertex,
            fragment: program.fragment,
            constants: Constants(&program.constants(&constants)),
            buffers: &buffers,
            primitive: PrimitiveState {
                cull_mode: match faces {
                    Faces::OfMaterial if key.surface.traits & 1 << TRAIT_DOUBLE_SIDED != 0 => None,
                    Faces::OfMaterial | Faces::Front => Some(Face::Back),
                    Faces::Back => Some(Face::Front),
                },
                front_face: if key.mirrored { FrontFace::Cw } else { FrontFace::Ccw },
                topology: match key.topology {
                    Topology::Triangles => PrimitiveTopology::TriangleList,
                    Topology::Lines => PrimitiveTopology::LineList,
                    Topology::Points => PrimitiveTopology::PointList,
                },
                ..PrimitiveState::default()
            },
            depth,
            colors,
            ..Raster::new(program.shader())
        })?;
        let frame = program.bind(cx, &pipeline, 0, |slot| frame.get(slot).cloned().flatten())?;
        let objects = match from.instances {
            Instances::Stream(_) => None,
            Instances::Numbers { objects, origins, .. } => {
                let placement = [objects, origins];
                let binding = |slot: usize| Some(placement.get(slot).copied()?.clone().into());
                Some(program.bind(cx, &pipeline, 2, binding)?)
            }
        };
        let materials = Materials::of(&program);
        Ok(SharedState { key, program, pipeline, frame, objects, materials, groups: Vec::new() })
    }
}

/// Fails if a surface needs more textures than the device binds.
pub(crate) fn fits(program: &Program, lobes: Lobes, material: &str, limits: &wgpu::Limits) -> Result<(), PassError> {
    let most = [limits.max_sampled_textures_per_shader_stage, limits.max_samplers_per_shader_stage];
    for ((count, most), what) in program.sampled().into_iter().zip(most).zip(["textures", "samplers"]) {
        if count > most {
            let (material, lobes) = (material.to_owned(), features_of(lobes).iter().map(Feature::name).collect());
            return Err(PassError::TooManyBindings { material, lobes, what, count, most });
        }
    }
    Ok(())
}
