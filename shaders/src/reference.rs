//! Mirrors of the functions of `wgsl/lib/` in f64, under the same file and function names.
//!
//! A mirror is the reference for the shader's accuracy. It omits tricks that only f32 needs, and keeps clamps that are
//! part of the function. Each file tests known values and invariants of its functions. [`cases`] lists every function
//! with its domain and error bound as data, so one generic test can compare all of them on a device.
//!
//! Some files also contain values that the CPU computes once per frame or scene and the shader only reads
//! ([`dfg::dfg_table`], [`sh::project_irradiance_sh`], [`sky::Preetham`]).

pub mod aces;
pub mod agx;
pub mod anisotropy;
pub mod bilateral;
pub mod bloom;
pub mod cases;
pub mod clear_coat;
pub mod cloth;
pub mod cone_trace;
pub mod contact_shadow;
pub mod cube;
pub mod depth_normal;
pub mod depth_pyramid;
pub mod dfg;
pub mod dfg_integration;
pub mod diffuse;
pub mod display_range;
pub mod dither;
pub mod dof;
pub mod environment;
pub mod flare;
pub mod fog;
pub mod fresnel;
pub mod froxel;
pub mod fullscreen;
pub mod fxaa;
pub mod gamut;
pub mod ggx;
pub mod grade;
pub mod grading;
pub mod gt7;
pub mod gtao;
pub mod image_light;
pub mod luminance;
pub mod math;
pub mod metal_rough;
pub mod micro_shadow;
pub mod moment_transparency;
pub mod night;
pub mod normal_map;
pub mod numerics;
pub mod occlusion;
pub mod primaries;
pub mod punctual;
pub mod quantize;
pub mod real;
pub mod refraction;
pub mod rgbm;
pub mod sampling;
pub mod sao;
pub mod screen_ray;
pub mod sh;
pub mod shadow;
pub mod shadow_moments;
pub mod sharpen;
pub mod sky;
pub mod specular_aa;
pub mod srgb;
pub mod standard_surface;
pub mod subsurface;
pub mod taa;
pub mod table;
pub mod thin_film;
pub mod tone_map;
pub mod unproject;
pub mod upscale;
pub mod uv_transform;
pub mod vignette;
pub mod weighted_blending;
