//! Passes that files refer to by kind.

use super::{assert_same_plan, file};
use crate::support::*;
use framegraph::file::*;
use framegraph::*;
use serde::Deserialize;

/// Draws a scene into a target, with its own depth buffer.
struct Scene;

#[derive(Deserialize)]
#[serde(deny_unknown_fields, default)]
struct SceneParams {
    samples: u8,
}

impl Default for SceneParams {
    fn default() -> Self {
        Self { samples: 1 }
    }
}

impl Plugin<Graph> for Scene {
    fn slots(&self) -> &[PluginSlot] {
        const { &[PluginSlot::required("color", SlotType::Target), PluginSlot::optional("lights", SlotType::Buffer)] }
    }

    fn declare(&self, graph: &mut Graph, call: &mut Call<'_>) -> Result<(), PluginError> {
        let SceneParams { samples } = call.params()?;
        if samples > 4 {
            return Err(PluginError::Custom {
                message: format!("{samples} samples"),
                hint: "ask for 4 at most".into(),
            });
        }
        let (target, name) = call.target("color");
        let name = name.unwrap_or("color").to_owned();
        let lights = call.buffer("lights");
        let color = graph.add_fn(call.name(), |p| {
            if let Some(lights) = lights {
                p.read_buffer(lights, AccessKind::Uniform)?;
            }
            let z = p.texture("depth", depth());
            p.depth(z, FAR)?;
            let target = p.target(target, &name, hdr());
            p.color(target, BLACK)
        })?;
        call.give("color", color);
        Ok(())
    }
}

/// Two passes that downsample and blur; the second samples the output of the first.
struct Blur;

impl Plugin<Graph> for Blur {
    fn slots(&self) -> &[PluginSlot] {
        const { &[PluginSlot::required("input", SlotType::Texture), PluginSlot::required("output", SlotType::Target)] }
    }

    fn declare(&self, graph: &mut Graph, call: &mut Call<'_>) -> Result<(), PluginError> {
        let () = call.params()?;
        let input = call.texture("input");
        let (target, name) = call.target("output");
        let name = name.unwrap_or("blurred").to_owned();
        let half = graph.add_fn(&format!("{}/half", call.name()), |p| {
            let input = input.ok_or_else(|| p.error("no input", "bind one"))?;
            p.sampled(input)?;
            let half = TextureDesc::new(Extent::fraction(2), Format::Rgba16Float);
            let half = p.texture("half", half);
            p.color(half, Intent::Overwrite)
        })?;
        let out = graph.add_fn(&format!("{}/full", call.name()), |p| {
            p.sampled(half)?;
            let target = p.target(target, &name, hdr());
            p.color(target, Intent::Overwrite)
        })?;
        call.give("output", out);
        Ok(())
    }
}

/// Requires a parameter.
struct Strict;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct StrictParams {
    #[serde(rename = "radius")]
    _radius: f32,
}

impl Plugin<Graph> for Strict {
    fn slots(&self) -> &[PluginSlot] {
        &[]
    }

    fn declare(&self, _: &mut Graph, call: &mut Call<'_>) -> Result<(), PluginError> {
        let StrictParams { .. } = call.params()?;
        Ok(())
    }
}

/// Declares a target slot, but does not write it.
struct Idle;

impl Plugin<Graph> for Idle {
    fn slots(&self) -> &[PluginSlot] {
        const { &[PluginSlot::optional("output", SlotType::Target)] }
    }

    fn declare(&self, _: &mut Graph, _: &mut Call<'_>) -> Result<(), PluginError> {
        Ok(())
    }
}

fn registry() -> Registry<'static, Graph> {
    let mut registry = Registry::new();
    assert!(!registry.insert("scene", Scene));
    assert!(!registry.insert("blur", Blur));
    assert!(!registry.insert("idle", Idle));
    assert!(!registry.insert("strict", Strict));
    registry
}

fn load(text: &str) -> Result<Graph, FileErrors> {
    let mut graph = Graph::new();
    GraphFile::parse("t.ron", text)?.declare(&[], &registry(), &mut graph)?;
    Ok(graph)
}

const SCREEN: &str = r#"
    Texture(name: "screen", format: Rgba8UnormSrgb, kind: Import(entry: Undefined, exit: Keep)),
    Texture(name: "old", format: Rgba16Float, kind: History(frames: 1)),
    Buffer(name: "lights", bytes: 64, kind: Import(entry: Defined, exit: Discard))"#;

const PASSES: &str = r#"
    Plugin(kind: "scene", name: "scene", slots: {"color": "hdr", "lights": "lights"}),
    Plugin(kind: "blur", name: "bloom", slots: {"input": "hdr", "output": "glow"}),
    Plugin(kind: "blur", name: "trail", slots: {"input": "old@-1", "output": "old"}),
    Raster(name: "grade", accesses: [
        Sampled(of: "hdr"), Sampled(of: "glow"), Sampled(of: "old"), Color(to: "screen", intent: Overwrite),
    ])"#;

fn in_code() -> Graph {
    let mut g = Graph::new();
    let out = screen(&mut g);
    let old = g.history("old", hdr(), 1);
    let lights = g.import_buffer("lights", 64, Entry::Defined, Exit::Discard);
    let scene = g
        .add_fn("scene", |p| {
            p.read_buffer(lights, AccessKind::Uniform)?;
            let z = p.texture("depth", depth());
            p.depth(z, FAR)?;
            let target = p.texture("hdr", hdr());
            p.color(target, BLACK)
        })
        .unwrap();
    let blur = |g: &mut Graph, name: &str, input: ReadOnly, target: Target| {
        g.scope(name, |g| {
            let half = g
                .add_fn("half", |p| {
                    p.sampled(input)?;
                    let half = TextureDesc::new(Extent::fraction(2), Format::Rgba16Float);
                    let half = p.texture("../half", half);
                    p.color(half, Intent::Overwrite)
                })
                .unwrap();
            g.add_fn("full", |p| {
                p.sampled(half)?;
                let target = p.target(target, "../glow", hdr());
                p.color(target, Intent::Overwrite)
            })
            .unwrap()
        })
    };
    let glow = blur(&mut g, "bloom", scene.into(), Target::New);
    let before = g.previous(old, 1).unwrap();
    let old = blur(&mut g, "trail", before.into(), old.into());
    g.add_fn("grade", |p| {
        p.sampled(scene)?;
        p.sampled(glow)?;
        p.sampled(old)?;
        p.color(out, Intent::Overwrite)
    })
    .unwrap();
    g
}

#[test]
fn the_file_with_plugins_and_the_code_compile_to_equal_plans() {
    let from_file = load(&file(SCREEN, PASSES, "")).unwrap();
    // The code declares its resources inside of the scope; the text differs only in those names.
    let (a, b) = (plan(&from_file, &wgpu()), plan(&in_code(), &wgpu()));
    let plain = dump::text(&b).replace("bloom/../", "").replace("trail/../", "");
    assert_eq!(dump::text(&a), plain);
    assert_eq!((a.steps(), a.decisions()), (b.steps(), b.decisions()));
    assert_same_plan(&a, &plan(&load(&file(SCREEN, PASSES, "")).unwrap(), &wgpu()));
}

#[test]
fn plugins_may_stand_in_any_order_too() {
    let passes = r#"
        Raster(name: "grade", accesses: [Sampled(of: "glow@bloom"), Color(to: "screen", intent: Overwrite)]),
        Plugin(kind: "blur", name: "bloom", slots: {"input": "hdr@scene", "output": "glow"}),
        Plugin(kind: "scene", name: "scene", slots: {"color": "hdr"})"#;
    let g = load(&file(SCREEN, passes, "")).unwrap();
    let names: Vec<_> = g.pass_ids().map(|p| g.pass_name(p)).collect();
    assert_eq!(names, ["scene", "bloom/half", "bloom/full", "grade"]);
}

#[test]
fn slots_parameters_and_kinds_are_checked() {
    let plugin = |rest: &str| file(SCREEN, &format!("Plugin(name: \"p\", {rest})"), "");
    let cases = [
        (plugin(r#"kind: "scen""#), "unknown plugin `scen`; did you mean `scene`?"),
        (plugin(r#"kind: "ssao""#), "unknown plugin `ssao`; use one of `blur`, `idle`, `scene` and `strict`"),
        (plugin(r#"kind: "scene""#), "t.ron:6:23: pass `p`: slot `color` of plugin `scene` is not bound; add"),
        (
            plugin(r#"kind: "scene", slots: {"colour": "hdr", "color": "x"}"#),
            "unknown slot `colour`; did you mean `color`?",
        ),
        (plugin(r#"kind: "scene", slots: {"color": "lights"}"#), "slot `color` requires a texture to write"),
        (
            plugin(r#"kind: "scene", slots: {"color": "x", "lights": "screen"}"#),
            "slot `lights` requires a buffer to read",
        ),
        (plugin(r#"kind: "scene", slots: {"color": "old@-1"}"#), "cannot be written"),
        (plugin(r#"kind: "blur", slots: {"input": "nowhere", "output": "x"}"#), "unknown resource `nowhere`"),
        (plugin(r#"kind: "blur", slots: {"input": "screen@-1", "output": "x"}"#), "not a history"),
        (
            plugin("kind: \"scene\", slots: {\"color\": \"x\"},\n  params: (\n  sample: 4)"),
            "t.ron:8:3: pass `p`: `SceneParams` has no field `sample`; did you mean `samples`?",
        ),
        (
            plugin("kind: \"scene\", slots: {\"color\": \"x\"}, params: (samples: 999)"),
            "t.ron:6:84: pass `p`: integer is out of bounds",
        ),
        (
            plugin("kind: \"scene\", slots: {\"color\": \"x\"}, params: (samples: 9)"),
            "pass `p`: plugin `scene`: 9 samples; ask for 4 at most",
        ),
        (plugin(r#"kind: "idle", slots: {"output": "x"}"#), "slot `output` was not written"),
        // Omitted parameters have no position, so the error points at the plugin, in its own line.
        (plugin("\n  kind: \"strict\""), "t.ron:6:23: pass `p`: `StrictParams` requires the field `radius`"),
        (
            plugin(r#"kind: "blur", slots: {"input": "x", "output": "x"}"#),
            "the plugin reads what it creates itself; let an earlier entry create it",
        ),
        (
            file(
                SCREEN,
                r#"
                Raster(name: "early", accesses: [Sampled(of: "hdr"), Color(to: "screen", intent: Overwrite)]),
                Plugin(kind: "scene", name: "s", slots: {"color": "hdr"})"#,
                "",
            ),
            "the plugin that creates it is listed later; list the plugin first, or select the version",
        ),
    ];
    for (text, expected) in cases {
        let errors = load(&text).expect_err(&text).to_string();
        assert!(errors.contains(expected), "{text}\n{errors}\nlacks {expected}");
        let own = expected.contains("reads what it creates itself");
        assert!(!own || !errors.contains("listed later"), "{errors}");
    }
    assert!(load(&plugin(r#"kind: "idle""#)).is_ok(), "an optional slot may stay unbound");
}

/// Loop indices and template arguments are inserted into parameters: alone in quotes as values, otherwise as parts of
/// texts.
#[test]
fn parameters_take_words_of_templates_and_numbers_of_loops() {
    let samples_of = |passes: &str, with: &str| {
        let templates = r#"templates: {"drawn": (params: ["name", "samples"], passes: [
            Plugin(kind: "scene", name: "{name}", slots: {"color": "x{name}"},
                params: (samples: "{samples}")),
        ])},"#;
        let text = file(SCREEN, passes, "").replacen("resources:", &format!("{templates} resources:"), 1);
        load(&text.replace("WITH", with)).map_err(|errors| errors.to_string())
    };
    let used = r#"Use(template: "drawn", with: {"name": "a", "samples": WITH})"#;
    let asked = |with: &str| samples_of(used, with).expect_err("no more than 4 samples").to_string();
    assert!(samples_of(used, "4").is_ok());
    assert!(asked("9").contains("plugin `scene`: 9 samples"), "{}", asked("9"));
    // A text is not a number, and the error has the position it would have without a template.
    let place = asked("\"4\"");
    assert!(place.contains("t.ron:4:34: pass `a`: ") && place.contains("expected"), "{place}");
    let each = |entry: &str| format!(r#"Each(index: "i", from: 8, count: 1, entries: [{entry}])"#);
    let through = samples_of(&each(used), r#""{i+1}""#).expect_err("9 samples");
    assert!(through.contains("9 samples"), "{through}");
    let direct = each(r#"Plugin(kind: "scene", name: "p", slots: {"color": "y"}, params: (samples: "{ i }"))"#);
    let direct = samples_of(&direct, "").expect_err("8 samples");
    assert!(direct.contains("8 samples"), "{direct}");
}

#[test]
fn errors_of_compiling_point_at_the_plugin() {
    // The scene's depth buffer has the size of the frame, but the target has another size.
    let resources = format!("{SCREEN}, Texture(name: \"small\", format: Rgba16Float, size: Texels(8, 8))");
    let text = file(
        &resources,
        "\nPlugin(kind: \"scene\", name: \"s\", slots: {\"color\": \"small\"})",
        "Keep(of: \"small\")",
    );
    let file = GraphFile::parse("t.ron", &text).unwrap();
    let mut graph = Graph::new();
    file.declare(&[], &registry(), &mut graph).unwrap();
    let errors = file.explain(&CompileErrors { listed: errors(&graph), more: 0 });
    assert!(errors.to_string().starts_with("t.ron:7:29: pass `s`: "), "{errors}");
}

/// Counts into a buffer, which it creates if the file has none of that name.
struct Count;

impl Plugin<Graph> for Count {
    fn slots(&self) -> &[PluginSlot] {
        const { &[PluginSlot::required("sums", SlotType::TargetBuffer)] }
    }

    fn declare(&self, graph: &mut Graph, call: &mut Call<'_>) -> Result<(), PluginError> {
        let name = call.bound("sums").unwrap_or("sums").to_owned();
        let old = call.buffer("sums");
        let sums = graph.add_fn(call.name(), |p| {
            let sums = old.unwrap_or_else(|| p.buffer(&name, 16));
            p.write_buffer(sums, AccessKind::StorageWrite, Intent::Overwrite)
        })?;
        call.give_buffer("sums", sums);
        Ok(())
    }
}

#[test]
fn a_plugin_writes_a_buffer_of_the_file_or_makes_one() {
    let mut registry = Registry::new();
    registry.insert("count", Count);
    let text = file(
        r#"Buffer(name: "known", bytes: 64)"#,
        r#"
        Plugin(kind: "count", name: "first", slots: {"sums": "known"}),
        Plugin(kind: "count", name: "second", slots: {"sums": "made"}),
        Compute(name: "read", flags: [SideEffect], accesses: [StorageRead(of: "known"), StorageRead(of: "made")]),
        "#,
        "",
    );
    let mut graph = Graph::new();
    GraphFile::parse("t.ron", &text).unwrap().declare(&[], &registry, &mut graph).unwrap();
    let bytes = |name| graph.find_resource(name).map(|r| graph.resources()[r.index()].desc.bytes(FRAME));
    assert_eq!((bytes("known"), bytes("made")), (Some(64), Some(16)));
    let read = graph.find_pass("read").unwrap();
    let writers: Vec<_> = graph.accesses_of(read).iter().map(|a| graph.versions()[a.version.index()].writer).collect();
    assert_eq!(writers, ["first", "second"].map(|name| graph.find_pass(name).unwrap()));
}
