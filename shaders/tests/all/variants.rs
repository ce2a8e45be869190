//! Variants of every pass: its features one by one and all together, without and with all effects, times values of its overrides.

use std::collections::BTreeMap;
use std::sync::LazyLock;

use naga::valid::Capabilities;

use framegraph_shaders::reflect::{Override, Scalar};
use framegraph_shaders::{Effect, Feature, Features, Module, Shader, library, resolve};

/// A pass with the features and effects it was resolved with.
pub struct Variant {
    pub pass: Module<'static>,
    pub features: Features,
    pub effects: &'static [Effect<'static>],
    pub shader: Shader,
}

impl Variant {
    /// For messages.
    pub fn name(&self) -> String {
        let features: Vec<&str> = self.features.iter().map(|f| f.name()).collect();
        let effects = if self.effects.is_empty() { "" } else { " with effects" };
        format!("{}[{}]{effects}", self.pass.path, features.join("+"))
    }

    /// Computes in half floats.
    pub fn in_half(&self) -> bool {
        self.features.contains(Feature::HALF)
    }

    /// Features that a device needs beyond core WGSL.
    pub fn capabilities(&self) -> Capabilities {
        // Shaders that run per sample read the sample index, as WebGPU allows for every shader.
        let core = Capabilities::MULTISAMPLED_SHADING;
        if self.in_half() { core.union(Capabilities::SHADER_FLOAT16) } else { core }
    }
}

/// An embedded pass.
pub fn pass(name: &str) -> Module<'static> {
    library::passes().find(|pass| pass.name() == name).unwrap_or_else(|| panic!("no pass is named {name}"))
}

/// All embedded effects, by name.
pub fn effects() -> &'static [Effect<'static>] {
    static ALL: LazyLock<Vec<Effect<'static>>> = LazyLock::new(|| {
        let files = library::SOURCES.iter().filter_map(|source| {
            let name = source.path.strip_prefix("effect/")?.strip_suffix(".wgsl")?;
            Some(Effect { name, wgsl: source.wgsl })
        });
        files.collect()
    });
    &ALL
}

/// Returns true if the pass ends with the socket for effects.
pub fn takes_effects(pass: &Module<'_>) -> bool {
    pass.wgsl.contains("import package::interface::epilogue::epilogue;")
}

/// The features that make a difference to a pass.
pub fn features_of(pass: &Module<'_>) -> Vec<Feature> {
    let text = |features: Features| resolve(pass, &features, &[]).unwrap().wgsl;
    let plain = text(Features::NONE);
    Feature::all().filter(|feature| text(Features::NONE.with(*feature)) != plain).collect()
}

/// The sets that show each feature by itself and all together: none, each alone, all.
pub fn one_by_one(features: &[Feature]) -> Vec<Features> {
    let alone = features.iter().map(|feature| Features::NONE.with(*feature));
    let all = features.iter().copied().collect();
    let mut sets: Vec<Features> = [Features::NONE].into_iter().chain(alone).chain([all]).collect();
    sets.dedup();
    sets
}

/// Every pass without features, with each of them alone and with all; without and with all also
/// in half floats; and what failed to resolve. Done once: it takes seconds unoptimized.
pub fn all() -> &'static (Vec<Variant>, Vec<String>) {
    static ALL: LazyLock<(Vec<Variant>, Vec<String>)> = LazyLock::new(resolve_all);
    &ALL
}

/// Resolves the same variant again.
pub fn resolve_all() -> (Vec<Variant>, Vec<String>) {
    let (mut variants, mut failures) = (Vec::new(), Vec::new());
    for pass in library::passes() {
        let (half, others): (Vec<_>, Vec<_>) = features_of(&pass).into_iter().partition(|f| *f == Feature::HALF);
        let sets = one_by_one(&others);
        // Without and with everything: every line is in one of the two.
        let ends = sets.first().into_iter().chain(sets.last()).filter(|_| !half.is_empty());
        let in_half: Vec<Features> = ends.map(|set| set.clone().with(Feature::HALF)).collect();
        for features in sets.into_iter().chain(in_half) {
            // Effects are the same in half floats.
            let both = takes_effects(&pass) && !features.contains(Feature::HALF);
            let choices: &[&[Effect<'static>]] = if both { &[&[], effects()] } else { &[&[]] };
            for &effects in choices {
                match resolve(&pass, &features, effects) {
                    Ok(shader) => variants.push(Variant { pass, features: features.clone(), effects, shader }),
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
