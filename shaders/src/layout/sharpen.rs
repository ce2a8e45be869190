//! Mirror of the struct of `wgsl/pass/sharpen.wgsl`.

use bytemuck::{Pod, Zeroable};

/// Settings of sharpening.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct SharpenUniforms {
    /// Strength, 0…1.
    pub strength: f32,
    /// Padding to 16 bytes; zero.
    pub _pad: [f32; 3],
}

#[cfg(test)]
pub(super) fn layouts() -> Vec<crate::reflect::StructLayout> {
    vec![layout_of!(SharpenUniforms { strength, _pad })]
}
