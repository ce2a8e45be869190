//! Which lobes a material has, as a set.

/// A lobe that a material may have beside the metal-rough base.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Lobe {
    /// A clear layer over the surface: [`ClearCoat`](super::ClearCoat).
    ClearCoat,
    /// Light scattered back by fibers: [`Sheen`](super::Sheen).
    Sheen,
    /// Highlights stretched along a direction: [`Anisotropy`](super::Anisotropy).
    Anisotropy,
    /// Light that passes through: [`Transmission`](super::Transmission).
    Transmission,
    /// Strength and tint of the dielectric reflection: [`Specular`](super::Specular).
    Specular,
}

impl Lobe {
    /// All lobes, in declaration order.
    pub const ALL: [Self; 5] = [Self::ClearCoat, Self::Sheen, Self::Anisotropy, Self::Transmission, Self::Specular];
}

/// A set of lobes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Lobes(u8);

impl Lobes {
    /// The metal-rough base alone.
    pub const NONE: Self = Self(0);

    /// The set with `lobe` added.
    #[must_use]
    pub const fn with(self, lobe: Lobe) -> Self {
        Self(self.0 | 1 << lobe as u8)
    }

    /// The members of either set.
    #[must_use]
    pub const fn union(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// Whether there is no lobe beside the base.
    pub const fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// Whether `lobe` is in the set.
    pub const fn contains(self, lobe: Lobe) -> bool {
        self.0 & 1 << lobe as u8 != 0
    }

    /// The members, in declaration order.
    pub fn iter(self) -> impl Iterator<Item = Lobe> {
        Lobe::ALL.into_iter().filter(move |lobe| self.contains(*lobe))
    }
}

impl FromIterator<Lobe> for Lobes {
    fn from_iter<I: IntoIterator<Item = Lobe>>(lobes: I) -> Self {
        lobes.into_iter().fold(Self::NONE, Self::with)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_set_holds_what_was_put_in() {
        let set: Lobes = [Lobe::Specular, Lobe::Sheen].into_iter().collect();
        assert_eq!(set.iter().collect::<Vec<_>>(), [Lobe::Sheen, Lobe::Specular]);
        assert!(!set.contains(Lobe::ClearCoat) && !set.is_empty() && Lobes::NONE.is_empty());
        assert_eq!(Lobes::NONE.with(Lobe::Sheen).union(Lobes::NONE.with(Lobe::Specular)), set);
    }
}
