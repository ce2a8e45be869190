//! Stencil state of materials.

/// Stencil test and operations of a material. Filament's `MaterialInstance::setStencil…`.
///
/// Reference and masks apply to both faces, since WebGPU has one of each.
///
/// ```
/// use framegraph_scene::material::{Material, Stencil, StencilCompare, StencilFace, StencilOp};
///
/// // Marks what it covers with 1; and is drawn where the mark is not.
/// let mark = StencilFace { pass: StencilOp::Replace, ..StencilFace::default() };
/// let mark = Stencil { write: true, reference: 1, ..Stencil::both(mark) };
/// let unmarked = StencilFace { compare: StencilCompare::NotEqual, ..StencilFace::default() };
/// let unmarked = Stencil { reference: 1, ..Stencil::both(unmarked) };
/// let material = Material { stencil: Some(Box::new(mark)), ..Material::default() };
/// # assert!(material.stencil.is_some_and(|own| *own != unmarked));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Stencil {
    /// True if the operations of the faces modify the buffer; otherwise only the test applies. Filament's
    /// `setStencilWrite`.
    pub write: bool,
    /// Reference value of the comparison and of [`StencilOp::Replace`].
    pub reference: u8,
    /// Mask of the bits that are compared.
    pub read_mask: u8,
    /// Mask of the bits that are written.
    pub write_mask: u8,
    /// Test and operations of front faces.
    pub front: StencilFace,
    /// Test and operations of back faces.
    pub back: StencilFace,
}

impl Default for Stencil {
    /// Returns a test that always passes, without writes, as in Filament.
    fn default() -> Self {
        Self::both(StencilFace::default())
    }
}

impl Stencil {
    /// Returns a state with the same test and operations for both faces, reference 0, full masks, and no writes.
    #[must_use]
    pub const fn both(face: StencilFace) -> Self {
        Self { write: false, reference: 0, read_mask: u8::MAX, write_mask: u8::MAX, front: face, back: face }
    }
}

/// Stencil test and operations of front or back faces.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct StencilFace {
    /// Comparison of the reference with the buffer. Filament's `setStencilCompareFunction`.
    pub compare: StencilCompare,
    /// Operation where the stencil test fails. Filament's `setStencilOpStencilFail`.
    pub stencil_fail: StencilOp,
    /// Operation where the stencil test passes and the depth test fails. Filament's `setStencilOpDepthFail`.
    pub depth_fail: StencilOp,
    /// Operation where both tests pass. Filament's `setStencilOpDepthStencilPass`.
    pub pass: StencilOp,
}

/// Comparison function; passes if `reference OP buffer value` holds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum StencilCompare {
    /// Always passes.
    #[default]
    Always,
    /// Never passes.
    Never,
    /// The reference is less.
    Less,
    /// The reference is less or equal.
    LessEqual,
    /// Both are equal.
    Equal,
    /// Both differ.
    NotEqual,
    /// The reference is greater or equal.
    GreaterEqual,
    /// The reference is greater.
    Greater,
}

impl StencilCompare {
    /// All comparisons with their names in files, which are WebGPU's.
    pub const NAMES: [(&'static str, Self); 8] = [
        ("always", Self::Always),
        ("never", Self::Never),
        ("less", Self::Less),
        ("less-equal", Self::LessEqual),
        ("equal", Self::Equal),
        ("not-equal", Self::NotEqual),
        ("greater-equal", Self::GreaterEqual),
        ("greater", Self::Greater),
    ];
}

/// Operation on the value in the stencil buffer.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum StencilOp {
    /// Keeps the value.
    #[default]
    Keep,
    /// Writes 0.
    Zero,
    /// Writes the reference.
    Replace,
    /// Inverts all bits.
    Invert,
    /// Increments, clamped to 255.
    IncrementClamp,
    /// Decrements, clamped to 0.
    DecrementClamp,
    /// Increments; 255 becomes 0.
    IncrementWrap,
    /// Decrements; 0 becomes 255.
    DecrementWrap,
}

impl StencilOp {
    /// All operations with their names in files, which are WebGPU's.
    pub const NAMES: [(&'static str, Self); 8] = [
        ("keep", Self::Keep),
        ("zero", Self::Zero),
        ("replace", Self::Replace),
        ("invert", Self::Invert),
        ("increment-clamp", Self::IncrementClamp),
        ("decrement-clamp", Self::DecrementClamp),
        ("increment-wrap", Self::IncrementWrap),
        ("decrement-wrap", Self::DecrementWrap),
    ];
}
