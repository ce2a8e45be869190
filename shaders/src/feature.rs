//! Features: what is compiled into a shader or left out.
//!
//! A feature changes the *interface* of a shader: which resources it binds; or, for one of them,
//! the type of number that shading computes in. Settings that change only arithmetic are WGSL
//! `override` constants, set when the pipeline is made, so that one resolved text serves them all.

/// One compile-time switch, tested in WGSL by `@if(NAME)`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Feature {
    /// The color pass reads the sun's shadow map.
    Shadows,
    /// The color pass reads the environment map for smooth reflections.
    EnvironmentMap,
    /// The material has a layer of varnish.
    ClearCoat,
    /// The material is cloth.
    Sheen,
    /// The material has grooves.
    Anisotropy,
    /// The material lets light through.
    Transmission,
    /// The material says how strong and of what tint its reflection is.
    Specular,
    /// Shading computes in f16 where that is safe; the device must have `SHADER_F16`.
    Half,
}

impl Feature {
    /// All features, in declaration order.
    pub const ALL: [Self; 8] = [
        Self::Shadows,
        Self::EnvironmentMap,
        Self::ClearCoat,
        Self::Sheen,
        Self::Anisotropy,
        Self::Transmission,
        Self::Specular,
        Self::Half,
    ];
    /// Those that a material calls for: each binds textures of its own.
    pub const LOBES: [Self; 5] = [Self::ClearCoat, Self::Sheen, Self::Anisotropy, Self::Transmission, Self::Specular];

    /// The name tested in WGSL.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Shadows => "SHADOWS",
            Self::EnvironmentMap => "ENVIRONMENT_MAP",
            Self::ClearCoat => "CLEAR_COAT",
            Self::Sheen => "SHEEN",
            Self::Anisotropy => "ANISOTROPY",
            Self::Transmission => "TRANSMISSION",
            Self::Specular => "SPECULAR",
            Self::Half => "HALF",
        }
    }
}

/// A set of features.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Features(u32);

impl Features {
    /// Nothing switched on.
    pub const NONE: Self = Self(0);

    /// The set with `feature` added.
    #[must_use]
    pub const fn with(self, feature: Feature) -> Self {
        Self(self.0 | 1 << feature as u32)
    }

    /// The set with `feature` added if `on`.
    #[must_use]
    pub const fn with_if(self, feature: Feature, on: bool) -> Self {
        if on { self.with(feature) } else { self }
    }

    /// The members of either set.
    #[must_use]
    pub const fn union(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// Whether nothing is switched on.
    pub const fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// Whether `feature` is in the set.
    pub const fn contains(self, feature: Feature) -> bool {
        self.0 & 1 << feature as u32 != 0
    }

    /// The members that are among `features`.
    #[must_use]
    pub fn only(self, features: &[Feature]) -> Self {
        features.iter().fold(Self::NONE, |set, f| set.with_if(*f, self.contains(*f)))
    }

    /// The members, in declaration order.
    pub fn iter(self) -> impl Iterator<Item = Feature> {
        Feature::ALL.into_iter().filter(move |f| self.contains(*f))
    }

    /// The subsets that show each feature by itself and all together: none, each alone, all. A few where all subsets would
    /// be thousands.
    pub fn one_by_one(features: &[Feature]) -> Vec<Self> {
        let alone = features.iter().map(|feature| Self::NONE.with(*feature));
        let all = features.iter().fold(Self::NONE, |set, feature| set.with(*feature));
        let mut sets: Vec<Self> = [Self::NONE].into_iter().chain(alone).chain([all]).collect();
        sets.dedup();
        sets
    }

    /// Every subset of `features`, smallest first.
    pub fn subsets(features: &[Feature]) -> Vec<Self> {
        (0..1_u32 << features.len())
            .map(|mask| {
                let chosen = features.iter().enumerate();
                chosen.fold(Self::NONE, |set, (bit, feature)| set.with_if(*feature, mask >> bit & 1 == 1))
            })
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn subsets_are_all_and_distinct() {
        let mut all = Features::subsets(&Feature::ALL);
        assert_eq!(all.len(), 1 << Feature::ALL.len());
        all.dedup();
        assert_eq!(all.len(), 1 << Feature::ALL.len());
        assert_eq!(Features::subsets(&[]), [Features::NONE]);
    }

    #[test]
    fn each_feature_is_shown_alone_and_with_all_others() {
        let sets = Features::one_by_one(&Feature::LOBES);
        assert_eq!(sets.len(), Feature::LOBES.len() + 2);
        for lobe in Feature::LOBES {
            assert_eq!(sets.iter().filter(|s| s.contains(lobe)).count(), 2, "{lobe:?}");
        }
        let one = Features::NONE.with(Feature::Sheen);
        assert_eq!(Features::one_by_one(&[Feature::Sheen]), [Features::NONE, one]);
        assert_eq!(Features::one_by_one(&[]), [Features::NONE]);
    }

    #[test]
    fn a_set_holds_what_was_put_in() {
        let set = Features::NONE.with(Feature::EnvironmentMap);
        assert!(set.contains(Feature::EnvironmentMap));
        assert!(!set.contains(Feature::Shadows));
        assert_eq!(set.iter().collect::<Vec<_>>(), [Feature::EnvironmentMap]);
        assert_eq!(set.only(&[Feature::Shadows]), Features::NONE);
        assert_eq!(set.only(&Feature::ALL), set);
    }
}
