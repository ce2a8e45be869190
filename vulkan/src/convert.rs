//! Conversion of a plan's enumerations to Vulkan: formats, layouts, stages, accesses, usages and operations.

use ash::vk;
use framegraph::{Aspect, ClearValue, Format, LoadOp, ResolveMode, Stages, State, StoreOp, Usage};

/// Returns the Vulkan format of a format. `Depth24Plus` becomes `D32_SFLOAT`, and `Depth24PlusStencil8` becomes
/// `D32_SFLOAT_S8_UINT`, which more devices support than formats of 24 bits.
#[must_use]
pub const fn vk_format(format: Format) -> vk::Format {
    match format {
        Format::R8Unorm => vk::Format::R8_UNORM,
        Format::R8Snorm => vk::Format::R8_SNORM,
        Format::R8Uint => vk::Format::R8_UINT,
        Format::R8Sint => vk::Format::R8_SINT,
        Format::R16Uint => vk::Format::R16_UINT,
        Format::R16Sint => vk::Format::R16_SINT,
        Format::R16Float => vk::Format::R16_SFLOAT,
        Format::Rg8Unorm => vk::Format::R8G8_UNORM,
        Format::Rg8Snorm => vk::Format::R8G8_SNORM,
        Format::Rg8Uint => vk::Format::R8G8_UINT,
        Format::Rg8Sint => vk::Format::R8G8_SINT,
        Format::R32Uint => vk::Format::R32_UINT,
        Format::R32Sint => vk::Format::R32_SINT,
        Format::R32Float => vk::Format::R32_SFLOAT,
        Format::Rg16Uint => vk::Format::R16G16_UINT,
        Format::Rg16Sint => vk::Format::R16G16_SINT,
        Format::Rg16Float => vk::Format::R16G16_SFLOAT,
        Format::Rgba8Unorm => vk::Format::R8G8B8A8_UNORM,
        Format::Rgba8UnormSrgb => vk::Format::R8G8B8A8_SRGB,
        Format::Rgba8Snorm => vk::Format::R8G8B8A8_SNORM,
        Format::Rgba8Uint => vk::Format::R8G8B8A8_UINT,
        Format::Rgba8Sint => vk::Format::R8G8B8A8_SINT,
        Format::Bgra8Unorm => vk::Format::B8G8R8A8_UNORM,
        Format::Bgra8UnormSrgb => vk::Format::B8G8R8A8_SRGB,
        Format::Rgb9e5Ufloat => vk::Format::E5B9G9R9_UFLOAT_PACK32,
        Format::Rgb10a2Uint => vk::Format::A2B10G10R10_UINT_PACK32,
        Format::Rgb10a2Unorm => vk::Format::A2B10G10R10_UNORM_PACK32,
        Format::Rg11b10Ufloat => vk::Format::B10G11R11_UFLOAT_PACK32,
        Format::Rg32Uint => vk::Format::R32G32_UINT,
        Format::Rg32Sint => vk::Format::R32G32_SINT,
        Format::Rg32Float => vk::Format::R32G32_SFLOAT,
        Format::Rgba16Uint => vk::Format::R16G16B16A16_UINT,
        Format::Rgba16Sint => vk::Format::R16G16B16A16_SINT,
        Format::Rgba16Float => vk::Format::R16G16B16A16_SFLOAT,
        Format::Rgba32Uint => vk::Format::R32G32B32A32_UINT,
        Format::Rgba32Sint => vk::Format::R32G32B32A32_SINT,
        Format::Rgba32Float => vk::Format::R32G32B32A32_SFLOAT,
        Format::Stencil8 => vk::Format::S8_UINT,
        Format::Depth16Unorm => vk::Format::D16_UNORM,
        Format::Depth24Plus | Format::Depth32Float => vk::Format::D32_SFLOAT,
        Format::Depth24PlusStencil8 | Format::Depth32FloatStencil8 => vk::Format::D32_SFLOAT_S8_UINT,
        Format::Bc1RgbaUnorm => vk::Format::BC1_RGBA_UNORM_BLOCK,
        Format::Bc1RgbaUnormSrgb => vk::Format::BC1_RGBA_SRGB_BLOCK,
        Format::Bc3RgbaUnorm => vk::Format::BC3_UNORM_BLOCK,
        Format::Bc3RgbaUnormSrgb => vk::Format::BC3_SRGB_BLOCK,
        Format::Bc4RUnorm => vk::Format::BC4_UNORM_BLOCK,
        Format::Bc5RgUnorm => vk::Format::BC5_UNORM_BLOCK,
        Format::Bc6hRgbUfloat => vk::Format::BC6H_UFLOAT_BLOCK,
        Format::Bc7RgbaUnorm => vk::Format::BC7_UNORM_BLOCK,
        Format::Bc7RgbaUnormSrgb => vk::Format::BC7_SRGB_BLOCK,
        Format::Etc2Rgb8Unorm => vk::Format::ETC2_R8G8B8_UNORM_BLOCK,
        Format::Etc2Rgba8Unorm => vk::Format::ETC2_R8G8B8A8_UNORM_BLOCK,
        Format::Astc4x4Unorm => vk::Format::ASTC_4X4_UNORM_BLOCK,
        Format::Astc4x4UnormSrgb => vk::Format::ASTC_4X4_SRGB_BLOCK,
        Format::Astc8x8Unorm => vk::Format::ASTC_8X8_UNORM_BLOCK,
    }
}

/// Returns the planes of `aspect`.
pub(crate) fn planes(format: Format, aspect: Aspect) -> vk::ImageAspectFlags {
    let depth = format.has_depth() && aspect != Aspect::Stencil;
    let stencil = format.has_stencil() && aspect != Aspect::Depth;
    match (depth, stencil) {
        (false, false) => vk::ImageAspectFlags::COLOR,
        (true, false) => vk::ImageAspectFlags::DEPTH,
        (false, true) => vk::ImageAspectFlags::STENCIL,
        (true, true) => vk::ImageAspectFlags::DEPTH | vk::ImageAspectFlags::STENCIL,
    }
}

/// Returns the flag of one plane, by its number.
pub(crate) fn plane(format: Format, number: u32) -> vk::ImageAspectFlags {
    let aspect = match (format.planes(), number) {
        (1, _) => Aspect::All,
        (_, 0) => Aspect::Depth,
        _ => Aspect::Stencil,
    };
    planes(format, aspect)
}

/// Returns the layout of one plane of an image in a state. Planes of depth-stencil formats have layouts of their own.
///
/// `Entry` and `Undefined` become `UNDEFINED`; the executor tracks the layout behind `Entry`.
pub(crate) fn layout(state: State, format: Format, number: u32) -> vk::ImageLayout {
    let two = format.planes() > 1;
    match state {
        // An owner's declared state does not know the format.
        State::ColorAttachment if format.is_depth_stencil() => layout(State::DepthAttachment, format, number),
        State::Undefined | State::Entry => vk::ImageLayout::UNDEFINED,
        State::ColorAttachment => vk::ImageLayout::COLOR_ATTACHMENT_OPTIMAL,
        State::DepthAttachment if two && number == 0 => vk::ImageLayout::DEPTH_ATTACHMENT_OPTIMAL,
        State::DepthAttachment if two => vk::ImageLayout::STENCIL_ATTACHMENT_OPTIMAL,
        State::DepthAttachment => vk::ImageLayout::DEPTH_STENCIL_ATTACHMENT_OPTIMAL,
        State::DepthReadOnly if two && number == 0 => vk::ImageLayout::DEPTH_READ_ONLY_OPTIMAL,
        State::DepthReadOnly if two => vk::ImageLayout::STENCIL_READ_ONLY_OPTIMAL,
        State::DepthReadOnly => vk::ImageLayout::DEPTH_STENCIL_READ_ONLY_OPTIMAL,
        State::InputAttachment | State::Sampled => vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL,
        State::CopySource => vk::ImageLayout::TRANSFER_SRC_OPTIMAL,
        State::CopyTarget => vk::ImageLayout::TRANSFER_DST_OPTIMAL,
        State::Storage | State::Uniform | State::VertexInput | State::Indirect => vk::ImageLayout::GENERAL,
    }
}

/// Returns the pipeline stages of a set.
pub(crate) fn stages(stages: Stages) -> vk::PipelineStageFlags2 {
    use vk::PipelineStageFlags2 as Flags;
    let table = [
        (Stages::SHADER, Flags::VERTEX_SHADER | Flags::FRAGMENT_SHADER),
        (Stages::COLOR, Flags::COLOR_ATTACHMENT_OUTPUT),
        (Stages::DEPTH, Flags::EARLY_FRAGMENT_TESTS | Flags::LATE_FRAGMENT_TESTS),
        (Stages::COMPUTE, Flags::COMPUTE_SHADER),
        (Stages::COPY, Flags::ALL_TRANSFER),
        (Stages::VERTEX_INPUT, Flags::VERTEX_INPUT),
        (Stages::INDIRECT, Flags::DRAW_INDIRECT),
    ];
    let known = table.iter().filter(|(stage, _)| stages.contains(*stage));
    known.fold(Flags::NONE, |all, (_, flags)| all | *flags)
}

/// Returns the read and write accesses of stages for a resource in a state.
pub(crate) fn accesses(stages: Stages, state: State) -> [vk::AccessFlags2; 2] {
    use vk::AccessFlags2 as Flags;
    let (mut reads, mut writes) = (Flags::NONE, Flags::NONE);
    let has = |stage| stages.contains(stage);
    let attached = matches!(state, State::ColorAttachment | State::DepthAttachment | State::DepthReadOnly);
    if has(Stages::COLOR) {
        reads |= Flags::COLOR_ATTACHMENT_READ;
        writes |= Flags::COLOR_ATTACHMENT_WRITE;
    }
    if has(Stages::DEPTH) {
        reads |= Flags::DEPTH_STENCIL_ATTACHMENT_READ;
        writes |= Flags::DEPTH_STENCIL_ATTACHMENT_WRITE;
    }
    if state == State::DepthReadOnly {
        writes = Flags::NONE;
    }
    if has(Stages::SHADER) || has(Stages::COMPUTE) {
        reads |= if state == State::Uniform { Flags::UNIFORM_READ } else { Flags::SHADER_READ | Flags::UNIFORM_READ };
        if attached || state == State::InputAttachment {
            reads |= Flags::INPUT_ATTACHMENT_READ;
        }
        if matches!(state, State::Storage | State::Undefined) {
            writes |= Flags::SHADER_WRITE;
        }
    }
    if has(Stages::COPY) {
        reads |= Flags::TRANSFER_READ;
        if state != State::CopySource {
            writes |= Flags::TRANSFER_WRITE;
        }
    }
    if has(Stages::VERTEX_INPUT) {
        reads |= Flags::VERTEX_ATTRIBUTE_READ | Flags::INDEX_READ;
    }
    if has(Stages::INDIRECT) {
        reads |= Flags::INDIRECT_COMMAND_READ;
    }
    [reads, writes]
}

/// Returns the usage of an image. Memoryless images are transient, which allows attachments only.
pub(crate) fn image_usage(usage: Usage, format: Format, memoryless: bool) -> vk::ImageUsageFlags {
    use vk::ImageUsageFlags as Flags;
    let depth = format.is_depth_stencil();
    let attachment = if depth { Flags::DEPTH_STENCIL_ATTACHMENT } else { Flags::COLOR_ATTACHMENT };
    // A same-pixel read that does not stay in the tile is sampled.
    let same_pixel = if memoryless { Flags::INPUT_ATTACHMENT } else { Flags::INPUT_ATTACHMENT | Flags::SAMPLED };
    let table = [
        (Usage::ATTACHMENT, attachment),
        (Usage::INPUT_ATTACHMENT, same_pixel),
        (Usage::SAMPLED, Flags::SAMPLED),
        (Usage::STORAGE, Flags::STORAGE),
        (Usage::COPY_SOURCE, Flags::TRANSFER_SRC),
        (Usage::COPY_TARGET, Flags::TRANSFER_DST),
    ];
    let start = if memoryless { Flags::TRANSIENT_ATTACHMENT | attachment } else { Flags::empty() };
    let all = table.iter().filter(|(one, _)| usage.contains(*one)).fold(start, |all, (_, flag)| all | *flag);
    // Vulkan has no image without a usage.
    if all.is_empty() { Flags::SAMPLED } else { all }
}

/// Returns the usage of a buffer.
pub(crate) fn buffer_usage(usage: Usage) -> vk::BufferUsageFlags {
    use vk::BufferUsageFlags as Flags;
    let table = [
        (Usage::STORAGE, Flags::STORAGE_BUFFER),
        (Usage::UNIFORM, Flags::UNIFORM_BUFFER),
        (Usage::VERTEX, Flags::VERTEX_BUFFER),
        (Usage::INDEX, Flags::INDEX_BUFFER),
        (Usage::INDIRECT, Flags::INDIRECT_BUFFER),
        (Usage::COPY_SOURCE, Flags::TRANSFER_SRC),
        (Usage::COPY_TARGET, Flags::TRANSFER_DST),
    ];
    let all = table.iter().filter(|(one, _)| usage.contains(*one)).fold(Flags::empty(), |all, (_, flag)| all | *flag);
    if all.is_empty() { Flags::TRANSFER_DST } else { all }
}

/// Returns the load operation.
pub(crate) const fn load(op: LoadOp) -> vk::AttachmentLoadOp {
    match op {
        LoadOp::Load => vk::AttachmentLoadOp::LOAD,
        LoadOp::Clear => vk::AttachmentLoadOp::CLEAR,
        LoadOp::DontCare => vk::AttachmentLoadOp::DONT_CARE,
    }
}

/// Returns the store operation. Without `VK_ATTACHMENT_STORE_OP_NONE`, unchanged contents are stored again.
pub(crate) const fn store(op: StoreOp, has_none: bool) -> vk::AttachmentStoreOp {
    match op {
        StoreOp::Store => vk::AttachmentStoreOp::STORE,
        StoreOp::Discard => vk::AttachmentStoreOp::DONT_CARE,
        StoreOp::None if has_none => vk::AttachmentStoreOp::NONE,
        StoreOp::None => vk::AttachmentStoreOp::STORE,
    }
}

/// Returns the mode of a depth resolve.
pub(crate) const fn resolve_mode(mode: ResolveMode) -> vk::ResolveModeFlags {
    match mode {
        ResolveMode::Average => vk::ResolveModeFlags::AVERAGE,
        ResolveMode::Sample0 => vk::ResolveModeFlags::SAMPLE_ZERO,
        ResolveMode::Min => vk::ResolveModeFlags::MIN,
        ResolveMode::Max => vk::ResolveModeFlags::MAX,
    }
}

/// Returns the clear value of an attachment of this format; `None` clears to zero.
pub(crate) fn clear_value(value: Option<ClearValue>, format: Format) -> vk::ClearValue {
    use framegraph::Numeric;
    match value {
        Some(ClearValue::DepthStencil(depth, stencil)) => {
            vk::ClearValue { depth_stencil: vk::ClearDepthStencilValue { depth, stencil } }
        }
        Some(ClearValue::Color(color)) => {
            let color = match format.numeric() {
                Numeric::Uint => vk::ClearColorValue { uint32: color.map(|channel| channel as u32) },
                Numeric::Sint => vk::ClearColorValue { int32: color.map(|channel| channel as i32) },
                _ => vk::ClearColorValue { float32: color.map(|channel| channel as f32) },
            };
            vk::ClearValue { color }
        }
        Some(ClearValue::Zero) | None => vk::ClearValue::default(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn formats_are_distinct_except_for_depth_of_24_bits() {
        let mut seen: Vec<vk::Format> = Format::ALL.iter().map(|f| vk_format(*f)).collect();
        seen.sort_unstable();
        seen.dedup();
        assert_eq!(seen.len() + 2, Format::ALL.len());
    }

    #[test]
    fn planes_have_layouts_of_their_own() {
        let of = |number| layout(State::DepthAttachment, Format::Depth32FloatStencil8, number);
        assert!(of(0) != of(1));
        let one = layout(State::DepthAttachment, Format::Depth32Float, 0);
        assert!(one == vk::ImageLayout::DEPTH_STENCIL_ATTACHMENT_OPTIMAL);
    }

    #[test]
    fn reads_of_attachments_in_shaders_are_visible_to_input_attachments() {
        let [reads, writes] = accesses(Stages::SHADER.union(Stages::DEPTH), State::DepthReadOnly);
        assert!(reads.contains(vk::AccessFlags2::INPUT_ATTACHMENT_READ) && writes.is_empty());
    }
}
