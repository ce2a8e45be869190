//! The effects of the frame that a scene may not call for, and sets of them.

/// An effect, or a liberty that the frame takes, that facts about a scene can leave out.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[repr(u8)]
pub enum Effect {
    /// Shadow maps of the sun.
    SunShadows,
    /// Shadow maps of spot and point lights.
    LampShadows,
    /// More than one map of the sun.
    Cascades,
    /// Rays through the picture's depth that complete the sun's maps.
    ContactShadows,
    /// Ambient occlusion from what the picture shows.
    Occlusion,
    /// Reflections of what the picture shows.
    Reflections,
    /// The picture of what is behind glass, and the pass that draws glass over it.
    Transmission,
    /// Glass that is seen through glass.
    GlassLayers,
    /// Surfaces that blend; they keep post-processing out of the color pass.
    Blending,
    /// Light that is scattered more than once within a rough surface.
    EnergyCompensation,
    /// Roughness widened by how much normals turn within a pixel.
    SpecularAa,
    /// Bands of irradiance beyond the second.
    ShBands,
    /// What ambient occlusion does to bounces and reflections.
    OcclusionShading,
    /// The sun occluded by the material's ambient occlusion.
    MicroShadows,
    /// What stands behind everything.
    Sky,
    /// Darker corners.
    Vignette,
    /// A color toward the edges.
    EdgeFade,
    /// White balance, contrast and what else changes colors.
    Grading,
    /// Noise that hides the steps of eight bits.
    Dither,
    /// A target of half floats between shading and post-processing.
    HdrTarget,
    /// Edges of the finished picture softened.
    Fxaa,
    /// More than one sample a texel.
    Msaa,
    /// Frames added up over time.
    Taa,
    /// Air that hides what is far away.
    Fog,
    /// What is out of focus is blurred.
    DepthOfField,
    /// What is bright glows.
    Bloom,
    /// Depth drawn before surfaces are shaded.
    Prepass,
}

impl Effect {
    /// All of them, in their order.
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

    /// As it is asked for.
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

    /// The effect of that name.
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
    /// None of them.
    pub const NONE: Self = Self(0);
    /// All of them.
    pub const ALL: Self = Self((1 << Effect::ALL.len()) - 1);

    /// The set with one more.
    #[must_use]
    pub const fn with(self, effect: Effect) -> Self {
        Self(self.0 | 1 << effect as u8)
    }

    /// The set with one less.
    #[must_use]
    pub const fn without(self, effect: Effect) -> Self {
        Self(self.0 & !(1 << effect as u8))
    }

    /// What is in both.
    #[must_use]
    pub const fn and(self, other: Self) -> Self {
        Self(self.0 & other.0)
    }

    /// Whether it has the effect.
    pub const fn contains(self, effect: Effect) -> bool {
        self.0 & 1 << effect as u8 != 0
    }

    /// Its effects, in their order.
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
