//! Conversion of a plan's enumerations to Vulkan: formats, layouts, stages and accesses.

use ash::vk;
use framegraph::{Aspect, Format, LoadOp, Role, Stages, State, StoreOp, Usage};

/// Returns the corresponding format; `None` if these tests do not need it.
pub fn format(format: Format) -> Option<vk::Format> {
    Some(match format {
        Format::R8Unorm => vk::Format::R8_UNORM,
        Format::R8Uint => vk::Format::R8_UINT,
        Format::R16Float => vk::Format::R16_SFLOAT,
        Format::Rg8Unorm => vk::Format::R8G8_UNORM,
        Format::R32Uint => vk::Format::R32_UINT,
        Format::R32Sint => vk::Format::R32_SINT,
        Format::R32Float => vk::Format::R32_SFLOAT,
        Format::Rg16Float => vk::Format::R16G16_SFLOAT,
        Format::Rgba8Unorm => vk::Format::R8G8B8A8_UNORM,
        Format::Rgba8UnormSrgb => vk::Format::R8G8B8A8_SRGB,
        Format::Bgra8Unorm => vk::Format::B8G8R8A8_UNORM,
        Format::Bgra8UnormSrgb => vk::Format::B8G8R8A8_SRGB,
        Format::Rgb10a2Unorm => vk::Format::A2B10G10R10_UNORM_PACK32,
        Format::Rg11b10Ufloat => vk::Format::B10G11R11_UFLOAT_PACK32,
        Format::Rg32Uint => vk::Format::R32G32_UINT,
        Format::Rg32Float => vk::Format::R32G32_SFLOAT,
        Format::Rgba16Uint => vk::Format::R16G16B16A16_UINT,
        Format::Rgba16Float => vk::Format::R16G16B16A16_SFLOAT,
        Format::Rgba32Uint => vk::Format::R32G32B32A32_UINT,
        Format::Rgba32Float => vk::Format::R32G32B32A32_SFLOAT,
        Format::Depth16Unorm => vk::Format::D16_UNORM,
        Format::Depth32Float => vk::Format::D32_SFLOAT,
        _ => return None,
    })
}

/// Returns the planes of `aspect`.
pub fn planes(format: Format, aspect: Aspect) -> vk::ImageAspectFlags {
    let depth = format.has_depth() && aspect != Aspect::Stencil;
    let stencil = format.has_stencil() && aspect != Aspect::Depth;
    match (depth, stencil) {
        (false, false) => vk::ImageAspectFlags::COLOR,
        (true, false) => vk::ImageAspectFlags::DEPTH,
        (false, true) => vk::ImageAspectFlags::STENCIL,
        (true, true) => vk::ImageAspectFlags::DEPTH | vk::ImageAspectFlags::STENCIL,
    }
}

/// Returns the layout of an image in a state; `Entry` depends on the replayer.
pub fn layout(state: State) -> vk::ImageLayout {
    match state {
        State::Undefined => vk::ImageLayout::UNDEFINED,
        State::ColorAttachment => vk::ImageLayout::COLOR_ATTACHMENT_OPTIMAL,
        State::DepthAttachment => vk::ImageLayout::DEPTH_STENCIL_ATTACHMENT_OPTIMAL,
        State::DepthReadOnly => vk::ImageLayout::DEPTH_STENCIL_READ_ONLY_OPTIMAL,
        State::InputAttachment | State::Sampled => vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL,
        State::CopySource => vk::ImageLayout::TRANSFER_SRC_OPTIMAL,
        State::CopyTarget => vk::ImageLayout::TRANSFER_DST_OPTIMAL,
        State::Entry | State::Storage | State::Uniform | State::VertexInput | State::Indirect => {
            vk::ImageLayout::GENERAL
        }
    }
}

const STAGES: [(Stages, vk::PipelineStageFlags); 7] = [
    (
        Stages::SHADER,
        vk::PipelineStageFlags::from_raw(
            vk::PipelineStageFlags::VERTEX_SHADER.as_raw() | vk::PipelineStageFlags::FRAGMENT_SHADER.as_raw(),
        ),
    ),
    (Stages::COLOR, vk::PipelineStageFlags::COLOR_ATTACHMENT_OUTPUT),
    (
        Stages::DEPTH,
        vk::PipelineStageFlags::from_raw(
            vk::PipelineStageFlags::EARLY_FRAGMENT_TESTS.as_raw()
                | vk::PipelineStageFlags::LATE_FRAGMENT_TESTS.as_raw(),
        ),
    ),
    (Stages::COMPUTE, vk::PipelineStageFlags::COMPUTE_SHADER),
    (Stages::COPY, vk::PipelineStageFlags::TRANSFER),
    (Stages::VERTEX_INPUT, vk::PipelineStageFlags::VERTEX_INPUT),
    (Stages::INDIRECT, vk::PipelineStageFlags::DRAW_INDIRECT),
];

/// Converts stages; an empty set becomes `none`.
pub fn stages(stages: Stages, none: vk::PipelineStageFlags) -> vk::PipelineStageFlags {
    let known = STAGES.iter().filter(|(stage, _)| stages.contains(*stage));
    let all = known.fold(vk::PipelineStageFlags::empty(), |all, (_, flags)| all | *flags);
    if all.is_empty() { none } else { all }
}

/// Returns the read and write accesses of stages for a resource in a state.
pub fn accesses(stages: Stages, state: State) -> (vk::AccessFlags, vk::AccessFlags) {
    let (mut reads, mut writes) = (vk::AccessFlags::empty(), vk::AccessFlags::empty());
    let has = |stage| stages.contains(stage);
    if has(Stages::COLOR) {
        reads |= vk::AccessFlags::COLOR_ATTACHMENT_READ;
        if state != State::DepthReadOnly {
            writes |= vk::AccessFlags::COLOR_ATTACHMENT_WRITE;
        }
    }
    if has(Stages::DEPTH) {
        reads |= vk::AccessFlags::DEPTH_STENCIL_ATTACHMENT_READ;
        if state != State::DepthReadOnly {
            writes |= vk::AccessFlags::DEPTH_STENCIL_ATTACHMENT_WRITE;
        }
    }
    if has(Stages::SHADER) || has(Stages::COMPUTE) {
        reads |= match state {
            State::Uniform => vk::AccessFlags::UNIFORM_READ,
            _ => vk::AccessFlags::SHADER_READ | vk::AccessFlags::UNIFORM_READ,
        };
        if matches!(state, State::Storage | State::Undefined) {
            writes |= vk::AccessFlags::SHADER_WRITE;
        }
    }
    if has(Stages::COPY) {
        reads |= vk::AccessFlags::TRANSFER_READ;
        if state != State::CopySource {
            writes |= vk::AccessFlags::TRANSFER_WRITE;
        }
    }
    if has(Stages::VERTEX_INPUT) {
        reads |= vk::AccessFlags::VERTEX_ATTRIBUTE_READ | vk::AccessFlags::INDEX_READ;
    }
    if has(Stages::INDIRECT) {
        reads |= vk::AccessFlags::INDIRECT_COMMAND_READ;
    }
    (reads, writes)
}

/// Converts the usage of an image.
pub fn image_usage(usage: Usage, format: Format) -> vk::ImageUsageFlags {
    let attachment = match format.is_depth_stencil() {
        true => vk::ImageUsageFlags::DEPTH_STENCIL_ATTACHMENT,
        false => vk::ImageUsageFlags::COLOR_ATTACHMENT,
    };
    let table = [
        (Usage::ATTACHMENT, attachment),
        (Usage::INPUT_ATTACHMENT, vk::ImageUsageFlags::SAMPLED),
        (Usage::SAMPLED, vk::ImageUsageFlags::SAMPLED),
        (Usage::STORAGE, vk::ImageUsageFlags::STORAGE),
        (Usage::COPY_SOURCE, vk::ImageUsageFlags::TRANSFER_SRC),
        (Usage::COPY_TARGET, vk::ImageUsageFlags::TRANSFER_DST),
    ];
    table
        .iter()
        .filter(|(one, _)| usage.contains(*one))
        .fold(vk::ImageUsageFlags::empty(), |all, (_, flag)| all | *flag)
}

/// Converts the usage of a buffer.
pub fn buffer_usage(usage: Usage) -> vk::BufferUsageFlags {
    let table = [
        (Usage::STORAGE, vk::BufferUsageFlags::STORAGE_BUFFER),
        (Usage::UNIFORM, vk::BufferUsageFlags::UNIFORM_BUFFER),
        (Usage::VERTEX, vk::BufferUsageFlags::VERTEX_BUFFER),
        (Usage::INDEX, vk::BufferUsageFlags::INDEX_BUFFER),
        (Usage::INDIRECT, vk::BufferUsageFlags::INDIRECT_BUFFER),
        (Usage::COPY_SOURCE, vk::BufferUsageFlags::TRANSFER_SRC),
        (Usage::COPY_TARGET, vk::BufferUsageFlags::TRANSFER_DST),
    ];
    table
        .iter()
        .filter(|(one, _)| usage.contains(*one))
        .fold(vk::BufferUsageFlags::empty(), |all, (_, flag)| all | *flag)
}

/// Converts a load operation.
pub fn load(op: LoadOp) -> vk::AttachmentLoadOp {
    match op {
        LoadOp::Load => vk::AttachmentLoadOp::LOAD,
        LoadOp::Clear => vk::AttachmentLoadOp::CLEAR,
        LoadOp::DontCare => vk::AttachmentLoadOp::DONT_CARE,
    }
}

/// Converts a store operation.
pub fn store(op: StoreOp) -> vk::AttachmentStoreOp {
    match op {
        StoreOp::Store => vk::AttachmentStoreOp::STORE,
        StoreOp::Discard => vk::AttachmentStoreOp::DONT_CARE,
        StoreOp::None => vk::AttachmentStoreOp::NONE,
    }
}

/// Returns the slot of a color attachment.
pub fn color_slot(role: Role) -> Option<u8> {
    match role {
        Role::Color(slot) => Some(slot),
        _ => None,
    }
}
