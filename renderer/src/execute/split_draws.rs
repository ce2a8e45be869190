//! Draws of one pass that are recorded by several threads, as render bundles that are executed in order.

use crate::device::error::{DeviceError, ErrorScopes, one_line};
use crate::device::format::texture_format;
use crate::execute::cx::Cx;
use crate::execute::error::RecordError;
use crate::execute::targets::Targets;
use crate::workers::{Job, Workers, share_world};
use std::ops::Range;
use std::panic::{AssertUnwindSafe, catch_unwind};
use wgpu::{
    BindGroup, Buffer, BufferSlice, Device, IndexFormat, RenderBundle, RenderBundleDepthStencil,
    RenderBundleDescriptor, RenderBundleEncoder, RenderBundleEncoderDescriptor, RenderPass, RenderPipeline,
};

/// Minimum number of draws that a thread records. Fewer take less time than creating a bundle.
const MIN_DRAWS: u32 = 256;

/// Object of the sentence "wgpu rejected …".
const PART: &str = "a part of a pass";

/// Begin of wgpu's message when it panics.
const PANIC: &str = "Error in RenderBundleEncoder::finish: ";

/// Records some of the draws of a pass ([`Cx::draw_split`]). Has the methods that render passes and bundles share.
#[derive(Debug)]
pub struct SplitDraws<'e, 'd>(Encoder<'e, 'd>);

#[derive(Debug)]
enum Encoder<'e, 'd> {
    Pass(&'e mut RenderPass<'static>),
    Bundle(&'e mut RenderBundleEncoder<'d>),
}

impl<'d> SplitDraws<'_, 'd> {
    /// Sets the pipeline.
    pub fn set_pipeline(&mut self, pipeline: &'d RenderPipeline) {
        match &mut self.0 {
            Encoder::Pass(pass) => pass.set_pipeline(pipeline),
            Encoder::Bundle(bundle) => bundle.set_pipeline(pipeline),
        }
    }

    /// Sets a bind group with its dynamic offsets.
    pub fn set_bind_group(&mut self, index: u32, group: &'d BindGroup, offsets: &[u32]) {
        match &mut self.0 {
            Encoder::Pass(pass) => pass.set_bind_group(index, group, offsets),
            Encoder::Bundle(bundle) => bundle.set_bind_group(index, group, offsets),
        }
    }

    /// Sets a vertex buffer.
    pub fn set_vertex_buffer(&mut self, slot: u32, buffer: BufferSlice<'d>) {
        match &mut self.0 {
            Encoder::Pass(pass) => pass.set_vertex_buffer(slot, buffer),
            Encoder::Bundle(bundle) => bundle.set_vertex_buffer(slot, buffer),
        }
    }

    /// Sets the index buffer.
    pub fn set_index_buffer(&mut self, buffer: BufferSlice<'d>, format: IndexFormat) {
        match &mut self.0 {
            Encoder::Pass(pass) => pass.set_index_buffer(buffer, format),
            Encoder::Bundle(bundle) => bundle.set_index_buffer(buffer, format),
        }
    }

    /// Draws vertices of the vertex buffers.
    pub fn draw(&mut self, vertices: Range<u32>, instances: Range<u32>) {
        match &mut self.0 {
            Encoder::Pass(pass) => pass.draw(vertices, instances),
            Encoder::Bundle(bundle) => bundle.draw(vertices, instances),
        }
    }

    /// Draws vertices that the index buffer names.
    pub fn draw_indexed(&mut self, indices: Range<u32>, base_vertex: i32, instances: Range<u32>) {
        match &mut self.0 {
            Encoder::Pass(pass) => pass.draw_indexed(indices, base_vertex, instances),
            Encoder::Bundle(bundle) => bundle.draw_indexed(indices, base_vertex, instances),
        }
    }

    /// Draws with arguments from a buffer, at an offset in bytes.
    pub fn draw_indirect(&mut self, arguments: &'d Buffer, offset: u64) {
        match &mut self.0 {
            Encoder::Pass(pass) => pass.draw_indirect(arguments, offset),
            Encoder::Bundle(bundle) => bundle.draw_indirect(arguments, offset),
        }
    }

    /// Draws indexed vertices with arguments from a buffer, at an offset in bytes.
    pub fn draw_indexed_indirect(&mut self, arguments: &'d Buffer, offset: u64) {
        match &mut self.0 {
            Encoder::Pass(pass) => pass.draw_indexed_indirect(arguments, offset),
            Encoder::Bundle(bundle) => bundle.draw_indexed_indirect(arguments, offset),
        }
    }
}

impl Cx<'_> {
    /// Records the draws `0..draws` of this pass, on several threads if there are thousands.
    ///
    /// `record` records a range of them, and is called once for each thread of the executor
    /// ([`Executor::record_on`](crate::Executor::record_on)). The ranges are executed in order, as render bundles.
    /// Without worker threads, or with fewer than 512 draws, it is called once and records into the render pass.
    ///
    /// Each call must set pipeline, bind groups and buffers, and they are unset afterwards. Viewport, scissor, blend
    /// constant and stencil reference of the render pass apply to all draws.
    ///
    /// ```
    /// use framegraph_wgpu::{Cx, Raster, RecordError, Shader};
    ///
    /// # const OBJECTS: Shader<'static> = Shader::new("objects", "");
    /// fn draw(objects: &[u32], cx: &mut Cx<'_>) -> Result<(), RecordError> {
    ///     let pipeline = cx.raster_pipeline(&Raster::new(OBJECTS))?;
    ///     cx.draw_split(objects.len() as u32, |draws, range| {
    ///         draws.set_pipeline(&pipeline);
    ///         for object in &objects[range.start as usize..range.end as usize] {
    ///             draws.draw(0..3, *object..*object + 1);
    ///         }
    ///     })
    /// }
    /// ```
    ///
    /// # Errors
    /// Fails if this is no raster pass, or if wgpu rejects a range ([`RecordError::Draws`]).
    pub fn draw_split<'d>(
        &mut self,
        draws: u32,
        record: impl Fn(&mut SplitDraws<'_, 'd>, Range<u32>) + Sync,
    ) -> Result<(), RecordError> {
        let workers = self.frame.workers;
        let pass = self.render_pass()?;
        let parts = |workers: &Workers| (workers.threads() as u32).min(draws / MIN_DRAWS);
        let Some((workers, parts)) = workers.map(|w| (w, parts(w))).filter(|(_, parts)| *parts > 1) else {
            record(&mut SplitDraws(Encoder::Pass(pass)), 0..draws);
            return Ok(());
        };
        let (device, targets) = (&self.frame.gpu.device, self.targets);
        let read_only = self.recording.requests.step().cached.attached.depth.as_ref();
        let read_only = read_only.map(|depth| [depth.depth.is_none(), depth.stencil.is_none()]).unwrap_or_default();
        let begin = |part: u32| (u64::from(draws) * u64::from(part) / u64::from(parts)) as u32;
        let mut bundles: Vec<_> = (0..parts).map(|part| (begin(part)..begin(part + 1), None)).collect();
        let (record, name) = (&record, self.pass_name());
        let mut jobs: Vec<_> = bundles
            .iter_mut()
            .map(|(range, made)| {
                move |(): &()| {
                    *made = Some(bundle(device, targets, read_only, name, |draws| record(draws, range.clone())));
                }
            })
            .collect();
        let mut jobs: Vec<_> = jobs.iter_mut().map(|job| job as Job<'_, ()>).collect();
        share_world(workers, &mut jobs, &());
        let rejected = |range: &Range<u32>, error: DeviceError| match error {
            DeviceError::Refused { message, .. } => RecordError::Draws { first: range.start, end: range.end, message },
            other => other.into(),
        };
        let made = bundles.into_iter().filter_map(|(range, made)| Some(made?.map_err(|error| rejected(&range, error))));
        let made: Vec<_> = made.collect::<Result<_, _>>()?;
        self.render_pass()?.execute_bundles(&made);
        Ok(())
    }
}

/// Records a bundle that fits the targets of the current step.
fn bundle<'d>(
    device: &Device,
    targets: &Targets,
    [depth_read_only, stencil_read_only]: [bool; 2],
    name: &str,
    record: impl FnOnce(&mut SplitDraws<'_, 'd>),
) -> Result<RenderBundle, DeviceError> {
    let scopes = ErrorScopes::open(device);
    let colors = targets.colors.map(|format| format.map(texture_format));
    let count = colors.iter().rposition(Option::is_some).map_or(0, |last| last + 1);
    let depth = targets.depth_format();
    let mut encoder = device.create_render_bundle_encoder(&RenderBundleEncoderDescriptor {
        label: Some(name),
        color_formats: &colors[..count],
        depth_stencil: depth.map(|format| RenderBundleDepthStencil { format, depth_read_only, stencil_read_only }),
        sample_count: targets.samples,
        multiview: targets.multiview_mask(),
    });
    record(&mut SplitDraws(Encoder::Bundle(&mut encoder)));
    // wgpu 30 panics if commands are invalid (`handle_error_fatal` in `RenderBundleEncoder::finish`).
    let finish = || encoder.finish(&RenderBundleDescriptor { label: Some(name) });
    let finished = catch_unwind(AssertUnwindSafe(finish));
    scopes.close(PART)?;
    finished.map_err(|reason| {
        let message = reason.downcast_ref::<String>().map_or("invalid commands", String::as_str);
        DeviceError::Refused { doing: PART, message: one_line(message.trim_start_matches(PANIC)) }
    })
}
