//! Features: what is compiled into a shader or left out.
//!
//! A feature changes the *interface* of a shader: which resources it binds; or, for one of them,
//! the type of number that shading computes in. Settings that change only arithmetic are WGSL
//! `override` constants, set when the pipeline is made, so that one resolved text serves them all.

/// One compile-time switch, tested in WGSL by `@if(NAME)`. Those of this crate are constants; another crate makes its own
/// and lists them in [`Module::features`](crate::Module::features).
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Feature(&'static str);

impl Feature {
    /// Shadow maps of depth are read through a tent.
    pub const SHADOWS: Self = Self("SHADOWS");
    /// Shadow maps of depth are read with penumbrae.
    pub const SHADOW_SOFT: Self = Self("SHADOW_SOFT");
    /// Shadow maps of moments of warped depth are read.
    pub const SHADOW_MOMENTS: Self = Self("SHADOW_MOMENTS");
    /// The sun's shadows are completed by a short ray through the structure of the scene.
    pub const CONTACT_SHADOWS: Self = Self("CONTACT_SHADOWS");
    /// A picture of ambient occlusion is read, a texel a pixel.
    pub const AMBIENT_OCCLUSION: Self = Self("AMBIENT_OCCLUSION");
    /// A picture of ambient occlusion is read that is smaller than what is shaded, and the structure of the scene with it.
    pub const OCCLUSION_UPSAMPLED: Self = Self("OCCLUSION_UPSAMPLED");
    /// Punctual lights are found by lists for parts of what is seen; without it every light is looked at everywhere.
    pub const FROXELS: Self = Self("FROXELS");
    /// What rays found in the picture is reflected before the environment is.
    pub const REFLECTIONS: Self = Self("REFLECTIONS");
    /// What is seen through fog.
    pub const FOG: Self = Self("FOG");
    /// The sun's disc and its halo are drawn over the background.
    pub const SUN_HALO: Self = Self("SUN_HALO");
    /// Where what moves was in the frame before is read.
    pub const VELOCITY: Self = Self("VELOCITY");
    /// The environment's prefiltered specular cube is read; without it lobes see three bands of spherical harmonics.
    pub const ENVIRONMENT_MAP: Self = Self("ENVIRONMENT_MAP");
    /// Clear coat (KHR_materials_clearcoat).
    pub const CLEAR_COAT: Self = Self("CLEAR_COAT");
    /// Sheen (KHR_materials_sheen).
    pub const SHEEN: Self = Self("SHEEN");
    /// Anisotropic specular reflection (KHR_materials_anisotropy).
    pub const ANISOTROPY: Self = Self("ANISOTROPY");
    /// Transmission through the surface (KHR_materials_transmission and KHR_materials_volume).
    pub const TRANSMISSION: Self = Self("TRANSMISSION");
    /// Strength and tint of the dielectric specular reflection (KHR_materials_specular).
    pub const SPECULAR: Self = Self("SPECULAR");
    /// Thin film over the base (KHR_materials_iridescence).
    pub const IRIDESCENCE: Self = Self("IRIDESCENCE");
    /// Refraction that differs by color (KHR_materials_dispersion); read with `TRANSMISSION`.
    pub const DISPERSION: Self = Self("DISPERSION");
    /// Diffuse transmission (KHR_materials_diffuse_transmission and KHR_materials_volume).
    pub const DIFFUSE_TRANSMISSION: Self = Self("DIFFUSE_TRANSMISSION");
    /// Light that is scattered below the surface, as Filament's shading model `subsurface` has it.
    pub const SUBSURFACE: Self = Self("SUBSURFACE");
    /// Diffuse light that is wrapped and tinted, as Filament's shading model `cloth` has it.
    pub const CLOTH_SUBSURFACE: Self = Self("CLOTH_SUBSURFACE");
    /// The material has a texture: its coordinates come with the vertices.
    pub const TEXTURED: Self = Self("TEXTURED");
    /// The mesh has colors at its vertices.
    pub const VERTEX_COLORS: Self = Self("VERTEX_COLORS");
    /// Materials are elements of one array, each surface's by the number that its instance has; without it each is bound alone.
    pub const MATERIAL_TABLE: Self = Self("MATERIAL_TABLE");
    /// What a vertex has to know of its object comes in the stream of instances; without it the object's number does.
    pub const INSTANCE_STREAM: Self = Self("INSTANCE_STREAM");
    /// Shading computes in f16 where that is safe; the device must have `SHADER_F16`.
    pub const HALF: Self = Self("HALF");

    /// The features that materials call for. Each binds textures of its own, but for
    /// `DISPERSION`, `SUBSURFACE` and `CLOTH_SUBSURFACE`.
    pub const LOBES: &[Self] = &[
        Self::CLEAR_COAT,
        Self::SHEEN,
        Self::ANISOTROPY,
        Self::TRANSMISSION,
        Self::SPECULAR,
        Self::IRIDESCENCE,
        Self::DISPERSION,
        Self::DIFFUSE_TRANSMISSION,
        Self::SUBSURFACE,
        Self::CLOTH_SUBSURFACE,
    ];
    /// The features that the embedded files test and materials do not call for.
    pub const OTHERS: &[Self] = &[
        Self::SHADOWS,
        Self::SHADOW_SOFT,
        Self::SHADOW_MOMENTS,
        Self::CONTACT_SHADOWS,
        Self::AMBIENT_OCCLUSION,
        Self::OCCLUSION_UPSAMPLED,
        Self::FROXELS,
        Self::REFLECTIONS,
        Self::FOG,
        Self::SUN_HALO,
        Self::VELOCITY,
        Self::ENVIRONMENT_MAP,
        Self::TEXTURED,
        Self::VERTEX_COLORS,
        Self::MATERIAL_TABLE,
        Self::INSTANCE_STREAM,
        Self::HALF,
    ];

    /// The feature tested as `@if(name)`.
    pub const fn new(name: &'static str) -> Self {
        Self(name)
    }

    /// The name tested in WGSL.
    pub const fn name(self) -> &'static str {
        self.0
    }

    /// All features that the embedded files test.
    pub fn all() -> impl Iterator<Item = Self> + Clone {
        Self::OTHERS.iter().chain(Self::LOBES).copied()
    }
}

/// A set of features.
#[derive(Clone, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Features(Vec<Feature>);

impl Features {
    /// Nothing switched on.
    pub const NONE: Self = Self(Vec::new());

    /// The set with `feature` added.
    #[must_use]
    pub fn with(mut self, feature: Feature) -> Self {
        if let Err(at) = self.0.binary_search(&feature) {
            self.0.insert(at, feature);
        }
        self
    }

    /// The set with `feature` added if `on`.
    #[must_use]
    pub fn with_if(self, feature: Feature, on: bool) -> Self {
        if on { self.with(feature) } else { self }
    }

    /// Whether nothing is switched on.
    pub const fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Whether `feature` is in the set.
    pub fn contains(&self, feature: Feature) -> bool {
        self.0.binary_search(&feature).is_ok()
    }

    /// The members, by name.
    pub fn iter(&self) -> impl Iterator<Item = Feature> {
        self.0.iter().copied()
    }
}

impl FromIterator<Feature> for Features {
    fn from_iter<I: IntoIterator<Item = Feature>>(features: I) -> Self {
        features.into_iter().fold(Self::NONE, Self::with)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_set_holds_what_was_put_in() {
        let set = Features::NONE.with(Feature::SHADOWS).with_if(Feature::HALF, false).with(Feature::ANISOTROPY);
        assert!(set.contains(Feature::new("SHADOWS")) && !set.contains(Feature::HALF) && !set.is_empty());
        assert_eq!(set.iter().collect::<Vec<_>>(), [Feature::ANISOTROPY, Feature::SHADOWS]);
        assert_eq!(set.clone().with(Feature::SHADOWS), set);
        assert_eq!([Feature::SHADOWS, Feature::ANISOTROPY].into_iter().collect::<Features>(), set);
    }
}
