//! Reasons why a resource has no texture or buffer.

/// Reason why a resource has no texture or buffer.
#[derive(Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum NoMemory {
    /// No frame was executed, or the last one failed.
    #[error("no frame was executed, or the last one failed; execute one first")]
    NotRealized,
    /// No pass of the plan uses the resource.
    #[error("no pass of the plan uses it; read or export it")]
    Unused,
    /// The plan inlined the pass that reads the resource.
    #[error("it is inlined into the shader that produces it; compile with `Options::inline` off to keep it")]
    Inlined,
    /// The resource is a memoryless attachment.
    #[error("it is a memoryless attachment; read it in a later pass, or export it, to keep it in memory")]
    Memoryless,
    /// The history is not declared in this frame.
    #[error("its history is not declared in this frame; declare it")]
    NoHistory,
    /// The resource is a surface texture, which is imported for one frame only.
    #[error("it is a surface texture, which is released after its frame; use it before")]
    Lent,
    /// A texture was requested, but the resource is a buffer.
    #[error("it is a buffer; look it up as one")]
    IsBuffer,
    /// A buffer was requested, but the resource is a texture.
    #[error("it is a texture; look it up as one")]
    IsTexture,
}

impl std::fmt::Debug for NoMemory {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        std::fmt::Display::fmt(self, f)
    }
}
