//! Image-based light evaluated on the device as in shading passes: specular cube, DFG table, harmonics.

use framegraph_passes::light::ibl::{DfgTable, ImageLight};
use framegraph_shaders::{Features, Module};
use framegraph_wgpu::{Gpu, read_buffer};
use std::error::Error;
use wgpu::util::{BufferInitDescriptor, DeviceExt};
use wgpu::{BindGroupDescriptor, BindGroupEntry, BindingResource, BufferDescriptor, BufferUsages};

const SPECULAR: &str = "
import package::lib::image_light::specular_lod;
@group(0) @binding(0) var<storage, read> asked: array<vec4<f32>>;
@group(0) @binding(1) var<storage, read_write> got: array<vec4<f32>>;
@group(0) @binding(2) var light: texture_cube<f32>;
@group(0) @binding(3) var light_sampler: sampler;
@group(0) @binding(4) var<uniform> last_level: vec4<f32>;
@compute @workgroup_size(64) fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= arrayLength(&asked) { return; }
    let lod = select(specular_lod(asked[id.x].w, last_level.x), asked[id.x].w * last_level.x, last_level.y > 0.5);
    got[id.x] = textureSampleLevel(light, light_sampler, asked[id.x].xyz, lod);
}";

const DFG: &str = "
import package::lib::dfg::dfg_uv;
@group(0) @binding(0) var<storage, read> asked: array<vec4<f32>>;
@group(0) @binding(1) var<storage, read_write> got: array<vec4<f32>>;
@group(0) @binding(2) var table: texture_2d<f32>;
@group(0) @binding(3) var table_sampler: sampler;
@compute @workgroup_size(64) fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= arrayLength(&asked) { return; }
    let at = dfg_uv(asked[id.x].x, asked[id.x].y, f32(textureDimensions(table, 0).x));
    got[id.x] = textureSampleLevel(table, table_sampler, at, 0.0);
}";

const IRRADIANCE: &str = "
import package::lib::sh::irradiance_sh5;
@group(0) @binding(0) var<storage, read> asked: array<vec4<f32>>;
@group(0) @binding(1) var<storage, read_write> got: array<vec4<f32>>;
@group(0) @binding(4) var<uniform> harmonics: array<vec4<f32>, 18>;
@compute @workgroup_size(64) fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= arrayLength(&asked) { return; }
    got[id.x] = vec4<f32>(irradiance_sh5(harmonics, asked[id.x].xyz), 1.0);
}";

/// Mapping from roughness to a mip level.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mapping {
    /// The mapping of the shaders.
    Lod,
    /// A linear mapping: wrong, for negative controls.
    Linear,
}

/// Returns the prefiltered radiance in nits for pairs of direction and roughness.
///
/// # Errors
/// The device fails.
pub fn specular(
    gpu: &Gpu,
    light: &ImageLight,
    mapping: Mapping,
    asked: &[[f32; 4]],
) -> Result<Vec<[f64; 3]>, Box<dyn Error>> {
    let linear = f32::from(u8::from(mapping == Mapping::Linear));
    let last = uniform(gpu, bytemuck::cast_slice(&[light.roughness_one_lod, linear, 0.0, 0.0]));
    let sampler = trilinear(gpu);
    let bindings = [
        (2, BindingResource::TextureView(&light.specular)),
        (3, BindingResource::Sampler(&sampler)),
        (4, last.as_entire_binding()),
    ];
    let got = run(gpu, SPECULAR, asked, &bindings)?;
    let nits = f64::from(light.texel_nits);
    Ok(got.into_iter().map(|[r, g, b, _]| [r, g, b].map(|c| f64::from(c) * nits)).collect())
}

/// Returns the table's values for pairs of n·v and roughness.
///
/// # Errors
/// The device fails.
pub fn dfg(gpu: &Gpu, table: &DfgTable, asked: &[[f64; 2]]) -> Result<Vec<[f64; 3]>, Box<dyn Error>> {
    let sampler = trilinear(gpu);
    let bindings = [(2, BindingResource::TextureView(&table.view)), (3, BindingResource::Sampler(&sampler))];
    let asked: Vec<[f32; 4]> = asked.iter().map(|[a, b]| [*a as f32, *b as f32, 0.0, 0.0]).collect();
    let got = run(gpu, DFG, &asked, &bindings)?;
    Ok(got.into_iter().map(|[r, g, b, _]| [r, g, b].map(f64::from)).collect())
}

/// Returns irradiance / π in nits for surface normals.
///
/// # Errors
/// The device fails.
pub fn irradiance(gpu: &Gpu, light: &ImageLight, normals: &[[f32; 4]]) -> Result<Vec<[f64; 3]>, Box<dyn Error>> {
    let harmonics = uniform(gpu, bytemuck::cast_slice(&light.irradiance));
    let got = run(gpu, IRRADIANCE, normals, &[(4, harmonics.as_entire_binding())])?;
    Ok(got.into_iter().map(|[r, g, b, _]| [r, g, b].map(f64::from)).collect())
}

fn uniform(gpu: &Gpu, contents: &[u8]) -> wgpu::Buffer {
    gpu.device.create_buffer_init(&BufferInitDescriptor { label: None, contents, usage: BufferUsages::UNIFORM })
}

fn trilinear(gpu: &Gpu) -> wgpu::Sampler {
    gpu.device.create_sampler(&wgpu::SamplerDescriptor {
        mag_filter: wgpu::FilterMode::Linear,
        min_filter: wgpu::FilterMode::Linear,
        mipmap_filter: wgpu::MipmapFilterMode::Linear,
        ..Default::default()
    })
}

fn run(
    gpu: &Gpu,
    source: &str,
    asked: &[[f32; 4]],
    bindings: &[(u32, BindingResource<'_>)],
) -> Result<Vec<[f32; 4]>, Box<dyn Error>> {
    let shader = framegraph_shaders::resolve(&Module::new("lookup.wgsl", source), &Features::NONE, &[])?;
    let device = &gpu.device;
    let size = size_of_val(asked) as u64;
    let output = gpu.guard("a lookup", || {
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some("lookup"),
            source: wgpu::ShaderSource::Wgsl(shader.wgsl.into()),
        });
        let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: Some("lookup"),
            layout: None,
            module: &module,
            entry_point: Some("main"),
            compilation_options: Default::default(),
            cache: None,
        });
        let contents = bytemuck::cast_slice(asked);
        let input =
            device.create_buffer_init(&BufferInitDescriptor { label: None, contents, usage: BufferUsages::STORAGE });
        let usage = BufferUsages::STORAGE | BufferUsages::COPY_SRC;
        let output = device.create_buffer(&BufferDescriptor { label: None, size, usage, mapped_at_creation: false });
        let mut entries = vec![
            BindGroupEntry { binding: 0, resource: input.as_entire_binding() },
            BindGroupEntry { binding: 1, resource: output.as_entire_binding() },
        ];
        entries.extend(bindings.iter().map(|(binding, r)| BindGroupEntry { binding: *binding, resource: r.clone() }));
        let layout = &pipeline.get_bind_group_layout(0);
        let group = device.create_bind_group(&BindGroupDescriptor { label: None, layout, entries: &entries });
        let mut encoder = device.create_command_encoder(&Default::default());
        {
            let mut pass = encoder.begin_compute_pass(&Default::default());
            pass.set_pipeline(&pipeline);
            pass.set_bind_group(0, &group, &[]);
            pass.dispatch_workgroups(asked.len().div_ceil(64) as u32, 1, 1);
        }
        gpu.queue.submit([encoder.finish()]);
        output
    })?;
    Ok(bytemuck::cast_slice(&read_buffer(gpu, &output, size)?).to_vec())
}
