//! Features: compile-time switches of shaders.
//!
//! A feature changes the *interface* of a shader, that is, the resources it binds. One feature,
//! [`HALF`](Feature::HALF), changes the number type of shading instead. Settings that change only arithmetic are WGSL
//! `override` constants. They are set when the pipeline is created, so one resolved text serves all their values.

/// Compile-time switch, tested in WGSL by `@if(NAME)`. This crate's features are constants; another crate creates its
/// own and lists them in [`Module::features`](crate::Module::features).
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Feature(&'static str);

impl Feature {
    /// Reads depth shadow maps with a tent filter.
    pub const SHADOWS: Self = Self("SHADOWS");
    /// Reads depth shadow maps with soft penumbrae.
    pub const SHADOW_SOFT: Self = Self("SHADOW_SOFT");
    /// Reads shadow maps that store moments of warped depth.
    pub const SHADOW_MOMENTS: Self = Self("SHADOW_MOMENTS");
    /// Adds contact shadows of the sun: a short ray through the depth pyramid of visible surfaces.
    pub const CONTACT_SHADOWS: Self = Self("CONTACT_SHADOWS");
    /// Reads an ambient occlusion texture at full resolution.
    pub const AMBIENT_OCCLUSION: Self = Self("AMBIENT_OCCLUSION");
    /// Reads an ambient occlusion texture of lower resolution and upsamples it with the depth pyramid.
    pub const OCCLUSION_UPSAMPLED: Self = Self("OCCLUSION_UPSAMPLED");
    /// Looks up punctual lights in the lists of froxels. Without it, every fragment evaluates every light.
    pub const FROXELS: Self = Self("FROXELS");
    /// Reads the texture of screen-space reflections before the environment.
    pub const REFLECTIONS: Self = Self("REFLECTIONS");
    /// Applies fog to surfaces and background.
    pub const FOG: Self = Self("FOG");
    /// Draws the sun's disc and its halo over the background.
    pub const SUN_HALO: Self = Self("SUN_HALO");
    /// Reads the positions of moving objects in the previous frame.
    pub const VELOCITY: Self = Self("VELOCITY");
    /// Reads the environment's prefiltered specular cube. Without it, lobes use three bands of spherical harmonics.
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
    /// Wavelength-dependent refraction (KHR_materials_dispersion); used with `TRANSMISSION`.
    pub const DISPERSION: Self = Self("DISPERSION");
    /// Diffuse transmission (KHR_materials_diffuse_transmission and KHR_materials_volume).
    pub const DIFFUSE_TRANSMISSION: Self = Self("DIFFUSE_TRANSMISSION");
    /// Subsurface scattering, as in Filament's shading model `subsurface`.
    pub const SUBSURFACE: Self = Self("SUBSURFACE");
    /// Wrapped and tinted diffuse light, as in Filament's shading model `cloth`.
    pub const CLOTH_SUBSURFACE: Self = Self("CLOTH_SUBSURFACE");
    /// The material has a texture, so vertices provide texture coordinates.
    pub const TEXTURED: Self = Self("TEXTURED");
    /// The mesh has vertex colors.
    pub const VERTEX_COLORS: Self = Self("VERTEX_COLORS");
    /// Reads materials from one array, by the number that the instance provides. Without it, each material has its own
    /// bind group.
    pub const MATERIAL_TABLE: Self = Self("MATERIAL_TABLE");
    /// Reads the object's attributes from the instance stream. Without it, the stream holds only the object's number.
    pub const INSTANCE_STREAM: Self = Self("INSTANCE_STREAM");
    /// Draws two eyes at once: left and right are two layers of the attachments. Needs multiview, which core WebGPU lacks.
    pub const STEREO: Self = Self("STEREO");
    /// Computes shading in f16 where that is accurate enough; the device must have `SHADER_F16`.
    pub const HALF: Self = Self("HALF");

    /// Features that materials enable. Each binds its own textures, except `DISPERSION`, `SUBSURFACE` and
    /// `CLOTH_SUBSURFACE`.
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
    /// Features of the embedded files that do not depend on the material.
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

    /// Creates the feature that WGSL tests as `@if(name)`.
    pub const fn new(name: &'static str) -> Self {
        Self(name)
    }

    /// Returns the name tested in WGSL.
    pub const fn name(self) -> &'static str {
        self.0
    }

    /// Returns all features that the embedded files test, except [`STEREO`](Self::STEREO).
    pub fn all() -> impl Iterator<Item = Self> + Clone {
        Self::OTHERS.iter().chain(Self::LOBES).copied()
    }
}

/// Set of features.
#[derive(Clone, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Features(Vec<Feature>);

impl Features {
    /// The empty set.
    pub const NONE: Self = Self(Vec::new());

    /// Returns the set with `feature` added.
    #[must_use]
    pub fn with(mut self, feature: Feature) -> Self {
        if let Err(at) = self.0.binary_search(&feature) {
            self.0.insert(at, feature);
        }
        self
    }

    /// Returns the set with `feature` added if `on` is true.
    #[must_use]
    pub fn with_if(self, feature: Feature, on: bool) -> Self {
        if on { self.with(feature) } else { self }
    }

    /// Returns true if the set is empty.
    pub const fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Returns true if the set contains `feature`.
    pub fn contains(&self, feature: Feature) -> bool {
        self.0.binary_search(&feature).is_ok()
    }

    /// Returns the features of the set, sorted by name.
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
