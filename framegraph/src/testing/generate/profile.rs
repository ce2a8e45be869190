//! What generated graphs are like.

/// The size of the frame that generated graphs are made for, in texels: small, so that sizes coincide often.
pub const FRAME: [u32; 2] = [64, 32];

/// What kind of graph is wanted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Profile {
    /// Passes at most, at least 1.
    pub max_passes: u8,
    /// Breaks rules now and then.
    pub sloppy: bool,
    /// Only whole textures of one part, no buffers, no MSAA: small graphs that brute force can follow.
    pub plain: bool,
    /// No access names some bytes of a buffer, or sees a texture through another format: for judges that know neither.
    pub plain_accesses: bool,
    /// Textures of three dimensions too.
    pub volumes: bool,
    /// Some of what passes wrote is forwarded to other textures, where that is allowed.
    pub forwards: bool,
}

impl Default for Profile {
    fn default() -> Self {
        Self { max_passes: 12, sloppy: false, plain: false, plain_accesses: false, volumes: true, forwards: false }
    }
}
