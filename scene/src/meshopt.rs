//! Decoder of buffer views compressed with `EXT_meshopt_compression` or `KHR_meshopt_compression`.
//!
//! The formats are defined in appendices A and B of the glTF 2.0 extension `KHR_meshopt_compression`.
//! `EXT_meshopt_compression` is the older subset without version 1 of attributes and without the color filter.
//!
//! ```text
//! Layout (count, stride, mode, filter) ── check ──┐
//! compressed bytes ───────────────────────────────┴─> attributes, triangles or indices ─> filter ─> bytes of the view
//! ```
//!
//! Existing crates were not suitable: `meshopt` wraps C++, `meshopt-rs` 0.1.2 has neither version 1 of attributes nor
//! the color filter, and both contain `unsafe`. This module has no `unsafe` code and does not depend on glTF documents:
//! `import` parses the extension and charges memory.

mod attributes;
mod error;
mod filter;
mod groups;
mod indices;
mod input;
mod layout;
mod triangles;

#[cfg(test)]
mod tests;

pub(crate) use error::MeshoptError;
pub(crate) use layout::{Filter, Layout, Mode};

/// Decodes a compressed buffer view of this layout. Returns `layout.count * layout.stride` bytes.
///
/// # Errors
///
/// Fails for a layout that the extension forbids, and for streams that are too short, too long or invalid. The stream
/// length is checked against the layout before anything is allocated.
pub(crate) fn decode(layout: &Layout, bytes: &[u8]) -> Result<Vec<u8>, MeshoptError> {
    layout.check(bytes.len())?;
    let mut decoded = match layout.mode {
        Mode::Attributes => attributes::decode(layout, bytes)?,
        Mode::Triangles => triangles::decode(layout, bytes)?,
        Mode::Indices => indices::decode(layout, bytes)?,
    };
    filter::apply(layout, &mut decoded);
    Ok(decoded)
}
