//! Rust mirrors of the structs and vertices that the shaders read.
//!
//! Each struct is `#[repr(C)]` with explicit padding and can be written to a buffer as bytes. A test compares the name,
//! the size and every member's offset with naga's layout of the WGSL struct. It fails if either side has a struct or
//! member without a counterpart. Each file lists its structs in `layouts` for this test.
//!
//! All structs are [`Zeroable`](bytemuck::Zeroable). Error-prone values, such as normal matrices, spot cones and
//! texture transforms, have constructors here.

/// Returns the size of a field without naming its type.
#[cfg(test)]
const fn size_of_field<S, F>(_: fn(&S) -> &F) -> u32 {
    size_of::<F>() as u32
}

/// Returns the layout of a Rust struct, given all its fields. A macro is necessary to name fields; its pattern without
/// `..` fails to compile if a field is missing.
#[cfg(test)]
macro_rules! layout_of {
    ($name:ident { $($field:ident),* $(,)? }) => {{
        let _complete = |value: $name| {
            let $name { $($field: _),* } = value;
        };
        crate::reflect::StructLayout {
            name: stringify!($name).to_owned(),
            size_bytes: size_of::<$name>() as u32,
            members: [$(crate::reflect::Member {
                name: stringify!($field).to_owned(),
                offset_bytes: std::mem::offset_of!($name, $field) as u32,
                size_bytes: $crate::layout::size_of_field(|value: &$name| &value.$field),
            }),*]
            .into_iter()
            .filter(|member| !member.name.starts_with("_pad"))
            .collect(),
        }
    }};
}

mod bloom;
mod dof;
mod fog;
mod frame;
mod froxel;
mod grading;
mod grading_settings;
mod ibl;
mod light;
mod material;
mod motion;
mod object;
mod occlusion;
mod post;
mod reflection;
mod shadow;
mod sharpen;
mod sky;
mod taa;
#[cfg(test)]
mod tests;
mod tone;
mod vertex;

pub use bloom::*;
pub use dof::*;
pub use fog::*;
pub use frame::*;
pub use froxel::*;
pub use grading::*;
pub use grading_settings::*;
pub use ibl::*;
pub use light::*;
pub use material::*;
pub use motion::*;
pub use object::*;
pub use occlusion::*;
pub use post::*;
pub use reflection::*;
pub use shadow::*;
pub use sharpen::*;
pub use sky::*;
pub use taa::*;
pub use tone::*;
pub use vertex::*;
