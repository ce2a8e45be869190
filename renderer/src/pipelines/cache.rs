//! Pipelines, made once for each combination of shader, state and targets, and never dropped.

use crate::cache::{Cache, CacheCounts};
use crate::device::error::{DeviceError, ErrorScopes};
use crate::execute::targets::Targets;
use crate::hash::Keyed;
use crate::pipelines::key::{Fixed, RasterKey, StagesKey, fixed};
use crate::pipelines::shader::{Shader, ShaderError, ShaderModules};
use crate::pipelines::state::{Compute, Raster};
use std::hash::BuildHasher;
use std::sync::{Arc, OnceLock};
use wgpu::{
    BindGroupLayout, Device, MultisampleState, PipelineCompilationOptions, PipelineLayout, PipelineLayoutDescriptor,
    VertexBufferLayout,
};

/// A pipeline with the layouts of its bind groups; dereferences to the wgpu pipeline. Cloning is cheap.
#[derive(Clone, Debug)]
pub struct Pipeline<P>(Arc<Made<P>>);

#[derive(Debug)]
struct Made<P> {
    pipeline: P,
    groups: [OnceLock<BindGroupLayout>; 4],
    layout_of: fn(&P, u32) -> BindGroupLayout,
}

impl<P> Pipeline<P> {
    fn new(pipeline: P, given: &[BindGroupLayout], layout_of: fn(&P, u32) -> BindGroupLayout) -> Self {
        let groups = [const { OnceLock::new() }; 4];
        for (slot, layout) in groups.iter().zip(given) {
            slot.get_or_init(|| layout.clone());
        }
        Self(Arc::new(Made { pipeline, groups, layout_of }))
    }

    /// The layout of bind group `index`, 0 to 3; the same object each time.
    ///
    /// An index that the pipeline does not have is refused by wgpu and fails the frame.
    pub fn group(&self, index: usize) -> &BindGroupLayout {
        let Made { pipeline, groups, layout_of } = &*self.0;
        groups[index.min(3)].get_or_init(|| layout_of(pipeline, index as u32))
    }
}

impl<P> std::ops::Deref for Pipeline<P> {
    type Target = P;
    fn deref(&self) -> &P {
        &self.0.pipeline
    }
}

/// A raster pipeline.
pub type RasterPipeline = Pipeline<wgpu::RenderPipeline>;
/// A compute pipeline.
pub type ComputePipeline = Pipeline<wgpu::ComputePipeline>;

/// All pipelines and shader modules that were asked for. See the [module](self).
#[derive(Debug, Default)]
pub(crate) struct Pipelines {
    raster: Cache<RasterKey, RasterPipeline>,
    compute: Cache<StagesKey, ComputePipeline>,
    modules: ShaderModules,
}

impl Pipelines {
    /// Hits and creations since the beginning, raster and compute together.
    pub(crate) fn counts(&self) -> CacheCounts {
        let [raster, compute] = [self.raster.counts(), self.compute.counts()];
        CacheCounts { hits: raster.hits + compute.hits, created: raster.created + compute.created }
    }

    /// The shader modules.
    pub(crate) fn modules(&self) -> &ShaderModules {
        &self.modules
    }

    /// Begins a frame.
    pub(crate) fn begin_frame(&mut self) {
        self.raster.begin_frame(u64::MAX);
        self.compute.begin_frame(u64::MAX);
        self.modules.begin_frame();
    }

    /// The raster pipeline for these targets; `own_slots` are the color slots that the pass declares, the others are left
    /// alone.
    ///
    /// # Errors
    /// [`ShaderError`], with the shader's name.
    pub(crate) fn raster(
        &self,
        device: &Device,
        raster: &Raster<'_>,
        targets: &Targets,
        own_slots: u8,
    ) -> Result<RasterPipeline, ShaderError> {
        let fixed = fixed(raster, targets, own_slots);
        let hash = Keyed::default().hash_one((raster, &fixed));
        let make = || {
            let module = self.modules.get(device, &raster.shader)?;
            let draws_beside_colors = raster.fragment.is_none() && fixed.colors.iter().any(Option::is_some);
            let nothing = if draws_beside_colors { Some(self.modules.get(device, &NOTHING)?) } else { None };
            let scopes = ErrorScopes::open(device);
            let pipeline = create_raster(device, raster, &module, nothing.as_ref(), &fixed);
            refused(scopes, raster.shader.name(), [Some(raster.vertex), raster.fragment].into_iter().flatten())?;
            let made = Pipeline::new(pipeline, raster.groups, wgpu::RenderPipeline::get_bind_group_layout);
            Ok((RasterKey::new(raster, fixed.clone()), made))
        };
        self.raster.get(hash, |key| key.is(raster, &fixed), make)
    }

    /// The compute pipeline.
    ///
    /// # Errors
    /// [`ShaderError`], with the shader's name.
    pub(crate) fn compute(&self, device: &Device, compute: &Compute<'_>) -> Result<ComputePipeline, ShaderError> {
        let Compute { shader, entry, constants, groups } = *compute;
        let make = || {
            let module = self.modules.get(device, &shader)?;
            let scopes = ErrorScopes::open(device);
            let layout = layout(device, groups);
            let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
                label: Some(shader.name()),
                layout: layout.as_ref(),
                module: &module,
                entry_point: Some(entry),
                compilation_options: PipelineCompilationOptions { constants: constants.0, ..Default::default() },
                cache: None,
            });
            refused(scopes, shader.name(), [entry].into_iter())?;
            let made = Pipeline::new(pipeline, groups, wgpu::ComputePipeline::get_bind_group_layout);
            Ok((StagesKey::new(&shader, entry, constants, groups), made))
        };
        let is = |key: &StagesKey| key.is(&shader, entry, constants, groups);
        self.compute.get(Keyed::default().hash_one(compute), is, make)
    }
}

fn refused<'e>(scopes: ErrorScopes, name: &str, entries: impl Iterator<Item = &'e str>) -> Result<(), ShaderError> {
    scopes.close("a pipeline").map_err(|error| match error {
        DeviceError::Refused { message, .. } => {
            ShaderError::Pipeline { name: name.to_owned(), entries: entries.map(str::to_owned).collect(), message }
        }
        other => ShaderError::Device(other),
    })
}

/// The explicit pipeline layout, or `None` to leave it to the shader.
fn layout(device: &Device, groups: &[BindGroupLayout]) -> Option<PipelineLayout> {
    let layouts: Vec<_> = groups.iter().map(Some).collect();
    let descriptor = PipelineLayoutDescriptor { label: None, bind_group_layouts: &layouts, ..Default::default() };
    (!groups.is_empty()).then(|| device.create_pipeline_layout(&descriptor))
}

/// Stands in for the fragment stage of a depth-only pass that shares its step with passes that write color: wgpu asks
/// every pipeline of a render pass for the same targets, and without a fragment stage a pipeline has none.
const NOTHING: Shader<'static> = Shader::new("nothing", "@fragment fn fs_nothing() {}");

fn create_raster(
    device: &Device,
    raster: &Raster<'_>,
    module: &wgpu::ShaderModule,
    nothing: Option<&wgpu::ShaderModule>,
    fixed: &Fixed,
) -> wgpu::RenderPipeline {
    let Fixed { colors, depth, samples, multiview_mask, alpha_to_coverage } = fixed;
    let last = colors.iter().rposition(Option::is_some).map_or(0, |slot| slot + 1);
    let compilation_options = PipelineCompilationOptions { constants: raster.constants.0, ..Default::default() };
    let buffers: Vec<_> = raster
        .buffers
        .iter()
        .map(|b| Some(VertexBufferLayout { array_stride: b.stride_bytes, step_mode: b.step, attributes: b.attributes }))
        .collect();
    let layout = layout(device, raster.groups);
    let targets = &colors[..last];
    let own = raster.fragment.map(|entry| wgpu::FragmentState {
        module,
        entry_point: Some(entry),
        compilation_options: compilation_options.clone(),
        targets,
    });
    let fragment = own.or(nothing.map(|module| wgpu::FragmentState {
        module,
        entry_point: Some("fs_nothing"),
        compilation_options: PipelineCompilationOptions::default(),
        targets,
    }));
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some(raster.shader.name()),
        layout: layout.as_ref(),
        vertex: wgpu::VertexState {
            module,
            entry_point: Some(raster.vertex),
            compilation_options: compilation_options.clone(),
            buffers: &buffers,
        },
        primitive: raster.primitive,
        depth_stencil: depth.clone(),
        multisample: MultisampleState { count: *samples, mask: !0, alpha_to_coverage_enabled: *alpha_to_coverage },
        fragment,
        multiview_mask: *multiview_mask,
        cache: None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::device::gpu::Gpu;
    use framegraph::Format;

    const FILL: Shader<'static> = Shader::new(
        "fill",
        "@group(0) @binding(0) var<uniform> color: vec4f;
         @vertex fn vs_main() -> @builtin(position) vec4f { return vec4f(0.0); }
         @fragment fn fs_main() -> @location(0) vec4f { return color; }
         @compute @workgroup_size(1) fn main() {}",
    );

    fn targets(format: Format) -> Targets {
        let mut targets = Targets { samples: 1, ..Targets::default() };
        targets.colors[0] = Some(format);
        targets
    }

    #[test]
    fn one_pipeline_for_one_combination() -> Result<(), Box<dyn std::error::Error>> {
        let gpu = Gpu::noop()?;
        let pipelines = Pipelines::default();
        let get = |format| pipelines.raster(&gpu.device, &Raster::new(FILL), &targets(format), 1);
        let first = get(Format::Rgba8Unorm)?;
        let again = get(Format::Rgba8Unorm)?;
        assert_eq!(*first, *again);
        assert_eq!(first.group(0), again.group(0), "one layout, so that bind groups made with it are found again");
        assert_ne!(*get(Format::Rgba16Float)?, *first);
        let compute = pipelines.compute(&gpu.device, &Compute::new(FILL))?;
        assert_eq!(*compute, *pipelines.compute(&gpu.device, &Compute::new(FILL))?);
        assert_eq!(pipelines.counts(), CacheCounts { hits: 2, created: 3 });
        assert_eq!(pipelines.modules().created(), 1);
        Ok(())
    }

    #[test]
    fn a_refusal_names_shader_and_entry_points() -> Result<(), Box<dyn std::error::Error>> {
        let gpu = Gpu::noop()?;
        let wrong = Raster { fragment: Some("fs_missing"), ..Raster::new(FILL) };
        let refused = Pipelines::default().raster(&gpu.device, &wrong, &targets(Format::Rgba8Unorm), 1);
        let told = refused.map(|_| ()).map_err(|e| e.to_string()).err().unwrap_or_default();
        assert!(told.contains("`fill`") && told.contains("fs_missing"), "{told}");
        Ok(())
    }
}
