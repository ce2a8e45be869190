//! The slots of plugins: names by which a file binds resources.

/// What a slot of a plugin is bound to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Takes {
    /// A texture that is read; an earlier image of a history too.
    Texture,
    /// A buffer that is read.
    Buffer,
    /// A texture that is written: one that the file declares, or one that the plugin makes under that name.
    Target,
    /// A buffer that is written, likewise.
    TargetBuffer,
}

impl Takes {
    /// Whether the plugin writes what the slot is bound to.
    pub(super) const fn is_target(self) -> bool {
        matches!(self, Self::Target | Self::TargetBuffer)
    }
}

/// A name by which a file binds a resource to a plugin.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PluginSlot {
    /// The name in files.
    pub name: &'static str,
    /// What it is bound to.
    pub takes: Takes,
    /// May be left unbound.
    pub optional: bool,
}

impl PluginSlot {
    /// A slot that must be bound.
    pub const fn required(name: &'static str, takes: Takes) -> Self {
        Self { name, takes, optional: false }
    }

    /// A slot that may be left unbound.
    pub const fn optional(name: &'static str, takes: Takes) -> Self {
        Self { name, takes, optional: true }
    }
}
