//! Every entry point, resolved as at run time, is valid with nothing but core WGSL, and half floats where asked for.

use framegraph_shaders::reflect::Stage;
use framegraph_shaders::{Feature, Features, Module, Shader, library, resolve};
use naga::valid::{Capabilities, ValidationFlags, Validator};

use crate::bindings::GROUP_MATERIAL;
use crate::variants;

#[test]
fn every_entry_point_is_valid_core_wgsl() {
    let (variants, failures) = variants::all();
    let mut failures = failures.clone();
    let mut entry_points = 0;
    for variant in variants {
        let module = naga::front::wgsl::parse_str(&variant.shader.wgsl);
        // `resolve` allows what a device might; here nothing beyond the core is allowed.
        let checked = module.map_err(|e| e.to_string()).and_then(|module| {
            let mut core = Validator::new(ValidationFlags::all(), Capabilities::MULTISAMPLED_SHADING);
            let with = Validator::new(ValidationFlags::all(), variant.capabilities()).validate(&module);
            match core.validate(&module) {
                Ok(_) if variant.in_half() => Err("it is said to use half floats and does not".to_owned()),
                _ => with.map_err(|e| format!("{e:?}")),
            }
        });
        match checked {
            Ok(_) => entry_points += variant.shader.reflection.entry_points.len(),
            Err(error) => failures.push(format!("{}: {error}", variant.name())),
        }
    }
    assert!(failures.is_empty(), "{} failures:\n{}", failures.len(), failures.join("\n"));
    assert!(variants.len() > library::passes().count(), "no variants were found");
    assert!(entry_points > variants.len(), "only {entry_points} entry points were found");
}

fn plain(pass: &Module<'_>) -> Shader {
    resolve(pass, &Features::NONE, &[]).unwrap()
}

/// Every function with a stage attribute in the file of a pass is an entry point of the shader, and no import adds one.
#[test]
fn the_entry_points_are_those_of_the_file() {
    for pass in library::passes() {
        let after =
            |attribute| pass.wgsl.match_indices(attribute).map(move |(at, text): (usize, &str)| at + text.len());
        let mut starts: Vec<usize> = ["@vertex", "@fragment", "@compute"].into_iter().flat_map(after).collect();
        starts.sort_unstable();
        let name = |at: &usize| pass.wgsl[*at..].split_once("fn ").and_then(|(_, text)| text.split_once('('));
        let written: Vec<&str> = starts.iter().filter_map(name).map(|(name, _)| name).collect();
        let shader = plain(&pass);
        let found: Vec<&str> = shader.reflection.entry_points.iter().map(|e| e.name.as_str()).collect();
        assert_eq!(found, written, "{}", pass.path);
        assert!(found.len() > 1, "{}: a vertex and a fragment stage", pass.path);
    }
}

#[test]
fn resolving_is_deterministic() {
    let ((first, _), (again, _)) = (variants::all(), variants::resolve_all());
    for (a, b) in first.iter().zip(&again) {
        assert_eq!(a.shader.wgsl, b.shader.wgsl, "{}", a.name());
        assert_eq!(a.shader.reflection, b.shader.reflection, "{}", a.name());
    }
}

#[test]
fn every_feature_makes_a_difference_and_only_to_what_shades() {
    for pass in library::passes() {
        let expected: Vec<Feature> = match pass.name() {
            // Dispersion is part of transmission, and makes no difference alone.
            "color" => {
                let not = [Feature::VELOCITY, Feature::DISPERSION, Feature::SUN_HALO];
                Feature::all().filter(|feature| !not.contains(feature)).collect()
            }
            "taa" => vec![Feature::VELOCITY],
            "sky" => vec![Feature::FOG, Feature::SUN_HALO],
            // Made of functions that shade, too, and made in f32.
            "dfg" => vec![Feature::HALF],
            "occlusion" => vec![Feature::HALF],
            // Its vertices hand on what those of the color pass do.
            "reflection" => vec![
                Feature::TEXTURED,
                Feature::VERTEX_COLORS,
                Feature::MATERIAL_TABLE,
                Feature::INSTANCE_STREAM,
                Feature::ANISOTROPY,
                Feature::TRANSMISSION,
                Feature::DIFFUSE_TRANSMISSION,
            ],
            // They read materials too, but are never asked to take them from an array.
            "prepass" | "pick" | "shadow" | "velocity" => vec![Feature::MATERIAL_TABLE, Feature::INSTANCE_STREAM],
            _ => Vec::new(),
        };
        assert_eq!(variants::features_of(&pass), expected, "{}", pass.path);
    }
}

/// A surface without a lobe has nothing of it in its shader, and one with it has.
#[test]
fn lobes_are_in_the_shaders_that_call_for_them() {
    let text = |features: Features| resolve(&variants::pass("color"), &features, &[]).unwrap().wgsl;
    let plain = text(Features::NONE);
    for (words, features) in [
        (["fn thin_film_reflectance", "iridescence_texture"], Features::NONE.with(Feature::IRIDESCENCE)),
        (["fn dispersed_ior", "refracted_path"], Features::NONE.with(Feature::TRANSMISSION).with(Feature::DISPERSION)),
        (["fn subsurface_scatter", "fn subsurface_roughness"], Features::NONE.with(Feature::SUBSURFACE)),
        (["fn wrapped_cosine", "fn cloth_tint"], Features::NONE.with(Feature::CLOTH_SUBSURFACE)),
        (["fn fd_transmitted", "diffuse_transmission_texture"], Features::NONE.with(Feature::DIFFUSE_TRANSMISSION)),
    ] {
        let lobe = text(features);
        for word in words {
            assert!(lobe.contains(word) && !plain.contains(word), "{word}");
        }
    }
    assert!(!text(Features::NONE.with(Feature::TRANSMISSION)).contains("dispersed_ior"));
}

#[test]
fn effects_make_a_difference_where_there_is_a_socket_and_are_refused_elsewhere() {
    for pass in library::passes() {
        let effects = &variants::effects()[..1];
        match resolve(&pass, &Features::NONE, effects) {
            Ok(with) => assert!(plain(&pass).wgsl != with.wgsl && variants::takes_effects(&pass), "{}", pass.path),
            Err(error) => assert!(!variants::takes_effects(&pass), "{}: {error}", pass.path),
        }
    }
}

#[test]
fn depth_passes_of_opaque_geometry_read_positions_alone() {
    for pass in ["shadow", "prepass"] {
        let shader = plain(&variants::pass(pass));
        let opaque = shader.reflection.entry_point("vs_opaque").unwrap();
        assert_eq!(opaque.stage, Stage::Vertex);
        let read: Vec<u32> = opaque.vertex_inputs.iter().map(|input| input.location).collect();
        assert_eq!(read, [0, 6], "position, and the number of the object");
        assert!(opaque.bindings.iter().all(|b| b.group != GROUP_MATERIAL));
    }
}

#[test]
fn prepass_and_color_agree_on_the_position() {
    // The same two functions, printed the same, under @invariant outputs.
    let text = |name| plain(&variants::pass(name)).wgsl;
    let (prepass, color) = (text("prepass"), text("color"));
    for name in ["fn world_position", "fn clip_position"] {
        let body = |wgsl: &str| {
            let from = wgsl.find(name).unwrap_or_else(|| panic!("{name} is missing"));
            wgsl[from..from + wgsl[from..].find("\n}").unwrap()].to_owned()
        };
        assert_eq!(body(&prepass), body(&color));
    }
    assert_eq!(prepass.matches("@invariant").count(), 2);
    assert_eq!(color.matches("@invariant").count(), 1);
}
