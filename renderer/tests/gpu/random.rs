//! Random graphs on the noop device, which validates all calls. Each pass binds everything that it declares, so that
//! wgpu detects every conflict in a plan.

use crate::bench::TestResult;
use framegraph::{
    Access, AccessKind, Aspect, Attachment, Desc, Dimension, Format, Numeric, PassKind, Plan, Scratch, StoreOp,
};
use framegraph_check::generate::{self, Entropy, Profile};
use framegraph_wgpu::{
    Binding, BoundResource, Compute, Cx, Executor, Gpu, Output, Raster, RecordError, Shader, ViewPart, texture_format,
};
use framegraph_wgpu::{Frame, mock};
use std::collections::BTreeMap;
use wgpu::{
    BindGroupLayout, BindGroupLayoutEntry, BindingType, BufferBindingType, ColorWrites, ShaderStages, TextureSampleType,
};

const NOTHING: Shader<'static> = Shader::new(
    "nothing",
    "@vertex fn vs_main() -> @builtin(position) vec4f { return vec4f(); }
     @fragment fn fs_main() {}
     @compute @workgroup_size(1) fn main() {}",
);

/// Returns the sample type of a format in shaders.
fn sample_type(format: Format, aspect: Aspect) -> TextureSampleType {
    match format.numeric() {
        Numeric::Depth if aspect == Aspect::Stencil || !format.has_depth() => TextureSampleType::Uint,
        Numeric::Depth => TextureSampleType::Depth,
        Numeric::Float => TextureSampleType::Float { filterable: false },
        Numeric::Sint => TextureSampleType::Sint,
        Numeric::Uint => TextureSampleType::Uint,
    }
}

/// Returns the binding type of an access; `None` if it is not bound in a group.
fn binding_type(plan: &Plan, access: &Access) -> Option<BindingType> {
    let buffer = |ty| BindingType::Buffer { ty, has_dynamic_offset: false, min_binding_size: None };
    let Desc::Texture(desc) = plan.graph().resources()[access.resource.index()].desc else {
        return match access.kind {
            AccessKind::Uniform => Some(buffer(BufferBindingType::Uniform)),
            AccessKind::StorageRead => Some(buffer(BufferBindingType::Storage { read_only: true })),
            AccessKind::StorageWrite => Some(buffer(BufferBindingType::Storage { read_only: false })),
            _ => None,
        };
    };
    let view_dimension = match desc.dimension {
        Dimension::D3 => wgpu::TextureViewDimension::D3,
        Dimension::D2 if access.range.layer_range(desc.layers.into()).len() > 1 => wgpu::TextureViewDimension::D2Array,
        Dimension::D2 => wgpu::TextureViewDimension::D2,
    };
    let storage = |access| BindingType::StorageTexture { access, format: texture_format(desc.format), view_dimension };
    match access.kind {
        AccessKind::Sampled | AccessKind::SamePixel => Some(BindingType::Texture {
            sample_type: sample_type(desc.format, access.range.aspect),
            view_dimension,
            multisampled: desc.samples > 1,
        }),
        AccessKind::StorageRead => Some(storage(wgpu::StorageTextureAccess::ReadOnly)),
        AccessKind::StorageWrite => Some(storage(wgpu::StorageTextureAccess::WriteOnly)),
        _ => None,
    }
}

/// Returns the limit that a binding counts to: sampled textures, storage textures, storage buffers, uniform buffers.
const fn class(ty: BindingType) -> usize {
    match ty {
        BindingType::StorageTexture { .. } => 1,
        BindingType::Buffer { ty: BufferBindingType::Storage { .. }, .. } => 2,
        BindingType::Buffer { .. } => 3,
        _ => 0,
    }
}

/// Binds everything that the pass declares, and draws or dispatches.
pub(crate) fn record(cx: &mut Cx<'_>, kind: PassKind) -> Result<(), RecordError> {
    let plan = cx.plan();
    let stage = if kind == PassKind::Compute { ShaderStages::COMPUTE } else { ShaderStages::FRAGMENT };
    // A fragment shader binds what it writes, and as much as its limits allow. A vertex shader reads the rest.
    let limits = cx.gpu().caps();
    let left = |class| match class {
        0 => limits.max_sampled_textures,
        1 => limits.max_storage_textures,
        2 => limits.max_storage_buffers,
        _ => limits.max_uniform_buffers,
    };
    let mut left = [0, 1, 2, 3].map(left);
    let writes = |id: framegraph::AccessId| {
        let access = &plan.graph().accesses()[id.index()];
        binding_type(plan, access).filter(|_| access.kind == AccessKind::StorageWrite)
    };
    cx.accesses().filter_map(writes).for_each(|ty| left[class(ty)] = left[class(ty)].saturating_sub(1));
    let (mut entries, mut bindings, mut vertices, mut indices) = (Vec::new(), Vec::new(), None, None);
    for id in cx.accesses() {
        let access = &plan.graph().accesses()[id.index()];
        if access.kind.is_attachment() {
            continue;
        }
        let storage = matches!(access.kind, AccessKind::StorageRead | AccessKind::StorageWrite);
        let texture = plan.graph().resources()[access.resource.index()].desc.texture().is_some();
        // Storage views have one level.
        let part = ViewPart { mip: (storage && texture).then_some(access.range.mip), ..ViewPart::WHOLE };
        let bound = cx.resource_part(id, part)?;
        let number = entries.len() as u32;
        if let Some(ty) = binding_type(plan, access) {
            let left = &mut left[class(ty)];
            let in_vertex = kind == PassKind::Raster && access.kind != AccessKind::StorageWrite && *left == 0;
            if access.kind != AccessKind::StorageWrite {
                *left = left.saturating_sub(1);
            }
            let visibility = if in_vertex { ShaderStages::VERTEX } else { stage };
            entries.push(BindGroupLayoutEntry { binding: number, visibility, ty, count: None });
            bindings.push((
                number,
                match &bound {
                    BoundResource::Texture { view, .. } => Binding::from(view.clone()),
                    BoundResource::Buffer(buffer) => buffer.clone().into(),
                },
            ));
        }
        match (access.kind, bound) {
            (AccessKind::Vertex, BoundResource::Buffer(buffer)) => vertices = Some(buffer),
            (AccessKind::Index, BoundResource::Buffer(buffer)) => indices = Some(buffer),
            _ => {}
        }
    }
    let layout =
        cx.gpu().device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: None, entries: &entries });
    let groups: [BindGroupLayout; 1] = [layout];
    let group = cx.bind_group(&groups[0], &bindings);
    match kind {
        PassKind::Copy => {
            cx.encoder()?;
        }
        PassKind::Compute => {
            let pipeline = cx.compute_pipeline(&Compute { groups: &groups, ..Compute::new(NOTHING) })?;
            let pass = cx.compute_pass()?;
            pass.set_pipeline(&pipeline);
            pass.set_bind_group(0, &group, &[]);
            pass.dispatch_workgroups(1, 1, 1);
        }
        PassKind::Raster => {
            let colors = [Output { blend: None, write: ColorWrites::empty() }; 8];
            let pipeline = cx.raster_pipeline(&Raster { groups: &groups, colors: &colors, ..Raster::new(NOTHING) })?;
            let pass = cx.render_pass()?;
            pass.set_pipeline(&pipeline);
            pass.set_bind_group(0, &group, &[]);
            if let Some(buffer) = &vertices {
                pass.set_vertex_buffer(0, buffer.slice());
            }
            if let Some(buffer) = &indices {
                pass.set_index_buffer(buffer.slice(), wgpu::IndexFormat::Uint32);
            }
            pass.draw(0..3, 0..1);
        }
    }
    Ok(())
}

#[test]
fn wgpu_accepts_every_plan() -> TestResult {
    let wanted = std::env::var("FRAMEGRAPH_RANDOM_GRAPHS").ok().and_then(|n| n.parse().ok());
    let count: u64 = wanted.unwrap_or(400);
    let gpu = Gpu::noop()?;
    let mut executor = Executor::new(&gpu);
    let (mut scratch, mut plan) = (Scratch::new(), Plan::new());
    let (mut executed, mut compared, mut beyond, mut refused) =
        (0u64, 0u64, BTreeMap::<&str, u64>::new(), Vec::<String>::new());
    for seed in 0..count {
        let graph = generate::graph(&mut Entropy::seeded(seed), &Profile::default());
        let mut options = generate::options_of(seed as u32);
        options.frame = generate::FRAME;
        // The device has fewer formats and sample counts than the generator uses.
        if framegraph::compile(&graph, &gpu.caps(), &options, &mut scratch, &mut plan).is_err() {
            *beyond.entry("compiler").or_default() += 1;
            continue;
        }
        let mut frame = Frame::<()>::from_graph(graph);
        for pass in plan.graph().pass_ids() {
            let kind = plan.graph().passes()[pass.index()].kind;
            frame.set_recorder(pass, move |_, (), cx| {
                drop(cx.inlined());
                record(cx, kind)
            });
        }
        let Ok(imported) = mock::imports(&gpu, &plan) else {
            *beyond.entry("import").or_default() += 1;
            continue;
        };
        match executor.execute(&plan, &frame, &(), &imported.bound) {
            Ok(_) => {
                executed += 1;
                // Separate operations per plane, and unused resolve targets, have no exact equivalent in wgpu.
                let exact = |a: &Attachment| {
                    let dropped = a.role.is_resolve() && a.store == StoreOp::Discard;
                    a.store == a.stencil_store && !dropped
                };
                if plan.attachments().iter().all(exact) {
                    compared += 1;
                    assert_eq!(executor.executed(), plan.counts(), "seed {seed}");
                }
            }
            Err(error) => refused.push(format!("seed {seed}: {error}\n{}", framegraph::dump::text(&plan))),
        }
    }
    println!(
        "{executed} graphs executed, {compared} of them compared, more than the device has is asked by {beyond:?}"
    );
    assert!(refused.is_empty(), "{} frames were refused; the first: {}", refused.len(), refused[0]);
    assert!(compared * 2 > count, "most graphs must be executed and compared, or the test shows nothing");
    Ok(())
}
