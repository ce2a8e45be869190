//! Depth of the visible surfaces: a prepass, a pyramid for screen-space effects, and resolves of samples.
//!
//! | module | passes |
//! | --- | --- |
//! | [`prepass`] | depth before color, in the color pass's samples |
//! | [`structure`] | depth without samples, with a pyramid of coarser levels |
//! | [`resolve`] | one depth a pixel from multisampled depth |

pub mod prepass;
pub mod resolve;
pub mod structure;
