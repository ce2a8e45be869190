//! Effects of the standard frame: a folder or file each, with its passes, its settings and what they need.
//!
//! | module | effect |
//! | --- | --- |
//! | [`shadow`] | shadow maps: drawing, filtering and keeping them |
//! | [`depth`] | depth prepass, depth pyramid of the visible structure, resolve of multisampled depth |
//! | [`occlusion`] | ambient occlusion (SAO, GTAO) and its blur |
//! | [`reflection`] | screen-space reflections |
//! | [`color`] | shaded opaque and blended surfaces, and the background |
//! | [`transparency`] | blended surfaces in any order: weighted, by moments, peeled |
//! | [`transmission`] | refractive surfaces and the picture behind them |
//! | [`fog`] | height fog and its in-scattering |
//! | [`taa`] | temporal anti-aliasing and motion vectors |
//! | [`exposure`] | measured luminance and distance, for automatic exposure and focus |
//! | [`dof`] | depth of field |
//! | [`bloom`] | bloom and lens flare |
//! | [`post`] | color grading, tone mapping, vignette and encoding, fused into one pass |
//! | [`fxaa`] | fast approximate anti-aliasing |
//! | [`upscale`] | upscaling and sharpening |
//! | [`picking`] | the object at a pixel |
//!
//! An effect may use [`gpu_scene`](crate::gpu_scene), [`light`](crate::light), [`program`](crate::program),
//! [`stages`](mod@crate::stages) and other effects above it in the frame. It never uses [`frame`](crate::frame), which composes the effects.

pub mod bloom;
pub mod color;
pub mod depth;
pub mod dof;
pub mod exposure;
pub mod fog;
pub mod fxaa;
pub mod occlusion;
pub mod picking;
pub mod post;
pub mod reflection;
pub mod shadow;
pub mod taa;
pub mod transmission;
pub mod transparency;
pub mod upscale;
