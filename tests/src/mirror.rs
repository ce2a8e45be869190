//! Functions of the shader library on a device, compared with their f64 mirrors: one compute pipeline per function.

use std::error::Error;

use framegraph_shader_mirrors::cases::{Case, Deviation};
use framegraph_wgpu::{Gpu, read_buffer};
use wgpu::util::{BufferInitDescriptor, DeviceExt};
use wgpu::{BindGroupDescriptor, BindGroupEntry, BufferDescriptor, BufferUsages, ComputePipelineDescriptor};

/// Returns the results of `case` on the device for `inputs`, row by row.
///
/// # Errors
/// The shader does not resolve, or the device fails.
pub fn results(gpu: &Gpu, case: &Case, inputs: &[f32]) -> Result<Vec<f32>, Box<dyn Error>> {
    results_of(gpu, case, &case.shader()?.wgsl, inputs)
}

/// Returns the results of another shader text with the interface of [`Case::shader`].
///
/// # Errors
/// The device rejects the text or fails.
pub fn results_of(gpu: &Gpu, case: &Case, wgsl: &str, inputs: &[f32]) -> Result<Vec<f32>, Box<dyn Error>> {
    let rows = inputs.len() / case.input_width();
    let size = (rows * case.results.len() * size_of::<f32>()) as u64;
    let device = &gpu.device;
    let output = gpu.guard(case.function, || {
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some(case.function),
            source: wgpu::ShaderSource::Wgsl(wgsl.into()),
        });
        let pipeline = device.create_compute_pipeline(&ComputePipelineDescriptor {
            label: Some(case.function),
            layout: None,
            module: &module,
            entry_point: Some("evaluate"),
            compilation_options: Default::default(),
            cache: None,
        });
        let numbers = device.create_buffer_init(&BufferInitDescriptor {
            label: Some("numbers"),
            contents: bytemuck::cast_slice(inputs),
            usage: BufferUsages::STORAGE,
        });
        let usage = BufferUsages::STORAGE | BufferUsages::COPY_SRC;
        let output =
            device.create_buffer(&BufferDescriptor { label: Some("results"), size, usage, mapped_at_creation: false });
        let group = device.create_bind_group(&BindGroupDescriptor {
            label: None,
            layout: &pipeline.get_bind_group_layout(0),
            entries: &[bound_entry(&numbers, 0), bound_entry(&output, 1)],
        });
        let mut encoder = device.create_command_encoder(&Default::default());
        {
            let mut pass = encoder.begin_compute_pass(&Default::default());
            pass.set_pipeline(&pipeline);
            pass.set_bind_group(0, &group, &[]);
            pass.dispatch_workgroups(rows.div_ceil(64) as u32, 1, 1);
        }
        gpu.queue.submit([encoder.finish()]);
        output
    })?;
    Ok(bytemuck::cast_slice(&read_buffer(gpu, &output, size)?).to_vec())
}

fn bound_entry(buffer: &wgpu::Buffer, binding: u32) -> BindGroupEntry<'_> {
    BindGroupEntry { binding, resource: buffer.as_entire_binding() }
}

/// Evaluates `case` at `count` points of its domain and compares with the mirror.
///
/// # Errors
/// The first point that exceeds the bound, or an error of [`results`].
pub fn compare(gpu: &Gpu, case: &Case, count: usize) -> Result<Deviation, Box<dyn Error>> {
    let inputs = case.inputs(count);
    let results = results(gpu, case, &inputs)?;
    Ok(case.check(&inputs, &results)?)
}
