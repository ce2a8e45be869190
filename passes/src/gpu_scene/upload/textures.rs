//! Textures with their mip levels, and samplers.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::{Arc, Mutex};

use wgpu::{
    AddressMode, AstcBlock, AstcChannel, DeviceType, Extent3d, Features, FilterMode, MipmapFilterMode,
    SamplerDescriptor, TexelCopyBufferLayout, TextureAspect, TextureDescriptor, TextureDimension, TextureFormat,
    TextureUsages, TextureView, TextureViewDescriptor,
};

use super::buffers::limit;
use super::error::UploadError;
use framegraph_scene::MaterialId;
use framegraph_scene::Scene;
use framegraph_scene::SceneError;
use framegraph_scene::error::Quantity;
use framegraph_scene::material::{SLOT_COUNT, SLOT_ROLES};
use framegraph_scene::memory::{Loan, Memory, OverBudget};
use framegraph_scene::mips::{Level, level_count, mip_levels, working_bytes};
use framegraph_scene::parallel::in_parallel;
use framegraph_scene::progress::{Progress, ProgressFn, Stage, report};
use framegraph_scene::texture::{BlockFormats, Filter, Image, ImageFormat, Sampler, TextureRole, Wrap};
use framegraph_wgpu::Gpu;

/// View and sampler of each texture slot of each material.
#[derive(Debug)]
pub(super) struct MaterialTextures {
    slots: Vec<[(TextureView, wgpu::Sampler); SLOT_COUNT]>,
    size_bytes: u64,
}

/// Borrowed or owned images of a scene. An owned image is dropped once all its textures are written.
pub(super) type Images<'a> = Vec<Cow<'a, Image>>;

/// Image in one role, waiting for upload.
struct Job<'a> {
    image: usize,
    role: TextureRole,
    pixels: Mutex<Option<Arc<Cow<'a, Image>>>>,
    working_bytes: u64,
}

/// Returns the block-compressed formats that the device samples, as load options of a scene.
#[must_use]
pub fn block_formats(gpu: &Gpu) -> BlockFormats {
    let features = gpu.device.features();
    BlockFormats {
        bc7: features.contains(Features::TEXTURE_COMPRESSION_BC),
        etc2: features.contains(Features::TEXTURE_COMPRESSION_ETC2),
        astc: features.contains(Features::TEXTURE_COMPRESSION_ASTC),
    }
}

/// Returns the texture format for texels in a role.
fn texture_format(format: ImageFormat, role: TextureRole) -> TextureFormat {
    let is_srgb = match role {
        TextureRole::Color => true,
        TextureRole::Linear | TextureRole::Normal => false,
    };
    let linear = match format {
        ImageFormat::Rgba8 => TextureFormat::Rgba8Unorm,
        ImageFormat::Bc7 => TextureFormat::Bc7RgbaUnorm,
        ImageFormat::Etc2Rgba8 => TextureFormat::Etc2Rgba8Unorm,
        ImageFormat::Astc4x4 => TextureFormat::Astc { block: AstcBlock::B4x4, channel: AstcChannel::Unorm },
    };
    if is_srgb { linear.add_srgb_suffix() } else { linear }
}

/// Checks that a device with these features samples the format of an image.
pub(super) fn check_format(features: Features, image: &Image) -> Result<(), UploadError> {
    let format = texture_format(image.format, TextureRole::Linear);
    let is_sampled = features.contains(format.required_features());
    is_sampled.then_some(()).ok_or_else(|| UploadError::Format { image: image.name.clone(), format: image.format })
}

/// Number of bytes queued before a wait; queued copies occupy memory until they are executed.
const QUEUED_BYTES: u64 = 64 << 20;

impl MaterialTextures {
    /// Uploads every image once for each role in which a texture uses it, within `memory`.
    pub fn upload(
        gpu: &Gpu,
        scene: &Scene,
        images: Images<'_>,
        memory: &Memory,
        progress: &mut ProgressFn<'_>,
    ) -> Result<Self, UploadError> {
        let largest = gpu.device.limits().max_texture_dimension_2d;
        for image in &images {
            let side = u64::from(image.width.max(image.height));
            limit(&image.name, Quantity::Side, side, largest.into())?;
            check_format(gpu.device.features(), image)?;
        }
        let shared = matches!(gpu.info().device_type, DeviceType::Cpu | DeviceType::IntegratedGpu);
        let jobs = jobs(scene, images, shared);
        let mut uploaded: BTreeMap<(usize, TextureRole), TextureView> = BTreeMap::new();
        let (mut size_bytes, mut queued_bytes) = (0, 0);
        let mut outcome: Result<(), UploadError> = Ok(());
        let mut done = 0;
        let admit = |job: &Job<'_>| memory.lend(job.working_bytes);
        in_parallel(&jobs, admit, made, |i, made| {
            let Job { image, role, .. } = jobs[i];
            done += 1;
            if outcome.is_ok() {
                outcome = made.and_then(|Made { pixels, levels, loan }| {
                    let step = Progress { stage: Stage::Upload, done, total: jobs.len(), item: &pixels.name };
                    report(progress, Path::new(&scene.name), step)?;
                    let (view, bytes) = write(gpu, &pixels, role, &levels)?;
                    uploaded.insert((image, role), view);
                    (size_bytes, queued_bytes) = (size_bytes + bytes, queued_bytes + bytes);
                    // The device holds the copies now, which the loan covers until they are carried out.
                    if queued_bytes >= QUEUED_BYTES {
                        gpu.queue.submit([]);
                        gpu.wait()?;
                        queued_bytes = 0;
                    }
                    if let Some(Cow::Owned(image)) = Arc::into_inner(pixels) {
                        memory.free(image.size_bytes());
                    }
                    // What the device keeps is the machine's own memory where they share it.
                    loan.keep(if shared { bytes } else { 0 });
                    Ok(())
                });
            }
            match outcome {
                Ok(()) => ControlFlow::Continue(()),
                Err(_) => ControlFlow::Break(()),
            }
        });
        outcome?;

        let samplers: Vec<wgpu::Sampler> = scene.samplers.iter().map(|s| sampler(gpu, *s)).collect();
        let plain = sampler(gpu, Sampler::default());
        // One neutral texture for each role.
        let mut neutral: BTreeMap<TextureRole, TextureView> = BTreeMap::new();
        for role in SLOT_ROLES {
            if let Entry::Vacant(vacant) = neutral.entry(role) {
                vacant.insert(write(gpu, &neutral_image(role), role, &[])?.0);
            }
        }
        let slots = scene
            .materials
            .iter()
            .map(|material| {
                let slots = material.slots();
                std::array::from_fn(|i| match slots[i] {
                    Some(slot) => {
                        let texture = scene.textures[slot.texture.index()];
                        let view = &uploaded[&(texture.image.index(), texture.role)];
                        (view.clone(), samplers[texture.sampler.index()].clone())
                    }
                    None => (neutral[&SLOT_ROLES[i]].clone(), plain.clone()),
                })
            })
            .collect();
        Ok(Self { slots, size_bytes })
    }

    /// Returns the slots of a material, in the order of `Material::slots`.
    pub fn of_material(&self, material: MaterialId) -> &[(TextureView, wgpu::Sampler); SLOT_COUNT] {
        &self.slots[material.index()]
    }

    pub fn size_bytes(&self) -> u64 {
        self.size_bytes
    }
}

/// Returns each image once for each of its roles. `shared` is true if device and host share memory.
fn jobs<'a>(scene: &Scene, images: Images<'a>, shared: bool) -> Vec<Job<'a>> {
    let images: Vec<_> = images.into_iter().map(Arc::new).collect();
    let mut jobs: Vec<Job<'_>> = Vec::new();
    for texture in &scene.textures {
        let (image, role) = (texture.image.index(), texture.role);
        if !jobs.iter().any(|job| (job.image, job.role) == (image, role)) {
            let pixels = Arc::clone(&images[image]);
            // The levels with what making them takes, or with the copy of all of them that waits for the device.
            let bytes = pixels.size_bytes();
            let (copied_bytes, working_bytes) = if pixels.missing_levels() {
                let copied_bytes = bytes * 4 / 3;
                (copied_bytes, working_bytes(pixels.width, pixels.height).max(bytes / 3 + copied_bytes))
            } else {
                (bytes, bytes)
            };
            let working_bytes = working_bytes + if shared { copied_bytes } else { 0 };
            jobs.push(Job { image, role, pixels: Mutex::new(Some(pixels)), working_bytes });
        }
    }
    jobs
}

/// Image with its mip levels, ready for upload.
struct Made<'a, 'm> {
    pixels: Arc<Cow<'a, Image>>,
    levels: Vec<Level>,
    loan: Loan<'m>,
}

fn made<'a, 'm>(job: &Job<'a>, loan: Result<Loan<'m>, OverBudget>) -> Result<Made<'a, 'm>, UploadError> {
    let pixels = job.pixels.lock().unwrap_or_else(|poisoned| poisoned.into_inner()).take();
    let pixels = pixels.expect("a job is done once");
    let loan = loan.map_err(|budget| SceneError::Memory {
        file: pixels.name.clone().into(),
        at: format!("mip levels and upload, {}×{}", pixels.width, pixels.height),
        budget,
    })?;
    let levels = mip_levels(&pixels, job.role);
    Ok(Made { pixels, levels, loan })
}

/// Returns an image of one texel that leaves the factor unchanged.
fn neutral_image(role: TextureRole) -> Image {
    let texel = match role {
        TextureRole::Color | TextureRole::Linear => [255; 4],
        TextureRole::Normal => [128, 128, 255, 255],
    };
    Image::from_rgba8(format!("neutral {role:?}"), 1, 1, texel.to_vec())
}

/// Creates the texture of an image and queues the copy of its levels. Returns its size in bytes, too.
fn write(
    gpu: &Gpu,
    image: &Image,
    role: TextureRole,
    levels: &[Level],
) -> Result<(TextureView, u64), framegraph_wgpu::DeviceError> {
    let format = texture_format(image.format, role);
    let own = (0..).zip(&image.levels).map(|(level, bytes)| {
        let [width, height] = image.level_size(level);
        (width, height, bytes.as_slice())
    });
    let rest = levels.iter().map(|l| (l.width, l.height, l.rgba8.as_slice()));
    let all: Vec<_> = own.chain(rest).collect();
    debug_assert_eq!(all.len() as u32, level_count(image.width, image.height));
    let view = gpu.guard("a texture of the scene", || {
        let levels = all.iter().map(|(w, h, bytes)| (*w, *h, *bytes));
        write_levels(gpu, &image.name, format, image.format.block_bytes(), levels)
    })?;
    Ok((view, all.iter().map(|(.., bytes)| bytes.len() as u64).sum()))
}

/// Creates a two-dimensional texture of these levels (width, height, bytes), largest first. `block_bytes` is the size
/// of a block, or of a texel.
pub(super) fn write_levels<'a>(
    gpu: &Gpu,
    label: &str,
    format: TextureFormat,
    block_bytes: u32,
    levels: impl ExactSizeIterator<Item = (u32, u32, &'a [u8])>,
) -> TextureView {
    let mut levels = levels.peekable();
    let count = levels.len() as u32;
    let (width, height) = levels.peek().map_or((1, 1), |(w, h, _)| (*w, *h));
    let size = |width, height| Extent3d { width, height, depth_or_array_layers: 1 };
    let texture = gpu.device.create_texture(&TextureDescriptor {
        label: Some(label),
        size: size(width, height),
        mip_level_count: count,
        sample_count: 1,
        dimension: TextureDimension::D2,
        format,
        usage: TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_DST | TextureUsages::COPY_SRC,
        view_formats: &[],
    });
    let (block_width, block_height) = format.block_dimensions();
    for (level, (width, height, bytes)) in levels.enumerate() {
        // Copies consist of whole blocks, which may exceed small levels.
        let blocks = (width.div_ceil(block_width), height.div_ceil(block_height));
        gpu.queue.write_texture(
            wgpu::TexelCopyTextureInfo {
                texture: &texture,
                mip_level: level as u32,
                origin: wgpu::Origin3d::ZERO,
                aspect: TextureAspect::All,
            },
            bytes,
            TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(blocks.0 * block_bytes), rows_per_image: None },
            size(blocks.0 * block_width, blocks.1 * block_height),
        );
    }
    texture.create_view(&TextureViewDescriptor { label: Some(label), ..Default::default() })
}

fn sampler(gpu: &Gpu, sampler: Sampler) -> wgpu::Sampler {
    let address = |wrap| match wrap {
        Wrap::Repeat => AddressMode::Repeat,
        Wrap::MirroredRepeat => AddressMode::MirrorRepeat,
        Wrap::ClampToEdge => AddressMode::ClampToEdge,
    };
    let filter = |filter| match filter {
        Filter::Nearest => FilterMode::Nearest,
        Filter::Linear => FilterMode::Linear,
    };
    gpu.device.create_sampler(&SamplerDescriptor {
        label: Some("material"),
        address_mode_u: address(sampler.wrap_u),
        address_mode_v: address(sampler.wrap_v),
        address_mode_w: AddressMode::ClampToEdge,
        mag_filter: filter(sampler.mag),
        min_filter: filter(sampler.min),
        mipmap_filter: match sampler.mip {
            Some(Filter::Linear) => MipmapFilterMode::Linear,
            Some(Filter::Nearest) | None => MipmapFilterMode::Nearest,
        },
        // Up to a quarter: level 0 alone, but minification still counts as such (Vulkan
        // specification, VkSamplerCreateInfo, note on OpenGL's filters without mip levels).
        lod_max_clamp: if sampler.mip.is_some() { 32.0 } else { 0.25 },
        ..SamplerDescriptor::default()
    })
}
