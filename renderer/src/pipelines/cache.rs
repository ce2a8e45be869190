//! Cache of pipelines by shader, state and targets.

use crate::cache::{Cache, CacheCounts, LastEntry};
use crate::device::error::{DeviceError, ErrorScopes};
use crate::execute::targets::Targets;
use crate::hash::KeyHashBuilder;
use crate::pipelines::bind_groups::BindGroupCache;
use crate::pipelines::compared_sources::ComparedSources;
use crate::pipelines::key::{Fixed, RasterKey, StagesKey, fixed};
use crate::pipelines::pipeline::{ComputePipeline, Pipeline, RasterPipeline};
use crate::pipelines::shader::{Compiled, Shader, ShaderError, ShaderModules};
use crate::pipelines::state::{Compute, Raster};
use framegraph::PassId;
use std::hash::BuildHasher;
use wgpu::{
    BindGroupLayout, Device, MultisampleState, PipelineCache, PipelineCompilationOptions, PipelineLayout,
    PipelineLayoutDescriptor, VertexBufferLayout,
};

/// Last raster pipeline of a request.
#[derive(Debug, Default)]
pub(crate) struct LastRaster {
    last: LastEntry<RasterKey, RasterPipeline>,
    /// Pass and compilation of the request. Equal values imply equal targets.
    place: Option<Place>,
}

/// A compilation number and a pass of its plan.
pub(crate) type Place = (u64, PassId);

/// Last compute pipeline of a request.
pub(crate) type LastCompute = LastEntry<StagesKey, ComputePipeline>;

/// Cache of pipelines and shader modules. See the [module documentation](self).
#[derive(Debug, Default)]
pub(crate) struct Pipelines {
    raster: Cache<RasterKey, RasterPipeline>,
    compute: Cache<StagesKey, ComputePipeline>,
    modules: ShaderModules,
    driver_cache: Option<PipelineCache>,
}

impl Pipelines {
    /// Returns hits and creations since the beginning, of raster and compute pipelines together.
    pub(crate) fn counts(&self) -> CacheCounts {
        let [raster, compute] = [self.raster.counts(), self.compute.counts()];
        CacheCounts { hits: raster.hits + compute.hits, created: raster.created + compute.created }
    }

    /// Returns the cache of shader modules.
    pub(crate) fn modules(&self) -> &ShaderModules {
        &self.modules
    }

    /// Begins a frame. Drops pipelines and modules that were not requested for `max_age` frames.
    pub(crate) fn begin_frame(&mut self, max_age: u64) {
        self.raster.begin_frame(max_age);
        self.compute.begin_frame(max_age);
        self.modules.begin_frame(max_age);
    }

    /// Sets the driver's pipeline cache for pipelines created from now on.
    pub(crate) fn set_driver_cache(&mut self, cache: Option<PipelineCache>) {
        self.driver_cache = cache;
    }

    /// Returns the driver's pipeline cache, if any.
    pub(crate) fn driver_cache(&self) -> Option<&PipelineCache> {
        self.driver_cache.as_ref()
    }

    /// Returns the raster pipeline for the targets of a `place`. `own_slots` is a mask of the color slots that the pass
    /// declares; other slots are not written. `last` is the last result of this request.
    ///
    /// # Errors
    /// Fails with [`ShaderError`], which has the shader's name.
    pub(crate) fn raster(
        &self,
        last: &mut LastRaster,
        device: &Device,
        raster: &Raster<'_>,
        (place, targets): (Place, &Targets),
        own_slots: impl FnOnce() -> u8,
    ) -> Result<RasterPipeline, ShaderError> {
        if last.place == Some(place)
            && let Some(pipeline) = self.raster.last(&last.last, |key| key.describes(raster))
        {
            return Ok(pipeline);
        }
        // Invalid until the lookup succeeds.
        last.place = None;
        let own_slots = own_slots();
        let Targets { colors, depth, samples, layers, .. } = targets;
        let hash = || KeyHashBuilder::default().hash_one((raster, colors, depth, samples, layers, own_slots));
        let make = || {
            let fixed = fixed(raster, targets, own_slots);
            let made = self.make_raster(device, raster, &self.modules.get(device, &raster.shader)?, &fixed)?;
            Ok((RasterKey::new(raster, targets, own_slots), made))
        };
        let is = |key: &RasterKey| key.fits(targets, own_slots) && key.describes(raster);
        let pipeline = self.raster.get_repeated(&mut last.last, hash, is, make)?;
        last.place = Some(place);
        Ok(pipeline)
    }

    /// Returns the compute pipeline. `last` is the last result of this request.
    ///
    /// # Errors
    /// Fails with [`ShaderError`], which has the shader's name.
    pub(crate) fn compute(
        &self,
        last: &mut LastCompute,
        device: &Device,
        compute: &Compute<'_>,
    ) -> Result<ComputePipeline, ShaderError> {
        let Compute { shader, entry, constants, groups } = *compute;
        let make = || {
            let made = self.make_compute(device, compute, &self.modules.get(device, &shader)?)?;
            Ok((StagesKey::new(&shader, entry, constants, groups), made))
        };
        let is = |key: &StagesKey| key.is(&shader, entry, constants, groups);
        self.compute.get_repeated(last, || KeyHashBuilder::default().hash_one(compute), is, make)
    }

    /// Replaces the source of `shader` and recreates its pipelines. Returns their number. Nothing changes if one of
    /// them fails, or if the source expects other bindings, entry points or vertex inputs.
    ///
    /// # Errors
    /// Fails with [`ShaderError`] if the source does not compile or does not match the old source or a pipeline.
    pub(crate) fn reload(
        &mut self,
        device: &Device,
        shader: &Shader<'_>,
        text: &str,
        groups: &BindGroupCache,
    ) -> Result<usize, ShaderError> {
        let module = ShaderModules::compile(device, shader.name(), text)?;
        // Recorders are written for the original source, even if it was reloaded before.
        let compared = ComparedSources::new(shader, text)?;
        let (mut raster, mut compute) = (std::mem::take(&mut self.raster), std::mem::take(&mut self.compute));
        let rasters = raster.rebuild(
            |key| key.stages.shader == shader.hash(),
            |key, old| {
                key.with(*shader, |raster, fixed| {
                    let entries: Vec<_> = [Some(raster.vertex), raster.fragment].into_iter().flatten().collect();
                    compared.check(&entries, raster.constants.0, raster.groups.is_empty())?;
                    let made = self.make_raster(device, raster, &module, fixed);
                    let new = made.map_err(|error| compared.explain(raster.vertex, raster.fragment, error))?;
                    compared.check_bound(device, groups, old, &new)?;
                    Ok(new)
                })
            },
        );
        let computes = compute.rebuild(
            |key| key.shader == shader.hash(),
            |key, old| {
                key.with(*shader, |compute| {
                    compared.check(&[compute.entry], compute.constants.0, compute.groups.is_empty())?;
                    let new = self.make_compute(device, compute, &module)?;
                    compared.check_bound(device, groups, old, &new)?;
                    Ok(new)
                })
            },
        );
        (self.raster, self.compute) = (raster, compute);
        let (rasters, computes) = (rasters?, computes?);
        compared.check_others()?;
        let rebuilt = rasters.len() + computes.len();
        self.raster.replace(rasters);
        self.compute.replace(computes);
        self.modules.replace(shader.hash(), module);
        Ok(rebuilt)
    }

    fn make_raster(
        &self,
        device: &Device,
        raster: &Raster<'_>,
        compiled: &Compiled,
        fixed: &Fixed,
    ) -> Result<RasterPipeline, ShaderError> {
        let draws_beside_colors = raster.fragment.is_none() && fixed.colors.iter().any(Option::is_some);
        let nothing = if draws_beside_colors { Some(self.modules.get(device, &NOTHING)?) } else { None };
        let scopes = ErrorScopes::open(device);
        let modules = (&compiled.module, nothing.as_ref().map(|n| &n.module));
        let pipeline = create_raster(device, raster, modules, fixed, self.driver_cache());
        refused(scopes, raster.shader.name(), [Some(raster.vertex), raster.fragment].into_iter().flatten())?;
        let (source, layout_of) = (compiled.source.clone(), wgpu::RenderPipeline::get_bind_group_layout);
        Ok(Pipeline::new(pipeline, source, raster.groups, layout_of))
    }

    fn make_compute(
        &self,
        device: &Device,
        compute: &Compute<'_>,
        compiled: &Compiled,
    ) -> Result<ComputePipeline, ShaderError> {
        let Compute { shader, entry, constants, groups } = *compute;
        let scopes = ErrorScopes::open(device);
        let layout = layout(device, shader.name(), groups);
        let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: Some(shader.name()),
            layout: layout.as_ref(),
            module: &compiled.module,
            entry_point: Some(entry),
            compilation_options: PipelineCompilationOptions { constants: constants.0, ..Default::default() },
            cache: self.driver_cache(),
        });
        refused(scopes, shader.name(), [entry].into_iter())?;
        let (source, layout_of) = (compiled.source.clone(), wgpu::ComputePipeline::get_bind_group_layout);
        Ok(Pipeline::new(pipeline, source, groups, layout_of))
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

/// Returns the explicit pipeline layout, or `None` to derive it from the shader.
fn layout(device: &Device, label: &str, groups: &[BindGroupLayout]) -> Option<PipelineLayout> {
    let layouts: Vec<_> = groups.iter().map(Some).collect();
    let descriptor =
        PipelineLayoutDescriptor { label: Some(label), bind_group_layouts: &layouts, ..Default::default() };
    (!groups.is_empty()).then(|| device.create_pipeline_layout(&descriptor))
}

/// Empty fragment stage for depth-only passes in a step with color targets. All pipelines of a render pass must have
/// the same color targets, which requires a fragment stage.
const NOTHING: Shader<'static> = Shader::new("nothing", "@fragment fn fs_nothing() {}");

fn create_raster(
    device: &Device,
    raster: &Raster<'_>,
    (module, nothing): (&wgpu::ShaderModule, Option<&wgpu::ShaderModule>),
    fixed: &Fixed,
    cache: Option<&PipelineCache>,
) -> wgpu::RenderPipeline {
    let Fixed { colors, depth, samples, multiview_mask, alpha_to_coverage } = fixed;
    let last = colors.iter().rposition(Option::is_some).map_or(0, |slot| slot + 1);
    let compilation_options = PipelineCompilationOptions { constants: raster.constants.0, ..Default::default() };
    let buffers: Vec<_> = raster
        .buffers
        .iter()
        .map(|b| Some(VertexBufferLayout { array_stride: b.stride_bytes, step_mode: b.step, attributes: b.attributes }))
        .collect();
    let layout = layout(device, raster.shader.name(), raster.groups);
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
        cache,
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
        let get = |format| {
            pipelines.raster(
                &mut LastRaster::default(),
                &gpu.device,
                &Raster::new(FILL),
                ((1, PassId::at(0)), &targets(format)),
                || 1,
            )
        };
        let first = get(Format::Rgba8Unorm)?;
        let again = get(Format::Rgba8Unorm)?;
        assert_eq!(*first, *again);
        let layout = |pipeline: &RasterPipeline| pipeline.group(0).layout().ok().cloned();
        assert_eq!(layout(&first), layout(&again), "one layout, so that cached bind groups are found");
        assert_ne!(*get(Format::Rgba16Float)?, *first);
        let compute = || pipelines.compute(&mut LastCompute::default(), &gpu.device, &Compute::new(FILL));
        assert_eq!(*compute()?, *compute()?);
        assert_eq!(pipelines.counts(), CacheCounts { hits: 2, created: 3 });
        assert_eq!(pipelines.modules().created(), 1);
        Ok(())
    }

    #[test]
    fn a_rejected_pipeline_names_shader_and_entry_points() -> Result<(), Box<dyn std::error::Error>> {
        let gpu = Gpu::noop()?;
        let wrong = Raster { fragment: Some("fs_missing"), ..Raster::new(FILL) };
        let (pipelines, targets) = (Pipelines::default(), targets(Format::Rgba8Unorm));
        let refused =
            pipelines.raster(&mut LastRaster::default(), &gpu.device, &wrong, ((1, PassId::at(0)), &targets), || 1);
        let report = refused.map(|_| ()).map_err(|e| e.to_string()).err().unwrap_or_default();
        assert!(report.contains("`fill`") && report.contains("fs_missing"), "{report}");
        Ok(())
    }
}
