//! Slots of plugins, to which files bind resources.

/// Type of a plugin slot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SlotType {
    /// A texture that is read, including earlier history images.
    Texture,
    /// A buffer that is read.
    Buffer,
    /// A texture that is written: declared by the file, or created by the plugin under that name.
    Target,
    /// A buffer that is written: declared by the file, or created by the plugin under that name.
    TargetBuffer,
}

impl SlotType {
    /// Returns `true` if the plugin writes the resource.
    pub(super) const fn is_target(self) -> bool {
        matches!(self, Self::Target | Self::TargetBuffer)
    }
}

/// A named input or output of a plugin.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PluginSlot {
    /// Name in files.
    pub name: &'static str,
    /// Type of the slot.
    pub ty: SlotType,
    /// The slot may be left unbound.
    pub optional: bool,
}

impl PluginSlot {
    /// Creates a slot that must be bound.
    pub const fn required(name: &'static str, ty: SlotType) -> Self {
        Self { name, ty, optional: false }
    }

    /// Creates a slot that may be left unbound.
    pub const fn optional(name: &'static str, ty: SlotType) -> Self {
        Self { name, ty, optional: true }
    }
}
