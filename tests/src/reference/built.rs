//! Features of a statement that are not implemented, or implemented differently from the reference's renderer.

use super::document::{Document, Msaa, ShadowType};
use super::occlusion;
use framegraph_passes::gpu_scene::shadow_views::MAX_CASCADES;

/// Differences between a statement and our renderer.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Gaps {
    /// Keys of features that are not implemented; the scene cannot be rendered as stated.
    pub missing: Vec<String>,
    /// Keys of features that are implemented differently; the picture is expected to be similar.
    pub otherwise: Vec<String>,
}

/// Finds the gaps of a statement.
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
        miss(ibl.ktx1.is_none() && ibl.uniform_cube.is_none(), "scene.ibl: neither uniform_cube nor ktx1");
    }
    let view = &scene.view;
    miss(view.taa.as_ref().is_some_and(|taa| taa.enabled && taa.upscaling), "scene.view.taa.upscaling");
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
        let cascades = options.shadow_cascades.is_some_and(|count| count > MAX_CASCADES as u32);
        differs(cascades, "scene.lights.shadow_options.shadowCascades", "four");
        let soft = shadow_type.is_some_and(|kind| matches!(kind, ShadowType::Dpcf | ShadowType::Pcss));
        differs(soft, "shadow_type", "other taps over the same disc");
    }
    differs(*dithering, "dithering", "another pattern");
    let rays = view.bloom.as_ref().is_some_and(|bloom| bloom.enabled && bloom.lens_flare == Some(true));
    let rays = rays && view.bloom.as_ref().is_some_and(|bloom| bloom.starburst != Some(false));
    differs(rays, "scene.view.bloom.starburst", "other random numbers");
    let biased = view.taa.as_ref().is_some_and(|taa| taa.enabled && taa.lod_bias.is_some_and(|bias| bias != 0.0));
    differs(biased, "scene.view.taa.lodBias", "textures are read without");
    let samples = view.msaa.as_ref().map_or(1, Msaa::samples);
    differs(!matches!(samples, 0 | 1 | 4), "scene.view.msaa", "four samples");
    for [key, how] in view.ao.iter().flat_map(occlusion::otherwise) {
        differs(true, &format!("scene.view.ao.{key}"), how);
    }
    for key in unknown(document) {
        differs(true, &key, "unknown, not read");
    }
    Gaps { missing, otherwise }
}

/// Returns unknown keys with their paths.
fn unknown(document: &Document) -> Vec<String> {
    let view = &document.scene.view;
    let lights = document.scene.lights.iter().enumerate();
    let options =
        lights.map(|(i, light)| (format!("scene.lights[{i}].shadow_options."), &light.shadow_options.unknown));
    let ao = view.ao.iter().map(|ao| ("scene.view.ao.".to_owned(), &ao.unknown));
    let ssr = view.ssr.iter().map(|ssr| ("scene.view.ssr.".to_owned(), &ssr.unknown));
    let taa = view.taa.iter().map(|taa| ("scene.view.taa.".to_owned(), &taa.unknown));
    let within = options.chain(ao).chain(ssr).chain(taa);
    let keys = within.flat_map(|(place, keys)| keys.keys().map(move |key| format!("{place}{key}")));
    document.unknown.iter().cloned().chain(keys).collect()
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
                format!(r#"{linear}, "view": {{"taa": {{"enabled": true, "upscaling": true}}}}"#),
                "scene.view.taa.upscaling",
            ),
            (format!(r#"{linear}, "view": {{"post_processing": true}}"#), "scene.output"),
            (ldr.to_owned(), "scene.output"),
            (format!(r#"{linear}, "ibl": {{"sh": [1, 1, 1]}}"#), "scene.ibl: neither uniform_cube nor ktx1"),
        ] {
            let Gaps { missing, .. } = of(&scene);
            assert!(matches!(&missing[..], [one] if one.starts_with(key)), "{scene}: {missing:?}");
        }
        // Minor differences are rendered and reported.
        for (scene, told) in [
            (
                format!(r#"{linear}, "view": {{"ao": {{"enabled": true, "resolution": 0.25, "noise": 1}}}}"#),
                &["scene.view.ao.resolution (half)", "scene.view.ao.noise (unknown, not read)"][..],
            ),
            (format!(r#"{linear}, "view": {{"msaa": 8}}"#), &["scene.view.msaa (four samples)"]),
            (
                format!(
                    r#"{linear}, "lights": [{{{light}, "cast_shadows": true, "shadow_options": {{"shadowCascades": 5, "x": 0}}}}]"#
                ),
                &[
                    "scene.lights.shadow_options.shadowCascades (four)",
                    "scene.lights[0].shadow_options.x (unknown, not read)",
                ],
            ),
        ] {
            let Gaps { missing, otherwise } = of(&scene);
            assert_eq!((missing.len(), otherwise), (0, told.iter().map(|s| (*s).to_owned()).collect()), "{scene}");
        }
        let shadowed = of(&format!(
            r#"{linear}, "lights": [{{{light}, "cast_shadows": true, "shadow_options": {{"shadowCascades": 4, "lispsm": true}}}}]"#
        ));
        assert_eq!(shadowed, Gaps::default());
    }
}
