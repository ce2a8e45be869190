//! A broken shader is reported with its file and line: the negative control of validation.

use framegraph_shaders::{Feature, Features, Module, Shader, ShaderError, Source, library, resolve};

fn resolve_source(file: &str, source: &str) -> Result<Shader, ShaderError> {
    resolve(&Module::new(file, source), &Features::NONE, &[])
}

fn error_of(source: &str) -> ShaderError {
    resolve_source("broken.wgsl", source).expect_err("it is broken")
}

/// A valid shader around a body that begins in line 5.
fn with_body(body: &str) -> String {
    format!(
        "import package::lib::luminance::luminance;\n\
         // a comment, so that lines move\n\n\
         @fragment fn fs_main() -> @location(0) vec4<f32> {{\n{body}\n}}\n"
    )
}

#[test]
fn the_shader_around_the_faults_is_sound() {
    let sound = with_body("    return vec4<f32>(luminance(vec3<f32>(1.0)));");
    assert!(resolve_source("sound.wgsl", &sound).is_ok());
}

#[test]
fn faults_are_reported_where_they_are() {
    // (body, line, part of the message)
    let faults = [
        // Does not parse.
        ("    let x = ;\n    return vec4<f32>(1.0);", 5, "expected expression"),
        // An identifier without a declaration.
        ("    let x = 1.0;\n    return vec4<f32>(missing);", 6, "missing"),
        // A type error, found by naga in the printed text.
        ("    let x = 1.0;\n    let y: vec3<f32> = x;\n    return vec4<f32>(y, 1.0);", 6, "y"),
        // A wrong number of arguments to a library function.
        ("\n\n    return vec4<f32>(luminance(vec3<f32>(1.0), 2.0));", 7, "Requires 1 arguments"),
        // A wrong type of argument, found by the validator.
        ("    let a = 1.0;\n    return vec4<f32>(luminance(vec2<f32>(a)));", 6, ""),
        // Inside nested blocks.
        (
            "    var sum = 0.0;\n    for (var i = 0; i < 3; i++) {\n        if i == 1 {\n\
             \n            sum += vec2<f32>(1.0);\n        }\n    }\n    return vec4<f32>(sum);",
            9,
            "",
        ),
        // The wrong return type.
        ("    let a = 1.0;\n    let b = a;\n    return a + b;", 7, ""),
    ];
    let mut failures = Vec::new();
    for (body, line, part) in faults {
        let error = error_of(&with_body(body));
        let text = error.to_string();
        let placed = matches!(
            &error,
            ShaderError::Source { file, line: at, .. } if file == "broken.wgsl" && *at == line
        );
        if !placed || !text.contains(part) || text.contains('\u{1b}') || text.contains('\n') {
            failures.push(format!("expected line {line} and `{part}`, got: {text}\n{body}"));
        }
    }
    assert!(failures.is_empty(), "{}", failures.join("\n\n"));
}

#[test]
fn a_missing_import_names_the_line_and_what_is_missing() {
    for import in ["package::lib::no_such_file::f", "package::lib::luminance::no_such_function"] {
        let source = format!("// comment\nimport {import};\n@compute @workgroup_size(1) fn main() {{}}\n");
        let text = error_of(&source).to_string();
        assert!(text.starts_with("broken.wgsl:2:") && text.contains("no_such"), "{text}");
    }
}

#[test]
fn a_name_of_two_files_is_refused() {
    let source = "import package::lib::ggx::d_ggx;\n\nconst PI: f32 = 3.0;\n\
                  @compute @workgroup_size(1) fn main() { let x = d_ggx(0.5, 0.5) + PI; }\n";
    let text = error_of(source).to_string();
    assert!(text.starts_with("broken.wgsl:3:") && text.contains("`PI`") && text.contains("lib/math.wgsl"), "{text}");
}

#[test]
fn an_unknown_feature_is_not_taken_for_one_that_is_off() {
    let source = "@compute @workgroup_size(1) fn main() {\n    @if(SHADWOS) { let x = 1; }\n}\n";
    let text = error_of(source).to_string();
    assert!(text.starts_with("broken.wgsl:2:") && text.contains("SHADWOS"), "{text}");
}

#[test]
fn a_custom_shader_cannot_pose_as_an_embedded_one() {
    let source = "@compute @workgroup_size(1) fn main() {}\n";
    for file in ["color.wgsl", "pass/color.wgsl", "some/folder/own.wgsl", "own", "1st with a blank.wgsl"] {
        let shader = resolve_source(file, source).unwrap();
        assert_eq!(shader.reflection.entry_points[0].name, "main");
        assert!(shader.wgsl.starts_with(&format!("// {file}:1\n")), "{}", shader.wgsl);
    }
    for file in ["", "two\nlines.wgsl"] {
        let error = resolve_source(file, source).expect_err(file);
        assert!(matches!(error, ShaderError::FileName { .. }), "{error}");
    }
}

#[test]
fn a_shader_of_another_crate_brings_its_files_and_features() {
    let noise =
        Source { path: "fog/noise.wgsl", wgsl: "@if(THICK) const NOISE: f32 = 2.0;\n@else const NOISE: f32 = 1.0;" };
    let wgsl = "import package::fog::noise::NOISE;\n\
                @compute @workgroup_size(1) fn main() { let x = NOISE; }\n";
    let thick = Feature::new("THICK");
    let fog = Module { features: &[thick], sources: &[noise], ..Module::new("fog/fog.wgsl", wgsl) };
    let text = |features: Features| resolve(&fog, &features, &[]).map(|shader| shader.wgsl);
    assert!(text(Features::NONE.with(thick)).unwrap().contains("NOISE: f32 = 2.0"));
    assert!(text(Features::NONE).unwrap().contains("// fog/noise.wgsl:2\nconst NOISE: f32 = 1.0"));

    let told = text(Features::NONE.with(Feature::new("THIN"))).unwrap_err().to_string();
    assert!(told.contains("fog/fog.wgsl") && told.contains("`THIN`"), "{told}");
    let told = resolve(&Module { features: &[], ..fog }, &Features::NONE, &[]).unwrap_err().to_string();
    assert!(told.starts_with("fog/noise.wgsl:1:") && told.contains("`THICK`"), "{told}");
    let hides = Source { path: "lib/math.wgsl", ..noise };
    let told = resolve(&Module { sources: &[hides], ..fog }, &Features::NONE, &[]).unwrap_err().to_string();
    assert!(told.contains("lib/math.wgsl"), "{told}");
}

#[test]
fn declarations_carry_their_origin() {
    let post = resolve(&library::pass("pass/post.wgsl").unwrap(), &Features::NONE, &[]).unwrap();
    let origins: Vec<&str> = post.wgsl.lines().filter(|line| line.starts_with("// ")).collect();
    assert!(origins.iter().any(|line| line.starts_with("// pass/post.wgsl:")));
    for line in origins {
        // The line that a comment names holds the declaration printed below it.
        let (file, number) = line[3..].split_once(':').unwrap();
        let text = library::text(file).unwrap_or_else(|| panic!("{line}"));
        let source = text.lines().nth(number.parse::<usize>().unwrap() - 1).unwrap();
        let word = |line: &str| line.split([' ', '<', '(']).next().unwrap_or_default().to_owned();
        let printed = post.wgsl.lines().skip_while(|l| *l != line).nth(1).unwrap();
        assert_eq!(word(source), word(printed), "{line}");
    }
}
