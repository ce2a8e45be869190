//! Variants of every pass: its features one by one and all together, without and with all effects, times values of its overrides.

use std::collections::BTreeMap;
use std::sync::LazyLock;

use framegraph_shaders::reflect::{Override, Scalar};
use framegraph_shaders::{Effect, Feature, Features, Shader, ShaderId};
use naga::valid::Capabilities;

/// A pass with the features and effects it was resolved with.
pub struct Variant {
    pub id: ShaderId,
    pub features: Features,
    pub effects: &'static [Effect],
    pub shader: Shader,
}

impl Variant {
    /// For messages.
    pub fn name(&self) -> String {
        let features: Vec<&str> = self.features.iter().map(|f| f.name()).collect();
        let effects = if self.effects.is_empty() { "" } else { " with effects" };
        format!("{}[{}]{effects}", self.id.path(), features.join("+"))
    }

    /// Computes in half floats.
    pub fn in_half(&self) -> bool {
        self.features.contains(Feature::Half)
    }

    /// What a device must have beyond core WGSL.
    pub fn capabilities(&self) -> Capabilities {
        if self.in_half() { Capabilities::SHADER_FLOAT16 } else { Capabilities::empty() }
    }
}

/// Every pass without features, with each of them alone and with all; without and with all also
/// in half floats; and what failed to resolve. Done once: it takes seconds unoptimized.
pub fn all() -> &'static (Vec<Variant>, Vec<String>) {
    static ALL: LazyLock<(Vec<Variant>, Vec<String>)> = LazyLock::new(resolve_all);
    &ALL
}

/// The same, anew.
pub fn resolve_all() -> (Vec<Variant>, Vec<String>) {
    let (mut variants, mut failures) = (Vec::new(), Vec::new());
    for id in ShaderId::ALL {
        let (half, others): (Vec<_>, Vec<_>) = id.features().iter().partition(|f| **f == Feature::Half);
        let sets = Features::one_by_one(&others);
        // Without and with everything: every line is in one of the two.
        let ends = sets.first().into_iter().chain(sets.last()).filter(|_| !half.is_empty());
        let in_half = ends.map(|set| set.with(Feature::Half));
        for features in sets.iter().copied().chain(in_half) {
            // Effects are the same in half floats.
            let both = id.takes_effects() && !features.contains(Feature::Half);
            let choices: &[&[Effect]] = if both { &[&[], &Effect::ALL] } else { &[&[]] };
            for &effects in choices {
                match framegraph_shaders::resolve_with(id, features, effects) {
                    Ok(shader) => variants.push(Variant { id, features, effects, shader }),
                    Err(error) => failures.push(error.to_string()),
                }
            }
        }
    }
    (variants, failures)
}

/// Override values worth trying: all defaults, then each constant alone at each of its other
/// values (both bools, the first few numbers), then all at their last.
pub fn constants(overrides: &[Override]) -> Vec<BTreeMap<String, f64>> {
    let values = |constant: &Override| match constant.scalar {
        Scalar::Bool => vec![0.0, 1.0],
        Scalar::U32 | Scalar::I32 => vec![0.0, 1.0, 2.0, 3.0, 5.0],
        Scalar::F16 | Scalar::F32 => constant.default.into_iter().collect(),
    };
    let mut all = vec![BTreeMap::new()];
    let mut last = BTreeMap::new();
    for constant in overrides {
        for value in values(constant).into_iter().filter(|v| Some(*v) != constant.default) {
            all.push(BTreeMap::from([(constant.name.clone(), value)]));
            last.insert(constant.name.clone(), value);
        }
    }
    if !last.is_empty() {
        all.push(last);
    }
    all
}
