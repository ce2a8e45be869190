// Memory layout of a material's factors: the base's and those of its lobes.

/// Placement of a texture on the mesh (KHR_texture_transform).
/// Mirrored by `layout::TextureMap`.
struct TextureMap {
    /// Columns of the 2×2 matrix rotation · scale.
    x_axis: vec2<f32>,
    y_axis: vec2<f32>,
    offset: vec2<f32>,
    /// Texture coordinate set of the mesh: 0 or 1.
    uv_set: u32,
}

/// Clear coat (KHR_materials_clearcoat). Mirrored by `layout::ClearCoatUniforms`.
struct ClearCoatUniforms {
    /// Coverage of the surface by the coat, 0…1.
    factor: f32,
    /// Perceptual roughness of the coat, 0…1.
    roughness: f32,
    /// Factor on x and y of the coat's normal map.
    normal_scale: f32,
    map: TextureMap,
    roughness_map: TextureMap,
    normal_map: TextureMap,
}

/// Sheen (KHR_materials_sheen). Mirrored by `layout::SheenUniforms`.
struct SheenUniforms {
    /// Reflectance of the sheen lobe, linear Rec.709.
    color: vec3<f32>,
    /// Perceptual roughness, 0…1.
    roughness: f32,
    color_map: TextureMap,
    roughness_map: TextureMap,
}

/// Anisotropy (KHR_materials_anisotropy). Mirrored by `layout::AnisotropyUniforms`.
struct AnisotropyUniforms {
    /// Cosine and sine of the rotation from the tangent.
    rotation: vec2<f32>,
    /// Strength of the anisotropy, 0…1.
    strength: f32,
    map: TextureMap,
}

/// Transmission, volume and dispersion (KHR_materials_transmission, KHR_materials_volume,
/// KHR_materials_dispersion). Mirrored by `layout::TransmissionUniforms`.
struct TransmissionUniforms {
    /// Transmission: the share of the light entering the surface that passes through it, 0…1.
    factor: f32,
    /// Index of refraction, 1 or more.
    ior: f32,
    /// Thickness of the volume under the surface in units of the mesh; 0 is a thin wall.
    thickness: f32,
    /// Dispersion: 20 over the Abbe number, 0 or more.
    dispersion: f32,
    /// Absorption coefficient in 1/m, by channel.
    absorption: vec3<f32>,
    map: TextureMap,
    thickness_map: TextureMap,
}

/// Strength and tint of the dielectric specular reflection (KHR_materials_specular). Mirrored by
/// `layout::SpecularUniforms`.
struct SpecularUniforms {
    /// Factor on the reflectance at normal incidence, linear Rec.709.
    color: vec3<f32>,
    /// Factor on the reflectance at all angles, 0…1.
    factor: f32,
    map: TextureMap,
    color_map: TextureMap,
}

/// Thin film (KHR_materials_iridescence). Mirrored by `layout::IridescenceUniforms`.
struct IridescenceUniforms {
    /// Coverage of the surface by the film, 0…1.
    factor: f32,
    /// Index of refraction of the film, 1 or more.
    ior: f32,
    /// Film thickness in nm at texture value 0.
    min_thickness_nm: f32,
    /// Film thickness in nm at texture value 1, or without a texture.
    max_thickness_nm: f32,
    map: TextureMap,
    thickness_map: TextureMap,
}

/// Diffuse transmission (KHR_materials_diffuse_transmission). Mirrored by
/// `layout::DiffuseTransmissionUniforms`.
struct DiffuseTransmissionUniforms {
    /// Albedo of the light that leaves through the back, linear Rec.709.
    color: vec3<f32>,
    /// Share of the scattered light that leaves through the back, 0…1.
    factor: f32,
    map: TextureMap,
    color_map: TextureMap,
}

/// Subsurface scattering (Filament's shading models `subsurface` and `cloth`). Mirrored by
/// `layout::SubsurfaceUniforms`.
struct SubsurfaceUniforms {
    /// Color of the scattered light, linear Rec.709, 0…1.
    color: vec3<f32>,
    /// Exponent of the lobe toward lights behind the surface, 0 or more.
    power: f32,
    /// Subsurface color of cloth, linear Rec.709, 0…1.
    cloth_color: vec3<f32>,
    /// Thickness, from 0 for thin to 1 for opaque.
    thickness: f32,
}

/// Factors of a material. Mirrored by `layout::MaterialUniforms`.
struct MaterialUniforms {
    /// Linear Rec.709 and alpha (straight, not premultiplied).
    base_color: vec4<f32>,
    /// Emitted radiance, linear Rec.709, emissive strength included.
    emissive: vec3<f32>,
    /// 1: `emissive` is in nits and is multiplied by the exposure. 0: it is a display value, as in
    /// most assets.
    emissive_exposure_weight: f32,
    /// 0 dielectric … 1 metal.
    metallic: f32,
    /// Perceptual roughness, 0…1.
    roughness: f32,
    /// Factor on x and y of the normal map.
    normal_scale: f32,
    /// Strength of the occlusion texture, 0…1.
    occlusion_strength: f32,
    /// Alpha threshold of mode MASK: fragments with lower alpha are discarded.
    alpha_cutoff: f32,
    /// Reflectance of the dielectric part at normal incidence; 0.04 for an index of 1.5.
    dielectric_f0: f32,
    /// Strength of the shadow on a shadow catcher, 0…1.
    @size(8) catcher_strength: f32,
    base_color_map: TextureMap,
    metallic_roughness_map: TextureMap,
    normal_map: TextureMap,
    occlusion_map: TextureMap,
    emissive_map: TextureMap,
    clear_coat: ClearCoatUniforms,
    sheen: SheenUniforms,
    anisotropy: AnisotropyUniforms,
    transmission: TransmissionUniforms,
    specular: SpecularUniforms,
    iridescence: IridescenceUniforms,
    diffuse_transmission: DiffuseTransmissionUniforms,
    subsurface: SubsurfaceUniforms,
}
