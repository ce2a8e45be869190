//! Parameters of generated graphs.

/// Frame size of generated graphs, in texels. Small, so that sizes often coincide.
pub const FRAME: [u32; 2] = [64, 32];

/// Parameters of a generated graph.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Profile {
    /// Maximum number of passes, at least 1.
    pub max_passes: u8,
    /// Violates rules now and then.
    pub sloppy: bool,
    /// Restricts the graph to whole single-subresource textures without multisampling, so that brute force can check
    /// it.
    pub plain: bool,
    /// Excludes byte ranges of buffers and views in other formats, for checkers that do not support them.
    pub plain_accesses: bool,
    /// Includes three-dimensional textures.
    pub volumes: bool,
    /// Includes forwards of textures.
    pub forwards: bool,
}

impl Default for Profile {
    fn default() -> Self {
        Self { max_passes: 12, sloppy: false, plain: false, plain_accesses: false, volumes: true, forwards: false }
    }
}
