//! A small scene that Bevy renders without a window, for the examples and tests.

#![allow(dead_code, reason = "each example and test uses a part")]

pub mod chain;
pub mod letterbox;
pub mod pictures;

use bevy_anti_alias::fxaa::Fxaa;
use bevy_app::{App, PluginsState, TaskPoolPlugin};
use bevy_asset::{Assets, Handle};
use bevy_camera::{Camera, Camera3d, Hdr, RenderTarget};
use bevy_color::{Color, LinearRgba};
use bevy_ecs::prelude::*;
use bevy_image::Image;
use bevy_light::{CascadeShadowConfigBuilder, DirectionalLight, DirectionalLightShadowMap, GlobalAmbientLight};
use bevy_math::{Quat, Vec2, Vec3};
use bevy_mesh::{Mesh, Mesh3d, Meshable};
use bevy_pbr::{MeshMaterial3d, StandardMaterial};
use bevy_post_process::bloom::Bloom;
use bevy_render::render_asset::RenderAssets;
use bevy_render::texture::GpuImage;
use bevy_render::view::{DebandDither, Msaa, Tonemapping};
use bevy_render::{RenderApp, RenderPlugin};
use bevy_shape::{Cuboid, Plane3d, Sphere};
use bevy_transform::components::Transform;
use framegraph_bevy::Device;
use std::path::PathBuf;
use wgpu::{TextureFormat, TextureUsages};

/// Command line of the examples.
#[derive(Debug)]
pub struct Arguments {
    /// Folder of the output.
    pub folder: PathBuf,
    /// Samples per texel.
    pub samples: u32,
    /// Width and height in texels.
    pub size: [u32; 2],
}

impl Arguments {
    /// Parses `[FOLDER] [--samples 1|4] [--size WIDTHxHEIGHT]`; the defaults are `folder`, 4 and 1280×720.
    pub fn parse(folder: &str) -> Result<Self, Box<dyn std::error::Error>> {
        let mut own = Self { folder: folder.into(), samples: 4, size: [1280, 720] };
        let mut arguments = std::env::args().skip(1);
        while let Some(argument) = arguments.next() {
            match argument.as_str() {
                "--samples" => own.samples = arguments.next().ok_or("--samples: 1 or 4 is missing")?.parse()?,
                "--size" => {
                    let text = arguments.next().ok_or("--size: WIDTHxHEIGHT is missing")?;
                    let (width, height) = text.split_once('x').ok_or("--size: write WIDTHxHEIGHT")?;
                    own.size = [width.parse()?, height.parse()?];
                }
                _ => own.folder = argument.into(),
            }
        }
        Ok(own)
    }
}

/// Target size, samples and effects of the camera.
#[derive(Clone, Copy, Debug)]
pub struct Choice {
    /// Width and height of the picture, in texels.
    pub size: [u32; 2],
    /// Samples per texel: 1 or 4.
    pub samples: u32,
    /// Bloom of Bevy.
    pub bloom: bool,
    /// Tone mapping of Bevy.
    pub tonemapping: Tonemapping,
    /// FXAA of Bevy.
    pub fxaa: bool,
}

/// Bevy with the scene, on a device of the caller.
pub struct Scene {
    app: App,
    output: Handle<Image>,
}

impl Scene {
    /// Builds the app. `add` adds plugins after Bevy's.
    pub fn new(device: &Device, choice: &Choice, add: impl FnOnce(&mut App)) -> Self {
        let mut app = App::new();
        app.add_plugins((
            TaskPoolPlugin::default(),
            bevy_diagnostic::FrameCountPlugin,
            bevy_time::TimePlugin,
            bevy_transform::TransformPlugin,
            bevy_window::WindowPlugin { primary_window: None, ..Default::default() },
            bevy_asset::AssetPlugin::default(),
            bevy_mesh::MeshPlugin,
            bevy_image::ImagePlugin::default(),
            bevy_camera::CameraPlugin,
            RenderPlugin {
                render_creation: device.render_creation(),
                synchronous_pipeline_compilation: true,
                ..Default::default()
            },
            bevy_core_pipeline::CorePipelinePlugin,
            bevy_post_process::PostProcessPlugin,
            bevy_anti_alias::AntiAliasPlugin,
            bevy_light::LightPlugin,
            bevy_pbr::PbrPlugin::default(),
        ));
        add(&mut app);
        let output = fill(app.world_mut(), choice);
        while app.plugins_state() == PluginsState::Adding {
            std::thread::yield_now();
        }
        app.finish();
        app.cleanup();
        Self { app, output }
    }

    /// The entity of the camera.
    pub fn camera(&mut self) -> Entity {
        let world = self.app.world_mut();
        world.query_filtered::<Entity, With<Camera>>().single(world).expect("one camera was spawned")
    }

    /// The app's main world.
    pub fn world(&mut self) -> &mut World {
        self.app.world_mut()
    }

    /// The render world.
    pub fn render(&self) -> &World {
        self.app.sub_app(RenderApp).world()
    }

    /// Renders frames and waits for the GPU after each. Returns the time of the last one, in milliseconds.
    pub fn frames(&mut self, device: &Device, count: u32) -> f64 {
        let mut last = 0.0;
        for _ in 0..count {
            let start = std::time::Instant::now();
            self.app.update();
            device.device.poll(wgpu::PollType::wait_indefinitely()).expect("the device waits for its work");
            last = start.elapsed().as_secs_f64() * 1e3;
        }
        last
    }

    /// Reads the picture: sRGB-encoded red, green, blue and alpha.
    pub fn picture(&self, device: &Device) -> Vec<u8> {
        let images = self.render().resource::<RenderAssets<GpuImage>>();
        let image = images.get(&self.output).expect("the output was rendered");
        framegraph_wgpu::read_texture(&device.gpu(), &image.texture).expect("the output can be read").rgba8()
    }
}

fn fill(world: &mut World, choice: &Choice) -> Handle<Image> {
    let [width, height] = choice.size;
    let mut image = Image::new_target_texture(width, height, TextureFormat::Rgba8UnormSrgb, None);
    image.texture_descriptor.usage |= TextureUsages::COPY_SRC;
    image.texture_descriptor.label = Some("picture");
    image.data = None;
    let output = world.resource_mut::<Assets<Image>>().add(image);
    world.insert_resource(DirectionalLightShadowMap { size: 512 });
    world.insert_resource(GlobalAmbientLight { brightness: 400.0, ..Default::default() });
    let mut mesh = |mesh: Mesh| world.resource_mut::<Assets<Mesh>>().add(mesh);
    let plane = mesh(Plane3d::new(Vec3::Y, Vec2::splat(8.0)).into());
    let sphere = mesh(Sphere::new(0.5).mesh().ico(4).expect("a subdivision below 80"));
    let cube = mesh(Cuboid::new(0.8, 0.8, 0.8).into());
    let mut material = |color: Color, emissive: f32| {
        let emissive = LinearRgba::rgb(emissive, emissive * 0.6, emissive * 0.2);
        let material =
            StandardMaterial { base_color: color, emissive, perceptual_roughness: 0.6, ..Default::default() };
        world.resource_mut::<Assets<StandardMaterial>>().add(material)
    };
    let gray = material(Color::srgb(0.6, 0.6, 0.6), 0.0);
    let red = material(Color::srgb(0.8, 0.25, 0.2), 0.0);
    let glow = material(Color::srgb(0.9, 0.8, 0.5), 20.0);
    world.spawn((Mesh3d(plane), MeshMaterial3d(gray)));
    for index in 0..5 {
        let x = 1.2 * (index as f32 - 2.0);
        let (shape, material) = if index % 2 == 0 { (&sphere, &red) } else { (&cube, &glow) };
        let place = Transform::from_xyz(x, 0.5, 0.3 * index as f32).with_rotation(Quat::from_rotation_y(0.5 + x));
        world.spawn((Mesh3d(shape.clone()), MeshMaterial3d(material.clone()), place));
    }
    world.spawn((
        DirectionalLight { illuminance: 6_000.0, shadow_maps_enabled: true, ..Default::default() },
        CascadeShadowConfigBuilder { num_cascades: 2, maximum_distance: 20.0, ..Default::default() }.build(),
        Transform::from_xyz(3.0, 6.0, 2.0).looking_at(Vec3::ZERO, Vec3::Y),
    ));
    let mut camera = world.spawn((
        Camera3d::default(),
        RenderTarget::from(output.clone()),
        Hdr,
        if choice.samples == 4 { Msaa::Sample4 } else { Msaa::Off },
        choice.tonemapping,
        DebandDither::Disabled,
        Transform::from_xyz(0.0, 2.4, 5.5).looking_at(Vec3::new(0.0, 0.4, 0.0), Vec3::Y),
    ));
    if choice.bloom {
        camera.insert(Bloom::NATURAL);
    }
    if choice.fxaa {
        camera.insert(Fxaa::default());
    }
    output
}
