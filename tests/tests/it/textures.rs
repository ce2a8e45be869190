//! Compressed textures on the device: every format is sampled like the RGBA version of the same file, and drawn like
//! the source picture.

use crate::stage::{Set, Shot, gpu};
use framegraph::Options;
use framegraph_passes::Settings;
use framegraph_passes::gpu_scene::upload::{GpuScene, MATERIAL_BINDINGS, block_formats};
use framegraph_passes::gpu_scene::view::Background;
use framegraph_scene::{BlockFormats, ImageFormat, LoadOptions, MaterialId, Scene, import, progress};
use framegraph_wgpu::{Binding, Gpu, read_buffer};
use glam::Vec3;
use serde_json::{Value, json};
use std::error::Error;
use std::path::{Path, PathBuf};
use wgpu::util::DeviceExt;

/// Width of a square in the picture, in pixels. It is the textures' width, so that a texel is one pixel.
const SIDE: usize = 64;

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("textures")
}

/// Loads `squares.gltf` with a change.
fn squares(formats: BlockFormats, change: impl FnOnce(&mut Value)) -> Result<Scene, Box<dyn Error>> {
    let mut document: Value = serde_json::from_slice(&std::fs::read(folder().join("squares.gltf"))?)?;
    change(&mut document);
    let options = LoadOptions { block_formats: formats, ..LoadOptions::default() };
    let path = folder().join("squares.gltf");
    let scene = import::load_bytes_with(&path, document.to_string().as_bytes(), &options, &mut progress::silent)?;
    scene.check()?;
    Ok(scene)
}

const NONE: BlockFormats = BlockFormats { bc7: false, etc2: false, astc: false };

/// Returns the block formats that the device samples, one by one; reports a skip for the others.
fn each_format(test: &str, gpu: &Gpu) -> Vec<(ImageFormat, BlockFormats)> {
    let device = block_formats(gpu);
    let of = [
        (ImageFormat::Bc7, device.bc7, BlockFormats { bc7: true, ..NONE }),
        (ImageFormat::Etc2Rgba8, device.etc2, BlockFormats { etc2: true, ..NONE }),
        (ImageFormat::Astc4x4, device.astc, BlockFormats { astc: true, ..NONE }),
    ];
    let sampled = of.into_iter().filter(|(format, is_sampled, _)| {
        if !is_sampled {
            test_report::skip(test, &format!("this device does not sample {format:?}"));
        }
        *is_sampled
    });
    sampled.map(|(format, _, formats)| (format, formats)).collect()
}

/// Returns the peak signal-to-noise ratio of 8-bit channels in dB; 100 for equal ones.
fn psnr_db(a: &[u8], b: &[u8]) -> f64 {
    assert!(a.len() == b.len() && !a.is_empty());
    let square: f64 = a.iter().zip(b).map(|(a, b)| f64::from(a.abs_diff(*b)).powi(2)).sum();
    (10.0 * (255.0 * 255.0 * a.len() as f64 / square).log10()).min(100.0)
}

/// Returns the pixels of one of three squares in a row.
fn square(picture: &[u8], place: usize) -> Vec<u8> {
    let (left, top) = (place % 3 * SIDE, place / 3 * SIDE);
    let row = |y: usize| &picture[4 * (3 * SIDE * (top + y) + left)..][..4 * SIDE];
    (0..SIDE).flat_map(row).copied().collect()
}

/// Draws one picture from PNG, ETC1S, UASTC, WebP and uncompressed KTX2 files side by side, 64 × 64 pixels each, in
/// every format of the device. Each has a PSNR of at least 40 dB to the PNG. Equal texels differ by dithering, and by
/// anti-aliasing at the edges of squares: 52 dB. Negative controls: another picture, and the same one shifted by a
/// pixel.
#[test]
fn compressed_textures_draw_their_source_picture() -> Result<(), Box<dyn Error>> {
    let test = "compressed_textures_draw_their_source_picture";
    let Some(gpu) = gpu(test) else { return Ok(()) };
    let size_px = [3 * SIDE as u32, 2 * SIDE as u32];
    let settings = Settings { samples: 1, ..Settings::DEFAULT };
    let shot =
        Shot { size_px, options: Options::for_frame(size_px[0], size_px[1]), ev100: 10.0, ..Shot::small(settings) };
    let all = [(ImageFormat::Rgba8, NONE)].into_iter().chain(each_format(test, &gpu));
    for (format, formats) in all {
        let scene = squares(formats, |_| {})?;
        assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);
        assert_eq!([1, 2].map(|image| scene.images[image].format), [format; 2]);
        let (picture, _) = Set::of(&gpu, scene, &shot, &Background::Constant(Vec3::ZERO))?.shoot(&gpu, &shot)?;
        let source = square(&picture, 0);
        for (place, name, least_db) in [(1, "ETC1S", 40.0), (2, "UASTC", 40.0), (3, "WebP", 40.0), (4, "KTX2", 50.0)] {
            let found = psnr_db(&square(&picture, place), &source);
            assert!(found >= least_db, "{name} as {format:?}: {found:.1} dB");
        }
        let other = psnr_db(&square(&picture, 5), &source);
        let shifted = psnr_db(&source[4..], &source[..source.len() - 4]);
        assert!(other < 25.0 && shifted < 40.0, "another picture: {other:.1} dB, a pixel off: {shifted:.1} dB");
    }
    Ok(())
}

/// Compares every level in every block format with the RGBA version of the same file. Transcoded blocks have the error
/// of another encoder: 40 dB. ETC1S in ETC2 and UASTC in ASTC have the same texels, to within 1/255.
#[test]
fn every_level_is_sampled_as_rgba() -> Result<(), Box<dyn Error>> {
    let test = "every_level_is_sampled_as_rgba";
    let Some(gpu) = gpu(test) else { return Ok(()) };
    let formats = each_format(test, &gpu);
    for name in ["color_etc1s.ktx2", "opaque_etc1s.ktx2", "color_uastc_zstd.ktx2", "normal_uastc.ktx2"] {
        let rgba = texels(&gpu, name, NONE, ImageFormat::Rgba8)?;
        assert_eq!(rgba.len(), 4 * (0..7).map(|level| (SIDE >> level).pow(2)).sum::<usize>());
        for (format, formats) in &formats {
            let blocks = texels(&gpu, name, *formats, *format)?;
            let found = psnr_db(&blocks, &rgba);
            let farthest = blocks.iter().zip(&rgba).map(|(a, b)| a.abs_diff(*b)).max();
            assert!(found >= 40.0, "{name} as {format:?}: {found:.1} dB");
            let is_same = match format {
                ImageFormat::Etc2Rgba8 => name.contains("etc1s"),
                ImageFormat::Astc4x4 => name.contains("uastc"),
                _ => false,
            };
            assert!(!is_same || farthest <= Some(1), "{name} as {format:?}: {farthest:?} of 255");
            let reversed: Vec<u8> = blocks.chunks(4).rev().flatten().copied().collect();
            assert!(psnr_db(&reversed, &rgba) < 30.0, "{name} as {format:?}: its texels are in any order");
        }
    }
    Ok(())
}

/// Returns the texels of all levels as a shader reads them, times 255, without sRGB decoding.
fn texels(gpu: &Gpu, name: &str, formats: BlockFormats, expected: ImageFormat) -> Result<Vec<u8>, Box<dyn Error>> {
    let scene = squares(formats, |document| {
        document["images"][1]["uri"] = json!(name);
        document["materials"][0] = json!({"occlusionTexture": {"index": 1}});
        document["scenes"][0]["nodes"] = json!([0]);
    })?;
    let [image] = &scene.images[..] else { return Err("one image is used".into()) };
    assert_eq!(image.format, expected, "{name}");
    let count: usize = image.levels.len();
    let sizes = (0..count as u32).map(|level| image.level_size(level));
    let total: u32 = sizes.map(|[width, height]| width * height).sum();
    let uploaded = GpuScene::upload(gpu, &scene, &mut progress::silent)?;
    let place = MATERIAL_BINDINGS.iter().position(|name| *name == "occlusion_texture").ok_or("it is listed")?;
    let Some(Binding::View(view)) = uploaded.material_binding(MaterialId::new(0), place) else {
        return Err("it is a texture".into());
    };
    let module = gpu.device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some("levels"),
        source: wgpu::ShaderSource::Wgsl(READ_LEVELS.into()),
    });
    let pipeline = gpu.device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: Some("levels"),
        layout: None,
        module: &module,
        entry_point: None,
        compilation_options: wgpu::PipelineCompilationOptions::default(),
        cache: None,
    });
    let out = gpu.device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
        label: Some("texels"),
        contents: &vec![0; 4 * total as usize],
        usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC,
    });
    let group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("levels"),
        layout: &pipeline.get_bind_group_layout(0),
        entries: &[
            wgpu::BindGroupEntry { binding: 0, resource: wgpu::BindingResource::TextureView(&view) },
            wgpu::BindGroupEntry { binding: 1, resource: out.as_entire_binding() },
        ],
    });
    let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
    pass.set_pipeline(&pipeline);
    pass.set_bind_group(0, &group, &[]);
    pass.dispatch_workgroups(1, 1, 1);
    drop(pass);
    gpu.queue.submit([encoder.finish()]);
    Ok(read_buffer(gpu, &out, out.size())?)
}

/// Writes every texel of every level, one level after another.
const READ_LEVELS: &str = "
@group(0) @binding(0) var image: texture_2d<f32>;
@group(0) @binding(1) var<storage, read_write> texels: array<u32>;

@compute @workgroup_size(64)
fn main(@builtin(local_invocation_index) lane: u32) {
    var first = 0u;
    for (var level = 0u; level < textureNumLevels(image); level += 1u) {
        let size = textureDimensions(image, level);
        for (var at = lane; at < size.x * size.y; at += 64u) {
            let texel = textureLoad(image, vec2<u32>(at % size.x, at / size.x), level);
            texels[first + at] = pack4x8unorm(texel);
        }
        first += size.x * size.y;
    }
}
";
