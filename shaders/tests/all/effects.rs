//! Point-wise effects at the end of a shader.

use framegraph_shaders::{Effect, Features, Module, ShaderError, library, resolve};

const SEPIA: Effect<'_> = Effect {
    name: "sepia",
    wgsl: "import package::lib::luminance::luminance;\n\
           struct Sepia { tint: vec3<f32> }\n\
           @group(0) @binding(0) var<uniform> sepia_settings: Sepia;\n\
           fn sepia(color: vec4<f32>, pixel: vec2<f32>) -> vec4<f32> {\n    \
               return vec4<f32>(luminance(color.rgb) * sepia_settings.tint, color.a);\n}\n",
};
const EXPOSE: Effect<'_> = Effect { name: "expose", wgsl: library::text("effect/expose.wgsl").unwrap() };
const TONE: Effect<'_> = Effect { name: "tone", wgsl: library::text("effect/tone.wgsl").unwrap() };
const POST: Module<'_> = library::pass("pass/post.wgsl").unwrap();

#[test]
fn effects_are_called_in_order_and_as_often_as_listed() -> Result<(), ShaderError> {
    for pass in ["pass/post.wgsl", "pass/color.wgsl", "pass/sky.wgsl"] {
        let pass = library::pass(pass).unwrap();
        let shader = resolve(&pass, &Features::NONE, &[EXPOSE, SEPIA, TONE, SEPIA])?;
        let from = shader.wgsl.find("fn epilogue(").unwrap_or_default();
        let body = &shader.wgsl[from..];
        let body = &body[..body.find("\n}").unwrap_or_default()];
        let calls: Vec<_> = body.lines().filter_map(|l| l.trim().strip_prefix("color = ")).collect();
        let names: Vec<_> = calls.iter().filter_map(|c| c.split_once('(')).map(|(name, _)| name).collect();
        assert_eq!(names, ["expose", "sepia", "tone", "sepia"], "{}", pass.path);
        assert_eq!(shader.wgsl.matches("fn sepia(").count(), 1);
        let bound = shader.reflection.entry_points.iter().flat_map(|e| &e.bindings);
        assert!(bound.clone().any(|b| b.name == "exposing") && !bound.clone().any(|b| b.name == "encoding"));
    }
    Ok(())
}

#[test]
fn effects_bind_behind_the_pass_and_each_other() -> Result<(), ShaderError> {
    let shader = resolve(&POST, &Features::NONE, &[SEPIA, EXPOSE])?;
    let fragment = shader.reflection.entry_point("fs_main").unwrap();
    let bound: Vec<_> = fragment.bindings.iter().map(|b| (b.binding, b.name.as_str())).collect();
    assert_eq!(bound, [(0, "hdr"), (1, "exposing"), (2, "sepia_settings")]);
    Ok(())
}

#[test]
fn wrong_effects_are_refused() {
    let refused = |effects: &[Effect<'_>]| resolve(&POST, &Features::NONE, effects).map(|_| ()).is_err();
    assert!(refused(&[Effect { name: "no name", ..SEPIA }]));
    assert!(refused(&[SEPIA, Effect { wgsl: "fn sepia() {}", ..SEPIA }]));
    assert!(refused(&[Effect { name: "tone", ..SEPIA }]), "an embedded one cannot be replaced");
    let fxaa = library::pass("pass/fxaa.wgsl").unwrap();
    let told = resolve(&fxaa, &Features::NONE, &[TONE]).map(|_| ()).unwrap_err().to_string();
    assert!(told.contains("pass/fxaa.wgsl") && told.contains("epilogue"), "{told}");
}

#[test]
fn a_fault_in_an_effect_is_reported_where_it_is() {
    let wgsl = "fn sepia(color: vec4<f32>, pixel: vec2<f32>) -> vec4<f32> {\n    let x = 1;\n    return lost;\n}\n";
    let told = resolve(&POST, &Features::NONE, &[Effect { wgsl, ..SEPIA }]).map(|_| ()).unwrap_err().to_string();
    assert!(told.starts_with("effect/sepia.wgsl:3:"), "{told}");
}
