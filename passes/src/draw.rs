//! Drawing lists of instances: one pipeline for each kind of surface, one bind group for each material.

use crate::program::Program;
use crate::world::World;
use renderer::scene::DrawLists;
use renderer::wgpu::{Binding, Constants, Cx, Depth, Output, Raster, RasterPipeline, RecordError, VertexBuffer};
use shaders::layout::{STREAM_ATTRIBUTES, STREAM_POSITION, VERTEX_ATTRIBUTES, VertexFormat, stream_stride_bytes};
use wgpu::{Face, FrontFace, PrimitiveState, VertexAttribute, VertexStepMode};

/// How a list of instances is drawn.
pub struct Surface<'a> {
    /// Shader and entry points.
    pub program: &'a Program,
    /// Values of the shader's `override` constants.
    pub constants: &'a [(&'a str, f64)],
    /// Depth test.
    pub depth: Depth,
    /// Blending by color slot.
    pub colors: &'a [Output],
}

/// How depth alone is drawn.
pub struct DepthDraw<'a> {
    /// Opaque and masked surfaces.
    pub programs: &'a [Program; 2],
    /// Depth test.
    pub depth: Depth,
    /// What is drawn; blended surfaces leave no depth.
    pub lists: &'a DrawLists,
}

/// Draws the depth of opaque and masked instances. `frame` offers the bindings of group 0 by name.
///
/// # Errors
/// What the shader or the device refuses.
pub fn draw_depth(
    draw: &DepthDraw<'_>,
    world: &World,
    cx: &mut Cx<'_>,
    frame: impl Fn(&str) -> Option<Binding>,
) -> Result<(), RecordError> {
    let DepthDraw { programs, depth, lists } = draw;
    for (program, list) in programs.iter().zip([&lists.opaque, &lists.mask]) {
        let surface = Surface { program, constants: &[], depth: depth.clone(), colors: &[] };
        draw_instances(&surface, list, world, cx, &frame)?;
    }
    Ok(())
}

/// What a pipeline depends on beside the kind of surface.
#[derive(Clone, Copy, PartialEq, Eq)]
struct Variant {
    double_sided: bool,
    mirrored: bool,
}

/// A pipeline with the groups that all its draws share.
struct Ready {
    variant: Variant,
    pipeline: RasterPipeline,
    frame: wgpu::BindGroup,
    objects: wgpu::BindGroup,
}

/// Draws `list`, instance numbers of the scene, in its order. `frame` offers the bindings of group 0 by name.
///
/// # Errors
/// What the shader or the device refuses.
pub fn draw_instances(
    surface: &Surface<'_>,
    list: &[usize],
    world: &World,
    cx: &mut Cx<'_>,
    frame: &dyn Fn(&str) -> Option<Binding>,
) -> Result<(), RecordError> {
    let mut pipelines: Vec<Ready> = Vec::new();
    for &index in list {
        let instance = &world.instances[index];
        let variant = Variant { double_sided: instance.double_sided, mirrored: instance.mirrored };
        let at = match pipelines.iter().position(|p| p.variant == variant) {
            Some(at) => at,
            None => {
                pipelines.push(ready(surface, variant, world, cx, frame)?);
                pipelines.len() - 1
            }
        };
        let Ready { pipeline, frame, objects, .. } = &pipelines[at];
        let of_material = if surface.program.has_group(1) {
            let known = world.scene.material_bindings(instance.material);
            Some(surface.program.bind_known(cx, pipeline, 1, &known)?)
        } else {
            None
        };
        let mesh = world.scene.mesh(instance.mesh);
        let pass = cx.render_pass()?;
        pass.set_pipeline(pipeline);
        pass.set_bind_group(0, frame, &[]);
        pass.set_bind_group(1, of_material.as_ref(), &[]);
        pass.set_bind_group(2, objects, &[]);
        pass.set_vertex_buffer(STREAM_POSITION, world.scene.positions.slice(..));
        pass.set_vertex_buffer(STREAM_ATTRIBUTES, world.scene.attributes.slice(..));
        pass.set_index_buffer(world.scene.indices.slice(..), wgpu::IndexFormat::Uint32);
        let number = index as u32;
        pass.draw_indexed(mesh.indices(), mesh.base_vertex, number..number + 1);
    }
    Ok(())
}

fn ready(
    surface: &Surface<'_>,
    variant: Variant,
    world: &World,
    cx: &mut Cx<'_>,
    frame: &dyn Fn(&str) -> Option<Binding>,
) -> Result<Ready, RecordError> {
    let Surface { program, constants, depth, colors } = surface;
    let buffers = vertex_buffers();
    let buffers: Vec<VertexBuffer<'_>> = buffers
        .iter()
        .enumerate()
        .map(|(stream, attributes)| VertexBuffer {
            stride_bytes: stream_stride_bytes(stream as u32),
            step: VertexStepMode::Vertex,
            attributes,
        })
        .collect();
    let pipeline = cx.raster_pipeline(&Raster {
        vertex: program.vertex,
        fragment: program.fragment,
        constants: Constants(constants),
        buffers: &buffers,
        primitive: PrimitiveState {
            cull_mode: if variant.double_sided { None } else { Some(Face::Back) },
            front_face: if variant.mirrored { FrontFace::Cw } else { FrontFace::Ccw },
            ..PrimitiveState::default()
        },
        depth: depth.clone(),
        colors,
        ..Raster::new(program.shader())
    })?;
    let group = program.bind(cx, &pipeline, 0, |_, name| Ok(frame(name)))?;
    let objects =
        program.bind(cx, &pipeline, 2, |_, name| Ok((name == "objects").then(|| world.objects.clone().into())))?;
    Ok(Ready { variant, pipeline, frame: group, objects })
}

/// The attributes of the two vertex streams, as wgpu takes them.
fn vertex_buffers() -> [Vec<VertexAttribute>; 2] {
    [STREAM_POSITION, STREAM_ATTRIBUTES].map(|stream| {
        let own = VERTEX_ATTRIBUTES.iter().filter(|a| a.stream == stream);
        own.map(|a| VertexAttribute {
            format: vertex_format(a.format),
            offset: a.offset_bytes,
            shader_location: a.location,
        })
        .collect()
    })
}

const fn vertex_format(format: VertexFormat) -> wgpu::VertexFormat {
    match format {
        VertexFormat::Float32x2 => wgpu::VertexFormat::Float32x2,
        VertexFormat::Float32x3 => wgpu::VertexFormat::Float32x3,
        VertexFormat::Float32x4 => wgpu::VertexFormat::Float32x4,
        VertexFormat::Unorm16x4 => wgpu::VertexFormat::Unorm16x4,
    }
}
