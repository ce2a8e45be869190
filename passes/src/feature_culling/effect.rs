//! Effects that a scene may not need, and sets of them.

/// An effect, or an approximation of the frame, that feature culling can drop.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[repr(u8)]
pub enum Effect {
    /// Shadow maps of the sun.
    SunShadows,
    /// Shadow maps of spot and point lights.
    LampShadows,
    /// Shadow cascades beyond the first.
    Cascades,
    /// Contact shadows: screen-space rays that complete the shadow maps of the sun.
    ContactShadows,
    /// Screen-space ambient occlusion.
    Occlusion,
    /// Screen-space reflections.
    Reflections,
    /// The picture behind refractive surfaces, and the pass that draws them over it.
    Transmission,
    /// Refractive surfaces seen through other refractive surfaces.
    GlassLayers,
    /// Blended surfaces; they prevent inlining post-processing into the color pass.
    Blending,
    /// Energy compensation for multiple scattering in rough surfaces.
    EnergyCompensation,
    /// Specular anti-aliasing: roughness is widened by the variation of normals within a pixel.
    SpecularAa,
    /// Irradiance harmonics beyond the second band.
    ShBands,
    /// Multi-bounce and specular ambient occlusion.
    OcclusionShading,
    /// Occlusion of the sun by the material's ambient occlusion.
    MicroShadows,
    /// The background.
    Sky,
    /// Vignette.
    Vignette,
    /// Fade to a color toward the edges.
    EdgeFade,
    /// Color grading.
    Grading,
    /// Dither, which hides the steps of eight bits.
    Dither,
    /// Half-float target between shading and post-processing.
    HdrTarget,
    /// FXAA.
    Fxaa,
    /// Multisampling.
    Msaa,
    /// Temporal anti-aliasing.
    Taa,
    /// Fog.
    Fog,
    /// Depth of field.
    DepthOfField,
    /// Bloom.
    Bloom,
    /// Depth prepass.
    Prepass,
}

impl Effect {
    /// All effects, in order.
    pub const ALL: [Self; 27] = [
        Self::SunShadows,
        Self::LampShadows,
        Self::Cascades,
        Self::ContactShadows,
        Self::Occlusion,
        Self::Reflections,
        Self::Transmission,
        Self::GlassLayers,
        Self::Blending,
        Self::EnergyCompensation,
        Self::SpecularAa,
        Self::ShBands,
        Self::OcclusionShading,
        Self::MicroShadows,
        Self::Sky,
        Self::Vignette,
        Self::EdgeFade,
        Self::Grading,
        Self::Dither,
        Self::HdrTarget,
        Self::Fxaa,
        Self::Msaa,
        Self::Taa,
        Self::Fog,
        Self::DepthOfField,
        Self::Bloom,
        Self::Prepass,
    ];

    /// Returns the name used in options.
    pub const fn name(self) -> &'static str {
        match self {
            Self::SunShadows => "sun-shadows",
            Self::LampShadows => "punctual-shadows",
            Self::Cascades => "cascades",
            Self::ContactShadows => "contact-shadows",
            Self::Occlusion => "ao",
            Self::Reflections => "ssr",
            Self::Transmission => "transmission",
            Self::GlassLayers => "glass-layers",
            Self::Blending => "blending",
            Self::EnergyCompensation => "energy-compensation",
            Self::SpecularAa => "specular-aa",
            Self::ShBands => "sh-bands",
            Self::OcclusionShading => "occlusion-shading",
            Self::MicroShadows => "micro-shadows",
            Self::Sky => "sky",
            Self::Vignette => "vignette",
            Self::EdgeFade => "edge-fade",
            Self::Grading => "grading",
            Self::Dither => "dither",
            Self::HdrTarget => "hdr-target",
            Self::Fxaa => "fxaa",
            Self::Msaa => "msaa",
            Self::Taa => "taa",
            Self::Fog => "fog",
            Self::DepthOfField => "dof",
            Self::Bloom => "bloom",
            Self::Prepass => "prepass",
        }
    }

    /// Returns the effect with this name.
    pub fn from_name(name: &str) -> Option<Self> {
        // The former name remains valid.
        let name = if name == "lamp-shadows" { "punctual-shadows" } else { name };
        Self::ALL.into_iter().find(|effect| effect.name() == name)
    }
}

/// A set of effects.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct EffectSet(u32);

impl EffectSet {
    /// The empty set.
    pub const NONE: Self = Self(0);
    /// The set of all effects.
    pub const ALL: Self = Self((1 << Effect::ALL.len()) - 1);

    /// Returns the set with `effect` added.
    #[must_use]
    pub const fn with(self, effect: Effect) -> Self {
        Self(self.0 | 1 << effect as u8)
    }

    /// Returns the set with `effect` removed.
    #[must_use]
    pub const fn without(self, effect: Effect) -> Self {
        Self(self.0 & !(1 << effect as u8))
    }

    /// Returns the intersection of both sets.
    #[must_use]
    pub const fn and(self, other: Self) -> Self {
        Self(self.0 & other.0)
    }

    /// Returns whether the set contains `effect`.
    pub const fn contains(self, effect: Effect) -> bool {
        self.0 & 1 << effect as u8 != 0
    }

    /// Returns the effects of the set, in order.
    pub fn iter(self) -> impl Iterator<Item = Effect> {
        Effect::ALL.into_iter().filter(move |effect| self.contains(*effect))
    }
}

impl FromIterator<Effect> for EffectSet {
    fn from_iter<I: IntoIterator<Item = Effect>>(effects: I) -> Self {
        effects.into_iter().fold(Self::NONE, Self::with)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_found_again_and_sets_hold_what_they_were_given() {
        for (number, effect) in Effect::ALL.into_iter().enumerate() {
            assert_eq!((effect as usize, Effect::from_name(effect.name())), (number, Some(effect)));
            assert_eq!(EffectSet::NONE.with(effect).iter().collect::<Vec<_>>(), [effect]);
            assert!(EffectSet::ALL.contains(effect) && !EffectSet::ALL.without(effect).contains(effect));
        }
        assert_eq!(Effect::from_name("shadow"), None);
        assert_eq!(Effect::from_name("lamp-shadows"), Some(Effect::LampShadows));
        assert_eq!(Effect::ALL.into_iter().collect::<EffectSet>(), EffectSet::ALL);
    }
}
