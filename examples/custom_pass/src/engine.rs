//! The existing engine: an instance, a device, a queue, pipelines and buffers. Nothing in this file depends on the render
//! graph.

use super::shapes::{Vertex, cube, octahedron, torus};
use bytemuck::{Pod, Zeroable};
use glam::{Mat4, Quat, Vec3, Vec4};
use std::ops::Range;
use wgpu::util::{BufferInitDescriptor, DeviceExt};
use wgpu::{
    Adapter, BindGroup, BindGroupDescriptor, BindGroupEntry, Buffer, BufferUsages, Device, Extent3d, Instance, Queue,
    RenderPass, RenderPipeline, Surface, Texture, TextureDescriptor, TextureDimension, TextureFormat, TextureUsages,
    VertexBufferLayout, VertexStepMode, vertex_attr_array,
};

/// Format of linear color.
pub const COLOR_FORMAT: TextureFormat = TextureFormat::Rgba16Float;
/// Format of ids: normals mapped to 0…1, and the object number divided by 255.
pub const ID_FORMAT: TextureFormat = TextureFormat::Rgba8Unorm;
/// Format of reversed depth: 1 at the near plane, 0 at infinity.
pub const DEPTH_FORMAT: TextureFormat = TextureFormat::Depth32Float;

/// Error while starting the engine.
#[derive(Clone, PartialEq, Eq, thiserror::Error)]
pub enum EngineError {
    /// No adapter is suitable, or none can present to the window.
    #[error("no adapter is suitable: {0}; install a driver, or change WGPU_BACKEND and WGPU_ADAPTER_NAME")]
    NoAdapter(String),
    /// The adapter provides no device.
    #[error("adapter: cannot open a device: {0}")]
    NoDevice(String),
}

impl std::fmt::Debug for EngineError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        std::fmt::Display::fmt(self, f)
    }
}

/// Small engine that draws a few rotating shapes.
#[derive(Debug)]
pub struct Engine {
    /// Adapter of the device.
    pub adapter: Adapter,
    /// Device.
    pub device: Device,
    /// Queue of the device.
    pub queue: Queue,
    backdrop: RenderPipeline,
    shapes: RenderPipeline,
    view: Buffer,
    view_group: BindGroup,
    vertices: Buffer,
    instances: Buffer,
    /// Vertex range of each object.
    objects: Vec<Range<u32>>,
}

#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct View {
    clip_from_world: Mat4,
    light: Vec4,
}

#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct Instanced {
    world_from_shape: Mat4,
    color: Vec4,
    number: u32,
    pad: [u32; 3],
}

/// Animated object.
struct Object {
    shape: usize,
    /// Linear color, and the emission as a multiple of it.
    color: [f32; 4],
    /// Transform as a function of time in seconds.
    placed: fn(f32) -> Mat4,
}

fn placed(scale: f32, turn: Quat, at: Vec3) -> Mat4 {
    Mat4::from_scale_rotation_translation(Vec3::splat(scale), turn, at)
}

const OBJECTS: [Object; 5] = [
    Object {
        shape: 2,
        color: [0.80, 0.22, 0.06, 0.0],
        placed: |t| placed(1.0, Quat::from_rotation_z(0.4) * Quat::from_rotation_x(0.9 + 0.5 * t), Vec3::ZERO),
    },
    Object {
        shape: 1,
        color: [1.0, 0.75, 0.30, 9.0],
        placed: |t| placed(0.32, Quat::from_rotation_y(1.7 * t), Vec3::ZERO),
    },
    Object {
        shape: 0,
        color: [0.10, 0.30, 0.70, 0.0],
        placed: |t| {
            placed(0.75, Quat::from_rotation_y(0.7 + 0.6 * t) * Quat::from_rotation_x(0.5), Vec3::new(-1.9, 0.1, -0.6))
        },
    },
    Object {
        shape: 1,
        color: [0.15, 0.55, 0.25, 0.0],
        placed: |t| placed(0.85, Quat::from_rotation_y(0.4 - 0.8 * t), Vec3::new(1.9, 0.15 * (1.3 * t).sin(), -0.4)),
    },
    Object {
        shape: 0,
        color: [0.35, 0.35, 0.40, 0.0],
        placed: |t| {
            placed(
                0.45,
                Quat::from_rotation_y(t) * Quat::from_rotation_z(0.6),
                Quat::from_rotation_y(0.9 * t) * Vec3::new(0.0, -0.2, 1.7),
            )
        },
    },
];

impl Engine {
    /// Creates a texture to draw into without a window, and to read back.
    pub fn picture(&self, [width, height]: [u32; 2]) -> Texture {
        self.device.create_texture(&TextureDescriptor {
            label: Some("picture"),
            size: Extent3d { width, height, depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: TextureDimension::D2,
            format: TextureFormat::Rgba8UnormSrgb,
            usage: TextureUsages::RENDER_ATTACHMENT | TextureUsages::COPY_SRC,
            view_formats: &[],
        })
    }

    /// Opens a device, compatible with `surface` if present, and creates all resources for drawing.
    ///
    /// # Errors
    /// [`EngineError`].
    pub fn open(instance: &Instance, surface: Option<&Surface<'_>>) -> Result<Self, EngineError> {
        let adapter = pollster::block_on(choose(instance, surface))?;
        // Neither the engine nor the graph requires more than WebGPU's defaults.
        let (device, queue) = pollster::block_on(adapter.request_device(&wgpu::DeviceDescriptor {
            label: Some("engine"),
            required_limits: wgpu::Limits::default().using_resolution(adapter.limits()),
            ..Default::default()
        }))
        .map_err(|error| EngineError::NoDevice(error.to_string()))?;
        Ok(Self::new(adapter, device, queue))
    }

    fn new(adapter: Adapter, device: Device, queue: Queue) -> Self {
        let shapes = [cube(), octahedron(), torus()];
        let mut first = 0;
        let ranges = shapes.each_ref().map(|shape| {
            let range = first..first + shape.len() as u32;
            first = range.end;
            range
        });
        let buffer = |label, contents: &[u8], usage| {
            device.create_buffer_init(&BufferInitDescriptor { label: Some(label), contents, usage })
        };
        let vertices = buffer("vertices", bytemuck::cast_slice(&shapes.concat()), BufferUsages::VERTEX);
        let blank = [Instanced::zeroed(); OBJECTS.len()];
        let moving = BufferUsages::COPY_DST;
        let instances = buffer("instances", bytemuck::cast_slice(&blank), BufferUsages::VERTEX | moving);
        let view = buffer("view", bytemuck::bytes_of(&View::zeroed()), BufferUsages::UNIFORM | moving);
        let (backdrop, shapes) = pipelines(&device);
        let view_group = device.create_bind_group(&BindGroupDescriptor {
            label: Some("view"),
            layout: &shapes.get_bind_group_layout(0),
            entries: &[BindGroupEntry { binding: 0, resource: view.as_entire_binding() }],
        });
        let objects = OBJECTS.iter().map(|o| ranges[o.shape].clone()).collect();
        Self { adapter, device, queue, backdrop, shapes, view, view_group, vertices, instances, objects }
    }

    /// Updates all transforms to the time `time_s` in seconds, for a picture with aspect ratio `width_over_height`.
    pub fn animate(&self, time_s: f32, width_over_height: f32) {
        use glam::camera::rh::{proj::directx::perspective_infinite_reverse, view::look_at_mat4};
        let eye = look_at_mat4(Vec3::new(0.0, 1.3, 4.6), Vec3::new(0.0, 0.0, 0.0), Vec3::Y);
        let view = View {
            clip_from_world: perspective_infinite_reverse(0.75, width_over_height, 0.1) * eye,
            light: Vec3::new(0.4, 0.8, 0.5).normalize().extend(0.12),
        };
        self.queue.write_buffer(&self.view, 0, bytemuck::bytes_of(&view));
        let instanced = |(object, number): (&Object, u32)| Instanced {
            world_from_shape: (object.placed)(time_s),
            color: object.color.into(),
            number,
            pad: [0; 3],
        };
        let instances: Vec<_> = OBJECTS.iter().zip(1..).map(instanced).collect();
        self.queue.write_buffer(&self.instances, 0, bytemuck::cast_slice(&instances));
    }

    /// Draws into a render pass of the caller. Its targets are [`COLOR_FORMAT`], [`ID_FORMAT`] and [`DEPTH_FORMAT`],
    /// single-sampled.
    pub fn draw(&self, pass: &mut RenderPass<'_>) {
        pass.set_pipeline(&self.backdrop);
        pass.draw(0..3, 0..1);
        pass.set_pipeline(&self.shapes);
        pass.set_bind_group(0, &self.view_group, &[]);
        pass.set_vertex_buffer(0, self.vertices.slice(..));
        pass.set_vertex_buffer(1, self.instances.slice(..));
        for (vertices, instance) in self.objects.iter().zip(0..) {
            pass.draw(vertices.clone(), instance..instance + 1);
        }
    }
}

/// Returns the adapter named by WGPU_ADAPTER_NAME, or the choice of wgpu.
async fn choose(instance: &Instance, surface: Option<&Surface<'_>>) -> Result<Adapter, EngineError> {
    let Ok(name) = std::env::var("WGPU_ADAPTER_NAME") else {
        let options = wgpu::RequestAdapterOptions { compatible_surface: surface, ..Default::default() };
        return instance.request_adapter(&options).await.map_err(|error| EngineError::NoAdapter(error.to_string()));
    };
    let fits = |adapter: &Adapter| {
        let named = adapter.get_info().name.to_lowercase().contains(&name.to_lowercase());
        named && surface.is_none_or(|surface| adapter.is_surface_supported(surface))
    };
    let all = instance.enumerate_adapters(wgpu::Backends::all()).await;
    let missing = || EngineError::NoAdapter(format!("no adapter is named `{name}`"));
    all.into_iter().find(fits).ok_or_else(missing)
}

/// Both pipelines have the same targets, because they draw in one render pass.
fn pipelines(device: &Device) -> (RenderPipeline, RenderPipeline) {
    let module = device.create_shader_module(wgpu::include_wgsl!("engine.wgsl"));
    let vertices = VertexBufferLayout {
        array_stride: size_of::<Vertex>() as u64,
        step_mode: VertexStepMode::Vertex,
        attributes: &vertex_attr_array![0 => Float32x3, 1 => Float32x3],
    };
    let instances = VertexBufferLayout {
        array_stride: size_of::<Instanced>() as u64,
        step_mode: VertexStepMode::Instance,
        attributes: &vertex_attr_array![
            2 => Float32x4, 3 => Float32x4, 4 => Float32x4, 5 => Float32x4, 6 => Float32x4, 7 => Uint32
        ],
    };
    let pipeline = |label, vertex, fragment, buffers: &[Option<VertexBufferLayout<'_>>], nearer: bool| {
        device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some(label),
            layout: None,
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some(vertex),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                buffers,
            },
            primitive: wgpu::PrimitiveState { cull_mode: nearer.then_some(wgpu::Face::Back), ..Default::default() },
            depth_stencil: Some(wgpu::DepthStencilState {
                format: DEPTH_FORMAT,
                depth_write_enabled: Some(nearer),
                depth_compare: Some(if nearer {
                    wgpu::CompareFunction::Greater
                } else {
                    wgpu::CompareFunction::Always
                }),
                stencil: wgpu::StencilState::default(),
                bias: wgpu::DepthBiasState::default(),
            }),
            multisample: wgpu::MultisampleState::default(),
            fragment: Some(wgpu::FragmentState {
                module: &module,
                entry_point: Some(fragment),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                targets: &[Some(COLOR_FORMAT.into()), Some(ID_FORMAT.into())],
            }),
            multiview_mask: None,
            cache: None,
        })
    };
    let shapes = [Some(vertices), Some(instances)];
    (
        pipeline("backdrop", "vs_backdrop", "fs_backdrop", &[], false),
        pipeline("shapes", "vs_shape", "fs_shape", &shapes, true),
    )
}
