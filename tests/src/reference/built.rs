//! What a statement asks for that is not built, and what is built otherwise than in the program that made the reference.

use super::document::{Document, Ibl, ShadowType};
use super::occlusion;
use framegraph_passes::shadow::MOST_CASCADES;

/// What stands between a statement and its picture.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Gaps {
    /// Keys that ask for what is not built: the scene cannot be rendered as stated.
    pub missing: Vec<String>,
    /// Keys whose effect is built in another way: the scene is rendered, and is expected to be near.
    pub otherwise: Vec<String>,
}

/// Goes through a statement.
pub fn gaps(document: &Document) -> Gaps {
    let Document { scene, shadow_type, dithering, .. } = document;
    let (mut missing, mut otherwise) = (Vec::new(), Vec::new());
    let mut miss = |asked: bool, key: &str| {
        if asked {
            missing.push(key.to_owned());
        }
    };
    miss(scene.assets.len() > 1, "scene.assets: more than one");
    if let Some(ibl) = &scene.ibl {
        miss(ibl.ktx1.is_some(), "scene.ibl.ktx1");
        miss(ibl.ktx1.is_none() && !is_even(ibl), "scene.ibl.sh: other than uniform_cube");
    }
    let view = &scene.view;
    for key in view.ao.iter().flat_map(occlusion::missing) {
        miss(true, &format!("scene.view.ao.{key}"));
    }
    miss(view.bloom.as_ref().is_some_and(|bloom| bloom.enabled), "scene.view.bloom");
    miss(view.fog.as_ref().is_some_and(|fog| fog.enabled), "scene.view.fog");
    miss(view.taa.as_ref().is_some_and(|taa| taa.enabled), "scene.view.taa");
    let samples = view.msaa.as_ref().map_or(1, super::document::Msaa::samples);
    miss(!matches!(samples, 1 | 4), "scene.view.msaa: other than 1 or 4 samples");
    let light_out = scene.output == super::document::Output::Linear;
    miss(light_out == view.post_processing, "scene.output: codes need post_processing, and light none");
    miss(
        scene.lights.len() > 1 && scene.lights[1..].iter().any(|l| l.cast_shadows),
        "scene.lights: a second that casts shadows",
    );
    let mut differs = |asked: bool, key: &str, how: &str| {
        if asked {
            otherwise.push(format!("{key} ({how})"));
        }
    };
    for light in scene.lights.iter().filter(|light| light.cast_shadows) {
        let options = &light.shadow_options;
        let cascades = options.shadow_cascades.is_some_and(|count| count > MOST_CASCADES as u32);
        miss(cascades, "scene.lights.shadow_options.shadowCascades: more than four");
        let soft = shadow_type.is_some_and(|kind| matches!(kind, ShadowType::Dpcf | ShadowType::Pcss));
        differs(soft, "shadow_type", "other taps over the same disc");
    }
    differs(*dithering, "dithering", "another pattern");
    Gaps { missing, otherwise }
}

/// One radiance from everywhere, and harmonics that say the same.
fn is_even(ibl: &Ibl) -> bool {
    let Some(radiance) = ibl.uniform_cube else { return false };
    ibl.sh.as_ref().is_none_or(|sh| {
        let (first, rest) = sh.split_at(sh.len().min(3));
        first == radiance && rest.iter().all(|c| *c == 0.0)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    fn of(scene: &str) -> Gaps {
        let camera = r#""camera": {"type": "ortho", "ortho": [0, 1, 0, 1], "eye": [0, 0, 1], "center": [0, 0, 0],
            "up": [0, 1, 0], "near": 0.1, "far": 10}"#;
        let text = format!(r#"{{"id": "a", "scene": {{"resolution": [1, 1], {camera}, {scene}}}}}"#);
        gaps(&Document::parse(Path::new("a.json"), &text).unwrap_or_else(|error| panic!("{scene}: {error}")))
    }

    #[test]
    fn what_is_not_built_is_named_and_what_is_off_is_not() {
        let linear = r#""assets": ["a"], "output": "linear""#;
        let ldr = r#""assets": ["a"], "output": "ldr""#;
        let light = r#""type": "DIRECTIONAL", "color": [1, 1, 1], "intensity": 3, "direction": [0, -1, 0]"#;
        let off = of(&format!(
            r#"{linear}, "specular_aa": [0, 0], "ibl": {{"uniform_cube": [1, 2, 3], "sh": [1, 2, 3]}}, "lights": [{{{light}}}],
            "view": {{"ao": {{"enabled": true, "radius": 1}}, "bloom": {{}}, "taa": {{"enabled": false}}, "msaa": 4}}"#
        ));
        assert_eq!(off, Gaps::default());
        for (scene, key) in [
            (
                format!(r#"{linear}, "view": {{"ao": {{"enabled": true, "resolution": 0.25}}}}"#),
                "scene.view.ao.resolution",
            ),
            (format!(r#"{linear}, "view": {{"bloom": {{"enabled": true}}}}"#), "scene.view.bloom"),
            (format!(r#"{linear}, "view": {{"fog": {{"enabled": true}}}}"#), "scene.view.fog"),
            (format!(r#"{linear}, "view": {{"taa": {{"enabled": true}}}}"#), "scene.view.taa"),
            (format!(r#"{linear}, "view": {{"msaa": 8}}"#), "scene.view.msaa"),
            (format!(r#"{linear}, "view": {{"post_processing": true}}"#), "scene.output"),
            (ldr.to_owned(), "scene.output"),
            (format!(r#"{linear}, "ibl": {{"ktx1": "a.ktx"}}"#), "scene.ibl.ktx1"),
            (format!(r#"{linear}, "ibl": {{"uniform_cube": [1, 1, 1], "sh": [1, 1, 2]}}"#), "scene.ibl.sh"),
            (
                format!(
                    r#"{linear}, "lights": [{{{light}, "cast_shadows": true, "shadow_options": {{"shadowCascades": 5}}}}]"#
                ),
                "scene.lights.shadow_options.shadowCascades",
            ),
        ] {
            let Gaps { missing, .. } = of(&scene);
            assert!(matches!(&missing[..], [one] if one.starts_with(key)), "{scene}: {missing:?}");
        }
        let shadowed = of(&format!(
            r#"{linear}, "lights": [{{{light}, "cast_shadows": true, "shadow_options": {{"shadowCascades": 4, "lispsm": true}}}}]"#
        ));
        assert_eq!(shadowed, Gaps::default());
    }
}
