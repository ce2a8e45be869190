//! Mirrors in f64 of the functions in `wgsl/lib/` of `framegraph-shaders`, under the same file and function names.
//!
//! A mirror is the reference for a shader function's accuracy, and is used in tests alone. It omits tricks that only f32
//! needs, and keeps clamps that are part of the function. Each file tests known values and invariants of its functions.
//! [`cases`] lists every function with its domain and error bound as data, so one generic test compares all of them on a
//! device.
//!
//! Mirrors that programs need at run time, such as tone curves and color grading, are part of `framegraph-shaders` and are
//! re-exported here.

pub mod anisotropy;
pub mod bilateral;
pub mod bloom;
pub mod cases;
pub mod clear_coat;
pub mod cone_trace;
pub mod contact_shadow;
pub mod cube;
pub mod depth_normal;
pub mod depth_pyramid;
pub mod diffuse;
pub mod dither;
pub mod dof;
pub mod environment;
pub mod flare;
pub mod fog;
pub mod fresnel;
pub mod froxel;
pub mod fullscreen;
pub mod fxaa;
pub mod gtao;
pub mod metal_rough;
pub mod micro_shadow;
pub mod moment_transparency;
pub mod normal_map;
pub mod numerics;
pub mod occlusion;
pub mod punctual;
pub mod quantize;
pub mod real;
pub mod refraction;
pub mod sao;
pub mod screen_ray;
pub mod sh;
pub mod shadow;
pub mod shadow_moments;
pub mod sharpen;
pub mod specular_aa;
pub mod standard_surface;
pub mod subsurface;
pub mod taa;
pub mod thin_film;
pub mod unproject;
pub mod upscale;
pub mod uv_transform;
pub mod vignette;
pub mod weighted_blending;

pub use framegraph_shaders::reference::{
    aces, agx, cloth, dfg, dfg_integration, display_range, gamut, ggx, grade, grading, gt7, image_light, luminance,
    math, night, primaries, rgbm, sampling, sky, srgb, table, tone_map,
};
