//! Drawing lists of instances: one pipeline for each kind of surface, one bind group for each material.
//!
//! A surface is of the kind of its lobes: each set of lobes has a shader of its own, which binds and computes nothing else.

use crate::program::Program;
use crate::upload::features_of;
use crate::world::{Placed, World};
use framegraph_scene::{DrawLists, Lobes, MaterialId};
use framegraph_shaders::Feature;
use framegraph_shaders::layout::{
    STREAM_ATTRIBUTES, STREAM_POSITION, VERTEX_ATTRIBUTES, VertexFormat, stream_stride_bytes,
};
use framegraph_wgpu::{Binding, Constants, Cx, Depth, Output, Raster, RasterPipeline, RecordError, VertexBuffer};
use std::sync::Arc;
use wgpu::{Face, FrontFace, PrimitiveState, VertexAttribute, VertexStepMode};

/// The program for surfaces with a set of lobes.
pub type ProgramOf<'a> = dyn Fn(Lobes) -> Result<Arc<Program>, RecordError> + 'a;

/// How a list of instances is drawn.
pub struct Surface<'a> {
    /// Shader and entry points, by the lobes of the material.
    pub program: &'a ProgramOf<'a>,
    /// Values of the shaders' `override` constants; those that a shader lacks are left out.
    pub constants: &'a [(&'a str, f64)],
    /// Depth test.
    pub depth: Depth,
    /// Blending by color slot.
    pub colors: &'a [Output],
    /// In which order.
    pub order: DrawOrder,
}

/// In which order a list is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DrawOrder {
    /// As the list has it: what blends must go from back to front.
    Kept,
    /// One pipeline after the other, in the list's order within each: where the order does not show.
    ByPipeline,
}

/// How depth alone is drawn.
pub struct DepthDraw<'a> {
    /// Opaque and masked surfaces.
    pub programs: &'a [Arc<Program>; 2],
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
        let of = |_| Ok(Arc::clone(program));
        // Nearest first, so that depth rejects what is behind.
        let surface =
            Surface { program: &of, constants: &[], depth: depth.clone(), colors: &[], order: DrawOrder::Kept };
        draw_instances(&surface, list, world, cx, &frame)?;
    }
    Ok(())
}

/// What a pipeline depends on beside the kind of surface.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Variant {
    lobes: Lobes,
    double_sided: bool,
    mirrored: bool,
}

impl Variant {
    fn of(instance: &Placed, world: &World) -> Self {
        let Placed { double_sided, mirrored, material, .. } = *instance;
        Self { lobes: world.scene.lobes(material), double_sided, mirrored }
    }
}

/// A pipeline with the groups that all its draws share.
struct Ready {
    variant: Variant,
    program: Arc<Program>,
    pipeline: RasterPipeline,
    frame: wgpu::BindGroup,
    objects: wgpu::BindGroup,
}

/// Draws `list`, instance numbers of the scene. `frame` offers the bindings of group 0 by name.
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
        let variant = Variant::of(instance, world);
        if let Err(at) = pipelines.binary_search_by_key(&variant, |p| p.variant) {
            pipelines.insert(at, ready(surface, variant, instance.material, world, cx, frame)?);
        }
    }
    match surface.order {
        DrawOrder::Kept => {
            for &index in list {
                let variant = Variant::of(&world.instances[index], world);
                if let Ok(at) = pipelines.binary_search_by_key(&variant, |p| p.variant) {
                    draw(&pipelines[at], index, world, cx)?;
                }
            }
        }
        DrawOrder::ByPipeline => {
            for ready in &pipelines {
                for &index in list.iter().filter(|i| Variant::of(&world.instances[**i], world) == ready.variant) {
                    draw(ready, index, world, cx)?;
                }
            }
        }
    }
    Ok(())
}

fn draw(ready: &Ready, index: usize, world: &World, cx: &mut Cx<'_>) -> Result<(), RecordError> {
    let Ready { program, pipeline, frame, objects, .. } = ready;
    let instance = &world.instances[index];
    let of_material = if program.has_group(1) {
        let known = |number| world.scene.material_binding(instance.material, number);
        Some(program.bind_numbered(cx, pipeline, 1, known)?)
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
    Ok(())
}

/// The pipeline of a variant, made for the first `material` that asks for it.
fn ready(
    surface: &Surface<'_>,
    variant: Variant,
    material: MaterialId,
    world: &World,
    cx: &mut Cx<'_>,
    frame: &dyn Fn(&str) -> Option<Binding>,
) -> Result<Ready, RecordError> {
    let Surface { program, constants, depth, colors, .. } = surface;
    let program = program(variant.lobes)?;
    fits(&program, variant.lobes, world.scene.material_name(material), &cx.gpu().device.limits())?;
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
        constants: Constants(&program.constants(constants)),
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
    Ok(Ready { variant, program, pipeline, frame: group, objects })
}

/// Refuses a surface with more textures than the device shades with at once.
fn fits(program: &Program, lobes: Lobes, material: &str, limits: &wgpu::Limits) -> Result<(), RecordError> {
    let most = [limits.max_sampled_textures_per_shader_stage, limits.max_samplers_per_shader_stage];
    for ((count, most), what) in program.sampled().into_iter().zip(most).zip(["textures", "samplers"]) {
        if count > most {
            let lobes: Vec<&str> = features_of(lobes).iter().map(Feature::name).collect();
            return Err(RecordError::custom(format!(
                "material {material:?} combines {}: its shader binds {count} {what}, and the device allows {most}; leave \
                 a lobe out",
                lobes.join(", ")
            )));
        }
    }
    Ok(())
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
        VertexFormat::Float16x4 => wgpu::VertexFormat::Float16x4,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::color::COLOR;
    use framegraph_scene::Lobe;
    use framegraph_shaders::Features;

    /// Every lobe at once binds more textures than WebGPU promises; one lobe does not.
    #[test]
    fn a_material_over_the_devices_limit_is_named() -> Result<(), Box<dyn std::error::Error>> {
        let frame = Features::NONE.with(Feature::SHADOWS).with(Feature::ENVIRONMENT_MAP);
        let outcome = |lobes: Lobes, limits: &wgpu::Limits| {
            let program = Program::new(
                &COLOR,
                &features_of(lobes).iter().fold(frame.clone(), Features::with),
                "vs_main",
                Some("fs_main"),
            )?;
            Ok::<_, framegraph_shaders::ShaderError>(
                fits(&program, lobes, "opal", limits).map_err(|error| error.to_string()),
            )
        };
        let all = Lobe::ALL.into_iter().collect();
        let guaranteed = wgpu::Limits::default();
        let error = outcome(all, &guaranteed)?.err().unwrap_or_default();
        let words =
            "material \"opal\" combines ANISOTROPY, CLEAR_COAT, SHEEN, SPECULAR, TRANSMISSION: its shader binds ";
        assert!(error.contains(words) && error.contains("textures, and the device allows 16"), "{error}");
        assert_eq!(outcome(Lobes::NONE.with(Lobe::ClearCoat), &guaranteed)?, Ok(()));
        let ample = wgpu::Limits { max_sampled_textures_per_shader_stage: 64, ..guaranteed };
        let error = outcome(all, &ample)?.err().unwrap_or_default();
        assert!(error.contains("samplers, and the device allows 16"), "{error}");
        Ok(())
    }
}
