//! The binding convention: which group holds what.
//!
//! Groups go from what changes least to what changes most. The bindings inside are declared
//! once, in `wgsl/interface/` and the passes, and read back by [`reflect`](crate::reflect):
//! a pipeline layout is [`Reflection::groups`](crate::Reflection::groups) of its entry
//! points, and a bind group fills its slots by name. The constants below are those names; a
//! test checks that the shaders know every one of them and no other.
//!
//! Depth-only pipelines for opaque geometry reach no material, so their group 1 is empty:
//! wgpu takes `None` there, and the group stays bound across a change of pipeline.

/// Group of what is the same all frame: uniforms, lights, shadow map, environment.
pub const GROUP_FRAME: u32 = 0;
/// Group of the material: factors, textures, samplers. The sky's coefficients lie here too,
/// the sky being what is drawn instead of materials.
pub const GROUP_MATERIAL: u32 = 1;
/// Group of the objects: one storage array, indexed by the instance index of the draw.
pub const GROUP_OBJECTS: u32 = 2;
/// Group of a post-processing pass: its uniforms and inputs.
pub const GROUP_POST: u32 = 0;
/// Group of what effects bind, in whatever pass they are: the same for the whole frame.
pub const GROUP_EFFECTS: u32 = 0;
/// First binding in [`GROUP_EFFECTS`] that no embedded shader uses.
pub const FREE_EFFECT_BINDING: u32 = 24;

/// What a slot is filled with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Resource {
    /// Uniform buffer holding the named struct of [`layout`](crate::layout).
    Uniform(&'static str),
    /// Read-only storage buffer holding an array of the named struct.
    Storage(&'static str),
    /// Texture; what for.
    Texture(&'static str),
    /// Sampler.
    Sampler(Sampling),
}

/// How a sampler must be set up.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sampling {
    /// As the glTF texture says.
    Material,
    /// Linear, clamp to edge.
    LinearClamp,
    /// Trilinear, clamp to edge: a cube map.
    TrilinearClamp,
    /// Trilinear, repeat in u, clamp in v: an equirectangular panorama.
    Panorama,
    /// Linear, clamp to edge, compare GreaterEqual: a reversed-Z shadow map.
    ShadowCompare,
}

/// A slot of the convention.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Convention {
    /// Name of the variable in WGSL; unique over all passes.
    pub name: &'static str,
    /// What to fill it with.
    pub resource: Resource,
}

const fn slot(name: &'static str, resource: Resource) -> Convention {
    Convention { name, resource }
}

/// Every slot of every pass.
pub const CONVENTIONS: &[Convention] = &[
    slot("frame", Resource::Uniform("FrameUniforms")),
    slot("lights", Resource::Storage("LightUniforms")),
    slot("shadow_map", Resource::Texture("depth of the sun's view, reversed-Z")),
    slot("shadow_sampler", Resource::Sampler(Sampling::ShadowCompare)),
    slot("environment_map", Resource::Texture("equirectangular radiance")),
    slot("environment_sampler", Resource::Sampler(Sampling::Panorama)),
    slot("dfg_table", Resource::Texture("directional albedos over (n·v, roughness), RGBA16F")),
    slot("light_sampler", Resource::Sampler(Sampling::TrilinearClamp)),
    slot("specular_map", Resource::Texture("cube of prefiltered radiance, a roughness a level")),
    slot("material", Resource::Uniform("MaterialUniforms")),
    slot("base_color_texture", Resource::Texture("sRGB color and alpha")),
    slot("metallic_roughness_texture", Resource::Texture("roughness in g, metalness in b")),
    slot("normal_texture", Resource::Texture("tangent-space normal")),
    slot("occlusion_texture", Resource::Texture("occlusion in r")),
    slot("emissive_texture", Resource::Texture("sRGB color")),
    slot("clear_coat_texture", Resource::Texture("coating in r")),
    slot("clear_coat_roughness_texture", Resource::Texture("roughness of the coat in g")),
    slot("clear_coat_normal_texture", Resource::Texture("tangent-space normal of the coat")),
    slot("sheen_color_texture", Resource::Texture("sRGB color")),
    slot("sheen_roughness_texture", Resource::Texture("roughness of the fibers in a")),
    slot("anisotropy_texture", Resource::Texture("direction in rg, strength in b")),
    slot("transmission_texture", Resource::Texture("transmitted share in r")),
    slot("thickness_texture", Resource::Texture("thickness in g")),
    slot("specular_texture", Resource::Texture("factor in a")),
    slot("specular_color_texture", Resource::Texture("sRGB color")),
    slot("base_color_sampler", Resource::Sampler(Sampling::Material)),
    slot("metallic_roughness_sampler", Resource::Sampler(Sampling::Material)),
    slot("normal_sampler", Resource::Sampler(Sampling::Material)),
    slot("occlusion_sampler", Resource::Sampler(Sampling::Material)),
    slot("emissive_sampler", Resource::Sampler(Sampling::Material)),
    slot("clear_coat_sampler", Resource::Sampler(Sampling::Material)),
    slot("clear_coat_roughness_sampler", Resource::Sampler(Sampling::Material)),
    slot("clear_coat_normal_sampler", Resource::Sampler(Sampling::Material)),
    slot("sheen_color_sampler", Resource::Sampler(Sampling::Material)),
    slot("sheen_roughness_sampler", Resource::Sampler(Sampling::Material)),
    slot("anisotropy_sampler", Resource::Sampler(Sampling::Material)),
    slot("transmission_sampler", Resource::Sampler(Sampling::Material)),
    slot("thickness_sampler", Resource::Sampler(Sampling::Material)),
    slot("specular_sampler", Resource::Sampler(Sampling::Material)),
    slot("specular_color_sampler", Resource::Sampler(Sampling::Material)),
    slot("scene_levels", Resource::Texture("pre-exposed linear color, distance in a, all levels")),
    slot("scene_sampler", Resource::Sampler(Sampling::TrilinearClamp)),
    slot("scene_depth", Resource::Texture("depth of opaque surfaces, one sample")),
    slot("scene_depth_samples", Resource::Texture("depth of opaque surfaces, several samples")),
    slot("objects", Resource::Storage("ObjectUniforms")),
    slot("shadow_view", Resource::Uniform("ShadowViewUniforms")),
    slot("sky", Resource::Uniform("SkyUniforms")),
    slot("exposing", Resource::Uniform("ExposureUniforms")),
    slot("grading", Resource::Uniform("GradingUniforms")),
    slot("vignetting", Resource::Uniform("VignetteUniforms")),
    slot("encoding", Resource::Uniform("EncodingUniforms")),
    slot("hdr", Resource::Texture("pre-exposed linear color")),
    slot("fxaa", Resource::Uniform("FxaaUniforms")),
    slot("ldr", Resource::Texture("encoded color, luma in alpha")),
    slot("ldr_sampler", Resource::Sampler(Sampling::LinearClamp)),
    slot("source", Resource::Texture("what is copied")),
    slot("source_sampler", Resource::Sampler(Sampling::LinearClamp)),
    slot("ibl", Resource::Uniform("IblUniforms")),
    slot("ibl_kernel", Resource::Uniform("IblKernelUniforms")),
    slot("panorama", Resource::Texture("equirectangular radiance, 32-bit floats, one level")),
    slot("cube", Resource::Texture("radiance cube, all levels or one")),
    slot("cube_sampler", Resource::Sampler(Sampling::TrilinearClamp)),
];

/// The convention of a variable's name.
pub fn convention(name: &str) -> Option<&'static Convention> {
    CONVENTIONS.iter().find(|convention| convention.name == name)
}
