//! Every entry point translates for every graphics API that wgpu drives.

use naga::back::{PipelineConstants, glsl, hlsl, msl, pipeline_constants, spv};
use naga::proc::BoundsCheckPolicies;
use naga::valid::{Capabilities, ModuleInfo, ValidationFlags, Validator};
use naga::{Module, ShaderStage};

use crate::variants::{self, Variant};
use framegraph_shaders::{Feature, Features, resolve};

struct Entry<'a> {
    module: &'a Module,
    info: &'a ModuleInfo,
    stage: ShaderStage,
    name: &'a str,
}

fn vulkan(entry: &Entry<'_>) -> Result<(), String> {
    let pipeline = spv::PipelineOptions { shader_stage: entry.stage, entry_point: entry.name.to_owned() };
    let options = spv::Options::default();
    spv::write_vec(entry.module, entry.info, &options, Some(&pipeline)).map(drop).map_err(|error| error.to_string())
}

fn opengl(entry: &Entry<'_>, version: glsl::Version) -> Result<(), String> {
    let options = glsl::Options { version, ..Default::default() };
    let pipeline =
        glsl::PipelineOptions { shader_stage: entry.stage, entry_point: entry.name.to_owned(), multiview: None };
    let mut out = String::new();
    let policies = BoundsCheckPolicies::default();
    glsl::Writer::new(&mut out, entry.module, entry.info, &options, &pipeline, policies)
        .and_then(|mut writer| writer.write())
        .map(drop)
        .map_err(|error| error.to_string())
}

fn direct3d(entry: &Entry<'_>) -> Result<(), String> {
    let options = hlsl::Options { fake_missing_bindings: true, ..Default::default() };
    let pipeline = hlsl::PipelineOptions { entry_point: Some((entry.stage, entry.name.to_owned())) };
    let mut out = String::new();
    hlsl::Writer::new(&mut out, &options, &pipeline)
        .write(entry.module, entry.info, None)
        .map(drop)
        .map_err(|error| error.to_string())
}

fn metal(entry: &Entry<'_>) -> Result<(), String> {
    // @invariant needs MSL 2.1; wgpu asks for what the device has.
    let options = msl::Options { lang_version: (2, 1), fake_missing_bindings: true, ..Default::default() };
    let pipeline =
        msl::PipelineOptions { entry_point: Some((entry.stage, entry.name.to_owned())), ..Default::default() };
    msl::write_string(entry.module, entry.info, &options, &pipeline).map(drop).map_err(|error| error.to_string())
}

/// A variant as naga reads it.
fn parsed(variant: &Variant) -> (Module, ModuleInfo) {
    let module = naga::front::wgsl::parse_str(&variant.shader.wgsl).unwrap();
    let info = Validator::new(ValidationFlags::all(), variant.capabilities()).validate(&module).unwrap();
    (module, info)
}

/// Translates all entry points with one choice of constants; returns how many translations
/// were made.
fn translate(
    variant: &Variant,
    (module, info): &(Module, ModuleInfo),
    constants: &PipelineConstants,
    failures: &mut Vec<String>,
) -> usize {
    let mut made = 0;
    for entry_point in &module.entry_points {
        let (stage, name) = (entry_point.stage, entry_point.name.as_str());
        let fixed = pipeline_constants::process_overrides(module, info, Some((stage, name)), constants);
        let (module, info) = match fixed {
            Ok(fixed) => fixed,
            Err(error) => {
                failures.push(format!("{} {name}: {error}", variant.name()));
                continue;
            }
        };
        let entry = Entry { module: &module, info: &info, stage, name };
        let gl_es = glsl::Version::Embedded { version: 310, is_webgl: false };
        let mut results = vec![("Vulkan", vulkan(&entry)), ("Direct3D 12", direct3d(&entry)), ("Metal", metal(&entry))];
        // OpenGL has no half floats in shaders, so no device asks for them there.
        if !variant.in_half() {
            results.push(("OpenGL 4.3", opengl(&entry, glsl::Version::Desktop(430))));
            results.push(("OpenGL ES 3.1", opengl(&entry, gl_es)));
        }
        for (api, result) in results {
            made += 1;
            if let Err(error) = result {
                failures.push(format!("{} {name} for {api}: {error}", variant.name()));
            }
        }
    }
    made
}

#[test]
fn every_variant_translates_for_every_api() {
    let (variants, failures) = variants::all();
    let mut failures = failures.clone();
    let mut made = 0;
    for variant in variants {
        let mut choices = variants::constants(&variant.shader.reflection.overrides);
        let elsewhere = variant.pass.name() == "color" && !variant.effects.is_empty();
        if variant.in_half() || elsewhere {
            // Each constant alone is shown in f32, and those of effects by the pass of nothing but effects: all at their
            // defaults and all at their last will do.
            choices.drain(1..choices.len() - 1);
        }
        let parsed = parsed(variant);
        for constants in choices {
            let constants = constants.into_iter().collect();
            made += translate(variant, &parsed, &constants, &mut failures);
        }
    }
    assert!(failures.is_empty(), "{} failures:\n{}", failures.len(), failures.join("\n"));
    assert!(made > 400, "only {made} translations were made");
}

#[test]
fn an_override_that_does_not_exist_is_an_error() {
    let (variants, _) = variants::all();
    let constants = [("NO_SUCH_CONSTANT".to_owned(), 1.0)].into_iter().collect();
    let mut failures = Vec::new();
    translate(&variants[0], &parsed(&variants[0]), &constants, &mut failures);
    assert!(!failures.is_empty(), "or the test above would not notice a misspelling");
}

/// The passes of stereo views are valid SPIR-V with multiview, and select an eye by the index of the view.
#[test]
fn stereo_variants_are_valid_with_multiview() -> Result<(), String> {
    for name in ["prepass", "color"] {
        let pass = variants::pass(name);
        for features in [Features::NONE, Features::NONE.with(Feature::INSTANCE_STREAM)] {
            let features = features.with(Feature::STEREO);
            let shader = resolve(&pass, &features, &[]).map_err(|error| error.to_string())?;
            assert!(shader.wgsl.contains("view_index"), "{name}");
            let module = naga::front::wgsl::parse_str(&shader.wgsl).map_err(|error| error.to_string())?;
            let capabilities = Capabilities::MULTIVIEW | Capabilities::MULTISAMPLED_SHADING;
            let info = Validator::new(ValidationFlags::all(), capabilities).validate(&module);
            let info = info.map_err(|error| error.emit_to_string(&shader.wgsl))?;
            for own in module
                .entry_points
                .iter()
                .filter(|own| ["vs_main", "vs_opaque", "vs_mask", "fs_main", "fs_mask"].contains(&&*own.name))
            {
                let (module, info) = pipeline_constants::process_overrides(
                    &module,
                    &info,
                    Some((own.stage, &own.name)),
                    &Default::default(),
                )
                .map_err(|error| error.to_string())?;
                vulkan(&Entry { module: &module, info: &info, stage: own.stage, name: &own.name })?;
            }
        }
    }
    Ok(())
}
