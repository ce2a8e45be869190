//! Optional features of a device.

/// Commands for barriers that the engine enabled.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Synchronization {
    /// `vkCmdPipelineBarrier` of Vulkan 1.0.
    #[default]
    Legacy,
    /// `vkCmdPipelineBarrier2KHR`: the extension and its feature are enabled.
    Extension,
    /// `vkCmdPipelineBarrier2` of Vulkan 1.3: the feature `synchronization2` is enabled.
    Core,
}

/// Optional features that the engine enabled on its device.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct DeviceFeatures {
    /// Commands for barriers.
    pub synchronization: Synchronization,
    /// `separateDepthStencilLayouts`: planes of a depth-stencil texture can be in different layouts. Without it,
    /// graphs must not contain textures with two planes.
    pub separate_depth_stencil_layouts: bool,
    /// `VK_ATTACHMENT_STORE_OP_NONE`: Vulkan 1.3 or an extension.
    pub store_op_none: bool,
    /// `VK_EXT_debug_utils` is enabled on the instance: resources get names, and passes labels.
    pub debug_utils: bool,
}
