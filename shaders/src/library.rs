//! The embedded sources and the passes among them.
//!
//! The sources are part of the program, so nothing is read from disk at run time. A test
//! compares this table with the folder, so a file that is not listed cannot be forgotten.

use crate::Feature;

/// One embedded file.
#[derive(Clone, Copy, Debug)]
pub struct Source {
    /// Path relative to `wgsl/`, with slashes.
    pub path: &'static str,
    /// The text: WGSL with `import` statements and `@if` attributes (WESL).
    pub text: &'static str,
}

const fn source(path: &'static str, text: &'static str) -> Source {
    Source { path, text }
}

/// All embedded files, sorted by path.
pub const SOURCES: &[Source] = &[
    source("effect/encode.wgsl", include_str!("../wgsl/effect/encode.wgsl")),
    source("effect/expose.wgsl", include_str!("../wgsl/effect/expose.wgsl")),
    source("effect/grade.wgsl", include_str!("../wgsl/effect/grade.wgsl")),
    source("effect/store_rg11b10ufloat.wgsl", include_str!("../wgsl/effect/store_rg11b10ufloat.wgsl")),
    source("effect/store_rgba16float.wgsl", include_str!("../wgsl/effect/store_rgba16float.wgsl")),
    source("effect/tone.wgsl", include_str!("../wgsl/effect/tone.wgsl")),
    source("effect/vignette.wgsl", include_str!("../wgsl/effect/vignette.wgsl")),
    source("interface/epilogue.wgsl", include_str!("../wgsl/interface/epilogue.wgsl")),
    source("interface/frame.wgsl", include_str!("../wgsl/interface/frame.wgsl")),
    source("interface/material.wgsl", include_str!("../wgsl/interface/material.wgsl")),
    source("interface/object.wgsl", include_str!("../wgsl/interface/object.wgsl")),
    source("interface/scene.wgsl", include_str!("../wgsl/interface/scene.wgsl")),
    source("lib/anisotropy.wgsl", include_str!("../wgsl/lib/anisotropy.wgsl")),
    source("lib/clear_coat.wgsl", include_str!("../wgsl/lib/clear_coat.wgsl")),
    source("lib/cloth.wgsl", include_str!("../wgsl/lib/cloth.wgsl")),
    source("lib/cube.wgsl", include_str!("../wgsl/lib/cube.wgsl")),
    source("lib/dfg.wgsl", include_str!("../wgsl/lib/dfg.wgsl")),
    source("lib/dfg_integration.wgsl", include_str!("../wgsl/lib/dfg_integration.wgsl")),
    source("lib/diffuse.wgsl", include_str!("../wgsl/lib/diffuse.wgsl")),
    source("lib/dither.wgsl", include_str!("../wgsl/lib/dither.wgsl")),
    source("lib/environment.wgsl", include_str!("../wgsl/lib/environment.wgsl")),
    source("lib/exposure.wgsl", include_str!("../wgsl/lib/exposure.wgsl")),
    source("lib/fresnel.wgsl", include_str!("../wgsl/lib/fresnel.wgsl")),
    source("lib/fullscreen.wgsl", include_str!("../wgsl/lib/fullscreen.wgsl")),
    source("lib/fxaa.wgsl", include_str!("../wgsl/lib/fxaa.wgsl")),
    source("lib/ggx.wgsl", include_str!("../wgsl/lib/ggx.wgsl")),
    source("lib/grading.wgsl", include_str!("../wgsl/lib/grading.wgsl")),
    source("lib/image_light.wgsl", include_str!("../wgsl/lib/image_light.wgsl")),
    source("lib/luminance.wgsl", include_str!("../wgsl/lib/luminance.wgsl")),
    source("lib/math.wgsl", include_str!("../wgsl/lib/math.wgsl")),
    source("lib/metal_rough.wgsl", include_str!("../wgsl/lib/metal_rough.wgsl")),
    source("lib/normal_map.wgsl", include_str!("../wgsl/lib/normal_map.wgsl")),
    source("lib/numerics.wgsl", include_str!("../wgsl/lib/numerics.wgsl")),
    source("lib/occlusion.wgsl", include_str!("../wgsl/lib/occlusion.wgsl")),
    source("lib/punctual.wgsl", include_str!("../wgsl/lib/punctual.wgsl")),
    source("lib/quantize.wgsl", include_str!("../wgsl/lib/quantize.wgsl")),
    source("lib/real.wgsl", include_str!("../wgsl/lib/real.wgsl")),
    source("lib/refraction.wgsl", include_str!("../wgsl/lib/refraction.wgsl")),
    source("lib/sampling.wgsl", include_str!("../wgsl/lib/sampling.wgsl")),
    source("lib/sh.wgsl", include_str!("../wgsl/lib/sh.wgsl")),
    source("lib/shadow.wgsl", include_str!("../wgsl/lib/shadow.wgsl")),
    source("lib/sky.wgsl", include_str!("../wgsl/lib/sky.wgsl")),
    source("lib/specular_aa.wgsl", include_str!("../wgsl/lib/specular_aa.wgsl")),
    source("lib/srgb.wgsl", include_str!("../wgsl/lib/srgb.wgsl")),
    source("lib/standard_surface.wgsl", include_str!("../wgsl/lib/standard_surface.wgsl")),
    source("lib/tone_map.wgsl", include_str!("../wgsl/lib/tone_map.wgsl")),
    source("lib/uv_transform.wgsl", include_str!("../wgsl/lib/uv_transform.wgsl")),
    source("lib/vignette.wgsl", include_str!("../wgsl/lib/vignette.wgsl")),
    source("pass/color.wgsl", include_str!("../wgsl/pass/color.wgsl")),
    source("pass/copy.wgsl", include_str!("../wgsl/pass/copy.wgsl")),
    source("pass/dfg.wgsl", include_str!("../wgsl/pass/dfg.wgsl")),
    source("pass/fxaa.wgsl", include_str!("../wgsl/pass/fxaa.wgsl")),
    source("pass/ibl.wgsl", include_str!("../wgsl/pass/ibl.wgsl")),
    source("pass/post.wgsl", include_str!("../wgsl/pass/post.wgsl")),
    source("pass/prepass.wgsl", include_str!("../wgsl/pass/prepass.wgsl")),
    source("pass/scene.wgsl", include_str!("../wgsl/pass/scene.wgsl")),
    source("pass/shadow.wgsl", include_str!("../wgsl/pass/shadow.wgsl")),
    source("pass/sky.wgsl", include_str!("../wgsl/pass/sky.wgsl")),
    source("shading/ambient.wgsl", include_str!("../wgsl/shading/ambient.wgsl")),
    source("shading/direct.wgsl", include_str!("../wgsl/shading/direct.wgsl")),
    source("shading/indirect.wgsl", include_str!("../wgsl/shading/indirect.wgsl")),
    source("shading/quality.wgsl", include_str!("../wgsl/shading/quality.wgsl")),
    source("shading/surface.wgsl", include_str!("../wgsl/shading/surface.wgsl")),
];

/// The text of an embedded file, by its path relative to `wgsl/`.
pub fn text(path: &str) -> Option<&'static str> {
    let at = SOURCES.binary_search_by_key(&path, |source| source.path);
    at.ok().map(|i| SOURCES[i].text)
}

/// An embedded pass: a file of `wgsl/pass/`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum ShaderId {
    /// Depth from a light: `vs_opaque`; `vs_mask` with `fs_mask`.
    Shadow,
    /// Depth from the camera: `vs_opaque`; `vs_mask` with `fs_mask`.
    Prepass,
    /// Lit surfaces: `vs_main` with `fs_main`.
    Color,
    /// What lies behind transmissive surfaces: `vs_main` with `fs_copy`, `fs_copy_samples` or `fs_level`.
    Scene,
    /// Background: `vs_main` with `fs_environment`, `fs_procedural`, `fs_constant` or `fs_black`.
    Sky,
    /// Point-wise effects over the whole screen: `vs_main` with `fs_main`.
    Post,
    /// Edge filter: `vs_main` with `fs_main`.
    Fxaa,
    /// Copy and rescale: `vs_main` with `fs_copy` or `fs_blit`.
    Copy,
    /// Prefiltered environment, made at load: `vs_main` with `fs_cube`, `fs_mip` or `fs_prefilter`.
    Ibl,
    /// Directional albedo of the lobes, made at load: `vs_main` with `fs_main`.
    Dfg,
}

impl ShaderId {
    /// All passes: those of the frame in its order, then those that make what it reads.
    pub const ALL: [Self; 10] = [
        Self::Shadow,
        Self::Prepass,
        Self::Color,
        Self::Scene,
        Self::Sky,
        Self::Post,
        Self::Fxaa,
        Self::Copy,
        Self::Ibl,
        Self::Dfg,
    ];

    /// Name of the file in `wgsl/pass/`, without its ending.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Shadow => "shadow",
            Self::Prepass => "prepass",
            Self::Color => "color",
            Self::Scene => "scene",
            Self::Sky => "sky",
            Self::Post => "post",
            Self::Fxaa => "fxaa",
            Self::Copy => "copy",
            Self::Ibl => "ibl",
            Self::Dfg => "dfg",
        }
    }

    /// Path relative to `wgsl/`.
    pub fn path(self) -> String {
        format!("pass/{}.wgsl", self.name())
    }

    /// The features that make a difference to this pass; any other is ignored by it.
    pub const fn features(self) -> &'static [Feature] {
        match self {
            Self::Color => &Feature::ALL,
            _ => &[],
        }
    }

    /// Whether the pass ends with the socket for effects, see [`resolve_with`](crate::resolve_with).
    pub const fn takes_effects(self) -> bool {
        matches!(self, Self::Color | Self::Sky | Self::Post)
    }
}
