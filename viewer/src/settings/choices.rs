//! Fields with variants or optional values.

use super::Node;
use framegraph_passes::effects::bloom::FlareSettings;
use framegraph_passes::effects::fog::FogGlow;
use framegraph_passes::effects::occlusion::{Blur, ConeTrace};
use framegraph_passes::{Effect, FrameSettings, Settings, Upscale};
use std::sync::OnceLock;

/// Alternative values of a field, in RON.
pub type Alternatives = Vec<String>;

/// Default settings of froxels.
const FROXELS: &str = "tiles: 144, slices: 16, near_m: 5.0, far_m: 100.0";

/// Optional fields.
const OPTIONS: [&str; 19] = [
    "settings.shading.specular_aa",
    "settings.shading.light_fade_m",
    "settings.shadows",
    "settings.shadows.far_m",
    "settings.shadows.bulb_m",
    "settings.shadows.contact",
    "settings.occlusion",
    "settings.occlusion.blur",
    "settings.occlusion.cone",
    "settings.reflections",
    "settings.fog",
    "settings.fog.glow",
    "settings.dof",
    "settings.dof.focal_length_m",
    "settings.bloom",
    "settings.bloom.flare",
    "settings.taa",
    "settings.upscale",
    "settings.post.edge_fade",
];

/// Fields with variants.
const VARIANTS: [(&str, &[&str]); 33] = [
    ("quality", &["Low", "High", "Ultra"]),
    ("settings.samples", &["1", "4"]),
    ("settings.shadows.moments.samples", &["1", "4"]),
    ("settings.shading.precision", &["Full", "Half"]),
    ("settings.shading.visibility", &["Exact", "Fast"]),
    ("settings.shading.table", &["Exact", "Fast"]),
    ("settings.shading.bands", &["Two", "Three", "Five"]),
    ("settings.shading.window", &["None", "Hann", "Sinc", "Laplacian(lambda: 0.01)"]),
    ("settings.shading.irradiance", &["Harmonics", "Cube"]),
    ("settings.shading.environment_format", &["Rg11b10", "Half", "Rgbm"]),
    ("settings.shading.transmission_blur", &["Distance", "Angle"]),
    ("settings.shading.light_window", &["Gltf", "Filament"]),
    ("settings.shadows.filter", &["Pcf", "Dpcf", "Pcss", "Vsm", "Evsm"]),
    ("settings.shadows.splits", &["Uniform", "Logarithmic", "Practical(0.8)", "At(0.125, 0.25, 0.5)"]),
    ("settings.shadows.fit", &["Tight(lispsm: true)", "Stable"]),
    (
        "settings.occlusion.method",
        &["Sao(taps: 16, turns: 7)", "Gtao(slices: 2, steps: 6, step_power: 1.0, occluders: Solid)"],
    ),
    ("settings.occlusion.method.occluders", &["Solid", "Fading", "Thick(0.2)"]),
    ("settings.occlusion.resolution", &["Full", "Half"]),
    (
        "settings.fog.color",
        &["Radiance(2000.0, 2500.0, 3000.0)", "Environment(tint: (1.0, 1.0, 1.0), sharp_m: 100.0, sharp_levels: 1.0)"],
    ),
    (
        "settings.transparency",
        &["Sorted", "TwoPasses", "Weighted", "Moments(precision: Half, overestimation: 0.25)", "Peeled(layers: 4)"],
    ),
    ("settings.transparency.precision", &["Half", "Full"]),
    ("settings.dof.resolution", &["Full", "Half"]),
    ("settings.bloom.quality", &["Low", "Medium", "High"]),
    ("settings.bloom.blend", &["Add", "Interpolate"]),
    ("settings.bloom.threshold", &["None", "Soft", "Hard"]),
    ("settings.taa.jitter", &["Rgss4", "Helix4", "Halton8", "Halton16", "Halton32"]),
    ("settings.taa.color_box", &["Bounds", "Variance", "Both"]),
    ("settings.taa.clipping", &["Accurate", "Clamp", "None"]),
    ("settings.upscale.filter", &["Bilinear", "Fsr"]),
    (
        "settings.post.look.tone_map",
        &[
            "Linear",
            "Hill",
            "Filmic",
            "Neutral",
            "AcesLegacy",
            "Linear2020",
            "Aces",
            "Agx",
            "AgxGolden",
            "AgxPunchy",
            "Gt7",
            "DisplayRange",
            "Mobile",
            "Generic(contrast: 1.55, middle_in: 0.18, middle_out: 0.215, white: 10.0)",
        ],
    ),
    ("settings.post.by", &["Direct", "Table(entries: 32, format: Half)"]),
    ("settings.post.by.format", &["Rgb10", "Half"]),
    ("settings.hdr_format", &["Rgba16Float", "Rg11b10Ufloat"]),
];

/// Returns the alternatives of the field at a path; `None` for numbers, booleans and plain structures.
pub fn alternatives(path: &str) -> Option<Alternatives> {
    if path == "lights" {
        return Some(vec![format!("Auto({FROXELS})"), format!("Froxels({FROXELS})"), "All".into()]);
    }
    if let Some((_, variants)) = VARIANTS.iter().find(|(known, _)| *known == path) {
        return Some(variants.iter().map(|variant| (*variant).to_owned()).collect());
    }
    OPTIONS.contains(&path).then(|| vec!["None".into(), template().at(path).map_or_else(String::new, Node::to_string)])
}

/// Returns settings in which nothing is `None`.
fn template() -> &'static Node {
    static TREE: OnceLock<Node> = OnceLock::new();
    TREE.get_or_init(|| {
        let frame = FrameSettings { settings: everything(), ..FrameSettings::DEFAULT };
        super::tree(&frame).unwrap_or_else(|_| Node::Word("None".into()))
    })
}

/// Returns settings with every effect at its default strength.
fn everything() -> Settings {
    let mut s = Effect::ALL.into_iter().fold(Settings::DEFAULT, Settings::with);
    s.upscale = Some(Upscale::DEFAULT);
    s.shading.light_fade_m = Some(100.0);
    if let Some(shadows) = &mut s.shadows {
        (shadows.far_m, shadows.bulb_m) = (Some(50.0), Some(0.1));
    }
    if let Some(occlusion) = &mut s.occlusion {
        occlusion.cone = Some(ConeTrace::FILAMENT);
        occlusion.blur = occlusion.blur.or(Some(Blur::high(4.0)));
    }
    if let Some(fog) = &mut s.fog {
        fog.glow = Some(FogGlow { start_m: 0.0, size: 20.0 });
    }
    if let Some(dof) = &mut s.dof {
        dof.focal_length_m = Some(0.028);
    }
    if let Some(bloom) = &mut s.bloom {
        bloom.flare = Some(FlareSettings::DEFAULT);
    }
    s
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::settings::{settings, tree};

    /// Lists every field below a path whose value is a variant.
    fn variants(node: &Node, path: &str, found: &mut Vec<String>) {
        let is_name = |word: &str| word.starts_with(|c: char| c.is_ascii_uppercase());
        if node.variant().is_some_and(is_name) {
            found.push(path.to_owned());
        }
        for (name, child) in node.children() {
            let path = if path.is_empty() { name } else { format!("{path}.{name}") };
            variants(child, &path, found);
        }
    }

    #[test]
    fn every_variant_of_the_file_can_be_chosen() {
        let mut found = Vec::new();
        variants(template(), "", &mut found);
        assert!(found.len() > 20, "{found:?}");
        for path in found {
            assert!(alternatives(&path).is_some(), "{path} has no alternatives");
        }
    }

    #[test]
    fn every_alternative_is_a_value_that_the_file_takes() {
        let paths = OPTIONS.into_iter().chain(VARIANTS.iter().map(|(path, _)| *path)).chain(["lights"]);
        let mut tried = 0;
        for path in paths {
            for text in alternatives(path).expect("it is in the lists") {
                let mut whole = template().clone();
                if path == "settings.occlusion.method.occluders" {
                    *whole.at_mut("settings.occlusion.method").expect("a method") =
                        super::super::parse(&alternatives("settings.occlusion.method").expect("methods")[1])
                            .expect("a value");
                }
                if path == "settings.transparency.precision" {
                    *whole.at_mut("settings.transparency").expect("a technique") =
                        super::super::parse(&alternatives("settings.transparency").expect("techniques")[3])
                            .expect("a value");
                }
                if path == "settings.post.by.format" {
                    *whole.at_mut("settings.post.by").expect("a way") =
                        super::super::parse(&alternatives("settings.post.by").expect("ways")[1]).expect("a value");
                }
                let place = whole.at_mut(path).unwrap_or_else(|| panic!("there is no {path}"));
                *place = super::super::parse(&text).unwrap_or_else(|error| panic!("{path}: {text}: {error}"));
                let read = settings(&whole).unwrap_or_else(|error| panic!("{path}: {text}: {error}"));
                let again = tree(&read).expect("a tree");
                let (is, asked) =
                    (again.at(path).and_then(Node::variant), super::super::parse(&text).expect("a value"));
                assert_eq!(is, asked.variant(), "{path}");
                tried += 1;
            }
        }
        assert!(tried > 80, "{tried}");
    }

    #[test]
    fn nothing_in_the_template_is_none_and_what_is_left_out_there_is_an_option() {
        for path in OPTIONS {
            assert_ne!(template().at(path).and_then(Node::variant), Some("None"), "{path}");
        }
        let mut none = Vec::new();
        let plain = tree(&FrameSettings::DEFAULT).expect("a tree");
        variants(&plain, "", &mut none);
        none.retain(|path| plain.at(path).and_then(Node::variant) == Some("None"));
        assert!(none.len() > 8 && none.iter().all(|path| alternatives(path).is_some()), "{none:?}");
    }
}
