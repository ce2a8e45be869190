//! Why no texture or buffer stands behind a resource.

/// Why no texture or buffer stands behind a resource.
#[derive(Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum NoMemory {
    /// No frame was executed, or the last one failed.
    #[error("the frame has not been realized")]
    NotRealized,
    /// No pass that the plan kept touches it.
    #[error("no kept pass accesses it")]
    Unused,
    /// The plan made its reader part of its writer's shader.
    #[error("its reader is part of its writer's shader")]
    Inlined,
    /// It is an attachment whose contents never leave the tile.
    #[error("it lives in the tile")]
    Memoryless,
    /// It is an image of a history that no pass declared in this frame.
    #[error("its history is not declared")]
    NoHistory,
    /// The image of a surface, which was lent for one frame.
    #[error("it was lent for the frame alone")]
    Lent,
    /// A texture was asked for, and it is a buffer.
    #[error("it is a buffer")]
    IsBuffer,
    /// A buffer was asked for, and it is a texture.
    #[error("it is a texture")]
    IsTexture,
}

impl std::fmt::Debug for NoMemory {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        std::fmt::Display::fmt(self, f)
    }
}
